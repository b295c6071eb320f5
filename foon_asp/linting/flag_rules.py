"""What there is to say of motion flags: a few that are missing among many."""

from collections.abc import Iterator

from foon_asp.linting.sheet import Sheet
from foon_asp.text.diagnostics import Diagnostic
from foon_asp.text.line import ObjectLine


def flag_findings(sheet: Sheet) -> Iterator[Diagnostic]:
    """Give one finding for a network where object lines have no motion flag, though most have one.

    Dialects without flags are as good; lists of objects have no motion to be in.
    """
    if sheet.entries is not None:
        return
    yield from _behind_a_space(sheet)
    first: tuple[int, str] | None = None
    missing = having = 0
    for line, index, count in sheet.distinct_lines:
        if not isinstance(line, ObjectLine):
            continue
        if line.fields:
            having += count
        else:
            first = first or (index, line.label)
            missing += count
    if first is None or missing >= having:
        return
    have = "have no motion flag, this one first" if missing > 1 else "has no motion flag"
    message = f"{missing} of {missing + having} object lines {have}; write 1 if it is in motion, 0 if not"
    yield sheet.finding("missing-flag", message, *first)


def _behind_a_space(sheet: Sheet) -> Iterator[Diagnostic]:
    """Give a finding for each label that ends with a flag, where the rest of it is a label, too."""
    labels = {line.label: line.fields for line, _, _ in sheet.distinct_lines if isinstance(line, ObjectLine)}
    flagged = any(labels.values())
    for line, index, _ in sheet.distinct_lines:
        if not isinstance(line, ObjectLine) or line.fields or line.label[-2:] not in {" 0", " 1"}:
            continue
        name = line.label[:-2]
        if flagged or name in labels:
            message = (
                f"{line.label!r} is read as the name; is it {name!r} with the motion flag {line.label[-1]}?"
            )
            yield sheet.finding("flag-space", message, index, line.label)
