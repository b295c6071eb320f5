"""Prices of units: exact decimals from 0, by motion and of single units, each once."""

from fractions import Fraction
from pathlib import Path

import pytest

from foon_asp.network import FunctionalUnit, ObjectNode, Source, UnitPrices
from foon_asp.text.diagnostics import InputError
from foon_asp.text.unit_price_list import UnitPriceList, read_unit_prices, write_unit_prices

DOUGH = ObjectNode.of("dough", ["raw"], [("in", "tin")])
OVEN = ObjectNode.of("oven")
BREAD = ObjectNode.of("bread", [], [], [("contains", ["flour", "salt"])])
BAKE = FunctionalUnit("bake", (DOUGH, OVEN), (BREAD,))
LINE = "bake\tdough; raw; in [tin]\toven\t→\tbread; contains {salt,flour}\t"


def read(folder: Path, text: str) -> UnitPriceList:
    file = folder / "prices.txt"
    file.write_text(text, "utf-8", newline="")
    return read_unit_prices(file)


def faults(folder: Path, text: str) -> list[tuple[int, int, str]]:
    with pytest.raises(InputError) as caught:
        read(folder, text)
    assert {d.code for d in caught.value.diagnostics} == {"unit-price"}
    assert all(d.excerpt in text for d in caught.value.diagnostics)
    return [(d.source.line, d.source.column, d.message) for d in caught.value.diagnostics]


@pytest.mark.parametrize(
    ("written", "price"),
    [
        ("0.000", Fraction(0)),
        (" 1.99 ", Fraction(199, 100)),
        (".5", Fraction(1, 2)),
        ("7.", Fraction(7)),
        ("0." + "0" * 29 + "1", Fraction(1, 10**30)),
        ("1" + "0" * 40 + ".1", 10**40 + Fraction(1, 10)),
    ],
)
def test_a_price_is_the_decimal_that_is_written(tmp_path: Path, written: str, price: Fraction) -> None:
    assert read(tmp_path, f"chop\t{written}\n").motions == {"chop": price}
    assert read(tmp_path, f"{LINE}{written}\n").units == {BAKE: price}


@pytest.mark.parametrize("end", ["\n", "\r\n"])
@pytest.mark.parametrize("arrow", ["→", "->", " -> "])
def test_a_file_with_both_kinds_of_lines(tmp_path: Path, end: str, arrow: str) -> None:
    text = f"# cents\n\nbake\t12\n \t\n  pick-and-place \t.5\n{LINE.replace('→', arrow)}9.5\nbake\t12.0"
    found = read(tmp_path, text.replace("\n", end))
    assert found.motions == {"bake": 12, "pick-and-place": Fraction(1, 2)}
    assert found.units == {BAKE: Fraction(19, 2)}
    assert found.sources == {BAKE: Source(str(tmp_path / "prices.txt"), 6)}


def test_a_unit_is_what_it_is_in_whatever_order(tmp_path: Path) -> None:
    other = "bake\toven;\tdough; in [tin]; raw\t->\tbread; contains {flour,salt}\t9.50\n"
    assert read(tmp_path, f"{LINE}9.5\n{other}").units == {BAKE: Fraction(19, 2)}
    nothing = read(tmp_path, "eat\toven\t->\t1\n").units
    assert list(nothing) == [FunctionalUnit("eat", (OVEN,), ())]


EXPECTED = "expected a price from 0, as a decimal such as 1.99"


@pytest.mark.parametrize(
    ("line", "column", "said"),
    [
        ("chop", 5, "found the end of the line, expected a tab and a price"),
        ("\t1", 1, "found a price, expected the motion before it"),
        ("chop\t-1", 6, f"found '-1', {EXPECTED}"),
        ("chop\t" + "1" * 1001, 6, "found a number of 1001 letters, expected at most 1000"),
        (
            "bake\toven\t1",
            11,
            "found the price of a unit, expected an arrow (-> between two tabs) before it",
        ),
        ("bake\t->\toven\t1", 6, "found an arrow, expected an input before it"),
        (
            "bake\toven\t->\tbread\t→\tbread\t1",
            20,
            "found a second arrow, expected an object node or the price",
        ),
        ("bake\toven\t->\t bread; in [tin\t1", 25, "found '[tin', expected [object]"),
        ("bake\toven\t\t->\tbread\t1", 11, "found the end of the line, expected a name"),
    ],
)
def test_what_is_wrong_has_its_place(tmp_path: Path, line: str, column: int, said: str) -> None:
    found = faults(tmp_path, f"mix\t1\n{line}\n")
    assert [each[:2] for each in found] == [(2, column)]
    assert found[0][2].startswith(said)


def test_two_prices_for_one_are_an_error_and_all_errors_are_told(tmp_path: Path) -> None:
    text = f"chop\t1\n{LINE}2\nchop\t1.0\nchop\t2\n{LINE}2.5\nmix\tx\n"
    assert [(line, said) for line, _, said in faults(tmp_path, text)] == [
        (4, "found a second price for 'chop', expected one"),
        (5, f"found a second price for {str(BAKE)!r}, expected one"),
        (6, f"found 'x', {EXPECTED}"),
    ]


def test_what_is_written_is_read_back(tmp_path: Path) -> None:
    prices = UnitPrices(
        {"bake": Fraction(12), "mix": Fraction(0)},
        {BAKE: Fraction(1, 10**30), FunctionalUnit("eat", (OVEN,), ()): Fraction(3)},
    )
    found = read(tmp_path, write_unit_prices(prices))
    assert (found.motions, found.units) == prices
