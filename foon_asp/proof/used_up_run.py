"""Search for an order in which a tree with consumable items runs, each of its steps once.

The order is a firing sequence of a Petri net. If more copies of a node are used up than exist in total, there
is no such order. Otherwise, a depth-first search looks for one.
"""

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from foon_asp.network import FunctionalUnit, ObjectNode
from foon_asp.problem import Problem
from foon_asp.proof.execution import Execution, Executions
from foon_asp.proof.replay import Shortage


class UsedUpRun(NamedTuple):
    """The result of a search for an order in which a tree with consumable items runs.

    ``order``: positions of the units in the tree, from 0; the listed order if that runs. ``None`` if no order
    was found.
    ``shortage``: a shortage that kept the search from an order; ``None`` if there is an order or no search.
    ``proved``: whether the result is certain; ``False`` if the search was given up.
    """

    order: tuple[int, ...] | None
    shortage: Shortage | None = None
    proved: bool = True

    @property
    def runs(self) -> bool | None:
        """Whether the tree runs in some order; ``None`` if the search was given up."""
        return None if not self.proved else self.order is not None


def used_up_run(problem: Problem, tree: Iterable[FunctionalUnit]) -> UsedUpRun:
    """Search for an order in which each step of a tree runs once, from the kitchen to the goals.

    The caller has checked that the tree makes its goals if items last (:func:`simulate_for`). If items last
    in the problem, the rule of docs/plans.md says what is used up, and kitchen items never run out. A unit
    that is listed several times runs as many times. Below level 3, consumption depends on contents, so
    nothing is searched or proved.

    Parameters:
        problem: The problem that the tree is for.
        tree: The units in the order listed.
    """
    if problem.network.level < 3:
        return UsedUpRun(None, proved=False)
    executions = Executions(problem)
    executed, wanted_copies = [executions.of(unit) for unit in tree], executions.wanted_copies()
    nodes = set(wanted_copies).union(
        *(copies for step in executed for copies in (step.preconditions, step.adds))
    )
    endless = set(filter(executions.is_endless, nodes))

    def without_endless(copies: Mapping[ObjectNode, int]) -> Mapping[ObjectNode, int]:
        """Return the numbers of copies without nodes that never run out."""
        if endless.isdisjoint(copies):
            return copies
        return {node: n for node, n in copies.items() if node not in endless}

    steps = [Execution(*map(without_endless, step)) for step in executed]
    stock, goals = executions.initial_copies(), without_endless(wanted_copies)
    first_shortage = _shortage_as_listed(steps, stock, goals)
    if first_shortage is None:
        return UsedUpRun(tuple(range(len(steps))))
    overdrawn = _total_shortage(steps, stock, goals)
    if overdrawn is not None:
        return UsedUpRun(None, overdrawn)
    search = _OrderSearch(steps, stock, goals)
    order = search.find_order()
    shortage = None if order else search.dead_end or first_shortage
    return UsedUpRun(order, shortage, order is not None or search.looks_left > 0)


def _shortage_as_listed(
    steps: Sequence[Execution], stock: Mapping[ObjectNode, int], goals: Mapping[ObjectNode, int]
) -> Shortage | None:
    """Execute the steps as listed; return the first shortage of a step or goal, or ``None`` without one."""
    copies, consumers = dict(stock), dict[ObjectNode, list[int]]()

    def missing(step: int | None, required: Mapping[ObjectNode, int]) -> Shortage | None:
        """Return the shortage of required copies at a step; ``None`` if nothing is missing.

        The step ``None`` stands for the goals at the end.
        """
        for node, amount in required.items():
            if copies.get(node, 0) < amount:
                return Shortage(step, node, tuple(consumers.get(node, ())), amount)
        return None

    for step, (preconditions, consumes, adds) in enumerate(steps):
        shortage = missing(step, preconditions)
        if shortage is not None:
            return shortage
        for node, amount in consumes.items():
            copies[node] -= amount
            consumers.setdefault(node, []).append(step)
        for node, amount in adds.items():
            copies[node] = copies.get(node, 0) + amount
    return missing(None, goals)


def _total_shortage(
    steps: Sequence[Execution], stock: Mapping[ObjectNode, int], goals: Mapping[ObjectNode, int]
) -> Shortage | None:
    """Return a shortage that every order of the steps has; ``None`` without one.

    A node has such a shortage if steps use up more copies of it than the stock has and all steps add. A goal
    has one if steps use up copies of it, and all steps together leave fewer than are wanted.
    """
    copies = dict(stock)
    for step in steps:
        for node, amount in step.adds.items():
            copies[node] = copies.get(node, 0) + amount
    consumers: dict[ObjectNode, list[int]] = {}
    for position, step in enumerate(steps):
        for node, amount in step.consumes.items():
            remaining = copies.get(node, 0)
            if remaining < amount:
                return Shortage(position, node, tuple(consumers.get(node, ())), amount)
            copies[node] = remaining - amount
            consumers.setdefault(node, []).append(position)
    lacking = (node for node, n in goals.items() if copies.get(node, 0) < n and node in consumers)
    goal = next(lacking, None)
    return None if goal is None else Shortage(None, goal, tuple(consumers[goal]), goals[goal])


