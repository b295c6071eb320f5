"""Offers, which are entry points of installed packages, and errors about them; no package is imported."""

import re
from collections.abc import Iterable
from typing import NamedTuple

from foon_asp.errors import UserError
from foon_asp.escapes import escaped

_OFFER_NAME = re.compile(r"[A-Za-z0-9](?:[A-Za-z0-9_.-]{0,38}[A-Za-z0-9])?", re.ASCII)


class Raised(NamedTuple):
    """An exception that a function of another package raised.

    ``classes`` are the names of its class and base classes, the most specific first, each with its module.
    ``message`` is cut off where it is long. ``raised_at`` is the file and line that raised the exception, or
    empty. ``trace`` is the traceback.
    """

    classes: tuple[str, ...]
    message: str
    raised_at: str
    trace: str

    @property
    def text(self) -> str:
        """The exception in one line, without the modules: ``raised ValueError: no tree (file.py:7)``."""
        name = self.classes[0].rpartition(".")[2]
        message = f": {self.message}" if self.message else ""
        return f"raised {name}{message}{self.raised_at and f' ({self.raised_at})'}"


class Offer(NamedTuple):
    """An entry point of an installed package, by which the package offers a function.

    ``group`` and ``name`` are those of the entry point. ``function`` is written ``module:function``.
    ``package`` is the name of the package with its version.
    """

    group: str
    name: str
    function: str
    package: str

    def fault(self, complaint: str, trace: str = "") -> UserError:
        """Return an error that names the offer and says what its package did wrong.

        The error has the first 300 letters of ``complaint``. With ``--debug``, users see the traceback
        ``trace``, too.
        """
        if len(complaint) > 300:  # a package may say any amount
            complaint = f"{complaint[:300]}..."
        error = UserError(
            f"{escaped(self.package)}: {escaped(self.name)} ({self.group}, {escaped(self.function)}): "
            f"{escaped(complaint)}\n"
            "what to do: tell the authors of the package, name others, or uninstall it"
        )
        if trace:
            error.add_note(trace)
        return error

    def raised_error(self, exception: Raised) -> UserError:
        """Return an error that says that the function of the offer raised an exception.

        For a :class:`UserError`, the text has its message alone. For any other exception, the text also has
        its class and its place.
        """
        is_user_error = f"{UserError.__module__}.{UserError.__name__}" in exception.classes
        return self.fault(exception.message if is_user_error else exception.text, exception.trace)

    def tree_of_reply(self, reply: object, unit_count: int) -> tuple[int, ...]:
        """Return a reply of the function as a tuple; it has to be a list of unit ids.

        Raises :class:`UserError` for anything but a list of different numbers from 0 to ``unit_count`` - 1.
        """
        if not isinstance(reply, list):
            raise self.fault(f"gave {reply!r}, expected the units of a tree")
        for unit in reply:
            if type(unit) is not int or not 0 <= unit < unit_count:
                raise self.fault(f"gave a tree with the unit {unit!r}; units are 0 to {unit_count - 1}")
        if len(set(reply)) < len(reply):
            raise self.fault("gave a tree that lists a unit twice")
        return tuple(reply)


def find_offers(group: str) -> list[Offer]:
    """Return the offers of installed packages in a group, sorted by package and name; none is imported.

    Of a package that is installed twice, only the first installation on Python's path counts. Raises
    :class:`UserError` if a package mentions the group but its entry points cannot be read.
    """
    from importlib import metadata  # noqa: PLC0415 (slow to import, and seldom needed)

    by_package: dict[str, list[Offer]] = {}
    for distribution in metadata.distributions():
        try:
            text = distribution.read_text("entry_points.txt")
        except UnicodeDecodeError as error:
            text = error.object.decode(errors="replace")  # to see whether it mentions the group
        if not text or group not in text:
            continue
        try:
            package, version = distribution.metadata["Name"], distribution.metadata["Version"]
            entry_points = distribution.entry_points.select(group=group)
            offers = [Offer(group, point.name, point.value, f"{package} {version}") for point in entry_points]
        except Exception as error:
            raise UserError(
                f"a package offers {group} and cannot be read: "
                f"{escaped(str(distribution.locate_file('.')))}: {escaped(text.strip())}: {error}"
            ) from None
        by_package.setdefault(str(package).lower().replace("_", "-"), offers)
    return [offer for package in sorted(by_package) for offer in sorted(by_package[package])]


def offers_by_name(offers: Iterable[Offer], reserved: Iterable[str]) -> dict[str, Offer]:
    """Return offers by name.

    Raises :class:`UserError` for a name that two offers have or that is ``reserved``; case is ignored. A name
    has to consist of at most 40 ASCII letters and digits, with ``-``, ``_`` and ``.`` between them. Raises
    :class:`UserError` for any other name.
    """
    owners = {name.lower(): "foon-asp" for name in reserved}
    by_name: dict[str, Offer] = {}
    for offer in offers:
        if not _OFFER_NAME.fullmatch(offer.name):
            raise offer.fault("expected a name of up to 40 letters and digits, with - _ . between them")
        if offer.name.lower() in owners:
            raise offer.fault(f"the name is taken: {owners[offer.name.lower()]} has one that is called so")
        owners[offer.name.lower()] = offer.package
        by_name[offer.name] = offer
    return by_name
