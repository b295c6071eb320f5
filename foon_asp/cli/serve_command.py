"""``view --serve``: the interactive page, until ctrl-C."""

import functools
from collections.abc import Callable
from typing import Any

import click

from foon_asp.asp.assembly import assemble
from foon_asp.cli import shared_options
from foon_asp.cli.exit_code import ExitCode
from foon_asp.dataset.item_options import items_of
from foon_asp.deadline import Deadline
from foon_asp.errors import UserError
from foon_asp.foon import Foon
from foon_asp.problem import parse_objectives
from foon_asp.questions.python_options import settings_of
from foon_asp.questions.question import Question

_FILE_OPTIONS = {"output": "-o", "format_": "--format"}


def with_serve_option(command: Callable[..., ExitCode], question: Question) -> Callable[..., ExitCode]:
    """Return the command of ``view`` with the option ``--serve``, which serves a page in place of an answer.

    The options of the ``question`` are for the page; all other options are for the data.
    """
    option_names = {option.name for option in question.options}

    @functools.wraps(command)
    def answer_or_serve(serve: bool, **values: Any) -> ExitCode:
        """Serve the page if ``serve``, else call the command.

        Raises :class:`UserError` for an output file or a format beside ``--serve``.
        """
        if not serve:
            return command(**values)
        for name, flag in _FILE_OPTIONS.items():
            if values.pop(name, None):
                raise UserError(f"found {flag} beside --serve: what the page shows is written into no file")
        deadline: Deadline | None = values.pop("deadline", None)
        question_options = {name: values.pop(name) for name in option_names & values.keys()}
        return _serve(question_options, values, deadline or Deadline())

    help_ = "Serve a page on this machine that asks again, until ctrl-C; needs foon-asp[view]."
    return click.option("--serve", is_flag=True, help=help_)(answer_or_serve)


def _serve(question_values: dict[str, Any], data_values: dict[str, Any], deadline: Deadline) -> ExitCode:
    """Serve the page until ctrl-C, and print its address.

    ``question_values`` and ``data_values`` are the values of options by name. The limits of the ``deadline``
    are for each answer. Raises :class:`UserError` if a package is missing, or for wrong rules.
    """
    try:
        from foon_asp.serve.desk import Desk
        from foon_asp.serve.form import Form
        from foon_asp.serve.server import serve_desk
    except ImportError as error:
        raise UserError(f"--serve needs more packages ({error}): pip install 'foon-asp[view]'") from None
    dataset = shared_options.read_dataset(**data_values)
    form = Form(
        goals=tuple(question_values["goals_named"]),
        objectives=tuple(map(str, parse_objectives(question_values["objectives"], dataset.measures))),
        containers=question_values["containers"],
        items=question_values["items"],
        beside=tuple(question_values["beside"]),
    )
    settings = settings_of(
        {
            "constraints": question_values["constraints"],
            "constants": question_values["constants"],
            "encodings": question_values["encodings"],
        }
    )
    example = dataset.problem((0,), form.containers)
    # to report errors in files of rules before the page is opened
    assemble(settings, functools.partial(click.echo, err=True), problem=example)
    used_up = items_of(dataset, question_values["items"], question_values["stock"], question_values["stays"])
    desk = Desk(Foon(dataset, "the data"), form, deadline.seconds, deadline.memory, settings, used_up)
    serve_desk(desk, lambda address: click.echo(f"{address}\nopen this in a browser; ctrl-C ends it"))
    return ExitCode.DONE
