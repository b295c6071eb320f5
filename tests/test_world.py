"""The world's faults are not bugs of ours: full disks, closed outputs, encodings, and whatever JSON holds."""

import contextlib
import io
import json
import os
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from foon_asp.batch.question_file import read_questions
from foon_asp.cli.main import main
from foon_asp.errors import UserError
from foon_asp.proof.verify import RefusedError, read_certificate
from foon_asp.text.answer_file import read_listed_tree
from foon_asp.text.diagnostics import InputError
from foon_asp.text.object_list import read_object_list
from foon_asp.text.reader import FoonReader
from tests.conftest import ROOT, Cli

pytestmark = pytest.mark.sampled(3)  # by default some cases of each test: there are many

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


# Text, a table, data and what click prints; the others are for the long run.
EACH_KIND = (0, 3, 4, 8)
PRINTING: list[tuple[str, ...]] = [
    ("solve", "--goal", "ice"),
    ("solve", "--goal", "ice", "--format", "json"),
    ("solve", "--goal", "ice", "--format", "foon"),
    ("compare", "--goal", "ice", "--search", "bfs"),
    ("facts", "--goal", "ice"),
    ("draw", "--goal", "ice"),
    ("certify", "--goal", "ice"),
    ("solve", "--help"),
    ("--version",),
]
PRINTED = [
    pytest.param(words, id=" ".join(words), marks=() if number in EACH_KIND else pytest.mark.slow)
    for number, words in enumerate(PRINTING)
]


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="there is no full disk to write to")
@pytest.mark.parametrize("words", PRINTED)
def test_a_full_disk(words: tuple[str, ...]) -> None:
    ran = run(*words, redirect=">/dev/full")
    assert ran.returncode == 2, ran.stderr
    assert b"standard output: cannot be written: No space left on device" in ran.stderr
    assert b"Traceback" not in ran.stderr
    assert b"Exception ignored" not in ran.stderr
    ran = run(*words, redirect=">/dev/full 2>/dev/full")
    assert ran.returncode == 2


@pytest.mark.parametrize("words", PRINTED)
@pytest.mark.sampled(3)
def test_closed_outputs(words: tuple[str, ...]) -> None:
    ran = run(*words, redirect=">&-")
    assert ran.returncode == 2, ran.stderr
    assert b"standard output: cannot be written: it is closed" in ran.stderr
    assert run(*words, redirect="2>&-").returncode == 0
    assert run(*words, redirect=">&- 2>&-").returncode == 2


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="there is no full disk to write to")
@pytest.mark.parametrize(
    "words",
    [
        ("certify", "--goal", "ice", "-o"),
        ("solve", "--goal", "ice", "--certificate"),
        ("draw", "--goal", "ice", "--format", "dot", "-o"),
        ("merge", "FILE", "-o"),
        ("convert", "FILE", "--to", "json", "-o"),
        ("fmt", "FILE", "-o"),
    ],
    ids=lambda words: words[0],
)
def test_a_file_on_a_full_disk(cli: Cli, tmp_path: Path, words: tuple[str, ...]) -> None:
    file = tmp_path / "a.txt"
    file.write_text(UNIT.replace("//\n", ""))
    given = [str(file) if word == "FILE" else word for word in words]
    ran = cli(*given, "/dev/full")
    assert (ran.code, "/dev/full: cannot be written: No space left on device" in ran.err) == (2, True)
    ran = cli(*given, tmp_path / "none" / "x.txt")
    assert ran.code == (0 if words[0] == "convert" else 2)  # which makes the folders that it needs
    ran = cli(*given, tmp_path / "a.txt" / "x.txt")
    assert (ran.code, "a.txt" in ran.err) == (2, True)


