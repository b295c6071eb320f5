"""For every check of the verifier a forged certificate that this check refuses, and no other.

Each check is taken out of the source in turn. Then its forged certificate has to pass, or where it does not,
the table says why the check stays all the same. So none is missing here, and none is there for nothing.
"""

import hashlib
import json
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

from foon_asp.network import StandInTable, UnitPrices
from foon_asp.problem import Problem, StandIns
from foon_asp.proof import (
    certificate_fields,
    certificate_header,
    certificate_json,
    certificate_rules,
    compiled_rules,
    exact_amounts,
    refusal,
    rule_meaning,
    step_budget,
    unit_costs,
    verifier,
)
from foon_asp.proof.refusal import RefusedError
from tests.proof.by_hand import (
    BAKE,
    END,
    HOPELESS,
    MIDDLE,
    MIX,
    NO_TREE,
    PLAIN,
    POUR,
    RARE,
    SALT,
    START,
    UNPROVED,
    bound,
    branch,
    goals,
    recipe,
    weigh,
)
from tests.proof.forging import (
    KIND,
    WORDS,
    Forged,
    Part,
    checks,
    held,
    require_its_check_alone,
    require_right,
)
from tests.support.handmade_certificate import Content, forbid, handmade

# Each module imports only those before it.
VERIFIER = (
    *(rule_meaning, compiled_rules, refusal, certificate_json),
    *(certificate_fields, certificate_rules, certificate_header),
    *(step_budget, exact_amounts, unit_costs, verifier),
)

# Nobody can make the end.
LOST = recipe("pour: start > middle", "dig: rare > end")
LOST_CUT = [2, 3]
# What is poured would do in place of the rare, and is not there as a stand-in.
SERVED = StandInTable.usual()._replace(pairs={("middle", "rare"): Fraction(1)})
UNSERVED = replace(LOST, stand_ins=StandIns(SERVED, nearest=True))
# Two ends, each made by one unit, and a unit that nobody needs.
PAIR = recipe("pour: start > left", "mix: start > right", "look: start > view", goals="left + right")
LEFT, RIGHT = 1, 2
# The only unit never succeeds.
NEVER = recipe("pour: start > end", rates={"pour": 0})
# The product of two of the rates is the third.
PRODUCTS = recipe(
    *("two: start > a", "hundred: start > b", "both: start > end"),
    rates={"hundred": "1/101", "both": "1/202"},
)
MANY = recipe(*(f"go {number}: start > end" for number in range(2000)))
# Rates whose numerators share no factor, and are long.
LONG = recipe(
    *("threes: start > middle", "fives: middle > end"),
    rates={"threes": Fraction(3**4600, 3**4600 + 1), "fives": Fraction(5**3200, 5**3200 + 1)},
)
# A rate just below a limit that is given in millionths.
LEAST = recipe("pour: start > end", rates={"pour": "0.5000009"})
# Water comes of a tap, though there is some.
TAP = recipe("draw: pot > water", "brew: water > tea", kitchen="pot + water")
NINES = Fraction("0." + "9" * 500)
CHAIN = recipe(*(f"go: n{n} > n{n + 1}" for n in range(8)), kitchen="n0", rates={"go": NINES})

BOTH = [END, MIDDLE]
CUTS = [[END], BOTH]
LEAF = weigh("1")


def certificate(at: Problem = PLAIN, **values: Any) -> Content:
    """Return a right certificate of the plain data with other values, sealed so that they fit."""
    right: Content = {"tree": [0], "costs": [1], "cuts": [[END]], "proof": LEAF}
    return handmade(at, **{**right, **values})


def plain(stays: str = "", at: Problem = PLAIN, **values: Any) -> Forged:
    """Forge a certificate of some data by other values."""
    return Forged(certificate(at, **values), at, stays)


def text(**values: str) -> str:
    """Return the text of a right certificate of a bound with other JSON in place of some values."""
    content = certificate(**bound("1"))
    parts = (f'"{key}": {values.get(key, json.dumps(value))}' for key, value in content.items())
    return "{" + ", ".join(parts) + "}"


