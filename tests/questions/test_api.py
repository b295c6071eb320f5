"""The questions in Python: the same answers as on the command line, problems that vary, results that show."""

import base64
import html
import json
import pickle
import random
import re
import sys
import warnings
import xml.etree.ElementTree as ET
from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

import foon_asp
from foon_asp import Foon, FoonWarning, Problem, UserError
from foon_asp.resources import bundled_kitchen
from foon_asp.store.import_files import import_files
from foon_asp.text.data_folder import find_data
from tests.conftest import Cli, valid
from tests.support.random_problems import random_problem

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
FORBID_AND_REQUIRE = ["why-not", "--constraint", "forbid_motion", "--constraint", "require_motion"]
CRUSH: dict[str, Any] = {"constants": {"forbidden_motion": "crush"}}
CLASHING = {"forbidden_motion": "crush", "required_motion": "crush"}

QUESTIONS: dict[str, tuple[list[str], list[str], str, Ask]] = {
    "all goals": (
        ["solve", "--all-goals", "--objective", "inputs,success", "--objective", "kitchen"],
        ["ice", "tea"],
        "implied",
        lambda p: foon_asp.solve_all_goals(p, ["inputs,success", "kitchen"]),
    ),
    "other engines": (
        ["solve", "--cross-check", "--objective", "success", "--rule", ":- use(1)."],
        ["tea"],
        "strict",
        lambda p: foon_asp.solve(p, "success", constraints=":- use(1).", cross_check=True),
    ),
    "solve under a constraint": (
        ["solve", "--constraint", "forbid_motion", *CONSTANT, "--encodings", "by_need", "--reduce", "none"],
        ["ice"],
        "strict",
        lambda p: foon_asp.solve(
            p, constraints="forbid_motion", encodings="by_need", reductions="none", **CRUSH
        ),
    ),
    "no tree": (["solve"], ["apple pie"], "strict", foon_asp.solve),
    "soft": (
        ["solve", "--soft", "forbid_motion=3", *CONSTANT],
        ["ice"],
        "strict",
        lambda p: foon_asp.solve(p, soft={"forbid_motion": 3}, **CRUSH),
    ),
    "one shopping list": (
        ["shopping-list", "--lists", "1", "--objective", "success"],
        ["apple pie"],
        "implied",
        lambda p: foon_asp.shopping_list(p, "success", lists=1),
    ),
    "why not, where rules are the reason": (
        [*FORBID_AND_REQUIRE, *CONSTANT, "-c", "required_motion=crush", "--weight", "forbid_motion=2"],
        ["ice"],
        "strict",
        lambda p: foon_asp.why_not(
            p,
            constraints=["forbid_motion", Path("require_motion")],
            constants=CLASHING,
            weights={"forbid_motion": 2},
        ),
    ),
    "regret": (
        ["regret", "--objective", "success", "--unit", "3"],
        ["ice"],
        "strict",
        lambda p: foon_asp.regret(p, "success", units=[3]),
    ),
    "assist, and a success to reach": (
        ["assist", "--reach", "0.95", "--constraint", "forbid_motion", *CONSTANT],
        ["ice"],
        "strict",
        lambda p: foon_asp.assist(p, reach=0.95, constraints="forbid_motion", **CRUSH),
    ),
    "pareto under a constraint": (
        ["pareto", "--objective", "units,kitchen", "--constraint", "forbid_motion", *CONSTANT],
        ["ice", "tea"],
        "strict",
        lambda p: foon_asp.pareto(p, ["units", "kitchen"], constraints="forbid_motion", **CRUSH),
    ),
}


@pytest.mark.slow
@pytest.mark.parametrize("question", QUESTIONS)
def test_the_answer_is_that_of_the_command_line(question: str, cli: Cli) -> None:
    words, goals, containers, ask = QUESTIONS[question]
    named = [word for goal in goals for word in ("--goal", goal)]
    given = [*words, *named, "--containers", containers]
    answer = ask(foon_asp.load().problem(*goals, containers=containers))
    assert timeless(answer.json()) == timeless(cli(*given, "--format", "json").json)
    shown = cli(*given, *(["--format", "markdown"] if words[0] == "compare" else [])).out.split("\n")
    # in Python, without advice on what to ask next; seconds are no figures to compare
    lines = [line for line in str(answer).split("\n") if not re.search(r"\d s\)?$|\d\.\d\d$", line)]
    assert set(lines) <= {*shown}


