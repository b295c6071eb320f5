"""Proofs that no derivation costs less than one in hand: weighted landmarks, and branching at a gap.

Weights on landmarks that overload no action (what the landmarks of an action weigh together is at most its
cost) add up to a lower bound on the cost of every derivation. The best such weights solve the dual of the
linear relaxation of hitting every landmark; landmarks are added as long as one is found that the relaxed
solution does not hit (Bonet and Helmert 2010; Haslum, Slaney and Thiébaux 2012 for the hitting sets).

Where at most so much of something may be used, that is one more row of the relaxation: an action that takes
of it may carry more weight, and what all that there is carries is taken from the bound.
"""

import math
import random
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from fractions import Fraction
from functools import cache, cmp_to_key, partial
from operator import mul
from typing import NamedTuple, Protocol

from foon_asp.bounds.cut import Cut, Cutter
from foon_asp.bounds.exact_optimum import ExactOptimum, Limit, exact_optimum
from foon_asp.bounds.hypergraph import Hypergraph
from foon_asp.bounds.lexicographic import Lexicographic, Vector, minus, times
from foon_asp.bounds.relaxation import Covering
from foon_asp.bounds.shared_costs import PARTS, SharedCosts, share_costs

_HIT = 0.999999  # a landmark of a greater share is taken to be hit
_STEP = 0.99  # of what costs are multiples of: bounds are rounded up
_BESIDE = 40  # cuts that are grown beside each other for one solution
_ORDERS = 3  # in how many orders cuts are grown before the relaxation counts as the best there is
_FINER = 1e-4  # how much less a level counts than the one before, in floats
_MANY = 1000  # actions from which on rounded weights are looked for before exact ones
_GREEDY = 200  # known cuts that get weights one after the other; all others only with all at once
_WORTH = 0.5  # of the actions: so many that are too dear are left out before anything else

_DEAR = 1000  # times what is to be proved: what it costs a relaxed solution to go beyond a limit


class Packing(NamedTuple):
    """Weighted cuts; with the costs of the actions taken as used, the weights add up to a lower bound.

    ``limits`` are the weights of limits, by their place; what is left of a limit, times its weight, is taken
    from the bound. What is left of the bound is rounded up at the coordinate ``rounded``.
    """

    weights: tuple[tuple[Cut, Vector], ...]
    limits: tuple[tuple[int, Vector], ...] = ()
    rounded: int | None = None


class Hopeless(NamedTuple):
    """A cut without members: under the branches taken, nothing reaches the targets."""

    cut: Cut


class Broken(NamedTuple):
    """Under the branches taken, a rule is broken: no derivation that keeps to it has the actions used."""

    rule: int


class Branch(NamedTuple):
    """Two proofs: for all derivations without an action, and for all those with it."""

    action: int
    without: "Proof"
    using: "Proof"


class Dear(NamedTuple):
    """Weights by which a derivation with any of some actions costs too much, and a proof for all others."""

    actions: tuple[int, ...]
    packing: Packing
    others: "Proof"


Proof = Packing | Hopeless | Broken | Branch | Dear
# An action, and the cases without it and with it, told apart further.
Cases = tuple[int, "Cases", "Cases"] | None


# Proves the same of derivations with none of some actions, with some cuts to begin with.
Others = Callable[[frozenset[int], Collection[frozenset[int]]], Proof]

# Looks for a proof that no derivation of targets by some actions costs less than a total, all costs being
# whole, with cuts to begin with, until it is expired. Weights are to be rounded up.
Search = Callable[
    [
        Hypergraph,
        Iterable[int],
        Collection[int],
        Callable[[int], int],
        Iterable[Collection[int]],
        int,
        Callable[[], bool],
    ],
    Proof | None,
]


class Rules(Protocol):
    """Rules that derivations keep to, and that neither targets nor limits say."""

    def bars(self, used: frozenset[int], without: frozenset[int]) -> Mapping[int, frozenset[int]]:
        """Return by rule the actions that are in no derivation with those used and none of the others."""

    def breaking(self, derivation: frozenset[int]) -> Sequence[int]:
        """Return some actions of a derivation by which it breaks a rule, none where it keeps to all."""

    def exceeded(self, derivation: frozenset[int]) -> Limit | None:
        """Return a limit that is not known yet and that a derivation exceeds; from then on it is known."""


