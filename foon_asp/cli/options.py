"""Options that several verbs share, and reading the data they name."""

import functools
import time
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple, TypeVar

import click

from foon_asp.errors import UserError
from foon_asp.network import FunctionalUnit, Network
from foon_asp.problem import ContainerRule, Objective, Problem
from foon_asp.resources import bundled_kitchen
from foon_asp.text import (
    Data,
    DataFiles,
    ListedObject,
    NodeNames,
    find_data,
    find_goal,
    is_store,
    kitchen_nodes,
    listed_nodes,
    read_data,
    summarize,
)

if TYPE_CHECKING:  # clingo, which often is not needed
    from foon_asp.asp.session import Session

Command = TypeVar("Command", bound=Callable[..., object])
_PATH = click.Path(path_type=Path)

_DATA_OPTIONS = (
    click.option("--data", "folder", type=_PATH, metavar="DIR", help="Folder with all of the following."),
    click.option(
        "--network",
        multiple=True,
        type=_PATH,
        metavar="FILE|DIR|STORE",
        help="FOON text or JSON, repeatable; or one store.",
    ),
    click.option("--kitchen", type=_PATH, metavar="FILE", help="What is at hand: JSON, or FOON objects."),
    click.option("--rates", type=_PATH, metavar="FILE", help="Success rates of motions."),
    click.option("--utensils", type=_PATH, metavar="FILE", help="Labels of utensils."),
    click.option("--goals", type=_PATH, metavar="FILE", help="Goals that --goal can name, likewise."),
    click.option("--lenient", is_flag=True, help="Leave out lines that are not understood, with a warning."),
)

_LEVEL_OPTION = click.option(
    "--level",
    type=click.IntRange(1, 3),
    default=3,
    show_default=True,
    help="What counts of an object node: 3 all of it, 2 without contents, 1 the label.",
)

_CONSTRAINT_OPTIONS = (
    click.option(
        "--constraint",
        "constraints",
        multiple=True,
        type=_PATH,
        metavar="FILE.lp",
        help="Add an encoding of yours, or one of ours by name; repeatable.",
    ),
    click.option(
        "--encodings", type=_PATH, metavar="DIR", help="Use the encodings of a folder instead of ours."
    ),
)

goal_option = click.option(
    "--goal",
    "goals_named",
    multiple=True,
    metavar="NAME",
    help="Label or one-line notation of a goal; repeat for one tree that makes all.",
)

objective_option = click.option(
    "--objective",
    "objectives",
    multiple=True,
    default=("units",),
    show_default=True,
    metavar="LIST",
    help=f"What is best, most important first: {', '.join(Objective)}.",
)

containers_option = click.option(
    "--containers",
    type=click.Choice([str(rule) for rule in ContainerRule]),
    default="strict",
    show_default=True,
    help="Whether a unit needs every input, or takes utensils that hold one of them as given.",
)

constant_option = click.option(
    "-c", "constants", multiple=True, metavar="NAME=VALUE", help="Set a #const of an encoding; repeatable."
)

time_limit_option = click.option(
    "--time-limit",
    type=click.FloatRange(min=0),
    metavar="SECONDS",
    help="Stop searching after so long, with the best tree and its bound.",
)

debug_option = click.option(
    "--debug", is_flag=True, expose_value=False, help="Show where an error was raised."
)


def format_option(*formats: str) -> Callable[[Command], Command]:
    """Make ``--format`` with the formats of a verb, the first by default."""
    return click.option(
        "--format", "format_", type=click.Choice(formats), default=formats[0], show_default=True
    )


def network_options(command: Command) -> Command:
    """Add the options that name the data."""
    return functools.reduce(lambda f, option: option(f), reversed((*_DATA_OPTIONS, debug_option)), command)


def data_options(command: Command) -> Command:
    """Add the options that name the data, and the level at which it is taken."""
    return network_options(_LEVEL_OPTION(command))


def constraint_options(command: Command) -> Command:
    """Add the options that add or replace encodings."""
    return functools.reduce(lambda f, option: option(f), reversed(_CONSTRAINT_OPTIONS), command)


def ask(data: Data, goals: Sequence[int], containers: str) -> Problem:
    """Ask for goals of the network under a container rule."""
    rule = ContainerRule(containers)
    return Problem(data.network, data.kitchen, tuple(goals), data.rates, data.utensils, rule)


