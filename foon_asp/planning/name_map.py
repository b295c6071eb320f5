"""The name map: what the names of a planning task mean, as JSON, so that plans can be read back."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple, Self

from msgspec import UNSET, UnsetType

from foon_asp.errors import UserError
from foon_asp.json_layout import read_json, schema_name
from foon_asp.network import FunctionalUnit, Network, ObjectNode
from foon_asp.planning.planning_task import PlanningTask, taking_action_name
from foon_asp.problem import ITEMS, Objective, UsedUp
from foon_asp.results.document import AboutGoals
from foon_asp.results.plain_values import fraction_text
from foon_asp.results.values import Copies, Mention, Node, Value
from foon_asp.results.values_of import copies_of, mention_of, named_node, node_of, question_fields
from foon_asp.text.foon_json_indent import check_json
from foon_asp.text.json_node import read_node_json
from foon_asp.text.plain_file import read_plain_text

KIND = "pddl-map"


class NameMap(NamedTuple):
    """The meaning of the actions of a planning task, and the question that the task stands for.

    ``units`` maps the name of an action to the unit that it executes. ``taking`` has the names of the actions
    that take a kitchen item. ``goals``, ``containers``, ``level`` and ``items`` are those of the question. If
    items last, ``items`` is ``None``.
    """

    units: Mapping[str, FunctionalUnit]
    taking: frozenset[str]
    goals: tuple[ObjectNode, ...]
    containers: str
    level: int
    items: UsedUp | None


def name_map_of(task: PlanningTask) -> NameMap:
    """Return the name map of a planning task.

    ``taking`` has a name for every node of the task, including nodes that no action takes.
    """
    problem, network = task.problem, task.problem.network
    return NameMap(
        {action.name: network.unit(action.unit) for action in task.actions if action.unit is not None},
        frozenset(map(taking_action_name, task.names.values())),
        problem.goal_nodes,
        str(problem.containers),
        network.level,
        problem.items,
    )


class Scale(Value, frozen=True):
    """How the values of an objective became whole numbers.

    Attributes:
        factor: What its values were multiplied by.
        rounded: Whether the products were rounded.
    """

    objective: Objective
    factor: str
    rounded: bool


class NamedObject(Value, frozen=True):
    """An object node, and its name in the planning task."""

    name: str
    object: Node


class NamedAction(Value, frozen=True):
    """An action of the planning task.

    Attributes:
        unit: The unit that it executes; null for an action that takes a kitchen item.
        inputs: The names of the inputs.
        outputs: The names of the outputs.
        cost: Its cost in the planning task.
    """

    name: str
    unit: Mention | None
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    cost: int


class Staying(Value, frozen=True):
    """What the user declared of a label, or of an object node: that it lasts, or is used up."""

    label: str | None
    object: Node | None
    stays: bool


class MapFile(AboutGoals, frozen=True, kw_only=True, tag=schema_name(KIND)):
    """The name map of a planning task, in which units refer to nodes by name.

    Attributes:
        scales: How objectives became the costs of actions.
        objects: The object nodes of the actions, once each.
        actions: The actions.
        stock: Where items are used up: how many copies the kitchen has.
        stays: Where items are used up: the labels and nodes that the user declared to last or to be used up.
        wanted: Where items are used up: how many copies of goals are wanted, where that is not one.
    """

    scales: tuple[Scale, ...]
    objects: tuple[NamedObject, ...]
    actions: tuple[NamedAction, ...]
    stock: tuple[Copies, ...] | UnsetType = UNSET
    stays: tuple[Staying, ...] | UnsetType = UNSET
    wanted: tuple[Copies, ...] | UnsetType = UNSET

    @classmethod
    def of(cls, task: PlanningTask) -> Self:
        """Return the name map of a planning task, in the form that is written to a file.

        Nodes of units that the task leaves out are named ``unused-NUMBER``.
        """
        problem, network = task.problem, task.problem.network
        objects = dict(task.names)
        for action in task.actions:  # a unit may have nodes that the task leaves out
            if action.unit is not None:
                for o in (*network.inputs[action.unit], *network.outputs[action.unit]):
                    objects.setdefault(o, f"unused-{network.object_number(o)}")
        actions = []
        for action in task.actions:
            unit, inputs, outputs = action.unit, action.preconditions, action.add_effects
            if unit is not None:
                inputs, outputs = network.inputs[unit], network.outputs[unit]
            actions.append(
                NamedAction(
                    action.name,
                    None if unit is None else mention_of(network, unit),
                    tuple(objects[o] for o in inputs),
                    tuple(objects[o] for o in outputs),
                    action.cost,
                )
            )
        items = problem.items
        return cls(
            **question_fields(problem, task.objectives),
            scales=tuple(
                Scale(scale.objective, fraction_text(scale.factor), scale.rounded)
                for scale in task.costs.scales
            ),
            objects=tuple(NamedObject(name, node_of(network, o)) for o, name in objects.items()),
            actions=tuple(actions),
            stock=UNSET if items is None else copies_of(network, items.stock),
            stays=UNSET if items is None else tuple(_staying(network, *pair) for pair in items.told.items()),
            wanted=UNSET if items is None else copies_of(network, items.wanted),
        )


def _staying(network: Network, name: str | ObjectNode, stays: bool) -> Staying:
    """Return what the user declared of a label or node."""
    if isinstance(name, str):
        return Staying(name, None, stays)
    return Staying(None, named_node(network, name), stays)


def read_name_map(file: Path) -> NameMap:
    """Return the name map in a file.

    Raises :class:`UserError` for a file that cannot be read, is not JSON, or is no :class:`MapFile`. If it is
    not JSON, the error has the line and column.
    """
    text = read_plain_text(file)
    check_json(text, str(file))
    try:
        content = read_json(text)
        if not isinstance(content, dict) or content.get("schema") != schema_name(KIND):
            raise ValueError(f"its schema is not {schema_name(KIND)!r}")
        return _name_map_of_json(content)
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        reason = f"{error} is missing" if isinstance(error, KeyError) else str(error)
        raise UserError(
            f"{file}: expected the map of names that foon-asp export wrote (map.json), but {reason}"
        ) from None


def _name_map_of_json(content: Mapping[str, Any]) -> NameMap:
    """Return the name map in the JSON object of a :class:`MapFile`.

    A missing or wrong value raises ``KeyError``, ``TypeError``, ``ValueError`` or ``AttributeError``.
    """
    nodes = {entry["name"]: read_node_json(entry["object"]) for entry in content["objects"]}
    units = {
        action["name"]: FunctionalUnit.of(
            action["unit"]["motion"],
            [nodes[name] for name in action["inputs"]],
            [nodes[name] for name in action["outputs"]],
        )
        for action in content["actions"]
        if action["unit"] is not None
    }
    taking = frozenset(action["name"] for action in content["actions"] if action["unit"] is None)
    goals = tuple(map(read_node_json, content["goals"]))
    items = None
    if content["items"] == ITEMS[1]:
        items = UsedUp(
            {
                entry["label"] or read_node_json(entry["object"]): bool(entry["stays"])
                for entry in content["stays"]
            },
            *(
                {read_node_json(entry["object"]): int(entry["copies"]) for entry in content[key]}
                for key in ("stock", "wanted")
            ),
        )
    return NameMap(units, taking, goals, str(content["containers"]), int(content["level"]), items)
