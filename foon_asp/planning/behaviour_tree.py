"""A plan as a behaviour tree: XML of BehaviorTree.CPP 4, which Groot2 reads.

If items last, the tree is a reactive sequence with a fallback for each step: first the condition that the
outputs of the step are there, then its action. So a step starts only after its inputs were made, and a step
that failed is tried again at the next tick. The tree has three nodes for each step. If items are used up, an
output may be gone later. So the tree is a sequence with two nodes for each step: the condition that its
inputs are there, then the action, which is repeated until it succeeds.
"""

from collections.abc import Iterable, Sequence
from typing import NamedTuple
from xml.etree import ElementTree

from msgspec import field

from foon_asp.escapes import escaped
from foon_asp.planning.pddl_name import pddl_name
from foon_asp.planning.robot_step import RobotStep
from foon_asp.results.values import Node, Value

CONDITION = "NodesAvailable"
ACTION = "ExecuteUnit"
UNTIL_SUCCESS = -1  # num_attempts of RetryUntilSuccessful without a limit


class Branch(Value, frozen=True):
    """A task tree to follow, and for how long.

    Attributes:
        failures: How many executions may fail before the next branch begins.
        robot_steps: The steps, in an order that executes; a step that another branch did is skipped.
    """

    failures: int
    robot_steps: tuple[RobotStep, ...] = field(name="steps")


class _Port(NamedTuple):
    """An input port of a node: its name, its C++ type, and its meaning for people."""

    name: str
    type: str
    meaning: str


_NODES = "std::vector<std::string>"
_PORTS = {
    ("Condition", CONDITION): (_Port("nodes", _NODES, "object nodes that all have to be there"),),
    ("Action", ACTION): (
        _Port("step", "int", "number of the step in its plan, from 1"),
        _Port("unit", "int", "id of the functional unit"),
        _Port("motion", "std::string", "the motion"),
        _Port("needs", _NODES, "object nodes that have to be there"),
        _Port("makes", _NODES, "object nodes that are there afterwards"),
        _Port("acted_on", _NODES, "what the motion is done to"),
        _Port("tools", _NODES, "what it is done with"),
        _Port("from", _NODES, "what the inputs are in, on or at"),
        _Port("to", _NODES, "what the outputs are in, on or at"),
        _Port("rate", "double", "success rate, if known"),
        _Port("duration", "double", "seconds, if known"),
    ),
}
LIST_SEPARATOR = ";"  # BehaviorTree.CPP splits lists at it


def node_name(node: Node) -> str:
    """Return the name of an object node in ports: ``o43-ice``, its name in PDDL.

    A node that the network does not have, such as a place that is no object of a unit, is named by its label,
    with commas for ``;`` and parentheses for braces.
    """
    if node.id is None:
        return _without_braces(node.label).replace(LIST_SEPARATOR, ",")
    return pddl_name("o", node.id, node.node)


def behaviour_tree_text(name: str, branches: Sequence[Branch], is_used_up: bool) -> str:
    """Return a behaviour tree as XML of BehaviorTree.CPP 4, with the definitions of its nodes' ports.

    Parameters:
        name: The name of the root, for people.
        branches: The trees to follow, the first one first. If a branch has failed as often as it may, the
            next one begins with the nodes that are then available.
        is_used_up: Whether items are used up. If so, there is a single branch. Its ``failures`` have no
            effect, since each action is repeated until it succeeds.
    """
    root = ElementTree.Element("root", BTCPP_format="4", main_tree_to_execute="Plan")
    tree = ElementTree.SubElement(root, "BehaviorTree", ID="Plan")
    parent = tree
    if len(branches) > 1:
        parent = ElementTree.SubElement(tree, "Fallback", name="the plan, and other ways")
    for branch in branches:
        if is_used_up:
            _add_sequence(parent, name, branch.robot_steps)
        else:
            branch_parent = parent if branch.failures == 1 else _add_retry(parent, branch.failures)
            _add_reactive_sequence(branch_parent, name, branch.robot_steps)
    model = ElementTree.SubElement(root, "TreeNodesModel")
    for (kind, node_id), ports in _PORTS.items():
        definition = ElementTree.SubElement(model, kind, ID=node_id)
        for port in ports:
            ElementTree.SubElement(
                definition, "input_port", name=port.name, type=port.type
            ).text = port.meaning
    ElementTree.indent(root)
    return f'<?xml version="1.0" encoding="UTF-8"?>\n{ElementTree.tostring(root, encoding="unicode")}\n'


