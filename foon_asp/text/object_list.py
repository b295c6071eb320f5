"""Kitchens and goals: lists of object nodes, in JSON or as FOON text without motions."""

from pathlib import Path
from typing import NamedTuple

from foon_asp.network import NodePattern, Source
from foon_asp.text.diagnostics import Diagnostic
from foon_asp.text.formats import JSON, format_of
from foon_asp.text.plain_file import read_plain_text
from foon_asp.text.reading import Reading


class ListedObject(NamedTuple):
    """An entry of a kitchen or goals file: the pattern of the nodes it means, its source and its amount.

    ``amount`` is how many copies are available or wanted; ``None`` where the file does not say it.
    """

    pattern: NodePattern
    source: Source
    amount: int | None = None


def read_object_list(file: Path, warnings: list[Diagnostic] | None = None) -> list[ListedObject]:
    """Return the entries of a kitchen or goals file, in JSON or as object blocks of FOON text.

    A ``*.json`` file is read as JSON, any other file by its content. JSON is a list of ``{"label", "states",
    "ingredients", "container", "amount"}``, of which only the label is required. Warnings are added to the
    list ``warnings``, if it is given.

    Raises :class:`InputError` with the line and column of every faulty entry. An entry is also faulty if an
    earlier entry lists the same object with another amount.
    """
    text = read_plain_text(file)
    format_ = JSON if file.suffix == JSON.list_suffix else format_of(text, str(file))
    reading = Reading()
    entries = [
        ListedObject(pattern, block.source, block.amount)
        for block, pattern in format_.objects(text, str(file), reading)
    ]
    first_amounts: dict[NodePattern, int | None] = {}
    for pattern, source, amount in entries:
        if first_amounts.setdefault(pattern, amount) != amount:
            reading.reject("amount", f"found a second amount of {str(pattern)!r}, expected one", source)
    reading.raise_errors()
    if warnings is not None:
        warnings += reading.diagnostics
    return entries
