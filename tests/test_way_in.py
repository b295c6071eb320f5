"""What somebody meets first: the README, the demo, the site, the notebooks, and files for a host."""

import re
import runpy
import shutil
import subprocess
from pathlib import Path

import click
import one_screen
import pytest

import foon_asp
from foon_asp.asp import Status
from foon_asp.cli.verbs import VERBS, verb_command
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


def test_a_manual_page_has_every_option_and_only_plain_requests() -> None:
    man = runpy.run_path(str(ROOT / "docs" / "man.py"))
    page, front = "\n".join(man["verb_page"]("solve")), "\n".join(man["main_page"]())
    for option in verb_command("solve").params:
        if isinstance(option, click.Option) and not option.hidden:
            assert option.opts[0].replace("-", r"\-") in page
    assert "\n.nf\nfoon\\-asp solve \\-\\-goal \\(aqgreek salad\\(aq\n" in page
    for verb in VERBS:
        assert rf"\fBfoon\-asp\-{man['roff'](verb)}\fR(1)" in front
    for each in (page, front):
        assert each.isascii()
        assert {*re.findall(r"^[.'](\w*)", each, re.MULTILINE)} <= {"TH", "SH", "SS", "PP", "TP", "nf", "fi"}


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
    workflow = text(".github/workflows/tests.yml")
    assert re.findall(r'"(3\.\d+)"', workflow.split("python:", 1)[1].split("]", 1)[0]) == known
    assert f"version: {foon_asp.__version__}" in text("CITATION.cff")
