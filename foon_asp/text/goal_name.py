"""Finding the object node that a goal's name means."""

import difflib
import shlex
from collections.abc import Iterable, Sequence

from foon_asp.errors import UserError
from foon_asp.network import Network, node_at_level
from foon_asp.text.line import LineError, parse_node
from foon_asp.text.object_list import ListedObject

_SHOWN = 12


def find_goal(name: str, network: Network, listed: Sequence[ListedObject] = ()) -> int:
    """Give the id of the object node that a goal names.

    A name is a label (of an entry of the goals file first, then of the network's nodes) or the one-line
    notation ``sweet potato; chopped; in [cutting board]``; a semicolon at the end (``onion;``) makes the
    notation of a node that is only a label. Raises :class:`UserError` with candidates ready
    to paste when it is unknown or means several nodes.
    """
    try:
        node = node_at_level(parse_node(name), network.level)
    except LineError as error:
        raise UserError(f"the goal {name!r} cannot be read: at column {error.column}, {error}") from None
    bare = ";" not in name
    entries = [entry for entry in listed if bare and entry.pattern.label == node.label]
    if entries:
        return _only(name, network, [o for entry in entries for o in listed_nodes(entry, network)])
    if bare and node.label in network.by_label:
        return _only(name, network, network.by_label[node.label])
    exact = network.object_id(node)
    if exact is not None:
        return exact
    labelled = network.by_label.get(node.label, ())
    if labelled:
        raise UserError(
            f"no object node is exactly {str(node)!r}; with that label there are\n" + _list(network, labelled)
        )
    lower = {label.lower(): label for label in network.by_label}
    found = difflib.get_close_matches(node.label.lower(), lower, n=3, cutoff=0.6)
    near = [lower[name] for name in found]
    message = f"no object node has the label {node.label!r}"
    if near:
        candidates = [o for label in near for o in network.by_label[label]]
        message += "; similar are\n" + _list(network, candidates)
    raise UserError(message)


def listed_nodes(entry: ListedObject, network: Network) -> tuple[int, ...]:
    """Give the nodes that an entry of a goals file stands for; raises :class:`UserError` for none."""
    found = network.find(entry.pattern)
    if not found:
        labelled = network.by_label.get(entry.pattern.label, ())
        raise UserError(
            f"{entry.source.file}:{entry.source.line}:{entry.source.column}: error: the goal "
            f"{str(entry.pattern)!r} matches no object node"
            + ("; with that label there are\n" + _list(network, labelled) if labelled else " of the network")
        )
    return found


def _only(name: str, network: Network, candidates: Iterable[int]) -> int:
    found = list(dict.fromkeys(candidates))
    if len(found) > 1:
        raise UserError(
            f"the goal {name!r} means {len(found)} object nodes; paste the one you mean\n"
            + _list(network, found)
        )
    return found[0]


def _list(network: Network, nodes: Sequence[int]) -> str:
    names = (str(network.objects[o]) for o in nodes[:_SHOWN])
    lines = [f"  --goal {shlex.quote(name if ';' in name else name + ';')}" for name in names]
    if len(nodes) > _SHOWN:
        lines.append(f"  ... and {len(nodes) - _SHOWN} more")
    return "\n".join(lines)
