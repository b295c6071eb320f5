"""What there is to say of what a unit changes: what comes from nothing, vanishes, or leaves the contents."""

from collections.abc import Iterator

from foon_asp.linting.habits import Habit, mentioned
from foon_asp.linting.names import Names
from foon_asp.linting.vocabulary import Vocabulary
from foon_asp.text.diagnostics import Diagnostic

_KNOWN, _SELDOM = 3, 8  # units of a motion, and one in that many: then it is no habit


def change_findings(names: Names, known: Vocabulary) -> Iterator[Diagnostic]:
    """Give the findings about each unit, but for what units with its motion are known to do.

    ``known`` has the habits of the motions of the files, too.
    """
    network = names.network
    grown: dict[int, list[int]] = {}  # by node, the units that make it out of what is called so
    for unit, (inputs, outputs) in enumerate(zip(network.inputs, network.outputs, strict=True)):
        before = mentioned([network.objects[node] for node in inputs])
        for node in set(outputs).difference(inputs):
            if network.objects[node].label in before:
                grown.setdefault(node, []).append(unit)
    for unit, motion in enumerate(network.motions):
        changes = names.habits.units[unit]
        habit = known.habits.get(motion, Habit())
        said: list[tuple[str, int, str]] = []
        if _is_seldom(habit.lose, habit.keep):
            for node, lost in changes.lost.items():
                said.append(
                    ("lost-contents", node, f"contains {_all(lost)} before {motion!r}, and no output has it")
                )
        for node, gained in () if _is_habit(habit.gain, habit.keep) else changes.gained.items():
            said.append(
                ("gained-contents", node, f"contains {_all(gained)} after {motion!r}, and no input has it")
            )
        for node in changes.new:
            if node in grown:
                place = names.files.copies[grown[node][0]][0]
                where = names.sheets[place.sheet].where(place.at)
                said.append(
                    ("from-nothing", node, f"comes from no input of {motion!r}; the unit on {where} makes it")
                )
            elif _is_seldom(habit.make, habit.units):
                said.append(("from-nothing", node, f"comes from no input of {motion!r}"))
        if _is_seldom(habit.end, habit.units):
            said += [
                ("vanished", node, f"is in no output of {motion!r}; where is it then?")
                for node in changes.gone
            ]
        if not said:
            continue
        copy = names.files.copies[unit][0]
        sheet = names.sheets[copy.sheet]
        lines = {node: index for index, node in sheet.blocks(copy.at)}  # an output where it is an input, too
        for code, number, message in said:
            found = network.objects[number]
            yield sheet.finding(code, f"{found.label!r} {message}", lines.get(found, copy.at), found.label)


def _is_seldom(often: int, of: int) -> bool:
    return of >= _KNOWN and _SELDOM * often <= of


def _is_habit(often: int, of: int) -> bool:
    return often > 0 and not _is_seldom(often, of)


def _all(names: list[str]) -> str:
    return ", ".join(names)
