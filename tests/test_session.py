"""Programs that are kept from question to question give the answers that each question has by itself."""

import random
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import pytest

from foon_asp.asp import Outcome, Settings, Status, solve
from foon_asp.asp.assembly import assemble
from foon_asp.asp.session import OpenProgram, Session
from foon_asp.deadline import Deadline
from foon_asp.encoding import exact_success
from foon_asp.network import UnitPrices
from foon_asp.problem import ContainerRule, Objective, Problem, levels, reach
from foon_asp.reduce import ALL, NONE
from tests import oracle
from tests.hard_problem import hard_problem
from tests.random_problems import MOTIONS, SERIES, random_objectives, random_problem
from tests.test_optimum import constraint

# Rules that are understood are applied before a program is asked, unless no reductions are asked for.
AT_MOST = Settings(constraints=(Path("at_most_units"),), reductions=NONE)

# Constraints that look at facts without use(U): what is not there must not be seen by them.
NOSY = (
    ':- unit(U), motion(U,"bake"), not use(U).',
    ":- #count { U : unit(U) } > 4, use(U), kitchen(O), needs(U,O).",
    ":- #count { O : object(O), label(O,L), not kitchen(O) } < 3.",
    ':- utensil("bowl"), goal(O), label(O,"bowl").',
    "more(U) :- unit(U), V < U : unit(V), V != U. :- more(U), use(U).",
    ":- N = #count { U : unit(U), inputs(U,2) }, use(N).",
    ":- risk(U,W), W > 100000000, use(U), state(O,S), located(O,W2,L), ingredient(O,I), source(U,X).",
)


def measured(outcome: Outcome) -> object:
    """Give what has to be the same: status, proof, and costs by the objectives."""
    costs = outcome.costs
    measures = None if costs is None else [costs.measure(o) for o in levels(outcome.objectives)]
    return outcome.status, outcome.proof, measures, outcome.bounds


def change(problem: Problem, rng: random.Random, rules: list[ContainerRule]) -> Problem:
    """Change kitchen, goals or container rule, as a session does."""
    objects = range(len(problem.network.objects))
    match rng.randrange(4):
        case 0:
            return replace(problem, kitchen=problem.kitchen ^ {rng.choice(objects)})
        case 1:
            return replace(
                problem, kitchen=frozenset(rng.sample(objects, rng.randint(0, min(5, len(objects)))))
            )
        case 2:
            return replace(
                problem, goals=tuple(rng.sample(objects, min(len(objects), rng.choice((1, 1, 2, 3)))))
            )
        case _:
            return replace(problem, containers=rng.choice(rules))


@pytest.mark.slow
@pytest.mark.parametrize("seeds", [range(5), pytest.param(range(5, 400), marks=pytest.mark.slow)])
def test_random_sessions(seeds: range, tmp_path: Path) -> None:
    """Changes to kitchen, goals, rule, constraint and objectives, one after another; by brute force too."""
    asked = proved = 0
    for seed in seeds:
        rng = random.Random(seed)
        session = Session()
        problem = random_problem(seed, ContainerRule.STRICT, units=rng.choice((7, 8, 20)))
        nosy = tmp_path / "nosy.lp"
        nosy.write_text(rng.choice(NOSY))
        for _ in range(12):
            problem = change(problem, rng, list(ContainerRule))
            name, constants, allowed = constraint(seed, problem)  # the same, of these goals and this kitchen
            objectives = random_objectives(rng, rng.randint(1, 3))
            with_nosy = rng.random() < 0.5
            files = (nosy,) if with_nosy else (Path(name),)
            settings = Settings(
                constraints=files,
                constants=() if with_nosy else tuple(constants),
                reductions=NONE if seed % 3 else ALL,
            )
            afresh = solve(problem, objectives, settings)
            kept = solve(problem, objectives, settings._replace(session=session))
            assert measured(kept) == measured(afresh), (seed, objectives, files)
            asked += 1
            proved += kept.status is Status.OPTIMAL
            if not with_nosy and len(problem.network) <= 8:
                found = list(oracle.trees(problem, allowed))
                best = oracle.best(found, problem, list(map(str, objectives)))
                assert (best is None) == (kept.units is None)
                if kept.units is not None:
                    tree = tuple(map(problem.network.unit, kept.units))
                    assert oracle.key(problem, tree, list(map(str, objectives))) == best
    assert asked // 10 < proved < asked


