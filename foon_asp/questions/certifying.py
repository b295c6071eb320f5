"""Certificates of optimal trees, found or given: proofs that are checked without a solver."""

import contextlib
from collections.abc import Sequence
from pathlib import Path

from foon_asp.asp import Settings
from foon_asp.certificate import (
    Certificate,
    NotBestError,
    certify,
    certify_outcome,
    certify_plan,
    coverage,
    covered_for_plans,
)
from foon_asp.dataset import Dataset
from foon_asp.dataset.nearby_optimum import near_goals
from foon_asp.dataset.paths import File
from foon_asp.problem import Objective, Problem, levels
from foon_asp.proof.verifier import Subject
from foon_asp.questions.answer import Answer, answered, answered_nearby
from foon_asp.questions.certificate_text import bound_text, certificate_lines, looked_at
from foon_asp.questions.python_arguments import asked_with, reading, whole
from foon_asp.questions.result import Ending
from foon_asp.questions.tree import Tree
from foon_asp.results.figure_text import costs_text
from foon_asp.whole_file import write_whole


def certified(
    problem: Problem, objectives: Sequence[Objective], settings: Settings, file: File | None = None
) -> Answer:
    """Solve a problem, and search for a certificate; at a limit or ctrl-C the answer has none.

    If the certificate is written into a ``file``, notes of the answer say what it proves.
    """
    deadline = settings.begun
    settings = settings._replace(deadline=deadline)
    ruled = settings.constraints or settings.constants or settings.encodings
    plain = not ruled and problem.items is None and Objective.PRICE not in objectives
    nearby = near_goals(problem, objectives, settings) if plain else None
    with reading():
        subject = nearby.subject() if nearby is not None else _subject(problem) if plain else None
    if nearby is None:
        only_best = problem.stand_ins is not None and asked_with(problem, settings, objectives) is problem
        complete = problem if only_best or subject is not None else whole(problem)
        answer = answered(complete, objectives, settings)
        proved = answer.problem
    else:
        answer = answered_nearby(nearby, objectives, settings)
        proved = nearby.relaxation
    certificate = None
    with contextlib.suppress(KeyboardInterrupt), deadline.watched("looking for a certificate"):
        outcome, certificate = certify_outcome(
            answer.outcome._replace(problem=proved), settings, lambda: deadline.passed, subject
        )
        answer = Answer.of(outcome._replace(problem=answer.problem))
    if file is None:
        return answer.having(certificate=certificate)
    _write(certificate, file)
    return answer.having(certificate_lines(answer.outcome, certificate, str(file)), certificate)


def _subject(problem: Problem) -> Subject | None:
    """Return the subject of a certificate for a problem over a part of a store; ``None`` for others."""
    data = problem.origin
    if not problem.network.object_numbers or not isinstance(data, Dataset) or problem.own_rates:
        return None
    network = problem.network
    goals = [network.object_number(goal) for goal in problem.goals]
    return data.with_kitchen_of(problem).subject(False, goals)


def certify_tree(
    tree: Tree, objectives: tuple[Objective, ...], settings: Settings, file: File
) -> tuple[Certificate | None, Ending, str]:
    """Prove that an executable tree or plan is the best, without a search, and write the certificate.

    Returns the certificate, how the proof ended, and what it proves.
    """
    objectives, certificate = levels(objectives), None
    try:
        certificate = _of_tree(tree, objectives, settings)
    except NotBestError as better:
        by = ", then ".join(objectives)
        return None, Ending.NEGATIVE, f"not the best by {by}: there is one with {costs_text(better.costs)}"
    _write(certificate, file)
    if certificate is None:
        return None, Ending.LIMIT, "no certificate was found, and nothing is written"
    content, sure = certificate.content, certificate.certified
    if certificate.claim == "bound":
        text = f"the certificate {file} proves a bound only: {bound_text(content)}"
        return certificate, Ending.LIMIT, text
    ending = Ending.DONE if sure == objectives else Ending.LIMIT
    return certificate, ending, f"proved best by {', then '.join(sure)} ({file}, {looked_at(content)})"


def _of_tree(tree: Tree, objectives: tuple[Objective, ...], settings: Settings) -> Certificate | None:
    """Return a certificate that a tree is the best, or ``None``."""
    problem, deadline, covered, units = tree.problem, settings.begun, coverage(settings), tree.ids
    with contextlib.suppress(KeyboardInterrupt), deadline.watched("looking for a certificate"):
        if problem.items is not None:
            covered = covered_for_plans(covered)
            return certify_plan(problem, objectives, units, covered, lambda: deadline.passed)
        units = tuple(dict.fromkeys(units))
        return certify(problem, objectives, units, covered, lambda: deadline.passed)
    return None


def _write(certificate: Certificate | None, file: File) -> None:
    if certificate is not None:
        write_whole(Path(file), certificate.text().encode())
