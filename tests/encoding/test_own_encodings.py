"""Encodings of ours that were changed in place: they run, and nothing bypasses them."""

import shutil
from pathlib import Path

import pytest

from foon_asp.encoding import own_encodings
from foon_asp.encoding.own_encodings import digest, is_own
from foon_asp.resources import encodings_folder
from tests.conftest import ROOT, Cli

OURS = ROOT / "encodings"


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A copy of our folder, which the program takes for its own."""
    copy = tmp_path / "encodings"
    shutil.copytree(encodings_folder(), copy)
    for module in (
        "asp.assembly",
        "rules.passed_constraint",
        "asp.settings",
        "encoding.own_encodings",
        "encoding.encoding",
    ):
        monkeypatch.setattr(f"foon_asp.{module}.encodings_folder", lambda: copy)
    own_encodings._digests.cache_clear()
    monkeypatch.setattr(own_encodings, "_digests", own_encodings._digests.__wrapped__)
    return copy


def test_the_digests_are_those_of_the_files() -> None:
    """After a change of an encoding: ``cd encodings && sha256sum *.lp */*.lp > SHA256SUMS``."""
    lines = (OURS / "SHA256SUMS").read_text().splitlines()
    files = {path.relative_to(OURS).as_posix(): digest(path) for path in OURS.rglob("*.lp")}
    assert {name: sha for sha, name in (line.split("  ") for line in lines)} == files


def test_what_is_own(folder: Path) -> None:
    file = folder / "task_tree.lp"
    text = file.read_bytes()
    file.write_bytes(text.replace(b"\n", b"\r\n"))
    assert is_own(file)  # a checkout with the line ends of Windows
    file.write_bytes(text + b"\n")
    assert not is_own(file)
    added = folder / "constraints" / "mine.lp"
    added.write_text(":- use(1).\n")
    assert not is_own(added)


def test_a_tree_is_what_an_encoding_changed_in_place_says(folder: Path, cli: Cli) -> None:
    words = ["solve", "--goal", "macaroni; cooked; in [pot]", "--format", "json"]
    ours = cli(*words)
    assert ours.code == 0
    assert '"proof": "cuts"' in ours.out
    with (folder / "task_tree.lp").open("a") as file:
        file.write(':- use(U), motion(U,"pour").\n')
    theirs = cli(*words)
    assert '"motion": "pour"' in ours.out
    assert '"motion": "pour"' not in theirs.out
    assert '"proof": "cuts"' not in theirs.out
    assert str(folder) in theirs.out


def test_what_is_best_is_what_an_encoding_changed_in_place_says(folder: Path, cli: Cli) -> None:
    words = ["solve", "--goal", "macaroni"]
    least = cli(*words)
    file = folder / "objectives.lp"
    file.write_text(file.read_text().replace("{ 1@P,U", "{ -1@P,U"))
    most = cli(*words)
    assert least.code == most.code == 0
    assert "as " + str(folder) in most.out
    assert least.out != most.out


def test_a_constraint_changed_in_place_is_not_certified_as_ours(folder: Path, cli: Cli) -> None:
    words = ["solve", "--goal", "macaroni", "--constraint", "forbid_motion", "-c", "forbidden_motion=fry"]
    words += ["--certificate", str(folder / "proof.json")]
    cli(*words)
    assert "forbid_motion.lp" not in (folder / "proof.json").read_text()
    with (folder / "constraints" / "forbid_motion.lp").open("a") as file:
        file.write(':- use(U), motion(U,"bake").\n')
    cli(*words)
    assert "forbid_motion.lp" in (folder / "proof.json").read_text()


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("exact_success.lp", ["solve", "--objective", "success"]),
        ("questions/other_trees.lp", ["alternatives"]),
        ("questions/at_most.lp", ["pareto", "--objective", "units,success"]),
        ("questions/second_opinion.lp", ["solve", "--cross-check"]),
        ("questions/shopping_list.lp", ["shopping-list", "--rule", ':- use(U), motion(U,"pat").']),
        ("questions/union.lp", ["alternatives", "--union", "--within", "20"]),
    ],
)
def test_what_cannot_be_replaced_is_refused(folder: Path, cli: Cli, name: str, words: list[str]) -> None:
    verb, *options = words
    asked = [verb, "--goal", "macaroni", *options]
    assert cli(*asked).code == 0
    with (folder / name).open("a") as file:
        file.write(":- use(1).\n")
    ran = cli(*asked)
    assert ran.code == 2, ran
    assert f"{folder / name} was changed, but answers rely on its old content: restore it" in ran.err
    assert ran.out == ""


def test_they_are_printed_and_copied(cli: Cli, tmp_path: Path) -> None:
    ours, mine = encodings_folder(), tmp_path / "mine"
    assert cli("encodings").out == f"{ours}\n"
    assert cli("encodings", "--copy", mine).code == 0
    content = [
        {path.relative_to(each): path.read_bytes() for path in each.rglob("*") if path.is_file()}
        for each in (ours, mine)
    ]
    assert content[0] == content[1]
    copied = mine / "task_tree.lp"
    copied.chmod(0o644)
    copied.write_text(copied.read_text() + ':- use(U), motion(U,"crush").\n')
    asked = "solve", "--goal", "ice", "--format", "json"
    free, edited = (cli(*asked, *words).json["costs"]["units"] for words in ((), ("--encodings", mine)))
    assert free < edited
    again = cli("encodings", "--copy", mine)
    assert again.code == 2
    assert "already exists" in again.err
