"""One of many questions, and who turns it into a problem."""

from collections.abc import Callable, Sequence
from typing import Annotated, Protocol

from msgspec import Meta, Struct

from foon_asp.problem import ContainerRule, Problem

Name = Annotated[str, Meta(min_length=1)]
Goals = Name | Annotated[tuple[Name, ...], Meta(min_length=1)]
Seconds = Annotated[float, Meta(ge=0, le=1e9)]  # at most some thirty years


class Asked(Struct, frozen=True):
    """One question of a batch, by names, as a line of JSON has it.

    Several goals are made by one tree. ``kitchen`` is a file, ``@starting``, or ``None`` for that of the
    data. ``objective`` is a list by commas of which the first counts most. ``time_limit`` is in seconds.
    ``items`` may be used up, with files for what is in ``stock`` and what ``stays``.
    """

    goal: Goals
    objective: Name = "units"
    containers: ContainerRule = ContainerRule.STRICT
    items: Name = "lasting"
    kitchen: Name | None = None
    stock: Name | None = None
    stays: Name | None = None
    time_limit: Seconds | None = None

    @property
    def goals(self) -> tuple[str, ...]:
        """The goals that one tree makes."""
        return (self.goal,) if isinstance(self.goal, str) else self.goal


class Asker(Protocol):
    """Data that is open, and may be asked again and again."""

    def named(self, word: str, containers: ContainerRule, kitchen: str | None) -> Sequence[str]:
        """Return the goals that ``@goals`` or ``@makeable`` stands for, in one-line notation."""

    def problem(self, asked: Asked) -> Problem:
        """Pose a question; raises :class:`UserError` where a goal or a kitchen is not there."""


Opener = Callable[[], Asker]
"""Opens the data, once in each worker: it has to pickle and to have a hash, and equal ones open the same."""
