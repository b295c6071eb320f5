"""Arguments of Python callers, checked and converted; errors use the words of Python."""

from collections.abc import Iterable, Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import replace
from os import PathLike

from foon_asp.asp.settings import Settings
from foon_asp.dataset import Dataset
from foon_asp.dataset.item_options import items_of, require_contents
from foon_asp.dataset.paths import File, Files
from foon_asp.errors import UserError
from foon_asp.problem import ITEMS, Objective, Problem, UsedUp, parse_objectives, with_dissimilarity
from foon_asp.questions.caller import caller
from foon_asp.rules.passed_constraint import Constraint, find_constraint, given_constraint

Objectives = str | Iterable[str]
"""Names of objectives: a text with one or several, separated by commas, or several texts. The first counts
most."""


def chosen_objectives(problem: Problem, names: Objectives) -> tuple[Objective, ...]:
    """Return the named objectives.

    For a problem with stand-ins, dissimilarity comes first unless it is named. Raises :class:`UserError` for
    an unknown name, and for an objective whose rates or prices are not known.
    """
    objectives = parse_objectives([names] if isinstance(names, str) else names, problem.measures)
    if problem.stand_ins is not None:
        objectives = with_dissimilarity(objectives)
    with limited_reading():
        problem.require_known_for(objectives)
    return objectives


def usual_objectives(
    problem: Problem, names: Objectives, usual: Sequence[str], instead: Sequence[str]
) -> Objectives:
    """Return the names if there are any, or else the ``usual`` objectives of a question.

    If there are no names, and success rates are not known for all motions, return ``instead`` and report a
    warning.
    """
    if names:
        return names
    if problem.rates is not None:
        return usual
    why = "motions lack one in the rates file" if problem.unrated else "no success rates are given (--rates)"
    caller().reporter.warning(f"success is left out, since {why}: asked is {' and '.join(instead)}")
    return instead


def as_constraints(constraints: Files) -> tuple[Constraint, ...]:
    """Return one constraint or several as a tuple.

    A constraint is a path, the text of a rule, or the name of a ready-made one.
    """
    is_single = isinstance(constraints, str | PathLike)
    return tuple(map(given_constraint, [constraints] if is_single else constraints))  # type: ignore[arg-type]


def problem_for_rules(problem: Problem, settings: Settings, objectives: Sequence[Objective] = ()) -> Problem:
    """Return the problem over the whole network if rules or stand-ins need it, else the problem unchanged.

    Rules in ``settings`` need the whole network if they may be about units that the goals cannot need. A
    problem with only the nearest stand-ins needs it, unless ``objectives`` begin with dissimilarity.
    ``objectives`` are given only if nothing but the best tree by them is wanted.
    """
    if not problem.has_stand_ins_for(objectives):
        return over_whole_network(problem)
    from foon_asp.asp.assembly import need_whole_network  # noqa: PLC0415 (where there may be rules)

    return over_whole_network(problem) if need_whole_network(problem, settings) else problem


def over_whole_network(problem: Problem) -> Problem:
    """Return the problem over the whole network, all of which is read.

    Reading stops at the limits of the caller.
    """
    with limited_reading():
        return problem.whole


def read_deferred(problem: Problem) -> Problem:
    """Read the units that the goals can need, if that was deferred, and return the same problem.

    Reading stops at the limits of the caller.
    """
    with limited_reading():
        assert problem.goals
    return problem


def limited_reading() -> AbstractContextManager[object]:
    """Return a context in which reading stops at the limits of the caller, if it has any."""
    deadline = caller().deadline
    return nullcontext() if deadline is None else deadline.watched("reading", late=True)


def constraint_weights(weight_of_file: Mapping[File, int]) -> dict[Constraint, int]:
    """Return the weights by constraint, from weights by file or name of a constraint.

    Raises :class:`UserError` for a constraint with two weights. It is also raised for a weight that is not a
    whole number, is less than 1, or is above the greatest that is allowed.
    """
    from foon_asp.asp.search_tuning import SEARCH  # noqa: PLC0415 (where there are rules)

    weights: dict[Constraint, int] = {}
    for name, weight in weight_of_file.items():
        if not isinstance(weight, int) or not 1 <= weight <= SEARCH.max_weight:
            raise UserError(
                f"found the weight {weight!r} of {name}, "
                f"expected a whole number from 1 to {SEARCH.max_weight}"
            )
        constraint = find_constraint(given_constraint(name))
        if constraint in weights:
            raise UserError(f"{name} has two weights")
        weights[constraint] = weight
    return weights


def with_items(problem: Problem, items: str) -> Problem:
    """Return the problem with items that are used up or last; ``items`` is ``used-up`` or ``lasting``.

    For ``used-up``, a problem in which items are used up already is returned unchanged. Otherwise, the data
    of the problem say what is in stock and what stays. Raises :class:`UserError` for another word, and for
    used-up items at a level without contents.
    """
    if items not in ITEMS:
        raise UserError(f"found the items {items!r}, expected one of {', '.join(ITEMS)}")
    if items == "lasting":
        return replace(problem, items=None)
    if problem.items is not None:
        return problem
    require_contents(problem.network.level)
    origin = problem.origin
    used_up = items_of(origin, items, None, None) if isinstance(origin, Dataset) else UsedUp()
    return replace(problem, items=used_up)


def require_at_least(number: int, minimum: int, argument: str) -> int:
    """Return a number if it is at least ``minimum``; else raise :class:`UserError`.

    ``argument`` is the name of the argument, for the message.
    """
    if number < minimum:
        raise UserError(f"found {argument}={number}, expected a whole number from {minimum}")
    return number
