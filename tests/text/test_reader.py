"""Reading FOON text: units, provenance, merging, and a located word about everything that is wrong."""

from pathlib import Path
from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from foon_asp.errors import UserError
from foon_asp.network import FunctionalUnit, ObjectNode, Source
from foon_asp.text.diagnostics import Diagnostic, InputError, Severity
from foon_asp.text.listed_unit import ReadUnit
from foon_asp.text.plain_file import read_plain_text
from foon_asp.text.reader import FoonReader
from foon_asp.text.writer import write_units
from tests.conftest import CORPUS
from tests.text.foon_strategies import steady, texts
from tests.text.reading import MIX, places, read, units_of

TEA = """\
O\tpot
S\tempty
O\ttea
S\tin\t[tin]
O\ttin
S\tcontains\t{tea}
M\tpour
O\tpot
S\tcontains\t{tea}
//
"""
TEA_WITH_IDS = """\
O278\tpot\t1
S41\tempty
O12\ttea\t1\t8
S65\tin\t[tin]
O3\ttin\t0
S23\tcontains\t{tea}
M54\tpour\t1:10\tAssumed
O278\tpot\t0
S23\tcontains\t{tea}
//
"""
TEA_UNIT = FunctionalUnit.of(
    "pour",
    [
        ObjectNode.of("pot", ["empty"]),
        ObjectNode.of("tea", [], [("in", "tin")]),
        ObjectNode.of("tin", [], [], [("contains", ["tea"])]),
    ],
    [ObjectNode.of("pot", [], [], [("contains", ["tea"])])],
)
MIX_UNIT = FunctionalUnit.of("mix", [ObjectNode.of("a")], [ObjectNode.of("b")])


def refusals(file: Path, lenient: bool) -> tuple[Diagnostic, ...]:
    """Return what is wrong with a file, if anything is; any other exception comes out."""
    try:
        FoonReader(lenient).read_network([file])
    except InputError as error:
        return error.diagnostics
    return ()


def node_of(*lines: str) -> ObjectNode:
    (unit,), _ = read("\n".join([*lines, "M\tmix", "O\tb", "//"]))
    (node,) = unit.inputs
    return node


# --- one grammar for what differs between files


@pytest.mark.parametrize("text", [TEA, TEA_WITH_IDS])
@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
@pytest.mark.parametrize("opening", ["", "//\n", "# made by hand\n//\n", "//\n//\n\n//\n"])
def test_dialects_line_ends_and_openings_give_the_same_unit(text: str, end: str, opening: str) -> None:
    found, reader = read((opening + text).replace("\n", end))
    assert units_of(found) == [TEA_UNIT]
    assert [*found[0].inputs, *found[0].outputs] == [*TEA_UNIT.inputs, *TEA_UNIT.outputs]
    assert reader.diagnostics == []
    assert found[0].source == Source("f.txt", opening.count("\n") + 1)


def test_comments_and_blanks_may_stand_anywhere() -> None:
    found, reader = read("".join(f"# aside\n\n{line}\n \t \n" for line in TEA.splitlines()))
    assert (units_of(found), reader.diagnostics, found[0].source.line) == ([TEA_UNIT], [], 3)
    found, reader = read(MIX.replace("//", "// \t") + MIX)
    assert (units_of(found), places(reader)) == ([MIX_UNIT] * 2, [("outer-space", 4, 3)])


@pytest.mark.parametrize("text", ["", "//\n", "# only words\n", "//\n\n//\n# x\n//"])
def test_a_text_without_units_is_no_error(text: str) -> None:
    found, reader = read(text)
    assert (found, reader.diagnostics) == ([], [])


@pytest.mark.parametrize("character", "\x0b\x0c\x1c\x1d\x1e\x85\xa0\u2028\u2029\u3000\ufeff\x00漢🍠")
def test_no_other_character_ends_a_line_or_a_name(character: str) -> None:
    found, reader = read(f"O\ta{character}b\nS\tc{character}d\nM\te{character}f\nO\tg\t8\n//\n")
    assert units_of(found) == [
        FunctionalUnit.of(
            f"e{character}f", [ObjectNode.of(f"a{character}b", [f"c{character}d"])], [ObjectNode.of("g")]
        )
    ]
    assert places(reader) == [("motion-flag", 4, 5)]


