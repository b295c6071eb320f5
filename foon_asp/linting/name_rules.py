"""Lint rules about names: typing errors, and names in brackets that are never objects."""

import re
from collections.abc import Iterator

from foon_asp.linting.context import Context
from foon_asp.linting.names import Kind, times_text
from foon_asp.linting.rule import NOTE, WARNING, rule
from foon_asp.linting.vocabulary import Bracket, words_of
from foon_asp.network import Contents, Relation
from foon_asp.text.diagnostics import Diagnostic, Rename
from foon_asp.text.line import StateLine


@rule("near-name", WARNING, "two names that differ by a likely typing error")
def find_near_names(context: Context) -> Iterator[Diagnostic]:
    """Two names of one kind are probably meant to be the same.

    The kinds are objects (with containers and ingredients), states, motions, and words of relations. Names
    that differ only in doubled letters, capitals, spaces or hyphens are reported however often they occur.
    Names that differ in a single letter are reported if one name is rare, not in the vocabulary, or never
    made or never taken. The letter is missing, added, changed, or swapped with the next. Four differences do
    not count as slips: singular and plural, endings of verbs (`cube` and `cubed`), digits, and different
    first letters. But `gratd` for `grated` is a slip. Each pair is reported once in each file, at the rarer
    name. The rarer name need not be the wrong one.
    """
    for kind, pairs in context.near_names.items():
        for name, meant in pairs:
            yield from _near_name_findings(context, kind, name, meant)


def _near_name_findings(context: Context, kind: Kind, name: str, meant: str) -> Iterator[Diagnostic]:
    """Yield a finding for each sheet with ``name``, which is probably ``meant`` misspelt.

    The finding has a rename to ``meant`` if ``meant`` is more frequent. It also has one if only ``name`` has
    a word that the vocabulary does not know.
    """
    names, words = context.names, context.vocabulary.words
    counts = names.counts[kind]
    is_slip = words.issuperset(words_of(meant)) and not words.issuperset(words_of(name))
    # two names that stand equally often: which one is wrong?
    rename = Rename(kind, name, meant) if counts[meant] > counts[name] or is_slip else None
    roles = ""
    if kind is Kind.OBJECT and (name in names.object_counts) != (meant in names.object_counts):
        unlisted = name if meant in names.object_counts else meant
        roles = f", and {unlisted!r} is never an object of its own"
    for sheet, index, count in names.mentions_by_sheet(kind, name):
        others = "" if count == counts[name] else f" ({times_text(count)} in this file)"
        message = (
            f"the {kind} {name!r} stands {times_text(counts[name])}{others}, "
            f"{meant!r} {times_text(counts[meant])}{roles}: "
            f"if they mean the same, write one of them everywhere"
        )
        yield sheet.finding(message, index, name)._replace(rename=rename)


@rule("misspelt", WARNING, "a word that is nearly one of the vocabulary")
def find_misspelt_words(context: Context) -> Iterator[Diagnostic]:
    """A word that is not in the vocabulary differs by one letter from a word of the vocabulary.

    It is reported once in each file. If the right name stands in the files, too, the finding is a
    `near-name`.
    """
    for kind, counts in context.names.counts.items():
        for name in counts:
            if (slip := context.vocabulary.find_slip(kind, name)) and (
                kind,
                name,
            ) not in context.paired_names:
                word, meant = slip
                message = f"{word!r} in the {kind} {name!r} is no word that is known; is it {meant!r}?"
                corrected = re.sub(rf"(?<![^\W\d_]){word}(?![^\W\d_])", meant, name)
                rename = (
                    Rename(kind, name, corrected) if corrected != name else None
                )  # it has capitals or accents
                for sheet, index, _ in context.names.mentions_by_sheet(kind, name):
                    yield sheet.finding(message, index, name)._replace(rename=rename)


@rule("unknown-container", NOTE, "an object in [ ] that is never an object line")
def find_unknown_containers(context: Context) -> Iterator[Diagnostic]:
    """No unit takes or makes the container as an object; it may have another name as an object.

    If no object has a similar name, the container is reported only if the vocabulary lacks a word of it. It
    is reported once for all files, where it first occurs.
    """
    return _unlisted_name_findings(context, Relation, "stands in [ ]", "no unit takes or makes it")


@rule("unknown-ingredient", WARNING, "an ingredient in { } that is never an object line")
def find_unknown_ingredients(context: Context) -> Iterator[Diagnostic]:
    """No unit takes or makes the ingredient as an object; it may have another name as an object.

    If no object has a similar name, the ingredient is reported only if the vocabulary lacks a word of it. It
    is reported once for all files, where it first occurs.
    """
    return _unlisted_name_findings(context, Contents, "is an ingredient", "no unit adds it")


def _unlisted_name_findings(
    context: Context, bracket: Bracket, role: str, advice: str
) -> Iterator[Diagnostic]:
    """Yield a finding for each name in a kind of bracket that is never an object of a unit.

    ``bracket`` is ``Relation`` for ``[ ]`` or ``Contents`` for ``{ }``. ``role`` and ``advice`` are parts of
    the messages. Brackets in kitchens and lists of goals do not count. Names that are reported as `near-name`
    or `misspelt` are skipped. Names that resemble no object are skipped if the vocabulary has all their
    words.
    """
    names, vocabulary = context.names, context.vocabulary
    for name, mentions in names.mentions[Kind.OBJECT].items():
        if name in names.object_counts or (Kind.OBJECT, name) in context.paired_names:
            continue
        bracketed = [
            mention
            for mention in mentions
            if isinstance(mention.line, StateLine)
            and isinstance(mention.line.attribute, bracket)
            and context.sheets[mention.sheet].entries is None
        ]
        if not bracketed or vocabulary.find_slip(Kind.OBJECT, name):
            continue
        alike = " or ".join(map(repr, names.similar_labels(name)))
        if not alike and all(word in vocabulary.words for word in name.lower().replace("-", " ").split()):
            continue
        first = min(bracketed, key=lambda mention: (mention.sheet, mention.first_index))
        sheets = len({mention.sheet for mention in bracketed})
        how_often = times_text(sum(mention.occurrences for mention in bracketed)) + (
            f" in {sheets} files" if sheets > 1 else ""
        )
        message = (
            f"{name!r} {role} {how_often}, and is never an object; {f'is it {alike}?' if alike else advice}"
        )
        yield context.sheets[first.sheet].finding(message, first.first_index, name)
