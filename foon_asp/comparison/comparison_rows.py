"""Comparisons as rows of a file, and the question that all rows of a file answer."""

import hashlib
from collections.abc import Sequence

import msgspec

from foon_asp.asp import Settings
from foon_asp.asp.assembly import rules_digest
from foon_asp.comparison.comparison import Comparison
from foon_asp.comparison.rows_file import RowForm
from foon_asp.json_layout import Json, json_line
from foon_asp.problem import Objective, Problem
from foon_asp.proof.certificate_subject import Subject
from foon_asp.results.plain_values import plain, read_plain
from foon_asp.searches import Search, SearchSettings


def read_comparison(row: Json) -> Comparison:
    """Read back a comparison from a row of a file, given as plain values.

    For a value that is no such row, raises one of the errors that :class:`RowForm` lists.
    """
    searches = [
        search | {name: _by_objective(search[name]) for name in ("measures", "ratios")}
        for search in row["searches"]
    ]
    fields = row | {"optimum": _by_objective(row["optimum"]), "searches": searches}
    comparison = read_plain(Comparison, fields)
    if json_line(plain(comparison)) != json_line(row):
        raise ValueError("more than what is written, or something else")
    return comparison


def _by_objective(values: Json) -> dict[Objective, object]:
    """Return values by objective in place of its name; raises :class:`ValueError` for another name."""
    return {Objective(name): value for name, value in values.items()}


COMPARISONS = RowForm("compare-row", plain, read_comparison, lambda comparison: comparison.goal.node)


def comparisons_question(
    problem: Problem, searches: Sequence[Search], settings: SearchSettings, rules: Settings | None = None
) -> Json:
    """Return the question of a file of comparisons: a digest of the data, searches, settings and rules.

    The question does not depend on the goals. It is the first line of the file. A run continues a file only
    if the questions of both are equal.
    """
    subject = Subject(problem.network, problem.kitchen, problem.rates, problem.utensils, problem.unit_prices)
    data: list[object] = [subject.digests()]
    if problem.items is not None:
        data += [list(problem.flows), sorted(map(problem.stock_of, problem.kitchen), key=repr)]
    return {
        "data": hashlib.sha256(json_line(data).encode()).hexdigest()[:16],
        "containers": str(problem.containers),
        "level": problem.network.level,
        "searches": {search.name: search.package for search in searches},
        **msgspec.to_builtins(settings),
        **(rules_digest(rules) if rules else {}),
    }
