"""Rules of a user's hold, or are refused with a place: nothing of theirs is dropped without a word.

The worlds of the user's and ours share no name; see ``tests/support/hostile_files.py`` for that at length.
"""

import shutil
from pathlib import Path

import pytest

from foon_asp import why_not
from foon_asp.asp import Settings, solve
from foon_asp.asp.assembly import assemble
from foon_asp.asp.soft import solve_soft
from foon_asp.encoding.encoding_file import included_files
from foon_asp.problem import ContainerRule, Objective, Problem
from foon_asp.resources import bundled_kitchen, encodings_folder
from foon_asp.rules.passed_constraint import given_constraint
from foon_asp.text.data_folder import find_data, read_data
from foon_asp.text.diagnostics import InputError
from foon_asp.text.node_lookup import find_goal
from tests.conftest import Cli

MACARONI = ["solve", "--goal", "macaroni"]
ICE = ["solve", "--goal", "ice"]


@pytest.fixture(scope="module")
def ice() -> Problem:
    data = read_data(find_data(bundled_kitchen()))
    goal = find_goal("ice", data.network, data.goals)
    return Problem(data.network, data.kitchen, (goal,), data.rates, data.utensils, ContainerRule.STRICT)


@pytest.fixture
def own_encodings(tmp_path: Path) -> Path:
    folder = tmp_path / "own"
    folder.mkdir()
    for name in ("task_tree.lp", "objectives.lp", "show.lp"):
        shutil.copy(encodings_folder() / name, folder)
    return folder


def written(folder: Path, text: str | bytes, name: str = "mine.lp") -> Path:
    file = folder / name
    file.write_bytes(text.encode() if isinstance(text, str) else text)
    return file


def refusal(file: Path) -> InputError:
    """Look a constraint over, and give what is said of it."""
    with pytest.raises(InputError) as raised:
        assemble(Settings(constraints=(file,)), lambda _: None)
    return raised.value


# --- Answers that were false.


@pytest.mark.parametrize("k", [0, 20, 40])
def test_a_constant_k_is_the_users(k: int, cli: Cli, tmp_path: Path) -> None:
    """It was the parameter of the part that compares products of rates: 9 units were called the best."""
    mine = written(tmp_path, f"#const k={k}.\n:- #count {{ U : use(U) }} > k.\n")
    for words in (MACARONI, ["solve", "--goal", "whipped cream"]):
        free = cli(*words, "--objective", "success", "--format", "json").json
        ran = cli(*words, "--objective", "success", "--constraint", mine, "--format", "json")
        if k:
            assert (ran.json["status"], ran.json["costs"]) == ("optimal", free["costs"])
        else:
            assert ran.code == 1
    front = cli("pareto", "--goal", "macaroni", "--objective", "units,success", "--constraint", mine)
    assert front.code == (0 if k else 1)


def test_helpers_that_were_named_like_ours(cli: Cli, tmp_path: Path) -> None:
    mine = written(
        tmp_path, "agrees(0,F) :- F = 0..9. seen(0). product(0,0,1). broken(1). way(1). executes(1).\n"
    )
    free = cli(*MACARONI, "--objective", "success", "--format", "json").json
    bound = cli(*MACARONI, "--objective", "success", "--constraint", mine, "--format", "json").json
    assert (bound["status"], bound["costs"]) == ("optimal", free["costs"])


def test_a_helper_broken_of_another_arity_is_not_counted(cli: Cli, tmp_path: Path) -> None:
    soft = written(tmp_path, 'broken(1) :- use(U).\n:- use(U), motion(U,"turn on"), broken(1).\n')
    ran = cli(*MACARONI, "--soft", f"{soft}=3", "--format", "json")
    assert ran.json["penalty"] == 6
    assert [each["broken"] for each in ran.json["soft_constraints"]] == [2]


def test_a_constant_that_is_a_term_of_ours_is_refused(cli: Cli, tmp_path: Path) -> None:
    mine = written(tmp_path, "% mine\n  #const units = inputs.\n")
    ran = cli("alternatives", "--goal", "ice", "--constraint", mine)
    assert ran.code == 2
    assert "mine.lp:2:3: error: found #const units, but that is a name" in ran.err


# --- Names.


