"""From one question to one row of results, whatever happens on the way."""

import time

from foon_asp.asp import Outcome, Settings, solve
from foon_asp.asp.assembly import asks_of_all
from foon_asp.batch.asked import Asked, Asker
from foon_asp.dataset.nearby_optimum import near_goals, solve_nearby
from foon_asp.deadline import Deadline, LimitError
from foon_asp.document.json_document import costs_json, figures_json
from foon_asp.errors import UserError
from foon_asp.problem import parse_objectives

Row = dict[str, object]


def answer_row(
    asker: Asker, asked: Asked, memory_limit: int | None = None, how: Settings | None = None
) -> Row:
    """Answer a question; an error, of the user's or ours, is a row too.

    Trees in rows were simulated, and are given by unit ids in an order that executes. docs/batch.md
    describes the keys. ``how`` has the rules of the user's. ``memory_limit`` is in bytes; where a limit
    leaves no tree, ``error`` says which one.
    """
    began = time.perf_counter()
    try:
        deadline = Deadline(asked.time_limit, memory_limit)
        settings = (how or Settings())._replace(deadline=deadline)
        with deadline.watched("reading", late=True):
            problem = asker.problem(asked)
        objectives = parse_objectives([asked.objective], problem.measures)
        near = near_goals(problem, objectives, settings)
        outcome = None if near is None else solve_nearby(near, objectives, settings)
        if outcome is None:
            with deadline.watched("reading", late=True):
                problem = problem.whole if asks_of_all(problem, settings) else problem
                assert problem.goals  # what they can need is read when it is looked at
            outcome = solve(problem, objectives, settings)
        row = _answered(asked, outcome)
    except LimitError as limit:
        row = {**failed_row(asked, f"stopped at {limit.stopped}"), "status": "unknown"}
    except UserError as error:
        row = failed_row(asked, str(error))
    except Exception as error:
        row = failed_row(asked, f"a bug of foon-asp: {type(error).__name__}: {error}")
    row["seconds"] = round(time.perf_counter() - began, 6)
    return row


def failed_row(asked: Asked, error: str | None) -> Row:
    """Give the row of a question without an answer."""
    return {
        **asked.shown(),
        "status": "failed",
        "error": error,
        "proof": None,
        "costs": None,
        "lower_bound": None,
        "units": None,
        "seconds": None,
    }


def _answered(asked: Asked, outcome: Outcome) -> Row:
    network = outcome.problem.network
    error = None if outcome.units or not outcome.stopped else f"stopped at {outcome.stopped}"
    return {
        **failed_row(asked, error),
        "status": str(outcome.status),
        "proof": None if outcome.proof is None else str(outcome.proof),
        "costs": costs_json(outcome.costs),
        "lower_bound": figures_json(outcome.bounds),
        "units": None if outcome.units is None else list(map(network.unit_number, outcome.units)),
    }
