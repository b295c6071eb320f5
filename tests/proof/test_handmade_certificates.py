"""What the verifier says of certificates written by hand: what is proved, and what is refused.

tests/proof/test_forged_certificates.py has a certificate for every check; here is what the checks compute.
"""

import hashlib
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

from foon_asp.network import FunctionalUnit, UnitPrices, network_at_level
from foon_asp.problem import ContainerRule, Problem
from foon_asp.proof import verifier
from foon_asp.proof.canonical_json import canonical_json
from foon_asp.proof.certificate_header import seal
from foon_asp.proof.certificate_json import load_certificate, read_certificate
from foon_asp.proof.certificate_limits import ALLOWED
from foon_asp.proof.certificate_rules import trusted_claims
from foon_asp.proof.certificate_subject import Subject
from foon_asp.proof.refusal import CheckLimitError, RefusedError
from foon_asp.proof.rule_meaning import OWN
from foon_asp.proof.verified_claim import Verified
from foon_asp.text.line_parser import parse_node
from tests.proof.by_hand import (
    BAKE,
    DIG,
    END,
    HOPELESS,
    MIDDLE,
    MIX,
    NO_TREE,
    OTHER,
    PLAIN,
    POUR,
    RARE,
    SALT,
    START,
    accepted,
    bound,
    branch,
    goals,
    recipe,
    refusal,
    weigh,
)
from tests.support.handmade_certificate import Content, check, forbid, handmade

POURED: Content = {"tree": [POUR], "costs": [1]}
BAKED: Content = {"tree": [MIX, BAKE], "costs": [2]}
NO_POURING: Content = {"rules": forbid(["pour"])}
CUTS = [[END], [END, MIDDLE]]
TAKEN: Content = {"objective": ["kitchen"], "cuts": [[START, END, MIDDLE]]}
LESS = "the weights do not add up to enough"
TWICE = "a branch is taken twice"
CROSSED = "a cut called hopeless is crossed"
NOT_USED = "cut 1 holds neither a goal nor what a used unit needs"
NO_MULTIPLE = "a cost is not a multiple of what is stated"
LACKS = "unit 0 of the tree lacks an input when it is its turn"


def carries(member: int) -> str:
    return f"unit or item {member} carries more than it costs"


# --- what is proved


@pytest.mark.parametrize(
    ("objective", "tree", "costs", "cuts", "proof"),
    [
        (["units"], [POUR], [1], [[END]], weigh("1")),
        (["inputs+ingredients"], [POUR], [1], [[END]], weigh("1")),
        # with the middle, the members are pouring and mixing
        (["success"], [MIX, BAKE], ["3/4"], CUTS[1:], weigh({"3/4": "1"})),
        (["success", "units"], [MIX, BAKE], ["3/4", 2], CUTS, weigh([{}, "1"], [{"3/4": "1"}, "1"])),
        # what pours and what mixes asks for the start
        (["kitchen", "units"], [POUR], [1, 1], [[END], *TAKEN["cuts"]], weigh(["0", "1"], ["1", "0"])),
    ],
)
def test_an_optimum_by_each_objective(
    objective: list[str], tree: list[int], costs: list[Any], cuts: list[Any], proof: Content
) -> None:
    values: Content = {"objective": objective, "tree": tree, "costs": costs, "cuts": cuts, "proof": proof}
    found = accepted(**values)
    exact = tuple(map(Fraction, costs))
    said = ("optimal", (END,), "strict", 3, tuple(objective), (), (), tuple(tree), exact, len(cuts))
    assert found == Verified(*said)


@pytest.mark.parametrize(
    ("objective", "tree", "cost"),
    [
        *(("units", [POUR], 1), ("units", [MIX, BAKE], 2), ("inputs", [MIX, BAKE], 3)),
        *(
            ("inputs+ingredients", [MIX, BAKE], 5),
            ("success", [MIX, BAKE], "3/4"),
            ("kitchen", [MIX, BAKE], 2),
        ),
    ],
)
def test_costs_of_a_tree(objective: str, tree: list[int], cost: Any) -> None:
    values = bound({} if objective == "success" else "0", objective=[objective], tree=tree)
    assert accepted(**values | {"costs": [cost]}).costs == (Fraction(cost),)
    stated = f'["{cost}"]' if objective == "success" else f"[{cost}]"
    others: list[Any] = [[], [cost, cost], ["1"], [True], [float(Fraction(cost))], None, [f"{cost}0"]]
    for other in others:
        assert refusal(**values | {"costs": other}) == f"the tree costs {stated}, not what is stated"


@pytest.mark.parametrize(
    ("objective", "weight", "proved", "too_much"),
    [
        (["units"], ["1/3"], ["1/3"], ["1/2"]),
        (["units", "inputs"], ["1", "0"], ["1/2", "7"], ["2", "-7"]),
        (["units", "inputs"], ["1", "-1"], ["1", "-1"], ["1", "0"]),
        # of the rates 1/2 and 1 the greater one costs nothing, but for a unit
        (["success", "units"], [{}, "1"], [{}, "1"], [{}, "2"]),
        (["success", "units"], [{}, "1"], [{"1/2": "-1"}, "9"], [{"1/2": "1/9"}, "-9"]),
    ],
)
def test_bounds(objective: list[str], weight: list[Any], proved: list[Any], too_much: list[Any]) -> None:
    """The cut is crossed by pouring and by baking, and both cost 1 by units and by inputs."""
    values: Content = {"objective": objective, "cuts": [[END]], "proof": weigh(weight)}
    assert accepted(**bound(*proved, **values)).claim == "bound"
    assert refusal(**bound(*too_much, **values)) == LESS


