"""Statistics of data at each level of FOON."""

from foon_asp.network import LEVELS, network_at_level
from foon_asp.network.statistics import Statistics, network_statistics
from foon_asp.text.data_folder import Data, kitchen_nodes


def statistics_by_level(data: Data) -> list[Statistics]:
    """Return the statistics of a network and its kitchen at the levels 1, 2 and 3, in this order.

    At each level, nodes are merged, and the kitchen items are matched again or the starting kitchen is
    determined again. For a network below level 3, return only its statistics at its own level.
    """
    network = data.network
    networks = (
        [network] if network.level < max(LEVELS) else [network_at_level(network, level) for level in LEVELS]
    )
    return [
        network_statistics(
            network_of_level, None if data.starting else kitchen_nodes(network_of_level, data.kitchen_items)
        )
        for network_of_level in networks
    ]
