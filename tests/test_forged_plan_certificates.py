"""For every check of the verifier of plans a forged certificate that this check refuses, and no other.

As in ``test_forged_certificates.py``: each check is taken out of the source in turn, and then its forged
certificate has to pass, or where it does not, the table says why the check stays.
"""

import ast
import re
from fractions import Fraction
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import Any, NamedTuple

import pytest

from foon_asp.network import Network, NetworkBuilder, ObjectNode, Source, UnitPrices
from foon_asp.network.level import network_at_level
from foon_asp.proof import verify, verify_plan
from tests.handmade_certificate import forbid
from tests.test_forged_certificates import KIND, checks, module

SOURCE = Path(verify_plan.__file__).read_text(encoding="utf-8")


class Data(NamedTuple):
    """What a certificate is held against."""

    network: Network
    kitchen: frozenset[int]
    rates: dict[str, Fraction] | None
    utensils: frozenset[str] = frozenset()
    prices: UnitPrices | None = None

    def id(self, label: str) -> int:
        """Give the id of the node with a label."""
        return next(o for o, node in enumerate(self.network.objects) if node.label == label)


def data(units: list[tuple[str, str, str]], kitchen: str, **rates: str) -> Data:
    """Build a network of units, each with a motion and labels of inputs and outputs."""
    builder = NetworkBuilder()
    for line, (motion, inputs, outputs) in enumerate(units):
        nodes = [[ObjectNode.of(label) for label in labels.split()] for labels in (inputs, outputs)]
        builder.add(motion, nodes[0], nodes[1], Source("forged", line + 1))
    network = builder.build()
    at_hand = frozenset(o for o, node in enumerate(network.objects) if node.label in kitchen.split())
    found = {motion: Fraction(rates.get(motion, "1/2")) for motion, _, _ in units}
    return Data(network, at_hand, found)


def served() -> Data:
    """Build a network in which soup in a bowl needs no bowl that contains it."""
    builder = NetworkBuilder()
    water, meal = ObjectNode.of("water"), ObjectNode.of("meal")
    soup, bowl = (
        ObjectNode.of("soup", [], [("in", "bowl")]),
        ObjectNode.of("bowl", [], [], [("contains", ["soup"])]),
    )
    builder.add("cook", [water], [soup], Source("forged", 1))
    builder.add("serve", [bowl, soup], [meal], Source("forged", 2))
    return Data(builder.build(), frozenset({0}), None, frozenset({"bowl"}))


# Bread is baked of dough, which is mixed of flour without end and of salt, of which there is one; more can be
# bought. Bread could be melted of gold, too, but nobody has what gold is dug of.
PLAIN = data(
    [
        ("mix", "flour salt", "dough"),
        ("bake", "dough", "bread"),
        ("dig", "rare", "gold"),
        ("buy", "flour", "salt"),
        ("melt", "gold", "bread"),
    ],
    "flour salt",
    mix="3/4",
    bake="2/3",
)
FLOUR, SALT, DOUGH, BREAD, RARE, GOLD = map(PLAIN.id, ("flour", "salt", "dough", "bread", "rare", "gold"))
# Two cups are filled for a meal, with a pan that was warmed once.
TWICE = data(
    [
        ("warm", "tap", "pan"),
        ("fill", "tap pan", "cup pan"),
        ("turn", "cup", "dish"),
        ("serve", "cup dish", "meal"),
    ],
    "tap",
)
# Soup is served of a bowl that nobody makes, since it is taken as given under implied containers.
SOUP = served()
# The bread never succeeds.
NEVER = PLAIN._replace(rates={**(PLAIN.rates or {}), "bake": Fraction(0)})
PRICED = PLAIN._replace(
    prices=UnitPrices(
        {**dict.fromkeys(("mix", "dig", "buy", "melt"), Fraction(1, 2)), "bake": Fraction(1, 4)}, {}
    )
)
LEVEL = PLAIN._replace(network=network_at_level(PLAIN.network, 2))


def goal(label: str) -> list[dict[str, Any]]:
    """Name a goal as certificates do."""
    return [{"id": PLAIN.id(label), "node": label}]


