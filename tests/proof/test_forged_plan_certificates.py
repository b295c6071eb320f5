"""For every check of the verifier of plans a forged certificate that this check refuses, and no other.

As in ``test_forged_certificates.py``: each check is taken out of the source in turn, and then its forged
certificate has to pass, or where it does not, the table says why the check stays.
"""

from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

from foon_asp.network import Edit, StandInTable, UnitAmounts, UnitPrices
from foon_asp.network.level import network_at_level
from foon_asp.problem import ContainerRule, Problem
from foon_asp.proof import certificate_items, unit_flows, verify_plan
from foon_asp.proof.certificate_header import seal
from foon_asp.proof.refusal import RefusedError
from foon_asp.standins import with_stand_ins
from tests.proof.by_hand import NO_TREE, bound, goals, recipe
from tests.proof.forging import KIND, Forged, Part, checks, held, require_its_check_alone, require_right
from tests.support.handmade_certificate import Content, forbid, handmade

# Each module imports only those before it.
VERIFIER = (certificate_items, unit_flows, verify_plan)

# Bread is baked of dough, which is mixed of flour without end and of salt, of which there is one; more can be
# bought. Bread could be melted of gold, too, but nobody has what gold is dug of.
PLAIN = recipe(
    *("mix: flour + salt > dough", "bake: dough > bread", "dig: rare > gold", "buy: flour > salt"),
    "melt: gold > bread",
    kitchen="flour + salt",
    rates={"mix": "3/4", "bake": "2/3"},
)
FLOUR, SALT, DOUGH, BREAD, RARE, GOLD = range(6)
# Two cups are filled for a meal, with a pan that was warmed once.
TWICE = recipe(
    *("warm: tap > pan", "fill: tap + pan > cup + pan", "turn: cup > dish", "serve: cup + dish > meal"),
    kitchen="tap",
)
PAN, CUP, DISH, DINNER = range(1, 5)
# Soup is served of a bowl that nobody makes, since it is taken as given under implied containers.
SOUP = recipe(
    *("cook: water > soup; in [bowl]", "serve: bowl; contains {soup} + soup; in [bowl] > meal"),
    kitchen="water",
    utensils="bowl",
)
STACKED = recipe(
    "serve: bowl; contains {soup} + soup; in [bowl] > meal + bowl; contains {soup}",
    kitchen="soup; in [bowl]",
    goals="bowl; contains {soup}",
    utensils="bowl",
)
STACKED = replace(STACKED, containers=ContainerRule.IMPLIED)
# The bread never succeeds.
NEVER = replace(PLAIN, rates={**(PLAIN.rates or {}), "bake": Fraction(0)})
PRICES = {**dict.fromkeys(PLAIN.network.motions, Fraction(1, 2)), "bake": Fraction(1, 4)}
PRICED = replace(PLAIN, unit_prices=UnitPrices(PRICES, {}))
# Sliced soup may stand in for diced soup, for one half.
HALVES = dict.fromkeys((Edit.MORE_STATE, Edit.FEWER_STATE), Fraction(1, 4))
REPLACED = with_stand_ins(
    recipe("sip: soup; sliced > tea", "serve: soup; diced > meal", kitchen="soup; sliced"),
    StandInTable({**StandInTable.usual().edits, **HALVES}, {}, {}),
)
LEVEL = replace(PLAIN, network=network_at_level(PLAIN.network, 2))


# Of salt, two are mixed; and two of gold are dug, which changes nothing.
MIX, DIG = PLAIN.network.unit(0), PLAIN.network.unit(2)
COUNTED = replace(PLAIN, amounts={MIX: UnitAmounts({PLAIN.network.objects[SALT]: 2})})
DUG = replace(PLAIN, amounts={DIG: UnitAmounts({}, {PLAIN.network.objects[GOLD]: 2})})
# Baking makes two loaves, and salt is bought by twos.
BAKE, BUY = PLAIN.network.unit(1), PLAIN.network.unit(3)
FROM_TWO = replace(
    PLAIN,
    amounts={
        BAKE: UnitAmounts({}, {PLAIN.network.objects[BREAD]: 2}),
        BUY: UnitAmounts({}, {PLAIN.network.objects[SALT]: 2}),
    },
)


