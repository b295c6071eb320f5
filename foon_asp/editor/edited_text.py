"""Text that is open in an editor, and the protocol's positions, ranges and edits in it."""

import re
import sys
from pathlib import Path
from urllib.parse import unquote

from foon_asp.editor.json_rpc import parameter
from foon_asp.text.formats import format_of
from foon_asp.text.json_value import Json
from foon_asp.text.plain_file import split_lines


class EditedText:
    """A text with its lines. Letters of a line are code points, columns of the protocol UTF-16 code units."""

    def __init__(self, uri: str, text: str) -> None:
        self.uri = uri
        self.text = text
        self.lines = split_lines(text)
        self.end = "\r\n" if "\r\n" in text else "\n"
        self.is_json = not format_of(text).has_comments

    @property
    def file(self) -> Path:
        """The path of the file."""
        scheme, _, path = unquote(self.uri).partition("://")
        return Path(re.sub("^/(?=[A-Za-z]:)", "", path) if scheme == "file" else "untitled")

    def position_of(self, parameters: object) -> tuple[int, int]:
        """Return the line and the letter, from 0, of the position in the parameters of a request."""
        line = min(parameter(parameters, "position.line", int), len(self.lines) - 1)
        column = parameter(parameters, "position.character", int)
        code_units = self.lines[line].encode("utf-16-le", "surrogatepass")[: 2 * column]
        return line, len(code_units.decode("utf-16-le", "ignore"))

    def position(self, line: int, letter: int = 0) -> Json:
        """Return the protocol's position of a letter of a line."""
        prefix = self.lines[line][:letter]
        return {"line": line, "character": len(prefix.encode("utf-16-le", "surrogatepass")) // 2}

    def range(self, line: int, start: int = 0, end: int = sys.maxsize) -> Json:
        """Return the protocol's range of the letters of a line from ``start`` to before ``end``."""
        return {"start": self.position(line, start), "end": self.position(line, end)}

    def edit(self, text: str, line: int, start: int = 0, end: int = sys.maxsize) -> Json:
        """Return the edit that replaces letters of a line by a text."""
        return {"range": self.range(line, start, end), "newText": text}

    def edits(self, lines: list[str]) -> list[Json]:
        """Return the edits that turn the text into one with these lines."""
        last = min(len(self.lines), len(lines)) - 1  # the edit of this line covers all lines after it
        edits = [
            self.edit(lines[number], number) for number in range(last) if lines[number] != self.lines[number]
        ]
        if self.lines[last:] != lines[last:]:
            edit = self.edit(self.end.join(lines[last:]), last)
            edit["range"]["end"] = self.range(len(self.lines) - 1)["end"]
            edits.append(edit)
        return edits
