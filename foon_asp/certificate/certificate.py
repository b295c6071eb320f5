"""Certificates: JSON that proves a tree optimal, a bound on all trees, or that there is no tree.

docs/dev/certificates.md describes the format. Every certificate returned was accepted by
``foon_asp.proof.verifier``.
"""

import hashlib
from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from typing import Any, NamedTuple

from foon_asp.certificate.arrays import Arrays, fraction_text
from foon_asp.certificate.coverage import NOTHING, Coverage, without_unused_claims
from foon_asp.errors import BugError
from foon_asp.hypergraph.cut import Cut
from foon_asp.hypergraph.lexicographic import Vector
from foon_asp.hypergraph.optimality_proof import CheaperError, Prover
from foon_asp.hypergraph.proof_tree import Broken, Cases, CostFixing, Hopeless, Packing, Proof
from foon_asp.json_layout import json_line
from foon_asp.problem import Costs, Objective, OptionalData, Problem
from foon_asp.proof.certificate_header import TREE_FORM, Form, seal
from foon_asp.proof.certificate_json import read_certificate
from foon_asp.proof.certificate_subject import Subject
from foon_asp.proof.refusal import CheckLimitError, RefusedError
from foon_asp.proof.verified_claim import Verified
from foon_asp.proof.verify_plan import verify_any


class NotBestError(Exception):
    """A tree that was to be proved optimal is not: another tree costs less.

    ``units`` are the units of the other tree, and ``costs`` are its costs.
    """

    def __init__(self, units: tuple[int, ...], costs: Costs) -> None:
        super().__init__("the tree is not the best: another one costs less")
        self.units, self.costs = units, costs


class Certificate(NamedTuple):
    """A verified certificate with its claim.

    ``content``: its JSON.
    ``claim``: ``optimal``, ``bound`` or ``infeasible``.
    ``certified``: the first objectives, as many as the certificate proves. The other objectives rest on the
    solver alone.
    """

    content: dict[str, Any]
    claim: str
    certified: tuple[Objective, ...]

    def text(self) -> str:
        """Return the certificate as JSON text.

        Each key has a line of its own. Each cut, and each weight of a proof without branches, has one as
        well.
        """
        lines = []
        for key, value in self.content.items():
            if key == "cuts" and value:
                value_text = "[\n" + ",\n".join("  " + json_line(cut) for cut in value) + "\n ]"
            elif key == "proof" and isinstance(value, dict) and value.get("weights"):
                pairs = ",\n".join("  " + json_line(pair) for pair in value["weights"])
                other_entries = {
                    name: proof_entry for name, proof_entry in value.items() if name != "weights"
                }
                suffix = "".join(
                    f', "{name}": {json_line(proof_entry)}' for name, proof_entry in other_entries.items()
                )
                value_text = f'{{"weights": [\n{pairs}\n ]{suffix}}}'
            else:
                value_text = json_line(value)
            lines.append(f' "{key}": {value_text}')
        return "{\n" + ",\n".join(lines) + "\n}\n"


