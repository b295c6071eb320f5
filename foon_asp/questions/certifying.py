"""Certificates that a tree is the best, for trees that are found here or given."""

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
from foon_asp.proof.certificate_subject import Subject
from foon_asp.questions.answer import Answer, answer_from_store, answer_problem
from foon_asp.questions.certificate_text import bound_text, certificate_lines, proof_size
from foon_asp.questions.ending import Ending
from foon_asp.questions.python_arguments import limited_reading, over_whole_network, problem_for_rules
from foon_asp.questions.tree import Tree
from foon_asp.results.figure_text import costs_text
from foon_asp.whole_file import write_whole


def solve_with_certificate(
    problem: Problem, objectives: Sequence[Objective], settings: Settings, file: File | None = None
) -> Answer:
    """Solve a problem, and search for a certificate of its answer; return the answer with the certificate.

    A limit or ctrl-C ends the search without a certificate. With a ``file``, a certificate that was found is
    written into it, and notes of the answer say what is proved. The whole network is read, with two
    exceptions: if a part of a large store suffices, and if no rules need it for a problem with stand-ins.
    """
    deadline = settings.effective_deadline
    settings = settings._replace(deadline=deadline)
    has_rules = settings.constraints or settings.constants or settings.encodings
    is_plain = not has_rules and problem.items is None and Objective.PRICE not in objectives
    nearby = near_goals(problem, objectives, settings) if is_plain else None
    with limited_reading():
        subject = (
            nearby.subject() if nearby is not None else _certificate_subject(problem) if is_plain else None
        )
    if nearby is None:
        suffices = (
            problem.stand_ins is not None and problem_for_rules(problem, settings, objectives) is problem
        )
        full_problem = problem if suffices or subject is not None else over_whole_network(problem)
        answer = answer_problem(full_problem, objectives, settings)
        certified_problem = answer.problem
    else:
        answer = answer_from_store(nearby, objectives, settings)
        certified_problem = nearby.relaxation
    certificate = None
    with contextlib.suppress(KeyboardInterrupt), deadline.watched("looking for a certificate"):
        outcome, certificate = certify_outcome(
            answer.outcome._replace(problem=certified_problem), settings, lambda: deadline.passed, subject
        )
        answer = Answer.of(outcome._replace(problem=answer.problem))
    if file is None:
        return answer.having(certificate=certificate)
    _write_if_found(certificate, file)
    return answer.having(certificate_lines(answer.outcome, certificate, str(file)), certificate)


def _certificate_subject(problem: Problem) -> Subject | None:
    """Return the data that a certificate is about, for a problem over a part of a store.

    Return ``None`` if the problem is over the whole network, has no dataset, or has units with their own
    rates.
    """
    dataset = problem.origin
    if not problem.network.object_numbers or not isinstance(dataset, Dataset) or problem.own_rates:
        return None
    network = problem.network
    goals = [network.object_number(goal) for goal in problem.goals]
    return dataset.with_kitchen_of(problem).subject(False, goals)


def certify_tree(
    tree: Tree, objectives: tuple[Objective, ...], settings: Settings, file: File
) -> tuple[Certificate | None, Ending, str]:
    """Prove that an executable tree or plan is the best, without a search, and write the certificate.

    Return the certificate or ``None``, how the proof ended, and in words what is proved. If the tree is
    proved best by every objective, the ending is ``DONE``. If a better tree is found, it is ``NEGATIVE``.
    Otherwise, it is ``LIMIT``. Without a certificate, no file is written.
    """
    objectives, certificate = levels(objectives), None
    try:
        certificate = _prove_best(tree, objectives, settings)
    except NotBestError as better:
        by = ", then ".join(objectives)
        return None, Ending.NEGATIVE, f"not the best by {by}: there is one with {costs_text(better.costs)}"
    _write_if_found(certificate, file)
    if certificate is None:
        return None, Ending.LIMIT, "no certificate was found, and nothing is written"
    content, proved_objectives = certificate.content, certificate.certified
    if certificate.claim == "bound":
        text = f"the certificate {file} proves a bound only: {bound_text(content)}"
        return certificate, Ending.LIMIT, text
    ending = Ending.DONE if proved_objectives == objectives else Ending.LIMIT
    by = ", then ".join(proved_objectives)
    return certificate, ending, f"proved best by {by} ({file}, {proof_size(content)})"


def _prove_best(tree: Tree, objectives: tuple[Objective, ...], settings: Settings) -> Certificate | None:
    """Return a certificate that a tree is the best, or a certificate of a bound on all trees.

    Return ``None`` if no certificate is found, also when a limit or ctrl-C stops the search. A tree counts a
    repeated unit once; a plan counts it as often as it is listed. Raises :class:`NotBestError` if a better
    tree is found.
    """
    problem, deadline, covered, units = (
        tree.problem,
        settings.effective_deadline,
        coverage(settings),
        tree.ids,
    )
    with contextlib.suppress(KeyboardInterrupt), deadline.watched("looking for a certificate"):
        if problem.items is not None:
            covered = covered_for_plans(covered)
            return certify_plan(problem, objectives, units, covered, lambda: deadline.passed)
        units = tuple(dict.fromkeys(units))
        return certify(problem, objectives, units, covered, lambda: deadline.passed)
    return None


def _write_if_found(certificate: Certificate | None, file: File) -> None:
    """Write a certificate as JSON into a file; for ``None``, write nothing."""
    if certificate is not None:
        write_whole(Path(file), certificate.text().encode())