class Question:
    """The data that the options name, read, and how many seconds that took.

    Verbs ask for goals and problems and leave the rest to it; ``data`` is everything, for those that need it.
    ``session`` keeps what was grounded, where there is a session.
    """

    session: "Session | None" = None

    def __init__(self, data: Data, read_seconds: float) -> None:
        self._data = data
        self.read_seconds = read_seconds

    @property
    def data(self) -> Data:
        """Everything there is."""
        return self._data

    @property
    def listed(self) -> Sequence[ListedObject]:
        """The entries of the goals file."""
        return self.data.goals

    @property
    def names(self) -> Network | NodeNames:
        """What goals are looked up in."""
        return self.data.network

    def goals(self, names: Sequence[str]) -> tuple[int, ...]:
        """Find the goals by name; without a name, the goals file has to hold exactly one."""
        if not names and len(self.listed) == 1:
            names = [self.listed[0].pattern.label]
        if not names:
            listed = "\n".join(f"  --goal {entry.pattern.label!r}" for entry in self.listed)
            raise UserError("name a goal with --goal" + (f"; the goals file has\n{listed}" if listed else ""))
        return tuple(dict.fromkeys(self.each_goal(names)))

    def each_goal(self, names: Sequence[str]) -> list[int]:
        """Find one goal for each name; without names, all nodes of the goals file."""
        if names:
            return [find_goal(name, self.names, self.listed) for name in names]
        return [node for entry in self.listed for node in listed_nodes(entry, self.names)]

    def with_kitchen(self, items: Sequence[ListedObject]) -> "Question":
        """Give the same data with another kitchen."""
        kitchen = kitchen_nodes(self.data.network, items)
        data = self.data._replace(kitchen=kitchen, kitchen_items=tuple(items))
        return Question(data, self.read_seconds)

    @property
    def motions(self) -> list[str]:
        """The motions of the network, in alphabetical order."""
        return sorted(set(self.data.network.motions))

    @property
    def at_hand(self) -> frozenset[int]:
        """The object nodes of the kitchen, by id."""
        return self.data.kitchen

    def with_changes(self, added: frozenset[int], removed: frozenset[int]) -> "Question":
        """Give the same data with object nodes added to the kitchen and taken from it."""
        data = self.data._replace(kitchen=self.data.kitchen - removed | added)
        return Question(data, self.read_seconds)

    def problem(self, goals: Sequence[int], containers: str, everything: bool = False) -> Problem:
        """Ask for goals, which are those of the problem in the same order, under a container rule.

        ``everything`` asks for units that no goal needs to be there too.
        """
        return ask(self.data, goals, containers)

    def part(
        self, goals: Sequence[int], units: Iterable[int] = (), tree: Iterable[FunctionalUnit] = ()
    ) -> tuple[Data, tuple[int, ...]]:
        """Give data with at least these goals, these units by id, and what a tree is made of.

        With it come the ids that the goals have there. Raises :class:`UserError` for ids of no unit.
        """
        self._check_units(units, len(self.data.network))
        return self.data, tuple(goals)

    def _check_units(self, units: Iterable[int], count: int) -> None:
        for unit in units:
            if not 0 <= unit < count:
                raise UserError(f"there is no unit {unit}: the network has units 0 to {count - 1}")


class Held(NamedTuple):
    """What a session has read, for the verbs that are asked within it, and how it was read."""

    question: Question
    lenient: bool
    level: int


def data_files(
    folder: Path | None,
    network: Sequence[Path],
    kitchen: Path | None,
    rates: Path | None,
    utensils: Path | None,
    goals: Path | None,
) -> DataFiles:
    """Find the files that the options name: those of the bundled kitchen without --data and --network."""
    if folder is None and not network:
        folder = bundled_kitchen()
    return find_data(folder, network, kitchen, rates, utensils, goals)


def read_question(
    folder: Path | None,
    network: Sequence[Path],
    kitchen: Path | None,
    rates: Path | None,
    utensils: Path | None,
    goals: Path | None,
    lenient: bool,
    level: int,
    kitchen_expected: bool = True,
) -> Question:
    """Read the data that the options name; warnings go to stderr.

    Without --data and --network it is the bundled kitchen. A network of its own does not get the bundled
    kitchen and rates, which are made for another one. Within a session the data is there already.
    """
    context = click.get_current_context(silent=True)
    held = context and context.find_object(Held)
    if held:
        if any((folder, network, kitchen, rates, utensils, goals)) or (lenient, level) != held[1:]:
            raise UserError(
                "the data of a session is what it was started with; another kitchen is given by: kitchen FILE"
            )
        return held.question
    began = time.perf_counter()
    files = data_files(folder, network, kitchen, rates, utensils, goals)
    if any(map(is_store, files.network)):
        from foon_asp.cli.stored_question import read_stored

        return read_stored(files, level, kitchen_expected)
    data = read_data(files, lenient, level)
    seconds = time.perf_counter() - began
    for text in summarize(data.warnings):
        click.echo(text, err=True)
    if data.left_out:
        lines = "1 line" if data.left_out == 1 else f"{data.left_out} lines"
        click.echo(f"warning: {lines} left out", err=True)
    if files.kitchen is None and kitchen_expected:
        click.echo("warning: no kitchen is given, so nothing is at hand; name one with --kitchen", err=True)
    return Question(data, seconds)