class _OrderSearch:
    """A depth-first search for an order of steps, which tries steps in the order listed.

    ``looks_left``: the number of steps that the search may still examine; at 0, it is given up.
    ``dead_end``: the shortage after the longest partial order so far that no step could continue. ``None`` if
    there is no such order, or if no step used up copies of what is missing.
    """

    def __init__(
        self, steps: Sequence[Execution], copies: Counter[ObjectNode], goals: Mapping[ObjectNode, int]
    ) -> None:
        """Make all steps wait, and count how many copies of each node they use up and read."""
        self._steps, self._copies, self._goals = steps, copies, goals
        self.looks_left = 100_000  # some 50 ms; no tree of the corpus takes 1,000
        self.dead_end: Shortage | None = None
        # the waiting steps in the order listed, as a ring; its sentinel is the number after the last step
        self._next = [*range(1, len(steps) + 1), 0]
        self._previous = [len(steps), *range(len(steps))]
        self._done = 0  # a bit for each done step
        self._consumers: Counter[ObjectNode] = Counter()  # copies that waiting steps use up
        self._readers: Counter[ObjectNode] = Counter()  # waiting steps that read a node
        self._most_read: Counter[ObjectNode] = Counter()  # most copies that one step reads
        for waiting in steps:
            self._consumers.update(waiting.consumes)
            for node, read in _copies_read(waiting):
                self._readers[node] += 1
                self._most_read[node] = max(self._most_read[node], read)

    def find_order(self) -> tuple[int, ...] | None:
        """Return the steps in an order that runs; ``None`` if no order runs or the search is given up.

        It also sets ``dead_end`` and ``looks_left``. The caller has made sure that steps use up no more
        copies than exist and are added in total. The copies of goals then suffice at the end.
        """
        done: list[int] = []
        dead: set[int] = set()  # sets of done steps that no order continues
        choices, longest = [self._next_steps(dead)], -1
        while choices:
            step = next(choices[-1], None)
            if step is not None:
                self._do_step(step)
                done.append(step)
                if len(done) == len(self._steps):
                    return tuple(done)
                choices.append(self._next_steps(dead))
                continue
            if len(done) > longest:
                longest, self.dead_end = len(done), self._missing_copies(done)
            if self.looks_left <= 0:
                return None
            dead.add(self._done)
            choices.pop()
            if done:
                self._undo_step(done.pop())
        return None

    def _next_steps(self, dead: set[int]) -> Iterator[int]:
        """Yield the waiting steps that can be next, in the order listed.

        After a step that leaves enough copies for all other waiting steps, no other step needs to be tried.
        So this step is the last one yielded. ``dead`` has sets of done steps, as bit masks, from which no
        order continues. If the present set of done steps is in ``dead``, nothing is yielded.
        """
        end = len(self._steps)
        step = end if self._done in dead else self._next[end]
        while step != end and self.looks_left > 0:
            self.looks_left -= 1
            execution = self._steps[step]
            if all(self._copies[node] >= n for node, n in execution.preconditions.items()):
                yield step
                if all(map(self._is_plentiful, execution.consumes)):
                    return
            step = self._next[step]

    def _missing_copies(self, done: Sequence[int]) -> Shortage | None:
        """Return the first shortage of a waiting step that done steps caused by using up copies.

        ``done`` has the done steps. Return ``None`` if there is no such shortage.
        """
        step = self._next[-1]
        while step != len(self._steps):
            for node, amount in self._steps[step].preconditions.items():
                consumers = tuple(
                    done_step for done_step in sorted(done) if node in self._steps[done_step].consumes
                )
                if consumers and self._copies[node] < amount:
                    return Shortage(step, node, consumers, amount)
            step = self._next[step]
        return None

    def _is_plentiful(self, node: ObjectNode) -> bool:
        """Return whether a node has enough copies for all waiting steps and for the goals, in any order."""
        reserved = max(self._goals.get(node, 0), self._most_read[node] if self._readers[node] else 0)
        return self._copies[node] >= self._consumers[node] + reserved

    def _do_step(self, step: int) -> None:
        """Execute a step that waits, and take it out of the ring of waiting steps."""
        previous, following = self._previous[step], self._next[step]
        self._next[previous], self._previous[following] = following, previous
        self._execute(step, 1)

    def _undo_step(self, step: int) -> None:
        """Undo the step that was done last, and put it back into the ring of waiting steps."""
        self._execute(step, -1)
        self._next[self._previous[step]] = self._previous[self._next[step]] = step

    def _execute(self, step: int, sign: int) -> None:
        """Execute a waiting step on all counts of copies and waiting steps; undo it with a ``sign`` of -1."""
        self._done ^= 1 << step
        _, consumes, adds = self._steps[step]
        for node, _ in _copies_read(self._steps[step]):
            self._readers[node] -= sign
        for node, amount in consumes.items():
            self._consumers[node] -= sign * amount
            self._copies[node] -= sign * amount
        for node, amount in adds.items():
            self._copies[node] += sign * amount


def _copies_read(step: Execution) -> Iterator[tuple[ObjectNode, int]]:
    """Yield each node of which a step needs more copies than it uses up, and the surplus."""
    for node, amount in step.preconditions.items():
        if amount > step.consumes.get(node, 0):
            yield node, amount - step.consumes.get(node, 0)
