"""What is in a network: counts at each level of detail, or its functional units one by one."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

from foon_asp.dataset.items import Stays, items_of
from foon_asp.dataset.paths import File
from foon_asp.dataset.statistics import count_levels
from foon_asp.deadline import Cancel
from foon_asp.document.json_document import document, unit_json
from foon_asp.foon import Foon, load
from foon_asp.network import Network, ObjectNode
from foon_asp.network.statistics import Statistics
from foon_asp.problem import ContainerRule, UsedUp, container_rule, needed_inputs
from foon_asp.problem.progress import OnProgress
from foon_asp.questions.contract import TABLES, Kind, Option, Part, question
from foon_asp.questions.options import CONTAINERS, ITEMS
from foon_asp.questions.posing import the_data
from foon_asp.questions.result import Result
from foon_asp.report.answer import unit_lines
from foon_asp.report.statistics_table import statistics_json, statistics_parts
from foon_asp.results.table import Part as Shown
from foon_asp.results.table import rendered
from foon_asp.text.data_folder import Data


@dataclass(frozen=True, repr=False)
class Stats(Result):
    """Counts of what is in a network, or the functional ``units`` that were asked for, by id.

    ``data`` has the network and the kitchen. Where it is to be explained what is used up, ``items`` says what
    stays, under the rule ``containers``, for which ``utensils`` count.

    Example:
        >>> foon_asp.stats(foon_asp.load()).levels[2].objects
        418
        >>> foon_asp.stats(foon_asp.load(), unit=[0], explain_items=True).stays(0)
        {'faucet; off': False}
    """

    data: Data
    units: tuple[int, ...] | None = None
    containers: ContainerRule = ContainerRule.STRICT
    utensils: frozenset[str] = frozenset()
    items: UsedUp | None = None

    @property
    def network(self) -> Network:
        """The network."""
        return self.data.network

    @cached_property
    def levels(self) -> Sequence[Statistics]:
        """The counts at the levels of detail 1 to 3; of data below level 3, at their own."""
        return count_levels(self.data)

    def stays(self, unit: int) -> dict[str, bool]:
        """Return for each input of a unit whether it is still there when the unit has run.

        Parameters:
            unit: The id of the unit here.
        """
        items = self.items or UsedUp()
        value = self.network.unit(unit)
        return {str(node): items.fate(value, node, self.utensils).stays for node in value.inputs}

    def text(self) -> str:
        """Return the same as text."""
        return rendered(self.show())

    def show(self) -> Iterator[Shown]:
        """Return a table with a column for each level; or the units, with what becomes of their inputs."""
        if self.units is None:
            yield from statistics_parts(self.network, self.levels, not self.data.starting)
        for unit in self.units or ():
            yield from self._lines(unit)

    def json_dict(self) -> object:
        """Return the same as plain values."""
        if self.units is None:
            return statistics_json(self.network, self.levels, not self.data.starting)
        shown = []
        for unit in self.units:
            each = unit_json(self.network, unit)
            for node, (_, stays, why) in zip(each["inputs"], self._fates(unit), strict=False):
                node |= {"stays": stays, "why": why}
            shown.append(each)
        return document("units", containers=str(self.containers), level=self.network.level, units=shown)

    def _lines(self, unit: int) -> Iterator[str]:
        yield from unit_lines(self.network, (unit,))
        yield from (f"       {node}  ({why})" for node, _, why in self._fates(unit))
        if self.items is not None:
            yield from (f"     → {self.network.objects[o]}" for o in self.network.outputs[unit])

    def _fates(self, unit: int) -> Iterator[tuple[ObjectNode, bool, str]]:
        """Yield each input of a unit, whether it stays, and why; nothing where that is not asked."""
        if self.items is None:
            return
        value = self.network.unit(unit)
        needed = set(needed_inputs(value, self.containers, self.utensils, self.network))
        for node in value.inputs:
            fate = self.items.fate(value, node, self.utensils)
            if node in needed:
                yield node, fate.stays, str(fate)
            else:
                yield node, True, "implied, so neither asked for nor used up"


@question(
    Option("units", "List the functional units instead of counting.", Kind.FLAG),
    Option("unit", "List this unit only, by its id.", Kind.WHOLE, many=True, metavar="ID"),
    Option("explain_items", "List units, and say of each input why it stays or is used up.", Kind.FLAG),
    CONTAINERS._replace(part=Part.QUESTION),
    ITEMS[2]._replace(
        help="Labels and object nodes that stay, or are used up, whatever the rule says.", part=Part.QUESTION
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
    pose=the_data,
)
def stats(
    foon: Foon | File,
    *,
    units: bool = False,
    unit: Iterable[int] = (),
    explain_items: bool = False,
    containers: str = "strict",
    stays: Stays | None = None,
    time_limit: float | None = None,
    on_progress: OnProgress | None = None,
    cancel: Cancel | None = None,
) -> Stats:
    """Count what is in a network at each level of detail, or list its functional units.

    Parameters:
        foon: The data, or the path of a recipe, a folder or a store.
        stays: What stays (``True``) or is used up (``False``), by label or object node; or the path of a
            file. Units are listed then.

    Returns:
        The counts; or the units, which say of their inputs whether they stay.

    Raises:
        UserError: for a file that cannot be read, or a unit that the network does not have; for a name in
            ``stays`` that the network does not have; and where inputs are to be explained below level 3.

    Example:
        >>> counts = foon_asp.stats(foon_asp.load())
        >>> [level.units for level in counts.levels]
        [219, 220, 220]
        >>> listed = foon_asp.stats(foon_asp.load(), unit=[0], explain_items=True)
        >>> listed.text().splitlines()[1:]
        ['       faucet; off  (used up)', '     → faucet; on']
    """
    dataset = (foon if isinstance(foon, Foon) else load(foon)).dataset
    explains = explain_items or stays is not None
    numbers = tuple(dict.fromkeys(unit))
    if not (units or numbers or explains):
        return Stats(dataset.data)
    items = items_of(dataset, "used-up", None, stays) if explains else None
    data = dataset.part((), numbers)[0] if numbers else dataset.data
    network = data.network
    listed = [network.unit_of_number(number) for number in numbers]
    ids = tuple(u for u in listed if u is not None) if numbers else tuple(range(len(network)))
    return Stats(data, ids, container_rule(containers), dataset.utensils, items)
