"""What is asked of clingo and what is made of its answers, on questions that are worked out by hand."""

import dataclasses
import shutil
import time
from collections import Counter
from collections.abc import Callable, Collection, Sequence
from fractions import Fraction
from pathlib import Path
from typing import Any, NamedTuple

import pytest

from foon_asp.asp import Outcome, Proof, Reporter, Settings, Status, solve
from foon_asp.asp.at_most import better_than
from foon_asp.asp.bare_program import bare_program
from foon_asp.asp.session import Session
from foon_asp.asp.solver import _cuts, _Solver
from foon_asp.bounds.landmark_cuts import Cuts, WeightedCut
from foon_asp.bounds.shared_costs import SharedCosts
from foon_asp.deadline import Deadline
from foon_asp.encoding.scales import Scales
from foon_asp.errors import BugError, UserError
from foon_asp.grounding.grounded import Grounded
from foon_asp.grounding.run import Run
from foon_asp.network import NetworkBuilder, ObjectNode, Source
from foon_asp.problem import Costs, Objective, Problem, levels
from foon_asp.reduce import NONE, ExactCosts, Reduced, Reduction, Wide, reduce
from foon_asp.reduce.graph import graph_of
from foon_asp.resources import encodings_folder
from foon_asp.rules.constraint import RuleText
from tests.test_bounded import at_most
from tests.test_objectives import NEW
from tests.ways_problem import GOAL, ways

UNITS, INPUTS, SUCCESS, KITCHEN = Objective.UNITS, Objective.INPUTS, Objective.SUCCESS, Objective.KITCHEN
SEARCHED = Settings(reductions=NONE)
Objectives = tuple[Objective, ...]
ByObjective = dict[Objective, int | Fraction]


class Answer(NamedTuple):
    """What a search says: bounds and trees, by number, on its way, and what it ends with."""

    run: Run
    bounds: Sequence[list[int]] = ()
    trees: Sequence[frozenset[int]] = ()


