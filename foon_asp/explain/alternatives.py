"""What else: all optimal trees, the next best, those that differ most, and what all have in common."""

from collections.abc import Sequence
from fractions import Fraction
from typing import NamedTuple

from foon_asp.asp import Reporter, Settings
from foon_asp.asp.facts import write_distances
from foon_asp.asp.own_encodings import question_encoding
from foon_asp.asp.program import CLINGO_OPTIONS
from foon_asp.asp.ranking import Ranked
from foon_asp.asp.search import run
from foon_asp.errors import BugError
from foon_asp.problem import Costs, Objective, Problem, levels, multiplies


class Tree(NamedTuple):
    """A tree by unit ids in an executable order, and what it costs."""

    units: tuple[int, ...]
    costs: Costs


class Alternatives(NamedTuple):
    """Trees in order of their costs, the optimal ones first; none holds another.

    ``complete`` says that no tree that was asked for is left out: where it is false, a limit came first, and
    before each of the last ``unproved`` trees others may come that were not found.
    ``wanted`` is how many trees were asked for, ``None`` where it was all that are optimal.
    """

    problem: Problem
    objectives: tuple[Objective, ...]
    trees: tuple[Tree, ...]
    complete: bool
    wanted: int | None = None
    unproved: int = 0

    @property
    def optimal(self) -> tuple[Tree, ...]:
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


def all_optimal(
    problem: Problem,
    objectives: Sequence[Objective],
    settings: Settings,
    most: int,
    reporter: Reporter | None = None,
) -> Alternatives:
    """Find every optimal tree, at most so many. Raises :class:`UserError` like :func:`foon_asp.asp.solve`."""
    return _ranked(problem, objectives, settings, most, Fraction(0), reporter)


def best_trees(
    problem: Problem,
    objectives: Sequence[Objective],
    settings: Settings,
    most: int,
    reporter: Reporter | None = None,
) -> Alternatives:
    """Find so many trees, the best there are; ``complete`` also where there are fewer."""
    return _ranked(problem, objectives, settings, most, None, reporter)._replace(wanted=most)


def most_different(
    problem: Problem,
    objectives: Sequence[Objective],
    settings: Settings,
    count: int,
    worse: Fraction,
    most: int,
    reporter: Reporter | None = None,
) -> Alternatives:
    """Choose so many trees that differ most, of all whose first objective is worse by no more than a part.

    ``worse`` is that part: 1/10 allows 11 units where 10 are best, and a success of 0.9 times the best. The
    two chosen trees that are most alike differ as much as can be (in how many units only one of them has).
    At most ``most`` trees are looked at; ``complete`` says that these were all, and that no choice among them
    is better.
    """
    settings = settings.limited()
    pool = _ranked(problem, objectives, settings, most, worse, reporter)._replace(wanted=count)
    if len(pool.trees) <= count:
        return pool
    ended = run(
        (question_encoding("most_different.lp"),),
        write_distances([tree.units for tree in pool.trees], count),
        CLINGO_OPTIONS,
        settings.begun,
        predicates=[("_chosen", 1)],
    )
    if ended.exhausted and not ended.atoms:
        raise BugError("no trees could be chosen")
    chosen = sorted(ended.atoms["_chosen"]) if ended.atoms else _far_apart(pool.trees, count)
    return pool._replace(
        trees=tuple(pool.trees[number] for number in chosen),
        complete=pool.complete and ended.exhausted,
        unproved=sum(number >= len(pool.trees) - pool.unproved for number in chosen),
    )


def _far_apart(trees: Sequence[Tree], count: int) -> list[int]:
    """Choose so many trees, one after the other, each as far from those before it as can be."""
    units = [frozenset(tree.units) for tree in trees]
    chosen = [0]
    while len(chosen) < count:
        left = (number for number in range(len(trees)) if number not in chosen)
        chosen.append(max(left, key=lambda n: min(len(units[n] ^ units[other]) for other in chosen)))
    return sorted(chosen)


def _ranked(
    problem: Problem,
    objectives: Sequence[Objective],
    settings: Settings,
    most: int,
    worse: Fraction | None,
    reporter: Reporter | None,
) -> Alternatives:
    """Take trees in order until there are so many, or one that is too dear; ``None`` is never too dear.

    With ``worse`` 0 only optimal trees are taken, by the whole list of objectives.
    """
    order = levels(tuple(objectives))
    ranked = Ranked(problem, objectives, settings, reporter)
    trees: list[Tree] = []
    complete = False
    for units, costs in ranked:
        if trees and worse is not None and _is_too_dear(costs, trees[0].costs, order, worse):
            complete = True
            break
        if len(trees) == most:
            complete = worse is None
            break
        trees.append(Tree(units, costs))
    else:
        complete = ranked.complete
    settled = len(trees)
    for units, costs in ranked.known:
        dear = trees and worse is not None and _is_too_dear(costs, trees[0].costs, order, worse)
        if not dear and len(trees) < most:
            trees.append(Tree(units, costs))
    unproved = len(trees) - settled
    if settled and worse == 0:  # what is as good as an optimal tree is optimal
        unproved = 0
    return Alternatives(problem, tuple(objectives), tuple(trees), complete, unproved=unproved)


def _is_too_dear(costs: Costs, best: Costs, order: tuple[Objective, ...], worse: Fraction) -> bool:
    if not worse:
        return costs.key(order) > best.key(order)
    ours, least = Fraction(costs.measure(order[0])), Fraction(best.measure(order[0]))
    return ours < least * (1 - worse) if multiplies(order[0]) else ours > least * (1 + worse)
