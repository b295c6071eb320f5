"""An engine of unified-planning: cheapest plans of delete relaxations that are also plans of the problem.

unified-planning imports this module after ``foon_asp.register_engine`` has registered it.
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
    *(("set_typing", feature) for feature in ("FLAT_TYPING", "HIERARCHICAL_TYPING")),
    *(
        ("set_conditions_kind", f"{feature}_CONDITIONS")
        for feature in ("NEGATIVE", "DISJUNCTIVE", "EXISTENTIAL", "UNIVERSAL")
    ),
    ("set_conditions_kind", "EQUALITIES"),
    *(("set_effects_kind", feature) for feature in ("CONDITIONAL_EFFECTS", "FORALL_EFFECTS")),
    *(("set_quality_metrics", feature) for feature in ("ACTIONS_COST", "PLAN_LENGTH")),
    *(
        ("set_actions_cost_kind", feature)
        for feature in ("STATIC_FLUENTS_IN_ACTIONS_COST", "INT_NUMBERS_IN_ACTIONS_COST")
    ),
)


class FoonAspPlanner(Engine, OneshotPlannerMixin):  # type: ignore[misc]
    """A planner that finds the cheapest plan of a problem without deletes, and proves that none is cheaper.

    A problem with deletes is solved only if the cheapest plan of its delete relaxation is also a plan of the
    problem.
    """

    def __init__(self, **_: object) -> None:
        Engine.__init__(self)
        OneshotPlannerMixin.__init__(self)

    @property
    def name(self) -> str:
        """The name of the engine."""
        return ENGINE

    @staticmethod
    def supported_kind() -> Any:
        """Return the kind of problems that the engine accepts; problems with delete effects are included."""
        kind = ProblemKind(version=2)
        for setter, feature in _KIND:
            getattr(kind, setter)(feature)
        return kind

    @staticmethod
    def supports(problem_kind: Any) -> bool:
        """Whether the engine accepts problems of a kind."""
        return bool(problem_kind <= FoonAspPlanner.supported_kind())

    @staticmethod
    def satisfies(optimality_guarantee: Any) -> bool:
        """Whether the engine gives an optimality guarantee: true for every guarantee of unified-planning."""
        return optimality_guarantee in set(OptimalityGuarantee)

    @staticmethod
    def get_credits(**_: object) -> Any:
        """Return the authors, licence and description of the engine."""
        description = "Cheapest plans of problems without deletes, proved by answer set programming and cuts."
        return Credits(ENGINE, "The foon-asp developers", "", "", "MIT", description, description)

    def _solve(
        self,
        problem: Any,
        heuristic: object = None,
        timeout: float | None = None,
        output_stream: IO[str] | None = None,
    ) -> Any:
        """Return a cheapest plan of the delete relaxation, if it is a plan of the problem as well.

        A result with a plan says whether the plan is proved optimal. Otherwise the status of the result says
        why there is no plan: unsupported, unsolvable or stopped by ``timeout`` (in seconds). If the cheapest
        plan of the delete relaxation is no plan of the problem, the status is unsupported. ``heuristic`` and
        ``output_stream`` have no effect.
        """
        if not self.supports(problem.kind):
            return self._result_without_plan(
                Ended.UNSUPPORTED_PROBLEM, "features beyond the kind of problems supported"
            )
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
            return self._result_without_plan(Ended.TIMEOUT, f"stopped at {limit.stopped}")
        except (UserError, UPException, NotImplementedError) as error:
            return self._result_without_plan(
                Ended.UNSUPPORTED_PROBLEM, str(error) or "what PDDL does not say"
            )
        if outcome.units is None:
            status = Ended.UNSOLVABLE_PROVEN if outcome.status is Status.INFEASIBLE else Ended.TIMEOUT
            return self._result_without_plan(status, "no plan, even where nothing is deleted")
        plan = SequentialPlan(list(_action_instances(problem, writer, outcome)), problem.environment)
        if ground.has_deletes:
            checked = SequentialPlanValidator().validate(problem, plan)
            if checked.status is not ValidationResultStatus.VALID:
                return self._result_without_plan(
                    Ended.UNSUPPORTED_PROBLEM, "the cheapest plan without deletes is no plan"
                )
        status = Ended.SOLVED_OPTIMALLY if _is_optimal(outcome, ground) else Ended.SOLVED_SATISFICING
        return PlanGenerationResult(status, plan, self.name)

    def _result_without_plan(self, status: Any, reason: str) -> Any:
        """Return a result without a plan, with a status and a reason for people."""
        return PlanGenerationResult(status, None, self.name, log_messages=[LogMessage(LogLevel.INFO, reason)])


def _is_optimal(outcome: Outcome, task: StripsTask) -> bool:
    """Whether a plan is proved optimal: by its status, or by a lower bound that equals its cost."""
    objective = task.objective
    if outcome.status is Status.OPTIMAL or outcome.costs is None:
        return outcome.status is Status.OPTIMAL
    return outcome.bounds.get(objective) == outcome.costs.measure(objective)


def _action_instances(problem: Any, writer: Any, outcome: Outcome) -> Iterator[Any]:
    """Yield the actions of a plan as instances of unified-planning, found by their names in its PDDL.

    Actions that derive facts are left out.
    """
    actions = {writer.get_pddl_name(action).lower(): action for action in problem.actions}
    objects = {writer.get_pddl_name(instance).lower(): instance for instance in problem.all_objects}
    expressions = problem.environment.expression_manager
    for unit in outcome.units or ():
        name = outcome.problem.network.motions[unit]
        if name != DERIVED:
            action, *terms = name.strip("()").split()
            yield ActionInstance(
                actions[action], tuple(expressions.ObjectExp(objects[term]) for term in terms)
            )