class CheaperError(Exception):
    """A derivation was found that costs less than the one to be proved best."""

    def __init__(self, actions: Sequence[int]) -> None:
        super().__init__("a cheaper derivation was found")
        self.actions = tuple(actions)


class _TimeUpError(Exception):
    pass


class Prover:
    """Looks for proofs about one hypergraph, its targets and the cost of each action.

    Derivations with an action of ``forbidden`` do not count, nor do those that go beyond one of the
    ``limits`` or break one of the ``rules``. ``expired`` says when to give up; it is asked between steps that
    take milliseconds on thousands of actions. What actions cost are multiples of those of ``multiples`` that
    are above 0, coordinate by coordinate, so that bounds are rounded up. ``search`` is tried where many
    actions have whole costs, and weights alone do not suffice.
    """

    def __init__(
        self,
        graph: Hypergraph,
        targets: Sequence[int],
        costs: Sequence[Vector],
        order: Lexicographic,
        forbidden: frozenset[int] = frozenset(),
        expired: Callable[[], bool] = lambda: False,
        known: Iterable[Iterable[int]] = (),
        limits: Sequence[Limit] = (),
        rules: Rules | None = None,
        multiples: Sequence[Fraction] = (),
        search: Search | None = None,
    ) -> None:
        self._multiples, self._search = multiples, search
        self._known, self._limits, self._rules = tuple(map(frozenset, known)), [*limits], rules
        self._graph, self._targets, self._costs, self._order = graph, targets, costs, order
        self._forbidden, self._expired = forbidden, expired
        self._random = random.Random(0)
        self._members = cache(graph.crossing)
        floats = [order.approximate(cost) for cost in set(costs)]
        scale, self._scales = 1.0, list[float]()
        for level, rates in enumerate(order.levels):
            largest = max((f[level] for f in floats), default=0.0)
            # rates may all be next to 1, where a solver would see nothing
            unit = largest or 1.0 if rates else 1.0
            self._scales.append(scale / unit)
            scale *= _FINER / (1 + largest / unit)

    def scaled(self, vector: Vector) -> float:
        """Return a cost as one float, in which a level counts much less than the one before it."""
        return sum(map(mul, self._order.approximate(vector), self._scales), 0.0)

    def prove(self, derivation: Iterable[int], cases: Cases = None) -> Proof | None:
        """Prove that no derivation costs less than this one; ``None`` where that takes too long.

        ``cases`` are told apart first, where those cuts that are known do not suffice. Raises
        :class:`CheaperError` when a derivation is met that costs less.
        """
        actions = frozenset(derivation)
        try:
            goal, nothing = self._total(actions), frozenset[int]()
            return self._prove(actions, goal, nothing, self._forbidden, self._known, cases, first=True)
        except _TimeUpError:
            return None

    def prove_none(self) -> Proof | None:
        """Prove that there is no derivation; ``None`` where that takes too long or there is one."""
        try:
            return self._prove(frozenset(), None, frozenset(), self._forbidden)
        except _TimeUpError:
            return None

    def relax(self, derivation: Iterable[int]) -> tuple[Packing, Vector] | None:
        """Return the weights, and their sum, that the relaxation alone has to offer: a lower bound.

        Cuts are grown with a good derivation in mind. ``None`` where there was no time, and where the targets
        are out of reach.
        """
        nothing: frozenset[int] = frozenset()
        barred = self._bars(nothing, self._forbidden).values()
        cutter = Cutter(self._graph, self._targets, self._forbidden.union(*barred))
        if cutter.hopeless:
            return None
        actions = frozenset(derivation)
        try:
            node = _Node(self, cutter, actions, nothing, self._total(actions))
            exact = node.relax(None)
        except _TimeUpError:
            return None
        return None if exact is None else (node.packing(exact), self.rounded(exact.value)[0])

    def _prove(
        self,
        derivation: frozenset[int],
        goal: Vector | None,
        used: frozenset[int],
        forbidden: frozenset[int],
        known: Collection[frozenset[int]] = (),
        cases: Cases = None,
        first: bool = False,
    ) -> Proof:
        """Prove that derivations with the used actions and none of the forbidden cost at least ``goal``.

        ``None`` as the goal is more than any costs: there is none. Cuts that are ``known`` are tried first.
        ``first`` is where nothing is told apart so far, but for what is too dear.
        """
        targets = [*self._targets, *(o for action in sorted(used) for o in self._graph.needs[action])]
        bars = self._bars(used, forbidden)
        for rule, barred in bars.items():
            if not used.isdisjoint(barred):
                return Broken(rule)
        cutter = Cutter(self._graph, targets, forbidden.union(*bars.values()))
        if cutter.hopeless:
            return Hopeless(cutter.hopeless)
        left = None if goal is None else minus(goal, self._total(used))
        undecided = set(cutter.actions) - used if cases else ()
        while cases is not None and cases[0] not in undecided:
            cases = cases[2] if cases[0] in used else cases[1]
        widened: Sequence[Cut] = ()
        if left is not None:

            def others(dear: frozenset[int], known: Collection[frozenset[int]]) -> Proof:
                return self._prove(derivation, goal, used, forbidden | dear, known, cases, first)

            many = len(cutter.actions) > _MANY or (first and forbidden != self._forbidden)
            step = self._step() if many else Fraction(0)
            alone = cases is not None and not first
            found, widened = self._packed(cutter, used, left, known, others, step, alone, first)
            if found is not None:
                return found
        if cases is not None:
            return self._branch(derivation, goal, used, forbidden, known, cases[0], cases[1:])
        while True:
            node = _Node(self, cutter, derivation, used, goal)
            node.admit(widened)
            exact = node.relax(left)
            if exact is not None and node.suffices(exact.value, left):
                return node.packing(exact)
            action = node.undecided()
            taken = [] if action is not None else node.taken()
            limit = self._exceeded(taken)
            if limit is None:
                break
            self._limits.append(limit)
            widened = node.cuts
        if action is None:
            breaking = [a for a in self._breaking(taken) if a not in used]
            if not breaking:
                cheaper = goal is not None and self._order.compare(self._total(taken), goal) < 0
                if cheaper and cutter.reached_by(taken) and not node.exceeds(taken):
                    raise CheaperError(self._able(taken))
                raise _TimeUpError  # floats led nowhere
            action = breaking[0]
        known = [frozenset(cut.objects) for cut in node.cuts]
        return self._branch(derivation, goal, used, forbidden, known, action, (None, None))

    def _branch(
        self,
        derivation: frozenset[int],
        goal: Vector | None,
        used: frozenset[int],
        forbidden: frozenset[int],
        known: Collection[frozenset[int]],
        action: int,
        told: Sequence[Cases],
    ) -> Branch:
        """Prove the same of derivations without an action, and of those with it."""
        without, using = told
        return Branch(
            action,
            self._prove(derivation, goal, used, forbidden | {action}, known, without),
            self._prove(derivation, goal, used | {action}, forbidden, known, using),
        )

    def rounded(self, bound: Vector) -> tuple[Vector, int | None]:
        """Round up a bound at the first coordinate that is no multiple of what all costs are multiples of."""
        for place, (part, multiple) in enumerate(zip(bound, self._multiples, strict=False)):
            if multiple and part % multiple:
                after = self._order.zero[place + 1 :]
                return (*bound[:place], math.ceil(part / multiple) * multiple, *after), place
        return bound, None

    def _bars(self, used: frozenset[int], without: frozenset[int]) -> Mapping[int, frozenset[int]]:
        return {} if self._rules is None else self._rules.bars(used, without)

    def _breaking(self, derivation: Iterable[int]) -> Sequence[int]:
        return () if self._rules is None else self._rules.breaking(frozenset(derivation))

    def _exceeded(self, derivation: Iterable[int]) -> Limit | None:
        chosen = frozenset(derivation)
        return None if self._rules is None or not chosen else self._rules.exceeded(chosen)

    def _able(self, actions: Sequence[int]) -> list[int]:
        """Return those of some actions that can run by these alone."""
        graph = self._graph
        reached = graph.reach(frozenset(range(len(graph.needs))).difference(actions))
        return [action for action in actions if all(reached[o] for o in graph.needs[action])]

    def _packed(
        self,
        cutter: Cutter,
        used: frozenset[int],
        goal: Vector,
        known: Collection[frozenset[int]],
        others: Others,
        step: Fraction,
        alone: bool,
        first: bool,
    ) -> tuple[Proof | None, Sequence[Cut]]:
        """Return a proof of ``goal``, if one is found without exact arithmetic, and all cuts.

        The weights of the ``known`` cuts are tried first. Where many actions cost multiples of a ``step``,
        what is too dear by them is left out, if it is worth it, with a proof for ``others``. The same is done
        with the weights of a relaxed solution in floats, rounded, if not ``alone``. The search comes last,
        where nothing is told apart so far.
        """
        targets = set(cutter.targets)
        known = [cut for cut in known if not targets.isdisjoint(cut)]
        cuts = [self._widened(cutter, cut) for cut in known[:_GREEDY]]
        cuts = [cut for cut in cuts if used.isdisjoint(cut.members)]
        packing, rests = self._share_out((cut, None) for cut in cuts)
        if self._reaches(packing, goal):
            return packing, cuts
        found = self._narrowed(cutter, used, goal, packing, rests, others, known, step)
        if found is not None or alone or not step:
            return found, cuts

        def steps(action: int) -> int:
            return 0 if action in used else int(self._costs[action][0] / step)

        enough = math.ceil(goal[0] / step)

        def heard(shared: SharedCosts) -> int:
            spare = (enough - 1) * PARTS - shared.bound
            dear = sum(rest > spare for rest in shared.left.values())
            return 0 if dear > _WORTH * len(cutter.actions) else enough

        shared = share_costs(
            *(self._graph, targets, cutter.actions, steps, known, enough, self._expired, heard),
            often=1,
        )
        if shared is not None:
            told = [(self._widened(cutter, cut), (weight * step / PARTS,)) for cut, weight in shared.cuts]
            told = [(cut, weight) for cut, weight in told if used.isdisjoint(cut.members)]
            packing, rests = self._share_out(told)
            if self._reaches(packing, goal):
                return packing, cuts
            found = self._narrowed(cutter, used, goal, packing, rests, others, shared.tight, step)
            if found is not None:
                return found, cuts
            cuts += [cut for cut, _ in told]
        return self._searched(cutter, goal, cuts, step) if first else None, cuts

    def _step(self) -> Fraction:
        """Return what all costs are multiples of, where they are one number each; else 0."""
        told = self._limits or self._rules is not None
        one = len(self._multiples) == 1 == len(self._order.zero)
        return self._multiples[0] if one and not told else Fraction(0)

    def _narrowed(
        self,
        cutter: Cutter,
        used: frozenset[int],
        goal: Vector,
        packing: Packing,
        rests: Mapping[int, Vector],
        others: Others,
        known: Collection[frozenset[int]],
        step: Fraction,
    ) -> Proof | None:
        """Leave out what is too dear by weights that leave ``rests`` of costs, where it is a good part.

        A derivation with an action costs at least what the weights add up to and what they leave of it.
        """
        if not step:
            return None
        spare = (math.ceil(goal[0] / step) - 1) * step - sum(weight[0] for _, weight in packing.weights)
        costs = ((a, rests.get(a, self._costs[a])[0]) for a in cutter.actions if a not in used)
        dear = frozenset(a for a, rest in costs if rest > spare)
        if len(dear) <= _WORTH * len(cutter.actions):
            return None
        proof = others(dear, known)
        needed = dear.intersection(self._crossing(proof))
        return Dear(tuple(sorted(needed)), packing._replace(rounded=0), proof) if needed else proof

    def _crossing(self, proof: Proof) -> Iterator[int]:
        """Return the actions that cross cuts of a proof, those that are left out somewhere with them."""
        for objects in {cut.objects for cut in _cuts(proof)}:
            yield from self._members(frozenset(objects))

    def _widened(self, cutter: Cutter, objects: Iterable[int]) -> Cut:
        """Return a cut with more objects, if any action crosses it that cannot run."""
        inside = frozenset(o for o in objects if not self._graph.at_start[o])
        members = cutter.among(self._members(inside))
        return cutter.widened(inside) if members is None else Cut(tuple(sorted(inside)), members)

    def _searched(self, cutter: Cutter, goal: Vector, known: Sequence[Cut], step: Fraction) -> Proof | None:
        """Let the search find a proof, and state it with cuts that hold for all actions."""
        if self._search is None or not step:
            return None
        found = self._search(
            *(self._graph, cutter.targets, cutter.actions),
            *(lambda action: int(self._costs[action][0] / step), [cut.objects for cut in known]),
            *(math.ceil(goal[0] / step), self._expired),
        )

        widened = cache(partial(self._widened, cutter))

        def packed(packing: Packing) -> Packing:
            weights = [(widened(cut.objects), (weight[0] * step,)) for cut, weight in packing.weights]
            _, rounded = self.rounded(self._order.total(weight for _, weight in weights))
            return Packing(tuple(weights), rounded=rounded)

        def stated(proof: Proof) -> Proof:
            if isinstance(proof, Branch):
                return Branch(proof.action, stated(proof.without), stated(proof.using))
            if isinstance(proof, Hopeless):
                return Hopeless(widened(proof.cut.objects))
            if isinstance(proof, Dear):
                return Dear(proof.actions, packed(proof.packing)._replace(rounded=0), stated(proof.others))
            assert isinstance(proof, Packing)
            return packed(proof)

        return None if found is None else stated(found)

    def _share_out(self, cuts: Iterable[tuple[Cut, Vector | None]]) -> tuple[Packing, dict[int, Vector]]:
        """Return each cut in turn the weight that its members have left of their costs, or at most another.

        Also give what is left of the costs of all members.
        """
        left: dict[int, Vector] = {}
        weights: list[tuple[Cut, Vector]] = []
        for cut, most in cuts:
            rests = {a: left.get(a, self._costs[a]) for a in cut.members}
            limits = [*rests.values()] if most is None else [*rests.values(), most]
            weight = min(limits, key=cmp_to_key(self._order.compare))
            if self._order.sign(weight) > 0:
                weights.append((cut, weight))
                left.update((a, minus(rest, weight)) for a, rest in rests.items())
        _, rounded = self.rounded(self._order.total(weight for _, weight in weights))
        return Packing(tuple(weights), rounded=rounded), left

    def _reaches(self, packing: Packing, goal: Vector) -> bool:
        """Whether weights add up to a goal, rounded up."""
        value, _ = self.rounded(self._order.total(weight for _, weight in packing.weights))
        return self._order.compare(value, goal) >= 0

    def _total(self, actions: Iterable[int]) -> Vector:
        return self._order.total(self._costs[a] for a in actions)


