"""What there is to say of ids: one file should give one id to one name."""

from collections.abc import Iterator
from typing import NamedTuple

from foon_asp.linting.names import times
from foon_asp.linting.sheet import Sheet, WrittenLine
from foon_asp.text.diagnostics import Diagnostic
from foon_asp.text.line import name_of

_KINDS = {"O": "object", "S": "state", "M": "motion"}
_NEARLY_ALL = 20  # lines with an id for one without
_MANY = 4  # names of one id: then it means nothing, and they are told together


class _Use(NamedTuple):
    """How often an id stands with a name, less than nothing so that they sort, where first, and the other."""

    rarity: int
    first: int
    other: str

    def times(self) -> str:
        return times(-self.rarity)


def id_findings(sheet: Sheet) -> Iterator[Diagnostic]:
    """Give a finding for each id with a second name, and for each name with a second id, of each kind."""
    lines: dict[tuple[str, str, str], list[WrittenLine]] = {}
    for written in sheet.distinct_lines:
        if id_ := written.line.id:
            key = sheet.lines[written.first][0], id_, name_of(written.line)
            lines.setdefault(key, []).append(written)
    names: dict[tuple[str, str], list[_Use]] = {}
    ids: dict[tuple[str, str], list[_Use]] = {}
    for (letter, id_, name), alike in lines.items():
        rarity, first = -sum(line.often for line in alike), min(line.first for line in alike)
        names.setdefault((letter, id_), []).append(_Use(rarity, first, name))
        ids.setdefault((letter, name), []).append(_Use(rarity, first, id_))
    yield from _missing(sheet)
    for (letter, id_), of_id in names.items():
        yield from _names_of_id(sheet, letter, id_, sorted(of_id))
    for (letter, name), of_name in ids.items():
        yield from _ids_of_name(sheet, letter, name, sorted(of_name))


def _missing(sheet: Sheet) -> Iterator[Diagnostic]:
    """Give the lines without an id, where nearly all have one."""
    without = [written for written in sheet.distinct_lines if not written.line.id]
    often = sum(written.often for written in without)
    if not without or _NEARLY_ALL * often > sum(written.often for written in sheet.distinct_lines):
        return
    for written in without:
        letter = sheet.lines[written.first][0]
        message = f"no {_KINDS[letter]} id behind {letter}; nearly all lines of the file have ids"
        yield sheet.finding("missing-id", message, written.first)


def _names_of_id(sheet: Sheet, letter: str, id_: str, uses: list[_Use]) -> Iterator[Diagnostic]:
    most, where = uses[0], sheet.where(uses[0].first, sheet)
    if len(uses) >= _MANY:
        shown = ", ".join(f"{use.other!r} ({-use.rarity})" for use in uses[: _MANY - 1])
        message = (
            f"the {_KINDS[letter]} id {letter}{id_} is that of {len(uses)} names: {shown}, ...; "
            "ids should tell names apart, or be left out"
        )
        yield sheet.finding("id-of-two-names", message, min(use.first for use in uses))
        return
    for use in uses[1:]:
        message = (
            f"the {_KINDS[letter]} id {letter}{id_} is that of {use.other!r} ({use.times()}) and "
            f"of {most.other!r} ({most.times()}, first on {where}); one needs another id"
        )
        yield sheet.finding("id-of-two-names", message, use.first)


def _ids_of_name(sheet: Sheet, letter: str, name: str, uses: list[_Use]) -> Iterator[Diagnostic]:
    most, where = uses[0], sheet.where(uses[0].first, sheet)
    for use in uses[1:]:
        message = (
            f"the {_KINDS[letter]} {name!r} has the id {letter}{use.other} ({use.times()}) and "
            f"{letter}{most.other} ({most.times()}, first on {where}); it should have one"
        )
        yield sheet.finding("name-of-two-ids", message, use.first)
