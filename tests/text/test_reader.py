"""Reading FOON text: units, provenance, merging, and a located word about everything that is wrong."""

from pathlib import Path
from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from foon_asp.errors import UserError
from foon_asp.network import FunctionalUnit, ObjectNode, Source
from foon_asp.text import reader as reader_module
from foon_asp.text.diagnostics import Diagnostic, InputError, Severity
from foon_asp.text.line import Line
from foon_asp.text.plain_file import read_plain_text
from foon_asp.text.reader import FoonReader, ReadUnit
from foon_asp.text.writer import write_line, write_units
from tests.text.foon_strategies import steady, texts, unit_texts, units

pytestmark = pytest.mark.sampled(3)  # by default some cases of each test: there are many

CORPUS = Path(__file__).resolve().parents[3] / "shared" / "corpus"

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
MIX = "O\ta\nM\tmix\nO\tb\n//\n"
MIX_UNIT = FunctionalUnit.of("mix", [ObjectNode.of("a")], [ObjectNode.of("b")])


def read(text: str, lenient: bool = False) -> tuple[list[ReadUnit], FoonReader]:
    """Read a text under the name ``f.txt``; the reader comes along with what it remarked on."""
    reader = FoonReader(lenient)
    return list(reader.units(text, "f.txt")), reader


def refusals(file: Path, lenient: bool) -> tuple[Diagnostic, ...]:
    """Give what is wrong with a file, if anything is; any other exception comes out."""
    try:
        FoonReader(lenient).read_network([file])
    except InputError as error:
        return error.diagnostics
    return ()


def units_of(found: list[ReadUnit]) -> list[FunctionalUnit]:
    return [FunctionalUnit.of(unit.motion, unit.inputs, unit.outputs) for unit in found]


def places(reader: FoonReader) -> list[tuple[str, int, int]]:
    return [(d.code, d.source.line, d.source.column) for d in reader.diagnostics]


def only_input(text: str) -> ObjectNode:
    (unit,), _ = read(text)
    (node,) = unit.inputs
    return node


def node_of(*lines: str) -> ObjectNode:
    return only_input("\n".join([*lines, "M\tmix", "O\tb", "//"]))


# --- one grammar for what differs between files


@pytest.mark.parametrize("text", [TEA, TEA_WITH_IDS])
@pytest.mark.parametrize("end", ["\n", "\r\n"])
@pytest.mark.parametrize("opening", ["", "//\n", "# made by hand\n//\n", "//\n//\n\n//\n"])
def test_dialects_line_ends_and_openings_give_the_same_unit(text: str, end: str, opening: str) -> None:
    found, reader = read((opening + text).replace("\n", end))
    assert units_of(found) == [TEA_UNIT]
    assert [*found[0].inputs, *found[0].outputs] == [*TEA_UNIT.inputs, *TEA_UNIT.outputs]
    assert reader.diagnostics == []
    assert found[0].source == Source("f.txt", opening.count("\n") + 1)


@pytest.mark.parametrize("start", ["", "\N{BYTE ORDER MARK}"])
@pytest.mark.parametrize("end", ["", "\n", "\n\n  \n"])
def test_a_byte_order_mark_and_the_last_line_end_do_not_matter(tmp_path: Path, start: str, end: str) -> None:
    file = tmp_path / "f.txt"
    file.write_text(start + TEA.rstrip("\n") + end, "utf-8")
    reader = FoonReader()
    assert reader.tree_units(read_plain_text(file), str(file)) == [(TEA_UNIT, Source(str(file), 1))]
    assert reader.diagnostics == []


def test_comments_and_blank_lines_may_stand_anywhere() -> None:
    spread = "".join(f"# aside\n\n{line}\n \t \n" for line in TEA.splitlines())
    found, reader = read(spread)
    assert units_of(found) == [TEA_UNIT]
    assert reader.diagnostics == []
    assert found[0].source.line == 3


def test_spaces_and_tabs_behind_a_separator_do_not_matter() -> None:
    found, reader = read(MIX.replace("//", "// \t") + MIX)
    assert units_of(found) == [MIX_UNIT, MIX_UNIT]
    assert places(reader) == [("outer-space", 4, 3)]
    assert reader.diagnostics[0].fix == "//"


@pytest.mark.parametrize("text", ["", "\n", "//\n", "# only words\n", "//\n\n//\n# x\n//"])
def test_a_text_without_units_is_no_error(text: str) -> None:
    found, reader = read(text)
    assert found == []
    assert reader.diagnostics == []


