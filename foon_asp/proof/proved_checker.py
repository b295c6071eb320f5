"""The checker of certificates that is proved in Coq: a program of its own, built from ``verified/``.

It shares no line with ``verify``: both are given the same data, and the proved checker computes members of
cuts, costs and the meanings of constraints by definitions about which a theorem is proved (docs/proofs.md).
"""

import shutil
import subprocess
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from foon_asp.proof.verify import RefusedError, Subject, canonical, read_rules

ACCEPTED = "accepted"
NOT_BUILT = "not built; `make verified` builds it where Coq is installed"

_NAME = "foon-verified"
_BUILT = Path(__file__).resolve().parents[2] / "verified" / "build" / _NAME


def program() -> Path | None:
    """Return the proved checker: as it is built in a checkout, or on PATH; ``None`` where it is not built."""
    if _BUILT.is_file():
        return _BUILT
    found = shutil.which(_NAME)
    return None if found is None else Path(found)


def ask(certificate: Mapping[str, Any], subject: Subject) -> str:
    """Run the proved checker on a certificate whose form and digests :func:`verify` has checked.

    Returns:
        ``accepted``, or else why it is not checked, in words.

    Raises:
        RefusedError: for a certificate that it refuses.
    """
    checker = program()
    if checker is None:
        return NOT_BUILT
    data = subject.described(read_rules(certificate["rules"], len(subject.network)))
    ended = subprocess.run(
        [checker],
        input=f"{data}\n{canonical(certificate)}",
        capture_output=True,
        encoding="utf-8",
        check=False,
    )
    answer, _, reason = ended.stdout.strip().partition(": ")
    if ended.returncode == 1:
        raise RefusedError(f"by the proved checker: {reason}")
    if ended.returncode == 0 and answer == ACCEPTED:
        return ACCEPTED
    return f"not checked: {reason or f'it ended with the exit code {ended.returncode}'}"
