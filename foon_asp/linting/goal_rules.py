"""Findings about goals and kitchens, compared with a network."""

from collections.abc import Iterator

from foon_asp.linting.linted_files import LintedFiles
from foon_asp.linting.sheet import Entry, Sheet
from foon_asp.network import Network
from foon_asp.text.diagnostics import Diagnostic
from foon_asp.text.line import ObjectLine

_MANY = 10  # entries of a list: if most of it is unknown, it is told of as a whole


def goal_findings(files: LintedFiles) -> Iterator[Diagnostic]:
    """Give the goals that no unit makes, and the kitchen items that are no object node.

    A unit makes what is among its outputs and not among its inputs. Without units, nothing is said of lists.
    """
    network = files.network
    sides = zip(network.inputs, network.outputs, strict=True)
    made = {node for inputs, outputs in sides for node in set(outputs).difference(inputs)}
    for sheet in files.sheets:
        if sheet.entries is None:
            yield from _tagged(sheet, network, made)
        elif len(network):
            yield from _listed(sheet, network, made)


def _tagged(sheet: Sheet, network: Network, made: set[int]) -> Iterator[Diagnostic]:
    tagged = {
        sheet.lines[written.first]
        for written in sheet.distinct_lines
        if isinstance(written.line, ObjectLine) and written.line.is_goal
    }
    if not tagged:
        return
    said = set()
    for index, line in enumerate(sheet.lines):
        if line not in tagged:
            continue
        _, node = next(sheet.blocks(index))
        if node in said or network.object_id(node) in made:
            continue
        said.add(node)
        message = f"{str(node)!r} is marked as a goal, and no unit makes it"
        yield sheet.finding("unmade-goal", message, index, node.label)


def _listed(sheet: Sheet, network: Network, made: set[int]) -> Iterator[Diagnostic]:
    unknown: list[Entry] = []
    for entry in sheet.entries or ():
        pattern, index = entry
        found = network.find(pattern)
        if not found:
            unknown.append(entry)
        elif sheet.lists_goals and made.isdisjoint(found):
            message = f"{str(pattern)!r} is a goal, and no unit makes it"
            yield sheet.finding("unmade-goal", message, index, pattern.label)
    if len(unknown) > _MANY and 2 * len(unknown) > len(sheet.entries or ()):
        pattern, index = unknown[0]
        message = (
            f"{len(unknown)} of the {len(sheet.entries or ())} entries are no object nodes of the network, "
            f"{str(pattern)!r} first; is the list for another network?"
        )
        yield sheet.finding(_code(sheet), message, index, pattern.label)
        return
    for pattern, index in unknown:
        message = f"{str(pattern)!r} is no object node of the network; {_alike(pattern.label, network)}"
        yield sheet.finding(_code(sheet), message, index, pattern.label)


def _code(sheet: Sheet) -> str:
    return "unmade-goal" if sheet.lists_goals else "unknown-item"


def _alike(label: str, network: Network) -> str:
    """Say which nodes have the label."""
    nodes = network.by_label.get(label, ())
    if not nodes:
        return f"none there is called {label!r}"
    more = f" and {len(nodes) - 1} more called {label!r}" if len(nodes) > 1 else ""
    return f"there is {str(network.objects[nodes[0]])!r}{more}"
