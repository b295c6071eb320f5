"""Shopping lists: the cheapest items to add to the kitchen so that a tree exists."""

import math
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import replace
from decimal import Decimal
from fractions import Fraction
from heapq import heappop, heappush
from os import PathLike
from pathlib import Path
from typing import Annotated, NamedTuple, Unpack

from msgspec import UNSET, UnsetType

from foon_asp.asp import Outcome, Reporter, Settings, Status
from foon_asp.asp.assembly import assemble
from foon_asp.asp.optimum import solve
from foon_asp.asp.postconditions import Postconditions
from foon_asp.asp.prepared import Prepared, prepare
from foon_asp.asp.program import Program
from foon_asp.dataset.paths import File
from foon_asp.encoding.fact_writer import write_for_sale, write_found_list
from foon_asp.encoding.own_encodings import question_encoding
from foon_asp.errors import BugError, UserError
from foon_asp.hypergraph import SolvedGoals
from foon_asp.json_layout import schema_name
from foon_asp.network import ObjectNode, Source, counted
from foon_asp.problem import Costs, Number, Objective, Problem, exact_number, levels
from foon_asp.problem.dead_ends import dead_ends
from foon_asp.problem.for_sale import Offer, Shop
from foon_asp.problem.number import INT32_MAX
from foon_asp.problem.purchases import Purchases
from foon_asp.proof.counted_run import counted_run
from foon_asp.questions.answer import Answer, WithAnswer
from foon_asp.questions.caller import caller
from foon_asp.questions.ending import Ending
from foon_asp.questions.options import AMOUNT, ITEMS, TREE
from foon_asp.questions.python_arguments import (
    Objectives,
    chosen_objectives,
    over_whole_network,
    require_at_least,
)
from foon_asp.questions.python_options import CommonOptions, settings_of
from foon_asp.questions.question import TABLES, Kind, Option, question
from foon_asp.results.figure_text import costs_text
from foon_asp.results.table import Block
from foon_asp.results.values import Node, Value
from foon_asp.results.values_of import node_as, question_fields
from foon_asp.text.line import LineError
from foon_asp.text.line_parser import parse_name
from foon_asp.text.tables import PRICES
from foon_asp.text.value_table import Row

_MAX_COMPARED = 30  # lists of one price whose trees are compared, at most

_REMARKS = {
    Offer.CYCLE: "what is for sale is not enough: something from a cycle that feeds only itself is needed",
    Offer.PROCESSED: "what is for sale is not enough, so the list contains things that units would make",
    Offer.DISH: "nothing else is enough, so the list contains something with the name of the dish in it",
    Offer.GOAL: "nothing else is enough, so the goal itself has to be bought",
}


class Item(Node, frozen=True, kw_only=True):
    """An object node on a shopping list.

    Attributes:
        price: What a copy costs; 1 without a price list.
        copies: Where items are used up: how many copies to buy.
    """

    price: Fraction
    copies: int | UnsetType = UNSET

    def __str__(self) -> str:
        return self.node if self.copies is UNSET else f"{self.copies} x {self.node}"


class ShoppingList(Value, frozen=True):
    """Object nodes to add to the kitchen.

    Attributes:
        price: The sum of prices; without a price list, the number of items, or of copies if they are used up.
        proved: Whether it is proved that no list is cheaper, except lists that contain all items of an
            earlier list.
        costs: What the best tree costs with these items; null where a limit came first.
    """

    items: tuple[Item, ...]
    price: Fraction
    proved: bool
    costs: Costs | None


