"""The file of a certificate and its JSON text: both are read here, and floats and double keys are refused."""

import json
from pathlib import Path
from typing import Any

from foon_asp.proof.certificate_limits import ALLOWED
from foon_asp.proof.refusal import CheckLimitError, RefusedError, require


def load_certificate(file: Path) -> Any:
    """Return the parsed JSON of a certificate file.

    Raises ``OSError`` if the file cannot be read, and ``UnicodeDecodeError`` if it is not UTF-8. Raises
    :class:`RefusedError` if it is longer than :class:`CertificateLimits` allows, or if its text is refused
    by :func:`read_certificate`.
    """
    with file.open("rb") as stream:
        raw = stream.read(ALLOWED.letters)
        if stream.peek():
            raise CheckLimitError(f"it has more than {ALLOWED.letters:,} letters")
    return read_certificate(raw.decode("utf-8"))


def read_certificate(text: str) -> Any:
    """Return the parsed JSON of a certificate.

    Raises :class:`RefusedError` if the text is no JSON or is nested too deeply. A key that occurs twice in
    one object and a number that is not whole are refused as well. Raises :class:`CheckLimitError` if it has
    more letters or brackets than :class:`CertificateLimits` allows.
    """

    def unique_keys(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        """Return a JSON object as a dictionary; refuse a key that occurs twice."""
        fields = dict(pairs)
        require(len(fields) == len(pairs), "a key stands twice in one object")
        return fields

    def refuse_float(number: str) -> None:
        """Raise :class:`RefusedError` for a number that is not whole, and for ``NaN`` and ``Infinity``."""
        raise RefusedError(f"found the number {number[:50]}, expected whole numbers, and fractions in quotes")

    if len(text) > ALLOWED.letters or text.count("[") + text.count("{") > ALLOWED.brackets:
        raise CheckLimitError(
            f"it has more than {ALLOWED.letters:,} letters or {ALLOWED.brackets:,} brackets"
        )
    try:
        return json.loads(
            text, object_pairs_hook=unique_keys, parse_float=refuse_float, parse_constant=refuse_float
        )
    except (ValueError, RecursionError) as error:
        raise RefusedError(f"not JSON: {error}") from None
