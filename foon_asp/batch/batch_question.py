"""One question of a batch, and the protocol of the data that pose it."""

from collections.abc import Callable, Sequence
from typing import Annotated, Protocol

from msgspec import Meta

from foon_asp.network import MAX_AMOUNT
from foon_asp.problem import DEFAULT_RULE, ContainerRule, Problem
from foon_asp.results.values import Value

Name = Annotated[str, Meta(min_length=1)]
Goals = Name | Annotated[tuple[Name, ...], Meta(min_length=1)]
Amount = Annotated[int, Meta(ge=1, le=MAX_AMOUNT)]
Amounts = Amount | Annotated[tuple[Amount, ...], Meta(min_length=1)]
Seconds = Annotated[float, Meta(ge=0, le=1e9)]  # at most some thirty years


class BatchQuestion(Value, frozen=True):
    """One question of a batch, by names, as a line of JSON has it.

    Attributes:
        goal: A goal, or several that one tree makes.
        objective: A list by commas of which the first counts most.
        items: Whether items last, or are used up; by default they are used up where amounts of goals are
            stated, and last elsewhere.
        kitchen: A file, or ``@starting``; null for that of the data.
        stock: Where items are used up: a file of what is in stock.
        stays: Where items are used up: a file of what stays.
        time_limit: In seconds.
        amount: How many copies of the goal are wanted, or of each of several goals in their order; null for
            the amounts of the goals file.
    """

    goal: Goals
    objective: Name = "units"
    containers: ContainerRule = DEFAULT_RULE
    items: Name | None = None
    kitchen: Name | None = None
    stock: Name | None = None
    stays: Name | None = None
    time_limit: Seconds | None = None
    amount: Amounts | None = None

    @property
    def goals(self) -> tuple[str, ...]:
        """The goals that one tree makes."""
        return (self.goal,) if isinstance(self.goal, str) else self.goal

    @property
    def amounts(self) -> tuple[int, ...]:
        """The amounts of the goals that are stated, one for each goal or none."""
        return (self.amount,) if isinstance(self.amount, int) else self.amount or ()


class Asker(Protocol):
    """Open data that pose questions as problems, any number of times."""

    def named(self, word: str, containers: ContainerRule, kitchen: str | None) -> Sequence[str]:
        """Return the goals for which the word ``@goals`` or ``@makeable`` stands, in one-line notation."""

    def items(self, question: BatchQuestion) -> str:
        """Return whether items last or are used up; this is the default if the question does not say it."""

    def problem(self, question: BatchQuestion) -> Problem:
        """Pose a question as a problem; raises :class:`UserError` for an unknown goal or kitchen."""


Opener = Callable[[], Asker]
"""A picklable, hashable function that opens the data, once in each worker; equal ones open equal data."""
