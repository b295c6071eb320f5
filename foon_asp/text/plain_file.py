"""Reading of text files in UTF-8, with or without a byte order mark; recognition of stores."""

import re
from codecs import BOM_UTF8, getincrementaldecoder
from collections.abc import Callable, Iterator
from io import TextIOWrapper
from pathlib import Path
from typing import BinaryIO

from foon_asp.errors import UserError
from foon_asp.network import Source
from foon_asp.text.diagnostics import Diagnostic, InputError, Severity

STORE_SUFFIX = ".foon"
NEUTRAL_SUFFIXES = (".jsonl", ".ndjson")
_LINE = re.compile(r"([^\r\n]*)(\r\n|\r|\n|\Z)")
_LINE_END = re.compile(r"\r\n|\r|\n")
FENCE = "```"
"""The beginning of lines around code in Markdown."""
STORE_MAGIC = b"SQLite format 3\0"  # how every database begins


def is_store(file: Path) -> bool:
    """Whether a path is that of a store: it has the suffix ``.foon``, or begins like an SQLite database.

    With the suffix, the file need not exist; a folder is no store.
    """
    if file.suffix == STORE_SUFFIX and not file.is_dir():
        return True
    return read_beginning(file, len(STORE_MAGIC)) == STORE_MAGIC


def read_beginning(file: Path, length: int) -> bytes:
    """Return the first ``length`` bytes of a file; empty for an unreadable file or a pipe."""
    if not file.is_file():
        return b""
    try:
        with file.open("rb") as stream:
            return stream.read(length)
    except OSError:
        return b""


def open_bytes(file: Path) -> BinaryIO:
    """Return a file that is open for reading bytes; raises :class:`UserError` when it cannot be opened."""
    try:
        return file.open("rb")
    except OSError as error:
        raise _unreadable_error(file, error) from None


def read_content(file: Path) -> bytes:
    """Return the bytes of a file; raises :class:`UserError` when it cannot be read."""
    try:
        return file.read_bytes()
    except OSError as error:
        raise _unreadable_error(file, error) from None


def _unreadable_error(file: Path, error: OSError) -> UserError:
    """Return the error that a file cannot be read, with the reason of the system."""
    return UserError(f"{file}: cannot be read: {error.strerror or error}")


def text_pieces(file: Path, size: int) -> Iterator[str]:
    """Yield the text of a file in pieces of about ``size`` letters, with line feeds as line ends.

    The file is first read as a whole to see whether it is UTF-8; for other files, this raises as
    :func:`read_plain_text` does. A byte order mark is left out.
    """
    with open_bytes(file) as stream:
        first_bytes = stream.read(len(STORE_MAGIC))
        stream.seek(0)
        try:
            decoder = getincrementaldecoder("utf-8")()
            while chunk := stream.read(size):
                decoder.decode(chunk)
            decoder.decode(b"", True)
        except UnicodeDecodeError:
            first_bytes = STORE_MAGIC
        if first_bytes == STORE_MAGIC:
            read_plain_text(file)  # raises the error
        stream.seek(0)
        with TextIOWrapper(stream, "utf-8-sig", newline=None) as text:
            while piece := text.read(size):
                yield piece


def split_lines(text: str) -> list[str]:
    """Return the lines of a text without their line ends, which may be of any kind.

    Behind a last line end, there is an empty line.
    """
    return text.replace("\r\n", "\n").replace("\r", "\n").split("\n")


def map_lines(text: str, write: Callable[[str], str]) -> str:
    """Return a text in which ``write`` has replaced each line; line ends stay."""
    return _LINE.sub(lambda match: write(match[1]) + match[2], text)


def usual_line_end(text: str) -> str:
    """Return the line end that most lines of a text have; a line feed if the text has no line end."""
    ends = _LINE_END.findall(text)
    return max(("\n", "\r\n", "\r"), key=ends.count)


def protect_byte_order_mark(text: str) -> str:
    """Return the text to write to a file so that it is read back as ``text``.

    A byte order mark at the beginning of ``text`` belongs to it, so another one is put before it.
    """
    return f"\ufeff{text}" if text.startswith("\ufeff") else text


def read_beginning_text(file: Path, max_bytes: int = 1_000_000) -> str:
    """Return the beginning of a file as text, by which its format is recognised.

    Bytes that are not UTF-8 are replaced. ``max_bytes`` has to cover the first line of a neutral file, which
    is a whole unit.
    """
    return read_beginning(file, max_bytes).decode("utf-8-sig", errors="replace")


def read_plain_text(file: Path) -> str:
    """Return the text of a file in UTF-8, without a byte order mark, with its line ends.

    Raises :class:`UserError` for a store, and when the file cannot be read. Raises :class:`InputError` with
    line and column of the first byte that is not UTF-8.
    """
    return plain_text(read_content(file), file)


def plain_text(data: bytes, file: Path) -> str:
    """Return the text of a file from its bytes ``data``; raises as :func:`read_plain_text` does."""
    if data.startswith(STORE_MAGIC):
        raise UserError(f"{file}: is a store, expected text; name a store only with --network")
    data = data.removeprefix(BOM_UTF8)
    try:
        return data.decode()
    except UnicodeDecodeError as error:
        raise not_utf_8(data, error, file) from None


def not_utf_8(data: bytes, error: UnicodeDecodeError, file: Path, line: int = 1) -> InputError:
    """Return the error that bytes of a file are no UTF-8, with the line and column of the first such byte.

    ``line`` is the number of the first line of ``data``.
    """
    bytes_before = data[: error.start]
    line_start = bytes_before.rfind(b"\n") + 1
    column = len(bytes_before[line_start:].decode("utf-8-sig")) + 1
    message = f"found the byte 0x{data[error.start]:02x}, expected UTF-8 text; save the file as UTF-8"
    source = Source(str(file), line + bytes_before.count(b"\n"), column)
    return InputError([Diagnostic(Severity.ERROR, "encoding", message, source)])