def test_a_bound_and_the_tree_beside_it() -> None:
    values: Content = {"claim": "bound", "cuts": [[END]], "proof": weigh("1"), **POURED}
    assert accepted(**values, bound=["1"], not_covered=["a.lp 1", "b=2"]).not_covered == ("a.lp 1", "b=2")
    assert refusal(**values, bound=["2"]) == "the bound is false"


def test_no_tree_at_all() -> None:
    nobody = {**NO_TREE, **goals(PLAIN, OTHER), "proof": HOPELESS}
    found = accepted(**nobody, cuts=[[RARE, OTHER]])
    assert (found.claim, found.goals, found.tree, found.cuts) == ("infeasible", (OTHER,), None, 1)
    assert refusal(**nobody, cuts=[[OTHER]]) == CROSSED  # by digging


def test_what_is_forbidden_is_no_member() -> None:
    values: Content = {**BAKED, "cuts": CUTS, "proof": weigh("1", "1")}
    assert list(accepted(**values, **NO_POURING).rules) == forbid(["pour"])
    assert refusal(**values) == carries(POUR)
    assert refusal(**POURED, **NO_POURING) == "the tree has unit 0, which a rule removes"
    for label, unit in (("salt", MIX), ("middle", MIX), ("end", BAKE)):
        said = f"the tree has unit {unit}, which a rule removes"
        assert refusal(**values, rules=forbid([], [label])) == said


def test_the_tree_is_executed_in_its_order() -> None:
    lacks = "unit 2 of the tree lacks an input when it is its turn"
    assert refusal(**bound("0") | {"tree": [BAKE, MIX], "costs": [2]}) == lacks
    both = goals(PLAIN, END, MIDDLE)
    assert refusal(**bound("0") | POURED | both) == "the tree does not make every goal"
    found = accepted(**bound("0") | {"tree": [POUR, MIX], "costs": [2]} | both)
    assert found.goals == (END, MIDDLE)
    assert accepted(tree=[], costs=[0], **goals(PLAIN, START)).costs == (0,)


def test_goals_at_hand_stand_behind_no_cut() -> None:
    """Not even where items count, and a cut may hold them."""
    values = bound("0", objective=["kitchen"], **goals(PLAIN, START, MIDDLE), proof=weigh("1"))
    assert refusal(**values, cuts=[[START]]) == "cut 0 holds neither a goal nor what a used unit needs"
    assert accepted(**values, cuts=[[START, MIDDLE]]).cuts == 1


# --- members and what they carry


def test_a_unit_that_needs_a_node_of_the_cut_is_no_member() -> None:
    """With both nodes in the cut, baking carries nothing of it; and mixing is the only other member."""
    values: Content = {**NO_POURING, "cuts": CUTS}
    assert accepted(**bound("2", **values), proof=weigh("1", "1")).cuts == 2
    assert refusal(**bound("0", **values), proof=weigh("1", "2")) == carries(MIX)
    assert refusal(**bound("0", **values), proof=weigh("2", "1")) == carries(BAKE)


def test_items_are_members_of_their_own() -> None:
    """Items are numbered behind the units; by units first, what has no cost by kitchen may carry it."""
    for item in (START, SALT):
        values: Content = {"objective": ["units", "kitchen"], "cuts": [sorted({END, MIDDLE, item})]}
        for number in ("1", "1/2"):
            assert accepted(**bound("0", number, **values), proof=weigh(["0", number])).claim == "bound"
        assert refusal(**bound("0", "1", **values), proof=weigh(["0", "2"])) == carries(4 + item)
    # after the item, baking
    assert refusal(**bound("0", objective=["kitchen"]), cuts=[[START, END]], proof=weigh("1")) == carries(
        BAKE
    )


def test_steps_that_need_a_node_of_the_cut_are_no_members() -> None:
    """What is passed on, 6, takes that the middle is made, 7."""
    rules = [{"rule": "require_intermediate", "required_intermediate": "middle"}]
    assert accepted(**bound("1"), rules=rules, cuts=[[6, 7]], proof=weigh("1")).claim == "bound"


def test_what_is_dear_costs_more_by_what_its_cuts_do_not_carry() -> None:
    proof = weigh("1/2", dear=[{"unit": BAKE}], others=weigh("1"))
    assert accepted(**bound("1"), cuts=[[END]], proof=proof).claim == "bound"
    assert refusal(**bound("9/8"), cuts=[[END]], proof=proof | {"others": weigh("9/8")}) == LESS


