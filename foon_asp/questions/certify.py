"""Certificates for answers and for trees of other programs, checked without a solver."""

import contextlib
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Self

from foon_asp.asp import Settings, Status
from foon_asp.asp.assembly import assemble
from foon_asp.asp.used_up import require_built_for_plans, require_rules_of_plans
from foon_asp.certificate import (
    Certificate,
    Coverage,
    NotBestError,
    certify_outcome,
    certify_plan,
    coverage,
    covered_for_plans,
)
from foon_asp.certificate import certify as prove_best
from foon_asp.dataset import Dataset
from foon_asp.dataset.nearby_optimum import near_goals
from foon_asp.dataset.paths import File, Files
from foon_asp.deadline import Cancel
from foon_asp.errors import UserError
from foon_asp.network import unit_at_level
from foon_asp.problem import Objective, Problem, levels
from foon_asp.problem.progress import OnProgress
from foon_asp.proof.replay import replay_for
from foon_asp.proof.simulation import Verdict, simulate_for
from foon_asp.proof.verify import Subject
from foon_asp.questions.answer import Answer, answered, answered_nearby
from foon_asp.questions.answer_and_more import AnswerAndMore
from foon_asp.questions.arguments import (
    Constants,
    Objectives,
    chosen_objectives,
    reading,
    settings,
    whole,
)
from foon_asp.questions.caller import caller
from foon_asp.questions.contract import Kind, Option, question
from foon_asp.questions.options import CONTAINERS, GOALS, ITEMS, LIMITS, OBJECTIVES, RULES
from foon_asp.questions.posing import one_problem_or_nearby
from foon_asp.questions.result import Ending, Result
from foon_asp.questions.tree import read_listed
from foon_asp.report.answer import costs_text, headline
from foon_asp.report.certified import bound_text, certificate_lines
from foon_asp.report.whole_file import write_whole
from foon_asp.text.json_value import Json


@dataclass(frozen=True, repr=False)
class Certified(AnswerAndMore[Answer]):
    """An ``answer`` and the ``certificate`` that proves it, which is ``None`` if none was found.

    ``certificate.text()`` is the content of the file to write; ``certificate.claim`` tells what is proved:
    ``optimal``, ``infeasible``, or only a ``bound``. ``place`` names the file, once it is written.

    Example:
        >>> certified = foon_asp.certify(foon_asp.load().problem("ice"))
        >>> certified.certificate.claim, certified.place
        ('optimal', 'in memory')
        >>> import pathlib, tempfile
        >>> certified.written(pathlib.Path(tempfile.mkdtemp()) / "ice.json").place == "in memory"
        False
    """

    certificate: Certificate | None
    place: str = "in memory"

    def lines(self) -> list[str]:
        """Say what proves the answer."""
        return certificate_lines(self.answer, self.certificate, self.place)

    def written(self, file: File) -> Self:
        """Write the certificate into a file, if there is one.

        Parameters:
            file: The path of the file.

        Returns:
            The same result, with the file as its ``place``.

        Raises:
            UserError: if the file cannot be written.
        """
        _write(self.certificate, Path(file))
        return replace(self, place=str(file))


@dataclass(frozen=True, repr=False)
class Proof(Result):
    """What ``foon-asp certify`` gives: a ``certificate``, and in words what it proves or why there is none.

    ``shown`` says that it was not written into a file; ``ended`` is how the question ended.
    """

    certificate: Certificate | None
    words: str
    ended: Ending
    shown: bool = True

    @property
    def ending(self) -> Ending:
        """Done when a tree is proved to be the best by every objective."""
        return self.ended

    def text(self) -> str:
        """Say what is proved, or why nothing is."""
        return f"{self.words}\n"

    def json_dict(self) -> Json:
        """Give the certificate as plain values; raises :class:`UserError` where there is none."""
        if self.certificate is None:
            raise UserError(self.words)
        return self.certificate.content

    def json_text(self) -> str:
        """Give the certificate as it is written; empty where there is none or it was written into a file."""
        return self.certificate.text() if self.certificate is not None and self.shown else ""

    def remark(self, format_: str) -> str:
        """Say what is proved, or why nothing is."""
        return self.words


