"""Replay of a plan with consumable items, copy by copy, in plain Python and independent of the solver."""

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

    ``made`` is the position of the step that made it, ``None`` for the kitchen.
    """

    node: ObjectNode
    made: int | None


class Shortage(NamedTuple):
    """A shortage: ``node`` has fewer copies than are needed at a step or at the end.

    ``step`` is the position of the step that lacks copies, from 0; ``None`` if the goals lack copies at the
    end. ``consumers`` are the positions of the steps that used up copies of the node, in order. ``amount`` is
    the number of copies needed.
    """

    step: int | None
    node: ObjectNode
    consumers: tuple[int, ...]
    amount: int = 1


class Step(NamedTuple):
    """A step that ran, with the copies that it used up (``gone``), read (``stayed``) and made (``came``)."""

    unit: FunctionalUnit
    gone: tuple[Copy, ...]
    stayed: tuple[Copy, ...]
    came: tuple[Copy, ...]


class Replay(NamedTuple):
    """The result of a replay: the ``steps`` that ran, and the ``shortage`` that stopped it, if one did.

    ``left`` are the copies that exist after the last step, made by steps or remaining from the stock; nodes
    that are not consumable are omitted. ``stock`` maps each node with a finite stock to the number of copies
    that the plan needs.
    """

    steps: tuple[Step, ...]
    shortage: Shortage | None
    left: tuple[Copy, ...]
    stock: dict[ObjectNode, int]


def replay_for(problem: Problem, plan: Iterable[FunctionalUnit]) -> Replay:
    """Replay a plan with consumable items from the kitchen of a problem, up to its goals.

    Kitchen items never run out, except those that the stock counts. A repeated unit runs again.
    """
    return _Kitchen(problem).run(list(plan))


def replayable_problem(problem: Problem, plan: Iterable[FunctionalUnit]) -> Problem:
    """Return a problem in which a plan can be replayed.

    This is the problem itself if its items are used up. If its items last, return a copy whose items can be
    used up, but in which every input of the plan stays.
    """
    if problem.items is not None:
        return problem
    stays: dict[str | ObjectNode, bool] = {node.label: True for unit in plan for node in unit.inputs}
    return replace(problem, items=UsedUp(stays))


def predecessors(replay: Replay) -> Iterator[set[int]]:
    """Yield for each step, in order, the positions of the steps that have to be done before it.

    These are the earlier steps that made a copy that the step needs, or that read a copy that the step uses
    up. Nodes that are not consumable always have another copy.
    """
    readers: dict[tuple[Copy, int], set[int]] = {}
    spent: Counter[Copy] = Counter()  # how often a copy like this was used up: those of a stock are alike
    for number, step in enumerate(replay.steps):
        after = {copy.made for copy in (*step.gone, *step.stayed) if copy.made is not None}
        for read in _numbered_reads(step, spent):
            readers.setdefault(read, set()).add(number)
        for copy in step.gone:
            if copy.made is not None or copy.node in replay.stock:
                after |= readers.get((copy, spent[copy]), set())
            spent[copy] += 1
        yield after


def shared_readers(replay: Replay, is_free: Callable[[str], bool]) -> list[tuple[int, ...]]:
    """Return, for each copy that several steps need and do not use up, the positions of the steps.

    Copies that neither a step made nor the stock counts are omitted, since they never run out. Nodes whose
    label ``is_free`` accepts are omitted, too, since each step can have another copy.
    """
    reading: dict[tuple[Copy, int], list[int]] = {}
    spent: Counter[Copy] = Counter()  # as in predecessors
    for number, step in enumerate(replay.steps):
        for copy, earlier in _numbered_reads(step, spent):
            if (copy.made is not None or copy.node in replay.stock) and not is_free(copy.node.label):
                reading.setdefault((copy, earlier), []).append(number)
        spent.update(step.gone)
    return [tuple(steps) for steps in reading.values() if len(steps) > 1]


def _numbered_reads(step: Step, spent: Counter[Copy]) -> Iterator[tuple[Copy, int]]:
    """Yield each copy that a step reads, with the copy's number among the copies of equal node and maker.

    ``spent`` counts the copies that earlier steps used up; they come first in the numbering, then those that
    this step uses up.
    """
    before = spent + Counter(step.gone)
    for copy in step.stayed:
        yield copy, before[copy]
        before[copy] += 1


class _Kitchen:
    """The state of the kitchen: nodes that are not consumable, and single copies of others, oldest first."""

    def __init__(self, problem: Problem) -> None:
        assert problem.items is not None
        self._executions = Executions(problem)
        self._copies = {
            node: deque([Copy(node, None)] * n) for node, n in self._executions.initial_copies().items()
        }
        self._consumers_of: dict[ObjectNode, list[int]] = {}
        self._made: Counter[ObjectNode] = Counter()  # copies made less copies used up
        self._stock_needed: dict[ObjectNode, int] = dict.fromkeys(self._copies, 0)

    def run(self, plan: Sequence[FunctionalUnit]) -> Replay:
        """Execute the units in order up to the first that lacks a copy; then look for the goals."""
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
        """Execute a unit whose preconditions are available; it takes the oldest copies first."""
        preconditions, consumes, adds = self._executions.of(unit)
        gone, stayed, came = list[Copy](), list[Copy](), list[Copy]()
        for node, amount in preconditions.items():
            used = consumes.get(node, 0)
            gone += self._take_copies(node, used, position)
            endless = self._endless_copy(node)
            kept = amount - used
            stayed += [endless] * kept if endless else islice(self._copies[node], kept)
        for node, amount in adds.items():
            copies = [Copy(node, position)] * amount
            came += copies
            if not self._endless_copy(node):
                self._copies.setdefault(node, deque()).extend(copies)
                self._made[node] += amount
        return Step(unit, tuple(gone), tuple(stayed), tuple(came))

    def _endless_copy(self, node: ObjectNode) -> Copy | None:
        return Copy(node, None) if self._executions.is_endless(node) else None

    def _has_copies(self, node: ObjectNode, amount: int) -> bool:
        """Return whether there are ``amount`` copies of a node, and record that the plan needs them."""
        if self._endless_copy(node):
            return True
        if node in self._stock_needed:
            self._stock_needed[node] = max(self._stock_needed[node], amount - self._made[node])
        return len(self._copies.get(node, ())) >= amount

    def _take_copies(self, node: ObjectNode, amount: int, position: int) -> list[Copy]:
        """Remove and return the oldest copies of a node; copies that are not consumable stay."""
        endless = self._endless_copy(node)
        if endless:
            return [endless] * amount
        if amount:
            self._consumers_of.setdefault(node, []).append(position)
        self._made[node] -= amount
        return [self._copies[node].popleft() for _ in range(amount)]

    def _shortage(self, step: int | None, node: ObjectNode, amount: int) -> Shortage:
        return Shortage(step, node, tuple(self._consumers_of.get(node, ())), amount)
