"""Ready-made constraints that are understood without clingo, against clingo."""

import subprocess
import sys
from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import pytest

from foon_asp.asp import Settings, Status, solve
from foon_asp.asp.assembly import assemble, hold_for_parts, leave_a_rest, reach_of_rules, ready_made
from foon_asp.asp.prepared import Prepared
from foon_asp.deadline import Deadline
from foon_asp.encoding.encoding import read_encoding
from foon_asp.encoding.facts import FACT_PREDICATES, READ_BY_OURS
from foon_asp.network import UnitPrices
from foon_asp.problem import Contradiction, Objective, Problem, Restriction, levels
from foon_asp.proof.constraint import LIBRARY
from foon_asp.reduce import ALL, NONE, Reduction
from foon_asp.resources import encodings_folder
from foon_asp.rules import flat_answers
from foon_asp.rules.constraint import given_constraint
from foon_asp.rules.ready_made import READ, ReadyMade
from tests.conftest import Cli
from tests.constraint_oracle import HEATS, settings_of
from tests.test_constraint_meanings import drawn, trees
from tests.test_nearby import near_of, stored

SEEDS = range(48)
ROOT = Path(__file__).resolve().parents[1]


def silent(_: str) -> None:
    """Hear nothing."""


def known(problem: Problem, settings: Settings) -> ReadyMade:
    program = ready_made(problem, settings, silent)
    assert program is not None
    assert program.ready_made is not None
    return program.ready_made


def asked(seed: int) -> Iterator[tuple[Problem, Settings]]:
    """Draw a problem, constraints on their own, and some of them together."""
    problem, rules, rng = drawn(seed)
    yield from ((problem, settings_of(rng.sample(rules, some))) for some in (1, 1, 1, 1, 2, 3))


@pytest.mark.sampled(24)
@pytest.mark.parametrize("seed", SEEDS)
def test_a_tree_keeps_to_them_as_clingo_says(seed: int) -> None:
    for problem, settings in asked(seed):
        by_clingo = Prepared(
            problem, levels((Objective.UNITS,)), settings, Deadline(), assemble(settings, silent)
        )
        rules = known(problem, settings)
        for units, _ in [*trees(problem)][:3]:
            assert rules.keeps(problem, units) == by_clingo.keeps(units), (settings, units)


