"""What an installed package offers under an entry point, found without importing it."""

import re
from collections.abc import Iterable
from typing import NamedTuple

from foon_asp.errors import UserError
from foon_asp.escapes import escaped

_NAME = re.compile(r"[A-Za-z0-9](?:[A-Za-z0-9_.-]{0,38}[A-Za-z0-9])?", re.ASCII)
_LONGEST = 300  # letters of what a package says


class Raised(NamedTuple):
    """What a function of another package raised: the names of its classes, the first its own, and its words.

    ``place`` is the line that raised it, ``trace`` all that led there.
    """

    classes: tuple[str, ...]
    message: str
    place: str
    trace: str

    @property
    def text(self) -> str:
        """Say it in a line."""
        name = self.classes[0].rpartition(".")[2]
        return (
            f"raised {name}{f': {self.message}' if self.message else ''}{self.place and f' ({self.place})'}"
        )


class Offer(NamedTuple):
    """One entry point: ``group`` and ``name``, the function it names as ``module:function``, who offers it.

    ``package`` is a name with a version.
    """

    group: str
    name: str
    function: str
    package: str

    def fault(self, what: str, trace: str = "") -> UserError:
        """Make an error of what is wrong with it; ``--debug`` shows the trace."""
        if len(what) > _LONGEST:
            what = f"{what[:_LONGEST]}..."
        error = UserError(
            f"{escaped(self.package)}: {escaped(self.name)} ({self.group}, {escaped(self.function)}): "
            f"{escaped(what)}\n"
            "what to do: tell the authors of the package, name others, or uninstall it"
        )
        if trace:
            error.add_note(trace)
        return error

    def raised(self, what: Raised) -> UserError:
        """Make an error of what it raised; what it says to users in our way is said as it is."""
        by_us = f"{UserError.__module__}.{UserError.__name__}" in what.classes
        return self.fault(what.message if by_us else what.text, what.trace)

    def units(self, given: object, number: int) -> tuple[int, ...]:
        """Take the result as units of a tree, by id; the network has ``number`` units.

        Raises :class:`UserError` for anything else.
        """
        if not isinstance(given, list):
            raise self.fault(f"gave {given!r}, expected the units of a tree")
        for unit in given:
            if type(unit) is not int or not 0 <= unit < number:
                raise self.fault(f"gave a tree with the unit {unit!r}; units are 0 to {number - 1}")
        if len(set(given)) < len(given):
            raise self.fault("gave a tree that lists a unit twice")
        return tuple(given)


def find_offers(group: str) -> list[Offer]:
    """List what installed packages offer under a group, by package and name; nothing of theirs is imported.

    Of a package that is there twice, the one that Python would import counts. Raises :class:`UserError` where
    what a package says of the group cannot be read.
    """
    from importlib import metadata  # noqa: PLC0415 (slow to import, and seldom needed)

    found: dict[str, list[Offer]] = {}
    for distribution in metadata.distributions():
        try:
            text = distribution.read_text("entry_points.txt")
        except UnicodeDecodeError as error:
            text = error.object.decode(errors="replace")  # to see whether it is any matter of ours
        if not text or group not in text:
            continue
        try:
            package, version = distribution.metadata["Name"], distribution.metadata["Version"]
            points = distribution.entry_points.select(group=group)
            offers = [Offer(group, point.name, point.value, f"{package} {version}") for point in points]
        except Exception as error:
            raise UserError(
                f"a package offers {group} and cannot be read: "
                f"{escaped(str(distribution.locate_file('.')))}: {escaped(text.strip())}: {error}"
            ) from None
        found.setdefault(str(package).lower().replace("_", "-"), offers)
    return [offer for package in sorted(found) for offer in sorted(found[package])]


def offers_by_name(offers: Iterable[Offer], taken: Iterable[str]) -> dict[str, Offer]:
    """Give offers by name.

    Raises :class:`UserError` for a name that two of them have, or that is among those ``taken``, in whatever
    case it is written; and for one that is not made of letters, digits, ``-``, ``_`` and ``.``.
    """
    known = {name.lower(): "foon-asp" for name in taken}
    named: dict[str, Offer] = {}
    for offer in offers:
        if not _NAME.fullmatch(offer.name):
            raise offer.fault("expected a name of up to 40 letters and digits, with - _ . between them")
        if offer.name.lower() in known:
            raise offer.fault(f"the name is taken: {known[offer.name.lower()]} has one that is called so")
        known[offer.name.lower()] = offer.package
        named[offer.name] = offer
    return named
