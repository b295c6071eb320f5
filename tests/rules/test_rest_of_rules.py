"""Rules that look at several units at once: the best tree that keeps to them, near the goals and far off."""

import random
from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Any, NamedTuple

import pytest

from foon_asp.asp import Outcome, Settings, Status, solve
from foon_asp.asp.ranking import Ranked
from foon_asp.encoding import rate_scale
from foon_asp.encoding.run import Run
from foon_asp.errors import BugError
from foon_asp.hypergraph import ALL, NONE
from foon_asp.network import UnitPrices
from foon_asp.problem import ContainerRule, Objective, Problem, Restriction
from foon_asp.rules.passed_constraint import given_constraint
from foon_asp.rules.rules import Rules
from tests.asp.test_solver import Answer, Heard, answering
from tests.oracle import task_trees
from tests.rules.test_constraint_meanings import small
from tests.support.random_problems import MOTIONS, random_problem

UNITS, SUCCESS, INPUTS, PRICE = Objective.UNITS, Objective.SUCCESS, Objective.INPUTS, Objective.PRICE

# The best tree heats and boils, which the rule does not allow together.
APART = ':- use(U), use(V), motion(U,"heat"), motion(V,"boil").'
BANNED = ("heat: start > x", "boil: x > end")
# 2 needs y: of 3, which looks near and is far, or of 4
LOOSE = small(
    *(*BANNED, "mix: y > end", "cut: z > y", "chop: w, k > y", "rinse: s > z", "steam: s > z", "dry: r > s"),
    *("air: r > s", "hang: q > r", "pour: v > w", "fill: v > w", "knead: start > k", "grind: u > v"),
    *("peel: start > u", "soak: t > q", "wring: start > t", "junk: start > o"),
)
HALVES = dict.fromkeys(LOOSE.network.motions, Fraction(1, 2))
SURE = dict.fromkeys(LOOSE.network.motions, Fraction(1))
# tidying, which leads to no goal, is asked for; and then what it needs is not allowed
ROW = small(
    *(*BANNED, "mix: a > end", "cut: b > a", "chop: c > b", "fry: start > c", "junk: start > o"),
    "tidy: o > p",
)
TIDY = f'{APART}\n:- use(U), motion(U,"mix"), not use(V) : motion(V,"tidy").'
NEVER = f'{TIDY}\n:- use(U), use(V), motion(U,"junk"), motion(V,"tidy").'
FAR = small(
    *("heat: x > end", "boil: y > end", "cut: z > x", "chop: v > x", "mix: z > y", "fry: v > y"),
    *("wash: s > z", "rinse: t > z", "steam: s > v", "soak: t > v", "dry: g > s", "hang: g > s"),
    *("air: g > t", "sun: g > t", "grow: start > g"),
)
GROWN = "\n".join(f':- use(U), use(V), motion(U,"grow"), motion(V,"{m}").' for m in ("heat", "boil"))
# two prices that clingo cannot tell apart
PRICED = small(
    *(*BANNED, "mix: start > end", "fry: y > end", "cut: z > y", "chop: z > y", "wash: start > z"),
    *("rinse: start > z", "burn: start > end"),
)
PRICES = {**dict.fromkeys(PRICED.network.motions, Fraction(0)), "burn": Fraction(10**9)}
PRICES |= {"mix": Fraction("1.0000001"), "fry": Fraction(1)}
FINE = {**dict.fromkeys(("heat", "boil", "cut", "junk"), Fraction(1)), "mix": Fraction("0.9")}
WHOLE = small("junk: start > o", "cut: start > a", "mix: start, a > end", "fry: start, a, end > w")


class Asked(NamedTuple):
    """A question, and the cost of its best tree with its units where there is one such tree."""

    problem: Problem
    rule: str
    objective: Objective
    cost: Fraction | int | None
    units: set[int] | None = None