def proving(**more: Any) -> Content:
    """Return the proof that bread takes mixing and baking, with more conditions."""
    return {"balance": [[DOUGH, "1"], [BREAD, "2"]], **more}


def items(stock: Any = (), stays: Any = (), wanted: Any = (), amounts: Any = ()) -> Content:
    """Return what is said of items."""
    return {"stock": [*stock], "stays": [*stays], "wanted": [*wanted], "amounts": [*amounts]}


PROOF = proving()
BREAD_ONCE = {"balance": [[BREAD, "1"]]}
BREAD_OFTEN = {"balance": [[BREAD, "9"]]}


def certificate(at: Problem = PLAIN, **values: Any) -> Content:
    """Return a right certificate of a plan of the plain data with other values, sealed so that they fit."""
    frame = {
        "format": verify_plan.PLAN.name,
        "version": verify_plan.PLAN.version,
        "items": items([[SALT, 1]]),
    }
    right = {"tree": [0, 1], "costs": [2], "unreached": [RARE, GOLD], "rounded": [], "proof": [PROOF]}
    content = {**handmade(at), **frame, **right, **values}
    return {**content, "seal": seal(content)}


def plain(stays: str = "", at: Problem = PLAIN, **values: Any) -> Forged:
    """Forge a certificate of some data by other values."""
    return Forged(certificate(at, **values), at, stays)


def at_least(least: Any, proof: Any, **values: Any) -> Forged:
    """Forge a bound without a plan."""
    return plain(**{**bound(least), "proof": [proof], **values})


def at_most(units: int) -> list[Content]:
    return [{"rule": "at_most_units", "max_units": units}]


SPOILED = [{"rule": "forbid_ingredient", "allergen": ["bread"]}]
WARMED_ONCE = [{"rule": "at_most_motion", "limited_motion": "warm", "max_uses": 1}]
SPENT = {"balance": [[DOUGH, "1"], [BREAD, "1"]]}
CUT = {"weights": [[0, "1"]]}
MEAL: Content = {"items": items(), "unreached": [], "cuts": [[PAN]], "at": TWICE}


def fed(weight: int) -> Content:
    """Return a proof for the meal that is right if the cup is filled once at most."""
    balance = [[CUP, str(weight)], [DISH, str(weight)], [DINNER, str(2 * weight)]]
    return {"balance": balance, "before": [[0, 1, str(weight)]]}


# Flour is taken: bread asks for dough, dough for flour.
FLOURED: Content = {"objective": ["kitchen"], "cuts": [[BREAD], [DOUGH], [FLOUR]]}


# Of flour, there are two bags, and one is all that is asked for.
TWO_BAGS: Content = {
    "objective": ["kitchen"],
    **goals(PLAIN, FLOUR),
    "items": items([[FLOUR, 2]]),
    "cuts": [[FLOUR]],
}
BY_PRICE = {"balance": [[DOUGH, "1/2"], [BREAD, "3/4"]]}


def floured(weight: str) -> Content:
    """Return a proof that flour is taken, and that this costs so much."""
    return {"weights": [[0, weight]], "before": [[1, 1, weight], [2, 0, weight]]}


def branch(most: int, up_to: Any, above: Any) -> Content:
    """Divide plans by how often they bake."""
    return {"branch": {"unit": 1}, "most": most, "up_to": up_to, "above": above}


TWO_SALTS: Content = {"items": items([[SALT, 1]], (), (), [[0, [[SALT, 2]], []]]), "at": COUNTED}