class Shopping(WithAnswer, frozen=True, kw_only=True, tag=schema_name("shopping-list")):
    """Lists of things to add to the kitchen, and the best tree with the first list.

    Attributes:
        offer: The nodes that could be bought: those on the price list (priced) or, without one, the first set
            from which the goals can be made. The sets are: raw nodes, unprocessed nodes, tools and vessels
            (for sale); also nodes of a cycle that feeds only itself (cycle); all but the dish (processed);
            all but the goals (dish); all (goal).
        lists: The lists, the cheapest first. Of lists with one price and number of items, those with the
            fewest mixtures and made things come first, then that with the best tree. Empty if no list helps.
        complete: Whether it is proved that there are no more lists.
        answer: The best tree with the first list in the kitchen; null without a list.

    Example:
        >>> shopping = foon_asp.shopping_list(foon_asp.load().problem("hot cocoa"), lists=1)
        >>> [(str(item), str(item.price)) for item in shopping.lists[0].items]
        [('cocoa tin; contains {cocoa powder}', '1')]
    """

    ROWS = "lists"

    offer: Offer
    lists: tuple[ShoppingList, ...]
    complete: bool
    answer: Answer | None

    @property
    def ending(self) -> Ending:
        """``DONE`` if all lists and the tree are proved, ``NEGATIVE`` if no list helps, else ``LIMIT``."""
        if not self.lists:
            return Ending.NEGATIVE if self.complete else Ending.LIMIT
        proved = all(bought.proved for bought in self.lists)
        return Ending.DONE if proved and self.answer and self.answer.ending is Ending.DONE else Ending.LIMIT

    def show(self) -> Iterator[Block]:
        """Return the first list with the steps that need each item, the other lists, and the best tree.

        The best tree is that with the items of the first list. Without a list, one line says why.
        """
        yield from self.goal_lines()
        if not self.lists:
            yield self._no_list_text()
            return
        first, *others = self.lists
        if first.items:
            claim = "cheapest" if self.offer is Offer.PRICED else "shortest"
            proved = f"{claim}, proved" if first.proved else f"not proved {claim}"
            yield f"shopping list ({self.conditions}; {proved}): {self._price_text(first)}"
            for item in first.items:
                yield from self._item_lines(item)
            if remark := _REMARKS.get(self.offer):
                yield remark
        else:
            yield f"nothing has to be bought ({self.conditions})"
        for number, other in enumerate(others, 2):
            claim = "" if other.proved else ", not proved next"
            costs = "a tree that is not known" if other.costs is None else costs_text(other.costs)
            yield f"or, list {number} ({self._price_text(other)}{claim}), with {costs}:"
            yield from (f"  {item}" for item in other.items)
        if first.items:
            yield self._further_lists_text()
        if self.answer is not None and self.answer.units is not None:
            claim, *note = self.answer.headlines()
            yield from ("", f"with {'the first list' if others else 'it'}: {claim}", *note, "")
            yield from (line for step in self.answer.units for line in step.lines())
            if not self.answer.units:
                yield "nothing to do"

    def _no_list_text(self) -> str:
        """Return one line on why there is no list."""
        if not self.complete:
            return f"unknown: stopped at a limit before any list was found ({self.conditions})"
        if self.offer is Offer.PRICED:
            return f"no list of things with a price makes a tree possible: proved ({self.conditions})"
        return f"whatever is bought, the constraints leave no tree: proved ({self.conditions})"

    def _item_lines(self, item: Item) -> Iterator[str]:
        """Yield an item, with its price if prices are known, and a line with the steps that need it.

        The line is left out if no step needs the item.
        """
        yield f"  {item}" + (f"    {_price_as_decimal(item.price)}" if self.offer is Offer.PRICED else "")
        steps = () if self.answer is None else self.answer.units or ()
        consumers = [step for step in steps if any(used.node == item.node for used in step.inputs)]
        if consumers:
            yield f"      for {', '.join(f'{step.motion} [{step.source[0]}]' for step in consumers)}"

    def _further_lists_text(self) -> str:
        """Return one line on whether there are further lists."""
        if not self.complete:
            return "there are more lists than these: --lists finds more"
        lists = "this list" if len(self.lists) == 1 else "one of these lists"
        if self.items != "lasting":
            return f"that is all: any other list that makes a plan possible has each thing of {lists}"
        return (
            f"that is all: any other set of things on offer that makes a tree possible holds all of {lists}"
        )

    def _price_text(self, bought: ShoppingList) -> str:
        """Return in words the number of items of a list; copies and price follow if they matter."""
        items = counted(len(bought.items), "object node")
        if self.items != "lasting":
            copies = sum(item.copies for item in bought.items if item.copies is not UNSET)
            items = f"{copies} {'copy' if copies == 1 else 'copies'} of {items}"
        return f"{items} for {_price_as_decimal(bought.price)}" if self.offer is Offer.PRICED else items


