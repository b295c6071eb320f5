"""A whole network as the page shows it, with coordinates for each unit and object node."""

from typing import Self

from foon_asp.pictures.graphviz import network_coordinates
from foon_asp.pictures.tree_drawing import network_drawing
from foon_asp.problem import Problem, reach
from foon_asp.results.values import Mention, Node, Value
from foon_asp.results.values_of import mention_of, nodes_of


class PlacedUnit(Mention, frozen=True):
    """A unit of a whole network.

    Attributes:
        inputs: The positions of its inputs in the objects.
        outputs: The positions of its outputs in the objects.
    """

    inputs: tuple[int, ...]
    outputs: tuple[int, ...]


class WholeNetwork(Value, frozen=True):
    """A whole network.

    Attributes:
        places: The coordinates x and y of each unit, and then of each object.
        kitchen: The positions of available objects.
        reachable: The positions of objects that are available or can be made.
        possible: The positions of units that can be done with reachable objects.
    """

    objects: tuple[Node, ...]
    units: tuple[PlacedUnit, ...]
    places: tuple[int, ...]
    kitchen: tuple[int, ...]
    reachable: tuple[int, ...]
    possible: tuple[int, ...]

    @classmethod
    def of(cls, problem: Problem) -> Self:
        """Return the whole network of a problem, with coordinates that Graphviz computes.

        An object that is in no unit is at (0, 0). Raises :class:`UserError` for a network that is too large
        for a layout, and if Graphviz is not installed.
        """
        network = problem.network
        reached = reach(problem)
        objects, units = range(len(network.objects)), range(len(network))
        drawing = network_drawing(network, units, (), (), ())
        coordinates_by_name = network_coordinates(drawing)
        coordinates = {
            box.unit if box.node is None else box.node: coordinates_by_name[box.name] for box in drawing.boxes
        }
        positions = [coordinates[network.unit_number(u)] for u in units]
        positions += [coordinates.get(node, (0, 0)) for node in network.objects]  # some nodes are in no unit
        mentions = (mention_of(network, u) for u in units)
        return cls(
            nodes_of(network, objects),
            tuple(
                PlacedUnit(mention.id, mention.motion, mention.source, tuple(inputs), tuple(outputs))
                for mention, inputs, outputs in zip(mentions, network.inputs, network.outputs, strict=True)
            ),
            tuple(round(number) for position in positions for number in position),
            tuple(sorted(problem.kitchen)),
            tuple(o for o in objects if reached.available[o]),
            tuple(sorted(reached.units)),
        )
