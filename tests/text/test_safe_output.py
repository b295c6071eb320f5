"""What is printed is safe: no name and no file moves a cursor, forges a line or speaks to a log."""

import csv
import io
import json
import os
import pty
import re
import subprocess
import sys
import unicodedata
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from foon_asp.cli.output import SafeStream
from foon_asp.errors import UserError
from foon_asp.escapes import encodable, escaped, escaped_lines
from foon_asp.results.table_columns import csv_text
from tests.conftest import ROOT, Cli

UNSAFE = [
    *map(chr, (*range(9), *range(11, 32), *range(0x7F, 0xA0))),
    *"\u061c\u200b\u200c\u200d\u200e\u200f\u2028\u2029\u202a\u202b\u202c\u202d\u202e\u2060\u2066\u2067\u2068",
    *"\u2069\ufeff\ud800\udcff\U000e0041",
]
SAFE = "é 饺子 → ½ \N{SLICE OF PIZZA} × – … · †\ttab\n"


def unsafe(text: str) -> list[str]:
    return [letter for letter in text if letter in UNSAFE]


@pytest.mark.parametrize("letter", UNSAFE, ids=ascii)
def test_what_is_unsafe_is_escaped_as_in_json(letter: str) -> None:
    for shown in (escaped(f"a{letter}b"), escaped_lines(f"a{letter}b")):
        assert not unsafe(shown)
        assert json.loads(f'"{shown}"').encode("utf-16", "surrogatepass") == f"a{letter}b".encode(
            "utf-16", "surrogatepass"
        )


@given(st.text(st.characters()))
def test_every_letter_that_stays_can_be_seen(text: str) -> None:
    for letter in escaped(text):
        assert unicodedata.category(letter) not in {"Cc", "Cs", "Zl", "Zp"}
        assert unicodedata.bidirectional(letter) not in [
            "LRE",
            "RLE",
            "LRO",
            "RLO",
            "PDF",
            "LRI",
            "RLI",
            "FSI",
            "PDI",
        ]


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("::error::x", "\\u003a:error::x"),
        ("a\n  ::stop-commands::x", "a\n  \\u003a:stop-commands::x"),
        ("a\n\t \u3000::x", "a\n\t \u3000\\u003a:x"),
        ("a ::error::x", "a ::error::x"),
        (":::", "\\u003a::"),
        ("a ##[error]x ##vso[task.x]", "a \\u0023#[error]x \\u0023#vso[task.x]"),
        ("# a ## b", "# a ## b"),
        (SAFE, SAFE),
    ],
)
def test_no_line_is_a_command_to_a_log(text: str, shown: str) -> None:
    assert escaped_lines(text) == shown


def test_letters_that_an_encoding_has_not() -> None:
    assert encodable("é → 饺", "ascii") == "\\u00e9 \\u2192 \\u997a"
    assert encodable("é → 饺", "cp1252") == "é \\u2192 \\u997a"
    assert encodable("é → 饺", "utf-8") == "é → 饺"
    assert encodable("é", "no such encoding") == "\\u00e9"


def test_a_stream_escapes_text_and_leaves_bytes() -> None:
    raw = io.BytesIO()
    stream = SafeStream(io.TextIOWrapper(raw, encoding="ascii"))
    stream.write("\x1b[31m→\n")
    stream.write_data(b"\x1b::\n")
    assert raw.getvalue() == b"\\u001b[31m\\u2192\n\x1b::\n"
    with pytest.raises(TypeError):
        stream.write(b"")  # type: ignore[arg-type]
    with pytest.raises(UserError, match="standard output: cannot be written: it is closed"):
        SafeStream(None).write("x")
    SafeStream(None, remarks=True).write("x")


# --- the verbs


# A bracket in the notation of a node opens the place that it is in: goals are named without one.
EVIL = "a\x1b[31m\x07\x7f\x9b2J\u202e\u200b\u2028::b"


