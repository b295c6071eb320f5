"""What a run of clingo ended with."""

from dataclasses import dataclass, field


@dataclass
class Run:
    """What a run of clingo ended with.

    ``units`` is the last (best) answer or ``None``, ``cost`` its cost vector as clingo reports it, which
    wraps at 32 bits. ``exhausted`` says that the search space was, so that
    the answer is optimal, or that there is none. ``lower`` holds the proved lower bound of each priority,
    highest first, as far as known.
    """

    units: frozenset[int] | None = None
    cost: tuple[int, ...] = ()
    exhausted: bool = False
    lower: list[int] = field(default_factory=list)
    ground_seconds: float = 0.0
    solve_seconds: float = 0.0
