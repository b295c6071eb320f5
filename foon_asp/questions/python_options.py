"""Keyword options that most questions take in Python: goals, rules, limits, progress and cancelling."""

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Annotated, TypedDict

from foon_asp.asp.settings import Settings
from foon_asp.dataset.paths import File, Files
from foon_asp.deadline import Cancel, Deadline, parse_memory_size, parse_seconds
from foon_asp.network import ObjectNode
from foon_asp.problem.progress import OnProgress
from foon_asp.questions.caller import caller
from foon_asp.questions.options import CONSTANTS, CONSTRAINTS, ENCODINGS, LIMITS, RULE
from foon_asp.questions.python_arguments import as_constraints

_TIME, _MEMORY = LIMITS

Constants = Mapping[str, object] | Iterable[str]
"""Values of ``#const`` by name, or texts ``NAME=VALUE``."""


class Limits(TypedDict, total=False):
    """Keyword options for time and memory limits, progress reports and cancelling."""

    time_limit: Annotated[float | None, _TIME]
    memory_limit: Annotated[int | str | None, _MEMORY]
    on_progress: OnProgress | None
    cancel: Cancel | None


class Posed(Limits, total=False):
    """Keyword options of :class:`Limits`, and the goals and container rule of the problem.

    The goals and the container rule are for a question whose first argument is a path or data, and not a
    problem.
    """

    goal: str | ObjectNode | Iterable[str | ObjectNode]
    containers: str


class CommonOptions(Posed, total=False):
    """Keyword options of :class:`Posed`, and the rules that a tree keeps to."""

    constraints: Annotated[Files, CONSTRAINTS, RULE]
    encodings: Annotated[File | None, ENCODINGS]
    constants: Annotated[Constants | None, CONSTANTS]


def settings_of(options: CommonOptions) -> Settings:
    """Return the settings of a search from the options of a question.

    The time limit starts now.
    """
    encodings, constants = options.get("encodings"), options.get("constants") or ()
    if isinstance(constants, Mapping):
        constants = [f"{name}={value}" for name, value in constants.items()]
    return Settings(
        as_constraints(options.get("constraints", ())),
        None if encodings is None else Path(encodings),
        tuple(constants),
        deadline=start_deadline(options),
    )


def start_deadline(options: Limits) -> Deadline:
    """Return a deadline whose time starts now; it ends no later than the deadline of the calling command.

    Without limits in ``options``, return the deadline of the command itself, if there is one.
    """
    outer, (time, memory) = caller().deadline, limits_of(options)
    if time is None and memory is None and outer is not None:
        return outer
    return Deadline(time, memory, within=outer)


def limits_of(options: Limits) -> tuple[float | None, int | None]:
    """Return the time limit in seconds and the memory limit in bytes; ``None`` for no limit."""
    time, memory = options.get("time_limit"), options.get("memory_limit")
    seconds = None if time is None else parse_seconds(time)
    return seconds, None if memory is None else parse_memory_size(memory)
