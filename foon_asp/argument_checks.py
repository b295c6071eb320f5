"""Runtime checks of arguments against the annotations of a function, with errors in words."""

import functools
import inspect
import types
import typing
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any, ParamSpec, TypeVar

from foon_asp.errors import UserError

P = ParamSpec("P")
T = TypeVar("T")

_TYPE_WORDS = {
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


def typed(function: Callable[P, T]) -> Callable[P, T]:
    """Return a function that first checks its arguments against its annotations, as :func:`checker` does."""
    check = checker(function)

    @functools.wraps(function)
    def checked(*arguments: P.args, **named: P.kwargs) -> T:
        check(arguments, named)
        return function(*arguments, **named)

    return checked


def checker(
    function: Callable[..., object], signature: inspect.Signature | None = None
) -> Callable[[tuple[object, ...], Mapping[str, object]], None]:
    """Return a function that checks positional and named arguments against the annotations of ``function``.

    It raises :class:`UserError` for a value that its annotation does not allow. It raises ``TypeError`` for
    arguments that do not fit the ``signature``, by default that of ``function``.

    Annotations that are strings allow all values. Default values, keys and values of mappings, and items of
    iterators are not checked.
    """
    expected_signature = signature or inspect.signature(function)
    annotations = {name: parameter.annotation for name, parameter in expected_signature.parameters.items()}

    def check(arguments: tuple[object, ...], named: Mapping[str, object]) -> None:
        """Raise an error if an argument is not allowed."""
        try:
            bound = expected_signature.bind(*arguments, **named)
        except TypeError as error:
            raise TypeError(f"{function.__name__}: {error}; it takes {', '.join(annotations)}") from None
        for name, argument in bound.arguments.items():
            is_variadic = expected_signature.parameters[name].kind is inspect.Parameter.VAR_POSITIONAL
            for value in argument if is_variadic else (argument,):
                if not _is_allowed(annotations[name], value):
                    words = _allowed_values(annotations[name])
                    expected = " or ".join(dict.fromkeys(words)) or "something else"
                    raise UserError(f"found {name}={value!r}, expected {expected}")

    return check


def _is_allowed(annotation: Any, value: object) -> bool:
    """Whether an annotation allows a value, as far as that can be checked at runtime.

    Only items of lists, tuples and sets are checked. A text does not count as several values. ``float``
    allows integers. Neither ``float`` nor ``int`` allows ``True`` and ``False``. An annotation that is no
    type, such as a string, allows all values.
    """
    origin, arguments = typing.get_origin(annotation), typing.get_args(annotation)
    if origin in {typing.Union, types.UnionType, typing.Annotated}:
        alternatives = arguments[:1] if origin is typing.Annotated else arguments
        return any(_is_allowed(alternative, value) for alternative in alternatives)
    if _is_of_several_values(origin):
        if isinstance(value, str | bytes) or not isinstance(value, Iterable):
            return False
        is_checkable = isinstance(value, list | tuple | set | frozenset) and len(arguments) == 1
        return not is_checkable or all(_is_allowed(arguments[0], item) for item in value)
    expected = origin or (types.NoneType if annotation is None else annotation)
    if not isinstance(expected, type) or expected is inspect.Parameter.empty:
        return True
    if expected in {int, float}:
        return isinstance(value, expected | int) and not isinstance(value, bool)
    return isinstance(value, expected)


def _is_of_several_values(origin: Any) -> bool:
    """Whether the origin of an annotation is a type with several values, such as ``Sequence``.

    A mapping counts as one value.
    """
    return isinstance(origin, type) and issubclass(origin, Iterable) and not issubclass(origin, Mapping)


def _allowed_values(annotation: Any) -> Iterator[str]:
    """Yield the values that an annotation allows, in words: ``a whole number``, ``text``.

    ``None`` is left out. Words may be repeated.
    """
    origin, arguments = typing.get_origin(annotation), typing.get_args(annotation)
    if origin is typing.Annotated:
        yield from _allowed_values(arguments[0])
    elif origin in {typing.Union, types.UnionType}:
        for alternative in arguments:
            yield from _allowed_values(alternative)
    elif _is_of_several_values(origin):
        yield f"several such as [{', '.join(dict.fromkeys(_allowed_values(arguments[0])))}]"
    elif annotation is not types.NoneType:
        name = (origin or annotation).__name__ if isinstance(origin or annotation, type) else ""
        yield _TYPE_WORDS.get(name, name) if name else "something else"
