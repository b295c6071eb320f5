"""Answers with proofs that are checked without a solver."""

import contextlib
import json
from collections.abc import Mapping
from os import PathLike
from pathlib import Path
from typing import Any, NamedTuple

from foon_asp.asp.solver import solve as find
from foon_asp.certificate import Certificate, certify_outcome
from foon_asp.dataset.paths import File, Files
from foon_asp.errors import UserError
from foon_asp.foon import Foon
from foon_asp.network import Network
from foon_asp.problem import Problem
from foon_asp.proof import verify as proof
from foon_asp.questions.answer import Answer
from foon_asp.questions.arguments import Constants, Objectives, chosen_objectives, settings
from foon_asp.questions.caller import caller
from foon_asp.questions.result import Result
from foon_asp.report.answer import outcome_json, outcome_text
from foon_asp.report.certified import certificate_lines, verified_json, verified_text
from foon_asp.report.drawing import Drawing


class _Certified(NamedTuple):
    answer: Answer
    certificate: Certificate | None


class Certified(Result, _Certified):
    """An ``answer`` and the ``certificate`` that proves it, ``None`` where none was found.

    ``certificate.text()`` is what to write into a file; ``certificate.claim`` says what it proves:
    ``optimal``, ``infeasible``, or only a ``bound``.
    """

    __slots__ = ()

    def text(self) -> str:
        """Give the answer, and what is proved of it."""
        return outcome_text(self.answer, certificate_lines(self.answer, self.certificate, "in memory"))

    def json_text(self) -> str:
        """Give the answer as ``foon-asp solve --certificate FILE --format json`` does."""
        return outcome_json(self.answer)

    def drawing(self) -> Drawing | None:
        """Give what the picture shows."""
        return self.answer.drawing()


class _VerifiedIn(NamedTuple):
    verified: proof.Verified
    network: Network
    content: Mapping[str, Any]


class VerifiedCertificate(Result, _VerifiedIn):
    """What a certificate proves; ``verified`` has its ``claim``, ``goals``, ``tree`` and ``costs``."""

    __slots__ = ()

    def text(self) -> str:
        """Say what is proved, as ``foon-asp verify`` does."""
        return verified_text(self.verified, self.network, dict(self.content))

    def json_text(self) -> str:
        """Say what is proved, as ``foon-asp verify --format json`` does."""
        return json.dumps(verified_json(self.verified, self.network), indent=2, ensure_ascii=False) + "\n"


def certify(
    problem: Problem,
    objectives: Objectives = "units",
    *,
    constraints: Files = (),
    constants: Constants | None = None,
    encodings: File | None = None,
    time_limit: float | None = None,
    memory_limit: int | str | None = None,
) -> Certified:
    """Solve a problem, and find a certificate of the answer: a proof that :func:`verify` checks.

    A certificate speaks about the whole network, which of a store is read for it. Otherwise as
    :func:`foon_asp.solve`.
    """
    chosen = chosen_objectives(problem, objectives)
    how = settings(constraints, constants, encodings, time_limit, memory_limit).limited()
    outcome = find(problem.whole, chosen, how, caller().reporter)
    certificate = None
    with contextlib.suppress(KeyboardInterrupt), how.begun.watched("looking for a certificate"):
        outcome, certificate = certify_outcome(outcome, how, lambda: how.begun.passed)
    return Certified(Answer._make(outcome), certificate)


def verify(data: Foon | Problem, certificate: Certificate | str | PathLike[str]) -> VerifiedCertificate:
    """Check a certificate against the data it speaks about, without any solver, and say what it proves.

    ``certificate`` is one that was found, or the path of a file. Raises :class:`RefusedError` for one that is
    wrong, with the first fault that is found.
    """
    if isinstance(certificate, Certificate):
        content = proof.read_certificate(certificate.text())
    else:
        try:
            content = proof.load_certificate(Path(certificate))
        except (OSError, UnicodeDecodeError) as error:
            raise UserError(f"{certificate}: cannot be read: {error}") from None
    read = (data if isinstance(data, Foon) else Foon.of(data)).dataset.data
    verified = proof.verify(content, read.network, read.kitchen, read.rates, read.utensils)
    return VerifiedCertificate(verified, read.network, content)
