"""What the verifier says of certificates written by hand: what is proved, what is refused, in how many steps.

tests/test_forged_certificates.py has a certificate for every check; here is what the checks compute.
"""

import hashlib
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

from foon_asp.network import (
    FunctionalUnit,
    Network,
    NetworkBuilder,
    ObjectNode,
    Source,
    UnitPrices,
    network_at_level,
)
from foon_asp.problem import ContainerRule, Problem
from foon_asp.proof import verify
from foon_asp.proof.constraint import OWN
from foon_asp.proof.verify import LimitError, RefusedError, digests, load_certificate, read_certificate
from tests.handmade_certificate import Content, check, forbid, handmade, older


def network(*units: tuple[str, list[ObjectNode], list[ObjectNode]]) -> Network:
    builder = NetworkBuilder()
    for line, (motion, inputs, outputs) in enumerate(units):
        builder.add(motion, inputs, outputs, Source("handmade", line + 1))
    return builder.build()


def accepted(problem: Problem, **values: Any) -> verify.Verified:
    return check(handmade(problem, **values), problem)


def refusal(problem: Problem, **values: Any) -> str:
    """Give why a certificate with these values is refused."""
    with pytest.raises(RefusedError) as refused:
        accepted(problem, **values)
    return str(refused.value)


START, RARE = ObjectNode.of("start"), ObjectNode.of("rare")
SALT = ObjectNode.of("salt", [], [], [("contains", ["grain", "iodine"])])
MIDDLE, END, OTHER = (ObjectNode.of(label) for label in ("middle", "end", "other"))
# The end is poured of the start, or baked of a middle that is mixed; what is rare nobody has.
POUR, MIX, BAKE, DIG = range(4)
PLAIN = Problem(
    network(
        ("pour", [START], [END]),
        ("mix", [START, SALT], [MIDDLE]),
        ("bake", [MIDDLE], [END]),
        ("dig", [RARE], [OTHER]),
    ),
    frozenset({0, 2}),
    (1,),
    {"pour": Fraction(1, 2), "mix": Fraction(3, 4), "bake": Fraction(1), "dig": Fraction(0)},
    frozenset(),
)
START_ID, END_ID, SALT_ID, MIDDLE_ID, RARE_ID, OTHER_ID = range(6)
BOUND: Content = {"claim": "bound", "bound": ["0"]}
NO_TREE: Content = {"claim": "infeasible", "objective": []}
POURED: Content = {"tree": [POUR], "costs": [1]}
NO_POURING: Content = {"rules": forbid(["pour"])}
ONE = {"weights": [[0, ["1"]]]}
ANOTHER_KIND = "a value of a rule is of another kind"
BOTH = {"weights": [[0, ["1"]], [1, ["1"]]]}


# --- what is proved


@pytest.mark.parametrize(
    ("objective", "tree", "costs", "cuts", "weights"),
    [
        (["units"], [POUR], [1], [[END_ID]], [["1"]]),
        (["inputs"], [POUR], [1], [[END_ID]], [["1"]]),
        (["inputs+ingredients"], [POUR], [1], [[END_ID]], [["1"]]),
        # with the middle, the members are pouring and mixing
        (["success"], [MIX, BAKE], ["3/4"], [[END_ID, MIDDLE_ID]], [[{"3/4": "1"}]]),
        (
            ["success", "units"],
            [MIX, BAKE],
            ["3/4", 2],
            [[END_ID], [END_ID, MIDDLE_ID]],
            [[{}, "1"], [{"3/4": "1"}, "1"]],
        ),
        # what pours and what mixes asks for the start
        (["kitchen"], [POUR], [1], [[START_ID, END_ID, MIDDLE_ID]], [["1"]]),
        (
            ["kitchen", "units"],
            [POUR],
            [1, 1],
            [[END_ID], [START_ID, END_ID, MIDDLE_ID]],
            [["0", "1"], ["1", "0"]],
        ),
    ],
)
def test_an_optimum_by_each_objective(
    objective: list[str], tree: list[int], costs: list[Any], cuts: list[Any], weights: list[Any]
) -> None:
    values: Content = {"objective": objective, "tree": tree, "costs": costs, "cuts": cuts}
    values["proof"] = {"weights": [list(pair) for pair in enumerate(weights)]}
    found = accepted(PLAIN, **values)
    assert found == verify.Verified(
        "optimal",
        (END_ID,),
        "strict",
        3,
        tuple(objective),
        *((), ()),
        tuple(tree),
        tuple(Fraction(cost) for cost in costs),
        len(cuts),
    )
    assert [str(cost) for cost in found.costs or ()] == [str(cost) for cost in costs]
    for version in (1, 2):  # which say the same of strict containers, and know no prices
        assert accepted(PLAIN, **values, version=version, digests=older(PLAIN)) == found
        said = "expected the keys network, kitchen, rates, utensils"
        assert refusal(PLAIN, **values, version=version) == said


@pytest.mark.parametrize(
    ("objective", "cost"),
    [("units", 2), ("inputs", 3), ("inputs+ingredients", 5), ("success", Fraction(3, 4)), ("kitchen", 2)],
)
def test_costs_of_a_tree(objective: str, cost: int | Fraction) -> None:
    stated = str(cost) if isinstance(cost, Fraction) else cost
    bound: list[Any] = [{}] if objective == "success" else ["0"]
    values: Content = {"claim": "bound", "objective": [objective], "bound": bound, "tree": [MIX, BAKE]}
    assert accepted(PLAIN, **values, costs=[stated]).costs == (cost,)
    computed = f'["{stated}"]' if objective == "success" else f"[{stated}]"
    said = f"the tree costs {computed}, not what is stated"
    others: list[Any] = [[], [stated, stated], ["1"], [True], [1.0], None, {}, 1]
    for other in others:
        assert refusal(PLAIN, **values, costs=other) == said
    assert refusal(PLAIN, **values, costs=[str(cost) + "0"]) == said
    if objective != "success":
        assert refusal(PLAIN, **values, costs=[float(cost)]) == said


def test_a_cost_of_1_is_not_true() -> None:
    values: Content = {**BOUND, "tree": [POUR]}
    assert accepted(PLAIN, **values, costs=[1]).costs == (1,)
    for other in (True, 1.0, "1"):
        assert refusal(PLAIN, **values, costs=[other]) == "the tree costs [1], not what is stated"


@pytest.mark.parametrize(
    ("objective", "weight", "proved", "too_much"),
    [
        (["units"], ["1"], ["1"], ["1001/1000"]),
        (["units"], ["1/3"], ["1/3"], ["1/2"]),
        (["units", "inputs"], ["1", "0"], ["1", "0"], ["1", "1/9"]),
        (["units", "inputs"], ["1", "0"], ["1/2", "7"], ["2", "-7"]),
        (["units", "inputs"], ["1", "-1"], ["1", "-1"], ["1", "0"]),
        # of the rates 1/2 and 1 the greater one costs nothing, but for a unit
        (["success", "units"], [{}, "1"], [{}, "1"], [{}, "2"]),
        (["success", "units"], [{}, "1"], [{"1/2": "-1"}, "9"], [{"1/2": "1/9"}, "-9"]),
    ],
)
def test_bounds(objective: list[str], weight: list[Any], proved: list[Any], too_much: list[Any]) -> None:
    """The cut is crossed by pouring and by baking, and both cost 1 by units and by inputs."""
    values: Content = {"claim": "bound", "objective": objective, "cuts": [[END_ID]]}
    values["proof"] = {"weights": [[0, weight]]}
    assert accepted(PLAIN, **values, bound=proved).claim == "bound"
    assert refusal(PLAIN, **values, bound=too_much) == "the weights do not add up to enough"


def test_a_bound_and_the_tree_beside_it() -> None:
    values: Content = {"claim": "bound", "cuts": [[END_ID]], "proof": ONE, **POURED}
    assert accepted(PLAIN, **values, bound=["1"]).tree == (POUR,)
    assert refusal(PLAIN, **values, bound=["2"]) == "the bound is false"


