"""Finding the object node that a goal's name means."""

import difflib
import shlex
from collections import defaultdict
from collections.abc import Iterable, Sequence
from typing import Protocol

from foon_asp.errors import UserError
from foon_asp.network import Network, NodePattern, ObjectNode, node_at_level
from foon_asp.text.line import LineError, parse_node
from foon_asp.text.object_list import ListedObject

_SHOWN = 12
_NEAR = 3  # labels shown that are like one that nobody has


class GoalError(UserError):
    """A name that means no object node, or several.

    ``said`` is the message without candidates, ``candidates`` are those shown, in one-line notation, and
    ``more`` counts the others. As a string they are options of the command line.
    """

    def __init__(self, said: str, candidates: Sequence[str] = (), more: int = 0) -> None:
        lines = [said, *(f"  --goal {shlex.quote(candidate)}" for candidate in candidates)]
        if more:
            lines.append(f"  ... and {more} more")
        super().__init__("\n".join(lines))
        self.said, self.candidates, self.more = said, tuple(candidates), more


class NodeNames(Protocol):
    """What names are looked up in, where it is no :class:`Network`. Ids are those of the object nodes."""

    @property
    def level(self) -> int:
        """How much of a node counts."""

    def object_id(self, node: ObjectNode) -> int | None:
        """Give the id of a node, or ``None`` when it is not there."""

    def node(self, object_id: int) -> ObjectNode:
        """Give the node with that id."""

    def find(self, pattern: NodePattern) -> Sequence[int]:
        """Give the ids of the nodes that a kitchen or goals entry stands for."""

    def labelled(self, label: str) -> tuple[int, Sequence[int]]:
        """Give how many nodes have a label, and the first of them, a dozen or more."""

    def beginning(self, start: str, most: int) -> Sequence[str]:
        """Give labels that begin so, in alphabetical order, at most so many."""

    def near(self, label: str, most: int) -> Sequence[str]:
        """Give labels that are like one, the likest first, at most so many."""


def find_goal(
    name: str, network: Network | NodeNames, listed: Sequence[ListedObject] = (), what: str = "goal"
) -> int:
    """Give the id of the object node that a goal, or ``what`` else is asked for, names.

    A name is a label (of an entry of the goals file first, then of the network's nodes) or the one-line
    notation ``sweet potato; chopped; in [cutting board]``; a semicolon at the end (``onion;``) makes the
    notation of a node that is only a label. Raises :class:`GoalError` with candidates ready
    to paste when it is unknown or means several nodes.
    """
    names = _names(network)
    try:
        named = parse_node(name)
    except LineError as error:
        raise GoalError(f"the {what} {name!r} cannot be read: at column {error.column}, {error}") from None
    bare = named == ObjectNode(named.label) and not _is_closed(name, named)
    node = node_at_level(named, names.level)
    entries = [entry for entry in listed if bare and entry.pattern.label == node.label]
    if entries:
        found = list(dict.fromkeys(o for entry in entries for o in listed_nodes(entry, names)))
        return _only(f"the {what} {name!r}", names, len(found), found)
    if bare:
        count, labelled = names.labelled(node.label)
        if count:
            return _only(f"the {what} {name!r}", names, count, labelled)
    exact = names.object_id(node)
    if exact is not None:
        return exact
    if not bare:  # a label with a semicolon in it, as it is
        count, labelled = names.labelled(name)
        if count:
            return _only(f"the {what} {name!r}", names, count, labelled)
    count, labelled = names.labelled(node.label)
    if count:
        said = f"no object node is exactly {str(node)!r}; with that label there are"
        raise _unclear(said, names, count, labelled)
    raise _unknown(f"no object node has the label {node.label!r}", node.label, names)


def _is_closed(name: str, node: ObjectNode) -> bool:
    """Whether a notation ends in a semicolon that is no part of a name."""
    name = name.rstrip(" ")
    return name.endswith(";") and parse_node(name[:-1]) == node


def listed_nodes(entry: ListedObject, network: Network | NodeNames) -> Sequence[int]:
    """Give the nodes that an entry of a goals file stands for; raises :class:`UserError` for none."""
    names = _names(network)
    found = names.find(entry.pattern)
    if not found:
        count, labelled = names.labelled(entry.pattern.label)
        place = f"{entry.source.file}:{entry.source.line}:{entry.source.column}"
        said = f"{place}: error: the goal {str(entry.pattern)!r} matches no object node"
        if count:
            raise _unclear(f"{said}; with that label there are", names, count, labelled)
        raise _unknown(f"{said} of the network", entry.pattern.label, names)
    return found


class _NetworkNames:
    """The names of a network that is in memory."""

    def __init__(self, network: Network) -> None:
        self.level = network.level
        self.object_id = network.object_id
        self.find = network.find
        self._network = network

    def node(self, object_id: int) -> ObjectNode:
        return self._network.objects[object_id]

    def labelled(self, label: str) -> tuple[int, Sequence[int]]:
        found = self._network.by_label.get(label, ())
        return len(found), found

    def beginning(self, start: str, most: int) -> Sequence[str]:
        return sorted(label for label in self._network.by_label if label.startswith(start))[:most]

    def near(self, label: str, most: int) -> Sequence[str]:
        return near_labels(label, self._network.by_label, most)


def near_labels(label: str, known: Iterable[str], most: int) -> list[str]:
    """Give those of the known labels that are like one, whatever their capitals, the likest first."""
    lower: defaultdict[str, list[str]] = defaultdict(list)
    for name in known:
        lower[name.lower()].append(name)
    close = difflib.get_close_matches(label.lower(), lower, n=most, cutoff=0.6)
    return [name for small in close for name in lower[small]]


def _names(network: Network | NodeNames) -> NodeNames:
    return _NetworkNames(network) if isinstance(network, Network) else network


def _only(what: str, names: NodeNames, count: int, found: Sequence[int]) -> int:
    if count > 1:
        raise _unclear(f"{what} means {count} object nodes; paste the one you mean", names, count, found)
    return found[0]


def _unknown(said: str, label: str, names: NodeNames) -> GoalError:
    """Name nodes whose labels begin so or are near, a few of each label, if there are any."""
    labels = dict.fromkeys((*names.beginning(label, _SHOWN), *names.near(label, _NEAR)))
    found = [names.labelled(like) for like in labels]
    if not found:
        return GoalError(said)
    each = max(1, _SHOWN // len(found))
    total = sum(count for count, _ in found)
    return _unclear(f"{said}; similar are", names, total, [o for _, first in found for o in first[:each]])


def _unclear(said: str, names: NodeNames, count: int, first: Iterable[int]) -> GoalError:
    shown = [names.node(o) for o in [*first][:_SHOWN]]
    # a semicolon makes the notation of a node that is only a label
    texts = [f"{node};" if node == ObjectNode(node.label) else str(node) for node in shown]
    return GoalError(said, texts, count - len(shown))
