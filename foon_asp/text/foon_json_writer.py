"""Writing of units and objects in JSON, in the two published forms.

The texts are laid out like the published files, and read by :mod:`foon_asp.text.json_units`.
"""

import re
from collections.abc import Sequence

from foon_asp.json_layout import json_line
from foon_asp.network import Contents, NodePattern, Relation
from foon_asp.text.conversion_loss import CannotHoldError, lost_in_line, lost_in_states
from foon_asp.text.diagnostics import Severity
from foon_asp.text.foon_json_indent import STEP, lay_out
from foon_asp.text.format import Dialect, WrittenPart
from foon_asp.text.json_list import JsonNumber
from foon_asp.text.json_object import read_json_objects
from foon_asp.text.json_units import read_json_units
from foon_asp.text.line import MotionLine, ObjectLine, StateLine
from foon_asp.text.listed_unit import ListedUnit, ObjectBlock
from foon_asp.text.motion_times import MotionFields, in_two_fields
from foon_asp.text.provenance import read_copy, read_video
from foon_asp.text.reading import Reading

# What a JSON number may look like; other digits, such as 007, are written as text.
_JSON_NUMBER = re.compile(r"(0|[1-9][0-9]*)(\.[0-9]+)?")


class JsonWriter:
    """A writer of one of the JSON forms, which reads each part back to find changed meanings and losses.

    See :class:`~foon_asp.text.format.Writer` for its methods.
    """

    holds_prices = True
    holds_no_inputs = False

    def __init__(self, target: Dialect) -> None:
        self._is_list = target is Dialect.JSON_LIST
        self._level = 1 if self._is_list else 2  # at which a unit stands

    def block(self, block: ObjectBlock, in_list: bool) -> WrittenPart:
        """Return the JSON of an object, laid out for a list or a unit, and its losses.

        An amount is written in a list; in a unit, only if it is above 1. Raises :class:`CannotHoldError` if
        the text would be read as another object.
        """
        line, states = block.object, block.states
        text = (object_without_ids if self._is_list else object_with_ids)(line, states)
        if block.amount is not None and (in_list or block.amount > 1):
            text = f'{text[:-1]},"amount":{block.amount}}}'
        read_back = _read_back_object(text) if in_list else _read_back_unit(text, '"x"').inputs[0]
        losses = lost_in_line(line, read_back.object) + lost_in_states(states, read_back.states)
        return lay_out(text, 1 if in_list else self._level + 2), losses

    def motion(self, line: MotionLine) -> WrittenPart:
        """Return the JSON of a motion, laid out for a unit, and its losses.

        Raises :class:`CannotHoldError` if the text would be read as another motion.
        """
        text = (motion_without_ids if self._is_list else motion_with_ids)(line)
        read_back = _read_back_unit('{"label":"x"}', text).motion
        return lay_out(text, self._level + 1), lost_in_line(line, read_back)

    def unit(self, inputs: Sequence[str], motion: str, outputs: Sequence[str], price: str) -> str:
        """Return the JSON of a unit from the JSON of its parts; without a price, ``price`` is empty."""
        return unit_text(inputs, motion, outputs, price, self._level)

    def network(self, units: Sequence[str], videos: Sequence[str]) -> str:
        """Return the JSON of a file from the JSON of its units.

        The form ``json-list`` leaves out ``videos``, for which it has no key.
        """
        return self.objects(units) if self._is_list else network_text(videos, units)

    def objects(self, parts: Sequence[str]) -> str:
        """Return the JSON of a list from the JSON of its values, with a line end."""
        return list_text(parts, 0) + "\n"

    def held_videos(self, videos: tuple[str, ...], comments: Sequence[str]) -> tuple[str, ...]:
        """Return ``videos`` if the written file can name them as its own, else an empty tuple.

        This needs a form with a key for videos. It also needs ``comments`` that name exactly these videos and
        no copies of units.
        """
        named = tuple(video for video in map(read_video, comments) if video)
        return videos if not self._is_list and named == videos and not any(map(read_copy, comments)) else ()


def with_container(block: ObjectBlock, pattern: NodePattern) -> ObjectBlock:
    """Return a listed object with its container as the last of its states.

    The container becomes a relation without a word. An object whose pattern has no container is returned as
    it is.
    """
    if pattern.container is None:
        return block
    return block._replace(states=(*block.states, StateLine(Relation("", pattern.container))))


def _read_back_object(text: str) -> ObjectBlock:
    """Return the object that is read from the JSON of an object in a list.

    Raises :class:`CannotHoldError` if it is read with an error.
    """
    reading = Reading()
    blocks = [with_container(*entry) for entry in read_json_objects(f"[{text}]", "", reading)]
    _raise_first_error(reading)
    return blocks[0]


def _read_back_unit(node: str, motion: str) -> ListedUnit:
    """Return the unit that is read from the JSON of a motion and of a node.

    The node is the only input and the only output. Raises :class:`CannotHoldError` if the unit is read with
    an error.
    """
    text = f'[{{"input_nodes":[{node}],"motion_node":{motion},"output_nodes":[{node}]}}]'
    reading = Reading()
    units = list(read_json_units(text, "", reading))
    _raise_first_error(reading)
    return units[0]


def _raise_first_error(reading: Reading) -> None:
    """Raise :class:`CannotHoldError` for the first error among diagnostics; warnings are ignored."""
    for diagnostic in reading.diagnostics:
        if diagnostic.severity is Severity.ERROR:
            raise CannotHoldError(diagnostic.message)


