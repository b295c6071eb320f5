"""What a question is: a function that Python calls, with options that a command line is made from."""

import functools
from collections.abc import Callable, Mapping
from enum import Flag, StrEnum, auto
from pathlib import Path
from typing import Generic, NamedTuple, ParamSpec, TypeVar

from foon_asp.errors import UserError
from foon_asp.questions.posing import Pose, one_problem
from foon_asp.questions.result import Result

P = ParamSpec("P")
R = TypeVar("R", bound=Result)


class Kind(StrEnum):
    """What the text of an option is read as."""

    TEXT = "text"
    WHOLE = "whole number"
    FILE = "file"
    SECONDS = "seconds"
    SIZE = "size"
    WEIGHTS = "weights of files"
    FLAG = "flag"
    OPTIONS = "options of another program"


class Part(Flag):
    """What an option belongs to, which may be several."""

    PROBLEM = auto()
    """The problem that is asked about, which has it in Python (goals, containers): it is posed by it."""
    QUESTION = auto()
    """The question: it is a parameter of the function."""
    COMMAND = auto()
    """A parameter that holds for a whole command: limits, and rules, to which a session may add."""
    TEXT = auto()
    """How what was found is said: a parameter of its text."""
    CHART = auto()
    """Files for a picture of what was found."""


class Option(NamedTuple):
    """One thing that can be chosen, as plain data.

    ``name`` is the parameter; ``flags`` are those of the command line, by default ``--name``, where dashes
    stand for underscores; a ``positional`` one has none and has to be given, unless it is ``many``. ``many``
    says that it is given again and again, ``choices`` that it is one of them, which a function gives where
    not all are ours, ``least`` how small a number may be, ``metavar`` what stands for the value in help.
    """

    name: str
    help: str
    kind: Kind = Kind.TEXT
    part: Part = Part.QUESTION
    default: object = None
    flags: tuple[str, ...] = ()
    many: bool = False
    metavar: str | None = None
    choices: tuple[str, ...] | Callable[[], tuple[str, ...]] = ()
    least: int | None = None
    positional: bool = False


class Question(Generic[P, R]):
    """A question: called, it gives what was found. ``options`` and ``help`` are for a command line.

    ``help`` is what follows after the line of the index, with examples and what it exits with. ``formats``
    are those that the result has, the first by default. ``suffixes`` say by the name of a file in which of
    them it is written, for a result that has a ``write``. ``pose`` makes for a command line what the function
    is asked about, of the options of the problem. ``command`` is what a command asks, with all options: the
    function itself, or another one where a command can choose more, or what Python raises is an answer there.
    """

    def __init__(
        self,
        ask: Callable[P, R],
        options: tuple[Option, ...],
        help_: str,
        formats: tuple[str, ...],
        suffixes: Mapping[str, str],
        pose: Pose,
        command: Callable[..., Result] | None,
    ) -> None:
        functools.update_wrapper(self, ask)
        self.ask, self.options, self.help, self.formats, self.pose = ask, options, help_, formats, pose
        self.suffixes = suffixes
        self.command = command or ask

    def __call__(self, *args: P.args, **named: P.kwargs) -> R:
        """Ask, as Python does."""
        return self.ask(*args, **named)

    def format_of(self, file: Path) -> str:
        """Give the format that the name of a file says; raises :class:`UserError` where it says none."""
        form = self.suffixes.get(file.suffix.lower())
        if form is None:
            ends = " ".join(self.suffixes)
            raise UserError(f"{file}: the name says no format: end it in {ends}, or name one (--format)")
        return form

    def __repr__(self) -> str:
        return f"<question {self.ask.__name__}>"


def question(
    *options: Option,
    help_: str,
    formats: tuple[str, ...] = ("text", "json"),
    suffixes: Mapping[str, str] | None = None,
    pose: Pose = one_problem,
    command: Callable[..., Result] | None = None,
) -> Callable[[Callable[P, R]], Question[P, R]]:
    """Make a question of a function."""

    def decorate(ask: Callable[P, R]) -> Question[P, R]:
        return Question(ask, options, help_, formats, suffixes or {}, pose, command)

    return decorate
