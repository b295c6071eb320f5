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
from foon_asp.proof.canonical_json import canonical_json
from foon_asp.proof.refusal import CheckLimitError, RefusedError
from foon_asp.proof.rule_meaning import OWN, Rule
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
    are found later, during the proof. If the rules exclude every tree, the only claim is that there is no
    tree. The result covers all constraints. Return ``None`` if the meaning of the user rules is not known.
    """
    rules = assemble(settings, lambda _: None).understood
    if rules is None:
        return None
    restriction = rules.restriction_of(problem, settings.effective_deadline, range(len(problem.network)))
    if restriction is None:
        return None
    claims: list[list[list[int]]] = []
    if isinstance(restriction, Contradiction):
        claims.append([[], []])
    else:
        compiled = covered.compile_rules(problem)
        required = {frozenset(makers) for makers in compiled.makers.values()}
        removed = (
            u for u in range(len(problem.network)) if u not in compiled.removed and restriction.removed(u)
        )
        claims += ([[unit], []] for unit in removed)
        claims += ([[], sorted(units)] for units in restriction.required if units not in required)
    constraints = [find_constraint(constraint) for constraint in settings.constraints]
    own_rule: dict[str, Any] = {
        "rule": OWN,
        "claims": claims,
        "limits": [],
        "constants": sorted(set(settings.constants)),
        "files": [
            _text_with_digest(constraint)
            for constraint in dict.fromkeys(constraints)
            if not _is_library(constraint)
        ],
        "library": sorted(
            {_library_name(constraint) for constraint in constraints if _is_library(constraint)}
        ),
    }
    user_constraints = frozenset(constraint for constraint in constraints if not _is_library(constraint))
    covered_limits = [
        (limit.amounts, limit.max_sum) for limit in covered.compile_rules(problem).limits.values()
    ]
    limits = OwnLimits(problem, settings, rules, user_constraints, covered_limits)
    return Coverage(tuple(sorted((*covered.rules, own_rule), key=canonical_json)), limits=limits)


def check_with_clingo(
    content: Mapping[str, Any], own_rule: Rule, problem: Problem, deadline: Deadline | None = None
) -> None:
    """Check with clingo the claims that a certificate of a problem takes on trust.

    Clingo searches for a tree that keeps to the rules and violates a claim or limit. It also checks that the
    certificate's tree keeps to the rules. Raises :class:`RefusedError` if a claim is false or clingo cannot
    run, and :class:`CheckLimitError` if clingo does not finish.

    Parameters:
        content: The JSON of the certificate.
        own_rule: The rule of the certificate that has the claims.
        problem: The problem that the certificate is about.
        deadline: The deadline of each search; ``None`` for no limit.
    """
    texts = [RuleText(file["text"]) for file in own_rule["files"]]
    constraints = (*texts, *map(named_constraint, own_rule["library"]))
    settings = Settings(
        constraints, constants=tuple(own_rule["constants"]), reductions=NONE, deadline=deadline
    )
    bodies = [_violated_claim(*claim) for claim in own_rule["claims"]] + [
        _exceeded_limit(*limit) for limit in own_rule["limits"]
    ]
    wrong_rules = "".join(f"_wrong :- {body}.\n" for body in bodies)
    if wrong_rules and _has_tree(content, problem, settings, f"{wrong_rules}:- not _wrong.\n"):
        raise RefusedError("what is taken on trust is not true: clingo finds a tree without it")
    if content["tree"] is not None:
        chosen = set(content["tree"])
        fixing_rules = (f":- {'not ' * (u in chosen)}use({u}).\n" for u in range(len(problem.network)))
        if not _has_tree(content, problem, settings, "".join(fixing_rules)):
            raise RefusedError("the tree does not keep to the rules: clingo says so")


def _has_tree(content: Mapping[str, Any], problem: Problem, settings: Settings, rules: str) -> bool:
    """Return whether clingo finds a tree that keeps to the constraints of ``settings`` and to ``rules``.

    Raises :class:`RefusedError` if clingo cannot run, and :class:`CheckLimitError` if it does not finish.
    """
    known_objectives = set(Objective)
    objectives = tuple(Objective(name) for name in content["objective"] if name in known_objectives)
    try:
        outcome = solve(problem, objectives, settings._replace(bounded=Bounded(rules, ())))
    except UserError as error:
        raise RefusedError(f"clingo cannot be asked what is taken on trust: {error}") from None
    if outcome.status is Status.UNKNOWN:
        raise CheckLimitError("clingo does not finish with what is taken on trust")
    return outcome.status is not Status.INFEASIBLE


def _violated_claim(used: list[int], without: list[int]) -> str:
    """Return the body of a clingo rule that holds if a tree violates a claim.

    The claim is that no tree has all ``used`` units and none of ``without``.
    """
    literals = [*(f"use({unit})" for unit in used), *(f"not use({unit})" for unit in without)]
    return ", ".join(literals) or "#true"


def _exceeded_limit(amounts: Mapping[str, Sequence[int]], max_sum: int) -> str:
    """Return a clingo aggregate that holds if a tree exceeds a limit.

    ``amounts`` has the units of each amount, by the amount as text. Raises :class:`CheckLimitError` if a
    sum may be too large for clingo.
    """
    counted = [(int(amount), unit) for amount, units in amounts.items() for unit in units]
    if max(sum(amount for amount, _ in counted), abs(max_sum)) > INT32_MAX:
        raise CheckLimitError("clingo cannot add up what a limit counts")
    return f"#sum {{ {'; '.join(f'{amount},{unit} : use({unit})' for amount, unit in counted)} }} > {max_sum}"


def _is_library(constraint: Constraint) -> bool:
    """Return whether a constraint is ready-made."""
    return isinstance(constraint, LibraryUse) or (isinstance(constraint, Path) and is_own(constraint))


def _library_name(constraint: Constraint) -> str:
    """Return the name of a ready-made constraint, with those values that were given together with it."""
    return constraint.stem if isinstance(constraint, Path) else str(constraint)


def _text_with_digest(constraint: Constraint) -> dict[str, str]:
    """Return the name, SHA-256 digest and text of rules; files that a file includes are put into it."""
    if isinstance(constraint, Path):
        is_alone = len(included_files(constraint)) == 1
        text = constraint.read_text("utf-8") if is_alone else read_encoding(constraint).text
    else:
        text = str(constraint)
    sha = hashlib.sha256(text.encode()).hexdigest()
    return {"name": constraint.name, "sha256": sha, "text": text}
