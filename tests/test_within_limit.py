"""A limit on how many of some units a tree has, by prices, against all trees there are."""

import math
import random
from collections.abc import Callable, Collection, Sequence
from dataclasses import replace
from fractions import Fraction

import pytest

from foon_asp.asp import Outcome, Settings, Status, solve
from foon_asp.asp.assembly import assemble
from foon_asp.asp.prepared import prepare
from foon_asp.asp.solver import Reporter, _Heard, _Solver
from foon_asp.bounds.landmark_cuts import Cuts
from foon_asp.deadline import Deadline
from foon_asp.problem import Costs, Objective, levels
from foon_asp.reduce import ExactCosts, Reduced, Wide, reduce, reduction
from foon_asp.reduce import within_limit as module
from foon_asp.reduce.within_limit import Limited, limited
from foon_asp.rules.constraint import given_constraint
from tests.plain_graphs import plain_problem
from tests.test_constraint_meanings import small
from tests.test_reductions import LISTS, posed


@pytest.fixture(autouse=True)
def _no_cases(monkeypatch: pytest.MonkeyPatch) -> None:
    """Have prices tell what cases would before."""
    monkeypatch.setattr("foon_asp.reduce.cases._EFFORT", 0)


@pytest.mark.sampled(2)
@pytest.mark.parametrize("rising", [False, True])
@pytest.mark.parametrize("improving", [True, False])
@pytest.mark.parametrize("seeds", [range(40), pytest.param(range(40, 600), marks=pytest.mark.slow)])
def test_better_trees_within_a_limit_are_within_what_is_left(
    seeds: range, improving: bool, rising: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Also where trees are not improved, so that prices and bounds have to bear bad ones."""
    if rising:
        monkeypatch.setattr(module, "_MANY", 0)
    if not improving:
        monkeypatch.setattr(reduction, "improved", lambda _graph, _actions, tree, *_: tree)
    none = left_out = unknown = 0
    for seed in seeds:
        problem, _, found = posed(seed)
        rng = random.Random(f"limit {seed}")
        counting = frozenset(u for u in range(len(problem.network)) if rng.random() < 0.6)
        names = LISTS[seed % len(LISTS)]
        by = [*names, "units"]
        objectives = levels(tuple(map(Objective, names)))
        reduced = reduce(problem, objectives, rest=True)
        if reduced.tree is None or reduced.wide is None:
            continue
        most = len(reduced.tree & counting) - 1
        if most < 0:
            continue
        kept = [tree for tree in found if len(tree.units & counting) <= most]
        limit = limited(reduced.wide, objectives, reduced.tree, counting.__contains__, most, lambda: False)
        if limit is None:
            unknown += 1
            continue
        if limit.tree is None:
            none += 1
            assert not kept, (seed, names)
            continue
        [mine] = [tree for tree in kept if tree.units == limit.tree]
        wide = reduced.wide
        within = wide.within(wide.total(limit.tree), lambda: False) if limit.units is None else limit.units
        left_out += within < reduced.wide.everything()
        for tree in kept:
            if tree.key(by) < mine.key(by) and not any(other.units < tree.units for other in found):
                assert tree.units <= within, (seed, names)
    assert none > len(seeds) / 30
    assert left_out > len(seeds) / 60
    assert unknown < len(seeds) / 10


# --- By hand: p, q and r are cut by one unit each, or fried and boiled by two.

THREE = small(
    *("cut: start > p", "cut: start > q", "cut: start > r", "fry: start > a", "boil: a > p"),
    *("fry: start > b", "boil: b > q", "fry: start > c", "boil: c > r", "mix: p, q, r > end"),
)


@pytest.mark.parametrize(("most", "units"), [(0, 7), (1, 6), (2, 5), (3, 4)])
def test_the_best_tree_of_so_many_cuts(most: int, units: int) -> None:
    rule = given_constraint(f"at_most_motion:limited_motion=cut,max_uses={most}")
    outcome = solve(THREE, settings=Settings((rule,)))
    assert outcome.status is Status.OPTIMAL
    assert outcome.costs is not None
    assert outcome.costs.units == units


@pytest.mark.parametrize(("cuts", "boils", "units"), [(1, 1, None), (1, 2, 6), (2, 1, 5)])
def test_a_tree_within_one_limit_may_be_beyond_another(cuts: int, boils: int, units: int | None) -> None:
    limits = {"cut": cuts, "boil": boils}
    rules = [given_constraint(f"at_most_motion:limited_motion={m},max_uses={n}") for m, n in limits.items()]
    outcome = solve(THREE, settings=Settings(tuple(rules)))
    assert outcome.status is (Status.OPTIMAL if units else Status.INFEASIBLE)
    assert (outcome.costs.units if outcome.costs else None) == units


def test_what_is_left_has_the_tree_within_the_limit() -> None:
    by = levels((Objective.UNITS,))
    wide = reduce(THREE, by, rest=True).wide
    assert wide is not None
    for most in (1, 2):
        found = limited(wide, by, frozenset({0, 1, 2, 9}), {0, 1, 2}.__contains__, most, lambda: False)
        assert found is not None
        assert found.tree is not None
        assert len(found.tree & {0, 1, 2}) <= most
        assert found.units is not None
        assert found.tree <= found.units
    problem = small("cut: start > p", "fry: start > q", "cut: start > q", "mix: p, q > end")
    wide = reduce(problem, by, rest=True).wide
    assert wide is not None
    none = limited(wide, by, frozenset({0, 2, 3}), {0, 2}.__contains__, 0, lambda: False)
    assert none is not None
    assert none.tree is None


# --- Step by step, with what the prices say put in their place.


class Prices:
    """Notes which limits are asked about; of some it says what it is told to."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, **said: Limited | BaseException | None) -> None:
        self.asked: list[int] = []
        self.found: list[Limited] = []
        self._said = said
        monkeypatch.setattr(module, "limited", self)
        self.looked_up: list[frozenset[int]] = []
        up_to = _Solver._up_to

        def noted(solver: _Solver, wide: Wide, tree: frozenset[int], ended: None) -> Outcome:
            self.looked_up.append(tree)
            return up_to(solver, wide, tree, ended)

        monkeypatch.setattr(_Solver, "_up_to", noted)
        self.looked_at: list[frozenset[int]] = []
        look_at = _Solver._look_at

        def looked(solver: _Solver, units: Collection[int]) -> None:
            self.looked_at.append(frozenset(units))
            look_at(solver, units)

        monkeypatch.setattr(_Solver, "_look_at", looked)

    def __call__(
        self,
        wide: Wide,
        objectives: Sequence[Objective],
        tree: frozenset[int],
        counts: Callable[[int], bool],
        most: int,
        expired: Callable[[], bool],
    ) -> Limited | None:
        assert not expired()
        assert sum(map(counts, tree)) > most
        self.asked.append(most)
        said = self._said.get(f"of_{most}", limited(wide, objectives, tree, counts, most, expired))
        if isinstance(said, BaseException):
            raise said
        if said is not None:
            self.found.append(said)
        return said


def within(**limits: int) -> Settings:
    """Limit motions; the last letter of a name, if it is a figure, only tells two limits of one apart."""
    rules = (
        f"at_most_motion:limited_motion={name.rstrip('12')},max_uses={most}" for name, most in limits.items()
    )
    return Settings(tuple(map(given_constraint, rules)))


def test_limits_that_the_best_tree_keeps_to_have_no_price(monkeypatch: pytest.MonkeyPatch) -> None:
    prices = Prices(monkeypatch)
    heard: list[int] = []

    class Listening(Reporter):
        def tree(self, costs: Costs) -> None:
            heard.append(costs.units)

    outcome = solve(THREE, (Objective.UNITS,), within(mix=1, cut=2), Listening())
    [found] = prices.found
    assert (outcome.status, prices.asked) == (Status.OPTIMAL, [2])
    assert (heard[0], heard[-1]) == (len(found.tree or ()), 5)
    assert found.units is not None
    assert (prices.looked_up, prices.looked_at) == ([], [found.units])


def test_where_no_price_tells_all_units_of_trees_as_cheap_are_looked_at(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    tree = frozenset({0, 3, 4, 5, 6, 7, 8, 9})  # with more units than it needs
    prices = Prices(monkeypatch, of_2=Limited(tree))
    outcome = solve(THREE, settings=within(cut=2))
    assert outcome.costs is not None
    assert (outcome.status, outcome.costs.units, prices.looked_up) == (Status.OPTIMAL, 5, [tree])


def test_where_the_price_of_a_limit_tells_nothing_the_next_is_asked(monkeypatch: pytest.MonkeyPatch) -> None:
    prices = Prices(monkeypatch, of_2=None)
    outcome = solve(THREE, settings=within(cut1=2, cut2=1))
    assert outcome.costs is not None
    assert (outcome.status, outcome.costs.units, prices.asked) == (Status.OPTIMAL, 6, [2, 1])
    assert (prices.looked_up, prices.looked_at) == ([], [found.units for found in prices.found])


def test_a_tree_that_breaks_another_limit_is_not_taken_from_a_price(monkeypatch: pytest.MonkeyPatch) -> None:
    prices = Prices(monkeypatch, of_2=Limited(frozenset({0, 1, 6, 8, 9})))
    outcome = solve(THREE, settings=within(cut1=2, cut2=1))
    assert outcome.costs is not None
    assert (outcome.status, outcome.costs.units, prices.asked) == (Status.OPTIMAL, 6, [2, 1])
    assert (prices.looked_up, prices.looked_at) == ([], [found.units for found in prices.found[1:]])


def test_that_no_tree_is_within_a_limit_is_the_answer(monkeypatch: pytest.MonkeyPatch) -> None:
    prices = Prices(monkeypatch, of_2=Limited(None))
    monkeypatch.setattr(_Solver, "_run", None)  # nothing is searched
    outcome = solve(THREE, settings=within(cut1=2, cut2=1))
    assert (outcome.status, outcome.units, prices.asked) == (Status.INFEASIBLE, None, [2])


def test_ctrl_c_just_before_a_price_is_asked_about(monkeypatch: pytest.MonkeyPatch) -> None:
    within_limits = _Solver._within_limits

    def pressed(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    def instead(solver: _Solver, wide: Wide, tree: frozenset[int]) -> Outcome | None:
        monkeypatch.setattr(Deadline, "watched", pressed)
        return within_limits(solver, wide, tree)

    monkeypatch.setattr(_Solver, "_within_limits", instead)
    deadline = Deadline()
    assert solve(THREE, settings=within(cut=2)._replace(deadline=deadline)).status is Status.UNKNOWN
    assert deadline.interrupted


def test_ctrl_c_while_a_price_is_asked_about(monkeypatch: pytest.MonkeyPatch) -> None:
    Prices(monkeypatch, of_2=KeyboardInterrupt())
    monkeypatch.setattr(_Solver, "_with_loose_ends", None)  # nothing else is looked at
    deadline = Deadline()
    outcome = solve(THREE, settings=within(cut=2)._replace(deadline=deadline))
    assert (outcome.status, outcome.units, deadline.interrupted) == (Status.UNKNOWN, None, True)
    assert outcome.stopped == "ctrl-C while cutting the network"


@pytest.mark.parametrize("units", [None, frozenset(range(10))])
def test_a_tree_that_a_price_finds_when_time_is_up_is_not_lost(
    units: frozenset[int] | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    settings, by = within(cut=2), (Objective.UNITS,)
    heard = _Heard(THREE, by, Reporter())
    first = prepare(THREE, by, settings, assemble(settings, print), heard)
    assert first.reduced is not None
    assert first.tree is not None
    wide = first.reduced.wide
    assert wide is not None
    solver = _Solver(first, by, heard, {})
    solver.deadline = Deadline(0.0)
    found = Limited(frozenset({0, 1, 7, 8, 9}), units)
    monkeypatch.setattr(module, "limited", lambda *_: found)
    outcome = solver._within_limits(wide, first.tree)
    assert outcome is not None
    assert (outcome.status, outcome.units) == (Status.FEASIBLE, (0, 1, 7, 8, 9))
    if units is not None:  # what cannot be better than the tree is looked at only where the tree has it
        assert solver.first.units == tuple(sorted(units | {0, 1, 7, 8, 9}))


# --- What prices are asked for, and what is made of what is told of them. Every unit costs 1.

PICK = plain_problem([([0], [1])] * 30, [1])
UNITS = levels((Objective.UNITS,))
Told = tuple[frozenset[int] | None, int, int]  # a tree, a bound, and how many units are left


def picked(counted: int, others: int) -> frozenset[int]:
    """Give some units, of which those below 10 count."""
    return frozenset([*range(counted), *range(10, 10 + others)])


class Teller:
    """Answers one question after the other, and notes the price of a unit that counts."""

    def __init__(self, told: Sequence[Told]) -> None:
        wide = reduce(PICK, UNITS, rest=True).wide
        assert wide is not None
        self.wide = wide  # the bound of its cuts is 1
        self.costs: list[ExactCosts] = []
        self.known: list[tuple[Collection[int], int]] = []
        self.many: list[float] = []
        self.left: list[set[int]] = []
        self._told = told

    @property
    def prices(self) -> list[Fraction]:
        """What was asked for each unit that counts, where others cost 1."""
        return [Fraction(costs(0), costs(10)) - 1 for costs in self.costs]

    def limited(self, most: int, monkeypatch: pytest.MonkeyPatch) -> Limited | None:
        """Ask with a tree of 8 units, 5 of which count."""
        monkeypatch.setattr(module, "at_costs", self)
        return limited(self.wide, UNITS, picked(5, 3), lambda unit: unit < 10, most, lambda: False)

    def rising(self, best: frozenset[int], monkeypatch: pytest.MonkeyPatch) -> Limited:
        """Ask at rising prices, from 2, where at most 2 units that count are within the limit."""
        monkeypatch.setattr(module, "at_costs", self)
        monkeypatch.setattr(module, "_LOW", Fraction(2))
        over = picked(5, 3)
        return module._by_rising_prices(
            self.wide, UNITS, best, over, lambda unit: unit < 10, 2, lambda: False
        )

    def __call__(
        self,
        wide: Wide,
        objectives: Sequence[Objective],
        costs: ExactCosts,
        expired: Callable[[], bool],
        known: Collection[int],
        below: int,
        many: float,
    ) -> Reduced:
        assert (wide.cuts, objectives, expired()) == (self.wide.cuts, UNITS, False)
        tree, bound, left = self._told[len(self.costs)]
        self.costs.append(costs)
        self.known.append((known, below))
        self.many.append(many)
        self.left.append(set(wide.left))
        return Reduced(tree, tuple(range(left)), False, None, bound, None)


@pytest.mark.parametrize(
    ("told", "prices", "tree", "left"),
    [
        # a tree of 14 units within the limit: 6 more for 3 fewer that count
        ([(picked(2, 12), 0, 9), (picked(1, 13), 5, 9)], [2], picked(2, 12), 9),
        ([(picked(2, 12), 0, 9), (None, 99, 9)], [2], picked(2, 12), None),
        # a price is rounded up, and none is asked for where the tree within the limit is as good
        ([(picked(2, 11), 0, 9), (None, 0, 9)], [2], picked(2, 11), None),
        ([(picked(2, 7), 0, 9), (None, 0, 9)], [1], picked(2, 7), None),
        ([(picked(2, 6), 0, 9)], [], picked(2, 6), None),
        ([(picked(1, 2), 0, 9)], [], picked(1, 2), None),
        # a dearer tree beyond the limit comes instead of the one before, but no cheaper one, nor one as dear
        ([(picked(2, 12), 0, 9), (picked(4, 5), 6, 9), (None, 0, 8)], [2, 3], picked(2, 12), 9),
        ([(picked(2, 12), 0, 9), (picked(3, 5), 6, 9)], [2], picked(2, 12), 9),
        ([(picked(2, 12), 0, 9), (picked(3, 2), 6, 9)], [2], picked(2, 12), 9),
        # a cheaper tree within the limit comes instead of the one before
        ([(picked(2, 12), 0, 9), (picked(2, 9), 6, 9), (None, 0, 8)], [2, 1], picked(2, 9), 9),
        ([(picked(2, 12), 0, 9), (picked(4, 5), 6, 9), (picked(2, 11), 9, 9)], [2, 3], picked(2, 11), 9),
        # two prices are tried, and the fewest units that one of them leaves are taken
        ([(picked(2, 12), 0, 9), (picked(4, 5), 6, 9), (picked(4, 6), 8, 8)], [2, 3], picked(2, 12), 8),
        ([(picked(2, 13), 0, 9), (picked(4, 5), 9, 8), (picked(3, 5), 10, 9)], [3, 3], picked(2, 13), 8),
        # few are enough at once
        ([(picked(2, 12), 0, 9), (picked(4, 5), 6, 7)], [2], picked(2, 12), 7),
        ([(picked(2, 12), 0, 9), (picked(2, 9), 6, 7)], [2], picked(2, 9), 7),
    ],
)
def test_prices_follow_from_what_was_told(
    told: list[Told],
    prices: list[int],
    tree: frozenset[int],
    left: int | None,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(module, "_FEW", 7)
    monkeypatch.setattr(module, "_MANY", 9)
    teller = Teller(told)
    found = teller.limited(2, monkeypatch)
    assert teller.many == [math.inf, *[9] * len(prices)]
    assert teller.prices == [31, *prices]  # the first is more than all units cost
    assert found == Limited(tree, None if left is None else frozenset(range(left)))
    assert teller.known[0] == (frozenset(), 0)
    # what is better than the best tree within the limit costs less than that and the price of two
    best = [told[0][0]]
    for each, _, _ in told[1:]:
        assert best[-1] is not None
        better = each is not None and len(each & {*range(10)}) <= 2 and len(each) < len(best[-1])
        best.append(each if better else best[-1])
    wanted = zip(best, prices, strict=False)
    assert teller.known[1:] == [(tree, len(tree or ()) + 2 * price) for tree, price in wanted]


# --- The same where prices rise. They end with one question more, at the price of the greatest bound.

FAR = picked(2, 20)  # within the limit: 14 units more for 3 fewer that count
OVER = picked(5, 3)


@pytest.mark.parametrize(
    ("best", "told", "prices", "tree"),
    [
        # none is asked for where the tree within the limit is as good
        (picked(2, 6), [], [], picked(2, 6)),
        (picked(1, 2), [], [], picked(1, 2)),
        (FAR, [(None, 99)], [2], FAR),
        # a tree with as many as may be is the best at its price; prices are fractions, too
        (FAR, [(picked(2, 12), 18)], [2], picked(2, 12)),
        (picked(1, 12), [(picked(2, 10), 0)], ["5/4"], picked(2, 10)),
        # they rise until a tree is within the limit, or costs as much as the one in hand
        (FAR, [(OVER, 18), (picked(2, 12), 22)], [2, 4], picked(2, 12)),
        (FAR, [(OVER, 0), (picked(3, 8), 0), (picked(2, 12), 0)], [2, 4, 8], picked(2, 12)),
        (FAR, [(OVER, 0), (OVER, 0), (OVER, 0)], [2, 4, "14/3"], FAR),
        (FAR, [(OVER, 0), (OVER, 0), (FAR, 0)], [2, 4, "14/3"], FAR),
        # then a tree within the limit or beyond it comes instead of the one before
        (FAR, [(picked(1, 11), 0), (OVER, 0)], [2, 1], picked(1, 11)),
        (FAR, [(picked(1, 11), 0), (picked(3, 6), 0), (picked(1, 11), 0)], [2, 1, "3/2"], picked(1, 11)),
        (FAR, [(picked(1, 13), 0), (picked(1, 9), 0), (picked(1, 9), 0)], [2, "3/2", "1/2"], picked(1, 9)),
        # a tree that is no better ends it
        (picked(2, 13), [(picked(1, 14), 0)], [2], picked(2, 13)),
    ],
)
def test_rising_prices_follow_from_what_was_told(
    best: frozenset[int],
    told: list[tuple[frozenset[int] | None, int]],
    prices: list[int | str],
    tree: frozenset[int],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    asked = [*map(Fraction, prices)]
    bounds = [Fraction(bound, p.denominator) - 2 * p for p, (_, bound) in zip(asked, told, strict=True)]
    last = [max(zip(bounds, asked, strict=True))[1]] if told and told[-1][0] else []
    teller = Teller([*((tree, bound, 9) for tree, bound in told), (None, 0, 0)])
    assert teller.rising(best, monkeypatch) == Limited(tree)
    assert teller.prices == [*asked, *last]
    assert teller.many == [math.inf] * len(teller.prices)
    assert teller.known[: len(told)] == [(frozenset(), 0)] * len(told)
    # what is better than the best tree within the limit costs less than that and the price of two
    assert teller.known[len(told) :] == [(tree, len(tree) * p.denominator + 2 * p.numerator) for p in last]


def test_so_many_rising_prices_are_tried(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "_RISING", 2)
    teller = Teller([(OVER, 0, 9), (OVER, 0, 9), (None, 0, 0)])
    assert teller.rising(FAR, monkeypatch) == Limited(FAR)
    assert teller.prices == [2, 4, 2]


@pytest.mark.parametrize(
    ("last", "found"),
    [
        ((OVER, 0, 9), Limited(picked(2, 12), frozenset(range(9)))),
        ((picked(2, 12), 0, 8), Limited(picked(2, 12), frozenset(range(8)))),
        ((picked(2, 11), 0, 8), Limited(picked(2, 11), frozenset(range(8)))),
        ((picked(1, 11), 0, 8), Limited(picked(1, 11), frozenset(range(8)))),
        ((picked(3, 9), 0, 8), Limited(picked(2, 12), frozenset(range(8)))),
        ((None, 0, 8), Limited(picked(2, 12))),
    ],
)
def test_the_price_of_the_greatest_bound_leaves_units(
    last: Told, found: Limited, monkeypatch: pytest.MonkeyPatch
) -> None:
    for bound, price in ((23, 4), (21, 2)):
        teller = Teller([(OVER, 18, 9), (picked(2, 12), bound, 9), last])
        assert teller.rising(FAR, monkeypatch) == found
        assert teller.prices == [2, 4, price]
        assert teller.known[-1] == (picked(2, 12), 14 + 2 * price)


def test_units_of_dearer_trees_are_no_longer_looked_at(monkeypatch: pytest.MonkeyPatch) -> None:
    limits = []

    def within(_: Wide, limit: int, expired: Callable[[], bool]) -> Collection[int]:
        limits.append((limit, expired()))
        return range(limit - 1)

    monkeypatch.setattr(Wide, "actions_within", within)
    teller = Teller([(OVER, 0, 9), (picked(2, 12), 0, 9), (None, 0, 0)])
    assert teller.rising(FAR, monkeypatch) == Limited(picked(2, 12))
    assert limits == [(22, False), (14, False)]
    far = {*range(21), *FAR}
    assert teller.left == [far, far, {*range(13), *picked(2, 12)}]


@pytest.mark.parametrize("many", [9, 10])
def test_prices_rise_where_the_first_leaves_too_many(many: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "_MANY", many)
    teller = Teller([(FAR, 0, 0), (FAR, 0, 10), (picked(2, 12), 18, 9), (None, 0, 0)])
    found = teller.limited(2, monkeypatch)
    rising = [Fraction(3, 2)] * 2
    assert teller.prices == [31, 5, *(rising if many < 10 else [])]
    if many < 10:
        assert found == Limited(picked(2, 12))
    else:
        assert found == Limited(FAR, frozenset(range(10)))


@pytest.mark.parametrize("most", range(3))
def test_a_limit_that_nothing_keeps_is_told_from_one_of_which_nothing_is_known(
    most: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    beyond = 31 * (most + 1)  # so much one more unit that counts costs, at a price beyond all units
    for tree in (None, picked(most, 1), picked(most + 1, 1)):
        teller = Teller([(tree, beyond, 9)])
        assert teller.limited(most, monkeypatch) == Limited(None)
        [costs] = teller.costs
        assert [costs.met(Cuts(bound, {}, []), range(most + 1)) for bound in (beyond - 1, beyond)] == [0, 1]
        assert costs.met(Cuts(0, {}, []), picked(most, 10))
    for tree in (None, picked(most + 1, 0), picked(most + 1, 10)):
        assert Teller([(tree, beyond - 1, 9)]).limited(most, monkeypatch) is None
    tree = picked(most, 1)
    found = Teller([(tree, beyond - 1, 9)]).limited(most, monkeypatch)
    assert found is not None
    assert (found.tree, found.units) == (tree, None)


def test_ctrl_c_is_passed_on(monkeypatch: pytest.MonkeyPatch) -> None:
    teller = Teller([(picked(2, 12), 0, 9)])
    monkeypatch.setattr(module, "at_costs", lambda *given: teller(*given)._replace(interrupted=True))
    with pytest.raises(KeyboardInterrupt):
        limited(teller.wide, UNITS, picked(5, 3), lambda unit: unit < 10, 2, lambda: False)


def test_what_leads_nowhere_has_no_costs() -> None:
    """It can run, but what takes its output cannot; where rates count, nothing knows what it costs."""
    nowhere = small(
        *("cut: start > a", "mix: a > end", "fry: start > b", "boil: b > c", "mix: c > end"),
        *("peel: start > x", "grow: never > never", "blend: x, never > end"),
    )
    rates = dict(
        zip(
            nowhere.network.motions,
            map(Fraction, ["98/100", "97/100", "6/10", "7/10", "97/100", "1/5", "1/7", "1/9"]),
            strict=True,
        )
    )
    rule = given_constraint("at_most_motion:limited_motion=cut,max_uses=0")
    outcome = solve(replace(nowhere, rates=rates), (Objective.SUCCESS,), Settings((rule,)))
    assert (outcome.status, outcome.units) == (Status.OPTIMAL, (2, 3, 4))
