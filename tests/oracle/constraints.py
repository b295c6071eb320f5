"""What the ready-made constraints say of one tree, from their own words. Shares no code with the program."""

import random
import re
from collections.abc import Mapping
from fractions import Fraction
from pathlib import Path, PurePath
from typing import Any

from foon_asp.asp import Settings
from foon_asp.network import FunctionalUnit, ObjectNode, Source
from foon_asp.problem import Problem
from foon_asp.resources import encodings_folder
from tests.oracle.task_trees import made, needed
from tests.support.random_problems import MOTIONS

Tree = tuple[FunctionalUnit, ...]


def ways(problem: Problem, tree: Tree, rule: Mapping[str, Any]) -> int:
    """Return in how many ways a tree breaks a constraint, given by name with its values."""
    values = [value for name, value in rule.items() if name != "rule"]
    return int(_WAYS[rule["rule"]](problem, tree, *values))


def keeps(problem: Problem, tree: Tree, rule: Mapping[str, Any]) -> bool:
    """Whether a tree keeps to a constraint."""
    return not ways(problem, tree, rule)


def touched(tree: Tree) -> list[ObjectNode]:
    return [node for unit in tree for nodes in (unit.inputs, unit.outputs) for node in {*nodes}]


def using(tree: Tree, label: str) -> int:
    """Return how many units have an object of that label."""
    return sum(any(node.label == label for node in touched((unit,))) for unit in tree)


def count(tree: Tree, motion: str) -> int:
    return sum(unit.motion == motion for unit in tree)


def has(node: ObjectNode, name: str) -> bool:
    return node.label == name or any(name in contents.ingredients for contents in node.contents)


def sources(problem: Problem, unit: FunctionalUnit) -> tuple[Source, ...]:
    number = problem.network.unit_id(unit)
    assert number is not None
    return problem.network.sources[number]


def vouched(problem: Problem, unit: FunctionalUnit, allowed: list[str]) -> bool:
    return any(
        not {source.file, PurePath(source.file).name, *source.videos}.isdisjoint(allowed)
        for source in sources(problem, unit)
    )


def videos(problem: Problem, unit: FunctionalUnit) -> set[str]:
    return {video for source in sources(problem, unit) for video in source.videos}


def price(problem: Problem, unit: FunctionalUnit) -> Fraction:
    assert problem.unit_prices is not None
    return problem.unit_prices.units.get(unit, problem.unit_prices.motions.get(unit.motion, Fraction()))


def passes_on(problem: Problem, tree: Tree, label: str) -> bool:
    rule, utensils = problem.containers, problem.utensils
    return any(
        node.label == label and not problem.at_hand(node) and node not in maker.inputs
        for maker in tree
        for node in made(maker, rule, utensils)
        for taker in tree
        if node in needed(taker, rule, utensils)
    )


def early(problem: Problem, tree: Tree, earlier: str, later: str) -> int:
    """Run all that runs without the earlier motion, and count what has the later one."""
    rule, utensils = problem.containers, problem.utensils
    at_hand = {problem.network.objects[o] for o in problem.kitchen}
    left, ran = [unit for unit in tree if unit.motion != earlier], 0
    while ready := [unit for unit in left if needed(unit, rule, utensils) <= at_hand]:
        ran += count(tuple(ready), later)
        at_hand |= {node for unit in ready for node in made(unit, rule, utensils)}
        left = [unit for unit in left if unit not in ready]
    return ran


