"""Planning tasks in PDDL, read here by a reader of their own, and plans of planners read back."""

import importlib.util
import json
import re
import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any, NamedTuple

import pytest

import foon_asp
from foon_asp import Foon, FunctionalUnit, Problem, Source, UserError
from foon_asp.engines import fast_downward
from foon_asp.planning.name_map import Scale
from foon_asp.planning.pddl_name import pddl_name
from foon_asp.problem import Number
from tests.conftest import Cli
from tests.oracle.used_up import random_problem

ADDING = ("units", "inputs", "inputs+ingredients", "attempts", "kitchen", "price")

Fact = tuple[str, ...]


def parsed(text: str) -> Any:
    """Read PDDL as nested lists: not with the reader that is tested elsewhere."""
    tokens = re.findall(r"[()]|[^\s()]+", re.sub(";.*", "", text))
    stack: list[list[Any]] = [[]]
    for token in tokens:
        if token == "(":
            stack.append([])
        elif token == ")":
            stack[-2].append(stack.pop())
        else:
            stack[-1].append(token)
    assert len(stack) == 1
    return stack[0][0]


def part(form: Any, name: str) -> Any:
    """Give the one part of a list that begins with a word."""
    (found,) = [each for each in form if isinstance(each, list) and each[0] == name]
    return found[1:]


def actions(domain: Any) -> dict[str, tuple[set[str], set[str], int]]:
    """Give what each action needs, gives and costs."""
    found = {}
    for each in domain:
        if isinstance(each, list) and each[0] == ":action":
            name, _, parameters, _, needs, _, effects = each[1:]
            assert parameters == []
            costs = [int(effect[2]) for effect in effects[1:] if effect[0] == "increase"]
            gives = {effect[1] for effect in effects[1:] if effect[0] == "at-hand"}
            assert len(gives) + len(costs) == len(effects) - 1
            assert name not in found
            found[name] = {need[1] for need in needs[1:]}, gives, (costs or [1])[0]
    return found


@pytest.fixture(scope="module")
def foon() -> Foon:
    kitchen = foon_asp.load()
    motions = sorted(set(kitchen.network.motions))
    prices: dict[str | FunctionalUnit, Number] = {
        motion: Fraction(number % 7, 4) for number, motion in enumerate(motions)
    }
    rates = {motion: Fraction(number % 3 + 1, 4) for number, motion in enumerate(motions)}
    return kitchen.vary(unit_prices=prices, rates=rates)


@pytest.mark.parametrize("containers", ["strict", "implied"])
@pytest.mark.parametrize("whole", [False, True])
def test_the_task_is_the_network(foon: Foon, containers: str, whole: bool) -> None:
    problem = foon.problem("greek salad", containers=containers)
    exported = foon_asp.export(problem, every_unit=whole)
    domain, task = parsed(exported.domain_file), parsed(exported.problem_file)
    found = actions(domain)
    names = {each.name: each.object.id or 0 for each in exported.name_map.objects}
    units = {each.name: each.unit.id for each in exported.name_map.actions if each.unit}
    network = problem.network
    assert len(found) == len(network) if whole else 0 < len(found) < len(network)
    constants = {each for each in part(domain, ":constants") if each not in {"-", "item"}}
    assert constants == {name for name in names if not name.startswith("unused")}
    assert all(re.fullmatch(r"[a-z][a-z0-9-]*", name) for name in {*constants, *found})
    for name, (needs, gives, _) in found.items():
        unit = units[name]
        assert name.startswith(f"u{unit}-")
        assert {names[each] for each in needs} == {*problem.needs[unit or 0]}
        assert {names[each] for each in gives} == {*problem.gives[unit or 0]}
    start = {each[1] for each in part(task, ":init")}
    assert start == {each for each in constants if names[each] in problem.kitchen}
    ((_, *goals),) = part(task, ":goal")
    assert [names[goal] for _, goal in goals] == list(problem.goals)


