"""Two trees beside each other, for people and for programs."""

import json
from collections.abc import Iterator

from foon_asp.explain.difference import Difference, Side
from foon_asp.network import FunctionalUnit, ObjectNode
from foon_asp.report.answer import costs_json, costs_text, counted

_PARTINGS = 12


def difference_text(found: Difference) -> str:
    """Give the costs of both, the units that only one has, and where they part."""
    left, right = found.left, found.right
    width = max(len(left.name), len(right.name))
    lines = [
        f"{letter}: {tree.name:<{width}}    {costs_text(tree.costs)}"
        for letter, tree in (("A", left), ("B", right))
    ]
    if not found.only_left and not found.only_right:
        order = "in the same order" if found.same_order else "in another order"
        lines.append(f"the same {counted(len(found.both), 'unit')}, {order}")
    else:
        lines.append(f"{counted(len(found.both), 'unit')} in both")
        for letter, tree, units in (("A", left, found.only_left), ("B", right, found.only_right)):
            lines.append(f"only in {letter}: {counted(len(units), 'unit')}")
            lines += [f"  {_unit_text(tree, unit)}" for unit in units]
    if found.partings:
        lines.append("they part at")
        for parting in found.partings[:_PARTINGS]:
            lines.append(f"  {parting.object}")
            lines += [
                f"    {letter}: {_origin(tree, unit, parting.object)}"
                for letter, tree, unit in (("A", left, parting.left), ("B", right, parting.right))
            ]
        if len(found.partings) > _PARTINGS:
            lines.append(
                f"  ... and {counted(len(found.partings) - _PARTINGS, 'more')}; --format json lists all"
            )
    return "\n".join(lines) + "\n"


def difference_json(found: Difference) -> str:
    """Give the same for programs."""
    result = {
        "a": _side_json(found.left),
        "b": _side_json(found.right),
        "same_units": not found.only_left and not found.only_right,
        "same_order": found.same_order,
        "only_in_a": [_unit_json(found.left, unit) for unit in found.only_left],
        "only_in_b": [_unit_json(found.right, unit) for unit in found.only_right],
        "in_both": [_unit_json(found.left, unit) for unit in found.both],
        "they_part_at": [
            {
                "object": str(parting.object),
                "a": _origin_json(found.left, parting.left, parting.object),
                "b": _origin_json(found.right, parting.right, parting.object),
            }
            for parting in found.partings
        ],
    }
    return json.dumps(result, indent=2, ensure_ascii=False) + "\n"


def _side_json(tree: Side) -> dict[str, object]:
    return {"name": tree.name, "goals": [str(goal) for goal in tree.goals], "costs": costs_json(tree.costs)}


def _unit_json(tree: Side, unit: FunctionalUnit) -> dict[str, object]:
    place = tree.places[unit]
    return {
        "motion": unit.motion,
        "inputs": [str(node) for node in unit.inputs],
        "outputs": [str(node) for node in unit.outputs],
        "file": place.file,
        "line": place.line,
    }


def _unit_text(tree: Side, unit: FunctionalUnit) -> str:
    made = [str(node) for node in tree.gives[unit] if node not in tree.needs[unit]]
    return f"{unit.motion}    [{tree.places[unit]}] makes {' and '.join(_few(made)) or 'nothing new'}"


def _few(names: list[str], shown: int = 2) -> Iterator[str]:
    yield from names[:shown]
    if len(names) > shown:
        yield f"{len(names) - shown} more"


def _origin(tree: Side, unit: FunctionalUnit | None, node: ObjectNode) -> str:
    if unit is not None:
        return f"{unit.motion}    [{tree.places[unit]}]"
    return "from the kitchen" if node in tree.kitchen else "not made"


def _origin_json(tree: Side, unit: FunctionalUnit | None, node: ObjectNode) -> object:
    if unit is not None:
        return _unit_json(tree, unit)
    return "kitchen" if node in tree.kitchen else None
