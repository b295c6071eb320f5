"""Permissions and owner of a replaced file, which the new file gets."""

import contextlib
import os
import stat
from pathlib import Path

from foon_asp.escapes import escaped
from foon_asp.warning import warn


def copy_permissions(old_status: os.stat_result, file: Path) -> None:
    """Set the permissions of a file to those in ``old_status``, and its owner and group where allowed.

    If the owner may not be set, the group alone is set, where allowed.
    """
    new_status = file.stat()
    if (old_status.st_uid, old_status.st_gid) != (new_status.st_uid, new_status.st_gid):
        try:
            os.chown(file, old_status.st_uid, old_status.st_gid)
        except OSError:
            with contextlib.suppress(OSError):
                os.chown(file, -1, old_status.st_gid)
    file.chmod(stat.S_IMODE(old_status.st_mode))


def warn_of_replaced(file: Path, old_status: os.stat_result) -> None:
    """Warn if a replaced file had other names (hard links), or another owner than the new ``file`` has.

    ``old_status`` is the status of the replaced file.
    """
    name = escaped(str(file))
    if old_status.st_nlink > 1:
        others = "another name" if old_status.st_nlink == 2 else f"{old_status.st_nlink - 1} other names"
        warn(f"{name}: the file had {others} (hard links), under which the old content stays")
    if file.stat().st_uid != old_status.st_uid:
        warn(f"{name}: the file belonged to another user, and belongs to you now")
