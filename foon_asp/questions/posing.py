"""Posing: functions that make the problem of a question from the options and data of a command line."""

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
    """A command line as seen by functions that pose its problem: its data and its options."""

    @property
    def dataset(self) -> Dataset:
        """The data that the command names, read on first access."""

    @property
    def level(self) -> int:
        """The level at which object nodes are compared."""

    @property
    def names_data(self) -> bool:
        """Whether the command names a network or a folder of data."""

    def given(self, option: str) -> bool:
        """Return whether the value of an option is from the command line, and not a default.

        ``option`` is the name of its parameter.
        """

    def unnamed_goals(self) -> list[ObjectNode]:
        """Return the goals of a command without ``--goal``, which are answered one by one.

        The goals are those that the data list, or else goals that are assumed for the data.
        """

    def add_sources(self, sources: Sequence[Path]) -> None:
        """Add files to the networks of the command; the data are read anew on the next access."""

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
"""A function from a :class:`Command`, and the options of its problem by name, to the first arguments of a
question."""


def pose_problem(
    command: Command,
    goals_named: Sequence[str],
    containers: str,
    items: str | None = None,
    stock: File | None = None,
    stays: File | None = None,
    all_goals: bool = False,
    amounts: Sequence[int] = (),
) -> tuple[Problem]:
    """Return the problem of the named goals, in a tuple; a tree for this problem makes all of its goals.

    With ``all_goals``, the problem is not solved as it is: the caller solves for each goal by itself. If no
    goal is then named, the problem has all goals of the goals file. ``amounts`` are the copies wanted of each
    goal. If there are amounts, items are used up. ``items`` is ``None`` for questions without this option;
    then items last. ``stock`` and ``stays`` are files about items that are used up.

    Of a large store, only the units nearest to the goals are read now. Raises :class:`UserError` if there is
    no goal.
    """
    dataset = command.dataset
    with command.reading():
        named = dataset.goal_ids(goals_named) if all_goals else dataset.command_goal_ids(goals_named)
        if not named:
            raise UserError("there are no goals: name some with --goal, or a file of them with --goals")
        stated = "lasting" if items is None else items if command.given("items") else None
        used_up = items_for(dataset, named, amounts, stated, stock, stays)
        return (dataset.nearby(tuple(dict.fromkeys(named)), containers, used_up),)


def pose_data(command: Command) -> "tuple[Foon]":
    """Return the data of the command as a :class:`Foon` named "the data", in a tuple of one."""
    from foon_asp.foon import Foon  # noqa: PLC0415 (for few questions)

    return (Foon(command.dataset, "the data"),)


def is_picture_of_tree(command: Command, goals_named: Sequence[str]) -> bool:
    """Return whether a picture is of a tree; otherwise, it is of the whole network.

    A picture is of a tree if goals are named, or if a recipe is an argument and not an option. Raises
    :class:`UserError` for a recipe with several goals, since a picture is of one tree.
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


def pose_without_data(command: Command, **named: object) -> tuple[object, ...]:
    """Return the values of ``named``, in order: a question without data takes only its own options."""
    return tuple(named.values())
