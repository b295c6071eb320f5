"""Costs shared out among landmarks as well as can be: the linear relaxation of hitting all of them.

Greedy weights of cuts depend on the order in which these are found. Here all cuts are known at once, and
those that the relaxed solution misses are added until none is found (Bonet and Helmert 2010). What HiGHS says
are floats: the weights are rounded to parts, and no action carries more than it costs, so the bound holds
whatever they were.
"""

import math
import random
from collections.abc import Callable, Collection, Iterable, Sequence
from fractions import Fraction
from typing import Any, NamedTuple

from foon_asp.bounds.cut import Cutter
from foon_asp.bounds.first_achievers import FirstAchievers
from foon_asp.bounds.hypergraph import Hypergraph
from foon_asp.bounds.missed_cuts import missed_cuts
from foon_asp.bounds.relaxation import Covering, UnsolvedError, Weighed

PARTS = 720720  # of 1: most weights are simple fractions
_CUTS = 40  # before all targets that one relaxed solution is asked for; of smaller ones there are more
_ALONE = 8  # times as many actions as there are, at most, for targets looked at by themselves
_SMALL = 0.5  # of the actions, at most, that a target may need for this
_STALLED = 8  # solutions, after which a bound that hardly grows counts as the best there is
_GROWS = 0.01  # of what lacks, how much these have to bring
_OFTEN = 8  # solutions, from one that is told of to the next
_TWICE = 1.001  # a cut of a greater share is hit more than once
_LARGE = 2**62  # sums that machine numbers do not hold
_LOST = Fraction(1, 100)  # how much less than the solution the weights may add up to


class SharedCosts(NamedTuple):
    """Weighted cuts: objects and weight of each, in :data:`PARTS` of 1.

    No derivation by the actions looked at costs less than ``bound``, in parts. ``left`` is what the cuts
    leave of the cost of each action, in parts, and ``shares`` is how much of each the relaxed solution takes.
    ``tight`` are the cuts that it hits just once: those to go on with.
    """

    bound: int
    left: dict[int, int]
    cuts: list[tuple[frozenset[int], int]]
    shares: dict[int, float]
    tight: Sequence[frozenset[int]] = ()


def share_costs(
    graph: Hypergraph,
    targets: Iterable[int],
    actions: Collection[int],
    cost: Callable[[int], int],
    known: Iterable[Iterable[int]],
    enough: int,
    expired: Callable[[], bool],
    heard: Callable[[SharedCosts], int] | None = None,
    often: int = _OFTEN,
) -> SharedCosts | None:
    """Find cuts before the targets, and the weights of the greatest sum that the costs allow.

    All of the actions can run, and those that cost nothing are taken as a whole. ``known`` are the objects of
    cuts to begin with. A bound of ``enough`` is good enough. What is known is ``heard`` of ``often``, once in
    so many solutions, which gives what is enough from then on, and nothing to end. ``None`` where nothing can
    be shared out.
    """
    return _Sharing(graph, targets, actions, cost, expired).share(known, enough, expired, heard, often)


def renumbered(
    graph: Hypergraph, targets: Iterable[int], actions: Sequence[int]
) -> tuple[Hypergraph, list[int], list[int]]:
    """Return a graph of some actions alone, its objects by their numbers before, and its targets."""
    targets, start = tuple(targets), graph.start
    objects = sorted({o for a in actions for o in graph.needs[a] if o not in start}.union(targets))
    number = {o: place for place, o in enumerate(objects)}
    small = Hypergraph(
        len(number),
        [[number[o] for o in graph.needs[a] if o in number] for a in actions],
        [[number[o] for o in graph.gives[a] if o in number] for a in actions],
        (),
    )
    return small, objects, [number[o] for o in targets]


def in_parts(costs: Sequence[int]) -> Any:
    """Return an array of costs in parts: machine numbers where their sum is one, else of any size."""
    import numpy as np  # noqa: PLC0415 (a part of HiGHS is there already)

    return np.array(costs, dtype=np.int64 if sum(costs) * PARTS < _LARGE else object) * PARTS


def _quotient(a: int, b: int) -> float:
    """Return ``a / b``, or infinity where no float is so large."""
    try:
        return a / b
    except OverflowError:
        return math.inf


def shared_out(
    told: Iterable[tuple[int, float]], of_1: int, rows: Sequence[Any], left: Any
) -> dict[int, int]:
    """Return rows the weights that they are told to have, rounded to parts, which ``left`` is able to carry.

    What rounding leaves goes to whom it helps. ``of_1`` are the parts of a weight of 1, ``rows`` the members
    of each row, and ``left`` what each of these can carry, from which the weights are taken away.
    """
    wanted = {row: round(Fraction(w) * of_1) if 0 < w < math.inf else 0 for row, w in told}
    weights = dict.fromkeys(wanted, 0)
    dearest_first = sorted(wanted, key=lambda row: -wanted[row])
    for limited in (True, False):
        for row in dearest_first:
            most = wanted[row] if limited else math.inf
            weight = int(min(most, left[rows[row]].min())) if most else 0
            if weight:
                weights[row] += weight
                left[rows[row]] -= weight
    return weights


def stalled(values: Sequence[float], lacks: float) -> bool:
    """Whether the last solutions brought hardly any of what still lacks."""
    return len(values) > _STALLED and values[-1] - values[-1 - _STALLED] < _GROWS * lacks


