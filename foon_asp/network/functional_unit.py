"""Functional units: one motion that takes object nodes to object nodes."""

from collections.abc import Iterable
from dataclasses import dataclass

from foon_asp.network.object_node import ObjectNode


@dataclass(frozen=True, slots=True, eq=False)
class FunctionalUnit:
    """A motion with its input and output object nodes.

    ``motion`` is its name; ``inputs`` and ``outputs`` list each node once, in the order first read. Units are
    equal if they have the same motion, set of inputs and set of outputs, whatever the order.

    Example:
        >>> water, tea = foon_asp.parse_node("water"), foon_asp.parse_node("tea; hot")
        >>> print(foon_asp.FunctionalUnit.of("brew", [water], [tea]))
        brew: water → tea; hot
    """

    motion: str
    inputs: tuple[ObjectNode, ...]
    outputs: tuple[ObjectNode, ...]

    @classmethod
    def of(cls, motion: str, inputs: Iterable[ObjectNode], outputs: Iterable[ObjectNode]) -> "FunctionalUnit":
        """Make a unit; a node listed twice on one side is kept once.

        Parameters:
            motion: The label of the motion.
            inputs: The object nodes that the unit needs.
            outputs: The object nodes that the unit makes.
        """
        return cls(motion, tuple(dict.fromkeys(inputs)), tuple(dict.fromkeys(outputs)))

    @property
    def identity(self) -> tuple[str, frozenset[ObjectNode], frozenset[ObjectNode]]:
        """The motion, the set of inputs and the set of outputs: units are equal if these are."""
        return self.motion, frozenset(self.inputs), frozenset(self.outputs)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, FunctionalUnit) and self.identity == other.identity

    def __hash__(self) -> int:
        return hash(self.identity)

    def __str__(self) -> str:
        return f"{self.motion}: {' + '.join(map(str, self.inputs))} → {' + '.join(map(str, self.outputs))}"
