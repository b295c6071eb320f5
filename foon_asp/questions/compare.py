"""The published searches, compared with the optimum."""

import contextlib
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Unpack

from msgspec import UNSET, UnsetType, structs

from foon_asp.asp import Settings
from foon_asp.asp.assembly import assemble
from foon_asp.comparison.comparison import Comparison
from foon_asp.comparison.comparison_rows import COMPARISONS, comparisons_question
from foon_asp.comparison.many import compare_goals, makeable
from foon_asp.comparison.published_table import PublishedTable, read_published
from foon_asp.comparison.rows_file import RowsFile
from foon_asp.comparison.summary import all_proved, summarize_comparisons
from foon_asp.dataset.item_options import items_of
from foon_asp.dataset.paths import File
from foon_asp.errors import UserError
from foon_asp.json_layout import Json, schema_name
from foon_asp.pictures.comparison_chart import write_comparison_chart
from foon_asp.problem import Problem
from foon_asp.questions.caller import caller
from foon_asp.questions.comparison_tables import comparison_table, published_table, summary_tables, tidy_rows
from foon_asp.questions.ending import Ending
from foon_asp.questions.options import CHART, CONTAINERS, EACH_GOAL, EACH_LIMITS, ITEMS, JOBS
from foon_asp.questions.posing import Command, pose_problem
from foon_asp.questions.python_arguments import problem_for_rules, require_at_least
from foon_asp.questions.python_options import CommonOptions, limits_of, settings_of
from foon_asp.questions.question import TABLES, Kind, Option, Role, question
from foon_asp.questions.result import Result
from foon_asp.questions.search import Retrieved
from foon_asp.questions.search_options import (
    COUNT,
    DEPTH,
    TIES,
    search_settings,
    searches_named,
    usable_searches,
)
from foon_asp.resources import published_table as published_file
from foon_asp.results.document import AboutGoals, Unserialized
from foon_asp.results.table import Block
from foon_asp.results.values_of import question_fields
from foon_asp.searches import Search, SearchSettings, search_names

_ONE_TREE = "FOON text holds one tree: name one search (--search) and one goal (--goal)"


class Compared(Result, AboutGoals, frozen=True, kw_only=True, tag=schema_name("compare")):
    """The searches and the optimum, compared for each goal of a problem.

    Attributes:
        comparisons: The searches and the optimum for each goal.
        published: Published figures to show beside the measured ones, where they are asked for.

    Example:
        >>> compared = foon_asp.compare(foon_asp.load().problem("macaroni"), ["bfs"])
        >>> (bfs,) = compared.comparisons[0].searches
        >>> str(bfs.ratios[foon_asp.Objective.UNITS]), bfs.executes, compared.proved
        ('10/9', True, True)
        >>> compared.csv()[:12]
        'goal,search,'
    """

    comparisons: tuple[Comparison, ...]
    published: PublishedTable | UnsetType = UNSET

    retrieved = Unserialized[tuple[Retrieved, ...]]()
    """The tree of each search for each goal, if trees are asked for or there is only one; else empty."""

    summed_up = Unserialized[bool]()
    """Whether only a summary is shown."""

    @property
    def proved(self) -> bool:
        """Whether all optima are proved."""
        return all_proved(self.comparisons)

    @property
    def ending(self) -> Ending:
        """``DONE`` if every optimum is proved, else ``LIMIT``."""
        return Ending.DONE if self.proved else Ending.LIMIT

    def show(self) -> Iterator[Block]:
        """Yield the table, the trees if they are asked for, and a summary if there are several goals.

        With ``published``, yield only the table of published figures. With ``all_makeable``, yield only the
        summary.
        """
        if isinstance(self.published, PublishedTable):
            yield from published_table(self.published, self.comparisons)
            return
        if not self.summed_up:
            yield f"Searches and the optimum ({self.conditions})"
            yield ""
            yield from comparison_table(self.comparisons, self.items == "lasting")
            if self.comparisons[0].searches[0].tree is not UNSET:
                yield from (block for retrieved in self.retrieved for block in ("", *retrieved.show()))
            if len(self.comparisons) == 1:
                return
            yield ""
        yield from summary_tables(summarize_comparisons(self.comparisons), self.proved)

    def table_rows(self) -> Iterator[Json]:
        """Return a row for each goal and search: measures, optima, ratios, and whether the tree executes."""
        conditions = {"containers": self.containers, "items": self.items, "level": self.level}
        return (row | conditions for comparison in self.comparisons for row in tidy_rows(comparison))

    def foon(self) -> str:
        """Return the tree of one search for one goal as FOON text, in the order listed.

        Raises:
            UserError: for several goals or searches.
        """
        if len(self.retrieved) != 1:
            raise UserError(_ONE_TREE)
        return self.retrieved[0].foon()

    def write_chart(self, file: File) -> None:
        """Write a box plot: for each search, the units of its trees divided by the optimum, over all goals.

        Parameters:
            file: The path of the file, which ends in ``.svg`` or ``.png``.

        Raises:
            UserError: for another file name, or if the packages of ``foon-asp[pictures]`` are missing.
        """
        write_comparison_chart(self.comparisons, self.conditions, Path(file))

    def __repr__(self) -> str:
        return f"<Compared: {', '.join(map(str, self.goals))}>"


