"""Costs shared out among all cuts: bounds that hold whatever floats say, held against brute force."""

import math
import random
from collections.abc import Callable, Iterable
from fractions import Fraction

import pytest

from foon_asp.asp import Settings, solve
from foon_asp.certificate import certify
from foon_asp.hypergraph import (
    ALL,
    NONE,
    Reduced,
    Reduction,
    greedy_stages,
    reduce,
    relaxation_stages,
    tuning,
)
from foon_asp.hypergraph.cost_partition import CostPartition, CostPartitioning
from foon_asp.hypergraph.covering import BasicSolution, Covering, LpSolution, UnsolvedError
from foon_asp.hypergraph.hypergraph import Hypergraph
from foon_asp.hypergraph.landmark_cuts import Cuts
from foon_asp.hypergraph.landmark_relaxation import PARTS
from foon_asp.hypergraph.lexicographic import Lexicographic
from foon_asp.hypergraph.optimality_proof import Prover
from foon_asp.hypergraph.tuning import PresolveTuning
from foon_asp.problem import ContainerRule, Objective, levels
from tests.hypergraph.small_graphs import asked, cheapest, crossing
from tests.support.plain_graphs import Action, plain_problem
from tests.support.random_problems import random_problem


def never() -> bool:
    return False


def share_costs(
    graph: Hypergraph,
    targets: list[int],
    actions: Iterable[int],
    cost: Callable[[int], int],
    known_cuts: Iterable[Iterable[int]],
    enough: int,
    expired: Callable[[], bool],
) -> CostPartition | None:
    """Return the cost partition that a bound of ``enough``, convergence or time ends with."""
    return CostPartitioning(graph, targets, [*actions], cost, expired, known_cuts).advance(enough)


def require_holds(graph: Hypergraph, targets: list[int], costs: list[int], found: CostPartition) -> None:
    load = [0] * len(costs)
    for objects, weight in found.cuts:
        assert weight > 0
        assert objects & set(targets)
        assert objects.isdisjoint(graph.start)
        for action in crossing(graph, objects):
            load[action] += weight
        assert (
            min(found.reduced_costs[action] for action in crossing(graph, objects)) == 0
        )  # it can have no more
    assert found.bound == sum(weight for _, weight in found.cuts)
    assert found.reduced_costs == {a: cost * PARTS - load[a] for a, cost in enumerate(costs)}
    assert min(found.reduced_costs.values()) >= 0
    assert found.bound <= cheapest(graph, targets, costs) * PARTS
    assert found.lp_values.keys() == set(range(len(costs)))
    for objects in found.tight:
        assert sum(found.lp_values[action] for action in crossing(graph, objects)) < 1.01