def test_prices_from_a_file_and_by_name(foon: Foon, tmp_path: Path) -> None:
    problem = foon.problem("hot cocoa", "apple pie")
    prices: dict[str, Any] = {"cocoa tin; contains {cocoa powder}": "4.50", "pie crust; chilled": 1.5}
    file = tmp_path / "prices.txt"
    file.write_text("".join(f"{name}\t{price}\n" for name, price in prices.items()))
    with pytest.warns(FoonWarning, match="no node for sale has this label: unicorn"):
        by_name = foon_asp.shopping_list(problem, prices={**prices, "unicorn": 1})
    assert by_name.lists == foon_asp.shopping_list(problem, prices=file).lists
    assert [str(node) for node in by_name.lists[0].items] == [*prices]
    assert by_name.lists[0].price == 6


def test_help_takes_rates_by_motion_and_from_a_file(foon: Foon, tmp_path: Path) -> None:
    problem = foon.problem("ice")
    file = tmp_path / "person.txt"
    file.write_text("crush\t0.95\n")
    by_motion = foon_asp.assist(problem, person={"crush": "0.95"})
    assert by_motion.json() == foon_asp.assist(problem, person=file).json()
    assert by_motion.rows[1].success == by_motion.greatest_success
    with pytest.warns(FoonWarning, match="the motion 'fly' has no rate for the robot"):
        foon_asp.assist(problem, person={"fly": 1})


def test_trees_in_files_are_checked_and_compared(source: Path, cli: Cli, tmp_path: Path) -> None:
    words = ["--goal", "macaroni", *data_words(source)]
    file, answer_file = tmp_path / "tree.txt", tmp_path / "answer.json"
    file.write_text(cli("compare", "--search", "bfs", *words, "--format", "foon").out, encoding="utf-8")
    answer_file.write_text(cli("solve", *words, "--format", "json").out, encoding="utf-8")
    problem = foon_asp.load(source).problem("macaroni")
    tree = foon_asp.Tree.read(problem, file)
    checked = foon_asp.check(problem, file)
    assert checked.json() == cli("check", file, *words, "--format", "json").json
    assert f"{checked}\n" == cli("check", file, *words).out
    assert checked.in_order is not None
    assert foon_asp.check(problem, checked.in_order).verdict == "executes as listed"
    best = foon_asp.solve(problem)
    found = foon_asp.diff(tree, best)
    assert timeless(found.json()) == timeless(cli("diff", file, answer_file, *words, "--format", "json").json)
    assert [unit.motion for unit in found.only_in_b] == ["tilt"]
    assert foon_asp.Tree.read(problem, answer_file) == best.tree


@pytest.mark.parametrize(
    "printed",
    [
        "pyclingo version 5.8.3\nSolving...\nAnswer: 1 (Time: 0.001s)\nuse(28)\nOptimization: 3\n"
        "Answer: 2 (Time: 0.002s)\nuse(27) use(26)\nOptimization: 2\nOPTIMUM FOUND\n\nModels  : 2\n",
        "use(27).\r\nuse(26).",
    ],
)
def test_a_tree_is_read_from_the_atoms_of_clingo(cli: Cli, tmp_path: Path, printed: str) -> None:
    file = tmp_path / "answer.txt"
    file.write_text(printed, encoding="utf-8")
    problem = foon_asp.load().problem("ice")
    assert foon_asp.Tree.read(problem, file) == foon_asp.Tree.of(problem, (27, 26))
    assert "executes in another order" in cli("check", file, "--goal", "ice").out
    assert cli("view", "--tree", file, "--goal", "ice", "--format", "dot").code == 0
    assert "use(U) names no goal" in cli("check", file).err
    file.write_text(printed.replace("26", "999"), encoding="utf-8")
    assert "use(999): the network has no unit 999" in cli("check", file, "--goal", "ice").err