QUESTIONS = {
    "best of all": Asked(small("fry: start > end", *BANNED, "mix: y, x > end"), APART, UNITS, 1, {0}),
    "loose ends": Asked(LOOSE, APART, UNITS, 6),
    "fewest and best": Asked(replace(LOOSE, rates=HALVES), APART, SUCCESS, Fraction(1, 64)),
    "more and better": Asked(
        replace(LOOSE, rates=HALVES | {m: Fraction(1) for m in ("cut", "dry", "hang", "soak")}),
        *(APART, SUCCESS, Fraction(1, 8)),
    ),
    "as good and fewer": Asked(
        replace(LOOSE, rates=SURE | {"chop": Fraction("0.49"), "cut": Fraction("0.7"), "dry": Fraction("0.7")}
                | {"air": Fraction("0.1")}),
        *(APART, SUCCESS, Fraction("0.49"), None),
    ),
    "in order": Asked(
        small("fry: start > end", "cut: start > a", "fry: a > end"),
        *("before:earlier_motion=cut,later_motion=fry", UNITS, 2, {1, 2}),
    ),
    "far": Asked(FAR, GROWN, UNITS, None),
    "asked for beside": Asked(ROW, TIDY, UNITS, 6, {2, 3, 4, 5, 6, 7}),
    "asked for in vain": Asked(ROW, NEVER, UNITS, None),
    "one that no look tells": Asked(ROW, ":- unit(0).", UNITS, None),
    "rounded prices": Asked(replace(PRICED, unit_prices=UnitPrices(PRICES, {})), APART, PRICE, 1),
    "fine rates": Asked(
        replace(
            small(*BANNED, "mix: start > end", "fry: y > end", "cut: start > y"),
            rates={**FINE, "fry": Fraction("0.9000000001")},
        ),
        *(APART, SUCCESS, Fraction("0.9000000001"), {3, 4}),
    ),
    "fine rates and junk": Asked(
        replace(
            small("boil: start > end", "fry: start > end", "junk: start > x"),
            rates={**FINE, "boil": Fraction("0.9000000001"), "fry": Fraction("0.9")},
        ),
        ':- use(U), motion(U,"boil"), not use(V) : motion(V,"junk").',
        *(SUCCESS, Fraction("0.9000000001"), {0, 2}),
    ),
    "part of a network": Asked(
        replace(WHOLE, network=WHOLE.network.without((0,))), APART, INPUTS, 3, {0, 1}
    ),
}  # fmt: skip


def asked(problem: Problem, rule: str = APART, *objectives: Objective, **named: Any) -> Outcome:
    settings = Settings((given_constraint(rule),))._replace(**named)
    return solve(problem, objectives or (UNITS,), settings)


@pytest.mark.parametrize("question", QUESTIONS)
@pytest.mark.parametrize(
    "named",
    [{}, {"reductions": NONE}, {"clingo_options": ("--configuration=handy",)}],
    ids=["reduced", "searched", "with options"],
)
def test_the_best_tree_that_keeps_to_the_rules(question: str, named: dict[str, Any]) -> None:
    problem, rule, objective, cost, units = QUESTIONS[question]
    outcome = asked(problem, rule, objective, **named)
    if cost is None:
        assert (outcome.status, outcome.units) == (Status.INFEASIBLE, None)
        return
    assert outcome.status is Status.OPTIMAL
    assert outcome.costs is not None
    assert outcome.costs.measure(objective) == cost
    assert units is None or units == {*(outcome.units or ())}
    if "fewe" in question:
        assert outcome.costs.units == 6


