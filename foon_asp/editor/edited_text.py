"""A FOON text that is edited: a change reads the pieces again that it touches, and no others."""

from bisect import bisect_right
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator
from itertools import accumulate
from typing import NamedTuple

from foon_asp.editor.piece import Block, Name, Piece
from foon_asp.network import ObjectNode
from foon_asp.text.diagnostics import Diagnostic
from foon_asp.text.plain_file import is_json, split_lines
from foon_asp.text.reader import FoonReader


class Found(NamedTuple):
    """A block of a piece, and the index of the first line of the piece."""

    start: int
    piece: Piece
    block: Block


class EditedText:
    """The lines of a text in the pieces between its separators, and an index of the names and nodes in it.

    JSON is not read piece by piece: it has one piece without lines, for its findings.
    """

    def __init__(self, text: str) -> None:
        self.reader = FoonReader()
        self.is_json = is_json(text)
        self.end = "\r\n" if "\r\n" in text else "\n"
        self.lines = split_lines(text)
        self.pieces: list[Piece] = []
        self.counts: Counter[Name] = Counter()
        self.holding: Counter[str] = Counter()
        self.ids: defaultdict[Name, Counter[str]] = defaultdict(Counter)
        self.makers: defaultdict[ObjectNode, dict[Piece, None]] = defaultdict(dict)
        self.needers: defaultdict[ObjectNode, dict[Piece, None]] = defaultdict(dict)
        self._starts: list[int] = []
        self._motions = 0
        self._put(0, 0, self._cut([] if self.is_json else self.lines))

    @property
    def text(self) -> str:
        """The whole text, with the line ends that it came with."""
        return self.end.join(self.lines)

    @property
    def is_list(self) -> bool:
        """Whether it lists objects, as a kitchen does: there is no motion in it."""
        return self._motions == 0

    @property
    def starts(self) -> list[int]:
        """The index of the first line of each piece."""
        if not self._starts:
            self._starts = [0, *accumulate(len(piece.lines) for piece in self.pieces)][:-1]
        return self._starts

    def change(self, start: tuple[int, int], end: tuple[int, int], text: str) -> None:
        """Replace what stands between two places, each the index of a line and of a letter in it."""
        first, last = min(start[0], len(self.lines) - 1), min(end[0], len(self.lines) - 1)
        head = self.lines[first][: start[1]] if start[0] == first else self.lines[first]
        tail = self.lines[last][end[1] :] if end[0] == last else ""
        new = split_lines(head + text + tail)
        if self.is_json:
            self.lines[first : last + 1] = new
            return
        from_piece, to_piece = self._piece_at(first), self._piece_at(last)
        begin = self.starts[from_piece]
        until = self.starts[to_piece] + len(self.pieces[to_piece].lines) + len(new) - (last + 1 - first)
        self.lines[first : last + 1] = new
        pieces = self._cut(self.lines[begin:until])
        while to_piece + 1 < len(self.pieces) and pieces[-1].lines:  # the separator is gone
            to_piece += 1
            until += len(self.pieces[to_piece].lines)
            pieces = self._cut(self.lines[begin:until])
        if to_piece + 1 < len(self.pieces) and not pieces[-1].lines:
            pieces.pop()
        self._put(from_piece, to_piece + 1, pieces)

    def block_at(self, line: int) -> Found | None:
        """Give the object node that a line belongs to."""
        if self.is_json or line >= len(self.lines):
            return None
        place = self._piece_at(line)
        start, piece = self.starts[place], self.pieces[place]
        here = (block for block in piece.blocks if block.start <= line - start < block.end)
        return next((Found(start, piece, block) for block in here), None)

    def where(self, pieces: Iterable[Piece]) -> Iterator[tuple[int, Piece]]:
        """Give the index of the first line of each piece, in order."""
        wanted = set(pieces)
        return ((start, p) for start, p in zip(self.starts, self.pieces, strict=True) if p in wanted)

    def linted(self, findings: Iterable[tuple[int, Diagnostic]]) -> None:
        """Take note of the findings about the present text, each with the index of its line."""
        for piece in self.pieces:
            piece.findings, piece.told = [], None
        for line, finding in findings:
            place = self._piece_at(min(line, len(self.lines) - 1))
            self.pieces[place].findings.append((line - self.starts[place], finding))

    def findings(self, first: int, last: int) -> Iterator[tuple[int, Diagnostic]]:
        """Give every finding about some lines with its line; of pieces that are new, what the reader says."""
        pieces = slice(self._piece_at(first), self._piece_at(last) + 1)
        for start, piece in zip(self.starts[pieces], self.pieces[pieces], strict=True):
            for line, finding in piece.findings:
                if first <= start + line <= last:
                    yield start + line, finding

    def _piece_at(self, line: int) -> int:
        return bisect_right(self.starts, line) - 1

    def _cut(self, lines: list[str]) -> list[Piece]:
        """Cut lines into pieces; what stands behind the last separator is one, too, and may be empty."""
        self.reader.parse_new(lines)
        pieces, start = [], 0
        for index, line in enumerate(lines):
            if line[:1] == "/" and line.rstrip(" \t") == "//":
                pieces.append(Piece(lines[start : index + 1], True, self.reader))
                start = index + 1
        pieces.append(Piece(lines[start:], False, self.reader))
        return pieces

    def _put(self, start: int, end: int, pieces: list[Piece]) -> None:
        """Put pieces in the place of others."""
        is_new = not self.pieces
        for piece in self.pieces[start:end]:
            self._count(piece, -1)
        for piece in pieces:
            self._count(piece, 1)
        self.pieces[start:end] = pieces
        self._starts = []
        for piece in pieces if not is_new else ():
            piece.findings = piece.remarks(self.reader, self.is_list)

    def _count(self, piece: Piece, sign: int) -> None:
        self._motions += sign * (piece.motion is not None)
        for name in piece.names:
            self.counts[name] += sign
            if not self.counts[name]:
                del self.counts[name]
        for word in piece.holding:
            self.holding[word] += sign
        for name, id_ in piece.ids:
            self.ids[name][id_] += sign
        for index, nodes in ((self.makers, piece.makes), (self.needers, piece.needs())):
            for node in nodes:
                if sign > 0:
                    index[node][piece] = None
                else:
                    index[node].pop(piece, None)
