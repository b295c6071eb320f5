"""Kitchens and goals, in JSON and as FOON text: what entries stand for, where each stands, what is wrong."""

import json
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from foon_asp.errors import UserError
from foon_asp.network import NetworkBuilder, NodePattern, ObjectNode, Relation, Source
from foon_asp.text.diagnostics import Diagnostic, InputError, Severity
from foon_asp.text.object_list import ListedObject, read_object_list
from foon_asp.text.writer import write_node
from tests.text.foon_strategies import nodes, steady

KEYS = (
    "container, has_portions, ingredients, label, object_id, object_in_motion, object_label, "
    "object_states, recipe_category, states"
)


def listed(tmp_path: Path, text: str) -> list[ListedObject]:
    file = tmp_path / "kitchen.json"
    file.write_text(text, "utf-8", newline="")
    return read_object_list(file)


def patterns(tmp_path: Path, *entries: object) -> list[NodePattern]:
    return [entry.pattern for entry in listed(tmp_path, json.dumps(entries))]


def errors(tmp_path: Path, text: str) -> tuple[Diagnostic, ...]:
    with pytest.raises(InputError) as caught:
        listed(tmp_path, text)
    return caught.value.diagnostics


def outcome(tmp_path: Path, text: str) -> tuple[list[ListedObject], tuple[Diagnostic, ...]]:
    """Give the entries, or else what is wrong."""
    try:
        return listed(tmp_path, text), ()
    except InputError as error:
        return [], error.diagnostics


# --- what entries say


def test_an_entry_says_label_states_ingredients_and_container(tmp_path: Path) -> None:
    assert patterns(
        tmp_path,
        {"label": "onion", "states": ["chopped", "raw"], "ingredients": [], "container": "bowl"},
        {"label": "bowl", "states": [], "ingredients": ["salt", "oil", "salt"], "container": None},
    ) == [
        NodePattern("onion", frozenset({"chopped", "raw"}), (), "bowl"),
        NodePattern("bowl", frozenset(), ("oil", "salt", "salt")),
    ]


def test_what_is_missing_or_null_is_none(tmp_path: Path) -> None:
    plain = NodePattern("onion")
    assert plain.container is None
    assert (
        patterns(
            tmp_path,
            {"label": "onion"},
            {"label": "onion", "container": None},
            {"label": "onion", "states": None, "ingredients": None},
            {"container": "", "ingredients": [], "states": [], "label": "onion"},
        )
        == [plain] * 4
    )


def test_spaces_around_names_are_left_out(tmp_path: Path) -> None:
    entry = {"label": " onion", "states": ["raw "], "ingredients": [" a"], "container": " bowl "}
    assert patterns(tmp_path, entry) == [NodePattern("onion", frozenset({"raw"}), ("a",), "bowl")]


def test_a_relation_written_as_a_state_is_a_relation(tmp_path: Path) -> None:
    (pattern,) = patterns(tmp_path, {"label": "stove", "states": ["on", "under [frying pan]"]})
    assert pattern == NodePattern(
        "stove", frozenset({"on"}), relations=frozenset({Relation("under", "frying pan")})
    )
    assert pattern.matches(ObjectNode.of("stove", ["on"], [("under", "frying pan")]))
    assert not pattern.matches(ObjectNode.of("stove", ["on"]))
    assert not pattern.matches(ObjectNode.of("stove", ["on"], [("in", "frying pan")]))
    assert not pattern.matches(ObjectNode.of("stove", ["on"], [("under", "frying pan"), ("in", "kitchen")]))


def test_an_empty_list_has_no_entries(tmp_path: Path) -> None:
    assert listed(tmp_path, "[]") == []
    assert listed(tmp_path, " \r\n[ ]\n ") == []


def test_a_blank_container_is_none_as_an_empty_one_is(tmp_path: Path) -> None:
    assert patterns(tmp_path, {"label": "a", "container": "  "}) == patterns(tmp_path, {"label": "a"})


def test_only_what_foon_text_leaves_out_is_left_out(tmp_path: Path) -> None:
    (pattern,) = patterns(tmp_path, {"label": "onion\xa0"})
    assert pattern.matches(ObjectNode.of("onion\xa0"))


