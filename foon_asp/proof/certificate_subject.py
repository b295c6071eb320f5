"""The subject of a certificate: the data that it is about, and the digests of this data."""

from collections.abc import Callable, Collection, Iterable, Mapping
from fractions import Fraction
from types import MappingProxyType
from typing import Any, NamedTuple

from foon_asp.network import Amounts, Network, StandInTable, UnitPrices
from foon_asp.proof.canonical_json import canonical_json, digest_of
from foon_asp.proof.rule_meaning import Rule, sources_read
from foon_asp.proof.stand_ins import stand_in_price_data


class Subject(NamedTuple):
    """The data that a certificate is about.

    ``network``: the network; units and nodes are given by id.
    ``kitchen``: the nodes that are available at first.
    ``rates``: the success rate of each motion; ``None`` if unknown.
    ``utensils``: the labels of utensils.
    ``prices``: the prices of motions and units; ``None`` if unknown.
    ``stated``: digests by name that are used as they are, in place of computed ones.
    ``trusted``: the names of stated digests that nobody computed from the data.
    ``amounts``: the amounts of inputs and outputs, which only plans read.
    ``stand_ins``: the table by which stand-ins were added to the network; ``None`` without stand-ins.
    """

    network: Network
    kitchen: Collection[int]
    rates: Mapping[str, Fraction] | None
    utensils: frozenset[str]
    prices: UnitPrices | None = None
    stated: Mapping[str, str] = MappingProxyType({})
    trusted: tuple[str, ...] = ()
    amounts: Amounts = MappingProxyType({})
    stand_ins: StandInTable | None = None

    def digests(self, rules: Iterable[Rule] = ()) -> dict[str, str]:
        """Return the SHA-256 digests of the data, by name, as a certificate with these rules states them.

        A digest in ``stated`` is returned as it is. The digest of sources covers only the parts of sources
        that the rules read.
        """
        return {
            name: self.stated.get(name) or digest_of(value())
            for name, value in self._digest_data(rules).items()
        }

    def canonical_data(self, rules: Iterable[Rule] = (), goals: Iterable[int] = ()) -> str:
        """Return all data that a certificate with these rules and goals depends on, as canonical JSON.

        It is an object. For the name of each digest, it has the data that the digest is computed from, also
        if the digest is in ``stated``. Under ``goals``, it has a pair of id and text for each goal.
        """
        values = {name: value() for name, value in self._digest_data(rules).items()}
        return canonical_json(
            {**values, "goals": [(goal, str(self.network.objects[goal])) for goal in goals]}
        )

    def _digest_data(self, rules: Iterable[Rule]) -> dict[str, Callable[[], object]]:
        """Return for each digest, by name, a function that returns the data to be digested.

        Without a table of stand-ins, there is no digest ``stand-ins``.
        """
        network, rates, prices = self.network, self.rates, self.prices
        sources = [read for rule in rules if (read := sources_read(rule, network)) is not None]
        table = self.stand_ins
        return {
            **({} if table is None else {"stand-ins": lambda: stand_in_price_data(table)}),
            "network": lambda: _network_data(network),
            "kitchen": lambda: sorted(self.kitchen),
            "rates": lambda: rates and sorted([motion, str(rate)] for motion, rate in rates.items()),
            "utensils": lambda: sorted(self.utensils),
            "prices": lambda: prices and _price_data(prices, network.detailed or network),
            "sources": lambda: sources or None,
        }


def _network_data(network: Network) -> list[Any]:
    """Return all that a claim about a network can depend on, except sources, as lists that JSON can write.

    Below level 3, the network of level 3 is included.
    """
    nodes = [
        (label, sorted(states), sorted(relations), contents)
        for label, states, relations, contents in network.objects
    ]
    below = [] if network.detailed is None else [_network_data(network.detailed), network.stands_for]
    return [network.level, nodes, network.motions, network.inputs, network.outputs, *below]


def _price_data(prices: UnitPrices, network: Network) -> list[list[Any]]:
    """Return two sorted lists of pairs: motions and their prices, and unit ids and their prices.

    Ids are those of ``network``; units that it does not have are omitted.
    """
    ids = ((network.unit_id(unit), price) for unit, price in prices.units.items())
    single = sorted([unit, str(price)] for unit, price in ids if unit is not None)
    return [sorted([motion, str(price)] for motion, price in prices.motions.items()), single]
