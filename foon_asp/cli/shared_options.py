"""Options that several verbs share, and the reading of the data that they name."""

import functools
from collections.abc import Callable, Sequence
from pathlib import Path

import click

from foon_asp.cli.click_option import Command, click_options
from foon_asp.cli.exit_code import ExitCode
from foon_asp.cli.named_path import NamedPath, WrittenPath
from foon_asp.cli.output import write_remark_once
from foon_asp.cli.progress_line import bytes_bar
from foon_asp.dataset import Dataset
from foon_asp.dataset.read_dataset import read_dataset as read_data
from foon_asp.deadline import Deadline, LimitError, Watch
from foon_asp.errors import UserError
from foon_asp.questions.options import LIMITS
from foon_asp.text.data_folder import find_data

_DEADLINE = "foon_asp.deadline"
_VERBOSE = "foon_asp.verbose"
_PATH = click.Path(path_type=NamedPath)


lenient_option = click.option(
    "--lenient", is_flag=True, help="Skip lines that are not understood, with a warning."
)

_DATA_OPTIONS = (
    click.option("--data", "folder", type=_PATH, metavar="DIR", help="A folder with all of the following."),
    click.option(
        "--network",
        multiple=True,
        type=_PATH,
        metavar="FILE|DIR|STORE",
        help="FOON text or JSON, repeatable; or a single store.",
    ),
    click.option(
        "--kitchen",
        type=_PATH,
        metavar="FILE",
        help="What is available, and how many: JSON, or FOON objects.",
    ),
    click.option("--rates", type=_PATH, metavar="FILE", help="Success rates of motions."),
    click.option("--utensils", type=_PATH, metavar="FILE", help="Labels of utensils."),
    click.option(
        "--goals", type=_PATH, metavar="FILE", help="Goals that --goal can name: JSON, or FOON objects."
    ),
    click.option("--unit-prices", type=_PATH, metavar="FILE", help="Prices of motions and of single units."),
    click.option(
        "--unit-amounts", type=_PATH, metavar="FILE", help="How many of a node units take and make."
    ),
    lenient_option,
)

sources_argument = click.argument("sources", nargs=-1, type=_PATH, metavar="[RECIPE|DIR|STORE]...")


_MEASURE_OPTION = click.option(
    "--measure",
    "measures",
    type=_PATH,
    multiple=True,
    metavar="FILE.lp",
    help="Rules for your own objectives, cost(NAME,U,N); docs/writing-objectives.md.",
)

_STAND_IN_OPTIONS = (
    click.option(
        "--stand-ins",
        is_flag=True,
        help="Let what the kitchen has be used in place of what it lacks, as little different as possible; "
        "docs/stand-ins.md.",
    ),
    click.option(
        "--stand-in-table",
        "stand_in_tables",
        type=_PATH,
        multiple=True,
        metavar="FILE",
        help="Prices of stand-ins that replace the usual ones, and those of stand_ins.txt in a data folder; "
        "with this, --stand-ins is not needed.",
    ),
    click.option(
        "--similar",
        type=_PATH,
        multiple=True,
        metavar="FILE",
        help="A lexicon: labels that stand in for others, with a price.",
    ),
)

_LEVEL_OPTION = click.option(
    "--level",
    type=click.IntRange(1, 3),
    default=3,
    show_default=True,
    help="Compare object nodes by label (1), by label, states and relations (2), or by everything (3).",
)

_QUIET_OPTION = click.option(
    "--quiet",
    is_flag=True,
    expose_value=False,
    help="Print no warnings, no advice and no progress; errors are printed.",
)


def _store_verbose(context: click.Context, _: click.Parameter, verbose: bool) -> None:
    """Store in the context whether ``-v`` was named, for :func:`is_verbose`."""
    context.meta[_VERBOSE] = verbose


_VERBOSE_OPTION = click.option(
    "-v",
    "--verbose",
    is_flag=True,
    expose_value=False,
    callback=_store_verbose,
    help="List the goals and the items that are assumed where none are given.",
)
_DEBUG_OPTION = click.option(
    "--debug", is_flag=True, expose_value=False, help="Show where in the code an error was raised."
)


def debug_option(command: Command) -> Command:
    """Add ``--quiet`` and ``--debug``, the options that every verb has; ``main`` interprets them."""
    return _QUIET_OPTION(_DEBUG_OPTION(command))


def format_option(*formats: str) -> Callable[[Command], Command]:
    """Return a decorator that adds ``--format`` with some formats, the default first."""
    return click.option(
        "--format", "format_", type=click.Choice(formats), default=formats[0], show_default=True
    )


files_argument = click.argument("paths", nargs=-1, required=True, type=_PATH, metavar="FILE|DIR...")


def output_option(metavar: str, help_: str) -> Callable[[Command], Command]:
    """Return a decorator that adds ``--output``, for which ``-`` is stdout."""
    return click.option("-o", "--output", type=WrittenPath(allow_dash=True), metavar=metavar, help=help_)


