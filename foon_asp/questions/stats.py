"""What is in a network: counts at each level of detail, or its functional units one by one."""

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Literal, Unpack

from msgspec import UNSET, UnsetType

from foon_asp.dataset import Dataset
from foon_asp.dataset.item_options import Stays, items_of
from foon_asp.dataset.level_counts import statistics_by_level
from foon_asp.dataset.paths import File
from foon_asp.escapes import escaped
from foon_asp.foon import Foon, load
from foon_asp.json_layout import schema_name
from foon_asp.network import Network, counted, starting_kitchen
from foon_asp.network.statistics import MANY, Statistics, most_connected_labels, most_connected_objects
from foon_asp.problem import DEFAULT_RULE, ContainerRule, UsedUp, container_rule, needed_inputs
from foon_asp.questions.options import CONTAINERS, ITEMS
from foon_asp.questions.posing import pose_data
from foon_asp.questions.python_options import Limits, start_deadline
from foon_asp.questions.question import TABLES, Kind, Option, Role, question
from foon_asp.questions.result import Result
from foon_asp.results.table import Block, Table
from foon_asp.results.values import Node, Unit, Value, step_lines
from foon_asp.results.values_of import node_as, node_of, nodes_of, unit_of
from foon_asp.text.data_folder import Data

# Heading, row name, and the figure of one level.
_ROWS: tuple[tuple[str, str, Callable[[Statistics], object]], ...] = (
    ("", "functional units", lambda s: s.units),
    ("", "object nodes", lambda s: s.objects),
    ("", "labels", lambda s: s.labels),
    ("", "motions", lambda s: s.motions),
    ("", "states", lambda s: s.states),
    ("", "relations, as in [bowl]", lambda s: s.relations),
    ("", "contents, as contains {salt}", lambda s: s.contents),
    ("units", "inputs, mean", lambda s: f"{s.mean_inputs:.2f}"),
    ("units", "inputs, most", lambda s: s.most_inputs),
    ("units", "outputs, mean", lambda s: f"{s.mean_outputs:.2f}"),
    ("units", "outputs, most", lambda s: s.most_outputs),
    ("units", "whose outputs are their inputs", lambda s: s.unchanged),
    ("object nodes", "that no unit makes", lambda s: s.producers[0]),
    *(
        ("object nodes", f"made by {n} unit{'s' * (n > 1)}", lambda s, n=n: s.producers[n])
        for n in range(1, MANY)
    ),
    ("object nodes", f"made by {MANY} or more", lambda s: s.producers[MANY]),
    ("object nodes", "most producers of one", lambda s: s.most_producers),
    ("object nodes", "that no unit needs", lambda s: s.unused),
    ("graph", "cycles (sets of nodes that need each other)", lambda s: s.cycles),
    ("graph", "nodes in cycles", lambda s: s.in_cycles),
    ("graph", "nodes in the largest", lambda s: s.largest_cycle),
    ("graph", "parts that share no node", lambda s: s.parts),
    ("graph", "units in the largest", lambda s: s.largest_part),
    ("reach", "nodes in the kitchen", lambda s: s.at_hand),
    ("reach", "depth, most", lambda s: s.depth),
    ("reach", "depth, median over units", lambda s: f"{s.median_depth:g}"),
    ("reach", "nodes out of reach", lambda s: s.unreached_objects),
    ("reach", "units out of reach", lambda s: s.unreached_units),
)


class FileUnits(Value, frozen=True):
    """How many units were read from a file, copies included."""

    file: str
    units: int


class StartingNodes(Value, frozen=True):
    """The object nodes assumed to be available without a kitchen, at level 3.

    Attributes:
        files: How many files of recipes there are.
        not_made: The nodes that no unit makes from other nodes.
        made_too: The nodes that a unit makes, and that the units of some file need at the beginning.
    """

    files: int
    not_made: tuple[Node, ...]
    made_too: tuple[Node, ...]


