"""PDDL as it is written: words and lists in parentheses, each with its place.

One regular expression is the whole grammar: what a list means depends on where it stands, so it is read by
whoever expects it, who then can say in words what is missing or beyond.
"""

import re
from collections.abc import Iterator
from typing import NamedTuple, NoReturn

from foon_asp.network import Source
from foon_asp.text.diagnostics import Diagnostic, InputError, Severity
from foon_asp.text.plain_file import split_lines

_TOKEN = re.compile(r"[ \t\r\n\f\v]+|;[^\r\n]*|([()]|\??[^ \t\r\n\f\v();?]+|\?)")  # a ? begins a word


class Word(NamedTuple):
    """A word, in small letters since PDDL tells none apart, and its place in the text."""

    text: str
    at: int


class Form(NamedTuple):
    """A list in parentheses, and its place in the text."""

    items: tuple["Word | Form", ...]
    at: int

    @property
    def head(self) -> str:
        """The word that it begins with; empty where it begins with none."""
        first = self.items[0] if self.items else self
        return first.text if isinstance(first, Word) else ""


class PddlText(NamedTuple):
    """A file of PDDL, for messages about places in it."""

    file: str
    text: str

    def fault(self, at: "int | Word | Form", message: str) -> NoReturn:
        """Raise :class:`InputError` about a place."""
        place = at if isinstance(at, int) else at.at
        line = self.text.count("\n", 0, place) + 1
        start = self.text.rfind("\n", 0, place) + 1
        source = Source(self.file, line, place - start + 1)
        excerpt = split_lines(self.text[start:].split("\n", 1)[0])[0]
        raise InputError([Diagnostic(Severity.ERROR, "pddl", message, source, excerpt)])

    def read(self) -> Form:
        """Give the one list that a file is; raises :class:`InputError` for anything else."""
        open_: list[tuple[int, list[Word | Form]]] = []
        whole: Form | None = None
        for word in self._tokens():
            if whole is not None:
                self.fault(word, f"found {shown(word)}, expected the end of the file")
            if word.text == "(":
                open_.append((word.at, []))
            elif not open_:
                self.fault(word, f"found {shown(word)}, expected ( at the beginning of the file")
            elif word.text == ")":
                at, items = open_.pop()
                form = Form(tuple(items), at)
                if open_:
                    open_[-1][1].append(form)
                else:
                    whole = form
            else:
                open_[-1][1].append(word)
        if open_:
            self.fault(open_[-1][0], "found a ( that is never closed, expected as many ) as (")
        if whole is None:
            self.fault(0, "found an empty file, expected (define ...)")
        return whole

    def _tokens(self) -> Iterator[Word]:
        for found in _TOKEN.finditer(self.text):
            if found[1]:
                yield Word(found[1].lower(), found.start(1))


def shown(part: Word | Form) -> str:
    """Give a part of a file as messages have it."""
    if isinstance(part, Word):
        return repr(part.text[:60])
    return f"({part.head[:60]} ...)" if part.head else "(...)"
