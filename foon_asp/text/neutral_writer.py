"""Writing of units and objects in the neutral form."""

from collections import Counter
from collections.abc import Iterable, Sequence
from decimal import Decimal

from foon_asp.json_layout import json_line
from foon_asp.network import ObjectNode
from foon_asp.text.conversion_loss import CannotHoldError, Loss, lost_in_line
from foon_asp.text.foon_json_writer import list_text
from foon_asp.text.format import WrittenPart
from foon_asp.text.line import MotionLine, ObjectLine
from foon_asp.text.listed_unit import ObjectBlock
from foon_asp.text.text_writer import with_container_word


def write_neutral_unit(id_: str, inputs: Iterable[str], outputs: Iterable[str], price: str) -> str:
    """Return the line of a unit, with its line end, from plain names.

    ``price`` is a decimal text, empty for a unit without a price.
    """
    sides = ([(json_line(name), 1) for name in names] for names in (inputs, outputs))
    return _unit_line(id_, price, *sides)


def _unit_line(
    id_: str, price: str, inputs: Sequence[tuple[str, int]], outputs: Sequence[tuple[str, int]]
) -> str:
    """Return the line of a unit; each name is already JSON, and stands with its amount."""
    input_list, output_list = map(_side_text, (inputs, outputs))
    price_part = f', "price": {Decimal(price):f}' if price else ""
    return f'{{"id": {json_line(id_)}, "inputs": {input_list}, "outputs": {output_list}{price_part}}}\n'


def _side_text(names: Sequence[tuple[str, int]]) -> str:
    """Return a side of a unit in JSON: a list of names, or amounts by name if some amount is not 1.

    Each of the ``names`` is already JSON, and stands with its amount. If a name comes twice, its amounts are
    added up.
    """
    if all(amount == 1 for _, amount in names):
        return f"[{', '.join(name for name, _ in names)}]"
    totals: Counter[str] = Counter()
    for name, amount in names:
        totals[name] += amount
    return f"{{{', '.join(f'{name}: {total}' for name, total in totals.items())}}}"


class NeutralWriter:
    """A writer of neutral files; the id of a unit is its motion, the name of a node its one-line notation.

    See :class:`~foon_asp.text.format.Writer` for its methods.
    """

    holds_prices = holds_no_inputs = True

    def __init__(self) -> None:
        self._names: dict[str, ObjectNode] = {}

    def block(self, block: ObjectBlock, in_list: bool) -> WrittenPart:
        """Return the name of an object node in JSON, and its losses.

        In a unit, an amount above 1 stands behind the name: ``"egg": 2``. In a list, the text is an object
        with ``label`` and, where stated, ``amount``. Raises :class:`CannotHoldError` for an empty name, for
        blanks around the name, and if an earlier node has the same name.
        """
        states = tuple(map(with_container_word, block.states))
        node = block._replace(states=states).node
        name = str(node) if states else node.label
        if not name or name != name.strip(" "):
            raise CannotHoldError(f"{name!r} is no name, or has blanks around it")
        if self._names.setdefault(name, node) != node:
            raise CannotHoldError(f"{name!r} would be the name of two object nodes")
        losses = lost_in_line(block.object, ObjectLine(block.object.label))
        losses += [Loss.IDS] * sum(bool(state.id) for state in states) + [Loss.PARTS] * bool(states)
        losses += [Loss.CONTAINERS] * (states != block.states)
        if in_list:
            stated = "" if block.amount is None else f', "amount": {block.amount}'
            return f'{{"label": {json_line(name)}{stated}}}', losses
        return json_line(name) + (f": {block.amount}" if (block.amount or 1) > 1 else ""), losses

    def motion(self, line: MotionLine) -> WrittenPart:
        """Return the motion as plain text, and its losses."""
        return line.motion, lost_in_line(line, MotionLine(line.motion))

    def unit(self, inputs: Sequence[str], motion: str, outputs: Sequence[str], price: str) -> str:
        """Return the line of a unit from its parts; ``price`` is empty for a unit without one."""
        return _unit_line(motion, price, *(list(map(_name_and_amount, names)) for names in (inputs, outputs)))

    def network(self, units: Sequence[str], videos: Sequence[str]) -> str:
        """Return the lines of all units; ``videos`` is empty."""
        return "".join(units)

    def objects(self, parts: Sequence[str]) -> str:
        """Return a JSON list of nodes, with a line end."""
        return list_text(parts, 0) + "\n"

    def held_videos(self, videos: tuple[str, ...], comments: Sequence[str]) -> tuple[str, ...]:
        """Return none, since neutral files cannot name videos."""
        return ()


def _name_and_amount(fragment: str) -> tuple[str, int]:
    """Return the name, still JSON, and the amount in the text that ``block`` wrote for a node of a unit."""
    name, _, amount = (fragment, "", "1") if fragment.endswith('"') else fragment.rpartition(": ")
    return name, int(amount)