@pytest.mark.parametrize("objective", ADDING)
def test_costs_are_those_of_trees_times_the_factor(foon: Foon, objective: str) -> None:
    problem = foon.problem("macaroni")
    exported = foon_asp.export(problem, objective)
    (scale,) = exported.name_map.scales
    answer = foon_asp.solve(problem, objective)
    assert answer.costs is not None
    names = {action.unit: action.name for action in exported.task.actions if action.unit is not None}
    taken = {o for unit in answer.ids or () for o in problem.needs[unit] if o in problem.kitchen}
    plan = [names[unit] for unit in answer.ids or ()]
    plan += [action.name for action in exported.task.actions if action.item in taken]
    found = actions(parsed(exported.domain_file))
    assert not scale.rounded
    least = answer.costs.measure(foon_asp.Objective(objective)) * Fraction(scale.factor)
    assert sum(found[name][2] for name in plan) == least
    bought = {o for action in exported.task.actions if action.item is not None for o in found[action.name][1]}
    init = part(parsed(exported.problem_file), ":init")
    assert bought.isdisjoint(each[1] for each in init if each[0] == "at-hand")


def test_of_several_objectives_the_first_counts_most(foon: Foon) -> None:
    problem = foon.problem("macaroni")
    exported = foon_asp.export(problem, "price,units")
    price, units = (Fraction(scale.factor) for scale in exported.name_map.scales)
    assert units == 1
    assert price > len(exported.task.actions)
    for action in exported.task.actions:
        assert action.unit is not None
        assert action.cost == price * problem.price(action.unit) + 1


def test_success_is_rounded_and_said_to_be(foon: Foon, cli: Cli, tmp_path: Path) -> None:
    exported = foon_asp.export(foon_asp.load().problem("ice"), "success")
    assert exported.name_map.scales == (Scale(foon_asp.Objective.SUCCESS, "1000000", True),)
    assert "; " in exported.domain_file
    assert "rounded" in exported.domain_file
    assert {action.cost for action in exported.task.actions} >= {356675}  # -ln of 7/10
    ran = cli("export", "--goal", "ice", "--objective", "success", "-o", tmp_path / "task")
    assert "rounded" in ran.out


def test_fractions_with_too_many_digits_are_rounded_and_said_to_be() -> None:
    problem = foon_asp.load().problem("greek salad")
    exported = foon_asp.export(problem, "attempts")
    (scale,) = exported.task.costs.scales
    assert scale.rounded
    assert "rounded" in exported.domain_file
    for action in exported.task.actions:
        assert action.unit is not None
        assert abs(action.cost - scale.factor / problem.rate(action.unit)) <= Fraction(1, 2)
    assert sum(action.cost for action in exported.task.actions) < 2**31


def test_what_cannot_be_added_up_is_refused(foon: Foon) -> None:
    ice = foon.problem("ice")
    used_up = replace(ice, items=foon_asp.UsedUp())
    wrong: list[tuple[Problem, dict[str, Any], str]] = [
        (foon.problem("macaroni"), {"objectives": "inputs,price,success"}, "planners add up"),
        (
            replace(ice, rates={**(ice.rates or {}), "crush": Fraction(0)}),
            {"objectives": "success"},
            "never succeeds",
        ),
        (used_up, {"objectives": "inputs,units"}, "by one objective"),
        (used_up, {"items": "lasting"}, "found items='lasting', but the problem is posed with strict"),
        (ice, {"items": "set"}, "found items='set', but the problem is posed with strict containers"),
        (ice, {"target": "anml"}, "expected pddl"),
    ]
    for problem, asked, words in wrong:
        with pytest.raises(UserError, match=words):
            foon_asp.export(problem, **asked)


