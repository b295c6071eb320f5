"""Plans as planners write them: Fast Downward, pyperplan, those of the IPC, and unified-planning."""

import difflib
import re
from collections.abc import Sequence
from typing import NamedTuple

from foon_asp.network import FunctionalUnit, Source
from foon_asp.planning.name_map import NameMap
from foon_asp.text.diagnostics import Diagnostic, InputError, Severity
from foon_asp.text.plain_file import split_lines

_COMMENT = re.compile(r"\s*;.*")
_HEAD = re.compile(r"\s*\w*Plan\w*:?\s*")  # of unified-planning: SequentialPlan:
_STEP = re.compile(
    r"""\s*
    (?:(?:step\s+)?\d+(?:\.\d+)?\s*:\s*)?           # 0: or 0.000: or step 0:
    (?:\(\s*(?P<listed>[^\s();:]+)\s*\)|            # (u580-pour)
       (?P<bare>[^\s()\[\]:;,]+)(?:\(\s*\))?)       # u580-pour or u580-pour()
    \s*(?:\[\s*\d+(?:\.\d+)?\s*\])?\s*              # [1.000], how long it takes
    """,
    re.VERBOSE | re.IGNORECASE,
)


class PlanStep(NamedTuple):
    """A step of a plan: the unit that it executes, and its place in the file."""

    unit: FunctionalUnit
    place: Source


def read_plan_text(text: str, file: str, names: NameMap) -> Sequence[PlanStep]:
    """Read the units that a plan executes, in its order; taking an item from the kitchen is no step.

    Raises :class:`InputError` for lines that are no steps of a plan, and for names that the map does not
    have.
    """
    steps: list[PlanStep] = []
    faults: list[Diagnostic] = []
    begun = False
    for number, line in enumerate(split_lines(text), 1):
        content = _COMMENT.sub("", line)
        if not content.strip() or (not begun and _HEAD.fullmatch(content)):
            continue
        begun = True
        step = _STEP.fullmatch(content)
        if step is None:
            faults.append(
                _fault(
                    file,
                    number,
                    line,
                    len(content) - len(content.lstrip()),
                    f"found {content.strip()[:80]!r}, expected a step of a plan, such as (u580-pour)",
                )
            )
            continue
        written = step["listed"] or step["bare"]
        name = written.lower()
        if name in names.units:
            column = step.start("listed" if step["listed"] else "bare") + 1
            steps.append(PlanStep(names.units[name], Source(file, number, column)))
        elif name not in names.taking:
            column = step.start("listed" if step["listed"] else "bare")
            near = difflib.get_close_matches(name, names.units, 3)
            advice = f", such as {' or '.join(near)}" if near else ""
            faults.append(
                _fault(
                    file, number, line, column, f"found {written!r}, expected an action of the map{advice}"
                )
            )
    if faults:
        raise InputError(faults)
    return steps


def _fault(file: str, number: int, line: str, column: int, message: str) -> Diagnostic:
    return Diagnostic(Severity.ERROR, "plan", message, Source(file, number, column + 1), line)
