"""The nodes of a proof that no derivation costs less than a total."""

from collections.abc import Iterator
from typing import NamedTuple

from foon_asp.hypergraph.cut import Cut
from foon_asp.hypergraph.lexicographic import Vector


class Packing(NamedTuple):
    """A cost partition over cuts, which proves a lower bound on the cost of derivations.

    The bound is the sum of the weights and of the costs of the used actions. For each limit, a product is
    subtracted: the weight of the limit times the amount that the used actions leave of it.

    ``weights``: pairs of a cut and its weight.
    ``limits``: pairs of the index of a limit and its weight.
    ``rounded``: the index of the coordinate at which the bound is rounded up; ``None`` without rounding.
    """

    weights: tuple[tuple[Cut, Vector], ...]
    limits: tuple[tuple[int, Vector], ...] = ()
    rounded: int | None = None


class Hopeless(NamedTuple):
    """A cut with an empty landmark: under the branches taken, no derivation reaches the targets."""

    cut: Cut


class Broken(NamedTuple):
    """The end of a branch: every derivation with the used actions breaks the rule of this number."""

    rule: int


class Branch(NamedTuple):
    """A proof for all derivations without an action, and a proof for all derivations with it."""

    action: int
    without: "Proof"
    using: "Proof"


class CostFixing(NamedTuple):
    """Reduced-cost fixing: a proof for derivations with one of the ``actions``, and one for all others.

    ``packing`` proves a lower bound for derivations with an action in ``actions``: its bound plus the
    action's reduced cost. ``others`` is the proof for derivations without any action in ``actions``.
    """

    actions: tuple[int, ...]
    packing: Packing
    others: "Proof"


Proof = Packing | Hopeless | Broken | Branch | CostFixing
# A branching tree: an action, the cases without it and the cases with it.
Cases = tuple[int, "Cases", "Cases"] | None


def cuts_of(proof: Proof) -> Iterator[Cut]:
    """Yield the cuts of a proof, in all of its branches; a cut may be yielded more than once.

    The end of a branch that breaks a rule has no cut.
    """
    waiting = [proof]
    while waiting:
        step = waiting.pop()
        if isinstance(step, Branch):
            waiting += [step.without, step.using]
        elif isinstance(step, CostFixing):
            waiting += [step.packing, step.others]
        elif isinstance(step, Hopeless):
            yield step.cut
        elif isinstance(step, Packing):
            yield from (cut for cut, _ in step.weights)
