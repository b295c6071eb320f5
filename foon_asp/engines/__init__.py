"""Second engines: other solvers that check the answers of foon-asp."""

from foon_asp.engines.agreement import ENGINES, Check, agreed_objectives, cross_check, find_engines
from foon_asp.engines.engine import (
    ClaimedAnswer,
    DisagreementError,
    Engine,
    EngineAnswer,
    NotCheckedError,
    Solve,
)

__all__ = [
    "ENGINES",
    "Check",
    "ClaimedAnswer",
    "DisagreementError",
    "Engine",
    "EngineAnswer",
    "NotCheckedError",
    "Solve",
    "agreed_objectives",
    "cross_check",
    "find_engines",
]
