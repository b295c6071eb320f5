"""What a FOON is: object nodes, functional units, the merged network, task trees."""

from foon_asp.network.functional_unit import FunctionalUnit
from foon_asp.network.level import (
    LEVELS,
    network_at_level,
    node_at_level,
    pattern_at_level,
    unit_at_level,
)
from foon_asp.network.network import Network, NetworkBuilder
from foon_asp.network.node_pattern import NodePattern
from foon_asp.network.object_node import Contents, ObjectNode, Relation
from foon_asp.network.source import Source
from foon_asp.network.task_tree import TaskTree
from foon_asp.network.unit_prices import UnitPrices

__all__ = [
    "LEVELS",
    "Contents",
    "FunctionalUnit",
    "Network",
    "NetworkBuilder",
    "NodePattern",
    "ObjectNode",
    "Relation",
    "Source",
    "TaskTree",
    "UnitPrices",
    "network_at_level",
    "node_at_level",
    "pattern_at_level",
    "unit_at_level",
]
