"""A line of a session, split into words like a command line."""

import re
from typing import NamedTuple

from foon_asp.errors import UserError

_PLAIN = re.compile(r"[^\s'\"\\#][^\s'\"\\]*")  # a word that needs no quotes


class Word(NamedTuple):
    """A word without its quotes, and the column, from 0, at which it begins with them."""

    text: str
    start: int


class Line(NamedTuple):
    """The words of a line, and the quote that is still open at its end, if any."""

    words: tuple[Word, ...]
    open_quote: str = ""

    @property
    def texts(self) -> list[str]:
        """The words as texts; raises :class:`UserError` for a quote that is not closed."""
        if self.open_quote:
            raise UserError(f"the quote {self.open_quote} in {self.words[-1].text!r} is not closed")
        return [word.text for word in self.words]


def take_apart(text: str) -> Line:
    """Split a line: blanks separate words, quotes keep them together, ``#`` before a word begins a comment.

    Within single quotes, nothing is special; within double quotes, a backslash quotes ``"`` and itself;
    outside of quotes, it quotes any letter.
    """
    words: list[Word] = []
    current, start, quote = "", -1, ""
    place = 0
    while place < len(text):
        letter, after = text[place], text[place + 1 : place + 2]
        place += 1
        if quote:
            if letter == quote:
                quote = ""
            elif letter == "\\" and quote == '"' and after and after in '"\\':
                current += after
                place += 1
            else:
                current += letter
            continue
        if letter.isspace():
            if start >= 0:
                words.append(Word(current, start))
            current, start = "", -1
            continue
        if start < 0:
            if letter == "#":
                break
            start = place - 1
        if letter in "'\"":
            quote = letter
        elif letter == "\\":
            current += after
            place += 1
        else:
            current += letter
    if start >= 0:
        words.append(Word(current, start))
    return Line(tuple(words), quote)


def quoted(word: str) -> str:
    """Quote a word so that :func:`take_apart` reads it back."""
    if _PLAIN.fullmatch(word):
        return word
    return f"'{word}'" if "'" not in word else '"' + re.sub(r'(["\\])', r"\\\1", word) + '"'
