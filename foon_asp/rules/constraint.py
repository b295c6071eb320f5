"""What may be given as a constraint: a file, a rule as text, a ready-made one with constants of its own."""

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
        """What it is called, as a file is by its name."""
        return "rule"

    def __str__(self) -> str:
        return self.text


class LibraryUse(NamedTuple):
    """A ready-made constraint with constants of its own: ``file``, and how it was ``written``."""

    file: Path
    written: str

    @property
    def name(self) -> str:
        """What it is called, as a file is by its name."""
        return self.written

    def __str__(self) -> str:
        return self.written

    @property
    def constants(self) -> dict[str, str]:
        """The constants with their values as written; raises :class:`UserError` for other texts."""
        name, _, rest = self.written.partition(":")
        found: dict[str, str] = {}
        while True:
            constant, equals, rest = rest.partition("=")
            if not equals or not constant.isidentifier():
                raise UserError(
                    f"found {constant[:40]!r} in {self.written!r}, expected {name}:CONSTANT=VALUE, and more "
                    'of them after commas; a value with a comma is put in double quotes: "VALUE"'
                )
            if constant in found:
                raise UserError(f"found two values of {constant} in {self.written!r}, expected one")
            quoted = _QUOTED.match(rest)
            end = quoted.end() if quoted else (rest + ",").index(",")
            found[constant], after, rest = rest[:end], rest[end : end + 1], rest[end + 1 :]
            if not after:
                return found
            if after != ",":
                raise UserError(
                    f"found {after}{rest[:40]} after {found[constant]} in {self.written!r}, expected a comma"
                )


Constraint = Path | RuleText | LibraryUse
"""A path (or the name of a ready-made constraint), rules as text, or a ready-made one with constants."""


def given_constraint(given: str | PathLike[str] | Constraint) -> Constraint:
    """Read a constraint as Python gives it, or take one that was read.

    A text that has ``:-``, or ends in a full stop, is a rule, unless it is an existing path or the name of a
    ready-made constraint; a path is always a path. An empty text is none of these: raises
    :class:`UserError` for it.
    """
    if isinstance(given, RuleText | LibraryUse):
        return given
    if not isinstance(given, str):
        return Path(given)
    if not given.strip():
        raise UserError(
            "found an empty text for a constraint, expected a file, the name of a ready-made one, or a rule "
            'such as :- use(U), motion(U,"fry").'
        )
    named = named_constraint(given)
    if isinstance(named, Path) and not exists(named) and (":-" in given or given.rstrip().endswith(".")):
        return RuleText(given)
    return named


def named_constraint(text: str, path: type[Path] = Path) -> Path | LibraryUse:
    """Read a path, or the name of a ready-made constraint, perhaps with constants of its own."""
    name, colon, _ = text.partition(":")
    if colon and not exists(Path(text)):
        file = _bundled(Path(name))
        if file is not None:
            return LibraryUse(file, text)
    return path(text)


def find_constraint(constraint: Constraint) -> Constraint:
    """Return a constraint with the path of its file, that of a ready-made one for its name.

    Raises :class:`UserError` where there is none.
    """
    if not isinstance(constraint, Path):
        return constraint
    if exists(constraint) and constraint.is_file():
        return constraint
    bundled = _bundled(constraint)
    if bundled is not None:
        return bundled
    name = str(constraint).partition(":")[0]
    if name != str(constraint) and exists(Path(name)) and Path(name).is_file():
        raise UserError(
            f"{constraint}: constants can follow the name of a ready-made constraint only; set those of a "
            "file with -c CONSTANT=VALUE"
        )
    names = ", ".join(sorted(file.stem for file in _library().glob(f"*{_SUFFIX}")))
    rule = "; a rule is given with --rule" if ":-" in str(constraint) else ""
    raise UserError(
        f"{constraint}: no such file; expected an encoding (.lp) or a ready-made one: {names}{rule}"
    )


def _library() -> Path:
    return encodings_folder() / "constraints"


def _bundled(path: Path) -> Path | None:
    """Return the ready-made constraint of a name, with or without its suffix."""
    if path.name != str(path):
        return None
    file = _library() / (path.name.removesuffix(_SUFFIX) + _SUFFIX)
    return file if exists(file) else None


def exists(path: Path) -> bool:
    """Whether a path exists; a text that can be none does not."""
    try:
        return path.exists()
    except (OSError, ValueError):
        return False
