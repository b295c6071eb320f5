"""The best tree for a question to a large store, of which no more is read than it takes to prove it."""

from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import TYPE_CHECKING

from foon_asp.asp import Outcome, Reporter, Settings, Status
from foon_asp.asp.assembly import hold_for_parts, leave_unsettled, program_of
from foon_asp.asp.optimum import solve
from foon_asp.asp.postconditions import Postconditions
from foon_asp.deadline import Deadline
from foon_asp.problem import Costs, Objective, Problem, executable_order, follow, levels, multiplies, reach
from foon_asp.reduce import ALL

if TYPE_CHECKING:  # plain answers do not need it
    from foon_asp.dataset.nearby import Nearby


def near_goals(problem: Problem, objectives: Sequence[Objective], how: Settings) -> "Nearby | None":
    """Return what is near the goals of a large store, where an answer may not need the whole."""
    near: Callable[[], Nearby | None] | None = getattr(problem, "near", None)
    if near is None or how.reductions != ALL or how.clingo_options:
        return None
    only_units_add = all(each in Objective and not each.row.item for each in objectives)
    return near() if only_units_add and hold_for_parts(how) else None


def solve_nearby(
    near: "Nearby", objectives: Sequence[Objective], how: Settings, reporter: Reporter | None = None
) -> Outcome | None:
    """Solve a question to a large store, of which no more is read than it takes to prove the answer.

    What units that were not read may make is taken to be at hand. If the best tree takes nothing of that, it
    is a tree of the whole network, and none there costs less; else more is read of what leads to what it
    takes. In the end everything is read. Rules of the user's have to hold for parts of trees; what the best
    tree without them takes is read before they are asked about, and then more each time: first what the tree
    of the fewest units takes that keeps to them. ``None`` where there is no tree even so, and rules are not
    all that there is to it: why is then a question about all that could lead to the goals.
    """
    reporter = reporter or Reporter()
    if how.constraints:
        program_of(near.problem, how, reporter.warning)  # whose names may be beyond what is read here
    deadline = how.begun
    alone = how._replace(deadline=deadline)
    free = alone._replace(constraints=(), constants=())
    first = levels(tuple(objectives))[0]
    tighter = min if multiplies(first) else max
    known: list[int | Fraction] = []  # bounds on the first objective
    mattered = set[int]()  # units, by number, that say what keeps to the rules
    few: list[int] | None = None  # a tree that keeps to them, by number, once it was asked for
    without: Outcome | None = None
    if leave_unsettled(how):  # the best tree without them is needed anyway, and quick to read
        without = solve_nearby(near, objectives, free, _OnlyWarnings(reporter))
        if without is None:
            return None
        known += [bound for each, bound in without.bounds.items() if each == first]
    while True:
        problem = near.problem
        found = solve(near.relaxed, objectives, alone, _OnlyWarnings(reporter), mattered)
        if found.status is Status.INFEASIBLE:
            rules_alone = without is not None or (bool(how.constraints) and _leads(near, deadline))
            return found._replace(problem=near.problem) if rules_alone else None
        known += [bound for each, bound in found.bounds.items() if each == first]
        lacking = [] if found.units is None else near.lacking(found.units)
        if lacking and found.status is Status.OPTIMAL:
            try:
                with deadline.watched("reading"):  # and not late, so that there is time for a tree
                    near.grow(lacking, quickly=without is not None)
            except KeyboardInterrupt:
                deadline.interrupt()
                found = found._replace(proof=None, stopped=deadline.stopped)
            else:
                if without is not None and few is None:
                    few = [] if first is Objective.UNITS else _fewest(near, alone, mattered)
                continue
        bounds = {**found.bounds, first: tighter(known)} if known else found.bounds
        found = found._replace(problem=problem, bounds=bounds)
        if lacking:  # at a limit: the bound holds, and what was read may have a tree of its own
            tree = solve(problem, objectives, alone, _OnlyWarnings(Reporter()))
            status = Status.UNKNOWN if tree.units is None else Status.FEASIBLE
            found = found._replace(status=status, units=tree.units, costs=tree.costs)
        if found.status is Status.UNKNOWN and few:
            units = [unit for number in few if (unit := problem.network.unit_of_number(number)) is not None]
            found = found._replace(
                status=Status.FEASIBLE, units=executable_order(problem, units), costs=problem.costs(units)
            )
        if found.units is not None:
            holds = Postconditions(problem, levels(tuple(objectives)), how)
            found = found._replace(units=holds.tree(found.units))
            assert found.costs is not None
            reporter.tree(found.costs)
        return found


def _leads(near: "Nearby", deadline: Deadline) -> bool:
    """Whether there is a tree without rules, or at a limit, whether there may be one."""
    while True:
        relaxed = near.relaxed
        found = reach(relaxed)
        tree = follow(relaxed.goals, found.makers, relaxed.needs, relaxed.kitchen)
        if tree is None:
            return False
        lacking = near.lacking(unit for unit in found.units if unit in tree)
        if not lacking:
            return True
        try:
            with deadline.watched("reading"):
                near.grow(lacking, quickly=True)
        except KeyboardInterrupt:
            deadline.interrupt()
            return True


def _fewest(near: "Nearby", how: Settings, mattered: set[int]) -> list[int]:
    """Read what the tree of the fewest units takes that keeps to the rules.

    That is asked sooner than by other objectives, tells as well where there is none, and what better trees
    take is mostly near that. Gives it by number; nothing where there is none, or at a limit.
    """
    while True:
        found = solve(near.relaxed, (Objective.UNITS,), how, mattered=mattered)
        if found.status is not Status.OPTIMAL or found.units is None:
            return []
        lacking = near.lacking(found.units)
        if not lacking:
            return [*map(near.problem.network.unit_number, found.units)]
        try:
            with how.begun.watched("reading"):
                near.grow(lacking, quickly=True)
        except KeyboardInterrupt:
            how.begun.interrupt()
            return []


def least_with_more(costs: Costs, order: Sequence[Objective], units: int = 1) -> tuple[int | Fraction, ...]:
    """Return the key that no tree is better than which has more units than one that costs this or more."""
    least = dict(zip(order, costs.key(order), strict=True))
    least[Objective.UNITS] += units
    return tuple(least.values())


class _OnlyWarnings(Reporter):
    """Passes on what is true of the whole network when a part of it is asked about."""

    def __init__(self, reporter: Reporter) -> None:
        self.warning = reporter.warning  # type: ignore[method-assign]
        self.bound = reporter.bound  # type: ignore[method-assign]
