"""Encodings of ours that were changed in place: they run, and nothing bypasses them."""

import hashlib
import shutil
from pathlib import Path

import pytest

from foon_asp.encoding import own_encodings
from foon_asp.encoding.own_encodings import digest, is_own
from foon_asp.resources import encodings_folder
from tests.conftest import Cli

pytestmark = pytest.mark.sampled(2)  # by default each second case of a test: there are many

OURS = Path(__file__).resolve().parent.parent / "encodings"


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A copy of our folder, which the program takes for its own."""
    copy = tmp_path / "encodings"
    shutil.copytree(encodings_folder(), copy)
    for module in (
        "asp.assembly",
        "rules.constraint",
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


def test_what_is_own(folder: Path, tmp_path: Path) -> None:
    file = folder / "task_tree.lp"
    assert is_own(file)
    text = file.read_bytes()
    file.write_bytes(text.replace(b"\n", b"\r\n"))
    assert is_own(file)  # a checkout with the line ends of Windows
    assert digest(file) == hashlib.sha256(text).hexdigest()
    file.write_bytes(text + b"\n")
    assert not is_own(file)
    elsewhere = tmp_path / "task_tree.lp"
    elsewhere.write_bytes(text)
    assert not is_own(elsewhere)
    own = folder / "constraints" / "mine.lp"
    own.write_text(":- use(1).\n")
    assert not is_own(own)


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
    words = ["certify", "--goal", "macaroni", "--constraint", "forbid_motion", "-c", "forbidden_motion=fry"]
    assert "forbid_motion.lp" not in cli(*words).out
    with (folder / "constraints" / "forbid_motion.lp").open("a") as file:
        file.write(':- use(U), motion(U,"bake").\n')
    assert "forbid_motion.lp" in cli(*words).out


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("exact_success.lp", ["solve", "--objective", "success"]),
        ("questions/other_trees.lp", ["alternatives"]),
        ("questions/at_most.lp", ["pareto", "--objective", "units,success"]),
        ("questions/second_opinion.lp", ["solve", "--cross-check"]),
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


@pytest.mark.slow
def test_a_shopping_list_needs_its_own_encoding(folder: Path, cli: Cli) -> None:
    words = ["shopping-list", "--goal", "macaroni", "--kitchen", str(folder / "empty.txt")]
    (folder / "empty.txt").write_text("")
    assert cli(*words).code in {0, 1}
    with (folder / "questions" / "shopping_list.lp").open("a") as file:
        file.write(":- use(1).\n")
    assert cli(*words).code == 2


def test_they_are_printed_and_copied(cli: Cli, tmp_path: Path) -> None:
    assert cli("encodings").out == f"{encodings_folder()}\n"
    mine = tmp_path / "mine"
    assert cli("encodings", "--copy", mine).code == 0
    files = {path.relative_to(mine) for path in mine.rglob("*") if path.is_file()}
    ours = encodings_folder()
    assert files == {path.relative_to(ours) for path in ours.rglob("*") if path.is_file()}
    assert all((mine / file).read_bytes() == (ours / file).read_bytes() for file in files)
    (mine / "task_tree.lp").chmod(0o644)
    (mine / "task_tree.lp").write_text(
        (ours / "task_tree.lp").read_text() + ':- use(U), motion(U,"crush").\n'
    )
    free = cli("solve", "--goal", "ice", "--format", "json").json
    edited = cli("solve", "--goal", "ice", "--encodings", mine, "--format", "json").json
    assert free["costs"]["units"] < edited["costs"]["units"]
    again = cli("encodings", "--copy", mine)
    assert again.code == 2
    assert "is there already" in again.err
