"""Single lines and the one-line notation: what they mean, how they are mended, where they are at fault."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from foon_asp.network import ObjectNode
from foon_asp.text.formats import format_of
from foon_asp.text.line import Line, LineError, ObjectLine
from foon_asp.text.line_parser import parse_node
from foon_asp.text.reader import FoonReader
from foon_asp.text.writer import write_line
from tests.text.foon_strategies import dirty_lines, lines, steady
from tests.text.reading import read, units_of


def in_unit(line: str) -> tuple[str, int]:
    """Put a line into a unit, under ``cup`` if it is no object line; its number comes along."""
    above = "O\tcup\n" if line[:1] in "SM" else ""
    below = "" if line[:1] == "M" else "M\tmix\n"
    return f"{above}{line}\n{below}O\ttea\n//\n", 2 if above else 1


# --- what lines mean


@pytest.mark.parametrize(
    ("line", "meaning"),
    [
        ("O278\tmixing bowl\t1", "mixing bowl"),
        ("O\tonion\t0\t!", "onion"),
        ("O007\t7-up\t1\t15", "7-up"),
        ("O\tsalt, coarse", "salt, coarse"),
        ("O\t#1 flour", '"#1 flour"'),
        ("O\tcrème  brûlée", "crème  brûlée"),
        ("S41\toff (ready)", "cup; off (ready)"),
        ("S\tin", "cup; in"),
        ("S65\tattached to\t[the mixer]", "cup; attached to [the mixer]"),
        ("S23\tcontains\t{salt,black pepper,oil}", "cup; contains {black pepper,oil,salt}"),
        ("S\tcoated\t{oil}", "cup; coated {oil}"),
        ("M54\tpour\t1:10\t1:11", "pour"),
        ("M\tpour\tAssumed\tASSUMED", "pour"),
        ("M\tpour\t<0:12-0:34,0:40-0:44>", "pour"),
        ("M4\tpour\t1:02:03\t<Assumed,Assumed>\tRobot\t0.85", "pour"),
        ("M4\tpour*\t0:05", "pour"),
        ("M\t*", "*"),
    ],
)
def test_a_line_as_it_should_be_is_understood_and_stays(line: str, meaning: str) -> None:
    text, _ = in_unit(line)
    (unit,), reader = read(text)
    assert reader.diagnostics == []
    assert (unit.motion if line[0] == "M" else str(unit.inputs[0])) == meaning
    assert format_of(text).canonical_text(text, "f.txt") == text


@pytest.mark.parametrize(
    ("line", "flag", "is_goal", "category"),
    [
        ("O\ta", None, False, None),
        ("O\ta\t01", "1", False, None),
        ("O\ta\t1\t15", "1", True, "15"),
        ("O\ta\t0\t!", "0", True, None),
        ("O\ta\t!\t7", None, True, "7"),
        ("O\ta\t7", None, True, "7"),
        ("O\ta\t0\t00", "0", False, None),
    ],
)
def test_an_object_line_says_whether_it_moves_and_is_a_goal(
    line: str, flag: str | None, is_goal: bool, category: str | None
) -> None:
    parsed = FoonReader().parse(line)
    assert isinstance(parsed, ObjectLine)
    assert (parsed.motion_flag, parsed.is_goal, parsed.category) == (flag, is_goal, category)


# --- what is remarked on, and mended where there is no doubt


@pytest.mark.parametrize(
    ("line", "mended", "remarks"),
    [
        # a space for a tab
        ("O12 tea pot\t1\t8", "O12\ttea pot\t1\t8", "4 space-for-tab"),
        ("S41 in\t[pot]", "S41\tin\t[pot]", "4 space-for-tab"),
        ("S65\tunder [pan]", "S65\tunder\t[pan]", "10 space-for-tab"),
        ("S\tunder[pan]", "S\tunder\t[pan]", "8 space-for-tab"),
        ("S7\tcontains  {b,a}", "S7\tcontains\t{b,a}", "13 space-for-tab"),
        ("S under [pan]", "S\tunder\t[pan]", "2 space-for-tab, 8 space-for-tab"),
        ("M54 pour\t1:10", "M54\tpour\t1:10", "4 space-for-tab"),
        # several tabs, blanks around and at the end
        ("O\t\ttea", "O\ttea", "3 outer-space"),
        ("O1\t tea \t1 ", "O1\ttea\t1", "4 outer-space, 8 outer-space, 10 outer-space"),
        ("O\ttea\t\t1\t", "O\ttea\t1", "6 empty-field, 9 empty-field"),
        ("S\thot \t ", "S\thot", "6 outer-space, 7 outer-space"),
        ("S\tin\t\t[ pot]\t", "S\tin\t[pot]", "7 outer-space, 7 outer-space, 13 outer-space"),
        ("M\t\tmix\t 1:10", "M\tmix\t1:10", "3 outer-space, 8 outer-space"),
        # brackets left open, closed wrongly, or left out
        ("S\tin\t[pot}", "S\tin\t[pot]", "6 bracket"),
        ("S\tin\tmixing bowl]", "S\tin\t[mixing bowl]", "6 bracket"),
        ("S\tcontains\t{b,a]", "S\tcontains\t{b,a}", "12 bracket"),
        ("S\tcoated\toil,salt", "S\tcoated\t{oil,salt}", "10 bracket"),
        ("S\tin\t[a,b", "S\tin\t{a,b}", "6 bracket, 6 contents-bracket"),
        ("S\tcontains\t[egg]", "S\tcontains\t{egg}", "12 contents-bracket"),
        ("S\ton\t[ ]", "S\ton", "6 empty-relation"),
        ("S\ton\t[", "S\ton", "6 bracket, 6 empty-relation"),
        # lists: of a kind of slip, the first is told
        ("S\tcontains\t{ b , a }", "S\tcontains\t{b,a}", "13 outer-space"),
        ("S\tcontains\t{b,,a,}", "S\tcontains\t{b,a}", "15 empty-ingredient"),
        ("S\tcontains\t{a, ,b}", "S\tcontains\t{a,b}", "15 empty-ingredient"),
        ("S\tcoated\ta, b,,c", "S\tcoated\t{a,b,c}", "10 bracket, 12 outer-space, 15 empty-ingredient"),
        ("S\tcontains\t{}", None, "13 empty-ingredient"),
        ("S\tcontains\t{b,a,b,b}", None, "17 repeated-ingredient"),
        ("S\tcontains\ta,a", "S\tcontains\t{a,a}", "12 bracket, 14 repeated-ingredient"),
        # flags and times
        ("O\ttea\t01\t15", "O\ttea\t1\t15", "7 motion-flag"),
        ("O12\ttea\t2", None, "9 motion-flag"),
        ("O\ttea \t?", "O\ttea\t?", "6 outer-space, 8 motion-flag"),
        ("O\ttea\t0\tchopped\t7", None, "9 unknown-field"),
        ("M\tmix**\t0:01", "M\tmix*\t0:01", "6 outer-space"),
        ("M\tmix\tAssume", "M\tmix\tAssumed", "7 time"),
        ("M\tmix\t1:35]\t3:0s7", "M\tmix\t1:35\t3:0s7", "7 time, 13 time"),
        ("M54\tmix*\t1:10\t<Assumed", "M54\tmix*\t1:10\t<Assumed>", "15 time"),
        ("M\tmix\t<0:01,0:09\tRobot\t0.85", "M\tmix\t<0:01,0:09>\tRobot\t0.85", "7 time"),
        ("M\tmix\t1:1\tRobot", None, "7 time, 11 time"),
    ],
)
def test_dirt_is_told_at_its_column_and_mended_where_there_is_no_doubt(
    line: str, mended: str | None, remarks: str
) -> None:
    text, number = in_unit(line)
    found, reader = read(text)
    assert {d.source.line for d in reader.diagnostics} == {number}
    told = sorted((d.source.column, d.code) for d in reader.diagnostics)
    assert ", ".join(f"{column} {code}" for column, code in told) == remarks
    assert {d.fix for d in reader.diagnostics} == {mended}
    clean, left = read(in_unit(mended or line)[0])
    assert units_of(clean) == units_of(found)
    assert all(d.fix is None for d in left.diagnostics)


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("O\ttea\t00", "motion flag '00' read as '0'"),
        ("O\ttea\t2", "motion flag '2' is not 0 or 1"),
        ("M\tmix\t3:0s7", "'3:0s7' is not a time (m:ss or Assumed)"),
        ("S\tunder [pan]", "no tab before [pan]; read as if there were one"),
        ("S\tcontains\t{a,b,a}", "ingredient 'a' is listed twice"),
        ("S\tcoated\t[b,a]", "[b,a] read as contents {b,a}"),
    ],
)
def test_a_remark_quotes_what_it_is_about(line: str, message: str) -> None:
    assert [d.message for d in read(in_unit(line)[0])[1].diagnostics] == [message]


@pytest.mark.parametrize(
    "digit", "\N{ARABIC-INDIC DIGIT THREE}\N{FULLWIDTH DIGIT THREE}\N{SUPERSCRIPT THREE}"
)
def test_digits_are_those_of_the_latin_script(digit: str) -> None:
    slips = (f"O{digit}\ttea", f"M\tmix\t1:2{digit}", f"M\tmix\tRobot\t0.{digit}", f"O\ttea\t1\t{digit}")
    codes = [[d.code for d in read(in_unit(line)[0])[1].diagnostics] for line in slips]
    assert codes == [["syntax"], ["time"], ["time", "time"], ["unknown-field"]]


@steady
@given(lines())
def test_a_line_is_written_as_it_was_read(line: Line) -> None:
    assert FoonReader().parse(write_line(line)) == line


@steady
@given(dirty_lines() | st.text("OSM1\t []{},a:!0*", max_size=14))
def test_a_mended_line_means_the_same_and_stays_as_it_is(text: str) -> None:
    reader = FoonReader()
    parsed = reader.parse(text)
    if isinstance(parsed, LineError):
        assert 1 <= parsed.column <= len(text) + 1
        return
    assert all(1 <= remark.column <= len(text) + 1 for remark in parsed.remarks)
    mended = write_line(parsed)
    again = reader.parse(mended)
    assert not isinstance(again, LineError)
    assert again._replace(remarks=()) == parsed._replace(remarks=())
    assert write_line(again) == mended
    assert len(again.remarks) <= len(parsed.remarks)
    assert parsed.remarks or mended == text


# --- what is not accepted

LINE = "an object line (O, tab, label), a state line (S, tab, state), a motion line (M, tab, motion) or a"
BRACKET = "[object], {ingredient,ingredient} or the end of the line"
FIELD = "a tab and a flag or time or the end of the line"


@pytest.mark.parametrize(
    ("line", "column", "found", "expected"),
    [
        ("X\ttea", 1, "'X→tea'", LINE),
        ("o\ttea", 1, "'o→tea'", LINE),
        ("O", 1, "'O'", LINE),
        ("Onion\ttea", 1, "'Onion→tea'", LINE),
        (" O\ttea", 1, "' O→tea'", LINE),
        ("O12\t  ", 7, "the end of the line", "a name"),
        ("S [pot]", 3, "'[pot]'", "a name"),
        ("S\t\t{a}", 4, "'{a}'", "a name"),
        ("M54\t]", 5, "']'", "a name"),
        ("O\ttea{a}", 6, "'{a}'", FIELD),
        ("M\tmix]\t1:10", 6, "']→1:10'", FIELD),
        ("S\tin\t[[pot]]", 5, "'→[[pot]]'", BRACKET),
        ("S\twhole]", 8, "']'", BRACKET),
        ("S\tin\t[pot]]", 11, "']'", "the end of the line"),
        ("S\tin\t[pot]\t{a}", 11, "'→{a}'", "the end of the line"),
        ("S\tcontains\t{a}x", 15, "'x'", "the end of the line"),
        ("abcdefghijklmnopqrstuvwxyz" * 100, 1, "'abcdefghijklmnopqrstuvwx...'", LINE),
    ],
)
def test_a_line_that_is_not_accepted_says_where_what_and_what_instead(
    line: str, column: int, found: str, expected: str
) -> None:
    text, number = in_unit(line)
    first = read(text)[1].diagnostics[0]
    assert (first.code, first.source.line, first.source.column) == ("syntax", number, column)
    assert first.message.replace("\\t", "→").startswith(f"found {found}, expected {expected}")


@pytest.mark.parametrize("before", [0, 1, 499, 500, 1200])
def test_a_line_at_fault_keeps_none_of_the_others_from_being_read(before: int) -> None:
    listed = [f"O\ta{number} " for number in range(before)]  # dirty, so that the parser takes them together
    reader = FoonReader(lenient=True)
    blocks = reader.object_blocks("\n".join([*listed, "O\tx]", "O\tb "]), "f.txt")
    assert [block.object.label for block in blocks] == [*(line[2:-1] for line in listed), "b"]
    assert [d.source.line for d in reader.diagnostics if d.code == "syntax"] == [before + 1]


# --- the one-line notation


@pytest.mark.parametrize(
    ("notation", "node"),
    [
        ("onion;", ObjectNode.of("onion")),
        (
            "sweet potato; off (ready); in [cutting board]",
            ObjectNode.of("sweet potato", ["off (ready)"], [("in", "cutting board")]),
        ),
        (
            "bowl; contains { pepper , salt }; on [table]",
            ObjectNode.of("bowl", [], [("on", "table")], [("contains", ["salt", "pepper"])]),
        ),
        (
            "pan; coated {oil}; contains {egg}; contains {egg}",
            ObjectNode.of("pan", [], [], [("contains", ["egg"]), ("coated", ["oil"]), ("contains", ["egg"])]),
        ),
        ("bowl; contains {}", ObjectNode.of("bowl", [], [], [("contains", [])])),
        ("  a  ;c;b; b", ObjectNode.of("a", ["b", "c"])),
        ("a; x; in[b;c] ; ", ObjectNode.of("a", ["x"], [("in", "b;c")])),
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
        ("   ", 1, "the end of the line"),
        ("; chopped", 1, "'; chopped'"),
        ("a;;b", 3, "';b'"),
        ("a; {b}", 3, "' {b}'"),
        ("[b]", 1, "'[b]'"),
        ("a; in [b", 7, "'[b'"),
        ("a; x]", 5, "']'"),
        ("a; in [b]   ; [c]", 14, "' [c]'"),
        ("a\tb", 2, r"'\tb'"),
        ("a\nb", 2, r"'\nb'"),
    ],
)
def test_a_notation_that_is_not_accepted_says_where(notation: str, column: int, found: str) -> None:
    with pytest.raises(LineError) as caught:
        parse_node(notation)
    assert (caught.value.column, caught.value.found) == (column, found)
    assert caught.value.found not in caught.value.expected


def test_a_bracket_behind_the_label_is_told_of_the_semicolon() -> None:
    with pytest.raises(LineError, match="expected a semicolon or the end of the line"):
        parse_node("a in [b]")
