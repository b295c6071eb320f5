"""The campaign: random networks under random rules, each answer held against brute force and other engines.

``python -m benchmarks.campaign 2000`` asks of 2,000 networks. A question is made from a number: the
network, its rates, the kitchen and the goals, the container rule, the objectives, the settings, and the
rules. They are drawn from our library, with constants that make a difference; from a generator of files with
helpers, counting, recursion, negation, choice and constants; and from the hostile files, which use our names.
What a rule keeps is said in Python (:mod:`tests.oracle.constraints`), or by clingo of one given tree at a
time; our encodings, facts and searches have no part in it.
"""

import random
import tempfile
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from fractions import Fraction
from pathlib import Path, PurePath
from typing import NamedTuple

from clingo import Control, Function, Number
from clingo.symbol import Symbol

from foon_asp.asp import Outcome, Settings, Status, solve
from foon_asp.asp.soft import solve_soft
from foon_asp.engines import ClaimedAnswer, DisagreementError, cross_check
from foon_asp.errors import UserError
from foon_asp.hypergraph import parse_reductions
from foon_asp.network import FunctionalUnit, NetworkBuilder, Source
from foon_asp.problem import ContainerRule, Objective, Problem
from foon_asp.rules.passed_constraint import Constraint
from tests.oracle import constraints, task_trees
from tests.oracle.constraints import random_rule, settings_of
from tests.support.gap_problem import gap_problem
from tests.support.hostile_files import hostile_files
from tests.support.random_problems import random_objectives, random_problem

Tree = tuple[FunctionalUnit, ...]
PATIENCE = 20.0  # seconds for each engine
RATES = (
    *("0.3", "0.09", "0.1", "0.9", "0.5", "0.18", "0.300000001", "0.090000001", "1", "0.25", "0.85", "1"),
    *(f"0.{'9' * digits}" for digits in (5, 8, 9, 12, 20, 40)),
    *("0.999999998", "0.99999999999999999998", "0.000000001", "0.00000000000000000000001"),
)
_TRIES = 8
FILES = ("salad.txt", "folder/soup.txt", "folder/tea.txt")


class Rule(NamedTuple):
    """A file of rules with its constants, and which trees it keeps.

    ``ways`` counts in how many ways a tree breaks it, where it can be soft. A rule that ``may_be_refused``
    has names of ours in it.
    """

    name: str
    file: Path
    constants: tuple[str, ...]
    keeps: Callable[[Tree], bool]
    ways: Callable[[Tree], int] | None = None
    may_be_refused: bool = False


class Question(NamedTuple):
    """All that is asked; ``soft`` has weights of those of the ``rules`` that may be broken, by place."""

    seed: int
    problem: Problem
    objectives: tuple[Objective, ...]
    rules: tuple[Rule, ...]
    soft: dict[int, int]
    settings: Settings

    def __str__(self) -> str:
        rules = ", ".join(
            f"{'soft ' if place in self.soft else ''}{rule.name} {' '.join(rule.constants)}".strip()
            for place, rule in enumerate(self.rules)
        )
        return (
            f"seed {self.seed}: {','.join(self.objectives)}, {self.problem.containers}, "
            f"{len(self.problem.network)} units, rules: {rules or 'none'}"
        )


# --- Questions.


