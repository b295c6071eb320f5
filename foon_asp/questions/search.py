"""The tree that a search returns, a published one or one of another package, and whether it executes."""

from collections.abc import Iterator
from dataclasses import replace
from typing import Annotated, Any, Self, Unpack

from msgspec import field

from foon_asp.comparison.comparison import simulate_retrieval
from foon_asp.json_layout import schema_name
from foon_asp.pictures.drawing import Drawing
from foon_asp.problem import Costs, Problem
from foon_asp.proof.simulation import Simulation, Verdict
from foon_asp.questions.ending import Ending
from foon_asp.questions.python_options import Posed, start_deadline
from foon_asp.questions.question import question
from foon_asp.questions.result import Result
from foon_asp.questions.search_options import COUNT, DEPTH, TIES, search_settings, searches_named
from foon_asp.questions.tree import Tree
from foon_asp.questions.used_up_note import used_up_note
from foon_asp.questions.verdict import Stop, simulation_fields, verdict_lines
from foon_asp.results.document import AboutGoals, Unserialized
from foon_asp.results.figure_text import costs_text
from foon_asp.results.table import Block
from foon_asp.results.values import Node, Step, UsedUpRun
from foon_asp.results.values_of import node_of, question_fields, steps_of
from foon_asp.searches import Ending as Searched
from foon_asp.searches import Search
from foon_asp.text.writer import write_units

_NO_TREE: Any = dict.fromkeys(("verdict", "as_listed", "in_any_order", "order", "used_up"))


class Retrieved(Result, AboutGoals, frozen=True, kw_only=True, tag=schema_name("search")):
    """The tree that a search returned for a problem.

    Attributes:
        search: The name of the search.
        package: The package that offers the search; null for a built-in search.
        ended: How the search ended: with a tree, stuck at an object that cannot be had, with the proof that
            no tree executes, or at a limit.
        stuck_at: The object that cannot be had, if the search was stuck; else null.
        verdict: Whether the tree executes; null without a tree.
        as_listed: What stops the tree in the order listed, if anything.
        in_any_order: What stops every order, if anything.
        order: Positions of steps, from 1, in an order in which they run. If the tree does not execute, steps
            may be missing. Null without a tree.
        used_up: Whether the tree, each step done once, runs where items are used up; null without a tree, and
            where items are used up anyway.
        costs: What the tree costs by every objective; null without a tree.
        units: The steps of the tree in the order listed; null without a tree.

    Example:
        >>> found = foon_asp.search(foon_asp.load().problem("ice"), "ids")
        >>> found.executes, found.costs.units, found.units[1].motion
        (True, 2, 'crush')
    """

    ROWS = "units"

    search: str
    package: str | None
    ended: Searched = field(name="ending")
    stuck_at: Node | None
    verdict: Verdict | None
    as_listed: Stop | None
    in_any_order: Stop | None
    order: tuple[int, ...] | None
    used_up: UsedUpRun | None
    costs: Costs | None
    units: tuple[Step, ...] | None

    @classmethod
    def of(
        cls, problem: Problem, search: Search, ended: Searched, ids: tuple[int, ...], stuck_at: Node | None
    ) -> Self:
        """Return the result of a search, with its tree simulated.

        Parameters:
            problem: The problem.
            search: The search.
            ended: How the search ended.
            ids: The units of its tree, by id in the network of the problem; empty without a tree.
            stuck_at: The object that cannot be had, if the search was stuck.
        """
        tree = Tree.of(problem, ids) if ended is Searched.TREE else None
        simulation = None if tree is None else simulate_retrieval(problem, ids, tree)
        retrieved = cls(
            **question_fields(problem),
            search=search.name,
            package=search.package,
            ended=ended,
            stuck_at=stuck_at,
            **(_NO_TREE if tree is None or simulation is None else simulation_fields(tree, simulation)),
            costs=None if tree is None else problem.costs(ids),
            units=None if tree is None else steps_of(problem, ids),
        )
        return retrieved.set_unserialized(
            problem=problem, ids=ids, promise=search.promise, tree=tree, simulation=simulation
        )

    problem = Unserialized[Problem]()
    """The problem that was asked about."""

    ids = Unserialized[tuple[int, ...]]()
    """The units of the tree by id in the network of the problem, as listed; none without a tree."""

    promise = Unserialized[str]()
    """What the search promises of its trees."""

    tree = Unserialized[Tree | None]()
    """The tree in the order listed; ``None`` without a tree."""

    simulation = Unserialized[Simulation | None]()
    """What the simulation of the tree found; ``None`` without a tree."""

    @property
    def executes(self) -> bool:
        """Whether there is a tree that executes, as listed or in another order."""
        return self.verdict in {Verdict.AS_LISTED, Verdict.REORDERED}

    @property
    def ending(self) -> Ending:
        """``DONE`` if the tree executes, ``LIMIT`` if a limit stopped the search, else ``NEGATIVE``."""
        if self.ended is Searched.UNKNOWN:
            return Ending.LIMIT
        return Ending.DONE if self.executes else Ending.NEGATIVE

    def show(self) -> Iterator[Block]:
        """Yield what the search guarantees of its trees, whether this tree executes, and the steps as listed.

        Without a tree, a line says why no tree was found.
        """
        yield from (*self.goal_lines(), f"{self.search} promises {self.promise}")
        if self.tree is None or self.simulation is None or self.units is None:
            yield self._no_tree_text()
            return
        yield from (*verdict_lines(self.tree, self.simulation), "")
        yield from (line for step in self.units for line in step.lines())

    def foon(self) -> str:
        """Return the tree as FOON text, in the order listed; a comment says whether it executes.

        Without a tree, the text is one comment that says why.
        """
        if self.costs is None:
            return f"# {self.search}: {self._no_tree_text()}\n"
        comments = [
            f"Task tree for: {' + '.join(map(str, self.goals))}",
            f"{self.search} ({self.problem.conditions}): {self.verdict}, {costs_text(self.costs)}",
        ]
        units = self.problem.tree(self.ids)
        comments += used_up_note(self.problem, units) if self.executes else []
        return write_units(units, comments, self.problem.amounts)

    def drawing(self) -> Drawing | None:
        """Return the drawing of the tree; ``None`` without a tree."""
        return None if self.tree is None else self.tree.drawing()

    def __repr__(self) -> str:
        return f"<Retrieved: {self.search}, {self.verdict or self.ended}>"

    def _no_tree_text(self) -> str:
        """Return one line on why there is no tree."""
        if self.ended is Searched.STUCK:
            return f"no tree: no unit makes {self.stuck_at}, and it is not in the kitchen"
        if self.ended is Searched.NONE and self.package is not None:
            return f"no tree: {self.package} says that none executes, which is not checked"
        if self.ended is Searched.NONE:
            return "no tree: none executes, at any depth"
        return "unknown: stopped at a limit before a tree was found"