@pytest.mark.parametrize("character", "\x0b\x0c\x1c\x1d\x1e\x85\xa0\u2028\u2029\u3000\ufeff\x00漢🍠")
def test_no_other_character_ends_a_line_or_a_name(character: str) -> None:
    found, reader = read(f"O\ta{character}b\nS\tc{character}d\nM\te{character}f\nO\tg\n//\n")
    assert units_of(found) == [
        FunctionalUnit.of(
            f"e{character}f", [ObjectNode.of(f"a{character}b", [f"c{character}d"])], [ObjectNode.of("g")]
        )
    ]
    assert reader.diagnostics == []


def test_a_remark_behind_such_a_character_is_on_its_line_and_column() -> None:
    _, reader = read("O\ta\u2028\x85\x0c\t7\nM\tmix\nO\t🍠b\t8\n//\n")
    assert places(reader) == [("motion-flag", 1, 8), ("motion-flag", 3, 6)]


def test_old_line_ends_are_line_ends_too() -> None:
    text = "# Source: v\n//\n" + TEA_WITH_IDS + "# aside\n" + MIX
    found, reader = read(text.replace("\n", "\r"))
    assert found == read(text)[0]
    assert reader.diagnostics == []


# --- what makes a node and a unit


def test_the_order_of_states_does_not_matter() -> None:
    one = node_of("O\ta", "S\thot", "S\tpeeled", "S\tin\t[pan]", "S\tcontains\t{x,y}")
    other = node_of("O\ta", "S\tcontains\t{y,x}", "S\tin\t[pan]", "S\tpeeled", "S\thot", "S\thot")
    assert one == other == ObjectNode.of("a", ["hot", "peeled"], [("in", "pan")], [("contains", ["x", "y"])])


def test_how_often_an_ingredient_is_there_matters() -> None:
    once, twice = node_of("O\ta", "S\tcontains\t{x}"), node_of("O\ta", "S\tcontains\t{x,x}")
    assert once != twice
    assert twice.ingredients == ("x", "x")


def test_what_a_node_is_in_or_on_or_holds_matters() -> None:
    different = [
        node_of("O\ta"),
        node_of("O\tb"),
        node_of("O\ta", "S\tin"),
        node_of("O\ta", "S\tin\t[p]"),
        node_of("O\ta", "S\ton\t[p]"),
        node_of("O\ta", "S\tin\t[q]"),
        node_of("O\ta", "S\tin\t{p}"),
        node_of("O\ta", "S\ton\t[p]", "S\tin\t[p]"),
        node_of("O\ta", "S\tcoated\t{p}"),
        node_of("O\ta", "S\tcoated\t{p}", "S\tin\t{p}"),
    ]
    assert len(set(different)) == len(different)


def test_two_lists_and_two_relations_under_one_object_are_all_kept() -> None:
    node = node_of("O\ta", "S\tcontains\t{x}", "S\tin\t[p]", "S\tcontains\t{y,x}", "S\ton\t[q]")
    assert node == ObjectNode.of(
        "a", [], [("in", "p"), ("on", "q")], [("contains", ["x"]), ("contains", ["x", "y"])]
    )
    assert node.ingredients == ("x", "x", "y")
    turned = ["S\tcontains\t{x,y}", "S\ton\t[q]", "S\tin\t[p]", "S\tcontains\t{x}"]
    assert node_of("O\ta", *turned) == node
    _, reader = read("O\ta\nS\tcontains\t{x}\nS\tcontains\t{y}\nM\tmix\nO\tb\n//\n")
    assert reader.diagnostics == []


def test_ids_flags_and_times_are_no_part_of_a_node_or_unit() -> None:
    one, _ = read("O1\ta\t0\nM2\tmix\t0:01\t0:02\nO3\tb\t1\n//\n")
    other, _ = read("O9\ta\t1\t4\nM8\tmix\nO7\tb\n//\n")
    assert units_of(one) == units_of(other) == [MIX_UNIT]


def test_a_node_listed_twice_in_a_unit_counts_once(tmp_path: Path) -> None:
    file = tmp_path / "f.txt"
    file.write_text("O\ta\nO\tc\nO\ta\nM\tmix\nO\tb\nO\tb\n//\nO\tc\nO\ta\nM\tmix\nO\tb\n//\n")
    network = FoonReader().read_network([file])
    assert network.inputs == ((0, 1),)
    assert network.outputs == ((2,),)
    assert [source.line for source in network.sources[0]] == [1, 8]


# --- where units come from


def test_every_unit_knows_its_first_line() -> None:
    found, _ = read("//\n\n# one\n" + MIX + "\n" + TEA_WITH_IDS + MIX)
    assert [(unit.motion, unit.source.line, unit.source.column) for unit in found] == [
        ("mix", 4, 1),
        ("pour", 9, 1),
        ("mix", 19, 1),
    ]


