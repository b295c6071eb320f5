"""What there is to say of object nodes line by line: second lists, and states said twice."""

from collections.abc import Collection, Iterator

from foon_asp.linting.names import times
from foon_asp.linting.sheet import Sheet
from foon_asp.network import Contents, Relation
from foon_asp.text.diagnostics import Diagnostic
from foon_asp.text.line import ObjectLine, StateLine

Attribute = str | Relation | Contents

_PLACES = {"in", "on", "inside", "under", "below", "at", "into", "onto", "on top of"}


def block_findings(sheet: Sheet) -> Iterator[Diagnostic]:
    """Return a finding for each different pair of lines that stand under one object.

    An object may be on a tray and covered with foil; two places, or two lists by one word, are too many.
    """
    written = {sheet.lines[each.first]: each.line for each in sheet.distinct_lines}
    labels = {line.label for line in written.values() if isinstance(line, ObjectLine)}
    found: dict[tuple[str, str, Attribute, Attribute], list[int]] = {}  # where
    label = ""
    above: dict[str, Attribute] = {}
    states: set[Attribute] = set()
    for index, text in enumerate(sheet.lines):
        line = written.get(text)
        if not isinstance(line, StateLine):
            if text[:1] == "O":
                label = line.label if isinstance(line, ObjectLine) else ""
                above, states = {}, set()
            continue
        attribute = line.attribute
        kind = _kind(attribute)
        if attribute in states:
            found.setdefault(("repeated-state", label, attribute, attribute), []).append(index)
        elif kind:
            if kind in above and _conflict(above[kind], attribute, labels):
                code = "second-contents" if isinstance(attribute, Contents) else "second-relation"
                found.setdefault((code, label, above[kind], attribute), []).append(index)
            above[kind] = attribute
        states.add(attribute)
    for (code, label, first, second), indices in found.items():
        count = f" ({times(len(indices))} in this file)" if len(indices) > 1 else ""
        yield sheet.finding(code, _message(code, label, first, second) + count, indices[0])


def _kind(attribute: Attribute) -> str:
    """Return what an object has one of: contents or a relation by one word, and one place; else nothing."""
    if isinstance(attribute, Contents):
        return "{" + attribute.word
    if isinstance(attribute, Relation):
        return "[" if attribute.word in _PLACES else "[" + attribute.word
    return ""


def _conflict(first: Attribute, second: Attribute, labels: Collection[str]) -> bool:
    """Whether two attributes of a kind cannot both be true: of places by two words, both must be objects."""
    if not isinstance(first, Relation) or not isinstance(second, Relation):
        return True
    return first.word == second.word or (first.object in labels and second.object in labels)


def _message(code: str, label: str, first: Attribute, second: Attribute) -> str:
    name, one, other = repr(label), str(first), str(second)
    if code == "repeated-state":
        return f"{other!r} is given twice for the object {name}; one line is enough"
    if code == "second-contents":
        return f"{name} has {other!r} beside {one!r}; both count: if they are one list, write one line"
    return f"{name} is {other!r} besides {one!r}; both count: if one is outdated, take it out"