@question(
    *TREE,
    *ITEMS,
    AMOUNT,
    used_up=True,
    formats=TABLES,
    help_="""
    \b
    foon-asp shopping-list --goal 'hot cocoa'
    foon-asp shopping-list --goal 'hot cocoa' --goal omelet --prices prices.txt
    foon-asp shopping-list recipe.txt --amount 8 --kitchen kitchen.json

    For sale is what no unit makes, what is empty or clean, a vessel or tool that units give back and cannot
    run without, and what has no state and contains at most one ingredient, unless it is a product. The dish
    itself is proposed only if nothing else is enough. A line of a price list is an object node in one-line
    notation, or a label, then a tab and a price. Every list is proved to be the cheapest of those that do not
    contain all of an earlier one; among lists of one size, that with plain things comes first, then that with
    the best tree.

    With items used up, or amounts of goals, it says how many copies of each thing to buy: the fewest, or the
    cheapest by a price list for one copy. What the kitchen has an amount of can be bought, too. A further
    list lacks some thing of every earlier one.

    Exits with 0 when there is a list, proved; with 1 when no list helps, proved; with 3 when stopped at a
    limit.
    """,
)
def shopping_list(
    problem: Problem,
    objectives: Objectives = "units",
    *,
    prices: Annotated[File | Mapping[str, Number] | None, Option(kind=Kind.FILE)] = None,
    lists: Annotated[int, Option(least=1)] = 3,
    **options: Unpack[CommonOptions],
) -> Shopping:
    """Find the fewest or cheapest object nodes to add to the kitchen so that a task tree or plan exists.

    Where items are used up, a list has the number of copies of each node. A further list lacks some node of
    every earlier list. Every list is proved: there is no shorter or cheaper one, except those that contain
    all items of an earlier list. Among lists of the same cost, one with fewer things comes first, then one
    with fewer mixtures and objects that units make, then one with a better tree. If a limit stops the search
    for these trees, the lists stay in the order in which they were found. All of a store is read.

    Parameters:
        prices: A price list: lines of an object node, a tab and a price; only what has a price can be bought.
            In Python also prices by name. A label stands for all its nodes that would be for sale. Without
            prices, every node costs 1.
        lists: How many lists to find, at most.

    Returns:
        The ``lists``, and the best tree with the items of the first one as the ``answer``.

    Raises:
        UserError: for a wrong argument or constraint, a price list that cannot be read, or a rule that says
            something else once the items are bought.

    Example:
        >>> shopping = foon_asp.shopping_list(foon_asp.load().problem("hot cocoa"))
        >>> print(*shopping.lists[0].items)
        cocoa tin; contains {cocoa powder}
        >>> shopping.answer.costs.units
        11
    """
    chosen, settings = chosen_objectives(problem, objectives), settings_of(options)
    max_lists = require_at_least(lists, 1, "lists")
    problem = over_whole_network(problem)
    priced = None if prices is None else _prices_of_nodes(problem, _price_rows(prices))
    if problem.items is not None:
        return _shopping_with_copies(problem, chosen, settings, priced, max_lists)
    deadline, reporter = settings.effective_deadline, caller().reporter
    program = assemble(settings, reporter.warning, problem=problem)
    cheapest = _Lists([], complete=True)
    offer_and_prices = (Offer.FOR_SALE, dict[int, Fraction]()) if priced is None else (Offer.PRICED, priced)
    try:
        with deadline.watched("looking for what is for sale"):
            shop = Shop(problem)
            offers = _unpriced_offers(problem, shop) if priced is None else [offer_and_prices]
        for offer_and_prices in offers:
            prepared = prepare(problem, chosen, settings, program, for_sale=offer_and_prices[1])
            cheapest = _lists_without_copies(prepared, chosen, shop, offer_and_prices[1], max_lists)
            if cheapest.lists or not cheapest.complete:
                break
    except KeyboardInterrupt:
        deadline.interrupt()
        cheapest = _Lists([], complete=False)
    offer, wares = offer_and_prices
    outcomes: list[tuple[_PricedList, Outcome]] = []
    for candidate in cheapest.lists:
        outcome = candidate.outcome
        if outcome is None:
            stocked = _with_bought_items(problem, candidate.bought)
            outcome = solve(stocked, chosen, settings, Reporter() if outcomes else reporter)
        if outcome.status is Status.INFEASIBLE:
            _refuse_nonlocal_rules(program)
            raise BugError("the shopping list does not make a tree possible")
        outcomes.append((candidate, outcome))
    if all(outcome.status is Status.OPTIMAL for _, outcome in outcomes):
        outcomes.sort(key=lambda pair: _list_key(pair[0], pair[1], shop))
    return Shopping(
        **question_fields(problem, chosen),
        offer=offer,
        lists=tuple(
            candidate.value(problem, wares, outcome.costs) for candidate, outcome in outcomes[:max_lists]
        ),
        complete=cheapest.complete and len(outcomes) <= max_lists,
        answer=Answer.of(outcomes[0][1], outcomes[0][0].bought) if outcomes else None,
    )


