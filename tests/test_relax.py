"""The delete relaxation of planning tasks, against an interpreter of PDDL that searches all states."""

import heapq
import importlib.util
import itertools
import json
import random
import re
import subprocess
import sys
from collections.abc import Iterator
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

import foon_asp
from foon_asp import RefusedError, UserError
from foon_asp.deadline import Deadline, LimitError
from foon_asp.engines import fast_downward
from foon_asp.planning.delete_relaxation import relaxed
from foon_asp.planning.pddl_reader import read_pddl
from foon_asp.planning.task_files import read_task
from tests.conftest import Cli
from tests.test_export import parsed

# --- PDDL as its text says: conditions are evaluated in a state, and a state only grows.

Fact = tuple[str, ...]
State = frozenset[tuple[bool, Fact]]  # what holds, and what does not: without deletes, both may


class Oracle:
    """A task that is interpreted; types have no subtypes here."""

    def __init__(self, domain: str, problem: str) -> None:
        self.domain, task = parsed(domain), parsed(problem)
        self.objects: dict[str, set[str]] = {}
        for form in (*self.domain[2:], *task[2:]):
            if form[0] in {":constants", ":objects"}:
                for name, kind in typed(form[1:]):
                    self.objects.setdefault(kind, set()).add(name)
                    self.objects.setdefault("object", set()).add(name)
        sections = {form[0]: form[1:] for form in task[2:]}
        self.goal = sections[":goal"][0]
        init = sections[":init"]
        self.start = frozenset(tuple(each) for each in init if each[0] != "=")
        self.values = {tuple(each[1]): Fraction(each[2]) for each in init if each[0] == "="}
        self.costed = ":metric" in sections

    def bindings(self, variables: list[Any]) -> Iterator[dict[str, str]]:
        listed = list(typed(variables))
        for objects in itertools.product(*(sorted(self.objects.get(kind, ())) for _, kind in listed)):
            yield {name: o for (name, _), o in zip(listed, objects, strict=True)}

    def holds(self, form: Any, state: State, wanted: bool = True) -> bool:
        """Whether a condition, or with ``wanted`` false its contrary, can be taken to hold."""
        head, *rest = form or ["and"]
        if head in {"not", "imply"}:
            parts = [["not", rest[0]], *rest[1:]]
            return self.holds(rest[0] if head == "not" else ["or", *parts], state, wanted == (head != "not"))
        if head in {"and", "or"}:
            found = [self.holds(each, state, wanted) for each in rest]
            return all(found) if (head == "and") == wanted else any(found)
        if head in {"forall", "exists"}:
            parts = [substituted(rest[1], binding) for binding in self.bindings(rest[0])]
            return self.holds(["and" if head == "forall" else "or", *parts], state, wanted)
        fact = tuple(form)
        if head == "=":
            return bool(fact[1] == fact[2]) == wanted
        return (wanted, fact) in state or (not wanted and fact not in self.start)

    def effects(self, form: Any, state: State) -> tuple[set[Fact], set[Fact], Fraction]:
        adds, deletes, cost = set[Fact](), set[Fact](), Fraction(0)
        head, *rest = form
        if head == "increase":
            value = rest[1]
            return adds, deletes, self.values[tuple(value)] if isinstance(value, list) else Fraction(value)
        if head == "not":
            return adds, {tuple(rest[0])}, cost
        if head == "and":
            parts = rest
        elif head == "forall":
            parts = [substituted(rest[1], binding) for binding in self.bindings(rest[0])]
        elif head == "when":
            parts = [rest[1]] if self.holds(rest[0], state) else []
        else:
            return {tuple(form)}, deletes, cost
        for part in parts:
            more, fewer, dearer = self.effects(part, state)
            adds, deletes, cost = adds | more, deletes | fewer, cost + dearer
        return adds, deletes, cost

    def best(self) -> Fraction | None:
        """Search all states for the cheapest way to the goal."""
        ground = []
        for form in self.domain[2:]:
            if form[0] == ":action":
                parts = dict(zip(form[2::2], form[3::2], strict=True))
                for binding in self.bindings(parts.get(":parameters", [])):
                    condition, effect = (
                        substituted(parts.get(key, []), binding) for key in (":precondition", ":effect")
                    )
                    ground.append((condition, effect))
        first: State = frozenset((True, fact) for fact in self.start)
        queue: list[tuple[Fraction, int, State]] = [(Fraction(0), 0, first)]
        known: dict[State, Fraction] = {first: Fraction(0)}
        count = itertools.count(1)
        while queue:
            cost, _, state = heapq.heappop(queue)
            if cost > known[state]:
                continue
            if self.holds(self.goal, state):
                return cost
            for condition, effect in ground:
                if self.holds(condition, state):
                    adds, deletes, more = self.effects(effect, state)
                    gained = {(True, fact) for fact in adds} | {(False, fact) for fact in deletes - adds}
                    after = state | gained
                    total = cost + (more if self.costed else 1)
                    if after != state and total < known.get(after, total + 1):
                        known[after] = total
                        heapq.heappush(queue, (total, next(count), after))
        return None