def test_no_tree_at_all() -> None:
    nobody = {**NO_TREE, "goals": [{"id": OTHER_ID, "node": "other"}], "proof": {"hopeless": 0}}
    found = accepted(PLAIN, **nobody, cuts=[[RARE_ID, OTHER_ID]])
    assert (found.claim, found.goals, found.objectives, found.tree, found.costs, found.cuts) == (
        *("infeasible", (OTHER_ID,), (), None, None),
        1,
    )
    crossed = "a cut called hopeless is crossed"
    assert refusal(PLAIN, **nobody, cuts=[[OTHER_ID]]) == crossed  # by digging
    tree: Content = {**nobody, **POURED, "objective": ["units"]}
    assert refusal(PLAIN, **{**tree, "goals": [{"id": END_ID, "node": "end"}]}) == "there cannot be a tree"


def test_what_is_forbidden_is_no_member() -> None:
    values: Content = {"tree": [MIX, BAKE], "costs": [2], "cuts": [[END_ID], [END_ID, MIDDLE_ID]]}
    found = accepted(PLAIN, **values, **NO_POURING, proof=BOTH)
    assert (found.claim, list(found.rules)) == ("optimal", forbid(["pour"]))
    assert refusal(PLAIN, **values, proof=BOTH) == "unit or item 0 carries more than it costs"
    salty: Content = {"rules": forbid([], ["salt"])}
    assert accepted(PLAIN, **POURED, cuts=[[END_ID]], proof=ONE, **salty).rules == (*forbid([], ["salt"]),)
    assert refusal(PLAIN, **values, proof=BOTH, **salty) == "the tree has unit 1, which a rule removes"
    assert refusal(PLAIN, **POURED, **NO_POURING) == "the tree has unit 0, which a rule removes"
    for label in ("middle", "end"):  # an input of one, an output of the other
        gone: Content = {"rules": forbid([], [label])}
        unit = MIX if label == "middle" else BAKE
        assert refusal(PLAIN, **values, **gone) == f"the tree has unit {unit}, which a rule removes"


def test_what_is_not_covered_is_passed_on() -> None:
    found = accepted(PLAIN, **BOUND, not_covered=["a.lp 1", "b=2"])
    assert found.not_covered == ("a.lp 1", "b=2")


def test_the_tree_is_executed_in_its_order() -> None:
    lacks = "unit 2 of the tree lacks an input when it is its turn"
    assert refusal(PLAIN, **BOUND, tree=[BAKE, MIX], costs=[2]) == lacks
    assert refusal(PLAIN, **BOUND, tree=[MIX], costs=[1]) == "the tree does not make every goal"
    goals = [{"id": END_ID, "node": "end"}, {"id": MIDDLE_ID, "node": "middle"}]
    assert refusal(PLAIN, **BOUND, **POURED, goals=goals) == "the tree does not make every goal"
    assert accepted(PLAIN, **BOUND, tree=[POUR, MIX], costs=[2], goals=goals).goals == (END_ID, MIDDLE_ID)
    at_hand = [{"id": START_ID, "node": "start"}]
    assert accepted(PLAIN, tree=[], costs=[0], goals=at_hand).costs == (0,)


def test_goals_at_hand_stand_behind_no_cut() -> None:
    """Not even where items count, and a cut may hold them."""
    goals = [{"id": START_ID, "node": "start"}, {"id": MIDDLE_ID, "node": "middle"}]
    values: Content = {**BOUND, "objective": ["kitchen"], "goals": goals, "proof": ONE}
    said = "cut 0 holds neither a goal nor what a used unit needs"
    assert refusal(PLAIN, **values, cuts=[[START_ID]]) == said
    assert accepted(PLAIN, **values, cuts=[[START_ID, MIDDLE_ID]]).cuts == 1


# --- members and what they carry


def test_a_unit_that_needs_a_node_of_the_cut_is_no_member() -> None:
    """With both nodes in the cut, baking carries nothing of it; and mixing is the only other member."""
    values: Content = {**NO_POURING, **BOUND, "cuts": [[END_ID], [END_ID, MIDDLE_ID]]}
    assert accepted(PLAIN, **{**values, "bound": ["2"]}, proof=BOTH).cuts == 2
    for weights, unit in (((1, 2), MIX), ((2, 1), BAKE)):
        proof = {"weights": [[0, [str(weights[0])]], [1, [str(weights[1])]]]}
        said = f"unit or item {unit} carries more than it costs"
        assert refusal(PLAIN, **values, proof=proof) == said


def test_items_are_members_of_their_own() -> None:
    """Items are numbered behind the units; by units first, what has no cost by kitchen may carry it."""
    values: Content = {**BOUND, "objective": ["units", "kitchen"], "bound": ["0", "1"]}
    for item in (START_ID, SALT_ID):
        cut = sorted({END_ID, MIDDLE_ID, item})
        for number in ("1", "1/2"):
            enough = {**values, "bound": ["0", number]}
            proof = {"weights": [[0, ["0", number]]]}
            assert accepted(PLAIN, **enough, cuts=[cut], proof=proof).claim == "bound"
        said = f"unit or item {4 + item} carries more than it costs"
        assert refusal(PLAIN, **values, cuts=[cut], proof={"weights": [[0, ["0", "2"]]]}) == said


def test_after_an_item_the_other_members_of_a_cut_are_found() -> None:
    values: Content = {**BOUND, "objective": ["kitchen"], "cuts": [[START_ID, END_ID]], "proof": ONE}
    assert refusal(PLAIN, **values) == "unit or item 2 carries more than it costs"  # baking


def test_weights_are_above_zero() -> None:
    for weight in ("0", "-1"):
        proof = {"weights": [[0, [weight]]]}
        assert refusal(PLAIN, **BOUND, cuts=[[END_ID]], proof=proof) == "a weight is not above zero"


def test_a_weight_speaks_of_rates_between_0_and_1() -> None:
    """The motions have the rates 0, 1/2, 3/4 and 1."""
    values: Content = {**BOUND, "bound": [{}], "objective": ["success"], "cuts": [[END_ID, MIDDLE_ID]]}
    for rate in ("0", "1", "1/3", "2"):
        proof = {"weights": [[0, [{rate: "1"}]]]}
        said = "expected rates of motions in a weight, and none of 0 or 1"
        assert refusal(PLAIN, **values, proof=proof) == said
    for rate, unit in (("1/2", MIX), ("3/4", None)):
        proof = {"weights": [[0, [{rate: "1"}]]]}
        if unit is None:
            assert accepted(PLAIN, **values, proof=proof).claim == "bound"
        else:
            said = f"unit or item {unit} carries more than it costs"
            assert refusal(PLAIN, **values, proof=proof) == said


def test_a_rate_of_0_costs_more_than_any_weight() -> None:
    values: Content = {**BOUND, "bound": [{"1/2": "1000"}], "objective": ["success"]}
    goals = [{"id": OTHER_ID, "node": "other"}]
    at_hand = Problem(PLAIN.network, PLAIN.kitchen | {RARE_ID}, (OTHER_ID,), PLAIN.rates, frozenset())
    values |= {"goals": goals, "cuts": [[OTHER_ID]], "proof": {"weights": [[0, [{"1/2": "1000"}]]]}}
    assert accepted(at_hand, **values).claim == "bound"
    branch = {"branch": {"unit": DIG}, "without": {"hopeless": 0}, "using": {"weights": []}}
    assert accepted(at_hand, **{**values, "proof": branch}).claim == "bound"
    assert refusal(at_hand, **{**values, "bound": [{}]}, tree=[DIG], costs=["0"]) == (
        "a tree that never succeeds is no better than another"
    )


def test_a_rate_of_0_decides_before_all_objectives_after_it() -> None:
    goals = [{"id": OTHER_ID, "node": "other"}]
    at_hand = Problem(PLAIN.network, PLAIN.kitchen | {RARE_ID}, (OTHER_ID,), PLAIN.rates, frozenset())
    values: Content = {"claim": "bound", "objective": ["success", "units"], "goals": goals}
    values |= {"cuts": [[OTHER_ID]], "proof": {"weights": [[0, [{"1/2": "9"}, "9"]]]}}
    assert accepted(at_hand, **values, bound=[{"1/2": "9"}, "9"]).claim == "bound"


