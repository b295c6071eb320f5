"""How a command asks a question: it reads the data, makes the problem, and asks."""

import importlib
import shlex
from collections.abc import Callable, Mapping, Sequence
from contextlib import AbstractContextManager
from dataclasses import replace
from functools import cached_property
from pathlib import Path
from typing import Any

import click
from click.core import ParameterSource

from foon_asp.cli import options
from foon_asp.cli.held import session_here
from foon_asp.cli.progress import Progress
from foon_asp.dataset import Dataset
from foon_asp.deadline import Deadline
from foon_asp.errors import UserError
from foon_asp.problem import Problem
from foon_asp.questions.caller import Caller, asked_by
from foon_asp.questions.contract import Part, Question, question_of
from foon_asp.questions.index import module_name, question_name
from foon_asp.questions.posing import DATA, no_data, one_problem, one_problem_or_nearby
from foon_asp.questions.result import Result


def find_question(verb: str) -> Question:
    """Give a question; its module is imported only then."""
    module = importlib.import_module(f"foon_asp.questions.{module_name(verb)}")
    return question_of(getattr(module, question_name(verb)))


def parameters(question: Question, given: Mapping[str, Any], parts: Part) -> dict[str, Any]:
    """Give the values of the options that belong to these parts."""
    own = (option.name for option in question.options if option.part & parts)
    return {name: given[name] for name in own if name in given}


def ask(
    question: Question,
    given: Mapping[str, Any],
    deadline: Deadline | None,
    command_of: Callable[[str], click.Command],
) -> Result:
    """Ask a question with the parameters of a command.

    ``deadline`` is that of the command. ``command_of`` gives the commands of other questions, which a
    question may ask.
    """
    own = {option.name for option in question.options}
    command = _Command({name: value for name, value in given.items() if name not in own}, command_of)
    with Progress(deadline) as progress:
        who = Caller(progress, session_here(), deadline, lenient=bool(given.get("lenient")))
        with asked_by(who):
            posed = _posed(question, command, given)
        if question.pose is not no_data or "time_limit" in {option.name for option in question.options}:
            progress.begin()  # there is a tree to wait for
        with asked_by(who._replace(read_seconds=command.read_seconds)):
            how = parameters(question, given, Part.QUESTION | Part.COMMAND)
            found = [question.command(*about, **how) for about in posed]
    if len(found) == 1:
        return found[0]
    from foon_asp.questions.each import Each

    return Each(found)


def _posed(question: Question, command: "_Command", given: Mapping[str, Any]) -> list[tuple[object, ...]]:
    """Pose a question: once, or for each of several goals that were assumed. What is assumed is said."""
    asked = parameters(question, given, Part.PROBLEM)
    unnamed = question.pose is not no_data and asked.get("goals_named") == ()
    each_alone = unnamed and question.pose in {one_problem, one_problem_or_nearby}
    goals = command.dataset.assumed_goals() if each_alone else []
    if len(goals) < 2:
        posed = [question.pose(command, **asked)]
    else:
        _refuse_one_file(question, given)
        posed = [question.pose(command, **asked | {"goals_named": [goal]}) for goal in goals]
    problems = [each for about in posed for each in about if isinstance(each, Problem)]
    if problems and unnamed:  # what is about no problem may need no data
        goals = command.dataset.assumed_goals()
    if {goal for problem in problems for goal in problem.goal_nodes} != set(goals):
        goals = []  # it is about others
    if problems and (goals or not command.dataset.has_kitchen):
        from foon_asp.dataset.assumed import goal_lines, kitchen_lines

        lines = [*goal_lines(command.dataset, goals)] if goals else []
        if not command.dataset.has_kitchen and session_here() is None:
            wanted = dict.fromkeys(goal for problem in problems for goal in problem.goals)
            lines += kitchen_lines(replace(problems[0], goals=tuple(wanted)))
        click.echo("\n".join(lines), err=True, nl=bool(lines))
    return posed


def _refuse_one_file(question: Question, given: Mapping[str, Any]) -> None:
    """Raise :class:`UserError` if the answers for several goals would be written into one file."""
    files = [given.get("output"), given.get("certificate_file")]
    if question.suffixes or any(files):
        raise UserError(
            "no goal is named, and there are several, which one file cannot hold: name one (--goal)"
        )


class _Command:
    """What a question may use of its command: the data, other questions, and the limits of reading."""

    def __init__(self, data: dict[str, Any], command_of: Callable[[str], click.Command]) -> None:
        self._data, self._command_of = data, command_of
        self._context = click.get_current_context()

    @cached_property
    def dataset(self) -> Dataset:
        """The data that the options name; read when first used."""
        return options.read_dataset(**self._data)

    @property
    def read_seconds(self) -> float | None:
        """How long reading took; ``None`` if nothing was read."""
        return self.dataset.read_seconds if "dataset" in self.__dict__ else None

    def given(self, option: str) -> bool:
        """Whether an option was given in the command itself, and not by the session or by default."""
        return _is_given(self._context, option)

    def add_sources(self, sources: Sequence[Path]) -> None:
        """Add networks that are named without an option, before the data are read."""
        if sources:
            self._data["sources"] = (*self._data.get("sources", ()), *sources)

    def reading(self) -> AbstractContextManager[object]:
        """Stop what is read in a ``with`` block at the limits of the command."""
        return options.reading()

    def ask(self, words: str, without: Sequence[str]) -> Result:
        """Ask a question that is written as a command; ``without`` names options that it must not have."""
        here = self._context
        try:
            verb, *rest = shlex.split(words)
        except ValueError as error:
            raise UserError(f"found {words!r}, expected the words of a command: {error}") from None
        question, command = find_question(verb), self._command_of(verb)
        name = f"{here.info_name} '{words}'"
        own = command.make_context(name, list(rest), obj=here.obj)
        if any(_is_given(own, option) for option in without):
            flags = sorted(each.opts[0] for each in command.params if each.name in without)
            raise UserError(f"found {words!r}, expected a question without {', '.join(flags)}")
        beside = {option: value for option, value in here.params.items() if _is_given(here, option)}
        if any(own.params.get(option) for option in DATA):
            beside = {option: value for option, value in beside.items() if option not in DATA}
        defaults = {**(here.default_map or {}), **beside}  # a session has something to say, too
        asked = command.make_context(name, rest, default_map=defaults, obj=here.obj)
        here.call_on_close(asked.close)
        if beside.get("sources"):  # a default is for options
            asked.params["sources"] = beside["sources"]
        given = {name: value for name, value in asked.params.items() if name not in {"format_", "output"}}
        with asked.scope(cleanup=False):
            deadline = options.begin(given.pop("time_limit", None), given.pop("memory_limit", None))
            return ask(question, given, deadline, self._command_of)


def _is_given(context: click.Context, option: str) -> bool:
    return context.get_parameter_source(option) is ParameterSource.COMMANDLINE
