"""Lines of FOON text, and nodes, that are a single token of the grammar: most are, and need no parser."""

import re
from collections.abc import Callable
from functools import cache

from foon_asp.network import Contents, ObjectNode, Relation, unquoted
from foon_asp.text.grammar import patterns
from foon_asp.text.line import Line, MotionLine, ObjectLine, Remark, StateLine


def clean_line(text: str) -> Line | None:
    """Read a line that is a single token of the grammar; ``None`` for any other."""
    match = _whole_lines()(f"{text}\n")
    return CLEAN[match.lastgroup](text) if match and match.lastgroup else None


def clean_node(notation: str) -> ObjectNode | None:
    """Read a node in one-line notation that is a label alone; ``None`` for any other."""
    return ObjectNode(unquoted(notation)) if _name()(notation) else None


@cache
def _whole_lines() -> Callable[[str], re.Match[str] | None]:
    tokens = "|".join(f"(?P<{name}>{pattern})" for name, pattern in patterns(CLEAN).items())
    return re.compile(tokens).fullmatch


@cache
def _name() -> Callable[[str], re.Match[str] | None]:
    return re.compile(patterns(["NAME"])["NAME"]).fullmatch


def _object(text: str) -> ObjectLine:
    letter, label, *fields = text.split("\t")
    return ObjectLine(label, letter[1:], tuple(fields))


def _plain(text: str) -> StateLine:
    letter, state = text.split("\t")
    return StateLine(state, letter[1:])


def _related(text: str) -> StateLine:
    letter, word, bracket = text.split("\t")
    return StateLine(Relation(word, bracket[1:-1]), letter[1:])


def _related_by_blank(text: str) -> StateLine:
    letter, state = text.split("\t")
    word, related = state[:-1].split(" [")
    remark = no_tab(f"[{related}]", len(letter + word) + 2)
    return StateLine(Relation(word, related), letter[1:], remarks=(remark,))


def _holding(text: str) -> StateLine:
    letter, word, bracket = text.split("\t")
    remarks: list[Remark] = []
    listed = items(bracket[1:-1], len(letter + word) + 4, remarks)
    return StateLine(Contents(word, tuple(sorted(listed))), letter[1:], listed, tuple(remarks))


def _motion(text: str) -> MotionLine:
    letter, motion, *fields = text.split("\t")
    return MotionLine(motion, letter[1:], fields=tuple(fields))


CLEAN: dict[str, Callable[[str], Line]] = {
    "CLEAN_OBJECT": _object,
    "CLEAN_PLAIN": _plain,
    "CLEAN_RELATED": _related,
    "BLANK_RELATED": _related_by_blank,
    "CLEAN_HOLDING": _holding,
    "CLEAN_MOTION": _motion,
}
"""By the name of the token."""


def no_tab(bracket: str, column: int) -> Remark:
    """Remark on a blank, or nothing, where a tab should stand before a bracket."""
    return Remark(column, "space-for-tab", f"no tab before {bracket}; read as if there were one")


def items(listed: str, column: int, remarks: list[Remark]) -> tuple[str, ...]:
    """Split what is in brackets at its commas; ``column`` is that of its first letter.

    What is dropped or doubtful is remarked on, once for each kind.
    """
    split = listed.split(",")
    if len(set(split)) == len(split) and all(item and item[0] != " " != item[-1] for item in split):
        return tuple(split)
    found: list[str] = []
    seen: set[str] = set()
    said: set[str] = set()

    def remark(code: str, message: str) -> None:
        if code not in said:
            remarks.append(Remark(column, code, message))
            said.add(code)

    for raw in split:
        item = raw.strip(" ")
        if not item:
            remark("empty-ingredient", "empty ingredient left out")
        else:
            if item != raw:
                remark("outer-space", f"spaces around {item!r} left out")
            if item in seen:
                remark("repeated-ingredient", f"ingredient {item!r} is listed twice")
            found.append(item)
            seen.add(item)
        column += len(raw) + 1
    return tuple(found)
