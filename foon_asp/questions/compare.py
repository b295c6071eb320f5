"""The searches of the literature, compared with the optimum."""

import contextlib
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from foon_asp.compare.comparison import Comparison
from foon_asp.compare.many import compare_goals, makeable
from foon_asp.compare.results_file import ResultsFile, comparison_json, results_question
from foon_asp.compare.summary import all_proved, summarize_comparisons
from foon_asp.dataset.items import items_of
from foon_asp.dataset.paths import File, Files
from foon_asp.deadline import Cancel
from foon_asp.document.json_document import document, goals_json, nodes_json
from foon_asp.errors import UserError
from foon_asp.problem import Problem
from foon_asp.problem.progress import OnProgress
from foon_asp.questions.arguments import Constants, asked_with, at_least, limits, settings
from foon_asp.questions.caller import caller
from foon_asp.questions.contract import Kind, Option, Part, question
from foon_asp.questions.options import CONTAINERS, EACH_GOAL, EACH_LIMITS, ITEMS, JOBS, RULES
from foon_asp.questions.posing import Command, each_goal
from foon_asp.questions.result import Ending, Result
from foon_asp.questions.searching import SEARCHING, known_searches, search_settings, searched
from foon_asp.report.bar_chart import write_chart
from foon_asp.report.comparison_chart import comparison_chart
from foon_asp.report.comparison_table import (
    comparisons_csv,
    comparisons_markdown,
    comparisons_table,
    summary_lines,
)
from foon_asp.report.published_table import PublishedTable, published_markdown, read_published
from foon_asp.report.renderable import Renderable
from foon_asp.resources import published_table
from foon_asp.search import search_names
from foon_asp.text.json_value import Json

_CHARTED = 60  # goals that a chart has room for


@dataclass(frozen=True, repr=False)
class Compared(Result):
    """The searches and the optimum, compared for each goal of a problem.

    Each of ``comparisons`` has ``optima`` by objective, and a judgement for each search, for one goal of
    ``problem``. ``comparison.ratio(judgement, objective)`` is a tree's measure divided by the optimum.
    ``published`` are published figures to show beside the measured ones, if any; ``summed_up`` tells whether
    the text is a summary of all goals.

    Example:
        >>> compared = foon_asp.compare_searches(foon_asp.load().problem("macaroni"), ["bfs"])
        >>> comparison = compared.comparisons[0]
        >>> str(comparison.ratio(comparison.judgements[0], foon_asp.Objective.UNITS))
        '10/9'
        >>> compared.markdown().splitlines()[0]
        '| goal | search | units | inputs | success | executes |'
        >>> compared.csv()[:10]
        'goal,conta'
    """

    problem: Problem
    comparisons: tuple[Comparison, ...]
    published: PublishedTable | None = None
    summed_up: bool = False

    @property
    def proved(self) -> bool:
        """Whether all optima are proved."""
        return all_proved(self.comparisons)

    @property
    def ending(self) -> Ending:
        """Done when every optimum is proved."""
        return Ending.DONE if self.proved else Ending.LIMIT

    def text(self) -> str:
        """Give the table in Markdown; a summary of everything that can be made."""
        return self.markdown()

    def markdown(self) -> str:
        """Give the table in Markdown, or what is said in its place."""
        if self.published is not None:
            return published_markdown(self.published, self._labels(), self.comparisons)
        if self.summed_up:
            lines = summary_lines(summarize_comparisons(self.comparisons), self.proved)
            return "\n".join(lines) + "\n"
        return comparisons_markdown(self.comparisons)

    def renderable(self) -> Renderable | None:
        """Give the table, as wide and in such colours as a console has."""
        return None if self.published or self.summed_up else comparisons_table(self.comparisons)

    def csv(self) -> str:
        """Give one line for each goal and search; fractions exact, ratios as decimals too."""
        return comparisons_csv(self.comparisons)

    def json_dict(self) -> object:
        """Give the comparisons, one for each goal; positions count from 1."""
        network = self.problem.network
        ids = {str(node): o for o, node in enumerate(network.objects)}

        def name(holder: Json | None, key: str) -> None:
            if holder and holder[key] is not None:
                (holder[key],) = nodes_json(network, [ids[holder[key]]])

        rows = list(map(comparison_json, self.comparisons))
        for row, goal in zip(rows, goals_json(network, self.problem.goals), strict=True):
            row["goal"] = goal
            del row["containers"], row["items"], row["level"]
            for search in row["searches"]:
                name(search, "stuck_at")
                name(search["obstacle"], "missing")
                search["units"] = search["units"] and list(map(network.unit_number, search["units"]))
        objectives = dict.fromkeys(each for row in self.comparisons for each in row.optima)
        return document("compare", self.problem, objectives, comparisons=rows)

    def write_chart(self, file: File) -> None:
        """Draw a bar chart of units into a file.

        Parameters:
            file: The path of the file, which ends in ``.svg`` or ``.png``.

        Raises:
            UserError: for too many goals, for another file name, or if the packages of
                ``foon-asp[pictures]`` are missing.
        """
        _hold_readable(self.problem)
        write_chart(comparison_chart(self._labels(), self.comparisons), Path(file))

    def _labels(self) -> list[str]:
        return [node.label for node in self.problem.goal_nodes]

    def __repr__(self) -> str:
        return f"<Compared: {', '.join(comparison.goal for comparison in self.comparisons)}>"

    def _in_notebook(self) -> dict[str, str]:
        """Give what a notebook shows by media type: the table."""
        return {"text/plain": repr(self), "text/markdown": str(self)}