def odd(number: int) -> str:
    """Return a small fraction with a long denominator that shares few divisors with the others."""
    return f"1/{10**990 + 2 * number + 1}"


def digest(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()


def own(claims: Any = (), limits: Any = (), **file: str) -> Content:
    """Return what is taken on trust of a rule: claims, and what units come to."""
    known = {"name": "mine.lp", "sha256": digest(":- use(3)."), "text": ":- use(3).", **file}
    empty: Content = {"constants": [], "library": []}
    return {"rule": "own", "claims": [*claims], "limits": [*limits], "files": [known], **empty}


def measured(name: str = "mine", costs: Any = None, **values: Any) -> Content:
    """Return a measure as certificates state it, with other values."""
    rules = "cost(mine,U,5) :- unit(U)."
    return {name: {"rules": rules, "sha256": digest(rules), "costs": costs or {"5": [0, 2]}, **values}}


# By a measure, pouring and baking cost 5.
FIVE: Content = {"objective": ["mine"], "costs": ["5"], "proof": weigh("5")}
INTERMEDIATE: Content = {"rule": "require_intermediate", "required_intermediate": "middle"}
BEFORE: Content = {"rule": "before", "earlier_motion": "bake", "later_motion": "mix"}
SPOILED: Content = {"rule": "forbid_ingredient", "allergen": ["end"]}
# The nodes of the constraint require_intermediate: what is passed on, and what is made and taken for it.
PASSED, MADE, TAKEN = range(6, 9)
ANY: Content = {"claim": "bound", "bound": ["0"]}
LIKELY: Content = {"objective": ["success"], "costs": ["1/2"], "claim": "bound", "bound": [{}]}
SURE: Content = {"objective": ["success"], **UNPROVED}
# Without what is poured, the end costs 2; what is mixed costs 1 more than the end.
BAKED: Content = {"tree": [1, 2], "costs": [2]}


DIGESTS = certificate()["digests"]
MIXED: Content = {**goals(PLAIN, MIDDLE), "tree": [MIX], "cuts": [[MIDDLE]]}
POURED_PRICE = UnitPrices({"pour": Fraction(1)}, {})
UNRATED = replace(PLAIN, rates=None)


def at_most(units: int) -> list[Content]:
    return [{"rule": "at_most_units", "max_units": units}]


def rated(rate: int) -> Problem:
    return replace(PLAIN, rates=dict.fromkeys(PLAIN.network.motions, Fraction(rate)))


FORGED: dict[str, Forged] = {
    "_check_stand_ins: …": plain(at=UNSERVED, **NO_TREE, cuts=[LOST_CUT], proof=HOPELESS),
    # --- reading
    "load_certificate: it has more than … letters": Forged(
        (text(not_covered=json.dumps(["é" * 100], ensure_ascii=False)) + " " * 16_000_000).encode(), PLAIN
    ),
    "unique_keys: a key stands twice in one object": Forged(text(tree='null, "tree": null'), PLAIN),
    "refuse_float: found the number …, expected whole numbers, and fractions in quotes": Forged(
        text(costs="1.5"), PLAIN
    ),
    "read_certificate: it has more than … letters or … brackets": Forged(
        json.dumps(certificate(not_covered=["[" * 1_000_001])), PLAIN
    ),
    # --- the frame
    "check_header: expected an object with the keys of a certificate": Forged([], PLAIN, KIND),
    "check_header: expected the format …": plain(format="a song"),
    "check_header: expected version … of the format": plain(version=99),
    "check_header: expected the keys …": plain(more=1),
    "check_header: the seal does not match: something was changed": Forged(
        certificate() | {"seal": "0"}, PLAIN
    ),
    "check_header: not a claim about level …": plain(level=2),
    "check_header: …: not the one that the certificate is about": plain(digests={**DIGESTS, "kitchen": "0"}),
    # --- kinds and order of values
    "read_object: expected an object": plain(proof=["weights"], stays=KIND),
    "read_object: expected the keys …": plain(digests={**DIGESTS, "more": ""}),
    "read_list: expected a list": plain(objective={"units": "units"}),
    "read_names: expected names": plain(not_covered=[1], stays=KIND),
    "read_names: expected names in order, each of them once": plain(not_covered=["b", "a"]),
    "read_names: a name has half of a letter (a surrogate)": plain(rules=forbid(["\ud800"])),
    "read_numbers: expected ids of the network": plain(tree=[False]),
    "read_numbers: an id stands twice": plain(**ANY, tree=[0, 0], costs=[2]),
    "read_numbers: expected ids in order": plain(cuts=[BOTH[::-1]]),
    "read_number: expected …": plain(at=LOST, **NO_TREE, cuts=[LOST_CUT], proof={"hopeless": False}),
    "read_rows: …: expected what has a weight by its number, and the weight": plain(
        proof={"weights": [[0, ["1"], 2]]}
    ),
    "read_rows: …: expected weights in order, each once": plain(proof={"weights": [[0, ["1/2"]]] * 2}),
    "read_rules: it has more than … rules": plain(rules=forbid(f"sing {number:03}" for number in range(101))),
    "read_rules: a rule is unknown": plain(rules=[{"rule": "sing"}], stays=KIND),
    "read_rules: a value of a rule is of another kind": plain(rules=at_most(True)),
    "read_rules: expected rules in order, each of them once": plain(rules=forbid(["sing", "dance"])[::-1]),
    "read_rules: rules of the user's own stand twice": plain(rules=[own([[[3], []]]), own()]),
    "_check_user_rules: a file of rules has no printable name": plain(rules=[own(name="mine.lp\nverified")]),
    "_check_user_rules: a text of rules does not have its digest": plain(rules=[own(sha256="0" * 64)]),
    "read_pair: expected …": plain(rules=[own([[[3]]])], stays=KIND),
    "_check_user_rules: a limit is no whole number": plain(rules=[own((), [[{"1": [3]}, True]])]),
    "_check_user_rules: a limit counts what is no whole number above zero": plain(
        **bound("3", cuts=[]),
        rules=[own((), [[{"-1": [0, 2]}, -2]])],
        proof=weigh(limits=[[1, ["3/2"]]]),
    ),
    "_check_user_rules: a limit counts a unit twice": plain(rules=[own((), [[{"1": [3], "2": [3]}, 1]])]),
    "read_goal: a goal is not the node of its id": plain(goals=[{"id": END, "node": "another"}]),
    "read_rational: expected a number such as 3/2": plain(proof=weigh("one"), stays=KIND),
    "read_rational: expected a fraction in lowest terms": plain(proof=weigh("2/2")),
    "read_rational: a fraction has more than … digits": plain(**ANY, proof=weigh("1/1" + "0" * 2500)),
    # --- the question
    "__init__: expected the containers strict or implied": plain(containers="loose"),
    "__init__: an objective is unknown": plain(**bound("0", objective=["unit"]), **UNPROVED),
    "__init__: an objective stands twice": plain(
        objective=["units", "units"], costs=[1, 1], proof=weigh(["1", "1"])
    ),
    "_require_complete: a claim needs …, but none are given": plain(WORDS, UNRATED, **LIKELY, **UNPROVED),
    "_require_complete: a unit has none of the … that a claim needs": plain(
        at=replace(PLAIN, unit_prices=POURED_PRICE), **bound("0", objective=["price"]), **UNPROVED
    ),
    "_required_rates: a rate is above 1": plain(at=rated(2), **SURE, costs=["2"]),
    "_require_complete: one of the … is below 0": plain(KIND, rated(-2), **SURE, costs=["-2"]),
    "_required_rates: a unit that never succeeds is repeated forever": plain(
        KIND, NEVER, **bound("0", objective=["attempts"])
    ),
    "__init__: a constraint has no printable name": plain(not_covered=["mine.lp\nverified: all of it"]),
    "__init__: expected goals, each of them once": plain(goals=[], tree=[], costs=[0], **UNPROVED),
    # --- the claim
    "verify_claim: a tree is given, but no objective": plain(objective=[], costs=[], **UNPROVED),
    "verify_claim: the tree costs …, not what is stated": plain(costs=[0]),
    "verify_claim: costs are given, but no tree": plain(**ANY, tree=None),
    "verify_claim: there cannot be a tree": plain(
        at=LOST, **NO_TREE | {"objective": ["units"]}, cuts=[LOST_CUT], proof=HOPELESS
    ),
    "verify_claim: a bound is given where there is nothing to bound": plain(
        at=LOST, **NO_TREE, bound=["9"], cuts=[LOST_CUT], proof=HOPELESS
    ),
    "verify_claim: expected the tree that is optimal": plain(tree=None, costs=None, **UNPROVED),
    "verify_claim: the bound of an optimal tree is what it costs": plain(bound=["1"]),
    "verify_claim: expected objectives": plain(**bound("0", objective=[]), **UNPROVED),
    "verify_claim: the bound is false": plain(
        "no proof shows such a bound, as the tree costs less; were one accepted, it would show here",
        claim="bound",
        bound=["2"],
    ),
    "verify_claim: expected the claim optimal, bound or infeasible": plain(claim="best"),
    "verify_claim: a cut is not used by the proof": plain(cuts=CUTS),
    # --- the tree
    "_execute: unit … of the tree lacks an input when it is its turn": plain(tree=[BAKE]),
    "_execute: the tree does not make every goal": plain(tree=[], costs=[0], **UNPROVED),
    "written_costs: a tree that never succeeds is no better than another": plain(
        at=NEVER, objective=["success"], costs=["0"], proof=branch(HOPELESS, weigh(), unit=POUR)
    ),
    "written_costs: the success rate of the tree is too long a number to be written": plain(
        at=CHAIN, **LIKELY | {"costs": [str(NINES**8)]}, **UNPROVED, tree=[*range(8)]
    ),
    "written_costs: what the tree costs is too long a number to be written": plain(
        KIND, LONG, objective=["attempts"], tree=[0, 1], costs=["1"], **UNPROVED
    ),
    "_require_kept_rules: the tree …": plain(rules=at_most(0)),
    # --- the proof
    "_check_proof: the weights do not add up to enough": plain(**BAKED),
    "_check_proof: a cut called hopeless is crossed": plain(**NO_TREE, proof=HOPELESS),
    "_check_proof: expected weights, a hopeless cut, a broken rule or a branch": plain(
        proof={**LEAF, "more": 1}
    ),
    "_check_proof: a rule called broken is kept": plain(
        **NO_TREE, rules=[BEFORE], cuts=[], proof={"broken": 0}
    ),
    "_check_proof: a branch is taken twice": plain(
        proof=branch(branch(LEAF, LEAF, unit=POUR), weigh(), unit=POUR)
    ),
    "_check_proof: expected a proof for what is without the dear": plain(
        proof={"dear": [{"unit": 1}], **LEAF}, stays=KIND
    ),
    "_above_cutoff: nothing is too dear": plain(proof={"dear": [], **LEAF, "others": LEAF}),
    "_above_cutoff: what is dear is decided twice": plain(
        proof={"dear": [{"unit": 1}] * 2, **LEAF, "others": LEAF}
    ),
    "_round_up: a multiple is stated for another objective": plain(
        proof=weigh("1", multiples={"inputs": "1"})
    ),
    "_round_up: a multiple is not above zero": plain(proof=weigh("1", multiples={"units": "-1"})),
    "_round_up: a cost is not a multiple of what is stated": plain(
        **bound("2"), proof=weigh("1", multiples={"units": "2"})
    ),
    # the two ends cost 2; with a weight below zero on the cut that both units cross they seem to cost 3
    "read_weights: …: a weight is not above zero": plain(
        at=PAIR,
        tree=[0, 1, 2],
        costs=[3],
        cuts=[[LEFT], [RIGHT], [LEFT, RIGHT]],
        proof=weigh("2", "2", "-1"),
    ),
    # pouring and mixing count 5, of which the limit below zero gives more than it takes
    "limit_at: a rule that limits nothing is given a weight": plain(
        rules=[BEFORE], proof=weigh("1", limits=[[0, ["1"]]]), stays=KIND
    ),
    "_check_cost_partition: unit or item … carries more than it costs": plain(**BAKED, proof=weigh("2")),
    "_crossing_members: cut … holds neither a goal nor what a used unit needs": plain(
        **NO_TREE, cuts=[[RARE]], proof=HOPELESS
    ),
    "_landmark: a cut holds a kitchen item": plain(
        "the item is a member that costs nothing, so no weight fits on the cut; this says so at once",
        cuts=[[START, END]],
    ),
    "_read_branch_member: a branch on an item where items cost nothing": plain(
        proof=branch(LEAF, LEAF, item=START)
    ),
    "read_amount: expected one part of a weight for each objective": plain(proof=weigh(["1", "1"])),
    "read_amount: expected rates of motions in a weight, and none of 0 or 1": plain(
        **LIKELY, cuts=[BOTH], proof=weigh({"99/100": "1"})
    ),
    # --- measures
    "_read_measure: a measure has no name of its own": plain(measures=measured("Mine")),
    "_read_measure: expected the text of rules": plain(KIND, **FIVE, measures=measured(rules=5)),
    "_read_measure: the digest of a measure is not that of its rules": plain(
        **FIVE, measures=measured(sha256="0")
    ),
    "_read_measure: a unit costs less than 0 by a measure": plain(
        **FIVE, measures=measured(costs={"-1": [1], "5": [0, 2]})
    ),
    "_read_measure: a unit has two costs by a measure": plain(
        **FIVE, measures=measured(costs={"6": [0], "5": [0, 2]})
    ),
    "_stated_cost: the cost of a unit by a measure is not stated": plain(
        KIND, **FIVE, measures=measured(costs={"5": [0]})
    ),
    # --- limits
    "_minus_log_sign: products of rates are too close to be told apart in reasonable time": plain(
        at=PRODUCTS,
        objective=["success"],
        tree=[2],
        costs=["1/202"],
        cuts=[[3]],
        proof=weigh({"1/2": "15000", "1/101": "15000", "1/202": "-14999"}),
    ),
    "spend_on_fractions: its fractions add up to numbers that are too long": plain(
        **ANY, cuts=[[END]] * 9, proof=weigh(*map(odd, range(9)))
    ),
    "spend: to check it takes more than … steps": plain(
        "it is the work that is refused; in the end, these cuts would be, as nothing uses them",
        MANY,
        cuts=[[END]] * 2700,
    ),
}

# What one function refuses, in other places of a certificate.
PLACES: dict[str, Forged] = {
    "expected amounts and their limit": plain(rules=[own((), [[{"1": [3]}, 1, 1]])]),
    "expected the number of a rule": plain(**NO_TREE, rules=[SPOILED], cuts=[], proof={"broken": False}),
    "expected the number of a step": plain(
        rules=[INTERMEDIATE],
        **BAKED,
        cuts=[[PASSED], [MADE], [TAKEN]],
        proof=branch(HOPELESS, weigh(None, "1", "1"), step=False),
    ),
}

# What turns another failure into a refusal, or is the refusal itself: taken out, nothing is accepted.
NO_CHECKS = {
    "require: otherwise",
    "read_certificate: not JSON: …",
    "refuse_deep_nesting: branches nested too deeply",
}
NEXT = "_cost_by_objective: an objective is unknown"
SLOW = "spend: to check it takes more than … steps"


def test_a_right_certificate_passes(tmp_path: Path) -> None:
    content = (certificate(), certificate(**FIVE, measures=measured()), text(), text().encode())
    assert [held(VERIFIER, Forged(each, PLAIN), tmp_path).claim for each in content] == [
        *("optimal", "optimal", "bound", "bound")
    ]


def test_every_check_has_a_forged_certificate() -> None:
    names = [name for name, _ in checks(VERIFIER)]
    assert len(set(names)) == len(names)
    assert {*names} == FORGED.keys() | NO_CHECKS | {NEXT}


def test_an_objective_that_has_no_cost_yet_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """That check is for the day when an objective is added: no certificate comes to it now."""
    monkeypatch.setattr(unit_costs, "OBJECTIVES", (*unit_costs.OBJECTIVES, "pans"))
    with pytest.raises(RefusedError, match="an objective is unknown"):
        held(VERIFIER, plain(objective=["pans"]), tmp_path)


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=pytest.mark.slow if name == SLOW else ()) for name in FORGED]
)
def test_a_forged_certificate_is_refused_by_its_check_alone(name: str, tmp_path: Path) -> None:
    require_its_check_alone(VERIFIER, name, FORGED[name], tmp_path)


