"""Files of questions: JSON Lines, one object on each line, which may stand for many questions."""

import itertools
import json
from collections.abc import Collection, Iterable, Iterator
from pathlib import Path
from typing import NamedTuple

from foon_asp.batch.asked import Asked, Asker
from foon_asp.errors import UserError
from foon_asp.network import Source
from foon_asp.problem import ITEMS, ContainerRule, parse_objectives
from foon_asp.text.data_folder import STARTING
from foon_asp.text.diagnostics import Diagnostic, InputError, Severity
from foon_asp.text.json_fault import json_fault
from foon_asp.text.json_value import json_line, read_json
from foon_asp.text.plain_file import read_plain_text

_LONGEST = 1e9  # seconds, some thirty years
_KEYS = ("goal", "objective", "containers", "items", "stock", "stays", "kitchen", "time_limit")


class QuestionLine(NamedTuple):
    """One line of a file of questions: every combination of its values is asked.

    ``goals`` holds for each tree the names of the goals that it makes; a name that begins with ``@`` stands
    for many. ``kitchens`` are files, ``STARTING``, or ``None`` for that of the data.
    """

    goals: tuple[tuple[str, ...], ...]
    objectives: tuple[str, ...]
    containers: tuple[str, ...]
    kitchens: tuple[Path | None, ...]
    time_limit: float | None
    items: tuple[str, ...]
    stocks: tuple[Path | None, ...]
    stays: tuple[Path | None, ...]

    @property
    def files(self) -> tuple[Path, ...]:
        """The files that it names."""
        return tuple(
            file for file in (*self.kitchens, *self.stocks, *self.stays) if file not in {None, STARTING}
        )


def read_questions(
    file: Path, time_limit: float | None, measures: Collection[str] = ()
) -> list[QuestionLine]:
    """Read questions; ``time_limit`` is for those that do not say theirs, and kitchens are beside the file.

    ``measures`` are objectives of the user's own, by name.

    Raises :class:`InputError` naming every line that is not one object with the keys that are known.
    """
    lines: list[QuestionLine] = []
    errors: list[Diagnostic] = []
    for number, text in enumerate(read_plain_text(file).replace("\r\n", "\n").split("\n"), 1):
        if not text.strip():
            continue
        try:
            lines.append(_line(read_json(text), file.parent, time_limit, measures))
        except json.JSONDecodeError as problem:
            fault = json_fault(problem)
            place = Source(str(file), number, fault.column)
            errors.append(Diagnostic(Severity.ERROR, "json", fault.message, place, text))
        except (UserError, ValueError) as problem:
            errors.append(Diagnostic(Severity.ERROR, "json", str(problem), Source(str(file), number), text))
    if errors:
        raise InputError(errors)
    if not lines:
        raise UserError(f'{file}: no questions; one looks like {{"goal": "ice", "objective": "units"}}')
    return lines


def each_question(lines: Iterable[QuestionLine], asker: Asker) -> Iterator[Asked]:
    """Give every question that the lines stand for, each once and in their order."""
    seen: set[Asked] = set()
    for line in lines:
        for kitchen, rule in itertools.product(line.kitchens, line.containers):
            goals: list[tuple[str, ...]] = []
            for names in line.goals:
                if names[0].startswith("@"):
                    goals += [(name,) for name in asker.named(names[0], rule, kitchen)]
                else:
                    goals.append(names)
            for objective, names, items, stock, stays in itertools.product(
                line.objectives, goals, line.items, line.stocks, line.stays
            ):
                asked = Asked(names, objective, rule, kitchen, line.time_limit, items, stock, stays)
                if asked not in seen:
                    seen.add(asked)
                    yield asked


def _line(value: object, folder: Path, time_limit: float | None, measures: Collection[str]) -> QuestionLine:
    if not isinstance(value, dict) or "goal" not in value:
        raise ValueError('expected an object such as {"goal": "ice", "objective": ["units", "success"]}')
    if unknown := sorted(value.keys() - set(_KEYS)):
        raise ValueError(f"found the key {unknown[0]!r}, expected one of {', '.join(_KEYS)}")
    goals = tuple(_goal(name) for name in _several(value["goal"]))
    objectives = tuple(_name(o, "objective") for o in _several(value.get("objective", "units")))
    for objective in objectives:
        parse_objectives([objective], measures)
    rules = _known(value.get("containers", "strict"), "containers", tuple(ContainerRule))
    items = _known(value.get("items", "lasting"), "items", ITEMS)
    kitchens, stocks, stays = (
        tuple(_file(file, key, folder) for file in _several(value.get(key)))
        for key in ("kitchen", "stock", "stays")
    )
    if "lasting" in items and any((*stocks, *stays)):
        raise ValueError('a stock, and what stays, are for items that are used up: add "items": "used-up"')
    limit = value.get("time_limit", time_limit)
    is_number = isinstance(limit, int | float) and not isinstance(limit, bool)
    if not (limit is None or (is_number and 0 <= limit <= _LONGEST)):
        raise ValueError(f"found the time_limit {str(limit)[:40]}, expected seconds, at most {_LONGEST:g}")
    limit = None if limit is None else float(limit)
    return QuestionLine(goals, objectives, rules, kitchens, limit, items, stocks, stays)


def _file(value: object, key: str, folder: Path) -> Path | None:
    """A name of a file in the folder of the questions; the starting kitchen is no file."""
    if value is None:
        return None
    name = _name(value, key)
    return STARTING if key == "kitchen" and name == str(STARTING) else folder / name


def _known(value: object, key: str, known: Collection[str]) -> tuple[str, ...]:
    names = tuple(_name(name, key) for name in _several(value))
    for name in names:
        if name not in known:
            raise ValueError(f"found the {key} {name!r}, expected {' or '.join(known)}")
    return names


def _several(value: object) -> list[object]:
    """A list stands for one question after the other; an empty one would ask nothing."""
    if value == []:
        raise ValueError("found an empty list, expected at least one value")
    return value if isinstance(value, list) else [value]


def _goal(value: object) -> tuple[str, ...]:
    """A name is a goal; a list within the list names goals that one tree makes."""
    names = tuple(_name(name, "goal") for name in _several(value))
    for name in names:
        if name.startswith("@") and (len(names) > 1 or name not in {"@goals", "@makeable"}):
            raise ValueError(f"found the goal {name!r}, expected a name, or @goals or @makeable by itself")
    return names


def _name(value: object, key: str) -> str:
    if not isinstance(value, str) or not value:
        raise ValueError(f"found {json_line(value)[:40]} as {key!r}, expected a name")
    return value
