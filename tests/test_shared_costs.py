"""Costs shared out among all cuts: bounds that hold whatever floats say, held against brute force."""

import random
from collections.abc import Collection, Iterator, Sequence
from itertools import combinations

import pytest

from foon_asp.asp import Settings, solve
from foon_asp.bounds import shared_costs
from foon_asp.bounds.cut import Cut, Cutter
from foon_asp.bounds.hypergraph import Hypergraph
from foon_asp.bounds.relaxation import Covering, Relaxed
from foon_asp.bounds.shared_costs import PARTS, SharedCosts, _Sharing, share_costs
from foon_asp.certificate import certify
from foon_asp.problem import ContainerRule, Objective, levels
from foon_asp.reduce import ALL, NONE, Reduction, reduction
from tests.random_problems import random_problem


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
        for count in range(len(costs) + 1):
            for chosen in combinations(everything, count):
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
        drawn, told = random.Random(seed), Covering.weights
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
    known = [({1}, (0, 2))]
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
    """In place of HiGHS: says a value for each solution, the same shares in all, and weights."""

    def __init__(self, values: Sequence[float], shares: list[float], weights: Sequence[float] = ()) -> None:
        self._values, self._shares, self._weights = values, shares, weights
        self.solved = 0
        self.rows: list[tuple[int, ...]] = []

    def add(self, row: tuple[int, ...]) -> None:
        self.rows.append(row)

    def solve(self) -> Relaxed:
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
        share_costs(graph, goals, every, lambda _: 2, (), enough, lambda: len(asked) > 999)
    return len(asked)


def test_cuts_are_looked_for_until_they_bring_little(monkeypatch: pytest.MonkeyPatch) -> None:
    # by the dearest action, 101 would be enough: a hundredth of what lacks, and no more, has to come of eight
    for values, solved in (([0.0] * 30, 9), ([0.0] * 8 + [1.0] * 30, 17), ([0.0, 101.0, 101.0], 2)):
        relaxation = Told(values, [0.0] * 50)
        assert told(monkeypatch, 50, relaxation, 202) == 40 * (solved - 1)
        assert (relaxation.solved, len(relaxation.rows)) == (solved, 40 * (solved - 1))
    relaxation = Told([0.0] * 9, [0.998] * 3)
    assert told(monkeypatch, 3, relaxation, 202) == 8 * 4  # the fourth is known
    assert sorted(relaxation.rows) == sorted([(0,), (1,), (2,)] * 8)
    relaxation = Told([0.0], [0.999] * 3)
    assert (told(monkeypatch, 3, relaxation, 202), relaxation.rows) == (1, [])
    sharing = _Sharing(Hypergraph(2, [[]], [[1]], [0]), [1], [0], lambda _: 1)
    assert sharing._separate([0.0], lambda: True) is False
    assert (sharing._separate([0.0], lambda: False), sharing._rows) == (True, [(0,)])


def test_dear_actions_are_cut_first() -> None:
    sharing = _Sharing(Hypergraph(3, [[], [1]], [[1], [2]], [0]), [2], range(2), [1, 10].__getitem__)
    for _ in range(9):
        assert sharing._separate([0.0, 0.0], lambda: False)
    assert sharing._rows == [(1,), (0,)] * 9


def test_weights_are_those_wanted_and_what_is_left_goes_to_the_greatest(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    relaxation = Told([0.0], [0.5, 0.25, 0.0, 0.0, 1.0], [0.5, 0.75, -1.0, 0.0, 1 / 3, 2 / 3])
    monkeypatch.setattr(shared_costs, "Covering", lambda _: relaxation)
    graph = Hypergraph(2, [[]] * 5, [[1]] * 5, [0])
    rows: list[Collection[int]] = [(0, 1), (1, 2, 9), (2, 3), (2,), (4,), (4,)]
    known = [({place}, members) for place, members in enumerate(rows)]
    found = share_costs(graph, [1], range(5), lambda _: 12, known, 99, lambda: True)
    weights = {0: 3, 1: 9, 2: 3, 4: 4, 5: 8}
    left = {0: 9, 1: 0, 2: 0, 3: 9, 4: 0}
    assert found == SharedCosts(
        27 * PARTS,
        {a: rest * PARTS for a, rest in left.items()},
        [(frozenset({place}), weight * PARTS) for place, weight in weights.items()],
        {0: 0.5, 1: 0.25, 2: 0.0, 3: 0.0, 4: 1.0},
    )
    assert relaxation.rows == [(0, 1), (1, 2), (2, 3), (2,), (4,), (4,)]


@pytest.mark.parametrize("rule", ContainerRule)
@pytest.mark.parametrize("seed", range(25))
def test_answers_are_those_of_the_plain_program(
    seed: int, rule: ContainerRule, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(reduction, "_SMALL", 0)
    # all that the greedy cuts leave is left to the shared costs
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
