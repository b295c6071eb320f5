"""The delete relaxation of a planning task: its cheapest plan, which is h+."""

import contextlib
from collections.abc import Iterator
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Self, Unpack

from msgspec import structs

from foon_asp.asp import Reporter, Settings, Status
from foon_asp.dataset.paths import File, Files, as_paths
from foon_asp.deadline import Deadline
from foon_asp.json_layout import schema_name
from foon_asp.network import counted
from foon_asp.planning.strips_task import DERIVED, StripsTask
from foon_asp.planning.task_files import read_task
from foon_asp.problem import Costs, Objective, Problem
from foon_asp.questions.answer import Answer, answer_problem
from foon_asp.questions.caller import caller
from foon_asp.questions.ending import Ending, ending_of_status
from foon_asp.questions.posing import pose_without_data
from foon_asp.questions.python_options import Limits, start_deadline
from foon_asp.questions.question import Kind, Option, question
from foon_asp.questions.result import Result
from foon_asp.results.document import Unserialized
from foon_asp.results.plain_values import fraction_text
from foon_asp.results.table import Block
from foon_asp.results.values import Value
from foon_asp.whole_file import write_whole

if TYPE_CHECKING:
    from foon_asp.certificate import Certificate


class PlannedAction(Value, frozen=True):
    """An action of a plan, and its cost."""

    action: str
    cost: Fraction

    def __str__(self) -> str:
        return self.action


class Relaxed(Result, frozen=True, kw_only=True, tag=schema_name("relax")):
    """The cheapest plan of the delete relaxation of a planning task.

    Attributes:
        task: The name of the file.
        facts: The number of facts.
        actions: The number of reachable actions.
        status: optimal: proved that no plan is cheaper, however many actions it has; infeasible: proved that
            there is no plan; feasible and unknown: stopped at a limit with or without a plan.
        stopped: For feasible and unknown: at which limit, and while doing what.
        certificate: The file with a proof, where one was written.
        cost: The cost of the plan; null without a plan.
        lower_bound: A proved lower bound on the cost of all plans.
        plan: The actions, in an order that executes if nothing is deleted; null without a plan.
        seconds: The time of each phase, in seconds.

    Example:
        >>> import pathlib, tempfile
        >>> folder = pathlib.Path(tempfile.mkdtemp())
        >>> foon_asp.export(foon_asp.load().problem("ice")).write(folder)
        >>> found = foon_asp.relax([folder / "domain.pddl", folder / "problem.pddl"])
        >>> [str(action) for action in found.plan]
        ['(u26-twist)', '(u27-crush)']
        >>> found.pddl().splitlines()[0]
        '(u26-twist)'
    """

    task: str
    facts: int
    actions: int
    status: Status
    stopped: str | None
    certificate: str | None
    cost: Fraction | None
    lower_bound: Fraction | None
    plan: tuple[PlannedAction, ...] | None
    seconds: dict[str, float]

    @classmethod
    def of(cls, task: StripsTask, answer: Answer) -> Self:
        """Return the result for a task from the answer to its problem.

        The plan leaves out actions that only derive predicates. A plan whose cost is the lower bound is
        optimal, even if the search for one with fewer actions was stopped.

        Parameters:
            task: The task.
            answer: The answer, in which facts are object nodes and actions are units.
        """
        objective, problem = answer.objectives[0], answer.problem
        cost = None if answer.costs is None else Fraction(answer.costs.measure(objective))
        bound = answer.outcome.bounds.get(objective)
        proved = answer.status in {Status.OPTIMAL, Status.INFEASIBLE} or None is not cost == bound
        names = ((problem.network.motions[unit], unit) for unit in answer.ids or ())
        return cls(
            task=task.name,
            facts=len(task.facts),
            actions=task.action_count,
            status=Status.OPTIMAL if proved and answer else answer.status,
            stopped=None if proved else answer.stopped,
            certificate=None,
            cost=cost,
            lower_bound=None if bound is None else Fraction(bound),
            plan=tuple(
                PlannedAction(name, Fraction(problem.figure(objective, unit)))
                for name, unit in names
                if name != DERIVED
            )
            if answer
            else None,
            seconds=answer.seconds,
        ).set_unserialized(answer=answer, strips=task)

    answer = Unserialized[Answer]()
    """The answer, in which facts are object nodes and actions are units."""

    strips = Unserialized[StripsTask]()
    """The task that was read."""

    @property
    def problem(self) -> Problem:
        """The task as a problem: facts are object nodes, actions are units."""
        return self.answer.problem

    @property
    def proved(self) -> bool:
        """Whether it is proved that no plan is cheaper, or that none exists."""
        return self.status in {Status.OPTIMAL, Status.INFEASIBLE}

    @property
    def ending(self) -> Ending:
        """``DONE`` if the plan is proved the cheapest, ``NEGATIVE`` if it is proved that no plan exists."""
        return ending_of_status(self.status)

    @property
    def claim(self) -> str:
        """The claim about the cost, in one line."""
        if self.status is Status.INFEASIBLE:
            return "infeasible: proved that there is no plan, even where nothing is deleted"
        if self.cost is None:
            return f"unknown: stopped at {self.stopped or 'a limit'}, before any plan was found"
        cost = fraction_text(self.cost)
        if self.status is Status.OPTIMAL:
            return f"h+ = {cost}: proved that no plan is cheaper where nothing is deleted"
        bound = "nothing" if self.lower_bound is None else fraction_text(self.lower_bound)
        return f"h+ is at most {cost}, and at least {bound}: stopped at {self.stopped or 'a limit'}"

    def show(self) -> Iterator[Block]:
        """Return the cost, its proof, and the plan."""
        yield f"task: {self.task}, {counted(self.facts, 'fact')}, {counted(self.actions, 'action')}"
        yield self.claim
        if self.certificate is not None:
            yield f"proof: certificate ({self.certificate})"
        if self.plan:
            yield ""
        for number, step in enumerate(self.plan or (), 1):
            yield f"{number:>3}  {step}" + ("" if step.cost == 1 else f"    [{fraction_text(step.cost)}]")

    def pddl(self) -> str:
        """Return the plan as a plan file: an action on each line, then its cost; empty without a plan."""
        if self.cost is None:
            return ""
        kind = "unit cost" if self.strips.unit_cost else "general cost"
        lines = [*map(str, self.plan or ()), f"; cost = {fraction_text(self.cost)} ({kind})"]
        return "\n".join(lines) + "\n"

    def remark(self, format_: str) -> str:
        """Return the claim if the plan is not proved to be the cheapest; else an empty text."""
        return "" if self.ending is Ending.DONE else self.claim


