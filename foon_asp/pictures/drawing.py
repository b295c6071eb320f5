"""Drawings, independent of the format: boxes with a role and text, and arrows between them."""

import re
from collections.abc import Collection, Iterable, Mapping, Sequence
from enum import StrEnum
from textwrap import wrap
from typing import NamedTuple

from foon_asp.escapes import UNSAFE
from foon_asp.network import FunctionalUnit, ObjectNode

_NONCHARACTERS = re.compile("[\ufffe\uffff]")


class Role(StrEnum):
    """The role of a box, in the words of a legend."""

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
        return _lines(self.label, 20)  # letters; bold text is wider

    @property
    def details(self) -> tuple[str, ...]:
        """The lines below the label: states, relations and contents, or the id of the unit."""
        texts = [] if self.unit is None else [f"unit {self.unit}"]
        if self.node is not None:
            texts = [", ".join(sorted(self.node.states))] if self.node.states else []
            texts += map(str, sorted(self.node.relations))
            texts += (f"{word} {{{', '.join(items)}}}" for word, items in self.node.contents)
        # with more letters in a line, drawings are wider, with fewer, higher
        return tuple(line for text in texts for line in _lines(text, 22))


class Drawing(NamedTuple):
    """Boxes, and arrows as pairs of names of boxes, under a caption of one line or more.

    ``graph`` distinguishes the graph of a network, in which every object node is one box, from a plan.
    """

    caption: tuple[str, ...]
    boxes: tuple[Box, ...]
    arrows: tuple[tuple[str, str], ...]
    graph: bool = False

    @property
    def units(self) -> int:
        """The number of functional units; each has one box, its motion."""
        return sum(box.role is Role.MOTION for box in self.boxes)


def draw_tree(
    units: Sequence[FunctionalUnit],
    kitchen: Collection[ObjectNode],
    goals: Iterable[ObjectNode],
    caption: Iterable[str],
    add_effects: Sequence[Iterable[ObjectNode]] | None = None,
) -> Drawing:
    """Return the drawing of a task tree, in which arrows lead from the achiever of a node to its consumers.

    Units are numbered in the order of ``units``. ``add_effects`` are the outputs that each unit makes under
    the container rule; ``None`` stands for all outputs.

    A kitchen item is a separate box at every use, since one shared box of the knife would connect everything.
    A by-product is a separate box, too. An output is a by-product if it is neither a goal nor an input of a
    unit, if the kitchen has it, if an earlier step has made it, or if the container rule does not count it as
    made.
    """
    achievers: dict[ObjectNode, int] = {}
    if add_effects is None:
        add_effects = [unit.outputs for unit in units]
    for number, added in enumerate(add_effects):
        for node in added:
            achievers.setdefault(node, number)

    def sources_of(nodes: Iterable[ObjectNode]) -> dict[ObjectNode, int | None]:
        return {node: None if node in kitchen else achievers.get(node, -1) for node in nodes}

    return draw_plan(units, [sources_of(unit.inputs) for unit in units], sources_of(goals), kitchen, caption)


def draw_plan(
    units: Sequence[FunctionalUnit],
    sources: Sequence[Mapping[ObjectNode, int | None]],
    goal_sources: Mapping[ObjectNode, int | None],
    kitchen: Collection[ObjectNode],
    caption: Iterable[str],
) -> Drawing:
    """Return the drawing of a plan in which items are used up: a copy that a later step takes is one box.

    A copy is identified by its node and the position of the step that made it, from 0; the position is
    ``None`` for the kitchen. ``sources`` are these positions for the inputs of each unit, and
    ``goal_sources`` for the goals. Other copies have boxes of their own.
    """
    canvas = _Canvas(kitchen, goal_sources.keys())
    consumed = {copy for step in (*sources, goal_sources) for copy in step.items()}
    for number, (unit, copies) in enumerate(zip(units, sources, strict=True)):
        motion = canvas.add(Role.MOTION, f"{number + 1}. {unit.motion}")
        for node in unit.inputs:
            achiever, role = copies.get(node), Role.KITCHEN if node in kitchen else Role.OBJECT
            copy = canvas.add(role, node.label, node) if achiever is None else canvas.shared(node, achiever)
            canvas.arrows.append((copy, motion))
        for node in unit.outputs:
            if (node, number) in consumed:
                canvas.arrows.append((motion, canvas.shared(node, number)))
            else:
                canvas.arrows.append((motion, canvas.add(Role.BY_PRODUCT, node.label, node)))
    for goal, achiever in goal_sources.items():
        canvas.shared(goal, achiever)
    return canvas.drawing(caption)


def draw_network(
    units: Iterable[tuple[int, FunctionalUnit]],
    kitchen: Collection[ObjectNode],
    goals: Collection[ObjectNode],
    caption: Iterable[str],
) -> Drawing:
    """Return the drawing of units, with their ids, as a bipartite graph: every object node is one box."""
    canvas = _Canvas(kitchen, goals)
    for unit_id, unit in units:
        motion = canvas.add(Role.MOTION, unit.motion, unit=unit_id)
        canvas.arrows += [(canvas.shared(node), motion) for node in unit.inputs]
        canvas.arrows += [(motion, canvas.shared(node)) for node in unit.outputs]
    return canvas.drawing(caption)._replace(graph=True)


class _Canvas:
    """A drawing in construction: it collects boxes and arrows, and numbers the boxes."""

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

    def shared(self, node: ObjectNode, achiever: int | None = None) -> str:
        """Return the name of the one box of a node, or of its copy that the step ``achiever`` makes."""
        if (node, achiever) not in self._names:
            role = Role.OBJECT
            if node in self._goals:
                role = Role.GOAL
            elif node in self._kitchen:
                role = Role.KITCHEN
            self._names[node, achiever] = self.add(role, node.label, node)
        return self._names[node, achiever]

    def drawing(self, caption: Iterable[str]) -> Drawing:
        """Return the finished drawing."""
        return Drawing(tuple(map(printable, caption)), tuple(self._boxes), tuple(self.arrows))


def _lines(text: str, width: int) -> tuple[str, ...]:
    """Return a text wrapped into lines; an empty text is one empty line."""
    return tuple(wrap(printable(text), width)) or ("",)


def printable(text: str) -> str:
    """Return a text in which characters that are invisible, misleading or forbidden in XML are replaced."""
    return _NONCHARACTERS.sub("\ufffd", UNSAFE.sub("\ufffd", text))
