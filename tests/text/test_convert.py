"""``foon-asp convert``: from any dialect to any other, and a list of what is lost on the way."""

import json
from collections import Counter
from collections.abc import Iterable, Sequence
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from foon_asp.network import ObjectNode
from foon_asp.text.conversion import Converter
from foon_asp.text.conversion_loss import Loss
from foon_asp.text.diagnostics import InputError
from foon_asp.text.format import Dialect
from foon_asp.text.formats import format_of, format_with
from foon_asp.text.listed_unit import ListedUnit, ObjectBlock
from foon_asp.text.motion_times import MotionFields, in_two_fields
from foon_asp.text.object_list import read_object_list
from foon_asp.text.plain_file import read_plain_text
from foon_asp.text.reader import FoonReader
from tests.conftest import CORPUS, Cli
from tests.text.foon_strategies import names, steady

TEXT = """\
# Source:\thttps://example.org/tea.mp4
# warm the cup first
//
O7\twater\t1
S3\thot
S8\tin\t[kettle]
O9\tcup\t0

S4\tempty
M5\tpour*\t0:10\t0:20\tRobot\t0.85
O9\tcup\t1\t12
S6\tcoated\t{tea,milk}
S8\ton\t[table]
S8\tnext to\t[kettle]
//
"""
IN_PLAIN = """\
# Source:\thttps://example.org/tea.mp4
# warm the cup first
//
O\twater
S\thot
S\tin\t[kettle]
O\tcup

S\tempty
M\tpour
O\tcup
S\tcoated\t{tea,milk}
S\ton\t[table]
S\tnext to\t[kettle]
//
"""
IN_NO_IDS = """\
# Source:\thttps://example.org/tea.mp4
# warm the cup first
//
O\twater\t1
S\thot
S\tin\t[kettle]
O\tcup\t0

S\tempty
M\tpour*\t<0:10,0:20>\tRobot\t0.85
O\tcup\t1\t12
S\tcoated\t{tea,milk}
S\ton\t[table]
S\tnext to\t[kettle]
//
"""


IN_JSON = """\
{
    "source": [
        "https://example.org/tea.mp4"
    ],
    "functional_units": [
        {
            "input_nodes": [
                {
                    "object_id": 7,
                    "object_label": "water",
                    "object_states": [
                        {
                            "state_id": 3,
                            "state_label": "hot",
                            "relative_object": null
                        },
                        {
                            "state_id": 8,
                            "state_label": "in",
                            "relative_object": "kettle"
                        }
                    ],
                    "ingredients": [],
                    "object_in_motion": 1
                },
                {
                    "object_id": 9,
                    "object_label": "cup",
                    "object_states": [
                        {
                            "state_id": 4,
                            "state_label": "empty",
                            "relative_object": null
                        }
                    ],
                    "ingredients": [],
                    "object_in_motion": 0
                }
            ],
            "motion_node": {
                "motion_id": 5,
                "motion_label": "pour*",
                "start_time": "0:10",
                "end_time": "0:20",
                "robot_type": "Robot",
                "weight_success": 0.85
            },
            "output_nodes": [
                {
                    "object_id": 9,
                    "object_label": "cup",
                    "object_states": [
                        {
                            "state_id": 6,
                            "state_label": "coated {tea,milk}",
                            "relative_object": null
                        },
                        {
                            "state_id": 8,
                            "state_label": "on",
                            "relative_object": "table"
                        },
                        {
                            "state_id": 8,
                            "state_label": "next to",
                            "relative_object": "kettle"
                        }
                    ],
                    "ingredients": [],
                    "object_in_motion": 1,
                    "recipe_category": 12
                }
            ]
        }
    ]
}
"""
IN_JSON_LIST = """\
[
    {
        "input_nodes": [
            {
                "label": "water",
                "states": [
                    "hot"
                ],
                "ingredients": [],
                "container": "kettle"
            },
            {
                "label": "cup",
                "states": [
                    "empty"
                ],
                "ingredients": [],
                "container": null
            }
        ],
        "motion_node": "pour",
        "output_nodes": [
            {
                "label": "cup",
                "states": [],
                "ingredients": [
                    "tea",
                    "milk"
                ],
                "container": "table"
            }
        ]
    }
]
"""
LOST_IN_PLAIN = {
    Loss.IDS: (10, 4),
    Loss.MOTION_FLAGS: (3, 4),
    Loss.CATEGORIES: (1, 11),
    Loss.TIMES: (1, 10),
    Loss.RATES: (1, 10),
    Loss.COMPOSITE: (1, 10),
}
LOST_IN_JSON = {Loss.COMMENTS: (1, 2)}
LOST_IN_JSON_LIST = {Loss.VIDEOS: (1, 1), Loss.COMMENTS: (1, 2)}


