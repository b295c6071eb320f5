"""Rules given as text, and ready-made constraints used several times with constants of their own."""

import json
import shlex
import subprocess
import sys
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest

import foon_asp
from foon_asp.asp import Settings
from foon_asp.asp.integrity import relax
from foon_asp.asp.postconditions import Postconditions
from foon_asp.certificate import coverage
from foon_asp.encoding.stated import Stated
from foon_asp.errors import BugError, UserError
from foon_asp.problem import ContainerRule, Objective
from foon_asp.resources import encodings_folder
from foon_asp.rules.passed_constraint import LibraryUse, RuleText, given_constraint, named_constraint
from foon_asp.rules.stating import load_constraints
from tests.conftest import ROOT, Cli
from tests.support.handmade_certificate import forbid
from tests.support.random_problems import random_problem

LIBRARY = encodings_folder() / "constraints"
CRUSH = ':- use(U), motion(U,"crush").'
POUND = ':- use(U), motion(U,"pound").'


def solved(cli: Cli, *words: str | Path) -> dict[str, Any]:
    """Ask for ice, and give the answer but for the time it took."""
    ran = cli("solve", "--goal", "ice", *words, "--format", "json")
    assert "error" not in ran.err
    assert "warning" not in ran.err
    return {key: value for key, value in ran.json.items() if key != "seconds"}


# --- Rules.


@pytest.mark.parametrize(
    "text",
    [
        CRUSH,
        f"% said\n{CRUSH[:11]}\n  {CRUSH[11:]}  % why\n",
        f"%* over\n lines *% {CRUSH}",
        'used(M) :- use(U), motion(U,M). bad("crush"). :- used(M), bad(M).',
        '#const which = "crush". :- use(U), motion(U,which).',
    ],
)
def test_a_rule_is_what_a_file_with_it_is(text: str, cli: Cli, tmp_path: Path) -> None:
    file = tmp_path / "mine.lp"
    file.write_bytes(text.encode())
    stated = solved(cli, "--rule", text)
    assert stated == solved(cli, "--constraint", file)
    assert stated["status"] == "optimal"
    assert "crush" not in {unit["motion"] for unit in stated["units"]}


def test_a_constant_of_a_rule_can_be_set(cli: Cli) -> None:
    rule = '#const which = "twist". :- use(U), motion(U,which).'
    assert solved(cli, "--rule", rule)["status"] == "infeasible"
    assert solved(cli, "--rule", rule, "-c", "which=crush") == solved(cli, "--rule", CRUSH)


def test_rules_hold_together_and_with_files(cli: Cli, tmp_path: Path) -> None:
    (tmp_path / "mine.lp").write_text(POUND)
    assert solved(cli, "--rule", CRUSH, "--rule", POUND)["status"] == "infeasible"
    assert solved(cli, "--rule", CRUSH, "--constraint", tmp_path / "mine.lp")["status"] == "infeasible"
    assert solved(cli, "--rule", f"{CRUSH} {POUND}")["status"] == "infeasible"
    # what one defines, the other sees
    assert solved(cli, "--rule", ':- used("crush").', "--rule", "used(M) :- use(U), motion(U,M).") == solved(
        cli, "--rule", CRUSH
    )


def test_a_rule_given_twice_holds_once(cli: Cli) -> None:
    assert solved(cli, "--rule", CRUSH, "--rule", CRUSH) == solved(cli, "--rule", CRUSH)
    found = cli("why-not", "--goal", "ice", "--rule", CRUSH, "--rule", CRUSH, "--format", "json").json[
        "clash"
    ]
    assert [(each["file"], each["text"]) for each in found["constraints"]] == [("rule 1", CRUSH)]


