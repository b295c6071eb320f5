"""The search for the best tree with clingo: programs, searches, sessions and their outcome."""

from foon_asp.asp.optimum import solve as solve
from foon_asp.asp.outcome import Outcome as Outcome
from foon_asp.asp.outcome import Proof as Proof
from foon_asp.asp.outcome import Status as Status
from foon_asp.asp.settings import Settings as Settings
from foon_asp.asp.solver import Reporter as Reporter