@pytest.mark.parametrize(
    ("words", "name"),
    [
        ("pour", "u7-pour"),
        ("Crème brûlée; in [pot]", "u7-creme-brulee-in-pot"),
        ("日本茶", "u7"),
        ("a) (b ; c\n", "u7-a-b-c"),
        ("--", "u7"),
        ("x" * 200, "u7-" + "x" * 60),
    ],
)
def test_names_are_valid_whatever_things_are_called(words: str, name: str) -> None:
    assert pddl_name("u", 7, words) == name


def strange() -> Problem:
    """Give a problem whose names are no names of PDDL, and differ in capitals or at the end alone."""
    builder = foon_asp.NetworkBuilder()
    water, Water, long_ = (  # noqa: N806
        foon_asp.ObjectNode.of(name) for name in ("wa(t)er; ;\n)", "WA(T)ER; ;\n)", "x" * 300)
    )
    longer = foon_asp.ObjectNode.of("x" * 301)
    builder.add("(and", [water], [Water], Source("f", 1))
    builder.add("(AND", [Water], [long_], Source("f", 2))
    builder.add("", [long_], [longer], Source("f", 3))
    return foon_asp.build(builder.build(), kitchen=[water]).problem(longer)


def test_strange_names_make_a_task_and_come_back(tmp_path: Path) -> None:
    problem = strange()
    exported = foon_asp.export(problem)
    assert [*actions(parsed(exported.domain_file))] == ["u0-and", "u1-and", "u2"]
    exported.write(tmp_path)
    (tmp_path / "plan").write_text("(U0-AND )\n(u1-and)\n(u2)\n")
    read = foon_asp.read_plan(problem, tmp_path / "plan", names=tmp_path / "map.json")
    assert read.sound
    assert [unit.motion for unit in read.tree] == ["(and", "(AND", ""]


PLANS = {
    "Fast Downward": "(a)\n(b)\n; cost = 2 (unit cost)\n",
    "pyperplan": "(a )\n(b )\n",
    "IPC": "; Time 0.02\n0: (A)\n1: (B)\n",
    "with times": "0.000: (a) [1.000]\n1.00100: (b) [1.000]\n\n",
    "FF": "step    0: A\n        1: B\n",
    "log of Metric-FF": """
ff: parsing domain file
domain 'FOON' defined
 ... done.
Cueing down from goal distance:    2 into depth [1]
                                   1            [1]
                                   0

ff: found legal plan as follows

step    0: A
        1: B

plan cost: 2.000000

time spent:    0.00 seconds instantiating 5 easy, 0 hard action templates
               0.00 seconds total time
""",
    "log of Fast Downward": """INFO     Running translator.
Parsing...
Translator variables: 2
INFO     Running search (release).
[t=0.000129s, 10280 KB] reading input...
[t=0.001500s, 10412 KB] Solution found!
[t=0.001510s, 10412 KB] Actual search time: 0.000170s
b  (9)
[t=0.001520s, 10412 KB] Plan length: 1 step(s).
[t=0.001659s, 10412 KB] Solution found!
[t=0.001674s, 10412 KB] Actual search time: 0.000177s
a  (3)
[t=0.001680s, 10412 KB] b  (3)
[t=0.001689s, 10412 KB] Plan length: 2 step(s).
[t=0.001689s, 10412 KB] Plan cost: 6
Solution found.
search exit code: 0
""",
    "log of an older Fast Downward": """Simplifying... done!
Solution found!
Actual search time: 0s [t=0s]
a (1)
b (1)
Plan length: 2 step(s).
Plan cost: 2
Solution found.
""",
    "unified-planning": "SequentialPlan:\n    a\n    b\n",
    "unified-planning, older": "a()\r\nb()\r\n",
}


@pytest.fixture
def folder(foon: Foon, tmp_path: Path) -> Path:
    foon_asp.export(foon.problem("ice")).write(tmp_path)
    return tmp_path


STEPS = ("u26-twist", "u27-crush")