@pytest.mark.parametrize("wrong", [False, True])
@pytest.mark.parametrize("seed", range(30))
def test_no_derivation_costs_less_than_the_bound(
    seed: int, wrong: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    graph, targets, costs = asked(seed)
    if wrong:  # nothing that HiGHS says of weights makes a bound too great
        drawn, told, amid = random.Random(seed), Covering.duals, Covering.interior_point

        def anything(weights: list[float]) -> list[float]:
            return [drawn.choice([w, drawn.uniform(-1, 3), math.inf, math.nan]) for w in weights]

        def inside(relaxation: Covering, expired: Callable[[], bool]) -> LpSolution | None:
            found = amid(relaxation, expired)
            return found and found._replace(duals=anything(found.duals))

        monkeypatch.setattr(Covering, "interior_point", inside)
        monkeypatch.setattr(Covering, "duals", lambda it: anything(told(it)))
    found = share_costs(graph, targets, range(len(costs)), costs.__getitem__, (), 10**15, never)
    assert (found is None) == (not targets)
    if found is not None:
        require_holds(graph, targets, costs, found)


@pytest.mark.parametrize("known", [False, True])
@pytest.mark.parametrize("seed", range(20))
def test_the_bound_is_that_of_the_relaxation(seed: int, known: bool) -> None:
    graph, targets, costs = asked(seed, (1, 2, 3))
    some = [{target} for target in targets] if known else []
    exact = Prover(graph, targets, [(Fraction(c),) for c in costs], Lexicographic([None])).relax([])
    found = share_costs(graph, targets, range(len(costs)), costs.__getitem__, some, 10**6, never)
    assert (found is None) == (not targets)
    if found is not None and exact is not None:
        require_holds(graph, targets, costs, found)
        assert 0 <= exact[1][0] - Fraction(found.bound, PARTS) < Fraction(1, 50)


def test_shares_are_halves_where_three_landmarks_overlap() -> None:
    # each pair of three actions is a landmark: greedy weights come to 1, the best to 3/2, every tree to 2
    graph = Hypergraph(4, [[], [], []], [[1, 2], [2, 3], [1, 3]], [0])
    found = share_costs(graph, [1, 2, 3], range(3), lambda _: 1, (), 2, never)
    assert found is not None
    assert (found.bound, found.reduced_costs) == (PARTS * 3 // 2, dict.fromkeys(range(3), 0))
    assert sorted(map(sorted, (objects for objects, _ in found.cuts))) == [[1], [2], [3]]
    assert found.lp_values == pytest.approx(dict.fromkeys(range(3), 0.5))
    assert {*found.tight} == {frozenset({o}) for o in (1, 2, 3)}
    late = share_costs(graph, [1, 2, 3], range(3), lambda _: 1, [{1}], 2, lambda: True)
    assert late is not None
    assert (late.bound, late.cuts) == (PARTS, [(frozenset({1}), PARTS)])
    assert share_costs(graph, [0], range(3), lambda _: 1, (), 2, never) is None
    few = share_costs(graph, [1, 2, 3], range(3), lambda _: 1, [{1}], 1, never)
    assert few is not None
    assert few.bound == PARTS  # which is enough


@pytest.mark.parametrize("seed", range(8))
def test_costs_that_no_float_can_hold(seed: int) -> None:
    graph, targets, costs = asked(seed)
    costs = [cost * 10**400 + cost for cost in costs]
    found = share_costs(graph, targets, range(len(costs)), costs.__getitem__, (), 10**430, never)
    assert (found is None) == (not targets)
    if found is not None:
        require_holds(graph, targets, costs, found)


def test_the_bound_rises_with_each_solution_and_time_may_be_up_at_any_step() -> None:
    graph, targets, costs = asked(8, (1, 2, 3))
    question = graph, targets, range(len(costs)), costs.__getitem__
    whole = share_costs(*question, (), 10**6, never)
    assert whole is not None
    often = []
    for solutions in (1, 2):
        partitioning, advances = CostPartitioning(*question, never, ()), 0
        while not partitioning.converged:
            shared, advances = partitioning.advance(10**6, solutions), advances + 1
            assert shared is not None
            require_holds(graph, targets, costs, shared)
            assert shared.bound <= whole.bound
        often.append(advances)
        assert shared == whole
    assert often[0] > often[1] > 1
    for steps in range(30):
        looks = iter(range(steps))
        late = share_costs(*question, (), 10**6, lambda looks=looks: next(looks, None) is None)  # type: ignore[misc]
        assert late is not None
        require_holds(graph, targets, costs, late)
        assert late.bound <= whole.bound


@pytest.mark.parametrize("most", [0, 1, 2])
def test_where_highs_finds_nothing_what_is_known_counts(most: int, monkeypatch: pytest.MonkeyPatch) -> None:
    graph, targets, costs = asked(8, (1, 2, 3))
    solved, solve = list[BasicSolution](), Covering.solve

    def lost(covering: Covering, expired: Callable[[], bool]) -> BasicSolution:
        if len(solved) == most:
            raise UnsolvedError
        solved.append(solve(covering, expired))
        return solved[-1]

    monkeypatch.setattr(Covering, "interior_point", lambda *_: None)
    monkeypatch.setattr(Covering, "solve", lost)
    found = share_costs(graph, targets, range(len(costs)), costs.__getitem__, (), 10**6, never)
    assert (found is None) == (most == 0)
    if found is not None:
        require_holds(graph, targets, costs, found)


@pytest.mark.parametrize("rule", ContainerRule)
@pytest.mark.parametrize("seed", range(8))
def test_answers_are_those_of_the_plain_program(
    seed: int, rule: ContainerRule, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Where all that the greedy cuts leave is left to the shared costs, of which is heard each time."""
    few_members = seed % 2 / 600  # hardly any, or none
    presolve_tuning = PresolveTuning(relaxed_actions=0, landmark_actions=few_members)
    monkeypatch.setattr(tuning, "PRESOLVE", presolve_tuning)
    monkeypatch.setattr(tuning, "RELAXATION", tuning.RELAXATION._replace(stalled_solutions=1))
    monkeypatch.setattr(greedy_stages, "improve_locally", lambda graph, few, tree, *_: tree)
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


# The goal comes of two things, of three or of four, each of a unit of its own.
THINGS = [10, 11], [20, 21, 22], [30, 31, 32, 33]
WAYS: list[Action] = [way for some in THINGS for way in (*(([0], [one]) for one in some), (some, [1]))]
FEW, MOST = frozenset(range(3)), frozenset(range(7, 12))
BOUNDS, DEAR = frozenset({Reduction.BOUNDS}), frozenset({Reduction.DEAR})


def reduced(
    patched: pytest.MonkeyPatch,
    bound: int,
    left: int,
    reductions: frozenset[Reduction],
    objective: Objective = Objective.UNITS,
) -> Reduced:
    """Reduce, where shared costs come to a bound and leave so much of the last unit, in parts."""
    every = dict.fromkeys(range(12), 0)
    told = CostPartition(bound, {**every, 11: left}, [], dict.fromkeys(every, 0.0))
    answers = iter([told])

    class Told:
        """Comes to one cost partition, and the next time to none."""

        converged = True

        def __init__(self, *_: object) -> None: ...

        def advance(self, *_: object) -> CostPartition | None:
            return next(answers, None)

    patched.setattr(relaxation_stages, "CostPartitioning", Told)
    patched.setattr(greedy_stages, "landmark_cuts", lambda *_: Cuts(1, every, []))
    patched.setattr(tuning, "PRESOLVE", PresolveTuning(relaxed_actions=0, branching_budget=0))
    found = reduce(plain_problem(WAYS, [1], rates=["1"] * 12), levels((objective,)), reductions)
    assert found.tree == FEW
    assert found.partition == (told if bound > PARTS else None)
    return found


@pytest.mark.parametrize(
    ("bound", "settled", "least"),
    [
        (PARTS, False, 1),
        (PARTS + 1, False, 2),
        (2 * PARTS, False, 2),
        (2 * PARTS + 1, True, 3),  # what trees cost is whole
        (5 * PARTS, True, 3),
    ],
)
def test_the_tree_is_proved_optimal_where_nothing_is_below_what_it_costs(
    bound: int, settled: bool, least: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    found = reduced(monkeypatch, bound, 0, BOUNDS)
    assert (found.settled, found.bound) == (settled, least)
    found = reduced(monkeypatch, min(bound, 3 * PARTS), 0, DEAR)  # what is as good is wanted, too
    assert (found.settled, found.bound, {*found.units} >= MOST) == (False, least, True)


def test_what_shared_costs_leave_more_of_than_is_to_be_gained_goes(monkeypatch: pytest.MonkeyPatch) -> None:
    doubt = (15 - 2) * 10**20  # of one rounded rate, which counts before 12 units
    for more in (0, 1):
        for reductions, most in ((BOUNDS | DEAR, 0), (DEAR, PARTS)):
            found = reduced(monkeypatch, 2 * PARTS, most + more, reductions)
            assert ({*found.units} >= MOST) == (not more)
        found = reduced(monkeypatch, 3 * PARTS, (doubt - 1) * PARTS + more, BOUNDS | DEAR, Objective.SUCCESS)
        assert (found.settled, {*found.units} >= MOST) == (False, not more)
