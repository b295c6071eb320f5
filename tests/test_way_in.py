"""What somebody meets first: the README, the demo, the site, the notebooks, and files for a host."""

import re
import runpy
from pathlib import Path

import one_screen
import pytest

import foon_asp
from foon_asp.asp import Status
from foon_asp.cli.verbs import VERBS
from tests import notebooks
from tests.conftest import ROOT


def text(name: str) -> str:
    return (ROOT / name).read_text(encoding="utf-8")


def test_the_readme_is_short() -> None:
    assert len(text("README.md").splitlines()) <= 120


@pytest.mark.parametrize(
    "page", ["README.md", "CONTRIBUTING.md", *sorted(p.name for p in ROOT.glob("docs/*.md"))]
)
def test_what_a_page_links_to_is_there(page: str) -> None:
    file = ROOT / page if (ROOT / page).exists() else ROOT / "docs" / page
    linked = re.findall(r"\]\(([^)#\s]+)|src=\"([^\"]+)\"", file.read_text(encoding="utf-8"))
    names = [markdown or html for markdown, html in linked]
    assert [n for n in names if "://" not in n and not (file.parent / n).exists()] == []


def test_the_site_has_every_page() -> None:
    listed = set(re.findall(r'"docs/([\w-]+)"', text("docs/build.py")))
    assert listed == {page.stem for page in ROOT.glob("docs/*.md")}


@pytest.mark.slow
def test_the_reference_has_every_verb_every_name_and_every_schema() -> None:
    build = runpy.run_path(str(ROOT / "docs" / "build.py"))
    pages = {page: "\n".join(lines()) for page, lines in build["MADE"].items()}
    for verb in VERBS:
        heading = f"### {verb}\n\n{VERBS[verb].line}\n\n```text\nUsage: foon-asp {verb} "
        assert heading in pages["reference/verbs"]
    for name in foon_asp.__all__:
        assert re.search(rf"^\.\. auto\w+:: foon_asp\.{name}$", pages["reference/python"], re.MULTILINE)
    schemas = {file.stem for file in (ROOT / "foon_asp/document/schemas").glob("*.json")} - {"defs"}
    assert set(re.findall(r"^## (.*)$", pages["reference/schemas"], re.MULTILINE)) == schemas
    assert all(f"\n{page}\n" in pages["index"] for group in build["PAGES"].values() for page in group)


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
    workflow = text(".github/workflows/tests.yml")
    assert re.findall(r'"(3\.\d+)"', workflow.split("python:", 1)[1].split("]", 1)[0]) == known
    assert f"version: {foon_asp.__version__}" in text("CITATION.cff")