@pytest.mark.parametrize(
    "text",
    [
        "_seen(0).",
        "_anything.",
        "-_seen(0).",
        "{ _seen(0) }.",
        "mine ; _seen(0).",
        "1 { _seen(0) : unit(U) } 1.",
        "1 #sum { 1,U : _seen(U) : unit(U) } :- mine. mine.",
        "_seen(0;1).",
        "-_seen(0;1).",
        "#external _seen(0).",
        "#defined _seen/1.",
        ":- _seen(0).",
        ":- use(U), not _executes(U).",
        "mine(_seen).",
        "mine(f(_way(1))).",
        "#const _k = 1.",
        "#program _product(_k).",
        "&_seen { 1 }.",
        "use(1;2).",
        "-use(1).",
        "not use(1).",
        "available(O;O) :- goal(O).",
        "gives(U,O) :- input(U,O).",
    ],
)
def test_names_of_ours_are_refused(text: str, tmp_path: Path) -> None:
    written(tmp_path, f"\n  {text}\n", "inner.lp")
    for file in (tmp_path / "inner.lp", written(tmp_path, '#include "inner.lp".\n')):
        error = refusal(file)
        for diagnostic in error.diagnostics:
            assert Path(diagnostic.source.file).name == "inner.lp"
            assert diagnostic.source.line == 2
            assert diagnostic.excerpt == f"  {text}"


def test_what_a_person_does_may_be_looked_at_and_not_be_defined(tmp_path: Path) -> None:
    assemble(Settings(constraints=(written(tmp_path, ":- use(U), _by_person(U).\n"),)), lambda _: None)
    refusal(written(tmp_path, "_by_person(3).\n"))


def test_predicates_go_by_name_and_arity(cli: Cli, tmp_path: Path) -> None:
    mine = written(tmp_path, "use(1,2). kitchen(1,2). unit. goal(1,1). risk(1). optimize(units).\n")
    assert "optimal by units (strict containers): 2 units" in cli(*ICE, "--constraint", mine).out


@pytest.mark.parametrize("name", ["units", "success", "kitchen", "use", "allowed", "risk", "_way", "gives"])
@pytest.mark.parametrize("soft", [False, True])
def test_constants_do_not_take_a_name_of_ours(name: str, soft: bool, cli: Cli, tmp_path: Path) -> None:
    mine = written(tmp_path, f":- use(9999).\n#const {name} = 3.\n")
    given = ["--soft", f"{mine}=1"] if soft else ["--constraint", mine]
    for more in ([], ["-c", f"{name}=4"]):
        ran = cli(*ICE, *given, *more)
        assert (ran.code, ran.out) == (2, "")
        assert f"mine.lp:2:1: error: found #const {name}" in ran.err


def test_a_copy_of_a_library_constraint_works_with_helpers_of_its_own(cli: Cli, tmp_path: Path) -> None:
    ours = encodings_folder() / "constraints"
    setting = ["-c", "forbidden_motion=crush"]
    copy = shutil.copy(ours / "forbid_motion.lp", tmp_path / "mine.lp")
    same = [cli(*ICE, "--constraint", file, *setting).out for file in ("forbid_motion", copy)]
    assert same[0] == same[1]
    both = cli(*ICE, "--constraint", "forbid_motion", "--constraint", copy, *setting)
    assert both.code == 2
    assert "found #const forbidden_motion" in both.err
    copied = (ours / "forbid_ingredient.lp").read_text()
    refusal(written(tmp_path, copied))
    assemble(Settings(constraints=(written(tmp_path, copied.replace("_tainted", "bad")),)), lambda _: None)


def test_constants_of_a_constraint_do_not_take_names_of_replaced_encodings(
    own_encodings: Path, tmp_path: Path
) -> None:
    with (own_encodings / "task_tree.lp").open("a") as file:
        file.write("helper(word). other :- helper(word).\n")
    for name in ("word", "helper", "other"):
        mine = written(tmp_path, f"#const {name} = 3.\n")
        with pytest.raises(InputError, match=f"found #const {name}"):
            assemble(Settings(constraints=(mine,), encodings=own_encodings), lambda _: None)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("_taken(O) :- kitchen(O).", "found a rule for _taken/1"),
        ("#const units = 3.", "found #const units"),
        ("#program step.\n:- use(3).", "found #program"),
        (":- &diff { 1 } < 3.", "found a theory atom"),
        (":- use(U), motion(U,M), M+1 > 2, goal(G).", "a term has no value here: M+1"),
        ('#include "/etc/passwd".', "found #include"),
    ],
)
def test_replaced_encodings_fail_closed_too(text: str, message: str, cli: Cli, own_encodings: Path) -> None:
    with (own_encodings / "task_tree.lp").open("a") as file:
        file.write(f"{text}\n")
    ran = cli(*ICE, "--encodings", own_encodings)
    assert (ran.code, ran.out) == (2, "")
    assert "own/task_tree.lp:" in ran.err
    assert message in ran.err


