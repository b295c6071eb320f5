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
    """One question of a batch, as a line of JSON states it, with names and no ids.

    Attributes:
        goal: A goal, or several that one tree makes.
        objective: One objective, or several separated by commas; the first counts most.
        items: Whether items last, or are used up; by default they are used up where amounts of goals are
            stated, and last elsewhere.
        kitchen: A file, or ``@starting`` for the starting kitchen; null for the kitchen of the data.
        stock: Where items are used up: a file of what is in stock.
        stays: Where items are used up: a file of what stays.
        time_limit: The time limit in seconds; null for none.
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
        """The goals that one tree makes; a single goal is in a tuple of one."""
        return (self.goal,) if isinstance(self.goal, str) else self.goal

    @property
    def amounts(self) -> tuple[int, ...]:
        """The number of copies wanted of each goal; empty if the question states none."""
        return (self.amount,) if isinstance(self.amount, int) else self.amount or ()


class OpenData(Protocol):
    """Data that a process has opened, and that turn questions into problems."""

    def goals_of_word(self, word: str, containers: ContainerRule, kitchen: str | None) -> Sequence[str]:
        """Return the goals that the word ``@goals`` or ``@makeable`` stands for, in one-line notation.

        ``kitchen``: a file or ``@starting``; ``None`` for the kitchen of the data.
        """

    def items(self, question: BatchQuestion) -> str:
        """Return ``lasting`` or ``used-up``: the value of ``items`` for a question that has none."""

    def problem(self, question: BatchQuestion) -> Problem:
        """Return the problem of a question; raises :class:`UserError` for an unknown goal or kitchen."""


Opener = Callable[[], OpenData]
"""A function that opens the data, once in each worker. It can be pickled and hashed; equal functions open
equal data."""
