"""Brackets of another kind than a word has elsewhere, and lines without them or with a wrong letter."""

from collections import Counter
from collections.abc import Iterator

from foon_asp.linting.context import Context
from foon_asp.linting.names import Kind, times
from foon_asp.linting.rule import WARNING, rule
from foon_asp.linting.vocabulary import Bracket, Vocabulary
from foon_asp.network import Contents, Relation
from foon_asp.text.diagnostics import Diagnostic
from foon_asp.text.line import StateLine

_LETTERS = {Kind.STATE: "S", Kind.OBJECT: "O"}
_MAX_WORDS = 3  # of a relation: attached to, on top of


@rule("other-bracket", WARNING, "a bracket of another kind than the word has elsewhere")
def other_bracket(context: Context) -> Iterator[Diagnostic]:
    """In `{ }` is an ingredient, in `[ ]` a place.

    In the files and in the vocabulary, the word stands with the other bracket nearly always, or the same
    thing does.
    """
    mentions = [each for listed in context.names.mentions[Kind.WORD].values() for each in listed]
    clean = [
        (each, each.line.attribute)
        for each in mentions
        if isinstance(each.line, StateLine) and not isinstance(each.line.attribute, str)
    ]
    counts = Counter[Relation | Contents]()
    for mention, attribute in clean:
        counts[attribute] += mention.often
    for mention, attribute in clean:
        if not mention.line.remarks and (message := _other_is_meant(attribute, counts, context.known)):
            sheet = context.sheets[mention.sheet]
            meant = f"; is '{_in_other_bracket(attribute)}' meant?"
            column = sheet.lines[mention.first].rfind("\t") + 2
            yield sheet.finding(message + meant, mention.first, column=column)


def _other_is_meant(
    attribute: Relation | Contents, counts: Counter[Relation | Contents], known: Vocabulary
) -> str:
    """Return why the other bracket is probably meant; empty where nothing speaks for it."""
    other: Bracket = Contents if isinstance(attribute, Relation) else Relation
    usual = known.usual_bracket(attribute.word)
    if usual is other:
        return f"{attribute.word!r} stands with {'{ }' if other is Contents else '[ ]'} nearly everywhere"
    held = _held(attribute)
    if len(held) > 1 or usual is not None:
        return ""
    swapped = Contents(attribute.word, held) if other is Contents else Relation(attribute.word, held[0])
    here, there = counts[attribute], counts[swapped]
    if there > here:
        return f"'{_in_other_bracket(attribute)}' stands {times(there)}, this {times(here)}"
    if other is Relation and held[0] in known.utensils and other in known.brackets(attribute.word):
        return f"{held[0]!r} is something that others are in or on"
    return ""


def _held(attribute: Relation | Contents) -> tuple[str, ...]:
    return attribute.ingredients if isinstance(attribute, Contents) else (attribute.object,)


def _in_other_bracket(attribute: Relation | Contents) -> str:
    held = ",".join(_held(attribute))
    return f"{attribute.word} " + (f"{{{held}}}" if isinstance(attribute, Relation) else f"[{held}]")


@rule("misread-line", WARNING, "a line that is read as a state or an object, and is probably something else")
def misread_line(context: Context) -> Iterator[Diagnostic]:
    """A state begins with a word that has brackets elsewhere and continues with the name of an object.

    It is a relation or contents, but without brackets behind a tab. Or a state is known as an object and an
    object as a state, and the letter at the beginning of the line is the wrong one.
    """
    names, vocabulary = context.names, context.vocabulary
    states, objects = names.counts[Kind.STATE], names.objects
    for state in states:
        if meant := _bracketed(state, context):
            for sheet, index, _ in names.by_sheet(Kind.STATE, state):
                message = f"{state!r} is read as a state; is {meant!r} meant, with brackets behind a tab?"
                yield sheet.finding(message, index, state)
    for kind, other, here, there in (
        (Kind.STATE, "an object", states, objects),
        (Kind.OBJECT, "a state", objects, states),
    ):
        for name, count in here.items():
            known_elsewhere = there.get(name, 0) > count or name in vocabulary.utensils
            is_other = known_elsewhere and name not in vocabulary.names[kind]
            for sheet, index, _ in names.by_sheet(kind, name) if is_other else ():
                # JSON has no letters; the name may be that of a container or an ingredient first
                if sheet.places is None and sheet.lines[index][0] == _LETTERS[kind]:
                    message = f"{name!r} is known as {other}; is it {other} here, and the letter wrong?"
                    yield sheet.finding(message, index, name)


def _bracketed(state: str, context: Context) -> str:
    """Return the relation or the contents that a state may be, which begins as one and ends with objects."""
    known, words = context.known, state.split(" ")
    for length in range(min(_MAX_WORDS, len(words) - 1), 0, -1):
        word, held = " ".join(words[:length]), " ".join(words[length:])
        brackets = list(known.brackets(word))
        if not brackets or held in known.names[Kind.STATE]:
            continue
        items = [item.strip() for item in held.split(",")]
        if brackets[0] is Relation:
            if held in known.names[Kind.OBJECT]:
                return f"{word} [{held}]"
        elif word == "contains" or known.names[Kind.OBJECT] >= set(items):
            return f"{word} {{{','.join(items)}}}"
    return ""
