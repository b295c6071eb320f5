"""What the translator of Fast Downward writes (output.sas), as a task without deletes."""

import re
from collections import Counter
from fractions import Fraction
from pathlib import Path
from typing import NamedTuple, NoReturn

from foon_asp.network import Source
from foon_asp.planning.strips_task import StripsAction, StripsTask
from foon_asp.text.diagnostics import Diagnostic, InputError, Severity
from foon_asp.text.plain_file import split_lines

BEGINNING = "begin_version"
_VERSION = 3
_ATOM = re.compile(r"(?P<negated>Negated)?Atom (?P<predicate>[^\s()]+)\((?P<terms>[^()]*)\)")

Value = tuple[int, int]
"""A variable and one of its values, by number: a fact."""


class _Operator(NamedTuple):
    name: str
    needs: list[Value]
    gives: list[Value]
    conditional: list[tuple[Value, int]]
    cost: int
    line: int


def parse_sas(text: str, file: str) -> StripsTask:
    """Read a task: each value of a variable is a fact, and no action takes one away.

    Raises :class:`InputError` for what is not of that form, and for axioms and effects under conditions.
    """
    return _Reader(text, file).read()


class _Reader:
    def __init__(self, text: str, file: str) -> None:
        self._lines, self._file, self._line = split_lines(text), file, 0

    def read(self) -> StripsTask:
        self._expect("begin_version")
        if self._number() != _VERSION:
            self._fault(f"found another version, expected {_VERSION}")
        self._expect("end_version", "begin_metric")
        metric = self._number()
        self._expect("end_metric")
        names = [self._variable() for _ in range(self._number())]
        for _ in range(self._number()):
            self._expect("begin_mutex_group")
            for _ in range(self._number()):
                self._numbers(2)
            self._expect("end_mutex_group")
        self._ranges = [len(values) for values in names]
        self._expect("begin_state")
        start = [self._value(variable, self._number()) for variable in range(len(names))]
        self._expect("end_state", "begin_goal")
        goal = self._values()
        self._expect("end_goal")
        operators = [self._operator() for _ in range(self._number())]
        if self._number():
            self._fault("found axioms, which are beyond a delete relaxation here")
        self._require_no_conditions(operators, goal)
        numbers = {
            value: place
            for place, value in enumerate((v, k) for v, size in enumerate(self._ranges) for k in range(size))
        }
        actions = [
            StripsAction(
                f"({operator.name})",
                [numbers[value] for value in operator.needs],
                [numbers[value] for value in operator.gives],
                Fraction(operator.cost if metric else 1),
                Source(self._file, operator.line),
            )
            for operator in operators
        ]
        started = frozenset(numbers[value] for value in start)
        goals = tuple(numbers[value] for value in goal)
        return StripsTask(Path(self._file).name, _unique(names), actions, started, goals)

    def _variable(self) -> list[str]:
        self._expect("begin_variable")
        variable = self._next()
        if self._number() != -1:
            self._fault("found a variable that axioms set, which is beyond a delete relaxation here")
        values = [_fact(self._next(), variable) for _ in range(self._number())]
        self._expect("end_variable")
        return values

    def _operator(self) -> _Operator:
        self._expect("begin_operator")
        name, line = self._next(), self._line
        needs, gives = self._values(), list[Value]()
        conditional: list[tuple[Value, int]] = []
        for _ in range(self._number()):
            count, *rest = self._numbers(None)
            if len(rest) != 2 * count + 3:
                self._fault(f"found an effect of {len(rest) + 1} numbers, expected {2 * count + 4}")
            variable, before, after = rest[2 * count :]
            value = self._value(variable, after)
            if before != -1:
                needs.append(self._value(variable, before))
            if count:
                conditional.append((value, self._line))
            else:
                gives.append(value)
        cost = self._number()
        self._expect("end_operator")
        return _Operator(name.rstrip(), list(dict.fromkeys(needs)), gives, conditional, cost, line)

    def _require_no_conditions(self, operators: list[_Operator], goal: list[Value]) -> None:
        """An effect under a condition may be ignored where nothing asks for it, as for one that deletes."""
        asked = {*goal, *(value for operator in operators for value in operator.needs)}
        for operator in operators:
            for value, line in operator.conditional:
                if value in asked:
                    self._line = line
                    self._fault(
                        f"found an effect of ({operator.name}) under a condition: conditional effects are "
                        "beyond a delete relaxation here"
                    )

    def _values(self) -> list[Value]:
        return [self._value(*self._numbers(2)) for _ in range(self._number())]

    def _value(self, variable: int, value: int) -> Value:
        if not (0 <= variable < len(self._ranges) and 0 <= value < self._ranges[variable]):
            self._fault(f"found the value {value} of variable {variable}, which is not declared")
        return variable, value

    def _numbers(self, count: int | None) -> list[int]:
        words = self._next().split()
        if not words or (count is not None and len(words) != count):
            self._fault(f"found {len(words)} words, expected {count or 'some'} numbers")
        if not all(re.fullmatch(r"-?\d{1,18}", word) for word in words):
            self._fault(f"found {self._lines[self._line - 1][:80]!r}, expected numbers")
        return list(map(int, words))

    def _number(self) -> int:
        (number,) = self._numbers(1)
        return number

    def _expect(self, *words: str) -> None:
        for word in words:
            found = self._next()
            if found.strip() != word:
                self._fault(f"found {found[:80]!r}, expected {word}")

    def _next(self) -> str:
        if self._line == len(self._lines):
            self._fault("found the end of the file, expected more lines: it is cut off")
        self._line += 1
        return self._lines[self._line - 1]

    def _fault(self, message: str) -> NoReturn:
        line = max(1, self._line)
        source = Source(self._file, line)
        raise InputError([Diagnostic(Severity.ERROR, "sas", message, source, self._lines[line - 1])])


def _fact(name: str, variable: str) -> str:
    """Name a value as PDDL has its atom; one that is no atom is named with its variable."""
    atom = _ATOM.fullmatch(name)
    if atom is None:
        return f"({variable} {name})"
    terms = [term.strip() for term in atom["terms"].split(",") if term.strip()]
    shown = f"({' '.join((atom['predicate'], *terms))})"
    return f"(not {shown})" if atom["negated"] else shown


def _unique(names: list[list[str]]) -> list[str]:
    """Give all facts in order, each by a name of its own."""
    counts = Counter(name for values in names for name in values)
    return [
        f"{name} [var{variable}]" if counts[name] > 1 else name
        for variable, values in enumerate(names)
        for name in values
    ]
