"""The cheapest derivation, by branching over the linear relaxation of hitting all landmarks.

At each place of the branching, some actions are used and some are forbidden. What the used ones need are
targets, too, and they cost nothing any more. Cuts are found by a relaxed solution as in
:mod:`foon_asp.bounds.shared_costs`, and hold everywhere before the targets that they are before, so they are
kept from place to place. A place is closed only by whole numbers: by weights of cuts that are rounded so that
no action carries more than it costs, or by a cut that nothing crosses. What HiGHS says decides where to look.
"""

import math
import random
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from heapq import heappop, heappush
from typing import Any

from foon_asp.bounds.cut import Cut, Cutter
from foon_asp.bounds.first_achievers import FirstAchievers
from foon_asp.bounds.hypergraph import Hypergraph
from foon_asp.bounds.lower_bound import Branch, Cases, Dear, Hopeless, Packing, Proof
from foon_asp.bounds.missed_cuts import missed_cuts
from foon_asp.bounds.relaxation import Covering, UnsolvedError
from foon_asp.bounds.shared_costs import PARTS, in_parts, renumbered, shared_out, stalled

_WHOLE = 1e-6  # a share that is so near to a whole number is one
_CUTS = 40  # before the targets that one relaxed solution is asked for
_ROUNDS = 3  # of cuts, at each place but the first
_OFTEN = 10  # places, from one at which derivations are guessed to the next

_LONG = 10_000_000  # actions looked at for a proof, at most: some minute of a processor
_LENGTH = 2_000_000  # objects and members of cuts that a proof may name, one by one
_PART = 5000  # of these, what each set of weights counts as: so many branches within each other can be read

Guess = Callable[[Mapping[int, float], Collection[int]], Iterable[Collection[int]]]


class TooLongError(Exception):
    """A proof takes too long, or is."""


@dataclass(slots=True, eq=False)
class _Place:
    """A place of the branching: what is used, what is forbidden, and what is known of derivations there.

    No derivation here costs less than ``bound``, in parts, by the ``weights`` of rows. Then it is either
    closed, or those with an action of ``dear`` are no better than the one found, and it has two places below
    it.
    """

    used: frozenset[int]
    forbidden: frozenset[int]
    bound: int
    weights: list[tuple[int, int]]
    hopeless: Cut | None = None
    dear: frozenset[int] = frozenset()
    action: int | None = None
    without: "_Place | None" = None
    using: "_Place | None" = None


