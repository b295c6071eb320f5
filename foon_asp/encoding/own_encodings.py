"""Recognition of unchanged built-in encodings, which cuts and certificates rely on.

``encodings/SHA256SUMS`` has the digest of each built-in encoding, with the line ends of Unix. A built-in
encoding that the user changed still runs, but counts as an encoding of the user.
"""

import hashlib
from functools import cache, lru_cache
from pathlib import Path

from foon_asp.errors import UserError
from foon_asp.resources import encodings_folder

ENCODING_FILES = ("task_tree.lp", "objectives.lp", "show.lp")
USED_UP = "used_up"
"""The folder of the encodings of plans in which items are used up."""
_DIGESTS = "SHA256SUMS"


def is_own(file: Path) -> bool:
    """Whether a file is an unchanged built-in encoding or ready-made constraint."""
    digests = _digests()
    expected = digests.get(file) or digests.get(file.resolve())
    return expected is not None and expected == digest(file)


def question_encoding(name: str) -> Path:
    """Return the path of a built-in encoding that a question needs, such as ``soft.lp``.

    Users cannot replace it. Raises :class:`UserError` if it was changed.
    """
    return _require_unchanged(encodings_folder() / "questions" / name)


def exact_success() -> Path:
    """Return the path of the encoding that compares products of rates.

    Raises :class:`UserError` if it was changed.
    """
    return _require_unchanged(encodings_folder() / "exact_success.lp")


def digest(file: Path) -> str:
    """Return the SHA-256 digest of a text file in hexadecimal, as if it had the line ends of Unix.

    It is cached until the file changes.
    """
    state = file.stat()
    return _digest(file, state.st_ino, state.st_size, state.st_mtime_ns, state.st_ctime_ns)


@lru_cache(maxsize=100)
def _digest(file: Path, *_state: int) -> str:
    """Return the SHA-256 digest of a file in hexadecimal, with line ends changed to those of Unix.

    ``_state`` is only part of the key of the cache.
    """
    return hashlib.sha256(file.read_bytes().replace(b"\r\n", b"\n")).hexdigest()


def _require_unchanged(file: Path) -> Path:
    """Return the path of a built-in encoding; raises :class:`UserError` if it was changed."""
    if not is_own(file):
        raise UserError(
            f"{file} was changed, but answers rely on its old content: restore it; to change what a tree is "
            "or what is best, add a constraint (--constraint) or replace encodings (--encodings)"
        )
    return file


@cache
def _digests() -> dict[Path, str]:
    """Return the digests in ``SHA256SUMS``, by path; they are cached."""
    folder = encodings_folder().resolve()
    lines = (folder / _DIGESTS).read_text(encoding="ascii").splitlines()
    return {folder / name: sha for sha, name in (line.split("  ", 1) for line in lines)}
