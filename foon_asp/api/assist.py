"""The best success when a person does some of the units."""

from collections.abc import Mapping
from fractions import Fraction
from os import PathLike
from pathlib import Path

from foon_asp.dataset.paths import File, Files
from foon_asp.explain import assist as explain
from foon_asp.problem import Number, Objective, Problem, success_rate
from foon_asp.questions.arguments import Constants, asked_with, at_least, settings
from foon_asp.questions.caller import caller
from foon_asp.questions.result import Result
from foon_asp.questions.tree import Tree
from foon_asp.report.answer import costs_text, counted
from foon_asp.report.assist import assistance_json, assistance_text
from foon_asp.text import read_rates
from foon_asp.warning import warn


class Assistance(Result, explain.Assistance):
    """The best trees of which a person does at most 0, 1, 2, ... units.

    Each of ``rows`` has ``most``, ``status``, ``success``, ``costs``, ``units`` by id and ``helped``, the ids
    of those that the person does; :attr:`task_trees` has the trees as values. ``smallest`` is the fewest
    units that reach what was wanted, ``None`` where it is out of reach. ``complete`` says that every row is
    proved.
    """

    __slots__ = ()

    @property
    def task_trees(self) -> tuple[Tree | None, ...]:
        """The trees of the rows as values, ``None`` where a row has none."""
        problem = self.problem
        return tuple(
            None
            if row.units is None or row.costs is None
            else Tree.of(
                problem, row.units, f"{counted(len(row.helped), 'unit')} helped: {costs_text(row.costs)}"
            )
            for row in self.rows
        )

    def text(self) -> str:
        """Give the rows as ``foon-asp assist`` does."""
        return assistance_text(self, with_tree=False)

    def json_text(self) -> str:
        """Give the rows as ``foon-asp assist --format json`` does."""
        return assistance_json(self)


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
) -> Assistance:
    """Find the best success when a person does at most 0, 1, 2, ... of the units, and which.

    The rows end with ``most`` units, with the first that succeeds as often as ``reach``, or where more help
    changes nothing. ``person`` has the rates of the motions that the person can do: a rates file, or rates by
    motion; without it the person can do all and never fails. ``time_limit`` is for all of it. Otherwise as
    :func:`foon_asp.solve`.
    """
    how = settings(constraints, constants, encodings, time_limit, memory_limit)
    wanted = None if reach is None else success_rate(reach, "the success to reach")
    problem.require_rates_for([Objective.SUCCESS])
    assert problem.rates is not None
    rates: dict[str, Fraction] | None = None
    if isinstance(person, str | PathLike):
        rates = read_rates(Path(person))
    elif person is not None:
        rates = {motion: success_rate(rate, f"the rate of {motion!r}") for motion, rate in person.items()}
    for motion in rates or ():
        if motion not in problem.rates:
            warn(f"the motion {motion!r} has no rate for the robot")
    limit = None if most is None else at_least(most, 0, "most")
    asked = asked_with(problem, how)
    return Assistance._make(explain.assist(asked, rates, limit, wanted, how, caller().reporter))
