"""The starting kitchen: what somebody has to have before anything is made."""

from foon_asp.network.network import Network


def starting_nodes(network: Network) -> frozenset[int]:
    """Give the ids of the nodes that no unit makes out of others: none does, or those only hand them on.

    A unit hands on what is among its inputs and its outputs. This holds under both container rules: under
    ``implied`` a unit does not make what it took as given.
    """
    made: set[int] = set()
    for inputs, outputs in zip(network.inputs, network.outputs, strict=True):
        made.update(o for o in outputs if o not in inputs)
    return frozenset(range(len(network.objects))).difference(made)
