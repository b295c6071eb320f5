"""From one question to one row of results, whatever happens on the way."""

import time
from typing import Literal

import msgspec

from foon_asp.asp import Outcome, Settings, solve
from foon_asp.asp.assembly import asks_of_all
from foon_asp.batch.asked import Asked, Asker
from foon_asp.comparison.rows_file import RowForm
from foon_asp.dataset.nearby_optimum import near_goals, solve_nearby
from foon_asp.deadline import Deadline, LimitError
from foon_asp.document.json_document import costs_json, figures_json
from foon_asp.errors import UserError
from foon_asp.problem import parse_objectives
from foon_asp.proof.used_up_run import used_up_run
from foon_asp.text.json_value import Json


class Exact(msgspec.Struct, frozen=True):
    """An exact number as text, and the nearest float, ``None`` above all of them."""

    exact: str
    approx: float | None


Figures = dict[str, int | Exact | None]
"""What is measured, by the name of the objective."""


class AnswerRow(Asked, frozen=True, kw_only=True):
    """A question with its answer; docs/batch.md describes the fields.

    The tree was simulated, and ``units`` has its unit ids in an order that executes.
    """

    status: Literal["optimal", "infeasible", "feasible", "unknown", "failed"]
    error: str | None = None
    proof: str | None = None
    costs: Figures | None = None
    lower_bound: Figures | None = None
    runs_used_up: bool | None = None
    units: tuple[int, ...] | None = None
    seconds: float | None = None

    @property
    def asked(self) -> Asked:
        """The question alone, which identifies the row."""
        return msgspec.convert(self, Asked, from_attributes=True)


ANSWERS = RowForm(
    "batch-row", msgspec.to_builtins, lambda row: msgspec.convert(row, AnswerRow), lambda row: row.asked
)


def answer_row(
    asker: Asker, asked: Asked, memory_limit: int | None = None, how: Settings | None = None
) -> AnswerRow:
    """Answer a question; an error, of the user's or ours, is a row too.

    ``how`` has the user rules. ``memory_limit`` is in bytes; where a limit leaves no tree, ``error`` says
    which one.
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
        answer = _answer(outcome)
    except LimitError as limit:
        answer = {"status": "unknown", "error": f"stopped at {limit.stopped}"}
    except UserError as error:
        answer = {"status": "failed", "error": str(error)}
    except Exception as error:
        answer = {"status": "failed", "error": f"a bug of foon-asp: {type(error).__name__}: {error}"}
    return _row(asked, answer | {"seconds": round(time.perf_counter() - began, 6)})


def failed_row(asked: Asked, error: str) -> AnswerRow:
    """Return the row of a question without an answer."""
    return _row(asked, {"status": "failed", "error": error})


def _row(asked: Asked, answer: Json) -> AnswerRow:
    return msgspec.convert(msgspec.structs.asdict(asked) | answer, AnswerRow)


def _answer(outcome: Outcome) -> Json:
    problem, units = outcome.problem, outcome.units
    answer = {
        "status": str(outcome.status),
        "error": None if units or not outcome.stopped else f"stopped at {outcome.stopped}",
        "proof": None if outcome.proof is None else str(outcome.proof),
        "costs": costs_json(outcome.costs),
        "lower_bound": figures_json(outcome.bounds),
    }
    if units is None:
        return answer
    return answer | {
        "runs_used_up": used_up_run(problem, problem.tree(units)).runs,
        "units": list(map(problem.network.unit_number, units)),
    }