def question(seed: int, folder: Path) -> Question:
    """Make a question; files of rules are written to a folder."""
    rng = random.Random(seed)
    containers = rng.choice(list(ContainerRule))
    problem, found = _problem(rng, containers)
    for _ in range(_TRIES):
        if len(found) > 2 or rng.random() < 0.1:  # mostly there is something to choose from
            break
        problem, found = _problem(rng, containers)
    if rng.random() < 0.7:
        rates = {motion: Fraction(rng.choice(RATES)) for motion in problem.rates or ()}
        problem = replace(problem, rates=rates)
    objectives = random_objectives(rng, rng.randint(1, 3))
    rules: tuple[Rule, ...] = ()
    for _ in range(_TRIES if rng.random() < 0.85 else 0):
        rules = tuple(_rules(problem, rng, folder))
        kept = sum(all(rule.keeps(tree) for rule in rules) for tree in found)
        if rng.random() < 0.1 or 0 < kept < len(found):  # rules mostly leave out some trees and not all
            break
    soft: dict[int, int] = {}
    if rng.random() < 0.3:
        soft = {
            place: rng.choice((1, 2, 3, 7, 1_000_000))
            for place, rule in enumerate(rules)
            if rule.ways is not None and rng.random() < 0.8
        }
    by_need = not rules and rng.random() < 0.2
    settings = Settings(
        tuple(rule.file for place, rule in enumerate(rules) if place not in soft),
        encodings=Path("by_need") if by_need else None,
        constants=tuple(constant for rule in rules for constant in rule.constants),
        reductions=parse_reductions(rng.choice(("all", "all", "safe", "none"))),
    )
    return Question(seed, problem, objectives, rules, soft, settings)


def _problem(rng: random.Random, containers: ContainerRule) -> tuple[Problem, list[Tree]]:
    """Make a problem, and all its trees without rules."""
    seed = rng.randrange(10**9)
    made = (
        gap_problem(seed, 3) if rng.random() < 0.05 else random_problem(seed, containers, rng.randint(4, 9))
    )
    problem = _with_sources(replace(made, containers=containers), rng)
    return problem, list(task_trees.trees(problem))


def _with_sources(problem: Problem, rng: random.Random) -> Problem:
    """Say of every unit that it was read from one or two files."""
    network = problem.network
    builder = NetworkBuilder()
    for number in range(len(network)):
        unit = network.unit(number)
        for file in rng.sample(FILES, rng.choice((1, 1, 2))):
            builder.add(unit.motion, list(unit.inputs), list(unit.outputs), Source(file, number + 1))
    again = builder.build()
    moved = {o: again.object_id(node) for o, node in enumerate(network.objects)}
    kitchen = frozenset(place for o in problem.kitchen if (place := moved[o]) is not None)
    goals = tuple(place for o in problem.goals if (place := moved[o]) is not None)
    return replace(problem, network=again, kitchen=kitchen, goals=goals)


def _rules(problem: Problem, rng: random.Random, folder: Path) -> Iterator[Rule]:
    library = [_library(problem, rng) for _ in range(rng.choice((0, 1, 1, 2)))]
    yield from {rule.name: rule for rule in library}.values()
    if rng.random() < 0.6:
        yield _generated(problem, rng, folder)
    if rng.random() < 0.3:
        hostile = rng.choice(hostile_files())
        file = hostile.write(folder)
        yield Rule(f"hostile {hostile.role} {hostile.name}", file, (), hostile.keeps, may_be_refused=True)


def _library(problem: Problem, rng: random.Random) -> Rule:
    """Draw a constraint of ours with constants."""
    rule = random_rule(rng, problem)
    if "allowed" in rule and rng.random() < 0.5:  # a file goes by its bare name, too
        rule["allowed"] = [PurePath(file).name for file in rule["allowed"]]
    name = rule["rule"]
    return Rule(
        name,
        Path(name),
        settings_of([rule]).constants,
        lambda tree: constraints.keeps(problem, tree, rule),
        lambda tree: constraints.ways(problem, tree, rule),
    )


# --- A generator of rules, and clingo asked of one tree at a time.


