"""The cheapest repair of a tree that does not execute: ``foon-asp check --repair``."""

import contextlib
from collections.abc import Callable, Iterable, Iterator
from os import PathLike
from pathlib import Path
from typing import Unpack

from foon_asp.asp import Outcome, Proof, Settings, Status
from foon_asp.asp.optimum import solve
from foon_asp.certificate import Certificate, NotBestError, certify, certify_infeasible
from foon_asp.certificate.coverage import Coverage
from foon_asp.dataset import Dataset
from foon_asp.dataset.paths import File
from foon_asp.errors import BugError, UserError
from foon_asp.json_layout import schema_name
from foon_asp.network import FunctionalUnit, ObjectNode, StandInTable, counted
from foon_asp.problem import Costs, Objective, Problem
from foon_asp.proof.rule_meaning import ALL_STEPS
from foon_asp.proof.simulation import Verdict, simulate_for
from foon_asp.questions.caller import caller
from foon_asp.questions.certificate_text import certificate_lines
from foon_asp.questions.ending import Ending, ending_of_status
from foon_asp.questions.python_arguments import over_whole_network
from foon_asp.questions.python_options import CommonOptions, settings_of
from foon_asp.questions.question import python_question
from foon_asp.questions.result import Result
from foon_asp.questions.stand_in import StandIn, stand_in_lines, stand_ins_in
from foon_asp.questions.tree import Tree, as_tree
from foon_asp.results.document import AboutGoals, Unserialized
from foon_asp.results.table import Block
from foon_asp.results.values import Node, Step
from foon_asp.results.values_of import nodes_of, question_fields, steps_of
from foon_asp.standins.repair import Repair
from foon_asp.text.writer import write_units
from foon_asp.whole_file import write_whole

_OBJECTIVES = Objective.DISSIMILARITY, Objective.UNITS


class Repaired(Result, AboutGoals, frozen=True, kw_only=True, tag=schema_name("repair")):
    """The cheapest repair of a tree: every step of it executes, with stand-ins and with units of a network.

    Attributes:
        verdict: Whether the tree executes as it is.
        status: optimal: proved cheapest; feasible: stopped at a limit with a repair; infeasible: proved that
            no repair exists; unknown: stopped without a repair.
        proof: What proves the status; null where nothing is proved.
        costs: What the repaired tree costs; null without a repair.
        stand_ins: What is used in place of what.
        added: The numbers, from 1, of the steps that the given tree did not have; stand-ins are not counted.
        order: For each step of the given tree, its number in the repaired tree, from 1; empty without a
            repair.
        lacking: If no repair exists: object nodes that nothing makes and nothing stands in for.
        units: The steps of the repaired tree; null without a repair.

    Example:
        >>> tree = foon_asp.search(foon_asp.load().problem("macaroni"), "bfs").tree
        >>> repaired = foon_asp.repair(foon_asp.load().problem("macaroni"), tree)
        >>> str(repaired.status), len(repaired.stand_ins), len(repaired.added)
        ('optimal', 0, 0)
    """

    ROWS = "stand_ins"

    verdict: Verdict
    status: Status
    proof: Proof | None
    costs: Costs | None
    stand_ins: tuple[StandIn, ...]
    added: tuple[int, ...]
    order: tuple[int, ...]
    lacking: tuple[Node, ...]
    units: tuple[Step, ...] | None

    @property
    def ending(self) -> Ending:
        """``DONE`` if the repair is proved the cheapest, ``NEGATIVE`` if none exists, else ``LIMIT``."""
        return ending_of_status(self.status)

    tree = Unserialized[Tree | None](None)
    """The repaired tree; ``None`` without one."""

    outcome = Unserialized[Outcome | None](None)
    """The outcome of the solver for the problem in which every step is a goal."""

    certificate = Unserialized[Certificate | None](None)
    """The certificate that proves the repair the cheapest, where one was asked for and found."""

    notes = Unserialized[tuple[str, ...]](())
    """What the certificate proves, where one was asked for."""

    def remark(self, format_: str) -> str:
        """Return the notes on the certificate, one on each line; empty without any."""
        return "\n".join(self.notes)

    def foon(self) -> str:
        """Return the repaired tree as FOON text; empty without a repair."""
        if self.tree is None:
            return ""
        comments = [f"Repaired tree for: {' + '.join(map(str, self.goals))}"]
        return write_units(self.tree.units, comments, self.tree.problem.amounts)

    def show(self) -> Iterator[Block]:
        """Return what has to change, and the steps of the repaired tree; or why there is no repair."""
        yield from self.goal_lines()
        yield f"as it is: {self.verdict}"
        if self.units is None:
            yield from self._without_repair()
            yield from self.notes
            return
        claim = "proved cheapest" if self.status is Status.OPTIMAL else "not proved cheapest"
        changes = [counted(len(self.stand_ins), "stand-in"), f"{counted(len(self.added), 'step')} added"]
        if list(self.order) != sorted(self.order):
            changes.append("in another order")
        yield f"repaired ({self.conditions}; {claim}): {', '.join(changes)}"
        yield from stand_in_lines(self.stand_ins)
        yield ""
        for step in self.units:
            yield from step.lines()
            if step.step in self.added:
                yield "     (added)"
        yield from self.notes

    def _without_repair(self) -> Iterator[str]:
        """Yield why there is no repair."""
        if self.status is not Status.INFEASIBLE:
            yield "unknown: stopped at a limit before a repair was found"
            return
        yield f"no repair exists: proved ({self.conditions})"
        if self.lacking:
            yield "nothing makes, and nothing stands in for:"
            yield from (f"  {node}" for node in self.lacking)


