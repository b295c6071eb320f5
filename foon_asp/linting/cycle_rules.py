"""What there is to say of dead cycles."""

from collections.abc import Iterator

from foon_asp.linting.linted_files import LintedFiles
from foon_asp.linting.names import Names
from foon_asp.linting.vocabulary import Vocabulary
from foon_asp.network import counted
from foon_asp.network.dead_cycles import DeadCycle, dead_cycles
from foon_asp.text.diagnostics import Diagnostic

_SHOWN = 4  # steps of a cycle


def cycle_findings(names: Names, known: Vocabulary) -> Iterator[Diagnostic]:
    """Give a finding for each dead cycle, where the cycle is entered; kitchens among the files break some.

    A utensil that is nothing but on, off or empty is at hand: a tap that is turned on and off is no slip.
    """
    files, network = names.files, names.network
    at_hand = {
        node
        for sheet in files.sheets
        if sheet.entries is not None and not sheet.lists_goals
        for entry in sheet.entries
        for node in network.find(entry.pattern)
    }
    at_hand.update(
        number
        for number, node in enumerate(network.objects)
        if node.label in known.utensils and not node.relations and not node.contents
    )
    for cycle in dead_cycles(network, at_hand):
        yield _finding(files, cycle)


def _finding(files: LintedFiles, cycle: DeadCycle) -> Diagnostic:
    network = files.network
    start, first_unit = cycle.steps[0]
    copy = files.copies[first_unit][0]
    sheet = files.sheets[copy.sheet]
    ways = []
    for (_, unit), (node, _) in zip(cycle.steps, (*cycle.steps[1:], cycle.steps[0]), strict=True):
        place = files.copies[unit][0]
        where = files.sheets[place.sheet].where(place.at, sheet)
        ways.append(f"{network.motions[unit]!r} ({where}) makes {str(network.objects[node])!r}")
    if len(ways) > _SHOWN:
        ways[_SHOWN - 1 : -1] = [counted(len(ways) - _SHOWN, "more step")]
    name = str(network.objects[start])
    others = (
        f"; {len(cycle.nodes)} objects wait for each other" if len(cycle.nodes) > len(cycle.steps) else ""
    )
    message = (
        f"only units that need {name!r} make it: from it {', from that '.join(ways)}{others}; "
        "it has to be in the kitchen, or made in another way"
    )
    return sheet.finding("dead-cycle", message, sheet.line_of(network.objects[start], copy.at))
