"""A planning task as PDDL: STRIPS with action costs, and numeric fluents where copies are counted."""

from collections.abc import Iterator, Mapping

from foon_asp.planning.action_costs import Scale
from foon_asp.planning.planning_task import Action, PlanningTask
from foon_asp.problem import multiplies

DOMAIN = "foon"
AT_HAND = "at-hand"
COPIES = "copies"


def domain_text(task: PlanningTask) -> str:
    """Return the PDDL domain: a constant for each object node, and the actions of the task.

    Actions have no costs if each costs 1. Comments say how items and costs are modelled.
    """
    return "\n".join(_domain_lines(task)) + "\n"


def problem_text(task: PlanningTask) -> str:
    """Return the PDDL problem: the initial state, the goals, and the metric unless each action costs 1."""
    return "\n".join(_problem_lines(task)) + "\n"


def scale_words(scale: Scale) -> str:
    """Return a description of how the costs of an objective were scaled: ``price: times 100, exact``."""
    if multiplies(scale.objective):
        return f"{scale.objective}: -ln of the rates, times {scale.factor}, rounded to whole numbers"
    exact = "rounded to whole numbers" if scale.rounded else "exact"
    return f"{scale.objective}: " + ("" if scale.factor == 1 else f"times {scale.factor}, ") + exact


def items_words(task: PlanningTask) -> str:
    """Return a description of how copies of items are modelled in the task."""
    if task.problem.items is None:
        return "items last, so that no action deletes anything"
    if not task.merged:
        return "copies are counted, but for what never runs out"
    return "the copies of a node are merged into one, so each plan runs, and may be longer than it has to be"


def _domain_lines(task: PlanningTask) -> Iterator[str]:
    """Yield the lines of the domain."""
    network, costed = task.problem.network, not task.costs.unit_cost
    yield f"; A FOON, {task.problem.conditions}: {items_words(task)}."
    yield "; Costs of actions, the most important first:"
    yield from (f";   {scale_words(scale)}" for scale in task.costs.scales)
    yield f"(define (domain {DOMAIN})"
    numeric_fluents = " :numeric-fluents" * bool(task.counted)
    yield f"  (:requirements :strips :typing{numeric_fluents}{' :action-costs' * costed})"
    yield "  (:types item)"
    yield "  (:constants"
    yield from (f"    {name} - item ; {_comment(str(network.objects[o]))}" for o, name in task.names.items())
    yield "  )"
    yield f"  (:predicates ({AT_HAND} ?o - item))"
    functions = [f"({COPIES} ?o - item)"] * bool(task.counted) + ["(total-cost)"] * costed
    if functions:
        yield f"  (:functions {' '.join(functions)} - number)"
    for action in task.actions:
        yield f"  (:action {action.name}"
        yield "    :parameters ()"
        yield f"    :precondition {_availability_condition(task, task.flow(action).asks)}"
        yield f"    :effect {_effect(task, action, costed)})"
    yield ")"


def _problem_lines(task: PlanningTask) -> Iterator[str]:
    """Yield the lines of the problem."""
    yield f"(define (problem {DOMAIN}-goal)"
    yield f"  (:domain {DOMAIN})"
    yield "  (:init"
    yield from (f"    ({AT_HAND} {task.names[o]})" for o in task.start if o not in task.counted)
    yield from (f"    (= ({COPIES} {task.names[o]}) {count})" for o, count in task.counted.items())
    if not task.costs.unit_cost:
        yield "    (= (total-cost) 0)"
    yield "  )"
    yield f"  (:goal {_availability_condition(task, task.wanted)})"
    if not task.costs.unit_cost:
        yield "  (:metric minimize (total-cost))"
    yield ")"


def _availability_condition(task: PlanningTask, copies: Mapping[int, int]) -> str:
    """Return the PDDL condition that these numbers of copies, by node id, are available.

    For a node whose copies are not counted, the number does not matter.
    """
    atoms = [
        f"(>= ({COPIES} {task.names[o]}) {n})" if o in task.counted else f"({AT_HAND} {task.names[o]})"
        for o, n in copies.items()
    ]
    return " ".join(["(and", *atoms]) + ")"


def _effect(task: PlanningTask, action: Action, costed: bool) -> str:
    """Return the PDDL effect of an action: what it adds and consumes and, if ``costed``, its cost."""
    counted, (_, uses, adds) = task.counted, task.flow(action)
    effects = [
        f"(increase ({COPIES} {task.names[o]}) {n})" if o in counted else f"({AT_HAND} {task.names[o]})"
        for o, n in adds.items()
    ]
    effects += [
        f"(decrease ({COPIES} {task.names[o]}) {n})" if o in counted else f"(not ({AT_HAND} {task.names[o]}))"
        for o, n in uses.items()
    ]
    if costed:
        effects.append(f"(increase (total-cost) {action.cost})")
    return " ".join(["(and", *effects]) + ")"


def _comment(text: str) -> str:
    """Return a text on one line of printable ASCII, with escapes, as every PDDL reader accepts it."""
    plain = text.encode("ascii", "backslashreplace").decode()
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in plain)
