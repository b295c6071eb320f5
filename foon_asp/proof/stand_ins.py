"""Check, for certificates, that a network has the stand-ins that its table asks for.

A stand-in is a unit that uses an available node in place of one that cannot be made. docs/stand-ins.md argues
why no other stand-in can be in a best tree. Prices are computed here anew, without the code that adds
stand-ins.
"""

from collections import Counter, deque
from collections.abc import Callable, Collection, Iterator, Sequence
from fractions import Fraction
from heapq import heapify, heappop, heappush
from typing import NamedTuple

from foon_asp.network import STAND_IN, Edit, Network, ObjectNode, StandInTable

Sides = Callable[[int], Collection[int | None]]  # from a unit to ids of nodes


class Actions(NamedTuple):
    """The kitchen, and functions from a unit to its preconditions (``needs``) and add effects (``gives``).

    Nodes are given by id; ``None`` stands for a node that is not in the network.
    """

    kitchen: Collection[int]
    needs: Sides
    gives: Sides


class StandInClaim(NamedTuple):
    """The part of a certificate's claim that concerns stand-ins.

    ``by_dissimilarity``: ``True`` if there are no rules, and the first objective, if any, is dissimilarity.
    ``bound``: the claimed lower bound on the dissimilarity of trees. ``None`` if the claim has no such bound,
    or if the claim is that there is no tree.
    """

    by_dissimilarity: bool
    bound: Fraction | None


def stand_in_price_data(table: StandInTable) -> list[list[str]]:
    """Return the prices of a table as sorted lists of texts, for the digest of a certificate.

    There are four kinds of lists: an edit and its price; an edit, a word and its price; ``label``, two labels
    and their price; ``node``, two nodes and their price. The price is ``None`` if the table forbids the
    difference.
    """
    edits = [[str(edit), str(price)] for edit, price in table.edits.items()]
    words = [[str(edit), word, str(price)] for (edit, word), price in table.words.items()]
    kind_names = {str: "label", ObjectNode: "node"}
    pairs = [
        [kind_names[type(serving)], str(serving), str(served), str(price)]
        for (serving, served), price in table.pairs.items()
    ]
    return sorted((*edits, *words, *pairs))


def price_of(table: StandInTable, serving: ObjectNode, served: ObjectNode) -> Fraction | None:
    """Return the price of using ``serving`` in place of ``served``; ``None`` if the table forbids it.

    If the table lists this pair of nodes, its entry decides. Otherwise, the prices of all differences between
    the nodes are added up. A difference without a price makes the pair forbidden.
    """
    if (serving, served) in table.pairs:
        return table.pairs[serving, served]
    prices: list[Fraction | None] = []
    labels = serving.label, served.label
    if serving.label != served.label:
        same_word = labels not in table.pairs and _singular_word(serving.label) == _singular_word(
            served.label
        )
        prices.append(table.edits[Edit.SPELLING] if same_word else table.pairs.get(labels))
    ingredients, other_ingredients = Counter(serving.ingredients), Counter(served.ingredients)
    shared = (ingredients & other_ingredients).total()
    if ingredients != other_ingredients and max(ingredients.total(), other_ingredients.total()) >= 2 * shared:
        prices.append(table.edits[Edit.CONTENTS])
    if serving.contents != served.contents and ingredients == other_ingredients:
        prices.append(table.edits[Edit.WORD])
    word_edits = [
        *((Edit.MORE_INGREDIENT, name) for name in (ingredients - other_ingredients).elements()),
        *((Edit.FEWER_INGREDIENT, name) for name in (other_ingredients - ingredients).elements()),
        *((Edit.MORE_STATE, state) for state in serving.states - served.states),
        *((Edit.FEWER_STATE, state) for state in served.states - serving.states),
    ]
    prices += [table.words.get(word_edit, table.edits[word_edit[0]]) for word_edit in word_edits]
    containers = Counter(relation.object for relation in serving.relations - served.relations)
    other_containers = Counter(relation.object for relation in served.relations - serving.relations)
    word_changes = sum((containers & other_containers).values())
    container_changes = max(
        sum((containers - other_containers).values()), sum((other_containers - containers).values())
    )
    prices += [table.edits[Edit.WORD]] * word_changes + [table.edits[Edit.CONTAINER]] * container_changes
    known_prices = [price for price in prices if price is not None]
    return sum(known_prices, Fraction(0)) if len(known_prices) == len(prices) else None