def test_one_program_serves_many_questions(monkeypatch: pytest.MonkeyPatch) -> None:
    """Goals, kitchen and objectives that were met before ground nothing."""
    grounded: list[int] = []
    made = OpenProgram.__init__

    def count(self: OpenProgram, *arguments: object) -> None:
        grounded.append(1)
        made(self, *arguments)  # type: ignore[arg-type]

    monkeypatch.setattr(OpenProgram, "__init__", count)
    problem = next(p for p in (random_problem(s, ContainerRule.STRICT, 20) for s in range(99)) if p.kitchen)
    everything = replace(problem, kitchen=frozenset(range(len(problem.network.objects))))
    rule = Settings(constraints=(Path("at_most_units"),), constants=("max_units=3",))
    settings = rule._replace(session=Session(), reductions=NONE)
    orders = [(Objective.SUCCESS,), (Objective.KITCHEN, Objective.SUCCESS)]
    for objectives in orders:
        solve(everything, objectives, settings)
    assert len(grounded) == 2
    for objectives in orders:
        for goal in range(len(problem.network.objects)):
            solve(replace(everything, goals=(goal,)), objectives, settings)
    assert len(grounded) == 2
    item = min(everything.kitchen - set(everything.goals))
    for _ in range(3):  # what has changed once is left open
        for kitchen in (everything.kitchen - {item}, everything.kitchen):
            solve(replace(everything, kitchen=kitchen), orders[0], settings)
    assert len(grounded) == 3
    solve(replace(everything, containers=ContainerRule.IMPLIED), (Objective.SUCCESS,), settings)
    assert len(grounded) == 4


@pytest.mark.slow
def test_a_kitchen_that_changes_too_much_is_grounded_anew(monkeypatch: pytest.MonkeyPatch) -> None:
    """What was left open is forgotten when it is too much; and answers stay the same."""
    monkeypatch.setattr("foon_asp.asp.session._MOST_OPEN", 2)
    monkeypatch.setattr("foon_asp.asp.session._MOST_PRODUCTS", 1)
    session = Session()
    settings = AT_MOST._replace(constants=("max_units=5",))
    rng = random.Random(1)
    problem = random_problem(3, ContainerRule.STRICT, 20)
    for _ in range(40):
        problem = change(problem, rng, [ContainerRule.STRICT])
        afresh = solve(problem, (Objective.SUCCESS,), settings)
        kept = solve(problem, (Objective.SUCCESS,), settings._replace(session=session))
        assert measured(kept) == measured(afresh)


def test_a_constraint_file_that_changed_is_read_again(tmp_path: Path) -> None:
    problem = next(
        p
        for p in (random_problem(seed, ContainerRule.STRICT) for seed in range(99))
        if (costs := solve(p).costs) and costs.units == 2
    )
    mine = tmp_path / "mine.lp"
    settings = Settings(constraints=(mine,), session=Session(), reductions=NONE)
    for most, expected in ((3, Status.OPTIMAL), (1, Status.INFEASIBLE), (2, Status.OPTIMAL)):
        mine.write_text(f":- #count {{ U : use(U) }} > {most}.")
        assert solve(problem, (Objective.UNITS,), settings).status is expected


@pytest.mark.slow
def test_a_rate_too_small_for_the_scale_of_others() -> None:
    """Which units there are decides how finely rates are scaled; constraints can see it."""
    seed, problem = next(
        (s, p) for s in range(99) if len(reach(p := random_problem(s, ContainerRule.STRICT)).units) > 4
    )
    assert problem.rates is not None
    rates = dict(problem.rates) | {problem.network.motions[0]: Fraction(1, 10**30)}
    everything = replace(problem, rates=rates, kitchen=frozenset(range(len(problem.network.objects))))
    settings = Settings(constraints=(Path("least_rate"),), constants=("least_rate=1000",), reductions=NONE)
    session, rng = Session(), random.Random(seed)
    for _ in range(20):
        kitchen = frozenset(rng.sample(sorted(everything.kitchen), 3))
        for each in (everything, replace(everything, kitchen=kitchen)):
            goal = rng.choice(sorted(everything.kitchen))
            asked = replace(each, goals=(goal,), kitchen=each.kitchen - {goal})
            afresh = solve(asked, (Objective.SUCCESS,), settings)
            kept = solve(asked, (Objective.SUCCESS,), settings._replace(session=session))
            assert measured(kept) == measured(afresh)


