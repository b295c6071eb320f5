"""Results of a run of clingo: answers on the way, and the end of the search."""

import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import NamedTuple


class ProgramError(Exception):
    """The refusal of a program or an option by clingo.

    A program is refused also if clingo would drop an instance of a rule. ``messages`` are clingo's reasons;
    ``otherwise`` is the text of its exception, empty if it raised none.
    """

    def __init__(self, messages: Sequence[str], otherwise: str) -> None:
        """Keep the messages, and the text of clingo's exception."""
        super().__init__(otherwise)
        self.messages, self.otherwise = list(messages), otherwise


def asks_for_statistics(options: Sequence[str]) -> bool:
    """Whether options of clingo request its statistics: ``--stats`` or ``--stats=N`` with N from 1."""
    return any(option == "--stats" or re.fullmatch("--stats=[1-9]\\d*", option) for option in options)


class FoundAnswer(NamedTuple):
    """An answer of clingo.

    ``units``: the numbers of the units in use.
    ``cost``: the cost vector, highest priority first.
    ``atoms``: by name of a requested predicate, the number of its atoms for each first argument.
    ``rows``: by name of a requested predicate, the arguments of its atoms whose arguments are all numbers.
    """

    units: frozenset[int]
    cost: tuple[int, ...]
    atoms: dict[str, Counter[int]]
    rows: dict[str, frozenset[tuple[int, ...]]]


class Ended(NamedTuple):
    """The end of a search: whether the search space is exhausted, and clingo's statistics if requested."""

    exhausted: bool
    statistics: str = ""


@dataclass
class Run:
    """The result of a run of clingo.

    Attributes:
        units: The numbers of the units of the last answer, which is the best; ``None`` if there is no answer.
        cost: The cost vector of the answer as clingo reports it; its numbers wrap at 32 bits.
        exhausted: Whether the whole search space was searched. Then the answer is optimal, or none exists.
        lower: The proved lower bound of each priority, highest first; empty if none is proved.
        atoms: By name of a requested predicate, the number of its atoms in the answer for each first
            argument.
        rows: By name of a requested predicate, the arguments of its atoms whose arguments are all numbers.
        ground_seconds: The time of grounding.
        solve_seconds: The time of the search.
        statistics: Statistics of clingo as text; empty unless an option requests them.
    """

    units: frozenset[int] | None = None
    cost: tuple[int, ...] = ()
    exhausted: bool = False
    lower: list[int] = field(default_factory=list)
    atoms: dict[str, Counter[int]] = field(default_factory=dict)
    rows: dict[str, frozenset[tuple[int, ...]]] = field(default_factory=dict)
    ground_seconds: float = 0.0
    solve_seconds: float = 0.0
    statistics: str = ""