def supplied(least: str) -> Forged:
    """Return a certificate that salt is bought before it is mixed, which is right for 3."""
    proof = {"weights": [[0, least], [1, "1"]], "supply": [[SALT, 0, "1"]]}
    return at_least(least, proof, cuts=[[DOUGH, BREAD], [BREAD]], **TWO_SALTS)


def rounded(least: str, weight: str) -> Forged:
    """Return a certificate that salt is bought and bread made, both by twos, which is right for 2."""
    goal = goals(FROM_TWO, SALT, BREAD)
    amounts = [[1, [], [[BREAD, 2]]], [3, [], [[SALT, 2]]]]
    return at_least(
        *(least, {"rounded": [[0, weight], [1, weight]]}),
        **{**goal, "items": items([[SALT, 1]], (), [[SALT, 2]], amounts), "at": FROM_TWO},
        rounded=[{"balance": [[SALT, "1/3"]]}, {"balance": [[BREAD, "1/3"]]}],
    )


FORGED: dict[str, Forged] = {
    # --- the frame
    "verify_plan: below level 3 nothing says what is used up: contents decide": plain(level=2, at=LEVEL),
    "verify_plan: a rule that plans are not held against": plain(
        rules=[{"rule": "not_both_motions", "one_motion": "dig", "other_motion": "melt"}]
    ),
    # --- what is never reached
    "idle: what is there at first is called unreached": plain(
        **NO_TREE, unreached=[FLOUR, RARE, GOLD], proof=[SPENT]
    ),
    "idle: what a unit can add is called unreached": plain(
        **NO_TREE, unreached=[DOUGH, RARE, GOLD], proof=[BREAD_ONCE]
    ),
    "_landmark: a cut holds a kitchen item": plain(
        **NO_TREE,
        cuts=[[FLOUR, DOUGH, BREAD]],
        proof=[CUT],
        stays="an item is a member that brings what the cut does, and costs nothing",
    ),
    # --- the plan
    "_execute: unit … of the plan lacks a copy of an input at step …": plain(
        tree=[1], costs=[1], proof=[BREAD_ONCE]
    ),
    "_execute: a copy of a goal is not there in the end": plain(tree=[], costs=[0], proof=[{}]),
    # --- rules
    "_require_kept_rules_by_counts: the plan has a unit that a rule removes": plain(rules=forbid(["bake"])),
    "_require_kept_rules_by_counts: the plan lacks what a rule asks for": plain(
        rules=[{"rule": "require_motion", "required_motion": "buy"}]
    ),
    "_require_kept_rules_by_counts: the plan exceeds what a rule limits": plain(rules=at_most(1)),
    "_check_proof: expected a proof for each objective": plain(proof=[PROOF, PROOF]),
    "_check_proof: a rule allows no plan": at_least("9", {}, rules=SPOILED, unreached=[]),
    "_check_proof: a proof is given where a rule allows no plan": plain(
        **{**NO_TREE, "unreached": []},
        rules=SPOILED,
        proof=[5],
    ),
    # --- the proof
    "_check_leaf: expected weights of conditions or a branch": plain(proof=[proving(more=[])]),
    "_least_reduced_cost: member … brings more than it costs, without end": plain(
        **NO_TREE, **MEAL, proof=[fed(1)]
    ),
    "cost_lower_bound: a unit that never succeeds is not compared": at_least(
        {"3/4": "1"}, {"balance": [[BREAD, {"3/4": "1"}]]}, objective=["success"], at=NEVER, stays=KIND
    ),
    "_read_rounded: expected sums of conditions": plain(rounded=[{"more": [], "balance": [[BREAD, "1/2"]]}]),
    "_read_rounded: what is rounded has a weight that is not above zero": plain(
        rounded=[{"balance": [[BREAD, "-1/2"]]}]
    ),
    "_round_row: a sum is rounded that is whole": plain(rounded=[{"balance": [[BREAD, "1"]]}], stays=KIND),
    "_require_enough: the weights do not add up to enough": plain(proof=[BREAD_ONCE]),
    "__init__: an objective that is not before this one is given a weight": at_least(
        "0", {"levels": [[0, "1"]]}
    ),
    "_add_cut: cut … holds neither a goal nor what the unit asks for": at_least(
        "3", proving(weights=[[0, "1"]]), cuts=[[RARE, GOLD]]
    ),
    "balance: what never runs out has no balance": plain(
        proof=[{"balance": [[FLOUR, "1"], *PROOF["balance"]]}]
    ),
    # --- items
    "__init__: an amount of a goal is not above 1": plain(items=items([[SALT, 1]], (), [[BREAD, 1]])),
    "__init__: an amount is wanted of what is no goal": plain(items=items([[SALT, 1]], (), [[DOUGH, 2]])),
    "read_amounts: expected …": plain(at=DUG, items=items([[SALT, 1]], (), (), [[2.0, [], [[GOLD, 2]]]])),
    "read_amounts: the amounts of units are not those of the data": plain(
        items=items([[SALT, 1]], (), (), [[2, [], [[GOLD, 2]]]])
    ),
    "_add_supply: what never runs out needs no supply": plain(proof=[proving(supply=[[FLOUR, 0, "1"]])]),
    "read_copies: expected … in order, each of them once": plain(items=items([[SALT, 0], [SALT, 1]])),
    "read_stock: expected kitchen items in stock": plain(items=items([[SALT, 1], [DOUGH, 0]])),
    "read_stays: expected …": plain(items=items([[SALT, 1]], [["salt", 0]])),
    "read_stays: expected labels, and then nodes": plain(
        items=items([[SALT, 1]], [[SALT, False], ["salt", False]])
    ),
    "read_stays: expected each of them once, in order": plain(
        items=items([[SALT, 1]], [["salt", True], ["salt", False]])
    ),
    "read_stays: expected ids of nodes that stay or go": plain(items=items([[SALT, 1]], [[99, False]])),
    "read_stays: a label has letters that cannot be printed": plain(
        items=items([[SALT, 1]], [["salt\nverified: all of it", False]])
    ),
}