def test_rates_outside_of_0_and_1_are_refused() -> None:
    below, above = "one of the success rates is below 0", "a rate is above 1"
    for rate, said in ((Fraction(-1, 10), below), (Fraction(11, 10), above)):
        odd = Problem(
            PLAIN.network, PLAIN.kitchen, (END_ID,), {**(PLAIN.rates or {}), "dig": rate}, frozenset()
        )
        assert refusal(odd, claim="bound", objective=["success"], bound=[{}]) == said
        assert accepted(odd, **BOUND).claim == "bound"  # by units, rates are nobody's business


def test_without_rates_all_but_success_is_proved() -> None:
    plain = Problem(PLAIN.network, PLAIN.kitchen, (END_ID,), None, frozenset())
    assert accepted(plain, **POURED, cuts=[[END_ID]], proof=ONE).claim == "optimal"
    values: Content = {"claim": "bound", "objective": ["success"], "bound": [{}]}
    assert refusal(plain, **values) == "a claim needs success rates, but none are given"


def test_units_that_need_nothing_take_no_items() -> None:
    """By kitchen they cost nothing, and the units decide."""
    made = network(("find", [], [END]))
    problem = Problem(made, frozenset(), (0,), None, frozenset())
    values: Content = {"objective": ["kitchen", "units"], "tree": [0], "costs": [0, 1]}
    assert refusal(problem, **values) == "the weights do not add up to enough"
    proof = {"weights": [[0, ["0", "1"]]]}
    assert accepted(problem, **values, cuts=[[0]], proof=proof).costs == (0, 1)


def test_an_objective_that_is_known_by_name_alone_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(verify, "OBJECTIVES", (*verify.OBJECTIVES, "pans"))
    values: Content = {**BOUND, "objective": ["pans"], "cuts": [[END_ID]], "proof": ONE}
    assert refusal(PLAIN, **values) == "an objective is unknown"


# --- branches


def test_a_branch_on_a_unit() -> None:
    """Without baking nothing makes the end; with it, it is paid for, and what it needs has to be made."""
    using = {"weights": [[1, ["1"]]]}
    proof = {"branch": {"unit": BAKE}, "without": {"hopeless": 0}, "using": using}
    values: Content = {**BOUND, **NO_POURING, "cuts": [[END_ID], [MIDDLE_ID]], "bound": ["2"]}
    assert accepted(PLAIN, **values, proof=proof).cuts == 2
    not_used = "cut 1 holds neither a goal nor what a used unit needs"
    assert refusal(PLAIN, **values, proof={**proof, "branch": {"unit": DIG}}) == not_used
    more = {**values, "bound": ["3"]}
    assert refusal(PLAIN, **more, proof=proof) == "the weights do not add up to enough"
    paid = {**proof, "using": {"weights": [[0, ["1"]], [1, ["1"]]]}}
    assert refusal(PLAIN, **values, proof=paid) == "unit or item 2 carries more than it costs"
    twice = {**proof, "using": proof}
    assert refusal(PLAIN, **values, proof=twice) == "a branch is taken twice"
    forbidden = {**proof, "branch": {"unit": POUR}}
    assert refusal(PLAIN, **values, proof=forbidden) == "a branch is taken twice"
    crossed = {**proof, "without": {"hopeless": 1}}
    assert refusal(PLAIN, **values, proof=crossed) == not_used


def test_a_branch_on_an_item() -> None:
    values: Content = {**BOUND, "objective": ["kitchen"], "bound": ["1"]}
    values["cuts"] = [[START_ID, END_ID, MIDDLE_ID], [MIDDLE_ID]]
    proof: Content = {"branch": {"item": START_ID}, "without": {"hopeless": 0}, "using": {"weights": []}}
    assert accepted(PLAIN, **{**values, "cuts": values["cuts"][:1]}, proof=proof).claim == "bound"
    using = {**proof, "using": {"weights": [[1, ["1"]]]}}  # an item needs nothing
    not_used = "cut 1 holds neither a goal nor what a used unit needs"
    assert refusal(PLAIN, **values, proof=using) == not_used
    other = {**proof, "branch": {"item": SALT_ID}}
    assert refusal(PLAIN, **values, proof=other) == "a cut called hopeless is crossed"
    twice = {**proof, "using": proof}
    assert refusal(PLAIN, **values, proof=twice) == "a branch is taken twice"


@pytest.mark.parametrize(
    ("branch", "said"),
    [
        ({"unit": 4}, "expected the id of a unit"),
        ({"unit": -1}, "expected the id of a unit"),
        ({"unit": True}, "expected the id of a unit"),
        ({"unit": None}, "expected the id of a unit"),
        ({"item": MIDDLE_ID}, "expected the id of a kitchen item"),
        ({"item": False}, "expected the id of a kitchen item"),
        ({"item": 2.0}, "expected the id of a kitchen item"),
        ({"item": 0, "unit": 0}, "expected the keys unit"),
        ({}, "expected the keys unit"),
        ([], "expected an object"),
    ],
)
def test_what_is_no_branch(branch: Any, said: str) -> None:
    leaf: Content = {"weights": []}
    proof = {"branch": branch, "without": leaf, "using": leaf}
    assert refusal(PLAIN, **BOUND, objective=["kitchen"], proof=proof) == said


# --- values of other kinds

NO_ID = "expected ids of the network"