def _generated(problem: Problem, rng: random.Random, folder: Path) -> Rule:
    """Write rules of one to three pieces, under names of their own."""
    network = problem.network
    motions = sorted(set(network.motions))
    labels = sorted({node.label for node in network.objects})
    text, constants = "", list[str]()
    for place in range(rng.choice((1, 1, 2, 3))):
        m, n = rng.choice(motions), rng.choice(motions)
        a, b = rng.choice(labels), rng.choice(labels)
        x, k = f"p{place}", rng.randint(0, 4)
        u = rng.randrange(len(network))
        pieces = [
            f':- #count {{ U : use(U), motion(U,"{m}") }} {rng.choice((">", "<", "!="))} {k}.',
            f":- use({u}), not use(U) : motion(U,\"{n}\"), U != {u}.",
            f'{x}(L) :- use(U), input(U,O), label(O,L). :- {x}("{a}"), not {x}("{b}").',
            f'{x}(L) :- use(U), gives(U,O), label(O,L). :- #count {{ L : {x}(L) }} > {k + 1}.',
            f'{{ {x}(M) : motion(_,M) }} = 1. :- {x}(M), use(U), motion(U,M). :- {x}("{m}").',
            f'{x}(U) ; {x}(U,no) :- use(U), motion(U,"{m}"). :- {x}(U), {x}(V,no). :- {x}(U), {x}(V), U < V.',
            f"#const {x} = {k}. :- #sum {{ N,U : use(U), inputs(U,N) }} > {x} + 4.",
            f'#const {x} = "". :- {x} != "", use(U), motion(U,{x}).',
            # what leads from one unit of the tree to another, and how far
            f"{x}(U,V) :- use(U), use(V), gives(U,O), needs(V,O), U != V.\n"
            f"{x}r(U,V) :- {x}(U,V). {x}r(U,W) :- {x}r(U,V), {x}(V,W).\n"
            f":- #count {{ U,V : {x}r(U,V) }} > {k + 1}.",
            f'-{x}(U) :- use(U), motion(U,"{m}"). {x}(U) :- use(U), output(U,O), label(O,"{a}").\n'
            f":- {k} > 3, {x}(_).",
            f'{x} :- not {x}n. {x}n :- not {x}. :- {x}, use(U), motion(U,"{m}").\n'
            f':- {x}n, use(U), motion(U,"{n}").',
            ":- not 1 <= #count { U : use(U), rate(U,N), N >= 250000 }.",
            f'{x}(N) :- N = #count {{ U : use(U), located(O,_,_), input(U,O) }}. :- {x}(N), N > {k}.',
            f'{x}(N) :- N = #max {{ I,U : use(U), ingredients(U,I) }}. :- {x}(N), N > {k}, N != #inf.',
            f':- use(U), source(U,"{rng.choice(FILES)}"), motion(U,"{m}").',
            f'{x}(O) :- goal(O), not kitchen(O). :- {x}(O), #count {{ U : use(U), output(U,O) }} > 1.',
            f":- {{ use(U) : utensil(L), input(U,O), label(O,L) }} > {k}.",
            f":- use(U), use(V), U < V, motion(U,M), motion(V,M), |U - V| = {k + 1}.",
            f'{x}(S) :- state(O,S), use(U), output(U,O). :- {x}("baked"), not {x}("raw").',
f"{x}(1..{k + 2}). 1 {{ {x}c(X) : {x}(X) }} 1. :- {x}c(X), not X <= #count {{ U : use(U) }}.",
        ]  # fmt: skip
        piece = rng.choice(pieces)
        if piece.startswith(f"#const {x} = ") and rng.random() < 0.6:
            constants.append(f"{x}={m}" if '""' in piece else f"{x}={k + 1}")
        text += piece + "\n"
    file = folder / "generated.lp"
    file.write_text(text, encoding="utf-8")
    judge = _Judge(problem, text, constants)
    return Rule(f"generated {text.strip()!r}", file, tuple(constants), judge.keeps)


