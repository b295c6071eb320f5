"""One of many questions, and who turns it into a problem."""

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NamedTuple, Protocol

from foon_asp.problem import Problem
from foon_asp.text.json_value import json_line


class Asked(NamedTuple):
    """One question of a batch, by names.

    ``goals`` are made by one tree. ``kitchen`` is a file, ``@starting``, or ``None`` for that of the
    data. ``objective`` is a list by commas of which the first counts most. ``time_limit`` is in seconds.
    ``items`` may be used up, with files for what is in ``stock`` and what ``stays``.
    """

    goals: tuple[str, ...]
    objective: str = "units"
    containers: str = "strict"
    kitchen: Path | None = None
    time_limit: float | None = None
    items: str = "lasting"
    stock: Path | None = None
    stays: Path | None = None

    @property
    def key(self) -> str:
        """The question as text, the same in every run: it identifies a row of results."""
        return json_line(self.shown())

    def shown(self) -> dict[str, object]:
        """Give what was asked, in plain values."""
        files = {"kitchen": self.kitchen, "stock": self.stock, "stays": self.stays}
        return {
            "goal": self.goals[0] if len(self.goals) == 1 else list(self.goals),
            "objective": self.objective,
            "containers": self.containers,
            "items": self.items,
            **{key: None if file is None else str(file) for key, file in files.items()},
            "time_limit": self.time_limit,
        }


class Asker(Protocol):
    """Data that is open, and may be asked again and again."""

    def named(self, word: str, containers: str, kitchen: Path | None) -> Sequence[str]:
        """Give the goals that ``@goals`` or ``@makeable`` stands for, in one-line notation."""

    def problem(self, asked: Asked) -> Problem:
        """Pose a question; raises :class:`UserError` where a goal or a kitchen is not there."""


Opener = Callable[[], Asker]
"""Opens the data, once in each worker: it has to pickle and to have a hash, and equal ones open the same."""
