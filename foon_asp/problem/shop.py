"""What of a problem's object nodes one can buy, where no prices say otherwise."""

from collections.abc import Collection

from foon_asp.network import ObjectNode
from foon_asp.problem.problem import Problem

_FRESH = frozenset({"empty", "clean"})


class Shop:
    """Tells what of a problem's object nodes can be bought.

    For sale is a node that no unit makes (one that needs it only hands it on, and so does one that the
    container rule lets skip it), and a node without any state that holds at most one ingredient, where what
    it is or holds is nobody's product. A *product* is a name that some unit makes out of things that neither
    bear nor hold it: whipped cream, dough, lemon juice. States are how a FOON says that something was done,
    so what has none is taken to be unprocessed. What is empty or clean, and nothing else, is a vessel or a
    tool as shops have it, and for sale although washing up makes it too.

    A goal is not for sale, nor is any node that bears or holds the name of the *dish*: the label of a goal
    (or, where that is a utensil, the one ingredient in it), if that is a product.
    """

    def __init__(self, problem: Problem) -> None:
        self._problem = problem
        self._products = _products(problem)
        names = {_substance(problem.network.objects[goal], problem.utensils) for goal in problem.goals}
        self._dishes = {name for name in names if name in self._products}

    def sells(self, o: int) -> bool:
        """Whether a node, by id, can be bought, dish or not."""
        node = self._problem.network.objects[o]
        if self.is_raw(o) or _is_fresh(node):
            return True
        return (
            not node.states
            and len(node.ingredients) <= 1
            and (node.ingredients or (node.label,))[0] not in self._products
        )

    def is_raw(self, o: int) -> bool:
        """Whether no unit makes a node out of others."""
        needs = self._problem.needs
        return all(o in needs[unit] for unit in self._problem.makers[o])

    def is_dish(self, o: int) -> bool:
        """Whether a node is a goal, or bears or holds the name of the dish."""
        node = self._problem.network.objects[o]
        names = {node.label, *node.ingredients}
        return o in self._problem.goals or not names.isdisjoint(self._dishes)

    def is_second_choice(self, o: int) -> bool:
        """Whether another node is better where trees are as good: units make this one, or it is a mixture."""
        node = self._problem.network.objects[o]
        return not (self.is_raw(o) or _is_fresh(node)) or len(node.ingredients) > 1


def _is_fresh(node: ObjectNode) -> bool:
    """Whether a node is an empty or clean vessel or tool."""
    return bool(node.states) and node.states <= _FRESH and not node.contents


def _substance(node: ObjectNode, utensils: Collection[str]) -> str | None:
    """Give the name of what a node is about: its label, or the one ingredient in a utensil."""
    if node.label not in utensils:
        return node.label
    return node.ingredients[0] if len(set(node.ingredients)) == 1 else None


def _products(problem: Problem) -> set[str]:
    network = problem.network
    objects = network.objects
    found: set[str] = set()
    for inputs, outputs in zip(network.inputs, network.outputs, strict=True):
        before = {name for o in inputs for name in (objects[o].label, *objects[o].ingredients)}
        found |= {objects[o].label for o in outputs} - before
    return found
