"""The delete relaxation of planning tasks, against an interpreter of PDDL that searches all states."""

import heapq
import itertools
import json
import random
import re
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

import foon_asp
from foon_asp import RefusedError
from foon_asp.deadline import Deadline, LimitError
from foon_asp.engines import fast_downward
from foon_asp.planning import translator
from foon_asp.planning.task_files import read_task
from tests.conftest import Cli
from tests.oracle import task_trees
from tests.planning.test_export import parsed

needs_translator = pytest.mark.skipif(
    not translator.is_installed(), reason="Fast Downward's translator is not installed (foon-asp[pddl])"
)

# --- PDDL as its text says: conditions are evaluated in a state, and a state only grows.

Fact = tuple[str, ...]
Literal = tuple[bool, Fact]
Clause = frozenset[Literal]
State = frozenset[Literal]  # what holds, and what does not: without deletes, both may


def consistent(clause: Clause) -> bool:
    return not any((not holds, fact) in clause for holds, fact in clause)


class Oracle:
    """A task that is interpreted; types have no subtypes here.

    Conditions are disjunctions of clauses, in which nothing holds and does not; a condition about all objects
    is a literal of its own in these.
    """

    def __init__(self, domain: str, problem: str) -> None:
        self.domain, task = parsed(domain), parsed(problem)
        self.objects: dict[str, set[str]] = {}
        for form in (*self.domain[2:], *task[2:]):
            if form[0] in {":constants", ":objects"}:
                for name, kind in typed(form[1:]):
                    self.objects.setdefault(kind, set()).add(name)
                    self.objects.setdefault("object", set()).add(name)
        sections = {form[0]: form[1:] for form in task[2:]}
        init = sections[":init"]
        self.start = frozenset(tuple(each) for each in init if each[0] != "=")
        self.values = {tuple(each[1]): Fraction(each[2]) for each in init if each[0] == "="}
        self.costed = ":metric" in sections
        self.about_all: dict[Fact, tuple[Any, bool]] = {}
        self.goal = self.clauses(sections[":goal"][0])

    def bindings(self, variables: list[Any]) -> Iterator[dict[str, str]]:
        listed = list(typed(variables))
        for objects in itertools.product(*(sorted(self.objects.get(kind, ())) for _, kind in listed)):
            yield {name: o for (name, _), o in zip(listed, objects, strict=True)}

    def clauses(self, form: Any, wanted: bool = True) -> list[Clause]:  # noqa: PLR0911
        """What makes a condition hold, or with ``wanted`` false its contrary."""
        head, *rest = form or ["and"]
        if head in {"not", "imply"}:
            form = ["or", ["not", rest[0]], rest[1]] if head == "imply" else rest[0]
            return self.clauses(form, wanted == (head == "imply"))
        if head in {"forall", "exists"}:
            parts = [substituted(rest[1], binding) for binding in self.bindings(rest[0])]
            form = ["and" if head == "forall" else "or", *parts]
            if (head == "exists") == wanted:
                return self.clauses(form, wanted)
            key = (repr(form), str(wanted))
            self.about_all[key] = (form, wanted)
            return [frozenset({(True, key)})]
        if head in {"and", "or"}:
            found = [self.clauses(each, wanted) for each in rest]
            if (head == "and") != wanted:
                return [clause for each in found for clause in each]
            joined = (frozenset[Literal]().union(*each) for each in itertools.product(*found))
            return [clause for clause in joined if consistent(clause)]
        if head == "=":
            return [frozenset()] if (rest[0] == rest[1]) == wanted else []
        return [frozenset({(wanted, tuple(form))})]

    def holds(self, clause: Clause, state: State) -> bool:
        return all(self.literal_holds(literal, state) for literal in clause)

    def literal_holds(self, literal: Literal, state: State) -> bool:
        wanted, fact = literal
        if fact in self.about_all:
            form, how = self.about_all[fact]
            parts = [self.clauses(each, how == wanted) for each in form[1:]]
            each_holds = [any(self.holds(clause, state) for clause in part) for part in parts]
            return all(each_holds) if wanted else any(each_holds)
        return literal in state or (not wanted and fact not in self.start)

    def effects(self, form: Any, clause: Clause) -> Iterator[tuple[Clause, Literal]]:
        head, *rest = form or ["and"]
        if head == "and":
            parts = rest
        elif head == "forall":
            parts = [substituted(rest[1], binding) for binding in self.bindings(rest[0])]
        elif head == "when":
            for each in self.clauses(rest[0]):
                if consistent(clause | each):
                    yield from self.effects(rest[1], clause | each)
            return
        elif head != "increase":
            yield clause, (head != "not", tuple(rest[0] if head == "not" else form))
            return
        else:
            return
        for part in parts:
            yield from self.effects(part, clause)

    def cost(self, form: Any) -> Fraction:
        if not self.costed:
            return Fraction(1)
        values = [part[2] for part in form[1:] if part[0] == "increase"]
        found = (self.values[tuple(each)] if isinstance(each, list) else Fraction(each) for each in values)
        return sum(found, Fraction(0))

    def ground(self) -> Iterator[tuple[Clause, list[tuple[Clause, Literal]], Fraction]]:
        for form in self.domain[2:]:
            if form[0] == ":action":
                parts = dict(zip(form[2::2], form[3::2], strict=True))
                for binding in self.bindings(parts.get(":parameters", [])):
                    condition, effect = (
                        substituted(parts.get(key, []), binding) for key in (":precondition", ":effect")
                    )
                    effects = list(self.effects(effect, frozenset()))
                    added_facts = [(c, fact) for c, (adds, fact) in effects if adds]
                    given = [(c, (True, fact)) for c, fact in added_facts]
                    for clause, (adds, fact) in effects:
                        if not adds:  # where nothing adds it at the same time
                            added = [[(not h, f) for h, f in c] for c, added in added_facts if added == fact]
                            for not_added in itertools.product(*added):
                                both = clause | frozenset(not_added)
                                if consistent(both):
                                    given.append((both, (False, fact)))
                    for clause in self.clauses(condition):
                        yield clause, [g for g in given if consistent(g[0] | clause)], self.cost(effect)

    def best(self) -> Fraction | None:
        """Search all states for the cheapest way to the goal."""
        ground = list(self.ground())
        first: State = frozenset((True, fact) for fact in self.start)
        queue: list[tuple[Fraction, int, State]] = [(Fraction(0), 0, first)]
        known: dict[State, Fraction] = {first: Fraction(0)}
        count = itertools.count(1)
        while queue:
            cost, _, state = heapq.heappop(queue)
            if cost > known[state]:
                continue
            if any(self.holds(clause, state) for clause in self.goal):
                return cost
            for condition, effects, more in ground:
                if self.holds(condition, state):
                    gained = {literal for clause, literal in effects if self.holds(clause, state)}
                    new = {o for o in gained if not self.literal_holds(o, state)}
                    total = cost + more
                    after = state | new
                    if new and total < known.get(after, total + 1):
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
            asked = " ".join(random.choice(["{}", "(not {})"]).format(atom(variables)) for _ in "ab")
            return f"(when ({random.choice(['and', 'or'])} {asked}) {effect(variables)})"
        return atom(variables, "pqrs") if kind == "a" else f"(not {atom(variables, 'pqrs')})"

    actions = []
    for number in range(random.randint(2, 5)):
        variables = ["?x", "?y"][: random.randint(0, 2)]
        parameters = " ".join(f"{name} - {random.choice(['t', 'u', 'object'])}" for name in variables)
        effects = " ".join(effect(variables) for _ in range(random.randint(1, 3)))
        cost = random.choice(["0", "1", "2", "(price)", f"(worth {term(variables)})", "3"])
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


