"""With a person's help: the best success when a person does some of the units."""

from collections.abc import Iterator, Mapping
from fractions import Fraction
from os import PathLike
from pathlib import Path
from typing import Annotated, Unpack

from foon_asp.asp import Outcome, Status
from foon_asp.dataset.paths import File
from foon_asp.json_layout import schema_name
from foon_asp.network import counted
from foon_asp.problem import Costs, Number, Objective, Problem, success_rate
from foon_asp.questions.caller import caller
from foon_asp.questions.ending import Ending
from foon_asp.questions.help_search import helped_trees
from foon_asp.questions.options import CONTAINERS, GOALS
from foon_asp.questions.python_arguments import problem_for_rules, require_at_least
from foon_asp.questions.python_options import CommonOptions, settings_of
from foon_asp.questions.question import TABLES, Kind, Option, question
from foon_asp.questions.result import Result
from foon_asp.questions.tree import Tree
from foon_asp.questions.used_up_note import used_up_note
from foon_asp.results.document import AboutGoals, Unserialized
from foon_asp.results.figure_text import costs_text, success_text
from foon_asp.results.table import Block, Table
from foon_asp.results.values import Step, UsedUpRun, Value
from foon_asp.results.values_of import question_fields, steps_of, used_up_of
from foon_asp.text.tables import RATES


class AssistedTree(Value, frozen=True):
    """The best tree of which a person does at most a given number of units.

    Attributes:
        most: The greatest number of units that the person may do.
        costs: What the tree costs, the person's rates included; null without a tree.
        bound: The success that no such tree exceeds; null if none is proved.
        by_person: The ids of the units that the person does.
        used_up: Whether the steps, each done once, run where items are used up; null without a tree.
        units: The steps, in an order that executes, with who does each; null without a tree.
    """

    most: int
    status: Status
    costs: Costs | None
    bound: Fraction | None
    by_person: tuple[int, ...]
    used_up: UsedUpRun | None
    units: tuple[Step, ...] | None

    @property
    def success(self) -> Fraction | None:
        """The success of the tree, with the person's rates for helped units; ``None`` without a tree."""
        return None if self.costs is None else self.costs.success