def convert(text: str, target: Dialect, lenient: bool = False) -> tuple[str, dict[Loss, tuple[int, int]]]:
    """Convert, and give each loss with its count and the line of the first."""
    converter = Converter(target, lenient)
    converter.learn(text)
    result = converter.convert(text, "file")
    return result.text, {loss: (lost.occurrences, lost.first.line) for loss, lost in result.lost.items()}


def test_to_plain() -> None:
    assert convert(TEXT, Dialect.PLAIN) == (IN_PLAIN, LOST_IN_PLAIN)


def test_to_no_ids_and_back() -> None:
    assert convert(TEXT, Dialect.NO_IDS) == (IN_NO_IDS, {Loss.IDS: (10, 4)})
    assert convert(TEXT, Dialect.IDS) == (TEXT, {})


def test_to_json_and_back() -> None:
    text, lost = convert(TEXT, Dialect.JSON)
    assert text == IN_JSON
    assert lost == LOST_IN_JSON
    without_comments = [line for line in TEXT.split("\n") if line and line != "# warm the cup first"]
    assert convert(text, Dialect.IDS) == ("\n".join(without_comments) + "\n", {})
    assert convert(text, Dialect.JSON_LIST)[1][Loss.VIDEOS] == (1, 1)


def test_to_a_json_list() -> None:
    text, lost = convert(TEXT, Dialect.JSON_LIST)
    assert text == IN_JSON_LIST
    in_blocks = {Loss.IDS: (10, 4), Loss.CATEGORIES: (1, 11)}  # counted where the object begins
    meaning = {Loss.RELATION_WORDS: (1, 11), Loss.RELATIONS: (1, 11), Loss.CONTENTS_WORDS: (1, 11)}
    assert lost == LOST_IN_PLAIN | LOST_IN_JSON_LIST | in_blocks | meaning


def test_numbering() -> None:
    """Ids that are there are kept and used for the same name; new ones are higher than all of their kind."""
    text = (
        "O\tonion\nO40\tknife\nS\twhole\nO\tknife\nM\tchop\nO\tonion\nS7\tin\t[bowl]\nS\tin\t[cup]\nM3\tcut\n"
    )
    numbered = (
        "O41\tonion\nO40\tknife\nS8\twhole\nO40\tknife\nM4\tchop\n"
        "O41\tonion\nS7\tin\t[bowl]\nS7\tin\t[cup]\nM3\tcut\n"
    )
    assert convert(text, Dialect.IDS) == (numbered, {})


def test_the_files_of_one_call_are_numbered_alike() -> None:
    first, second = "O\tonion\nM\tpeel\nO\tonion\n//\n", "O\tcup\nM4\twash\nO2\tonion\n//\n"
    converter = Converter(Dialect.IDS)
    converter.learn(first)
    converter.learn(second)
    assert converter.convert(first, "a").text == "O2\tonion\nM5\tpeel\nO2\tonion\n//\n"
    assert converter.convert(second, "b").text == "O3\tcup\nM4\twash\nO2\tonion\n//\n"


@pytest.mark.parametrize(
    ("one", "two"),
    [
        ("<0:14,0:20>", "0:14\t0:20"),
        ("<Assumed>", "Assumed\tAssumed"),
        ("<0:02:50,1:00:00>", "0:02:50\t1:00:00"),
        ("1:10", "1:10"),
        ("Assumed\t1:10", "Assumed\t1:10"),
        ("<0:12-0:34,0:40-0:44>", "<0:12-0:34,0:40-0:44>"),
    ],
)
def test_times_stand_in_one_field_without_ids_and_else_in_two(one: str, two: str) -> None:
    unit = "O{0}\ta\nM{0}\tmix\t{1}\nO{0}\ta\nS{0}\tmixed\n//\n"
    assert convert(unit.format(1, two), Dialect.NO_IDS)[0] == unit.format("", one)
    assert convert(unit.format("", one), Dialect.IDS)[0] == unit.format(1, two)
    assert convert(unit.format("", "<0:14-0:20>"), Dialect.IDS)[0] == unit.format(1, "0:14\t0:20")


