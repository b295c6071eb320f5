"""Asking a question for a command: the data are read, problems are posed, and the question is called."""

import importlib
from collections.abc import Mapping, Sequence
from contextlib import AbstractContextManager
from functools import cached_property
from pathlib import Path
from typing import Any

import click
from click.core import ParameterSource

from foon_asp.cli import shared_options
from foon_asp.cli.output import say
from foon_asp.cli.progress_line import Progress
from foon_asp.dataset import Dataset
from foon_asp.deadline import Deadline
from foon_asp.errors import UserError
from foon_asp.network import ObjectNode
from foon_asp.problem import Problem
from foon_asp.questions.caller import Caller, asked_by
from foon_asp.questions.each_goal import EachGoal
from foon_asp.questions.index import module_name, question_name
from foon_asp.questions.options import GOAL_OF_PLAN
from foon_asp.questions.posing import pose_problem, pose_without_data
from foon_asp.questions.posing_plan import data_for_trees, pose_plan
from foon_asp.questions.question import Question, Role, question_of
from foon_asp.questions.result import Result
from foon_asp.questions.tree import read_answer


def find_question(verb: str) -> Question:
    """Return the question of a verb, whose module is imported only now."""
    module = importlib.import_module(f"foon_asp.questions.{module_name(verb)}")
    return question_of(getattr(module, question_name(verb)))


def parameters(question: Question, values: Mapping[str, Any], parts: Role) -> dict[str, Any]:
    """Return the values, by name, of the options of a question that belong to ``parts``."""
    names = (option.name for option in question.options if option.role & parts)
    return {name: values[name] for name in names if name in values}


def ask(
    question: Question, values: Mapping[str, Any], deadline: Deadline | None, form: str | None = None
) -> Result:
    """Call a question with the parameters of a command, under its ``deadline``; return the result.

    ``form`` is the chosen format of the result; ``None`` is the default. Several assumed goals give an
    :class:`EachGoal` of results.
    """
    option_names = {option.name for option in question.options}
    command = _Command({name: value for name, value in values.items() if name not in option_names})
    with Progress(deadline) as progress:
        caller = Caller(progress, deadline=deadline, lenient=bool(values.get("lenient")), form=form)
        with asked_by(caller):
            subjects = _subjects(question, command, values)
        _warn_of_measures(command, values)
        if question.pose is not pose_without_data or "time_limit" in option_names:
            progress.begin()  # a search follows
        with asked_by(caller._replace(read_seconds=command.read_seconds)):
            options_ = parameters(question, values, Role.QUESTION | Role.COMMAND)
            results = [question.command(*subject, **options_) for subject in subjects]
    if len(results) == 1:
        return results[0]
    return EachGoal(answers=tuple(results))


def _warn_of_measures(command: "_Command", values: Mapping[str, Any]) -> None:
    """Print a warning for each file of measures that the objectives of the question do not use."""
    chosen = values.get("objectives")
    if not command.measures_named or chosen is None:
        return
    named = {word.strip() for words in chosen for word in words.split(",")}
    measures_of: dict[str, list[str]] = {}
    for measure in command.dataset.measures.values():
        measures_of.setdefault(measure.place, []).append(measure.name)
    for file, names in measures_of.items():
        if named.isdisjoint(names):
            listed = " or ".join(f"--objective {name}" for name in names)
            click.echo(
                f"{file}: warning: no objective is its measure, so it has no effect; add {listed}", err=True
            )


def _subjects(question: Question, command: "_Command", values: Mapping[str, Any]) -> list[tuple[object, ...]]:
    """Return the subjects of a question: one problem or tree, or one for each of several assumed goals.

    Assumed goals and kitchen items are reported to the user.
    """
    problem_options = parameters(question, values, Role.PROBLEM)
    tree = values.get("tree")
    if question.pose is not pose_plan and tree is not None and tree.is_file():  # a pipe is read once
        listed = read_answer(tree)
        data_for_trees(command, {tree: listed})
        if problem_options.get("goals_named") == ():
            problem_options["goals_named"] = tuple(map(str, listed.goals))
    # the question itself reports them, or has none
    reports_goals = question.pose is pose_without_data or GOAL_OF_PLAN in question.options
    unnamed = not reports_goals and problem_options.get("goals_named") == ()
    one_goal = question.pose is pose_problem and not problem_options.get("all_goals")
    goals = command.unnamed_goals() if unnamed and one_goal else []
    if len(goals) < 2:
        subjects = [question.pose(command, **problem_options)]
    else:
        _refuse_one_file(question, values)
        subjects = [question.pose(command, **problem_options | {"goals_named": [goal]}) for goal in goals]
    problems = [value for subject in subjects for value in subject if isinstance(value, Problem)]
    if problems and unnamed:  # without a problem, the data may not be needed, and are not read
        goals = goals or command.dataset.assumed_goals()
    if {goal for problem in problems for goal in problem.goal_nodes} != set(goals):
        goals = []  # the question has other goals, which are not assumed
    if problems and (goals or not command.dataset.has_kitchen):
        from foon_asp.dataset.assumption_lines import goal_lines, kitchen_lines

        lines = [*goal_lines(command.dataset, goals, shared_options.is_verbose())] if goals else []
        if not command.dataset.has_kitchen:
            lines += kitchen_lines(command.dataset, problems, shared_options.is_verbose())
        if lines:
            say("\n".join(lines))
    return subjects


def _refuse_one_file(question: Question, values: Mapping[str, Any]) -> None:
    """Raise :class:`UserError` where the results for several goals would be written into one file."""
    files = [values.get("output"), values.get("certificate")]
    if question.suffixes or any(files):
        raise UserError(
            "no goal is named, and there are several, which one file cannot hold: name one (--goal)"
        )


class _Command:
    """The command of a question, as :class:`foon_asp.questions.posing.Command` describes it."""

    def __init__(self, data: dict[str, Any]) -> None:
        self._data = data
        self._context = click.get_current_context()

    @cached_property
    def dataset(self) -> Dataset:
        """The data that the options name, read at the first access."""
        return shared_options.read_dataset(**self._data)

    @property
    def read_seconds(self) -> float | None:
        """The time that reading took; ``None`` if nothing was read."""
        return self.dataset.read_seconds if "dataset" in self.__dict__ else None

    def unnamed_goals(self) -> list[ObjectNode]:
        """Return the goals of a command without ``--goal``, which are answered one by one.

        If the command names data with several listed goals, these are all of them; else the assumed goals.
        """
        if self.names_data:
            listed = self.dataset.listed
            return self.dataset.listed_goals() if len(listed) > 1 else self.dataset.assumed_goals()
        return self.dataset.assumed_goals()

    @property
    def names_data(self) -> bool:
        """Whether the command names a network."""
        return any(self._data.get(option) for option in ("sources", "folder", "network"))

    @property
    def level(self) -> int:
        """The level at which object nodes are compared."""
        level: int = self._data["level"]
        return level

    @property
    def measures_named(self) -> bool:
        """Whether the command names files of measures."""
        return bool(self._data.get("measures"))

    def given(self, option: str) -> bool:
        """Return whether the value of an option is from the command line, and no default."""
        return self._context.get_parameter_source(option) is ParameterSource.COMMANDLINE

    def add_sources(self, sources: Sequence[Path]) -> None:
        """Add networks that are named without an option; the data are read anew."""
        if sources:
            self._data["sources"] = (*self._data.get("sources", ()), *sources)
            self.__dict__.pop("dataset", None)

    def reading(self) -> AbstractContextManager[object]:
        """Return a context in which reading stops at the limits of the command."""
        return shared_options.reading()
