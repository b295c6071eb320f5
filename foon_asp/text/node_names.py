"""What a network and a store offer for looking up object nodes by name."""

from collections.abc import Sequence
from typing import Protocol

from foon_asp.network import NodePattern, ObjectNode


class NodeNames(Protocol):
    """A network whose nodes are looked up by name: a :class:`~foon_asp.network.Network`, or a store."""

    @property
    def level(self) -> int:
        """The level of FOON, from 1 to 3."""

    def object_id(self, node: ObjectNode) -> int | None:
        """Return the id of a node, ``None`` if it does not exist."""

    def node(self, object_id: int) -> ObjectNode:
        """Return the node with an id."""

    def find(self, pattern: NodePattern) -> Sequence[int]:
        """Return the ids of the nodes that match an entry of a kitchen or goals file."""

    def labelled(self, label: str) -> tuple[int, Sequence[int]]:
        """Return how many nodes have a label, and the ids of at least the first twelve."""

    def beginning(self, start: str, max_labels: int) -> Sequence[str]:
        """Return labels that begin with ``start``, in alphabetical order, at most ``max_labels``."""

    def near(self, label: str, max_labels: int) -> Sequence[str]:
        """Return labels similar to ``label``, the most similar first, at most ``max_labels``."""
