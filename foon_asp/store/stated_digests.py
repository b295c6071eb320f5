"""The digests that certificates name, worked out while a network is imported and kept in its store.

They are those of :func:`foon_asp.proof.verify.digests`, for data without changes.
"""

from collections.abc import Iterable, Mapping
from fractions import Fraction
from hashlib import sha256
from pathlib import Path
from tempfile import TemporaryFile

from foon_asp.store.block import plain_text

_READ = 1_000_000  # bytes at a time


class StatedDigests:
    """The digests of a network and its kitchen, which come node by node and unit by unit.

    What is said of units waits in files without a name, in a ``folder``, since all nodes come before it.
    """

    def __init__(self, folder: Path) -> None:
        self._network, self._kitchen = sha256(b"[3,["), sha256(b"[")
        self._has_items = False
        # of motions, inputs, outputs
        self._of_units = [TemporaryFile(dir=folder) for _ in range(3)]  # noqa: SIM115 (closed by close)
        self._motions: list[bytes] = []  # as they are written, by their number

    def close(self) -> None:
        """Remove the files."""
        for file in self._of_units:
            file.close()

    def add_node(self, number: int, node: bytes, in_kitchen: bool) -> None:
        """Add the next node, whose parts are written as JSON."""
        self._network.update(b"," + node if number else node)
        if in_kitchen:
            self._kitchen.update(b",%d" % number if self._has_items else b"%d" % number)
            self._has_items = True

    def add_motion(self, motion: str) -> None:
        """Add a motion, which has the next number."""
        self._motions.append(b"," + plain_text(motion))

    def add_unit(self, motion: int, inputs: list[int], outputs: list[int]) -> None:
        """Add the next unit, with the number of its motion."""
        motions, *sides = self._of_units
        motions.write(self._motions[motion])
        for file, side in zip(sides, (inputs, outputs), strict=True):
            file.write(b"," + str(side).replace(" ", "").encode())

    def finished(self) -> dict[str, str]:
        """Give the digests by name."""
        for file in self._of_units:
            file.seek(1)  # no comma before the first
            self._network.update(b"],[")
            while piece := file.read(_READ):
                self._network.update(piece)
        self._network.update(b"]]")
        self._kitchen.update(b"]")
        return {"network": self._network.hexdigest(), "kitchen": self._kitchen.hexdigest()}


def price_digest(motions: Mapping[str, Fraction] | None, units: Iterable[tuple[int, str]]) -> str:
    """Give the digest of prices of motions and of units by id, in order; ``None`` where none are known."""
    if motions is None:
        return sha256(b"null").hexdigest()
    found = sha256(b"[" + plain_text(sorted([motion, str(price)] for motion, price in motions.items())))
    found.update(b",[")
    for place, price in enumerate(units):
        found.update((b"," if place else b"") + plain_text(price))
    found.update(b"]]")
    return found.hexdigest()