def test_the_addresses_above_a_unit_are_its_videos() -> None:
    text = (
        MIX  # before any address
        + "# Source:\thttps://example.org/1\n# cut at 3:10\n# Source: https://example.org/2 \n//\n"
        + MIX
        + MIX
        + "# Source:\thttps://example.org/3\n//\n"
        + MIX
        + "# Source:\t4\n//\n//\n# Source:\t5\n"
        + MIX
    )
    found, reader = read(text)
    assert [unit.source.videos for unit in found] == [
        (),
        ("https://example.org/1", "https://example.org/2"),
        ("https://example.org/1", "https://example.org/2"),
        ("https://example.org/3",),
        ("4", "5"),
    ]
    assert reader.diagnostics == []


def test_the_videos_of_one_file_are_not_those_of_the_next(tmp_path: Path) -> None:
    (tmp_path / "1.txt").write_text("# Source:\tv\n" + MIX)
    (tmp_path / "2.txt").write_text(MIX)
    network = FoonReader().read_network([tmp_path / "1.txt", tmp_path / "2.txt"])
    assert [source.videos for source in network.sources[0]] == [("v",), ()]


def test_an_address_that_is_missing_is_no_video() -> None:
    (unit,), _ = read("# Source:\n# Source: \t\n" + MIX)
    assert unit.source.videos == ()


# --- merging


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
    assert network.unit(0) == MIX_UNIT
    assert network.unit(1) == TEA_UNIT
    assert network.unit_id(TEA_UNIT) == 1


def test_copies_with_their_nodes_in_another_order_are_merged(tmp_path: Path) -> None:
    file = tmp_path / "f.txt"
    file.write_text(
        "O\ta\nO\tb\nS\tx\nS\ty\nM\tmix\nO\tc\nO\td\n//\n"
        + "O\tb\nS\ty\nS\tx\nO\ta\nM\tmix\nO\td\nO\tc\n//\n"
    )
    network = FoonReader().read_network([file])
    assert len(network) == 1
    assert [source.line for source in network.sources[0]] == [1, 9]
    assert [network.objects[o].label for o in network.inputs[0]] == ["a", "b"]


def test_units_that_differ_in_motion_input_or_output_are_not_merged(tmp_path: Path) -> None:
    file = tmp_path / "f.txt"
    file.write_text(
        "O\ta\nM\tmix\nO\tb\n//\nO\ta\nM\tMix\nO\tb\n//\nO\ta\nS\thot\nM\tmix\nO\tb\n//\nO\tb\nM\tmix\nO\ta\n//\n"
    )
    assert len(FoonReader().read_network([file])) == 4


def test_a_tree_keeps_its_copies_in_their_order(tmp_path: Path) -> None:
    file = tmp_path / "f.txt"
    file.write_text(MIX + TEA + MIX)
    tree = FoonReader().tree_units(read_plain_text(file), str(file))
    assert [(unit, source.line) for unit, source in tree] == [(MIX_UNIT, 1), (TEA_UNIT, 5), (MIX_UNIT, 15)]


# --- warnings: read all the same


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("O\ta\nM\tmix\nO\tb\n", [("missing-separator", 3, 4)]),
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


def test_a_warning_quotes_its_line() -> None:
    _, reader = read("\r\nO\ta\r\nS\tunder [pan]\r\nM\tmix\r\nO\tb\r\n//\r\n")
    assert reader.diagnostics == [
        Diagnostic(
            Severity.WARNING,
            "space-for-tab",
            "no tab before [pan]; read as if there were one",
            Source("f.txt", 3, 8),
            "S\tunder [pan]",
            "S\tunder\t[pan]",
        )
    ]


def test_dirt_is_remarked_on_wherever_it_stands() -> None:
    dirty = "O\ta\n# aside\nS\tcontains\t{x,}\n\nS\tcontains\t{x,}\nM\tmix\nO\tb\n//\n"
    found, reader = read(dirty * 2)
    assert [d.source.line for d in reader.diagnostics] == [3, 5, 11, 13]
    assert found[0].inputs == found[1].inputs == [ObjectNode.of("a", [], [], [("contains", ["x"])] * 2)]


# --- errors: located, all of them, and nothing else

