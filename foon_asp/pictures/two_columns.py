"""A page with two networks side by side, without scripts."""

import html
import re
from collections.abc import Iterable, Sequence
from typing import NamedTuple

from foon_asp.escapes import UNSAFE
from foon_asp.pictures.page import digest, web
from foon_asp.results.values import Node, Unit, UnitDifference

Row = tuple[Unit | None, Unit | None, Sequence[UnitDifference]]


class Pair(NamedTuple):
    """Pairs of units of two networks under a heading; the reader has to unfold ``folded`` ones."""

    heading: str
    rows: Sequence[Row]
    folded: bool = False


def two_columns(
    title: str, names: Sequence[str], figures: Sequence[Sequence[str]], sections: Iterable[Pair]
) -> str:
    """Return the page: a table of figures, then units under headings, with differences marked.

    ``names`` are the names of the two networks. ``figures`` are rows of cells; the first row is the header.
    """
    style = web("light.css") + web("dark.css") + web("two_columns.css")
    head, *rows = figures
    table = _row("th", head) + "".join(_row("td", row) for row in rows)
    columns = "".join(f"<p>{letter}: {_text(name)}</p>" for letter, name in zip("AB", names, strict=True))
    body = f'<div class="pair">{columns}</div><table>{table}</table>'
    body += "".join(map(_section, sections))
    policy = f"default-src 'none'; style-src {digest(style)}; base-uri 'none'; form-action 'none'"
    return (
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        f'<meta http-equiv="Content-Security-Policy" content="{policy}">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        '<meta name="color-scheme" content="light dark">\n'
        f"<title>{_text(title)}</title>\n<style>{style}</style>\n</head>\n"
        f"<body>\n<main>\n<h1>{_text(title)}</h1>\n{body}\n</main>\n</body>\n</html>\n"
    )


def _section(section: Pair) -> str:
    """Return the HTML of pairs of units under their heading; nothing without any."""
    if not section.rows:
        return ""
    heading = f"{section.heading}: {len(section.rows):,}"
    rows = "\n".join(map(_pair, section.rows))
    if section.folded:
        return f"<details>\n<summary>{heading}</summary>\n{rows}\n</details>\n"
    return f"<h2>{heading}</h2>\n{rows}\n"


def _pair(row: Row) -> str:
    """Return the HTML of two units beside each other, with their differences marked and listed."""
    unit_a, unit_b, differences = row
    column_a = _unit(unit_a, {(difference.kind, difference.a) for difference in differences})
    column_b = _unit(unit_b, {(difference.kind, difference.b) for difference in differences})
    items = "".join(f"<li>{_difference(difference)}</li>" for difference in differences)
    return f'<div class="pair">{column_a}{column_b}{f"<ul>{items}</ul>" if items else ""}</div>'


def _difference(difference: UnitDifference) -> str:
    """Return a difference in words, such as ``state chopped only in A``."""
    prefix = f"{_text(difference.of)}: " if difference.of else ""
    sides = [f"<b>{_text(name)}</b>" for name in (difference.a, difference.b) if name]
    location = (
        f"{sides[0]} in A, {sides[1]} in B"
        if len(sides) > 1
        else f"{sides[0]} only in {'A' if difference.a else 'B'}"
    )
    return f"{prefix}{difference.kind} {location}"


def _unit(unit: Unit | None, marked: set[tuple[str, str | None]]) -> str:
    """Return the HTML of a unit, with the kinds and names in ``marked`` bold; an empty cell for ``None``."""
    if unit is None:
        return '<section class="none"></section>'
    motion = f"<b>{_text(unit.motion)}</b>" if ("motion", unit.motion) in marked else _text(unit.motion)
    inputs, outputs = (
        "".join(f"<li>{_node(node, role, marked)}</li>" for node in nodes)
        for role, nodes in (("input", unit.inputs), ("output", unit.outputs))
    )
    return (
        f"<section><h3>{motion} <small>{_text(str(unit.source[0]))}</small></h3>"
        f'<ul>{inputs}</ul><ul class="out">{outputs}</ul></section>'
    )


def _node(node: Node, role: str, marked: set[tuple[str, str | None]]) -> str:
    """Return a node in one-line notation, with the names in it that differ marked."""
    text = str(node)
    if (role, text) in marked:
        return f"<b>{_text(text)}</b>"
    names = sorted(
        {name for kind, name in marked if name and kind not in {"motion", "input", "output"}}, key=len
    )
    if not names:
        return _text(text)
    pattern = "|".join(re.escape(name) for name in reversed(names))
    pieces = re.split(rf"(?<!\w)({pattern})(?!\w)", text)
    return "".join(
        f"<b>{_text(piece)}</b>" if index % 2 else _text(piece) for index, piece in enumerate(pieces)
    )


def _row(cell: str, texts: Iterable[str]) -> str:
    return "<tr>" + "".join(f"<{cell}>{_text(text)}</{cell}>" for text in texts) + "</tr>"


def _text(text: str) -> str:
    return html.escape(UNSAFE.sub("\ufffd", text))
