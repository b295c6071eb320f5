"""Shop: a model of which object nodes can be bought, for shopping lists without a price list."""

from collections.abc import Collection, Iterator, Sequence
from enum import StrEnum

from foon_asp.network import ObjectNode, starting_nodes
from foon_asp.problem.dead_ends import Blocked, DeadEnds, RootCause, h_add
from foon_asp.problem.problem import Problem

_FRESH_STATES = frozenset({"empty", "clean"})


class Offer(StrEnum):
    """A set of object nodes that shopping lists may contain.

    With a price list, the set is ``priced``: the nodes on the price list. Without a price list, it is the
    first of the following sets from which the goals can be made:

    ``for sale``: the nodes that :class:`Shop` sells, except the dish.
    ``cycle``: the nodes of ``for sale``, and nodes that can only be made from each other, except the dish.
    ``processed``: every node except the dish.
    ``dish``: every node except the goals.
    ``goal``: every node.
    """

    FOR_SALE = "for sale"
    CYCLE = "cycle"
    PROCESSED = "processed"
    DISH = "dish"
    GOAL = "goal"
    PRICED = "priced"


class Shop:
    """A model of which object nodes of a problem can be bought.

    In a FOON, states say that something was done to a node. So these nodes are for sale:

    - a node that no unit makes out of other nodes;
    - a vessel or tool: a node whose states are only empty or clean, or a node of the starting kitchen without
      contents. The label of the latter must be no ingredient of any node;
    - an unprocessed node: it has no state, is not on or at anything, and contains at most one ingredient. The
      name of this ingredient (without one, the label of the node) must not be a *product*. A product is a
      name that some unit makes out of nodes without this name, such as whipped cream, dough or lemon juice.

    The goals are not for sale, nor is the *dish*. The name of a goal is its label or, for a utensil, its one
    ingredient. If this name is a product, each node with it as its label or as an ingredient belongs to the
    dish.
    """

    def __init__(self, problem: Problem) -> None:
        """Compute the starting kitchen, the products and the names of the dish of a problem."""
        self._problem = problem
        self._starting = starting_nodes(problem.network, problem.goals)
        self._products = _product_names(problem)
        self._ingredients = {item for node in problem.network.objects for item in node.ingredients}
        names = {_substance(problem.network.objects[goal], problem.utensils) for goal in problem.goals}
        self._dishes = {name for name in names if name in self._products}

    def sells(self, o: int) -> bool:
        """Whether a node, given by id, is for sale by the three rules of the class.

        The rule about goals and the dish is not applied; see :meth:`is_dish`.
        """
        node = self._problem.network.objects[o]
        if self._is_raw_or_vessel(o):
            return True
        return (
            not node.states
            and all(relation.word == "in" for relation in node.relations)
            and all(contents.word == "contains" for contents in node.contents)
            and len(node.ingredients) <= 1
            and (node.ingredients or (node.label,))[0] not in self._products
        )

    def offers(self, roots: Sequence[RootCause]) -> Iterator[tuple[Offer, list[int]]]:
        """Yield all offers except ``priced``, from the smallest set to the largest, each with its node ids.

        Kitchen items are in no offer. Offers from which the goals cannot be made are yielded as well.
        ``roots`` are the causes of the problem's dead ends; the nodes of their cycles are in the offer
        ``cycle``.
        """
        problem = self._problem
        outside_kitchen = [o for o in range(len(problem.network.objects)) if o not in problem.kitchen]
        no_dish = [o for o in outside_kitchen if not self.is_dish(o)]
        sold = [o for o in no_dish if self.sells(o)]
        yield Offer.FOR_SALE, sold
        in_cycles = {o for root in roots if root.cycle for o in root.cycle.nodes}
        yield Offer.CYCLE, [*sold, *sorted(in_cycles.difference(sold).intersection(no_dish))]
        yield Offer.PROCESSED, no_dish
        yield Offer.DISH, [o for o in outside_kitchen if o not in problem.goals]
        yield Offer.GOAL, outside_kitchen

    def short_list(self, ends: DeadEnds) -> list[int]:
        """Return ascending ids of a few nodes that make all goals reachable once they are in the kitchen.

        The nodes come from the first offer from which the goals can be made. They are the nodes that the
        relaxed plan of ``h_add`` buys, without nodes that units of this plan can make. The plan buys few
        nodes and, among equal numbers, few second choices (:meth:`is_second_choice`). A shorter list may
        exist. If all goals are reachable, the list is empty.
        """
        for _, offer in self.offers(ends.roots):
            # an item costs more than all second choices of a list
            sources = {o: 2**20 + self.is_second_choice(o) for o in offer if o in ends.makers}
            costs, cheapest = h_add(ends.makers, sources)
            if costs.keys() >= set(ends.goals):
                break
        plan: dict[int, Sequence[Blocked]] = {}
        open_preconditions = list(ends.goals)
        while open_preconditions:
            o = open_preconditions.pop()
            if o not in plan:
                plan[o] = ends.makers[o]
                lacking = (blocked.lacks for blocked in plan[o] if blocked.unit == cheapest.get(o))
                open_preconditions += next(lacking, ())
        units = {cheapest[o] for o in plan if o in cheapest}
        plan = {o: [blocked for blocked in makers if blocked.unit in units] for o, makers in plan.items()}
        listed = plan.keys() - cheapest
        for o in sorted(o for o in listed if plan[o]):  # a unit of the plan makes it
            if h_add(plan, dict.fromkeys(listed - {o}, 1))[0].keys() >= set(ends.goals):
                listed.remove(o)
        return sorted(listed)

    def is_raw(self, o: int) -> bool:
        """Whether no unit makes a node out of other nodes: each unit that makes it also needs it."""
        needs = self._problem.needs
        return all(o in needs[unit] for unit in self._problem.makers[o])

    def is_dish(self, o: int) -> bool:
        """Whether a node is a goal or the dish; see the class."""
        node = self._problem.network.objects[o]
        names = {node.label, *node.ingredients}
        return o in self._problem.goals or not names.isdisjoint(self._dishes)

    def is_second_choice(self, o: int) -> bool:
        """Whether a shopping list should avoid a node: it has several ingredients, or it can be made.

        A node can be made if some unit makes it out of other nodes. Vessels and tools with at most one
        ingredient are no second choice, even if they can be made.
        """
        return not self._is_raw_or_vessel(o) or len(self._problem.network.objects[o].ingredients) > 1

    def _is_raw_or_vessel(self, o: int) -> bool:
        """Whether a node is for sale by one of the first two rules of the class: raw, or a vessel or tool."""
        node = self._problem.network.objects[o]
        is_starting_vessel = o in self._starting and not node.contents and node.label not in self._ingredients
        return self.is_raw(o) or _is_clean_vessel(node) or is_starting_vessel


def _is_clean_vessel(node: ObjectNode) -> bool:
    """Whether a node is a vessel or tool by its states: it has states, and only empty or clean.

    A node with contents or relations is neither.
    """
    return bool(node.states) and node.states <= _FRESH_STATES and not node.contents and not node.relations


def _substance(node: ObjectNode, utensils: Collection[str]) -> str | None:
    """Return the name of what a node consists of: its label or, for a utensil, its one ingredient.

    Return ``None`` for a utensil with no ingredient or several.
    """
    if node.label not in utensils:
        return node.label
    return node.ingredients[0] if len(set(node.ingredients)) == 1 else None


def _product_names(problem: Problem) -> set[str]:
    """Return the labels of products: labels of a unit's outputs that none of its inputs has or contains."""
    network = problem.network
    objects = network.objects
    products: set[str] = set()
    for inputs, outputs in zip(network.inputs, network.outputs, strict=True):
        input_names = {name for o in inputs for name in (objects[o].label, *objects[o].ingredients)}
        products |= {objects[o].label for o in outputs} - input_names
    return products
