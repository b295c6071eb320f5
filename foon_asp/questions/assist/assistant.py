"""The best trees when a person does up to 0, 1, 2, ... of the units, one after the other."""

from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction
from functools import cached_property
from itertools import count
from typing import NamedTuple

from foon_asp.asp import Outcome, Reporter, Settings, Status, solve
from foon_asp.asp.assisted import assisted, require_near, sees_who_does_it
from foon_asp.asp.postconditions import Postconditions
from foon_asp.asp.ranking import Ranked
from foon_asp.problem import Costs, Objective, Problem, reach, relevant
from foon_asp.questions.assist.priced_help import PricedHelp

_SUCCESS = (Objective.SUCCESS,)
_TREES = 200  # that are looked at one by one before units are counted


class Assisted(NamedTuple):
    """The best tree of which a person does at most ``most`` units.

    ``units`` are unit ids in an order that executes, ``helped`` those that the person does, and ``costs``
    what the tree costs, the person's rates included; without a tree they are ``None``, empty and ``None``.
    ``bound`` is what no such tree succeeds more often than, as far as it is proved.
    """

    most: int
    status: Status
    units: tuple[int, ...] | None
    helped: frozenset[int]
    costs: Costs | None
    bound: Fraction | None

    @property
    def success(self) -> Fraction | None:
        """The product of the rates of those who do the units; ``None`` without a tree."""
        return None if self.costs is None else self.costs.success

    def reaches(self, wanted: Fraction) -> bool:
        """Whether the tree succeeds as often as is wanted."""
        return self.success is not None and self.success >= wanted


class Rows(NamedTuple):
    """The rows that were asked for, as far as they were found.

    ``greatest`` is the best success with any number of units done by the person, ``None`` where there is no
    tree at all and where a limit came first. ``complete`` says that every row is proved and none is left out.
    """

    rows: tuple[Assisted, ...]
    greatest: Fraction | None
    complete: bool


