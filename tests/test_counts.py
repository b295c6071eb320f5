"""Whole counts of executions: what they prove of small flows, and every plan up to a length."""

import math
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from itertools import product
from random import Random

import pytest

from foon_asp.bounds import counts as counts_module
from foon_asp.bounds.counts import (
    Balance,
    BetterError,
    CountBound,
    Counts,
    Flows,
    Landmark,
    Level,
    Measure,
    Sum,
    SumLimit,
    _around,
    _Model,
)
from foon_asp.bounds.whole_program import Solved, Stopped, WholeProgram

_LONGEST = 4


Key = tuple[tuple[int, int], ...]


def plans(made: Flows) -> Iterator[tuple[Key, int]]:
    """Give every plan up to a length: how often it executes what, and what it takes of stock and items."""
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


def random_flows(choose: Random) -> Flows:
    objects, actions = range(choose.randint(2, 4)), range(choose.randint(2, 4))
    asks = [choose.sample(objects, choose.randint(0, 2)) for _ in actions]
    return Flows(
        asks,
        [[o for o in asked if choose.random() < 0.6] for asked in asks],
        [[o for o in choose.sample(objects, choose.randint(1, 2)) if o not in asked] for asked in asks],
        [choose.sample(range(100, 103), choose.randint(0, 2)) for _ in actions],
        {o: choose.randint(0, 2) for o in objects if choose.random() < 0.4},
        choose.sample(objects, choose.randint(1, 2)),
    )


