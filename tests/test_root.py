"""Roots of rational numbers: compared and rounded without any float."""

import random
from fractions import Fraction

import pytest

from foon_asp.problem.root import Root, whole_root


def test_the_whole_part_of_a_root() -> None:
    for degree in range(1, 7):
        for number in [*range(200), 10**40, 10**40 - 1, 7**30, 7**30 - 1, 7**30 + 1, 2**200 + 5]:
            root = whole_root(degree, number)
            assert root**degree <= number < (root + 1) ** degree


def test_a_root_is_of_the_least_degree() -> None:
    assert Root.taken(2, Fraction(4, 9)) == Root(1, Fraction(2, 3))
    assert Root.taken(6, Fraction(4, 9)) == Root(3, Fraction(2, 3))
    assert Root.taken(4, Fraction(16, 81)) == Root(1, Fraction(2, 3))
    assert Root.taken(4, Fraction(1, 2)) == Root(4, Fraction(1, 2))
    assert Root.taken(6, Fraction(8, 27)) == Root(2, Fraction(2, 3))
    assert Root.taken(5, Fraction(1)) == Root(1, Fraction(1))
    assert Root.taken(2, Fraction(1, 4)).rational == Fraction(1, 2)
    assert Root.taken(2, Fraction(1, 2)).rational is None


@pytest.mark.parametrize(("degree", "of"), [(0, Fraction(1)), (2, Fraction(0)), (1, Fraction(-1))])
def test_only_positive_numbers_have_one(degree: int, of: Fraction) -> None:
    with pytest.raises(ValueError, match="positive"):
        Root.taken(degree, of)


def test_roots_are_in_order_and_rounded_to_both_sides() -> None:
    rng = random.Random(1)
    for _ in range(300):
        of = Fraction(rng.randint(1, 10 ** rng.randint(1, 30)), rng.randint(1, 10 ** rng.randint(1, 30)))
        root = Root.taken(rng.randint(1, 5), of)
        digits = rng.randint(1, 12)
        below, above = root.below(digits), root.above(digits)
        assert below**root.degree <= root.of <= above**root.degree
        assert Root(1, below) <= root <= Root(1, above)
        step = above - below
        assert step == 0 or (step.numerator == 1 or step.denominator == 1)
        assert step == 0 or below / step < 10**digits
        assert step == 0 or above / step >= 10 ** (digits - 1)
        other = Root.taken(rng.randint(1, 5), of)
        assert (root < other) == (root.of**other.degree < other.of**root.degree)
        assert root.over(Fraction(3)) < root
    assert Root(1, Fraction(3, 4)).below(4) == Root(1, Fraction(3, 4)).above(2) == Fraction(3, 4)
    assert Root(2, Fraction(1, 2)).below(4) == Fraction("0.7071")
    assert Root(2, Fraction(1, 2)).above(4) == Fraction("0.7072")
