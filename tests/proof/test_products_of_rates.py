"""What the verifier says of products of rates: compared exactly, by logarithms or multiplied out.

A bound with no weights to prove it is accepted exactly where it is not above nothing. So a bound and its
opposite together tell whether a product is below, equal to or above 1.
"""

from decimal import Context, Decimal
from fractions import Fraction

import pytest

from foon_asp.problem import Problem
from foon_asp.proof.refusal import CheckLimitError
from tests.proof.by_hand import recipe, refusal

TOO_CLOSE = "products of rates are too close to be told apart in reasonable time"


def rated(*rates: str) -> Problem:
    """Make the end of the start, by a motion of each rate, named as it."""
    return recipe(*(f"{rate}: start > end" for rate in rates), rates={rate: rate for rate in rates})


def sign(problem: Problem, exponents: dict[str, str]) -> int:
    """Give the sign of the sum of ``e * -log(rate)``: it is above zero where its bound is not proved."""
    below, above = (proved(problem, exponents, opposite) for opposite in (1, -1))
    assert below or above
    return above - below


def proved(problem: Problem, exponents: dict[str, str], opposite: int) -> bool:
    bound = {rate: str(opposite * Fraction(e)) for rate, e in exponents.items()}
    said = refusal(problem, claim="bound", objective=["success"], bound=[bound])
    if said == TOO_CLOSE:
        raise CheckLimitError(said)
    assert said in ("", "the weights do not add up to enough")
    return said == ""


RATES = rated("1/2", "1/4", "1/3", "2/3", "1/101", "1/202", "99/100", "98/99", "49/50")


@pytest.mark.parametrize(
    ("exponents", "expected"),
    [
        ({}, 0),
        ({"1/2": "1"}, 1),
        ({"1/2": "-1/1000"}, -1),
        # 1/2 is below 2/3 and above 1/3
        ({"1/2": "1", "2/3": "-1"}, 1),
        ({"1/2": "1", "1/3": "-1"}, -1),
        # 1/2 * 1/2 is 1/4
        ({"1/2": "2", "1/4": "-1"}, 0),
        ({"1/2": "2", "1/4": "-999/1000"}, 1),
        ({"1/2": "2", "1/4": "-1001/1000"}, -1),
        ({"1/2": "1", "1/101": "1", "1/202": "-1"}, 0),
        ({"1/2": "1", "1/3": "-1", "2/3": "1"}, 0),
        ({"99/100": "1", "98/99": "1", "49/50": "-1"}, 0),
        ({"99/100": "1/7", "98/99": "1/7", "49/50": "-2/7"}, -1),
    ],
)
def test_signs(exponents: dict[str, str], expected: int) -> None:
    assert sign(RATES, exponents) == expected


@pytest.mark.parametrize("digits", [60, 300])
def test_rates_closer_than_logarithms_tell_are_multiplied_out(digits: int) -> None:
    """Those of long fractions around 1/3 are computed to fifty digits."""
    third, above = f"{10**digits}/{3 * 10**digits + 1}", f"{10**digits}/{3 * 10**digits - 1}"
    problem = rated("1/3", third, above)
    assert sign(problem, {third: "1", "1/3": "-1"}) == 1
    assert sign(problem, {third: "-1", "1/3": "1"}) == -1
    assert sign(problem, {above: "1", "1/3": "-1"}) == -1
    assert sign(problem, {above: "3", "1/3": "-3"}) == -1
    assert sign(problem, {above: "1/3", third: "-1/3"}) == -1
    # the product of the two is above 1/9: 1 / (9 - 1/100...)
    assert sign(problem, {above: "1", third: "1", "1/3": "-2"}) == -1


