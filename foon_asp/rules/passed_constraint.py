"""Constraints as users pass them: a file, a rule as text, or a ready-made one with constants of its own."""

import re
from os import PathLike
from pathlib import Path
from typing import NamedTuple

from foon_asp.errors import UserError
from foon_asp.resources import encodings_folder

_SUFFIX = ".lp"
_QUOTED = re.compile(r'"(?:\\.|[^"\\])*"', re.DOTALL)


class RuleText(NamedTuple):
    """Rules given as text."""

    text: str

    @property
    def name(self) -> str:
        """The name of the rules in messages, in place of a file's name."""
        return "rule"

    def __str__(self) -> str:
        """Return the rules."""
        return self.text


class LibraryUse(NamedTuple):
    """A ready-made constraint with constants of its own, as ``forbid_motion:forbidden_motion=fry``.

    ``file`` is the file of the constraint. ``written`` is the text of the option, such as the one above.
    """

    file: Path
    written: str

    @property
    def name(self) -> str:
        """The text of the option, which messages have in place of a file's name."""
        return self.written

    def __str__(self) -> str:
        """Return the text of the option."""
        return self.written

    @property
    def constants(self) -> dict[str, str]:
        """The values of the constants by name, as written; raises :class:`UserError` for wrong syntax."""
        name, _, remaining = self.written.partition(":")
        values: dict[str, str] = {}
        while True:
            constant, equals, remaining = remaining.partition("=")
            if not equals or not constant.isidentifier():
                raise UserError(
                    f"found {constant[:40]!r} in {self.written!r}, expected {name}:CONSTANT=VALUE, and more "
                    'of them after commas; a value with a comma is put in double quotes: "VALUE"'
                )
            if constant in values:
                raise UserError(f"found two values of {constant} in {self.written!r}, expected one")
            quoted = _QUOTED.match(remaining)
            end = quoted.end() if quoted else (remaining + ",").index(",")
            values[constant], separator, remaining = (
                remaining[:end],
                remaining[end : end + 1],
                remaining[end + 1 :],
            )
            if not separator:
                return values
            if separator != ",":
                raise UserError(
                    f"found {separator}{remaining[:40]} after {values[constant]} in {self.written!r}, "
                    "expected a comma"
                )


Constraint = Path | RuleText | LibraryUse
"""A path (or the name of a ready-made constraint), rules as text, or a ready-made one with constants."""


def given_constraint(constraint: str | PathLike[str] | Constraint) -> Constraint:
    """Return the constraint that a Python argument stands for.

    A text that is an existing path is this path. ``NAME:CONSTANT=VALUE`` is the use of a ready-made
    constraint. Any other text is a rule if it has ``:-`` or ends in a full stop. Otherwise it is a path, or
    the name of a ready-made constraint. Raises :class:`UserError` for an empty text.
    """
    if isinstance(constraint, RuleText | LibraryUse):
        return constraint
    if not isinstance(constraint, str):
        return Path(constraint)
    if not constraint.strip():
        raise UserError(
            "found an empty text for a constraint, expected a file, the name of a ready-made one, or a rule "
            'such as :- use(U), motion(U,"fry").'
        )
    named = named_constraint(constraint)
    if (
        isinstance(named, Path)
        and not exists(named)
        and (":-" in constraint or constraint.rstrip().endswith("."))
    ):
        return RuleText(constraint)
    return named


def named_constraint(text: str, path: type[Path] = Path) -> Path | LibraryUse:
    """Return the use of a ready-made constraint for a text ``NAME:CONSTANT=VALUE``, else the text as a path.

    An existing path is always a path. ``path`` is the class of paths that are returned.
    """
    name, colon, _ = text.partition(":")
    if colon and not exists(Path(text)):
        file = _ready_made_file(Path(name))
        if file is not None:
            return LibraryUse(file, text)
    return path(text)


def find_constraint(constraint: Constraint) -> Constraint:
    """Return a constraint; the name of a ready-made one is replaced by the path of its file.

    An existing file has precedence over a ready-made constraint. Raises :class:`UserError` if there is no
    such file and no ready-made constraint of this name.
    """
    if not isinstance(constraint, Path):
        return constraint
    if exists(constraint) and constraint.is_file():
        return constraint
    bundled = _ready_made_file(constraint)
    if bundled is not None:
        return bundled
    name = str(constraint).partition(":")[0]
    if name != str(constraint) and exists(Path(name)) and Path(name).is_file():
        raise UserError(
            f"{constraint}: constants can follow the name of a ready-made constraint only; set those of a "
            "file with -c CONSTANT=VALUE"
        )
    names = ", ".join(sorted(file.stem for file in _constraints_folder().glob(f"*{_SUFFIX}")))
    rule = "; a rule is given with --rule" if ":-" in str(constraint) else ""
    raise UserError(
        f"{constraint}: no such file; expected an encoding (.lp) or a ready-made one: {names}{rule}"
    )


def _constraints_folder() -> Path:
    """Return the folder of the ready-made constraints."""
    return encodings_folder() / "constraints"


def _ready_made_file(path: Path) -> Path | None:
    """Return the file of the ready-made constraint with this name, else ``None``.

    The ending ``.lp`` may be missing. A path with a folder is no name.
    """
    if path.name != str(path):
        return None
    file = _constraints_folder() / (path.name.removesuffix(_SUFFIX) + _SUFFIX)
    return file if exists(file) else None


def exists(path: Path) -> bool:
    """Whether a path exists; ``False`` for a text that cannot be a path."""
    try:
        return path.exists()
    except (OSError, ValueError):
        return False
