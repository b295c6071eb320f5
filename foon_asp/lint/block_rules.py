"""What there is to say of object nodes line by line: second lists, and states said twice."""

from collections.abc import Collection, Iterator

from foon_asp.lint.names import times
from foon_asp.lint.sheet import Sheet
from foon_asp.network import Contents, Relation
from foon_asp.text.diagnostics import Diagnostic
from foon_asp.text.line import ObjectLine, StateLine

_PLACES = {"in", "on", "inside", "under", "below", "at", "into", "onto", "on top of"}


def block_findings(sheet: Sheet) -> Iterator[Diagnostic]:
    """Give a finding for each different pair of lines that stand under one object.

    An object may be on a tray and covered with foil; two places, or two lists by one word, are too many.
    """
    parts = {
        sheet.lines[written.first]: _part(written.line.attribute)
        for written in sheet.distinct_lines
        if isinstance(written.line, StateLine)
    }
    labels = {written.line.label for written in sheet.distinct_lines if isinstance(written.line, ObjectLine)}
    found: dict[tuple[str, str, str, str], list[int]] = {}  # where
    label = ""
    above: dict[str, str] = {}
    states: set[str] = set()
    for index, line in enumerate(sheet.lines):
        part = parts.get(line)
        if part is None:
            if line[:1] == "O":
                label, above, states = line, {}, set()
            continue
        if line in states:
            found.setdefault(("repeated-state", label, line, line), []).append(index)
        elif part:
            if part in above and _conflict(above[part], line, labels):
                code = "second-contents" if part[0] == "{" else "second-relation"
                found.setdefault((code, label, above[part], line), []).append(index)
            above[part] = line
        states.add(line)
    for (code, label, first, second), places in found.items():
        count = f" ({times(len(places))} in this file)" if len(places) > 1 else ""
        yield sheet.finding(code, _message(code, label, first, second) + count, places[0])


def _part(attribute: str | Relation | Contents) -> str:
    """Say what an object has one of: contents or a relation by one word, and one place."""
    if isinstance(attribute, Contents):
        return "{" + attribute.word
    if isinstance(attribute, Relation):
        return "[" if attribute.word in _PLACES else "[" + attribute.word
    return ""


def _conflict(first: str, second: str, labels: Collection[str]) -> bool:
    """Whether two lines cannot both be true: of two places by different words, both have to be objects."""
    word, one = first.split("\t")[1:3]
    other_word, other = second.split("\t")[1:3]
    return word == other_word or (one.strip("[]") in labels and other.strip("[]") in labels)


def _message(code: str, label: str, first: str, second: str) -> str:
    name, one, other = (" ".join(line.split("\t")[1:]) for line in (label, first, second))
    name = repr(label.split("\t")[1]) if "\t" in label else repr(name)
    if code == "repeated-state":
        return f"{other!r} is given twice for the object {name}; one line is enough"
    if code == "second-contents":
        return f"{name} has {other!r} beside {one!r}; both count: if they are one list, write one line"
    return f"{name} is {other!r} besides {one!r}; both count: if one is outdated, take it out"
