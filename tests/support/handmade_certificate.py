"""Certificates written by hand, without the finder: right ones, and forged ones with a seal that fits."""

from collections.abc import Iterable
from typing import Any

from foon_asp.certificate.certificate import subject_of
from foon_asp.problem import Problem
from foon_asp.proof import verifier
from foon_asp.proof.canonical_json import canonical_json
from foon_asp.proof.certificate_header import TREE_FORM, seal
from foon_asp.proof.verified_claim import Verified

Content = dict[str, Any]


def handmade(problem: Problem, **values: Any) -> Content:
    """Give a sealed certificate of a problem with these values, and those of no claim for the others."""
    content: Content = {
        "format": TREE_FORM.name,
        "version": TREE_FORM.version,
        "claim": "optimal",
        "goals": [{"id": goal, "node": str(problem.network.objects[goal])} for goal in problem.goals],
        "containers": str(problem.containers),
        "level": problem.network.level,
        "objective": ["units"],
        "digests": subject_of(problem).digests(),
        "rules": [],
        "measures": {},
        "not_covered": [],
        "tree": None,
        "costs": None,
        "bound": None,
        "cuts": [],
        "proof": {"weights": []},
        **values,
    }
    return {**content, "seal": seal(content)}


def check(content: Any, problem: Problem) -> Verified:
    """Verify a certificate against the data of a problem."""
    return verifier.verify(content, subject_of(problem))


def forbid(motions: Iterable[str] = (), labels: Iterable[str] = ()) -> list[dict[str, str]]:
    """Give the rules that forbid motions and labels of objects, in order."""
    rules = [{"rule": "forbid_motion", "forbidden_motion": motion} for motion in motions]
    rules += [{"rule": "forbid_object", "forbidden_object": label} for label in labels]
    return sorted(rules, key=canonical_json)
