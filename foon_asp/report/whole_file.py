"""Files that are there whole or not at all."""

import os
import stat
from pathlib import Path

from foon_asp.errors import UserError


def write_whole(file: Path, content: bytes) -> None:
    """Write beside the file and rename; what was there before stays until then, and after a failure.

    A file that is replaced passes on its permissions; a link stays, and the file that it names is written.
    A pipe or device is written to as it is. Raises :class:`UserError` when it cannot be written.
    """
    try:
        target = Path(os.path.realpath(file))
        if target.exists() and not target.is_file():
            target.write_bytes(content)
            return
        partial = target.with_name(f".{target.name}.{os.getpid()}")
        try:
            partial.write_bytes(content)
            if target.exists():
                partial.chmod(stat.S_IMODE(target.stat().st_mode))
            partial.replace(target)
        finally:
            partial.unlink(missing_ok=True)
    except OSError as error:
        raise UserError(f"{file}: cannot be written: {error.strerror or error}") from None
