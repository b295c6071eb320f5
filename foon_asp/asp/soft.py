"""Soft constraints: the least penalty first, then the best tree among those that have it."""

import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from foon_asp.asp.exact_success import problem_scale
from foon_asp.asp.facts import write_facts, write_greatest_penalty, write_soft, write_tree
from foon_asp.asp.integrity import IntegrityConstraint, relax
from foon_asp.asp.outcome import Outcome, Status
from foon_asp.asp.program import Settings, assemble, find_constraint
from foon_asp.asp.search import run
from foon_asp.asp.solver import Reporter, solve
from foon_asp.deadline import Deadline
from foon_asp.errors import BugError, UserError
from foon_asp.problem import Objective, Problem, reach

GREATEST_WEIGHT = 1_000_000  # of a constraint that may be broken or dropped


class Broken(NamedTuple):
    """A soft constraint, its weight, and in how many ways the tree breaks it."""

    constraint: IntegrityConstraint
    weight: int
    ways: int


class SoftOutcome(NamedTuple):
    """An answer under soft constraints.

    ``penalty`` is the sum of weight times ways over ``constraints``, for the tree of ``outcome``; ``None``
    and empty where there is no tree. An ``optimal`` outcome has the least penalty of all trees, and is the
    best by the objectives among those with that penalty.
    """

    outcome: Outcome
    penalty: int | None
    constraints: tuple[Broken, ...]


def solve_soft(
    problem: Problem,
    objectives: Sequence[Objective],
    settings: Settings,
    weights: Mapping[Path, int],
    reporter: Reporter | None = None,
) -> SoftOutcome:
    """Find the tree with the least penalty, and among those the best by a lexicographic list of objectives.

    ``weights`` are those of the files whose integrity constraints are soft; the constraints of ``settings``
    are hard. Each way in which a constraint is broken, by other values of the variables that it has as a
    whole, costs its weight. Raises :class:`UserError` like :func:`foon_asp.asp.solve`.
    """
    reporter = reporter or Reporter()
    both = set(map(find_constraint, settings.constraints)) & set(map(find_constraint, weights))
    if both:
        raise UserError(f"{min(both)} is named as a constraint and as a soft one; leave one of them out")
    began = time.monotonic()
    deadline = Deadline(settings.time_limit)
    constraints, relaxed = relax(tuple(weights), settings.constants, soft=True)
    of_file = {find_constraint(path): weight for path, weight in weights.items()}
    by_number = {c.number: of_file[c.file] for c in constraints}
    rules = write_soft(by_number)
    settings = settings._replace(relaxed=relaxed)
    program = assemble(settings, reporter.warning)
    reached = reach(problem)
    units = tuple(sorted(reached.units))
    scale = None if problem.rates is None else problem_scale(problem, units)
    facts = write_facts(problem, units, scale, with_sources=True) + program.rules + rules

    def tell(units: tuple[int, ...] | None, outcome: Outcome) -> SoftOutcome:
        if units is None:
            return SoftOutcome(outcome, None, ())
        given = run(
            program.files,
            facts + write_tree(units),
            program.arguments,
            Deadline(None),
            "ignore",
            None,
            None,
            ("_broken",),
        )
        if given.units != frozenset(units):
            raise BugError("the tree found is none when its soft constraints are looked at")
        ways = given.atoms["_broken"]
        found = tuple(Broken(c, by_number[c.number], ways[c.number]) for c in constraints)
        return SoftOutcome(outcome, sum(each.weight * each.ways for each in found), found)

    spent: dict[str, float] = {}
    least: int | None = None
    proved = True
    if all(reached.available[goal] for goal in problem.goals):
        ended = run(
            program.files,
            facts + "optimize(_soft,1).\n",
            program.arguments,
            deadline,
            predicates=("_broken",),
        )
        proved = ended.exhausted
        spent["soft"] = ended.ground_seconds + ended.solve_seconds
        if ended.units is not None:
            least = sum(by_number[number] * ways for number, ways in ended.atoms["_broken"].items())
    bound = "" if least is None else write_greatest_penalty(least)
    limit = settings.time_limit
    left = None if limit is None else max(0.0, limit - (time.monotonic() - began))
    hard = settings._replace(relaxed=relaxed._replace(rules=relaxed.rules + rules + bound), time_limit=left)
    outcome = solve(problem, objectives, hard, Reporter())
    if least is not None and outcome.status is Status.INFEASIBLE:
        raise BugError("the least penalty was lost")
    if not proved and outcome.status is Status.OPTIMAL:
        outcome = outcome._replace(status=Status.FEASIBLE, proof=None, bounds={})
    outcome.seconds.update(spent)
    return tell(outcome.units, outcome)
