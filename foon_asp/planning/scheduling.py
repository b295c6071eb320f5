"""Schedules of least makespan: from CP-SAT in another process, with agents and tools assigned."""

from collections.abc import Iterator, Sequence
from importlib.util import find_spec
from itertools import accumulate, pairwise
from math import ceil
from typing import NamedTuple

from foon_asp.deadline import Deadline, LimitError
from foon_asp.errors import BugError, UserError
from foon_asp.planning.schedule_task import ScheduleTask
from foon_asp.planning.tool_order import first_schedule, tool_order
from foon_asp.processes.pipe import pack_message
from foon_asp.processes.worker import DiedError, Worker, give_back_worker, take_worker
from foon_asp.proof.timetable import TimedStep, Tool, ToolName

_NOT_INSTALLED = "a schedule needs OR-Tools: pip install 'foon-asp[schedule]'"
_WORKER_KEY = "foon_asp.planning.cp_sat"


class BestSchedule(NamedTuple):
    """The best schedule, or the result that there is none.

    ``starts``: the starts of the steps in ticks; ``None`` without a schedule.
    ``bound``: a lower bound on the makespan, in ticks.
    ``proved``: it is proved that no schedule is shorter, or, without ``starts``, that none exists.
    ``lacking``: without ``starts``, numbers of copies by tool with which a schedule exists; these need the
    fewest additional copies, unless a limit stopped this search.
    """

    starts: tuple[int, ...] | None
    bound: int
    proved: bool
    lacking: dict[ToolName, int]


def shortest(task: ScheduleTask, deadline: Deadline) -> BestSchedule:
    """Minimize the makespan until it is proved optimal, or until a limit or ctrl-C; return the best schedule.

    Raises :class:`UserError` where OR-Tools is not installed.
    """
    if find_spec("ortools") is None:
        raise UserError(_NOT_INSTALLED)
    try:
        order = tool_order(task, deadline)
    except KeyboardInterrupt:  # at a limit, too
        deadline.interrupt()
        starts, lacking = _sequential(task)
        return BestSchedule(starts, task.bound, False, lacking)
    if order.steps is None:
        return BestSchedule(None, task.bound, True, order.lacking or _sequential(task)[1])
    deadline.doing = "scheduling"
    incumbent = first_schedule(task, order.steps)
    bound = task.bound

    def improve(starts: Sequence[int]) -> None:
        nonlocal incumbent
        incumbent = tuple(starts)

    def raise_bound(value: float) -> None:
        nonlocal bound
        bound = max(
            bound, ceil(value - 1e-6)
        )  # a float, in ticks: so little above a whole number is that number

    worker = take_worker(_WORKER_KEY, lambda: Worker(_WORKER_KEY, "schedules are found"))
    try:
        kind, status = worker.ask(
            pack_message((task, incumbent)), deadline, {"found": improve, "bound": raise_bound}
        )
    except LimitError:
        kind, status = "end", "limit"
    except DiedError as died:
        raise BugError(f"CP-SAT {died}") from None
    if kind == "missing":
        worker.end()
        raise UserError(f"{_NOT_INSTALLED} ({status})")
    give_back_worker(_WORKER_KEY, worker)
    if status not in {"proved", "limit"}:
        raise BugError(f"CP-SAT ends with {status}")
    makespan = _makespan(task, incumbent)
    if status == "proved":
        bound = makespan
    return BestSchedule(incumbent, bound, makespan == bound, {})


def _sequential(task: ScheduleTask) -> tuple[tuple[int, ...] | None, dict[ToolName, int]]:
    """Return the schedule of the steps as listed, without overlap, or ``None`` and the lacking tools."""
    spans = [(use.name, min(use.steps), max(use.steps)) for use in task.uses]
    needed = {
        name: max(
            sum(tool == name and first <= step <= last for tool, first, last in spans)
            for step in range(len(task.lengths))
        )
        for name in task.counts
    }
    lacking = {name: number for name, number in needed.items() if number > task.counts[name]}
    starts = tuple(accumulate(task.lengths[:-1], initial=0)) if task.lengths else ()
    return (None, lacking) if lacking else (starts, {})


def _makespan(task: ScheduleTask, starts: Sequence[int]) -> int:
    return max((start + n for start, n in zip(starts, task.lengths, strict=True)), default=0)


def timed_steps(task: ScheduleTask, starts: Sequence[int]) -> list[TimedStep]:
    """Return the steps of a schedule with agents and tools, each as early as these assignments allow."""
    ends = [start + length for start, length in zip(starts, task.lengths, strict=True)]
    active = [step for step, passive in enumerate(task.passive) if not passive]
    agents = _color({step: (starts[step], ends[step]) for step in active})
    spans = [(min(starts[s] for s in use.steps), max(ends[s] for s in use.steps)) for use in task.uses]
    tools: dict[int, Tool] = {}
    for name in task.counts:
        spans_of_tool = {use: spans[use] for use, (tool, _) in enumerate(task.uses) if tool == name}
        tools |= {use: Tool(name, number) for use, number in _color(spans_of_tool).items()}
    after = [set(earlier) for earlier in task.after]
    for earlier, later in _followers(task, starts, spans, agents, tools):
        after[later].add(earlier)
    earliest: dict[int, int] = {}
    for step in sorted(range(len(starts)), key=lambda step: starts[step]):
        earliest[step] = max((earliest[before] + task.lengths[before] for before in after[step]), default=0)
    return [
        TimedStep(
            earliest[step] * task.tick,
            (earliest[step] + task.lengths[step]) * task.tick,
            agents.get(step),
            tuple(tools[use] for use in uses),
        )
        for step, uses in enumerate(task.at_step)
    ]


def _color(spans: dict[int, tuple[int, int]]) -> dict[int, int]:
    """Color an interval graph with numbers from 1; overlapping spans have different numbers.

    Of the free numbers, a span gets the one that has been free the longest.
    """
    free_at: list[int] = []
    numbers: dict[int, int] = {}
    for key, (start, end) in sorted(spans.items(), key=lambda item: (item[1], item[0])):
        free = [number for number, time in enumerate(free_at) if time <= start]
        number = min(free, key=lambda number: (free_at[number], number), default=len(free_at))
        if number == len(free_at):
            free_at.append(end)
        free_at[number] = end
        numbers[key] = number + 1
    return numbers


def _followers(
    task: ScheduleTask,
    starts: Sequence[int],
    spans: Sequence[tuple[int, int]],
    agents: dict[int, int],
    tools: dict[int, Tool],
) -> Iterator[tuple[int, int]]:
    """Return pairs of steps that share an agent, a tool or a copy; the second step follows the first."""
    uses = task.uses
    steps_of_agent: dict[int, list[int]] = {}
    for step, agent in agents.items():
        steps_of_agent.setdefault(agent, []).append(step)
    for steps in (*steps_of_agent.values(), *(use.steps for use in uses), *task.sharing):
        in_order = sorted(steps, key=lambda step: starts[step])
        yield from pairwise(in_order)
    uses_of_tool: dict[Tool, list[int]] = {}
    for use, tool in tools.items():
        uses_of_tool.setdefault(tool, []).append(use)
    for tool_uses in uses_of_tool.values():
        in_order = sorted(tool_uses, key=lambda use: spans[use])
        for first, second in pairwise(in_order):
            yield from ((before, later) for before in uses[first].steps for later in uses[second].steps)
