"""Reading FOON text and the tables beside it: both dialects, dirt, errors in place, nothing lost silently."""

from fractions import Fraction
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from foon_asp.errors import UserError
from foon_asp.network import FunctionalUnit, NetworkBuilder, NodePattern, ObjectNode, Relation, Source
from foon_asp.text.data_folder import find_data, read_data
from foon_asp.text.diagnostics import InputError
from foon_asp.text.goal_name import find_goal
from foon_asp.text.label_list import read_labels
from foon_asp.text.line import LineError
from foon_asp.text.line_parser import parse_node
from foon_asp.text.object_list import read_object_list
from foon_asp.text.plain_file import read_plain_text
from foon_asp.text.rate_table import read_rates
from foon_asp.text.reader import FoonReader
from foon_asp.text.writer import write_units
from tests.conftest import CORPUS

pytestmark = pytest.mark.sampled(2)  # by default each second case of a test: there are many

PLAIN = """\
# Source:\thttps://example.org/a
//
O\tmixing bowl
S\tempty
O\tmilk
S\tin\t[jug]
O\tjug
S\tcontains\t{milk}
M\tpour
O\tmixing bowl
S\tcontains\t{milk}
//
"""
WITH_IDS = """\
# Source:\thttps://example.org/a\r
//\r
O278\tmixing bowl\t1\r
S41\tempty\r
O12\tmilk\t1\t8\r
S65\tin\t[jug]\r
O12\tjug\t0\r
S23\tcontains\t{milk}\r
M54\tpour\t1:10\t1:11\r
O278\tmixing bowl\t0\r
S23\tcontains\t{milk}\r
//\r
"""


def units(text: str, lenient: bool = False) -> tuple[list[FunctionalUnit], FoonReader]:
    reader = FoonReader(lenient)
    read = [FunctionalUnit.of(u.motion, u.inputs, u.outputs) for u in reader.units(text, "file.txt")]
    return read, reader


def remarks(text: str, lenient: bool = False) -> list[tuple[str, int, int]]:
    return [(d.code, d.source.line, d.source.column) for d in units(text, lenient)[1].diagnostics]


def test_one_grammar_reads_both_dialects() -> None:
    expected = FunctionalUnit.of(
        "pour",
        [
            ObjectNode.of("mixing bowl", ["empty"]),
            ObjectNode.of("milk", [], [("in", "jug")]),
            ObjectNode.of("jug", [], [], [("contains", ["milk"])]),
        ],
        [ObjectNode.of("mixing bowl", [], [], [("contains", ["milk"])])],
    )
    for text in (PLAIN, WITH_IDS, PLAIN.replace("//\n", "//\n\n# aside\n")):
        read, reader = units(text)
        assert read == [expected]
        assert reader.diagnostics == []


def test_every_unit_knows_its_line_and_videos() -> None:
    text = (
        PLAIN + PLAIN.split("//\n")[1] + "//\n# Source:\tb\n# Source:\tc\n" + PLAIN.split("//\n")[1] + "//\n"
    )
    found = list(FoonReader().units(text, "file.txt"))
    assert [(u.source.line, u.source.videos) for u in found] == [
        (3, ("https://example.org/a",)),
        (13, ("https://example.org/a",)),
        (25, ("b", "c")),
    ]


def test_files_are_merged_with_every_copy_kept(tmp_path: Path) -> None:
    (tmp_path / "b.txt").write_text(WITH_IDS, newline="")
    (tmp_path / "a.txt").write_text("\N{BYTE ORDER MARK}" + PLAIN + PLAIN.replace("pour", "tip"), "utf-8")
    (tmp_path / "motion.txt").write_text("pour\t0.5\n")
    network = read_data(find_data(tmp_path)).network
    assert network.motions == ("pour", "tip")
    assert [[(Path(s.file).name, s.line) for s in copies] for copies in network.sources] == [
        [("a.txt", 3), ("b.txt", 3)],
        [("a.txt", 15)],
    ]
    assert len(network.objects) == 4
    assert network.producers[3] == (0, 1)
    assert network.consumers[0] == (0, 1)


