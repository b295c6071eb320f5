"""Errors for names that mean no object node, or several, with candidates to paste."""

import shlex
from collections.abc import Iterable, Sequence
from typing import NamedTuple

from foon_asp.errors import UserError
from foon_asp.network import ObjectNode
from foon_asp.text.node_names import NodeNames

_MAX_CANDIDATES = 12  # candidates in a message


class Wording(NamedTuple):
    """The words for a node in messages: a noun, and the option that precedes each candidate to paste."""

    noun: str
    option: str


GOAL = Wording("goal", "--goal")


class GoalError(UserError):
    """A name that means no object node, or several.

    ``message`` is without candidates. ``candidates`` are the candidates shown, in one-line notation.
    ``hidden`` counts the candidates that are not shown. The text of the error has the candidates ready to
    paste, behind ``option``.
    """

    def __init__(
        self, message: str, candidates: Sequence[str] = (), hidden: int = 0, option: str = GOAL.option
    ) -> None:
        lines = [message, *(f"  {option} {shlex.quote(candidate)}" for candidate in candidates)]
        if hidden:
            lines.append(f"  ... and {hidden} more")
        super().__init__("\n".join(lines))
        self.message, self.candidates, self.hidden = message, tuple(candidates), hidden


def most_similar_first(node: ObjectNode, nodes: Sequence[int], names: NodeNames) -> Sequence[int]:
    """Return ids of nodes sorted by similarity of their notation to that of ``node``.

    If ``node`` is a label alone, the order of ``nodes`` stays.
    """
    if node == ObjectNode(node.label):
        return nodes
    import difflib  # noqa: PLC0415 (only for error messages)

    by_notation = {str(names.node(o)): o for o in nodes}
    return [
        by_notation[text]
        for text in difflib.get_close_matches(str(node), by_notation, len(by_notation), cutoff=0)
    ]


def unknown_error(message: str, node: ObjectNode, names: NodeNames, wording: Wording) -> GoalError:
    """Return the error about an unknown node, with some nodes of each similar label as candidates.

    Labels are similar if they begin with the label of the node, or are spelled nearly like it. Each label has
    an equal share of the twelve candidates. Without a similar label, the error has only the message.
    """
    labels = dict.fromkeys((*names.beginning(node.label, _MAX_CANDIDATES), *names.near(node.label, 3)))
    counted_nodes = [names.labelled(label) for label in labels]
    if not counted_nodes:
        return GoalError(message)
    nodes_per_label = max(1, _MAX_CANDIDATES // len(counted_nodes))
    total = sum(count for count, _ in counted_nodes)
    candidates = [
        o for _, nodes in counted_nodes for o in most_similar_first(node, nodes, names)[:nodes_per_label]
    ]
    return error_with_candidates(f"{message}; similar are", names, total, candidates, wording)


def error_with_candidates(
    message: str, names: NodeNames, count: int, candidates: Iterable[int], wording: Wording
) -> GoalError:
    """Return an error with up to twelve of the candidates, which are ids of nodes.

    ``count`` is the number of all candidates, of which only some may be given. The error says how many it
    does not show.
    """
    shown = [str(names.node(o)) for o in [*candidates][:_MAX_CANDIDATES]]
    return GoalError(message, shown, count - len(shown), wording.option)
