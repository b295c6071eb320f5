"""Networks in JSON: both forms, what they mean beside FOON text, odd values, and errors in place."""

import json
from pathlib import Path

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from foon_asp.errors import UserError
from foon_asp.network import Contents, FunctionalUnit, ObjectNode, Relation, Source
from foon_asp.text.diagnostics import InputError, Severity
from foon_asp.text.line import MotionLine, ObjectLine, StateLine
from foon_asp.text.line_parser import parse_line
from foon_asp.text.listed_unit import ListedUnit
from foon_asp.text.merged_network import merged_text
from foon_asp.text.plain_file import read_plain_text
from foon_asp.text.reader import FoonReader
from foon_asp.text.writer import write_line
from tests.text.foon_strategies import steady, units

FULL = """\
{
    "source": ["https://example.org/1", " https://example.org/2 "],
    "functional_units": [
        {
            "input_nodes": [
                {
                    "object_id": 278,
                    "object_label": "bowl",
                    "object_states": [
                        {"state_id": 41, "state_label": "empty", "relative_object": null},
                        {"state_id": 65, "state_label": "on", "relative_object": "table"}
                    ],
                    "ingredients": [],
                    "object_in_motion": 0
                },
                {
                    "object_id": 12,
                    "object_label": "cup",
                    "object_states": [
                        {"state_id": 23, "state_label": "contains", "relative_object": null}
                    ],
                    "ingredients": ["milk", "honey"],
                    "object_in_motion": 1
                }
            ],
            "motion_node": {
                "motion_id": 54,
                "motion_label": "pour*",
                "start_time": "0:01",
                "end_time": "0:09",
                "robot_type": "Robot",
                "weight_success": 0.850
            },
            "output_nodes": [
                {"object_label": "bowl", "object_states": [], "ingredients": ["honey", "milk"]}
            ]
        }
    ]
}
"""
BARE = """\
[
  {
    "input_nodes": [
      {"label": "bowl", "states": ["empty"], "ingredients": [], "container": "None"},
      {"label": "milk", "states": [], "ingredients": [], "container": "cup"}
    ],
    "motion_node": "pour",
    "output_nodes": [
      {"label": "bowl", "states": [], "ingredients": ["milk"], "container": null}
    ]
  }
]
"""


def read(text: str, lenient: bool = False) -> tuple[list[ListedUnit], FoonReader]:
    reader = FoonReader(lenient)
    return list(reader.listed_units(text, "f.json")), reader


def only(text: str) -> ListedUnit:
    (unit,), reader = read(text)
    assert reader.diagnostics == []
    return unit


def unit_text(inputs: object = None, motion: object = "mix", outputs: object = None) -> str:
    """Give a network of one unit in JSON, ``a`` to ``b`` where nothing else is said."""
    return json.dumps(
        [
            {
                "input_nodes": [{"label": "a"}] if inputs is None else inputs,
                "motion_node": motion,
                "output_nodes": [{"label": "b"}] if outputs is None else outputs,
            }
        ]
    )


def lines(unit: ListedUnit) -> list[str]:
    """Give the lines that a unit would have in FOON text."""
    blocks = [[write_line(b.object), *map(write_line, b.states)] for b in (*unit.inputs, *unit.outputs)]
    blocks.insert(len(unit.inputs), [write_line(unit.motion)])
    return [line for block in blocks for line in block]


def messages(text: str, lenient: bool = False) -> list[tuple[int, int, str]]:
    _, reader = read(text, lenient)
    return [(d.source.line, d.source.column, d.message) for d in reader.diagnostics]


# --- the two forms


def test_the_form_with_ids_keeps_all_that_foon_text_would() -> None:
    unit = only(FULL)
    assert lines(unit) == [
        "O278\tbowl\t0",
        "S41\tempty",
        "S65\ton\t[table]",
        "O12\tcup\t1",
        "S23\tcontains\t{milk,honey}",
        "M54\tpour*\t0:01\t0:09\tRobot\t0.850",
        "O\tbowl",
        "S\tcontains\t{honey,milk}",
    ]
    videos = ("https://example.org/1", "https://example.org/2")
    assert unit.sources == (Source("f.json", 4, 9, videos),)
    assert unit.motion == MotionLine("pour", "54", True, ("0:01", "0:09", "Robot", "0.850"))


