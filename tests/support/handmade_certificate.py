"""Certificates written by hand, without the finder: right ones, and forged ones with a seal that fits."""

from collections.abc import Iterable
from typing import Any

from foon_asp.certificate.certificate import subject_of
from foon_asp.problem import Problem
from foon_asp.proof import verify

Content = dict[str, Any]


def handmade(problem: Problem, **values: Any) -> Content:
    """Give a sealed certificate of a problem with these values, and those of no claim for the others."""
    content: Content = {
        "format": verify.TREE.name,
        "version": verify.TREE.version,
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
    if content["version"] in (1, 2, 3):
        content = before_rules(content)
    return {**content, "seal": verify.seal(content)}


def before_rules(content: Content) -> Content:
    """Give a certificate without rules the keys that it had before version 4, unsealed."""
    old = {"forbidden": {"motions": [], "objects": []}, **content}
    del old["rules"], old["measures"]
    return {**old, "digests": {key: sha for key, sha in old["digests"].items() if key != "sources"}}


def check(content: Any, problem: Problem) -> verify.Verified:
    """Verify a certificate against the data of a problem."""
    return verify.verify(content, subject_of(problem))


def older(problem: Problem) -> dict[str, str]:
    """Give the digests that certificates had before there were prices, and sources."""
    digests = subject_of(problem).digests()
    return {name: digest for name, digest in digests.items() if name not in ("prices", "sources")}


def forbid(motions: Iterable[str] = (), labels: Iterable[str] = ()) -> list[dict[str, str]]:
    """Give the rules that forbid motions and labels of objects, in order."""
    rules = [{"rule": "forbid_motion", "forbidden_motion": motion} for motion in motions]
    rules += [{"rule": "forbid_object", "forbidden_object": label} for label in labels]
    return sorted(rules, key=verify.canonical)
