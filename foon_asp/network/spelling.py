"""Two spellings of one name."""

import re

_DOUBLED = re.compile(r"([^\W\d_])\1+")
_BETWEEN = re.compile(r"[\s\-_'’.]+")


def joined(name: str) -> str:
    """Give a name without capitals, blanks, hyphens and the like."""
    return _BETWEEN.sub("", name.casefold()) or name


def without_doubles(name: str) -> str:
    """Give a name :func:`joined`, with letters that stand doubled once."""
    return _DOUBLED.sub(r"\1", joined(name))


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
