"""The summary of a batch run."""

import statistics
from collections import Counter
from collections.abc import Iterator, Sequence
from typing import Self

from foon_asp.batch.answer_row import AnswerRow
from foon_asp.json_layout import schema_name
from foon_asp.network import counted
from foon_asp.results.document import Document, Unserialized
from foon_asp.results.table import Block


class RunSummary(Document, frozen=True, kw_only=True, tag=schema_name("batch")):
    """The summary of a batch run.

    Attributes:
        questions: The number of questions.
        answered_before: The number of questions answered by an earlier run.
        answered: The number of questions answered by this run.
        statuses: The number of answers by status, of this and the earlier run.
        proofs: The number of answers of this run by kind of proof.
        seconds_median: The median time of an answer of this run; null without one.
        seconds_worst: The greatest time of an answer of this run; null without one.
        seconds: The time of this run.
    """

    questions: int
    answered_before: int
    answered: int
    statuses: dict[str, int]
    proofs: dict[str, int]
    seconds_median: float | None
    seconds_worst: float | None
    seconds: float

    errors = Unserialized[Sequence[AnswerRow]](())
    """The rows of this run that have an error."""

    @classmethod
    def of(
        cls,
        question_count: int,
        earlier_rows: Sequence[AnswerRow],
        new_rows: Sequence[AnswerRow],
        seconds: float,
    ) -> Self:
        """Return the summary of a run.

        ``earlier_rows`` are the rows of an earlier run, ``new_rows`` those of this run, which took
        ``seconds``.
        """
        durations = [row.seconds for row in new_rows if row.seconds is not None]
        proof_counts = Counter(row.proof for row in new_rows if row.proof is not None)
        summary = cls(
            questions=question_count,
            answered_before=len(earlier_rows),
            answered=len(new_rows),
            statuses=dict(sorted(Counter(row.status for row in (*earlier_rows, *new_rows)).items())),
            proofs=dict(sorted(proof_counts.items())),
            seconds_median=statistics.median(durations) if durations else None,
            seconds_worst=max(durations, default=None),
            seconds=round(seconds, 3),
        )
        return summary.set_unserialized(errors=[row for row in new_rows if row.error is not None])

    def show(self) -> Iterator[Block]:
        """Yield the numbers of answers and proofs, the times, and the first three rows with an error."""
        earlier_text = f", {self.answered_before:,} of them answered before" if self.answered_before else ""
        yield counted(self.questions, "question", ",") + earlier_text
        yield f"in total: {_counts_text(self.statuses, '') or 'none'}"
        if self.answered:
            yield f"answered {self.answered:,} in {self.seconds:.1f} s"
            yield f"proved: {_counts_text(self.proofs, 'by ') or 'none'}"
        if self.seconds_median is not None:
            yield f"seconds for one: median {self.seconds_median:.3f}, worst {self.seconds_worst:.3f}"
        yield from (f"failed: {' + '.join(row.goals)}: {row.error}" for row in self.errors[:3])
        failed = sum(row.status == "failed" for row in self.errors)
        if failed > 3:
            yield f"... and {failed - 3} more failed: see their rows"


def _counts_text(counts: dict[str, int], prefix: str) -> str:
    """Return counts in words: ``3 by clingo, 1 by search``; ``prefix`` is the text before each name."""
    return ", ".join(f"{count:,} {prefix}{name}" for name, count in counts.items())
