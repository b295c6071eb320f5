"""From the solver's answer to one that a certificate proves."""

import time
from collections.abc import Callable

from foon_asp.asp import Outcome, Proof, Settings, Status
from foon_asp.certificate.certificate import Certificate, NotBestError, certify, certify_infeasible
from foon_asp.certificate.coverage import coverage
from foon_asp.errors import BugError
from foon_asp.problem import levels


def certify_outcome(
    outcome: Outcome, settings: Settings, expired: Callable[[], bool] = lambda: False
) -> tuple[Outcome, Certificate | None]:
    """Find a certificate for an answer to a question under these settings, and mark the answer with it.

    The answer is marked ``certificate`` where the whole of its claim is proved; where only the first of its
    objectives are, it says for each. Raises :class:`BugError` when a tree that the solver called optimal is
    not.
    """
    began = time.perf_counter()
    covered = coverage(settings)
    found: Certificate | None = None
    if outcome.status is Status.INFEASIBLE:
        found = certify_infeasible(outcome.problem, covered)
    elif outcome.status is Status.OPTIMAL and outcome.units is not None:
        try:
            found = certify(
                outcome.problem,
                levels(outcome.objectives),
                outcome.units,
                covered,
                expired,
                outcome.cuts,
            )
        except NotBestError as better:
            raise BugError(
                f"the solver calls the tree {list(outcome.units)} optimal by "
                f"{', '.join(outcome.objectives)}, but "
                f"the units {list(better.units)} make the goals for {better.costs}"
            ) from None
    outcome.seconds["certificate"] = time.perf_counter() - began
    if found is None or found.claim == "bound":
        return outcome, found
    complete = found.claim == "infeasible" or found.certified == levels(outcome.objectives)
    proof = Proof.CERTIFICATE if complete else outcome.proof
    return outcome._replace(proof=proof, certified=found.certified), found