class Assistance(Result, AboutGoals, frozen=True, kw_only=True, tag=schema_name("assist")):
    """The best trees if a person does at most 0, 1, 2, ... units, in this order.

    Attributes:
        person: The person's rates by motion; null for one who never fails.
        complete: Whether all rows that were asked for are there and proved.
        greatest_success: The best success with any help; null if there is no tree or a limit was reached.
        more_help_changes_nothing: Whether the last row has the greatest success.
        reach: The success to reach, if one was given.
        smallest: The fewest helped units with which that success is reached; null if no row reaches it.
        rows: The best tree for each number of units.

    Example:
        >>> helped = foon_asp.assist(foon_asp.load().problem("macaroni"), 1)
        >>> [len(row.by_person) for row in helped.rows], helped.complete
        ([0, 1], True)
    """

    ROWS = "rows"

    person: dict[str, Fraction] | None
    complete: bool
    greatest_success: Fraction | None
    more_help_changes_nothing: bool
    reach: Fraction | None
    smallest: int | None
    rows: tuple[AssistedTree, ...]

    problem = Unserialized[Problem]()
    """The problem that was asked about."""

    most = Unserialized[int | None]()
    """The greatest number of units that was asked for."""

    @property
    def task_trees(self) -> tuple[Tree | None, ...]:
        """The tree of each row, for other questions; ``None`` for a row without a tree."""
        return tuple(map(self._tree, self.rows))

    def _tree(self, row: AssistedTree) -> Tree | None:
        """Return the tree of a row, with a claim; ``None`` for a row without a tree."""
        if row.units is None or row.costs is None:
            return None
        ids = self.problem.network.units_of_numbers(step.id for step in row.units if step.id is not None)
        helped = counted(len(row.by_person), "unit")
        return Tree.of(self.problem, ids, f"{helped} helped: {costs_text(row.costs)}")

    @property
    def ending(self) -> Ending:
        """``LIMIT`` if a row is missing or not proved.

        Otherwise ``NEGATIVE`` if there is no tree or the success to reach is not reached, else ``DONE``.
        """
        if not self.complete:
            return Ending.LIMIT
        missed = self.reach is not None and self.smallest is None
        return Ending.NEGATIVE if missed or self.rows[-1].units is None else Ending.DONE

    def show(self) -> Iterator[Block]:
        """Yield a table with a row for each number of helped units, and what is proved of the success.

        The tree of the last row follows if ``most`` was given, or if this tree reaches the success asked for.
        If no tree exists, one line says so in place of the table.
        """
        yield from self.goal_lines()
        conditions, last = self.problem.conditions, self.rows[-1]
        if self.complete and self.greatest_success is None:
            yield f"infeasible: proved that no task tree exists, with help or without ({conditions})"
            return
        person = "who never fails" if self.person is None else "at rates of the person's own"
        claim = (
            "each row is proved"
            if self.complete
            else "stopped at a limit: some rows are missing or not proved"
        )
        yield f"best success with a person's help, {person} ({conditions}); {claim}"
        yield ""
        yield Table(("helped", "success", "units", "the person takes"), [*self._cells()], frozenset({3}))
        yield ""
        yield from self._remarks()
        tree = self._tree(last)
        shown = self.most is not None or self.smallest is not None
        if shown and tree is not None and last.costs is not None:
            yield ""
            yield f"with {counted(len(last.by_person), 'unit')} done by the person: {costs_text(last.costs)}"
            yield from used_up_note(self.problem, tree)
            yield from (line for step in last.units or () for line in step.lines())

    def _cells(self) -> Iterator[tuple[str, ...]]:
        """Yield the cells of each row: the number of helped units, success, units and changes.

        The cell of changes lists the helped units that were added or removed since the row before. If the
        tree is not proved best, this cell also has a remark and the bound. A row without a tree says so in
        the place of the success.
        """
        motions = {step.id: step.motion for row in self.rows for step in row.units or ()}
        previous_helped: tuple[int, ...] = ()
        for row in self.rows:
            if row.costs is None or row.success is None:
                no_tree_text = "no tree" if row.status is Status.INFEASIBLE else "no tree found yet"
                yield str(row.most), no_tree_text, "", ""
                continue
            changes = [("-", unit) for unit in previous_helped if unit not in row.by_person]
            changes += [("+", unit) for unit in row.by_person if unit not in previous_helped]
            texts = [f"{sign} {unit} {motions[unit]}" for sign, unit in changes]
            if row.status is Status.FEASIBLE:
                at_most = "" if row.bound is None else f" (at most {success_text(row.bound)})"
                texts.append(f"not proved best{at_most}")
            yield str(row.most), success_text(row.success), str(row.costs.units), ", ".join(texts)
            previous_helped = row.by_person

    def _remarks(self) -> Iterator[str]:
        """Yield lines on whether the success to reach is reached, and on the success with any help."""
        last, greatest = self.rows[-1], self.greatest_success
        if self.reach is not None:
            # the number that was asked for as a decimal where it is a short one
            reach_text = success_text(self.reach)
            wanted = str(self.reach) if reach_text.startswith("≈") else reach_text
            if self.smallest is not None:
                fewer = ", and not with fewer" if self.smallest else ""
                yield f"{wanted} is reached with help for {counted(self.smallest, 'unit')}{fewer}: proved"
            elif greatest is not None and greatest < self.reach:
                yield f"{wanted} is out of reach: {success_text(greatest)} is the most with any help: proved"
            elif self.complete:
                yield f"{wanted} is not reached with help for {counted(last.most, 'unit')}: proved"
        if self.more_help_changes_nothing:
            yield "more help changes nothing"
        elif greatest is not None:
            yield f"with any help: {success_text(greatest)}"