class LabelUnits(Value, frozen=True):
    """How many units have a label among their inputs or outputs."""

    label: str
    units: int


class ObjectUnits(Value, frozen=True):
    """How many units need an object node, and how many make it."""

    object: Node
    needed_by: int
    made_by: int


class Stats(Result, frozen=True, kw_only=True, tag=schema_name("stats")):
    """The size of a network at each level.

    Attributes:
        units_read: How many units were read, copies included.
        copies: How many of them equal a unit that was read before.
        files: The files that they were read from.
        videos: The addresses of the annotated videos.
        reached_from: The nodes from which depth and reach are counted.
        starting_kitchen: The starting kitchen; null where a kitchen was given.
        levels: The counts at the levels of detail 1 to 3; for data below level 3, only at their own level.
            ``producers`` are the numbers of nodes that 0, 1, 2, 3 and 4 or more units make.
        most_connected_labels: The ten labels that most units have.
        most_connected_objects: The ten object nodes that most units touch.

    Example:
        >>> foon_asp.stats(foon_asp.load()).levels[2].objects
        418
    """

    ROWS = "levels"

    units_read: int
    copies: int
    files: tuple[FileUnits, ...]
    videos: tuple[str, ...]
    reached_from: Literal["kitchen", "starting kitchen"]
    starting_kitchen: StartingNodes | None
    levels: tuple[Statistics, ...]
    most_connected_labels: tuple[LabelUnits, ...]
    most_connected_objects: tuple[ObjectUnits, ...]

    @classmethod
    def of(cls, data: Data) -> "Stats":
        """Return the counts of the nodes, units and labels in data.

        Parameters:
            data: A network, and the kitchen beside it if one was given.
        """
        network = data.network
        sources = [source for copies in network.sources for source in copies]
        labels, objects = (
            most_connected_labels(network, 10),
            most_connected_objects(network, 10),
        )
        return cls(
            units_read=len(sources),
            copies=len(sources) - len(network),
            files=tuple(FileUnits(*pair) for pair in Counter(source.file for source in sources).items()),
            videos=tuple(dict.fromkeys(video for source in sources for video in source.videos)),
            reached_from="starting kitchen" if data.starting else "kitchen",
            starting_kitchen=_starting_nodes(network) if data.starting else None,
            levels=tuple(statistics_by_level(data)),
            most_connected_labels=tuple(LabelUnits(*pair) for pair in labels),
            most_connected_objects=tuple(
                ObjectUnits(node_of(network, o), *numbers) for o, *numbers in objects
            ),
        )

    def show(self) -> Iterator[Block]:
        """Return a table with a column for each level, then the most connected labels and nodes.

        The starting kitchen, if it is used, and the files with the most units are listed, too.
        """
        places = f"{counted(len(self.files), 'file', ',')}, {counted(len(self.videos), 'source video', ',')}"
        yield f"{counted(self.units_read, 'unit', ',')} read from {places}"
        are = "is a copy of another" if self.copies == 1 else "are copies of others"
        yield f"{self.copies:,} of them {are}"
        yield from ("", self._table())
        if self.starting_kitchen is not None:
            files, made = counted(self.starting_kitchen.files, "file", ","), self.starting_kitchen.made_too
            yield "the starting kitchen, as no kitchen is given:"
            yield f"  what no unit makes: {counted(len(self.starting_kitchen.not_made), 'node', ',')}"
            yield f"  what units of the {files} also need: {counted(len(made), 'node', ',')}"
        yield from ("", "most connected labels: units with the label among their inputs or outputs")
        yield from (f"  {label.units:>7,}  {label.label}" for label in self.most_connected_labels)
        yield from ("", "most connected object nodes: units that need it, units that make it")
        for node in self.most_connected_objects:
            yield f"  {node.needed_by:>7,} {node.made_by:>7,}  {node.object}"
        if len(self.files) > 1:
            largest = sorted(self.files, key=lambda file: -file.units)[:10]
            yield from ("", "most units: files")
            yield from (f"  {file.units:>7,}  {escaped(file.file)}" for file in largest)
        if len(self.files) > 10:
            others = counted(len(self.files) - 10, "file", ",")
            yield f"  ... and {others} more; --format json lists all"

    def _table(self) -> Table:
        """Return the table of figures, with a column for each level."""
        rows: list[Sequence[str] | str] = []
        heading = ""
        for group, name, figure in _ROWS:
            if group != heading:
                rows.append(f"reach from the {self.reached_from}" if group == "reach" else group)
                heading = group
            figures = [figure(statistics) for statistics in self.levels]
            figure_texts = [f"{value:,}" if isinstance(value, int) else str(value) for value in figures]
            rows.append([f"  {name}" if group else name, *figure_texts])
        return Table(["at level", *(str(level.level) for level in self.levels)], rows, frozenset({0}))


