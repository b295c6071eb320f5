"""What rules of the user's own remove and ask for: taken on trust by certificates, and checked by clingo."""

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
from foon_asp.problem import Contradiction, Objective, Problem
from foon_asp.proof.constraint import OWN, Rule
from foon_asp.proof.verify import LimitError, RefusedError, canonical
from foon_asp.reduce import NONE
from foon_asp.rules.constraint import Constraint, LibraryUse, RuleText, find_constraint, named_constraint

_GREATEST = 2**31 - 1  # number of clingo's


def with_own_rules(covered: Coverage, problem: Problem, settings: Settings) -> Coverage | None:
    """Cover rules of the user's own by what they remove and ask for; ``None`` where nothing is known of that.

    What the covered rules remove and ask for already is left out, since it is not taken on trust. What
    shrinking rules limit is found while a proof is.
    """
    rules = assemble(settings, lambda _: None).understood
    if rules is None:
        return None
    found = rules.applied(problem)
    claims: list[list[list[int]]] = []
    if isinstance(found, Contradiction):
        claims.append([[], []])
    else:
        ruled = covered.ruled(problem)
        asked = {frozenset(makers) for makers in ruled.makers.values()}
        gone = (u for u in range(len(problem.network)) if u not in ruled.removed and found.removed(u))
        claims += ([[unit], []] for unit in gone)
        claims += ([[], sorted(units)] for units in found.required if units not in asked)
    given = [find_constraint(each) for each in settings.constraints]
    own: dict[str, Any] = {
        "rule": OWN,
        "claims": claims,
        "limits": [],
        "constants": sorted(set(settings.constants)),
        "files": [_file(each) for each in dict.fromkeys(given) if not _is_library(each)],
        "library": sorted({_written(each) for each in given if _is_library(each)}),
    }
    theirs = frozenset(each for each in given if not _is_library(each))
    stated = [(limit.amounts, limit.most) for limit in covered.ruled(problem).limits.values()]
    limits = OwnLimits(problem, settings, rules, theirs, stated)
    return Coverage(tuple(sorted((*covered.rules, own), key=canonical)), limits=limits)


def check_with_clingo(
    content: Mapping[str, Any], own: Rule, problem: Problem, deadline: Deadline | None = None
) -> None:
    """Let clingo check what a certificate takes on trust; the problem is the one that it is about.

    Asks for a tree that keeps to the rules and of which a claim is not true, and whether its own tree keeps
    to them. Raises :class:`RefusedError` where something is not true, and where clingo cannot be asked.
    """
    given = [RuleText(file["text"]) for file in own["files"]]
    found = (*given, *map(named_constraint, own["library"]))
    how = Settings(found, constants=tuple(own["constants"]), reductions=NONE, deadline=deadline)
    bodies = [_claim(*claim) for claim in own["claims"]] + [_beyond(*limit) for limit in own["limits"]]
    wrong = "".join(f"_wrong :- {body}.\n" for body in bodies)
    if wrong and _some_tree(content, problem, how, f"{wrong}:- not _wrong.\n"):
        raise RefusedError("what is taken on trust is not true: clingo finds a tree without it")
    if content["tree"] is not None:
        chosen = set(content["tree"])
        fixed = (f":- {'not ' * (u in chosen)}use({u}).\n" for u in range(len(problem.network)))
        if not _some_tree(content, problem, how, "".join(fixed)):
            raise RefusedError("the tree does not keep to the rules: clingo says so")


def _some_tree(content: Mapping[str, Any], problem: Problem, how: Settings, rules: str) -> bool:
    """Ask clingo whether there is a tree that keeps to more rules, among all units that can be made."""
    ours = set(Objective)
    objectives = tuple(Objective(name) for name in content["objective"] if name in ours)
    try:
        found = solve(problem, objectives, how._replace(bounded=Bounded(rules, ())))
    except UserError as error:
        raise RefusedError(f"clingo cannot be asked what is taken on trust: {error}") from None
    if found.status is Status.UNKNOWN:
        raise LimitError("clingo does not finish with what is taken on trust")
    return found.status is not Status.INFEASIBLE


def _claim(used: list[int], without: list[int]) -> str:
    literals = [*(f"use({unit})" for unit in used), *(f"not use({unit})" for unit in without)]
    return ", ".join(literals) or "#true"


def _beyond(amounts: Mapping[str, Sequence[int]], most: int) -> str:
    """Say that units come to more than a limit; raises :class:`LimitError` for what clingo cannot add up."""
    counted = [(int(amount), unit) for amount, units in amounts.items() for unit in units]
    if max(sum(amount for amount, _ in counted), abs(most)) > _GREATEST:
        raise LimitError("clingo cannot add up what a limit counts")
    return f"#sum {{ {'; '.join(f'{amount},{unit} : use({unit})' for amount, unit in counted)} }} > {most}"


def _is_library(constraint: Constraint) -> bool:
    return isinstance(constraint, LibraryUse) or (isinstance(constraint, Path) and is_own(constraint))


def _written(constraint: Constraint) -> str:
    return constraint.stem if isinstance(constraint, Path) else str(constraint)


def _file(constraint: Constraint) -> dict[str, str]:
    """Return the text of rules; of a file that includes others, all that it says."""
    if isinstance(constraint, Path):
        alone = len(included_files(constraint)) == 1
        text = constraint.read_text("utf-8") if alone else read_encoding(constraint).text
    else:
        text = str(constraint)
    sha = hashlib.sha256(text.encode()).hexdigest()
    return {"name": constraint.name, "sha256": sha, "text": text}