# --- what makes a node and a unit


def test_the_order_of_states_ids_flags_and_times_do_not_matter() -> None:
    one = node_of("O1\ta\t0", "S\thot", "S\tpeeled", "S\tin\t[pan]", "S\tcontains\t{x,y}")
    other = node_of("O\ta\t1\t4", "S\tcontains\t{y,x}", "S5\tin\t[pan]", "S\tpeeled", "S\thot", "S\thot")
    assert one == other == ObjectNode.of("a", ["hot", "peeled"], [("in", "pan")], [("contains", ["x", "y"])])


def test_what_a_node_is_in_or_on_or_holds_matters_and_how_often() -> None:
    different = [
        node_of("O\ta"),
        node_of("O\tb"),
        node_of("O\ta", "S\tin"),
        node_of("O\ta", "S\tin\t[p]"),
        node_of("O\ta", "S\ton\t[p]"),
        node_of("O\ta", "S\tin\t[q]"),
        node_of("O\ta", "S\tin\t{p}"),
        node_of("O\ta", "S\tin\t{p,p}"),
        node_of("O\ta", "S\ton\t[p]", "S\tin\t[p]"),
        node_of("O\ta", "S\tcoated\t{p}"),
        node_of("O\ta", "S\tcoated\t{p}", "S\tin\t{p}"),
    ]
    assert len(set(different)) == len(different)
    lists = ["S\tcontains\t{x}", "S\tin\t[p]", "S\tcontains\t{y,x}", "S\ton\t[q]"]
    assert node_of("O\ta", *lists) == node_of("O\ta", *lists[::-1])
    assert node_of("O\ta", *lists).ingredients == ("x", "x", "y")


def test_a_node_listed_twice_in_a_unit_counts_once(tmp_path: Path) -> None:
    file = tmp_path / "f.txt"
    file.write_text("O\ta\nO\tc\nO\ta\nM\tmix\nO\tb\nO\tb\n//\nO\tc\nO\ta\nM\tmix\nO\tb\n//\n")
    network = FoonReader().read_network([file])
    assert (network.inputs, network.outputs) == (((0, 1),), ((2,),))
    assert [source.line for source in network.sources[0]] == [1, 8]


# --- where units come from, and merging


def test_the_addresses_above_a_unit_are_its_videos(tmp_path: Path) -> None:
    text = (
        MIX  # before any address
        + "# Source:\thttps://example.org/1\n# cut at 3:10\n# Source: https://example.org/2 \n//\n"
        + MIX
        + MIX
        + "# Source:\thttps://example.org/3\n//\n"
        + MIX
        + "# Source:\t4\n//\n//\n# Source:\n# Source:\t5\n"
        + MIX
    )
    found, reader = read(text)
    assert [(unit.source.line, unit.source.videos) for unit in found] == [
        (1, ()),
        (9, ("https://example.org/1", "https://example.org/2")),
        (13, ("https://example.org/1", "https://example.org/2")),
        (19, ("https://example.org/3",)),
        (28, ("4", "5")),
    ]
    assert reader.diagnostics == []
    (tmp_path / "1.txt").write_text(text)
    (tmp_path / "2.txt").write_text(MIX)
    network = FoonReader().read_network([tmp_path / "1.txt", tmp_path / "2.txt"])
    assert network.sources[0][-1] == Source(str(tmp_path / "2.txt"), 1)


