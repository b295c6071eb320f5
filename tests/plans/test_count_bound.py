"""Whole counts of executions: what they prove of small flows, and every plan up to a length."""

import math
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from itertools import product
from random import Random

import pytest

from foon_asp.plans import count_bound
from foon_asp.plans.conditions import Counts, Level, Measure, SumLimit
from foon_asp.plans.count_bound import BetterError, CountBound
from foon_asp.plans.flows import Flows
from foon_asp.plans.tuning import PLANS
from foon_asp.plans.whole_program import Solved, Stopped, WholeProgram

_LONGEST = 4


Key = tuple[tuple[int, int], ...]


def plans(made: Flows) -> Iterator[tuple[Key, int]]:
    """Return every plan up to a length: how often it executes what, and what it takes of stock and items."""
    for length in range(_LONGEST + 1):
        for order in product(range(len(made.asks)), repeat=length):
            taken = executed(made, order)
            if taken is not None:
                items = {o for a in order for o in made.items[a]}
                yield tuple(sorted(Counter(order).items())), taken + len(items)


def executed(made: Flows, order: Sequence[int]) -> int | None:
    """Execute actions one by one, and give how many copies they cannot do without; ``None`` if they fail."""
    copies, untouched = Counter(made.start), Counter(made.start)
    for asked, action in (*((made.asks[a], a) for a in order), (made.targets, None)):
        for o in asked:
            if not copies[o]:
                return None
            untouched[o] = min(untouched[o], copies[o] - 1)
        if action is not None:
            copies.subtract(made.uses[action])
            copies.update(made.adds[action])
    return sum(made.start.values()) - untouched.total()


def flows_of(
    asks: Sequence[Sequence[int]],
    uses: Sequence[Sequence[int]],
    adds: Sequence[Sequence[int]],
    items: Sequence[Sequence[int]],
    start: Mapping[int, int],
    targets: Sequence[int],
) -> Flows:
    """Return flows in which an object counts as often as it is listed."""
    asked, used, added = (list(map(Counter, side)) for side in (asks, uses, adds))
    return Flows(asked, used, added, items, start, Counter(targets))


def random_flows(choose: Random) -> Flows:
    objects, actions = range(choose.randint(2, 4)), range(choose.randint(2, 4))
    asks = [choose.sample(objects, choose.randint(0, 2)) for _ in actions]
    return flows_of(
        asks,
        [[o for o in asked if choose.random() < 0.6] for asked in asks],
        [[o for o in choose.sample(objects, choose.randint(1, 2)) if o not in asked] for asked in asks],
        [choose.sample(range(100, 103), choose.randint(0, 2)) for _ in actions],
        {o: choose.randint(0, 2) for o in objects if choose.random() < 0.4},
        choose.sample(objects, choose.randint(1, 2)),
    )


def possible(made: Flows) -> list[tuple[Counts, int]]:
    """Return all counts that a plan may have, up to a length, and what it takes of stock and items at least.

    No more is used up than there is and is made, and if nothing were used up, all that is executed could be
    and would reach the targets.
    """
    found = []
    stock = [o for o, n in made.start.items() if n]
    for times in product(range(_LONGEST + 1), repeat=len(made.asks)):
        if sum(times) > _LONGEST:
            continue
        counts = {a: n for a, n in enumerate(times) if n}
        least = min(
            (
                sum(taken)
                for taken in product(*(range(made.start[o] + 1) for o in stock))
                if _holds(made, counts, dict(zip(stock, taken, strict=True)))
            ),
            default=None,
        )
        if least is not None:
            found.append((counts, least + len({o for a in counts for o in made.items[a]})))
    return found


def cost_of(measure: Measure, counts: Counts, taken: int) -> Fraction:
    if measure.exact is not None:
        return measure.exact(counts)
    return Fraction(sum(measure.costs[a] * n for a, n in counts.items()) + measure.item * taken)


