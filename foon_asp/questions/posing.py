"""Posing: from the options and data of a command line to the problem of a question."""

from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

from foon_asp.dataset import Dataset
from foon_asp.dataset.item_options import items_for
from foon_asp.dataset.paths import File
from foon_asp.errors import UserError
from foon_asp.network import ObjectNode
from foon_asp.problem import Problem

if TYPE_CHECKING:
    from foon_asp.foon import Foon


class Command(Protocol):
    """The command that a question is asked by."""

    @property
    def dataset(self) -> Dataset:
        """The data that the command names, read on first access."""

    @property
    def level(self) -> int:
        """The level at which object nodes are compared."""

    @property
    def names_data(self) -> bool:
        """Whether the command names a network."""

    def given(self, option: str) -> bool:
        """Return whether an option, by name, is on the command line itself."""

    def unnamed_goals(self) -> list[ObjectNode]:
        """Return the goals that are answered one by one, for a command that names no goal."""

    def add_sources(self, sources: Sequence[Path]) -> None:
        """Add networks that are named without an option; the data are read anew."""

    def reading(self) -> AbstractContextManager[object]:
        """Return a context in which reading stops at the limits of the command."""


DATA = (
    "sources",
    "folder",
    "network",
    "kitchen",
    "rates",
    "utensils",
    "goals",
    "unit_prices",
    "unit_amounts",
)
"""The options of a command that name data."""

Pose = Callable[..., tuple[object, ...]]
"""Makes what a function is asked about, its first arguments: of a :class:`Command`, and the options of the
problem by name."""


def one_problem(
    command: Command,
    goals_named: Sequence[str],
    containers: str,
    items: str | None = None,
    stock: File | None = None,
    stays: File | None = None,
    all_goals: bool = False,
    amounts: Sequence[int] = (),
) -> tuple[Problem]:
    """Pose one problem, whose tree makes all goals that are named; with amounts of goals, items are used up.

    Items last for a question that has no ``items``. With ``all_goals``, each goal is a question of its own:
    the named goals, or all of the goals file. Of a large store, the units that the goals can need are read
    on first access.
    """
    dataset = command.dataset
    with command.reading():
        named = dataset.goal_ids(goals_named) if all_goals else dataset.command_goal_ids(goals_named)
        if not named:
            raise UserError("there are no goals: name some with --goal, or a file of them with --goals")
        stated = "lasting" if items is None else items if command.given("items") else None
        used_up = items_for(dataset, named, amounts, stated, stock, stays)
        return (dataset.nearby(tuple(dict.fromkeys(named)), containers, used_up),)


def the_data(command: Command) -> "tuple[Foon]":
    """Return the data as the subject of a question."""
    from foon_asp.foon import Foon  # noqa: PLC0415 (for few questions)

    return (Foon(command.dataset, "the data"),)


def is_for_goals(command: Command, goals_named: Sequence[str]) -> bool:
    """Return whether a picture is of a tree: goals are named, or a recipe is named without an option.

    Raises :class:`UserError` for a recipe with several goals, since a picture is of one tree.
    """
    if goals_named or not command.given("sources"):
        return bool(goals_named)
    goals = command.unnamed_goals()
    if len(goals) > 1:
        raise UserError(
            f"no goal is named, and there are {len(goals)}, too many for one picture: name one (--goal), or "
            "give the file as --network FILE to see the whole network"
        )
    return True


def no_data(command: Command, **named: object) -> tuple[object, ...]:
    """Return only the values of the question's own options, for a command without options for data."""
    return tuple(named.values())
