"""A drawing in DOT, the language of Graphviz."""

from foon_asp.report.drawing import Drawing, Role, Shape

# Objects are green and motions red, as the field draws them; kitchen items are paler, goals framed in gold.
_STYLES = {
    Role.OBJECT: 'shape=box, fillcolor="#8fce8f", color="#2e7d32"',
    Role.KITCHEN: 'shape=box, fillcolor="#e3f4e3", color="#7cb37c"',
    Role.GOAL: 'shape=box, fillcolor="#8fce8f", color="#c99700", penwidth=4',
    Role.MOTION: 'shape=ellipse, fillcolor="#e57373", color="#b71c1c"',
}

_LETTER = 0.085  # inches for a letter of 10 points

_HEAD = """\
digraph FOON {
  graph [rankdir=TB, nodesep=0.2, ranksep=0.35, bgcolor="white"];
  node [style="filled", fontname="DejaVu Sans,Verdana,Arial,sans-serif", fontsize=10, margin="0.08,0.05"];
  edge [color="#555555", arrowsize=0.7];
"""


def write_dot(drawing: Drawing) -> str:
    """Give the drawing as a DOT graph."""
    lines = [
        f'  {shape.name} [{_STYLES[shape.role]}, width={_width(shape):.2f}, label="{_label(shape)}"];'
        for shape in drawing.shapes
    ]
    for arrow in drawing.arrows:
        style = " [style=dashed, constraint=false]" if arrow.again else ""
        lines.append(f"  {arrow.tail} -> {arrow.head}{style};")
    return _HEAD + "\n".join(lines) + "\n}\n"


def _width(shape: Shape) -> float:
    """Give the least width in inches: layouts that do not know the font take the text for narrower."""
    return 0.2 + _LETTER * max(map(len, (*shape.title, *shape.notes)))


def _label(shape: Shape) -> str:
    return "\\n".join(map(_text, (*shape.title, *shape.notes)))


def _text(line: str) -> str:
    """Escape what a DOT string takes for itself; control characters have no place in a picture."""
    plain = "".join(c if c.isprintable() else " " for c in line)
    return plain.replace("\\", "\\\\").replace('"', '\\"')