@pytest.mark.parametrize(
    ("state", "node"),
    [
        ("contains [egg]", ObjectNode.of("pan", [], [], [("contains", ["egg"])])),
        ("coated [oil,salt]", ObjectNode.of("pan", [], [], [("coated", ["oil", "salt"])])),
    ],
)
def test_contents_in_square_brackets_mean_what_they_mean_in_foon_text(
    tmp_path: Path, state: str, node: ObjectNode
) -> None:
    (pattern,) = patterns(tmp_path, {"label": "pan", "states": [state]})
    assert pattern.matches(node)


# --- where entries stand


@pytest.mark.parametrize("end", ["\n", "\r\n"])
@pytest.mark.parametrize("start", ["", "\N{BYTE ORDER MARK}"])
def test_every_entry_knows_its_line_and_column(tmp_path: Path, start: str, end: str) -> None:
    text = (
        '[{"label": "a"}, {"label": "🍠 b"},  {"label": "c"},\n'
        "\n"
        '\t{\n   "label": "d",\n "states": []},{"label": "e"}\n'
        '  , {"label": "f"} ]\n'
    )
    found = listed(tmp_path, start + text.replace("\n", end))
    assert [(e.pattern.label, e.source.line, e.source.column) for e in found] == [
        ("a", 1, 2),
        ("🍠 b", 1, 18),
        ("c", 1, 37),
        ("d", 3, 2),
        ("e", 5, 16),
        ("f", 6, 5),
    ]
    assert {e.source.file for e in found} == {str(tmp_path / "kitchen.json")}


def test_only_line_feeds_count_lines(tmp_path: Path) -> None:
    found = listed(tmp_path, '[{"label": "a\u2028\x85b"},\n{"label": "c"}]')
    assert [entry.source.line for entry in found] == [1, 2]


# --- entries of another form


@pytest.mark.parametrize(
    ("entry", "message"),
    [
        ("7", 'found 7, expected an object {"label": ..., "states": [...]}'),
        ('"onion"', 'found "onion", expected an object'),
        ("null", "found null, expected an object"),
        ('["onion"]', 'found ["onion"], expected an object'),
        ("NaN", "found NaN, expected an object"),
        ("{}", 'found null as "label", expected a name'),
        ('{"states": ["raw"]}', 'found null as "label", expected a name'),
        ('{"label": ""}', 'found "" as "label", expected a name'),
        ('{"label": " "}', 'found " " as "label", expected a name'),
        ('{"label": 7}', 'found 7 as "label", expected a name'),
        ('{"label": ["a"]}', 'found ["a"] as "label", expected a name'),
        ('{"label": "a", "states": "raw"}', 'found "raw" as "states", expected a list of names'),
        ('{"label": "a", "states": [1]}', 'found 1 as "states", expected a name'),
        ('{"label": "a", "states": ["x", null]}', 'found null as "states", expected a name'),
        (
            '{"label": "a", "states": ["in [b]]"]}',
            "found the state \"in [b]]\": at its column 7, found ']', ex",
        ),
        ('{"label": "a", "states": [{"state": "x"}]}', "found the key 'state', expected one of label, rel"),
        ('{"label": "a", "states": [{"state_id": 3}]}', 'found null as "state_label", expected a name'),
        ('{"label": "a", "object_id": "x"}', 'found "x" as "object_id", expected a number'),
        ('{"label": "a", "states": {"x": "y"}}', 'found {"x": "y"} as "states", expected a list of names'),
        ('{"label": "a", "ingredients": "b"}', 'found "b" as "ingredients", expected a list of names'),
        ('{"label": "a", "ingredients": [["b"]]}', 'found ["b"] as "ingredients", expected a name'),
        ('{"label": "a", "container": ["b"]}', 'found ["b"] as "container", expected a name or null'),
        ('{"label": "a", "container": 0}', 'found 0 as "container", expected a name or null'),
        ('{"label": "a", "container": false}', 'found false as "container", expected a name or null'),
        ('{"label": "a", "contianer": "b"}', f"found the key 'contianer', expected one of {KEYS}"),
        ('{"Label": "a"}', f"found the key 'Label', expected one of {KEYS}"),
    ],
)
def test_an_entry_of_another_form_is_named_in_place(tmp_path: Path, entry: str, message: str) -> None:
    (error,) = errors(tmp_path, f'[{{"label": "ok"}},\r\n  {entry}]\r\n')
    assert error.source == Source(str(tmp_path / "kitchen.json"), 2, 3)
    assert error.message.startswith(message)
    assert error.excerpt == f"  {entry}]"


