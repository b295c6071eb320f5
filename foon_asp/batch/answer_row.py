"""Rows of results: one for each question of a batch, also for a question that fails."""

import time
from typing import Any, Literal

import msgspec
from msgspec.structs import asdict, replace

from foon_asp.asp import Outcome, Settings, solve
from foon_asp.asp.assembly import need_whole_network
from foon_asp.batch.batch_question import BatchQuestion, OpenData
from foon_asp.comparison.rows_file import RowForm
from foon_asp.dataset.nearby_optimum import near_goals, solve_nearby
from foon_asp.deadline import Deadline, LimitError
from foon_asp.errors import UserError
from foon_asp.problem import parse_objectives, with_dissimilarity
from foon_asp.proof.used_up_run import used_up_run
from foon_asp.results.plain_values import costs_by_name, exact_measures, plain, read_plain
from foon_asp.results.values import Figure

Figures = dict[str, Figure | None]
"""Measures by the name of the objective."""


class AnswerRow(BatchQuestion, frozen=True, kw_only=True):
    """A question of a batch, and its answer.

    Attributes:
        error: The error or the limit that left no tree; null if there was none.
        proof: The kind of proof; null if nothing is proved.
        costs: The costs of the tree by objective, and its number of ingredients; a cost that is not known is
            null.
        lower_bound: By objective, the best value that a tree can still have.
        runs_used_up: Whether the tree runs where items are used up; null without a tree, and if that is not
            known.
        units: The unit ids in an order that executes; null without a tree.
        seconds: The time that the answer took.
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
    def question(self) -> BatchQuestion:
        """The question alone, without the answer; it identifies the row."""
        return msgspec.convert(self, BatchQuestion, from_attributes=True)


ANSWERS = RowForm("batch-row", plain, lambda row: read_plain(AnswerRow, row), lambda row: row.question)


def answer_row(
    data: OpenData, question: BatchQuestion, memory_limit: int | None = None, settings: Settings | None = None
) -> AnswerRow:
    """Return the row with the answer of a question; a user error or a bug becomes the status ``failed``.

    ``settings`` have the user rules; their deadline is replaced by one with the time limit of the question.
    ``memory_limit`` is in bytes. If a limit leaves no tree, the field ``error`` names the limit.
    """
    began = time.perf_counter()
    try:
        deadline = Deadline(question.time_limit, memory_limit)
        settings = (settings or Settings())._replace(deadline=deadline)
        with deadline.watched("reading", late=True):
            problem = data.problem(question)
        objectives = parse_objectives([question.objective], problem.measures)
        if problem.stand_ins is not None:
            objectives = with_dissimilarity(objectives)
        nearby = near_goals(problem, objectives, settings)
        outcome = None if nearby is None else solve_nearby(nearby, objectives, settings)
        if outcome is None:
            with deadline.watched("reading", late=True):
                if need_whole_network(problem, settings) or not problem.has_stand_ins_for(objectives):
                    problem = problem.whole
                assert problem.goals  # reads the units that the goals can need
            outcome = solve(problem, objectives, settings)
        row = _row_of_outcome(question, outcome)
    except LimitError as limit:
        row = _row(question, status="unknown", error=f"stopped at {limit.stopped}")
    except UserError as error:
        row = failed_row(question, str(error))
    except Exception as error:
        row = failed_row(question, f"a bug of foon-asp: {type(error).__name__}: {error}")
    return replace(row, seconds=round(time.perf_counter() - began, 6))


def failed_row(question: BatchQuestion, error: str) -> AnswerRow:
    """Return the row of a question that could not be answered, with the status ``failed``."""
    return _row(question, status="failed", error=error)


def _row(question: BatchQuestion, **answer: Any) -> AnswerRow:
    """Return the row of a question with those fields of its answer that are named."""
    return AnswerRow(**asdict(question), **answer)


def _row_of_outcome(question: BatchQuestion, outcome: Outcome) -> AnswerRow:
    """Return the row of a question with the outcome of the solver.

    If there is a tree, the row also says whether it runs where items are used up.
    """
    problem, units = outcome.problem, outcome.units
    row = _row(
        question,
        status=str(outcome.status),
        error=None if units or not outcome.stopped else f"stopped at {outcome.stopped}",
        proof=None if outcome.proof is None else str(outcome.proof),
        costs=None if outcome.costs is None else costs_by_name(outcome.costs),
        lower_bound=exact_measures(outcome.bounds),
    )
    if units is None:
        return row
    runs = used_up_run(problem, problem.tree(units)).runs
    return replace(row, runs_used_up=runs, units=tuple(map(problem.network.unit_number, units)))