def typed(parts: list[str]) -> Iterator[tuple[str, str]]:
    waiting: list[str] = []
    rest = iter(parts)
    for part in rest:
        if part == "-":
            kind = next(rest)
            yield from ((name, kind) for name in waiting)
            waiting = []
        else:
            waiting.append(part)
    yield from ((name, "object") for name in waiting)


def substituted(form: Any, binding: dict[str, str]) -> Any:
    if isinstance(form, str):
        return binding.get(form, form)
    if form and form[0] in {"forall", "exists"}:
        binding = {name: o for name, o in binding.items() if name not in dict(typed(form[1]))}
        return [form[0], form[1], substituted(form[2], binding)]
    return [substituted(part, binding) for part in form]


def written(folder: Path, domain: str, problem: str) -> list[Path]:
    files = [folder / "domain.pddl", folder / "problem.pddl"]
    for file, text in zip(files, (domain, problem), strict=True):
        file.write_text(text, encoding="utf-8")
    return files


# --- random tasks

PREDICATES = {"p": 1, "q": 1, "r": 2, "s": 0, "k": 1}  # k is never changed


def random_task(random: random.Random) -> tuple[str, str]:
    """Make a small task with a bit of everything that is taken."""

    def term(variables: list[str]) -> str:
        return random.choice([*variables, *variables, "a"]) if variables else random.choice("ab")

    def atom(variables: list[str], names: str = "pqrsk") -> str:
        name = random.choice(names)
        return f"({' '.join([name, *(term(variables) for _ in range(PREDICATES[name]))])})"

    def condition(variables: list[str], depth: int) -> str:
        kind = random.choice("aaaan" if not depth else "aaanncdfeih=")
        if kind == "a":
            return atom(variables)
        if kind == "n":
            return f"(not {condition(variables, 0 if depth < 2 else depth - 1)})"
        if kind in "cd":
            parts = " ".join(condition(variables, depth - 1) for _ in range(random.randint(0, 3)))
            return f"({'and' if kind == 'c' else 'or'} {parts})"
        if kind == "i":
            return f"(imply {condition(variables, depth - 1)} {condition(variables, depth - 1)})"
        if kind == "=":
            return f"(= {term(variables)} {term(variables)})"
        variable = random.choice(["?x", "?z"])
        inner = condition([*variables, variable], depth - 1)
        return f"({'forall' if kind == 'f' else 'exists'} ({variable} - {random.choice(['t', 'u'])}) {inner})"

    def effect(variables: list[str]) -> str:
        kind = random.choice("aaaaddfw")
        if kind == "f":
            return f"(forall (?w - t) {effect([*variables, '?w'])})"
        if kind == "w":
            asked = random.choice(["(k {0})", "(not (k {0}))", "(= {0} b)"]).format(term(variables))
            return f"(when {asked} {effect(variables)})"
        return atom(variables, "pqrs") if kind == "a" else f"(not {atom(variables, 'pqrs')})"

    actions = []
    for number in range(random.randint(2, 5)):
        variables = ["?x", "?y"][: random.randint(0, 2)]
        parameters = " ".join(f"{name} - {random.choice(['t', 'u', 'object'])}" for name in variables)
        effects = " ".join(effect(variables) for _ in range(random.randint(1, 3)))
        cost = random.choice(["0", "1", "2.5", "(price)", f"(worth {term(variables)})", "3"])
        actions.append(
            f"(:action act{number} :parameters ({parameters}) "
            f":precondition {condition(variables, 2)} "
            f":effect (and {effects} (increase (total-cost) {cost})))"
        )
    domain = (
        "(define (domain d) (:requirements :adl :action-costs) (:types t u) (:constants a b - t) "
        "(:predicates (p ?x) (q ?x) (r ?x ?y) (s) (k ?x)) "
        f"(:functions (total-cost) (price) (worth ?x) - number) {' '.join(actions)})"
    )
    facts = {f"({' '.join([n, *(random.choice('abc') for _ in range(PREDICATES[n]))])})" for n in "pqrkkk"}
    values = " ".join(f"(= (worth {o}) {random.randint(0, 3)})" for o in "abc")
    metric = "(:metric minimize (total-cost))" * random.randint(0, 1)
    goal = f"(and {atom([], 'pqrs')} {condition([], 2)})"
    problem = (
        f"(define (problem e) (:domain d) (:objects c - u) "
        f"(:init {' '.join(sorted(facts))} (= (total-cost) 0) (= (price) 2) {values}) "
        f"(:goal {goal}) {metric})"
    )
    return domain, problem


