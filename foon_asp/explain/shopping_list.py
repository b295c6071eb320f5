"""What it would take: the cheapest things to add to the kitchen so that there is a tree."""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from enum import StrEnum
from fractions import Fraction
from typing import NamedTuple

from foon_asp.asp import Outcome, Reporter, Settings, Status, solve
from foon_asp.asp.exact_success import problem_scale
from foon_asp.asp.facts import write_facts, write_for_sale, write_list
from foon_asp.asp.own_encodings import question_encoding
from foon_asp.asp.program import Program, assemble
from foon_asp.asp.search import run
from foon_asp.deadline import Deadline
from foon_asp.errors import BugError, UserError
from foon_asp.problem import Objective, Problem, reach, relevant
from foon_asp.problem.dead_ends import Cause, dead_ends
from foon_asp.problem.shop import Shop
from foon_asp.text import Price


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

    ``proved`` says that no list is cheaper, among those that do not hold all of an earlier one.
    """

    items: tuple[int, ...]
    price: Fraction
    proved: bool


class Shopping(NamedTuple):
    """The answer: lists in order of cost, and the tree that the first makes possible.

    ``lists`` is empty where no list helps; ``complete`` says that the search ended, so that there is none, or
    that there are no more lists than these. ``outcome`` is the best tree once the first list is in the
    kitchen. ``prices`` are those of a price list, ``None`` where every node counts one.
    """

    problem: Problem
    offer: Offer
    lists: tuple[ShoppingList, ...]
    complete: bool
    outcome: Outcome | None
    prices: Mapping[int, Fraction] | None


def shopping_list(
    problem: Problem,
    objectives: Sequence[Objective] = (Objective.UNITS,),
    settings: Settings | None = None,
    prices: Mapping[int, Fraction] | None = None,
    most: int = 3,
    reporter: Reporter | None = None,
) -> Shopping:
    """Find the cheapest lists, at most so many, and prove each: no list that could stand there is cheaper.

    Without ``prices`` (by object node id) every node counts one. Of lists that cost the same, one with fewer
    second choices (:meth:`Shop.is_second_choice`) comes first, then one with a smaller tree. The tree that
    results is the best by ``objectives``. Constraints hold for it. Raises :class:`UserError` like
    :func:`foon_asp.asp.solve`.
    """
    settings, reporter = (settings or Settings()).limited(), reporter or Reporter()
    deadline = settings.begun
    program = assemble(settings, reporter.warning)
    lists: list[ShoppingList] = []
    complete = True
    offer = Offer.FOR_SALE if prices is None else Offer.PRICED
    try:
        with deadline.watched("looking for what is for sale"):
            shop = Shop(problem)
            offers = _offers(problem, shop, prices)
        while not lists and complete:
            with deadline.watched("looking for what is for sale"):
                following = next(offers, None)
            if following is None:
                break
            offer, wares = following
            lists, complete = _lists(problem, shop, wares, program, deadline, most)
    except KeyboardInterrupt:
        deadline.interrupt()
        complete = False
    outcome = None
    if lists:
        stocked = replace(problem, kitchen=problem.kitchen.union(lists[0].items))
        outcome = solve(stocked, objectives, settings, reporter)
        if outcome.status is Status.INFEASIBLE:
            raise BugError("the shopping list does not make a tree possible")
    return Shopping(problem, offer, tuple(lists), complete, outcome, prices)


def priced(problem: Problem, listed: Sequence[Price], warn: Callable[[str], None]) -> dict[int, Fraction]:
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
            what = "no node that one can buy has this label" if entry.label_alone else "no such object node"
            warn(f"{entry.source}:{entry.source.column}: warning: {what}: {entry.node}")
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
    problem: Problem,
    shop: Shop,
    wares: Mapping[int, Fraction],
    program: Program,
    deadline: Deadline,
    most: int,
) -> tuple[list[ShoppingList], bool]:
    """Find the cheapest lists from some wares, one run each; say whether there are no others."""
    with deadline.watched("cutting the network"):
        stocked = replace(problem, kitchen=problem.kitchen.union(wares))
        reached = reach(stocked)
        if not all(reached.available[goal] for goal in problem.goals):
            return [], True
        # backwards with the kitchen as it is: what is for sale may also be made
        units = relevant(problem, reached) if program.own else tuple(sorted(reached.units))
        met = {*problem.goals, *(o for unit in units for o in problem.needs[unit])}
        scale = math.lcm(*(price.denominator for price in wares.values()))
        rates = None if problem.rates is None or program.own else problem_scale(problem, units)
        sold = {o: price for o, price in wares.items() if o in met}
        if any(price * scale >= 2**31 for price in sold.values()):
            raise UserError("prices this far apart do not fit clingo, whose numbers have 32 bits")
        facts = write_facts(problem, units, rates, with_sources=not program.own) + write_for_sale(
            {o: int(price * scale) for o, price in sold.items()}, filter(shop.is_second_choice, sold)
        )
    files = (*program.files, question_encoding("shopping_list.lp"))
    lists: list[ShoppingList] = []
    while len(lists) < most:
        ended = run(
            files, facts, program.arguments, deadline, predicates=[("_buy", 1)], endless=program.endless
        )
        if ended.units is not None:
            items = tuple(sorted(ended.atoms["_buy"]))
            price = sum((wares[o] for o in items), Fraction(0))
            lists.append(ShoppingList(items, price, ended.exhausted))
            facts += write_list(len(lists), items)
        if ended.units is None or not ended.exhausted:
            return lists, ended.exhausted
        if not items:
            return lists, True
    return lists, False
