"""Which encodings are unchanged built-in ones: cuts and certificates rely on them.

``encodings/SHA256SUMS`` holds the digest of each, with the line ends of Unix. One of ours that was changed in
place is what runs, but it is then treated like a user's: what it says may be something else.
"""

import hashlib
from functools import cache
from pathlib import Path

from foon_asp.errors import UserError
from foon_asp.resources import encodings_folder

ENCODING_FILES = ("task_tree.lp", "objectives.lp", "show.lp")
USED_UP = "used_up"
"""The folder of the encodings of plans in which items are used up."""
_DIGESTS = "SHA256SUMS"


def is_own(file: Path) -> bool:
    """Whether an encoding is an unchanged built-in one."""
    digests = _digests()
    known = digests.get(file) or digests.get(file.resolve())
    return known is not None and known == digest(file)


def question_encoding(name: str) -> Path:
    """Return a built-in encoding that a question needs and that cannot be replaced, such as ``soft.lp``.

    Raises :class:`UserError` where it was changed.
    """
    return _unchanged(encodings_folder() / "questions" / name)


def exact_success() -> Path:
    """Return the encoding that settles products of rates. Raises :class:`UserError` where it was changed."""
    return _unchanged(encodings_folder() / "exact_success.lp")


def digest(file: Path) -> str:
    """Return the SHA-256 of a text with the line ends of Unix."""
    return hashlib.sha256(file.read_bytes().replace(b"\r\n", b"\n")).hexdigest()


def _unchanged(file: Path) -> Path:
    if not is_own(file):
        raise UserError(
            f"{file} was changed, but answers rely on its old content: restore it; to change what a tree is "
            "or what is best, add a constraint (--constraint) or replace encodings (--encodings)"
        )
    return file


@cache
def _digests() -> dict[Path, str]:
    folder = encodings_folder().resolve()
    lines = (folder / _DIGESTS).read_text(encoding="ascii").splitlines()
    return {folder / name: sha for sha, name in (line.split("  ", 1) for line in lines)}
