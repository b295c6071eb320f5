"""Policies with retries: follow a tree, and after a number of failed executions another one.

The model: an execution of a unit succeeds with its rate, whatever happened before. A failed execution changes
nothing, but a run ends after a limited number of failures. Available nodes stay available.

A policy chooses the next unit by the available nodes and by the number of failures left. The greatest chance
of all policies over the units of some trees is found by dynamic programming over the available nodes. A unit
that is necessary for the goals is executed first. This is never worse: every successful run has to execute it
until it succeeds, and its failures are then known earlier.
"""

import heapq
import itertools
from collections.abc import Iterable, Iterator, Sequence
from fractions import Fraction
from functools import cache
from typing import NamedTuple

from foon_asp.problem import Problem


class PolicyLimits(NamedTuple):
    """Limits of the search for the best policy.

    ``states``: the greatest number of states of the dynamic program; the default takes some seconds.
    Thirteen bundled goals need fewer than 3,000 states.
    ``units``: the greatest number of units in the trees. The dynamic program recurses once for each unit, and
    Python limits the depth of recursion.
    ``policies``: the greatest number of policies that are compared; each is evaluated exactly.
    """

    states: int = 10_000
    units: int = 150
    policies: int = 300


POLICY_LIMITS = PolicyLimits()

State = frozenset[int]
"""The object nodes that are there, by id, without the kitchen."""


class PolicyBranch(NamedTuple):
    """A tree to follow, and after how many failures the next branch begins.

    ``units`` are ids in an order that executes.
    """

    units: tuple[int, ...]
    failures: int


class Policy(NamedTuple):
    """Trees to follow one after the other, and the ``chance`` that the goals are made.

    ``bound`` is a chance that no policy over the units of the trees exceeds. ``is_exact`` says that some
    policy, perhaps not this one, reaches ``bound``.
    """

    branches: tuple[PolicyBranch, ...]
    chance: Fraction
    bound: Fraction
    is_exact: bool


class _TooManyStates(Exception):  # noqa: N818 (is caught here)
    """The exception that there are more states or units than :class:`PolicyLimits` allows."""


def best_policy(problem: Problem, trees: Sequence[tuple[int, ...]], retries: int) -> Policy:
    """Return the policy with the greatest chance among policies that follow some trees one after another.

    The chance of a policy is the probability that it makes the goals. Among policies of equal chance, one
    with the fewest branches is returned. At most :attr:`PolicyLimits.policies` policies are compared, those
    with few branches first. If there are more states or units than :class:`PolicyLimits` allows, ``bound`` is
    only an upper bound.

    Parameters:
        problem: The problem, whose items last, with rates.
        trees: Trees for its goals, at least one, by unit ids in an order that executes.
        retries: How many failed executions a run survives; the next failure ends it.
    """
    units = tuple(dict.fromkeys(unit for tree in trees for unit in tree))
    try:
        bound, is_exact = _Optimum(problem, units, retries).chance, True
    except _TooManyStates:
        bound, is_exact = _bound(problem, units, retries), False
    best: Policy | None = None
    for branches in itertools.islice(_candidates(trees, retries + 1), POLICY_LIMITS.policies):
        chance = _chance(problem, branches)
        if best is None or chance > best.chance:
            best = Policy(branches, chance, bound, is_exact)
        if chance == bound:  # none is better
            break
    assert best is not None
    return best


def _candidates(trees: Sequence[tuple[int, ...]], failures: int) -> Iterator[tuple[PolicyBranch, ...]]:
    """Yield the policies whose branches have this number of failures in total.

    Each policy follows some of the trees, in some order, and no tree twice. Every branch has at least one
    failure. Policies with few branches come first.
    """
    for number in range(1, min(len(trees), failures) + 1):
        for order in itertools.permutations(trees, number):
            for cuts in itertools.combinations(range(1, failures), number - 1):
                shares = (end - begin for begin, end in itertools.pairwise((0, *cuts, failures)))
                yield tuple(map(PolicyBranch, order, shares))


class _ExecutionModel:
    """The preconditions, add effects and rates of units, all without kitchen items.

    The functions ``needs``, ``makes`` and ``rate`` return them by unit id, and cache the results. An add
    effect that is also an input is left out.
    """

    def __init__(self, problem: Problem) -> None:
        """Take the goals, kitchen, rates and units of a problem."""
        self.kitchen, self.goals = problem.kitchen, frozenset(problem.goals) - problem.kitchen
        self.rate = cache(lambda unit: Fraction(problem.rate(unit)))
        self.needs = cache(lambda unit: frozenset(problem.needs[unit]) - problem.kitchen)
        inputs, gives = problem.network.inputs, problem.gives
        self.makes = cache(lambda unit: frozenset(gives[unit]).difference(inputs[unit]) - problem.kitchen)

    def reaches(self, state: State, units: Iterable[int]) -> bool:
        """Whether units can make the goals from the available nodes ``state``, if none fails."""
        available, waiting = set(state), list(units)
        while not self.goals <= available:
            blocked = []
            for unit in waiting:  # one pass is enough where they are in an order that executes
                if self.needs(unit) <= available:
                    available |= self.makes(unit)
                else:
                    blocked.append(unit)
            if len(blocked) == len(waiting):
                return False
            waiting = blocked
        return True

    def is_necessary(self, unit: int, state: State, units: Iterable[int]) -> bool:
        """Whether the goals cannot be made from ``state`` by ``units`` without this unit."""
        return not self.reaches(state, (other for other in units if other != unit))


