"""Provably optimal task trees for FOON, by answer set programming.

>>> import foon_asp
>>> foon = foon_asp.load("data/kitchen")
>>> problem = foon.problem("ice")
>>> answer = foon_asp.solve(problem, "success")
>>> str(answer.status), answer.costs.units
('optimal', 3)

docs/api.md has a function for each question, with examples.
"""

import importlib
from typing import TYPE_CHECKING

from foon_asp.questions.index import INDEX, module_name

if TYPE_CHECKING:
    from foon_asp.asp import Outcome as Outcome
    from foon_asp.asp import Reporter as Reporter
    from foon_asp.asp import Status as Status
    from foon_asp.deadline import Cancel as Cancel
    from foon_asp.deadline import StoppedError as StoppedError
    from foon_asp.errors import BugError as BugError
    from foon_asp.errors import FoonWarning as FoonWarning
    from foon_asp.errors import UserError as UserError
    from foon_asp.foon import Foon as Foon
    from foon_asp.foon import build as build
    from foon_asp.foon import load as load
    from foon_asp.network import FunctionalUnit as FunctionalUnit
    from foon_asp.network import Network as Network
    from foon_asp.network import NetworkBuilder as NetworkBuilder
    from foon_asp.network import ObjectNode as ObjectNode
    from foon_asp.network import Source as Source
    from foon_asp.network import TaskTree as TaskTree
    from foon_asp.planning.unified import register_engine as register_engine
    from foon_asp.problem import ContainerRule as ContainerRule
    from foon_asp.problem import Costs as Costs
    from foon_asp.problem import Fate as Fate
    from foon_asp.problem import Objective as Objective
    from foon_asp.problem import Problem as Problem
    from foon_asp.problem import UsedUp as UsedUp
    from foon_asp.problem.progress import Progress as Progress
    from foon_asp.proof.replay import Copy as Copy
    from foon_asp.proof.simulation import Simulation as Simulation
    from foon_asp.proof.simulation import Verdict as Verdict
    from foon_asp.proof.timetable import TimedStep as TimedStep
    from foon_asp.proof.timetable import Tool as Tool
    from foon_asp.proof.verify import RefusedError as RefusedError
    from foon_asp.questions.alternatives import Alternatives as Alternatives
    from foon_asp.questions.alternatives import alternatives as alternatives
    from foon_asp.questions.answer import Answer as Answer
    from foon_asp.questions.assist import Assistance as Assistance
    from foon_asp.questions.assist import assist as assist
    from foon_asp.questions.certify import Certified as Certified
    from foon_asp.questions.certify import certify as certify
    from foon_asp.questions.check import Checked as Checked
    from foon_asp.questions.check import check as check
    from foon_asp.questions.clash import Clash as Clash
    from foon_asp.questions.clash import clash as clash
    from foon_asp.questions.compare import Compared as Compared
    from foon_asp.questions.compare import compare_searches as compare_searches
    from foon_asp.questions.cross_check import CrossChecked as CrossChecked
    from foon_asp.questions.cross_check import cross_check as cross_check
    from foon_asp.questions.diff import Difference as Difference
    from foon_asp.questions.diff import diff as diff
    from foon_asp.questions.diff_network import Agreement as Agreement
    from foon_asp.questions.diff_network import NetworkDifference as NetworkDifference
    from foon_asp.questions.diff_network import diff_networks as diff_networks
    from foon_asp.questions.draw import Drawn as Drawn
    from foon_asp.questions.draw import draw as draw
    from foon_asp.questions.export import Exported as Exported
    from foon_asp.questions.export import export as export
    from foon_asp.questions.export import to_unified_planning as to_unified_planning
    from foon_asp.questions.menu import Menu as Menu
    from foon_asp.questions.menu import menu as menu
    from foon_asp.questions.optima import Optima as Optima
    from foon_asp.questions.optima import optima as optima
    from foon_asp.questions.pareto import Front as Front
    from foon_asp.questions.pareto import pareto as pareto
    from foon_asp.questions.read_plan import PlanRead as PlanRead
    from foon_asp.questions.read_plan import read_plan as read_plan
    from foon_asp.questions.regret import Regrets as Regrets
    from foon_asp.questions.regret import regret as regret
    from foon_asp.questions.relax import Relaxed as Relaxed
    from foon_asp.questions.relax import relax as relax
    from foon_asp.questions.schedule import Schedule as Schedule
    from foon_asp.questions.schedule import schedule as schedule
    from foon_asp.questions.search import Retrieved as Retrieved
    from foon_asp.questions.search import retrieve as retrieve
    from foon_asp.questions.sensitivity import Sensitivity as Sensitivity
    from foon_asp.questions.sensitivity import sensitivity as sensitivity
    from foon_asp.questions.shopping_list import Shopping as Shopping
    from foon_asp.questions.shopping_list import shopping_list as shopping_list
    from foon_asp.questions.solve import solve as solve
    from foon_asp.questions.solve_soft import SoftAnswer as SoftAnswer
    from foon_asp.questions.solve_soft import solve_soft as solve_soft
    from foon_asp.questions.trace import Traced as Traced
    from foon_asp.questions.trace import trace as trace
    from foon_asp.questions.tree import Tree as Tree
    from foon_asp.questions.units import Units as Units
    from foon_asp.questions.units import units as units
    from foon_asp.questions.verify import VerifiedCertificate as VerifiedCertificate
    from foon_asp.questions.verify import verify as verify
    from foon_asp.questions.view import View as View
    from foon_asp.questions.view import view as view
    from foon_asp.questions.why_not import Explanation as Explanation
    from foon_asp.questions.why_not import why_not as why_not
    from foon_asp.text.duration_list import Duration as Duration
    from foon_asp.text.line_parser import parse_node as parse_node
    from foon_asp.text.reader import FoonReader as FoonReader
    from foon_asp.text.writer import write_units as write_units

