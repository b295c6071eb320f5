"""The words of a PDDL file with their places: what it defines, and slips that its reader passes over.

The translator of Fast Downward reads PDDL. For it, an action with a parameter of an undeclared type or with
an undeclared cost is one that never runs, so that a slip would prove that there is no plan.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple, NoReturn

from foon_asp.network import Source
from foon_asp.text.diagnostics import Diagnostic, InputError, Severity
from foon_asp.text.plain_file import split_lines

_BUILT_IN_TYPES = {"object", "number"}


class Token(NamedTuple):
    """A parenthesis, or a word in small letters, and its place in the text: lines and columns from 1."""

    text: str
    line: int
    column: int


@dataclass(frozen=True)
class PddlOutline:
    """A PDDL file as a sequence of words and parentheses."""

    file: str
    text: str

    @cached_property
    def tokens(self) -> list[Token]:
        """The words and parentheses, without comments."""
        return list(_tokens(self._lines))

    @property
    def kind(self) -> str:
        """What the file defines: ``domain``, ``problem``, or empty where it is no PDDL."""
        words = [token.text for token in self.tokens[:4]]
        return words[3] if words[:3] == ["(", "define", "("] and len(words) == 4 else ""

    @property
    def name(self) -> str:
        """The name of the domain or the problem."""
        return self.tokens[4].text if len(self.tokens) > 4 else ""

    @cached_property
    def _lines(self) -> list[str]:
        return split_lines(self.text)

    def section(self, name: str) -> set[str]:
        """Return the words of the sections of a name, such as ``:types``."""
        words: set[str] = set()
        depth = inside = 0
        for before, token in zip(self.tokens, self.tokens[1:], strict=False):
            depth += (before.text == "(") - (before.text == ")")
            if depth < inside:
                inside = 0
            if token.text == name and before.text == "(":
                inside = depth
            elif inside:
                words.add(token.text)
        return words

    def require_types(self, types: set[str]) -> None:
        """Raise :class:`InputError` for a type that is not among the declared ones."""
        tokens = self.tokens
        for place, token in enumerate(tokens[:-2]):
            if token.text != "-":
                continue
            kinds = [tokens[place + 1]]
            if kinds[0].text == "(":  # (either TYPE TYPE)
                kinds = tokens[place + 3 : _closing(tokens, place + 1)]
            for kind in kinds:
                if kind.text not in types:
                    self.fault(kind, f"found the type {kind.text}, which the domain does not declare")

    def require_costs(self, functions: set[str]) -> None:
        """Raise :class:`InputError` for a cost that is not declared, or the second one of an action.

        The translator would count the last cost of an action alone.
        """
        costs = 0
        for place, token in enumerate(self.tokens[:-5]):
            if token.text == ":action":
                costs = 0
            elif token.text == "increase":
                costs += 1
                if costs > 1:
                    self.fault(token, "found a second cost of an action, expected one (increase ...)")
                opening, function = self.tokens[place + 4 : place + 6]  # after (total-cost)
                if opening.text == "(" and function.text not in functions:
                    self.fault(function, f"found the cost {function.text}, which the domain does not declare")

    def fault(self, token: Token, message: str) -> NoReturn:
        """Raise :class:`InputError` about a place."""
        source = Source(self.file, token.line, token.column)
        raise InputError([Diagnostic(Severity.ERROR, "pddl", message, source, self._lines[token.line - 1])])


def require_task(domain: PddlOutline, problem: PddlOutline) -> None:
    """Raise :class:`InputError` where a problem is not of a domain, or a name in them is not declared."""
    for token, word in zip(problem.tokens, problem.tokens[1:], strict=False):
        if token.text == ":domain" and word.text != domain.name:
            problem.fault(
                word,
                f"found a problem of the domain {word.text}, but {domain.file} defines the domain "
                f"{domain.name}: the two files do not belong together",
            )
    types = domain.section(":types") | _BUILT_IN_TYPES
    for outline in (domain, problem):
        outline.require_types(types)
    domain.require_costs(domain.section(":functions"))


def _closing(tokens: list[Token], place: int) -> int:
    """Return the place of the parenthesis that closes the one at a place."""
    return next((n for n in range(place, len(tokens)) if tokens[n].text == ")"), len(tokens))


def _tokens(lines: list[str]) -> Iterator[Token]:
    for number, line in enumerate(lines, 1):
        content = line.split(";", 1)[0].lower()
        begin = 0
        for place, letter in enumerate(content + " "):
            if letter in "()?" or letter.isspace():
                if place > begin:
                    yield Token(content[begin:place], number, begin + 1)
                if letter in "()":
                    yield Token(letter, number, place + 1)
                begin = place + (letter != "?")  # a ? begins a word