@needs_translator
@pytest.mark.parametrize(
    "seed", [*range(8), *(pytest.param(s, marks=pytest.mark.slow) for s in range(8, 120))]
)
def test_random_tasks_cost_what_a_search_of_all_states_finds(tmp_path: Path, seed: int) -> None:
    domain, problem = random_task(random.Random(seed))
    relaxed = foon_asp.relax(written(tmp_path, domain, problem))
    assert relaxed.proved
    assert relaxed.cost == Oracle(domain, problem).best(), domain + problem


# --- what is beyond, and what is wrong, is refused in words

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


@needs_translator
@pytest.mark.parametrize(
    ("effects", "start", "cost"),
    [
        ("(p) (not (p))", "(p)", None),
        ("(when (q) (p)) (not (p))", "(p) (q)", None),  # nothing makes q false
        ("(when (q) (p)) (not (p))", "(p)", 1),
        ("(when (q) (p)) (not (p)) (not (q))", "(p) (q)", 2),
        ("(when (q) (not (p))) (q)", "(p)", 2),
        ("(when (q) (not (p))) (when (q) (p)) (q)", "(p)", None),
        ("(when (q) (not (p))) (when (not (q)) (p)) (q)", "(p)", 2),
    ],
)
def test_a_fact_deleted_and_added_by_one_action_is_added(
    tmp_path: Path, effects: str, start: str, cost: int | None
) -> None:
    domain = f"(define (domain d) (:predicates (p) (q)) (:action a :parameters () :effect (and {effects})))"
    problem = f"(define (problem e) (:domain d) (:init {start}) (:goal (and (not (p)))))"
    relaxed = foon_asp.relax(written(tmp_path, domain, problem))
    assert relaxed.cost == cost == Oracle(domain, problem).best()
    assert relaxed.proved


