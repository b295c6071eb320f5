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
    """A node of the picture: a motion, with the id of its ``unit`` in a graph, or an object ``node``."""

    name: str
    role: Role
    label: str
    node: ObjectNode | None = None
    unit: int | None = None

    @property
    def head(self) -> tuple[str, ...]:
        """The lines of the label."""
        return _lines(self.label, _HEAD_LINE)

    @property
    def details(self) -> tuple[str, ...]:
        """The lines below the label: states, relations and contents, or the id of the unit."""
        texts = [] if self.unit is None else [f"unit {self.unit}"]
        if self.node is not None:
            texts = [", ".join(sorted(self.node.states))] if self.node.states else []
            texts += map(str, sorted(self.node.relations))
            texts += (f"{word} {{{', '.join(items)}}}" for word, items in self.node.contents)
        return tuple(line for text in texts for line in _lines(text, _LINE))


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
        """The number of functional units, each of which is one motion."""
        return sum(box.role is Role.MOTION for box in self.boxes)


def draw_tree(
    units: Sequence[FunctionalUnit],
    kitchen: Collection[ObjectNode],
    goals: Iterable[ObjectNode],
    caption: Iterable[str],
    gives: Sequence[Iterable[ObjectNode]] | None = None,
) -> Drawing:
    """Draw the units of a task tree, numbered in the order given, so that arrows lead from step to step.

    ``gives`` are the outputs that each of them makes under the container rule: all, if ``None``.

    What comes from the kitchen is a box of its own at every use, and so is every by-product: an output
    that is no goal, that no unit takes, that the kitchen has, that an earlier step has made, or that the step
    took as given and did not make. One shared
    box for the knife, or for the tap that runs all the time, would tie everything to everything.
    """
    achievers: dict[ObjectNode, int] = {}
    for number, outputs in enumerate([unit.outputs for unit in units] if gives is None else gives):
        for node in outputs:
            achievers.setdefault(node, number)

    def sources(nodes: Iterable[ObjectNode]) -> dict[ObjectNode, int | None]:
        return {node: None if node in kitchen else achievers.get(node, -1) for node in nodes}

    return draw_plan(units, [sources(unit.inputs) for unit in units], sources(goals), kitchen, caption)


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
        motion = canvas.add(Role.MOTION, f"{number + 1}. {unit.motion}")
        for node in unit.inputs:
            made, role = copies.get(node), Role.KITCHEN if node in kitchen else Role.OBJECT
            copy = canvas.add(role, node.label, node) if made is None else canvas.shared(node, made)
            canvas.arrows.append((copy, motion))
        for node in unit.outputs:
            if (node, number) in wanted:
                canvas.arrows.append((motion, canvas.shared(node, number)))
            else:
                canvas.arrows.append((motion, canvas.add(Role.BY_PRODUCT, node.label, node)))
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
        motion = canvas.add(Role.MOTION, unit.motion, unit=unit_id)
        canvas.arrows += [(canvas.shared(node), motion) for node in unit.inputs]
        canvas.arrows += [(motion, canvas.shared(node)) for node in unit.outputs]
    return canvas.drawing(caption)._replace(graph=True)


class _Canvas:
    """Collects boxes and arrows, and names the boxes in the order in which they come."""

    def __init__(self, kitchen: Collection[ObjectNode], goals: Collection[ObjectNode]) -> None:
        self._kitchen = kitchen
        self._goals = goals
        self._boxes: list[Box] = []
        self._names: dict[tuple[ObjectNode, int | None], str] = {}
        self.arrows: list[tuple[str, str]] = []

    def add(self, role: Role, label: str, node: ObjectNode | None = None, unit: int | None = None) -> str:
        """Add a box, and return its name."""
        name = f"{'m' if node is None else 'o'}{len(self._boxes)}"
        self._boxes.append(Box(name, role, label, node, unit))
        return name

    def shared(self, node: ObjectNode, made: int | None = None) -> str:
        """Return the name of the one box of a node, or of the copy of it that a step made."""
        if (node, made) not in self._names:
            role = Role.OBJECT
            if node in self._goals:
                role = Role.GOAL
            elif node in self._kitchen:
                role = Role.KITCHEN
            self._names[node, made] = self.add(role, node.label, node)
        return self._names[node, made]

    def drawing(self, caption: Iterable[str]) -> Drawing:
        """Return what was collected."""
        return Drawing(tuple(map(printable, caption)), tuple(self._boxes), tuple(self.arrows))


def _lines(text: str, width: int) -> tuple[str, ...]:
    """Wrap a text; an empty text is an empty line."""
    return tuple(wrap(printable(text), width)) or ("",)


def printable(text: str) -> str:
    """Return a text without what XML, and with it SVG, cannot hold, or what is not seen as what it is."""
    return _NO_LETTERS.sub("\ufffd", UNSAFE.sub("\ufffd", text))
