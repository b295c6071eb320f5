"""Standard output and error, through which everything goes that a command says: what is shown is safe."""

import contextlib
import os
import sys
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, TextIO, cast

from foon_asp.errors import UserError
from foon_asp.escapes import encodable, escaped_lines, forget_line_ends

if TYPE_CHECKING:
    from rich.console import Console


class SafeStream:
    """A stream of text that escapes what a terminal or a log would not show, or take for a command.

    Letters that its encoding does not have are escaped too, so that no text is too foreign to be shown.
    ``stream`` is ``None`` where it was closed before we began. What cannot be written is a fault, but for
    ``remarks``, without which an answer is one. A ``styled`` stream lets colours pass: who writes to it
    escapes names first.
    """

    errors = "strict"

    def __init__(self, stream: TextIO | None, remarks: bool = False, styled: bool = False) -> None:
        self.stream = stream
        self._remarks = remarks
        self._styled = styled

    @property
    def encoding(self) -> str:
        """The encoding, which only who writes styled text has to know: the rest is seen to here."""
        return (self._styled and self.stream and self.stream.encoding) or "utf-8"

    def write(self, text: str) -> int:
        """Write a text; raises :class:`UserError` where there is no room, or nobody to write to."""
        if not isinstance(text, str):
            raise TypeError(f"expected text, found {type(text).__name__}")
        with self._faults():
            stream = self._open()
            stream.write(encodable(escaped_lines(text, self._styled), stream.encoding or "utf-8"))
        return len(text)

    def write_data(self, content: bytes) -> None:
        """Write bytes as they are."""
        with self._faults():
            stream = self._open()
            stream.flush()
            stream.buffer.write(content)
            stream.buffer.flush()

    def flush(self) -> None:
        """Hand over what was written."""
        if self.stream is not None:
            with self._faults():
                self.stream.flush()

    def isatty(self) -> bool:
        """Whether somebody sits in front of it."""
        return self.stream is not None and self.stream.isatty()

    def writable(self) -> bool:
        """Say yes: others ask."""
        return True

    def __getattr__(self, name: str) -> Any:
        return getattr(self.stream, name)

    def _open(self) -> TextIO:
        if self.stream is None:
            raise OSError("it is closed")
        return self.stream

    @contextlib.contextmanager
    def _faults(self) -> Iterator[None]:
        try:
            yield
        except BrokenPipeError:
            raise
        except OSError as error:
            if not self._remarks:
                raise UserError(f"standard output: cannot be written: {error.strerror or error}") from None


@contextlib.contextmanager
def safe_streams() -> Iterator[None]:
    """Let everything that is printed go through :class:`SafeStream`."""
    forget_line_ends()
    out, err = sys.stdout, sys.stderr
    sys.stdout = cast(TextIO, SafeStream(out))
    sys.stderr = cast(TextIO, SafeStream(err, remarks=True))
    try:
        yield
    finally:
        sys.stdout, sys.stderr = out, err


def write_data(content: str | bytes) -> None:
    """Write a file's worth of data to standard output, to the byte.

    Raises :class:`UserError` for text that UTF-8 cannot hold.
    """
    from foon_asp.report.whole_file import utf_8

    cast(SafeStream, sys.stdout).write_data(utf_8(content) if isinstance(content, str) else content)


def console(err: bool = False) -> "Console":
    """Give a console for tables and what moves, whose colours are let through on a terminal."""
    from rich.console import Console

    here = sys.stderr if err else sys.stdout
    stream = here.stream if isinstance(here, SafeStream) else here
    return Console(file=cast(TextIO, SafeStream(stream, remarks=err, styled=True)))


def drop_output() -> None:
    """Send what is still to be written nowhere: nobody can read it, and Python would try when it ends."""
    for stream in (sys.stdout, sys.stderr):
        if stream is None:
            continue
        try:
            stream.flush()
        except (OSError, UserError, ValueError):
            with contextlib.suppress(OSError, ValueError):
                os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())
