"""How wrong success rates may be: the interval of each in which the best tree stays the best."""

import math
import textwrap
from collections import Counter
from collections.abc import Collection, Iterable, Iterator
from dataclasses import dataclass, replace
from decimal import Context, Decimal
from fractions import Fraction
from typing import NamedTuple

from foon_asp.asp import Outcome, Reporter, Settings, Status, solve
from foon_asp.asp.assembly import assemble
from foon_asp.asp.postconditions import Postconditions
from foon_asp.dataset.paths import File, Files
from foon_asp.errors import UserError
from foon_asp.problem import Costs, Objective, Problem, Root, levels, reach, relevant, success_rate
from foon_asp.questions.answer import Answer
from foon_asp.questions.arguments import Constants, asked_with, settings
from foon_asp.questions.caller import caller
from foon_asp.questions.contract import question
from foon_asp.questions.options import CONTAINERS, GOALS, LIMITS, RULES
from foon_asp.questions.result import Ending, Result
from foon_asp.report.answer import changes_text, counted, goal_lines, headline, success_text
from foon_asp.report.drawing import Drawing
from foon_asp.report.json_document import costs_json, document, fraction_json, steps_json
from foon_asp.text.json_value import Json

_SUCCESS = (Objective.SUCCESS,)
_TINY = Fraction(1, 10**9)  # at which part of its rate a motion is as good as forbidden, mostly
_HALF = Fraction(1, 2)
_DIGITS = 4  # of an end in words, at least
_PERCENT_DIGITS = 3
_WIDTH = 60  # columns


class End(NamedTuple):
    """How far a rate may go to one side, and what is the best tree beyond.

    ``at`` is where another tree is as good, and beyond it better: ``beyond``, its units by id in an order
    that executes. Both are ``None`` where no rate on that side makes another tree better. ``proved`` says
    that this is the end; where it is false a limit came first, and the end may be nearer to the rate.
    """

    at: Root | None
    beyond: tuple[int, ...] | None
    proved: bool = True


class Interval(NamedTuple):
    """The rates of one motion at which the tree stays optimal, while all other rates are what they are.

    ``rate`` is the one that is given, and ``units`` says how many units of the tree have it. The interval
    goes from ``below.at``, or from 0, which is not in it, to ``above.at``, or to 1.
    """

    motion: str
    rate: Fraction
    units: int
    below: End
    above: End

    @property
    def proved(self) -> bool:
        """Whether both ends are proved."""
        return self.below.proved and self.above.proved

    @property
    def flips(self) -> tuple["Flip", ...]:
        """The ends beyond which another tree is the best, the nearer one first."""
        sides = ((self.below, False), (self.above, True))
        return tuple(sorted(Flip(self, end, above) for end, above in sides if end.at is not None))


class Flip(NamedTuple):
    """An end beyond which another tree is the best: flips are in order of relative change of the rate."""

    interval: Interval
    end: End
    above: bool

    @property
    def at(self) -> Root:
        """The rate at which it is."""
        assert self.end.at is not None
        return self.end.at

    @property
    def inwards(self) -> Fraction:
        """The rate at which it is, rounded to a decimal within the interval."""
        rate, digits = self.interval.rate, _DIGITS
        if self.at.rational == rate:
            return rate
        while True:
            rounded = self.at.below(digits) if self.above else self.at.above(digits)
            if rounded >= rate if self.above else rounded <= rate:
                return rounded
            digits += 1

    def change(self, digits: int) -> tuple[Fraction, Fraction]:
        """Give two numbers between which the relative change of the rate is, by the digits that count.

        They are one number where that is rational.
        """
        factor = self.at.over(self.interval.rate)
        exact = factor.rational
        low, high = (factor.below(digits), factor.above(digits)) if exact is None else (exact, exact)
        return (low - 1, high - 1) if self.above else (1 - high, 1 - low)

    def __lt__(self, other: object) -> bool:
        """Compare relative changes exactly, by as many digits as it takes.

        Changes that are equal and not rational are on one side, and factors of the rate that are equal: were
        the factors on two sides, they would add up to 2. But positive roots none of which is a rational
        multiple of another are linearly independent over the rational numbers (Besicovitch, 1940).
        """
        assert isinstance(other, Flip)
        if self.at.over(self.interval.rate) == other.at.over(other.interval.rate):
            return False  # on one side, or both at the rate itself
        digits = _DIGITS
        while True:
            (low, high), (others_low, others_high) = self.change(digits), other.change(digits)
            if high < others_low or others_high <= low:
                return high < others_low
            digits *= 2


