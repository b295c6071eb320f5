"""The tree that a search returns, one of the literature or of another package, and whether it executes."""

from dataclasses import dataclass, replace

from foon_asp.compare.comparison import simulated
from foon_asp.deadline import Cancel
from foon_asp.document.json_document import costs_json, document, nodes_json, steps_json
from foon_asp.problem import Costs, Problem
from foon_asp.problem.progress import OnProgress
from foon_asp.proof.simulation import Simulation, Verdict
from foon_asp.questions.arguments import begin
from foon_asp.questions.contract import TABLES, Kind, Option, question
from foon_asp.questions.options import CONTAINERS, GOALS, ITEMS, LIMITS
from foon_asp.questions.result import Ending, Result
from foon_asp.questions.searching import SEARCHING, search_settings, searched
from foon_asp.questions.tree import Tree
from foon_asp.report.answer import costs_text, goal_lines, steps
from foon_asp.report.drawing import Drawing
from foon_asp.report.verdict import Listed, verdict_json, verdict_text
from foon_asp.search import Ending as Searched
from foon_asp.search import Retrieval, Search, search_names
from foon_asp.text.writer import write_units


@dataclass(frozen=True, repr=False)
class Retrieved(Result):
    """What a search returned for a problem.

    ``search`` is the search and ``problem`` the problem; ``retrieval`` has the ``ending``, and the ``units``
    by id as listed. ``simulation`` tells whether the tree executes and what stops it; it is ``None`` without
    a tree.

    Example:
        >>> found = foon_asp.retrieve(foon_asp.load().problem("ice"), "ids")
        >>> found.executes, found.costs.units
        (True, 2)
    """

    problem: Problem
    search: Search
    retrieval: Retrieval
    simulation: Simulation | None

    @property
    def tree(self) -> Tree | None:
        """The tree in the order listed, ``None`` where the search has none."""
        return None if self.simulation is None else Tree.of(self.problem, self.retrieval.units)

    @property
    def executes(self) -> bool:
        """Whether there is a tree that executes, as listed or in another order."""
        return self.simulation is not None and self.simulation.verdict is not Verdict.NEVER

    @property
    def costs(self) -> Costs | None:
        """What the tree costs, ``None`` without a tree."""
        return None if self.simulation is None else self.problem.costs(self.retrieval.units)

    @property
    def ending(self) -> Ending:
        """Done when the tree executes."""
        if self.retrieval.ending is Searched.UNKNOWN:
            return Ending.LIMIT
        return Ending.DONE if self.executes else Ending.NEGATIVE

    def text(self) -> str:
        """Say what the search promises, whether its tree executes, and list the tree as it was returned."""
        lines = [*goal_lines(self.problem), f"{self.search.name} promises {self.search.promise}"]
        if self.simulation is None:
            return "\n".join([*lines, self._without()]) + "\n"
        lines.append(verdict_text(self.problem, self._listed(), self.simulation).rstrip("\n"))
        return "\n".join([*lines, "", *steps(self.problem, self.retrieval.units)]) + "\n"

    def json_dict(self) -> object:
        """Give the same; positions count from 1."""
        problem, found, simulation = self.problem, self.retrieval, self.simulation
        stuck = () if found.stuck_at is None else (found.stuck_at,)
        return document(
            "search",
            problem,
            search=self.search.name,
            package=self.search.package,
            ending=str(found.ending),
            stuck_at=next(iter(nodes_json(problem.network, stuck)), None),
            **verdict_json(problem, self._listed(), simulation),
            costs=costs_json(self.costs),
            units=None if simulation is None else steps_json(problem, found.units),
        )

    def foon(self) -> str:
        """Give the tree as FOON text, in the order listed; a comment says whether it executes."""
        if self.simulation is None or self.costs is None:
            return f"# {self.search.name}: {self._without()}\n"
        comments = [
            f"Task tree for: {' + '.join(map(str, self.problem.goal_nodes))}",
            f"{self.search.name} ({self.problem.conditions}): {self.simulation.verdict}, "
            f"{costs_text(self.costs)}",
        ]
        return write_units(map(self.problem.network.unit, self.retrieval.units), comments)

    def drawing(self) -> Drawing | None:
        """Give what the picture shows."""
        return None if self.tree is None else self.tree.drawing()

    def __repr__(self) -> str:
        ended = self.retrieval.ending if self.simulation is None else self.simulation.verdict
        return f"<Retrieved: {self.search.name}, {ended}>"

    def _listed(self) -> Listed:
        network = self.problem.network
        return [(network.unit(unit), network.sources[unit][0]) for unit in self.retrieval.units]

    def _without(self) -> str:
        """Say why there is no tree."""
        found = self.retrieval
        if found.ending is Searched.STUCK and found.stuck_at is not None:
            stuck = self.problem.network.objects[found.stuck_at]
            return f"no tree: no unit makes {stuck}, and it is not in the kitchen"
        if found.ending is Searched.NONE and self.search.package is not None:
            return f"no tree: {self.search.package} says that none executes, which is not checked"
        if found.ending is Searched.NONE:
            return "no tree: none executes, at any depth"
        return "unknown: stopped at a limit before a tree was found"


@question(
    Option("search", "The search to run.", positional=True, choices=search_names),
    GOALS,
    *SEARCHING,
    Option(
        "published",
        "Run ids as published: it takes the first unit everywhere, as bfs does.",
        Kind.FLAG,
        default=False,
    ),
    CONTAINERS,
    *ITEMS,
    *LIMITS,
    help_="""
    \b
    foon-asp search bfs --goal 'greek salad'
    foon-asp search ids --goal macaroni --containers implied

    bfs, dfs, greedy-success and greedy-inputs choose one unit for each object and never look back; ids
    backtracks, and returns a tree of least depth that executes or says that none does. Other packages may
    bring searches: docs/entry-points.md. They know nothing of items that are used up (--items used-up):
    their tree then executes if it runs as a plan, in some order.

    Exits with 0 when the tree executes, as listed or in another order; 1 when it never does or there is
    none; 3 when stopped at a limit.
    """,
    formats=(*TABLES, "foon"),
)
def retrieve(
    problem: Problem,
    search: str,
    *,
    ties: str = "first",
    count: str = "ingredients",
    depth_limit: int | None = None,
    published: bool = False,
    time_limit: float | None = None,
    memory_limit: int | str | None = None,
    on_progress: OnProgress | None = None,
    cancel: Cancel | None = None,
) -> Retrieved:
    """Retrieve a task tree with a search of the literature, and find out whether it executes.

    Parameters:
        search: ``bfs``, ``dfs``, ``ids``, ``greedy-success``, ``greedy-inputs``, or the name of a search
            that another package offers, which runs in a process of its own.

    Returns:
        The tree, its ``costs``, and the ``simulation`` that says whether it executes.

    Raises:
        UserError: for a wrong argument, or if a search of another package fails or returns no valid tree.

    Example:
        >>> foon_asp.retrieve(foon_asp.load().problem("macaroni"), "bfs")
        <Retrieved: bfs, executes in another order>
    """
    (wanted,) = searched([search])
    deadline = begin(time_limit, memory_limit)
    how = search_settings(ties, count, depth_limit, published, deadline.left, deadline.memory)
    found = wanted.run(replace(problem, items=None), how)
    simulation = None
    if found.ending is Searched.TREE:
        simulation = simulated(problem, found.units, problem.tree(found.units))
    return Retrieved(problem, wanted, found, simulation)
