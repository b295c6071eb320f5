"""Presolve of a question: an incumbent, a lower bound, and the units that a better tree can have.

A :class:`Gap` is passed from stage to stage (:mod:`greedy_stages`, :mod:`relaxation_stages`); each stage
makes it smaller.
"""

import math
from collections.abc import Callable, Collection, Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext, suppress
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

from foon_asp.garbage_collection import without_garbage_collection
from foon_asp.hypergraph import greedy_stages as greedy
from foon_asp.hypergraph import tuning
from foon_asp.hypergraph.exact_costs import CoarseCosts, ExactCosts, TooFineError
from foon_asp.hypergraph.extension import actions_of_extensions, extend_tree
from foon_asp.hypergraph.gap_bounded_subproblem import Subproblem
from foon_asp.hypergraph.goal_graph import graph_of
from foon_asp.hypergraph.h_values import compute_h_values
from foon_asp.hypergraph.incumbent_gap import Gap, Stage
from foon_asp.hypergraph.incumbent_trees import irredundant_subset
from foon_asp.hypergraph.landmark_cuts import Cuts
from foon_asp.hypergraph.reduced_cost_fixing import neighbourhood
from foon_asp.hypergraph.reductions import ALL, Reduction
from foon_asp.hypergraph.restricted_subproblem import restricted_subproblem
from foon_asp.hypergraph.solved_goals import SolvedGoals, can_use_solved_goals
from foon_asp.hypergraph.task import Task
from foon_asp.hypergraph.tuning import PresolveTuning
from foon_asp.problem import Objective, Problem

if TYPE_CHECKING:  # few questions need it
    from foon_asp.hypergraph.cost_partition import CostPartition
    from foon_asp.hypergraph.proof_tree import Cases

Expired = Callable[[], bool]
Guard = Callable[[], AbstractContextManager[object]]
HValues = Mapping[int, int]
Stages = Callable[[Task, Gap, HValues], Stage]


class Course(NamedTuple):
    """The stages to run after a first tree was found.

    ``near_goals``: the stages for a large network, of which only a part near the goals was looked at.
    ``whole``: the stages for any other network.
    """

    near_goals: Stages
    whole: Stages


class Reduced(NamedTuple):
    """A presolved question.

    ``tree``: the units of the incumbent; ``None`` if there is no tree.
    ``units``: the units of the incumbent, ascending. If not ``settled``, the units that a better tree can
    have are included.
    ``settled``: whether the incumbent is proved optimal.
    ``costs``: the exact costs; ``None`` if rates are too fine.
    ``bound``: a lower bound on the cost of every tree; 0 if rates are too fine.
    ``cuts``: the greedy cost partition with the greatest bound, over the units that remained when it was
    found; ``None`` if no greedy partition was found.
    ``interrupted``: whether ctrl-C ended the reduction, or time was up before any reduction. Then ``units``
    must not be used.
    ``subproblem``: the gap-bounded subproblem, which is valid under any rules on trees; ``None`` if no cuts
    were found.
    ``partition``: the last optimal cost partition that raised the bound; ``None`` if none raised it.
    ``cases``: the actions branched on, as nested cases; ``None`` without branching.
    ``tight``: the tight cuts of the LP solutions by which units were excluded, over the units that remained.
    """

    tree: frozenset[int] | None
    units: tuple[int, ...]
    settled: bool
    costs: ExactCosts | None
    bound: int
    cuts: Cuts | None
    interrupted: bool = False
    subproblem: Subproblem | None = None
    partition: "CostPartition | None" = None
    cases: "Cases" = None
    tight: Collection[frozenset[int]] = ()


class Listener:
    """Observer of incumbents and bounds; its methods do nothing unless overridden."""

    def tree(self, units: frozenset[int]) -> None:
        """Receive the units of a new incumbent."""

    def bound(self, costs: ExactCosts, bound: int) -> None:
        """Receive a greater lower bound on the cost of all trees, in the units of ``costs``."""


class Bounds(Listener):
    """Observer that passes on bounds but no trees, since the trees may break rules."""

    def __init__(self, listener: Listener) -> None:
        self._listener = listener

    def bound(self, costs: ExactCosts, bound: int) -> None:
        """Pass on a lower bound on the cost of all trees."""
        self._listener.bound(costs, bound)


