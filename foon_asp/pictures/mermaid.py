"""Drawings as Mermaid flowcharts, which many viewers of Markdown show as pictures."""

import re
from collections.abc import Iterator

from foon_asp.json_layout import json_line
from foon_asp.pictures.drawing import Box, Drawing, Role

# By role: the brackets of a box and its style. Mermaid has no double borders: a goal's is thick.
_ROLE_STYLES = {
    Role.MOTION: ("[", "]", "fill:#c62828,stroke:#8e0000,color:#ffffff"),
    Role.KITCHEN: ("(", ")", "fill:#e3f4e1,stroke:#7cb97c,color:#000000"),
    Role.OBJECT: ("(", ")", "fill:#93d293,stroke:#2e7d32,color:#000000"),
    Role.BY_PRODUCT: ("(", ")", "fill:#ffffff,stroke:#7cb97c,color:#000000,stroke-dasharray:4"),
    Role.GOAL: ("([", "])", "fill:#ffd54f,stroke:#a67c00,color:#000000,stroke-width:4px"),
}

# Characters with a meaning in Mermaid, Markdown or HTML. In quotes, brackets, braces and commas have none.
_SPECIAL = re.compile(r"[!-'*+\-./:;<-@\\^_`|~]")


def mermaid_text(drawing: Drawing) -> str:
    """Return a drawing as a Mermaid flowchart from top to bottom; its title is the caption in one line."""
    return "\n".join(_flowchart_lines(drawing)) + "\n"


def mermaid_markdown(drawing: Drawing) -> str:
    """Return a drawing as a Mermaid flowchart in a code block of Markdown."""
    return f"```mermaid\n{mermaid_text(drawing)}```\n"


def _flowchart_lines(drawing: Drawing) -> Iterator[str]:
    """Yield the parts of a flowchart: its header with the caption, boxes, arrows, and a style by role."""
    # The header is YAML, which includes the strings of JSON.
    yield f"---\ntitle: {json_line(' | '.join(drawing.caption))}\n---"
    yield "flowchart TD"
    yield from (f"  {_box_text(box)}" for box in drawing.boxes)
    yield from (f"  {tail} --> {head}" for tail, head in drawing.arrows)
    yield from (f"  classDef {_css_class(role)} {style}" for role, (_, _, style) in _ROLE_STYLES.items())


def _box_text(box: Box) -> str:
    """Return the text of a box in a flowchart: its name, bold label, details, and role as the CSS class."""
    opening, closing, _ = _ROLE_STYLES[box.role]
    head = "<br/>".join(map(_escape, box.head))
    label = "<br/>".join((f"<b>{head}</b>", *map(_escape, box.details)))
    return f'{box.name}{opening}"{label}"{closing}:::{_css_class(box.role)}'


def _css_class(role: Role) -> str:
    """Return the name of the CSS class of a role."""
    return role.replace(" ", "_").replace("-", "_")


def _escape(text: str) -> str:
    """Return a text with all characters escaped that have a meaning in Mermaid, Markdown or HTML."""
    return _SPECIAL.sub(lambda match: f"#{ord(match[0])};", text)
