"""Other trees: all optimal ones, the next best or those that differ most, and what they have in common."""

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from typing import Annotated, NamedTuple, Unpack

from foon_asp.asp import Settings
from foon_asp.asp.assembly import CLINGO_OPTIONS
from foon_asp.asp.ranking import Ranked
from foon_asp.encoding.clingo_run import run
from foon_asp.encoding.fact_writer import write_distances
from foon_asp.encoding.own_encodings import question_encoding
from foon_asp.errors import BugError, UserError
from foon_asp.json_layout import schema_name
from foon_asp.network import counted
from foon_asp.pictures.drawing import Drawing
from foon_asp.pictures.notebook import page_bundle
from foon_asp.plans.ranked_plans import RankedPlans, best_plans
from foon_asp.problem import Costs, Objective, Problem, levels, multiplies
from foon_asp.questions.caller import caller
from foon_asp.questions.ending import Ending
from foon_asp.questions.options import AMOUNT, ITEMS, TREE
from foon_asp.questions.python_arguments import (
    Objectives,
    chosen_objectives,
    problem_for_rules,
    require_at_least,
)
from foon_asp.questions.python_options import CommonOptions, settings_of
from foon_asp.questions.question import TABLES, Kind, Option, question
from foon_asp.questions.result import Result
from foon_asp.questions.tree import Tree
from foon_asp.questions.used_up_note import used_up_note
from foon_asp.results.document import AboutGoals, Unserialized
from foon_asp.results.figure_text import costs_text
from foon_asp.results.table import Block
from foon_asp.results.values import CostedTree, Mention, Node, Value, step_lines, steps_not_in
from foon_asp.results.values_of import costed_tree, mention_of, node_of, question_fields


class Way(Value, frozen=True):
    """One way to make an object node.

    Attributes:
        made_by: The units that make it.
        trees: The indices of the trees that make it so, from 0.
    """

    made_by: tuple[Mention, ...]
    trees: tuple[int, ...]


class Parting(Value, frozen=True):
    """An object node that trees make in different ways."""

    object: Node
    ways: tuple[Way, ...]


