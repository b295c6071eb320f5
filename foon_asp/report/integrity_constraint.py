"""A rule without a head of the user's, with its place, for people and for programs."""

from collections.abc import Iterator

from foon_asp.asp.integrity import IntegrityConstraint
from foon_asp.text.json_value import Json


def constraint_lines(constraint: IntegrityConstraint, remark: str = "") -> Iterator[str]:
    """Say where a constraint stands and under which constants, and give its text."""
    given = "".join(f"    -c {setting}" for setting in constraint.constants)
    yield f"  {constraint.source}{remark}{given}"
    yield f"      {constraint.text}"


def constraint_json(constraint: IntegrityConstraint) -> Json:
    """Give a constraint with its place and text."""
    return {
        "number": constraint.number,
        "file": constraint.source.file,
        "line": constraint.source.line,
        "text": constraint.text,
        "constants": list(constraint.constants),
    }