@pytest.mark.parametrize(
    ("values", "said"),
    [
        ({"version": 0}, "expected version 5 of the format"),
        ({"version": 6}, "expected version 5 of the format"),
        ({"version": True}, "expected version 5 of the format"),
        ({"version": 2.0}, "expected version 5 of the format"),
        ({"version": "2"}, "expected version 5 of the format"),
        ({"level": 2}, "not a claim about level 3"),
        ({"level": 3.0}, "not a claim about level 3"),
        ({"level": None}, "not a claim about level 3"),
        ({"goals": []}, "expected goals, each of them once"),
        ({"goals": [{"id": END_ID, "node": "end"}] * 2}, "expected goals, each of them once"),
        ({"goals": [{"id": 6, "node": "end"}]}, NO_ID),
        ({"goals": [{"id": -5, "node": "end"}]}, NO_ID),
        ({"goals": [{"id": True, "node": "end"}]}, NO_ID),
        ({"goals": [{"id": END_ID, "node": "start"}]}, "a goal is not the node of its id"),
        ({"tree": [4]}, NO_ID),
        ({"tree": [-1]}, NO_ID),
        ({"tree": [0.0]}, NO_ID),
        ({"tree": [POUR, POUR]}, "an id stands twice"),
        ({"cuts": [[6]]}, NO_ID),
        ({"cuts": [[-1]]}, NO_ID),
        ({"cuts": [[]]}, "expected ids in order"),
        ({"cuts": [[3, 1]]}, "expected ids in order"),
        ({"cuts": [[1, 1]]}, "an id stands twice"),
        ({"cuts": [[START_ID, END_ID]]}, "a cut holds a kitchen item"),
        ({"proof": ONE}, "expected the number of a cut"),
        ({"proof": {"weights": [[-1, ["1"]]]}}, "expected the number of a cut"),
        ({"proof": {"weights": [[True, ["1"]]]}}, "expected the number of a cut"),
        ({"proof": {"weights": [[0, ["1"]], [0, ["1"]]]}}, "expected cuts in order, each of them once"),
        ({"proof": {"weights": [[1, ["1"]], [0, ["1"]]]}}, "expected cuts in order, each of them once"),
        ({"proof": {"weights": [[[], ["1"]]]}}, "expected the number of a cut"),
        ({"proof": {"weights": [[0, ["1"]], ["1", ["1"]]]}}, "expected the number of a cut"),
        ({"proof": {"weights": [[0]]}}, "expected a cut and its weight"),
        ({"proof": {"weights": ["ab"]}}, "expected a cut and its weight"),
        ({"proof": {"hopeless": 0}}, "expected the number of a cut"),
        ({"proof": {"hopeless": -1}}, "expected the number of a cut"),
        ({"proof": {}}, "expected weights, a hopeless cut, a broken rule or a branch"),
        ({"objective": ["units", "units"]}, "an objective stands twice"),
        ({"objective": ["unit"]}, "an objective is unknown"),
        ({"objective": []}, "expected objectives"),
        ({"bound": []}, "expected one part of a weight for each objective"),
        ({"bound": ["0", "0"]}, "expected one part of a weight for each objective"),
        ({"bound": [0]}, "expected a number such as 3/2"),
        ({"bound": ["1.5"]}, "expected a number such as 3/2"),
        ({"bound": ["+1"]}, "expected a number such as 3/2"),
        ({"bound": ["-0"]}, "expected a fraction in lowest terms"),
        ({"bound": ["2/4"]}, "expected a fraction in lowest terms"),
        ({"bound": ["1/1"]}, "expected a fraction in lowest terms"),
        ({"bound": ["\u0661"]}, "expected a number such as 3/2"),
        ({"costs": [0]}, "costs are given, but no tree"),
        ({"claim": "optimal"}, "expected the tree that is optimal"),
        ({"claim": "infeasible"}, "there cannot be a tree"),
        (
            {"version": 3, "forbidden": {"motions": ["b", "a"], "objects": []}},
            "expected names in order, each of them once",
        ),
        (
            {"version": 3, "forbidden": {"motions": [], "objects": ["a", "a"]}},
            "expected names in order, each of them once",
        ),
        ({"version": 3, "forbidden": {"motions": [1], "objects": []}}, "expected names"),
        ({"rules": {}}, "expected a list"),
        ({"rules": [[]]}, "expected an object"),
        ({"rules": [{}]}, "a rule is unknown"),
        ({"rules": [{"rule": ["forbid_motion"]}]}, "a rule is unknown"),
        ({"rules": [{"rule": "forbid_motion"}]}, "expected the keys rule, forbidden_motion"),
        ({"rules": forbid(["a", "b"])[::-1]}, "expected rules in order, each of them once"),
        ({"rules": forbid([], ["a", "a"])}, "expected rules in order, each of them once"),
        (
            {"rules": [{"rule": "forbid_motion", "forbidden_motion": 1}]},
            ANOTHER_KIND,
        ),
        ({"rules": [{"rule": "at_most_units", "max_units": "1"}]}, ANOTHER_KIND),
        (
            {"rules": [{"rule": "only_sources", "allowed": ["b", "a"]}]},
            "expected names in order, each of them once",
        ),
        ({"rules": [{"rule": "only_sources", "allowed": [1]}]}, "expected names"),
        ({"rules": forbid([f"sing {number:03}" for number in range(101)])}, "it has more than 100 rules"),
        ({"not_covered": ["a\nb"]}, "a constraint has no printable name"),
        ({"containers": "loose"}, "expected the containers strict or implied"),
        ({"containers": "implied", "version": 1}, verify._VERSION_1),
    ],
)
def test_what_is_refused(values: Content, said: str) -> None:
    assert refusal(PLAIN, **{**BOUND, **values}) == said


def test_from_version_2_on_implied_containers_are_spoken_of() -> None:
    implied = replace(PLAIN, containers=ContainerRule.IMPLIED)
    assert accepted(implied, **BOUND, version=2, digests=older(implied)).containers == "implied"


def test_a_branch_on_an_item_where_items_cost_nothing() -> None:
    proof = {"branch": {"item": START_ID}, "without": {"weights": []}, "using": {"weights": []}}
    assert refusal(PLAIN, **BOUND, proof=proof) == "a branch on an item where items cost nothing"


def test_other_data_are_refused() -> None:
    content = handmade(PLAIN, **BOUND)
    others = {
        "network": Problem(
            network(("pour", [START], [END, SALT])), frozenset({0, 2}), (1,), PLAIN.rates, frozenset()
        ),
        "kitchen": Problem(PLAIN.network, frozenset({0}), (1,), PLAIN.rates, frozenset()),
        "rates": Problem(PLAIN.network, PLAIN.kitchen, (1,), None, frozenset()),
        "utensils": Problem(PLAIN.network, PLAIN.kitchen, (1,), PLAIN.rates, frozenset({"cup"})),
    }
    for part, other in others.items():
        with pytest.raises(RefusedError) as refused:
            check(content, other)
        assert str(refused.value) == f"{part}: not the one that the certificate is about"
    with pytest.raises(RefusedError) as refused:
        check({**content, "level": 2}, PLAIN)
    assert str(refused.value) == "the seal does not match: something was changed"


def test_a_level_is_a_number() -> None:
    plain = network_at_level(PLAIN.network, 1)
    level_1 = Problem(plain, frozenset({0, 2}), (1,), PLAIN.rates, frozenset())
    assert accepted(level_1, **BOUND).level == 1
    assert refusal(level_1, **BOUND, level=True) == "not a claim about level 1"


def test_what_holds_itself_is_refused() -> None:
    proof: Content = {"branch": {"unit": 0}, "without": {"weights": []}}
    proof["using"] = proof
    with pytest.raises(RefusedError, match="branches nested too deeply"):
        check({**handmade(PLAIN, **BOUND), "proof": proof}, PLAIN)


# --- the container rule

CUP = ObjectNode.of("cup", [], [], [("contains", ["salt"])])
IN_CUP = ObjectNode.of("salt", [], [("in", "cup")])


def asked(
    inputs: list[ObjectNode], lacking: int | None, goal: ObjectNode = END, rule: str = "implied"
) -> str | None:
    """Give why a unit does not make a goal where one of its inputs is lacking; ``None`` where it does.

    It puts out its inputs as well. The cup is a utensil.
    """
    made = network(("pour", inputs, [END, *inputs]))
    at_hand = frozenset(range(len(inputs))) - {lacking}
    goals = (made.object_id(goal) or 0,)
    problem = Problem(made, at_hand, goals, None, frozenset({"cup"}), ContainerRule(rule))
    try:
        accepted(problem, **BOUND, **POURED)
    except RefusedError as refused:
        return str(refused)
    return None


LACKS = "unit 0 of the tree lacks an input when it is its turn"


@pytest.mark.parametrize(
    ("vessel", "others", "given"),
    [
        (CUP, [IN_CUP], True),
        (CUP, [START, IN_CUP], True),
        (CUP, [ObjectNode.of("salt", ["dry"], [("on", "table"), ("under", "cup")])], True),  # any relation
        (CUP, [], False),
        (CUP, [SALT], False),  # nowhere
        (CUP, [ObjectNode.of("salt", [], [("in", "bowl")])], False),
        (CUP, [ObjectNode.of("flour", [], [("in", "cup")])], False),
        (ObjectNode.of("cup"), [IN_CUP], False),  # of nothing
        (ObjectNode.of("cup", [], [], [("contains", ["salt", "salt"])]), [IN_CUP], False),  # of two
        (ObjectNode.of("bowl", [], [], [("contains", ["salt"])]), [IN_CUP], False),  # no utensil
        (
            ObjectNode.of("bowl", [], [], [("contains", ["salt"])]),
            [ObjectNode.of("salt", [], [("in", "bowl")])],
            False,
        ),
        (ObjectNode.of("cup", [], [("in", "cup")], [("contains", ["cup"])]), [], False),  # in itself
    ],
)
def test_which_vessels_are_taken_as_given(vessel: ObjectNode, others: list[ObjectNode], given: bool) -> None:
    inputs = [vessel, *others]
    assert asked(inputs, lacking=None) is None
    assert asked(inputs, lacking=0) == (None if given else LACKS)
    assert asked(inputs, lacking=0, rule="strict") == LACKS
    for place in range(1, len(inputs)):
        assert asked(inputs, lacking=place) == LACKS
    if given:  # nothing comes from nothing
        said = "the tree does not make every goal"
        assert asked(inputs, lacking=0, goal=vessel) == said
        assert asked(inputs, lacking=None, goal=vessel) is None


