"""Stages without linear programs: landmark cuts, better trees, reduced-cost fixing, pruning."""

from collections.abc import Callable, Collection, Mapping
from dataclasses import replace
from typing import NamedTuple

from foon_asp.hypergraph.action_landmarks import relevant_given_landmarks
from foon_asp.hypergraph.dominance import undominated_actions
from foon_asp.hypergraph.h_values import compute_h_values
from foon_asp.hypergraph.incumbent_gap import FirstCuts, Gap, Stage
from foon_asp.hypergraph.incumbent_trees import improve_locally, irredundant_subset
from foon_asp.hypergraph.landmark_cuts import Cuts, landmark_cuts
from foon_asp.hypergraph.reduced_cost_fixing import neighbourhood, reduced_cost_fixing, reduced_costs_of
from foon_asp.hypergraph.reductions import Reduction
from foon_asp.hypergraph.task import Task

NO_CUTS = Cuts(0, {}, [])
Guide = Callable[[Callable[[int], int]], Mapping[int, int]]


class Bounded(NamedTuple):
    """A gap, and the landmark cuts over its candidates."""

    gap: Gap
    cuts: Cuts


def raise_bound(task: Task, gap: Gap, h_values: Mapping[int, int], guide: Guide | None) -> Bounded:
    """Find landmark cuts over the candidates, which have to contain a tree, and raise the lower bound.

    ``h_values`` and ``guide`` are those of :func:`landmark_cuts`. The bound is raised at most to the cost of
    the incumbent. The cuts become ``first`` of the evidence if it has no first cuts yet. They become its
    ``cuts`` if no earlier bound is as great. If ctrl-C interrupts the search, the cuts found so far are
    returned.
    """
    costs = task.costs
    assert costs is not None
    max_landmark_actions = task.tuning.landmark_actions * max(task.tuning.easy_actions, len(gap.candidates))
    cuts = landmark_cuts(
        task.graph,
        task.graph.goals,
        gap.candidates,
        costs,
        h_values,
        task.expired,
        guide,
        max_landmark_actions,
    )
    evidence = gap.evidence
    if evidence.first is None and not cuts.interrupted:
        evidence = evidence._replace(first=FirstCuts(cuts, gap.candidates))
    if evidence.cuts is None or cuts.bound > evidence.cuts.bound:
        evidence = evidence._replace(cuts=cuts)
    return Bounded(gap.with_bound(min(cuts.bound, task.incumbent_cost(gap)), evidence), cuts)


def tighten(task: Task, gap: Gap, h_values: Mapping[int, int], guide: Guide | None, thorough: bool) -> Stage:
    """Raise the lower bound by cuts, look for better trees, and exclude candidates by reduced costs.

    Yields the gap after each step. If the cuts prove the incumbent optimal, the gap is marked as proved, and
    no candidates are excluded. Candidates are excluded only if the task has the reduction ``dear``. The
    other arguments are those of :func:`raise_bound` and :func:`search_neighbourhood`. Raises
    ``KeyboardInterrupt`` if the search for cuts was interrupted.
    """
    gap, cuts = raise_bound(task, gap, h_values, guide)
    yield gap
    if cuts.interrupted:
        raise KeyboardInterrupt
    met = is_proved_by(task, gap, cuts)
    if not met and not task.expired():
        improved_gap = search_neighbourhood(task, gap, cuts, thorough)
        met = improved_gap is not gap and is_proved_by(task, improved_gap, cuts)
        gap = improved_gap
        yield gap
    if met:
        gap = gap.as_proved()
    elif Reduction.DEAR in task.reductions and not task.expired():
        gap = fix_candidates(task, gap, cuts)
    yield gap
    return gap


def h_max_guide(task: Task, gap: Gap) -> Guide:
    """Return the guide for landmark cuts: a function from reduced costs to h_max over the candidates."""
    return lambda reduced_cost: (
        compute_h_values(task.graph, gap.candidates, reduced_cost, h_add=False).h_objects
    )


def is_proved_by(task: Task, gap: Gap, cuts: Cuts) -> bool:
    """Return whether cuts prove the incumbent optimal; ``False`` if equally good trees are wanted as well."""
    assert task.costs is not None
    return task.only_better(gap) and task.costs.proves_optimal(cuts, gap.incumbent)