def _holds(made: Flows, counts: Counts, there: dict[int, int]) -> bool:
    copies = Counter(there)
    for a, n in counts.items():
        copies.update(dict.fromkeys(made.adds[a], n))
        copies.subtract(dict.fromkeys(made.uses[a], n))
    reached, waiting = {o for o, n in there.items() if n}, set(counts)
    while ready := {a for a in waiting if reached.issuperset(made.asks[a])}:
        waiting -= ready
        reached.update(o for a in ready for o in made.adds[a])
    balanced = all(n >= (o in made.targets) for o, n in copies.items())
    return balanced and not waiting and reached.issuperset(made.targets)


def random_measure(choose: Random, actions: int) -> Measure:
    """Return a measure with costs of at least 1, in whole numbers or rounded down to halves."""
    if choose.random() < 0.6:
        return Measure([choose.randint(1, 3) for _ in range(actions)], choose.choice((0, 0, 1)))
    exact = [
        choose.choice([Fraction(1), Fraction(4, 3), Fraction(5, 4), Fraction(5, 2)]) for _ in range(actions)
    ]
    kinds = sorted(set(exact))

    def total(counts: Mapping[int, int]) -> Fraction:
        return sum((exact[a] * n for a, n in counts.items()), Fraction(0))

    return Measure([int(2 * cost) for cost in exact], 0, total, list(map(kinds.index, exact)))


def level_of(measure: Measure, cost: Fraction) -> Level:
    return Level(measure, cost, int(cost) if measure.exact is None else int(2 * cost))


UNITS = Measure([1, 1, 1])


def flows(*actions: str, start: dict[int, int] | None = None, targets: tuple[int, ...] = (0,)) -> Flows:
    """Write an action as what it asks for and what it adds; a star is what stays, from 100 on are items."""
    asks: list[list[int]] = []
    uses: list[list[int]] = []
    adds: list[list[int]] = []
    items: list[list[int]] = []
    for action in actions:
        before, _, after = action.partition(">")
        words = before.split()
        asks.append([int(word.strip("*")) for word in words if int(word.strip("*")) < 100])
        uses.append([int(word) for word in words if "*" not in word and int(word) < 100])
        items.append([int(word) for word in words if "*" not in word and int(word) >= 100])
        adds.append([int(word) for word in after.split()])
    return flows_of(asks, uses, adds, items, start or {}, targets)


def proves(bound: CountBound, *levels: Level) -> list[Counts]:
    """Return the counts that had to be asked for, none of which is better, until the proof was there."""
    asked: list[Counts] = []

    def is_better(counts: Counts) -> bool:
        asked.append(counts)
        return False

    bound.prove(levels, is_better)
    return asked


def whole(measure: Measure, cost: int) -> Level:
    return Level(measure, Fraction(cost), cost)


def better(bound: CountBound, *levels: Level) -> Counts:
    """Return the first counts that would be better."""
    with pytest.raises(BetterError, match="a better plan was found") as error:
        bound.prove(levels, lambda _: True)
    return error.value.counts


# 0 washes knives (4 of them, say, are dirty), 1 and 2 cut with one
def test_what_is_used_up_has_to_be_made_each_time() -> None:
    cutting = flows(">3", "3>0", "3>1", targets=(0, 1))
    bound = CountBound(cutting)
    assert bound.cheapest_counts([UNITS]) == {0: 2, 1: 1, 2: 1}
    assert not bound.is_infeasible()
    assert proves(bound, whole(UNITS, 4)) == []
    assert better(bound, whole(UNITS, 5)) == {0: 2, 1: 1, 2: 1}
    assert bound.proved <= 4
    assert better(bound, Level(UNITS, Fraction(9, 2), 4)) == {0: 2, 1: 1, 2: 1}
    assert len(proves(bound, whole(UNITS, 6))) == 2  # and one with a knife too many, which no order has
    assert bound.proved == 5
    keeping = CountBound(flows(">3", "3*>0", "3*>1", targets=(0, 1)))
    assert keeping.cheapest_counts([UNITS], rounds=1) == {0: 1, 1: 1, 2: 1}
    assert proves(keeping, whole(UNITS, 3)) == []
    assert better(keeping, whole(UNITS, 4)) == {0: 1, 1: 1, 2: 1}


