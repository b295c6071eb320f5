"""Other trees: all optimal ones, the next best, those that differ most, and what all have in common."""

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import NamedTuple

from foon_asp.asp import Settings
from foon_asp.asp.assembly import CLINGO_OPTIONS
from foon_asp.asp.ranked_plans import RankedPlans
from foon_asp.asp.ranking import Ranked
from foon_asp.asp.used_up import best_plans
from foon_asp.dataset.paths import File, Files
from foon_asp.deadline import Cancel
from foon_asp.document.json_document import costs_json, document, mention_json, nodes_json, steps_json
from foon_asp.encoding.facts import write_distances
from foon_asp.encoding.own_encodings import question_encoding
from foon_asp.encoding.search import run
from foon_asp.errors import BugError, UserError
from foon_asp.network import counted
from foon_asp.problem import Costs, Objective, Problem, levels, multiplies
from foon_asp.problem.progress import OnProgress
from foon_asp.questions.arguments import (
    Constants,
    Objectives,
    asked_with,
    at_least,
    chosen_objectives,
    settings,
)
from foon_asp.questions.caller import caller
from foon_asp.questions.contract import TABLES, Kind, Option, question
from foon_asp.questions.options import HOW, ITEMS, TREE
from foon_asp.questions.result import Ending, Result
from foon_asp.questions.tree import Tree
from foon_asp.report.answer import costs_text, goal_lines, missing, unit_lines
from foon_asp.report.drawing import Drawing
from foon_asp.report.notebook import page_bundle

_SHOWN = 20  # trees that are listed one by one for people
_PICTURES = 4  # that a notebook shows


class Alternative(NamedTuple):
    """A tree by unit ids in an order that executes, and what it costs."""

    units: tuple[int, ...]
    costs: Costs


class Parting(NamedTuple):
    """Where some trees part: an object node, by id, that they make in different ways.

    Each of ``ways`` has the units, by id, that make it and the places of the trees that make it so.
    """

    object: int
    ways: tuple[tuple[tuple[int, ...], tuple[int, ...]], ...]


