"""Stages over the linear relaxation: optimal cost partitioning, trees that follow it, branch and bound."""

import math
from collections.abc import Collection, Sequence
from dataclasses import replace
from itertools import accumulate

from foon_asp.hypergraph import tuning
from foon_asp.hypergraph.branch_and_bound import Branching
from foon_asp.hypergraph.cost_partition import CostPartition, CostPartitioning
from foon_asp.hypergraph.covering import ROUGH_TOLERANCE
from foon_asp.hypergraph.greedy_stages import prune_dominated, search_repeatedly
from foon_asp.hypergraph.h_values import compute_h_values
from foon_asp.hypergraph.incumbent_gap import Gap, Stage
from foon_asp.hypergraph.incumbent_trees import (
    irredundant_subset,
    perturbation_search,
    trees_by_lp_values,
    trees_by_partition,
)
from foon_asp.hypergraph.landmark_relaxation import PARTS
from foon_asp.hypergraph.reduced_cost_fixing import reduced_cost_fixing
from foon_asp.hypergraph.reductions import Reduction
from foon_asp.hypergraph.task import Task


def partition_costs(task: Task, gap: Gap) -> Stage:
    """Raise the bound by optimal cost partitions, follow LP solutions to trees, and exclude candidates.

    If many candidates were excluded, the relaxation begins anew over the remaining ones. Ends when few
    candidates are excluded, few remain, the gap is proved, time is up, or branching is faster. Yields each
    gap that it reaches.
    """
    costs, graph, limits = task.costs, task.graph, task.tuning
    assert costs is not None
    if not gap.evidence.starting:
        gap = replace(gap, evidence=gap.evidence._replace(starting=_starting_cuts(gap)))
    before = math.inf
    while limits.relaxed_actions < len(gap.candidates) < limits.worthwhile_share * before:
        before, almost_closed, starting = len(gap.candidates), False, gap.evidence.starting
        partitioning = CostPartitioning(graph, graph.goals, gap.candidates, costs, task.expired, starting)
        while True:
            partition = partitioning.advance(task.incumbent_cost(gap), tuning.RELAXATION.stalled_solutions)
            if partition is None:
                return gap
            if partitioning.converged:
                break
            gap = yield from follow_solution(task, gap, partition, limits.search_looks)
            almost_closed = (
                may_branch(task, gap) and gap.lower_bound > task.incumbent_cost(gap) * limits.sufficient_bound
            )
            if gap.proved or almost_closed or len(gap.candidates) < limits.worthwhile_share * before:
                break
        if not gap.proved:
            gap = yield from follow_solution(task, gap, partition, limits.search_looks)
        if gap.proved or almost_closed or task.expired():
            break
    return gap


def _starting_cuts(gap: Gap) -> tuple[frozenset[int], ...]:
    """Return the cuts of the greedy cost partition to begin the relaxation with, each by its objects.

    Large landmarks are weak and make the LP slow. So cuts with small landmarks are returned first, and the
    sum of the sizes is limited.
    """
    cuts = gap.evidence.cuts.cuts if gap.evidence.cuts else []
    budget = tuning.RELAXATION.starting_landmarks * len(gap.candidates)
    smallest_first = sorted(cuts, key=lambda cut: len(cut.members))
    sizes = accumulate(len(cut.members) for cut in smallest_first)
    return tuple(cut.objects for cut, size in zip(smallest_first, sizes, strict=True) if size <= budget)


