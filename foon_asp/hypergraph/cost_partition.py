"""Optimal cost partitioning over landmark cuts: the dual of the hitting set relaxation.

Greedy weights of cuts depend on the order of the cuts. Here all cuts are weighed at once, and cuts that the
LP solution violates are added until none is found (Bonet and Helmert 2010; Katz and Domshlak 2010 for cost
partitioning). The floats of HiGHS are rounded to parts such that no action carries more than its cost, so the
bound holds whatever they were.
"""

import math
import random
from collections.abc import Callable, Collection, Iterable, Sequence
from fractions import Fraction
from typing import Any, NamedTuple

from foon_asp.hypergraph.covering import Covering, UnsolvedError, Weighed
from foon_asp.hypergraph.cut import Cutter
from foon_asp.hypergraph.first_achievers import FirstAchievers
from foon_asp.hypergraph.hypergraph import Hypergraph
from foon_asp.hypergraph.violated_cuts import disjoint_violated_cuts

PARTS = 720720  # of 1: most weights are simple fractions
_CUTS = 40  # cuts of all targets separated for one LP solution; more where targets need few actions
_ALONE = 8  # times all actions: the total size of the cutters for single targets, at most
_SMALL = 0.5  # of the actions: the size of a cutter for a single target, at most
_STALLED = 8  # solutions after which a bound that hardly grows counts as optimal
_GROWS = 0.01  # of the gap: what these solutions have to gain
_OFTEN = 8  # solutions from one call of ``on_solution`` to the next
_TWICE = 1.001  # a cut with a greater sum of LP values is not tight
_LARGE = 2**62  # sums that do not fit into 64 bits
_LOST = Fraction(1, 100)  # how much the rounded bound may be below the LP value


class SharedCosts(NamedTuple):
    """A cost partition over cuts: objects and weight of each cut, in :data:`PARTS` of 1.

    No derivation by the actions looked at costs less than ``bound``, in parts. ``reduced_costs`` are those of
    each action, in parts, and ``shares`` the LP value of each action. ``tight`` are the cuts that the LP
    solution satisfies with equality: the ones to begin the next relaxation with.
    """

    bound: int
    reduced_costs: dict[int, int]
    cuts: list[tuple[frozenset[int], int]]
    shares: dict[int, float]
    tight: Sequence[frozenset[int]] = ()


def share_costs(
    graph: Hypergraph,
    targets: Iterable[int],
    actions: Collection[int],
    cost: Callable[[int], int],
    known_cuts: Iterable[Iterable[int]],
    enough: int,
    expired: Callable[[], bool],
    on_solution: Callable[[SharedCosts], int] | None = None,
    every: int = _OFTEN,
) -> SharedCosts | None:
    """Find landmark cuts of the targets and an optimal cost partition over them.

    All of the actions can run, and actions of cost 0 count as used. ``known_cuts`` are the objects of cuts to
    begin with. The search ends at a bound of ``enough``. After each ``every`` solutions, ``on_solution`` is
    called with the cost partition so far, and returns the bound that is enough from then on, or 0 to end.
    Returns ``None`` where the targets cannot be reached or are all available, and where HiGHS fails.
    """
    return _Sharing(graph, targets, actions, cost, expired).share(
        known_cuts, enough, expired, on_solution, every
    )


def renumbered(
    graph: Hypergraph, targets: Iterable[int], actions: Sequence[int]
) -> tuple[Hypergraph, list[int], list[int]]:
    """Return the graph of the given actions, the old numbers of its objects, and its targets."""
    targets, start = tuple(targets), graph.start
    objects = sorted({o for a in actions for o in graph.needs[a] if o not in start}.union(targets))
    number = {o: i for i, o in enumerate(objects)}
    small = Hypergraph(
        len(number),
        [[number[o] for o in graph.needs[a] if o in number] for a in actions],
        [[number[o] for o in graph.gives[a] if o in number] for a in actions],
        (),
    )
    return small, objects, [number[o] for o in targets]


def in_parts(costs: Sequence[int]) -> Any:
    """Return an array of costs in parts: 64-bit integers where their sum fits, else Python integers."""
    import numpy as np  # noqa: PLC0415 (a part of HiGHS is there already)

    return np.array(costs, dtype=np.int64 if sum(costs) * PARTS < _LARGE else object) * PARTS


def _quotient(a: int, b: int) -> float:
    """Return ``a / b``, or infinity where no float is so large."""
    try:
        return a / b
    except OverflowError:
        return math.inf


def shared_out(
    dual_values: Iterable[tuple[int, float]], of_1: int, rows: Sequence[Any], capacity: Any
) -> dict[int, int]:
    """Return a feasible weight for each row: its dual value rounded to parts, limited by ``capacity``.

    Capacity that rounding leaves over is used greedily. ``of_1`` are the parts of a weight of 1, ``rows`` the
    columns of each row, and ``capacity`` the cost of each column in parts, which becomes its reduced cost.
    """
    wanted = {row: round(Fraction(w) * of_1) if 0 < w < math.inf else 0 for row, w in dual_values}
    weights = dict.fromkeys(wanted, 0)
    dearest_first = sorted(wanted, key=lambda row: -wanted[row])
    for limited in (True, False):
        for row in dearest_first:
            upper = wanted[row] if limited else math.inf
            weight = int(min(upper, capacity[rows[row]].min())) if upper else 0
            if weight:
                weights[row] += weight
                capacity[rows[row]] -= weight
    return weights


