"""Drawings, independent of any format: boxes with a role and text, and arrows between them."""

import re
from collections.abc import Collection, Iterable, Mapping, Sequence
from enum import StrEnum
from textwrap import wrap
from typing import NamedTuple

from foon_asp.escapes import UNSAFE
from foon_asp.network import FunctionalUnit, ObjectNode

_NONCHARACTERS = re.compile("[\ufffe\uffff]")


class Role(StrEnum):
    """The role of a box; its value is the name of the role in a legend."""

    MOTION = "motion"
    KITCHEN = "kitchen item"
    OBJECT = "object"
    BY_PRODUCT = "by-product"
    GOAL = "goal"


class Box(NamedTuple):
    """A box of a drawing: a motion, or an object node.

    ``name``: identifies the box in arrows.
    ``label``: the motion, or the label of the object node.
    ``node``: the object node; ``None`` for a motion.
    ``unit``: for a motion in the graph of a network, the id of its unit; otherwise ``None``.
    """

    name: str
    role: Role
    label: str
    node: ObjectNode | None = None
    unit: int | None = None

    @property
    def head(self) -> tuple[str, ...]:
        """The lines of the label, wrapped."""
        return _wrapped_lines(self.label, 20)  # letters; bold text is wider

    @property
    def details(self) -> tuple[str, ...]:
        """The wrapped lines below the label: states, relations and contents, or the id of the unit."""
        texts = [] if self.unit is None else [f"unit {self.unit}"]
        if self.node is not None:
            texts = [", ".join(sorted(self.node.states))] if self.node.states else []
            texts += map(str, sorted(self.node.relations))
            texts += (f"{word} {{{', '.join(items)}}}" for word, items in self.node.contents)
        # with more letters in a line, drawings are wider, with fewer, higher
        return tuple(line for text in texts for line in _wrapped_lines(text, 22))


class Drawing(NamedTuple):
    """Boxes and arrows under a caption.

    ``caption``: one line or more.
    ``arrows``: pairs of names of boxes, from tail to head.
    ``graph``: true for the graph of a network, in which every object node is one box; false for a tree or
    plan.
    """

    caption: tuple[str, ...]
    boxes: tuple[Box, ...]
    arrows: tuple[tuple[str, str], ...]
    graph: bool = False

    @property
    def unit_count(self) -> int:
        """The number of functional units; each has one box, which is its motion."""
        return sum(box.role is Role.MOTION for box in self.boxes)


def draw_tree(
    units: Sequence[FunctionalUnit],
    kitchen: Collection[ObjectNode],
    goals: Iterable[ObjectNode],
    caption: Iterable[str],
    add_effects: Sequence[Iterable[ObjectNode]] | None = None,
) -> Drawing:
    """Return the drawing of a task tree; arrows lead from the achiever of a node to its consumers.

    Units are numbered in the order of ``units``, from 1. ``add_effects``: for each unit, the outputs that it
    makes under the container rule; ``None`` if each makes all its outputs.

    A kitchen item is a separate box at every use, since one shared box of the knife would connect everything.
    A by-product is also a separate box.

    An output is a by-product
    - if it is neither a goal nor an input of a unit,
    - if the kitchen has it or an earlier step has made it, or
    - if the container rule does not count it as made.
    """
    achievers: dict[ObjectNode, int] = {}
    if add_effects is None:
        add_effects = [unit.outputs for unit in units]
    for number, added in enumerate(add_effects):
        for node in added:
            achievers.setdefault(node, number)

    def sources_of(nodes: Iterable[ObjectNode]) -> dict[ObjectNode, int | None]:
        """Return, by node, the position of the unit that first makes it.

        It is ``None`` for a kitchen item, and -1 if no unit makes the node.
        """
        return {node: None if node in kitchen else achievers.get(node, -1) for node in nodes}

    return draw_plan(units, [sources_of(unit.inputs) for unit in units], sources_of(goals), kitchen, caption)