# text, the place, a part of the message; the good unit MIX follows each
STRUCTURAL = [
    ("O\ta\nM\tmix\nx\nO\tb\n//\n", ("syntax", 3, 1), "found 'x', expected an object line"),
    ("O\ta\nS\tin\t[p]]\nM\tmix\nO\tb\n//\n", ("syntax", 2, 9), "found ']', expected the end of the line"),
    ("O\ta\nM\tmix\nO\tb\nO\n//\n", ("syntax", 4, 1), "found 'O', expected an object line"),
    ("S\tx\nO\ta\nM\tmix\nO\tb\n//\n", ("state-without-object", 1, 1), "expected an object line before it"),
    ("O\ta\nM\tmix\nS\tx\nO\tb\n//\n", ("state-without-object", 3, 1), "expected an object line before it"),
    ("O\ta\nM\tmix\nO\tb\nM\tcut\nO\tc\n//\n", ("second-motion", 4, 1), "found a second motion in one unit"),
    ("O\ta\nM\tmix\nM\tmix\nO\tb\n//\n", ("second-motion", 3, 1), "found a second motion in one unit"),
]
# text, and where it is said that it holds no unit, in either mode
NO_UNIT = [
    ("\nO\ta\nS\tx\n//\n", ("no-motion", 4, 1), "found //, expected a motion line: the unit of line 2", 2),
    ("O\ta\n# x\n\nO\tb\n//\n", ("no-motion", 5, 1), "expected a motion line: the unit of line 1", 2),
    ("M\tmix\nO\tb\n//\n", ("no-inputs", 1, 1), "the unit of line 1 has no input objects", 2),
    ("\n\nM\tmix\n// \n", ("no-inputs", 3, 1), "the unit of line 3 has no input objects", 1),
]


@pytest.mark.parametrize(("text", "place", "message"), STRUCTURAL)
def test_an_error_is_located_and_named(text: str, place: tuple[str, int, int], message: str) -> None:
    found, reader = read(text + MIX)
    assert places(reader) == [place]
    (error,) = reader.diagnostics
    assert error.severity is Severity.ERROR
    assert error.source.file == "f.txt"
    assert message in error.message
    assert error.excerpt == text.split("\n")[place[1] - 1]
    with pytest.raises(InputError) as caught:
        reader.raise_errors()
    assert caught.value.diagnostics == (error,)
    assert units_of(found)[-1] == MIX_UNIT


@pytest.mark.parametrize(("text", "place", "message"), STRUCTURAL)
def test_lenient_makes_it_a_warning_at_the_same_place(
    text: str, place: tuple[str, int, int], message: str
) -> None:
    found, reader = read(text + MIX, lenient=True)
    reader.raise_errors()
    assert places(reader)[0] == place
    # A unit with two motions is told of as well, since all of it is left out.
    assert places(reader)[1:] == [("second-motion", 1, 1)] * (place[0] == "second-motion")
    warning = reader.diagnostics[0]
    assert warning.severity is Severity.WARNING
    assert message in warning.message
    assert all(d.message.endswith("; left out") for d in reader.diagnostics)
    assert units_of(found)[-1] == MIX_UNIT


@pytest.mark.parametrize("lenient", [False, True])
@pytest.mark.parametrize(("text", "place", "message", "lines"), NO_UNIT)
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
    assert units_of(found) == [MIX_UNIT]
    assert reader.left_out == lines


@pytest.mark.parametrize("second", ["M\tmix\n", "M\tcut\t0:01\n", "O\tb\nM\tmix\n"])
def test_a_second_motion_is_an_error_and_the_unit_is_never_read(second: str) -> None:
    text = "O\ta\nM\tmix\n" + second + "O\tc\n//\n"
    found, reader = read(text)
    assert found == []
    assert [(d.code, d.severity) for d in reader.diagnostics] == [("second-motion", Severity.ERROR)]
    found, reader = read(text, lenient=True)
    assert found == []
    assert [(d.code, d.severity) for d in reader.diagnostics] == [("second-motion", Severity.WARNING)] * 2
    assert "2 motions" in reader.diagnostics[1].message
    assert reader.left_out == text.count("\n") - 1