def _pose_goals(
    command: Command,
    goals_named: Sequence[str],
    containers: str,
    all_makeable: bool,
    published: bool,
    items: str,
    stock: File | None,
    stays: File | None,
) -> tuple[Problem]:
    """Return the problem whose goals are compared, in a tuple, as the first argument of :func:`compare`.

    With ``all_makeable``, the problem has an arbitrary goal, which :func:`compare` replaces. With
    ``published``, the goals are by default those of the published table. A goal outside of the table raises
    :class:`UserError`. Another container rule than the one of the table causes a warning.
    """
    if published:
        table = read_published(published_file())
        goals_named = goals_named or tuple(table.goals)
        if all_makeable or not table.goals.keys() >= set(goals_named):
            raise UserError(f"the published table has the goals {', '.join(table.goals)} and no others")
        if containers != table.containers:
            caller().reporter.warning(
                f"warning: the published searches use {table.containers} containers, this is {containers}: "
                f"add --containers {table.containers}"
            )
    if all_makeable:
        used_up = items_of(command.dataset, items, stock, stays)
        return (command.dataset.problem((0,), containers, everything=True, items=used_up),)
    return pose_problem(command, goals_named, containers, items, stock, stays, all_goals=True)


@question(
    EACH_GOAL,
    CONTAINERS,
    *ITEMS,
    *EACH_LIMITS,
    CHART._replace(help="A file for a chart of units over the optimum (.svg or .png)."),
    help_="""
    \b
    foon-asp compare                                   every goal of the goals file
    foon-asp compare --goal macaroni --containers implied
    foon-asp compare --goal macaroni --search bfs --trees
    foon-asp compare --goal macaroni --search bfs --format foon > tree.txt
    foon-asp compare --all-makeable --jobs 2 --results makeable.jsonl

    The searches are run, every tree they return is simulated, and the optima are proved beside them. bfs,
    dfs, greedy-success and greedy-inputs choose one unit for each object and never look back; ids backtracks,
    and returns a tree of least depth that executes or says that none does. Other packages may bring searches:
    docs/entry-points.md. They know nothing of items that are used up: their tree then executes if it runs as
    a plan, in some order.

    Each goal is answered by itself, and the limits are for each answer. Under rules, the optima keep to them,
    and of each tree it is said which ones it breaks. Exits with 0 when every optimum is proved, and with 3
    when one was stopped at a limit.
    """,
    formats=(*TABLES, "foon"),
    pose=_pose_goals,
)
def compare(
    problem: Problem,
    searches: Annotated[Iterable[str], Option(flags=("--search",), many=True, choices=search_names)] = (),
    *,
    trees: Annotated[bool, Option()] = False,
    all_makeable: Annotated[bool, Option(role=Role.PROBLEM | Role.QUESTION)] = False,
    published: Annotated[bool, Option(role=Role.PROBLEM | Role.QUESTION)] = False,
    ties: Annotated[str, TIES] = "first",
    count: Annotated[str, COUNT] = "ingredients",
    depth_limit: Annotated[int | None, DEPTH] = None,
    jobs: Annotated[int, JOBS] = 1,
    results: Annotated[File | None, Option(kind=Kind.WRITTEN)] = None,
    **options: Unpack[CommonOptions],
) -> Compared:
    """Run searches for each goal of a problem by itself, and prove the optimum beside them.

    The limits are for each search and each optimum. Optima keep to constraints. Searches ignore them: for
    each tree that executes, the result lists the rules that the tree breaks.

    Parameters:
        searches: A search to run; by default all of them, including those of other packages. Without success
            rates, the default leaves greedy-success out.
        trees: Show the trees of the searches too, step by step.
        all_makeable: Compare for every object that can be made, and print a summary.
        published: Show the published figures beside the measured ones. If a goal has no such figures, they
            are left out. With ``published``, ``ids`` is run as published: it is the same as ``bfs``.
        results: A file to which results are added, as JSON Lines; goals that it already has are not searched
            again.

    Returns:
        The ``comparisons``, one for each goal, with figures for each search and the optimum.

    Raises:
        UserError: for a wrong argument, or a file of results that belongs to another question.

    Example:
        >>> compared = foon_asp.compare(foon_asp.load().problem("macaroni"), ["bfs"])
        >>> bfs = compared.comparisons[0].searches[0]
        >>> len(bfs.units), str(bfs.verdict)
        (10, 'executes in another order')
    """
    searches = tuple(searches)
    chosen = searches_named(searches)
    if problem.rates is None and not searches:
        chosen = usable_searches(rated=False)
        caller().reporter.warning("greedy-success is left out, and so is success: no success rates are known")
    each_limit = limits_of(options)
    settings = search_settings(ties, count, depth_limit, published, *each_limit)
    require_at_least(jobs, 1, "jobs")
    rules = settings_of(options)._replace(deadline=None)
    if rules.replaced is not None:
        raise UserError(f"{rules.replaced}: searches know nothing of other encodings: leave them out")
    problem = problem_for_rules(problem, rules)
    assemble(rules, caller().reporter.warning, problem=problem)  # what is wrong with files is said at once
    if all_makeable or results is not None:  # results are kept with a digest of all the data
        problem = problem.whole
    if all_makeable:
        problem = replace(problem, goals=tuple(makeable(problem)))
        if not problem.goals:
            raise UserError("there are no goals: nothing can be made that is not in the kitchen")
    is_single_search = len(problem.goals) == len(chosen) == 1
    if caller().form == "foon" and not is_single_search:
        raise UserError(_ONE_TREE)
    table = read_published(published_file()) if published else None
    if table is not None and not table.goals.keys() >= {node.label for node in problem.goal_nodes}:
        table = None
    comparisons = list(_compare_each_goal(problem, chosen, settings, rules, jobs, results))
    search_of = {search.name: search for search in chosen}
    retrieved: list[Retrieved] = []
    if trees or is_single_search:
        for goal, row in zip(problem.goals, comparisons, strict=True):
            goal_problem = replace(problem, goals=(goal,))
            for result in row.searches:
                ids = problem.network.units_of_numbers(result.units or ())
                retrieved.append(
                    Retrieved.of(goal_problem, search_of[result.search], result.ending, ids, result.stuck_at)
                )
    if trees:
        steps = iter(retrieved)
        comparisons = [
            structs.replace(
                row,
                searches=tuple(structs.replace(result, tree=next(steps).units) for result in row.searches),
            )
            for row in comparisons
        ]
    return Compared(
        **question_fields(
            problem, dict.fromkeys(objective for row in comparisons for objective in row.optimum)
        ),
        comparisons=tuple(comparisons),
        published=table or UNSET,
    ).set_unserialized(retrieved=tuple(retrieved), summed_up=all_makeable)


