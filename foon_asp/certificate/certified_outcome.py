"""Certification of the solver's answers."""

import time
from collections.abc import Callable, Sequence
from fractions import Fraction
from operator import sub
from typing import Any

from foon_asp.asp import Outcome, Proof, Settings, Status
from foon_asp.certificate.arrays import Arrays
from foon_asp.certificate.certificate import Certificate, NotBestError, certify, certify_infeasible
from foon_asp.certificate.coverage import Coverage, coverage
from foon_asp.certificate.plan import certify_no_plan, certify_plan, covered_for_plans
from foon_asp.errors import BugError
from foon_asp.hypergraph.lexicographic import Vector
from foon_asp.problem import Problem, levels, multiplies
from foon_asp.proof.certificate_limits import ALLOWED
from foon_asp.proof.certificate_rules import trusted_claims
from foon_asp.proof.certificate_subject import Subject


def certify_outcome(
    outcome: Outcome,
    settings: Settings,
    expired: Callable[[], bool] = lambda: False,
    subject: Subject | None = None,
) -> tuple[Outcome, Certificate | None]:
    """Return an answer marked as certified, and its certificate; ``None`` if no certificate is found.

    If the certificate proves only a bound, or takes user rules on trust, the answer is not marked. Otherwise,
    the objectives that the certificate proves are marked as certified. If it proves the whole claim, the kind
    of proof of the answer becomes ``certificate``. Then a plan that was found at a limit becomes optimal.

    User rules are taken on trust only if that proves more than a bound on trees. In all cases,
    ``outcome.seconds["certificate"]`` becomes the time of the search for certificates.

    ``subject`` is the whole network if the network of the answer is a part of it, as for
    :func:`~foon_asp.certificate.certify`. Raises :class:`BugError` if a tree that the solver called optimal
    is not, or if answer and certificate contradict each other.
    """
    start_time = time.perf_counter()
    covered = coverage(settings)
    is_plan = outcome.problem.items is not None
    if is_plan:
        covered = covered_for_plans(covered)
    certificate = _find_certificate(outcome, settings, covered, expired, subject)
    if (
        not is_plan
        and covered.not_covered
        and (certificate is None or certificate.claim == "bound")
        and outcome.proof is not None
    ):
        from foon_asp.certificate.own_rules import with_own_rules  # noqa: PLC0415 - it loads clingo

        with_user_rules = with_own_rules(covered, outcome.problem, settings)
        trusting = (
            None
            if with_user_rules is None
            else _find_certificate(outcome, settings, with_user_rules, expired)
        )
        if with_user_rules is not None and trusting is not None and trusting.claim != "bound":
            covered, certificate = with_user_rules, trusting
    outcome.seconds["certificate"] = time.perf_counter() - start_time
    if certificate is not None:
        contradiction = _contradiction(outcome, certificate, covered)
        if contradiction is not None:
            raise _wrong_answer(outcome, settings, contradiction)
    if certificate is None or certificate.claim == "bound" or trusted_claims(certificate.content):
        return outcome, certificate
    complete = certificate.claim == "infeasible" or certificate.certified == levels(outcome.objectives)
    if complete and outcome.status is Status.FEASIBLE and outcome.costs is not None:
        bounds = {objective: outcome.costs.measure(objective) for objective in certificate.certified}
        outcome = outcome._replace(status=Status.OPTIMAL, bounds=bounds, stopped=None)
    proof = Proof.CERTIFICATE if complete else outcome.proof
    return outcome._replace(proof=proof, certified=certificate.certified), certificate


def _find_certificate(
    outcome: Outcome,
    settings: Settings,
    covered: Coverage,
    expired: Callable[[], bool],
    subject: Subject | None = None,
) -> Certificate | None:
    """Return a certificate about the trees or plans under the covered rules; ``None`` if none is found.

    An answer about trees that is neither optimal nor infeasible gets none. Raises :class:`BugError` if a tree
    is better than the optimal one of the answer.
    """
    if outcome.problem.items is not None:
        return _find_plan_certificate(outcome, covered, expired)
    if outcome.status is Status.INFEASIBLE:
        return certify_infeasible(outcome.problem, covered, expired, subject)
    if outcome.status is not Status.OPTIMAL or outcome.units is None:
        return None
    objectives = levels(outcome.objectives)
    try:
        return certify(
            outcome.problem, objectives, outcome.units, covered, expired, outcome.cuts, subject, outcome.cases
        )
    except NotBestError as better:
        why = f"there is a better tree, {_tree_text(outcome, better.units)}"
        raise _wrong_answer(outcome, settings, why) from None


