"""Success rates: exact decimals above 0 and at most 1, each motion once."""

from fractions import Fraction
from pathlib import Path

import pytest

from foon_asp.network import Source
from foon_asp.text.diagnostics import Diagnostic, InputError
from foon_asp.text.tables import RATES


def rates(folder: Path, text: str) -> dict[str, Fraction]:
    file = folder / "motion.txt"
    file.write_text(text, "utf-8", newline="")
    return RATES.read(file)


def errors(folder: Path, text: str) -> tuple[Diagnostic, ...]:
    with pytest.raises(InputError) as caught:
        rates(folder, text)
    return caught.value.diagnostics


@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
@pytest.mark.parametrize("start", ["", "\N{BYTE ORDER MARK}"])
def test_a_table_has_exact_decimals_comments_and_blank_lines(tmp_path: Path, end: str, start: str) -> None:
    text = (
        "pour\t0.3\n# how often\n\n \t \n#mix\t0.1\n  whisk by hand \t 1. \ncut\t.5\nfry\t00.250\ncut\t0.50\n"
        "boil\t0.333333333333333333333\nstir\t0.000000001"
    )
    assert rates(tmp_path, start + text.replace("\n", end)) == {
        "pour": Fraction(3, 10),
        "whisk by hand": Fraction(1),
        "cut": Fraction(1, 2),
        "fry": Fraction(1, 4),
        "boil": Fraction(333333333333333333333, 10**21),
        "stir": Fraction(1, 10**9),
    }


def test_an_empty_table_is_no_error(tmp_path: Path) -> None:
    assert rates(tmp_path, "") == {}


DECIMAL = "expected a success rate as a decimal such as 0.85"


@pytest.mark.parametrize(
    ("line", "column", "message"),
    [
        ("mix up\t0.00", 8, "found the success rate 0.00, expected a rate above 0 and at most 1"),
        ("mix up\t1.01", 8, "found the success rate 1.01, expected a rate above 0 and at most 1"),
        ("mix up\t1e-1", 8, f"found '1e-1', {DECIMAL}"),
        ("mix up\t0,5", 8, f"found '0,5', {DECIMAL}"),
        ("mix up\t.", 8, f"found '.', {DECIMAL}"),
        ("mix up\t٠.٥", 8, f"found '٠.٥', {DECIMAL}"),
        ("mix up\t", 8, f"found '', {DECIMAL}"),
        ("mix up\t0." + "3" * 999, 8, "found a number of 1001 letters, expected at most 1000"),
        ("mix 0.5", 8, "found the end of the line, expected a tab and a success rate"),
        ("  \t0.5", 1, "found a success rate, expected the motion before it"),
        ("pour\t0.6", 6, "found a second success rate for 'pour', expected one"),
    ],
)
def test_a_row_that_is_none_is_named_in_place(tmp_path: Path, line: str, column: int, message: str) -> None:
    (error,) = errors(tmp_path, f"pour\t0.5\r\n{line}\r\n")
    assert error.source == Source(str(tmp_path / "motion.txt"), 2, column)
    assert (error.message, error.excerpt) == (message, line)


def test_all_errors_are_told(tmp_path: Path) -> None:
    found = errors(tmp_path, "a\t0\nb\t0.5\nc\nd\tx\nb\t0.4\n")
    assert [(error.source.line, error.source.column) for error in found] == [(1, 3), (3, 2), (4, 3), (5, 3)]
