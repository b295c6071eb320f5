"""Docstrings of what is public: they say all that a caller has to know, and their examples run."""

import ast
import builtins
import doctest
import functools
import inspect
import re
import textwrap
from collections.abc import Callable, Iterator
from enum import Enum
from typing import Any

import pytest

import foon_asp
from foon_asp import BugError, UserError
from foon_asp.dataset import read_dataset
from foon_asp.questions.contract import Option, described
from foon_asp.questions.options import LIMITS

PUBLIC: dict[str, Any] = {name: getattr(foon_asp, name) for name in foon_asp.__all__}
FUNCTIONS = {name: found for name, found in PUBLIC.items() if inspect.isfunction(found)}
CLASSES = {name: found for name, found in PUBLIC.items() if inspect.isclass(found)}
SECTION = re.compile(r"^(Parameters|Returns|Raises|Example):\n((?:    .*\n|\n(?=    ))+)", re.MULTILINE)
ENTRY = re.compile(r"^    (\w+): \S", re.MULTILINE)


def sections(docstring: str) -> dict[str, str]:
    return dict(SECTION.findall(inspect.cleandoc(docstring) + "\n"))


def parameters(function: Callable[..., Any]) -> list[str]:
    return [name for name in inspect.signature(function).parameters if name not in {"self", "cls"}]


def raised(function: Callable[..., Any]) -> Iterator[type]:
    """Give the errors of callers that the code of a function itself raises."""
    (node,) = ast.parse(textwrap.dedent(inspect.getsource(function))).body
    known = {**vars(builtins), **inspect.unwrap(function).__globals__}
    caught = {
        (inner, name.id)
        for block in ast.walk(node)
        if isinstance(block, ast.Try)
        for handler in block.handlers
        if handler.type is not None
        for name in ast.walk(handler.type)
        if isinstance(name, ast.Name)
        for statement in block.body
        for inner in ast.walk(statement)
    }
    for each in ast.walk(node):
        if isinstance(each, ast.Raise) and isinstance(each.exc, ast.Call):
            name = ast.unparse(each.exc.func)
            error = known.get(name)
            if not inspect.isclass(error) or error in {BugError, NotImplementedError}:
                continue
            if (each, name) not in caught:
                yield error


def lacking(function: Callable[..., Any], *docstrings: str) -> Iterator[str]:
    """Name what the docstrings of a function, its own and those of methods it overrides, leave out."""
    found: dict[str, str] = {}
    for docstring in reversed(docstrings):
        found |= sections(docstring)
    if ENTRY.findall(found.get("Parameters", "")) != parameters(function):
        yield "Parameters"
    named = ENTRY.findall(found.get("Raises", ""))
    for error in raised(function):
        if not any(base.__name__ in named for base in error.__mro__):
            yield error.__name__


