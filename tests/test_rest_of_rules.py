"""Rules that reductions do not know of: the search near the goals finds what brute force finds."""

import random
from collections import Counter
from collections.abc import Collection, Sequence
from dataclasses import replace
from fractions import Fraction
from itertools import product
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from foon_asp.asp import Outcome, Proof, Settings, Status, solve
from foon_asp.asp import prepared as prepared_module
from foon_asp.asp import solver as solver_module
from foon_asp.asp.assembly import assemble
from foon_asp.asp.prepared import Prepared, prepare
from foon_asp.asp.ranking import Ranked
from foon_asp.asp.solver import Reporter, _Heard, _Solver
from foon_asp.deadline import Deadline
from foon_asp.encoding import exact_success
from foon_asp.errors import BugError
from foon_asp.grounding.grounded import Grounded
from foon_asp.grounding.run import Run
from foon_asp.network import UnitPrices
from foon_asp.problem import ContainerRule, Objective, Problem, Restriction
from foon_asp.reduce import NONE, Reduced, Wide, reduce
from foon_asp.rules.constraint import given_constraint
from foon_asp.rules.rules import Rules
from tests import oracle
from tests.random_problems import MOTIONS, random_problem
from tests.test_constraint_meanings import small
from tests.test_solver import Answer, Searches

OBJECTIVES = (Objective.UNITS, Objective.INPUTS, Objective.SUCCESS, Objective.KITCHEN)