@pytest.mark.parametrize(
    ("rule", "message"),
    [
        ("", "rule 1: found '', expected a rule such as"),
        ("  \n", "rule 1: found '  \\n', expected a rule such as"),
        ("% all of it a comment", "rule 1: found '% all of it a comment', expected a rule such as"),
        (CRUSH[:-1], "rule 1:1:29: error: syntax error, unexpected EOF; a rule ends in a full stop"),
        (':- use(U), motion(U,"crush).', 'rule 1:1:21: error: lexer error, unexpected "'),
        ("a. %* open", "rule 1:1:11: error: lexer error, unexpected <EOF>"),
        (":- use(U),\n  motion(U,“crush”).", "rule 1:2:12: error: found '“' (U+201C)"),
        (":- use(U), U > 4294967297.", "rule 1:1:16: error: found the number 4294967297, expected at most"),
        (":- use(U), not motion(U,M).", "rule 1:1:25: error: the variable 'M' is unsafe"),
        (":- use(U),\n motion(U,M), M+1 > 3.", "rule 1:2:15: error: a term has no value here: M+1"),
        ("\n\navailable(1).", "rule 1:3:1: error: found a rule for available/1"),
        (":- use(U), _tainted(U).", "rule 1:1:12: error: found _tainted/1, but names that begin with '_'"),
        (
            "#const use = 3. :- use(1).",
            "rule 1:1:1: error: found #const use, but that is a name in the facts",
        ),
        ('#include "other.lp".', "rule 1:1:1: error: found #include, expected rules: only a file includes"),
        ("#include <incmode>.", "rule 1:1:1: error: found #include, expected rules: only a file includes"),
        ("#script (python) import os #end.", "rule 1:1:1: error: found #script, expected rules"),
        ("#program more. :- use(1).", "rule 1:1:1: error: found #program, expected rules"),
        ("#minimize { 1,U : use(U) }.", "rule 1:1:13: error: found a statement that minimizes"),
        (":- use(U).\udcff", "rule 1: expected a rule in UTF-8"),
        (":- use(1). % \0\n:- use(2).", "rule 1:1:14: error: found U+0000"),
        ("mine.lp", "rule 1:1:8: error: syntax error, unexpected EOF"),
    ],
)
def test_faults_have_their_place_in_the_rule(rule: str, message: str, cli: Cli) -> None:
    ran = cli("solve", "--goal", "ice", "--rule", rule)
    assert (ran.code, ran.out) == (2, "")
    assert message in ran.err
    assert "<string>" not in ran.err
    assert "/" not in ran.err.replace("available/1", "").replace("_tainted/1", "")


def test_faults_of_the_second_rule_are_its_own(cli: Cli) -> None:
    ran = cli("solve", "--goal", "ice", "--rule", CRUSH, "--rule", ":- use(U), motoin(U,1).")
    assert ran.err.startswith("rule 2:1:12: warning: no rule or fact defines motoin/2")
    assert "    :- use(U), motoin(U,1).\n               ^\n" in ran.err
    ran = cli("solve", "--goal", "ice", "--rule", "#const n = 1. p(n).", "--rule", "#const n = 2. q(n).")
    assert ran.code == 2
    assert ran.err.startswith("rule 2:1:1: error: redefinition of constant")
    ran = cli("solve", "--goal", "ice", "--rule", CRUSH, "--soft", ":- use(U), U+a > 1.=3")
    assert ran.err.startswith("rule 2:1:12: error: a term has no value here: U+a")


@pytest.mark.parametrize("fault", ["odd(M) :- not motion(1,M).", "odd(O+L) :- goal(O), label(O,L)."])
def test_faults_are_said_though_other_rules_leave_no_tree(fault: str, cli: Cli) -> None:
    ran = cli("solve", "--goal", "ice", "--rule", ":- use(U).", "--rule", fault)
    assert (ran.code, ran.out) == (2, "")
    assert ran.err.startswith("rule 2:1:")
    assert cli("solve", "--goal", "ice", "--rule", ":- use(U).").code == 1


def test_a_rule_where_a_file_is_meant_is_told_from_it(cli: Cli) -> None:
    ran = cli("solve", "--goal", "ice", "--constraint", CRUSH)
    assert ran.code == 2
    assert "no such file" in ran.err
    assert "a rule is given with --rule" in ran.err


