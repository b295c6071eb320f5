"""The process of CP-SAT, OR-Tools' constraint solver, which cannot be in one process with HiGHS.

It minimizes the makespan of a plan. It sends each better schedule and bound, and at last its status.
"""

import threading
from collections.abc import Sequence
from io import FileIO
from typing import Any

from foon_asp.planning.schedule_task import ScheduleTask
from foon_asp.processes.pipe import become_worker, receive, send
from foon_asp.proof.timetable import ToolName


def serve() -> None:
    """Solve tasks from standard input, in an endless loop; send the answers to the pipe of answers.

    A task comes with an incumbent for :class:`_Model`. Without OR-Tools, send ``missing`` and return.
    """
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

    ``incumbent`` is a feasible schedule, given as the start of each step in ticks. The solver gets it as a
    hint, and its makespan as an upper bound.
    """

    def __init__(self, cp_model: Any, task: ScheduleTask, incumbent: Sequence[int]) -> None:
        """Add the variables and intervals of steps, the precedences and the limit on agents."""
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
        """Search for a schedule of least makespan; return ``proved``, or else the status of CP-SAT.

        Each better schedule is sent as ``found`` with the starts of the steps in ticks, each better bound as
        ``bound`` with a float. To be called once, since it adds constraints to the model.
        """
        model, library = self._model, self._library
        self._constrain_tools()
        makespan = model.new_int_var(self._task.bound, self._end, "")
        for step in range(len(self._starts)):
            model.add(self._end_of(step) <= makespan)
        model.minimize(makespan)
        starts, send_lock = self._starts, threading.Lock()

        def report(kind: str, value: object) -> None:
            """Send a message; CP-SAT calls this from several threads."""
            with send_lock:
                send(answers, (kind, value))

        class Listener(library.CpSolverSolutionCallback):  # type: ignore[misc, name-defined]
            """Callback of CP-SAT that sends each better schedule."""

            def on_solution_callback(self) -> None:
                """Send the starts of the steps, in ticks."""
                report("found", [self.value(start) for start in starts])

        solver = self._solver()
        solver.best_bound_callback = lambda bound: report("bound", bound)
        status = solver.solve(model, Listener())
        return "proved" if status == library.OPTIMAL else str(solver.status_name(status))

    def _constrain_tools(self) -> None:
        """Add the constraints on tools and copies of items.

        A use of a tool occupies one copy, from the start of its first step to the end of its last step. The
        steps of a use do not overlap. Steps that share a copy of an item do not overlap either.
        """
        model = self._model
        in_use: dict[ToolName, list[Any]] = {}
        for name, steps in self._task.uses:
            if len(steps) == 1:
                in_use.setdefault(name, []).append(self._steps[steps[0]])
                continue
            use_start, use_end = (model.new_int_var(0, self._end, "") for _ in range(2))
            for step in steps:
                model.add(use_start <= self._starts[step])
                model.add(use_end >= self._end_of(step))
            model.add_no_overlap([self._steps[step] for step in steps])
            length = model.new_int_var(0, self._end, "")
            in_use.setdefault(name, []).append(model.new_interval_var(use_start, length, use_end, ""))
        for steps in self._task.sharing:
            model.add_no_overlap([self._steps[step] for step in steps])
        for name, intervals in in_use.items():
            model.add_cumulative(intervals, [1] * len(intervals), self._task.counts[name])

    def _end_of(self, step: int) -> Any:
        """Return the end of a step, as an expression of its start variable."""
        return self._starts[step] + self._task.lengths[step]

    def _solver(self) -> Any:
        """Return a solver that is deterministic: it has one worker and a fixed seed."""
        solver = self._library.CpSolver()
        # more workers find no schedule sooner for plans of some hundred steps, and are not deterministic
        solver.parameters.num_workers = 1
        solver.parameters.random_seed = 1
        return solver