@pytest.mark.parametrize(
    "seed", [*range(15), *(pytest.param(s, marks=pytest.mark.slow) for s in range(15, 400))]
)
def test_random_tasks_cost_what_a_search_of_all_states_finds(tmp_path: Path, seed: int) -> None:
    domain, problem = random_task(random.Random(seed))
    relaxed = foon_asp.relax(written(tmp_path, domain, problem))
    assert relaxed.proved
    assert relaxed.cost == Oracle(domain, problem).best(), domain + problem


# --- what is beyond, and what is wrong, is refused at its place

DOMAIN = """(define (domain d)
  (:requirements :strips :typing)
  (:types block)
  (:predicates (on ?x ?y - block) (free ?x - block))
  (:functions (total-cost) - number (weight ?x - block) - number)
  (:action put :parameters (?x ?y - block)
    :precondition (and (free ?x) (free ?y))
    :effect (and (on ?x ?y) (not (free ?y)) (increase (total-cost) 1))))
"""
PROBLEM = """(define (problem e) (:domain d)
  (:objects a b - block)
  (:init (free a) (free b) (= (total-cost) 0))
  (:goal (on a b)))
"""
DOMAIN_FAULTS = [
    (
        "(on ?x ?y) (not",
        "(when (free ?x) (on ?y ?x)) (not",
        "8:34: error: found an effect under the condition (free ?x)",
    ),
    ("(:action", "(:derived (on ?x ?y) (free ?x)) (:action", "6:3: error: found axioms (derived predicates)"),
    ("(:action", "(:durative-action", "6:3: error: found actions that take time"),
    (
        "(increase (total-cost) 1)",
        "(increase (weight ?x) 1)",
        "8:55: error: found numeric fluents (increase (weight",
    ),
    ("(increase (total-cost) 1)", "(assign (total-cost) 1)", "8:45: error: found numeric fluents (assign)"),
    ("(increase (total-cost) 1)", "(increase (total-cost) -1)", "expected a cost: a number from 0"),
    ("(free ?x) (free ?y))", "(> (weight ?x) 2))", "7:24: error: found numeric fluents (>)"),
    ("(free ?x) (free ?y))", "(= (weight ?x) 2))", "7:24: error: found numeric fluents (=)"),
    ("(free ?x) (free ?y))", "(free ?z))", "7:30: error: found '?z', which is no variable known here"),
    ("(free ?x) (free ?y))", "(free c))", "7:30: error: found 'c', which is no object known here"),
    ("(free ?x) (free ?y))", "(free ?x ?y))", "7:24: error: found (free ...) with 2 terms, expected 1"),
    (
        "(free ?x) (free ?y))",
        "(fre ?x))",
        "7:24: error: found (fre ...), expected a predicate that the domain",
    ),
    ("(free ?x) (free ?y))", "(not (free ?x) (free ?y)))", "(not ...) with 2 parts, expected 1"),
    ("?x ?y - block) (free", "?x ?y - blok) (free", "found the type 'blok'"),
    (":parameters", ":vars", "expected :parameters, :precondition and :effect once each"),
    ("1))))", "1)))))", "8:73: error: found ')', expected the end of the file"),
    ("1))))", "1)))", "1:1: error: found a ( that is never closed"),
    ("(define (domain", "(define (problem", "expected (define (domain NAME) ...)"),
    ("(:predicates", "(:what) (:predicates", "4:3: error: found (:what ...), expected one of"),
]
PROBLEM_FAULTS = [
    ("(= (total-cost) 0)", "(at 5 (free a))", "something that happens at a time"),
    ("(= (total-cost) 0)", "(= (weight a) x)", "expected a number"),
    ("(= (total-cost) 0)", "(on a c)", "3:34: error: found 'c', which is no object known here"),
    ("(:goal (on a b))", "(:goal (preference p (on a b)))", "found preferences"),
    ("(:goal (on a b))", "", "found no (:goal ...)"),
    ("(:goal (on a b))", "(:goal (on a b)) (:metric maximize (total-cost))", "found another metric"),
    ("(:goal (on a b))", "(:goal (on a b)) (:metric minimize (total-time))", "found another metric"),
    ("(:goal (on a b))", "(:goal (on a b)) (:constraints (always (free a)))", "constraints on trajectories"),
]


