"""A certificate taken apart for people: the cases of its proof, and who crosses each cut."""

import math
from collections.abc import Iterable, Mapping
from fractions import Fraction
from typing import Any

from foon_asp.document.json_document import mention_json, nodes_json
from foon_asp.problem import Objective, Problem, multiplies
from foon_asp.text.json_value import Json


def proof_json(problem: Problem, content: Json) -> Json:
    """Give a certificate, its cases, and the names of the units and object nodes that these are about.

    A case is a part of the proof without branches: what is ``given`` in it, and the cuts that carry weight,
    or the one that nobody crosses, each with its members. Of what is ``dear``, a tree has one in this case;
    in those after it, trees have none. Weights and costs are those by the first objective,
    and approximate: for products of rates, negative logarithms. Nodes that rules of the claim add are left
    out.
    """
    network = problem.network
    nodes = len(network.objects)
    cases: list[Json] = []
    waiting: list[tuple[Json, tuple[Json, ...]]] = [(content["proof"], ())]
    while waiting:
        part, given = waiting.pop()
        if "branch" in part:
            ((kind, number),) = part["branch"].items()
            waiting += [
                (part[side], (*given, {"kind": kind, "id": number, "taken": side == "using"}))
                for side in ("without", "using")
            ]
        else:
            cases.append(_case(problem, content, part, given))
            if "dear" in part:
                left_out = ({**each, "taken": False} for each in cases[-1]["dear"])
                waiting.append((part["others"], (*given, *left_out)))
    known = {o for case in cases for cut in case["cuts"] for o in cut["nodes"]}
    units = {member for case in cases for cut in case["cuts"] for member in cut["members"]}
    named = [each for case in cases for each in (*case["given"], *case["dear"])]
    units |= {each["id"] for each in named if each["kind"] == "unit"}
    known |= {each["id"] for each in named if each["kind"] == "item"}
    return {
        "certificate": content,
        "cost": _cost(content),
        "cases": cases,
        "units": [mention_json(network, unit) for unit in sorted(units) if unit < len(network)],
        "objects": nodes_json(network, sorted(o for o in known if o < nodes)),
    }


def _case(problem: Problem, content: Json, part: Json, given: tuple[Json, ...]) -> Json:
    left_out = {each["id"] for each in given if each["kind"] == "unit" and not each["taken"]}
    weights = part["weights"] if "weights" in part else [[part["hopeless"], None]] * ("hopeless" in part)
    cuts = []
    for place, weight in weights:
        cut = content["cuts"][place]
        cuts.append(
            {
                "nodes": [o for o in cut if o < len(problem.network.objects)],
                "weight": None if weight is None else _approximate(weight[0]),
                "members": sorted(_members(problem, cut) - left_out),
            }
        )
    dear = [
        {"kind": kind, "id": number} for choice in part.get("dear", ()) for kind, number in choice.items()
    ]
    ends = next(key for key in ("hopeless", "broken", "weights") if key in part)
    paid = _paid(problem, content, given)
    return {"given": list(given), "dear": dear, "ends": ends, "paid": paid, "cuts": cuts}


def _members(problem: Problem, cut: Iterable[int]) -> set[int]:
    """Give the units that make a node of a cut and need none."""
    inside = frozenset(cut)
    found: set[int] = set()
    for o in inside:
        if o < len(problem.network.objects) and o not in problem.kitchen:
            found.update(u for u in problem.makers[o] if inside.isdisjoint(problem.needs[u]))
    return found


def _cost(content: Json) -> float | None:
    """Give what the tree of a certificate costs, in the measure of the weights."""
    if content["claim"] == "optimal":
        figure = float(Fraction(content["costs"][0]))
        return -math.log(figure) if _multiplied(content["objective"][0]) else figure
    return None if content["bound"] is None else _approximate(content["bound"][0])


def _paid(problem: Problem, content: Json, given: Iterable[Json]) -> float:
    """Give what the units and items cost that are given to be taken."""
    if not content["objective"]:
        return 0.0
    name = content["objective"][0]
    total = 0.0
    for each in given:
        if each["taken"] and each["kind"] == "item":
            total += 1.0
        elif each["taken"] and each["kind"] == "unit" and name != "kitchen":
            figure = float(Fraction(problem.costs([each["id"]]).measures[name]))
            total += -math.log(figure) if _multiplied(name) else figure
    return total


def _approximate(component: str | Mapping[str, str] | Any) -> float:
    if isinstance(component, Mapping):
        return math.fsum(-math.log(Fraction(r)) * float(Fraction(e)) for r, e in component.items())
    return float(Fraction(component))


def _multiplied(name: str) -> bool:
    return name in Objective and multiplies(Objective(name))