def stand_in_fault(
    network: Network, table: StandInTable, actions: Actions, goals: Sequence[int], claim: StandInClaim
) -> str | None:
    """Return in words the first fault of the stand-ins of a network; ``None`` without one.

    A node is *free* if it is in the kitchen or can be made without stand-ins. Each stand-in of the network
    must have a price above 0 by the table, and serve a node that is not free. The table also gives a price to
    pairs of nodes. Each pair whose served node is not free must have a stand-in.

    If the claim is by dissimilarity, this stand-in may be missing in three cases:

    - No tree needs the served node.
    - The serving node costs more than the cheapest free node that could serve.
    - Every tree with the stand-in has a dissimilarity above ``claim.bound``.

    ``goals`` are the nodes, by id, that every tree makes or takes from the kitchen.
    """
    objects = network.objects
    stand_ins: set[tuple[int, int]] = set()
    for unit, motion in enumerate(network.motions):
        if motion == STAND_IN:
            (serving,), (served,) = network.inputs[unit], network.outputs[unit]
            stand_ins.add((serving, served))
    free = _nodes_made(network, actions)
    for serving, served in stand_ins:
        price = price_of(table, objects[serving], objects[served])
        if price is None or price <= 0:
            return f"{objects[serving]} does not stand in for {objects[served]} by the table"
        if served in free:
            return f"a stand-in serves {objects[served]}, which can be made"
    servers = _Servers(network, table, free, claim.by_dissimilarity)
    if claim.by_dissimilarity:
        unfree_nodes = _nodes_needed(network, goals, free, actions)
        least = _least_dissimilarities(network, servers, goals, actions)
    else:
        unfree_nodes, least = set(range(len(objects))) - free, {}
    for served in unfree_nodes:
        for serving, price in servers.prices_of(served).items():
            if (serving, served) in stand_ins:
                continue
            is_free = serving in free or claim.bound is None
            serving_cost = Fraction(0) if is_free else least.get(serving)
            if serving_cost is not None and (claim.bound is None or price + serving_cost <= claim.bound):
                return f"a stand-in is missing: {objects[serving]} for {objects[served]}"
    return None


def _singular_word(label: str) -> str:
    """Return a label in lower case, in the singular, without spaces, hyphens and underscores.

    A word of up to 3 letters, or with the end ``ss``, counts as singular.
    """
    word = "".join(letter for letter in label.casefold() if letter not in " -_")
    if len(word) > 5 and word[-3:] in {"ies", "oes"}:
        return word[:-3] + {"i": "y", "o": "o"}[word[-3]]
    if len(word) > 5 and word[-4:] in {"sses", "shes", "ches"}:
        return word[:-2]
    is_plural = word[-1:] == "s" and word[-2:] != "ss"
    return word[:-1] if is_plural and len(word) > 3 else word


class _Servers:
    """The nodes that may stand in for others by a table (*serving* nodes), with their prices.

    ``free``: the nodes that can be made without stand-ins.
    ``nearest``: whether a serving node is omitted if it costs more than the cheapest free one.
    """

    def __init__(self, network: Network, table: StandInTable, free: Collection[int], nearest: bool) -> None:
        """Index the nodes of the network by label and by spelling; prices are computed later."""
        self.free, self.nearest = free, nearest
        self._network, self._table = network, table
        self._by_label: dict[str, list[int]] = {}
        for o, node in enumerate(network.objects):
            self._by_label.setdefault(node.label, []).append(o)
        self._spelled: dict[str, list[int]] = {}
        for label, nodes in self._by_label.items():
            self._spelled.setdefault(_singular_word(label), []).extend(nodes)
        self._prices_of: dict[int, dict[int, Fraction]] = {}

    def prices_of(self, served: int) -> dict[int, Fraction]:
        """Return the price of each node that may serve in place of the node ``served``, by id; cached.

        ``served`` itself is omitted. With ``nearest``, nodes that cost more than the cheapest free one are
        omitted as well.
        """
        if served not in self._prices_of:
            objects = self._network.objects
            node = objects[served]
            priced = {
                serving: price
                for serving in self._candidates(node)
                if serving != served and (price := price_of(self._table, objects[serving], node)) is not None
            }
            cheapest = min((price for o, price in priced.items() if o in self.free), default=None)
            if cheapest is not None and self.nearest:
                priced = {o: price for o, price in priced.items() if price <= cheapest}
            self._prices_of[served] = priced
        return self._prices_of[served]

    def _candidates(self, node: ObjectNode) -> Iterator[int]:
        """Yield the ids of nodes for which the table may have a price in place of ``node``, maybe twice.

        Their label is spelled like that of ``node``, or the table lists the pair of labels or of nodes.
        ``node`` itself is yielded as well.
        """
        yield from self._spelled[_singular_word(node.label)]
        for serving, served in self._table.pairs:
            if served == node.label and isinstance(serving, str):
                yield from self._by_label.get(serving, ())
            elif served == node and isinstance(serving, ObjectNode):
                number = self._network.object_id(serving)
                if number is not None:
                    yield number


