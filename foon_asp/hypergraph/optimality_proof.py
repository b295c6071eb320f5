"""Proofs that no derivation costs less than the incumbent: cost partitions over landmarks, and branching.

A cost partition gives each landmark a weight. For each action, the weights of its landmarks add up to at most
its cost. Then the sum of all weights is a lower bound on the cost of every derivation. The best weights solve
the dual of the hitting set relaxation. Landmarks are added as long as the LP solution violates one (Bonet and
Helmert 2010; Haslum, Slaney and Thiébaux 2012 for the hitting sets).

A limit on a resource is one more row of the relaxation. An action that consumes the resource may then carry
more weight. In return, the weight of the limit times its amount is subtracted from the bound.
"""

import math
import random
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from fractions import Fraction
from functools import cache, cmp_to_key, partial
from itertools import islice
from operator import mul
from typing import Protocol

from foon_asp.hypergraph import tuning
from foon_asp.hypergraph.branch_and_bound import prove_by_branching
from foon_asp.hypergraph.cost_partition import CostPartition, CostPartitioning
from foon_asp.hypergraph.covering import TOLERANCE, Covering
from foon_asp.hypergraph.cut import Cut, Cutter
from foon_asp.hypergraph.exact_optimum import ExactOptimum, Limit, exact_optimum
from foon_asp.hypergraph.hypergraph import Hypergraph
from foon_asp.hypergraph.landmark_relaxation import PARTS
from foon_asp.hypergraph.lexicographic import Lexicographic, Vector, multiply, subtract
from foon_asp.hypergraph.proof_tree import (
    Branch,
    Broken,
    Cases,
    CostFixing,
    Hopeless,
    Packing,
    Proof,
    cuts_of,
)
from foon_asp.hypergraph.violated_cuts import disjoint_violated_cuts

# Continues the proof for derivations without the given actions, from the given cuts.
Others = Callable[[frozenset[int], Collection[frozenset[int]]], Proof]


class Rules(Protocol):
    """Rules on derivations that neither targets nor limits express."""

    def barred_actions(self, used: frozenset[int], without: frozenset[int]) -> Mapping[int, frozenset[int]]:
        """Return the actions that each rule bars, by the number of the rule.

        Take a derivation with all ``used`` actions and no action of ``without``. It breaks the rule if it
        also has a barred action.
        """

    def breaking_actions(self, derivation: frozenset[int]) -> Sequence[int]:
        """Return actions of a derivation that together break a rule; empty if it breaks none."""

    def exceeded_limit(self, derivation: frozenset[int]) -> Limit | None:
        """Return a limit that a derivation exceeds and that was not returned earlier.

        Return ``None`` if there is no such limit.
        """


class CheaperError(Exception):
    """The ``actions`` form a derivation that costs less than the one to be proved optimal."""

    def __init__(self, actions: Sequence[int]) -> None:
        super().__init__("a cheaper derivation was found")
        self.actions = tuple(actions)


class _GivenUpError(Exception):
    """A proof was given up, since time is up or floats led nowhere."""


