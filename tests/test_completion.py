"""What shells complete behind ``foon-asp``, in the shells themselves where they are; and misspelt verbs."""

import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.conftest import ROOT, Cli

PROGRAM = f"{shlex.quote(sys.executable)} -m foon_asp"
LINES = [
    ("foon-asp shopp", ["shopping-list"]),
    ("foon-asp solve --goal 'greek s", ["greek salad", "greek salad; mixed; in [salad bowl]"]),
    ("foon-asp solve --goal greek\\ s", ["greek salad", "greek salad; mixed; in [salad bowl]"]),
    ("foon-asp solve --rates nowhere.txt --goal tea", []),  # the data cannot be read
    ("foon-asp solve --obj", ["--objective"]),
    ("foon-asp solve --objective units,su", ["units,success"]),
    ("foon-asp solve --containers ", ["strict", "implied"]),
    ("foon-asp solve --constraint forbid_m", ["forbid_motion"]),
    ("foon-asp slove --obj", []),
    ("foon-asp solve --data ", []),
]
PIECES = [
    ("foon-asp solve --constraint forbid_motion:forbidden_motion=sli", ["slice", "slide"]),
    ("foon-asp solve --constraint forbid_motion -c forbidden_motion=sli", ["slice", "slide"]),
    ("foon-asp solve --constraint forbid_object -c forbidden_object=muf", []),
    ("foon-asp solve --constraint forbid_object -c forbidden_object=kni", ["knife"]),
]


@pytest.mark.parametrize(("line", "words"), LINES)
@pytest.mark.parametrize("shell", ["bash", "fish"])
def test_what_a_line_may_go_on_with(cli: Cli, shell: str, line: str, words: list[str]) -> None:
    ran = cli("completion", shell, "--line", line)
    assert (ran.code, ran.out.splitlines()) == (0, words)


@pytest.mark.parametrize(("line", "words"), PIECES)
def test_bash_replaces_what_stands_behind_a_colon_or_equals_sign(
    cli: Cli, line: str, words: list[str]
) -> None:
    assert cli("completion", "bash", "--line", line).out.splitlines() == words
    begun = line.rsplit(maxsplit=1)[-1].rpartition("=")[0] + "="
    assert cli("completion", "zsh", "--line", line).out.splitlines() == [begun + word for word in words]


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


def test_bash_completes(cli: Cli, tmp_path: Path) -> None:
    ask = 'COMP_POINT=${#COMP_LINE}; _foon_asp; printf "%s\\n" "${COMPREPLY[@]}"'
    line = 'COMP_LINE="foon-asp solve --goal \'greek salad; m"'
    found = run("bash", f"{cli('completion', 'bash').out}\n{line}\n{ask}", tmp_path)
    assert found == ["greek salad; mixed; in [salad bowl]"]


def test_fish_completes(cli: Cli, tmp_path: Path) -> None:
    ask = "complete -C 'foon-asp solve --goal \"greek salad; m'"
    found = run("fish", f"{cli('completion', 'fish').out}\n{ask}", tmp_path)
    assert found == ["greek salad; mixed; in [salad bowl]"]


def test_zsh_reads_its_script(cli: Cli, tmp_path: Path) -> None:
    script = cli("completion", "zsh").out
    ask = 'compadd() { print -l -- ${(P)2} }; LBUFFER="foon-asp solve --goal omel"; _foon_asp'
    found = run("zsh", f"compdef() {{ }}\n{script}\n{ask}", tmp_path)
    assert found[0] == "omelet"


def test_another_shell_is_refused(cli: Cli) -> None:
    assert cli("completion", "tcsh").code == 2


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
        ("xyzzy", "foon-asp -h lists the verbs"),
    ],
)
def test_a_misspelt_verb_gets_the_nearest(cli: Cli, word: str, hint: str) -> None:
    ran = cli(word, "--goal", "ice")
    assert ran.code == 2
    assert f"there is no verb '{word}'; {hint}" in ran.err
