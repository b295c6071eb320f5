"""Clashing constraints: a smallest clash, and the cheapest constraints to drop."""

from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from msgspec.structs import asdict

from foon_asp.asp import Settings, Status
from foon_asp.asp.assembly import CLINGO_OPTIONS, assemble
from foon_asp.asp.integrity import relax
from foon_asp.asp.prepared import prepare
from foon_asp.asp.solver import solve_prepared
from foon_asp.encoding.clingo_run import run
from foon_asp.encoding.fact_writer import write_constraints, write_corrections
from foon_asp.encoding.own_encodings import question_encoding
from foon_asp.errors import BugError
from foon_asp.network import counted
from foon_asp.problem import Objective, Problem
from foon_asp.questions.answer import Answer
from foon_asp.questions.caller import caller
from foon_asp.questions.ending import Ending
from foon_asp.results.values import ListedConstraint, Value
from foon_asp.rules.passed_constraint import Constraint, find_constraint

_BY_UNITS = (Objective.UNITS,)


class WeightedConstraint(ListedConstraint, frozen=True):
    """A rule without a head that may be dropped.

    Attributes:
        weight: What it costs to drop it.
    """

    weight: int


class Clash(Value, frozen=True, kw_only=True):
    """Whether some constraints leave a tree, and if not, why.

    Attributes:
        complete: Whether it is known if the constraints clash; otherwise a limit came first.
        tree_exists_without_constraints: Whether there is a tree once all are dropped.
        constraints: All constraints.
        smallest_clash: A smallest set of constraints that cannot hold together; empty if none is known.
        smallest_proved: Whether no fewer constraints clash.
        cheapest_to_drop: The cheapest constraints to drop so that the others leave a tree. If a limit came
            first, cheaper ones may suffice.
        answer: The best tree by units without the dropped constraints; null where it is not known.

    Example:
        >>> ice = foon_asp.load().problem("ice")
        >>> rules = {"forbidden_motion": "crush", "required_motion": "crush"}
        >>> constraints = ["forbid_motion", "require_motion"]
        >>> found = foon_asp.why_not(ice, constraints=constraints, constants=rules).clash
        >>> found.smallest_proved, [constraint.line for constraint in found.smallest_clash]
        (True, [11, 12])
    """

    complete: bool = True
    tree_exists_without_constraints: bool = True
    constraints: tuple[WeightedConstraint, ...]
    smallest_clash: tuple[WeightedConstraint, ...] = ()
    smallest_proved: bool = False
    cheapest_to_drop: tuple[WeightedConstraint, ...] = ()
    answer: Answer | None = None

    @property
    def ending(self) -> Ending:
        """``DONE`` if a tree keeps to all constraints and the best one is proved.

        It is ``NEGATIVE`` if no tree exists without the constraints either. It is also ``NEGATIVE`` if the
        smallest clash and the best tree without the dropped constraints are proved. Otherwise it is
        ``LIMIT``.
        """
        if not self.tree_exists_without_constraints:
            return Ending.NEGATIVE
        if not self.complete or self.answer is None:
            return Ending.LIMIT
        if self.cheapest_to_drop:
            proved = self.smallest_proved and self.answer.status is Status.OPTIMAL
            return Ending.NEGATIVE if proved else Ending.LIMIT
        return self.answer.ending

    def lines(self, conditions: str) -> Iterator[str]:
        """Yield lines on the smallest clash, on the cheapest constraints to drop, and on the best tree.

        The best tree is the one without the dropped constraints. ``conditions`` names the conditions under
        which claims hold, such as ``strict containers``.
        """
        dropped, answer = self.cheapest_to_drop, self.answer
        if not self.tree_exists_without_constraints:
            yield f"no task tree is left whatever is dropped: proved ({conditions})"
            yield "other rules of the files rule it out"
            return
        if not self.complete:
            unknown = "unknown: stopped at a limit before it was known whether the constraints clash"
            yield f"{unknown} ({conditions})"
            if dropped:
                yield "without these there is a task tree; a cheaper set may do, or nothing has to be dropped"
                yield from _constraint_lines(dropped)
            return
        all_constraints = counted(len(self.constraints), "constraint")
        if not self.constraints:
            yield f"there is a task tree ({conditions}); foon-asp solve finds the best"
            return
        if not dropped:
            together = " together" * (len(self.constraints) > 1)
            yield f"no clash: the {all_constraints} can hold{together} ({conditions})"
            if answer is not None:
                yield from answer.headlines()
            return
        clash_size = len(self.smallest_clash)
        if not self.smallest_proved:
            unknown = "the smallest clash was not found within the limit"
            yield f"the {all_constraints} cannot hold together ({conditions}); {unknown}"
        elif len(self.constraints) == 1:
            yield f"1 constraint leaves no task tree: proved ({conditions})"
        elif clash_size == 1:
            yield f"1 of the {all_constraints} leaves no task tree by itself: proved ({conditions})"
        else:
            text = f"{clash_size} of the {all_constraints} cannot hold together"
            yield f"{text}, and no smaller set: proved ({conditions})"
        yield from _constraint_lines(self.smallest_clash)
        weight = sum(constraint.weight for constraint in dropped)
        weight_text = (
            "" if {constraint.weight for constraint in self.constraints} == {1} else f", weight {weight}"
        )
        yield f"cheapest to drop: {counted(len(dropped), 'constraint')}{weight_text}"
        yield from _constraint_lines(dropped)
        if answer is not None and answer.status is not Status.UNKNOWN:
            claim, *note = answer.headlines()
            yield f"without {'it' if len(dropped) == 1 else 'them'}: {claim}"
            yield from note


