"""Reading of lines of FOON text and of nodes in one-line notation.

Lark is imported only for texts that :mod:`foon_asp.text.clean_line` cannot read.
"""

from functools import lru_cache
from typing import cast

from foon_asp.errors import UserError
from foon_asp.network import ObjectNode
from foon_asp.text.clean_line import clean_line, clean_node
from foon_asp.text.line import Line, LineError, StateLine


def parse_line(text: str) -> Line:
    """Return the parsed line of a text: an object, state or motion line without its line end.

    Raises :class:`LineError` when the grammar does not accept it.
    """
    return clean_line(text) or cast(Line, _parse_by_grammar("line", text + "\n"))


@lru_cache(50_000)  # of the 35,576 lines of the universal FOON, 2,123 are different
def read_line(text: str) -> Line | LineError:
    """Return the parsed line of a text, or its error; results are cached.

    A text of more than a million letters is an error.
    """
    max_letters = 1_000_000
    try:
        if len(text) > max_letters:
            raise LineError(max_letters + 1, f"a line of {len(text)} letters", (f"at most {max_letters}",))
        return parse_line(text)
    except LineError as error:
        return error.without_traceback()


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
    return clean_node(notation) or cast(ObjectNode, _parse_by_grammar("node", notation))


def parse_name(text: str) -> str | ObjectNode:
    """Return the label if a text is a label alone, else the node of a one-line notation.

    ``onion;`` is notation: the node with this label and without states. Raises :class:`LineError` like
    :func:`parse_node`.
    """
    node = parse_node(text)
    is_label = node == ObjectNode(node.label) and not text.rstrip(" ").endswith(";")
    return node.label if is_label else node


def read_state(text: str) -> StateLine:
    """Return the state line of a state in a JSON file: ``whole``, ``in [bowl]``, ``coated {a,b}``.

    A blank before a bracket is no slip in JSON. Raises :class:`LineError`, with the column in ``text``, when
    the grammar does not accept the state.
    """
    for column, letter in enumerate(text, 1):
        if letter in "\t\r\n":
            raise LineError(column, repr(letter), ("a name", "[object]", "{ingredient,ingredient}"))
    line = read_line(f"S\t{text}")
    if isinstance(line, LineError):
        raise LineError(max(1, line.column - 2), line.found, line.expected)
    # between a word and its bracket, a JSON file has a blank where FOON text has a tab
    remarks = tuple(remark for remark in line.remarks if remark.code != "space-for-tab")
    return cast(StateLine, line)._replace(remarks=remarks) if line.remarks else cast(StateLine, line)


def _parse_by_grammar(start: str, text: str) -> object:
    """Call ``parse_by_grammar`` of ``line_builder``, which is imported here, since its import takes long."""
    from foon_asp.text.line_builder import parse_by_grammar  # noqa: PLC0415 (imports Lark)

    return parse_by_grammar(start, text)