def _find_plan_certificate(
    outcome: Outcome, covered: Coverage, expired: Callable[[], bool]
) -> Certificate | None:
    """Return a certificate about the plans under the covered rules; ``None`` if none is found.

    The plan of the answer need not be optimal: it may have been found at a limit.
    """
    if outcome.status is Status.INFEASIBLE:
        return certify_no_plan(outcome.problem, covered, expired)
    if outcome.units is None:
        return None
    return certify_plan(outcome.problem, levels(outcome.objectives), outcome.units, covered, expired)


def _contradiction(outcome: Outcome, certificate: Certificate, covered: Coverage) -> str | None:
    """Return in words why an answer and a certificate contradict each other; ``None`` if they do not.

    The verifier has accepted the certificate, but does not know the answer. So the goals and the claims of
    the two are compared here.
    """
    problem, content = outcome.problem, certificate.content
    goals = tuple(goal["id"] for goal in content["goals"])
    goals_asked = tuple(map(problem.network.object_number, problem.goals))
    if (goals, content["containers"]) != (goals_asked, str(problem.containers)):
        return f"the certificate speaks of the goals {list(goals)} under {content['containers']} containers"
    if outcome.units is None:
        return None if certificate.claim == "infeasible" else f"the certificate claims {certificate.claim}"
    if certificate.claim == "infeasible":
        return "the certificate proves that there is no tree"
    if problem.items is not None:  # it has the plan itself, whose costs were held against what is proved
        return None
    return _cost_contradiction(outcome, outcome.units, certificate, covered)


def _cost_contradiction(
    outcome: Outcome, units: Sequence[int], certificate: Certificate, covered: Coverage
) -> str | None:
    """Return in words why the costs of a tree contradict a certificate; ``None`` if they do not.

    The costs contradict it if they are below the proved bound, or differ from the costs of the tree that is
    proved optimal.
    """
    problem, content = outcome.problem, certificate.content
    arrays = Arrays(problem, certificate.certified, covered)
    cost = arrays.order.total(arrays.costs[a] for a in arrays.actions(units))
    if certificate.claim == "bound":
        bound = _read_vector(arrays, content["bound"])
        if arrays.order.sign([*map(sub, cost, bound)]) < 0:
            return f"the certificate proves the bound {content['bound']}, and the tree costs less"
        return None
    tree = [unit for u in content["tree"] if (unit := problem.network.unit_of_number(u)) is not None]
    proved_cost = arrays.order.total(arrays.costs[a] for a in arrays.actions(tree))
    if arrays.order.sign([*map(sub, cost, proved_cost)]) != 0:
        return f"the certificate proves another tree optimal, {_tree_text(outcome, tree)}"
    return None


def _read_vector(arrays: Arrays, stated: Sequence[Any]) -> Vector:
    """Return a bound as a cost vector, from its JSON."""
    vector: list[Fraction] = []
    for objective, stated_value in zip(arrays.objectives, stated, strict=True):
        if multiplies(objective):
            vector += [Fraction(stated_value.get(str(rate), 0)) for rate in arrays.rates]
        else:
            vector.append(Fraction(stated_value))
    return tuple(vector)


def _wrong_answer(outcome: Outcome, settings: Settings, why: str) -> BugError:
    """Return an error about a wrong answer of the solver; its message states the question, not the data."""
    problem = outcome.problem
    question_lines = [
        f"goals: {' | '.join(str(problem.network.objects[goal]) for goal in problem.goals)}",
        f"containers: {problem.containers}, level {problem.network.level}",
        f"objectives: {', '.join(levels(outcome.objectives))}",
        f"network: {len(problem.network)} units, {len(problem.network.objects)} object nodes",
        f"kitchen: {len(problem.kitchen)} items",
    ]
    question_lines += [f"constraint: {file}" for file in settings.constraints]
    question_lines += [f"constant: {constant}" for constant in settings.constants]
    if settings.replaced is not None:
        question_lines.append(f"encodings: {settings.replaced}")
    answer = "no tree" if outcome.units is None else _tree_text(outcome, outcome.units)
    return BugError(f"the answer is {outcome.status}, {answer}, but {why}\n" + "\n".join(question_lines))


def _tree_text(outcome: Outcome, units: Sequence[int]) -> str:
    """Return a tree and its costs in words, for a message."""
    return f"the units {list(units)} ({_costs_text(outcome.problem, units)})"


def _costs_text(problem: Problem, units: Sequence[int]) -> str:
    """Return the costs of a tree in words, such as ``3 units, 7 inputs``, for a message.

    An unknown success rate is omitted, and one of too many digits is not printed.
    """
    costs = problem.costs(units)
    cost_texts = [f"{costs.units} units", f"{costs.inputs} inputs", f"{costs.ingredients} ingredients"]
    cost_texts.append(f"{costs.kitchen} kitchen items")
    if costs.success is not None:
        is_long = costs.success.denominator.bit_length() > ALLOWED.written_bits
        cost_texts.append(f"success {'of too many digits to print' if is_long else costs.success}")
    return ", ".join(cost_texts)
