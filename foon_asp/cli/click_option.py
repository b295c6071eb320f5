"""Parameters of click, made from the options of questions."""

import functools
import itertools
from collections.abc import Callable
from typing import Any, TypeVar

import click

from foon_asp.cli.named_path import NamedPath, WrittenPath
from foon_asp.deadline import parse_memory_size, parse_seconds
from foon_asp.questions.question import Kind, Option, Role
from foon_asp.rules.passed_constraint import Constraint, RuleText, named_constraint

Command = TypeVar("Command", bound=Callable[..., object])

_RULES_KEY = "foon_asp.rules"


def _keep_rules(context: click.Context, _: click.Parameter, value: tuple[str, ...]) -> None:
    """Store the values of ``--rule`` in the context of the command, for :func:`_with_rules`."""
    context.meta[_RULES_KEY] = tuple(map(RuleText, value))


def _with_rules(
    context: click.Context, _: click.Parameter, value: tuple[Constraint, ...]
) -> tuple[Constraint, ...]:
    """Return the values of ``--constraint``, then the rules that :func:`_keep_rules` stored, each once."""
    return tuple(dict.fromkeys((*value, *context.meta.get(_RULES_KEY, ()))))


def _parse_soft(
    _: click.Context, parameter: click.Parameter, value: tuple[str, ...]
) -> dict[Constraint, int]:
    """Parse values ``FILE.lp=WEIGHT``; return the weight of each constraint."""
    if not value:
        return {}
    from foon_asp.cli.weighted_files import parse_weights

    return parse_weights(value, parameter.opts[0])


def _parse_constraint(text: str) -> Constraint:
    """Return the constraint that a value of ``--constraint`` names: a file, or a ready-made constraint."""
    return named_constraint(text, NamedPath)


def _split_sources(
    context: click.Context, parameter: click.Parameter, value: tuple[str, ...]
) -> tuple[str, ...]:
    """Return the arguments from the first option on, which are for another program.

    The words before the first option are networks: they become the parameter ``sources`` of the command.
    """
    words = list(itertools.takewhile(lambda word: not word.startswith("-"), value))
    context.params["sources"] = tuple(map(NamedPath, words))
    return value[len(words) :]


def _complete_from_data(context: click.Context, parameter: click.Parameter, incomplete: str) -> list[str]:
    """Return the completions of the incomplete value of an option, from the data that the command names."""
    from foon_asp.cli.completed_words import completed_words

    return completed_words(context, parameter, incomplete)


_NAMED_IN_DATA = frozenset({"goals_named", "objectives", "constraints", "constants"})
_CALLBACKS = {"rules": _keep_rules, "constraints": _with_rules}


def click_options(*options: Option) -> Callable[[Command], Command]:
    """Return a decorator that adds parameters of click for several options, in this order."""

    def decorate(command: Command) -> Command:
        """Add the parameters of all ``options`` to a command."""
        return functools.reduce(lambda f, option: click_option(option)(f), reversed(options), command)

    return decorate


def click_option(option: Option) -> Callable[[Command], Command]:
    """Return a decorator that adds an option of a question as a parameter of click.

    A positional option becomes an argument. The help of a repeatable option says that it is repeatable. An
    option with the role ``EXTRA_VALUES`` is not passed to the command.
    """
    choices = option.choices() if callable(option.choices) else option.choices
    type_of_kind: dict[Kind, Any] = {
        Kind.TEXT: click.Choice(choices) if choices else None,
        Kind.WHOLE: int if option.least is None else click.IntRange(min=option.least),
        Kind.FILE: click.Path(path_type=NamedPath),
        Kind.WRITTEN: WrittenPath(),
        Kind.SECONDS: parse_seconds,
        Kind.SIZE: parse_memory_size,
        Kind.WEIGHTS: None,
        Kind.CONSTRAINT: _parse_constraint,
        Kind.OPTIONS: click.UNPROCESSED,
    }
    if option.positional:
        return click.argument(
            option.name,
            type=type_of_kind[option.kind],
            nargs=-1 if option.many else 1,
            metavar=option.metavar,
            required=not (option.optional or option.many),
            callback=_split_sources if option.kind is Kind.OPTIONS else None,
        )
    flags = option.flags or ("--" + option.name.replace("_", "-"),)
    if option.kind is Kind.FLAG:
        return click.option(*flags, option.name, is_flag=True, help=option.help)
    return click.option(
        *flags,
        option.name,
        type=type_of_kind[option.kind],
        multiple=option.many,
        default=option.default,
        show_default=option.default is not None,
        metavar=option.metavar or ("FILE" if option.kind in {Kind.FILE, Kind.WRITTEN} else None),
        expose_value=option.role is not Role.EXTRA_VALUES,
        is_eager=option.role is Role.EXTRA_VALUES,  # before the option to which it adds
        callback=_parse_soft if option.kind is Kind.WEIGHTS else _CALLBACKS.get(option.name),
        shell_complete=_complete_from_data if option.name in _NAMED_IN_DATA else None,
        help=f"{option.help[:-1]}; repeatable." if option.many else option.help,
    )
