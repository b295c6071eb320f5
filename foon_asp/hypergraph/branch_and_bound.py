"""Branch and cut for the cheapest derivation, over the linear relaxation of hitting all landmarks.

At each node of the search tree, some actions are used and some are forbidden. The preconditions of used
actions are additional targets, and used actions cost nothing more. Cuts that an LP solution violates are
added as in :mod:`foon_asp.hypergraph.cost_partition`. A cut is valid at every node at which it contains a
target, so all nodes share their cuts.

Integers alone close a node: a cost partition or a cut with an empty landmark. The weights of the partition
are rounded so that they add up to at most the cost of each action. The floats of HiGHS only guide the search.
"""

import math
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from heapq import heappop, heappush
from typing import Any

from foon_asp.hypergraph import tuning
from foon_asp.hypergraph.cost_partition import has_stalled
from foon_asp.hypergraph.covering import TOLERANCE, UnsolvedError
from foon_asp.hypergraph.cut import Cut, Cutter
from foon_asp.hypergraph.hypergraph import Hypergraph
from foon_asp.hypergraph.landmark_relaxation import PARTS, LandmarkRelaxation
from foon_asp.hypergraph.proof_tree import Branch, Cases, CostFixing, Hopeless, Packing, Proof

Guess = Callable[[Mapping[int, float], Collection[int]], Iterable[Collection[int]]]


class TooLongError(Exception):
    """A proof takes too much time, or lists too many objects and actions."""


@dataclass(slots=True, eq=False)
class _Node:
    """A node of the search tree: the derivations with all ``used`` and no ``forbidden`` actions.

    Actions are given as columns of the relaxation.

    ``bound``: a lower bound on the cost of the node's derivations, in parts: :data:`PARTS` is a cost of 1.
    ``weights``: pairs of a row and its weight. The cuts of the rows prove the bound.
    ``hopeless``: a cut with an empty landmark if the node has no derivation, else ``None``.
    ``above_cutoff``: actions whose derivations are no better than the incumbent. Both children forbid them.
    ``action``: the action branched on; ``None`` before branching.
    ``without``, ``using``: the children that forbid and use this action; ``None`` before branching.
    """

    used: frozenset[int]
    forbidden: frozenset[int]
    bound: int
    weights: list[tuple[int, int]]
    hopeless: Cut | None = None
    above_cutoff: frozenset[int] = frozenset()
    action: int | None = None
    without: "_Node | None" = None
    using: "_Node | None" = None