def test_the_bare_form_has_names_alone() -> None:
    unit = only(BARE)
    assert lines(unit) == [
        "O\tbowl",
        "S\tempty",
        "O\tmilk",
        "S\tin\t[cup]",
        "M\tpour",
        "O\tbowl",
        "S\tcontains\t{milk}",
    ]
    assert unit.sources == (Source("f.json", 2, 3),)


@pytest.mark.parametrize("text", [FULL, BARE])
@pytest.mark.parametrize("end", ["\n", "\r\n"])
@pytest.mark.parametrize("start", ["", "\N{BYTE ORDER MARK}", "\n \t"])
def test_either_form_is_what_its_lines_are_as_foon_text(
    tmp_path: Path, text: str, end: str, start: str
) -> None:
    as_json, as_text = tmp_path / "f.json", tmp_path / "f.txt"
    as_json.write_text((start + text).replace("\n", end), "utf-8", newline="")
    as_text.write_text("\n".join(lines(only(text))) + "\n//\n")
    reader = FoonReader()
    (by_json, source), (by_text, _) = (
        reader.tree_units(read_plain_text(as_json), str(as_json))[0],
        reader.tree_units(read_plain_text(as_text), str(as_text))[0],
    )
    assert by_json == by_text
    assert source.line == only(text).sources[0].line + start.count("\n")
    assert reader.diagnostics == []
    assert len(FoonReader().read_network([as_json, as_text])) == 1


def test_json_is_known_by_its_first_letter_whatever_the_name(tmp_path: Path) -> None:
    file = tmp_path / "FOON.txt"
    file.write_text(BARE)
    assert FoonReader().read_network([file]).motions == ("pour",)


def test_units_are_read_either_way_the_same() -> None:
    reader = FoonReader()
    (unit,) = reader.units(FULL, "f.json")
    listed = only(FULL)
    assert unit.inputs == [block.node for block in listed.inputs]
    assert unit.outputs == [block.node for block in listed.outputs]
    assert (unit.motion, unit.sources) == ("pour", listed.sources)


@pytest.mark.slow
@steady
@given(units())
def test_any_units_in_the_form_with_ids_come_back(written: list[FunctionalUnit]) -> None:
    def as_json(node: ObjectNode) -> dict[str, object]:
        states: list[object] = [{"state_label": state} for state in node.states]
        states += [{"state_label": r.word, "relative_object": r.object} for r in node.relations]
        states += [f"{c.word} {{{','.join(c.ingredients)}}}" for c in node.contents]
        return {"object_label": node.label, "object_states": states}

    text = json.dumps(
        {
            "functional_units": [
                {
                    "input_nodes": list(map(as_json, unit.inputs)),
                    "motion_node": {"motion_label": unit.motion},
                    "output_nodes": list(map(as_json, unit.outputs)),
                }
                for unit in written
            ]
        },
        indent=1,
    )
    nodes = [node for unit in written for node in (*unit.inputs, *unit.outputs)]
    # In JSON, the name None means that there is none.
    assume(all(unit.motion != "None" for unit in written))
    assume(all(relation.object != "None" for node in nodes for relation in node.relations))
    found, reader = read(text)
    reader.raise_errors()
    for unit, listed in zip(written, found, strict=True):
        motion = parse_line(f"M\t{unit.motion}")
        assert isinstance(motion, MotionLine)
        assert (listed.motion.motion, listed.motion.composite) == (motion.motion, motion.composite)
        assert tuple(block.node for block in listed.inputs) == unit.inputs
        assert tuple(block.node for block in listed.outputs) == unit.outputs
    # A list without ingredients, or with one twice, is remarked on as in FOON text, and nothing else is.
    lists = [contents.ingredients for node in nodes for contents in node.contents]
    odd = any(len(set(items)) < len(items) or not items for items in lists)
    assert {d.code for d in reader.diagnostics} - {"no-outputs"} == ({"json-value"} if odd else set())


