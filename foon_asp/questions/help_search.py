"""The best trees of which a person does at most 0, 1, 2, ... units."""

from collections.abc import Iterable, Mapping
from dataclasses import replace
from fractions import Fraction
from typing import NamedTuple

from foon_asp.asp import Outcome, Reporter, Settings, Status, solve
from foon_asp.asp.assisted import assistance_bounds, read_who_does_units, require_local
from foon_asp.asp.postconditions import Postconditions
from foon_asp.asp.ranking import Ranked
from foon_asp.problem import Objective, Problem, reach

_PROVED = frozenset({Status.OPTIMAL, Status.INFEASIBLE})
_SUCCESS = (Objective.SUCCESS,)
_BEST = (Objective.SUCCESS, Objective.UNITS)


class PricedHelp:
    """Lagrangian relaxation of the number of helped units: help for a unit costs a factor of success.

    At a price q, a helped unit counts with q times the person's rate. Let S be the optimal success at this
    price. Then a tree with help for M units has at most the success S / q^M. If the optimal tree at the price
    reaches this bound with help for M units, it is optimal for M. Ties are broken by fewest units.

    Otherwise, another price is tried. If no price closes the gap, trees are enumerated at the price with the
    least bound, in order of success. The enumeration ends when no later tree can be better.

    The prices tried are those at which help for another motion begins to pay. The logarithm of the bound is
    convex in the logarithm of the price. So the least bound is found where the bound first rises.
    """

    def __init__(
        self, problem: Problem, better: Mapping[str, Fraction], settings: Settings, reporter: Reporter
    ) -> None:
        """Prepare the prices; ``better`` has the person's rates of motions that the person does better."""
        self._problem, self._better, self._settings, self._reporter = problem, better, settings, reporter
        self._rates = problem.rates or {}
        # At this price, help for a motion begins to pay.
        self._break_even = {motion: self._rates[motion] / rate for motion, rate in better.items()}
        self._prices = sorted({*self._break_even.values(), Fraction(1)})
        self._outcomes: dict[Fraction, Outcome] = {}

    def best(self, max_helped: int) -> Outcome:
        """Return the best tree with help for at most ``max_helped`` units.

        At a limit, return the best tree found, which is not proved best.
        """
        bounds: dict[Fraction, Fraction] = {}
        for price in self._prices:
            outcome = self._optimum_at(price)
            if outcome.status is Status.INFEASIBLE:
                return outcome
            if outcome.status is not Status.OPTIMAL or outcome.units is None:
                return self._best_before_limit(max_helped)
            tree = self._with_help(max_helped, outcome.units)
            bounds[price] = Fraction(outcome.bounds[Objective.SUCCESS]) / price**max_helped
            if -_order_key(tree)[0] == bounds[price]:
                return _as_optimal(tree)
            if bounds[price] > min(bounds.values()):
                break
        return self._best_enumerated(max_helped, min(bounds, key=bounds.__getitem__))

    def best_with_any_help(self) -> Outcome:
        """Return the best tree with help for any number of its units.

        In the problem of the outcome, each motion has the greater rate of person and robot; the helped units
        are not marked.
        """
        return self._optimum_at(Fraction(1))

    def helped_units(self, max_helped: int, units: Iterable[int]) -> list[int]:
        """Return at most ``max_helped`` of the ``units``: those whose rates help raises most.

        Units that the person does not do better are left out. The unit with the greatest gain comes first.
        """
        motions = self._problem.network.motions
        by_gain = sorted((self._break_even[motions[u]], u) for u in units if motions[u] in self._break_even)
        return [unit for _, unit in by_gain[:max_helped]]

    def _best_enumerated(self, max_helped: int, price: Fraction) -> Outcome:
        """Enumerate trees by success at a price; return the best one with help for ``max_helped`` units.

        The enumeration ends where no later tree can be better. At a limit, return the result of
        :meth:`_best_before_limit`.
        """
        best: Outcome | None = None
        ranked = Ranked(self._problem_at(price), _SUCCESS, self._settings, Reporter())
        for units, costs in ranked:
            tree = self._with_help(max_helped, units)
            best = tree if best is None else min(best, tree, key=_order_key)
            if _order_key(best) <= (costs.key(_SUCCESS)[0] / price**max_helped, costs.units):
                return _as_optimal(best)
        if best is None or not ranked.complete:
            return self._best_before_limit(max_helped)
        return _as_optimal(best)

    def _best_before_limit(self, max_helped: int) -> Outcome:
        """Return the best of the trees found at all prices so far, with the least bound that is proved.

        Without a tree, return the first outcome with that bound.
        """
        outcomes = self._outcomes.values()
        trees = [
            self._with_help(max_helped, outcome.units) for outcome in outcomes if outcome.units is not None
        ]
        bounds = [
            Fraction(outcome.bounds[Objective.SUCCESS]) / price**max_helped
            for price, outcome in self._outcomes.items()
            if outcome.bounds
        ]
        best = min(trees, key=_order_key, default=next(iter(outcomes)))
        return best._replace(bounds={Objective.SUCCESS: min(bounds)} if bounds else {})

    def _with_help(self, max_helped: int, units: tuple[int, ...]) -> Outcome:
        """Return a feasible outcome for the tree of ``units``, with a person for :meth:`helped_units`."""
        motions = self._problem.network.motions
        own_rates = {unit: self._better[motions[unit]] for unit in self.helped_units(max_helped, units)}
        problem = replace(self._problem, own_rates=own_rates)
        return Outcome(problem, _SUCCESS, Status.FEASIBLE, units, problem.costs(units), {}, {})

    def _optimum_at(self, price: Fraction) -> Outcome:
        """Return the optimum at a price, solved once for each price.

        Only the first search reports to the reporter.
        """
        if price not in self._outcomes:
            reporter = (
                Reporter() if self._outcomes else self._reporter
            )  # later searches have other objectives or bounds
            self._outcomes[price] = solve(self._problem_at(price), _SUCCESS, self._settings, reporter)
        return self._outcomes[price]

    def _problem_at(self, price: Fraction) -> Problem:
        """Return the problem at a price of help.

        The rate of a motion is the robot's rate, or the person's rate times the price if that is greater.
        """
        rates = {m: max(rate, self._better.get(m, 0) * price) for m, rate in self._rates.items()}
        return replace(self._problem, rates=rates)


