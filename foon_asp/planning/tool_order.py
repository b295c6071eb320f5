"""Orders in which the steps of a plan can be done one after the other with the available tools.

A schedule exists if and only if such an order exists. The starts of the steps in a schedule are such an
order: a tool that is in use between the starts of two steps is in use when the second step starts.
"""

from graphlib import TopologicalSorter
from heapq import heappop, heappush, heapreplace
from typing import NamedTuple

from foon_asp.deadline import Deadline
from foon_asp.encoding.clingo_run import run
from foon_asp.encoding.fact_writer import write_tool_order
from foon_asp.encoding.own_encodings import question_encoding
from foon_asp.encoding.run import Run
from foon_asp.planning.schedule_task import ScheduleTask
from foon_asp.proof.timetable import ToolName

_CLINGO_OPTIONS = ("--opt-strategy=usc,oll,4", "--opt-usc-shrink=min")


class ToolOrder(NamedTuple):
    """An order of the steps that the available tools allow, or the tools that are lacking for one.

    ``steps``: the steps in order; ``None`` without an order.
    ``proved``: whether it is proved that there is no order.
    ``lacking``: without an order, maps each tool with too few copies to the number of copies that an order
    needs. The additional copies are the fewest in total. Empty if they are not known.
    """

    steps: tuple[int, ...] | None
    proved: bool
    lacking: dict[ToolName, int]


def tool_order(task: ScheduleTask, deadline: Deadline) -> ToolOrder:
    """Search for an order of the steps; if no order exists, search for the fewest lacking copies of tools.

    Raises ``KeyboardInterrupt`` at ctrl-C, and at a limit that is reached before the first search ends.
    """
    feasible = _run(task, deadline, may_lack=False)
    if feasible.units is not None:
        return ToolOrder(_steps_in_order(task, feasible), False, {})
    if not feasible.exhausted:
        deadline.check()
        raise KeyboardInterrupt
    extended = _run(task, deadline, may_lack=True)
    if not extended.exhausted or extended.units is None:
        return ToolOrder(None, True, {})
    names = list(task.counts)
    lacking: dict[ToolName, int] = {}
    for kind, number in extended.rows["_lacking"]:
        lacking[names[kind]] = max(number, lacking.get(names[kind], 0))
    return ToolOrder(None, True, lacking)


def _run(task: ScheduleTask, deadline: Deadline, may_lack: bool) -> Run:
    """Run clingo for an order of the uses of tools; return the run.

    With ``may_lack``, clingo may add copies of tools, and minimizes their number. Without it, clingo stops at
    the first order.
    """
    kinds = {name: kind for kind, name in enumerate(task.counts)}
    uses = ((kinds[use.name], use.steps) for use in task.uses)
    return run(
        (question_encoding("tool_order.lp"),),
        write_tool_order(list(task.counts.values()), uses, task.after, may_lack),
        _CLINGO_OPTIONS,
        deadline,
        "opt" if may_lack else "ignore",
        predicates=[("_used_before", 2), ("_lacking", 2)],
    )


def _steps_in_order(task: ScheduleTask, answer: Run) -> tuple[int, ...]:
    """Return the steps in a topological order that keeps to the order of uses in clingo's answer.

    If several steps can come next, the first one in the plan is taken.
    """
    sorter = TopologicalSorter[tuple[str, int]]()
    for step, after in enumerate(task.after):
        sorter.add(("step", step), *(("step", earlier) for earlier in after))
    for use, (_, steps) in enumerate(task.uses):
        for step in steps:
            sorter.add(("step", step), ("begin", use))
            sorter.add(("end", use), ("step", step))
    for first, second in answer.rows["_used_before"]:
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
    """Return the starts of steps, in ticks, by list scheduling.

    The steps are placed in the given order. Each starts as soon as the steps that it waits for have ended and
    its tools are free. A step that is not passive also waits for an agent.
    """
    starts, ends = [0] * len(order), [0] * len(order)
    agent_free = [0] * task.agents
    tool_free: dict[ToolName, list[int]] = {name: [0] * count for name, count in task.counts.items()}
    use_ends = [0] * len(task.uses)  # when the last step of a use so far ends
    copy_free = [0] * len(task.sharing)  # when the last step so far that shares a copy ends
    unscheduled = [len(use.steps) for use in task.uses]
    at_step = task.at_step
    for step in order:
        uses = at_step[step]
        start = max((ends[earlier] for earlier in task.after[step]), default=0)
        for use in uses:
            name, steps = task.uses[use]
            start = max(start, heappop(tool_free[name]) if unscheduled[use] == len(steps) else use_ends[use])
        shared = [copy for copy, steps in enumerate(task.sharing) if step in steps]
        start = max(start, *(copy_free[copy] for copy in shared), 0)
        if not task.passive[step]:
            start = max(start, agent_free[0])
            heapreplace(agent_free, start + task.lengths[step])
        starts[step], ends[step] = start, start + task.lengths[step]
        for copy in shared:
            copy_free[copy] = ends[step]
        for use in uses:
            use_ends[use] = ends[step]
            unscheduled[use] -= 1
            if not unscheduled[use]:
                heappush(tool_free[task.uses[use].name], use_ends[use])
    return tuple(starts)
