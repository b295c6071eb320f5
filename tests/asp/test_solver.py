"""Best trees of questions that are worked out by hand, and what is made of the answers of clingo."""

import dataclasses
import itertools
import shutil
import time
from collections.abc import Callable, Sequence
from fractions import Fraction
from pathlib import Path
from typing import Any, NamedTuple

import pytest

from foon_asp.asp import Outcome, Proof, Reporter, Settings, Status, solve
from foon_asp.asp.bare_program import bare_program
from foon_asp.deadline import Deadline
from foon_asp.encoding.grounded import Grounded
from foon_asp.encoding.run import Run
from foon_asp.errors import BugError, UserError
from foon_asp.hypergraph import ALL, NONE
from foon_asp.network import NetworkBuilder, ObjectNode, Source, UnitPrices
from foon_asp.problem import Costs, Objective, Problem, levels
from foon_asp.resources import encodings_folder
from tests.support.gap_problem import gap_problem
from tests.support.ways_problem import GOAL, ways

UNITS, INPUTS, SUCCESS, KITCHEN = Objective.UNITS, Objective.INPUTS, Objective.SUCCESS, Objective.KITCHEN
SEARCHED = Settings(reductions=NONE)
RULED = Settings((Path("at_most_units"),), constants=("max_units=9",), reductions=NONE)
Objectives = tuple[Objective, ...]
ByObjective = dict[Objective, int | Fraction]


class Answer(NamedTuple):
    """What a search says: bounds and trees, by number, on its way, and what it ends with."""

    run: Run
    bounds: Sequence[list[int]] = ()
    trees: Sequence[frozenset[int]] = ()


def answering(monkeypatch: pytest.MonkeyPatch, *answers: Answer | None) -> None:
    """Have clingo say these answers, one a search; it is asked itself for ``None``, and afterwards."""
    waiting, search = list(answers), Grounded.search

    def instead(
        grounded: Grounded,
        deadline: Deadline,
        opt_mode: str,
        on_tree: Callable[[frozenset[int]], None] | None = None,
        on_bound: Callable[[list[int]], None] | None = None,
        *given: Any,
    ) -> Run:
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


@pytest.mark.parametrize(
    ("objectives", "settings", "bounds", "proof", "left"),
    [
        ((UNITS,), Settings(), {UNITS: 1}, Proof.CUTS, 0),
        ((SUCCESS, KITCHEN), SEARCHED, {SUCCESS: Fraction(1, 2), KITCHEN: 1, UNITS: 1}, Proof.SOLVER, 3),
    ],
)
def test_an_outcome_with_a_tree(
    objectives: Objectives, settings: Settings, bounds: ByObjective, proof: Proof, left: int
) -> None:
    problem = ways(["0.5"], ["0.5", "0.2"], beside=True)
    began = time.perf_counter()
    outcome = solve(problem, objectives, settings)
    elapsed = time.perf_counter() - began
    costs = problem.costs((0,))
    expected = Outcome(problem, objectives, Status.OPTIMAL, (0,), costs, bounds, {}, proof=proof, left=left)
    assert outcome._replace(seconds={}, cuts=()) == expected
    assert outcome.cuts == (((problem.goals[0],),) if proof is Proof.CUTS else ())
    assert min(outcome.seconds.values()) > 0
    assert sum(outcome.seconds.values()) <= elapsed


@pytest.mark.parametrize("settings", [SEARCHED, Settings(), RULED])
def test_an_outcome_without_a_tree(settings: Settings) -> None:
    problem = dataclasses.replace(ways(["0.5"]), kitchen=frozenset())
    expected = Outcome(problem, (SUCCESS,), Status.INFEASIBLE, None, None, {}, {}, proof=Proof.SOLVER)
    assert solve(problem, (SUCCESS,), settings)._replace(seconds={}) == expected