def _shopping_with_copies(
    problem: Problem,
    objectives: tuple[Objective, ...],
    settings: Settings,
    priced: Mapping[int, Fraction] | None,
    max_lists: int,
) -> Shopping:
    """Return the result for plans in which items are used up: the cheapest lists, with copies of each node.

    ``priced`` are the prices by id of the node; ``None`` without a price list. The lists are of the first
    offer that is enough. Raises :class:`UserError` for rules, which would see the purchases as units.
    """
    if settings.constraints or settings.replaced is not None:
        raise UserError(
            "shopping lists with items used up are not built under rules: leave the rules out, or ask with "
            "--items lasting"
        )
    without_stock = replace(problem, kitchen=problem.endless)  # nodes with an amount can be bought, too
    shop, needs = Shop(without_stock), {*problem.goals, *(o for needs in problem.needs for o in needs)}
    offers = [(Offer.PRICED, dict(priced))] if priced is not None else _unpriced_offers(without_stock, shop)
    cheapest, offer_and_prices = _Lists([], complete=True), (Offer.FOR_SALE, dict[int, Fraction]())
    for offer_and_prices in offers:
        wares = {o: price for o, price in offer_and_prices[1].items() if o in needs}
        second_choices = frozenset(filter(shop.is_second_choice, wares))

        def purchases(left_out: Collection[int]) -> Purchases:
            """Return the purchases that remain possible without wares, by id, that are left out."""
            offered = {o: price for o, price in wares.items() if o not in left_out}  # noqa: B023 (called here)
            return Purchases(problem, offered, second_choices.intersection(offered), objectives)  # noqa: B023

        cheapest = _Shopper(problem, settings, purchases, objectives, wares).lists(max_lists)
        if cheapest.lists or not cheapest.complete:
            break
    outcomes = [(listed, listed.outcome) for listed in cheapest.lists if listed.outcome is not None]
    return Shopping(
        **question_fields(problem, objectives),
        offer=offer_and_prices[0],
        lists=tuple(
            listed.value(problem, offer_and_prices[1], outcome.costs) for listed, outcome in outcomes
        ),
        complete=cheapest.complete,
        answer=Answer.of(outcomes[0][1], outcomes[0][0].bought) if outcomes else None,
    )


class _PricedList(NamedTuple):
    """A shopping list by ids, its price, and whether it is proved to be the cheapest.

    ``bought`` has the number of copies to buy by id of the object node; the number is 1 where items last.
    ``outcome`` has the best tree with these items; ``None`` if it is not known.
    """

    bought: Mapping[int, int]
    price: Fraction
    proved: bool
    outcome: Outcome | None = None

    @property
    def items(self) -> tuple[int, ...]:
        """The ids of the object nodes to buy."""
        return tuple(self.bought)

    def value(self, problem: Problem, wares: Mapping[int, Fraction], costs: Costs | None) -> ShoppingList:
        """Return the list as a value for a result.

        ``wares`` are the prices by id of the node; ``costs`` are those of the best tree with the items.
        """
        counts = problem.items is not None
        items = (
            node_as(Item, problem.network, o, price=wares[o], copies=copies if counts else UNSET)
            for o, copies in self.bought.items()
        )
        return ShoppingList(tuple(items), self.price, self.proved, costs)