def certify(
    problem: Problem,
    objectives: Sequence[Objective],
    units: Sequence[int],
    covered: Coverage = NOTHING,
    expired: Callable[[], bool] = lambda: False,
    cuts: Sequence[Sequence[int]] = (),
    subject: Subject | None = None,
    cases: Cases = None,
) -> Certificate | None:
    """Certify that a tree is optimal, by as many of the first objectives as are proved, or certify a bound.

    Parameters:
        problem: The problem; its network may be a part of a larger one (see ``subject``).
        objectives: The objectives, the most important first.
        units: The tree, by unit ids in an executable order.
        covered: The constraints that the certificate covers, and the names of the others.
        expired: Returns whether time is up.
        cuts: Sets of object nodes with a goal in each, tried first (:attr:`foon_asp.asp.Outcome.cuts`).
        cases: The case split to begin with (``Outcome.cases``); ``None`` for none.
        subject: The whole network and its data, if the problem has only a part of it. The part then has all
            achievers of each node that is needed and not available, and there are no constraints.

    Returns:
        The certificate. If no objective is proved, or under constraints that are not covered, it may
        prove only a bound on all trees. The result is ``None`` in these cases:

        - Time is up before a proof is found.
        - An objective needs rates, and a rate is 0.
        - Units have rates that differ from those of their motions, and an objective needs rates or rules are
          covered.
        - The proof is beyond the limits of ``verify``: products of rates are too close to be compared, or
          numbers are too long to be written.

    Raises:
        NotBestError: if the tree is not optimal, unless trees may have to keep to more than the covered rules
            (:attr:`Coverage.partial`).
    """
    if covered.rules and problem.own_rates:
        return None
    if any(objective.row.needs is OptionalData.RATES for objective in objectives) and (
        problem.own_rates or not all(map(problem.rate, range(len(problem.network))))
    ):
        return None
    bounding_tree = tuple(units)
    # of an answer under rules, a cut can hold what its search added for them
    known_cuts = [[o for o in cut if o < len(problem.network.objects)] for cut in cuts]
    for count in range(len(objectives), 0, -1):
        arrays = Arrays(problem, objectives[:count], covered)
        prover = _prover(arrays, expired, known_cuts)
        try:
            proof = prover.prove(arrays.actions(units), arrays.renumber_cases(cases))
        except CheaperError as cheaper:
            bounding_tree = tuple(a for a in cheaper.actions if a < len(problem.network))
            if not covered.partial:
                raise NotBestError(bounding_tree, problem.costs(bounding_tree)) from None
            break
        if proof is not None:
            certificate = _write_tree_certificate(arrays, covered, "optimal", units, proof, subject)
            if certificate is not None:
                return certificate
        if expired():
            break
    arrays = Arrays(problem, objectives, covered)
    relaxed = _prover(arrays, expired).relax(arrays.actions(bounding_tree))
    if relaxed is None:
        return None
    packing, bound = relaxed
    return _write_tree_certificate(arrays, covered, "bound", units, packing, subject, bound)


def certify_infeasible(
    problem: Problem,
    covered: Coverage = NOTHING,
    expired: Callable[[], bool] = lambda: False,
    subject: Subject | None = None,
) -> Certificate | None:
    """Return a certificate that there is no tree.

    Return ``None`` if some tree satisfies all covered constraints, or if no proof is found before time is up.
    Also return ``None`` if the proof is beyond the limits of ``verify``. The result is ``None``, too, if
    constraints are covered and units have rates of their own. ``covered``, ``expired`` and ``subject`` are as
    for :func:`certify`.
    """
    if covered.rules and problem.own_rates:
        return None
    arrays = Arrays(problem, (), covered)
    never = min(arrays.ruled.never, default=None)
    proof = _prover(arrays, expired).prove_none() if never is None else Broken(never)
    if proof is None:
        return None
    return _write_tree_certificate(arrays, covered, "infeasible", None, proof, subject)


def _prover(arrays: Arrays, expired: Callable[[], bool], cuts: Sequence[Sequence[int]] = ()) -> Prover:
    """Return a prover of claims about the arrays, which starts with known cuts."""
    rules = arrays if arrays.ruled.barred or arrays.has_own_limits else None
    return Prover(
        arrays.graph,
        arrays.goals,
        arrays.costs,
        arrays.order,
        arrays.forbidden,
        expired,
        known_cuts=cuts,
        limits=arrays.limits,
        rules=rules,
        multiples=arrays.multiples,
    )


