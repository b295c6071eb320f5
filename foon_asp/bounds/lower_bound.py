"""Proofs that no derivation costs less than one in hand: weighted landmarks, and branching at a gap.

Weights on landmarks that overload no action (what the landmarks of an action weigh together is at most its
cost) add up to a lower bound on the cost of every derivation. The best such weights solve the dual of the
linear relaxation of hitting every landmark; landmarks are added as long as one is found that the relaxed
solution does not hit (Bonet and Helmert 2010; Haslum, Slaney and Thiébaux 2012 for the hitting sets).
"""

import random
from collections.abc import Callable, Iterable, Sequence
from fractions import Fraction
from typing import NamedTuple

from foon_asp.bounds.cut import Cut, Cutter
from foon_asp.bounds.exact_optimum import ExactOptimum, exact_optimum
from foon_asp.bounds.hypergraph import Hypergraph
from foon_asp.bounds.lexicographic import Lexicographic, Vector
from foon_asp.bounds.relaxation import Covering, Relaxed

_HIT = 1 - 1e-6  # a landmark of a greater share is taken to be hit
_ORDERS = 3  # in how many orders cuts are grown before the relaxation counts as the best there is
_FINER = 1e-4  # how much less a level counts than the one before, in floats


class Packing(NamedTuple):
    """Weighted cuts; with the costs of the actions taken as used, the weights add up to a lower bound."""

    weights: tuple[tuple[Cut, Vector], ...]


class Hopeless(NamedTuple):
    """A cut without members: under the branches taken, nothing reaches the targets."""

    cut: Cut


class Branch(NamedTuple):
    """Two proofs: for all derivations without an action, and for all those with it."""

    action: int
    without: "Proof"
    using: "Proof"


Proof = Packing | Hopeless | Branch


class CheaperError(Exception):
    """A derivation was found that costs less than the one to be proved best."""

    def __init__(self, actions: Sequence[int]) -> None:
        super().__init__("a cheaper derivation was found")
        self.actions = tuple(actions)


class _TimeUpError(Exception):
    pass


class Prover:
    """Looks for proofs about one hypergraph, its targets and the cost of each action.

    Derivations with an action of ``forbidden`` do not count. ``expired`` says when to give up; it is asked
    between steps that take milliseconds on thousands of actions.
    """

    def __init__(
        self,
        graph: Hypergraph,
        targets: Sequence[int],
        costs: Sequence[Vector],
        order: Lexicographic,
        forbidden: frozenset[int] = frozenset(),
        expired: Callable[[], bool] = lambda: False,
        known: Iterable[Iterable[int]] = (),
    ) -> None:
        self._known = tuple(known)
        self._graph, self._targets, self._costs, self._order = graph, targets, costs, order
        self._forbidden, self._expired = forbidden, expired
        self._random = random.Random(1)
        floats = {cost: order.approximate(cost) for cost in set(costs)}
        scale, scales = 1.0, []
        for level, rates in enumerate(order.levels):
            largest = max((f[level] for f in floats.values()), default=0.0)
            if rates and largest > 0:  # rates may all be next to 1, where a solver would see nothing
                scales.append(scale / largest)
                scale *= _FINER / 2
            else:
                scales.append(scale)
                scale *= _FINER / (1 + largest)
        self._scales = scales

    def scaled(self, vector: Vector) -> float:
        """Give a cost as one float, in which a level counts much less than the one before it."""
        values = self._order.approximate(vector)
        return sum(value * scale for value, scale in zip(values, self._scales, strict=True))

    def prove(self, derivation: Iterable[int]) -> Proof | None:
        """Prove that no derivation costs less than this one; ``None`` where that takes too long.

        Raises :class:`CheaperError` when one is met that does.
        """
        actions = frozenset(derivation)
        try:
            return self._prove(actions, self._total(actions), frozenset(), self._forbidden)
        except _TimeUpError:
            return None

    def relax(self, derivation: Iterable[int]) -> tuple[Packing, Vector] | None:
        """Give the weights, and their sum, that the relaxation alone has to offer: a lower bound.

        Cuts are grown with a good derivation in mind. ``None`` where there was no time, and where the targets
        are out of reach.
        """
        cutter = Cutter(self._graph, self._targets, self._forbidden)
        if cutter.hopeless:
            return None
        try:
            node = _Node(self, cutter, frozenset(derivation), frozenset())
            exact = node.relax(None)
        except _TimeUpError:
            return None
        return None if exact is None else (node.packing(exact), exact.value)

    def _prove(
        self, derivation: frozenset[int], goal: Vector, used: frozenset[int], forbidden: frozenset[int]
    ) -> Proof:
        """Prove that derivations with the used actions and none of the forbidden cost at least ``goal``."""
        targets = [*self._targets, *(o for action in sorted(used) for o in self._graph.needs[action])]
        cutter = Cutter(self._graph, targets, forbidden)
        if cutter.hopeless:
            return Hopeless(cutter.hopeless)
        root = not used and forbidden == self._forbidden
        known = [cutter.widened(objects) for objects in self._known] if root else []
        base = self._total(used)
        left = tuple(g - b for g, b in zip(goal, base, strict=True))
        if self._order.sign(left) <= 0:
            return Packing(())
        packing = self._share_out(known)
        total = self._order.total(weight for _, weight in packing.weights)
        if self._order.sign(_minus(total, left)) >= 0:
            return packing
        node = _Node(self, cutter, frozenset() if derivation & forbidden else derivation, used)
        node.add(known)
        exact = node.relax(left)
        if exact is not None and self._order.sign(_minus(exact.value, left)) >= 0:
            return node.packing(exact)
        action = node.undecided(exact)
        if action is None:
            taken = node.taken(exact)
            if cutter.reached_by(taken) and self._order.sign(_minus(self._total(taken), goal)) < 0:
                raise CheaperError(taken)
            raise _TimeUpError  # floats led nowhere
        return Branch(
            action,
            self._prove(derivation, goal, used, forbidden | {action}),
            self._prove(derivation, goal, used | {action}, forbidden),
        )

    def _share_out(self, cuts: Iterable[Cut]) -> Packing:
        """Give each cut in turn the weight that its members have left of their costs."""
        left: dict[int, Vector] = {}
        weights: list[tuple[Cut, Vector]] = []
        for cut in cuts:
            rests = [left.get(a, self._costs[a]) for a in cut.members]
            weight = rests[0]
            for rest in rests[1:]:
                if rest != weight and self._order.sign(_minus(rest, weight)) < 0:
                    weight = rest
            if self._order.sign(weight) > 0:
                weights.append((cut, weight))
                left.update((a, _minus(rest, weight)) for a, rest in zip(cut.members, rests, strict=True))
        return Packing(tuple(weights))

    def _total(self, actions: Iterable[int]) -> Vector:
        return self._order.total(self._costs[a] for a in actions)


