"""A transcript: commands, each followed by what it printed."""

import contextlib
import csv
import io
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import NamedTuple
from unittest import mock

from foon_asp.cli.main import main

ROOT = Path(__file__).resolve().parents[2]
KITCHEN = ROOT / "data" / "kitchen"
FILES = Path(__file__).parent / "files"
_ENVIRONMENT = {"COLUMNS": "100", "NO_COLOR": "1"}

# What differs from run to run: times in JSON, in sentences and at the end of a row.
_VARYING = (
    (re.compile(r'(?<="seconds": )\{[^}]*\}'), "{}"),
    (re.compile(r'(?<="seconds": )\d[\d.e-]*'), "0"),
    (re.compile(r"(?<=^seconds for one: ).*", re.MULTILINE), "#"),
    (re.compile(r"\b\d+(\.\d+)? s\b"), "# s"),
    (re.compile(r"(?<=optimal|easible) +\d+\.\d\d$", re.MULTILINE), " #"),
)


class Printed(NamedTuple):
    """How a command ended, and what it printed."""

    code: int
    out: str
    err: str


Run = Callable[[list[str]], Printed]


def transcripts() -> list[Path]:
    """Return the paths of all transcripts."""
    return sorted(Path(__file__).parent.glob("*.txt"))


def commands(text: str) -> list[str]:
    """Return the commands of a transcript: the lines that begin with a dollar sign."""
    return [line[2:] for line in text.splitlines() if line.startswith("$ ")]


def recorded(lines: Iterable[str], run: Run, data: Path, root: Path = ROOT) -> Iterator[str]:
    """Run commands in a new folder, and return each with what it printed.

    The folder holds the input files of the transcripts, and a copy of ``data`` as ``kitchen``. The command
    ``cat FILE`` prints a file, and ``> FILE`` writes what a command prints on stdout. Lines on stderr begin
    with ``! ``. Paths below ``root``, the checkout that is run, are printed without it.
    """
    with (
        tempfile.TemporaryDirectory(prefix="golden") as folder,
        contextlib.chdir(folder),
        mock.patch.dict(os.environ, _ENVIRONMENT),
    ):
        shutil.copytree(FILES, folder, dirs_exist_ok=True)
        shutil.copytree(data, "kitchen")
        for line in lines:
            command, _, target = line.partition(" > ")
            program, *words = shlex.split(command)
            if program == "cat":
                path = Path(*words)
                said = path.read_text(encoding="utf-8") if path.is_file() else "! there is no such file\n"
            else:
                printed = run(words)
                if "csv" in words:
                    printed = printed._replace(out=_without_seconds(printed.out))
                if target:
                    Path(target).write_text(printed.out, encoding="utf-8")
                    printed = printed._replace(out="")
                said = _in_one_text(printed)
            for varying, constant in _VARYING:
                said = varying.sub(constant, said)
            said = said.replace(f"{folder}/", "").replace(f"{root}/", "")
            yield f"$ {line}\n" + "".join(f"{each.rstrip()}\n" for each in said.splitlines())


def _without_seconds(table: str) -> str:
    """Return a table in CSV with empty columns in place of times."""
    rows = list(csv.reader(io.StringIO(table)))
    times = [place for place, name in enumerate(rows[0]) if name.startswith("seconds")] if rows else []
    for row in rows[1:]:
        for place in times:
            row[place] = ""
    out = io.StringIO()
    csv.writer(out, lineterminator="\n").writerows(rows)
    return out.getvalue()


def _in_one_text(printed: Printed) -> str:
    errors = "".join(f"! {line}\n" for line in printed.err.splitlines())
    out = printed.out if printed.out.endswith("\n") or not printed.out else f"{printed.out}\n"
    return errors + out + (f"[exit {printed.code}]\n" if printed.code else "")


def run_here(words: list[str]) -> Printed:
    """Run a command line of this checkout in this process."""
    out, err, stdin = (io.TextIOWrapper(io.BytesIO(), encoding="utf-8", write_through=True) for _ in range(3))
    code: object = 0
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err), mock.patch("sys.stdin", stdin):
        try:
            main(words)
        except SystemExit as ended:
            code = ended.code
    assert isinstance(code, int)
    return Printed(code, *(stream.buffer.getvalue().decode() for stream in (out, err)))


def running_in(checkout: Path) -> Run:
    """Return what runs a command line of another checkout, in a process."""

    def run(words: list[str]) -> Printed:
        ran = subprocess.run(
            [sys.executable, "-m", "foon_asp", *words],
            env=os.environ | {"PYTHONPATH": str(checkout)},
            stdin=subprocess.DEVNULL,
            capture_output=True,
            encoding="utf-8",
            check=False,
        )
        return Printed(ran.returncode, ran.stdout, ran.stderr)

    return run
