"""FOON text and the tables beside it, in and out."""

from foon_asp.text.data_folder import (
    Data,
    DataFiles,
    find_data,
    kitchen_item_warning,
    kitchen_nodes,
    network_files,
    read_data,
    unit_price_warning,
    unit_prices,
)
from foon_asp.text.diagnostics import Diagnostic, InputError, Severity, excerpt_with_caret, summarize
from foon_asp.text.exact_price import decimal_text
from foon_asp.text.goal_name import (
    GoalError,
    NodeNames,
    SomeNames,
    Wording,
    find_goal,
    listed_nodes,
    nodes_beginning,
    notation,
)
from foon_asp.text.label_list import read_labels
from foon_asp.text.line import LineError, parse_node
from foon_asp.text.object_list import ListedObject, read_object_list
from foon_asp.text.plain_file import STORE_MAGIC, STORE_SUFFIX, is_store, read_plain_text
from foon_asp.text.rate_table import read_rates
from foon_asp.text.reader import FoonReader
from foon_asp.text.unit_price_list import UnitPriceList, read_unit_prices, write_unit_prices
from foon_asp.text.writer import write_units

__all__ = [
    "STORE_MAGIC",
    "STORE_SUFFIX",
    "Data",
    "DataFiles",
    "Diagnostic",
    "FoonReader",
    "GoalError",
    "InputError",
    "LineError",
    "ListedObject",
    "NodeNames",
    "Severity",
    "SomeNames",
    "UnitPriceList",
    "Wording",
    "decimal_text",
    "excerpt_with_caret",
    "find_data",
    "find_goal",
    "is_store",
    "kitchen_item_warning",
    "kitchen_nodes",
    "listed_nodes",
    "network_files",
    "nodes_beginning",
    "notation",
    "parse_node",
    "read_data",
    "read_labels",
    "read_object_list",
    "read_plain_text",
    "read_rates",
    "read_unit_prices",
    "summarize",
    "unit_price_warning",
    "unit_prices",
    "write_unit_prices",
    "write_units",
]