def object_with_ids(line: ObjectLine, states: tuple[StateLine, ...]) -> str:
    """Return the JSON of an object in the form ``json``: with ids, flag, and each state line as a state.

    A relation without a word becomes the ``container``. The first contents with the word ``contains`` become
    the ingredients. Other contents become a state such as ``coated {salt}``. A recipe category without a
    motion flag is left out, and so are further fields.
    """
    ingredients: tuple[str, ...] = ()
    container = None
    state_values: list[dict[str, object]] = []
    for state in states:
        attribute = state.attribute
        label, related = str(attribute), None
        if isinstance(attribute, Relation):
            if not attribute.word:
                container = attribute.object
                continue
            label, related = attribute
        elif isinstance(attribute, Contents):
            has_contents = any(state_value["state_label"] == "contains" for state_value in state_values)
            if attribute.word == "contains" and state.listed and not has_contents:
                label, ingredients = "contains", state.listed
            else:
                label = f"{attribute.word} {{{','.join(state.listed)}}}"
        state_values.append(
            {"state_id": _json_number(state.id), "state_label": label, "relative_object": related}
        )
    value: dict[str, object] = {
        "object_id": _json_number(line.id),
        "object_label": line.label,
        "object_states": state_values,
        "ingredients": list(ingredients),
        "object_in_motion": _json_number(line.motion_flag or ""),
    }
    if line.category and line.motion_flag:  # without a flag before it, it would be read as the flag
        value["recipe_category"] = _json_number(line.category)
    if container is not None:
        value["container"] = container
    return _compact_json(value)


def motion_with_ids(line: MotionLine) -> str:
    """Return the JSON of a motion in the form ``json``: with id, times, moving entity and success rate.

    Parts that the line does not have are null. Times after the second are left out.
    """
    times, entity, rate = MotionFields.of(line.fields)
    begin, end, *_ = (*in_two_fields(times), None, None)
    return _compact_json(
        {
            "motion_id": _json_number(line.id),
            "motion_label": line.motion + "*" * line.composite,
            "start_time": begin,
            "end_time": end,
            "robot_type": entity,
            "weight_success": _json_number(rate or ""),
        }
    )


def object_without_ids(line: ObjectLine, states: tuple[StateLine, ...]) -> str:
    """Return the JSON of an object in the form ``json-list``: label, states, ingredients and one container.

    The container is the object of the first relation ``in``, or else of the first relation. All ingredients
    are in one list, without the words of contents.
    """
    attributes = [state.attribute for state in states]
    relations = sorted(
        (attribute for attribute in attributes if isinstance(attribute, Relation)),
        key=lambda relation: relation.word != "in",
    )
    return _compact_json(
        {
            "label": line.label,
            "states": [state for state in attributes if isinstance(state, str)],
            "ingredients": [item for state in states for item in state.listed],
            "container": relations[0].object if relations else None,
        }
    )


def motion_without_ids(line: MotionLine) -> str:
    """Return the JSON of a motion in the form ``json-list``: its name alone."""
    return _compact_json(line.motion)


def unit_text(inputs: Sequence[str], motion: str, outputs: Sequence[str], price: str, level: int) -> str:
    """Return the JSON of a unit from the JSON of its parts, laid out for nesting ``level``.

    The motion has to be laid out one level deeper, the objects two levels deeper. ``price`` is a decimal
    text, empty for a unit without a price.
    """
    key_indent = "\n" + STEP * (level + 1)
    lists = (list_text(objects, level + 1) for objects in (inputs, outputs))
    price_part = f',{key_indent}"price": {_compact_json(_json_number(price))}' if price else ""
    return '{{{0}"input_nodes": {1},{0}"motion_node": {3},{0}"output_nodes": {2}{4}{5}}}'.format(
        key_indent, *lists, motion, price_part, "\n" + STEP * level
    )


def network_text(videos: Sequence[str], units: Sequence[str]) -> str:
    """Return the JSON of a file in the form ``json``; its ``units`` are JSON laid out for level 2.

    Without ``videos``, the key ``source`` is left out.
    """
    source = f'    "source": {list_text(list(map(_compact_json, videos)), 1)},\n' if videos else ""
    return f'{{\n{source}    "functional_units": {list_text(units, 1)}\n}}\n'


def list_text(values: Sequence[str], level: int) -> str:
    """Return the JSON of a list, laid out for nesting ``level``.

    ``values`` are the JSON of its values, laid out one level deeper.
    """
    if not values:
        return "[]"
    start = "\n" + STEP * (level + 1)
    return "[" + ",".join(start + value for value in values) + "\n" + STEP * level + "]"


def _json_number(digits: str) -> object:
    """Return digits as a number of JSON; without digits, return ``None``.

    Digits that are no number of JSON, such as ``007``, are returned as text.
    """
    if not digits:
        return None
    return JsonNumber(digits) if _JSON_NUMBER.fullmatch(digits) else digits


def _compact_json(value: object) -> str:
    """Return a plain value as JSON without blanks; a ``JsonNumber`` in it is written as a number."""
    if isinstance(value, JsonNumber):
        return value.text
    if isinstance(value, dict):
        return (
            "{" + ",".join(f"{_compact_json(key)}:{_compact_json(item)}" for key, item in value.items()) + "}"
        )
    if isinstance(value, list):
        return "[" + ",".join(map(_compact_json, value)) + "]"
    return json_line(value)
