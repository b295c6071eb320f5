"""The same question as a mixed integer program in HiGHS, handed over whole."""

import time
from collections.abc import Iterable, Sequence
from typing import Any

from contest.elimination import ordered
from contest.instance import Instance, cuts
from foon_asp.hypergraph.highs_run import silent_highs


def ready() -> None:
    """Import what solving needs."""
    import highspy  # noqa: F401, PLC0415
    import numpy as np  # noqa: F401, PLC0415


def solve_mixed_integer(
    instance: Instance, seconds: float, levels: bool, threads: int, elimination: bool = False
) -> list[int] | None:
    """Give the actions of a best tree, or ``None`` where there is none.

    A variable for each action says that it is used; a used one has a used maker for each node it needs. With
    ``levels``, nodes on cycles stand above what they are made of; with ``elimination``, they are eliminated
    one after the other, as Rankooh and Rintanen have it. Else cycles are cut off when an optimum has one, and
    the program is solved again.
    """
    began = time.monotonic()
    program = _Program(instance, threads)
    if levels:
        program.add_levels()
    if elimination:
        program.add_clauses(ordered(instance) or ())
    program.load()
    while True:
        used = program.solve(began + seconds - time.monotonic())
        if used is None:
            return None
        found = cuts(instance, used)
        if not found:
            return used
        program.cut(found)


class _Program:
    """Rows are kept as lists until the whole program is loaded."""

    def __init__(self, instance: Instance, threads: int) -> None:
        self._instance = instance
        self._threads = threads
        self._highs: Any = None
        self._actions = len(instance.units)
        self._upper = [1.0] * self._actions
        self._costs = [float(cost) for cost in instance.costs]
        self._lower: list[float] = []
        self._starts, self._columns, self._values = [0], list[int](), list[float]()
        makers = instance.makers
        for action, needs in enumerate(instance.needs):
            for node in needs:
                self._row(0.0, [*makers[node], action], [*([1.0] * len(makers[node])), -1.0])
        for goal in instance.goals:
            self._row(1.0, makers[goal], [1.0] * len(makers[goal]))

    def add_levels(self) -> None:
        """Let every node on a cycle have one maker in charge, and stand above what that one needs there."""
        instance, sizes = self._instance, self._instance.sizes
        levels: dict[int, int] = {}
        for node, number in enumerate(instance.component):
            if sizes[number] > 1:
                levels[node] = self._column(sizes[number] - 1.0)
        users: dict[int, list[int]] = {node: [] for node in levels}
        for action, needs in enumerate(instance.needs):
            for node in needs:
                if node in users:
                    users[node].append(action)
        for node, level in levels.items():
            charge = []
            size = float(sizes[instance.component[node]])
            for action in instance.makers[node]:
                inner = instance.inner(action, node)
                if not inner:
                    charge.append(action)
                    continue
                column = self._column(1.0)
                charge.append(column)
                self._row(0.0, [action, column], [1.0, -1.0])
                for need in inner:
                    self._row(1.0 - size, [level, levels[need], column], [1.0, -1.0, -size])
            for action in users[node]:
                self._row(0.0, [*charge, action], [*([1.0] * len(charge)), -1.0])
            if node in instance.goals:
                self._row(1.0, charge, [1.0] * len(charge))

    def add_clauses(self, clauses: Iterable[Sequence[int]]) -> None:
        """Add clauses; what is above the actions is a variable of 0 or 1."""
        for clause in clauses:
            for literal in clause:
                while abs(literal) > len(self._costs):
                    self._column(1.0)
            signs = [1.0 if literal > 0 else -1.0 for literal in clause]
            self._row(1.0 - signs.count(-1.0), [abs(literal) - 1 for literal in clause], signs)

    def load(self) -> None:
        """Hand everything to HiGHS."""
        import highspy  # noqa: PLC0415
        import numpy as np  # noqa: PLC0415

        lp: Any = highspy.HighsLp()
        lp.num_col_, lp.num_row_ = len(self._costs), len(self._lower)
        lp.col_cost_, lp.col_upper_ = np.array(self._costs), np.array(self._upper)
        lp.col_lower_ = np.zeros(lp.num_col_)
        lp.row_lower_, lp.row_upper_ = np.array(self._lower), np.full(lp.num_row_, highspy.kHighsInf)
        lp.a_matrix_.format_ = highspy.MatrixFormat.kRowwise
        lp.a_matrix_.start_ = np.array(self._starts, dtype=np.int32)
        lp.a_matrix_.index_ = np.array(self._columns, dtype=np.int32)
        lp.a_matrix_.value_ = np.array(self._values)
        whole, real = highspy.HighsVarType.kInteger, highspy.HighsVarType.kContinuous
        lp.integrality_ = [whole if upper == 1.0 else real for upper in self._upper]
        self._highs = silent_highs()
        options = {"threads": self._threads, "mip_rel_gap": 0.0, "mip_abs_gap": 1e-6}
        for option, value in options.items():
            self._highs.setOptionValue(option, value)
        self._highs.passModel(lp)

    def solve(self, seconds: float) -> list[int] | None:
        """Minimize; give the used actions."""
        import highspy  # noqa: PLC0415

        if not self._actions:
            return None if self._lower else []
        self._highs.setOptionValue("time_limit", float(self._highs.getRunTime() + max(seconds, 0.001)))
        self._highs.run()
        status = self._highs.getModelStatus()
        if status == highspy.HighsModelStatus.kInfeasible:
            return None
        if status == highspy.HighsModelStatus.kTimeLimit:
            raise TimeoutError
        if status != highspy.HighsModelStatus.kOptimal:
            raise RuntimeError(f"HiGHS ends with {status}")
        values = self._highs.getSolution().col_value
        return [action for action in range(self._actions) if values[action] > 0.5]

    def cut(self, found: list[tuple[list[int], int | None]]) -> None:
        """Add rows to the program that is loaded."""
        import highspy  # noqa: PLC0415
        import numpy as np  # noqa: PLC0415

        for supports, user in found:
            columns = supports if user is None else [*supports, user]
            values = [1.0] * len(supports) + [-1.0] * (user is not None)
            row = np.array(columns, dtype=np.int32), np.array(values)
            self._highs.addRow(float(user is None), highspy.kHighsInf, len(columns), *row)

    def _column(self, upper: float) -> int:
        self._upper.append(upper)
        self._costs.append(0.0)
        return len(self._costs) - 1

    def _row(self, lower: float, columns: list[int], values: list[float]) -> None:
        self._lower.append(lower)
        self._columns += columns
        self._values += values
        self._starts.append(len(self._columns))
