"""The published table of the literature beside what is measured here."""

import json
from collections.abc import Sequence
from fractions import Fraction
from pathlib import Path
from typing import NamedTuple

from foon_asp.compare.comparison import Comparison
from foon_asp.problem import Objective


class PublishedTable(NamedTuple):
    """Functional units by goal label and search, the container rule they were found under, the source."""

    source: str
    containers: str
    columns: dict[str, str]
    goals: dict[str, dict[str, int]]


def read_published(file: Path) -> PublishedTable:
    """Read the figures that come with the program."""
    table = json.loads(file.read_text(encoding="utf-8"))
    return PublishedTable(table["source"], table["containers"], table["columns"], table["goals"])


def published_markdown(table: PublishedTable, labels: Sequence[str], measured: Sequence[Comparison]) -> str:
    """Lay the figures side by side, published → measured, and count where they agree.

    ``labels`` are the goals of ``measured``, in the same order.
    """
    columns = list(table.columns)
    lines = [
        "Functional units, published → measured; = where they agree",
        "",
        f"| goal | {' | '.join(columns)} | optimum |",
        "|---" * (len(columns) + 2) + "|",
    ]
    agree = dict.fromkeys(columns, 0)
    for label, comparison in zip(labels, measured, strict=True):
        units = {j.search: j.measures.get(Objective.UNITS) for j in comparison.judgements}
        cells = []
        for column in columns:
            published, here = table.goals[label][column], units.get(column)
            agree[column] += here == published
            cells.append(f"{published} =" if here == published else f"{published} → {_number(here)}")
        optimum = comparison.optima[Objective.UNITS]
        best = optimum.status if optimum.value is None else _number(optimum.value)
        lines.append(f"| {label} | {' | '.join(cells)} | {best} |")
    counts = ", ".join(f"{column} {agree[column]} of {len(measured)}" for column in columns)
    return "\n".join([*lines, "", f"Agreeing: {counts}", "", f"Published: {table.source}"]) + "\n"


def _number(value: Fraction | None) -> str:
    return "no tree" if value is None else str(value)
