"""Writing FOON text: the canonical form, which the reader takes back without loss."""

from hypothesis import given, settings

from foon_asp.network import FunctionalUnit, ObjectNode
from foon_asp.text.reader import FoonReader
from foon_asp.text.writer import write_node, write_unit, write_units
from tests.text.foon_strategies import steady, units

BOWL = ObjectNode.of(
    "mixing bowl",
    ["stirred", "clean"],
    [("on", "table"), ("in", "sink")],
    [("contains", ["salt", "flour"]), ("coated", ["oil"])],
)
UNIT = FunctionalUnit.of(
    "pour", [ObjectNode.of("b", ["hot"]), ObjectNode.of("a")], [ObjectNode.of("c", [], [("in", "d")])]
)


def read_back(text: str) -> tuple[list[FunctionalUnit], set[str]]:
    reader = FoonReader()
    found = [FunctionalUnit.of(u.motion, u.inputs, u.outputs) for u in reader.units(text, "f.txt")]
    return found, {diagnostic.code for diagnostic in reader.diagnostics}


def test_a_node_is_written_with_its_attributes_sorted() -> None:
    assert write_node(BOWL) == (
        "O\tmixing bowl\n"
        "S\tclean\n"
        "S\tstirred\n"
        "S\tin\t[sink]\n"
        "S\ton\t[table]\n"
        "S\tcoated\t{oil}\n"
        "S\tcontains\t{flour,salt}\n"
    )
    assert write_node(ObjectNode.of("onion")) == "O\tonion\n"


def test_a_unit_is_written_in_its_own_order_and_closed() -> None:
    assert write_unit(UNIT) == "O\tb\nS\thot\nO\ta\nM\tpour\nO\tc\nS\tin\t[d]\n//\n"


def test_a_text_begins_with_its_comments_and_a_separator() -> None:
    assert write_units([]) == "//\n"
    assert write_units([], ["one", "Source:\tv"]) == "# one\n# Source:\tv\n//\n"
    assert write_units([UNIT, UNIT], ["one"]) == "# one\n//\n" + write_unit(UNIT) * 2


def test_a_comment_of_two_lines_stays_a_comment() -> None:
    assert read_back(write_units([UNIT], ["one\ntwo", "three\r\n\nfour\rfive"])) == ([UNIT], set())


@settings(steady, max_examples=50)
@given(units())
def test_units_come_back_the_same_in_the_same_order(written: list[FunctionalUnit]) -> None:
    text = write_units(written, ["made by a test"])
    found, codes = read_back(text)
    assert found == written
    assert [(u.inputs, u.outputs) for u in found] == [(u.inputs, u.outputs) for u in written]
    # The canonical form leaves nothing found but what the units themselves are.
    assert codes <= {"no-outputs", "repeated-ingredient", "empty-ingredient"}
    assert write_units(found, ["made by a test"]) == text
