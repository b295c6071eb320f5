"""The optimum of every goal by itself, under one or several lists of objectives."""

from collections.abc import Iterable, Iterator, Sequence
from fractions import Fraction
from itertools import chain
from typing import Unpack

from foon_asp.asp import Outcome, Settings, Status, solve
from foon_asp.dataset.nearby import NearbyProblem, without_reading_more
from foon_asp.dataset.nearby_optimum import near_goals
from foon_asp.deadline import Deadline
from foon_asp.hypergraph import SolvedGoals
from foon_asp.json_layout import schema_name
from foon_asp.problem import Objective, Problem, for_each_goal
from foon_asp.questions.answer import Answer, answer_from_store
from foon_asp.questions.caller import caller
from foon_asp.questions.ending import Ending
from foon_asp.questions.python_arguments import chosen_objectives, problem_for_rules, read_deferred
from foon_asp.questions.python_options import CommonOptions, limits_of, settings_of
from foon_asp.questions.question import python_question
from foon_asp.questions.result import Result
from foon_asp.results.document import AboutGoals
from foon_asp.results.figure_text import figure_text
from foon_asp.results.table import Block, Cell, Table
from foon_asp.results.values_of import question_fields

_ALWAYS = (Objective.UNITS, Objective.INPUTS, Objective.SUCCESS)  # columns; others where they are asked for
_STYLES = {Status.OPTIMAL: "good", Status.INFEASIBLE: "bad"}
_LEFT_ALIGNED = frozenset({0, 1})


class Optima(Result, AboutGoals, frozen=True, kw_only=True, tag=schema_name("optima")):
    """The best trees for each goal by itself.

    Attributes:
        answers: Goal by goal, one answer for each list of objectives.

    Example:
        >>> best = foon_asp.solve_all_goals(foon_asp.load(), ["units", "success"], goal="ice")
        >>> [str(answer.objectives[0]) for answer in best.answers]
        ['units', 'success']
    """

    ROWS = "answers"

    answers: tuple[Answer, ...]

    @property
    def ending(self) -> Ending:
        """``DONE`` if every answer is proved, infeasible ones included; else ``LIMIT``."""
        stopped = any(answer.ending is Ending.LIMIT for answer in self.answers)
        return Ending.LIMIT if stopped else Ending.DONE

    def show(self) -> Iterator[Block]:
        """Yield a title, a table, and notes on words and signs in the table.

        Answers with equal goal, status and costs share a row.
        """
        first = self.answers[0]
        trees, tree = ("task trees", "tree") if self.items == "lasting" else ("plans", "plan")
        yield f"The best {trees} ({first.conditions})"
        yield ""
        objective_lists = list(dict.fromkeys(answer.objectives for answer in self.answers))
        other_objectives = [
            objective for objective in dict.fromkeys(chain(*objective_lists)) if objective not in _ALWAYS
        ]
        columns = (*_ALWAYS, *other_objectives)
        rows: list[list[str | Cell]] = []
        for goal, answer_groups in self._by_goal():
            for index, answers in enumerate(answer_groups):
                cells = _cells(answers, len(objective_lists), columns)
                rows.append([Cell("" if index else goal, "strong"), *cells])
        yield Table(
            ["goal", "best by", *columns, "status", "seconds"], rows, _LEFT_ALIGNED | {len(columns) + 2}
        )
        if any(answer.status is Status.OPTIMAL for answer in self.answers):
            yield "optimal: proved best by the objective named"
        if any(answer.status is Status.INFEASIBLE for answer in self.answers):
            yield f"infeasible: proved that no {tree} exists"
        if any(map(_is_short_of_copies, self.answers)):
            yield "* with each item used once, it does not run: see --items used-up"

    def _by_goal(self) -> Iterator[tuple[str, list[list[Answer]]]]:
        """Yield the label of each goal, and its answers in groups with equal status and costs."""
        goals: dict[object, dict[object, list[Answer]]] = {}
        for answer in self.answers:
            rows = goals.setdefault(answer.goals, {})
            rows.setdefault((answer.status, answer.costs), []).append(answer)
        for rows in goals.values():
            answer_groups = list(rows.values())
            yield " + ".join(goal.label for goal in answer_groups[0][0].goals), answer_groups

    def __repr__(self) -> str:
        return f"<Optima: {len(self.answers)} answers>"


