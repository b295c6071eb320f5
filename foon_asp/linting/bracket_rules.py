"""What there is to say of brackets: of another kind than a word has elsewhere, or none."""

from collections.abc import Iterator, Sequence

from foon_asp.linting.names import Kind, Names, times
from foon_asp.linting.vocabulary import Bracket, Vocabulary
from foon_asp.network import Contents, Relation
from foon_asp.text.diagnostics import Diagnostic
from foon_asp.text.line import StateLine
from foon_asp.text.reader import FoonReader

_LONGEST = 3  # words of a relation: attached to, on top of


def bracket_findings(names: Names, known: Vocabulary) -> Iterator[Diagnostic]:
    """Give a finding for each distinct line whose bracket differs from what its word has elsewhere.

    ``known`` has the words of the files, too.
    """
    items = _of_items(names)
    for word, mentions in names.mentions[Kind.WORD].items():
        usual = known.usual_bracket(word)
        for sheet, line, first, _ in mentions:
            if not isinstance(line, StateLine) or line.remarks:
                continue
            attribute = line.attribute
            held: tuple[str, ...]
            other: Bracket
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
    for state in names.mentions[Kind.STATE]:
        if meant := _bare(state, names, known):
            for sheet, index, _ in names.by_sheet(Kind.STATE, state):
                message = f"{state!r} is read as a state; is {meant!r} meant, with brackets behind a tab?"
                yield names.sheets[sheet].finding("no-bracket", message, index, state)


def without_doubtful_fixes(
    remarks: Sequence[Diagnostic], known: Vocabulary, reader: FoonReader
) -> list[Diagnostic]:
    """Give remarks without the fixes of lines whose brackets are of two kinds, where the other may be meant.

    What is a list, or what a word ``contains``, is in braces; else the word has to stand with that kind of
    bracket elsewhere.
    """
    doubtful = set()
    for remark in remarks:
        if remark.code != "bracket" or "wrong bracket" not in remark.message:
            continue
        line = reader.parse(remark.excerpt)
        attribute = line.attribute if isinstance(line, StateLine) else ""
        if isinstance(attribute, Relation):
            certain = known.usual_bracket(attribute.word) is Relation
        elif isinstance(attribute, Contents):
            listed = len(attribute.ingredients) > 1 or attribute.word == "contains"
            certain = listed or known.usual_bracket(attribute.word) is Contents
        else:
            continue
        if not certain:
            doubtful.add(remark.source[:2])
    return [remark._replace(fix=None) if remark.source[:2] in doubtful else remark for remark in remarks]


def _of_items(names: Names) -> dict[tuple[str, str, Bracket], int]:
    """Count the lines of a word with one thing in brackets, of each kind."""
    counts: dict[tuple[str, str, Bracket], int] = {}
    for word, mentions in names.mentions[Kind.WORD].items():
        for mention in mentions:
            attribute = mention.line.attribute if isinstance(mention.line, StateLine) else ""
            if isinstance(attribute, Relation):
                key: tuple[str, str, Bracket] = (word, attribute.object, Relation)
            elif isinstance(attribute, Contents) and len(attribute.ingredients) == 1:
                key = (word, attribute.ingredients[0], Contents)
            else:
                continue
            counts[key] = counts.get(key, 0) + mention.often
    return counts


def _bare(state: str, names: Names, known: Vocabulary) -> str:
    """Give the relation or the contents that a state may be: it begins as one and goes on with objects."""
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


def _sign(kind: Bracket) -> str:
    return "[ ]" if kind is Relation else "{ }"


def _written(kind: Bracket, held: str) -> str:
    return f"[{held}]" if kind is Relation else f"{{{held}}}"
