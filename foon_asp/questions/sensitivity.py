"""How wrong success rates may be: the interval of each in which the best tree stays the best."""

from collections.abc import Iterator
from fractions import Fraction
from typing import Literal, Unpack

from foon_asp.asp import Status, solve
from foon_asp.asp.assembly import assemble
from foon_asp.errors import UserError
from foon_asp.json_layout import schema_name
from foon_asp.network import counted
from foon_asp.problem import Objective, Problem, success_rate
from foon_asp.questions.answer import Answer, WithAnswer
from foon_asp.questions.caller import caller
from foon_asp.questions.ending import Ending
from foon_asp.questions.flip import Flip, decimal_text
from foon_asp.questions.optimality_interval import Envelope, IntervalEnd
from foon_asp.questions.options import CONTAINERS, GOALS
from foon_asp.questions.python_arguments import problem_for_rules
from foon_asp.questions.python_options import CommonOptions, settings_of
from foon_asp.questions.question import TABLES, question
from foon_asp.results.figure_text import success_text
from foon_asp.results.plain_values import fraction_text
from foon_asp.results.table import Block, Table
from foon_asp.results.values import CostedTree, Value, changed_motions, steps_not_in
from foon_asp.results.values_of import costed_tree, question_fields

_SUCCESS = (Objective.SUCCESS,)

Direction = Literal["below", "above"]


class FlipRate(Value, frozen=True):
    """The rate of a motion at which another tree is as good as the best one.

    Attributes:
        root: The degree of the root that the rate is: 2 for the square root of ``of``.
        of: The exact rational number whose root the rate is, as text.
        inwards: The rate as a decimal, rounded so that it lies within the interval.
        change: The relative change of the rate, as text in percent.
    """

    root: int
    of: str
    inwards: Fraction
    change: str


class TreeBeyond(CostedTree, frozen=True):
    """The best tree if a rate lies beyond the end of its interval, with the costs at the given rates.

    Attributes:
        gone: The ids of the units that the best tree has and this tree lacks.
        new: The ids of the units that this tree has and the best tree lacks.
    """

    gone: tuple[int, ...]
    new: tuple[int, ...]


class RateEnd(Value, frozen=True):
    """One end of the interval of a rate.

    Attributes:
        proved: Whether this is the end; if not, a limit came first, and the end may be nearer to the rate.
        at: The rate at which another tree is as good; null if no rate on that side makes another tree better.
        beyond: The tree that is the best beyond this rate; null without such a rate.
    """

    proved: bool
    at: FlipRate | None
    beyond: TreeBeyond | None


class RateInterval(Value, frozen=True):
    """The rates of one motion at which the best tree stays the best, while other rates do not change.

    Attributes:
        rate: The rate that is given.
        units: How many units of the best tree have the motion.
        below: The end below the rate. If it has no rate, the interval goes down to 0, which is not in it.
        above: The end above the rate. If it has no rate, the interval goes up to 1.
    """

    motion: str
    rate: Fraction
    units: int
    below: RateEnd
    above: RateEnd

    @property
    def proved(self) -> bool:
        """Whether both ends are proved."""
        return self.below.proved and self.above.proved

    @property
    def flips(self) -> bool:
        """Whether some rate makes another tree the best."""
        return self.below.at is not None or self.above.at is not None

    def __str__(self) -> str:
        return self.motion if self.units == 1 else f"{self.motion} ({self.units})"


class FirstFlip(Value, frozen=True):
    """The motion whose rate has to change least for another best tree, and that end of its interval."""

    motion: str
    side: Direction


class Sensitivity(WithAnswer, frozen=True, kw_only=True, tag=schema_name("sensitivity")):
    """How wrong each success rate may be before another tree is the best.

    Attributes:
        answer: The best tree by ``success``.
        intervals: One for each motion that a tree for the goals may have. The motion whose rate has to
            change least for another best tree comes first. Empty if no tree was proved the best.
        others: Motions that no tree for the goals needs.
        first: The motion whose rate has to change least for another best tree; null where none does.

    Example:
        >>> found = foon_asp.sensitivity(foon_asp.load().problem("ice"))
        >>> len(found.intervals), found.first.motion, found.first.side
        (4, 'pound', 'below')
    """

    ROWS = "intervals"

    answer: Answer
    intervals: tuple[RateInterval, ...]
    others: tuple[str, ...]
    first: FirstFlip | None

    @property
    def ending(self) -> Ending:
        """The ending of ``answer``; ``LIMIT`` if an end of an interval is not proved."""
        proved = all(interval.proved for interval in self.intervals)
        return self.answer.ending if proved else Ending.LIMIT

    def show(self) -> Iterator[Block]:
        """Return a table of the motions whose rate can make another tree the best, then the other motions.

        The last line says which rate to measure first, or that no rate alone makes another tree the best.
        """
        yield from (*self.goal_lines(), *self.answer.headlines())
        flipping = [interval for interval in self.intervals if interval.flips]
        stable = [interval for interval in self.intervals if not interval.flips]
        if flipping:
            claim = "each proved" if self.ending is Ending.DONE else "as far as they are known"
            yield f"one rate may be wrong between these ends, {claim}"
            yield ""
            headings = ("rate", "from", "to", "motion", "beyond")
            yield Table(headings, [*map(self._cells, flipping)], left_aligned=frozenset({3, 4}), indent=2)
        kept = [str(interval) for interval in stable if interval.proved and interval.units]
        foreign_count = sum(interval.proved and not interval.units for interval in stable) + len(self.others)
        if foreign_count:
            kept.append(f"{counted(foreign_count, 'motion')} that the tree does not have")
        unknown = [str(interval) for interval in stable if not interval.proved]
        for title, names in (("at any rate", kept), ("not known", unknown)):
            if names:
                yield ""
                yield f"{title}: {', '.join(names)}"
        if self.intervals:
            yield ""
            yield from self._advice()

    def _cells(self, interval: RateInterval) -> tuple[str, ...]:
        """Return the row of a motion: rate, both ends of the interval, name, and the trees beyond them.

        An end that is not proved has a question mark. If no rate on a side makes another tree better, the end
        is 0 or 1.
        """
        best, ends, beyond = self.answer.units or (), [], []
        for end, limit in ((interval.below, "0"), (interval.above, "1")):
            ends.append((decimal_text(end.at.inwards) if end.at else limit) + "?" * (not end.proved))
            if end.at and end.beyond:
                rival = end.beyond.units
                changes = changed_motions(steps_not_in(best, rival), steps_not_in(rival, best))
                beyond.append(f"{end.at.change}: {changes}")
        return success_text(interval.rate), *ends, str(interval), "; ".join(beyond)

    def _advice(self) -> Iterator[str]:
        """Yield lines on which rate to measure first, or that no rate alone makes another tree better."""
        if self.ending is Ending.LIMIT:
            yield "stopped at a limit: an end with ? may be nearer to the rate"
        if self.first is not None:
            motion, direction = self.first.motion, self.first.side
            end: RateEnd = getattr(self.intervals[0], direction)
            if end.at:
                flip = f"{direction} {decimal_text(end.at.inwards)} ({end.at.change})"
                yield f"flips first: {motion}, {flip}; measure it before others"
        elif self.ending is Ending.DONE:
            yield "no rate makes another tree better by itself: there is nothing to measure"


