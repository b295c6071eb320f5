"""Text files as they come: UTF-8 with or without a byte order mark."""

from codecs import BOM_UTF8
from pathlib import Path

from foon_asp.errors import UserError
from foon_asp.network import Source
from foon_asp.text.diagnostics import Diagnostic, InputError, Severity


def read_plain_text(file: Path) -> str:
    """Read a whole file as UTF-8, line ends untouched.

    Raises :class:`UserError` when it cannot be opened and :class:`InputError` with line and column of
    the first byte that is not UTF-8.
    """
    try:
        data = file.read_bytes()
    except OSError as error:
        raise UserError(f"{file}: cannot be read: {error.strerror or error}") from None
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