COST = "(increase (total-cost) 1)"
A_BLOCK = "?x ?y - block) (free"


@needs_translator
@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("(:action", "(:durative-action", "domain.pddl: error: Expected a non-empty block"),
        (COST, "(increase (weight ?x) 1)", "'increase' expects two arguments: found"),
        (
            *(COST, "(increase (total-cost) (wait ?x))"),
            "domain.pddl:8:69: error: found the cost wait, which the domain does not declare",
        ),
        (
            COST,
            f"{COST} (increase (total-cost) 2)",
            "domain.pddl:8:72: error: found a second cost of an action",
        ),
        (A_BLOCK, "?x ?y - blok) (free", "domain.pddl:4:28: error: found the type blok"),
        (A_BLOCK, "?x ?y - (either block blok)) (free", "domain.pddl:4:42: error: found the type"),
        (":effect (and", f":effect (when (free ?x) {COST}) (and", "found a second cost"),
        (COST, f"(when (free ?x) {COST})", "translator fails on these files, with"),
        ("1))))", "1)))", "domain.pddl: error: Missing ')'"),
        ("(define (domain", "(define (what", "domain.pddl: found neither a domain nor a problem in PDDL"),
        (
            "(on a b)))",
            "(on a c)))",
            "problem.pddl: error: Undefined object: found c (in goal, condition, literal)",
        ),
        (DOMAIN, "(define (domain", "problem.pddl:1:30: error: found a problem of the domain d"),
        ("a b - block", "a b - blocks", "problem.pddl:2:19: error: found the type blocks"),
        ("(:domain d)", "(:domain x)", "problem.pddl:1:30: error: found a problem of the domain x"),
        ("(on a b)", "(and " * 3_000 + "(on a b)" + ")" * 3_000, "found conditions nested too deeply"),
        ("(define (problem", "(define (domain", "found two files with a domain"),
    ],
)
def test_what_is_beyond_or_wrong_is_refused_in_words(
    cli: Cli, tmp_path: Path, old: str, new: str, words: str
) -> None:
    assert (old in DOMAIN) != (old in PROBLEM)
    ran = cli("relax", *written(tmp_path, DOMAIN.replace(old, new, 1), PROBLEM.replace(old, new, 1)))
    assert ran.code == 2, ran.out
    assert words in ran.err
    assert "Traceback" not in ran.err


@needs_translator
@pytest.mark.parametrize(
    ("domain", "problem"),
    [
        ("domain.pddl", "prob18.pddl"),
        ("domain_18.pddl", "prob18.pddl"),
        ("p18-domain.pddl", "p18-airport.pddl"),
        ("domain_p18.pddl", "p18.pddl"),
        ("p18-domain.pddl", "p18.pddl"),
    ],
)
def test_a_problem_finds_its_domain_and_two_files_have_any_order(
    cli: Cli, tmp_path: Path, domain: str, problem: str
) -> None:
    (tmp_path / problem).write_text(PROBLEM)
    assert "found no domain beside this problem" in cli("relax", tmp_path / problem).err
    (tmp_path / domain).write_text(DOMAIN)
    for files in ([problem], [problem, domain], [domain, problem]):
        ran = cli("relax", *(tmp_path / file for file in files))
        assert "h+ = 1" in ran.out, ran.err
    assert "found a domain alone" in cli("relax", tmp_path / domain).err


