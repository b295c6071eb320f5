"""Pairs of names that are one name with a typing error, found by deletion neighbourhoods."""

import re
from collections.abc import Collection, Container, Iterable, Iterator, Mapping
from typing import NamedTuple

from foon_asp.network.spelling import one_letter_apart, without_doubles, without_separators

_PLURAL_ENDING = re.compile(r"e?s$")
_VERB_ENDING = re.compile(r"(?:e?[sdr]|[ey])$")  # juice, juiced; flakes, flaked; mix, mixer; salt, salty


class _Slips(NamedTuple):
    """The limits of frequency and length for a name to count as a slip for another name.

    ``rare``, ``very_rare``: the greatest number of mentions of a slip.
    ``ratio``, ``high_ratio``, ``highest_ratio``: the least ratio of mentions of the other name to those of
    the slip.
    ``short``, ``medium``, ``long``: the least number of letters of the shorter word. Shorter words are mostly
    different words (off and of, bell and bel). With lower limits, more slips are found, and more words are
    wrongly reported.
    ``compared``: how many of the names that share all letters but one are compared, the most frequent first.
    ``name_letters``: the greatest number of letters of a name; longer texts are no names, and slow to
    compare.
    """

    rare: int = 5
    very_rare: int = 2
    ratio: int = 3
    high_ratio: int = 20
    highest_ratio: int = 100
    short: int = 3
    medium: int = 4
    long: int = 5
    compared: int = 3
    name_letters: int = 60


_SLIPS = _Slips()


def near_names(
    counts: dict[str, int],
    verbs: bool = False,
    known_words: Collection[str] = (),
    loose: Container[str] = (),
) -> Iterator[tuple[str, str]]:
    """Yield pairs of names of one kind: the rarer one, and the one that may be meant.

    Names that only differ in doubled letters, capitals, blanks or hyphens are a pair at any frequency
    (``drinking glas``, ``hashbrown``). A rare name and a much more frequent name are a pair if one letter
    after the first of a word is missing, added, changed or swapped (``baking try``). Grammatical endings
    (egg, eggs) and different digits are no slips. A rare name is in one pair at most.

    Rare names are looked up among the frequent names by deletion neighbourhood: the texts that lack one of
    their letters. So not all pairs are compared.

    Parameters:
        counts: The number of mentions of each name.
        verbs: Whether the names are verbs; cube and cubed are then no slips either.
        known_words: Words that are spelt correctly. Two known words are different words. An unknown word
            similar to a known word is a slip at any frequency.
        loose: Names that are never made or never used. A loose name similar to a name that is not loose is a
            slip at any frequency.
    """
    paired: set[str] = set()
    for rare, meant in _spelt_two_ways(counts, known_words):
        paired.update((rare, meant))
        yield rare, meant
    rare_names = [
        name
        for name, count in counts.items()
        if name not in paired and (count <= _SLIPS.rare or name in loose or _unknown(name, known_words))
    ]
    if not rare_names:
        return
    frequent: dict[str, list[str]] = {}
    for name in sorted(counts, key=lambda name: (-counts[name], name)):
        if counts[name] < _SLIPS.ratio and name in loose and _unknown(name, known_words):
            continue
        for shortened in _without_a_letter(name):
            sharing = frequent.setdefault(shortened, [])
            if len(sharing) < _SLIPS.compared:
                sharing.append(name)
    for name in rare_names:
        candidates = {
            c for shortened in _without_a_letter(name) for c in frequent.get(shortened, ())
        }.difference({name})
        ordered = sorted(candidates, key=lambda other: (-counts[other], other))
        meant_name = next(
            (other for other in ordered if _is_slip(name, other, counts, verbs, known_words, loose)), None
        )
        if meant_name is not None:
            yield name, meant_name


def _spelt_two_ways(counts: dict[str, int], known_words: Collection[str]) -> Iterator[tuple[str, str]]:
    """Yield pairs that are equal but for doubled letters, capitals and blanks, the rarer name first."""
    spellings: dict[str, list[str]] = {}
    for name in counts:
        if len(name) <= _SLIPS.name_letters:
            spellings.setdefault(without_doubles(name), []).append(name)
    for skeleton, names in spellings.items():
        if len(names) < 2:
            continue
        usual = max(names, key=lambda name: (not _unknown(name, known_words), counts[name]))
        for name in names:
            if name != usual and (
                len(skeleton) >= _SLIPS.long or without_separators(name) == without_separators(usual)
            ):
                yield name, usual