@question(
    GOALS,
    CONTAINERS,
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
    most: Annotated[int | None, Option(flags=("--assist",), metavar="M", least=0)] = None,
    *,
    reach: Annotated[Number | None, Option(metavar="SUCCESS")] = None,
    person: Annotated[File | Mapping[str, Number] | None, Option(kind=Kind.FILE)] = None,
    **options: Unpack[CommonOptions],
) -> Assistance:
    """Find the best success if a person does at most 0, 1, 2, ... units, and which ones these are.

    The person takes over only motions with a higher rate than the robot's. The rows end with ``most`` units,
    with the first that reaches ``reach``, or where more help changes nothing. The limits are for the whole
    question.

    The question comes from the weighted FOON: a tree with M human-assisted motions (Paulius, Dong and Sun,
    Task planning with a weighted functional object-oriented network, 2021). Here it is answered over all
    trees.

    Parameters:
        most: The greatest number of units that the person does.
        reach: A success to reach with the fewest units done by the person. A number above 0, at most 1.
        person: A file with success rates of what the person can do; without it, everything, never failing. In
            Python, also rates by motion.

    Returns:
        The ``rows``, one for each number of units that makes a difference.

    Raises:
        UserError: for a wrong argument or constraint, or if the robot's rates are not given.

    Example:
        >>> helped = foon_asp.assist(foon_asp.load().problem("macaroni"), 2)
        >>> [(row.most, round(float(row.success), 4)) for row in helped.rows]
        [(0, 0.6293), (1, 0.7122), (2, 0.7742)]
    """
    settings = settings_of(options)
    wanted = None if reach is None else success_rate(reach, "the success to reach")
    limit = None if most is None else require_at_least(most, 0, "most")
    person_rates = _read_person_rates(problem, person)
    problem = problem_for_rules(problem, settings)
    trees = helped_trees(problem, person_rates, settings, caller().reporter, limit, wanted)
    rows = tuple(_assisted_tree(problem, max_helped, row) for max_helped, row in enumerate(trees.rows))
    last = rows[-1].success
    assistance = Assistance(
        **question_fields(problem, [Objective.SUCCESS]),
        person=person_rates,
        complete=trees.complete,
        greatest_success=trees.greatest,
        more_help_changes_nothing=trees.greatest is not None and trees.greatest == last,
        reach=wanted,
        smallest=rows[-1].most if wanted is not None and last is not None and last >= wanted else None,
        rows=rows,
    )
    return assistance.set_unserialized(problem=problem, most=limit)


def _read_person_rates(
    problem: Problem, person: File | Mapping[str, Number] | None
) -> dict[str, Fraction] | None:
    """Return the success rates of a person by motion, from a file or a mapping.

    If ``person`` is ``None``, the person never fails, and ``None`` is returned. Motions that have no rate for
    the robot are reported as warnings. Raises :class:`UserError` if the rates of the robot are not known, or
    if a rate is not above 0 and at most 1.
    """
    problem.require_known_for([Objective.SUCCESS])
    assert problem.rates is not None
    for motion, rate in problem.rates.items():
        success_rate(rate, f"the success rate of {motion!r}")
    if person is None:
        return None
    prefix = ""
    if isinstance(person, str | PathLike):
        rates, prefix = RATES.read(Path(person)), f"{person}: warning: "
    else:
        rates = {motion: success_rate(rate, f"the rate of {motion!r}") for motion, rate in person.items()}
    for motion in rates:
        if motion not in problem.rates:
            caller().reporter.warning(f"{prefix}the motion {motion!r} has no rate for the robot")
    return rates


def _assisted_tree(problem: Problem, max_helped: int, outcome: Outcome) -> AssistedTree:
    """Return the outcome of a search with help for at most ``max_helped`` units as a row of the result."""
    units, helped, bound = outcome.units, outcome.problem.own_rates, outcome.bounds.get(Objective.SUCCESS)
    return AssistedTree(
        max_helped,
        outcome.status,
        outcome.costs,
        None if bound is None else Fraction(bound),
        tuple(sorted(map(problem.network.unit_number, helped))),
        used_up_of(problem, None if units is None else problem.tree(units)),
        None if units is None else steps_of(problem, units, helped=helped),
    )
