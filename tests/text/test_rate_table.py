"""Success rates: exact decimals above 0 and at most 1, each motion once."""

from fractions import Fraction
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from foon_asp.errors import UserError
from foon_asp.network import Source
from foon_asp.text.diagnostics import Diagnostic, InputError
from foon_asp.text.rate_table import read_rates
from tests.text.foon_strategies import names, steady


def rates(tmp_path: Path, text: str) -> dict[str, Fraction]:
    file = tmp_path / "motion.txt"
    file.write_text(text, "utf-8", newline="")
    return read_rates(file)


def errors(tmp_path: Path, text: str) -> tuple[Diagnostic, ...]:
    with pytest.raises(InputError) as caught:
        rates(tmp_path, text)
    return caught.value.diagnostics


def outcome(tmp_path: Path, text: str) -> tuple[dict[str, Fraction], tuple[Diagnostic, ...]]:
    """Give the rates, or else what is wrong."""
    try:
        return rates(tmp_path, text), ()
    except InputError as error:
        return {}, error.diagnostics


@pytest.mark.parametrize(
    ("written", "rate"),
    [
        ("0.1", Fraction(1, 10)),
        ("0.30", Fraction(3, 10)),
        ("1", Fraction(1)),
        ("1.0", Fraction(1)),
        ("1.", Fraction(1)),
        (".5", Fraction(1, 2)),
        ("00.25", Fraction(1, 4)),
        (" 0.75 ", Fraction(3, 4)),
        ("0.333333333333333333333", Fraction(333333333333333333333, 10**21)),
        ("0.000000001", Fraction(1, 10**9)),
    ],
)
def test_a_rate_is_the_decimal_that_is_written(tmp_path: Path, written: str, rate: Fraction) -> None:
    assert rates(tmp_path, f"pour\t{written}\n") == {"pour": rate}


@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_a_table_with_comments_and_blank_lines(tmp_path: Path, end: str) -> None:
    text = "# how often it works\n\npour\t0.9\n \t \n#mix\t0.1\npick-and-place\t0.85\n  whisk \t1"
    assert rates(tmp_path, text.replace("\n", end)) == {
        "pour": Fraction(9, 10),
        "pick-and-place": Fraction(85, 100),
        "whisk": Fraction(1),
    }


def test_a_byte_order_mark_is_no_part_of_the_first_motion(tmp_path: Path) -> None:
    assert rates(tmp_path, "\N{BYTE ORDER MARK}pour\t0.5\n") == {"pour": Fraction(1, 2)}


def test_an_empty_table_is_no_error(tmp_path: Path) -> None:
    assert rates(tmp_path, "") == {}


@pytest.mark.parametrize(
    ("value", "message"),
    [
        ("0", "found the success rate 0, expected a rate above 0 and at most 1"),
        ("0.000", "found the success rate 0.000, expected a rate above 0 and at most 1"),
        ("1.01", "found the success rate 1.01, expected a rate above 0 and at most 1"),
        ("2", "found the success rate 2, expected a rate above 0 and at most 1"),
        ("-0.5", "found '-0.5', expected a success rate as a decimal such as 0.85"),
        ("+0.5", "found '+0.5', expected a success rate as a decimal such as 0.85"),
        ("high", "found 'high', expected a success rate as a decimal such as 0.85"),
        ("50%", "found '50%', expected a success rate as a decimal such as 0.85"),
        ("1/2", "found '1/2', expected a success rate as a decimal such as 0.85"),
        ("1e-1", "found '1e-1', expected a success rate as a decimal such as 0.85"),
        ("0,5", "found '0,5', expected a success rate as a decimal such as 0.85"),
        (".", "found '.', expected a success rate as a decimal such as 0.85"),
        ("nan", "found 'nan', expected a success rate as a decimal such as 0.85"),
        ("٠.٥", "found '٠.٥', expected a success rate as a decimal such as 0.85"),
        ("", "found '', expected a success rate as a decimal such as 0.85"),
        ("0.5 0.6", "found '0.5 0.6', expected a success rate as a decimal such as 0.85"),
    ],
)
def test_a_rate_that_is_none_is_named_in_place(tmp_path: Path, value: str, message: str) -> None:
    (error,) = errors(tmp_path, f"pour\t0.5\r\nmix up\t{value}\r\n")
    assert error.source == Source(str(tmp_path / "motion.txt"), 2, 8)
    assert error.message == message
    assert error.excerpt == f"mix up\t{value}"


