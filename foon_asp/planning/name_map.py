"""What the names of a planning task stand for, as JSON, so that plans can be read back."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

from foon_asp.document.json_document import document, fraction_text, mention_json, named_json, nodes_json
from foon_asp.errors import UserError
from foon_asp.network import FunctionalUnit, Network, ObjectNode
from foon_asp.planning.planning_task import PlanningTask, taking
from foon_asp.problem import ITEMS, UsedUp
from foon_asp.text.json_layout import check_json
from foon_asp.text.json_node import read_node_json
from foon_asp.text.json_value import Json, read_json, schema_name
from foon_asp.text.plain_file import read_plain_text

KIND = "pddl-map"


class NameMap(NamedTuple):
    """What the actions of a planning task stand for, and what the task is about.

    ``units`` has the unit of every action that executes one. ``taking`` are the names of the actions that
    take a kitchen item. ``goals``, ``containers``, ``level`` and ``items`` are those of the question.
    """

    units: Mapping[str, FunctionalUnit]
    taking: frozenset[str]
    goals: tuple[ObjectNode, ...]
    containers: str
    level: int
    items: UsedUp | None


def map_of(task: PlanningTask) -> NameMap:
    """Give what the names of a task stand for, whether its actions take kitchen items or these are there."""
    problem, network = task.problem, task.problem.network
    return NameMap(
        {action.name: network.unit(action.unit) for action in task.actions if action.unit is not None},
        frozenset(map(taking, task.names.values())),
        problem.goal_nodes,
        str(problem.containers),
        network.level,
        problem.items,
    )


def map_json(task: PlanningTask) -> Json:
    """Give the same as a document; nodes that units have in common stand there once, by name."""
    problem, network = task.problem, task.problem.network
    objects = dict(task.names)
    for action in task.actions:  # what a unit may skip is no part of the task, and of the unit
        if action.unit is not None:
            for o in (*network.inputs[action.unit], *network.outputs[action.unit]):
                objects.setdefault(o, f"unused-{network.object_number(o)}")
    actions = []
    for action in task.actions:
        unit, inputs, outputs = action.unit, action.needs, action.gives
        if unit is not None:
            inputs, outputs = network.inputs[unit], network.outputs[unit]
        actions.append(
            {
                "name": action.name,
                "unit": None if unit is None else mention_json(network, unit),
                "inputs": [objects[o] for o in inputs],
                "outputs": [objects[o] for o in outputs],
                "cost": action.cost,
            }
        )
    named = zip(objects.values(), nodes_json(network, objects), strict=True)
    return document(
        KIND,
        problem,
        task.objectives,
        scales=[
            {"objective": str(each.objective), "factor": fraction_text(each.factor), "rounded": each.rounded}
            for each in task.costs.scales
        ],
        objects=[{"name": name, "object": node} for name, node in named],
        actions=actions,
        **({} if problem.items is None else _items_json(network, problem.items)),
    )


def _items_json(network: Network, items: UsedUp) -> Json:
    """Give what is in stock, and what somebody said of labels and nodes."""
    said = [
        {"label": name, "object": None}
        if isinstance(name, str)
        else {"label": None, "object": named_json(network, name)}
        for name in items.told
    ]
    return {
        "stock": [{"object": named_json(network, o), "copies": n} for o, n in items.stock.items()],
        "stays": [{**name, "stays": stays} for name, stays in zip(said, items.told.values(), strict=True)],
    }


def read_name_map(file: Path) -> NameMap:
    """Read a map from a file.

    Raises :class:`UserError` for a file that cannot be read, or is not what :func:`map_json` gives, with the
    place where it is not JSON.
    """
    text = read_plain_text(file)
    check_json(text, str(file))
    try:
        found = read_json(text)
        if not isinstance(found, dict) or found.get("schema") != schema_name(KIND):
            raise ValueError(f"its schema is not {schema_name(KIND)!r}")
        return _read(found)
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        what = f"{error} is missing" if isinstance(error, KeyError) else str(error)
        raise UserError(
            f"{file}: expected the map of names that foon-asp export wrote (map.json), but {what}"
        ) from None


def _read(found: Mapping[str, Any]) -> NameMap:
    nodes = {each["name"]: read_node_json(each["object"]) for each in found["objects"]}
    units = {
        action["name"]: FunctionalUnit.of(
            action["unit"]["motion"],
            [nodes[each] for each in action["inputs"]],
            [nodes[each] for each in action["outputs"]],
        )
        for action in found["actions"]
        if action["unit"] is not None
    }
    taking = frozenset(action["name"] for action in found["actions"] if action["unit"] is None)
    goals = tuple(map(read_node_json, found["goals"]))
    items = None
    if found["items"] == ITEMS[1]:
        items = UsedUp(
            {each["label"] or read_node_json(each["object"]): bool(each["stays"]) for each in found["stays"]},
            {read_node_json(each["object"]): int(each["copies"]) for each in found["stock"]},
        )
    return NameMap(units, taking, goals, str(found["containers"]), int(found["level"]), items)
