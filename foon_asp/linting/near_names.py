"""Pairs of similar names, one of which is probably a typing error of the other."""

import re
from collections.abc import Collection, Container, Iterable, Iterator, Mapping
from typing import NamedTuple

from foon_asp.network.spelling import one_letter_apart, without_doubles, without_separators

_PLURAL_ENDING = re.compile(r"e?s$")
_VERB_ENDING = re.compile(r"(?:e?[sdr]|[ey])$")  # juice, juiced; flakes, flaked; mix, mixer; salt, salty


class _SlipLimits(NamedTuple):
    """The limits of frequency and length for a name to count as a slip: a typing error of another name.

    ``rare``, ``very_rare``: the greatest numbers of mentions of a slip.
    ``ratio``, ``high_ratio``, ``highest_ratio``: how many times as often the other name must be mentioned, at
    least.
    ``short``, ``medium``, ``long``: the least numbers of letters of the shorter word. Shorter words are
    mostly different words (off and of, bell and bel). Lower limits find more slips and report
    more right words.
    ``compared``: how many of the names that share all letters but one are compared, the most frequent first.
    ``name_letters``: the greatest number of letters of a name; longer texts are no names, and slow to
    compare.

    The kind of slip decides which number applies (see :func:`_is_rare_enough`).
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


_LIMITS = _SlipLimits()


def near_names(
    counts: dict[str, int],
    verbs: bool = False,
    known_words: Collection[str] = (),
    one_sided: Container[str] = (),
) -> Iterator[tuple[str, str]]:
    """Yield pairs of names of one kind: the rarer one, and the one that is probably meant.

    Names that only differ in doubled letters, capitals, blanks or hyphens are a pair at any frequency
    (``drinking glas``, ``hashbrown``). A rare name and a much more frequent name are a pair if one letter of
    a word is missing, added, changed or swapped (``baking try``). A rare name has at most five mentions. The
    first letter of the word must be equal. Grammatical endings (egg, eggs) and different digits are no slips.
    A rare name is in one pair at most. Names of more than 60 letters are in no pair.

    Parameters:
        counts: The number of mentions of each name.
        verbs: Whether the names are verbs; cube and cubed are then no slips either.
        known_words: Words that are spelt correctly. Two known words are different words. An unknown word
            similar to a known word is a slip at any frequency.
        one_sided: Names that are never made or never used. Such a name is a slip at any frequency if a
            similar name is both made and used.
    """
    paired: set[str] = set()
    for rare, meant in _spelling_variants(counts, known_words):
        paired.update((rare, meant))
        yield rare, meant
    rare_names = [
        name
        for name, count in counts.items()
        if name not in paired
        and (count <= _LIMITS.rare or name in one_sided or _has_unknown_word(name, known_words))
    ]
    if not rare_names:
        return
    frequent: dict[str, list[str]] = {}
    for name in sorted(counts, key=lambda name: (-counts[name], name)):
        if counts[name] < _LIMITS.ratio and name in one_sided and _has_unknown_word(name, known_words):
            continue
        for shortened in _deletion_neighbourhood(name):
            sharing = frequent.setdefault(shortened, [])
            if len(sharing) < _LIMITS.compared:
                sharing.append(name)
    for name in rare_names:
        candidates = {
            candidate
            for shortened in _deletion_neighbourhood(name)
            for candidate in frequent.get(shortened, ())
        }.difference({name})
        ordered = sorted(candidates, key=lambda other: (-counts[other], other))
        meant_name = next(
            (other for other in ordered if _is_slip(name, other, counts, verbs, known_words, one_sided)), None
        )
        if meant_name is not None:
            yield name, meant_name


def _spelling_variants(counts: dict[str, int], known_words: Collection[str]) -> Iterator[tuple[str, str]]:
    """Yield pairs of names that differ only in doubled letters, capitals, blanks and hyphens.

    The second name is the usual one. This is a name that has only known words, or else the most frequent
    name. Short names must also agree in their doubled letters. A name is short if it has less than five
    letters when a doubled letter counts once. Names of more than 60 letters are left out.
    """
    spellings: dict[str, list[str]] = {}
    for name in counts:
        if len(name) <= _LIMITS.name_letters:
            spellings.setdefault(without_doubles(name), []).append(name)
    for skeleton, names in spellings.items():
        if len(names) < 2:
            continue
        usual = max(names, key=lambda name: (not _has_unknown_word(name, known_words), counts[name]))
        for name in names:
            if name != usual and (
                len(skeleton) >= _LIMITS.long or without_separators(name) == without_separators(usual)
            ):
                yield name, usual


def _deletion_neighbourhood(name: str) -> Iterable[str]:
    """Return a name and all texts that lack one of its letters; nothing for a name that is too long."""
    if len(name) > _LIMITS.name_letters:
        return ()
    return {name, *(name[:position] + name[position + 1 :] for position in range(len(name)))}


def near_word(word: str, deletions: Mapping[str, Iterable[str]], verbs: bool) -> str | None:
    """Return the known word that is probably meant by an unknown word.

    ``deletions`` is the :func:`deletion_index` of the known words. If the word with ``ed`` behind it is
    known, that word is meant. With ``verbs``, other endings of verbs are no slips. Return ``None`` if no
    known word is similar, or if the word has less than 4 or more than 60 letters.
    """
    if not _LIMITS.medium <= len(word) <= _LIMITS.name_letters:
        return None
    past_form = f"{word}ed"
    if past_form in deletions.get(past_form, ()):
        return past_form
    candidates = {
        other for shortened in _deletion_neighbourhood(word) for other in deletions.get(shortened, ())
    }
    # a changed letter is least likely: most such words are different words
    ordered = sorted(
        candidates, key=lambda other: (len(other) == len(word) and sorted(other) != sorted(word), other)
    )
    return next((other for other in ordered if _differ_by_a_slip(word, other, verbs)), None)


def deletion_index(words: Iterable[str]) -> dict[str, list[str]]:
    """Return, by text, the words that have this text in their deletion neighbourhoods.

    The neighbourhood of a word is the word and all texts that lack one of its letters. Words of less than
    four letters are left out.
    """
    deletions: dict[str, list[str]] = {}
    for word in words:
        if len(word) >= _LIMITS.medium:
            for shortened in _deletion_neighbourhood(word):
                deletions.setdefault(shortened, []).append(word)
    return deletions


def _has_unknown_word(name: str, known_words: Collection[str]) -> bool:
    """Whether a name has a word that is not known; false if ``known_words`` is empty.

    Words with other characters than letters are ignored.
    """
    return bool(known_words) and any(word.isalpha() and word not in known_words for word in name.split(" "))


def _differ_by_a_slip(word: str, other: str, verbs: bool) -> bool:
    """Whether two words differ by one letter after the first, and not only in their grammatical ending.

    The letter is missing, added, changed or swapped. A final d in place of ed is also a slip, as in
    ``gratd``.
    """
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
    one_sided: Container[str],
) -> bool:
    """Whether a rare name is probably a slip of a frequent one, from which it differs in one word.

    The parameters are those of :func:`near_names`. If the word in which ``rare`` differs is known, ``rare``
    is no slip. If only the word of ``frequent`` is known, or only ``rare`` is one-sided, ``rare`` is a slip
    however often it is mentioned. Otherwise, a slip has at most five mentions and is much rarer.
    """
    words, others = rare.split(" "), frequent.split(" ")
    differing = [(a, b) for a, b in zip(words, others, strict=False) if a != b]
    if len(words) != len(others) or len(differing) != 1:
        return False
    word, other = differing[0]
    if not _differ_by_a_slip(word, other, verbs):
        return False
    shortest = min(len(word), len(other))
    if known_words and (
        word in known_words or other in known_words or (rare in one_sided and frequent not in one_sided)
    ):
        return word not in known_words and shortest >= _LIMITS.short
    return counts[rare] <= _LIMITS.rare and _is_rare_enough(word, other, counts[rare], counts[frequent])


def _is_rare_enough(word: str, other: str, rare_mentions: int, frequent_mentions: int) -> bool:
    """Whether a word is so much rarer than a similar word that it is probably a slip.

    ``rare_mentions`` and ``frequent_mentions`` are the numbers of mentions of the names with these words.
    The other name must have at least three mentions. How many times more frequent it must be depends on the
    length of the words and on how they differ. They differ by swapped letters, a changed letter, or a
    missing one.
    """
    # Short words, and words with another letter, are mostly words of their own: dip, drip; batter, butter.
    shortest, ratio = min(len(word), len(other)), frequent_mentions / rare_mentions
    if frequent_mentions < _LIMITS.ratio:
        return False
    if sorted(word) == sorted(other):  # letters have changed places
        return shortest >= _LIMITS.medium and ratio >= _LIMITS.ratio
    if len(word) == len(other):
        return shortest >= _LIMITS.long and ratio >= _LIMITS.high_ratio and rare_mentions <= _LIMITS.very_rare
    if ratio >= _LIMITS.highest_ratio:
        return shortest >= _LIMITS.short
    return shortest >= _LIMITS.long and ratio >= _LIMITS.ratio
