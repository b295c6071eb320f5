"""Thresholds for the evaluation of rules; they change only its time, never an answer."""

from typing import NamedTuple


class RuleTuning(NamedTuple):
    """Thresholds for the evaluation of rules and measures.

    ``evaluated_units``: the most units in a network for which rules that only remove units are evaluated
    before the search. In a larger network, the search evaluates them for the units near the goals alone. In
    benchmarks/rules.py at 100,000 units, this takes 0.15 s against 0.43 s.
    ``plain_atoms``: the most atoms in a rule of a measure with which it still counts as having few instances.
    ``quick_letters``: the number of letters from which facts and rules of a measure are grounded in another
    process. Clingo grounds shorter texts in a fraction of a second.
    """

    evaluated_units: int = 20_000
    plain_atoms: int = 6
    quick_letters: int = 1_500_000


TUNING = RuleTuning()