def _cells(answers: list[Answer], list_count: int, columns: Iterable[Objective]) -> Iterator[str | Cell]:
    """Yield the cells after the goal in a row of a table, for answers with equal status and costs.

    The cells are:

    - the lists of objectives that the answers are for, or ``all`` if they are for all of several lists;
      a ``*`` marks a tree that does not run if items are used up
    - the measure by each objective in ``columns``, or ``–`` if it is not known
    - the status
    - the sum of the seconds

    ``list_count`` is the number of all lists. Without a tree, the first cell and the measures are empty.
    """
    first = answers[0]
    names = [" then ".join(answer.objectives) for answer in answers]
    leading = {answer.objectives[0] for answer in answers}
    mark = " *" if any(map(_is_short_of_copies, answers)) else ""
    yield "" if first.costs is None else ("all" if len(names) == list_count > 1 else ", ".join(names)) + mark
    for objective in columns:
        measure = None if first.costs is None else first.costs.measures.get(objective)
        text = "" if first.costs is None else "–" if measure is None else _measure_text(objective, measure)
        yield Cell(text, "good" if objective in leading and first.status is Status.OPTIMAL else "")
    yield Cell(first.status, _STYLES.get(first.status, ""))
    yield f"{sum(sum(answer.seconds.values()) for answer in answers):.2f}"


def _measure_text(objective: Objective, measure: int | Fraction) -> str:
    """Return a measure as text; a success rate is a decimal: ``0.6440``, or ``6.440e-04`` below 1/1000."""
    if objective is not Objective.SUCCESS:
        return figure_text(objective, measure)
    return f"{float(measure):.4f}" if measure >= Fraction(1, 1000) else f"{float(measure):.3e}"


def _is_short_of_copies(answer: Answer) -> bool:
    """Whether the answer has a tree, and this tree is known not to run if items are used up."""
    return answer.used_up is not None and answer.used_up.runs is False


@python_question
def solve_all_goals(
    problem: Problem, objectives: str | Iterable[str] = "units", **options: Unpack[CommonOptions]
) -> Optima:
    """Find the best tree for each goal of a problem by itself, under several lists of objectives.

    The limits are for each answer. Ctrl-C stops all answers.

    Parameters:
        objectives: Several objectives; each is one name, or a list separated by commas.

    Returns:
        The ``answers``: for each goal in order, one :class:`Answer` for each list of objectives.

    Raises:
        UserError: for a wrong argument or constraint, or an objective that needs rates or prices not given.

    Example:
        >>> foon = foon_asp.load()
        >>> found = foon_asp.solve_all_goals(foon, ["units", "success"], goal=["ice", "tea"])
        >>> [answer.costs.units for answer in found.answers]
        [2, 3, 7, 7]
    """
    list_texts = [objectives] if isinstance(objectives, str) else objectives
    objective_lists = [chosen_objectives(problem, text) for text in list_texts]
    # limits are for each answer, ctrl-C is for all of them
    settings, each_limits = settings_of(options), limits_of(options)
    outer = Deadline(within=caller().deadline)
    solved_by_list = [SolvedGoals() for _ in objective_lists]
    outcomes_of: dict[int, list[Outcome]] = {}
    for index, goal_problem in _in_search_order(_problems_by_goal(problem, settings), solved_by_list[0]):
        outcomes_of[index] = []
        for objective_list, solved in zip(objective_lists, solved_by_list, strict=True):
            goal_settings = settings._replace(deadline=Deadline(*each_limits, within=outer))
            nearby = near_goals(goal_problem, objective_list, goal_settings)
            if nearby is None:
                outcome = solve(
                    read_deferred(goal_problem),
                    objective_list,
                    goal_settings,
                    caller().reporter,
                    solved=solved,
                )
            else:
                outcome = answer_from_store(nearby, objective_list, goal_settings).outcome
            outcomes_of[index].append(outcome)
    outcomes = [outcome for index in range(len(outcomes_of)) for outcome in outcomes_of[index]]
    objectives_of_all = dict.fromkeys(objective for outcome in outcomes for objective in outcome.objectives)
    return Optima(
        **question_fields(without_reading_more(problem), objectives_of_all),
        answers=tuple(map(Answer.of, outcomes)),
    )


def _in_search_order(problems: Sequence[Problem], solved: SolvedGoals) -> Iterator[tuple[int, Problem]]:
    """Yield problems of one goal each, with their index, in the order in which they are to be solved.

    Until ``solved`` has landmarks to share, the order is the given one. From then on, problems whose goal has
    a smaller ``h_add`` come first. The caller adds to ``solved`` while it solves the problems.
    """
    remaining = [*range(len(problems))]
    while remaining and not solved.sharing:
        index = remaining.pop(0)
        yield index, problems[index]
    for index in sorted(remaining, key=lambda index: solved.h_add(problems[index].goals[0])):
        yield index, problems[index]


def _problems_by_goal(problem: Problem, settings: Settings) -> list[Problem]:
    """Return a problem for each goal of a problem.

    Without rules and replaced encodings, each problem over a large store reads only units near its own goal.
    In all other cases, the whole network is read if rules or stand-ins need it.
    """
    if isinstance(problem, NearbyProblem) and not settings.constraints and settings.replaced is None:
        return problem.single_goal_problems()
    return for_each_goal(problem_for_rules(problem, settings))
