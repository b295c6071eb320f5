"""No file of a user's is destroyed: what is written over is what was meant, and it is whole or not at all."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import pytest

from foon_asp.compare.results_file import ResultsFile, comparison_json, read_comparison
from foon_asp.errors import UserError
from foon_asp.report.whole_file import write_whole
from foon_asp.resources import bundled_kitchen
from tests.conftest import Cli

pytestmark = pytest.mark.sampled(3)  # by default some cases of each test: there are many

UNIT = "O\ta\nM\tmix\nO\tb\n//\n"
QUESTION = '{"goal": "ice"}'
FOREIGN = {
    "a line without an end": b"shopping: milk, eggs",
    "a line": b"shopping: milk, eggs\n",
    "two lines, the last without an end": b"milk\neggs",
    "minified JSON": b'{"question":1,"answers":[1,2,3]}',
    "JSON with another key first": b'{"question": {"data": "x"}, "goal": "ice"}\n',
    "a question": QUESTION.encode(),
    "questions": f"{QUESTION}\n{QUESTION}\n".encode(),
    "no text": bytes(range(256)) * 3,
    "zeros": bytes(100),
    "a brace": b"{",
    "a number": b"17",
    "null": b"null\n",
    "brackets": b"[" * 100_000,
    "digits": b"9" * 10_000 + b"\n",
    "an end alone": b"\n",
}


@pytest.fixture
def questions(tmp_path: Path) -> Path:
    file = tmp_path / "questions.jsonl"
    file.write_text(QUESTION)
    return file


def begin(cli: Cli, verb: str, questions: Path, results: Path) -> tuple[int, str, str]:
    """Run a verb that keeps results."""
    if verb == "batch":
        return cli("batch", questions, "--results", results)
    return cli("compare", "--goal", "ice", "--search", "bfs", "--results", results)


@pytest.mark.parametrize("content", FOREIGN.values(), ids=FOREIGN)
@pytest.mark.parametrize("verb", ["batch", "compare"])
def test_results_are_kept_in_files_of_ours_alone(
    cli: Cli, questions: Path, tmp_path: Path, verb: str, content: bytes
) -> None:
    file = tmp_path / "mine"
    file.write_bytes(content)
    ran = begin(cli, verb, questions, file)
    assert ran[0] == 2
    assert "results of foon-asp" in ran[2]
    assert file.read_bytes() == content


@pytest.mark.slow
@pytest.mark.parametrize("verb", ["batch", "compare"])
def test_what_is_begun_or_cut_short_is_gone_on_with(
    cli: Cli, questions: Path, tmp_path: Path, verb: str
) -> None:
    file = tmp_path / "results"
    file.touch()
    assert begin(cli, verb, questions, file)[0] == 0
    whole = file.read_bytes()
    head, row, end = whole.split(b"\n")
    assert not end
    for cut in (b"", head + b"\n", head + b"\n" + row[:-1], head + b"\n" + row):
        file.write_bytes(cut)
        assert begin(cli, verb, questions, file)[0] == 0
        lines = file.read_bytes().split(b"\n")
        assert (lines[0], len(lines), lines[2]) == (head, 3, b"")
        assert json.loads(lines[1])["goal"] == json.loads(row)["goal"]


ROWS = [
    "7",
    "[]",
    "null",
    "{}",
    '"goal"',
    '{"goal": 7}',
    QUESTION,
    '{"goal": ["ice"], "objective": [], "containers": {}, "kitchen": 7, "time_limit": "x", "status": "x"}',
    "[" * 50_000 + "]" * 50_000,
    "9" * 9_000,
    "NaN",
    "\udcff",
    "",
]


@pytest.mark.parametrize("row", ROWS, ids=range(len(ROWS)))
@pytest.mark.parametrize("verb", ["batch", "compare"])
@pytest.mark.sampled(12)
def test_rows_of_another_make_no_file_of_ours(
    cli: Cli, questions: Path, tmp_path: Path, verb: str, row: str
) -> None:
    file = tmp_path / "results"
    begin(cli, verb, questions, file)
    head, ours, _ = file.read_bytes().split(b"\n")
    content = b"\n".join([head, row.encode("utf-8", "surrogateescape"), ours, b""])
    file.write_bytes(content)
    ran = begin(cli, verb, questions, file)
    assert ran[0] == 2
    assert ":2: error: not a line of results" in ran[2]
    assert file.read_bytes() == content


@pytest.mark.parametrize("verb", ["batch", "compare"])
@pytest.mark.parametrize("place", [0, 1])
def test_results_of_another_version_are_refused(
    cli: Cli, questions: Path, tmp_path: Path, verb: str, place: int
) -> None:
    file = tmp_path / "results"
    assert begin(cli, verb, questions, file)[0] == 0
    lines = file.read_text().splitlines(keepends=True)
    name = f"foon-asp/{verb}-row/"
    assert all(json.loads(line)["schema"] == f"{name}1" for line in lines)
    lines[place] = lines[place].replace(f"{name}1", f"{name}2")
    file.write_text(content := "".join(lines))
    ran = begin(cli, verb, questions, file)
    assert ran[0] == 2
    assert (
        f":{place + 1}: error: found results of foon-asp in the version '{name}2', expected '{name}1'"
        in ran[2]
    )
    assert file.read_text() == content


def test_parts_of_another_version_are_refused(cli: Cli, questions: Path, tmp_path: Path) -> None:
    pytest.importorskip("pyarrow")
    parquet = pytest.importorskip("pyarrow.parquet")
    folder = tmp_path / "answers.parquet"
    assert cli("batch", questions, "--results", folder).code == 0
    part = folder / "part-000000.parquet"
    table = parquet.read_table(part, partitioning=None)
    assert set(table.column("schema").to_pylist()) == {"foon-asp/batch-row/1"}
    other = table.set_column(0, "schema", [["foon-asp/batch-row/2"] * len(table)])
    parquet.write_table(other, part)
    ran = cli("batch", questions, "--results", folder)
    assert ran.code == 2
    assert "not a part of results of foon-asp" in ran.err


WRONG: list[Any] = [-1.5, True, [], [[]], {}, {"x": 1}, float("nan"), 7]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("verb", "keys"),
    [
        ("batch", ("goal", "objective", "containers", "kitchen", "time_limit", "status")),
        ("compare", ("goal", "containers", "level", "optimum", "searches")),
    ],
)
def test_any_value_of_a_row_may_be_wrong(
    cli: Cli, questions: Path, tmp_path: Path, verb: str, keys: tuple[str, ...]
) -> None:
    file = tmp_path / "results"
    begin(cli, verb, questions, file)
    head, ours = file.read_text().splitlines()
    row = json.loads(ours)
    may_be: dict[str, list[Any]] = {
        "time_limit": [7],
        "searches": [[]],
        "optimum": [{}],
    }  # nothing is wrong with these

    def refused(value: dict[str, Any]) -> None:
        content = f"{head}\n{json.dumps(value)}\n"
        file.write_text(content)
        ran = begin(cli, verb, questions, file)
        assert (ran[0], "not a line of results" in ran[2]) == (2, True), value
        assert file.read_text() == content

    for key in keys:
        refused({other: value for other, value in row.items() if other != key})
        for value in WRONG:
            if value not in may_be.get(key, []):
                refused(row | {key: value})
    refused(row | {"more": 1})


@pytest.mark.parametrize("wrong", [*WRONG, "1e999999999", "x", ["1", "2"], {"units": 1}, None])
def test_any_value_of_a_comparison_may_be_wrong(cli: Cli, tmp_path: Path, wrong: Any) -> None:
    file = tmp_path / "results"
    assert begin(cli, "compare", file, file)[0] == 0
    row = json.loads(file.read_text().splitlines()[1])
    assert row.pop("schema") == "foon-asp/compare-row/1"
    assert comparison_json(read_comparison(row)) == row
    for part in (row["searches"][0], row["optimum"]["units"]):
        for key, value in list(part.items()):
            names = ["x", "1e999999999"]
            may_be: dict[str, list[Any]] = {"search": names, "stuck_at": [*names, None], "obstacle": [None]}
            may_be |= {
                "value": [None],
                "units": [None, []],
                "verdict": [None],
                "order": [[]],
                "measures": [{}],
                "breaks": [["1", "2"]],
            }
            if wrong in may_be.get(key, []) or wrong == value:
                continue
            part[key] = wrong
            with pytest.raises((ValueError, KeyError, TypeError, AttributeError, ArithmeticError)):
                read_comparison(row)
            part[key] = value


def test_results_are_no_folder_pipe_or_device(cli: Cli, questions: Path, tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    for place in (tmp_path, tmp_path / "pipe", Path("/dev/null"), Path("/dev/full")):
        for verb in ("batch", "compare"):
            code, _, err = begin(cli, verb, questions, place)
            assert (code, "is not a file in which results can be kept" in err) == (2, True)
    assert cli("batch", questions, "--results", questions / "x").code == 2


def test_results_are_not_kept_in_a_file_that_is_read(cli: Cli, questions: Path, tmp_path: Path) -> None:
    empty = tmp_path / "utensils.txt"
    empty.touch()
    ran = cli("batch", questions, "--results", empty, "--data", bundled_kitchen(), "--utensils", empty)
    assert (ran.code, empty.read_bytes()) == (2, b"")
    assert "is read by this command" in ran.err


def test_parquet_of_others_stays(cli: Cli, questions: Path, tmp_path: Path) -> None:
    pyarrow = pytest.importorskip("pyarrow")
    parquet = pytest.importorskip("pyarrow.parquet")
    table = pyarrow.table({"goal": ["ice"], "price": [3]})
    file = tmp_path / "mine.parquet"
    parquet.write_table(table, file)
    folders = []
    for number, name in enumerate(("part-000000.parquet", "part-00000-a.parquet", "x.txt")):
        folder = tmp_path / f"{number}.parquet"
        folder.mkdir()
        parquet.write_table(table, folder / name)
        folders.append(folder)
    ours = tmp_path / "ours.parquet"
    assert cli("batch", questions, "--results", ours).code == 0
    assert cli("batch", questions, "--results", ours).code == 0
    parquet.write_table(table, ours / "part-000001.parquet")
    before = {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()}
    for place in (file, *folders, ours):
        ran = cli("batch", questions, "--results", place)
        assert ran.code == 2, place
        assert "bug" not in ran.err
    assert before == {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()}


# --- files that are written whole


def test_a_link_stays_a_link_and_permissions_stay(tmp_path: Path) -> None:
    target, link = tmp_path / "folder" / "target.txt", tmp_path / "link.txt"
    target.parent.mkdir()
    target.write_text("old")
    target.chmod(0o640)
    link.symlink_to(target)
    write_whole(link, b"new")
    assert link.is_symlink()
    assert (target.read_bytes(), target.stat().st_mode & 0o777) == (b"new", 0o640)
    dangling = tmp_path / "dangling.txt"
    dangling.symlink_to(tmp_path / "folder" / "new.txt")
    write_whole(dangling, b"new")
    assert dangling.is_symlink()
    assert (tmp_path / "folder" / "new.txt").read_bytes() == b"new"
    assert sorted(path.name for path in tmp_path.rglob("*")) == [
        "dangling.txt",
        "folder",
        "link.txt",
        "new.txt",
        "target.txt",
    ]


def test_a_new_file_has_the_usual_permissions(tmp_path: Path) -> None:
    before = os.umask(0o027)
    try:
        write_whole(tmp_path / "new.txt", b"new")
    finally:
        os.umask(before)
    assert (tmp_path / "new.txt").stat().st_mode & 0o777 == 0o640


def test_a_ring_of_links_a_folder_and_a_name_that_is_too_long(tmp_path: Path) -> None:
    (tmp_path / "one").symlink_to("two")
    (tmp_path / "two").symlink_to("one")
    for name in ("one", ".", "x" * 300, "none/x"):
        with pytest.raises(UserError, match="cannot be written"):
            write_whole(tmp_path / name, b"new")
    assert (tmp_path / "one").is_symlink()
    assert sorted(os.listdir(tmp_path)) == ["one", "two"]


def test_a_write_that_fails_leaves_the_old_file_and_nothing_else(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "a.txt"
    file.write_text("old")

    def full(_: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("foon_asp.report.whole_file.os.fsync", full)
    with pytest.raises(UserError, match=r"a\.txt: cannot be written: No space left on device"):
        write_whole(file, b"new")
    assert file.read_text() == "old"
    assert os.listdir(tmp_path) == ["a.txt"]


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write everything")
def test_a_protected_file_is_not_replaced(tmp_path: Path) -> None:
    file = tmp_path / "a.txt"
    file.write_text("old")
    file.chmod(0o444)
    with pytest.raises(UserError, match="cannot be written: Permission denied"):
        write_whole(file, b"new")
    assert file.read_text() == "old"


def test_a_killed_write_leaves_the_old_file(tmp_path: Path) -> None:
    file = tmp_path / "a.txt"
    file.write_bytes(b"o" * 30_000_000)
    code = (
        "import sys; from pathlib import Path; from foon_asp.report.whole_file import write_whole\n"
        "content = b'n' * 30_000_000; print('now', flush=True)\n"
        "while True: write_whole(Path(sys.argv[1]), content)"
    )
    for pause in (0.0, 0.004, 0.03):
        with subprocess.Popen([sys.executable, "-c", code, str(file)], stdout=subprocess.PIPE) as running:
            assert running.stdout is not None
            running.stdout.readline()
            time.sleep(pause)
            running.send_signal(signal.SIGKILL)
        assert file.read_bytes() in {b"o" * 30_000_000, b"n" * 30_000_000}


# --- no command writes over what it reads


def test_convert_onto_its_own_source(cli: Cli, tmp_path: Path) -> None:
    file, link, twin = tmp_path / "a.txt", tmp_path / "link.txt", tmp_path / "twin.txt"
    lossy = "# mine\nO1\ta\nM2\tmix\nO3\tb\n//\n"
    file.write_text(lossy)
    link.symlink_to(file)
    twin.hardlink_to(file)
    for name in (file, link, twin):
        ran = cli("convert", file, "--to", "plain", "-o", name)
        assert ran.code == 2
        assert "would be overwritten by a file without its ids" in ran.err
        assert file.read_text() == lossy
    ran = cli("convert", file, "--to", "ids", "-o", file)
    assert ran.code == 0
    assert "nothing is lost" in ran.err
    file.write_text(UNIT + "nonsense\n" + UNIT)
    before = file.read_text()
    ran = cli("convert", file, "--to", "json", "--lenient", "-o", file)
    assert ran.code == 2, ran.err
    assert file.read_text() == before


def test_merge_onto_one_of_its_files(cli: Cli, tmp_path: Path) -> None:
    one, two, twin = tmp_path / "1.txt", tmp_path / "2.txt", tmp_path / "twin.txt"
    for file in (one, two):
        file.write_text(UNIT)
    twin.hardlink_to(two)
    for name in (one, two, twin):
        ran = cli("merge", one, two, "-o", name)
        assert (ran.code, "one of the files to merge" in ran.err) == (2, True)
        assert name.read_text() == UNIT


@pytest.mark.parametrize(
    "words",
    [
        ("certify", "-o", "FILE"),
        ("draw", "--format", "dot", "-o", "FILE"),
        ("solve", "--certificate", "FILE"),
        ("compare", "--search", "bfs", "--results", "FILE"),
        ("shell",),
    ],
    ids=lambda words: words[0],
)
def test_an_answer_is_not_written_over_the_data(
    cli: Cli, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, words: tuple[str, ...]
) -> None:
    monkeypatch.chdir(tmp_path)
    for file in bundled_kitchen().iterdir():
        (tmp_path / file.name).write_bytes(file.read_bytes())
    (tmp_path / "mine.lp").write_text(':- use(U), motion(U,"fry").\n')
    (tmp_path / "other.txt").write_text("O\twater\n")
    before = {path: path.read_bytes() for path in tmp_path.iterdir()}
    network = next(name for name in ("FOON.txt", "foon.txt") if (tmp_path / name).exists())
    for name in (network, "kitchen.json", "motion.txt", "mine.lp", "other.txt"):
        if words == ("shell",):
            lines = ["kitchen other.txt", "constraint mine.lp", f"certify --goal ice -o {name}"]
            script = tmp_path.parent / "script.txt"
            script.write_text("\n".join(lines))
            ran = cli("shell", script, "--data", tmp_path)
        else:
            if name == "mine.lp" and words[0] in {"draw", "compare"}:
                continue
            given = ["--constraint", "mine.lp"] if words[0] not in {"draw", "compare"} else []
            kitchen = ["--kitchen", "other.txt"] if name == "other.txt" else []
            ran = cli(
                *(name if w == "FILE" else w for w in words), "--goal", "ice", "--data", ".", *given, *kitchen
            )
        assert (ran.code, "is read by this command" in ran.err) == (2, True), (name, ran)
        assert before == {path: path.read_bytes() for path in tmp_path.iterdir()}


@pytest.mark.parametrize("verb", ["pareto", "compare"])
def test_a_chart_is_not_drawn_over_the_data(cli: Cli, tmp_path: Path, verb: str) -> None:
    network = tmp_path / "FOON.svg"
    network.write_text(UNIT)
    ran = cli(verb, "--network", network, "--goal", "b", "--chart", network)
    assert (ran.code, network.read_text()) == (2, UNIT)
    assert "is read by this command" in ran.err


def test_a_store_is_written_through_its_link(cli: Cli, tmp_path: Path) -> None:
    (tmp_path / "FOON.txt").write_text(UNIT)
    link = tmp_path / "link.foon"
    link.symlink_to(tmp_path / "real.foon")
    for _ in range(2):
        assert cli("import", tmp_path / "FOON.txt", "--store", link).code == 0
        assert link.is_symlink()
        (tmp_path / "real.foon").chmod(0o600)
    assert (tmp_path / "real.foon").stat().st_mode & 0o777 == 0o600
    leftover = tmp_path / ".real.foon.partial"
    leftover.write_text("mine")
    ran = cli("import", tmp_path / "FOON.txt", "--store", link)
    assert (ran.code, leftover.read_text()) == (2, "mine")
    assert "is in the way" in ran.err


def test_results_that_cannot_be_written_are_no_bug(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = tmp_path / "a.jsonl"

    def full(_: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("foon_asp.compare.rows_file.os.fsync", full)
    with pytest.raises(UserError, match=r"a\.jsonl: cannot be written: No space left on device"):
        ResultsFile(file, {})
    assert file.read_bytes() == b""