class _Node:
    """The relaxation at one place of the branching: cuts, their rows, and who covers them."""

    def __init__(
        self, prover: Prover, cutter: Cutter, derivation: frozenset[int], used: frozenset[int]
    ) -> None:
        self._prover, self._cutter, self._derivation, self._used = prover, cutter, derivation, used
        self._actions = [a for a in cutter.actions if a not in used]
        self._places = {action: place for place, action in enumerate(self._actions)}
        self._costs = [prover._costs[action] for action in self._actions]
        floats = {cost: prover.scaled(cost) for cost in set(self._costs)}
        self._floats = [floats[cost] for cost in self._costs]
        self._covering = Covering(self._floats)
        self._cuts: list[Cut] = []
        self._rows: list[list[int]] = []
        self._seen: set[tuple[int, ...]] = set()
        self._relaxed = Relaxed(0.0, [0.0] * len(self._actions), [], [])

    def relax(self, enough: Vector | None) -> ExactOptimum | None:
        """Add cuts until none is found that the relaxed solution misses, or the bound is enough."""
        order = self._prover._order
        wanted = None if enough is None else self._prover.scaled(enough)
        while True:
            if self._prover._expired():
                raise _TimeUpError
            near = wanted is not None and self._relaxed.value >= wanted * (1 - 1e-7)
            if not near and self._separate(self._relaxed.x):
                self._relaxed = self._covering.solve()
                continue
            exact = exact_optimum(self._rows, self._costs, order, self._relaxed.columns, self._relaxed.rows)
            if exact is None:
                if near and self._separate(self._relaxed.x):
                    self._relaxed = self._covering.solve()
                    continue
                return None
            if enough is not None and order.sign(_minus(exact.value, enough)) >= 0:
                return exact
            if not self._separate(self._shares(exact)):
                return exact
            self._relaxed = self._covering.solve()

    def packing(self, exact: ExactOptimum) -> Packing:
        """Give the weighted cuts of an exact optimum."""
        return Packing(tuple((self._cuts[row], weight) for row, weight in sorted(exact.weights.items())))

    def undecided(self, exact: ExactOptimum | None) -> int | None:
        """Give the action that is most nearly half taken, the most expensive of several; else ``None``."""
        shares = self._relaxed.x if exact is None else self._shares(exact)
        share, _, place = max(
            ((min(x, 1 - x), self._floats[place], -place) for place, x in enumerate(shares)),
            default=(0.0, 0.0, 0),
        )
        return self._actions[-place] if share > 1e-6 else None

    def taken(self, exact: ExactOptimum | None) -> list[int]:
        """Give the actions that the relaxed solution takes, with those that are used anyway."""
        shares = self._relaxed.x if exact is None else self._shares(exact)
        return sorted({a for a, x in zip(self._actions, shares, strict=True) if x > 0.5} | self._used)

    def _shares(self, exact: ExactOptimum) -> list[float]:
        return [float(exact.x.get(place, 0)) for place in range(len(self._actions))]

    def add(self, cuts: Iterable[Cut]) -> None:
        """Add cuts that are not there yet, and solve the relaxation with them."""
        new = [cut for cut in cuts if cut.objects not in self._seen]
        for cut in new:
            self._admit(cut, [self._places[a] for a in cut.members])
        if new:
            self._relaxed = self._covering.solve()

    def _admit(self, cut: Cut, row: list[int]) -> None:
        self._seen.add(cut.objects)
        self._cuts.append(cut)
        self._rows.append(row)
        self._covering.add(row)

    def _separate(self, x: Sequence[float]) -> bool:
        """Look for cuts whose landmarks have shares of less than 1; whether there were any."""
        found = False
        for attempt in range(_ORDERS):
            ties = [self._prover._random.random() for _ in self._actions] if attempt else self._floats
            places = sorted(range(len(self._actions)), key=lambda p: (-x[p], ties[p], p))
            order = [self._actions[p] for p in places]
            keeps = [self._derivation - {a} for a in sorted(self._derivation - self._used)]
            for keep in (*keeps, frozenset[int]()):
                cut = self._cutter.cut(sorted(keep | self._used), order)
                if cut is None or cut.objects in self._seen:
                    continue
                row = [self._places[a] for a in cut.members]
                if sum(x[place] for place in row) < _HIT:
                    found = True
                    self._admit(cut, row)
            if found:
                return True
        return False


def _minus(one: Sequence[Fraction], other: Sequence[Fraction]) -> Vector:
    return tuple(a - b for a, b in zip(one, other, strict=True))
