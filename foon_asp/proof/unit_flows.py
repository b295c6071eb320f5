"""The flows of units in the check of a plan: the copies of nodes that they need, consume and add."""

from collections.abc import Mapping, Sequence, Set
from functools import cache
from typing import NamedTuple

from foon_asp.network import Network, ObjectNode
from foon_asp.proof.step_budget import StepBudget
from foon_asp.proof.unit_effects import UnitEffects


class Flow(NamedTuple):
    """The copies of object nodes that a unit needs (``asks``), consumes (``uses``) and adds, by node id."""

    asks: Mapping[int, int]
    uses: Mapping[int, int]
    adds: Mapping[int, int]


class UnitFlows:
    """The flows of the units of a network; ``flow`` is a cached function from a unit id to its flow.

    ``effects``: the preconditions and add effects of units.
    ``utensils``: the labels of utensils.
    ``amounts``: the amounts of inputs and of outputs, by unit id; other amounts are 1.
    ``stays_stated``: whether labels, and nodes by id, stay when used, as a certificate states it.
    ``budget``: the steps of the check, of which a flow takes some.
    """

    def __init__(
        self,
        network: Network,
        effects: UnitEffects,
        utensils: Set[str],
        amounts: Mapping[int, tuple[Mapping[int, int], Mapping[int, int]]],
        stays_stated: Mapping[str | int, bool],
        budget: StepBudget,
    ) -> None:
        self.network, self.needs, self.gives = network, effects.needs, effects.gives
        self.utensils, self.amounts, self.stays_stated = utensils, amounts, stays_stated
        self.budget = budget
        self.flow = cache(self._flow)

    def _flow(self, unit: int) -> Flow:
        """Return the copies that one execution of a unit needs, consumes and adds.

        Of an output that is also an input, only the surplus over the input is added. The work counts as steps
        of the check.
        """
        network, inputs = self.network, self.network.inputs[unit]
        input_amounts, output_amounts = self.amounts.get(unit, ({}, {}))
        asks = {o: input_amounts.get(o, 1) for o in self.needs(unit) if o is not None}
        gives = {o: output_amounts.get(o, 1) for o in self.gives(unit) if o is not None}
        self.budget.spend(len(inputs) * (1 + len(network.outputs[unit])))
        remaining = {
            o: self._remaining_copies(unit, o, amount, output_amounts.get(o, 1)) for o, amount in asks.items()
        }
        adds = {o: n - (input_amounts.get(o, 1) if o in inputs else 0) for o, n in gives.items()}
        return Flow(
            asks,
            {o: amount - remaining[o] for o, amount in asks.items() if amount > remaining[o]},
            {o: surplus for o, surplus in adds.items() if surplus > 0},
        )

    def _remaining_copies(self, unit: int, o: int, amount: int, made: int) -> int:
        """Return how many of the ``amount`` copies of an input remain after a unit has run.

        The first case that holds decides:

        - The certificate states whether the input stays: all or none remain.
        - The input is an output, too: ``made`` copies remain, but at most ``amount``.
        - Another output has the label of the input: none remain.
        - Otherwise, :meth:`_stays_by_rule` says whether all or none remain.
        """
        objects, network = self.network.objects, self.network
        node = objects[o]
        for name in (o, node.label):
            if name in self.stays_stated:
                return amount if self.stays_stated[name] else 0
        outputs = [objects[output] for output in network.outputs[unit]]
        if any(output.label == node.label for output in outputs):
            return min(amount, made) if o in network.outputs[unit] else 0
        return amount if self._stays_by_rule(unit, node, outputs) else 0

    def _stays_by_rule(self, unit: int, node: ObjectNode, outputs: Sequence[ObjectNode]) -> bool:
        """Return whether an input stays although no output has its label.

        A utensil stays if it is empty, or if an output is in, on or at it. An input may be located in another
        input, its container. It stays if an output with the label of the container still contains it.
        """
        objects, network = self.network.objects, self.network
        if node.label in self.utensils:
            is_empty = not any(contents.ingredients for contents in node.contents)
            if is_empty or any(output.is_in(node.label) for output in outputs):
                return True
        input_labels = {objects[o].label for o in network.inputs[unit]}
        containers = {relation.object for relation in node.relations} & input_labels
        return any(output.label in containers and node.label in output.ingredients for output in outputs)
