"""Which constraints cannot hold together, and which to drop."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from foon_asp.asp import Outcome, Reporter, Settings, Status, solve
from foon_asp.asp.exact_success import problem_scale
from foon_asp.asp.facts import write_constraints, write_corrections, write_facts
from foon_asp.asp.integrity import IntegrityConstraint, placed, relax
from foon_asp.asp.own_encodings import question_encoding
from foon_asp.asp.program import CLINGO_OPTIONS, assemble, find_constraint
from foon_asp.asp.search import run
from foon_asp.errors import BugError
from foon_asp.problem import Objective, Problem, reach


class Clash(NamedTuple):
    """Whether the constraints of a question leave a tree, and if not, why.

    ``constraints`` are all of them; ``makeable`` says whether the goals can be made at all. ``tree_exists``
    says whether there is a tree without any of them. ``smallest`` is a smallest set, by number of
    constraints, that cannot hold together; ``proved`` that it is one. ``dropped`` is the cheapest set to drop
    so that the others leave a tree, by ``weights``, and ``outcome`` the best tree without them. Where the
    constraints do leave a tree both sets are empty, and ``outcome`` is the answer. ``complete`` is false when
    a limit came before any of this was known; ``dropped`` is then a set that leaves a tree, if one was found,
    but there may be a cheaper one, or no need of any.
    """

    problem: Problem
    constraints: tuple[IntegrityConstraint, ...]
    makeable: bool
    weights: Mapping[int, int]
    tree_exists: bool
    smallest: tuple[IntegrityConstraint, ...]
    proved: bool
    dropped: tuple[IntegrityConstraint, ...]
    outcome: Outcome | None
    complete: bool


def find_clash(
    problem: Problem,
    objectives: Sequence[Objective],
    settings: Settings,
    file_weights: Mapping[Path, int] | None = None,
    reporter: Reporter | None = None,
) -> Clash:
    """Find a smallest clash and the cheapest constraints to drop.

    Every rule without a head in the constraint files is one constraint; ``file_weights`` says what it costs
    to drop one of a file, 1 where it says nothing. Other rules of the files always hold. The smallest clash
    is found by implicit hitting sets (Ignatiev, Previti, Liffiton and Marques-Silva, Smallest MUS Extraction
    with Minimal Hitting Set Dualization, CP 2015): a smallest set with one of every correction known so far,
    until it is a clash itself.
    """
    reporter = reporter or Reporter()
    settings = settings.limited()
    deadline = settings.begun
    constraints, relaxed = relax(settings.constraints, settings.constants, soft=False, deadline=deadline)
    by_number = {constraint.number: constraint for constraint in constraints}
    of_file = {find_constraint(path): weight for path, weight in (file_weights or {}).items()}
    weights = {number: of_file.get(c.file, 1) for number, c in by_number.items()}
    settings = settings._replace(relaxed=relaxed)
    program = assemble(settings, reporter.warning)
    blame = (question_encoding("blame.lp"),)

    makeable = True

    def answer(
        tree_exists: bool = True,
        smallest: Sequence[int] = (),
        proved: bool = False,
        dropped: Sequence[int] = (),
        outcome: Outcome | None = None,
        complete: bool = True,
    ) -> Clash:
        sets = (tuple(by_number[number] for number in sorted(part)) for part in (smallest, dropped))
        return Clash(
            problem,
            constraints,
            makeable,
            weights,
            tree_exists,
            next(sets),
            proved,
            next(sets),
            outcome,
            complete,
        )

    try:
        with deadline.watched("cutting the network"):
            reached = reach(problem)
            makeable = all(reached.available[goal] for goal in problem.goals)
            units = tuple(sorted(reached.units))
            scale = None if problem.rates is None else problem_scale(problem, units)
            facts = write_facts(problem, units, scale, with_sources=True) + relaxed.rules
    except KeyboardInterrupt:
        deadline.interrupt()
        return answer(complete=False)
    if not makeable:
        return answer(tree_exists=False)
    dropping = "optimize(_dropping,1).\n"
    corrections: list[tuple[int, ...]] = []
    blamed: tuple[int, ...] = ()
    while True:
        question = facts + dropping + write_constraints(weights, blamed)
        with placed(relaxed, question):
            ended = run(
                program.files,
                question,
                program.arguments,
                deadline,
                predicates=[("_dropped", 1)],
                endless=program.endless,
            )
        if ended.units is None or not ended.exhausted:
            break
        corrections.append(tuple(sorted(ended.atoms["_dropped"])))
        if not corrections[-1]:
            break
        hit = write_constraints(weights, ()) + write_corrections(corrections)
        hitting = run(blame, hit, CLINGO_OPTIONS, deadline, predicates=[("_blamed", 1)])
        if hitting.units is None or not hitting.exhausted:
            break
        blamed = tuple(sorted(hitting.atoms["_blamed"]))
    clashes = ended.units is None and ended.exhausted
    if not corrections:
        some = ended.atoms["_dropped"] if ended.atoms else ()  # enough to drop, but perhaps not the cheapest
        return answer(tree_exists=not clashes, dropped=sorted(some), complete=clashes)
    dropped = corrections[0]
    kept = write_constraints(weights, set(weights).difference(dropped))
    outcome = solve(
        problem,
        objectives,
        settings._replace(relaxed=relaxed._replace(rules=relaxed.rules + kept)),
        Reporter(),
    )
    if outcome.status is Status.INFEASIBLE:
        raise BugError("dropping the constraints does not leave a tree")
    return answer(smallest=blamed if clashes else (), proved=clashes, dropped=dropped, outcome=outcome)
