"""How a question is asked: rules, limits, progress and cancelling, which every question takes."""

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Annotated, TypedDict

from foon_asp.asp.settings import Settings
from foon_asp.dataset.paths import File, Files
from foon_asp.deadline import Cancel, Deadline, memory_size, seconds
from foon_asp.network import ObjectNode
from foon_asp.problem.progress import OnProgress
from foon_asp.questions.arguments import given_constraints
from foon_asp.questions.caller import caller
from foon_asp.questions.options import CONSTANTS, CONSTRAINTS, ENCODINGS, LIMITS, RULE

_TIME, _MEMORY = LIMITS

Constants = Mapping[str, object] | Iterable[str]
"""Values of ``#const`` by name, or texts ``NAME=VALUE``."""


class Limits(TypedDict, total=False):
    """When a question ends at the latest, and who hears of its progress."""

    time_limit: Annotated[float | None, _TIME]
    memory_limit: Annotated[int | str | None, _MEMORY]
    on_progress: OnProgress | None
    cancel: Cancel | None


class Posed(Limits, total=False):
    """The same, and how a problem is posed where a path or data stand in place of it."""

    goal: str | ObjectNode | Iterable[str | ObjectNode]
    containers: str


class How(Posed, total=False):
    """The same, with the rules that a tree keeps to."""

    constraints: Annotated[Files, CONSTRAINTS, RULE]
    encodings: Annotated[File | None, ENCODINGS]
    constants: Annotated[Constants | None, CONSTANTS]


def settings_of(how: How) -> Settings:
    """Return the settings of a search, with limits that begin now."""
    encodings, constants = how.get("encodings"), how.get("constants") or ()
    if isinstance(constants, Mapping):
        constants = [f"{name}={value}" for name, value in constants.items()]
    return Settings(
        given_constraints(how.get("constraints", ())),
        None if encodings is None else Path(encodings),
        tuple(constants),
        deadline=begin(how),
    )


def begin(how: Limits) -> Deadline:
    """Let limits begin, within those of the command that asks."""
    within, (time, memory) = caller().deadline, limits_of(how)
    if time is None and memory is None and within is not None:
        return within
    return Deadline(time, memory, within=within)


def limits_of(how: Limits) -> tuple[float | None, int | None]:
    """Return limits, in seconds and in bytes."""
    time, memory = how.get("time_limit"), how.get("memory_limit")
    return None if time is None else seconds(time), None if memory is None else memory_size(memory)