def test_a_weight_speaks_of_rates_between_0_and_1() -> None:
    """The motions have the rates 0, 1/2, 3/4 and 1."""
    values = bound({}, objective=["success"], cuts=[[END, MIDDLE]])
    for rate in ("0", "1", "1/3", "2"):
        said = "expected rates of motions in a weight, and none of 0 or 1"
        assert refusal(**values, proof=weigh({rate: "1"})) == said
    assert refusal(**values, proof=weigh({"1/2": "1"})) == carries(MIX)
    assert accepted(**values, proof=weigh({"3/4": "1"})).claim == "bound"


DUG = replace(PLAIN, kitchen=PLAIN.kitchen | {RARE}, goals=(OTHER,))


def test_a_rate_of_0_costs_more_than_any_weight() -> None:
    much: Content = {"1/2": "1000"}
    values = bound(much, objective=["success"], cuts=[[OTHER]])
    assert accepted(DUG, **values, proof=weigh(much)).claim == "bound"
    assert accepted(DUG, **values, proof=branch(HOPELESS, weigh(), unit=DIG)).claim == "bound"
    assert refusal(DUG, **values | {"bound": [{}], "tree": [DIG], "costs": ["0"]}) == (
        "a tree that never succeeds is no better than another"
    )
    two = bound(much, "9", objective=["success", "units"], cuts=[[OTHER]])
    assert accepted(DUG, **two, proof=weigh([much, "9"])).claim == "bound"


def test_rates_outside_of_0_and_1_are_refused() -> None:
    for rate, said in ((-1, "one of the success rates is below 0"), (11, "a rate is above 1")):
        odd = replace(PLAIN, rates={**(PLAIN.rates or {}), "dig": Fraction(rate, 10)})
        assert refusal(odd, **bound({}, objective=["success"])) == said
        assert accepted(odd, **bound("0")).claim == "bound"  # by units, rates are nobody's business
    none = replace(PLAIN, rates=None)
    assert accepted(none, **POURED, cuts=[[END]], proof=weigh("1")).claim == "optimal"
    said = "a claim needs success rates, but none are given"
    assert refusal(none, **bound({}, objective=["success"])) == said


def test_units_that_need_nothing_take_no_items() -> None:
    """By kitchen they cost nothing, and the units decide."""
    values: Content = {"objective": ["kitchen", "units"], "tree": [0], "costs": [0, 1]}
    found = recipe("find: > end", kitchen="")
    assert refusal(found, **values) == LESS
    assert accepted(found, **values, cuts=[[0]], proof=weigh(["0", "1"])).costs == (0, 1)


# --- branches


def test_a_branch_on_a_unit() -> None:
    """Without baking nothing makes the end; with it, it is paid for, and what it needs has to be made."""
    proof = branch(HOPELESS, weigh(None, "1"), unit=BAKE)
    values: Content = {**NO_POURING, "cuts": [[END], [MIDDLE]]}
    assert accepted(**bound("2", **values), proof=proof).cuts == 2
    assert refusal(**bound("3", **values), proof=proof) == LESS
    for wrong, said in (
        ({"branch": {"unit": DIG}}, NOT_USED),
        ({"using": weigh("1", "1")}, carries(BAKE)),
        ({"using": proof}, TWICE),
        ({"branch": {"unit": POUR}}, TWICE),
        ({"without": {"hopeless": 1}}, NOT_USED),
    ):
        assert refusal(**bound("2", **values), proof=proof | wrong) == said


def test_a_branch_on_an_item() -> None:
    proof = branch(HOPELESS, weigh(), item=START)
    values = bound("1", objective=["kitchen"], cuts=[*TAKEN["cuts"], [MIDDLE]])
    assert accepted(**values | TAKEN, proof=proof).claim == "bound"
    for wrong, said in (
        ({"using": weigh(None, "1")}, NOT_USED),  # an item needs nothing
        ({"branch": {"item": SALT}}, CROSSED),
        ({"using": proof}, TWICE),
    ):
        assert refusal(**values, proof=proof | wrong) == said
    # a rule hears of the units of a branch, and not of its items
    rules = [{"rule": "before", "earlier_motion": "mix", "later_motion": "bake"}]
    for item in (START, SALT):
        leaves = branch(weigh(), weigh(), item=item)
        assert accepted(**bound("0", objective=["kitchen"]), rules=rules, proof=leaves).claim == "bound"


# --- values of other kinds

VERSION, LEVEL, NO_ID = (
    "expected version 5 of the format",
    "not a claim about level 3",
    "expected ids of the network",
)
NO_CUT, NO_UNIT, NO_ITEM = (
    "expected the number of a cut",
    "expected the id of a unit",
    "expected the id of a kitchen item",
)
NUMBER, PARTS = "expected a number such as 3/2", "expected one part of a weight for each objective"
LOWEST, NO_GOALS = "expected a fraction in lowest terms", "expected goals, each of them once"
IN_ORDER, ORDERED = "expected ids in order", "weights: expected weights in order, each once"
WEIGHED = "weights: expected what has a weight by its number, and the weight"
NAMES, NAMES_ORDERED = "expected names", "expected names in order, each of them once"
RULES_ORDERED = "expected rules in order, each of them once"
COUNTS = "a limit counts what is no whole number above zero"
KINDS: list[Any] = [0, -1, True, []]
A_GOAL = {"id": END, "node": "end"}


