"""Catalog, documentation and implementation of linting say the same."""

import re
from pathlib import Path
from typing import NamedTuple

import pytest

from foon_asp.linting.catalog import CATALOG
from tests.conftest import ROOT, Cli

PAGE = (ROOT / "docs" / "lint.md").read_text(encoding="utf-8")
FENCE = re.compile(r"^```(\w+) ?(.*)\n((?:.*\n)*?)```$", re.MULTILINE)


class Example(NamedTuple):
    """What stands under the heading of a code."""

    severity: str
    meaning: str
    files: list[tuple[str, bytes]]
    output: str


def example(section: str) -> Example:
    severity, meaning = re.findall(r"^(\w+): (.*)\.$", section, re.MULTILINE)[0]
    files = []
    output = ""
    for language, words, body in FENCE.findall(section):
        if language == "foon":
            name, _, encoding = words.partition(" ")
            files.append((name, body.replace("→", "\t").encode(encoding or "utf-8")))
        else:
            output += body
    return Example(severity, meaning, files, output)


SECTIONS = dict(re.findall(r"^### (\S+)\n((?:(?!##).*\n)*)", PAGE, re.MULTILINE))


def test_every_code_is_documented_in_the_order_of_the_catalog() -> None:
    assert list(SECTIONS) == list(CATALOG)
    table = re.findall(r"^\| \[`(\S+)`\]\(#(\S+)\) \| (\w+) \| (.*) \| (.*) \|$", PAGE, re.MULTILINE)
    assert [row[:4] for row in table] == [(r.code, r.code, r.severity, r.meaning) for r in CATALOG.values()]


@pytest.mark.parametrize("code", CATALOG)
def test_the_example_of_a_code_gives_what_is_shown(
    code: str, tmp_path: Path, cli: Cli, monkeypatch: pytest.MonkeyPatch
) -> None:
    severity, meaning, files, output = example(SECTIONS[code])
    rule = CATALOG[code]
    assert (severity.lower(), meaning) == (rule.severity, rule.meaning)
    monkeypatch.chdir(tmp_path)
    for name, content in files:
        Path(name).write_bytes(content)
    ran = cli("lint", "--select", code, *(name for name, _ in files))
    assert "".join(ran.out.splitlines(keepends=True)[:-1]) == output
    assert f"{rule.severity}: " in output
    assert f"[{code}]" in output
    mends = re.findall(rf"^\| \[`{code}`\].* \| (.*) \|$", PAGE, re.MULTILINE)[0]
    assert bool(mends.strip()) == ("--fix would mend" in ran.out)