class _Lists(NamedTuple):
    """Shopping lists, the cheapest first.

    ``complete``: whether it is proved that there are no others.
    """

    lists: list[_PricedList]
    complete: bool


def _with_bought_items(problem: Problem, bought: Mapping[int, int]) -> Problem:
    """Return the problem with bought items in its kitchen; ``bought`` has the copies by id of the node.

    Where items are used up, the copies are added to the stock. A stock stated of a node outside the kitchen
    is ignored.
    """
    kitchen = problem.kitchen.union(bought)
    if problem.items is None:
        return replace(problem, kitchen=kitchen)
    stock = dict(problem.items.stock)
    for o, copies in bought.items():
        node = problem.network.objects[o]
        stock[node] = (stock.get(node, 0) if o in problem.kitchen else 0) + copies
    return replace(problem, kitchen=kitchen, items=replace(problem.items, stock=stock))


def _list_key(
    candidate: _PricedList, outcome: Outcome, shop: Shop
) -> tuple[Fraction, int, int, tuple[int | Fraction, ...]]:
    """Return the sort key of a list: price, number of items, second choices, costs of the best tree.

    Second choices are mixtures and nodes that units make (:meth:`Shop.is_second_choice`).
    """
    assert outcome.costs is not None
    second_choices = sum(map(shop.is_second_choice, candidate.items))
    costs = outcome.costs.key(levels(outcome.objectives))
    return candidate.price, len(candidate.items), second_choices, tuple(costs)


def _refuse_nonlocal_rules(program: Program) -> None:
    """Raise :class:`UserError` for an understood rule whose meaning depends on units outside the tree.

    Bought items make more units executable, and so would change what the rule says.
    """
    for rule in program.understood.rules if program.understood else ():
        if rule.nonlocality:
            raise UserError(
                f"{rule.source}: {rule.nonlocality}, so what the rule says changes with the units that can "
                "be made, and these with what is bought: no shopping list can be found under it; let it look "
                "at units of the tree alone"
            )


def _price_rows(prices: File | Mapping[str, Number]) -> list[Row[str | ObjectNode, Fraction]]:
    """Return the rows of a price list, from the path of a file or a mapping from names to prices.

    Raises :class:`UserError` for an entry that cannot be read, and for a price below 0.
    """
    if isinstance(prices, str | PathLike):
        return PRICES.rows(Path(prices))
    rows = []
    for number, (name, stated) in enumerate(prices.items(), 1):
        price = exact_number(stated, f"the price of {name!r}")
        if price < 0:
            raise UserError(f"found the price {stated} of {name!r}, expected one from 0")
        try:
            named = parse_name(name)
        except LineError as error:
            raise UserError(
                f"the name {name!r} of a price cannot be read: at column {error.column}, {error}"
            ) from None
        rows.append(Row(named, price, Source("prices", number)))
    return rows


def _prices_of_nodes(
    problem: Problem, listed: Sequence[Row[str | ObjectNode, Fraction]]
) -> dict[int, Fraction]:
    """Return the prices, by id of the object node, of the nodes in a price list.

    An entry with a label alone stands for all nodes of this label that would be for sale without prices. An
    entry with a whole node overrides it. Available nodes that never run out are left out. A warning names
    each entry that matches no node.
    """
    network, shop = problem.network, Shop(problem)
    prices: dict[int, Fraction] = {}
    for entry in sorted(
        listed, key=lambda entry: not isinstance(entry.name, str)
    ):  # entries with whole nodes override labels
        if isinstance(entry.name, str):
            fault = "no node for sale has this label"
            objects = [o for o in network.by_label.get(entry.name, ()) if shop.sells(o)]
        else:
            fault = "no such object node"
            object_id = network.object_id(entry.name)
            objects = [] if object_id is None else [object_id]
        prices.update(dict.fromkeys(objects, entry.value))
        if not objects:
            node = ObjectNode(entry.name) if isinstance(entry.name, str) else entry.name
            caller().reporter.warning(f"{entry.source}:{entry.source.column}: warning: {fault}: {node}")
    return {o: price for o, price in prices.items() if o not in problem.endless}


