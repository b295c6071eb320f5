"""The JSON formats: FOON units in the two published forms, and lists of objects."""

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from foon_asp.network import FunctionalUnit, NodePattern
from foon_asp.text.diagnostics import InputError
from foon_asp.text.exact_number import read_price
from foon_asp.text.foon_json_indent import check_json, lay_out
from foon_asp.text.format import Dialect, Format, Writer
from foon_asp.text.json_list import JsonList, begins_json
from foon_asp.text.json_names import json_mentions, rename_in_json
from foon_asp.text.json_object import read_json_objects
from foon_asp.text.json_units import read_json_units
from foon_asp.text.line import Line, Mention
from foon_asp.text.listed_unit import ListedUnit, ObjectBlock
from foon_asp.text.plain_file import usual_line_end
from foon_asp.text.reading import Reading

if TYPE_CHECKING:
    from foon_asp.text.conversion_ids import Numbering
    from foon_asp.text.renaming import Renaming


class FoonJson(Format):
    """FOON in JSON, in either published form; the keys tell which one it is."""

    dialects: tuple[Dialect, ...] = (Dialect.JSON, Dialect.JSON_LIST)
    suffix = list_suffix = ".json"
    machine_written = True

    def recognises(self, text: str, file: str) -> bool:
        """Whether the text begins with ``{`` or ``[``, after blanks."""
        return begins_json(text)

    def dialect(self, text: str) -> Dialect:
        """Return the published form of a text.

        It is ``JSON`` if the text is an object, or if its object nodes have the key ``object_label``.
        Otherwise it is ``JSON_LIST``.
        """
        by_its_name = any("object_label" in value for value in _objects_telling_form(text))
        return Dialect.JSON if by_its_name or text.lstrip(" \t\r\n")[0] == "{" else Dialect.JSON_LIST

    def lists_objects(self, text: str) -> bool:
        """Whether the text is a list that begins with a text or with an object without ``input_nodes``."""
        first = next(iter(JsonList(text, Path())), None) if text.lstrip(" \t\r\n")[0] == "[" else None
        if first is None or not isinstance(first.value, dict | str):
            return False
        return isinstance(first.value, str) or "input_nodes" not in first.value

    def listed_units(self, text: str, file: str, reading: Reading) -> Iterator[ListedUnit]:
        """Yield the units of a text in order, with equivalent lines of FOON text.

        Prices and diagnostics are recorded in ``reading``.
        """
        for unit in read_json_units(text, file, reading):
            if unit.price:
                copy = FunctionalUnit.of(unit.motion.motion, *unit.sides)
                reading.prices.add(copy, read_price(unit.price), unit.motion_source)
            yield unit

    def objects(self, text: str, file: str, reading: Reading) -> Iterator[tuple[ObjectBlock, NodePattern]]:
        """Yield the objects of a kitchen or of goals, each with its pattern.

        A ``container`` is in the pattern alone, not in the block.
        """
        return read_json_objects(text, file, reading)

    def lines(self, text: str) -> Iterator[Line]:
        """Yield objects and motions as lines of FOON text; parts that cannot be understood are left out.

        The motion of a unit comes before its objects.
        """
        reading = Reading(lenient=True)
        if self.lists_objects(text):
            for block, _ in self.objects(text, "", reading):
                yield from block.lines
            return
        for unit in self.listed_units(text, "", reading):
            yield unit.motion
            for block in unit.inputs + unit.outputs:
                yield from block.lines

    def canonical_text(self, text: str, file: str, lenient: bool = False) -> str:
        """Return JSON laid out anew; a line end after the last bracket is neither added nor removed.

        All lines get the most frequent line end. A text that is not JSON raises :class:`InputError`. If
        ``lenient``, it is returned unchanged instead.
        """
        try:
            check_json(text, file)
        except InputError:
            if not lenient:
                raise
            return text
        laid_out = lay_out(text) + ("\n" if text.rstrip(" \t")[-1:] in {"\r", "\n"} else "")
        return laid_out.replace("\n", usual_line_end(text))

    def mentions(self, text: str, file: str) -> Iterator[Mention]:
        """Yield every mention of a name; raises :class:`InputError` for a text that is not JSON."""
        check_json(text, file)
        return json_mentions(text)

    def renamed_text(self, text: str, file: str, renaming: "Renaming") -> str:
        """Return a text with the new name; see :class:`~foon_asp.text.renaming.Renaming`."""
        return rename_in_json(text, renaming)

    def writer(self, target: Dialect, numbering: "Numbering") -> Writer:
        """Return a writer of networks and lists of objects in one of the forms; ``numbering`` is not used."""
        from foon_asp.text.foon_json_writer import JsonWriter  # noqa: PLC0415 (only for conversions)

        return JsonWriter(target)


def _objects_telling_form(text: str) -> Iterator[dict[str, object]]:
    """Yield the objects whose keys tell the form of a text, if there are any.

    In a text with units, they are the input nodes of the first unit. In a list of objects, it is the first
    object.
    """
    first = next(iter(JsonList(text, Path(), "functional_units")), None)
    value = first.value if first else None
    if not isinstance(value, dict):
        return
    nodes = value.get("input_nodes")
    for node in nodes if isinstance(nodes, list) else [value]:
        if isinstance(node, dict):
            yield node