class Alternatives(Result, AboutGoals, frozen=True, kw_only=True, tag=schema_name("alternatives")):
    """Trees for the goals of a problem, the best first; no tree contains all units of another.

    Attributes:
        complete: Whether every tree that was asked for is listed. If not, a limit was reached.
        unproved: How many of the last trees are not proved to be the next ones: others may come before them.
        optimal: How many trees are proved optimal; they are the first ones.
        in_every_optimal: The ids of the units that all optimal trees have.
        in_some_optimal: The ids of the units that some optimal tree has.
        partings: The object nodes where trees part, from the goals backwards. After the first node, each
            group of trees that make it in one way has its own next node.
        trees: The trees, in order of their costs.

    Example:
        >>> found = foon_asp.alternatives(foon_asp.load().problem("ice"), best=2)
        >>> [tree.costs.units for tree in found.trees], found.complete, found.optimal
        ([2, 3], True, 1)
        >>> found.task_trees[0]
        <Tree for ice; crushed; in [drinking glass]: 2 units>
    """

    ROWS = "trees"

    complete: bool
    unproved: int
    optimal: int
    in_every_optimal: tuple[int, ...]
    in_some_optimal: tuple[int, ...]
    partings: tuple[Parting, ...]
    trees: tuple[CostedTree, ...]

    problem = Unserialized[Problem]()
    """The problem that was asked about."""

    @property
    def task_trees(self) -> tuple[Tree, ...]:
        """The trees as :class:`Tree` values for other questions, in the order of ``trees``."""
        claims = (
            f"tree {number}: {costs_text(tree.costs, self.objectives)}"
            for number, tree in enumerate(self.trees, 1)
        )
        ids = (self.problem.network.units_of_numbers(tree.ids) for tree in self.trees)
        return tuple(Tree.of(self.problem, *ids_and_claim) for ids_and_claim in zip(ids, claims, strict=True))

    @property
    def ending(self) -> Ending:
        """``LIMIT`` if a requested tree may be missing, ``NEGATIVE`` if no tree exists, else ``DONE``."""
        if not self.complete:
            return Ending.LIMIT
        return Ending.DONE if self.trees else Ending.NEGATIVE

    def show(self) -> Iterator[Block]:
        """Yield the goals, what is proved, and up to 20 trees with their costs.

        The first tree is shown with all its steps, each other one by its differences from the first.
        """
        yield from self.goal_lines()
        yield from self._claim_lines()
        max_shown = 20
        for number, (tree, task_tree) in enumerate(
            zip(self.trees[:max_shown], self.task_trees, strict=False), 1
        ):
            yield task_tree.claim
            yield from used_up_note(self.problem, task_tree)
            if number == 1:
                yield from step_lines(tree.units)
                continue
            yield from step_lines(steps_not_in(self.trees[0].units, tree.units), "-")
            yield from step_lines(steps_not_in(tree.units, self.trees[0].units), "+")
        if len(self.trees) > max_shown:
            others = counted(len(self.trees) - max_shown, "more tree")
            yield f"... and {others}; --format json lists all"

    def _claim_lines(self) -> Iterator[str]:
        """Yield lines that say how many trees there are, and what of that is proved.

        For trees that differ most, they also say where the trees part.
        """
        conditions, tree_count = self.conditions, len(self.trees)
        if not self.trees and self.complete:
            yield f"infeasible: proved that no task tree exists ({conditions})"
        elif not self.trees:
            yield f"unknown: stopped at a limit before any task tree was found ({conditions})"
        elif self.wanted is None:
            yield from self._optimal_claim_lines()
        elif tree_count < self.wanted and self.complete:
            be = "is" if tree_count == 1 else "are"
            yield f"there {be} {counted(tree_count, 'tree')} and no more ({conditions})"
        elif not self.complete:
            yield f"{counted(tree_count, 'tree')} of those found before a limit ({conditions})"
            if self.unproved:
                yield f"other trees may come before the last {self.unproved} of them"
        else:
            yield f"{counted(tree_count, 'tree')} ({conditions})"
        if self.different and self.trees:
            yield from self._parting_lines()

    def _optimal_claim_lines(self) -> Iterator[str]:
        """Yield lines on optimal trees: their number, whether it is proved, and the steps in all of them."""
        conditions, by, tree_count = self.conditions, ", then ".join(self.objectives), len(self.trees)
        costs = costs_text(self.trees[0].costs, self.objectives)
        if tree_count == self.unproved:
            yield f"feasible, not proved best by {by} ({conditions}; stopped at a limit): {costs}"
        elif not self.complete:
            optimal_trees = counted(tree_count, "optimal tree")
            yield f"at least {optimal_trees} by {by} ({conditions}; stopped at a limit): {costs}"
        elif tree_count == 1:
            yield f"the optimal tree by {by} is the only one: proved ({conditions}): {costs}"
        else:
            yield f"{tree_count} optimal trees by {by}, and no others: proved ({conditions}): {costs}"
        if tree_count > 1 and self.optimal:
            common_units = set(self.in_every_optimal)
            yield f"in every one{' found' * (not self.complete)}: {counted(len(common_units), 'unit')}"
            step_of = {step.id: step for step in self.trees[0].units if step.id in common_units}
            yield from step_lines(step_of[unit] for unit in self.in_every_optimal)

    def _parting_lines(self) -> Iterator[str]:
        """Yield lines on each object node that trees make in different ways, with the trees of each way."""
        for parting in self.partings:
            trees = sorted(index for way in parting.ways for index in way.trees)
            subject = "they part" if len(trees) == len(self.trees) else f"{_tree_numbers(trees)} part"
            yield f"{subject} at {parting.object}"
            for way in parting.ways:
                makers = " and ".join(f"{unit.motion} [{unit.source[0]}]" for unit in way.made_by)
                yield f"  {_tree_numbers(way.trees)}: {makers}"

    wanted = Unserialized[int | None]()
    """The number of trees asked for; ``None`` for all optimal ones."""

    different = Unserialized[bool]()
    """Whether the trees are those that differ most."""

    def drawing(self) -> Drawing | None:
        """Return the drawing of the first tree; ``None`` without a tree."""
        return self.task_trees[0].drawing() if self.trees else None

    def _in_notebook(self) -> dict[str, str]:
        """Return the notebook display by media type: the text, and pictures of the first four trees."""
        return page_bundle(self, (tree.drawing() for tree in self.task_trees[:4]))


class _CostedIds(NamedTuple):
    """A tree with its costs: ``units`` are the ids of its units in an order that executes."""

    units: tuple[int, ...]
    costs: Costs