@dataclass(frozen=True, repr=False)
class Sensitivity(Result):
    """The tree that is the best by ``success``, and how wrong each rate may be, by itself, so that it stays.

    ``intervals`` has one for each motion that a tree for the goals may have, in order of the relative change
    that makes another tree the best, the smallest first; those that never do come last. ``others`` are the
    motions of the network that no such tree has: their rates change nothing. Both are empty where there is
    no tree, or where it was not proved to be the best.
    """

    outcome: Answer
    intervals: tuple[Interval, ...]
    others: tuple[str, ...]

    @property
    def first(self) -> Flip | None:
        """Where the smallest relative change of one rate makes another tree the best; ``None`` where none."""
        return min((flip for interval in self.intervals for flip in interval.flips), default=None)

    @property
    def ending(self) -> Ending:
        """Done when every end is proved."""
        proved = all(interval.proved for interval in self.intervals)
        return self.outcome.ending if proved else Ending.LIMIT

    def text(self) -> str:
        """Give the motions whose rates can make another tree the best, then those whose rates cannot."""
        return "\n".join([*goal_lines(self.outcome.problem), headline(self.outcome), *_lines(self)]) + "\n"

    def json_dict(self) -> Json:
        """Give the answer and the intervals, with the trees beyond their ends."""
        best, first = self.outcome, self.first
        side = first and {"motion": first.interval.motion, "side": "above" if first.above else "below"}
        return document(
            "sensitivity",
            best.problem,
            best.objectives,
            answer=best.json_dict(),
            intervals=[_interval_json(best, interval) for interval in self.intervals],
            others=list(self.others),
            first=side,
        )

    def drawing(self) -> Drawing | None:
        """Give what the picture of the best tree shows."""
        return self.outcome.drawing()


@question(
    GOALS,
    CONTAINERS,
    *RULES,
    *LIMITS,
    help_="""
    \b
    foon-asp sensitivity --goal macaroni
    foon-asp sensitivity --goal macaroni --constraint forbid_motion -c forbidden_motion=tilt

    The best tree is that by success. Each rate varies by itself; the one that needs to change least,
    relatively, to make another tree the best comes first. Ends are exact, and in words rounded inwards.

    Exits with 0 when every end is proved, 1 when there is no tree at all, 3 when a limit came first.
    """,
)
def sensitivity(
    problem: Problem,
    *,
    constraints: Files = (),
    constants: Constants | None = None,
    encodings: File | None = None,
    time_limit: float | None = None,
    memory_limit: int | str | None = None,
) -> Sensitivity:
    """Find for each motion the interval of its success rate in which the best tree by ``success`` stays it.

    Constraints that look at success rates see those that are given, whatever rate is asked about. The limits
    are for all of it. Otherwise as :func:`foon_asp.solve`.
    """
    problem.require_known_for(_SUCCESS)
    for motion in sorted(set(problem.network.motions)):
        success_rate((problem.rates or {})[motion], f"the success rate of {motion!r}")
    for rate in problem.own_rates.values():
        success_rate(rate, "the success rate of a unit")
    how = settings(constraints, constants, encodings, time_limit, memory_limit)
    how = how._replace(session=None)  # at other rates programs weigh otherwise
    program = assemble(how, lambda _: None)
    if program.replaced:
        raise UserError(
            f"{how.replaced}: nobody knows what these encodings measure at other success rates: "
            "ask without them, or put what they add into a constraint"
        )
    if ("risk", 2) in program.looked_at:
        raise UserError(
            "a constraint looks at risk/2, which changes with the rates that are asked about: "
            "let it look at rate/2, which stays what is given, or leave it out"
        )
    problem = asked_with(problem, how)
    outcome = solve(problem, _SUCCESS, how, caller().reporter)
    if outcome.units is None or outcome.status is not Status.OPTIMAL:
        return Sensitivity(Answer._make(outcome), (), ())
    search = _Search(problem, outcome.units, how)
    found = [search.interval(motion) for motion in search.motions]
    flipping = sorted((each for each in found if each.flips), key=lambda each: each.flips[0])
    others = sorted({*problem.network.motions}.difference(search.motions))
    still = (each for each in found if not each.flips)
    return Sensitivity(Answer._make(outcome), (*flipping, *still), tuple(others))


class _Tree(NamedTuple):
    """A tree as one motion sees it: at a rate x it succeeds as often as ``rest`` * x^``power``.

    ``best`` says that it is proved to be the best where it was looked for.
    """

    units: tuple[int, ...]
    power: int
    rest: Fraction
    best: bool


