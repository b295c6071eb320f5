"""What there is to say of names: slips of the pen, and objects that are never there."""

from collections.abc import Iterator

from foon_asp.lint.names import Kind, Names, times
from foon_asp.lint.near_names import near_names, near_word
from foon_asp.lint.vocabulary import Vocabulary, words_of
from foon_asp.network import Contents, Relation
from foon_asp.text.diagnostics import Diagnostic, Rename
from foon_asp.text.line import StateLine


def name_findings(names: Names, known: Vocabulary) -> Iterator[Diagnostic]:
    """Give the findings about near names, and about containers and ingredients that are no object.

    ``known`` are names that FOONs have elsewhere.
    """
    said = set()
    for kind in Kind:
        verbs = kind is not Kind.OBJECT
        for name, meant in near_names(names.counts[kind], verbs, known.words, names.loose[kind]):
            said |= {(kind, name), (kind, meant)}
            yield from _near(names, kind, name, meant)
        for name in names.counts[kind]:
            if (kind, name) not in said and name not in known.names[kind]:
                yield from _misspelt(names, kind, name, known)
    if names.has_network:
        for name in names.mentions[Kind.OBJECT]:
            if name not in names.objects and (Kind.OBJECT, name) not in said:
                yield from _unknown(names, name)


def _near(names: Names, kind: Kind, name: str, meant: str) -> Iterator[Diagnostic]:
    counts = names.counts[kind]
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
        rename = Rename(kind, name, meant) if counts[meant] > counts[name] else None  # which one is wrong?
        yield names.sheets[sheet].finding("near-name", message, index, name)._replace(rename=rename)


def _misspelt(names: Names, kind: Kind, name: str, known: Vocabulary) -> Iterator[Diagnostic]:
    """Say of a name that a word of it is nearly one that is known."""
    for word in words_of(name):
        if word in known.words:
            continue
        meant = near_word(word, known.near, verbs=kind is not Kind.OBJECT)
        if meant is not None:
            message = f"{word!r} in the {kind} {name!r} is no word that is known; is it {meant!r}?"
            for sheet, index, _ in names.by_sheet(kind, name):
                yield names.sheets[sheet].finding("misspelt", message, index, name)
            return


def _unknown(names: Names, name: str) -> Iterator[Diagnostic]:
    """Say once of a name that no file has it as an object: as a container, and as an ingredient."""
    alike = " or ".join(map(repr, names.objects_alike(name)))
    for code, part in (("unknown-container", Relation), ("unknown-ingredient", Contents)):
        found = [
            mention
            for mention in names.mentions[Kind.OBJECT][name]
            if isinstance(mention.line, StateLine) and isinstance(mention.line.attribute, part)
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