def reduce(
    problem: Problem,
    objectives: Sequence[Objective],
    reductions: Collection[Reduction] = ALL,
    expired: Expired = lambda: False,
    listener: Listener | None = None,
    guard: Guard = nullcontext,
    solved: SolvedGoals | None = None,
) -> Reduced:
    """Reduce a problem to the units that a search for the best tree still has to look at.

    ``objectives``: the list as it is optimized, with ``units`` in it, so that every unit costs something.
    ``reductions``: the reductions to make. If empty, all relevant units that can be executed remain.
    ``expired``: returns whether time is up.
    ``listener``: receives trees and bounds.
    ``guard``: returns a context in which computations are interrupted when time is up, as by ctrl-C.
    ``solved``: answers to questions that differ only in goals and removed units. They speed up this question,
    and its answer is added to them. They are ignored if :func:`can_use_solved_goals` returns false.

    Raises ``KeyboardInterrupt`` if it is interrupted before there is a tree. A later interruption is caught,
    and recorded in the result.
    """
    with without_garbage_collection():
        with guard():
            presolve = _Presolve(_task_of(problem, objectives, reductions, expired), listener, guard)
        if solved is None or not can_use_solved_goals(presolve.task):
            presolve.extend_or_run()
        else:
            presolve.run_with_solved_goals(solved)
        return presolve.result()


def reduce_under_rules(
    problem: Problem,
    objectives: Sequence[Objective],
    reductions: Collection[Reduction] = ALL,
    expired: Expired = lambda: False,
    listener: Listener | None = None,
    guard: Guard = nullcontext,
    redundant: bool = False,
    course: Course | None = None,
) -> Reduced:
    """Reduce a problem whose trees have to keep to user rules, without knowing the rules.

    ``subproblem`` and ``bound`` of the result are valid under any rules; its ``tree`` may break them.

    ``redundant``: whether trees may have units that lead to no goal.
    ``course``: the stages to run; ``None`` for :data:`ROUNDS`. :data:`BOUND` is enough for a caller that
    needs no particular tree. Other arguments are those of :func:`reduce`.
    """
    presolve_tuning = tuning.PRESOLVE._replace(branching_budget=0, landmark_actions=math.inf)
    with without_garbage_collection():
        with guard():
            task = _task_of(problem, objectives, reductions, expired, presolve_tuning)
            presolve = _Presolve(task, listener, guard, redundant)
        presolve.run(course or ROUNDS)
        return presolve.result(redundant)


def h_add_tree(problem: Problem, objectives: Sequence[Objective]) -> frozenset[int] | None:
    """Return the units of a tree that follows h_add, without proof; it is usually near the optimum.

    ``objectives`` are those of :func:`reduce`. Returns ``None`` if there is no tree. Raises
    ``KeyboardInterrupt`` if it is interrupted.
    """
    reduced = reduce_under_rules(problem, objectives, course=Course(_follow_h_add, _follow_h_add))
    if reduced.interrupted:
        raise KeyboardInterrupt
    return reduced.tree


def reduce_at_costs(
    subproblem: Subproblem,
    objectives: Sequence[Objective],
    costs: ExactCosts,
    expired: Expired,
    known_tree: Collection[int] = (),
    below: int = 0,
    max_actions: float = math.inf,
) -> Reduced:
    """Reduce a gap-bounded subproblem under other ``costs``.

    ``known_tree``: the units of a tree that may become the first incumbent; empty for none.
    ``below``: a cost; 0 for none. With it, two kinds of units remain: those of trees that cost less than it,
    and those of trees better than the incumbent.
    ``max_actions``: a number of actions, used only with ``below``. If more remain, and the first cuts exclude
    hardly any action, the reduction ends after these cuts.

    Interruptions are treated as by :func:`reduce`.
    """
    presolve_tuning = tuning.PRESOLVE._replace(branching_budget=0, landmark_actions=math.inf)
    if below:  # clingo gets the remaining actions with an incumbent
        presolve_tuning = presolve_tuning._replace(relaxed_actions=presolve_tuning.easy_actions)
    reductions = {Reduction.DEAR, Reduction.BOUNDS} if below else ALL
    with without_garbage_collection():
        task = _task_of(subproblem.problem, objectives, reductions, expired, presolve_tuning)
        task = replace(task, costs=costs, coarse_costs=costs, below=below, scope=subproblem.remaining)

        def fix_before_rounds(task: Task, gap: Gap, h_values: HValues) -> Stage:
            """Exclude candidates above the cutoff first, and run all rounds only if few enough remain.

            If ``below`` is 0, or there are at most ``max_actions`` candidates, all rounds are run at once.
            """
            if below and len(gap.candidates) > max_actions:
                before = len(gap.candidates)
                gap, cuts = greedy.raise_bound(task, gap, h_values, greedy.h_max_guide(task, gap))
                gap = greedy.fix_candidates(task, gap, cuts)  # the cutoff does not depend on the incumbent
                yield gap
                if len(gap.candidates) > max(max_actions, task.tuning.worthwhile_share * before):
                    return gap
                h_values = compute_h_values(task.graph, gap.candidates, costs, h_add=False).h_objects
            return (yield from run_rounds(task, gap, h_values))

        presolve = _Presolve(task, None, nullcontext)
        presolve.run(Course(run_near_goals, fix_before_rounds), subproblem.tree_actions(known_tree))
        return presolve.result(subproblem.redundant)


