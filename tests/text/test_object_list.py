"""Kitchens and goals, in JSON and as FOON text: what entries stand for, where each stands, what is wrong."""

import json
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from foon_asp.network import NetworkBuilder, NodePattern, ObjectNode, Relation, Source
from foon_asp.text.diagnostics import Diagnostic, InputError
from foon_asp.text.line_parser import parse_node
from foon_asp.text.object_list import ListedObject, read_object_list
from tests.text.foon_strategies import nodes, steady


def listed(
    folder: Path, text: str, name: str = "kitchen.json"
) -> tuple[list[ListedObject], list[Diagnostic]]:
    """Read a list; the warnings come along."""
    file = folder / name
    file.write_text(text, "utf-8", newline="")
    warnings: list[Diagnostic] = []
    return read_object_list(file, warnings), warnings


def blocks(folder: Path, text: str) -> tuple[list[ListedObject], list[Diagnostic]]:
    return listed(folder, text, "kitchen.txt")


def patterns(folder: Path, *entries: object) -> list[NodePattern]:
    return [entry.pattern for entry in listed(folder, json.dumps(entries))[0]]


def errors(folder: Path, text: str, name: str = "kitchen.json") -> tuple[Diagnostic, ...]:
    with pytest.raises(InputError) as caught:
        listed(folder, text, name)
    return caught.value.diagnostics


# --- in JSON; what an object says, rightly or wrongly, is in test_json_units.py


def test_an_entry_says_label_states_relations_ingredients_and_container(tmp_path: Path) -> None:
    found = patterns(
        tmp_path,
        {"label": "onion", "states": ["chopped", "raw"], "ingredients": [], "container": "bowl"},
        {"label": "bowl", "states": [], "ingredients": ["salt", "oil", "salt"], "container": None},
        {"label": "stove", "states": ["on", "under [pan]"]},
        {"label": "a", "states": ["in [b]"], "container": "b"},
        {"label": "a\tb[", "ingredients": ["x,y", "z}"], "container": "p]"},
    )
    assert found == [
        NodePattern("onion", frozenset({"chopped", "raw"}), (), "bowl"),
        NodePattern("bowl", frozenset(), ("oil", "salt", "salt")),
        NodePattern("stove", frozenset({"on"}), relations=frozenset({Relation("under", "pan")})),
        NodePattern("a", container="b", relations=frozenset({Relation("in", "b")})),
        NodePattern("a\tb[", frozenset(), ("x,y", "z}"), "p]"),
    ]
    assert str(found[2]._replace(ingredients=("i", "j"), container="b")) == (
        "stove; on; under [pan]; container [b]; contains {i,j}"
    )


@pytest.mark.parametrize("end", ["\n", "\r\n"])
@pytest.mark.parametrize("start", ["", "\N{BYTE ORDER MARK}"])
def test_every_entry_knows_its_line_and_column(tmp_path: Path, start: str, end: str) -> None:
    text = (
        '[{"label": "a\u2028\x85"}, {"label": "🍠 b"},  {"label": "c"},\n'
        "\n"
        '\t{\n   "label": "d",\n "states": []},{"label": "e"}\n'
        '  , {"label": "f"} ]\n'
    )
    found, _ = listed(tmp_path, start + text.replace("\n", end))
    file = str(tmp_path / "kitchen.json")
    places = [(1, 2), (1, 20), (1, 39), (3, 2), (5, 16), (6, 5)]
    assert [entry.source for entry in found] == [Source(file, *place) for place in places]
    assert listed(tmp_path, f" {end}[ ]{end} ") == ([], [])


@pytest.mark.parametrize(
    ("entry", "message"),
    [
        ('"onion; in [bowl"', "found \"onion; in [bowl\": at its column 11, found '[bowl', expected"),
        ('{"node": "onion", "label": "onion"}', 'found "onion", expected a node as in an answer'),
    ],
)
def test_a_node_of_another_form_is_named_in_place(tmp_path: Path, entry: str, message: str) -> None:
    (error,) = errors(tmp_path, f'[{{"label": "ok"}},\r\n  {entry}]\r\n')
    assert error.source == Source(str(tmp_path / "kitchen.json"), 2, 3)
    assert error.message.startswith(message)


def test_all_entries_of_another_form_are_told(tmp_path: Path) -> None:
    found = errors(tmp_path, '[7,\n {"label": "a"}, {"label": 0},\n {"x": 1}]')
    assert [(error.source.line, error.source.column) for error in found] == [(1, 2), (2, 18), (3, 2)]