def stalled(values: Sequence[float], lacks: float) -> bool:
    """Return whether the last LP solutions hardly reduced the gap ``lacks`` between the bound and enough."""
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
        plain, self._objects, small_targets = renumbered(graph, targets, self._actions)
        self._achievers = FirstAchievers(plain, expired)
        small = self._achievers.graph
        self._cutter = Cutter(small, small_targets)
        self._costs = [cost(a) for a in self._actions]
        self._dearest = max(self._costs, default=1)
        self._random = random.Random(0)
        self._single_target_cutters, self._other_targets_cutters = (
            ([], []) if self._cutter.hopeless else self._by_target(small)
        )
        self._relative = [
            c / self._dearest for c in self._costs
        ]  # between 0 and 1, as costs may be too great for floats
        self._covering = Covering(self._relative)
        self._rows: list[list[int]] = []
        self._cuts: list[frozenset[int]] = []
        self._whole_cuts: dict[int, frozenset[int]] = {}  # by row, the objects of its cut in the whole graph
        self._interior_point = True  # faster, until it is not exact enough

    def share(
        self,
        known_cuts: Iterable[Iterable[int]],
        enough: int,
        expired: Callable[[], bool],
        on_solution: Callable[[SharedCosts], int] | None,
        every: int,
    ) -> SharedCosts | None:
        if self._cutter.hopeless or not self._cutter.targets:
            return None
        position = {o: i for i, o in enumerate(self._objects)}
        for objects in known_cuts:
            self._add(frozenset(position[o] for o in objects if o in position))
        values: list[float] = []
        last: Weighed | None = None
        while last is None or not expired():
            relaxed = self._solved(expired)
            if relaxed is None:
                break
            last = relaxed
            values.append(relaxed.value)
            above = 100 * enough - 99  # hundredths: costs are whole, and so are bounds
            lacks = _quotient(above, 100 * self._dearest) - relaxed.value
            ends = lacks <= 0 or stalled(values, lacks)
            if ends or not self._separate(relaxed.x, expired):
                if self._interior_point and not ends:
                    self._interior_point = False
                    continue
                shared = self._shared(relaxed)
                lost = Fraction(relaxed.value) * self._dearest - Fraction(shared.bound, PARTS)
                if not self._interior_point or lost < _LOST:
                    return shared
                self._interior_point = False
            elif on_solution is not None and len(values) % every == 0:
                shared = self._shared(relaxed)
                enough = on_solution(shared)
                if not enough:
                    return shared
        return None if last is None else self._shared(last)

    def _solved(self, expired: Callable[[], bool]) -> Weighed | None:
        """Return an LP solution; ``None`` where HiGHS finds none before time is up."""
        if self._interior_point:
            relaxed = self._covering.interior_point(expired)
            if relaxed is not None:
                return relaxed
            self._interior_point = False
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
        """Add disjoint cuts that an LP solution violates; return whether there are any."""
        import numpy as np  # noqa: PLC0415 (a part of HiGHS is there already)

        relative, random_number = np.array(self._relative), self._random.random
        shares = np.where(relative > 0, x, 1.0)
        any_added = False
        effort = _CUTS * len(self._actions)
        self._random.shuffle(self._single_target_cutters)
        for cutter in (*self._single_target_cutters, *self._other_targets_cutters):
            cuts = disjoint_violated_cuts(cutter, (), shares, relative, random_number)
            while effort > 0:
                if expired():
                    return False
                effort -= len(cutter.actions)
                cut = next(cuts, None)
                if cut is None:
                    break
                any_added = True
                self._add(frozenset(cut.objects))
        return any_added

    def _by_target(self, graph: Hypergraph) -> tuple[list[Cutter], list[Cutter]]:
        """Return a :class:`Cutter` for each target that needs few actions, and one for all other targets."""
        count, targets = len(self._actions), self._cutter.targets
        alone: list[Cutter] = []
        others: list[int] = []
        effort = _ALONE * count if len(targets) > 1 else 0
        everything = bytearray(b"\1") * graph.size
        for target in targets:
            if effort > 0:
                cutter = Cutter(graph, [target], reachable=everything)
                effort -= len(cutter.actions)
                if len(cutter.actions) <= count * _SMALL:
                    alone.append(cutter)
                    continue
            others.append(target)
        together = [Cutter(graph, others, reachable=everything)] if others else []
        return alone, together

    def _shared(self, solved: Weighed) -> SharedCosts:
        capacity = in_parts(self._costs)
        dual_values = [*solved.weights] + [0.0] * (
            len(self._rows) - len(solved.weights)
        )  # for rows added since
        weights = shared_out(enumerate(dual_values), self._dearest * PARTS, self._rows, capacity)
        shares = solved.x
        tight = [row for row, members in enumerate(self._rows) if sum(shares[a] for a in members) < _TWICE]
        return SharedCosts(
            sum(weights.values()),
            dict(zip(self._actions, capacity.tolist(), strict=True)),
            [(self._whole(row), weight) for row, weight in weights.items() if weight],
            {a: shares[n] for n, a in enumerate(self._actions)},
            [self._whole(row) for row in tight],
        )

    def _whole(self, row: int) -> frozenset[int]:
        """Return a row's cut as objects of the whole graph, widened to the same landmark there."""
        if row not in self._whole_cuts:
            objects = self._achievers.widened(self._cuts[row])
            self._whole_cuts[row] = frozenset(self._objects[o] for o in objects)
        return self._whole_cuts[row]
