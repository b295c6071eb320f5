"""Assumed goals of networks without a list of goals: nodes marked with ``!``, or outputs of last units."""

from collections.abc import Iterable, Mapping, Sequence

from foon_asp.network import Network, NodePattern, ObjectNode, Source
from foon_asp.text.object_list import ListedObject

MARKED, LAST = "marked", "last"


def final_outputs(inputs: Sequence[int], outputs: Sequence[int], needed: Iterable[int]) -> list[int]:
    """Return the final outputs of the last unit of a file: its outputs that no unit needs.

    If every output is needed, return the outputs that are not among ``inputs``. If there are none either,
    return all ``outputs``.

    All arguments are ids of nodes. ``inputs`` and ``outputs`` are those of the last unit; ``needed`` are the
    inputs of all units.
    """
    needed = set(needed)
    return [o for o in outputs if o not in needed] or [o for o in outputs if o not in inputs] or [*outputs]


def goal_entry(node: ObjectNode, source: Source) -> ListedObject:
    """Return an entry of a goals file that matches only this node.

    The entry has the ``source``, but without its videos.
    """
    return ListedObject(NodePattern.of(node), source._replace(videos=()))


def last_goals(network: Network, last_units: Mapping[int, Source]) -> list[ListedObject]:
    """Return the final outputs of the last unit of each file, each once, as entries of a goals file.

    ``last_units`` maps the id of the last unit of each file to its source. If a node is a final output of
    several units, its entry has the source of the first of them.
    """
    outputs = {o for unit in last_units for o in network.outputs[unit]}
    needed = {o for inputs in network.inputs for o in inputs if o in outputs}
    goal_sources: dict[int, Source] = {}
    for unit, source in last_units.items():
        for o in final_outputs(network.inputs[unit], network.outputs[unit], needed):
            goal_sources.setdefault(o, source)
    return [goal_entry(network.objects[o], source) for o, source in goal_sources.items()]