@pytest.mark.parametrize(
    "text", ["_executes(U) :- use(U), goal(O), output(U,O), available(O).", "_needed(O) :- goal(O).", "h(1)."]
)
def test_replaced_encodings_may_define_what_those_of_ours_do(
    text: str, cli: Cli, own_encodings: Path
) -> None:
    with (own_encodings / "task_tree.lp").open("a") as file:
        file.write(f"{text}\n")
    (own_encodings / "show.lp").unlink()  # ours is taken
    assert cli(*ICE, "--encodings", own_encodings).code == 0


# --- What clingo would leave this out.

LOST = [
    (":- use(U), motion(U,M), M+1 > 3.", 25),
    (":- use(U), rate(U,N), N/0 > 3.", 23),
    (":- #sum { M,U : use(U), motion(U,M) } > 3.", 11),
    ("mine(1..M) :- motion(U,M), use(U).", 6),
    (":- #count { M+1 : use(U), motion(U,M) } > 1.", 13),
    ("#const n = 1+a.\n:- use(n).", 12),
    (":- #sum+ { M,U : use(U), motion(U,M) } > 3.", 12),
    ("near(U) :- motion(U,M), label(O,L), |M| > 3, use(U).", 37),
    ("#heuristic use(U) : motion(U,M), unit(U). [M,true]", 44),
]


@pytest.mark.parametrize(("text", "column"), LOST)
def test_what_clingo_would_leave_out_is_an_error(
    text: str, column: int, ice: Problem, tmp_path: Path
) -> None:
    mine = written(tmp_path, text + "\n")
    with pytest.raises(InputError) as raised:
        solve(ice, [Objective.SUCCESS], Settings(constraints=(mine,)))
    source = raised.value.diagnostics[0].source
    assert (Path(source.file), source.line, source.column) == (mine, 1, column)
    assert "clingo would leave this out" in raised.value.diagnostics[0].message


@pytest.mark.parametrize("weight", ["N-40", "-1"])
def test_a_weight_below_0_where_none_counts(weight: str, ice: Problem) -> None:
    rule = given_constraint(f":- #sum+ {{ {weight},U : use(U), inputs(U,N) }} > 20.")
    with pytest.raises(InputError) as raised:
        solve(ice, [Objective.UNITS], Settings((rule,)))
    assert "is below 0, which #sum+ counts as nothing" in raised.value.diagnostics[0].message
    assert "not a number" not in str(raised.value)


def test_it_is_one_in_soft_constraints_and_clashes(ice: Problem, tmp_path: Path) -> None:
    mine = written(tmp_path, ":- use(0).\n:- use(U), motion(U,M), M+1 > 3.\n")
    with pytest.raises(InputError) as raised:
        solve_soft(ice, [Objective.UNITS], Settings(), {mine: 2})
    assert raised.value.diagnostics[0].source[:2] == (str(mine), 2)
    with pytest.raises(InputError) as raised:
        why_not(ice, constraints=mine)
    assert raised.value.diagnostics[0].source[:2] == (str(mine), 2)
    assert raised.value.diagnostics[0].excerpt == ":- use(U), motion(U,M), M+1 > 3."


@pytest.mark.parametrize(
    "words",
    [
        ["pareto", "--objective", "units,success"],
        ["alternatives"],
        ["shopping-list"],
        ["solve", "--goal", "macaroni"],
        ["assist"],
        ["sensitivity"],
    ],
    ids=lambda words: words[0],
)
def test_it_is_one_in_every_question(words: list[str], cli: Cli, tmp_path: Path) -> None:
    mine = written(tmp_path, ":- use(U), motion(U,M), M+1 > 3.\n")
    ran = cli(words[0], "--goal", "ice", *words[1:], "--constraint", mine)
    assert (ran.code, ran.out) == (2, "")
    assert "mine.lp:1:" in ran.err
    assert "clingo would leave this out" in ran.err


def test_no_limit_of_messages_hides_one(ice: Problem, tmp_path: Path) -> None:
    """Atoms that nothing defines have a message each, and there are more of them than of a usual limit."""
    many = "".join(f":- nothing{number}(1).\n" for number in range(40))
    mine = written(tmp_path, many + ":- use(U), motion(U,M), M+1 > 3.\n")
    with pytest.raises(InputError, match="clingo would leave this out"):
        solve(ice, [Objective.UNITS], Settings(constraints=(mine,)))


