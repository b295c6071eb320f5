"""Second engines: other solvers that check the answers of foon-asp."""

from foon_asp.engines.agreement import ENGINES, Check, agree, cross_check, find_engines
from foon_asp.engines.engine import Asked, DisagreementError, Engine, EngineAnswer, NotCheckedError, Solve

__all__ = [
    "ENGINES",
    "Asked",
    "Check",
    "DisagreementError",
    "Engine",
    "EngineAnswer",
    "NotCheckedError",
    "Solve",
    "agree",
    "cross_check",
    "find_engines",
]