def _chance(problem: Problem, branches: tuple[PolicyBranch, ...]) -> Fraction:
    """Return the exact chance that the branches, followed one after the other, make the goals.

    A unit whose outputs are all available already is skipped. A branch begins with the nodes that are
    available when the branch before it ends.
    """
    model = _ExecutionModel(problem)
    # by branch, position in it, and minus the failures left: a success and a failure lead to later keys
    waiting = {(0, 0, -branches[0].failures): {State(): Fraction(1)}}
    keys = [*waiting]  # a heap
    reached = Fraction(0)
    while keys:
        key = heapq.heappop(keys)
        branch, position, failures = key
        units = branches[branch].units
        for state, chance in waiting.pop(key).items():
            index = position
            while index < len(units) and model.makes(units[index]) <= state:
                index += 1
            if index == len(units):
                reached += chance
                continue
            unit = units[index]
            rate = model.rate(unit)
            successors = [((branch, index + 1, failures), state | model.makes(unit), rate)]
            if failures < -1:
                successors.append(((branch, index, failures + 1), state, 1 - rate))
            elif branch + 1 < len(branches):
                successors.append(((branch + 1, 0, -branches[branch + 1].failures), state, 1 - rate))
            for following, new_state, share in successors:
                if share:
                    if following not in waiting:
                        waiting[following] = {}
                        heapq.heappush(keys, following)
                    states = waiting[following]
                    states[new_state] = states.get(new_state, 0) + chance * share
    return reached


class _Optimum:
    """The greatest ``chance`` that a policy over some units makes the goals, by dynamic programming.

    A state is the set of available nodes.
    """

    def __init__(self, problem: Problem, units: Sequence[int], retries: int) -> None:
        """Compute the greatest chance; raises :class:`_TooManyStates` beyond the limits."""
        self._model, self._units, self._retries = _ExecutionModel(problem), units, retries
        self._values: dict[State, tuple[Fraction, ...]] = {}
        if len(units) > POLICY_LIMITS.units:
            raise _TooManyStates
        self.chance = self._value(frozenset())[retries]

    def _value(self, state: State) -> tuple[Fraction, ...]:
        """Return the greatest chances from a state, by the number of failures left, from 0 to ``retries``.

        They are kept for further calls. Raises :class:`_TooManyStates` beyond the limit.
        """
        if self._model.goals <= state:
            return (Fraction(1),) * (self._retries + 1)
        if state not in self._values:
            if len(self._values) == POLICY_LIMITS.states:
                raise _TooManyStates
            self._values[state] = ()  # counts while it is being computed
            successes = [
                (self._model.rate(unit), self._value(state | self._model.makes(unit)))
                for unit in self._choices(state)
            ]
            values: list[Fraction] = []
            for failures in range(self._retries + 1):
                failed = values[-1] if failures else Fraction(0)
                outcomes = (rate * value[failures] + (1 - rate) * failed for rate, value in successes)
                values.append(max(outcomes, default=Fraction(0)))
            self._values[state] = tuple(values)
        return self._values[state]

    def _choices(self, state: State) -> list[int]:
        """Return the units that can be executed in a state and add something.

        If one of them is necessary for the goals, only the first such unit is returned.
        """
        model = self._model
        useful = [unit for unit in self._units if not model.makes(unit) <= state]
        ready = [unit for unit in useful if model.needs(unit) <= state]
        return next(([unit] for unit in ready if model.is_necessary(unit, state, useful)), ready)


def _bound(problem: Problem, units: Sequence[int], retries: int) -> Fraction:
    """Return an upper bound on the chance of any policy over the units.

    It is the chance that the necessary units fail at most ``retries`` times in total.
    """
    model = _ExecutionModel(problem)
    chances = [Fraction(1)] + [Fraction(0)] * retries  # by the number of failures so far
    for unit in units:
        if not model.is_necessary(unit, State(), units):
            continue
        rate = model.rate(unit)
        for failures in range(retries + 1):
            one_failure_less = chances[failures - 1] if failures else Fraction(0)  # changed already
            chances[failures] = rate * chances[failures] + (1 - rate) * one_failure_less
    return sum(chances, Fraction(0))