class CountedHelp:
    """A search for trees with limited help, over a network with a copy of each unit for the person.

    Only units that the person does better have a copy, and the number of copies in a tree is limited. This is
    for rules and encodings that look at who does a unit; :class:`PricedHelp` is for all others.
    """

    def __init__(
        self, problem: Problem, better: Mapping[str, Fraction], settings: Settings, reporter: Reporter
    ) -> None:
        """Add a copy of each unit that the person does better, with the person's rate from ``better``."""
        self._problem, self._settings, self._reporter = problem, settings, reporter
        network = problem.network
        units = [unit for unit in sorted(reach(problem).units) if network.motions[unit] in better]
        self._originals = dict(enumerate(units, len(network)))
        own_rates = {twin: better[network.motions[unit]] for twin, unit in self._originals.items()}
        self._twins = replace(problem, network=network.with_copies(units), own_rates=own_rates)

    def best(self, max_helped: int) -> Outcome:
        """Return the best tree with help for at most ``max_helped`` units; copies are turned into originals.

        Only the first search reports to the reporter.
        """
        unit_number = self._twins.network.unit_number
        twins = {unit_number(twin): unit_number(unit) for twin, unit in self._originals.items()}
        settings = self._settings._replace(bounded=assistance_bounds(twins, max_helped))
        outcome = solve(self._twins, _SUCCESS, settings, self._reporter)
        self._reporter = Reporter()  # later searches have other objectives or bounds
        if outcome.units is None:
            return outcome._replace(problem=self._problem)
        units = tuple(self._originals.get(unit, unit) for unit in outcome.units)
        own_rates = {
            self._originals[u]: self._twins.own_rates[u] for u in outcome.units if u in self._originals
        }
        problem = replace(self._problem, own_rates=own_rates)
        return outcome._replace(problem=problem, units=units, costs=problem.costs(units))

    def best_with_any_help(self) -> Outcome:
        """Return the best tree with help for any number of its units."""
        return self.best(len(self._originals))