def _posed(
    command: Command,
    goals_named: Sequence[str],
    containers: str,
    all_makeable: bool,
    published: bool,
    charts: Sequence[Path],
    items: str,
    stock: File | None,
    stays: File | None,
) -> tuple[Problem]:
    """Pose the goals, and refuse what cannot be laid beside them before anything is solved."""
    if published:
        table = read_published(published_table())
        goals_named = goals_named or tuple(table.goals)
        if all_makeable or not table.goals.keys() >= set(goals_named):
            raise UserError(f"the published table has the goals {', '.join(table.goals)} and no others")
        if containers != table.containers:
            caller().reporter.warning(
                f"warning: the published searches use {table.containers} containers, this is {containers}: "
                f"add --containers {table.containers}"
            )
    if all_makeable:
        how = items_of(command.dataset, items, stock, stays)
        problem = _everything_makeable(command.dataset.problem((0,), containers, everything=True, items=how))
    else:
        (problem,) = each_goal(command, goals_named, containers, items, stock, stays)
    if charts:
        _hold_readable(problem)
    return (problem,)


def _everything_makeable(problem: Problem) -> Problem:
    goals = makeable(problem)
    if not goals:
        raise UserError("there are no goals: nothing can be made that is not in the kitchen")
    return replace(problem, goals=tuple(goals))


def _hold_readable(problem: Problem) -> None:
    if len(problem.goals) > _CHARTED:
        raise UserError(
            f"a chart of {len(problem.goals)} goals would be unreadable; name up to {_CHARTED} with --goal"
        )