@pytest.mark.parametrize(
    ("text", "left_out", "kept"),
    [
        ("O\ta\nM\tmix\nx\nO\tb\n//\n", 1, "O\ta\nM\tmix\nO\tb\n//\n"),
        ("O\ta\nS\tin\t[p]]\nS\thot\nM\tmix\nO\tb\n//\n", 1, "O\ta\nS\thot\nM\tmix\nO\tb\n//\n"),
        # a line that is nothing does not part an object from its states
        ("O\ta\nS\tx\n?\nS\ty\nM\tmix\nO\tb\n//\n", 1, "O\ta\nS\tx\nS\ty\nM\tmix\nO\tb\n//\n"),
        # the states of an object that cannot be read go with it
        ("O\ta\nO\nS\tx\nS\ty\nM\tmix\nO\tb\n//\n", 3, "O\ta\nM\tmix\nO\tb\n//\n"),
        ("O\ta\nM\tmix\nO\tb\nO\n# x\nS\ty\n//\n", 2, "O\ta\nM\tmix\nO\tb\n//\n"),
        ("O\ta\nO\nx\nS\ty\nM\tmix\nO\tb\n//\n", 3, "O\ta\nM\tmix\nO\tb\n//\n"),
        ("O\ta\nO\nS\tx\nO\tc\nS\ty\nM\tmix\nO\tb\n//\n", 2, "O\ta\nO\tc\nS\ty\nM\tmix\nO\tb\n//\n"),
        ("S\tx\nS\ty\nO\ta\nM\tmix\nO\tb\n//\n", 2, "O\ta\nM\tmix\nO\tb\n//\n"),
        ("O\ta\nM\tmix\nM\t]\nO\tb\n//\n", 1, "O\ta\nM\tmix\nO\tb\n//\n"),
        ("O\ta\nM\t]\nM\tmix\nO\tb\n//\n", 1, "O\ta\nM\tmix\nO\tb\n//\n"),
        ("O\ta\nS\tx\nO\tb\n//\n", 3, ""),
        ("M\tmix\nO\tb\nS\tx\n//\n", 3, ""),
    ],
)
def test_lenient_leaves_out_the_line_and_keeps_the_rest(text: str, left_out: int, kept: str) -> None:
    found, reader = read(text + TEA, lenient=True)
    assert units_of(found) == units_of(read(kept + TEA)[0])
    assert reader.left_out == left_out
    assert reader.diagnostics


@pytest.mark.parametrize(
    "text", ["O\ta\nO\nS\tx\nM\tmix\nO\tb\n//\n", "O\ta\nM\tmix\nO\tb\nO[\n# x\nS\ty\n//\n"]
)
def test_states_of_an_object_that_cannot_be_read_are_not_those_of_the_one_before(text: str) -> None:
    found, reader = read(text, lenient=True)
    assert units_of(found) == [MIX_UNIT]
    assert [d.code for d in reader.diagnostics] == ["syntax"]


@pytest.mark.parametrize(
    ("text", "left_out"),
    [
        ("O\ta\n\n# x\nO\tb\n//\n", 2),
        ("O\ta\nx\n//\n", 2),
        ("x\n//\n", 1),
        ("O\ta\nM\t]\nO\tb\n//\n", 3),
        ("O[\nM\tmix\nO\tb\n//\n", 3),
        ("O\ta\n", 1),
        ("O\ta\n\n\n", 1),
    ],
)
def test_a_unit_left_out_counts_every_line_of_it_once(text: str, left_out: int) -> None:
    found, reader = read(text, lenient=True)
    assert found == []
    assert reader.left_out == left_out


def test_a_unit_that_is_not_finished_when_the_file_ends() -> None:
    found, reader = read(MIX + "O\ta\nS\tx")
    assert units_of(found) == [MIX_UNIT]
    assert places(reader) == [("no-motion", 6, 1)]
    assert reader.diagnostics[0].message == (
        "the file ends, expected a motion line: the unit of line 5 has no motion; left out"
    )


def test_a_file_ends_on_its_last_line() -> None:
    _, reader = read(MIX + "O\ta\nS\tx\n")
    assert [(d.code, d.source.line) for d in reader.diagnostics] == [("no-motion", 6)]
    assert reader.diagnostics[0].excerpt == "S\tx"


@pytest.mark.parametrize("lenient", [False, True])
@pytest.mark.parametrize("above", ["", "//\n", "\n", "# kitchen\n", "# kitchen\n//\n\n"])
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
    ("text", "place"),
    [
        ("O\ta\nM\t\nO\tb\n//\n", ("syntax", 2, 3)),
        ("O\ta\nMmix\nO\tb\n//\n", ("syntax", 2, 1)),
        ("O[a\nM\tmix\nO\tb\n//\n", ("syntax", 1, 1)),
    ],
)
def test_one_fault_is_one_error(text: str, place: tuple[str, int, int]) -> None:
    assert places(read(text)[1]) == [place]


@pytest.mark.parametrize(
    ("text", "places_of_both"),
    [
        ("O\ta\nS\t\n//\n", [("syntax", 2, 3), ("no-motion", 3, 1)]),
        ("M\tmix\nO\tb\nS\t\n//\n", [("syntax", 3, 3), ("no-inputs", 1, 1)]),
    ],
)
def test_a_broken_state_is_not_why_a_motion_or_an_input_is_missing(
    text: str, places_of_both: list[tuple[str, int, int]]
) -> None:
    assert places(read(text)[1]) == places_of_both


@pytest.mark.parametrize("line", ["///", " //", "// next", "--"])
def test_a_separator_that_is_not_quite_one_is_told_what_it_should_be(line: str) -> None:
    _, reader = read(f"O\ta\nM\tmix\nO\tb\n{line}\n" + MIX)
    assert places(reader)[0] == ("syntax", 4, 1)
    assert "//" in reader.diagnostics[0].message.partition(", expected ")[2]