def test_what_is_proved_was_not_stopped() -> None:
    deadline = Deadline()

    class Hasty(Reporter):
        def bound(self, objective: Objective, bound: int | Fraction) -> None:
            deadline.interrupt()

    outcome = solve(ways(["0.5"]), (UNITS,), Settings(deadline=deadline), Hasty())
    assert (outcome.proof, outcome.stopped, deadline.interrupted) == (Proof.CUTS, None, True)


def test_options_of_clingo_are_looked_at_though_there_is_nothing_to_ask() -> None:
    problem = ways(["0.5"])
    assert solve(problem, (UNITS,), Settings(clingo_options=("--configuration=trendy",))).proof is Proof.CUTS
    with pytest.raises(UserError, match="no-such-option"):
        solve(problem, (UNITS,), Settings(clingo_options=("--no-such-option",)))


# --- What clingo is told, and the best trees.


def test_the_facts_of_a_question() -> None:
    """What cannot run is there where a goal cannot be made, and what no goal needs where rules may ask."""
    problem = ways(["0.5", "1"], beside=True)
    ruled = Settings(constraints=(Path("at_most_units"),), constants=("max_units=3",))
    text = bare_program(problem, (SUCCESS,), ruled, {}).facts
    assert text.splitlines() == [
        'unit(0). motion(0,"go 0 0"). input(0,0). needs(0,0). output(0,1). gives(0,1). inputs(0,1). '
        'ingredients(0,0). rate(0,500000). risk(0,69314718). source(0,"way 0").',
        'unit(1). motion(1,"go 0 1"). input(1,1). needs(1,1). output(1,2). gives(1,2). inputs(1,1). '
        'ingredients(1,0). rate(1,1000000). risk(1,0). source(1,"way 0").',
        'unit(2). motion(2,"garnish"). input(2,0). needs(2,0). output(2,3). gives(2,3). inputs(2,1). '
        'ingredients(2,0). rate(2,1000000). risk(2,0). source(2,"ways").',
        'object(0). label(0,"start"). kitchen(0).',
        'object(1). label(1,"way 0"). state(1,"0").',
        'object(2). label(2,"goal").',
        'object(3). label(3,"garnish").',
        *("goal(2).", "optimize(success,2).", "optimize(units,1)."),
    ]
    half = dataclasses.replace(ways(["0.5"], ["0.5", "0.5"]), kitchen=frozenset({2}))
    for asked, units in (
        (problem, {0, 1}),
        (dataclasses.replace(problem, kitchen=frozenset()), {0, 1}),
        (half, {2}),
        (dataclasses.replace(half, goals=(*half.goals, 0)), {0, 2}),
    ):
        lines = bare_program(asked, (SUCCESS,), Settings(), {}).facts.splitlines()
        assert {unit for unit in range(3) if any(line.startswith(f"unit({unit})") for line in lines)} == units
        assert "source(" not in "".join(lines)


CHAINS: list[tuple[tuple[list[str], ...], Objectives, tuple[int, ...]]] = [
    ((["0.5", "0.5"], ["0.2"]), (UNITS,), (2,)),
    ((["0.5", "0.5"], ["0.2"]), (UNITS, SUCCESS), (2,)),
    ((["0.5", "0.5"], ["0.2"]), (KITCHEN, SUCCESS), (0, 1)),
    # three times 0.7 weighs 107002482 and may have lost 2 more; 0.3430000001 is better, and one unit
    ((["0.7"] * 3, ["0.3430000001"]), (SUCCESS,), (3,)),
    ((["0.7"] * 3, ["0.3429999999"]), (SUCCESS,), (0, 1, 2)),
    # of equal products fewest units count
    ((["0.7"] * 3, ["0.343"]), (SUCCESS,), (3,)),
    ((["0.7"] * 3, ["0.343"]), (KITCHEN, SUCCESS), (3,)),
    ((["0.7"] * 3, ["0.343"]), (SUCCESS, KITCHEN), (3,)),
    # units of rate 1 lose nothing, and what is not certain may weigh as little
    ((["0.5", "1"], ["0.2"]), (SUCCESS,), (0, 1)),
    ((["0.9999999999"], ["1", "1"], ["0.5"]), (SUCCESS,), (1, 2)),
    # three units of 10^-9 weigh 6,216,979,749 together, which clingo reports modulo 2^32
    ((["0.000000001"] * 3,), (SUCCESS,), (0, 1, 2)),
    ((["0.000000001"] * 3, ["0.000000001", "0.000000001", "0.1"]), (SUCCESS,), (3, 4, 5)),
]