def _without_a_letter(name: str) -> Iterable[str]:
    """Return the deletion neighbourhood of a name: itself, and the texts without one of its letters."""
    if len(name) > _SLIPS.name_letters:
        return ()
    return {name, *(name[:position] + name[position + 1 :] for position in range(len(name)))}


def near_word(word: str, deletions: Mapping[str, Iterable[str]], verbs: bool) -> str | None:
    """Return the known word for which an unknown one is likely a slip, else ``None``.

    ``deletions`` is the :func:`deletion_index` of the known words.
    """
    if not _SLIPS.medium <= len(word) <= _SLIPS.name_letters:
        return None
    if word + "ed" in deletions:
        return word + "ed"
    candidates = {other for shortened in _without_a_letter(word) for other in deletions.get(shortened, ())}
    # a changed letter is least likely: most such words are different words
    ordered = sorted(
        candidates, key=lambda other: (len(other) == len(word) and sorted(other) != sorted(word), other)
    )
    return next((other for other in ordered if _differ_by_a_slip(word, other, verbs)), None)


def deletion_index(words: Iterable[str]) -> dict[str, list[str]]:
    """Return an index of words by themselves and by the texts that lack one of their letters."""
    deletions: dict[str, list[str]] = {}
    for word in words:
        if len(word) >= _SLIPS.medium:
            for shortened in _without_a_letter(word):
                deletions.setdefault(shortened, []).append(word)
    return deletions


def _unknown(name: str, known_words: Collection[str]) -> bool:
    """Whether a name has a word that is not known; false where no words are known."""
    return bool(known_words) and any(word.isalpha() and word not in known_words for word in name.split(" "))


def _differ_by_a_slip(word: str, other: str, verbs: bool) -> bool:
    """Whether words differ by a letter behind the first, and not by a grammatical ending."""
    ending = _VERB_ENDING if verbs else _PLURAL_ENDING
    is_grammar = ending.sub("", word) == ending.sub("", other)
    is_cut = word[-1:] == "d" and other == f"{word[:-1]}ed"  # gratd
    return (is_cut or not is_grammar) and word[:1] == other[:1] and one_letter_apart(word, other)


def _is_slip(
    rare: str,
    frequent: str,
    counts: dict[str, int],
    verbs: bool,
    known_words: Collection[str],
    loose: Container[str],
) -> bool:
    """Whether a rare name is likely a slip for a frequent one with almost the same letters."""
    words, others = rare.split(" "), frequent.split(" ")
    differing = [(a, b) for a, b in zip(words, others, strict=False) if a != b]
    if len(words) != len(others) or len(differing) != 1:
        return False
    word, other = differing[0]
    if not _differ_by_a_slip(word, other, verbs):
        return False
    shortest = min(len(word), len(other))
    if known_words and (
        word in known_words or other in known_words or (rare in loose and frequent not in loose)
    ):
        return word not in known_words and shortest >= _SLIPS.short
    return counts[rare] <= _SLIPS.rare and _is_rare_beside(word, other, counts[rare], counts[frequent])


def _is_rare_beside(word: str, other: str, rare: int, frequent: int) -> bool:
    """Whether a word is so much rarer than a similar word that it is probably a slip."""
    # Short words, and words with another letter, are mostly words of their own: dip, drip; batter, butter.
    shortest, ratio = min(len(word), len(other)), frequent / rare
    if frequent < _SLIPS.ratio:
        return False
    if sorted(word) == sorted(other):  # letters have changed places
        return shortest >= _SLIPS.medium and ratio >= _SLIPS.ratio
    if len(word) == len(other):
        return shortest >= _SLIPS.long and ratio >= _SLIPS.high_ratio and rare <= _SLIPS.very_rare
    if ratio >= _SLIPS.highest_ratio:
        return shortest >= _SLIPS.short
    return shortest >= _SLIPS.long and ratio >= _SLIPS.ratio