@pytest.mark.parametrize("digits", [3, 20, 300])
def test_rates_next_to_1(digits: int) -> None:
    """Where 1 - x and 1 - 2x are the rates, the second is below the square of the first, but not by much."""
    once, twice = f"{10**digits - 1}/{10**digits}", f"{10**digits // 2 - 1}/{10**digits // 2}"
    problem = rated(once, twice)
    assert sign(problem, {once: "1"}) == 1
    assert sign(problem, {twice: "1", once: "-1"}) == 1
    assert sign(problem, {twice: "1", once: "-2"}) == 1
    assert sign(problem, {twice: "-1", once: "2"}) == -1
    assert sign(problem, {twice: "1", once: "-201/100"}) == -1


# --- how close is too close: exponents so long that nothing can be multiplied out

EXACT = Context(prec=800)


def minus_log(rate: Fraction) -> Decimal:
    return EXACT.subtract(EXACT.ln(Decimal(rate.denominator)), EXACT.ln(Decimal(rate.numerator)))


@pytest.mark.parametrize(
    ("one", "other", "width"),
    [
        # Of 50 digits of log(2), 0.69, the last is worth 1e-50, and of log(3), 1.09, it is 1e-49. The log(2)
        # counts log(3) / log(2) times, 1.58. What is known of log(1) is all.
        ("1/2", "1/3", "1.158e-49"),
        # 52 digits of log(123), 4.8, and log(122), times 0.524, and 52 of log(234), 5.4, and log(233)
        ("122/123", "233/234", "3.048e-51"),
        # log(10 ** 100), 230.2, has 160 digits, as its first 110 are those of the numerator, too
        (f"{10**100 - 1}/{10**100}", f"{10**100 // 2 - 1}/{10**100 // 2}", "6e-157"),
        # and log(10 ** 420), 967.0, has 450, and no more
        (f"{10**420 - 1}/{10**420}", f"{10**420 // 2 - 1}/{10**420 // 2}", "6e-447"),
    ],
)
def test_logarithms_have_as_many_digits_as_they_need(one: str, other: str, width: str) -> None:
    """Each logarithm is off by half a unit of its last digit, and is taken to be off by one.

    So with one and a half times the sum of these units, a difference is seen for sure, and with half of it
    never. It would take too long to multiply the powers out.
    """
    problem = rated(one, other)
    first, second = minus_log(Fraction(one)), minus_log(Fraction(other))
    for times, seen in (("1.6", True), ("0.4", False), ("-1.6", True), ("-0.4", False)):
        off = EXACT.multiply(Decimal(times), Decimal(width))
        exponent = Fraction(EXACT.divide(EXACT.add(second, off), first))
        exponents = {one: str(Fraction(round(exponent * 10**700), 10**700)), other: "-1"}
        if seen:
            assert sign(problem, exponents) == (1 if off > 0 else -1)
        else:
            with pytest.raises(CheckLimitError):
                sign(problem, exponents)


def test_products_of_up_to_250_000_bits_are_multiplied_out() -> None:
    """The denominators 2, 4 and 8 have 2, 3 and 4 bits."""
    powers = rated("1/2", "1/4", "1/8")
    assert sign(powers, {"1/2": "-75000", "1/8": "25000"}) == 0  # 2 * 75,000 and 4 * 25,000
    assert sign(powers, {"1/2": "75000", "1/8": "-25000"}) == 0
    with pytest.raises(CheckLimitError):  # 2 * 75,000 and 4 * 24,998 and 3 * 3 are 250,001
        sign(powers, {"1/2": "-75000", "1/4": "3", "1/8": "24998"})


def test_bounds_that_touch_zero_decide_nothing() -> None:
    """Fifty digits of log(2) and log(3), one more and one less, as exponents: the sum is zero or above it."""
    fifty = Context(prec=50)
    two = int(Fraction(fifty.ln(Decimal(2))) * 10**50) - 1
    three = int(Fraction(fifty.ln(Decimal(3))) * 10**49) + 1
    for opposite in (1, -1):
        with pytest.raises(CheckLimitError):
            proved(RATES, {"1/2": str(10 * three), "1/3": str(-two)}, opposite)
