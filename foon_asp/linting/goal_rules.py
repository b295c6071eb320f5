"""Lint rules about goals and kitchens, which are compared with the network."""

from collections.abc import Iterator

from foon_asp.linting.context import Context
from foon_asp.linting.names import is_of_another_network
from foon_asp.linting.rule import ERROR, NOTE, WARNING, rule
from foon_asp.linting.sheet import Sheet
from foon_asp.network import Network, NodePattern
from foon_asp.text.diagnostics import Diagnostic
from foon_asp.text.line import ObjectLine


@rule("unmade-goal", WARNING, "a goal that no unit makes")
def find_unmade_goals(context: Context) -> Iterator[Diagnostic]:
    """No unit makes the goal, or only units that need it make it.

    A goal is an object line with a recipe category or `!`, or an entry of a list of goals. A list of goals is
    a file with `goal` in its name. Lists are compared with the networks that are linted together with them.
    If most entries of a list are unknown, a single finding reports them all.
    """
    for sheet in context.sheets:
        if sheet.entries is None:
            yield from _unmade_marked_goals(sheet, context)
    for sheet in _object_lists(context, of_goals=True):
        yield from _unknown_entries(sheet, context.network)
        for pattern, index, _ in sheet.entries or ():
            nodes = context.network.find(pattern)
            if nodes and context.made_nodes.isdisjoint(nodes):
                message = f"{str(pattern)!r} is a goal, and no unit makes it"
                yield sheet.finding(message, index, pattern.label)


@rule("unknown-item", NOTE, "an entry of a kitchen that is not in the network")
def find_unknown_items(context: Context) -> Iterator[Diagnostic]:
    """No unit of the networks that are linted with the kitchen has this node.

    There may be a slip in the kitchen or in the network, or the item is not needed. If most entries of a
    kitchen are unknown, a single finding reports them all.
    """
    for sheet in _object_lists(context, of_goals=False):
        yield from _unknown_entries(sheet, context.network)


@rule("amount", ERROR, "an amount that is no number from 1 to 1,000,000, or a second one")
def find_wrong_amounts(context: Context) -> Iterator[Diagnostic]:
    """A line `# Amount:` with a tab and a number stands below an object line and says how many there are.

    An object line has at most one such line. A kitchen or a list of goals may have an object several times.
    Then all its entries have the same amount, or none has an amount.
    """
    yield from context.remarks.get("amount", [])
    for sheet in context.sheets:
        first_amounts: dict[NodePattern, int | None] = {}
        for pattern, index, stated in sheet.entries or ():
            if first_amounts.setdefault(pattern, stated) != stated:
                yield sheet.finding(f"a second amount of {str(pattern)!r}", index, pattern.label)


def _object_lists(context: Context, of_goals: bool) -> Iterator[Sheet]:
    """Yield the sheets that are lists of goals (``of_goals``), or those that are kitchens.

    Yields nothing if the linted files have no units, as nothing can be compared then.
    """
    for sheet in context.sheets if len(context.network) else ():
        if sheet.entries is not None and sheet.lists_goals is of_goals:
            yield sheet


def _unmade_marked_goals(sheet: Sheet, context: Context) -> Iterator[Diagnostic]:
    """Yield a finding for each object of a sheet that is marked as a goal and that no unit makes.

    A node that is marked several times is reported once.
    """
    tagged = {
        sheet.lines[written_line.first_index]
        for written_line in sheet.distinct_lines
        if isinstance(written_line.line, ObjectLine) and written_line.line.is_goal
    }
    reported = set()
    for index, line in enumerate(sheet.lines) if tagged else ():
        if line not in tagged:
            continue
        _, node = next(sheet.object_nodes(index))
        if node not in reported and context.network.object_id(node) not in context.made_nodes:
            reported.add(node)
            message = f"{str(node)!r} is marked as a goal, and no unit makes it"
            yield sheet.finding(message, index, node.label)


def _unknown_entries(sheet: Sheet, network: Network) -> Iterator[Diagnostic]:
    """Yield a finding for each entry of a list that matches no object node of the network.

    If more than ten entries match none, and they are most of the list, yield one finding about them all.
    """
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
        message = (
            f"{str(pattern)!r} is no object node of the network; {_same_label_hint(pattern.label, network)}"
        )
        yield sheet.finding(message, index, pattern.label)


def _same_label_hint(label: str, network: Network) -> str:
    """Return the end of a message: a node of the network with this label, and how many more there are.

    If no node has the label, the text says so.
    """
    nodes = network.by_label.get(label, ())
    if not nodes:
        return f"none there is called {label!r}"
    others = f" and {len(nodes) - 1} more called {label!r}" if len(nodes) > 1 else ""
    return f"there is {str(network.objects[nodes[0]])!r}{others}"