__version__ = "0.1.0"

# Where each public name besides the questions lives; a room is imported when a name of it is first asked for.
_ROOMS = {
    "questions.answer": ("Answer",),
    "questions.solve_soft": ("SoftAnswer", "solve_soft"),
    "questions.cross_check": ("CrossChecked", "cross_check"),
    "foon": ("Foon", "build", "load"),
    "questions.export": ("to_unified_planning",),
    "questions.tree": ("Tree",),
    "asp": ("Outcome", "Reporter", "Status"),
    "deadline": ("Cancel", "StoppedError"),
    "errors": ("BugError", "FoonWarning", "UserError"),
    "network": ("FunctionalUnit", "Network", "NetworkBuilder", "ObjectNode", "Source", "TaskTree"),
    "planning.unified": ("register_engine",),
    "problem": ("ContainerRule", "Costs", "Fate", "Objective", "Problem", "UsedUp"),
    "problem.progress": ("Progress",),
    "proof.replay": ("Copy",),
    "proof.simulation": ("Simulation", "Verdict"),
    "proof.timetable": ("TimedStep", "Tool"),
    "proof.verify": ("RefusedError",),
    "text.duration_list": ("Duration",),
    "text.line_parser": ("parse_node",),
    "text.reader": ("FoonReader",),
    "text.writer": ("write_units",),
}
_NAMES = {
    **{name: room for room, names in _ROOMS.items() for name in names},
    **{name: f"questions.{module_name(verb)}" for verb, entry in INDEX.items() for name in entry.python},
}

__all__ = [*_NAMES]  # noqa: PLE0604 (what the catalog has)


def __getattr__(name: str) -> object:
    if name not in _NAMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(importlib.import_module(f"foon_asp.{_NAMES[name]}"), name)


def __dir__() -> list[str]:
    """Give the public names, for completion."""
    return [*__all__, "__version__"]
