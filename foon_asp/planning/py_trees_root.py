"""Behaviour trees of this program executed by py_trees (``pip install 'foon-asp[robot]'``)."""

from collections.abc import Callable
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple
from xml.etree import ElementTree

from foon_asp.errors import UserError
from foon_asp.planning.behaviour_tree import ACTION, CONDITION, LIST_SEPARATOR, UNTIL_SUCCESS

if TYPE_CHECKING:
    from py_trees.behaviour import Behaviour
    from py_trees.common import Status


class Execution(NamedTuple):
    """One execution of a functional unit: the ports of an action in a behaviour tree.

    Object nodes have their names in PDDL, such as ``o46-ice-cubed-in-drinking-glass``.

    ``step``: the number of the step, from 1.
    ``unit``: the id of the functional unit.
    ``motion``: its motion.
    ``needs``: nodes that have to be available.
    ``makes``: nodes that are available afterwards.
    ``acted_on``: nodes that the motion is done to.
    ``tools``: nodes that it is done with.
    ``origins``: places that the inputs are in, on or at.
    ``destinations``: places that the outputs are in, on or at.
    ``rate``: the success rate; ``None`` if it is not known.
    ``duration``: the duration in seconds; ``None`` if it is not known.

    Example:
        >>> foon_asp.Execution(1, 26, "twist", ("o43-ice",), ("o46-ice",)).motion
        'twist'
    """

    step: int
    unit: int
    motion: str
    needs: tuple[str, ...]
    makes: tuple[str, ...]
    acted_on: tuple[str, ...] = ()
    tools: tuple[str, ...] = ()
    origins: tuple[str, ...] = ()
    destinations: tuple[str, ...] = ()
    rate: float | None = None
    duration: float | None = None


Execute = Callable[[Execution], bool | None]
"""Executes a unit: ``True`` if that succeeded, ``False`` if it failed, ``None`` while it is going on."""
IsAvailable = Callable[[str], bool]
"""Whether an object node is there, by its name in PDDL."""


def py_trees_root(xml: str | PathLike[str], execute: Execute, is_available: IsAvailable) -> "Behaviour":
    """Make a tree of py_trees from a behaviour tree of this program.

    Tick it until its status is ``SUCCESS``; each tick after a failure tries again.

    Parameters:
        xml: A string is the text of the XML; a path is that of a file with the text.
        execute: A function that is called with an :class:`Execution` to execute a unit. It returns ``True``
            if the execution succeeded, ``False`` if it failed. While the execution goes on, it returns
            ``None``, and the next tick calls it again.
        is_available: A function that is called with the name of an object node, and returns whether the node
            is there.

    Returns:
        The root, a ``py_trees.behaviour.Behaviour``.

    Raises:
        UserError: if py_trees is not installed, or for XML that is not of this program.

    Example:
        >>> answer = foon_asp.solve(foon_asp.load().problem("ice"))
        >>> kitchen = {node for step in answer.robot_plan().robot_steps for node in step.needs}
        >>> root = foon_asp.py_trees_root(answer.behaviour_tree(), print, lambda name: False)
        >>> root.name
        'ice; crushed; in [drinking glass]'
    """
    try:
        import py_trees  # noqa: F401, PLC0415 (an extra)
    except ImportError:
        raise UserError("running a behaviour tree needs py_trees: pip install 'foon-asp[robot]'") from None
    expected = "expected XML of --format behaviour-tree"
    text, name = (xml, "the behaviour tree") if isinstance(xml, str) else (_file_text(Path(xml)), str(xml))
    try:
        element = ElementTree.fromstring(text).find("BehaviorTree/*")
    except ElementTree.ParseError as error:
        raise UserError(f"{name}: {error}") from None
    if element is None:
        raise UserError(f"{name}: found no <BehaviorTree>, {expected}")
    try:
        return _behaviour(element, execute, is_available)
    except KeyError as error:
        raise UserError(f"{name}: found an element without {error}, {expected}") from None
    except ValueError as error:
        raise UserError(f"{name}: {error}, {expected}") from None


def _file_text(file: Path) -> str:
    """Return the text of a file; raises :class:`UserError` if it cannot be read."""
    try:
        return file.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise UserError(f"{file}: cannot be read: {error}") from None


def _behaviour(element: ElementTree.Element, execute: Execute, is_available: IsAvailable) -> "Behaviour":
    """Return the py_trees behaviour of an XML element, with its children.

    Raises :class:`UserError` for an element that is not of this program, :class:`KeyError` for a missing
    attribute, and :class:`ValueError` for an attribute that is no number or a missing child.
    """
    from py_trees import behaviours, composites, decorators  # noqa: PLC0415

    name = element.get("name", element.get("ID", element.tag))
    children = [_behaviour(child, execute, is_available) for child in element]
    behaviour: Behaviour
    match element.tag, element.get("ID"):
        case ("ReactiveSequence" | "Sequence") as tag, _:
            behaviour = composites.Sequence(name, memory=tag == "Sequence", children=children)
        case "Fallback", _:
            behaviour = composites.Selector(name, memory=True, children=children)
        case "RetryUntilSuccessful", _:
            attempts = int(element.attrib["num_attempts"])
            if not children:
                raise ValueError(f"found no child of {element.tag}")
            failures = float("inf") if attempts == UNTIL_SUCCESS else attempts
            behaviour = decorators.Retry(name, children[0], failures)  # type: ignore[arg-type]
        case "AlwaysSuccess", _:
            behaviour = behaviours.Success(name)
        case "Condition", id_ if id_ == CONDITION:
            nodes = _port_names(element, "nodes")
            behaviour = _leaf(name, lambda: all(map(is_available, nodes)))
        case "Action", id_ if id_ == ACTION:
            execution = _execution(element)
            behaviour = _leaf(name, lambda: execute(execution))
        case _:
            raise UserError(f"found the node {element.tag} {name!r}, which is not of this program")
    return behaviour


def _leaf(name: str, ask: Callable[[], bool | None]) -> "Behaviour":
    """Return a behaviour without children, whose status is what ``ask`` returns at each tick.

    ``True`` means success, ``False`` failure, ``None`` running.
    """
    from py_trees.behaviour import Behaviour  # noqa: PLC0415
    from py_trees.common import Status  # noqa: PLC0415

    class Leaf(Behaviour):
        """The behaviour, which calls ``ask`` at each tick."""

        def update(self) -> "Status":
            """Return the status of a tick."""
            outcome = ask()
            return Status.RUNNING if outcome is None else Status.SUCCESS if outcome else Status.FAILURE

    return Leaf(name)


def _execution(element: ElementTree.Element) -> Execution:
    """Return the execution that the ports of an action element describe.

    Raises :class:`KeyError` without the step, the unit or the motion; other ports may be missing.
    """
    ports = element.attrib
    needs, makes, acted_on, tools, origins, destinations = (
        _port_names(element, port) for port in ("needs", "makes", "acted_on", "tools", "from", "to")
    )
    rate, duration = (float(ports[port]) if port in ports else None for port in ("rate", "duration"))
    step, unit, motion = int(ports["step"]), int(ports["unit"]), ports["motion"]
    return Execution(step, unit, motion, needs, makes, acted_on, tools, origins, destinations, rate, duration)


def _port_names(element: ElementTree.Element, port: str) -> tuple[str, ...]:
    """Return the names of object nodes in a port; empty without the port."""
    return tuple(filter(None, element.get(port, "").split(LIST_SEPARATOR)))
