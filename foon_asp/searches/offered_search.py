"""Searches that other packages offer; each runs in a process of its own, and its result is validated."""

import functools
from typing import Any

from foon_asp.deadline import Deadline, LimitError
from foon_asp.offered.offer import Offer, Raised
from foon_asp.offered.process import ask_offered
from foon_asp.problem import Problem
from foon_asp.searches.retrieval import Ending, Retrieval
from foon_asp.searches.search_interface import Search, SearchSettings


def offered_search(offer: Offer) -> Search:
    """Return the search that a package offers.

    The package is not imported now; the search runs in a process of its own, which imports it.
    """
    promise = f"what {offer.package} says of it; foon-asp has checked only its tree"
    return Search(offer.name, promise, functools.partial(_retrieve, offer), offer.package)


def _retrieve(offer: Offer, problem: Problem, settings: SearchSettings) -> Retrieval:
    """Return the validated result of an offered search; at a limit, its ending is ``unknown``.

    Raises :class:`UserError` if the search raises an exception, or returns no valid retrieval.
    """
    deadline = Deadline(settings.time_limit, settings.memory_limit)
    try:
        reply = ask_offered(offer, deadline, problem.plain, settings)
    except LimitError:
        return Retrieval(Ending.UNKNOWN)
    if isinstance(reply, Raised):
        raise offer.raised_error(reply)
    return _validate(offer, problem, reply)


def _validate(offer: Offer, problem: Problem, reply: Any) -> Retrieval:
    """Return the retrieval that a search replied with; raises :class:`UserError` if it is not valid.

    ``reply`` has to be a triple of an ending, unit ids and the id of an object. There are units only with the
    ending ``tree``, and an object only with the ending ``stuck``. No unit makes this object, and it is not in
    the kitchen.
    """
    fault = offer.fault(f"gave {reply!r}, expected a Retrieval")
    try:
        ending, units, stuck_at = reply
        ending = Ending(ending)
    except (ValueError, TypeError):
        raise fault from None
    network = problem.network
    tree = offer.tree_of_reply(units, len(network))
    if tree and ending is not Ending.TREE:
        raise offer.fault(f"gave units, and the ending {ending}")
    if (stuck_at is not None) != (ending is Ending.STUCK):
        raise offer.fault(f"gave the ending {ending}, and stuck_at={stuck_at!r}")
    if stuck_at is not None:
        if type(stuck_at) is not int or not 0 <= stuck_at < len(network.objects):
            raise offer.fault(f"is stuck at {stuck_at!r}; objects are 0 to {len(network.objects) - 1}")
        if stuck_at in problem.kitchen or network.producers[stuck_at]:
            raise offer.fault(
                f"is stuck at {network.objects[stuck_at]}, which is in the kitchen or made by a unit"
            )
    return Retrieval(ending, tree, stuck_at)
