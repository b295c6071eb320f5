"""Kitchens and goals in JSON: what entries stand for, where each stands, and what is wrong in place."""

import json
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from foon_asp.errors import UserError
from foon_asp.network import NetworkBuilder, NodePattern, ObjectNode, Relation, Source
from foon_asp.text import Diagnostic, InputError, ListedObject, read_object_list
from tests.text.foon_strategies import nodes, steady


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


@pytest.mark.xfail(strict=True, reason="FOON text reads these as contents, JSON as relations")
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
        ('{"label": "a", "states": [1]}', 'found [1] as "states", expected a list of names'),
        ('{"label": "a", "states": ["x", null]}', 'found ["x", null] as "states", expected a list of names'),
        ('{"label": "a", "states": {"x": 1}}', 'found {"x": 1} as "states", expected a list of names'),
        ('{"label": "a", "ingredients": "b"}', 'found "b" as "ingredients", expected a list of names'),
        ('{"label": "a", "ingredients": [["b"]]}', 'found [["b"]] as "ingredients", expected a list of'),
        ('{"label": "a", "container": ["b"]}', 'found ["b"] as "container", expected a name or null'),
        ('{"label": "a", "container": 0}', 'found 0 as "container", expected a name or null'),
        ('{"label": "a", "container": false}', 'found false as "container", expected a name or null'),
        (
            '{"label": "a", "contianer": "b"}',
            "found the key 'contianer', expected one of container, ingredients, label, states",
        ),
        ('{"Label": "a"}', "found the key 'Label', expected one of container, ingredients, label, states"),
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


@pytest.mark.xfail(strict=True, reason="of a key given twice the first value is lost without a word")
def test_a_key_given_twice_is_an_error(tmp_path: Path) -> None:
    (error,) = errors(tmp_path, '[\n{"label": "a", "states": ["x"], "states": ["y"]}]')
    assert (error.source.line, error.source.column) == (2, 1)
    assert "states" in error.message


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
        ('[{"label": "a"},\n]', 2, 1, "Expecting value"),
        ("[,]", 1, 2, "Expecting value"),
        ('[{"label": "a",}]', 1, 16, "double quotes"),
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


@pytest.mark.xfail(
    strict=True, reason="says 'not JSON' of what is JSON, only not a list, and not what was found"
)
@pytest.mark.parametrize("text", ['{"label": "a"}', '"onion"', "7"])
def test_json_that_is_no_list_is_not_called_no_json(tmp_path: Path, text: str) -> None:
    (error,) = errors(tmp_path, text)
    assert "not JSON" not in error.message
    assert error.message.startswith("found ")


@pytest.mark.xfail(
    strict=True, reason="the place is the first letter of the file, wherever the number stands"
)
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