def test_all_errors_of_all_files_are_collected(tmp_path: Path) -> None:
    one, two, three = (tmp_path / f"{n}.txt" for n in "123")
    one.write_text("O\ta\nS\t\nM\tmix\nO\tb\n//\nx\n" + MIX)
    two.write_text(MIX)
    three.write_text("O\ta\t7\nM\tmix\nO\t[\n//\n")
    reader = FoonReader()
    with pytest.raises(InputError) as caught:
        reader.read_network([one, two, three])
    assert [(d.source.file, d.source.line, d.source.column) for d in caught.value.diagnostics] == [
        (str(one), 2, 3),
        (str(one), 6, 1),
        (str(three), 3, 3),
    ]
    assert "motion-flag" in {d.code for d in reader.diagnostics}  # a warning is no part of the error
    assert f"{one}:2:3: error: found the end of the line, expected a name" in str(caught.value)
    assert f"{three}:3:3: error: found '[', expected a name" in str(caught.value)


def test_a_tree_with_errors_is_refused_and_lenient_reads_the_rest(tmp_path: Path) -> None:
    file = tmp_path / "f.txt"
    file.write_text(MIX + "?\n" + MIX)
    with pytest.raises(InputError, match=r"f\.txt:5:1: error: found '\?'"):
        FoonReader().tree_units(read_plain_text(file), str(file))
    reader = FoonReader(lenient=True)
    assert [unit for unit, _ in reader.tree_units(read_plain_text(file), str(file))] == [MIX_UNIT, MIX_UNIT]
    assert len(reader.read_network([file])) == 1
    assert reader.left_out == 2


def test_a_remark_brings_the_line_as_it_should_be_or_nothing() -> None:
    text = "O tea\t2\nS\tcontains\t{a,a}\nS\tin\tpot\nM\tmix\t1:35]\tx\nO\tb\t3\n//\t\n"
    _, reader = read(text)
    assert [(d.source.line, d.code, d.fix) for d in reader.diagnostics] == [
        (1, "space-for-tab", "O\ttea\t2"),
        (1, "motion-flag", "O\ttea\t2"),
        (2, "repeated-ingredient", None),
        (3, "bracket", "S\tin\t[pot]"),
        (4, "time", "M\tmix\t1:35\tx"),
        (4, "time", "M\tmix\t1:35\tx"),
        (5, "motion-flag", None),
        (6, "outer-space", "//"),
    ]


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


@pytest.mark.slow
@pytest.mark.parametrize("letter", ["O\t", "S\t", "M\t", "x"])
def test_a_line_of_more_than_a_million_letters_is_refused(letter: str) -> None:
    longest = letter + "a" * (1_000_000 - len(letter))
    text = "O\ta\n%s\nM\tmix\nO\tb\n//\n" + MIX
    found, reader = read(text % f"{longest}a")
    assert places(reader) == [("syntax", 2, 1_000_001)]
    assert "a line of 1000001 letters" in reader.diagnostics[0].message
    assert len(str(reader.diagnostics[0])) < 1000
    found, reader = read(text % f"{longest}a", lenient=True)
    assert units_of(found) == [MIX_UNIT, MIX_UNIT]
    _, reader = read(text % longest)
    assert not any("letters" in d.message for d in reader.diagnostics)


# --- files that are not text


@pytest.mark.parametrize("lenient", [False, True])
@pytest.mark.parametrize(
    ("data", "line", "column", "byte"),
    [
        (b"O\tcr\xe8me\n", 1, 5, "e8"),
        ("O\tcrème\n".encode() + b"S\t\xff", 2, 3, "ff"),
        ("O\tcrème brûl".encode() + b"\xe9e", 1, 13, "e9"),
        ("O\ta\r\n".encode("utf-16"), 1, 1, "ff"),
        (b"O\ta\nM\tmix\xc3", 2, 6, "c3"),
    ],
)
def test_a_file_that_is_not_utf_8_is_refused_in_place(
    tmp_path: Path, lenient: bool, data: bytes, line: int, column: int, byte: str
) -> None:
    file = tmp_path / "f.txt"
    file.write_bytes(data)
    with pytest.raises(InputError) as caught:
        FoonReader(lenient).read_network([file])
    (error,) = caught.value.diagnostics
    assert error.source == Source(str(file), line, column)
    assert f"found the byte 0x{byte}, expected UTF-8" in error.message