class _Pool(NamedTuple):
    """Trees in order of their costs.

    ``complete``: whether all trees that were asked for are among them.
    ``unproved``: how many of the last trees are not proved to be the next ones.
    """

    trees: tuple[_CostedIds, ...]
    complete: bool
    unproved: int


def alternatives_or_union(
    problem: Problem,
    objectives: Objectives = "units",
    *,
    union: bool = False,
    best: int | None = None,
    different: int | None = None,
    within: int = 0,
    limit: int = 100,
    **options: Unpack[CommonOptions],
) -> Result:
    """Return the result of :func:`alternatives`, or with ``union`` the units that optimal trees have.

    The union has the units that every optimal tree has and the units that some optimal tree has. With
    ``union``, ``limit`` has no effect. Raises :class:`UserError` for ``union`` with ``best`` or
    ``different``.
    """
    if not union:
        return alternatives(
            problem, objectives, best=best, different=different, within=within, limit=limit, **options
        )
    from foon_asp.questions.unit_union import unit_union  # noqa: PLC0415

    if best is not None or different is not None:
        raise UserError("--union lists units of all trees: leave out --best and --different")
    return unit_union(problem, objectives, within=within, **options)


@question(
    *TREE,
    *ITEMS,
    AMOUNT,
    Option(
        "union",
        "List the units of every optimal tree, and of some, proved without a list of the trees.",
        Kind.FLAG,
        default=False,
    ),
    formats=TABLES,
    command=alternatives_or_union,
    help_="""
    \b
    foon-asp alternatives --goal macaroni             every optimal tree, and what all of them have
    foon-asp alternatives --goal macaroni --best 5
    foon-asp alternatives --goal macaroni --different 3 --within 20
    foon-asp alternatives --goal macaroni --union     units of all optimal trees, and of some
    foon-asp alternatives --goal macaroni --union --within 10

    A tree that contains all units of another listed tree is not listed. Trees are
    found one by one in order of their costs, which are compared exactly. With --items used-up, plans differ
    by how often they execute units, and none does all that another one does, as often.

    Exits with 0 when all trees that were asked for are listed, 1 when there is no tree, 3 when a limit
    came first.
    """,
)
def alternatives(
    problem: Problem,
    objectives: Objectives = "units",
    *,
    best: Annotated[int | None, Option(metavar="K", least=1)] = None,
    different: Annotated[int | None, Option(metavar="K", least=2)] = None,
    within: Annotated[int, Option(metavar="PERCENT", least=0)] = 0,
    limit: Annotated[int, Option(metavar="N", least=1)] = 100,
    **options: Unpack[CommonOptions],
) -> Alternatives:
    """Find all optimal trees, the best few, or those that differ most from each other.

    Trees that differ most are chosen so that the two most alike differ in as many units as possible. The
    limits are for the whole question.

    Parameters:
        best: Find this many of the best trees, in order.
        different: Find this many trees that differ most from each other.
        within: Among ``different`` trees (and with ``--union``), how much worse by the first objective a tree
            may be, in percent. 10 allows 11 units if 10 are best, or 0.9 times the best success.
        limit: The greatest number of trees to look at. It has no effect on ``best``.

    Returns:
        The ``trees``; ``complete`` tells whether they are all that were asked for, proved.

    Raises:
        UserError: for a wrong argument or constraint, for ``best`` with ``different``, and for ``within``
            without ``different``.

    Example:
        >>> found = foon_asp.alternatives(foon_asp.load().problem("macaroni"), best=3)
        >>> [tree.costs.units for tree in found.trees]
        [9, 10, 10]
    """
    if best is not None and different is not None:
        raise UserError("best and different exclude each other; give one of them")
    if within and different is None:
        raise UserError("within is only for different trees: give different, too")
    max_loss = Fraction(require_at_least(within, 0, "within"), 100)
    require_at_least(limit, 1, "limit")
    chosen, settings = chosen_objectives(problem, objectives), settings_of(options)
    problem = problem_for_rules(problem, settings)
    if best is not None:
        pool = _rank_trees(problem, chosen, settings, require_at_least(best, 1, "best"), None)
    elif different is not None:
        require_at_least(different, 2, "different")
        pool = _most_different(_rank_trees(problem, chosen, settings, limit, max_loss), different, settings)
    else:
        pool = _rank_trees(problem, chosen, settings, limit, Fraction(0))
    result = _alternatives_of(problem, chosen, pool)
    return result.set_unserialized(problem=problem, wanted=best or different, different=different is not None)


