"""FOON units in JSON, in the two published forms.

The first form is ``{"source": [...], "functional_units": [...]}`` with ``object_label``, ``object_states``
and ids. The second is a bare list of units whose objects have ``label``, ``states``, ``ingredients`` and
``container``. Both are read into the lines of FOON text, so that all later stages are independent of the
form.
"""

from collections.abc import Iterator
from pathlib import Path

from foon_asp.network import Relation, Source
from foon_asp.text.json_list import JsonElement, JsonList, JsonNumber
from foon_asp.text.json_object import (
    NODE_KEYS,
    check_keys,
    digits_under,
    optional_name,
    price_from_json,
    read_object,
    stated_amount,
)
from foon_asp.text.line import MotionLine, StateLine
from foon_asp.text.listed_unit import ListedUnit, ObjectBlock
from foon_asp.text.motion_times import is_rate, is_time
from foon_asp.text.reading import Reading
from foon_asp.text.text_units import no_motion_message

_NEEDED = {"input_nodes", "motion_node", "output_nodes"}
_KEYS = {*_NEEDED, "price"}
_LABELS = {"label", "object_label"}
_MOTION_KEYS = {"motion_id", "motion_label", "start_time", "end_time", "robot_type", "weight_success"}


def read_json_units(text: str, file: str, reading: Reading) -> Iterator[ListedUnit]:
    """Yield the units of a JSON text in order; diagnostics are added to ``reading``.

    A ``container`` becomes the relation ``in``, unless another relation of the object names it. Units without
    input objects are left out, with a warning. Units without output objects only cause a warning. A list of
    objects alone has no units, and causes a warning. Faulty units are left out; their faults are recorded
    after the last unit.
    """
    elements = JsonList(text, Path(file), "functional_units")
    all_elements = list(elements)
    videos = _videos(elements.others.get("source"))
    if all_elements and not elements.errors and all(_is_object(element.value) for element in all_elements):
        reading.warn("no-motion", no_motion_message(len(all_elements)), all_elements[0].source)
        return
    for element in all_elements:
        try:
            unit, remarks = _unit(element, videos)
        except ValueError as error:
            elements.add_error(element.source, str(error))
            continue
        for remark in remarks:
            reading.warn("json-value", remark, element.source)
        motion = unit.motion.motion
        if not unit.inputs:
            reading.warn("no-inputs", f"the unit {motion!r} has no input objects; left out", element.source)
            continue
        if not unit.outputs:
            reading.warn("no-outputs", f"the unit {motion!r} has no output objects", element.source)
        yield unit
    for found_error in elements.errors:
        reading.reject(found_error.code, found_error.message, found_error.source, found_error.excerpt)


def _is_object(value: object) -> bool:
    """Whether a value is a JSON object with the label of an object node, and with no key of a unit."""
    return isinstance(value, dict) and not value.keys() & _NEEDED and bool(value.keys() & _LABELS)


def _videos(value: object) -> tuple[str, ...]:
    """Return the addresses of the annotated videos; ``value`` is one address or a list of addresses.

    Values that are no text are skipped.
    """
    values = value if isinstance(value, list) else [value]
    return tuple(" ".join(video.split()) for video in values if isinstance(video, str) and video.strip())


def _unit(element: JsonElement, videos: tuple[str, ...]) -> tuple[ListedUnit, list[str]]:
    """Return the unit of an element, and messages on what was left out or assumed, each once.

    Raises :class:`ValueError` for an element of another form.
    """
    value, source = element
    if not isinstance(value, dict) or not value.keys() >= _NEEDED:
        raise ValueError(f"found no functional unit, expected an object with {', '.join(sorted(_NEEDED))}")
    check_keys(value, _KEYS)
    remarks: list[str] = []
    inputs, outputs = (_blocks(value, key, source, remarks) for key in ("input_nodes", "output_nodes"))
    motion = _motion_line(value["motion_node"], remarks)
    price = price_from_json(value.get("price"))
    unit = ListedUnit(motion, inputs, outputs, (source._replace(videos=videos),), source, price)
    return unit, list(dict.fromkeys(remarks))


def _blocks(unit: dict[str, object], key: str, source: Source, remarks: list[str]) -> tuple[ObjectBlock, ...]:
    """Return the object blocks of a side of a unit, which is the list under ``key``.

    A ``container`` becomes the relation ``in``, unless another relation of the object names it. Messages on
    what was left out or assumed are added to ``remarks``. Raises :class:`ValueError` for objects of another
    form.
    """
    objects = unit[key]
    if not isinstance(objects, list):
        raise ValueError(f'found no list as "{key}", expected a list of objects')
    blocks = []
    for value in objects:
        line, states, container, object_remarks = read_object(value, NODE_KEYS)
        remarks += object_remarks
        if container is not None and not any(_relates_to(state, container) for state in states):
            states = (*states, StateLine(Relation("in", container)))
        blocks.append(ObjectBlock(line, states, source, stated_amount(value)))
    return tuple(blocks)


def _relates_to(state: StateLine, container: str) -> bool:
    """Whether a state line is a relation to an object, by any word."""
    return isinstance(state.attribute, Relation) and state.attribute.object == container


def _motion_line(value: object, remarks: list[str]) -> MotionLine:
    """Return the motion line of a unit, with the times, entity and success rate that its JSON has.

    ``value`` is the JSON object of the motion, or its label alone. A success rate without an entity is that
    of ``Robot``; an entity without a success rate is left out. An end time without a start time gets the
    start ``Assumed``. Messages on what was left out or assumed are added to ``remarks``. Raises
    :class:`ValueError` for a motion without a label, and for other faults.
    """
    if not isinstance(value, dict):
        value = {"motion_label": value}
    check_keys(value, _MOTION_KEYS)
    label = optional_name(value.get("motion_label"), "motion_label")
    if label is None:
        raise ValueError("found a motion without a label, expected a name")
    composite = label.endswith("*") and label.strip("* ") != ""
    start, end = (optional_name(value.get(key), key) for key in ("start_time", "end_time"))
    remarks += [
        f"{time!r} is not a time (m:ss or Assumed)" for time in (start, end) if time and not is_time(time)
    ]
    fields = [time for time in (start or (end and "Assumed"), end) if time]
    rate = value.get("weight_success")
    rate = rate.text if isinstance(rate, JsonNumber) else optional_name(rate, "weight_success")
    entity = optional_name(value.get("robot_type"), "robot_type")
    if rate is not None:
        if not is_rate(rate):
            raise ValueError(f'found {rate[:40]!r} as "weight_success", expected a rate from 0 to 1')
        if entity is None:
            remarks.append(f"the success rate {rate} is of no robot_type; read as that of Robot")
        fields += [entity or "Robot", rate]
    elif entity is not None:
        remarks.append(f"the robot_type {entity!r} has no weight_success; left out")
    return MotionLine(
        label.rstrip("* ") if composite else label, digits_under(value, "motion_id"), composite, tuple(fields)
    )
