"""The codes in ``docs/lint.md``: ``python -m tests.linting`` writes them from the rules and examples."""

import textwrap
from collections.abc import Iterator

from foon_asp.linting.catalog import CATALOG
from foon_asp.linting.example import Example, read_example
from foon_asp.linting.rule import Rule
from foon_asp.report.rule_page import example_texts
from tests.conftest import ROOT

FILE = ROOT / "docs" / "lint.md"
BEGINNING = "## Codes\n"
WIDTH = 120


def page() -> str:
    """Return the page: what people wrote, and below it the codes."""
    written, _, _ = FILE.read_text(encoding="utf-8").partition(BEGINNING)
    examples = {code: read_example(code) for code in CATALOG}
    rows = "".join(_row(rule, examples[code]) for code, rule in CATALOG.items())
    sections = [
        f"### {code}\n\n" + "\n".join(_section(rule, examples[code])) for code, rule in CATALOG.items()
    ]
    head = "| code | severity | meaning | `--fix` |\n|---|---|---|---|\n"
    return f"{written}{BEGINNING}\n{head}{rows}\n" + "\n".join(sections)


def _row(rule: Rule, shown: Example) -> str:
    mends = sum(finding.mendable for finding in shown.findings)
    unsafe = any(finding.unsafe for finding in shown.findings)
    fix = "mends" if mends == len(shown.findings) else "mends some" if mends else "unsafe" if unsafe else ""
    return f"| [`{rule.code}`](#{rule.code}) | {rule.severity} | {rule.meaning} | {fix} |\n"


def _section(rule: Rule, shown: Example) -> Iterator[str]:
    yield f"{rule.severity.capitalize()}: {rule.meaning}.\n"
    for paragraph in rule.explanation.split("\n\n"):
        yield textwrap.fill(paragraph, WIDTH, break_long_words=False, break_on_hyphens=False) + "\n"
    for name, text in example_texts(shown):
        yield f"```foon {name}\n{text.rstrip()}\n```\n"
    findings = "\n".join(map(str, shown.findings))
    yield f"```text\n{findings}\n```\n"


if __name__ == "__main__":
    FILE.write_text(page(), encoding="utf-8")
    print(f"written: {FILE.name}")
