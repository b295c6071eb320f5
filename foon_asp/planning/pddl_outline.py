"""Checks of PDDL files for errors that the translator of Fast Downward does not report.

For the translator, an action with a parameter of an undeclared type or with an undeclared cost is never
applicable. So a misspelt name would prove that there is no plan.
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
    """A parenthesis, or a word in lower case, and its line and column in the text, both from 1."""

    text: str
    line: int
    column: int


@dataclass(frozen=True)
class PddlOutline:
    """A PDDL file as a sequence of tokens."""

    file: str
    text: str

    @cached_property
    def tokens(self) -> list[Token]:
        """The words and parentheses in order, without comments."""
        return list(_tokens(self._lines))

    @property
    def kind(self) -> str:
        """The kind of definition in the file: ``domain`` or ``problem``; empty if the file is no PDDL."""
        words = [token.text for token in self.tokens[:4]]
        return words[3] if words[:3] == ["(", "define", "("] and len(words) == 4 else ""

    @property
    def name(self) -> str:
        """The name of the domain or problem that the file defines; empty if the file ends before a name."""
        return self.tokens[4].text if len(self.tokens) > 4 else ""

    @cached_property
    def _lines(self) -> list[str]:
        """The lines of the text."""
        return split_lines(self.text)

    def section(self, name: str) -> set[str]:
        """Return the words in all sections of a name, such as ``:types``, at any depth of parentheses.

        A dash is a word as well. The name itself is left out.
        """
        words: set[str] = set()
        depth = section_depth = 0
        for previous, token in zip(self.tokens, self.tokens[1:], strict=False):
            depth += (previous.text == "(") - (previous.text == ")")
            if depth < section_depth:
                section_depth = 0
            if token.text == name and previous.text == "(":
                section_depth = depth
            elif section_depth:
                words.add(token.text)
        return words

    def require_types(self, types: set[str]) -> None:
        """Raise :class:`InputError` for a type, written after a dash, that is not in ``types``.

        In ``(either A B)`` after a dash, both types are checked.
        """
        tokens = self.tokens
        for index, token in enumerate(tokens[:-2]):
            if token.text != "-":
                continue
            type_tokens = [tokens[index + 1]]
            if type_tokens[0].text == "(":  # (either TYPE TYPE)
                type_tokens = tokens[index + 3 : _closing_index(tokens, index + 1)]
            for type_token in type_tokens:
                if type_token.text not in types:
                    self.raise_error(
                        type_token, f"found the type {type_token.text}, which the domain does not declare"
                    )

    def require_costs(self, functions: set[str]) -> None:
        """Raise :class:`InputError` for a cost function not in ``functions``, or a second cost of an action.

        The translator would count only the last cost of an action. A cost that is a number passes.
        """
        costs = 0
        for index, token in enumerate(self.tokens[:-5]):
            if token.text == ":action":
                costs = 0
            elif token.text == "increase":
                costs += 1
                if costs > 1:
                    self.raise_error(token, "found a second cost of an action, expected one (increase ...)")
                opening, function = self.tokens[index + 4 : index + 6]  # after (total-cost)
                if opening.text == "(" and function.text not in functions:
                    self.raise_error(
                        function, f"found the cost {function.text}, which the domain does not declare"
                    )

    def raise_error(self, token: Token, message: str) -> NoReturn:
        """Raise :class:`InputError` with a message and the position of a token."""
        source = Source(self.file, token.line, token.column)
        raise InputError([Diagnostic(Severity.ERROR, "pddl", message, source, self._lines[token.line - 1])])


def require_task(domain: PddlOutline, problem: PddlOutline) -> None:
    """Raise :class:`InputError` for the first fault of a planning task.

    A fault is a problem of another domain, a type or cost that is not declared, or an action with two costs.
    """
    for token, word in zip(problem.tokens, problem.tokens[1:], strict=False):
        if token.text == ":domain" and word.text != domain.name:
            problem.raise_error(
                word,
                f"found a problem of the domain {word.text}, but {domain.file} defines the domain "
                f"{domain.name}: the two files do not belong together",
            )
    types = domain.section(":types") | _BUILT_IN_TYPES
    for outline in (domain, problem):
        outline.require_types(types)
    domain.require_costs(domain.section(":functions"))


def _closing_index(tokens: list[Token], opening: int) -> int:
    """Return the index of the first closing parenthesis from ``opening`` on; without one, the end index."""
    return next((index for index in range(opening, len(tokens)) if tokens[index].text == ")"), len(tokens))


def _tokens(lines: list[str]) -> Iterator[Token]:
    """Yield the tokens of lines, in lower case and without comments.

    A ``?`` is the beginning of a word.
    """
    for number, line in enumerate(lines, 1):
        content = line.split(";", 1)[0].lower()
        word_start = 0
        for index, letter in enumerate(content + " "):
            if letter in "()?" or letter.isspace():
                if index > word_start:
                    yield Token(content[word_start:index], number, word_start + 1)
                if letter in "()":
                    yield Token(letter, number, index + 1)
                word_start = index + (letter != "?")  # a ? begins a word
