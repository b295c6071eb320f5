"""An engine for unified-planning: cheapest plans of delete relaxations, where they are plans of the problem.

Only whoever uses unified-planning imports this; ``foon_asp.register_engine`` offers it there.
"""

from collections.abc import Iterator
from typing import IO, Any

from unified_planning.engines import (
    Credits,
    Engine,
    LogMessage,
    OptimalityGuarantee,
    PlanGenerationResult,
    SequentialPlanValidator,
    ValidationResultStatus,
)
from unified_planning.engines import PlanGenerationResultStatus as Ended
from unified_planning.engines.mixins import OneshotPlannerMixin
from unified_planning.engines.results import LogLevel
from unified_planning.exceptions import UPException
from unified_planning.io import PDDLWriter
from unified_planning.model import ProblemKind
from unified_planning.plans import ActionInstance, SequentialPlan

from foon_asp.asp import Outcome, Settings, Status
from foon_asp.asp.solver import solve
from foon_asp.deadline import Deadline, LimitError
from foon_asp.errors import UserError
from foon_asp.planning.pddl_outline import PddlOutline
from foon_asp.planning.strips_task import DERIVED, StripsTask
from foon_asp.planning.task_files import read_pddl
from foon_asp.planning.unified import ENGINE

_KIND = (
    ("set_problem_class", "ACTION_BASED"),
    *(("set_typing", each) for each in ("FLAT_TYPING", "HIERARCHICAL_TYPING")),
    *(
        ("set_conditions_kind", f"{each}_CONDITIONS")
        for each in ("NEGATIVE", "DISJUNCTIVE", "EXISTENTIAL", "UNIVERSAL")
    ),
    ("set_conditions_kind", "EQUALITIES"),
    *(("set_effects_kind", each) for each in ("CONDITIONAL_EFFECTS", "FORALL_EFFECTS")),
    *(("set_quality_metrics", each) for each in ("ACTIONS_COST", "PLAN_LENGTH")),
    *(
        ("set_actions_cost_kind", each)
        for each in ("STATIC_FLUENTS_IN_ACTIONS_COST", "INT_NUMBERS_IN_ACTIONS_COST")
    ),
)


class FoonAspPlanner(Engine, OneshotPlannerMixin):  # type: ignore[misc]
    """Finds the cheapest plan of a problem without deletes, and proves that none is cheaper."""

    def __init__(self, **_: object) -> None:
        Engine.__init__(self)
        OneshotPlannerMixin.__init__(self)

    @property
    def name(self) -> str:
        """The name of the engine."""
        return ENGINE

    @staticmethod
    def supported_kind() -> Any:
        """Give the kind of problems that may be asked; deletes are looked at in the problem itself."""
        kind = ProblemKind(version=2)
        for setter, feature in _KIND:
            getattr(kind, setter)(feature)
        return kind

    @staticmethod
    def supports(problem_kind: Any) -> bool:
        """Say whether problems of a kind may be asked."""
        return bool(problem_kind <= FoonAspPlanner.supported_kind())

    @staticmethod
    def satisfies(optimality_guarantee: Any) -> bool:
        """Say that plans are the cheapest."""
        return optimality_guarantee in set(OptimalityGuarantee)

    @staticmethod
    def get_credits(**_: object) -> Any:
        """Give who made the engine, and what it is."""
        words = "Cheapest plans of problems without deletes, proved by answer set programming and cuts."
        return Credits(ENGINE, "The foon-asp developers", "", "", "MIT", words, words)

    def _solve(
        self,
        problem: Any,
        heuristic: object = None,
        timeout: float | None = None,
        output_stream: IO[str] | None = None,
    ) -> Any:
        """Find a cheapest plan: one of the delete relaxation, if the problem has it as a plan, too."""
        if not self.supports(problem.kind):
            return self._ended(Ended.UNSUPPORTED_PROBLEM, "features beyond the kind of problems supported")
        deadline = Deadline(timeout)
        try:
            writer = PDDLWriter(problem)
            domain, task = (
                PddlOutline(kind, text)
                for kind, text in (("domain", writer.get_domain()), ("problem", writer.get_problem()))
            )
            ground = read_pddl(domain, task, deadline)
            outcome = solve(ground.problem(), (ground.objective,), Settings(deadline=deadline))
        except LimitError as limit:
            return self._ended(Ended.TIMEOUT, f"stopped at {limit.stopped}")
        except (UserError, UPException, NotImplementedError) as error:
            return self._ended(Ended.UNSUPPORTED_PROBLEM, str(error) or "what PDDL does not say")
        if outcome.units is None:
            none = Ended.UNSOLVABLE_PROVEN if outcome.status is Status.INFEASIBLE else Ended.TIMEOUT
            return self._ended(none, "no plan, even where nothing is deleted")
        plan = SequentialPlan(list(_instances(problem, writer, outcome)), problem.environment)
        if ground.loses:
            checked = SequentialPlanValidator().validate(problem, plan)
            if checked.status is not ValidationResultStatus.VALID:
                return self._ended(Ended.UNSUPPORTED_PROBLEM, "the cheapest plan without deletes is no plan")
        status = Ended.SOLVED_OPTIMALLY if _best(outcome, ground) else Ended.SOLVED_SATISFICING
        return PlanGenerationResult(status, plan, self.name)

    def _ended(self, status: Any, reason: str) -> Any:
        """Return a result without a plan."""
        return PlanGenerationResult(status, None, self.name, log_messages=[LogMessage(LogLevel.INFO, reason)])


def _best(outcome: Outcome, task: StripsTask) -> bool:
    by = task.objective
    if outcome.status is Status.OPTIMAL or outcome.costs is None:
        return outcome.status is Status.OPTIMAL
    return outcome.bounds.get(by) == outcome.costs.measure(by)


def _instances(problem: Any, writer: Any, outcome: Outcome) -> Iterator[Any]:
    """Give the actions of a plan as unified-planning has them, whatever they are called in PDDL."""
    actions = {writer.get_pddl_name(action).lower(): action for action in problem.actions}
    objects = {writer.get_pddl_name(each).lower(): each for each in problem.all_objects}
    expressions = problem.environment.expression_manager
    for unit in outcome.units or ():
        name = outcome.problem.network.motions[unit]
        if name != DERIVED:
            action, *terms = name.strip("()").split()
            yield ActionInstance(
                actions[action], tuple(expressions.ObjectExp(objects[term]) for term in terms)
            )