def network_options(command: Command) -> Command:
    """Add ``-v``, the options that name data, and the options that every verb has."""
    added = (*_DATA_OPTIONS, _VERBOSE_OPTION, debug_option)
    return functools.reduce(lambda f, option: option(f), reversed(added), command)


def is_verbose() -> bool:
    """Return whether the current command has ``-v``."""
    return bool(click.get_current_context().meta.get(_VERBOSE))


def data_options(command: Command) -> Command:
    """Add the options of :func:`network_options`, and the options for measures, stand-ins and the level."""
    options = (_MEASURE_OPTION, *_STAND_IN_OPTIONS, _LEVEL_OPTION)
    return network_options(functools.reduce(lambda f, option: option(f), reversed(options), command))


def limit_options(command: Callable[..., ExitCode]) -> Callable[..., ExitCode]:
    """Add the options for limits to a command.

    In place of their values, the command gets the ``deadline`` that they set. If a limit stops the command,
    advice is printed. If the limit interrupts it without an answer, :class:`LimitError` is raised instead.
    """

    @functools.wraps(command)
    def limited(time_limit: float | None, memory_limit: int | None, **values: object) -> ExitCode:
        """Call the command with its deadline; if a limit stopped it, print advice.

        If the limit interrupted the command itself, :class:`LimitError` is raised instead.
        """
        deadline = start_deadline(time_limit, memory_limit)
        try:
            code = command(deadline=deadline, **values)
        except KeyboardInterrupt as stop:
            if deadline.stopped is None or deadline.interrupted or isinstance(stop, LimitError):
                raise
            raise LimitError(deadline) from None  # an interrupt of the deadline, in code of a library
        if code is ExitCode.LIMIT and deadline.stopped and not deadline.interrupted:
            click.echo(f"stopped at {deadline.stopped}: {deadline.advice}", err=True)
        return code

    return click_options(*LIMITS)(limited)


def start_deadline(time_limit: float | None, memory_limit: int | None) -> Deadline:
    """Return the deadline of the current command, and store it for :func:`reading`.

    The limits are in seconds and in bytes; ``None`` for no limit. Time counts from the start of the process
    if the process runs only this command, else from now.
    """
    context = click.get_current_context()
    began = context.obj if isinstance(context.obj, float) else None
    deadline = Deadline(time_limit, memory_limit, began)
    context.meta[_DEADLINE] = deadline
    return deadline


def reading() -> Watch:
    """Return a context manager in which reading stops at the limits of the current command, if it has any."""
    context = click.get_current_context(silent=True)
    deadline: Deadline | None = context.meta.get(_DEADLINE) if context else None
    return (deadline or Deadline()).watched("reading", late=True)


def folder_and_networks(
    sources: Sequence[Path], folder: Path | None, network: Sequence[Path]
) -> tuple[Path | None, tuple[Path, ...]]:
    """Return the data folder and the networks that a command names.

    ``sources`` are its arguments; ``folder`` and ``network`` are the values of ``--data`` and ``--network``.
    If a folder is the only argument and neither option is given, it is the data folder. Otherwise, each
    argument is a network.

    Raises :class:`UserError` for a source that does not exist.
    """
    for source in sources:
        if not source.exists():
            raise UserError(f"no such file or folder: {source} (goals are named with --goal)")
    if len(sources) == 1 and sources[0].is_dir() and folder is None and not network:
        return sources[0], ()
    return folder, (*sources, *network)


def read_dataset(
    folder: Path | None,
    network: Sequence[Path],
    kitchen: Path | None,
    rates: Path | None,
    utensils: Path | None,
    goals: Path | None,
    unit_prices: Path | None,
    unit_amounts: Path | None,
    lenient: bool,
    level: int,
    measures: Sequence[Path] = (),
    sources: Sequence[Path] = (),
    stand_ins: bool = False,
    stand_in_tables: Sequence[Path] = (),
    similar: Sequence[Path] = (),
) -> Dataset:
    """Read the data that the options name, with measures and tables of stand-ins; print each warning once.

    ``sources`` are networks named as arguments, as in :func:`folder_and_networks`. Reading stops at the
    limits of the command. The data are closed when the command ends.
    """
    folder, network = folder_and_networks(sources, folder, network)
    with reading():
        files = find_data(folder, network, kitchen, rates, utensils, goals, unit_prices, unit_amounts)
    with bytes_bar("reading", files.network), reading():
        dataset = read_data(files, lenient, level)
        if measures:
            from foon_asp.rules.measure import read_measures

            dataset = dataset.with_measures(read_measures(measures))
        if stand_ins or stand_in_tables or similar:
            from foon_asp.standins.table_file import read_stand_ins

            folder_tables = () if files.stand_ins is None else (files.stand_ins,)
            table = read_stand_ins((*folder_tables, *stand_in_tables), similar, dataset.utensils)
            dataset = dataset.with_stand_in_table(table)
    context = click.get_current_context(
        silent=True
    )  # a worker of a batch has none, and never closes the data
    if context:
        context.call_on_close(dataset.close)
    for text in dataset.brief:
        write_remark_once(text)
    return dataset