def possible(made: Flows) -> list[tuple[Counts, int]]:
    """Give all counts that a plan may have, up to a length, and what it takes of stock and items at least.

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
    """Give a measure with costs of at least 1, in whole numbers or rounded down to halves."""
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
    return Flows(asks, uses, adds, items, start or {}, targets)


def proves(bound: CountBound, *levels: Level) -> list[Counts]:
    """Give the counts that had to be asked for, none of which is better, until the proof was there."""
    asked: list[Counts] = []

    def is_better(counts: Counts) -> bool:
        asked.append(counts)
        return False

    bound.prove(levels, is_better)
    return asked


def whole(measure: Measure, cost: int) -> Level:
    return Level(measure, Fraction(cost), cost)


def better(bound: CountBound, *levels: Level) -> Counts:
    """Give the first counts that would be better."""
    with pytest.raises(BetterError, match="a better plan was found") as error:
        bound.prove(levels, lambda _: True)
    return error.value.counts


# 0 washes knives (4 of them, say, are dirty), 1 and 2 cut with one
def test_what_is_used_up_has_to_be_made_each_time() -> None:
    cutting = flows(">3", "3>0", "3>1", targets=(0, 1))
    bound = CountBound(cutting)
    assert bound.counts([UNITS]) == {0: 2, 1: 1, 2: 1}
    assert not bound.none()
    assert proves(bound, whole(UNITS, 4)) == []
    assert better(bound, whole(UNITS, 5)) == {0: 2, 1: 1, 2: 1}
    assert bound.proved == 0  # no part was looked at but the first
    assert better(bound, Level(UNITS, Fraction(9, 2), 4)) == {0: 2, 1: 1, 2: 1}
    assert len(proves(bound, whole(UNITS, 6))) == 2  # and one with a knife too many, which no order has
    assert bound.proved == 5
    keeping = CountBound(flows(">3", "3*>0", "3*>1", targets=(0, 1)))
    assert keeping.counts([UNITS], rounds=1) == {0: 1, 1: 1, 2: 1}
    assert proves(keeping, whole(UNITS, 3)) == []
    assert better(keeping, whole(UNITS, 4)) == {0: 1, 1: 1, 2: 1}


def test_what_is_there_at_first_need_not_be_made() -> None:
    for knives, counts in ((1, {0: 1, 1: 1, 2: 1}), (2, {1: 1, 2: 1}), (3, {1: 1, 2: 1})):
        bound = CountBound(flows(">3", "3>0", "3>1", start={3: knives}, targets=(0, 1)))
        assert bound.counts([UNITS]) == counts
        assert proves(bound, whole(UNITS, sum(counts.values()))) == []
        assert better(bound, whole(UNITS, sum(counts.values()) + 1)) == counts
    there = CountBound(flows(">0", "100>0", "101>0", start={0: 1}))
    assert there.counts([UNITS]) == {}
    assert proves(there, whole(UNITS, 0)) == []


def test_copies_and_items_that_are_taken_are_paid_once_each() -> None:
    cutting = flows("100>3", "100 3>0", "3>1", start={3: 2}, targets=(0, 1))
    for item, counts, cost in ((1, {1: 1, 2: 1}, 5), (3, {0: 2, 1: 1, 2: 1}, 9)):
        measure = Measure([2, 1, 1], item)
        bound = CountBound(cutting)
        assert bound.counts([measure]) == counts
        assert proves(bound, whole(measure, cost)) == []
        assert better(bound, whole(measure, cost + 1)) == counts
    circle = flows("1*>0", "0*>1", start={1: 1})
    measure = Measure([1, 1], 3)
    assert CountBound(circle).counts([measure]) == {0: 1}
    assert proves(CountBound(circle), whole(measure, 4)) == []
    assert better(CountBound(circle), whole(measure, 5)) == {0: 1}
    reading = flows("3*>0", "3*>1", start={3: 2}, targets=(0, 1))
    measure = Measure([0, 0], 1)
    assert proves(CountBound(reading), whole(measure, 1)) == []  # one copy is enough
    assert better(CountBound(reading), whole(measure, 2)) == {0: 1, 1: 1}


def test_a_circle_does_not_make_itself() -> None:
    circle = CountBound(flows("1*>0", "0*>1"))
    assert circle.none()
    assert circle.counts([UNITS]) is None
    costs = Measure([1, 1, 5])
    bound = CountBound(flows("1*>0", "0*>1", ">0"))
    assert bound.none() is False
    assert bound.counts([costs]) == {2: 1}
    assert proves(bound, whole(costs, 5)) == []
    assert better(bound, whole(costs, 6)) == {2: 1}
    used_up = CountBound(flows("1>0", "0>1"))
    assert used_up.none()


def test_some_action_of_each_set_is_asked_for() -> None:
    ways = flows(">0", "100>0", "101>0")
    costs = Measure([1, 3, 2])
    assert CountBound(ways).counts([costs]) == {0: 1}
    bound = CountBound(ways, [[1, 2]])
    assert bound.counts([costs]) == {2: 1}
    assert proves(bound, whole(costs, 2)) == []
    assert CountBound(ways, [[1], [2]]).counts([costs]) == {1: 1, 2: 1}


def test_a_level_counts_only_where_those_before_are_as_good() -> None:
    ways = flows(">0", "100>0", "101>0")
    first, second = Measure([1, 1, 2]), Measure([3, 2, 1])
    bound = CountBound(ways)
    assert bound.counts([first, second]) == {1: 1}
    assert proves(bound, whole(first, 1), whole(second, 2)) == []
    assert proves(bound, whole(first, 1), whole(second, 4)) == [{1: 1}, {0: 1}]
    assert bound.proved == 0  # what is proved of the second level is no bound on the first
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


def test_what_costs_nothing_may_be_executed_as_often_as_wanted() -> None:
    bound = CountBound(flows(">3", "3>0", "3>1", targets=(0, 1)))
    free = Measure([0, 1, 1])
    assert bound.counts([free, UNITS]) == {0: 2, 1: 1, 2: 1}
    assert proves(bound, whole(free, 2)) == []
    assert better(bound, whole(free, 3), whole(UNITS, 4)).keys() == {0, 1, 2}


def test_how_often_a_plan_as_good_can_execute_each_action() -> None:
    cutting = flows(">3", "3>0", "3>1", targets=(0, 1))
    assert CountBound(cutting).caps(whole(UNITS, 4)) == [2, 1, 1]
    assert CountBound(cutting).caps(whole(UNITS, 5)) == [3, 1, 1]
    assert CountBound(cutting).caps(whole(Measure([0, 1, 1]), 3)) == [None, 2, 2]
    reading = flows(">3", "3*>0", "3*>1", targets=(0, 1))
    assert CountBound(reading).caps(whole(UNITS, 4)) == [2, 2, 2]  # one execution more, of any
    with pytest.raises(Stopped):
        CountBound(cutting, expired=lambda: True).caps(whole(UNITS, 4))


def test_it_stops_when_time_is_up() -> None:
    bound = CountBound(flows("1*>0", "0*>1", ">0"), expired=lambda: True)
    for ask in (bound.none, lambda: bound.counts([UNITS]), lambda: bound.prove([whole(UNITS, 1)], bool)):
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
    monkeypatch.setattr(counts_module, "_MOST_PARTS", 5)
    # not executed, or executed: less than once, or more, and then more than twice; 3 times at most are of use
    costs = Measure([1])
    assert proves(CountBound(flows(">0")), whole(costs, 4)) == [{0: 1}, {0: 2}, {0: 3}]
    monkeypatch.setattr(counts_module, "_MOST_PARTS", 4)
    with pytest.raises(Stopped):
        proves(CountBound(flows(">0")), whole(costs, 4))
    monkeypatch.setattr(WholeProgram, "solve", lambda *_: Solved(None, -math.inf))
    assert not CountBound(flows("0*>0")).none()
    with pytest.raises(Stopped):
        proves(CountBound(flows(">0")), whole(costs, 1))


# --- What the model says, row by row.

# 0 washes a knife (3) and adds what nobody asks for (5); 1 uses the knife up, 2 reads it and takes a copy
# of 4, 3 puts back what it takes.
KITCHEN = flows(">3 5", "3 100>0", "3* 4 100 101>1", "6>6", start={4: 2, 7: 0}, targets=(0, 1))


def rows(model: _Model) -> list[tuple[dict[int, int], int]]:
    return [({c: part for c, part in row.items() if part}, least) for row, least in model.program._rows]


def test_the_rows_of_counts_alone() -> None:
    model = _Model(CountBound(KITCHEN), [Measure([1, 1, 1, 1])])
    # 0 to 3 are how often, 4 to 7 whether at all
    assert (model.program.lower, model.program.upper) == ([0] * 8, [None] * 4 + [1] * 4)
    used = [({a: 1, 4 + a: -1}, 0) for a in range(4)]
    assert rows(model) == [
        *[({}, 0)] * 4,  # nothing is known of how often
        *used,
        ({0: 1, 1: -1}, 0),  # knives
        ({1: 1}, 1),
        ({2: 1}, 1),
        ({2: -1}, -2),  # no more copies of 4 than there are
        ({4: 1, 6: -1}, 0),  # a knife that is read was washed once
    ]
    model.program.cap(1, 5)
    model.tighten()
    assert rows(model)[:4] == [({}, 0), ({5: 5, 1: -1}, 0), ({}, 0), ({}, 0)]
    far = _Model(CountBound(KITCHEN), [], far=True)
    assert rows(far)[:4] == [({4 + a: 1000, a: -1}, 0) for a in range(4)]


def test_the_rows_where_copies_and_items_cost_something() -> None:
    bound = CountBound(KITCHEN, [[1, 2]])
    priced = Measure([1, 2, 0, 0], 3)
    model = _Model(bound, [Measure([1, 1, 1, 1]), priced])
    assert (model.stock, model.program.lower[8:], model.program.upper[8:]) == ({4: 8}, [0] * 3, [2, 1, 1])
    assert rows(model)[11:] == [
        ({2: -1, 8: 1}, 0),  # copies of 4 that are taken
        ({9: 1, 5: -1}, 0),
        ({4: 1, 6: -1}, 0),
        ({9: 1, 6: -1}, 0),
        ({10: 1, 6: -1}, 0),
        ({5: 1, 6: 1}, 1),  # what is required
    ]
    assert model.objective(priced) == {0: 1, 1: 2, 8: 3, 9: 3, 10: 3}
    assert model.objective(Measure([0, 1, 0, 0])) == {1: 1}
    model.add_landmark(Landmark((0, 3), (4,), 2))
    assert rows(model)[17:] == [({4: 1, 7: 1, 8: 1, 6: -1}, 0)]
    model.limit(Level(priced, Fraction(5), 5))
    assert rows(model)[18:] == [({0: -1, 1: -2, 8: -3, 9: -3, 10: -3}, -5)]
    assert model.program.upper[:4] == [5, 2, None, None]
    assert rows(model)[:2] == [({4: 5, 0: -1}, 0), ({5: 2, 1: -1}, 0)]
    model.keep(priced, [0.9999, 2.0, 0, 0, 1, 1, 0, 0, 1, 1, 0])
    assert rows(model)[19:] == [({0: -1, 1: -2, 8: -3, 9: -3, 10: -3}, -11)]
    model.cap(Measure([2, 3, 1, 0]), -1)
    assert model.program.upper[:4] == [0, 0, 0, None]
    reading = _Model(CountBound(flows("4*>0", ">4", start={4: 1})), [priced])
    assert rows(reading)[-1] == ({3: 1, 4: 1, 2: -1}, 0)  # read, if it was taken or made


def test_what_rows_say_of_every_plan() -> None:
    """What they do not say of every one, as what holds how often an action is executed, is no condition."""
    level, limits = whole(Measure([1, 2, 0, 0]), 5), [({0: 2}, 7, False, False), ({1: 1}, 1, True, True)]
    bound = CountBound(KITCHEN, [[1, 2]], limits, within=[level])
    model = bound._model([])
    knife, needed = Landmark((), (), 2, (3,)), Landmark((1, 2))
    assert model.conditions == {
        **dict(enumerate([Balance(3), Balance(0), Balance(1), Balance(4)], 8)),
        **dict(enumerate([knife, needed, Sum(0), Sum(1), level], 12)),
    }
    model.add_landmark(Landmark((3,), (), 0))
    assert model.conditions[17] == Landmark((3,), (), 0)
    priced = _Model(CountBound(KITCHEN), [Measure([0] * 4, 1)])
    asked = {12: (1, 100), 13: (2, 3), 14: (2, 100), 15: (2, 101)}
    items = {row: Landmark((), (), action, (o,)) for row, (action, o) in asked.items()}
    assert {row: said for row, said in priced.conditions.items() if row > 11} == items
    # a copy that is read may be one that is there: without columns for these, a row says nothing
    reading = flows("4*>0", start={4: 1})
    for item, conditions in ((0, {}), (1, {4: Landmark((), (), 0, (4,))})):
        found = _Model(CountBound(reading), [Measure([1], item)]).conditions
        assert {row: said for row, said in found.items() if isinstance(said, Landmark)} == {
            row - 1: said for row, said in conditions.items()
        }


def test_the_rows_of_limits() -> None:
    limits = [({0: 2, 1: 3}, 7, False, False), ({1: 1, 2: 1}, 1, True, False), ({0: 1, 3: 1}, 1, False, True)]
    model = _Model(CountBound(KITCHEN, (), limits), [])
    assert rows(model)[13:] == [({0: -2, 1: -3}, -7), ({1: 1, 2: 1}, 1), ({4: -1, 7: -1}, -1)]
    assert model.program.upper[:4] == [3, 2, None, None]
    none = _Model(CountBound(KITCHEN, (), [({3: 1}, -1, False, False)]), [])
    assert none.program.upper[:4] == [None, None, None, 0]


def test_the_rows_of_plans_that_are_known() -> None:
    bound = CountBound(KITCHEN, beside=[{0: 1, 2: 3}, {2: 3, 3: 2}])
    model = _Model(bound, [])
    assert (model.program.lower[8:], model.program.upper[8:]) == ([0, 0], [1, 1])
    often = [({2: 1, 8: -3}, 0), ({}, -2), ({4: -1, 8: -1}, -1), ({3: 1, 9: -2}, 0), ({}, -1)]
    assert rows(model)[13:] == [*often, ({8: -1, 9: -1}, -1)]
    model.program.cap(2, 5)
    model.program.cap(3, 1)
    model.tighten()
    assert rows(model)[14] == ({8: 3, 2: -1}, -2)  # 2 at most, or 5
    assert rows(model)[17] == ({3: -1}, -1)
    for counts, told, held in (
        ({2: 3}, (0, 0), (2, 3, 8)),
        ({2: 4}, (0, 0), (2, 3, 8)),
        ({2: 3}, (1, 0), None),
        ({2: 2, 3: 1}, (0, 0), None),
        ({2: 3, 3: 2}, (1, 0), (3, 2, 9)),
    ):
        assert model.held(counts, [0.0] * 8 + [float(each) for each in told]) == held


def test_the_rows_of_what_plans_have_to_be_as_good_as() -> None:
    units, cheap = Measure([1, 1, 1, 1]), Measure([1, 2, 0, 0])
    bound = CountBound(KITCHEN, within=[whole(cheap, 3), whole(units, 4)])
    assert rows(bound._model([units]))[13:] == [
        ({0: -1, 1: -2}, -3),
        (dict.fromkeys(range(4), -1), -4),
    ]
    assert bound._model([units]).program.upper[:4] == [3, 1, 4, 4]


def test_how_many_executions_there_can_be_in_all() -> None:
    limited = flows("3>0", "3>1", start={3: 4})
    assert CountBound(limited).most_executions() == 4
    assert CountBound(limited, (), [({0: 2, 1: 2}, 5, False, False)]).most_executions() == 2
    assert CountBound(flows(">0")).most_executions() is None
    assert CountBound(limited, (), [({0: 1}, 5, True, False)]).most_executions() is None  # no plan at all


def test_landmarks_of_targets_are_cut_where_they_are_hit_in_part() -> None:
    # two of three actions make each two of three targets: half of each would do
    half = flows(">0 1", ">0 2", ">1 2", targets=(0, 1, 2))
    bound = CountBound(half, derivation=[0, 1])
    x = [0.5, 0.5, 0.5, 0.25, 0.25, 0.25]
    model = _Model(bound, [UNITS])
    before = rows(model)
    assert bound._separate(x, model, at_root=True)
    assert sorted(landmark.members for landmark in bound._landmarks) == [(0, 1), (0, 2), (1, 2)]
    assert rows(model)[len(before) :] == [({3: 1, 4: 1}, 1), ({3: 1, 5: 1}, 1), ({4: 1, 5: 1}, 1)]
    assert bound._separate([1.0] * 6, model, at_root=True) is False
    none_left = flows(">1", "1*>0", start={1: 0})
    bound = CountBound(none_left, derivation=[0, 1])
    assert bound._separate([0.5, 0.5, 0.0, 0.0], _Model(bound, []), at_root=True)
    assert {landmark.members for landmark in bound._landmarks} == {(0,), (1,)}
    assert CountBound(half)._separate(x, model, at_root=True) is False  # without a derivation
    assert not CountBound(flows(">0", start={0: 1}), derivation=[0])._separate(x, model, at_root=True)
    assert not CountBound(flows("1>0"), derivation=[0])._separate(x, model, at_root=True)


def test_more_than_a_few_executions_are_found_as_well() -> None:
    eggs = flows(">3", *(f"3>{n}" for n in range(10, 22)), targets=tuple(range(10, 22)))
    for actions in ((), range(13)):
        bound = CountBound(eggs, derivation=actions)
        assert bound.counts([Measure([1] * 13)]) == {0: 12, **dict.fromkeys(range(1, 13), 1)}


def test_a_landmark_over_copies_is_left_out_where_these_are_not_counted() -> None:
    model = _Model(CountBound(KITCHEN), [])
    before = rows(model)
    model.add_landmark(Landmark((0,), (4,)))
    assert rows(model) == before
    model.add_landmark(Landmark((0,)))
    assert rows(model) == [*before, ({4: 1}, 1)]


def test_executions_are_counted_by_class_where_costs_are_rounded() -> None:
    measure = Measure([1, 1, 1, 1], 0, lambda _: Fraction(0), [1, 0, -1, 1])
    model = _Model(CountBound(KITCHEN), [measure])
    assert model.class_columns(measure) == [8, 9]
    assert (model.program.lower[8:], model.program.upper[8:]) == ([0, 0], [None, None])
    assert rows(model)[13:] == [
        ({8: 1, 1: -1}, 0),
        ({8: -1, 1: 1}, 0),
        ({9: 1, 0: -1, 3: -1}, 0),
        ({9: -1, 0: 1, 3: 1}, 0),
    ]
    assert len(rows(_Model(CountBound(KITCHEN), [measure], far=True))) == 13


# --- How what is left is divided.


def test_what_is_around_counts_is_divided_into_parts_that_share_nothing() -> None:
    program = WholeProgram(3)
    program.upper = [4, None, 2]
    program.lower = [1, 0, 2]
    found = [1.0000001, 3.0, 2.0]
    parts = list(_around(program, found, (0, 1, 2)))
    assert len(parts) == 3  # fewer or more of 1, and more of 0: no more than there are parts
    for point in product(range(1, 5), range(7), range(2, 3)):
        inside = [
            all(
                low <= value and (most is None or value <= most)
                for low, value, most in zip(lower, point, upper, strict=True)
            )
            for lower, upper in parts
        ]
        assert sum(inside) == (point != (1, 3, 2))
    assert (program.lower, program.upper) == ([1, 0, 2], [4, None, 2])
    # what is executed most is told apart first
    assert parts[0] == ([1, 0, 2], [4, 2, 2])


def test_what_is_looked_at_first_in_a_part() -> None:
    bound = CountBound(flows(">0", ">1", targets=(0, 1)))
    exact = Measure([1, 1], 0, lambda counts: Fraction(sum(counts.values())), [0, -1])
    units = whole(Measure([1, 1]), 9)

    def parts(x: list[float], level: Level, *before: Level) -> list[tuple[list[int], list[int | None]]]:
        model, levels = _Model(bound, [each.measure for each in (*before, level)]), (*before, level)
        return list(bound._branches(model, x, levels, lambda counts: counts == {0: 2, 1: 2}))

    none, once = [None, None, 1, 1], [0, 0, 0, 0]
    # what is most nearly half executed
    assert parts([1.8, 2.4, 1, 1], units) == [(once, [None, 2, 1, 1]), ([0, 3, 0, 0], none)]
    assert parts([2.4, 1.2, 1, 0.1], units) == [(once, [2, None, 1, 1]), ([3, 0, 0, 0], none)]
    # what is executed and does not count as such
    assert parts([0.9999999, 3, 1, 0], units) == [(once, [None, 0, 1, 1]), ([0, 1, 0, 1], none)]
    # counts of which the exact cost is too much: others of the classes
    assert parts([3, 1, 1, 1, 3], Level(exact, Fraction(4), 9, strict=True)) == [
        ([0] * 5, [*none, 2]),
        ([0, 0, 0, 0, 4], [*none, None]),
    ]
    assert len(parts([3, 1, 1, 1, 3], units, Level(exact, Fraction(3), 9))) == 2
    # counts that have no order: others
    assert len(parts([3, 1, 1, 1, 3], Level(exact, Fraction(5), 9, strict=True))) == 4
    assert len(parts([3, 1, 1, 1, 3], units, Level(exact, Fraction(4), 9))) == 4
    with pytest.raises(BetterError):
        parts([2, 2, 1, 1], units)


def test_what_is_executed_as_often_as_in_a_known_plan_counts_as_such() -> None:
    bound = CountBound(flows(">0", ">1", targets=(0, 1)), beside=[{0: 2, 1: 1}])
    level = whole(Measure([1, 1]), 9)
    model = _Model(bound, [level.measure])
    parts = list(bound._branches(model, [3, 1, 1, 1, 0], [level], lambda _: True))
    assert parts == [
        ([0] * 5, [1, None, 1, 1, 1]),
        ([2, 0, 0, 0, 1], [None, None, 1, 1, 1]),
    ]


def test_counts_that_are_found_are_not_those_of_a_known_plan(monkeypatch: pytest.MonkeyPatch) -> None:
    ways = flows(">0", ">1", "100>0", targets=(0, 1))
    # that each is executed a little would do if it were not asked whether it is executed at all
    assert CountBound(ways, beside=[{0: 1, 1: 1}]).counts([UNITS]) == {1: 1, 2: 1}
    monkeypatch.delattr(WholeProgram, "whole_optimum")  # not needed where counts are whole
    assert CountBound(ways).counts([Measure([1, 1, 2])]) == {0: 1, 1: 1}


def test_it_is_proved_that_there_is_no_plan(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[Counts] = []

    def is_better(counts: Counts) -> bool:
        asked.append(counts)
        return len(asked) == 9

    eating = flows("3>0", "3>1", start={3: 2})
    caps, tighten_root = list[int](), CountBound._tighten_root

    def tightened(bound: CountBound, model: _Model, objective: Mapping[int, int], cutoff: int) -> None:
        caps.append(cutoff)
        tighten_root(bound, model, objective, cutoff)

    monkeypatch.setattr(CountBound, "_tighten_root", tightened)
    bound = CountBound(eating)
    bound.none_is_left(Measure([1, 1]), is_better)
    assert (asked[0], sorted(map(sorted, map(dict.items, asked)))) == (
        {0: 1},  # the fewest first
        [[(0, 1)], [(0, 1), (1, 1)], [(0, 2)]],
    )
    assert (bound.proved, caps) == (0, [2])  # what is proved is of another measure, and no bound
    for found in (bound, CountBound(flows(">0"))):  # as often as wanted
        with pytest.raises(BetterError):
            found.none_is_left(Measure([1, 1]), lambda _: True)
    assert caps == [2, 2]
    CountBound(flows("1>0", ">2")).none_is_left(Measure([1, 1]), is_better)
    asked.clear()
    monkeypatch.setattr(counts_module, "_MOST_UNCAPPED", 5)
    with pytest.raises(Stopped):
        CountBound(flows(">0", ">2", targets=(0, 2))).none_is_left(Measure([1, 1]), is_better)
    assert asked[0] == {0: 1, 1: 1}
    assert 2 <= len(asked) <= 3


def test_more_landmarks_are_looked_for_at_the_root_only(monkeypatch: pytest.MonkeyPatch) -> None:
    asked, separate = list[bool](), CountBound._separate

    def separated(bound: CountBound, x: Sequence[float], model: _Model, at_root: bool) -> bool:
        asked.append(at_root)
        return separate(bound, x, model, at_root)

    monkeypatch.setattr(CountBound, "_separate", separated)
    proves(CountBound(flows(">0"), derivation=[0]), whole(Measure([1]), 3))
    assert asked == [True, True, False, False]


def test_actions_that_cannot_be_executed_twice_are_found_at_the_root(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def tightened(actions: Flows, costs: list[int], cutoff: int, landmarks: int = 0) -> list[int | None]:
        bound, measure = CountBound(actions), Measure(costs)
        model = _Model(bound, [measure])
        model.cap(measure, cutoff)
        bound._tighten_root(model, model.objective(measure), cutoff)
        assert model.program.lower == [0] * 2 * len(costs)
        assert len(bound._landmarks) == landmarks
        return model.program.upper[: len(costs)]

    once = flows(">3", "3*>0")
    assert tightened(once, [1, 1], 3) == [3, 3]
    assert tightened(once, [1, 1], 2) == [2, 1]
    assert tightened(once, [1, 1], 0) == [0, 0]
    cutting = flows(">3", "3*>0", "3*>1", targets=(0, 1))
    assert tightened(cutting, [1, 1, 1], 3) == [3, 1, 1]
    twice = flows(">3", "3*>0", ">1", targets=(0, 1))
    assert tightened(twice, [4, 1, 2], 4) == [1, 1, 1]  # a bound of just as much is none
    assert tightened(twice, [2, 2, 4], 9) == [4, 4, 1]
    assert tightened(flows("1*>0", "0*>1", ">0"), [1, 1, 5], 7, landmarks=1) == [7, 7, 1]
    reading = flows("1*>0", "0*>1", ">0", ">3", "3*>4", targets=(0, 4))
    assert tightened(reading, [1, 1, 2, 1, 1], 4, landmarks=1) == [4, 4, 2, 4, 1]
    bound, seen = CountBound(once), list[int]()
    with monkeypatch.context() as patched:
        patched.setattr(CountBound, "_tighten_root", lambda _, __, ___, cutoff: seen.append(cutoff))
        assert proves(bound, whole(Measure([1, 1]), 2)) == []
    assert seen == [1]
    monkeypatch.setattr(counts_module, "_PROBES", 1)
    assert tightened(cutting, [1, 1, 1], 3) == [3, 1, 3]


def hold(made: Flows, first: Level, second: Level | None = None, limits: Sequence[SumLimit] = ()) -> None:
    """Hold what is asked for in the course of a proof against all that there is."""

    def within(counts: Counts) -> bool:
        sums = [
            (sum(w * (a in counts if used else counts.get(a, 0)) for a, w in weights.items()), bound, least)
            for weights, bound, least, used in limits
        ]
        return all(total >= bound if least else total <= bound for total, bound, least in sums)

    known = [(c, taken) for c, taken in possible(made) if within(c)]
    as_good = [c for c, taken in known if cost_of(first.measure, c, taken) <= first.cost]
    caps = CountBound(made, (), limits).caps(first) if as_good else []
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
            found = bound.counts([first.measure])
            assert found is not None
            assert sum(first.measure.costs[a] * n for a, n in found.items()) <= first.most
        asked = proves(bound, *levels)
        assert sorted(sorted(c.items()) for c in asked) == sorted(sorted(c.items()) for c in better)


def runnable(made: Flows) -> list[int]:
    """Give all actions that can be executed if nothing is used up."""
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
        if CountBound(made).none():
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
        CountBound(made, (), (), derivation, [limit], beside).every(levels, asked.append)
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