class Prover:
    """Searches for optimality proofs over one hypergraph, its targets and the cost of each action.

    ``costs``: the cost of each action as a vector.
    ``order``: the order of cost vectors.
    ``forbidden``: the actions that derivations must not have.
    ``expired``: returns whether to give up. It is called between steps that take milliseconds on thousands of
    actions.
    ``known_cuts``: the cuts to begin with, each by its objects.
    ``limits``, ``rules``: derivations that exceed a limit or break a rule do not count.
    ``multiples``: for each coordinate, a number of which all costs are multiples. Bounds are rounded up to a
    multiple of it. For 0 or a missing number, nothing is rounded.
    """

    def __init__(
        self,
        graph: Hypergraph,
        targets: Sequence[int],
        costs: Sequence[Vector],
        order: Lexicographic,
        forbidden: frozenset[int] = frozenset(),
        expired: Callable[[], bool] = lambda: False,
        known_cuts: Iterable[Iterable[int]] = (),
        limits: Sequence[Limit] = (),
        rules: Rules | None = None,
        multiples: Sequence[Fraction] = (),
    ) -> None:
        self._multiples = multiples
        self._known_cuts, self._limits, self._rules = tuple(map(frozenset, known_cuts)), [*limits], rules
        self._graph, self._targets, self._costs, self._order = graph, targets, costs, order
        self._forbidden, self._expired = forbidden, expired
        self._random = random.Random(0)
        self._landmark_of = cache(graph.landmark_of)
        floats = [order.approximate(cost) for cost in set(costs)]
        scale, self._scales = 1.0, list[float]()
        for level, rates in enumerate(order.levels):
            largest = max((f[level] for f in floats), default=0.0)
            # rates may all be next to 1, where a solver would see nothing
            unit = largest or 1.0 if rates else 1.0
            self._scales.append(scale / unit)
            scale *= 1e-4 / (1 + largest / unit)  # so that a level weighs much less than the one before

    def as_float(self, vector: Vector) -> float:
        """Return a cost as one float: a sum in which each level weighs much less than the level above it."""
        return sum(map(mul, self._order.approximate(vector), self._scales), 0.0)

    def prove(self, derivation: Iterable[int], cases: Cases = None) -> Proof | None:
        """Return a proof that no derivation costs less than this one; ``None`` if no proof is found in time.

        Known cuts are tried first. If they do not suffice, the proof branches on ``cases``. These are the
        nested cases of an earlier search. Raises :class:`CheaperError` if a cheaper derivation is found.
        """
        try:
            goal, nothing = self._cost_of(derivation), frozenset[int]()
            return self._prove(goal, nothing, self._forbidden, self._known_cuts, cases, at_root=True)
        except _GivenUpError:
            return None

    def prove_none(self) -> Proof | None:
        """Return a proof that no derivation exists. Return ``None`` if none is found, or one exists."""
        try:
            return self._prove(None, frozenset(), self._forbidden)
        except _GivenUpError:
            return None

    def relax(self, derivation: Iterable[int]) -> tuple[Packing, Vector] | None:
        """Return the optimal cost partition of the relaxation, before any branching, and its lower bound.

        The relaxation may exceed limits. An excess costs 1000 times as much as ``derivation``, which has no
        other effect. The lower bound is rounded up. Return ``None`` if the targets cannot be reached, time is
        up, or exact arithmetic fails.
        """
        nothing: frozenset[int] = frozenset()
        barred = self._barred_actions(nothing, self._forbidden).values()
        cutter = Cutter(self._graph, self._targets, self._forbidden.union(*barred))
        if cutter.hopeless:
            return None
        try:
            node = _NodeRelaxation(self, cutter, nothing, self._cost_of(derivation))
            exact = node.relax(None)
        except _GivenUpError:
            return None
        return None if exact is None else (node.packing(exact), self.round_up(exact.value)[0])

    def _prove(
        self,
        goal: Vector | None,
        used: frozenset[int],
        forbidden: frozenset[int],
        known_cuts: Collection[frozenset[int]] = (),
        cases: Cases = None,
        at_root: bool = False,
    ) -> Proof:
        """Return a proof that derivations with all used and no forbidden actions cost at least ``goal``.

        ``goal``: the cost to be proved; ``None`` to prove that there is no such derivation.
        ``known_cuts``: the cuts that are tried first.
        ``cases``: nested cases to branch on if cuts do not suffice; ``None`` to choose actions by LP values.
        ``at_root``: whether there was no branching yet; reduced-cost fixing does not count.

        New limits that a rounded LP solution exceeds are added to the limits of the prover. Raises
        :class:`CheaperError` as :meth:`prove` does, and :class:`_GivenUpError` if it gives up.
        """
        targets = [*self._targets, *(o for action in sorted(used) for o in self._graph.needs[action])]
        bars = self._barred_actions(used, forbidden)
        for rule, barred in bars.items():
            if not used.isdisjoint(barred):
                return Broken(rule)
        cutter = Cutter(self._graph, targets, forbidden.union(*bars.values()))
        if cutter.hopeless:
            return Hopeless(cutter.hopeless)
        remaining_goal = None if goal is None else subtract(goal, self._cost_of(used))
        undecided = set(cutter.actions) - used if cases else ()
        while cases is not None and cases[0] not in undecided:
            cases = cases[2] if cases[0] in used else cases[1]
        cuts: Sequence[Cut] = ()
        if remaining_goal is not None:

            def others(above_cutoff: frozenset[int], known_cuts: Collection[frozenset[int]]) -> Proof:
                """Continue the proof for derivations without the actions above the cutoff."""
                return self._prove(goal, used, forbidden | above_cutoff, known_cuts, cases, at_root)

            is_large = len(cutter.actions) > tuning.PROOF.rounded_actions or (
                at_root and forbidden != self._forbidden
            )
            step = self._cost_step() if is_large else Fraction(0)
            without_lp = cases is not None and not at_root
            proof, cuts = self._prove_by_partition(
                cutter, used, remaining_goal, known_cuts, others, step, without_lp, at_root
            )
            if proof is not None:
                return proof
        if cases is not None:
            return self._branch(goal, used, forbidden, known_cuts, cases[0], cases[1:])
        while True:
            node = _NodeRelaxation(self, cutter, used, goal)
            node.add_cuts(cuts)
            exact = node.relax(remaining_goal)
            if exact is not None and node.is_sufficient(exact.value, remaining_goal):
                return node.packing(exact)
            action = node.most_fractional_action()
            rounded_solution = [] if action is not None else node.rounded_solution()
            limit = self._exceeded_limit(rounded_solution)
            if limit is None:
                break
            self._limits.append(limit)
            cuts = node.cuts
        if action is None:
            breaking = [a for a in self._breaking_actions(rounded_solution) if a not in used]
            if not breaking:
                cost = self._cost_of(rounded_solution)
                is_cheaper = goal is not None and self._order.compare(cost, goal) < 0
                is_derivation = cutter.reached_by(rounded_solution)
                if is_cheaper and is_derivation and not node.exceeds_limit(rounded_solution):
                    raise CheaperError(self._runnable_actions(rounded_solution))
                raise _GivenUpError  # floats led nowhere
            action = breaking[0]
        known_cuts = [frozenset(cut.objects) for cut in node.cuts]
        return self._branch(goal, used, forbidden, known_cuts, action, (None, None))

    def _branch(
        self,
        goal: Vector | None,
        used: frozenset[int],
        forbidden: frozenset[int],
        known_cuts: Collection[frozenset[int]],
        action: int,
        cases: Sequence[Cases],
    ) -> Branch:
        """Return a proof that branches on an action: one proof without the action, one with it.

        ``cases`` are two nested cases, without the action and with it. Other arguments are those of
        :meth:`_prove`.
        """
        without, using = cases
        return Branch(
            action,
            self._prove(goal, used, forbidden | {action}, known_cuts, without),
            self._prove(goal, used | {action}, forbidden, known_cuts, using),
        )

    def round_up(self, bound: Vector) -> tuple[Vector, int | None]:
        """Round up the first coordinate of a bound that is no multiple of its number in ``multiples``.

        Later coordinates become 0. Returns the bound, and the index of the coordinate that was rounded. The
        index is ``None`` if none was rounded.
        """
        for i, (coordinate, multiple) in enumerate(zip(bound, self._multiples, strict=False)):
            if multiple and coordinate % multiple:
                after = self._order.zero[i + 1 :]
                return (*bound[:i], math.ceil(coordinate / multiple) * multiple, *after), i
        return bound, None

    def _barred_actions(self, used: frozenset[int], without: frozenset[int]) -> Mapping[int, frozenset[int]]:
        """Return what :meth:`Rules.barred_actions` returns; an empty mapping without rules."""
        return {} if self._rules is None else self._rules.barred_actions(used, without)

    def _breaking_actions(self, derivation: Iterable[int]) -> Sequence[int]:
        """Return what :meth:`Rules.breaking_actions` returns; an empty tuple without rules."""
        return () if self._rules is None else self._rules.breaking_actions(frozenset(derivation))

    def _exceeded_limit(self, derivation: Iterable[int]) -> Limit | None:
        """Return what :meth:`Rules.exceeded_limit` returns; ``None`` without rules or without actions."""
        chosen = frozenset(derivation)
        return None if self._rules is None or not chosen else self._rules.exceeded_limit(chosen)

    def _runnable_actions(self, actions: Sequence[int]) -> list[int]:
        """Return those of the given actions that can run if no other actions are allowed."""
        graph = self._graph
        reached = graph.reach(frozenset(range(len(graph.needs))).difference(actions))
        return [action for action in actions if all(reached[o] for o in graph.needs[action])]

    def _prove_by_partition(
        self,
        cutter: Cutter,
        used: frozenset[int],
        goal: Vector,
        known_cuts: Collection[frozenset[int]],
        others: Others,
        step: Fraction,
        without_lp: bool,
        at_root: bool,
    ) -> tuple[Proof | None, Sequence[Cut]]:
        """Return a proof of ``goal`` without exact linear programming, and the cuts looked at.

        Cuts whose landmark has a used action are left out.

        The proof is ``None`` if all attempts fail. They are made in this order:
        1. a greedy cost partition over ``known_cuts``,
        2. reduced-cost fixing by this partition; ``others`` proves the goal without the fixed actions,
        3. a partition whose weights are at most the rounded duals of the LP, and fixing by it,
        4. :func:`prove_by_branching`, if ``at_root`` is true.

        All costs are multiples of ``step``. If it is 0, only the first attempt is made. If ``without_lp`` is
        true, only the first two are made.
        """
        targets = set(cutter.targets)
        known_cuts = [cut for cut in known_cuts if not targets.isdisjoint(cut)]
        cuts = [self._widen(cutter, cut) for cut in known_cuts[: tuning.PROOF.greedy_cuts]]
        cuts = [cut for cut in cuts if used.isdisjoint(cut.members)]
        packing, reduced_costs = self._partition_greedily((cut, None) for cut in cuts)
        if self._reaches_goal(packing, goal):
            return packing, cuts
        proof = self._fix_by_cost(cutter, used, goal, packing, reduced_costs, others, known_cuts, step)
        if proof is not None or without_lp or not step:
            return proof, cuts

        def cost_in_steps(action: int) -> int:
            """Return the cost of an action divided by ``step``; 0 for a used action."""
            return 0 if action in used else int(self._costs[action][0] / step)

        enough = math.ceil(goal[0] / step)

        partition = self._optimal_partition(cutter, cost_in_steps, known_cuts, enough)
        if partition is not None:
            weighted_cuts = [
                (self._widen(cutter, cut), (weight * step / PARTS,)) for cut, weight in partition.cuts
            ]
            weighted_cuts = [(cut, weight) for cut, weight in weighted_cuts if used.isdisjoint(cut.members)]
            packing, reduced_costs = self._partition_greedily(weighted_cuts)
            if self._reaches_goal(packing, goal):
                return packing, cuts
            proof = self._fix_by_cost(
                cutter, used, goal, packing, reduced_costs, others, partition.tight, step
            )
            if proof is not None:
                return proof, cuts
            cuts += [cut for cut, _ in weighted_cuts]
        return self._prove_by_search(cutter, goal, cuts, step) if at_root else None, cuts

    def _optimal_partition(
        self, cutter: Cutter, cost: Callable[[int], int], known_cuts: Iterable[frozenset[int]], enough: int
    ) -> CostPartition | None:
        """Return an optimal cost partition, or one by which many actions are excluded.

        ``enough`` is the bound that is needed; the search ends when it is reached. An action is excluded if
        the bound plus its reduced cost exceeds ``enough - 1``. Return ``None`` if there is no cost partition.
        """
        partitioning = CostPartitioning(
            self._graph, cutter.targets, cutter.actions, cost, self._expired, known_cuts
        )
        while True:
            partition = partitioning.advance(enough, max_solutions=1)
            if partition is None or partitioning.converged:
                return partition
            cutoff = (enough - 1) * PARTS - partition.bound
            above_cutoff = sum(reduced_cost > cutoff for reduced_cost in partition.reduced_costs.values())
            if above_cutoff > tuning.PROOF.fixed_share * len(cutter.actions):
                return partition

    def _cost_step(self) -> Fraction:
        """Return a number of which all costs are multiples.

        It is 0 if no such number is known, costs have several coordinates, or there are limits or rules.
        """
        constrained = self._limits or self._rules is not None
        one_number = len(self._multiples) == 1 == len(self._order.zero)
        return self._multiples[0] if one_number and not constrained else Fraction(0)

    def _fix_by_cost(
        self,
        cutter: Cutter,
        used: frozenset[int],
        goal: Vector,
        packing: Packing,
        reduced_costs: Mapping[int, Vector],
        others: Others,
        known_cuts: Collection[frozenset[int]],
        step: Fraction,
    ) -> Proof | None:
        """Return a proof by reduced-cost fixing.

        A derivation with an action costs at least the bound of ``packing`` plus the reduced cost of the
        action. This proves the goal for derivations with an action above the cutoff; ``others`` proves it for
        all others. If no landmark of the proof by ``others`` has an action above the cutoff, that proof holds
        for all derivations, and is returned as it is.

        Return ``None`` if too few actions are above the cutoff, or ``step`` is 0.
        """
        if not step:
            return None
        cutoff = (math.ceil(goal[0] / step) - 1) * step - sum(weight[0] for _, weight in packing.weights)
        remaining = ((a, reduced_costs.get(a, self._costs[a])[0]) for a in cutter.actions if a not in used)
        above_cutoff = frozenset(a for a, reduced_cost in remaining if reduced_cost > cutoff)
        if len(above_cutoff) <= tuning.PROOF.fixed_share * len(cutter.actions):
            return None
        proof = others(above_cutoff, known_cuts)
        fixed = above_cutoff.intersection(self._landmark_actions(proof))
        return CostFixing(tuple(sorted(fixed)), packing._replace(rounded=0), proof) if fixed else proof

    def _landmark_actions(self, proof: Proof) -> Iterator[int]:
        """Yield the actions that cross the cuts of a proof.

        Fixed and forbidden actions are included. An action may be yielded more than once.
        """
        for objects in {cut.objects for cut in cuts_of(proof)}:
            yield from self._landmark_of(frozenset(objects))

    def _widen(self, cutter: Cutter, objects: Iterable[int]) -> Cut:
        """Return the cut with the given objects inside, without the initial ones among them.

        If an action that cannot run crosses the cut, unreachable objects are added to it. Forbidden actions
        are left out of its landmark.
        """
        inside = frozenset(o for o in objects if not self._graph.at_start[o])
        members = cutter.without_forbidden(self._landmark_of(inside))
        return cutter.widen(inside) if members is None else Cut(tuple(sorted(inside)), members)

    def _prove_by_search(
        self, cutter: Cutter, goal: Vector, known_cuts: Sequence[Cut], step: Fraction
    ) -> Proof | None:
        """Return a proof by :func:`prove_by_branching`; ``None`` if it finds none, or ``step`` is 0.

        The cuts of the proof are widened, so that they are valid for all actions.
        """
        if not step:
            return None
        result = prove_by_branching(
            *(self._graph, cutter.targets, cutter.actions),
            *(lambda action: int(self._costs[action][0] / step), [cut.objects for cut in known_cuts]),
            *(math.ceil(goal[0] / step), self._expired),
        )

        widened = cache(partial(self._widen, cutter))

        def widen_packing(packing: Packing) -> Packing:
            """Return a cost partition with widened cuts; weights in steps become vectors of costs."""
            weights = [(widened(cut.objects), (weight[0] * step,)) for cut, weight in packing.weights]
            _, rounded = self.round_up(self._order.total(weight for _, weight in weights))
            return Packing(tuple(weights), rounded=rounded)

        def widen_proof(proof: Proof) -> Proof:
            """Return a proof with widened cuts; weights in steps become vectors of costs."""
            if isinstance(proof, Branch):
                return Branch(proof.action, widen_proof(proof.without), widen_proof(proof.using))
            if isinstance(proof, Hopeless):
                return Hopeless(widened(proof.cut.objects))
            if isinstance(proof, CostFixing):
                return CostFixing(
                    proof.actions, widen_packing(proof.packing)._replace(rounded=0), widen_proof(proof.others)
                )
            assert isinstance(proof, Packing)
            return widen_packing(proof)

        return None if result is None else widen_proof(result)

    def _partition_greedily(
        self, cuts: Iterable[tuple[Cut, Vector | None]]
    ) -> tuple[Packing, dict[int, Vector]]:
        """Partition costs greedily: each cut in turn gets the least reduced cost of its landmark actions.

        ``cuts`` are pairs of a cut and the greatest weight that it may get; ``None`` for no maximum. Cuts of
        weight 0 are left out. Returns the cost partition, and the reduced costs of its landmark actions.
        """
        reduced_costs: dict[int, Vector] = {}
        weights: list[tuple[Cut, Vector]] = []
        for cut, max_weight in cuts:
            remaining = {a: reduced_costs.get(a, self._costs[a]) for a in cut.members}
            limits = [*remaining.values()] if max_weight is None else [*remaining.values(), max_weight]
            weight = min(limits, key=cmp_to_key(self._order.compare))
            if self._order.sign(weight) > 0:
                weights.append((cut, weight))
                reduced_costs.update(
                    (a, subtract(reduced_cost, weight)) for a, reduced_cost in remaining.items()
                )
        _, rounded = self.round_up(self._order.total(weight for _, weight in weights))
        return Packing(tuple(weights), rounded=rounded), reduced_costs

    def _reaches_goal(self, packing: Packing, goal: Vector) -> bool:
        """Return whether the sum of the weights of a cost partition, rounded up, is at least ``goal``."""
        value, _ = self.round_up(self._order.total(weight for _, weight in packing.weights))
        return self._order.compare(value, goal) >= 0

    def _cost_of(self, actions: Iterable[int]) -> Vector:
        """Return the sum of the costs of actions, as a vector."""
        return self._order.total(self._costs[a] for a in actions)


