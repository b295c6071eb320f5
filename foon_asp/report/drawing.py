"""What a picture shows: shapes for object nodes and motions, arrows between them, whatever the format."""

from collections.abc import Sequence
from enum import StrEnum
from textwrap import wrap
from typing import NamedTuple

from foon_asp.network import Network, ObjectNode

_WIDTH = 22  # of a line of text in a shape, in letters


class Role(StrEnum):
    """What a shape stands for; each has its color."""

    OBJECT = "object"
    KITCHEN = "kitchen"
    GOAL = "goal"
    MOTION = "motion"


class Shape(NamedTuple):
    """A box: ``title`` and ``notes`` are lines of text, wrapped; ``name`` is unique in the drawing."""

    name: str
    role: Role
    title: tuple[str, ...]
    notes: tuple[str, ...] = ()


class Arrow(NamedTuple):
    """From shape to shape, by name; ``again`` where a unit gives back one of its inputs."""

    tail: str
    head: str
    again: bool = False


class Drawing(NamedTuple):
    """Shapes and arrows, in an order that does not depend on anything but the question."""

    shapes: tuple[Shape, ...]
    arrows: tuple[Arrow, ...]

    @property
    def units(self) -> int:
        """Count the functional units drawn."""
        return sum(shape.role is Role.MOTION for shape in self.shapes)


def draw_units(
    network: Network,
    units: Sequence[int],
    kitchen: frozenset[int] = frozenset(),
    goals: Sequence[int] = (),
    numbered: bool = False,
) -> Drawing:
    """Draw units of a network, by id.

    A task tree is ``numbered``: its motions carry the number of their step. Kitchen items are drawn anew for
    every step that takes them, as leaves, and what a step gives back or makes once more is left out: both
    keep the branches of a large tree apart. Otherwise every object has one shape, and all arrows are there.
    """
    shapes: dict[str, Shape] = {}
    arrows: list[Arrow] = []
    made: set[int] = set()

    def shape(o: int, step: int) -> str:
        leaf = numbered and o in kitchen
        name = f"o{o}_{step}" if leaf else f"o{o}"
        role = Role.GOAL if o in goals else Role.KITCHEN if o in kitchen else Role.OBJECT
        shapes.setdefault(name, Shape(name, role, *_texts(network.objects[o])))
        return name

    for step, unit in enumerate(units, 1):
        motion = f"u{unit}"
        title = f"{step}. {network.motions[unit]}" if numbered else network.motions[unit]
        inputs = [shape(o, step) for o in network.inputs[unit]]
        shapes[motion] = Shape(motion, Role.MOTION, tuple(wrap(title, _WIDTH) or [""]))
        arrows += [Arrow(name, motion) for name in inputs]
        for o in network.outputs[unit]:
            if numbered and (o in made or o in kitchen):
                continue
            made.add(o)
            arrows.append(Arrow(motion, shape(o, step), o in network.inputs[unit]))
    return Drawing(tuple(shapes.values()), tuple(arrows))


def _texts(node: ObjectNode) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Give the wrapped label, and the wrapped lines of what else is known of a node."""
    notes = [*sorted(node.states), *map(str, sorted(node.relations))]
    notes += [f"{word} {{{', '.join(items)}}}" for word, items in node.contents]
    return (
        tuple(wrap(node.label, _WIDTH) or [""]),
        tuple(line for note in notes for line in wrap(note, _WIDTH)),
    )
