"""Names that are one name with a slip of the pen."""

import re
from collections.abc import Collection, Container, Iterable, Iterator, Mapping

from foon_asp.network.spelling import joined, one_letter_apart, without_doubles

_LONGEST = 60  # letters: what is longer is no name, and comparing it takes long
_SHORTEST_DOUBLED = 5  # letters: off and of, bell and bel are words of their own
_PLURAL_ENDING = re.compile(r"e?s$")
_VERB_ENDING = re.compile(r"(?:e?[sdr]|[ey])$")  # juice, juiced; flakes, flaked; mix, mixer; salt, salty
_RARE, _VERY_RARE = 5, 2  # mentions
_RATIO, _HIGH_RATIO, _HIGHEST_RATIO = 3, 20, 100  # how much more often the other name stands
_SHORT, _MIDDLE, _LONG = 3, 4, 5  # letters of the shorter word
_SHORT_KNOWN = 4  # letters of a word that may be a slip for one that is known
_COMPARED = 3  # names with the same letters but one: only the most frequent are compared


def near_names(
    counts: dict[str, int],
    verbs: bool = False,
    known: Collection[str] = (),
    loose: Container[str] = (),
) -> Iterator[tuple[str, str]]:
    """Return pairs of names of one kind: the one that stands less often, and the one that may be meant.

    Names that only differ in doubled letters, capitals, blanks or hyphens are a pair at any frequency
    (``drinking glas``, ``hashbrown``). A name that is rare beside another one is a pair with it if one
    letter is missing, added, changed or has changed places, behind the first letter of a word
    (``baking try``). An ending that is grammar is no slip: egg, eggs, and of ``verbs`` cube, cubed. Nor is a
    digit.

    ``known`` are words that are spelt as they should be: two of them are words of their own, and one beside
    one of them that is none is a slip at any frequency. So is a name in ``loose``, those that are never made
    or never used, beside one that is not there.

    ``counts`` has the mentions of each name. A name is given once. Time and memory grow with the letters of
    the names: rare names are looked up among the frequent ones by what is left when a letter is taken away.
    """
    paired: set[str] = set()
    for rare, meant in _spelt_two_ways(counts, known):
        paired.update((rare, meant))
        yield rare, meant
    rare_names = [
        name
        for name, count in counts.items()
        if name not in paired and (count <= _RARE or name in loose or _unknown(name, known))
    ]
    if not rare_names:
        return
    frequent: dict[str, list[str]] = {}
    for name in sorted(counts, key=lambda name: (-counts[name], name)):
        if counts[name] < _RATIO and name in loose and _unknown(name, known):
            continue
        for rest in _without_a_letter(name):
            alike = frequent.setdefault(rest, [])
            if len(alike) < _COMPARED:
                alike.append(name)
    for name in rare_names:
        candidates = {c for rest in _without_a_letter(name) for c in frequent.get(rest, ())}.difference(
            {name}
        )
        ordered = sorted(candidates, key=lambda other: (-counts[other], other))
        meant_name = next(
            (other for other in ordered if _is_slip(name, other, counts, verbs, known, loose)), None
        )
        if meant_name is not None:
            yield name, meant_name


def _spelt_two_ways(counts: dict[str, int], known: Collection[str]) -> Iterator[tuple[str, str]]:
    """Return pairs that are the same without doubled letters, capitals and blanks."""
    spellings: dict[str, list[str]] = {}
    for name in counts:
        if len(name) <= _LONGEST:
            spellings.setdefault(without_doubles(name), []).append(name)
    for skeleton, names in spellings.items():
        if len(names) < 2:
            continue
        most = max(names, key=lambda name: (not _unknown(name, known), counts[name]))
        for name in names:
            if name != most and (len(skeleton) >= _SHORTEST_DOUBLED or joined(name) == joined(most)):
                yield name, most


def _without_a_letter(name: str) -> Iterable[str]:
    if len(name) > _LONGEST:
        return ()
    return {name, *(name[:place] + name[place + 1 :] for place in range(len(name)))}


def near_word(word: str, near: Mapping[str, Iterable[str]], verbs: bool) -> str | None:
    """Return the known word for which one that is not known is likely a slip.

    ``near`` has the known words by what is left of them when a letter is taken away, and by themselves.
    """
    if not _SHORT_KNOWN <= len(word) <= _LONGEST:
        return None
    if word + "ed" in near:
        return word + "ed"
    candidates = {other for rest in _without_a_letter(word) for other in near.get(rest, ())}
    # another letter is the least likely: most of such words are words of their own
    ordered = sorted(
        candidates, key=lambda other: (len(other) == len(word) and sorted(other) != sorted(word), other)
    )
    return next((other for other in ordered if _near(word, other, verbs)), None)


def by_what_is_left(words: Iterable[str]) -> dict[str, list[str]]:
    """Return words by themselves and by what is left of them when a letter is taken away."""
    near: dict[str, list[str]] = {}
    for word in words:
        if len(word) >= _SHORT_KNOWN:
            for rest in _without_a_letter(word):
                near.setdefault(rest, []).append(word)
    return near


def _unknown(name: str, known: Collection[str]) -> bool:
    """Whether a name has a word that is not known, where any is."""
    return bool(known) and any(word.isalpha() and word not in known for word in name.split(" "))


def _near(word: str, other: str, verbs: bool) -> bool:
    """Whether words differ by a letter behind the first, and not by an ending that is grammar."""
    ending = _VERB_ENDING if verbs else _PLURAL_ENDING
    is_grammar = ending.sub("", word) == ending.sub("", other)
    is_cut = word[-1:] == "d" and other == f"{word[:-1]}ed"  # gratd
    return (is_cut or not is_grammar) and word[:1] == other[:1] and one_letter_apart(word, other)


def _is_slip(
    rare: str,
    frequent: str,
    counts: dict[str, int],
    verbs: bool,
    known: Collection[str],
    loose: Container[str],
) -> bool:
    """Whether a rare name is likely a slip for a frequent one with almost the same letters."""
    words, others = rare.split(" "), frequent.split(" ")
    differing = [(a, b) for a, b in zip(words, others, strict=False) if a != b]
    if len(words) != len(others) or len(differing) != 1:
        return False
    word, other = differing[0]
    if not _near(word, other, verbs):
        return False
    shortest = min(len(word), len(other))
    if known and (word in known or other in known or (rare in loose and frequent not in loose)):
        return word not in known and shortest >= _SHORT
    return counts[rare] <= _RARE and _is_rare_beside(word, other, counts[rare], counts[frequent])


def _is_rare_beside(word: str, other: str, rare: int, frequent: int) -> bool:
    """Whether a word stands so rarely beside another one that it is hardly meant."""
    # Short words, and words with another letter, are mostly words of their own: dip, drip; batter, butter.
    shortest, ratio = min(len(word), len(other)), frequent / rare
    if frequent < _RATIO:
        return False
    if sorted(word) == sorted(other):  # letters have changed places
        return shortest >= _MIDDLE and ratio >= _RATIO
    if len(word) == len(other):
        return shortest >= _LONG and ratio >= _HIGH_RATIO and rare <= _VERY_RARE
    if ratio >= _HIGHEST_RATIO:
        return shortest >= _SHORT
    return shortest >= _LONG and ratio >= _RATIO
