"""The shortest schedule of a task: asked of another process, and put in order."""

from collections.abc import Iterator, Sequence
from importlib.util import find_spec
from itertools import accumulate, pairwise
from math import ceil
from typing import NamedTuple

from foon_asp.deadline import Deadline, LimitError
from foon_asp.errors import BugError, UserError
from foon_asp.planning.schedule_task import ScheduleTask
from foon_asp.planning.tool_order import first_schedule, tool_order
from foon_asp.processes.pipe import packed
from foon_asp.processes.worker import DiedError, Worker, give_back, take
from foon_asp.proof.timetable import TimedStep, Tool, ToolName

_MISSING = "a schedule needs OR-Tools: pip install 'foon-asp[schedule]'"
_KEY = "foon_asp.planning.cp_sat"
_EXACT = 1e-6  # a bound arrives as a float: one so little above a whole number is that number


class Found(NamedTuple):
    """What was found: ``starts`` in ticks, ``None`` without a schedule, and a ``bound`` that none is below.

    ``proved`` says that there is nothing shorter; without a schedule, that there is none. ``lacking`` says
    then how many tools are enough: the fewest more, unless a limit came before that was known.
    """

    starts: tuple[int, ...] | None
    bound: int
    proved: bool
    lacking: dict[ToolName, int]


def shortest(task: ScheduleTask, deadline: Deadline) -> Found:
    """Look for a shortest schedule until the limits, or ctrl-C.

    Raises :class:`UserError` where OR-Tools is not installed.
    """
    if find_spec("ortools") is None:
        raise UserError(_MISSING)
    try:
        order = tool_order(task, deadline)
    except KeyboardInterrupt:  # at a limit, too
        deadline.interrupt()
        starts, lacking = _one_by_one(task)
        return Found(starts, task.bound, False, lacking)
    if order.steps is None:
        return Found(None, task.bound, True, order.lacking or _one_by_one(task)[1])
    deadline.doing = "scheduling"
    best = first_schedule(task, order.steps)
    bound = task.bound

    def found(starts: list[int]) -> None:
        nonlocal best
        best = tuple(starts)

    def bounded(value: float) -> None:
        nonlocal bound
        bound = max(bound, ceil(value - _EXACT))

    worker = take(_KEY, lambda: Worker(_KEY, "schedules are found"))
    try:
        kind, ended = worker.ask(packed((task, best)), deadline, {"found": found, "bound": bounded})
    except LimitError:
        kind, ended = "end", "limit"
    except DiedError as died:
        raise BugError(f"CP-SAT {died}") from None
    if kind == "missing":
        worker.end()
        raise UserError(f"{_MISSING} ({ended})")
    give_back(_KEY, worker)
    if ended not in {"proved", "limit"}:
        raise BugError(f"CP-SAT ends with {ended}")
    if ended == "proved":
        bound = _length(task, best)
    return Found(best, bound, _length(task, best) == bound, {})


def _one_by_one(task: ScheduleTask) -> tuple[tuple[int, ...] | None, dict[ToolName, int]]:
    """Do the steps as listed, one after the other; without enough tools, say how many that takes."""
    spans = [(use.name, min(use.steps), max(use.steps)) for use in task.uses]
    needed = {
        name: max(
            sum(each == name and first <= step <= last for each, first, last in spans)
            for step in range(len(task.lengths))
        )
        for name in task.counts
    }
    lacking = {name: number for name, number in needed.items() if number > task.counts[name]}
    starts = tuple(accumulate(task.lengths[:-1], initial=0)) if task.lengths else ()
    return (None, lacking) if lacking else (starts, {})


def _length(task: ScheduleTask, starts: Sequence[int]) -> int:
    return max((start + n for start, n in zip(starts, task.lengths, strict=True)), default=0)


def timed_steps(task: ScheduleTask, starts: Sequence[int]) -> list[TimedStep]:
    """Say who does each step with what, and let each start as early as that allows."""
    ends = [start + length for start, length in zip(starts, task.lengths, strict=True)]
    active = [step for step, passive in enumerate(task.passive) if not passive]
    agents = _numbers({step: (starts[step], ends[step]) for step in active})
    spans = [(min(starts[s] for s in use.steps), max(ends[s] for s in use.steps)) for use in task.uses]
    tools: dict[int, Tool] = {}
    for name in task.counts:
        own = {use: spans[use] for use, (named, _) in enumerate(task.uses) if named == name}
        tools |= {use: Tool(name, number) for use, number in _numbers(own).items()}
    after = [set(each) for each in task.after]
    for earlier, later in _followers(task, starts, spans, agents, tools):
        after[later].add(earlier)
    early: dict[int, int] = {}
    for step in sorted(range(len(starts)), key=lambda step: starts[step]):
        early[step] = max((early[before] + task.lengths[before] for before in after[step]), default=0)
    return [
        TimedStep(
            early[step] * task.tick,
            (early[step] + task.lengths[step]) * task.tick,
            agents.get(step),
            tuple(tools[use] for use in uses),
        )
        for step, uses in enumerate(task.at_step)
    ]


def _numbers(spans: dict[int, tuple[int, int]]) -> dict[int, int]:
    """Give each span a number from 1 that no other has at the time: the one that is free the longest."""
    free_at: list[int] = []
    numbers: dict[int, int] = {}
    for each, (start, end) in sorted(spans.items(), key=lambda item: (item[1], item[0])):
        free = [number for number, time in enumerate(free_at) if time <= start]
        number = min(free, key=lambda number: (free_at[number], number), default=len(free_at))
        if number == len(free_at):
            free_at.append(end)
        free_at[number] = end
        numbers[each] = number + 1
    return numbers


def _followers(
    task: ScheduleTask,
    starts: Sequence[int],
    spans: Sequence[tuple[int, int]],
    agents: dict[int, int],
    tools: dict[int, Tool],
) -> Iterator[tuple[int, int]]:
    """Return pairs of steps of which the second follows the first: they share a hand, a tool or a copy."""
    uses = task.uses
    hands: dict[int, list[int]] = {}
    for step, agent in agents.items():
        hands.setdefault(agent, []).append(step)
    for steps in (*hands.values(), *(use.steps for use in uses), *task.sharing):
        in_order = sorted(steps, key=lambda step: starts[step])
        yield from pairwise(in_order)
    turns: dict[Tool, list[int]] = {}
    for use, tool in tools.items():
        turns.setdefault(tool, []).append(use)
    for turn in turns.values():
        in_order = sorted(turn, key=lambda use: spans[use])
        for first, second in pairwise(in_order):
            yield from ((before, later) for before in uses[first].steps for later in uses[second].steps)