def test_what_is_there_at_first_need_not_be_made() -> None:
    for knives, counts in ((1, {0: 1, 1: 1, 2: 1}), (2, {1: 1, 2: 1}), (3, {1: 1, 2: 1})):
        bound = CountBound(flows(">3", "3>0", "3>1", start={3: knives}, targets=(0, 1)))
        assert bound.cheapest_counts([UNITS]) == counts
        assert proves(bound, whole(UNITS, sum(counts.values()))) == []
        assert better(bound, whole(UNITS, sum(counts.values()) + 1)) == counts
    there = CountBound(flows(">0", "100>0", "101>0", start={0: 1}))
    assert there.cheapest_counts([UNITS]) == {}
    assert proves(there, whole(UNITS, 0)) == []


def test_copies_and_items_that_are_taken_are_paid_once_each() -> None:
    cutting = flows("100>3", "100 3>0", "3>1", start={3: 2}, targets=(0, 1))
    for item, counts, cost in ((1, {1: 1, 2: 1}, 5), (3, {0: 2, 1: 1, 2: 1}, 9)):
        measure = Measure([2, 1, 1], item)
        bound = CountBound(cutting)
        assert bound.cheapest_counts([measure]) == counts
        assert proves(bound, whole(measure, cost)) == []
        assert better(bound, whole(measure, cost + 1)) == counts
    circle = flows("1*>0", "0*>1", start={1: 1})
    measure = Measure([1, 1], 3)
    bound = CountBound(circle)
    assert bound.cheapest_counts([measure]) == {0: 1}
    assert not bound.is_infeasible()  # also where copies are not counted
    assert proves(CountBound(circle), whole(measure, 4)) == []
    assert better(CountBound(circle), whole(measure, 5)) == {0: 1}
    reading = flows("3*>0", "3*>1", start={3: 2}, targets=(0, 1))
    measure = Measure([0, 0], 1)
    assert proves(CountBound(reading), whole(measure, 1)) == []  # one copy is enough
    assert better(CountBound(reading), whole(measure, 2)) == {0: 1, 1: 1}


def test_a_circle_does_not_make_itself() -> None:
    circle = CountBound(flows("1*>0", "0*>1"))
    assert circle.is_infeasible()
    assert circle.cheapest_counts([UNITS]) is None
    costs = Measure([1, 1, 5])
    bound = CountBound(flows("1*>0", "0*>1", ">0"))
    assert bound.is_infeasible() is False
    assert bound.cheapest_counts([costs]) == {2: 1}
    assert proves(bound, whole(costs, 5)) == []
    assert better(bound, whole(costs, 6)) == {2: 1}
    used_up = CountBound(flows("1>0", "0>1"))
    assert used_up.is_infeasible()


def test_some_action_of_each_set_is_asked_for() -> None:
    ways = flows(">0", "100>0", "101>0")
    costs = Measure([1, 3, 2])
    assert CountBound(ways).cheapest_counts([costs]) == {0: 1}
    bound = CountBound(ways, [[1, 2]])
    assert bound.cheapest_counts([costs]) == {2: 1}
    assert proves(bound, whole(costs, 2)) == []
    assert CountBound(ways, [[1], [2]]).cheapest_counts([costs]) == {1: 1, 2: 1}


def test_a_level_counts_only_where_those_before_are_as_good() -> None:
    ways = flows(">0", "100>0", "101>0")
    first, second = Measure([1, 1, 2]), Measure([3, 2, 1])
    bound = CountBound(ways)
    assert bound.cheapest_counts([first, second]) == {1: 1}
    assert proves(bound, whole(first, 1), whole(second, 2)) == []
    assert proves(bound, whole(first, 1), whole(second, 4)) == [{1: 1}, {0: 1}]
    assert bound.proved <= 1  # what is proved of the second level is no bound on the first
    assert better(bound, whole(first, 1), whole(second, 3)) == {1: 1}
    assert better(bound, whole(first, 2), whole(second, 0)) in ({0: 1}, {1: 1})