class _NodeRelaxation:
    """The relaxation at one node of the branching.

    It has a column for each action of the cutter, and one for the excess over each limit. It has a row for
    each limit and for each cut.

    ``goal``: the bound to be proved. The excess over a limit costs 1000 times as much.
    ``lp_values``: the LP values of the columns in the last solution.
    ``cuts``: the cuts, in the order of their rows.
    """

    def __init__(self, prover: Prover, cutter: Cutter, used: frozenset[int], goal: Vector | None) -> None:
        self._prover, self._cutter, self._used = prover, cutter, used
        self._actions = cutter.actions
        self._columns = {action: column for column, action in enumerate(self._actions)}
        self._costs = [prover._costs[action] for action in self._actions]
        floats = {cost: prover.as_float(cost) for cost in set(self._costs)}
        self._floats = [floats[cost] for cost in self._costs]
        self._limits = [
            self._limit_over_columns(column, limit) for column, limit in enumerate(prover._limits)
        ]
        excess_cost = (Fraction(1),) * prover._order.width if goal is None else multiply(goal, Fraction(1000))
        self._costs += [excess_cost] * len(self._limits)
        self._covering = Covering([*self._floats, *[prover.as_float(excess_cost)] * len(self._limits)])
        for amounts, max_amount in self._limits:
            self._covering.add_limit(amounts, max_amount)
        constrained = self._limits or prover._rules is not None
        self._free = (
            [] if constrained else [column for column, cost in enumerate(self._costs) if not any(cost)]
        )
        self.cuts: list[Cut] = []
        self._rows: list[list[int]] = []
        self.lp_values: Sequence[float]

    def _limit_over_columns(self, row: int, limit: Limit) -> Limit:
        """Return a limit on actions as a limit on columns; ``row`` is its number.

        The amounts of the used actions are subtracted. An additional column is the excess over the limit.
        """
        amounts, max_amount = limit
        columns = {self._columns[a]: amount for a, amount in amounts.items() if a in self._columns}
        remaining = max_amount - sum(amounts[a] for a in self._used if a in amounts)
        return {**columns, len(self._actions) + row: Fraction(-1)}, remaining

    def exceeds_limit(self, actions: Iterable[int]) -> bool:
        """Return whether actions exceed a limit of the prover."""
        chosen = set(actions)
        return any(
            sum(amount for a, amount in amounts.items() if a in chosen) > max_amount
            for amounts, max_amount in self._prover._limits
        )

    def is_sufficient(self, value: Vector, enough: Vector | None) -> bool:
        """Return whether a bound, rounded up, is at least ``enough``.

        If ``enough`` is ``None``, return whether the bound is above 0.
        """
        order = self._prover._order
        if enough is None:
            return order.sign(value) > 0
        return order.compare(self._prover.round_up(value)[0], enough) >= 0

    def relax(self, enough: Vector | None) -> ExactOptimum | None:
        """Add violated cuts until the bound is ``enough``, or until no more are found.

        ``enough``: the bound that suffices; ``None`` for no such bound. The last LP solution is recorded in
        ``lp_values``. Returns the exact optimum of the rows. Returns ``None`` if exact arithmetic fails.
        Raises :class:`_GivenUpError` if time is up.
        """
        order = self._prover._order
        wanted = math.inf if enough is None else self._prover.as_float(enough)
        if enough is not None and len(enough) == len(self._prover._multiples) == 1:  # more than one step less
            wanted -= 0.99 * self._prover.as_float((self._prover._multiples[0],))
        while True:
            self._check_time()
            relaxed = self._covering.solve(self._prover._expired)
            self._check_time()
            self._record_solution(relaxed.x)
            if relaxed.value < wanted * 0.9999999 and self._separate():
                continue
            exact = exact_optimum(self._rows, self._costs, order, relaxed.columns, relaxed.rows, self._limits)
            if exact is not None:
                if enough is not None and self.is_sufficient(exact.value, enough):
                    return exact
                self._record_solution([float(exact.x.get(column, 0)) for column in range(len(self._actions))])
            if not self._separate():
                return exact

    def _check_time(self) -> None:
        """Raise :class:`_GivenUpError` if time is up."""
        if self._prover._expired():
            raise _GivenUpError

    def _record_solution(self, x: Sequence[float]) -> None:
        """Record an LP solution; actions of cost 0 get the value 1, unless there are limits or rules."""
        self.lp_values = [*x]
        for column in self._free:
            self.lp_values[column] = 1.0

    def packing(self, exact: ExactOptimum) -> Packing:
        """Return the cost partition of an exact optimum: its duals are the weights of cuts and of limits.

        A limit is a row of the LP with an upper bound on a sum over actions.
        """
        weights = sorted(exact.duals.items())
        first = len(self._limits)
        return Packing(
            tuple((self.cuts[row - first], weight) for row, weight in weights if row >= first),
            tuple((row, weight) for row, weight in weights if row < first),
            self._prover.round_up(exact.value)[1],
        )

    def most_fractional_action(self) -> int | None:
        """Return the action whose LP value is nearest to 1/2; of equally near ones, the most expensive.

        Return ``None`` if all LP values are integers up to rounding.
        """
        fractional = [
            (abs(x - 0.5), -self._floats[column], self._actions[column])
            for column, x in enumerate(self.lp_values[: len(self._actions)])
            if abs(x - 0.5) < 0.5 - TOLERANCE
        ]
        return min(fractional)[2] if fractional else None

    def rounded_solution(self) -> list[int]:
        """Return the used actions and those whose LP value is above 1/2, ascending."""
        lp_values = zip(
            self._actions, self.lp_values, strict=False
        )  # after those of actions come those of limits
        return sorted({action for action, x in lp_values if round(x)} | self._used)

    def _separate(self) -> bool:
        """Add cuts with disjoint landmarks that the last LP solution violates.

        Return whether there are such cuts. At most ``tuning.RELAXATION.cuts`` cuts are added at a call.
        """
        import numpy as np  # noqa: PLC0415 (a part of HiGHS is there already)

        count = len(self._actions)
        lp_values, costs = np.zeros((2, len(self._prover._costs)))
        lp_values[self._actions], costs[self._actions] = self.lp_values[:count], self._floats
        random_number = self._prover._random.random
        cuts = disjoint_violated_cuts(self._cutter, self._used, lp_values, costs, random_number, TOLERANCE)
        violated = list(islice(cuts, tuning.RELAXATION.cuts))
        self.add_cuts(violated)
        return bool(violated)

    def add_cuts(self, cuts: Iterable[Cut]) -> None:
        """Add cuts as rows. A cut is left out if a landmark action has no column."""
        for cut in cuts:
            if self._columns.keys() >= set(cut.members):
                row = [self._columns[a] for a in cut.members]
                self.cuts.append(cut)
                self._rows.append(row)
                self._covering.add_row(row)
