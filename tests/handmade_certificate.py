"""Certificates written by hand, without the finder: right ones, and forged ones with a seal that fits."""

from typing import Any

from foon_asp.problem import Problem
from foon_asp.proof import verify

Content = dict[str, Any]


def handmade(problem: Problem, **values: Any) -> Content:
    """Give a sealed certificate of a problem with these values, and those of no claim for the others."""
    content: Content = {
        "format": verify.FORMAT,
        "version": verify.VERSION,
        "claim": "optimal",
        "goals": [{"id": goal, "node": str(problem.network.objects[goal])} for goal in problem.goals],
        "containers": str(problem.containers),
        "level": problem.network.level,
        "objective": ["units"],
        "digests": verify.digests(*_data(problem)),
        "forbidden": {"motions": [], "objects": []},
        "not_covered": [],
        "tree": None,
        "costs": None,
        "bound": None,
        "cuts": [],
        "proof": {"weights": []},
        **values,
    }
    return {**content, "seal": verify.seal(content)}


def check(content: Any, problem: Problem) -> verify.Verified:
    """Verify a certificate against the data of a problem."""
    return verify.verify(content, *_data(problem))


def older(problem: Problem) -> dict[str, str]:
    """Give the digests that certificates had before there were prices."""
    return {name: digest for name, digest in verify.digests(*_data(problem)).items() if name != "prices"}


def _data(problem: Problem) -> tuple[Any, ...]:
    return problem.network, problem.kitchen, problem.rates, problem.utensils, problem.unit_prices
