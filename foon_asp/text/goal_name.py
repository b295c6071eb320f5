"""Finding the object node that a name means: of a goal, or of a thing in the kitchen."""

import shlex
from collections.abc import Iterable, Sequence
from typing import NamedTuple, Protocol

from foon_asp.errors import UserError
from foon_asp.network import NodePattern, ObjectNode, node_at_level
from foon_asp.text.line import LineError
from foon_asp.text.line_parser import parse_node
from foon_asp.text.object_list import ListedObject

_SHOWN = 12
_NEAR = 3  # labels shown that are like one that nobody has


class Wording(NamedTuple):
    """How messages name the thing, where it was looked up, and what comes before a name to paste."""

    thing: str
    where: str
    before: str


_GOAL = Wording("goal", "", "--goal")


class GoalError(UserError):
    """A name that means no object node, or several.

    ``said`` is the message without candidates, ``candidates`` are those shown, in one-line notation, and
    ``more`` counts the others. As a string they are ready to paste, behind the words that stand ``before``.
    """

    def __init__(
        self, said: str, candidates: Sequence[str] = (), more: int = 0, before: str = _GOAL.before
    ) -> None:
        lines = [said, *(f"  {before} {shlex.quote(candidate)}" for candidate in candidates)]
        if more:
            lines.append(f"  ... and {more} more")
        super().__init__("\n".join(lines))
        self.said, self.candidates, self.more = said, tuple(candidates), more


class NodeNames(Protocol):
    """What names are looked up in: a :class:`~foon_asp.network.Network`, or a store."""

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
        """Give labels that begin with ``start``, in alphabetical order, at most ``most``."""

    def near(self, label: str, most: int) -> Sequence[str]:
        """Give labels similar to ``label``, the most similar first, at most ``most``."""


def find_goal(
    name: str,
    names: NodeNames,
    listed: Sequence[ListedObject] = (),
    wording: Wording = _GOAL,
    by_beginning: bool = False,
) -> int:
    """Give the id of the object node that a goal names.

    A name is the label of an entry of the goals file, the one-line notation ``sweet potato; chopped; in
    [cutting board]``, or a label that one node alone has. A node that is only a label comes before others
    with that label, so that ``str(node)`` finds the node; a semicolon at the end (``onion;``) makes it the
    notation also where the goals file has such an entry. ``by_beginning`` takes the beginning of a notation
    too, where one node alone begins so and no name is just this. Raises :class:`GoalError` with candidates
    ready to paste when it is unknown or means several nodes; ``wording`` is for other things than goals.
    """
    begun = [] if not by_beginning else nodes_beginning(name, names, 2)
    try:
        named = parse_node(name)
    except LineError as error:
        if len(begun) == 1:
            return begun[0]
        raise GoalError(
            f"the {wording.thing} {name!r} cannot be read: at column {error.column}, {error}"
        ) from None
    bare = named == ObjectNode(named.label) and not _is_closed(name, named)
    node = node_at_level(named, names.level)
    entries = [entry for entry in listed if bare and entry.pattern.label == node.label]
    if entries:
        found = list(dict.fromkeys(o for entry in entries for o in listed_nodes(entry, names)))
        return _only(name, names, len(found), found, wording)
    exact = names.object_id(node)
    if exact is not None:
        return exact
    count, labelled = names.labelled(node.label if bare else name)  # also one with a semicolon, as it is
    if count:
        return _only(name, names, count, labelled, wording)
    if len(begun) == 1:
        return begun[0]
    count, labelled = names.labelled(node.label)
    if count:
        said = f"no object node{wording.where} is exactly {str(node)!r}; with that label there are"
        raise _unclear(said, names, count, _likest(node, labelled, names), wording)
    raise _unknown(f"no object node{wording.where} has the label {node.label!r}", node, names, wording)


def nodes_beginning(start: str, names: NodeNames, most: int) -> list[int]:
    """Give the ids of nodes whose one-line notation begins with ``start``, ordered by label.

    At most ``most`` are given. Up to the first semicolon that is a label, and of it as many letters as there
    are.
    """
    label, semicolon, _ = start.partition(";")
    labels = [label] if semicolon else names.beginning(label, most)
    found: list[int] = []
    for each in labels:
        found += (o for o in names.labelled(each)[1] if str(names.node(o)).startswith(start))
        if len(found) >= most:
            break
    return found[:most]


def notation(node: ObjectNode) -> str:
    """Give the one-line notation that names a node and no other: a label alone is closed by a semicolon."""
    return f"{node};" if node == ObjectNode(node.label) else str(node)


def _is_closed(name: str, node: ObjectNode) -> bool:
    """Whether a notation ends in a semicolon that is no part of a name."""
    name = name.rstrip(" ")
    return name.endswith(";") and parse_node(name[:-1]) == node


def listed_nodes(entry: ListedObject, names: NodeNames) -> Sequence[int]:
    """Give the nodes that an entry of a goals file stands for; raises :class:`UserError` for none."""
    found = names.find(entry.pattern)
    if not found:
        count, labelled = names.labelled(entry.pattern.label)
        place = f"{entry.source}:{entry.source.column}"
        said = f"{place}: error: the goal {str(entry.pattern)!r} matches no object node"
        if count:
            raise _unclear(f"{said}; with that label there are", names, count, labelled, _GOAL)
        raise _unknown(f"{said} of the network", ObjectNode(entry.pattern.label), names, _GOAL)
    return found


def _only(name: str, names: NodeNames, count: int, found: Sequence[int], wording: Wording) -> int:
    if count > 1:
        said = f"the {wording.thing} {name!r} means {count} object nodes{wording.where}"
        raise _unclear(f"{said}; paste the one you mean", names, count, found, wording)
    return found[0]


def _likest(node: ObjectNode, found: Sequence[int], names: NodeNames) -> Sequence[int]:
    """Order nodes by how like one that is not there they are written; a label alone says nothing."""
    if node == ObjectNode(node.label):
        return found
    import difflib  # noqa: PLC0415 (for faults alone)

    written = {str(names.node(o)): o for o in found}
    return [written[each] for each in difflib.get_close_matches(str(node), written, len(written), cutoff=0)]


def _unknown(said: str, node: ObjectNode, names: NodeNames, wording: Wording) -> GoalError:
    """Name nodes whose labels begin so or are near, a few of each label, if there are any."""
    labels = dict.fromkeys((*names.beginning(node.label, _SHOWN), *names.near(node.label, _NEAR)))
    found = [names.labelled(like) for like in labels]
    if not found:
        return GoalError(said)
    each = max(1, _SHOWN // len(found))
    total = sum(count for count, _ in found)
    first = [o for _, some in found for o in _likest(node, some, names)[:each]]
    return _unclear(f"{said}; similar are", names, total, first, wording)


def _unclear(said: str, names: NodeNames, count: int, first: Iterable[int], wording: Wording) -> GoalError:
    shown = [notation(names.node(o)) for o in [*first][:_SHOWN]]
    return GoalError(said, shown, count - len(shown), wording.before)