@pytest.mark.slow
@SERIES
@pytest.mark.parametrize("scale", [1, 7])
@pytest.mark.sampled(2)
def test_coarse_weights_with_kept_products(part: int, scale: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Nearly every tree is in the band: many products, seen and wanted again in other questions."""
    monkeypatch.setattr(exact_success, "_scale", lambda _: scale)
    for seed in range(25 // part):
        problem, session = random_problem(seed, ContainerRule.IMPLIED), Session()
        settings = AT_MOST._replace(constants=("max_units=6",))
        rng = random.Random(seed)
        for _ in range(5):
            for objectives in ([Objective.SUCCESS], [Objective.KITCHEN, Objective.SUCCESS, Objective.INPUTS]):
                afresh = solve(problem, objectives, settings)
                kept = solve(problem, objectives, settings._replace(session=session))
                assert measured(kept) == measured(afresh), (seed, objectives)
            problem = change(problem, rng, [ContainerRule.IMPLIED])


def test_a_kept_program_counts_the_items_of_the_kitchen_asked_about() -> None:
    """Two kitchens, and again the first: what counts is the kitchen of the question, not of one before."""
    settings = AT_MOST._replace(constants=("max_units=9",), session=Session())
    for seed in range(3):
        problem = random_problem(seed, ContainerRule.STRICT, units=7)
        less = replace(problem, kitchen=frozenset(sorted(problem.kitchen)[1:]))
        for asked in (problem, less, problem, less):
            for objectives in ([Objective.KITCHEN], [Objective.KITCHEN, Objective.SUCCESS, Objective.INPUTS]):
                kept = solve(asked, objectives, settings)
                assert measured(kept) == measured(solve(asked, objectives, settings._replace(session=None)))


def test_a_program_of_prices_is_not_kept() -> None:
    """They are rounded, as success is, and one program settles what rounding may hide of one of them."""
    problem, session = random_problem(0, ContainerRule.STRICT), Session()
    problem = replace(problem, unit_prices=UnitPrices(dict.fromkeys(MOTIONS, Fraction(1, 3)), {}))
    settings = AT_MOST._replace(constants=("max_units=9",), session=session)
    for objectives, kept in (((Objective.PRICE,), 0), ((Objective.SUCCESS,), 1)):
        solve(problem, objectives, settings)
        assert len(session._programs) == kept


@pytest.mark.slow
def test_after_a_limit_the_session_goes_on() -> None:
    problem, session = hard_problem(12, 8, 3, 3), Session()
    settings = AT_MOST._replace(constants=("max_units=99",), deadline=Deadline(0), session=session)
    assert solve(problem, (Objective.UNITS,), settings).status in {Status.UNKNOWN, Status.FEASIBLE}
    assert not session._programs  # a search that was stopped is not gone on with
    in_time = settings._replace(deadline=None)
    kept = solve(problem, (Objective.UNITS,), in_time)
    assert measured(kept) == measured(solve(problem, (Objective.UNITS,), in_time._replace(session=None)))
    assert kept.status is Status.OPTIMAL


@pytest.mark.parametrize(
    ("rule", "is_open"),
    [
        (':- use(U), motion(U,"bake").', True),
        (":- #count { U : use(U) } = 3.", True),
        (":- N = #count { U : use(U) }, N > 3.", False),
        (":- { use(U) : unit(U) } = N, unit(N).", False),
        (":- optimize(units,P), P > 1.", False),
    ],
)
def test_what_cannot_be_left_open(rule: str, is_open: bool, tmp_path: Path) -> None:
    """An aggregate that gives a variable its value can blow up; what a search adds is not the question's."""
    (tmp_path / "mine.lp").write_text(rule)
    settings = Settings(constraints=(tmp_path / "mine.lp",))
    assert assemble(settings, lambda _: None).open is is_open
    assert not assemble(settings._replace(encodings=Path("by_need")), lambda _: None).open
    assert not assemble(Settings(), lambda _: None).open