def draw_plan(
    units: Sequence[FunctionalUnit],
    sources: Sequence[Mapping[ObjectNode, int | None]],
    goal_sources: Mapping[ObjectNode, int | None],
    kitchen: Collection[ObjectNode],
    caption: Iterable[str],
) -> Drawing:
    """Return the drawing of a plan in which items are used up; units are numbered from 1.

    A node may have several copies. The source of a copy is the position of the step that made it, from 0. The
    source is ``None`` for the kitchen, and -1 if nothing makes the node.

    ``sources``: for each unit, the sources of its inputs; an input that is left out counts as ``None``.
    ``goal_sources``: the sources of the goals.

    A copy is one box if a step makes it, and a later step or a goal takes it. A node that nothing makes is
    also one box. All other copies are separate boxes. Each goal has a box, also if no unit takes or makes it.
    """
    canvas = _Canvas(kitchen, goal_sources.keys())
    consumed = {copy for step in (*sources, goal_sources) for copy in step.items()}
    for number, (unit, copies) in enumerate(zip(units, sources, strict=True)):
        motion = canvas.add_box(Role.MOTION, f"{number + 1}. {unit.motion}")
        for node in unit.inputs:
            achiever, role = copies.get(node), Role.KITCHEN if node in kitchen else Role.OBJECT
            input_box = (
                canvas.add_box(role, node.label, node)
                if achiever is None
                else canvas.shared_box(node, achiever)
            )
            canvas.arrows.append((input_box, motion))
        for node in unit.outputs:
            if (node, number) in consumed:
                canvas.arrows.append((motion, canvas.shared_box(node, number)))
            else:
                canvas.arrows.append((motion, canvas.add_box(Role.BY_PRODUCT, node.label, node)))
    for goal, achiever in goal_sources.items():
        canvas.shared_box(goal, achiever)
    return canvas.finished_drawing(caption)


def draw_network(
    units: Iterable[tuple[int, FunctionalUnit]],
    kitchen: Collection[ObjectNode],
    goals: Collection[ObjectNode],
    caption: Iterable[str],
) -> Drawing:
    """Return the drawing of units as a bipartite graph, in which every object node is one box.

    ``units`` are pairs of an id, which the box of the motion shows, and a unit. Nodes of no unit have no box.
    """
    canvas = _Canvas(kitchen, goals)
    for unit_id, unit in units:
        motion = canvas.add_box(Role.MOTION, unit.motion, unit=unit_id)
        canvas.arrows += [(canvas.shared_box(node), motion) for node in unit.inputs]
        canvas.arrows += [(motion, canvas.shared_box(node)) for node in unit.outputs]
    return canvas.finished_drawing(caption)._replace(graph=True)


class _Canvas:
    """A drawing in construction, which collects boxes and arrows and numbers the boxes.

    The ``kitchen`` and the ``goals`` determine the roles of shared boxes.
    """

    def __init__(self, kitchen: Collection[ObjectNode], goals: Collection[ObjectNode]) -> None:
        self._kitchen = kitchen
        self._goals = goals
        self._boxes: list[Box] = []
        self._names: dict[tuple[ObjectNode, int | None], str] = {}
        self.arrows: list[tuple[str, str]] = []

    def add_box(self, role: Role, label: str, node: ObjectNode | None = None, unit: int | None = None) -> str:
        """Add a box, and return its new name, such as ``m0`` for a motion and ``o1`` for a node."""
        name = f"{'m' if node is None else 'o'}{len(self._boxes)}"
        self._boxes.append(Box(name, role, label, node, unit))
        return name

    def shared_box(self, node: ObjectNode, achiever: int | None = None) -> str:
        """Return the name of the one box of a node, which is added at the first call.

        The role of the box is goal, kitchen item or object, the first that fits. With ``achiever``, the box
        is for the copy that the step at this position makes.
        """
        if (node, achiever) not in self._names:
            role = Role.OBJECT
            if node in self._goals:
                role = Role.GOAL
            elif node in self._kitchen:
                role = Role.KITCHEN
            self._names[node, achiever] = self.add_box(role, node.label, node)
        return self._names[node, achiever]

    def finished_drawing(self, caption: Iterable[str]) -> Drawing:
        """Return the drawing with all boxes and arrows that were added.

        Characters of the caption that cannot be printed are replaced; see :func:`replace_unprintable`.
        """
        return Drawing(tuple(map(replace_unprintable, caption)), tuple(self._boxes), tuple(self.arrows))


def _wrapped_lines(text: str, width: int) -> tuple[str, ...]:
    """Return the lines of a text wrapped at ``width`` letters; an empty text is one empty line."""
    return tuple(wrap(replace_unprintable(text), width)) or ("",)


def replace_unprintable(text: str) -> str:
    """Return a text with U+FFFD for every character that is invisible, misleading or forbidden in XML."""
    return _NONCHARACTERS.sub("\ufffd", UNSAFE.sub("\ufffd", text))