def _add_reactive_sequence(parent: ElementTree.Element, name: str, steps: Iterable[RobotStep]) -> None:
    """Add to an element the reactive sequence of the steps of a branch, for items that last.

    A step is a fallback: the condition that its outputs are available, or else its action. A step without
    outputs has only the action. Without steps, the sequence succeeds.
    """
    sequence = ElementTree.SubElement(parent, "ReactiveSequence", name=escaped(name))
    for step in steps:
        fallback = ElementTree.SubElement(sequence, "Fallback", name=_step_name(step))
        if step.makes:  # else nothing shows that it is done
            _add_condition(fallback, step.makes)
        _add_action(fallback, step)
    if not len(sequence):
        ElementTree.SubElement(sequence, "AlwaysSuccess")


def _add_sequence(parent: ElementTree.Element, name: str, steps: Iterable[RobotStep]) -> None:
    """Add to an element the sequence of the steps of a branch, for items that are used up.

    A step is the condition that its inputs are available, then its action, which is repeated until it
    succeeds. Without steps, the sequence succeeds.
    """
    sequence = ElementTree.SubElement(parent, "Sequence", name=escaped(name))
    for step in steps:
        _add_condition(sequence, step.needs)
        _add_action(_add_retry(sequence, UNTIL_SUCCESS), step)
    if not len(sequence):
        ElementTree.SubElement(sequence, "AlwaysSuccess")


def _add_retry(parent: ElementTree.Element, attempts: int) -> ElementTree.Element:
    """Add a node that repeats its child until it succeeds, up to a number of attempts; return the node."""
    return ElementTree.SubElement(parent, "RetryUntilSuccessful", num_attempts=str(attempts))


def _add_condition(parent: ElementTree.Element, nodes: Iterable[Node]) -> None:
    """Add the condition that object nodes are available."""
    ElementTree.SubElement(parent, "Condition", ID=CONDITION, nodes=_node_list(nodes))


def _add_action(parent: ElementTree.Element, step: RobotStep) -> None:
    """Add the action that executes the unit of a step, with its ports.

    The ports for rate and duration are left out if these are not known.
    """
    numbers = {"rate": step.rate, "duration": step.duration}
    ElementTree.SubElement(
        parent,
        "Action",
        {
            "ID": ACTION,
            "name": _step_name(step),
            "step": str(step.step),
            "unit": str(step.id),
            "motion": _without_braces(step.motion),
            "needs": _node_list(step.needs),
            "makes": _node_list(step.makes),
            "acted_on": _node_list(step.acted_on),
            "tools": _node_list(step.tools),
            "from": _node_list(step.origins),
            "to": _node_list(step.destinations),
            **{port: f"{float(value):.15g}" for port, value in numbers.items() if value is not None},
        },
    )


def _without_braces(name: str) -> str:
    """Return a name with parentheses for braces, since ``{name}`` would be a blackboard entry.

    Characters that cannot be printed are escaped.
    """
    return escaped(name).replace("{", "(").replace("}", ")")


def _step_name(step: RobotStep) -> str:
    """Return the name of a step: its number and motion."""
    return escaped(f"{step.step} {step.motion}")


def _node_list(nodes: Iterable[Node]) -> str:
    """Return the names of object nodes as the value of a port, separated by ``;``."""
    return LIST_SEPARATOR.join(map(node_name, nodes))