def test_a_missing_tab_is_named_at_the_end_of_the_line(tmp_path: Path) -> None:
    (error,) = errors(tmp_path, "# x\npour 0.5\n")
    assert (error.source.line, error.source.column) == (2, 9)
    assert error.message == "found the end of the line, expected a tab and a success rate"


def test_a_rate_given_twice_is_no_error_where_it_is_the_same(tmp_path: Path) -> None:
    assert rates(tmp_path, "pour\t0.5\nmix\t1\npour\t.50\n") == {"pour": Fraction(1, 2), "mix": Fraction(1)}


def test_two_different_rates_are_an_error_at_the_second(tmp_path: Path) -> None:
    (error,) = errors(tmp_path, "pour\t0.5\nmix\t1\npour\t0.6\n")
    assert (error.source.line, error.source.column) == (3, 6)
    assert error.message.startswith("found a second success rate for 'pour'")


def test_all_errors_are_told(tmp_path: Path) -> None:
    found = errors(tmp_path, "a\t0\nb\t0.5\nc\nd\tx\nb\t0.4\n")
    assert [(error.source.line, error.source.column) for error in found] == [(1, 3), (3, 2), (4, 3), (5, 3)]


def test_a_table_that_is_not_there_or_not_text_is_refused(tmp_path: Path) -> None:
    with pytest.raises(UserError, match=r"nothing\.txt: cannot be read"):
        read_rates(tmp_path / "nothing.txt")
    (tmp_path / "motion.txt").write_bytes(b"pour\t0.5\nfl\xe9ttern\t1\n")
    with pytest.raises(InputError, match=r"motion\.txt:2:3: error: found the byte 0xe9"):
        read_rates(tmp_path / "motion.txt")


@pytest.mark.parametrize("line", ["\t0.5", "  \t0.5"])
def test_a_missing_motion_is_an_error_in_place(tmp_path: Path, line: str) -> None:
    (error,) = errors(tmp_path, f"pour\t0.5\n{line}\n")
    assert error.source.line == 2
    assert "motion" in error.message


def test_a_rate_of_very_many_digits_is_read_or_refused_in_place(tmp_path: Path) -> None:
    found, diagnostics = outcome(tmp_path, "pour\t0." + "3" * 5000)
    assert found == {"pour": Fraction(10**5000 // 3, 10**5000)} or diagnostics[0].source.line == 1


@steady
@given(st.dictionaries(names().map(str.strip), st.integers(1, 10**6), max_size=4))
def test_any_table_is_read_as_written(
    tmp_path_factory: pytest.TempPathFactory, table: dict[str, int]
) -> None:
    table = {motion: rate for motion, rate in table.items() if motion and motion[0] not in "#\ufeff"}
    text = "".join(f"{motion}\t{rate // 10**6}.{rate % 10**6:06}\n" for motion, rate in table.items())
    assert rates(tmp_path_factory.getbasetemp(), text) == {
        motion: Fraction(rate, 10**6) for motion, rate in table.items()
    }


@steady
@given(st.text(max_size=40) | st.text("ab\t0.15#\n\r ", max_size=40))
def test_any_table_is_read_or_refused_in_place(tmp_path_factory: pytest.TempPathFactory, text: str) -> None:
    found, diagnostics = outcome(tmp_path_factory.getbasetemp(), text)
    assert all(0 < rate <= 1 for rate in found.values())
    for diagnostic in diagnostics:
        line = text.removeprefix("\ufeff").split("\n")[diagnostic.source.line - 1]
        assert 1 <= diagnostic.source.column <= len(line) + 1
