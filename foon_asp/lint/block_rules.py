"""What there is to say of object nodes line by line: second lists, and states said twice."""

from collections.abc import Iterator

from foon_asp.lint.names import times
from foon_asp.lint.sheet import Sheet
from foon_asp.network import Contents, Relation
from foon_asp.text.diagnostics import Diagnostic
from foon_asp.text.line import StateLine


def block_findings(sheet: Sheet) -> Iterator[Diagnostic]:
    """Give a finding for each different pair of lines that stand under one object."""
    parts = {
        sheet.lines[written.first]: type(written.line.attribute)
        for written in sheet.distinct_lines
        if isinstance(written.line, StateLine)
    }
    found: dict[tuple[str, str, str, str], list[int]] = {}  # where
    label, above = "", dict.fromkeys((Contents, Relation), "")
    states: set[str] = set()
    for index, line in enumerate(sheet.lines):
        part = parts.get(line)
        if part is None:
            if line[:1] == "O":
                label, above = line, dict.fromkeys((Contents, Relation), "")
                states = set()
            continue
        if line in states:
            found.setdefault(("repeated-state", label, line, line), []).append(index)
        elif part in above:
            if above[part]:
                code = "second-contents" if part is Contents else "second-relation"
                found.setdefault((code, label, above[part], line), []).append(index)
            above[part] = line
        states.add(line)
    for (code, label, first, second), places in found.items():
        count = f" ({times(len(places))} in this file)" if len(places) > 1 else ""
        yield sheet.finding(code, _message(code, label, first, second) + count, places[0])


def _message(code: str, label: str, first: str, second: str) -> str:
    name, one, other = (" ".join(line.split("\t")[1:]) for line in (label, first, second))
    name = repr(label.split("\t")[1]) if "\t" in label else repr(name)
    if code == "repeated-state":
        return f"{other!r} is given twice for the object {name}; one line is enough"
    if code == "second-contents":
        return f"{name} has {other!r} beside {one!r}; both count: if they are one list, write one line"
    return f"{name} is {other!r} besides {one!r}; both count: if one is outdated, take it out"
