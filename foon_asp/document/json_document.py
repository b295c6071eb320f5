"""What every verb prints with ``--format json``: one head, and units, steps and figures in one form.

docs/json.md describes it, and the schemas say it for programs.
"""

from collections.abc import Collection, Iterable, Iterator, Mapping
from decimal import Decimal
from fractions import Fraction

from foon_asp.network import FunctionalUnit, Network, ObjectNode, Source
from foon_asp.problem import Costs, Objective, Problem, kitchen_needed
from foon_asp.text.json_node import node_json, place_json
from foon_asp.text.json_value import Json, schema_name


def document(
    kind: str, problem: Problem | None = None, objectives: Iterable[str] = (), /, **fields: object
) -> Json:
    """Give a document of a kind; one about a problem begins with what was asked."""
    head: Json = {}
    if problem is not None:
        network = problem.network
        goals = goals_json(network, problem.goals)
        items = "lasting" if problem.items is None else "used-up"
        starting = nodes_json(network, kitchen_needed(problem)) if problem.starting else None
        head = head_json(goals, problem.containers, network.level, objectives, items, starting)
    return {"schema": schema_name(kind), **head, **fields}


def head_json(
    goals: list[Json],
    containers: str,
    level: int,
    objectives: Iterable[str],
    items: str = "lasting",
    starting_kitchen: list[Json] | None = None,
) -> Json:
    """Give what every document about goals begins with.

    ``starting_kitchen`` are the items that can be needed, where no kitchen was given.
    """
    head = {"goals": goals, "containers": str(containers), "items": items, "level": level}
    return {**head, "objectives": list(map(str, objectives)), "starting_kitchen": starting_kitchen}


def goals_json(network: Network, goals: Iterable[int]) -> list[Json]:
    """Give goals; below level 3 with the level-3 nodes that each stands for."""
    goals = tuple(goals)
    listed = nodes_json(network, goals)
    if network.detailed is not None:
        for goal, shown in zip(goals, listed, strict=True):
            shown["stands_for"] = nodes_json(network.detailed, network.objects_stand_for[goal])
    return listed


def nodes_json(network: Network, ids: Iterable[int]) -> list[Json]:
    """Give nodes of a network."""
    return [node_json(network.objects[o], network.object_number(o)) for o in ids]


def named_json(network: Network, node: ObjectNode) -> Json:
    """Give a node that a network may have or not."""
    o = network.object_id(node)
    return node_json(node, None if o is None else network.object_number(o))


def mention_json(network: Network, unit: int) -> Json:
    """Give what a unit is known by: its id, motion and places."""
    shown = unit_json(network, unit)
    return {key: shown[key] for key in ("id", "motion", "source")}


def unit_json(network: Network, unit: int) -> Json:
    """Give a unit; below level 3 with the level-3 units that it stands for."""
    shown = {
        "id": network.unit_number(unit),
        "motion": network.motions[unit],
        "inputs": nodes_json(network, network.inputs[unit]),
        "outputs": nodes_json(network, network.outputs[unit]),
        "source": list(map(place_json, network.sources[unit])),
    }
    if network.detailed is not None:
        shown["stands_for"] = [unit_json(network.detailed, detail) for detail in network.stands_for[unit]]
    return shown


def listed_unit_json(network: Network, unit: FunctionalUnit, place: Source) -> Json:
    """Give a unit that was listed somewhere, and that a network may have or not."""
    number = network.unit_id(unit)
    inputs, outputs = ([named_json(network, node) for node in side] for side in (unit.inputs, unit.outputs))
    return {
        "id": None if number is None else network.unit_number(number),
        "motion": unit.motion,
        "inputs": inputs,
        "outputs": outputs,
        "source": [place_json(place)],
    }