@dataclass(frozen=True, repr=False)
class Alternatives(Result):
    """Trees in order of their costs, the optimal ones first; none contains all units of another.

    ``problem`` is the problem asked about, and ``objectives`` are those asked for. Each of ``trees`` has its
    ``units`` by id and its ``costs``; :attr:`task_trees` has the trees as values. ``complete`` tells whether
    all trees asked for were found. If not, a limit was reached, and unknown trees may come before each of
    the last ``unproved`` ones. ``wanted`` is the number of trees asked for, or ``None`` for all optimal
    ones; ``different`` says that they are those that differ most.

    Example:
        >>> found = foon_asp.alternatives(foon_asp.load().problem("ice"), best=2)
        >>> [len(tree.units) for tree in found.trees], found.complete
        ([2, 3], True)
    """

    problem: Problem
    objectives: tuple[Objective, ...]
    trees: tuple[Alternative, ...]
    complete: bool
    wanted: int | None = None
    unproved: int = 0
    different: bool = False

    @property
    def partings(self) -> tuple[Parting, ...]:
        """Where the trees part, from the goals backwards: first all of them, then each group by itself."""
        found: list[Parting] = []
        groups = [tuple(range(len(self.trees)))]
        while groups:
            group = groups.pop(0)
            parting = self._parting(group)
            if parting is not None:
                found.append(parting)
                groups += [trees for _, trees in parting.ways if len(trees) > 1]
        return tuple(found)

    def _parting(self, group: tuple[int, ...]) -> Parting | None:
        """Find the first object node behind the goals that some trees make in different ways."""
        problem = self.problem
        units = [frozenset(self.trees[place].units) for place in group]
        queue = list(problem.goals)
        for o in queue:  # grows on the way
            if o in problem.kitchen:
                continue
            makers = [unit for unit in problem.makers[o] if o not in problem.needs[unit]]  # not handed on
            ways: dict[tuple[int, ...], list[int]] = {}
            for place, tree in zip(group, units, strict=True):
                ways.setdefault(tuple(unit for unit in makers if unit in tree), []).append(place)
            if len(ways) > 1:
                return Parting(o, tuple((made, tuple(places)) for made, places in ways.items()))
            further = dict.fromkeys(need for made in ways for unit in made for need in problem.needs[unit])
            queue += [need for need in further if need not in queue]
        return None

    @property
    def task_trees(self) -> tuple[Tree, ...]:
        """The trees as values, in the same order."""
        return tuple(
            Tree.of(self.problem, tree.units, f"tree {number}: {costs_text(tree.costs, self.objectives)}")
            for number, tree in enumerate(self.trees, 1)
        )

    @property
    def optimal(self) -> tuple[Alternative, ...]:
        """The trees that are proved optimal: those as good as the first, if that one is."""
        if len(self.trees) == self.unproved:
            return ()
        order = levels(self.objectives)
        return tuple(t for t in self.trees if t.costs.key(order) == self.trees[0].costs.key(order))

    @property
    def in_every(self) -> frozenset[int]:
        """The units that all optimal trees shown have."""
        optimal = [frozenset(tree.units) for tree in self.optimal]
        return frozenset.intersection(*optimal) if optimal else frozenset()

    @property
    def in_some(self) -> frozenset[int]:
        """The units that some optimal tree shown has."""
        return frozenset(unit for tree in self.optimal for unit in tree.units)

    @property
    def ending(self) -> Ending:
        """Done when nothing is left out of what was asked for."""
        if not self.complete:
            return Ending.LIMIT
        return Ending.DONE if self.trees else Ending.NEGATIVE

    def text(self) -> str:
        """Say how many trees there are, what each costs, and in what it differs from the first.

        Where all optimal ones were asked for, also what they have in common.
        """
        lines = _optimal_lines(self) if self.wanted is None else _lines(self, self.wanted)
        return "\n".join([*goal_lines(self.problem), *lines]) + "\n"

    def json_dict(self) -> object:
        """Give the trees with what they cost, and the units that all optimal ones or some of them have."""
        number = self.problem.network.unit_number
        return document(
            "alternatives",
            self.problem,
            self.objectives,
            complete=self.complete,
            unproved=self.unproved,
            optimal=len(self.optimal),
            in_every_optimal=sorted(map(number, self.in_every)),
            in_some_optimal=sorted(map(number, self.in_some)),
            partings=[
                {
                    "object": nodes_json(self.problem.network, [parting.object])[0],
                    "ways": [
                        {
                            "made_by": [mention_json(self.problem.network, unit) for unit in made],
                            "trees": trees,
                        }
                        for made, trees in parting.ways
                    ],
                }
                for parting in self.partings
            ],
            trees=[
                {"costs": costs_json(tree.costs), "units": steps_json(self.problem, tree.units)}
                for tree in self.trees
            ],
        )

    def drawing(self) -> Drawing | None:
        """Give what the picture of the first tree shows."""
        return self.task_trees[0].drawing() if self.trees else None

    def _in_notebook(self) -> dict[str, str]:
        """Give what a notebook shows by media type: the text, and the pictures of the first trees."""
        return page_bundle(self, (tree.drawing() for tree in self.task_trees[:_PICTURES]))


