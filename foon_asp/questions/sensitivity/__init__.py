"""How wrong success rates may be: the interval of each in which the best tree stays the best."""

import textwrap
from collections.abc import Iterator
from dataclasses import dataclass
from decimal import Context, Decimal
from fractions import Fraction

from foon_asp.asp import Status, solve
from foon_asp.asp.assembly import assemble
from foon_asp.dataset.paths import File, Files
from foon_asp.deadline import Cancel
from foon_asp.document.json_document import costs_json, document, fraction_json, steps_json
from foon_asp.errors import UserError
from foon_asp.network import counted
from foon_asp.problem import Objective, Problem, success_rate
from foon_asp.problem.progress import OnProgress
from foon_asp.problem.root import Root
from foon_asp.questions.answer import Answer, WithOutcome
from foon_asp.questions.arguments import Constants, asked_with, settings
from foon_asp.questions.caller import caller
from foon_asp.questions.contract import TABLES, question
from foon_asp.questions.options import CONTAINERS, GOALS, HOW
from foon_asp.questions.result import Ending
from foon_asp.questions.sensitivity.envelope import Envelope
from foon_asp.questions.sensitivity.interval import End, Flip, Interval
from foon_asp.report.answer import changes_text, goal_lines, headline, success_text
from foon_asp.report.stacked import is_narrow, stacked_lines

_SUCCESS = (Objective.SUCCESS,)
_SHORT = Fraction(1, 10**9)  # from which on a number is written without an exponent
_DIGITS = 4  # of a change, at first
_PERCENT_DIGITS = 3
_WIDTH = 60  # columns


@dataclass(frozen=True, repr=False)
class Sensitivity(WithOutcome):
    """How wrong each success rate may be before another tree is the best.

    ``outcome`` is the best tree by ``success``. ``intervals`` has one for each motion that a tree for the
    goals may have, ordered by the smallest relative change that makes another tree the best; motions for
    which none does come last. ``others`` are the motions of the network that no such tree has: their rates
    change nothing. Both are empty if there is no tree, or if it was not proved the best.

    Example:
        >>> found = foon_asp.sensitivity(foon_asp.load().problem("ice"))
        >>> len(found.intervals), found.first.interval.motion
        (4, 'pound')
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

    def json_dict(self) -> object:
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


@question(
    GOALS,
    CONTAINERS,
    *HOW,
    formats=TABLES,
    help_="""
    \b
    foon-asp sensitivity --goal macaroni
    foon-asp sensitivity --goal macaroni --constraint forbid_motion -c forbidden_motion=tilt

    The best tree is the best by success. Each rate varies by itself; the rate with the smallest
    relative change to another best tree comes first. Ends are exact; the text shows them rounded inwards.

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
    on_progress: OnProgress | None = None,
    cancel: Cancel | None = None,
) -> Sensitivity:
    """Find how wrong each success rate may be before another tree is the best by ``success``.

    One rate varies while the others stay as given. Constraints see the rates as given. The limits are for
    the whole question.

    Returns:
        The best tree as the ``outcome``, and an interval for each motion, that with the nearest end first.

    Raises:
        UserError: for a wrong argument or constraint, for rates not given, or for rules about ``risk/2``.

    Example:
        >>> found = foon_asp.sensitivity(foon_asp.load().problem("macaroni"))
        >>> found.first.interval.motion, float(found.first.interval.rate)
        ('pour', 0.95)
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
            f"{how.replaced}: it is not known what these encodings measure at other success "
            "rates: leave them out, or put what they add into a constraint"
        )
    if ("risk", 2) in program.looked_at:
        raise UserError(
            "a constraint uses risk/2, which changes with the rates asked about: use rate/2, "
            "which stays as given, or leave the constraint out"
        )
    problem = asked_with(problem, how)
    outcome = solve(problem, _SUCCESS, how, caller().reporter)
    if outcome.units is None or outcome.status is not Status.OPTIMAL:
        return Sensitivity(Answer._make(outcome), (), ())
    envelope = Envelope(problem, outcome.units, how)
    found = [envelope.interval(motion) for motion in envelope.motions]
    flipping = sorted((each for each in found if each.flips), key=lambda each: each.flips[0])
    others = sorted({*problem.network.motions}.difference(envelope.motions))
    still = (each for each in found if not each.flips)
    return Sensitivity(Answer._make(outcome), (*flipping, *still), tuple(others))


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
    names = ["motion", *map(_named, flipping)]
    if is_narrow():
        beyond = [
            "; ".join(f"{_side(flip)}: {_changes(found.outcome, flip)}" for flip in i.flips) for i in flipping
        ]
        blocks = zip(names[1:], rows[1:], beyond, strict=True)
        yield from stacked_lines(
            ["motion", *rows[0], "beyond"], ([name, *row, text] for name, row, text in blocks)
        )
        return
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
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
    return f"{decimal:f}" if value >= _SHORT else f"{decimal}"


def _changes(best: Answer, flip: Flip) -> str:
    return changes_text(best.problem.network, *_gone_and_new(best, flip.end))


def _gone_and_new(best: Answer, end: End) -> tuple[list[int], list[int]]:
    ours, theirs = best.units or (), end.beyond or ()
    return [unit for unit in ours if unit not in theirs], [unit for unit in theirs if unit not in ours]


def _wrapped(text: str, indent: str) -> list[str]:
    return textwrap.wrap(
        text, _WIDTH, subsequent_indent=indent, break_long_words=False, break_on_hyphens=False
    )


def _interval_json(best: Answer, interval: Interval) -> object:
    flips = {flip.above: flip for flip in interval.flips}
    return {
        "motion": interval.motion,
        "rate": fraction_json(interval.rate),
        "units": interval.units,
        "below": _end_json(best, interval.below, flips.get(False)),
        "above": _end_json(best, interval.above, flips.get(True)),
    }


def _end_json(best: Answer, end: End, flip: Flip | None) -> object:
    network = best.problem.network
    known: dict[str, object] = {"proved": end.proved, "at": None, "beyond": None}
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
