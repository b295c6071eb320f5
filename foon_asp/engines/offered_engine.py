"""Engines that other packages offer. They run in a process of their own, and their answers are validated."""

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
    """Return the engine that a package offers. It counts as installed, and runs in a process of its own."""
    return Engine(offer.name, lambda: True, functools.partial(_run_offered, offer), offer.package)


def _run_offered(
    offer: Offer,
    problem: Problem,
    objectives: tuple[Objective, ...],
    forbidden: frozenset[int],
    seconds: float,
) -> EngineAnswer:
    """Run the engine of an offer in a process of its own. The other arguments are those of :class:`Solve`.

    The engine gets :attr:`Problem.plain`. ``finished`` is false in the answer if the engine was stopped after
    ``seconds``. Raises :class:`NotCheckedError` if the engine raises it. Raises :class:`UserError` if the
    engine raises another error or returns no valid answer.
    """
    try:
        reply = ask_offered(offer, Deadline(seconds), problem.plain, objectives, forbidden, seconds)
    except LimitError:
        return EngineAnswer(offer.name, objectives, None, False)
    if isinstance(reply, Raised):
        if _NOT_CHECKED in reply.classes:
            raise NotCheckedError(escaped(reply.message))
        raise offer.raised_error(reply)
    return _validate_reply(offer, problem, objectives, reply)


def _validate_reply(
    offer: Offer, problem: Problem, objectives: tuple[Objective, ...], reply: Any
) -> EngineAnswer:
    """Return the answer in a reply of an engine.

    A valid reply has the form of an :class:`EngineAnswer`, names the first objectives of the question, and
    has distinct ids as units. Raises :class:`UserError` for any other reply.

    The name in the reply is ignored: the answer has the name of the offer.
    """
    try:
        _, optimized, units, finished = msgspec.convert(reply, tuple[Any, list[Any], Any, bool])
    except ValueError:
        raise offer.fault(f"gave {reply!r}, expected an EngineAnswer") from None
    if not optimized or optimized != list(objectives[: len(optimized)]):
        raise offer.fault(
            f"looked at {optimized!r}, expected the first of {', '.join(objectives)}, or more of them"
        )
    tree = None if units is None else offer.tree_of_reply(units, len(problem.network))
    return EngineAnswer(offer.name, objectives[: len(optimized)], tree, finished)
