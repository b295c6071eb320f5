"""Docstrings of what is public: they say all that a caller has to know, and their examples run."""

import doctest
import functools
import inspect
import re
from collections.abc import Callable, Iterator
from enum import Enum
from typing import Any

import pytest

import foon_asp
from foon_asp.dataset import read_dataset
from foon_asp.planning import translator

PUBLIC: dict[str, Any] = {name: getattr(foon_asp, name) for name in foon_asp.__all__}
FUNCTIONS = {name: found for name, found in PUBLIC.items() if inspect.isfunction(found)}
CLASSES = {name: found for name, found in PUBLIC.items() if inspect.isclass(found)}
SECTION = re.compile(r"^(Parameters|Returns|Raises|Example):\n((?:    .*\n|\n(?=    ))+)", re.MULTILINE)
ENTRY = re.compile(r"^    (\w+): \S", re.MULTILINE)


def sections(docstring: str) -> dict[str, str]:
    return dict(SECTION.findall(inspect.cleandoc(docstring) + "\n"))


def parameters(function: Callable[..., Any]) -> list[str]:
    return [name for name in inspect.signature(function).parameters if name not in {"self", "cls"}]


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
    assert ENTRY.findall(sections(docstring).get("Parameters", "")) == parameters(function)
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


# Methods that no example shows: what we call in a class of the caller's, what is asked between our own rooms,
# and what needs an extra.


@pytest.mark.parametrize("name", PUBLIC)
def test_an_example_runs(name: str) -> None:
    if name in {"schedule", "Schedule"}:
        pytest.importorskip("ortools", reason="OR-Tools is not installed (foon-asp[schedule])")
    if name == "py_trees_root":
        pytest.importorskip("py_trees", reason="py_trees is not installed (foon-asp[robot])")
    if name in {"relax", "Relaxed"} and not translator.is_installed():
        pytest.skip("Fast Downward's translator is not installed (foon-asp[pddl])")
    assert not failures(name, PUBLIC[name].__doc__)