@question(
    pose=pose_without_data,
    formats=("text", "json", "pddl"),
    help_="""
    \b
    foon-asp relax problem.pddl
    foon-asp relax output.sas --certificate proof.json
    foon-asp verify proof.json output.sas
    foon-asp relax domain.pddl problem.pddl --format pddl > relaxed.plan

    Without deletes, an action is a functional unit and a fact an object node, so the cheapest plan is the
    best task tree. Its cost is h+, a lower bound on every plan of the task. PDDL is read by Fast Downward's
    translator, which pip install 'foon-asp[pddl]' brings along: STRIPS with types, whole action costs, ADL
    and derived predicates. The domain may be left out where it stands beside the problem.

    Exits with 0 when the cost is proved, 1 when there is no plan, 2 for bad input, 3 when stopped at a
    limit.
    """,
)
def relax(
    task: Annotated[Files, Option(kind=Kind.FILE, many=True, metavar="TASK...", positional=True)] = (),
    *,
    certificate_file: Annotated[
        File | None, Option(kind=Kind.WRITTEN, flags=("--certificate",), metavar="FILE")
    ] = None,
    **limits: Unpack[Limits],
) -> Relaxed:
    """Find the cheapest plan of a planning task without its deletes, and prove that none is cheaper.

    Parameters:
        task: PROBLEM.pddl with DOMAIN.pddl, or TASK.sas as Fast Downward's translator writes it. One path or
            two.
        certificate_file: Also write a proof, which ``foon-asp verify FILE TASK...`` checks. If no proof
            is found, a warning says so, and no file is written.

    Returns:
        The ``plan``, its ``cost``, what is proved of it as ``status``, and the task as a ``problem``.

    Raises:
        UserError: for a file that cannot be read, and for what is beyond a delete relaxation.

    Example:
        >>> import pathlib, tempfile
        >>> folder = pathlib.Path(tempfile.mkdtemp())
        >>> foon_asp.export(foon_asp.load().problem("macaroni")).write(folder)
        >>> relaxed = foon_asp.relax([folder / "domain.pddl", folder / "problem.pddl"])
        >>> str(relaxed.cost), str(relaxed.status)
        ('9', 'optimal')
    """
    deadline = start_deadline(limits)
    relaxed = solve_relaxation(read_task(as_paths(task), deadline), deadline)
    if certificate_file is None:
        return relaxed
    certificate = _find_certificate(relaxed, deadline)
    if certificate is None:
        caller().reporter.warning("no certificate was found, and nothing is written")
        return relaxed
    write_whole(Path(certificate_file), certificate.text().encode())
    return structs.replace(relaxed, certificate=str(certificate_file)).set_unserialized(**relaxed.__dict__)