@pytest.mark.parametrize("said", PLACES)
def test_each_place_is_read(said: str, tmp_path: Path) -> None:
    with pytest.raises(RefusedError, match=said):
        held(VERIFIER, PLACES[said], tmp_path)


# --- what refuses by what it computes

POURED = branch(weigh("1", "1"), LEAF, unit=POUR)
DEAR = {"dear": [{"unit": 1}], **LEAF, "others": weigh("1", "1")}
TWO = bound("2")

PARTS = {
    # the end costs 1; it seems to cost 2 where the unit that is used, and paid for, carries a weight as well
    "a unit that is used was paid for": Part(
        "capacity = {} if member in used else self.cost(member)",
        "capacity = self.cost(member)",
        plain(**BAKED, cuts=CUTS, proof=POURED),
    ),
    # what makes the end of the start is of both cuts, and costs 1
    "weights are added over their common denominator": Part(
        "value.numerator * (scales[key] // value.denominator)",
        "value.numerator",
        plain(**bound("7/6"), cuts=CUTS, proof=weigh("1/2", "2/3")),
    ),
    "a goal at hand needs nothing": Part(
        "goal in cut and goal not in self.kitchen",
        "goal in cut",
        plain(**bound("1", objective=["kitchen"]), **goals(PLAIN, START), cuts=[[START]]),
    ),
    "the side without the unit is proved, too": Part(
        'waiting.append((node["without"], used, without | {member}))',
        "pass",
        plain(**TWO, proof=branch(weigh(), LEAF, unit=1)),
    ),
    "the side with the unit is proved, too": Part(
        'waiting.append((node["using"], used | {member}, without))',
        "pass",
        plain(**BAKED, cuts=CUTS, proof={**POURED, "using": weigh()}),
    ),
    "a unit that is left out is no member": Part(
        "return self.members[index] - without",
        "return self.members[index] - without - used",
        plain(**BAKED, cuts=CUTS, proof=POURED),
    ),
    "what is dear costs what its cuts do not carry": Part(
        "for addition in [{}] if above_cutoff is None else map(reduced_cost, above_cutoff)",
        "for addition in [{}] if above_cutoff is None else map(self._cost, above_cutoff)",
        plain(**BAKED, cuts=CUTS, proof={**DEAR, "dear": [{"unit": 0}]}),
    ),
    "each of what is dear is": Part(
        "map(reduced_cost, above_cutoff)",
        "map(reduced_cost, above_cutoff[:1])",
        plain(
            **TWO, cuts=CUTS, proof={**LEAF, "dear": [{"unit": 1}, {"unit": 0}], "others": {"hopeless": 1}}
        ),
    ),
    "the others are proved, too": Part(
        'waiting.append((node["others"], used, without.union(above_cutoff)))',
        "pass",
        plain(**TWO, proof={**DEAR, "others": weigh()}),
    ),
    "a unit is used once": Part(
        "members = [*units, *(", "members = [*units[:1], *(", plain(tree=[1, 2], costs=[1])
    ),
    "the costs of used units count once": Part(
        "map(self.cost, used)",
        "map(self.cost, [*used, *used])",
        plain(**BAKED, cuts=CUTS, proof={**POURED, "using": weigh()}),
    ),
    # of the end, the step and what it needs, the step's cost is none and it can carry nothing
    # the end takes the start, and what is passed on the salt; the step takes nothing
    "a step costs nothing": Part(
        """        if member in self.ruled.steps:
            return {}
""",
        "",
        plain(
            **bound("3", objective=["kitchen"]),
            rules=[INTERMEDIATE],
            cuts=[[START, END, MIDDLE], [SALT, PASSED, MADE], [PASSED]],
            proof=weigh("1", "1", "1"),
        ),
    ),
    "what is used takes of a limit": Part(
        "-limit.remaining(used)",
        "-limit.remaining(used) + 1",
        plain(**TWO, rules=at_most(1), proof=weigh("2", limits=[[0, ["1"]]])),
    ),
    "what is used and paid for carries nothing, limited or not": Part(
        "if weighted_limits and member not in used:",
        "if weighted_limits:",
        plain(
            **bound("5"),
            rules=at_most(1),
            cuts=CUTS,
            proof=branch(weigh("4", "4", limits=[[0, ["3"]]]), weigh("4", limits=[[0, ["4"]]]), unit=POUR),
        ),
    ),
    "where nothing is to be bounded, a bound is above nothing": Part(
        "self.arithmetic.sign(self.arithmetic.sum(bound)) > 0",
        "self.arithmetic.sign(self.arithmetic.sum(bound)) >= 0",
        plain(**NO_TREE, **UNPROVED),
    ),
    "what a rule removes is no member": Part(
        "[(proof, no_members, self.ruled.removed)]",
        "[(proof, no_members, frozenset(range(3)))]",
        plain(**NO_TREE, proof=HOPELESS),
    ),
    # baking on what is mixed is right where something is mixed
    "what a rule bars is told from the branch": Part(
        "excluded = without.union(*(self._barred_units(n, used, without) for n in self.ruled.barred))",
        "excluded = without.union(*(self._barred_units(n, used, frozenset({1})) for n in self.ruled.barred))",
        plain(
            **NO_TREE,
            rules=[{"rule": "before", "earlier_motion": "mix", "later_motion": "bake"}, *forbid(["pour"])],
            proof=HOPELESS,
        ),
    ),
    "a unit with a forbidden node is removed": Part(
        "if not (touched.isdisjoint(inputs) and touched.isdisjoint(outputs))",
        "if not touched.isdisjoint(outputs)",
        plain(rules=forbid([], ["start"])),
        rule_meaning,
    ),
    "all that a rule removes is": Part(
        "rate * 1_000_000 // 1 >= least_rate",
        "rate * 1_000_001 // 1 >= least_rate",
        plain(at=LEAST, rules=[{"rule": "least_rate", "least_rate": 500_001}]),
        rule_meaning,
    ),
    "an allergen of a goal leaves no tree, and of nothing else": Part(
        "isdisjoint(question.goals)",
        "isdisjoint(question.kitchen)",
        plain(**NO_TREE, rules=[SPOILED | {"allergen": ["salt"]}], cuts=[], proof={"broken": 0}),
        rule_meaning,
    ),
    "what is at hand is not passed on": Part(
        "        if o not in question.kitchen:\n",
        "        if True:\n",
        plain(
            at=TAP,
            **ANY,
            **UNPROVED,
            rules=[{**INTERMEDIATE, "required_intermediate": "water"}],
            tree=[0, 1],
            costs=[2],
        ),
        rule_meaning,
    ),
    "things of one unit are counted each": Part(
        "amounts[member] + amount if member in amounts else amount",
        "amount",
        plain(
            at=replace(NEVER, utensils=frozenset({"start", "end"})),
            rules=[{"rule": "at_most_utensils", "max_utensils": 1}],
        ),
        compiled_rules,
    ),
    "of each set a tree has a unit": Part(
        "made.issuperset(needs)",
        "not made.isdisjoint(needs)",
        plain(rules=[INTERMEDIATE], **MIXED),
        compiled_rules,
    ),
    # where nothing is dug, mixing is right
    "a claim bars the last of its units where the others are used": Part(
        "if len(remaining) == 1",
        "if remaining",
        plain(**NO_TREE, rules=[own([[[1, 3], []]]), *forbid(["pour"])], cuts=[BOTH], proof=HOPELESS),
        rule_meaning,
    ),
    "no unit of the tree is barred": Part(
        "any(units & barred for", "any(others & barred for", plain(rules=[BEFORE], **MIXED), compiled_rules
    ),
}


@pytest.mark.parametrize("name", PARTS)
def test_a_part_that_is_wrong_lets_a_forged_certificate_pass(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    require_right(PARTS[name], tmp_path, monkeypatch, VERIFIER)