# Everything that a line may carry, in all combinations.
NAMES = names("*") | st.sampled_from(["tea", "cup", "in", "contains", "None", "12", "on"])
ITEMS = NAMES.map(lambda name: name.replace(",", "")).map(str.strip).filter(bool)
WORDS = NAMES.filter(lambda name: name != "contains")
IDS = st.sampled_from(["", "", "1", "23", "007"])


def lines(fields: st.SearchStrategy[Iterable[str]]) -> st.SearchStrategy[str]:
    return fields.map("\t".join)


TAGS = st.sampled_from(
    [(), ("0",), ("1",), ("1", "15"), ("0", "!"), ("!",), ("1", "7", "!"), ("2",), ("x", "15")]
)
OBJECTS = lines(st.builds(lambda i, name, tags: (f"O{i}", name, *tags), IDS, NAMES, TAGS))
STATES = lines(
    st.builds(lambda i, name: (f"S{i}", name), IDS, NAMES)
    | st.builds(lambda i, word, name: (f"S{i}", word, f"[{name}]"), IDS, WORDS, ITEMS)
    | st.builds(
        lambda i, word, items: (f"S{i}", word, "{" + ",".join(items) + "}"),
        IDS,
        st.just("contains") | NAMES,
        st.lists(ITEMS, max_size=3),
    )
)
TIMES = st.sampled_from(
    [
        (),
        ("0:10", "0:20"),
        ("<0:10,0:20>",),
        ("<Assumed>",),
        ("Assumed", "1:10"),
        ("1:10",),
        ("3:0s7", "0:10", "x"),
    ]
)
RATES = st.sampled_from([(), (), ("Robot", "0.85"), ("Human", ".5"), ("None", "1")])
MOTIONS = lines(
    st.builds(
        lambda i, name, star, times, rate: (f"M{i}", name + star, *times, *rate),
        IDS,
        NAMES,
        st.sampled_from(["", "", "*"]),
        TIMES,
        RATES,
    )
)
BLOCKS = st.builds(lambda first, rest: [first, *rest], OBJECTS, st.lists(STATES, max_size=4)).map("\n".join)
COMMENTS = st.sampled_from(
    [[], [], ["# note"], ["# Source:\thttps://a.b/c"], ["# From:\ta.txt:3\tvideo"], [""]]
)
UNITS = st.builds(
    lambda before, inputs, motion, outputs: "\n".join([*before, *inputs, motion, *outputs, "//"]),
    COMMENTS,
    st.lists(BLOCKS, min_size=1, max_size=3),
    MOTIONS,
    st.lists(BLOCKS, max_size=2),
)
NETWORKS = st.lists(UNITS, max_size=3).map(lambda units: "".join(unit + "\n" for unit in units))
LISTS = st.lists(BLOCKS, min_size=1, max_size=4).map(lambda blocks: "\n".join(blocks) + "\n")


def read(text: str) -> list[ListedUnit]:
    return list(FoonReader(lenient=True).listed_units(text, "file"))


def blocks_of(units: Iterable[ListedUnit]) -> list[ObjectBlock]:
    return [block for unit in units for block in (*unit.inputs, *unit.outputs)]


MEANING = {
    Loss.RELATION_WORDS,
    Loss.RELATIONS,
    Loss.CONTAINERS,
    Loss.CONTENTS_WORDS,
    Loss.CONTENTS_LISTS,
    Loss.NO_CONTENTS,
    Loss.PARTS,
}


def blurred(node: ObjectNode, lost: Iterable[Loss]) -> object:
    """Give a node without what a conversion says is lost."""
    if Loss.PARTS in lost:
        return str(node) if node[1:] != ObjectNode("")[1:] else node.label
    relations: Sequence[object] = sorted(node.relations)
    contents: Sequence[object] = list(node.contents)
    if Loss.RELATION_WORDS in lost or Loss.CONTAINERS in lost:
        relations = sorted(relation.object for relation in node.relations)
    if Loss.RELATIONS in lost:
        relations = []
    if {Loss.CONTENTS_WORDS, Loss.CONTENTS_LISTS, Loss.NO_CONTENTS} & set(lost):
        contents = list(node.ingredients)
    return node.label, node.states, relations, contents


