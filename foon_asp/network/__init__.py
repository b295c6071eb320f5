"""What a FOON is: object nodes, functional units, the merged network, task trees."""

from foon_asp.network.functional_unit import FunctionalUnit
from foon_asp.network.network import Network, NetworkBuilder
from foon_asp.network.node_pattern import NodePattern
from foon_asp.network.object_node import Contents, ObjectNode, Relation
from foon_asp.network.source import Source
from foon_asp.network.task_tree import TaskTree

__all__ = [
    "Contents",
    "FunctionalUnit",
    "Network",
    "NetworkBuilder",
    "NodePattern",
    "ObjectNode",
    "Relation",
    "Source",
    "TaskTree",
]
