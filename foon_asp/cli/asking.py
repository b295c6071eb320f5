"""From a parsed command to a result: read the data, pose the problem, and call the question."""

import importlib
from collections.abc import Mapping, Sequence
from contextlib import AbstractContextManager
from functools import cached_property
from pathlib import Path
from typing import Any

import click
from click.core import ParameterSource

from foon_asp.cli import shared_options
from foon_asp.cli.output import write_remark
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
    """Import the module of a verb, and return the question that the verb asks."""
    module = importlib.import_module(f"foon_asp.questions.{module_name(verb)}")
    return question_of(getattr(module, question_name(verb)))


def values_with_role(question: Question, values: Mapping[str, Any], roles: Role) -> dict[str, Any]:
    """Return the values, by name, of the options of a question that have one of the ``roles``.

    An option without a value is left out.
    """
    names = (option.name for option in question.options if option.role & roles)
    return {name: values[name] for name in names if name in values}


def ask(
    question: Question, values: Mapping[str, Any], deadline: Deadline | None, form: str | None = None
) -> Result:
    """Read the data that a command names, call its question, and return the result.

    ``values`` are the values of all options by name. ``form`` is the chosen format of the result, or ``None``
    for the default format. If no goal is named and there are several, the question is called for each one.
    The result is then an :class:`EachGoal`. Progress is shown at a terminal. A file of measures that has no
    effect causes a warning.
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
            options_ = values_with_role(question, values, Role.QUESTION | Role.COMMAND)
            results = [question.command(*subject, **options_) for subject in subjects]
    if len(results) == 1:
        return results[0]
    return EachGoal(answers=tuple(results))


def _warn_of_measures(command: "_Command", values: Mapping[str, Any]) -> None:
    """Print a warning for each ``--measure`` file of which no measure is an objective of the question.

    For a question without objectives, nothing is printed.
    """
    chosen = values.get("objectives")
    if not command.names_measures or chosen is None:
        return
    chosen_names = {word.strip() for words in chosen for word in words.split(",")}
    measures_of: dict[str, list[str]] = {}
    for measure in command.dataset.measures.values():
        measures_of.setdefault(measure.place, []).append(measure.name)
    for file, names in measures_of.items():
        if chosen_names.isdisjoint(names):
            objective_options = " or ".join(f"--objective {name}" for name in names)
            warning = "no objective is its measure, so it has no effect; add"
            click.echo(f"{file}: warning: {warning} {objective_options}", err=True)


def _subjects(question: Question, command: "_Command", values: Mapping[str, Any]) -> list[tuple[object, ...]]:
    """Return the first arguments of each call of a question, such as ``(problem,)``.

    If the command names no goals or no data, a file with a tree may name them. If there are several goals and
    the command names none, there is a call for each goal. Otherwise, there is one call. Assumed goals and
    kitchen items are printed to stderr. Raises :class:`UserError` if the results for several goals would be
    written into one file.
    """
    problem_options = values_with_role(question, values, Role.PROBLEM)
    tree = values.get("tree")
    if question.pose is not pose_plan and tree is not None and tree.is_file():  # a pipe is read once
        answer = read_answer(tree)
        data_for_trees(command, {tree: answer})
        if problem_options.get("goals_named") == ():
            problem_options["goals_named"] = tuple(map(str, answer.goals))
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
            write_remark("\n".join(lines))
    return subjects


def _refuse_one_file(question: Question, values: Mapping[str, Any]) -> None:
    """Raise :class:`UserError` if the results for several goals would be written into one file.

    That is so for a question whose result may be a file, and for a command with ``--certificate``.
    """
    files = [values.get("output"), values.get("certificate")]
    if question.suffixes or any(files):
        raise UserError(
            "no goal is named, and there are several, which one file cannot hold: name one (--goal)"
        )


class _Command:
    """The current command of click, as :class:`foon_asp.questions.posing.Command` describes commands.

    ``data_options`` are the values of the options of :func:`foon_asp.cli.shared_options.read_dataset` by
    name.
    """

    def __init__(self, data_options: dict[str, Any]) -> None:
        self._data_options = data_options
        self._context = click.get_current_context()

    @cached_property
    def dataset(self) -> Dataset:
        """The data that the options name, read at the first access."""
        return shared_options.read_dataset(**self._data_options)

    @property
    def read_seconds(self) -> float | None:
        """The seconds that reading took; ``None`` if nothing was read."""
        return self.dataset.read_seconds if "dataset" in self.__dict__ else None

    def unnamed_goals(self) -> list[ObjectNode]:
        """Return the goals of a command without ``--goal``, which are answered one by one.

        They are the listed goals if the command names data that list several. Otherwise, they are assumed.
        """
        has_listed_goals = self.names_data and len(self.dataset.goal_entries) > 1
        return self.dataset.listed_goals() if has_listed_goals else self.dataset.assumed_goals()

    @property
    def names_data(self) -> bool:
        """Whether the command names a network, or a folder of data."""
        return any(self._data_options.get(option) for option in ("sources", "folder", "network"))

    @property
    def level(self) -> int:
        """The level at which object nodes are compared."""
        level: int = self._data_options["level"]
        return level

    @property
    def names_measures(self) -> bool:
        """Whether the command names files of measures."""
        return bool(self._data_options.get("measures"))

    def given(self, option: str) -> bool:
        """Return whether the value of an option is from the command line, and not a default."""
        return self._context.get_parameter_source(option) is ParameterSource.COMMANDLINE

    def add_sources(self, sources: Sequence[Path]) -> None:
        """Add networks to those that the command names; ``dataset`` then reads the data again."""
        if sources:
            self._data_options["sources"] = (*self._data_options.get("sources", ()), *sources)
            self.__dict__.pop("dataset", None)

    def reading(self) -> AbstractContextManager[object]:
        """Return a context manager in which reading stops at the limits of the command."""
        return shared_options.reading()