def details(units: list[ListedUnit]) -> dict[Loss, Counter[object]]:
    """Give what is no part of the network and yet may be lost, each with how often it is there."""
    blocks = blocks_of(units)
    ids = [block.object.id for block in blocks] + [unit.motion.id for unit in units]
    ids += [state.id for block in blocks for state in block.states]
    motions = [MotionFields.of(unit.motion.fields) for unit in units]
    tags = [block.object.fields for block in blocks]
    return {
        Loss.IDS: Counter(i for i in ids if i),
        Loss.MOTION_FLAGS: Counter(f[0] for f in tags if f and f[0] in {"0", "1"}),
        Loss.GOAL_MARKS: Counter(f for fields in tags for f in fields if f == "!"),
        Loss.CATEGORIES: Counter(f for fields in tags for f in fields[1:] if f.isdecimal()),
        Loss.FIELDS: Counter(f[0] for f in tags if f and f[0] not in {"0", "1", "!"}),
        Loss.TIMES: Counter(in_two_fields(m.times) for m in motions if m.times),
        Loss.RATES: Counter((m.entity, m.rate) for m in motions if m.rate),
        Loss.COMPOSITE: Counter(unit.motion.motion for unit in units if unit.motion.composite),
    }


def in_order(units: list[ListedUnit]) -> list[object]:
    return [[(state.attribute, state.listed) for state in block.states] for block in blocks_of(units)]


@pytest.mark.parametrize("target", list(Dialect))
def test_an_empty_list_stays_or_is_listed_as_lost(target: Dialect) -> None:
    text = "O\tcup\nS\tcontains\t{}\nM\tfill\nO\tcup\nS\tfull\n//\n"
    result, lost = convert(text, target)
    kept = [unit.inputs[0].node for unit in read(result)] == [
        ObjectNode.of("cup", contents=[("contains", [])])
    ]
    assert kept == (target not in {Dialect.JSON_LIST, Dialect.NEUTRAL})
    assert kept == (not lost)


@settings(steady, max_examples=50)
@given(NETWORKS, st.sampled_from(Dialect))
def test_whatever_is_lost_is_listed_and_nothing_else(text: str, target: Dialect) -> None:
    before = read(text)
    try:
        result, lost = convert(text, target)
    except InputError as error:
        # Names that JSON keeps for something else, or a bare "contains" beside contents.
        assert "cannot hold" in str(error)  # noqa: PT017
        assert not format_with(target).has_comments
        assert "None" in text or "\tcontains" in text
        return
    after = read(result)
    same = [unit.motion.motion for unit in before] == [unit.motion.motion for unit in after]
    assert same
    for side in ("inputs", "outputs"):
        for old, new in zip(before, after, strict=True):
            nodes = [[blurred(block.node, lost) for block in getattr(unit, side)] for unit in (old, new)]
            assert nodes[0] == nodes[1]
    had, has = details(before), details(after)
    for kind, found in had.items():
        missing = found - has[kind]
        assert missing.total() == lost.get(kind, (0, 0))[0], kind
        # New are only the ids that were asked for, and what is left of a loss that is listed.
        if kind not in lost and (kind, target) != (Loss.IDS, Dialect.IDS):
            assert not has[kind] - found, kind
    if in_order(before) != in_order(after):
        assert (MEANING | {Loss.ORDER}) & set(lost)
    else:
        assert not (MEANING | {Loss.ORDER}) & set(lost)
    comments = {Loss.COMMENTS: "# note", Loss.VIDEOS: "# Source:", Loss.COPIES: "# From:"}
    for kind, start in comments.items():
        count = sum(line.startswith(start) for line in text.split("\n"))
        kept = sum(line.startswith(start) for line in result.split("\n"))
        if kind is Loss.VIDEOS and target is Dialect.JSON:
            kept = len(json.loads(result).get("source", []))
            assert not kept or {unit.sources[0].videos for unit in after} == {
                unit.sources[0].videos for unit in before
            }
        assert count - kept == lost.get(kind, (0, 0))[0]


@settings(steady, max_examples=40)
@given(NETWORKS)
def test_text_to_text_keeps_the_network_its_comments_and_blank_lines(text: str) -> None:
    for target in (Dialect.PLAIN, Dialect.NO_IDS, Dialect.IDS):
        result, lost = convert(text, target)
        assert [unit.sources for unit in read(result)] == [unit.sources for unit in read(text)]
        assert [line[:1] for line in result.split("\n")] == [line[:1] for line in text.split("\n")]
        assert not MEANING & set(lost)
        assert convert(result, target) == (result, {})