def test_all_entries_of_another_form_are_told(tmp_path: Path) -> None:
    found = errors(tmp_path, '[7,\n {"label": "a"}, {"label": 0},\n {"x": 1}]')
    assert [(error.source.line, error.source.column) for error in found] == [(1, 2), (2, 18), (3, 2)]


@pytest.mark.parametrize("value", ['""', "0", "false", "{}", "0.0"])
@pytest.mark.parametrize("key", ["states", "ingredients"])
def test_a_value_of_another_type_is_an_error_even_if_empty(tmp_path: Path, key: str, value: str) -> None:
    (error,) = errors(tmp_path, f'[{{"label": "a", "{key}": {value}}}]')
    assert f'as "{key}", expected a list of names' in error.message


def test_a_key_given_twice_is_an_error(tmp_path: Path) -> None:
    (error,) = errors(tmp_path, '[\n{"label": "a", "states": ["x"], "states": ["y"]}]')
    assert (error.source.line, error.source.column) == (2, 1)
    assert error.message == "found the key 'states' twice in one object"


# --- not a JSON list at all


@pytest.mark.parametrize(
    ("text", "line", "column", "message"),
    [
        ("", 1, 1, "expected a list, [ ... ]"),
        ("\n\n  ", 3, 3, "expected a list, [ ... ]"),
        ('{"label": "a"}', 1, 1, "expected a list, [ ... ]"),
        ("O\tonion\n", 1, 1, "expected a list, [ ... ]"),
        ('\n "onion"', 2, 2, "expected a list, [ ... ]"),
        ("[", 1, 2, "Expecting value"),
        ('[{"label": "a"}', 1, 16, "expected a comma or ]"),
        ('[{"label": "a"}\n {"label": "b"}]', 2, 2, "expected a comma or ]"),
        ('[{"label": "a"},\n]', 1, 16, "found a comma before ], expected none"),
        ("[,]", 1, 2, "found a comma before ], expected none"),
        ('[{"label": "a",}]', 1, 15, "found a comma before }, expected none"),
        ('[\r\n{"label" "a"}]', 2, 10, "Expecting ':' delimiter"),
        ("[{'label': 'a'}]", 1, 3, "double quotes"),
        ('[{"label": "a}]', 1, 12, "Unterminated string"),
        ('[{"label": "a"}] []', 1, 18, "expected the end of the file after the list"),
        ('[{"label": "a"}]\n// note', 2, 1, "expected the end of the file after the list"),
        ("[]]", 1, 3, "expected the end of the file after the list"),
        ("[\n// note\n]", 2, 1, "Expecting value"),
    ],
)
def test_broken_json_is_located(tmp_path: Path, text: str, line: int, column: int, message: str) -> None:
    (error,) = errors(tmp_path, text)
    assert error.source == Source(str(tmp_path / "kitchen.json"), line, column)
    assert message in error.message
    assert error.excerpt == text.replace("\r\n", "\n").split("\n")[line - 1]


@pytest.mark.parametrize("text", ["[" * 100_000, '[{"label": ' + "[" * 100_000])
def test_lists_without_end_are_refused(tmp_path: Path, text: str) -> None:
    (error,) = errors(tmp_path, text)
    assert error.source.line == 1


def test_a_number_of_very_many_digits_is_refused(tmp_path: Path) -> None:
    (error,) = errors(tmp_path, '[{"label": ' + "1" * 5000 + "}]")
    assert error.source.line == 1


@pytest.mark.parametrize("text", ['{"label": "a"}', '"onion"', "7"])
def test_json_that_is_no_list_is_not_called_no_json(tmp_path: Path, text: str) -> None:
    (error,) = errors(tmp_path, text)
    assert "not JSON" not in error.message
    assert error.message.startswith("found ")


def test_a_number_of_very_many_digits_is_located(tmp_path: Path) -> None:
    (error,) = errors(tmp_path, '[{"label": "a"},\n {"label": ' + "1" * 5000 + "}]")
    assert error.source.line == 2
    assert "sys." not in error.message  # advice for a programmer


