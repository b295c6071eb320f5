"""Goals and kitchens, compared with the network."""

from collections.abc import Iterator

from foon_asp.linting.context import Context
from foon_asp.linting.names import is_of_another_network
from foon_asp.linting.rule import ERROR, NOTE, WARNING, rule
from foon_asp.linting.sheet import Sheet
from foon_asp.network import Network, NodePattern
from foon_asp.text.diagnostics import Diagnostic
from foon_asp.text.line import ObjectLine


@rule("unmade-goal", WARNING, "a goal that no unit makes")
def unmade_goal(context: Context) -> Iterator[Diagnostic]:
    """The goal is not an output of any unit, or only of units that need it.

    It is an object line with a recipe category or `!`, or an entry of a list of goals (a file with `goal` in
    its name). Lists are compared with the networks that are linted together with them.
    """
    for sheet in context.sheets:
        if sheet.entries is None:
            yield from _tagged(sheet, context)
    for sheet in _lists(context, of_goals=True):
        yield from _unknown(sheet, context.network)
        for pattern, index, _ in sheet.entries or ():
            nodes = context.network.find(pattern)
            if nodes and context.made.isdisjoint(nodes):
                message = f"{str(pattern)!r} is a goal, and no unit makes it"
                yield sheet.finding(message, index, pattern.label)


@rule("unknown-item", NOTE, "an entry of a kitchen that is not in the network")
def unknown_item(context: Context) -> Iterator[Diagnostic]:
    """No unit of the networks linted with the kitchen has this node.

    There may be a slip in one of the two, or the item is not needed. If most entries of a kitchen are
    unknown, they are reported together.
    """
    for sheet in _lists(context, of_goals=False):
        yield from _unknown(sheet, context.network)


@rule("amount", ERROR, "an amount that is no number from 1 to 1,000,000, or a second one")
def amount(context: Context) -> Iterator[Diagnostic]:
    """A line `# Amount:`, a tab and a number is under an object line, once, and says how many there are.

    An object that a kitchen or a list of goals has several times has the same amount each time, or none.
    """
    yield from context.remarks.get("amount", [])
    for sheet in context.sheets:
        first_amounts: dict[NodePattern, int | None] = {}
        for pattern, index, stated in sheet.entries or ():
            if first_amounts.setdefault(pattern, stated) != stated:
                yield sheet.finding(f"a second amount of {str(pattern)!r}", index, pattern.label)


def _lists(context: Context, of_goals: bool) -> Iterator[Sheet]:
    """Yield the lists of goals, or the kitchens; without units, there is nothing to compare them with."""
    for sheet in context.sheets if len(context.network) else ():
        if sheet.entries is not None and sheet.lists_goals is of_goals:
            yield sheet


def _tagged(sheet: Sheet, context: Context) -> Iterator[Diagnostic]:
    """Yield a finding for each tagged goal that is not made."""
    tagged = {
        sheet.lines[written_line.first]
        for written_line in sheet.distinct_lines
        if isinstance(written_line.line, ObjectLine) and written_line.line.is_goal
    }
    reported = set()
    for index, line in enumerate(sheet.lines) if tagged else ():
        if line not in tagged:
            continue
        _, node = next(sheet.blocks(index))
        if node not in reported and context.network.object_id(node) not in context.made:
            reported.add(node)
            message = f"{str(node)!r} is marked as a goal, and no unit makes it"
            yield sheet.finding(message, index, node.label)


def _unknown(sheet: Sheet, network: Network) -> Iterator[Diagnostic]:
    """Yield a finding for each entry of a list that is no object node, or a single one if most are none."""
    entries = sheet.entries or ()
    unknown = [entry for entry in entries if not network.find(entry.pattern)]
    if is_of_another_network(len(unknown), len(entries)):
        pattern, index, _ = unknown[0]
        message = (
            f"{len(unknown)} of the {len(entries)} entries are no object nodes of the network, "
            f"{str(pattern)!r} first; is the list for another network?"
        )
        yield sheet.finding(message, index, pattern.label)
        return
    for pattern, index, _ in unknown:
        message = f"{str(pattern)!r} is no object node of the network; {_alike(pattern.label, network)}"
        yield sheet.finding(message, index, pattern.label)


def _alike(label: str, network: Network) -> str:
    """Return the nodes that have a label, in words."""
    nodes = network.by_label.get(label, ())
    if not nodes:
        return f"none there is called {label!r}"
    others = f" and {len(nodes) - 1} more called {label!r}" if len(nodes) > 1 else ""
    return f"there is {str(network.objects[nodes[0]])!r}{others}"