@question(help_="In a command: foon-asp compare --search NAME --trees.", used_up=True)
def search(
    problem: Problem,
    search: str,
    *,
    ties: Annotated[str, TIES] = "first",
    count: Annotated[str, COUNT] = "ingredients",
    depth_limit: Annotated[int | None, DEPTH] = None,
    published: bool = False,
    **options: Unpack[Posed],
) -> Retrieved:
    """Retrieve a task tree with a published search, and find out whether it executes.

    ``bfs``, ``dfs``, ``greedy-success`` and ``greedy-inputs`` choose one unit for each object, and do not
    backtrack. ``ids`` backtracks: it returns a tree of least depth that executes, or says that none does. All
    searches run as if items last. Where items are used up, the tree executes if it runs as a plan in some
    order.

    Parameters:
        search: ``bfs``, ``dfs``, ``ids``, ``greedy-success``, ``greedy-inputs``, or the name of a search
            that another package offers, which runs in a process of its own.
        published: Whether to run ``ids`` as published: it does not backtrack, and is the same as ``bfs``.

    Returns:
        The ``units`` of the tree, its ``costs``, and the ``verdict`` that says whether it executes.

    Raises:
        UserError: for a wrong argument, or if a search of another package fails or returns no valid tree.

    Example:
        >>> foon_asp.search(foon_asp.load().problem("macaroni"), "bfs")
        <Retrieved: bfs, executes in another order>
    """
    (chosen_search,) = searches_named([search])
    deadline = start_deadline(options)
    settings = search_settings(
        ties, count, depth_limit, published, deadline.remaining_seconds, deadline.memory
    )
    outcome = chosen_search.run(replace(problem, items=None), settings)
    stuck_at = None if outcome.stuck_at is None else node_of(problem.network, outcome.stuck_at)
    return Retrieved.of(problem, chosen_search, outcome.ending, outcome.units, stuck_at)
