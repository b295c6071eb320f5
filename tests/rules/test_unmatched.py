"""Rules that do nothing say so: names that nothing has, and measures and options without effect."""

import random
import re
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import pytest

import foon_asp
from foon_asp import FoonWarning
from foon_asp.encoding.fact_writer import write_facts
from foon_asp.resources import bundled_kitchen
from foon_asp.rules.constraint_library import library_constraints
from tests.conftest import Cli
from tests.support.random_rules import RandomRules

ICE = ("solve", "--goal", "ice")


def warned(cli: Cli, *words: str | Path) -> list[str]:
    """Ask a question and give the first lines of its warnings."""
    ran = cli(*words)
    assert ran.code in {0, 1}, ran.err
    return [line for line in ran.err.splitlines() if "warning: " in line]


@pytest.mark.parametrize(
    ("rule", "words"),
    [
        (":- use(U), motion(U,crush).", 'motion(U,crush); did you mean motion(U,"crush")?'),
        (':- use(U), motion(U,"crushh").', 'motion(U,"crushh"); did you mean motion(U,"crush")?'),
        (':- use(U), not motion(U,"crushh").', 'motion(U,"crushh"); did you mean motion(U,"crush")?'),
        (':- use(U), motion(U,("fry";"crushh")).', 'motion(U,"crushh"); did you mean motion(U,"crush")?'),
        (':- use(U), motion(U,M), M = "Crush".', 'did you mean motion(U,"crush")?'),
        ('#const m = "crsh". :- use(U), motion(U,m).', 'motion(U,"crsh"); did you mean motion(U,"crush")?'),
        ('bad(crush). :- use(U), motion(U,M), bad(M).', 'did you mean motion(U,"crush")?'),
        (':- #count { U : use(U), motion(U,"pourr") } > 2.', 'did you mean motion(U,"pour")?'),
        (':- not use(U) : motion(U,"pourr").', 'motion(U,"pourr"); did you mean motion(U,"pour")?'),
        ('{ odd(U) : motion(U,"pourr") }. :- odd(U).', 'motion(U,"pourr"); did you mean motion(U,"pour")?'),
        (':- use(U), input(U,O), label(O,"bowll").', 'label(O,"bowll"); did you mean label(O,"bowl")?'),
        (':- use(U), input(U,O), state(O,"choped").', 'state(O,"choped"); did you mean state(O,"chopped")?'),
        (':- use(U), input(U,O), ingredient(O,"buter").', 'did you mean ingredient(O,"butter")?'),
        (':- use(U), input(U,O), located(O,_,"bowll").', 'did you mean located(O,_,"bowl")?'),
        (':- use(U), input(U,O), located(O,"inn","bowl").', 'did you mean located(O,"in","bowl")?'),
        (':- utensil("bwol"), use(U).', 'did you mean utensil("bowl")?'),
        (':- use(U), source(U,"FOOON.txt").', 'did you mean source(U,"FOON.txt")?'),
        (':- use(U), video(U,"abc").', 'nothing in this network matches video(U,"abc")'),
        (':- use(U), input(U,"ice").', 'label(O,"ice") says which it is'),
        (':- kitchen("ice"), use(U).', 'an object node there; label(O,"ice") says which it is'),
        (":- use(crush).", 'U is the number of a unit there; motion(U,"crush") says which it is'),
        (":- use(99999).", "use(99999): no unit has that number"),
        (':- use(U), inputs(U,"3").', 'inputs(U,"3"): a number stands there'),
        ('allergen("buter").', 'the label or ingredient "buter"; did you mean "butter"?'),
    ],
)  # fmt: skip
def test_a_name_that_nothing_has_is_warned_of(cli: Cli, rule: str, words: str) -> None:
    (warning,) = warned(
        cli, *ICE, "--constraint", "forbid_ingredient:forbidden_ingredient=ice", "--rule", rule
    )
    assert warning.startswith("rule 1:1:")
    assert warning.endswith(words)


@pytest.mark.parametrize(
    "rule",
    [
        ':- use(U), motion(U,"fry"), input(U,O), label(O,"onion").',  # no goal can need it
        'hot("fry"). hot("sear"). :- use(U), motion(U,M), hot(M).',  # a list for several networks
        'nut(O) :- label(O,"sugar"). nut(O) :- ingredient(O,"sugar"). :- use(U), input(U,O), nut(O).',
        ':- use(U), input(U,O), label(O,"lemon"). :- use(U), input(U,O), ingredient(O,"lemon").',
        '#const off = "". :- off != "", use(U), motion(U,off).',
        ':- use(U), motion(U,M), M != "sear".',
        'allergen("walnut"). allergen("butter").',
        ":- kitchen(0), goal(1), use(0), rate(U,123), use(U).",
    ],
)
def test_a_rule_that_may_match_is_not(cli: Cli, rule: str) -> None:
    where = ("--constraint", "forbid_ingredient:forbidden_ingredient=ice", "--rule", rule)
    assert [line for line in warned(cli, *ICE, *where) if "nothing in this" in line] == []


