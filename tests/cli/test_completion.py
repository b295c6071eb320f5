"""What shells complete behind ``foon-asp``, in the shells themselves where they are; and misspelt verbs."""

import re
import shlex
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from foon_asp.cli.verbs import FIRST_VERBS, VERBS
from tests.conftest import ROOT, Cli

PROGRAM = f"{shlex.quote(sys.executable)} -m foon_asp"
LINES = [
    ("foon-asp shopp", ["shopping-list"]),
    ("foon-asp solve --goal 'greek s", ["greek salad", "greek salad; mixed; in [salad bowl]"]),
    ("foon-asp solve --goal greek\\ s", ["greek salad", "greek salad; mixed; in [salad bowl]"]),
    ("foon-asp solve --rates nowhere.txt --goal tea", []),  # the data cannot be read
    ("foon-asp solve --obj", ["--objective"]),
    ('foon-asp solve --goal "greek \\"s', []),
    ("foon-asp solve --objective units,su", ["units,success"]),
    ("foon-asp solve --objective=units,su", ["--objective=units,success"]),
    ("foon-asp solve --containers ", ["strict", "implied"]),
    ("foon-asp solve --constraint forbid_m", ["forbid_motion"]),
    ("foon-asp solve ", []),  # the shell offers files
]
PIECES = [
    ("foon-asp solve --constraint forbid_motion:forbidden_motion=sli", ["slice", "slide"]),
    ("foon-asp solve --constraint forbid_motion -c forbidden_motion=sli", ["slice", "slide"]),
    ("foon-asp solve --constraint forbid_object -c forbidden_object=muf", []),
    ("foon-asp solve --constraint forbid_object -c forbidden_object=kni", ["knife"]),
]


Completed = Callable[[str, str], list[str]]


@pytest.fixture
def completed(cli: Cli, monkeypatch: pytest.MonkeyPatch) -> Completed:
    """Return the words that a shell is sent for a line."""

    def ask(shell: str, line: str) -> list[str]:
        monkeypatch.setenv("FOON_ASP_LINE", line)
        monkeypatch.setenv("_FOON_ASP_COMPLETE", f"{shell}_complete")
        ran = cli()
        assert ran.code == 0
        return [word for word in ran.out.splitlines() if word]

    return ask


@pytest.mark.parametrize(("line", "words"), LINES)
def test_what_a_line_may_go_on_with(completed: Completed, line: str, words: list[str]) -> None:
    assert completed("fish", line) == words


def test_an_empty_word_may_be_a_verb_or_a_goal(completed: Completed) -> None:
    verbs = completed("zsh", "foon-asp ")
    assert {"solve", "lint", "help"} <= {*verbs}
    assert "completion" not in verbs
    assert {"greek salad", "macaroni"} <= {*completed("zsh", "foon-asp solve --goal ")}


@pytest.mark.parametrize(("line", "words"), PIECES)
def test_bash_replaces_what_stands_behind_a_colon_or_equals_sign(
    completed: Completed, line: str, words: list[str]
) -> None:
    assert completed("bash", line) == words
    begun = line.rsplit(maxsplit=1)[-1].rpartition("=")[0] + "="
    assert completed("zsh", line) == [begun + word for word in words]


def run(shell: str, script: str, tmp_path: Path) -> list[str]:
    if shutil.which(shell) is None:
        pytest.skip(f"{shell} is not installed")
    program = tmp_path / "foon-asp"
    program.write_text(f'#!/bin/sh\nexec {PROGRAM} "$@"\n')
    program.chmod(0o755)
    path = f"{tmp_path}:/usr/bin:/bin"
    home = {"PATH": path, "HOME": str(tmp_path), "PYTHONPATH": str(ROOT)}
    ran = subprocess.run(
        [shell, "-c", script], capture_output=True, text=True, env=home, cwd=tmp_path, check=False
    )
    assert not ran.stderr
    return ran.stdout.splitlines()


@pytest.mark.parametrize(
    ("shell", "begun", "ask"),
    [
        (
            "bash",
            'COMP_LINE="foon-asp solve --goal \'greek salad; m"',
            'COMP_POINT=${#COMP_LINE}; _foon_asp; printf "%s\\n" "${COMPREPLY[@]}"',
        ),
        ("fish", "", "complete -C 'foon-asp solve --goal \"greek salad; m'"),
        (
            "zsh",
            "compadd() { print -l -- ${(P)2} }; LBUFFER='foon-asp solve --goal \"greek salad; m'",
            "_foon_asp",
        ),
    ],
)
def test_a_shell_completes(cli: Cli, tmp_path: Path, shell: str, begun: str, ask: str) -> None:
    before = "compdef() { }\n" * (shell == "zsh")
    found = run(shell, f"{before}{cli('completion', shell).out}\n{begun}\n{ask}", tmp_path)
    assert found == ["greek salad; mixed; in [salad bowl]"]


def test_quiet_leaves_errors_alone(cli: Cli, tmp_path: Path) -> None:
    recipe = tmp_path / "recipe.txt"
    recipe.write_text("//\nO\tice\nS cubed\nM\tcrush\nO\tice\nS\tcrushed\n//\n")
    loud, quiet = cli("solve", recipe, "--goal", "ice"), cli("solve", recipe, "--goal", "ice", "--quiet")
    assert "warning" in loud.err
    assert (quiet.code, quiet.out, quiet.err) == (loud.code, loud.out, "")
    chart = ("solve", "--goal", "ice", "--quiet", "--certificate", tmp_path / "proof.json")
    assert cli(*chart).err == ""
    missing = cli("solve", "--goal", "nothing", "--quiet")
    assert (missing.code, missing.out) == (2, "")
    assert missing.err.startswith("error: no object node has the label 'nothing'")


@pytest.mark.parametrize(
    ("word", "hint"),
    [
        ("slove", "did you mean 'solve'?"),
        ("why_not", "did you mean 'why-not'?"),
        ("Solve", "did you mean 'solve'?"),
        ("xyzzy", "foon-asp help lists the verbs"),
        ("shell", "ask with a command for each question, or in Python, where vary changes it"),
        ("draw", "type: foon-asp view -o FILE.svg"),
    ],
)
def test_a_misspelt_verb_gets_the_nearest(cli: Cli, word: str, hint: str) -> None:
    ran = cli(word, "--goal", "ice")
    assert ran.code == 2
    assert f"there is no verb '{word}'; {hint}" in ran.err


def test_help_lists_the_verbs_that_most_people_need_or_all(cli: Cli) -> None:
    for_programs = {"rename", "schema", "completion", "lsp"}
    for words, verbs in (
        ("-h", {*FIRST_VERBS}),
        ("help", VERBS.keys() - for_programs),
        ("help --all", {*VERBS}),
    ):
        text = cli(*words.split()).out
        assert {*re.findall(r"^  ([a-z-]+) ", text, re.MULTILINE)} & VERBS.keys() == verbs
    assert "foon-asp help" in cli("-h").out
    assert cli("help", "fmt").out == cli("fmt", "-h").out
    assert "did you mean 'solve'?" in cli("help", "slove").err
