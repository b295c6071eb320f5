"""A whole network as a page shows it: with a place in a picture for each unit and object node."""

from typing import Self

from foon_asp.pictures.graphviz import spots
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
        places: Of units, then of objects: x and y of each.
        kitchen: The positions of objects at hand.
        reachable: The positions of objects at hand or that can be made.
        possible: The positions of units that can be done with these.
    """

    objects: tuple[Node, ...]
    units: tuple[PlacedUnit, ...]
    places: tuple[int, ...]
    kitchen: tuple[int, ...]
    reachable: tuple[int, ...]
    possible: tuple[int, ...]

    @classmethod
    def of(cls, problem: Problem) -> Self:
        """Return the network of a problem, laid out."""
        network = problem.network
        reached = reach(problem)
        objects, units = range(len(network.objects)), range(len(network))
        drawing = network_drawing(network, units, (), (), ())
        found = spots(drawing)
        places = {box.unit if box.node is None else box.node: found[box.name] for box in drawing.boxes}
        listed = [places[network.unit_number(u)] for u in units]
        listed += [places.get(node, (0, 0)) for node in network.objects]  # some are in no unit
        mentions = (mention_of(network, u) for u in units)
        return cls(
            nodes_of(network, objects),
            tuple(
                PlacedUnit(each.id, each.motion, each.source, tuple(inputs), tuple(outputs))
                for each, inputs, outputs in zip(mentions, network.inputs, network.outputs, strict=True)
            ),
            tuple(round(number) for place in listed for number in place),
            tuple(sorted(problem.kitchen)),
            tuple(o for o in objects if reached.available[o]),
            tuple(sorted(reached.units)),
        )