def _alternatives_of(problem: Problem, objectives: tuple[Objective, ...], pool: _Pool) -> Alternatives:
    """Return the trees of a pool as a result, with units of all and of some optimal trees, and partings.

    The optimal trees are those with the costs of the first tree. If no tree of the pool is proved, no tree
    counts as optimal.
    """
    order, unit_number = levels(objectives), problem.network.unit_number
    proved = pool.trees if len(pool.trees) > pool.unproved else ()
    optimal = [
        frozenset(tree.units) for tree in proved if tree.costs.key(order) == proved[0].costs.key(order)
    ]
    return Alternatives(
        **question_fields(problem, objectives),
        complete=pool.complete,
        unproved=pool.unproved,
        optimal=len(optimal),
        in_every_optimal=tuple(sorted(map(unit_number, frozenset.intersection(*optimal) if optimal else ()))),
        in_some_optimal=tuple(sorted(map(unit_number, frozenset().union(*optimal)))),
        partings=tuple(_partings(problem, [frozenset(tree.units) for tree in pool.trees])),
        trees=tuple(costed_tree(problem, tree.units, tree.costs) for tree in pool.trees),
    )


def _partings(problem: Problem, trees: Sequence[frozenset[int]]) -> Iterator[Parting]:
    """Yield the object nodes where trees part, each with the ways in which the trees make it.

    The first is the node nearest to the goals that the trees make in different ways. Trees that make it in
    one way form a group. For each group, the node where its own trees part follows, and so on. If all trees
    make all nodes in the same way, nothing is yielded.
    """
    groups = [tuple(range(len(trees)))]
    for group in groups:  # grows during the loop
        parting = _first_parting(problem, {index: trees[index] for index in group})
        if parting is not None:
            o, ways = parting
            mentions = [tuple(mention_of(problem.network, unit) for unit in made_by) for made_by in ways]
            yield Parting(node_of(problem.network, o), tuple(map(Way, mentions, map(tuple, ways.values()))))
            groups += [tuple(indices) for indices in ways.values() if len(indices) > 1]


def _first_parting(
    problem: Problem, trees: Mapping[int, frozenset[int]]
) -> tuple[int, dict[tuple[int, ...], list[int]]] | None:
    """Return the first object node, from the goals backwards, that trees make in different ways.

    ``trees`` maps indices of trees to their units. The result is the id of the node, and a mapping. A key has
    the units by which some trees make the node; its value lists the indices of these trees. A unit that needs
    the node itself does not make it. Nodes of the kitchen are skipped. Return ``None`` if the trees make
    every node in the same way.
    """
    queue = list(problem.goals)
    for o in queue:  # grows during the loop
        if o in problem.kitchen:
            continue
        makers = [
            unit for unit in problem.makers[o] if o not in problem.needs[unit]
        ]  # without units that only hand the node on
        ways: dict[tuple[int, ...], list[int]] = {}
        for index, tree in trees.items():
            ways.setdefault(tuple(unit for unit in makers if unit in tree), []).append(index)
        if len(ways) > 1:
            return o, ways
        further = dict.fromkeys(need for made_by in ways for unit in made_by for need in problem.needs[unit])
        queue += [need for need in further if need not in queue]
    return None


def _most_different(pool: _Pool, count: int, settings: Settings) -> _Pool:
    """Return a pool of ``count`` trees of a pool, such that the most similar two differ as much as possible.

    This is max-min diversity, solved by clingo. A pool of at most ``count`` trees is returned as it is. At a
    limit, the best choice found is returned, or else a greedy one, and the pool is not complete. The trees
    keep their order.
    """
    if len(pool.trees) <= count:
        return pool
    clingo_run = run(
        (question_encoding("most_different.lp"),),
        write_distances(list(map(_executions, pool.trees)), count),
        CLINGO_OPTIONS,
        settings.effective_deadline,
        predicates=[("_chosen", 1)],
    )
    if clingo_run.exhausted and not clingo_run.atoms:
        raise BugError("no trees could be chosen")
    chosen = sorted(clingo_run.atoms["_chosen"]) if clingo_run.atoms else _choose_far_apart(pool.trees, count)
    return pool._replace(
        trees=tuple(pool.trees[index] for index in chosen),
        complete=pool.complete and clingo_run.exhausted,
        unproved=sum(index >= len(pool.trees) - pool.unproved for index in chosen),
    )