@pytest.mark.parametrize(
    ("line", "code", "column", "means"),
    [
        ("S\tunder [pan]", "space-for-tab", 8, ObjectNode.of("milk", [], [("under", "pan")])),
        ("S\tcontains {a}", "space-for-tab", 11, ObjectNode.of("milk", [], [], [("contains", ["a"])])),
        ("S\tcontains\t{a, b}", "outer-space", 15, ObjectNode.of("milk", [], [], [("contains", ["a", "b"])])),
        ("S\tcontains\t{a,}", "empty-ingredient", 15, ObjectNode.of("milk", [], [], [("contains", ["a"])])),
        (
            "S\tcontains\t{a,b,a}",
            "repeated-ingredient",
            17,
            ObjectNode.of("milk", [], [], [("contains", ["a", "a", "b"])]),
        ),
        ("S\tcoated\t[a,b]", "contents-bracket", 10, ObjectNode.of("milk", [], [], [("coated", ["a", "b"])])),
        ("S\tcontains\t[a]", "contents-bracket", 12, ObjectNode.of("milk", [], [], [("contains", ["a"])])),
        ("S\ton\t[]", "empty-relation", 6, ObjectNode.of("milk", ["on"])),
        ("S\t cold", "outer-space", 3, ObjectNode.of("milk", ["cold"])),
    ],
)
def test_dirt_is_understood_and_remarked_on_in_place(
    line: str, code: str, column: int, means: ObjectNode
) -> None:
    text = f"//\nO\tmilk\n# aside\n{line}\nM\tmix\nO\tx\n//\n"
    read, reader = units(text * 2)
    assert read[0].inputs == (means,)
    assert [(d.code, d.source.line, d.source.column) for d in reader.diagnostics] == [
        (code, 4, column),
        (code, 11, column),
    ]


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("O\ta\t00\nM\tmix\nO\tb\n//\n", [("motion-flag", 1, 5)]),
        ("O\ta\nM\tmix\t1:35]\t3:0s7\nO\tb\n//\n", [("time", 2, 7), ("time", 2, 13)]),
        ("O\ta\nM\tmix\tAssumed\tassumed\nO\tb\n//\n", []),
        ("O\ta\nM\tmix\n//\n", [("no-outputs", 1, 1)]),
        ("O\ta\nM\tmix\nO\tb\n", [("missing-separator", 3, 4)]),
        ("O\ta\nM\tmix\nO\tb", [("missing-separator", 3, 4)]),
        ("O\ta\nS\tin\t[b]\nS\tin\t[c]\nS\tcontains\t{a}\nS\tcoated\t{a}\nM\tmix\nO\tb\n//\n", []),
    ],
)
def test_warnings_do_not_stop_the_reading(text: str, found: list[tuple[str, int, int]]) -> None:
    assert remarks(text) == found
    assert len(units(text)[0]) == 1


GOOD = "O\ta\nM\tmix\nO\tb\n//\n"


@pytest.mark.parametrize(
    ("text", "place", "message", "left_out"),
    [
        ("X\ta\n", (1, 1), "found 'X\\ta', expected an object line", 1),
        ("O\n", (1, 1), "found 'O', expected an object line (O, tab, label)", 1),
        ("O\ta\nS\tin\t[[b]\n", (2, 5), "found '\\t[[b]', expected [object], {ingredient", 1),
        ("O\ta\nS\tin\t[b]]\n", (2, 9), "found ']', expected the end of the line", 1),
        ("O\ta\nS\tin\t[b]\tc\n", (2, 9), "found '\\tc', expected the end of the line", 1),
        ("O\t  \nS\tx\n", (1, 5), "found the end of the line, expected a name", 2),
        ("O\ta\nS\t \n", (2, 4), "found the end of the line, expected a name", 1),
        ("O\t\nS\tx\nS\ty\n", (1, 3), "found the end of the line, expected a name", 3),
        ("S\tx\n", (1, 1), "found a state line, expected an object line before it", 1),
    ],
)
def test_errors_name_place_found_and_expected(
    text: str, place: tuple[int, int], message: str, left_out: int
) -> None:
    _, reader = units(text + GOOD)
    with pytest.raises(InputError) as caught:
        reader.raise_errors()
    first = caught.value.diagnostics[0]
    assert (first.source.line, first.source.column) == place
    assert message in first.message
    assert f"file.txt:{place[0]}:{place[1]}: error: " in str(caught.value)

    read, lenient = units(text + GOOD, lenient=True)
    lenient.raise_errors()
    assert read[-1].motion == "mix"
    assert lenient.left_out == left_out
    assert all("left out" in d.message for d in lenient.diagnostics)