@pytest.mark.parametrize(
    ("text", "change", "words"),
    [
        *(("domain", fault[:2], fault[2]) for fault in DOMAIN_FAULTS),
        *(("problem", fault[:2], fault[2]) for fault in PROBLEM_FAULTS),
    ],
)
def test_what_is_beyond_or_wrong_is_refused_at_its_place(
    cli: Cli, tmp_path: Path, text: str, change: tuple[str, str], words: str
) -> None:
    texts = {"domain": DOMAIN, "problem": PROBLEM}
    assert change[0] in texts[text]
    texts[text] = texts[text].replace(*change, 1)
    ran = cli("relax", *written(tmp_path, texts["domain"], texts["problem"]))
    assert ran.code == 2
    assert f"{text}.pddl:" in ran.err
    assert words in ran.err


def test_conditions_that_nothing_changes_and_deletes_are_no_obstacle(tmp_path: Path) -> None:
    domain = DOMAIN.replace(
        "(not (free ?y))", "(when (free ?x) (not (free ?y))) (when (not (= ?x ?y)) (free ?x))"
    )
    assert foon_asp.relax(written(tmp_path, domain, PROBLEM)).plan == ("(put a b)",)


def test_a_condition_that_an_effect_changes_anything_is_none(tmp_path: Path) -> None:
    """As in the domain schedule: where it does not hold, the effect would change nothing."""
    domain = DOMAIN.replace("(on ?x ?y) (not (free ?y))", "(when (not (on ?x ?y)) (on ?x ?y))")
    assert foon_asp.relax(written(tmp_path, domain, PROBLEM)).plan == ("(put a b)",)
    other = DOMAIN.replace("(on ?x ?y) (not (free ?y))", "(when (not (on ?y ?x)) (on ?x ?y))")
    with pytest.raises(UserError, match="conditional effects are beyond"):
        foon_asp.relax(written(tmp_path, other, PROBLEM))


def test_a_variable_begins_a_word(tmp_path: Path) -> None:
    domain = DOMAIN.replace("(free ?x) (free ?y)", "(free?x) (free?y)").replace(
        "(on ?x ?y) (not", "(on?x?y) (not"
    )
    assert foon_asp.relax(written(tmp_path, domain, PROBLEM)).cost == 1


def test_a_delete_is_a_conditional_effect_where_its_contrary_is_asked_for(tmp_path: Path) -> None:
    domain = DOMAIN.replace("(not (free ?y))", "(when (free ?x) (not (free ?y)))")
    problem = PROBLEM.replace("(on a b)", "(not (free a))")
    with pytest.raises(UserError, match="conditional effects are beyond"):
        foon_asp.relax(written(tmp_path, domain, problem))


def test_too_many_ways_are_refused(tmp_path: Path) -> None:
    choice = "(or (free a) (on a b) (on b a))"
    problem = PROBLEM.replace(
        "(on a b)", f"(and {' '.join(choice.replace('free a', f'on a {x}') for x in 'ab')})"
    )
    assert foon_asp.relax(written(tmp_path, DOMAIN, problem)).cost == 1
    objects = " ".join(f"o{number}" for number in range(30))
    many = " ".join(f"(or (on o{n} o{n + 1}) (on o{n + 1} o{n}))" for n in range(20))
    problem = PROBLEM.replace("a b - block", f"{objects} a b - block").replace("(on a b)", f"(and {many})")
    with pytest.raises(UserError, match="more than 1000 ways to hold"):
        foon_asp.relax(written(tmp_path, DOMAIN, problem))