@pytest.mark.parametrize(("chains", "objectives", "best"), CHAINS)
def test_the_best_of_several_ways(
    chains: tuple[list[str], ...], objectives: Objectives, best: tuple[int, ...]
) -> None:
    """By cuts and by searches, with a program that is kept and with another; trees heard of get better."""
    problem = ways(*chains)
    for settings in (Settings(), SEARCHED, RULED, RULED):
        heard = Heard()
        outcome = solve(problem, objectives, settings, heard)
        assert (outcome.status, outcome.units) == (Status.OPTIMAL, best)
        assert heard.trees[-1] == outcome.costs
        assert heard.warnings == []
        keys = [costs.key(levels(objectives)) for costs in heard.trees]
        assert keys == sorted({*keys}, reverse=True)
        bounds = [bound for objective, bound in heard.bounds if objective is objectives[0]]
        figures = [-bound if objectives[0] is SUCCESS else bound for bound in bounds]
        assert figures == sorted(figures)
        assert all(figure <= keys[-1][0] for figure in figures)


def test_totals_that_are_equal_have_equal_rights() -> None:
    """All ways cost 6, but for the last, and weigh the less the more they lose by rounding."""
    thirds = [Fraction(number, 3) for number in range(11)]
    prices = [[Fraction(2)] * 3, thirds[4:6] * 2, [thirds[8], thirds[10]], [6 + Fraction(1, 10**9 + 7)]]
    problem = ways(*(["1"] * len(chain) for chain in prices))
    motions = dict(zip(problem.network.motions, itertools.chain(*prices), strict=True))
    problem = dataclasses.replace(problem, unit_prices=UnitPrices(motions, {}))
    for settings in (SEARCHED, Settings(), RULED):
        assert optimum(problem, (Objective.PRICE,), settings) == (7, 8)


@pytest.mark.parametrize("reductions", [NONE, ALL])
def test_nothing_is_below_0(reductions: Any) -> None:
    """A unit that needs nothing takes nothing from the kitchen: what is better has fewer units."""
    builder = NetworkBuilder()
    builder.add("find", [], [ObjectNode.of("part")], Source("nothing", 1))
    builder.add("build", [ObjectNode.of("part")], [GOAL], Source("nothing", 2))
    builder.add("buy", [], [GOAL], Source("nothing", 3))
    network = builder.build()
    goal = network.object_id(GOAL)
    assert goal is not None
    problem = Problem(network, frozenset(), (goal,), None, frozenset())
    for options, objectives in itertools.product(
        ((), ("--opt-strategy=bb",)), ((UNITS, KITCHEN), (KITCHEN, UNITS))
    ):
        assert optimum(problem, objectives, Settings(reductions=reductions, clingo_options=options)) == (2,)
    at_hand = dataclasses.replace(ways(["0.5"]), kitchen=frozenset({0, 1}))
    for objective in (UNITS, SUCCESS):
        assert optimum(at_hand, (objective,), Settings(reductions=reductions)) == ()
    assert optimum(ways(["1", "1"], ["1"]), (SUCCESS,), Settings(reductions=reductions)) == (2,)


def test_answers_are_about_the_numbers_of_the_whole_network() -> None:
    """Of a network a part is read, whose units keep their numbers in facts and answers."""
    whole = ways(["0.2", "0.2"], ["0.5"] * 3, ["0.7"] * 3, ["0.3430000001"])
    part = dataclasses.replace(whole, network=whole.network.without((0, 1, 3)))
    for settings in (SEARCHED, Settings(), RULED, RULED):
        heard = Heard()
        assert solve(part, (SUCCESS,), settings, heard).units == (5,)
        assert heard.trees[-1] == part.costs((5,))
    assert 'unit(8). motion(8,"go 3 0")' in bare_program(part, (UNITS,), Settings(), {}).facts