class HelpedTrees(NamedTuple):
    """The best trees with help for at most 0, 1, 2, ... units.

    The problem of each outcome has the person's rates for the helped units. ``greatest`` is the best
    success with help for any number of units; ``None`` without a tree or at a limit. ``complete`` says that
    every row is proved and no row is missing.
    """

    rows: tuple[Outcome, ...]
    greatest: Fraction | None
    complete: bool


def helped_trees(
    problem: Problem,
    person: Mapping[str, Fraction] | None,
    settings: Settings,
    reporter: Reporter,
    max_helped: int | None,
    wanted: Fraction | None,
) -> HelpedTrees:
    """Find the best trees with help for 0, 1, 2, ... units.

    ``person`` has the person's rates by motion; ``None`` for a person who never fails. The person takes over
    only motions with a higher rate than the robot's. The last row is the first for which one of three
    conditions holds:

    - it has help for ``max_helped`` units; ``None`` for no such condition
    - the success of its tree is at least ``wanted``; ``None`` for no such condition
    - more help changes nothing

    At a limit or ctrl-C, the rows end early, and the last may be unproved. If no better tree was found for
    it, it repeats the tree of the row before. Before the first row, ctrl-C raises ``KeyboardInterrupt``.

    Raises :class:`UserError` for wrong rules, and for rules that look beyond the tree and at who does a unit.
    """
    better = {
        motion: rate
        for motion, robot in (problem.rates or {}).items()
        if (rate := Fraction(1) if person is None else person.get(motion, Fraction(0))) > robot
    }
    must_count = settings.replaced is not None
    if not must_count and read_who_does_units(settings.constraints):
        require_local(settings)
        must_count = True
    search = (CountedHelp if must_count else PricedHelp)(problem, better, settings, reporter)
    rows: list[Outcome] = []
    with_any_help: Outcome | None = None
    complete = False
    try:
        while not complete:
            row = search.best(len(rows))
            previous = rows[-1] if rows else row
            if row.status not in _PROVED and previous.units is not None:  # help never makes a tree worse
                row = min(row, previous._replace(status=Status.FEASIBLE, bounds=row.bounds), key=_order_key)
            _require_sound(len(rows), row, previous, settings)
            rows.append(row)
            if row.status not in _PROVED:
                break
            with_any_help = with_any_help or search.best_with_any_help()
            if with_any_help.status not in _PROVED:
                break
            reached = wanted is not None and -_order_key(row)[0] >= wanted
            # a requested number is always solved, since more help may need fewer units
            compared_length = 1 if max_helped is None else 2
            more_help_is_vain = (
                _order_key(row)[:compared_length] == _order_key(with_any_help)[:compared_length]
            )
            complete = (
                reached or more_help_is_vain or with_any_help.units is None or len(rows) - 1 == max_helped
            )
    except KeyboardInterrupt:
        if not rows:
            raise
    greatest_costs = with_any_help is not None and with_any_help.status in _PROVED and with_any_help.costs
    return HelpedTrees(tuple(rows), greatest_costs.success if greatest_costs else None, complete)


def _order_key(outcome: Outcome) -> tuple[int | Fraction, ...]:
    """Return a key by which the best outcome comes first: (-success, units), or (1,) without a tree."""
    return (1,) if outcome.costs is None else outcome.costs.key(_BEST)


def _as_optimal(tree: Outcome) -> Outcome:
    """Return the outcome of a tree as proved optimal, with its own measures as bounds."""
    assert tree.costs is not None
    return tree._replace(
        status=Status.OPTIMAL, bounds={objective: tree.costs.measure(objective) for objective in _BEST}
    )


def _require_sound(max_helped: int, row: Outcome, previous: Outcome, settings: Settings) -> None:
    """Raise :class:`BugError` if ``row`` has wrong claims, too much help, or is worse than with less help.

    ``max_helped`` is the greatest number of helped units, and ``previous`` the outcome with less help. An
    outcome without a tree is not checked.
    """
    if row.units is None:
        return
    postconditions = Postconditions(row.problem, _BEST, settings)
    helped = row.problem.own_rates.keys()
    postconditions.require(
        len(helped) <= max_helped and helped <= set(row.units),
        lambda: (
            f"the tree {row.units} with help for {max_helped} units at most has help for {sorted(helped)}"
        ),
    )
    postconditions.require_true_claims(row)
    postconditions.require_no_better(previous, row, f"with help for {max_helped} units")
