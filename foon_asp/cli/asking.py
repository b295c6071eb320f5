"""How a command asks a question: it reads the data, makes the problem, and asks."""

import importlib
from collections.abc import Mapping, Sequence
from contextlib import AbstractContextManager
from functools import cached_property
from pathlib import Path
from typing import Any

import click
from click.core import ParameterSource

from foon_asp.cli import options
from foon_asp.cli.output import say
from foon_asp.cli.progress import Progress
from foon_asp.dataset import Dataset
from foon_asp.deadline import Deadline
from foon_asp.errors import UserError
from foon_asp.network import ObjectNode
from foon_asp.problem import Problem
from foon_asp.questions.caller import Caller, asked_by
from foon_asp.questions.contract import Question, Role, question_of
from foon_asp.questions.each_goal import EachGoal
from foon_asp.questions.index import module_name, question_name
from foon_asp.questions.posing import no_data, one_problem
from foon_asp.questions.posing_plan import a_plan, settle_data
from foon_asp.questions.result import Result
from foon_asp.questions.tree import read_answer


def find_question(verb: str) -> Question:
    """Give a question; its module is imported only then."""
    module = importlib.import_module(f"foon_asp.questions.{module_name(verb)}")
    return question_of(getattr(module, question_name(verb)))


def parameters(question: Question, given: Mapping[str, Any], parts: Role) -> dict[str, Any]:
    """Give the values of the options that belong to these parts."""
    own = (option.name for option in question.options if option.role & parts)
    return {name: given[name] for name in own if name in given}


def ask(
    question: Question, given: Mapping[str, Any], deadline: Deadline | None, form: str | None = None
) -> Result:
    """Ask a question with the parameters of a command, whose ``deadline`` it has.

    ``form`` is the format of the result, if one is chosen.
    """
    own = {option.name for option in question.options}
    command = _Command({name: value for name, value in given.items() if name not in own})
    with Progress(deadline) as progress:
        who = Caller(progress, deadline=deadline, lenient=bool(given.get("lenient")), form=form)
        with asked_by(who):
            posed = _posed(question, command, given)
        _warn_of_measures(command, given)
        if question.pose is not no_data or "time_limit" in {option.name for option in question.options}:
            progress.begin()  # there is a tree to wait for
        with asked_by(who._replace(read_seconds=command.read_seconds)):
            how = parameters(question, given, Role.QUESTION | Role.COMMAND)
            found = [question.command(*about, **how) for about in posed]
    if len(found) == 1:
        return found[0]
    return EachGoal(answers=tuple(found))


def _warn_of_measures(command: "_Command", given: Mapping[str, Any]) -> None:
    """Warn of files of measures none of which is an objective of the question."""
    chosen = given.get("objectives")
    if not command.measures_named or chosen is None:
        return
    named = {word.strip() for words in chosen for word in words.split(",")}
    files: dict[str, list[str]] = {}
    for measure in command.dataset.measures.values():
        files.setdefault(measure.place, []).append(measure.name)
    for place, names in files.items():
        if named.isdisjoint(names):
            listed = " or ".join(f"--objective {name}" for name in names)
            click.echo(
                f"{place}: warning: no objective is its measure, so it has no effect; add {listed}", err=True
            )


def _posed(question: Question, command: "_Command", given: Mapping[str, Any]) -> list[tuple[object, ...]]:
    """Pose a question: once, or for each of several goals that were assumed. What is assumed is said."""
    asked = parameters(question, given, Role.PROBLEM)
    tree = given.get("tree")
    if question.pose is not a_plan and tree is not None and tree.is_file():  # a pipe is read once
        listed = read_answer(tree)
        settle_data(command, {tree: listed})
        if asked.get("goals_named") == ():
            asked["goals_named"] = tuple(map(str, listed.goals))
    says_goals = question.pose in {no_data, a_plan}  # itself, where there are any
    unnamed = not says_goals and asked.get("goals_named") == ()
    alone = question.pose is one_problem and not asked.get("all_goals")
    each_alone = unnamed and alone
    goals = command.unnamed_goals() if each_alone else []
    if len(goals) < 2:
        posed = [question.pose(command, **asked)]
    else:
        _refuse_one_file(question, given)
        posed = [question.pose(command, **asked | {"goals_named": [goal]}) for goal in goals]
    problems = [each for about in posed for each in about if isinstance(each, Problem)]
    if problems and unnamed:  # what is about no problem may need no data
        goals = goals or command.dataset.assumed_goals()
    if {goal for problem in problems for goal in problem.goal_nodes} != set(goals):
        goals = []  # it is about others
    if problems and (goals or not command.dataset.has_kitchen):
        from foon_asp.dataset.assumed import goal_lines, kitchen_lines

        lines = [*goal_lines(command.dataset, goals, options.is_verbose())] if goals else []
        if not command.dataset.has_kitchen:
            lines += kitchen_lines(command.dataset, problems, options.is_verbose())
        if lines:
            say("\n".join(lines))
    return posed


def _refuse_one_file(question: Question, given: Mapping[str, Any]) -> None:
    """Raise :class:`UserError` if the answers for several goals would be written into one file."""
    files = [given.get("output"), given.get("certificate")]
    if question.suffixes or any(files):
        raise UserError(
            "no goal is named, and there are several, which one file cannot hold: name one (--goal)"
        )


class _Command:
    """What a question may use of its command: the data, and the limits of reading."""

    def __init__(self, data: dict[str, Any]) -> None:
        self._data = data
        self._context = click.get_current_context()

    @cached_property
    def dataset(self) -> Dataset:
        """The data that the options name; read when first used."""
        return options.read_dataset(**self._data)

    @property
    def read_seconds(self) -> float | None:
        """How long reading took; ``None`` if nothing was read."""
        return self.dataset.read_seconds if "dataset" in self.__dict__ else None

    def unnamed_goals(self) -> list[ObjectNode]:
        """Return the goals that are answered one by one where none is named: of data that are named, all."""
        if self.names_data:
            listed = self.dataset.listed
            return self.dataset.listed_goals() if len(listed) > 1 else self.dataset.assumed_goals()
        return self.dataset.assumed_goals()

    @property
    def names_data(self) -> bool:
        """Whether a network is named."""
        return any(self._data.get(option) for option in ("sources", "folder", "network"))

    @property
    def level(self) -> int:
        """The level at which object nodes are compared."""
        found: int = self._data["level"]
        return found

    @property
    def measures_named(self) -> bool:
        """Whether files of measures are named."""
        return bool(self._data.get("measures"))

    def given(self, option: str) -> bool:
        """Whether an option was given in the command itself, and not by default."""
        return self._context.get_parameter_source(option) is ParameterSource.COMMANDLINE

    def add_sources(self, sources: Sequence[Path]) -> None:
        """Add networks that are named without an option; the data are read anew."""
        if sources:
            self._data["sources"] = (*self._data.get("sources", ()), *sources)
            self.__dict__.pop("dataset", None)

    def reading(self) -> AbstractContextManager[object]:
        """Stop what is read in a ``with`` block at the limits of the command."""
        return options.reading()
