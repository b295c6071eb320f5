"""Which use of a tool is first, so that steps can be done one after the other with the tools there are.

There is a schedule if and only if there is such an order: steps in order of their starts are one, since what
is in use between two of them is in use when the second starts.
"""

from graphlib import TopologicalSorter
from heapq import heappop, heappush, heapreplace
from typing import NamedTuple

from foon_asp.deadline import Deadline
from foon_asp.encoding.facts import write_tool_order
from foon_asp.encoding.own_encodings import question_encoding
from foon_asp.encoding.search import run
from foon_asp.grounding.run import Run
from foon_asp.planning.schedule_task import ScheduleTask
from foon_asp.proof.timetable import ToolName

_OPTIONS = ("--opt-strategy=usc,oll,4", "--opt-usc-shrink=min")


class ToolOrder(NamedTuple):
    """The ``steps`` in an order, ``None`` where there is none, and whether that is ``proved``.

    ``lacking`` says then how many tools there have to be, the fewest more, if that is known.
    """

    steps: tuple[int, ...] | None
    proved: bool
    lacking: dict[ToolName, int]


def tool_order(task: ScheduleTask, deadline: Deadline) -> ToolOrder:
    """Look for an order of the steps, and where there is none, for the fewest tools that are lacking.

    Raises ``KeyboardInterrupt`` at a limit while nothing is known, and at ctrl-C.
    """
    found = _run(task, deadline, may_lack=False)
    if found.units is not None:
        return ToolOrder(_steps(task, found), False, {})
    if not found.exhausted:
        deadline.check()
        raise KeyboardInterrupt
    more = _run(task, deadline, may_lack=True)
    if not more.exhausted or more.units is None:
        return ToolOrder(None, True, {})
    names = list(task.counts)
    lacking: dict[ToolName, int] = {}
    for kind, number in more.rows["_lacking"]:
        lacking[names[kind]] = max(number, lacking.get(names[kind], 0))
    return ToolOrder(None, True, lacking)


def _run(task: ScheduleTask, deadline: Deadline, may_lack: bool) -> Run:
    kinds = {name: kind for kind, name in enumerate(task.counts)}
    uses = ((kinds[use.name], use.steps) for use in task.uses)
    return run(
        (question_encoding("tool_order.lp"),),
        write_tool_order(list(task.counts.values()), uses, task.after, may_lack),
        _OPTIONS,
        deadline,
        "opt" if may_lack else "ignore",
        predicates=[("_used_before", 2), ("_lacking", 2)],
    )


def _steps(task: ScheduleTask, found: Run) -> tuple[int, ...]:
    """Put the steps in an order, the first of those listed where there is a choice."""
    sorter = TopologicalSorter[tuple[str, int]]()
    for step, after in enumerate(task.after):
        sorter.add(("step", step), *(("step", each) for each in after))
    for use, (_, steps) in enumerate(task.uses):
        for step in steps:
            sorter.add(("step", step), ("begin", use))
            sorter.add(("end", use), ("step", step))
    for first, second in found.rows["_used_before"]:
        sorter.add(("begin", second), ("end", first))
    sorter.prepare()
    order: list[int] = []
    ready: list[tuple[int, tuple[str, int]]] = []
    while sorter.is_active():
        for node in sorter.get_ready():
            heappush(ready, (node[1] if node[0] == "step" else -1, node))
        _, node = heappop(ready)
        if node[0] == "step":
            order.append(node[1])
        sorter.done(node)
    return tuple(order)


def first_schedule(task: ScheduleTask, order: tuple[int, ...]) -> tuple[int, ...]:
    """Start steps, in an order that tools allow, as early as agents, tools and what they wait for allow."""
    starts, ends = [0] * len(order), [0] * len(order)
    agents = [0] * task.agents
    free: dict[ToolName, list[int]] = {name: [0] * count for name, count in task.counts.items()}
    over = [0] * len(task.uses)  # when the last step of a use so far ends
    free_again = [0] * len(task.sharing)  # when the last step so far that shares a copy ends
    left = [len(use.steps) for use in task.uses]
    at_step = task.at_step
    for step in order:
        uses = at_step[step]
        begin = max((ends[each] for each in task.after[step]), default=0)
        for use in uses:
            name, steps = task.uses[use]
            begin = max(begin, heappop(free[name]) if left[use] == len(steps) else over[use])
        shared = [place for place, steps in enumerate(task.sharing) if step in steps]
        begin = max(begin, *(free_again[place] for place in shared), 0)
        if not task.passive[step]:
            begin = max(begin, agents[0])
            heapreplace(agents, begin + task.lengths[step])
        starts[step], ends[step] = begin, begin + task.lengths[step]
        for place in shared:
            free_again[place] = ends[step]
        for use in uses:
            over[use] = ends[step]
            left[use] -= 1
            if not left[use]:
                heappush(free[task.uses[use].name], over[use])
    return tuple(starts)
