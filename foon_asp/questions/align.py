"""The nodes of a recipe compared with those of a network: known, one edit away, or new."""

from collections import Counter
from collections.abc import Iterator
from enum import StrEnum
from pathlib import Path
from typing import Annotated, ClassVar

from foon_asp.dataset import read_dataset
from foon_asp.dataset.paths import File
from foon_asp.errors import UserError
from foon_asp.foon import Foon
from foon_asp.json_layout import schema_name
from foon_asp.network import Edit, FunctionalUnit, Network, ObjectNode, StandInTable, counted
from foon_asp.questions.posing import Command, pose_data
from foon_asp.questions.question import TABLES, Kind, Option, question
from foon_asp.questions.result import ENDINGS, Result
from foon_asp.questions.stand_in import NodeEdit
from foon_asp.results.document import Unserialized
from foon_asp.results.table import Block
from foon_asp.results.values import Node, Value
from foon_asp.results.values_of import named_node, node_of
from foon_asp.standins.pair_prices import NodePrices
from foon_asp.text.data_folder import find_data
from foon_asp.text.writer import write_units

_WORD_EDITS = frozenset((Edit.WORD, Edit.SPELLING, Edit.LABEL))  # other words for the same object and place


class Match(StrEnum):
    """How a node of a recipe is found in a network."""

    IN_NETWORK = "known"
    ONE_EDIT = "one edit"
    NEW = "new"


class AlignedNode(Value, frozen=True):
    """A node of a recipe, and the nearest one of a network.

    Attributes:
        match: known: the network has the node; one edit: the network has a node that differs in one edit of
            the table of stand-ins; new: neither is so.
        node: The node of the recipe.
        nearest: The node of the network that is one edit away; null for a known or a new node.
        edit: The edit in which the two nodes differ; null for a known or a new node.
    """

    match: Match
    node: Node
    nearest: Node | None
    edit: NodeEdit | None


class Aligned(Result, frozen=True, kw_only=True, tag=schema_name("align")):
    """The nodes of a recipe compared with those of a network.

    Attributes:
        in_network: How many nodes of the recipe the network has.
        one_edit: How many nodes of the recipe are one edit away from a node of the network.
        new: How many nodes of the recipe are neither in the network nor one edit away.
        labels_known: How many labels of the recipe the network has.
        labels: How many different labels the recipe has.
        units_known: How many units of the recipe the network has.
        units: How many units the recipe has.
        nodes: The nodes, in the order of the recipe.

    Example:
        >>> aligned = foon_asp.align(foon_asp.load(), to=foon_asp.load())
        >>> aligned.in_network, aligned.one_edit, aligned.new, str(aligned.nodes[0].match)
        (418, 0, 0, 'known')
    """

    ROWS: ClassVar[str] = "nodes"
    SUFFIXES: ClassVar = {**ENDINGS, ".txt": "foon"}

    in_network: int
    one_edit: int
    new: int
    labels_known: int
    labels: int
    units_known: int
    units: int
    nodes: tuple[AlignedNode, ...]

    aligned_units = Unserialized[tuple[FunctionalUnit, ...]](())
    """The units of the recipe in the words of the network."""

    def foon(self) -> str:
        """Return the recipe as FOON text.

        A node that differs from a node of the network in a word or label only is written as the network has
        it.
        """
        return write_units(self.aligned_units, ["In the words of another network"])

    def show(self) -> Iterator[Block]:
        """Yield counts of nodes, labels and units, then nodes one edit away with their edits, then new nodes.

        The nodes one edit away are in order of the price of their edit.
        """
        yield (
            f"{counted(len(self.nodes), 'node')}: {self.in_network} known, {self.one_edit} one edit away, "
            f"{self.new} new"
        )
        yield f"labels known: {self.labels_known} of {self.labels}; units: {self.units_known} of {self.units}"
        near_nodes = sorted(
            (row for row in self.nodes if row.edit is not None),
            key=lambda row: (row.edit.price if row.edit else 0, str(row.node)),
        )
        if near_nodes:
            yield from ("", "one edit away, and what the network has:")
            for row in near_nodes:
                yield f"  {row.node}"
                yield f"    {row.nearest}: {row.edit}"
        new_nodes = [node for node in self.nodes if node.match is Match.NEW]
        if new_nodes:
            yield from ("", "new:", *(f"  {row.node}" for row in new_nodes))