_WAYS: Mapping[str, Any] = {
    "forbid_motion": lambda p, t, motion: count(t, motion),
    "forbid_object": lambda p, t, label: sum(n.label == label for n in touched(t)),
    "forbid_ingredient": lambda p, t, names: sum(
        any(has(node, name) for name in names) for node in (*touched(t), *{*p.goal_nodes})
    ),
    "least_rate": lambda p, t, least: sum(p.rates[u.motion] * 1_000_000 < least for u in t),
    "only_sources": lambda p, t, allowed: sum(not vouched(p, u, allowed) for u in t),
    "at_least_videos": lambda p, t, least: sum(len(videos(p, u)) < least for u in t),
    "motion_only_with": lambda p, t, motion, label: sum(
        u.motion == motion and not using((u,), label) for u in t
    ),
    "never_heated": lambda p, t, name, heats: sum(
        has(node, name) for u in t if u.motion in heats for node in {*u.inputs}
    ),
    "at_most_utensil_uses": lambda p, t, label, most: using(t, label) > most,
    "at_most_price": lambda p, t, most: sum(price(p, u) for u in t) * 100 > most,
    "not_both_motions": lambda p, t, one, other: count(t, one) * count(t, other),
    "require_motion": lambda p, t, motion: not count(t, motion),
    "require_object": lambda p, t, label: not using(t, label),
    "require_ingredient": lambda p, t, name: not any(has(n, name) for n in touched(t)),
    "require_intermediate": lambda p, t, label: not passes_on(p, t, label),
    "at_most_units": lambda p, t, most: len(t) > most,
    "at_most_motion": lambda p, t, motion, most: count(t, motion) > most,
    "at_most_utensils": lambda p, t, most: len({n.label for n in touched(t)} & p.utensils) > most,
    "before": early,
}


HEATS = sorted(
    motion
    for line in (encodings_folder() / "constraints" / "never_heated.lp").read_text().splitlines()
    if not line.startswith("%")
    for motion in re.findall(r'heats\("([^"]+)"\)', line)
)
_CONSTANTS = {"allergen": "forbidden_ingredient", "allowed": "allowed_source"}


def settings_of(rules: list[dict[str, Any]]) -> Settings:
    """Ask for constraints with their values, of which those that are lists have one."""
    constants = []
    for rule in rules:
        for name, value in rule.items():
            if name not in ("rule", "heats"):
                one = value[0] if isinstance(value, list) else value
                written = one if isinstance(one, int) else f'"{one}"'
                constants.append(f"{_CONSTANTS.get(name, name)}={written}")
    return Settings(tuple(Path(rule["rule"]) for rule in rules), constants=tuple(constants))


def random_rule(rng: random.Random, problem: Problem) -> dict[str, Any]:
    """Draw a constraint with values that mean something for a problem, mostly."""
    nodes = problem.network.objects
    labels = [node.label for node in nodes]
    names = [*labels, *(name for node in nodes for name in node.ingredients)]
    files = [source.file for sources in problem.network.sources for source in sources]
    values: dict[str, dict[str, Any]] = {
        "forbid_motion": {"forbidden_motion": rng.choice(MOTIONS)},
        "forbid_object": {"forbidden_object": rng.choice(labels)},
        "forbid_ingredient": {"allergen": [rng.choice(names)]},
        "least_rate": {"least_rate": rng.choice([90_000, 100_000, 300_000, 900_000])},
        "only_sources": {"allowed": [rng.choice(files)]},
        "require_motion": {"required_motion": rng.choice(MOTIONS)},
        "require_object": {"required_object": rng.choice(labels)},
        "require_ingredient": {"required_ingredient": rng.choice(names)},
        "require_intermediate": {"required_intermediate": rng.choice(labels)},
        "at_most_units": {"max_units": rng.randrange(1, 6)},
        "at_most_motion": {"limited_motion": rng.choice(MOTIONS), "max_uses": rng.randrange(3)},
        "at_most_utensils": {"max_utensils": rng.randrange(3)},
        "at_least_videos": {"least_videos": rng.randrange(3)},
        "motion_only_with": {"tied_motion": rng.choice(MOTIONS), "tied_utensil": rng.choice(labels)},
        "never_heated": {"unheated_ingredient": rng.choice(names), "heats": HEATS},
        "at_most_utensil_uses": {"limited_utensil": rng.choice(labels), "max_utensil_uses": rng.randrange(3)},
        "not_both_motions": {"one_motion": rng.choice(MOTIONS), "other_motion": rng.choice(MOTIONS)},
        "before": {"earlier_motion": rng.choice(MOTIONS), "later_motion": rng.choice(MOTIONS)},
    }
    prices = problem.prices
    if None not in prices and all(p is not None and p < 1000 and (p * 100).denominator == 1 for p in prices):
        values["at_most_price"] = {"max_price": rng.choice([0, 30, 100, 250])}
    name = rng.choice(sorted(values))
    return {"rule": name, **values[name]}
