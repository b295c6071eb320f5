"""Files of questions: JSON Lines, an object on each line, which may stand for many questions."""

import functools
import itertools
import json
from collections.abc import Collection, Iterable, Iterator
from pathlib import Path

import msgspec

from foon_asp.batch.batch_question import BatchQuestion, OpenData
from foon_asp.errors import UserError
from foon_asp.json_layout import read_json
from foon_asp.network import STARTING, Source, counted
from foon_asp.problem import ITEMS, ContainerRule, parse_objectives
from foon_asp.text.diagnostics import Diagnostic, InputError, Severity
from foon_asp.text.json_list import json_fault
from foon_asp.text.plain_file import read_plain_text

_QUESTION_KEYS = BatchQuestion.__struct_fields__
_FILE_KEYS = ("kitchen", "stock", "stays")
_CHOICES = {"containers": [*map(str, ContainerRule)], "items": ITEMS}
_FOR_MANY = ("@goals", "@makeable")


def read_questions(
    file: Path, time_limit: float | None, measures: Collection[str] = ()
) -> list[BatchQuestion]:
    """Return the questions in a file: one for every combination of the values of a line.

    Files that questions name are relative to the folder of the file. ``time_limit``, in seconds, is for
    questions without a time limit. ``measures`` are the names of user-defined objectives. A goal may be a
    word for many goals, such as ``@makeable``. Blank lines are skipped.

    Raises :class:`InputError` with all wrong lines, and :class:`UserError` if there is no question.
    """
    questions: list[BatchQuestion] = []
    errors: list[Diagnostic] = []
    for number, text in enumerate(read_plain_text(file).replace("\r\n", "\n").split("\n"), 1):
        if not text.strip():
            continue
        try:
            for question in _questions_of_line(read_json(text), time_limit):
                parse_objectives([question.objective], measures)
                questions.append(_with_file_paths(question, file.parent))
        except (UserError, ValueError) as error:
            fault = json_fault(error) if isinstance(error, json.JSONDecodeError) else None
            source = Source(str(file), number, fault.column if fault else 1)
            message = fault.message if fault else str(error)
            errors.append(Diagnostic(Severity.ERROR, "json", message, source, text))
    if errors:
        raise InputError(errors)
    if not questions:
        raise UserError(f'{file}: no questions; one looks like {{"goal": "ice", "objective": "units"}}')
    return questions


def files_of_questions(questions: Iterable[BatchQuestion]) -> set[Path]:
    """Return the paths of the files that questions name: kitchens, stocks and lists of what stays.

    The kitchen ``@starting`` is no file, and left out.
    """
    names = {getattr(question, key) for question in questions for key in _FILE_KEYS}
    return {Path(name) for name in names - {None, str(STARTING)}}


def expand_questions(questions: Iterable[BatchQuestion], data: OpenData) -> Iterator[BatchQuestion]:
    """Yield every question once, with ``@goals`` and ``@makeable`` replaced by one goal after another.

    A question that does not say whether items are used up gets what ``data.items`` returns.
    """
    goals_of_word = functools.cache(data.goals_of_word)
    seen: set[BatchQuestion] = set()
    for question in questions:
        goals: Iterable[str | tuple[str, ...]] = (question.goal,)
        if question.goal in _FOR_MANY:
            goals = goals_of_word(str(question.goal), question.containers, question.kitchen)
        for goal in goals:
            expanded = msgspec.structs.replace(question, goal=goal)
            if expanded.items is None:
                expanded = msgspec.structs.replace(expanded, items=data.items(expanded))
            if expanded not in seen:
                seen.add(expanded)
                yield expanded


def _questions_of_line(value: object, time_limit: float | None) -> Iterator[BatchQuestion]:
    """Yield a question for every combination of the values of a line, goals varying fastest.

    ``value`` is the line as read from JSON. ``time_limit`` is for a line without one. A list of a single goal
    becomes the goal. If the line states amounts but not how items are used, the questions have items used up.
    Raises :class:`ValueError` for a wrong value, and for keys that do not go together.
    """
    if not isinstance(value, dict) or "goal" not in value:
        raise ValueError('expected an object such as {"goal": "ice", "objective": ["units", "success"]}')
    if unknown := sorted(value.keys() - {*_QUESTION_KEYS}):
        raise ValueError(f"found the key {unknown[0]!r}, expected one of {', '.join(_QUESTION_KEYS)}")
    entry = {"time_limit": time_limit} | value
    # goals vary fastest in the product, so the goal comes last
    values_of_key = {key: _as_list(entry[key]) for key in reversed(_QUESTION_KEYS) if key in entry}
    if [] in values_of_key.values():
        raise ValueError("found an empty list, expected at least one value")
    for key, choices in _CHOICES.items():
        for name in values_of_key.get(key, ()):
            if name not in choices:
                raise ValueError(f"found the {key} {name!r}, expected {' or '.join(choices)}")
    for values in itertools.product(*values_of_key.values()):
        question = msgspec.convert(dict(zip(values_of_key, values, strict=True)), BatchQuestion)
        if len(question.goals) == 1:
            question = msgspec.structs.replace(question, goal=question.goals[0])
        for name in question.goals:
            if name.startswith("@") and question.goal not in _FOR_MANY:
                raise ValueError(
                    f"found the goal {name!r}, expected a name, or @goals or @makeable by itself"
                )
        if question.amounts and (len(question.amounts) != len(question.goals) or question.goal in _FOR_MANY):
            raise ValueError(
                f"found {counted(len(question.amounts), 'amount')} for "
                f"{'many goals' if question.goal in _FOR_MANY else counted(len(question.goals), 'goal')}, "
                "expected one for each"
            )
        if question.items == "lasting" and question.amounts:
            raise ValueError('an amount of a goal is for items that are used up: leave "items" out')
        if question.items is None and question.amounts:
            question = msgspec.structs.replace(question, items=ITEMS[1])
        if question.items != "used-up" and (question.stock or question.stays):
            raise ValueError(
                'a stock, and what stays, are for items that are used up: add "items": "used-up"'
            )
        yield question


def _as_list(value: object) -> list[object]:
    """Return a list unchanged, and any other value in a list of one."""
    return value if isinstance(value, list) else [value]


def _with_file_paths(question: BatchQuestion, folder: Path) -> BatchQuestion:
    """Return the question with its file names relative to ``folder``; the kitchen ``@starting`` stays."""
    names = {key: name for key in _FILE_KEYS if (name := getattr(question, key)) is not None}
    paths = {
        key: str(folder / name) for key, name in names.items() if (key, name) != ("kitchen", str(STARTING))
    }
    return msgspec.structs.replace(question, **paths)