@question(
    *TREE,
    *ITEMS,
    Option("best", "Find this many of the best trees, in order.", Kind.WHOLE, metavar="K", least=1),
    Option(
        "different",
        "Find this many trees that differ most from each other.",
        Kind.WHOLE,
        metavar="K",
        least=2,
    ),
    Option(
        "within",
        "Among different trees, how much worse by the first objective a tree may be, in percent.",
        Kind.WHOLE,
        default=0,
        metavar="PERCENT",
        least=0,
    ),
    Option(
        "limit", "The greatest number of trees to look at.", Kind.WHOLE, default=100, metavar="N", least=1
    ),
    *HOW,
    formats=TABLES,
    help_="""
    \b
    foon-asp alternatives --goal macaroni             every optimal tree, and what all of them have
    foon-asp alternatives --goal macaroni --best 5
    foon-asp alternatives --goal macaroni --different 3 --within 20

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
    best: int | None = None,
    different: int | None = None,
    within: int = 0,
    limit: int = 100,
    constraints: Files = (),
    constants: Constants | None = None,
    encodings: File | None = None,
    time_limit: float | None = None,
    memory_limit: int | str | None = None,
    on_progress: OnProgress | None = None,
    cancel: Cancel | None = None,
) -> Alternatives:
    """Find all optimal trees, the best few, or those that differ most from each other.

    Trees that differ most are chosen so that the two most alike differ in as many units as possible. The
    limits are for the whole question.

    Parameters:
        best: The number of best trees to find, in order.
        different: The number of trees to choose that differ most.
        within: How much worse by the first objective a tree may be among ``different`` ones, in percent: 10
            allows 11 units if 10 are best, or 0.9 times the best success.

    Returns:
        The ``trees``; ``complete`` tells whether they are all that were asked for, proved.

    Raises:
        UserError: for a wrong argument or constraint, or if both ``best`` and ``different`` are given.

    Example:
        >>> found = foon_asp.alternatives(foon_asp.load().problem("macaroni"), best=3)
        >>> [tree.costs.units for tree in found.trees]
        [9, 10, 10]
    """
    if best is not None and different is not None:
        raise UserError("best and different exclude each other; give one of them")
    if within and different is None:
        raise UserError("within is only for different trees: give different, too")
    worse = Fraction(at_least(within, 0, "within"), 100)
    at_least(limit, 1, "limit")
    chosen = chosen_objectives(problem, objectives)
    how = settings(constraints, constants, encodings, time_limit, memory_limit)
    problem = asked_with(problem, how)
    if best is not None:
        return replace(_ranked(problem, chosen, how, at_least(best, 1, "best"), None), wanted=best)
    if different is not None:
        at_least(different, 2, "different")
        return _most_different(_ranked(problem, chosen, how, limit, worse), different, how)
    return _ranked(problem, chosen, how, limit, Fraction(0))


def _most_different(pool: Alternatives, count: int, how: Settings) -> Alternatives:
    """Choose ``count`` trees of a pool that differ most."""
    pool = replace(pool, wanted=count, different=True)
    if len(pool.trees) <= count:
        return pool
    ended = run(
        (question_encoding("most_different.lp"),),
        write_distances(list(map(_executions, pool.trees)), count),
        CLINGO_OPTIONS,
        how.begun,
        predicates=[("_chosen", 1)],
    )
    if ended.exhausted and not ended.atoms:
        raise BugError("no trees could be chosen")
    chosen = sorted(ended.atoms["_chosen"]) if ended.atoms else _far_apart(pool.trees, count)
    return replace(
        pool,
        trees=tuple(pool.trees[number] for number in chosen),
        complete=pool.complete and ended.exhausted,
        unproved=sum(number >= len(pool.trees) - pool.unproved for number in chosen),
    )


def _executions(tree: Alternative) -> frozenset[tuple[int, int]]:
    """Give each execution of a tree or plan: the unit, and which time it is."""
    seen = Counter[int]()
    found = set[tuple[int, int]]()
    for unit in tree.units:
        seen[unit] += 1
        found.add((unit, seen[unit]))
    return frozenset(found)


def _far_apart(trees: Sequence[Alternative], count: int) -> list[int]:
    """Choose ``count`` trees one by one, each as different as possible from those before it."""
    units = list(map(_executions, trees))
    chosen = [0]
    while len(chosen) < count:
        left = (number for number in range(len(trees)) if number not in chosen)
        chosen.append(max(left, key=lambda n: min(len(units[n] ^ units[other]) for other in chosen)))
    return sorted(chosen)


def _ranked(
    problem: Problem,
    objectives: tuple[Objective, ...],
    how: Settings,
    most: int,
    worse: Fraction | None,
) -> Alternatives:
    """Take trees in order until there are ``most``, or until one is worse by more than ``worse``.

    ``None`` allows any tree. With ``worse`` 0 only optimal trees are taken, by the whole list of objectives.
    """
    if problem.items is not None and worse == 0:
        plans, proved, complete = best_plans(problem, objectives, how, caller().reporter, most)
        given = tuple(Alternative(plan, costs) for plan, costs in plans)
        return Alternatives(problem, objectives, given, complete, unproved=0 if proved else len(given))
    order = levels(objectives)
    one_by_one = Ranked if problem.items is None else RankedPlans
    ranked = one_by_one(problem, objectives, how, caller().reporter)
    trees: list[Alternative] = []
    complete = False
    for units, costs in ranked:
        if trees and worse is not None and _is_too_dear(costs, trees[0].costs, order, worse):
            complete = True
            break
        if len(trees) == most:
            complete = worse is None
            break
        trees.append(Alternative(units, costs))
    else:
        complete = ranked.complete
    settled = len(trees)
    for units, costs in ranked.known:
        dear = trees and worse is not None and _is_too_dear(costs, trees[0].costs, order, worse)
        if not dear and len(trees) < most:
            trees.append(Alternative(units, costs))
    unproved = len(trees) - settled
    if settled and worse == 0:  # what is as good as an optimal tree is optimal
        unproved = 0
    return Alternatives(problem, objectives, tuple(trees), complete, unproved=unproved)


def _is_too_dear(costs: Costs, best: Costs, order: tuple[Objective, ...], worse: Fraction) -> bool:
    if not worse:
        return costs.key(order) > best.key(order)
    ours, least = Fraction(costs.measure(order[0])), Fraction(best.measure(order[0]))
    return ours < least * (1 - worse) if multiplies(order[0]) else ours > least * (1 + worse)


def _lines(found: Alternatives, wanted: int) -> Iterator[str]:
    rule = found.problem.conditions
    if not found.trees:
        yield _no_tree(found)
        return
    if len(found.trees) < wanted and found.complete:
        be = "is" if len(found.trees) == 1 else "are"
        yield f"there {be} {counted(len(found.trees), 'tree')} and no more ({rule})"
    elif not found.complete:
        yield f"{counted(len(found.trees), 'tree')} of those found before a limit ({rule})"
        if found.unproved:
            yield f"other trees may come before the last {found.unproved} of them"
    else:
        yield f"{counted(len(found.trees), 'tree')} ({rule})"
    if found.different:
        yield from _parting_lines(found)
    yield from _trees(found)


def _optimal_lines(found: Alternatives) -> Iterator[str]:
    rule, best = found.problem.conditions, ", then ".join(found.objectives)
    if not found.trees:
        yield _no_tree(found)
        return
    costs = costs_text(found.trees[0].costs, found.objectives)
    number = len(found.trees)
    if number == found.unproved:
        yield f"feasible, not proved best by {best} ({rule}; stopped at a limit): {costs}"
    elif not found.complete:
        yield f"at least {counted(number, 'optimal tree')} by {best} ({rule}; stopped at a limit): {costs}"
    elif number == 1:
        yield f"the optimal tree by {best} is the only one: proved ({rule}): {costs}"
    else:
        yield f"{number} optimal trees by {best}, and no others: proved ({rule}): {costs}"
    if number > 1 and found.optimal:
        yield f"in every one{' found' * (not found.complete)}: {counted(len(found.in_every), 'unit')}"
        yield from unit_lines(found.problem.network, found.in_every)
    yield from _trees(found)


def _parting_lines(found: Alternatives) -> Iterator[str]:
    """Say where the trees part, and which go the same way."""
    network = found.problem.network
    for parting in found.partings:
        trees = sorted(place for _, places in parting.ways for place in places)
        who = "they part" if len(trees) == len(found.trees) else f"{_numbered(trees)} part"
        yield f"{who} at {network.objects[parting.object]}"
        for made, places in parting.ways:
            makers = " and ".join(f"{network.motions[unit]} [{network.sources[unit][0]}]" for unit in made)
            yield f"  {_numbered(places)}: {makers}"


def _numbered(places: Sequence[int]) -> str:
    return f"tree{'s' * (len(places) > 1)} {', '.join(str(place + 1) for place in places)}"


def _trees(found: Alternatives) -> Iterator[str]:
    """List the trees, each but the first by what it has instead."""
    first, network = found.trees[0], found.problem.network
    for number, tree in enumerate(found.trees[:_SHOWN], 1):
        yield f"tree {number}: {costs_text(tree.costs, found.objectives)}"
        if number == 1:
            yield from unit_lines(network, tree.units)
            continue
        yield from unit_lines(network, missing(first.units, tree.units), "-")
        yield from unit_lines(network, missing(tree.units, first.units), "+")
    if len(found.trees) > _SHOWN:
        yield f"... and {counted(len(found.trees) - _SHOWN, 'more tree')}; --format json lists all"


def _no_tree(found: Alternatives) -> str:
    rule = found.problem.conditions
    if found.complete:
        return f"infeasible: proved that no task tree exists ({rule})"
    return f"unknown: stopped at a limit before any task tree was found ({rule})"
