"""Rules, their examples, the page of codes and ``lint --explain`` say the same."""

import pytest

from foon_asp.linting.catalog import CATALOG
from foon_asp.linting.example import read_example
from tests.conftest import Cli
from tests.linting.__main__ import FILE, page


def test_the_page_has_every_rule_with_its_example() -> None:
    assert page() == FILE.read_text(encoding="utf-8"), "python -m tests.linting writes it anew"


@pytest.mark.parametrize("code", CATALOG)
def test_a_rule_finds_the_slip_in_its_example(code: str, cli: Cli) -> None:
    rule, findings = CATALOG[code], read_example(code).findings
    assert {(finding.code, finding.severity) for finding in findings} == {(code, rule.severity)}
    out = cli("lint", "--explain", code).out
    assert out.startswith(f"{code}: {rule.severity}: {rule.meaning}\n\n{rule.explanation.split()[0]}")
    assert all(f": {rule.severity}: {finding.message} [{code}]\n" in out for finding in findings)