def test_a_tree_with_units_of_no_network(foon: Foon) -> None:
    problem = foon.problem("ice")
    answer = foon_asp.solve(problem)
    assert answer.tree is not None
    first, *others = answer.tree
    strange = foon_asp.FunctionalUnit.of("conjure", first.inputs, [foon_asp.parse_node("smoke")])
    checked = foon_asp.check(problem, [first, strange, *others])
    assert checked.executes
    assert checked.json()["not_in_network"] == [2]
    assert foon_asp.diff(answer, checked.tree).json()["b"]["costs"] is None
    without = foon_asp.check(problem, others)
    assert (without.executes, without.in_order) == (False, None)


def test_certificates(source: Path, cli: Cli, tmp_path: Path) -> None:
    foon = foon_asp.load(source)
    file = tmp_path / "proof.json"
    found = foon_asp.solve(foon.problem("ice"), "success", certificate=file)
    assert found.certificate is not None
    said = cli("solve", "--goal", "ice", "--objective", "success", "--certificate", file, *data_words(source))
    assert found.text() == said.out
    assert found.certificate.text() == file.read_text()
    by_file = foon_asp.verify(foon, file)
    assert by_file == foon_asp.verify(foon.problem("tea"), found.certificate)
    assert by_file.json() == cli("verify", file, *data_words(source), "--format", "json").json
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
    return [timeless(best.json()), timeless(reasons.json()), foon_asp.search(problem, "ids").json()]


def test_a_varied_problem_is_one_of_other_files(source: Path, tmp_path: Path) -> None:
    foon = foon_asp.load(source)
    entries = json.loads((KITCHEN / "kitchen.json").read_text())
    fewer, table = tmp_path / "kitchen.json", tmp_path / "motion.txt"
    fewer.write_text(json.dumps([entry for entry in entries if entry["label"] != "drinking glass"]))
    table.write_text(re.sub(r"(?m)^crush\t.*", "crush\t0.125", (KITCHEN / "motion.txt").read_text()))
    less = foon_asp.load(source, kitchen=fewer, rates=table)
    problem = foon.problem("tea").vary(goals="ice", rates={"crush": 0.125})
    varied = problem.vary(without="drinking glass")
    assert Foon.of(varied).kitchen == less.kitchen
    for same in (varied, problem.vary(kitchen=fewer), problem.vary(kitchen=less.kitchen)):
        assert answers(same) == answers(less.problem("ice"))
    gone = [node for node in foon.kitchen if node.label == "drinking glass"]
    assert answers(varied.vary(adding=gone)) == answers(problem)
    # a name in full stands for one item alone
    assert len(foon.vary(without=str(gone[0])).kitchen) == len(foon.kitchen) - 1


def test_the_kitchen_of_an_answer_is_that_of_its_problem(source: Path) -> None:
    shopping = foon_asp.shopping_list(foon_asp.load(source).problem("hot cocoa"))
    assert shopping.answer is not None
    stocked = shopping.answer.problem
    assert foon_asp.solve(stocked.vary(containers="implied")).status == "optimal"
    assert foon_asp.solve(stocked.vary(without=map(str, shopping.lists[0].items))).status == "infeasible"


def test_a_problem_put_together_by_hand() -> None:
    plain = random_problem(3, foon_asp.ContainerRule.STRICT)
    problem = Problem(plain.network, plain.kitchen, plain.goals, plain.rates, plain.utensils)
    assert foon_asp.solve(plain).tree == foon_asp.solve(problem).tree
    with pytest.raises(UserError, match="put together by hand"):
        problem.vary(containers="implied")
    implied = Foon.of(problem).problem(*problem.goal_nodes).vary(containers="implied")
    assert (implied.containers, implied.kitchen) == ("implied", plain.kitchen)


@pytest.mark.parametrize("seed", range(20))
def test_random_problems_vary_as_if_they_were_posed_anew(seed: int) -> None:
    plain = random_problem(seed, foon_asp.ContainerRule.STRICT)
    start = Foon.of(plain).problem(*plain.goal_nodes)
    rng = random.Random(seed)
    nodes = plain.network.objects
    kitchen = frozenset(rng.sample(range(len(nodes)), rng.randint(0, 5)))
    goals = tuple(rng.sample(range(len(nodes)), rng.randint(1, 2)))
    rates = {motion: Fraction(rng.randint(1, 9), 10) for motion in plain.rates or {}}
    rule = foon_asp.ContainerRule.IMPLIED
    anew = replace(plain, kitchen=kitchen, goals=goals, rates=rates, containers=rule)
    asked, there, gone = ([nodes[o] for o in ids] for ids in (goals, kitchen, plain.kitchen - kitchen))
    once = start.vary(asked, "implied", kitchen=there, rates=rates)
    steps = start.vary(adding=there).vary(rates=rates).vary(containers="implied", without=gone).vary(asked)
    for varied in (once, steps):
        assert (varied.kitchen, varied.goals, varied.rates) == (kitchen, goals, rates)
        assert answers(varied) == answers(anew)
    assert start.kitchen == plain.kitchen


