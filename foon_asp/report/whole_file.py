"""Files that are written completely or not at all."""

import contextlib
import os
import stat
from collections.abc import Iterator, Mapping
from pathlib import Path

from foon_asp.errors import UserError


def write_whole(file: Path, content: bytes) -> None:
    """Write to a file beside it and rename; the old file stays until then, and after a failure.

    A file that is replaced passes on its permissions, and one that is write-protected is not replaced; a link
    stays, and the file that it names is written. A pipe or device is written to as it is. Raises
    :class:`UserError` when it cannot be written.
    """
    try:
        if file.exists() and not file.is_file():
            file.write_bytes(content)
            return
        target = Path(os.path.realpath(file))
        if target.is_symlink():  # a ring of links
            target.stat()
        _replace(target, content)
    except OSError as error:
        raise UserError(f"{file}: cannot be written: {error.strerror or error}") from None


def write_all_whole(contents: Mapping[Path, bytes]) -> None:
    """Replace several files, all of them or none: all is written beside them before the first is replaced.

    Raises :class:`UserError` when one of them cannot be written; all of them are then as they were.
    """
    replaced: dict[Path, bytes] = {}
    try:
        with contextlib.ExitStack() as stack:
            staged = []
            for file, content in contents.items():
                target = Path(os.path.realpath(file))
                staged.append((target, stack.enter_context(_staged(target, content))))
            for target, partial in staged:
                before = target.read_bytes()
                partial.replace(target)
                replaced[target] = before
    except OSError as error:
        for target, before in replaced.items():
            _replace(target, before)
        name = os.fsdecode(error.filename) if error.filename else file
        raise UserError(f"{name}: cannot be written: {error.strerror or error}; no file is changed") from None


def utf_8(text: str) -> bytes:
    """Give the bytes of a text; raises :class:`UserError` for half a character, which has none."""
    try:
        return text.encode()
    except UnicodeEncodeError as error:
        line = text.count("\n", 0, error.start) + 1
        found = ascii(text[error.start])
        raise UserError(
            f"line {line} of what would be written has {found}, half a character, which UTF-8 cannot hold: "
            "correct the name that contains it"
        ) from None


def _replace(target: Path, content: bytes) -> None:
    with _staged(target, content) as partial:
        partial.replace(target)


@contextlib.contextmanager
def _staged(target: Path, content: bytes) -> Iterator[Path]:
    """Write beside a file what will replace it, if it may be replaced; if it has not, it is removed."""
    # A name that nobody has: no other file of the user's is written over on the way.
    partial = target.with_name(f".foon-asp.{os.urandom(8).hex()}")
    mode = None
    if target.exists():
        with target.open("ab"):  # may it be written? Renaming asks the folder alone
            mode = stat.S_IMODE(target.stat().st_mode)
    try:
        with partial.open("xb") as written:
            written.write(content)
            written.flush()
            os.fsync(written.fileno())
        if mode is not None:
            partial.chmod(mode)
        yield partial
    finally:
        partial.unlink(missing_ok=True)
