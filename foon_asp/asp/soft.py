"""Soft constraints: trees of the least penalty, and the best tree among these."""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

from foon_asp.asp.assembly import assemble
from foon_asp.asp.integrity import IntegrityConstraint, relax
from foon_asp.asp.outcome import Outcome, Status
from foon_asp.asp.prepared import prepare
from foon_asp.asp.reporter import Reporter
from foon_asp.asp.settings import Relaxed, Settings
from foon_asp.asp.solver import solve_prepared
from foon_asp.encoding.fact_writer import write_greatest_penalty, write_least_penalty, write_soft, write_tree
from foon_asp.encoding.run import Run
from foon_asp.errors import UserError
from foon_asp.problem import Objective, Problem
from foon_asp.rules.passed_constraint import Constraint, find_constraint


class Broken(NamedTuple):
    """An integrity constraint that may be broken, its weight, and how many of its instances a tree breaks."""

    constraint: IntegrityConstraint
    weight: int
    ways: int


class SoftOutcome(NamedTuple):
    """An answer under soft constraints.

    Each of the ``constraints`` has a ``weight``, and ``ways``, the number of its instances that the tree of
    ``outcome`` breaks. ``penalty`` is the sum of ``weight`` times ``ways``. Without a tree, ``penalty`` is
    ``None`` and ``constraints`` is empty. The tree of an ``optimal`` outcome has the least penalty. It is the
    best by the objectives among the trees with this penalty.
    """

    outcome: Outcome
    penalty: int | None
    constraints: tuple[Broken, ...]


def soft_rules(
    settings: Settings, weights: Mapping[Constraint, int]
) -> tuple[tuple[IntegrityConstraint, ...], dict[int, int], Relaxed]:
    """Return the integrity constraints of soft constraints, their weights by number, and rewritten rules.

    ``weights`` maps each soft constraint to its weight. The rewritten rules count the instances that a tree
    breaks. Raises :class:`UserError` for a soft constraint that is also a constraint of ``settings``.
    """
    weight_of = {find_constraint(constraint): weight for constraint, weight in weights.items()}
    both = weight_of.keys() & set(map(find_constraint, settings.constraints))
    if both:
        named = min(map(str, both))
        raise UserError(f"{named} is named as a constraint and as a soft one; leave one of them out")
    constraints, relaxed = relax(
        weights,
        settings.constants,
        soft=True,
        deadline=settings.effective_deadline,
        before=settings.constraints,
    )
    by_number = {constraint.number: weight_of[constraint.constraint] for constraint in constraints}
    return constraints, by_number, relaxed._replace(rules=relaxed.rules + write_soft(by_number))


def solve_soft(
    problem: Problem,
    objectives: Sequence[Objective],
    settings: Settings,
    weights: Mapping[Constraint, int],
    reporter: Reporter | None = None,
) -> SoftOutcome:
    """Find the best tree by lexicographic objectives among the trees with the least penalty.

    ``weights`` maps each soft constraint to its weight; the constraints of ``settings`` are hard. A tree may
    break several instances of a rule, which differ in the values of its global variables. The penalty is the
    sum of the weights of all broken instances. At a limit, the tree found so far is returned, without a
    proof. Raises :class:`UserError` like :func:`foon_asp.asp.solve`.
    """
    settings = settings._replace(deadline=settings.effective_deadline)
    constraints, by_number, relaxed = soft_rules(settings, weights)
    settings = settings._replace(relaxed=relaxed)
    program = assemble(settings, (reporter or Reporter()).warning, problem=problem)
    prepared = prepare(problem, objectives, settings, program)
    holds = prepared.holds
    seconds: dict[str, float] = {}
    least_penalty: int | None = None
    is_least_proved = True
    penalty_run = Run()

    def run_with_penalty(question_facts: str) -> Run:
        """Run clingo for the least penalty, with additional facts; count the instances broken."""
        return prepared.run(question_facts + write_least_penalty(1), predicates=[("_broken", 2)])

    def soft_outcome(outcome: Outcome, ways: Mapping[int, int]) -> SoftOutcome:
        """Return an outcome with its penalty.

        ``ways`` has the number of broken instances by number of integrity constraint.
        """
        broken = tuple(
            Broken(constraint, by_number[constraint.number], ways.get(constraint.number, 0))
            for constraint in constraints
        )
        return SoftOutcome(outcome, sum(rule.weight * rule.ways for rule in broken), broken)

    if prepared.tree is not None:
        penalty_run = run_with_penalty("")
        is_least_proved = penalty_run.exhausted
        seconds["soft"] = penalty_run.ground_seconds + penalty_run.solve_seconds
        if penalty_run.units is not None:
            least_penalty = sum(
                by_number[number] * ways for number, ways in penalty_run.atoms["_broken"].items()
            )
    penalty_limit = "" if least_penalty is None else write_greatest_penalty(least_penalty)
    outcome = solve_prepared(prepared, objectives, penalty_limit)
    holds.require(
        least_penalty is None or outcome.status is not Status.INFEASIBLE, lambda: "the least penalty was lost"
    )
    if not is_least_proved and outcome.status is Status.OPTIMAL:
        outcome = outcome._replace(status=Status.FEASIBLE, proof=None, bounds={})
    outcome.seconds.update(seconds)
    if outcome.units is not None:
        # auxiliary predicates may leave the broken instances of a tree open: the least penalty counts
        check_run = run_with_penalty(write_tree(outcome.units))
        if check_run.exhausted:
            holds.require(
                check_run.units == frozenset(outcome.units),
                lambda: f"the tree {outcome.units} does not hold when its soft constraints are checked",
            )
            answer = soft_outcome(outcome, check_run.atoms["_broken"])
            holds.require(
                least_penalty is None
                or answer.penalty in range(least_penalty if is_least_proved else 0, least_penalty + 1),
                lambda: (
                    f"the penalty of {outcome.units} is {answer.penalty}, "
                    f"but the least one was to be {least_penalty}"
                ),
            )
            return answer
    if penalty_run.units is not None:  # stopped: the incumbent
        tree = holds.require_executable(penalty_run.units)
        incumbent_outcome = outcome._replace(
            status=Status.FEASIBLE, units=tree, costs=problem.costs(tree), bounds={}
        )
        return soft_outcome(incumbent_outcome, penalty_run.atoms["_broken"])
    return SoftOutcome(outcome, None, ())