def test_parameters_of_ready_made_constraints(cli: Cli) -> None:
    words = 'warning: nothing in this network has the motion "crussh"; did you mean "crush"?'
    use = "forbid_motion:forbidden_motion=crussh"
    both = ("--constraint", "forbid_motion", "-c", "forbidden_motion=crussh")
    more = ("--rule", ":- #count { U : use(U) } > 9.")
    for given in (("--constraint", use), both, ("--constraint", use, *more), (*both, *more)):
        assert warned(cli, *ICE, *given) == [f"{use}: {words}"]
    for constraint in library_constraints():
        for parameter in constraint.parameters:
            if parameter.own_value == '""':
                constants = [
                    f"{each.name}={each.example}" for each in constraint.parameters if each is not parameter
                ]
                asked = f"{constraint.name}:{','.join([f'{parameter.name}=qqqq', *constants])}"
                (line,) = warned(cli, *ICE, "--constraint", asked)
                assert re.fullmatch(rf'{asked}: warning: nothing in this network has the .* "qqqq"', line)


def test_a_list_may_be_in_two_files(cli: Cli, tmp_path: Path) -> None:
    for name, text in (("a.lp", 'hot("sear").'), ("b.lp", 'hot("fry"). :- use(U), motion(U,M), hot(M).')):
        (tmp_path / name).write_text(text)
    assert warned(cli, *ICE, "--constraint", tmp_path / "a.lp", "--constraint", tmp_path / "b.lp") == []


@pytest.mark.parametrize(
    "words",
    [
        ["solve", "--all-goals"],
        ["shopping-list", "--goal", "ice"],
        ["compare", "--goal", "ice"],
        ["alternatives", "--goal", "ice", "--items", "used-up"],
        ["solve", "--goal", "ice", "--certificate", "FILE"],
    ],
)
def test_every_question_says_it_once(cli: Cli, tmp_path: Path, words: Sequence[str]) -> None:
    words = [str(tmp_path / "certificate.json") if word == "FILE" else word for word in words]
    assert len(warned(cli, *words, "--rule", ':- use(U), motion(U,"crushh").')) == 1


def test_python_warns() -> None:
    problem = foon_asp.load().problem("ice")
    with pytest.warns(FoonWarning, match="did you mean motion"):
        foon_asp.solve(problem, constraints=":- use(U), motion(U,crush).")


def test_all_of_a_store_counts(cli: Cli, tmp_path: Path) -> None:
    store = tmp_path / "all.foon"
    assert cli("merge", bundled_kitchen(), "--store", store).code == 0
    for rule, expected in (
        (':- use(U), motion(U,"fry"). :- use(U), input(U,O), state(O,"chopped"), label(O,"omelet").', 0),
        (':- use(U), motion(U,"fryy"). :- use(U), input(U,O), state(O,"choped"), label(O,"omelett").', 3),
    ):
        found = warned(cli, "solve", store, "--goal", "ice; crushed; in [drinking glass]", "--rule", rule)
        assert len([line for line in found if "did you mean" in line]) == expected
        assert len([line for line in found if "nothing in this network" in line]) == expected


def slips(names: random.Random, text: str) -> str:
    """Misspell a name of a rule."""
    places = [match.end() - 1 for match in re.finditer(r'"[^"]+"', text)]
    place = names.choice(places)
    return f"{text[:place]}q{text[place:]}"


def matched(facts: str, name: str, arguments: str) -> bool:
    """Whether a line of facts has an atom with these arguments, where a variable stands for any."""
    parts = [re.escape(each) if each[0] in '"0123456789' else "[^,()]*" for each in arguments.split(",")]
    return re.search(rf"\b{name}\({','.join(parts)}\)", facts) is not None


class Real(NamedTuple):
    """The real universal FOON, and all its facts."""

    foon: foon_asp.Foon
    facts: str


@pytest.fixture(scope="module")
def real(universal: Path) -> Real:
    with warnings.catch_warnings(action="ignore"):
        foon = foon_asp.load(universal)
    problem = foon.problem(foon.goals[0])
    return Real(foon, write_facts(problem, range(len(problem.network))))


