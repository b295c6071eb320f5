"""What there is to say of ids: one file should give one id to one name."""

from collections.abc import Iterator

from foon_asp.lint.names import times
from foon_asp.lint.sheet import Sheet
from foon_asp.text import Diagnostic
from foon_asp.text.line import name_of

_KINDS = {"O": "object", "S": "state", "M": "motion"}
_MANY = 4  # names of one id: then it means nothing, and they are told together


class _Use:
    """How often an id stands with a name, and where first."""

    def __init__(self, index: int) -> None:
        self.index = index
        self.count = 0


def id_findings(sheet: Sheet) -> Iterator[Diagnostic]:
    """Give a finding for each id with a second name, and for each name with a second id, of each kind."""
    uses: dict[str, dict[tuple[str, str], _Use]] = {letter: {} for letter in _KINDS}
    for line, index, count in sheet.distinct_lines:
        if line.id:
            letter = sheet.lines[index][0]
            use = uses[letter].setdefault((line.id, name_of(line)), _Use(index))
            use.index = min(use.index, index)
            use.count += count
    for letter, found in uses.items():
        names: dict[str, list[tuple[str, _Use]]] = {}
        ids: dict[str, list[tuple[str, _Use]]] = {}
        for (id_, name), use in found.items():
            names.setdefault(id_, []).append((name, use))
            ids.setdefault(name, []).append((id_, use))
        for id_, of_id in names.items():
            yield from _names_of_id(sheet, letter, id_, sorted(of_id, key=_frequency))
        for name, of_name in ids.items():
            yield from _ids_of_name(sheet, letter, name, sorted(of_name, key=_frequency))


def _frequency(use: tuple[str, _Use]) -> tuple[int, int]:
    return -use[1].count, use[1].index


def _names_of_id(sheet: Sheet, letter: str, id_: str, uses: list[tuple[str, _Use]]) -> Iterator[Diagnostic]:
    most, most_use = uses[0]
    if len(uses) >= _MANY:
        shown = ", ".join(f"{name!r} ({use.count})" for name, use in uses[: _MANY - 1])
        message = (
            f"the {_KINDS[letter]} id {letter}{id_} is that of {len(uses)} names: {shown}, ...; "
            "ids should tell names apart, or be left out"
        )
        second = min(uses, key=lambda use: use[1].index)
        yield sheet.finding("id-of-two-names", message, second[1].index)
        return
    for name, use in uses[1:]:
        message = (
            f"the {_KINDS[letter]} id {letter}{id_} is that of {name!r} ({times(use.count)}) and of {most!r} "
            f"({times(most_use.count)}, first on {sheet.where(most_use.index, sheet)}); one needs another id"
        )
        yield sheet.finding("id-of-two-names", message, use.index)


def _ids_of_name(sheet: Sheet, letter: str, name: str, uses: list[tuple[str, _Use]]) -> Iterator[Diagnostic]:
    most, most_use = uses[0]
    for id_, use in uses[1:]:
        message = (
            f"the {_KINDS[letter]} {name!r} has the id {letter}{id_} ({times(use.count)}) and {letter}{most} "
            f"({times(most_use.count)}, first on {sheet.where(most_use.index, sheet)}); it should have one"
        )
        yield sheet.finding("name-of-two-ids", message, use.index)