def test_several_files_and_json(tmp_path: Path, foon: Foon) -> None:
    units = (KITCHEN / "FOON.txt").read_text(encoding="utf-8").split("//\n")
    halves = [tmp_path / "a.txt", tmp_path / "b.txt"]
    for half, some in zip(halves, (units[:100], units[100:]), strict=True):
        half.write_text("//\n".join(some) + "//\n", encoding="utf-8")
    beside: dict[str, Any] = {name: KITCHEN / file for name, file in BESIDE.items()}
    for source in (halves, map(str, halves), KITCHEN / "FOON.txt"):
        loaded = foon_asp.load(source, **beside)
        assert len(loaded.network) == len(foon.network)
        for name in BESIDE:
            assert getattr(loaded, name) == getattr(foon, name)
    unit = {"input_nodes": [WATER], "motion_node": "boil", "output_nodes": [{"label": "tea"}]}
    (tmp_path / "units.json").write_text(json.dumps({"functional_units": [unit]}))
    (tmp_path / "kitchen.json").write_text(json.dumps([WATER]))
    tea = foon_asp.load(tmp_path / "units.json", kitchen=tmp_path / "kitchen.json").problem("tea")
    assert foon_asp.solve(tea).ids == (0,)
    with pytest.raises(UserError, match=r"success needs the success rates .* load\(\.\.\., rates"):
        foon_asp.solve(tea, "success")


WATER = {"label": "water"}
BESIDE = {
    "kitchen": "kitchen.json",
    "rates": "motion.txt",
    "utensils": "utensils.txt",
    "goals": "goal_nodes.json",
}


def test_what_is_assumed_is_warned_of_where_the_caller_stands(tmp_path: Path) -> None:
    kitchen = tmp_path / "kitchen.json"
    kitchen.write_text('[{"label": "drinking glas"}]')
    with pytest.warns(FoonWarning, match="'drinking glas' matches no object node") as caught:
        foon = foon_asp.load(KITCHEN, kitchen=kitchen)
    assert [Path(warning.filename).name for warning in caught] == ["test_api.py"]
    assert [str(warning.message) for warning in caught] == list(foon.warnings)
    with pytest.warns(FoonWarning, match="No kitchen given"):
        foon_asp.load(KITCHEN / "FOON.txt")
    with pytest.warns(FoonWarning, match="did you mean use/1") as caught:
        foon_asp.solve(foon_asp.load().problem("ice"), constraints=':- uses(U), motion(U,"fry").')
    assert [Path(warning.filename).name for warning in caught] == ["test_api.py"]


def test_a_path_or_data_can_stand_in_place_of_a_problem(foon: Foon) -> None:
    ask: Any = foon_asp.solve
    assert ask(KITCHEN, goal="ice", objective="success").ids == ask(ice(foon), "success").ids
    both = ask(foon, goal=["ice", foon.nodes("tea")[0]], containers="implied")
    assert [goal.label for goal in both.goals] == ["ice", "tea"]
    assert both.containers == "implied"
    tree = ask(foon, goal="ice").tree
    assert [tree[0], tree[-1]] == [*tree]
    with pytest.raises(TypeError, match="keyword argument 'time'; it takes problem, objectives,"):
        ask(foon, goal="ice", time=3)


def test_nothing_is_printed(foon: Foon, capsys: pytest.CaptureFixture[str]) -> None:
    for goal in ("ice", "apple pie"):
        for ask in (foon_asp.solve, foon_asp.why_not, foon_asp.regret):
            found = ask(foon.problem(goal))
            assert str(found)
            assert repr(found).startswith("<")
            assert "\n" not in repr(found)
    assert capsys.readouterr() == ("", "")


