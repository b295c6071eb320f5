"""Thresholds for the evaluation of rules; they change only its time, never an answer."""

from typing import NamedTuple


class RuleTuning(NamedTuple):
    """Thresholds for evaluating rules before the search, and measures without another process.

    ``evaluated_units``: units of a network. In a larger one, rules that only remove units are left to the
    search, which looks at the units near the goals alone. In benchmarks/rules.py at 100,000 units, this takes
    0.15 s against 0.43 s.
    ``plain_atoms``: atoms in a rule of a measure; only with more can its instances be many.
    ``quick_letters``: letters of facts and rules of a measure; clingo grounds fewer in a fraction of a
    second, so that no process of its own is started.
    """

    evaluated_units: int = 20_000
    plain_atoms: int = 6
    quick_letters: int = 1_500_000


TUNING = RuleTuning()
