r"""A drawing in DOT, Graphviz' language.

Labels are plain and not HTML-like, which not every build of Graphviz understands. The class of a node names
its role and how many lines of its label are its head, for a style sheet to make them bold.
"""

from collections.abc import Iterator, Sequence
from textwrap import wrap

from foon_asp.report.drawing import Box, Drawing, Role

# Graphviz knows how wide this font is even where no font is installed, and few are wider: a text that is
# shown in another one still fits its box.
FONT = "DejaVu Sans"

_CAPTION_LINE = 90  # letters

# Objects are green and motions red, as everywhere in the field. For those who cannot tell the two apart,
# motions are dark and have corners, and objects are light and rounded.
_LOOKS = {
    Role.MOTION: 'style=filled, fillcolor="#c62828", color="#8e0000", fontcolor="#ffffff", fontsize=11',
    Role.KITCHEN: 'fillcolor="#e3f4e1", color="#7cb97c", fontsize=9',
    Role.OBJECT: 'fillcolor="#93d293", color="#2e7d32"',
    Role.BY_PRODUCT: 'fillcolor="#ffffff", color="#7cb97c", style="filled,rounded,dashed", fontsize=9',
    Role.GOAL: 'fillcolor="#ffd54f", color="#a67c00", penwidth=2, peripheries=2, fontsize=12',
}


def dot_text(drawing: Drawing) -> str:
    """Give a drawing as DOT, from top to bottom."""
    return "\n".join(_lines(drawing)) + "\n"


def _lines(drawing: Drawing) -> Iterator[str]:
    yield "digraph foon {"
    caption = [line for text in drawing.caption for line in wrap(text, _CAPTION_LINE)]
    yield f'  graph [fontname="{FONT}", fontsize=12, labelloc=t, nodesep=0.12, ranksep=0.3, pad=0.15,'
    yield f"    label={_quoted(caption)}]"
    yield f'  node [fontname="{FONT}", fontsize=10, shape=box, style="filled,rounded",'
    yield '    margin="0.13,0.05", width=0, height=0]'
    yield '  edge [color="#616161", arrowsize=0.6]'
    yield from _legend(drawing)
    yield from (_node(box) for box in drawing.boxes)
    yield from (f"  {tail} -> {head}" for tail, head in drawing.arrows)
    yield "}"


def _legend(drawing: Drawing) -> Iterator[str]:
    """Frame a sample of every role that there is."""
    roles = {box.role for box in drawing.boxes}
    samples = [
        Box(f"legend{number}", role, (str(role),)) for number, role in enumerate(Role) if role in roles
    ]
    yield '  subgraph cluster_legend {\n    label="" color="#bdbdbd"'
    yield from (f"  {_node(sample)}" for sample in samples)
    yield "  }"


def _node(box: Box) -> str:
    look = f'class="{box.role.replace(" ", "-")} head{len(box.head)}", {_LOOKS[box.role]}'
    return f"  {box.name} [label={_quoted((*box.head, *box.details))}, {look}]"


def _quoted(lines: Sequence[str]) -> str:
    r"""Quote lines so that Graphviz shows them as they are: neither ``\N`` nor ``&amp;`` means anything."""
    plain = (line.replace("\\", r"\\").replace('"', r"\"").replace("&", "&amp;") for line in lines)
    return '"' + r"\n".join(plain) + '"'
