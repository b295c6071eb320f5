"""Reading lines of FOON text and nodes in one-line notation.

Lark is imported for what is not a single token of the grammar.
"""

from collections.abc import Sequence
from functools import lru_cache
from typing import cast

from foon_asp.errors import UserError
from foon_asp.network import ObjectNode
from foon_asp.text.clean_line import clean_line, clean_node
from foon_asp.text.line import Line, LineError, StateLine

_BATCH = 500  # lines handed to the parser at once: one at fault sends only these back, one by one


def parse_line(text: str) -> Line:
    """Read an object, state or motion line, given without its line end.

    Raises :class:`LineError` when the grammar does not accept it.
    """
    return clean_line(text) or cast(list[Line], _build("lines", text + "\n"))[0]


def parse_lines(texts: Sequence[str]) -> list[Line | LineError]:
    """Read many lines, which is faster than one by one."""
    found: list[Line | LineError | None] = [clean_line(text) for text in texts]
    others = [place for place, line in enumerate(found) if line is None]
    for start in range(0, len(others), _BATCH):
        batch = others[start : start + _BATCH]
        lines: list[Line | LineError] = []
        try:
            text = "".join(f"{texts[place]}\n" for place in batch)
            lines += cast(list[Line], _build("lines", text))
        except LineError:
            for place in batch:
                try:
                    lines.append(parse_line(texts[place]))
                except LineError as error:
                    lines.append(error.kept())
        for place, line in zip(batch, lines, strict=True):
            found[place] = line
    return cast(list[Line | LineError], found)


def parse_node(notation: str) -> ObjectNode:
    """Read an object node in one-line notation.

    Parameters:
        notation: For example ``sweet potato; chopped; in [cutting board]``; a name in it may be in quotes, as
            a string of JSON: ``"a; b"; chopped``.

    Returns:
        The object node.

    Raises:
        LineError: for text that is not in the notation, with the column and what was expected.
        UserError: for what is no text.

    Example:
        >>> node = foon_asp.parse_node("sweet potato; chopped; in [cutting board]")
        >>> node.label, sorted(node.states)
        ('sweet potato', ['chopped'])
    """
    if not isinstance(notation, str):
        raise UserError(f"found notation={notation!r}, expected text")
    notation = notation.rstrip(" ")
    return clean_node(notation) or cast(ObjectNode, _build("node", notation))


def parse_name(text: str) -> str | ObjectNode:
    """Return the label that a text is alone, or the node in one-line notation; ``onion;`` is a node.

    Raises :class:`LineError` like :func:`parse_node`.
    """
    node = parse_node(text)
    is_label = node == ObjectNode(node.label) and not text.rstrip(" ").endswith(";")
    return node.label if is_label else node


@lru_cache(10_000)  # a kitchen says "empty" hundreds of times
def read_state(text: str) -> StateLine:
    """Read what a state of a JSON file says, as on a state line: ``whole``, ``in [bowl]``, ``coated {a,b}``.

    Raises :class:`LineError`, with the column in ``text``, when the grammar does not accept it.
    """
    for column, letter in enumerate(text, 1):
        if letter in "\t\r\n":
            raise LineError(column, repr(letter), ("a name", "[object]", "{ingredient,ingredient}"))
    try:
        line = cast(StateLine, parse_line(f"S\t{text}"))
    except LineError as error:
        raise LineError(max(1, error.column - 2), error.found, error.expected) from None
    # between a word and its bracket, a JSON file has a blank where FOON text has a tab
    return line._replace(remarks=tuple(r for r in line.remarks if r.code != "space-for-tab"))


def _build(start: str, text: str) -> object:
    from foon_asp.text.line_builder import build  # noqa: PLC0415 (takes Lark along)

    return build(start, text)