def _executions(tree: _CostedIds) -> frozenset[tuple[int, int]]:
    """Return the executions of a tree or plan; ``(5, 2)`` is the second execution of unit 5."""
    count_of = Counter[int]()
    executions = set[tuple[int, int]]()
    for unit in tree.units:
        count_of[unit] += 1
        executions.add((unit, count_of[unit]))
    return frozenset(executions)


def _choose_far_apart(trees: Sequence[_CostedIds], count: int) -> list[int]:
    """Choose ``count`` trees greedily: the first, then each time the tree farthest from those chosen before.

    This is farthest-point-first traversal. Return the indices of the trees in ascending order.
    """
    executions = list(map(_executions, trees))
    chosen = [0]
    while len(chosen) < count:
        remaining = (index for index in range(len(trees)) if index not in chosen)
        chosen.append(max(remaining, key=lambda i: min(len(executions[i] ^ executions[j]) for j in chosen)))
    return sorted(chosen)


def _rank_trees(
    problem: Problem,
    objectives: tuple[Objective, ...],
    settings: Settings,
    max_trees: int,
    max_loss: Fraction | None,
) -> _Pool:
    """Return a pool of at most ``max_trees`` trees, enumerated in order of costs.

    ``max_loss`` says how much worse than the best a tree may be by the first objective, as a share: a tenth
    allows 11 units if 10 are best. ``0`` allows only trees that are optimal by all objectives. ``None``
    allows all trees.

    The pool is complete if it has all allowed trees. For ``None``, ``max_trees`` trees are enough. After a
    limit, the last trees of the pool are not proved to be the next ones.
    """
    if problem.items is not None and max_loss == 0:
        plans, proved, complete = best_plans(problem, objectives, settings, caller().reporter, max_trees)
        ranked_plans = tuple(_CostedIds(plan, costs) for plan, costs in plans)
        return _Pool(ranked_plans, complete, 0 if proved else len(ranked_plans))
    order = levels(objectives)
    one_by_one = Ranked if problem.items is None else RankedPlans
    ranked = one_by_one(problem, objectives, settings, caller().reporter)
    trees: list[_CostedIds] = []
    complete = False
    for units, costs in ranked:
        if trees and max_loss is not None and _is_worse(costs, trees[0].costs, order, max_loss):
            complete = True
            break
        if len(trees) == max_trees:
            break
        trees.append(_CostedIds(units, costs))
        if max_loss is None and len(trees) == max_trees:  # no search for a tree that was not asked for
            complete = True
            break
    else:
        complete = ranked.complete
    proved_count = len(trees)
    for units, costs in ranked.pending:
        is_excluded = trees and max_loss is not None and _is_worse(costs, trees[0].costs, order, max_loss)
        if not is_excluded and len(trees) < max_trees:
            trees.append(_CostedIds(units, costs))
    unproved = len(trees) - proved_count
    if proved_count and max_loss == 0:  # a tree with the costs of an optimal tree is optimal
        unproved = 0
    return _Pool(tuple(trees), complete, unproved)


def _is_worse(costs: Costs, best: Costs, order: tuple[Objective, ...], max_loss: Fraction) -> bool:
    """Whether costs are worse than ``best`` by more than ``max_loss``.

    If ``max_loss`` is 0, all objectives in ``order`` are compared. Otherwise, only the first objective is
    compared, and ``max_loss`` is a share of its best value.
    """
    if not max_loss:
        return costs.key(order) > best.key(order)
    measure, best_measure = Fraction(costs.measure(order[0])), Fraction(best.measure(order[0]))
    if multiplies(order[0]):
        return measure < best_measure * (1 - max_loss)
    return measure > best_measure * (1 + max_loss)


def _tree_numbers(indices: Sequence[int]) -> str:
    """Return the numbers of trees in words: ``trees 1, 3`` for the indices 0 and 2, ``tree 1`` for 0."""
    return f"tree{'s' * (len(indices) > 1)} {', '.join(str(index + 1) for index in indices)}"
