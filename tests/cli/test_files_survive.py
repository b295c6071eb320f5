"""No file of a user's is destroyed: what is written over is what was meant, and it is whole or not at all."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import click
import pytest

import foon_asp
from foon_asp.cli.named_path import WrittenPath
from foon_asp.cli.verbs import VERBS, verb_command
from foon_asp.errors import UserError
from foon_asp.whole_file import write_all_whole, write_whole
from tests.conftest import Cli

UNIT = "O\ta\nM\tmix\nO\tb\n//\n"
QUESTION = '{"goal": "ice"}'
FOREIGN = {
    "a line without an end": b"shopping: milk, eggs",
    "two lines, the last without an end": b"milk\neggs",
    "minified JSON": b'{"question":1,"answers":[1,2,3]}',
    "JSON with another key first": b'{"question": {"data": "x"}, "goal": "ice"}\n',
    "questions": f"{QUESTION}\n{QUESTION}\n".encode(),
    "no text": bytes(range(256)) * 3,
    "brackets": b"[" * 100_000,
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


@pytest.mark.parametrize("verb", ["batch", "compare"])
@pytest.mark.parametrize("line", [1, 2])
def test_results_of_another_version_are_refused(
    cli: Cli, questions: Path, tmp_path: Path, verb: str, line: int
) -> None:
    file = tmp_path / "results"
    assert begin(cli, verb, questions, file)[0] == 0
    ours, other = f"foon-asp/{verb}-row/1", f"foon-asp/{verb}-row/2"
    lines = file.read_text().splitlines(keepends=True)
    lines[line - 1] = lines[line - 1].replace(ours, other)
    file.write_text(content := "".join(lines))
    ran = begin(cli, verb, questions, file)
    said = f":{line}: error: found results of foon-asp in the version '{other}', expected '{ours}'"
    assert (ran[0], said in ran[2], file.read_text()) == (2, True, content)


@pytest.mark.parametrize("verb", ["batch", "compare"])
def test_rows_of_another_make_no_file_of_ours(cli: Cli, questions: Path, tmp_path: Path, verb: str) -> None:
    file = tmp_path / "results"
    begin(cli, verb, questions, file)
    head, ours = file.read_text().splitlines()
    row = json.loads(ours)
    rows = ["7", "{}", "", QUESTION, "[" * 50_000 + "]" * 50_000, "\udcff"]
    parts = [row] if verb == "batch" else [row, row["searches"][0], row["optimum"]["units"]]
    for part in parts:
        for key in {*part} - {"schema"} if verb == "compare" else ("goal", "objective", "kitchen", "status"):
            value, part[key] = part[key], {"x": 1}
            rows.append(json.dumps(row))
            part[key] = value
    for wrong in rows:
        content = f"{head}\n{wrong}\n{ours}\n".encode("utf-8", "surrogateescape")
        file.write_bytes(content)
        ran = begin(cli, verb, questions, file)
        assert (ran[0], ":2: error: not a line of results" in ran[2]) == (2, True), wrong[:99]
        assert file.read_bytes() == content


def test_results_are_no_folder_pipe_or_device(cli: Cli, questions: Path, tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    for place in (tmp_path, tmp_path / "pipe", Path("/dev/null"), Path("/dev/full")):
        for verb in ("batch", "compare"):
            code, _, err = begin(cli, verb, questions, place)
            assert (code, "is not a file in which results can be kept" in err) == (2, True)
    assert cli("batch", questions, "--results", questions / "x").code == 2


@pytest.mark.parametrize("suffix", ["csv", "parquet"])
def test_tables_of_others_stay(cli: Cli, questions: Path, tmp_path: Path, suffix: str) -> None:
    if suffix == "parquet":
        pytest.importorskip("pyarrow")
    file, folder = tmp_path / f"mine.{suffix}", tmp_path / f"theirs.{suffix}"
    file.write_text("eggs\n")
    folder.mkdir()
    for place in (file, folder):
        ran = cli("batch", questions, "--results", place)
        assert (ran.code, "was not changed; name another file" in ran.err) == (2, True)
    assert file.read_text() == "eggs\n"
    assert sorted(tmp_path.iterdir()) == sorted([file, folder, questions])


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
    before = os.umask(0o027)
    try:
        write_whole(tmp_path / "fresh.txt", b"new")
    finally:
        os.umask(before)
    assert (tmp_path / "fresh.txt").stat().st_mode & 0o777 == 0o640
    dangling = tmp_path / "dangling.txt"
    dangling.symlink_to(tmp_path / "folder" / "new.txt")
    write_whole(dangling, b"new")
    assert dangling.is_symlink()
    assert (tmp_path / "folder" / "new.txt").read_bytes() == b"new"
    assert sorted(path.name for path in tmp_path.rglob("*")) == [
        "dangling.txt",
        "folder",
        "fresh.txt",
        "link.txt",
        "new.txt",
        "target.txt",
    ]


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

    monkeypatch.setattr("foon_asp.whole_file.os.fsync", full)
    with pytest.raises(UserError, match=r"a\.txt: cannot be written: No space left on device"):
        write_whole(file, b"new")
    assert file.read_text() == "old"
    assert os.listdir(tmp_path) == ["a.txt"]


def test_a_killed_write_leaves_the_old_file(tmp_path: Path) -> None:
    file = tmp_path / "a.txt"
    file.write_bytes(b"o" * 30_000_000)
    code = (
        "import sys; from pathlib import Path; from foon_asp.whole_file import write_whole\n"
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


@pytest.mark.skipif(os.geteuid() != 0, reason="only root may give files away")
def test_a_replaced_file_keeps_its_owner(cli: Cli, tmp_path: Path) -> None:
    source, file = tmp_path / "a.txt", tmp_path / "b.foon"
    source.write_text(UNIT)
    assert cli("merge", source, "--store", file).code == 0
    for replaced, words in ((file, ["merge", source, "--store", file]), (source, ["fmt", source])):
        source.write_text(UNIT.removesuffix("//\n"))
        replaced.chmod(0o640)
        os.chown(replaced, 1234, 2345)
        assert cli(*words).code == 0
        found = replaced.stat()
        assert (found.st_uid, found.st_gid, found.st_mode & 0o777) == (1234, 2345, 0o640)
    assert source.read_text() == UNIT


def test_a_hard_link_that_is_split_is_said(cli: Cli, tmp_path: Path) -> None:
    file, twin = tmp_path / "a.txt", tmp_path / "twin.txt"
    file.write_text(old := UNIT.removesuffix("//\n"))
    twin.hardlink_to(file)
    ran = cli("fmt", file)
    assert (ran.code, file.read_text(), twin.read_text()) == (0, UNIT, old)
    warning = f"warning: {file}: the file had another name (hard links), under which the old content stays"
    assert warning in ran.err.splitlines()
    file.write_text(old)
    assert "warning" not in cli("fmt", file).err
    (tmp_path / "third.txt").hardlink_to(twin)
    with pytest.warns(foon_asp.FoonWarning, match="another name"):
        write_whole(twin, b"new")


def test_what_a_kill_left_is_cleared_and_nothing_else(tmp_path: Path) -> None:
    stay = [".foon-asp.mine", ".foon-asp.0123456789abcdef0", ".foon-asp.folder0000000000", "0123456789abcdef"]
    for name in stay:
        (tmp_path / name).write_text("mine")
    target = tmp_path / ".foon-asp.cccccccccccccccc"
    target.symlink_to(tmp_path / stay[0])
    os.mkfifo(tmp_path / ".foon-asp.dddddddddddddddd")
    code = (
        "import os, signal, sys; from pathlib import Path; from foon_asp import whole_file\n"
        "def hold(_):\n    print('written', flush=True); signal.pause()\n"
        "whole_file.os.fsync = hold; whole_file.write_whole(Path(sys.argv[1]), b'theirs')"
    )
    before = {path.name for path in tmp_path.iterdir()}
    writers = [
        subprocess.Popen([sys.executable, "-c", code, str(tmp_path / name)], stdout=subprocess.PIPE)
        for name in ("killed.txt", "living.txt")
    ]
    for writer in writers:
        assert writer.stdout is not None
        writer.stdout.readline()
    assert len(list(tmp_path.iterdir())) == len(before) + 2
    writers[0].kill()
    writers[0].wait()
    write_whole(tmp_path / "new.txt", b"new")
    (theirs,) = {path.name for path in tmp_path.iterdir()} - before - {"new.txt"}
    assert (tmp_path / theirs).read_bytes() == b"theirs"
    writers[1].kill()
    for writer in writers:
        writer.communicate()


def test_files_that_are_written_together_are_as_they_were_after_ctrl_c(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    files = [tmp_path / f"{name}.txt" for name in "abc"]
    for file in files:
        file.write_text("old")
    replace = Path.replace

    def struck(partial: Path, target: Path) -> Path:
        if target == files[1]:
            monkeypatch.setattr(Path, "replace", replace)
            raise KeyboardInterrupt
        return replace(partial, target)

    monkeypatch.setattr(Path, "replace", struck)
    with pytest.raises(KeyboardInterrupt):
        write_all_whole(dict.fromkeys(files, b"new"))
    assert [file.read_text() for file in files] == ["old"] * 3
    assert len(list(tmp_path.iterdir())) == 3


# --- no command writes over what it reads


SUFFIXES = {"align": ".txt", "view": ".html", "diff": ".html"}
WEIGHTED = {"soft", "weights"}
WRITERS = {
    verb: command
    for verb, command in ((verb, verb_command(verb)) for verb in VERBS)
    if any(isinstance(each.type, WrittenPath) for each in command.params)
    and verb != "fmt"  # which is in place
}


def asked(verb: str, folder: Path) -> tuple[list[str], list[Path]]:
    """Make a file for each parameter of a verb that names one; return the words, and the files."""
    options, positional, files = [verb], [], []
    for each in WRITERS[verb].params:
        lp = each.name in {"constraints", "measures", *WEIGHTED}
        if each.name in {"folder", "network", "sources"} or not (lp or isinstance(each.type, click.Path)):
            continue
        if isinstance(each.type, WrittenPath):
            continue
        file = folder / (f"{each.name}.lp" if lp else str(each.name))
        if each.name == "encodings":
            file = file / "objectives.lp"
            file.parent.mkdir()
        file.write_text('#include "more.lp".' if lp else QUESTION if verb == "batch" else UNIT)
        files.append(file)
        word = str(file.parent if each.name == "encodings" else file) + "=1" * (each.name in WEIGHTED)
        if isinstance(each, click.Argument):
            positional.append(word)
        else:
            options += [each.opts[0], word]
    if any(file.suffix == ".lp" for file in files):
        files.append(folder / "more.lp")
        files[-1].write_text(":- use(1).")
    if verb == "convert":
        options += ["--to", "plain"]
    return [*options, *positional], files


@pytest.mark.parametrize("verb", WRITERS)
def test_no_verb_writes_over_what_it_reads(cli: Cli, tmp_path: Path, verb: str) -> None:
    words, files = asked(verb, tmp_path)
    ways: list[tuple[list[str | Path], list[Path]]] = [([*words], files)]
    names = {each.name for each in WRITERS[verb].params}
    data = tmp_path / "data"
    data.mkdir()
    tables = ("FOON.txt", "kitchen.txt", "motion.txt", "utensils.txt", "goal_nodes.txt", "unit_prices.txt")
    for name in tables:
        (data / name).write_text(UNIT)
    needed = [tmp_path / name for name in ("questions", "plan", "a", "b") if name in names]
    needed += [tmp_path / "tree"] * (verb == "check")
    first: list[str | Path] = [verb, *needed]
    if "folder" in names:
        ways.append(([*first, "--data", data], [data / name for name in tables]))
        ways.append(([*first, "--network", data], [data / "FOON.txt"]))
    if "sources" in names:
        ways.append(([*first, data], [data / name for name in tables]))
    if "paths" in names:
        to = ["--to", "plain"] * (verb == "convert")
        ways.append(([verb, *to, data / "FOON.txt"], [data / "FOON.txt"]))
    before = {file: file.read_bytes() for file in tmp_path.rglob("*") if file.is_file()}
    for output in WRITERS[verb].params:
        if not isinstance(output.type, WrittenPath):
            continue
        for way, read in ways:
            for number, file in enumerate(read):
                place = tmp_path / "out" / f"out{SUFFIXES.get(verb, '.svg')}"
                written = place / "domain.pddl" if output.name == "folder_written" else place
                written.parent.mkdir(parents=True, exist_ok=True)
                written.hardlink_to(file) if number % 2 else written.symlink_to(file)
                ran = cli(*way, output.opts[0], place)
                assert (ran.code, "is read by this command" in ran.err) == (2, True), (output, file, ran)
                written.unlink()
    assert before == {file: file.read_bytes() for file in tmp_path.rglob("*") if file.is_file()}


@pytest.mark.parametrize(
    ("verb", "outputs"),
    [("convert --to plain", (".", "../recipes")), ("merge", ("b.txt", "../recipes/b.txt"))],
)
def test_nothing_in_a_folder_that_is_read_is_written_over(
    cli: Cli, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, verb: str, outputs: tuple[str, ...]
) -> None:
    folder = tmp_path / "recipes"
    folder.mkdir()
    monkeypatch.chdir(folder)
    for name in ("a.txt", "b.txt"):
        Path(name).write_text(UNIT)
    for output in outputs:
        ran = cli(*verb.split(), "../recipes", "-o", output)
        assert (ran.code, "is read by this command" in ran.err) == (2, True), ran
    assert {file.name: file.read_text() for file in folder.iterdir()} == {"a.txt": UNIT, "b.txt": UNIT}


def test_the_domain_beside_a_problem_is_not_written_over(cli: Cli, tmp_path: Path) -> None:
    problem, domain = tmp_path / "problem.pddl", tmp_path / "domain.pddl"
    for file in (problem, domain):
        file.write_text("(define)")
    ran = cli("relax", problem, "--certificate", domain)
    assert (ran.code, "is read by this command" in ran.err) == (2, True)
    assert domain.read_text() == "(define)"


def test_a_file_is_not_written_twice(cli: Cli, tmp_path: Path) -> None:
    (tmp_path / "plan.txt").write_text(UNIT)
    out = tmp_path / "out.txt"
    ran = cli("trace", tmp_path / "plan.txt", "-o", out, "--stock-out", f"{tmp_path}/./out.txt")
    assert (ran.code, "would be written twice" in ran.err, out.exists()) == (2, True, False)


@pytest.mark.parametrize("content", ["", UNIT, '{"schema": "foon-asp/answer/1"}', None])
def test_a_baseline_replaces_only_a_baseline(cli: Cli, tmp_path: Path, content: str | None) -> None:
    recipe, baseline = tmp_path / "recipe.txt", tmp_path / "baseline.json"
    recipe.write_text(UNIT)
    if content is not None:
        baseline.write_text(content)
    ran = cli("lint", recipe, "--baseline", baseline, "--write-baseline")
    if content:
        assert (ran.code, baseline.read_text()) == (2, content)
        assert "is no baseline, and is not replaced by one" in ran.err
        return
    assert ran.code == 0
    assert cli("lint", recipe, "--baseline", baseline, "--write-baseline").code == 0
    baseline.unlink()
    baseline.hardlink_to(recipe)
    for name in (baseline, recipe):
        assert cli("lint", recipe, "--baseline", name, "--write-baseline").code == 2
    assert recipe.read_text() == UNIT


def test_a_store_is_written_through_its_link(cli: Cli, tmp_path: Path) -> None:
    (tmp_path / "FOON.txt").write_text(UNIT)
    link = tmp_path / "link.foon"
    link.symlink_to(tmp_path / "real.foon")
    for _ in range(2):
        assert cli("merge", tmp_path / "FOON.txt", "--store", link).code == 0
        assert link.is_symlink()
        (tmp_path / "real.foon").chmod(0o600)
    assert (tmp_path / "real.foon").stat().st_mode & 0o777 == 0o600
