"""What it would take: the cheapest things to add to the kitchen."""

from collections.abc import Mapping
from os import PathLike
from pathlib import Path

from foon_asp.dataset.paths import File, Files
from foon_asp.errors import UserError
from foon_asp.explain import shopping_list as explain
from foon_asp.network import ObjectNode, Source
from foon_asp.problem import Number, Problem, exact
from foon_asp.questions.answer import Answer
from foon_asp.questions.arguments import Constants, Objectives, at_least, chosen_objectives, settings
from foon_asp.questions.caller import caller
from foon_asp.questions.result import Result
from foon_asp.report.drawing import Drawing
from foon_asp.report.shopping import shopping_json, shopping_text
from foon_asp.text import LineError, Price, parse_node, read_prices
from foon_asp.warning import warn


class Shopping(Result, explain.Shopping):
    """Lists of things to add to the kitchen in order of cost, and the tree that the first makes possible.

    Each of ``lists`` has its ``items`` by id, its ``price`` (their number, or the sum of prices) and whether
    it is ``proved`` that none is cheaper; :attr:`items` are the things of the first. ``lists`` is empty where
    no list helps, which is proved when ``complete``.
    """

    __slots__ = ()

    @property
    def items(self) -> tuple[ObjectNode, ...]:
        """The things on the first list."""
        objects = self.problem.network.objects
        return tuple(objects[o] for o in self.lists[0].items) if self.lists else ()

    @property
    def outcome(self) -> Answer | None:
        """The best tree once the first list is in the kitchen; ``None`` without a list."""
        outcome = super().outcome
        return None if outcome is None else Answer._make(outcome)

    def text(self) -> str:
        """Give the lists as ``foon-asp shopping-list`` does."""
        return shopping_text(self)

    def json_text(self) -> str:
        """Give the lists as ``foon-asp shopping-list --format json`` does."""
        return shopping_json(self)

    def drawing(self) -> Drawing | None:
        """Give what the picture of the tree shows."""
        return None if self.outcome is None else self.outcome.drawing()


def shopping_list(
    problem: Problem,
    objectives: Objectives = "units",
    *,
    prices: File | Mapping[str, Number] | None = None,
    lists: int = 3,
    constraints: Files = (),
    constants: Constants | None = None,
    encodings: File | None = None,
    time_limit: float | None = None,
    memory_limit: int | str | None = None,
) -> Shopping:
    """Find the fewest or cheapest object nodes to add to the kitchen so that a task tree exists.

    With ``prices``, only what has one can be bought: the path of a price list, or prices by label or one-line
    notation, where a label stands for its nodes that would be for sale. At most so many ``lists`` are given.
    Of a store, the whole network is read. Otherwise as :func:`foon_asp.solve`.
    """
    chosen = chosen_objectives(problem, objectives)
    how = settings(constraints, constants, encodings, time_limit, memory_limit)
    asked = problem.whole
    by_id = None
    if prices is not None:
        listed = read_prices(Path(prices)) if isinstance(prices, str | PathLike) else _given(prices)
        by_id = explain.priced(asked, listed, warn)
    most = at_least(lists, 1, "lists")
    return Shopping._make(explain.shopping_list(asked, chosen, how, by_id, most, caller().reporter))


def _given(prices: Mapping[str, Number]) -> list[Price]:
    """Read prices as the lines of a price list are."""
    found = []
    for number, (name, given) in enumerate(prices.items(), 1):
        price = exact(given, f"the price of {name!r}")
        if price < 0:
            raise UserError(f"found the price {given} of {name!r}, expected one from 0")
        try:
            node = parse_node(name)
        except LineError as error:
            raise UserError(
                f"the name {name!r} of a price cannot be read: at column {error.column}, {error}"
            ) from None
        found.append(Price(node, ";" not in name, price, Source("prices", number)))
    return found
