"""Tables that programs write into a page: each stands between two comments that name it."""

from pathlib import Path


def put(page: Path, section: str, text: str) -> None:
    """Replace what stands between ``<!-- begin SECTION -->`` and ``<!-- end SECTION -->``.

    Raises :class:`ValueError` where the page does not have both, once each.
    """
    marks = f"<!-- begin {section} -->", f"<!-- end {section} -->"
    before = page.read_text(encoding="utf-8")
    if any(before.count(mark) != 1 for mark in marks):
        raise ValueError(f"{page}: expected {marks[0]} and {marks[1]}, once each")
    head, _, rest = before.partition(marks[0])
    _, _, tail = rest.partition(marks[1])
    page.write_text(f"{head}{marks[0]}\n{text.strip()}\n{marks[1]}{tail}", encoding="utf-8")


def table(header: list[str], rows: list[list[str]]) -> str:
    """Lay out a table in Markdown, the first column to the left and all others to the right."""
    rule = ["---", *["---:"] * (len(header) - 1)]
    return "\n".join("| " + " | ".join(row) + " |" for row in [header, rule, *rows])
