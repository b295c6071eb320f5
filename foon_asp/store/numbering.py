"""Numbers for distinct things, in little memory."""

from array import array
from hashlib import blake2b
from struct import Struct

_LEAST = 1024  # slots
_PARTS = Struct("QQ")


class Numbering:
    """Numbers distinct things from 0 in the order in which they come, with some thirty bytes for each.

    A thing is known by 128 bits of the BLAKE2b digest of what it is; nobody can find two with the same.
    """

    def __init__(self) -> None:
        self._slots = array("I", bytes(4 * _LEAST))  # the number plus 1, 0 where free
        self._high, self._low = array("Q"), array("Q")  # of the digests, by number

    def __len__(self) -> int:
        return len(self._low)

    def find(self, content: bytes) -> int | None:
        """Give the number of a thing by its content, ``None`` where it has none."""
        return self._place(*_digest(content))[0]

    def number(self, content: bytes) -> int:
        """Give the number of a thing, which is the next one where it is new."""
        high, low = _digest(content)
        found, slot = self._place(high, low)
        if found is not None:
            return found
        self._high.append(high)
        self._low.append(low)
        count = self._slots[slot] = len(self._low)
        if 3 * count > 2 * len(self._slots):
            self._grow()
        return count - 1

    def _place(self, high: int, low: int) -> tuple[int | None, int]:
        """Give the number of a digest, and its slot: a free one where it has no number."""
        slots, last = self._slots, len(self._slots) - 1
        slot = low & last
        while number := slots[slot]:
            if self._low[number - 1] == low and self._high[number - 1] == high:
                return number - 1, slot
            slot = (slot + 1) & last
        return None, slot

    def _grow(self) -> None:
        self._slots = slots = array("I", bytes(8 * len(self._slots)))
        last = len(slots) - 1
        for number, low in enumerate(self._low, 1):
            slot = low & last
            while slots[slot]:
                slot = (slot + 1) & last
            slots[slot] = number


def _digest(content: bytes) -> tuple[int, int]:
    high, low = _PARTS.unpack(blake2b(content, digest_size=16).digest())
    return high, low