@pytest.mark.parametrize(
    "seed", [*range(12), *(pytest.param(s, marks=pytest.mark.slow) for s in range(12, 40))]
)
def test_random_rules_over_the_real_network(real: Real, seed: int) -> None:
    names, foon = random.Random(seed), real.foon
    problem = foon.problem(foon.goals[seed % len(foon.goals)])
    text = RandomRules(seed, problem).of_one_unit()
    for rules in (text, slips(names, text) if '"' in text else text):
        heard = Warnings()
        try:
            foon_asp.solve(problem, constraints=rules, reporter=heard, time_limit=20)
        except foon_asp.UserError:  # a variable is unsafe
            continue
        for line in heard.texts:
            found = re.search(r"nothing in this network matches (\w+)\(([^)]*)\)(?! with)", line)
            assert found is None or not matched(real.facts, *found.groups()), line
        named = re.findall(r'(motion|label|state|ingredient)\(([^()]*"[^()]*)\)', rules)
        assert heard.texts or all(matched(real.facts, *each) for each in named), rules


class Warnings(foon_asp.Reporter):
    """Keeps warnings."""

    def __init__(self) -> None:
        self.texts: list[str] = []

    def warning(self, message: str) -> None:
        self.texts.append(message)


# What else has no effect.


@pytest.mark.parametrize(
    "rule", [":- use(U), motion(U,crush).", ':- use("crush").', ':- use(U), inputs(U,"2").']
)
def test_explained_rules_that_never_hold_remove_nothing(cli: Cli, rule: str) -> None:
    (told,) = cli("constraints", "--rule", rule, "--format", "json").json["rules"]
    assert told["kind"] == "fact"
    assert told["reason"]["text"].endswith("so it has no effect")
    for name in ('"crush"', '"crushh"'):
        shown = cli("constraints", "--rule", f":- use(U), motion(U,{name}).").out
        assert "it removes the units that match it" in shown


@pytest.mark.parametrize(
    "rule", [":~ use(U). [1,U]", "#minimize { 1,U : use(U) }.", "#maximize { 1,U : use(U) }."]
)
def test_minimizing_names_the_two_ways(cli: Cli, tmp_path: Path, rule: str) -> None:
    file = tmp_path / "mine.lp"
    file.write_text(rule)
    for words in (("--rule", rule), ("--constraint", file), ("--soft", f"{file}=2")):
        ran = cli(*ICE, *words)
        assert ran.code == 2
        assert "--soft FILE=WEIGHT" in ran.err
        assert "--measure FILE.lp --objective NAME" in ran.err


def test_a_measure_that_is_no_objective_is_warned_of(cli: Cli, tmp_path: Path) -> None:
    file = tmp_path / "effort.lp"
    file.write_text(
        'cost(effort,U,5) :- unit(U), motion(U,"pour").\ncost(care,U,1) :- unit(U), motion(U,"pour").\n'
    )
    warning = (
        f"{file}: warning: no objective is its measure, so it has no effect; "
        "add --objective effort or --objective care"
    )
    assert warned(cli, *ICE, "--measure", file) == [warning]
    assert warned(cli, *ICE, "--measure", file, "--objective", "units,care") == []
    assert warned(cli, "pareto", "--goal", "ice", "--measure", file, "--objective", "units,effort") == []
    file.write_text('cost(effort,U,5) :- unit(U), motion(U,"pourr").\n')
    (slip,) = warned(cli, *ICE, "--measure", file, "--objective", "effort")
    assert slip.endswith('did you mean motion(U,"pour")?')


@pytest.mark.parametrize(
    "more",
    [["--rule", ':- use(U), motion(U,"crush").'], ["--items", "used-up", "--objective", "kitchen"]],
)
def test_statistics_of_clingo(cli: Cli, more: list[str]) -> None:
    ran = cli(*ICE, "--reduce", "none", *more, "--", "--stats")
    assert ran.code == 0
    assert "solving.solvers.choices = " in ran.err
    settled = cli(*ICE, "--", "--stats")
    assert "clingo has no statistics: the question was settled without its search" in settled.err
    assert "statistics" not in cli(*ICE, "--reduce", "none").err


def test_plans_that_need_no_clingo_have_no_statistics(cli: Cli) -> None:
    ran = cli(*ICE, "--items", "used-up", "--", "--stats")
    assert ran.code == 0
    assert "clingo has no statistics: the plan and its order" in ran.err