def test_success_needs_rates() -> None:
    problem = dataclasses.replace(ways(["0.5"], ["0.2", "0.5"]), rates=None)
    assert optimum(problem, (UNITS,)) == (0,)
    with pytest.raises(UserError, match="the objective success needs the success rates of the motions"):
        solve(problem, (UNITS, SUCCESS))


# --- Limits.


def test_without_time_there_is_a_tree_and_nothing_is_proved() -> None:
    problem = ways(["0.5"], ["0.5", "0.5"])
    for objective, bound in ((UNITS, 0), (SUCCESS, 1)):
        heard = Heard()
        outcome = solve(problem, (objective,), SEARCHED._replace(deadline=Deadline(0)), heard)
        assert (outcome.status, outcome.bounds) == (Status.FEASIBLE, {objective: bound})
        assert outcome.stopped == "the time limit of 0 s while cutting the network"
        assert outcome.costs == heard.trees[-1]


E_3 = Fraction("0.740818220681717868")  # e^-0.3, which weighs 3 * 10^7
CUTS = Fraction("0.771637500000000001")


@pytest.mark.parametrize(
    ("objectives", "lower", "bounds"),
    [
        ((UNITS,), [], {UNITS: 5}),
        ((UNITS,), [-5], {UNITS: 5}),
        ((UNITS,), [6], {UNITS: 6}),
        ((UNITS,), [9], {UNITS: 6}),  # nothing is better than the tree in hand
        ((UNITS, KITCHEN), [5, 9], {UNITS: 5}),  # the second says something of trees of 5 units only
        ((UNITS, KITCHEN), [6], {UNITS: 6}),
        ((UNITS, KITCHEN), [6, -1], {UNITS: 6, KITCHEN: 0}),
        ((UNITS, KITCHEN), [9, 9], {UNITS: 6, KITCHEN: 2}),
        # the tree with the least sum of rounded weights may not be the one that succeeds most often
        ((UNITS, SUCCESS, KITCHEN), [6, 3 * 10**7, 1], {UNITS: 6, SUCCESS: E_3}),
        ((SUCCESS,), [], {SUCCESS: CUTS}),
        ((SUCCESS,), [1], {SUCCESS: CUTS}),
        ((SUCCESS, UNITS), [3 * 10**7, 3], {SUCCESS: E_3}),
    ],
)
def test_bounds_at_a_limit(
    objectives: Objectives, lower: list[int], bounds: ByObjective, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Cuts prove 5 units of 6; the better of that and what the search says counts."""
    problem, heard = gap_problem(0, 3), Heard()
    answering(monkeypatch, Answer(Run(lower=lower), [lower]))
    outcome = solve(problem, objectives, Settings(), heard)
    assert (outcome.status, outcome.costs, outcome.stopped) == (Status.FEASIBLE, heard.trees[-1], None)
    assert [*outcome.bounds.items()] == [*bounds.items()] == heard.bounds[-len(bounds) :]


def test_at_a_limit_the_best_tree_heard_of_is_given(monkeypatch: pytest.MonkeyPatch) -> None:
    """The one in hand, what a search came by, or what it came to, of which weights may tell too little."""
    problem = ways(["0.7"] * 3, ["0.3430000001", "1"], ["0.3430000001"])
    long, two, one = ((0, 1, 2), (3, 4), (5,))
    least = Answer(Run(numbers(problem, *long), (107_002_482, 3), True, [107_002_482, 3]))
    halfway = Answer(Run(numbers(problem, *long), (107_002_482, 3), lower=[10**8]))
    by = [numbers(problem, *two)]
    for answers, best in (
        ([Answer(Run(lower=[1]))], long),
        ([halfway], long),
        ([halfway._replace(trees=by)], two),
        ([least, Answer(Run())], long),
        ([least, Answer(Run(), trees=by)], two),
        ([least, Answer(Run(by[0], (107_002_483,)))], two),
        ([least._replace(trees=by), Answer(Run(exhausted=True)), Answer(Run())], two),
        ([least, None, Answer(Run(exhausted=True)), Answer(Run(numbers(problem, *one), (0, 1)))], one),
    ):
        answering(monkeypatch, *answers)
        outcome = solve(problem, (SUCCESS,), SEARCHED)
        assert (outcome.status, outcome.units) == (Status.FEASIBLE, best)
        assert list(outcome.bounds) == [SUCCESS]
        assert outcome.bounds[SUCCESS] >= Fraction("0.3430000001")


@pytest.mark.parametrize(
    ("exhausted", "status", "proof"), [(True, Status.INFEASIBLE, Proof.SOLVER), (False, Status.UNKNOWN, None)]
)
def test_no_tree_under_a_rule(
    exhausted: bool, status: Status, proof: Proof | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    answering(monkeypatch, Answer(Run(exhausted=exhausted)))
    outcome = solve(ways(["0.5"]), (UNITS,), RULED._replace(constants=("max_units=0",)))
    assert (outcome.status, outcome.proof, outcome.units, outcome.bounds) == (status, proof, None, {})


# --- What clingo says is not believed.


def test_searches_that_contradict_each_other_are_a_bug(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of two units is the best tree of the last search, of one unit that of the first."""
    problem = ways(["0.5"], ["0.5", "1"])
    first, last = Run(numbers(problem, 0), (69_314_718, 1), True), Run(numbers(problem, 1, 2), (2,), True)
    answering(monkeypatch, Answer(first), Answer(Run(exhausted=True)), Answer(last))
    with pytest.raises(BugError, match="but one was found for"):
        solve(problem, (SUCCESS,), SEARCHED)
    answering(monkeypatch, None, None, Answer(Run(exhausted=True)))
    with pytest.raises(BugError, match="the best success was lost"):
        solve(ways(["0.5"], ["0.2"]), (SUCCESS,), SEARCHED)
    # one unit succeeds less often than two, which were settled on
    problem = ways(["0.5", "0.5"], ["0.2"])
    answering(monkeypatch, None, None, Answer(Run(numbers(problem, 2), (1,), True)))
    with pytest.raises(BugError, match=r"the tree \[2\] is to be as good as \[0, 1\] by success"):
        solve(problem, (SUCCESS,), SEARCHED)


@pytest.mark.parametrize(
    ("units", "costs", "message"),
    [
        ((0,), (2, 1), r"clingo reports the costs \[2, 1\], the units \[0\] cost \[1, 1\]"),
        ((0,), (1, 1 + 2**31), "clingo reports the costs"),
        ((0,), (1,), r"clingo reports the costs \[1\]"),
        ((0,), (1, 1, 0), r"clingo reports the costs \[1, 1, 0\]"),
        ((0,), (1 - 2**32, 1 + 2**32), None),
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
    answering(monkeypatch, Answer(Run(numbers(problem, *units), costs, exhausted)))
    if message is None:
        assert solve(problem, (INPUTS, UNITS), SEARCHED).units == units
        return
    with pytest.raises(BugError, match=message):
        solve(problem, (INPUTS, UNITS), SEARCHED)


@pytest.mark.parametrize(
    ("objectives", "wrong"),
    [
        ((UNITS, INPUTS), {INPUTS: 0}),
        ((SUCCESS,), {SUCCESS: Fraction("0.50001")}),
        ((KITCHEN, SUCCESS), {UNITS: 2}),
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


@pytest.mark.parametrize("at_hand", [False, True])
def test_no_tree_where_there_is_one_is_a_bug(at_hand: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    problem = ways(["0.5"])
    if at_hand:
        problem = dataclasses.replace(problem, kitchen=problem.kitchen.union(problem.goals))
    for objectives in ((UNITS,), (SUCCESS,)):
        answering(monkeypatch, Answer(Run(exhausted=True)))
        with pytest.raises(BugError, match="a tree is at hand, but the encodings say that there is none"):
            solve(problem, objectives, SEARCHED)


def test_units_that_the_network_has_not_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    problem = ways(["0.5"])
    answering(monkeypatch, Answer(Run(numbers(problem, 0) | {77}, (2,), True)))
    with pytest.raises(
        UserError, match=r"^the encodings made use\(77\), but the network has no unit of that number$"
    ):
        solve(problem, (UNITS,), SEARCHED)


# --- Rules and encodings of the user's.


def test_under_a_rule_all_that_can_be_made_is_left(tmp_path: Path) -> None:
    rule = tmp_path / "rule.lp"
    rule.write_text(':- not use(U) : motion(U,"garnish").  :- use(U), source(U,"way 1").\n')
    problem = ways(["0.5"], ["0.2"], beside=True)
    for reductions, proof, left in ((NONE, Proof.SOLVER, 3), (ALL, Proof.CUTS, 0)):
        outcome = solve(problem, (SUCCESS,), Settings(constraints=(rule,), reductions=reductions))
        assert (outcome.status, outcome.units, outcome.proof) == (Status.OPTIMAL, (0, 2), proof)
        assert outcome.left == left
        # the set of units that the rule asks for is a goal of no node, so no cut of it is told
        assert outcome.cuts == (() if reductions is NONE else ((problem.goals[0],),))


def test_encodings_that_measure_something_else_are_warned_of(tmp_path: Path) -> None:
    """What they call best is given, though it is not the tree of fewest units."""
    own = own_encodings(tmp_path, objectives=("{ 1@P,U ", "{ -1@P,U "))
    problem = ways(["0.5"], ["0.2", "0.5"])
    heard = Heard()
    outcome = solve(problem, (UNITS, SUCCESS), Settings(encodings=own), heard)
    assert (outcome.status, outcome.units, outcome.encodings) == (Status.OPTIMAL, (0, 1, 2), own)
    assert heard.warnings == [
        f"{own / 'objectives.lp'} does not measure what the objectives units, success measure here: the tree "
        "is optimal in its sense, and the costs shown are the usual ones"
    ]
    assert heard.bounds == []


def test_nobody_knows_what_other_encodings_bound(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    settings = Settings(encodings=own_encodings(tmp_path))
    problem = ways(["0.5"], ["0.2", "0.5"])
    heard, two = Heard(), numbers(problem, 1, 2)
    answering(monkeypatch, None, Answer(Run(two, (2,), lower=[2]), [[1], [2]]))
    outcome = solve(problem, (UNITS,), settings, heard)
    assert (outcome.status, outcome.units, outcome.bounds) == (Status.FEASIBLE, (1, 2), {})
    assert heard.bounds == []
    # what they call best counts, whatever was heard of before
    answering(monkeypatch, None, Answer(Run(two, (2,), True), trees=[numbers(problem, 0)]))
    assert optimum(problem, (UNITS,), settings) == (1, 2)


@pytest.mark.parametrize(
    ("rate", "old", "new"),
    [
        # the rival, 0.3430000001, is weighed otherwise than the first tree
        ("0.3430000001", "{ W@P,U ", "{ W+W/107002483@P,U "),
        # and so is, when it comes to units, the single step
        (
            "0.343",
            "{ 1@P,U     : use(U),",
            '{ 1@P,U : use(U), optimize(units,P); 1@P,x,U : motion(U,"go 1 0"), use(U),',
        ),
    ],
)
def test_encodings_that_measure_some_trees_only_are_refused(
    rate: str, old: str, new: str, tmp_path: Path
) -> None:
    own = own_encodings(tmp_path, objectives=(old, new))
    with pytest.raises(UserError) as refused:
        solve(ways(["0.7"] * 3, [rate]), (SUCCESS,), Settings(encodings=own))
    assert str(refused.value) == (
        f"{own / 'objectives.lp'} measures some trees as the objectives success, units do, "
        "and others not: they cannot be compared"
    )