def _task_of(
    problem: Problem,
    objectives: Sequence[Objective],
    reductions: Collection[Reduction],
    expired: Expired,
    presolve_tuning: PresolveTuning | None = None,
) -> Task:
    """Return the task of reducing a problem, with its graph and rough costs, but without exact costs.

    ``presolve_tuning``: the numbers that steer the stages; ``None`` for the usual ones.
    """
    presolve_tuning = presolve_tuning or tuning.PRESOLVE
    graph, coarse = graph_of(problem, objectives), CoarseCosts(problem, objectives[0])
    return Task(
        problem,
        tuple(objectives),
        frozenset(reductions),
        expired,
        graph,
        graph.thin(presolve_tuning.required_achievers, coarse),
        coarse,
        presolve_tuning,
        range(len(graph.needs)),
    )


def _with_costs(task: Task, actions: Collection[int]) -> Task:
    """Return the task with exact costs of ``actions``.

    If it has exact costs already, or rates are too fine for them, it is returned unchanged.
    """
    if task.costs is None:
        with suppress(TooFineError):
            return replace(task, costs=ExactCosts(task.problem, task.objectives, actions))
    return task


def run_rounds(task: Task, gap: Gap, h_values: HValues) -> Stage:
    """Repeat rounds of landmark cuts, search for trees and pruning, until a tree is proved optimal.

    If a round excludes few candidates, the linear relaxation and branching follow. If nothing has changed
    then, better trees are looked for thoroughly in one more round. Ends when that changes nothing either, or
    when time is up. Without exact costs, a round only prunes. Yields each gap that it reaches.
    """
    costs, limits = task.costs, task.tuning
    if costs is not None and len(gap.candidates) > limits.easy_actions:
        gap = greedy.follow_h_add(task, gap)
        yield gap
    if costs is not None and costs.has_limit:  # any tree below the limit will do
        gap = greedy.search_neighbourhood(task, gap, greedy.NO_CUTS, thorough=False)
        gap = gap.as_proved() if greedy.is_proved_by(task, gap, greedy.NO_CUTS) else gap
        yield gap
    thorough = False  # as a last resort
    while not gap.proved:
        before = gap
        if costs is not None and task.reductions & {Reduction.BOUNDS, Reduction.DEAR}:
            guide = greedy.h_max_guide(task, gap)
            gap = yield from greedy.tighten(task, gap, h_values, guide, thorough)
        if gap.proved or task.expired():
            return gap
        gap = greedy.prune_dominated(task, gap)
        if not _has_changed(gap, before):
            gap = greedy.prune_by_landmarks(task, gap)
        yield gap
        slow = len(gap.candidates) > max(
            limits.neighbourhood_actions, limits.worthwhile_share * len(before.candidates)
        )  # another turn would bring little
        if (slow or not _has_changed(gap, before)) and costs is not None and not thorough:
            gap = yield from _tighten_by_relaxation(task, gap)
            if gap.proved:
                return gap
        changed = _has_changed(gap, before)
        if not changed and (thorough or len(gap.candidates) <= limits.easy_actions):
            return gap
        thorough = not changed
        h_values = compute_h_values(
            task.graph, gap.candidates, costs or task.coarse_costs, h_add=False
        ).h_objects
    return gap


def _has_changed(gap: Gap, before: Gap) -> bool:
    """Return whether a gap has fewer candidates than the earlier gap ``before``, or another incumbent."""
    return (len(gap.candidates), gap.incumbent) != (len(before.candidates), before.incumbent)


