"""What is in data, counted at each level of detail."""

from foon_asp.network import LEVELS, network_at_level
from foon_asp.network.statistics import Statistics, count
from foon_asp.text.data_folder import Data, kitchen_nodes


def count_levels(data: Data) -> list[Statistics]:
    """Count what is in a network, with what cannot be made from its kitchen, at the levels 1 to 3."""
    counted = []
    for level in LEVELS:
        network = network_at_level(data.network, level)
        kitchen = kitchen_nodes(network, data.kitchen_items) if data.kitchen_items else None
        counted.append(count(network, kitchen))
    return counted