PROOF = {"balance": [[DOUGH, "1"], [BREAD, "2"]]}


def certificate(at: Data, **values: Any) -> dict[str, Any]:
    """Give a certificate of the plain data with other values, sealed so that they fit."""
    content: dict[str, Any] = {
        "format": verify_plan.FORMAT,
        "version": verify_plan.VERSION,
        "claim": "optimal",
        "goals": goal("bread"),
        "containers": "strict",
        "level": 3,
        "items": {"stock": [[SALT, 1]], "stays": []},
        "objective": ["units"],
        "digests": verify.digests(*at),
        "rules": [],
        "measures": {},
        "not_covered": [],
        "tree": [0, 1],
        "costs": [2],
        "bound": None,
        "unreached": sorted([RARE, GOLD]),
        "cuts": [],
        "proof": [PROOF],
        **values,
    }
    return {"seal": verify.seal(content), **content}


class Forged(NamedTuple):
    """What only one check refuses, and the data it is held against; as in the other tables."""

    content: Any
    at: Data = PLAIN
    stays: str = ""


def plain(stays: str = "", at: Data = PLAIN, **values: Any) -> Forged:
    """Forge a certificate of some data by other values."""
    return Forged(certificate(at, **values), at, stays)


def bound(least: Any, proof: Any, **values: Any) -> Forged:
    """Forge a bound without a plan."""
    stated = {"claim": "bound", "tree": None, "costs": None, "bound": [least], "proof": [proof]}
    return plain(**{**stated, **values})


def items(stock: Any = (), stays: Any = ()) -> dict[str, Any]:
    """Give what is said of items."""
    return {"stock": list(stock), "stays": list(stays)}


NO_PLAN: dict[str, Any] = {"claim": "infeasible", "objective": [], "tree": None, "costs": None}
SPENT = {"balance": [[DOUGH, "1"], [BREAD, "1"]]}
CUT = {"weights": [[0, "1"]]}
ONE = bound("1", {"balance": [[BREAD, "1"]]})

MEAL: dict[str, Any] = {
    "goals": [{"id": TWICE.id("meal"), "node": "meal"}],
    "items": items(),
    "unreached": [],
    "cuts": [[TWICE.id("pan")]],
    "at": TWICE,
}


def fed(weight: str) -> dict[str, Any]:
    """Give a proof for the meal that is right if the cup is filled once at most."""
    sides = [[TWICE.id(label), weight] for label in ("cup", "dish")]
    both = [TWICE.id("meal"), str(2 * int(weight))]
    return {"balance": [*sides, both], "before": [[0, 1, weight]]}