def test_a_unit_that_does_not_make_a_node_is_no_member() -> None:
    made = network(("pour", [CUP, IN_CUP], [END, CUP]))
    for rule, said in (("implied", None), ("strict", "a cut called hopeless is crossed")):
        problem = Problem(made, frozenset({1}), (0,), None, frozenset({"cup"}), ContainerRule(rule))
        # under strict the pouring needs the cup, so that it is a member only with another goal
        proof = {"hopeless": 0}
        assert accepted(problem, **NO_TREE, cuts=[[0]], proof=proof).claim == "infeasible"
        ends = Problem(made, frozenset({1}), (2,), None, frozenset({"cup"}), ContainerRule(rule))
        if said is None:
            assert refusal(ends, **NO_TREE, cuts=[[2]], proof=proof) == "a cut called hopeless is crossed"
            assert refusal(ends, **NO_TREE, cuts=[[0, 2]], proof=proof) == (
                "a cut called hopeless is crossed"
            )
        else:
            assert refusal(ends, **NO_TREE, cuts=[[2]], proof=proof) == said
            assert accepted(ends, **NO_TREE, cuts=[[0, 2]], proof=proof).claim == "infeasible"


SUGAR_CUP = ObjectNode.of("cup", [], [], [("contains", ["sugar"])])
PEPPER_CUP = ObjectNode.of("cup", [], [], [("contains", ["pepper"])])
PEPPER = ObjectNode.of("pepper", [], [("in", "cup")])
PASTE = ObjectNode.of("paste")
# Below level 3, the first two are one unit. The first takes its cup as given, the second does not, since
# sugar is not among its inputs. The third does.
DETAILED = network(
    ("pour", [IN_CUP, CUP], [END, CUP]),
    ("pour", [IN_CUP, SUGAR_CUP], [END, SUGAR_CUP]),
    ("stir", [PEPPER, PEPPER_CUP], [PASTE, PEPPER_CUP]),
)


@pytest.mark.parametrize("level", [1, 2])
def test_below_level_3_a_unit_needs_what_all_need_and_makes_what_any_makes(level: int) -> None:
    merged = network_at_level(DETAILED, level)
    assert merged.stands_for == ((0, 1), (2,))
    salt, cup, end, pepper, paste = range(5)
    labels = [node.label for node in merged.objects]
    assert labels == ["salt", "cup", "end", "pepper", "paste"]

    def tried(kitchen: set[int], tree: list[int], goal: int) -> str | None:
        utensils = frozenset({"cup"})
        problem = Problem(merged, frozenset(kitchen), (goal,), None, utensils, ContainerRule.IMPLIED)
        try:
            accepted(problem, **BOUND, tree=tree, costs=[len(tree)])
        except RefusedError as refused:
            return str(refused)
        return None

    assert tried({salt}, [0], end) is None
    assert tried({salt}, [0], cup) is None  # that of sugar, which is made
    assert tried({cup}, [0], end) == LACKS
    assert tried({pepper}, [1], paste) is None
    assert tried({pepper}, [1], cup) == "the tree does not make every goal"
    assert tried({cup}, [1], paste) == LACKS.replace("0", "1")


def test_below_level_3_a_unit_has_a_price_if_all_that_it_stands_for_have_one() -> None:
    merged = network_at_level(DETAILED, 2)
    one, other = DETAILED.unit(0), DETAILED.unit(1)
    by_price: Content = {"claim": "bound", "objective": ["price"], "bound": ["0"], "tree": [0]}

    def priced(units: dict[FunctionalUnit, Fraction]) -> Problem:
        prices = UnitPrices({"stir": Fraction(2)}, units)
        utensils, rule = frozenset({"cup"}), ContainerRule.IMPLIED
        return Problem(merged, frozenset({0}), (2,), None, utensils, rule, unit_prices=prices)

    known = {one: Fraction(7), other: Fraction(5)}
    assert accepted(priced(known), **by_price, costs=["5"]).costs == (5,)
    for unit, price in known.items():
        said = "a unit has none of the prices that a claim needs"
        assert refusal(priced({unit: price}), **by_price, costs=[str(price)]) == said


# --- digests


