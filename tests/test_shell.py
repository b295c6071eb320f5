"""Sessions: lines from files, from a pipe and from a terminal, and what a word can be completed to."""

import fcntl
import io
import json
import os
import pty
import re
import select
import shutil
import subprocess
import sys
import termios
import time
from pathlib import Path

import pytest

from foon_asp.cli.options import read_dataset
from foon_asp.cli.shell_completion import candidates
from foon_asp.cli.shell_line import Word, quoted, take_apart
from foon_asp.cli.shell_prompt import history_file
from foon_asp.cli.shell_session import QUESTIONS, WORDS, ShellSession
from foon_asp.errors import UserError
from foon_asp.text.writer import write_units
from tests.conftest import ROOT, Cli, Ran
from tests.hard_problem import hard_problem

pytestmark = pytest.mark.sampled(3)  # by default some cases of each test: there are many


@pytest.fixture
def shell(cli: Cli, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Cli:
    """Run the lines of a script named ``lines.txt``, in a folder of its own; words are for the verb."""
    monkeypatch.chdir(tmp_path)

    def run(*lines: str | Path, words: tuple[str | Path, ...] = ()) -> Ran:
        Path("lines.txt").write_text("".join(f"{line}\n" for line in lines), encoding="utf-8")
        return cli("shell", "lines.txt", *words)

    return run


# --- Lines.


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", []),
        ("  # nothing", []),
        ("solve", ["solve"]),
        ("goal 'sweet potato; chopped' tea  # two", ["goal", "sweet potato; chopped", "tea"]),
        ('have "a \\"b\\" \\\\ c" d\\ e', ["have", 'a "b" \\ c', "d e"]),
        (r"have 'a\;b'", ["have", r"a\;b"]),
        ("goal a#b ''", ["goal", "a#b", ""]),
        ("a'b c'd", ["ab cd"]),
    ],
)
def test_a_line_is_taken_apart_like_a_command_line(text: str, words: list[str]) -> None:
    assert take_apart(text).texts == words


def test_places_of_words_and_quotes_that_are_open() -> None:
    line = take_apart("goal 'sweet po")
    assert line.words == (Word("goal", 0), Word("sweet po", 5))
    assert line.open_quote == "'"
    with pytest.raises(UserError, match="the quote ' in 'sweet po' is not closed"):
        _ = line.texts


@pytest.mark.parametrize("word", ["a", "a b", "it's", 'it\'s "x"\\', "", "#", "a#", "a\\;b", "\u00a0"])
def test_quotes_give_the_word_back(word: str) -> None:
    assert take_apart(f"x {quoted(word)}").texts == ["x", word]


# --- Scripts.


def test_a_session_answers_as_the_verbs_do(shell: Cli, cli: Cli, tmp_path: Path) -> None:
    """What stands in the session is what the options say on the command line; both rules, several goals."""
    (tmp_path / "mine.lp").write_text(':- use(U), motion(U,"crush").\n')
    lines = [
        "goal ice 'whipped cream'",
        "objective success,units",
        "solve --format json",
        "containers implied",
        "constraint mine.lp",
        "constraint forbid_motion forbidden_motion=whip",
        "solve --format json",
        "lack 'drinking glass; empty'",
        "why-not --format json",
        "have 'drinking glass; empty'",
        "drop mine.lp",
        "goal ice",
        "solve --format json",
        "solve --format json --goal tea --containers strict",
    ]
    ran = shell(*lines)
    assert ran.code == 0, ran.err
    both = ("--goal", "ice", "--goal", "whipped cream", "--objective", "success,units")
    implied = ("--containers", "implied")
    mine = ("--constraint", "mine.lp")
    whip = ("--constraint", "forbid_motion", "-c", "forbidden_motion=whip")
    kitchen = json.loads((ROOT / "data/kitchen/kitchen.json").read_text())
    no_glass = [i for i in kitchen if (i["label"], i.get("states")) != ("drinking glass", ["empty"])]
    assert len(no_glass) == len(kitchen) - 1
    (tmp_path / "no_glass.json").write_text(json.dumps(no_glass))
    less = ("--data", ROOT / "data/kitchen", "--kitchen", "no_glass.json")
    expected = [
        cli("solve", *both, "--format", "json"),
        cli("solve", *both, *implied, *mine, *whip, "--format", "json"),
        cli("why-not", *both[:4], *implied, *mine, *whip, *less, "--format", "json"),
        cli("solve", "--goal", "ice", *both[4:], *implied, *whip, "--format", "json"),
        cli("solve", "--goal", "tea", *both[4:], *whip, "--format", "json"),
    ]
    found = documents(ran.out)
    for one, other in zip(found, expected, strict=True):
        theirs = other.json
        if "roots" in one:
            assert one == theirs
            continue
        for key in ("goals", "containers", "objectives", "status", "proof", "costs", "lower_bound"):
            assert one[key] == theirs[key]


