"""The budget of a check: its steps are counted, and a check that takes too many of them is refused."""

from foon_asp.proof.certificate_limits import ALLOWED
from foon_asp.proof.refusal import LimitError


class StepBudget:
    """The number of steps that a check may take.

    ``max_steps``: the number at first.
    ``steps_left``: the number that is left.
    """

    def __init__(self, max_steps: int) -> None:
        self.max_steps = self.steps_left = max_steps

    def spend(self, steps: int) -> None:
        """Count steps of the check; raises :class:`LimitError` if there are too many."""
        self.steps_left -= steps
        if self.steps_left < 0:
            raise LimitError(f"to check it takes more than {self.max_steps:,} steps")

    def spend_on_fractions(self, bits: int, times: int = 1) -> None:
        """Count the steps of ``times`` operations on fractions of ``bits`` bits.

        The steps grow with the square of the bits. Raises :class:`LimitError` if the fractions or the check
        are too long.
        """
        if bits > ALLOWED.sum_bits:
            raise LimitError("its fractions add up to numbers that are too long")
        self.spend(times * (5 + (bits // 512) ** 2))
