"""Other questions under rules: what they find is the same whether rules are applied beforehand or not."""

import json
import random
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

import foon_asp
from foon_asp.asp import Settings, solve
from foon_asp.errors import UserError
from foon_asp.problem import Objective, Problem, levels
from foon_asp.questions.result import Ending
from foon_asp.reduce import NONE
from tests.conftest import ROOT, Cli, valid
from tests.test_reductions import LISTS, posed
from tests.test_restricted_answers import CLASSES, rules

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


def menu(problem: Problem, rules: Rules) -> object:
    others = [o for o in range(len(problem.network.objects)) if o not in problem.goals]
    found = foon_asp.menu(replace(problem, goals=(*problem.goals, others[0])), "inputs", **rules)
    answers = (found.together, *found.separate)
    return [(answer.status, answer.costs and answer.costs.inputs) for answer in answers]


def regret(problem: Problem, rules: Rules) -> object:
    found = foon_asp.regret(problem, "inputs", units=range(len(problem.network)), **rules)
    [*losses] = sorted(
        (each.id, each.status, each.costs and each.costs.inputs)
        for each in found.regrets
        if each.part == "unit" and each.costs
    )
    best = found.outcome.costs
    return best and best.inputs, losses


def assist(problem: Problem, rules: Rules) -> object:
    better = dict.fromkeys(sorted(set(problem.network.motions))[:2], 1)
    found = foon_asp.assist(problem, person=better, **rules)
    return [(row.most, row.status, row.costs and row.costs.success) for row in found.rows]


QUESTIONS = [alternatives, optima, pareto, menu, regret, assist]
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


@pytest.mark.sampled(3)
@pytest.mark.parametrize("ask", QUESTIONS)
@pytest.mark.parametrize("seeds", [range(4), pytest.param(range(4, 80), marks=pytest.mark.slow)])
def test_what_is_found_is_the_same(
    ask: Asked, seeds: range, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for seed in seeds:
        problem, some = drawn(seed, tmp_path)
        ours = ask(problem, some)
        with monkeypatch.context() as patch:
            patch.setattr("foon_asp.asp.prepared._applied", lambda first, _: first)
            plain = ask(problem, some)
        assert ours == plain, (seed, some)


@pytest.mark.parametrize("seeds", [range(10), pytest.param(range(10, 600), marks=pytest.mark.slow)])
def test_ready_made_constraints_have_the_answers_of_the_plain_program(seeds: range) -> None:
    for seed in seeds:
        problem, _, _ = posed(seed)
        names, constants = library(random.Random(f"library {seed}"), problem)
        objectives = tuple(map(Objective, LISTS[seed % len(LISTS)]))
        settings = Settings(tuple(map(Path, names)), constants=tuple(constants))
        ours = solve(problem, objectives, settings)
        for others in ({"reductions": NONE}, {"encodings": Path("by_need")}):
            plain = solve(problem, objectives, settings._replace(**others))
            if "encodings" in others and not _by_need(names):
                continue
            assert ours.status is plain.status, (seed, settings, others)
            if ours.costs is not None and plain.costs is not None:
                by = levels(objectives)
                assert ours.costs.key(by) == plain.costs.key(by), (seed, settings, others)
                assert ours.bounds == plain.bounds


def _by_need(names: list[str]) -> bool:
    """Whether a program whose trees have no spare units has the same optimum."""
    return not any(name.startswith("require") for name in names)


def test_optima_keep_to_rules() -> None:
    problem = foon_asp.load().problem("ice", "macaroni")
    rules: Rules = {"constraints": ["forbid_motion", ":- #count { U : use(U) } > most. #const most = 9."]}
    rules["constants"] = {"forbidden_motion": "crush", "most": 8}
    found = foon_asp.optima(problem, ["units", "inputs"], **rules)
    each = [(goal, objective) for goal in ("ice", "macaroni") for objective in ("units", "inputs")]
    answers = [foon_asp.solve(problem.vary(goal), objective, **rules) for goal, objective in each]
    assert [(o.status, o.costs) for o in found.outcomes] == [(a.status, a.costs) for a in answers]
    assert len({answer.status for answer in answers}) == 2


@pytest.mark.parametrize("name", ["motion", "object", "ingredient", "intermediate"])
def test_what_is_required_and_not_there_is_broken_once(name: str) -> None:
    rule = f"require_{name}:required_{name}=dough"
    assert foon_asp.solve_soft(foon_asp.load().problem("ice"), soft={rule: 3}).penalty == 3


@pytest.mark.parametrize("stored", [False, True])
def test_which_rules_a_given_tree_breaks(tmp_path: Path, cli: Cli, stored: bool) -> None:
    """One about the tree, one that looks beyond it, and one that is kept; also where a store is read."""
    data = KITCHEN
    if stored:
        data = tmp_path / "kitchen.foon"
        assert cli("import", "--data", KITCHEN, "--store", data).code == 0
    problem = foon_asp.load(data).problem("ice")
    tree = foon_asp.solve(problem).tree
    assert tree is not None
    twist = ':- use(U), motion(U,"twist").'
    beyond = ':- unit(U), not use(U), motion(U,"pour"), output(U,O), label(O,"ice").'
    fry = ':- use(U), motion(U,"fry").'
    checked = foon_asp.check(problem, tree, constraints=[twist, beyond, fry])
    assert checked.breaks is not None
    assert [rule.text for rule in checked.breaks] == [twist, beyond]
    assert (checked.executes, checked.ending) == (True, Ending.NEGATIVE)
    assert repr(checked) == "<Checked: executes as listed (strict containers), but breaks 2 rules>"
    kept = foon_asp.check(problem, tree, constraints="forbid_motion", constants={"forbidden_motion": "fry"})
    assert (kept.breaks, kept.ending) == ((), Ending.DONE)
    assert kept.text().endswith("\nit keeps to the rules\n")
    assert repr(kept) == "<Checked: executes as listed (strict containers)>"
    assert foon_asp.check(problem, tree).breaks is None
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
    assert '"2. pound"' in cli("draw", "--goal", "ice", *crush).out
    assert '"2. pound"' not in cli("draw", "--goal", "ice").out
    for words in (("--unit", "3"), ("--tree", tree, "--goal", "ice"), ()):
        assert "--rule is for the best tree for a --goal" in cli("draw", *words, *rule).err
    assert "no encoding in use has the constant 'x'" in cli("check", tree, "--goal", "ice", "-c", "x=1").err
    ran = cli("check", tree, "--goal", "ice", *rule, "--items", "used-up")
    assert ran.code == 1
    assert ran.out.startswith("runs as listed (strict containers, items used up)")
    assert "it breaks 1 rule:\n  rule 1:1\n" in ran.out
    with pytest.raises(UserError, match="nothing is solved here"):
        foon_asp.draw(foon_asp.load(), constraints=rule[1])
