"""Comparisons as JSON Lines: written as they come, read back to go on after an interruption."""

import json
import os
from collections.abc import Iterator
from fractions import Fraction
from pathlib import Path
from typing import IO, Any, Self

from foon_asp.compare.comparison import Comparison, Judgement, Optimum
from foon_asp.errors import UserError
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
    """A file of comparisons under construction.

    Its first line is the question (data, rule, searches and their settings): a file that was begun for
    another question is refused. Lines are written whole and at once; a last line that an interruption cut
    short is dropped.
    """

    def __init__(self, path: Path, question: dict[str, object]) -> None:
        self.path = path
        self.question = json.loads(json.dumps(question))
        self.done: dict[str, Comparison] = {}
        kept = 0
        if path.exists():
            for row, end in _rows(path):
                if not kept:
                    self._check(row)
                else:
                    comparison = read_comparison(row)
                    self.done[comparison.goal] = comparison
                kept = end
        try:
            self._file: IO[bytes] = path.open("r+b" if path.exists() else "w+b")
        except OSError as error:
            raise UserError(f"{path}: cannot be written: {error.strerror or error}") from None
        self._file.truncate(kept)
        self._file.seek(kept)
        if not kept:
            self._write({"question": self.question})

    def _check(self, row: dict[str, Any]) -> None:
        begun = row.get("question") if isinstance(row, dict) else None
        if begun != self.question:
            raise UserError(
                f"{self.path}: was begun for another question; name another file, or remove this one\n"
                f"  there: {begun}\n  now:   {self.question}"
            )

    def add(self, comparison: Comparison) -> None:
        """Write one comparison; it is on the disk when this returns."""
        self.done[comparison.goal] = comparison
        self._write(comparison_json(comparison))

    def _write(self, row: dict[str, object]) -> None:
        self._file.write(json.dumps(row, ensure_ascii=False).encode() + b"\n")
        self._file.flush()
        os.fsync(self._file.fileno())

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._file.close()


def _rows(path: Path) -> Iterator[tuple[dict[str, Any], int]]:
    """Give the whole lines of a file, decoded, each with the offset of its end."""
    end = 0
    try:
        lines = path.read_bytes().splitlines(keepends=True)
    except OSError as error:
        raise UserError(f"{path}: cannot be read: {error.strerror or error}") from None
    for number, line in enumerate(lines, 1):
        if not line.endswith(b"\n"):
            return
        end += len(line)
        try:
            yield json.loads(line), end
        except ValueError:
            raise UserError(f"{path}:{number}: error: not a line of results; name another file") from None
