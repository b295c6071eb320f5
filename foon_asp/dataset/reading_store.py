"""Opening a store as a dataset."""

import time

from foon_asp.dataset.dataset import Dataset, left_out_warning
from foon_asp.dataset.kitchen import Kitchen
from foon_asp.dataset.prices import DataPrices
from foon_asp.dataset.store_source import StoreSource
from foon_asp.errors import UserError
from foon_asp.network import is_starting, network_at_level, pattern_at_level, starting_kitchen
from foon_asp.problem import unrated_remarks
from foon_asp.store.store import Store
from foon_asp.text.data_folder import (
    Data,
    DataFiles,
    kitchen_item_warning,
    kitchen_nodes,
    unit_price_warning,
)
from foon_asp.text.diagnostics import brief_summary, summarize
from foon_asp.text.object_list import read_object_list
from foon_asp.text.repeated_node import repeated_note
from foon_asp.text.tables import RATES, read_utensils
from foon_asp.text.unit_amount_list import UNIT_AMOUNTS
from foon_asp.text.unit_price_list import read_unit_prices


def read_store(files: DataFiles, level: int) -> Dataset:
    """Open the store that is named as the network; other named files replace what was imported.

    Below level 3, the whole store is read and closed, since nodes are merged at such a level. There are
    remarks about entries of the named files that match nothing in the store. Other remarks are about motions
    without a success rate, nodes that a unit lists twice, and lines that were left out of the store. Raises
    :class:`UserError` if a second network is named.
    """
    if len(files.network) > 1:
        raise UserError(
            f"{files.network[0]} and {files.network[1]}: a store is read alone; import "
            "the files together into one"
        )
    began = time.perf_counter()
    store = Store(files.network[0])
    source = StoreSource(store, UNIT_AMOUNTS.rows(files.unit_amounts) if files.unit_amounts else ())
    warnings = source.unmatched_amounts
    prices = source.prices
    if files.unit_prices:
        price_list = read_unit_prices(files.unit_prices)
        matched_prices = {
            unit: price for unit, price in price_list.units.items() if store.unit_id(unit) is not None
        }
        warnings += [
            unit_price_warning(unit, price_list.sources[unit])
            for unit in price_list.units.keys() - matched_prices.keys()
        ]
        prices = DataPrices(price_list.motions, matched_prices)
    dataset = Dataset(
        source,
        Kitchen(source.kitchen),
        read_object_list(files.goals, warnings) if files.goals else store.goals,
        RATES.read(files.rates) if files.rates else store.rates,
        read_utensils(files.utensils) if files.utensils else store.utensils,
        prices,
        kitchen_items=None,
        goals_from="" if files.goals else store.goals_from,
        stock=store.stock,
    )
    if is_starting(files.kitchen) and not (files.kitchen is None and store.has_kitchen):
        dataset = dataset.with_starting_kitchen()
    elif files.kitchen:
        kitchen = read_object_list(files.kitchen, warnings)
        warnings += [kitchen_item_warning(item) for item in kitchen if not store.find(item.pattern)]
        dataset = dataset.with_kitchen(kitchen)
    remarks = [] if dataset.rates is None else [*unrated_remarks(store.motion_sources(), dataset.rates)]
    if store.left_out:
        remarks.append(f"{left_out_warning(store.left_out)} when the store was made")
    remarks += repeated_note(store.repeated)
    if level < 3:
        dataset = Dataset.of(_data_at_level(dataset.data, level))
        store.close()
    dataset.source.seconds = time.perf_counter() - began
    return dataset.with_remarks(
        summarize(warnings), brief_summary(warnings), remarks, files.kitchen is not None or store.has_kitchen
    )


def _data_at_level(data: Data, level: int) -> Data:
    """Return data reduced to a level, with the kitchen and the goals matched at that level."""
    network = network_at_level(data.network, level)
    goals = tuple(entry._replace(pattern=pattern_at_level(entry.pattern, level)) for entry in data.goals)
    kitchen = starting_kitchen(network).nodes if data.starting else kitchen_nodes(network, data.kitchen_items)
    return data._replace(network=network, kitchen=kitchen, goals=goals)
