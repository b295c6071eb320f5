"""Options that several verbs share, and reading the data they name."""

import functools
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple, TypeVar

import click

from foon_asp.cli.exit_code import ExitCode
from foon_asp.cli.named_path import NamedPath
from foon_asp.dataset import Dataset, dataset_files
from foon_asp.dataset.reading import read_dataset as read_data
from foon_asp.deadline import Deadline, LimitError, Watch, memory_size, seconds
from foon_asp.errors import UserError
from foon_asp.problem import ContainerRule, Objective

if TYPE_CHECKING:  # clingo, which often is not needed
    from foon_asp.asp.session import Session

Command = TypeVar("Command", bound=Callable[..., object])
_DEADLINE = "foon_asp.deadline"
_PATH = click.Path(path_type=NamedPath)


class Held(NamedTuple):
    """What a session has read, for the verbs that are asked within it, and how it was read.

    ``session`` keeps what was grounded; ``files`` are those that were read. ``constraints``, ``constants``
    and ``encodings`` are the rules that stand: a line of the session adds to them, and takes none away.
    """

    dataset: Dataset
    lenient: bool
    level: int
    session: "Session"
    files: tuple[Path, ...]
    constraints: tuple[Path, ...]
    constants: tuple[str, ...]
    encodings: Path | None


def with_rules_that_stand(
    context: click.Context, _: click.Parameter, value: tuple[Path, ...]
) -> tuple[Path, ...]:
    """Add constraints to those that stand in the session, if a verb is asked in one."""
    here = context.find_object(Held)
    standing = () if here is None else here.constraints
    return tuple(dict.fromkeys((*standing, *value)))


def with_constants_that_stand(
    context: click.Context, _: click.Parameter, value: tuple[str, ...]
) -> tuple[str, ...]:
    """Add constants to those that stand; another value for one of these would change a rule that stands."""
    here = context.find_object(Held)
    standing = () if here is None else here.constants
    values = dict(setting.split("=", 1) for setting in standing)
    for setting in value:
        name = setting.partition("=")[0]
        if name in values and setting not in standing:
            raise UserError(
                f"{name}={values[name]} stands, and {setting!r} on this line would change that rule: "
                "constraint NAME CONSTANT=VALUE replaces it, and drop takes it away"
            )
    return (*standing, *(setting for setting in value if setting not in standing))


def encodings_that_stand(context: click.Context, _: click.Parameter, value: Path | None) -> Path | None:
    """Give the encodings that stand in the session; others would be of another question."""
    here = context.find_object(Held)
    if here is None or here.encodings is None:
        return value
    if value not in {None, here.encodings}:
        raise UserError(
            f"the encodings of {here.encodings} stand in this session; those of {value} need one of their own"
        )
    return here.encodings


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
        callback=with_rules_that_stand,
        help="Add an encoding of yours, or one of ours by name; repeatable.",
    ),
    click.option(
        "--encodings",
        type=_PATH,
        metavar="DIR",
        callback=encodings_that_stand,
        help="Use the encodings of a folder instead of ours.",
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

soft_option = click.option(
    "--soft",
    multiple=True,
    metavar="FILE.lp=WEIGHT",
    help="Constraints that may be broken, each way at that price; the least sum comes first.",
)

constant_option = click.option(
    "-c",
    "constants",
    multiple=True,
    metavar="NAME=VALUE",
    callback=with_constants_that_stand,
    help="Set a #const of an encoding; repeatable.",
)


_LIMIT_OPTIONS = (
    click.option(
        "--time-limit",
        type=seconds,
        metavar="SECONDS",
        help="Stop after so long, with the best known and its bound.",
    ),
    click.option(
        "--memory-limit",
        type=memory_size,
        metavar="SIZE",
        help="Stop likewise at so much memory: 500M, 2G. On Linux only.",
    ),
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


def each_limit_options(command: Command) -> Command:
    """Add the limits of each answer that a command gives: ``time_limit`` and ``memory_limit``."""
    return functools.reduce(lambda f, option: option(f), reversed(_LIMIT_OPTIONS), command)


def limit_options(command: Callable[..., ExitCode]) -> Callable[..., ExitCode]:
    """Add the limits of a whole command, from reading on: ``deadline``. At the end it says what to do."""

    @functools.wraps(command)
    def limited(time_limit: float | None, memory_limit: int | None, **given: object) -> ExitCode:
        deadline = begin(time_limit, memory_limit)
        try:
            code = command(deadline=deadline, **given)
        except KeyboardInterrupt as stop:
            if deadline.stopped is None or deadline.interrupted or isinstance(stop, LimitError):
                raise
            raise LimitError(deadline) from None  # it struck where nobody says so
        if code is ExitCode.LIMIT and deadline.stopped and not deadline.interrupted:
            click.echo(f"stopped at {deadline.stopped}: {deadline.advice}", err=True)
        return code

    return each_limit_options(limited)


def begin(time_limit: float | None, memory_limit: int | None) -> Deadline:
    """Let the limits of the command at hand begin."""
    deadline = Deadline(time_limit, memory_limit)
    click.get_current_context().meta[_DEADLINE] = deadline
    return deadline


def reading() -> Watch:
    """Stop what is read in a ``with`` block at the limits of the command, if it has any."""
    context = click.get_current_context(silent=True)
    deadline: Deadline | None = context.meta.get(_DEADLINE) if context else None
    return (deadline or Deadline()).watched("reading", late=True)


def held() -> Held | None:
    """Give what the session has in which a verb is asked, if it is asked in one."""
    context = click.get_current_context(silent=True)
    return context.find_object(Held) if context else None


def session_here() -> "Session | None":
    """Give what keeps ground programs for the next question, if there may be one."""
    here = held()
    return here.session if here else None


def read_dataset(
    folder: Path | None,
    network: Sequence[Path],
    kitchen: Path | None,
    rates: Path | None,
    utensils: Path | None,
    goals: Path | None,
    lenient: bool,
    level: int,
    kitchen_expected: bool = True,
) -> Dataset:
    """Read the data that the options name; warnings go to stderr. Within a session it is there already."""
    here = held()
    if here:
        if any((folder, network, kitchen, rates, utensils, goals)) or (lenient, level) != here[1:3]:
            raise UserError(
                "the data of a session is what it was started with; another kitchen is given by: kitchen FILE"
            )
        return here.dataset
    with reading():
        files = dataset_files(folder, network, kitchen, rates, utensils, goals)
        dataset = read_data(files, lenient, level)
    context = click.get_current_context(silent=True)  # a worker of a batch has none, and reads until it ends
    if context:
        context.call_on_close(dataset.close)
    for text in dataset.remarks:
        click.echo(text, err=True)
    if not dataset.has_kitchen and kitchen_expected:
        click.echo("warning: no kitchen is given, so nothing is at hand; name one with --kitchen", err=True)
    return dataset
