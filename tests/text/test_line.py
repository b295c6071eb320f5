"""The grammar of single lines and of the one-line notation: what they mean, where they are at fault."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from foon_asp.network import Contents, ObjectNode, Relation
from foon_asp.text.line import Line, LineError, MotionLine, ObjectLine, StateLine
from foon_asp.text.line_parser import parse_line, parse_lines, parse_node, read_state
from foon_asp.text.writer import write_line
from tests.text.foon_strategies import dirty_lines, lines, names, nodes, steady

ANY_LINE = (
    "an object line (O, tab, label)",
    "a state line (S, tab, state)",
    "a motion line (M, tab, motion)",
    "a separator (//)",
)
NAME = ("a name",)
BRACKET = ("[object]", "{ingredient,ingredient}", "the end of the line")
FIELD = ("a tab and a flag or time", "the end of the line")
END = ("the end of the line",)


# --- what lines mean


@pytest.mark.parametrize(
    ("line", "parsed"),
    [
        ("O\tonion", ObjectLine("onion")),
        ("O278\tmixing bowl", ObjectLine("mixing bowl", "278")),
        ("O278\tmixing bowl\t1", ObjectLine("mixing bowl", "278", ("1",))),
        ("O\tmixing bowl\t0", ObjectLine("mixing bowl", "", ("0",))),
        ("O3\tonion\t1\t15", ObjectLine("onion", "3", ("1", "15"))),
        ("O007\tonion", ObjectLine("onion", "007")),
        ("O\tonion\t!", ObjectLine("onion", "", ("!",))),
        ("O\tonion\t0\t!", ObjectLine("onion", "", ("0", "!"))),
        ("O\t7-up", ObjectLine("7-up")),
        ("O\tsalt, coarse", ObjectLine("salt, coarse")),
        ("O\t#1 flour", ObjectLine("#1 flour")),
        ("O\tcrème brûlée", ObjectLine("crème brûlée")),
        ("O\ta  b", ObjectLine("a  b")),
        ("O\tO", ObjectLine("O")),
    ],
)
def test_an_object_line_gives_label_id_flag_and_tag(line: str, parsed: ObjectLine) -> None:
    assert parse_line(line) == parsed
    assert write_line(parsed) == line


@pytest.mark.parametrize(
    ("line", "flag", "is_goal", "category"),
    [
        ("O\ta", None, False, None),
        ("O\ta\t0", "0", False, None),
        ("O\ta\t1", "1", False, None),
        ("O\ta\t01", "1", False, None),
        ("O\ta\t1\t15", "1", True, "15"),
        ("O\ta\t0\t!", "0", True, None),
        ("O\ta\t!", None, True, None),
        ("O\ta\t7", None, True, "7"),
        ("O\ta\t!\t7", None, True, "7"),
        ("O\ta\t0\t00", "0", False, None),
        ("O\ta\t0\tchopped", "0", False, None),
    ],
)
def test_an_object_line_says_whether_it_moves_and_is_a_goal(
    line: str, flag: str | None, is_goal: bool, category: str | None
) -> None:
    parsed = parse_line(line)
    assert isinstance(parsed, ObjectLine)
    assert (parsed.motion_flag, parsed.is_goal, parsed.category) == (flag, is_goal, category)


@pytest.mark.parametrize(
    ("line", "parsed"),
    [
        ("M\tpour", MotionLine("pour")),
        ("M54\tpour", MotionLine("pour", "54")),
        ("M54\tpour\t1:10\t1:11", MotionLine("pour", "54", False, ("1:10", "1:11"))),
        ("M\tpick-and-place\t0:05\t12:59", MotionLine("pick-and-place", "", False, ("0:05", "12:59"))),
        ("M\tpour\tAssumed\tassumed", MotionLine("pour", "", False, ("Assumed", "assumed"))),
        ("M\tpour\tASSUMED", MotionLine("pour", "", False, ("ASSUMED",))),
        ("M\tpour\t<1:10>\t<Assumed>", MotionLine("pour", "", False, ("<1:10>", "<Assumed>"))),
        ("M\tpour\t1:02:03\t1:02:04", MotionLine("pour", "", False, ("1:02:03", "1:02:04"))),
        (
            "M\tpour\t<0:12-0:34,0:40-0:44>",
            MotionLine("pour", "", False, ("<0:12-0:34,0:40-0:44>",)),
        ),
        ("M\tpour\t<Assumed,Assumed>", MotionLine("pour", "", False, ("<Assumed,Assumed>",))),
        (
            "M4\tpour\t<0:01,0:09>\tRobot\t0.85",
            MotionLine("pour", "4", False, ("<0:01,0:09>", "Robot", "0.85")),
        ),
        (
            "M4\tpour\t0:01\t0:09\tHuman\t1",
            MotionLine("pour", "4", False, ("0:01", "0:09", "Human", "1")),
        ),
        ("M4\tpour*", MotionLine("pour", "4", True)),
        ("M\tpick-and-place*\t0:05", MotionLine("pick-and-place", "", True, ("0:05",))),
        ("M\t*", MotionLine("*")),
    ],
)
def test_a_motion_line_gives_motion_id_mark_times_entity_and_rate(line: str, parsed: MotionLine) -> None:
    assert parse_line(line) == parsed
    assert write_line(parsed) == line


@pytest.mark.parametrize(
    ("line", "attribute"),
    [
        ("S\twhole", "whole"),
        ("S41\toff (ready)", "off (ready)"),
        ("S\tin", "in"),
        ("S\tin\t[mixing bowl]", Relation("in", "mixing bowl")),
        ("S65\tattached to\t[mixer]", Relation("attached to", "mixer")),
        ("S\tcontains\t{salt}", Contents("contains", ("salt",))),
        ("S23\tcontains\t{salt,black pepper,oil}", Contents("contains", ("black pepper", "oil", "salt"))),
        ("S\tcoated\t{oil}", Contents("coated", ("oil",))),
    ],
)
def test_a_state_line_gives_a_state_a_relation_or_contents(
    line: str, attribute: str | Relation | Contents
) -> None:
    parsed = parse_line(line)
    assert isinstance(parsed, StateLine)
    assert parsed.attribute == attribute
    assert parsed.remarks == ()
    assert f"S{parsed.id}" == line.partition("\t")[0]
    assert write_line(parsed) == line


def test_ingredients_are_kept_in_the_order_listed() -> None:
    assert parse_line("S9\tcontains\t{b,c,a}") == StateLine(
        Contents("contains", ("a", "b", "c")), "9", ("b", "c", "a")
    )


def test_the_word_of_a_relation_matters() -> None:
    assert parse_line("S\tin\t[bowl]") != parse_line("S\ton\t[bowl]")


# --- what is remarked on


@pytest.mark.parametrize(
    ("line", "attribute", "remarks"),
    [
        ("S\tunder [pan]", Relation("under", "pan"), [(8, "space-for-tab")]),
        ("S65\tunder [pan]", Relation("under", "pan"), [(10, "space-for-tab")]),
        ("S\tcontains {a}", Contents("contains", ("a",)), [(11, "space-for-tab")]),
        ("S\t cold", "cold", [(3, "outer-space")]),
        ("S\tcold  ", "cold", [(7, "outer-space")]),
        ("S\t in\t[pan]", Relation("in", "pan"), [(3, "outer-space")]),
        ("S\tin\t[ pan]", Relation("in", "pan"), [(6, "outer-space")]),
        ("S\tcontains\t{a, b}", Contents("contains", ("a", "b")), [(15, "outer-space")]),
        # the same again in the same list is told once
        ("S\tcontains\t{ a,b }", Contents("contains", ("a", "b")), [(13, "outer-space")]),
        (
            "S\tcontains\t{a,, b,, c}",
            Contents("contains", ("a", "b", "c")),
            [(15, "empty-ingredient"), (16, "outer-space")],
        ),
        ("S\tcontains\t{a,}", Contents("contains", ("a",)), [(15, "empty-ingredient")]),
        ("S\tcontains\t{,a}", Contents("contains", ("a",)), [(13, "empty-ingredient")]),
        ("S\tcontains\t{a, ,b}", Contents("contains", ("a", "b")), [(15, "empty-ingredient")]),
        ("S\tcontains\t{}", Contents("contains", ()), [(13, "empty-ingredient")]),
        ("S\tcontains\t{b,a,b}", Contents("contains", ("a", "b", "b")), [(17, "repeated-ingredient")]),
        ("S\tcontains\t{a,a,a}", Contents("contains", ("a", "a", "a")), [(15, "repeated-ingredient")]),
        ("S\tcoated\t[oil,salt]", Contents("coated", ("oil", "salt")), [(10, "contents-bracket")]),
        ("S\tcontains\t[baking paper]", Contents("contains", ("baking paper",)), [(12, "contents-bracket")]),
        ("S\ton\t[]", "on", [(6, "empty-relation")]),
        ("S\ton\t[ ]", "on", [(6, "empty-relation")]),
        # several at once, each in its place
        (
            "S\tcontains [a, a]",
            Contents("contains", ("a", "a")),
            [
                (11, "space-for-tab"),
                (12, "contents-bracket"),
                (15, "outer-space"),
                (15, "repeated-ingredient"),
            ],
        ),
    ],
)
def test_dirt_in_a_state_line_is_remarked_on_at_its_column(
    line: str, attribute: str | Relation | Contents, remarks: list[tuple[int, str]]
) -> None:
    parsed = parse_line(line)
    assert isinstance(parsed, StateLine)
    assert parsed.attribute == attribute
    assert sorted((remark.column, remark.code) for remark in parsed.remarks) == remarks


@pytest.mark.parametrize(
    ("line", "name", "remarks"),
    [
        ("O\ttea\t00", "tea", [(7, "motion-flag")]),
        ("O12\ttea\t2", "tea", [(9, "motion-flag")]),
        ("O\ttea\t", "tea", [(6, "empty-field")]),
        ("O\ttea\t\t1", "tea", [(6, "empty-field")]),
        ("O\ttea\t 1", "tea", [(7, "outer-space")]),
        ("O\t tea\t1", "tea", [(3, "outer-space")]),
        ("O\ttea \t?", "tea", [(6, "outer-space"), (8, "motion-flag")]),
        ("M\tmix\t1:35]\t3:0s7", "mix", [(7, "time"), (13, "time")]),
        ("M54\tmix\t1:10\t<Assumed", "mix", [(14, "time")]),
        ("M\tmix\tAssume", "mix", [(7, "time")]),
        ("M\tmix\t1:1", "mix", [(7, "time")]),
        ("M\t mix", "mix", [(3, "outer-space")]),
    ],
)
def test_dirt_in_an_object_or_motion_line_is_remarked_on_at_its_column(
    line: str, name: str, remarks: list[tuple[int, str]]
) -> None:
    parsed = parse_line(line)
    assert isinstance(parsed, ObjectLine | MotionLine)
    assert parsed[0] == name
    assert [(remark.column, remark.code) for remark in parsed.remarks] == remarks


def test_a_remark_quotes_what_it_is_about() -> None:
    def messages(line: str) -> list[str]:
        return [remark.message for remark in parse_line(line).remarks]

    assert messages("O\ttea\t00") == ["motion flag '00' read as '0'"]
    assert messages("O\ttea\t2") == ["motion flag '2' is not 0 or 1"]
    assert messages("M\tmix\t3:0s7") == ["'3:0s7' is not a time (m:ss or Assumed)"]
    assert messages("S\tunder [pan]") == ["no tab before [pan]; read as if there were one"]
    assert messages("S\tcontains\t{a,b,a}") == ["ingredient 'a' is listed twice"]
    assert messages("S\tcoated\t[b,a]") == ["[b,a] read as contents {b,a}"]


def test_a_field_that_means_nothing_is_remarked_on() -> None:
    # A number may stand there in real files; a word may be a state whose own line was forgotten.
    remarks = parse_line("O\tonion\t0\tchopped\t7").remarks
    assert [(remark.column, remark.code) for remark in remarks] == [(11, "unknown-field")]
    assert "'chopped'" in remarks[0].message


def test_a_missing_tab_is_remarked_on_where_it_belongs() -> None:
    parsed = parse_line("S\tunder[pan]")
    assert [(remark.column, remark.code) for remark in parsed.remarks] == [(8, "space-for-tab")]


@pytest.mark.parametrize(
    ("line", "remarks"),
    [
        ("S\tcoated\ta, b", [(10, "bracket"), (12, "outer-space")]),
        ("S\tcoated\ta,,b", [(10, "bracket"), (12, "empty-ingredient")]),
        ("S\tcontains\ta,a", [(12, "bracket"), (14, "repeated-ingredient")]),
        ("S\tin\ta,", [(6, "bracket"), (8, "empty-ingredient")]),
    ],
)
def test_dirt_in_a_list_without_brackets_is_remarked_on_at_its_column(
    line: str, remarks: list[tuple[int, str]]
) -> None:
    assert [(remark.column, remark.code) for remark in parse_line(line).remarks] == remarks


# --- what is mended


@pytest.mark.parametrize(
    ("line", "mended", "codes"),
    [
        # a space for a tab
        ("O tea", "O\ttea", ["space-for-tab"]),
        ("O12 tea pot\t1\t8", "O12\ttea pot\t1\t8", ["space-for-tab"]),
        ("S41 in\t[pot]", "S41\tin\t[pot]", ["space-for-tab"]),
        ("S\tunder [pan]", "S\tunder\t[pan]", ["space-for-tab"]),
        ("S\tunder[pan]", "S\tunder\t[pan]", ["space-for-tab"]),
        ("S7\tcontains  {b,a}", "S7\tcontains\t{b,a}", ["space-for-tab"]),
        ("S under [pan]", "S\tunder\t[pan]", ["space-for-tab", "space-for-tab"]),
        ("M54 pour\t1:10", "M54\tpour\t1:10", ["space-for-tab"]),
        # several tabs, blanks around and at the end
        ("O\t\ttea", "O\ttea", ["outer-space"]),
        ("O1\t tea \t1 ", "O1\ttea\t1", ["outer-space", "outer-space", "outer-space"]),
        ("O\ttea\t\t1\t", "O\ttea\t1", ["empty-field", "empty-field"]),
        ("S\thot \t ", "S\thot", ["outer-space", "outer-space"]),
        ("S\thot\t", "S\thot", ["outer-space"]),
        ("S\tin\t\t[pot]", "S\tin\t[pot]", ["outer-space"]),
        ("S\tin\t[pot]\t", "S\tin\t[pot]", ["outer-space"]),
        ("M\t\tmix\t 1:10", "M\tmix\t1:10", ["outer-space", "outer-space"]),
        # brackets left open, closed wrongly, or left out
        ("S\tin\t[pot", "S\tin\t[pot]", ["bracket"]),
        ("S\tin\t[pot}", "S\tin\t[pot]", ["bracket"]),
        ("S\tin\tpot", "S\tin\t[pot]", ["bracket"]),
        ("S\tin\tmixing bowl]", "S\tin\t[mixing bowl]", ["bracket"]),
        ("S\tcontains\t{b,a", "S\tcontains\t{b,a}", ["bracket"]),
        ("S\tcontains\t{b,a]", "S\tcontains\t{b,a}", ["bracket"]),
        ("S\tcontains\tsalt", "S\tcontains\t{salt}", ["bracket"]),
        ("S\tcoated\toil,salt", "S\tcoated\t{oil,salt}", ["bracket"]),
        ("S\tin\t[a,b", "S\tin\t{a,b}", ["bracket", "contents-bracket"]),
        ("S\tcontains\t[egg]", "S\tcontains\t{egg}", ["contents-bracket"]),
        ("S\ton\t[]", "S\ton", ["empty-relation"]),
        ("S\ton\t[", "S\ton", ["bracket", "empty-relation"]),
        # lists
        ("S\tcontains\t{ b , a }", "S\tcontains\t{b,a}", ["outer-space"]),
        ("S\tcontains\t{b,,a,}", "S\tcontains\t{b,a}", ["empty-ingredient"]),
        # flags and times
        ("O\ttea\t00", "O\ttea\t0", ["motion-flag"]),
        ("O\ttea\t01\t15", "O\ttea\t1\t15", ["motion-flag"]),
        ("M\tmix *", "M\tmix*", ["outer-space"]),
        ("M\tmix**\t0:01", "M\tmix*\t0:01", ["outer-space"]),
        ("M\tmix* \t0:01", "M\tmix*\t0:01", ["outer-space"]),
        ("M\tmix\tAssume", "M\tmix\tAssumed", ["time"]),
        ("M\tmix\t1:35]\t1:40", "M\tmix\t1:35\t1:40", ["time"]),
        ("M\tmix*\t<Assumed", "M\tmix*\t<Assumed>", ["time"]),
        ("M\tmix\t<0:01,0:09\tRobot\t0.85", "M\tmix\t<0:01,0:09>\tRobot\t0.85", ["time"]),
    ],
)
def test_what_is_beyond_doubt_is_mended(line: str, mended: str, codes: list[str]) -> None:
    parsed = parse_line(line)
    assert sorted(remark.code for remark in parsed.remarks) == sorted(codes)
    assert write_line(parsed) == mended
    assert parse_line(mended) == parsed._replace(remarks=())


@pytest.mark.parametrize(
    "line",
    [
        "O\ttea\t2",
        "O\ttea\tchopped",
        "O\ttea\t0\tchopped",
        "M\tmix\t3:0s7",
        "M\tmix\tRobot",
        "S\tcontains\t{a,a}",
        "S\tcontains\t{}",
    ],
)
def test_what_is_in_doubt_is_remarked_on_and_kept(line: str) -> None:
    parsed = parse_line(line)
    assert parsed.remarks
    assert write_line(parsed) == line


@steady
@given(lines())
def test_a_line_is_written_as_it_was_read(line: Line) -> None:
    assert parse_line(write_line(line)) == line


@steady
@given(dirty_lines() | st.text("OSM1\t []{},a:!0*", max_size=14))
def test_a_mended_line_means_the_same_and_stays_as_it_is(text: str) -> None:
    try:
        parsed = parse_line(text)
    except LineError:
        return
    mended = write_line(parsed)
    again = parse_line(mended)
    assert again._replace(remarks=()) == parsed._replace(remarks=())
    assert write_line(again) == mended
    assert len(again.remarks) <= len(parsed.remarks)
    if not parsed.remarks:
        assert mended == text


@pytest.mark.parametrize(
    "digit", "\N{ARABIC-INDIC DIGIT THREE}\N{FULLWIDTH DIGIT THREE}\N{SUPERSCRIPT THREE}"
)
def test_digits_are_those_of_the_latin_script(digit: str) -> None:
    with pytest.raises(LineError):
        parse_line(f"O{digit}\ttea")
    assert [remark.code for remark in parse_line(f"M\tmix\t1:2{digit}").remarks] == ["time"]
    assert [remark.code for remark in parse_line(f"M\tmix\tRobot\t0.{digit}").remarks] == ["time", "time"]
    assert [remark.code for remark in parse_line(f"O\ttea\t1\t{digit}").remarks] == ["unknown-field"]


# --- what is not accepted


@pytest.mark.parametrize(
    ("line", "column", "found", "expected"),
    [
        ("", 1, "the end of the line", ANY_LINE),
        ("tea", 1, "'tea'", ANY_LINE),
        ("X\ttea", 1, r"'X\ttea'", ANY_LINE),
        ("o\ttea", 1, r"'o\ttea'", ANY_LINE),
        ("O", 1, "'O'", ANY_LINE),
        ("O1a\ttea", 1, r"'O1a\ttea'", ANY_LINE),
        ("Onion\ttea", 1, r"'Onion\ttea'", ANY_LINE),
        (" O\ttea", 1, r"' O\ttea'", ANY_LINE),
        ("O\t", 3, "the end of the line", NAME),
        ("O12\t  ", 7, "the end of the line", NAME),
        ("O ", 3, "the end of the line", NAME),
        ("S [pot]", 3, "'[pot]'", NAME),
        ("O\t[pot]", 3, "'[pot]'", NAME),
        ("S\t", 3, "the end of the line", NAME),
        ("S\t[pot]", 3, "'[pot]'", NAME),
        ("S\t\t{a}", 4, "'{a}'", NAME),
        ("M\t", 3, "the end of the line", NAME),
        ("M54\t]", 5, "']'", NAME),
        ("O\ttea[", 6, "'['", FIELD),
        ("O\ttea{a}", 6, "'{a}'", FIELD),
        ("O\ttea\r", 6, r"'\r'", FIELD),
        ("M\tmix]\t1:10", 6, r"']\t1:10'", FIELD),
        ("S\tin\t[[pot]]", 5, r"'\t[[pot]]'", BRACKET),
        ("S\tcontains\t{a,{b}}", 11, r"'\t{a,{b}}'", BRACKET),
        ("S\twhole]", 8, "']'", BRACKET),
        ("S\tin\t[pot]]", 11, "']'", END),
        ("S\tin\t[pot]\t[pan]", 11, r"'\t[pan]'", END),
        ("S\tin\t[pot]\t{a}", 11, r"'\t{a}'", END),
        ("S\tcontains\t{a}x", 15, "'x'", END),
    ],
)
def test_a_line_that_is_not_accepted_says_where_what_and_what_instead(
    line: str, column: int, found: str, expected: tuple[str, ...]
) -> None:
    with pytest.raises(LineError) as caught:
        parse_line(line)
    assert (caught.value.column, caught.value.found, caught.value.expected) == (column, found, expected)


def test_the_message_of_an_error_is_a_sentence() -> None:
    with pytest.raises(LineError) as caught:
        parse_line("S\twhole]")
    assert str(caught.value) == "found ']', expected [object], {ingredient,ingredient} or the end of the line"
    with pytest.raises(LineError, match=r"^found the end of the line, expected a name$"):
        parse_line("O\t")


def test_a_long_rest_of_line_is_not_shown_whole() -> None:
    with pytest.raises(LineError) as caught:
        parse_line("abcdefghijklmnopqrstuvwxyz" * 100)
    assert caught.value.found == "'abcdefghijklmnopqrstuvwx...'"


# --- many lines at once


def test_lines_read_together_mean_what_each_means_alone() -> None:
    lines = ["O\ta\t00", "S\tx", "S\tin [b]", "S\tcontains\t{a, a}", "M\tmix\tx\ty", "O\ta\t00"]
    assert parse_lines(lines) == [parse_line(line) for line in lines]
    assert parse_lines([]) == []


@pytest.mark.parametrize("broken", ["", "O", "S\tin\t[b]]", "x", "O\ta\rO\tb"])
@pytest.mark.parametrize("before", [0, 1, 499, 500, 1200])
def test_a_line_at_fault_keeps_none_of_the_others_from_being_read(broken: str, before: int) -> None:
    found = parse_lines(["O\ta"] * before + [broken, "M\tmix"])
    assert found[:before] == [ObjectLine("a")] * before
    assert found[before + 1 :] == [MotionLine("mix")]
    error = found[before]
    assert isinstance(error, LineError)
    with pytest.raises(LineError) as alone:
        parse_line(broken)
    assert (error.column, error.found, error.expected) == (
        alone.value.column,
        alone.value.found,
        alone.value.expected,
    )


@steady
@given(name=names(), number=st.integers(0, 999).map(str))
def test_any_name_is_a_label_a_state_and_a_motion(name: str, number: str) -> None:
    assert parse_line(f"O{number}\t{name}\t1") == ObjectLine(name, number, ("1",))
    assert parse_line(f"S{number}\t{name}") == StateLine(name, number)
    bare = name.rstrip("* ") if name.strip("* ") else name
    motion = parse_line(f"M{number}\t{bare}\t1:10\t1:11")
    assert motion == MotionLine(bare, number, False, ("1:10", "1:11"))


@steady
@given(st.text(st.characters(exclude_characters="\n"), max_size=12) | st.text("OSM1\t []{},a", max_size=12))
def test_any_line_is_read_or_refused_with_a_column_in_it(line: str) -> None:
    try:
        columns = [remark.column for remark in parse_line(line).remarks]
    except LineError as error:
        columns = [error.column]
    assert all(1 <= column <= len(line) + 1 for column in columns)


# --- the one-line notation


@pytest.mark.parametrize(
    ("notation", "node"),
    [
        ("onion", ObjectNode.of("onion")),
        ("onion;", ObjectNode.of("onion")),
        (
            "sweet potato; chopped; in [cutting board]",
            ObjectNode.of("sweet potato", ["chopped"], [("in", "cutting board")]),
        ),
        ("stove; off (ready);", ObjectNode.of("stove", ["off (ready)"])),
        (
            "bowl; contains {black pepper,olive oil}; on [table]",
            ObjectNode.of("bowl", [], [("on", "table")], [("contains", ["olive oil", "black pepper"])]),
        ),
        (
            "bowl; contains { black pepper , salt }",
            ObjectNode.of("bowl", [], [], [("contains", ["black pepper", "salt"])]),
        ),
        (
            "pan; coated {oil}; contains {egg}; contains {egg}",
            ObjectNode.of("pan", [], [], [("contains", ["egg"]), ("coated", ["oil"]), ("contains", ["egg"])]),
        ),
        ("bowl; contains {}", ObjectNode.of("bowl", [], [], [("contains", [])])),
        ("a;b;c", ObjectNode.of("a", ["b", "c"])),
        ("a; c; b; b", ObjectNode.of("a", ["b", "c"])),
        ("  a  ;  b  ", ObjectNode.of("a", ["b"])),
        ("a; in[b]", ObjectNode.of("a", [], [("in", "b")])),
        ("a; in [b;c]", ObjectNode.of("a", [], [("in", "b;c")])),
        # as in a file: a list in square brackets, and the word "contains", mean contents
        ("pan; coated [oil,salt]", ObjectNode.of("pan", [], [], [("coated", ["oil", "salt"])])),
        ("pan; contains [egg]", ObjectNode.of("pan", [], [], [("contains", ["egg"])])),
    ],
)
def test_the_notation_of_a_node(notation: str, node: ObjectNode) -> None:
    assert parse_node(notation) == node


@pytest.mark.parametrize(
    ("notation", "column", "found"),
    [
        ("", 1, "the end of the line"),
        ("   ", 1, "the end of the line"),
        (";", 1, "';'"),
        ("; chopped", 1, "'; chopped'"),
        ("a;;b", 3, "';b'"),
        ("a; [b]", 3, "' [b]'"),
        ("a; {b}", 3, "' {b}'"),
        ("[b]", 1, "'[b]'"),
        ("a; in [b", 7, "'[b'"),
        ("a; x]", 5, "']'"),
        ("a; in [b] [c]", 10, "' [c]'"),
        ("a in [b]", 6, "'[b]'"),
        ("a\tb", 2, r"'\tb'"),
    ],
)
def test_a_notation_that_is_not_accepted_says_where(notation: str, column: int, found: str) -> None:
    with pytest.raises(LineError) as caught:
        parse_node(notation)
    assert (caught.value.column, caught.value.found) == (column, found)
    assert caught.value.expected


def test_spaces_that_do_not_matter_count_as_columns_all_the_same() -> None:
    with pytest.raises(LineError) as caught:
        parse_node("a; in [b]   ; [c]")
    assert (caught.value.column, caught.value.found) == (14, "' [c]'")


def test_a_bracket_behind_the_label_is_told_of_the_semicolon() -> None:
    with pytest.raises(LineError, match="expected a semicolon or the end of the line"):
        parse_node("a in [b]")


@pytest.mark.parametrize("notation", ["a; in [b] ; x", "a; x; in [b] ", "a; x; in [b]; "])
def test_spaces_around_semicolons_and_at_the_end_do_not_matter(notation: str) -> None:
    assert parse_node(notation) == ObjectNode.of("a", ["x"], [("in", "b")])


def test_a_line_break_in_a_notation_is_named_as_what_was_found() -> None:
    with pytest.raises(LineError) as caught:
        parse_node("a\nb")
    assert caught.value.found not in caught.value.expected
    with pytest.raises(LineError) as caught:
        parse_node("a\n")
    assert caught.value.found not in caught.value.expected


@steady
@given(nodes())
def test_the_notation_of_a_node_reads_back(node: ObjectNode) -> None:
    assert parse_node(str(node)) == node
    assert parse_node(f"{node};") == node


@pytest.mark.parametrize("line", ["O\tsalt;pepper", "S\tsalt;pepper", "S\tsalt;pepper\t[pan]"])
def test_a_name_with_a_semicolon_can_be_said_in_the_notation(line: str) -> None:
    parsed = parse_line(line)
    if isinstance(parsed, ObjectLine):
        node = ObjectNode.of(parsed.label)
    else:
        assert isinstance(parsed, StateLine)
        attribute = parsed.attribute
        node = (
            ObjectNode.of("a", [attribute])
            if isinstance(attribute, str)
            else ObjectNode.of("a", [], [(attribute.word, "pan")])
        )
    assert parse_node(str(node)) == node


# --- states in JSON files


@pytest.mark.parametrize(
    ("state", "meaning"),
    [
        ("chopped", "chopped"),
        ("off (ready)", "off (ready)"),
        ("under [cooking pan]", Relation("under", "cooking pan")),
        ("attached to [mixer]", Relation("attached to", "mixer")),
        ("in  [ pot ]", Relation("in", "pot")),
        ("in[pot]", Relation("in", "pot")),
        ("in [pot", Relation("in", "pot")),
        ("contains [egg]", Contents("contains", ("egg",))),
        ("coated {oil,salt}", Contents("coated", ("oil", "salt"))),
        ("coated [salt,oil]", Contents("coated", ("oil", "salt"))),
        ("on []", "on"),
        ("on", "on"),
    ],
)
def test_a_state_in_json_is_what_it_would_be_on_a_state_line(
    state: str, meaning: str | Relation | Contents
) -> None:
    assert read_state(state).attribute == meaning


@pytest.mark.parametrize(
    ("state", "column", "found"),
    [
        ("", 1, "the end of the line"),
        ("]", 1, "']'"),
        ("in [pot] x", 9, "' x'"),
        ("in [pot]]", 9, "']'"),
        ("in [pot] [pan]", 9, "' [pan]'"),
    ],
)
def test_a_state_that_foon_text_refuses_is_refused_in_json(state: str, column: int, found: str) -> None:
    with pytest.raises(LineError) as caught:
        read_state(state)
    assert (caught.value.column, caught.value.found) == (column, found)


@pytest.mark.parametrize("brackets", ["[]", "[ ]"])
def test_a_state_with_empty_brackets_is_the_same_in_json_and_in_foon_text(brackets: str) -> None:
    line = parse_line(f"S\ton\t{brackets}")
    assert isinstance(line, StateLine)
    assert read_state(f"on {brackets}").attribute == line.attribute