def test_results_are_frozen_and_short_to_look_at(foon: Foon) -> None:
    problem = foon.problem("ice")
    answer = foon_asp.solve(problem)
    frozen = (answer, "units"), (answer.costs, "units"), (problem, "kitchen"), (answer.tree, "units")
    for value, name in frozen:
        with pytest.raises(AttributeError):
            setattr(value, name, ())
    assert repr(problem) == "<Problem: ice; crushed; in [drinking glass] (strict containers)>"
    assert repr(foon) == "<Foon of the bundled kitchen>"
    assert repr(foon.network).startswith("<Network: 220 units")
    assert repr(answer.tree) == "<Tree for ice; crushed; in [drinking glass]: 2 units>"
    assert pickle.loads(pickle.dumps(answer)).json() == answer.json()


@pytest.mark.parametrize("goal", ["ice", "apple pie"])
def test_a_tree_is_made_of_units_with_names(goal: str, foon: Foon, cli: Cli) -> None:
    answer, ran = foon_asp.solve(foon.problem(goal)), cli("solve", "--goal", goal, "--format", "foon")
    assert answer.foon() == ran.out
    assert answer.remark("foon") == ran.err.rstrip("\n")
    if answer.tree is None:
        assert goal == "apple pie"
        return
    assert f"{answer.tree}" == ran.out
    assert [unit.motion for unit in answer.tree] == [unit["motion"] for unit in answer.json()["units"]]
    assert foon.nodes("macaroni")[0].label == "macaroni"
    assert foon.nodes("unicorn") == ()


def texts_in(svg: ET.Element) -> set[str | None]:
    return {element.text for element in svg.iter() if element.tag.endswith("text")}


def steps_of(tree: foon_asp.TaskTree | None) -> set[str]:
    assert tree is not None
    return {f"{step}. {unit.motion}" for step, unit in enumerate(tree, 1)}


def ice(foon: Foon) -> Problem:
    return foon.problem("ice")


def test_a_notebook_shows_a_picture(foon: Foon) -> None:
    answer = foon_asp.solve(foon.problem("ice"))
    assert answer.tree is not None
    for bundle in (answer._repr_mimebundle_(), answer.tree._repr_mimebundle_()):
        assert steps_of(answer.tree) <= texts_in(ET.fromstring(bundle["image/svg+xml"]))
        assert bundle.keys() == {"text/plain", "image/svg+xml"}


def test_a_notebook_shows_a_page(foon: Foon) -> None:
    problem, pie = foon.problem("ice"), foon.problem("apple pie")
    front: Any = foon_asp.regret(problem)
    for result, trees in ((front, 1), (foon_asp.alternatives(problem, best=2), 2), (foon_asp.solve(pie), 0)):
        bundle = result._repr_mimebundle_()
        assert bundle["text/plain"] == repr(result)
        page = ET.fromstring(f"<p>{bundle['text/html']}</p>")
        assert (page.findtext("pre") or "").startswith(str(result))
        images = [each.attrib["src"].removeprefix("data:image/svg+xml;base64,") for each in page.iter("img")]
        drawn = [texts_in(ET.fromstring(base64.b64decode(image))) for image in images]
        assert [bool({"1. twist", "1. turn on"} & texts) for texts in drawn] == [True] * trees
    table = foon_asp.compare(problem)._repr_mimebundle_()["text/html"]
    assert table.startswith("<pre>Searches and the optimum (strict containers)\n")
    with pytest.raises(UserError, match="no tree to draw"):
        foon_asp.solve(pie).svg()


def test_without_the_packages_for_pictures_there_is_text(foon: Foon, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "wasmtime", None)
    answer = foon_asp.solve(foon.problem("ice"))
    for shown in (answer, answer.tree, foon_asp.alternatives(foon.problem("ice"))):
        assert shown is not None
        bundle = shown._repr_mimebundle_()
        assert html.unescape(bundle.pop("text/html")) == f"<pre>{shown}</pre>"
        assert bundle == {"text/plain": repr(shown)}
    with pytest.raises(UserError, match="pip install"):
        answer.svg()