def _unpriced_offers(problem: Problem, shop: Shop) -> list[tuple[Offer, dict[int, Fraction]]]:
    """Return the offers of a shop, each larger than the one before.

    An offer is the name of a set of nodes, with the price 1 for each of them by id.
    """
    offers = shop.offers(dead_ends(problem).roots)
    return [(offer, dict.fromkeys(sold, Fraction(1))) for offer, sold in offers]


def _lists_without_copies(
    prepared: Prepared,
    objectives: tuple[Objective, ...],
    shop: Shop,
    wares: Mapping[int, Fraction],
    max_lists: int,
) -> _Lists:
    """Return the cheapest lists of ``wares``, which are prices by id of the node, where items last.

    Without rules, :class:`_Shopper` finds the lists, and under rules clingo. If there are rules and
    ``objectives`` beside ``units``, the result has further lists of the same price, for the caller to
    compare. If the goals cannot be made even with all wares, there is no list. This is proved unless a limit
    came first.
    """
    if prepared.tree is None:
        return _Lists([], complete=not prepared.stopped)
    problem = prepared.problem
    needed_objects = {*problem.goals, *(o for unit in prepared.units for o in problem.needs[unit])}
    sold = {o: price for o, price in wares.items() if o in needed_objects}
    second_choices = frozenset(filter(shop.is_second_choice, sold))
    if prepared.program.is_built_in:
        without = Purchases(problem, sold, second_choices, objectives).without
        return _Shopper(problem, prepared.settings, without, objectives, wares).lists(max_lists)
    return _lists_under_rules(prepared, sold, second_choices, max_lists, objectives != (Objective.UNITS,))


class _Shopper:
    """A search for the cheapest shopping lists by a hitting-set tree (Reiter 1987).

    A node of the hitting-set tree is a set of wares to leave out. Its list is what an optimal tree or plan
    buys of the other wares. The next list is the cheapest one that lacks an item of every earlier list.
    """

    def __init__(
        self,
        problem: Problem,
        settings: Settings,
        purchases: Callable[[Collection[int]], Purchases],
        objectives: tuple[Objective, ...],
        wares: Mapping[int, Fraction],
    ) -> None:
        """Prepare the search for lists of ``wares``, which are prices by id of the object node.

        ``purchases`` returns, for ids of wares to leave out, the purchases that remain possible.
        """
        self._problem, self._settings, self._wares = problem, settings, wares
        self._purchases, self._objectives = purchases, objectives
        self._queue: list[tuple[tuple[int | Fraction, ...], int, frozenset[int], _PricedList]] = []
        self._seen: set[frozenset[int]] = set()
        self._chosen_lists: list[_PricedList] = []
        self._solved = SolvedGoals()

    def lists(self, max_lists: int) -> _Lists:
        """Return up to ``max_lists`` lists, the cheapest first; at a limit, the lists found so far.

        If nothing has to be bought, the only list is empty. If ``max_lists`` lists are found, others are not
        ruled out, so the lists are not complete.
        """
        if not self._search_without(frozenset(), caller().reporter):
            return _Lists(self._chosen_lists, complete=False)
        while self._queue:
            _, _, left_out, listed = heappop(self._queue)
            if all(listed.items != earlier.items for earlier in self._chosen_lists):
                self._chosen_lists.append(listed)
                if not listed.items or len(self._chosen_lists) == max_lists:
                    return _Lists(self._chosen_lists, complete=not listed.items)
            if not all(self._search_without(left_out | {item}, Reporter()) for item in listed.items):
                return _Lists(self._chosen_lists, complete=False)
        return _Lists(self._chosen_lists, complete=True)

    def _search_without(self, left_out: frozenset[int], reporter: Reporter) -> bool:
        """Add the best list without the wares ``left_out`` to the queue; return false at a limit.

        Nothing is done if the set was searched before. If an earlier list has no ware in ``left_out``, it may
        be the best one again. So each item of this list is left out in turn, in addition to ``left_out``. If
        a limit comes before any list was proved, the best list found is kept, unproved.
        """
        if left_out in self._seen:
            return True
        self._seen.add(left_out)
        for earlier in self._chosen_lists:
            if left_out.isdisjoint(earlier.items):  # which the best list might be
                return all(self._search_without(left_out | {item}, reporter) for item in earlier.items)
        purchases = self._purchases(left_out)
        objectives = purchases.objectives
        outcome = solve(purchases.problem, objectives, self._settings, reporter, solved=self._solved)
        if outcome.status is Status.OPTIMAL and outcome.costs is not None:
            listed = self._bought_list(outcome, purchases)
            heappush(self._queue, (outcome.costs.key(levels(objectives)), len(self._seen), left_out, listed))
        if outcome.status is Status.FEASIBLE and not self._chosen_lists:
            self._chosen_lists.append(self._bought_list(outcome, purchases))
        return outcome.status in {Status.OPTIMAL, Status.INFEASIBLE}

    def _bought_list(self, outcome: Outcome, purchases: Purchases) -> _PricedList:
        """Split an outcome with purchases into the items bought and a tree or plan without purchases.

        The problem of this tree or plan has the items in its kitchen. Raises :class:`BugError` if it does not
        execute with them.
        """
        assert outcome.units is not None
        bought, units = purchases.split(outcome.units)
        problem = _with_bought_items(self._problem, bought)
        if problem.items is None:
            order = Postconditions(problem, levels(self._objectives), self._settings).require_executable(
                units
            )
        else:
            order = units
            lacking = counted_run(problem, order).lacking
            if lacking is not None:
                raise BugError(f"with what is bought, the plan {list(order)} lacks {lacking}")
        costs, proved = problem.costs(order), outcome.status is Status.OPTIMAL
        bounds = {by: costs.measure(by) for by in levels(self._objectives)} if proved else {}
        tree = outcome._replace(
            problem=problem,
            objectives=self._objectives,
            units=order,
            costs=costs,
            bounds=bounds,
            cuts=(),
            cases=None,
        )
        price = sum((self._wares[o] * copies for o, copies in bought.items()), Fraction(0))
        return _PricedList(bought, price, proved, tree)


