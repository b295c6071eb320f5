"""The parts of a FOON: object nodes, functional units, the merged network, task trees."""

from foon_asp.network.counted import counted as counted
from foon_asp.network.functional_unit import FunctionalUnit as FunctionalUnit
from foon_asp.network.level import LEVELS as LEVELS
from foon_asp.network.level import network_at_level as network_at_level
from foon_asp.network.level import node_at_level as node_at_level
from foon_asp.network.level import pattern_at_level as pattern_at_level
from foon_asp.network.level import unit_at_level as unit_at_level
from foon_asp.network.network import Network as Network
from foon_asp.network.network import NetworkBuilder as NetworkBuilder
from foon_asp.network.node_pattern import NodePattern as NodePattern
from foon_asp.network.object_node import Contents as Contents
from foon_asp.network.object_node import ObjectNode as ObjectNode
from foon_asp.network.object_node import Relation as Relation
from foon_asp.network.quoted_name import in_quotes as in_quotes
from foon_asp.network.quoted_name import unquoted as unquoted
from foon_asp.network.source import Source as Source
from foon_asp.network.starting import StartingKitchen as StartingKitchen
from foon_asp.network.starting import starting_kitchen as starting_kitchen
from foon_asp.network.starting import starting_nodes as starting_nodes
from foon_asp.network.task_tree import TaskTree as TaskTree
from foon_asp.network.unit_amounts import MAX_AMOUNT as MAX_AMOUNT
from foon_asp.network.unit_amounts import NO_AMOUNTS as NO_AMOUNTS
from foon_asp.network.unit_amounts import Amounts as Amounts
from foon_asp.network.unit_amounts import DataAmounts as DataAmounts
from foon_asp.network.unit_amounts import UnitAmounts as UnitAmounts
from foon_asp.network.unit_prices import UnitPrices as UnitPrices