@pytest.mark.parametrize(
    ("goal", "code", "words"),
    [
        ("(and)", 0, "h+ = 0"),
        ("(free a)", 0, "h+ = 0"),
        ("(or (free a) (on a b))", 0, "h+ = 0"),
        ("(and (on a b) (on b a))", 0, "h+ = 2"),
        ("(forall (?x ?y - block) (on ?x ?y))", 0, "h+ = 4"),
        ("(exists (?x - block) (not (free ?x)))", 0, "h+ = 1"),
        ("(and (or) (free a))", 1, "no plan"),
        ("(= a b)", 1, "no plan"),
    ],
)
def test_goals_of_all_kinds(cli: Cli, tmp_path: Path, goal: str, code: int, words: str) -> None:
    files = written(tmp_path, DOMAIN, PROBLEM.replace("(on a b)", goal))
    ran = cli("relax", *files, "--certificate", tmp_path / "proof.json")
    assert ran.code == code, ran.out + ran.err
    assert words in ran.out
    verified = cli("verify", tmp_path / "proof.json", *files)
    assert verified.code == 0, verified.out + verified.err
    assert cli("verify", tmp_path / "proof.json", *written(tmp_path, DOMAIN, PROBLEM)).code == 1


def test_costs_and_types_and_capitals(tmp_path: Path) -> None:
    domain = """(DEFINE (domain D) ; a comment )
      (:types hard soft - thing thing little - object) (:constants ROCK - hard)
      (:predicates (held ?x - (either thing little)) (At ?x))
      (:functions (Total-Cost) (price ?x))
      (:action TAKE :parameters (?x - thing) :effect (and (HELD ?x) (increase (total-cost) (price ?x))))
      (:action pinch :parameters (?x - (either soft little)) :precondition ()
        :effect (and (held ?x) (increase (total-cost) 0.25)))
      (:action nothing :parameters () :effect ()))"""
    problem = """(define (problem e) (:domain d) (:objects wool - soft dust - little)
      (:init (= (price rock) 2) (= (PRICE wool) 1) (not (held rock)))
      (:goal (and (held Rock) (held WOOL) (held dust))) (:metric minimize (total-cost)))"""
    files = written(tmp_path, domain, problem)
    relaxed = foon_asp.relax(files)
    assert (relaxed.cost, relaxed.proved) == (Fraction(5, 2), True)
    assert sorted(relaxed.plan or ()) == ["(pinch dust)", "(pinch wool)", "(take rock)"]
    assert relaxed.pddl().endswith("; cost = 5/2 (general cost)\n")
    unpriced = problem.replace("(= (PRICE wool) 1)", "")
    with pytest.raises(UserError, match=r"the cost \(price wool\) of this action has no value"):
        foon_asp.relax(written(tmp_path, domain, unpriced))


# --- files of Fast Downward's translator

SAS = """begin_version
3
end_version
begin_metric
1
end_metric
2
begin_variable
var0
-1
2
Atom on(a, b)
NegatedAtom on(a, b)
end_variable
begin_variable
var1
-1
3
Atom at(a)
Atom at(b)
<none of those>
end_variable
1
begin_mutex_group
2
1 0
1 1
end_mutex_group
begin_state
1
0
end_state
begin_goal
1
0 0
end_goal
2
begin_operator
go a b
0
1
0 1 0 1
3
end_operator
begin_operator
put
1
1 1
1
0 0 -1 0
0
end_operator
0
"""


