"""The catalog of questions against the questions: names, options, parameters, help."""

import importlib
import inspect
import subprocess
import sys
from collections.abc import Callable
from typing import Any

import pytest

from foon_asp.cli.verbs import VERBS
from foon_asp.questions import question
from foon_asp.questions.index import INDEX, module_name, question_name
from foon_asp.questions.question import Option, Question, Role
from foon_asp.questions.result import Result
from tests.conftest import Cli

# parameters that the command line has no option for: it has them from elsewhere
PYTHON_ONLY = {
    "problem",
    "foon",
    "about",
    "arguments",
    "data",
    "a",
    "b",
    "level",
    "reporter",
    "cancel",
    "on_progress",
}


def function_of(verb: str) -> Callable[..., Result]:
    module = importlib.import_module(f"foon_asp.questions.{module_name(verb)}")
    found: Callable[..., Result] = getattr(module, question_name(verb))
    return found


def question_of(verb: str) -> Question:
    return question.question_of(function_of(verb))


def parameters(verb: str) -> dict[str, inspect.Parameter]:
    """Return the parameters of what a command calls, without those that pose the problem in Python."""
    command, function = question_of(verb).command, function_of(verb)
    found = dict(question.expanded_signature(command).parameters)
    if any(each.kind is each.VAR_KEYWORD for each in inspect.signature(command).parameters.values()):
        found = {**inspect.signature(function).parameters, **found}  # what it passes on
    posing = {"goal", "containers"} - asked_for(verb).keys()
    return {name: each for name, each in found.items() if name not in posing}


def asked_for(verb: str) -> dict[str, Option]:
    parts = Role.QUESTION | Role.COMMAND
    return {option.name: option for option in question_of(verb).options if option.role & parts}


@pytest.mark.parametrize("verb", INDEX)
def test_a_question_is_a_verb(verb: str) -> None:
    assert verb in VERBS
    assert isinstance(question_of(verb), Question)


@pytest.mark.parametrize("verb", INDEX)
def test_options_are_parameters(verb: str) -> None:
    options = question_of(verb).options
    posed = {each.name for each in options if each.role is Role.PROBLEM and each.positional}
    taken = {name for name in parameters(verb) if name not in PYTHON_ONLY}
    taken -= posed  # what is read to pose the problem comes before the options
    assert set(asked_for(verb)) == taken


@pytest.mark.parametrize("verb", INDEX)
def test_defaults_are_the_same(verb: str) -> None:
    def plain(value: Any) -> Any:
        return tuple(value.split(" ")) if isinstance(value, str) else value or None

    for name, option in asked_for(verb).items():
        default = parameters(verb)[name].default
        if option.positional and not option.many:
            assert default is inspect.Parameter.empty, name
        elif option.many:
            assert plain(option.default) == plain(default), name
        else:
            assert (option.default or None) == (default or None), name


@pytest.mark.parametrize("verb", INDEX)
def test_a_command_has_what_python_has(verb: str) -> None:
    theirs = inspect.signature(function_of(verb)).parameters
    only = PYTHON_ONLY | ({"goal", "containers"} - parameters(verb).keys())
    for name in theirs.keys() - only:
        assert parameters(verb)[name].default == theirs[name].default, name


@pytest.mark.parametrize("verb", INDEX)
def test_help_begins_with_the_line_of_the_index(verb: str, cli: Cli) -> None:
    ran = cli(verb, "--help")
    assert ran.code == 0
    assert INDEX[verb].line in " ".join(ran.out.split())
    assert f"foon-asp {verb}" in ran.out
    assert "xits with 0" in ran.out


def test_help_of_all_imports_no_question() -> None:
    code = (
        "import sys; from foon_asp.cli.main import cli\n"
        "try: cli.main(['--help'], standalone_mode=False)\n"
        "finally: print(sorted(m for m in sys.modules if m.startswith('foon_asp.questions.')))"
    )
    ran = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert ran.stdout.splitlines()[-1] == "['foon_asp.questions.index']"