def _compare_each_goal(
    problem: Problem,
    searches: Sequence[Search],
    settings: SearchSettings,
    rules: Settings,
    jobs: int,
    results: File | None,
) -> Iterator[Comparison]:
    """Return the comparison of each goal, in the order of the goals.

    Comparisons that the file of ``results`` has are not repeated. All others are added to the file. Progress
    and warnings are reported to the caller.
    """
    goals = {str(node): goal for node, goal in zip(problem.goal_nodes, problem.goals, strict=True)}
    with contextlib.ExitStack() as stack:
        done: dict[object, Comparison] = {}
        file = None
        if results is not None:
            file_question = comparisons_question(problem, searches, settings, rules)
            file = stack.enter_context(RowsFile(Path(results), COMPARISONS, file_question))
            done = file.done
            for text in file.duplicate_warnings:
                caller().reporter.warning(text)
        remaining = [goal for name, goal in goals.items() if name not in done]
        done_before = len(goals) - len(remaining)
        caller().reporter.step("comparing", done_before, len(goals))
        rows = compare_goals(problem, remaining, searches, settings, settings.time_limit, jobs, rules)
        for row_count, row in enumerate(rows, 1):
            if file is None:
                done[row.goal.node] = row
            else:
                file.add(row)
            caller().reporter.step("comparing", done_before + row_count, len(goals))
    return map(done.__getitem__, goals)