def test_a_task_of_the_translator(cli: Cli, tmp_path: Path) -> None:
    file = tmp_path / "output.sas"
    file.write_text(SAS)
    ran = cli("relax", file, "--format", "json", "--certificate", tmp_path / "proof.json")
    assert ran.json["cost"] == {"exact": "3", "approx": 3.0}
    assert [step["action"] for step in ran.json["plan"]] == ["(go a b)", "(put)"]
    assert cli("verify", tmp_path / "proof.json", file).code == 0
    file.write_text(SAS.replace("begin_metric\n1", "begin_metric\n0"))
    assert foon_asp.relax(file).cost == 2
    assert foon_asp.relax(file).task.facts[:3] == ["(on a b)", "(not (on a b))", "(at a)"]


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (("begin_version\n3", "begin_version\n2"), "2:1: error: found another version, expected 3"),
        (("var0\n-1", "var0\n0"), "found a variable that axioms set"),
        (("end_operator\n0\n", "end_operator\n1\nbegin_rule\n"), "found axioms"),
        (("1\n0 1 0 1\n3", "1\n1 0 0 1 0 1\n3"), "found an effect of (go a b) under a condition"),
        (("0 0 -1 0", "0 7 -1 0"), "found the value 0 of variable 7, which is not declared"),
        (("0 0 -1 0", "0 0 x 0"), "expected numbers"),
        (("1 1\n1\n0 0", "1\n1\n0 0"), "found 1 words, expected 2 numbers"),
        (("end_operator\n0\n", ""), "expected"),
    ],
)
def test_a_broken_task_of_the_translator_is_refused(
    cli: Cli, tmp_path: Path, change: tuple[str, str], words: str
) -> None:
    assert change[0] in SAS
    file = tmp_path / "output.sas"
    file.write_text(SAS.replace(*change))
    ran = cli("relax", file)
    assert ran.code == 2
    assert words in ran.err
    assert re.search(r"output.sas:\d+:1: error: ", ran.err)


def test_files_that_are_no_task(cli: Cli, tmp_path: Path) -> None:
    files = written(tmp_path, DOMAIN, PROBLEM)
    assert "expected DOMAIN.pddl PROBLEM.pddl" in cli("relax", files[0]).err
    assert "found 0 files" in cli("relax").err
    assert "found 3 files" in cli("relax", *files, files[0]).err
    assert cli("relax", *files, "--data", tmp_path).code == 2
    ran = cli("verify", tmp_path / "proof.json", *files, "--kitchen", tmp_path / "k")
    assert "found options for data beside a planning task" in ran.err


needs_translator = pytest.mark.skipif(
    importlib.util.find_spec("fast_downward") is None,
    reason="the translator of Fast Downward is not installed (pip install fast-downward-translate)",
)


def translated(folder: Path) -> Path:
    command = [sys.executable, "-m", "fast_downward.translate", "domain.pddl", "problem.pddl"]
    ran = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert ran.returncode == 0, ran.stdout + ran.stderr
    return folder / "output.sas"


@needs_translator
@pytest.mark.parametrize("goal", ["ice", pytest.param("greek salad", marks=pytest.mark.slow)])
def test_two_ways_of_grounding_cost_the_same(tmp_path: Path, goal: str) -> None:
    problem = foon_asp.load().problem(goal)
    foon_asp.export(problem, "inputs").write(tmp_path)
    ours = foon_asp.relax([tmp_path / "domain.pddl", tmp_path / "problem.pddl"])
    theirs = foon_asp.relax(translated(tmp_path))
    answer = foon_asp.solve(problem, "inputs").costs
    assert answer is not None
    assert ours.cost == theirs.cost == answer.inputs


@needs_translator
@pytest.mark.slow
@pytest.mark.parametrize("seed", range(60))
def test_random_tasks_without_negation_cost_the_same_translated(tmp_path: Path, seed: int) -> None:
    generator = random.Random(seed)
    facts = [f"f{number}" for number in range(10)]

    def some(most: int) -> str:
        return " ".join(f"(at {fact})" for fact in generator.sample(facts, generator.randint(1, most)))

    actions = "\n".join(
        f"(:action a{number} :parameters () :precondition (and {some(2)}) "
        f":effect (and {some(2)} (increase (total-cost) {generator.randint(0, 4)})))"
        for number in range(14)
    )
    domain = (
        "(define (domain d) (:requirements :action-costs) (:constants "
        f"{' '.join(facts)}) (:predicates (at ?x)) (:functions (total-cost) - number) {actions})"
    )
    problem = (
        f"(define (problem e) (:domain d) (:init {some(2)} (= (total-cost) 0)) (:goal (and {some(3)})) "
        "(:metric minimize (total-cost)))"
    )
    ours = foon_asp.relax(written(tmp_path, domain, problem))
    theirs = foon_asp.relax(translated(tmp_path))
    assert ours.cost == theirs.cost == Oracle(domain, problem).best()


