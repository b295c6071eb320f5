"""What it would take: the cheapest things to add to the kitchen so that there is a tree."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from enum import StrEnum
from fractions import Fraction
from os import PathLike
from pathlib import Path
from typing import NamedTuple

from foon_asp.asp import Reporter, Status, solve
from foon_asp.asp.assembly import assemble
from foon_asp.asp.prepared import Prepared, prepare
from foon_asp.asp.program import Program
from foon_asp.dataset.paths import File, Files
from foon_asp.deadline import Cancel
from foon_asp.document.json_document import costs_json, document, fraction_json, nodes_json
from foon_asp.encoding.facts import write_for_sale, write_list
from foon_asp.encoding.own_encodings import question_encoding
from foon_asp.errors import BugError, UserError
from foon_asp.network import ObjectNode, Source, counted
from foon_asp.problem import Costs, Number, Objective, Problem, exact, levels
from foon_asp.problem.dead_ends import Cause, dead_ends
from foon_asp.problem.progress import OnProgress
from foon_asp.problem.shop import Shop
from foon_asp.questions.answer import Answer, WithOutcome
from foon_asp.questions.arguments import Constants, Objectives, at_least, chosen_objectives, settings, whole
from foon_asp.questions.caller import caller
from foon_asp.questions.contract import TABLES, Kind, Option, question
from foon_asp.questions.options import HOW, TREE
from foon_asp.questions.result import Ending
from foon_asp.report.answer import answer_json, costs_text, goal_lines, headline, steps
from foon_asp.text.line import LineError
from foon_asp.text.line_parser import parse_node
from foon_asp.text.price_list import Price, read_prices


class Offer(StrEnum):
    """What lists are made of. The first offer from which any list can be made is taken.

    ``for sale``: what :class:`Shop` sells, without the dish. ``cycle``: also nodes that can only be made from
    each other. ``processed``: everything but the dish. ``dish``: everything but the goals. ``goal``:
    everything. ``priced``: what a price list has, and nothing else.
    """

    FOR_SALE = "for sale"
    CYCLE = "cycle"
    PROCESSED = "processed"
    DISH = "dish"
    GOAL = "goal"
    PRICED = "priced"


class ShoppingList(NamedTuple):
    """Object nodes to add to the kitchen, by id, and what they cost: their number or the sum of prices.

    ``proved`` says that no list is cheaper, among those that do not hold all of an earlier one. ``costs`` are
    those of the best tree with the things on this list, ``None`` where a limit came before.
    """

    items: tuple[int, ...]
    price: Fraction
    proved: bool
    costs: Costs | None = None


_COMPARED = 30  # lists of one price whose trees are compared, at most

_REMARKS = {
    Offer.CYCLE: "what is for sale is not enough: something from a cycle that feeds only itself is needed",
    Offer.PROCESSED: "what is for sale is not enough, so the list contains things that units would make",
    Offer.DISH: "nothing else is enough, so the list contains something with the name of the dish in it",
    Offer.GOAL: "nothing else is enough, so the goal itself has to be bought",
}


@dataclass(frozen=True, repr=False)
class Shopping(WithOutcome):
    """Lists of things to add to the kitchen, in order of cost, and the best tree with the first list.

    Among lists of one cost and one number of things, the one with the best tree comes first.

    ``problem`` and ``objectives`` are those asked about. Each of ``lists`` has its ``items`` by id, its
    ``price`` (their number, or the sum of prices), whether it is ``proved`` that none is cheaper, and the
    ``costs`` of its best tree; :attr:`items` are those of the first list as values. ``offer`` tells what the
    lists are made of. ``lists`` is empty if no list helps; ``complete`` tells whether the search ended, so
    that there are no more lists than these. ``outcome`` is the best tree with the first list in the kitchen,
    or ``None`` without a list. ``prices`` are those of a price list, or ``None`` if every node counts one.

    Example:
        >>> shopping = foon_asp.shopping_list(foon_asp.load().problem("hot cocoa"), lists=1)
        >>> [(str(found.price), found.proved) for found in shopping.lists]
        [('1', True)]
    """

    problem: Problem
    offer: Offer
    lists: tuple[ShoppingList, ...]
    complete: bool
    outcome: Answer | None
    prices: Mapping[int, Fraction] | None
    objectives: tuple[Objective, ...]

    @property
    def items(self) -> tuple[ObjectNode, ...]:
        """The things on the first list."""
        objects = self.problem.network.objects
        return tuple(objects[o] for o in self.lists[0].items) if self.lists else ()

    @property
    def ending(self) -> Ending:
        """Done when every list is proved, and the tree to be the best."""
        if not self.lists:
            return Ending.NEGATIVE if self.complete else Ending.LIMIT
        proved = all(found.proved for found in self.lists)
        solved = self.outcome is not None and self.outcome.status is Status.OPTIMAL
        return Ending.DONE if proved and solved else Ending.LIMIT

    def text(self) -> str:
        """Give the best list with what is known of each thing on it, the other lists, and the tree."""
        problem = self.problem
        lines = list(goal_lines(problem))
        if not self.lists:
            return "\n".join([*lines, *_none(self)]) + "\n"
        first, *others = self.lists
        if not first.items:
            lines.append(f"nothing has to be bought ({problem.conditions})")
        else:
            claim = "cheapest" if self.prices is not None else "shortest"
            proved = f"{claim}, proved" if first.proved else f"not proved {claim}"
            lines.append(f"shopping list ({problem.conditions}; {proved}): {_price(self, first)}")
            lines += [f"  {line}" for o in first.items for line in _item_lines(self, o)]
            if remark := _REMARKS.get(self.offer):
                lines.append(remark)
        for number, other in enumerate(others, 2):
            claim = "" if other.proved else ", not proved next"
            lines.append(f"or, list {number} ({_price(self, other)}{claim}), with {_costs(other)}:")
            lines += [f"  {problem.network.objects[o]}" for o in other.items]
        if first.items:
            lines.append(_others(self))
        if self.outcome is not None and self.outcome.units is not None:
            outcome = self.outcome
            lines += ["", f"with {'the first list' if others else 'it'}: {headline(outcome)}", ""]
            tree = "\n".join(steps(outcome.problem, outcome.units or (), first.items))
            lines.append(tree or "nothing to do")
        return "\n".join(lines) + "\n"

    def json_dict(self) -> object:
        """Give the lists and the answer that the first makes possible."""
        answer, bought = self.outcome, self.lists[0].items if self.lists else ()
        return document(
            "shopping-list",
            self.problem,
            self.objectives,
            offer=str(self.offer),
            lists=[
                {
                    "items": [_item_json(self, o) for o in found.items],
                    "price": fraction_json(found.price),
                    "proved": found.proved,
                    "costs": costs_json(found.costs),
                }
                for found in self.lists
            ],
            complete=self.complete,
            answer=None if answer is None else answer_json(answer, bought),
        )


@question(
    *TREE,
    Option(
        "prices",
        "A price list: lines of an object node, a tab and a price; only what has a price can be bought.",
        Kind.FILE,
    ),
    Option("lists", "How many lists to find, at most.", Kind.WHOLE, default=3, least=1),
    *HOW,
    formats=TABLES,
    help_="""
    \b
    foon-asp shopping-list --goal 'hot cocoa'
    foon-asp shopping-list --goal 'hot cocoa' --goal omelet --prices prices.txt

    For sale is what no unit makes, what is empty or clean, and what has no state and holds at most one
    ingredient, unless it is a product of some unit. The dish itself is proposed only if nothing else is
    enough. A line of a price list is an object node in one-line notation, or a label, then a tab and a price.
    Every list is proved to be the cheapest of those that do not contain all of an earlier one; among lists of
    one size, that with the best tree comes first.

    Exits with 0 when there is a list, proved; with 1 when no list helps, proved; with 3 when stopped at a
    limit.
    """,
)
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
    on_progress: OnProgress | None = None,
    cancel: Cancel | None = None,
) -> Shopping:
    """Find the fewest or cheapest object nodes to add to the kitchen so that a task tree exists.

    Every list is proved: there is no shorter or cheaper one, except those that contain all of an earlier
    list. Among lists of the same cost, one with fewer things comes first, then one with a better tree, then
    one with fewer mixtures and objects that units make. All of a store is read.

    Parameters:
        prices: The path of a price list, or prices by name; only what has a price can be bought. A label
            stands for all its nodes that would be for sale. Without prices, every node counts one.

    Returns:
        The ``lists``, the ``items`` of the first one, and the best tree with these as its ``outcome``.

    Raises:
        UserError: for a wrong argument or constraint, a price list that cannot be read, or a rule that says
            something else once the items are bought.

    Example:
        >>> shopping = foon_asp.shopping_list(foon_asp.load().problem("hot cocoa"))
        >>> print(*shopping.items)
        cocoa tin; contains {cocoa powder}
        >>> shopping.outcome.costs.units
        11
    """
    chosen = chosen_objectives(problem, objectives)
    how = settings(constraints, constants, encodings, time_limit, memory_limit)
    most = at_least(lists, 1, "lists")
    problem = whole(problem)
    by_id = None
    if prices is not None:
        listed = read_prices(Path(prices)) if isinstance(prices, str | PathLike) else _given(prices)
        by_id = _priced(problem, listed)
    deadline, reporter = how.begun, caller().reporter
    program = assemble(how, reporter.warning)
    found: list[ShoppingList] = []
    complete = True
    offer = Offer.FOR_SALE if by_id is None else Offer.PRICED
    try:
        with deadline.watched("looking for what is for sale"):
            shop = Shop(problem)
            offers = _offers(problem, shop, by_id)
        while not found and complete:
            with deadline.watched("looking for what is for sale"):
                following = next(offers, None)
            if following is None:
                break
            offer, wares = following
            first = prepare(problem, chosen, how, program, for_sale=wares)
            found, complete = _lists(first, shop, wares, most, chosen != (Objective.UNITS,))
    except KeyboardInterrupt:
        deadline.interrupt()
        complete = False
    outcomes: dict[ShoppingList, Answer] = {}
    for each in found:
        stocked = replace(problem, kitchen=problem.kitchen.union(each.items))
        who = Reporter() if outcomes else reporter
        outcome = Answer._make(solve(stocked, chosen, how, who))
        if outcome.status is Status.INFEASIBLE:
            _refuse_far_rules(program)
            raise BugError("the shopping list does not make a tree possible")
        outcomes[each._replace(costs=outcome.costs)] = outcome
    in_order = _in_order(outcomes, shop, chosen) if found else []
    complete = complete and len(in_order) <= most
    shown = tuple(in_order[:most])
    best = outcomes[shown[0]] if shown else None
    return Shopping(problem, offer, shown, complete, best, by_id, chosen)


def _in_order(
    outcomes: Mapping[ShoppingList, Answer], shop: Shop, objectives: tuple[Objective, ...]
) -> list[ShoppingList]:
    """Put lists in order: by price, by number, by what their best trees cost, if that is proved."""
    if any(outcome.status is not Status.OPTIMAL for outcome in outcomes.values()):
        return list(outcomes)
    order = levels(objectives)

    def key(found: ShoppingList) -> tuple[Fraction, int, tuple[int | Fraction, ...], int]:
        assert found.costs is not None
        second = sum(map(shop.is_second_choice, found.items))
        return found.price, len(found.items), tuple(found.costs.key(order)), second

    return sorted(outcomes, key=key)


def _refuse_far_rules(program: Program) -> None:
    """Raise :class:`UserError` for a rule that sees more units before it is settled what is bought."""
    for rule in program.understood.rules if program.understood else ():
        if rule.further:
            raise UserError(
                f"{rule.source}: {rule.further}, so what the rule says changes with the units that can be "
                "made, and these with what is bought: no shopping list can be found under it; let it look at "
                "units of the tree alone"
            )


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


def _priced(problem: Problem, listed: Sequence[Price]) -> dict[int, Fraction]:
    """Find the object nodes that a price list is about; one that matches none is warned of.

    A label alone stands for all of its nodes that would be for sale without prices.
    """
    network, shop = problem.network, Shop(problem)
    prices: dict[int, Fraction] = {}
    for entry in sorted(listed, key=lambda entry: not entry.label_alone):  # whole nodes have the last word
        if entry.label_alone:
            found = [o for o in network.by_label.get(entry.node.label, ()) if shop.sells(o)]
        else:
            known = network.object_id(entry.node)
            found = [] if known is None else [known]
        prices.update(dict.fromkeys(found, entry.price))
        if not found:
            what = "no node for sale has this label" if entry.label_alone else "no such object node"
            caller().reporter.warning(f"{entry.source}:{entry.source.column}: warning: {what}: {entry.node}")
    return prices


def _offers(
    problem: Problem, shop: Shop, prices: Mapping[int, Fraction] | None
) -> Iterator[tuple[Offer, dict[int, Fraction]]]:
    """Give what lists can be made of, each offer with more in it than the one before."""
    if prices is not None:
        yield Offer.PRICED, {o: price for o, price in prices.items() if o not in problem.kitchen}
        return
    one = Fraction(1)
    others = [o for o in range(len(problem.network.objects)) if o not in problem.kitchen]
    sold = [o for o in others if shop.sells(o)]
    yield Offer.FOR_SALE, {o: one for o in sold if not shop.is_dish(o)}
    roots = dead_ends(problem).roots
    cycles = {o for root in roots if root.cause is Cause.CYCLE and root.cycle for o in root.cycle.nodes}
    yield Offer.CYCLE, {o: one for o in dict.fromkeys([*sold, *sorted(cycles)]) if not shop.is_dish(o)}
    yield Offer.PROCESSED, {o: one for o in others if not shop.is_dish(o)}
    yield Offer.DISH, {o: one for o in others if o not in problem.goals}
    yield Offer.GOAL, dict.fromkeys(others, one)


def _lists(
    first: Prepared, shop: Shop, wares: Mapping[int, Fraction], most: int, compared: bool
) -> tuple[list[ShoppingList], bool]:
    """Find the cheapest lists from some wares, one run each; say whether there are no others.

    Where trees are to be ``compared`` by more than their size, all lists of the last price come along.
    """
    if first.tree is None:
        return [], not first.stopped
    problem = first.problem
    met = {*problem.goals, *(o for unit in first.units for o in problem.needs[unit])}
    scale = math.lcm(*(price.denominator for price in wares.values()))
    sold = {o: price for o, price in wares.items() if o in met}
    if any(price * scale >= 2**31 for price in sold.values()):
        raise UserError("prices this far apart do not fit clingo, whose numbers have 32 bits")
    prices = {o: int(price * scale) for o, price in sold.items()}
    more = write_for_sale(prices, filter(shop.is_second_choice, sold))
    encoding = question_encoding("shopping_list.lp")
    lists: list[ShoppingList] = []
    while len(lists) < most or (
        compared and len(lists) < _COMPARED and lists[-1].price == lists[most - 1].price
    ):
        ended = first.run(more, encodings=(encoding,), predicates=[("_buy", 1)])
        if ended.units is not None:
            items = tuple(sorted(ended.atoms["_buy"]))
            price = sum((wares[o] for o in items), Fraction(0))
            lists.append(ShoppingList(items, price, ended.exhausted))
            more += write_list(len(lists), items)
        if ended.units is None or not ended.exhausted:
            return lists, ended.exhausted
        if not items:
            return lists, True
    return lists, False


def _costs(found: ShoppingList) -> str:
    return "a tree that is not known" if found.costs is None else costs_text(found.costs)


def _others(shopping: Shopping) -> str:
    """Say what there is beside the lists shown."""
    if not shopping.complete:
        return "there are more lists than these: --lists finds more"
    these = "this list" if len(shopping.lists) == 1 else "one of these lists"
    return f"that is all: any other set of things on offer that makes a tree possible holds all of {these}"


def _none(shopping: Shopping) -> Sequence[str]:
    rule = shopping.problem.conditions
    if not shopping.complete:
        return [f"unknown: stopped at a limit before any list was found ({rule})"]
    if shopping.offer is Offer.PRICED:
        return [f"no list of things with a price makes a tree possible: proved ({rule})"]
    return [f"whatever is bought, the constraints leave no tree: proved ({rule})"]


def _item_lines(shopping: Shopping, o: int) -> Iterator[str]:
    network = shopping.problem.network
    price = "" if shopping.prices is None else f"    {_decimal(shopping.prices[o])}"
    yield f"{network.objects[o]}{price}"
    users = [unit for unit in network.consumers[o] if o in shopping.problem.needs[unit]]
    if shopping.outcome is not None and shopping.outcome.units is not None:
        used = [unit for unit in shopping.outcome.units if unit in users]
        places = ", ".join(f"{network.motions[unit]} [{network.sources[unit][0]}]" for unit in used)
        if places:
            yield f"    for {places}"


def _item_json(shopping: Shopping, o: int) -> object:
    price = Fraction(1) if shopping.prices is None else shopping.prices[o]
    return nodes_json(shopping.problem.network, [o])[0] | {"price": fraction_json(price)}


def _price(shopping: Shopping, found: ShoppingList) -> str:
    things = counted(len(found.items), "object node")
    return things if shopping.prices is None else f"{things} for {_decimal(found.price)}"


def _decimal(number: Fraction) -> str:
    """Give a sum of decimals as a decimal: ``3.20`` for 16/5, ``3`` for 3."""
    for places in range(7):
        if (number * 10**places).denominator == 1:
            shown = max(places, 2) if places else 0
            return f"{int(number * 10**shown) // 10**shown}" + (
                f".{int(number * 10**shown) % 10**shown:0{shown}d}" if shown else ""
            )
    return str(number)