def steps_json(problem: Problem, units: Collection[int], bought: Collection[int] = ()) -> list[Json]:
    """Give units as the steps of a plan: where each input comes from, and which outputs are made."""
    network = problem.network
    steps = []
    for step, (unit, origins) in enumerate(input_origins(problem, units, bought), 1):
        shown = unit_json(network, unit)
        for node, o, origin in zip(shown["inputs"], network.inputs[unit], origins, strict=True):
            node["from"] = origin
            if problem.items is not None:
                node["stays"] = o not in problem.flows[unit].uses
        for node, o in zip(shown["outputs"], network.outputs[unit], strict=True):
            node["made"] = o in problem.gives[unit]
        steps.append({"step": step, **shown})
    return steps


def input_origins(
    problem: Problem, units: Collection[int], bought: Collection[int] = ()
) -> Iterator[tuple[int, list[Json]]]:
    """Say for each unit, in the order listed, where each of its inputs comes from.

    ``bought`` are the items of the kitchen, by id, that were not there before. In a list that does not
    execute as it is, a needed input may be made by a later step only, or by none.
    """
    if problem.items is not None:
        yield from _copies_origins(problem, units)
        return
    makers: dict[int, list[int]] = {}
    for step, unit in enumerate(units, 1):
        for o in problem.gives[unit]:
            makers.setdefault(o, []).append(step)
    for step, unit in enumerate(units, 1):
        origins: list[Json] = []
        for o in problem.network.inputs[unit]:
            if o in problem.kitchen:
                origins.append({"bought" if o in bought else "kitchen": True})
                continue
            makes = makers.get(o, ())
            if makes and makes[0] < step:
                origins.append({"step": makes[0]})
            elif o not in problem.needs[unit]:
                origins.append({"implied": True})
            else:
                later = next((maker for maker in makes if maker > step), 0)
                origins.append({"later_step": later} if later else {"missing": True})
        yield unit, origins


def _copies_origins(problem: Problem, plan: Collection[int]) -> Iterator[tuple[int, list[Json]]]:
    """Say the same of a plan in which items are used up: each input is the oldest copy that there is."""
    copies: dict[int, list[Json]] = {}
    for o in problem.kitchen:
        copies[o] = [{"kitchen": True}] * (problem.stock_of(o) or 0)
    for step, unit in enumerate(plan, 1):
        asks, uses, adds = problem.flows[unit]
        origins: list[Json] = []
        for o in problem.network.inputs[unit]:
            if o in problem.endless:
                origins.append({"kitchen": True})
            elif o not in asks:
                origins.append({"implied": True})
            elif not copies.get(o):
                origins.append({"missing": True})
            else:
                origins.append(copies[o].pop(0) if o in uses else copies[o][0])
        for o in adds:
            copies.setdefault(o, []).append({"step": step})
        yield unit, origins


def fraction_json(value: Fraction | None) -> Json | None:
    """Give an exact number, and a float for people; ``None`` stays ``None``.

    There is no float (``None``) beside a number above all of them.
    """
    if value is None:
        return None
    return {"exact": fraction_text(value), "approx": approximate(value)}


def fraction_text(value: Fraction) -> str:
    """Write an exact number, of however many digits."""
    # through Decimal: products of long rates have more digits than Python turns into text at once
    parts = [str(Decimal(n)) for n in (value.numerator, value.denominator)]
    return "/".join(parts) if value.denominator != 1 else parts[0]


def approximate(value: Fraction) -> float | None:
    """Give the nearest float; ``None`` for a number above all."""
    try:
        return float(value)
    except OverflowError:
        return None


def figure_json(objective: Objective, figure: int | Fraction | None) -> object:
    """Give what an objective measures: a whole number, or an exact fraction; ``None`` stays ``None``."""
    if figure is None or objective.row.whole:
        return None if figure is None else int(figure)
    return fraction_json(Fraction(figure))


def costs_json(costs: Costs | None) -> Json | None:
    """Give all measures of a tree by objective, ``None`` where nothing is known, and its ingredients."""
    if costs is None:
        return None
    figures = figures_json({**dict.fromkeys(Objective), **costs.measures})
    return figures | {"ingredients": costs.ingredients}


def figures_json(figures: Mapping[Objective, int | Fraction | None]) -> Json:
    """Give what is measured by several objectives."""
    return {str(objective): figure_json(objective, figure) for objective, figure in figures.items()}
