"""The checker of certificates that is proved in Coq: a program of its own, built from ``verified/``.

It shares no line with ``verify``: both are given the same data, and the proved checker computes members of
cuts, costs and the meanings of constraints by definitions about which a theorem is proved (docs/proofs.md).
"""

import shutil
import subprocess
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from foon_asp.proof.verifier import RefusedError, Subject, canonical, read_rules

ACCEPTED = "accepted"
NOT_BUILT = "not built; `make verified` builds it where Coq is installed"

_PROGRAM = "foon-verified"
_BUILT = Path(__file__).resolve().parents[2] / "verified" / "build" / _PROGRAM


def program() -> Path | None:
    """Return the proved checker: as it is built in a checkout, or on PATH; ``None`` where it is not built."""
    if _BUILT.is_file():
        return _BUILT
    installed = shutil.which(_PROGRAM)
    return None if installed is None else Path(installed)


def judge(checker: Path, data: str, certificate: str) -> tuple[str, str]:
    """Return the verdict of the proved checker: ``accepted``, ``refused`` or ``not checked``, and the reason.

    Parameters:
        checker: The program.
        data: The data as :meth:`Subject.described` writes them.
        certificate: The text of the certificate.
    """
    ended = subprocess.run(
        [checker], input=f"{data}\n{certificate}".encode(errors="replace"), capture_output=True, check=False
    )
    verdict, _, reason = ended.stdout.decode(errors="replace").strip().partition(": ")
    expected = {0: ACCEPTED, 1: "refused", 3: "not checked"}
    if expected.get(ended.returncode) == verdict:
        return verdict, reason
    return "not checked", f"it ended with the exit code {ended.returncode}"


def ask(certificate: Mapping[str, Any], subject: Subject) -> str:
    """Check a certificate that :func:`verify` accepts with the proved checker.

    Returns:
        ``accepted``, or else why it is not checked, in words.

    Raises:
        RefusedError: for a certificate that it refuses.
    """
    checker = program()
    if checker is None:
        return NOT_BUILT
    data = subject.described(read_rules(certificate["rules"], len(subject.network)))
    verdict, reason = judge(checker, data, canonical(certificate))
    if verdict == "refused":
        raise RefusedError(f"by the proved checker: {reason}")
    return verdict if verdict == ACCEPTED else f"{verdict}: {reason}"