@pytest.mark.parametrize("planner", PLANS)
def test_plans_of_all_kinds_are_read(folder: Path, foon: Foon, planner: str) -> None:
    text = PLANS[planner]
    for letter, name in zip("ab", STEPS, strict=True):
        text = re.sub(rf"(?<![\w]){letter}(?![\w])", name, text)
        text = re.sub(rf"(?<![\w]){letter.upper()}(?![\w])", name.upper(), text)
    (folder / "plan").write_bytes(text.encode())
    problem = foon.problem("ice")
    read = foon_asp.read_plan(problem, folder / "plan", names=folder / "map.json")
    assert read.sound
    assert [unit.motion for unit in read.tree] == ["twist", "crush"]
    assert foon_asp.check(problem, read.tree).executes


@pytest.mark.parametrize(
    ("text", "place", "words"),
    [
        ("(u26-twist)\n(u27-crash)\n", "2:2", "expected an action of the map, such as u27-crush"),
        ("(u26-twist)\n  nothing to do\n", "2:3", "expected a step of a plan"),
        ("(u26-twist\n", "1:1", "expected a step of a plan"),
        ("(u26-twist) (u27-crush)\n", "1:1", "expected a step of a plan"),
        ("Solution found!\nu26-twist (1)\n", "1:1", "a log that ends in the middle of this plan"),
        ("Solution found!\nu26-twist (1)\nPlan length: 2 step(s).\n", "3:1", "expected 2"),
        (
            "Solution found!\n[t=0s, 9 KB] u27-crash (1)\nPlan length: 1 step(s).\n",
            "2:14",
            "such as u27-crush",
        ),
        ("Reading\n[t=0s] Completely explored state space -- no solution!\n", "2:1", "without a plan in it"),
        ("ff: goal can be simplified to FALSE. No plan will solve it\n", "1:1", "without a plan in it"),
    ],
)
def test_lines_that_are_no_steps_are_errors(
    folder: Path, cli: Cli, text: str, place: str, words: str
) -> None:
    (folder / "plan").write_text(text)
    ran = cli("read-plan", folder / "plan", "--map", folder / "map.json")
    assert ran.code == 2
    assert f"plan:{place}: error: " in ran.err
    assert words in ran.err


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("(u27-crush)\n(u26-twist)\n", "plan:1]"),
        ("; nothing\n(u27-crush)\n", "plan:2]"),
        ("(u26-twist)\n", "the goal is not made"),
        ("", "the goal is not made"),
    ],
)
def test_a_broken_plan_is_refused_with_its_line(folder: Path, cli: Cli, text: str, words: str) -> None:
    (folder / "plan").write_text(text)
    ran = cli("read-plan", folder / "plan", "--map", folder / "map.json")
    assert ran.code == 1
    assert ran.out.startswith("refused: ")
    assert words in ran.out
    ran = cli("read-plan", folder / "plan", "--map", folder / "map.json", "--format", "foon")
    assert (ran.code, ran.out) == (1, "")
    assert "refused" in ran.err


def test_a_plan_that_repeats_itself_is_a_tree(folder: Path, foon: Foon, cli: Cli) -> None:
    (folder / "plan").write_text("(u26-twist)\n(u26-twist)\n(u27-crush)\n")
    read = foon_asp.read_plan(foon.problem("ice"), folder / "plan", names=folder / "map.json")
    assert read.sound
    assert len(read.tree) == 2
    ran = cli("read-plan", folder / "plan", "--map", folder / "map.json", "--format", "foon")
    (folder / "tree.txt").write_text(ran.out)
    assert cli("check", folder / "tree.txt", "--goal", "ice").code == 0


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda m: m.update(schema="foon-asp/answer/1"), "its schema is not"),
        (lambda m: m.pop("actions"), "'actions' is missing"),
        (lambda m: m["objects"].clear(), "is missing"),
        (lambda m: m.update(actions=[1]), "but"),
        (lambda m: m.update(level=2), "about level 2"),
    ],
)
def test_a_map_that_is_none_is_refused(
    folder: Path, cli: Cli, change: Callable[[Any], Any], words: str
) -> None:
    file = folder / "map.json"
    content = json.loads(file.read_text())
    change(content)
    (folder / "plan").write_text("(u26-twist)\n")
    for text, said in (
        (json.dumps(content), words),
        ('{\n"schema": 1,\n}\n', f"{file}:2:12: error: not JSON"),
    ):
        file.write_text(text)
        ran = cli("read-plan", folder / "plan", "--map", file)
        assert ran.code == 2
        assert said in ran.err
        assert "map.json" in ran.err


