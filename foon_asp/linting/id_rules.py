"""Lint rules about ids and motion flags: a file should have one id for each name, on all lines or on none."""

from collections.abc import Iterator
from typing import NamedTuple

from foon_asp.linting.context import Context
from foon_asp.linting.names import times_text
from foon_asp.linting.rule import NOTE, WARNING, rule
from foon_asp.linting.sheet import Sheet
from foon_asp.text.diagnostics import Diagnostic
from foon_asp.text.line import ObjectLine, name_of

_KINDS = {"O": "object", "S": "state", "M": "motion"}


class _Use(NamedTuple):
    """A name that stands with an id, or an id that stands with a name.

    ``occurrences`` is the number of lines that have both the name and the id. ``first_index`` is the index of
    the first such line.
    """

    text: str
    occurrences: int
    first_index: int


def _uses_by_key(sheet: Sheet, by_id: bool) -> Iterator[tuple[str, str, list[_Use]]]:
    """Yield the letter of the lines (O, S or M), a key, and its uses, the most frequent first.

    With ``by_id``, keys are ids and uses are their names. Otherwise keys are names and uses are their ids.
    Lines without an id are left out.
    """
    uses: dict[tuple[str, str], dict[str, _Use]] = {}
    for line, first, occurrences in sheet.distinct_lines:
        if line.id:
            key, text = (line.id, name_of(line)) if by_id else (name_of(line), line.id)
            uses_of_key = uses.setdefault((sheet.lines[first][0], key), {})
            earlier = uses_of_key.get(text, _Use(text, 0, first))
            uses_of_key[text] = _Use(text, earlier.occurrences + occurrences, min(earlier.first_index, first))
    for (letter, key), uses_of_key in uses.items():
        yield letter, key, sorted(uses_of_key.values(), key=lambda use: (-use.occurrences, use.first_index))


@rule("id-of-two-names", WARNING, "one id for two names")
def find_ids_of_two_names(context: Context) -> Iterator[Diagnostic]:
    """One file has one id for two names of objects, of states or of motions.

    An id with four names or more means nothing and is reported once. foon-asp ignores ids, but other programs
    use them.
    """
    for sheet in context.sheets:
        for letter, id_, uses in _uses_by_key(sheet, by_id=True):
            usual, *others = uses
            if len(uses) >= 4:  # the id means nothing
                shown = ", ".join(f"{use.text!r} ({use.occurrences})" for use in uses[:3])
                message = (
                    f"the {_KINDS[letter]} id {letter}{id_} is that of {len(uses)} names: {shown}, ...; "
                    "ids should tell names apart, or be left out"
                )
                yield sheet.finding(message, min(use.first_index for use in uses))
                continue
            for use in others:
                line = sheet.line_name(usual.first_index, sheet)
                message = (
                    f"the {_KINDS[letter]} id {letter}{id_} is that of {use.text!r} "
                    f"({times_text(use.occurrences)}) and of {usual.text!r} "
                    f"({times_text(usual.occurrences)}, first on {line}); one needs another id"
                )
                yield sheet.finding(message, use.first_index)


@rule("name-of-two-ids", WARNING, "one name with two ids")
def find_names_of_two_ids(context: Context) -> Iterator[Diagnostic]:
    """One file has two ids for one name of an object, a state or a motion."""
    for sheet in context.sheets:
        for letter, name, (usual, *others) in _uses_by_key(sheet, by_id=False):
            for use in others:
                line = sheet.line_name(usual.first_index, sheet)
                message = (
                    f"the {_KINDS[letter]} {name!r} has the id {letter}{use.text} "
                    f"({times_text(use.occurrences)}) and {letter}{usual.text} "
                    f"({times_text(usual.occurrences)}, first on {line}); it should have one"
                )
                yield sheet.finding(message, use.first_index)


@rule("missing-field", NOTE, "no id or motion flag, in a file where other lines have one")
def find_missing_fields(context: Context) -> Iterator[Diagnostic]:
    """Ids and motion flags are optional, but a file has them on all lines or on none.

    Lines without an id are reported if at least 19 of 20 lines have one. If most object lines have a motion
    flag, a single finding covers all object lines that have none.
    """
    for sheet in context.sheets:
        lines = sheet.distinct_lines
        without_id = [written for written in lines if not written.line.id]
        count = sum(written.occurrences for written in without_id)
        if 20 * count <= sum(written.occurrences for written in lines):
            for written in without_id:
                letter = sheet.lines[written.first_index][0]
                message = f"no {_KINDS[letter]} id behind {letter}; nearly all lines of the file have ids"
                yield sheet.finding(message, written.first_index)
        objects = [
            (written.line, written.first_index, written.occurrences)
            for written in lines
            if isinstance(written.line, ObjectLine)
        ]
        without_flag = [(line.label, first, count) for line, first, count in objects if not line.fields]
        missing, total = (sum(count for *_, count in written) for written in (without_flag, objects))
        if sheet.entries is None and 0 < 2 * missing < total:  # lists of objects have no motion to be in
            have = "have no motion flag, this one first" if missing > 1 else "has no motion flag"
            message = f"{missing} of {total} object lines {have}; write 1 if it is in motion, 0 if not"
            label, index, _ = without_flag[0]
            yield sheet.finding(message, index, label)
