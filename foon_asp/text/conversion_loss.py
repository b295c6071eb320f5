"""Losses of a conversion: a line or object as it was read is compared with what the result is read as."""

from collections import Counter
from collections.abc import Iterator
from enum import StrEnum

from foon_asp.network import Contents, Relation
from foon_asp.text.line import Line, MotionLine, ObjectLine, StateLine, is_number
from foon_asp.text.motion_times import MotionFields, in_two_fields


class Loss(StrEnum):
    """A part of a file that some dialect cannot hold; the value is the noun for it in messages."""

    IDS = "ids"
    MOTION_FLAGS = "motion flags"
    CATEGORIES = "recipe categories"
    GOAL_MARKS = "goal marks !"
    FIELDS = "further fields"
    TIMES = "times"
    RATES = "entities and their success rates"
    PRICES = "prices of units"
    COMPOSITE = "composite marks *"
    RELATION_WORDS = "relation words: read back as in [...] or any place"
    RELATIONS = "further relations of an object"
    CONTAINERS = "containers without a word, which is any: written as in [...]"
    CONTENTS_WORDS = "words of contents: read back as contains {...}"
    CONTENTS_LISTS = "contents in several lists: joined"
    NO_CONTENTS = "empty contents {}"
    PARTS = "states, relations and contents: in the name of their object, which is all one"
    ORDER = "the order of state lines"
    COMMENTS = "comments"
    VIDEOS = "source videos"
    COPIES = "files and lines that units were merged from"


class CannotHoldError(Exception):
    """A part of a file that a dialect cannot hold, since the part would be read back with another meaning."""


def lost_in_line(line: Line, converted: Line) -> list[Loss]:
    """Return a loss for each part of ``line`` that is missing in the ``converted`` line.

    Raises :class:`CannotHoldError` if the lines differ in meaning.
    """
    lost = [Loss.IDS] if line.id and not converted.id else []
    if isinstance(line, ObjectLine) and isinstance(converted, ObjectLine):
        if line.label != converted.label:
            raise CannotHoldError(f"the label {line.label!r} would be read as {converted.label!r}")
        lost += _lost_fields(line.fields, converted.fields)
    elif isinstance(line, MotionLine) and isinstance(converted, MotionLine):
        if line.motion != converted.motion:
            raise CannotHoldError(f"the motion {line.motion!r} would be read as {converted.motion!r}")
        lost += [Loss.COMPOSITE] if line.composite and not converted.composite else []
        lost += _lost_times(MotionFields.of(line.fields), MotionFields.of(converted.fields))
    elif isinstance(line, StateLine) and isinstance(converted, StateLine):
        lost += _lost_attributes((line,), (converted,))
    else:
        raise CannotHoldError("one kind of line would be read as another")
    return lost


def lost_in_states(states: tuple[StateLine, ...], converted: tuple[StateLine, ...]) -> list[Loss]:
    """Return a loss for each part of the state lines of an object that the ``converted`` lines lack.

    A missing relation, or a missing word of a relation, is only a loss. Other states or ingredients, and a
    relation to another object, are a change of meaning: they raise :class:`CannotHoldError`.
    """
    ids = Counter(state.id for state in states if state.id) - Counter(state.id for state in converted)
    return [Loss.IDS] * ids.total() + _lost_attributes(states, converted)


def _lost_fields(fields: tuple[str, ...], converted: tuple[str, ...]) -> Iterator[Loss]:
    """Yield a loss for each field of an object line that is missing in the converted line.

    A first field ``0`` or ``1`` is a motion flag, and a later number is a recipe category.
    """
    missing = Counter(fields) - Counter(converted)
    for index, field in enumerate(fields):
        if not missing[field]:
            continue
        missing[field] -= 1
        if index == 0 and field in {"0", "1"}:
            yield Loss.MOTION_FLAGS
        elif field == "!":
            yield Loss.GOAL_MARKS
        else:
            yield Loss.CATEGORIES if index and is_number(field) else Loss.FIELDS


