"""The other process: CP-SAT of OR-Tools, which cannot be in one process with HiGHS, looks for a schedule.

It answers with what it finds on the way, and with how it ended.
"""

import threading
from collections.abc import Sequence
from io import FileIO
from typing import Any

from foon_asp.planning.schedule_task import ScheduleTask
from foon_asp.processes.pipe import receive, requests, send
from foon_asp.proof.timetable import ToolName

_WORKERS = 1  # more find no schedule sooner for plans of some hundred steps, and not always the same one


def serve() -> None:
    """Read tasks from standard input, and write what is found to what was standard output."""
    asked, answers = requests(receive)
    try:
        from ortools.sat.python import cp_model  # noqa: PLC0415 (this process alone may have it)
    except ImportError as error:
        send(answers, ("missing", str(error)))
        return
    while True:
        task, known = asked.get()
        send(answers, ("end", _Model(cp_model, task, known).shortest(answers)))


class _Model:
    """The variables of a task: when each step starts, and how long each tool is in use.

    ``known`` is a schedule, by the starts of steps.
    """

    def __init__(self, cp_model: Any, task: ScheduleTask, known: Sequence[int]) -> None:
        self._library, self._task = cp_model, task
        self._model = model = cp_model.CpModel()
        ends = (start + length for start, length in zip(known, task.lengths, strict=True))
        self._end = end = max(ends, default=0)
        self._starts = [model.new_int_var(0, end - length, "") for length in task.lengths]
        self._steps = [
            model.new_fixed_size_interval_var(start, length, "")
            for start, length in zip(self._starts, task.lengths, strict=True)
        ]
        for start, value in zip(self._starts, known, strict=True):
            model.add_hint(start, value)
        for step, after in enumerate(task.after):
            for earlier in after:
                model.add(self._over(earlier) <= self._starts[step])
        by_hand = [each for each, passive in zip(self._steps, task.passive, strict=True) if not passive]
        model.add_cumulative(by_hand, [1] * len(by_hand), task.agents)

    def shortest(self, answers: FileIO) -> str:
        """Look for a shortest schedule; say whether one is ``proved``, or how it ended."""
        model, library = self._model, self._library
        self._hold()
        makespan = model.new_int_var(self._task.bound, self._end, "")
        for step in range(len(self._starts)):
            model.add(self._over(step) <= makespan)
        model.minimize(makespan)
        starts, writing = self._starts, threading.Lock()

        def say(kind: str, value: object) -> None:
            with writing:
                send(answers, (kind, value))

        class Listener(library.CpSolverSolutionCallback):  # type: ignore[misc, name-defined]
            def on_solution_callback(self) -> None:
                say("found", [self.value(start) for start in starts])

        solver = self._solver()
        solver.best_bound_callback = lambda bound: say("bound", bound)
        status = solver.solve(model, Listener())
        return "proved" if status == library.OPTIMAL else str(solver.status_name(status))

    def _hold(self) -> None:
        """Let no more tools be in use than there are, and each at one step at a time."""
        model = self._model
        in_use: dict[ToolName, list[Any]] = {}
        for name, steps in self._task.uses:
            if len(steps) == 1:
                in_use.setdefault(name, []).append(self._steps[steps[0]])
                continue
            begin, end = (model.new_int_var(0, self._end, "") for _ in range(2))
            for step in steps:
                model.add(begin <= self._starts[step])
                model.add(end >= self._over(step))
            model.add_no_overlap([self._steps[step] for step in steps])
            length = model.new_int_var(0, self._end, "")
            in_use.setdefault(name, []).append(model.new_interval_var(begin, length, end, ""))
        for steps in self._task.sharing:
            model.add_no_overlap([self._steps[step] for step in steps])
        for name, intervals in in_use.items():
            model.add_cumulative(intervals, [1] * len(intervals), self._task.counts[name])

    def _over(self, step: int) -> Any:
        return self._starts[step] + self._task.lengths[step]

    def _solver(self) -> Any:
        solver = self._library.CpSolver()
        solver.parameters.num_workers = _WORKERS
        solver.parameters.random_seed = 1
        return solver
