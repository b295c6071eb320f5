"""Compilation of constraints into a network: additional nodes, steps and limits."""

from collections.abc import Iterable, Mapping, Sequence
from fractions import Fraction
from typing import NamedTuple

from foon_asp.proof.rule_meaning import Barred, Meaning, Units


class Limit(NamedTuple):
    """A limit on a sum: the amount of each unit or step, and the greatest sum."""

    amounts: Mapping[int, Fraction]
    max_sum: Fraction

    def remaining(self, used: Iterable[int]) -> Fraction:
        """Return the greatest sum less the amounts of used units and steps."""
        return self.max_sum - sum(self.amounts.get(member, 0) for member in used)


class CompiledRules:
    """Constraints as nodes, steps and limits, numbered after the nodes and the units of a network.

    ``gives`` and ``needs`` map a unit to the additional nodes that it makes and needs. A step makes its node
    once all nodes that it needs are available, and costs nothing; ``steps`` maps it to its preconditions and
    its node. A tree uses a step if one of its units needs the step's node, or if this node is a goal.
    ``makers`` maps each additional node to the units and steps that make it.

    A tree that keeps to the constraints has no unit of ``removed``, reaches the nodes ``goals``, and stays
    within each of the ``limits``. If ``never`` is not empty, there is no such tree. ``barred`` has functions
    that find further units that no tree has (:class:`Meaning`). A limit has the number of its constraint;
    limits of constraints that may have several are numbered after all constraints.
    """

    def __init__(self, meanings: Sequence[Meaning], first_node: int, first_step: int) -> None:
        """Compile the meanings of constraints into new nodes, steps and limits."""
        self.removed: Units = frozenset().union(*(meaning.removed for meaning in meanings))
        self.never = {index for index, meaning in enumerate(meanings) if meaning.never}
        self.barred: dict[int, Barred] = {p: m.barred for p, m in enumerate(meanings) if m.barred}
        self.goals: list[int] = []
        self.makers: dict[int, list[int]] = {}
        self.gives: dict[int, list[int]] = {}
        self.needs: dict[int, list[int]] = {}
        self.steps: dict[int, tuple[Sequence[int], int]] = {}
        self.limits: dict[int, Limit] = {}
        self._first_node, self._first_step = first_node, first_step
        for index, meaning in enumerate(meanings):
            for alternatives in meaning.requirements:
                goal = self._add_node()
                self.goals.append(goal)
                for sets in alternatives:
                    nodes = [goal] if len(sets) == 1 else [self._add_node() for _ in sets]
                    for node, units in zip(nodes, sets, strict=True):
                        self._add_achievers(node, units)
                    if nodes != [goal]:
                        self._add_step(nodes, goal)
            if meaning.max_sum is not None:
                amounts: dict[int, Fraction] = {}
                for units, amount in meaning.counted_sets:
                    member = self._counting_member(units)
                    amounts[member] = amounts[member] + amount if member in amounts else amount
                self.limits[index] = Limit(amounts, meaning.max_sum)
        several = (limit for meaning in meanings for limit in meaning.limits)
        self.limits.update((len(meanings) + number, Limit(*limit)) for number, limit in enumerate(several))

    def barred_units(self, used: Units, without: Units) -> dict[int, Units]:
        """Return the barred units of each constraint, by its number.

        No tree with all used units and none of ``without`` has a barred unit.
        """
        return {number: barred(used, without) for number, barred in self.barred.items()}

    def fault(self, units: Units, others: Units) -> str | None:
        """Return why a tree with all ``units`` and none of ``others`` breaks constraints, else ``None``."""
        members = self.units_and_steps(units)
        if removed := self.removed & units:
            return f"has unit {min(removed)}, which a rule removes"
        if not all(any(m in members for m in self.makers[goal]) for goal in self.goals):
            return "lacks what a rule asks for"
        if any(limit.remaining(members) < 0 for limit in self.limits.values()):
            return "exceeds what a rule limits"
        if self.never or any(units & barred for barred in self.barred_units(units, others).values()):
            return "breaks a rule"
        return None

    def units_and_steps(self, units: Units) -> Units:
        """Return a tree's units together with the steps that it uses."""
        made = {node for unit in units for node in self.gives.get(unit, ())}
        required = {node for unit in units for node in self.needs.get(unit, ())}.union(self.goals)
        steps = (
            step for step, (needs, node) in self.steps.items() if node in required and made.issuperset(needs)
        )
        return units.union(steps)

    def _add_node(self) -> int:
        """Add a node, and return its number."""
        node = self._first_node + len(self.makers)
        self.makers[node] = []
        return node

    def _add_step(self, needs: Sequence[int], node: int) -> int:
        """Add a step that makes a node from others, and return its number."""
        step = self._first_step + len(self.steps)
        self.steps[step] = needs, node
        self.makers[node].append(step)
        return step

    def _add_achievers(self, node: int, units: Units) -> None:
        for unit in sorted(units):
            self.gives.setdefault(unit, []).append(node)
            self.makers[node].append(unit)

    def _counting_member(self, units: Units) -> int:
        """Return the member that counts once for a set of units.

        It is the only unit of the set, or a new step that all units of the set need.
        """
        if len(units) == 1:
            (only,) = units
            return only
        node = self._add_node()
        for unit in units:
            self.needs.setdefault(unit, []).append(node)
        return self._add_step((), node)
