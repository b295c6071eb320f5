"""A large network as one still picture: squares, circles and lines, in the form of the published figures."""

from collections import Counter
from collections.abc import Iterator
from html import escape

from foon_asp.report.dot import FONT
from foon_asp.report.drawing import Box, Drawing, Role
from foon_asp.report.spread import spread

_WIDTH = 1400.0  # points
_MARGIN = 30.0
_CAPTION = 24.0
_NAMED = 24  # object nodes whose names are written: those that most arrows meet
_LOOKS = {
    Role.MOTION: ("#c62828", "#8e0000"),
    Role.KITCHEN: ("#d5efd0", "#5f9a5f"),
    Role.OBJECT: ("#4caf50", "#1b5e20"),
    Role.BY_PRODUCT: ("#ffffff", "#5f9a5f"),
    Role.GOAL: ("#ffd54f", "#8a6800"),
}


def network_picture(drawing: Drawing) -> bytes:
    """Draw as SVG; the whole name of a node shows where the mouse rests on it."""
    return ("\n".join(_lines(drawing)) + "\n").encode()


def _lines(drawing: Drawing) -> Iterator[str]:
    numbers = {box.name: number for number, box in enumerate(drawing.boxes)}
    arrows = [(numbers[tail], numbers[head]) for tail, head in drawing.arrows]
    motions = [number for number, box in enumerate(drawing.boxes) if box.role is Role.MOTION]
    spots = spread(len(drawing.boxes), arrows, motions)
    right, bottom = (max(spot[axis] for spot in spots) or 1 for axis in (0, 1))
    scale = (_WIDTH - 2 * _MARGIN) / right
    top = _MARGIN + _CAPTION * (len(drawing.caption) + 1)
    height = top + bottom * scale + _MARGIN
    places = [(_MARGIN + x * scale, top + y * scale) for x, y in spots]
    met = Counter(number for arrow in arrows for number in arrow)
    yield (
        f'<svg width="{_WIDTH:.0f}pt" height="{height:.0f}pt" viewBox="0 0 {_WIDTH:.0f} {height:.0f}" '
        'xmlns="http://www.w3.org/2000/svg">'
    )
    yield f'<style>text {{ font-family: "{FONT}", Verdana, Arial, sans-serif; font-size: 12px }}</style>'
    yield f'<rect width="{_WIDTH:.0f}" height="{height:.0f}" fill="#ffffff"/>'
    for number, line in enumerate(drawing.caption, 1):
        yield f'<text x="{_MARGIN:.0f}" y="{_CAPTION * number + 6:.0f}">{escape(line)}</text>'
    yield from _legend(drawing)
    lines = (f"M{_at(*places[tail])}L{_at(*places[head])}" for tail, head in arrows)
    yield f'<path d="{"".join(lines)}" fill="none" stroke="#455a64" stroke-opacity="0.22" stroke-width=".7"/>'
    for number, (box, place) in enumerate(zip(drawing.boxes, places, strict=True)):
        text = "; ".join((" ".join(box.head), *box.details))
        yield f"{_shape(box, *place, met[number])}<title>{escape(text)}</title></{_tag(box)}>"
    objects = (number for number, box in enumerate(drawing.boxes) if box.role is not Role.MOTION)
    for number in sorted(objects, key=lambda each: (-met[each], each))[:_NAMED]:
        x, y = places[number]
        name = escape(" ".join(drawing.boxes[number].head))
        yield (
            f'<text x="{x:.1f}" y="{y - 8:.1f}" text-anchor="middle" stroke="#ffffff" stroke-width="3" '
            f'paint-order="stroke">{name}</text>'
        )
    yield "</svg>"


def _legend(drawing: Drawing) -> Iterator[str]:
    roles = {box.role for box in drawing.boxes}
    x, y = _MARGIN + 5, _CAPTION * (len(drawing.caption) + 1) + 2
    for role in Role:
        if role in roles:
            sample = Box("", role, (str(role),))
            yield f"{_shape(sample, x, y, 30)}</{_tag(sample)}>"
            yield f'<text x="{x + 12:.0f}" y="{y + 4:.0f}">{role}</text>'
            x += 120


def _shape(box: Box, x: float, y: float, met: int) -> str:
    fill, line = _LOOKS[box.role]
    look = f'fill="{fill}" stroke="{line}" stroke-width="0.6" class="{box.role.replace(" ", "-")}"'
    if box.role is Role.MOTION:
        return f'<rect x="{x - 2.6:.1f}" y="{y - 2.6:.1f}" width="5.2" height="5.2" {look}>'
    return f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{3 + min(6, met / 40):.1f}" {look}>'


def _tag(box: Box) -> str:
    return "rect" if box.role is Role.MOTION else "circle"


def _at(x: float, y: float) -> str:
    return f"{x:.1f},{y:.1f}"