class _Judge:
    """Asks clingo whether rules keep a given tree: what is used is assumed, and no tree is searched for."""

    def __init__(self, problem: Problem, text: str, constants: Sequence[str]) -> None:
        network = problem.network
        self._numbers = {network.unit(number): number for number in range(len(network))}
        self._reached = _reached(problem)
        settings = [
            f"{name}={value}" if value.isdigit() else f'{name}="{value}"'
            for name, _, value in (constant.partition("=") for constant in constants)
        ]
        arguments = [word for setting in settings for word in ("-c", setting)]
        self._control = Control([*arguments, "1"], logger=lambda *_: None)
        self._control.add(
            "base", [], "{ use(U) : unit(U) }.\n" + "".join(_facts(problem, self._reached)) + text
        )
        self._control.ground()

    def keeps(self, tree: Tree) -> bool:
        """Whether the rules hold of a tree."""
        used = {self._numbers[unit] for unit in tree}
        assumptions: list[tuple[Symbol, bool]] = [
            (Function("use", [Number(number)]), number in used) for number in self._reached
        ]
        return bool(self._control.solve(assumptions=assumptions).satisfiable)


def _reached(problem: Problem) -> list[int]:
    """Give the units that can run at all: only those are there for rules to look at."""
    network = problem.network
    units = [network.unit(number) for number in range(len(network))]
    there = {network.objects[o] for o in problem.kitchen}
    ran: set[int] = set()
    while True:
        more = {
            number
            for number, unit in enumerate(units)
            if number not in ran and task_trees.needed(unit, problem.containers, problem.utensils) <= there
        }
        if not more:
            return sorted(ran)
        ran |= more
        for number in more:
            there |= task_trees.made(units[number], problem.containers, problem.utensils)


def _facts(problem: Problem, units: Sequence[int]) -> Iterator[str]:
    """Write what encodings/README.md promises to constraints, anew."""
    network, name = problem.network, problem.network.object_id
    described = {network.objects[goal] for goal in problem.goals}
    for number in units:
        unit = network.unit(number)
        needs = task_trees.needed(unit, problem.containers, problem.utensils)
        gives = task_trees.made(unit, problem.containers, problem.utensils)
        described |= {*unit.inputs, *unit.outputs}
        yield f'unit({number}). motion({number},"{unit.motion}").\n'
        for predicate, nodes in (
            ("input", unit.inputs),
            ("output", unit.outputs),
            ("needs", needs),
            ("gives", gives),
        ):
            yield "".join(f"{predicate}({number},{name(node)}).\n" for node in nodes)
        inputs = set(unit.inputs)
        held = sum(len(contents.ingredients) for node in inputs for contents in node.contents)
        rate = (problem.rates or {})[unit.motion]
        yield f"inputs({number},{len(inputs)}). ingredients({number},{held}).\n"
        yield f"rate({number},{rate.numerator * 1_000_000 // rate.denominator}).\n"
        for source in network.sources[number]:
            yield f'source({number},"{source.file}"). source({number},"{PurePath(source.file).name}").\n'
    for node in described:
        o = name(node)
        yield f'object({o}). label({o},"{node.label}").\n'
        yield "".join(f'state({o},"{state}").\n' for state in node.states)
        yield "".join(f'located({o},"{word}","{at}").\n' for word, at in node.relations)
        yield "".join(f'ingredient({o},"{item}").\n' for item in node.ingredients)
        if o in problem.kitchen:
            yield f"kitchen({o}).\n"
        if node.label in problem.utensils:
            yield f'utensil("{node.label}").\n'
    for goal in problem.goals:
        yield f"goal({goal}).\n"


# --- Answers.

Tally = Counter[str]


def ask(asked: Question, tally: Tally) -> str | None:
    """Answer a question, and hold the answer against brute force and other engines; give what is wrong."""
    try:
        if asked.soft:
            soft: dict[Constraint, int] = {
                asked.rules[place].file: weight for place, weight in asked.soft.items()
            }
            found = solve_soft(asked.problem, asked.objectives, asked.settings, soft)
            return _judged(asked, ClaimedAnswer(found.outcome, asked.settings, soft, found.penalty), tally)
        outcome = solve(asked.problem, asked.objectives, asked.settings)
        return _judged(asked, ClaimedAnswer(outcome, asked.settings), tally)
    except UserError as error:
        if any(rule.may_be_refused for rule in asked.rules):
            tally["refused"] += 1
            return None
        return f"refused: {error}"
    except DisagreementError as error:
        return f"disagreement: {error}"
    except Exception as error:
        return f"{type(error).__name__}: {error}"