def _lists_under_rules(
    prepared: Prepared,
    sold: Mapping[int, Fraction],
    second_choices: Collection[int],
    max_lists: int,
    compared: bool,
) -> _Lists:
    """Return the cheapest lists of ``sold`` wares under rules, by one run of clingo for each list.

    ``sold`` are prices by id of the node. Of equally cheap lists, clingo prefers those without
    ``second_choices``, which are mixtures and nodes that units make. An empty list is the last one, since
    nothing has to be bought. With ``compared``, there are up to 30 lists: further lists have the price of
    list number ``max_lists``, and the caller chooses by the trees. Raises :class:`UserError` for prices
    beyond 32 bits.
    """
    scale = math.lcm(*(price.denominator for price in sold.values()))
    if any(price * scale > INT32_MAX for price in sold.values()):
        raise UserError("prices this far apart do not fit clingo, whose numbers have 32 bits")
    prices = {o: int(price * scale) for o, price in sold.items()}
    facts = write_for_sale(prices, second_choices)
    encoding = question_encoding("shopping_list.lp")
    lists: list[_PricedList] = []
    while len(lists) < max_lists or (
        compared and len(lists) < _MAX_COMPARED and lists[-1].price == lists[max_lists - 1].price
    ):
        clingo_run = prepared.run(facts, encodings=(encoding,), predicates=[("_buy", 1)])
        if clingo_run.units is not None:
            items = tuple(sorted(clingo_run.atoms["_buy"]))
            price = sum((sold[o] for o in items), Fraction(0))
            lists.append(_PricedList(dict.fromkeys(items, 1), price, clingo_run.exhausted))
            facts += write_found_list(len(lists), items)
        if clingo_run.units is None or not clingo_run.exhausted:
            return _Lists(lists, clingo_run.exhausted)
        if not items:
            return _Lists(lists, complete=True)
    return _Lists(lists, complete=False)


def _price_as_decimal(number: Fraction) -> str:
    """Return a sum of decimals as a decimal: ``3.20`` for 16/5, ``3`` for 3.

    A number that six decimal places cannot hold is returned as a fraction.
    """
    for places in (0, 2, 3, 4, 5, 6):
        if (number * 10**places).denominator == 1:
            return f"{Decimal(number.numerator) / number.denominator:.{places}f}"
    return str(number)
