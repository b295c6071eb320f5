"""The questions in Python: the same answers as on the command line, problems that vary, results that show."""

import base64
import html
import json
import os
import pickle
import random
import warnings
import xml.etree.ElementTree as ET
from collections.abc import Callable
from dataclasses import FrozenInstanceError, replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

import foon_asp
from foon_asp import Foon, FoonWarning, Problem, UserError
from foon_asp.engines import DisagreementError, EngineAnswer
from foon_asp.problem import Problem as PlainProblem
from foon_asp.questions.index import INDEX
from foon_asp.report import picture
from foon_asp.resources import bundled_kitchen
from foon_asp.store.import_files import import_files
from foon_asp.store.store import Store
from foon_asp.text.data_folder import find_data
from tests.conftest import CORPUS, Cli, Ran
from tests.random_problems import random_problem

pytestmark = pytest.mark.sampled(4)  # by default some cases of each test: there are many

KITCHEN = bundled_kitchen()


@pytest.fixture(scope="module")
def store(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Give a store of the bundled kitchen."""
    file = tmp_path_factory.mktemp("store") / "kitchen.foon"
    import_files(find_data(KITCHEN), file)
    return file


@pytest.fixture(scope="module")
def foon() -> Foon:
    return foon_asp.load()


@pytest.fixture(params=["text", pytest.param("store", marks=pytest.mark.slow)])
def source(request: pytest.FixtureRequest, store: Path) -> Path:
    """Give the bundled kitchen as a folder, and as a store."""
    return KITCHEN if request.param == "text" else store


def timeless(value: Any) -> Any:
    """Leave out how long things took and what the trees are called."""
    if isinstance(value, dict):
        return {key: timeless(each) for key, each in value.items() if key not in {"seconds", "name"}}
    return [timeless(each) for each in value] if isinstance(value, list) else value


def data_words(source: Path) -> list[str | Path]:
    return ["--data" if source.is_dir() else "--network", source]


Ask = Callable[[Problem], Any]
CONSTANT = ["-c", "forbidden_motion=crush"]
FORBID_AND_REQUIRE = ["clash", "--constraint", "forbid_motion", "--constraint", "require_motion"]
CRUSH: dict[str, Any] = {"constants": {"forbidden_motion": "crush"}}

QUESTIONS: dict[str, tuple[list[str], list[str], str, Ask]] = {
    "solve": (["solve"], ["ice"], "strict", foon_asp.solve),
    "solve by two": (
        ["solve", "--objective", "success,inputs"],
        ["greek salad"],
        "implied",
        lambda p: foon_asp.solve(p, ["success", foon_asp.Objective.INPUTS]),
    ),
    "solve for two": (["solve", "--level", "2"], ["ice", "macaroni"], "strict", foon_asp.solve),
    "solve under a constraint": (
        ["solve", "--constraint", "forbid_motion", *CONSTANT],
        ["ice"],
        "strict",
        lambda p: foon_asp.solve(p, constraints="forbid_motion", **CRUSH),
    ),
    "solve with other encodings": (
        ["solve", "--encodings", "by_need", "--reduce", "none"],
        ["macaroni"],
        "strict",
        lambda p: foon_asp.solve(p, encodings="by_need", reductions="none"),
    ),
    "no tree": (["solve"], ["apple pie"], "strict", foon_asp.solve),
    "soft": (
        ["solve", "--soft", "forbid_motion=3", *CONSTANT],
        ["ice"],
        "strict",
        lambda p: foon_asp.solve_soft(p, soft={"forbid_motion": 3}, **CRUSH),
    ),
    "why not": (["why-not"], ["apple pie"], "strict", foon_asp.why_not),
    "why not, with a tree": (["why-not"], ["ice"], "implied", foon_asp.why_not),
    "why not, where rules are the reason": (
        ["why-not", *FORBID_AND_REQUIRE[1:], *CONSTANT, "-c", "required_motion=crush"],
        ["ice"],
        "strict",
        lambda p: foon_asp.why_not(
            p,
            constraints=["forbid_motion", "require_motion"],
            constants={"forbidden_motion": "crush", "required_motion": "crush"},
        ),
    ),
    "shopping list": (["shopping-list"], ["hot cocoa"], "strict", foon_asp.shopping_list),
    "one shopping list": (
        ["shopping-list", "--lists", "1", "--objective", "success"],
        ["apple pie"],
        "implied",
        lambda p: foon_asp.shopping_list(p, "success", lists=1),
    ),
    "clash": (
        [*FORBID_AND_REQUIRE, *CONSTANT, "-c", "required_motion=crush", "--weight", "forbid_motion=2"],
        ["ice"],
        "strict",
        lambda p: foon_asp.clash(
            p,
            constraints=["forbid_motion", Path("require_motion")],
            constants={"forbidden_motion": "crush", "required_motion": "crush"},
            weights={"forbid_motion": 2},
        ),
    ),
    "alternatives": (["alternatives"], ["greek salad"], "strict", foon_asp.alternatives),
    "the best": (
        ["alternatives", "--best", "3", "--objective", "inputs"],
        ["ice"],
        "strict",
        lambda p: foon_asp.alternatives(p, "inputs", best=3),
    ),
    "the most different": (
        ["alternatives", "--different", "2", "--within", "50"],
        ["ice"],
        "strict",
        lambda p: foon_asp.alternatives(p, different=2, within=50),
    ),
    "regret": (
        ["regret", "--objective", "success", "--unit", "3"],
        ["ice"],
        "strict",
        lambda p: foon_asp.regret(p, "success", units=[3]),
    ),
    "sensitivity": (["sensitivity"], ["ice"], "strict", foon_asp.sensitivity),
    "menu": (["menu"], ["ice", "tea"], "strict", foon_asp.menu),
    "assist": (["assist"], ["macaroni"], "implied", foon_asp.assist),
    "assist with so many": (
        ["assist", "--assist", "1"],
        ["ice"],
        "strict",
        lambda p: foon_asp.assist(p, 1),
    ),
    "assist, and a success to reach": (
        ["assist", "--reach", "0.95", "--constraint", "forbid_motion", *CONSTANT],
        ["ice"],
        "strict",
        lambda p: foon_asp.assist(p, reach=0.95, constraints="forbid_motion", **CRUSH),
    ),
    "pareto": (["pareto"], ["whipped cream"], "implied", foon_asp.pareto),
    "pareto under a constraint": (
        ["pareto", "--objective", "units,kitchen", "--constraint", "forbid_motion", *CONSTANT],
        ["ice", "tea"],
        "strict",
        lambda p: foon_asp.pareto(p, ["units", "kitchen"], constraints="forbid_motion", **CRUSH),
    ),
    "bfs": (["search", "bfs"], ["macaroni"], "implied", lambda p: foon_asp.retrieve(p, "bfs")),
    "ids": (["search", "ids"], ["greek salad"], "strict", lambda p: foon_asp.retrieve(p, "ids")),
    "greedy, the last": (
        ["search", "greedy-inputs", "--ties", "last", "--count", "nodes"],
        ["macaroni"],
        "strict",
        lambda p: foon_asp.retrieve(p, "greedy-inputs", ties="last", count="nodes"),
    ),
    "compare": (["compare"], ["ice", "macaroni"], "strict", foon_asp.compare_searches),
    "compare one": (
        ["compare", "--search", "dfs"],
        ["tea"],
        "implied",
        lambda p: foon_asp.compare_searches(p, ["dfs"]),
    ),
}


@pytest.mark.slow
@pytest.mark.parametrize("question", QUESTIONS)
@pytest.mark.sampled(12)
def test_the_answer_is_that_of_the_command_line(question: str, source: Path, cli: Cli) -> None:
    words, goals, containers, ask = QUESTIONS[question]
    named = [word for goal in goals for word in ("--goal", goal)]
    level = 2 if "--level" in words else 3
    given: list[str | Path] = [*words, *named, "--containers", containers, *data_words(source)]
    answer = ask(foon_asp.load(source, level=level).problem(*goals, containers=containers))
    assert timeless(answer.json()) == timeless(cli(*given, "--format", "json").json)
    shown = cli(*given, *(["--format", "markdown"] if words[0] == "compare" else []))
    if words[0] in INDEX:
        assert shown.out == f"{answer}\n"
        return
    # on the command line, advice on what to ask next comes behind
    assert shown.out.startswith(f"{answer}\n") or question.startswith("no tree")
    assert str(answer).split("\n")[:2] == shown.out.split("\n")[:2]


def test_optima_of_several_goals(source: Path, cli: Cli) -> None:
    words = ["--objective", "inputs,success", "--objective", "kitchen", "--containers", "implied"]
    given = ["optima", "--goal", "ice", "--goal", "tea", *words, *data_words(source)]
    problem = foon_asp.load(source).problem("ice", "tea", containers="implied")
    best = foon_asp.optima(problem, ["inputs,success", "kitchen"])
    assert [outcome.problem.goal_nodes for outcome in best.outcomes] == [
        (goal,) for goal in problem.goal_nodes for _ in "ab"
    ]
    assert timeless(best.json()) == timeless(cli(*given, "--format", "json").json)

    def lines(text: str) -> list[list[str]]:
        return [[word for word in line.split() if "." not in word] for line in text.split("\n")]

    assert lines(str(best)) == lines(cli(*given).out.rstrip())
    assert [str(outcome) for outcome in foon_asp.optima(problem, "kitchen").outcomes] == [
        str(foon_asp.solve(problem.vary(name), "kitchen")) for name in ("ice", "tea")
    ]


@pytest.mark.slow
@pytest.mark.parametrize(("containers", "objective"), [("strict", "success,kitchen"), ("implied", "inputs")])
def test_every_goal_is_answered_as_on_the_command_line(
    containers: str, objective: str, foon: Foon, cli: Cli
) -> None:
    for goal in foon.goals:
        words = ("--goal", f"{goal};", "--containers", containers, "--objective", objective)
        shown = cli("solve", *words, "--format", "json").json
        problem = foon.problem(goal, containers=containers)
        assert timeless(foon_asp.solve(problem, objective).json()) == timeless(shown)


@pytest.mark.slow
def test_prices_from_a_file_and_by_name(foon: Foon, tmp_path: Path) -> None:
    problem = foon.problem("hot cocoa", "apple pie")
    prices: dict[str, Any] = {
        "cocoa tin; contains {cocoa powder}": "4.50",
        "pie crust; chilled": 1.5,
        "pie crust; rolled": 3,
    }
    file = tmp_path / "prices.txt"
    file.write_text("".join(f"{name}\t{price}\n" for name, price in prices.items()))
    by_name = foon_asp.shopping_list(problem, prices=prices)
    assert timeless(by_name.json()) == timeless(foon_asp.shopping_list(problem, prices=file).json())
    assert [str(node) for node in by_name.items] == [*prices][:2]
    assert by_name.lists[0].price == 6
    with pytest.warns(FoonWarning, match="no node for sale has this label: unicorn"):
        foon_asp.shopping_list(problem, prices={**prices, "unicorn": 1})


def test_rates_of_single_units_stay_when_a_problem_varies(foon: Foon) -> None:
    problem = foon.problem("ice")
    units = foon_asp.solve(problem).units
    assert units is not None
    sure = replace(problem, own_rates=dict.fromkeys(units, Fraction(1)))
    varied = [sure.vary(containers="implied"), sure.vary(goals="tea")]
    found = [foon_asp.solve(each, "success").costs for each in varied]
    assert [costs is not None and costs.success == 1 for costs in found] == [True, False]


def test_help_takes_rates_by_motion_and_from_a_file(foon: Foon, tmp_path: Path) -> None:
    problem = foon.problem("ice")
    file = tmp_path / "person.txt"
    file.write_text("crush\t0.95\n")
    by_motion = foon_asp.assist(problem, person={"crush": "0.95"})
    assert by_motion.json() == foon_asp.assist(problem, person=file).json()
    assert by_motion.rows[1].success == by_motion.greatest
    assert [len(tree or ()) for tree in by_motion.task_trees] == [
        len(row.units or ()) for row in by_motion.rows
    ]
    with pytest.warns(FoonWarning, match="the motion 'fly' has no rate for the robot"):
        foon_asp.assist(problem, person={"fly": 1})
    with pytest.raises(UserError, match="found 0 for the success to reach, expected a number above 0"):
        foon_asp.assist(problem, reach=0)


@pytest.mark.slow
def test_the_chart_of_a_front(foon: Foon, tmp_path: Path) -> None:
    front = foon_asp.pareto(foon.problem("macaroni"))
    assert [tree.units for tree in front.task_trees] == [
        foon.problem("macaroni").tree(point.units).units for point in front.points
    ]
    front.write_chart(tmp_path / "front.svg")
    assert ET.parse(tmp_path / "front.svg").getroot().tag.endswith("svg")
    with pytest.raises(UserError, match="no point to draw"):
        foon_asp.pareto(foon.problem("apple pie")).write_chart(tmp_path / "none.svg")


def saved(ran: Ran, file: Path) -> Path:
    file.write_text(ran.out, encoding="utf-8")
    return file


def test_trees_in_files_are_checked_and_compared(source: Path, cli: Cli, tmp_path: Path) -> None:
    words = ["--goal", "macaroni", *data_words(source)]
    file = saved(cli("search", "bfs", *words, "--format", "foon"), tmp_path / "tree.txt")
    answer_file = saved(cli("solve", *words, "--format", "json"), tmp_path / "answer.json")
    problem = foon_asp.load(source).problem("macaroni")
    tree = foon_asp.Tree.read(problem, file)
    checked = foon_asp.check(problem, file)
    assert checked.json() == cli("check", file, *words, "--format", "json").json
    assert f"{checked}\n" == cli("check", file, *words).out
    assert checked.executes
    assert checked.in_order is not None
    assert foon_asp.check(problem, checked.in_order).simulation.verdict == "executes as listed"
    best = foon_asp.solve(problem)
    found = foon_asp.diff(tree, best)
    assert timeless(found.json()) == timeless(
        cli("diff", file, "solve " + " ".join(map(str, words)), *words, "--format", "json").json
    )
    assert {unit.motion for unit in found.only_right} == {"tilt"}
    assert foon_asp.Tree.read(problem, answer_file) == best.tree
    assert foon_asp.diff(best, foon_asp.Tree.read(problem, answer_file)).partings == ()


@pytest.mark.slow
def test_a_tree_with_units_of_no_network(source: Path) -> None:
    problem = foon_asp.load(source).problem("ice")
    answer = foon_asp.solve(problem)
    assert answer.tree is not None
    first, *others = answer.tree
    strange = foon_asp.FunctionalUnit.of("conjure", first.inputs, [foon_asp.parse_node("smoke")])
    checked = foon_asp.check(problem, [first, strange, *others])
    assert checked.executes
    assert checked.json()["not_in_network"] == [2]
    assert foon_asp.diff(answer, checked.tree).only_right == (strange,)
    assert "conjure" in checked.svg()
    without = foon_asp.check(problem, others)
    assert not without.executes
    assert without.in_order is None


@pytest.mark.slow
def test_other_engines(source: Path, cli: Cli, monkeypatch: pytest.MonkeyPatch) -> None:
    foon = foon_asp.load(source)
    rules = {"constraints": ["at_most_utensils"], "constants": {"max_utensils": 3}}
    checked = foon_asp.cross_check(foon.problem("tea"), "success", **rules)  # type: ignore[arg-type]
    clingo, *others = checked.checks
    assert (clingo.engine, clingo.objectives, clingo.reason) == ("clingo", ("success", "units"), None)
    assert all(other.reason for other in others)
    assert "cross-check: clingo agrees by success, units (" in str(checked)
    words = (
        "--constraint",
        "at_most_utensils",
        "-c",
        "max_utensils=3",
        "--objective",
        "success",
        "--cross-check",
    )
    shown = cli("solve", "--goal", "tea", *data_words(source), *words, "--format", "json").json
    assert timeless(checked.json()) == timeless(shown)
    soft = foon_asp.cross_check(
        foon.problem("ice"), soft={"forbid_motion": 3}, constants={"forbidden_motion": "crush"}
    )
    assert isinstance(soft.answer, foon_asp.SoftAnswer)
    assert soft.checks[0].reason is None
    assert "cross-check: clingo agrees by penalty, units (" in str(soft)
    assert soft.json()["cross_check"][0]["agrees_by"] == ["units"]

    def disagrees(*args: object) -> None:
        raise DisagreementError("no", EngineAnswer("clingo", (), None, True))

    monkeypatch.setattr("foon_asp.engines.bare_clingo.check_with_bare_clingo", disagrees)
    with pytest.raises(foon_asp.BugError, match="no"):
        foon_asp.cross_check(foon.problem("tea"))


@pytest.mark.parametrize("goal", ["ice", "apple pie"])
def test_an_answer_is_foon_text_as_on_the_command_line(goal: str, foon: Foon, cli: Cli) -> None:
    ran = cli("solve", "--goal", goal, "--format", "foon")
    answer = foon_asp.solve(foon.problem(goal))
    assert answer.foon() == ran.out
    assert answer.remark("foon") == ran.err.rstrip("\n")
    assert bool(ran.out) == (ran.err == "") == (goal == "ice")


def test_a_certified_answer_is_said_as_on_the_command_line(foon: Foon, cli: Cli, tmp_path: Path) -> None:
    file = tmp_path / "proof.json"
    said = cli("solve", "--goal", "apple pie", "--certificate", file).out
    certified = foon_asp.certify(foon.problem("apple pie"))
    assert certified.text() == said.replace(str(file), "in memory")
    assert certified.certificate is not None
    assert certified.certificate.text() == file.read_text()


def test_certificates(source: Path, cli: Cli, tmp_path: Path) -> None:
    foon = foon_asp.load(source)
    found = foon_asp.certify(foon.problem("ice"), "success")
    assert found.certificate is not None
    assert found.certificate.claim == "optimal"
    assert found.answer.proof == "certificate"
    assert "proof: certificate" in str(found)
    file = tmp_path / "proof.json"
    file.write_text(found.certificate.text(), encoding="utf-8")
    by_file = foon_asp.verify(foon, file)
    assert by_file == foon_asp.verify(foon.problem("tea"), found.certificate)
    shown = cli("verify", file, *data_words(source), "--format", "json").json
    assert by_file.json() == shown
    file.write_text(found.certificate.text().replace('"optimal"', '"bound"'), encoding="utf-8")
    with pytest.raises(foon_asp.RefusedError, match="seal"):
        foon_asp.verify(foon, file)
    with pytest.raises(foon_asp.RefusedError, match="kitchen"):
        foon_asp.verify(foon.vary(without="knife"), found.certificate)
    with pytest.raises(UserError, match="cannot be read"):
        foon_asp.verify(foon, tmp_path / "none.json")


def answers(problem: Problem) -> list[Any]:
    """Give what a problem has for answers, whatever it is posed of."""
    best = foon_asp.solve(problem, "success")
    reasons = foon_asp.why_not(problem)
    return [timeless(best.json()), timeless(reasons.json()), foon_asp.retrieve(problem, "ids").json()]


@pytest.mark.parametrize("goal", ["ice", "macaroni", "whipped cream", "apple pie"])
def test_a_varied_problem_is_one_that_is_asked_anew(goal: str, source: Path, tmp_path: Path) -> None:
    foon = foon_asp.load(source)
    start = foon.problem("tea")
    other = start.vary(goals=goal, containers="implied")
    assert answers(other) == answers(foon_asp.load(source).problem(goal, containers="implied"))
    assert answers(other.vary(containers="strict")) == answers(foon.problem(goal))
    both = other.vary(goals=["ice", "tea"], containers="strict")
    assert answers(both) == answers(foon.problem("ice", "tea"))

    entries = json.loads((KITCHEN / "kitchen.json").read_text())
    fewer = tmp_path / "kitchen.json"
    fewer.write_text(json.dumps([entry for entry in entries if entry["label"] != "drinking glass"]))
    less = foon_asp.load(source, kitchen=fewer)
    assert {str(node) for node in less.kitchen} < {str(node) for node in foon.kitchen}
    varied = foon.problem(goal).vary(without="drinking glass")
    assert Foon.of(varied).kitchen == less.kitchen
    assert answers(varied) == answers(less.problem(goal))
    gone = [node for node in foon.kitchen if node.label == "drinking glass"]
    assert answers(varied.vary(adding=gone)) == answers(foon.problem(goal))
    assert answers(foon.problem(goal).vary(kitchen=fewer)) == answers(less.problem(goal))
    assert answers(foon.problem(goal).vary(kitchen=less.kitchen)) == answers(less.problem(goal))
    # a name in full stands for one item alone
    assert len(foon.vary(without=str(gone[0])).kitchen) == len(foon.kitchen) - 1


def test_varied_rates(source: Path, tmp_path: Path) -> None:
    foon = foon_asp.load(source)
    table = (KITCHEN / "motion.txt").read_text()
    (line,) = [line for line in table.split("\n") if line.startswith("crush\t")]
    (tmp_path / "motion.txt").write_text(table.replace(line, "crush\t0.125"))
    anew = foon_asp.load(source, rates=tmp_path / "motion.txt").problem("ice")
    for rate in ("0.125", 0.125, Fraction(1, 8)):
        assert answers(foon.problem("ice").vary(rates={"crush": rate})) == answers(anew)
    assert foon.rates is not None
    assert foon.rates["crush"] == Fraction(line.split("\t")[1])


def test_the_kitchen_of_an_answer_is_that_of_its_problem(source: Path) -> None:
    shopping = foon_asp.shopping_list(foon_asp.load(source).problem("hot cocoa"))
    assert shopping.outcome is not None
    stocked = shopping.outcome.problem
    assert foon_asp.solve(stocked.vary(containers="implied")).status == "optimal"
    assert foon_asp.solve(stocked.vary(without=shopping.items)).status == "infeasible"


def test_varying_reads_nothing_and_indexes_nothing(
    foon: Foon, store: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    problem = foon.problem("macaroni", containers="implied")
    needs, network = problem.needs, problem.network
    reading = Path.read_bytes

    def encodings_only(path: Path) -> bytes:
        return reading(path) if path.suffix == ".lp" else pytest.fail(f"{path} is read")

    foon_asp.solve(problem)  # looks up the digests of our encodings
    monkeypatch.setattr(Path, "read_bytes", encodings_only)
    monkeypatch.setattr(Path, "read_text", lambda *_: pytest.fail("a file is read"))
    fewer = problem.vary(goals="ice", without="knife")
    assert fewer.network is network
    assert fewer.needs is needs
    assert fewer.vary(containers="strict").needs is network.inputs
    monkeypatch.setattr(Store, "whole", lambda *_: pytest.fail("the whole store is read"))
    stored = foon_asp.load(store).problem("macaroni", containers="implied")
    part = stored.vary(goals="ice", containers="strict", without="knife", rates={"pour": 1})
    assert len(part.network) < len(network)
    assert foon_asp.solve(part).costs == foon_asp.solve(foon.problem("ice")).costs


def files_held_open(file: Path) -> int:
    """Count the open files of this process that are this one."""
    opened = (os.path.realpath(f"/proc/self/fd/{number}") for number in os.listdir("/proc/self/fd"))
    return sum(Path(name) == file.resolve() for name in opened)


@pytest.mark.skipif(not Path("/proc/self/fd").is_dir(), reason="the system does not say what is open")
def test_the_store_behind_a_foon_is_closed(store: Path) -> None:
    before = files_held_open(store)
    with foon_asp.load(store) as opened:
        assert files_held_open(store) == before + 1
        varied = opened.vary(without="knife")
        problem = varied.problem("ice")
    assert files_held_open(store) == before
    assert foon_asp.solve(problem).status == "optimal"  # what was read stays
    with pytest.raises(UserError, match=r"kitchen\.foon: the store was closed; open it again"):
        varied.problem("macaroni")
    # without `with`, when nothing needs it any more, which a problem that can be varied does
    loaded = foon_asp.load(store)
    problem = loaded.problem("ice")
    del loaded
    assert files_held_open(store) == before + 1
    assert problem.vary(goals="macaroni").goals
    del problem
    assert files_held_open(store) == before
    assert foon_asp.load(store, level=2).network
    assert files_held_open(store) == before


def test_data_that_were_read_whole_are_there_after_the_end_of_with() -> None:
    with foon_asp.load() as loaded:
        pass
    assert foon_asp.solve(loaded.problem("ice")).status == "optimal"


def test_a_problem_put_together_by_hand() -> None:
    plain = random_problem(3, foon_asp.ContainerRule.STRICT)
    problem = Problem(plain.network, plain.kitchen, plain.goals, plain.rates, plain.utensils)
    assert foon_asp.solve(problem).units == foon_asp.solve(plain).units
    assert foon_asp.solve(plain).tree == foon_asp.solve(problem).tree
    with pytest.raises(UserError, match="put together by hand"):
        problem.vary(containers="implied")
    foon = Foon.of(problem)
    implied = foon.problem(*problem.goal_nodes).vary(containers="implied", without=foon.kitchen[:1])
    assert implied.kitchen == frozenset(sorted(plain.kitchen)[1:])
    assert implied.containers == "implied"
    assert implied.network is plain.network


@pytest.mark.parametrize("seed", range(40))
def test_random_problems_vary_as_if_they_were_posed_anew(seed: int) -> None:
    plain = random_problem(seed, foon_asp.ContainerRule.STRICT)
    start = Foon.of(plain).problem(*plain.goal_nodes)
    rng = random.Random(seed)
    kitchen = frozenset(rng.sample(range(len(plain.network.objects)), rng.randint(0, 5)))
    goals = tuple(rng.sample(range(len(plain.network.objects)), rng.randint(1, 2)))
    rates = {motion: Fraction(rng.randint(1, 9), 10) for motion in plain.rates or {}}
    rule, prices = foon_asp.ContainerRule.IMPLIED, plain.unit_prices
    anew = PlainProblem(plain.network, kitchen, goals, rates, plain.utensils, rule, unit_prices=prices)
    nodes = plain.network.objects
    asked = [nodes[o] for o in goals]
    in_kitchen = [nodes[o] for o in sorted(kitchen)]
    once = start.vary(asked, "implied", kitchen=in_kitchen, rates=rates)
    gone = [nodes[o] for o in plain.kitchen - kitchen]
    steps = (
        start.vary(adding=in_kitchen).vary(rates=rates).vary(containers="implied", without=gone).vary(asked)
    )
    for varied in (once, steps):
        assert (varied.kitchen, varied.goals, varied.rates) == (kitchen, goals, rates)
        assert varied.needs == anew.needs
        assert timeless(foon_asp.solve(varied, "success").json()) == timeless(
            foon_asp.solve(anew, "success").json()
        )
    assert start.kitchen == plain.kitchen


def test_several_files_and_json(tmp_path: Path, foon: Foon) -> None:
    text = (KITCHEN / "FOON.txt").read_text(encoding="utf-8")
    units = text.split("//\n")
    halves = [tmp_path / "a.txt", tmp_path / "b.txt"]
    halves[0].write_text("//\n".join(units[:100]) + "//\n", encoding="utf-8")
    halves[1].write_text("//\n".join(units[100:]), encoding="utf-8")
    beside = {name: KITCHEN / file for name, file in BESIDE.items()}
    for source in (halves, map(str, halves), KITCHEN / "FOON.txt"):
        loaded = foon_asp.load(source, **beside)  # type: ignore[arg-type]
        assert len(loaded.network) == len(foon.network)
        assert loaded.kitchen == foon.kitchen
        assert loaded.goals == foon.goals
        assert loaded.utensils == foon.utensils
        assert foon_asp.solve(loaded.problem("ice")).costs == foon_asp.solve(foon.problem("ice")).costs
    node = {"label": "tea", "states": ["hot"]}
    unit = {"input_nodes": [{"label": "water"}], "motion_node": "boil", "output_nodes": [node]}
    (tmp_path / "units.json").write_text(json.dumps({"functional_units": [unit]}))
    (tmp_path / "kitchen.json").write_text(json.dumps([{"label": "water"}]))
    tea = foon_asp.load(tmp_path / "units.json", kitchen=tmp_path / "kitchen.json").problem("tea")
    costs = foon_asp.solve(tea).costs
    assert costs is not None
    assert (costs.units, costs.success) == (1, None)
    with pytest.raises(
        UserError, match=r"success needs the success rates of the motions: .* load\(\.\.\., rates"
    ):
        foon_asp.solve(tea, "success")


BESIDE = {
    "kitchen": "kitchen.json",
    "rates": "motion.txt",
    "utensils": "utensils.txt",
    "goals": "goal_nodes.json",
}


def test_what_is_assumed_is_warned_of_where_the_caller_stands(tmp_path: Path) -> None:
    (tmp_path / "kitchen.json").write_text('[{"label": "drinking glas"}]')
    with pytest.warns(FoonWarning, match="'drinking glas' matches no object node") as caught:
        foon = foon_asp.load(KITCHEN, kitchen=tmp_path / "kitchen.json")
    assert [Path(warning.filename).name for warning in caught] == ["test_api.py"]
    assert [str(warning.message) for warning in caught] == list(foon.warnings)
    assert foon.kitchen == ()
    with pytest.warns(FoonWarning, match="no kitchen is given"):
        foon_asp.load(KITCHEN / "FOON.txt")
    constraint = tmp_path / "mine.lp"
    constraint.write_text(':- uses(U), motion(U,"fry").\n')
    with pytest.warns(FoonWarning, match="did you mean use/1") as caught:
        foon_asp.solve(foon_asp.load().problem("ice"), constraints=[constraint])
    assert [Path(warning.filename).name for warning in caught] == ["test_api.py"]


@pytest.mark.slow
def test_nothing_is_printed(foon: Foon, capsys: pytest.CaptureFixture[str]) -> None:
    for goal in ("ice", "apple pie", "hot cocoa"):
        problem = foon.problem(goal)
        for ask in (foon_asp.solve, foon_asp.why_not, foon_asp.shopping_list, foon_asp.regret):
            assert str(ask(problem))
            assert repr(ask(problem)).startswith("<")
            assert "\n" not in repr(ask(problem))
    assert capsys.readouterr() == ("", "")


def test_results_are_frozen_and_short_to_look_at(foon: Foon) -> None:
    problem = foon.problem("ice")
    answer = foon_asp.solve(problem)
    for value, name in ((answer, "units"), (answer.costs, "units"), (foon_asp.regret(problem), "regrets")):
        with pytest.raises(AttributeError):
            setattr(value, name, ())
    for frozen, name in ((problem, "kitchen"), (answer.tree, "units")):
        with pytest.raises(FrozenInstanceError):
            setattr(frozen, name, ())
    assert repr(problem) == "<Problem: ice; crushed; in [drinking glass] (strict containers)>"
    assert repr(foon) == "<Foon of the bundled kitchen>"
    assert repr(foon.network).startswith("<Network: 220 units")
    assert repr(answer.tree) == "<Tree for ice; crushed; in [drinking glass]: 2 units>"
    assert pickle.loads(pickle.dumps(answer)).json() == answer.json()


def test_a_tree_is_made_of_units_with_names(foon: Foon, cli: Cli) -> None:
    answer = foon_asp.solve(foon.problem("macaroni"))
    assert answer.tree is not None
    assert isinstance(answer.tree, foon_asp.TaskTree)
    assert [unit.motion for unit in answer.tree] == [unit["motion"] for unit in answer.json()["units"]]
    assert f"{answer.tree}" == cli("solve", "--goal", "macaroni", "--format", "foon").out
    assert foon_asp.solve(foon.problem("apple pie")).tree is None
    assert foon.nodes("macaroni")[0].label == "macaroni"
    assert foon.nodes("unicorn") == ()


def texts_in(svg: ET.Element) -> set[str | None]:
    return {element.text for element in svg.iter() if element.tag.endswith("text")}


def images_in(page: str) -> list[ET.Element]:
    """Give the pictures of a page, which has to be well-formed."""
    begin = "data:image/svg+xml;base64,"
    images = [each.attrib["src"] for each in ET.fromstring(f"<p>{page}</p>").iter("img")]
    assert all(image.startswith(begin) for image in images)
    return [ET.fromstring(base64.b64decode(image.removeprefix(begin))) for image in images]


def steps_of(tree: foon_asp.TaskTree | None) -> set[str]:
    assert tree is not None
    return {f"{step}. {unit.motion}" for step, unit in enumerate(tree, 1)}


def test_a_notebook_shows_a_picture(foon: Foon) -> None:
    problem = foon.problem("ice")
    answer = foon_asp.solve(problem)
    assert answer.tree is not None
    for bundle in (answer._repr_mimebundle_(), answer.tree._repr_mimebundle_()):
        svg = bundle["image/svg+xml"]
        assert svg.startswith("<svg")
        assert steps_of(answer.tree) <= texts_in(ET.fromstring(svg))
        assert bundle.keys() == {"text/plain", "image/svg+xml"}


def test_a_notebook_shows_a_page(foon: Foon) -> None:
    problem = foon.problem("ice")
    menu = foon_asp.menu(problem.vary(["ice", "tea"]))
    regrets = foon_asp.regret(problem)
    alternatives = foon_asp.alternatives(problem, best=2)
    shown: list[tuple[Any, list[foon_asp.TaskTree | None]]] = [
        (menu, [menu.together.tree]),
        (regrets, [regrets.outcome.tree]),
        (alternatives, [*alternatives.task_trees]),
        (foon_asp.why_not(foon.problem("apple pie")), []),
        (foon_asp.solve(foon.problem("apple pie")), []),
    ]
    for result, trees in shown:
        bundle = result._repr_mimebundle_()
        assert bundle["text/plain"] == repr(result)
        page = bundle["text/html"]
        assert html.unescape(page).startswith(f"<pre>{result}</pre>")
        pictures = images_in(page)
        assert len(pictures) == len(trees)
        for image, tree in zip(pictures, trees, strict=True):
            assert steps_of(tree) <= texts_in(image)
    table = foon_asp.compare_searches(problem)._repr_mimebundle_()["text/markdown"]
    assert table.startswith("| goal |")
    with pytest.raises(UserError, match="no tree to draw"):
        foon_asp.solve(foon.problem("apple pie")).svg()


def test_without_the_packages_for_pictures_there_is_text(foon: Foon, monkeypatch: pytest.MonkeyPatch) -> None:
    def missing(_: object) -> bytes:
        raise UserError("a picture needs more packages: pip install 'foon-asp[pictures]'")

    monkeypatch.setattr("foon_asp.report.notebook.svg_picture", missing)
    answer = foon_asp.solve(foon.problem("ice"))
    for shown in (answer, answer.tree, foon_asp.alternatives(foon.problem("ice"))):
        assert shown is not None
        bundle = shown._repr_mimebundle_()
        assert html.unescape(bundle.pop("text/html")) == f"<pre>{shown}</pre>"
        assert bundle == {"text/plain": repr(shown)}
    with pytest.raises(UserError, match="pip install"):
        answer.svg()


def test_a_picture_too_large_is_text(foon: Foon, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(picture, "MOST_UNITS", 1)
    answer = foon_asp.solve(foon.problem("ice"))
    assert answer._repr_mimebundle_().keys() == {"text/plain", "text/html"}


FAULTS: dict[str, tuple[Callable[[Foon], object], str]] = {
    "no such file": (lambda _: foon_asp.load("nowhere"), "nowhere: no such file or folder"),
    "no files": (lambda _: foon_asp.load([]), "expected the path of a FOON, found an empty list"),
    "level": (lambda _: foon_asp.load(level=4), "found level=4, expected 1, 2 or 3"),
    "no goal": (lambda f: f.problem(), "name a goal; the goals file has 'greek salad', 'macaroni',"),
    "goals": (
        lambda f: f.problem("bowl"),
        "means 12 object nodes; paste the one you mean\n  'bowl; empty'\n",
    ),
    "unknown": (
        lambda f: f.problem("macarony"),
        "no object node has the label 'macarony'; similar are\n  'mac",
    ),
    "node": (lambda f: f.problem(foon_asp.ObjectNode("x")), "no object node of the network is the goal 'x'"),
    "rule": (
        lambda f: f.problem("ice", containers="lax"),
        "found the containers 'lax', expected one of strict, implied",
    ),
    "kitchen item": (lambda f: f.vary(adding="bowl"), "the kitchen item 'bowl' means 12 object nodes; paste"),
    "no such item": (
        lambda f: f.vary(without="apple crumble"),
        "the kitchen has nothing with the label 'apple",
    ),
    "several items": (
        lambda f: f.vary(adding=["pie crust; rolled", "pie crust; chilled"], without="pie crust"),
        "the kitchen has 2 items with the label 'pie crust'; name those you mean",
    ),
    "not there": (lambda f: f.vary(without="bowl; dirty"), "the kitchen does not have 'bowl; dirty'"),
    "motion": (
        lambda f: f.vary(rates={"crus": 1}),
        "no motion 'crus' has a success rate; similar are 'crush'",
    ),
    "rate": (
        lambda f: f.vary(rates={"crush": 1.5}),
        "found 1.5 for the success rate of 'crush', expected a number above 0",
    ),
    "number": (
        lambda f: f.vary(rates={"crush": "much"}),
        "found 'much' for the success rate of 'crush', exp",
    ),
    "objective": (
        lambda f: foon_asp.solve(f.problem("ice"), "taste"),
        "found the objective 'taste', expected one of units, inputs",
    ),
    "constraint": (
        lambda f: foon_asp.solve(f.problem("ice"), constraints="x"),
        "x: no such file; expected an encoding",
    ),
    "empty constraint": (
        lambda f: foon_asp.solve(f.problem("ice"), constraints=""),
        "found an empty text for a constraint, expected a file, the name of a ready-made one, or a rule",
    ),
    "empty soft constraint": (
        lambda f: foon_asp.solve_soft(f.problem("ice"), soft={" ": 1}),
        "found an empty text for a constraint, expected a file, the name of a ready-made one, or a rule",
    ),
    "constant": (
        lambda f: foon_asp.solve(f.problem("ice"), constants={"x": 1}),
        "no encoding in use has the constant 'x'",
    ),
    "reduction": (lambda f: foon_asp.solve(f.problem("ice"), reductions="x"), "expected"),
    "time": (lambda f: foon_asp.solve(f.problem("ice"), time_limit=-1), "found the time limit -1, expected"),
    "weight": (
        lambda f: foon_asp.solve_soft(f.problem("ice"), soft={"forbid_motion": 0}),
        "found the weight 0 of forbid_motion, expected a whole number from 1 to 1000000",
    ),
    "two weights": (
        lambda f: foon_asp.solve_soft(f.problem("ice"), soft={"forbid_motion": 1, "forbid_motion.lp": 1}),
        "forbid_motion.lp has two weights",
    ),
    "no constraint": (
        lambda f: foon_asp.clash(f.problem("ice"), constraints=[]),
        "name constraints, files or names of ours; why-not",
    ),
    "both": (
        lambda f: foon_asp.alternatives(f.problem("ice"), best=1, different=2),
        "best and different exclude each other",
    ),
    "within": (
        lambda f: foon_asp.alternatives(f.problem("ice"), within=5),
        "within is only for different trees",
    ),
    "none": (
        lambda f: foon_asp.alternatives(f.problem("ice"), best=0),
        "found best=0, expected a whole number",
    ),
    "unit": (lambda f: foon_asp.regret(f.problem("ice"), units=[7, 9999]), "there is no unit 9999 in the"),
    "a menu of one": (lambda f: foon_asp.menu(f.problem("ice")), "a menu has several goals"),
    "price": (
        lambda f: foon_asp.shopping_list(f.problem("tea"), prices={"tea; in [x": 1}),
        "the name 'tea; in [x' of a price cannot be read: at column 9",
    ),
    "negative": (
        lambda f: foon_asp.shopping_list(f.problem("tea"), prices={"tea": -1}),
        "found the price -1 of 'tea', expected one from 0",
    ),
    "search": (
        lambda f: foon_asp.retrieve(f.problem("ice"), "a*"),
        "found the search 'a*', expected one of bfs",
    ),
    "ties": (
        lambda f: foon_asp.retrieve(f.problem("ice"), "bfs", ties="any"),
        "found ties='any', expected one of first, last",
    ),
    "diff": (
        lambda f: foon_asp.diff(foon_asp.solve(f.problem("ice")), foon_asp.solve(f.problem("apple pie"))),
        "the right answer has no tree",
    ),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_faults_say_what_was_expected(fault: str, foon: Foon) -> None:
    ask, message = FAULTS[fault]
    with warnings.catch_warnings(), pytest.raises(UserError) as raised:
        ask(foon)
    assert message in str(raised.value)
    assert "--" not in str(raised.value)


def test_one_goal_needs_no_name(tmp_path: Path) -> None:
    (tmp_path / "goals.txt").write_text("O\tice\nS\tcrushed\nS\tin\t[drinking glass]\n")
    foon = foon_asp.load(KITCHEN, goals=tmp_path / "goals.txt")
    assert foon.problem().goal_nodes == foon.goals


def test_the_real_universal_foon(universal: Path) -> None:
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        foon = foon_asp.load(universal)
    assert [str(each.message) for each in caught] == list(foon.warnings)
    assert CORPUS.is_dir()
    goal = foon.goals[0]
    strict = foon_asp.solve(foon.problem(goal))
    implied = foon_asp.solve(strict.problem.vary(containers="implied"))
    assert {strict.status, implied.status} <= {"optimal", "infeasible"}
