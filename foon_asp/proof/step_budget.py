"""The budget of a check: its steps are counted, and a check that takes too many of them is refused."""

from foon_asp.proof.certificate_limits import ALLOWED
from foon_asp.proof.refusal import CheckLimitError


class StepBudget:
    """The number of steps that a check may take.

    ``max_steps``: the number at first.
    ``steps_left``: the number that is left.
    """

    def __init__(self, max_steps: int) -> None:
        self.max_steps = self.steps_left = max_steps

    def spend(self, steps: int) -> None:
        """Subtract steps from those left; raise :class:`CheckLimitError` if they do not suffice."""
        self.steps_left -= steps
        if self.steps_left < 0:
            raise CheckLimitError(f"to check it takes more than {self.max_steps:,} steps")

    def spend_on_fractions(self, bits: int, times: int = 1) -> None:
        """Count the steps of ``times`` operations on fractions of ``bits`` bits.

        The steps of an operation grow with the square of the bits. Raises :class:`CheckLimitError` if the
        fractions are too long or the steps left do not suffice.
        """
        if bits > ALLOWED.sum_bits:
            raise CheckLimitError("its fractions add up to numbers that are too long")
        self.spend(times * (5 + (bits // 512) ** 2))
