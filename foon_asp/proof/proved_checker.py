"""Calls the checker of certificates that is proved in Coq: a separate program, built from ``verified/``.

It shares no code with ``verify``. From the same data, it computes landmarks, costs and the meanings of
constraints by definitions of its own. docs/proofs.md states the theorem that is proved about these
definitions.
"""

import json
import shutil
import subprocess
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from foon_asp.proof.certificate_rules import read_rules
from foon_asp.proof.certificate_subject import Subject
from foon_asp.proof.refusal import RefusedError

ACCEPTED = "accepted"
NOT_BUILT = "not built; `make verified` builds it where Coq is installed"

_PROGRAM = "foon-verified"
_BUILT = Path(__file__).resolve().parents[2] / "verified" / "build" / _PROGRAM


def find_checker() -> Path | None:
    """Return the path of the proved checker: the build of this checkout, or else the one on PATH.

    Return ``None`` if neither exists.
    """
    if _BUILT.is_file():
        return _BUILT
    installed = shutil.which(_PROGRAM)
    return None if installed is None else Path(installed)


def run_checker(checker: Path, subject_data: str, certificate: str) -> tuple[str, str]:
    """Run the proved checker; return its verdict and the reason.

    The verdict is ``accepted``, ``refused`` or ``not checked``. If the program fails, it is ``not checked``,
    and the reason names the exit code.

    Parameters:
        checker: The path of the program.
        subject_data: The data as :meth:`Subject.canonical_data` returns them.
        certificate: The certificate as JSON text.
    """
    process = subprocess.run(
        [checker],
        input=f"{subject_data}\n{certificate}".encode(errors="replace"),
        capture_output=True,
        check=False,
    )
    verdict, _, reason = process.stdout.decode(errors="replace").strip().partition(": ")
    expected = {0: ACCEPTED, 1: "refused", 3: "not checked"}
    if expected.get(process.returncode) == verdict:
        return verdict, reason
    return "not checked", f"it ended with the exit code {process.returncode}"


def check_certificate(certificate: Mapping[str, Any], subject: Subject) -> str:
    """Check a certificate with the proved checker, after :func:`verify` accepted it.

    Returns:
        ``accepted``, or in words why nothing was checked, for example that the checker is not built.

    Raises:
        RefusedError: if the proved checker refuses the certificate.
    """
    checker = find_checker()
    if checker is None:
        return NOT_BUILT
    rules = read_rules(certificate["rules"], len(subject.network))
    subject_data = subject.canonical_data(rules, [goal["id"] for goal in certificate["goals"]])
    # no longer than the file that was read
    text = json.dumps(certificate, separators=(",", ":"), ensure_ascii=False)
    verdict, reason = run_checker(checker, subject_data, text)
    if verdict == "refused":
        raise RefusedError(f"by the proved checker: {reason}")
    return verdict if verdict == ACCEPTED else f"{verdict}: {reason}"
