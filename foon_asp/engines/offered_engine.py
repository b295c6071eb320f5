"""Engines that other packages offer: run in a process of their own, and what they say is looked over."""

import functools
from typing import Any

import msgspec

from foon_asp.deadline import Deadline, LimitError
from foon_asp.engines.engine import Engine, EngineAnswer, NotCheckedError
from foon_asp.escapes import escaped
from foon_asp.offered.offer import Offer, Raised
from foon_asp.offered.process import ask_offered
from foon_asp.problem import Objective, Problem

_NOT_CHECKED = f"{NotCheckedError.__module__}.{NotCheckedError.__name__}"


def offered_engine(offer: Offer) -> Engine:
    """Make an engine of what a package offers."""
    return Engine(offer.name, lambda: True, functools.partial(_solve, offer), offer.package)


def _solve(
    offer: Offer,
    problem: Problem,
    objectives: tuple[Objective, ...],
    forbidden: frozenset[int],
    seconds: float,
) -> EngineAnswer:
    """Ask it; at the end of its time it is not finished.

    Raises :class:`NotCheckedError` where it does, and :class:`UserError` where it raises anything else, or
    gives no answer.
    """
    try:
        given = ask_offered(offer, Deadline(seconds), problem.plain, objectives, forbidden, seconds)
    except LimitError:
        return EngineAnswer(offer.name, objectives, None, False)
    if isinstance(given, Raised):
        if _NOT_CHECKED in given.classes:
            raise NotCheckedError(escaped(given.message))
        raise offer.raised(given)
    return _looked_over(offer, problem, objectives, given)


def _looked_over(offer: Offer, problem: Problem, asked: tuple[Objective, ...], given: Any) -> EngineAnswer:
    """Take what was given for an answer, if it is one."""
    try:
        _, objectives, units, finished = msgspec.convert(given, tuple[Any, list[Any], Any, bool])
    except ValueError:
        raise offer.fault(f"gave {given!r}, expected an EngineAnswer") from None
    if not objectives or objectives != list(asked[: len(objectives)]):
        raise offer.fault(
            f"looked at {objectives!r}, expected the first of {', '.join(asked)}, or more of them"
        )
    tree = None if units is None else offer.units(units, len(problem.network))
    return EngineAnswer(offer.name, asked[: len(objectives)], tree, finished)