# What is read as in certificates of trees.
PLACES: dict[str, Forged] = {
    "expected items and their copies in stock": plain(items=items([[SALT, True]])),
    "expected the format": plain(format="a song"),
    "expected version 3 of the format": plain(version=99),
    "expected the keys": plain(more=1),
    "not a claim about level 3": plain(level=3.0),
    "the seal does not match: something was changed": Forged(certificate() | {"seal": "0"}, PLAIN),
    "kitchen: not the one that the certificate is about": plain(
        digests={**certificate()["digests"], "kitchen": "0"}
    ),
    "expected ids of units in a plan": plain(tree=[False, 1]),
    "expected the most executions of a branch": plain(proof=[branch(True, PROOF, PROOF)]),
    "expected the number of a cut": at_least("1", {"weights": [[-1, "1"]]}, cuts=[[BREAD]]),
    "expected the id of a unit that a cut is before": plain(
        cuts=[[GOLD]], proof=[proving(before=[[0, -1, "1"]])]
    ),
    "a rule that limits nothing is given a weight": plain(proof=[proving(limits=[[0, "1"]])]),
    "balance: expected what has a weight by its number, and the weight": plain(
        proof=[{"balance": [[float(DOUGH), "1"], [BREAD, "2"]]}]
    ),
    "balance: expected weights in order, each once": plain(proof=[{"balance": [[BREAD, "2"], [DOUGH, "1"]]}]),
    "balance: a weight is not above zero": at_least("1", {"balance": [[SALT, "-1"]]}),
    "expected the id of a unit that is supplied": plain(proof=[proving(supply=[[SALT, -1, "1"]])]),
    "expected the number of an earlier rounded sum": plain(rounded=[{"rounded": [[0, "1/2"]]}]),
    "expected the number of a rounded sum": plain(proof=[proving(rounded=[[0, "1"]])]),
    "expected the id of a node in a supply": plain(proof=[proving(supply=[[-1, 0, "1"]])]),
    "expected the id of a node in a balance": plain(proof=[{"balance": [[-1, "1"], *PROOF["balance"]]}]),
}


