"""Where the nodes of a large graph go: they push each other away, and arrows pull their ends together.

The picture of a universal FOON in the literature is laid out like this. All nodes push all others: their mass
is laid on a grid, and convolved with the force of a mass by Fourier transforms. Where many arrows meet, as at
a knife, each pulls little, or it would tie everything together. The same graph gives the same places, as long
as numpy is the same.
"""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from foon_asp.deadline import uninterrupted

if TYPE_CHECKING:
    import numpy
    from numpy.typing import NDArray

    Floats = NDArray[numpy.float64]

_FEWEST, _MOST = 32, 128  # cells along a side of the grid: four for each node, within these
_ROUNDS = 100
_PULL = 12.0
_MIDDLE = 0.5  # how much everything is drawn to the middle
_LENGTH = 1.2  # up to which an arrow does not pull
_STEP = 4.0  # the longest move, at the beginning
_GAP = 0.5  # between neighbours, in the end
_PARTINGS = 25
SCALE = 20  # places for a length of 1


def spread(nodes: int, arrows: Sequence[tuple[int, int]], order: Sequence[int]) -> list[tuple[int, int]]:
    """Give each node a place, x and y from 0.

    ``order`` lists nodes of which neighbours belong together, such as the units of a file; all others start
    where those are that have arrows with them.
    """
    with uninterrupted():
        import numpy as np  # noqa: PLC0415 - slow to import

    if not nodes:
        return []
    tails, heads = np.array(arrows, dtype=np.int64).reshape(-1, 2).T
    degree = np.maximum(1, np.bincount(tails, minlength=nodes) + np.bincount(heads, minlength=nodes))
    weight = _PULL / np.maximum(degree[tails], degree[heads]) ** 0.8
    stiff = 1 + np.bincount(tails, weight, nodes) + np.bincount(heads, weight, nodes)
    push = _Push(nodes)
    at = _start(nodes, tails, heads, order)
    for number in range(_ROUNDS):
        force = push(at) - _MIDDLE * at
        apart = at[heads] - at[tails]
        length = np.sqrt((apart * apart).sum(1)) + 1e-9
        pull = apart * (weight * np.maximum(0, length - _LENGTH) / length)[:, None]
        for axis in (0, 1):
            force[:, axis] += np.bincount(tails, pull[:, axis], nodes)
            force[:, axis] -= np.bincount(heads, pull[:, axis], nodes)
        move = force / stiff[:, None]
        far = np.sqrt((move * move).sum(1)) + 1e-9
        most = _STEP * (1 - number / _ROUNDS) + 0.05
        at += move * (np.minimum(far / 2, most) / far)[:, None]
    for _ in range(_PARTINGS):
        _part(at)
    placed = np.rint((at - at.min(0)) * SCALE).astype(np.int64)
    return [(int(x), int(y)) for x, y in placed]


def _part(at: "Floats") -> None:
    """Move nodes apart that are nearer to each other than the gap, each by half of what is missing."""
    import numpy as np  # noqa: PLC0415

    cells = np.floor((at - at.min(0)) / _GAP).astype(np.int64)
    across = int(cells[:, 1].max()) + 3
    key = cells[:, 0] * across + cells[:, 1]
    order = np.argsort(key, kind="stable")
    ordered = key[order]
    for beside in (0, 1, across - 1, across, across + 1):  # the cells around, each pair of cells once
        first = np.searchsorted(ordered, key + beside, "left")
        count = np.searchsorted(ordered, key + beside, "right") - first
        one = np.repeat(np.arange(len(at)), count)
        behind = np.arange(len(one)) - np.repeat(np.cumsum(count) - count, count)
        other = order[np.repeat(first, count) + behind]
        if not beside:
            one, other = one[one < other], other[one < other]
        away = at[other] - at[one]
        far = np.sqrt((away * away).sum(1))
        away[far == 0] = np.stack([np.cos(one * 2.4), np.sin(one * 2.4)], 1)[far == 0]
        share = np.where(far < _GAP, (_GAP - far) / 2 / np.where(far == 0, 1, far), 0)[:, None] * away
        for axis in (0, 1):
            at[:, axis] += np.bincount(other, share[:, axis], len(at))
            at[:, axis] -= np.bincount(one, share[:, axis], len(at))