def _write_tree_certificate(
    arrays: Arrays,
    covered: Coverage,
    claim: str,
    units: Sequence[int] | None,
    proof: Proof,
    subject: Subject | None,
    bound: Vector | None = None,
) -> Certificate | None:
    """Return the verified certificate of a claim about trees; each cut and each limit gets a number in it.

    Return ``None`` if numbers in the proof are too long, or if the certificate is beyond the limits of the
    verifier. Claims about user rules that the proof does not use are left out.

    ``subject`` is ``None`` if the problem is over the whole network. ``bound`` is ``None`` unless the claim
    is ``bound``.
    """
    problem, network = arrays.problem, arrays.problem.network
    subject = subject or subject_of(problem)
    cuts: dict[tuple[int, ...], int] = {}
    limit_numbers, own_limits = list(arrays.ruled.limits), arrays.own_limits
    own_numbers: dict[int, int] = {}

    def cut_number(cut: Cut) -> int:
        """Return the number of a cut; a new cut gets the next number."""
        return cuts.setdefault(cut.objects, len(cuts))

    def limit_number(position: int) -> int:
        """Return the number of a limit in the certificate, by its position among the limits of the arrays.

        Limits by user rules are numbered after the rules, in the order of use.
        """
        index = limit_numbers[position]
        if index not in own_limits:
            return index
        return len(covered.rules) + own_numbers.setdefault(index, len(own_numbers))

    def packing_json(packing: Packing) -> dict[str, object]:
        """Return the JSON of a cost partition: weights of cuts, weights of limits, and the divisor.

        The divisor says to which multiples the bound is rounded up. Limits and divisor are omitted where the
        partition does not use them. Cuts and limits get numbers.
        """
        weights = sorted((cut_number(cut), arrays.vector_json(weight)) for cut, weight in packing.weights)
        limits = sorted(
            (limit_number(position), arrays.vector_json(weight)) for position, weight in packing.limits
        )
        content: dict[str, object] = {"weights": [list(pair) for pair in weights]}
        if limits:
            content["limits"] = [list(pair) for pair in limits]
        if packing.rounded is not None:
            content["multiples"] = arrays.multiple_json(packing.rounded)
        return content

    def proof_json(proof: Proof) -> dict[str, object]:
        """Return the JSON of a proof, with its branches."""
        if isinstance(proof, Hopeless):
            return {"hopeless": cut_number(proof.cut)}
        if isinstance(proof, Packing):
            return packing_json(proof)
        if isinstance(proof, Broken):
            return {"broken": proof.rule}
        if isinstance(proof, CostFixing):
            above_cutoff = [arrays.action_json(action) for action in proof.actions]
            return {"dear": above_cutoff, **packing_json(proof.packing), "others": proof_json(proof.others)}
        return {
            "branch": arrays.action_json(proof.action),
            "without": proof_json(proof.without),
            "using": proof_json(proof.using),
        }

    try:
        proof_content = proof_json(proof)
        least = None if bound is None else arrays.vector_json(bound)
    except CheckLimitError:
        return None
    graph = arrays.graph
    members = (u for cut in cuts for o in cut for u in graph.makers[o] if {*cut}.isdisjoint(graph.needs[u]))
    limits = [own_limits[index] for index in own_numbers]
    rules = without_unused_claims(covered.rules, members, limits) if covered.partial else covered.rules
    numbered = [list(map(network.object_number, objects)) for objects in cuts]
    claimed = Claimed(claim, arrays.objectives, units, least)
    return write_certificate(
        TREE_FORM, problem, claimed, covered._replace(rules=rules), numbered, proof_content, subject
    )


class Claimed(NamedTuple):
    """The claim of a certificate.

    ``claim``: ``optimal``, ``bound`` or ``infeasible``.
    ``objectives``: the objectives that the claim is about, most important first.
    ``units``: the tree or plan; ``None`` for a claim without one.
    ``bound``: the bound as the JSON of a cost vector; ``None`` for a claim without one.
    """

    claim: str
    objectives: tuple[Objective, ...]
    units: Sequence[int] | None
    bound: Sequence[object] | None