def test_a_file_that_is_not_there_or_not_text_is_refused(tmp_path: Path) -> None:
    with pytest.raises(UserError, match=r"nothing\.json: cannot be read"):
        read_object_list(tmp_path / "nothing.json")
    file = tmp_path / "kitchen.json"
    file.write_bytes(b'[\n{"label": "cr\xe8me"}]')
    with pytest.raises(InputError, match=r"kitchen\.json:2:14: error: found the byte 0xe8"):
        read_object_list(file)


@steady
@given(st.text(max_size=30) | st.text('[]{},:"label \n7', max_size=30))
def test_any_text_is_read_or_refused_in_place(tmp_path_factory: pytest.TempPathFactory, text: str) -> None:
    _, diagnostics = outcome(tmp_path_factory.getbasetemp(), text)
    for diagnostic in diagnostics:
        line = text.removeprefix("\ufeff").split("\n")[diagnostic.source.line - 1]
        assert 1 <= diagnostic.source.column <= len(line) + 1


_json = st.recursive(
    st.none() | st.booleans() | st.integers(-9, 9) | st.sampled_from(["a", "", "in [b]"]),
    lambda inner: (
        st.lists(inner, max_size=3)
        | st.dictionaries(st.sampled_from(["label", "states", "ingredients", "container", "x"]), inner)
    ),
    max_leaves=8,
)


@steady
@given(_json)
def test_any_json_is_read_or_refused_in_place(
    tmp_path_factory: pytest.TempPathFactory, value: object
) -> None:
    entries, diagnostics = outcome(tmp_path_factory.getbasetemp(), json.dumps(value, indent=1))
    assert diagnostics or (isinstance(value, list) and len(entries) == len(value))


# --- the same as FOON text


def blocks(
    tmp_path: Path, text: str, name: str = "kitchen.txt"
) -> tuple[list[ListedObject], list[Diagnostic]]:
    """Read object blocks; the warnings come along."""
    file = tmp_path / name
    file.write_text(text, "utf-8", newline="")
    warnings: list[Diagnostic] = []
    return read_object_list(file, warnings), warnings


@pytest.mark.parametrize("name", ["kitchen.txt", "goals", "kitchen.foon"])
@pytest.mark.parametrize("end", ["\n", "\r\n"])
@pytest.mark.parametrize("start", ["", "\N{BYTE ORDER MARK}"])
def test_object_blocks_are_entries(tmp_path: Path, name: str, end: str, start: str) -> None:
    text = (
        "# what is there\n//\nO5\tegg\t0\t15\nS\twhole\nS65\tin\t[bowl]\n//\n\n"
        "O\tbowl\nS\tcontains\t{b,a}\nS\tcoated\t{c}\nO\tsalt\t1"
    )
    entries, warnings = blocks(tmp_path, start + text.replace("\n", end), name)
    assert [entry.pattern for entry in entries] == [
        NodePattern("egg", frozenset({"whole"}), relations=frozenset({Relation("in", "bowl")})),
        NodePattern("bowl", ingredients=("a", "b", "c")),
        NodePattern("salt"),
    ]
    assert [entry.source for entry in entries] == [Source(str(tmp_path / name), line) for line in (3, 8, 11)]
    assert warnings == []


def test_a_relation_in_a_text_is_by_word(tmp_path: Path) -> None:
    ((pattern, _),), _ = blocks(tmp_path, "O\ta\nS\tin\t[b]\n")
    assert pattern.matches(ObjectNode.of("a", [], [("in", "b")]))
    assert not pattern.matches(ObjectNode.of("a", [], [("on", "b")]))


@pytest.mark.parametrize("text", ["", "\n", "# nothing\n", "//\n//\n"])
def test_a_text_without_objects_has_no_entries(tmp_path: Path, text: str) -> None:
    assert blocks(tmp_path, text) == ([], [])


def test_dirt_in_a_list_of_objects_is_remarked_on(tmp_path: Path) -> None:
    entries, warnings = blocks(tmp_path, "O egg\nS\tin [bowl]\n")
    assert [str(entry.pattern) for entry in entries] == ["egg; in [bowl]"]
    assert [(d.code, d.source.line, d.source.column, d.fix) for d in warnings] == [
        ("space-for-tab", 1, 2, "O\tegg"),
        ("space-for-tab", 2, 5, "S\tin\t[bowl]"),
    ]


