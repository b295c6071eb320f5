"""Commands of click for the questions of the catalog, made from the description of each question."""

import contextlib
import sys
import textwrap
from collections.abc import Callable
from pathlib import Path
from typing import Any

import click

from foon_asp.asp.reporter import Reporter
from foon_asp.cli import shared_options
from foon_asp.cli.asking import ask, find_question, values_with_role
from foon_asp.cli.click_option import Command, click_option
from foon_asp.cli.exit_code import ExitCode, exit_code_of
from foon_asp.cli.named_path import WrittenPath
from foon_asp.cli.output import write_data, write_parts
from foon_asp.cli.output_file import check_outputs
from foon_asp.cli.whole_process import keep_until_exit
from foon_asp.deadline import Deadline
from foon_asp.errors import UserError
from foon_asp.problem import ITEMS
from foon_asp.questions.caller import Caller, asked_by
from foon_asp.questions.index import INDEX
from foon_asp.questions.posing import pose_without_data
from foon_asp.questions.question import Question, Role, not_for_used_up_items
from foon_asp.questions.result import NothingToDrawError, NoTreeError, Result, format_method

_LIMITS = frozenset({"time_limit", "memory_limit"})
_NOT_FOR_TERMINALS = {"png": "PNG", "pdf": "PDF", "html": "a page of HTML"}
_ESCAPED_FORMATS = frozenset(
    {"text", "json", "csv", "markdown", "steps", "steps-csv"}
)  # other formats are written unchanged


def question_command(verb: str) -> click.Command:
    """Import the module of a verb, and return the command that asks the question of the verb.

    Its parameters are the options of the question, and the options for limits, formats and data that it
    needs. The command of ``view`` can also serve a page.
    """
    question = find_question(verb)
    command: Callable[..., ExitCode] = _answer_function(question)
    if verb == "view":
        from foon_asp.cli.serve_command import with_serve_option

        command = with_serve_option(command, question)
    command = (
        shared_options.debug_option if question.pose is pose_without_data else shared_options.data_options
    )(command)
    takes_all = any(option.positional and option.many for option in question.options)
    if question.pose is not pose_without_data and not takes_all:  # after the arguments of the question
        command = shared_options.sources_argument(command)
    for option in _format_options(question):
        command = option(command)
    names = {option.name for option in question.options}
    if "containers" in names and "items" not in names:
        command = _without_used_up(verb)(command)
    own_options = [o for o in question.options if not (o.name in _LIMITS and o.role is Role.COMMAND)]
    if len(own_options) < len(question.options):
        command = shared_options.limit_options(command)
    for declared in reversed(own_options):
        command = click_option(declared)(command)
    help_ = f"{INDEX[verb].line}\n\n{textwrap.dedent(question.help).strip()}"
    return click.command(verb, help=help_)(command)


def _without_used_up(verb: str) -> Callable[[Command], Command]:
    """Return a decorator that adds a hidden ``--items``, which refuses ``used-up`` for this verb."""

    def refuse(_: click.Context, __: click.Parameter, value: str) -> None:
        """Raise an error for ``used-up``."""
        if value != "lasting":
            raise not_for_used_up_items(verb)

    return click.option(
        "--items",
        type=click.Choice(ITEMS),
        default="lasting",
        hidden=True,
        expose_value=False,
        callback=refuse,
    )


def _answer_function(question: Question) -> Callable[..., ExitCode]:
    """Return the function that a command calls with the values of its options.

    It asks the question, shows the result or writes it into files, and returns the exit code.
    """

    def answer(
        format_: str | None = None,
        output: Path | None = None,
        deadline: Deadline | None = None,
        **values: Any,
    ) -> ExitCode:
        """Check the output files, call the question, and show or write the result and its charts.

        If there is no tree to go on with, print the message of the :class:`NoTreeError`.
        """
        charts = [file for files in values_with_role(question, values, Role.CHART).values() for file in files]
        if charts:
            from foon_asp.pictures.chart import check_suffix

            for chart in charts:
                check_suffix(chart)
        form = _chosen_format(question, format_, output)
        check_outputs()
        try:
            result = ask(question, values, deadline, form)
            keep_until_exit(result)
        except NoTreeError as error:
            click.echo(str(error), err=True)
            return exit_code_of(error.ending)
        for chart in charts:
            try:
                result.write_chart(chart)
                click.echo(f"wrote {chart}", err=True)
            except NothingToDrawError as error:
                click.echo(f"{chart} is not written: {error}", err=True)
        with asked_by(Caller(Reporter(), deadline=deadline)):
            if output is None:
                _show_result(result, form)
            else:
                _write_result(result, form, output)
        return exit_code_of(result.ending)

    return answer


def _format_options(question: Question) -> list[Callable[[Command], Command]]:
    """Return decorators that add ``--format``, and ``--output`` for a result that can be a file.

    For a question with a single format, the list is empty.
    """
    if len(question.formats) == 1:
        return []
    if not question.suffixes:
        return [shared_options.format_option(*question.formats)]
    default = question.formats[0].upper()
    return [
        click.option(
            "--format",
            "format_",
            type=click.Choice(question.formats),
            help=f"The format, in place of the ending of the file; without a file, {default} to stdout.",
        ),
        click.option(
            "-o",
            "--output",
            type=WrittenPath(),
            metavar="FILE",
            help=f"The file to write; its ending chooses the format ({' '.join(question.suffixes)}).",
        ),
    ]


def _chosen_format(question: Question, format_: str | None, output: Path | None) -> str:
    """Return the format of a result.

    It is ``format_``, else the one for the ending of ``output``, else the default. Raises :class:`UserError`
    for a picture or a page without an output at a terminal.
    """
    form = format_ or (question.formats[0] if output is None else question.format_of(output))
    if form in _NOT_FOR_TERMINALS and output is None and sys.stdout.isatty():
        raise UserError(
            f"a terminal cannot show {_NOT_FOR_TERMINALS[form]}: write it into a file with -o FILE"
        )
    return form


def _show_result(result: Result, format_: str) -> None:
    """Write a result to standard output in a format, and a remark on what the format cannot hold to stderr.

    If there is nothing to draw, only the remark is written.
    """
    if format_ == "text":
        write_parts(result.show())
    elif format_ in _ESCAPED_FORMATS:
        click.echo(getattr(result, format_method(format_))(), nl=False)
    else:
        with contextlib.suppress(NothingToDrawError):  # the remark has the reason
            write_data(getattr(result, format_method(format_))())
    remark = result.remark(format_)
    if remark and format_ != "text":
        click.echo(remark, err=True)


def _write_result(result: Result, format_: str, output: Path) -> None:
    """Write a result into a file in a format; report that, and what the format cannot hold, on stderr.

    If there is nothing to draw, no file is written.
    """
    if remark := result.remark(format_):
        click.echo(remark, err=True)
    with contextlib.suppress(NothingToDrawError):
        result.write(output, format_)
        click.echo(f"wrote {output}", err=True)
