"""The world's faults are not bugs of ours: full disks, closed outputs, encodings, and whatever JSON holds."""

import contextlib
import io
import json
import os
import shutil
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from foon_asp.batch.question_file import read_questions
from foon_asp.cli.main import main
from foon_asp.errors import UserError
from foon_asp.proof.certificate_json import read_certificate
from foon_asp.proof.refusal import RefusedError
from foon_asp.text.answer_file import read_listed_tree
from foon_asp.text.diagnostics import InputError
from foon_asp.text.object_list import read_object_list
from foon_asp.text.reader import FoonReader
from tests.conftest import ROOT, Cli
from tests.support.damaged_json import damaged

UNIT = "O\tnöt → x\nM\tmix\nO\tb\n//\n"


def run(
    *words: str | bytes, redirect: str = "", python: Sequence[str] = (), **environment: str
) -> subprocess.CompletedProcess[bytes]:
    """Run ``foon-asp`` in a process of its own; ``redirect`` is what a shell is told about its outputs."""
    command = [sys.executable, *python, "-m", "foon_asp", *words]
    plain = {k: v for k, v in os.environ.items() if k not in {"PYTHONIOENCODING", "PYTHONUTF8", "LC_ALL"}}
    return subprocess.run(
        ["sh", "-c", f'"$@" {redirect}', "sh", *command],
        capture_output=True,
        check=False,
        cwd=ROOT,
        env=plain | environment,
        stdin=subprocess.DEVNULL,
        timeout=120,
    )


# Text, a table, data and what click prints.
PRINTING: list[tuple[str, ...]] = [
    ("solve", "--goal", "ice"),
    ("compare", "--goal", "ice", "--search", "bfs"),
    ("facts", "--goal", "ice"),
    ("--version",),
]


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="there is no full disk to write to")
@pytest.mark.parametrize("words", PRINTING, ids=" ".join)
def test_a_full_disk(words: tuple[str, ...]) -> None:
    ran = run(*words, redirect=">/dev/full")
    assert ran.returncode == 2, ran.stderr
    assert b"standard output: cannot be written: No space left on device" in ran.stderr
    assert b"Traceback" not in ran.stderr
    assert b"Exception ignored" not in ran.stderr
    ran = run(*words, redirect=">/dev/full 2>/dev/full")
    assert ran.returncode == 2


@pytest.mark.parametrize("words", PRINTING, ids=" ".join)
def test_closed_outputs(words: tuple[str, ...]) -> None:
    ran = run(*words, redirect=">&-")
    assert ran.returncode == 2, ran.stderr
    assert b"standard output: cannot be written: it is closed" in ran.stderr
    assert run(*words, redirect="2>&-").returncode == 0
    assert run(*words, redirect=">&- 2>&-").returncode == 2


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="there is no full disk to write to")
@pytest.mark.parametrize(
    "words",
    ["solve --goal ice --certificate", "convert FILE --to json -o", "fmt FILE -o"],
)
def test_a_file_on_a_full_disk(cli: Cli, tmp_path: Path, words: str) -> None:
    file = tmp_path / "a.txt"
    file.write_text(UNIT.replace("//\n", ""))
    given = words.replace("FILE", str(file)).split()
    ran = cli(*given, "/dev/full")
    assert (ran.code, "/dev/full: cannot be written: No space left on device" in ran.err) == (2, True)
    ran = cli(*given, file / "x.txt")
    assert (ran.code, "a.txt" in ran.err) == (2, True)


@pytest.mark.parametrize(
    "words",
    [
        "stats --network PLACE",
        "solve --goal ice --kitchen PLACE",
        "solve --goal ice --constraint PLACE",
        "solve --goal ice --encodings PLACE",
        "verify PLACE",
        "check PLACE --goal ice",
        "batch PLACE --results x.jsonl",
        "assist --goal ice --person PLACE",
        "shopping-list --goal ice --prices PLACE",
        "lint PLACE",
        "fmt PLACE",
        "convert PLACE --to json",
        "import PLACE --store x.foon",
    ],
)
def test_a_folder_or_nothing_in_the_place_of_a_file(
    cli: Cli, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, words: str
) -> None:
    monkeypatch.chdir(tmp_path)
    folder = tmp_path / "folder"
    folder.mkdir()
    binary = tmp_path / "binary"
    binary.write_bytes(b"\xff\x00\x1b[31m" * 9)
    for place in (
        folder,
        tmp_path / "none",
        folder / "x" / "y",
        binary / "x",
        binary,
        Path("x" * 300),
        Path("\udcff"),
    ):
        ran = cli(*(str(place) if word == "PLACE" else word for word in words.split()))
        assert ran.code in {1, 2}, (place, ran.err)  # 1: what is looked at is found wrong
        assert "bug" not in ran.err
        assert "\x1b" not in ran.err + ran.out


@pytest.mark.parametrize("encoding", ["cp1252", "ascii", "utf-16"])
def test_an_output_in_another_encoding(encoding: str) -> None:
    arrow, times = (" → " if encoding == "utf-16" else " -> "), ("1.00x" if encoding == "ascii" else "1.00×")
    for words, sign in ((PRINTING[0], arrow), (("compare", "--goal", "ice"), times)):
        ran = run(*words, PYTHONIOENCODING=encoding)
        assert ran.returncode == 0, ran.stderr
        assert sign in ran.stdout.decode(encoding)
        assert "\\u2" not in ran.stdout.decode(encoding)  # a path may have letters that the encoding has not


