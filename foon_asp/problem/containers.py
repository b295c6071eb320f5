"""The two container rules: which inputs a unit asks for."""

from enum import StrEnum

from foon_asp.network import FunctionalUnit, ObjectNode


class ContainerRule(StrEnum):
    """``strict``: a unit needs every input. ``implied``: the rule of the published searches.

    Under ``implied`` a utensil node that holds exactly one ingredient is taken as given when that
    ingredient, located in that utensil (by any relation), is also an input of the same unit.
    """

    STRICT = "strict"
    IMPLIED = "implied"


def needed_inputs(
    unit: FunctionalUnit, rule: ContainerRule, utensils: frozenset[str]
) -> tuple[ObjectNode, ...]:
    """Give the inputs that the rule asks for, in the unit's order."""
    if rule is ContainerRule.STRICT:
        return unit.inputs
    return tuple(node for node in unit.inputs if not _is_implied(node, unit.inputs, utensils))


def _is_implied(node: ObjectNode, inputs: tuple[ObjectNode, ...], utensils: frozenset[str]) -> bool:
    if node.label not in utensils or len(node.ingredients) != 1:
        return False
    ingredient = node.ingredients[0]
    return any(
        other is not node and other.label == ingredient and other.is_in(node.label) for other in inputs
    )
