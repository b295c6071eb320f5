"""Comparisons as JSON Lines: written as they come, read back to go on after an interruption."""

from fractions import Fraction
from pathlib import Path
from typing import Any, Self

from foon_asp.compare.comparison import Comparison, Judgement, Optimum
from foon_asp.compare.rows_file import RowsFile
from foon_asp.problem import Objective


def comparison_json(comparison: Comparison) -> dict[str, object]:
    """Give a comparison in plain values; numbers that may be fractions are texts such as ``27/1250``."""
    return {
        "goal": comparison.goal,
        "containers": comparison.containers,
        "level": comparison.level,
        "optimum": {
            str(objective): {"status": optimum.status, "value": _text(optimum.value)}
            for objective, optimum in comparison.optima.items()
        },
        "searches": [_judgement_json(comparison, judgement) for judgement in comparison.judgements],
    }


def _judgement_json(comparison: Comparison, judgement: Judgement) -> dict[str, object]:
    obstacle = None
    if judgement.obstacle is not None:
        motion, missing, cycle = judgement.obstacle
        obstacle = {"motion": motion or None, "missing": missing, "cycle": cycle}
    return {
        "search": judgement.search,
        "ending": judgement.ending,
        "stuck_at": judgement.stuck_at,
        "units": None if judgement.units is None else list(judgement.units),
        "measures": {str(objective): str(value) for objective, value in judgement.measures.items()},
        "ratios": {
            str(objective): _text(comparison.ratio(judgement, objective)) for objective in judgement.measures
        },
        "executes": judgement.executes,
        "order": list(judgement.order),
        "obstacle": obstacle,
    }


def _text(value: Fraction | None) -> str | None:
    return None if value is None else str(value)


def read_comparison(row: dict[str, Any]) -> Comparison:
    """Turn what :func:`comparison_json` gave into a comparison again."""
    return Comparison(
        row["goal"],
        row["containers"],
        {
            Objective(name): Optimum(o["status"], None if o["value"] is None else Fraction(o["value"]))
            for name, o in row["optimum"].items()
        },
        tuple(
            Judgement(
                s["search"],
                s["ending"],
                None if s["units"] is None else tuple(s["units"]),
                {Objective(name): Fraction(value) for name, value in s["measures"].items()},
                s["executes"],
                tuple(s["order"]),
                None
                if s["obstacle"] is None
                else (s["obstacle"]["motion"] or "", s["obstacle"]["missing"], s["obstacle"]["cycle"]),
                s["stuck_at"],
            )
            for s in row["searches"]
        ),
        row["level"],
    )


class ResultsFile:
    """A file of comparisons under construction, begun for a question as :class:`RowsFile` says."""

    def __init__(self, path: Path, question: dict[str, object]) -> None:
        self._rows = RowsFile(path, question)
        found = map(read_comparison, self._rows.found)
        self.done: dict[str, Comparison] = {comparison.goal: comparison for comparison in found}

    def add(self, comparison: Comparison) -> None:
        """Write one comparison; it is on the disk when this returns."""
        self.done[comparison.goal] = comparison
        self._rows.write(comparison_json(comparison))

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._rows.__exit__()
