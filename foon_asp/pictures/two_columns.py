"""A page with two networks side by side, without scripts. The networks are called A and B."""

import html
import re
from collections.abc import Iterable, Sequence
from typing import NamedTuple

from foon_asp.escapes import UNSAFE
from foon_asp.pictures.page import digest, web_text
from foon_asp.results.values import Node, Unit, UnitDifference

Row = tuple[Unit | None, Unit | None, Sequence[UnitDifference]]


class PairSection(NamedTuple):
    """A section of the page: pairs of units under a heading.

    A row is a unit of A, a unit of B, and their differences. If a unit has no counterpart, the other unit of
    its row is ``None``. A ``folded`` section shows its rows only when the reader unfolds it. A section
    without rows is not shown.
    """

    heading: str
    rows: Sequence[Row]
    folded: bool = False


def two_column_page(
    title: str, names: Sequence[str], table_rows: Sequence[Sequence[str]], sections: Iterable[PairSection]
) -> str:
    """Return the HTML of the page: a table, then sections of units with their differences marked.

    ``names``: the names of the two networks.
    ``table_rows``: the cells of each row of the table; the first row is the header.
    """
    style = web_text("colours_light.css") + web_text("colours_dark.css") + web_text("two_columns.css")
    header, *rows = table_rows
    table = _row_html("th", header) + "".join(_row_html("td", row) for row in rows)
    name_lines = "".join(
        f"<p>{letter}: {_escape(name)}</p>" for letter, name in zip("AB", names, strict=True)
    )
    body = f'<div class="pair">{name_lines}</div><table>{table}</table>'
    body += "".join(map(_section_html, sections))
    policy = f"default-src 'none'; style-src {digest(style)}; base-uri 'none'; form-action 'none'"
    return (
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        f'<meta http-equiv="Content-Security-Policy" content="{policy}">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        '<meta name="color-scheme" content="light dark">\n'
        f"<title>{_escape(title)}</title>\n<style>{style}</style>\n</head>\n"
        f"<body>\n<main>\n<h1>{_escape(title)}</h1>\n{body}\n</main>\n</body>\n</html>\n"
    )


def _section_html(section: PairSection) -> str:
    """Return the HTML of a section; empty for a section without rows."""
    if not section.rows:
        return ""
    heading = f"{section.heading}: {len(section.rows):,}"
    rows = "\n".join(map(_pair_html, section.rows))
    if section.folded:
        return f"<details>\n<summary>{heading}</summary>\n{rows}\n</details>\n"
    return f"<h2>{heading}</h2>\n{rows}\n"


def _pair_html(row: Row) -> str:
    """Return the HTML of two units beside each other; their differences are marked and listed."""
    unit_a, unit_b, differences = row
    column_a = _unit_html(unit_a, {(difference.kind, difference.a) for difference in differences})
    column_b = _unit_html(unit_b, {(difference.kind, difference.b) for difference in differences})
    list_items = "".join(f"<li>{_difference_html(difference)}</li>" for difference in differences)
    return f'<div class="pair">{column_a}{column_b}{f"<ul>{list_items}</ul>" if list_items else ""}</div>'


def _difference_html(difference: UnitDifference) -> str:
    """Return a difference in words as HTML, such as ``state <b>chopped</b> only in A``.

    The node that it is about, if any, comes first.
    """
    prefix = f"{_escape(difference.of)}: " if difference.of else ""
    sides = [f"<b>{_escape(name)}</b>" for name in (difference.a, difference.b) if name]
    location = (
        f"{sides[0]} in A, {sides[1]} in B"
        if len(sides) > 1
        else f"{sides[0]} only in {'A' if difference.a else 'B'}"
    )
    return f"{prefix}{difference.kind} {location}"


def _unit_html(unit: Unit | None, marked: set[tuple[str, str | None]]) -> str:
    """Return the HTML of a unit; for ``None``, an empty cell.

    Names in ``marked``, pairs of a kind and a name, are bold.
    """
    if unit is None:
        return '<section class="none"></section>'
    motion = f"<b>{_escape(unit.motion)}</b>" if ("motion", unit.motion) in marked else _escape(unit.motion)
    inputs, outputs = (
        "".join(f"<li>{_node_html(node, role, marked)}</li>" for node in nodes)
        for role, nodes in (("input", unit.inputs), ("output", unit.outputs))
    )
    return (
        f"<section><h3>{motion} <small>{_escape(str(unit.source[0]))}</small></h3>"
        f'<ul>{inputs}</ul><ul class="out">{outputs}</ul></section>'
    )


def _node_html(node: Node, role: str, marked: set[tuple[str, str | None]]) -> str:
    """Return the HTML of a node in one-line notation.

    ``role`` is ``input`` or ``output``. If ``marked`` has the node in this role, the whole text is bold.
    Otherwise the marked names in the text are bold where they are whole words. Names of motions do not count.
    """
    text = str(node)
    if (role, text) in marked:
        return f"<b>{_escape(text)}</b>"
    names = sorted(
        {name for kind, name in marked if name and kind not in {"motion", "input", "output"}}, key=len
    )
    if not names:
        return _escape(text)
    pattern = "|".join(re.escape(name) for name in reversed(names))
    pieces = re.split(rf"(?<!\w)({pattern})(?!\w)", text)
    return "".join(
        f"<b>{_escape(piece)}</b>" if index % 2 else _escape(piece) for index, piece in enumerate(pieces)
    )


def _row_html(cell: str, texts: Iterable[str]) -> str:
    """Return the HTML of a table row; ``cell`` is the tag of its cells, ``td`` or ``th``."""
    return "<tr>" + "".join(f"<{cell}>{_escape(text)}</{cell}>" for text in texts) + "</tr>"


def _escape(text: str) -> str:
    """Return a text as HTML, in which invisible and misleading characters are replaced."""
    return html.escape(UNSAFE.sub("\ufffd", text))
