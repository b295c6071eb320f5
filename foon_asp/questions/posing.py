"""What a question is about, made of what a command line says and the data it names."""

from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

from foon_asp.dataset import Dataset
from foon_asp.dataset.items import items_of
from foon_asp.dataset.paths import File
from foon_asp.errors import UserError
from foon_asp.problem import Problem
from foon_asp.questions.result import Result

if TYPE_CHECKING:
    from foon_asp.foon import Foon


class Command(Protocol):
    """The command that a question is asked by."""

    @property
    def dataset(self) -> Dataset:
        """The data that it names; read when it is first looked at."""

    def ask(self, words: str, without: Sequence[str]) -> Result:
        """Ask a question that is written as a command; ``without`` names options that it must not have.

        What stands beside it counts where it does not say it itself; a question that names data of its own
        takes none from there.
        """

    def given(self, option: str) -> bool:
        """Whether an option, by name, stands in its own words."""

    def add_sources(self, sources: Sequence[Path]) -> None:
        """Add networks that are named without an option, before the data are read."""

    def reading(self) -> AbstractContextManager[object]:
        """Stop what is read in a ``with`` block at the limits of the command."""


DATA = ("sources", "folder", "network", "kitchen", "rates", "utensils", "goals", "unit_prices")
"""The options of a command that name data."""

Pose = Callable[..., tuple[object, ...]]
"""Makes what a function is asked about, its first arguments: of a :class:`Command`, and the options of the
problem by name."""


def one_problem(
    command: Command,
    goals_named: Sequence[str],
    containers: str,
    items: str = "lasting",
    stock: File | None = None,
    stays: File | None = None,
) -> tuple[Problem]:
    """Pose one problem, whose tree makes all goals that are named."""
    dataset = command.dataset
    with command.reading():
        how = items_of(dataset, items, stock, stays)
        return (dataset.problem(dataset.goals(goals_named), containers, items=how),)


def one_problem_or_nearby(
    command: Command,
    goals_named: Sequence[str],
    containers: str,
    items: str = "lasting",
    stock: File | None = None,
    stays: File | None = None,
) -> tuple[Problem]:
    """Pose one problem; what its goals can need of a large store is read when it is looked at."""
    dataset = command.dataset
    with command.reading():
        how = items_of(dataset, items, stock, stays)
        return (dataset.nearby(dataset.goals(goals_named), containers, how),)


def the_data(command: Command) -> "tuple[Foon]":
    """Ask about the data as a whole."""
    from foon_asp.foon import Foon  # noqa: PLC0415 (for few questions)

    return (Foon(command.dataset, "the data"),)


def no_data(command: Command, **named: object) -> tuple[object, ...]:
    """Ask about something that the question names itself; its command has no options for data."""
    return tuple(named.values())


def each_goal_or_nearby(
    command: Command,
    goals_named: Sequence[str],
    containers: str,
    items: str = "lasting",
    stock: File | None = None,
    stays: File | None = None,
) -> tuple[Problem]:
    """Pose the same as :func:`each_goal`; of a large store, what they can need is read when looked at."""
    dataset = command.dataset
    with command.reading():
        how = items_of(dataset, items, stock, stays)
        return (dataset.nearby(_each(dataset, goals_named), containers, how),)


def _each(dataset: Dataset, goals_named: Sequence[str]) -> tuple[int, ...]:
    goals = dataset.each_goal(goals_named)
    if not goals:
        raise UserError("there are no goals: name some with --goal, or a file of them with --goals")
    return tuple(dict.fromkeys(goals))


def each_goal(
    command: Command,
    goals_named: Sequence[str],
    containers: str,
    items: str = "lasting",
    stock: File | None = None,
    stays: File | None = None,
) -> tuple[Problem]:
    """Pose goals that are a question of their own each: those that are named, or all of the goals file."""
    dataset = command.dataset
    with command.reading():
        how = items_of(dataset, items, stock, stays)
        return (dataset.problem(_each(dataset, goals_named), containers, items=how),)
