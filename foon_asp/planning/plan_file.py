"""Reader of plan files: of Fast Downward, Metric-FF, pyperplan, planners of the IPC and unified-planning.

The log that Fast Downward or Metric-FF prints can also be read, if it has a plan.
"""

import difflib
import re
from collections.abc import Sequence
from typing import NamedTuple

from foon_asp.network import FunctionalUnit, Source
from foon_asp.planning.name_map import NameMap
from foon_asp.text.diagnostics import Diagnostic, InputError, Severity
from foon_asp.text.plain_file import split_lines

_COMMENT = re.compile(r"\s*;.*")
_HEADING = re.compile(r"\s*\w*Plan\w*:?\s*")  # of unified-planning: SequentialPlan:
_PLAN_STEP = re.compile(
    r"""\s*
    (?:(?:step\s+)?\d+(?:\.\d+)?\s*:\s*)?           # 0: or 0.000: or step 0:
    (?:\(\s*(?P<listed>[^\s();:]+)\s*\)|            # (u580-pour)
       (?P<bare>[^\s()\[\]:;,]+)(?:\(\s*\))?)       # u580-pour or u580-pour()
    \s*(?:\[\s*\d+(?:\.\d+)?\s*\])?\s*              # [1.000], how long it takes
    """,
    re.VERBOSE | re.IGNORECASE,
)

_STAMP = r"(?:\[t=[^\]]*\]\s*)?"  # of Fast Downward: [t=0.002s, 9948 KB]
_LOG = re.compile(
    r"\[t=|INFO\s|ff: |problem proven unsolvable", re.IGNORECASE
)  # the beginning of a log's line
_PLAN_FOLLOWS = re.compile(rf"{_STAMP}solution found!|ff: found (?:a )?(?:legal )?plan", re.IGNORECASE)
_PLAN_ENDS = re.compile(rf"{_STAMP}plan (?:length|cost):|plan cost:|time spent:", re.IGNORECASE)
_BETWEEN = re.compile(rf"{_STAMP}actual search time:", re.IGNORECASE)
_PLAN_LENGTH = re.compile(rf"{_STAMP}plan length:\s*(\d+)", re.IGNORECASE)
_STAMPED = re.compile(_STAMP)
_STEP_COST = re.compile(r"\s\(\d+\)\s*\Z")  # of a step of Fast Downward: u26-twist (1)


class PlanStep(NamedTuple):
    """A step of a plan: the unit that it executes, and the place of its name in the file."""

    unit: FunctionalUnit
    source: Source


def read_plan_text(text: str, file: str, names: NameMap) -> Sequence[PlanStep]:
    """Return the steps of a plan that execute units, in order; steps that take a kitchen item are left out.

    Names are read without regard to case. Blank lines, comments and headings before the first step are
    skipped. Raises an :class:`InputError` that lists every line that is no step of a plan or has an unknown
    name. Also raises :class:`InputError` for a log without a plan.
    """
    steps: list[PlanStep] = []
    faults: list[Diagnostic] = []
    has_begun = False
    for number, line in _plan_lines(split_lines(text), file):
        content = _COMMENT.sub("", line)
        if not content.strip() or (not has_begun and _HEADING.fullmatch(content)):
            continue
        has_begun = True
        step = _PLAN_STEP.fullmatch(content)
        if step is None:
            faults.append(
                _line_error(
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
            similar = difflib.get_close_matches(name, names.units, 3)
            advice = f", such as {' or '.join(similar)}" if similar else ""
            faults.append(
                _line_error(
                    file, number, line, column, f"found {written!r}, expected an action of the map{advice}"
                )
            )
    if faults:
        raise InputError(faults)
    return steps


def _plan_lines(lines: Sequence[str], file: str) -> Sequence[tuple[int, str]]:
    """Return the lines of a plan with their numbers from 1: all lines, or those of the last plan in a log.

    From the lines of a log, time stamps and costs of steps are removed. Raises :class:`InputError` for a log
    without a plan, and for one whose last plan is cut off or has another length than the log says.
    """
    plan_starts = [index for index, line in enumerate(lines) if _PLAN_FOLLOWS.match(line.strip())]
    if not plan_starts:
        log = next((index for index, line in enumerate(lines) if _LOG.match(line.strip())), None)
        if log is not None:
            message = "found the log of a planner without a plan in it, expected one that found a plan"
            raise InputError([_line_error(file, log + 1, lines[log], 0, message)])
        return list(enumerate(lines, 1))
    first = plan_starts[-1] + 1
    end = next((n for n in range(first, len(lines)) if _PLAN_ENDS.match(lines[n].strip())), None)
    if end is None:
        message = "found a log that ends in the middle of this plan: it is cut off"
        raise InputError([_line_error(file, first, lines[first - 1], 0, message)])
    steps = [
        (number, _without_log_marks(line))
        for number, line in enumerate(lines[first:end], first + 1)
        if line.strip() and not _BETWEEN.match(line.strip())
    ]
    length = _PLAN_LENGTH.match(lines[end].strip())
    if length is not None and int(length[1]) != len(steps):
        message = f"found a plan of {len(steps)} steps above, expected {length[1]}"
        raise InputError([_line_error(file, end + 1, lines[end], 0, message)])
    return steps


def _without_log_marks(line: str) -> str:
    """Return a line of a log with blanks in place of its time stamp, and without the cost of its step."""
    stamp = _STAMPED.match(line)
    blanks = " " * (stamp.end() if stamp else 0)
    return _STEP_COST.sub("", blanks + line[len(blanks) :])


def _line_error(file: str, number: int, line: str, column: int, message: str) -> Diagnostic:
    """Return an error about a place in the file: line ``number`` counts from 1, ``column`` from 0."""
    return Diagnostic(Severity.ERROR, "plan", message, Source(file, number, column + 1), line)