def certified(problem: Problem, objectives: Sequence[Objective], how: Settings) -> Certified:
    """Solve a problem, and look for a certificate; at a limit or ctrl-C the answer comes without one."""
    deadline = how.begun
    how = how._replace(deadline=deadline)
    ruled = how.constraints or how.constants or how.encodings
    plain = not ruled and problem.items is None and Objective.PRICE not in objectives
    near = near_goals(problem, objectives, how) if plain else None
    with reading():
        subject = near.subject() if near is not None else _subject(problem) if plain else None
    if near is None:
        answer = answered(whole(problem) if subject is None else problem, objectives, how)
        proved = answer.problem
    else:
        answer = answered_nearby(near, objectives, how)
        proved = near.relaxed
    certificate = None
    with contextlib.suppress(KeyboardInterrupt), deadline.watched("looking for a certificate"):
        outcome, certificate = certify_outcome(
            answer._replace(problem=proved), how, lambda: deadline.passed, subject
        )
        answer = Answer._make(outcome._replace(problem=answer.problem))
    return Certified(answer, certificate)


def _subject(problem: Problem) -> Subject | None:
    """Give what a certificate speaks about, if it need not be read; ``None`` where the problem has it."""
    data = problem.origin
    if not problem.network.object_numbers or not isinstance(data, Dataset) or problem.own_rates:
        return None
    return data.with_kitchen_of(problem).subject(everything=False)


def certify_and_write(
    problem: Problem,
    objectives: Objectives = "units",
    *,
    tree: File | None = None,
    file: File | None = None,
    constraints: Files = (),
    constants: Constants | None = None,
    encodings: File | None = None,
    time_limit: float | None = None,
    memory_limit: int | str | None = None,
) -> Proof:
    """Certify as ``foon-asp certify`` does: the optimum or a given ``tree``, into a file or to be shown."""
    chosen = chosen_objectives(problem, objectives)
    how = settings(constraints, constants, encodings, time_limit, memory_limit)
    if tree is not None:
        found = certify_tree(problem, chosen, Path(tree), how)
    else:
        found = _proof(certified(problem, chosen, how), "standard output" if file is None else str(file))
    if file is None:
        return found
    _write(found.certificate, Path(file))
    return replace(found, shown=False)


def _proof(found: Certified, place: str) -> Proof:
    answer, certificate = found.answer, found.certificate
    words = "\n".join([headline(answer), *certificate_lines(answer, certificate, place)])
    ended = Ending.LIMIT
    if certificate is not None:
        if answer.status is Status.INFEASIBLE:
            ended = Ending.NEGATIVE
        elif certificate.claim == "optimal" and certificate.certified == levels(answer.objectives):
            ended = Ending.DONE
    return Proof(certificate, words, ended)


def certify_tree(problem: Problem, objectives: tuple[Objective, ...], file: Path, how: Settings) -> Proof:
    """Prove a given tree best, with no solver but the linear relaxation."""
    problem, deadline = whole(problem), how.begun
    # no solver looks at the rules and constants here, so a fault in them would go by without a word
    program = assemble(how, caller().reporter.warning, problem.items is not None)
    covered = coverage(how)
    if problem.items is not None:
        require_built_for_plans(how)
        require_rules_of_plans(program)
        return _certify_plan(problem, objectives, file, how, covered)
    with reading():
        ordered = _executable(problem, file, covered)
    if isinstance(ordered, str):
        return Proof(None, f"no certificate: {ordered}", Ending.NEGATIVE)
    wanted = levels(objectives)
    by = ", then ".join(wanted)
    try:
        with deadline.watched("looking for a certificate"):
            certificate = prove_best(problem, wanted, ordered, covered, lambda: deadline.passed)
    except NotBestError as better:
        words = (
            f"no certificate: the tree is not the best by {by}: it has {costs_text(problem.costs(ordered))}, "
            f"and there is one with {costs_text(better.costs)}"
        )
        return Proof(None, words, Ending.NEGATIVE)
    return _given(certificate, wanted)


def _given(certificate: Certificate | None, wanted: tuple[Objective, ...]) -> Proof:
    """Say what is proved of a tree or plan that was given."""
    if certificate is None:
        return Proof(None, "no certificate was found", Ending.LIMIT)
    if certificate.claim == "bound":
        words = f"a bound only: {bound_text(certificate.content)}"
        return Proof(certificate, words, Ending.LIMIT)
    words = f"proved best by {', then '.join(certificate.certified)}"
    ended = Ending.DONE if certificate.certified == wanted else Ending.LIMIT
    return Proof(certificate, words, ended)


def _certify_plan(
    problem: Problem, objectives: tuple[Objective, ...], file: Path, how: Settings, covered: Coverage
) -> Proof:
    """Prove a given plan best, or how much every plan costs at least."""
    covered = covered_for_plans(covered)
    with reading():
        plan = _running(problem, file, covered)
    if isinstance(plan, str):
        return Proof(None, f"no certificate: {plan}", Ending.NEGATIVE)
    wanted, deadline = levels(objectives), how.begun
    problem.require_known_for(wanted)
    with deadline.watched("looking for a certificate"):
        certificate = certify_plan(problem, wanted, plan, covered, lambda: deadline.passed)
    return _given(certificate, wanted)