def _least_dissimilarities(
    network: Network, servers: _Servers, goals: Sequence[int], actions: Actions
) -> dict[int, Fraction]:
    """Return a lower bound on the dissimilarity of making each node that is not free, by id (h_max).

    A unit costs at least as much as its most expensive input; a stand-in adds its price. All stand-ins that
    ``servers`` allows are considered, even if the network does not have them. Omitted are nodes that no goal
    needs, and nodes that cannot be made even with stand-ins.
    """
    makers: dict[int, list[set[int]]] = {}
    stack = [goal for goal in goals if goal not in servers.free]
    while stack:
        made = stack.pop()
        if made in makers:
            continue
        makers[made] = [
            {o for o in actions.needs(unit) if o is not None} - {*servers.free}
            for unit in network.producers[made]
            if network.motions[unit] != STAND_IN and made in actions.gives(unit)
        ]
        stack += (o for inputs in makers[made] for o in inputs)
        stack += (o for o in servers.prices_of(made) if o not in servers.free)
    served_by: dict[int, list[tuple[int, Fraction]]] = {}
    waiting: dict[int, list[tuple[int, set[int]]]] = {}
    heap: list[tuple[Fraction, int]] = []
    for made, units in makers.items():
        for serving, price in servers.prices_of(made).items():
            if serving in servers.free:
                heap.append((price, made))
            else:
                served_by.setdefault(serving, []).append((made, price))
        for inputs in units:
            for o in tuple(inputs):
                waiting.setdefault(o, []).append((made, inputs))
    heapify(heap)
    least: dict[int, Fraction] = {}
    while heap:
        cost, o = heappop(heap)
        if o in least:
            continue
        least[o] = cost
        for made, price in served_by.get(o, ()):
            heappush(heap, (cost + price, made))
        for made, inputs in waiting.get(o, ()):
            inputs.discard(o)
            if not inputs:
                heappush(heap, (cost, made))
    return least


def _nodes_made(network: Network, actions: Actions) -> set[int]:
    """Return the nodes, by id, that are in the kitchen or can be made from it without stand-ins."""
    units = [unit for unit, motion in enumerate(network.motions) if motion != STAND_IN]
    needs, gives = actions.needs, actions.gives
    waiting = {unit: {o for o in needs(unit) if o is not None} for unit in units}
    consumers: dict[int, list[int]] = {}
    for unit, inputs in waiting.items():
        for o in inputs:
            consumers.setdefault(o, []).append(unit)
    made: set[int] = set()
    queue = deque(actions.kitchen)
    for unit, inputs in waiting.items():
        if not inputs:
            queue.extend(o for o in gives(unit) if o is not None)
    while queue:
        o = queue.popleft()
        if o in made:
            continue
        made.add(o)
        for unit in consumers.get(o, ()):
            waiting[unit].discard(o)
            if not waiting[unit]:
                queue.extend(output for output in gives(unit) if output is not None)
    return made


def _nodes_needed(
    network: Network, goals: Sequence[int], free: Collection[int], actions: Actions
) -> set[int]:
    """Return the nodes, by id, that a tree may need and that are not free.

    They are goals and, recursively, preconditions of their achievers. Stand-ins of the network are achievers,
    too.
    """
    needed = {goal for goal in goals if goal not in free}
    stack = list(needed)
    while stack:
        served = stack.pop()
        for unit in network.producers[served]:
            if served not in actions.gives(unit):
                continue
            for o in actions.needs(unit):
                if o is not None and o not in free and o not in needed:
                    needed.add(o)
                    stack.append(o)
    return needed