@pytest.mark.parametrize("option", ["--warn=none", "--warn=no-operation-undefined", "--war=none"])
def test_no_option_hides_one(option: str, cli: Cli) -> None:
    ran = cli(*ICE, "--", option)
    assert ran.code == 2
    assert "would change what an answer means" in ran.err


def test_a_sum_that_is_too_large_for_clingo_is_said_to_be(cli: Cli, tmp_path: Path) -> None:
    mine = written(tmp_path, ":- #sum { 2000000000,U : use(U) } > 2100000000.\n")
    ran = cli(*MACARONI, "--constraint", mine)
    assert ran.code == 2
    assert "mine.lp:1:4: error: the sum leaves the whole numbers that clingo has" in ran.err


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (":- &diff { a - b } <= 3, use(1).", "1:5: error: found a theory atom"),
        ("&diff { a - b } <= 3.", "1:2: error: found a theory atom"),
        ("#theory t { s { + : 1, unary }; &d/0 : s, any }.", "1:1: error: found #theory"),
        ("#show use(3) : use(2).", "1:1: error: found #show of a term"),
        ("#show U : unit(U).", "1:1: error: found #show of a term"),
        ("#project use/1.", "1:1: error: found #project"),
        ("#project use(U) : unit(U).", "1:1: error: found #project"),
        ("#edge (1,2) : use(3).", "1:1: error: found #edge"),
        ("#include <incmode>.", "1:1: error: found #include <...>"),
        ("#external mine(1).", "1:1: error: found #external"),
    ],
)
def test_statements_that_are_no_rules_are_refused(text: str, message: str, cli: Cli, tmp_path: Path) -> None:
    ran = cli(*ICE, "--constraint", written(tmp_path, text + "\n"))
    assert (ran.code, ran.out) == (2, "")
    assert f"mine.lp:{message}" in ran.err


@pytest.mark.parametrize("text", ["#show.", "#show mine/1.", "#show use/1.", "#heuristic use(1). [1,true]"])
def test_statements_that_change_no_answer_may_stay(text: str, cli: Cli, tmp_path: Path) -> None:
    ran = cli(*ICE, "--constraint", written(tmp_path, f"mine(1). {text}\n"))
    assert "optimal by units (strict containers): 2 units" in ran.out


# --- Files.


@pytest.mark.parametrize(
    "target", ["/etc/passwd", "../outside.lp", "sub/../../outside.lp", "link.lp", "gone.lp", "text.txt", "-"]
)
def test_files_elsewhere_are_not_included_and_never_quoted(target: str, cli: Cli, tmp_path: Path) -> None:
    folder = tmp_path / "folder"
    (folder / "sub").mkdir(parents=True)
    written(tmp_path, "secret word :-\n", "outside.lp")
    written(folder, "secret word :-\n", "text.txt")
    (folder / "link.lp").symlink_to(tmp_path / "outside.lp")
    ran = cli(*ICE, "--constraint", written(folder, f'p.\n  #include %* x *%\n "{target}".\n'))
    assert (ran.code, ran.out) == (2, "")
    assert f'mine.lp:2:3: error: found #include of "{target}", expected' in ran.err
    assert "secret" not in ran.err
    assert "root:" not in ran.err


def test_files_beside_are_included(cli: Cli, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = tmp_path / "folder"
    (folder / "sub").mkdir(parents=True)
    mine = written(folder, '#include "sub/one.lp". % #include "no.lp".\n%* #include "no.lp". *%\n')
    written(folder / "sub", '#include "two.lp". p("#include \\"no.lp\\".").\n', "one.lp")
    written(folder / "sub", '#include "one.lp". :- use(U), motion(U,"crush").\n', "two.lp")
    narrowed = cli(*ICE, "--constraint", mine)
    assert "3 units" in narrowed.out
    assert [file.name for file in included_files(mine)] == ["mine.lp", "one.lp", "two.lp"]
    assert cli("why-not", "--goal", "ice", "--constraint", mine).code == 0
    monkeypatch.chdir(written(tmp_path, "", "two.lp").parent)  # where clingo looks first
    ran = cli(*ICE, "--constraint", mine)
    assert ran.code == 2
    assert "one.lp:1:1: error: found #include" in ran.err


@pytest.mark.parametrize("option", ["--constraint", "--soft"])
def test_a_file_that_is_no_encoding_is_not_quoted(option: str, cli: Cli, tmp_path: Path) -> None:
    secret = written(tmp_path, "secret word :-\n", "secret.txt")
    ran = cli(*ICE, option, f"{secret}=1" if option == "--soft" else secret)
    assert ran.code == 2
    assert "expected an encoding, a file whose name ends in .lp" in ran.err
    assert "word" not in ran.err


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (":- use(U), motion(U,“fry”).", "1:21: error: found '“' (U+201C), which no rule can have outside"),
        ("\ufeff:- use(3).", "1:1: error: found U+FEFF"),
        ("p.\n:- use(ü).", "2:8: error: found 'ü' (U+00FC)"),
        (":- use(3).\0:- use(4).", "1:11: error: found U+0000"),
        (":- use(3).\u00a0", "1:11: error: found U+00A0"),
    ],
)
def test_letters_that_clingo_does_not_know(text: str, message: str, cli: Cli, tmp_path: Path) -> None:
    """The process ended the process with 1 in clingo, which says that there is no tree."""
    ran = cli(*ICE, "--constraint", written(tmp_path, text))
    assert (ran.code, ran.out) == (2, "")
    assert f"mine.lp:{message}" in ran.err


