"""Fast reading of usual lines of FOON text and of labels, by regular expressions in place of the parser.

Most lines are usual, and importing Lark and building the parser takes a third of a cold ``solve``.
"""

import re

from foon_asp.network import Contents, ObjectNode, Relation
from foon_asp.text.line import Line, MotionLine, ObjectLine, Remark, StateLine

_CLEAN_NAME = r"[^ \t\r\n\[\]{}](?:[^\t\r\n\[\]{}]*[^ \t\r\n\[\]{}])?"
_MOTION = r"[^ *\t\r\n\[\]{}](?:[^*\t\r\n\[\]{}]*[^ *\t\r\n\[\]{}])?"
_RELATED = r"[^ ,\[\]{}\t\r\n](?:[^,\[\]{}\t\r\n]*[^ ,\[\]{}\t\r\n])?"
_OBJECT_LINE = re.compile(rf"O([0-9]*)\t({_CLEAN_NAME})(?:\t([01]))?")
_MOTION_LINE = re.compile(rf"M([0-9]*)\t({_MOTION})((?:\t(?:[0-9]+:[0-9][0-9]|Assumed))*)")
# JSON has a blank for the tab before a bracket; contains [something] is a list in the wrong brackets
_STATE_LINE = re.compile(
    rf"S([0-9]*)\t(?!contains[\t ]\[)({_CLEAN_NAME})(?:([\t ])\[({_RELATED})\]|\t\{{([^\[\]{{}}\t\r\n]*)\}})?"
)
_LABEL = re.compile(r' *[^ ";\t\r\n\[\]{}][^;\t\r\n\[\]{}]*')


def clean_line(text: str) -> Line | None:
    """Return the parsed line of a text without line end, or ``None`` if the parser has to read the text.

    The parser has to read lines with faults and with most slips. Only two kinds of slips are read here, with
    remarks: slips in ingredients, and a space in place of the tab before a bracket.
    """
    if match := _STATE_LINE.fullmatch(text):
        return _matched_state_line(match)
    if match := _OBJECT_LINE.fullmatch(text):
        id_, label, flag = match.groups()
        return ObjectLine(label, id_, (flag,) if flag else ())
    if match := _MOTION_LINE.fullmatch(text):
        id_, motion, times = match.groups()
        return MotionLine(motion, id_, fields=tuple(times.split("\t")[1:]))
    return None


def clean_node(notation: str) -> ObjectNode | None:
    """Return the node of a one-line notation that is a label alone, without quotes.

    Return ``None`` for any other notation.
    """
    return ObjectNode(notation.strip(" ")) if _LABEL.fullmatch(notation) else None


def _matched_state_line(match: re.Match[str]) -> StateLine:
    """Return the state line that ``_STATE_LINE`` matched, with remarks on slips."""
    id_, name, gap, related, listed = match.groups()
    end = match.end(2)
    remarks: list[Remark] = []
    if related is not None:
        if gap == " ":
            remarks.append(no_tab_remark(f"[{related}]", end + 1))
        return StateLine(Relation(name, related), id_, remarks=tuple(remarks))
    if listed is None:
        return StateLine(name, id_)
    ingredients = split_ingredients(listed, end + 3, remarks)
    return StateLine(Contents(name, tuple(sorted(ingredients))), id_, ingredients, tuple(remarks))


def no_tab_remark(bracket: str, column: int) -> Remark:
    """Return the remark that no tab stands before ``bracket``, such as ``[bowl]``."""
    return Remark(column, "space-for-tab", f"no tab before {bracket}; read as if there were one")


def split_ingredients(text: str, column: int, remarks: list[Remark]) -> tuple[str, ...]:
    """Return the ingredients in the text between brackets, split at commas and without spaces around them.

    Empty ingredients are left out, repeated ingredients stay. ``column`` is that of the first letter of the
    text. At most three remarks are added to ``remarks``: on empty, on spaced and on repeated ingredients.
    """
    raw_items = text.split(",")
    if len(set(raw_items)) == len(raw_items) and all(
        item and item[0] != " " != item[-1] for item in raw_items
    ):
        return tuple(raw_items)
    kept: list[str] = []
    seen: set[str] = set()
    remarked: set[str] = set()

    def add_remark(code: str, message: str) -> None:
        """Add a remark at the current column, unless there is one of this code."""
        if code not in remarked:
            remarks.append(Remark(column, code, message))
            remarked.add(code)

    for raw_item in raw_items:
        item = raw_item.strip(" ")
        if not item:
            add_remark("empty-ingredient", "empty ingredient left out")
        else:
            if item != raw_item:
                add_remark("outer-space", f"spaces around {item!r} left out")
            if item in seen:
                add_remark("repeated-ingredient", f"ingredient {item!r} is listed twice")
            kept.append(item)
            seen.add(item)
        column += len(raw_item) + 1
    return tuple(kept)