@pytest.mark.parametrize(
    ("text", "place"),
    [
        ("O\ta\nx\nO\tb\n", ("syntax", 2, 1)),
        ("O\ta\nS\tin\t[b]]\n", ("syntax", 2, 9)),
        ("O\tb\n//\nS\tx\nO\ta\n", ("state-without-object", 3, 1)),
        ("O\tb\n//\nO\ta\nM\tmix\nO\tb\n//\n", ("motion-in-list", 4, 1)),
        ("O\ta\nM\tmix", ("motion-in-list", 2, 1)),
        # objects are not needed for a motion to be one too many
        ("M\tmix\nO\tb\n//\n", ("motion-in-list", 1, 1)),
        # the line is shown as it stands in the file
        ("O\ta\nM mix\nO\tb\n//\n", ("motion-in-list", 2, 1)),
    ],
)
def test_what_is_no_list_of_objects_is_refused_in_place(
    tmp_path: Path, text: str, place: tuple[str, int, int]
) -> None:
    with pytest.raises(InputError) as caught:
        blocks(tmp_path, text)
    (error,) = caught.value.diagnostics
    assert (error.code, error.source.line, error.source.column) == place
    assert error.excerpt == text.split("\n")[place[1] - 1]


def test_every_motion_in_a_list_of_objects_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError) as caught:
        blocks(tmp_path, "O\ta\nM\tmix\nM\tcut\nO\tb\n//\nM\tmix\n")
    assert [(d.code, d.source.line, d.excerpt) for d in caught.value.diagnostics] == [
        ("motion-in-list", 2, "M\tmix"),
        ("motion-in-list", 3, "M\tcut"),
        ("motion-in-list", 6, "M\tmix"),
    ]


def test_json_is_known_by_its_name_or_its_first_letter(tmp_path: Path) -> None:
    entries, _ = blocks(tmp_path, '\n [{"label": "a"}]')
    assert [(str(e.pattern), e.source.line, e.source.column) for e in entries] == [("a", 2, 3)]
    with pytest.raises(InputError, match=r"kitchen\.json:1:1: error: .*expected a list"):
        blocks(tmp_path, "O\ta\n", "kitchen.json")
    with pytest.raises(InputError, match=r"kitchen\.txt:1:1: error: .*expected a list"):
        blocks(tmp_path, '{"label": "a"}')


@steady
@given(st.lists(nodes(), max_size=4))
def test_a_written_node_is_an_entry_that_stands_for_it(
    tmp_path_factory: pytest.TempPathFactory, some: list[ObjectNode]
) -> None:
    entries, warnings = blocks(tmp_path_factory.getbasetemp(), "".join(map(write_node, some)))
    assert [entry.pattern.label for entry in entries] == [node.label for node in some]
    assert all(entry.pattern.matches(node) for entry, node in zip(entries, some, strict=True))
    assert {d.code for d in warnings} <= {"repeated-ingredient", "empty-ingredient"}


# --- states and names in either form of JSON


@pytest.mark.parametrize(
    ("state", "line"),
    [
        ("whole", "S\twhole"),
        ("on", "S\ton"),
        ("on []", "S\ton\t[]"),
        ("in [bowl]", "S\tin\t[bowl]"),
        ("in  [ bowl ]", "S\tin\t[ bowl ]"),
        ("contains [egg]", "S\tcontains\t[egg]"),
        ("coated {b,a}", "S\tcoated\t{b,a}"),
    ],
)
def test_a_state_says_the_same_in_json_and_in_foon_text(tmp_path: Path, state: str, line: str) -> None:
    (by_json,) = patterns(tmp_path, {"label": "a", "states": [state]})
    ((by_text, _),), _ = blocks(tmp_path, f"O\ta\n{line}\n")
    assert by_json == by_text