def test_right_certificates_pass(tmp_path: Path) -> None:
    goal_of_rule = len(PLAIN.network.objects)
    nothing: Content = {"weights": [], "before": [], "limits": [], "levels": []}
    optimal = (
        plain(),
        plain(rules=at_most(2)),
        plain(proof=[proving(**nothing)]),
        plain(**FLOURED, tree=[3, 0, 1], costs=[1], proof=[floured("1")]),
        plain(items=items([[SALT, 10**9 - 1]])),
        plain(proof=[branch(10**9 - 1, PROOF, PROOF)]),
    )
    bounds = (
        supplied("3"),
        rounded("2", "1"),
        at_least("3", {"balance": [[SALT, "1"], [DOUGH, "3"], [BREAD, "4"]]}, **TWO_SALTS),
        at_least("1", BREAD_ONCE),
        at_least(
            *("3", proving(**CUT)),
            rules=[{"rule": "require_motion", "required_motion": "buy"}],
            cuts=[[goal_of_rule]],
        ),
        at_least("3/4", BY_PRICE, objective=["price"], at=PRICED),
        at_least("1", CUT, **TWO_BAGS),
        # still not at all, or else six times
        at_least("2", branch(0, branch(5, BREAD_OFTEN, {}), PROOF)),
        at_least("2", branch(1, PROOF, branch(0, {}, {}))),
    )
    none = (
        plain(**NO_TREE, rules=at_most(1), proof=[proving(limits=[[0, "1"]])]),
        plain(**NO_TREE, rules=at_most(0), proof=[BREAD_ONCE]),
        plain(**NO_TREE, rules=[{"rule": "at_most_price", "max_price": 100}], cuts=[[BREAD]], proof=[CUT]),
        plain(**NO_TREE, rules=SPOILED, unreached=[], proof=[{}]),
        # the bowl is not added by what skips it
        plain(at=STACKED, **NO_TREE, items=items(), unreached=[], cuts=[[0]], proof=[CUT]),
    )
    for claim, certificates in (("optimal", optimal), ("bound", bounds), ("infeasible", none)):
        for each in certificates:
            assert held(VERIFIER, each, tmp_path).claim == claim
    wrong = (
        plain(items=items([[SALT, 10**9]])),
        plain(proof=[branch(10**9, PROOF, PROOF)]),
        at_least("2", branch(0, PROOF, {})),
        # what may be executed is told by the cost of its own objective
        plain(**bound("9", "1"), objective=["inputs", "units"], proof=[BREAD_OFTEN, BREAD_ONCE]),
        plain(**bound("1", "9"), objective=["units", "inputs"], proof=[BREAD_ONCE, BREAD_OFTEN]),
        plain(**NO_TREE, **MEAL, rules=WARMED_ONCE, proof=[fed(1)]),  # a cup may be filled more often
        at_least("2", {"balance": [[FLOUR, "2"]]}, **{**TWO_BAGS, "cuts": []}),  # the bag that is taken
    )
    for each in wrong:
        with pytest.raises(RefusedError):
            held(VERIFIER, each, tmp_path)


def test_every_check_has_a_forged_certificate() -> None:
    names = [name for name, _ in checks(VERIFIER)]
    assert len(set(names)) == len(names)
    assert {*names} == FORGED.keys()


@pytest.mark.parametrize("name", FORGED)
def test_a_forged_certificate_is_refused_by_its_check_alone(name: str, tmp_path: Path) -> None:
    require_its_check_alone(VERIFIER, name, FORGED[name], tmp_path)