def _running(problem: Problem, file: Path, covered: Coverage) -> list[int] | str:
    """Read a plan that runs as it is listed, or say why it does not."""
    listed = [unit for unit, _ in read_listed(file)[0]]
    units = [problem.network.unit_id(unit) for unit in listed]
    known = [unit for unit in units if unit is not None]
    if len(known) < len(listed):
        return "a unit of the plan is not in the network"
    if replay_for(problem, listed).shortage is not None:
        return "the plan does not run; `foon-asp check` says why"
    chosen, ruled = Counter(known), covered.ruled(problem)
    fault = ruled.fault(frozenset(chosen), frozenset(range(len(problem.network))) - chosen.keys())
    for limit in ruled.limits.values():
        if sum(limit.amounts.get(unit, 0) * count for unit, count in chosen.items()) > limit.most:
            fault = "exceeds what a rule limits"
    return known if fault is None else f"by the constraints, the plan {fault}"


def _executable(problem: Problem, file: Path, covered: Coverage) -> list[int] | str:
    """Read a tree in an order that executes, or say why it has none."""
    tree = [unit_at_level(unit, problem.network.level) for unit, _ in read_listed(file)[0]]
    units = [problem.network.unit_id(unit) for unit in tree]
    known = [unit for unit in units if unit is not None]
    simulation = simulate_for(problem, problem.tree(known))
    if len(known) < len(tree) or len(set(known)) < len(known):
        return "a unit of the tree is not in the network, or appears twice"
    if simulation.verdict is Verdict.NEVER:
        return "the tree does not execute; `foon-asp check` says why"
    chosen = frozenset(known)
    fault = covered.ruled(problem).fault(chosen, frozenset(range(len(problem.network))) - chosen)
    if fault is not None:
        return f"by the constraints, the tree {fault}"
    return [known[position] for position in simulation.order]


def _write(certificate: Certificate | None, file: Path) -> None:
    if certificate is not None:
        write_whole(file, certificate.text().encode())


@question(
    GOALS,
    Option("tree", "A task tree or plan to prove the best.", Kind.FILE, metavar="TREE.txt"),
    Option(
        "file", "The file to write; by default stdout.", Kind.FILE, flags=("-o", "--output"), metavar="FILE"
    ),
    OBJECTIVES,
    CONTAINERS,
    *ITEMS,
    *RULES,
    *LIMITS,
    formats=("json",),
    pose=one_problem_or_nearby,
    command=certify_and_write,
    help_="""
    \b
    foon-asp certify --goal 'greek salad' -o proof.json           the optimum is found and proved
    foon-asp certify --goal macaroni --tree tree.txt -o t.json    a tree in FOON text is proved best
    foon-asp certify --goal macaroni --items used-up -o p.json    a plan, and what every plan costs at least

    Exits with 0 when the certificate proves a tree optimal by every objective; with 1 when it proves that
    there is no tree, or when the tree given does not execute or is not the best; with 3 when it proves less
    (a bound, or the first objectives alone) or when none was found. Where items are used up, a plan is meant.
    """,
)
def certify(
    problem: Problem,
    objectives: Objectives = "units",
    *,
    constraints: Files = (),
    constants: Constants | None = None,
    encodings: File | None = None,
    time_limit: float | None = None,
    memory_limit: int | str | None = None,
    on_progress: OnProgress | None = None,
    cancel: Cancel | None = None,
) -> Certified:
    """Solve a problem, and find a certificate: a proof of the answer, which :func:`foon_asp.verify` checks.

    A certificate is about the whole network. Of a store, no more is read than the proof touches where no rule
    is given: then the certificate names the digests that the store states. Where items are used up, it says
    what every plan costs at least, and has a plan of that cost, or of more: then the claim is a ``bound``.

    Returns:
        The ``answer``, and the ``certificate``, which is ``None`` if no proof was found.

    Raises:
        UserError: for a wrong argument or constraint, or an objective that needs rates or prices not given.

    Example:
        >>> certified = foon_asp.certify(foon_asp.load().problem("greek salad"), "success")
        >>> certified.certificate.claim
        'optimal'
    """
    chosen = chosen_objectives(problem, objectives)
    return certified(problem, chosen, settings(constraints, constants, encodings, time_limit, memory_limit))
