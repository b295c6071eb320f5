"""Shop: a model of which object nodes can be bought, for shopping lists without a price list."""

from collections.abc import Collection, Iterator, Sequence
from enum import StrEnum

from foon_asp.network import ObjectNode, starting_nodes
from foon_asp.problem.dead_ends import Blocked, DeadEnds, Root, h_add
from foon_asp.problem.problem import Problem

_FRESH_STATES = frozenset({"empty", "clean"})


class Offer(StrEnum):
    """The set of nodes that shopping lists may contain.

    With a price list, the set is ``priced``: the nodes on the price list. Without a price list, it is the
    first of the following sets from which the goals can be made. ``for sale``: the nodes that :class:`Shop`
    sells, except the dish. ``cycle``: in addition, nodes that can only be made from each other.
    ``processed``: every node except the dish. ``dish``: every node except the goals. ``goal``: every node.
    """

    FOR_SALE = "for sale"
    CYCLE = "cycle"
    PROCESSED = "processed"
    DISH = "dish"
    GOAL = "goal"
    PRICED = "priced"


class Shop:
    """A model of which object nodes of a problem can be bought.

    A node is for sale if no unit makes it out of other nodes, or if it is a vessel or tool of the starting
    kitchen. A node is also for sale if it has no state, contains at most one ingredient, is not on anything,
    and its label or ingredient is not a product. A *product* is a name that some unit makes out of nodes
    without this name: whipped cream, dough, lemon juice. In a FOON, states say that something was done to a
    node, so a node without states is assumed to be unprocessed. A node whose states are only empty or clean
    is a vessel or tool. It is for sale, although washing up makes it, too.

    A goal is not for sale, and neither is a node that has or contains the name of the *dish*. This name is
    the label of a goal or, for a utensil, its one ingredient, if the name is a product.
    """

    def __init__(self, problem: Problem) -> None:
        """Collect the starting nodes, products and dishes of a problem."""
        self._problem = problem
        self._starting = starting_nodes(problem.network, problem.goals)
        self._products = _products(problem)
        self._ingredients = {item for node in problem.network.objects for item in node.ingredients}
        names = {_substance(problem.network.objects[goal], problem.utensils) for goal in problem.goals}
        self._dishes = {name for name in names if name in self._products}

    def sells(self, o: int) -> bool:
        """Return whether a node, by id, can be bought, whether or not it is the dish.

        For sale are plain nodes, and nodes without states that are only in something and contain at most one
        ingredient, which no unit makes.
        """
        node = self._problem.network.objects[o]
        if self._is_plain(o):
            return True
        return (
            not node.states
            and all(relation.word == "in" for relation in node.relations)
            and all(contents.word == "contains" for contents in node.contents)
            and len(node.ingredients) <= 1
            and (node.ingredients or (node.label,))[0] not in self._products
        )

    def offers(self, roots: Sequence[Root]) -> Iterator[tuple[Offer, list[int]]]:
        """Yield the offers with their nodes, by id, each larger than the one before.

        ``roots`` are the causes of the problem's dead ends.
        """
        problem = self._problem
        others = [o for o in range(len(problem.network.objects)) if o not in problem.kitchen]
        no_dish = [o for o in others if not self.is_dish(o)]
        sold = [o for o in no_dish if self.sells(o)]
        yield Offer.FOR_SALE, sold
        in_cycles = {o for root in roots if root.cycle for o in root.cycle.nodes}
        yield Offer.CYCLE, [*sold, *sorted(in_cycles.difference(sold).intersection(no_dish))]
        yield Offer.PROCESSED, no_dish
        yield Offer.DISH, [o for o in others if o not in problem.goals]
        yield Offer.GOAL, others

    def short_list(self, ends: DeadEnds) -> list[int]:
        """Return a few object nodes that make all goals reachable once they are in the kitchen, by id.

        The list has the nodes that the relaxed plan of ``h_add`` takes from the first sufficient offer,
        without nodes that units of this plan make. Nodes that are second choices are avoided. A shorter list
        may exist. If all goals are reachable, the list is empty.
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
        """Return whether no unit makes a node out of others."""
        needs = self._problem.needs
        return all(o in needs[unit] for unit in self._problem.makers[o])

    def is_dish(self, o: int) -> bool:
        """Return whether a node is a goal, or has or contains the name of the dish."""
        node = self._problem.network.objects[o]
        names = {node.label, *node.ingredients}
        return o in self._problem.goals or not names.isdisjoint(self._dishes)

    def is_second_choice(self, o: int) -> bool:
        """Return whether lists should avoid a node: a mixture, or a node that is not plain."""
        return not self._is_plain(o) or len(self._problem.network.objects[o].ingredients) > 1

    def _is_plain(self, o: int) -> bool:
        """Return whether a node is raw, or a vessel or tool: empty, clean, or from the starting kitchen."""
        node = self._problem.network.objects[o]
        given_back = o in self._starting and not node.contents and node.label not in self._ingredients
        return self.is_raw(o) or _is_fresh(node) or given_back


def _is_fresh(node: ObjectNode) -> bool:
    """Return whether a node is an empty or clean vessel or tool."""
    return bool(node.states) and node.states <= _FRESH_STATES and not node.contents and not node.relations


def _substance(node: ObjectNode, utensils: Collection[str]) -> str | None:
    """Return the substance of a node: its label, or the one ingredient in a utensil; ``None`` without one."""
    if node.label not in utensils:
        return node.label
    return node.ingredients[0] if len(set(node.ingredients)) == 1 else None


def _products(problem: Problem) -> set[str]:
    """Return the labels that units make out of nodes which neither have nor contain them."""
    network = problem.network
    objects = network.objects
    products: set[str] = set()
    for inputs, outputs in zip(network.inputs, network.outputs, strict=True):
        before = {name for o in inputs for name in (objects[o].label, *objects[o].ingredients)}
        products |= {objects[o].label for o in outputs} - before
    return products
