"""Comparison of spellings: names that differ only in blanks, doubled letters or one letter."""

import re
from collections import defaultdict
from collections.abc import Iterable

_DOUBLED = r"([^\W\d_])\1+"
_SEPARATORS = r"[\s\-_'’.]+"


def without_separators(name: str) -> str:
    """Return a name in lower case, without blanks, hyphens, underscores, apostrophes and full stops.

    A name that has nothing else is returned unchanged.
    """
    return re.sub(_SEPARATORS, "", name.casefold()) or name


def without_doubles(name: str) -> str:
    """Return a name as :func:`without_separators` does, with doubled letters written once: ``egs``."""
    return re.sub(_DOUBLED, r"\1", without_separators(name))


def one_letter_apart(word: str, other: str) -> bool:
    """Whether two words differ by one letter added, left out or changed, or by two neighbours swapped.

    Equal words are not one letter apart, and neither are ``egg 1`` and ``egg 2``, since digits are no
    letters.
    """
    start = 0
    while start < min(len(word), len(other)) and word[start] == other[start]:
        start += 1
    differing, other_differing = word[start:], other[start:]
    while differing and other_differing and differing[-1] == other_differing[-1]:
        differing, other_differing = differing[:-1], other_differing[:-1]
    swapped = len(differing) == 2 and differing == other_differing[::-1]
    return (swapped or max(len(differing), len(other_differing)) == 1) and (
        differing + other_differing
    ).isalpha()


def near_labels(label: str, labels: Iterable[str], max_labels: int) -> list[str]:
    """Return the labels most similar to ``label``, the most similar first.

    Similarity is measured by :mod:`difflib`, in lower case, and is at least 0.6. At most ``max_labels``
    labels are returned, where labels that differ only in case count as one.
    """
    import difflib  # noqa: PLC0415 (for faults alone)

    by_lower_case: defaultdict[str, list[str]] = defaultdict(list)
    for name in labels:
        by_lower_case[name.lower()].append(name)
    close_labels = difflib.get_close_matches(label.lower(), by_lower_case, n=max_labels, cutoff=0.6)
    return [name for lower_label in close_labels for name in by_lower_case[lower_label]]
