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
    """A part of a file that a dialect cannot hold, since it would be read back with another meaning."""


def lost_in_line(before: Line, after: Line) -> list[Loss]:
    """Return what a converted line lacks: parts of ``before`` that ``after`` has not, one entry for each.

    Raises :class:`CannotHoldError` if the lines differ in meaning.
    """
    lost = [Loss.IDS] if before.id and not after.id else []
    if isinstance(before, ObjectLine) and isinstance(after, ObjectLine):
        if before.label != after.label:
            raise CannotHoldError(f"the label {before.label!r} would be read as {after.label!r}")
        lost += _lost_fields(before.fields, after.fields)
    elif isinstance(before, MotionLine) and isinstance(after, MotionLine):
        if before.motion != after.motion:
            raise CannotHoldError(f"the motion {before.motion!r} would be read as {after.motion!r}")
        lost += [Loss.COMPOSITE] if before.composite and not after.composite else []
        lost += _lost_times(MotionFields.of(before.fields), MotionFields.of(after.fields))
    elif isinstance(before, StateLine) and isinstance(after, StateLine):
        lost += _lost_attributes((before,), (after,))
    else:
        raise CannotHoldError("one kind of line would be read as another")
    return lost


def lost_in_states(before: tuple[StateLine, ...], after: tuple[StateLine, ...]) -> list[Loss]:
    """Return what the converted state lines of an object lack, one entry for each part.

    A relation without a word is a container, and stands for a relation with any word. Raises
    :class:`CannotHoldError` if the object would be read back with other states, relations or ingredients.
    """
    ids = Counter(s.id for s in before if s.id) - Counter(s.id for s in after)
    return [Loss.IDS] * ids.total() + _lost_attributes(before, after)


def _lost_fields(before: tuple[str, ...], after: tuple[str, ...]) -> Iterator[Loss]:
    """Yield a loss for each field of an object line that the converted line has not."""
    missing = Counter(before) - Counter(after)
    for index, field in enumerate(before):
        if not missing[field]:
            continue
        missing[field] -= 1
        if index == 0 and field in {"0", "1"}:
            yield Loss.MOTION_FLAGS
        elif field == "!":
            yield Loss.GOAL_MARKS
        else:
            yield Loss.CATEGORIES if index and is_number(field) else Loss.FIELDS


def _lost_times(before: MotionFields, after: MotionFields) -> Iterator[Loss]:
    """Yield ``TIMES`` if the times of two motion lines differ, and ``RATES`` if entity or success rate do."""
    if in_two_fields(before.times) != in_two_fields(after.times):
        yield Loss.TIMES
    if before[1:] != after[1:]:
        yield Loss.RATES


def _lost_attributes(before: tuple[StateLine, ...], after: tuple[StateLine, ...]) -> list[Loss]:
    """Return what converted state lines lack, ids aside; raises as :func:`lost_in_states` does."""
    old_attributes, new_attributes = [s.attribute for s in before], [s.attribute for s in after]
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
    if _kept_in_order(before, kept) != _kept_in_order(after, kept):
        lost.append(Loss.ORDER)
    return lost


def _lost_relation(relation: Relation, extra: Counter[str | Relation | Contents]) -> Loss:
    """Return the loss of a relation: of its word, or of all of it.

    Only the word is lost if the result relates to the same object by another word. ``extra`` counts the
    attributes that only the result has; that other relation is removed from it.
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
    """Return the attributes that are ``kept``, each with its listed ingredients, in line order."""
    return [(state.attribute, state.listed) for state in states if state.attribute in kept]


def _attributes_text(attributes: list[str | Relation | Contents]) -> str:
    """Return attributes as text for a message, ``nothing`` for none."""
    return "; ".join(map(str, attributes)) or "nothing"
