"""What somebody meets first: the README, the demo, the site, the notebooks, and files for a host."""

import re
import runpy
import shutil
import subprocess
from pathlib import Path

import one_screen
import pytest

import foon_asp
from foon_asp.asp import Status
from foon_asp.cli.verbs import VERBS
from tests.conftest import ROOT
from tests.docs import notebooks

PAGES = {page.relative_to(ROOT / "docs").with_suffix("").as_posix() for page in ROOT.glob("docs/**/*.md")}


def text(name: str) -> str:
    return (ROOT / name).read_text(encoding="utf-8")


@pytest.mark.parametrize(
    "page", ["README.md", "CONTRIBUTING.md", *sorted(f"docs/{page}.md" for page in PAGES)]
)
def test_what_a_page_links_to_is_there(page: str) -> None:
    file = ROOT / page
    linked = re.findall(r"\]\(([^)#\s]+)|src=\"([^\"]+)\"", file.read_text(encoding="utf-8"))
    names = [markdown or html for markdown, html in linked]
    assert [n for n in names if "://" not in n and not (file.parent / n).exists()] == []


def test_the_site_has_every_page() -> None:
    assert set(re.findall(r'"docs/([\w/-]+)"', text("docs/build.py"))) == PAGES


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("groff") is None, reason="groff is not installed")
def test_every_manual_page_can_be_read(tmp_path: Path) -> None:
    man = runpy.run_path(str(ROOT / "docs" / "man.py"))
    man["main"]([str(tmp_path)])
    assert {file.stem for file in tmp_path.iterdir()} == {"foon-asp", *(f"foon-asp-{verb}" for verb in VERBS)}
    for file in tmp_path.iterdir():
        ran = subprocess.run(
            ["groff", "-man", "-Tascii", "-ww", str(file)], capture_output=True, text=True, check=True
        )
        assert ran.stderr == ""
        assert "SYNOPSIS" in re.sub(r".\x08|\x1b\[[0-9;]*m", "", ran.stdout)


def test_the_demo_is_one_screen_and_says_what_is_true(capsys: pytest.CaptureFixture[str]) -> None:
    one_screen.main()
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) <= 24
    assert max(map(len, lines)) <= 80
    rows = {line[:14].strip(): line[14:].split() for line in lines}
    foon = foon_asp.load()
    for goal in one_screen.GOALS:
        best = foon_asp.solve(foon.problem(goal, containers="implied"))
        assert best.status is Status.OPTIMAL
        assert best.costs is not None
        assert rows[goal][0] == str(best.costs.units)
    marks = [mark for goal in one_screen.GOALS for mark in rows[goal] if mark in {"~", "!", "-"}]
    assert f"Only {25 - len(marks)} of the 25 trees execute" in "\n".join(lines)


@pytest.mark.parametrize("name", ["annotations.ipynb", "search.ipynb"])
@pytest.mark.slow
def test_a_notebook_shows_what_it_computes(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    notebook = notebooks.read(notebooks.FOLDER / name)
    shown = notebooks.texts(notebook)
    assert sum(map(bool, shown)) >= 4
    assert notebooks.texts(notebooks.executed(notebook)) == shown


def test_files_for_a_host_follow_the_project() -> None:
    known = re.findall(r"Language :: Python :: (3\.\d+)", text("pyproject.toml"))
    assert re.findall(r"^ +(3\.\d+)$", text(".github/workflows/nightly.yml"), re.MULTILINE) == known
    assert f"version: {foon_asp.__version__}" in text("CITATION.cff")
