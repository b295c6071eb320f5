"""What a picture shows: boxes with a role and text, and arrows between them, whatever the format."""

import re
from collections.abc import Collection, Iterable, Mapping, Sequence
from enum import StrEnum
from textwrap import wrap
from typing import NamedTuple

from foon_asp.escapes import UNSAFE
from foon_asp.network import FunctionalUnit, ObjectNode

_LINE = 22  # letters in a line of a box
_HEAD_LINE = 20  # letters in a line of bold text, which is wider

_NO_LETTERS = re.compile("[\ufffe\uffff]")


class Role(StrEnum):
    """What a box stands for, in the words of a legend."""

    MOTION = "motion"
    KITCHEN = "kitchen item"
    OBJECT = "object"
    BY_PRODUCT = "by-product"
    GOAL = "goal"


class Box(NamedTuple):
    """A node of the picture: ``head`` are the lines of its name, ``details`` those below it."""

    name: str
    role: Role
    head: tuple[str, ...]
    details: tuple[str, ...] = ()


class Drawing(NamedTuple):
    """Boxes, and arrows between boxes by their names, under a caption of a line or more.

    ``graph`` says that it is the graph of a network, in which every object node is one box, and no plan.
    """

    caption: tuple[str, ...]
    boxes: tuple[Box, ...]
    arrows: tuple[tuple[str, str], ...]
    graph: bool = False

    @property
    def units(self) -> int:
        """Count the functional units, each of which is one motion."""
        return sum(box.role is Role.MOTION for box in self.boxes)


def draw_tree(
    units: Sequence[FunctionalUnit],
    kitchen: Collection[ObjectNode],
    goals: Collection[ObjectNode],
    caption: Iterable[str],
    gives: Sequence[Collection[ObjectNode]] | None = None,
) -> Drawing:
    """Draw the units of a task tree, numbered in the order given, so that arrows lead from step to step.

    ``gives`` are the outputs that each of them makes under the container rule: all, if ``None``.

    What comes from the kitchen is a box of its own at every use, and so is every by-product: an output
    that is no goal, that no unit takes, that the kitchen has, that an earlier step has made, or that the step
    took as given and did not make. One shared
    box for the knife, or for the tap that runs all the time, would tie everything to everything.
    """
    canvas = _Canvas(kitchen, goals)
    taken = {node for unit in units for node in unit.inputs if node not in kitchen}
    made: set[ObjectNode] = set()
    if gives is None:
        gives = [unit.outputs for unit in units]
    for step, (unit, given) in enumerate(zip(units, gives, strict=True), 1):
        motion = canvas.motion(f"{step}. {unit.motion}")
        for node in unit.inputs:
            at_hand = node in kitchen
            canvas.arrow(canvas.copy(node, Role.KITCHEN) if at_hand else canvas.shared(node), motion)
        for node in unit.outputs:
            first = node in given and node not in made and node not in kitchen
            first = first and (node in taken or node in goals)
            canvas.arrow(motion, canvas.shared(node) if first else canvas.copy(node, Role.BY_PRODUCT))
        made.update(given)
    for goal in goals:
        canvas.shared(goal)  # one that the kitchen holds needs no unit, and is part of the picture
    return canvas.drawing(caption)


def draw_plan(
    units: Sequence[FunctionalUnit],
    taken: Sequence[Mapping[ObjectNode, int | None]],
    kept: Mapping[ObjectNode, int | None],
    kitchen: Collection[ObjectNode],
    caption: Iterable[str],
) -> Drawing:
    """Draw the steps of a plan in which items are used up: a copy that a later step takes is a box.

    Copies are known by the step that made them, counted from 0, and ``None`` is the kitchen. ``taken`` says
    for each step where the copies of its inputs come from, and ``kept`` those of the goals. All others are
    boxes of their own at every use.
    """
    canvas = _Canvas(kitchen, kept)
    wanted = {copy for step in (*taken, kept) for copy in step.items()}
    for number, (unit, copies) in enumerate(zip(units, taken, strict=True)):
        motion = canvas.motion(f"{number + 1}. {unit.motion}")
        for node in unit.inputs:
            made, role = copies.get(node), Role.KITCHEN if node in kitchen else Role.OBJECT
            canvas.arrow(canvas.copy(node, role) if made is None else canvas.shared(node, made), motion)
        for node in unit.outputs:
            box = canvas.shared(node, number) if (node, number) in wanted else None
            canvas.arrow(motion, box or canvas.copy(node, Role.BY_PRODUCT))
    for goal, made in kept.items():
        canvas.shared(goal, made)
    return canvas.drawing(caption)


def draw_network(
    units: Iterable[tuple[int, FunctionalUnit]],
    kitchen: Collection[ObjectNode],
    goals: Collection[ObjectNode],
    caption: Iterable[str],
) -> Drawing:
    """Draw units with their ids as the graph they are: every object node is one box."""
    canvas = _Canvas(kitchen, goals)
    for unit_id, unit in units:
        motion = canvas.motion(unit.motion, f"unit {unit_id}")
        for node in unit.inputs:
            canvas.arrow(canvas.shared(node), motion)
        for node in unit.outputs:
            canvas.arrow(motion, canvas.shared(node))
    return canvas.drawing(caption)._replace(graph=True)


class _Canvas:
    """Collects boxes and arrows, and names the boxes in the order in which they come."""

    def __init__(self, kitchen: Collection[ObjectNode], goals: Collection[ObjectNode]) -> None:
        self._kitchen = kitchen
        self._goals = goals
        self._boxes: list[Box] = []
        self._arrows: list[tuple[str, str]] = []
        self._names: dict[tuple[ObjectNode, int | None], str] = {}

    def motion(self, *text: str) -> str:
        """Add a motion and give the name of its box."""
        return self._box("m", Role.MOTION, *text)

    def shared(self, node: ObjectNode, made: int | None = None) -> str:
        """Give the name of the one box of a node, or of the copy of it that a step made."""
        if (node, made) not in self._names:
            role = Role.OBJECT
            if node in self._goals:
                role = Role.GOAL
            elif node in self._kitchen:
                role = Role.KITCHEN
            self._names[node, made] = self.copy(node, role)
        return self._names[node, made]

    def copy(self, node: ObjectNode, role: Role) -> str:
        """Add a box for a node, also where it has one, and give the new one's name."""
        states = [", ".join(sorted(node.states))] if node.states else []
        contents = (f"{word} {{{', '.join(items)}}}" for word, items in node.contents)
        return self._box("o", role, node.label, *states, *map(str, sorted(node.relations)), *contents)

    def arrow(self, tail: str, head: str) -> None:
        """Add an arrow between two boxes."""
        self._arrows.append((tail, head))

    def drawing(self, caption: Iterable[str]) -> Drawing:
        """Give what was collected."""
        return Drawing(tuple(map(_printable, caption)), tuple(self._boxes), tuple(self._arrows))

    def _box(self, kind: str, role: Role, head: str, *details: str) -> str:
        name = f"{kind}{len(self._boxes)}"
        lines = tuple(line for text in details for line in _lines(text, _LINE))
        self._boxes.append(Box(name, role, _lines(head, _HEAD_LINE), lines))
        return name


def _lines(text: str, width: int) -> tuple[str, ...]:
    """Wrap a text; an empty text is an empty line."""
    return tuple(wrap(_printable(text), width)) or ("",)


def _printable(text: str) -> str:
    """Give a text without what XML, and with it SVG, cannot hold, or what is not seen as what it is."""
    return _NO_LETTERS.sub("\ufffd", UNSAFE.sub("\ufffd", text))
