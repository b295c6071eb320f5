"""The search for the best tree with clingo: programs, searches and their outcome.

Names are imported at their first use, since reports and settings need no search.
"""

import importlib
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from foon_asp.asp.optimum import solve as solve
    from foon_asp.asp.outcome import Outcome as Outcome
    from foon_asp.asp.outcome import Proof as Proof
    from foon_asp.asp.outcome import Status as Status
    from foon_asp.asp.reporter import Reporter as Reporter
    from foon_asp.asp.settings import Settings as Settings
else:  # not for type checkers, which then know each name
    _MODULES = {"solve": "optimum", "Proof": "outcome", "Status": "outcome"}
    _MODULES |= {name: name.lower() for name in ("Outcome", "Reporter", "Settings")}

    def __getattr__(name: str) -> object:
        if name not in _MODULES:
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        return getattr(importlib.import_module(f"foon_asp.asp.{_MODULES[name]}"), name)
