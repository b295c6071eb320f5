"""Lint rule about dead cycles: objects that are made only by units that need them."""

from collections.abc import Iterator

from foon_asp.linting.context import Context
from foon_asp.linting.rule import NOTE, rule
from foon_asp.network import counted
from foon_asp.network.dead_cycles import dead_cycles
from foon_asp.text.diagnostics import Diagnostic


@rule("dead-cycle", NOTE, "objects that are made only by units that need them")
def find_dead_cycles(context: Context) -> Iterator[Diagnostic]:
    """No task tree can make the objects of a cycle unless one is available, as each needs another of them.

    This may be intended, as with a bottle that is opened and closed again. Then put one of the objects into
    the kitchen, and lint the kitchen together with the network. Otherwise a state is wrong, and the cycle was
    meant to begin with another object. A unit that both needs and makes an object, such as the knife that
    chops, does not count as making it. All objects outside the cycle are assumed to be available. Utensils
    are available in any state, such as a stove that is off. The cycle is reported at the unit where it is
    first entered.
    """
    network, sheets = context.network, context.sheets
    for cycle in dead_cycles(network, _available_nodes(context)):
        start, first_unit = cycle.steps[0]
        copy = context.files.copies[first_unit][0]
        steps = []
        for (_, unit), (node, _) in zip(cycle.steps, (*cycle.steps[1:], cycle.steps[0]), strict=True):
            step_copy = context.files.copies[unit][0]
            location = sheets[step_copy.sheet].line_name(step_copy.first_index, sheets[copy.sheet])
            steps.append(f"{network.motions[unit]!r} ({location}) makes {str(network.objects[node])!r}")
        if len(steps) > 4:
            steps[3:-1] = [counted(len(steps) - 4, "more step")]
        others = ""
        if len(cycle.nodes) > len(cycle.steps):
            others = f"; {len(cycle.nodes)} objects wait for each other"
        message = (
            f"only units that need {str(network.objects[start])!r} make it: from it "
            f"{', from that '.join(steps)}{others}; it has to be in the kitchen, or made in another way"
        )
        line = context.node_line(copy, 0, network.objects[start])
        yield sheets[copy.sheet].finding(message, line)


def _available_nodes(context: Context) -> set[int]:
    """Return the ids of nodes that a linted kitchen lists, and of utensils without relations and contents.

    Utensils are those of the vocabulary.
    """
    available = {
        number
        for number, node in enumerate(context.network.objects)
        if node.label in context.vocabulary.utensils and not node.relations and not node.contents
    }
    for sheet in context.sheets:
        for entry in sheet.entries or () if not sheet.lists_goals else ():
            available.update(context.network.find(entry.pattern))
    return available