def test_copies_are_merged_and_the_place_of_each_is_kept(tmp_path: Path) -> None:
    one, two = tmp_path / "1.txt", tmp_path / "2.txt"
    one.write_text(MIX + TEA + "O\ta\nM\tstir\nO\tb\n//\n")
    two.write_text("# Source:\tv\n//\nO\tz\nM\tmix\nO\ta\n//\n" + TEA_WITH_IDS + MIX, newline="\r\n")
    network = FoonReader().read_network([one, two])
    assert network.motions == ("mix", "pour", "stir", "mix")
    assert network.sources == (
        (Source(str(one), 1), Source(str(two), 17, 1, ("v",))),
        (Source(str(one), 5), Source(str(two), 7, 1, ("v",))),
        (Source(str(one), 15),),
        (Source(str(two), 3, 1, ("v",)),),
    )
    assert [node.label for node in network.objects] == ["a", "b", "pot", "tea", "tin", "pot", "z"]
    assert (network.unit(1), network.unit_id(TEA_UNIT)) == (TEA_UNIT, 1)
    tree = FoonReader().tree_units(MIX + TEA + MIX, "f.txt")
    assert [(unit, source.line) for unit, source in tree] == [(MIX_UNIT, 1), (TEA_UNIT, 5), (MIX_UNIT, 15)]


def test_units_are_merged_where_motion_and_sides_are_the_same_in_any_order(tmp_path: Path) -> None:
    file = tmp_path / "f.txt"
    file.write_text(
        "O\ta\nO\tb\nS\tx\nS\ty\nM\tmix\nO\tc\nO\td\n//\nO\tb\nS\ty\nS\tx\nO\ta\nM\tmix\nO\td\nO\tc\n//\n"
        "O\ta\nM\tmix\nO\tb\n//\nO\ta\nM\tMix\nO\tb\n//\nO\ta\nS\thot\nM\tmix\nO\tb\n//\nO\tb\nM\tmix\nO\ta\n//\n"
    )
    network = FoonReader().read_network([file])
    assert [[source.line for source in copies] for copies in network.sources] == [
        [1, 9],
        [17],
        [21],
        [25],
        [30],
    ]
    assert [network.objects[o].label for o in network.inputs[0]] == ["a", "b"]


# --- warnings: read all the same


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("O\ta\nM\tmix\nO\tb", [("missing-separator", 3, 4)]),
        ("O\ta\nM\tmix\nO\tb\n\n \n", [("missing-separator", 3, 4)]),
        ("\n# x\nO\ta\nM\tmix\n//\n", [("no-outputs", 3, 1)]),
        ("O\ta\nM\tmix", [("no-outputs", 1, 1), ("missing-separator", 2, 6)]),
        (
            "O\ta\t00\nS\tunder [pan]\nM\tmix\tx\nO\tb\n//\n",
            [("motion-flag", 1, 5), ("space-for-tab", 2, 8), ("time", 3, 7)],
        ),
    ],
)
def test_dirt_is_a_warning_and_the_unit_is_kept(text: str, found: list[tuple[str, int, int]]) -> None:
    read_units, reader = read(text)
    assert len(read_units) == 1
    assert places(reader) == found
    assert {d.severity for d in reader.diagnostics} == {Severity.WARNING}
    reader.raise_errors()
    assert reader.left_out == 0


def test_dirt_is_remarked_on_wherever_it_stands_with_its_line() -> None:
    dirty = "O\ta\r\n# aside\r\nS\tunder [x]\r\n\r\nS\tunder [x]\r\nM\tmix\r\nO\tb\r\n//\r\n"
    _, reader = read(dirty * 2)
    message = "no tab before [x]; read as if there were one"
    assert reader.diagnostics == [
        Diagnostic(
            Severity.WARNING,
            "space-for-tab",
            message,
            Source("f.txt", line, 8),
            "S\tunder [x]",
            "S\tunder\t[x]",
        )
        for line in (3, 5, 11, 13)
    ]


# --- errors: located, all of them, and nothing else; the good unit MIX follows each