@pytest.fixture(autouse=True, scope="module")
def read_once() -> Iterator[None]:
    """Read the bundled kitchen once for all examples."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("foon_asp.foon.read_dataset", functools.cache(read_dataset))
        yield


def fields(kind: type) -> list[str]:
    """Name the public values of a class of values, or the members of an enumeration."""
    if issubclass(kind, Enum):
        return [member.name for member in kind]
    named = [
        *getattr(kind, "_fields", ()),
        *(each.name for each in getattr(kind, "__dataclass_fields__", {}).values()),
    ]
    return [name for name in named if not name.startswith("_")]


def members(kind: type) -> Iterator[tuple[str, Any, list[str]]]:
    """Give the public methods and properties of a class, with their docstrings and those they override."""
    ours = [base for base in kind.__mro__ if base.__module__.startswith("foon_asp.")]
    for name in dict.fromkeys(name for base in ours for name in vars(base) if not name.startswith("_")):
        found = [vars(base)[name] for base in ours if name in vars(base)]
        if isinstance(found[0], property | functools.cached_property) or inspect.isroutine(found[0]):
            yield name, found[0], [inspect.getdoc(each) or "" for each in found]


def failures(name: str, docstring: str) -> str:
    """Run the examples of a docstring, and give what was not as it says."""
    test = doctest.DocTestParser().get_doctest(docstring, {"foon_asp": foon_asp}, name, None, 0)
    said: list[str] = []
    doctest.DocTestRunner(verbose=False).run(test, out=said.append)
    return "".join(said)


@pytest.mark.parametrize("name", FUNCTIONS)
def test_a_function_is_described(name: str) -> None:
    function = FUNCTIONS[name]
    docstring = inspect.getdoc(function) or ""
    first, blank, *_ = docstring.split("\n")
    assert re.fullmatch(r"[A-Z].*[.?]", first)
    assert not blank
    assert not [*lacking(function, docstring)]
    assert {"Returns", "Example"} <= sections(docstring).keys()
    assert ">>> " in sections(docstring)["Example"]
    # the help of options is part of it, and must not speak of a command line
    assert not re.search(r" --\w|[Rr]epeat", docstring)


@pytest.mark.parametrize("name", CLASSES)
def test_a_class_is_described(name: str) -> None:
    kind = CLASSES[name]
    docstring = inspect.getdoc(kind) or ""
    assert re.fullmatch(r"[A-Z].*[.?]", docstring.split("\n")[0])
    assert ">>> " in sections(docstring)["Example"]
    known = docstring + "".join(inspect.getdoc(base) or "" for base in kind.__mro__[1:-1])
    assert not [field for field in fields(kind) if not re.search(rf"``{field}(\[\w\])?``", known)]


@pytest.mark.parametrize("name", CLASSES)
def test_a_method_is_described(name: str) -> None:
    lacks = {}
    for member, found, docstrings in members(CLASSES[name]):
        assert re.match(r"[A-Z][^\n]*[.?:]$", docstrings[0].split("\n")[0]), member
        function = found.fget if isinstance(found, property) else getattr(found, "__func__", found)
        if inspect.isfunction(function):
            lacks[member] = [*lacking(function, *docstrings)]
    assert not [member for member in lacks.items() if member[1]]


# Methods that no example shows: what we call in a class of the caller's, what is asked between our own rooms,
# and what needs an extra.
NOT_SHOWN = {
    *("Reporter.warning", "Reporter.bound", "Reporter.step"),
    *("Problem.copies_taken", "Problem.require_known_for", "Problem.measure", "Problem.apply_measures"),
    *("UsedUp.flow", "FoonReader.parse_new", "Network.find"),
    *("Result.svg", "Tree.svg", "Drawn.png", "Result.write_chart", "Result.to_frame"),
}


def test_every_method_is_shown_in_an_example() -> None:
    """In that of its class, or of another with the same method, or in its own."""
    shown: dict[str, bool] = {}
    for kind in CLASSES.values():
        for name, found, docstrings in members(kind):
            if isinstance(found, property | functools.cached_property):
                continue
            first = [base for base in kind.__mro__ if name in vars(base)][-1].__name__
            lines = "".join((inspect.getdoc(kind) or "", *docstrings)).split("\n")
            code = "\n".join(line for line in lines if line.lstrip().startswith((">>> ", "... ")))
            called = re.search(rf"[.]{name}\(|def {name}\(", code) is not None
            shown[f"{first}.{name}"] = shown.get(f"{first}.{name}", False) or called
    assert {name for name, is_shown in shown.items() if not is_shown} == NOT_SHOWN


@pytest.mark.sampled(4)
@pytest.mark.parametrize("name", PUBLIC)
def test_an_example_runs(name: str) -> None:
    if name in {"schedule", "Schedule"}:
        pytest.importorskip("ortools", reason="OR-Tools is not installed (foon-asp[schedule])")
    assert not failures(name, PUBLIC[name].__doc__)


@pytest.mark.parametrize("name", [name for name in FUNCTIONS if "objectives" in parameters(FUNCTIONS[name])])
def test_an_unknown_objective_is_an_error_that_is_named(name: str) -> None:
    given: dict[str, Any] = {"soft": {}} if name == "solve_soft" else {}
    plan: tuple[Any, ...] = ((),) if name == "trace" else ()
    with pytest.raises(UserError, match="'speed'"):
        FUNCTIONS[name](foon_asp.load().problem("ice", "tea"), *plan, "speed", **given)
    assert "UserError" in ENTRY.findall(sections(inspect.getdoc(FUNCTIONS[name]) or "")["Raises"])


def test_a_parameter_without_a_description_is_found() -> None:
    def forgetful(problem: str, most: int, time_limit: int, pace: int = 1) -> int:
        """Count.

        Parameters:
            most: How far to count, which
                is said here.

        Returns:
            The last number.
        """
        if pace < 1:
            raise UserError(problem)
        return most // time_limit

    asked = described(*LIMITS, Option("most", "Not this."))(forgetful)
    docstring = inspect.getdoc(asked) or ""
    assert [*lacking(asked, docstring)] == ["Parameters", "UserError"]
    shown = docstring.split("\n")
    assert shown[3].startswith("    problem: ")
    assert shown[4] == "    most: How far to count, which is said here."
    assert shown[5] == f"    time_limit: {LIMITS[0].help}"
    assert shown[6:] == ["", "Returns:", "    The last number."]


def test_an_example_that_is_wrong_is_found() -> None:
    assert "Expected" in failures("wrong", ">>> 1 + 1\n3\n")