def write_certificate(
    form: Form,
    problem: Problem,
    claimed: Claimed,
    covered: Coverage,
    cuts: Sequence[Sequence[int]],
    proof: object,
    subject: Subject,
    **more_keys: object,
) -> Certificate | None:
    """Return a sealed and verified certificate; ``None`` if it is beyond the limits of the verifier.

    For a measure, the certificate states only the costs of the units that the proof looks at. ``more_keys``
    are keys of the certificate beyond those of trees. Raises :class:`BugError` if the verifier refuses the
    certificate.
    """
    network, (claim, objectives, units, bound) = problem.network, claimed
    try:
        content: dict[str, Any] = {
            "format": form.name,
            "version": form.version,
            "claim": claim,
            "goals": [
                {"id": network.object_number(goal), "node": str(network.objects[goal])}
                for goal in problem.goals
            ],
            "containers": str(problem.containers),
            "level": network.level,
            "objective": [str(objective) for objective in objectives],
            "digests": subject.digests(covered.rules),
            "rules": [dict(rule) for rule in covered.rules],
            "measures": {
                str(objective): _measure_json(problem, objective)
                for objective in objectives
                if objective in problem.measures
            },
            "not_covered": list(covered.not_covered),
            **more_keys,
            "tree": None if units is None else list(map(network.unit_number, units)),
            "costs": None if units is None else _costs_json(problem, objectives, units),
            "bound": bound,
            "cuts": cuts,
            "proof": proof,
        }
        certificate = Certificate(content, claim, objectives)
        verified = _seal_and_verify(certificate, subject)
        for measure in verified.trusted:  # of all units, those that the proof looks at
            content["measures"][measure.name]["costs"] = _units_by_cost(measure.costs)
        if verified.trusted:
            _seal_and_verify(certificate, subject)
    except CheckLimitError:
        return None
    except RefusedError as refused:
        raise BugError(f"a certificate that was found is refused: {refused}") from None
    return certificate


def _costs_json(problem: Problem, objectives: Sequence[Objective], units: Sequence[int]) -> list[object]:
    """Return the JSON of the costs of a tree or plan: a whole number or a fraction as text, by objective."""
    costs = problem.costs(units)
    values = [costs.measure(objective) for objective in objectives]
    return [value if isinstance(value, int) else fraction_text(value) for value in values]


def _seal_and_verify(certificate: Certificate, subject: Subject) -> Verified:
    """Write the seal of a certificate into its content, and return the claim that the verifier accepts.

    Raises :class:`RefusedError` if the verifier refuses the certificate.
    """
    content = certificate.content
    content["seal"] = seal(content)
    return verify_any(read_certificate(certificate.text()), subject)


def subject_of(problem: Problem) -> Subject:
    """Return the data that certificates of a problem are about: its network, kitchen, rates and the like.

    The network of the problem has to be the whole network, not a part of it.
    """
    return Subject(
        *(problem.network, problem.kitchen, problem.rates, problem.utensils, problem.unit_prices),
        amounts=problem.amounts,
        stand_ins=problem.stand_ins.table if problem.stand_ins else None,
    )


def _measure_json(problem: Problem, objective: Objective) -> dict[str, Any]:
    """Return the JSON of a measure: its rules, their digest, and the units by their cost."""
    rules = problem.measures[objective].text
    unit_numbers = map(problem.network.unit_number, range(len(problem.network)))
    costs = problem.figures(objective, range(len(problem.network)))
    return {
        "rules": rules,
        "sha256": hashlib.sha256(rules.encode()).hexdigest(),
        "costs": _units_by_cost(dict(zip(unit_numbers, costs, strict=True))),
    }


def _units_by_cost(costs: Mapping[int, int | Fraction]) -> dict[str, list[int]]:
    """Return the units of each cost, ascending, under the cost as text: ``{"16/5": [3, 8]}``."""
    units_by_cost: dict[str, list[int]] = {}
    for unit in sorted(costs):
        units_by_cost.setdefault(str(costs[unit]), []).append(unit)
    return units_by_cost
