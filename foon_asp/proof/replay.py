"""Replay of a plan with consumable items, copy by copy, in plain Python and without the solver's code."""

from collections import Counter, deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from itertools import islice
from typing import NamedTuple

from foon_asp.network import FunctionalUnit, ObjectNode
from foon_asp.problem import Problem, UsedUp
from foon_asp.proof.execution import Executions


class Copy(NamedTuple):
    """A copy of an object ``node``.

    ``made`` is the position of the step that made it, from 0; ``None`` if the kitchen had it.
    """

    node: ObjectNode
    made: int | None


class Shortage(NamedTuple):
    """A shortage: ``node`` has fewer copies than are needed at a step or at the end.

    ``step``: the position of the step that lacks copies, from 0; ``None`` if the goals lack them at the end.
    ``consumers``: the positions of the earlier steps that used up copies of the node, ascending.
    ``amount``: the number of copies needed.
    """

    step: int | None
    node: ObjectNode
    consumers: tuple[int, ...]
    amount: int = 1


class Step(NamedTuple):
    """A step that ran.

    ``gone``: the copies that it used up.
    ``stayed``: the copies that it needed and did not use up.
    ``came``: the copies that it made.
    """

    unit: FunctionalUnit
    gone: tuple[Copy, ...]
    stayed: tuple[Copy, ...]
    came: tuple[Copy, ...]


class Replay(NamedTuple):
    """The result of a replay.

    ``steps``: the steps that ran, in order.
    ``shortage``: the shortage that stopped the replay; ``None`` if the plan runs and makes the goals.
    ``left``: the consumable copies that exist after the last step, from the stock or made by steps.
    ``stock``: for each node with a finite stock, the number of initial copies that the plan needs. If a step
    lacks copies, the copies that it needs are included.
    """

    steps: tuple[Step, ...]
    shortage: Shortage | None
    left: tuple[Copy, ...]
    stock: dict[ObjectNode, int]


def replay_for(problem: Problem, plan: Iterable[FunctionalUnit]) -> Replay:
    """Replay a plan from the kitchen of a problem whose items are used up; then look for the goals.

    The replay stops at the first step that lacks a copy. Kitchen items never run out unless the stock counts
    them. A unit that is listed twice runs twice.
    """
    return _Kitchen(problem).run(list(plan))


def replayable_problem(problem: Problem, plan: Iterable[FunctionalUnit]) -> Problem:
    """Return a problem whose items are used up, so that :func:`replay_for` can replay a plan.

    If items of ``problem`` are used up, return it as it is. Otherwise, return a copy in which items are used
    up. In the copy, items with the label of an input of the plan stay.
    """
    if problem.items is not None:
        return problem
    stays: dict[str | ObjectNode, bool] = {node.label: True for unit in plan for node in unit.inputs}
    return replace(problem, items=UsedUp(stays))


def predecessors(replay: Replay) -> Iterator[set[int]]:
    """Yield for each step, in order, the positions of the earlier steps that have to be done before it.

    To *read* a copy is to need it and not to use it up. An earlier step has to come first in two cases. It
    made a copy that the step needs, or it read a copy that the step uses up. Endless nodes cause no order,
    since another copy always exists.
    """
    readers: dict[tuple[Copy, int], set[int]] = {}
    spent: Counter[Copy] = Counter()  # how often an equal copy was used up
    for position, step in enumerate(replay.steps):
        earlier_steps = {copy.made for copy in (*step.gone, *step.stayed) if copy.made is not None}
        for numbered_copy in _numbered_reads(step, spent):
            readers.setdefault(numbered_copy, set()).add(position)
        for copy in step.gone:
            if copy.made is not None or copy.node in replay.stock:
                earlier_steps |= readers.get((copy, spent[copy]), set())
            spent[copy] += 1
        yield earlier_steps


def shared_readers(replay: Replay, is_free: Callable[[str], bool]) -> list[tuple[int, ...]]:
    """Return, for each copy that two or more steps read, the positions of its readers, ascending.

    To *read* a copy is to need it and not to use it up. Endless nodes, which the kitchen has and the stock
    does not count, are omitted. Nodes with a label that ``is_free`` accepts are omitted as well.
    """
    readers: dict[tuple[Copy, int], list[int]] = {}
    spent: Counter[Copy] = Counter()  # as in predecessors
    for position, step in enumerate(replay.steps):
        for copy, copy_number in _numbered_reads(step, spent):
            if (copy.made is not None or copy.node in replay.stock) and not is_free(copy.node.label):
                readers.setdefault((copy, copy_number), []).append(position)
        spent.update(step.gone)
    return [tuple(steps) for steps in readers.values() if len(steps) > 1]


