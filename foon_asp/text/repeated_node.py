"""Object nodes that a unit of FOON text lists twice, which is mostly a slip and counts once."""

from collections.abc import Sequence
from typing import NamedTuple

from foon_asp.network import ObjectNode, Source, counted


class RepeatedNode(NamedTuple):
    """The first node that a copy of a unit lists twice on one side, in one-line notation, and its source."""

    node: str
    source: Source


def repeated_node(inputs: Sequence[ObjectNode], outputs: Sequence[ObjectNode]) -> ObjectNode | None:
    """Return the first node that one side of a unit lists twice; ``None`` if no side repeats a node."""
    for nodes in (inputs, outputs):
        labels = {node.label for node in nodes}  # mostly enough, and strings keep their hashes
        if len(labels) < len(nodes) and len(set(nodes)) < len(nodes):
            return next(node for index, node in enumerate(nodes) if node in nodes[:index])
    return None


def repeated_note(repeated: Sequence[RepeatedNode]) -> list[str]:
    """Return a list with one line: a note about all repeated nodes. Without repeated nodes, it is empty."""
    if not repeated:
        return []
    first = repeated[0]
    units = f"{counted(len(repeated), 'unit')} {'lists' if len(repeated) == 1 else 'list'}"
    return [
        f"note: {units} an object node twice, which counts once: {first.node!r} in "
        f"{first.source.file}:{first.source.line}; foon-asp lint shows each"
    ]
