"""Questions: functions for Python, with options from which a command line is made."""

import functools
import inspect
from collections.abc import Callable, Iterator, Mapping, Sequence
from enum import Flag, StrEnum, auto
from pathlib import Path
from typing import NamedTuple, ParamSpec, TypeVar, get_args

from foon_asp.errors import UserError
from foon_asp.problem import DEFAULT_RULE, Problem
from foon_asp.questions.docstring import complete_docstring, docstring_entries
from foon_asp.questions.posing import Pose, pose_problem
from foon_asp.questions.python_call import HELP, wrap_for_python
from foon_asp.questions.result import Result

TABLES = ("text", "json", "csv", "markdown")
"""The formats of a result that has rows."""

_DEFAULTS = {"constraints": (), "goal": (), "containers": DEFAULT_RULE.value}

P = ParamSpec("P")
T = TypeVar("T")
R = TypeVar("R", bound=Result)


class Kind(StrEnum):
    """The type that the text of an option is parsed into."""

    TEXT = "text"
    WHOLE = "whole number"
    FILE = "file"
    WRITTEN = "file to write"
    SECONDS = "seconds"
    SIZE = "size"
    CONSTRAINT = "constraint"
    WEIGHTS = "weights of constraints"
    FLAG = "flag"
    OPTIONS = "options of another program"


class Role(Flag):
    """The roles that an option can have; an option may combine several."""

    PROBLEM = auto()
    """Part of the problem (goals, containers): a command poses the problem by it; in Python, a problem
    has it."""
    QUESTION = auto()
    """A parameter of the function that answers the question."""
    COMMAND = auto()
    """A parameter that holds for a whole command, such as limits and rules."""
    EXTRA_VALUES = auto()
    """More values of another parameter, as rules are of constraints; in Python, that parameter takes them."""
    CHART = auto()
    """Files for a picture of what was found."""


class Option(NamedTuple):
    """An option of a question, for the command line and Python, as plain data.

    An option may be in the annotation of a parameter (``Annotated[int, Option(...)]``). If it has no name, it
    takes its name and default from the parameter. Without ``help``, it takes the first sentence of the
    parameter's entry in the docstring.

    ``name``: the name of the parameter.
    ``help``: the description on the command line and in Python.
    ``kind``: the type that a value on the command line is parsed into.
    ``role``: whether the option is of the problem, of the question or of the command.
    ``default``: the value without the option; in Python, the default of the parameter.
    ``flags``: the flags of the command line; by default ``--name`` with dashes for underscores.
    ``many``: whether it may be repeated.
    ``metavar``: the word for the value in help; by default the word of its type, and ``FILE`` for a file.
    ``choices``: the values allowed, or a function that lists them if other packages may add some.
    ``least``: the smallest number allowed.
    ``positional``: whether it has no flag; it must then be given, unless it may be repeated.
    ``optional``: whether it may be left out although it is positional.
    ``python``: an addition to ``help`` about values that only Python accepts.
    """

    name: str = ""
    help: str = ""
    kind: Kind = Kind.TEXT
    role: Role = Role.QUESTION
    default: object = None
    flags: tuple[str, ...] = ()
    many: bool = False
    metavar: str | None = None
    choices: tuple[str, ...] | Callable[[], tuple[str, ...]] = ()
    least: int | None = None
    positional: bool = False
    optional: bool = False
    python: str = ""


class Question:
    """The description of a question for a command line.

    ``options``: the options of the command.
    ``help``: the text of ``--help`` below its first line, with examples and exit codes.
    ``formats``: the formats of the result, the default first.
    ``suffixes``: the format that each ending of a file name stands for; empty if no file can be written.
    ``pose``: a function from the options of the problem to the first arguments of the question.
    ``command``: the function that a command calls with all options. This is usually the question itself.
    It is another function if the command has more options, or answers where Python raises an exception.
    """

    def __init__(
        self,
        options: tuple[Option, ...],
        help_: str,
        formats: tuple[str, ...],
        suffixes: Mapping[str, str],
        pose: Pose,
        command: Callable[..., Result],
    ) -> None:
        self.options, self.help, self.formats, self.pose = options, help_, formats, pose
        self.suffixes = suffixes
        self.command = command

    def format_of(self, file: Path) -> str:
        """Return the format of a file name by its ending; its letters may be of either case.

        Raises :class:`UserError` for another ending.
        """
        format_ = self.suffixes.get(file.suffix.lower())
        if format_ is None:
            endings = " ".join(self.suffixes)
            raise UserError(f"{file}: the name says no format: end it in {endings}, or name one (--format)")
        return format_


def question(
    *options: Option,
    help_: str,
    formats: tuple[str, ...] = ("text", "json"),
    suffixes: Mapping[str, str] | None = None,
    pose: Pose = pose_problem,
    command: Callable[..., Result] | None = None,
    used_up: bool = False,
) -> Callable[[Callable[P, R]], Callable[P, R]]:
    """Return a decorator that wraps a function for Python, and describes it for a command line.

    The description is a :class:`Question`, which :func:`question_of` returns; the arguments become its
    fields. Its options are ``options``, followed by the options in the annotations of the function's
    parameters. The question supports items that are used up if it has an option for them, or if ``used_up``
    says so. Otherwise, it raises :class:`UserError` for a problem with such items.
    """

    def decorate(ask: Callable[P, R]) -> Callable[P, R]:
        """Return the wrapped function; its attribute ``question`` is the description."""
        named = {option.name for option in options}
        all_options = (*options, *(option for option in _options_of(ask) if option.name not in named))
        if not used_up and "items" not in {option.name for option in all_options}:
            ask = _for_lasting_items(ask)
        command_function = command or ask  # a command line has read its values already, rules among them
        wrapped = python_question(ask, all_options)
        wrapped.__dict__["question"] = Question(
            all_options, help_, formats, suffixes or {}, pose, command_function
        )
        return wrapped

    return decorate