@pytest.mark.parametrize(
    ("data", "column", "byte"),
    [(b"O\tcr\xe8me\n", 5, "e8"), ("O\té".encode() + b"ab\xff", 6, "ff"), (b"\xff", 1, "ff")],
)
def test_a_wrong_byte_behind_a_byte_order_mark_is_located(
    tmp_path: Path, data: bytes, column: int, byte: str
) -> None:
    file = tmp_path / "f.txt"
    file.write_bytes("\N{BYTE ORDER MARK}".encode() + data)
    with pytest.raises(InputError) as caught:
        FoonReader().read_network([file])
    (error,) = caught.value.diagnostics
    assert error.source == Source(str(file), 1, column)
    assert f"0x{byte}" in error.message


def test_a_file_that_is_not_utf_8_does_not_hide_the_errors_of_others(tmp_path: Path) -> None:
    one, two, three = (tmp_path / f"{n}.txt" for n in "123")
    one.write_text("x\n")
    two.write_bytes(b"\xff")
    three.write_text("y\n")
    with pytest.raises(InputError) as caught:
        FoonReader().read_network([one, two, three])
    files = [d.source.file for d in caught.value.diagnostics]
    assert list(dict.fromkeys(files)) == [str(one), str(two), str(three)]


def test_a_file_that_cannot_be_opened_is_named(tmp_path: Path) -> None:
    for path in (tmp_path / "nothing.txt", tmp_path):
        for lenient in (False, True):
            with pytest.raises(UserError, match="cannot be read") as caught:
                FoonReader(lenient).read_network([path])
            assert str(path) in str(caught.value)


# --- one reader, many texts


def test_a_reader_remembers_nothing_that_matters() -> None:
    reader = FoonReader()
    dirty = "O\ta\nS\tx [b]\nS\t\nM\tmix\nO\tb\n//\n"
    first = list(reader.units(dirty, "f.txt"))
    remarks = list(reader.diagnostics)
    assert list(reader.units(dirty, "f.txt")) == first
    assert reader.diagnostics == remarks * 2