FORGED: dict[str, Forged] = {
    # --- the frame
    "verify_plan: expected the format …": plain(format="a song"),
    "verify_plan: expected version … of the format": plain(version=99),
    "verify_plan: expected the keys …": plain(more=1),
    "verify_plan: the seal does not match: something was changed": Forged(
        {**certificate(PLAIN), "seal": "0" * 64}
    ),
    "verify_plan: not a claim about level …": plain(level=3.0, at=PLAIN),
    "verify_plan: below level 3 nothing says what is used up: contents decide": plain(level=2, at=LEVEL),
    "verify_plan: a rule that plans are not held against": plain(
        rules=[{"rule": "not_both_motions", "one_motion": "dig", "other_motion": "melt"}]
    ),
    "verify_plan: …: not the one that the certificate is about": plain(
        digests={**certificate(PLAIN)["digests"], "kitchen": "0" * 64}
    ),
    # --- what is never reached
    "idle: what is there at first is called unreached": plain(
        **NO_PLAN, unreached=sorted([FLOUR, RARE, GOLD]), proof=[SPENT]
    ),
    "idle: what a unit can add is called unreached": plain(
        **NO_PLAN, unreached=sorted([DOUGH, RARE, GOLD]), proof=[{"balance": [[BREAD, "1"]]}]
    ),
    "_members: a cut holds a kitchen item": plain(
        **NO_PLAN,
        cuts=[sorted([FLOUR, DOUGH, BREAD])],
        proof=[CUT],
        stays="an item is a member that brings what the cut does, and costs nothing",
    ),
    # --- the plan
    "_tree: expected ids of units in a plan": plain(tree=[False, 1]),
    "_tree: unit … of the plan lacks a copy of an input at step …": plain(
        tree=[1], costs=[1], proof=[{"balance": [[BREAD, "1"]]}]
    ),
    "_tree: a copy of a goal is not there in the end": plain(tree=[], costs=[0], proof=[{}]),
    # --- rules
    "_keep_counts: the plan has a unit that a rule removes": plain(rules=forbid(["bake"])),
    "_keep_counts: the plan lacks what a rule asks for": plain(
        rules=[{"rule": "require_motion", "required_motion": "buy"}]
    ),
    "_keep_counts: the plan exceeds what a rule limits": plain(
        rules=[{"rule": "at_most_units", "max_units": 1}]
    ),
    "_prove: expected a proof for each objective": plain(proof=[PROOF, PROOF]),
    "_prove: a rule allows no plan": bound(
        "9", {}, rules=[{"rule": "forbid_ingredient", "allergen": ["bread"]}], unreached=[]
    ),
    "_prove: a proof is given where a rule allows no plan": plain(
        **{**NO_PLAN, "unreached": []},
        rules=[{"rule": "forbid_ingredient", "allergen": ["bread"]}],
        proof=[5],
    ),
    # --- the proof
    "_divided: expected the most executions of a branch": plain(
        proof=[{"branch": {"unit": 1}, "most": True, "up_to": PROOF, "above": PROOF}]
    ),
    "_prove_part: expected weights of conditions or a branch": plain(proof=[{**PROOF, "more": []}]),
    "_cheapest: member … brings more than it costs, without end": plain(**NO_PLAN, **MEAL, proof=[fed("1")]),
    "kept: a unit that never succeeds is not compared": bound(
        {"3/4": "1"}, {"balance": [[BREAD, {"3/4": "1"}]]}, objective=["success"], at=NEVER, stays=KIND
    ),
    "_require_enough: the weights do not add up to enough": plain(proof=[{"balance": [[BREAD, "1"]]}]),
    "cut: expected the number of a cut": bound("1", {"weights": [[-1, "1"]]}, cuts=[[BREAD]]),
    "__init__: expected the id of a unit that a cut is before": plain(
        cuts=[[GOLD]], proof=[{**PROOF, "before": [[0, -1, "1"]]}]
    ),
    "__init__: a rule that limits nothing is given a weight": plain(
        proof=[{**PROOF, "limits": [[0, "1"]]}], stays=KIND
    ),
    "__init__: an objective that is not before this one is given a weight": bound(
        "0", {"levels": [[0, "1"]]}
    ),
    "_weighed: expected what has a weight by its number, and the weight": plain(
        proof=[{"balance": [[float(DOUGH), "1"], [BREAD, "2"]]}], stays=KIND
    ),
    "_weighed: expected weights in order, each once": plain(
        proof=[{"balance": [[BREAD, "2"], [DOUGH, "1"]]}]
    ),
    "_weighed: a weight is not above zero": bound("1", {"balance": [[SALT, "-1"]]}),
    "_cross: cut … holds neither a goal nor what the unit asks for": bound(
        "3", {**PROOF, "weights": [[0, "1"]]}, cuts=[sorted([GOLD, RARE])]
    ),
    "_balance: expected the id of a node in a balance": plain(
        proof=[{"balance": [[-1, "1"], *PROOF["balance"]]}]
    ),
    "_balance: what never runs out has no balance": plain(
        proof=[{"balance": [[FLOUR, "1"], *PROOF["balance"]]}]
    ),
    # --- items
    "_stock: expected items and their copies in stock": plain(items=items([[SALT, True]])),
    "_stock: expected items of the stock in order, each of them once": plain(
        items=items([[SALT, 0], [SALT, 1]])
    ),
    "_stock: expected kitchen items in stock": plain(items=items([[SALT, 1], [DOUGH, 0]])),
    "_told: expected labels and nodes, and whether they stay": plain(items=items([[SALT, 1]], [["salt", 0]])),
    "_told: expected labels, and then nodes": plain(
        items=items([[SALT, 1]], [[SALT, False], ["salt", False]])
    ),
    "_told: expected each of them once, in order": plain(
        items=items([[SALT, 1]], [["salt", True], ["salt", False]])
    ),
    "_told: expected ids of nodes that stay or go": plain(items=items([[SALT, 1]], [[99, False]])),
    "_told: a label has letters that cannot be printed": plain(
        items=items([[SALT, 1]], [["salt\nverified: all of it", False]])
    ),
}
CHECKS = {check.name: check.node for check in checks(ast.parse(SOURCE))}


