"""Pages of the documentation whose examples are run: commands, files, Python, and what they print."""

import doctest
import re
import shlex
import shutil
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

from foon_asp.json_layout import json_text, read_json
from foon_asp.planning import translator
from tests.conftest import ROOT, Cli

needs_or_tools = pytest.mark.skipif(
    find_spec("ortools") is None, reason="OR-Tools is not installed (foon-asp[schedule])"
)
needs_pandas = pytest.mark.skipif(
    find_spec("pandas") is None, reason="pandas is not installed (foon-asp[notebook])"
)
PAGES = (
    "README.md",
    pytest.param("docs/guide.md", marks=pytest.mark.slow),
    "docs/tutorial-robot.md",
    "docs/tutorial-logic.md",
    "docs/tutorial-planning.md",
    pytest.param("docs/tutorial-frame.md", marks=needs_pandas),
    pytest.param("docs/questions.md", marks=pytest.mark.slow),
    "docs/writing-constraints.md",
    "docs/writing-objectives.md",
    "docs/pddl.md",
    "docs/plans.md",
    "docs/proofs.md",
    "docs/stand-ins.md",
)
# A block with a file name is a file; one without is a session.
FENCE = re.compile(r"^```(?:(?:[\w-]+ )?(\S+\.\w+)|[\w-]*)\n((?:.*\n)*?)```$", re.MULTILINE)


# At the end of a line: how long an answer took, and blanks that fill a table.
LAST = re.compile(r"((?<=optimal )|(?<=easible )) +\d+\.\d\d *$| +$", re.MULTILINE)


def matches(shown: str, printed: str) -> bool:
    """Whether a text is what was printed, whatever time it took; a line ``...`` stands for any lines."""
    shown, printed = LAST.sub("", shown), LAST.sub("", printed)
    pattern = "".join("(?:.*\n)*" if line == "...\n" else re.escape(line) for line in shown.splitlines(True))
    return re.fullmatch(pattern, printed) is not None


def laid_out(printed: str) -> str:
    """JSON with its lines broken anew, since they depend on how long paths in it are; other text as it is."""
    try:
        return json_text(read_json(printed)) if printed.startswith("{") else printed
    except ValueError:
        return printed


@pytest.mark.parametrize("page", PAGES)
@pytest.mark.default_cases(
    "docs/tutorial-planning.md",
    "docs/tutorial-robot.md",
    "docs/pddl.md",
    "docs/plans.md",
    "docs/writing-objectives.md",
    "docs/tutorial-logic.md",
    "docs/stand-ins.md",
)
def test_the_examples_of_a_page(page: str, cli: Cli, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    for folder in ("data", "encodings"):
        Path(folder).symlink_to(ROOT / folder)
    text = (ROOT / page).read_text(encoding="utf-8")
    if "\n$ foon-asp relax" in text and not translator.is_installed():
        pytest.skip("Fast Downward's translator is not installed (foon-asp[pddl])")
    run, lacking = 0, ""
    for name, body in FENCE.findall(text):
        if name:
            Path(name).write_text(body.replace("→", "\t"), encoding="utf-8")
            continue
        for session in re.split(r"^\$ ", body, flags=re.MULTILINE)[1:]:
            command, _, shown = session.partition("\n")
            command, _, target = command.partition(" > ")
            run += 1
            program, *words = shlex.split(command)
            if program == "node":
                if shutil.which("node") is None:
                    lacking = f"node is not installed: {command} was not run"
                    continue
                said = subprocess.run([program, *words], capture_output=True, text=True, check=False).stdout
                assert matches(shown, said), f"{command}\n{said}"
                continue
            if program == "python":
                bare = command.replace("python", shlex.quote(sys.executable), 1)
                said = subprocess.run(bare, shell=True, capture_output=True, text=True, check=False).stdout
                assert matches(shown, said), f"{command}\n{said}"
                continue
            assert program == "foon-asp", command
            if words[0] == "schedule" and find_spec("ortools") is None:
                lacking = f"OR-Tools is not installed (foon-asp[schedule]): {command} was not run"
                continue
            with monkeypatch.context() as both:
                if not target:  # in the order in which a terminal shows them
                    both.setattr(sys, "stderr", sys.stdout)
                ran = cli(*words)
            assert ran.code in {0, 1, 2, 3}, command
            printed = laid_out((ran.err + ran.out).replace(f"{ROOT}/", ""))
            if target:
                Path(target).write_text(ran.out, encoding="utf-8")
                printed = ran.err
            assert matches(shown, printed), f"{command}\n{printed}"
    assert run >= 5
    if lacking:
        pytest.skip(lacking)


@pytest.mark.parametrize(
    ("page", "least"),
    [
        ("docs/api.md", 50),
        ("README.md", 4),
        pytest.param("docs/tutorial-frame.md", 10, marks=needs_pandas),
        pytest.param("docs/plans.md", 8, marks=needs_or_tools),
    ],
)
def test_the_examples_in_python(
    page: str, least: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("data").symlink_to(ROOT / "data")
    text = (ROOT / page).read_text(encoding="utf-8")
    sessions = "\n".join(re.findall(r"^```pycon\n((?:.*\n)*?)```$", text, re.MULTILINE))
    examples = doctest.DocTestParser().get_doctest(sessions, {}, page, page, 0)
    said: list[str] = []
    options = doctest.ELLIPSIS | doctest.REPORT_NDIFF
    ran = doctest.DocTestRunner(optionflags=options).run(examples, out=said.append)
    assert not ran.failed, "".join(said)
    assert ran.attempted >= least