class Searches:
    """Hears how clingo is asked; an answer that is given here is said in its place, one a search."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, *answers: Answer | None) -> None:
        self.modes: list[str] = []
        waiting, search = list(answers), Grounded.search

        def instead(
            grounded: Grounded,
            deadline: Deadline,
            opt_mode: str,
            on_tree: Callable[[frozenset[int]], None] | None = None,
            on_bound: Callable[[list[int]], None] | None = None,
            *given: Any,
        ) -> Run:
            self.modes.append(opt_mode)
            answer = waiting.pop(0) if waiting else None
            if answer is None:
                return search(grounded, deadline, opt_mode, on_tree, on_bound, *given)
            for bound in answer.bounds:
                if on_bound:
                    on_bound(bound)
            for tree in (*answer.trees, answer.run.units):
                if on_tree and tree is not None:
                    on_tree(tree)
            return dataclasses.replace(answer.run)

        monkeypatch.setattr(Grounded, "search", instead)


class Heard(Reporter):
    """Writes down what it hears of."""

    def __init__(self) -> None:
        self.warnings: list[str] = []
        self.trees: list[Costs] = []
        self.bounds: list[tuple[Objective, int | Fraction]] = []

    def warning(self, message: str) -> None:
        self.warnings.append(message)

    def tree(self, costs: Costs) -> None:
        self.trees.append(costs)

    def bound(self, objective: Objective, bound: int | Fraction) -> None:
        self.bounds.append((objective, bound))


def leave(
    monkeypatch: pytest.MonkeyPatch,
    problem: Problem,
    objectives: Objectives,
    tree: Collection[int],
    bounded_like: Collection[int] | None = None,
    **parts: Any,
) -> None:
    """Have the reductions leave everything, with a tree in hand.

    A lower bound on all trees is what the units of ``bounded_like`` cost; without, nothing is known of costs.
    """
    costs, bound = None, 0
    if bounded_like is not None:
        costs = reduce(problem, levels(objectives)).costs
        assert costs is not None
        bound = sum(map(costs, bounded_like))
    left = Reduced(frozenset(tree), tuple(range(len(problem.network))), False, costs, bound, None)
    left = left._replace(**parts)
    monkeypatch.setattr("foon_asp.asp.prepared.reduce", lambda *_: left)


def numbers(problem: Problem, *units: int) -> frozenset[int]:
    return frozenset(map(problem.network.unit_number, units))


def optimum(
    problem: Problem, objectives: Objectives = (UNITS,), settings: Settings = SEARCHED
) -> tuple[int, ...]:
    outcome = solve(problem, objectives, settings)
    assert outcome.status is Status.OPTIMAL
    assert outcome.units is not None
    return outcome.units


def own_encodings(folder: Path, **changes: tuple[str, str]) -> Path:
    """Copy our encodings and change some texts of them."""
    own = folder / "own"
    shutil.copytree(encodings_folder(), own)
    for name, (old, new) in changes.items():
        text = (own / f"{name}.lp").read_text()
        assert old in text
        (own / f"{name}.lp").write_text(text.replace(old, new))
    return own


# --- Outcomes, part by part.


def test_an_outcome_by_cuts() -> None:
    problem = ways(["0.5"], ["0.5", "0.2"])
    began = time.perf_counter()
    outcome = solve(problem)
    elapsed = time.perf_counter() - began
    assert outcome._replace(seconds={}, cuts=()) == Outcome(
        problem,
        (UNITS,),
        Status.OPTIMAL,
        (0,),
        problem.costs((0,)),
        {UNITS: 1},
        {},
        proof=Proof.CUTS,
        left=0,
    )
    assert outcome.cuts == ((problem.goals[0],),)
    assert set(outcome.seconds) == {"cut", "check"}
    assert min(outcome.seconds.values()) > 0
    assert sum(outcome.seconds.values()) <= elapsed


def test_an_outcome_by_search() -> None:
    problem = ways(["0.5"], ["0.5", "0.2"], beside=True)
    began = time.perf_counter()
    outcome = solve(problem, (SUCCESS, KITCHEN), SEARCHED)
    elapsed = time.perf_counter() - began
    assert outcome._replace(seconds={}) == Outcome(
        problem,
        (SUCCESS, KITCHEN),
        Status.OPTIMAL,
        (0,),
        problem.costs((0,)),
        {SUCCESS: Fraction(1, 2), KITCHEN: 1, UNITS: 1},
        {},
        proof=Proof.SOLVER,
        left=3,
    )
    assert set(outcome.seconds) == {"cut", "facts", "ground", "solve", "check"}
    assert min(outcome.seconds.values()) > 0
    assert sum(outcome.seconds.values()) <= elapsed


RULED = Settings((Path("at_most_units"),), constants=("max_units=9",), reductions=NONE)


@pytest.mark.parametrize("settings", [SEARCHED, Settings(), RULED])
def test_an_outcome_without_a_tree(settings: Settings) -> None:
    problem = dataclasses.replace(ways(["0.5"]), kitchen=frozenset())
    outcome = solve(problem, (SUCCESS,), settings)
    assert outcome._replace(seconds={}) == Outcome(
        problem, (SUCCESS,), Status.INFEASIBLE, None, None, {}, {}, proof=Proof.SOLVER
    )
    assert set(outcome.seconds) == {"cut"}


def test_what_is_proved_was_not_stopped() -> None:
    deadline = Deadline()

    class Hasty(Reporter):
        def bound(self, objective: Objective, bound: int | Fraction) -> None:
            deadline.interrupt()

    outcome = solve(ways(["0.5"]), (UNITS,), Settings(deadline=deadline), Hasty())
    assert outcome.proof is Proof.CUTS
    assert outcome.stopped is None
    assert deadline.interrupted


def test_a_program_that_has_answered_is_closed(monkeypatch: pytest.MonkeyPatch) -> None:
    """Each one grounded is, whether it was followed by another or not, and at a fault, too."""
    made: Counter[str] = Counter()
    begin, close, search = Grounded.__init__, Grounded.close, Grounded.search

    def beginning(grounded: Grounded, *given: Any) -> None:
        made["begun"] += 1
        begin(grounded, *given)

    def closing(grounded: Grounded) -> None:
        made["closed"] += 1
        close(grounded)

    def stumbling(grounded: Grounded, *given: Any) -> Run:
        if made["begun"] == 2:
            raise UserError("no more")
        return search(grounded, *given)

    monkeypatch.setattr(Grounded, "__init__", beginning)
    monkeypatch.setattr(Grounded, "close", closing)
    problem = ways(["0.5"], ["0.5", "0.2"])
    assert optimum(problem, (SUCCESS,)) == (0,)
    assert made == {"begun": 3, "closed": 3}  # by weights, within the band, and what comes after
    made.clear()
    assert optimum(problem, (UNITS,), RULED) == (0,)
    assert made == {"begun": 1, "closed": 1}  # for the first tree and for the best one
    made.clear()
    own = Settings((RuleText(":- 10 <= #count { U : use(U) }."),))  # ready-made ones need no clingo for this
    assert optimum(problem, (UNITS,), own) == (0,)
    assert made == {"begun": 1, "closed": 1}  # does the best tree keep to the rule?
    made.clear()
    monkeypatch.setattr(Grounded, "search", stumbling)
    with pytest.raises(UserError, match="no more"):
        solve(problem, (SUCCESS,), SEARCHED)
    assert made == {"begun": 2, "closed": 2}


def test_options_of_clingo_are_looked_at_though_there_is_nothing_to_ask(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    problem = ways(["0.5"])
    assert solve(problem, (UNITS,), Settings(clingo_options=("--configuration=trendy",))).proof is Proof.CUTS
    with pytest.raises(UserError, match="no-such-option"):
        solve(problem, (UNITS,), Settings(clingo_options=("--no-such-option",)))
    monkeypatch.delattr("foon_asp.encoding.search.check")
    assert optimum(problem) == (0,)


# --- What clingo is asked.


def test_the_facts_of_a_question() -> None:
    """What cannot run is there where a goal cannot be made, and what no goal needs where rules may ask."""
    problem = ways(["0.5", "1"], beside=True)
    units = [
        'unit(0). motion(0,"go 0 0"). input(0,0). needs(0,0). output(0,1). gives(0,1). inputs(0,1). '
        "ingredients(0,0). rate(0,500000). risk(0,69314718).",
        'unit(1). motion(1,"go 0 1"). input(1,1). needs(1,1). output(1,2). gives(1,2). inputs(1,1). '
        "ingredients(1,0). rate(1,1000000). risk(1,0).",
        'unit(2). motion(2,"garnish"). input(2,0). needs(2,0). output(2,3). gives(2,3). inputs(2,1). '
        "ingredients(2,0). rate(2,1000000). risk(2,0).",
    ]
    objects = [
        'object(0). label(0,"start").',
        'object(1). label(1,"way 0"). state(1,"0").',
        'object(2). label(2,"goal").',
        'object(3). label(3,"garnish").',
    ]
    asked = ["goal(2).", "optimize(success,2).", "optimize(units,1)."]
    at_hand = [f"{objects[0]} kitchen(0).", *objects[1:]]
    assert bare_program(problem, (SUCCESS,), Settings(), {}).facts.splitlines() == [
        *units[:2],
        *at_hand[:3],
        *asked,
    ]
    nowhere = dataclasses.replace(problem, kitchen=frozenset())
    assert bare_program(nowhere, (SUCCESS,), Settings(), {}).facts.splitlines() == [
        *units[:2],
        *objects[:3],
        *asked,
    ]
    ruled = Settings(constraints=(Path("at_most_units"),), constants=("max_units=3",))
    places = [f'source({number},"{name}").' for number, name in enumerate(("way 0", "way 0", "ways"))]
    sourced = [f"{unit} {place}" for unit, place in zip(units, places, strict=True)]
    assert bare_program(problem, (SUCCESS,), ruled, {}).facts.splitlines() == [*sourced, *at_hand, *asked]


def test_facts_where_some_goals_can_be_made() -> None:
    """All units that lead to a goal are there, runnable or not, as soon as one goal cannot be made."""
    problem = ways(["0.5"], ["0.5", "0.5"])
    (start,) = problem.kitchen
    half = dataclasses.replace(problem, kitchen=frozenset({2}), goals=(*problem.goals, start))
    assert "unit(0)." in bare_program(half, (UNITS,), Settings(), {}).facts
    whole = dataclasses.replace(half, goals=problem.goals)
    assert "unit(0)." not in bare_program(whole, (UNITS,), Settings(), {}).facts


def test_without_reductions_the_best_tree_is_asked_for(monkeypatch: pytest.MonkeyPatch) -> None:
    searches = Searches(monkeypatch)
    problem = ways(["0.5", "0.5"], ["0.2"])
    for reductions in (NONE, frozenset({Reduction.DOMINATED}), frozenset({Reduction.FORCED})):
        assert optimum(problem, (UNITS,), Settings(reductions=reductions)) == (2,)
    assert searches.modes == ["opt"] * 3


def test_within_bounds_and_under_rules_some_tree_comes_first(monkeypatch: pytest.MonkeyPatch) -> None:
    searches = Searches(monkeypatch)
    problem = ways(["0.5", "0.5"], ["0.2"])
    bounded = Settings(bounded=at_most({UNITS: 1}))
    assert optimum(problem, (UNITS,), bounded) == (2,)
    assert searches.modes == ["ignore", "opt"]
    ruled = RULED._replace(constants=("max_units=1",))
    assert optimum(problem, (UNITS,), ruled) == (2,)
    assert searches.modes == ["ignore", "opt"] * 2


def test_trees_are_within_bounds_that_are_fractions(monkeypatch: pytest.MonkeyPatch) -> None:
    """Every unit costs a cent: what is better than two cents has one unit, than one cent there is nothing."""
    cents = NEW["to scale"]
    monkeypatch.setattr("foon_asp.problem.costs._MEASURED", (*Objective, cents))
    problem = ways(["0.9", "0.9"], ["0.8", "0.9"], ["0.2"])
    objectives = (SUCCESS, cents)
    assert optimum(problem, objectives, Settings()) == (0, 1)
    two, one = problem.costs((0, 1)), problem.costs((4,))
    assert (two.measure(cents), one.measure(cents)) == (Fraction(1, 50), Fraction(1, 100))
    assert optimum(problem, objectives, Settings(bounded=better_than([two], [cents]))) == (4,)
    none = solve(problem, objectives, Settings(bounded=better_than([two, one], [cents])))
    assert none.status is Status.INFEASIBLE


@pytest.mark.parametrize(
    ("objectives", "incumbent", "mode", "found"),
    [
        ((UNITS,), (0, 1), "opt,1", (2,)),
        ((UNITS,), (2,), "opt,0", (2,)),
        ((INPUTS, UNITS), (0, 1), "opt,2,1", (2,)),
        ((UNITS, SUCCESS), (0, 1), "opt,2", (2,)),
        ((SUCCESS,), (2,), "opt", (0, 1)),
        ((KITCHEN, SUCCESS), (2,), "opt,1", (0, 1)),
    ],
)
def test_with_a_tree_in_hand_better_ones_are_asked_for(
    objectives: Objectives,
    incumbent: tuple[int, ...],
    mode: str,
    found: tuple[int, ...],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    problem = ways(["0.5", "0.5"], ["0.2"])
    leave(monkeypatch, problem, objectives, incumbent)
    searches = Searches(monkeypatch)
    assert optimum(problem, objectives, Settings()) == found
    assert searches.modes[0] == mode


def test_nothing_is_below_0(monkeypatch: pytest.MonkeyPatch) -> None:
    """A unit that needs nothing takes nothing from the kitchen: what is better has fewer units."""
    builder = NetworkBuilder()
    builder.add("find", [], [ObjectNode.of("part")], Source("nothing", 1))
    builder.add("build", [ObjectNode.of("part")], [GOAL], Source("nothing", 2))
    builder.add("buy", [], [GOAL], Source("nothing", 3))
    network = builder.build()
    goal = network.object_id(GOAL)
    assert goal is not None
    problem = Problem(network, frozenset(), (goal,), None, frozenset())
    for options in ((), ("--opt-strategy=bb",)):
        for objectives, mode in (((UNITS, KITCHEN), "opt,1"), ((KITCHEN, UNITS), "opt,0,1")):
            with monkeypatch.context() as patch:
                leave(patch, problem, objectives, (0, 1))
                searches = Searches(patch)
                assert optimum(problem, objectives, Settings(clingo_options=options)) == (2,)
                assert searches.modes == [mode]


def test_nothing_is_better_than_no_unit(monkeypatch: pytest.MonkeyPatch) -> None:
    problem = dataclasses.replace(ways(["0.5"]), kitchen=frozenset({0, 1}))
    assert set(problem.goals) <= problem.kitchen
    leave(monkeypatch, problem, (UNITS,), ())
    searches = Searches(monkeypatch)
    assert optimum(problem, (UNITS,), Settings()) == ()
    assert searches.modes == ["opt"]
    assert optimum(problem, (SUCCESS,)) == ()


# --- Limits and ctrl-C.


def struck(monkeypatch: pytest.MonkeyPatch, what: str) -> None:
    """Have ctrl-C pressed the moment before something begins to be watched."""
    watched = Deadline.watched

    def instead(deadline: Deadline, doing: str, **how: bool) -> Any:
        deadline.doing = doing
        if doing == what:
            raise KeyboardInterrupt
        return watched(deadline, doing, **how)

    monkeypatch.setattr(Deadline, "watched", instead)


@pytest.mark.parametrize("ruled", [False, True])
@pytest.mark.parametrize(
    ("doing", "status"), [("cutting the network", Status.UNKNOWN), ("writing facts", Status.FEASIBLE)]
)
def test_ctrl_c_is_noted_wherever_it_comes(
    doing: str, status: Status, ruled: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    struck(monkeypatch, doing)
    settings = SEARCHED._replace(deadline=Deadline())
    if ruled:
        settings = settings._replace(constraints=(Path("at_most_units"),), constants=("max_units=3",))
        status = Status.UNKNOWN  # nobody knows a tree that keeps to the rule
    problem = ways(["0.5"], ["0.5", "0.5"])
    outcome = solve(problem, (SUCCESS,), settings)
    assert outcome.status is status
    assert outcome.proof is None
    assert outcome.stopped == f"ctrl-C while {doing}"
    assert (outcome.units is None) == (status is Status.UNKNOWN)
    if status is Status.FEASIBLE:
        assert outcome.bounds == {SUCCESS: 1}
        assert outcome.left == 3
    else:
        assert outcome.bounds == {}


@pytest.mark.parametrize(("objectives", "bounds"), [((UNITS,), {UNITS: 0}), ((SUCCESS,), {SUCCESS: 1})])
def test_without_time_there_is_a_tree_and_nothing_is_proved(
    objectives: Objectives, bounds: ByObjective, monkeypatch: pytest.MonkeyPatch
) -> None:
    heard = Heard()
    problem = ways(["0.5"], ["0.5", "0.5"])
    monkeypatch.setattr(_Solver, "_search", None)
    outcome = solve(problem, objectives, SEARCHED._replace(deadline=Deadline(0)), heard)
    assert outcome.status is Status.FEASIBLE
    assert outcome.bounds == bounds
    assert outcome.stopped == "the time limit of 0 s while cutting the network"
    assert outcome.costs == heard.trees[-1]


def test_cuts_that_share_costs_are_those_of_the_answer(monkeypatch: pytest.MonkeyPatch) -> None:
    problem = ways(["0.5"], ["0.5", "0.5"])
    [goal] = problem.goals
    leave(monkeypatch, problem, (UNITS,), {0}, shared=SharedCosts(0, {}, [(frozenset({goal}), 1)], {}))
    assert solve(problem).cuts == ((goal,),)
    leave(monkeypatch, problem, (UNITS,), {0})
    assert solve(problem).cuts == ()


def test_reductions_that_were_interrupted_have_proved_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    """What they leave says nothing then."""
    problem = ways(["0.5", "0.5"], ["0.2"])
    leave(monkeypatch, problem, (UNITS,), (0, 1), units=(0, 1), interrupted=True)
    deadline = Deadline()
    outcome = solve(problem, (UNITS,), Settings(deadline=deadline))
    assert outcome.status is Status.FEASIBLE
    assert outcome.units == (0, 1)
    assert deadline.interrupted


BOUNDS: list[tuple[Objectives, list[int], list[int] | None, ByObjective]] = [
    ((UNITS,), [], [0], {UNITS: 1}),
    ((UNITS,), [-5], [0], {UNITS: 1}),
    ((UNITS,), [2], [0], {UNITS: 2}),
    ((UNITS,), [2], [0, 1], {UNITS: 2}),
    ((UNITS,), [3], [0], {UNITS: 3}),
    ((UNITS,), [7], [0], {UNITS: 3}),  # nothing is better than the tree in hand
    ((UNITS, KITCHEN), [2, 9], [0], {UNITS: 2}),  # the second says something of trees of 2 units only
    ((UNITS, KITCHEN), [3], [0], {UNITS: 3}),
    ((UNITS, KITCHEN), [3, 0], [0], {UNITS: 3, KITCHEN: 0}),
    ((UNITS, KITCHEN), [3, -1], [0], {UNITS: 3, KITCHEN: 0}),
    ((UNITS, KITCHEN), [7, 9], [0], {UNITS: 3, KITCHEN: 1}),
    ((UNITS, INPUTS, KITCHEN), [3, 2, 1], [0], {UNITS: 3, INPUTS: 2, KITCHEN: 1}),
    ((UNITS, SUCCESS), [3], [0], {UNITS: 3}),
    ((UNITS, SUCCESS), [3, 0], [0], {UNITS: 3, SUCCESS: 1}),
    ((UNITS, SUCCESS), [3, -1], [0], {UNITS: 3, SUCCESS: 1}),
    ((UNITS, SUCCESS), [3, 10**8], [0], {UNITS: 3, SUCCESS: Fraction("0.367879441171442323")}),  # e^-1
    # the tree with the least sum of rounded weights may not be the one that succeeds most often
    ((UNITS, SUCCESS, KITCHEN), [3, 0, 1], [0], {UNITS: 3, SUCCESS: 1}),
    ((SUCCESS,), [10**8, 2], [], {SUCCESS: Fraction("0.367879441171442323")}),
    ((SUCCESS,), [], [], {SUCCESS: 1}),
    ((SUCCESS, UNITS), [10**8, 3], [], {SUCCESS: Fraction("0.367879441171442323")}),
    # without cuts what the search says stands
    ((UNITS,), [], None, {UNITS: 0}),
    ((UNITS,), [-5], None, {UNITS: 0}),
    ((UNITS,), [2], None, {UNITS: 2}),
    ((UNITS, KITCHEN), [2, 9], None, {UNITS: 2, KITCHEN: 9}),
    ((UNITS, SUCCESS), [3, 10**8, 1], None, {UNITS: 3, SUCCESS: Fraction("0.367879441171442323")}),
    ((SUCCESS,), [], None, {SUCCESS: 1}),
    ((SUCCESS, UNITS), [10**8, 3], None, {SUCCESS: Fraction("0.367879441171442323")}),
]


@pytest.mark.parametrize(("objectives", "lower", "like", "bounds"), BOUNDS)
def test_bounds_at_a_limit(
    objectives: Objectives,
    lower: list[int],
    like: list[int] | None,
    bounds: ByObjective,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Three ways, of 1, 2 and 3 units; the longest is in hand, and cuts prove what some units cost."""
    problem = ways(["0.2"], ["0.5", "0.5"], ["0.6", "0.6", "0.6"])
    hand = (3, 4, 5)
    leave(monkeypatch, problem, objectives, hand, like)
    heard = Heard()
    Searches(monkeypatch, Answer(Run(lower=lower), [lower]))
    outcome = solve(problem, objectives, Settings(), heard)
    assert outcome.status is Status.FEASIBLE
    assert outcome.units == hand
    assert outcome.bounds == bounds
    assert list(outcome.bounds) == list(bounds)
    assert heard.bounds == list(bounds.items())
    assert heard.trees == [problem.costs(hand)]
    assert outcome.stopped is None