def test_in_a_terminal_that_knows_ascii_alone() -> None:
    for words in (PRINTING[0], ("solve", "--goal", "é"), ("solve", "--all-goals", "--goal", "ice")):
        # without site: before 3.13 it reads the name of this folder, which may have any letters, as ASCII
        path = os.pathsep.join(sys.path)
        python = ("-S", "-X", "utf8=0")
        ran = run(*words, python=python, LC_ALL="C", PYTHONCOERCECLOCALE="0", PYTHONPATH=path)
        assert ran.returncode in {0, 2}
        assert b"bug" not in ran.stderr
        if "foon" not in words:  # data is UTF-8
            assert ran.stdout.isascii()
        assert ran.stderr.isascii()


@pytest.mark.parametrize(
    "words",
    [
        (b"solve", b"--goal", b"\xff"),
        (b"\xff",),
        (b"solve", b"--\xff"),
    ],
)
def test_words_that_are_no_text(words: tuple[bytes, ...]) -> None:
    ran = run(*words)
    assert ran.returncode == 2, ran.stderr
    assert b"udcff" in ran.stderr
    ran.stderr.decode()


@pytest.mark.slow
def test_files_whose_names_are_no_text(tmp_path: Path) -> None:
    folder = os.fsencode(tmp_path) + b"/\xff"
    shutil.copytree(ROOT / "data" / "kitchen", os.fsdecode(folder))
    questions, store = folder + b"/q.jsonl", folder + b"/a.foon"
    Path(os.fsdecode(questions)).write_text('{"goal": "ice", "kitchen": [null, "kitchen.json"]}')
    for words in (
        (b"solve", b"--goal", b"ice", b"--format", b"json"),
        (b"facts", b"--goal", b"ice", b"--constraint", b"forbid_motion"),
        (b"stats",),
        (b"solve", b"--goal", b"ice", b"--certificate", folder + b"/proof.json"),
        (b"merge", b"--store", store),
        *[(b"batch", questions, b"--results", folder + b"/a.jsonl")] * 2,
    ):
        ran = run(*words, b"--data", folder)
        assert ran.returncode == 0, ran.stderr
        (ran.stdout + ran.stderr).decode()
    assert run(b"solve", b"--goal", b"ice", b"--network", store).returncode == 0


# --- JSON of any shape

# A list of nodes, a network, an answer and a question: what is read as JSON.
_NODE = {"label": "a", "states": ["s"], "ingredients": ["b"], "container": "c"}
_UNIT = {"motion": "mix", "inputs": ["a"], "outputs": ["b; c"], "source": [{"file": "f", "line": 1}]}
_QUESTION = {
    "goal": "ice",
    "objective": "units",
    "containers": "strict",
    "kitchen": None,
    "time_limit": 1,
}
_DOCUMENTS: tuple[Any, ...] = (
    [_NODE],
    [{"input_nodes": [_NODE], "motion_node": "mix", "output_nodes": [_NODE]}],
    {"units": [_UNIT], "goals": ["b; c"], "status": "optimal"},
    _QUESTION,
)


def read_every_way(file: Path, text: str) -> None:
    """Read a text in every way that JSON is read."""
    file.write_bytes(text.encode("utf-8", "surrogatepass"))
    with contextlib.suppress(UserError):
        read_object_list(file)
    for lenient in (False, True):
        with contextlib.suppress(InputError):
            FoonReader(lenient).read_network([file])
        with contextlib.suppress(UserError):
            read_listed_tree(file, FoonReader(lenient))
    with contextlib.suppress(UserError):
        read_questions(file, None)
    with contextlib.suppress(RefusedError):
        read_certificate(text)


@settings(deadline=None, max_examples=60)
@given(text=damaged(_DOCUMENTS).map(json.dumps) | st.text(max_size=40))
@example("[" * 60_000 + "]" * 60_000)
@example('{"answer": {"units": ' + "[" * 60_000)
@example('{"goal": ' * 60_000)
@example("9" * 9_999)
def test_whatever_json_says_it_is_read_or_refused(
    tmp_path_factory: pytest.TempPathFactory, text: str
) -> None:
    read_every_way(tmp_path_factory.getbasetemp() / "any.json", text)


@settings(deadline=None, max_examples=25)
@given(lines=st.lists(damaged([_QUESTION]), min_size=1, max_size=2))
def test_whatever_a_batch_is_asked(tmp_path_factory: pytest.TempPathFactory, lines: list[Any]) -> None:
    folder = tmp_path_factory.mktemp("batch")
    (folder / "q.jsonl").write_text("".join(f"{json.dumps(line)}\n" for line in lines))
    (folder / "FOON.txt").write_text(UNIT)
    words = ["batch", str(folder / "q.jsonl"), "--results", str(folder / "a.jsonl"), "--data", str(folder)]
    said = io.StringIO()
    with (
        contextlib.redirect_stdout(said),
        contextlib.redirect_stderr(said),
        pytest.raises(SystemExit) as ended,
    ):
        main(words)
    assert ended.value.code in {0, 1, 2, 3}
    assert "bug" not in said.getvalue()
