"""What a session holds for its commands: data, and the rules set so far."""

from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import click

from foon_asp.dataset import Dataset
from foon_asp.errors import UserError
from foon_asp.rules.constraint import Constraint, RuleText

if TYPE_CHECKING:  # clingo, which often is not needed
    from foon_asp.asp.session import Session


class Held(NamedTuple):
    """What a session has read, and how.

    ``session`` keeps what was grounded; ``files`` are those that were read. ``constraints``, ``constants``
    and ``encodings`` are the rules set so far: a command of the session adds to them, and removes none.
    """

    dataset: Dataset
    lenient: bool
    level: int
    session: "Session"
    files: tuple[Path, ...]
    constraints: tuple[Constraint, ...]
    constants: tuple[str, ...]
    encodings: Path | None


_RULES = "foon_asp.rules"


def rules_given(context: click.Context, _: click.Parameter, value: tuple[str, ...]) -> None:
    """Keep the rules of a command until its constraints are read."""
    context.meta[_RULES] = tuple(map(RuleText, value))


def with_rules_that_stand(
    context: click.Context, _: click.Parameter, value: tuple[Constraint, ...]
) -> tuple[Constraint, ...]:
    """Add constraints and rules to those of the session, if there is one."""
    here = context.find_object(Held)
    standing = () if here is None else here.constraints
    return tuple(dict.fromkeys((*standing, *value, *context.meta.get(_RULES, ()))))


def with_constants_that_stand(
    context: click.Context, _: click.Parameter, value: tuple[str, ...]
) -> tuple[str, ...]:
    """Add constants to those of the session.

    Another value for one of these would change a rule, and is refused.
    """
    here = context.find_object(Held)
    standing = () if here is None else here.constants
    values = dict(setting.split("=", 1) for setting in standing)
    for setting in value:
        name = setting.partition("=")[0]
        if name in values and setting not in standing:
            raise UserError(
                f"{name}={values[name]} is set in this session, and {setting!r} on this line would "
                "change that rule: constraint NAME CONSTANT=VALUE replaces it, and drop removes it"
            )
    return (*standing, *(setting for setting in value if setting not in standing))


def encodings_that_stand(context: click.Context, _: click.Parameter, value: Path | None) -> Path | None:
    """Give the encodings of the session, if there is one; others are refused."""
    here = context.find_object(Held)
    if here is None or here.encodings is None:
        return value
    if value not in {None, here.encodings}:
        raise UserError(
            f"this session uses the encodings of {here.encodings}; start another one to use {value}"
        )
    return here.encodings


def held() -> Held | None:
    """Give what the session holds, if there is one."""
    context = click.get_current_context(silent=True)
    return context.find_object(Held) if context else None


def session_here() -> "Session | None":
    """Give what keeps ground programs for the next question of the session, if there is one."""
    here = held()
    return here.session if here else None
