"""How a question is asked: rules, limits, progress and cancelling, which every question takes."""

from collections.abc import Iterable
from typing import Annotated, TypedDict

from foon_asp.asp.settings import Settings
from foon_asp.dataset.paths import File, Files
from foon_asp.deadline import Cancel
from foon_asp.network import ObjectNode
from foon_asp.problem.progress import OnProgress
from foon_asp.questions.arguments import Constants, settings
from foon_asp.questions.options import CONSTANTS, CONSTRAINTS, ENCODINGS, LIMITS, RULE

_TIME, _MEMORY = LIMITS


class Posed(TypedDict, total=False):
    """How a problem is posed where a path or data stand in place of it."""

    goal: str | ObjectNode | Iterable[str | ObjectNode]
    containers: str


class Patience(Posed, total=False):
    """When a question that searches for nothing ends at the latest, in Python alone."""

    time_limit: float | None
    on_progress: OnProgress | None
    cancel: Cancel | None


class HeldAgainst(Patience, total=False):
    """The rules that a given tree is held against."""

    constraints: Annotated[Files, CONSTRAINTS, RULE]
    encodings: Annotated[File | None, ENCODINGS]
    constants: Annotated[Constants | None, CONSTANTS]


class Limits(Posed, total=False):
    """When a question ends at the latest, and who hears of its progress."""

    time_limit: Annotated[float | None, _TIME]
    memory_limit: Annotated[int | str | None, _MEMORY]
    on_progress: OnProgress | None
    cancel: Cancel | None


class How(Posed, total=False):
    """The rules that a tree keeps to, and the limits of the question."""

    constraints: Annotated[Files, CONSTRAINTS, RULE]
    encodings: Annotated[File | None, ENCODINGS]
    constants: Annotated[Constants | None, CONSTANTS]
    time_limit: Annotated[float | None, _TIME]
    memory_limit: Annotated[int | str | None, _MEMORY]
    on_progress: OnProgress | None
    cancel: Cancel | None


def settings_of(how: How) -> Settings:
    """Return the settings of a search, with limits that begin now."""
    return settings(
        how.get("constraints", ()),
        how.get("constants"),
        how.get("encodings"),
        how.get("time_limit"),
        how.get("memory_limit"),
    )
