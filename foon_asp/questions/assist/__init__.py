"""With a person's help: the best success when a person does some of the units."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from os import PathLike
from pathlib import Path

from foon_asp.asp import Status
from foon_asp.dataset.paths import File, Files
from foon_asp.deadline import Cancel
from foon_asp.document.json_document import costs_json, document, fraction_json, steps_json
from foon_asp.network import counted
from foon_asp.problem import Number, Objective, Problem, success_rate
from foon_asp.problem.progress import OnProgress
from foon_asp.questions.arguments import Constants, asked_with, at_least, settings
from foon_asp.questions.assist.assistant import Assistant, Assisted
from foon_asp.questions.caller import caller
from foon_asp.questions.contract import TABLES, Kind, Option, question
from foon_asp.questions.options import CONTAINERS, GOALS, HOW
from foon_asp.questions.result import Ending, Result
from foon_asp.questions.tree import Tree
from foon_asp.report.answer import costs_text, goal_lines, steps, success_text
from foon_asp.report.stacked import is_narrow, stacked_lines
from foon_asp.text.rate_table import read_rates


@dataclass(frozen=True, repr=False)
class Assistance(Result):
    """The best trees if a person does at most 0, 1, 2, ... units, in this order.

    ``problem`` is the problem asked about. Each of ``rows`` has ``most``, ``status``, ``success``,
    ``costs``, ``units`` by id and ``helped``, the ids of those that the person does; :attr:`task_trees` has
    the trees as values. ``person`` has the person's success rates by motion, or is ``None`` for a person who
    never fails. ``greatest`` is the best success with any help; it is ``None`` if there is no tree or a
    limit was reached. ``wanted`` is the success to reach and ``most`` the number of units, if they were
    given. ``complete`` tells whether all rows asked for are there and proved.

    Example:
        >>> helped = foon_asp.assist(foon_asp.load().problem("macaroni"), 1)
        >>> [len(row.helped) for row in helped.rows], helped.complete
        ([0, 1], True)
    """

    problem: Problem
    person: Mapping[str, Fraction] | None
    rows: tuple[Assisted, ...]
    greatest: Fraction | None
    wanted: Fraction | None
    most: int | None
    complete: bool

    @property
    def smallest(self) -> int | None:
        """The fewest units to be done by a person for the wanted success; ``None`` where no row has it."""
        if self.wanted is None:
            return None
        return next((row.most for row in self.rows if row.reaches(self.wanted)), None)

    @property
    def exhausted(self) -> bool:
        """Whether more help than that of the last row changes nothing."""
        return bool(self.rows) and self.greatest is not None and self.rows[-1].success == self.greatest

    @property
    def task_trees(self) -> tuple[Tree | None, ...]:
        """The trees of the rows as values, ``None`` where a row has none."""
        return tuple(
            None
            if row.units is None or row.costs is None
            else Tree.of(
                self.problem,
                row.units,
                f"{counted(len(row.helped), 'unit')} helped: {costs_text(row.costs)}",
            )
            for row in self.rows
        )

    @property
    def ending(self) -> Ending:
        """Done when every row is proved, and what was to be reached is."""
        if not self.complete:
            return Ending.LIMIT
        missed = self.wanted is not None and self.smallest is None
        return Ending.NEGATIVE if missed or self.rows[-1].units is None else Ending.DONE

    def text(self) -> str:
        """Give a row for each number of units, and what was reached.

        The tree of the last row is given where it was asked for, and where it reaches what is wanted.
        """
        return "\n".join([*goal_lines(self.problem), *_lines(self)]) + "\n"

    def json_dict(self) -> object:
        """Give all rows with their trees, and who does each unit."""
        person = self.person
        return document(
            "assist",
            self.problem,
            [Objective.SUCCESS],
            person=None if person is None else {m: fraction_json(rate) for m, rate in person.items()},
            complete=self.complete,
            greatest_success=fraction_json(self.greatest),
            more_help_changes_nothing=self.exhausted,
            reach=fraction_json(self.wanted),
            smallest=self.smallest,
            rows=[_row_json(self, row) for row in self.rows],
        )


@question(
    GOALS,
    CONTAINERS,
    Option(
        "most",
        "The greatest number of units that the person does.",
        Kind.WHOLE,
        flags=("--assist",),
        metavar="M",
        least=0,
    ),
    Option("reach", "A success to reach with the fewest units done by the person.", metavar="SUCCESS"),
    Option(
        "person",
        "A file with success rates of what the person can do; without it, everything, never failing.",
        Kind.FILE,
    ),
    *HOW,
    formats=TABLES,
    help_="""
    \b
    foon-asp assist --goal macaroni               for every number that makes a difference
    foon-asp assist --goal macaroni --assist 3    for 0 to 3, and the tree with 3
    foon-asp assist --goal macaroni --reach 0.8   up to the fewest that reach it, and the tree

    The person takes over only units with a higher rate than the robot's. Trees are compared exactly; of trees
    with the same success, one with the fewest units is given.

    Exits with 0 when every row is proved, 1 when there is no tree or the success is out of reach, 3 when a
    limit came first.
    """,
)
def assist(
    problem: Problem,
    most: int | None = None,
    *,
    reach: Number | None = None,
    person: File | Mapping[str, Number] | None = None,
    constraints: Files = (),
    constants: Constants | None = None,
    encodings: File | None = None,
    time_limit: float | None = None,
    memory_limit: int | str | None = None,
    on_progress: OnProgress | None = None,
    cancel: Cancel | None = None,
) -> Assistance:
    """Find the best success if a person does at most 0, 1, 2, ... units, and which ones these are.

    The person takes over only motions with a higher rate than the robot's. The rows end with ``most`` units,
    with the first that reaches ``reach``, or where more help changes nothing. The limits are for the whole
    question.

    The question comes from the weighted FOON: a tree with M human-assisted motions (Paulius, Dong and Sun,
    Task planning with a weighted functional object-oriented network, 2021). Here it is answered over all
    trees.

    Parameters:
        reach: A success, above 0 and at most 1, to reach with the fewest units done by the person.
        person: The path of a file with success rates, or rates by motion, of what the person can do. Without
            it the person can do everything and never fails.

    Returns:
        The ``rows``, one for each number of units that makes a difference.

    Raises:
        UserError: for a wrong argument or constraint, or if the robot's rates are not given.

    Example:
        >>> helped = foon_asp.assist(foon_asp.load().problem("macaroni"), 2)
        >>> [(row.most, round(float(row.success), 4)) for row in helped.rows]
        [(0, 0.6293), (1, 0.7122), (2, 0.7742)]
    """
    how = settings(constraints, constants, encodings, time_limit, memory_limit)
    how = how._replace(session=None)  # every number of units has programs that no other question can use
    wanted = None if reach is None else success_rate(reach, "the success to reach")
    limit = None if most is None else at_least(most, 0, "most")
    theirs = _rates(problem, person)
    problem = asked_with(problem, how)
    rows, greatest, complete = Assistant(problem, theirs, how, caller().reporter).rows(limit, wanted)
    return Assistance(problem, theirs, rows, greatest, wanted, limit, complete)


def _rates(problem: Problem, person: File | Mapping[str, Number] | None) -> dict[str, Fraction] | None:
    """Read the rates of a person; those of the robot must be known and above 0."""
    problem.require_known_for([Objective.SUCCESS])
    assert problem.rates is not None
    for motion, rate in problem.rates.items():
        success_rate(rate, f"the success rate of {motion!r}")
    if person is None:
        return None
    place = ""
    if isinstance(person, str | PathLike):
        rates, place = read_rates(Path(person)), f"{person}: warning: "
    else:
        rates = {motion: success_rate(rate, f"the rate of {motion!r}") for motion, rate in person.items()}
    for motion in rates:
        if motion not in problem.rates:
            caller().reporter.warning(f"{place}the motion {motion!r} has no rate for the robot")
    return rates


def _lines(found: Assistance) -> Iterator[str]:
    rule = found.problem.conditions
    last = found.rows[-1]
    if last.status is Status.INFEASIBLE and found.greatest is None and found.complete:
        yield f"infeasible: proved that no task tree exists, with help or without ({rule})"
        return
    never = "who never fails" if found.person is None else "at rates of the person's own"
    claim = (
        "each row is proved" if found.complete else "stopped at a limit: some rows are missing or not proved"
    )
    yield f"best success with a person's help, {never} ({rule}); {claim}"
    yield ""
    yield from _table(found)
    yield ""
    yield from _remarks(found)
    shown = found.most is not None or found.smallest is not None
    if shown and last.units is not None and last.costs is not None:
        yield ""
        yield f"with {counted(len(last.helped), 'unit')} done by the person: {costs_text(last.costs)}"
        yield from steps(found.problem, last.units, helped=last.helped)


def _table(found: Assistance) -> Iterator[str]:
    """Give what every row adds to the one before: the whole would be most of a tree, again and again."""
    headings = ["helped", "   success", "units", "the person takes"]
    rows = [*_cells(found)]
    if is_narrow():
        yield from stacked_lines(headings, rows)
    else:
        yield from ("  ".join(cells).rstrip() for cells in (headings, *rows))


def _cells(found: Assistance) -> Iterator[list[str]]:
    before: frozenset[int] = frozenset()
    for row in found.rows:
        most = f"{row.most:>6}"
        if row.costs is None or row.success is None:
            yield [most, "no tree" if row.status is Status.INFEASIBLE else "no tree found yet", "", ""]
            continue
        taken = [f"- {_name(found, unit)}" for unit in sorted(before - row.helped)]
        taken += [f"+ {_name(found, unit)}" for unit in sorted(row.helped - before)]
        if row.status is Status.FEASIBLE:
            known = "" if row.bound is None else f" (at most {success_text(row.bound)})"
            taken.append(f"not proved best{known}")
        figures = [most, f"{success_text(row.success):>10}", f"{row.costs.units:>5}"]
        yield [*figures, ", ".join(taken)]
        before = row.helped


def _remarks(found: Assistance) -> Iterator[str]:
    last, wanted, greatest = found.rows[-1], found.wanted, found.greatest
    if wanted is not None and found.smallest is not None:
        fewer = ", and not with fewer" if found.smallest else ""
        yield f"{_plain(wanted)} is reached with help for {counted(found.smallest, 'unit')}{fewer}: proved"
    elif wanted is not None and greatest is not None and greatest < wanted:
        yield f"{_plain(wanted)} is out of reach: {success_text(greatest)} is the most with any help: proved"
    elif wanted is not None and found.complete:
        yield f"{_plain(wanted)} is not reached with help for {counted(last.most, 'unit')}: proved"
    if found.exhausted:
        yield "more help changes nothing"
    elif greatest is not None:
        yield f"with any help: {success_text(greatest)}"


def _plain(wanted: Fraction) -> str:
    """Give the number that was asked for as a decimal where it is a short one."""
    text = success_text(wanted)
    return str(wanted) if text.startswith("≈") else text


def _name(found: Assistance, unit: int) -> str:
    network = found.problem.network
    return f"{network.unit_number(unit)} {network.motions[unit]}"


def _row_json(found: Assistance, row: Assisted) -> object:
    units = None if row.units is None else steps_json(found.problem, row.units)
    for step, unit in zip(units or (), row.units or (), strict=True):
        step["by"] = "person" if unit in row.helped else "robot"
    return {
        "most": row.most,
        "status": str(row.status),
        "costs": costs_json(row.costs),
        "bound": fraction_json(row.bound),
        "by_person": sorted(map(found.problem.network.unit_number, row.helped)),
        "units": units,
    }