class _Search:
    """Looks for the ends of intervals, motion by motion; docs/questions.md has the argument."""

    def __init__(self, problem: Problem, tree: tuple[int, ...], how: Settings) -> None:
        self._problem, self._tree, self._how = problem, tree, how
        self._holds = Postconditions(problem, levels(_SUCCESS), how)
        reached = reach(problem)
        # A unit that the goals cannot need makes no tree better, but rules of the user's may ask for it.
        plain = not how.constraints and how.replaced is None
        self._units = relevant(problem, reached) if plain else reached.units
        self._most = self._counted(self._units)
        self.motions = sorted(self._most)
        self._looser: Problem | None = None
        if not plain:
            from foon_asp.certificate import coverage  # noqa: PLC0415 (for constraints alone)

            self._looser = _without(problem, coverage(how).forbids(problem.network))
        try:
            self._settled = self._unmoved()
        except KeyboardInterrupt:
            how.begun.interrupt()
            self._settled = set()

    def interval(self, motion: str) -> Interval:
        """Find the interval of one motion; at a limit, what is known of it."""
        rate = (self._problem.rates or {})[motion]
        tree = self._seen(motion, self._tree, best=True)
        ends = []
        for search in (self._below, self._above):
            try:
                ends.append(search(motion, tree))
            except KeyboardInterrupt:
                self._how.begun.interrupt()
                ends.append(End(None, None, proved=False))
        return Interval(motion, rate, tree.power, *ends)

    def _above(self, motion: str, tree: _Tree) -> End:
        """Find the greatest rate at which the tree is optimal."""
        rate = (self._problem.rates or {})[motion]
        if rate == 1 or self._most[motion] == tree.power or motion in self._settled:
            return End(None, None)
        return self._end_from(motion, tree, Fraction(1))

    def _below(self, motion: str, tree: _Tree) -> End:
        """Find the least rate at which the tree is optimal."""
        if not tree.power or self._ruled_out(motion, 0, _HALF):
            return End(None, None)
        rate = (self._problem.rates or {})[motion]
        tiny = _TINY if rate > _TINY else rate * _TINY
        end = self._end_from(motion, tree, tiny)
        if end.at is not None or not end.proved:
            return end
        # A tree with fewer units of the motion is better below some rate, and if it has all other units there
        # are, below this one; it would be better than the best there.
        if self._rest(motion, self._units) > tree.rest * tiny:
            return end
        rival, proved = self._better(motion, 0, _HALF)  # all others are 1: the fewest units of it
        return (
            End(None, None, proved)
            if rival is None
            else self._end_at(motion, tree, rival._replace(best=False))
        )

    def _end_from(self, motion: str, tree: _Tree, far: Fraction) -> End:
        """Find the end on the way to a rate that is far away, if another tree is better there."""
        rival, proved = self._better(motion, 1, far)
        return End(None, None, proved) if rival is None else self._end_at(motion, tree, rival)

    def _end_at(self, motion: str, tree: _Tree, rival: _Tree) -> End:
        """Go from a tree that is better far away towards the rate, to the nearest end."""
        rate = Root(1, (self._problem.rates or {})[motion])
        while True:
            more, fewer = (rival, tree) if rival.power > tree.power else (tree, rival)
            end = Root.taken(more.power - fewer.power, fewer.rest / more.rest)
            if end == rate or (rival.best and more.power - fewer.power == 1):
                return End(end, rival.units)
            nearer, proved = self._better(motion, end.degree, end.of)
            if nearer is None:
                return End(end, rival.units, proved)
            rival = nearer

    def _better(self, motion: str, degree: int, of: Fraction) -> tuple[_Tree | None, bool]:
        """Look for a tree that is better than the one in hand at another rate, and say if that is proved.

        The rate is a root of this degree of a number. All rates are raised to that degree, which makes it
        rational and leaves products in the order in which they are.
        """
        if self._ruled_out(motion, degree, of):
            return None, True
        outcome, better = self._compared(_at_rate(self._problem, motion, degree, of))
        proved = outcome.status is Status.OPTIMAL
        if not better or outcome.units is None:
            return None, proved
        return self._seen(motion, outcome.units, proved), proved

    def _ruled_out(self, motion: str, degree: int, of: Fraction) -> bool:
        """Say whether even without the constraints no tree is better at another rate.

        What they rule out unit by unit is left out. This is fast: there is mostly nothing to search.
        """
        if self._looser is None:
            return False
        ours = _success(_at_rate(self._problem, motion, degree, of).costs(self._tree))
        free = self._how._replace(constraints=(), constants=(), encodings=None)
        bound = solve(_at_rate(self._looser, motion, degree, of), _SUCCESS, free, Reporter())
        return bound.status is Status.OPTIMAL and bound.costs is not None and _success(bound.costs) <= ours

    def _unmoved(self) -> set[str]:
        """Find motions whose rates may be as great as can be, many at once.

        If the tree is optimal where all units but its own that have one of these motions never fail, it is so
        where the rate of one of the motions rises: other trees gain no more by that. If it is not, the
        motions by which another tree gains are left out.
        """
        network, own = self._problem.network, self._problem.own_rates
        motions = set(self.motions)
        while motions:
            others = {unit for unit in self._units if network.motions[unit] in motions}.difference(self._tree)
            sure = dict.fromkeys(others, Fraction(1)) | dict(own)
            outcome, better = self._compared(replace(self._problem, own_rates=sure, as_seen=self._problem))
            if not better or outcome.units is None:
                return motions if outcome.status is Status.OPTIMAL else set()
            motions.difference_update(network.motions[unit] for unit in others.intersection(outcome.units))
        return motions

    def _compared(self, there: Problem) -> tuple[Outcome, bool]:
        """Find the best tree at other rates, and say whether it is better there than the one in hand."""
        outcome = solve(there, _SUCCESS, self._how, Reporter())
        ours = _success(there.costs(self._tree))
        theirs = Fraction(0) if outcome.costs is None else _success(outcome.costs)
        self._holds.require(
            theirs >= ours or outcome.status not in {Status.OPTIMAL, Status.INFEASIBLE},
            lambda: f"at other success rates {outcome.status} is said, but the tree {self._tree} is better",
        )
        return outcome, theirs > ours

    def _counted(self, units: Iterable[int]) -> Counter[str]:
        """Count the units of each motion whose rate is that of the motion."""
        network, own = self._problem.network, self._problem.own_rates
        return Counter(network.motions[unit] for unit in units if unit not in own)

    def _seen(self, motion: str, units: tuple[int, ...], best: bool) -> _Tree:
        return _Tree(
            units, sum(self._varies(motion, unit) for unit in units), self._rest(motion, units), best
        )

    def _rest(self, motion: str, units: Iterable[int]) -> Fraction:
        """Multiply the rates of units that do not vary with that of the motion."""
        fixed = (self._problem.rate(unit) for unit in units if not self._varies(motion, unit))
        return math.prod(fixed, start=Fraction(1))

    def _varies(self, motion: str, unit: int) -> bool:
        return self._problem.network.motions[unit] == motion and unit not in self._problem.own_rates