def test_an_entry_may_have_the_names_of_the_other_form(tmp_path: Path) -> None:
    assert patterns(
        tmp_path,
        {
            "object_id": 5,
            "object_label": "egg",
            "object_states": [
                {"state_id": 1, "state_label": "whole", "relative_object": None},
                {"state_id": 65, "state_label": "in", "relative_object": "bowl"},
                {"label": "on", "related_object": "None"},
                {"state_label": "contains"},
            ],
            "ingredients": [{"label": "b", "states": []}, "a"],
            "object_in_motion": 1,
        },
    ) == [
        NodePattern(
            "egg", frozenset({"whole", "on"}), ("a", "b"), relations=frozenset({Relation("in", "bowl")})
        )
    ]


@pytest.mark.parametrize("none", ["None", "", "  ", None])
def test_a_container_that_is_none_is_none(tmp_path: Path, none: str | None) -> None:
    assert patterns(tmp_path, {"label": "a", "container": none}) == [NodePattern("a")]


def test_a_value_is_shown_as_it_stands(tmp_path: Path) -> None:
    (error,) = errors(tmp_path, '[{"label": "a", "states": {"x": 1}}]')
    assert error.message.startswith('found {"x": 1} as "states"')


@pytest.mark.parametrize(
    ("entry", "pattern"),
    [
        ({"label": "a\tb"}, NodePattern("a\tb")),
        ({"label": "a[b"}, NodePattern("a[b")),
        ({"label": "a", "ingredients": ["x,y", "z}"]}, NodePattern("a", ingredients=("x,y", "z}"))),
        ({"label": "a", "container": "p]"}, NodePattern("a", container="p]")),
        (
            {"label": "a", "states": [{"state_label": "in", "relative_object": "p,q"}]},
            NodePattern("a", relations=frozenset({Relation("in", "p,q")})),
        ),
    ],
)
def test_names_in_json_may_hold_what_ends_a_name_in_foon_text(
    tmp_path: Path, entry: object, pattern: NodePattern
) -> None:
    assert patterns(tmp_path, entry) == [pattern]


@pytest.mark.parametrize(("state", "column"), [("[pot]", 1), ("in  [pot] x", 10), ("in[pot] x", 8)])
def test_a_state_at_fault_is_located_in_itself(tmp_path: Path, state: str, column: int) -> None:
    (error,) = errors(tmp_path, json.dumps([{"label": "a", "states": [state]}]))
    assert f"at its column {column}, " in error.message


@pytest.mark.parametrize(
    ("entry", "message"),
    [
        ({"label": "a", "object_label": "b"}, "found both 'label' and 'object_label', expected one of them"),
        (
            {"label": "a", "states": [{"state_label": "in [p]", "relative_object": "q"}]},
            "found the related object 'q' besides the one in \"in [p]\"",
        ),
    ],
)
def test_what_an_entry_says_twice_is_refused(tmp_path: Path, entry: object, message: str) -> None:
    (error,) = errors(tmp_path, json.dumps([entry]))
    assert error.message == message


def test_what_an_entry_has_mended_is_a_warning(tmp_path: Path) -> None:
    file = tmp_path / "kitchen.json"
    file.write_text('[{"label": "a"},\n {"label": "b", "states": ["in [p", "hot"], "has_portions": true}]')
    warnings: list[Diagnostic] = []
    entries = read_object_list(file, warnings)
    assert [str(entry.pattern) for entry in entries] == ["a", "b; hot; in [p]"]
    assert [(d.severity, d.code, d.source, d.message) for d in warnings] == [
        (Severity.WARNING, "json-value", Source(str(file), 2, 2), "[p is not closed; read as [p]"),
        (
            Severity.WARNING,
            "json-value",
            Source(str(file), 2, 2),
            "has_portions left out: FOON text has no place for it",
        ),
    ]


# --- which nodes an entry stands for

A = ObjectNode.of("a")
IN_B = ObjectNode.of("a", [], [("in", "b")])