def _lost_times(fields: MotionFields, converted: MotionFields) -> Iterator[Loss]:
    """Yield ``TIMES`` if the times of two motion lines differ, and ``RATES`` if other fields differ.

    Other fields are the entity and the success rate. Times in one field, ``<0:14,0:20>``, count as equal to
    times in two fields.
    """
    if in_two_fields(fields.times) != in_two_fields(converted.times):
        yield Loss.TIMES
    if fields[1:] != converted[1:]:
        yield Loss.RATES


def _lost_attributes(states: tuple[StateLine, ...], converted: tuple[StateLine, ...]) -> list[Loss]:
    """Return the losses of state lines, except lost ids; raises as :func:`lost_in_states` does.

    A repeated state may be left out without a loss. ``ORDER`` is lost if the kept lines are in another order.
    """
    old_attributes, new_attributes = [s.attribute for s in states], [s.attribute for s in converted]
    missing, extra = (
        Counter(old_attributes) - Counter(new_attributes),
        Counter(new_attributes) - Counter(old_attributes),
    )
    kept = Counter(old_attributes) - missing
    lost: list[Loss] = []
    for attribute in missing.elements():
        if isinstance(attribute, Relation):
            lost.append(_lost_relation(attribute, extra))
        elif isinstance(attribute, str):
            if attribute not in kept:
                raise CannotHoldError(f"the state {attribute!r} would be lost")
        elif not attribute.ingredients:
            lost.append(Loss.NO_CONTENTS)
        elif attribute.word != "contains":
            lost.append(Loss.CONTENTS_WORDS)
    contents = [
        attribute for attribute in old_attributes if isinstance(attribute, Contents) and attribute.ingredients
    ]
    if len(contents) > 1 and any(isinstance(attribute, Contents) for attribute in missing):
        lost.append(Loss.CONTENTS_LISTS)
    if _all_ingredients(old_attributes) != _all_ingredients(new_attributes):
        raise CannotHoldError(
            f"{_attributes_text(old_attributes)} would be read as {_attributes_text(new_attributes)}"
        )
    unexpected = [attribute for attribute in extra.elements() if not isinstance(attribute, Contents)]
    if unexpected:
        raise CannotHoldError(
            f"{_attributes_text(old_attributes)} would be read as {_attributes_text(new_attributes)}"
        )
    if _kept_in_order(states, kept) != _kept_in_order(converted, kept):
        lost.append(Loss.ORDER)
    return lost


def _lost_relation(relation: Relation, extra: Counter[str | Relation | Contents]) -> Loss:
    """Return the kind of loss of a relation that is missing in the converted lines.

    If the converted lines relate to the same object by another word, return ``RELATION_WORDS``, or
    ``CONTAINERS`` for a relation without a word. Otherwise return ``RELATIONS``. ``extra`` counts the
    attributes that only the converted lines have; the relation by another word is removed from it.
    """
    for other_relation in list(extra):
        if isinstance(other_relation, Relation) and other_relation.object == relation.object:
            extra[other_relation] -= 1
            extra += Counter()  # removes entries without a count
            return Loss.RELATION_WORDS if relation.word else Loss.CONTAINERS
    return Loss.RELATIONS


def _all_ingredients(attributes: list[str | Relation | Contents]) -> list[str]:
    """Return the ingredients in all contents among attributes, sorted, with repeats."""
    return sorted(
        i for contents in attributes if isinstance(contents, Contents) for i in contents.ingredients
    )


def _kept_in_order(
    states: tuple[StateLine, ...], kept: Counter[str | Relation | Contents]
) -> list[tuple[object, tuple[str, ...]]]:
    """Return the ``kept`` attributes in the order of lines, each with its ingredients as listed."""
    return [(state.attribute, state.listed) for state in states if state.attribute in kept]


def _attributes_text(attributes: list[str | Relation | Contents]) -> str:
    """Return attributes as text for a message, ``nothing`` for none."""
    return "; ".join(map(str, attributes)) or "nothing"
