"""Text files as they come, UTF-8 with or without a byte order mark; and what is none."""

import json
import re
from codecs import BOM_UTF8, getincrementaldecoder
from collections.abc import Iterator
from io import TextIOWrapper
from pathlib import Path
from typing import BinaryIO

from foon_asp.errors import UserError
from foon_asp.network import Source
from foon_asp.text.diagnostics import Diagnostic, InputError, Severity

STORE_SUFFIX = ".foon"
NEUTRAL_SUFFIXES = (".jsonl", ".ndjson")
_FIRST_LINE = 1_000_000  # bytes of it looked at
FENCE = "```"
"""How a line begins by which Markdown, and who writes it, tells code from prose."""
_BEGINNING = 2_000  # letters of a text that are looked at for JSON
_JSON_LINE = re.compile(r"^[ \t]*[\[{]", re.MULTILINE)
_FOON_LINE = re.compile(r"[OSM]\d*[ \t]|//|#")
STORE_MAGIC = b"SQLite format 3\0"  # how every database begins


def is_store(file: Path) -> bool:
    """Whether a path is no text but a store: it is named like one, or begins like any database."""
    if file.suffix == STORE_SUFFIX and not file.is_dir():
        return True
    return read_beginning(file, len(STORE_MAGIC)) == STORE_MAGIC


def read_beginning(file: Path, length: int) -> bytes:
    """Give the first bytes of a file; nothing where it cannot be read, or can be once only, as a pipe."""
    if not file.is_file():
        return b""
    try:
        with file.open("rb") as opened:
            return opened.read(length)
    except OSError:
        return b""


def opened(file: Path) -> BinaryIO:
    """Open a file to read its bytes; raises :class:`UserError` when it cannot be."""
    try:
        return file.open("rb")
    except OSError as error:
        raise _unreadable(file, error) from None


def read_content(file: Path) -> bytes:
    """Read a whole file; raises :class:`UserError` when it cannot be opened."""
    try:
        return file.read_bytes()
    except OSError as error:
        raise _unreadable(file, error) from None


def _unreadable(file: Path, error: OSError) -> UserError:
    return UserError(f"{file}: cannot be read: {error.strerror or error}")


def is_neutral(text: str, file: str = "") -> bool:
    """Whether a text is in the neutral form: named as it, or its first line is one of its units as JSON."""
    if file.endswith(NEUTRAL_SUFFIXES):
        return True
    start = len(text[:1_000]) - len(text[:1_000].lstrip("\ufeff \t\r\n"))
    line = text[start:].split("\n", 1)[0] if text[start : start + 1] == "{" else ""
    if '"outputs"' not in line:
        return False
    try:
        unit = json.loads(line, parse_int=str, parse_float=str)
    except (ValueError, RecursionError):
        return False
    return isinstance(unit, dict) and unit.keys() >= {"inputs", "outputs"} and "schema" not in unit


def begins_neutral(file: Path) -> bool:
    """Whether the first line of a file is a unit of the neutral form."""
    with opened(file) as lines:
        return is_neutral(lines.readline(_FIRST_LINE).decode(errors="replace"))


def is_neutral_file(file: Path) -> bool:
    """Whether a file is in the neutral form, by the ending of its name or by its first line."""
    return file.is_file() and (file.name.endswith(NEUTRAL_SUFFIXES) or begins_neutral(file))


def is_json(text: str) -> bool:
    """Whether a text is JSON; no line of FOON text begins with a bracket."""
    return text[:1_000].lstrip(" \t\r\n")[:1] in {"{", "["}


def before_json(text: str) -> str:
    """Return an error message about what stands before JSON in a text; empty where nothing does."""
    begins = text[:_BEGINNING].lstrip(" \t\r\n")
    first = begins.split("\n", 1)[0].rstrip()
    if not _JSON_LINE.search(begins) or is_json(begins) or _FOON_LINE.match(first):
        return ""
    if first.startswith(FENCE):
        return (
            f"found a code fence around JSON, expected JSON alone: remove the lines that begin with {FENCE}"
        )
    return f"found the text {first[:40]!r} before JSON, expected JSON alone: remove it"


def text_pieces(file: Path, size: int) -> Iterator[str]:
    """Give the text of a file in pieces of some ``size``, every line end as a line feed.

    Raises as :func:`read_plain_text` does, before it gives anything.
    """
    with opened(file) as stream:
        begins = stream.read(len(STORE_MAGIC))
        stream.seek(0)
        try:
            decoder = getincrementaldecoder("utf-8")()
            while data := stream.read(size):
                decoder.decode(data)
            decoder.decode(b"", True)
        except UnicodeDecodeError:
            begins = STORE_MAGIC
        if begins == STORE_MAGIC:
            read_plain_text(file)  # says what is wrong
        stream.seek(0)
        with TextIOWrapper(stream, "utf-8-sig", newline=None) as text:
            while piece := text.read(size):
                yield piece


def split_lines(text: str) -> list[str]:
    """Give the lines of a text without their ends, whatever these are."""
    return text.replace("\r\n", "\n").replace("\r", "\n").split("\n")


def read_plain_text(file: Path) -> str:
    """Read a whole file as UTF-8, line ends untouched.

    Raises :class:`UserError` when it cannot be opened and :class:`InputError` with line and column of
    the first byte that is not UTF-8.
    """
    return plain_text(read_content(file), file)


def plain_text(data: bytes, file: Path) -> str:
    """Give the text of the bytes of a file, as :func:`read_plain_text` does."""
    if data.startswith(STORE_MAGIC):
        raise UserError(f"{file}: is a store, expected text; name a store only with --network")
    data = data.removeprefix(BOM_UTF8)
    try:
        return data.decode()
    except UnicodeDecodeError as error:
        raise not_utf_8(data, error, file) from None


def not_utf_8(data: bytes, error: UnicodeDecodeError, file: Path, line: int = 1) -> InputError:
    """Give the error of bytes that are no UTF-8; ``line`` is the number of their first line."""
    before = data[: error.start]
    start = before.rfind(b"\n") + 1
    column = len(before[start:].decode("utf-8-sig")) + 1
    message = f"found the byte 0x{data[error.start]:02x}, expected UTF-8 text; save the file as UTF-8"
    source = Source(str(file), line + before.count(b"\n"), column)
    return InputError([Diagnostic(Severity.ERROR, "encoding", message, source)])
