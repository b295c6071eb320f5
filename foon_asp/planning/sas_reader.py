"""Reader of Fast Downward's translator format, a planning task in finite-domain variables (output.sas)."""

import re
from collections import Counter
from dataclasses import dataclass
from typing import NamedTuple, NoReturn

from foon_asp.network import Source
from foon_asp.text.diagnostics import Diagnostic, InputError, Severity
from foon_asp.text.plain_file import split_lines

BEGINNING = "begin_version"
_ATOM = re.compile(r"(?P<negated>Negated)?Atom (?P<predicate>[^\s()]+)\((?P<terms>[^()]*)\)")


class SasEffect(NamedTuple):
    """A conditional effect: an operator adds ``fact`` where all facts of ``condition`` hold."""

    condition: tuple[int, ...]
    fact: int


class SasOperator(NamedTuple):
    """An operator by name: its preconditions, effects and cost, and its line in the file."""

    name: str
    preconditions: tuple[int, ...]
    effects: list[SasEffect]
    cost: int
    source: Source


class SasAxiom(NamedTuple):
    """An axiom: it derives the fact ``head`` where all facts of ``body`` hold."""

    body: tuple[int, ...]
    head: int
    source: Source


@dataclass(frozen=True)
class SasTask:
    """A planning task in finite-domain variables (Helmert 2009); a fact is a value of a variable, by number.

    ``variables``: the facts of each variable. ``derived``: the variables that axioms set.
    ``start``: the fact of each variable in the initial state; for a derived variable, its default value.
    ``costed``: whether the metric counts the costs of operators; otherwise each operator costs 1.
    """

    file: str
    facts: list[str]
    variables: list[range]
    derived: frozenset[int]
    start: list[int]
    goal: tuple[int, ...]
    operators: list[SasOperator]
    axioms: list[SasAxiom]
    costed: bool


def parse_sas(text: str, file: str) -> SasTask:
    """Return the task in the text of a file of the translator.

    Raises :class:`InputError` for lines that are not of the format.
    """
    return _Reader(text, file).read()


class _Reader:
    """A recursive-descent parser over lines."""

    def __init__(self, text: str, file: str) -> None:
        self._lines, self._file, self._line = split_lines(text), file, 0
        self._variables: list[range] = []
        self._derived: set[int] = set()

    def read(self) -> SasTask:
        """Return the task of the whole file."""
        self._expect("begin_version")
        if self._number() != 3:
            self._fault("found another version, expected 3")
        self._expect("end_version", "begin_metric")
        costed = bool(self._number())
        self._expect("end_metric")
        names = [self._variable() for _ in range(self._number())]
        for _ in range(self._number()):
            self._expect("begin_mutex_group")
            for _ in range(self._number()):
                self._numbers(2)
            self._expect("end_mutex_group")
        self._expect("begin_state")
        start = [self._value(variable, self._number()) for variable in range(len(names))]
        self._expect("end_state", "begin_goal")
        goal = self._values()
        self._expect("end_goal")
        operators = [self._operator() for _ in range(self._number())]
        axioms = [self._axiom() for _ in range(self._number())]
        derived = frozenset(self._derived)
        facts = _unique(names)
        return SasTask(self._file, facts, self._variables, derived, start, goal, operators, axioms, costed)

    def _variable(self) -> list[str]:
        """Read a variable, and return the names of its facts."""
        self._expect("begin_variable")
        variable = self._next()
        if self._number() != -1:
            self._derived.add(len(self._variables))
        values = [_fact(self._next(), variable) for _ in range(self._number())]
        self._expect("end_variable")
        first = self._variables[-1].stop if self._variables else 0
        self._variables.append(range(first, first + len(values)))
        return values

    def _operator(self) -> SasOperator:
        """Read an operator; the value that a variable must have before an effect becomes a precondition."""
        self._expect("begin_operator")
        name, source = self._next().rstrip(), Source(self._file, self._line)
        preconditions, effects = [*self._values()], list[SasEffect]()
        for _ in range(self._number()):
            count, *numbers = self._numbers(None)
            if len(numbers) != 2 * count + 3:
                self._fault(f"found an effect of {len(numbers) + 1} numbers, expected {2 * count + 4}")
            condition = tuple(map(self._value, numbers[: 2 * count : 2], numbers[1 : 2 * count : 2]))
            variable, before, after = numbers[2 * count :]
            if before != -1:
                preconditions.append(self._value(variable, before))
            effects.append(SasEffect(condition, self._value(variable, after)))
        cost = self._number()
        self._expect("end_operator")
        return SasOperator(f"({name})", tuple(dict.fromkeys(preconditions)), effects, cost, source)

    def _axiom(self) -> SasAxiom:
        """Read an axiom, which has to set a derived variable."""
        self._expect("begin_rule")
        source = Source(self._file, self._line)
        body = self._values()
        variable, _, after = self._numbers(3)
        if variable not in self._derived:
            self._fault(f"found an axiom that sets the variable {variable}, which no axiom may set")
        self._expect("end_rule")
        return SasAxiom(body, self._value(variable, after), source)

    def _values(self) -> tuple[int, ...]:
        """Read a number of lines with a variable and a value, and return their facts."""
        return tuple(self._value(*self._numbers(2)) for _ in range(self._number()))

    def _value(self, variable: int, value: int) -> int:
        """Return the fact that is a value of a variable."""
        if not (0 <= variable < len(self._variables) and 0 <= value < len(self._variables[variable])):
            self._fault(f"found the value {value} of variable {variable}, which is not declared")
        return self._variables[variable][value]

    def _numbers(self, count: int | None) -> list[int]:
        """Read a line of ``count`` numbers, or of any positive count for ``None``."""
        words = self._next().split()
        if not words or (count is not None and len(words) != count):
            self._fault(f"found {len(words)} words, expected {count or 'some'} numbers")
        if not all(re.fullmatch(r"-?\d{1,18}", word) for word in words):
            self._fault(f"found {self._lines[self._line - 1][:80]!r}, expected numbers")
        return list(map(int, words))

    def _number(self) -> int:
        (number,) = self._numbers(1)
        return number

    def _expect(self, *keywords: str) -> None:
        for keyword in keywords:
            line = self._next()
            if line.strip() != keyword:
                self._fault(f"found {line[:80]!r}, expected {keyword}")

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
    """Return the PDDL atom of a value; without an atom, the names of its variable and of the value."""
    atom = _ATOM.fullmatch(name)
    if atom is None:
        return f"({variable} {name})"
    terms = [term.strip() for term in atom["terms"].split(",") if term.strip()]
    shown = f"({' '.join((atom['predicate'], *terms))})"
    return f"(not {shown})" if atom["negated"] else shown


def _unique(names: list[list[str]]) -> list[str]:
    """Return the names of all facts in order; equal names get the number of their variable."""
    counts = Counter(name for values in names for name in values)
    return [
        f"{name} [var{variable}]" if counts[name] > 1 else name
        for variable, values in enumerate(names)
        for name in values
    ]
