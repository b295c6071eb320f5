"""Where units come from: the comment lines that say so, read and written."""

import time

import pytest
from hypothesis import given
from hypothesis import strategies as st

from foon_asp.network import Source
from foon_asp.text.provenance import is_video, read_copy, read_video, write_copy
from foon_asp.text.reader import FoonReader
from tests.text.foon_strategies import steady

UNIT = "O\ta\nM\tmix\nO\tb\n//\n"


@pytest.mark.parametrize(
    ("comment", "video"),
    [
        ("# Source: https://example.org/1 ", "https://example.org/1"),
        ("# Source:https://example.org/1", "https://example.org/1"),
        ("# Source:\ttwo words", "two words"),
        ("# Source:\tone\ttwo", "one two"),
        ("# Source: \t", None),
        ("# source: x", None),
        ("# made from # Source: x", None),
        ("# From:\ta.txt:3", None),
    ],
)
def test_a_comment_may_name_a_video(comment: str, video: str | None) -> None:
    assert read_video(comment) == video
    assert is_video(comment) == comment.startswith("# Source:")


@pytest.mark.parametrize(
    ("comment", "source"),
    [
        ("# From:\ta.txt:3", Source("a.txt", 3)),
        ("# From:\ta.txt:3\tv\tw", Source("a.txt", 3, 1, ("v", "w"))),
        ("# From:\ta.txt:3\t\tw \t", Source("a.txt", 3, 1, ("w",))),
        ("# From:\tmy folder/1:2 tea.txt:17", Source("my folder/1:2 tea.txt", 17)),
        ("# From:\ta.txt:3:4", Source("a.txt:3", 4)),
        ("# From:\ta.txt", None),
        ("# From:\t:3", None),
        ("# from:\ta.txt:3", None),
        ("# it is From:\ta.txt:3", None),
    ],
)
def test_a_comment_may_name_a_copy(comment: str, source: Source | None) -> None:
    assert read_copy(comment) == source


_words = st.text(
    st.characters(exclude_categories=["Cs", "Cc", "Zs", "Zl", "Zp"]) | st.sampled_from(":# "),
    min_size=1,
    max_size=8,
).filter(lambda word: word == word.strip())
_sources = st.builds(
    Source, _words, st.integers(1, 999_999_999), st.just(1), st.lists(_words, max_size=3).map(tuple)
)


@steady
@given(st.lists(_sources, min_size=1, max_size=4))
def test_a_unit_has_the_copies_above_it(sources: list[Source]) -> None:
    reader = FoonReader()
    text = "//\n" + "".join(map(write_copy, sources)) + UNIT + UNIT
    assert [unit.sources for unit in reader.units(text, "f.txt")] == [
        tuple(sources),
        (Source("f.txt", len(sources) + 6),),
    ]
    assert next(unit.sources for unit in reader.listed_units(text, "f.txt")) == tuple(sources)
    assert reader.diagnostics == []


def test_copies_may_stand_among_other_comments_and_blank_lines() -> None:
    text = "# one\n# From:\ta.txt:3\n\n# two\n# From:\tb.txt:9\n# From: nowhere\n" + UNIT
    (unit,) = FoonReader().units(text, "f.txt")
    assert unit.sources == (Source("a.txt", 3), Source("b.txt", 9))


def test_copies_have_videos_of_their_own() -> None:
    text = "# Source:\tv\n//\n# From:\ta.txt:3\tw\n# From:\tb.txt:9\n" + UNIT + UNIT
    first, second = FoonReader().units(text, "f.txt")
    assert [source.videos for source in first.sources] == [("w",), ()]
    assert second.sources == (Source("f.txt", 9, 1, ("v",)),)


def test_copies_of_a_unit_that_is_left_out_are_not_those_of_the_next() -> None:
    reader = FoonReader()
    (unit,) = reader.units("# From:\ta.txt:3\nO\ta\n//\n" + UNIT, "f.txt")
    assert [d.code for d in reader.diagnostics] == ["no-motion"]
    assert unit.sources == (Source("f.txt", 4),)


@pytest.mark.parametrize("above", ["# From:\ta.txt:33", "# From:\tb.txt:9\tv\n# From:\ta.txt:33"])
@pytest.mark.parametrize("end", ["\n//\n", "\n//\n//\n\n"])
def test_copies_named_above_no_unit_are_those_of_none(above: str, end: str) -> None:
    reader = FoonReader()
    (unit,) = reader.units(above + end + UNIT, "f.txt")
    assert unit.sources == (Source("f.txt", (above + end).count("\n") + 1),)
    assert reader.diagnostics == []


def test_remarks_are_about_the_file_at_hand() -> None:
    reader = FoonReader()
    (unit,) = reader.units("# From:\ta.txt:3\nO\ta\t00\nM\tmix\nO\tb\n//\n", "f.txt")
    assert unit.source.file == "a.txt"
    assert [(d.source.file, d.source.line) for d in reader.diagnostics] == [("f.txt", 2)]


@pytest.mark.parametrize("start", ["# From:", "# From:\ta.txt:3", "# Source:\tx"])
@pytest.mark.parametrize("many", [" ", ": ", ":1", " \t"])
def test_a_million_letters_take_no_time(start: str, many: str) -> None:
    comment = start + many * (1_000_000 // len(many)) + "x:"
    began = time.process_time()
    read_copy(comment)
    read_video(comment)
    assert time.process_time() - began < 1
