"""Names that PDDL takes: what a thing is, its number, and a readable rest."""

import re
import unicodedata

_LONGEST = 60  # letters of the readable rest
_OTHER = re.compile("[^a-z0-9]+")


def pddl_name(kind: str, number: int, words: str) -> str:
    """Give a name such as ``u580-pour``, which no other thing of the kind has, whatever the words are.

    PDDL does not tell capital letters from small ones, and takes letters of ASCII, digits and dashes alone.
    """
    plain = unicodedata.normalize("NFKD", words).encode("ascii", "ignore").decode().lower()
    rest = _OTHER.sub("-", plain).strip("-")[:_LONGEST].rstrip("-")
    return f"{kind}{number}-{rest}" if rest else f"{kind}{number}"