@pytest.mark.parametrize("rule", [APART, TIDY, NEVER])
@pytest.mark.parametrize("searches", range(4))
def test_a_limit_after_some_searches_settles_nothing(
    rule: str, searches: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A search that ends with a tree, as far as it came, or without one."""
    problem = LOOSE if rule is APART else ROW
    best = asked(problem, rule)
    kept = frozenset({2, 4, 10, 12, 13, 14} if rule is APART else {2, 3, 4, 5, 6, 7})
    for found in (None, kept) if searches and rule is not NEVER else (None,):
        heard = Heard()
        at_limit = [Answer(Run(found))] * 30
        answering(monkeypatch, *[None] * searches, *at_limit)
        outcome = solve(problem, (UNITS,), Settings((given_constraint(rule),)), heard)
        monkeypatch.undo()
        if outcome.status in {Status.OPTIMAL, Status.INFEASIBLE}:
            assert (outcome.status, outcome.costs) == (best.status, best.costs)
            continue
        assert outcome.status is (Status.UNKNOWN if outcome.units is None else Status.FEASIBLE)
        assert (outcome.units is None) == (not heard.trees)
        assert outcome.units is None or {*outcome.units} == kept
        assert outcome.bounds.get(UNITS, 0) <= 6


@pytest.mark.parametrize(
    "seeds", [range(12), pytest.param(range(12, 30), marks=pytest.mark.slow)], ids=["few", "many"]
)
def test_units_that_mattered_before_may_be_any(seeds: Sequence[int], monkeypatch: pytest.MonkeyPatch) -> None:
    """Also those that are not here, or that rules remove; and of weights that tell little."""
    met: Counter[Status] = Counter()
    for seed in seeds:
        rng = random.Random(seed)
        problem = random_problem(seed, list(ContainerRule)[seed % 2], units=12)
        gone, *both = rng.sample(MOTIONS, 3)
        kept = [tree for tree in task_trees.trees(problem) if not {*both} <= {unit.motion for unit in tree}]
        kept = [tree for tree in kept if gone not in {unit.motion for unit in tree}]
        rules = f':- use(U), motion(U,"{gone}").' + APART.replace("heat", both[0]).replace("boil", both[1])
        names = rng.choice((["units"], ["success"], ["inputs"], ["success", "units"]))
        best = task_trees.best(kept, problem, names)
        known = {*rng.sample(range(15), rng.randrange(1, 15))}
        settings = Settings((given_constraint(rules),))
        with monkeypatch.context() as patch:
            if seed % 2:
                patch.setattr(rate_scale, "_scale", lambda _: 2)
            for before in (None, known, known):  # and those that mattered in this one
                outcome = solve(problem, [*map(Objective, names)], settings, mattered=before)
                assert outcome.status is (Status.INFEASIBLE if best is None else Status.OPTIMAL), seed
                met[outcome.status] += 1
                if outcome.units is not None:
                    tree = tuple(map(problem.network.unit, outcome.units))
                    assert task_trees.key(problem, tree, names) == best, seed
    assert len(met) == 2


def test_units_that_matter_are_told() -> None:
    known = set[int]()
    for _ in range(2):
        outcome = solve(LOOSE, (UNITS,), Settings((given_constraint(APART),)), mattered=known)
        assert outcome.costs is not None
        assert outcome.costs.units == 6
        assert known > {2, 4, 12, 13, 14}


def test_rules_that_were_applied_wrongly_are_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    """The tree that is given is held against the rules as the user wrote them."""
    monkeypatch.setattr(Rules, "restriction_of", lambda *_: Restriction(lambda _: False))
    settings = Settings((given_constraint(':- use(U), motion(U,"boil").'),))
    problem = small(*BANNED, "mix: y > end", "cut: start > y", "fry: x > y")
    with pytest.raises(BugError, match="does not keep to the rules that were added"):
        solve(problem, settings=settings)
    with pytest.raises(BugError, match="does not keep to the rules that were added"):
        [*Ranked(problem, (UNITS,), settings)]


def test_cuts_of_sets_that_are_asked_for_are_not_shown() -> None:
    """They have no node that anybody could read."""
    problem = small("boil: start > end", "junk: start > x", "tidy: x > o")
    assert asked(problem, ':- not use(U) : motion(U,"tidy").', reductions=ALL).cuts == ((1,),)
