"""Two trees beside each other."""

from foon_asp.errors import UserError
from foon_asp.explain import difference as explain
from foon_asp.questions.answer import Answer
from foon_asp.questions.result import Result
from foon_asp.questions.tree import Tree
from foon_asp.report.difference import difference_json, difference_text


class Difference(Result, explain.Difference):
    """Two trees, what only one has (``only_left``, ``only_right``), what both have, and where they part.

    ``left`` and ``right`` have the units and the ``costs`` of each; ``partings`` are the object nodes that
    both come to and have from elsewhere.
    """

    __slots__ = ()

    def text(self) -> str:
        """Give the difference as ``foon-asp diff`` does."""
        return difference_text(self)

    def json_text(self) -> str:
        """Give the difference as ``foon-asp diff --format json`` does."""
        return difference_json(self)

    def __repr__(self) -> str:
        only = f"{len(self.only_left)} only left, {len(self.only_right)} only right"
        return f"<Difference: {only}, {len(self.both)} in both>"


def diff(left: Answer | Tree, right: Answer | Tree) -> Difference:
    """Compare two trees: what both have, what only one has, what each costs, and where they part.

    A tree in a file is read by :meth:`foon_asp.Problem.read_tree`. Raises :class:`UserError` for an answer
    without a tree.
    """
    return Difference._make(explain.difference(_side("left", left), _side("right", right)))


def _side(name: str, given: Answer | Tree) -> explain.Side:
    tree = given.tree if isinstance(given, Answer) else given
    if tree is None:
        raise UserError(f"the {name} answer has no tree, so there is nothing to compare")
    problem = tree.problem
    nodes = {node for unit in tree for node in (*unit.inputs, *unit.outputs)}.union(problem.goal_nodes)
    kitchen = frozenset(filter(problem.at_hand, nodes))
    listed = list(zip(tree.units, tree.places, strict=True))
    return explain.side(
        name,
        listed,
        problem.goal_nodes,
        kitchen,
        problem.containers,
        problem.utensils,
        problem.rates,
        problem.network,
    )