def test_all_errors_are_reported_at_once(tmp_path: Path) -> None:
    (tmp_path / "one.txt").write_text("O\n" + GOOD + "S\tx\n\nO\tb\nM\tx\nM\ty\n//\n")
    (tmp_path / "two.txt").write_text("?\n" + GOOD)
    with pytest.raises(InputError) as caught:
        FoonReader().read_network([tmp_path / "one.txt", tmp_path / "two.txt"])
    assert [(Path(d.source.file).name, d.source.line, d.code) for d in caught.value.diagnostics] == [
        ("one.txt", 1, "syntax"),
        ("one.txt", 6, "state-without-object"),
        ("one.txt", 10, "second-motion"),
        ("two.txt", 1, "syntax"),
    ]


def test_unicode_line_separators_do_not_end_a_line() -> None:
    for separator in "\x0b\x0c\x1c\x1d\x1e\x85\u2028\u2029":
        read, _ = units(f"O\ta{separator}b\nM\tmix\nO\tc\n//\n")
        assert read[0].inputs[0].label == f"a{separator}b"


def test_a_file_that_is_not_text_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "x.txt"
    file.write_bytes(b"O\tcr\xe8me\n")
    with pytest.raises(InputError, match=r"x\.txt:1:5: error: found the byte 0xe8, expected UTF-8"):
        FoonReader().read_network([file])
    for missing in (tmp_path / "nothing.txt", tmp_path):
        with pytest.raises(UserError, match="cannot be read"):
            FoonReader().read_network([missing])


names = st.text("abc xyzé'", min_size=1, max_size=8).map(str.strip).filter(bool)
nodes = st.builds(
    ObjectNode.of,
    names,
    st.sets(names, max_size=3),
    st.sets(st.tuples(names, names), max_size=2),
    st.lists(st.tuples(names, st.lists(names, min_size=1, max_size=3)), max_size=2),
).filter(lambda node: all(relation.word != "contains" for relation in node.relations))
some_units = st.lists(
    st.builds(
        FunctionalUnit.of,
        names,
        st.lists(nodes, min_size=1, max_size=3),
        st.lists(nodes, min_size=1, max_size=3),
    ),
    max_size=5,
)


@pytest.mark.slow
@settings(deadline=None, derandomize=True, max_examples=100)
@given(some_units)
def test_what_is_written_is_read_again(written: list[FunctionalUnit]) -> None:
    read, reader = units(write_units(written))
    assert read == written
    assert [u.inputs for u in read] == [u.inputs for u in written]
    assert {d.code for d in reader.diagnostics} <= {"repeated-ingredient"}


@settings(deadline=None, derandomize=True, max_examples=200)
@given(nodes)
def test_the_notation_of_a_node_reads_back(node: ObjectNode) -> None:
    assert parse_node(str(node)) == node
    assert parse_node(str(node) + ";") == node


PIECES = [
    "O\ta",
    "O12\tb\t1",
    "S\tx",
    "S\tin\t[a]",
    "S\tin [a]",
    "S\tcontains\t{a,}",
    "M\tmix",
    "M4\tcut\t1:2",
]
PIECES += [
    "//",
    "",
    "#",
    "# Source:\tv",
    "O",
    "S\t",
    "{",
    "S\tin\t[",
    "\t",
    "O\ta\t\t",
    "\r",
    "M\t[",
    "\u2028",
]


@pytest.mark.slow
@settings(deadline=None, derandomize=True, max_examples=300)
@given(st.lists(st.sampled_from(PIECES) | st.text(max_size=6), max_size=25), st.sampled_from(["\n", "\r\n"]))
def test_no_text_crashes_the_reader_and_nothing_is_lost_silently(lines: list[str], end: str) -> None:
    text = end.join(lines)
    read, reader = units(text)
    for diagnostic in reader.diagnostics:
        line = text.replace("\r\n", "\n").replace("\r", "\n").split("\n")[diagnostic.source.line - 1]
        assert 1 <= diagnostic.source.column <= len(line) + 1
        assert str(diagnostic)
    if not reader.diagnostics:
        meaningful = [x for x in text.replace("\r\n", "\n").replace("\r", "\n").split("\n") if x[:1] == "M"]
        assert len(read) == len(meaningful)
    lenient_units, lenient = units(text, lenient=True)
    lenient.raise_errors()
    assert len(lenient_units) >= len(read)