@pytest.fixture
def evil(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Give a folder of data in which every name is out to do harm."""
    folder = tmp_path / "evil\n::error::\x1b[31m\u202e"
    folder.mkdir()
    node = {
        "label": EVIL,
        "states": ["s" + EVIL.replace("[", "")],
        "ingredients": [f"i{EVIL}"],
        "container": f"c{EVIL}",
    }
    unit = {
        "input_nodes": [node],
        "motion_node": f"m{EVIL}",
        "output_nodes": [{"label": f"::{EVIL}".replace("[", "")}, {"label": "[/x]##[error]"}],
    }
    (folder / "FOON.json").write_text(json.dumps([unit, unit | {"motion_node": "::n"}]))
    (folder / "kitchen.json").write_text(json.dumps([node]))
    (folder / "goal_nodes.json").write_text(
        json.dumps([{"label": f"::{EVIL}".replace("[", "")}, {"label": "[/x]##[error]"}])
    )
    (folder / "motion.txt").write_text(f"m{EVIL}\t0.5\n::n\t0.25\n")
    (folder / "mine\n::error::x.lp").write_text(':- use(U), motion(U, "::error::x\n").\n')
    monkeypatch.chdir(tmp_path)
    return folder


GOAL = ("--goal", f"::{EVIL}".replace("[", ""))
VERBS: list[tuple[str, ...]] = [
    ("stats",),
    ("solve", *GOAL),
    ("solve", "--goal", "none"),
    ("solve", "--goal", "::error::x\n::error::y\x1b"),
    ("solve", "--all-goals"),
    ("compare",),
    ("compare", "--format", "csv"),
    ("compare", "--format", "markdown"),
    ("compare", "--search", "bfs", "--trees", *GOAL),
    ("why-not", *GOAL),
    ("shopping-list", *GOAL, "--kitchen", "/dev/null"),
    ("alternatives", *GOAL),
    ("pareto", *GOAL, "--trees"),
    ("regret", *GOAL),
    ("solve", *GOAL),
    ("assist", *GOAL),
    ("why-not", *GOAL, "--constraint", "FOLDER/mine\n::error::x.lp"),
    ("solve", *GOAL, "--constraint", "FOLDER/mine\n::error::x.lp"),
    ("solve", *GOAL, "--constraint", "none\n::error::x\x1b.lp"),
    ("solve", *GOAL, "--time-limit", "\n::error::x\x1b"),
    ("solve", "\n::error::x\x1b"),
    ("\n::error::x\x1b",),
    ("view", *GOAL, "--format", "mermaid"),
    ("view", *GOAL, "--format", "svg"),
    ("check", "FOLDER/FOON.json", *GOAL),
    ("merge", "--store", "\n::error::x.foon"),
]
BARE: list[tuple[str, ...]] = [
    ("lint", "FOLDER"),
    ("lint", "FOLDER", "--format", "json"),
    ("lint", "FOLDER", "--format", "sarif"),
    ("rename", "\n::error::x", "x", "FOLDER"),
    ("fmt", "--check", "FOLDER"),
    ("convert", "FOLDER/FOON.json", "--to", "plain", "-o", "\n::error::x.txt"),
    ("convert", "FOLDER", "--to", "plain", "-o", "\n::error::x"),
    ("merge", "\n::error::x"),
    ("solve", "--data", "\n::error::x"),
    ("stats", "--network", "FOLDER/mine\n::error::x.lp"),
    ("batch", "\n::error::x", "--results", "x"),
]


@pytest.mark.parametrize("words", [*VERBS, *BARE], ids=ascii)
def test_nothing_that_is_printed_does_harm(cli: Cli, evil: Path, words: tuple[str, ...]) -> None:
    data = (
        ("--data", evil) if (words in VERBS and len(words) > 1) or words in {("stats",), ("compare",)} else ()
    )
    ran = cli(*(word.replace("FOLDER", str(evil)) for word in words), *data)
    assert ran.code in {0, 1, 2}, ran.err
    assert "bug" not in ran.err
    for text in (ran.out, ran.err):
        assert not unsafe(text)
        lines = text.split("\n")
        assert not [line for line in lines if line.lstrip().startswith("::")]
        assert words[0] == "view" or "##[" not in text  # a picture is data
    if words in VERBS[:2] or words[0] == "compare" or "--all-goals" in words:
        assert (ran.code, bool(ran.out)) == (0, True)
        assert "--all-goals" not in words or "[/x]" in ran.out  # though it looks like markup
    if words[-1] == "json":
        assert ran.json is not None


def test_a_name_of_two_lines_stays_on_one(cli: Cli, tmp_path: Path) -> None:
    two = "forged\noptimal: 0 units"
    node = {"label": two, "states": [], "ingredients": [two], "container": two}
    unit = {"input_nodes": [node], "motion_node": two, "output_nodes": [{"label": "b"}, node]}
    (tmp_path / "FOON.json").write_text(json.dumps([unit]))
    (tmp_path / "kitchen.json").write_text(json.dumps([node]))
    (tmp_path / "goal_nodes.json").write_text(json.dumps([{"label": "b"}]))
    store = tmp_path / "a.foon"
    assert cli("merge", "--data", tmp_path, "--store", store).code == 0
    answer = tmp_path / "answers" / "answer.json"
    answer.parent.mkdir()
    answer.write_text(cli("solve", "--data", tmp_path, "--format", "json").out)
    for words in (
        ("solve", "--data", tmp_path),
        ("alternatives", "--network", store),
        ("view", "--data", tmp_path),
        ("schedule", answer, "--data", tmp_path, "--default-duration", "5"),
    ):
        ran = cli(*words)
        assert (ran.code, "forged" in ran.out) == (0, True)
        assert "\noptimal: 0 units" not in ran.out + ran.err


def test_a_line_that_keeps_changing_goes_back_to_its_beginning() -> None:
    changing = "\r\x1b[2K\x1b[1A\x1b[2Kbest tree"
    assert escaped_lines(changing, styled=True) == changing
    assert escaped_lines("forged\rtree", styled=True) == "forged\\u000dtree"
    assert escaped_lines(changing) == "\\u000d\\u001b[2K\\u001b[1A\\u001b[2Kbest tree"


def test_colours_are_kept_on_a_terminal_and_those_of_names_are_not(evil: Path) -> None:
    ours, theirs = pty.openpty()
    command = [sys.executable, "-m", "foon_asp", "solve", "--all-goals", "--data", str(evil)]
    environment = {**os.environ, "TERM": "xterm-256color", "PYTHONPATH": str(ROOT)}
    environment.pop("NO_COLOR", None)
    subprocess.run(command, stdout=theirs, stderr=subprocess.PIPE, check=True, env=environment)
    shown = os.read(ours, 1_000_000)
    assert b"\x1b[1" in shown
    assert b"\x1b[31m\x07" not in shown
    assert b"\\u001b31m" in shown
    subprocess.run(
        command, stdout=theirs, stderr=subprocess.PIPE, check=True, env={**environment, "NO_COLOR": "1"}
    )
    shown = os.read(ours, 1_000_000)
    assert not re.search(rb"\x1b\[[0-9;]*3[0-7]", shown)
    os.close(ours)
    os.close(theirs)


@pytest.mark.parametrize(
    ("start", "shown"),
    [
        ("=", "'="),
        ("+", "'+"),
        ("-", "'-"),
        ("@", "'@"),
        ("\t", "\\u0009"),
        ("\r", "\\u000d"),
        ("=1+", "'=1+"),
    ],
)
def test_no_cell_of_csv_is_a_formula(start: str, shown: str) -> None:
    goal = f"{start}cmd|' /C calc'!A0"
    (row,) = csv.DictReader(io.StringIO(csv_text([{"goal": goal, "missing": [goal]}]), newline=""))
    assert row["goal"] == row["missing"] == shown + goal.removeprefix(start)