def _pose_recipe(command: Command) -> tuple[Foon]:
    """Return the recipe that a command names, in a tuple, as the first argument of :func:`align`.

    Raises :class:`UserError` if the command names no recipe.
    """
    if not command.names_data:
        raise UserError("align what? name a recipe: foon-asp align RECIPE --to NETWORK")
    return pose_data(command)


@question(
    formats=(*TABLES, "foon"),
    suffixes=Aligned.SUFFIXES,
    pose=_pose_recipe,
    help_="""
    \b
    foon-asp align recipe.txt --to FOON.txt
    foon-asp align recipe.txt --to FOON.txt -o renamed.txt

    A node is known, one edit of the table of stand-ins away from a known one (docs/stand-ins.md), or new.
    With -o FILE.txt, the recipe is written in the words of the network: nodes that differ in a word are
    replaced (on for in, a label that is spelled alike or listed as similar); others stay.

    Exits with 0, whatever is new.
    """,
)
def align(
    data: Foon, *, to: Annotated[File | Foon | None, Option(kind=Kind.FILE, metavar="NETWORK")] = None
) -> Aligned:
    """Compare the nodes of a recipe with those of a network: known, one edit away, or new.

    Parameters:
        data: The recipe. Its table of stand-ins is used, or the usual table if it has none.
        to: The network whose words count, or its path.

    Returns:
        The nodes with the nearest ones of the network.

    Raises:
        UserError: for a file that cannot be read, or without a network.

    Example:
        >>> foon = foon_asp.load()
        >>> foon_asp.align(foon, to=foon).new
        0
    """
    if to is None:
        raise UserError("align with what? name a network: --to NETWORK")
    recipe = data.dataset.data.network
    target = to.dataset if isinstance(to, Foon) else read_dataset(find_data(None, [Path(to)]))
    network = target.data.network
    table = data.dataset.stand_ins or StandInTable.usual()
    prices = NodePrices(network, table)
    nearest = {node: _node_one_edit_away(node, network, table, prices) for node in recipe.objects}
    nodes = tuple(_aligned_node(node, o, recipe, network, table) for node, o in nearest.items())
    matches = Counter(node.match for node in nodes)
    labels = set(recipe.by_label)
    aligned = Aligned(
        in_network=matches[Match.IN_NETWORK],
        one_edit=matches[Match.ONE_EDIT],
        new=matches[Match.NEW],
        labels_known=len(labels & set(network.by_label)),
        labels=len(labels),
        units_known=sum(network.unit_id(unit) is not None for unit in recipe),
        units=len(recipe),
        nodes=nodes,
    )
    aligned_of = {
        node: network.objects[o] if o is not None and row.edit and row.edit.edit in _WORD_EDITS else node
        for (node, o), row in zip(nearest.items(), nodes, strict=True)
    }
    aligned_units = (
        FunctionalUnit.of(
            unit.motion, map(aligned_of.__getitem__, unit.inputs), map(aligned_of.__getitem__, unit.outputs)
        )
        for unit in recipe
    )
    return aligned.set_unserialized(aligned_units=tuple(aligned_units))


def _node_one_edit_away(
    node: ObjectNode, network: Network, table: StandInTable, prices: NodePrices
) -> int | None:
    """Return the id of the node of a network that may stand in for ``node`` by a single edit of the table.

    Of several such nodes, the one with the lowest price is returned. Return ``None`` if no node is one edit
    away, or if the network has ``node`` itself.
    """
    if network.object_id(node) is not None:
        return None
    priced = sorted((price, o) for o, price in prices.servers_of_node(node).items())
    return next((o for _, o in priced if len(table.differences(network.objects[o], node) or ()) == 1), None)


def _aligned_node(
    node: ObjectNode, nearest: int | None, recipe: Network, network: Network, table: StandInTable
) -> AlignedNode:
    """Return a node of a ``recipe`` as a value that says how the ``network`` has it.

    ``nearest`` is the id of the node of the network one edit away; ``None`` if no node is, or if the network
    has ``node`` itself.
    """
    value = named_node(recipe, node)
    if nearest is None:
        match = Match.NEW if network.object_id(node) is None else Match.IN_NETWORK
        return AlignedNode(match, value, None, None)
    (edit,) = table.differences(network.objects[nearest], node) or ()
    return AlignedNode(Match.ONE_EDIT, value, node_of(network, nearest), NodeEdit(*edit))
