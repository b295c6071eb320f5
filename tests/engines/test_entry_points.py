"""Searches and engines of other packages: found, run, held to what is asked; hostile ones refused by name."""

import json
import os
import subprocess
import sys
import time
import tomllib
from collections.abc import Callable
from pathlib import Path

import pytest

import foon_asp
from foon_asp.engines import Solve, find_engines
from foon_asp.errors import UserError
from foon_asp.problem import Objective
from foon_asp.searches import Retrieve, SearchSettings
from tests.conftest import ROOT, Cli, valid
from tests.support.example_package import foon_example
from tests.support.packages import Packages, install

EXAMPLE = Path(foon_example.__file__).parent
PAGE = ROOT / "docs" / "entry-points.md"
PROJECT = tomllib.loads((EXAMPLE / "pyproject.toml").read_text())["project"]
U = Objective.UNITS
RETRIEVE: Retrieve = foon_example.fewest_open  # held by the type checker
SOLVE: Solve = foon_example.every_set


@pytest.fixture
def packages(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Packages:
    folder = tmp_path / "installed"
    folder.mkdir()
    return Packages(folder, monkeypatch)


def install_example(packages: Packages) -> None:
    searches, engines = (
        {name: value.partition(":")[2] for name, value in PROJECT["entry-points"][group].items()}
        for group in ("foon_asp.searches", "foon_asp.engines")
    )
    packages.install("foon-example", (EXAMPLE / "foon_example.py").read_text(), searches, engines)


def test_the_page_shows_the_example() -> None:
    for file in ("foon_example.py", "pyproject.toml"):
        assert (EXAMPLE / file).read_text() in PAGE.read_text()


def test_a_search_of_another_package_stands_in_compare(cli: Cli, packages: Packages, tmp_path: Path) -> None:
    install_example(packages)
    words = ["compare", "--goal", "macaroni", "--goal", "ice", "--search", "fewest-open"]
    results = ["--results", tmp_path / "results.jsonl"]
    for row in cli(*words, "--format", "json").json["comparisons"]:
        (theirs,) = row["searches"]
        assert (theirs["search"], theirs["ending"]) == ("fewest-open", "tree")
        assert theirs["verdict"] in {"executes as listed", "executes in another order"}
    assert "\nfewest-open " in cli(*words).out
    for _ in range(2):
        assert cli(*words, *results).code == 0
    # results of another version are those of another question
    told = packages.folder / "foon_example-1.0.dist-info" / "METADATA"
    told.write_text(told.read_text().replace("1.0", "1.1"))
    ran = cli(*words, *results)
    assert ran.code == 2
    assert "started for another question" in ran.err


def test_a_search_of_another_package_runs_by_itself(cli: Cli, packages: Packages) -> None:
    install_example(packages)
    ran = cli("compare", "--search", "fewest-open", "--goal", "macaroni", "--trees")
    assert "fewest-open promises what foon-example 1.0 says of it" in ran.out
    assert "fewest-open" in cli("compare", "--help").out
    problem = foon_asp.load().problem("macaroni")
    theirs = foon_asp.search(problem, "fewest-open")
    assert theirs.ids == RETRIEVE(problem, SearchSettings()).units
    assert (theirs.package, foon_asp.search(problem, "bfs").package) == ("foon-example 1.0", None)
    unknown = cli("compare", "--search", "magic", "--goal", "ice")
    assert unknown.code == 2
    assert "fewest-open" in unknown.err


@pytest.mark.slow
def test_the_example_is_installed_by_pip(tmp_path: Path) -> None:
    words = ["-m", "pip", "install", "--no-index", "--no-deps", "--no-build-isolation", "--quiet", "--target"]
    subprocess.run([sys.executable, *words, tmp_path, EXAMPLE], check=True)
    ran = run(tmp_path, "compare", "--goal", "ice")
    assert ran.returncode == 0
    assert "fewest-open" in ran.stdout


def run(folder: Path, *words: str) -> subprocess.CompletedProcess[str]:
    """Run the command in a process of its own, with a folder of packages."""
    return subprocess.run(
        [sys.executable, "-m", "foon_asp", *words],
        capture_output=True,
        text=True,
        check=False,
        env={**os.environ, "PYTHONPATH": str(folder)},
        cwd=ROOT,
    )


HOSTILE = """
import os, sys, time
from foon_asp.errors import UserError
from foon_asp.searches import Ending, Retrieval

number = 42

def search(given):
    return lambda problem, settings: given

def raises(problem, settings):
    raise ValueError("a\\nb")

def refuses(problem, settings):
    raise UserError("this search needs a kitchen with a stove")

def leaves(problem, settings):
    sys.exit(0)

def ends(problem, settings):
    os._exit(3)

def endless(problem, settings):
    while True:
        try:
            time.sleep(60)
        except BaseException:
            pass

def changes(problem, settings):
    problem.network.units = ()

nothing = search(None)
word = search("tree")
strange = search(Retrieval(Ending.TREE, (object(),)))
outside = lambda problem, settings: Retrieval(Ending.TREE, (len(problem.network),))
below = search(Retrieval(Ending.TREE, (-1,)))
floats = search(Retrieval(Ending.TREE, (1.0,)))
truth = search(Retrieval(Ending.TREE, (True,)))
twice = search(Retrieval(Ending.TREE, (1, 1)))
both = search(Retrieval(Ending.NONE, (1,)))
stuck = search(Retrieval(Ending.STUCK))
elsewhere = search(Retrieval(Ending.STUCK, stuck_at=10**9))
made = lambda problem, settings: Retrieval(Ending.STUCK, stuck_at=problem.goals[0])
endings = search(Retrieval("best", (1,)))
long = search("x" * 100000)
none = search(Retrieval(Ending.NONE))
wrong = search(Retrieval(Ending.TREE, (0, 1, 2)))

def noisy(problem, settings):
    problem.rates.update(dict.fromkeys(problem.rates, 1))
    print("noise of print")
    os.system("echo noise of a program")
    sys.stdin.read()
    return Retrieval(Ending.NONE)
"""

REFUSED = {
    "raises": "raised ValueError: a\\u000ab (",
    "refuses": "this search needs a kitchen with a stove\n",
    "leaves": "raised SystemExit: 0 (",
    "ends": "ended its process (3)",
    "changes": "raised FrozenInstanceError: cannot assign to field 'units' (",
    "nothing": "gave None, expected a Retrieval",
    "word": "gave 'tree', expected a Retrieval",
    "strange": "which is no answer",
    "outside": "; units are 0 to ",
    "below": "gave a tree with the unit -1; units are 0 to ",
    "floats": "gave a tree with the unit 1.0; units are",
    "truth": "gave a tree with the unit True; units are",
    "twice": "gave a tree that lists a unit twice",
    "both": "gave units, and the ending none",
    "stuck": "gave the ending stuck, and stuck_at=None",
    "elsewhere": "is stuck at 1000000000; objects are 0 to ",
    "made": "is stuck at ice; crushed; in [drinking glass], which is in the kitchen or made by a unit",
    "endings": "expected a Retrieval",
    "long": "xxx...\n",
    "number": "expected a function, found 42",
    "missing": "cannot be imported: AttributeError: module 'foon_hostile' has no attribute 'missing'",
}


def test_what_is_no_tree_is_refused_by_name(cli: Cli, packages: Packages) -> None:
    packages.install("foon-hostile", HOSTILE, {name: name for name in REFUSED})
    problem = foon_asp.load().problem("ice")
    for name, words in REFUSED.items():
        with pytest.raises(UserError) as raised:
            foon_asp.search(problem, name)
        start = f"foon-hostile 1.0: {name} (foon_asp.searches, foon_hostile:{name}): "
        assert str(raised.value).startswith(start)
        assert words in str(raised.value)
        assert len(str(raised.value)) < 600
        assert name != "raises" or "in raises" in raised.value.__notes__[0]  # what --debug shows
    ran = cli("compare", "--search", "refuses", "--goal", "ice")
    assert (ran.code, ran.out) == (2, "")
    assert ran.err.startswith("error: foon-hostile 1.0: refuses (")
    assert ran.err.endswith("what to do: tell the authors of the package, name others, or uninstall it\n")
    # ours do not mind
    assert cli("compare", "--goal", "ice", "--search", "bfs", "--search", "ids").code == 0
    assert cli("compare", "--goal", "ice").code == 2


@pytest.mark.slow
def test_what_it_does_it_does_elsewhere(packages: Packages) -> None:
    packages.install("foon-hostile", HOSTILE, {"noisy": "noisy", "wrong": "wrong", "none": "none"})
    ran = run(packages.folder, "compare", "--goal", "ice", "--format", "json")
    assert ran.returncode == 0
    (found,) = valid(json.loads(ran.stdout))["comparisons"]
    rows = {row["search"]: row for row in found["searches"]}
    best = foon_asp.solve(foon_asp.load().problem("ice"), "success").costs
    assert best is not None
    assert found["optimum"]["success"]["value"]["exact"] == str(best.success) != "1"
    assert rows["wrong"]["verdict"] == "does not execute"
    assert rows["none"]["ending"] == rows["noisy"]["ending"] == "none"
    assert {"noise of print", "noise of a program"} <= {*ran.stderr.splitlines()}
    said = run(packages.folder, "compare", "--search", "none", "--goal", "ice", "--trees")
    assert said.returncode == 0
    assert "no tree: foon-hostile 1.0 says that none executes, which is not checked" in said.stdout


@pytest.mark.slow
def test_a_search_without_an_end_is_ended(cli: Cli, packages: Packages) -> None:
    packages.install("foon-hostile", HOSTILE, {"endless": "endless", "none": "none"})
    began = time.monotonic()
    asked = "--goal", "ice", "--time-limit", "0.5"
    ran = cli("compare", "--search", "endless", "--trees", *asked)
    assert "unknown: stopped at a limit" in ran.out
    (row,) = cli("compare", *asked, "--format", "json").json["comparisons"]
    endings = [(each["search"], each["ending"]) for each in row["searches"]]
    assert endings[-2:] == [("endless", "unknown"), ("none", "none")]
    assert time.monotonic() - began < 20


@pytest.mark.parametrize("name", ["bfs", "IDS", "optimum", "a b", "x" * 41])
def test_names_are_taken_once(cli: Cli, packages: Packages, name: str) -> None:
    packages.install("foon-name", "", {name: "search"})
    for words in (["compare", "--search", "bfs"], ["compare"]):
        ran = cli(*words, "--goal", "ice")
        assert ran.code == 2
        assert f"error: foon-name 1.0: {name} (foon_asp.searches, " in ran.err
    assert cli("compare", "--help").code == 0
    assert cli("solve", "--goal", "ice").code == 0


def test_of_two_packages_with_one_name_the_second_is_refused(cli: Cli, packages: Packages) -> None:
    packages.install("foon-one", "", {"mine": "search"})
    packages.install("foon-two", "", {"mine": "search"})
    ran = cli("compare", "--search", "bfs", "--goal", "ice")
    assert ran.code == 2
    assert "error: foon-two 1.0: mine (" in ran.err
    assert "the name is taken: foon-one 1.0 has one" in ran.err


def test_a_package_that_cannot_be_read_is_named(cli: Cli, packages: Packages) -> None:
    packages.install("foon-odd")
    points = packages.folder / "foon_odd-1.0.dist-info" / "entry_points.txt"
    ours = b"[foon_asp.searches]\n"
    for text, code in (
        (b"[console_scripts]\nnonsense\n", 0),  # no matter of ours
        (b"[console_scripts]\n# \xff\n", 0),
        (ours + b"nonsense\n", 2),
        (ours + b"mine = a:b\n# \xff\n", 2),
    ):
        points.write_bytes(text)
        ran = cli("compare", "--search", "bfs", "--goal", "ice")
        assert ran.code == code
        assert ("a package offers foon_asp.searches and cannot be read: " in ran.err) == bool(code)
        assert (str(packages.folder) in ran.err) == bool(code)


def test_of_a_package_that_is_there_twice_the_first_counts(
    cli: Cli, packages: Packages, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    packages.install("foon-hostile", HOSTILE, {"mine": "raises"})
    first, other = tmp_path / "first", tmp_path / "other"
    install(first, "foon-hostile", HOSTILE, {"mine": "none"})
    install(other, "foon-other", "")  # which comes before, and offers nothing
    (other / "foon_other-1.0.dist-info" / "entry_points.txt").unlink()
    for folder in (first, other):
        monkeypatch.syspath_prepend(folder)
    ran = cli("compare", "--search", "mine", "--goal", "ice")
    (row,) = (line.split() for line in ran.out.splitlines() if line.startswith("mine "))
    assert row == ["mine", "no", "tree:", "none"]


@pytest.mark.slow
def test_its_process_ends_with_ours(packages: Packages, tmp_path: Path) -> None:
    told = tmp_path / "pid"
    packages.install(
        "foon-hostile",
        "import os, pathlib\n"
        "def endless(problem, settings):\n"
        f"    pathlib.Path({str(told)!r}).write_text(f'{{os.getpid()}}\\n')\n"
        "    while True: pass\n",
        {"endless": "endless"},
    )

    def within_10_seconds(holds: Callable[[], bool]) -> None:
        end = time.monotonic() + 10
        while not holds():
            assert time.monotonic() < end
            time.sleep(0.05)

    ours = subprocess.Popen(
        [sys.executable, "-m", "foon_asp", "compare", "--search", "endless", "--goal", "ice"],
        env={**os.environ, "PYTHONPATH": str(packages.folder)},
        cwd=ROOT,
    )
    within_10_seconds(lambda: told.exists() and told.read_text().endswith("\n"))
    ours.kill()
    ours.wait()
    within_10_seconds(lambda: not Path("/proc", told.read_text().strip()).exists())


# --- engines

ENGINES = """
import time
from foon_asp.engines import EngineAnswer, NotCheckedError

def answer(units, finished=True, which=1):
    return lambda problem, objectives, forbidden, seconds: EngineAnswer(
        "me", objectives[:which], units, finished
    )

def endless(problem, objectives, forbidden, seconds):
    while True:
        time.sleep(60)

def declines(problem, objectives, forbidden, seconds):
    raise NotCheckedError("not\\nme")

def everything(problem, objectives, forbidden, seconds):
    return EngineAnswer("HiGHS", objectives, tuple(range(3)), True)

def cheats(problem, objectives, forbidden, seconds):
    problem.rates.update(dict.fromkeys(problem.rates, 1))
    return EngineAnswer("foon-asp", objectives, (), True)

none = answer(None)
late = answer(None, False)
raises = lambda *given: 1 / 0
text = lambda *given: "a tree"
outside = answer((10**9,))
nothing = answer((), which=0)
mixed = lambda problem, objectives, forbidden, seconds: EngineAnswer("me", objectives[::-1], (), True)
twice = answer((0, 0))
maybe = answer((), "yes")
"""
SAID = {
    "declines": "not checked: not\\u000ame",
    "late": "not checked: it found no answer in time",
    "none": "disagrees and is wrong: we say a tree exists, none says no tree exists (",
    "cheats": "disagrees and is wrong: the tree of cheats does not execute (",
    "everything": "disagrees and is wrong: the tree of everything does not execute (",
}
FAULTS = {
    "raises": "raised ZeroDivisionError: division by zero (",
    "text": "gave 'a tree', expected an EngineAnswer",
    "outside": "gave a tree with the unit 1000000000; units are 0 to ",
    "nothing": "looked at [], expected the first of success, units, or more of them",
    "mixed": "looked at ['units', 'success'], expected the first of success, units, or more of them",
    "twice": "gave a tree that lists a unit twice",
    "maybe": "expected an EngineAnswer",
    "missing": "cannot be imported: AttributeError",
}


@pytest.mark.slow
def test_an_engine_of_another_package_is_asked_too(cli: Cli, packages: Packages) -> None:
    install_example(packages)
    asked, said = ("solve", "--goal", "ice", "--cross-check"), "every-set (foon-example 1.0)"
    assert f"cross-check: {said} agrees by units (" in cli(*asked).out
    by_success = cli(*asked, "--objective", "success")
    assert f"{said}: not checked: it counts units, and nothing else\n" in by_success.out
    ruled = cli(*asked, "--constraint", "at_most_units", "-c", "max_units=9")
    assert f"{said}: not checked: it knows no rules such as at_most_units" in ruled.out
    without = ("--constraint", "forbid_motion", "-c", "forbidden_motion=crush")
    row = cli(*asked, *without, "--format", "json").json["cross_check"][-1]
    assert (row["engine"], row["package"], row["agrees_by"]) == ("every-set", "foon-example 1.0", ["units"])
    none = cli("solve", "--goal", "apple pie", "--cross-check")
    assert f"{said} agrees that no tree exists" in none.out
    checks = foon_asp.solve(foon_asp.load().problem("ice"), cross_check=True).cross_check
    assert isinstance(checks, tuple)
    assert [check.package for check in checks] == [None] * (len(checks) - 1) + ["foon-example 1.0"]


@pytest.mark.slow
def test_what_an_engine_claims_is_shown_as_its_own(cli: Cli, packages: Packages) -> None:
    packages.install("foon-hostile", ENGINES, engines={name: name for name in SAID})
    asked = "solve", "--goal", "ice", "--objective", "success"
    alone = cli(*asked).out
    ran = cli(*asked, "--cross-check")
    assert ran.code == 0
    assert ran.out.partition("\n")[0] == alone.partition("\n")[0]
    for name, words in SAID.items():
        (line,) = (line for line in ran.out.splitlines() if line.startswith(f"cross-check: {name} "))
        assert line.removeprefix(f"cross-check: {name} (foon-hostile 1.0)").lstrip(": ").startswith(words)


def test_an_engine_without_an_end_is_ended(packages: Packages) -> None:
    packages.install("foon-hostile", ENGINES, engines={"endless": "endless"})
    problem = foon_asp.load().problem("ice")
    assert not find_engines()[-1].solve(problem, (U,), frozenset(), 0.5).finished


def test_a_tree_with_a_forbidden_unit_is_none(cli: Cli, packages: Packages) -> None:
    code = "from foon_asp.engines import EngineAnswer\ndef best(problem, objectives, forbidden, seconds):\n"
    problem = foon_asp.load().problem("ice")
    units = foon_asp.solve(problem).ids
    assert units is not None
    code += f"    return EngineAnswer('', objectives, {units}, True)\n"
    packages.install("foon-heedless", code, engines={"heedless": "best"})
    words = ("--constraint", "forbid_motion", "-c", "forbidden_motion=crush")
    ran = cli("solve", "--goal", "ice", "--cross-check", *words)
    assert ran.code == 0
    assert "disagrees and is wrong: the tree of heedless has a unit that the rules forbid (" in ran.out
    agrees = cli("solve", "--goal", "ice", "--cross-check")
    assert "heedless (foon-heedless 1.0) agrees by units (" in agrees.out


def test_an_engine_that_gives_no_answer_is_refused_by_name(cli: Cli, packages: Packages) -> None:
    packages.install("foon-hostile", ENGINES, engines={name: name for name in FAULTS})
    problem = foon_asp.load().problem("ice")
    engines = {engine.name: engine for engine in find_engines()}
    for name, words in FAULTS.items():
        with pytest.raises(UserError) as raised:
            engines[name].solve(problem, (Objective.SUCCESS, U), frozenset(), 60.0)
        start = f"foon-hostile 1.0: {name} (foon_asp.engines, foon_hostile:{name}): "
        assert str(raised.value).startswith(start)
        assert words in str(raised.value)
    ran = cli("solve", "--goal", "ice", "--cross-check")
    assert ran.code == 2
    assert ran.err.startswith("error: foon-hostile 1.0: ")
    assert not ran.out


def test_names_of_engines_are_taken_once(cli: Cli, packages: Packages) -> None:
    packages.install("foon-clash", "", engines={"highs": "solve"})
    ran = cli("solve", "--goal", "ice", "--cross-check")
    assert ran.code == 2
    assert (
        "foon-clash 1.0: highs (foon_asp.engines, foon_clash:solve): the name is taken: foon-asp" in ran.err
    )
    assert cli("solve", "--goal", "ice").code == 0