def test_cuts_bound_success(monkeypatch: pytest.MonkeyPatch) -> None:
    """The better of two bounds counts: that of the cuts, to 17 digits, or that of the search."""
    problem = ways(["0.2"], ["0.6", "0.6", "0.6"])
    leave(monkeypatch, problem, (SUCCESS,), (0,), (1, 2, 3))
    heard = Heard()
    weak, strong = [1], [160_943_790]
    Searches(monkeypatch, Answer(Run(lower=strong), [weak, strong]))
    outcome = solve(problem, (SUCCESS,), Settings(), heard)
    (_, by_cuts), (_, by_search) = heard.bounds
    assert Fraction("0.216") <= by_cuts < Fraction("0.21600000001")
    assert Fraction("0.2") <= by_search < Fraction("0.20000001")
    assert outcome.bounds == {SUCCESS: by_search}


def test_at_a_limit_the_better_tree_is_given(monkeypatch: pytest.MonkeyPatch) -> None:
    """The one in hand, or what clingo came to."""
    problem = ways(["0.2"], ["0.5", "0.5"], ["0.6", "0.6", "0.6"])
    short, middle, long = (0,), (1, 2), (3, 4, 5)
    for hand, found, best in ((short, middle, short), (long, middle, middle), (middle, middle, middle)):
        with monkeypatch.context() as patch:
            leave(patch, problem, (UNITS,), hand, [0])
            Searches(patch, Answer(Run(numbers(problem, *found), (len(found),), lower=[1])))
            outcome = solve(problem, (UNITS,), Settings())
            assert (outcome.status, outcome.units) == (Status.FEASIBLE, best)
            assert outcome.bounds == {UNITS: 1}