@question(
    EACH_GOAL,
    Option(
        "all_makeable",
        "Compare for every object that can be made, and print a summary.",
        Kind.FLAG,
        Part.PROBLEM | Part.QUESTION,
        default=False,
    ),
    Option(
        "searches",
        "A search to run; by default all of them, including those of other packages.",
        flags=("--search",),
        many=True,
        choices=search_names,
    ),
    *SEARCHING,
    Option(
        "published",
        "Show the published figures beside the measured ones.",
        Kind.FLAG,
        Part.PROBLEM | Part.QUESTION,
        default=False,
    ),
    CONTAINERS,
    *ITEMS,
    *RULES,
    *EACH_LIMITS,
    JOBS,
    Option(
        "results",
        "A file to which results are added, as JSON Lines; goals that it already has are not searched again.",
        Kind.FILE,
    ),
    Option(
        "charts",
        "A file for a bar chart of units (.svg or .png).",
        Kind.FILE,
        Part.CHART | Part.PROBLEM,
        flags=("--chart",),
        many=True,
    ),
    help_="""
    \b
    foon-asp compare                                   every goal of the goals file
    foon-asp compare --goal macaroni --containers implied
    foon-asp compare --all-makeable --jobs 2 --results makeable.jsonl

    The searches are run, every tree they return is simulated, and the optima are proved beside them. Each
    goal is answered by itself, and the limits are for each answer. Under rules, the optima keep to them, and
    of each tree it is said which ones it breaks. Exits with 0 when every
    optimum is proved, and with 3 when one was stopped at a limit.
    """,
    formats=("text", "json", "csv", "markdown"),
    pose=_posed,
)
def compare_searches(
    problem: Problem,
    searches: Iterable[str] = (),
    *,
    all_makeable: bool = False,
    ties: str = "first",
    count: str = "ingredients",
    depth_limit: int | None = None,
    published: bool = False,
    constraints: Files = (),
    constants: Constants | None = None,
    encodings: File | None = None,
    time_limit: float | None = None,
    memory_limit: int | str | None = None,
    jobs: int = 1,
    results: File | None = None,
    on_progress: OnProgress | None = None,
    cancel: Cancel | None = None,
) -> Compared:
    """Run searches for each goal of a problem by itself, and prove the optimum beside them.

    The limits are for each search and each optimum. Optima keep to constraints; of each tree of a search
    that executes, it is said which of their rules it breaks.

    Parameters:
        searches: Names of searches, as for :func:`foon_asp.retrieve`; without any, all that are known.
        all_makeable: Whether to search for every object that can be made, and to print a summary.
        published: Whether to run ids as published, and to show the published figures beside the measured
            ones if all goals have some.

    Returns:
        One comparison for each goal, with figures for each search and the optimum.

    Raises:
        UserError: for a wrong argument, or a file of results that belongs to another question.

    Example:
        >>> compared = foon_asp.compare_searches(foon_asp.load().problem("macaroni"), ["bfs"])
        >>> bfs = compared.comparisons[0].judgements[0]
        >>> len(bfs.units), bfs.executes
        (10, 'executes in another order')
    """
    searches = tuple(searches)
    chosen = searched(searches)
    if problem.rates is None and not searches:
        chosen = known_searches(rated=False)
        caller().reporter.warning("greedy-success is left out, and so is success: no success rates are known")
    how = search_settings(ties, count, depth_limit, published, *limits(time_limit, memory_limit))
    at_least(jobs, 1, "jobs")
    rules = settings(constraints, constants, encodings)._replace(session=None, deadline=None)
    if rules.replaced is not None:
        raise UserError(f"{rules.replaced}: searches know nothing of other encodings: leave them out")
    problem = asked_with(problem, rules)
    if all_makeable or results is not None:  # results are kept with a digest of all the data
        problem = problem.whole
    if all_makeable:
        problem = _everything_makeable(problem)
    goals = {str(node): goal for node, goal in zip(problem.goal_nodes, problem.goals, strict=True)}
    with contextlib.ExitStack() as stack:
        done: dict[str, Comparison] = {}
        file = None
        if results is not None:
            begun_for = results_question(problem, chosen, how, rules)
            file = stack.enter_context(ResultsFile(Path(results), begun_for))
            done = file.done
        left = [goal for name, goal in goals.items() if name not in done]
        before = len(goals) - len(left)
        caller().reporter.step("comparing", before, len(goals))
        rows = compare_goals(problem, left, chosen, how, how.time_limit, jobs, rules)
        for number, row in enumerate(rows, 1):
            if file is None:
                done[row.goal] = row
            else:
                file.add(row)
            caller().reporter.step("comparing", before + number, len(goals))
    table = read_published(published_table()) if published else None
    if table is not None and not table.goals.keys() >= {node.label for node in problem.goal_nodes}:
        table = None
    compared = tuple(done[name]._replace(starting=problem.starting) for name in goals)
    return Compared(problem, compared, table, all_makeable)
