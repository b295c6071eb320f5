"""Costs shared out among all cuts: bounds that hold whatever floats say, held against brute force."""

import random
from collections.abc import Callable, Iterator, Sequence
from itertools import combinations
from typing import Any

import pytest

from foon_asp.asp import Settings, solve
from foon_asp.bounds import shared_costs
from foon_asp.bounds.cut import Cut, Cutter
from foon_asp.bounds.hypergraph import Hypergraph
from foon_asp.bounds.landmark_cuts import Cuts, WeightedCut
from foon_asp.bounds.relaxation import Covering, Relaxed, UnsolvedError, Weighed
from foon_asp.bounds.shared_costs import PARTS, SharedCosts, _Sharing, share_costs
from foon_asp.certificate import certify
from foon_asp.problem import ContainerRule, Objective, levels
from foon_asp.reduce import ALL, NONE, ExactCosts, Listener, Reduced, Reduction, reduce, reduction
from foon_asp.reduce.graph import Graph
from tests.plain_graphs import Action, plain_problem
from tests.random_problems import random_problem
from tests.test_reduction import after


def never() -> bool:
    return False


def random_graph(rng: random.Random) -> Hypergraph:
    """Draw a graph with cycles, in which every action can run."""
    size, actions = rng.randint(4, 8), rng.randint(4, 11)
    needs = [rng.sample(range(size), rng.randint(0, 2)) for _ in range(actions)]
    gives = [rng.sample(range(size), rng.randint(1, 2)) for _ in range(actions)]
    reached = Hypergraph(size, needs, gives, [0]).reach()
    able = [a for a in range(actions) if all(reached[o] for o in needs[a])]
    return Hypergraph(size, [needs[a] for a in able], [gives[a] for a in able], [0])


def cheapest(graph: Hypergraph, targets: list[int], costs: list[int]) -> int:
    """Try all sets of actions."""
    everything = range(len(graph.needs))

    def able() -> Iterator[int]:
        for size in range(len(costs) + 1):
            for chosen in combinations(everything, size):
                reached = graph.reach(frozenset(everything) - set(chosen))
                if all(reached[o] for o in targets):
                    yield sum(costs[a] for a in chosen)

    return min(able())


def require_holds(graph: Hypergraph, targets: list[int], costs: list[int], found: SharedCosts) -> None:
    load = [0] * len(costs)
    for objects, weight in found.cuts:
        assert weight > 0
        assert objects & set(targets)
        assert objects.isdisjoint(graph.start)
        for action, (needs, gives) in enumerate(zip(graph.needs, graph.gives, strict=True)):
            if objects & set(gives) and objects.isdisjoint(needs):
                load[action] += weight
    assert found.bound == sum(weight for _, weight in found.cuts)
    assert found.left == {a: cost * PARTS - load[a] for a, cost in enumerate(costs)}
    assert min(found.left.values()) >= 0
    assert found.bound <= cheapest(graph, targets, costs) * PARTS


def asked(seed: int) -> tuple[Hypergraph, list[int], list[int]]:
    rng = random.Random(seed)
    graph = random_graph(rng)
    able = [o for o in range(1, graph.size) if graph.reach()[o]]
    targets = rng.sample(able, min(len(able), rng.randint(1, 3)))
    return graph, targets, [rng.choice([1, 1, 2, 10**12]) for _ in graph.needs]


