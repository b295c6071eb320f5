"""Identifiers of PDDL: a letter for the kind, a number, and up to 60 letters of readable words."""

import re
import unicodedata

_SEPARATOR = re.compile("[^a-z0-9]+")


def pddl_name(kind: str, number: int, words: str) -> str:
    """Return an identifier such as ``u580-pour``; kind and number alone make it unique.

    ``words`` are reduced to lower-case ASCII letters, digits and dashes, since PDDL ignores case and allows
    nothing else. They are cut off after 60 characters. If nothing of them is left, the identifier is
    ``u580``.
    """
    plain = unicodedata.normalize("NFKD", words).encode("ascii", "ignore").decode().lower()
    suffix = _SEPARATOR.sub("-", plain).strip("-")[:60].rstrip("-")
    return f"{kind}{number}-{suffix}" if suffix else f"{kind}{number}"