@pytest.mark.parametrize(
    ("notation", "column"), [("", 1), ("; x", 1), ("a; in [b", 7), ("a;;b", 3), ("a; [b]", 3)]
)
def test_a_notation_that_cannot_be_read(notation: str, column: int) -> None:
    with pytest.raises(LineError) as caught:
        parse_node(notation)
    assert caught.value.column == column


def test_kitchen_entries_know_their_place_and_form(tmp_path: Path) -> None:
    file = tmp_path / "kitchen.json"
    file.write_text(
        '[\n  {"label": "a", "states": ["x"], "ingredients": ["c", "b"], "container": "pot"},\n'
        '  {"label": "b"}, {"label": "stove", "states": ["on", "under [pan]"]}]\n'
    )
    first, second, third = read_object_list(file)
    assert first.pattern == NodePattern("a", frozenset({"x"}), ("b", "c"), "pot")
    assert [(e.source.line, e.source.column) for e in (first, second, third)] == [(2, 3), (3, 3), (3, 19)]
    assert third.pattern.matches(ObjectNode.of("stove", ["on"], [("under", "pan")]))
    assert not third.pattern.matches(ObjectNode.of("stove", ["on"], [("in", "pan")]))


@pytest.mark.parametrize(
    ("text", "place"),
    [
        ('{"label": "a"}', "1:1"),
        ('[{"label": "a"}\n {"label": "b"}]', "2:2"),
        ('[{"label": "a"},\n 7]', "2:2"),
        ('[{"label": ""}]', "1:2"),
        ('[{"label": "a", "states": "x"}]', "1:2"),
        ('[{"label": "a", "container": 3}]', "1:2"),
        ('[{"label": "a", "container": "b", "contianer": 1}]', "1:2"),
        ('[{"label": "a"}] []', "1:18"),
        ('[{"label": "a"', "1:15"),
        ("[" * 100_000, "1:1"),
        ("[" + "9" * 5000 + "]", "1:2"),
        ('[{"label": "a", "states": ""}]', "1:2"),
        ('[{"label": "a",\n  }]', "1:15"),
        ('[{"label": "a"\n ,\t}]', "2:2"),
        ('[{"label": "a", "states": ["x", ]}]', "1:31"),
        ('[{"label": "a", "states": [,]}]', "1:28"),
        ('[{"label": "a", "states": ["x" "y"]}]', "1:32"),
        ('[{"label": "a", \'states\': []}]', "1:17"),
        ('[{"label": "a", "states": ["]', "1:28"),
    ],
)
def test_broken_json_is_located(tmp_path: Path, text: str, place: str) -> None:
    file = tmp_path / "kitchen.json"
    file.write_text(text)
    with pytest.raises(InputError, match=rf"kitchen\.json:{place}: error: "):
        read_object_list(file)


def test_a_container_matches_any_relation_and_null_none() -> None:
    inside, on = ObjectNode.of("a", [], [("in", "b")]), ObjectNode.of("a", [], [("on", "b")])
    both = ObjectNode.of("a", [], [], [("contains", ["x"]), ("coated", ["y", "x"])])
    assert NodePattern("a", container="b").matches(inside)
    assert NodePattern("a", container="b").matches(on)
    assert not NodePattern("a").matches(inside)
    assert not NodePattern("a", container="b").matches(ObjectNode.of("a"))
    assert NodePattern("a", ingredients=("x", "x", "y")).matches(both)
    assert not NodePattern("a", ingredients=("x", "y")).matches(both)
    assert not NodePattern("a", frozenset({"hot"})).matches(ObjectNode.of("a"))


def test_a_network_finds_the_nodes_that_an_entry_matches() -> None:
    places = [[("in", "bowl")], [("on", "bowl"), ("under", "lid")], [("in", "lid")], []]
    nodes = [
        ObjectNode.of(label, states, place, contents)
        for label in ("egg", "ham")
        for states in ([], ["raw"])
        for place in places
        for contents in ([], [("contains", ["salt"])])
    ]
    builder = NetworkBuilder()
    builder.add("mix", nodes, nodes[:1], Source("a.txt", 1))
    network = builder.build()
    entries = [
        NodePattern(label, states, ingredients, container, frozenset(Relation(*r) for r in relations))
        for label in ("egg", "jam")
        for states in (frozenset[str](), frozenset({"raw"}))
        for ingredients in ((), ("salt",))
        for container in (None, "bowl", "lid", "pot")
        for relations in ((), *places[:3])
    ]
    for entry in entries:
        assert network.find(entry) == tuple(o for o, node in enumerate(nodes) if entry.matches(node))
    assert sum(map(bool, map(network.find, entries))) > 20


