"""What there is to say of places: an object in something that does not contain it, or that is not there."""

from collections.abc import Collection, Iterator

from foon_asp.linting.habits import Habits, held, words_in
from foon_asp.linting.names import Names
from foon_asp.network import Network, ObjectNode
from foon_asp.text.diagnostics import Diagnostic

_PLACES = {"in", "on"}
_USUAL = 2  # how much more often something is said than not


def place_findings(names: Names) -> Iterator[Diagnostic]:
    """Give the findings about each side of each unit, in linear time."""
    files, network, habits = names.files, names.network, names.habits
    labels = {node.label for node in network.objects}
    places = {place for node in network.objects for _, place in node.relations} - habits.ingredients
    is_usual = _places_are_usual(network)
    for unit, copies in enumerate(files.copies):
        copy = copies[0]
        sheet = files.sheets[copy.sheet]
        sides = network.inputs[unit], network.outputs[unit]
        for side, ids in enumerate(sides):
            nodes = [network.objects[node] for node in ids]
            said = [("unheld", *each) for each in _unheld(nodes, habits)]
            which = "outputs" if side else "inputs"
            said += [
                ("other-place", node, f"{what} the {which} have not, and {holder!r} contains it")
                for node, what, holder in _elsewhere(nodes, labels, habits)
            ]
            others = [network.objects[node] for node in sides[1 - side]]
            if side == 0:
                known = {node for _, node, _ in said}
                said += [
                    ("left-out", node, f"{what} of {network.motions[unit]!r} have, and the inputs have not")
                    for node, what in _only_after(nodes, others)
                    if node not in known
                ]
            if is_usual:
                said += [
                    ("other-place", node, f"{holder!r} contains {node.label!r}, which is in no place here")
                    for node, holder in _unplaced(nodes, others, places, habits)
                ]
            if not said:
                continue
            blocks = list(sheet.blocks(copy.at))
            part = blocks[copy.inputs :] if side else blocks[: copy.inputs]
            for code, node, message in said:
                index = next((index for index, other in part if other == node), copy.at)
                yield sheet.finding(code, message, index, node.label)


def _places_are_usual(network: Network) -> bool:
    """Whether what a container contains is mostly said to be in or on it."""
    placed = unplaced = 0
    for side in (*network.inputs, *network.outputs):
        nodes = [network.objects[node] for node in side]
        for holder in nodes:
            for node in nodes:
                if node.label in held(holder):
                    placed += any(place == holder.label for _, place in node.relations)
                    unplaced += not node.relations
    return placed > _USUAL * unplaced


def _only_after(
    inputs: Collection[ObjectNode], outputs: Collection[ObjectNode]
) -> Iterator[tuple[ObjectNode, str]]:
    """Give an input for each thing that it is in or on, where only the outputs have that."""
    before, after = ({node.label for node in side} for side in (inputs, outputs))
    for node in inputs:
        for word, place in node.relations:
            if word in _PLACES and place in after and place not in before:
                before.add(place)
                yield node, f"{node.label!r} is {word} {place!r}, which the outputs"


def _unplaced(
    nodes: Collection[ObjectNode],
    others: Collection[ObjectNode],
    places: Collection[str],
    habits: Habits,
) -> Iterator[tuple[ObjectNode, str]]:
    """Give the foods without a place, while the only thing that contains them is one.

    Not where more of the only food in it is put there: ``others`` is the other side.
    """
    for node in nodes:
        if node.relations or node.contents or node.label not in habits.foods:
            continue
        holders = [other for other in nodes if node.label in held(other)]
        if len(holders) != 1 or sum(other.label == node.label for other in nodes) > 1:
            continue
        holder = holders[0].label
        is_put = any(
            other.label == node.label and any(place == holder for _, place in other.relations)
            for other in others
        )
        if holder in places and (len(held(holders[0])) > 1 or not is_put):
            yield node, holder


def _unheld(nodes: Collection[ObjectNode], habits: Habits) -> Iterator[tuple[ObjectNode, str]]:
    """Give the one object that is in a container, and is not among its contents."""
    for holder in nodes:
        contents = held(holder)
        if not contents or holder.label in habits.ingredients:
            continue
        if sum(node.label == holder.label for node in nodes) > 1:
            continue
        around = {place for _, place in holder.relations}
        inside = [node for node in nodes if ("in", holder.label) in node.relations]
        extra = [
            node
            for node in inside
            if node.label in habits.foods
            and node.label not in contents
            and node.label not in around
            and not any(node.label in held(other) for other in nodes)
            and not any(held(other) for other in inside if other.label in contents)
            and not held(node)
            and words_in([node.label]).isdisjoint(words_in(contents))
        ]
        if len(extra) == 1:
            inside_it = ", ".join(sorted(contents))
            yield (
                extra[0],
                f"{extra[0].label!r} is in {holder.label!r} here, which contains {inside_it}, and not it",
            )


def _elsewhere(
    nodes: Collection[ObjectNode], labels: Collection[str], habits: Habits
) -> Iterator[tuple[ObjectNode, str, str]]:
    """Give the objects in or on something that the unit has not, while something else contains them."""
    here = {node.label for node in nodes}
    for node in nodes:
        for word, place in node.relations:
            if word not in _PLACES or place in here or place not in labels or place in habits.ingredients:
                continue
            holders = sorted({other.label for other in nodes if node.label in held(other)})
            if any(other.label in holders and (word, place) in other.relations for other in nodes):
                continue
            if not holders or not habits.ingredients.isdisjoint(holders):
                continue
            if words_in([place]).isdisjoint(words_in(holders)):
                yield node, f"{node.label!r} is {word} {place!r}, which", holders[0]
