"""Costs of several levels: what is compared how closely, and what numbers are taken apart into."""

import math
import random
from fractions import Fraction

import pytest

from foon_asp.hypergraph import lexicographic
from foon_asp.hypergraph.coprime_base import coprime_base, factor_exponents
from foon_asp.hypergraph.lexicographic import Lexicographic, minus_log

ONE, HALF = Fraction(1), Fraction(1, 2)
COUNT = Lexicographic([None])


@pytest.mark.parametrize("seed", range(10))
def test_products_that_differ_in_a_late_digit_are_ordered(seed: int) -> None:
    rng = random.Random(seed)
    one, other = Fraction(rng.randint(100, 999), 1000), Fraction(rng.randint(100, 999), 1001)
    for digits in (8, 69, 70, 71, 72, 140):
        for late in (-1, 1):
            third = one * other * (1 + late * Fraction(1, 10**digits))
            order = Lexicographic([[one, other, third], None])
            assert order.sign((ONE, ONE, -ONE, Fraction(0))) == late
            assert order.sign((-ONE, -ONE, ONE, Fraction(0))) == -late
            assert order.sign((-HALF, -HALF, HALF, ONE)) == -late
            assert (
                order.compare((ONE, ONE, Fraction(0), Fraction(0)), (Fraction(0), Fraction(0), ONE, ONE))
                == late
            )


@pytest.mark.parametrize(
    ("rates", "exponents"),
    [
        (["2/3", "3/4", "1/2"], [1, 1, -1]),
        (["1/2", "1/4", "1/8"], [-5, 1, 1]),
        (["2/3", "4/9", "8/27"], [3, -3, 1]),
        (["6/35", "2/5", "3/7"], [2, -2, -2]),
        (["6/35", "2/5", "3/7"], [0, 0, 0]),
    ],
)
def test_products_that_are_1_leave_it_to_the_next_level(rates: list[str], exponents: list[int]) -> None:
    order = Lexicographic([[Fraction(rate) for rate in rates], None])
    for share in (ONE, Fraction(1, 7), Fraction(10**200)):
        parts = [share * exponent for exponent in exponents]
        assert [order.sign((*parts, Fraction(count))) for count in (-2, 0, 2)] == [-1, 0, 1]


def test_what_is_too_small_for_a_float_is_above_0() -> None:
    tiny = Fraction(1, 10**400)
    order = Lexicographic([[HALF, Fraction(1, 3)], None])
    assert order.sign((tiny, Fraction(0), -ONE)) == 1
    assert order.sign((Fraction(0), -tiny, ONE)) == -1
    assert order.sign((tiny, -tiny, ONE)) == -1
    assert order.sign((Fraction(0), Fraction(0), -tiny)) == -1
    assert order.approximate((tiny, ONE, tiny)) == [pytest.approx(1.0986122886681098), 0.0]


def test_a_vector_of_another_width_is_an_error() -> None:
    order = Lexicographic([None, [HALF, Fraction(1, 3)]])
    assert order.width == 3
    assert Lexicographic([]).zero == ()
    for function in (
        order.sign,
        order.approximate,
        lambda vector: order.total([vector]),
        lambda vector: order.compare(vector, order.zero),
    ):
        function(order.zero)
        with pytest.raises(ValueError, match="zip"):
            function((Fraction(0), ONE))

    with pytest.raises(ValueError, match="zip"):
        order.compare((*order.zero, ONE), order.zero)