def find_clash(problem: Problem, settings: Settings, own_weights: Mapping[Constraint, int]) -> Clash:
    """Find a smallest clash of the constraints in ``settings``, and the cheapest constraints to drop.

    The result also has the tree with the fewest units if the cheapest constraints are dropped.
    ``own_weights`` has, by constraint, the cost of dropping one of its rules; the default is 1. At a limit,
    the result has what was found by then.

    The smallest clash is a smallest minimal unsatisfiable subset (MUS). It is found by implicit hitting sets
    (Ignatiev, Previti, Liffiton and Marques-Silva, Smallest MUS Extraction with Minimal Hitting Set
    Dualization, CP 2015). A correction set is a set of constraints without which a tree exists. Each
    iteration takes a smallest set of constraints that hits all correction sets found so far. If no tree keeps
    to this set, it is the clash. Otherwise, a further correction set is found.
    """
    deadline = settings.effective_deadline
    settings = settings._replace(deadline=deadline)
    constraints, relaxed = relax(settings.constraints, settings.constants, soft=False, deadline=deadline)
    weight_of = {find_constraint(c): weight for c, weight in own_weights.items()}
    by_number = {
        rule.number: WeightedConstraint(**asdict(rule.listed), weight=weight_of.get(rule.constraint, 1))
        for rule in constraints
    }
    weights = {number: constraint.weight for number, constraint in by_number.items()}
    settings = settings._replace(relaxed=relaxed)
    program = assemble(settings, caller().reporter.warning, problem=problem)
    hitting_set_encoding = (question_encoding("blame.lp"),)

    def clash_with(**fields: Any) -> Clash:
        """Return the result with all constraints, and with other attributes from ``fields``."""
        return Clash(constraints=tuple(by_number.values()), **fields)

    def constraints_of(numbers: Iterable[int]) -> tuple[WeightedConstraint, ...]:
        """Return the constraints with these numbers, in ascending order."""
        return tuple(by_number[number] for number in sorted(numbers))

    prepared = prepare(problem, _BY_UNITS, settings, program)
    if prepared.stopped:
        return clash_with(complete=False)
    if prepared.tree is None:
        return clash_with(tree_exists_without_constraints=False)
    dropping = "optimize(_dropping,1).\n"
    corrections: list[tuple[int, ...]] = []
    hitting_set: tuple[int, ...] = ()
    while True:
        dropping_run = prepared.run(
            dropping + write_constraints(weights, hitting_set), predicates=[("_dropped", 1)]
        )
        if dropping_run.units is None or not dropping_run.exhausted:
            break
        corrections.append(tuple(sorted(dropping_run.atoms["_dropped"])))
        if not corrections[-1]:
            break
        rules = write_constraints(weights, ()) + write_corrections(corrections)
        hitting_run = run(hitting_set_encoding, rules, CLINGO_OPTIONS, deadline, predicates=[("_blamed", 1)])
        if hitting_run.units is None or not hitting_run.exhausted:
            break
        hitting_set = tuple(sorted(hitting_run.atoms["_blamed"]))
    clashes = dropping_run.units is None and dropping_run.exhausted
    if not corrections:
        # Without these a tree exists, but perhaps they are not the cheapest.
        sufficient = dropping_run.atoms["_dropped"] if dropping_run.atoms else ()
        return clash_with(
            complete=clashes,
            tree_exists_without_constraints=not clashes,
            cheapest_to_drop=constraints_of(sufficient),
        )
    dropped = corrections[0]
    kept = write_constraints(weights, set(weights).difference(dropped))
    outcome = solve_prepared(prepared, _BY_UNITS, kept)
    if outcome.status is Status.INFEASIBLE:
        raise BugError("dropping the constraints does not leave a tree")
    return clash_with(
        smallest_clash=constraints_of(hitting_set) if clashes else (),
        smallest_proved=clashes,
        cheapest_to_drop=constraints_of(dropped),
        answer=Answer.of(outcome),
    )


def _constraint_lines(constraints: Iterable[WeightedConstraint]) -> Iterator[str]:
    """Yield the lines of each constraint: its place and its text."""
    for constraint in constraints:
        yield from constraint.lines()