class _Push:
    """How much each node is pushed by all others."""

    def __init__(self, nodes: int) -> None:
        import numpy as np  # noqa: PLC0415

        self._side = _FEWEST
        while self._side < _MOST and self._side**2 < 4 * nodes:
            self._side *= 2
        away = np.fft.fftfreq(2 * self._side, 1 / (2 * self._side))
        x, y = np.meshgrid(away, away, indexing="ij")
        square = x * x + y * y
        square[0, 0] = 1
        self._kernels = [np.fft.rfft2(x / square), np.fft.rfft2(y / square)]

    def __call__(self, at: "Floats") -> "Floats":
        import numpy as np  # noqa: PLC0415

        side = self._side
        low = at.min(0)
        cell = (at.max(0) - low).max() * 1.0001 / (side - 1) + 1e-9
        place = (at - low) / cell
        corner = np.minimum(place.astype(np.int64), side - 2)
        (x, y), (right, up) = corner.T, (place - corner).T
        shares = [((1 - right) * (1 - up), 0, 0), (right * (1 - up), 1, 0), ((1 - right) * up, 0, 1)]
        shares.append((right * up, 1, 1))
        spots = [(share, (x + dx) * side + y + dy) for share, dx, dy in shares]
        mass = np.zeros(side * side)
        for share, spot in spots:
            mass += np.bincount(spot, share, side * side)
        waves = np.fft.rfft2(mass.reshape(side, side), (2 * side, 2 * side))
        force = np.zeros_like(at)
        for axis, kernel in enumerate(self._kernels):
            field = np.fft.irfft2(waves * kernel, (2 * side, 2 * side))[:side, :side].ravel() / cell
            for share, spot in spots:
                force[:, axis] += field[spot] * share
        return force


def _start(
    nodes: int, tails: "NDArray[numpy.int64]", heads: "NDArray[numpy.int64]", order: Sequence[int]
) -> "Floats":
    """Lay what is ordered along a curve on which neighbours stay neighbours, and the others beside it."""
    import numpy as np  # noqa: PLC0415

    depth = 1
    while 4**depth < len(order):
        depth += 1
    at = np.zeros((nodes, 2))
    for position, node in enumerate(order):
        at[node] = _on_curve(position * 4**depth // len(order), depth)
    ordered = np.zeros(nodes, dtype=bool)
    ordered[list(order)] = True
    count = np.zeros(nodes)
    total = np.zeros((nodes, 2))
    for one, other in ((tails, heads), (heads, tails)):
        known = ordered[other] & ~ordered[one]
        count += np.bincount(one[known], minlength=nodes)
        for axis in (0, 1):
            total[:, axis] += np.bincount(one[known], at[other[known], axis], nodes)
    at[~ordered] = (total / np.maximum(1, count)[:, None])[~ordered]
    turn = np.arange(nodes) * 2.4  # no two of them at the same place
    beside = np.stack([np.cos(turn), np.sin(turn)], 1) * 0.7
    at[~ordered] += beside[~ordered]
    moved: Floats = (at - at.mean(0)) * 1.6
    return moved


def _on_curve(place: int, depth: int) -> tuple[int, int]:
    """Give the point at a place of Hilbert's curve."""
    x = y = 0
    for level in range(depth):
        side = 1 << level
        right = 1 & (place // 2)
        up = 1 & (place ^ right)
        if not up:
            if right:
                x, y = side - 1 - x, side - 1 - y
            x, y = y, x
        x, y = x + side * right, y + side * up
        place //= 4
    return x, y
