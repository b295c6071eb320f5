"""Lint rules about units and their objects: listed twice, changed by nothing, in two places at once."""

from collections.abc import Callable, Iterator
from functools import partial
from operator import eq

from foon_asp.linting.context import Context
from foon_asp.linting.linted_files import Copy
from foon_asp.linting.names import times_text
from foon_asp.linting.rule import NOTE, WARNING, rule
from foon_asp.linting.sheet import Sheet
from foon_asp.network import Contents, Relation
from foon_asp.text.diagnostics import Diagnostic
from foon_asp.text.line import ObjectLine

_Attribute = str | Relation | Contents
_PLACES = {"in", "on", "inside", "under", "below", "at", "into", "onto", "on top of"}


@rule("no-effect", WARNING, "a unit whose outputs are its inputs")
def find_units_without_effect(context: Context) -> Iterator[Diagnostic]:
    """The unit makes nothing, so no task tree needs it. Usually a state is missing in the outputs."""
    network = context.network
    for motion, inputs, outputs, copies in zip(
        network.motions, network.inputs, network.outputs, context.files.copies, strict=True
    ):
        if outputs and len(inputs) == len(outputs) and set(inputs) == set(outputs):
            message = f"the outputs of the unit {motion!r} are its inputs; say what {motion!r} changes, or "
            for copy in copies:
                yield context.finding_at_unit(copy, message + "leave it out")


@rule("duplicate-unit", WARNING, "a unit that the file already contains")
def find_duplicate_units(context: Context) -> Iterator[Diagnostic]:
    """Two units of a file have the same motion, inputs and outputs.

    The order of lines and states, ids, flags and times do not count. A universal FOON has every unit once;
    `foon-asp merge` takes care of that. A unit may be in several recipes.
    """
    for motion, copies in zip(context.network.motions, context.files.copies, strict=True):
        firsts: dict[int, Copy] = {}
        for copy in copies:
            sheet = context.sheets[copy.sheet]
            first = firsts.setdefault(copy.sheet, copy)
            if first is not copy:
                line = sheet.line_name(first.first_index, sheet)
                message = (
                    f"the unit {motion!r} is already on {line}, with the same inputs and outputs; "
                    "one is enough"
                )
                yield context.finding_at_unit(copy, message)


@rule("repeated-object", WARNING, "an object node listed twice on one side of a unit, or a state of it")
def find_repeated_objects(context: Context) -> Iterator[Diagnostic]:
    """Inputs and outputs of a unit, and states of an object, are sets: what stands twice counts once.

    Two eggs are two nodes only if they differ, for example in their places. A table (`unit_amounts.txt`) says
    how many are taken. Often a state line is missing under one of two equal objects. In JSON and neutral
    lines, a node that is listed twice is meant twice.
    """
    network = context.network
    for unit, copies in enumerate(context.files.copies):
        for copy in copies:
            if context.sheets[copy.sheet].places is not None:  # JSON, in which two are meant
                continue
            if copy.inputs > len(network.inputs[unit]) or copy.outputs > len(network.outputs[unit]):
                yield from _repeated_nodes(context, copy)
    for sheet in context.sheets:
        for label, _, state, indices in _clashes(sheet, eq):
            message = f"{str(state)!r} is given twice for the object {label!r}; one line is enough"
            yield _first_line_finding(sheet, message, indices)


def _repeated_nodes(context: Context, copy: Copy) -> Iterator[Diagnostic]:
    """Yield a finding for each node that a side of a copy of a unit lists again."""
    sheet = context.sheets[copy.sheet]
    for side, blocks in zip(("inputs", "outputs"), context.node_lines(copy), strict=True):
        firsts: dict[object, int] = {}
        for index, node in blocks:
            first = firsts.setdefault(node, index)
            if first != index:
                message = f"{str(node)!r} is among the {side} of the unit already, on "
                message += f"{sheet.line_name(first, sheet)}; it counts once"
                yield sheet.finding(message, index, node.label)


@rule("second-relation", NOTE, "two places, or two relations or lists by one word, under one object")
def find_second_relations(context: Context) -> Iterator[Diagnostic]:
    """An object can be in two relations, such as `on [tray]` and `covered [foil]`, but not in two places.

    It cannot have two relations with the same word, or two lists of contents with the same word. When an
    object is moved, its old place has to be removed. All contents belong on one line.
    """
    for sheet in context.sheets:
        labels = {
            written.line.label for written in sheet.distinct_lines if isinstance(written.line, ObjectLine)
        }
        for label, first, second, indices in _clashes(sheet, partial(_exclude_each_other, labels)):
            if isinstance(second, Contents):
                message = f"{label!r} has {str(second)!r} beside {str(first)!r}; both count: if they are "
                message += "one list, write one line"
            else:
                message = f"{label!r} is {str(second)!r} besides {str(first)!r}; both count: if one is "
                message += "outdated, take it out"
            yield _first_line_finding(sheet, message, indices)


def _clashes(
    sheet: Sheet, is_clash: Callable[[_Attribute, _Attribute], bool]
) -> Iterator[tuple[str, _Attribute, _Attribute, list[int]]]:
    """Yield the label of an object, two clashing attributes, and the indices of lines with the second one.

    Each label with its two attributes is yielded once. ``is_clash`` is asked with an earlier and a later
    attribute of one object. If an attribute clashes with several earlier ones, it is yielded with the first
    of them.
    """
    lines_by_clash: dict[tuple[str, _Attribute, _Attribute], list[int]] = {}
    for block in sheet.longer_blocks:
        for number, (index, second) in enumerate(block.attributes):
            for _, first in block.attributes[:number]:
                if is_clash(first, second):
                    lines_by_clash.setdefault((block.label, first, second), []).append(index)
                    break
    for (label, first, second), indices in lines_by_clash.items():
        yield label, first, second, indices


def _first_line_finding(sheet: Sheet, message: str, indices: list[int]) -> Diagnostic:
    """Return a finding about the first of the lines at ``indices``; the message says how many there are."""
    count = f" ({times_text(len(indices))} in this file)" if len(indices) > 1 else ""
    return sheet.finding(message + count, indices[0])


def _exclude_each_other(labels: set[str], first: _Attribute, second: _Attribute) -> bool:
    """Whether two attributes exclude each other: both have the same word, or both are places.

    Places are relations such as ``in`` or ``on`` to objects with one of ``labels``. Equal attributes do not
    exclude each other, nor do a relation and contents.
    """
    if isinstance(first, Contents) and isinstance(second, Contents):
        return first.word == second.word and first != second
    if not isinstance(first, Relation) or not isinstance(second, Relation) or first == second:
        return False
    are_places = {first.word, second.word} <= _PLACES and {first.object, second.object} <= labels
    return first.word == second.word or are_places