@pytest.mark.parametrize(
    ("text", "place", "message"),
    [
        ("O\ta\nM\tmix\nx\nO\tb\n//\n", ("syntax", 3, 1), "found 'x', expected an object line"),
        ("O\ta\nS\tin\t[p]]\nM\tmix\nO\tb\n//\n", ("syntax", 2, 9), "found ']', expected the end of the"),
        ("O[a\nM\tmix\nO\tb\n//\n", ("syntax", 1, 1), "found 'O[a'"),
        (
            "S\tx\nO\ta\nM\tmix\nO\tb\n//\n",
            ("state-without-object", 1, 1),
            "found a state line, expected an obj",
        ),
        (
            "O\ta\nM\tmix\nS\tx\nO\tb\n//\n",
            ("state-without-object", 3, 1),
            "expected an object line before it",
        ),
        (
            "O\ta\nM\tmix\nO\tb\nM\tcut\nO\tc\n//\n",
            ("second-motion", 4, 1),
            "found a second motion in one unit",
        ),
    ],
)
def test_an_error_is_located_and_lenient_makes_it_a_warning(
    text: str, place: tuple[str, int, int], message: str
) -> None:
    found, reader = read(text + MIX)
    (error,) = reader.diagnostics
    assert (error.severity, places(reader)) == (Severity.ERROR, [place])
    assert message in error.message
    assert error.excerpt == text.split("\n")[place[1] - 1]
    with pytest.raises(InputError) as caught:
        reader.raise_errors()
    assert caught.value.diagnostics == (error,)
    assert units_of(found)[-1] == MIX_UNIT

    found, reader = read(text + MIX, lenient=True)
    reader.raise_errors()
    warning, *others = reader.diagnostics
    assert warning == error._replace(severity=Severity.WARNING, message=f"{error.message}; left out")
    # A unit that has no or two motions, or no inputs, is told of as well, since all of it is left out.
    assert {d.code for d in others} <= {"second-motion", "no-motion", "no-inputs"}
    assert bool(others) == (len(found) == 1)
    assert all(d.message.endswith("; left out") for d in others)
    assert units_of(found)[-1] == MIX_UNIT


@pytest.mark.parametrize("lenient", [False, True])
@pytest.mark.parametrize(
    ("text", "place", "message", "lines"),
    [
        (
            "\nO\ta\nS\tx\n//\n",
            ("no-motion", 4, 1),
            "found //, expected a motion line: the unit of line 2",
            2,
        ),
        ("O\ta\n# x\n\nO\tb\n//\n", ("no-motion", 5, 1), "expected a motion line: the unit of line 1", 2),
        ("M\tmix\nO\tb\n//\n", ("no-inputs", 1, 1), "the unit of line 1 has no input objects", 2),
        ("\n\nM\tmix\n// \n", ("no-inputs", 3, 1), "the unit of line 3 has no input objects", 1),
    ],
)
def test_what_is_no_unit_is_left_out_with_a_warning_in_either_mode(
    text: str, place: tuple[str, int, int], message: str, lines: int, lenient: bool
) -> None:
    found, reader = read(text + MIX, lenient)
    reader.raise_errors()
    (warning,) = (d for d in reader.diagnostics if d.code != "outer-space")
    assert (warning.code, warning.source.line, warning.source.column) == place
    assert warning.severity is Severity.WARNING
    assert message in warning.message
    assert warning.message.endswith("; left out")
    assert warning.excerpt == text.split("\n")[place[1] - 1]
    assert (units_of(found), reader.left_out) == ([MIX_UNIT], lines)


def test_a_unit_with_two_motions_is_never_read() -> None:
    text = "O\ta\nM\tmix\nM\tcut\t0:01\nO\tc\n//\n"
    assert read(text)[0] == []
    found, reader = read(text, lenient=True)
    assert (found, reader.left_out) == ([], 4)
    assert places(reader) == [("second-motion", 3, 1), ("second-motion", 1, 1)]
    assert reader.diagnostics[1].message == "the unit of line 1 has 2 motions; left out"


