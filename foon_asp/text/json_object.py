"""Reading object nodes from JSON, in either of the published forms."""

import json
from collections.abc import Iterator
from decimal import Decimal
from pathlib import Path
from typing import NamedTuple

from foon_asp.json_layout import json_line
from foon_asp.network import Contents, NodePattern, ObjectNode, Relation, Source
from foon_asp.text.amount_mark import EXPECTED_AMOUNT, parse_amount
from foon_asp.text.exact_number import MAX_LETTERS, read_price
from foon_asp.text.json_list import JsonList, JsonNumber
from foon_asp.text.json_node import read_node_json
from foon_asp.text.line import MOTION_FLAGS, LineError, ObjectLine, StateLine, is_number
from foon_asp.text.line_parser import parse_node, read_state
from foon_asp.text.listed_unit import ObjectBlock
from foon_asp.text.reading import Reading

# The equivalent keys of the two forms, and the keys that are allowed.
_LABEL, _STATES = ("label", "object_label"), ("states", "object_states")
_STATE_LABEL, _RELATED = ("state_label", "label"), ("relative_object", "related_object")
LISTED_UNDER = "contains"
"""The word that listed ingredients are read under."""

_OTHERS = {"ingredients", "container", "object_id", "object_in_motion", "has_portions", "recipe_category"}
KEYS = {*_LABEL, *_STATES, *_OTHERS}
NODE_KEYS = {*KEYS, "amount"}
"""The keys of an object of a unit or a list."""
_STATE_KEYS = {*_STATE_LABEL, *_RELATED, "state_id"}


class JsonObject(NamedTuple):
    """An object node read from JSON, as lines of FOON text.

    ``container`` is an object that the node is in, on or at, by an unknown word; ``None`` without one.
    ``remarks`` are messages on repairs, and on parts that lines cannot hold.
    """

    line: ObjectLine
    states: tuple[StateLine, ...]
    container: str | None
    remarks: tuple[str, ...] = ()


def read_object(value: object, keys: set[str] = KEYS) -> JsonObject:
    """Return the node of a JSON object, in either form; ``keys`` are the allowed keys.

    A state is a name such as ``whole`` or ``in [bowl]``, or an object with ``state_label`` and
    ``relative_object``. Listed ingredients become contents with the word ``contains``, also without a state
    of this name.

    A key without a value may be missing or null. For a container, related object, id or flag, an empty text
    and ``"None"`` also mean that there is no value. Raises :class:`ValueError` for a value of another form.
    """
    if not isinstance(value, dict):
        raise ValueError(f'found {excerpt_of(value)}, expected an object {{"label": ..., "states": [...]}}')
    check_keys(value, keys)
    label_key, label_value = key_and_value(value, _LABEL)
    label = _checked_name(label_value, label_key).strip(" ")
    if not label:
        raise ValueError(f'found {excerpt_of(label_value)} as "{label_key}", expected a name')
    states = [_state_line(state) for state in _checked_list(*key_and_value(value, _STATES))]
    listed_ingredients = _checked_list("ingredients", value.get("ingredients"))
    ingredients = tuple(item for item in map(_ingredient_name, listed_ingredients) if item)
    if ingredients:
        states = _add_contents(states, ingredients)
    container = optional_name(value.get("container"), "container")
    flag, category = digits_under(value, "object_in_motion"), digits_under(value, "recipe_category")
    fields = tuple(filter(None, (flag, category)))
    line = ObjectLine(label, digits_under(value, "object_id"), fields)
    remarks = [remark.message for state in states for remark in state.remarks]
    plain_states = [state._replace(remarks=()) for state in states] if remarks else states
    return JsonObject(
        line,
        tuple(plain_states),
        container,
        (*remarks, *_remarks_on_losses(value, flag, category, listed_ingredients)),
    )


def read_json_objects(text: str, file: str, reading: Reading) -> Iterator[tuple[ObjectBlock, NodePattern]]:
    """Yield the objects of a JSON list with their patterns; diagnostics are added to ``reading``.

    The patterns are those of :func:`read_objects`. Errors are added after the last object.
    """
    elements = JsonList(text, Path(file))
    for block, pattern, remarks in read_objects(elements):
        for remark in remarks:
            reading.warn("json-value", remark, block.source)
        yield block, pattern
    reading.diagnostics += elements.errors