class _Sharing:
    def __init__(
        self,
        graph: Hypergraph,
        targets: Iterable[int],
        actions: Collection[int],
        cost: Callable[[int], int],
        expired: Callable[[], bool],
    ) -> None:
        self._actions = sorted(actions)
        plain, self._objects, within = renumbered(graph, targets, self._actions)
        self._achievers = FirstAchievers(plain, expired)
        small = self._achievers.graph
        self._cutter = Cutter(small, within)
        self._costs = [cost(a) for a in self._actions]
        self._dearest = max(self._costs, default=1)
        self._random = random.Random(0)
        self._alone, self._together = ([], []) if self._cutter.hopeless else self._by_target(small)
        self._relative = [c / self._dearest for c in self._costs]  # the costs may be too great for floats
        self._covering = Covering(self._relative)
        self._rows: list[list[int]] = []
        self._cuts: list[frozenset[int]] = []
        self._stated: dict[int, frozenset[int]] = {}  # cuts by row, as they hold in the whole graph
        self._inside = True  # which is found sooner, until it is not exact enough

    def share(
        self,
        known: Iterable[Iterable[int]],
        enough: int,
        expired: Callable[[], bool],
        heard: Callable[[SharedCosts], int] | None,
        often: int,
    ) -> SharedCosts | None:
        if self._cutter.hopeless or not self._cutter.targets:
            return None
        number = {o: place for place, o in enumerate(self._objects)}
        for objects in known:
            self._add(frozenset(number[o] for o in objects if o in number))
        values: list[float] = []
        last: Weighed | None = None
        while last is None or not expired():
            found = self._solved(expired)
            if found is None:
                break
            last = found
            values.append(found.value)
            above = 100 * enough - 99  # hundredths: costs are whole, and so are bounds
            lacks = _quotient(above, 100 * self._dearest) - found.value
            ends = lacks <= 0 or stalled(values, lacks)
            if ends or not self._separate(found.x, expired):
                if self._inside and not ends:
                    self._inside = False
                    continue
                shared = self._shared(found)
                lost = Fraction(found.value) * self._dearest - Fraction(shared.bound, PARTS)
                if not self._inside or lost < _LOST:
                    return shared
                self._inside = False
            elif heard is not None and len(values) % often == 0:
                shared = self._shared(found)
                enough = heard(shared)
                if not enough:
                    return shared
        return None if last is None else self._shared(last)

    def _solved(self, expired: Callable[[], bool]) -> Weighed | None:
        """Return a relaxed solution, or ``None`` where HiGHS finds none, or not by the time that is up."""
        if self._inside:
            found = self._covering.inside(expired)
            if found is not None:
                return found
            self._inside = False
        try:
            solved = self._covering.solve(expired)
        except UnsolvedError:
            return None
        return Weighed(solved.value, solved.x, self._covering.weights())

    def _add(self, cut: frozenset[int]) -> None:
        self._cuts.append(cut)
        self._rows.append(self._achievers.members(cut))
        self._covering.add(self._rows[-1])

    def _separate(self, x: list[float], expired: Callable[[], bool]) -> bool:
        """Add cuts that a relaxed solution misses, each beside those before; whether there are any."""
        import numpy as np  # noqa: PLC0415 (a part of HiGHS is there already)

        relative, chance = np.array(self._relative), self._random.random
        shares = np.where(relative > 0, x, 1.0)
        found = False
        effort = _CUTS * len(self._actions)
        self._random.shuffle(self._alone)
        for cutter in (*self._alone, *self._together):
            cuts = missed_cuts(cutter, (), shares, relative, chance)
            while effort > 0:
                if expired():
                    return False
                effort -= len(cutter.actions)
                cut = next(cuts, None)
                if cut is None:
                    break
                found = True
                self._add(frozenset(cut.objects))
        return found

    def _by_target(self, graph: Hypergraph) -> tuple[list[Cutter], list[Cutter]]:
        """Give cutters before single targets that can need few of the actions, and one before all others."""
        most, targets = len(self._actions), self._cutter.targets
        alone: list[Cutter] = []
        others: list[int] = []
        effort = _ALONE * most if len(targets) > 1 else 0
        everything = bytearray(b"\1") * graph.size
        for target in targets:
            if effort > 0:
                cutter = Cutter(graph, [target], reachable=everything)
                effort -= len(cutter.actions)
                if len(cutter.actions) <= most * _SMALL:
                    alone.append(cutter)
                    continue
            others.append(target)
        together = [Cutter(graph, others, reachable=everything)] if others else []
        return alone, together

    def _shared(self, solved: Weighed) -> SharedCosts:
        left = in_parts(self._costs)
        told = [*solved.weights] + [0.0] * (len(self._rows) - len(solved.weights))  # of rows that came later
        weights = shared_out(enumerate(told), self._dearest * PARTS, self._rows, left)
        shares = solved.x
        tight = [row for row, members in enumerate(self._rows) if sum(shares[a] for a in members) < _TWICE]
        return SharedCosts(
            sum(weights.values()),
            dict(zip(self._actions, left.tolist(), strict=True)),
            [(self._whole(row), weight) for row, weight in weights.items() if weight],
            {a: shares[n] for n, a in enumerate(self._actions)},
            [self._whole(row) for row in tight],
        )

    def _whole(self, row: int) -> frozenset[int]:
        """Return the objects of a cut by their numbers in the whole graph, where it has the same landmark."""
        if row not in self._stated:
            wide = self._achievers.widened(self._cuts[row])
            self._stated[row] = frozenset(self._objects[o] for o in wide)
        return self._stated[row]