@pytest.mark.parametrize(
    "words",
    [
        ("stats", "--network", "PLACE"),
        ("solve", "--goal", "ice", "--kitchen", "PLACE"),
        ("solve", "--goal", "ice", "--rates", "PLACE"),
        ("solve", "--goal", "ice", "--utensils", "PLACE"),
        ("solve", "--goal", "ice", "--goals", "PLACE"),
        ("solve", "--goal", "ice", "--constraint", "PLACE"),
        ("solve", "--goal", "ice", "--encodings", "PLACE"),
        ("verify", "PLACE"),
        ("check", "PLACE", "--goal", "ice"),
        ("draw", "--tree", "PLACE"),
        ("certify", "--goal", "ice", "--tree", "PLACE"),
        ("batch", "PLACE", "--results", "x.jsonl"),
        ("shell", "PLACE"),
        ("assist", "--goal", "ice", "--person", "PLACE"),
        ("shopping-list", "--goal", "ice", "--prices", "PLACE"),
        ("lint", "PLACE"),
        ("fmt", "PLACE"),
        ("rename", "a", "b", "PLACE"),
        ("merge", "PLACE"),
        ("convert", "PLACE", "--to", "json"),
        ("import", "PLACE", "--store", "x.foon"),
    ],
    ids=lambda words: f"{words[0]} {words[-2]}",
)
def test_a_folder_or_nothing_in_the_place_of_a_file(
    cli: Cli, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, words: tuple[str, ...]
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
        ran = cli(*(str(place) if word == "PLACE" else word for word in words))
        assert ran.code in {1, 2}, (place, ran.err)  # 1: what is looked at is found wrong
        assert "bug" not in ran.err
        assert "\x1b" not in ran.err + ran.out


@pytest.mark.slow
@pytest.mark.parametrize("encoding", ["cp1252", "ascii", "latin-1", "utf-16", "cp437"])
@pytest.mark.parametrize("words", PRINTING[:7], ids=" ".join)
def test_an_output_in_another_encoding(words: tuple[str, ...], encoding: str) -> None:
    ran = run(*words, PYTHONIOENCODING=encoding)
    assert ran.returncode == 0, ran.stderr
    if "json" in words:
        assert json.loads(ran.stdout.decode(encoding))["status"] == "optimal"
    if words == PRINTING[0]:
        text = ran.stdout.decode(encoding)
        assert ("→" if encoding == "utf-16" else "->") in text


@pytest.mark.parametrize("encoding", ["cp1252", "ascii"])
def test_an_output_without_arrows(encoding: str) -> None:
    for words, sign in ((PRINTING[0], b" -> "), (("compare", "--goal", "ice"), b"-----")):
        ran = run(*words, PYTHONIOENCODING=encoding)
        assert ran.returncode == 0, ran.stderr
        assert sign in ran.stdout
        assert b"\\u" not in ran.stdout


def test_in_a_terminal_that_knows_ascii_alone() -> None:
    for words in (PRINTING[0], ("solve", "--goal", "é"), ("optima", "--goal", "ice")):
        ran = run(*words, python=("-X", "utf8=0"), LC_ALL="C", PYTHONCOERCECLOCALE="0")
        assert ran.returncode in {0, 2}
        assert b"bug" not in ran.stderr
        if "foon" not in words:  # data is UTF-8
            assert ran.stdout.isascii()
        assert ran.stderr.isascii()


@pytest.mark.parametrize(
    "words",
    [
        (b"solve", b"--goal", b"\xff"),
        (b"solve", b"--goal", b"ice", b"--constraint", b"\xff"),
        (b"stats", b"--network", b"\xff"),
        (b"\xff",),
        (b"solve", b"--\xff"),
        (b"solve", b"--goal", b"ice", b"--objective", b"\xff"),
    ],
)
def test_words_that_are_no_text(words: tuple[bytes, ...]) -> None:
    ran = run(*words)
    assert ran.returncode == 2, ran.stderr
    assert b"udcff" in ran.stderr
    ran.stderr.decode()


@pytest.mark.slow
def test_files_whose_names_are_no_text(tmp_path: Path) -> None:
    for file in (ROOT / "data" / "kitchen").iterdir():
        (tmp_path / file.name).write_bytes(file.read_bytes())
    folder = os.fsencode(tmp_path) + b"/\xff"
    os.mkdir(folder)
    for file in tmp_path.iterdir():
        if file.is_file():
            Path(os.fsdecode(folder + b"/" + os.fsencode(file.name))).write_bytes(file.read_bytes())
    for words in (
        (b"solve", b"--goal", b"ice"),
        (b"solve", b"--goal", b"ice", b"--format", b"json"),
        (b"solve", b"--goal", b"ice", b"--constraint", b"forbid_motion", b"-c", b"forbidden_motion=fry"),
        (b"alternatives", b"--goal", b"ice"),
        (b"facts", b"--goal", b"ice", b"--constraint", b"forbid_motion"),
        (b"stats",),
        (b"draw", b"--goal", b"ice"),
        (b"certify", b"--goal", b"ice"),
    ):
        ran = run(*words, b"--data", folder)
        assert ran.returncode == 0, ran.stderr
        (ran.stdout + ran.stderr).decode()
    store = folder + b"/a.foon"
    assert run(b"import", b"--data", folder, b"--store", store).returncode == 0
    assert run(b"solve", b"--goal", b"ice", b"--network", store).returncode == 0
    questions = folder + b"/q.jsonl"
    Path(os.fsdecode(questions)).write_text('{"goal": "ice", "kitchen": [null, "kitchen.json"]}')
    for _ in range(2):
        ran = run(b"batch", questions, b"--results", folder + b"/a.jsonl", b"--data", folder)
        assert ran.returncode == 0, ran.stderr


@pytest.mark.parametrize(
    "words", [("stats",), ("solve", "--goal", "ice"), ("optima",), ("compare", "--goal", "ice")]
)
def test_in_a_narrow_pipe_without_colours(words: tuple[str, ...]) -> None:
    ran = run(*words, NO_COLOR="1", COLUMNS="60", FORCE_COLOR="")
    assert (ran.returncode, b"\x1b" in ran.stdout) == (0, False)
    assert ran.stdout


# --- JSON of any shape

_hostile: st.SearchStrategy[Any] = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(),
    st.floats(),
    st.text(max_size=9),
    st.sampled_from(
        [10**400, -(10**19), "\ud800", "\x00", "a\nb", "1e999999999", "@goals", "@x", "in [", "/dev", ""]
    ),
)
_KEYS = (
    "goal objective containers kitchen time_limit label object_label states object_states ingredients "
    "container input_nodes output_nodes motion_node motion_label functional_units source units answer goals "
    "status inputs outputs motion file line state_label relative_object object_id cuts tree format"
)
_keys = st.sampled_from(_KEYS.split())
_values = st.recursive(
    _hostile,
    lambda part: st.lists(part, max_size=4) | st.dictionaries(_keys | st.text(max_size=3), part, max_size=5),
)
_node = st.fixed_dictionaries(
    {"label": st.just("a") | _values},
    optional={"states": _values, "ingredients": _values, "container": _values},
)
_unit = st.fixed_dictionaries(
    {
        "input_nodes": st.lists(_node, max_size=2) | _values,
        "motion_node": st.just("mix") | _values,
        "output_nodes": st.lists(_node, max_size=2) | _values,
    }
)
_answer = st.fixed_dictionaries(
    {
        "units": st.lists(
            st.fixed_dictionaries(
                {
                    "motion": st.just("mix") | _values,
                    "inputs": st.lists(st.sampled_from(["a", "b; c"])) | _values,
                    "outputs": st.lists(st.just("a")) | _values,
                    "source": st.just([{"file": "f", "line": 1}])
                    | st.lists(st.fixed_dictionaries({"file": _values, "line": _values}), max_size=2)
                    | _values,
                }
            ),
            max_size=2,
        )
        | _values
    },
    optional={"goals": _values, "status": _values},
)
_question = st.fixed_dictionaries(
    {"goal": st.just("ice") | _values},
    optional={"objective": _values, "containers": _values, "kitchen": _values, "time_limit": _values},
)
_texts = st.one_of(
    st.one_of(_values, st.lists(_unit, max_size=3), st.lists(_node, max_size=3), _answer, _question).map(
        json.dumps
    ),
    st.text(max_size=40),
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


@pytest.mark.slow
@settings(deadline=None, max_examples=150)
@given(text=_texts)
def test_whatever_json_says_it_is_read_or_refused(
    tmp_path_factory: pytest.TempPathFactory, text: str
) -> None:
    read_every_way(tmp_path_factory.getbasetemp() / "any.json", text)


@pytest.mark.parametrize(
    "start", ["", '{"units":', '{"goal":', '{"answer":{"units":', '{"functional_units":', '[{"label":']
)
@pytest.mark.parametrize("inside", ["[" * 60_000, "[" * 60_000 + "]" * 60_000, '{"a":' * 60_000, "9" * 9_999])
def test_json_without_end(tmp_path: Path, start: str, inside: str) -> None:
    for end in ("", "}" * start.count("{") + "]" * start.count("[")):
        read_every_way(tmp_path / "any.json", start + inside + end)


@settings(deadline=None, max_examples=25)
@given(lines=st.lists(_question | _values, min_size=1, max_size=2))
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


@pytest.mark.parametrize("seconds", ["nan", "inf", "-inf", "1e300", "1e10", "-1", "x", "1e-300", "0"])
@pytest.mark.parametrize("verb", ["solve", "alternatives", "certify"])
def test_any_time_limit(cli: Cli, verb: str, seconds: str) -> None:
    ran = cli(verb, "--goal", "ice", "--time-limit", seconds)
    assert ran.code in {0, 2, 3}, ran.err
    assert "bug" not in ran.err
