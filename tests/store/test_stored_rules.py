"""Questions under rules, asked of a store: the part that is read has the answers of the whole."""

import random
from collections.abc import Callable
from decimal import Decimal, localcontext
from pathlib import Path
from typing import Any

import pytest

import foon_asp
from foon_asp.problem import ContainerRule, Problem, levels
from foon_asp.store.store import Store
from tests.rules.test_restricted_answers import CLASSES, rules
from tests.rules.test_rules_in_questions import alternatives, library, pareto
from tests.store.test_store import import_problem
from tests.support.random_problems import random_problem

Rules = dict[str, Any]
Asked = Callable[[Problem, Rules], object]


def best(problem: Problem, rules: Rules) -> object:
    answer = foon_asp.solve(problem, "inputs,success", **rules)
    return answer.status, answer.costs and answer.costs.key(levels(answer.objectives))


def optima(problem: Problem, rules: Rules) -> object:
    found = foon_asp.alternatives(problem, "units", **rules)
    return found.complete, {frozenset(tree.ids) for tree in found.trees}


def assist(problem: Problem, rules: Rules) -> object:
    found = foon_asp.assist(problem, person={"pour": 1, "cut": 1}, **rules)
    return [(row.most, row.status, row.costs and row.costs.success) for row in found.rows]


def sensitivity(problem: Problem, rules: Rules) -> object:
    found = foon_asp.sensitivity(problem, **rules)
    ends = [(each.motion, each.below.at, each.above.at) for each in found.intervals]
    return found.answer.status, [each for each in ends if each[1:] != (None, None)]


def several_goals(problem: Problem, rules: Rules) -> object:
    data = foon_asp.Foon.of(problem)
    goals = sorted({*problem.goal_nodes, *data.nodes("dough"), *data.nodes("salt")}, key=str)[:3]
    if len(goals) < 2:
        return None
    found = foon_asp.solve(problem.vary(goals=goals), **rules)
    return found.status, found.costs and found.costs.units


def regret(problem: Problem, rules: Rules) -> object:
    found = foon_asp.regret(problem, "inputs", **rules)
    items = [each for each in found.regrets if each.item]
    return sorted((str(each.item), each.status, each.costs and each.costs.inputs) for each in items)


def posed(seed: int, folder: Path) -> tuple[Problem, Problem, Rules]:
    """Return a problem over a network that was read whole, and over a store, and rules for it."""
    drawn = random_problem(seed, list(ContainerRule)[seed % 2], units=10, readable=True)
    assert drawn.rates is not None
    store = import_problem(drawn, folder)
    rates = folder / "motion.txt"
    with localcontext(prec=400):
        rates.write_text(
            "".join(f"{m}\t{Decimal(r.numerator) / r.denominator:f}\n" for m, r in drawn.rates.items())
        )
    utensils = folder / "utensils.txt"
    utensils.write_text("".join(f"{label}\n" for label in sorted(drawn.utensils)))
    [text, part] = [
        foon_asp.load(file, kitchen=folder / "kitchen.txt", rates=rates, utensils=utensils).problem(
            *drawn.goal_nodes, containers=str(drawn.containers)
        )
        for file in (folder / "FOON.txt", store)
    ]
    rng = random.Random(f"stored {seed}")
    if rng.random() < 0.5:
        names, constants = library(rng, text)
        return text, part, {"constraints": names, "constants": constants}
    some = rules(seed, len(text.network), sorted(CLASSES))
    return text, part, {"constraints": [rule.text for rule in some]}


QUESTIONS: list[Asked] = [best, optima, alternatives, pareto, assist, sensitivity, regret, several_goals]


@pytest.mark.nightly
@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("seeds", [range(3), pytest.param(range(3, 300), marks=pytest.mark.nightly)])
def test_a_store_has_the_answers_of_the_whole(
    seeds: range, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    read: list[Store] = []
    read_whole = Store.read_whole

    def noted(store: Store) -> object:
        read.append(store)
        return read_whole(store)

    monkeypatch.setattr(Store, "read_whole", noted)
    asked = 0
    for seed in seeds:
        text, part, some = posed(seed, tmp_path)
        for ask in QUESTIONS if seed % 2 else QUESTIONS[:1]:
            for chosen in (some, {}) if ask is regret else (some,):
                assert ask(part, chosen) == ask(text, chosen), (seed, chosen)
            asked += 1
    assert len(read) < asked / 2
