"""What came of a run of many questions, counted as rows come."""

import statistics
from collections import Counter
from collections.abc import Iterable

from foon_asp.batch.answer_row import Row

_SHOWN = 3  # errors, of possibly thousands


class Tally:
    """Counts of rows by status and by what a claim rests on, and the seconds that they took.

    ``before`` are the statuses of rows that were there when the run began. ``errors`` are the first few.
    """

    def __init__(self, before: Iterable[str] = ()) -> None:
        self.before = Counter(before)
        self.statuses: Counter[str] = Counter()
        self.errors: list[str] = []
        self.proofs: Counter[str] = Counter()
        self._seconds: list[float] = []

    def add(self, row: Row) -> None:
        """Count a row."""
        self.statuses[str(row["status"])] += 1
        if row["error"] is not None and len(self.errors) < _SHOWN:
            self.errors.append(f"{row['goal']}: {row['error']}")
        if row["proof"] is not None:
            self.proofs[str(row["proof"])] += 1
        if isinstance(row["seconds"], float):
            self._seconds.append(row["seconds"])

    def summary(self) -> dict[str, object]:
        """Give the counts, and the median and the greatest number of seconds for one question."""
        return {
            "answered_before": self.before.total(),
            "answered": self.statuses.total(),
            "statuses": dict(sorted((self.statuses + self.before).items())),
            "proofs": dict(sorted(self.proofs.items())),
            "seconds_median": statistics.median(self._seconds) if self._seconds else None,
            "seconds_worst": max(self._seconds, default=None),
        }
