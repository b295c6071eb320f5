"""Files that are written completely or not at all."""

import contextlib
import functools
import os
import re
import stat
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import BinaryIO

from foon_asp.errors import UserError
from foon_asp.file_permissions import copy_permissions, warn_of_replaced

try:
    import fcntl
except ImportError:  # Windows has no such locks, so what a kill left there stays
    fcntl = None  # type: ignore[assignment]

_PARTIAL = re.compile(r"\.foon-asp\.[0-9a-f]{16}")


def write_whole(file: Path, content: bytes) -> None:
    """Make a file or replace its content, completely or not at all: after a failure, the file is unchanged.

    A new file is written beside the old one and renamed. It gets the permissions of the old one, and its
    owner where that is allowed. If the path is a symbolic link, the linked file is replaced. A pipe or device
    is written to directly.

    Warns if the file has other names (hard links), which keep the old content, or if its owner changes.
    Raises :class:`UserError` where the file cannot be written, for example if it is write-protected.
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
    """Replace the contents of several files, which all have to exist; if one cannot be written, none changes.

    All new files are written beside the old ones before the first is renamed. After an error or ctrl-C, all
    files have their old content. If the process is killed in the middle, each file has its old or its new
    content. Warns as :func:`write_whole` does. Raises :class:`UserError` where a file cannot be written.
    """
    old_contents: dict[Path, bytes] = {}
    try:
        with contextlib.ExitStack() as stack:
            staged_files = []
            for file, content in contents.items():
                target = Path(os.path.realpath(file))
                staged_files.append((target, stack.enter_context(_staged_file(target, content))))
            for target, partial_path in staged_files:
                old_content = target.read_bytes()
                old_contents[target] = old_content
                partial_path.replace(target)
    except BaseException as error:
        for target, old_content in old_contents.items():
            if target.read_bytes() != old_content:
                _replace(target, old_content)
        if not isinstance(error, OSError):
            raise
        name = os.fsdecode(error.filename) if error.filename else file
        raise UserError(f"{name}: cannot be written: {error.strerror or error}; no file is changed") from None


def utf_8(text: str) -> bytes:
    """Return the bytes of a text in UTF-8.

    Raises :class:`UserError`, with the line, for half of a surrogate pair, which UTF-8 cannot hold.
    """
    try:
        return text.encode()
    except UnicodeEncodeError as error:
        line = text.count("\n", 0, error.start) + 1
        half_character = ascii(text[error.start])
        raise UserError(
            f"line {line} of what would be written has {half_character}, half a character, which UTF-8 "
            "cannot hold: correct the name that contains it"
        ) from None


def _replace(target: Path, content: bytes) -> None:
    """Replace a file by a new one, which is written beside it and renamed."""
    with _staged_file(target, content) as partial_path:
        partial_path.replace(target)


@contextlib.contextmanager
def _staged_file(target: Path, content: bytes) -> Iterator[Path]:
    """Return a context with the path of a new file beside the target; the caller renames it to the target.

    The new file has the given content and the permissions of the target. At first, temporary files of killed
    processes are removed from the folder. At the end, the new file is removed if it was not renamed. A
    warning is issued if the replaced target had other names or another owner. Raises :class:`OSError` for a
    target that may not be written.
    """
    old_status = None
    if target.exists():
        with target.open("ab"):  # may it be written? Renaming asks the folder alone
            old_status = target.stat()
    _remove_leftovers(target.parent)
    partial_path, partial_file = _create_locked_file(target.parent)
    try:
        with partial_file:
            partial_file.write(content)
            partial_file.flush()
            os.fsync(partial_file.fileno())
            if old_status is not None:
                copy_permissions(old_status, partial_path)
            # Windows renames no open file; and a process may have 1,024 open, and rename writes many
            if fcntl is None or partial_file.fileno() > 500:
                partial_file.close()
            yield partial_path
        if old_status is not None:
            warn_of_replaced(target, old_status)
    finally:
        partial_path.unlink(missing_ok=True)


def _create_locked_file(folder: Path) -> tuple[Path, BinaryIO]:
    """Return the path of a new file with an unused name, and the open file.

    The file is locked until it is closed, where files can be locked.
    """
    while True:
        partial_path = folder / f".foon-asp.{os.urandom(8).hex()}"
        partial_file = partial_path.open("xb")
        if _try_lock(partial_file.fileno(), otherwise=True) and partial_path.exists():
            return partial_path, partial_file
        partial_file.close()  # before the lock, another process took the file for a leftover


@functools.cache  # once for each folder: fmt writes many files
def _remove_leftovers(folder: Path) -> None:
    """Remove the temporary files of killed processes from a folder: no process has them locked.

    A second call with the same folder does nothing. Errors are ignored.
    """
    with contextlib.suppress(OSError):
        for name in filter(_PARTIAL.fullmatch, os.listdir(folder)):
            with contextlib.suppress(OSError):
                _remove_unlocked(folder / name)


def _remove_unlocked(file: Path) -> None:
    """Remove a temporary file, unless another process is writing it and so has locked it.

    If files cannot be locked, or if the path is no regular file, nothing is removed.
    """
    descriptor = os.open(file, os.O_RDONLY | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0))
    try:
        if stat.S_ISREG(os.fstat(descriptor).st_mode) and _try_lock(descriptor, otherwise=False):
            file.unlink()
    finally:
        os.close(descriptor)


def _try_lock(descriptor: int, otherwise: bool) -> bool:
    """Lock an open file, given by its descriptor, and return whether this succeeded.

    Return ``False`` if another process has locked the file. Return ``otherwise`` where files cannot be
    locked.
    """
    if fcntl is None:
        return otherwise
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except OSError:
        return otherwise
    return True