@pytest.mark.parametrize(
    ("text", "places"),
    [
        ("[{U}, {U},\n\n  {U}]", [(1, 2), (1, 93), (3, 3)]),
        ('{"functional_units": [\n{U}\n,\n {U}],\n "source": "v"}', [(2, 1), (4, 2)]),
        ('{"made by": {"functional_units": []}, "functional_units": [{U}]}', [(1, 60)]),
    ],
)
def test_every_unit_knows_its_place(text: str, places: list[tuple[int, int]]) -> None:
    one = unit_text()[1:-1]
    assert len(one) == 89
    found, reader = read(text.replace("{U}", one))
    assert reader.diagnostics == []
    assert [(unit.sources[0].line, unit.sources[0].column) for unit in found] == places


@pytest.mark.parametrize(
    ("value", "videos"),
    [
        ('"v"', ("v",)),
        ('["v", "w"]', ("v", "w")),
        ("[]", ()),
        ("null", ()),
        ('[" ", null, 5, "v"]', ("v",)),
    ],
)
@pytest.mark.parametrize("first", [True, False])
def test_the_source_is_one_video_or_a_list_before_or_behind_the_units(
    value: str, videos: tuple[str, ...], first: bool
) -> None:
    parts = [f'"source": {value}', f'"functional_units": {unit_text()}']
    unit = only("{" + ", ".join(parts if first else parts[::-1]) + "}")
    assert unit.sources[0].videos == videos


# --- objects


@pytest.mark.parametrize(
    ("value", "line", "states"),
    [
        ({"label": " a "}, ObjectLine("a"), ()),
        ({"label": "a", "states": None, "ingredients": None, "container": None}, ObjectLine("a"), ()),
        ({"label": "a", "object_id": "007"}, ObjectLine("a", "007"), ()),
        ({"label": "a", "object_id": "None", "object_in_motion": None}, ObjectLine("a"), ()),
        ({"label": "a", "object_in_motion": "1"}, ObjectLine("a", "", ("1",)), ()),
        (
            {"label": "a", "object_in_motion": 0, "recipe_category": 15},
            ObjectLine("a", "", ("0", "15")),
            (),
        ),
        ({"label": "a", "has_portions": False}, ObjectLine("a"), ()),
        ({"label": "a", "states": ["in [p]"]}, ObjectLine("a"), (StateLine(Relation("in", "p")),)),
        ({"label": "a", "states": ["on"]}, ObjectLine("a"), (StateLine("on"),)),
        (
            {"label": "a", "states": ["coated {c,b}"]},
            ObjectLine("a"),
            (StateLine(Contents("coated", ("b", "c")), "", ("c", "b")),),
        ),
        # a container without a word is one that the object is in
        ({"label": "a", "container": " p "}, ObjectLine("a"), (StateLine(Relation("in", "p")),)),
        (
            {"label": "a", "states": ["under [p]"], "container": "p"},
            ObjectLine("a"),
            (StateLine(Relation("under", "p")),),
        ),
        (
            {"label": "a", "states": ["under [q]"], "container": "p"},
            ObjectLine("a"),
            (StateLine(Relation("under", "q")), StateLine(Relation("in", "p"))),
        ),
        # ingredients are those of the state that says so, or stand behind all states
        (
            {
                "label": "a",
                "states": [{"state_id": 23, "state_label": "contains"}, "hot"],
                "ingredients": ["c", "b"],
            },
            ObjectLine("a"),
            (StateLine(Contents("contains", ("b", "c")), "23", ("c", "b")), StateLine("hot")),
        ),
        (
            {"label": "a", "states": ["hot"], "ingredients": ["c", "", {"label": "b"}, " d "]},
            ObjectLine("a"),
            (StateLine("hot"), StateLine(Contents("contains", ("b", "c", "d")), "", ("c", "b", "d"))),
        ),
        ({"label": "a", "ingredients": ["", " "]}, ObjectLine("a"), ()),
        (
            {"label": "a", "states": [{"label": "in", "related_object": "p", "state_id": "65"}]},
            ObjectLine("a"),
            (StateLine(Relation("in", "p"), "65"),),
        ),
        (
            {"label": "a", "states": [{"state_label": "in", "relative_object": "None"}]},
            ObjectLine("a"),
            (StateLine("in"),),
        ),
    ],
)
def test_what_an_object_says(value: object, line: ObjectLine, states: tuple[StateLine, ...]) -> None:
    (block,) = only(unit_text([value])).inputs
    assert (block.object, block.states) == (line, states)


@pytest.mark.parametrize("none", ["None", "", " ", None])
def test_a_container_that_is_none_is_none(none: str | None) -> None:
    (block,) = only(unit_text([{"label": "a", "container": none}])).inputs
    assert block.node == ObjectNode.of("a")


