"""The goals of networks that come without a list of goals: marked with ``!``, or what the last unit makes."""

from collections.abc import Iterable, Mapping, Sequence

from foon_asp.network import Network, NodePattern, ObjectNode, Source
from foon_asp.text.object_list import ListedObject

MARKED, LAST = "marked", "last"


def wanted_outputs(inputs: Sequence[int], outputs: Sequence[int], needed: Iterable[int]) -> list[int]:
    """Return what the last unit of a file is for, of the ids on its sides: the outputs that no unit needs.

    ``needed`` are those of the outputs that some unit has among its inputs. Where these are all, it is what
    the unit was not given itself, and all of it where there is nothing else.
    """
    needed = set(needed)
    return [o for o in outputs if o not in needed] or [o for o in outputs if o not in inputs] or [*outputs]


def as_entry(node: ObjectNode, source: Source) -> ListedObject:
    """Return a node as an entry of a goals file would name it; ``source`` is where it was read."""
    return ListedObject(NodePattern.of(node), source._replace(videos=()))


def last_goals(network: Network, last_units: Mapping[int, Source]) -> list[ListedObject]:
    """Return what the last units, by id with their places, are for: as entries of a goals file."""
    outputs = {o for unit in last_units for o in network.outputs[unit]}
    needed = {o for inputs in network.inputs for o in inputs if o in outputs}
    found: dict[int, Source] = {}
    for unit, place in last_units.items():
        for o in wanted_outputs(network.inputs[unit], network.outputs[unit], needed):
            found.setdefault(o, place)
    return [as_entry(network.objects[o], source) for o, source in found.items()]