# --- Items that are used up.


class Step(NamedTuple):
    """An action: what has to be there (and how often), what it sets, what it adds up, and its cost."""

    needs: list[Fact]
    least: list[tuple[Fact, int]]
    sets: dict[Fact, bool]
    adds: dict[Fact, int]
    cost: int


State = tuple[frozenset[Fact], frozenset[tuple[Fact, int]]]


def conditions(form: Any) -> tuple[list[Fact], list[tuple[Fact, int]]]:
    parts = [each for each in form[1:] if each]
    counts = [(tuple(each[1]), int(each[2])) for each in parts if each[0] == ">="]
    return [tuple(each) for each in parts if each[0] != ">="], counts


def steps_of(domain: Any) -> dict[str, Step]:
    found = {}
    for each in domain:
        if isinstance(each, list) and each[0] == ":action":
            name, _, _, _, needs, _, effects = each[1:]
            step = Step(*conditions(needs), {}, {}, 1)
            for effect in effects[1:]:
                if effect[0] in {"increase", "decrease"}:
                    sign = 1 if effect[0] == "increase" else -1
                    if effect[1] == ["total-cost"]:
                        step = step._replace(cost=int(effect[2]))
                    else:
                        step.adds[tuple(effect[1])] = sign * int(effect[2])
                else:
                    step.sets[tuple(effect[-1]) if effect[0] == "not" else tuple(effect)] = effect[0] != "not"
            found[name] = step
    return found


def cheapest(exported: foon_asp.Exported, longest: int) -> tuple[int, list[str]] | None:
    """Find the cheapest plan of a task up to a length, state by state."""
    task, steps = parsed(exported.problem_file), steps_of(parsed(exported.domain_file))
    facts = [each for each in part(task, ":init") if each[0] != "="]
    numbers = {tuple(each[1]): int(each[2]) for each in part(task, ":init") if each[0] == "="}
    (goal,) = part(task, ":goal")

    def holds(state: State, condition: tuple[list[Fact], list[tuple[Fact, int]]]) -> bool:
        counts = dict(state[1])
        return state[0].issuperset(condition[0]) and all(counts[o] >= n for o, n in condition[1])

    first = frozenset(map(tuple, facts)), frozenset(numbers.items())
    layer: dict[State, tuple[int, list[str]]] = {first: (0, [])}
    best: tuple[int, list[str]] | None = None
    for _ in range(longest + 1):
        following: dict[State, tuple[int, list[str]]] = {}
        for state, (cost, plan) in layer.items():
            if holds(state, conditions(goal)):
                best = min(best or (cost, plan), (cost, plan))
                continue
            for name, step in steps.items():
                if holds(state, (step.needs, step.least)):
                    there = {fact for fact in state[0] if step.sets.get(fact, True)}
                    there.update(fact for fact, holds_now in step.sets.items() if holds_now)
                    counts = {o: n + step.adds.get(o, 0) for o, n in state[1]}
                    new = frozenset(there), frozenset(counts.items())
                    reached = cost + step.cost, [*plan, name]
                    following[new] = min(following.get(new, reached), reached)
        layer = following
    return best


