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
from typing import NamedTuple

from foon_asp.bounds.cut import Cutter
from foon_asp.bounds.hypergraph import Hypergraph
from foon_asp.bounds.relaxation import Covering, Weighed

PARTS = 720720  # of 1: most weights are simple fractions
_HIT = 0.999  # a landmark of a greater share is taken to be hit
_CUTS = 40  # before all targets that one relaxed solution is asked for; of smaller ones there are more
_ALONE = 8  # times as many actions as there are, at most, for targets looked at by themselves
_SMALL = 0.5  # of the actions, at most, that a target may need for this
_STALLED = 8  # solutions after which a bound that hardly grows counts as the best there is
_GROWS = 0.01  # of what lacks, how much these have to bring
_LOST = Fraction(1, 100)  # how much less than the solution the weights may add up to


class SharedCosts(NamedTuple):
    """Weighted cuts: objects and weight of each, in :data:`PARTS` of 1.

    No derivation by the actions looked at costs less than ``bound``, in parts. ``left`` is what the cuts
    leave of the cost of each action, in parts, and ``shares`` is how much of each the relaxed solution takes.
    """

    bound: int
    left: dict[int, int]
    cuts: list[tuple[frozenset[int], int]]
    shares: dict[int, float]


def share_costs(
    graph: Hypergraph,
    targets: Iterable[int],
    actions: Collection[int],
    cost: Callable[[int], int],
    known: Iterable[tuple[Collection[int], Collection[int]]],
    enough: int,
    expired: Callable[[], bool],
) -> SharedCosts | None:
    """Find cuts before the targets, and the weights of the greatest sum that the costs allow.

    All of the actions can run, and those that cost nothing are taken as a whole. ``known`` are cuts to begin
    with, their objects and their landmarks. A bound of ``enough`` is good enough. ``None`` where nothing can
    be shared out.
    """
    return _Sharing(graph, targets, actions, cost).share(known, enough, expired)


def renumbered(
    graph: Hypergraph, targets: Iterable[int], actions: Sequence[int]
) -> tuple[Hypergraph, list[int], list[int]]:
    """Give a graph of some actions alone, its objects by their numbers before, and its targets."""
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


class _Sharing:
    def __init__(
        self,
        graph: Hypergraph,
        targets: Iterable[int],
        actions: Collection[int],
        cost: Callable[[int], int],
    ) -> None:
        self._actions = sorted(actions)
        small, self._objects, within = renumbered(graph, targets, self._actions)
        self._cutter = Cutter(small, within)
        self._costs = [cost(a) for a in self._actions]
        self._dearest = max(self._costs, default=1)
        self._random = random.Random(0)
        self._alone, self._together = ([], []) if self._cutter.hopeless else self._by_target(small)
        self._relative = [c / self._dearest for c in self._costs]  # the costs may be too great for floats
        self._covering = Covering(self._relative)
        self._rows: list[tuple[int, ...]] = []
        self._cuts: list[frozenset[int]] = []

    def share(
        self,
        known: Iterable[tuple[Collection[int], Collection[int]]],
        enough: int,
        expired: Callable[[], bool],
    ) -> SharedCosts | None:
        if self._cutter.hopeless or not self._cutter.targets:
            return None
        place = {a: n for n, a in enumerate(self._actions)}
        for objects, members in known:
            row = tuple(place[a] for a in members if a in place)
            self._add(frozenset(objects), row)
        wanted = (100 * enough - 99) / (100 * self._dearest)  # costs are whole, and so are bounds
        values: list[float] = []
        last: Weighed | None = None
        inside = True  # which is found sooner, until it is not exact enough
        while last is None or not expired():
            found = self._covering.inside(expired) if inside else None
            if found is None:
                if last is not None and expired():
                    break
                inside = False
                solved = self._covering.solve(expired)
                found = Weighed(solved.value, solved.x, self._covering.weights())
            last = found
            values.append(found.value)
            lacks = wanted - found.value
            grown = values[-1] - values[-1 - _STALLED] if len(values) > _STALLED else math.inf
            if lacks <= 0 or grown < _GROWS * lacks or not self._separate(found.x, expired):
                shared = self._shared(found)
                lost = Fraction(found.value) * self._dearest - Fraction(shared.bound, PARTS)
                if not inside or lost < _LOST:
                    return shared
                inside = False
        return self._shared(last)

    def _add(self, objects: frozenset[int], row: tuple[int, ...]) -> None:
        self._cuts.append(objects)
        self._rows.append(row)
        self._covering.add(row)

    def _separate(self, x: list[float], expired: Callable[[], bool]) -> bool:
        """Add cuts that a relaxed solution misses, each beside those before; whether there are any."""
        import numpy as np  # noqa: PLC0415 (a part of HiGHS is there already)

        relative, chance = np.array(self._relative), self._random.random
        shares = np.where(relative > 0, x, 1.0)
        found = False
        effort = _CUTS * len(self._actions)
        self._random.shuffle(self._alone)
        for cutter in (*self._alone, *self._together):
            places = np.array(cutter.actions)
            costs = relative[places]
            while effort > 0:
                if expired():
                    return False
                effort -= len(places)
                dear = costs * [0.5 + chance() for _ in costs]
                order = places[np.lexsort((dear, -shares[places]))]
                cut = cutter.cut((), order.tolist())
                assert cut is not None  # without actions no target is reached
                if shares[list(cut.members)].sum() >= _HIT:
                    break
                found = True
                self._add(frozenset(self._objects[o] for o in cut.objects), cut.members)
                shares[list(cut.members)] = 1.0
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
        left = [c * PARTS for c in self._costs]
        weights = [0] * len(self._rows)
        of_1 = self._dearest * PARTS
        wanted = [max(0, round(Fraction(w) * of_1)) for w in solved.weights]
        wanted += [0] * (len(self._rows) - len(wanted))  # of rows that came later
        dearest_first = sorted(range(len(wanted)), key=lambda row: -wanted[row])
        for limit in (wanted, None):  # what is left by rounding goes to whom it helps
            for row in dearest_first:
                members = self._rows[row]
                weight = min(left[a] for a in members)
                if limit is not None:
                    weight = min(weight, limit[row])
                weights[row] += weight
                for a in members:
                    left[a] -= weight
        return SharedCosts(
            sum(weights),
            {a: left[n] for n, a in enumerate(self._actions)},
            [(cut, weights[row]) for row, cut in enumerate(self._cuts) if weights[row]],
            {a: solved.x[n] for n, a in enumerate(self._actions)},
        )