def test_bytes_that_are_no_letters(cli: Cli, tmp_path: Path) -> None:
    ran = cli(*ICE, "--constraint", written(tmp_path, b"p.\n% \xfcber\n:- use(3).\n"))
    assert ran.code == 2
    assert "mine.lp:2:3: error: found the byte 0xfc, expected text in UTF-8" in ran.err


def test_a_name_that_is_no_text(cli: Cli, tmp_path: Path) -> None:
    ran = cli(*ICE, "--constraint", written(tmp_path, ":- use(3).\n", "\udcff.lp"))
    assert (ran.code, ran.out) == (2, "")
    assert "expected an encoding with a name in UTF-8" in ran.err


def test_any_letters_in_strings_and_comments(cli: Cli, tmp_path: Path) -> None:
    mine = written(tmp_path, '% über “x”\n%* ü %* ö *% ä % ß *%\n *% #! é\n:- use(U), motion(U,"“frÿ”").\n')
    assert cli(*ICE, "--constraint", mine).code == 0


# --- Numbers.


@pytest.mark.parametrize("number", ["2147483647", "4294967296", "99999999999999999999", "0x80000000"])
def test_numbers_that_clingo_has_not(number: str, cli: Cli, tmp_path: Path) -> None:
    """It takes them modulo 2^32: no tree of more than 4294967296 units was no tree with any."""
    ran = cli(*ICE, "--constraint", written(tmp_path, f":- #count {{ U : use(U) }} > {number}.\n"))
    assert (ran.code, ran.out) == (2, "")
    assert f"mine.lp:1:28: error: found the number {number}, expected at most 2147483646" in ran.err
    ran = cli(*ICE, "--constraint", "at_most_units", "-c", f"max_units={number}")
    assert ran.code == 2
    assert "for the constant 'max_units', expected a whole number of 32 bits" in ran.err


@pytest.mark.parametrize("value", ["99999999999", "@f", "1/0", "x,y", "ü", "#sup + 1", "", "f(1)"])
def test_values_of_constants_that_are_words(value: str, cli: Cli, tmp_path: Path) -> None:
    mine = written(tmp_path, "#const n = word.\n:- use(U), p(n). p(a).\n")
    ran = cli(*ICE, "--constraint", mine, "-c", f"n={value}")
    assert ran.code == 2
    assert "for the constant 'n', expected a whole number or a word" in ran.err
    assert cli(*ICE, "--constraint", mine, "-c", "n=b").code == 0
    assert cli(*ICE, "--constraint", mine, "-c", "n=a").code == 1


@pytest.mark.parametrize("setting", ["units=inputs", "_k=1", "=3", "k"])
def test_odd_names_of_constants(setting: str, cli: Cli) -> None:
    ran = cli(*ICE, "--constraint", "at_most_units", "-c", setting)
    assert (ran.code, ran.out) == (2, "")


@pytest.mark.parametrize("limit", ["nan", "inf", "-inf", "-1", "1e999"])
def test_time_limits_that_are_none(limit: str, cli: Cli, tmp_path: Path) -> None:
    ran = cli(*ICE, "--time-limit", limit)
    assert (ran.code, ran.out) == (2, "")
    number = {"nan": "NaN", "inf": "Infinity", "-inf": "-Infinity"}.get(limit, limit)
    questions = written(tmp_path, f'{{"goal": "ice", "time_limit": {number}}}\n', "questions.jsonl")
    ran = cli("batch", questions, "--results", tmp_path / "results.jsonl")
    assert ran.code == 2
    assert "- at `$.time_limit`" in ran.err