@pytest.mark.parametrize(
    ("text", "left_out", "kept"),
    [
        ("O\ta\nM\tmix\nx\nO\tb\n//\n", 1, MIX),
        ("O\ta\nS\tin\t[p]]\nS\thot\nM\tmix\nO\tb\n//\n", 1, "O\ta\nS\thot\nM\tmix\nO\tb\n//\n"),
        # a line that is nothing does not part an object from its states
        ("O\ta\nS\tx\n?\nS\ty\nM\tmix\nO\tb\n//\n", 1, "O\ta\nS\tx\nS\ty\nM\tmix\nO\tb\n//\n"),
        # the states of an object that cannot be read go with it
        ("O\ta\nO\nS\tx\nS\ty\nM\tmix\nO\tb\n//\n", 3, MIX),
        ("O\ta\nM\tmix\nO\tb\nO[\n# x\nS\ty\n//\n", 2, MIX),
        ("O\ta\nO\nS\tx\nO\tc\nS\ty\nM\tmix\nO\tb\n//\n", 2, "O\ta\nO\tc\nS\ty\nM\tmix\nO\tb\n//\n"),
        ("S\tx\nS\ty\nO\ta\nM\tmix\nO\tb\n//\n", 2, MIX),
        ("O\ta\nM\tmix\nM\t]\nO\tb\n//\n", 1, MIX),
        # of a unit that is left out, every line counts once
        ("O\ta\nS\tx\nO\tb\n//\n", 3, ""),
        ("M\tmix\nO\tb\nS\tx\n//\n", 3, ""),
        ("O\ta\n\n# x\nx\n//\n", 2, ""),
        ("x\n//\n", 1, ""),
        ("O\ta\nM\t]\nO\tb\n//\n", 3, ""),
        ("O[\nM\tmix\nO\tb\n//\n", 3, ""),
    ],
)
def test_lenient_leaves_out_the_line_and_keeps_the_rest(text: str, left_out: int, kept: str) -> None:
    found, reader = read(text + TEA, lenient=True)
    assert units_of(found) == units_of(read(kept + TEA)[0])
    assert reader.left_out == left_out
    assert reader.diagnostics


@pytest.mark.parametrize("end", ["", "\n", "\n\n"])
def test_a_unit_that_is_not_finished_when_the_file_ends(end: str) -> None:
    found, reader = read(MIX + "O\ta\nS\tx" + end)
    assert units_of(found) == [MIX_UNIT]
    assert places(reader) == [("no-motion", 6, 1)]
    assert reader.diagnostics[0].excerpt == "S\tx"
    assert reader.diagnostics[0].message == (
        "the file ends, expected a motion line: the unit of line 5 has no motion; left out"
    )


@pytest.mark.parametrize("lenient", [False, True])
@pytest.mark.parametrize("above", ["", "//\n", "# kitchen\n//\n\n"])
@pytest.mark.parametrize(
    ("rest", "message", "lines"),
    [("", "one object and no motion", 2), ("O\tb\n\n", "2 objects and no motion", 3)],
)
def test_a_list_of_objects_is_called_one_on_its_first_line(
    above: str, rest: str, message: str, lines: int, lenient: bool
) -> None:
    found, reader = read(above + "O\ta\nS\tx\n" + rest, lenient)
    assert found == []
    (warning,) = reader.diagnostics
    assert (warning.severity, warning.code) == (Severity.WARNING, "no-motion")
    assert (warning.source, warning.excerpt) == (Source("f.txt", above.count("\n") + 1), "O\ta")
    assert warning.message == f"{message}: a list such as a kitchen or goals, without units"
    assert reader.left_out == lines


@pytest.mark.parametrize(
    ("text", "both"),
    [
        ("O\ta\nS\t\n//\n", [("syntax", 2, 3), ("no-motion", 3, 1)]),
        ("M\tmix\nO\tb\nS\t\n//\n", [("syntax", 3, 3), ("no-inputs", 1, 1)]),
    ],
)
def test_a_broken_state_is_not_why_a_motion_or_an_input_is_missing(
    text: str, both: list[tuple[str, int, int]]
) -> None:
    assert places(read(text)[1]) == both


@pytest.mark.parametrize("line", ["///", " //", "// next", "--"])
def test_a_separator_that_is_not_quite_one_is_told_what_it_should_be(line: str) -> None:
    _, reader = read(f"O\ta\nM\tmix\nO\tb\n{line}\n" + MIX)
    assert places(reader)[0] == ("syntax", 4, 1)
    assert "//" in reader.diagnostics[0].message.partition(", expected ")[2]