def test_a_limit_while_products_are_compared(monkeypatch: pytest.MonkeyPatch) -> None:
    """Weights alone choose three units, of which nothing follows for the best product: that has one."""
    problem = ways(["0.7"] * 3, ["0.3430000001"])
    assert optimum(problem, (SUCCESS,)) == (3,)
    leave(monkeypatch, problem, (SUCCESS,), (0, 1, 2))
    first = Run(numbers(problem, 0, 1, 2), (107_002_482, 3), True, [107_002_482, 3])
    Searches(monkeypatch, Answer(first), Answer(Run()))
    outcome = solve(problem, (SUCCESS,), Settings())
    assert (outcome.status, outcome.units) == (Status.FEASIBLE, (0, 1, 2))
    assert list(outcome.bounds) == [SUCCESS]
    assert Fraction("0.3430000001") <= outcome.bounds[SUCCESS] < Fraction("0.34300002")
    # and what comes after success may have been stopped, too
    for last in (Run(), Run(numbers(problem, 3), (0, 1))):
        Searches(monkeypatch, None, None, None, Answer(last))
        outcome = solve(problem, (SUCCESS,), Settings())
        assert (outcome.status, outcome.units) == (Status.FEASIBLE, (3,))


# --- What is heard on the way.


def test_trees_and_bounds_are_heard_as_they_get_better(monkeypatch: pytest.MonkeyPatch) -> None:
    heard = Heard()
    problem = ways(["0.5"] * 3, ["0.5"] * 2, ["0.2"])
    outcome = solve(problem, (UNITS,), SEARCHED, heard)
    assert heard.trees[-1] == outcome.costs == problem.costs((5,))
    assert heard.warnings == []
    assert [costs.units for costs in heard.trees] == sorted(
        {costs.units for costs in heard.trees}, reverse=True
    )
    assert heard.bounds == sorted(heard.bounds)
    assert all(0 <= bound <= 1 for _, bound in heard.bounds)

    # of two trees that are as good, the first is heard of; and of what the reductions find
    heard = Heard()
    found = reduce(problem, (UNITS,))
    assert found.costs is not None

    def tells(
        _problem: Problem, _levels: Objectives, _reductions: object, _expired: object, listener: Any, *_: Any
    ) -> Reduced:
        for tree in ((0, 1, 2), (3, 4), (0, 1, 2), (5,)):
            listener.tree(frozenset(tree))
        listener.bound(found.costs, found.bound)
        return found

    monkeypatch.setattr("foon_asp.asp.prepared.reduce", tells)
    assert solve(problem, (UNITS,), Settings(), heard).proof is Proof.CUTS
    assert heard.trees == [problem.costs(tree) for tree in ((0, 1, 2), (3, 4), (5,))]
    assert heard.bounds == [(UNITS, 1)]


