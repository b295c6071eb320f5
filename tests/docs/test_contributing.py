"""CONTRIBUTING.md: the way of a question is the one it goes, and the files of the recipes are there."""

import re

from tests.conftest import ROOT

PAGE = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
STEP = re.compile(r"^\| *\d* *\| `([^`]+)` \| `([^`]+)` \|", re.MULTILINE)
FILE = re.compile(r"(?:foon_asp|encodings|tests|docs|data)/[\w./-]+|[A-Z][A-Z]+\.md|pyproject\.toml")


def test_the_way_of_a_question_is_the_one_it_goes() -> None:
    steps = STEP.findall(PAGE)
    assert len(steps) > 20
    for file, name in steps:
        assert re.search(rf"\b{name.split('.')[0]}\b", (ROOT / file).read_text(encoding="utf-8")), (
            file,
            name,
        )


def test_files_that_are_named_are_there() -> None:
    named = set(FILE.findall(PAGE))
    assert len(named) > 40
    for name in named:
        path = ROOT / name
        assert path.exists() or ("NAME" in name and path.parent.is_dir()), name
    tables = re.findall(r"^\| file \| what \|\n\|---\|---\|\n((?:\|.*\n)+)", PAGE, re.MULTILINE)
    assert len(tables) == 6
