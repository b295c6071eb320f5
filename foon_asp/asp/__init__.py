"""The bridge to clingo: facts, programs, searches and their outcome."""

from foon_asp.asp.outcome import Outcome, Proof, Status
from foon_asp.asp.settings import Settings
from foon_asp.asp.solver import Reporter, solve

__all__ = ["Outcome", "Proof", "Reporter", "Settings", "Status", "solve"]