@pytest.mark.parametrize("seed", range(12))
def test_plans_of_tasks_in_which_items_are_used_up(tmp_path: Path, seed: int) -> None:
    problem = random_problem(seed)
    ours = foon_asp.solve(problem, "inputs").costs
    costs = {}
    for items in ("used-up", "set"):
        exported = foon_asp.export(problem, "inputs", items=items)
        found = cheapest(exported, 6)
        costs[items] = found and found[0]
        if found is not None:
            (tmp_path / "plan").write_text("".join(f"({name})\n" for name in found[1]))
            read = foon_asp.read_plan(problem, tmp_path / "plan")
            assert read.sound
            assert foon_asp.check(problem, read.tree).executes
            assert sum(len(set(unit.inputs)) for unit in read.tree) == costs[items]
    if ours is None:
        assert costs == {"used-up": None, "set": None}
    else:
        assert ours.units > 6 or costs["used-up"] == ours.inputs
        assert costs["set"] is None or costs["set"] >= ours.inputs


def test_copies_that_are_merged_may_cost_more_or_leave_no_plan() -> None:
    builder = foon_asp.NetworkBuilder()
    egg, cup, cake, dough = map(foon_asp.parse_node, ("egg", "cup", "cake", "dough"))
    builder.add("lay", [cup], [egg], Source("f", 1))
    builder.add("beat", [egg], [dough], Source("f", 2))
    builder.add("bake", [dough, egg], [cake], Source("f", 3))
    data = foon_asp.build(builder.build(), kitchen=[cup])
    problem = data.problem(cake, items="used-up", stock={cup: 2})
    assert foon_asp.solve(problem).costs.units == 4  # type: ignore[union-attr]
    assert (cheapest(foon_asp.export(problem), 6) or [0])[0] == 4
    merged = foon_asp.export(problem, items="set")
    assert "the copies of a node are merged" in merged.domain_file
    assert cheapest(merged, 6) is None


def test_a_plan_for_items_that_are_used_up_goes_there_and_back(cli: Cli, tmp_path: Path) -> None:
    (tmp_path / "stays.txt").write_text("knife\tstays\n", encoding="utf-8")
    words = ("--goal", "greek salad", "--items", "used-up", "--stays", tmp_path / "stays.txt")
    for items in ("used-up", "set"):
        ran = cli("export", *words[:3], items, *words[4:], "-o", tmp_path / items)
        assert ran.code == 0
        assert ("copies are counted" if items == "used-up" else "merged") in ran.out
    answer = json.loads(cli("solve", *words, "--format", "json").out)
    names = {
        each["unit"]["id"]: each["name"]
        for each in json.loads((tmp_path / "used-up" / "map.json").read_text())["actions"]
    }
    plan = [names[step["id"]] for step in answer["units"]]
    (tmp_path / "plan").write_text("".join(f"({name})\n" for name in plan))
    asked = ("read-plan", tmp_path / "plan", "--map", tmp_path / "used-up" / "map.json")
    assert cli(*asked).out.startswith(
        f"executes as listed (strict containers, items used up)\n{len(plan)} units"
    )
    assert json.loads(cli(*asked, "--format", "json").out)["sound"]
    (tmp_path / "plan").write_text("".join(f"({name})\n" for name in plan[1:]))
    ran = cli(*asked)
    assert ran.code == 1
    assert ran.out.startswith("refused: does not execute")


def planned(problem: Problem, objective: str, folder: Path, run: Callable[[Path], str]) -> Fraction | int:
    """Let a planner find a plan, read it back, and give what it costs; it has to execute."""
    exported = foon_asp.export(problem, objective)
    exported.write(folder)
    (folder / "plan").write_text(run(folder))
    read = foon_asp.read_plan(problem, folder / "plan", names=folder / "map.json")
    assert read.sound, str(read)
    assert foon_asp.check(problem, read.tree).executes
    ids = [problem.network.unit_id(unit) for unit in read.tree]
    return problem.costs(unit for unit in ids if unit is not None).measure(foon_asp.Objective(objective))


