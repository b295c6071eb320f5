"""Identifiers of PDDL: a letter for the kind, a number, and readable words of up to 60 letters."""

import re
import unicodedata

_SEPARATOR = re.compile("[^a-z0-9]+")


def pddl_name(kind: str, number: int, words: str) -> str:
    """Return an identifier such as ``u580-pour``; kind and number make it unique, whatever the words are.

    PDDL ignores the case of letters, and allows only ASCII letters, digits and dashes.
    """
    plain = unicodedata.normalize("NFKD", words).encode("ascii", "ignore").decode().lower()
    suffix = _SEPARATOR.sub("-", plain).strip("-")[:60].rstrip("-")
    return f"{kind}{number}-{suffix}" if suffix else f"{kind}{number}"
