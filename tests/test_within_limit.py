"""A limit on how many of some units a tree has, by prices, against all trees there are."""

import random
from collections.abc import Callable, Sequence
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


@pytest.mark.sampled(2)
@pytest.mark.parametrize("improving", [True, False])
@pytest.mark.parametrize("seeds", [range(40), pytest.param(range(40, 600), marks=pytest.mark.slow)])
def test_better_trees_within_a_limit_are_within_what_is_left(
    seeds: range, improving: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Also where trees are not improved, so that prices and bounds have to bear bad ones."""
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
        within = limit.wide.within(limit.allowed, lambda: False)
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


def test_what_a_price_allows_is_what_it_adds_to_a_tree_within_the_limit() -> None:
    by = levels((Objective.UNITS,))
    wide = reduce(THREE, by, rest=True).wide
    assert wide is not None
    for most in (1, 2):
        found = limited(wide, by, frozenset({0, 1, 2, 9}), {0, 1, 2}.__contains__, most, lambda: False)
        assert found is not None
        assert found.tree is not None
        assert len(found.tree & {0, 1, 2}) <= most
        # three units more for three cuts fewer: each cut is priced at 1
        assert found.allowed == len(found.tree) + most
        left = found.wide.within(found.allowed, lambda: False)
        assert {0, 4, 6, 8, 9} <= left
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
        self.looked_up: list[tuple[Wide, int | None]] = []
        up_to = _Solver._up_to

        def noted(
            solver: _Solver, wide: Wide, tree: frozenset[int], ended: None, allowed: int | None = None
        ) -> Outcome:
            self.looked_up.append((wide, allowed))
            return up_to(solver, wide, tree, ended, allowed)

        monkeypatch.setattr(_Solver, "_up_to", noted)
        self.within: list[int] = []
        within = Wide.within

        def looked(wide: Wide, most: int, expired: Callable[[], bool]) -> frozenset[int]:
            self.within.append(most)
            return within(wide, most, expired)

        monkeypatch.setattr(Wide, "within", looked)

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
    assert prices.looked_up == [(found.wide, found.allowed)]
    assert prices.within == [found.allowed] != [found.wide.total(found.tree or frozenset())]


def test_where_the_price_of_a_limit_tells_nothing_the_next_is_asked(monkeypatch: pytest.MonkeyPatch) -> None:
    prices = Prices(monkeypatch, of_2=None)
    outcome = solve(THREE, settings=within(cut1=2, cut2=1))
    assert outcome.costs is not None
    assert (outcome.status, outcome.costs.units, prices.asked) == (Status.OPTIMAL, 6, [2, 1])
    assert [wide for wide, _ in prices.looked_up] == [found.wide for found in prices.found]


def test_a_tree_that_breaks_another_limit_is_not_taken_from_a_price(monkeypatch: pytest.MonkeyPatch) -> None:
    wide = reduce(THREE, levels((Objective.UNITS,)), rest=True).wide
    assert wide is not None
    prices = Prices(monkeypatch, of_2=Limited(frozenset({0, 1, 6, 8, 9}), wide, 9))
    outcome = solve(THREE, settings=within(cut1=2, cut2=1))
    assert outcome.costs is not None
    assert (outcome.status, outcome.costs.units, prices.asked) == (Status.OPTIMAL, 6, [2, 1])
    assert [found.wide for found in prices.found][1:] == [wide for wide, _ in prices.looked_up]


def test_that_no_tree_is_within_a_limit_is_the_answer(monkeypatch: pytest.MonkeyPatch) -> None:
    wide = reduce(THREE, levels((Objective.UNITS,)), rest=True).wide
    assert wide is not None
    prices = Prices(monkeypatch, of_2=Limited(None, wide, 0))
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


def test_a_tree_that_a_price_finds_when_time_is_up_is_not_lost(monkeypatch: pytest.MonkeyPatch) -> None:
    settings, by = within(cut=2), (Objective.UNITS,)
    heard = _Heard(THREE, by, Reporter())
    first = prepare(THREE, by, settings, assemble(settings, print), heard)
    assert first.reduced is not None
    assert first.tree is not None
    wide = first.reduced.wide
    assert wide is not None
    solver = _Solver(first, by, heard, {})
    solver.deadline = Deadline(0.0)
    found = Limited(frozenset({0, 1, 7, 8, 9}), wide, 5)
    monkeypatch.setattr(module, "limited", lambda *_: found)
    outcome = solver._within_limits(wide, first.tree)
    assert outcome is not None
    assert (outcome.status, outcome.units) == (Status.FEASIBLE, (0, 1, 7, 8, 9))


# --- What prices are asked for, and what is made of what is told of them. Every unit costs 1.

PICK = plain_problem([([0], [1])] * 30, [1])
UNITS = levels((Objective.UNITS,))
Told = tuple[frozenset[int] | None, int, bool]  # a tree, a bound, and whether cuts are known


def picked(counted: int, others: int) -> frozenset[int]:
    """Give some units, of which those below 10 count."""
    return frozenset([*range(counted), *range(10, 10 + others)])


class Teller:
    """Answers one question after the other, and notes the price of a unit that counts."""

    def __init__(self, told: Sequence[Told]) -> None:
        wide = reduce(PICK, UNITS, rest=True).wide
        assert wide is not None
        self.wide = wide  # the bound of its cuts is 1
        self.anew = [replace(wide) for _ in told]
        self.costs: list[ExactCosts] = []
        self._told = told

    @property
    def prices(self) -> list[int]:
        return [costs(0) - costs(10) for costs in self.costs]

    def limited(self, most: int, monkeypatch: pytest.MonkeyPatch) -> Limited | None:
        """Ask with a tree of 8 units, 5 of which count."""
        monkeypatch.setattr(module, "at_costs", self)
        return limited(self.wide, UNITS, picked(5, 3), lambda unit: unit < 10, most, lambda: False)

    def __call__(
        self, wide: Wide, objectives: Sequence[Objective], costs: ExactCosts, expired: Callable[[], bool]
    ) -> Reduced:
        assert (wide, objectives, expired()) == (self.wide, UNITS, False)
        assert costs(10) == 1
        tree, bound, known = self._told[len(self.costs)]
        anew = self.anew[len(self.costs)] if known else None
        self.costs.append(costs)
        return Reduced(tree, (), False, None, bound, None, wide=anew)


@pytest.mark.parametrize(
    ("told", "prices", "tree", "known_by", "allowed"),
    [
        # a tree of 14 units within the limit: 6 more for 3 fewer that count
        ([(picked(2, 12), 0, True), (picked(1, 13), 5, True)], [2], picked(2, 12), 0, 14),
        # the bound is beyond the one known, by the price of two
        ([(picked(2, 12), 0, True), (picked(1, 13), 6, True)], [2], picked(2, 12), 1, 14 + 2 * 2),
        ([(picked(2, 12), 0, True), (None, 99, True)], [2], picked(2, 12), 0, 14),
        ([(picked(2, 12), 0, True), (picked(2, 12), 99, False)], [2], picked(2, 12), 0, 14),
        # a price is rounded up, and none is asked for where the tree within the limit is as good
        ([(picked(2, 11), 0, True), (None, 0, False)], [2], picked(2, 11), 0, 13),
        ([(picked(2, 7), 0, True), (None, 0, False)], [1], picked(2, 7), 0, 9),
        ([(picked(2, 6), 0, True)], [], picked(2, 6), 0, 8),
        ([(picked(1, 2), 0, True)], [], picked(1, 2), 0, 3),
        # a dearer tree beyond the limit comes instead of the one before, but no cheaper one, nor one as dear
        ([(picked(2, 12), 0, True), (picked(4, 5), 6, True), (None, 0, False)], [2, 3], picked(2, 12), 1, 18),
        ([(picked(2, 12), 0, True), (picked(3, 5), 6, True)], [2], picked(2, 12), 1, 18),
        ([(picked(2, 12), 0, True), (picked(3, 2), 6, True)], [2], picked(2, 12), 1, 18),
        # a cheaper tree within the limit comes instead of the one before
        ([(picked(2, 12), 0, True), (picked(2, 9), 6, True), (None, 0, False)], [2, 1], picked(2, 9), 1, 15),
        # two prices are tried, and the one of the greatest bound is taken
        (
            [(picked(2, 12), 0, True), (picked(4, 5), 6, True), (picked(4, 6), 8, True)],
            *([2, 3], picked(2, 12), 1, 14 + 2 * 2),
        ),
        (
            [(picked(2, 13), 0, True), (picked(4, 5), 9, True), (None, 10, True)],
            *([3, 3], picked(2, 13), 1, 15 + 2 * 3),
        ),
        (
            [(picked(2, 13), 0, True), (picked(4, 5), 9, True), (picked(3, 5), 10, True)],
            *([3, 3], picked(2, 13), 2, 15 + 2 * 3),
        ),
        (
            [(picked(2, 12), 0, True), (picked(4, 5), 6, True), (picked(2, 11), 9, True)],
            *([2, 3], picked(2, 11), 2, 13 + 2 * 3),
        ),
    ],
)
def test_prices_follow_from_what_was_told(
    told: list[Told],
    prices: list[int],
    tree: frozenset[int],
    known_by: int,
    allowed: int,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    teller = Teller(told)
    found = teller.limited(2, monkeypatch)
    assert teller.prices == [31, *prices]  # the first is more than all units cost
    wide = teller.anew[known_by] if known_by else teller.wide
    assert found == Limited(tree, wide, allowed)


@pytest.mark.parametrize("most", range(3))
def test_a_limit_that_nothing_keeps_is_told_from_one_of_which_nothing_is_known(
    most: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    beyond = 31 * (most + 1)  # so much one more unit that counts costs, at a price beyond all units
    for tree in (None, picked(most, 1), picked(most + 1, 1)):
        teller = Teller([(tree, beyond, True)])
        assert teller.limited(most, monkeypatch) == Limited(None, teller.wide, 0)
        [costs] = teller.costs
        assert [costs.met(Cuts(bound, {}, []), range(most + 1)) for bound in (beyond - 1, beyond)] == [0, 1]
        assert costs.met(Cuts(0, {}, []), picked(most, 10))
    for tree in (None, picked(most + 1, 0), picked(most + 1, 10)):
        assert Teller([(tree, beyond - 1, True)]).limited(most, monkeypatch) is None
    tree = picked(most, 1)
    found = Teller([(tree, beyond - 1, True)]).limited(most, monkeypatch)
    assert found is not None
    assert (found.tree, found.allowed) == (tree, most + 1)


def test_ctrl_c_is_passed_on(monkeypatch: pytest.MonkeyPatch) -> None:
    teller = Teller([(picked(2, 12), 0, True)])
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
