"""Text files as they come, UTF-8 with or without a byte order mark; and what is none."""

from codecs import BOM_UTF8
from pathlib import Path

from foon_asp.errors import UserError
from foon_asp.network import Source
from foon_asp.text.diagnostics import Diagnostic, InputError, Severity

STORE_SUFFIX = ".foon"
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


def read_content(file: Path) -> bytes:
    """Read a whole file; raises :class:`UserError` when it cannot be opened."""
    try:
        return file.read_bytes()
    except OSError as error:
        raise UserError(f"{file}: cannot be read: {error.strerror or error}") from None


def is_json(text: str) -> bool:
    """Whether a text is JSON; no line of FOON text begins with a bracket."""
    return text[:1_000].lstrip(" \t\r\n")[:1] in {"{", "["}


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
        before = data[: error.start]
        start = before.rfind(b"\n") + 1
        column = len(before[start:].decode()) + 1
        message = f"found the byte 0x{data[error.start]:02x}, expected UTF-8 text; save the file as UTF-8"
        source = Source(str(file), before.count(b"\n") + 1, column)
        raise InputError([Diagnostic(Severity.ERROR, "encoding", message, source)]) from None
