"""The delete relaxation of a planning task: its cheapest plan, which is h+."""

import contextlib
from collections.abc import Iterator
from dataclasses import dataclass, replace
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING

from foon_asp.asp import Reporter, Settings, Status
from foon_asp.dataset.paths import File, Files, files
from foon_asp.deadline import Cancel, Deadline
from foon_asp.document.json_document import document, fraction_json, fraction_text
from foon_asp.network import counted
from foon_asp.planning.strips_task import REACHED, StripsTask
from foon_asp.planning.task_files import read_task
from foon_asp.problem import Costs, Objective, Problem
from foon_asp.problem.progress import OnProgress
from foon_asp.questions.answer import Answer, answered
from foon_asp.questions.arguments import begin
from foon_asp.questions.caller import caller
from foon_asp.questions.contract import Kind, Option, question
from foon_asp.questions.options import LIMITS
from foon_asp.questions.posing import no_data
from foon_asp.questions.result import Ending, Result
from foon_asp.report.whole_file import write_whole

if TYPE_CHECKING:
    from foon_asp.certificate import Certificate

TASK = Option(
    "task",
    "DOMAIN.pddl PROBLEM.pddl, or TASK.sas as Fast Downward's translator writes it.",
    Kind.FILE,
    default=(),
    many=True,
    metavar="TASK...",
    positional=True,
    python="One path or two.",
)


@dataclass(frozen=True, repr=False)
class Relaxed(Result):
    """The cheapest plan of a ``task`` without deletes, with an ``answer`` in which actions are units.

    ``certificate`` proves it, if one was asked for and found, and ``place`` is the file it was written to.

    Example:
        >>> import pathlib, tempfile
        >>> folder = pathlib.Path(tempfile.mkdtemp())
        >>> foon_asp.export(foon_asp.load().problem("ice")).write(folder)
        >>> foon_asp.relax([folder / "domain.pddl", folder / "problem.pddl"]).plan
        ('(u26-twist)', '(u27-crush)')
        >>> foon_asp.relax([folder / "domain.pddl", folder / "problem.pddl"]).pddl().splitlines()[0]
        '(u26-twist)'
    """

    task: StripsTask
    answer: Answer
    certificate: "Certificate | None" = None
    place: str | None = None

    @property
    def problem(self) -> Problem:
        """The task as a problem: facts are object nodes, actions are units."""
        return self.answer.problem

    @property
    def cost(self) -> Fraction | None:
        """What the plan costs; ``None`` where there is none."""
        costs = self.answer.costs
        return None if costs is None else Fraction(costs.measure(self._objective))

    @property
    def lower_bound(self) -> Fraction | None:
        """What no plan costs less than, as far as it is proved."""
        bound = self.answer.bounds.get(self._objective)
        return None if bound is None else Fraction(bound)

    @property
    def proved(self) -> bool:
        """Whether it is proved that no plan is cheaper, however many actions it has, or that none exists."""
        if self.answer.status in {Status.OPTIMAL, Status.INFEASIBLE}:
            return True
        return self.cost is not None and self.cost == self.lower_bound

    @property
    def plan(self) -> tuple[str, ...] | None:
        """The actions in an order that executes where nothing is deleted; ``None`` where there is no plan."""
        units = self.answer.units
        return None if units is None else tuple(name for name, _ in self._steps())

    @property
    def ending(self) -> Ending:
        """Done when the plan is proved to be the cheapest."""
        if not self.proved:
            return Ending.LIMIT
        return Ending.NEGATIVE if self.answer.units is None else Ending.DONE

    def text(self) -> str:
        """Give the cost, what is proved of it, and the plan."""
        return "\n".join(self._lines()) + "\n"

    def pddl(self) -> str:
        """Give the plan as planners write them; empty where there is none."""
        if self.cost is None:
            return ""
        kind = "unit cost" if self._objective is Objective.UNITS else "general cost"
        return "\n".join([*(self.plan or ()), f"; cost = {fraction_text(self.cost)} ({kind})"]) + "\n"

    def remark(self, format_: str) -> str:
        """Say what is claimed, where that is not the cheapest plan."""
        return "" if self.ending is Ending.DONE else self._headline()

    def json_dict(self) -> object:
        """Give the same; docs/json.md describes it."""
        answer = self.answer
        status = Status.OPTIMAL if self.proved and answer.units is not None else answer.status
        return document(
            "relax",
            task=self.task.name,
            facts=len(self.task.facts),
            actions=len(self.task.actions),
            status=str(status),
            stopped=None if self.proved else answer.stopped,
            certificate=self.place if self.certificate else None,
            cost=fraction_json(self.cost),
            lower_bound=fraction_json(self.lower_bound),
            plan=None
            if answer.units is None
            else [{"action": name, "cost": fraction_json(cost)} for name, cost in self._steps()],
            seconds={phase: round(seconds, 6) for phase, seconds in answer.seconds.items()},
        )

    @property
    def _objective(self) -> Objective:
        return self.answer.objectives[0]

    def _steps(self) -> Iterator[tuple[str, Fraction]]:
        for unit in self.answer.units or ():
            name = self.problem.network.motions[unit]
            if name != REACHED:
                yield name, Fraction(self.problem.figure(self._objective, unit))

    def _headline(self) -> str:
        if self.cost is None:
            if self.answer.status is Status.INFEASIBLE:
                return "infeasible: proved that there is no plan, even where nothing is deleted"
            return f"unknown: stopped at {self.answer.stopped or 'a limit'}, before any plan was found"
        cost = fraction_text(self.cost)
        if self.proved:
            return f"h+ = {cost}: proved that no plan is cheaper where nothing is deleted"
        bound = "nothing" if self.lower_bound is None else fraction_text(self.lower_bound)
        return f"h+ is at most {cost}, and at least {bound}: stopped at {self.answer.stopped or 'a limit'}"

    def _lines(self) -> Iterator[str]:
        task = self.task
        yield f"task: {task.name}, {counted(len(task.facts), 'fact')}, {counted(len(task.actions), 'action')}"
        yield self._headline()
        if self.certificate is not None:
            yield f"proof: certificate ({self.place})"
        elif self.place is not None:
            yield "no certificate was found, and nothing is written"
        if self.plan:
            yield ""
        for number, (name, cost) in enumerate(self._steps(), 1):
            yield f"{number:>3}  {name}" + ("" if cost == 1 else f"    [{fraction_text(cost)}]")

    def __repr__(self) -> str:
        return f"<Relaxed: {self._headline()}>"


