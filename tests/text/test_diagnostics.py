"""How remarks look: place, message, the line with a caret, and many of a kind folded."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from foon_asp.errors import UserError
from foon_asp.network import Source
from foon_asp.text.diagnostics import (
    Diagnostic,
    InputError,
    Severity,
    brief_summary,
    excerpt_with_caret,
    summarize,
)
from tests.text.foon_strategies import steady


def warning(line: int, code: str = "time", file: str = "f.txt", excerpt: str = "") -> Diagnostic:
    return Diagnostic(Severity.WARNING, code, f"about line {line}", Source(file, line, 3), excerpt)


def test_a_diagnostic_gives_place_message_and_line_without_its_fix() -> None:
    error = Diagnostic(Severity.ERROR, "syntax", "found x", Source("a b.txt", 7, 12, ("video",)))
    assert str(error) == "a b.txt:7:12: error: found x"
    pointing = warning(4, excerpt="M\tmix\tx")
    assert str(pointing).split("\n") == [
        "f.txt:4:3: warning: about line 4",
        "    M→mix→x",
        "      ^",
    ]
    assert str(pointing._replace(fix="M\tmix")) == str(pointing)


@pytest.mark.parametrize(
    ("line", "column", "shown"),
    [
        ("abc", 4, ["    abc", "       ^"]),
        ("", 1, ["    ", "    ^"]),
        ("a\tb", 3, ["    a→b", "      ^"]),
        ("a\x00b\x1b[31m\x85", 4, ["    a�b�[31m�", "       ^"]),
        ("a\u2028b", 3, ["    a�b", "      ^"]),
        ("crème", 4, ["    crème", "       ^"]),
    ],
)
def test_the_caret_stands_under_the_column(line: str, column: int, shown: list[str]) -> None:
    assert excerpt_with_caret(line, column).split("\n") == shown


@steady
@given(st.text(max_size=30), st.data(), st.integers(1, 12))
def test_the_caret_never_points_at_another_character(line: str, data: st.DataObject, width: int) -> None:
    column = data.draw(st.integers(1, len(line) + 1))
    shown, caret = excerpt_with_caret(line, column, width).split("\n")
    assert caret.strip() == "^"
    at = caret.index("^")
    meant = line[column - 1 : column].replace("\t", "→")
    assert shown[at : at + 1] == (meant if meant.isprintable() else "�")
    assert shown.isprintable()
    assert len(shown) <= 4 + width


@pytest.mark.parametrize(("count", "shown", "rest"), [(1, 1, 0), (40, 40, 0), (41, 40, 1), (42, 40, 2)])
def test_an_input_error_shows_the_first_errors_and_counts_the_rest(count: int, shown: int, rest: int) -> None:
    found = [warning(line) for line in range(1, count + 1)]
    error = InputError(found)
    assert isinstance(error, UserError)
    assert error.diagnostics == tuple(found)
    lines = str(error).split("\n")
    assert lines[:shown] == [str(d) for d in found[:shown]]
    assert len(lines) == shown + bool(rest)
    if rest:
        assert lines[-1].startswith(f"... and {rest} more error{'s' * (rest > 1)}; ")


def test_in_brief_few_are_told_and_many_are_counted() -> None:
    few = [warning(line, code) for line in (3, 8) for code in ("time", "motion-flag", "outer-space")]
    assert brief_summary(few) == summarize(few)
    many = [*few, warning(9, "time"), warning(4, "syntax", "my kitchen.txt")]
    assert brief_summary(many) == [
        "warning: 8 remarks on the data (3 time, 2 motion-flag, 2 outer-space, 1 syntax); "
        "see foon-asp lint f.txt 'my kitchen.txt'"
    ]
    assert brief_summary([]) == []


def test_each_kind_in_each_file_is_told_once_with_the_lines_of_the_others() -> None:
    found = [
        warning(5, "time"),
        warning(1, "outer-space"),
        warning(6, "time"),
        warning(7, "time", "g.txt"),
        warning(2, "outer-space"),
        warning(9, "outer-space"),
    ]
    assert summarize(found, max_lines=1) == [
        f"{found[0]}\n    2 warnings of this kind (time); others on line 6",
        f"{found[1]}\n    3 warnings of this kind (outer-space); others on line 2, ...",
        str(found[3]),
    ]
    assert summarize(found)[1].endswith("others on line 2, 9")
    assert summarize([]) == []