def documents(text: str) -> list[dict[str, object]]:
    """Read JSON documents that stand behind each other."""
    decoder, found, place = json.JSONDecoder(), [], 0
    while place < len(text):
        value, place = decoder.raw_decode(text, place)
        found.append(value)
        place += len(text[place:]) - len(text[place:].lstrip())
    return found


def test_what_is_said_and_what_is_answered(shell: Cli) -> None:
    ran = shell(
        "# what stands, from the beginning",
        "foon-asp goal ice   # pasted",
        "",
        "lack 'ice; cubed'",
        "have 'drinking glass; contains {ice}'",
        "constraint forbid_motion forbidden_motion=crush",
        "constraint at_most_units max_units=9",
        "time-limit 20",
        "show",
        "drop at_most_units",
        "have 'drinking glass; contains {ice}' 'ice; cubed; in [ice cube tray]'",
        "objective kitchen success",
        "show",
        words=("--containers", "implied"),
    )
    assert (
        ran.err
        == """\
goal: ice; crushed; in [drinking glass]
no longer at hand: ice; cubed; in [ice cube tray]
at hand: drinking glass; contains {ice}
constraint: forbid_motion forbidden_motion=crush
constraint: at_most_units max_units=9
time-limit: 20
dropped: at_most_units
already at hand: drinking glass; contains {ice}
at hand: ice; cubed; in [ice cube tray]
objective: kitchen, success
"""
    )
    assert (
        ran.out
        == """\
goal: ice; crushed; in [drinking glass]
objective: units
containers: implied
constraint: forbid_motion forbidden_motion=crush
constraint: at_most_units max_units=9
time-limit: 20
kitchen: 110 object nodes
  + drinking glass; contains {ice}
  - ice; cubed; in [ice cube tray]
goal: ice; crushed; in [drinking glass]
objective: kitchen, success
containers: implied
constraint: forbid_motion forbidden_motion=crush
time-limit: 20
kitchen: 111 object nodes
  + drinking glass; contains {ice}
"""
    )


@pytest.mark.slow
def test_other_questions_take_what_stands(shell: Cli, cli: Cli) -> None:
    ran = shell(
        "goal macaroni tea",
        "menu",
        "goal macaroni",
        "alternatives --best 2",
        "regret",
        "diff 'solve' 'solve --objective success'",
        "search bfs",
        "goal 'hot cocoa'",
        "shopping-list --lists 1",
    )
    two = ("--goal", "macaroni", "--goal", "tea")
    expected = [
        cli("menu", *two),
        cli("alternatives", *two[:2], "--best", "2"),
        cli("regret", *two[:2]),
        cli("diff", "solve --goal macaroni", "solve --goal macaroni --objective success"),
        cli("search", "bfs", *two[:2]),
        cli("shopping-list", "--goal", "hot cocoa", "--lists", "1"),
    ]
    printed = "".join(each.out for each in expected)
    printed = printed.replace("solve --goal macaroni --objective", "solve --objective")
    assert re.sub(" +", " ", ran.out) == re.sub(" +", " ", printed.replace("solve --goal macaroni", "solve"))
    assert ran.code == 0