def test_all_errors_of_all_files_are_collected(tmp_path: Path) -> None:
    one, two, three = (tmp_path / f"{n}.txt" for n in "123")
    one.write_text("O\ta\nS\t\nM\tmix\nO\tb\n//\nx\n" + MIX)
    two.write_bytes(b"\xff")
    three.write_text("O\ta\t7\nM\tmix\nO\t[\n//\n")
    reader = FoonReader()
    with pytest.raises(InputError) as caught:
        reader.read_network([one, two, three])
    assert [(d.source.file, d.source.line, d.source.column) for d in caught.value.diagnostics] == [
        (str(one), 2, 3),
        (str(one), 6, 1),
        (str(two), 1, 1),
        (str(three), 3, 3),
    ]
    assert "motion-flag" in {d.code for d in reader.diagnostics}  # a warning is no part of the error
    assert f"{one}:2:3: error: found the end of the line, expected a name" in str(caught.value)
    two.write_text(MIX)
    assert len(reader.read_network([two])) == 1  # a reader that met errors reads on


def test_a_text_with_errors_is_refused_and_lenient_reads_the_rest(tmp_path: Path) -> None:
    text = MIX + "?\n" + MIX
    with pytest.raises(InputError, match=r"f\.txt:5:1: error: found '\?'"):
        FoonReader().tree_units(text, "f.txt")
    strict, lenient = FoonReader(), FoonReader(lenient=True)
    assert [len(list(reader.listed_units(text, "f.txt"))) for reader in (strict, lenient)] == [2, 2]
    with pytest.raises(InputError, match=r"f\.txt:5:1"):
        strict.raise_errors()
    assert [unit for unit, _ in lenient.tree_units(text, "f.txt")] == [MIX_UNIT, MIX_UNIT]
    file = tmp_path / "f.txt"
    file.write_text(text)
    assert len(lenient.read_network([file])) == 1
    assert lenient.left_out == 3


@steady
@given(texts())
def test_a_text_with_its_fixes_says_the_same_with_less_to_remark_on(text: str) -> None:
    found, reader = read(text, lenient=True)
    lines = text.replace("\r\n", "\n").split("\n")
    for diagnostic in reader.diagnostics:
        if diagnostic.fix is not None:
            assert diagnostic.fix != diagnostic.excerpt
            lines[diagnostic.source.line - 1] = diagnostic.fix
    again, mended = read("\n".join(lines), lenient=True)
    assert [unit[:3] for unit in again] == [unit[:3] for unit in found]
    assert all(d.fix is None for d in mended.diagnostics)
    assert mended.left_out == reader.left_out
    assert len(mended.diagnostics) <= len(reader.diagnostics)


@pytest.mark.parametrize("letter", ["S\t", "x"])
def test_a_line_of_more_than_a_million_letters_is_refused(letter: str) -> None:
    longest = letter + "a" * (1_000_000 - len(letter))
    text = "O\ta\n%s\nM\tmix\nO\tb\n//\n" + MIX
    found, reader = read(text % f"{longest}a", lenient=True)
    assert places(reader) == [("syntax", 2, 1_000_001)]
    assert "a line of 1000001 letters" in reader.diagnostics[0].message
    assert len(str(reader.diagnostics[0])) < 1000
    assert units_of(found) == [MIX_UNIT, MIX_UNIT]
    _, reader = read(text % longest)
    assert not any("letters" in d.message for d in reader.diagnostics)


# --- files


@pytest.mark.parametrize("lenient", [False, True])
@pytest.mark.parametrize(
    ("data", "line", "column", "byte"),
    [
        (b"O\tcr\xe8me\n", 1, 5, "e8"),
        ("O\tcrème\n".encode() + b"S\t\xff", 2, 3, "ff"),
        ("O\ta\r\n".encode("utf-16"), 1, 1, "ff"),
        (b"O\ta\nM\tmix\xc3", 2, 6, "c3"),
        ("\ufeffO\té".encode() + b"ab\xff", 1, 6, "ff"),
        (b"\xef\xbb\xbf\xff", 1, 1, "ff"),
    ],
)
def test_a_file_that_is_not_utf_8_is_refused_in_place(
    tmp_path: Path, lenient: bool, data: bytes, line: int, column: int, byte: str
) -> None:
    file = tmp_path / "f.txt"
    file.write_bytes(data)
    (error,) = refusals(file, lenient)
    assert error.source == Source(str(file), line, column)
    assert f"found the byte 0x{byte}, expected UTF-8" in error.message