class ExplainedInput(Node, frozen=True, kw_only=True):
    """An input of a unit.

    Attributes:
        stays: Whether it is still there when the unit has run; left out unless asked for.
        why: Why it stays, or is used up; left out unless asked for.
    """

    stays: bool | UnsetType = UNSET
    why: str | UnsetType = UNSET


class ExplainedUnit(Unit, frozen=True):
    """A unit; on request, each input says whether it stays or is used up."""

    inputs: tuple[ExplainedInput, ...]


class ListedUnits(Result, frozen=True, kw_only=True, tag=schema_name("units")):
    """The functional units of a network.

    Attributes:
        containers: The container rule under which inputs are used up.
        level: The level at which object nodes are compared.
        units: The units that were asked for by id, or all.

    Example:
        >>> listed = foon_asp.stats(foon_asp.load(), unit=[0], explain_items=True)
        >>> [(str(node), node.stays) for node in listed.units[0].inputs]
        [('faucet; off', False)]
    """

    ROWS = "units"

    containers: ContainerRule
    level: int
    units: tuple[ExplainedUnit, ...]

    def show(self) -> Iterator[Block]:
        """Return a line for each unit; on request, lines for its inputs and outputs follow.

        The line of an input says why it stays or is used up.
        """
        for unit in self.units:
            yield from step_lines([unit])
            explained = [node for node in unit.inputs if node.why is not UNSET]
            yield from (f"       {node}  ({node.why})" for node in explained)
            if explained:
                yield from (f"     → {node}" for node in unit.outputs)


@question(
    Option("units", "List the functional units instead of counting.", Kind.FLAG),
    Option("unit", "List this unit only, by its id.", Kind.WHOLE, many=True, metavar="ID"),
    Option("explain_items", "List units, and say of each input why it stays or is used up.", Kind.FLAG),
    CONTAINERS._replace(role=Role.QUESTION),
    ITEMS[2]._replace(
        help="Labels and object nodes that stay, or are used up, whatever the rule says.", role=Role.QUESTION
    ),
    formats=TABLES,
    help_="""
    \b
    foon-asp stats my_foon                   a folder of data, or of recipes
    foon-asp stats one.txt two.json more/    networks, together
    foon-asp stats my_foon --units           its functional units, one by one
    foon-asp stats --explain-items --unit 12 --unit 30 --stays mine.txt

    Counts units, object nodes, motions and states; how many units make each node; cycles, parts, depth, and
    what cannot be made from the kitchen (or, without one, from what makes the units of each file run); the
    most connected objects. Each at the levels of detail 1 to 3, or at --level 1 or 2 alone: level 2 ignores
    contents, level 1 all but labels. docs/formats.md says exactly what is counted, and docs/plans.md what is
    used up.

    Exits with 0.
    """,
    pose=pose_data,
)
def stats(
    foon: Foon | File,
    *,
    units: bool = False,
    unit: Iterable[int] = (),
    explain_items: bool = False,
    containers: str = DEFAULT_RULE.value,
    stays: Stays | None = None,
    **limits: Unpack[Limits],
) -> Stats | ListedUnits:
    """Count what is in a network at each level of detail, or list its functional units.

    Parameters:
        foon: The data, or the path of a recipe, a folder or a store.
        stays: What stays (``True``) or is used up (``False``), by label or object node; or the path of a
            file. If given, units are listed.

    Returns:
        The counts. With ``units``, ``unit``, ``explain_items`` or ``stays``: the units instead. With
        ``explain_items`` or ``stays``, each of their inputs says whether it stays.

    Raises:
        UserError: for a file that cannot be read, for a unit or a name in ``stays`` that the network does not
            have, and if inputs are to be explained below level 3.

    Example:
        >>> counts = foon_asp.stats(foon_asp.load())
        >>> [level.units for level in counts.levels]
        [219, 220, 220]
        >>> listed = foon_asp.stats(foon_asp.load(), unit=[0], explain_items=True)
        >>> listed.text().splitlines()[1:]
        ['       faucet; off  (used up)', '     → faucet; on']
    """
    explains = explain_items or stays is not None
    with start_deadline(limits).watched("counting"):
        dataset = (foon if isinstance(foon, Foon) else load(foon)).dataset
        if units or unit or explains:
            return _list_units(
                dataset, tuple(dict.fromkeys(unit)), container_rule(containers), explains, stays
            )
        return Stats.of(dataset.data)