@pytest.mark.parametrize(
    ("line", "message"),
    [
        (
            "items used-up",
            "it is an option, for one line only: solve --items used-up",
        ),
        ("slove", "found 'slove', expected a word of the session or a question; did you mean solve?"),
        ("obj units", "did you mean objective?"),
        ("goal panckae", "no object node has the label 'panckae'"),
        ("goal", "name a goal; the goals file has\n  goal 'greek salad'"),
        ("goal greek salad", "a name with blanks is in quotes: goal 'greek salad'"),
        ("have bowl", "object nodes; paste the one you mean\n  have '"),
        ("lack unicorn", "no object node at hand has the label 'unicorn'"),
        ("kitchen nothing.json", "nothing.json: no such file"),
        ("containers loose", "found the container rule 'loose', expected strict or implied"),
        ("objective speed", "found the objective 'speed', expected one of"),
        ("objective", "expected objective LIST, of units, inputs"),
        ("constraint nothing", "nothing: no such file; expected an encoding (.lp) or a ready-made one"),
        ("constraint forbid_motion x=1", "no encoding in use has the constant 'x'"),
        ("drop forbid_motion", "this session has no constraint 'forbid_motion'; the session has: none"),
        ("time-limit soon", "found the time limit 'soon', expected seconds, or none"),
        ("show me", "found 'me' after show"),
        ("help me", "found 'me', expected a word of the session or a question"),
        ("solve --bset 3", "No such option '--bset'"),
        ("solve --goal tea --data elsewhere", "a session keeps the data it was started with"),
        ("solve", "name a goal with --goal"),
        ("goal 'tea", "the quote ' in 'tea' is not closed"),
    ],
)
def test_a_fault_ends_a_script_with_its_line(shell: Cli, line: str, message: str) -> None:
    ran = shell("# a fault", "", line, "goal tea", "solve")
    assert ran.code == 2
    assert "lines.txt:3: error: " in ran.err
    assert message in ran.err
    assert ran.out == ""


def test_a_fault_in_a_constraint_has_both_places_and_changes_nothing(shell: Cli, tmp_path: Path) -> None:
    (tmp_path / "mine.lp").write_text(":- use(U), mootion(U,\n")
    ran = shell("constraint mine.lp")
    assert ran.code == 2
    assert ran.err.startswith("lines.txt:1: error: mine.lp:")


@pytest.mark.parametrize(
    ("lines", "code"),
    [
        ([], 0),
        (["goal 'apple pie'"], 0),
        (["goal 'apple pie'", "solve"], 1),
        (["goal 'apple pie'", "solve", "show"], 1),
        (["goal 'apple pie'", "solve", "goal tea", "solve"], 0),
        (["goal 'apple pie'", "solve", "quit", "nonsense"], 1),
    ],
)
def test_a_script_ends_with_the_code_of_the_last_question(shell: Cli, lines: list[str], code: int) -> None:
    assert shell(*lines).code == code