@pytest.mark.parametrize(
    ("text", "line", "column", "message"),
    [
        ("\n\n  ", 3, 3, "expected a list, [ ... ]"),
        ('{"label": "a"}', 1, 1, "expected a list, [ ... ]"),
        ("[", 1, 2, "Expecting value"),
        ('[{"label": "a"}', 1, 16, "expected a comma or ]"),
        ('[{"label": "a"}\n {"label": "b"}]', 2, 2, "expected a comma or ]"),
        ('[{"label": "a"},\n]', 1, 16, "found a comma before ], expected none"),
        ("[,]", 1, 2, "found a comma before ], expected none"),
        ('[{"label": "a"},,2]', 1, 17, "Expecting value"),
        ('[{"a": "[,]",\n\n}]', 1, 13, "found a comma before }, expected none"),
        ('["a\n', 1, 4, "Invalid control character at"),
        ('[{"label": "a",}]', 1, 15, "found a comma before }, expected none"),
        ('[{"label": "a", "states": ["x", ]}]', 1, 31, "found a comma before ], expected none"),
        ('[\r\n{"label" "a"}]', 2, 10, "Expecting ':' delimiter"),
        ("[{'label': 'a'}]", 1, 3, "double quotes"),
        ('[{"label": "a}]', 1, 12, "Unterminated string"),
        ('[{"label": "a"}]\n// note', 2, 1, "expected the end of the file after the list"),
        ("[" * 100_000, 1, 1, "nested too deeply"),
        ('[{"label": "a"},\n {"label": ' + "1" * 5000 + "}]", 2, 2, "found 111111111"),
        # what stands around JSON
        ('```json\n[{"label": "a"}]\n```\n', 1, 1, "found a code fence around JSON, expected JSON alone"),
        ('Here it is:\n\n[{"label": "a"}]', 1, 1, "found the text 'Here it is:' before JSON"),
        ('[{"label": "a"}]\nThat is all!', 2, 1, "found 'That is all!', expected the end of the file"),
        ('[{"label": "a"}]\n```', 2, 1, "found '```', expected the end of the file"),
    ],
)
def test_broken_json_is_located(tmp_path: Path, text: str, line: int, column: int, message: str) -> None:
    (error,) = errors(tmp_path, text)
    assert error.source == Source(str(tmp_path / "kitchen.json"), line, column)
    assert message in error.message
    assert "sys." not in error.message  # advice for a programmer
    assert error.excerpt == text.replace("\r\n", "\n").split("\n")[line - 1]
    if text[0] in "`H":  # known by what is in it
        assert [d[:3] for d in errors(tmp_path, text, "kitchen.txt")] == [error[:3]]


def test_json_is_known_by_its_name_or_its_first_letter(tmp_path: Path) -> None:
    entries, _ = blocks(tmp_path, '\n [{"label": "a"}]')
    assert [(str(e.pattern), e.source.line, e.source.column) for e in entries] == [("a", 2, 3)]
    for name, text in (("kitchen.json", "O\ta\n"), ("kitchen.txt", '{"label": "a"}')):
        assert "expected a list" in errors(tmp_path, text, name)[0].message


@steady
@given(st.text(max_size=30) | st.text('[]{},:"label \n7', max_size=30))
def test_any_text_is_read_or_refused_in_place(tmp_path_factory: pytest.TempPathFactory, text: str) -> None:
    try:
        listed(tmp_path_factory.getbasetemp(), text)
    except InputError as error:
        for diagnostic in error.diagnostics:
            line = text.removeprefix("\ufeff").split("\n")[diagnostic.source.line - 1]
            assert 1 <= diagnostic.source.column <= len(line) + 1


# --- the same as FOON text


@pytest.mark.parametrize("name", ["kitchen.txt", "goals", "kitchen.foon"])
@pytest.mark.parametrize("end", ["\n", "\r\n"])
@pytest.mark.parametrize("start", ["", "\N{BYTE ORDER MARK}"])
def test_object_blocks_are_entries(tmp_path: Path, name: str, end: str, start: str) -> None:
    text = (
        "# what is there\n//\nO5\tegg\t0\t15\nS\twhole\nS65\tin\t[bowl]\n//\n\n"
        "O\tbowl\nS\tcontains\t{b,a}\nS\tcoated\t{c}\nO\tsalt\t1"
    )
    entries, warnings = listed(tmp_path, start + text.replace("\n", end), name)
    assert [entry.pattern for entry in entries] == [
        NodePattern("egg", frozenset({"whole"}), relations=frozenset({Relation("in", "bowl")})),
        NodePattern.of(ObjectNode.of("bowl", [], [], [("contains", ["a", "b"]), ("coated", ["c"])])),
        NodePattern("salt"),
    ]
    assert [entry.source for entry in entries] == [Source(str(tmp_path / name), line) for line in (3, 8, 11)]
    assert warnings == []