@pytest.mark.parametrize("wrong", [False, True])
@pytest.mark.parametrize("seed", range(40))
def test_no_derivation_costs_less_than_the_bound(
    seed: int, wrong: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    graph, targets, costs = asked(seed)
    if wrong:  # nothing that HiGHS says of weights makes a bound too great
        drawn, told, amid = random.Random(seed), Covering.weights, Covering.inside

        def inside(relaxation: Covering, expired: Callable[[], bool]) -> Weighed | None:
            found = amid(relaxation, expired)
            return found and found._replace(weights=[drawn.uniform(-1, 3) for _ in found.weights])

        monkeypatch.setattr(Covering, "inside", inside)
        monkeypatch.setattr(Covering, "weights", lambda it: [drawn.uniform(-1, 3) for _ in told(it)])
    found = share_costs(graph, targets, range(len(costs)), costs.__getitem__, (), 10**15, lambda: False)
    assert (found is None) == (not targets)
    if found is not None:
        require_holds(graph, targets, costs, found)


def test_shares_are_halves_where_three_landmarks_overlap() -> None:
    # each pair of three actions is a landmark: greedy weights come to 1, the best to 3/2, every tree to 2
    graph = Hypergraph(4, [[], [], []], [[1, 2], [2, 3], [1, 3]], [0])
    found = share_costs(graph, [1, 2, 3], range(3), lambda _: 1, (), 2, lambda: False)
    assert found is not None
    assert (found.bound, found.left) == (PARTS * 3 // 2, dict.fromkeys(range(3), 0))
    assert sorted(map(sorted, (objects for objects, _ in found.cuts))) == [[1], [2], [3]]
    assert found.shares == pytest.approx(dict.fromkeys(range(3), 0.5))
    known = [{1}]
    late = share_costs(graph, [1, 2, 3], range(3), lambda _: 1, known, 2, lambda: True)
    assert late is not None
    assert (late.bound, late.cuts) == (PARTS, [(frozenset({1}), PARTS)])
    assert share_costs(graph, [0], range(3), lambda _: 1, (), 2, lambda: False) is None


@pytest.mark.parametrize("seed", range(8))
def test_costs_that_no_float_can_hold(seed: int) -> None:
    graph, targets, costs = asked(seed)
    costs = [cost * 10**400 + cost for cost in costs]
    found = share_costs(graph, targets, range(len(costs)), costs.__getitem__, (), 10**430, lambda: False)
    assert found is not None
    require_holds(graph, targets, costs, found)


class Told:
    """In place of HiGHS: says a value for each solution, the same shares in all, and weights.

    With ``amid``, solutions are those that are no corners, too.
    """

    def __init__(self, values: Sequence[float], shares: list[float], weights: Sequence[float] = ()) -> None:
        self._values, self._shares, self._weights = values, shares, weights
        self.solved, self.amid = 0, False
        self.rows: list[tuple[int, ...]] = []

    def add(self, row: Sequence[int]) -> None:
        self.rows.append(tuple(row))

    def inside(self, expired: Callable[[], bool]) -> Weighed | None:
        if not self.amid:
            return None
        solved = self.solve(expired)
        return Weighed(solved.value, solved.x, self.weights())

    def solve(self, expired: Callable[[], bool]) -> Relaxed:
        self.solved += 1
        return Relaxed(self._values[self.solved - 1], self._shares, [], [])

    def weights(self) -> list[float]:
        return [*self._weights, *[0.0] * (len(self.rows) - len(self._weights))]


def told(monkeypatch: pytest.MonkeyPatch, targets: int, told: Told, enough: int) -> int:
    """Share out costs of 2 among targets of one action each, and give how many cuts were asked for."""
    asked, find = list[tuple[int, ...]](), Cutter.cut

    def cut(cutter: Cutter, keep: tuple[int, ...], order: list[int]) -> Cut | None:
        asked.append(keep)
        return find(cutter, keep, order)

    with monkeypatch.context() as patched:
        patched.setattr(shared_costs, "Covering", lambda _: told)
        patched.setattr(Cutter, "cut", cut)
        every = range(targets)
        graph = Hypergraph(targets + 1, [[]] * targets, [[a + 1] for a in every], [0])
        goals = range(1, targets + 1)
        share_costs(graph, goals, every, lambda _: 2, (), enough, lambda: len(asked) > 9999)
    return len(asked)


# by the dearest action, 101 would be enough: a hundredth of what lacks, and no more, has to come of eight
# costs are whole, so a little more than 201 is as good as 202
ENDS = [
    ([0.0] * 30, 9),
    ([0.0] * 8 + [1.0] * 30, 17),
    ([0.0, 100.506], 2),
    ([0.0] + [100.5] * 9, 10),
]


def test_cuts_are_looked_for_until_they_bring_little(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(shared_costs, "_SMALL", 0)  # before all targets together
    for values, solved in ENDS:
        relaxation = Told(values, [0.0] * 50)
        assert told(monkeypatch, 50, relaxation, 202) == 40 * (solved - 1)
        assert (relaxation.solved, len(relaxation.rows)) == (solved, 40 * (solved - 1))
    relaxation = Told([0.0] * 9, [0.998] * 3)
    assert told(monkeypatch, 3, relaxation, 202) == 8 * 4  # the fourth is known
    assert sorted(relaxation.rows) == sorted([(0,), (1,), (2,)] * 8)
    relaxation = Told([0.0], [0.999] * 3)
    assert (told(monkeypatch, 3, relaxation, 202), relaxation.rows) == (1, [])
    sharing = _Sharing(Hypergraph(2, [[]], [[1]], [0]), [1], [0], lambda _: 1, never)
    assert sharing._separate([0.0], lambda: True) is False
    assert (sharing._separate([0.0], lambda: False), sharing._rows) == (True, [[0]])


def test_each_target_that_needs_few_actions_has_cuts_by_itself(monkeypatch: pytest.MonkeyPatch) -> None:
    for values, solved in ENDS:
        relaxation = Told(values, [0.0] * 50)
        assert told(monkeypatch, 50, relaxation, 202) == 2 * 50 * (solved - 1)  # the second is known
        assert sorted(relaxation.rows) == [(a,) for a in range(50) for _ in range(solved - 1)]
    relaxation = Told([0.0], [0.999] * 3)
    assert (told(monkeypatch, 3, relaxation, 202), relaxation.rows) == (3, [])


def test_targets_are_looked_at_by_themselves_only_where_that_takes_little() -> None:
    # four things from nothing, of which the targets need one, one, three and, after a way of 32 actions, one
    needs = [[], [], [], [], [1, 2, 3], [4], *[[6 + n] for n in range(31)]]
    gives = [[1], [2], [3], [4], *[[5 + n] for n in range(33)]]
    graph = Hypergraph(38, needs, gives, [0])
    sharing = _Sharing(graph, [1, 2, 5, 37], range(37), lambda _: 1, never)
    assert [cutter.actions for cutter in sharing._alone] == [[0], [1], [0, 1, 2, 4]]
    assert [len(cutter.actions) for cutter in sharing._together] == [33]
    assert sharing._separate([1.0] * 36 + [0.0], lambda: False)
    assert sharing._rows == [[36]]


@pytest.mark.parametrize(
    ("needed", "actions", "effort", "alone", "together"),
    [
        ([1], 4, 4, [], [1]),  # it has no others beside it
        ([1, 1], 4, 4, [1, 1], []),
        ([2, 1], 4, 4, [2, 1], []),
        ([3, 1], 4, 4, [1], [3]),  # too many are needed, which takes as long to find out
        ([2, 2, 1], 5, 4, [2, 2], [1]),
    ],
)
def test_how_many_targets_are_looked_at_by_themselves(
    needed: list[int],
    actions: int,
    effort: int,
    alone: list[int],
    together: list[int],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Each target needs some actions that make something of nothing, and one that makes the target of it."""
    monkeypatch.setattr(shared_costs, "_ALONE", effort / actions)
    needs: list[list[int]] = []
    for count in needed:
        first = len(needs) + 1
        needs += [*[[]] * (count - 1), [*range(first, first + count - 1)]]
    targets = [sum(needed[: place + 1]) for place in range(len(needed))]
    needs += [[]] * (actions - len(needs))
    graph = Hypergraph(actions + 1, needs, [[a + 1] for a in range(actions)], [0])
    sharing = _Sharing(graph, targets, range(actions), lambda _: 1, never)
    assert [len(cutter.actions) for cutter in sharing._alone] == alone
    assert [len(cutter.actions) for cutter in sharing._together] == together


def test_dear_actions_are_cut_first() -> None:
    graph = Hypergraph(3, [[], [1], []], [[1], [2], [2]], [0])
    sharing = _Sharing(graph, [2], range(3), [1, 4, 10**6].__getitem__, never)
    for _ in range(9):
        assert sharing._separate([0.0] * 3, lambda: False)
    assert sharing._rows == [[1, 2]] * 9


def test_weights_are_those_wanted_and_what_is_left_goes_to_the_greatest(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    relaxation = Told([0.0], [0.5, 0.25, 0.0, 0.0, 1.0], [0.5, 0.75, -1.0, 0.0, 1 / 3, 2 / 3])
    monkeypatch.setattr(shared_costs, "Covering", lambda _: relaxation)
    graph = Hypergraph(7, [[]] * 5, [[1], [1, 2], [2, 3, 4], [3], [5, 6]], [0])
    rows = [(0, 1), (1, 2), (2, 3), (2,), (4,), (4,)]
    targets = range(1, 7)
    found = share_costs(graph, targets, range(5), lambda _: 12, [{o} for o in targets], 99, lambda: True)
    weights = {0: 3, 1: 9, 2: 3, 4: 4, 5: 8}
    left = {0: 9, 1: 0, 2: 0, 3: 9, 4: 0}
    assert found == SharedCosts(
        27 * PARTS,
        {a: rest * PARTS for a, rest in left.items()},
        [(frozenset({place + 1}), weight * PARTS) for place, weight in weights.items()],
        {0: 0.5, 1: 0.25, 2: 0.0, 3: 0.0, 4: 1.0},
        [frozenset({o}) for o in targets],
    )
    assert relaxation.rows == rows


def shared_of_five(relaxation: Told, enough: int, monkeypatch: pytest.MonkeyPatch) -> int:
    """Share out costs of 10 among five targets of one action each; gives the bound."""
    with monkeypatch.context() as patched:
        patched.setattr(shared_costs, "Covering", lambda _: relaxation)
        graph = Hypergraph(6, [[]] * 5, [[n] for n in range(1, 6)], [0])
        known = [{n + 1} for n in range(5)]
        found = share_costs(graph, range(1, 6), range(5), lambda _: 10, known, enough, lambda: False)
    assert found is not None
    return found.bound


def test_a_solution_amid_others_is_enough_where_its_weights_are(monkeypatch: pytest.MonkeyPatch) -> None:
    # what is left of the costs goes to the cuts as well, so all five are known to come to 50
    exact = Told([5.0] * 3, [1.0] * 5, [1.0] * 5)
    exact.amid = True
    assert (shared_of_five(exact, 50, monkeypatch), exact.solved) == (50 * PARTS, 1)
    # the value says more than the weights come to: a corner is looked for
    vague = Told([5.002, 5.0], [1.0] * 5, [1.0] * 5)
    vague.amid = True
    assert (shared_of_five(vague, 50, monkeypatch), vague.solved) == (50 * PARTS, 2)
    near = Told([5.0009], [1.0] * 5, [1.0] * 5)
    near.amid = True
    assert (shared_of_five(near, 50, monkeypatch), near.solved) == (50 * PARTS, 1)


def test_where_a_solution_amid_others_misses_no_cut_a_corner_may(monkeypatch: pytest.MonkeyPatch) -> None:
    some = Told([4.0, 4.0], [1.0] * 5, [1.0] * 5)
    some.amid = True
    assert (shared_of_five(some, 50, monkeypatch), some.solved) == (50 * PARTS, 2)


def test_where_time_is_up_the_last_solution_counts(monkeypatch: pytest.MonkeyPatch) -> None:
    class Ended(Told):
        def inside(self, expired: Callable[[], bool]) -> Weighed | None:
            return None if self.solved else super().inside(expired)

    relaxation = Ended([1.0], [0.0] * 5, [0.5])
    relaxation.amid = True
    looks = iter([False] * 6)  # within the round of cuts that follows, and then time is up
    monkeypatch.setattr(shared_costs, "Covering", lambda _: relaxation)
    graph = Hypergraph(6, [[]] * 5, [[n] for n in range(1, 6)], [0])
    known = [{1}]
    found = share_costs(graph, range(1, 6), range(5), lambda _: 10, known, 50, lambda: next(looks, True))
    assert found is not None
    assert relaxation.solved == 1
    assert found.bound > 10 * PARTS  # rows that came later have what is left
    require_holds(graph, [*range(1, 6)], [10] * 5, found)


def test_what_is_known_is_heard_of_now_and_then(monkeypatch: pytest.MonkeyPatch) -> None:
    """Who hears of it says what is enough, and when that is all; cuts hit more than once are not tight."""
    heard: list[SharedCosts] = []

    def shared(*enough: int) -> tuple[SharedCosts | None, int]:
        relaxation = Told([0.1 * n for n in range(40)], [0.0, 1.5, 0.0], [0.5])
        answers = iter(enough)
        heard.clear()

        def hear(shared: SharedCosts) -> int:
            heard.append(shared)
            return next(answers)

        with monkeypatch.context() as patched:
            patched.setattr(shared_costs, "Covering", lambda _: relaxation)
            graph = Hypergraph(4, [[]] * 3, [[1], [2], [3]], [0])
            known = [{2}]
            found = share_costs(graph, [1, 2, 3], range(3), lambda _: 10, known, 99, lambda: False, hear)
        return found, relaxation.solved

    found, solved = shared(0)
    assert (found, solved) == (heard[0], 8)
    assert {*heard[0].tight} == {frozenset({1}), frozenset({3})}
    found, solved = shared(99, 99, 0)
    assert (found, solved, len(heard)) == (heard[-1], 24, 3)
    found, solved = shared(8)  # which the ninth solution comes to
    assert (solved, len(heard)) == (9, 1)
    require_holds(Hypergraph(4, [[]] * 3, [[1], [2], [3]], [0]), [1, 2, 3], [10] * 3, heard[0])


def test_where_highs_finds_nothing_what_is_known_counts(monkeypatch: pytest.MonkeyPatch) -> None:
    class Lost(Told):
        def solve(self, expired: Callable[[], bool]) -> Relaxed:
            if self.solved == self.most:
                raise UnsolvedError
            return super().solve(expired)

        most = 0

    relaxation = Lost([0.0] * 9, [0.0], [0.5])
    graph = Hypergraph(2, [[]], [[1]], [0])
    monkeypatch.setattr(shared_costs, "Covering", lambda _: relaxation)
    assert share_costs(graph, [1], [0], lambda _: 10, (), 99, lambda: False) is None
    relaxation.most = 1
    found = share_costs(graph, [1], [0], lambda _: 10, (), 99, lambda: False)
    assert found is not None
    require_holds(graph, [1], [10], found)


@pytest.mark.parametrize("rule", ContainerRule)
@pytest.mark.parametrize("seed", range(25))
def test_answers_are_those_of_the_plain_program(
    seed: int, rule: ContainerRule, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(reduction, "_SMALL", 0)
    # all that the greedy cuts leave is left to the shared costs, of which is heard each time
    monkeypatch.setattr(shared_costs, "_OFTEN", 1)
    monkeypatch.setattr(reduction, "_DENSE", seed % 2 / 600)  # hardly any member, or none
    monkeypatch.setattr(reduction, "_ROUNDS", 1)
    monkeypatch.setattr(reduction, "improved", lambda graph, few, tree, *_: tree)
    problem = random_problem(seed, rule, units=14)
    objectives = [(Objective.UNITS,), (Objective.PRICE,), (Objective.SUCCESS,), (Objective.KITCHEN,)][
        seed % 4
    ]
    plain = solve(problem, objectives, Settings(reductions=NONE))
    for reductions in (ALL, frozenset({Reduction.DEAR}), frozenset({Reduction.BOUNDS})):
        outcome = solve(problem, objectives, Settings(reductions=reductions))
        assert outcome.status is plain.status
        if plain.costs is not None and outcome.costs is not None and outcome.units is not None:
            by = levels(objectives)
            assert outcome.costs.key(by) == plain.costs.key(by), reductions
            assert certify(problem, by, outcome.units, cuts=outcome.cuts) is not None


# --- In the course of the reductions, of cuts that prove a bound of 1 and of what is told of shared costs.

# The goal comes of two things, of three or of four, each of a unit of its own. TWIN does what the last of
# MORE does, and of BOTH the first gives a thing of MORE and one of MOST, and takes what the other one gives.
THINGS = [10, 11], [20, 21, 22], [30, 31, 32, 33]
WAYS: list[Action] = [
    way for things in THINGS for way in (*(([0], [thing]) for thing in things), (things, [1]))
]
WAYS += [WAYS[6], ([50], [20, 30]), ([0], [50])]
FEW, MORE, MOST, TWIN, BOTH = map(frozenset, ([0, 1, 2], [3, 4, 5, 6], [7, 8, 9, 10, 11], [12], [13, 14]))
BOUNDS, DEAR, DOMINATED = (frozenset({r}) for r in (Reduction.BOUNDS, Reduction.DEAR, Reduction.DOMINATED))
FIRST = [frozenset({1})]  # the cut that is known at first
Answer = tuple[int, dict[int, int]] | None  # a bound, and what is left of some units, in parts


class Course(Listener):
    """Reduces, and keeps what is heard of trees and bounds, how many are left, and the cuts known then."""

    def __init__(self, *told: Answer) -> None:
        self.told = told
        self.trees: list[frozenset[int]] = []
        self.bounds: list[int] = []
        self.left: list[int] = []
        self.known: list[object] = []
        self.given: list[SharedCosts] = []
        self.late = False

    def tree(self, units: frozenset[int]) -> None:
        self.trees.append(units)

    def bound(self, costs: ExactCosts, bound: int) -> None:
        self.bounds.append(bound)

    def share(
        self, graph: Graph, goals: object, left: set[int], costs: object, known: object, *rest: Any
    ) -> SharedCosts | None:
        enough, _, heard = rest
        assert heard
        assert (goals, enough, self.late) == (graph.goals, len(self.trees[-1]), False)
        told = self.told[len(self.left)]
        self.left.append(len(left))
        self.known.append(known)
        if told is None:
            return None
        every = range(len(graph.needs))
        found = SharedCosts(told[0], {**dict.fromkeys(every, 0), **told[1]}, [], dict.fromkeys(every, 0.0))
        self.given.append(found)
        return found

    def reduce(
        self,
        monkeypatch: pytest.MonkeyPatch,
        reductions: frozenset[Reduction],
        objective: Objective = Objective.UNITS,
        rates: str = "1",
        *,
        expired: Callable[[], bool] = lambda: False,
        small: int = 0,
        easy: int = 99,
        hand: frozenset[int] | None = None,
    ) -> Reduced:
        members = 2, 6, 11, 12
        first = Cuts(1, dict.fromkeys(members, 0), [WeightedCut(FIRST[0], members, members[0], 1)])
        monkeypatch.setattr(reduction, "landmark_cuts", lambda *_: first)
        monkeypatch.setattr(reduction, "improved", lambda _graph, _actions, tree, *_: tree)
        monkeypatch.setattr(reduction, "_SMALL", small)
        monkeypatch.setattr(reduction, "_EASY", easy)
        monkeypatch.setattr(reduction, "_EFFORT", 0)
        monkeypatch.setattr(shared_costs, "share_costs", self.share)
        if hand:
            monkeypatch.setattr(reduction, "without_spare", lambda *_: {*hand})
        problem = plain_problem(WAYS, [1], rates=[rates] * len(WAYS))

        def asked() -> bool:
            self.late = expired()
            return self.late

        return reduce(problem, levels((objective,)), reductions, asked, self)


@pytest.mark.parametrize(
    ("bound", "settled", "heard"),
    [
        (1, False, [1]),
        (PARTS, False, [1]),
        (PARTS + 1, False, [1, 2]),
        (2 * PARTS, False, [1, 2]),
        (2 * PARTS + 1, True, [1, 3]),  # what trees cost is whole
        (3 * PARTS, True, [1, 3]),
        (5 * PARTS, True, [1, 3]),
    ],
)
def test_the_tree_is_proved_optimal_where_nothing_is_below_what_it_costs(
    bound: int, settled: bool, heard: list[int], monkeypatch: pytest.MonkeyPatch
) -> None:
    for reductions in (BOUNDS, BOUNDS | DOMINATED):
        course = Course((bound, {}))
        found = course.reduce(monkeypatch, reductions)
        assert (found.tree, found.settled, found.bound) == (FEW, settled, heard[-1])
        assert (course.trees, course.bounds, course.known) == ([FEW], heard, [FIRST])
        assert found.shared == (course.given[0] if len(heard) > 1 else None)
        assert ({*found.units} >= FEW | MOST) != settled
    for reductions in (DEAR, DOMINATED) if bound <= 3 * PARTS else ():  # what is as good is wanted, too
        course = Course((bound, {}))
        found = course.reduce(monkeypatch, reductions)
        assert (found.settled, found.bound, {*found.units} >= MOST) == (False, heard[-1], True)


def test_where_rates_are_rounded_no_shared_costs_settle_anything(monkeypatch: pytest.MonkeyPatch) -> None:
    doubt = (15 + 1) * 10**20  # of one rounded rate, which counts before 15 units
    for more, stays in ((0, True), (1, False)):
        told = 3 * PARTS, {11: (3 + doubt - 1) * PARTS - 3 * PARTS + more}
        course = Course(told, *[None] * 2)
        found = course.reduce(monkeypatch, BOUNDS | DEAR, Objective.SUCCESS)
        assert found.costs is not None
        assert found.costs.doubt == doubt
        assert (found.settled, found.bound, found.tree) == (False, 3, FEW)
        assert {*found.units} == {*range(15)} - (set() if stays else MOST)


@pytest.mark.parametrize(("reductions", "most"), [(BOUNDS | DEAR, 0), (DEAR, PARTS), (BOUNDS, 99 * PARTS)])
def test_what_shared_costs_leave_more_of_than_is_to_be_gained_goes(
    reductions: frozenset[Reduction], most: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    for more in (0, 1):
        course = Course((2 * PARTS, {11: most + more}), None, None)
        found = course.reduce(monkeypatch, reductions)
        goes = more == 1 and Reduction.DEAR in reductions
        assert {*found.units}.issuperset(MOST) == (not goes)
        assert {*found.units} >= FEW | MORE
        assert (found.settled, found.bound) == (False, 2)
        # what is left is shared out again while that helps, and once more when cuts were found anew
        assert course.known == ([FIRST, (), FIRST] if goes else [FIRST])


def test_costs_are_shared_out_again_where_a_tenth_is_gone(monkeypatch: pytest.MonkeyPatch) -> None:
    drop = {11: 9 * PARTS}
    # 5 of 15 go, and then 1 of 10, which is not worth it, or 2
    course = Course((PARTS, drop), (PARTS, {12: 9 * PARTS}), None)
    found = course.reduce(monkeypatch, DEAR)
    assert (course.left, course.known) == ([15, 10, 9], [FIRST, (), FIRST])
    assert {*found.units} == FEW | MORE | BOTH
    course = Course((PARTS, drop), (PARTS, {13: 9 * PARTS}), None, None)
    found = course.reduce(monkeypatch, DEAR)
    assert (course.left, course.known) == ([15, 10, 8, 8], [FIRST, (), (), FIRST])
    assert {*found.units} == FEW | MORE | TWIN
    # what is of no use then, as another one stands in for it, goes at once
    course = Course((PARTS, drop), None, None)
    course.reduce(monkeypatch, DEAR | DOMINATED)
    assert course.left == [14, 8, 7]


def test_few_units_are_not_shared_among(monkeypatch: pytest.MonkeyPatch) -> None:
    for small, asked in ((14, [15]), (15, [])):
        course = Course((PARTS, {}))
        course.reduce(monkeypatch, DEAR, small=small)
        assert course.left == asked


def test_costs_are_shared_out_where_nothing_else_helps_and_once(monkeypatch: pytest.MonkeyPatch) -> None:
    # what another one stands in for goes first; where much is left there is a thorough round after
    for easy in (0, 99):
        course = Course((PARTS, {}))
        course.reduce(monkeypatch, DOMINATED | DEAR, easy=easy)
        assert course.left == [14]
    course = Course()
    assert course.reduce(monkeypatch, frozenset(Reduction), Objective.SUCCESS, "0").costs is None
    # without cuts none are known
    course = Course((PARTS, {}))
    found = course.reduce(monkeypatch, DOMINATED)
    assert (course.known, course.bounds, found.cuts) == ([()], [1], None)


def test_a_better_tree_on_the_way_counts_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    course = Course((2 * PARTS + 1, {}))
    found = course.reduce(monkeypatch, BOUNDS, hand=MOST)
    assert (found.tree, found.settled, course.trees) == (FEW, True, [MOST, FEW])


def test_nothing_is_shared_out_when_time_is_up(monkeypatch: pytest.MonkeyPatch) -> None:
    calls = 0
    for last in range(99):
        course = Course((PARTS, {11: 9 * PARTS}), *[(PARTS, {})] * 2)
        course.reduce(monkeypatch, DEAR, expired=after(last))
        calls += len(course.left)
        if not course.late:
            break
    assert calls > last > 9


# For each of nine goals in rows of three a unit of its own, and for each row one unit: three are enough.
ROWS: list[Action] = [*(([0], [n]) for n in range(1, 10)), *(([0], [n, n + 1, n + 2]) for n in (1, 4, 7))]
GOALS = [*range(1, 10)]


@pytest.mark.parametrize(
    ("tries", "among", "follows", "size"),
    [
        (0, 1.0, False, 9),
        (99, 1.0, False, 3),  # nine of these twelve in hand, and the three others
        (99, 0.99, False, 9),
        (0, 1.0, True, 3),
    ],
)
def test_a_relaxed_solution_leads_to_a_better_tree(
    tries: int, among: float, follows: bool, size: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """By what it takes, searched among with what is in hand; or by estimates that follow it."""
    monkeypatch.setattr(reduction, "_AMONG", among)
    monkeypatch.setattr(reduction, "varied", lambda _graph, _actions, tree, *_: tree)
    monkeypatch.setattr(reduction, "_SMALL", 0)
    monkeypatch.setattr(reduction, "_EFFORT", 0)
    monkeypatch.setattr(reduction, "_TRIES", 0)
    monkeypatch.setattr(reduction, "_THOROUGH", tries)
    monkeypatch.setattr(shared_costs, "_OFTEN", 1)
    monkeypatch.setattr(reduction, "improved", lambda _graph, _actions, tree, *_: tree)
    monkeypatch.setattr(reduction, "without_spare", lambda _graph, tree, _cost: set(tree))
    if not follows:
        monkeypatch.setattr(reduction, "following", lambda *_: ())
    found = reduce(plain_problem(ROWS, GOALS), levels((Objective.UNITS,)), BOUNDS)
    assert found.tree is not None
    assert len(found.tree) == size
    assert found.bound == 3


def test_dense_cuts_are_begun_with_where_they_are_few(monkeypatch: pytest.MonkeyPatch) -> None:
    # the one that is known has 4 of 15 units
    for twofold, few, part, known in (
        (2, 0, 0.0, True),
        (4 / 15, 0, 0.0, True),
        (0.2, 0, 0.0, False),
        (0.2, 3, 0.0, False),
        (0.2, 4, 0.0, True),
        (0.2, 0, 0.2, False),
        (0.2, 0, 0.27, True),
    ):
        monkeypatch.setattr(reduction, "_TWOFOLD", twofold)
        monkeypatch.setattr(reduction, "_SPARSE", (few, part))
        course = Course((PARTS, {}))
        course.reduce(monkeypatch, DEAR)
        assert course.known == [FIRST if known else []]


def test_many_units_are_shared_among_though_the_tree_has_changed(monkeypatch: pytest.MonkeyPatch) -> None:
    """Another turn of greedy cuts would take long; where a tenth is gone, it is worth it."""
    for many, turns in ((15, 2), (14, 1)):
        course = Course((PARTS, {}))
        monkeypatch.setattr(reduction, "_MANY", many)
        monkeypatch.setattr(reduction._Reducer, "_drop_dear", lambda *_: None)
        monkeypatch.setattr(reduction._Reducer, "_improve", lambda self, *_: self._take(self.tree ^ {14}))
        course.reduce(monkeypatch, DEAR)
        assert course.left[:1] == ([15] if turns == 1 else [])


def test_chance_leads_to_a_better_tree_where_a_solution_takes_much(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(reduction, "_SMALL", 0)
    monkeypatch.setattr(reduction, "_EFFORT", 0)
    monkeypatch.setattr(reduction, "improved", lambda _graph, _actions, tree, *_: tree)
    monkeypatch.setattr(reduction, "following", lambda *_: ())
    for tries, size in ((0, 9), (40, 3)):
        monkeypatch.setattr(reduction, "_TRIES", tries)
        monkeypatch.setattr(reduction, "_THOROUGH", tries)
        found = reduce(plain_problem(ROWS, GOALS), levels((Objective.UNITS,)), BOUNDS)
        assert found.tree is not None
        assert len(found.tree) == size