def _tighten_by_relaxation(task: Task, gap: Gap) -> Stage:
    """Tighten the gap by optimal cost partitions, then by branch and bound; yield each gap that it reaches.

    Does nothing if there are few candidates.
    """
    if len(gap.candidates) <= task.tuning.relaxed_actions:
        return gap
    from foon_asp.hypergraph.relaxation_stages import (  # noqa: PLC0415 (few questions need it)
        branch,
        partition_costs,
    )

    gap = yield from partition_costs(task, gap)
    return gap if gap.proved else (yield from branch(task, gap))


def run_near_goals(task: Task, gap: Gap, h_values: HValues) -> Stage:
    """Run the greedy stages once over a large network, then rounds over the remaining candidates.

    The first cuts have no guide, since a guide takes time linear in the number of all actions. Yields each
    gap that it reaches. Raises ``KeyboardInterrupt`` if time is up before any candidate was excluded.
    """
    if task.costs is not None:
        gap = yield from greedy.tighten(task, gap, h_values, None, thorough=False)
    if gap.proved:
        return gap
    if len(gap.candidates) == len(task.graph.needs):
        if task.expired():  # before any reduction
            raise KeyboardInterrupt
        opening = greedy.restrict_to_relevant(task, gap)
        assert opening is not None
        gap, _ = opening
    gap = greedy.prune_dominated(task, gap)
    yield gap
    if not task.expired():
        h_values = compute_h_values(
            task.graph, gap.candidates, task.costs or task.coarse_costs, h_add=False
        ).h_objects
        gap = yield from run_rounds(task, gap, h_values)
    return gap


def _follow_h_add(task: Task, gap: Gap, h_values: HValues) -> Stage:
    """Replace the incumbent as :func:`greedy_stages.follow_h_add` does; yield the gap.

    Does nothing without exact costs. The h-values are not used.
    """
    if task.costs is not None:
        gap = greedy.follow_h_add(task, gap)
        yield gap
    return gap


def _bound_once(task: Task, gap: Gap, h_values: HValues) -> Stage:
    """Raise the lower bound once by landmark cuts; yield the gap.

    Does nothing without exact costs.
    """
    if task.costs is not None:
        gap = greedy.raise_bound(task, gap, h_values, greedy.h_max_guide(task, gap)).gap
        yield gap
    return gap


def _bound_lazily(task: Task, gap: Gap, h_values: HValues) -> Stage:
    """Raise the lower bound once by landmark cuts without a guide; yield the gap.

    A guide would look at all actions. Does nothing without exact costs.
    """
    if task.costs is not None:
        gap = greedy.raise_bound(task, gap, h_values, None).gap
        yield gap
    return gap


ROUNDS, BOUND = Course(run_near_goals, run_rounds), Course(_bound_lazily, _bound_once)


