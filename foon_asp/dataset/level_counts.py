"""Statistics of data at each level of FOON."""

from foon_asp.network import LEVELS, network_at_level
from foon_asp.network.statistics import Statistics, network_statistics
from foon_asp.text.data_folder import Data, kitchen_nodes


def statistics_by_level(data: Data) -> list[Statistics]:
    """Return the statistics of a network and its kitchen at the levels 1, 2 and 3, in this order.

    At each level, nodes are merged and the kitchen items are matched again. For a network below level 3,
    return only its statistics at its own level.
    """
    whole = data.network
    networks = [whole] if whole.level < max(LEVELS) else [network_at_level(whole, level) for level in LEVELS]
    return [
        network_statistics(network, None if data.starting else kitchen_nodes(network, data.kitchen_items))
        for network in networks
    ]
