"""The best tree for a problem, and its proof."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from fractions import Fraction
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Self

from msgspec import UNSET, UnsetType
from msgspec.structs import replace

from foon_asp.asp import Outcome, Proof, Reporter, Settings, Status
from foon_asp.asp.assembly import ReachOfRules, reach_of_rules
from foon_asp.asp.optimum import solve
from foon_asp.dataset.nearby_optimum import least_with_more, near_goals, solve_nearby
from foon_asp.json_layout import schema_name
from foon_asp.network import counted
from foon_asp.problem import Costs, Objective, Problem, levels
from foon_asp.problem.dead_ends import Cause
from foon_asp.questions.caller import caller
from foon_asp.questions.ending import Ending, ending_of_status
from foon_asp.questions.python_arguments import limited_reading, problem_for_rules, read_deferred
from foon_asp.questions.result import Result
from foon_asp.questions.stand_in import StandIn, stand_in_lines, stand_ins_in
from foon_asp.questions.used_up_note import used_up_note
from foon_asp.questions.why_infeasible import why_infeasible
from foon_asp.results.document import AboutGoals, Unserialized
from foon_asp.results.figure_text import bound_text, costs_text, figure_text
from foon_asp.results.table import Block
from foon_asp.results.values import CostedTree, Figure, ListedConstraint, Node, Step, UsedUpRun, Value
from foon_asp.results.values_of import question_fields, steps_of, used_up_of
from foon_asp.text.tables import Duration
from foon_asp.text.writer import write_units

if TYPE_CHECKING:  # slow to import, and not needed to print an answer
    from foon_asp.certificate import Certificate
    from foon_asp.dataset.nearby import Nearby
    from foon_asp.pictures.drawing import Drawing
    from foon_asp.questions.robot_plan import RobotPlan
    from foon_asp.questions.tree import Tree


class SoftConstraint(ListedConstraint, frozen=True):
    """A rule without a head that may be broken at a price.

    Attributes:
        weight: The price of each way to break it.
        broken: In how many ways the tree breaks it.
    """

    weight: int
    broken: int


class Alone(Value, frozen=True):
    """The best tree for one of several goals by itself.

    Attributes:
        costs: What the best tree for it costs; null without one.
    """

    goal: Node
    status: Status
    costs: Costs | None

    def __str__(self) -> str:
        costs = "" if self.costs is None else f": {costs_text(self.costs)}"
        return f"{self.goal} alone: {self.status}{costs}"


class Serving(Value, frozen=True):
    """The goals that a unit of a tree is needed for.

    Attributes:
        unit: The id of the unit.
        goals: The goals that need it, where each object node comes from the first unit that makes it.
    """

    unit: int
    goals: tuple[Node, ...]


class SkippedGoal(Value, frozen=True):
    """A goal that cannot be made, and was left out.

    Attributes:
        cause: missing: an object node is not in the kitchen, and no unit makes it. cycle: an object node can
            only be made from itself, by way of others.
        object: The object node of the cause, the first on the easiest way to the goal.
        cycle_size: How many object nodes can only be made from each other; 0 for the cause missing.
    """

    goal: Node
    cause: Cause
    object: Node
    cycle_size: int

    def __str__(self) -> str:
        if self.cause is Cause.CYCLE:
            return f"{self.goal}: {self.object} can only be made from itself ({self.cycle_size} in the cycle)"
        missing = "it" if self.object == self.goal else self.object
        return f"{self.goal}: {missing} is not in the kitchen, and no unit makes it"


class EngineCheck(Value, frozen=True):
    """The check of an answer by another engine.

    Attributes:
        package: The package of the engine; null for a built-in one.
        checked: Whether the engine checked the answer.
        agrees_by: The objectives by which the engine finds the tree optimal; empty if no tree exists.
        disagrees: The error in the answer of an engine of another package, or null.
        reason: Why the engine did not check the answer, or null.
    """

    engine: str
    package: str | None
    checked: bool
    agrees_by: tuple[Objective, ...]
    disagrees: str | None
    reason: str | None
    seconds: float


class PolicyTree(Value, frozen=True):
    """A tree that a policy follows, and how long.

    Attributes:
        failures: After how many failed executions the policy goes on with the next tree, or ends.
    """

    failures: int
    tree: CostedTree


class RetryPolicy(Value, frozen=True):
    """Trees to follow one after the other until one is completed, and the chance that one is.

    Each tree begins with what the executions before it have made. An execution succeeds with the rate of its
    unit, whatever happened before; a failed one changes nothing.

    Attributes:
        retries: How many executions may fail in a run that succeeds.
        chance: The chance that the goals are made, by this policy.
        bound: No policy over the units of the trees considered has a greater chance.
        is_exact: Whether some policy, perhaps another one, has exactly the chance ``bound``. If not,
            ``bound`` is the chance that the units which every policy needs fail ``retries`` times at most.
        considered: The number of trees considered: the best one, and the best by success.
    """

    retries: int
    chance: Fraction
    bound: Fraction
    is_exact: bool
    considered: int
    branches: tuple[PolicyTree, ...]

    def lines(self) -> Iterator[str]:
        """Yield a line with the chance and what is proved of it, and a line for each tree."""
        success = figure_text(Objective.SUCCESS, self.chance)
        trees = counted(self.considered, "tree")
        if self.chance == self.bound:
            claim = f"proved that no policy over the units of {trees} has more"
        else:
            bound = figure_text(Objective.SUCCESS, self.bound)
            claim = f"a policy over the units of {trees} has at most {bound}"
            claim += ", which one has that chooses anew at every step" * self.is_exact
        retries = f"{self.retries} retr{'y' if self.retries == 1 else 'ies'}"
        yield f"with {retries}: success {success}; {claim}"
        for number, branch in enumerate(self.branches, 1):
            then = "until" if number == 1 else "then until"
            yield f"  {then} {counted(branch.failures, 'failure')}: {costs_text(branch.tree.costs)}"


class Answer(Result, AboutGoals, frozen=True, kw_only=True, tag=schema_name("answer")):
    """The best task tree, and its proof.

    Attributes:
        encodings: The folder that replaced the built-in encodings, if any: they then define what is best.
        status: optimal: proved best; feasible: stopped at a limit with a tree; infeasible: proved that no
            tree exists; unknown: stopped without a tree.
        stopped: The limit that stopped an unproved answer, and what was being done.
        proof: What proves an optimal or infeasible answer; null for others.
        proof_by_objective: Of an optimal answer, what proves each objective.
        costs: What the tree costs by every objective; null without a tree.
        lower_bound: By objective in order, a proved bound on its best value: no cost is less, no success is
            greater. Only trees count that are best by all earlier objectives.
        used_up: Whether the steps, each done once, run where items are used up; null without a tree, and
            where items are used up anyway.
        units: The steps of the tree, in an order that executes; null without a tree.
        seconds: The time of each phase.
        penalty: Under soft constraints, the sum of all weights, each times the number of ways in which its
            constraint is broken; null without a tree.
        soft_constraints: Every constraint that may be broken; empty without a tree.
        skipped: The goals that cannot be made and were left out, if that was asked for.
        goals_alone: For a few goals, the best tree for each by itself.
        sum_of_goals_alone: What the trees of ``goals_alone`` cost by the first objective, added up, or
            multiplied for success; null if a goal has no tree.
        serves: For several goals, the goals that each unit is needed for.
        cross_check: The checks by other engines, where they are requested.
        policy: With ``--retries``, the trees to follow, and their chance; null without a tree, or if a limit
            came first.
        stand_ins: Of a problem with stand-ins, what is used in place of what; empty without a tree.

    Example:
        >>> answer = foon_asp.solve(foon_asp.load().problem("ice"))
        >>> str(answer.status), answer.costs.units, answer.ids, answer.tree
        ('optimal', 2, (26, 27), <Tree for ice; crushed; in [drinking glass]: 2 units>)
        >>> answer.units[0].motion, str(answer.units[0].inputs[0]), str(answer.units[0].inputs[0].origin)
        ('twist', 'ice; cubed; in [ice cube tray]', 'kitchen')
        >>> answer.text().splitlines()[1]
        'optimal by units (strict containers): 2 units, 6 inputs, success 0.644'
        >>> answer.json()["status"], answer.json_dict()["level"]
        ('optimal', 3)
        >>> answer.foon().count("//"), answer.steps()[0], answer.json_text()[0], answer.remark("foon")
        (3, '{', '{', '')
        >>> answer.drawing().caption[0]
        'Task tree for ice; crushed; in [drinking glass]'
    """

    ROWS = "units"

    encodings: Path | None
    status: Status
    stopped: str | None
    proof: Proof | None
    proof_by_objective: dict[Objective, Proof]
    costs: Costs | None
    lower_bound: dict[Objective, Figure | None]
    used_up: UsedUpRun | None
    units: tuple[Step, ...] | None
    seconds: dict[str, float]
    penalty: int | UnsetType | None = UNSET
    soft_constraints: tuple[SoftConstraint, ...] | UnsetType = UNSET
    skipped: tuple[SkippedGoal, ...] | UnsetType = UNSET
    goals_alone: tuple[Alone, ...] | UnsetType = UNSET
    sum_of_goals_alone: Figure | UnsetType | None = UNSET
    serves: tuple[Serving, ...] | UnsetType = UNSET
    cross_check: tuple[EngineCheck, ...] | UnsetType = UNSET
    policy: RetryPolicy | UnsetType | None = UNSET
    stand_ins: tuple[StandIn, ...] | UnsetType = UNSET

    @classmethod
    def of(cls, outcome: Outcome, bought: Mapping[int, int] = MappingProxyType({}), **fields: Any) -> Self:
        """Return the answer for an outcome of the solver.

        Parameters:
            outcome: The outcome.
            bought: How many copies of each kitchen item were bought, by the id of its object node.
            fields: Further fields of a subclass.
        """
        problem, units, proof = outcome.problem, outcome.units, outcome.proof
        proofs: dict[Objective, Proof] = {}
        if outcome.status is Status.OPTIMAL and proof is not None:
            for objective in levels(outcome.objectives):
                proofs[objective] = Proof.CERTIFICATE if objective in outcome.certified else proof
        answer = cls(
            **question_fields(problem, outcome.objectives),
            encodings=outcome.encodings,
            status=outcome.status,
            stopped=outcome.stopped,
            proof=proof,
            proof_by_objective=proofs,
            costs=outcome.costs,
            lower_bound=dict(outcome.bounds),
            used_up=used_up_of(problem, None if units is None else problem.tree(units)),
            units=None if units is None else steps_of(problem, units, bought),
            seconds={phase: round(seconds, 6) for phase, seconds in outcome.seconds.items()},
            stand_ins=UNSET if problem.stand_ins is None else stand_ins_in(problem, units or ()),
            **fields,
        )
        return answer.set_unserialized(outcome=outcome)

    outcome = Unserialized[Outcome]()
    """The outcome of the solver, with ids."""

    @property
    def problem(self) -> Problem:
        """The problem that was asked about."""
        return self.outcome.problem

    notes = Unserialized[tuple[str, ...]](())
    """Lines about the proof, which are shown behind the steps."""

    certificate = Unserialized["Certificate | None"](None)
    """The certificate that proves the answer, where one was asked for and found."""

    def having(
        self, notes: Iterable[str] = (), certificate: "Certificate | None" = None, **fields: Any
    ) -> Self:
        """Return the answer with changed fields and more notes.

        Parameters:
            notes: More notes.
            certificate: The certificate; without it, the answer keeps the one that it has.
            fields: The fields that change.
        """
        answer = replace(self, **fields)
        certificate = certificate or self.certificate
        attributes = {**self.__dict__, "notes": (*self.notes, *notes), "certificate": certificate}
        return answer.set_unserialized(**attributes)

    @property
    def ids(self) -> tuple[int, ...] | None:
        """The ids of the units in the network, in an order that executes; ``None`` without a tree."""
        return self.outcome.units

    @property
    def claim(self) -> str:
        """A line with the status, objectives and costs of the tree.

        Without a tree, the line says that no tree exists, or what stopped the search.
        """
        noun = "task tree" if self.items == "lasting" else "plan"
        conditions = self.conditions
        if self.encodings is not None:
            conditions += f", as {self.encodings} has it"
        if self.status is Status.INFEASIBLE:
            return f"infeasible: proved that no {noun} exists ({conditions})"
        if self.costs is None:
            limit = self.stopped or "a limit"
            return f"unknown: stopped at {limit}, before any {noun} was found ({conditions})"
        claim = "optimal" if self.status is Status.OPTIMAL else "feasible, not proved best"
        best = ", then ".join(self.objectives)
        return f"{claim} by {best} ({conditions}): {costs_text(self.costs, self.objectives)}"

    def headlines(self) -> list[str]:
        """Return the claim, and for some trees a second line: the note of :func:`used_up_note`."""
        note = [] if self.ids is None else used_up_note(self.problem, self.problem.tree(self.ids))
        return [self.claim, *note]

    def __bool__(self) -> bool:
        """Whether there is a tree."""
        return self.units is not None

    @property
    def tree(self) -> "Tree | None":
        """The tree, in an order that executes; ``None`` without a tree."""
        from foon_asp.questions.tree import Tree  # noqa: PLC0415

        return None if self.ids is None else Tree.of(self.problem, self.ids, self.claim)

    @property
    def ending(self) -> Ending:
        """``LIMIT`` for a tree without the policy that was asked for, else the ending for the status."""
        is_policy_missing = self.policy is None and self.units is not None
        return Ending.LIMIT if is_policy_missing else ending_of_status(self.status)

    def show(self) -> Iterator[Block]:
        """Yield the goals, the claim, the steps and notes; if no tree exists, the reasons for that."""
        yield from (*self.goal_lines(), *self.findings(), *self.notes)

    def findings(self) -> Iterator[Block]:
        """Yield the claim, the remarks and the steps; if no tree exists, the reasons for that.

        For a tree that is not proved best, the bounds follow the remarks. The reasons are searched for
        here, until the deadline of the caller.
        """
        yield from self.headlines()
        yield from self.remarks()
        if self.status is Status.FEASIBLE:
            bounds = [bound_text(objective, bound) for objective, bound in self.outcome.bounds.items()]
            yield f"proved so far: {', '.join(bounds) or 'nothing'}"
        if self.units:
            yield ""
            yield from (line for step in self.units for line in step.lines())
        elif self.units is not None:
            yield "the kitchen already holds it: nothing to do"
        if self.status is Status.INFEASIBLE:
            yield from why_infeasible(self.problem, caller().deadline)

    def remarks(self) -> Iterator[str]:
        """Yield lines on goals left out, shared units, soft constraints, retries and stand-ins, if any."""
        if isinstance(self.skipped, tuple) and self.skipped:
            be = "is" if len(self.skipped) == 1 else "are"
            yield f"{counted(len(self.skipped), 'goal')} cannot be made and {be} left out:"
            yield from (f"  {skipped}" for skipped in self.skipped)
        yield from self._sharing_lines()
        yield from self._penalty_lines()
        if isinstance(self.policy, RetryPolicy):
            yield from self.policy.lines()
        if isinstance(self.stand_ins, tuple) and self.units is not None:
            yield from stand_in_lines(self.stand_ins)

    def _sharing_lines(self) -> Iterator[str]:
        """Yield lines with the costs of each goal by itself, and the units that serve several goals.

        An answer for a single goal has no such lines. If the goals were not solved one by one, a line names
        the option for that. If a goal has no tree by itself, the shared units are left out.
        """
        if not isinstance(self.serves, tuple):
            return
        yield from map(str, self.goals_alone if isinstance(self.goals_alone, tuple) else ())
        if self.costs is None or self.units is None:
            return
        by, total = self.objectives[0], self.sum_of_goals_alone
        shared = {serving.unit: serving.goals for serving in self.serves if len(serving.goals) > 1}
        shared_text = f"{counted(len(shared), 'unit')} shared"
        if total is UNSET:
            yield f"{shared_text}; what each goal costs by itself: --all-goals"
        elif total is None:
            return
        else:
            alone_text, together_text = (
                figure_text(by, measure) for measure in (total, self.costs.measure(by))
            )
            yield f"{by} one by one {alone_text}, together {together_text}; {shared_text}"
        for step in self.units:
            if step.id in shared:
                labels = ", ".join(goal.label for goal in shared[step.id])
                yield f"  {step.motion}    [{step.source[0]}] for {labels}"

    def _penalty_lines(self) -> Iterator[str]:
        """Yield lines with the penalty, and the soft constraints that the tree breaks.

        Without soft constraints or without a tree, yield nothing.
        """
        if not isinstance(self.soft_constraints, tuple) or self.penalty is None:
            return
        all_constraints = counted(len(self.soft_constraints), "soft constraint")
        broken = [constraint for constraint in self.soft_constraints if constraint.broken]
        if not broken:
            is_single = len(self.soft_constraints) == 1
            holding = "the soft constraint holds" if is_single else f"all of {all_constraints} hold"
            yield f"penalty 0: {holding}"
            return
        least = "the least there is" if self.status is Status.OPTIMAL else "not proved least"
        yield f"penalty {self.penalty}, {least}: {len(broken)} of {all_constraints} broken"
        for constraint in broken:
            times = "" if constraint.broken == 1 else f", {constraint.broken} times"
            yield from constraint.lines(f"    (weight {constraint.weight}{times})")

    def foon(self) -> str:
        """Return the tree as FOON text under a comment with the claim; empty without a tree."""
        if self.ids is None:
            return ""
        comments = [f"Task tree for: {' + '.join(map(str, self.goals))}", *self.headlines()]
        return write_units(map(self.problem.network.unit, self.ids), comments, self.problem.amounts)

    durations = Unserialized[Mapping[str, Duration]]({})
    """How long motions take; motions without a stated duration are missing."""

    def robot_plan(self) -> "RobotPlan | None":
        """Return the plan for a robot's program, with the retry policy if there is one.

        Return ``None`` without a tree.
        """
        if self.ids is None:
            return None
        from foon_asp.questions.robot_plan import RobotPlan  # noqa: PLC0415

        policy = None
        if isinstance(self.policy, RetryPolicy):
            ids = self.problem.network.units_of_numbers
            policy = [(ids(branch.tree.ids), branch.failures) for branch in self.policy.branches]
        return RobotPlan.of(self.problem, self.objectives, self.ids, self.durations, policy)

    def remark(self, format_: str) -> str:
        """Return lines on what a format cannot hold: the claim, the remarks, and the notes on the proof.

        The claim is left out if the tree is proved optimal without soft constraints. The remarks are left out
        for ``json``, which has them as fields. Formats of steps get a note if no utensils are known.
        """
        claim, *remarks = self.headlines()
        remarks += self.remarks()
        claims = [] if self.status is Status.OPTIMAL and self.penalty is UNSET else [claim]
        if format_ in {"steps", "steps-csv", "behaviour-tree"} and self.units and not self.problem.utensils:
            remarks.append("note: no utensils are known (--utensils): tools are what a step leaves as it is")
        return "\n".join([*claims, *([] if format_ == "json" else remarks), *self.notes])

    def drawing(self) -> "Drawing | None":
        """Return the drawing of the tree; ``None`` without a tree."""
        return None if self.tree is None else self.tree.drawing()

    def _in_notebook(self) -> dict[str, str]:
        """Return the notebook display by media type: the picture with its claim, or the text."""
        from foon_asp.pictures.notebook import picture_bundle  # noqa: PLC0415

        drawing = self.drawing()
        return super()._in_notebook() if drawing is None else picture_bundle(self, drawing)


class WithAnswer(Result, AboutGoals, frozen=True, kw_only=True):
    """A result that has the best tree, and draws it.

    Attributes:
        answer: The best tree; null without one.
    """

    answer: Answer | None

    def __bool__(self) -> bool:
        """Whether there is a tree."""
        return bool(self.answer)

    def drawing(self) -> "Drawing | None":
        """Return the drawing of the tree; ``None`` without a tree."""
        return None if self.answer is None else self.answer.drawing()


def answer_problem(
    problem: Problem, objectives: Sequence[Objective], settings: Settings, reporter: Reporter | None = None
) -> Answer:
    """Solve a problem; return the answer, with the seconds that reading took, if they are known.

    If ``reporter`` is ``None``, the reporter of the caller is used.
    """
    return _answer_of(solve(problem, objectives, settings, reporter or caller().reporter))


def answer_under_rules(
    problem: Problem, objectives: Sequence[Objective], settings: Settings, reporter: Reporter | None = None
) -> Answer:
    """Solve a problem under user rules, which may be about units that no goal needs.

    Of a large store, no more is read than the answer takes. The first way that works is taken:

    1. :func:`answer_from_store`, if :func:`near_goals` allows it.
    2. For a large store, :func:`solve_nearby_under`. It reads only the units near the goals, and the units
       that the rules require. Its outcome is the answer if it is proved, or if a limit is reached.
    3. :func:`_answer_with_reading`.

    If a limit or ctrl-C stops the third way without a tree, a tree of the second way is the answer. If
    ``reporter`` is ``None``, the reporter of the caller is used.
    """
    nearby = near_goals(problem, objectives, settings)
    if nearby is not None:
        return answer_from_store(nearby, objectives, settings)
    reporter = reporter or caller().reporter
    settings = settings._replace(deadline=settings.effective_deadline)
    outcome = None
    if hasattr(problem, "nearby"):  # of a large store
        from foon_asp.dataset.nearby_under_rules import solve_nearby_under  # noqa: PLC0415

        outcome = solve_nearby_under(problem, objectives, settings, reporter)
    if outcome is not None and (outcome.proof is not None or outcome.stopped):
        return _answer_of(outcome)
    try:
        answer = _answer_with_reading(problem, objectives, settings, reporter)
    except KeyboardInterrupt:
        if outcome is None:
            raise
        settings.effective_deadline.interrupt()
        return _answer_of(outcome._replace(stopped=settings.effective_deadline.stopped))
    if outcome is not None and answer.status is Status.UNKNOWN:  # there is a tree already
        return _answer_of(outcome._replace(stopped=answer.stopped))
    return answer


def _answer_with_reading(
    problem: Problem, objectives: Sequence[Objective], settings: Settings, reporter: Reporter
) -> Answer:
    """Solve a problem; read more than the units that the goals can need only if the answer takes it.

    If no rule looks beyond a tree, the problem over the units that the goals can need is solved first. Any
    tree with other units costs at least a unit more than the optimum without rules. If the first answer costs
    no more than that, it is returned, and no more is read.

    If a limit or ctrl-C stops the reading of all data, the tree found so far is returned as ``FEASIBLE``. The
    optimum without rules is its bound. Without such a tree, the interrupt is raised.
    """
    problem = read_deferred(problem)
    is_partial = problem.network.object_numbers and problem.items is None and settings.constraints
    if is_partial and settings.replaced is None and reach_of_rules(settings) is ReachOfRules.TREE:
        unconstrained = solve(
            problem, objectives, settings._replace(constraints=(), constants=()), Reporter()
        )
        if unconstrained.status is Status.OPTIMAL and unconstrained.costs:
            partial = solve(problem, objectives, settings, Reporter())
            order = levels(tuple(objectives))
            least = least_with_more(unconstrained.costs, order)
            if partial.status is Status.OPTIMAL and partial.costs and partial.costs.key(order) <= least:
                return _answer_of(partial)
            try:
                with settings.effective_deadline.watched(
                    "reading"
                ):  # and not late, since there may be a tree already
                    problem = problem_for_rules(problem, settings, objectives)
            except KeyboardInterrupt:
                if partial.units is None:
                    raise
                settings.effective_deadline.interrupt()
                bounds = {order[0]: unconstrained.costs.measure(order[0])}
                partial = partial._replace(
                    status=Status.FEASIBLE, proof=None, stopped=settings.effective_deadline.stopped
                )
                return _answer_of(partial._replace(bounds=bounds))
    return answer_problem(problem_for_rules(problem, settings, objectives), objectives, settings, reporter)


def answer_from_store(nearby: "Nearby", objectives: Sequence[Objective], settings: Settings) -> Answer:
    """Solve a problem over a large store, and read no more of the store than the proof takes.

    If this gives no answer, for example since no tree exists, all data are read, and
    :func:`answer_under_rules` solves the problem again.
    """
    outcome = solve_nearby(nearby, objectives, settings, caller().reporter)
    if outcome is not None:
        return _answer_of(outcome)
    with limited_reading():
        problem = nearby.full_problem()
    return answer_under_rules(problem, objectives, settings)


def _answer_of(outcome: Outcome) -> Answer:
    """Return the answer for an outcome.

    If the time of reading is known, it is added to the ``seconds`` of the outcome in place.
    """
    read_seconds = caller().read_seconds
    if read_seconds is not None:
        outcome.seconds["read"] = read_seconds
    return Answer.of(outcome)