@pytest.mark.parametrize("text", ["", "# nothing\n", "//\n//\n"])
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
    ("text", "places"),
    [
        ("O\ta\nS\tin\t[b]]\nx\n", [("syntax", 2, 9), ("syntax", 3, 1)]),
        ("O\tb\n//\nS\tx\nO\ta\n", [("state-without-object", 3, 1)]),
        ("O\ta\nM mix", [("motion-in-list", 2, 1)]),
        # objects are not needed for a motion to be one too many
        ("M\tmix\nO\tb\n//\n", [("motion-in-list", 1, 1)]),
        (
            "O\ta\nM\tmix\nM\tcut\nO\tb\n//\nM\tmix\n",
            [("motion-in-list", 2, 1), ("motion-in-list", 3, 1), ("motion-in-list", 6, 1)],
        ),
    ],
)
def test_what_is_no_list_of_objects_is_refused_in_place(
    tmp_path: Path, text: str, places: list[tuple[str, int, int]]
) -> None:
    found = errors(tmp_path, text, "kitchen.txt")
    assert [(d.code, d.source.line, d.source.column) for d in found] == places
    assert [d.excerpt for d in found] == [text.split("\n")[line - 1] for _, line, _ in places]


@pytest.mark.parametrize(
    ("line", "advice"),
    [
        ("onion", "an object is written O, a tab, and onion"),
        ("o onion", "write O, a tab, and onion"),
        ("s5 chopped", "write S5, a tab, and chopped"),
        ("```", "remove this line: a code fence is no part of FOON text"),
    ],
)
def test_a_line_that_begins_with_no_letter_says_what_to_write(tmp_path: Path, line: str, advice: str) -> None:
    assert errors(tmp_path, line, "kitchen.txt")[0].message.endswith(f"; {advice}")


@pytest.mark.parametrize(
    ("state", "line"),
    [
        ("on []", "S\ton\t[]"),
        ("in  [ bowl ]", "S\tin\t[ bowl ]"),
        ("in[bowl", "S\tin\t[bowl"),
        ("contains [egg]", "S\tcontains\t[egg]"),
        ("coated [b,a]", "S\tcoated\t{b,a}"),
    ],
)
def test_a_state_says_the_same_in_json_and_in_foon_text(tmp_path: Path, state: str, line: str) -> None:
    (by_json,) = patterns(tmp_path, {"label": "a", "states": [state]})
    ((by_text, *_),), _ = blocks(tmp_path, f"O\ta\n{line}\n")
    assert by_json == by_text


def test_contents_in_a_text_are_by_word_and_those_of_json_are_not(tmp_path: Path) -> None:
    coated = ObjectNode.of("pan", [], [], [("coated", ["oil"])])
    ((pattern, *_),), _ = blocks(tmp_path, "O\tpan\nS\tcontains\t{oil}\n")
    assert not pattern.matches(coated)
    assert patterns(tmp_path, {"label": "pan", "ingredients": ["oil"]})[0].matches(coated)


# --- which nodes an entry stands for

INSIDE = {"states": ["in [b]"]}


@pytest.mark.parametrize(
    ("entry", "node", "matches"),
    [
        # states are exact
        ({}, "a; x", False),
        ({"states": ["x"]}, "a", False),
        ({"states": ["y", "x"]}, "a; x; y", True),
        ({"states": ["x"]}, "a; x; y", False),
        # no container: only nodes that are in or on nothing
        ({}, "a; attached to [b]", False),
        # a container: any relation to that object, by any word
        ({"container": "b"}, "a; on [c]; under [b]", True),
        ({"container": "b"}, "a", False),
        ({"container": "b"}, "a; in [c]", False),
        ({"container": "in"}, "a; in [b]", False),
        ({"container": "b"}, "a; b", False),
        # ingredients: the multiset of everything contained, under whatever word
        ({}, "a; contains {x}", False),
        ({"ingredients": ["x"]}, "a", False),
        ({"ingredients": ["x"]}, "a; contains {x,x}", False),
        ({"ingredients": ["x", "x", "y"]}, "a; contains {y,x}; coated {x}", True),
        ({}, "a; contains {}", True),
        # a relation by word has to be there by word, beside the container's or alone
        (INSIDE, "a; in [b]", True),
        (INSIDE, "a; on [b]", False),
        (INSIDE, "a; in [b]; in [c]", False),
        ({**INSIDE, "container": "b"}, "a; in [b]", True),
        ({**INSIDE, "container": "c"}, "a; in [b]; on [c]", True),
        ({**INSIDE, "container": "c"}, "a; in [b]", False),
        ({**INSIDE, "container": "c"}, "a; on [b]; on [c]", False),
    ],
)
def test_which_nodes_an_entry_stands_for(
    tmp_path: Path, entry: dict[str, object], node: str, matches: bool
) -> None:
    (pattern,) = patterns(tmp_path, {"label": "a", **entry})
    assert pattern.matches(parse_node(node)) is matches
    assert not pattern.matches(parse_node(f"b{node[1:]}"))


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
