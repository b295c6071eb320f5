"""Files that are there whole or not at all."""

import os
from pathlib import Path

from foon_asp.errors import UserError


def write_whole(file: Path, content: bytes) -> None:
    """Write beside the file and rename; what was there before stays until then, and after a failure.

    Raises :class:`UserError` when it cannot be written.
    """
    partial = file.with_name(f".{file.name}.{os.getpid()}")
    try:
        try:
            partial.write_bytes(content)
            partial.replace(file)
        finally:
            partial.unlink(missing_ok=True)
    except OSError as error:
        raise UserError(f"{file}: cannot be written: {error.strerror or error}") from None