def solve_relaxation(task: StripsTask, deadline: Deadline) -> Relaxed:
    """Find the cheapest plan of the delete relaxation of a task.

    Among plans of this cost, one with fewer actions is preferred. But the search ends as soon as the cost is
    proved, so the plan may have more actions than it needs.
    """
    proof_deadline = Deadline(within=deadline)
    reporter = _StopWhenProved(caller().reporter, task.objective, proof_deadline)
    answer = answer_problem(task.problem(), (task.objective,), Settings(deadline=proof_deadline), reporter)
    return Relaxed.of(task, answer)


class _StopWhenProved(Reporter):
    """A reporter that ends the search once the cost of the incumbent equals the lower bound.

    It forwards only trees and bounds to another reporter.
    """

    def __init__(self, reporter: Reporter, objective: Objective, deadline: Deadline) -> None:
        self._reporter, self._objective, self._deadline = reporter, objective, deadline
        self._cost: int | Fraction | None = None
        self._lower_bound: int | Fraction | None = None

    def tree(self, costs: Costs) -> None:
        """Forward the costs of a new incumbent, and record its cost by the objective that is to be proved.

        If the cost equals the lower bound, this ends the search.
        """
        self._reporter.tree(costs)
        self._cost = costs.measure(self._objective)
        self._stop_if_proved()

    def bound(self, objective: Objective, bound: int | Fraction) -> None:
        """Forward a lower bound, and record it if it is on the cost to be proved.

        If it equals the cost of the incumbent, this ends the search.
        """
        self._reporter.bound(objective, bound)
        if objective is self._objective:
            self._lower_bound = bound
            self._stop_if_proved()

    def _stop_if_proved(self) -> None:
        """End the search if the incumbent costs as much as the lower bound.

        By ``units``, this does nothing: the search ends by itself, since there is no second objective.
        """
        if self._objective is not Objective.UNITS and None is not self._cost == self._lower_bound:
            self._deadline.stop_at_proof()


def _find_certificate(relaxed: Relaxed, deadline: Deadline) -> "Certificate | None":
    """Return a certificate that the plan is the cheapest, or that no plan exists.

    Return ``None`` if neither is proved or no certificate is found, and if a limit or ctrl-C stops the
    search.
    """
    from foon_asp.certificate import certify, certify_infeasible  # noqa: PLC0415 (slow to import)

    answer, units = relaxed.answer, relaxed.answer.ids
    with contextlib.suppress(KeyboardInterrupt), deadline.watched("looking for a certificate"):
        if relaxed.status is Status.OPTIMAL and units is not None:
            return certify(
                *(answer.problem, answer.objectives, units),
                expired=lambda: deadline.passed,
                cuts=answer.outcome.cuts,
                cases=answer.outcome.cases,
            )
        if relaxed.status is Status.INFEASIBLE:
            return certify_infeasible(answer.problem)
    return None
