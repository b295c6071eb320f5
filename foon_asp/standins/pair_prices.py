"""Prices of many stand-ins, computed fast and in integers, without the edits that explain them."""

import math
from collections import Counter, defaultdict
from fractions import Fraction

from foon_asp.network import Edit, Network, ObjectNode, Relation, StandInTable, spelled_alike, spelling_key


class NodePrices:
    """For each node of a network, the prices at which a table lets other nodes stand in for it.

    Prices are whole numbers: the exact prices times ``scale``, their common denominator.
    """

    def __init__(self, network: Network, table: StandInTable) -> None:
        """Scale the prices of the table to integers, and index its pairs and the spellings of labels."""
        prices = (*table.edits.values(), *table.words.values(), *table.pairs.values())
        self.scale = math.lcm(*(price.denominator for price in prices if price is not None))
        self._objects, self._by_label = network.objects, network.by_label
        self._edits = {edit: self._scaled(price) for edit, price in table.edits.items()}
        self._words = {word: self._scaled(price) for word, price in table.words.items()}
        self._pairs = {pair: self._scaled(price) for pair, price in table.pairs.items()}
        self._labels_serving: defaultdict[str, list[str]] = defaultdict(list)  # that serve a label
        self._nodes_serving: defaultdict[ObjectNode, list[int]] = defaultdict(list)  # that serve a node
        for serving, served in table.pairs:
            if isinstance(served, str) and isinstance(serving, str):
                self._labels_serving[served].append(serving)
            elif isinstance(served, ObjectNode) and isinstance(serving, ObjectNode):
                number = network.object_id(serving)
                if number is not None:
                    self._nodes_serving[served].append(number)
        self._labels_by_spelling: defaultdict[str, list[str]] = defaultdict(list)
        for label in network.by_label:
            self._labels_by_spelling[spelling_key(label)].append(label)
        self._servers: dict[int, dict[int, int]] = {}

    def _scaled(self, price: Fraction | None) -> int | None:
        """Return a price times ``scale``; ``None`` for ``None``."""
        return None if price is None else int(price * self.scale)

    def servers_of(self, served: int) -> dict[int, int]:
        """Return the price of each node, by id, that may stand in for the node ``served``; cached.

        ``served`` is an id and is omitted itself.
        """
        servers = self._servers.get(served)
        if servers is None:
            servers = self._servers[served] = self.servers_of_node(self._objects[served])
        return servers

    def servers_of_node(self, node: ObjectNode) -> dict[int, int]:
        """Return the price of each node of the network, by id, that may stand in for ``node``.

        ``node`` may be of another network. If it is in the network, it is omitted itself.
        """
        objects, by_label = self._objects, self._by_label
        labels = (
            *self._labels_by_spelling.get(spelling_key(node.label), ()),
            *self._labels_serving.get(node.label, ()),
        )
        nodes = dict.fromkeys(o for label in labels for o in by_label.get(label, ()))
        nodes |= dict.fromkeys(self._nodes_serving.get(node, ()))
        prices = ((o, self.price(objects[o], node)) for o in nodes if objects[o] != node)
        return {o: price for o, price in prices if price is not None}

    def price(self, serving: ObjectNode, served: ObjectNode) -> int | None:
        """Return the price of using ``serving`` in place of ``served``; ``None`` if the table forbids it.

        If the table lists this pair of nodes, its entry decides. Otherwise, the prices of all differences
        between the nodes are added up. The price is a whole number, in units of ``1 / scale``.
        """
        if self._pairs and (serving, served) in self._pairs:
            return self._pairs[serving, served]
        total = 0
        label, states, relations, contents = serving
        served_label, served_states, served_relations, served_contents = served
        if label != served_label:
            is_listed = (label, served_label) in self._pairs or not spelled_alike(label, served_label)
            price = self._pairs.get((label, served_label)) if is_listed else self._edits[Edit.SPELLING]
            if price is None:
                return None
            total += price
        if contents != served_contents:
            price = self._contents_price(serving.ingredients, served.ingredients)
            if price is None:
                return None
            total += price
        if states != served_states:
            for edit, names in (
                (Edit.FEWER_STATE, served_states - states),
                (Edit.MORE_STATE, states - served_states),
            ):
                for name in names:
                    price = self._name_price(edit, name)
                    if price is None:
                        return None
                    total += price
        if relations != served_relations:
            price = self._relations_price(relations, served_relations)
            if price is None:
                return None
            total += price
        return total

    def _name_price(self, edit: Edit, name: str) -> int | None:
        """Return the price of an edit that adds or removes a name; ``None`` if the table forbids it.

        The name is a state or an ingredient. If the table has a price for this name and edit, return this
        price. Otherwise, return the price of the edit.
        """
        price = self._words.get((edit, name), -1)
        return self._edits[edit] if price == -1 else price

    def _contents_price(
        self, ingredients: tuple[str, ...], served_ingredients: tuple[str, ...]
    ) -> int | None:
        """Return the price of the differences between two contents, given by their ingredients.

        If the ingredients are equal, the contents differ in a word such as *in*. The price of
        :attr:`Edit.CONTENTS` is added if at most half of the ingredients of the longer list are in both.
        Return ``None`` if the table forbids a difference.
        """
        if ingredients == served_ingredients:
            return self._edits[Edit.WORD]
        total = 0
        larger = max(len(ingredients), len(served_ingredients))
        if 2 * min(len(ingredients), len(served_ingredients)) <= larger:
            price = self._edits[Edit.CONTENTS]
            if price is None:
                return None
            total = price
        counts, served_counts = Counter(ingredients), Counter(served_ingredients)
        common = counts & served_counts
        if not total and 2 * common.total() <= larger:
            price = self._edits[Edit.CONTENTS]
            if price is None:
                return None
            total = price
        for edit, differing in (
            (Edit.MORE_INGREDIENT, counts - common),
            (Edit.FEWER_INGREDIENT, served_counts - common),
        ):
            for name, count in differing.items():
                price = self._name_price(edit, name)
                if price is None:
                    return None
                total += price * count
        return total

    def _relations_price(
        self, relations: frozenset[Relation], served_relations: frozenset[Relation]
    ) -> int | None:
        """Return the price of the differences between two sets of relations.

        If both sets have a container, but with other words such as *on*, the price of a word is added. If
        only one set has a container, the price of a container is added. A container in place of another
        counts once. Return ``None`` if the table forbids a difference.
        """
        surplus = Counter(relation.object for relation in relations - served_relations)
        lacking = Counter(relation.object for relation in served_relations - relations)
        word_changes = (surplus & lacking).total()
        container_changes = max(surplus.total(), lacking.total()) - word_changes
        word, container = self._edits[Edit.WORD], self._edits[Edit.CONTAINER]
        if (word_changes and word is None) or (container_changes and container is None):
            return None
        return word_changes * (word or 0) + container_changes * (container or 0)