def _first_tree_near_goals(task: Task) -> tuple[Gap, HValues] | None:
    """Find a first tree of a large network among the actions nearest to the goals.

    Most of a large network is too far from the goals for a good tree, and is never looked at. Returns the gap
    with all actions as candidates, and the h_max of each object that was reached.

    Returns ``None`` if the network is small, few actions lead to the goals, or no tree is found. Also returns
    ``None`` if the task has neither the reduction ``bounds`` nor ``dear``.
    """
    size, limits = len(task.graph.needs), task.tuning
    if not task.reductions & {Reduction.BOUNDS, Reduction.DEAR} or size <= limits.lazy_actions:
        return None
    all_actions = range(size)
    nearest = neighbourhood(
        task.thin_graph, all_actions, task.coarse_costs, math.inf, enough=limits.first_actions
    )
    if len(nearest) < limits.first_actions:
        return None
    narrowed = restricted_subproblem(task.thin_graph, nearest, task.coarse_costs, size // 4)
    if narrowed is None:
        return None
    derivations, tree = narrowed
    return Gap(frozenset(tree), 0, all_actions), derivations.h_objects


class _Presolve:
    """A run of the stages of a task.

    ``gap``: the last gap; ``None`` before there is a tree.
    ``ended``: whether the last run ended without an interruption.
    ``redundant``: whether trees may have redundant actions. Then the costs of all actions are needed.
    ``listener``, ``guard``: as for :func:`reduce`.
    """

    def __init__(self, task: Task, listener: Listener | None, guard: Guard, redundant: bool = False) -> None:
        self.task, self.ended, self._redundant = task, False, redundant
        self.gap: Gap | None = None
        self._listener, self.guard = listener or Listener(), guard

    @property
    def bounds_listener(self) -> Listener:
        """A listener for the run of another task whose bounds hold for this task, but whose trees do not."""
        return Bounds(self._listener)

    def run_guarded(self, step: Callable[[], None]) -> None:
        """Run a step under the guard, and record in ``ended`` whether it ended by itself.

        ``KeyboardInterrupt`` ends the step. It is caught if there is a tree, or if the step was complete;
        else it is passed on.
        """
        self.ended = False
        try:
            with self.guard():
                step()
                self.ended = True
        except KeyboardInterrupt:
            if self.gap is None and not self.ended:
                raise

    def run(self, course: Course, known_tree: Collection[int] = ()) -> None:
        """Find a first tree, and run the stages of a course from it, under the guard.

        ``known_tree`` has the actions of a tree that becomes the first incumbent if it is better.
        """
        self.run_guarded(lambda: self._run_course(course, known_tree))

    def _run_course(self, course: Course, known_tree: Collection[int]) -> None:
        """Do what :meth:`run` does, without the guard.

        Trees are compared at rough costs, and the first incumbent is made irredundant. If there is no tree,
        ``gap`` stays ``None``. If the task has no reductions, the stages are not run.
        """
        task, stages = self.task, course.near_goals
        opening = _first_tree_near_goals(task)
        if opening is None:
            opening, stages = greedy.restrict_to_relevant(task, Gap(frozenset(), 0, ())), course.whole
        if opening is None:
            return
        self.gap, h_values = opening
        if task.reductions:
            trees = [self.gap.incumbent, known_tree] if known_tree else [self.gap.incumbent]
            tree = min(trees, key=lambda tree: sum(map(task.coarse_costs, tree)))
            self.report(self.gap.with_incumbent(irredundant_subset(task.graph, tree, task.coarse_costs)))
            self.run_stages(stages, h_values)

    def run_with_solved_goals(self, solved: SolvedGoals) -> None:
        """Run all rounds, interrupted when time is up, and record the resulting gap in ``solved``.

        The rounds begin with the gap that ``solved`` has for these goals, if it has one.
        """

        def run_from_shared_gap() -> None:
            """Run the rounds from the gap of ``solved``, or from a first tree if there is no such gap.

            If ``solved`` has exact costs, the task gets them. At the end, the answer is recorded in
            ``solved``.
            """
            costs = solved.costs
            if costs is not None:
                self.task = replace(self.task, costs=costs)
            gap = solved.gap(self.task)
            if gap is None or costs is None:
                self._run_course(ROUNDS, ())
            else:
                self.report(Gap(gap.incumbent, 0, gap.candidates))
                self.report(gap)
                if not gap.proved:
                    h_values = compute_h_values(self.task.graph, gap.candidates, costs, h_add=False).h_objects
                    self.run_stages(ROUNDS.whole, h_values)
            solved.record(self.task, self.gap)

        self.run_guarded(run_from_shared_gap)

    def extend_or_run(self) -> None:
        """Extend trees for the goals alone, so that they have a unit of each required set, or run all rounds.

        The rounds are run if extending leads to no gap. Nothing is extended without required sets, or without
        the reduction ``dear``.
        """
        restriction = self.task.problem.restriction
        if restriction is not None and restriction.required and Reduction.DEAR in self.task.reductions:
            _presolve_by_extension(self)
        if self.gap is None:
            self.run(ROUNDS)

    def run_stages(self, stages: Stages, h_values: HValues) -> None:
        """Set exact costs of the task, then run stages from the current gap; report trees and bounds."""
        assert self.gap is not None
        actions = range(len(self.task.graph.needs)) if self._redundant else self.gap.candidates
        self.task = task = _with_costs(self.task, actions)
        for gap in stages(task, replace(self.gap, budget=task.tuning.branching_budget), h_values):
            self.report(gap)

    def report(self, gap: Gap) -> None:
        """Make a gap the current one; report a new incumbent and a greater bound to the listener.

        The bound of the first gap, and bounds without exact costs, are not reported.
        """
        before, self.gap = self.gap, gap
        if before is None or gap.incumbent is not before.incumbent:
            self._listener.tree(self._units(gap.incumbent))
        if self.task.costs is not None and before is not None and gap.lower_bound > before.lower_bound:
            self._listener.bound(self.task.costs, gap.lower_bound)

    def _units(self, actions: Collection[int]) -> frozenset[int]:
        """Return the units among actions."""
        return frozenset(a for a in actions if a < self.task.graph.units)

    def result(self, redundant: bool = False) -> Reduced:
        """Return the result; ``redundant`` tells whether trees of its subproblem may be redundant.

        If the gap is proved, or the run was interrupted, the units are only the units of the incumbent.
        """
        task, gap = self.task, self.gap
        if gap is None:
            return Reduced(None, (), False, None, 0, None)
        evidence, tree = gap.evidence, self._units(gap.incumbent)
        units = tree if gap.proved or not self.ended else tree | self._units(gap.candidates)
        subproblem = None
        if evidence.first is not None and task.costs is not None:
            cuts, actions = evidence.first
            subproblem = Subproblem(task.problem, task.graph, actions, task.costs, cuts, redundant)
        return Reduced(
            *(tree, tuple(sorted(units)), gap.proved, task.costs, gap.lower_bound, evidence.cuts),
            *(not self.ended, subproblem, evidence.partition, evidence.cases, evidence.tight),
        )


def _presolve_by_extension(presolve: _Presolve) -> None:
    """Presolve a question with required sets by its relaxation: the same question without these sets.

    Every tree contains a tree for the goals alone. Its other units are the extension, which costs the
    difference. So the candidates are the actions of cheap trees for the goals and of cheap extensions. If a
    tree costs no more than the best tree for the goals alone, it is optimal. Otherwise all rounds are run
    over the candidates.

    The result is in ``presolve.gap``, which stays ``None`` if the relaxation does not help. Bounds of the
    relaxation are reported, its trees are not.
    """
    task = presolve.task
    graph, restriction = task.graph, task.problem.restriction
    assert restriction is not None
    goals_problem = replace(task.problem, restriction=replace(restriction, required=()))
    goals_task = _task_of(goals_problem, task.objectives, task.reductions, task.expired)
    goals_task = _with_costs(goals_task, range(len(goals_task.graph.needs)))
    goals_presolve = _Presolve(goals_task, presolve.bounds_listener, presolve.guard)
    goals_presolve.run(ROUNDS)
    reduced, gap, costs = goals_presolve.result(), goals_presolve.gap, goals_task.costs
    if costs is None or gap is None or reduced.subproblem is None:
        return
    subproblem, h_values = reduced.subproblem, dict[int, int]()

    def extend() -> None:
        """Extend the best tree for the goals alone, and set the gap of ``presolve``; fill ``h_values``.

        Does nothing if no extension is found. Raises ``KeyboardInterrupt`` if time is up.
        """
        tree = extend_tree(task.thin_graph, gap.incumbent, costs, len(graph.needs) // 4)
        if tree is None:
            return
        incumbent = frozenset(irredundant_subset(graph, tree, costs))
        start = Gap(incumbent, 0, range(len(graph.needs)))
        presolve.report(start)
        if reduced.interrupted:
            raise KeyboardInterrupt
        only_better, total = Reduction.BOUNDS in task.reductions, sum(map(costs, incumbent))
        optimal = gap.proved and incumbent == gap.incumbent if costs.doubt else total == gap.lower_bound
        if only_better and optimal:
            presolve.task = replace(task, costs=costs)
            evidence = gap.evidence._replace(first=None, tight=())
            presolve.gap = start.with_bound(gap.lower_bound, evidence).as_proved()
            return
        limit = total - only_better
        candidates = {*subproblem.actions_within(limit, task.expired), *incumbent}
        distance = limit - gap.lower_bound + costs.doubt
        candidates |= actions_of_extensions(graph, candidates, costs, distance, task.expired)
        if task.expired():
            raise KeyboardInterrupt
        derivations = compute_h_values(graph, candidates, task.coarse_costs, h_add=False)
        h_values.update(derivations.h_objects)
        presolve.gap = start.with_candidates(graph.cone(derivations.h_actions)[0])

    presolve.run_guarded(extend)
    if presolve.gap is not None and presolve.ended and not presolve.gap.proved:
        presolve.run_guarded(lambda: presolve.run_stages(run_rounds, h_values))
