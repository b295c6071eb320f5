"""Finding the object node that a name means: of a goal, or of a thing in the kitchen."""

import re
import shlex
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple, Protocol

from foon_asp.errors import UserError
from foon_asp.network import NodePattern, ObjectNode, in_quotes, node_at_level, unquoted
from foon_asp.text.line import LineError
from foon_asp.text.line_parser import parse_name
from foon_asp.text.object_list import ListedObject

_SHOWN = 12
_NEAR = 3  # labels shown that are like one that nobody has
_IN_QUOTES = re.compile(r' *"(?:\\(?:["\\/bfnrt]|u[0-9a-fA-F]{4})|[^"\\])*("?)')  # closed or not


class Wording(NamedTuple):
    """How messages name the thing, and what comes before a name to paste."""

    thing: str
    before: str


_GOAL = Wording("goal", "--goal")


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
        """Return the id of a node, or ``None`` when it is not there."""

    def node(self, object_id: int) -> ObjectNode:
        """Return the node with that id."""

    def find(self, pattern: NodePattern) -> Sequence[int]:
        """Return the ids of the nodes that a kitchen or goals entry stands for."""

    def labelled(self, label: str) -> tuple[int, Sequence[int]]:
        """Return how many nodes have a label, and the first of them, a dozen or more."""

    def beginning(self, start: str, most: int) -> Sequence[str]:
        """Return labels that begin with ``start``, in alphabetical order, at most ``most``."""

    def near(self, label: str, most: int) -> Sequence[str]:
        """Return labels similar to ``label``, the most similar first, at most ``most``."""


def find_goal(
    name: str,
    names: NodeNames,
    listed: Sequence[ListedObject] = (),
    wording: Wording = _GOAL,
) -> int:
    """Return the id of the object node that a goal names.

    A name is the node itself in one-line notation (``sweet potato; chopped; in [cutting board]``, as
    ``str(node)`` has it), else the label of an entry of the goals file, else a label that one node alone has.
    A label that cannot be read as the notation, or is no node by it, is taken as it is written. A semicolon
    at the end (``onion;``) makes a label the notation, which no entry and no other node is meant by.
    Raises :class:`GoalError` with candidates ready to paste when it is unknown or means several nodes;
    ``wording`` is for other things than goals.
    """
    named: str | ObjectNode = name
    fault = None
    node = as_written = ObjectNode(name.strip(" "))
    try:
        named = parse_name(name)
    except LineError as error:
        fault = error
    else:
        node = node_at_level(ObjectNode(named) if isinstance(named, str) else named, names.level)
    for exact in (node, as_written):
        if (found := names.object_id(exact)) is not None:
            return found
    label = named if isinstance(named, str) else as_written.label
    entries = [entry for entry in listed if entry.pattern.label == label]
    if entries:
        meant = list(dict.fromkeys(o for entry in entries for o in listed_nodes(entry, names)))
        return _only(name, names, len(meant), meant, wording)
    count, labelled = names.labelled(label)
    if count:
        return _only(name, names, count, labelled, wording)
    if fault is not None:
        raise GoalError(
            f"the {wording.thing} {name!r} cannot be read: at column {fault.column}, {fault}; "
            f"a name with such letters in it is in quotes: {in_quotes(as_written.label)}"
        )
    count, labelled = names.labelled(node.label)
    if count:
        said = f"no object node is exactly {str(node)!r}; with that label there are"
        raise _unclear(said, names, count, _likest(node, labelled, names), wording)
    raise _unknown(f"no object node has the label {node.label!r}", node, names, wording)


def nodes_beginning(start: str, names: NodeNames, most: int) -> list[int]:
    """Return the ids of nodes whose one-line notation, or whose label, begins with ``start``, by label.

    At most ``most`` are returned. Up to the first semicolon that is a label, and of it as many letters as
    there are; it may be in quotes.
    """
    label, semicolon, _ = start.partition(";")
    labels = [label] if semicolon else []
    if begun := _IN_QUOTES.match(start):
        label = unquoted(begun[0].strip(" ") + '"' * (not begun[1]))
        labels = [label] if begun[1] else [*names.beginning(label, most)]
    found: dict[int, None] = {}
    for each in dict.fromkeys([*labels, *names.beginning(start, most)]):
        for o in names.labelled(each)[1]:
            if each.startswith(start) or str(names.node(o)).startswith(start):
                found[o] = None
        if len(found) >= most:
            break
    return [*found][:most]


def entry_names(listed: Sequence[ListedObject], names: NodeNames) -> Iterator[str]:
    """Return names that mean the entries of a goals file: their labels, where these mean no other node."""
    counts = Counter(entry.pattern.label for entry in listed)
    for entry in listed:
        label = entry.pattern.label
        found = names.find(entry.pattern)
        exact = names.object_id(ObjectNode(label))
        if len(found) != 1 or (counts[label] == 1 and exact in {None, found[0]}):
            yield str(ObjectNode(label))
        else:
            yield str(names.node(found[0]))


def listed_goal(entry: ListedObject, names: NodeNames) -> int:
    """Return the one node that an entry of a goals file stands for; raises :class:`UserError` for several."""
    found = listed_nodes(entry, names)
    return _only(str(entry.pattern), names, len(found), found, _GOAL)


def listed_nodes(entry: ListedObject, names: NodeNames) -> Sequence[int]:
    """Return the nodes that an entry of a goals file stands for; raises :class:`UserError` for none."""
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
        said = f"the {wording.thing} {name!r} means {count} object nodes"
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
    shown = [str(names.node(o)) for o in [*first][:_SHOWN]]
    return GoalError(said, shown, count - len(shown), wording.before)
