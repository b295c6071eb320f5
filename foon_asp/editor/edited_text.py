"""A text that is open in an editor, and the protocol's positions, ranges and edits in it."""

import re
import sys
from pathlib import Path
from urllib.parse import unquote

from foon_asp.editor.json_rpc import parameter
from foon_asp.json_layout import Json
from foon_asp.text.formats import format_of
from foon_asp.text.plain_file import split_lines


class EditedText:
    """A text that is open in an editor.

    Lines and letters are counted from 0. A letter is a code point, while a column of the protocol is a UTF-16
    code unit. ``line_end`` is the line end of edits: that of Windows if the text has one.
    """

    def __init__(self, uri: str, text: str) -> None:
        self.uri = uri
        self.text = text
        self.lines = split_lines(text)
        self.line_end = "\r\n" if "\r\n" in text else "\n"
        self.is_json = not format_of(text).has_comments

    @property
    def file(self) -> Path:
        """The path of the file; ``untitled`` for a text that is not in a file."""
        scheme, _, path = unquote(self.uri).partition("://")
        return Path(re.sub("^/(?=[A-Za-z]:)", "", path) if scheme == "file" else "untitled")

    def requested_position(self, parameters: object) -> tuple[int, int]:
        """Return line and letter of the position in the parameters of a request.

        A line below the text becomes the last line. A letter beyond the end of the line becomes the end.
        Raises :class:`RequestError` for parameters without a position.
        """
        line = min(parameter(parameters, "position.line", int), len(self.lines) - 1)
        column = parameter(parameters, "position.character", int)
        code_units = self.lines[line].encode("utf-16-le", "surrogatepass")[: 2 * column]
        return line, len(code_units.decode("utf-16-le", "ignore"))

    def position(self, line: int, letter: int = 0) -> Json:
        """Return a letter of a line as a position of the protocol."""
        prefix = self.lines[line][:letter]
        return {"line": line, "character": len(prefix.encode("utf-16-le", "surrogatepass")) // 2}

    def range(self, line: int, start: int = 0, end: int = sys.maxsize) -> Json:
        """Return letters of a line, from ``start`` to before ``end``, as a range of the protocol.

        By default, ``end`` is the end of the line.
        """
        return {"start": self.position(line, start), "end": self.position(line, end)}

    def edit(self, text: str, line: int, start: int = 0, end: int = sys.maxsize) -> Json:
        """Return the edit that replaces letters of a line, from ``start`` to before ``end``, by a text.

        By default, it replaces the whole line.
        """
        return {"range": self.range(line, start, end), "newText": text}

    def edits_to(self, lines: list[str]) -> list[Json]:
        """Return the edits that turn the text into a text with these lines; unchanged lines get no edit.

        The lines are compared one by one up to the last line of the shorter text. One edit covers this line
        and all lines after it.
        """
        last = min(len(self.lines), len(lines)) - 1  # the edit of this line covers all lines after it
        edits = [
            self.edit(lines[number], number) for number in range(last) if lines[number] != self.lines[number]
        ]
        if self.lines[last:] != lines[last:]:
            edit = self.edit(self.line_end.join(lines[last:]), last)
            edit["range"]["end"] = self.range(len(self.lines) - 1)["end"]
            edits.append(edit)
        return edits
