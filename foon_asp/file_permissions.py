"""Permissions and owner of a replaced file, which the new file gets."""

import contextlib
import os
import stat
from pathlib import Path

from foon_asp.escapes import escaped
from foon_asp.warning import warn


def copy_permissions(old: os.stat_result, file: Path) -> None:
    """Set the permissions of a file to those in ``old``, and its owner and group where this is allowed."""
    new = file.stat()
    if (old.st_uid, old.st_gid) != (new.st_uid, new.st_gid):
        try:
            os.chown(file, old.st_uid, old.st_gid)
        except OSError:
            with contextlib.suppress(OSError):
                os.chown(file, -1, old.st_gid)
    file.chmod(stat.S_IMODE(old.st_mode))


def warn_of_replaced(file: Path, old: os.stat_result) -> None:
    """Warn if a replaced file had other names (hard links), or another owner than the new file has.

    ``old`` is the status of the replaced file.
    """
    name = escaped(str(file))
    if old.st_nlink > 1:
        others = "another name" if old.st_nlink == 2 else f"{old.st_nlink - 1} other names"
        warn(f"{name}: the file had {others} (hard links), under which the old content stays")
    if file.stat().st_uid != old.st_uid:
        warn(f"{name}: the file belonged to another user, and belongs to you now")