def test_trees_are_heard_of_from_every_search(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of the first one, of what weighs less, of a better product and of fewer units."""
    problem = ways(["0.2"], ["0.7"] * 3, ["0.3430000001", "1"], ["0.3430000001"])
    heard = Heard()
    leave(monkeypatch, problem, (SUCCESS,), (0,))
    Searches(
        monkeypatch,
        Answer(Run(numbers(problem, 1, 2, 3), (107_002_482, 3), True), [[0]]),
        Answer(Run(numbers(problem, 4, 5), (107_002_483,), True), [[1]]),
        Answer(Run(exhausted=True), [[2]]),
        Answer(Run(numbers(problem, 6), (1,), True), [[3]]),
    )
    assert solve(problem, (SUCCESS,), Settings(), heard).units == (6,)
    assert heard.trees == [problem.costs(tree) for tree in ((0,), (1, 2, 3), (4, 5), (6,))]
    assert heard.bounds == [(SUCCESS, 1)]  # later searches are not about all trees
    heard = Heard()
    ruled = Settings(constraints=(Path("at_most_units"),), constants=("max_units=2",))
    assert solve(problem, (UNITS,), ruled, heard).units is not None
    assert heard.trees[-1].units == 1


def test_a_better_tree_that_was_heard_of_is_not_lost(monkeypatch: pytest.MonkeyPatch) -> None:
    """What weighs least, at which a search ends, need not be the best of what it came by."""
    problem = ways(["0.2"], ["0.7"] * 3, ["0.3430000001", "1"], ["0.3430000001"])
    leave(monkeypatch, problem, (SUCCESS,), (0,))
    long, two, one = numbers(problem, 1, 2, 3), numbers(problem, 4, 5), numbers(problem, 6)
    least = Run(long, (107_002_482, 3), True)
    none = Run(exhausted=True)
    for answers, best in (
        ([Answer(Run(long, (107_002_482, 3)), trees=[two])], (4, 5)),
        ([Answer(least), Answer(Run(two, (107_002_483,)))], (4, 5)),
        ([Answer(least), Answer(Run(), trees=[two])], (4, 5)),
        ([Answer(least, trees=[two]), Answer(none), Answer(Run())], (4, 5)),
        ([Answer(least, trees=[two]), Answer(none), Answer(Run(one, (1,)))], (6,)),
    ):
        Searches(monkeypatch, *answers)
        outcome = solve(problem, (SUCCESS,), Settings())
        assert (outcome.status, outcome.units) == (Status.FEASIBLE, best)


def test_searches_that_contradict_each_other_are_a_bug(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of two units is the best tree of the last search, of one unit that of the first."""
    problem = ways(["0.5"], ["0.5", "1"])
    first, last = Run(numbers(problem, 0), (69_314_718, 1), True), Run(numbers(problem, 1, 2), (2,), True)
    Searches(monkeypatch, Answer(first), Answer(Run(exhausted=True)), Answer(last))
    with pytest.raises(BugError, match="but one was found for"):
        solve(problem, (SUCCESS,), SEARCHED)


def test_costs_of_a_tree_in_hand_are_worked_out_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """And once more when the answer is held against its tree."""
    asked: Counter[frozenset[int]] = Counter()
    costs = Problem.costs

    def counted(problem: Problem, units: Any) -> Costs:
        asked[frozenset(units)] += 1
        return costs(problem, units)

    monkeypatch.setattr(Problem, "costs", counted)
    assert optimum(ways(["0.5"]), (UNITS,)) == (0,)
    assert asked == {frozenset({0}): 2}


@pytest.mark.parametrize("settings", [SEARCHED, RULED, RULED._replace(session=Session())])
def test_how_units_are_weighed_is_worked_out_once(
    settings: Settings, monkeypatch: pytest.MonkeyPatch
) -> None:
    """For the question, and for the program that is kept of it; and what it weighs is one figure."""
    made: list[Scales] = []
    scale = Scales.__init__

    def counted(scales: Scales, *given: Any) -> None:
        made.append(scales)
        scale(scales, *given)

    monkeypatch.setattr(Scales, "__init__", counted)
    assert optimum(ways(["0.7"] * 3, ["0.3430000001"]), (SUCCESS,), settings) == (3,)
    assert len(made) == 1


# --- Success, settled exactly.


@pytest.mark.parametrize(
    ("chains", "objectives", "first", "modes", "best"),
    [
        # 0.5 weighs 69314718: within that and what one unit may have lost, less 1, nothing else is
        ((["0.5"], ["0.2"]), (SUCCESS,), (69_314_718, 1), ["opt", "opt,69314718", "opt,1"], (0,)),
        # three times 0.7 weighs 107002482 and may have lost 2 more; 0.3430000001 is better, and one unit
        (
            (["0.7"] * 3, ["0.3430000001"]),
            (SUCCESS,),
            (107_002_482, 3),
            ["opt", "opt,107002484", "opt,107002483", "opt,1"],
            (3,),
        ),
        # and a little less is worse: it is looked at, and not looked at again
        (
            (["0.7"] * 3, ["0.3429999999"]),
            (SUCCESS,),
            (107_002_482, 3),
            ["opt", "opt,107002484", "opt,107002484", "opt,3"],
            (0, 1, 2),
        ),
        # of equal products fewest units count
        (
            (["0.7"] * 3, ["0.343"]),
            (SUCCESS,),
            (107_002_482, 3),
            ["opt", "opt,107002484", "opt,3"],
            (3,),
        ),
        (
            (["0.7"] * 3, ["0.343"]),
            (KITCHEN, SUCCESS),
            (1, 107_002_482, 3),
            ["opt,1", "opt,1,107002484", "opt,1,3"],
            (3,),
        ),
        (
            (["0.7"] * 3, ["0.343"]),
            (SUCCESS, KITCHEN),
            (107_002_482, 1, 3),
            ["opt", "opt,107002484", "opt,1,3"],
            (3,),
        ),
        # units of rate 1 lose nothing
        (
            (["0.5", "1"], ["0.2"]),
            (SUCCESS,),
            (69_314_718, 2),
            ["opt", "opt,69314718", "opt,2"],
            (0, 1),
        ),
        # where units come first, nothing comes after
        ((["0.5"], ["0.3"]), (UNITS, SUCCESS), (1, 69_314_718), ["opt,1", "opt,1,69314718"], (0,)),
        # nothing is better than certain, but something that is not may weigh as little
        ((["1", "1"], ["0.5"]), (SUCCESS,), (0, 2), ["opt", "opt,2"], (0, 1)),
        ((["0.9999999999"], ["1", "1"], ["0.5"]), (SUCCESS,), (0, 1), ["opt", "opt,0", "opt,2"], (1, 2)),
    ],
)
def test_products_within_the_band_are_compared(
    chains: tuple[list[str], ...],
    objectives: Objectives,
    first: tuple[int, ...],
    modes: list[str],
    best: tuple[int, ...],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The first way is found first; each search has a bound of its own."""
    problem = ways(*chains)
    way = range(len(chains[0]))
    leave(monkeypatch, problem, objectives, way)
    searches = Searches(monkeypatch, Answer(Run(numbers(problem, *way), first, True)))
    assert optimum(problem, objectives, Settings()) == best
    assert searches.modes == modes


def test_where_all_rates_are_1_nothing_is_rounded(monkeypatch: pytest.MonkeyPatch) -> None:
    problem = ways(["1", "1"], ["1"])
    leave(monkeypatch, problem, (SUCCESS,), (0, 1))
    searches = Searches(monkeypatch)
    assert optimum(problem, (SUCCESS,), Settings()) == (2,)
    assert searches.modes == ["opt,0,1"]


def test_every_product_within_the_band_is_compared(monkeypatch: pytest.MonkeyPatch) -> None:
    """On a coarse scale five ways weigh the same, and each is looked at once."""
    monkeypatch.setattr("foon_asp.encoding.exact_success._scale", lambda _: 10)
    problem = ways(["0.501"], ["0.505"], ["0.503"], ["0.504"], ["0.502"])
    leave(monkeypatch, problem, (SUCCESS,), (0,))
    searches = Searches(monkeypatch, Answer(Run(numbers(problem, 0), (6, 1), True)))
    assert optimum(problem, (SUCCESS,), Settings()) == (1,)
    assert searches.modes == ["opt", *["opt,6"] * 5, "opt,1"]


def test_totals_that_are_equal_have_equal_rights(monkeypatch: pytest.MonkeyPatch) -> None:
    """All ways cost 6, and weigh the less the more they lose by rounding; three units of 2 lose nothing."""
    objective = NEW["rounded"]
    monkeypatch.setattr("foon_asp.problem.costs._MEASURED", (*Objective, objective))
    thirds = [Fraction(number, 3) for number in range(11)]
    chains = [[Fraction(2)] * 3, thirds[4:6] * 2, [thirds[8], thirds[10]], [7 + Fraction(1, 10**9 + 7)]]
    problem = ways(*([str(1 / cost) for cost in chain] for chain in chains))
    leave(monkeypatch, problem, (objective,), (0, 1, 2))
    weights = 599_999_998, 600_000_000  # of the second way, and of the first
    searches = Searches(monkeypatch, Answer(Run(numbers(problem, 3, 4, 5, 6), (weights[0], 4), True)))
    assert optimum(problem, (objective,), Settings()) == (7, 8)
    band = f"opt,{weights[1]}"
    assert searches.modes[:4] == ["opt", band, band, band]
    assert searches.modes[4] == "opt,3"
    assert searches.modes[-1] in {"opt,2", "opt,3"}
    assert len(searches.modes) == 7
    # at a limit in the last of these, what is in hand is the answer
    Searches(monkeypatch, *[None] * 6, Answer(Run()))
    outcome = solve(problem, (objective,), Settings())
    assert (outcome.status, outcome.units) == (Status.FEASIBLE, (7, 8))


def test_a_product_that_is_lost_is_a_bug(monkeypatch: pytest.MonkeyPatch) -> None:
    Searches(monkeypatch, None, None, Answer(Run(exhausted=True)))
    with pytest.raises(BugError, match="the best success was lost"):
        solve(ways(["0.5"], ["0.2"]), (SUCCESS,), SEARCHED)


# --- What clingo says is not believed.


@pytest.mark.parametrize(
    ("units", "costs", "message"),
    [
        ((0,), (2, 1), r"clingo reports the costs \[2, 1\], the units \[0\] cost \[1, 1\]"),
        ((0,), (1, 2), r"clingo reports the costs \[1, 2\], the units \[0\] cost \[1, 1\]"),
        ((0,), (1, 1 + 2**31), "clingo reports the costs"),
        ((0,), (1, 65), "clingo reports the costs"),
        ((0,), (1,), r"clingo reports the costs \[1\]"),
        ((0,), (1, 1, 0), r"clingo reports the costs \[1, 1, 0\]"),
        ((1, 2), (2, 2), None),
        ((1, 2), (2 - 2**32, 2 + 2**32), None),
    ],
)
@pytest.mark.parametrize("exhausted", [True, False])
def test_costs_of_an_answer_are_held_against_our_own(
    units: tuple[int, ...],
    costs: tuple[int, ...],
    message: str | None,
    exhausted: bool,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """They are compared as clingo counts, modulo 2^32, also where a limit came."""
    problem = ways(["0.5"], ["0.5", "0.5"])
    leave(monkeypatch, problem, (INPUTS, UNITS), (1, 2))
    Searches(monkeypatch, Answer(Run(numbers(problem, *units), costs, exhausted)))
    if message is None:
        assert solve(problem, (INPUTS, UNITS), Settings()).units == units
        return
    with pytest.raises(BugError, match=message):
        solve(problem, (INPUTS, UNITS), Settings())


def test_sums_beyond_32_bits_are_right() -> None:
    """Three units of 10^-9 weigh 6,216,979,749 together, which clingo reports modulo 2^32."""
    tiny = "0.000000001"
    assert optimum(ways([tiny] * 3), (SUCCESS,)) == (0, 1, 2)
    assert optimum(ways([tiny] * 3, [tiny, tiny, "0.1"]), (SUCCESS,)) == (3, 4, 5)


def test_no_tree_where_there_is_one_is_a_bug(monkeypatch: pytest.MonkeyPatch) -> None:
    """There is one in hand: only where better ones are asked for may there be none."""
    problem = ways(["0.5"])
    at_hand = dataclasses.replace(problem, kitchen=problem.kitchen.union(problem.goals))
    for asked, tree, objectives, ours in (
        (problem, (0,), (UNITS,), False),
        (problem, (0,), (SUCCESS,), False),
        (problem, (0,), (SUCCESS,), True),
        (problem, (0,), (UNITS, SUCCESS), True),
        (at_hand, (), (UNITS,), True),
    ):
        Searches(monkeypatch, Answer(Run(exhausted=True)))
        with monkeypatch.context() as patch:
            if ours:
                leave(patch, asked, objectives, tree)
            with pytest.raises(BugError, match="a tree is at hand, but the encodings say that there is none"):
                solve(asked, objectives, Settings() if ours else SEARCHED)
    Searches(monkeypatch, Answer(Run(exhausted=True)))
    leave(monkeypatch, problem, (UNITS,), (0,))
    assert optimum(problem, (UNITS,), Settings()) == (0,)


def test_units_that_the_network_has_not_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    problem = ways(["0.5"])
    Searches(monkeypatch, Answer(Run(numbers(problem, 0) | {77}, (2,), True)))
    with pytest.raises(UserError) as refused:
        solve(problem, (UNITS,), SEARCHED)
    assert str(refused.value) == "the encodings made use(77), but the network has no unit of that number"


def test_answers_are_about_the_numbers_of_the_whole_network(tmp_path: Path) -> None:
    """Of a network a part is read, whose units keep their numbers in facts and answers."""
    whole = ways(["0.2", "0.2"], ["0.5"] * 3, ["0.7"] * 3, ["0.3430000001"])
    part = dataclasses.replace(whole, network=whole.network.without((0, 1, 3)))
    heard = Heard()
    for settings in (SEARCHED, Settings(), RULED, RULED._replace(session=Session())):
        outcome = solve(part, (SUCCESS,), settings, heard)
        assert outcome.units == (5,)
        assert heard.trees[-1] == part.costs((5,))
    assert 'unit(8). motion(8,"go 3 0")' in bare_program(part, (UNITS,), Settings(), {}).facts
    rule = tmp_path / "rule.lp"
    rule.write_text(":- use(8).\n")
    assert optimum(part, (UNITS,), Settings(constraints=(rule,))) == (2, 3, 4)


# --- Rules and encodings of the user's.


@pytest.mark.parametrize(
    ("exhausted", "status", "proof"), [(True, Status.INFEASIBLE, Proof.SOLVER), (False, Status.UNKNOWN, None)]
)
def test_no_tree_under_a_rule(
    exhausted: bool, status: Status, proof: Proof | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    Searches(monkeypatch, Answer(Run(exhausted=exhausted)))
    settings = RULED._replace(constants=("max_units=0",))
    outcome = solve(ways(["0.5"]), (UNITS,), settings)
    assert (outcome.status, outcome.proof, outcome.units) == (status, proof, None)
    assert outcome.bounds == {}


def test_under_a_rule_all_that_can_be_made_is_left(tmp_path: Path) -> None:
    rule = tmp_path / "rule.lp"
    rule.write_text(':- not use(U) : motion(U,"garnish").  :- use(U), source(U,"way 1").\n')
    problem = ways(["0.5"], ["0.2"], beside=True)
    outcome = solve(problem, (SUCCESS,), Settings(constraints=(rule,), reductions=NONE))
    assert (outcome.status, outcome.proof) == (Status.OPTIMAL, Proof.SOLVER)
    assert outcome.units == (0, 2)
    assert outcome.left == 3
    assert outcome.cuts == ()
    reduced = solve(problem, (SUCCESS,), Settings(constraints=(rule,)))
    assert (reduced.status, reduced.proof) == (Status.OPTIMAL, Proof.CUTS)
    assert reduced.units == (0, 2)
    # the set of units that the rule asks for is a goal of no node, so no cut of it is told
    assert reduced.cuts == ((problem.goals[0],),)


def test_cuts_from_before_anything_was_left_out_come_after_the_best() -> None:
    def cuts(*objects: int) -> Cuts:
        return Cuts(1, {}, [WeightedCut(frozenset({o}), (0,), 0, 1) for o in objects])

    problem = ways(["0.5"])
    costs = ExactCosts(problem, (UNITS,), [0])
    wide = Wide(problem, graph_of(problem, (UNITS,)), [0], costs, cuts(1, 2), spare=False)
    reduced = Reduced(frozenset(), (), False, costs, 0, cuts(2, 3), wide=wide)
    assert _cuts(reduced) == [{2}, {3}, {1}]
    assert _cuts(reduced._replace(wide=None)) == [{2}, {3}]
    assert _cuts(reduced._replace(cuts=None)) == [{1}, {2}]
    assert _cuts(None) == []


@pytest.mark.parametrize("objectives", [(UNITS,), (SUCCESS,), (KITCHEN, SUCCESS, INPUTS)])
def test_a_kept_program_answers_as_one_of_its_own(
    objectives: Objectives, monkeypatch: pytest.MonkeyPatch
) -> None:
    """With its seconds; it is looked for once a question."""
    settings = RULED._replace(session=Session())
    asked: list[object] = []
    program = Session.program

    def counted(session: Session, *given: Any) -> Any:
        asked.append(given)
        return program(session, *given)

    monkeypatch.setattr(Session, "program", counted)
    problem = ways(["0.7"] * 3, ["0.343"], ["0.3430000001", "1"])
    afresh = solve(problem, objectives, settings._replace(session=None))
    for _ in range(2):
        asked.clear()
        kept = solve(problem, objectives, settings)
        assert kept._replace(seconds={}) == afresh._replace(seconds={})
        assert set(kept.seconds) == {"cut", "ground", "solve", "check"}
        assert min(kept.seconds.values()) > 0
        assert len(asked) == 1


def test_a_kept_program_that_was_left_halfway_is_dropped(monkeypatch: pytest.MonkeyPatch) -> None:
    """At a limit and at a fault: the next question has one of its own."""
    problem = ways(["0.5", "0.5"], ["0.5"])
    settings = RULED._replace(session=Session())
    closed: list[Grounded] = []
    close = Grounded.close

    def closing(program: Grounded) -> None:
        closed.append(program)
        close(program)

    monkeypatch.setattr(Grounded, "close", closing)
    first = Run(numbers(problem, 0, 1), (2,), True)
    for ended in (Run(lower=[1]), Run(numbers(problem, 2), (1,), False, [1])):
        with monkeypatch.context() as patch:
            Searches(patch, Answer(first), Answer(ended))
            outcome = solve(problem, (UNITS,), settings)
        assert (outcome.status, outcome.bounds) == (Status.FEASIBLE, {UNITS: 1})
        assert len(closed) == 1
        assert solve(problem, (UNITS,), settings).status is Status.OPTIMAL
        assert len(closed) == 1
        closed.clear()
    with monkeypatch.context() as patch:
        Searches(patch, Answer(first), Answer(Run(numbers(problem, 2), (1,), True), trees=[frozenset({99})]))
        with pytest.raises(UserError, match="no unit of that number"):
            solve(problem, (UNITS,), settings)
    assert len(closed) == 1


def test_encodings_that_measure_something_else_are_warned_of(tmp_path: Path) -> None:
    """What they call best is given, though it is not the tree of fewest units."""
    own = own_encodings(tmp_path, objectives=("{ 1@P,U ", "{ -1@P,U "))
    problem = ways(["0.5"], ["0.2", "0.5"])
    for objectives in ((UNITS,), (UNITS, SUCCESS)):
        heard = Heard()
        outcome = solve(problem, objectives, Settings(encodings=own), heard)
        assert outcome.status is Status.OPTIMAL
        assert outcome.units == (0, 1, 2)
        assert outcome.encodings == own
        assert heard.warnings == [
            f"{own / 'objectives.lp'} does not measure what the objectives "
            f"{', '.join(objectives)} measure here: the tree is optimal in its sense, and the costs shown "
            "are the usual ones"
        ]
        assert heard.bounds == []


def test_nobody_knows_what_other_encodings_bound(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    own = own_encodings(tmp_path)
    problem = ways(["0.5"], ["0.2", "0.5"])
    heard = Heard()
    Searches(monkeypatch, None, Answer(Run(numbers(problem, 1, 2), (2,), lower=[2]), [[1], [2]]))
    outcome = solve(problem, (UNITS,), Settings(encodings=own), heard)
    assert (outcome.status, outcome.units, outcome.bounds) == (Status.FEASIBLE, (1, 2), {})
    assert heard.bounds == []
    Searches(monkeypatch, None, Answer(Run(lower=[2])))
    outcome = solve(problem, (UNITS,), Settings(encodings=own), heard)
    assert (outcome.status, outcome.bounds) == (Status.FEASIBLE, {})
    # what they call best counts, whatever was heard of before
    last = Answer(Run(numbers(problem, 1, 2), (2,), True), trees=[numbers(problem, 0)])
    Searches(monkeypatch, None, last)
    assert optimum(problem, (UNITS,), Settings(encodings=own)) == (1, 2)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        # the rival, 0.3430000001, is weighed otherwise than the first tree
        ("{ W@P,U ", "{ W+W/107002483@P,U "),
        # and so is, when it comes to units, the single step
        (
            "{ 1@P,U     : use(U),",
            '{ 1@P,U : use(U), optimize(units,P); 1@P,x,U : motion(U,"go 1 0"), use(U),',
        ),
    ],
)
def test_encodings_that_measure_some_trees_only_are_refused(old: str, new: str, tmp_path: Path) -> None:
    own = own_encodings(tmp_path, objectives=(old, new))
    for rate in ("0.3430000001", "0.343"):
        problem = ways(["0.7"] * 3, [rate])
        if "W" in old and rate == "0.343":
            continue  # a product that was seen is not looked at
        with pytest.raises(UserError) as refused:
            solve(problem, (SUCCESS,), Settings(encodings=own))
        assert str(refused.value) == (
            f"{own / 'objectives.lp'} measures some trees as the objectives success, units do, "
            "and others not: they cannot be compared"
        )


def test_success_needs_rates() -> None:
    problem = dataclasses.replace(ways(["0.5"], ["0.2", "0.5"]), rates=None)
    assert optimum(problem, (UNITS,)) == (0,)
    with pytest.raises(UserError, match="the objective success needs the success rates of the motions"):
        solve(problem, (UNITS, SUCCESS))


def test_what_comes_after_keeps_what_was_settled(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """One unit succeeds less often than two, which were settled on, whoever wrote the encodings."""
    problem = ways(["0.5", "0.5"], ["0.2"])
    for settings, searches in ((SEARCHED, 2), (Settings(encodings=own_encodings(tmp_path)), 3)):
        Searches(monkeypatch, *[None] * searches, Answer(Run(numbers(problem, 2), (1,), True)))
        with pytest.raises(BugError, match=r"the tree \[2\] is to be as good as \[0, 1\] by success"):
            solve(problem, (SUCCESS,), settings)


@pytest.mark.parametrize(
    ("objectives", "wrong"),
    [
        ((UNITS,), {UNITS: 2}),
        ((UNITS, INPUTS), {INPUTS: 0}),
        ((SUCCESS,), {SUCCESS: Fraction("0.50001")}),
        ((SUCCESS,), {UNITS: 2}),
        ((KITCHEN, SUCCESS), {KITCHEN: 0}),
    ],
)
def test_costs_are_held_against_what_units_weigh(
    objectives: Objectives, wrong: ByObjective, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Whatever is wrong with what trees are said to cost, clingo counts otherwise."""
    costs = Problem.costs
    monkeypatch.setattr(
        Problem, "costs", lambda problem, units: Costs({**costs(problem, units).measures, **wrong})
    )
    with pytest.raises(BugError, match=r"the units \[0\] weigh \[.*\], but cost \['"):
        solve(ways(["0.5"]), objectives, SEARCHED)
