"""Compilation of constraints into a network: additional nodes, steps and limits.

A *step* is like a unit without cost that only constraints know. docs/dev/certificates.md explains its use.
"""

from collections.abc import Iterable, Mapping, Sequence
from fractions import Fraction
from typing import NamedTuple

from foon_asp.proof.rule_meaning import Barred, Meaning, Units


class Limit(NamedTuple):
    """A limit on a sum: the amounts of units and steps, by number, and the greatest sum."""

    amounts: Mapping[int, Fraction]
    max_sum: Fraction

    def remaining(self, used: Iterable[int]) -> Fraction:
        """Return the greatest sum less the amounts of the units and steps in ``used``."""
        return self.max_sum - sum(self.amounts.get(member, 0) for member in used)


class CompiledRules:
    """Constraints, compiled into nodes, steps and limits of a network.

    New nodes are numbered after those of the network. A step makes one new node once all its preconditions
    are available, and costs nothing. A tree uses a step if one of its units needs the step's node, or if this
    node is a goal. A tree satisfies the constraints if all that follows holds:

    ``removed``: it has no unit of this set.
    ``goals``: it makes each new node of this list.
    ``limits``: it keeps to each limit. A limit by ``max_sum`` of a :class:`Meaning` has the number of the
    constraint. Limits in ``limits`` of a meaning have numbers after those of all constraints.
    ``never``: this set is empty. It has the numbers of constraints that no tree satisfies.
    ``barred``: it has no unit that a function of this dictionary returns (:class:`Meaning`). The keys are the
    numbers of the constraints.

    ``gives`` and ``needs`` map a unit to the new nodes that it makes and needs. ``steps`` maps a step to its
    preconditions and its node. ``makers`` maps a new node to the units and steps that make it.
    """

    def __init__(self, meanings: Sequence[Meaning], first_node: int, first_step: int) -> None:
        """Compile meanings of constraints; new nodes and steps are numbered from the given numbers on."""
        self.removed: Units = frozenset().union(*(meaning.removed for meaning in meanings))
        self.never = {index for index, meaning in enumerate(meanings) if meaning.never}
        self.barred: dict[int, Barred] = {
            index: meaning.barred for index, meaning in enumerate(meanings) if meaning.barred
        }
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
        further = (limit for meaning in meanings for limit in meaning.limits)
        self.limits.update((number, Limit(*limit)) for number, limit in enumerate(further, len(meanings)))

    def barred_units(self, used: Units, without: Units) -> dict[int, Units]:
        """Return the units that each constraint of ``barred`` bars, by number of the constraint.

        No tree with all units of ``used`` and none of ``without`` has a barred unit.
        """
        return {number: barred(used, without) for number, barred in self.barred.items()}

    def fault(self, units: Units, others: Units) -> str | None:
        """Return in words why a tree of ``units`` breaks constraints; ``None`` if it satisfies them.

        ``others`` are the units that the tree does not have.
        """
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
        """Return the units of a tree together with the steps that it uses."""
        made = {node for unit in units for node in self.gives.get(unit, ())}
        required = {node for unit in units for node in self.needs.get(unit, ())}.union(self.goals)
        steps = (
            step for step, (needs, node) in self.steps.items() if node in required and made.issuperset(needs)
        )
        return units.union(steps)

    def _add_node(self) -> int:
        """Add a node that nothing makes yet, and return its number."""
        node = self._first_node + len(self.makers)
        self.makers[node] = []
        return node

    def _add_step(self, needs: Sequence[int], node: int) -> int:
        """Add a step that makes ``node`` from the nodes ``needs``, and return its number."""
        step = self._first_step + len(self.steps)
        self.steps[step] = needs, node
        self.makers[node].append(step)
        return step

    def _add_achievers(self, node: int, units: Units) -> None:
        """Add each of the units as a maker of a new node."""
        for unit in sorted(units):
            self.gives.setdefault(unit, []).append(node)
            self.makers[node].append(unit)

    def _counting_member(self, units: Units) -> int:
        """Return a unit or step, by number, that a tree has if and only if it has a unit of the set.

        If the set has one unit, return this unit. Otherwise, add a step and return its number. All units of
        the set then need the node that the step makes.
        """
        if len(units) == 1:
            (only,) = units
            return only
        node = self._add_node()
        for unit in units:
            self.needs.setdefault(unit, []).append(node)
        return self._add_step((), node)
