"""Names that are one name with a slip of the pen."""

import re
from collections.abc import Iterable, Iterator

from foon_asp.network.spelling import joined, one_letter_apart, without_doubles

_LONGEST = 60  # letters: what is longer is no name, and comparing it takes long
_SHORTEST_DOUBLED = 5  # letters: off and of, bell and bel are words of their own
_PLURAL_ENDING = re.compile(r"e?s$")
_VERB_ENDING = re.compile(r"(?:e?[sdr]|[ey])$")  # juice, juiced; flakes, flaked; mix, mixer; salt, salty
_RARE, _VERY_RARE = 5, 2  # mentions
_RATIO, _HIGH_RATIO, _HIGHEST_RATIO = 3, 20, 100  # how much more often the other name stands
_SHORT, _MIDDLE, _LONG = 3, 4, 5  # letters of the shorter word
_COMPARED = 3  # names with the same letters but one: only the most frequent are compared


def near_names(counts: dict[str, int], verbs: bool = False) -> Iterator[tuple[str, str]]:
    """Give pairs of names of one kind: the one that stands less often, and the one that may be meant.

    Names that only differ in doubled letters, capitals, blanks or hyphens are a pair at any frequency
    (``drinking glas``, ``hashbrown``). A name that is rare beside another one is a pair with it if one
    letter is missing, added, changed or has changed places, behind the first letter of a word
    (``baking try``). An ending that is grammar is no slip: egg, eggs, and of ``verbs`` cube, cubed. Nor is a
    digit.

    ``counts`` has the mentions of each name. A name is given once. Time and memory grow with the letters of
    the names: rare names are looked up among the frequent ones by what is left when a letter is taken away.
    """
    paired = set()
    for rare, meant in _spelt_two_ways(counts):
        paired.add(rare)
        yield rare, meant
    rare_names = [name for name, count in counts.items() if count <= _RARE and name not in paired]
    if not rare_names:
        return
    frequent: dict[str, list[str]] = {}
    for name in sorted(counts, key=lambda name: (-counts[name], name)):
        if counts[name] < _RATIO:
            break
        for rest in _without_a_letter(name):
            known = frequent.setdefault(rest, [])
            if len(known) < _COMPARED:
                known.append(name)
    for name in rare_names:
        candidates = {c for rest in _without_a_letter(name) for c in frequent.get(rest, ())}
        ordered = sorted(candidates, key=lambda other: (-counts[other], other))
        meant_name = next((other for other in ordered if _is_slip(name, other, counts, verbs)), None)
        if meant_name is not None:
            yield name, meant_name


def _spelt_two_ways(counts: dict[str, int]) -> Iterator[tuple[str, str]]:
    """Give pairs that are the same without doubled letters, capitals and blanks."""
    spellings: dict[str, list[str]] = {}
    for name in counts:
        if len(name) <= _LONGEST:
            spellings.setdefault(without_doubles(name), []).append(name)
    for skeleton, names in spellings.items():
        if len(names) < 2:
            continue
        most = max(names, key=lambda name: counts[name])
        for name in names:
            if name != most and (len(skeleton) >= _SHORTEST_DOUBLED or joined(name) == joined(most)):
                yield name, most


def _without_a_letter(name: str) -> Iterable[str]:
    if len(name) > _LONGEST:
        return ()
    return {name, *(name[:place] + name[place + 1 :] for place in range(len(name)))}


def _is_slip(rare: str, frequent: str, counts: dict[str, int], verbs: bool) -> bool:
    """Whether a rare name is likely a slip for a frequent one with almost the same letters."""
    words, others = rare.split(" "), frequent.split(" ")
    differing = [(a, b) for a, b in zip(words, others, strict=False) if a != b]
    if len(words) != len(others) or len(differing) != 1:
        return False
    word, other = differing[0]
    ending = _VERB_ENDING if verbs else _PLURAL_ENDING
    is_grammar = ending.sub("", word) == ending.sub("", other)
    if is_grammar or word[:1] != other[:1] or not one_letter_apart(word, other):
        return False
    # Short words, and words with another letter, are mostly words of their own: dip, drip; batter, butter.
    ratio = counts[frequent] / counts[rare]
    shortest = min(len(word), len(other))
    if sorted(word) == sorted(other):  # letters have changed places
        return shortest >= _MIDDLE and ratio >= _RATIO
    if len(word) == len(other):
        return shortest >= _LONG and ratio >= _HIGH_RATIO and counts[rare] <= _VERY_RARE
    if ratio >= _HIGHEST_RATIO:
        return shortest >= _SHORT
    return shortest >= _LONG and ratio >= _RATIO