def read_objects(elements: JsonList) -> Iterator[tuple[ObjectBlock, NodePattern, tuple[str, ...]]]:
    """Yield the entries of a list, each with its pattern and the messages on its repairs.

    An entry is a node as :func:`read_object` reads it, a node in one-line notation, or a node of an answer
    in JSON. A ``container`` is in the pattern of an entry, and not among its states. Listed ingredients match
    contents with any words. Faulty entries are left out, and become errors of the list.
    """
    for value, source in elements:
        try:
            amount = stated_amount(value) if isinstance(value, dict) else None
            if (node := _node_of_notation_or_answer(value)) is not None:
                yield _block_of_node(node, source)._replace(amount=amount), NodePattern.of(node), ()
                continue
            line, states, container, remarks = read_object(value, NODE_KEYS)
        except ValueError as error:
            elements.add_error(source, str(error))
        else:
            block = ObjectBlock(line, states, source, amount)
            pattern = NodePattern.of(block.node)._replace(container=container)
            if isinstance(value, dict) and value.get("ingredients"):  # under any word
                pattern = pattern._replace(contents=())
            yield block, pattern, remarks


def _node_of_notation_or_answer(value: object) -> ObjectNode | None:
    """Return a node in one-line notation or as in an answer; ``None`` for another form.

    Raises :class:`ValueError` for a fault in the notation or the node.
    """
    if isinstance(value, str):
        try:
            return parse_node(value)
        except LineError as error:
            raise ValueError(
                f"found {excerpt_of(value)}: at its column {error.column}, {error}; a name with such "
                "letters in it is in quotes"
            ) from None
    if not isinstance(value, dict) or "node" not in value:
        return None
    try:
        return read_node_json(value)
    except (KeyError, TypeError) as error:
        raise ValueError(
            f"found {excerpt_of(value['node'])}, expected a node as in an answer: {error}"
        ) from None


def _block_of_node(node: ObjectNode, source: Source) -> ObjectBlock:
    """Return the object block of a node, with its state lines sorted and without ids."""
    states = [*map(StateLine, sorted(node.states)), *map(StateLine, sorted(node.relations))]
    states += [StateLine(contents, listed=contents.ingredients) for contents in node.contents]
    return ObjectBlock(ObjectLine(node.label), tuple(states), source)


def check_keys(value: dict[str, object], allowed: set[str]) -> None:
    """Raise :class:`ValueError` if an object has a key that is not allowed."""
    if not value.keys() <= allowed:
        unknown = min(value.keys() - allowed)
        raise ValueError(f"found the key {unknown!r}, expected one of {', '.join(sorted(allowed))}")


def key_and_value(value: dict[str, object], keys: tuple[str, ...]) -> tuple[str, object]:
    """Return the key of an object that is among ``keys``, and its value.

    If the object has none of the keys, return the first key and ``None``. Raises :class:`ValueError` if it
    has two of the keys.
    """
    present_keys = [key for key in keys if key in value] or [keys[0]]
    if len(present_keys) > 1:
        raise ValueError(f"found both {present_keys[0]!r} and {present_keys[1]!r}, expected one of them")
    return present_keys[0], value.get(present_keys[0])


def optional_name(value: object, key: str) -> str | None:
    """Return a value that is a name, without blanks around it.

    Return ``None`` for null and for a text that means no value (:func:`is_none`). Raises
    :class:`ValueError`, which names ``key``, for any other value.
    """
    if value is None:
        return None
    name = _checked_name(value, key, "a name or null").strip(" ")
    return None if is_none(name) else name


def is_none(name: str) -> bool:
    """Whether a text means no value: it is empty, or ``None`` in letters of any case."""
    return name.strip().lower() in {"", "none"}


def digits_under(value: dict[str, object], key: str) -> str:
    """Return the digits of the number under a key, which may be written as a text.

    Return an empty text if the key is missing, null, or a text that means no value (:func:`is_none`). Raises
    :class:`ValueError` for any other value.
    """
    value_of_key = value.get(key)
    if value_of_key is None or (isinstance(value_of_key, str) and is_none(value_of_key)):
        return ""
    written = value_of_key.text if isinstance(value_of_key, JsonNumber) else value_of_key
    if isinstance(written, str) and is_number(written):
        return written
    raise ValueError(f'found {excerpt_of(value_of_key)} as "{key}", expected a number')


def amount_from_json(value: object) -> int:
    """Return an amount from a number or a text of digits.

    Raises :class:`ValueError` for another value.
    """
    written = value.text if isinstance(value, JsonNumber) else str(value)
    try:
        return parse_amount(written, 1)
    except LineError:
        raise ValueError(f"found the amount {excerpt_of(value)}, expected {EXPECTED_AMOUNT}") from None


def stated_amount(value: dict[str, object]) -> int | None:
    """Return the value of the key ``amount`` of an object, or ``None`` if it is missing or null.

    Raises :class:`ValueError` for a value that is no amount.
    """
    stated = value.get("amount")
    return None if stated is None else amount_from_json(stated)


