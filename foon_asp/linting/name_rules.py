"""What there is to say of names: slips of the pen, and objects that are never there."""

import re
from collections.abc import Iterator

from foon_asp.linting.names import Kind, Names, times
from foon_asp.linting.near_names import near_names, near_word
from foon_asp.linting.vocabulary import Vocabulary, words_of
from foon_asp.network import Contents, Relation
from foon_asp.text.diagnostics import Diagnostic, Rename
from foon_asp.text.line import StateLine

_A = {Kind.OBJECT: "an object", Kind.STATE: "a state"}
_LETTERS = {Kind.OBJECT: "O", Kind.STATE: "S"}


def name_findings(names: Names, known: Vocabulary) -> Iterator[Diagnostic]:
    """Give the findings about near names, and about containers and ingredients that are no object.

    ``known`` are names that FOONs have elsewhere.
    """
    said = set()
    for kind in Kind:
        verbs = kind is not Kind.OBJECT
        for name, meant in near_names(names.counts[kind], verbs, known.words, names.loose[kind]):
            said |= {(kind, name), (kind, meant)}
            yield from _near(names, kind, name, meant, known)
        for name in names.counts[kind]:
            if (kind, name) not in said and name not in known.names[kind]:
                for finding in _misspelt(names, kind, name, known):
                    said.add((kind, name))
                    yield finding
    yield from _of_the_other_kind(names, known)
    if names.has_network:
        for name in names.mentions[Kind.OBJECT]:
            if name not in names.objects and (Kind.OBJECT, name) not in said:
                yield from _unknown(names, name, known)


def _near(names: Names, kind: Kind, name: str, meant: str, known: Vocabulary) -> Iterator[Diagnostic]:
    counts = names.counts[kind]
    is_slip = known.words.issuperset(words_of(meant)) and not known.words.issuperset(words_of(name))
    # two names that stand equally often: which one is wrong?
    rename = Rename(kind, name, meant) if counts[meant] > counts[name] or is_slip else None
    roles = ""
    if kind is Kind.OBJECT and (name in names.objects) != (meant in names.objects):
        only = name if meant in names.objects else meant
        roles = f", and {only!r} is never an object of its own"
    for sheet, index, here in names.by_sheet(kind, name):
        others = "" if here == counts[name] else f" ({times(here)} in this file)"
        message = (
            f"the {kind} {name!r} stands {times(counts[name])}{others}, {meant!r} {times(counts[meant])}"
            f"{roles}: if they mean the same, write one of them everywhere"
        )
        yield names.sheets[sheet].finding("near-name", message, index, name)._replace(rename=rename)


def _of_the_other_kind(names: Names, known: Vocabulary) -> Iterator[Diagnostic]:
    """Say of states that are objects and of objects that are states, where they are known as nothing else."""
    states, objects = names.counts[Kind.STATE], names.objects
    for kind, here, other in ((Kind.STATE, states, Kind.OBJECT), (Kind.OBJECT, objects, Kind.STATE)):
        there = names.objects if other is Kind.OBJECT else states
        for name, count in here.items():
            is_other = there.get(name, 0) > count or name in known.utensils
            if is_other and kind is not other and name not in known.names[kind]:
                message = f"{name!r} is known as {_A[other]}; is it {_A[other]} here, and the letter wrong?"
                for sheet, index, _ in names.by_sheet(kind, name):
                    if names.sheets[sheet].lines[index][:1] == _LETTERS[kind]:
                        yield names.sheets[sheet].finding("other-kind", message, index, name)


def _misspelt(names: Names, kind: Kind, name: str, known: Vocabulary) -> Iterator[Diagnostic]:
    """Say of a name that a word of it is nearly one that is known."""
    for word in words_of(name):
        if word in known.words:
            continue
        meant = near_word(word, known.near[kind], verbs=kind is not Kind.OBJECT)
        if meant is not None:
            message = f"{word!r} in the {kind} {name!r} is no word that is known; is it {meant!r}?"
            right = re.sub(rf"(?<![^\W\d_]){word}(?![^\W\d_])", meant, name)
            rename = Rename(kind, name, right) if right != name else None  # it has capitals or accents
            for sheet, index, _ in names.by_sheet(kind, name):
                yield names.sheets[sheet].finding("misspelt", message, index, name)._replace(rename=rename)
            return


def _unknown(names: Names, name: str, known: Vocabulary) -> Iterator[Diagnostic]:
    """Say once of a name that no file has it as an object: as a container, and as an ingredient.

    Where no other name may be meant, it has to have a word that is not known.
    """
    alike = " or ".join(map(repr, names.objects_alike(name)))
    if not alike and all(word in known.words for word in name.lower().replace("-", " ").split()):
        return
    for code, part in (("unknown-container", Relation), ("unknown-ingredient", Contents)):
        found = [
            mention
            for mention in names.mentions[Kind.OBJECT][name]
            if isinstance(mention.line, StateLine)
            and isinstance(mention.line.attribute, part)
            and names.sheets[mention.sheet].entries is None
        ]
        if not found:
            continue
        first = min(found, key=lambda mention: (mention.sheet, mention.first))
        often = times(sum(mention.often for mention in found))
        sheets = len({mention.sheet for mention in found})
        often += f" in {sheets} files" if sheets > 1 else ""
        if part is Relation:
            message = f"{name!r} stands in [ ] {often}, and is never an object"
            advice = "no unit takes or makes it"
        else:
            message = f"{name!r} is an ingredient {often}, and is never an object"
            advice = "no unit adds it"
        message += f"; is it {alike}?" if alike else f"; {advice}"
        yield names.sheets[first.sheet].finding(code, message, first.first, name)