def patterns(text: str, file: Path) -> list[object]:
    file.write_text(text, newline="")
    entries = read_object_list(file)
    return [(p.label, p.states, p.ingredients, p.container, p.relations, n) for p, _, n in entries]


@settings(steady, max_examples=50)
@given(text=LISTS, target=st.sampled_from(Dialect))
def test_kitchens_and_goals(tmp_path_factory: pytest.TempPathFactory, text: str, target: Dialect) -> None:
    assert format_of(text).lists_objects(text)
    file = tmp_path_factory.getbasetemp() / "list"
    try:
        result, lost = convert(text, target)
    except InputError:
        assert not format_with(target).has_comments
        assert "None" in text or "\tcontains" in text
        return
    assert format_of(result).lists_objects(result)
    same = patterns(text, file) == patterns(result, file)
    only_words = {Loss.CONTENTS_WORDS, Loss.CONTENTS_LISTS, Loss.NO_CONTENTS}  # no part of a pattern
    assert same == (not (MEANING - only_words) & set(lost))


def test_what_json_says_and_text_cannot(tmp_path: Path) -> None:
    for name in ("a\tb", "a\nS\tb", "[a]", "", "\ud800", "x" * 1_000_001):
        node = json.dumps({"label": name})
        text = f'[{{"input_nodes": [{node}], "motion_node": "cut", "output_nodes": []}}]'
        with pytest.raises(InputError) as raised:
            convert(text, Dialect.PLAIN)
        assert raised.value.diagnostics[0].source.line == 1
        assert convert(text, Dialect.PLAIN, lenient=True)[0] == ""
    ingredient = '[{"label": "bowl", "ingredients": ["salt, pepper"]}]'
    with pytest.raises(InputError, match="would be read as contains"):
        convert(ingredient, Dialect.PLAIN)
    relation = '[{"label": "bowl", "states": [{"label": "contains", "relative_object": "cup"}]}]'
    with pytest.raises(InputError, match="cannot hold"):
        convert(relation, Dialect.PLAIN)


def test_a_container_without_a_word_becomes_in() -> None:
    text = '[{"label": "ice", "container": "glass"}, {"label": "tea", "container": "None"}]'
    assert convert(text, Dialect.PLAIN) == ("O\tice\nS\tin\t[glass]\nO\ttea\n", {Loss.CONTAINERS: (1, 1)})
    back, lost = convert("O\tice\nS\tin\t[glass]\nO\ttea\n", Dialect.JSON_LIST)
    assert [entry["container"] for entry in json.loads(back)] == ["glass", None]
    assert lost == {Loss.RELATION_WORDS: (1, 1)}


@pytest.mark.parametrize("target", [Dialect.JSON, Dialect.JSON_LIST, Dialect.NEUTRAL])
def test_json_holds_half_a_character_and_is_laid_out(target: Dialect) -> None:
    node = '{"label": "\\ud800é"}'
    result, _ = convert(
        f'[{{"input_nodes": [{node}], "motion_node": "m", "output_nodes": [{node}]}}]', target
    )
    assert "\\ud800" in result
    assert convert(result, target) == (result, {})


@pytest.mark.parametrize(
    ("text", "dialect"),
    [
        (TEXT, Dialect.IDS),
        (IN_PLAIN, Dialect.PLAIN),
        (IN_NO_IDS, Dialect.NO_IDS),
        ("O\ttea\nwhat\r\nM\tpour\t0:10\n", Dialect.NO_IDS),
        ("", Dialect.PLAIN),
        (IN_JSON, Dialect.JSON),
        (IN_JSON_LIST, Dialect.JSON_LIST),
        ('[{"object_label": "tea"}]', Dialect.JSON),
        ('[{"label": "tea"}]', Dialect.JSON_LIST),
        ('["tea", [3]]', Dialect.JSON_LIST),
        ('\n {"outputs": ["tea"], "id": "brew", "inputs": []}', Dialect.NEUTRAL),
        ('{"schema": "foon-asp/answer/1", "inputs": [], "outputs": []}', Dialect.JSON),
    ],
)
def test_the_dialect_is_found_out(text: str, dialect: Dialect) -> None:
    assert format_of(text).dialect(text) is dialect