def follow_solution(task: Task, gap: Gap, partition: CostPartition, looks: int) -> Stage:
    """Look for better trees that follow an LP solution, then apply its cost partition.

    Better trees are looked for in one of two ways. If the LP solution and its trees use few actions, branch
    and bound is run over the used actions. Otherwise, a perturbation search is run. Neither is run if the
    bound of the partition reaches the cost of the incumbent. ``looks`` is the budget: how often each
    candidate may be looked at. Yields each gap that it reaches.
    """
    costs, graph = task.costs, task.graph
    assert costs is not None
    used = {
        action for action, lp_value in partition.lp_values.items() if lp_value > ROUGH_TOLERANCE
    } | gap.incumbent
    for tree in trees_by_partition(graph, gap.candidates, costs, partition):
        used |= tree
        if task.is_better(tree, gap):
            gap = gap.with_incumbent(tree)
            yield gap
    rounded_bound, count = -(-partition.bound // PARTS), len(gap.candidates)
    if rounded_bound < task.incumbent_cost(gap) and len(used) <= task.tuning.sparse_share * count:
        cuts = [cut for cut, _ in partition.cuts]
        gap = yield from search_among(task, gap, used, cuts, 2 * looks * count)
    elif rounded_bound < task.incumbent_cost(gap):
        tree = perturbation_search(
            *(graph, gap.candidates, set(gap.incumbent), costs, rounded_bound, task.expired),
            *(partition.lp_values, task.random_source.random, looks),
        )
        gap = gap.with_incumbent(tree) if task.is_better(tree, gap) else gap
    gap = apply_partition(task, gap, partition)
    yield gap
    return gap


def apply_partition(task: Task, gap: Gap, partition: CostPartition) -> Gap:
    """Raise the bound by a cost partition, exclude candidates by reduced costs, and prune dominated ones.

    The bound is rounded up, since costs are whole numbers. The gap is marked as proved in one case: the bound
    equals the cost of the incumbent, no cost was rounded, and only better trees are wanted. The partition and
    its tight cuts become evidence. Candidates are excluded only by the reductions of the task.
    """
    costs, total, evidence = task.costs, task.incumbent_cost(gap), gap.evidence
    assert costs is not None
    bound = min(-(-partition.bound // PARTS), total)
    tight = tuple(dict.fromkeys((*evidence.tight, *partition.tight)))
    evidence = evidence._replace(tight=tight, starting=tuple(partition.tight))
    gap = gap.with_bound(
        bound, evidence._replace(partition=partition) if bound > gap.lower_bound else evidence
    )
    if Reduction.DEAR in task.reductions:
        distance = task.cutoff(gap) * PARTS - partition.bound
        reduced_cost = partition.reduced_costs.__getitem__
        gap = gap.with_candidates(
            reduced_cost_fixing(task.graph, gap.candidates, reduced_cost, distance, task.expired)
        )
    gap = prune_dominated(task, gap)
    return gap.as_proved() if task.only_better(gap) and not costs.doubt and bound == total else gap


def search_among(
    task: Task, gap: Gap, actions: Collection[int], cuts: Sequence[frozenset[int]], effort: int
) -> Stage:
    """Look for a better tree among a few actions by branch and bound (sub-MIP heuristic).

    Actions that cannot run without others are left out. ``cuts`` are the cuts to begin with, each by its
    objects. ``effort`` is the budget, in actions looked at. Yields the gap with each better tree. Its bound
    does not change.
    """
    graph, costs = task.graph, task.costs
    assert costs is not None
    runnable = compute_h_values(graph, actions, costs, h_add=False).h_actions
    search = Branching(
        *(graph, graph.goals, runnable, costs, cuts, task.incumbent_cost(gap)),
        lambda lp_values, without: trees_by_lp_values(graph, runnable, costs, lp_values, without),
    )
    for _ in search.search(effort, task.expired):
        tree = irredundant_subset(graph, search.incumbent or gap.incumbent, costs)
        if task.is_better(tree, gap):
            gap = gap.with_incumbent(tree)
            yield gap
    return gap


def may_branch(task: Task, gap: Gap) -> bool:
    """Return whether branching may be used to prove a tree optimal.

    Return ``False`` if costs are rounded or have a limit. Also return ``False`` if equally good trees are
    wanted, or if the budget is used up.
    """
    assert task.costs is not None
    return task.only_better(gap) and not (task.costs.doubt or task.costs.has_limit) and gap.budget > 0


def branch(task: Task, gap: Gap) -> Stage:
    """Branch and bound over the candidates, within the budget of the gap.

    Does nothing if :func:`may_branch` forbids it, or there are few candidates. Also does nothing if the lower
    bound is far below the cost of the incumbent. Better trees are first looked for in the neighbourhood. If
    the search closes all nodes, the gap is marked as proved, and the case split becomes evidence. If it only
    finds a better tree, the last cost partition is applied again. Yields each gap that it reaches.
    """
    costs, graph, limits = task.costs, task.graph, task.tuning
    assert costs is not None
    is_close = gap.lower_bound >= task.incumbent_cost(gap) * limits.branching_bound
    if not may_branch(task, gap) or len(gap.candidates) <= limits.relaxed_actions or not is_close:
        return gap
    gap = yield from search_repeatedly(task, gap)
    total, evidence, candidates = task.incumbent_cost(gap), gap.evidence, gap.candidates
    cuts = [cut.objects for cut in evidence.cuts.cuts] if evidence.cuts else []
    cuts += [objects for objects, _ in evidence.partition.cuts] if evidence.partition else []
    search = Branching(
        *(graph, graph.goals, candidates, costs, cuts, total),
        lambda lp_values, without: trees_by_lp_values(graph, candidates, costs, lp_values, without),
    )
    for _ in search.search(gap.budget, task.expired):
        incumbent = gap.incumbent if search.incumbent is None else search.incumbent
        gap = gap.with_incumbent(incumbent).with_bound(search.bound, evidence)
        yield gap
    gap = replace(gap, budget=search.effort)
    if search.closed:
        proof = evidence._replace(cases=search.cases())
        gap = gap.with_bound(task.incumbent_cost(gap), proof).as_proved()
    elif evidence.partition is not None and task.incumbent_cost(gap) < total:
        gap = apply_partition(task, gap, evidence.partition)
    yield gap
    return gap
