"""The claim that a checked certificate proves, and the statements that it takes on trust."""

from collections.abc import Mapping
from fractions import Fraction
from types import MappingProxyType
from typing import NamedTuple

from foon_asp.proof.rule_meaning import Rule


class Trusted(NamedTuple):
    """A statement taken on trust: what units cost by a measure of the user.

    ``name``: the name of the measure.
    ``rules``: the text of the rules that define the measure.
    ``sha256``: the digest of this text.
    ``costs``: the costs by unit id, as stated. That other units cost at least 0 is taken on trust, too.
    """

    name: str
    rules: str
    sha256: str
    costs: Mapping[int, Fraction]


class ItemClaims(NamedTuple):
    """The statements about consumable items that a claim about plans rests on.

    ``stock``: the copies of kitchen items, by id of the node. Other kitchen items never run out.
    ``stays``: for labels, and for nodes by id, whether they stay when used, whatever the rule says.
    ``wanted``: the number of copies wanted of a goal, by id, if it is not 1.
    """

    stock: Mapping[int, int]
    stays: Mapping[str | int, bool]
    wanted: Mapping[int, int] = MappingProxyType({})


class Verified(NamedTuple):
    """The claim that a certificate proves about the data that it was checked with.

    ``claim`` is one of three. ``optimal``: no tree is better than ``tree`` by the ``objectives``, most
    important first. ``bound``: no tree costs less than the certificate's bound. ``infeasible``: there is no
    tree.

    ``goals``: the goal nodes, by id.
    ``containers``: the container rule, ``strict`` or ``implied``.
    ``level``: the level of the network.
    ``rules``: the constraints on all trees of the claim, each with its name (``rule``) and its values.
    ``not_covered``: names of constraints that the claim does not take into account.
    ``tree``: the units by id, in an order that executes; ``None`` without a tree.
    ``costs``: the costs of the tree, one for each objective; ``None`` without a tree.
    ``cuts``: the number of cuts.
    ``trusted``: statements that the claim rests on and that are not in the data.
    ``used_up``: statements about items, if items are used up. All claims are then about plans in place of
    trees.
    """

    claim: str
    goals: tuple[int, ...]
    containers: str
    level: int
    objectives: tuple[str, ...]
    rules: tuple[Rule, ...]
    not_covered: tuple[str, ...]
    tree: tuple[int, ...] | None
    costs: tuple[int | Fraction, ...] | None
    cuts: int
    trusted: tuple[Trusted, ...] = ()
    used_up: ItemClaims | None = None