FAULTS: dict[str, tuple[Callable[[Foon], object], str]] = {
    "no goal": (lambda f: f.problem(), "name a goal; the goals file has 'greek salad', 'macaroni',"),
    "goals": (
        lambda f: f.problem("bowl"),
        "means 12 object nodes; paste the one you mean\n  'bowl; empty'\n",
    ),
    "rule": (lambda f: f.problem("ice", containers="lax"), "found the containers 'lax', expected one of"),
    "not there": (lambda f: f.vary(without="bowl; dirty"), "the kitchen does not have 'bowl; dirty'"),
    "motion": (
        lambda f: f.vary(rates={"crus": 1}),
        "no motion 'crus' has a success rate; similar are 'crush'",
    ),
    "rate": (lambda f: f.vary(rates={"crush": 1.5}), "found 1.5 for the success rate of 'crush', expected a"),
    "about nothing": (lambda _: foon_asp.solve(), "solve of what? solve('eggs.txt'), or"),  # type: ignore[call-arg]
    "no path": (
        lambda _: foon_asp.solve("ice"),  # type: ignore[arg-type]
        "no such file or folder: ice (a goal of the bundled kitchen: solve(foon_asp.load(), goal='ice'))",
    ),
    "two goals": (lambda f: foon_asp.solve(ice(f), goal="tea"), "a problem has its own goal"),
    "a number": (lambda _: foon_asp.solve(3), "expected a path, data or a problem"),  # type: ignore[arg-type]
    "weight": (
        lambda f: foon_asp.solve(ice(f), soft={"forbid_motion": 0}),
        "found the weight 0 of forbid_motion, expected a whole number from 1 to 1000000",
    ),
    "two weights": (
        lambda f: foon_asp.solve(ice(f), soft={"forbid_motion": 1, "forbid_motion.lp": 1}),
        "forbid_motion.lp has two weights",
    ),
    "both": (lambda f: foon_asp.alternatives(ice(f), best=1, different=2), "best and different exclude each"),
    "within": (lambda f: foon_asp.alternatives(ice(f), within=5), "within is only for different trees"),
    "none": (lambda f: foon_asp.alternatives(ice(f), best=0), "found best=0, expected a whole number"),
    "unit": (lambda f: foon_asp.regret(ice(f), units=[7, 9999]), "there is no unit 9999 in the"),
    "no motion": (lambda f: foon_asp.regret(ice(f), motions="crsh"), "has the motion 'crsh'; similar are 'c"),
    "reach": (lambda f: foon_asp.assist(ice(f), reach=0), "found 0 for the success to reach, expected a"),
    "no tree": (lambda f: foon_asp.why_not(ice(f)).foon(), "this is no tree, which FOON text could hold"),
    "price": (
        lambda f: foon_asp.shopping_list(ice(f), prices={"tea; in [x": 1}),
        "the name 'tea; in [x' of a price cannot be read: at column 9",
    ),
    "search": (lambda f: foon_asp.search(ice(f), "a*"), "found the search 'a*', expected one of bfs"),
    "diff": (
        lambda f: foon_asp.diff(foon_asp.solve(ice(f)), foon_asp.solve(f.problem("apple pie"))),
        "b: the answer has no tree",
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


@pytest.mark.filterwarnings("ignore::foon_asp.errors.FoonWarning")
def test_data_verbs_in_python(cli: Cli, tmp_path: Path) -> None:
    recipe = tmp_path / "egg.txt"
    recipe.write_text("//\nO\tegg\nM\tfry\nO\tegg\nS\tfried\n//\n" * 2)
    found, counts, units = foon_asp.lint(recipe), foon_asp.stats(recipe), foon_asp.stats(recipe, units=True)
    for result, words in ((found, ["lint"]), (counts, ["stats"]), (units, ["stats", "--units"])):
        assert result.text() == cli(*words, recipe).out
        assert result.csv() == cli(*words, recipe, "--format", "csv").out
        assert result.json() == cli(*words, recipe, "--format", "json").json
    merged = foon_asp.merge(recipe)
    assert merged.foon() == cli("merge", recipe).out
    store = tmp_path / "egg.foon"
    assert foon_asp.merge(tmp_path, store=store).json() == valid(merged.json())
    assert foon_asp.stats(store).json()["levels"] == counts.json()["levels"]
