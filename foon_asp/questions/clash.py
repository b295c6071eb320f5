"""Which constraints cannot hold together, and which to drop."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from foon_asp.asp import Settings, Status
from foon_asp.asp.assembly import CLINGO_OPTIONS, assemble
from foon_asp.asp.integrity import IntegrityConstraint, relax
from foon_asp.asp.prepared import prepare
from foon_asp.asp.solver import solve_prepared
from foon_asp.dataset.paths import File, Files
from foon_asp.deadline import Cancel
from foon_asp.document.json_document import document
from foon_asp.encoding.facts import write_constraints, write_corrections
from foon_asp.encoding.own_encodings import question_encoding
from foon_asp.encoding.search import run
from foon_asp.errors import BugError, UserError
from foon_asp.network import counted
from foon_asp.problem import Objective, Problem
from foon_asp.problem.progress import OnProgress
from foon_asp.questions.answer import Answer, WithOutcome
from foon_asp.questions.arguments import (
    Constants,
    Objectives,
    chosen_objectives,
    constraint_weights,
    settings,
    whole,
)
from foon_asp.questions.caller import caller
from foon_asp.questions.contract import Kind, Option, question
from foon_asp.questions.options import HOW, TREE
from foon_asp.questions.result import Ending
from foon_asp.report.answer import goal_lines, headline
from foon_asp.report.integrity_constraint import constraint_json, constraint_lines
from foon_asp.rules.constraint import Constraint, find_constraint


@dataclass(frozen=True, repr=False)
class Clash(WithOutcome):
    """Whether some constraints leave a tree, and if not, why.

    ``problem`` and ``objectives`` are those asked about. ``constraints`` are all constraints, each with its
    ``source``, ``text`` and ``constants``; ``weights`` has by number what it costs to drop one. ``makeable``
    tells whether the goals can be made at all, ``tree_exists`` whether there is a tree without any of the
    constraints. ``smallest`` is a smallest set of constraints that cannot hold together, if ``proved``.
    ``dropped`` is the cheapest set to drop so that the others leave a tree, and ``outcome`` the best tree
    then. If the constraints leave a tree, both sets are empty, and ``outcome`` is the answer. ``complete``
    is false if a limit was reached before this was known; ``dropped`` may then be more than necessary.

    Example:
        >>> ice = foon_asp.load().problem("ice")
        >>> rules = {"forbidden_motion": "crush", "required_motion": "crush"}
        >>> found = foon_asp.clash(ice, constraints=["forbid_motion", "require_motion"], constants=rules)
        >>> found.proved, [constraint.source.line for constraint in found.smallest]
        (True, [11, 12])
        >>> next(found.lines()).partition(":")[0]
        '2 of the 2 constraints cannot hold together, and no smaller set'
    """

    problem: Problem
    objectives: tuple[Objective, ...]
    constraints: tuple[IntegrityConstraint, ...]
    weights: Mapping[int, int]
    makeable: bool = True
    tree_exists: bool = True
    smallest: tuple[IntegrityConstraint, ...] = ()
    proved: bool = False
    dropped: tuple[IntegrityConstraint, ...] = ()
    outcome: Answer | None = None
    complete: bool = True

    @property
    def ending(self) -> Ending:
        """Done when the constraints can hold together, and the best tree under them is proved to be it."""
        if not self.tree_exists:
            return Ending.NEGATIVE
        if not self.complete or self.outcome is None:
            return Ending.LIMIT
        if self.dropped:
            proved = self.proved and self.outcome.status is Status.OPTIMAL
            return Ending.NEGATIVE if proved else Ending.LIMIT
        return self.outcome.ending

    def text(self) -> str:
        """Say which constraints clash and which to drop."""
        advice = [] if self.makeable else ["foon-asp why-not says why"]
        return "\n".join([*goal_lines(self.problem), *self.lines(), *advice]) + "\n"

    def lines(self) -> Iterator[str]:
        """Say the same without the goals."""
        rule = self.problem.conditions
        if not self.tree_exists and self.makeable:
            yield f"no task tree is left whatever is dropped: proved ({rule})"
            yield "other rules of the files rule it out"
            return
        if not self.tree_exists:
            yield f"no task tree exists even without the constraints: proved ({rule})"
            return
        if not self.complete:
            yield f"unknown: stopped at a limit before it was known whether the constraints clash ({rule})"
            if self.dropped:
                yield "without these there is a task tree; a cheaper set may do, or nothing has to be dropped"
                yield from _listed(self.dropped)
            return
        number = counted(len(self.constraints), "constraint")
        if not self.constraints:
            yield f"there is a task tree ({rule}); foon-asp solve finds the best"
            return
        if not self.dropped:
            yield f"no clash: the {number} can hold{' together' * (len(self.constraints) > 1)} ({rule})"
            if self.outcome is not None:
                yield headline(self.outcome)
            return
        if self.proved:
            size = len(self.smallest)
            if len(self.constraints) == 1:
                yield f"1 constraint leaves no task tree: proved ({rule})"
            elif size == 1:
                yield f"1 of the {number} leaves no task tree by itself: proved ({rule})"
            else:
                yield f"{size} of the {number} cannot hold together, and no smaller set: proved ({rule})"
            yield from _listed(self.smallest)
        else:
            yield (
                f"the {number} cannot hold together ({rule}); the smallest clash was not found within the "
                "limit"
            )
        weight = sum(self.weights[constraint.number] for constraint in self.dropped)
        at = "" if set(self.weights.values()) == {1} else f", weight {weight}"
        yield f"cheapest to drop: {counted(len(self.dropped), 'constraint')}{at}"
        yield from _listed(self.dropped)
        if self.outcome is not None and self.outcome.status is not Status.UNKNOWN:
            yield f"without {'it' if len(self.dropped) == 1 else 'them'}: {headline(self.outcome)}"

    def json_dict(self) -> object:
        """Give all that is known of the clash."""
        return document(
            "clash",
            self.problem,
            self.objectives,
            complete=self.complete,
            tree_exists_without_constraints=self.tree_exists,
            clash=bool(self.dropped),
            constraints=[
                constraint_json(each) | {"weight": self.weights[each.number]} for each in self.constraints
            ],
            smallest_clash=list(map(constraint_json, self.smallest)),
            smallest_proved=self.proved,
            cheapest_to_drop=list(map(constraint_json, self.dropped)),
            answer=None if self.outcome is None else self.outcome.json_dict(),
        )


@question(
    *TREE,
    Option(
        "weights",
        "What it costs to drop a constraint of a file, 1 if not given.",
        Kind.WEIGHTS,
        flags=("--weight",),
        many=True,
        metavar="FILE.lp=WEIGHT",
    ),
    *HOW,
    help_="""
    \b
    foon-asp clash --goal omelet --constraint mine.lp --constraint yours.lp
    foon-asp clash --goal omelet --constraint mine.lp --constraint yours.lp --weight mine.lp=10

    Every rule without a head (:- ...) is a constraint of its own; other rules of the files always hold. Both
    sets are proved: no smaller one clashes, and dropping nothing cheaper leaves a tree.

    Exits with 0 when the constraints can hold together; with 1 when they clash, or when there is no tree even
    without them; with 3 when stopped at a limit.
    """,
)
def clash(
    problem: Problem,
    objectives: Objectives = "units",
    *,
    constraints: Files = (),
    weights: Mapping[File, int] | None = None,
    constants: Constants | None = None,
    encodings: File | None = None,
    time_limit: float | None = None,
    memory_limit: int | str | None = None,
    on_progress: OnProgress | None = None,
    cancel: Cancel | None = None,
) -> Clash:
    """Find a smallest set of constraints that cannot hold together, and the cheapest ones to drop.

    Every rule without a head (``:- ...``) in the files is one constraint. All of a store is read.

    Parameters:
        weights: What it costs to drop one constraint of a file, by file; 1 if not given.

    Returns:
        The ``smallest`` clash, the constraints to be ``dropped``, and the best tree without them as the
        ``outcome``.

    Raises:
        UserError: for a wrong argument or constraint, or if there are no constraints.

    Example:
        >>> found = foon_asp.clash(
        ...     foon_asp.load().problem("ice"),
        ...     constraints=["forbid_motion", "require_motion"],
        ...     constants={"forbidden_motion": "crush", "required_motion": "crush"},
        ... )
        >>> len(found.smallest), len(found.dropped)
        (2, 1)
    """
    chosen = chosen_objectives(problem, objectives)
    how = settings(constraints, constants, encodings, time_limit, memory_limit)
    if not how.constraints:
        raise UserError("name constraints, files or names of ours; why-not explains other reasons")
    return find_clash(whole(problem), chosen, how, constraint_weights(weights or {}))


def find_clash(
    problem: Problem,
    objectives: Sequence[Objective],
    how: Settings,
    own_weights: Mapping[Constraint, int] | None = None,
) -> Clash:
    """Find a smallest clash and the cheapest constraints to drop, of those in some settings.

    ``own_weights`` says what it costs to drop a rule of a constraint, 1 where it says nothing. The smallest
    clash is found by implicit hitting sets (Ignatiev, Previti, Liffiton and Marques-Silva, Smallest MUS
    Extraction with Minimal Hitting Set Dualization, CP 2015): a smallest set with one of every correction
    known so far, until it is a clash itself.
    """
    deadline = how.begun
    how = how._replace(deadline=deadline)
    constraints, relaxed = relax(how.constraints, how.constants, soft=False, deadline=deadline)
    by_number = {constraint.number: constraint for constraint in constraints}
    weight_of = {find_constraint(c): weight for c, weight in (own_weights or {}).items()}
    weights = {number: weight_of.get(c.constraint, 1) for number, c in by_number.items()}
    how = how._replace(relaxed=relaxed)
    program = assemble(how, caller().reporter.warning)
    blame = (question_encoding("blame.lp"),)
    known = Clash(problem, tuple(objectives), constraints, weights)

    def those(numbers: Iterable[int]) -> tuple[IntegrityConstraint, ...]:
        return tuple(by_number[number] for number in sorted(numbers))

    first = prepare(problem, objectives, how, program)
    if first.stopped:
        return replace(known, complete=False)
    if first.tree is None:
        return replace(known, makeable=False, tree_exists=False)
    dropping = "optimize(_dropping,1).\n"
    corrections: list[tuple[int, ...]] = []
    blamed: tuple[int, ...] = ()
    while True:
        ended = first.run(dropping + write_constraints(weights, blamed), predicates=[("_dropped", 1)])
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
        return replace(known, tree_exists=not clashes, dropped=those(some), complete=clashes)
    dropped = corrections[0]
    kept = write_constraints(weights, set(weights).difference(dropped))
    outcome = Answer._make(solve_prepared(first, objectives, kept))
    if outcome.status is Status.INFEASIBLE:
        raise BugError("dropping the constraints does not leave a tree")
    smallest = those(blamed) if clashes else ()
    return replace(known, smallest=smallest, proved=clashes, dropped=those(dropped), outcome=outcome)


def _listed(constraints: Iterable[IntegrityConstraint]) -> Iterator[str]:
    for constraint in constraints:
        yield from constraint_lines(constraint)
