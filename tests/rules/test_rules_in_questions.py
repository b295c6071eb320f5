"""Other questions under rules: what they find is the same whether rules are applied beforehand or not."""

import json
import random
import shutil
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

import foon_asp
from foon_asp.errors import UserError
from foon_asp.problem import Problem
from foon_asp.questions.ending import Ending
from foon_asp.resources import encodings_folder
from tests.conftest import ROOT, Cli, valid
from tests.hypergraph.test_reductions import posed
from tests.rules.test_restricted_answers import CLASSES, rules

KITCHEN = ROOT / "data" / "kitchen"
Rules = dict[str, Any]
Asked = Callable[[Problem, Rules], object]


def alternatives(problem: Problem, rules: Rules) -> object:
    found = foon_asp.alternatives(problem, "inputs", best=4, **rules)
    return found.complete, [tree.costs.inputs for tree in found.trees]


def optima(problem: Problem, rules: Rules) -> object:
    found = foon_asp.alternatives(problem, "units", **rules)
    return found.complete, {frozenset(tree.units) for tree in found.trees}


def pareto(problem: Problem, rules: Rules) -> object:
    found = foon_asp.pareto(problem, "units,inputs", **rules)
    return found.complete, [(point.costs.units, point.costs.inputs) for point in found.points]


def several_goals(problem: Problem, rules: Rules) -> object:
    others = [o for o in range(len(problem.network.objects)) if o not in problem.goals]
    found = foon_asp.solve(replace(problem, goals=(*problem.goals, others[0])), "inputs", **rules)
    assert isinstance(found.goals_alone, tuple)
    alone = [(each.status, each.costs and each.costs.inputs) for each in found.goals_alone]
    return [(found.status, found.costs and found.costs.inputs), *alone]


def regret(problem: Problem, rules: Rules) -> object:
    found = foon_asp.regret(problem, "inputs", units=range(len(problem.network)), **rules)
    [*losses] = sorted(
        (each.unit.id, each.status, each.costs and each.costs.inputs)
        for each in found.regrets
        if each.unit and each.costs
    )
    best = found.answer.costs
    return best and best.inputs, losses


def assist(problem: Problem, rules: Rules) -> object:
    better = dict.fromkeys(sorted(set(problem.network.motions))[:2], 1)
    found = foon_asp.assist(problem, person=better, **rules)
    return [(row.most, row.status, row.costs and row.costs.success) for row in found.rows]


QUESTIONS = [alternatives, optima, pareto, several_goals, regret, assist]
LIBRARY = [
    ("forbid_motion", "forbidden_motion", "motion"),
    ("forbid_object", "forbidden_object", "label"),
    ("forbid_ingredient", "forbidden_ingredient", "label"),
    ("least_rate", "least_rate", ["100000", "300000", "300001", "1000000"]),
    ("only_sources", "allowed_source", ['"random"', '"steps"', '"x"']),
    ("at_most_motion", "limited_motion", "motion"),
    ("at_most_units", "max_units", ["0", "1", "2", "3"]),
    ("at_most_utensils", "max_utensils", ["0", "1", "2"]),
    ("before", "earlier_motion", "motion"),
    ("require_motion", "required_motion", "motion"),
    ("require_object", "required_object", "label"),
    ("require_ingredient", "required_ingredient", "label"),
    ("require_intermediate", "required_intermediate", "label"),
]


def library(rng: random.Random, problem: Problem) -> tuple[list[str], list[str]]:
    """Draw one or two ready-made constraints, with constants that mean something here or nothing."""
    network = problem.network
    values = {
        "motion": [f'"{m}"' for m in sorted({*network.motions, "fly"})],
        "label": [f'"{n.label}"' for n in network.objects] + ['"moon"'],
    }
    names, constants = [], []
    for name, constant, of in rng.sample(LIBRARY, rng.choice((1, 1, 2))):
        names.append(name)
        constants.append(f"{constant}={rng.choice(values[of] if isinstance(of, str) else of)}")
        if name == "at_most_motion":
            constants.append(f"max_uses={rng.choice((0, 1, 2))}")
        if name == "before":
            constants.append(f"later_motion={rng.choice(values['motion'])}")
    return names, constants


def drawn(seed: int, folder: Path) -> tuple[Problem, Rules]:
    """Give a problem and rules for it, ready-made ones or others."""
    problem, _, _ = posed(seed)
    rng = random.Random(f"questions {seed}")
    if rng.random() < 0.5:
        names, constants = library(rng, problem)
        return problem, {"constraints": names, "constants": constants}
    file = folder / "mine.lp"
    text = "\n".join(rule.text for rule in rules(seed, len(problem.network), sorted(CLASSES)))
    if rng.random() < 0.3:
        text += "\n#defined _by_person/1."
        text += "\n:- use(U), _by_person(U), motion(U,M), #count { V : use(V), motion(V,M) } > 1."
        text += f"\n:- use(U), _by_person(U), output(U,{rng.randrange(len(problem.network.objects))})."
    file.write_text(f"{text}\n")
    return problem, {"constraints": [file]}


