"""The effects of units in the check of a certificate: preconditions and add effects, also below level 3."""

from collections.abc import Collection, Iterator
from functools import cache

from foon_asp.network import Network, node_at_level


class UnitEffects:
    """The preconditions (``needs``) and add effects (``gives``) of units, without nodes that constraints add.

    ``needs`` and ``gives`` are cached functions from a unit id to ids of nodes. An id of ``None`` stands for
    nodes that the network does not have.

    ``containers`` is the container rule, ``strict`` or ``implied``; ``utensils`` are the labels of utensils.
    """

    def __init__(self, network: Network, containers: str, utensils: Collection[str]) -> None:
        self.network, self.containers, self.utensils = network, containers, utensils
        self.needs, self.gives = cache(self._needs), cache(self._gives)

    def _needs(self, unit: int) -> frozenset[int | None]:
        """Return the preconditions of a unit, without nodes that constraints add.

        Below level 3, they are the common preconditions of all units of level 3 that the unit stands for.
        """
        return frozenset.intersection(*(needed for needed, _ in self._detailed_effects(unit)))

    def _gives(self, unit: int) -> frozenset[int | None]:
        """Return the add effects of a unit, without nodes that constraints add.

        Below level 3, they are the add effects of all units of level 3 that the unit stands for.
        """
        return frozenset.union(*(made for _, made in self._detailed_effects(unit)))

    def _detailed_effects(self, unit: int) -> Iterator[tuple[frozenset[int | None], frozenset[int | None]]]:
        """Yield preconditions and add effects of each unit of level 3 that a unit stands for.

        Nodes are ids at the network's level. A unit of level 3 stands for itself. Containers that the
        container rule skips are omitted.
        """
        network = self.network
        detailed = network.detailed or network
        for detail in (unit,) if network.detailed is None else network.stands_for[unit]:
            inputs = set(detailed.inputs[detail])
            skipped = self._skipped_containers(detailed, inputs) if self.containers == "implied" else set()
            yield (
                self._ids_at_level(inputs - skipped),
                self._ids_at_level(set(detailed.outputs[detail]) - skipped),
            )

    def _skipped_containers(self, detailed: Network, inputs: set[int]) -> set[int]:
        """Return the inputs of a unit that the container rule ``implied`` takes as given.

        Such an input is a utensil with exactly one ingredient. This ingredient, located in the utensil, is
        another input.
        """
        nodes = [(o, detailed.objects[o]) for o in inputs]
        return {
            o
            for o, vessel in nodes
            if vessel.label in self.utensils
            and len(vessel.ingredients) == 1
            and any(
                other != o and node.label == vessel.ingredients[0] and node.is_in(vessel.label)
                for other, node in nodes
            )
        }

    def _ids_at_level(self, nodes: set[int]) -> frozenset[int | None]:
        """Return nodes of level 3 as ids at the network's level; ``None`` for nodes that it does not have."""
        network = self.network
        if network.detailed is None:
            return frozenset(nodes)
        nodes_at_level = (node_at_level(network.detailed.objects[o], network.level) for o in nodes)
        return frozenset(map(network.object_id, nodes_at_level))
