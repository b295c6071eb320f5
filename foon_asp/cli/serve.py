"""``view --serve``: the page that asks again, until ctrl-C."""

import functools
from collections.abc import Callable
from typing import Any

import click

from foon_asp.asp.assembly import assemble
from foon_asp.cli import options
from foon_asp.cli.exit_code import ExitCode
from foon_asp.dataset.items import items_of
from foon_asp.deadline import Deadline
from foon_asp.errors import UserError
from foon_asp.foon import Foon
from foon_asp.problem import parse_objectives
from foon_asp.questions.common_options import settings_of
from foon_asp.questions.contract import Question

_OF_A_FILE = {"output": "-o", "format_": "--format"}


def serving(command: Callable[..., ExitCode], question: Question) -> Callable[..., ExitCode]:
    """Add ``--serve`` to the command of a page."""
    own = {option.name for option in question.options}

    @functools.wraps(command)
    def served(serve: bool, **given: Any) -> ExitCode:
        if not serve:
            return command(**given)
        for name, flag in _OF_A_FILE.items():
            if given.pop(name, None):
                raise UserError(f"found {flag} beside --serve: what the page shows is written into no file")
        deadline: Deadline | None = given.pop("deadline", None)
        asked = {name: given.pop(name) for name in own & given.keys()}
        return _serve(asked, given, deadline or Deadline())

    help_ = "Serve a page on this machine that asks again, until ctrl-C; needs foon-asp[view]."
    return click.option("--serve", is_flag=True, help=help_)(served)


def _serve(asked: dict[str, Any], data: dict[str, Any], deadline: Deadline) -> ExitCode:
    try:
        from foon_asp.serve.desk import Desk
        from foon_asp.serve.form import Form
        from foon_asp.serve.server import serve
    except ImportError as error:
        raise UserError(f"--serve needs more packages ({error}): pip install 'foon-asp[view]'") from None
    dataset = options.read_dataset(**data)
    first = Form(
        goals=tuple(asked["goals_named"]),
        objectives=tuple(map(str, parse_objectives(asked["objectives"], dataset.measures))),
        containers=asked["containers"],
        items=asked["items"],
        beside=tuple(asked["beside"]),
    )
    how = settings_of(
        {
            "constraints": asked["constraints"],
            "constants": asked["constants"],
            "encodings": asked["encodings"],
        }
    )
    example = dataset.problem((0,), first.containers)
    # what is wrong with files is said at once
    assemble(how, functools.partial(click.echo, err=True), problem=example)
    used_up = items_of(dataset, asked["items"], asked["stock"], asked["stays"])
    desk = Desk(Foon(dataset, "the data"), first, deadline.seconds, deadline.memory, how, used_up)
    serve(desk, lambda address: click.echo(f"{address}\nopen this in a browser; ctrl-C ends it"))
    return ExitCode.DONE
