"""Shopping lists, for people and for programs."""

import json
from collections.abc import Iterator, Sequence
from fractions import Fraction

from foon_asp.explain.shopping_list import Offer, Shopping, ShoppingList
from foon_asp.report.answer import counted, fraction_json, goal_lines, headline, outcome_dict, steps

_REMARKS = {
    Offer.CYCLE: "nothing that one can buy would do: some of a cycle that feeds only itself is needed",
    Offer.PROCESSED: "nothing that one can buy would do, so the list has things that units would make",
    Offer.DISH: "nothing else is left, so the list has something that bears or holds the name of the dish",
    Offer.GOAL: "nothing else is left but to buy what was asked for",
}


def shopping_text(shopping: Shopping) -> str:
    """Give the best list with what is known of each thing on it, the other lists, and the tree."""
    problem = shopping.problem
    lines = list(goal_lines(problem))
    if not shopping.lists:
        return "\n".join([*lines, *_none(shopping)]) + "\n"
    first, *others = shopping.lists
    if not first.items:
        lines.append(f"nothing has to be bought ({problem.conditions})")
    else:
        claim = "cheapest" if shopping.prices is not None else "shortest"
        proved = f"{claim}, proved" if first.proved else f"not proved {claim}"
        lines.append(f"shopping list ({problem.conditions}; {proved}): {_price(shopping, first)}")
        lines += [f"  {line}" for o in first.items for line in _item_lines(shopping, o)]
        if remark := _REMARKS.get(shopping.offer):
            lines.append(remark)
    for number, other in enumerate(others, 2):
        claim = "" if other.proved else ", not proved next"
        lines.append(f"or, list {number} ({_price(shopping, other)}{claim}):")
        lines += [f"  {problem.network.objects[o]}" for o in other.items]
    if first.items and shopping.complete:
        lines.append("any other list holds all of one above")
    if shopping.outcome is not None and shopping.outcome.units is not None:
        outcome = shopping.outcome
        lines += ["", f"with {'the first list' if others else 'it'}: {headline(outcome)}", ""]
        tree = "\n".join(steps(outcome.problem, outcome.units or (), first.items))
        lines.append(tree or "nothing to do")
    return "\n".join(lines) + "\n"


def shopping_json(shopping: Shopping) -> str:
    """Give the lists and the answer that the first makes possible."""
    problem = shopping.problem
    objects = problem.network.objects
    return (
        json.dumps(
            {
                "goals": [str(objects[goal]) for goal in problem.goals],
                "containers": str(problem.containers),
                "level": problem.network.level,
                "offer": str(shopping.offer),
                "lists": [
                    {
                        "items": [_item_json(shopping, o) for o in found.items],
                        "price": fraction_json(found.price),
                        "proved": found.proved,
                    }
                    for found in shopping.lists
                ],
                "complete": shopping.complete,
                "answer": None if shopping.outcome is None else outcome_dict(shopping.outcome),
            },
            indent=2,
            ensure_ascii=False,
        )
        + "\n"
    )


def _none(shopping: Shopping) -> Sequence[str]:
    rule = shopping.problem.conditions
    if not shopping.complete:
        return [f"unknown: stopped at a limit before any list was found ({rule})"]
    if shopping.offer is Offer.PRICED:
        return [f"no list of things with a price makes a tree possible: proved ({rule})"]
    return [f"whatever is bought, the constraints leave no tree: proved ({rule})"]


def _item_lines(shopping: Shopping, o: int) -> Iterator[str]:
    network = shopping.problem.network
    price = "" if shopping.prices is None else f"    {decimal(shopping.prices[o])}"
    yield f"{network.objects[o]}{price}"
    users = [unit for unit in network.consumers[o] if o in shopping.problem.needs[unit]]
    if shopping.outcome is not None and shopping.outcome.units is not None:
        used = [unit for unit in shopping.outcome.units if unit in users]
        places = ", ".join(f"{network.motions[unit]} [{network.sources[unit][0]}]" for unit in used)
        if places:
            yield f"    for {places}"


def _item_json(shopping: Shopping, o: int) -> dict[str, object]:
    network = shopping.problem.network
    price = Fraction(1) if shopping.prices is None else shopping.prices[o]
    return {"id": o, "object": str(network.objects[o]), "price": fraction_json(price)}


def _price(shopping: Shopping, found: ShoppingList) -> str:
    things = counted(len(found.items), "object node")
    return things if shopping.prices is None else f"{things} for {decimal(found.price)}"


def decimal(number: Fraction) -> str:
    """Give a sum of decimals as a decimal: ``3.20`` for 16/5, ``3`` for 3."""
    for places in range(7):
        if (number * 10**places).denominator == 1:
            shown = max(places, 2) if places else 0
            return f"{int(number * 10**shown) // 10**shown}" + (
                f".{int(number * 10**shown) % 10**shown:0{shown}d}" if shown else ""
            )
    return str(number)