def _numbered_reads(step: Step, spent: Counter[Copy]) -> Iterator[tuple[Copy, int]]:
    """Yield each copy that a step needs and does not use up, with a number that tells equal copies apart.

    Copies are equal if node and maker are equal. Numbers of equal copies begin at 0. Copies that earlier
    steps used up (``spent``) have the first numbers, copies that this step uses up the next ones.
    """
    next_numbers = spent + Counter(step.gone)
    for copy in step.stayed:
        yield copy, next_numbers[copy]
        next_numbers[copy] += 1


class _Kitchen:
    """The kitchen during a replay: endless nodes, and single copies of the others, oldest first."""

    def __init__(self, problem: Problem) -> None:
        """Start with the initial copies of a problem whose items are used up."""
        assert problem.items is not None
        self._executions = Executions(problem)
        self._copies = {
            node: deque([Copy(node, None)] * n) for node, n in self._executions.initial_copies().items()
        }
        self._consumers_of: dict[ObjectNode, list[int]] = {}
        self._made: Counter[ObjectNode] = Counter()  # copies made less copies used up
        self._stock_needed: dict[ObjectNode, int] = dict.fromkeys(self._copies, 0)

    def run(self, plan: Sequence[FunctionalUnit]) -> Replay:
        """Execute the units in order, up to the first that lacks a copy, and return the replay.

        If all units run, the shortage is that of the first goal that lacks copies.
        """
        steps: list[Step] = []
        shortage: Shortage | None = None
        for position, unit in enumerate(plan):
            preconditions = self._executions.of(unit).preconditions
            lacking = [(node, n) for node, n in preconditions.items() if not self._has_copies(node, n)]
            if lacking:
                shortage = self._shortage(position, *lacking[0])
                break
            steps.append(self._run_step(position, unit))
        if shortage is None:
            missing = [
                (node, n)
                for node, n in self._executions.wanted_copies().items()
                if not self._has_copies(node, n)
            ]
            if missing:
                shortage = self._shortage(None, *missing[0])
        remaining = tuple(copy for copies in self._copies.values() for copy in copies)
        return Replay(tuple(steps), shortage, remaining, self._stock_needed)

    def _run_step(self, position: int, unit: FunctionalUnit) -> Step:
        """Execute a unit whose preconditions are available, oldest copies first, and return its step.

        Its outputs become copies made by the step at ``position``.
        """
        preconditions, consumes, adds = self._executions.of(unit)
        gone, stayed, came = list[Copy](), list[Copy](), list[Copy]()
        for node, amount in preconditions.items():
            consumed = consumes.get(node, 0)
            gone += self._take_copies(node, consumed, position)
            endless = self._endless_copy(node)
            unconsumed = amount - consumed
            stayed += [endless] * unconsumed if endless else islice(self._copies[node], unconsumed)
        for node, amount in adds.items():
            copies = [Copy(node, position)] * amount
            came += copies
            if not self._endless_copy(node):
                self._copies.setdefault(node, deque()).extend(copies)
                self._made[node] += amount
        return Step(unit, tuple(gone), tuple(stayed), tuple(came))

    def _endless_copy(self, node: ObjectNode) -> Copy | None:
        """Return a copy that stands for all copies of an endless node; ``None`` for other nodes."""
        return Copy(node, None) if self._executions.is_endless(node) else None

    def _has_copies(self, node: ObjectNode, amount: int) -> bool:
        """Return whether ``amount`` copies of a node exist.

        Also increase the number of initial copies that the plan needs of the node, if its stock is finite.
        """
        if self._endless_copy(node):
            return True
        if node in self._stock_needed:
            self._stock_needed[node] = max(self._stock_needed[node], amount - self._made[node])
        return len(self._copies.get(node, ())) >= amount

    def _take_copies(self, node: ObjectNode, amount: int, position: int) -> list[Copy]:
        """Remove and return the oldest copies of a node, and note the step at ``position`` as their consumer.

        An endless node keeps its copies.
        """
        endless = self._endless_copy(node)
        if endless:
            return [endless] * amount
        if amount:
            self._consumers_of.setdefault(node, []).append(position)
        self._made[node] -= amount
        return [self._copies[node].popleft() for _ in range(amount)]

    def _shortage(self, step: int | None, node: ObjectNode, amount: int) -> Shortage:
        """Return the shortage of a node of which a step needs ``amount`` copies.

        Its consumers are the steps that used up copies of the node so far.
        """
        return Shortage(step, node, tuple(self._consumers_of.get(node, ())), amount)
