"""What there is to say of brackets: of another kind than a word has elsewhere, or none."""

from collections.abc import Iterator

from foon_asp.lint.names import Kind, Names, times
from foon_asp.lint.vocabulary import Vocabulary
from foon_asp.network import Contents, Relation
from foon_asp.text.diagnostics import Diagnostic
from foon_asp.text.line import StateLine

_LONGEST = 3  # words of a relation: attached to, on top of


def bracket_findings(names: Names, known: Vocabulary) -> Iterator[Diagnostic]:
    """Give a finding for each distinct line whose bracket differs from what its word has elsewhere.

    ``known`` has the words of the files, too.
    """
    items = _of_items(names)
    for word, mentions in names.mentions[Kind.WORD].items():
        usual = known.usual_bracket(word)
        for sheet, line, first, often in mentions:
            if not isinstance(line, StateLine) or line.remarks:
                continue
            attribute = line.attribute
            if isinstance(attribute, Relation):
                held, other = (attribute.object,), Contents
            elif isinstance(attribute, Contents):
                held, other = attribute.ingredients, Relation
            else:
                continue
            message = ""
            if usual is other:
                message = f"{word!r} stands with {_sign(usual)} nearly everywhere"
            elif len(held) == 1 and usual is None:
                here, there = items[word, held[0], type(attribute)], items.get((word, held[0], other), 0)
                if there > here:
                    message = f"'{word} {_written(other, held[0])}' stands {times(there)}, this {times(here)}"
                elif other is Relation and held[0] in known.utensils and other in known.brackets[word]:
                    message = f"{held[0]!r} is something that others are in or on"
            if message:
                shown = f"{word} {_written(other, ','.join(held))}"
                message = f"{message}; is {shown!r} meant?"
                yield names.sheets[sheet].finding(
                    "other-bracket", message, first, column=names.sheets[sheet].lines[first].rfind("\t") + 2
                )
    for state, mentions in names.mentions[Kind.STATE].items():
        if state in names.objects and state not in known.names[Kind.STATE]:
            message = f"{state!r} is the name of an object; is it an object line?"
            for sheet, index, _ in names.by_sheet(Kind.STATE, state):
                yield names.sheets[sheet].finding("object-as-state", message, index, state)
        elif meant := _bare(state, names, known):
            for sheet, index, _ in names.by_sheet(Kind.STATE, state):
                message = f"{state!r} is read as a state; is {meant!r} meant, with brackets behind a tab?"
                yield names.sheets[sheet].finding("no-bracket", message, index, state)


def _of_items(names: Names) -> dict[tuple[str, str, type], int]:
    """Count the lines of a word with one thing in brackets, of each kind."""
    counts: dict[tuple[str, str, type], int] = {}
    for word, mentions in names.mentions[Kind.WORD].items():
        for mention in mentions:
            attribute = mention.line.attribute if isinstance(mention.line, StateLine) else ""
            if isinstance(attribute, Relation):
                key: tuple[str, str, type] = (word, attribute.object, Relation)
            elif isinstance(attribute, Contents) and len(attribute.ingredients) == 1:
                key = (word, attribute.ingredients[0], Contents)
            else:
                continue
            counts[key] = counts.get(key, 0) + mention.often
    return counts


def _bare(state: str, names: Names, known: Vocabulary) -> str:
    """Give the relation or the contents that a state may be, where it begins as one and goes on with objects."""
    words = state.split(" ")
    for length in range(min(_LONGEST, len(words) - 1), 0, -1):
        word, rest = " ".join(words[:length]), " ".join(words[length:])
        counts = known.brackets.get(word)
        if not counts or rest in known.names[Kind.STATE]:
            continue
        kind = counts.most_common(1)[0][0]
        held = [item.strip() for item in rest.split(",")]
        objects = known.names[Kind.OBJECT]
        if kind is Contents and (word == "contains" or all(item in objects for item in held)):
            return f"{word} {_written(kind, ','.join(held))}"
        if kind is Relation and (rest in objects or rest in names.objects):
            return f"{word} {_written(kind, rest)}"
    return ""


def _sign(kind: type) -> str:
    return "[ ]" if kind is Relation else "{ }"


def _written(kind: type, held: str) -> str:
    return f"[{held}]" if kind is Relation else f"{{{held}}}"
