"""The functional units of a network, and what each does with its inputs."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from foon_asp.dataset.items import Stays, items_of
from foon_asp.deadline import Cancel
from foon_asp.document.json_document import document, unit_json
from foon_asp.foon import Foon
from foon_asp.network import Network, ObjectNode
from foon_asp.problem import ContainerRule, UsedUp, container_rule, needed_inputs
from foon_asp.problem.progress import OnProgress
from foon_asp.questions.contract import TABLES, Kind, Option, Part, question
from foon_asp.questions.options import CONTAINERS, ITEMS
from foon_asp.questions.posing import the_data
from foon_asp.questions.result import Result
from foon_asp.report.answer import unit_lines


@dataclass(frozen=True, repr=False)
class Units(Result):
    """Functional units of a ``network``, by id in ``ids``.

    ``items`` says what stays, if that was asked, under the rule ``containers``, for which ``utensils`` count.

    Example:
        >>> listed = foon_asp.units(foon_asp.load(), units=[0], explain_items=True)
        >>> listed.stays(0)
        {'faucet; off': False}
    """

    network: Network
    ids: tuple[int, ...]
    containers: ContainerRule
    utensils: frozenset[str]
    items: UsedUp | None = None

    def stays(self, unit: int) -> dict[str, bool]:
        """Say of each input of a unit whether it is still there when the unit has run.

        Parameters:
            unit: The id of the unit here.
        """
        items = self.items or UsedUp()
        value = self.network.unit(unit)
        return {str(node): items.fate(value, node, self.utensils).stays for node in value.inputs}

    def text(self) -> str:
        """List the units, and under each its inputs with what becomes of them."""
        return "".join(f"{line}\n" for line in self._lines())

    def json_dict(self) -> object:
        """Give the same."""
        shown = []
        for unit in self.ids:
            each = unit_json(self.network, unit)
            if self.items is not None:
                for node, (_, stays, why) in zip(each["inputs"], self._fates(unit), strict=True):
                    node |= {"stays": stays, "why": why}
            shown.append(each)
        return document("units", containers=str(self.containers), level=self.network.level, units=shown)

    def _lines(self) -> Iterator[str]:
        for unit in self.ids:
            yield from unit_lines(self.network, (unit,))
            if self.items is not None:
                yield from (f"       {node}  ({why})" for node, _, why in self._fates(unit))
                yield from (f"     → {self.network.objects[o]}" for o in self.network.outputs[unit])

    def _fates(self, unit: int) -> Iterator[tuple[ObjectNode, bool, str]]:
        """Give each input, whether it stays, and why."""
        assert self.items is not None
        value = self.network.unit(unit)
        needed = set(needed_inputs(value, self.containers, self.utensils, self.network))
        for node in value.inputs:
            fate = self.items.fate(value, node, self.utensils)
            if node in needed:
                yield node, fate.stays, str(fate)
            else:
                yield node, True, "implied, so neither asked for nor used up"


@question(
    Option(
        "units", "The id of a unit; all without any.", Kind.WHOLE, flags=("--unit",), many=True, metavar="ID"
    ),
    Option("explain_items", "Say of each input why it stays, or that it is used up.", Kind.FLAG),
    CONTAINERS._replace(part=Part.QUESTION),
    ITEMS[2]._replace(
        help="Labels and object nodes that stay, or are used up, whatever the rule says.", part=Part.QUESTION
    ),
    formats=TABLES,
    help_="""
    \b
    foon-asp units --explain-items
    foon-asp units --explain-items --unit 12 --unit 30 --stays mine.txt

    docs/plans.md has the rule. Exits with 0.
    """,
    pose=the_data,
)
def units(
    foon: Foon,
    *,
    units: Iterable[int] = (),
    explain_items: bool = False,
    containers: str = "strict",
    stays: Stays | None = None,
    time_limit: float | None = None,
    on_progress: OnProgress | None = None,
    cancel: Cancel | None = None,
) -> Units:
    """List the functional units of a network, and say which of their inputs are used up.

    Parameters:
        foon: The data.
        stays: What stays (``True``) or is used up (``False``), by label or object node; or the path of a
            file.

    Returns:
        The units, which say of their inputs whether they stay.

    Raises:
        UserError: for a unit that the network does not have, a file that cannot be read, or a name in it
            that the network does not have; and where inputs are to be explained below level 3.

    Example:
        >>> listed = foon_asp.units(foon_asp.load(), units=[0], explain_items=True)
        >>> listed.text().splitlines()[1:]
        ['       faucet; off  (used up)', '     → faucet; on']
    """
    wanted = tuple(dict.fromkeys(units))
    dataset = foon.dataset
    how = items_of(dataset, "used-up", None, stays) if explain_items or stays is not None else None
    network = dataset.data.network if not wanted else dataset.part((), wanted)[0].network
    here = [network.unit_of_number(number) for number in wanted]
    ids = tuple(unit for unit in here if unit is not None) if wanted else tuple(range(len(network)))
    return Units(network, ids, container_rule(containers), dataset.utensils, how)