@pytest.mark.slow
def test_corpus(universal: Path) -> None:
    """Every file to every dialect; a node that FOON text lists twice in a unit counts once."""

    def meant(units: list[ListedUnit], text: str) -> list[ListedUnit]:
        counts_copies = format_of(text).machine_written
        return [unit.with_totals if counts_copies else unit.without_repeats for unit in units]

    tables = {"motion.txt", "utensils.txt"}
    files = [f for f in CORPUS.rglob("*.*") if f.suffix in {".txt", ".json"} and f.name not in tables]
    files = [file for file in files if file.parent.name != "llm-trees"]  # not all of these can be read
    assert len(files) > 60
    texts = [read_plain_text(file) for file in files[::3]]
    reader = FoonReader(lenient=True)
    before = [list(reader.listed_units(text, "")) for text in texts]
    for target in Dialect:
        converter, back = Converter(target), FoonReader()
        for text in texts:
            converter.learn(text)
        for text, units in zip(texts, before, strict=True):
            result = converter.convert(text, "")
            after = list(back.listed_units(result.text, ""))
            assert [unit.motion.motion for unit in after] == [unit.motion.motion for unit in units]
            if not MEANING & set(result.lost):
                nodes_after = [b.node for b in blocks_of(meant(after, result.text))]
                assert nodes_after == [b.node for b in blocks_of(meant(units, text))]


def test_one_file(cli: Cli, tmp_path: Path) -> None:
    file, out = tmp_path / "tea.txt", tmp_path / "out.txt"
    file.write_text(TEXT)
    ran = cli("convert", file, "--to", "no-ids")
    assert (ran.code, ran.out) == (0, IN_NO_IDS)
    assert ran.err == f"{file}: ids → no-ids; not in the result:\n  10  ids; first at {file}:4\n"
    assert cli("convert", file, "--to", "ids", "-o", out).err == f"{file}: ids → ids; nothing is lost\n"
    assert out.read_text() == TEXT
    assert cli("convert", file, "--to", "json", "-o", tmp_path).code == 0
    assert (tmp_path / "tea.json").read_text() == IN_JSON


def test_a_folder(cli: Cli, tmp_path: Path) -> None:
    recipes, out = tmp_path / "recipes", tmp_path / "deep" / "out"
    (recipes / "hot").mkdir(parents=True)
    (recipes / "hot" / "tea.txt").write_text(TEXT)
    (recipes / "kitchen.json").write_text('[{"label": "cup"}]')
    ran = cli("convert", recipes, "--to", "plain", "-o", out)
    assert ran.code == 0
    assert ran.err.startswith("2 files (1 ids, 1 json-list) → plain; not in the result:\n  10  ids; first at")
    assert (out / "hot" / "tea.txt").read_text() == IN_PLAIN
    assert (out / "kitchen.txt").read_text() == "O\tcup\n"
    assert cli("convert", recipes, "--to", "plain").code == 2
    assert cli("convert", recipes, "--to", "plain", "-o", recipes).code == 2
    assert (recipes / "hot" / "tea.txt").read_text() == TEXT
    assert cli("convert", recipes, "--to", "plain", "-o", recipes / "kitchen.json").code == 2
    (recipes / "kitchen.txt").write_text("O\tcup\n")
    ran = cli("convert", recipes, "--to", "plain", "-o", tmp_path / "new")
    assert ran.code == 2
    assert "would both be written to" in ran.err
    assert not (tmp_path / "new").exists()


def test_nothing_is_written_when_something_is_not_understood(cli: Cli, tmp_path: Path) -> None:
    for name, text in (("a.txt", TEXT), ("b.txt", "O\ttea\nwhat\nM\tdrink\n//\n")):
        (tmp_path / name).write_text(text)
    ran = cli("convert", tmp_path, "--to", "json", "-o", tmp_path / "out")
    assert ran.code == 2
    assert f"{tmp_path / 'b.txt'}:2:1: error: " in ran.err
    assert not (tmp_path / "out").exists()
    assert cli("convert", tmp_path, "--to", "json", "-o", tmp_path / "out", "--lenient").code == 0


def test_lines_that_are_in_no_unit_are_counted(cli: Cli, tmp_path: Path) -> None:
    file = tmp_path / "a.txt"
    file.write_text("O\ttea\n//\nO\ttea\nM\tdrink\nO\tcup\n//\n")
    ran = cli("convert", file, "--to", "json")
    assert ran.code == 0
    assert "  1  lines that are in no unit; see the warnings\n" in ran.err
    assert "has no motion; left out" in ran.err
    assert cli("convert", file, "--to", "plain").out == file.read_text()
