"""Two spellings of one name."""

import re
from collections import defaultdict
from collections.abc import Iterable

_DOUBLED = r"([^\W\d_])\1+"
_BETWEEN = r"[\s\-_'’.]+"


def joined(name: str) -> str:
    """Return a name without capitals, blanks, hyphens and the like."""
    return re.sub(_BETWEEN, "", name.casefold()) or name


def without_doubles(name: str) -> str:
    """Return a name :func:`joined`, with letters that stand doubled once."""
    return re.sub(_DOUBLED, r"\1", joined(name))


def one_letter_apart(word: str, other: str) -> bool:
    """Whether adding, leaving out or changing one letter, or swapping two, leads from one to the other."""
    start = 0
    while start < min(len(word), len(other)) and word[start] == other[start]:
        start += 1
    a, b = word[start:], other[start:]
    while a and b and a[-1] == b[-1]:
        a, b = a[:-1], b[:-1]
    swapped = len(a) == 2 and a == b[::-1]
    return (swapped or max(len(a), len(b)) == 1) and (a + b).isalpha()


def near_labels(label: str, known: Iterable[str], most: int) -> list[str]:
    """Return those of the known labels that are like one, whatever their capitals, the likest first."""
    import difflib  # noqa: PLC0415 (for faults alone)

    lower: defaultdict[str, list[str]] = defaultdict(list)
    for name in known:
        lower[name.lower()].append(name)
    close = difflib.get_close_matches(label.lower(), lower, n=most, cutoff=0.6)
    return [name for small in close for name in lower[small]]
