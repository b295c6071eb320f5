"""What a console lays out by its width, and the same as text."""

import io

from rich.console import Console, RenderableType

Renderable = RenderableType
"""A table or the like, of ``rich``."""

_WIDTH = 200  # letters, more than our tables take


def plain_text(renderable: Renderable) -> str:
    """Give what a wide console without colours shows."""
    console = Console(file=io.StringIO(), width=_WIDTH, color_system=None)
    lines = "".join(segment.text for segment in console.render(renderable)).split("\n")
    return "\n".join(line.rstrip() for line in lines)
