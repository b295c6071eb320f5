"""Encodings of the user's: constraints, replacements, and what is said of their faults."""

import shutil
from pathlib import Path

import pytest

from foon_asp.encoding import encoding as encoding_rules
from foon_asp.encoding.stated import Stated
from foon_asp.resources import encodings_folder
from tests.conftest import Cli


def encoding(tmp_path: Path, text: str, name: str = "mine.lp") -> Path:
    file = tmp_path / name
    file.write_text(text)
    return file


def test_our_constraints_go_by_name_and_take_constants(cli: Cli) -> None:
    free = cli("solve", "--goal", "ice", "--format", "json").json
    motion = free["units"][-1]["motion"]
    banned = ["--constraint", "forbid_motion", "-c", f"forbidden_motion={motion}"]
    limited = cli("solve", "--goal", "ice", *banned, "--format", "json").json
    assert motion not in {unit["motion"] for unit in limited["units"]}
    units = free["costs"]["units"]
    few = cli("solve", "--goal", "ice", "--constraint", "at_most_units", "-c", f"max_units={units - 1}")
    assert few.code == 1
    assert "without the constraints there is one" in few.out
    for written in (f"0{units}", f"00{units}"):
        assert cli("solve", "--goal", "ice", "--constraint", f"at_most_units:max_units={written}").code == 0
    unset = cli("solve", "--goal", "ice", "--constraint", "forbid_motion")
    assert unset.code == 0
    assert "the constant forbidden_motion is not set and the constraint has no effect" in unset.err


@pytest.mark.parametrize(
    ("use", "set_"),
    [
        ("forbid_motion:forbidden_motion=", "forbid_motion:forbidden_motion=VALUE"),
        ("before:earlier_motion=,later_motion=x", "before:earlier_motion=VALUE,later_motion=x"),
        ("before:earlier_motion=rinse", "before:earlier_motion=rinse,later_motion=VALUE"),
    ],
)
def test_how_to_set_a_value_of_a_use(cli: Cli, use: str, set_: str) -> None:
    ran = cli("solve", "--goal", "ice", "--constraint", use)
    assert ran.err.splitlines()[0].endswith(f"; set it with {set_}")


@pytest.mark.parametrize(
    ("rule", "constraint", "unset"),
    [
        ('allergen("salt").', "forbid_ingredient", False),
        ('allowed("salad.txt").', "only_sources", False),
        (":- use(U), allergen(U).", "forbid_ingredient", True),
        ('heats("flambe").', "never_heated", True),  # what is not to be heated is still not said
    ],
)
def test_a_constant_need_not_be_set_where_rules_say_the_same_in_another_way(
    cli: Cli, rule: str, constraint: str, unset: bool
) -> None:
    ran = cli("solve", "--goal", "ice", "--rule", rule, "--constraint", constraint)
    assert ("is not set and the constraint has no effect" in ran.err) is unset


def test_a_constraint_may_ask_for_what_the_goal_does_not_need(cli: Cli) -> None:
    words = ["solve", "--goal", "ice", "--constraint", "require_motion", "-c", "required_motion=preheat"]
    ran = cli(*words, "--format", "json")
    assert ran.code == 0
    assert ran.json["status"] == "optimal"
    assert [unit["motion"] for unit in ran.json["units"]].count("preheat") == 1


@pytest.mark.parametrize(
    ("text", "message", "line"),
    [
        (':- use(U), motion(U,"a")\n:- use(U).\n', "mine.lp:2:1: error: syntax error", ":- use(U)."),
        (":- use(U), X < 3.\n", "mine.lp:1:12: error: the variable 'X' is unsafe", ":- use(U), X < 3."),
        ("#script (python)\n#end.\n", "mine.lp:1:1: error: found #script", "#script (python)"),
        ("#minimize { 1,U : use(U) }.\n", "mine.lp:1:13: error: found a statement that minimizes", "#min"),
        (":~ use(U). [1,U]\n", "mine.lp:1:1: error: found a statement that minimizes", ":~ use(U)"),
        ("#program step.\n:- use(U).\n", "mine.lp:1:1: error: found #program", "#program step."),
        ("available(O) :- goal(O).\n", "mine.lp:1:1: error: found a rule for available/1", "available(O)"),
        (
            "risk(U,9) :- unit(U).\n",
            "mine.lp:1:1: error: found a rule for risk/2, which a constraint may not",
            "risk(U,9)",
        ),
        ("{ use(U) : unit(U) }.\n", "mine.lp:1:3: error: found a rule for use/1", "{ use(U)"),
        ("_wanted(0).\n", "mine.lp:1:1: error: found ", "_wanted(0)"),
    ],
)
def test_faults_are_reported_in_place(cli: Cli, tmp_path: Path, text: str, message: str, line: str) -> None:
    ran = cli("solve", "--goal", "ice", "--constraint", encoding(tmp_path, text))
    assert ran.code == 2
    assert message in ran.err
    assert line in ran.err
    assert ran.out == ""


def test_scripts_are_refused_behind_an_include(cli: Cli, tmp_path: Path) -> None:
    encoding(tmp_path, "#script (python)\n#end.\n", "hidden.lp")
    ran = cli("solve", "--goal", "ice", "--constraint", encoding(tmp_path, '#include "hidden.lp".\n'))
    assert ran.code == 2
    assert "hidden.lp:1:1: error: found #script" in ran.err


