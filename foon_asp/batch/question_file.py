"""Files of questions: JSON Lines, one object on each line, which may stand for many questions."""

import functools
import itertools
import json
from collections.abc import Collection, Iterable, Iterator
from pathlib import Path

import msgspec

from foon_asp.batch.asked import Asked, Asker
from foon_asp.errors import UserError
from foon_asp.network import Source
from foon_asp.problem import ITEMS, ContainerRule, parse_objectives
from foon_asp.text.data_folder import STARTING
from foon_asp.text.diagnostics import Diagnostic, InputError, Severity
from foon_asp.text.json_list import json_fault
from foon_asp.text.json_value import read_json
from foon_asp.text.plain_file import read_plain_text

_KEYS = Asked.__struct_fields__
_FILES = ("kitchen", "stock", "stays")
_KNOWN = {"containers": [*map(str, ContainerRule)], "items": ITEMS}
_FOR_MANY = ("@goals", "@makeable")


def read_questions(file: Path, time_limit: float | None, measures: Collection[str] = ()) -> list[Asked]:
    """Read questions, every combination of the values of a line; kitchens are beside the file.

    ``time_limit`` is for those that do not say theirs, and ``measures`` are objectives of the user's own, by
    name. Goals may be words that stand for many.

    Raises :class:`InputError` naming every line that is not one object with the keys that are known.
    """
    questions: list[Asked] = []
    errors: list[Diagnostic] = []
    for number, text in enumerate(read_plain_text(file).replace("\r\n", "\n").split("\n"), 1):
        if not text.strip():
            continue
        try:
            for asked in _combinations(read_json(text), time_limit):
                parse_objectives([asked.objective], measures)
                questions.append(_with_files(asked, file.parent))
        except (UserError, ValueError) as problem:
            fault = json_fault(problem) if isinstance(problem, json.JSONDecodeError) else None
            place = Source(str(file), number, fault.column if fault else 1)
            message = fault.message if fault else str(problem)
            errors.append(Diagnostic(Severity.ERROR, "json", message, place, text))
    if errors:
        raise InputError(errors)
    if not questions:
        raise UserError(f'{file}: no questions; one looks like {{"goal": "ice", "objective": "units"}}')
    return questions


def named_files(questions: Iterable[Asked]) -> set[Path]:
    """Return the files that questions name."""
    names = {getattr(asked, key) for asked in questions for key in _FILES}
    return {Path(name) for name in names - {None, str(STARTING)}}


def each_question(questions: Iterable[Asked], asker: Asker) -> Iterator[Asked]:
    """Return every question once, with the goals that words stand for."""
    named = functools.cache(asker.named)
    seen: set[Asked] = set()
    for asked in questions:
        goals: Iterable[str | tuple[str, ...]] = (asked.goal,)
        if asked.goal in _FOR_MANY:
            goals = named(str(asked.goal), asked.containers, asked.kitchen)
        for goal in goals:
            one = msgspec.structs.replace(asked, goal=goal)
            if one not in seen:
                seen.add(one)
                yield one


def _combinations(value: object, time_limit: float | None) -> Iterator[Asked]:
    """Return every combination of the values of a line; raises :class:`ValueError` for a wrong one."""
    if not isinstance(value, dict) or "goal" not in value:
        raise ValueError('expected an object such as {"goal": "ice", "objective": ["units", "success"]}')
    if unknown := sorted(value.keys() - {*_KEYS}):
        raise ValueError(f"found the key {unknown[0]!r}, expected one of {', '.join(_KEYS)}")
    given = {"time_limit": time_limit} | value
    several = {key: _several(given[key]) for key in reversed(_KEYS) if key in given}  # all goals by turns
    if [] in several.values():
        raise ValueError("found an empty list, expected at least one value")
    for key, known in _KNOWN.items():
        for name in several.get(key, ()):
            if name not in known:
                raise ValueError(f"found the {key} {name!r}, expected {' or '.join(known)}")
    for values in itertools.product(*several.values()):
        asked = msgspec.convert(dict(zip(several, values, strict=True)), Asked)
        if len(asked.goals) == 1:
            asked = msgspec.structs.replace(asked, goal=asked.goals[0])
        for name in asked.goals:
            if name.startswith("@") and asked.goal not in _FOR_MANY:
                raise ValueError(
                    f"found the goal {name!r}, expected a name, or @goals or @makeable by itself"
                )
        if asked.items == "lasting" and (asked.stock or asked.stays):
            raise ValueError(
                'a stock, and what stays, are for items that are used up: add "items": "used-up"'
            )
        yield asked


def _several(value: object) -> list[object]:
    """Return the values of a key; one that is not in a list stands alone."""
    return value if isinstance(value, list) else [value]


def _with_files(asked: Asked, folder: Path) -> Asked:
    """Return a question that names its files from where we are; the starting kitchen is no file."""
    named = {key: name for key in _FILES if (name := getattr(asked, key)) is not None}
    files = {
        key: str(folder / name) for key, name in named.items() if (key, name) != ("kitchen", str(STARTING))
    }
    return msgspec.structs.replace(asked, **files)