@pytest.mark.parametrize(
    ("pattern", "node", "matches"),
    [
        # label and states are exact
        (NodePattern("a"), A, True),
        (NodePattern("b"), A, False),
        (NodePattern("a", frozenset({"x"})), A, False),
        (NodePattern("a"), ObjectNode.of("a", ["x"]), False),
        (NodePattern("a", frozenset({"y", "x"})), ObjectNode.of("a", ["x", "y"]), True),
        (NodePattern("a", frozenset({"x"})), ObjectNode.of("a", ["x", "y"]), False),
        # no container: only nodes that are in or on nothing
        (NodePattern("a"), IN_B, False),
        (NodePattern("a"), ObjectNode.of("a", [], [("attached to", "b")]), False),
        # a container: any relation to that object, by any word
        (NodePattern("a", container="b"), IN_B, True),
        (NodePattern("a", container="b"), ObjectNode.of("a", [], [("under", "b")]), True),
        (NodePattern("a", container="b"), ObjectNode.of("a", [], [("on", "c"), ("in", "b")]), True),
        (NodePattern("a", container="b"), A, False),
        (NodePattern("a", container="b"), ObjectNode.of("a", [], [("in", "c")]), False),
        (NodePattern("a", container="in"), IN_B, False),
        (NodePattern("a", container="b"), ObjectNode.of("a", ["b"]), False),
        # ingredients: the multiset of everything contained, under whatever word
        (NodePattern("a", ingredients=("x",)), ObjectNode.of("a", [], [], [("contains", ["x"])]), True),
        (NodePattern("a", ingredients=("x",)), ObjectNode.of("a", [], [], [("coated", ["x"])]), True),
        (NodePattern("a"), ObjectNode.of("a", [], [], [("contains", ["x"])]), False),
        (NodePattern("a", ingredients=("x",)), A, False),
        (NodePattern("a", ingredients=("x",)), ObjectNode.of("a", [], [], [("contains", ["x", "x"])]), False),
        (
            NodePattern("a", ingredients=("x", "x", "y")),
            ObjectNode.of("a", [], [], [("contains", ["y", "x"]), ("coated", ["x"])]),
            True,
        ),
        (
            NodePattern("a", ingredients=("x", "y")),
            ObjectNode.of("a", [], [], [("contains", ["y", "x"]), ("coated", ["x"])]),
            False,
        ),
        (NodePattern("a"), ObjectNode.of("a", [], [], [("contains", [])]), True),
        # a relation by word has to be there by word, beside the container's or alone
        (NodePattern("a", relations=frozenset({Relation("in", "b")})), IN_B, True),
        (NodePattern("a", relations=frozenset({Relation("on", "b")})), IN_B, False),
        (NodePattern("a", relations=frozenset({Relation("in", "b")})), A, False),
        (
            NodePattern("a", container="c", relations=frozenset({Relation("in", "b")})),
            ObjectNode.of("a", [], [("in", "b"), ("on", "c")]),
            True,
        ),
        (NodePattern("a", container="c", relations=frozenset({Relation("in", "b")})), IN_B, False),
        (
            NodePattern("a", container="c", relations=frozenset({Relation("in", "b")})),
            ObjectNode.of("a", [], [("on", "b"), ("on", "c")]),
            False,
        ),
    ],
)
def test_which_nodes_an_entry_stands_for(pattern: NodePattern, node: ObjectNode, matches: bool) -> None:
    assert pattern.matches(node) is matches


def test_the_container_may_be_named_among_the_states_too(tmp_path: Path) -> None:
    (pattern,) = patterns(tmp_path, {"label": "a", "states": ["in [b]"], "container": "b"})
    assert pattern.matches(IN_B)


def test_an_entry_is_shown_in_one_line() -> None:
    assert str(NodePattern("a")) == "a"
    pattern = NodePattern("a", frozenset({"y", "x"}), ("i", "j"), "b", frozenset({Relation("under", "c")}))
    assert str(pattern) == "a; x; y; under [c]; container [b]; contains {i,j}"


@steady
@given(st.lists(nodes(), min_size=1, max_size=5), st.booleans())
def test_a_network_finds_all_nodes_that_an_entry_matches(some: list[ObjectNode], strip: bool) -> None:
    builder = NetworkBuilder()
    # Every node also without its relations, so that there is something to tell apart.
    builder.add("mix", [*some, *(node._replace(relations=frozenset()) for node in some)], [], Source("f", 1))
    network = builder.build()
    for node in some:
        containers = [None, *(relation.object for relation in node.relations)]
        relations = frozenset() if strip else node.relations
        for container in containers:
            pattern = NodePattern(node.label, node.states, node.ingredients, container, relations)
            by_hand = tuple(o for o, other in enumerate(network.objects) if pattern.matches(other))
            assert network.find(pattern) == by_hand