def _list_units(
    dataset: Dataset, numbers: Sequence[int], rule: ContainerRule, explains: bool, stays: Stays | None
) -> ListedUnits:
    """Return the units with the given ids in the whole network, or all units if there are no ids.

    If ``explains``, each input says whether it stays. ``stays`` overrides this for labels and nodes. Raises
    :class:`UserError` for unknown ids. It is also raised if inputs are to be explained below level 3.
    """
    items = items_of(dataset, "used-up", None, stays) if explains else None
    network = (dataset.data_part((), numbers)[0] if numbers else dataset.data).network
    unit_ids = [network.unit_of_number(number) for number in numbers]
    ids = [unit for unit in unit_ids if unit is not None] if numbers else range(len(network))
    listed = tuple(_explained_unit(network, unit, rule, dataset.utensils, items) for unit in ids)
    return ListedUnits(containers=rule, level=network.level, units=listed)


def _explained_unit(
    network: Network, unit: int, rule: ContainerRule, utensils: frozenset[str], items: UsedUp | None
) -> ExplainedUnit:
    """Return a unit, by id, as a value.

    ``items`` says how items are used up: each input then says whether it stays and why. If ``items`` is
    ``None``, inputs say nothing of this. An input that the container rule takes as given stays.
    """
    unit_value, functional_unit = unit_of(network, unit), network.unit(unit)
    needed = set() if items is None else set(needed_inputs(functional_unit, rule, utensils, network))
    inputs = []
    for o, node in zip(network.inputs[unit], functional_unit.inputs, strict=True):
        stays: bool | UnsetType = UNSET
        why: str | UnsetType = UNSET
        if items is not None and node in needed:
            fate = items.fate(functional_unit, node, utensils)
            stays, why = fate.stays, str(fate)
        elif items is not None:
            stays, why = True, "implied, so neither asked for nor used up"
        inputs.append(node_as(ExplainedInput, network, o, stays=stays, why=why))
    return ExplainedUnit(
        unit_value.id,
        unit_value.motion,
        tuple(inputs),
        unit_value.outputs,
        unit_value.source,
        unit_value.stands_for,
    )


def _starting_nodes(network: Network) -> StartingNodes:
    """Return the starting kitchen of a network, as nodes that no unit makes and nodes that units make."""
    kitchen = starting_kitchen(network)
    not_made, made_too = (
        nodes_of(network, sorted(nodes))
        for nodes in (kitchen.nodes - kitchen.made_by_units, kitchen.made_by_units)
    )
    return StartingNodes(kitchen.file_count, not_made, made_too)
