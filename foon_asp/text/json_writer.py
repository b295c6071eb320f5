"""Writing units and objects in JSON, in the two forms that are about.

What is written is laid out like the files in these forms, and read by :mod:`foon_asp.text.json_units`.
"""

import json
import re
from collections.abc import Iterable
from functools import cache

from foon_asp.network import Contents, Relation
from foon_asp.text.conversion_times import MotionFields, in_two_fields
from foon_asp.text.json_layout import lay_out
from foon_asp.text.json_list import JsonNumber
from foon_asp.text.line import MotionLine, ObjectLine, StateLine

# What a JSON number may look like; other digits, such as 007, are written as text.
_NUMBER = re.compile(r"(0|[1-9][0-9]*)(\.[0-9]+)?")

Written = tuple[str, ...]
"""The JSON texts of the nodes of one side of a unit."""


def json_object(line: ObjectLine, states: tuple[StateLine, ...]) -> str:
    """Write an object with its ids and flag, every state line as a state.

    A relation without a word is a ``container``; contents under another word than ``contains``, and those
    after the first, are a state such as ``coated {salt}``.
    """
    ingredients: tuple[str, ...] = ()
    container = None
    written: list[dict[str, object]] = []
    for state in states:
        said = state.attribute
        label, related = str(said), None
        if isinstance(said, Relation):
            if not said.word:
                container = said.object
                continue
            label, related = said
        elif isinstance(said, Contents):
            bare = any(other["state_label"] == "contains" for other in written)
            if said.word == "contains" and state.listed and not bare:
                label, ingredients = "contains", state.listed
            else:
                label = f"{said.word} {{{','.join(state.listed)}}}"
        written.append({"state_id": _number(state.id), "state_label": label, "relative_object": related})
    flag = line.fields[0] if line.fields and line.fields[0].isdecimal() else ""
    value: dict[str, object] = {
        "object_id": _number(line.id),
        "object_label": line.label,
        "object_states": written,
        "ingredients": list(ingredients),
        "object_in_motion": _number(flag),
    }
    if line.category:
        value["recipe_category"] = _number(line.category)
    if container is not None:
        value["container"] = container
    return _text(value)


def json_motion(line: MotionLine) -> str:
    """Write a motion with its id, its times, who moves and the success rate."""
    times, entity, rate = MotionFields.of(line.fields)
    begin, end, *_ = (*in_two_fields(times), None, None)
    return _text(
        {
            "motion_id": _number(line.id),
            "motion_label": line.motion + "*" * line.composite,
            "start_time": begin,
            "end_time": end,
            "robot_type": entity,
            "weight_success": _number(rate or ""),
        }
    )


def list_object(line: ObjectLine, states: tuple[StateLine, ...]) -> str:
    """Write an object with label, states, ingredients and one container, by ``in`` if it has such a one."""
    said = [state.attribute for state in states]
    places = sorted((place for place in said if isinstance(place, Relation)), key=lambda p: p.word != "in")
    return _text(
        {
            "label": line.label,
            "states": [state for state in said if isinstance(state, str)],
            "ingredients": [item for state in states for item in state.listed],
            "container": places[0].object if places else None,
        }
    )


def list_motion(line: MotionLine) -> str:
    """Write a motion as its name alone."""
    return _text(line.motion)


def json_unit(inputs: Iterable[str], motion: str, outputs: Iterable[str]) -> str:
    """Put a unit together from the texts of its parts."""
    sides = [f"[{','.join(side)}]" for side in (inputs, outputs)]
    return f'{{"input_nodes":{sides[0]},"motion_node":{motion},"output_nodes":{sides[1]}}}'


def _number(digits: str) -> object:
    if not digits:
        return None
    return JsonNumber(digits) if _NUMBER.fullmatch(digits) else digits


def _text(value: object) -> str:
    if isinstance(value, JsonNumber):
        return value.text
    if isinstance(value, dict):
        return "{" + ",".join(f"{_text(key)}:{_text(item)}" for key, item in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ",".join(map(_text, value)) + "]"
    if isinstance(value, str):
        lone = any("\ud800" <= c <= "\udfff" for c in value)  # half a pair, which is no text in UTF-8
        return json.dumps(value, ensure_ascii=lone)
    return json.dumps(value)


@cache
def laid_out(text: str, level: int) -> str:
    """Lay out the text of an object or motion, which repeat much."""
    return lay_out(text, level)