# --- units without inputs


def bare_problem(seed: int) -> foon_asp.Problem:
    """Make a problem in which some units need nothing."""
    generator = random.Random(seed)
    nodes = [foon_asp.ObjectNode.of(f"o{number}") for number in range(9)]
    builder = foon_asp.NetworkBuilder()
    for number in range(14):
        inputs = generator.sample(nodes, generator.choice([0, 0, 1, 2, 2]))
        outputs = generator.sample(nodes, generator.choice([1, 1, 2]))
        builder.add(f"m{number}", inputs, outputs, foon_asp.Source("by hand", number))
    data = foon_asp.build(
        builder.build(), kitchen=nodes[:1], rates=dict.fromkeys(builder.build().motions, "0.9")
    )
    return data.problem(*generator.sample(nodes[1:], 2))


def cheapest(problem: foon_asp.Problem) -> int | None:
    """Try all sets of units, smallest first."""
    units = range(len(problem.network))
    for size in range(len(units) + 1):
        for tree in itertools.combinations(units, size):
            at_hand, left = set(problem.kitchen), list(tree)
            while ready := [unit for unit in left if at_hand.issuperset(problem.needs[unit])]:
                at_hand.update(*(problem.gives[unit] for unit in ready))
                left = [unit for unit in left if unit not in ready]
            if not left and at_hand.issuperset(problem.goals):
                return size
    return None


@pytest.mark.sampled(4)
@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("how", [{}, {"reductions": "none"}, {"reductions": "none", "encodings": "by_need"}])
def test_units_may_need_nothing(seed: int, how: dict[str, Any]) -> None:
    problem = bare_problem(seed)
    answer = foon_asp.solve(problem, **how)
    least = cheapest(problem)
    assert (None if answer.costs is None else answer.costs.units) == least
    if not how and least is not None:
        certified = foon_asp.certify(problem, "success")
        assert certified.certificate is not None
        assert foon_asp.verify(problem, certified.certificate).verified.claim == "optimal"
        assert answer.tree is not None
        assert foon_asp.check(problem, answer.tree).executes
        assert all(check.reason is None for check in foon_asp.cross_check(problem).checks) or (
            not fast_downward.installed()
        )


def test_a_certificate_of_another_cost_is_refused(tmp_path: Path) -> None:
    files = written(tmp_path, DOMAIN, PROBLEM)
    relaxed = foon_asp.relax(files, certificate_file=tmp_path / "proof.json")
    assert relaxed.certificate is not None
    content = json.loads((tmp_path / "proof.json").read_text())
    content["tree"] = []
    (tmp_path / "proof.json").write_text(json.dumps(content))
    with pytest.raises(RefusedError):
        foon_asp.verify(relaxed.problem, tmp_path / "proof.json")


def test_the_search_ends_when_the_cost_is_proved(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    free = "(:action loose :parameters (?x - block) :effect (and (free ?x) (increase (total-cost) 0)))"
    domain = DOMAIN.rstrip()[:-1] + free + ")"
    metric = PROBLEM.rstrip()[:-1] + "(:metric minimize (total-cost)))"
    relaxed = foon_asp.relax(written(tmp_path, domain, metric))
    assert relaxed.cost == 1
    assert relaxed.proved


def test_advice_at_a_limit_is_about_the_task(tmp_path: Path) -> None:
    domain, problem = tmp_path / "domain.pddl", tmp_path / "task.pddl"
    domain.write_text(
        "(define (domain d) (:predicates (p ?x)) (:action a :parameters (?x) :effect (p ?x)))",
        encoding="utf-8",
    )
    problem.write_text(
        "(define (problem t) (:domain d) (:objects o) (:init) (:goal (p o)))", encoding="utf-8"
    )
    assert len(read_task([domain, problem], Deadline()).actions) == 1
    with pytest.raises(LimitError) as reading:
        read_task([domain, problem], Deadline(1e-9))
    with pytest.raises(LimitError) as grounding:
        relaxed(read_pddl(domain, problem), Deadline(1e-9))
    assert reading.value.stopped.endswith("while reading the task")
    assert grounding.value.stopped.endswith("while grounding the task")
    assert [each.value.advice for each in (reading, grounding)] == ["raise the limit"] * 2