@pytest.mark.parametrize("ask", QUESTIONS)
@pytest.mark.parametrize("seeds", [range(4), pytest.param(range(4, 20), marks=pytest.mark.slow)])
def test_what_is_found_is_the_same(ask: Asked, seeds: range, tmp_path: Path) -> None:
    """Of encodings that are not ours, though the same, nothing is known before a search."""
    own = shutil.copytree(encodings_folder(), tmp_path / "own")
    with (own / "task_tree.lp").open("a") as file:
        file.write("% mine\n")
    for seed in seeds:
        problem, some = drawn(seed, tmp_path)
        if ask is assist and "constants" not in some:
            continue  # to other encodings a unit that a person does is one of another number
        assert ask(problem, some) == ask(problem, {**some, "encodings": own}), (seed, some)


def test_optima_keep_to_rules() -> None:
    problem = foon_asp.load().problem("ice", "macaroni")
    rules: Rules = {"constraints": ["forbid_motion", ":- #count { U : use(U) } > most. #const most = 9."]}
    rules["constants"] = {"forbidden_motion": "crush", "most": 8}
    found = foon_asp.solve_all_goals(problem, ["units", "inputs"], **rules)
    each = [(goal, objective) for goal in ("ice", "macaroni") for objective in ("units", "inputs")]
    answers = [foon_asp.solve(problem.vary(goal), objective, **rules) for goal, objective in each]
    assert [(o.status, o.costs) for o in found.answers] == [(a.status, a.costs) for a in answers]
    assert len({answer.status for answer in answers}) == 2


@pytest.mark.parametrize("name", ["motion", "object", "ingredient", "intermediate"])
def test_what_is_required_and_not_there_is_broken_once(name: str) -> None:
    rule = f"require_{name}:required_{name}=dough"
    assert foon_asp.solve(foon_asp.load().problem("ice"), soft={rule: 3}).penalty == 3


@pytest.mark.parametrize("stored", [False, True])
def test_which_rules_a_given_tree_breaks(tmp_path: Path, cli: Cli, stored: bool) -> None:
    """One about the tree, one that looks beyond it, and one that is kept; also where a store is read."""
    data = KITCHEN
    if stored:
        data = tmp_path / "kitchen.foon"
        assert cli("merge", "--data", KITCHEN, "--store", data).code == 0
    problem = foon_asp.load(data).problem("ice")
    tree = foon_asp.solve(problem).tree
    assert tree is not None
    twist = ':- use(U), motion(U,"twist").'
    beyond = ':- unit(U), not use(U), motion(U,"pour"), output(U,O), label(O,"ice").'
    fry = ':- use(U), motion(U,"fry").'
    checked = foon_asp.check(problem, tree, constraints=[twist, beyond, fry])
    assert isinstance(checked.breaks, tuple)
    assert [rule.text for rule in checked.breaks] == [twist, beyond]
    assert (checked.executes, checked.ending) == (True, Ending.NEGATIVE)
    assert repr(checked) == "<Checked: executes as listed (strict containers), but breaks 2 rules>"
    kept = foon_asp.check(problem, tree, constraints="forbid_motion", constants={"forbidden_motion": "fry"})
    assert (kept.breaks, kept.ending) == ((), Ending.DONE)
    assert kept.text().endswith("\nit keeps to the rules\n")
    assert repr(kept) == "<Checked: executes as listed (strict containers)>"
    assert "breaks" not in foon_asp.check(problem, tree).json()
    half = foon_asp.check(problem, tree.units[1:], constraints=twist)
    assert half.breaks is None
    assert "not looked at, since it does not execute" in half.text()
    with pytest.raises(UserError, match="without encodings"):
        foon_asp.check(problem, tree, encodings=tmp_path)


def test_check_and_draw_on_a_command_line(tmp_path: Path, cli: Cli) -> None:
    tree = tmp_path / "ice.txt"
    tree.write_text(cli("solve", "--goal", "ice", "--format", "foon").out, encoding="utf-8")
    rule = ("--rule", ':- use(U), motion(U,"twist"), not motion(U,"fry").')
    ran = cli("check", tree, "--goal", "ice", *rule, "--format", "json")
    assert ran.code == 1
    (broken,) = valid(json.loads(ran.out))["breaks"]
    assert (broken["file"], broken["text"]) == ("rule 1", rule[1])
    crush = ("--rule", ':- use(U), motion(U,"crush").')
    assert '"2. pound"' in cli("view", "--goal", "ice", *crush, "--format", "dot").out
    assert '"2. pound"' not in cli("view", "--goal", "ice", "--format", "dot").out
    for words in (("--unit", "3"), ("--tree", tree, "--goal", "ice"), ()):
        assert "--rule is for the best tree for a --goal" in cli("view", *words, *rule, "--format", "dot").err
    ran = cli("check", tree, "--goal", "ice", *rule, "--items", "used-up")
    assert ran.code == 1
    assert ran.out.startswith("executes as listed (strict containers, items used up)")
    assert "it breaks 1 rule:\n  rule 1:1\n" in ran.out
    with pytest.raises(UserError, match="nothing is solved here"):
        foon_asp.view(foon_asp.load(), constraints=rule[1])