def weights(*pairs: Any) -> Content:
    return {"proof": {"weights": [*pairs]}}


def branched(**member: Any) -> Content:
    return {"proof": branch(weigh(), weigh(), **member), "objective": ["kitchen"]}


def claiming(*claims: list[list[int]], **more: Any) -> Content:
    """Return a rule with claims of units, sets that no tree has and lacks."""
    own = {"rule": OWN, "claims": [*claims], "constants": [], "files": [], "library": [], "limits": []}
    return {**own, **more}


def ruled(*rules: Any) -> Content:
    return {"rules": [*rules]}


def sha(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()


FILE = {"name": "mine.lp", "sha256": sha(":- use(1)."), "text": ":- use(1)."}


@pytest.mark.parametrize(
    ("said", "wrong"),
    [
        (VERSION, [{"version": each} for each in (0, 4, 6, True, 5.0, "5")]),
        (LEVEL, [{"level": each} for each in (2, 3.0, None)]),
        (NO_GOALS, [{"goals": []}, {"goals": [A_GOAL] * 2}]),
        (NO_ID, [{"goals": [A_GOAL | {"id": each}]} for each in (6, -5, True)]),
        (NO_ID, [*({"tree": [each]} for each in (4, -1, 0.0)), *({"cuts": [[each]]} for each in (6, -1))]),
        ("an id stands twice", [{"tree": [POUR, POUR]}, {"cuts": [[1, 1]]}, ruled(claiming([[0, 0], []]))]),
        (IN_ORDER, [{"cuts": [each]} for each in ([], [3, 1])]),
        (IN_ORDER, [ruled(claiming(limits=[[{"1": []}, 1]]))]),
        (WEIGHED, [weights([each, ["1"]]) for each in KINDS if type(each) is not int]),
        (
            NO_CUT,
            [
                *(weights([each, ["1"]]) for each in (0, -1)),
                *({"proof": {"hopeless": each}} for each in KINDS),
            ],
        ),
        (WEIGHED, [weights([0, ["1"]], ["1", ["1"]]), weights([0])]),
        (ORDERED, [weights([place, ["1"]], [0, ["1"]]) for place in (0, 1)]),
        (
            "weights: a weight is not above zero",
            [{"cuts": [[END]], "proof": weigh(each)} for each in ("0", "-1")],
        ),
        ("expected a list", [weights("ab")]),
        (PARTS, [{"bound": []}, {"bound": ["0", "0"]}]),
        (NUMBER, [{"bound": [each]} for each in (0, "1.5", "+1", "\u0661")]),
        (LOWEST, [{"bound": [each]} for each in ("-0", "2/4", "1/1")]),
        (NAMES_ORDERED, [ruled({"rule": "only_sources", "allowed": ["b", "a"]})]),
        (NAMES, [ruled({"rule": "only_sources", "allowed": [1]}), ruled(claiming(library=[1]))]),
        (NAMES, [ruled(claiming(files=[FILE | {key: 1}])) for key in ("name", "text")]),
        ("expected a list", [{"rules": {}}]),
        (
            "expected an object",
            [ruled([]), ruled(claiming(limits=[[["1"], 1]])), {"proof": branch(0, 0) | {"branch": []}}],
        ),
        (
            "a rule is unknown",
            [ruled({}), ruled({"rule": ["forbid_motion"]}), ruled(claiming(), {"rule": "x"})],
        ),
        ("expected the keys rule, forbidden_motion", [ruled({"rule": "forbid_motion"})]),
        (RULES_ORDERED, [ruled(*forbid(["a", "b"])[::-1]), ruled(*forbid([], ["a", "a"]))]),
        (NO_UNIT, [branched(unit=each) for each in (4, -1, True, None)]),
        (NO_ITEM, [branched(item=each) for each in (MIDDLE, False, 2.0)]),
        ("expected the keys unit", [branched(), branched(item=0, unit=0)]),
        ("expected the keys rule, claims, constants, files, library, limits", [ruled(claiming(more=1))]),
        ("expected the keys name, sha256, text", [ruled(claiming(files=[{**FILE, "more": 1}]))]),
        (NO_ID, [ruled(claiming([[99], []])), ruled(claiming(limits=[[{"1": [99]}, 1]]))]),
        (COUNTS, [ruled(claiming(limits=[[{each: [MIX]}, 1]])) for each in ("0", "1/2")]),
    ],
)
def test_what_is_refused(said: str, wrong: list[Content]) -> None:
    for values in wrong:
        assert refusal(**bound("0") | values) == said


def test_right_values_beside_those() -> None:
    for values in (
        ruled(*forbid(f"sing {number:03}" for number in range(100))),
        ruled(claiming(files=[FILE])),
    ):
        assert accepted(**bound("0") | values).claim == "bound"
    implied = replace(PLAIN, containers=ContainerRule.IMPLIED)
    assert accepted(implied, **bound("0")).containers == "implied"
    level_1 = replace(PLAIN, network=network_at_level(PLAIN.network, 1))
    assert accepted(level_1, **bound("0")).level == 1
    assert refusal(level_1, **bound("0"), level=True) == "not a claim about level 1"
    proof = branch(weigh(), weigh(), unit=0)
    proof["using"] = proof
    with pytest.raises(RefusedError, match="branches nested too deeply"):
        check({**handmade(PLAIN, **bound("0")), "proof": proof}, PLAIN)


def test_other_data_are_refused() -> None:
    content = handmade(PLAIN, **bound("0"))
    for part, other in {
        "network": recipe("pour: start > end", rates={}),
        "kitchen": replace(PLAIN, kitchen=frozenset({0})),
        "rates": replace(PLAIN, rates=None),
        "utensils": replace(PLAIN, utensils=frozenset({"cup"})),
        "prices": replace(PLAIN, unit_prices=UnitPrices({}, {PLAIN.network.unit(POUR): Fraction(0)})),
    }.items():
        with pytest.raises(RefusedError, match=f"^{part}: not the one that the certificate is about$"):
            check(content, other)


# --- the container rule

CUP, IN_CUP = "cup; contains {salt}", "salt; in [cup]"


@pytest.mark.parametrize(
    ("vessel", "others", "given"),
    [
        (CUP, [IN_CUP], True),
        (CUP, ["start", IN_CUP], True),
        (CUP, ["salt; dry; on [table]; under [cup]"], True),  # any relation
        (CUP, [], False),
        (CUP, ["salt"], False),  # nowhere
        (CUP, ["salt; in [bowl]"], False),
        (CUP, ["flour; in [cup]"], False),
        ("cup", [IN_CUP], False),  # of nothing
        ("cup; contains {salt,salt}", [IN_CUP], False),  # of two
        ("bowl; contains {salt}", ["salt; in [bowl]"], False),  # no utensil
        ("cup; in [cup]; contains {cup}", [], False),  # in itself
    ],
)
def test_which_vessels_are_taken_as_given(vessel: str, others: list[str], given: bool) -> None:
    """A unit puts out its inputs as well; one of them is lacking."""
    nodes = [vessel, *others]
    unit = f"pour: {' + '.join(nodes)} > {' + '.join(['end', *nodes])}"

    def asked(lacking: int | None, goal: str = "end", rule: str = "implied") -> str:
        at_hand = " + ".join(node for place, node in enumerate(nodes) if place != lacking)
        problem = recipe(unit, kitchen=at_hand, goals=goal, utensils="cup")
        problem = replace(problem, containers=ContainerRule(rule))
        return refusal(problem, **bound("0") | POURED)

    assert asked(None) == ""
    assert asked(0) == ("" if given else LACKS)
    assert asked(0, rule="strict") == LACKS
    assert {asked(place) for place in range(1, len(nodes))} <= {LACKS}
    if given:  # nothing comes from nothing
        assert asked(0, vessel) == "the tree does not make every goal"
        assert asked(None, vessel) == ""


def test_a_unit_that_does_not_make_a_node_is_no_member() -> None:
    """Under strict the pouring needs the cup, so that it is a member only with another goal."""
    for rule, refused in (("strict", [False, True, False]), ("implied", [False, True, True])):
        for (goal, cut), crossed in zip(((0, [0]), (2, [2]), (2, [0, 2])), refused, strict=True):
            pour = recipe(f"pour: {CUP} + {IN_CUP} > end + {CUP}", kitchen=IN_CUP, utensils="cup")
            at = replace(pour, goals=(goal,), containers=ContainerRule(rule))
            assert (refusal(at, **NO_TREE, cuts=[cut], proof=HOPELESS) == CROSSED) == crossed


# Below level 3, the first two are one unit. The first takes its cup as given, the second does not, since
# sugar is not among its inputs. The third does.
DETAILED = recipe(
    f"pour: {IN_CUP} + {CUP} > end + {CUP}",
    f"pour: {IN_CUP} + cup; contains {{sugar}} > end + cup; contains {{sugar}}",
    "stir: pepper; in [cup] + cup; contains {pepper} > paste + cup; contains {pepper}",
    utensils="cup",
)


def merged(level: int, kitchen: int, goal: int, **more: Any) -> Problem:
    network, rule = network_at_level(DETAILED.network, level), ContainerRule.IMPLIED
    at = replace(DETAILED, network=network, kitchen=frozenset({kitchen}), goals=(goal,), containers=rule)
    return replace(at, **more)


@pytest.mark.parametrize("level", [1, 2])
def test_below_level_3_a_unit_needs_what_all_need_and_makes_what_any_makes(level: int) -> None:
    salt, cup, end, pepper, paste = range(5)
    for kitchen, unit, goal, said in (
        (salt, 0, end, ""),
        (salt, 0, cup, ""),  # that of sugar, which is made
        (cup, 0, end, LACKS),
        (pepper, 1, paste, ""),
        (pepper, 1, cup, "the tree does not make every goal"),
        (cup, 1, paste, LACKS.replace("0", "1")),
    ):
        assert refusal(merged(level, kitchen, goal), **bound("0") | {"tree": [unit], "costs": [1]}) == said


def test_below_level_3_a_unit_has_a_price_if_all_that_it_stands_for_have_one() -> None:
    def priced(*known: int, cost: str) -> str:
        prices = {DETAILED.network.unit(unit): Fraction((7, 5)[unit]) for unit in known}
        at = merged(2, 0, 2, unit_prices=UnitPrices({"stir": Fraction(2)}, prices))
        return refusal(at, **bound("0", objective=["price"]) | {"tree": [0], "costs": [cost]})

    assert priced(0, 1, cost="5") == ""
    for unit, cost in ((0, "7"), (1, "5")):
        assert priced(unit, cost=cost) == "a unit has none of the prices that a claim needs"


# --- digests


def test_digests_are_those_of_canonical_json() -> None:
    """Written out by hand: a certificate of today has to fit the same data forever."""
    bowl, dish = (
        "bowl; clean; big; red; on [tray]; in [oven]; at [home]",
        '"plat\u00e9"; contains {salt,egg,egg}',
    )
    small = recipe(f"pour: {bowl} + {dish} > end", f"mix: end > {dish}").network
    written = (
        '[3,[["bowl",["big","clean","red"],[["at","home"],["in","oven"],["on","tray"]],[]],'
        '["plat\\u00e9",[],[],[["contains",["egg","egg","salt"]]]],["end",[],[],[]]],'
        '["pour","mix"],[[0,1],[2]],[[2],[1]]]'
    )
    rates = {"pour": Fraction(1, 2), "mix": Fraction(3)}
    assert Subject(small, {2, 0}, rates, frozenset(("cup", "bowl"))).digests() == {
        "network": sha(written),
        "kitchen": sha("[0,2]"),
        "rates": sha('[["mix","3"],["pour","1/2"]]'),
        "utensils": sha('["bowl","cup"]'),
        "prices": sha("null"),
        "sources": sha("null"),
    }
    end = parse_node("end")
    elsewhere = FunctionalUnit("mix", (end,), (end,))
    prices = UnitPrices(rates, {small.unit(1): Fraction(0), elsewhere: Fraction(1)})
    level_1 = network_at_level(small, 1)
    for network in (small, level_1):
        found = Subject(network, (), None, frozenset(), prices).digests()
        assert found["prices"] == sha('[[["mix","3"],["pour","1/2"]],[[1,"0"]]]')
    assert Subject(small, (), None, frozenset(), UnitPrices({}, {})).digests()["prices"] == sha("[[],[]]")
    assert Subject(level_1, (), {}, frozenset()).digests()["network"] == sha(
        '[1,[["bowl",[],[],[]],["plat\\u00e9",[],[],[]],["end",[],[],[]]],'
        f'["pour","mix"],[[0,1],[2]],[[2],[1]],{written},[[0],[1]]]'
    )
    assert seal({"b": [1, "x"], "seal": "any", "a": None}) == sha('{"a":null,"b":[1,"x"]}')


# --- how much work is done, and how long numbers may be


def test_a_check_has_five_million_steps_and_more_for_a_large_network() -> None:
    """Rates with 420 nines and more, whose logarithms have 450 digits, which are 45 ** 3 steps each."""
    rates = [str(1 - Fraction(1, 10**nines)) for nines in range(420, 476)]
    units = {f"go {number}": rate for number, rate in enumerate(rates)}
    at = recipe(*(f"{motion}: start > end" for motion in units), rates=units)
    said = "to check it takes more than 5,011,600 steps"  # for 56 units and two object nodes
    assert refusal(at, **bound(dict.fromkeys(rates, "-1"), objective=["success"])) == said


HALVES = recipe("one: start > end", "two: start > end", rates={"two": "1/4"})


@pytest.mark.parametrize(
    ("most", "at", "values"),
    [
        (4_300, PLAIN, bound("1", cuts=[[END]] * 200, proof=weigh(*["1/200"] * 200))),
        (9_800, PLAIN, bound("0", rules=forbid(f"sing {number:03}" for number in range(99)))),
        (4_000, PLAIN, bound("0", rules=[claiming(*([[MIX, BAKE], [POUR]] for _ in range(200)))])),
        (600, HALVES, bound({"1/2": "-200", "1/4": "100"}, objective=["success"])),
        (14, PLAIN, bound(str(-(2**1535)))),
    ],
    ids=["cuts", "rules", "claims", "products", "digits"],
)
def test_work_of_all_kinds_is_counted(
    monkeypatch: pytest.MonkeyPatch, most: int, at: Problem, values: Content
) -> None:
    assert accepted(at, **values).claim == "bound"
    limits = ALLOWED._replace(steps=most, steps_each=0)
    monkeypatch.setattr(verifier, "ALLOWED", limits)
    assert refusal(at, **values) == f"to check it takes more than {most:,} steps"


NINES = "9" * 1999
LONG = "its fractions add up to numbers that are too long"
RATES = {
    f"1/{denominator}": f"-{2**5998}" for denominator in range(2, 8)
}  # exponents of 36,000 bits together
SIX = recipe(*(f"{rate}: start > end" for rate in RATES), rates={rate: rate for rate in RATES})
PRICE_LONG = "what the tree costs is too long a number to be written"
RATE_LONG = "the success rate of the tree is too long a number to be written"


def test_numbers_have_their_limits() -> None:
    assert accepted(**bound(f"-{NINES}")).claim == "bound"
    assert refusal(**bound(f"-{NINES}9")) == "a fraction has more than 2,000 digits"
    assert accepted(SIX, **bound(RATES, objective=["success"])).claim == "bound"
    assert refusal(SIX, **bound({**RATES, "1/7": f"-{2**5999}"}, objective=["success"])) == LONG
    # 13,000 bits, of the denominators of rates together, and of a cost in the numerator as in the denominator
    for last, said in ((Fraction(1, 3), ""), (Fraction(1, 6), RATE_LONG)):
        rates = {"one": Fraction(1, 2**12_997), "two": last}
        two = recipe("one: start > middle", "two: middle > end", rates=rates)
        values = {"objective": ["success"], "tree": [0, 1], "costs": [str(rates["one"] * last)]}
        assert refusal(two, **bound({}) | values) == said
    for price in (Fraction(2**13_000), Fraction(1, 2**13_000)):
        fits = Fraction(2**13_000 - 1) if price > 1 else Fraction(1, 2**13_000 - 1)
        for each, said in ((fits, ""), (price, PRICE_LONG)):
            priced = replace(PLAIN, unit_prices=UnitPrices(dict.fromkeys(PLAIN.network.motions, each), {}))
            values = {"objective": ["price"], "tree": [POUR], "costs": [str(each)]}
            assert refusal(priced, **bound("0") | values) == said


# --- reading

FAR = "it has more than 16,000,000 letters"


def test_files_have_their_limits(tmp_path: Path) -> None:
    file = tmp_path / "proof.json"
    text = "[]" + " " * 15_999_998
    file.write_text(text)
    assert load_certificate(file) == []
    file.write_text(text + " ")
    with pytest.raises(CheckLimitError, match=f"^{FAR}$"):
        load_certificate(file)
    brackets = '"' + "[" * 600_000 + "{" * 400_000 + '"'
    assert len(read_certificate(brackets)) == 1_000_000
    for longer in (text + " ", brackets + "["):
        with pytest.raises(CheckLimitError, match=f"^{FAR} or 1,000,000 brackets$"):
            read_certificate(longer)


# --- what rules of the user's own are said to leave


def test_what_is_taken_on_trust_is_found() -> None:
    assert trusted_claims({"rules": [*forbid(["pour"]), claiming()]}) == claiming()
    assert trusted_claims({"rules": forbid(["pour"])}) is None
    assert trusted_claims({}) is None
    text = "cost(mine,U,1) :- unit(U)."
    measures = {"mine": {"rules": text, "sha256": sha(text), "costs": {"0": [POUR]}}}
    assert accepted(**bound("0"), measures=measures).trusted == ()
    used = accepted(**bound("0", objective=["mine"]), measures=measures).trusted
    assert [(each.name, each.costs) for each in used] == [("mine", {})]


def test_a_claim_is_about_units_of_one_set_and_none_of_another_and_what_they_come_to() -> None:
    """Mixing counts 2 and baking 1; pouring counts nothing."""
    exceeds = "the tree exceeds what a rule limits"
    for rule, said in (
        (claiming([[MIX], [BAKE]]), ""),
        (claiming([[MIX], [POUR]]), "the tree breaks a rule"),
        (claiming([[BAKE], []]), f"the tree has unit {BAKE}, which a rule removes"),
        (claiming([[], [POUR]]), "the tree lacks what a rule asks for"),
        (claiming(limits=[[{"1": [BAKE], "2": [MIX]}, 2]]), exceeds),
        (claiming(limits=[[{"1": [BAKE], "2": [MIX]}, 3]]), ""),
    ):
        assert refusal(**bound("0") | BAKED, rules=[rule]) == said
    two = claiming(limits=[[{"1": [BAKE], "2": [MIX]}, 2]])
    assert accepted(**POURED, rules=[two], cuts=[[END]], proof=weigh("1")).claim == "optimal"
    # without pouring there is no tree; the limit of the rule after the library's is the next but one
    rules = sorted([*forbid(["pour"]), two], key=canonical_json)
    proof = weigh("1", "2", limits=[[2, ["1"]]])
    values: Content = {**NO_TREE, "rules": rules, "cuts": CUTS}
    assert accepted(**values, proof=proof).claim == "infeasible"
    said = "a rule that limits nothing is given a weight"
    assert refusal(**values, proof={**proof, "limits": [[1, ["1"]]]}) == said


def test_after_a_broken_rule_the_other_branches_are_looked_at() -> None:
    proof = branch(weigh(), branch(weigh(), {"broken": 0}, unit=BAKE), unit=MIX)
    assert refusal(**bound("5"), rules=[claiming([[MIX, BAKE], []])], proof=proof) == LESS


def test_limits_and_what_stands_for_a_thing_that_is_used_once() -> None:
    """Of a cup that is filled and poured and a bowl that is washed and dried one may be used."""
    at = recipe(
        *(
            "fill: start > cup; full",
            "pour: cup; full > end",
            "wash: end > bowl; wet",
            "dry: bowl; wet > other",
        ),
        utensils="cup bowl",
    )
    cup, end, bowl, other, of_bowl, of_cup = range(1, 7)  # what units ask for that touch one

    def utensils(most: int) -> list[Content]:
        return [{"rule": "at_most_utensils", "max_utensils": most}]

    tree: Content = {"tree": [0, 1, 2, 3], "costs": [4]}
    assert refusal(at, **bound("0") | tree, rules=utensils(1)) == "the tree exceeds what a rule limits"
    # each of the two things is needed, one is there, and neither costs anything
    cuts = [[cup, end, bowl, other, of_cup], [bowl, other, of_bowl]]
    # the same by branches: the step of each thing is used, as the units need it, and then there are two
    steps = branch(HOPELESS, weigh(limits=[[0, ["1"]]]), step=1)
    for proof in (weigh("1", "1", limits=[[0, ["1"]]]), branch({"hopeless": 1}, steps, step=0)):
        assert accepted(at, **NO_TREE, rules=utensils(1), cuts=cuts, proof=proof).claim == "infeasible"
        assert refusal(at, **NO_TREE, rules=utensils(2), cuts=cuts, proof=proof) == LESS
    without = refusal(at, **NO_TREE, rules=utensils(1), cuts=cuts, proof=weigh("1", "1"))
    assert "carries more than it costs" in without


def test_what_a_limit_does_not_speak_of_carries_what_it_costs() -> None:
    """One may be baked at most: what is baked may carry more, and what is poured no more than it costs."""
    rules = [{"rule": "at_most_motion", "limited_motion": "bake", "max_uses": 1}]
    half: Content = {"limits": [[0, ["1/2"]]]}
    values: Content = {"rules": rules, "cuts": [[END]]}
    assert accepted(**bound("1/2", **values), proof=weigh("1", **half)).claim == "bound"
    assert refusal(**bound("1", **values), proof=weigh("1", **half)) == LESS
    assert refusal(**bound("1/2", **values), proof=weigh("3/2", **half)) == carries(POUR)
    for weight in ("0", "-1"):
        said = "limits: a weight is not above zero"
        assert refusal(**bound("0", **values), proof=weigh("1", limits=[[0, [weight]]])) == said
    no_pouring = sorted([*rules, *forbid(["pour"])], key=canonical_json)
    baked: Content = {"rules": no_pouring, "cuts": [[END]], "proof": weigh("3/2", limits=[[1, ["1/2"]]])}
    assert accepted(**bound("1", **baked)).claim == "bound"


@pytest.mark.parametrize(
    ("objective", "weight", "multiples", "bounds", "said"),
    [
        (["units"], ["1/3"], {"units": "1"}, ["1"], ""),
        (["units"], ["1/3"], {"units": "1/2"}, ["1"], LESS),
        (["units"], ["1"], {"units": "1"}, ["2"], LESS),  # it is one already
        (["units"], ["1/3"], {"units": "2"}, ["2"], NO_MULTIPLE),
        (["price"], ["1/3"], {"price": "2/3"}, ["2/3"], ""),
        # by the first that is not a multiple, and what comes after it is 0
        (["units", "inputs"], ["1/3", "9"], {"units": "1", "inputs": "1"}, ["1", "0"], ""),
        (["units", "inputs"], ["1/3", "9"], {"units": "1", "inputs": "1"}, ["1", "1"], LESS),
        (["units", "inputs"], ["1", "1/3"], {"units": "1", "inputs": "1"}, ["1", "1"], ""),
        (["units", "inputs"], ["1", "1/3"], {"inputs": "1"}, ["1", "1"], ""),
        (["units", "inputs"], ["1", "1/3"], {"units": "1"}, ["1", "1"], LESS),
        (["success"], [{}], {"success": "1"}, [{}], NO_MULTIPLE),
        # items cost 1 each, and no unit costs anything
        (["kitchen"], ["1/3"], {"kitchen": "1"}, ["1"], ""),
        (["kitchen"], ["1/3"], {"kitchen": "1"}, ["2"], LESS),
    ],
)
def test_a_bound_is_rounded_up_to_what_all_costs_are_multiples_of(
    objective: list[str], weight: list[Any], multiples: Content, bounds: list[Any], said: str
) -> None:
    prices = {motion: Fraction(2 * (unit + 1), 3) for unit, motion in enumerate(PLAIN.network.motions)}
    priced = replace(PLAIN, unit_prices=UnitPrices(prices, {}))
    cuts = TAKEN["cuts"] if objective == ["kitchen"] else [[END]]
    proof = weigh(*([] if weight == [{}] else [weight]), multiples=multiples)
    values: Content = {"objective": objective, "cuts": cuts if proof["weights"] else [], "proof": proof}
    assert refusal(priced, **bound(*bounds, **values)) == said


def test_what_is_used_is_paid_for_beside_what_is_rounded_up() -> None:
    values: Content = {"cuts": [[MIDDLE], [END]], **NO_POURING}
    proof = branch({"hopeless": 1}, weigh("1/3", multiples={"units": "1"}), unit=BAKE)
    assert accepted(**bound("2", **values), proof=proof).claim == "bound"
    assert refusal(**bound("3", **values), proof=proof) == LESS
