"""Schedules of least makespan: found by CP-SAT in another process, then given agents and tools."""

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
    """The best schedule, or the result that no schedule was found.

    ``starts``: the starts of the steps in ticks; ``None`` without a schedule.
    ``bound``: a lower bound on the makespan, in ticks.
    ``proved``: whether it is proved that no schedule is shorter. Without ``starts``, whether it is proved
    that no schedule exists.
    ``lacking``: maps each tool with too few copies to the number of copies that a schedule needs. Empty if
    there is a schedule. The additional copies are the fewest in total, unless a limit stopped the search.
    """

    starts: tuple[int, ...] | None
    bound: int
    proved: bool
    lacking: dict[ToolName, int]


def shortest_schedule(task: ScheduleTask, deadline: Deadline) -> BestSchedule:
    """Return the schedule of least makespan; at a limit or ctrl-C, the best one found so far.

    A limit and ctrl-C are recorded in the deadline. CP-SAT searches in another process. If there are too few
    tools for a schedule, the result says which are lacking. The search may end before it finds an order that
    the tools allow. Then the steps follow one after the other in the order of the plan, if the tools allow
    this. Raises :class:`UserError` if OR-Tools is not installed.
    """
    if find_spec("ortools") is None:
        raise UserError(_NOT_INSTALLED)
    try:
        order = tool_order(task, deadline)
    except KeyboardInterrupt:  # at a limit, too
        deadline.interrupt()
        starts, lacking = _sequential_schedule(task)
        return BestSchedule(starts, task.bound, False, lacking)
    if order.steps is None:
        return BestSchedule(None, task.bound, True, order.lacking or _sequential_schedule(task)[1])
    deadline.doing = "scheduling"
    incumbent = first_schedule(task, order.steps)
    bound = task.bound

    def improve(starts: Sequence[int]) -> None:
        """Keep a better schedule as the incumbent."""
        nonlocal incumbent
        incumbent = tuple(starts)

    def raise_bound(value: float) -> None:
        """Round a lower bound on the makespan up to whole ticks, and keep it if it is better."""
        nonlocal bound
        # a float, in ticks: so little above a whole number is that number
        bound = max(bound, ceil(value - 1e-6))

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


def _sequential_schedule(task: ScheduleTask) -> tuple[tuple[int, ...] | None, dict[ToolName, int]]:
    """Return the starts of the steps if they are done one after the other as listed, and an empty mapping.

    If a tool has too few copies for that, return ``None`` and a mapping from each such tool to the number of
    copies needed.
    """
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
    """Return the end of the last step, in ticks."""
    return max((start + n for start, n in zip(starts, task.lengths, strict=True)), default=0)


def timed_steps(task: ScheduleTask, starts: Sequence[int]) -> list[TimedStep]:
    """Return the steps of a schedule with their agents and tools, and with times in seconds.

    ``starts`` are in ticks. Agents and tools are assigned so that these starts remain feasible. Then each
    step starts as early as the assignments allow, perhaps earlier than given. A passive step has no agent.
    """
    ends = [start + length for start, length in zip(starts, task.lengths, strict=True)]
    active = [step for step, passive in enumerate(task.passive) if not passive]
    agents = _color_intervals({step: (starts[step], ends[step]) for step in active})
    spans = [(min(starts[s] for s in use.steps), max(ends[s] for s in use.steps)) for use in task.uses]
    tools: dict[int, Tool] = {}
    for name in task.counts:
        spans_of_tool = {use: spans[use] for use, (tool, _) in enumerate(task.uses) if tool == name}
        tools |= {use: Tool(name, number) for use, number in _color_intervals(spans_of_tool).items()}
    after = [set(earlier) for earlier in task.after]
    for earlier, later in _followers(task, starts, spans, agents, tools):
        after[later].add(earlier)
    earliest: dict[int, int] = {}
    for step in sorted(range(len(starts)), key=lambda step: starts[step]):
        earliest[step] = max(
            (earliest[earlier] + task.lengths[earlier] for earlier in after[step]), default=0
        )
    return [
        TimedStep(
            earliest[step] * task.tick,
            (earliest[step] + task.lengths[step]) * task.tick,
            agents.get(step),
            tuple(tools[use] for use in uses),
        )
        for step, uses in enumerate(task.at_step)
    ]


def _color_intervals(spans: dict[int, tuple[int, int]]) -> dict[int, int]:
    """Return a number from 1 for each span, by its key; overlapping spans have different numbers.

    A span is a start and an end. In order of their starts, each span gets the number that has been free the
    longest. This colors an interval graph with the fewest numbers.
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
    """Yield pairs of an earlier and a later step: the earlier step has to end before the later one starts.

    The steps of a pair share an agent, a tool or a copy of an item. Steps that share an agent, a use or a
    copy are sorted by start, and each is paired with the next one. If two uses of a tool follow each other
    directly, every step of the first use is paired with every step of the second. ``spans`` are the start and
    end of each use.
    """
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