@cache
def without(name: str) -> ModuleType:
    """Give the verifier without one of its checks."""
    gone, lines = CHECKS[name], SOURCE.split("\n")
    lines[gone.lineno - 1 : gone.end_lineno] = [" " * gone.col_offset + "pass"]
    return module("\n".join(lines))


def held(by: Any, forged: Forged) -> Any:
    """Hold a forged certificate against its data."""
    return by.verify_plan(forged.content, *forged.at)


def test_a_right_certificate_passes() -> None:
    assert held(verify_plan, plain()).claim == "optimal"
    assert held(verify_plan, ONE).claim == "bound"
    rules, goal_of_rule = [{"rule": "require_motion", "required_motion": "buy"}], len(PLAIN.network.objects)
    bought = bound("3", {**PROOF, "weights": [[0, "1"]]}, rules=rules, cuts=[[goal_of_rule]])
    assert held(verify_plan, bought).claim == "bound"
    assert held(verify_plan, plain(rules=[{"rule": "at_most_units", "max_units": 2}])).claim == "optimal"
    limited = plain(
        **NO_PLAN,
        rules=[{"rule": "at_most_units", "max_units": 1}],
        proof=[{**PROOF, "limits": [[0, "1"]]}],
    )
    assert held(verify_plan, limited).claim == "infeasible"
    taken = plain(**FLOURED, tree=[3, 0, 1], costs=[1], proof=[floured("1")])
    assert held(verify_plan, taken).claim == "optimal"
    nothing: dict[str, Any] = {"weights": [], "before": [], "limits": [], "levels": []}
    assert held(verify_plan, plain(proof=[{**PROOF, **nothing}])).claim == "optimal"
    unpriced = plain(
        **NO_PLAN, rules=[{"rule": "at_most_price", "max_price": 100}], cuts=[[BREAD]], proof=[CUT]
    )
    assert held(verify_plan, unpriced).claim == "infeasible"
    assert held(verify_plan, bound("3/4", BY_PRICE, objective=["price"], at=PRICED)).claim == "bound"
    assert held(verify_plan, bound("1", {"weights": [[0, "1"]]}, **TWO_BAGS)).claim == "bound"
    tainted = [{"rule": "forbid_ingredient", "allergen": ["bread"]}]
    assert held(verify_plan, plain(**NO_PLAN, rules=tainted, unreached=[], proof=[{}])).claim == "infeasible"


def test_every_check_has_a_forged_certificate() -> None:
    names = [check.name for check in checks(ast.parse(SOURCE))]
    assert len(set(names)) == len(names)
    assert {*names} == FORGED.keys()


@pytest.mark.parametrize("name", FORGED)
def test_a_forged_certificate_is_refused_by_its_check_alone(name: str) -> None:
    forged, said = FORGED[name], name.partition(": ")[2]
    with pytest.raises(verify.RefusedError, match=".*".join(map(re.escape, said.split("…")))):
        held(verify_plan, forged)
    if not forged.stays:
        assert type(held(without(name), forged)).__name__ == "Verified"
        return
    failed = failure(without(name), forged)
    assert (forged.stays == KIND) == (failed not in ("RefusedError", "LimitError"))


def test_what_is_nested_too_deeply_is_refused() -> None:
    content = certificate(PLAIN)
    for _ in range(10_000):
        content["proof"] = [content["proof"]]
    with pytest.raises(verify.RefusedError, match="branches nested too deeply"):
        verify_plan.verify_plan(content, *PLAIN)


