"""Networks in JSON: both forms, what they mean beside FOON text, odd values, and errors in place."""

import json
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from foon_asp.network import Source
from foon_asp.text.diagnostics import Diagnostic, InputError, Severity
from foon_asp.text.listed_unit import ListedUnit
from foon_asp.text.object_list import read_object_list
from foon_asp.text.reader import FoonReader
from foon_asp.text.writer import write_line
from tests.text.foon_strategies import steady
from tests.text.reading import units_of

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
AS_TEXT = """\
O278\tbowl\t0
S41\tempty
S65\ton\t[table]
O12\tcup\t1
S23\tcontains\t{milk,honey}
M54\tpour*\t0:01\t0:09\tRobot\t0.850
O\tbowl
S\tcontains\t{honey,milk}
//
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
BARE_AS_TEXT = "O\tbowl\nS\tempty\nO\tmilk\nS\tin\t[cup]\nM\tpour\nO\tbowl\nS\tcontains\t{milk}\n//\n"


def read(text: str, lenient: bool = False) -> tuple[list[ListedUnit], FoonReader]:
    reader = FoonReader(lenient)
    return list(reader.listed_units(text, "f.json")), reader


def only(text: str) -> ListedUnit:
    (unit,), reader = read(text)
    assert reader.diagnostics == []
    return unit


def unit_text(inputs: object = None, motion: object = "mix", outputs: object = None) -> str:
    """Return a unit in JSON, ``a`` to ``b`` where nothing else is said."""
    return json.dumps(
        {
            "input_nodes": [{"label": "a"}] if inputs is None else inputs,
            "motion_node": motion,
            "output_nodes": [{"label": "b"}] if outputs is None else outputs,
        }
    )


ONE = unit_text()


def lines(unit: ListedUnit) -> list[str]:
    """Return the lines that a unit would have in FOON text."""
    blocks = [[write_line(b.object), *map(write_line, b.states)] for b in (*unit.inputs, *unit.outputs)]
    blocks.insert(len(unit.inputs), [write_line(unit.motion)])
    return [line for block in blocks for line in block]


def listed(folder: Path, entry: str) -> tuple[list[object], tuple[Diagnostic, ...]]:
    """Read an entry of a kitchen, on line 2 behind another; what is wrong or remarked on comes along."""
    file = folder / "kitchen.json"
    file.write_text(f'[{{"label": "ok"}},\r\n  {entry}]\r\n', newline="")
    warnings: list[Diagnostic] = []
    try:
        found = [entry.pattern for entry in read_object_list(file, warnings)]
    except InputError as error:
        return [], error.diagnostics
    return list(found), tuple(warnings)


# --- the two forms


@pytest.mark.parametrize(("text", "as_text"), [(FULL, AS_TEXT), (BARE, BARE_AS_TEXT)])
@pytest.mark.parametrize("end", ["\n", "\r\n"])
@pytest.mark.parametrize("start", ["", "\N{BYTE ORDER MARK}", "\n \t"])
def test_either_form_is_what_its_lines_are_as_foon_text(
    tmp_path: Path, text: str, as_text: str, end: str, start: str
) -> None:
    unit = only(text)
    assert "\n".join([*lines(unit), "//\n"]) == as_text
    file = tmp_path / "FOON.txt"  # JSON is known by its first letter, whatever the name
    file.write_text((start + text).replace("\n", end), "utf-8", newline="")
    reader = FoonReader()
    (found,) = reader.file_units(file)
    assert units_of([found]) == [unit for unit, _ in reader.tree_units(as_text, "f.txt")]
    videos = ("https://example.org/1", "https://example.org/2") if text == FULL else ()
    place = (4, 9) if text == FULL else (2, 3)
    assert unit.sources == (Source("f.json", *place, videos),)
    assert found.source == Source(str(file), place[0] + start.count("\n"), place[1], videos)
    assert reader.diagnostics == []


@pytest.mark.parametrize(
    ("text", "places"),
    [
        ("[{U}, {U},\n\n  {U}]", [(1, 2), (1, 93), (3, 3)]),
        ('{"functional_units": [\n{U}\n,\n {U}],\n "source": "v"}', [(2, 1), (4, 2)]),
        ('{"made by": {"functional_units": []}, "functional_units": [{U}]}', [(1, 60)]),
        ('{"functional_units": []}', []),
        (" [ ]\n", []),
    ],
)
def test_every_unit_knows_its_place(text: str, places: list[tuple[int, int]]) -> None:
    assert len(ONE) == 89
    found, reader = read(text.replace("{U}", ONE))
    assert reader.diagnostics == []
    assert [(unit.sources[0].line, unit.sources[0].column) for unit in found] == places


@pytest.mark.parametrize(
    ("value", "videos"),
    [('"v"', ("v",)), ('["v", "w"]', ("v", "w")), ("null", ()), ('[" ", null, 5, "v"]', ("v",))],
)
@pytest.mark.parametrize("step", [1, -1])
def test_the_source_is_one_video_or_a_list_before_or_behind_the_units(
    value: str, videos: tuple[str, ...], step: int
) -> None:
    parts = [f'"source": {value}', f'"functional_units": [{ONE}]']
    assert only("{" + ", ".join(parts[::step]) + "}").sources[0].videos == videos


# --- objects: the same in networks and in lists


@pytest.mark.parametrize(
    ("value", "written"),
    [
        ('{"label": " a ", "has_portions": false}', "O\ta"),
        ('{"label": "a", "states": null, "ingredients": null, "container": null}', "O\ta"),
        ('{"label": "a", "object_id": "007", "object_in_motion": "1"}', "O007\ta\t1"),
        ('{"label": "a", "object_id": "None", "object_in_motion": null}', "O\ta"),
        ('{"label": "a", "object_in_motion": 0, "recipe_category": 15}', "O\ta\t0\t15"),
        ('{"label": "a\xa0", "states": ["in  [p]", "on", " hot "]}', "O\ta\xa0|S\tin\t[p]|S\ton|S\thot"),
        ('{"label": "a", "states": ["coated {c,b}"]}', "O\ta|S\tcoated\t{c,b}"),
        # a container without a word is one that the object is in
        ('{"label": "a", "container": " p "}', "O\ta|S\tin\t[p]"),
        ('{"label": "a", "states": ["under [p]"], "container": "p"}', "O\ta|S\tunder\t[p]"),
        ('{"label": "a", "states": ["under [q]"], "container": "p"}', "O\ta|S\tunder\t[q]|S\tin\t[p]"),
        ('{"label": "a", "container": " none "}', "O\ta"),
        ('{"label": "a", "container": " "}', "O\ta"),
        # ingredients are those of the state that says so, or stand behind all states
        (
            '{"label": "a", "states": [{"state_id": 23, "state_label": "contains"}, "hot"], '
            '"ingredients": ["c", "b"]}',
            "O\ta|S23\tcontains\t{c,b}|S\thot",
        ),
        (
            '{"label": "a", "states": ["hot"], "ingredients": ["c", "", {"label": "b"}, " d "]}',
            "O\ta|S\thot|S\tcontains\t{c,b,d}",
        ),
        ('{"label": "a", "ingredients": ["", " "]}', "O\ta"),
        (
            '{"label": "a", "states": [{"label": "in", "related_object": "p", "state_id": "65"}]}',
            "O\ta|S65\tin\t[p]",
        ),
        (
            '{"object_label": "a", "object_states": [{"state_label": "in", "relative_object": "None"}]}',
            "O\ta|S\tin",
        ),
    ],
)
def test_what_an_object_says(tmp_path: Path, value: str, written: str) -> None:
    unit = only("[" + ONE.replace('{"label": "a"}', value) + "]")
    assert "|".join(lines(unit)[:-2]) == written
    (_, pattern), remarks = listed(tmp_path, value)
    assert remarks == ()
    assert pattern.matches(unit.inputs[0].node)  # type: ignore[attr-defined]


OBJECT_KEYS = (
    "amount, container, has_portions, ingredients, label, object_id, object_in_motion, object_label, "
    "object_states, recipe_category, states"
)


@pytest.mark.parametrize(
    ("value", "message"),
    [
        ("7", 'found 7, expected an object {"label": ..., "states": [...]}'),
        ('["onion"]', 'found ["onion"], expected an object'),
        ("NaN", "found NaN, expected an object"),
        ('{"states": ["raw"]}', 'found null as "label", expected a name'),
        ('{"label": " "}', 'found " " as "label", expected a name'),
        ('{"label": ["a"]}', 'found ["a"] as "label", expected a name'),
        ('{"object_label": 3}', 'found 3 as "object_label", expected a name'),
        ('{"label": "a", "object_id": -1}', 'found -1 as "object_id", expected a number'),
        ('{"label": "a", "object_id": 1.5}', 'found 1.5 as "object_id", expected a number'),
        ('{"label": "a", "object_in_motion": true}', 'found true as "object_in_motion"'),
        ('{"label": "a", "states": ""}', 'found "" as "states", expected a list of names'),
        ('{"label": "a", "states": {"x": "y"}}', 'found {"x": "y"} as "states", expected a list of names'),
        ('{"label": "a", "states": ["x", null]}', 'found null as "states", expected a name'),
        ('{"label": "a", "states": [""]}', 'found the state "": at its column 1, found the end of the line'),
        (
            '{"label": "a", "states": ["in [b]]"]}',
            "found the state \"in [b]]\": at its column 7, found ']', ex",
        ),
        ('{"label": "a", "states": ["in  [p] x"]}', 'found the state "in  [p] x": at its column 8, found'),
        ('{"label": "a", "states": [{"state": "x"}]}', "found the key 'state', expected one of label, rel"),
        ('{"label": "a", "states": [{"state_id": 3}]}', 'found null as "state_label", expected a name'),
        ('{"label": "a", "ingredients": 0}', 'found 0 as "ingredients", expected a list of names'),
        ('{"label": "a", "ingredients": [["b"]]}', 'found ["b"] as "ingredients", expected a name'),
        ('{"label": "a", "container": false}', 'found false as "container", expected a name or null'),
        ('{"label": "a", "contianer": "b"}', f"found the key 'contianer', expected one of {OBJECT_KEYS}"),
        ('{"label": "a", "states": ["x"], "states": []}', "found the key 'states' twice in one object"),
        # what is said twice
        (
            '{"label": "a", "object_label": "b"}',
            "found both 'label' and 'object_label', expected one of them",
        ),
        (
            '{"label": "a", "states": [{"label": "in", "related_object": "p", "relative_object": "q"}]}',
            "found both 'relative_object' and 'related_object', expected one of them",
        ),
        (
            '{"label": "a", "states": [{"label": "in [p]", "relative_object": "q"}]}',
            "found the related object 'q' besides the one in \"in [p]\"",
        ),
    ],
)
def test_an_object_of_another_form_is_named_in_place(tmp_path: Path, value: str, message: str) -> None:
    _, (error,) = listed(tmp_path, value)
    assert (error.severity, error.source.line, error.source.column) == (Severity.ERROR, 2, 3)
    assert error.message.startswith(message)
    assert error.excerpt == f"  {value}]"
    message = message.partition(", expected one of")[0]  # an object of a unit may have an amount, too
    found, reader = read("[\n" + ONE.replace('{"label": "b"}', value) + "]")
    assert [d.message.startswith(message) for d in reader.diagnostics] == [True]
    assert (found, reader.diagnostics[0].source.line) == ([], 2)


@pytest.mark.parametrize(
    ("value", "remarks"),
    [
        ('{"label": "a", "states": ["contains [egg]"]}', ["[egg] read as contents {egg}"]),
        ('{"label": "a", "states": ["on []", "hot"]}', ["nothing in []; read as the state 'on'"]),
        ('{"label": "a", "states": [{"state_label": "in [pot"}]}', ["[pot is not closed; read as [pot]"]),
        ('{"label": "a", "has_portions": []}', ["has_portions left out: FOON text has no place for it"]),
        (
            '{"label": "a", "ingredients": [{"label": "b", "container": "c"}]}',
            ["states and containers of ingredients left out: only their labels count"],
        ),
    ],
)
def test_what_is_mended_or_left_out_is_said_once(tmp_path: Path, value: str, remarks: list[str]) -> None:
    _, reader = read("[" + ONE.replace('{"label": "a"}', value).replace('{"label": "b"}', value) + "]")
    _, of_list = listed(tmp_path, value)
    for diagnostics in (reader.diagnostics, of_list):
        assert [d.message for d in diagnostics] == remarks
        assert {(d.severity, d.code) for d in diagnostics} == {(Severity.WARNING, "json-value")}
    assert [(d.source.line, d.source.column) for d in (*reader.diagnostics, *of_list)] == [(1, 2), (2, 3)]


# --- motions


@pytest.mark.parametrize(
    ("value", "line"),
    [
        ('" mix* "', "M\tmix*"),
        ('"*"', "M\t*"),
        ('{"motion_label": "mix", "motion_id": 7, "weight_success": null}', "M7\tmix"),
        ('{"motion_label": "mix", "start_time": "Assumed", "end_time": "None"}', "M\tmix\tAssumed"),
        # numbers are kept as written
        ('{"motion_label": "mix", "robot_type": "Human", "weight_success": 0.10}', "M\tmix\tHuman\t0.10"),
        (
            '{"motion_label": "mix", "robot_type": "Human", "weight_success": "0.123456789012345678901"}',
            "M\tmix\tHuman\t0.123456789012345678901",
        ),
        # an end without a beginning stays an end
        ('{"motion_label": "mix", "end_time": "0:05"}', "M\tmix\tAssumed\t0:05"),
    ],
)
def test_what_a_motion_says(value: str, line: str) -> None:
    unit = only("[" + unit_text(motion="M").replace('"M"', value) + "]")
    assert write_line(unit.motion) == line


@pytest.mark.parametrize(
    ("inputs", "motion", "message"),
    [
        (
            None,
            {"motion_label": "mix", "robot_type": "Human"},
            "the robot_type 'Human' has no weight_success",
        ),
        (None, {"motion_label": "mix", "weight_success": 0.5}, "the success rate 0.5 is of no robot_type"),
        (None, {"motion_label": "mix", "start_time": "1:35]"}, "'1:35]' is not a time"),
        ([{"label": "a", "object_in_motion": "00"}], "mix", "the motion flag '00' is not 0 or 1"),
        ([{"label": "a", "recipe_category": 15}], "mix", ""),
    ],
)
def test_what_is_in_doubt_about_flags_times_and_rates_is_remarked_on(
    inputs: object, motion: object, message: str
) -> None:
    (unit,), reader = read(f"[{unit_text(inputs, motion)}]")
    (warning,) = reader.diagnostics
    assert (warning.severity, warning.code, warning.source) == (
        Severity.WARNING,
        "json-value",
        unit.sources[0],
    )
    assert warning.message.startswith(message)


@pytest.mark.parametrize("rate", ["5", "1.01", "-0.5", "1e-2", "NaN", '"high"'])
def test_a_success_rate_that_is_none_is_refused(rate: str) -> None:
    text = unit_text(motion={"motion_label": "mix", "robot_type": "Human", "weight_success": "R"})
    found, reader = read(f"[{text}]".replace('"R"', rate))
    assert found == []
    (error,) = reader.diagnostics
    assert error.severity is Severity.ERROR
    assert error.message == f'found {rate.strip(chr(34))!r} as "weight_success", expected a rate from 0 to 1'


# --- what is no unit, no network, no JSON


MOTION_KEYS = "end_time, motion_id, motion_label, robot_type, start_time, weight_success"


@pytest.mark.parametrize(
    ("unit", "message"),
    [
        ("7", "found no functional unit, expected an object with input_nodes, motion_node, output_nodes"),
        ('{"input_nodes": [], "output_nodes": []}', "found no functional unit, expected an object with"),
        (ONE[:-1] + ', "note": 1}', "found the key 'note', expected one of input_nodes, motion_n"),
        (unit_text(7), 'found no list as "input_nodes", expected a list of objects'),
        (unit_text(outputs={}), 'found no list as "output_nodes", expected a list of objects'),
        (unit_text(motion="None"), "found a motion without a label, expected a name"),
        (unit_text(motion={"motion_id": 3}), "found a motion without a label, expected a name"),
        (unit_text(motion=5), 'found 5 as "motion_label", expected a name'),
        (unit_text(motion={"label": "mix"}), f"found the key 'label', expected one of {MOTION_KEYS}"),
        (unit_text(motion={"motion_label": "mix", "start_time": 5}), 'found 5 as "start_time", exp'),
    ],
)
@pytest.mark.parametrize("whole", ["[%s,\n  %s, %s]", '{"functional_units": [%s,\n  %s, %s]}'])
def test_a_unit_of_another_form_is_named_in_place(unit: str, message: str, whole: str) -> None:
    text = whole % (ONE, unit, ONE)
    found, reader = read(text)
    (error,) = reader.diagnostics
    assert (error.severity, error.source) == (Severity.ERROR, Source("f.json", 2, 3))
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
    assert reader.left_out == 0  # counts the lines of FOON text


@pytest.mark.parametrize("lenient", [False, True])
def test_units_without_inputs_or_outputs_and_lists_of_objects(lenient: bool) -> None:
    (unit,), reader = read(f"[{unit_text([])},\n{unit_text(outputs=[])}]", lenient)
    assert (unit.inputs[0].object.label, unit.outputs) == ("a", ())
    found, of_list = read('\n[{"label": "a"},\n {"object_label": "b"}]', lenient)
    assert found == []
    assert "2 objects and no motion" in of_list.diagnostics[0].message
    assert [
        (d.severity, d.code, d.source.line, d.source.column)
        for d in (*reader.diagnostics, *of_list.diagnostics)
    ] == [
        (Severity.WARNING, "no-inputs", 1, 2),
        (Severity.WARNING, "no-outputs", 2, 1),
        (Severity.WARNING, "no-motion", 2, 2),
    ]


@pytest.mark.parametrize(
    ("text", "line", "column", "message"),
    [
        ('\n {"units": []}', 1, 1, "expected a list, or an object with the key 'functional_units'"),
        ('{"functional_units":\n 7}', 2, 2, "expected a list"),
        ('{"functional_units": []\n "source": []}', 2, 2, "expected a comma or }"),
        ('{"functional_units": [],\n}', 2, 1, "expected a key in quotes"),
        ('{["x"]: 1, "functional_units": []}', 1, 2, "expected a key in quotes"),
        ('{"source": "u", "source": "v", "functional_units": []}', 1, 17, "the key 'source' twice in one"),
        ('{"functional_units": [],\n "functional_units": []}', 2, 2, "the key 'functional_units' twice in"),
        ('{"functional_units" []}', 1, 21, "expected :"),
        ('{"functional_units": []} {}', 1, 26, "expected the end of the file"),
        ("[\n", 2, 1, "Expecting value"),
        ("{", 1, 2, "Expecting value"),
        ("[{'input_nodes': []}]", 1, 3, "double quotes"),
        ('[\n{"x": {"label": "a", "label": "b"}}]', 2, 1, "found the key 'label' twice in one object"),
        ("[" * 100_000, 1, 1, "nested too deeply"),
        ('{"functional_units": [' + '{"x":' * 100_000, 1, 1, "nested too deeply"),
    ],
)
def test_what_is_no_network_is_located(text: str, line: int, column: int, message: str) -> None:
    (error,) = read(text)[1].diagnostics
    assert (error.source.line, error.source.column) == (line, column)
    assert message in error.message


def test_what_stands_before_a_fault_is_read() -> None:
    found, reader = read(f"[{ONE},\n{ONE},\n ]")
    assert len(found) == 2
    assert [(d.source.line, d.source.column) for d in reader.diagnostics] == [(2, len(ONE) + 1)]


@steady
@given(st.text('[]{},:"1a \n', max_size=20) | st.text(max_size=20))
def test_any_text_that_begins_as_json_is_read_or_refused_in_place(text: str) -> None:
    for start in ("[", "{", '{"functional_units":', '{"functional_units": [], '):
        _, reader = read(start + text)
        rows = (start + text).split("\n")
        for diagnostic in reader.diagnostics:
            assert 1 <= diagnostic.source.column <= len(rows[diagnostic.source.line - 1]) + 1
