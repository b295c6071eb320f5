"""The page of a lint rule: its meaning, its example, and the findings in the example."""

from collections.abc import Iterator

from foon_asp.linting.example import Example
from foon_asp.linting.rule import Rule
from foon_asp.results.table import Block


def rule_page(rule: Rule, example: Example) -> Iterator[Block]:
    """Yield the meaning of a rule, its example with tabs drawn as ``→``, and the findings in the example."""
    yield f"{rule.code}: {rule.severity}: {rule.meaning}"
    for paragraph in rule.explanation.split("\n\n"):
        yield from ("", paragraph.replace("\n", " "))
    for name, text in example_texts(example):
        yield from ("", f"{name}:", *(f"    {line}" for line in text.splitlines()))
    yield from ("", *(line for finding in example.findings for line in str(finding).split("\n")))


def example_texts(example: Example) -> Iterator[tuple[str, str]]:
    """Yield the name and the text of each file of an example, with tabs drawn as ``→``."""
    for file, content in example.files.items():
        yield str(file), content.decode(errors="replace").replace("\t", "→")