@pytest.mark.sampled(2)
@pytest.mark.parametrize("part", range(4))
def test_what_is_found_near_the_goals_is_the_best_of_all(part: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(solver_module, "_NEAR", 1)
    monkeypatch.setattr(solver_module, "_MORE", 2)
    met: Counter[str] = Counter()
    for seed in range(10 * part, 10 * part + 10):
        rng = random.Random(seed)
        problem = random_problem(seed, list(ContainerRule)[seed % 2], units=7)
        objective, (one, other) = OBJECTIVES[seed % 4], rng.sample(MOTIONS, 2)
        spare = rng.random() < 0.5
        text = (
            f':- use(U), motion(U,"{one}"), not use(V) : motion(V,"{other}").'
            if spare
            else f':- use(U), motion(U,"{one}"), use(V), motion(V,"{other}").'
        )
        kept = [
            tree
            for tree in oracle.trees(problem)
            if (motions := {unit.motion for unit in tree})
            and (one not in motions or (other in motions) == spare)
        ]
        if oracle.makes(problem, ()):
            kept.append(())
        best = oracle.best(kept, problem, [str(objective)])
        outcome = solve(problem, (objective,), Settings((given_constraint(text),)))
        met[outcome.status] += 1
        if best is None:
            assert outcome.status is Status.INFEASIBLE, seed
            continue
        assert outcome.status is Status.OPTIMAL, seed
        assert outcome.units is not None
        tree = tuple(map(problem.network.unit, outcome.units))
        assert {*tree} in map(set, kept), seed
        assert oracle.key(problem, tree, [str(objective)]) == best, seed
    assert met[Status.OPTIMAL] > 2


def test_what_was_found_among_few_units_is_held_against_all_that_may_be_better(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    problem = small("cut: start > a", "mix: a > b", "fry: b > end", "boil: start > end", "junk: start > x")
    settings = Settings((given_constraint(':- use(U), motion(U,"boil"), not use(4).'),))

    def begun() -> _Solver:
        heard = _Heard(problem, (Objective.UNITS,), Reporter())
        first = prepare(problem, (Objective.UNITS,), settings, assemble(settings, print), heard)
        assert first.rest
        return _Solver(first, (Objective.UNITS,), heard, {})

    def found(solver: _Solver, among: set[int], late: bool = False) -> Outcome:
        reduced = solver.first.reduced
        assert reduced is not None
        wide = reduced.wide
        assert wide is not None
        solver.first = replace(solver.first, reduced=reduced._replace(settled=False))
        solver._look_at(among)
        ended = solver._run(solver.levels)
        assert ended.units is not None
        solver.heard.tree(ended.units)
        if late:
            solver.deadline = Deadline(0.0)
        return solver._up_to(wide, solver._in_hand(ended.units), ended)

    few = found(begun(), {0, 1, 2})
    assert (few.status, few.units) == (Status.OPTIMAL, (3, 4))
    monkeypatch.setattr(_Solver, "_search", None)  # what was found among all of them is the best
    for among in ({0, 1, 2, 3, 4}, {0, 3, 4}):  # trees of two units have no others than these
        every = found(begun(), among)
        assert (every.status, every.units) == (Status.OPTIMAL, (3, 4))
    # what was proved when time was up is not lost
    assert found(begun(), {0, 1, 2, 3, 4}, late=True).status is Status.OPTIMAL


# --- Step by step: the best tree heats and boils, which the rule does not allow together.

APART = ':- use(U), use(V), motion(U,"heat"), motion(V,"boil").'
BANNED = ("heat: start > x", "boil: x > end")
# 2 needs y: of 3, which looks near and is far, or of 4
LOOSE = small(
    *(*BANNED, "mix: y > end", "cut: z > y", "chop: w, k > y", "rinse: s > z", "steam: s > z", "dry: r > s"),
    *("air: r > s", "hang: q > r", "pour: v > w", "fill: v > w", "knead: start > k", "grind: u > v"),
    *("peel: start > u", "soak: t > q", "wring: start > t", "junk: start > o"),
)


class Looks:
    """Notes among which units is searched."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.units: list[set[int]] = []
        look_at = _Solver._look_at

        def instead(solver: _Solver, units: Collection[int]) -> None:
            self.units.append({*units})
            look_at(solver, units)

        monkeypatch.setattr(_Solver, "_look_at", instead)


def asked(problem: Problem, rule: str = APART, *objectives: Objective, **named: Any) -> Outcome:
    settings = Settings((given_constraint(rule),))._replace(**named)
    return solve(problem, objectives or (Objective.UNITS,), settings)


def says(outcome: Outcome) -> tuple[Status, set[int]]:
    return outcome.status, {*(outcome.units or ())}


def test_a_best_tree_that_keeps_to_the_rules_is_the_one(monkeypatch: pytest.MonkeyPatch) -> None:
    searches = Searches(monkeypatch)
    outcome = asked(small(*BANNED, "fry: start > end", "mix: y > end"))
    assert (*says(outcome), outcome.proof) == (Status.OPTIMAL, {2}, Proof.CUTS)
    assert searches.modes == ["ignore"]  # whether it does


@pytest.mark.parametrize("tree", [(0, 1), (2,)])
def test_a_tree_that_cuts_do_not_prove_best_is_held_against_others(
    tree: tuple[int, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    problem = small("cut: start > a", "mix: a > end", "fry: start > end")

    def unsettled(*given: Any) -> Reduced:
        return reduce(*given)._replace(settled=False, tree=frozenset(tree), units=(0, 1, 2))

    monkeypatch.setattr(prepared_module, "reduce", unsettled)
    outcome = asked(problem)
    assert (*says(outcome), outcome.proof) == (Status.OPTIMAL, {2}, Proof.SOLVER)

    def pressed(*_: Any) -> frozenset[int]:
        raise KeyboardInterrupt

    monkeypatch.setattr(Wide, "within", pressed)
    deadline = Deadline()
    outcome = asked(problem, deadline=deadline)
    assert says(outcome) == (Status.FEASIBLE, {*tree})
    assert outcome.bounds[Objective.UNITS] == 1
    assert deadline.interrupted


def test_loose_ends_are_tied_until_none_is_left(monkeypatch: pytest.MonkeyPatch) -> None:
    looks = Looks(monkeypatch)
    for step in ("_near", "_up_to"):  # there is no need to look at everything
        monkeypatch.setattr(_Solver, step, None)
    outcome = asked(LOOSE)
    assert outcome.status is Status.OPTIMAL
    assert {*(outcome.units or ())} - {10, 11} == {2, 4, 12, 13, 14}
    first = {*range(7), 10, 11, 12}
    assert looks.units == [first, first | {7, 8, 9, 15, 16}, {*range(17)}]
    # a landmark of three units, and those beyond, are not there from the beginning
    looks.units.clear()
    monkeypatch.setattr(solver_module, "_NEAR", 2)
    assert asked(LOOSE).costs == outcome.costs
    assert looks.units[0] == {0, 1, 2, 3, 4}
    looks.units.clear()
    monkeypatch.setattr(solver_module, "_NEAR", 3)
    assert asked(LOOSE).costs == outcome.costs
    assert looks.units[0] == first


def test_options_of_the_users_are_those_of_loose_ends_too(monkeypatch: pytest.MonkeyPatch) -> None:
    given: list[Sequence[str]] = []

    def grounded(program: Grounded, files: object, text: str, arguments: Sequence[str], *rest: Any) -> None:
        given.append(arguments)
        ground(program, files, text, arguments, *rest)

    ground: Any = Grounded.__init__
    monkeypatch.setattr(Grounded, "__init__", grounded)
    plain = asked(LOOSE)
    assert "--configuration=frumpy" in given[-1]
    handy = asked(LOOSE, clingo_options=("--configuration=handy",))
    assert "--configuration=handy" in given[-1]
    assert plain.costs == handy.costs


def test_of_a_part_of_a_network_units_keep_their_numbers() -> None:
    whole = small(
        *("junk: start > o", *BANNED, "mix: y > end", "cut: z > y", "chop: w > y", "rinse: s > z"),
        *("steam: s > z", "dry: start > s", "air: start > s", "pour: start > w", "fill: never > w"),
    )
    part = replace(whole, network=whole.network.without((0,)))
    assert says(asked(part)) in ((Status.OPTIMAL, {2, 4, 9}), (Status.OPTIMAL, {2, 4, 10}))
    whole = small("junk: start > o", "cut: start > a", "mix: start, a > end", "fry: start, a, end > w")
    part = replace(whole, network=whole.network.without((0,)))
    found = solve(part, (Objective.INPUTS,), Settings(reductions=NONE))
    assert says(found) == (Status.OPTIMAL, {0, 1})


@pytest.mark.parametrize(("name", "number"), [("_LOOSE", 2), ("_MANY", 4), ("_MANY", 9)])
def test_where_loose_ends_take_too_long_all_units_are_looked_at(
    name: str, number: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    looks = Looks(monkeypatch)
    monkeypatch.setattr(solver_module, name, number)
    outcome = asked(LOOSE)
    assert outcome.costs is not None
    assert (outcome.status, outcome.costs.units) == (Status.OPTIMAL, 6)
    assert looks.units[-1] == {*range(17)}
    assert len(looks.units) == (2 if number == 4 else 3)


def test_what_each_tree_has_counts_from_the_beginning(monkeypatch: pytest.MonkeyPatch) -> None:
    """However far it is from the goals."""
    looks = Looks(monkeypatch)
    monkeypatch.setattr(solver_module, "_NEAR", 1)
    problem = small(
        *("heat: x > end", "boil: y > end", "cut: z > x", "chop: v > x", "mix: z > y", "fry: v > y"),
        *("wash: s > z", "rinse: t > z", "steam: s > v", "soak: t > v", "dry: g > s", "hang: g > s"),
        *("air: g > t", "sun: g > t", "grow: start > g"),
    )
    rules = (f':- use(U), use(V), motion(U,"grow"), motion(V,"{motion}").' for motion in ("heat", "boil"))
    assert asked(problem, "\n".join(rules)).status is Status.INFEASIBLE
    assert len(looks.units) == 1


@pytest.mark.parametrize("found", [None, {2}, {2, 3, 4}])
def test_loose_ends_that_a_limit_leaves_settle_nothing(
    found: set[int] | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    problem = small(*BANNED, "mix: a, b > end", "cut: start > a", "chop: start > b")
    at_limit = Run() if found is None else Run(frozenset(map(problem.network.unit_number, found)), (3,))
    searches = Searches(monkeypatch, None, Answer(at_limit))
    assert says(asked(problem)) == (Status.OPTIMAL, {2, 3, 4})
    assert len(searches.modes) == 3  # the best tree is asked for once more, among all units


def test_what_is_best_by_rounded_costs_is_held_against_what_was_not_looked_at(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Two prices that clingo cannot tell apart: the better tree is not yet whole when the other is found."""
    prices = {**dict.fromkeys(("heat", "boil", "cut", "chop", "wash", "rinse"), Fraction(0))}
    prices |= {"mix": Fraction("1.0000001"), "fry": Fraction(1), "burn": Fraction(10**9)}
    problem = small(
        *(*BANNED, "mix: start > end", "fry: y > end", "cut: z > y", "chop: z > y", "wash: start > z"),
        *("rinse: start > z", "burn: start > end"),
    )
    problem = replace(problem, unit_prices=UnitPrices(prices, {}))
    looks = Looks(monkeypatch)
    outcome = asked(problem, APART, Objective.PRICE)
    assert outcome.status is Status.OPTIMAL
    assert outcome.costs is not None
    assert outcome.costs.measure(Objective.PRICE) == 1
    assert looks.units[0].isdisjoint({6, 7})


def test_rates_that_are_too_fine_for_the_reductions_are_left_to_the_search() -> None:
    """These know of one tree only, which does not keep to the rule."""
    rates = {**dict.fromkeys(("heat", "boil", "cut"), Fraction(1)), "mix": Fraction("0.9")}
    problem = small(*BANNED, "mix: start > end", "fry: y > end", "cut: start > y")
    problem = replace(problem, rates={**rates, "fry": Fraction("0.9000000001")})
    assert says(asked(problem, APART, Objective.SUCCESS)) == (Status.OPTIMAL, {3, 4})
    # what leads to no goal is there, too, where a rule asks for it
    problem = small("boil: start > end", "fry: start > end", "junk: start > x")
    rates = {"boil": Fraction("0.9000000001"), "fry": Fraction("0.9"), "junk": Fraction(1)}
    rule = ':- use(U), motion(U,"boil"), not use(V) : motion(V,"junk").'
    fine = replace(problem, rates=rates)
    assert says(asked(fine, rule, Objective.SUCCESS)) == (Status.OPTIMAL, {0, 2})


@pytest.mark.slow
def test_rounding_hides_nothing_among_loose_ends(monkeypatch: pytest.MonkeyPatch) -> None:
    """With weights so coarse that most trees weigh the same."""
    monkeypatch.setattr(exact_success, "_scale", lambda _: 2)
    met: Counter[bool] = Counter()
    settle = _Solver._settled_with_loose_ends

    def settling(solver: _Solver, *given: Any) -> Run | None:
        found = settle(solver, *given)
        assert found is not None
        assert found.units is not None
        met[given[-1] == len(found.units)] += 1
        return found

    monkeypatch.setattr(_Solver, "_settled_with_loose_ends", settling)
    for seed in range(240):
        rng = random.Random(seed)
        problem = random_problem(seed, list(ContainerRule)[seed % 2], units=14)
        both, names = {*rng.sample(MOTIONS, 2)}, ["success", "units"][: 1 + seed % 2]
        kept = [tree for tree in oracle.trees(problem) if not both <= {unit.motion for unit in tree}]
        kept += [()] if oracle.makes(problem, ()) else []
        best = oracle.best(kept, problem, names)
        rule = ':- use(U), motion(U,"{}"), use(V), motion(V,"{}").'.format(*both)
        outcome = asked(problem, rule, *map(Objective, names))
        assert outcome.status is (Status.INFEASIBLE if best is None else Status.OPTIMAL), seed
        if outcome.units is not None:
            tree = tuple(map(problem.network.unit, outcome.units))
            assert oracle.key(problem, tree, names) == best, seed
    assert met[True]
    assert met[False]


def test_a_tree_of_the_fewest_units_is_not_held_against_those_that_are_as_good(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    fewer: list[dict[int, int]] = []

    def written(units: dict[int, int]) -> str:
        fewer.append(units)
        return ""

    monkeypatch.setattr("foon_asp.encoding.facts.write_fewer", written)
    few = replace(LOOSE, rates=dict.fromkeys(LOOSE.network.motions, Fraction(1, 2)))
    outcome = asked(few, APART, Objective.SUCCESS)
    assert outcome.costs is not None
    assert (outcome.costs.success, outcome.costs.units) == (Fraction(1, 64), 6)
    assert fewer == [{}]
    many = replace(
        few, rates={**(few.rates or {}), **dict.fromkeys(("cut", "dry", "hang", "soak"), Fraction(1))}
    )
    outcome = asked(many, APART, Objective.SUCCESS)
    assert outcome.costs is not None
    assert (outcome.costs.success, outcome.costs.units) == (Fraction(1, 8), 7)
    assert fewer[1:] == [{0: 7}]


def test_fewer_units_with_the_same_product_come_in_the_same_search(monkeypatch: pytest.MonkeyPatch) -> None:
    """With weights so coarse that 0.7 weighs nothing, and 0.49 something."""
    monkeypatch.setattr(exact_success, "_scale", lambda _: 2)
    rates = dict.fromkeys(LOOSE.network.motions, Fraction(1))
    rates |= {
        "cut": Fraction("0.7"),
        "dry": Fraction("0.7"),
        "air": Fraction("0.1"),
        "chop": Fraction("0.49"),
    }
    outcome = asked(replace(LOOSE, rates=rates), APART, Objective.SUCCESS)
    assert outcome.costs is not None
    assert (outcome.costs.success, outcome.costs.units) == (Fraction("0.49"), 6)


def test_loose_ends_begin_with_what_mattered_before(monkeypatch: pytest.MonkeyPatch) -> None:
    looks = Looks(monkeypatch)
    known = set[int]()
    first = solve(LOOSE, (Objective.UNITS,), Settings((given_constraint(APART),)), known=known)
    assert known > {2, 4, 12, 13, 14}
    asked_before, looks.units = len(looks.units), []
    monkeypatch.setattr(Prepared, "keeps", None)  # that is known, and that nothing else tells
    for step in ("_by_cases", "_within_limits"):
        monkeypatch.setattr(_Solver, step, None)
    again = solve(LOOSE, (Objective.UNITS,), Settings((given_constraint(APART),)), known=known)
    assert again.costs == first.costs
    assert len(looks.units) == 1 < asked_before


def test_the_best_tree_without_the_rest_is_not_looked_for_again() -> None:
    found: dict[tuple[str, bool], Reduced] = {}
    for rule, brief in product((APART, ""), (False, True)):
        settings = Settings((given_constraint(rule),) if rule else ())
        heard = _Heard(LOOSE, (Objective.UNITS,), Reporter())
        program = assemble(settings, print)
        first = prepare(LOOSE, (Objective.UNITS,), settings, program, heard, brief=brief)
        assert first.reduced is not None
        found[rule, brief] = first.reduced
    assert {asked for asked, reduced in found.items() if not reduced.settled} == {(APART, True)}
    quick, thorough = found[APART, True].wide, found[APART, False].wide
    assert quick is not None
    assert thorough is not None
    assert quick.landmarks() == thorough.landmarks()


def test_the_best_tree_without_the_rest_is_looked_for_unless_somebody_says_not_to() -> None:
    settings = Settings((given_constraint(APART),))
    heard = _Heard(LOOSE, (Objective.UNITS,), Reporter())
    first = prepare(LOOSE, (Objective.UNITS,), settings, assemble(settings, print), heard)
    assert first.reduced is not None
    assert first.reduced.settled


def test_of_units_that_mattered_before_those_that_rules_remove_are_gone() -> None:
    settings = Settings((given_constraint(f'{APART} :- use(U), motion(U,"cut").'),))
    heard = _Heard(LOOSE, (Objective.UNITS,), Reporter())
    first = prepare(LOOSE, (Objective.UNITS,), settings, assemble(settings, print), heard)
    assert first.reduced is not None
    assert first.reduced.wide is not None
    assert first.reduced.wide.left_of([2, 3, 4, 99]) == {2, 4}


@pytest.mark.slow
def test_units_that_mattered_before_may_be_any() -> None:
    """Also those that are not here, or that rules remove."""
    met: Counter[Status] = Counter()
    for seed in range(60):
        rng = random.Random(seed)
        problem = random_problem(seed, list(ContainerRule)[seed % 2], units=12)
        gone, *both = rng.sample(MOTIONS, 3)
        kept = [tree for tree in oracle.trees(problem) if not {*both} <= {unit.motion for unit in tree}]
        kept = [tree for tree in kept if gone not in {unit.motion for unit in tree}]
        kept += [()] if oracle.makes(problem, ()) else []
        rules = ':- use(U), motion(U,"{}"). :- use(U), use(V), motion(U,"{}"), motion(V,"{}").'
        settings = Settings((given_constraint(rules.format(gone, *both)),))
        names = rng.choice((["units"], ["success"], ["inputs"]))
        known = {*rng.sample(range(15), rng.randrange(1, 15))}
        outcome = solve(problem, [*map(Objective, names)], settings, known=known)
        best = oracle.best(kept, problem, names)
        assert outcome.status is (Status.INFEASIBLE if best is None else Status.OPTIMAL), seed
        met[outcome.status] += 1
        if outcome.units is not None:
            tree = tuple(map(problem.network.unit, outcome.units))
            assert oracle.key(problem, tree, names) == best, seed
    assert len(met) == 2


def test_rules_that_were_applied_wrongly_are_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    """The tree that is given is held against the rules as the user wrote them."""
    monkeypatch.setattr(Rules, "applied", lambda *_: Restriction(lambda _: False))
    settings = Settings((given_constraint(':- use(U), motion(U,"boil").'),))
    problem = small(*BANNED, "mix: y > end", "cut: start > y", "fry: x > y")
    with pytest.raises(BugError, match="does not keep to the rules that were added"):
        solve(problem, settings=settings)
    with pytest.raises(BugError, match="does not keep to the rules that were added"):
        [*Ranked(problem, (Objective.UNITS,), settings)]


def test_cuts_of_sets_that_are_asked_for_are_not_shown() -> None:
    """They have no node that anybody could read."""
    problem = small("boil: start > end", "junk: start > x", "tidy: x > o")
    assert asked(problem, ':- not use(U) : motion(U,"tidy").').cuts == ((1,),)


def test_what_rounding_hides_is_looked_for_among_loose_ends(monkeypatch: pytest.MonkeyPatch) -> None:
    by, settings = (Objective.SUCCESS,), Settings((given_constraint(APART),))
    problem = replace(LOOSE, rates=dict.fromkeys(LOOSE.network.motions, Fraction(1, 2)))
    heard = _Heard(problem, by, Reporter())
    solver = _Solver(prepare(problem, by, settings, assemble(settings, print), heard), by, heard, {}, "own. ")
    before = solver.program
    loose = before._replace(files=(Path("other.lp"),))
    rounded: list[Objective | None] = [Objective.SUCCESS]
    best = frozenset({2, 4}), True

    def settle(_: _Solver, units: frozenset[int], fewest: int) -> tuple[frozenset[int], bool]:
        assert (solver.program, solver.rules, solver._loose) == (loose, "own. more.", True)
        assert units == {1}
        assert fewest == 1
        return best

    monkeypatch.setattr(_Solver, "_settle", settle)
    measured: list[frozenset[int]] = []
    monkeypatch.setattr(_Solver, "_measures_agree", lambda _, units, *__: measured.append(units))
    monkeypatch.setattr(_Solver, "_scaled", lambda _: SimpleNamespace(rounded=rounded[0]))

    def settled(known: set[int]) -> set[int] | None:
        ended = solver._settled_with_loose_ends(Run(frozenset({1})), loose, "more.", known, 1)
        assert (solver.program, solver.rules, solver._loose) == (before, "own. ", False)
        return None if ended is None or ended.units is None else {*ended.units}

    assert settled({1, 2, 4}) == {2, 4}
    assert settled({1, 2}) is None  # the best has loose ends
    best = frozenset({2, 4}), False
    assert settled({1, 2, 4}) is None
    rounded[0] = None
    assert settled({1, 2, 4}) == {1}
    assert measured == [{1}] * 4
    monkeypatch.undo()
    solver._look_at(range(17))
    for has_loose in (True, False):  # nobody hears of trees with loose ends
        solver._loose = has_loose
        assert solver._run(solver.levels).units is not None
        assert (heard.best is None) == has_loose


def test_that_there_is_no_tree_is_looked_at_again(monkeypatch: pytest.MonkeyPatch) -> None:
    problem = small("boil: start > end", "junk: start > x")
    assert asked(problem, ":- unit(0).").status is Status.INFEASIBLE  # which no look at the network tells
    monkeypatch.setattr(prepared_module, "reduce", lambda *_: Reduced(None, (), False, None, 0, None))
    with pytest.raises(BugError, match="there is no tree, but the goals can be made"):
        solve(problem)


def test_where_nothing_makes_the_goals_clingo_is_not_asked(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delattr("foon_asp.encoding.search.run")
    problem = replace(small("boil: start > end"), kitchen=frozenset())
    assert solve(problem).status is Status.INFEASIBLE


# --- Near the goals: a rule that asks for a unit which leads to no goal.

ROW = small(
    *(*BANNED, "mix: a > end", "cut: b > a", "chop: c > b", "fry: start > c", "junk: start > o"),
    "tidy: o > p",
)
TIDY = f'{APART}\n:- use(U), motion(U,"mix"), not use(V) : motion(V,"tidy").'
NEVER = f'{TIDY}\n:- use(U), use(V), motion(U,"junk"), motion(V,"tidy").'


def test_ever_more_units_near_the_goals_are_looked_at(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(solver_module, "_NEAR", 1)
    monkeypatch.setattr(solver_module, "_MORE", 2)
    near = Wide.nearest
    asked_for: list[int] = []

    def nearest(wide: Wide, most: int) -> frozenset[int]:
        asked_for.append(most)
        return near(wide, most) - {0}  # which is in the best tree, and stays

    monkeypatch.setattr(Wide, "nearest", nearest)
    looks = Looks(monkeypatch)
    assert says(asked(ROW, TIDY)) == (Status.OPTIMAL, {2, 3, 4, 5, 6, 7})
    assert asked_for == [1, 2, 4]  # and then all 8
    assert looks.units == [{0, 1, 2, 3, 4}] * 3 + [{*range(8)}]
    looks.units.clear()
    assert asked(ROW, NEVER).status is Status.INFEASIBLE
    assert len(looks.units) == 4


@pytest.mark.parametrize("tree", [None, {2, 3, 4, 5, 6, 7}])
def test_a_limit_near_the_goals_ends_the_search(
    tree: set[int] | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    units = None if tree is None else frozenset(map(ROW.network.unit_number, tree))
    searches = Searches(monkeypatch, None, Answer(Run(units)))
    outcome = asked(ROW, TIDY)
    assert says(outcome) == (Status.UNKNOWN if tree is None else Status.FEASIBLE, tree or set())
    assert len(searches.modes) == 2


def test_each_program_of_a_search_is_closed(monkeypatch: pytest.MonkeyPatch) -> None:
    made: Counter[str] = Counter()
    begin, close = Grounded.__init__, Grounded.close

    def beginning(grounded: Grounded, *given: Any) -> None:
        made["begun"] += 1
        begin(grounded, *given)

    def closing(grounded: Grounded) -> None:
        made["closed"] += 1
        close(grounded)

    monkeypatch.setattr(Grounded, "__init__", beginning)
    monkeypatch.setattr(Grounded, "close", closing)
    monkeypatch.setattr(solver_module, "_NEAR", 1)
    assert asked(ROW, TIDY).status is Status.OPTIMAL
    assert made["begun"] == made["closed"] > 2
