r"""A drawing in DOT, Graphviz' language.

Labels are plain text, since HTML-like labels are not in every build of Graphviz. The class of a node is its
role and the number of head lines in its label; a style sheet makes these lines bold.
"""

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from textwrap import wrap

from foon_asp.pictures.drawing import Box, Drawing, Role

# Graphviz knows the widths of this font even where no font is installed, and few fonts are wider: a text in
# another font still fits its box.
FONT = "DejaVu Sans"

BOXED_UNITS = 300
"""Units of a drawing with boxes, at most: more take minutes to lay out, and are too many to read."""

# Objects are green and motions red, as in the FOON literature. For readers with a color deficiency, motions
# are dark and have corners, and objects are light and rounded.
_ROLE_ATTRIBUTES = {
    Role.MOTION: 'style=filled, fillcolor="#c62828", color="#8e0000", fontcolor="#ffffff", fontsize=11',
    Role.KITCHEN: 'fillcolor="#e3f4e1", color="#7cb97c", fontsize=9',
    Role.OBJECT: 'fillcolor="#93d293", color="#2e7d32"',
    Role.BY_PRODUCT: 'fillcolor="#ffffff", color="#7cb97c", style="filled,rounded,dashed", fontsize=9',
    Role.GOAL: 'fillcolor="#ffd54f", color="#a67c00", penwidth=2, peripheries=2, fontsize=12',
}
_BOX_DEFAULTS = f"""\
  graph [fontname="{FONT}", fontsize=12, labelloc=t, nodesep=0.12, ranksep=0.3, pad=0.15]
  node [fontname="{FONT}", fontsize=10, shape=box, style="filled,rounded",
    margin="0.13,0.05", width=0, height=0]
  edge [color="#616161", arrowsize=0.6]"""
_POINT_DEFAULTS = f"""\
  graph [fontname="{FONT}", fontsize=40, labelloc=t, pad=0.5, outputorder=edgesfirst,
    layout=sfdp, start=1, K=4, repulsiveforce=0.5, overlap=true]
  node [fontname="{FONT}", label="", shape=circle, style=filled,
    fixedsize=true, width=0.1, height=0.1]
  edge [color="#455a6438", arrowhead=none]"""


def dot_text(drawing: Drawing) -> str:
    """Return a drawing in DOT, from top to bottom, with a legend of its roles.

    For a network of more than :data:`BOXED_UNITS` units, return :func:`graph_text`, which has no legend.
    """
    if drawing.graph and drawing.unit_count > BOXED_UNITS:
        return graph_text(drawing)
    nodes = (_node_line(box, (*box.head, *box.details), _ROLE_ATTRIBUTES[box.role]) for box in drawing.boxes)
    return _digraph_text(drawing, _BOX_DEFAULTS, [*_legend_lines(drawing), *nodes])


def graph_text(drawing: Drawing, max_names: int = 24) -> str:
    """Return the drawing of a network in DOT, with motions as squares and object nodes as circles.

    It is for a force-directed layout. The full text of a node is its tooltip. Only the ``max_names`` object
    nodes of the highest degree show their names, since more names would overlap.
    """
    degrees = Counter(name for arrow in drawing.arrows for name in arrow)
    objects = [box for box in drawing.boxes if box.node is not None]
    named_boxes = {box.name for box in sorted(objects, key=lambda box: -degrees[box.name])[:max_names]}
    motions = [box.name for box in drawing.boxes if box.node is None]
    lines = [f"  {' -> '.join(motions)} [style=invis]"]  # neighbours in a file are close to each other
    for box in sorted(drawing.boxes, key=lambda box: box.name in named_boxes):  # names are painted last
        label = box.head if box.name in named_boxes else ()
        colors = _ROLE_ATTRIBUTES[box.role].partition(", penwidth")[0]
        attributes = f"{colors}, fontsize=24, fontcolor=black, style=filled"
        shape = "circle" if box.node else "square"
        tooltip = _quoted_lines(["; ".join((*box.head, *box.details))])
        lines.append(_node_line(box, label, f"{attributes}, shape={shape}, tooltip={tooltip}"))
    return _digraph_text(drawing, _POINT_DEFAULTS, lines)


def _digraph_text(drawing: Drawing, defaults: str, nodes: Iterable[str]) -> str:
    """Return a graph in DOT: the caption of a drawing, wrapped, then ``nodes``, then its arrows.

    ``defaults`` and ``nodes`` are lines of DOT.
    """
    caption = _quoted_lines([line for text in drawing.caption for line in wrap(text, width=90)])
    arrows = (f"  {tail} -> {head}" for tail, head in drawing.arrows)
    return "\n".join(("digraph foon {", defaults, f"  label={caption}", *nodes, *arrows, "}\n"))


def _legend_lines(drawing: Drawing) -> Iterator[str]:
    """Yield the lines of a legend: a frame with a sample of every role in the drawing."""
    roles = {box.role for box in drawing.boxes}
    yield '  subgraph cluster_legend {\n    label="" color="#bdbdbd"'
    for number, role in enumerate(Role):
        if role in roles:
            yield "  " + _node_line(Box(f"legend{number}", role, role), (role,), _ROLE_ATTRIBUTES[role])
    yield "  }"


def _node_line(box: Box, label: Sequence[str], attributes: str) -> str:
    """Return the line of a box in DOT; its class is its role and the number of its head lines.

    ``label`` are the lines of its label.
    """
    class_ = f"{box.role.replace(' ', '-')} head{len(box.head)}"
    return f'  {box.name} [label={_quoted_lines(label)}, class="{class_}", {attributes}]'


def _quoted_lines(lines: Sequence[str]) -> str:
    """Return a quoted string of DOT that Graphviz shows as these lines, one below the other."""
    plain = (line.replace("\\", r"\\").replace('"', r"\"").replace("&", "&amp;") for line in lines)
    return '"' + r"\n".join(plain) + '"'