def test_without_the_translator_it_says_what_to_install(
    cli: Cli, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("importlib.util.find_spec", lambda _: None)
    ran = cli("relax", *written(tmp_path, DOMAIN, PROBLEM))
    assert ran.code == 2
    assert "pip install 'foon-asp[pddl]'" in ran.err


def stand_in(folder: Path, monkeypatch: pytest.MonkeyPatch, code: str) -> list[Path]:
    """Put another program in the place of the translator."""
    package = folder / "fast_downward" / "translate"
    package.mkdir(parents=True)
    (package / "__init__.py").touch()
    (package / "__main__.py").write_text(code)
    monkeypatch.setenv("PYTHONPATH", str(folder))
    monkeypatch.setattr("foon_asp.planning.translator.is_installed", lambda: True)
    return written(folder, DOMAIN, PROBLEM)


@pytest.mark.parametrize(
    ("code", "words"),
    [
        ("raise MemoryError", "translator ran out of memory"),
        ("import sys; sys.exit(20)", "translator ran out of memory"),
        ("import os, signal; os.kill(os.getpid(), signal.SIGKILL)", "translator was ended by signal 9"),
        ("raise ValueError('what')", "translator fails on these files, with 'ValueError: what'"),
        ("pass", "translator fails on these files, with 'it says nothing'"),
        ("open('output.sas', 'w').write('begin_version')", "expected more lines: it is cut off"),
    ],
)
def test_a_translator_that_fails_is_an_error_in_words(
    cli: Cli, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, code: str, words: str
) -> None:
    ran = cli("relax", *stand_in(tmp_path, monkeypatch, code))
    assert ran.code == 2
    assert words in ran.err


def alive(process: int) -> bool:
    try:
        return Path(f"/proc/{process}/stat").read_text().rsplit(")", 1)[1].split()[0] != "Z"
    except OSError:
        return False


WAITS = "import os, pathlib, time; pathlib.Path({!r}).write_text(str(os.getpid())); time.sleep(60)"


def test_a_translator_that_takes_too_long_is_ended(
    cli: Cli, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    note = tmp_path / "process"
    files = stand_in(tmp_path, monkeypatch, WAITS.format(str(note)))
    ran = cli("relax", *files, "--time-limit", "1")
    assert ran.code == 3
    assert "while reading the task" in ran.err
    assert not note.exists() or not alive(int(note.read_text()))


@pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="processes are looked at in /proc")
@pytest.mark.parametrize("sent", [signal.SIGINT, pytest.param(signal.SIGKILL, marks=pytest.mark.slow)])
def test_no_translator_is_left_over(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, sent: int) -> None:
    note = tmp_path / "process"
    steps = WAITS.format(str(note)).replace(
        "time.sleep(60)", "[(print(), time.sleep(.1)) for _ in range(600)]"
    )
    files = stand_in(tmp_path, monkeypatch, steps)
    command = [sys.executable, "-m", "foon_asp", "relax", *map(str, files)]
    with subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as running:
        end = time.monotonic() + 60
        while not (note.exists() and note.read_text()) and time.monotonic() < end:
            time.sleep(0.05)
        running.send_signal(sent)
        assert running.wait(30) != 0
    while alive(int(note.read_text())) and time.monotonic() < end:
        time.sleep(0.05)
    assert not alive(int(note.read_text()))


@needs_translator
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
    assert cli("verify", tmp_path / "proof.json", *written(tmp_path, DOMAIN, PROBLEM)).code == 2


@needs_translator
def test_costs_and_types_and_capitals(tmp_path: Path) -> None:
    domain = """(DEFINE (domain D) ; a comment )
      (:types thing little - object hard soft - thing) (:constants ROCK - hard)
      (:predicates (held ?x - (either thing little)) (At ?x))
      (:functions (Total-Cost) - number (price ?x) - number)
      (:action TAKE :parameters (?x - thing) :effect (and (HELD ?x) (increase (total-cost) (price ?x))))
      (:action pinch :parameters (?x) :precondition (not (= ?x ROCK))
        :effect (and (held ?x) (increase (total-cost) 1))))"""
    problem = """(define (problem e) (:domain d) (:objects wool - soft dust - little)
      (:init (= (price rock) 4) (= (PRICE wool) 2) (not (held rock)))
      (:goal (and (held Rock) (held WOOL) (held dust))) (:metric minimize (total-cost)))"""
    relaxed = foon_asp.relax(written(tmp_path, domain, problem))
    assert relaxed.proved
    assert relaxed.cost == 6
    assert sorted(map(str, relaxed.plan or ())) == ["(pinch dust)", "(pinch wool)", "(take rock)"]
    assert relaxed.pddl().endswith("; cost = 6 (general cost)\n")


@needs_translator
def test_facts_that_axioms_derive(cli: Cli, tmp_path: Path) -> None:
    domain = """(define (domain d) (:types block)
      (:predicates (on ?x ?y - block) (above ?x ?y - block) (bare ?x - block))
      (:derived (above ?x ?y - block) (or (on ?x ?y) (exists (?z - block) (and (on ?x ?z) (above ?z ?y)))))
      (:derived (bare ?x - block) (not (exists (?y - block) (on ?y ?x))))
      (:action put :parameters (?x ?y - block) :effect (on ?x ?y))
      (:action clear :parameters (?x - block) :effect (forall (?y - block) (not (on ?y ?x)))))"""
    problem = """(define (problem e) (:domain d) (:objects a b c - block) (:init (on a b)) (:goal GOAL))"""

    def relax(goal: str) -> Any:
        return cli("relax", *written(tmp_path, domain, problem.replace("GOAL", goal)))

    ran = relax("(above a c)")
    assert "h+ = 1" in ran.out
    assert "(put" in ran.out
    assert "axiom" not in ran.out
    assert "h+ = 1" in relax("(and (bare b) (bare c))").out
    assert "h+ = 2" in relax("(and (above a c) (bare b))").out
    ran = relax("(not (above a b))")
    assert ran.code == 2
    assert "derived by recursion" in ran.err


@needs_translator
def test_too_many_effects_under_conditions_are_refused(cli: Cli, tmp_path: Path) -> None:
    domain = """(define (domain d) (:predicates (p ?x) (q ?x))
      (:action make :parameters (?x) :effect (p ?x))
      (:action all :parameters () :effect (forall (?x) (when (p ?x) (q ?x)))))"""
    for count, code in ((4, 0), (10, 2)):
        objects = " ".join(f"o{number}" for number in range(count))
        problem = (
            f"(define (problem e) (:domain d) (:objects {objects}) (:init) (:goal (forall (?x) (q ?x))))"
        )
        ran = cli("relax", *written(tmp_path, domain, problem))
        assert ran.code == code
        assert ("h+ = 5" in ran.out) == (not code)
    assert "found the action (all) with effects under 10 conditions" in ran.err


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
    assert foon_asp.relax(file).strips.facts == ["(on a b)", "(at a)", "(at b)"]
    file.write_text(SAS.replace("Atom on(a, b)\nNegatedAtom on(a, b)", "Atom at(a)\nNegatedAtom at(a)"))
    assert foon_asp.relax(file).strips.facts == ["(at a) [var0]", "(at a) [var1]", "(at b)"]


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (("begin_version\n3", "begin_version\n2"), "2:1: error: found another version, expected 3"),
        (
            ("end_operator\n0\n", "end_operator\n1\nbegin_rule\n0\n0 1 0\nend_rule\n"),
            "which no axiom may set",
        ),
        (("1\n0 1 0 1\n3", "1\n1 0 1 0 1\n3"), "found an effect of 5 numbers, expected 6"),
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


def test_effects_under_conditions_and_axioms_of_the_translator(tmp_path: Path) -> None:
    """Where a variable has many values, any other one is the contrary of one."""
    file = tmp_path / "output.sas"
    conditional = SAS.replace("1\n0 1 0 1\n3", "1\n1 0 0 1 0 1\n3")  # go a b, once put is done
    file.write_text(conditional)
    relaxed = foon_asp.relax(file)
    assert relaxed.proved
    assert relaxed.cost is None
    axiom = "1\nbegin_rule\n1\n1 0\n2 1 0\nend_rule\n"  # var2 as long as it is at a; its contrary is the goal
    derived = "begin_variable\nvar2\n0\n2\nAtom here()\nNegatedAtom here()\nend_variable\n1\nbegin_mutex"
    text = SAS.replace("1\nbegin_mutex", derived).replace("end_metric\n2", "end_metric\n3")
    text = text.replace("1\n0\nend_state", "1\n0\n1\nend_state").replace(
        "1\n0 0\nend_goal", "1\n2 1\nend_goal"
    )
    file.write_text(text.removesuffix("0\n") + axiom)
    assert [*map(str, foon_asp.relax(file).plan or ())] == ["(go a b)"]


def test_files_that_are_no_task(cli: Cli, tmp_path: Path) -> None:
    files = written(tmp_path, DOMAIN, PROBLEM)
    assert "found 0 files" in cli("relax").err
    assert "found 3 files" in cli("relax", *files, files[0]).err
    assert cli("relax", *files, "--data", tmp_path).code == 2
    ran = cli("verify", tmp_path / "proof.json", *files, "--kitchen", tmp_path / "k")
    assert "found options for data beside a planning task" in ran.err


@needs_translator
def test_a_question_costs_the_same_as_a_planning_task(tmp_path: Path) -> None:
    problem = foon_asp.load().problem("greek salad")
    foon_asp.export(problem, "inputs").write(tmp_path)
    relaxed = foon_asp.relax([tmp_path / "domain.pddl", tmp_path / "problem.pddl"])
    answer = foon_asp.solve(problem, "inputs").costs
    assert answer is not None
    assert relaxed.cost == answer.inputs


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


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("how", [{}, {"reductions": "none"}, {"reductions": "none", "encodings": "by_need"}])
def test_units_may_need_nothing(seed: int, how: dict[str, Any], tmp_path: Path) -> None:
    problem = bare_problem(seed)
    answer = foon_asp.solve(problem, **how)
    least = next(map(len, task_trees.trees(problem)), None)  # the smallest first
    assert (None if answer.costs is None else answer.costs.units) == least
    if not how and least is not None:
        proof = tmp_path / "proof.json"
        foon_asp.solve(problem, "success", certificate=proof)
        assert foon_asp.verify(problem, proof).claim == "optimal"
        assert answer.tree is not None
        assert foon_asp.check(problem, answer.tree).executes
        checks = foon_asp.solve(problem, cross_check=True).cross_check
        assert isinstance(checks, tuple)
        assert all(check.reason is None for check in checks) or (not fast_downward.is_installed())


@needs_translator
def test_a_certificate_of_another_cost_is_refused(tmp_path: Path) -> None:
    files = written(tmp_path, DOMAIN, PROBLEM)
    relaxed = foon_asp.relax(files, certificate_file=tmp_path / "proof.json")
    assert relaxed.certificate is not None
    content = json.loads((tmp_path / "proof.json").read_text())
    content["tree"] = []
    (tmp_path / "proof.json").write_text(json.dumps(content))
    with pytest.raises(RefusedError):
        foon_asp.verify(relaxed.problem, tmp_path / "proof.json")


@needs_translator
def test_the_search_ends_when_the_cost_is_proved(tmp_path: Path) -> None:
    free = "(:action loose :parameters (?x - block) :effect (and (free ?x) (increase (total-cost) 0)))"
    domain = DOMAIN.rstrip()[:-1] + free + ")"
    metric = PROBLEM.rstrip()[:-1] + "(:metric minimize (total-cost)))"
    relaxed = foon_asp.relax(written(tmp_path, domain, metric))
    assert relaxed.cost == 1
    assert relaxed.proved


@needs_translator
def test_advice_at_a_limit_is_about_the_task(tmp_path: Path) -> None:
    with pytest.raises(LimitError) as reading:
        read_task(written(tmp_path, DOMAIN, PROBLEM), Deadline(1e-9))
    assert reading.value.stopped.endswith("while reading the task")
    assert reading.value.advice == "raise the limit"