def test_what_is_counted_is_below_a_billion() -> None:
    def branched(most: int) -> Forged:
        return plain(proof=[{"branch": {"unit": 1}, "most": most, "up_to": PROOF, "above": PROOF}])

    for made in (lambda count: plain(items=items([[SALT, count]])), branched):
        assert held(verify_plan, made(10**9 - 1)).claim == "optimal"
        with pytest.raises(verify.RefusedError):
            held(verify_plan, made(10**9))


def test_a_part_that_is_divided_again_by_the_same_unit_is_no_larger() -> None:
    def branch(most: int, up_to: Any, above: Any) -> Any:
        return {"branch": {"unit": 1}, "most": most, "up_to": up_to, "above": above}

    unbaked = branch(5, {"balance": [[BREAD, "9"]]}, {})  # still not at all, or else six times
    assert held(verify_plan, bound("2", branch(0, unbaked, PROOF))).claim == "bound"
    assert held(verify_plan, bound("2", branch(1, PROOF, branch(0, {}, {})))).claim == "bound"
    with pytest.raises(verify.RefusedError, match="do not add up"):
        held(verify_plan, bound("2", branch(0, PROOF, {})))


def failure(by: Any, forged: Forged) -> str:
    """Give the kind of error with which a forged certificate is not accepted."""
    try:
        held(by, forged)
    except Exception as error:
        return type(error).__name__
    pytest.fail("accepted")


# --- what refuses by what it computes


class Part(NamedTuple):
    """A part of the source that is no check by itself, a wrong one in its place, and what passes then."""

    right: str
    wrong: str
    forged: Forged


# Flour is taken: bread asks for dough, dough for flour.
FLOURED: dict[str, Any] = {"objective": ["kitchen"], "cuts": [[BREAD], [DOUGH], [FLOUR]]}


# Of flour, there are two bags, and one is all that is asked for.
TWO_BAGS: dict[str, Any] = {
    "objective": ["kitchen"],
    "goals": goal("flour"),
    "items": items([[FLOUR, 2]]),
    "cuts": [[FLOUR]],
}
BY_PRICE = {"balance": [[DOUGH, "1/2"], [BREAD, "3/4"]]}


def floured(weight: str) -> dict[str, Any]:
    """Give a proof that flour is taken, and that this costs so much."""
    return {"weights": [[0, weight]], "before": [[1, 1, weight], [2, 0, weight]]}