def test_a_file_that_cannot_be_opened_is_named(tmp_path: Path) -> None:
    for path in (tmp_path / "nothing.txt", tmp_path):
        with pytest.raises(UserError, match=f"{path}: cannot be read"):
            FoonReader(lenient=True).read_network([path])


@pytest.mark.parametrize("seed", range(12))
def test_a_long_file_is_read_in_pieces_as_it_is_at_once(seed: int, tmp_path: Path) -> None:
    rng = Random(seed)
    lines = [
        *TEA.splitlines(),
        *MIX.splitlines(),
        "O\tgoal\t!",
        "# Source:\tv",
        "// ",
        "",
        "S\tloose",
        "é\x0c",
    ]
    text = "".join(rng.choice(lines) + rng.choice(["\n", "\n", "\r\n", "\r"]) for _ in range(200))
    above = "# " + "x" * (999_990 - rng.randrange(600)) + "\n"  # the first piece ends among the lines
    text = above + text.replace("\n//\n", "\n" if seed == 0 else "\n//\n")  # one has no separator
    file = tmp_path / "f.txt"
    file.write_bytes(("\N{BYTE ORDER MARK}" if seed % 2 else "").encode() + text.encode())
    whole, pieces = FoonReader(lenient=True), FoonReader(lenient=True)
    assert list(pieces.file_units(file)) == list(whole.units(text, str(file)))
    assert pieces.diagnostics == whole.diagnostics
    assert (pieces.left_out, pieces.marked) == (whole.left_out, whole.marked)


@steady
@given(one=texts(), two=texts(), lenient=st.booleans())
def test_a_used_reader_reads_as_a_fresh_one(one: str, two: str, lenient: bool) -> None:
    fresh_units, fresh = read(two, lenient)
    used_units, used = read(one, lenient)
    before, left_out = len(used.diagnostics), used.left_out
    for _ in range(2):
        assert list(used.units(two, "f.txt")) == fresh_units
        assert used.diagnostics[before:] == fresh.diagnostics
        assert used.left_out - left_out == fresh.left_out
        before, left_out = len(used.diagnostics), used.left_out
    assert used_units == read(one, lenient)[0]


# --- any text


@steady
@given(texts())
def test_any_text_is_read_or_refused_in_place_and_nothing_is_lost_silently(text: str) -> None:
    found, reader = read(text)
    lines = text.replace("\r\n", "\n").split("\n")
    for diagnostic in reader.diagnostics:
        line = lines[diagnostic.source.line - 1]
        assert diagnostic.excerpt == line
        assert 1 <= diagnostic.source.column <= len(line) + 1
        assert diagnostic.message in str(diagnostic)
    errors = [d for d in reader.diagnostics if d.severity is Severity.ERROR]
    assert errors == sorted(errors, key=lambda d: d.source.line)
    assert (reader.left_out > 0) == any(
        d.code in {"no-motion", "no-inputs"} and d.severity is Severity.WARNING for d in reader.diagnostics
    )
    for unit in found:
        assert unit.inputs
        if unit.source.file == "f.txt":  # else it is where a comment says
            assert lines[unit.source.line - 1].strip()
    if not reader.diagnostics:
        assert len(found) == sum(line.startswith("M") for line in lines)
        nodes = sum(len(unit.inputs) + len(unit.outputs) for unit in found)
        assert nodes == sum(line.startswith("O") for line in lines)
        assert all(line.strip()[:1] in {"O", "S", "M", "#", "/", ""} for line in lines)
    _, lenient = read(text, lenient=True)
    lenient.raise_errors()
    assert (lenient.left_out > 0) == bool(errors or reader.left_out)
    assert lenient.left_out >= reader.left_out