def _judged(asked: Question, answered: ClaimedAnswer, tally: Tally) -> str | None:
    outcome = answered.outcome
    if outcome.status not in {Status.OPTIMAL, Status.INFEASIBLE}:
        tally["stopped"] += 1
        return None
    best = _best(asked)
    if (best is None) != (outcome.status is Status.INFEASIBLE):
        return f"{outcome.status}, brute force says {best}"
    if best is not None:
        wrong = _wrong_tree(asked, outcome, answered.penalty, best)
        if wrong is not None:
            return wrong
    tally[str(outcome.status)] += 1
    if asked.rules:
        tally["rules made a difference"] += best != _best(asked._replace(rules=(), soft={}))
    clingo, highs = cross_check(answered, PATIENCE)[:2]
    tally["cross-checked" if clingo.reason is None else "not checked"] += 1
    tally["cross-checked by HiGHS, too"] += highs.reason is None
    return None


def _wrong_tree(
    asked: Question, outcome: Outcome, penalty: int | None, best: tuple[Fraction, ...]
) -> str | None:
    problem = asked.problem
    assert outcome.units is not None
    assert outcome.costs is not None
    tree = tuple(map(problem.network.unit, outcome.units))
    if not task_trees.makes(problem, tree):
        return "the tree does not execute"
    hard = [rule for place, rule in enumerate(asked.rules) if place not in asked.soft]
    if not all(rule.keeps(tree) for rule in hard):
        return "the tree breaks a rule"
    key = _key(asked, tree)
    if key != best:
        return f"the tree has {list(map(str, key))}, brute force {list(map(str, best))}"
    if asked.soft and penalty != key[0]:
        return f"the penalty is {penalty}, by brute force {key[0]}"
    said = [outcome.costs.measure(objective) for objective in asked.objectives]
    anew = [task_trees.measure(problem, tree, objective) for objective in asked.objectives]
    if list(map(abs, anew)) != said:
        return f"the costs are {said}, by brute force {anew}"
    return None


def _best(asked: Question) -> tuple[Fraction, ...] | None:
    """Give the least key of all trees that the hard rules keep; they are asked of the best first."""
    hard = [rule for place, rule in enumerate(asked.rules) if place not in asked.soft]
    keyed = sorted(
        (_key(asked, tree), place, tree) for place, tree in enumerate(task_trees.trees(asked.problem))
    )
    return next((key for key, _, tree in keyed if all(rule.keeps(tree) for rule in hard)), None)


def _key(asked: Question, tree: Tree) -> tuple[Fraction, ...]:
    key = task_trees.key(asked.problem, tree, list(map(str, asked.objectives)))
    if not asked.soft:
        return key
    penalty = Fraction(0)
    for place, weight in asked.soft.items():
        ways = asked.rules[place].ways
        assert ways is not None
        penalty += weight * ways(tree)
    return penalty, *key


def campaign(seeds: Sequence[int], wrong: list[str]) -> Tally:
    """Ask a question for every seed; what is wrong is added to a list."""
    tally: Tally = Counter()
    for seed in seeds:
        with tempfile.TemporaryDirectory() as name:
            asked = question(seed, Path(name))
            tally["networks"] += 1
            tally["under rules"] += bool(asked.rules)
            tally["with soft rules"] += bool(asked.soft)
            said = ask(asked, tally)
            if said is not None:
                tally["wrong"] += 1
                wrong.append(f"{asked}: {said}")
    return tally