def test_costs_that_are_rounded_down_are_weighed_as_they_are() -> None:
    exact = [Fraction(3, 2), Fraction(4, 3), Fraction(1)]

    def total(counts: Mapping[int, int]) -> Fraction:
        return sum((exact[a] * n for a, n in counts.items()), Fraction(0))

    measure = Measure([1, 1, 1], 0, total, [1, 0, -1])
    ways = flows(">0", ">0", "0>1", targets=(1,))
    asked = proves(CountBound(ways), Level(measure, Fraction(7, 3), 2))
    assert asked == []
    found = better(CountBound(ways), Level(measure, Fraction(5, 2), 2))
    assert found == {1: 1, 2: 1}


def test_what_is_cheaper_and_too_much_as_it_is_hides_nothing() -> None:
    def total(counts: Mapping[int, int]) -> Fraction:
        return Fraction(3, 2) * (counts.get(0, 0) + counts.get(1, 0))

    level, asked = Level(Measure([1, 1, 0], 0, total, [0, 0, -1]), Fraction(2), 2), list[Counts]()
    CountBound(flows(">0", ">3", "3 3>0"), levels=[level]).visit_counts(
        [whole(Measure([3, 1, 0]), 3)], asked.append
    )
    assert asked == [{0: 1}]


def test_what_costs_nothing_may_be_executed_as_often_as_wanted() -> None:
    bound = CountBound(flows(">3", "3>0", "3>1", targets=(0, 1)))
    free = Measure([0, 1, 1])
    assert bound.cheapest_counts([free, UNITS]) == {0: 2, 1: 1, 2: 1}
    assert proves(bound, whole(free, 2)) == []
    assert better(bound, whole(free, 3), whole(UNITS, 4)).keys() == {0, 1, 2}


def test_how_often_a_plan_as_good_can_execute_each_action() -> None:
    cutting = flows(">3", "3>0", "3>1", targets=(0, 1))
    assert CountBound(cutting).max_counts(whole(UNITS, 4)) == [2, 1, 1]
    assert CountBound(cutting).max_counts(whole(UNITS, 5)) == [3, 1, 1]
    assert CountBound(cutting).max_counts(whole(Measure([0, 1, 1]), 3)) == [None, 2, 2]
    reading = flows(">3", "3*>0", "3*>1", targets=(0, 1))
    assert CountBound(reading).max_counts(whole(UNITS, 4)) == [2, 2, 2]  # one execution more, of any
    with pytest.raises(Stopped):
        CountBound(cutting, expired=lambda: True).max_counts(whole(UNITS, 4))


def test_it_stops_when_time_is_up() -> None:
    bound = CountBound(flows("1*>0", "0*>1", ">0"), expired=lambda: True)
    for ask in (
        bound.is_infeasible,
        lambda: bound.cheapest_counts([UNITS]),
        lambda: bound.prove([whole(UNITS, 1)], bool),
    ):
        with pytest.raises(Stopped):
            ask()
    asked: list[Counts] = []

    def is_better(counts: Counts) -> bool:
        asked.append(counts)
        return False

    bound = CountBound(flows(">3", "3>0", "3>1", targets=(0, 1)), expired=lambda: bool(asked))
    with pytest.raises(Stopped):
        bound.prove([whole(UNITS, 9)], is_better)
    assert len(asked) == 1


def test_it_stops_after_many_parts_and_where_floats_lead_nowhere(monkeypatch: pytest.MonkeyPatch) -> None:
    costs = Measure([1])
    assert proves(CountBound(flows(">0")), whole(costs, 4)) == [{0: 1}, {0: 2}, {0: 3}]
    monkeypatch.setattr(count_bound, "PLANS", PLANS._replace(nodes=2, equation_nodes=0))
    with pytest.raises(Stopped):
        proves(CountBound(flows(">0")), whole(costs, 4))
    monkeypatch.setattr(WholeProgram, "solve", lambda *_: Solved(None, -math.inf))
    assert not CountBound(flows("0*>0")).is_infeasible()
    with pytest.raises(Stopped):
        proves(CountBound(flows(">0")), whole(costs, 1))


