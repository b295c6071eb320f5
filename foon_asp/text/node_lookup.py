"""Lookup of the object node that a name means, for goals and kitchen items."""

import re
from collections import Counter
from collections.abc import Iterator, Sequence

from foon_asp.network import ObjectNode, in_quotes, node_at_level, unquoted
from foon_asp.text.line import LineError
from foon_asp.text.line_parser import parse_name
from foon_asp.text.node_names import NodeNames
from foon_asp.text.object_list import ListedObject
from foon_asp.text.unknown_node import (
    GOAL,
    GoalError,
    Wording,
    error_with_candidates,
    most_similar_first,
    unknown_error,
)

_IN_QUOTES = re.compile(r' *"(?:\\(?:["\\/bfnrt]|u[0-9a-fA-F]{4})|[^"\\])*("?)')  # closed or not


def find_goal(
    name: str,
    names: NodeNames,
    goal_entries: Sequence[ListedObject] = (),
    wording: Wording = GOAL,
) -> int:
    """Return the id of the object node that a goal names in ``names``, which is a network or a store.

    The name is tried in this order:

    - as the one-line notation of a node, such as ``sweet potato; chopped; in [cutting board]``,
    - as the label of an entry of the goals file, one of ``goal_entries``,
    - as the label of a single node.

    Notation is reduced to the level of ``names``. A text that is no notation, or the notation of no node, is
    also tried literally as a label. A label with a semicolon after it, ``onion;``, is only tried as notation:
    it is the node without states.

    Raises :class:`GoalError` with candidates ready to paste if the name is unknown or means several nodes.
    ``wording`` has the words for a goal in messages.
    """
    parsed_name: str | ObjectNode = name
    fault = None
    node = literal_node = ObjectNode(name.strip(" "))
    try:
        parsed_name = parse_name(name)
    except LineError as error:
        fault = error
    else:
        node = node_at_level(
            ObjectNode(parsed_name) if isinstance(parsed_name, str) else parsed_name, names.level
        )
    for candidate in (node, literal_node):
        if (object_id := names.object_id(candidate)) is not None:
            return object_id
    label = parsed_name if isinstance(parsed_name, str) else literal_node.label
    entries = [entry for entry in goal_entries if entry.pattern.label == label]
    if entries:
        matching_nodes = list(dict.fromkeys(o for entry in entries for o in nodes_of_entry(entry, names)))
        return _only_node(name, names, len(matching_nodes), matching_nodes, wording)
    count, labelled = names.labelled(label)
    if count:
        return _only_node(name, names, count, labelled, wording)
    if fault is not None:
        raise GoalError(
            f"the {wording.noun} {name!r} cannot be read: at column {fault.column}, {fault}; "
            f"a name with such letters in it is in quotes: {in_quotes(literal_node.label)}"
        )
    count, labelled = names.labelled(node.label)
    if count:
        message = f"no object node is exactly {str(node)!r}; with that label there are"
        raise error_with_candidates(message, names, count, most_similar_first(node, labelled, names), wording)
    raise unknown_error(f"no object node has the label {node.label!r}", node, names, wording)


def nodes_beginning(start: str, names: NodeNames, max_nodes: int) -> list[int]:
    """Return the ids of nodes whose one-line notation or label begins with ``start``, in order of labels.

    At most ``max_nodes`` are returned. The text before the first semicolon is a whole label. Without a
    semicolon, ``start`` is the beginning of a label. The label may be in quotes.
    """
    label, semicolon, _ = start.partition(";")
    labels = [label] if semicolon else []
    if quoted := _IN_QUOTES.match(start):
        label = unquoted(quoted[0].strip(" ") + '"' * (not quoted[1]))
        labels = [label] if quoted[1] else [*names.beginning(label, max_nodes)]
    nodes: dict[int, None] = {}
    for candidate in dict.fromkeys([*labels, *names.beginning(start, max_nodes)]):
        for o in names.labelled(candidate)[1]:
            if candidate.startswith(start) or str(names.node(o)).startswith(start):
                nodes[o] = None
        if len(nodes) >= max_nodes:
            break
    return [*nodes][:max_nodes]


def entry_names(goal_entries: Sequence[ListedObject], names: NodeNames) -> Iterator[str]:
    """Yield a name for each entry of a goals file, by which :func:`find_goal` finds the node of the entry.

    The name is the label of the entry. If the label also means another node, the name is the one-line
    notation of the entry's node. An entry that does not match exactly one node has its label in any case.
    """
    counts = Counter(entry.pattern.label for entry in goal_entries)
    for entry in goal_entries:
        label = entry.pattern.label
        nodes = names.find(entry.pattern)
        bare_node = names.object_id(ObjectNode(label))
        if len(nodes) != 1 or (counts[label] == 1 and bare_node in {None, nodes[0]}):
            yield str(ObjectNode(label))
        else:
            yield str(names.node(nodes[0]))


def node_of_entry(entry: ListedObject, names: NodeNames) -> int:
    """Return the id of the only node that matches an entry of a goals file.

    Raises :class:`GoalError` if no node or several nodes match.
    """
    nodes = nodes_of_entry(entry, names)
    return _only_node(str(entry.pattern), names, len(nodes), nodes, GOAL)


def nodes_of_entry(entry: ListedObject, names: NodeNames) -> Sequence[int]:
    """Return the ids of the nodes that match an entry of a goals file.

    Raises :class:`GoalError` with similar candidates if no node matches.
    """
    nodes = names.find(entry.pattern)
    if not nodes:
        count, labelled = names.labelled(entry.pattern.label)
        position = f"{entry.source}:{entry.source.column}"
        message = f"{position}: error: the goal {str(entry.pattern)!r} matches no object node"
        if count:
            raise error_with_candidates(f"{message}; with that label there are", names, count, labelled, GOAL)
        raise unknown_error(f"{message} of the network", ObjectNode(entry.pattern.label), names, GOAL)
    return nodes


def _only_node(name: str, names: NodeNames, count: int, nodes: Sequence[int], wording: Wording) -> int:
    """Return the only one of ``nodes``; raises :class:`GoalError` with candidates if there are several.

    ``count`` is the number of nodes that ``name`` means. ``nodes`` are their ids, or only the first ones.
    """
    if count > 1:
        message = f"the {wording.noun} {name!r} means {count} object nodes"
        raise error_with_candidates(f"{message}; paste the one you mean", names, count, nodes, wording)
    return nodes[0]
