"""What a run of clingo gives, on the way and in the end."""

import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import NamedTuple


class ProgramError(Exception):
    """clingo refused a program or an option; ``messages`` are its reasons."""

    def __init__(self, messages: Sequence[str], otherwise: str) -> None:
        super().__init__(otherwise)
        self.messages, self.otherwise = list(messages), otherwise


def asks_for_statistics(options: Sequence[str]) -> bool:
    """Whether options of clingo ask for its statistics."""
    return any(option == "--stats" or re.fullmatch("--stats=[1-9]\\d*", option) for option in options)


class Heard(NamedTuple):
    """An answer: the units in use, the cost vector, and counts of the atoms that were asked for.

    ``rows`` has the arguments of those atoms that have numbers only.
    """

    units: frozenset[int]
    cost: tuple[int, ...]
    atoms: dict[str, Counter[int]]
    rows: dict[str, frozenset[tuple[int, ...]]]


class Ended(NamedTuple):
    """How a search ended: whether it was exhausted, and clingo's statistics as text where asked for."""

    exhausted: bool
    statistics: str = ""


@dataclass
class Run:
    """What a run of clingo ended with.

    ``units`` is the last (best) answer or ``None``, ``cost`` its cost vector as clingo reports it, which
    wraps at 32 bits. ``exhausted`` says that the search space was, so that
    the answer is optimal, or that there is none. ``lower`` holds the proved lower bound of each priority,
    highest first, as far as known. ``atoms`` says for each predicate that was
    asked for how many of its atoms in the answer begin with each number, and ``rows`` what the arguments are
    of those that have numbers only. ``statistics`` are clingo's, as text, where an option asks for them.
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