@steady
@given(
    st.binary(max_size=40)
    | st.builds(bytes.__add__, st.just("\ufeffO\té".encode()), st.binary(max_size=6))
    | st.builds(lambda text, tail: text.encode() + tail, texts(), st.binary(max_size=3))
)
def test_any_file_is_read_or_refused_as_the_users(
    tmp_path_factory: pytest.TempPathFactory, data: bytes
) -> None:
    file = tmp_path_factory.getbasetemp() / "any.txt"
    file.write_bytes(data)
    try:
        data.decode()
        decodable = True
    except UnicodeDecodeError:
        decodable = False
    assert refusals(file, lenient=False) or decodable
    assert bool(refusals(file, lenient=True)) == (not decodable)


# --- the two ways to read: by object blocks, and line by line


def both_ways(text: str, lenient: bool = False) -> tuple[list[ReadUnit], FoonReader]:
    found, reader = read(text, lenient)
    by_line = FoonReader(lenient)
    listed = list(by_line.listed_units(text, "f.txt"))
    assert [
        ReadUnit(u.motion.motion, [b.node for b in u.inputs], [b.node for b in u.outputs], u.sources)
        for u in listed
    ] == found
    assert by_line.diagnostics == reader.diagnostics
    assert by_line.left_out == reader.left_out
    return found, reader


@steady
@given(st.lists(texts(), min_size=1, max_size=3), st.lists(st.integers(0, 2), max_size=6), st.booleans())
def test_units_read_by_their_blocks_and_line_by_line_are_the_same(
    pieces: list[str], order: list[int], lenient: bool
) -> None:
    # Pieces come again, so that their blocks are remembered from the first time.
    both_ways("\n//\n".join([*pieces, *(pieces[i % len(pieces)] for i in order)]), lenient)


def test_places_are_right_in_either_way() -> None:
    clean = TEA_WITH_IDS
    dirty = clean.replace("S41\tempty", "S41 empty")
    text = "# Source:\tv\n//\n" + (clean * 3 + dirty + "\n# aside\n" + MIX) * 3
    found, reader = both_ways(text)
    lines = text.split("\n")
    firsts = [n + 1 for n, line in enumerate(lines) if line[:1] == "O" and lines[n - 1][:1] not in "OSM"]
    assert [unit.source.line for unit in found] == firsts
    assert len(firsts) == 15
    assert {unit.source.videos for unit in found} == {("v",)}
    assert [d.source.line for d in reader.diagnostics] == [
        n + 1 for n, line in enumerate(lines) if line == "S41 empty"
    ]


# --- the real corpus


@pytest.mark.skipif(not CORPUS.is_dir(), reason=f"the real corpus is not at {CORPUS}")
def test_the_real_subgraphs_are_read_and_written_and_read_again() -> None:
    files = sorted((CORPUS / "subgraphs").glob("*.txt"))
    assert len(files) == 56
    left_out = {}
    for file in files:
        reader = FoonReader()
        tree = [unit for unit, _ in reader.tree_units(read_plain_text(file), str(file))]
        if reader.left_out:
            left_out[file.name[:4]] = {d.code for d in reader.diagnostics} & {"no-motion", "no-inputs"}
        again, _ = read(write_units(tree))
        assert tree
        assert units_of(again) == tree
        assert [tuple(unit.inputs) for unit in again] == [unit.inputs for unit in tree]
    assert left_out == {"0083": {"no-motion"}}


def test_a_lenient_reading_leaves_out_json_in_prose_with_a_warning() -> None:
    text = "Here is the recipe:\n{"
    with pytest.raises(InputError, match="found the text 'Here is the recipe:' before JSON"):
        read(text)[1].raise_errors()
    units, reader = read(text, lenient=True)
    reader.raise_errors()
    assert units == []
    assert [str(d).partition("\n")[0] for d in reader.diagnostics] == [
        "f.txt:1:1: warning: found the text 'Here is the recipe:' before JSON, expected JSON alone: "
        "remove it; left out"
    ]
