"""Values of the wrong type are refused in words, by the annotations of a function."""

import functools
import inspect
import types
import typing
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any, ParamSpec, TypeVar

from foon_asp.errors import UserError

P = ParamSpec("P")
T = TypeVar("T")

_WORDS = {
    "int": "a whole number",
    "float": "a number",
    "bool": "True or False",
    "str": "text",
    "PathLike": "a path",
    "Path": "a path",
    "Mapping": "a dictionary",
    "Callable": "a function",
    "Problem": "a path, data or a problem: 'eggs.txt', foon_asp.load(), foon_asp.load().problem('macaroni')",
    "Foon": "data: foon_asp.load()",
    "ObjectNode": "an object node",
    "FunctionalUnit": "a functional unit",
    "Tree": "a tree: foon_asp.solve(problem).tree",
    "Cancel": "a token: foon_asp.Cancel()",
}


def typed(ask: Callable[P, T]) -> Callable[P, T]:
    """Make a function refuse values that its annotations do not allow; see :func:`checker`."""
    check = checker(ask)

    @functools.wraps(ask)
    def checked(*given: P.args, **named: P.kwargs) -> T:
        check(given, named)
        return ask(*given, **named)

    return checked


def checker(
    ask: Callable[..., object], signature: inspect.Signature | None = None
) -> Callable[[tuple[object, ...], Mapping[str, object]], None]:
    """Make what raises :class:`UserError` for arguments that the annotations of a function do not allow.

    What can be read only once is not looked into, and annotations that are texts allow everything. The
    ``signature`` is by default that of the function.
    """
    asked = signature or inspect.signature(ask)
    kinds = {name: parameter.annotation for name, parameter in asked.parameters.items()}

    def check(given: tuple[object, ...], named: Mapping[str, object]) -> None:
        try:
            bound = asked.bind(*given, **named)
        except TypeError as error:
            raise TypeError(f"{ask.__name__}: {error}; it takes {', '.join(kinds)}") from None
        for name, value in bound.arguments.items():
            many = asked.parameters[name].kind is inspect.Parameter.VAR_POSITIONAL
            for each in value if many else (value,):
                if not _fits(kinds[name], each):
                    expected = " or ".join(dict.fromkeys(_words(kinds[name]))) or "something else"
                    raise UserError(f"found {name}={each!r}, expected {expected}")

    return check


def _fits(kind: Any, value: object) -> bool:
    """Whether an annotation allows a value, as far as it says something that can be told."""
    origin, arguments = typing.get_origin(kind), typing.get_args(kind)
    if origin in {typing.Union, types.UnionType, typing.Annotated}:
        several = arguments[:1] if origin is typing.Annotated else arguments
        return any(_fits(each, value) for each in several)
    if _is_several(origin):
        if isinstance(value, str | bytes) or not isinstance(value, Iterable):
            return False
        known = isinstance(value, list | tuple | set | frozenset) and len(arguments) == 1
        return not known or all(_fits(arguments[0], each) for each in value)
    expected = origin or (types.NoneType if kind is None else kind)
    if not isinstance(expected, type) or expected is inspect.Parameter.empty:
        return True
    if expected in {int, float}:
        return isinstance(value, expected | int) and not isinstance(value, bool)
    return isinstance(value, expected)


def _is_several(origin: Any) -> bool:
    return isinstance(origin, type) and issubclass(origin, Iterable) and not issubclass(origin, Mapping)


def _words(kind: Any) -> Iterator[str]:
    """Say what an annotation allows."""
    origin, arguments = typing.get_origin(kind), typing.get_args(kind)
    if origin is typing.Annotated:
        yield from _words(arguments[0])
    elif origin in {typing.Union, types.UnionType}:
        for each in arguments:
            yield from _words(each)
    elif _is_several(origin):
        yield f"several such as [{', '.join(dict.fromkeys(_words(arguments[0])))}]"
    elif kind is not types.NoneType:
        name = (origin or kind).__name__ if isinstance(origin or kind, type) else ""
        yield _WORDS.get(name, name) if name else "something else"