def test_a_rule_without_a_full_stop_lacks_it_at_its_end(cli: Cli) -> None:
    ran = cli("solve", "--goal", "ice", "--rule", ":- use(U)")
    assert ran.code == 2
    assert "rule 1:1:10: error: " in ran.err
    assert "; a rule ends in a full stop" in ran.err


NAME, TEXT = (
    "found k, which is above every number; set it, as in #const k = 3.",
    'found the text "3", which is',
)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (":- #count { U : use(U) } > k.", NAME),
        (":- k < #sum { N,U : use(U), inputs(U,N) }.", NAME),
        (":- 2 { use(U) } k.", NAME),
        (":- use(U), inputs(U,N), 1 < N < k.", NAME),
        (':- #count { U : use(U) } > "3".', TEXT),
        ("#const k = 2. :- #count { U : use(U) } > k.", ""),
        (":- use(U), motion(U,M), M = k, M != k.", ""),
        (':- use(U), motion(U,M), M > "pour".', ""),
        (':- #max { M : use(U), motion(U,M) } > "pour".', ""),
        (":- #count { U : use(U) } > #sup.", ""),
    ],
)
def test_what_numbers_are_compared_with_is_one(text: str, said: str) -> None:
    rules = encoding_rules.read_encoding(Stated("rule 1", text))
    warnings = list(map(str, encoding_rules.check_encodings([rules], [])))
    assert [said in each for each in warnings] == ([True] if said else [])


@pytest.mark.parametrize(
    ("text", "advice"),
    [
        (':- use(U), motionn(U,"fry").\n', "no rule or fact defines motionn/2"),
        (':- use(U), motionn(U,"fry").\n', "did you mean motion/2?"),
        (":- use(U), motion(U).\n", "did you mean motion/2?"),
        (':- use(U), locate(U,"in","pan").\n', "did you mean located/3?"),
        (":- zzz.\n", "the predicates are listed in encodings/README.md"),
    ],
)
def test_undefined_atoms_are_warned_of(cli: Cli, tmp_path: Path, text: str, advice: str) -> None:
    ran = cli("solve", "--goal", "ice", "--constraint", encoding(tmp_path, text))
    assert ran.code == 0
    assert "mine.lp:1:" in ran.err
    assert advice in ran.err


def test_defined_atoms_are_not(cli: Cli, tmp_path: Path) -> None:
    text = """\
#defined maybe/1.
risky(U) :- use(U), rate(U,R), R < 100000.
:- #count { U : risky(U) } > 3.
:- maybe(X), use(X).
:- use(U), output(U,O), ingredient(O,"milk"), located(O,"in","bowl"), utensil("bowl"), not kitchen(O).
"""
    ran = cli("solve", "--goal", "ice", "--constraint", encoding(tmp_path, text))
    assert ran.code == 0
    assert ran.err == ""


@pytest.fixture
def own_encodings(tmp_path: Path) -> Path:
    folder = tmp_path / "own"
    folder.mkdir()
    for name in ("task_tree.lp", "objectives.lp", "show.lp"):
        shutil.copy(encodings_folder() / name, folder)
    return folder


def test_replaced_encodings_run(cli: Cli, own_encodings: Path) -> None:
    same = cli("solve", "--goal", "macaroni", "--encodings", own_encodings, "--format", "json").json
    assert same["costs"]["units"] == 9
    assert same["encodings"] == str(own_encodings)
    with (own_encodings / "task_tree.lp").open("a") as file:
        file.write(':- use(U), motion(U,"simmer").\n')
    assert cli("solve", "--goal", "macaroni", "--encodings", own_encodings).code == 1


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("use(9999).\n", "the encodings made use(9999), but the network has no unit of that number"),
        ("use(a).\n", "the encodings made use(a), expected use(U) with the number of a unit"),
        ("available(O) :- goal(O).\n", "the tree found does not execute"),
    ],
)
def test_a_tree_that_does_not_execute_is_never_printed(
    cli: Cli, own_encodings: Path, text: str, message: str
) -> None:
    with (own_encodings / "task_tree.lp").open("a") as file:
        file.write(text)
    ran = cli("solve", "--goal", "ice", "--encodings", own_encodings)
    assert ran.code == 2
    assert message in ran.err
    assert ran.out == ""


def test_another_measure_is_said_to_be_one(cli: Cli, own_encodings: Path) -> None:
    text = (own_encodings / "objectives.lp").read_text()
    (own_encodings / "objectives.lp").write_text(text.replace("{ 1@P,U ", "{ 7@P,U ", 1))
    ran = cli("solve", "--goal", "macaroni", "--encodings", own_encodings)
    assert ran.code == 0
    assert "does not measure what the objectives units measure here" in ran.err


def test_a_folder_without_encodings_is_refused(cli: Cli, tmp_path: Path) -> None:
    ran = cli("solve", "--goal", "ice", "--encodings", tmp_path)
    assert ran.code == 2
    assert "expected a folder with encodings to use instead of the built-in ones: task_tree.lp" in ran.err


@pytest.mark.parametrize("verb", ["solve", "pareto"])
def test_that_there_is_no_tree_is_said_of_the_encodings_that_were_asked(verb: str, cli: Cli) -> None:
    """By need, no tree has a unit that no goal needs, and the rule asks for one."""
    ran = cli(verb, "--goal", "ice", "--rule", ':- not use(U) : motion(U,"bake").', "--encodings", "by_need")
    assert ran.code == 1
    assert "infeasible: proved that no task tree exists (strict containers, as by_need has it)" in ran.out