# --- motions


@pytest.mark.parametrize(
    ("value", "line"),
    [
        ('"mix"', MotionLine("mix")),
        ('" mix* "', MotionLine("mix", "", True)),
        ('"*"', MotionLine("*")),
        ('{"motion_label": "mix"}', MotionLine("mix")),
        ('{"motion_label": "mix", "motion_id": 7}', MotionLine("mix", "7")),
        ('{"motion_label": "mix", "start_time": "0:01"}', MotionLine("mix", "", False, ("0:01",))),
        (
            '{"motion_label": "mix", "start_time": "Assumed", "end_time": "None"}',
            MotionLine("mix", "", False, ("Assumed",)),
        ),
        # numbers are kept as written
        (
            '{"motion_label": "mix", "robot_type": "Human", "weight_success": 0.10}',
            MotionLine("mix", "", False, ("Human", "0.10")),
        ),
        (
            '{"motion_label": "mix", "robot_type": "Human", "weight_success": "0.123456789012345678901"}',
            MotionLine("mix", "", False, ("Human", "0.123456789012345678901")),
        ),
        # an end without a beginning stays an end
        (
            '{"motion_label": "mix", "end_time": "0:05"}',
            MotionLine("mix", "", False, ("Assumed", "0:05")),
        ),
        ('{"motion_label": "mix", "weight_success": null}', MotionLine("mix")),
    ],
)
def test_what_a_motion_says(value: str, line: MotionLine) -> None:
    assert only(unit_text(motion="M").replace('"M"', value)).motion == line


# --- what lines have no place for


@pytest.mark.parametrize(
    ("inputs", "motion", "message"),
    [
        ([{"label": "a", "has_portions": True}], "mix", "has_portions left out"),
        (
            [{"label": "a", "ingredients": [{"label": "b", "states": ["hot"]}]}],
            "mix",
            "states and containers of ingredients left out",
        ),
        (
            None,
            {"motion_label": "mix", "robot_type": "Human"},
            "the robot_type 'Human' has no weight_success",
        ),
        (None, {"motion_label": "mix", "weight_success": 0.5}, "the success rate 0.5 is of no robot_type"),
    ],
)
def test_what_is_left_out_or_assumed_is_said_once(inputs: object, motion: object, message: str) -> None:
    text = unit_text(inputs, motion, inputs)
    (unit,), reader = read(text)
    (warning,) = reader.diagnostics
    assert (warning.severity, warning.code) == (Severity.WARNING, "json-value")
    assert warning.source == unit.sources[0]
    assert warning.message.startswith(message)


@pytest.mark.parametrize("lenient", [False, True])
def test_a_list_of_objects_is_called_one(lenient: bool) -> None:
    found, reader = read('\n[{"label": "a"},\n {"object_label": "b"}]', lenient)
    assert found == []
    assert [(d.severity, d.code, d.source.line, d.source.column) for d in reader.diagnostics] == [
        (Severity.WARNING, "no-motion", 2, 2)
    ]
    assert "2 objects and no motion" in reader.diagnostics[0].message


# --- what is no unit


MOTION_KEYS = "end_time, motion_id, motion_label, robot_type, start_time, weight_success"


