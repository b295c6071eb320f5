"""Comparisons as JSON Lines: written as they come, read back to go on after an interruption."""

import hashlib
from collections.abc import Sequence
from fractions import Fraction
from pathlib import Path
from typing import Any, TypeVar

from foon_asp.asp import Settings, Status
from foon_asp.asp.assembly import rules_digest
from foon_asp.compare.comparison import Comparison, Judgement, Optimum
from foon_asp.compare.rows_file import RowsFile
from foon_asp.document.json_document import figure_json, figures_json, fraction_json
from foon_asp.problem import ITEMS, ContainerRule, Objective, Problem
from foon_asp.proof.simulation import Verdict
from foon_asp.search import Ending, Search, SearchSettings
from foon_asp.text.json_value import Json, json_line

Plain = TypeVar("Plain")


def comparison_json(comparison: Comparison) -> Json:
    """Give a comparison in plain values, with nodes in one-line notation; positions count from 1."""
    return {
        "goal": comparison.goal,
        "containers": comparison.containers,
        "items": comparison.items,
        "level": comparison.level,
        "optimum": {
            str(objective): {"status": optimum.status, "value": figure_json(objective, optimum.value)}
            for objective, optimum in comparison.optima.items()
        },
        "searches": [_judgement_json(comparison, judgement) for judgement in comparison.judgements],
    }


def _judgement_json(comparison: Comparison, judgement: Judgement) -> Json:
    obstacle = None
    if judgement.obstacle is not None:
        motion, missing, cycle = judgement.obstacle
        obstacle = {"motion": motion or None, "missing": missing, "cycle": cycle}
    ratios = {str(each): fraction_json(comparison.ratio(judgement, each)) for each in judgement.measures}
    return {
        "search": judgement.search,
        "ending": judgement.ending,
        "stuck_at": judgement.stuck_at,
        "units": None if judgement.units is None else list(judgement.units),
        "measures": figures_json(judgement.measures),
        "ratios": ratios,
        "verdict": judgement.executes,
        "order": [position + 1 for position in judgement.order],
        "obstacle": obstacle,
        "breaks": list(judgement.breaks),
    }


def read_comparison(row: Json) -> Comparison:
    """Turn what :func:`comparison_json` gave into a comparison again.

    Raises one of the errors that :class:`RowsFile` knows for anything else.
    """
    comparison = Comparison(
        _of(row["goal"], str),
        ContainerRule(row["containers"]),
        {
            Objective(name): Optimum(
                Status(o["status"]), None if o["value"] is None else _fraction(o["value"])
            )
            for name, o in row["optimum"].items()
        },
        tuple(map(_judgement, row["searches"])),
        _of(row["level"], int),
        _of(row["items"], str),
    )
    if (
        comparison.level not in {1, 2, 3}
        or comparison.items not in ITEMS
        or comparison_json(comparison) != row
    ):
        raise ValueError("more than what is written, or something else")
    return comparison


def _judgement(row: Json) -> Judgement:
    obstacle, stuck_at, units = row["obstacle"], row["stuck_at"], row["units"]
    return Judgement(
        _of(row["search"], str),
        Ending(row["ending"]),
        None if units is None else tuple(_of(unit, int) for unit in units),
        {Objective(name): _fraction(value) for name, value in row["measures"].items()},
        None if row["verdict"] is None else Verdict(row["verdict"]),
        tuple(_of(position, int) - 1 for position in row["order"]),
        None
        if obstacle is None
        else (
            _of(obstacle["motion"] or "", str),
            _of(obstacle["missing"], str),
            _of(obstacle["cycle"], bool),
        ),
        None if stuck_at is None else _of(stuck_at, str),
        tuple(_of(rule, str) for rule in row["breaks"]),
    )


def _of(value: Any, kind: type[Plain]) -> Plain:
    if type(value) is not kind:
        raise TypeError(f"found {value!r}, expected {kind.__name__}")
    return value


def _fraction(value: Any) -> Fraction:
    text = str(value) if type(value) is int else _of(value["exact"], str)
    if not set(text) <= set("0123456789/-"):  # an exponent could stand for any number of digits
        raise ValueError(f"found {text!r}, expected a fraction")
    return Fraction(text)


def results_question(
    problem: Problem, searches: Sequence[Search], settings: SearchSettings, rules: Settings | None = None
) -> dict[str, object]:
    """Describe what is asked, so that results of another question are not taken for this one's."""
    network = problem.network
    packages = {search.name: search.package for search in searches if search.package is not None}
    digest = hashlib.sha256()
    for part in (
        [str(node) for node in network.objects],
        [network.motions, network.inputs, network.outputs],
        sorted(problem.kitchen),
        sorted(problem.utensils),
        sorted((motion, str(rate)) for motion, rate in (problem.rates or {}).items()),
        *([list(map(str, problem.prices))] if problem.unit_prices else []),
        *(
            []
            if problem.items is None
            else [problem.flows, sorted(map(problem.stock_of, problem.kitchen), key=repr)]
        ),
    ):
        digest.update(json_line(part).encode())
    return {
        "data": digest.hexdigest()[:16],
        "containers": str(problem.containers),
        **({} if problem.items is None else {"items": "used-up"}),
        "level": problem.network.level,
        "searches": [search.name for search in searches],
        **({"packages": packages} if packages else {}),
        "ties": str(settings.ties),
        "count": str(settings.count),
        "published": settings.published,
        "depth_limit": settings.depth_limit,
        "time_limit": settings.time_limit,
        **({} if settings.memory_limit is None else {"memory_limit": settings.memory_limit}),
        **(rules_digest(rules) if rules else {}),
    }


class ResultsFile(RowsFile[Comparison]):
    """A file of comparisons under construction, begun for a question as :class:`RowsFile` says."""

    def __init__(self, path: Path, question: dict[str, object]) -> None:
        super().__init__(path, "compare-row", question, read_comparison)
        self.done = {comparison.goal: comparison for comparison in self.found}

    def add(self, comparison: Comparison) -> None:
        """Write one comparison; it is on the disk when this returns."""
        self.done[comparison.goal] = comparison
        self.write(comparison_json(comparison))