@pytest.mark.parametrize("said", PLACES)
def test_each_place_is_read(said: str, tmp_path: Path) -> None:
    with pytest.raises(RefusedError, match=said):
        held(VERIFIER, PLACES[said], tmp_path)


def test_what_is_nested_too_deeply_is_refused(tmp_path: Path) -> None:
    content = certificate()
    for _ in range(10_000):
        content["proof"] = [content["proof"]]
    with pytest.raises(RefusedError, match="branches nested too deeply"):
        held(VERIFIER, Forged(content, PLAIN), tmp_path)


# --- what refuses by what it computes

PARTS = {
    "a sum is at least the next whole number": Part(
        "for unit, n in coefficients.items()}, math.ceil(least)",
        "for unit, n in coefficients.items()}, math.ceil(least) + 1",
        rounded("4", "1"),
    ),
    "a coefficient is rounded by its part": Part(
        "below + min(Fraction(1), (coefficient - below) / fraction)", "Fraction(below)", rounded("4", "2")
    ),
    "copies in stock need not be made": Part(
        "wanted - self._initial_copies(o, weight)",
        "wanted",
        at_least("1", {"balance": [[SALT, "1"]]}, **goals(PLAIN, SALT)),
    ),
    "what costs less than two is executed once, at most": Part(
        "math.ceil(max_cost / per_execution) - 1 if is_strict",
        "math.ceil(max_cost / per_execution) - 2 if is_strict",
        at_least("2", {"balance": [[DOUGH, "2"]]}, **goals(PLAIN, DOUGH)),
    ),
    "what never runs out can be taken": Part(
        "self.stock.get(o, 1)",
        "self.stock.get(o, 0)",
        at_least("2", floured("2"), **FLOURED),
    ),
    "what is asked for is taken of the kitchen": Part(
        "yield from [len(network) + o] * items_count",
        "yield from ()",
        at_least("2", floured("2"), **FLOURED),
    ),
    "a bound is rounded up to what executions cost": Part(
        'elif objective == "attempts":',
        "elif objective == 0:",
        at_least("3", {"balance": [[DOUGH, "4/3"], [BREAD, "17/6"]]}, objective=["attempts"]),
    ),
    "a bound by dissimilarity is not rounded up": Part(
        'objective in {"success", "dissimilarity"}',
        'objective == "success"',
        at_least(
            "1",
            {"weights": [[0, "1/2"]]},
            objective=["dissimilarity"],
            items=items(),
            unreached=[],
            cuts=[[2, 3]],
            at=REPLACED,
        ),
    ),
    "a bound is rounded up to what units are priced at": Part(
        'if objective == "price":',
        'if objective != "price":',
        at_least("1", BY_PRICE, objective=["price"], at=PRICED),
    ),
    "each copy that is taken crosses a cut": Part(
        "self.used if member < len(check.network) else self.executed",
        "self.used",
        at_least("1", {"weights": [[0, "2"]]}, **TWO_BAGS),
    ),
    "what a plan uses up is gone": Part(
        "copies.subtract({o: n for o, n in uses.items() if o not in self.endless})",
        "pass",
        plain(claim="bound", bound=["2"], tree=[0, 1, 1], costs=[3]),
    ),
    "a copy of every input has to be there": Part(
        "all(o in self.endless or copies[o] >= n for o, n in asks.items())",
        "any(o in self.endless or copies[o] >= n for o, n in asks.items())",
        plain(items=items([[SALT, 0]])),
    ),
    "a goal in stock is taken of it": Part(
        "initial_needed[goal] = max(initial_needed[goal], needed)",
        "pass",
        plain(objective=["kitchen"], **goals(PLAIN, SALT), tree=[], costs=[0], proof=[{}]),
    ),
    "a copy in stock is there": Part(
        "self.stock.get(o, 0) > 0",
        "self.stock.get(o, 0) > 1",
        plain(**{**NO_TREE, "unreached": [SALT, RARE, GOLD]}, rules=forbid(["buy"]), proof=[SPENT]),
    ),
    "a unit asks for as many as the data say": Part(
        "asks = {o: input_amounts.get(o, 1) for o in self.needs(unit) if o is not None}",
        "asks = {o: 1 for o in self.needs(unit) if o is not None}",
        plain(**TWO_SALTS),
        unit_flows,
    ),
    "a unit is supplied with what it asks for": Part(
        "check.flow(supplied).asks.get(o, 0)", "check.flow(supplied).asks.get(o, 0) + 1", supplied("4")
    ),
    "as many of a goal are wanted as is said": Part(
        "return self.wanted_stated.get(goal, 1)",
        "return 1",
        plain(items=items([[SALT, 1]], (), [[BREAD, 2]])),
    ),
    "what a unit is let skip it does not ask for": Part(
        "for unit in network.consumers[o] if o in self.flow(unit).asks",
        "for unit in network.consumers[o]",
        plain(
            **NO_TREE,
            containers="implied",
            items=items(),
            unreached=[2],
            proof=[{"balance": [[3, "1"]]}],
            at=SOUP,
        ),
    ),
    "a unit may bring the most": Part(
        "ends.append(arithmetic.sum([arithmetic.times(per_execution, Fraction(high or 0)), once]))",
        "pass",
        at_least("6", fed(5), **MEAL),
    ),
    "a unit need not be executed": Part(
        "ends: list[Amount] = [{}] if low == 0 else []",
        "ends: list[Amount] = [{}] if high == 0 else []",
        at_least("3", {"balance": [[SALT, "1/2"], *PROOF["balance"]]}),
    ),
    "the part up to a count is proved, too": Part(
        'yield Node(proof["up_to"], node.min_counts, {**node.max_counts, member: up_to})',
        "pass",
        at_least("3", {**branch(0, {}, PROOF), "branch": {"unit": 3}}),
    ),
    "the part above a count is proved, too": Part(
        'yield Node(proof["above"], {**node.min_counts, member: above}, node.max_counts)',
        "yield from ()",
        at_least("9", branch(0, BREAD_OFTEN, {})),
    ),
    "a bound is rounded up and no further": Part(
        "math.ceil(bound.get(key, Fraction(0)) * denominator)",
        "math.ceil(bound.get(key, Fraction(0)) * denominator) + 1",
        at_least("3", PROOF),
    ),
    "where there is nothing to be bounded, a bound is above nothing": Part(
        "enough = self.arithmetic.sign(bound) > 0",
        "enough = self.arithmetic.sign(bound) >= 0",
        plain(**NO_TREE, proof=[{}]),
    ),
    "a cut before a unit says nothing where it is not executed": Part(
        "            self._add_to_constant(weight, -1)\n",
        "            pass\n",
        at_least("3", proving(before=[[0, 4, "1"]]), cuts=[[GOLD]]),
    ),
    "a member of a cut may cross it": Part(
        "self._add_coefficient(coefficients, member, weight, -1)",
        "pass",
        at_least("9", {"weights": [[0, "9"]]}, cuts=[[BREAD]]),
    ),
    "what is used up has to come": Part(
        "flow.adds.get(o, 0) - flow.uses.get(o, 0)",
        "-flow.uses.get(o, 0)",
        at_least("9", BREAD_OFTEN),
    ),
    "what is left of a limit is taken from the bound": Part(
        "self._add_to_constant(weight, -limit.max_sum)",
        "self._add_to_constant(weight, 0)",
        at_least(
            "3",
            {"limits": [[0, "1"]], "balance": [[DOUGH, "2"], [BREAD, "4"]]},
            rules=at_most(2),
        ),
    ),
}


@pytest.mark.parametrize("name", PARTS)
def test_a_part_that_is_wrong_lets_a_forged_certificate_pass(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    require_right(PARTS[name], tmp_path, monkeypatch, VERIFIER)
