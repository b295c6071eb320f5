"""The steps of a plan in time: when each is done, by whom, and with which tools."""

from fractions import Fraction

from msgspec import UNSET, UnsetType

from foon_asp.results.values import NumberedStep, Value


class Tool(Value, frozen=True):
    """One copy of a tool or vessel.

    Attributes:
        tool: A label, or a vessel with what is in it.
        number: The number of the copy, from 1.

    Example:
        >>> str(foon_asp.Tool("knife", 2))
        'knife 2'
    """

    tool: str
    number: int

    def __str__(self) -> str:
        return f"{self.tool} {self.number}"


class TimedStep(NumberedStep, frozen=True):
    """A step with its times in seconds, who does it, and with which tools.

    Attributes:
        product: The label of the first node that it makes; null where it makes nothing.
        agent: The number of the agent that does it, from 1; null where nobody has to stand by.
        tools: The copies of tools that it uses and no other step uses meanwhile, in the order of the unit's
            objects.
        after: The numbers, from 1, of the steps that it waits for, since it takes what they make or uses up
            what they need.
        amount: Where items are used up: how many copies of the product it makes, if that is not one.

    Example:
        >>> problem = foon_asp.load().problem("ice")
        >>> tree = foon_asp.solve(problem).tree
        >>> foon_asp.schedule(problem, tree, durations={"twist": 10, "crush": 30}).timetable[1].agent
        1
    """

    product: str | None
    start: Fraction
    end: Fraction
    agent: int | None
    tools: tuple[Tool, ...]
    after: tuple[int, ...]
    amount: int | UnsetType = UNSET

    @property
    def name(self) -> str:
        """The motion and the product: ``crush (ice)``."""
        product = self.product if self.amount is UNSET else f"{self.amount} x {self.product}"
        return f"{self.motion} ({product})" if product else self.motion