def test_how_many_executions_there_can_be_in_all() -> None:
    limited = flows("3>0", "3>1", start={3: 4})
    assert CountBound(limited).max_executions() == 4
    assert CountBound(limited, (), [({0: 2, 1: 2}, 5, False, False)]).max_executions() == 2
    assert CountBound(flows(">0")).max_executions() is None
    assert CountBound(limited, (), [({0: 1}, 5, True, False)]).max_executions() is None  # no plan at all


def test_more_than_a_few_executions_are_found_as_well() -> None:
    eggs = flows(">3", *(f"3>{n}" for n in range(10, 22)), targets=tuple(range(10, 22)))
    for actions in ((), range(13)):
        bound = CountBound(eggs, derivation=actions)
        assert bound.cheapest_counts([Measure([1] * 13)]) == {0: 12, **dict.fromkeys(range(1, 13), 1)}


def test_counts_that_are_found_are_not_those_of_a_known_plan() -> None:
    ways = flows(">0", ">1", "100>0", targets=(0, 1))
    # that each is executed a little would do if it were not asked whether it is executed at all
    assert CountBound(ways, excluded_counts=[{0: 1, 1: 1}]).cheapest_counts([UNITS]) == {1: 1, 2: 1}
    assert CountBound(ways).cheapest_counts([Measure([1, 1, 2])]) == {0: 1, 1: 1}