def test_where_floats_tell_nothing_is_taken_apart(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delattr(lexicographic, "coprime_base")
    order = Lexicographic([[HALF, Fraction(1, 3)], [Fraction(1, 5), Fraction(1, 6)]])
    assert order.sign((ONE, -HALF, Fraction(0), Fraction(0))) == 1
    assert order.sign((Fraction(1, 10**6), Fraction(-1, 10**6), Fraction(0), Fraction(0))) == -1
    assert order.sign((Fraction(0), Fraction(0), -ONE, ONE)) == 1
    assert order.sign(order.zero) == 0
    with pytest.raises(NameError):
        order.sign((ONE, Fraction(-6309297535714574, 10**16), Fraction(0), Fraction(0)))  # log 2 / log 3


def test_logarithms_have_ten_digits_more_than_are_asked_for_and_those_that_numbers_next_to_1_share() -> None:
    assert minus_log(Fraction(1, 8), 2) == (Fraction("2.07944154168"), Fraction("2.07944154168") / 10**11)
    assert minus_log(HALF, 2) == (Fraction("0.693147180560"), Fraction("0.693147180560") / 10**11)
    # ln 10 - ln 9, of 13 digits each
    assert minus_log(Fraction(9, 10), 2) == (
        Fraction("2.302585092994") - Fraction("2.197224577336"),
        Fraction("4.499809670330") / 10**12,
    )
    for rate in (HALF, Fraction(2, 3), Fraction(1, 10**50), 1 - Fraction(1, 10**50), 1 - Fraction(1, 3**400)):
        exact = minus_log(rate, 200)[0]
        for digits in (1, 10, 60):
            found, off = minus_log(rate, digits)
            assert abs(found - exact) < off < found / 10**digits


def test_numbers_are_taken_apart_into_coprime_ones() -> None:
    assert coprime_base([]) == coprime_base([1, 1]) == []
    assert coprime_base([7, 1, 7]) == [7]
    assert sorted(coprime_base([12, 18])) == [2, 3]
    assert sorted(coprime_base([4, 16, 64])) == [4]
    assert sorted(coprime_base([10, 21, 35])) == [2, 3, 5, 7]
    assert sorted(coprime_base([8, 9])) == [8, 9]
    assert factor_exponents(72, [2, 3, 5]) == {2: 3, 3: 2}
    assert factor_exponents(64, [8]) == {8: 2}
    assert factor_exponents(1, [2]) == {}


def test_totals_above_all_floats_are_ordered() -> None:
    order = Lexicographic([[Fraction(1, 2), Fraction(1, 3)]])
    for large in (10**16, 10**308, 10**400):
        assert order.sign([large, -large]) == -1
        assert order.sign([-large, large]) == 1
        assert order.sign([large, Fraction(-large, 2)]) == 1  # ln 2 is more than half of ln 3
        assert order.compare((Fraction(large), Fraction(0)), (Fraction(large), Fraction(1))) == -1
    assert Lexicographic([None]).sign([Fraction(-(10**400), 3)]) == -1
    assert order.approximate([10**400, -(10**400)]) == order.approximate([10**12, -(10**12)])
    assert order.approximate([10**400, -(10**400)]) != order.approximate([10**11, -(10**11)])


def test_exponents_do_not_make_up_for_logarithms_that_floats_lose() -> None:
    """A rate so near to 1 has a logarithm of 0 as a float, and counts for more than the other here."""
    near = 1 - Fraction(1, 10**400)
    nearer = 1 - Fraction(1, 10**250)
    order = Lexicographic([[near, nearer]])
    assert order.sign([10**200, -1]) == 1
    assert order.sign([-(10**200), 1]) == -1
    assert order.sign([10**100, -1]) == -1


def test_products_are_compared_exactly() -> None:
    rates = [Fraction("0.3"), Fraction("0.09"), Fraction("0.300000001")]
    order = Lexicographic([rates, None])
    half, one = Fraction(1, 2), Fraction(1)
    assert order.sign((one * 2, -one, Fraction(0), Fraction(0))) == 0
    assert order.sign((one, -half, Fraction(0), -one)) == -1
    assert order.sign((one, Fraction(0), -one, -one)) == 1
    assert order.sign((-half, Fraction(0), half, one)) == -1
    assert order.sign(order.zero) == 0
    tiny = Fraction(1, 10**30)  # 1 - 2 * 10**-30 against (1 - 10**-30) ** 2: their floats are equal
    close = Lexicographic([[1 - 2 * tiny, 1 - tiny]])
    assert close.sign((one, -2 * one)) == 1
    assert close.sign((-one, 2 * one)) == -1


@pytest.mark.parametrize("seed", range(60))
def test_costs_are_ordered_as_products_of_fractions_are(seed: int) -> None:
    """Among rates whose products collide, and for powers that are fractions."""
    rng = random.Random(seed)
    pool = ["0.5", "0.25", "0.7", "0.49", "0.9", "0.81", "0.3", "0.999999999", "0.000000001"]
    rates = list(map(Fraction, rng.sample(pool, 3)))
    first = rng.random() < 0.5
    order = Lexicographic([rates, None] if first else [None, rates])
    assert order.width == 4
    share = Fraction(1, rng.choice([1, 2, 3]))
    for _ in range(20):
        exponents = [rng.randint(-3, 3) for _ in rates]
        count = rng.choice([-1, 0, 0, 1])
        product = math.prod(rate**power for rate, power in zip(rates, exponents, strict=True))
        by_rates = (product < 1) - (product > 1)
        parts = [share * power for power in exponents]
        vector = (*parts, share * count) if first else (share * count, *parts)
        expected = by_rates or count if first else count or by_rates
        assert order.sign(vector) == expected
        assert order.sign([-part for part in vector]) == -expected
        one, other = order.approximate(vector)
        logarithm, figure = (one, other) if first else (other, one)
        assert figure == float(share * count)
        assert logarithm == pytest.approx(-float(share) * math.log(product), abs=1e-12)
        assert order.total([vector, vector]) == tuple(2 * part for part in vector)
    assert order.total([]) == order.zero == (Fraction(0),) * 4
