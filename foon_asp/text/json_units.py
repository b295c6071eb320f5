"""FOON units in JSON, in the two forms that are about.

The one is ``{"source": [...], "functional_units": [...]}`` with ``object_label``, ``object_states`` and ids;
the other a bare list of units whose objects have ``label``, ``states``, ``ingredients`` and ``container``.
Both are read into the lines that FOON text would have, so that nothing after the reading knows which it was.
"""

from collections.abc import Iterator
from pathlib import Path

from foon_asp.network import Relation, Source
from foon_asp.text.diagnostics import Diagnostic, Severity
from foon_asp.text.json_list import JsonElement, JsonList, JsonNumber
from foon_asp.text.json_object import first_of, number, optional_name, read_object
from foon_asp.text.line import MotionLine, StateLine
from foon_asp.text.listed_unit import ListedUnit, ObjectBlock

_KEYS = {"input_nodes", "motion_node", "output_nodes"}
_MOTION_KEYS = {"motion_id", "motion_label", "start_time", "end_time", "robot_type", "weight_success"}


def is_json(text: str) -> bool:
    """Whether a text is JSON; no line of FOON text begins with a bracket."""
    return text[:1_000].lstrip(" \t\r\n")[:1] in {"{", "["}


def read_json_units(
    text: str, file: str, diagnostics: list[Diagnostic], lenient: bool
) -> Iterator[ListedUnit]:
    """Give the units in order; what is wrong goes to ``diagnostics``, under ``lenient`` as warnings.

    An object whose ``container`` is named without a word is ``in`` it.
    """
    elements = JsonList(text, Path(file), "functional_units")
    listed = list(elements)
    videos = _videos(elements.others.get("source"))
    for element in listed:
        try:
            unit = _unit(element, videos)
        except ValueError as problem:
            elements.error(element.source, str(problem))
            continue
        if not unit.inputs:
            message = f"the unit {unit.motion.motion!r} has no input objects; left out"
            diagnostics.append(Diagnostic(Severity.WARNING, "no-inputs", message, element.source))
            continue
        if not unit.outputs:
            message = f"the unit {unit.motion.motion!r} has no output objects"
            diagnostics.append(Diagnostic(Severity.WARNING, "no-outputs", message, element.source))
        yield unit
    if lenient:
        diagnostics += [
            error._replace(severity=Severity.WARNING, message=f"{error.message}; left out")
            for error in elements.errors
        ]
    else:
        diagnostics += elements.errors


def _videos(value: object) -> tuple[str, ...]:
    """The videos that were annotated: one address, or a list."""
    found = value if isinstance(value, list) else [value]
    return tuple(video.strip() for video in found if isinstance(video, str) and video.strip())


def _unit(element: JsonElement, videos: tuple[str, ...]) -> ListedUnit:
    value, source = element
    if not isinstance(value, dict) or not value.keys() >= _KEYS:
        raise ValueError(f"found no functional unit, expected an object with {', '.join(sorted(_KEYS))}")
    if unknown := sorted(value.keys() - _KEYS):
        raise ValueError(f"found the key {unknown[0]!r}, expected one of {', '.join(sorted(_KEYS))}")
    sides = (_side(value, key, source) for key in ("input_nodes", "output_nodes"))
    inputs, outputs = sides
    return ListedUnit(
        _motion(value["motion_node"]), inputs, outputs, (source._replace(videos=videos),), source
    )


def _side(unit: dict[str, object], key: str, source: Source) -> tuple[ObjectBlock, ...]:
    objects = unit[key]
    if not isinstance(objects, list):
        raise ValueError(f'found no list as "{key}", expected a list of objects')
    blocks = []
    for value in objects:
        line, states, container = read_object(value)
        if container is not None and not any(_names(state, container) for state in states):
            states = (*states, StateLine(Relation("in", container)))
        blocks.append(ObjectBlock(line, states, source))
    return tuple(blocks)


def _names(state: StateLine, container: str) -> bool:
    return isinstance(state.attribute, Relation) and state.attribute.object == container


def _motion(value: object) -> MotionLine:
    if not isinstance(value, dict):
        value = {"motion_label": value}
    if unknown := sorted(value.keys() - _MOTION_KEYS):
        raise ValueError(f"found the key {unknown[0]!r}, expected one of {', '.join(sorted(_MOTION_KEYS))}")
    label = optional_name(first_of(value, ("motion_label",))[1], "motion_label")
    if label is None:
        raise ValueError("found a motion without a label, expected a name")
    composite = label.endswith("*") and label.strip("* ") != ""
    times = [optional_name(value.get(key), key) for key in ("start_time", "end_time")]
    fields = [time for time in times if time]
    rate = value.get("weight_success")
    rate = rate.text if isinstance(rate, JsonNumber) else optional_name(rate, "weight_success")
    if rate is not None:
        fields += [optional_name(value.get("robot_type"), "robot_type") or "Robot", rate]
    return MotionLine(
        label.rstrip("* ") if composite else label, number(value, "motion_id"), composite, tuple(fields)
    )