@python_question
def repair(
    problem: Problem,
    tree: str | PathLike[str] | Iterable[FunctionalUnit],
    *,
    certificate: File | None = None,
    **options: Unpack[CommonOptions],
) -> Repaired:
    """Find the cheapest repair of a tree: the least dissimilarity, then the fewest units.

    Every step of the tree executes once it is repaired. For that, available nodes stand in for others, units
    of the network of the problem are added, and the order changes.

    Parameters:
        tree: The path of a file (FOON text, or an answer in JSON), or functional units in the order listed.
        certificate: The path of a file to write a certificate to: a proof of the repair that
            :func:`foon_asp.verify` checks without a solver. It is about the network of the problem, which has
            to have all units of the tree.

    Returns:
        The repair, with its ``stand_ins``, ``added`` steps and the repaired ``tree``.

    Raises:
        UserError: if the file cannot be read, if items are used up, if there are constraints or encodings, or
            if a certificate is wanted and the network lacks a unit of the tree.

    Example:
        >>> problem = foon_asp.load().problem("ice")
        >>> foon_asp.repair(problem, foon_asp.solve(problem).tree).order
        (1, 2)
    """
    settings = settings_of(options)
    if settings.constraints or settings.replaced is not None:
        raise UserError("a tree is repaired without rules and encodings: leave them out")
    table = StandInTable.usual() if problem.stand_ins is None else problem.stand_ins.table
    listed = as_tree(problem, tree)
    base_problem = over_whole_network(problem) if problem.stand_ins is None else problem
    if certificate is not None and any(base_problem.network.unit_id(unit) is None for unit in listed.units):
        raise UserError(
            "a certificate is about the network, and that lacks units of the tree: name the tree, too"
        )
    needed = Repair.of(base_problem, listed.units, listed.places, table, _kitchen_lists(problem))
    verdict = simulate_for(needed.shown, listed).verdict
    outcome = solve(needed.posed, _OBJECTIVES, settings, caller().reporter)
    found_certificate: Certificate | None = None
    notes: tuple[str, ...] = ()
    if certificate is not None:
        outcome, found_certificate = _certify_repair(needed, outcome, settings)
        notes = tuple(certificate_lines(outcome, found_certificate, str(certificate)))
        if found_certificate is not None:
            write_whole(Path(certificate), found_certificate.text().encode())
    shown_problem, units = needed.shown, outcome.units
    if units is None:
        lacking = (
            nodes_of(shown_problem.network, needed.unmakeable_nodes())
            if outcome.status is Status.INFEASIBLE
            else ()
        )
    else:
        lacking = ()
    positions = {unit: number for number, unit in enumerate(units or (), 1)}
    repaired = Repaired(
        **question_fields(shown_problem, _OBJECTIVES),
        verdict=verdict,
        status=outcome.status,
        proof=outcome.proof,
        costs=None if units is None else shown_problem.costs(units),
        stand_ins=() if units is None else stand_ins_in(shown_problem, units),
        added=tuple(positions[unit] for unit in needed.added_units(units or ())),
        order=tuple(positions[unit] for unit in needed.steps) if positions else (),
        lacking=lacking,
        units=None if units is None else steps_of(shown_problem, units),
    )
    return repaired.set_unserialized(
        tree=None if units is None else Tree.of(shown_problem, units),
        outcome=outcome,
        certificate=found_certificate,
        notes=notes,
    )


def _certify_repair(
    needed: Repair, outcome: Outcome, settings: Settings
) -> tuple[Outcome, Certificate | None]:
    """Return the outcome of a repair, and a certificate that it is the cheapest or that no repair exists.

    The certificate is ``None`` if nothing is proved, or if it is not found in time. If it covers all
    objectives, it becomes the proof of the outcome. If it proves only a bound, the outcome is unchanged.
    Raises :class:`BugError` if a better tree exists.
    """
    covered = Coverage(({"rule": ALL_STEPS, "units": sorted(needed.steps)},))
    deadline, problem, certificate = settings.effective_deadline, needed.shown, None
    with contextlib.suppress(KeyboardInterrupt), deadline.watched("looking for a certificate"):
        if outcome.status is Status.INFEASIBLE:
            certificate = certify_infeasible(problem, covered, lambda: deadline.passed)
        elif outcome.status is Status.OPTIMAL and outcome.units is not None:
            try:
                certificate = certify(problem, _OBJECTIVES, outcome.units, covered, lambda: deadline.passed)
            except NotBestError as better:
                raise BugError(f"a repair was called the cheapest: {better}") from None
    if certificate is None or certificate.claim == "bound":
        return outcome, certificate
    complete = certificate.claim == "infeasible" or certificate.certified == _OBJECTIVES
    proof = Proof.CERTIFICATE if complete else outcome.proof
    return outcome._replace(proof=proof, certified=certificate.certified), certificate


def _kitchen_lists(problem: Problem) -> Callable[[ObjectNode], bool]:
    """Return a function that says whether an entry of the kitchen file matches a node.

    The network need not have the node. Without a kitchen file, no entry matches.
    """
    data = problem.origin.data if isinstance(problem.origin, Dataset) else None
    items = () if data is None else data.kitchen_items
    return lambda node: any(item.pattern.matches(node) for item in items)