def price_from_json(value: object, exponents: bool = False) -> str:
    """Return a price as a decimal text, from a number or a text of JSON; empty for null.

    If ``exponents``, a number may have an exponent: ``1e2`` becomes ``100``. Raises :class:`ValueError` for a
    value that is no price.
    """
    if value is None:
        return ""
    written = value.text if isinstance(value, JsonNumber) else value
    if not isinstance(written, str):
        raise ValueError('found no number as "price", expected a price from 0, as a decimal such as 1.99')
    if exponents and isinstance(value, JsonNumber) and "e" in written.lower():
        exact = Decimal(written)
        if abs(exact.adjusted()) + len(written) >= MAX_LETTERS:
            raise ValueError(
                f'found {written[:40]!r} as "price", expected one of at most {MAX_LETTERS} letters'
            )
        written = f"{exact:f}"
    try:
        read_price(written)
    except LineError as error:
        raise ValueError(f'in "price": {error}') from None
    return written


def _state_line(value: object) -> StateLine:
    """Return the state line of a state in JSON: a name, also with brackets, or an object.

    Raises :class:`ValueError` for another value.
    """
    if isinstance(value, dict):
        check_keys(value, _STATE_KEYS)
        label_key, label_value = key_and_value(value, _STATE_LABEL)
        state = _state_line(_checked_name(label_value, label_key))
        related = optional_name(key_and_value(value, _RELATED)[1], _RELATED[0])
        if related:
            if not isinstance(state.attribute, str):
                raise ValueError(
                    f"found the related object {related!r} besides the one in {excerpt_of(label_value)}"
                )
            state = state._replace(attribute=Relation(state.attribute, related))
        return state._replace(id=digits_under(value, "state_id"))
    name = _checked_name(value, "states", "a name").strip(" ")
    try:
        return read_state(name)
    except LineError as error:
        raise ValueError(
            f"found the state {excerpt_of(name)}: at its column {error.column}, {error}"
        ) from None


def _add_contents(states: list[StateLine], ingredients: tuple[str, ...]) -> list[StateLine]:
    """Return the states with contents of the word ``contains``.

    The contents take the place of the first state ``contains``, or come last if no state is ``contains``.
    """
    contents = Contents(LISTED_UNDER, tuple(sorted(ingredients)))
    for index, state in enumerate(states):
        if state.attribute == contents.word:
            return [*states[:index], StateLine(contents, state.id, ingredients), *states[index + 1 :]]
    return [*states, StateLine(contents, "", ingredients)]


def _remarks_on_losses(
    value: dict[str, object], flag: str, category: str, ingredients: list[object]
) -> Iterator[str]:
    """Yield messages on parts of an object that lines cannot hold, and on parts that are unusual in lines.

    ``flag``, ``category`` and ``ingredients`` are parts of the object ``value`` that have been read already.
    """
    if flag not in {"", *MOTION_FLAGS}:
        yield f"the motion flag {flag!r} is not 0 or 1"
    if category and not flag:
        yield f"the recipe category {category!r} comes without a motion flag"
    if value.get("has_portions") not in (None, False, "False", ""):
        yield "has_portions left out: FOON text has no place for it"
    for ingredient in ingredients:
        if isinstance(ingredient, dict) and any(read_object(ingredient)[1:3]):
            yield "states and containers of ingredients left out: only their labels count"


def _ingredient_name(value: object) -> str:
    """Return the name of an ingredient without blanks around it; the name may be empty.

    An ingredient that is an object is named by its label. Raises :class:`ValueError` for another value.
    """
    if isinstance(value, dict):
        return read_object(value).line.label
    return _checked_name(value, "ingredients").strip(" ")


def _checked_list(key: str, items: object) -> list[object]:
    """Return a value that is a list; an empty list for ``None``, which stands for a missing key.

    Raises :class:`ValueError`, which names ``key``, for another value.
    """
    if items is None:
        return []
    if not isinstance(items, list):
        raise ValueError(f'found {excerpt_of(items)} as "{key}", expected a list of names')
    return items


def _checked_name(value: object, key: str, expected: str = "a name") -> str:
    """Return a value that is a text; raises :class:`ValueError`, which names ``key``, for any other value."""
    if not isinstance(value, str):
        raise ValueError(f'found {excerpt_of(value)} as "{key}", expected {expected}')
    return value


def excerpt_of(value: object) -> str:
    """Return the first 40 letters of a value in JSON, for a message."""
    if isinstance(value, JsonNumber):
        return value.text[:40]
    return json_line(value, _plain_number)[:40]


def _plain_number(value: JsonNumber) -> object:
    """Return a number as a value that Python can write as JSON; from 20 letters on, this is a text."""
    return json.loads(value.text) if len(value.text) < 20 else value.text
