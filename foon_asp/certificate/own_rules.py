"""Removals and requirements by user rules: taken on trust by certificates, and checked by clingo."""

import hashlib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from foon_asp.asp import Settings, Status, solve
from foon_asp.asp.assembly import assemble
from foon_asp.asp.settings import Bounded
from foon_asp.certificate.coverage import Coverage
from foon_asp.certificate.own_limits import OwnLimits
from foon_asp.deadline import Deadline
from foon_asp.encoding.encoding import read_encoding
from foon_asp.encoding.encoding_file import included_files
from foon_asp.encoding.own_encodings import is_own
from foon_asp.errors import UserError
from foon_asp.hypergraph import NONE
from foon_asp.problem import Contradiction, Objective, Problem
from foon_asp.problem.number import INT32_MAX
from foon_asp.proof.rule_meaning import OWN, Rule
from foon_asp.proof.verifier import LimitError, RefusedError, canonical_json
from foon_asp.rules.passed_constraint import (
    Constraint,
    LibraryUse,
    RuleText,
    find_constraint,
    named_constraint,
)


def with_own_rules(covered: Coverage, problem: Problem, settings: Settings) -> Coverage | None:
    """Return the coverage with user rules as claims about removed and required units.

    Claims that follow from covered rules are left out, since they need no trust. Limits by antimonotone rules
    are found later, during the proof. ``None`` where the meaning of the user rules is not known.
    """
    rules = assemble(settings, lambda _: None).understood
    if rules is None:
        return None
    applied = rules.applied(problem, settings.begun, range(len(problem.network)))
    if applied is None:
        return None
    claims: list[list[list[int]]] = []
    if isinstance(applied, Contradiction):
        claims.append([[], []])
    else:
        ruled = covered.ruled(problem)
        required = {frozenset(makers) for makers in ruled.makers.values()}
        gone = (u for u in range(len(problem.network)) if u not in ruled.removed and applied.removed(u))
        claims += ([[unit], []] for unit in gone)
        claims += ([[], sorted(units)] for units in applied.required if units not in required)
    constraints = [find_constraint(constraint) for constraint in settings.constraints]
    own: dict[str, Any] = {
        "rule": OWN,
        "claims": claims,
        "limits": [],
        "constants": sorted(set(settings.constants)),
        "files": [
            _file(constraint) for constraint in dict.fromkeys(constraints) if not _is_library(constraint)
        ],
        "library": sorted({_written(constraint) for constraint in constraints if _is_library(constraint)}),
    }
    theirs = frozenset(constraint for constraint in constraints if not _is_library(constraint))
    stated = [(limit.amounts, limit.max_sum) for limit in covered.ruled(problem).limits.values()]
    limits = OwnLimits(problem, settings, rules, theirs, stated)
    return Coverage(tuple(sorted((*covered.rules, own), key=canonical_json)), limits=limits)


def check_with_clingo(
    content: Mapping[str, Any], own: Rule, problem: Problem, deadline: Deadline | None = None
) -> None:
    """Check with clingo the claims that a certificate of a problem takes on trust.

    Clingo searches for a tree that keeps to the rules and violates a claim, and checks that the certificate's
    tree keeps to the rules. Raises :class:`RefusedError` where a claim is false or clingo cannot run, and
    :class:`LimitError` where it does not finish.
    """
    texts = [RuleText(file["text"]) for file in own["files"]]
    constraints = (*texts, *map(named_constraint, own["library"]))
    settings = Settings(constraints, constants=tuple(own["constants"]), reductions=NONE, deadline=deadline)
    bodies = [_claim(*claim) for claim in own["claims"]] + [_beyond(*limit) for limit in own["limits"]]
    wrong = "".join(f"_wrong :- {body}.\n" for body in bodies)
    if wrong and _some_tree(content, problem, settings, f"{wrong}:- not _wrong.\n"):
        raise RefusedError("what is taken on trust is not true: clingo finds a tree without it")
    if content["tree"] is not None:
        chosen = set(content["tree"])
        fixed = (f":- {'not ' * (u in chosen)}use({u}).\n" for u in range(len(problem.network)))
        if not _some_tree(content, problem, settings, "".join(fixed)):
            raise RefusedError("the tree does not keep to the rules: clingo says so")


def _some_tree(content: Mapping[str, Any], problem: Problem, settings: Settings, rules: str) -> bool:
    """Return whether clingo finds a tree of executable units that keeps to the additional ``rules``."""
    ours = set(Objective)
    objectives = tuple(Objective(name) for name in content["objective"] if name in ours)
    try:
        outcome = solve(problem, objectives, settings._replace(bounded=Bounded(rules, ())))
    except UserError as error:
        raise RefusedError(f"clingo cannot be asked what is taken on trust: {error}") from None
    if outcome.status is Status.UNKNOWN:
        raise LimitError("clingo does not finish with what is taken on trust")
    return outcome.status is not Status.INFEASIBLE


def _claim(used: list[int], without: list[int]) -> str:
    literals = [*(f"use({unit})" for unit in used), *(f"not use({unit})" for unit in without)]
    return ", ".join(literals) or "#true"


def _beyond(amounts: Mapping[str, Sequence[int]], max_sum: int) -> str:
    """Return a clingo aggregate that is true where a limit is exceeded.

    Raises :class:`LimitError` for sums too large for clingo.
    """
    counted = [(int(amount), unit) for amount, units in amounts.items() for unit in units]
    if max(sum(amount for amount, _ in counted), abs(max_sum)) > INT32_MAX:
        raise LimitError("clingo cannot add up what a limit counts")
    return f"#sum {{ {'; '.join(f'{amount},{unit} : use({unit})' for amount, unit in counted)} }} > {max_sum}"


def _is_library(constraint: Constraint) -> bool:
    return isinstance(constraint, LibraryUse) or (isinstance(constraint, Path) and is_own(constraint))


def _written(constraint: Constraint) -> str:
    return constraint.stem if isinstance(constraint, Path) else str(constraint)


def _file(constraint: Constraint) -> dict[str, str]:
    """Return the text of rules with its digest; a file that includes others is expanded."""
    if isinstance(constraint, Path):
        alone = len(included_files(constraint)) == 1
        text = constraint.read_text("utf-8") if alone else read_encoding(constraint).text
    else:
        text = str(constraint)
    sha = hashlib.sha256(text.encode()).hexdigest()
    return {"name": constraint.name, "sha256": sha, "text": text}