@pytest.mark.parametrize("seed", range(12))
def test_a_file_is_read_in_pieces_as_it_is_at_once(
    seed: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
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
    text = "".join(rng.choice(lines) + rng.choice(["\n", "\n", "\r\n", "\r"]) for _ in range(80))
    text = text.replace("\n//\n", "\n" if seed == 0 else "\n//\n")  # one of them has no separator
    file = tmp_path / "f.txt"
    file.write_bytes(("\N{BYTE ORDER MARK}" if seed % 2 else "").encode() + text.encode())
    whole = FoonReader(lenient=True)
    expected = list(whole.units(read_plain_text(file), str(file)))
    monkeypatch.setattr(reader_module, "_PIECE", rng.randrange(1, 30))
    monkeypatch.setattr(reader_module, "_AHEAD", rng.randrange(1, 100))
    monkeypatch.setattr(reader_module, "_REMEMBERED", rng.randrange(1, 9))
    pieces = FoonReader(lenient=True)
    assert list(pieces.file_units(file)) == expected
    assert pieces.diagnostics == whole.diagnostics
    assert (pieces.left_out, pieces.marked) == (whole.left_out, whole.marked)


def test_a_reader_that_met_an_error_reads_the_next_file(tmp_path: Path) -> None:
    bad, good = tmp_path / "bad.txt", tmp_path / "good.txt"
    bad.write_text("x\n")
    good.write_text(MIX)
    reader = FoonReader()
    with pytest.raises(InputError):
        reader.tree_units(read_plain_text(bad), str(bad))
    assert [unit for unit, _ in reader.tree_units(read_plain_text(good), str(good))] == [MIX_UNIT]
    with pytest.raises(InputError):
        reader.read_network([good, bad])
    assert len(reader.read_network([good])) == 1


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
def test_any_text_is_read_or_refused_in_place(text: str) -> None:
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


@steady
@given(texts())
def test_a_text_without_a_diagnostic_has_lost_nothing(text: str) -> None:
    found, reader = read(text)
    lines = text.split("\n")
    if not reader.diagnostics:
        assert len(found) == sum(line.startswith("M") for line in lines)
        nodes = sum(len(unit.inputs) + len(unit.outputs) for unit in found)
        assert nodes == sum(line.startswith("O") for line in lines)
        assert all(line.strip()[:1] in {"O", "S", "M", "#", "/", ""} for line in lines)


@steady
@given(texts())
def test_lenient_reads_any_text(text: str) -> None:
    _, reader = read(text, lenient=True)
    reader.raise_errors()
    strict = read(text)[1]
    errors = [d for d in strict.diagnostics if d.severity is Severity.ERROR]
    assert (reader.left_out > 0) == bool(errors or strict.left_out)
    assert reader.left_out >= strict.left_out


@steady
@given(
    st.binary(max_size=40)
    | texts().map(str.encode)
    | st.builds(bytes.__add__, st.just("\ufeffO\té".encode()), st.binary(max_size=6))
    | st.builds(lambda text, tail: text.encode() + tail, texts(), st.binary(min_size=1, max_size=3))
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


# --- the two ways to read


def both_ways(text: str, lenient: bool = False) -> tuple[list[ReadUnit], FoonReader]:
    """Read by object blocks, and line by line; both have to give the same."""
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


@pytest.mark.slow
@steady
@given(st.lists(unit_texts(), min_size=1, max_size=4), st.lists(st.integers(0, 3), max_size=8))
def test_whole_units_with_a_little_dirt_are_the_same_either_way(some: list[str], order: list[int]) -> None:
    text = "\n".join([*some, *(some[i % len(some)] for i in order), ""])
    found, reader = both_ways(text)
    assert len(found) == len(some) + len(order)
    assert reader.left_out == 0


@pytest.mark.slow
@steady
@given(units(), st.integers(1, 3), st.booleans())
def test_units_that_come_again_are_the_same_either_way(
    written: list[FunctionalUnit], times: int, lenient: bool
) -> None:
    found, _ = both_ways(write_units(written * times), lenient)
    assert units_of(found) == written * times


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


def test_the_lines_of_a_unit_are_kept_as_written() -> None:
    (unit,) = FoonReader().listed_units(TEA_WITH_IDS, "f.txt")
    lines: list[Line] = []
    for side in (unit.inputs, unit.outputs):
        for block in side:
            lines += [block.object, *block.states]
        lines += [unit.motion] if side is unit.inputs else []
    assert [write_line(line) for line in lines] == TEA_WITH_IDS.split("\n")[:-2]
    assert unit.sources == (Source("f.txt", 1),)
    assert unit.motion_source == Source("f.txt", 7)
    assert [block.source.line for block in (*unit.inputs, *unit.outputs)] == [1, 3, 5, 8]


def test_listed_units_of_a_text_with_errors_are_refused() -> None:
    strict, lenient = FoonReader(), FoonReader(lenient=True)
    texts = MIX + "?\n" + MIX, "f.txt"
    assert [len(list(reader.listed_units(*texts))) for reader in (strict, lenient)] == [2, 2]
    with pytest.raises(InputError, match=r"f\.txt:5:1: error: found '\?'"):
        strict.raise_errors()
    lenient.raise_errors()


# --- any network


@pytest.mark.slow
@steady
@given(units())
def test_ids_flags_times_comments_and_line_ends_change_nothing(written: list[FunctionalUnit]) -> None:
    plain = write_units(written)
    decorated = []
    for number, line in enumerate(plain.split("\n")):
        letter, tab, rest = line.partition("\t")
        ends = {"O": f"\t{number % 2}", "M": f"\t{number}:0{number % 10}\tAssumed"}
        decorated += [f"{letter}{number}\t{rest}{ends.get(letter, '')}" if tab else line, "# aside", ""]
    expected, plain_reader = read(plain)
    found, reader = read("\r\n".join(decorated))
    assert [unit[:3] for unit in found] == [unit[:3] for unit in expected]
    assert [d.code for d in reader.diagnostics] == [d.code for d in plain_reader.diagnostics]


@pytest.mark.slow
@steady
@given(units(), st.randoms(use_true_random=False))
def test_the_order_of_lines_within_a_side_changes_nothing(
    written: list[FunctionalUnit], random: Random
) -> None:
    shuffled = []
    for unit in written:
        sides = [list(unit.inputs), list(unit.outputs)]
        for side in sides:
            random.shuffle(side)
        shuffled.append(FunctionalUnit.of(unit.motion, *sides))
    assert units_of(read(write_units(shuffled))[0]) == written


# --- the real corpus


@pytest.mark.skipif(not CORPUS.is_dir(), reason=f"the real corpus is not at {CORPUS}")
def test_the_real_subgraphs_are_read_and_written_and_read_again() -> None:
    files = sorted((CORPUS / "subgraphs").glob("*.txt"))
    assert len(files) == 56
    unfinished: list[Diagnostic] = []
    for file in files:
        reader = FoonReader()
        tree = reader.tree_units(read_plain_text(file), str(file))
        assert tree
        unfinished += [d for d in reader.diagnostics if d.code == "no-motion"]
        assert (reader.left_out > 0) == any(d.code == "no-motion" for d in reader.diagnostics)
        read_units = [unit for unit, _ in tree]
        again, _ = read(write_units(read_units))
        assert units_of(again) == read_units
        assert [tuple(unit.inputs) for unit in again] == [unit.inputs for unit in read_units]
    assert len(unfinished) == 1
    assert unfinished[0].source.line > 1
    assert "has no motion" in str(unfinished[0])
