"""The proof of a certificate as cases: the leaves of its branching, each with its cuts."""

import math
from collections.abc import Iterable, Mapping
from fractions import Fraction
from typing import Any, Self

from msgspec import UNSET, UnsetType

from foon_asp.json_layout import Json
from foon_asp.problem import Objective, Problem, multiplies
from foon_asp.results.values import Mention, Node, Value
from foon_asp.results.values_of import mention_of, nodes_of


class Choice(Value, frozen=True):
    """A unit, an item of the kitchen or a step of the rules, which a proof branches on or excludes.

    Attributes:
        kind: unit, item or step.
        id: The id of the unit or item; the number of the step, from 0.
        taken: Whether every tree of a case has it (true) or none has it (false). Left out in
            ``dear``.
    """

    kind: str
    id: int
    taken: bool | UnsetType = UNSET


class WeighedCut(Value, frozen=True):
    """A cut, and its weight by the first objective; the weight is null without landmark actions.

    Attributes:
        nodes: The ids of the object nodes of the cut.
        members: The landmark actions: the ids of units that make a node of the cut and need no node of it.
    """

    nodes: tuple[int, ...]
    weight: float | None
    members: tuple[int, ...]


class ProofCase(Value, frozen=True):
    """A leaf of the branching proof.

    Attributes:
        given: The branching decisions: the choices that every tree of this case has, or that none has.
        dear: Choices whose reduced cost is so high that a tree with one of them cannot be better. The case is
            about trees with at least one of them; later cases exclude them.
        ends: The argument that closes the case: a cut that no unit crosses (hopeless), a rule that is broken
            (broken), or weights of cuts that add up to enough (weights).
        paid: The cost of the choices that are taken.
        cuts: The cuts with a weight, or the cut without landmark actions.
    """

    given: tuple[Choice, ...]
    dear: tuple[Choice, ...]
    ends: str
    paid: float
    cuts: tuple[WeighedCut, ...]


class ProofCases(Value, frozen=True):
    """A certificate, the cases of its proof, and the units and object nodes in them.

    Weights and costs are by the first objective, and approximate; for success, they are negative logarithms.
    Nodes that rules of the claim add are left out.

    Attributes:
        cost: The cost of the tree, or the bound; null without either.
    """

    certificate: Json
    cost: float | None
    cases: tuple[ProofCase, ...]
    units: tuple[Mention, ...]
    objects: tuple[Node, ...]

    @classmethod
    def of(cls, problem: Problem, content: Json) -> Self:
        """Return the cases of the proof in a certificate about a problem.

        Cases that take the choice of a branch come before those that exclude it.

        Parameters:
            problem: The problem.
            content: The certificate as plain values.
        """
        network, cases = problem.network, []
        waiting: list[tuple[Json, tuple[Choice, ...]]] = [(content["proof"], ())]
        while waiting:
            subproof, decisions = waiting.pop()
            if "branch" in subproof:
                ((kind, number),) = subproof["branch"].items()
                waiting += (
                    (subproof[branch], (*decisions, Choice(kind, number, branch == "using")))
                    for branch in ("without", "using")
                )
                continue
            above_cutoff = tuple(
                Choice(*kind_and_id) for choice in subproof.get("dear", ()) for kind_and_id in choice.items()
            )
            cases.append(_proof_case(problem, content, subproof, decisions, above_cutoff))
            if "others" in subproof:
                excluded = (Choice(choice.kind, choice.id, False) for choice in above_cutoff)
                waiting.append((subproof["others"], (*decisions, *excluded)))
        nodes = {o for case in cases for cut in case.cuts for o in cut.nodes}
        units = {member for case in cases for cut in case.cuts for member in cut.members}
        for choice in (choice for case in cases for choice in (*case.given, *case.dear)):
            {"unit": units, "item": nodes}.get(choice.kind, set()).add(choice.id)
        return cls(
            content,
            _claimed_cost(content),
            tuple(cases),
            tuple(mention_of(network, unit) for unit in sorted(units) if unit < len(network)),
            nodes_of(network, sorted(o for o in nodes if o < len(network.objects))),
        )


def _proof_case(
    problem: Problem,
    content: Json,
    subproof: Json,
    decisions: tuple[Choice, ...],
    above_cutoff: tuple[Choice, ...],
) -> ProofCase:
    """Return a leaf of the proof as a case.

    ``content`` is the certificate, and ``subproof`` the leaf. ``decisions`` are the choices on the branch to
    the leaf. ``above_cutoff`` are the choices whose reduced cost is too high for a better tree.
    """
    excluded = {choice.id for choice in decisions if choice.kind == "unit" and not choice.taken}
    weights = (
        subproof["weights"]
        if "weights" in subproof
        else [[subproof["hopeless"], None]] * ("hopeless" in subproof)
    )
    cuts = []
    for number, weight in weights:
        nodes = tuple(o for o in content["cuts"][number] if o < len(problem.network.objects))
        members = sorted(_landmark_actions(problem, nodes) - excluded)
        cuts.append(
            WeighedCut(nodes, None if weight is None else _weight_as_float(weight[0]), tuple(members))
        )
    ends = next(key for key in ("hopeless", "broken", "weights") if key in subproof)
    return ProofCase(decisions, above_cutoff, ends, _cost_of_taken(problem, content, decisions), tuple(cuts))


def _landmark_actions(problem: Problem, cut: Iterable[int]) -> set[int]:
    """Return the landmark actions of a cut of node ids.

    These are the units, by id, that make a node of the cut and need no node of it. Making a kitchen item does
    not count.
    """
    inside = frozenset(cut)
    makers = (unit for o in inside - problem.kitchen for unit in problem.makers[o])
    return {unit for unit in makers if inside.isdisjoint(problem.needs[unit])}


def _claimed_cost(content: Json) -> float | None:
    """Return the cost or the bound in a certificate by its first objective, in the unit of the weights.

    ``None`` if no tree exists.
    """
    if content["claim"] == "optimal":
        return _additive_cost(content["objective"][0], content["costs"][0])
    return None if content["bound"] is None else _weight_as_float(content["bound"][0])


def _cost_of_taken(problem: Problem, content: Json, decisions: Iterable[Choice]) -> float:
    """Return the summed cost, by the first objective, of the units and items that are taken by decisions.

    An item costs 1. By the objective ``kitchen``, units cost nothing. The cost is 0 if the certificate has no
    objective.
    """
    if not content["objective"]:
        return 0.0
    name = content["objective"][0]
    chosen = [choice for choice in decisions if choice.taken]
    total = float(sum(choice.kind == "item" for choice in chosen))
    for choice in chosen:
        if choice.kind == "unit" and name != "kitchen":
            total += _additive_cost(name, problem.costs([choice.id]).measures[name])
    return total


def _additive_cost(name: str, cost: Any) -> float:
    """Return a cost by the name of its objective as a float; for success, its negative logarithm."""
    figure = float(Fraction(cost))
    multiplied = name in Objective and multiplies(Objective(name))
    return -math.log(figure) if multiplied else figure


def _weight_as_float(component: str | Mapping[str, str] | Any) -> float:
    """Return a weight in a certificate as a float.

    A weight is an exact number. For success, it is a sum of negative logarithms of rates, given as exponents
    by rate.
    """
    if isinstance(component, Mapping):
        return math.fsum(
            -math.log(Fraction(rate)) * float(Fraction(exponent)) for rate, exponent in component.items()
        )
    return float(Fraction(component))