PARTS = {
    "copies in stock need not be made": Part(
        "(o in check.goals) - there",
        "(o in check.goals)",
        bound("1", {"balance": [[SALT, "1"]]}, goals=goal("salt")),
    ),
    "what costs less than two is executed once, at most": Part(
        "math.ceil(most / each) - 1 if exact",
        "math.ceil(most / each) - 2 if exact",
        bound("2", {"balance": [[DOUGH, "2"]]}, goals=goal("dough")),
    ),
    "what never runs out can be taken": Part(
        "self.stock.get(o, 1)",
        "self.stock.get(o, 0)",
        bound("2", floured("2"), **FLOURED),
    ),
    "what is asked for is taken of the kitchen": Part(
        "yield len(network) + o",
        "yield from ()",
        bound("2", floured("2"), **FLOURED),
    ),
    "a bound is rounded up to what executions cost": Part(
        'if objective == "attempts" else every',
        "if objective == 0 else every",
        bound("3", {"balance": [[DOUGH, "4/3"], [BREAD, "17/6"]]}, objective=["attempts"]),
    ),
    "a bound is rounded up to what units are priced at": Part(
        'every = self.prices if objective == "price" else []',
        'every = self.prices if objective != "price" else []',
        bound("1", BY_PRICE, objective=["price"], at=PRICED),
    ),
    "each copy that is taken crosses a cut": Part(
        "self.used if member < len(check.network) else self.executed",
        "self.used",
        bound("1", {"weights": [[0, "2"]]}, **TWO_BAGS),
    ),
    "what a plan uses up is gone": Part(
        "copies.subtract(uses - self.endless)",
        "pass",
        plain(claim="bound", bound=["2"], tree=[0, 1, 1], costs=[3]),
    ),
    "a copy of every input has to be there": Part(
        "all(o in self.endless or copies[o] > 0 for o in asks)",
        "any(o in self.endless or copies[o] > 0 for o in asks)",
        plain(items=items([[SALT, 0]])),
    ),
    "a goal in stock is taken of it": Part(
        "least[goal] = max(least[goal], 1 + self.stock[goal] - copies[goal])",
        "pass",
        plain(objective=["kitchen"], goals=goal("salt"), tree=[], costs=[0], proof=[{}]),
    ),
    "a copy in stock is there": Part(
        "self.stock.get(o, 0) > 0",
        "self.stock.get(o, 0) > 1",
        bound("3", {**PROOF, "weights": [[0, "1"]]}, cuts=[sorted([SALT, DOUGH, BREAD])]),
    ),
    "what a unit is let skip it does not ask for": Part(
        "for unit in network.consumers[o] if o in self.flow(unit).asks",
        "for unit in network.consumers[o]",
        plain(
            **NO_PLAN,
            goals=[{"id": 3, "node": "meal"}],
            containers="implied",
            items=items(),
            unreached=[2],
            proof=[{"balance": [[3, "1"]]}],
            at=SOUP,
        ),
    ),
    "a unit may bring the most": Part(
        "found.append(self._sum([self._times(each, Fraction(most or 0)), once]))",
        "pass",
        bound("6", fed("5"), **MEAL),
    ),
    "a unit need not be executed": Part(
        "found: list[Amount] = [{}] if low == 0 else []",
        "found: list[Amount] = [{}] if most == 0 else []",
        bound("3", {"balance": [[SALT, "1/2"], *PROOF["balance"]]}),
    ),
    "the part up to a count is proved, too": Part(
        'yield Part(proof["up_to"], part.least, {**part.most, member: up_to})',
        "pass",
        bound("3", {"branch": {"unit": 3}, "most": 0, "up_to": {}, "above": {"balance": PROOF["balance"]}}),
    ),
    "the part above a count is proved, too": Part(
        'yield Part(proof["above"], {**part.least, member: above}, part.most)',
        "yield from ()",
        bound("9", {"branch": {"unit": 1}, "most": 0, "up_to": {"balance": [[BREAD, "9"]]}, "above": {}}),
    ),
    "a bound is rounded up and no further": Part(
        "math.ceil(bound.get(at, Fraction(0)) * parts)",
        "math.ceil(bound.get(at, Fraction(0)) * parts) + 1",
        bound("3", PROOF),
    ),
    "where there is nothing to be bounded, a bound is above nothing": Part(
        "enough = self._sign(bound) > 0", "enough = self._sign(bound) >= 0", plain(**NO_PLAN, proof=[{}])
    ),
    "a cut before a unit says nothing where it is not executed": Part(
        "self.constant = check.sum_of(self.constant, weight, -1)\n",
        "pass\n",
        bound("3", {**PROOF, "before": [[0, 4, "1"]]}, cuts=[[GOLD]]),
    ),
    "a member of a cut may cross it": Part(
        "self._come(self.used if member < len(check.network) else self.executed, member, weight, -1)",
        "pass",
        bound("9", {"weights": [[0, "9"]]}, cuts=[[BREAD]]),
    ),
    "what is used up has to come": Part(
        "(o in flow.adds) - (o in flow.uses)",
        "-(o in flow.uses)",
        bound("9", {"balance": [[BREAD, "9"]]}),
    ),
    "what is left of a limit is taken from the bound": Part(
        "-ruled.limits[place].most",
        "0",
        bound(
            "3",
            {**PROOF, "limits": [[0, "1"]], "balance": [[DOUGH, "2"], [BREAD, "4"]]},
            rules=[{"rule": "at_most_units", "max_units": 2}],
        ),
    ),
}


@pytest.mark.parametrize("name", PARTS)
def test_a_part_that_is_wrong_lets_a_forged_certificate_pass(name: str) -> None:
    right, wrong, forged = PARTS[name]
    assert SOURCE.count(right) == 1
    with pytest.raises(verify.RefusedError):
        held(verify_plan, forged)
    assert type(held(module(SOURCE.replace(right, wrong)), forged)).__name__ == "Verified"