def _at_rate(problem: Problem, motion: str, degree: int, of: Fraction) -> Problem:
    """Raise all rates of a problem to the degree of a root, which the rate of a motion is."""
    raised = {name: rate**degree for name, rate in (problem.rates or {}).items()}
    own = {unit: rate**degree for unit, rate in problem.own_rates.items()}
    return replace(problem, rates=raised | {motion: of}, own_rates=own, as_seen=problem)


def _success(costs: Costs) -> Fraction:
    return Fraction(costs.measure(Objective.SUCCESS))


def _without(problem: Problem, units: Collection[int]) -> Problem:
    """Leave units out of a problem, whose others keep the rates that are their own."""
    kept = [unit for unit in range(len(problem.network)) if unit not in units]
    own = {place: problem.own_rates[unit] for place, unit in enumerate(kept) if unit in problem.own_rates}
    return replace(problem, network=problem.network.without(units), own_rates=own)


def _lines(found: Sensitivity) -> Iterator[str]:
    flipping = [interval for interval in found.intervals if interval.flips]
    still = [interval for interval in found.intervals if not interval.flips]
    if flipping:
        known = "each proved" if found.ending is Ending.DONE else "as far as they are known"
        yield f"one rate may be wrong between these ends, {known}"
        yield ""
        yield from _table(found, flipping)
    kept = [_named(interval) for interval in still if interval.proved and interval.units]
    foreign = sum(interval.proved and not interval.units for interval in still) + len(found.others)
    if foreign:
        kept.append(f"{counted(foreign, 'motion')} that the tree does not have")
    unknown = [_named(interval) for interval in still if not interval.proved]
    for title, names in (("at any rate", kept), ("not known", unknown)):
        if names:
            yield ""
            yield from _wrapped(f"{title}: {', '.join(names)}", "  ")
    if found.intervals:
        yield ""
        yield from _advice(found)


