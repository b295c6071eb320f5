"""The process of CP-SAT, OR-Tools' constraint solver, which cannot be in one process with HiGHS.

It minimizes the makespan of a plan, and sends each better schedule and bound, and at last its status.
"""

import threading
from collections.abc import Sequence
from io import FileIO
from typing import Any

from foon_asp.planning.schedule_task import ScheduleTask
from foon_asp.processes.pipe import become_worker, receive, send
from foon_asp.proof.timetable import ToolName


def serve() -> None:
    """Solve tasks from standard input, and write schedules, bounds and a status to the pipe of answers."""
    tasks, answers = become_worker(receive)
    try:
        from ortools.sat.python import cp_model  # noqa: PLC0415 (this process alone may have it)
    except ImportError as error:
        send(answers, ("missing", str(error)))
        return
    while True:
        task, incumbent = tasks.get()
        send(answers, ("end", _Model(cp_model, task, incumbent).minimize_makespan(answers)))


class _Model:
    """The constraint model of a task: a start variable for each step, an interval for each use of a tool.

    ``incumbent`` is a feasible schedule, as the start of each step in ticks: a hint, and an upper bound.
    """

    def __init__(self, cp_model: Any, task: ScheduleTask, incumbent: Sequence[int]) -> None:
        """Add the variables of steps, the precedences and the limit on agents."""
        self._library, self._task = cp_model, task
        self._model = model = cp_model.CpModel()
        ends = (start + length for start, length in zip(incumbent, task.lengths, strict=True))
        self._end = end = max(ends, default=0)
        self._starts = [model.new_int_var(0, end - length, "") for length in task.lengths]
        self._steps = [
            model.new_fixed_size_interval_var(start, length, "")
            for start, length in zip(self._starts, task.lengths, strict=True)
        ]
        for start, value in zip(self._starts, incumbent, strict=True):
            model.add_hint(start, value)
        for step, after in enumerate(task.after):
            for earlier in after:
                model.add(self._end_of(earlier) <= self._starts[step])
        occupying_agent = [
            interval for interval, passive in zip(self._steps, task.passive, strict=True) if not passive
        ]
        model.add_cumulative(occupying_agent, [1] * len(occupying_agent), task.agents)

    def minimize_makespan(self, answers: FileIO) -> str:
        """Search for a schedule of least makespan; return ``proved`` or CP-SAT's other status."""
        model, library = self._model, self._library
        self._constrain_tools()
        makespan = model.new_int_var(self._task.bound, self._end, "")
        for step in range(len(self._starts)):
            model.add(self._end_of(step) <= makespan)
        model.minimize(makespan)
        starts, send_lock = self._starts, threading.Lock()

        def report(kind: str, value: object) -> None:
            with send_lock:
                send(answers, (kind, value))

        class Listener(library.CpSolverSolutionCallback):  # type: ignore[misc, name-defined]
            def on_solution_callback(self) -> None:
                report("found", [self.value(start) for start in starts])

        solver = self._solver()
        solver.best_bound_callback = lambda bound: report("bound", bound)
        status = solver.solve(model, Listener())
        return "proved" if status == library.OPTIMAL else str(solver.status_name(status))

    def _constrain_tools(self) -> None:
        """Add cumulative constraints: a use of a tool occupies one copy, and its steps do not overlap."""
        model = self._model
        in_use: dict[ToolName, list[Any]] = {}
        for name, steps in self._task.uses:
            if len(steps) == 1:
                in_use.setdefault(name, []).append(self._steps[steps[0]])
                continue
            begin, end = (model.new_int_var(0, self._end, "") for _ in range(2))
            for step in steps:
                model.add(begin <= self._starts[step])
                model.add(end >= self._end_of(step))
            model.add_no_overlap([self._steps[step] for step in steps])
            length = model.new_int_var(0, self._end, "")
            in_use.setdefault(name, []).append(model.new_interval_var(begin, length, end, ""))
        for steps in self._task.sharing:
            model.add_no_overlap([self._steps[step] for step in steps])
        for name, intervals in in_use.items():
            model.add_cumulative(intervals, [1] * len(intervals), self._task.counts[name])

    def _end_of(self, step: int) -> Any:
        return self._starts[step] + self._task.lengths[step]

    def _solver(self) -> Any:
        """Return a deterministic solver."""
        solver = self._library.CpSolver()
        # more workers find no schedule sooner for plans of some hundred steps, and are not deterministic
        solver.parameters.num_workers = 1
        solver.parameters.random_seed = 1
        return solver