def test_it_is_proved_that_there_is_no_plan(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[Counts] = []

    def is_better(counts: Counts) -> bool:
        asked.append(counts)
        return len(asked) == 9

    bound = CountBound(flows("3>0", "3>1", start={3: 2}))
    bound.prove_infeasible(Measure([1, 1]), is_better)
    assert (asked[0], sorted(map(sorted, map(dict.items, asked)))) == (
        {0: 1},  # the fewest first
        [[(0, 1)], [(0, 1), (1, 1)], [(0, 2)]],
    )
    assert bound.proved == 0  # what is proved is of another measure
    for found in (bound, CountBound(flows(">0"))):  # as often as wanted
        with pytest.raises(BetterError):
            found.prove_infeasible(Measure([1, 1]), lambda _: True)
    CountBound(flows("1>0", ">2")).prove_infeasible(Measure([1, 1]), is_better)
    asked.clear()
    monkeypatch.setattr(count_bound, "PLANS", PLANS._replace(uncapped_nodes=5))
    with pytest.raises(Stopped):
        CountBound(flows(">0", ">2", targets=(0, 2))).prove_infeasible(Measure([1, 1]), is_better)
    assert asked[0] == {0: 1, 1: 1}


def within(limits: Sequence[SumLimit], counts: Counts) -> bool:
    """Whether counts keep to limits."""
    sums = [
        (sum(w * (a in counts if used else counts.get(a, 0)) for a, w in weights.items()), bound, least)
        for weights, bound, least, used in limits
    ]
    return all(total >= bound if least else total <= bound for total, bound, least in sums)


def hold(made: Flows, first: Level, second: Level | None = None, limits: Sequence[SumLimit] = ()) -> None:
    """Hold what is asked for in the course of a proof against all that there is."""
    known = [(c, taken) for c, taken in possible(made) if within(limits, c)]
    as_good = [c for c, taken in known if cost_of(first.measure, c, taken) <= first.cost]
    caps = CountBound(made, (), limits).max_counts(first) if as_good else []
    for action, most in enumerate(caps):
        assert most is None or most >= max(counts.get(action, 0) for counts in as_good)
    better = [c for c, taken in known if cost_of(first.measure, c, taken) < first.cost]
    levels = [first]
    if second is not None:
        levels.append(second)
        better += [
            c
            for c, taken in known
            if cost_of(first.measure, c, taken) <= first.cost
            and cost_of(second.measure, c, taken) < second.cost
        ]
    for derivation in ((), runnable(made)):
        bound = CountBound(made, (), limits, derivation)
        if as_good:
            found = bound.cheapest_counts([first.measure])
            assert found is not None
            assert sum(first.measure.costs[a] * n for a, n in found.items()) <= first.max_cost
        asked = proves(bound, *levels)
        assert sorted(sorted(c.items()) for c in asked) == sorted(sorted(c.items()) for c in better)


def runnable(made: Flows) -> list[int]:
    """Return all actions that can be executed if nothing is used up."""
    reached, found = {o for o, n in made.start.items() if n}, list[int]()
    while ready := [a for a, asked in enumerate(made.asks) if a not in found and reached.issuperset(asked)]:
        found += ready
        reached.update(o for a in ready for o in made.adds[a])
    return sorted(found)


def random_limit(choose: Random, actions: int) -> SumLimit:
    weights = {a: choose.randint(1, 2) for a in range(actions) if choose.random() < 0.6}
    return weights, choose.randint(0, 3), choose.random() < 0.4, choose.random() < 0.4


@pytest.mark.parametrize("seed", range(8))
def test_all_counts_that_may_be_better_are_asked_for_and_no_others(seed: int) -> None:
    choose = Random(seed)
    for _ in range(10):
        made = random_flows(choose)
        first, second = (random_measure(choose, len(made.asks)) for _ in range(2))
        some, other = Fraction(choose.randint(1, _LONGEST + 1)), Fraction(choose.randint(1, 9))
        limits = [random_limit(choose, len(made.asks)) for _ in range(choose.choice((0, 0, 1, 2)))]
        if CountBound(made).is_infeasible():
            assert not possible(made)
        elif some > _LONGEST:
            hold(made, level_of(first, some), None, limits)
        else:
            hold(made, level_of(first, some), level_of(second, other), limits)


@pytest.mark.parametrize("seed", range(6))
def test_all_that_is_as_good_and_not_known_is_asked_for(seed: int) -> None:
    choose, some = Random(seed), 0
    while some < 8:
        made = random_flows(choose)
        size = len(made.asks)
        known = possible(made)
        if len(known) < 4:
            continue
        some += 1
        first, second = (random_measure(choose, size) for _ in range(2))
        limit = level_of(second, Fraction(choose.randint(4, 18), 2))
        if limit.measure.exact is not None and choose.random() < 0.5:
            limit = limit._replace(strict=True)
        last = whole(Measure([choose.randint(1, 2) for _ in range(size)]), choose.randint(2, _LONGEST))
        levels = [level_of(first, Fraction(choose.randint(4, 18), 2)), last]
        beside = [counts for counts, _ in choose.sample(known, choose.randint(0, 3)) if counts]
        as_good = [
            counts
            for counts, taken in known
            if all(cost_of(each.measure, counts, taken) <= each.cost for each in (*levels, limit))
            and not (limit.strict and cost_of(second, counts, taken) == limit.cost)
            and not any(all(counts.get(a, 0) >= n for a, n in each.items()) for each in beside)
        ]
        asked: list[Counts] = []
        derivation = choose.choice(((), runnable(made)))
        CountBound(made, (), (), derivation, [limit], beside).visit_counts(levels, asked.append)
        assert sorted(sorted(c.items()) for c in asked) == sorted(sorted(c.items()) for c in as_good)


def test_a_circle_that_is_met_later_is_left_out_as_well() -> None:
    hold(flows(">0", "2*>1", "1*>2", "1*>0"), whole(Measure([1, 1, 1, 1]), 5))
    hold(flows(">0", "2*>1", "1*>2", "1*>3", "3 >0"), whole(Measure([1, 1, 1, 1, 1]), 5))
    hold(flows("1*>0", "0*>1", ">1", start={1: 0}), whole(UNITS, 5))
    hold(flows(">0", "4* 2*>1", "1*>2", ">2", start={4: 1}), whole(Measure([1, 1, 1, 1]), 5))
    hold(flows("4 1*>0", "0*>1", ">1", start={4: 2}), whole(UNITS, 5))
    hold(flows("100>0", "2*>1", "1*>2", "1*>0", start={2: 1}), whole(Measure([1, 1, 1, 1], 1), 5))


def test_every_plan_has_counts_that_are_asked_for() -> None:
    choose = Random(2)
    for _ in range(20):
        made = random_flows(choose)
        known = {tuple(sorted(counts.items())): taken for counts, taken in possible(made)}
        assert all(known[counts] <= taken for counts, taken in plans(made))
