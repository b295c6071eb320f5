"""Lint rules about objects and contents that appear or vanish in a unit."""

from collections.abc import Iterator

from foon_asp.linting.context import Context
from foon_asp.linting.habits import Changes, Habit, mentioned_names
from foon_asp.linting.rule import WARNING, rule
from foon_asp.network import ObjectNode
from foon_asp.text.diagnostics import Diagnostic


def _is_seldom(count: int, total: int) -> bool:
    """Whether ``count`` of ``total`` units with a motion are few: at most one in eight.

    False for fewer than three units, which tell nothing about a motion.
    """
    return total >= 3 and 8 * count <= total


def _units_with_habits(context: Context) -> Iterator[tuple[int, str, Changes, Habit]]:
    """Yield the id of each unit, its motion, its changes, and the habit of its motion.

    The habit counts the units of the files and those of the vocabulary.
    """
    for unit, motion in enumerate(context.network.motions):
        yield unit, motion, context.habits.changes_by_unit[unit], context.all_names.habit(motion)


def _finding_at(context: Context, unit: int, side: int, node: int, message: str) -> Diagnostic:
    """Return a finding about an input (``side`` 0) or output (1) in the first copy of a unit.

    ``node`` is the id of the input or output, whose label is put before the message.
    """
    object_node = context.network.objects[node]
    copy = context.files.copies[unit][0]
    return context.finding_at_node(copy, side, object_node, f"{object_node.label!r} {message}")


@rule("lost-contents", WARNING, "contents that lose something, which no output has")
def find_lost_contents(context: Context) -> Iterator[Diagnostic]:
    """A container keeps some of its contents in a unit; other contents of it are in no output of the unit.

    Motions that are known to take something out, such as `drain`, are not reported, nor are unknown motions.
    """
    for unit, motion, changes, habit in _units_with_habits(context):
        for node, lost in changes.lost.items() if _is_seldom(habit.lose, habit.keep) else ():
            message = f"contains {', '.join(lost)} before {motion!r}, and no output has it"
            yield _finding_at(context, unit, 1, node, message)


@rule("gained-contents", WARNING, "contents that gain something, which no input has")
def find_gained_contents(context: Context) -> Iterator[Diagnostic]:
    """A container keeps its contents in a unit and gets further contents, which are in no input.

    Motions that show what is inside, such as `open`, are not reported.
    """
    for unit, motion, changes, habit in _units_with_habits(context):
        is_habit = habit.gain and not _is_seldom(habit.gain, habit.keep)
        for node, gained in () if is_habit else changes.gained.items():
            message = f"contains {', '.join(gained)} after {motion!r}, and no input has it"
            yield _finding_at(context, unit, 1, node, message)


@rule("from-nothing", WARNING, "an output that nothing among the inputs is or contains")
def find_outputs_from_nothing(context: Context) -> Iterator[Diagnostic]:
    """An output comes from no input, as far as names and contents tell.

    It is reported if units with the motion seldom make anything new. It is also reported if another unit
    makes the same object out of an input that has its name.
    """
    units_by_made_node = _units_by_made_node(context)
    for unit, motion, changes, habit in _units_with_habits(context):
        for node in changes.new:
            message = f"comes from no input of {motion!r}"
            producer = units_by_made_node.get(context.network.objects[node])
            if producer is not None:
                copy = context.files.copies[producer][0]
                message += f"; the unit on {context.sheets[copy.sheet].line_name(copy.first_index)} makes it"
            elif not _is_seldom(habit.make, habit.units):
                continue
            yield _finding_at(context, unit, 1, node, message)


def _units_by_made_node(context: Context) -> dict[ObjectNode, int]:
    """Return, by node, the id of the first unit that makes it out of inputs with its label among their names.

    The names of an input are its label, its contents and the objects of its relations. Nodes without such a
    unit are left out.
    """
    units: dict[ObjectNode, int] = {}
    for side in context.sides:
        input_names = mentioned_names(side.others) if side.number == 1 else set()
        for node in set(side.nodes).difference(side.others):
            if node.label in input_names:
                units.setdefault(node, side.unit)
    return units


@rule("vanished", WARNING, "an input that no output is or contains")
def find_vanished_ingredients(context: Context) -> Iterator[Diagnostic]:
    """An ingredient is in no output, neither as an object nor among contents, and the unit makes nothing new.

    Motions that use things up, such as `wash`, are not reported, nor are unknown motions.
    """
    for unit, motion, changes, habit in _units_with_habits(context):
        for node in changes.gone if _is_seldom(habit.end, habit.units) else ():
            message = f"is in no output of {motion!r}; where is it then?"
            yield _finding_at(context, unit, 0, node, message)