@pytest.mark.parametrize(
    ("unit", "message"),
    [
        ("7", "found no functional unit, expected an object with input_nodes, motion_node, output_nodes"),
        ('"mix"', "found no functional unit, expected an object with"),
        ('{"input_nodes": [], "output_nodes": []}', "found no functional unit, expected an object with"),
        (unit_text()[1:-2] + ', "note": 1}', "found the key 'note', expected one of input_nodes, motion_n"),
        (unit_text(7)[1:-1], 'found no list as "input_nodes", expected a list of objects'),
        (unit_text(outputs={})[1:-1], 'found no list as "output_nodes", expected a list of objects'),
        (unit_text(["a"])[1:-1], 'found "a", expected an object {"label"'),
        (unit_text([{"label": ""}])[1:-1], 'found "" as "label", expected a name'),
        (unit_text([{"object_label": None}])[1:-1], 'found null as "object_label", expected a name'),
        (unit_text([{"label": "a", "object_id": -1}])[1:-1], 'found -1 as "object_id", expected a number'),
        (unit_text([{"label": "a", "object_id": 1.5}])[1:-1], 'found 1.5 as "object_id", expected a num'),
        (unit_text([{"label": "a", "object_in_motion": True}])[1:-1], 'found true as "object_in_motion"'),
        (unit_text([{"label": "a", "states": [""]}])[1:-1], 'found the state "": at its column 1, found'),
        (unit_text([{"label": "a", "states": ["in [p]]"]}])[1:-1], 'found the state "in [p]]": at its co'),
        (unit_text(outputs=[{"label": "b", "x": 1}])[1:-1], "found the key 'x', expected one of contain"),
        (unit_text(motion="None")[1:-1], "found a motion without a label, expected a name"),
        (unit_text(motion={"motion_id": 3})[1:-1], "found a motion without a label, expected a name"),
        (unit_text(motion=5)[1:-1], 'found 5 as "motion_label", expected a name'),
        (unit_text(motion={"label": "mix"})[1:-1], f"found the key 'label', expected one of {MOTION_KEYS}"),
        (unit_text(motion={"motion_label": "mix", "start_time": 5})[1:-1], 'found 5 as "start_time", exp'),
    ],
)
@pytest.mark.parametrize("whole", ["[%s,\n  %s, %s]", '{"functional_units": [%s,\n  %s, %s]}'])
def test_a_unit_of_another_form_is_named_in_place(unit: str, message: str, whole: str) -> None:
    text = whole % (unit_text()[1:-1], unit, unit_text()[1:-1])
    found, reader = read(text)
    (error,) = reader.diagnostics
    assert error.severity is Severity.ERROR
    assert error.source == Source("f.json", 2, 3)
    assert error.message.startswith(message)
    assert error.excerpt == text.split("\n")[1]
    assert len(found) == 2
    with pytest.raises(InputError):
        reader.raise_errors()

    found, reader = read(text, lenient=True)
    reader.raise_errors()
    (warning,) = reader.diagnostics
    assert warning == error._replace(severity=Severity.WARNING, message=f"{error.message}; left out")
    assert len(found) == 2


@pytest.mark.parametrize("lenient", [False, True])
def test_a_unit_without_inputs_is_left_out_and_one_without_outputs_kept(lenient: bool) -> None:
    text = "[" + unit_text([])[1:-1] + ",\n" + unit_text(outputs=[])[1:-1] + "]"
    (unit,), reader = read(text, lenient)
    assert (unit.inputs[0].object.label, unit.outputs) == ("a", ())
    assert [(d.severity, d.code, d.source.line, d.source.column) for d in reader.diagnostics] == [
        (Severity.WARNING, "no-inputs", 1, 2),
        (Severity.WARNING, "no-outputs", 2, 1),
    ]


@pytest.mark.parametrize(
    ("text", "line", "column", "message"),
    [
        ("{}", 1, 1, "expected a list, or an object with the key 'functional_units'"),
        ('\n {"units": []}', 1, 1, "expected a list, or an object with the key 'functional_units'"),
        ('{"functional_units": {}}', 1, 22, "expected a list"),
        ('{"functional_units":\n 7}', 2, 2, "expected a list"),
        ('{"functional_units": []\n "source": []}', 2, 2, "expected a comma or }"),
        ('{"functional_units": [],\n}', 2, 1, "expected a key in quotes"),
        ('{["x"]: 1, "functional_units": []}', 1, 2, "expected a key in quotes"),
        (
            '{"source": ["u"], "source": ["v"], "functional_units": []}',
            1,
            19,
            "the key 'source' twice in one",
        ),
        ('{"functional_units": [],\n "functional_units": []}', 2, 2, "the key 'functional_units' twice in"),
        ('{"functional_units" []}', 1, 21, "expected :"),
        ('{"functional_units": []} {}', 1, 26, "expected the end of the file"),
        ("[\n", 2, 1, "Expecting value"),
        ("{", 1, 2, "Expecting value"),
        ("[{'input_nodes': []}]", 1, 3, "double quotes"),
        ('[{"input_nodes": [], "input_nodes": []}]', 1, 2, "found the key 'input_nodes' twice in one object"),
        ('[\n{"x": {"label": "a", "label": "b"}}]', 2, 1, "found the key 'label' twice in one object"),
    ],
)
def test_what_is_no_network_is_located(text: str, line: int, column: int, message: str) -> None:
    ((found_line, found_column, found),) = messages(text)
    assert (found_line, found_column) == (line, column)
    assert message in found