def with_fast_downward(folder: Path) -> str:
    program = fast_downward.driver_script()
    assert program is not None
    files = (str(folder / name) for name in ("domain.pddl", "problem.pddl"))
    command = [sys.executable, str(program), "--plan-file", str(folder / "sas_plan"), *files]
    ran = subprocess.run(
        [*command, "--search", "astar(lmcut())"], cwd=folder, capture_output=True, text=True, check=False
    )
    assert ran.returncode == 0, ran.stdout + ran.stderr
    return (folder / "sas_plan").read_text()


def with_pyperplan(folder: Path) -> str:
    module = importlib.import_module("pyperplan.planner")
    steps = module.search_plan(
        str(folder / "domain.pddl"),
        str(folder / "problem.pddl"),
        module.SEARCHES["astar"],
        module.HEURISTICS["lmcut"],
    )
    return "\n".join(step.name for step in steps)


needs_fast_downward = pytest.mark.skipif(
    not fast_downward.is_installed(), reason="Fast Downward is not installed (foon-asp[cross-check])"
)
needs_pyperplan = pytest.mark.skipif(
    importlib.util.find_spec("pyperplan") is None, reason="pyperplan is not installed (pip install pyperplan)"
)


@needs_fast_downward
@pytest.mark.parametrize("objective", ADDING)
def test_fast_downward_finds_our_costs(foon: Foon, tmp_path: Path, objective: str) -> None:
    problem = foon.problem("macaroni", containers="implied")
    ours = foon_asp.solve(problem, objective).costs
    assert ours is not None
    cost = planned(problem, objective, tmp_path, with_fast_downward)
    assert cost == ours.measure(foon_asp.Objective(objective))


@pytest.mark.slow
@needs_fast_downward
@pytest.mark.parametrize(("objective", "containers"), [("inputs", "implied"), ("attempts", "strict")])
def test_fast_downward_finds_our_costs_for_all_goals(tmp_path: Path, objective: str, containers: str) -> None:
    data = foon_asp.load()
    for goal in map(str, data.goals):
        problem = data.problem(goal, containers=containers)
        ours = foon_asp.solve(problem, objective).costs
        if ours is not None:
            cost = planned(problem, objective, tmp_path, with_fast_downward)
            assert cost == ours.measure(foon_asp.Objective(objective)), goal


@needs_pyperplan
def test_pyperplan_finds_our_costs(foon: Foon, tmp_path: Path) -> None:
    problem = foon.problem("ice")
    ours = foon_asp.solve(problem).costs
    assert ours is not None
    assert planned(problem, "units", tmp_path, with_pyperplan) == ours.units


@pytest.mark.parametrize(
    "planner",
    [
        pytest.param(with_fast_downward, marks=needs_fast_downward),
        pytest.param(with_pyperplan, marks=needs_pyperplan),
    ],
)
def test_planners_find_plans_that_run(planner: Callable[[Path], str], tmp_path: Path) -> None:
    problem = foon_asp.load().problem("ice", items="used-up")
    ours = foon_asp.solve(problem).costs
    assert ours is not None
    foon_asp.export(problem, items="set").write(tmp_path)
    (tmp_path / "plan").write_text(planner(tmp_path))
    read = foon_asp.read_plan(problem, tmp_path / "plan", names=tmp_path / "map.json")
    assert read.sound
    assert len(read.tree) >= ours.units


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::foon_asp.FoonWarning")
@needs_fast_downward
def test_fast_downward_finds_our_costs_on_the_real_network(universal: Path, tmp_path: Path) -> None:
    data = foon_asp.load(universal)
    for goal in map(str, data.goals):
        for containers in ("strict", "implied"):
            problem = data.problem(goal, containers=containers)
            ours = foon_asp.solve(problem).costs
            if ours is not None:
                assert planned(problem, "units", tmp_path, with_fast_downward) == ours.units, goal