def test_rates_are_exact(tmp_path: Path) -> None:
    file = tmp_path / "motion.txt"
    file.write_text("# comment\r\npour\t0.1\r\nmix\t1\nwhisk by hand\t.333333333333333333333\nmix\t1.0\n\n")
    rates = read_rates(file)
    assert rates["pour"] == Fraction(1, 10)
    assert rates["mix"] == 1
    assert rates["whisk by hand"] == Fraction(333333333333333333333, 10**21)
    for bad, column in (
        ("a\t0", 3),
        ("a\t1.01", 3),
        ("a\t-0.5", 3),
        ("a\t1e-2", 3),
        ("a 0.5", 6),
        ("a\t٣", 3),
    ):
        file.write_text(bad + "\n")
        with pytest.raises(InputError, match=rf"motion\.txt:1:{column}: error: "):
            read_rates(file)
    file.write_text("a\t0.5\na\t0.6\n")
    with pytest.raises(InputError, match="a second success rate for 'a'"):
        read_rates(file)


def test_labels(tmp_path: Path) -> None:
    file = tmp_path / "utensils.txt"
    file.write_text("# tools\nbowl\r\n\n cutting board \nrice cooker")
    assert read_labels(file) == {"bowl", "cutting board", "rice cooker"}


def test_goals_by_label_notation_and_goals_file(tmp_path: Path) -> None:
    (tmp_path / "FOON.txt").write_text(
        "O\tmilk\nO\tsalt\nM\tmix\nO\tmilk\nS\tsalted\nO\tfoam\nS\tin\t[cup]\nS\ton\t[milk]\n"
        "O\tfoam\nS\tcold\n//\n"
    )
    (tmp_path / "goal_nodes.json").write_text('[{"label": "milk", "states": ["salted"]}]')
    data = read_data(find_data(tmp_path))
    network, listed = data.network, data.goals
    salted = network.object_id(ObjectNode.of("milk", ["salted"]))
    assert find_goal("milk", network, listed) == salted
    bare = network.object_id(ObjectNode.of("milk"))
    assert find_goal("milk;", network, listed) == find_goal("milk", network) == bare
    assert find_goal("milk; salted", network) == salted
    assert find_goal("salt", network) == network.object_id(ObjectNode.of("salt"))
    foam = network.object_id(ObjectNode.of("foam", [], [("in", "cup"), ("on", "milk")]))
    assert find_goal("foam; on [milk]; in [cup]", network) == foam
    with pytest.raises(UserError, match="means 2 object nodes") as caught:
        find_goal("foam", network)
    for line in str(caught.value).splitlines()[1:]:
        pasted = line.removeprefix("  --goal ").strip("'")
        assert find_goal(pasted, network) in {foam, network.object_id(ObjectNode.of("foam", ["cold"]))}
    with pytest.raises(UserError, match="no object node has the label 'mlik'; similar are"):
        find_goal("mlik", network)


@pytest.mark.skipif(not CORPUS.is_dir(), reason=f"the real corpus is not at {CORPUS}")
def test_the_real_corpus() -> None:
    data = read_data(find_data(CORPUS / "universal"))
    assert (len(data.network), len(data.network.objects)) == (2376, 4305)
    items = read_object_list(CORPUS / "universal" / "kitchen.json")
    assert len(items) == 1174
    assert sum(bool(data.network.find(item.pattern)) for item in items) == 1173
    files = sorted((CORPUS / "subgraphs").glob("*.txt"))
    assert len(files) == 56
    left_out = {}
    for file in files:
        reader = FoonReader()
        read = [unit for unit, _ in reader.tree_units(read_plain_text(file), str(file))]
        if reader.left_out:
            left_out[file.name[:4]] = {d.code for d in reader.diagnostics} & {"no-motion", "no-inputs"}
        assert read
        assert units(write_units(read))[0] == read
    assert left_out == {"0083": {"no-motion"}}