def test_what_stands_before_a_fault_is_read() -> None:
    one = unit_text()[1:-1]
    found, reader = read(f"[{one},\n{one},\n ]")
    assert len(found) == 2
    assert [(d.source.line, d.source.column) for d in reader.diagnostics] == [(2, len(one) + 1)]


@pytest.mark.parametrize("text", ["[]", '{"functional_units": []}', " [ ]\n"])
def test_a_network_may_be_empty(text: str) -> None:
    found, reader = read(text)
    assert (found, reader.diagnostics) == ([], [])


@pytest.mark.parametrize("text", ["[" * 100_000, '{"functional_units": [' + '{"x":' * 100_000])
def test_lists_without_end_are_refused(text: str) -> None:
    ((line, _, message),) = messages(text)
    assert line == 1
    assert "nested too deeply" in message


_json = st.recursive(
    st.none() | st.booleans() | st.integers(-9, 9) | st.sampled_from(["a", "", "in [b]", "None", "contains"]),
    lambda inner: (
        st.lists(inner, max_size=3)
        | st.dictionaries(
            st.sampled_from(
                [
                    "label",
                    "states",
                    "ingredients",
                    "container",
                    "object_id",
                    "object_in_motion",
                    "state_label",
                    "relative_object",
                    "motion_label",
                    "start_time",
                    "robot_type",
                    "weight_success",
                    "x",
                ]
            ),
            inner,
        )
    ),
    max_leaves=6,
)


@pytest.mark.slow
@steady
@given(
    st.lists(st.tuples(st.lists(_json, max_size=2) | _json, _json, st.lists(_json, max_size=2)), max_size=3),
    st.booleans(),
)
def test_any_values_are_read_or_refused_in_place(values: list[tuple[object, ...]], lenient: bool) -> None:
    keys = ("input_nodes", "motion_node", "output_nodes")
    text = json.dumps([dict(zip(keys, value, strict=True)) for value in values], indent=1)
    found, reader = read(text, lenient)
    rows = text.split("\n")
    for diagnostic in reader.diagnostics:
        assert rows[diagnostic.source.line - 1][diagnostic.source.column - 1 :][:1] == "{"
        assert diagnostic.excerpt in {"", rows[diagnostic.source.line - 1]}
    left_out = [d for d in reader.diagnostics if d.code not in {"no-outputs", "json-value"}]
    assert len(found) + len(left_out) == len(values)
    assert lenient <= all(d.severity is Severity.WARNING for d in reader.diagnostics)


@steady
@given(st.text('[]{},:"1a \n', max_size=20) | st.text(max_size=20))
def test_any_text_that_begins_as_json_is_read_or_refused_in_place(text: str) -> None:
    for start in ("[", "{", '{"functional_units":', '{"functional_units": [], '):
        _, reader = read(start + text)
        rows = (start + text).split("\n")
        for diagnostic in reader.diagnostics:
            assert 1 <= diagnostic.source.column <= len(rows[diagnostic.source.line - 1]) + 1


# --- what is mended or left out is said


@pytest.mark.parametrize(
    ("value", "remarks"),
    [
        ({"label": "a", "states": ["contains [egg]"]}, ["[egg] read as contents {egg}"]),
        ({"label": "a", "states": ["on []"]}, ["nothing in []; read as the state 'on'"]),
        ({"label": "a", "states": [{"state_label": "in [pot"}]}, ["[pot is not closed; read as [pot]"]),
        ({"label": "a", "states": ["on []", "hot", "on []"]}, ["nothing in []; read as the state 'on'"]),
        ({"label": "a", "object_in_motion": 2}, ["the motion flag '2' is not 0 or 1"]),
        ({"label": "a", "object_in_motion": "00"}, ["the motion flag '00' is not 0 or 1"]),
        ({"label": "a", "has_portions": True}, ["has_portions left out: FOON text has no place for it"]),
        ({"label": "a", "has_portions": []}, ["has_portions left out: FOON text has no place for it"]),
        ({"label": "a", "has_portions": {}}, ["has_portions left out: FOON text has no place for it"]),
        ({"label": "a", "has_portions": False}, []),
        ({"label": "a", "states": ["in  [pot]", " hot ", "coated {c,b}"]}, []),
        (
            {"label": "a", "ingredients": [{"label": "b", "states": ["raw"]}]},
            ["states and containers of ingredients left out: only their labels count"],
        ),
    ],
)
def test_what_is_mended_or_left_out_is_remarked_on(value: object, remarks: list[str]) -> None:
    _, reader = read(unit_text([value]))
    assert [d.message for d in reader.diagnostics] == remarks
    for diagnostic in reader.diagnostics:
        assert (diagnostic.severity, diagnostic.code) == (Severity.WARNING, "json-value")
        assert diagnostic.source == Source("f.json", 1, 2)


