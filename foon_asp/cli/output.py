"""Standard output and error: streams that escape everything a command prints for terminals."""

import contextlib
import os
import shutil
import sys
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any, TextIO, cast

import click

from foon_asp.errors import UserError
from foon_asp.escapes import encodable, escaped_lines
from foon_asp.results.table import Block, blocks_text

if TYPE_CHECKING:
    from rich.console import Console

_WRITTEN_ONCE = "foon_asp.written_once"  # in the context of a command: the remarks that it wrote once
_SIGNS = {"→": "->", "≈": "~", "×": "x", "†": "+"}


class SafeStream:
    """A text stream that escapes characters which a terminal or a log would hide or execute.

    Characters that the encoding of the stream lacks are escaped as well.

    ``stream``: the stream to write to; ``None`` if it was closed from the start.
    ``remarks``: whether failed writes are ignored, since an answer is complete without remarks.
    ``styled``: whether the codes of colours are kept; the caller must then escape names.
    ``quiet``: whether text is dropped.
    """

    errors = "strict"

    def __init__(self, stream: TextIO | None, remarks: bool = False, styled: bool = False) -> None:
        self.stream = stream
        self.quiet = False
        self._remarks = remarks
        self._styled = styled

    @property
    def encoding(self) -> str:
        """The encoding of the stream if it is styled; else ``utf-8``, since all text is escaped."""
        return (self._styled and self.stream and self.stream.encoding) or "utf-8"

    def write(self, text: str) -> int:
        """Write a text, escaped, unless the stream is quiet; return the number of its characters.

        Raises :class:`UserError` where the disk is full or the output is closed.
        """
        if not isinstance(text, str):
            raise TypeError(f"expected text, found {type(text).__name__}")
        if self.quiet:
            return len(text)
        with self._user_errors():
            stream = self._open_stream()
            stream.write(encodable(escaped_lines(text, self._styled), stream.encoding or "utf-8"))
        return len(text)

    def write_data(self, content: bytes) -> None:
        """Write bytes unchanged, also if the stream is quiet, and flush; raises as :meth:`write` does."""
        with self._user_errors():
            stream = self._open_stream()
            stream.flush()
            stream.buffer.write(content)
            stream.buffer.flush()

    def flush(self) -> None:
        """Flush the stream."""
        if self.stream is not None:
            with self._user_errors():
                self.stream.flush()

    def isatty(self) -> bool:
        """Return whether the stream is a terminal, and not quiet."""
        return not self.quiet and self.stream is not None and self.stream.isatty()

    def writable(self) -> bool:
        """Return ``True``: the stream can be written."""
        return True

    def __getattr__(self, name: str) -> Any:
        """Return an attribute of the stream that is written to, if this class does not define it."""
        return getattr(self.stream, name)

    def _open_stream(self) -> TextIO:
        """Return the stream to write to; raises ``OSError`` if it was closed from the start."""
        if self.stream is None:
            raise OSError("it is closed")
        return self.stream

    @contextlib.contextmanager
    def _user_errors(self) -> Iterator[None]:
        """In a ``with`` block, raise :class:`UserError` for a failed write; with ``remarks``, ignore it.

        A ``BrokenPipeError`` is raised as it is: the reader of the output has ended.
        """
        try:
            yield
        except BrokenPipeError:
            raise
        except OSError as error:
            if not self._remarks:
                raise UserError(f"standard output: cannot be written: {error.strerror or error}") from None


@contextlib.contextmanager
def safe_streams() -> Iterator[None]:
    """In a ``with`` block, let standard output and standard error be objects of :class:`SafeStream`.

    A failed write to standard error is ignored.
    """
    out, err = sys.stdout, sys.stderr
    sys.stdout = cast(TextIO, SafeStream(out))
    sys.stderr = cast(TextIO, SafeStream(err, remarks=True))
    try:
        yield
    finally:
        sys.stdout, sys.stderr = out, err


def show_remarks(shown: bool) -> None:
    """Set whether text written to standard error from now on is shown or dropped."""
    cast(SafeStream, sys.stderr).quiet = not shown


def write_data(content: str | bytes) -> None:
    """Write data to standard output, unchanged.

    Raises :class:`UserError` for text that UTF-8 cannot hold.
    """
    from foon_asp.whole_file import utf_8

    cast(SafeStream, sys.stdout).write_data(utf_8(content) if isinstance(content, str) else content)


def write_output(output: Path | None, content: bytes) -> None:
    """Write bytes into a file, and report that on stderr.

    For ``None`` or ``-``, write them to standard output instead.
    """
    from foon_asp.whole_file import write_whole

    if output is None or str(output) == "-":
        write_data(content)
    else:
        write_whole(output, content)
        click.echo(f"wrote {output}", err=True)


def console(err: bool = False) -> "Console":
    """Return a console of rich on standard output, or with ``err`` on standard error.

    ``--quiet`` does not silence the console. The caller escapes the names that it writes.
    """
    from rich.console import Console

    target = sys.stderr if err else sys.stdout
    stream = target.stream if isinstance(target, SafeStream) else target
    return Console(file=cast(TextIO, SafeStream(stream, remarks=err, styled=True)))


def terminal_width_and_colour() -> tuple[int | None, bool]:
    """Return the width of the terminal in columns, and whether it may show colours.

    Where standard output is no terminal, they are ``None`` and ``False``. ``NO_COLOR`` in the environment
    forbids colours.
    """
    if not sys.stdout.isatty():
        return None, False
    return shutil.get_terminal_size().columns, "NO_COLOR" not in os.environ


def write_parts(blocks: Iterable[Block]) -> None:
    """Write lines and tables to standard output, in the width and the colours of the terminal.

    Signs that the output cannot encode are replaced as in :func:`with_plain_signs`.
    """
    width, coloured = terminal_width_and_colour()
    text = with_plain_signs(blocks_text(blocks, width, coloured))
    stream = sys.stdout
    if coloured and isinstance(stream, SafeStream):
        stream = cast(TextIO, SafeStream(stream.stream, styled=True))
    stream.write(text)


def write_remark(text: str) -> None:
    """Write a remark to standard error, wrapped to the width of a terminal."""
    width = shutil.get_terminal_size().columns if sys.stderr.isatty() else None
    click.echo(blocks_text(text.split("\n"), width), err=True, nl=False)


def write_remark_once(text: str) -> None:
    """Write a remark to standard error, unless the command wrote the same remark before.

    Outside of a command, the remark is always written.
    """
    context = click.get_current_context(silent=True)
    written_remarks: set[str] = (
        set() if context is None else context.find_root().meta.setdefault(_WRITTEN_ONCE, set())
    )
    if text not in written_remarks:
        written_remarks.add(text)
        write_remark(text)


def with_plain_signs(text: str) -> str:
    """Return a text with ASCII for each sign ``→ ≈ × †`` that standard output cannot encode."""
    encoding = getattr(getattr(sys.stdout, "stream", sys.stdout), "encoding", None) or "utf-8"
    return text.translate(
        {ord(sign): ascii_ for sign, ascii_ in _SIGNS.items() if encodable(sign, encoding) != sign}
    )


def flush_or_drop_output() -> None:
    """Flush standard output and error; where this fails, discard what was not written.

    Otherwise Python would try to write it at exit, and fail.
    """
    for stream in (sys.stdout, sys.stderr):
        if stream is None:
            continue
        try:
            stream.flush()
        except (OSError, UserError, ValueError):
            with contextlib.suppress(OSError, ValueError):
                os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())