class Branching:
    """Branch and cut for the cheapest derivation of the targets that costs less than ``total``.

    Arguments of the constructor:
    ``actions``: the actions that derivations may have. All of them can run, and each costs more than 0.
    ``cuts``: the cuts to begin with, each as a set of objects.
    ``guess``: the primal heuristic. It gets the LP value of each action and the set of forbidden actions, and
    returns derivations.

    Attributes:
    ``incumbent``: the best derivation found that costs less than ``total``; ``None`` before the first.
    ``bound``: a lower bound on the cost of every derivation. It never exceeds the cost of the incumbent or,
    without one, ``total``.
    ``closed``: whether all nodes are closed. Then the incumbent is optimal or, without one, all derivations
    cost at least ``total``.
    ``effort``: the remaining budget of the search, in actions looked at.
    """

    def __init__(
        self,
        graph: Hypergraph,
        targets: Iterable[int],
        actions: Collection[int],
        cost: Callable[[int], int],
        cuts: Iterable[Collection[int]],
        total: int,
        guess: Guess,
    ) -> None:
        import numpy as np  # noqa: PLC0415 (a part of HiGHS is there already)

        self._np = np
        self._relaxation = LandmarkRelaxation(graph, targets, actions, cost)
        self._actions, self._costs = self._relaxation.actions, self._relaxation.costs
        self._graph, self._targets = self._relaxation.graph, self._relaxation.targets
        self._relative_costs, self._covering = self._relaxation.relative_costs, self._relaxation.covering
        self._common_divisor = math.gcd(*self._costs) or 1  # costs of derivations are multiples of it
        self._costs_in_parts = self._relaxation.costs_in_parts()
        self._total, self._guess = total, guess
        self.incumbent: frozenset[int] | None = None
        self.bound, self.closed = 0, False
        self._active: dict[int, bool] = {}  # by row, whether its cut has a target at the current node
        self._relaxed_at: tuple[frozenset[int], frozenset[int]] = frozenset(), frozenset()
        self.effort = 0
        self._length_budget: float = math.inf  # objects and actions that the proof may still list
        self._expired: Callable[[], bool] = lambda: False
        self._root = _Node(frozenset(), frozenset(), 0, [])
        self._relaxation.add_whole_cuts(cuts)

    def search(self, effort: int, expired: Callable[[], bool]) -> Iterator[None]:
        """Search the tree of nodes in the order of their bounds, least first, until all nodes are closed.

        Yields ``None`` after each new incumbent or bound, and once all nodes are closed. Ends early, with
        ``closed`` still false, in three cases: ``effort`` actions were looked at, ``expired`` returns true,
        or HiGHS fails.
        """
        self.effort = effort
        waiting = [(0, 0, 0, self._root)]
        node_number = 0
        try:
            while waiting:
                bound, depth, _, node = waiting[0]
                previous = self.bound, self._total
                self.bound = max(self.bound, min(-(-bound // PARTS), self._total))
                stopped = self._must_stop(expired)
                if not stopped and not self._is_above_cutoff(bound):
                    stopped = not self._close_or_branch(node, node_number, expired)
                if (self.bound, self._total) != previous:
                    yield
                if stopped:
                    return
                heappop(waiting)
                for child in (node.using, node.without):
                    if child is not None:
                        node_number += 1
                        heappush(waiting, (child.bound, depth - 1, node_number, child))
        except UnsolvedError:
            return
        self.closed = True
        yield

    def proof(self, max_length: float = math.inf, expired: Callable[[], bool] = lambda: False) -> Proof:
        """Return the proof of the search, which has to have closed all nodes.

        Raises :class:`TooLongError` if ``expired`` returns true, or the proof is longer than ``max_length``.
        Its length is the number of objects and landmark actions in it, plus 5000 for each cost partition.
        """
        self._length_budget, self._expired = max_length, expired
        return self._proof_of(self._root)[0]

    def cases(self) -> Cases:
        """Return the case split of the whole search: the actions branched on, as nested cases.

        Each split is a triple: an action, the split of the derivations without it, and the split of the
        derivations with it. A closed node is ``None``. Actions fixed by reduced cost are not listed.
        """
        return self._cases_below(self._root)

    def _cases_below(self, node: _Node) -> Cases:
        """Return the case split at a node, as :meth:`cases` does; ``None`` if it did not branch."""
        if node.hopeless or node.without is None or node.using is None or node.action is None:
            return None
        return self._actions[node.action], self._cases_below(node.without), self._cases_below(node.using)

    def _must_stop(self, expired: Callable[[], bool]) -> bool:
        """Return whether the effort is used up or time is up."""
        return self.effort <= 0 or expired()

    def _is_above_cutoff(self, bound: int) -> bool:
        """Return whether a lower bound on costs, in parts, exceeds the greatest cost that is still wanted."""
        return bound > self._cutoff() * PARTS

    def _cutoff(self) -> int:
        """Return the greatest cost that a derivation better than the incumbent can have.

        Without an incumbent, ``total`` takes the place of its cost. The cutoff is a multiple of the common
        divisor of all costs.
        """
        return (self._total - 1) // self._common_divisor * self._common_divisor

    def _set_bounds(self, node: _Node, targets: set[int]) -> None:
        """Set the bounds of columns and rows of the relaxation for a node.

        Used actions are fixed at 1 and forbidden ones at 0. ``targets`` are the targets at this node. If a
        cut contains no such target, its row is made redundant.
        """
        used, forbidden = self._relaxed_at
        for action in (used ^ node.used) | (forbidden ^ node.forbidden):
            upper = 0.0 if action in node.forbidden else 1.0 if action in node.used else math.inf
            self._covering.set_bounds(action, float(action in node.used), upper)
        self._relaxed_at = node.used, node.forbidden
        for row, cut in enumerate(self._relaxation.cuts):
            active = not cut.isdisjoint(targets)
            if active != self._active.get(row, True):
                self._active[row] = active
                self._covering.set_row_minimum(row, float(active))

    def _close_or_branch(self, node: _Node, node_number: int, expired: Callable[[], bool]) -> bool:
        """Solve the relaxation at a node in rounds of cuts, and close the node or give it two children.

        A node is closed if it is ``hopeless``, or if its bound is above the cutoff. If the node gets
        children, both forbid the actions above the cutoff. A better derivation that is found becomes the
        incumbent. Returns ``False`` if time or effort ran out first, else ``True``. Raises
        :class:`UnsolvedError` if HiGHS fails.

        ``node_number``: the number of the node in the order of creation. Number 0 is the root, which gets
        more rounds. The primal heuristic is called at the root and at every few nodes.
        """
        targets = set(self._targets).union(*(self._graph.needs[a] for a in node.used))
        self.effort -= len(self._actions)
        cutter = Cutter(self._graph, targets, node.forbidden)
        if cutter.hopeless is not None:
            node.hopeless = cutter.hopeless
            return True
        self._set_bounds(node, targets)
        undecided = self._np.ones(len(self._actions), dtype=bool)
        undecided[list(node.used | node.forbidden)] = False
        values: list[float] = []
        while True:
            solution = self._covering.solve(expired)
            lp_values = self._np.array(solution.x)
            values.append(solution.value)
            self._raise_bound(node)
            if self._is_above_cutoff(node.bound):
                return True
            if self._must_stop(expired):
                return False
            fractional = self._np.flatnonzero(
                undecided & (lp_values > TOLERANCE) & (lp_values < 1 - TOLERANCE)
            )
            if not len(fractional):
                chosen = self._rounded_derivation(cutter, lp_values, node)
                if not chosen:
                    continue
                if self._is_above_cutoff(node.bound):
                    return True
                fractional = self._np.array(
                    sorted(chosen - node.used)
                )  # rounding left a gap that floats do not close
                break
            if node_number:
                is_last_round = len(values) > tuning.RELAXATION.node_rounds
            else:
                is_last_round = has_stalled(
                    values, self._total / self._relaxation.greatest_cost - solution.value
                )
            if is_last_round or not self._separate(cutter, lp_values, node, expired):
                break
        if node_number % tuning.RELAXATION.guess_interval == 0:
            self._try_guesses(lp_values, node)
            if self._is_above_cutoff(node.bound):
                return True
        reduced_costs = self._reduced_costs(node)
        gap = self._cutoff() * PARTS - node.bound
        above_cutoff = self._np.flatnonzero(reduced_costs > gap).tolist()
        node.above_cutoff = frozenset(above_cutoff) - node.used - node.forbidden
        scores = self._np.minimum(lp_values, 1.001 - lp_values)[fractional] * (
            self._relative_costs[fractional] + 0.05
        )
        action = int(fractional[scores.argmax()])
        node.above_cutoff -= {action}
        node.action = action
        forbidden = node.forbidden | node.above_cutoff
        node.without = _Node(node.used, forbidden | {action}, node.bound, node.weights)
        using_bound = node.bound + int(reduced_costs[action])
        node.using = _Node(node.used | {action}, forbidden, using_bound, node.weights)
        return True

    def _rounded_derivation(self, cutter: Cutter, lp_values: Any, node: _Node) -> set[int]:
        """Round an LP solution to a derivation, record the derivation, and return its columns.

        The derivation has the used actions and those of LP value above 1/2, without forbidden actions. It
        becomes the incumbent if it is better. If the actions do not reach all targets, the empty set is
        returned. Then a cut that the actions do not cross is added to the relaxation.
        """
        chosen = node.used.union(self._np.flatnonzero(lp_values > 0.5).tolist()) - node.forbidden
        self.effort -= len(cutter.actions)
        cut = cutter.cut(chosen, cutter.actions)
        if cut is not None:
            self._relaxation.add_cut(frozenset(cut.objects))
            return set()
        self._record_derivation({self._actions[a] for a in chosen})
        return set(chosen)

    def _record_derivation(self, actions: set[int]) -> None:
        """Make a derivation the incumbent if it costs less than the incumbent.

        Without an incumbent, it has to cost less than ``total``.
        """
        total = sum(self._costs[i] for i, a in enumerate(self._actions) if a in actions)
        if total < self._total:
            self._total, self.incumbent = total, frozenset(actions)

    def _try_guesses(self, lp_values: Any, node: _Node) -> None:
        """Replace the incumbent by a better derivation, if the primal heuristic proposes one.

        Derivations with actions that the relaxation lacks are ignored. ``effort`` is lowered.
        """
        self.effort -= 2 * len(self._actions)
        solution = dict(zip(self._actions, lp_values.tolist(), strict=True))
        for derivation in self._guess(solution, {self._actions[a] for a in node.forbidden}):
            if set(derivation) <= solution.keys():
                self._record_derivation(set(derivation))

    def _separate(self, cutter: Cutter, lp_values: Any, node: _Node, expired: Callable[[], bool]) -> bool:
        """Add cuts with disjoint landmarks that an LP solution violates; return whether any was added.

        The actions looked at are subtracted from ``effort``, and ``lp_values`` stay as they are.
        """
        budget = min(self.effort, tuning.RELAXATION.cuts * len(cutter.actions))
        added, looks = self._relaxation.separate([cutter], node.used, lp_values.copy(), budget, expired)
        self.effort -= looks
        return added > 0

    def _raise_bound(self, node: _Node) -> None:
        """Round the LP duals to weights of rows, which prove a bound of the node.

        If the weights raise the bound, or the node has no weights yet, they are stored in the node. The bound
        of the node never falls.
        """
        reduced_costs = self._costs_in_parts.copy()
        used_cost = sum(self._costs[a] for a in node.used) * PARTS
        reduced_costs[list(node.used)] = 0
        reduced_costs[list(node.forbidden)] = sum(self._costs) * PARTS  # more than cuts can take
        dual_values = (
            (row, w) for row, w in enumerate(self._covering.duals()) if self._active.get(row, True)
        )
        weights = self._relaxation.feasible_weights(dual_values, reduced_costs)
        bound = used_cost + sum(weights.values())
        if bound > node.bound or not node.weights:
            node.bound = max(bound, node.bound)
            node.weights = [(row, weight) for row, weight in weights.items() if weight]

    def _reduced_costs(self, node: _Node) -> Any:
        """Return an array of the reduced cost of each action at a node, in parts.

        The reduced cost is the cost minus the weights of the open cuts whose landmark has the action. A cut
        is open if its landmark has no used action. The reduced cost of a forbidden action may be below 0.
        """
        reduced_costs = self._costs_in_parts.copy()
        for row, weight in self._open_cuts(node):
            reduced_costs[self._relaxation.rows[row]] -= weight
        return reduced_costs

    def _open_cuts(self, node: _Node) -> Iterator[tuple[int, int]]:
        """Yield the row and the weight of each cut whose landmark has no used action of a node."""
        for row, weight in node.weights:
            if node.used.isdisjoint(self._relaxation.rows[row].tolist()):
                yield row, weight

    def _proof_of(self, node: _Node) -> tuple[Proof, set[int]]:
        """Return the proof of a closed node, and the columns of the forbidden actions that it relies on.

        The proof is valid for derivations without these actions. Raises as :meth:`proof` does.
        """
        if node.hopeless is not None:
            cut = frozenset(node.hopeless.objects)
            return Hopeless(self._cut_in_whole_graph(cut, node)), {
                *self._relaxation.landmark_of(cut)
            } & node.forbidden
        if node.without is None or node.using is None or node.action is None:
            return self._packing_of(node)
        proof, relied_on = self._proof_of(node.without)
        using, relied_on_using = self._proof_of(node.using)
        proof = Branch(self._actions[node.action], proof, using)
        relied_on = (relied_on - {node.action}) | relied_on_using
        fixed = sorted(relied_on & node.above_cutoff)
        if not fixed:
            return proof, relied_on
        packing, overloaded = self._packing_of(node)
        proof = CostFixing(tuple(self._actions[a] for a in fixed), packing, proof)
        return proof, (relied_on - node.above_cutoff) | overloaded

    def _packing_of(self, node: _Node) -> tuple[Packing, set[int]]:
        """Return the cost partition of a node, and the columns of forbidden actions that it overloads.

        An action is overloaded if the weights of the cuts that it crosses add up to more than its cost.
        Raises :class:`TooLongError` if the proof as a whole becomes too long, or time is up.
        """
        weights: list[tuple[Cut, tuple[Fraction]]] = []
        self._length_budget -= 5000  # which limits the depth of the branching, too
        for row, weight in self._open_cuts(node):
            cut = self._cut_in_whole_graph(self._relaxation.cuts[row], node)
            self._length_budget -= len(cut.objects) + len(cut.members)
            if self._length_budget < 0 or self._expired():
                raise TooLongError
            weights.append((cut, (Fraction(weight, PARTS),)))
        overloaded = set(self._np.flatnonzero(self._reduced_costs(node) < 0).tolist())
        return Packing(tuple(weights)), overloaded & node.forbidden

    def _cut_in_whole_graph(self, cut: frozenset[int], node: _Node) -> Cut:
        """Return a cut of the subgraph in numbers of the whole graph.

        The landmark of the result lacks the actions that the node forbids.
        """
        crossing = (self._actions[a] for a in self._relaxation.landmark_of(cut) if a not in node.forbidden)
        return Cut(tuple(sorted(self._relaxation.whole_cut(cut))), tuple(sorted(crossing)))


def prove_by_branching(
    graph: Hypergraph,
    targets: Iterable[int],
    actions: Collection[int],
    cost: Callable[[int], int],
    cuts: Iterable[Collection[int]],
    total: int,
    expired: Callable[[], bool],
) -> Proof | None:
    """Return a proof that no derivation costs less than ``total``; ``None`` if no proof is found in time.

    Arguments are those of :class:`Branching`; ``expired`` returns whether time is up. Costs are whole
    numbers, so it suffices that bounds of the proof exceed ``total - 1``.

    Also returns ``None`` if a derivation costs less, or the proof becomes too long. Costs of 0, and costs
    with a common divisor above 1, are not supported: the result is ``None``.
    """
    costs = [cost(action) for action in actions]
    if math.gcd(*costs) != 1 or 0 in costs:
        return None
    search = Branching(graph, targets, actions, cost, cuts, total, lambda *_: ())
    for _ in search.search(tuning.PROOF.search_budget, expired):
        if search.incumbent is not None:
            return None
    if not search.closed:
        return None
    try:
        return search.proof(tuning.PROOF.proof_length, expired)
    except TooLongError:
        return None