def test_a_rule_may_be_soft(cli: Cli) -> None:
    ran = cli("solve", "--goal", "ice", "--soft", f"{CRUSH}=3", "--rule", POUND, "--format", "json").json
    assert ran["penalty"] == 3
    assert [(each["file"], each["text"]) for each in ran["soft_constraints"]] == [("rule 2", CRUSH)]
    both = cli("solve", "--goal", "ice", "--soft", f"{CRUSH}=3", "--rule", CRUSH)
    assert both.code == 2
    assert "is named as a constraint and as a soft one" in both.err


def test_a_rule_of_several_lines_clashes_in_one(cli: Cli) -> None:
    rule = ':- use(U),\n   motion(U,"twist").'
    ran = cli("why-not", "--goal", "ice", "--rule", f"{POUND}\n{rule}")
    assert '  rule 1:2\n      :- use(U), motion(U,"twist").\n' in ran.out


# --- In Python.


def test_texts_are_rules_paths_or_names(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    for name in ("mine.lp", "ends in a dot.", "forbid_motion:forbidden_motion=fry", "a:-b"):
        Path(name).write_text(CRUSH)
        assert given_constraint(name) == Path(name)
    assert given_constraint(CRUSH) == RuleText(CRUSH)
    assert given_constraint('allergen("nut"). ') == RuleText('allergen("nut"). ')
    assert given_constraint(Path(CRUSH)) == Path(CRUSH)
    assert given_constraint("forbid_motion") == Path("forbid_motion")
    assert given_constraint("nowhere.lp") == Path("nowhere.lp")
    used = given_constraint("forbid_motion:forbidden_motion=:-.")
    assert used == LibraryUse(LIBRARY / "forbid_motion.lp", "forbid_motion:forbidden_motion=:-.")
    assert given_constraint(":- " + "x" * 5000) == RuleText(":- " + "x" * 5000)
    assert given_constraint(":- \0.") == RuleText(":- \0.")


def test_python_takes_rules_as_the_command_does(cli: Cli) -> None:
    ice = foon_asp.load().problem("ice")
    by_command = solved(cli, "--rule", CRUSH)
    for given in (CRUSH, [CRUSH], [CRUSH, CRUSH], ["forbid_motion:forbidden_motion=crush"]):
        answer = foon_asp.solve(ice, constraints=given).json()
        assert answer["units"] == by_command["units"]
        assert answer["status"] == "optimal"
    soft = foon_asp.solve(ice, soft={CRUSH: 2, "forbid_motion:forbidden_motion=pound": 3})
    assert soft.penalty == 2
    with pytest.raises(UserError, match=r"^rule 2:1:12: error: a term has no value"):
        foon_asp.solve(ice, constraints=[CRUSH, ":- use(U), U/0 > 1."])
    with pytest.raises(UserError, match="no such file"):
        foon_asp.solve(ice, constraints=[Path(CRUSH)])


# --- Ready-made constraints with constants of their own.


@pytest.mark.parametrize(
    ("written", "constants"),
    [
        ("forbid_motion:forbidden_motion=fry", {"forbidden_motion": "fry"}),
        ("forbid_motion.lp:forbidden_motion=fry", {"forbidden_motion": "fry"}),
        ("before:earlier_motion=a b,later_motion=c=d", {"earlier_motion": "a b", "later_motion": "c=d"}),
        ("only_sources:allowed_source=https://x/y//z", {"allowed_source": "https://x/y//z"}),
        ('before:earlier_motion="a, b",later_motion=c', {"earlier_motion": '"a, b"', "later_motion": "c"}),
        ('forbid_motion:forbidden_motion="say \\"a,\\""', {"forbidden_motion": '"say \\"a,\\""'}),
        ("forbid_motion:forbidden_motion=", {"forbidden_motion": ""}),
    ],
)
def test_constants_are_read_as_written(written: str, constants: dict[str, str]) -> None:
    use = named_constraint(written)
    assert isinstance(use, LibraryUse)
    assert (use.written, use.constants) == (written, constants)


@pytest.mark.parametrize(
    ("written", "message"),
    [
        ("forbid_motion:", "found '' in 'forbid_motion:', expected forbid_motion:CONSTANT=VALUE"),
        ("forbid_motion:fry", "found 'fry' in 'forbid_motion:fry', expected forbid_motion:CONSTANT=VALUE"),
        ("forbid_motion:forbidden_motion=a,b", "found 'b' in 'forbid_motion:forbidden_motion=a,b', expected"),
        ("forbid_motion:forbidden_motion=a,", "found '' in 'forbid_motion:forbidden_motion=a,', expected"),
        ('forbid_motion:forbidden_motion="a"b', 'found b after "a" in '),
        ('forbid_motion:forbidden_motion="a', 'found "a for a constant, expected a text in quotes'),
        ("forbid_motion:forbidden_motion=a,forbidden_motion=b", "found two values of forbidden_motion in"),
        ("forbid_motion:forbiden=a", "forbid_motion has no constant 'forbiden'; it has forbidden_motion"),
        ("at_most_units:max_units=few", "found 'few' for the constant 'max_units', expected a whole number"),
        ("at_most_units:max_units=4294967296", "found '4294967296' for the constant 'max_units', expected"),
        ("forbid_move:x=1", "forbid_move:x=1: no such file; expected an encoding (.lp) or a ready-made one"),
        ("mine.lp:most=2", "mine.lp:most=2: constants can follow the name of a ready-made constraint only"),
    ],
)
def test_what_is_no_use_is_refused(
    written: str, message: str, cli: Cli, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("mine.lp").write_text("#const most = 3.\n:- use(most).\n")
    ran = cli("solve", "--goal", "ice", "--constraint", written)
    assert (ran.code, ran.out) == (2, "")
    assert message in ran.err


def test_each_use_has_constants_of_its_own(cli: Cli) -> None:
    crush, pound = (f"forbid_motion:forbidden_motion={motion}" for motion in ("crush", "pound"))
    plain = ("--constraint", "forbid_motion", "-c", "forbidden_motion=pound")
    assert solved(cli, "--constraint", crush) == solved(cli, "--rule", CRUSH)
    assert solved(cli, "--constraint", crush, "--constraint", pound)["status"] == "infeasible"
    assert solved(cli, "--constraint", crush, *plain)["status"] == "infeasible"
    assert solved(cli, *plain) != solved(cli, "--constraint", crush)
    assert solved(cli, "--constraint", crush, "--constraint", crush) == solved(cli, "--constraint", crush)
    # -c is for what has no constants of its own
    ran = cli("solve", "--goal", "ice", "--constraint", crush, "-c", "forbidden_motion=pound")
    assert ran.code == 2
    assert f"the constant 'forbidden_motion', but {crush} has values of its own: set it there" in ran.err
    one = ("--constraint", "before:earlier_motion=rinse", "-c", "later_motion=chop")
    assert "but before:earlier_motion=rinse has values of its own" in cli("solve", "--goal", "ice", *one).err
    assert "no encoding in use has the constant 'x'" in (
        cli("solve", "--goal", "ice", "--constraint", crush, "-c", "x=1").err
    )


def test_an_existing_path_of_that_name_wins(
    cli: Cli, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    name = "forbid_motion:forbidden_motion=a.lp"
    Path(name).write_text(CRUSH)
    assert solved(cli, "--constraint", name) == solved(cli, "--rule", CRUSH)


def test_a_constant_that_is_not_set_is_named_with_its_use(cli: Cli) -> None:
    written = "at_most_motion:limited_motion=crush"
    ran = cli("solve", "--goal", "ice", "--constraint", written)
    assert f"at_most_motion.lp ({written}): warning: the constant max_uses is not set" in ran.err
    assert f"set it with {written},max_uses=VALUE" in ran.err
    assert cli("solve", "--goal", "ice", "--constraint", f"{written},max_uses=0").err == ""


def test_extension_points_are_shared(cli: Cli) -> None:
    text = cli(
        *("facts", "--goal", "tea", "--rule", 'allergen("x").'),
        *("--constraint", "forbid_ingredient:forbidden_ingredient=egg"),
        *("--constraint", "forbid_ingredient:forbidden_ingredient=tea bag"),
    ).out
    for number, value in ((1, "egg"), (2, "tea bag")):
        assert f'#const _forbidden_ingredient_{number} = "{value}".' in text
        assert f"#false :- use(U); input(U,O); _tainted_{number}(O)." in text
        assert f"_tainted_{number}(O) :- allergen(L); label(O,L)." in text
    assert text.endswith('allergen("x").\n')


def test_texts_that_look_like_names_are_left_alone(cli: Cli) -> None:
    use = LibraryUse(LIBRARY / "forbid_motion.lp", "forbid_motion:forbidden_motion=forbidden_motion")
    rules = load_constraints([use])[use]
    assert isinstance(rules, Stated)
    assert '#const _forbidden_motion_1 = "forbidden_motion".' in rules.text


# --- What else takes constraints.


def test_bare_clingo_finds_the_same_from_the_printed_facts(cli: Cli, tmp_path: Path) -> None:
    words = [
        *("--rule", ':- use(U), motion(U,"crush"),\n   risk(U,W), W < 0. % c'),
        *("--constraint", "before:earlier_motion=slice,later_motion=pound"),
        *("--constraint", "at_most_motion:limited_motion=crush,max_uses=0"),
    ]
    (tmp_path / "facts.lp").write_text(cli("facts", "--goal", "ice", *words).out)
    files = [f"encodings/{name}.lp" for name in ("task_tree", "objectives", "show")]
    ran = subprocess.run(
        [sys.executable, "-m", "clingo", *files, str(tmp_path / "facts.lp"), "--outf=2"],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
    )
    found = json.loads(ran.stdout)
    assert ran.stderr == ""
    answer = solved(cli, *words)
    if answer["status"] == "infeasible":
        assert found["Result"] == "UNSATISFIABLE"
    else:
        assert found["Models"]["Costs"] == [answer["costs"]["units"]]


def test_a_bug_report_can_be_pasted() -> None:
    """What was asked is said with rules as rules, whether they are rewritten or not."""
    problem = random_problem(0, ContainerRule.STRICT)
    use = given_constraint("forbid_motion:forbidden_motion=fry")
    _, relaxed = relax([RuleText(POUND), use], (), soft=True, before=[RuleText(CRUSH)])
    settings = Settings((RuleText(CRUSH), use), relaxed=relaxed)
    checks = Postconditions(problem, (Objective.UNITS,), settings, own=False)
    with pytest.raises(BugError) as bug:
        checks.require(False, lambda: "wrong")
    words = shlex.split(next(line for line in str(bug.value).split("\n") if "foon-asp facts" in line))
    given = [(flag, word) for flag, word in pairwise(words) if flag in {"--rule", "--constraint"}]
    assert given == [("--rule", CRUSH), ("--constraint", str(use)), ("--rule", POUND)]
    assert "Stated(" not in str(bug.value)
    checks = Postconditions(problem, (Objective.UNITS,), Settings(encodings=Path("by_need")), own=False)
    with pytest.raises(BugError, match="--encodings by_need"):
        checks.require(False, lambda: "wrong")


def test_certificates_name_rules_by_their_text() -> None:
    uses = [f"forbid_motion:forbidden_motion={motion}" for motion in ("fry", '"a, b"')]
    given = tuple(map(given_constraint, [*uses, CRUSH, "at_most_units:max_units=3"]))
    covered = coverage(Settings(given))
    assert list(covered.rules) == [*forbid(["a, b", "fry"]), {"rule": "at_most_units", "max_units": 3}]
    (named,) = covered.not_covered
    assert named.startswith("rule ")
    assert named.endswith(CRUSH)
    assert (
        coverage(Settings((RuleText(POUND),))).not_covered
        != coverage(Settings((RuleText(CRUSH),))).not_covered
    )
