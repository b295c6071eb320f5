"""Reader of files of Fast Downward's translator (output.sas): tasks in finite-domain variables."""

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
    """A conditional effect: an operator adds ``fact`` if all facts of ``condition`` hold."""

    condition: tuple[int, ...]
    fact: int


class SasOperator(NamedTuple):
    """An operator: its name in parentheses, its preconditions, effects and cost, and its line in the file."""

    name: str
    preconditions: tuple[int, ...]
    effects: list[SasEffect]
    cost: int
    source: Source


class SasAxiom(NamedTuple):
    """An axiom: the fact ``head`` is derived if all facts of ``body`` hold."""

    body: tuple[int, ...]
    head: int
    source: Source


@dataclass(frozen=True)
class SasTask:
    """A planning task in finite-domain variables (Helmert 2009).

    A fact is the assignment of a value to a variable; all facts are numbered from 0.

    ``facts``: the names of all facts.
    ``variables``: the range of the facts of each variable.
    ``derived``: the numbers of the variables that axioms set.
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
    """Return the planning task in the text of a file of the translator; ``file`` is its name in errors.

    Raises :class:`InputError` for lines that are not of the format, and for another version than 3.
    """
    return _Reader(text, file).read()


class _Reader:
    """A recursive-descent parser over lines."""

    def __init__(self, text: str, file: str) -> None:
        self._lines, self._file, self._line = split_lines(text), file, 0
        self._variables: list[range] = []
        self._derived: set[int] = set()

    def read(self) -> SasTask:
        """Return the task of the whole file; mutex groups are passed over."""
        self._expect("begin_version")
        if self._number() != 3:
            self._raise_error("found another version, expected 3")
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
        start = [self._fact_number(variable, self._number()) for variable in range(len(names))]
        self._expect("end_state", "begin_goal")
        goal = self._fact_list()
        self._expect("end_goal")
        operators = [self._operator() for _ in range(self._number())]
        axioms = [self._axiom() for _ in range(self._number())]
        derived = frozenset(self._derived)
        facts = _unique_fact_names(names)
        return SasTask(self._file, facts, self._variables, derived, start, goal, operators, axioms, costed)

    def _variable(self) -> list[str]:
        """Read a variable, and return the names of its facts.

        The range of its facts is recorded, and its number if it is derived.
        """
        self._expect("begin_variable")
        variable = self._next_line()
        if self._number() != -1:
            self._derived.add(len(self._variables))
        values = [_fact_name(self._next_line(), variable) for _ in range(self._number())]
        self._expect("end_variable")
        first = self._variables[-1].stop if self._variables else 0
        self._variables.append(range(first, first + len(values)))
        return values

    def _operator(self) -> SasOperator:
        """Read an operator, and return it.

        If an effect requires that its variable has some value before, this fact becomes a precondition. Each
        precondition is listed once.
        """
        self._expect("begin_operator")
        name, source = self._next_line().rstrip(), Source(self._file, self._line)
        preconditions, effects = [*self._fact_list()], list[SasEffect]()
        for _ in range(self._number()):
            count, *numbers = self._numbers(None)
            if len(numbers) != 2 * count + 3:
                self._raise_error(f"found an effect of {len(numbers) + 1} numbers, expected {2 * count + 4}")
            condition = tuple(map(self._fact_number, numbers[: 2 * count : 2], numbers[1 : 2 * count : 2]))
            variable, before, after = numbers[2 * count :]
            if before != -1:
                preconditions.append(self._fact_number(variable, before))
            effects.append(SasEffect(condition, self._fact_number(variable, after)))
        cost = self._number()
        self._expect("end_operator")
        return SasOperator(f"({name})", tuple(dict.fromkeys(preconditions)), effects, cost, source)

    def _axiom(self) -> SasAxiom:
        """Read an axiom, and return it; raises :class:`InputError` if its variable is not derived."""
        self._expect("begin_rule")
        source = Source(self._file, self._line)
        body = self._fact_list()
        variable, _, after = self._numbers(3)
        if variable not in self._derived:
            self._raise_error(f"found an axiom that sets the variable {variable}, which no axiom may set")
        self._expect("end_rule")
        return SasAxiom(body, self._fact_number(variable, after), source)

    def _fact_list(self) -> tuple[int, ...]:
        """Read a count, then as many lines with a variable and a value; return their facts."""
        return tuple(self._fact_number(*self._numbers(2)) for _ in range(self._number()))

    def _fact_number(self, variable: int, value: int) -> int:
        """Return the number of the fact that assigns a value to a variable.

        Raises :class:`InputError` if the file declares no such value.
        """
        if not (0 <= variable < len(self._variables) and 0 <= value < len(self._variables[variable])):
            self._raise_error(f"found the value {value} of variable {variable}, which is not declared")
        return self._variables[variable][value]

    def _numbers(self, count: int | None) -> list[int]:
        """Read a line of ``count`` integers; with ``None``, of at least one."""
        words = self._next_line().split()
        if not words or (count is not None and len(words) != count):
            self._raise_error(f"found {len(words)} words, expected {count or 'some'} numbers")
        if not all(re.fullmatch(r"-?\d{1,18}", word) for word in words):
            self._raise_error(f"found {self._lines[self._line - 1][:80]!r}, expected numbers")
        return list(map(int, words))

    def _number(self) -> int:
        """Read a line of one integer, and return it."""
        (number,) = self._numbers(1)
        return number

    def _expect(self, *keywords: str) -> None:
        """Read one line for each of the keywords; raise :class:`InputError` if a line is not its keyword."""
        for keyword in keywords:
            line = self._next_line()
            if line.strip() != keyword:
                self._raise_error(f"found {line[:80]!r}, expected {keyword}")

    def _next_line(self) -> str:
        """Return the next line; raises :class:`InputError` at the end of the file."""
        if self._line == len(self._lines):
            self._raise_error("found the end of the file, expected more lines: it is cut off")
        self._line += 1
        return self._lines[self._line - 1]

    def _raise_error(self, message: str) -> NoReturn:
        """Raise :class:`InputError` with a message and the line that was read last."""
        line = max(1, self._line)
        source = Source(self._file, line)
        raise InputError([Diagnostic(Severity.ERROR, "sas", message, source, self._lines[line - 1])])


def _fact_name(name: str, variable: str) -> str:
    """Return the name of a fact: the PDDL atom of a value, or ``(not ATOM)`` if the atom is negated.

    ``name`` is the value as the file has it, ``variable`` the name of its variable. If the value is no atom,
    the fact is named ``(VARIABLE VALUE)``.
    """
    atom = _ATOM.fullmatch(name)
    if atom is None:
        return f"({variable} {name})"
    terms = [term.strip() for term in atom["terms"].split(",") if term.strip()]
    shown = f"({' '.join((atom['predicate'], *terms))})"
    return f"(not {shown})" if atom["negated"] else shown


def _unique_fact_names(names: list[list[str]]) -> list[str]:
    """Return the names of all facts in order; every name that occurs twice gets the number of its variable.

    For example, ``(open) [var3]``.
    """
    counts = Counter(name for values in names for name in values)
    return [
        f"{name} [var{variable}]" if counts[name] > 1 else name
        for variable, values in enumerate(names)
        for name in values
    ]