@pytest.mark.parametrize("rate", ["5", "1.01", "-0.5", "1e-2", "NaN", "Infinity", '"high"'])
def test_a_success_rate_that_is_none_is_refused(rate: str) -> None:
    text = unit_text(motion={"motion_label": "mix", "robot_type": "Human", "weight_success": "R"})
    found, reader = read(text.replace('"R"', rate))
    assert found == []
    (error,) = reader.diagnostics
    assert error.severity is Severity.ERROR
    assert error.message == f'found {rate.strip(chr(34))!r} as "weight_success", expected a rate from 0 to 1'


@pytest.mark.parametrize(
    ("value", "message"),
    [
        ({"label": "a", "object_label": "b"}, "found both 'label' and 'object_label', expected one of them"),
        (
            {"label": "a", "states": [], "object_states": []},
            "found both 'states' and 'object_states', expect",
        ),
        (
            {"label": "a", "states": [{"state_label": "in", "related_object": "p", "relative_object": "q"}]},
            "found both 'relative_object' and 'related_object', expected one of them",
        ),
        (
            {"label": "a", "states": [{"state_label": "in [p]", "relative_object": "q"}]},
            "found the related object 'q' besides the one in \"in [p]\"",
        ),
    ],
)
def test_what_is_said_twice_is_refused(value: object, message: str) -> None:
    found, reader = read(unit_text([value]))
    assert found == []
    assert [d.message[: len(message)] for d in reader.diagnostics] == [message]


# --- where JSON is not FOON text


@pytest.mark.parametrize(
    ("inputs", "motion"),
    [
        ([{"label": "a\tb"}], "mix"),
        ([{"label": "a\nb"}], "mix"),
        ([{"label": "a", "container": "p,q"}], "mix"),
        ([{"label": "a", "ingredients": ["x,y"]}], "mix"),
        ([{"label": "a", "states": [{"state_label": "contains", "relative_object": "p"}]}], "mix"),
        ([{"label": "a"}], "a\tb"),
        ([{"label": "a"}], "a]"),
    ],
)
def test_a_name_that_foon_text_cannot_hold_is_read_but_not_written_as_text(
    tmp_path: Path, inputs: object, motion: str
) -> None:
    file = tmp_path / "f.json"
    file.write_text(unit_text(inputs, motion))
    reader = FoonReader()
    network = reader.read_network([file])
    assert (network.motions, reader.diagnostics) == ((motion,), [])
    with pytest.raises(UserError, match="a name that FOON text cannot hold"):
        list(merged_text(network, "from JSON"))


@pytest.mark.parametrize("text", [unit_text([]), unit_text(7)])
def test_units_of_json_that_are_left_out_are_said_and_no_lines_are_counted(text: str) -> None:
    found, reader = read(text, lenient=True)
    assert found == []
    assert [d.message.endswith("; left out") for d in reader.diagnostics] == [True]
    assert reader.left_out == 0  # counts the lines of FOON text


@pytest.mark.parametrize(
    ("inputs", "motion"),
    [
        ([{"label": "a", "recipe_category": 15}], "mix"),
        ([{"label": "a"}], {"motion_label": "mix", "start_time": "1:35]"}),
    ],
)
def test_a_category_or_time_in_doubt_is_remarked_on(inputs: object, motion: object) -> None:
    assert messages(unit_text(inputs, motion))


def test_the_container_of_an_ingredient_is_remarked_on_as_its_states_are() -> None:
    assert messages(unit_text([{"label": "a", "ingredients": [{"label": "b", "container": "c"}]}]))