def _cuts(proof: Proof) -> Iterator[Cut]:
    """Return the cuts of a proof."""
    waiting = [proof]
    while waiting:
        part = waiting.pop()
        if isinstance(part, Branch):
            waiting += [part.without, part.using]
        elif isinstance(part, Dear):
            waiting += [part.packing, part.others]
        elif isinstance(part, Hopeless):
            yield part.cut
        elif isinstance(part, Packing):
            yield from (cut for cut, _ in part.weights)


class _Node:
    """The relaxation at one place of the branching: cuts, their rows, and who covers them.

    ``shares`` are those of the actions, in the solution that was looked at last, ``cuts`` those of the rows.
    """

    def __init__(
        self,
        prover: Prover,
        cutter: Cutter,
        derivation: frozenset[int],
        used: frozenset[int],
        goal: Vector | None,
    ) -> None:
        self._prover, self._cutter, self._used = prover, cutter, used
        self._derivation = sorted(derivation)
        self._actions = cutter.actions
        self._places = {action: place for place, action in enumerate(self._actions)}
        self._costs = [prover._costs[action] for action in self._actions]
        floats = {cost: prover.scaled(cost) for cost in set(self._costs)}
        self._floats = [floats[cost] for cost in self._costs]
        self._limits = [self._limited(place, limit) for place, limit in enumerate(prover._limits)]
        dear = (Fraction(1),) * prover._order.width if goal is None else times(goal, Fraction(_DEAR))
        self._costs += [dear] * len(self._limits)
        self._covering = Covering([*self._floats, *[prover.scaled(dear)] * len(self._limits)])
        for amounts, most in self._limits:
            self._covering.limit(amounts, most)
        told = self._limits or prover._rules is not None
        self._free = [] if told else [place for place, cost in enumerate(self._costs) if not any(cost)]
        self.cuts: list[Cut] = []
        self._rows: list[list[int]] = []
        self.shares: Sequence[float]

    def _limited(self, place: int, limit: Limit) -> Limit:
        """Give what is left of a limit for the columns; the last of them, at a price, makes up what lacks."""
        amounts, most = limit
        taken = {self._places[a]: amount for a, amount in amounts.items() if a in self._places}
        left = most - sum(amounts[a] for a in self._used if a in amounts)
        return {**taken, len(self._actions) + place: Fraction(-1)}, left

    def exceeds(self, actions: Iterable[int]) -> bool:
        """Whether actions go beyond a limit."""
        chosen = set(actions)
        return any(
            sum(amount for a, amount in amounts.items() if a in chosen) > most
            for amounts, most in self._prover._limits
        )

    def suffices(self, value: Vector, enough: Vector | None) -> bool:
        """Whether a bound is enough; ``None`` is more than nothing."""
        order = self._prover._order
        if enough is None:
            return order.sign(value) > 0
        return order.compare(self._prover.rounded(value)[0], enough) >= 0

    def relax(self, enough: Vector | None) -> ExactOptimum | None:
        """Add cuts until none is found that the relaxed solution misses, or the bound is enough."""
        order = self._prover._order
        wanted = math.inf if enough is None else self._prover.scaled(enough)
        if enough is not None and len(enough) == len(self._prover._multiples) == 1:  # more than one step less
            wanted -= _STEP * self._prover.scaled((self._prover._multiples[0],))
        while True:
            self._check()
            relaxed = self._covering.solve(self._prover._expired)
            self._check()
            self._share(relaxed.x)
            if relaxed.value < wanted * 0.9999999 and self._separate():
                continue
            exact = exact_optimum(self._rows, self._costs, order, relaxed.columns, relaxed.rows, self._limits)
            if exact is not None:
                if enough is not None and self.suffices(exact.value, enough):
                    return exact
                self._share([float(exact.x.get(place, 0)) for place in range(len(self._actions))])
            if not self._separate():
                return exact

    def _check(self) -> None:
        if self._prover._expired():
            raise _TimeUpError

    def _share(self, x: Sequence[float]) -> None:
        """Record a solution, with all that costs nothing and is in no limit or rule taken as a whole."""
        self.shares = [*x]
        for place in self._free:
            self.shares[place] = 1.0

    def packing(self, exact: ExactOptimum) -> Packing:
        """Return the weighted cuts of an exact optimum."""
        weights = sorted(exact.weights.items())
        first = len(self._limits)
        return Packing(
            tuple((self.cuts[row - first], weight) for row, weight in weights if row >= first),
            tuple((row, weight) for row, weight in weights if row < first),
            self._prover.rounded(exact.value)[1],
        )

    def undecided(self) -> int | None:
        """Return the action that is most nearly half taken, the most expensive of several; else ``None``."""
        halves = [
            (abs(x - 0.5), -self._floats[place], self._actions[place])
            for place, x in enumerate(self.shares[: len(self._actions)])
            if abs(x - 0.5) < 0.499999
        ]
        return min(halves)[2] if halves else None

    def taken(self) -> list[int]:
        """Return the actions that the relaxed solution takes, with those that are used anyway."""
        shares = zip(self._actions, self.shares, strict=False)  # after those of actions come those of limits
        return sorted({action for action, x in shares if round(x)} | self._used)

    def _separate(self) -> bool:
        """Look for cuts whose landmarks have shares of less than 1; whether there were any."""
        return self._admit_beside() or any(self._admit_missed() for _ in range(_ORDERS))

    def _admit_beside(self) -> bool:
        """Grow cuts with no action in common, of dear ones where it can be, and add those missed."""
        chance = self._prover._random.random
        shares = dict(zip(self._actions, self.shares, strict=False))
        missed: list[Cut] = []
        while len(missed) < _BESIDE:
            dear = {a: cost * (0.5 + chance()) for a, cost in zip(self._actions, self._floats, strict=True)}
            cut = self._cutter.cut(self._used, sorted(self._actions, key=lambda a: (-shares[a], dear[a])))
            if cut is None or sum(shares[a] for a in cut.members) >= _HIT:
                break
            missed.append(cut)
            shares.update(dict.fromkeys(cut.members, 1.0))
        self.admit(missed)
        return bool(missed)

    def _admit_missed(self) -> bool:
        """Grow cuts in an order with great shares first, arbitrary else, and add those that are missed."""
        arbitrary = self._prover._random.random
        order = sorted(self._actions, key=lambda a: (-self.shares[self._places[a]], arbitrary()))
        keeps = [[b for b in self._derivation if b != a] for a in self._derivation]
        missed: dict[tuple[int, ...], Cut] = {}
        for keep in (*keeps, ()):
            cut = self._cutter.cut([*keep, *self._used], order)
            if cut is not None and sum(self.shares[self._places[a]] for a in cut.members) < _HIT:
                missed[cut.members] = cut
        self.admit(missed.values())
        return bool(missed)

    def admit(self, cuts: Iterable[Cut]) -> None:
        """Add cuts, all whose members the targets can need."""
        for cut in cuts:
            if self._places.keys() >= set(cut.members):
                row = [self._places[a] for a in cut.members]
                self.cuts.append(cut)
                self._rows.append(row)
                self._covering.add(row)