def _table(found: Sensitivity, flipping: list[Interval]) -> Iterator[str]:
    """Align rates and ends, and say under each motion what comes beyond."""
    rows = [["rate", "from", "to"]]
    for interval in flipping:
        ends = {flip.above: _number(flip.inwards) for flip in interval.flips}
        low, high = ends.get(False, "0"), ends.get(True, "1")
        rows.append(
            [
                success_text(interval.rate),
                low + "?" * (not interval.below.proved),
                high + "?" * (not interval.above.proved),
            ]
        )
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    names = ["motion", *map(_named, flipping)]
    for place, (row, name) in enumerate(zip(rows, names, strict=True)):
        cells = "  ".join(cell.rjust(width) for cell, width in zip(row, widths, strict=True))
        yield f"  {cells}  {name}"
        for flip in flipping[place - 1].flips if place else ():
            yield from _wrapped(f"      {_side(flip)}: {_changes(found.outcome, flip)}", " " * 10)


def _advice(found: Sensitivity) -> Iterator[str]:
    first = found.first
    complete = all(interval.proved for interval in found.intervals)
    if not complete:
        yield "stopped at a limit: an end with ? may be nearer to the rate"
    if first is not None:
        yield from _wrapped(
            f"flips first: {first.interval.motion}, {_side(first)}; measure it before others", "  "
        )
    elif complete:
        yield "no rate makes another tree better by itself: there is nothing to measure"


def _named(interval: Interval) -> str:
    return interval.motion if interval.units == 1 else f"{interval.motion} ({interval.units})"


def _side(flip: Flip) -> str:
    return f"{'above' if flip.above else 'below'} {_number(flip.inwards)} ({_percent(flip)})"


def _percent(flip: Flip) -> str:
    """Give a relative change in percent, rounded to 0."""
    digits = _DIGITS
    while True:
        low, high = flip.change(digits)
        if low == high == 0:
            return "0 %"
        if low > 0:
            shown = {Root(1, 100 * each).below(_PERCENT_DIGITS) for each in (low, high)}
            if len(shown) == 1:
                return f"{'+' if flip.above else '-'}{_number(shown.pop())} %"
        digits *= 2


def _number(value: Fraction) -> str:
    """Write a number as a decimal where it is one, and else as a fraction."""
    context = Context(prec=value.numerator.bit_length() + value.denominator.bit_length())
    decimal = context.divide(Decimal(value.numerator), Decimal(value.denominator)).normalize(context)
    if Fraction(decimal) != value:
        return str(value)
    return f"{decimal:f}" if value >= _TINY else f"{decimal}"


def _changes(best: Answer, flip: Flip) -> str:
    return changes_text(best.problem.network, *_gone_and_new(best, flip.end))


def _gone_and_new(best: Answer, end: End) -> tuple[list[int], list[int]]:
    ours, theirs = best.units or (), end.beyond or ()
    return [unit for unit in ours if unit not in theirs], [unit for unit in theirs if unit not in ours]


def _wrapped(text: str, indent: str) -> list[str]:
    return textwrap.wrap(
        text, _WIDTH, subsequent_indent=indent, break_long_words=False, break_on_hyphens=False
    )


def _interval_json(best: Answer, interval: Interval) -> Json:
    flips = {flip.above: flip for flip in interval.flips}
    return {
        "motion": interval.motion,
        "rate": fraction_json(interval.rate),
        "units": interval.units,
        "below": _end_json(best, interval.below, flips.get(False)),
        "above": _end_json(best, interval.above, flips.get(True)),
    }


def _end_json(best: Answer, end: End, flip: Flip | None) -> Json:
    network = best.problem.network
    known: Json = {"proved": end.proved, "at": None, "beyond": None}
    if flip is None or end.beyond is None:
        return known
    gone, new = _gone_and_new(best, end)
    at = fraction_json(flip.at.of) or {}
    known["at"] = {
        "root": flip.at.degree,
        "of": at["exact"],
        "inwards": fraction_json(flip.inwards),
        "change": _percent(flip),
    }
    known["beyond"] = {
        "costs": costs_json(best.problem.costs(end.beyond)),
        "units": steps_json(best.problem, end.beyond),
        "gone": [network.unit_number(unit) for unit in gone],
        "new": [network.unit_number(unit) for unit in new],
    }
    return known
