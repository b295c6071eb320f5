"""A kitchen in which a behaviour tree is executed by py_trees; it knows units, and not their ports."""

import random
from collections import Counter

from foon_asp import Execution, Problem, py_trees_root
from foon_asp.planning.pddl_name import pddl_name
from foon_asp.proof.execution import Executions

SUCCESS = "SUCCESS"


class SimulatedKitchen:
    """What is there of each object node, by its name, while units run that fail with a probability."""

    def __init__(self, problem: Problem, failing: float, seed: int) -> None:
        self._problem, self._failing, self._random = problem, failing, random.Random(seed)
        network = problem.network
        self._name = {
            node: pddl_name("o", network.object_number(o), str(node))
            for o, node in enumerate(network.objects)
        }
        self._unit = {network.unit_number(unit): unit for unit in range(len(network))}
        self._executions = Executions(problem)
        self.there = Counter[str]()
        for o in problem.kitchen:
            stock = problem.stock_of(o) if problem.items is not None else None
            self.there[self._name[network.objects[o]]] = 10**9 if stock is None else stock
        self.executed: list[int] = []
        self.tried = 0

    def is_available(self, name: str) -> bool:
        assert name in self._name.values(), f"no such node: {name}"
        return self.there[name] > 0

    def execute(self, execution: Execution) -> bool | None:
        """Run a unit, which sometimes takes two ticks; nothing may be missing, by the network itself."""
        self.tried += 1
        unit = self._unit[execution.unit]
        needed, used, added = self._executions.of(self._problem.network.unit(unit))
        lacking = [str(node) for node in needed if not self.there[self._name[node]]]
        assert not lacking, f"unit {unit} began without {lacking}"
        if self.tried % 5 == 1:
            return None
        if self._random.random() < self._failing:
            return False
        if self._problem.items is not None:
            self.there.subtract(self._name[node] for node in used)
        self.there.update(self._name[node] for node in added)
        self.executed.append(unit)
        return True

    def holds_goals(self) -> bool:
        return all(self.is_available(self._name[node]) for node in self._problem.goal_nodes)


def run(problem: Problem, xml: str, failing: float, seed: int, ticks: int = 100_000) -> SimulatedKitchen:
    """Tick a tree until it succeeds, and return the kitchen, in which the goals then are."""
    kitchen = SimulatedKitchen(problem, failing, seed)
    root = py_trees_root(xml, kitchen.execute, kitchen.is_available)
    for _ in range(ticks):
        root.tick_once()
        if root.status.name == SUCCESS:
            break
    assert root.status.name == SUCCESS
    assert kitchen.holds_goals()
    return kitchen