def sha(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()


def test_digests_are_those_of_canonical_json() -> None:
    """Written out by hand: a certificate of today has to fit the same data forever."""
    bowl = ObjectNode.of(
        "bowl", ["clean", "big", "red"], [("on", "tray"), ("in", "oven"), ("at", "home")], []
    )
    dish = ObjectNode.of("plat\u00e9", [], [], [("contains", ["salt", "egg", "egg"])])
    small = network(("pour", [bowl, dish], [END]), ("mix", [END], [dish]))
    written = (
        '[3,[["bowl",["big","clean","red"],[["at","home"],["in","oven"],["on","tray"]],[]],'
        '["plat\\u00e9",[],[],[["contains",["egg","egg","salt"]]]],["end",[],[],[]]],'
        '["pour","mix"],[[0,1],[2]],[[2],[1]]]'
    )
    rates = {"pour": Fraction(1, 2), "mix": Fraction(3)}
    assert digests(small, {2, 0}, rates, {"cup", "bowl"}) == {
        "network": sha(written),
        "kitchen": sha("[0,2]"),
        "rates": sha('[["mix","3"],["pour","1/2"]]'),
        "utensils": sha('["bowl","cup"]'),
        "prices": sha("null"),
        "sources": sha("null"),
    }
    unit = FunctionalUnit("mix", (END,), (dish,))
    elsewhere = FunctionalUnit("mix", (END,), (END,))
    prices = UnitPrices(
        {"pour": Fraction(1, 2), "mix": Fraction(3)}, {unit: Fraction(0), elsewhere: Fraction(1)}
    )
    with_prices = '[[["mix","3"],["pour","1/2"]],[[1,"0"]]]'
    assert digests(small, (), None, (), prices)["prices"] == sha(with_prices)
    assert digests(network_at_level(small, 1), (), None, (), prices)["prices"] == sha(with_prices)
    assert digests(small, (), None, (), UnitPrices({}, {}))["prices"] == sha("[[],[]]")
    assert digests(small, (), None, ())["rates"] == sha("null")
    level_1 = network_at_level(small, 1)
    assert digests(level_1, (), {}, ())["network"] == sha(
        '[1,[["bowl",[],[],[]],["plat\\u00e9",[],[],[]],["end",[],[],[]]],'
        f'["pour","mix"],[[0,1],[2]],[[2],[1]],{written},[[0],[1]]]'
    )


def test_a_seal_is_the_digest_of_all_else_with_sorted_keys() -> None:
    assert verify.seal({"b": [1, "x"], "seal": "any", "a": None}) == sha('{"a":null,"b":[1,"x"]}')


# --- steps and other limits


def steps(monkeypatch: pytest.MonkeyPatch, needed: int, problem: Problem, **values: Any) -> None:
    """Hold a certificate against the fewest steps that it needs, and against one less."""
    monkeypatch.setattr(verify, "_STEPS_EACH", 0)
    monkeypatch.setattr(verify, "_STEPS", needed)
    accepted(problem, **values)
    monkeypatch.setattr(verify, "_STEPS", needed - 1)
    assert refusal(problem, **values) == f"to check it takes more than {needed - 1:,} steps"


def rated(*rates: str) -> Problem:
    """Make the end of the start, by a motion of each rate."""
    made = network(*((f"go {number}", [START], [END]) for number in range(len(rates))))
    known = {f"go {number}": Fraction(rate) for number, rate in enumerate(rates)}
    return Problem(made, frozenset({0}), (1,), known, frozenset())


def below(exponents: dict[str, str]) -> Content:
    """Claim a bound by success that is proved without weights, as it is not above nothing."""
    return {"claim": "bound", "objective": ["success"], "bound": [exponents]}


def test_steps_of_looks_and_short_numbers(monkeypatch: pytest.MonkeyPatch) -> None:
    # a leaf; the bound, taken from the sum of nothing
    steps(monkeypatch, 1 + 5, PLAIN, **BOUND)
    # the cut, a node that two units make; the tree's cost; the leaf; the weight, added to nothing, and where
    # the cut stands: its number, a goal, two members; their loads; the bound and its two sides
    optimum: Content = {**POURED, "cuts": [[END_ID]], "proof": ONE}
    steps(monkeypatch, 3 + 5 + 1 + 5 + 4 + 10 + 5 + 10, PLAIN, **optimum)
    # what a load leaves of a cost is two numbers for each of the members
    half = {"weights": [[0, ["1/2"]]]}
    steps(monkeypatch, 3 + 1 + 5 + 4 + 10 + 20 + 5 + 10, PLAIN, **BOUND, cuts=[[END_ID]], proof=half)
    # what is rounded up to 1 is one number for each unit and item, once
    rounded: Content = {"claim": "bound", "bound": ["1"], "cuts": [[END_ID]]}
    leaf = {"weights": [[0, ["1/2"]]], "multiples": {"units": "1"}}
    steps(monkeypatch, 3 + 1 + 5 + 4 + 10 + 20 + 30 + 5 + 10, PLAIN, **rounded, proof=leaf)
    # an item in a cut is one look, and one for the unit that makes it
    items: Content = {**BOUND, "objective": ["kitchen"], "cuts": [[START_ID, END_ID, MIDDLE_ID]]}
    steps(monkeypatch, 1 + 3 + 2 + 1 + 5 + 3 + 5 + 5 + 10, PLAIN, **items, proof=ONE)


def test_steps_of_branches(monkeypatch: pytest.MonkeyPatch) -> None:
    """With and without digging, baking is branched on, where pouring is forbidden."""
    bake = {"branch": {"unit": BAKE}, "without": {"hopeless": 0}, "using": {"weights": [[1, ["1"]]]}}
    dig = {"branch": {"unit": DIG}, "without": bake, "using": bake}
    values: Content = {**BOUND, **NO_POURING, "bound": ["2"], "cuts": [[END_ID], [MIDDLE_ID]], "proof": dig}
    rule = 10 * (4 + 6)  # units and nodes
    cuts = 3 + 2
    root = 1 + 0 + 1  # a look, those used, those left out
    using = 1 + 1 + 1
    without_bake = (1 + 1 + 2) + (1 + 1 + 1 + 2)  # a cut's number, its goal, those used, its members
    using_bake = (1 + 2 + 1) + 5 + (1 + 1 + 2 + 1) + 5 + 15 + 15  # what is used is paid for twice
    with_dig = using + without_bake + using_bake
    without = 1 + 0 + 2
    without_bake = (1 + 0 + 3) + (1 + 1 + 0 + 2)
    using_bake = (1 + 1 + 2) + 5 + (1 + 1 + 1 + 1) + 5 + 10 + 15
    without_dig = without + without_bake + using_bake
    steps(monkeypatch, rule + cuts + root + with_dig + without_dig, PLAIN, **values)


def test_steps_of_logarithms(monkeypatch: pytest.MonkeyPatch) -> None:
    """Each exponent is 5 and the square of its 4,000 bits and more by 512, each logarithm 5 ** 3, once."""
    e, log = 5 + 7**2, 5**3
    steps(monkeypatch, 1 + 5 + e + log, PLAIN, **below({"1/2": "-1"}))
    # an exponent of 0 and a rate of 1 take nothing
    steps(monkeypatch, 1 + 5, PLAIN, **below({"1/2": "0"}))
    tree: Content = {**below({}), "tree": [MIX, BAKE], "costs": ["3/4"]}
    steps(monkeypatch, 10 + 10 + e + log + 1, PLAIN, **tree)
    # mixing carries what it costs, and pouring less
    weight = {"weights": [[0, [{"3/4": "1"}]]]}
    values: Content = {**below({}), "cuts": [[END_ID, MIDDLE_ID]], "proof": weight}
    packed = (e + log) + 5 + 4 + 10 + (10 + 2 * e + log)
    steps(monkeypatch, 5 + 1 + packed + 5 + 5 + e, PLAIN, **values)
    # 4,000 bits and 94 of the numerator and one of the denominator are below 8 * 512
    steps(monkeypatch, 1 + 5 + e + log, PLAIN, **below({"1/2": str(-(2**93))}))
    steps(monkeypatch, 1 + 5 + 5 + 8**2 + log, PLAIN, **below({"1/2": str(-(2**94))}))
    # a rate with 33 bits in common takes 11 digits more
    near = str(1 - Fraction(1, 10**10))
    steps(monkeypatch, 1 + 5 + e + 6**3, rated(near), **below({near: "-1"}))


def test_steps_of_products(monkeypatch: pytest.MonkeyPatch) -> None:
    """Here 200 * 2 and 100 * 3 bits, whose root is 26: 700 * 26 / 64 is 284.4."""
    equal = below({"1/2": "-200", "1/4": "100"})
    steps(monkeypatch, 1 + 10 + 2 * 54 + 2 * 125 + 284, rated("1/2", "1/4"), **equal)


def test_steps_of_long_numbers(monkeypatch: pytest.MonkeyPatch) -> None:
    """A number of 1,536 bits over 1: the square of three times 512."""
    steps(monkeypatch, 1 + 5 + 3**2, PLAIN, **BOUND | {"bound": [str(-(2**1535))]})


def test_a_check_has_five_million_steps_and_more_for_a_large_network() -> None:
    """Rates with 420 nines and more, whose logarithms have 450 digits, which are 45 ** 3 steps each."""
    rates = [str(1 - Fraction(1, 10**nines)) for nines in range(420, 476)]
    said = "to check it takes more than 5,011,600 steps"  # for 56 units and two object nodes
    assert refusal(rated(*rates), **below(dict.fromkeys(rates, "-1"))) == said


def test_fractions_have_2_000_digits() -> None:
    assert accepted(PLAIN, **BOUND | {"bound": ["-" + "9" * 1999]}).claim == "bound"
    with pytest.raises(LimitError) as refused:
        accepted(PLAIN, **BOUND | {"bound": ["-" + "9" * 2000]})
    assert str(refused.value) == "a fraction has more than 2,000 digits"


def test_sums_of_fractions_have_40_000_bits() -> None:
    """Six exponents of 36,000 bits together, and 4,000 for their logarithms."""
    rates = ["1/2", "1/3", "1/4", "1/5", "1/6", "1/7"]
    bound = {rate: str(-(2**5998)) for rate in rates}  # of 5,999 bits, and 1 of the denominator
    assert accepted(rated(*rates), **below(bound)).claim == "bound"
    bound["1/7"] = str(-(2**5999))
    with pytest.raises(LimitError) as refused:
        accepted(rated(*rates), **below(bound))
    assert str(refused.value) == "its fractions add up to numbers that are too long"


def test_success_rates_have_13_000_bits() -> None:
    """Together, in the denominators of the rates."""
    once, twice = Fraction(1, 2**12_997), Fraction(1, 3)
    for last in (twice, twice / 2):
        made = network(("one", [START], [MIDDLE]), ("two", [MIDDLE], [END]))
        rates = {"one": once, "two": last}
        problem = Problem(made, frozenset({0}), (2,), rates, frozenset())
        values: Content = {**below({}), "tree": [0, 1], "costs": [str(once * last)]}
        if last == twice:
            assert accepted(problem, **values).costs == (once * last,)
            continue
        with pytest.raises(LimitError) as refused:
            accepted(problem, **values)
        assert str(refused.value) == "the success rate of the tree is too long a number to be written"


@pytest.mark.parametrize(
    ("written", "longer"),
    [
        (Fraction(2**13_000 - 1), Fraction(2**13_000)),
        (Fraction(1, 2**13_000 - 1), Fraction(1, 2**13_000)),
    ],
)
def test_costs_have_13_000_bits(written: Fraction, longer: Fraction) -> None:
    """In the numerator as in the denominator."""
    made = network(("one", [START], [END]))
    for price in (written, longer):
        prices = UnitPrices({"one": price}, {})
        problem = Problem(made, frozenset({0}), (1,), None, frozenset(), unit_prices=prices)
        claim: Content = {"claim": "bound", "objective": ["price"], "bound": ["0"]}
        values: Content = {**claim, "tree": [0], "costs": [str(price)]}
        if price == written:
            assert accepted(problem, **values).costs == (price,)
            continue
        with pytest.raises(LimitError) as refused:
            accepted(problem, **values)
        assert str(refused.value) == "what the tree costs is too long a number to be written"


# --- reading


def test_a_file_has_sixteen_million_letters(tmp_path: Path) -> None:
    text = "[]" + " " * 15_999_998
    file = tmp_path / "proof.json"
    file.write_text(text)
    assert load_certificate(file) == []
    text += " "
    file.write_text(text)
    with pytest.raises(LimitError) as refused:
        load_certificate(file)
    assert str(refused.value) == "it has more than 16,000,000 letters"
    with pytest.raises(LimitError, match="it has more than 16,000,000 letters or 1,000,000 brackets"):
        read_certificate(text)


def test_a_file_has_a_million_brackets() -> None:
    text = '"' + "[" * 600_000 + "{" * 400_000 + '"'
    assert len(read_certificate(text)) == 1_000_000
    with pytest.raises(LimitError) as refused:
        read_certificate(text + "[")
    assert str(refused.value) == "it has more than 16,000,000 letters or 1,000,000 brackets"


def test_what_is_no_json() -> None:
    for text in ("", "{", "[" * 100_000):
        with pytest.raises(RefusedError, match=r"^not JSON: "):
            read_certificate(text)
    with pytest.raises(RefusedError) as refused:
        read_certificate('{"a": 1, "b": 2, "a": 1}')
    assert str(refused.value) == "a key stands twice in one object"


def test_a_number_is_quoted_as_far_as_it_can_be_read() -> None:
    with pytest.raises(RefusedError) as refused:
        read_certificate("[1." + "0" * 60 + "]")
    said = "expected whole numbers, and fractions in quotes"
    assert str(refused.value) == f"found the number 1.{'0' * 48}, {said}"


# --- what rules of the user's own are said to leave


def claiming(*claims: list[list[int]], **more: Any) -> Content:
    """Give a rule with claims of units, sets that no tree has and lacks."""
    own = {"rule": OWN, "claims": [*claims], "constants": [], "files": [], "library": [], "limits": []}
    return {**own, **more}


def test_what_is_taken_on_trust_has_a_form_of_its_own() -> None:
    own = claiming()
    assert verify.trusted({"rules": [*forbid(["pour"]), own]}) == own
    assert verify.trusted({"rules": forbid(["pour"])}) is None
    assert verify.trusted({}) is None
    keys = "expected the keys rule, claims, constants, files, library, limits"
    assert refusal(PLAIN, **BOUND, rules=[claiming(more=1)]) == keys
    file = {"name": "mine.lp", "sha256": hashlib.sha256(b":- use(1).").hexdigest(), "text": ":- use(1)."}
    assert accepted(PLAIN, **BOUND, rules=[claiming(files=[file])]).claim == "bound"
    more = claiming(files=[{**file, "more": 1}])
    assert refusal(PLAIN, **BOUND, rules=[more]) == "expected the keys name, sha256, text"
    assert refusal(PLAIN, **BOUND, rules=[own, {"rule": "unknown"}]) == "a rule is unknown"
    for wrong, said in (
        (claiming([[99], []]), "expected ids of the network"),
        (claiming([[POUR, POUR], []]), "an id stands twice"),
        (claiming(constants=["b=1", "a=1"]), "expected names in order, each of them once"),
        (claiming(library=[1]), "expected names"),
        (claiming(files=[{**file, "name": 1}]), "expected names"),
        (claiming(files=[{**file, "text": 1}]), "expected names"),
        (claiming(limits=[[{"1": [99]}, 1]]), "expected ids of the network"),
        (claiming(limits=[[{"1": []}, 1]]), "expected ids in order"),
        (claiming(limits=[[["1"], 1]]), "expected an object"),
        (claiming(limits=[[{"0": [MIX]}, 1]]), "a limit counts what is no whole number above zero"),
        (claiming(limits=[[{"1/2": [MIX]}, 1]]), "a limit counts what is no whole number above zero"),
    ):
        assert refusal(PLAIN, **BOUND, rules=[wrong]) == said


def test_steps_of_claims(monkeypatch: pytest.MonkeyPatch) -> None:
    """A rule takes ten for each unit and node; the tree is held against it, and so is each leaf."""
    units, nodes = len(PLAIN.network), len(PLAIN.network.objects)
    claims = claiming([[MIX, BAKE], [POUR]], [[POUR, DIG], []])
    said = (1 + 2 + 1) + (1 + 2 + 0)
    proof = 10 * (units + nodes) + 1 + units + 5 * said + 5
    steps(monkeypatch, proof, PLAIN, **BOUND, rules=[claims])
    # one rule bars units; then what the tree costs, and that less the bound
    steps(monkeypatch, proof + units + 5 + 10, PLAIN, **BOUND, **POURED, rules=[claims])


def test_a_claim_is_about_all_units_of_one_set_and_none_of_another() -> None:
    baked: Content = {"tree": [MIX, BAKE], "costs": [2], **BOUND}
    assert accepted(PLAIN, **baked, rules=[claiming([[MIX], [BAKE]])]).tree == (MIX, BAKE)
    assert refusal(PLAIN, **baked, rules=[claiming([[MIX], [POUR]])]) == "the tree breaks a rule"
    assert refusal(PLAIN, **baked, rules=[claiming([[BAKE], []])]) == (
        f"the tree has unit {BAKE}, which a rule removes"
    )
    assert refusal(PLAIN, **baked, rules=[claiming([[], [POUR]])]) == "the tree lacks what a rule asks for"


def test_a_claim_is_about_what_units_come_to() -> None:
    """Mixing counts 2 and baking 1, of which there are 2 at most; pouring counts nothing."""
    two = claiming(limits=[[{"1": [BAKE], "2": [MIX]}, 2]])
    baked: Content = {"tree": [MIX, BAKE], "costs": [2], **BOUND}
    assert refusal(PLAIN, **baked, rules=[two]) == "the tree exceeds what a rule limits"
    assert accepted(PLAIN, **baked, rules=[claiming(limits=[[{"1": [BAKE], "2": [MIX]}, 3]])]).tree
    assert accepted(PLAIN, **POURED, rules=[two], cuts=[[END_ID]], proof=ONE).claim == "optimal"
    # without pouring there is no tree; the limit of the rule after the library's is the next but one
    rules = sorted([*forbid(["pour"]), two], key=verify.canonical)
    proof = {"weights": [[0, ["1"]], [1, ["2"]]], "limits": [[2, ["1"]]]}
    values: Content = {**NO_TREE, "rules": rules, "cuts": [[END_ID], [END_ID, MIDDLE_ID]]}
    assert accepted(PLAIN, **values, proof=proof).claim == "infeasible"
    assert refusal(PLAIN, **values, proof={**proof, "limits": [[1, ["1"]]]}) == (
        "a rule that limits nothing is given a weight"
    )


def test_after_a_broken_rule_the_other_branches_are_looked_at() -> None:
    using = {"branch": {"unit": BAKE}, "without": {"weights": []}, "using": {"broken": 0}}
    proof = {"branch": {"unit": MIX}, "without": {"weights": []}, "using": using}
    forged: Content = {"claim": "bound", "bound": ["5"], "rules": [claiming([[MIX, BAKE], []])]}
    assert refusal(PLAIN, **forged, proof=proof) == "the weights do not add up to enough"


def test_limits_and_what_stands_for_a_thing_that_is_used_once() -> None:
    """Of a cup that is filled and poured and a bowl that is washed and dried one may be used."""
    problem = Problem(
        network(
            ("fill", [START], [ObjectNode.of("cup", ["full"])]),
            ("pour", [ObjectNode.of("cup", ["full"])], [END]),
            ("wash", [END], [ObjectNode.of("bowl", ["wet"])]),
            ("dry", [ObjectNode.of("bowl", ["wet"])], [OTHER]),
        ),
        frozenset({0}),
        (4,),
        None,
        frozenset({"cup", "bowl"}),
    )
    cup, end, bowl, other, of_bowl, of_cup = 1, 2, 3, 4, 5, 6  # what units ask for that touch one
    rules = [{"rule": "at_most_utensils", "max_utensils": 1}]
    tree: Content = {"tree": [0, 1, 2, 3], "costs": [4]}
    assert refusal(problem, **tree, **BOUND, rules=rules) == "the tree exceeds what a rule limits"
    # each of the two things is needed, one is there, and neither costs anything
    cuts = [[cup, end, bowl, other, of_cup], [bowl, other, of_bowl]]
    proof = {"weights": [[0, ["1"]], [1, ["1"]]], "limits": [[0, ["1"]]]}
    none = accepted(problem, **NO_TREE, rules=rules, cuts=cuts, proof=proof)
    assert none.claim == "infeasible"
    two = [{"rule": "at_most_utensils", "max_utensils": 2}]
    assert refusal(problem, **NO_TREE, rules=two, cuts=cuts, proof=proof) == (
        "the weights do not add up to enough"
    )
    assert "carries more than it costs" in refusal(
        problem, **NO_TREE, rules=rules, cuts=cuts, proof={"weights": proof["weights"]}
    )
    # the same by branches: the step of each thing is used, as the units need it, and then there are two
    both = {"weights": [], "limits": [[0, ["1"]]]}
    steps = {
        "branch": {"step": 0},
        "without": {"hopeless": 1},
        "using": {"branch": {"step": 1}, "without": {"hopeless": 0}, "using": both},
    }
    assert accepted(problem, **NO_TREE, rules=rules, cuts=cuts, proof=steps).claim == "infeasible"
    assert refusal(problem, **NO_TREE, rules=two, cuts=cuts, proof=steps) == (
        "the weights do not add up to enough"
    )


def test_what_a_limit_does_not_speak_of_carries_what_it_costs() -> None:
    """One may be baked at most: what is baked may carry more, and what is poured no more than it costs."""
    rules = [{"rule": "at_most_motion", "limited_motion": "bake", "max_uses": 1}]
    no_pouring = sorted([*rules, *forbid(["pour"])], key=verify.canonical)
    limits = {"limits": [[0, ["1/2"]]]}
    proof = {"weights": [[0, ["1"]]], **limits}
    values: Content = {"claim": "bound", "rules": rules, "cuts": [[END_ID]]}
    assert accepted(PLAIN, **values, bound=["1/2"], proof=proof).claim == "bound"
    assert refusal(PLAIN, **values, bound=["1"], proof=proof) == "the weights do not add up to enough"
    more = {"weights": [[0, ["3/2"]]], **limits}
    assert refusal(PLAIN, **values, bound=["1/2"], proof=more) == "unit or item 0 carries more than it costs"
    for weight in ("0", "-1"):
        wrong = {**proof, "limits": [[0, [weight]]]}
        said = "a weight of a limit is not above zero"
        assert refusal(PLAIN, **values, bound=["0"], proof=wrong) == said
    baked = {**values, "rules": no_pouring, "proof": {**more, "limits": [[1, ["1/2"]]]}}
    assert accepted(PLAIN, **baked, bound=["1"]).claim == "bound"


def test_a_bound_is_rounded_up_to_what_all_costs_are_multiples_of() -> None:
    prices = {"pour": Fraction(1), "mix": Fraction(3, 2), "bake": Fraction(1, 2), "dig": Fraction(2)}
    priced = replace(PLAIN, unit_prices=UnitPrices(prices, {}))

    def claims(bound: list[Any], objective: list[str], weight: list[Any], **multiples: str) -> str:
        proof = {"weights": [[0, weight]], "multiples": multiples}
        values: Content = {"claim": "bound", "bound": bound, "objective": objective, "proof": proof}
        try:
            return check(handmade(priced, cuts=[[END_ID]], **values), priced).claim
        except RefusedError as refused:
            return str(refused)

    less, no_multiple = "the weights do not add up to enough", "a cost is not a multiple of what is stated"
    assert claims(["1"], ["units"], ["1/3"], units="1") == "bound"
    assert claims(["1/2"], ["units"], ["1/3"], units="1/2") == "bound"
    assert claims(["1"], ["units"], ["1/3"], units="1/2") == less
    assert claims(["2"], ["units"], ["1"], units="1") == less  # it is one already
    assert claims(["2"], ["units"], ["1/3"], units="2") == no_multiple
    assert claims(["1/2"], ["price"], ["1/3"], price="1/2") == "bound"
    assert claims(["1"], ["price"], ["1/3"], price="1") == no_multiple
    # by the first that is not a multiple, and what comes after it is 0
    two = ["units", "inputs"]
    assert claims(["1", "0"], two, ["1/3", "9"], units="1", inputs="1") == "bound"
    assert claims(["1", "1"], two, ["1/3", "9"], units="1", inputs="1") == less
    assert claims(["1", "1"], two, ["1", "1/3"], units="1", inputs="1") == "bound"
    assert claims(["1", "1"], two, ["1", "1/3"], inputs="1") == "bound"
    assert claims(["1", "1"], two, ["1", "1/3"], units="1") == less
    nothing = {"weights": [], "multiples": {"success": "1"}}
    rates: Content = {"claim": "bound", "bound": [{}], "objective": ["success"], "proof": nothing}
    assert refusal(PLAIN, **rates) == no_multiple
    # items cost 1 each, and no unit costs anything
    taken: Content = {"claim": "bound", "objective": ["kitchen"], "cuts": [[START_ID, END_ID, MIDDLE_ID]]}
    for bound, multiple, refused in (("1", "1", ""), ("2", "2", no_multiple), ("2", "1", less)):
        proof = {"weights": [[0, ["1/3"]]], "multiples": {"kitchen": multiple}}
        if refused:
            assert refusal(PLAIN, **taken, bound=[bound], proof=proof) == refused
        else:
            assert accepted(PLAIN, **taken, bound=[bound], proof=proof).claim == "bound"


def test_what_is_used_is_paid_for_beside_what_is_rounded_up() -> None:
    multiples = {"multiples": {"units": "1"}}
    using = {"weights": [[0, ["1/3"]]], **multiples}
    values: Content = {"claim": "bound", "cuts": [[MIDDLE_ID], [END_ID]], "rules": forbid(["pour"])}
    proof = {"branch": {"unit": BAKE}, "without": {"hopeless": 1}, "using": using}
    assert accepted(PLAIN, **values, bound=["2"], proof=proof).claim == "bound"
    assert refusal(PLAIN, **values, bound=["3"], proof=proof) == "the weights do not add up to enough"


def test_a_rule_hears_of_the_units_of_a_branch_and_not_of_its_items() -> None:
    rules = [{"rule": "before", "earlier_motion": "mix", "later_motion": "bake"}]
    leaf: Content = {"weights": []}
    for item in (START_ID, SALT_ID):
        proof = {"branch": {"item": item}, "without": leaf, "using": leaf}
        found = accepted(PLAIN, **BOUND | {"objective": ["kitchen"]}, rules=rules, proof=proof)
        assert found.claim == "bound"


def test_a_measure_that_no_objective_uses_is_not_taken_on_trust() -> None:
    text = "cost(mine,U,1) :- unit(U)."
    stated = {"rules": text, "sha256": hashlib.sha256(text.encode()).hexdigest(), "costs": {"0": [POUR]}}
    assert accepted(PLAIN, **BOUND, measures={"mine": stated}).trusted == ()
    used = accepted(PLAIN, **BOUND | {"objective": ["mine"]}, measures={"mine": stated}).trusted
    assert [(each.name, each.costs) for each in used] == [("mine", {})]


def test_a_claim_is_about_a_hundred_rules() -> None:
    motions = [f"motion {number:03}" for number in range(101)]
    assert len(accepted(PLAIN, **BOUND, rules=forbid(motions[1:])).rules) == 100
    with pytest.raises(LimitError, match="it has more than 100 rules"):
        accepted(PLAIN, **BOUND, rules=forbid(motions))
