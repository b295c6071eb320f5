"""The map from the names of a planning task to units and nodes, as JSON, by which plans are read back."""

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
    """The meaning of the actions of a planning task, and the question that the task poses.

    ``units`` maps an action's name to the unit that it executes. ``taking`` are the names of the actions that
    take a kitchen item. ``goals``, ``containers``, ``level`` and ``items`` are those of the question;
    ``items`` is ``None`` where items last.
    """

    units: Mapping[str, FunctionalUnit]
    taking: frozenset[str]
    goals: tuple[ObjectNode, ...]
    containers: str
    level: int
    items: UsedUp | None


def map_of(task: PlanningTask) -> NameMap:
    """Return the name map of a task."""
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
    """Return the name map of a task as a JSON document, in which units refer to nodes by name."""
    problem, network = task.problem, task.problem.network
    objects = dict(task.names)
    for action in task.actions:  # a unit may have nodes that the task leaves out, such as bought items
        if action.unit is not None:
            for o in (*network.inputs[action.unit], *network.outputs[action.unit]):
                objects.setdefault(o, f"unused-{network.object_number(o)}")
    actions = []
    for action in task.actions:
        unit, inputs, outputs = action.unit, action.preconditions, action.add_effects
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
            {
                "objective": str(scale.objective),
                "factor": fraction_text(scale.factor),
                "rounded": scale.rounded,
            }
            for scale in task.costs.scales
        ],
        objects=[{"name": name, "object": node} for name, node in named],
        actions=actions,
        **({} if problem.items is None else _items_json(network, problem.items)),
    )


def _items_json(network: Network, items: UsedUp) -> Json:
    """Return the stock, and the labels and nodes that the user declared to last or to be used up."""
    declared = [
        {"label": name, "object": None}
        if isinstance(name, str)
        else {"label": None, "object": named_json(network, name)}
        for name in items.told
    ]
    return {
        "stock": [{"object": named_json(network, o), "copies": n} for o, n in items.stock.items()],
        "stays": [
            {**name, "stays": stays} for name, stays in zip(declared, items.told.values(), strict=True)
        ],
    }


def read_name_map(file: Path) -> NameMap:
    """Read a map from a file.

    Raises :class:`UserError` for a file that cannot be read, and for one that :func:`map_json` cannot have
    made, with line and column where it is not JSON.
    """
    text = read_plain_text(file)
    check_json(text, str(file))
    try:
        tree = read_json(text)
        if not isinstance(tree, dict) or tree.get("schema") != schema_name(KIND):
            raise ValueError(f"its schema is not {schema_name(KIND)!r}")
        return _read(tree)
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        reason = f"{error} is missing" if isinstance(error, KeyError) else str(error)
        raise UserError(
            f"{file}: expected the map of names that foon-asp export wrote (map.json), but {reason}"
        ) from None


def _read(tree: Mapping[str, Any]) -> NameMap:
    """Return the name map of a JSON tree; a part that lacks or has another type is an error of Python."""
    nodes = {entry["name"]: read_node_json(entry["object"]) for entry in tree["objects"]}
    units = {
        action["name"]: FunctionalUnit.of(
            action["unit"]["motion"],
            [nodes[name] for name in action["inputs"]],
            [nodes[name] for name in action["outputs"]],
        )
        for action in tree["actions"]
        if action["unit"] is not None
    }
    taking = frozenset(action["name"] for action in tree["actions"] if action["unit"] is None)
    goals = tuple(map(read_node_json, tree["goals"]))
    items = None
    if tree["items"] == ITEMS[1]:
        items = UsedUp(
            {
                entry["label"] or read_node_json(entry["object"]): bool(entry["stays"])
                for entry in tree["stays"]
            },
            {read_node_json(entry["object"]): int(entry["copies"]) for entry in tree["stock"]},
        )
    return NameMap(units, taking, goals, str(tree["containers"]), int(tree["level"]), items)
