"""Second engines: the same questions put to solvers that share nothing with ours, and what to make of it."""

from foon_asp.engines.agreement import ENGINES, DisagreementError, agree, cross_check
from foon_asp.engines.engine import EngineAnswer

__all__ = ["ENGINES", "DisagreementError", "EngineAnswer", "agree", "cross_check"]
