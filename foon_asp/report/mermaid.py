"""A drawing in Mermaid, which many Markdown viewers show as a picture."""

from foon_asp.report.drawing import Drawing, Role, Shape

_CLASSES = {
    Role.OBJECT: "fill:#8fce8f,stroke:#2e7d32,color:#000",
    Role.KITCHEN: "fill:#e3f4e3,stroke:#7cb37c,color:#000",
    Role.GOAL: "fill:#8fce8f,stroke:#c99700,stroke-width:4px,color:#000",
    Role.MOTION: "fill:#e57373,stroke:#b71c1c,color:#000",
}

_ARROWS = {False: "-->", True: "-.->"}


def write_mermaid(drawing: Drawing) -> str:
    """Give the drawing as a Mermaid flowchart."""
    lines = ["flowchart TB"]
    for shape in drawing.shapes:
        opening, closing = ("([", "])") if shape.role is Role.MOTION else ("[", "]")
        lines.append(f'  {shape.name}{opening}"{_label(shape)}"{closing}:::{shape.role}')
    lines += [f"  {arrow.tail} {_ARROWS[arrow.again]} {arrow.head}" for arrow in drawing.arrows]
    lines += [f"  classDef {role} {style}" for role, style in _CLASSES.items()]
    return "\n".join(lines) + "\n"


def _label(shape: Shape) -> str:
    title = "<br/>".join(_text(line) for line in shape.title)
    return "<br/>".join([f"<b>{title}</b>", *map(_text, shape.notes)])


def _text(line: str) -> str:
    """Write all but letters, digits, spaces and commas as entities, which cannot be Mermaid's own syntax."""
    return "".join(c if c.isalnum() or c in " ," else f"#{ord(c)};" for c in line)