@question(
    TASK,
    Option(
        "certificate_file",
        "Also write a proof, which `foon-asp verify FILE TASK...` checks.",
        Kind.FILE,
        flags=("--certificate",),
        metavar="FILE",
    ),
    *LIMITS,
    pose=no_data,
    formats=("text", "json", "pddl"),
    help_="""
    \b
    foon-asp relax domain.pddl problem.pddl
    foon-asp relax output.sas --certificate proof.json
    foon-asp verify proof.json output.sas
    foon-asp relax domain.pddl problem.pddl --format pddl > relaxed.plan

    Without deletes, an action is a functional unit and a fact an object node, so the cheapest plan is the
    best task tree. Its cost is h+, a lower bound on every plan of the task. STRIPS is read, with action
    costs, negation, equality, quantifiers and disjunctions; conditional effects, axioms and numeric fluents
    are refused.

    Exits with 0 when the cost is proved, 1 when there is no plan, 2 for bad input, 3 when stopped at a
    limit.
    """,
)
def relax(
    task: Files = (),
    *,
    certificate_file: File | None = None,
    time_limit: float | None = None,
    memory_limit: int | str | None = None,
    on_progress: OnProgress | None = None,
    cancel: Cancel | None = None,
) -> Relaxed:
    """Find the cheapest plan of a planning task without its deletes, and prove that none is cheaper.

    Parameters:
        certificate_file: The path of the file to write a certificate to.

    Returns:
        The ``plan``, its ``cost``, whether that is ``proved``, and the task as a ``problem``.

    Raises:
        UserError: for a file that cannot be read, and for what is beyond a delete relaxation.

    Example:
        >>> import pathlib, tempfile
        >>> folder = pathlib.Path(tempfile.mkdtemp())
        >>> foon_asp.export(foon_asp.load().problem("macaroni")).write(folder)
        >>> relaxed = foon_asp.relax([folder / "domain.pddl", folder / "problem.pddl"])
        >>> str(relaxed.cost), relaxed.proved
        ('9', True)
    """
    deadline = begin(time_limit, memory_limit)
    read = read_task(files(task), deadline)
    found = solved(read, deadline)
    if certificate_file is None:
        return found
    certificate = _certificate(found, deadline)
    if certificate is not None:
        write_whole(Path(certificate_file), certificate.text().encode())
    return replace(found, certificate=certificate, place=str(certificate_file))


def solved(task: StripsTask, deadline: Deadline) -> Relaxed:
    """Find the cheapest plan of a task that was read.

    Among plans that cost the same, the shortest is looked for, but no longer than the cost takes to prove.
    """
    own = Deadline(within=deadline)
    reporter = _Enough(caller().reporter, task.objective, own)
    answer = answered(task.problem(), (task.objective,), Settings(deadline=own), reporter)
    return Relaxed(task, answer)


class _Enough(Reporter):
    """Passes on what it hears, and stops the search when the cost of the best plan is proved."""

    def __init__(self, reporter: Reporter, objective: Objective, deadline: Deadline) -> None:
        self._reporter, self._objective, self._deadline = reporter, objective, deadline
        self._cost: int | Fraction | None = None
        self._least: int | Fraction | None = None

    def tree(self, costs: Costs) -> None:
        """Note the cost of the best plan."""
        self._reporter.tree(costs)
        self._cost = costs.measure(self._objective)
        self._compare()

    def bound(self, objective: Objective, bound: int | Fraction) -> None:
        """Note what no plan costs less than."""
        self._reporter.bound(objective, bound)
        if objective is self._objective:
            self._least = bound
            self._compare()

    def _compare(self) -> None:
        if self._objective is not Objective.UNITS and None is not self._cost == self._least:
            self._deadline.enough()


def _certificate(found: Relaxed, deadline: Deadline) -> "Certificate | None":
    """Look for a proof of the cost alone; at a limit or ctrl-C there is none."""
    from foon_asp.certificate import certify, certify_infeasible  # noqa: PLC0415 (slow to import)

    answer, units = found.answer, found.answer.units
    with contextlib.suppress(KeyboardInterrupt), deadline.watched("looking for a certificate"):
        if units is not None and found.proved:
            return certify(
                *(answer.problem, answer.objectives, units),
                expired=lambda: deadline.passed,
                cuts=answer.cuts,
                cases=answer.cases,
            )
        if answer.status is Status.INFEASIBLE:
            return certify_infeasible(answer.problem)
    return None
