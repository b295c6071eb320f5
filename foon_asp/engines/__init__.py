"""Second engines: the same questions put to others than our solver, and what to make of it."""

from foon_asp.engines.agreement import ENGINES, Check, agree, cross_check
from foon_asp.engines.engine import Asked, DisagreementError, EngineAnswer, NotCheckedError

__all__ = [
    "ENGINES",
    "Asked",
    "Check",
    "DisagreementError",
    "EngineAnswer",
    "NotCheckedError",
    "agree",
    "cross_check",
]