@question(
    GOALS,
    CONTAINERS,
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
def sensitivity(problem: Problem, **options: Unpack[CommonOptions]) -> Sensitivity:
    """Find how wrong each success rate may be before another tree is the best by ``success``.

    One rate varies while the others stay as given. Constraints see the rates as given. The limits are for
    the whole question.

    Returns:
        The best tree as the ``answer``, and an interval for each motion, the one with the nearest end first.

    Raises:
        UserError: for a wrong argument or constraint, for rates not given, for replaced encodings, or for
            rules about ``risk/2``.

    Example:
        >>> found = foon_asp.sensitivity(foon_asp.load().problem("macaroni"))
        >>> found.intervals[0].motion, float(found.intervals[0].rate)
        ('pour', 0.95)
    """
    problem.require_known_for(_SUCCESS)
    for motion in sorted(set(problem.network.motions)):
        success_rate((problem.rates or {})[motion], f"the success rate of {motion!r}")
    for rate in problem.own_rates.values():
        success_rate(rate, "the success rate of a unit")
    settings = settings_of(options)
    program = assemble(settings, lambda _: None)
    if program.replaced:
        raise UserError(
            f"{settings.replaced}: it is not known what these encodings measure at other success "
            "rates: leave them out, or put what they add into a constraint"
        )
    if ("risk", 2) in program.looked_at:
        raise UserError(
            "a constraint uses risk/2, which changes with the rates asked about: use rate/2, "
            "which stays as given, or leave the constraint out"
        )
    problem = problem_for_rules(problem, settings)
    outcome = solve(problem, _SUCCESS, settings, caller().reporter)
    answer, fields_of_question = Answer.of(outcome), question_fields(problem, _SUCCESS)
    if outcome.units is None or outcome.status is not Status.OPTIMAL:
        return Sensitivity(**fields_of_question, answer=answer, intervals=(), others=(), first=None)
    envelope = Envelope(problem, outcome.units, settings)
    flipping: list[tuple[Flip, RateInterval]] = []
    stable: list[RateInterval] = []
    for motion in envelope.motions:
        rate = (problem.rates or {})[motion]
        flips, ends = [], []
        for above in (False, True):
            end = envelope.end(motion, above)
            flip = None if end.at is None else Flip(rate, end.at, above)
            ends.append(_end_value(answer, end, flip))
            flips += [] if flip is None else [flip]
        interval = RateInterval(motion, rate, envelope.unit_count(motion), *ends)
        if flips:
            flipping.append((min(flips), interval))
        else:
            stable.append(interval)
    flipping.sort(key=lambda pair: pair[0])
    nearest = [
        FirstFlip(interval.motion, "above" if flip.above else "below") for flip, interval in flipping[:1]
    ]
    return Sensitivity(
        **fields_of_question,
        answer=answer,
        intervals=(*(interval for _, interval in flipping), *stable),
        others=tuple(sorted({*problem.network.motions}.difference(envelope.motions))),
        first=nearest[0] if nearest else None,
    )


def _end_value(best: Answer, end: IntervalEnd, flip: Flip | None) -> RateEnd:
    """Return an end of an interval as a value for a result, with the best tree beyond it.

    ``flip`` is the change of the rate up to this end; ``None`` if no rate on this side makes another tree
    better. The value then has neither a rate nor a tree.
    """
    if flip is None or end.beyond is None:
        return RateEnd(end.proved, None, None)
    tree, best_units = costed_tree(best.problem, end.beyond, best.problem.costs(end.beyond)), best.units or ()
    gone, new = (
        tuple(step.id for step in steps_not_in(steps, others) if step.id is not None)
        for steps, others in ((best_units, tree.units), (tree.units, best_units))
    )
    return RateEnd(
        end.proved,
        FlipRate(flip.at.degree, fraction_text(flip.at.of), flip.inwards, flip.percent),
        TreeBeyond(tree.costs, tree.used_up, tree.units, gone, new),
    )