class Assistant:
    """A problem, and what the person does better than the robot.

    Where nothing looks at who does a unit, :class:`PricedHelp` answers for each number of units. Where a
    constraint does, and where too many trees are nearly as good, units that the person does better are there
    twice, and the person's are counted.
    """

    def __init__(
        self,
        problem: Problem,
        person: Mapping[str, Fraction] | None,
        settings: Settings,
        reporter: Reporter,
    ) -> None:
        """Take rates, those of the person too where there are any, and settings whose deadline has begun."""
        self._problem = problem
        self._settings, self._reporter = settings, reporter
        self._first = True
        self._better: dict[str, Fraction] = {}
        for motion, robot in (problem.rates or {}).items():
            rate = Fraction(1) if person is None else person.get(motion, Fraction(0))
            if rate > robot:
                self._better[motion] = rate
        self._own = not settings.constraints and settings.replaced is None
        self._priced: PricedHelp | None = None
        if settings.replaced is None and not sees_who_does_it(settings.constraints):
            self._priced = PricedHelp(problem, self._better, self._unbounded, self._ranked)
        elif settings.replaced is None:
            require_near(settings)
        self._twins: Problem | None = None

    def rows(self, most: int | None, wanted: Fraction | None) -> Rows:
        """Solve the question for one number of units after another.

        They end with ``most``, with the first that succeeds as often as ``wanted``, or where more help
        changes nothing. Raises :class:`UserError` like :func:`foon_asp.asp.solve`.
        """
        rows: list[Assisted] = []
        last: Outcome | None = None  # with any number of units done by the person

        def found(complete: bool) -> Rows:
            greatest = None if last is None or last.costs is None else last.costs.success
            return Rows(tuple(rows), greatest, complete)

        for number in count():
            try:
                row = self._row(number)
                if rows:
                    row = _beside(row, rows[-1], last)
                self._check(row, rows[-1] if rows else None)
                rows.append(row)
                if row.status in {Status.FEASIBLE, Status.UNKNOWN}:
                    return found(complete=False)
                if last is None:
                    best = self._unlimited()
                    if best.status in {Status.FEASIBLE, Status.UNKNOWN}:
                        return found(complete=False)
                    last = best
            except KeyboardInterrupt:
                if not rows:
                    raise
                return found(complete=False)
            if wanted is not None and row.reaches(wanted):
                break
            if last.costs is None or number == most:
                break
            # a number that is asked for is answered, since with more help fewer units may do
            if row.success == last.costs.success and (most is None or _key(row.costs) == _key(last.costs)):
                break
        return found(complete=True)

    def _check(self, row: Assisted, before: Assisted | None) -> None:
        """Require that the person does few enough units, that the costs say so, and that help never hurts."""
        if row.units is None or row.costs is None:
            return
        holds = Postconditions(
            self._problem, (Objective.SUCCESS, Objective.UNITS), self._settings, own=self._own
        )
        holds.tree(row.units)
        motions = self._problem.network.motions
        own = {unit: self._better.get(motions[unit], Fraction(0)) for unit in row.helped}
        costs = replace(self._problem, own_rates=own).costs(row.units)
        holds.require(
            len(row.helped) <= row.most and row.helped <= set(row.units) and _key(costs) == _key(row.costs),
            lambda: (
                f"the tree {list(row.units or ())} with help for {sorted(row.helped)} is said to have "
                f"{_key(row.costs)} with help for {row.most} at most, but has {_key(costs)}"
            ),
        )
        holds.require(
            row.bound is None or costs.success is None or row.bound >= costs.success,
            lambda: f"the tree {list(row.units or ())} succeeds more often than its bound allows",
        )
        holds.require(
            before is None or before.costs is None or _key(costs) <= _key(before.costs),
            lambda: f"with help for {row.most} units the best tree is worse than with less",
        )

    def _row(self, most: int) -> Assisted:
        priced = self._priced
        if priced is None:
            return self._outcome_row(most, self._counted(most))
        if most == 0:
            return self._outcome_row(most, self._unbounded(self._problem))
        found = priced.best(most, _TREES if self._own else None)
        if found is not None:
            return self._priced_row(most, Status.OPTIMAL, found)
        if self._own and not priced.stopped:
            row = self._outcome_row(most, self._counted(most))
        else:
            row = Assisted(most, Status.UNKNOWN, None, frozenset(), None, None)
        if row.status is Status.OPTIMAL:
            return row
        known = priced.good(most)
        if known is not None:
            other = self._priced_row(most, Status.FEASIBLE, known)
            row = other if row.costs is None or _key(other.costs) < _key(row.costs) else row
        bounds = [bound for bound in (row.bound, priced.bound(most)) if bound is not None]
        return row._replace(bound=min(bounds, default=None))

    def _priced_row(self, most: int, status: Status, units: tuple[int, ...]) -> Assisted:
        assert self._priced is not None
        costs = self._priced.costs(units, most)
        bound = costs.success if status is Status.OPTIMAL else None
        return Assisted(most, status, units, self._priced.helped(units, most), costs, bound)

    def _outcome_row(self, most: int, outcome: Outcome) -> Assisted:
        bound = outcome.bounds.get(Objective.SUCCESS)
        units = outcome.units
        return Assisted(
            most,
            outcome.status,
            None if units is None else tuple(map(self._original, units)),
            frozenset(self._original(u) for u in units or () if u >= len(self._problem.network)),
            outcome.costs,
            None if bound is None else Fraction(bound),
        )

    def _unlimited(self) -> Outcome:
        """Solve with any number of units done by the person: then all that he or she is better at are."""
        if self._priced is None:
            return self._counted(len(self._originals))
        return self._unbounded(replace(self._problem, rates={**(self._problem.rates or {}), **self._better}))

    def _counted(self, most: int) -> Outcome:
        network = self._problem.network
        if self._twins is None:
            copies = network.with_copies(self._originals)
            own = {len(network) + k: self._better[network.motions[u]] for k, u in enumerate(self._originals)}
            self._twins = replace(self._problem, network=copies, own_rates=own)
        number = self._twins.network.unit_number
        bounded = assisted(
            {number(twin): number(self._original(twin)) for twin in self._twins.own_rates}, most
        )
        others = self._settings.bounded
        if others is not None:
            bounded = bounded._replace(
                rules=others.rules + bounded.rules, files=(*others.files, *bounded.files), below=others.below
            )
        return solve(self._twins, _SUCCESS, self._settings._replace(bounded=bounded), self._heard())

    @cached_property
    def _originals(self) -> list[int]:
        """The units that are there twice where those of the person are counted."""
        problem = self._problem
        reached = reach(problem)
        units = relevant(problem, reached) if self._own else sorted(reached.units)
        return [unit for unit in units if problem.network.motions[unit] in self._better]

    def _original(self, unit: int) -> int:
        here = len(self._problem.network)
        return unit if unit < here else self._originals[unit - here]

    def _unbounded(self, problem: Problem) -> Outcome:
        return solve(problem, _SUCCESS, self._settings, self._heard())

    def _ranked(self, problem: Problem) -> Ranked:
        return Ranked(problem, _SUCCESS, self._settings, self._heard())

    def _heard(self) -> Reporter:
        """Give the reporter to the first search: what it warns of all do, and others ask another thing."""
        reporter = self._reporter if self._first else Reporter()
        self._first = False
        return reporter


def _beside(row: Assisted, before: Assisted, unlimited: Outcome | None) -> Assisted:
    """Put into a row what is known from the one before and from the best with any number of units.

    A tree with less help is one with more, and the one to keep where it is as good.
    """
    if before.costs is not None and (row.costs is None or _key(before.costs) <= _key(row.costs)):
        status = row.status if row.status is Status.OPTIMAL else Status.FEASIBLE
        row = before._replace(most=row.most, status=status, bound=row.bound)
    if unlimited is not None and unlimited.costs is not None and row.status is not Status.INFEASIBLE:
        bounds = [bound for bound in (row.bound, unlimited.costs.success) if bound is not None]
        row = row._replace(bound=min(bounds))
    return row


def _key(costs: Costs | None) -> tuple[int | Fraction, ...]:
    return () if costs is None else costs.key((Objective.SUCCESS, Objective.UNITS))