def python_question(ask: Callable[P, T], options: Sequence[Option] | None = None) -> Callable[P, T]:
    """Return a function that takes a problem, or a path or data in place of it; its docstring is completed.

    ``options`` describe the parameters in the docstring; by default, these are the options in the
    annotations. A command line needs :func:`question` instead.
    """
    signature = _without_options(expanded_signature(ask))
    described = _options_of(ask) if options is None else options
    texts = HELP | {option.name: f"{option.help} {option.python}".rstrip() for option in described}
    wrapped = wrap_for_python(ask, signature)
    wrapped.__doc__ = complete_docstring(ask, signature, texts)
    return wrapped


def expanded_signature(ask: Callable[..., object]) -> inspect.Signature:
    """Return the signature of a function, with a parameter for each key of an ``Unpack`` annotation.

    These parameters replace one such as ``**options: Unpack[CommonOptions]``. They are keywords only, and
    most have the default ``None``.
    """
    signature = inspect.signature(ask)
    parameters: list[inspect.Parameter] = []
    for parameter in signature.parameters.values():
        if parameter.kind is not inspect.Parameter.VAR_KEYWORD:
            parameters.append(parameter)
            continue
        for name, annotation in _keyword_annotations(parameter.annotation).items():
            default = _DEFAULTS.get(name)
            kind = inspect.Parameter.KEYWORD_ONLY
            parameters.append(inspect.Parameter(name, kind, default=default, annotation=annotation))
    return signature.replace(parameters=parameters)


def _keyword_annotations(annotation: object) -> Mapping[str, object]:
    """Return the annotations of the keywords in ``Unpack[...]``; empty for ``**kwargs`` of any type."""
    return {
        name: kind for typed_dict in get_args(annotation) for name, kind in typed_dict.__annotations__.items()
    }


def _without_options(signature: inspect.Signature) -> inspect.Signature:
    """Return the signature with plain types in place of annotations that have an :class:`Option`."""
    parameters = signature.parameters.values()
    origins = (getattr(parameter.annotation, "__origin__", None) for parameter in parameters)
    return signature.replace(
        parameters=[
            parameter.replace(annotation=origin)
            if hasattr(parameter.annotation, "__metadata__")
            else parameter
            for parameter, origin in zip(parameters, origins, strict=True)
        ]
    )


def _options_of(ask: Callable[..., object]) -> Iterator[Option]:
    """Yield the options in the annotations of a function's parameters, completed from the parameters."""
    texts = docstring_entries(ask)
    for parameter in expanded_signature(ask).parameters.values():
        for option in getattr(parameter.annotation, "__metadata__", ()):
            if isinstance(option, Option):
                yield _complete_option(option, parameter, texts)


def _complete_option(option: Option, parameter: inspect.Parameter, texts: Mapping[str, str]) -> Option:
    """Return an option with its missing name, default, help and type filled in from its parameter.

    ``texts`` are the entries of the docstring by parameter; the help is the first sentence. An option that
    has a name is shared by questions, and only its default is changed. A parameter of type ``bool`` makes a
    flag, and one of type ``int`` takes a whole number.
    """
    if option.name:  # an option shared by questions, whose default may differ
        default = parameter.default if isinstance(parameter.default, str | int) else option.default
        return option._replace(default=(default,) if option.many and isinstance(default, str) else default)
    kind = option.kind
    if kind is Kind.TEXT:
        kinds = {parameter.annotation.__origin__, *get_args(parameter.annotation.__origin__)}
        kind = Kind.FLAG if bool in kinds else Kind.WHOLE if int in kinds and str not in kinds else kind
    default = parameter.default if isinstance(parameter.default, str | int) else None
    text = texts.get(parameter.name, "").partition(". ")[0].rstrip(".")
    help_ = option.help or f"{text.replace('``', '')}."
    return option._replace(name=parameter.name, kind=kind, default=default, help=help_)


def _for_lasting_items(ask: Callable[P, R]) -> Callable[P, R]:
    """Return a question that first raises :class:`UserError` for a problem whose items are used up."""

    @functools.wraps(ask)
    def wrapped(*about: P.args, **named: P.kwargs) -> R:
        """Check the problems among the arguments, and call the question."""
        if any(isinstance(argument, Problem) and argument.items is not None for argument in about):
            raise not_for_used_up_items(ask.__module__.removeprefix("foon_asp.questions."))
        return ask(*about, **named)

    return wrapped


def not_for_used_up_items(name: str) -> UserError:
    """Return the error for a question that does not support items that are used up.

    ``name`` is the verb or the module of the question, for example ``why_not``.
    """
    return UserError(f"{name.replace('_', '-')} is not built for items that are used up (--items used-up)")


def question_of(ask: Callable[..., object]) -> Question:
    """Return the description of a function that :func:`question` wrapped."""
    description: Question = ask.__dict__["question"]
    return description
