"""Lint rules about places: objects in containers that do not contain them, or that are not in the unit."""

from collections.abc import Collection, Iterator

from foon_asp.linting.context import Context, Side
from foon_asp.linting.habits import Habits, content_names, words_in
from foon_asp.linting.rule import WARNING, rule
from foon_asp.network import ObjectNode
from foon_asp.text.diagnostics import Diagnostic

_PLACES = {"in", "on"}
FaultyNodes = Iterator[tuple[ObjectNode, str]]
"""The faulty nodes of a side of a unit, each with the message."""


@rule("unheld", WARNING, "an object in something that contains other things, and not it")
def find_unheld_objects(context: Context) -> Iterator[Diagnostic]:
    """The object is in a container, but is not among the contents of the container on this side of the unit.

    If the object is in another container of the same name, that container is missing on this side.
    """
    for side in context.sides:
        for node, message in unheld_nodes(side, context.habits):
            yield context.finding_at_node(context.files.copies[side.unit][0], side.number, node, message)


def unheld_nodes(side: Side, habits: Habits) -> FaultyNodes:
    """Yield each food that is in a container whose contents do not list it, with the message.

    Containers are skipped
    - that have several such foods,
    - whose label is not unique on this side,
    - that are ingredients themselves, or
    - that hold on this side a listed content which has contents itself.

    Foods are skipped
    - that another node contains,
    - that have contents of their own, or
    - that share a word with the contents.
    """
    for holder in side.nodes:
        contents = content_names(holder)
        if not contents or holder.label in habits.ingredients:
            continue
        if sum(node.label == holder.label for node in side.nodes) > 1:
            continue
        holder_places = {related_object for _, related_object in holder.relations}
        inside = [node for node in side.nodes if ("in", holder.label) in node.relations]
        unlisted = [
            node
            for node in inside
            if node.label in habits.foods
            and node.label not in contents
            and node.label not in holder_places
            and not any(node.label in content_names(other) for other in side.nodes)
            and not any(content_names(other) for other in inside if other.label in contents)
            and not content_names(node)
            and words_in([node.label]).isdisjoint(words_in(contents))
        ]
        if len(unlisted) == 1:
            (node,) = unlisted
            listed = ", ".join(sorted(contents))
            yield node, f"{node.label!r} is in {holder.label!r} here, which contains {listed}, and not it"


@rule(
    "other-place",
    WARNING,
    "an object in something that the unit has not, or in nothing, while something else contains it",
)
def find_objects_in_other_places(context: Context) -> Iterator[Diagnostic]:
    """The object is in a place that is not in the unit, and something else in the unit contains the object.

    Also reported is an object without a place that a container in the unit contains. Such an object is
    reported only if the files mostly state that contents are in their container.
    """
    objects = context.network.objects
    labels = {node.label for node in objects}
    places = {
        related_object for node in objects for _, related_object in node.relations
    } - context.habits.ingredients
    is_usual = _places_are_usual(context)
    for side in context.sides:
        misplaced = list(misplaced_nodes(side, labels, context.habits))
        if is_usual:
            misplaced += _unplaced_foods(side, places, context.habits)
        for node, message in misplaced:
            yield context.finding_at_node(context.files.copies[side.unit][0], side.number, node, message)


def misplaced_nodes(side: Side, labels: Collection[str], habits: Habits) -> FaultyNodes:
    """Yield each node that another node contains, and that is in or on an object missing on this side.

    With each node comes the message. ``labels`` are the labels of all nodes of the network; the label of the
    missing object is among them.

    A node is skipped
    - if the object or the containing node is an ingredient,
    - if the object and the containing node share a word, or
    - if the containing node is in or on the object.
    """
    labels_of_side = {node.label for node in side.nodes}
    for node in side.nodes:
        for word, related_object in node.relations:
            if (
                word not in _PLACES
                or related_object in labels_of_side
                or related_object not in labels
                or related_object in habits.ingredients
            ):
                continue
            holders = sorted({other.label for other in side.nodes if node.label in content_names(other)})
            if any(
                other.label in holders and (word, related_object) in other.relations for other in side.nodes
            ):
                continue
            if not holders or not habits.ingredients.isdisjoint(holders):
                continue
            if words_in([related_object]).isdisjoint(words_in(holders)):
                which = "outputs" if side.number else "inputs"
                yield (
                    node,
                    f"{node.label!r} is {word} {related_object!r}, which the {which} have not, and "
                    f"{holders[0]!r} contains it",
                )


def _places_are_usual(context: Context) -> bool:
    """Whether the files mostly state that an object among contents has a relation to its container.

    They mostly state it if they do so more than twice as often as they state no relation of the object.
    """
    placed = unplaced = 0
    for side in context.sides:
        for holder in side.nodes:
            for node in side.nodes if holder.contents else ():
                if node.label in content_names(holder):
                    placed += any(related_object == holder.label for _, related_object in node.relations)
                    unplaced += not node.relations
    return placed > 2 * unplaced


def _unplaced_foods(side: Side, places: Collection[str], habits: Habits) -> FaultyNodes:
    """Yield each food without a stated place that exactly one node of this side contains, with the message.

    ``places`` are the labels that may be places; the containing node must have one of them. A food whose
    label is not unique on this side is skipped. A food is also skipped if the unit puts it into the container
    or takes it out. It does so if the food is the only content, and is in the container on the other side.
    """
    for node in side.nodes:
        if node.relations or node.contents or node.label not in habits.foods:
            continue
        holders = [other for other in side.nodes if node.label in content_names(other)]
        if len(holders) != 1 or sum(other.label == node.label for other in side.nodes) > 1:
            continue
        holder = holders[0].label
        is_put = any(
            other.label == node.label
            and any(related_object == holder for _, related_object in other.relations)
            for other in side.others
        )
        if holder in places and (len(content_names(holders[0])) > 1 or not is_put):
            yield node, f"{holder!r} contains {node.label!r}, which is in no place here"


def inputs_placed_in_outputs(side: Side) -> FaultyNodes:
    """Yield inputs in or on an object that only the outputs list, each with the beginning of a message.

    ``side`` are the inputs of a unit. An object is reported for one input only.
    """
    own_labels, other_labels = ({node.label for node in nodes} for nodes in (side.nodes, side.others))
    for node in side.nodes:
        for word, related_object in node.relations:
            if word in _PLACES and related_object in other_labels and related_object not in own_labels:
                own_labels.add(related_object)
                yield node, f"{node.label!r} is {word} {related_object!r}, which the outputs"