def search_neighbourhood(task: Task, gap: Gap, cuts: Cuts, thorough: bool) -> Gap:
    """Look for a better tree among the candidates of small reduced cost; return the gap with it.

    If no better tree is found, ``gap`` itself is returned. ``thorough`` is as for :func:`improve_locally`.
    """
    costs = task.costs
    assert costs is not None
    reduced_cost = reduced_costs_of(costs, cuts)
    distance, tree = task.incumbent_cost(gap) - cuts.bound, set(gap.incumbent)
    candidates = neighbourhood(
        task.thin_graph, gap.candidates, reduced_cost, distance, enough=task.tuning.neighbourhood_actions
    )
    better = improve_locally(task.graph, candidates | tree, tree, costs, reduced_cost, task.expired, thorough)
    return gap if better is tree else gap.with_incumbent(better)


def search_repeatedly(task: Task, gap: Gap) -> Stage:
    """Search the neighbourhood thoroughly, again and again, until the incumbent stays as it is.

    Also ends when time is up, or when ``branching_budget`` actions were looked at. Yields the gap after each
    search.
    """
    budget, previous = task.tuning.branching_budget, frozenset[int]()
    while gap.incumbent != previous and not task.expired():
        previous = gap.incumbent
        budget -= len(previous) * len(gap.candidates)
        if budget < 0:
            break
        gap = search_neighbourhood(task, gap, gap.evidence.cuts or NO_CUTS, thorough=True)
        yield gap
    return gap


def follow_h_add(task: Task, gap: Gap) -> Gap:
    """Replace the incumbent by an irredundant tree that follows h_add over the candidates, if it is better.

    If the candidates contain no tree, an irredundant subset of the incumbent is tried instead.
    """
    costs = task.costs
    assert costs is not None
    tree = compute_h_values(task.graph, gap.candidates, costs, h_add=True).tree(task.graph, task.graph.goals)
    better = irredundant_subset(task.graph, tree or gap.incumbent, costs)
    return gap.with_incumbent(better) if task.is_better(better, gap) else gap


def fix_candidates(task: Task, gap: Gap, cuts: Cuts) -> Gap:
    """Return the gap without the candidates that reduced-cost fixing by cuts excludes."""
    assert task.costs is not None
    reduced_cost, distance = reduced_costs_of(task.costs, cuts), task.cutoff(gap) - cuts.bound
    return gap.with_candidates(
        reduced_cost_fixing(task.graph, gap.candidates, reduced_cost, distance, task.expired)
    )


def prune_dominated(task: Task, gap: Gap) -> Gap:
    """Return the gap without dominated candidates, if the task has this reduction and exact costs."""
    if task.costs is None or Reduction.DOMINATED not in task.reductions:
        return gap
    return gap.with_candidates(undominated_actions(task.graph, gap.candidates, task.costs))


def prune_by_landmarks(task: Task, gap: Gap) -> Gap:
    """Return the gap without the candidates that action landmarks make irrelevant.

    Returns the same gap if the task lacks this reduction, or if there are many candidates.
    """
    large = len(gap.candidates) > task.tuning.neighbourhood_actions
    if large or Reduction.FORCED not in task.reductions:
        return gap
    return gap.with_candidates(relevant_given_landmarks(task.graph, gap.candidates))


def restrict_to_relevant(task: Task, gap: Gap) -> tuple[Gap, dict[int, int]] | None:
    """Return the gap with all relevant actions that can run as candidates, and the h_max of each object.

    h_max is computed at the rough costs of the task. If the incumbent is empty, the tree that follows h_max
    becomes the incumbent. Returns ``None`` if there is no tree.
    """
    graph = task.graph
    cone, _ = graph.cone(task.scope)
    derivations = compute_h_values(graph, cone, task.coarse_costs, h_add=False)
    tree = derivations.tree(graph, graph.goals)
    if tree is None:
        return None
    candidates: Collection[int] = derivations.h_actions
    if len(candidates) < len(cone):  # others may lead only to actions that cannot run
        candidates = graph.cone(candidates)[0]
    return replace(
        gap, incumbent=gap.incumbent or frozenset(tree), candidates=candidates
    ), derivations.h_objects