@pytest.mark.sampled(12)
@pytest.mark.parametrize("seed", SEEDS)
def test_they_remove_and_require_the_same(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(flat_answers, "_OFTEN", 3)
    for problem, settings in asked(seed):
        rules = assemble(settings, silent).understood
        assert rules is not None
        ours, theirs = known(problem, settings), rules.applied(problem)
        assert (ours.local, ours.spare, ours.rest) == (rules.local, rules.spare, bool(rules.rest)), settings
        found = ours.applied(problem)
        assert isinstance(found, Contradiction) == isinstance(theirs, Contradiction), settings
        if isinstance(found, Restriction):
            assert isinstance(theirs, Restriction)
            every = range(len(problem.network))
            assert [*map(found.removed, every)] == [*map(theirs.removed, every)], settings
            assert set(found.required) == set(theirs.required), settings
        counted = [({*filter(counts, every)}, most) for counts, most in ours.counted(problem)]
        for counts, most in rules.counted(problem):
            assert ({*filter(counts, every)}, most) in counted


@pytest.mark.sampled(24)
@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("objective", [Objective.UNITS, Objective.SUCCESS])
@pytest.mark.parametrize("reductions", [ALL, frozenset({Reduction.FORCED})], ids=["all", "without bounds"])
def test_answers_are_the_same(
    seed: int, objective: Objective, reductions: frozenset[Reduction], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Without bounds, clingo is asked about all constraints where it has to be asked about one."""
    for problem, given in asked(seed):
        settings = given._replace(reductions=reductions)
        posed = replace(
            problem, rates=problem.rates or dict.fromkeys(problem.network.motions, Fraction(1, 2))
        )
        known(posed, settings)
        ours = solve(posed, (objective,), settings)
        with monkeypatch.context() as without:
            without.setattr("foon_asp.asp.solver.ready_made", lambda *_: None)
            theirs = solve(
                posed, (objective,), given if reductions == ALL else given._replace(reductions=NONE)
            )
        assert ours.status is theirs.status, settings
        assert ours.status in {Status.OPTIMAL, Status.INFEASIBLE}
        if ours.costs is not None:
            assert theirs.costs is not None
            assert ours.costs.key(levels((objective,))) == theirs.costs.key(levels((objective,)))


@pytest.mark.parametrize(
    "other", ["only_sources:allowed_source=FOON.txt", "require_ingredient:required_ingredient=salt"]
)
@pytest.mark.parametrize("reductions", ["all", "forced", "none"])
def test_clingo_is_told_what_the_others_look_at(cli: Cli, other: str, reductions: str) -> None:
    words = "--constraint", "before:earlier_motion=cook,later_motion=fry", "--constraint", other
    ran = cli("solve", "--goal", "macaroni", *words, "--reduce", reductions, "--format", "json")
    assert (ran.json["status"], ran.json["costs"]["units"]) == ("optimal", 9)


def test_clingo_is_told_all_that_they_look_at() -> None:
    prices = {"at_most_price"}
    for name in LIBRARY:
        file = encodings_folder() / "constraints" / f"{name}.lp"
        used = {each for each in read_encoding(file).used if each[0] in FACT_PREDICATES}
        assert used <= READ | READ_BY_OURS | ({("price", 2)} if name in prices else set())
        assert used <= ready(name).looked_at | READ_BY_OURS


def ready(name: str, **values: str) -> ReadyMade:
    """Understand a constraint with all of its constants."""
    return known(drawn(0)[0], with_constants(name, **values))


def with_constants(name: str, **values: str) -> Settings:
    encoding = read_encoding(encodings_folder() / "constraints" / f"{name}.lp")
    given = {constant: '"x"' if value == '""' else "3" for constant, value in encoding.constants.items()}
    written = ",".join(f"{constant}={values.get(constant, value)}" for constant, value in given.items())
    return Settings((given_constraint(f"{name}:{written}"),))


@pytest.mark.parametrize("name", LIBRARY)
def test_how_far_they_reach_is_as_clingo_says(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    settings = with_constants(name)

    def reach() -> tuple[object, ...]:
        return reach_of_rules(settings), hold_for_parts(settings), leave_a_rest(settings)

    found = reach()
    monkeypatch.setattr("foon_asp.asp.assembly._known", lambda _: None)
    assert found == reach()


def test_parts_of_stores_are_asked_about_without_clingo(tmp_path: Path) -> None:
    """But not where the rest of the rules does not see all that is taken to be at hand."""
    problem = drawn(5)[0]
    near = near_of(stored(problem, tmp_path).nearby((0,), "strict", first=1))
    assert near is not None
    assert near.open_to(range(near.units))
    prices = problem.unit_prices
    part, relaxed = (replace(each, unit_prices=prices) for each in (near.problem, near.relaxed))
    for name in LIBRARY:
        assert ready_made(part, with_constants(name), silent)
        assert bool(ready_made(relaxed, with_constants(name), silent)) is not ready(name).rest, name


@pytest.mark.parametrize("name", LIBRARY)
def test_all_of_them_are_understood(name: str) -> None:
    (rule,) = ready(name).rules
    assert rule.keys() == {"rule", *LIBRARY[name].values}
    assert rule.get("heats", HEATS) == HEATS


@pytest.mark.parametrize(
    "texts",
    [
        (':- use(U), motion(U,"mix").',),
        ("forbid_motion",),  # a constant that is not set has a warning
        ("at_most_motion:max_uses=3",),
        ("forbid_motion:forbidden_motion=mix", ':- use(U), motion(U,"cut").'),
        ("forbid_motion:forbidden_motion=mix", "forbid_motion:forbidden_motion=cut"),  # of one file
        ("forbid_motion:forbidden_motion=mix,limit=3",),  # which is refused
        ("forbid_motion:forbidden_motion=",),
        (r'forbid_motion:forbidden_motion="a\"b"',),
        ("at_most_units:max_units=many",),
        ("at_most_units:max_units=3000000000",),
        ("at_most_units:max_units=007",),
    ],
)
def test_others_are_left_to_clingo(texts: tuple[str, ...]) -> None:
    problem, _, _ = drawn(0)
    assert ready_made(problem, Settings((*map(given_constraint, texts),)), silent) is None


def test_what_differs_is_left_to_clingo(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    problem, _, _ = drawn(0)
    settings = Settings((given_constraint("at_most_price:max_price=3"),))
    assert ready_made(problem, settings, silent)
    assert ready_made(problem, settings._replace(constants=("max_price=3",)), silent) is None
    assert ready_made(problem, settings._replace(reductions=frozenset()), silent) is None
    assert ready_made(problem, settings._replace(encodings=tmp_path), silent) is None
    assert ready_made(replace(problem, unit_prices=None), settings, silent) is None
    dear = UnitPrices(dict.fromkeys(problem.network.motions, problem.price(0) + 1), {})
    thirds = UnitPrices({motion: price / 3 for motion, price in dear.motions.items()}, {})
    assert ready_made(replace(problem, unit_prices=dear), settings, silent)
    assert ready_made(replace(problem, unit_prices=thirds), settings, silent) is None
    monkeypatch.setattr("foon_asp.rules.ready_made.is_own", lambda file: False)
    assert ready_made(problem, settings, silent) is None


def test_what_they_settle_needs_no_clingo() -> None:
    code = (
        "import sys\n"
        "from foon_asp.cli.main import main\n"
        "try:\n    main(sys.argv[1:])\n"
        "except SystemExit as end:\n    print(end.code, 'clingo' in sys.modules)"
    )
    words = ["solve", "--goal", "ice", "--constraint", "forbid_motion:forbidden_motion=crush"]
    words += ["--constraint", "at_most_units", "-c", "max_units=3"]
    ran = subprocess.run(
        [sys.executable, "-c", code, *words], capture_output=True, text=True, check=True, cwd=ROOT
    )
    assert "optimal by units (strict containers): 3 units, 9 inputs" in ran.stdout
    assert ran.stdout.endswith("0 False\n")