class Branching:
    """A search for derivations of the targets that cost less than ``total``.

    All of the actions can run, and each costs more than 0. ``known`` are sets of objects of cuts to begin
    with. ``guess`` gives derivations for how much of each action a relaxed solution takes and for what
    is forbidden, ``better`` hears of those that are cheaper than any before, and ``bounded`` of bounds.
    ``effort`` is what is left of it after a search.
    """

    def __init__(
        self,
        graph: Hypergraph,
        targets: Iterable[int],
        actions: Collection[int],
        cost: Callable[[int], int],
        known: Iterable[Collection[int]],
        total: int,
        guess: Guess,
        better: Callable[[set[int]], None],
        bounded: Callable[[int], None],
    ) -> None:
        import numpy as np  # noqa: PLC0415 (a part of HiGHS is there already)

        self._np = np
        self._actions = sorted(actions)
        plain, self._objects, self._targets = renumbered(graph, targets, self._actions)
        self._achievers = FirstAchievers(plain)
        self._graph = self._achievers.graph
        self._costs = [cost(a) for a in self._actions]
        self._unit = math.gcd(*self._costs) or 1  # costs of derivations are multiples of it
        self._dearest = max(self._costs, default=1)
        self._relative = np.array([c / self._dearest for c in self._costs])
        self._parts = in_parts(self._costs)
        self._total, self._guess, self._better, self._bounded = total, guess, better, bounded
        self._random = random.Random(0)
        self._covering = Covering(self._relative.tolist())
        self._rows: list[Any] = []
        self._cuts: list[frozenset[int]] = []
        self._asked: list[bool] = []  # rows that count at the place looked at
        self._now: tuple[frozenset[int], frozenset[int]] = frozenset(), frozenset()
        self.effort = 0
        self._most: float = math.inf  # that a proof may name
        self._expired: Callable[[], bool] = lambda: False
        self._wide: dict[frozenset[int], tuple[int, ...]] = {}  # cuts as they hold in the whole graph
        self._first = _Place(frozenset(), frozenset(), 0, [])
        number = {o: place for place, o in enumerate(self._objects)}
        for cut in known:
            self._add(frozenset(number[o] for o in cut if o in number))

    def search(self, effort: int, expired: Callable[[], bool]) -> bool:
        """Branch until nothing is open, up to an effort of about so many actions looked at.

        Gives whether it is proved that no derivation costs less than the one found, or than ``total`` where
        none was.
        """
        self.effort = effort
        waiting = [(0, 0, 0, self._first)]
        number = 0
        heard = 0
        try:
            while waiting:
                bound, depth, _, place = waiting[0]
                reached = min(-(-bound // PARTS), self._total)
                if reached > heard:
                    heard = reached
                    self._bounded(heard)
                if self._stopped(expired):
                    return False
                if not self._closes(bound) and not self._solve(place, number, expired):
                    return False
                heappop(waiting)
                for below in (place.using, place.without):
                    if below is not None:
                        number += 1
                        heappush(waiting, (below.bound, depth - 1, number, below))
        except UnsolvedError:
            return False
        return True

    def proof(self, most: float = math.inf, expired: Callable[[], bool] = lambda: False) -> Proof:
        """Prove what a search came to.

        Raises :class:`TooLongError` where time is up, and where it names more objects and members than that.
        """
        self._most, self._expired = most, expired
        return self._proof(self._first)[0]

    def cases(self) -> Cases:
        """Return the actions that were branched on, without what was left out by the way."""
        return self._cases(self._first)

    def _cases(self, place: _Place) -> Cases:
        if place.hopeless or place.without is None or place.using is None or place.action is None:
            return None
        return self._actions[place.action], self._cases(place.without), self._cases(place.using)

    def _stopped(self, expired: Callable[[], bool]) -> bool:
        return self.effort <= 0 or expired()

    def _closes(self, bound: int) -> bool:
        """Whether what costs no less than a bound is no better than the derivation found."""
        return bound > self._below() * PARTS

    def _below(self) -> int:
        """Return the most that a derivation can cost that is better than the one found."""
        return (self._total - 1) // self._unit * self._unit

    def _add(self, cut: frozenset[int]) -> None:
        """Add a row for a cut: all actions that cross it, whatever is forbidden just now."""
        self._rows.append(self._np.array(self._achievers.members(cut), dtype=self._np.int32))
        self._cuts.append(cut)
        self._asked.append(True)
        self._covering.add(self._rows[-1])

    def _go_to(self, place: _Place, targets: set[int]) -> None:
        """Let the relaxation be that of a place."""
        used, forbidden = self._now
        for action in (used ^ place.used) | (forbidden ^ place.forbidden):
            most = 0.0 if action in place.forbidden else 1.0 if action in place.used else math.inf
            self._covering.bound(action, float(action in place.used), most)
        self._now = place.used, place.forbidden
        for row, cut in enumerate(self._cuts):
            asked = not cut.isdisjoint(targets)
            if asked != self._asked[row]:
                self._asked[row] = asked
                self._covering.demand(row, float(asked))

    def _solve(self, place: _Place, number: int, expired: Callable[[], bool]) -> bool:
        """Close a place, or give it two below it; whether there was time for that."""
        targets = set(self._targets).union(*(self._graph.needs[a] for a in place.used))
        self.effort -= len(self._actions)
        cutter = Cutter(self._graph, targets, place.forbidden)
        if cutter.hopeless is not None:
            place.hopeless = cutter.hopeless
            return True
        self._go_to(place, targets)
        free = self._np.ones(len(self._actions), dtype=bool)
        free[list(place.used | place.forbidden)] = False
        values: list[float] = []
        while True:
            relaxed = self._covering.solve(expired)
            shares = self._np.array(relaxed.x)
            values.append(relaxed.value)
            self._weigh(place)
            if self._closes(place.bound):
                return True
            if self._stopped(expired):
                return False
            halves = self._np.flatnonzero(free & (shares > _WHOLE) & (shares < 1 - _WHOLE))
            if not len(halves):
                chosen = self._taken(cutter, shares, place)
                if not chosen:
                    continue
                if self._closes(place.bound):
                    return True
                halves = self._np.array(sorted(chosen - place.used))  # floats are too coarse for the rest
                break
            if number:
                ends = len(values) > _ROUNDS
            else:
                ends = stalled(values, self._total / self._dearest - relaxed.value)
            if ends or not self._separate(cutter, shares, place, expired):
                break
        if number % _OFTEN == 0:
            self._guessed(shares, place)
            if self._closes(place.bound):
                return True
        left = self._left(place)
        limit = self._below() * PARTS - place.bound
        dear = self._np.flatnonzero(left > limit).tolist()
        place.dear = frozenset(dear) - place.used - place.forbidden
        some = self._np.minimum(shares, 1.001 - shares)[halves] * (self._relative[halves] + 0.05)
        action = int(halves[some.argmax()])
        place.dear -= {action}
        place.action = action
        forbidden = place.forbidden | place.dear
        place.without = _Place(place.used, forbidden | {action}, place.bound, place.weights)
        paid = place.bound + int(left[action])
        place.using = _Place(place.used | {action}, forbidden, paid, place.weights)
        return True

    def _taken(self, cutter: Cutter, shares: Any, place: _Place) -> set[int]:
        """Return the actions of a derivation that is taken as a whole; else none, and add a cut it misses."""
        chosen = place.used.union(self._np.flatnonzero(shares > 0.5).tolist()) - place.forbidden
        self.effort -= len(cutter.actions)
        cut = cutter.cut(chosen, cutter.actions)
        if cut is not None:
            self._add(frozenset(cut.objects))
            return set()
        self._found({self._actions[a] for a in chosen})
        return set(chosen)

    def _found(self, actions: set[int]) -> None:
        total = sum(self._costs[place] for place, a in enumerate(self._actions) if a in actions)
        if total < self._total:
            self._total = total
            self._better(actions)

    def _guessed(self, shares: Any, place: _Place) -> None:
        self.effort -= 2 * len(self._actions)
        taken = dict(zip(self._actions, shares.tolist(), strict=True))
        for found in self._guess(taken, {self._actions[a] for a in place.forbidden}):
            if set(found) <= taken.keys():
                self._found(set(found))

    def _separate(self, cutter: Cutter, shares: Any, place: _Place, expired: Callable[[], bool]) -> bool:
        """Add cuts that a relaxed solution misses, each beside those before; whether there are any."""
        cuts = missed_cuts(cutter, place.used, shares.copy(), self._relative, self._random.random)
        found = 0
        while found < _CUTS and not self._stopped(expired):
            self.effort -= len(cutter.actions)
            cut = next(cuts, None)
            if cut is None:
                break
            found += 1
            self._add(frozenset(cut.objects))
        return found > 0

    def _weigh(self, place: _Place) -> None:
        """Record what the weights of all rows prove, if it is more than is known."""
        left = self._parts.copy()
        paid = sum(self._costs[a] for a in place.used) * PARTS
        left[list(place.used)] = 0
        left[list(place.forbidden)] = sum(self._costs) * PARTS  # more than they can come to carry
        told = ((row, w) for row, w in enumerate(self._covering.weights()) if self._asked[row])
        weights = shared_out(told, self._dearest * PARTS, self._rows, left)
        bound = paid + sum(weights.values())
        if bound > place.bound or not place.weights:
            place.bound = max(bound, place.bound)
            place.weights = [(row, weight) for row, weight in weights.items() if weight]

    def _left(self, place: _Place) -> Any:
        """Return what the weights at a place leave of the cost of each action, in parts."""
        left = self._parts.copy()
        for row, weight in self._carrying(place):
            left[self._rows[row]] -= weight
        return left

    def _carrying(self, place: _Place) -> Iterator[tuple[int, int]]:
        """Return rows and their weights; what the used actions cross can carry nothing."""
        for row, weight in place.weights:
            if place.used.isdisjoint(self._rows[row].tolist()):
                yield row, weight

    def _proof(self, place: _Place) -> tuple[Proof, set[int]]:
        """Give the proof of a place that is closed, and which of the forbidden actions it needs to be so."""
        if place.hopeless is not None:
            cut = frozenset(place.hopeless.objects)
            return Hopeless(self._stated(cut, place)), {*self._achievers.members(cut)} & place.forbidden
        if place.without is None or place.using is None or place.action is None:
            return self._packing(place)
        proof, barred = self._proof(place.without)
        using, barred_too = self._proof(place.using)
        proof = Branch(self._actions[place.action], proof, using)
        barred = (barred - {place.action}) | barred_too
        dear = sorted(barred & place.dear)
        if not dear:
            return proof, barred
        packing, overloaded = self._packing(place)
        proof = Dear(tuple(self._actions[a] for a in dear), packing, proof)
        return proof, (barred - place.dear) | overloaded

    def _packing(self, place: _Place) -> tuple[Packing, set[int]]:
        weights: list[tuple[Cut, tuple[Fraction]]] = []
        self._most -= _PART
        for row, weight in self._carrying(place):
            cut = self._stated(self._cuts[row], place)
            self._most -= len(cut.objects) + len(cut.members)
            if self._most < 0 or self._expired():
                raise TooLongError
            weights.append((cut, (Fraction(weight, PARTS),)))
        overloaded = set(self._np.flatnonzero(self._left(place) < 0).tolist())
        return Packing(tuple(weights)), overloaded & place.forbidden

    def _stated(self, cut: frozenset[int], place: _Place) -> Cut:
        """Return a cut by the numbers of the whole graph, with what crosses it at a place."""
        crossing = (self._actions[a] for a in self._achievers.members(cut) if a not in place.forbidden)
        if cut not in self._wide:
            wide = self._achievers.widened(cut)
            self._wide[cut] = tuple(sorted(self._objects[o] for o in wide))
        return Cut(self._wide[cut], tuple(sorted(crossing)))


def branched(
    graph: Hypergraph,
    targets: Iterable[int],
    actions: Collection[int],
    cost: Callable[[int], int],
    known: Iterable[Collection[int]],
    total: int,
    expired: Callable[[], bool],
) -> Proof | None:
    """Prove that no derivation costs less than ``total``; arguments are those of :class:`Branching`.

    What its weights add up to is above the next smaller cost, and to be rounded up. ``None`` where that takes
    too long, where one costs less, and where an action costs nothing or all cost multiples of more than 1.
    """
    costs = [cost(action) for action in actions]
    if math.gcd(*costs) != 1 or 0 in costs:
        return None
    cheaper: list[set[int]] = []
    search = Branching(
        *(graph, targets, actions, cost, known, total, lambda *_: (), cheaper.append, lambda _: None)
    )
    if not search.search(_LONG, expired) or cheaper:
        return None
    try:
        return search.proof(_LENGTH, expired)
    except TooLongError:
        return None
