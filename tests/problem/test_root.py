"""Roots of rational numbers: compared and rounded without any float."""

import random
from fractions import Fraction

import pytest

from foon_asp.problem.root import Root, integer_root


def test_the_whole_part_of_a_root() -> None:
    for degree in range(1, 7):
        for number in [*range(100), 7**30, 7**30 - 1, 7**30 + 1, 2**200 + 5]:
            root = integer_root(degree, number)
            assert root**degree <= number < (root + 1) ** degree


@pytest.mark.parametrize(
    ("degree", "of", "least", "base"),
    [
        (6, "4/9", 3, "2/3"),
        (4, "16/81", 1, "2/3"),
        (4, "1/2", 4, "1/2"),
        (6, "8/27", 2, "2/3"),
        (5, "1", 1, "1"),
    ],
)
def test_a_root_is_of_the_least_degree(degree: int, of: str, least: int, base: str) -> None:
    root = Root.simplify(degree, Fraction(of))
    assert root == Root(least, Fraction(base))
    assert root.rational == (Fraction(base) if least == 1 else None)


@pytest.mark.parametrize(("degree", "of"), [(0, 1), (2, 0), (1, -1)])
def test_only_positive_numbers_have_one(degree: int, of: int) -> None:
    with pytest.raises(ValueError, match="positive"):
        Root.simplify(degree, Fraction(of))


def test_roots_are_in_order_and_rounded_to_both_sides() -> None:
    rng = random.Random(1)
    for _ in range(300):
        of = Fraction(rng.randint(1, 10 ** rng.randint(1, 30)), rng.randint(1, 10 ** rng.randint(1, 30)))
        root, other = (Root.simplify(rng.randint(1, 5), of) for _ in range(2))
        digits = rng.randint(1, 12)
        below, above = root.round_down(digits), root.round_up(digits)
        assert Root(1, below) <= root <= Root(1, above)
        if step := above - below:
            assert 1 in step.as_integer_ratio()
            assert below / step < 10**digits
            assert above / step >= 10 ** (digits - 1)
        assert (root < other) == (root.of**other.degree < other.of**root.degree)
        assert root.divide_by(Fraction(2, 3)).of * Fraction(2, 3) ** root.degree == root.of
    assert Root(1, Fraction(3, 4)).round_down(4) == Root(1, Fraction(3, 4)).round_up(2) == Fraction(3, 4)
    assert Root(2, Fraction(1, 2)).round_down(4) == Fraction("0.7071")
    assert Root(2, Fraction(1, 2)).round_up(4) == Fraction("0.7072")
