"""Dominance pruning: actions that another action dominates."""

from collections import Counter
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence

from foon_asp.hypergraph.goal_graph import GoalGraph


def undominated_actions(graph: GoalGraph, actions: Collection[int], cost: Callable[[int], int]) -> set[int]:
    """Return the actions that no other action dominates.

    Action A dominates action B if three things hold. The preconditions of A are a subset of B's, A has all
    effects of B, and A costs no more. Then A can replace B in any tree, and the tree costs no more. For this,
    ``cost`` has to cover the whole list of objectives. Initial objects do not count as preconditions. Effects
    that no action or goal needs do not count. An action without effects that count is left out of the result.
    If actions dominate each other, one of them stays.
    """
    start = graph.start
    needed = {a: frozenset(o for o in graph.needs[a] if o not in start) for a in actions}
    wanted = set(graph.goals).union(*needed.values())
    effects = {a: frozenset(o for o in graph.gives[a] if o in wanted) for a in actions}
    remaining = set(actions)
    consumers = Counter(o for needs in needed.values() for o in needs)
    achiever_counts = Counter(o for gives in effects.values() for o in gives)
    rarity = {o: i for i, o in enumerate(sorted(consumers, key=lambda o: (consumers[o], o)))}
    ordered = {a: sorted(needed[a], key=rarity.__getitem__) for a in actions}
    by_preconditions = _PreconditionTrie(ordered, effects)
    achiever_count = {o: (achiever_counts[o], o) for o in achiever_counts}.__getitem__
    prices = {a: cost(a) for a in actions}
    for action in sorted(actions, key=lambda a: (prices[a], -a), reverse=True):
        gives, price = effects[action], prices[action]
        if not gives:
            remaining.discard(action)
            continue
        rarest = min(gives, key=achiever_count)
        for other in by_preconditions.achievers_with_subset(ordered[action], rarest):
            if other != action and prices[other] <= price and other in remaining and gives <= effects[other]:
                remaining.discard(action)
                break
    return remaining


class _PreconditionTrie:
    """A set-trie (Savnik 2013) of actions by their preconditions.

    ``ordered``: the preconditions of each action, rare ones first.
    ``effects``: the effects of each action, by which the actions at a node of the trie are indexed.
    """

    def __init__(self, ordered: Mapping[int, Sequence[int]], effects: Mapping[int, frozenset[int]]) -> None:
        self._children: dict[tuple[int, int], int] = {}  # by node and precondition
        self._achievers: dict[tuple[int, int], list[int]] = {}  # by node and effect
        for action, needs in ordered.items():
            node = 0
            for need in needs:
                node = self._children.setdefault((node, need), len(self._children) + 1)
            for o in effects[action]:
                self._achievers.setdefault((node, o), []).append(action)

    def achievers_with_subset(self, needs: Sequence[int], effect: int) -> Iterator[int]:
        """Yield the achievers of ``effect`` whose preconditions are a subset of ``needs``.

        ``needs`` has to be ordered like the preconditions of actions: rare ones first.
        """
        children, achievers = self._children, self._achievers
        nodes = [0]  # reached by subsets of the preconditions so far
        yield from achievers.get((0, effect), ())
        for need in needs:
            for node in [children[node, need] for node in nodes if (node, need) in children]:
                nodes.append(node)
                yield from achievers.get((node, effect), ())