def test_a_script_from_standard_input(cli: Cli, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stdin", io.StringIO("goal tea\nsolve\nnonsense\n"))
    ran = cli("shell")
    assert ran.code == 2
    assert "optimal by units (strict containers): 7 units" in ran.out
    assert "<stdin>:3: error: found 'nonsense'" in ran.err
    assert (
        cli("shell", "nowhere.txt").err == "error: nowhere.txt: cannot be read: No such file or directory\n"
    )


def test_limits_and_other_kitchens(shell: Cli, tmp_path: Path) -> None:
    (tmp_path / "glasses.txt").write_text("O\tdrinking glass\nS\tempty\nO\tunicorn\n")
    ran = shell("kitchen glasses.txt", "kitchen", "have 'muddler; clean'", "show", "goal ice", "why-not")
    assert ran.code == 1
    assert "glasses.txt:3:1: warning: the kitchen item 'unicorn' matches no object node" in ran.err
    assert "kitchen: 1 object node from glasses.txt\n" in ran.err
    assert ran.out.startswith("drinking glass; empty\n")
    assert "kitchen: 2 object nodes\n  + muddler; clean\n" in ran.out


def test_questions_to_a_store(shell: Cli, cli: Cli, tmp_path: Path) -> None:
    """Changes to the kitchen of a store, with and without reading it whole."""
    store = tmp_path / "kitchen.foon"
    assert cli("import", "--data", ROOT / "data/kitchen", "--store", store).code == 0
    lines = (
        "goal ice",
        "solve --format json",
        "lack 'muddler; clean'",
        "solve --format json",
        "constraint at_most_units max_units=9",
        "solve --format json",
        "have 'muddler; clean'",
        "solve --format json",
        "solve --format json --goal 'drinking glass; contains {ice}'",
        "show",
        "kitchen",
    )
    stored, plain = shell(*lines, words=("--network", store)), shell(*lines)
    assert stored.code == plain.code == 0
    timeless = [re.sub(r'"seconds": \{[^}]*\}', "", ran.out) for ran in (stored, plain)]
    assert timeless[0] == timeless[1]
    assert stored.err == plain.err


def test_at_another_level(shell: Cli) -> None:
    ran = shell("goal 'ice'", "solve", "lack 'muddler'", "show", words=("--level", "1"))
    assert ran.code == 0, ran.err
    assert "stands for" in ran.out
    assert "  - muddler\n" in ran.out


def test_help(shell: Cli) -> None:
    ran = shell("help", "help goal", "help solve", "solve -h")
    assert all(f"  {usage.usage} " in ran.out for usage in WORDS.values())
    assert all(verb in ran.out for verb in QUESTIONS)
    assert ran.out.count("Find the best task tree for a goal") == 2


# --- Completion.


@pytest.fixture(scope="module")
def session() -> ShellSession:
    question = read_dataset(None, (), None, None, None, None, None, lenient=False, level=3)
    session = ShellSession(question, lenient=False, level=3, encodings=None)
    session.run("constraint at_most_units max_units=9")
    return session


@pytest.mark.parametrize(
    ("line", "start", "texts"),
    [
        ("con", 0, ("containers", "constraint", "constraints")),
        ("goal mac", 5, ("macaroni", "'macaroni and cheese'", "'macaroni; dry; in [macaroni box]'")),
        ("goal 'greek sal", 5, ("'greek salad'", "'greek salad; mixed; in [salad bowl]'")),
        ("goal tea 'ice; cr", 9, ("'ice; crushed; in [drinking glass]'",)),
        ("have mudd", 5, ("'muddler; clean'",)),
        ("lack mudd", 5, ("'muddler; clean'",)),
        ("containers ", 11, ("strict", "implied")),
        ("objective un", 10, ("units",)),
        (
            "objective units,",
            10,
            ("units,inputs", "units,inputs+ingredients", "units,success", "units,kitchen"),
        ),
        ("constraint req", 11, ("require_ingredient", "require_intermediate", "require_motion")),
        ("constraint forbid_motion ", 25, ("forbidden_motion=",)),
        (
            "constraint forbid_motion forbidden_motion=cr",
            25,
            ("forbidden_motion=crack", "forbidden_motion=crank", "forbidden_motion=crumble"),
        ),
        ("constraint forbid_object forbidden_object=mudd", 25, ("forbidden_object=muddler",)),
        ("constraint forbid_motion:", 11, ("forbid_motion:forbidden_motion=",)),
        ("constraint forbid_motion:forbidden_motion=cran", 11, ("forbid_motion:forbidden_motion=crank",)),
        (
            "solve --constraint before:earlier_motion=a,later_motion=cran",
            19,
            ("before:earlier_motion=a,later_motion=crank",),
        ),
        ("rule ", 5, ()),
        ("drop ", 5, ("at_most_units",)),
        ("help sh", 5, ("show", "shopping-list")),
        ("alternatives --b", 13, ("--best",)),
        ("solve --containers i", 19, ("implied",)),
        ("solve --objective success,k", 18, ("success,kitchen",)),
        ("foon-asp solve --goal whip", 22, ("'whipped cream'",)),
        ("solve --constraint forbid_i", 19, ("forbid_ingredient",)),
        ("show ", 5, ()),
        ("nonsense ", 9, ()),
        ("search ids --time-limit ", 24, ()),
    ],
)
def test_candidates(session: ShellSession, line: str, start: int, texts: tuple[str, ...]) -> None:
    found = candidates(line, session)
    assert found.start == start
    if texts:
        assert found.texts[: len(texts)] == texts
    else:
        assert not found.texts


# --- At a terminal.


def terminal(words: list[str | Path], steps: list[tuple[str, str]], state: Path) -> tuple[int, str]:
    """Run ``foon-asp`` at a terminal: type each text once what was to come before it has been printed."""
    ours, theirs = pty.openpty()
    environment = {**os.environ, "PROMPT_TOOLKIT_NO_CPR": "1", "TERM": "xterm", "XDG_STATE_HOME": str(state)}
    process = subprocess.Popen(
        [sys.executable, "-m", "foon_asp", *map(str, words)],
        stdin=theirs,
        stdout=theirs,
        stderr=theirs,
        cwd=ROOT,
        env=environment,
        start_new_session=True,
        # ctrl-C reaches those of this terminal
        preexec_fn=lambda: fcntl.ioctl(0, termios.TIOCSCTTY, 0),  # noqa: PLW1509
    )
    os.close(theirs)
    printed, seen = "", 0
    until = time.monotonic() + 60
    for awaited, text in [*steps, ("", "")]:
        while time.monotonic() < until:
            plain = re.sub(r"\x1b\[[0-9;?]*[a-zA-Z]", "", printed)
            if awaited and awaited in plain[seen:]:
                seen = plain.index(awaited, seen) + len(awaited)
                break
            if select.select([ours], [], [], 0.1)[0]:
                try:
                    printed += os.read(ours, 65536).decode(errors="replace")
                except OSError:  # the other end is closed
                    break
        time.sleep(0.3)
        if text:
            os.write(ours, text.encode())
    os.close(ours)
    return process.wait(timeout=30), re.sub(r"\x1b\[[0-9;?]*[a-zA-Z]", "", printed)


@pytest.mark.slow
def test_a_session_at_a_terminal(tmp_path: Path) -> None:
    """An error keeps the session, tab completes, ctrl-D leaves, and the lines are kept for the next time."""
    prompt = "foon-asp>"
    code, printed = terminal(
        ["shell"],
        [
            (prompt, "goal panckae\r"),
            ("error: no object node", "objective succ\t"),
            ("success", "\r"),
            ("objective: success", "goal ice\r"),
            ("goal: ice", "solve\r"),
            ("optimal by success", "\x04"),
        ],
        tmp_path,
    )
    assert code == 0, printed
    lines = (tmp_path / "foon-asp" / "history").read_text().splitlines()
    assert [line for line in lines if line.startswith("+")] == [
        "+goal panckae",
        "+objective success",
        "+goal ice",
        "+solve",
    ]


@pytest.mark.slow
def test_ctrl_c_ends_the_question_and_keeps_the_session(tmp_path: Path) -> None:
    problem = hard_problem()
    network = problem.network
    (tmp_path / "FOON.txt").write_text(write_units(map(network.unit, range(len(network)))))
    (tmp_path / "kitchen.txt").write_text(
        "".join(f"O\t{network.objects[o]}\n" for o in sorted(problem.kitchen))
    )
    goal = str(network.objects[problem.goals[0]])
    code, printed = terminal(
        ["shell", "--data", tmp_path, "--goal", goal],
        [
            ("foon-asp>", "solve --constraint at_most_units -c max_units=999\r"),
            ("best tree:", "\x03"),
            ("proved so far", "show\r"),
            ("time-limit: none", "\x03"),
            ("foon-asp>", "quit\r"),
        ],
        tmp_path / "state",
    )
    assert code == 0, printed
    assert "feasible, not proved best by units" in printed


def test_history_is_for_terminals_only(shell: Cli, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
    assert history_file() == tmp_path / "state" / "foon-asp" / "history"
    assert shell("goal tea", "solve").code == 0
    assert not (tmp_path / "state").exists()
    for unset in ("", "relative/folder"):
        monkeypatch.setenv("XDG_STATE_HOME", unset)
        assert history_file() == Path.home() / ".local" / "state" / "foon-asp" / "history"


def test_scripts_do_not_load_the_prompt(tmp_path: Path) -> None:
    program = (
        "import sys\nfrom foon_asp.cli.main import main\n"
        "try: main(['shell'])\nfinally: print('prompt_toolkit' in sys.modules)"
    )
    ran = subprocess.run(
        [sys.executable, "-c", program],
        input="goal tea\n",
        text=True,
        capture_output=True,
        cwd=ROOT,
        check=True,
    )
    assert ran.stdout == "False\n"


ALLERGY = ':- use(U), input(U,O), label(O,"nut").\n'
NUTS = """\
O\tnut
M\tcrush
O\tcake
//
O\tflour
M\tbake
O\tdough
//
O\tdough
M\tbake
O\tcake
//
"""


@pytest.fixture
def nuts(shell: Cli) -> Cli:
    """Run lines in a session in which an allergy stands; the best cake by far is one with nuts."""
    Path("FOON.txt").write_text(NUTS)
    Path("kitchen.txt").write_text("O\tnut\nO\tflour\n")
    Path("allergy.lp").write_text(ALLERGY)
    Path("other.lp").write_text(':- use(U), motion(U,"fry").\n')
    Path("motion.txt").write_text("crush\t0.9\nbake\t0.8\n")

    def run(*lines: str | Path, words: tuple[str | Path, ...] = ()) -> Ran:
        return shell("goal cake", "constraint allergy.lp", *lines, words=("--data", ".", *words))

    return run


@pytest.mark.parametrize(
    "line",
    [
        "solve",
        "solve --constraint other.lp",
        "solve --constraint forbid_motion -c forbidden_motion=fry",
        "solve --constraint allergy.lp --constraint other.lp",
        "solve --soft other.lp=3",
        "solve --reduce none --constraint other.lp",
        "alternatives --constraint other.lp",
        "certify --constraint other.lp",
        "pareto --trees --constraint other.lp",
        "regret --constraint other.lp",
        "menu --goal cake --goal dough --constraint other.lp",
        "diff 'solve --constraint other.lp' 'solve'",
        "diff solve 'solve --constraint other.lp -c max_units=9 --constraint at_most_units'",
    ],
)
def test_a_rule_that_stands_still_holds_when_a_line_adds_another(nuts: Cli, line: str) -> None:
    ran = nuts(line)
    assert ran.code in {0, 3}, ran.err
    shown = {"diff": "2 units, 2 inputs", "certify": "allergy.lp"}.get(line.split(maxsplit=1)[0], "bake")
    assert shown in ran.out
    assert "crush" not in ran.out


def test_without_the_rule_there_are_nuts(nuts: Cli) -> None:
    assert "crush" in nuts("drop allergy.lp", "solve --constraint other.lp").out


def test_rules_of_the_command_line_stand_too(nuts: Cli) -> None:
    ran = nuts(
        "drop allergy.lp",
        "solve --constraint other.lp",
        words=("--constraint", "forbid_motion", "-c", "forbidden_motion=crush"),
    )
    assert ran.code == 0
    assert "crush" not in ran.out


def test_a_constant_that_stands_is_replaced_by_a_word_alone(nuts: Cli) -> None:
    stands = "constraint forbid_motion forbidden_motion=crush"
    ran = nuts(stands, "solve -c forbidden_motion=bake")
    assert ran.code == 2
    assert "forbidden_motion=crush is set" in ran.err
    assert nuts(stands, "solve -c forbidden_motion=crush").code == 0
    ran = nuts(stands, "constraint forbid_motion forbidden_motion=bake", "solve")
    assert "replaced: forbidden_motion=crush" in ran.err
    assert ran.code == 1
    ran = nuts(stands, "constraint other.lp", "solve")
    assert "replaced" not in ran.err


@pytest.mark.parametrize("line", ["search bfs", "units"])
def test_what_knows_of_no_rules_is_not_asked_while_some_stand(nuts: Cli, line: str) -> None:
    ran = nuts(line)
    verb = line.split(maxsplit=1)[0]
    assert (ran.code, ran.out) == (2, "")
    assert f"{verb} takes no constraints, and this session has allergy.lp: drop them first" in ran.err
    assert nuts(f"{verb} --help").code == 0


def test_a_given_tree_and_a_picture_are_under_the_rules_that_stand(nuts: Cli) -> None:
    Path("tree.txt").write_text(NUTS[: NUTS.index("//") + 3])
    ran = nuts("check tree.txt", "draw", "draw --tree tree.txt")
    checked, *_ = ran.out.partition("digraph")
    assert 'it breaks 1 rule:\n  allergy.lp:1\n      :- use(U), input(U,O), label(O,"nut").\n' in checked
    solved, shown = ran.out.split("digraph foon")[1:]
    assert ("1. bake" in solved, "1. crush" in solved) == (True, False)
    assert "1. crush" in shown  # nothing is solved


def test_encodings_that_stand_are_not_replaced_by_a_line(nuts: Cli, tmp_path: Path) -> None:
    shutil.copytree(ROOT / "encodings", tmp_path / "mine")
    shutil.copytree(ROOT / "encodings", tmp_path / "others")
    ran = nuts("solve --encodings others", words=("--encodings", "mine"))
    assert ran.code == 2
    assert "this session uses the encodings of mine" in ran.err
    assert nuts("solve", "solve --encodings mine", words=("--encodings", "mine")).code == 0


def test_rules_stand_in_a_session(shell: Cli) -> None:
    rule = """':- use(U), motion(U,"crush").'"""
    ran = shell(
        "goal ice",
        f"rule {rule}",
        "constraint forbid_motion:forbidden_motion=pound",
        "show",
        "solve",
        f"drop {rule} forbid_motion:forbidden_motion=pound",
        f"solve --rule {rule}",
        f"solve --constraint forbid_motion:forbidden_motion=crush --rule {rule}",
        f"rule {rule}",
        "solve --rule ':- use(U), motoin(U,1).'",
    )
    assert (
        'rule: :- use(U), motion(U,"crush").\nconstraint: forbid_motion:forbidden_motion=pound\n' in ran.out
    )
    assert ran.out.count("infeasible") == 1
    assert ran.out.count("3 units, 9 inputs") == 3
    assert "rule 2:1:12: warning: no rule or fact defines motoin/2" in ran.err
    assert ran.code == 0


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("rule", "expected rule 'RULE', with the rule in quotes"),
        ("rule :- use(U), motion(U,1).", "expected rule 'RULE', with the rule in quotes"),
        ("rule ''", "rule 1: found '', expected a rule such as"),
        ("rule ':- use(U)'", "rule 1:1:10: error: syntax error, unexpected EOF; a rule ends in a full stop"),
        ("drop ':- use(1).'", "this session has no constraint ':- use(1).'"),
        ("constraint forbid_motion:x=1", "forbid_motion has no constant 'x'"),
    ],
)
def test_rules_that_are_none_change_nothing(shell: Cli, line: str, message: str) -> None:
    ran = shell("goal ice", line)
    assert ran.code == 2
    assert message in ran.err
