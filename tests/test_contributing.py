"""CONTRIBUTING.md: the way of a question is the one it goes, and the files of the recipes are there."""

import re
import shlex
import sys
from pathlib import Path
from types import FrameType

from tests.conftest import ROOT, Cli

PAGE = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
STEP = re.compile(r"^\| *\d* *\| `([^`]+)` \| `([^`]+)` \|", re.MULTILINE)
FILE = re.compile(r"(?:foon_asp|encodings|tests|docs|data)/[\w./-]+|[A-Z][A-Z]+\.md|pyproject\.toml")
NAME = re.compile(r"(?<=`)[A-Za-z_]+(?=`)")


def steps() -> list[tuple[str, str]]:
    found = STEP.findall(PAGE)
    assert len(found) > 20
    return found


def test_a_question_goes_the_way_that_is_told(cli: Cli) -> None:
    (command,) = re.findall(r"^`foon-asp (solve [^`]+)`, from the words", PAGE, re.MULTILINE)
    called: dict[tuple[str, str], None] = {}

    def note(frame: FrameType, event: str, _: object) -> None:
        if event == "call" and frame.f_code.co_filename.startswith(str(ROOT)):
            file = Path(frame.f_code.co_filename).relative_to(ROOT).as_posix()
            called.setdefault((file, frame.f_code.co_qualname))

    before = sys.getprofile()
    sys.setprofile(note)
    try:
        ran = cli(*shlex.split(command))
    finally:
        sys.setprofile(before)
    assert ran.code == 0
    told = steps()
    assert [each for each in called if each in told] == told


def test_files_that_are_named_are_there() -> None:
    named = set(FILE.findall(PAGE))
    assert len(named) > 40
    for name in named:
        path = ROOT / name
        assert path.exists() or ("NAME" in name and path.parent.is_dir()), name
    tables = re.findall(r"^\| file \| what \|\n\|---\|---\|\n((?:\|.*\n)+)", PAGE, re.MULTILINE)
    assert len(tables) == 5


def test_recipes_begin_with_files() -> None:
    for table in re.findall(r"^\| file \| what \|\n\|---\|---\|\n((?:\|.*\n)+)", PAGE, re.MULTILINE):
        for row in table.splitlines():
            assert all(FILE.fullmatch(word) for word in re.findall(r"`([^`]+)`", row.split("|")[1])), row


def test_names_of_code_are_in_the_code() -> None:
    files = [
        *(ROOT / "foon_asp").rglob("*.py"),
        *(ROOT / name for name in FILE.findall(PAGE) if "test_" in name),
    ]
    code = "\n".join(file.read_text(encoding="utf-8") for file in files if file.exists())
    known = set(re.findall(r"^ *(?:(?:def|class) )?([A-Za-z_]+)\b", code, re.MULTILINE))
    named = {name for name in NAME.findall(PAGE) if not name.islower() or "_" in name} - {"NAME"}
    assert {"Row", "Solve", "SEARCHES", "ENGINES", "CASES", "SOLVERS", "scope_of", "json_dict"} <= named
    assert named <= known
