"""Lint rules about brackets: the wrong kind, missing ones, and lines with a wrong first letter."""

from collections import Counter
from collections.abc import Iterator

from foon_asp.linting.context import Context
from foon_asp.linting.names import Kind, times_text
from foon_asp.linting.rule import WARNING, rule
from foon_asp.linting.vocabulary import Bracket, Vocabulary
from foon_asp.network import Contents, Relation
from foon_asp.text.diagnostics import Diagnostic
from foon_asp.text.line import StateLine

_LETTERS = {Kind.STATE: "S", Kind.OBJECT: "O"}


@rule("other-bracket", WARNING, "a bracket of another kind than the word has elsewhere")
def find_other_brackets(context: Context) -> Iterator[Diagnostic]:
    """An ingredient is in `{ }`, a place is in `[ ]`.

    A bracket is reported for three reasons. First, in the files or in the vocabulary, the word before the
    bracket nearly always has the other kind. Second, the whole text, such as `in [bowl]`, is more frequent
    with the other kind. Third, the only thing in `{ }` is an object that others are in or on.
    """
    mentions = [
        mention for name_mentions in context.names.mentions[Kind.WORD].values() for mention in name_mentions
    ]
    attributes = [
        (mention, mention.line.attribute)
        for mention in mentions
        if isinstance(mention.line, StateLine) and not isinstance(mention.line.attribute, str)
    ]
    counts = Counter[Relation | Contents]()
    for mention, attribute in attributes:
        counts[attribute] += mention.occurrences
    for mention, attribute in attributes:
        if not mention.line.remarks and (
            message := _reason_to_swap_brackets(attribute, counts, context.all_names)
        ):
            sheet = context.sheets[mention.sheet]
            suggestion = f"; is '{_with_other_bracket(attribute)}' meant?"
            column = sheet.lines[mention.first_index].rfind("\t") + 2
            yield sheet.finding(message + suggestion, mention.first_index, column=column)


def _reason_to_swap_brackets(
    attribute: Relation | Contents, counts: Counter[Relation | Contents], vocabulary: Vocabulary
) -> str:
    """Return in words why an attribute probably needs the other kind of bracket; empty if nothing says so.

    ``counts``: by attribute, the number of lines that have it. :func:`find_other_brackets` names the three
    possible reasons. The second and third reason need a single object in the brackets, and a word without a
    usual kind of bracket.
    """
    other: Bracket = Contents if isinstance(attribute, Relation) else Relation
    usual = vocabulary.usual_bracket(attribute.word)
    if usual is other:
        return f"{attribute.word!r} stands with {'{ }' if other is Contents else '[ ]'} nearly everywhere"
    objects = _bracketed_objects(attribute)
    if len(objects) > 1 or usual is not None:
        return ""
    swapped = Contents(attribute.word, objects) if other is Contents else Relation(attribute.word, objects[0])
    count, swapped_count = counts[attribute], counts[swapped]
    if swapped_count > count:
        return (
            f"'{_with_other_bracket(attribute)}' stands {times_text(swapped_count)}, this {times_text(count)}"
        )
    if (
        other is Relation
        and objects[0] in vocabulary.utensils
        and other in vocabulary.brackets(attribute.word)
    ):
        return f"{objects[0]!r} is something that others are in or on"
    return ""


def _bracketed_objects(attribute: Relation | Contents) -> tuple[str, ...]:
    """Return the names in the brackets: the ingredients in ``{ }``, or the single object in ``[ ]``."""
    return attribute.ingredients if isinstance(attribute, Contents) else (attribute.object,)


def _with_other_bracket(attribute: Relation | Contents) -> str:
    """Return an attribute as text with its brackets swapped: ``in {bowl}`` for ``in [bowl]``."""
    objects = ",".join(_bracketed_objects(attribute))
    return f"{attribute.word} " + (f"{{{objects}}}" if isinstance(attribute, Relation) else f"[{objects}]")


@rule("misread-line", WARNING, "a line that is read as a state or an object, and is probably something else")
def find_misread_lines(context: Context) -> Iterator[Diagnostic]:
    """A state looks like a relation or contents without brackets, such as `in bowl` for `in [bowl]`.

    Such a state begins with a word that has brackets elsewhere and continues with the name of an object. Also
    reported is a state whose name is a utensil or more often the name of an object. An object is reported if
    its name is more often the name of a state. Probably the first letter of the line is wrong. States and
    objects that the vocabulary has as such are not reported.
    """
    names, vocabulary = context.names, context.vocabulary
    states, objects = names.counts[Kind.STATE], names.object_counts
    for state in states:
        if meant := _suggested_attribute(state, context):
            for sheet, index, _ in names.mentions_by_sheet(Kind.STATE, state):
                message = f"{state!r} is read as a state; is {meant!r} meant, with brackets behind a tab?"
                yield sheet.finding(message, index, state)
    for kind, other, counts, other_counts in (
        (Kind.STATE, "an object", states, objects),
        (Kind.OBJECT, "a state", objects, states),
    ):
        for name, count in counts.items():
            is_known_other = other_counts.get(name, 0) > count or name in vocabulary.utensils
            is_misread = is_known_other and name not in vocabulary.names[kind]
            for sheet, index, _ in names.mentions_by_sheet(kind, name) if is_misread else ():
                # JSON has no letters; the name may be that of a container or an ingredient first
                if sheet.places is None and sheet.lines[index][0] == _LETTERS[kind]:
                    message = f"{name!r} is known as {other}; is it {other} here, and the letter wrong?"
                    yield sheet.finding(message, index, name)


def _suggested_attribute(state: str, context: Context) -> str:
    """Return the text of the relation or contents that a state probably stands for; empty for a likely state.

    For example, ``in [bowl]`` for the state ``in bowl``. The names and words are those of the files and of
    the vocabulary. The text in ``[ ]`` has to be a known object. The text in ``{ }`` has to be a list of
    known objects. After ``contains`` it can be any text that is no known state.
    """
    all_names, words = context.all_names, state.split(" ")
    for length in range(min(3, len(words) - 1), 0, -1):  # a relation has up to three words: on top of
        word, objects = " ".join(words[:length]), " ".join(words[length:])
        brackets = list(all_names.brackets(word))
        if not brackets or objects in all_names.names[Kind.STATE]:
            continue
        items = [item.strip() for item in objects.split(",")]
        if brackets[0] is Relation:
            if objects in all_names.names[Kind.OBJECT]:
                return f"{word} [{objects}]"
        elif word == "contains" or all_names.names[Kind.OBJECT] >= set(items):
            return f"{word} {{{','.join(items)}}}"
    return ""
