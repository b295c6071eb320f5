"""The JSON of every verb: held against its schema, and the schemas against what there is."""

import copy
import json
import re
from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import click
import jsonschema
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from foon_asp.asp import Proof, Status
from foon_asp.cli.verbs import VERBS, verb_command
from foon_asp.document.schema import SCHEMAS, schema, schema_kinds
from foon_asp.network import LEVELS, ObjectNode
from foon_asp.problem import ContainerRule, Objective
from foon_asp.proof.simulation import Verdict
from foon_asp.search import Ending
from foon_asp.text.json_node import node_json, read_node_json
from foon_asp.text.json_value import json_text, read_json, schema_name
from tests.conftest import ROOT, Cli, valid

FORBID = ("--constraint", "forbid_motion", "-c", 'forbidden_motion="crush"')
SOFT = ("--soft", "forbid_motion=3", "-c", 'forbidden_motion="crush"')
# By verb: what is asked of the bundled kitchen, each to give another branch of the document. The first is
# asked by default. What is in capitals is a file.
RULE = ("--rule", ":- use(U), motion(U,M), #count { V : motion(V,M) } = 1.")
ASKED: dict[str, list[tuple[str, ...]]] = {
    "solve": [
        ("--goal", "ice", *SOFT),
        ("--goal", "ice", "--cross-check"),
        ("--goal", "ice", "--goal", "tea", "--objective", "success,inputs", "--containers", "implied"),
        ("--goal", "ice", "--level", "1"),
        ("--goal", "apple pie"),
        ("--goal", "ice", "--objective", "attempts,inputs+ingredients,kitchen"),
        ("--goal", "whipped cream", "--time-limit", "0"),
        ("--goal", "ice", "--items", "used-up"),
    ],
    "optima": [("--goal", "ice"), ("--goal", "tea", "--objective", "kitchen,success", "--level", "2")],
    "search": [("bfs", "--goal", "ice"), ("bfs", "--goal", "macaroni"), ("dfs", "--goal", "apple pie")],
    "compare": [("--goal", "ice"), ("--goal", "apple pie", "--level", "2")],
    "check": [
        ("TORN", "--goal", "ice"),
        ("TREE", "--goal", "tea"),
        ("TREE", "--goal", "ice"),
        ("TORN", "--goal", "ice", "--items", "used-up"),
        ("TREE", "--goal", "ice", "--items", "used-up"),
    ],
    "verify": [("PROOF",), ("FORGED",)],
    "why-not": [("--goal", "apple pie"), ("--goal", "ice", *FORBID)],
    "shopping-list": [("--goal", "apple pie"), ("--goal", "ice")],
    "clash": [
        ("--goal", "ice", *FORBID),
        ("--goal", "ice", "--constraint", "require_motion", "-c", 'required_motion="crush"'),
    ],
    "alternatives": [("--goal", "ice"), ("--goal", "ice", "--different", "2"), ("--goal", "apple pie")],
    "pareto": [("--goal", "ice"), ("--goal", "apple pie")],
    "regret": [("--goal", "ice", "--objective", "success,kitchen"), ("--goal", "apple pie")],
    "sensitivity": [("--goal", "ice"), ("--goal", "apple pie")],
    "menu": [("--goal", "ice", "--goal", "tea"), ("--goal", "ice", "--goal", "apple pie")],
    "assist": [("--goal", "ice", "--reach", "0.9"), ("--goal", "ice"), ("--goal", "apple pie")],
    "diff": [("TREE", "TORN", "--goal", "ice"), ("TREE", "solve --goal ice --containers implied")],
    "export": [
        ("--goal", "ice"),
        ("--goal", "ice", "--objective", "kitchen,success", "--containers", "implied"),
    ],
    "read-plan": [("PLAN", "--map", "MAP")],
    "relax": [("DOMAIN", "PROBLEM")],
    "batch": [("QUESTIONS", "--results", "ROWS")],
    "trace": [
        ("TREE", "--goal", "ice", "--items", "used-up"),
        ("TREE", "--goal", "ice", "--items", "used-up", "--failed", "2"),
        ("TORN", "--goal", "ice"),
    ],
    "schedule": [
        ("TREE", "--durations", "LENGTHS"),
        (
            "BOWLS",
            "--network",
            "BOWLS",
            "--utensils",
            "LABELS",
            "--kitchen",
            "THINGS",
            "--durations",
            "LENGTHS",
        ),
    ],
    "units": [("--unit", "3", "--explain-items"), ("--unit", "3")],
    "view": [
        ("--goal", "ice", "--beside", "alternatives"),
        ("--goal", "ice"),
        ("--goal", "apple pie"),
        ("--goal", "ice", "--beside", "front", *FORBID),
        ("--goal", "ice", "--items", "used-up"),
    ],
    "stats": [()],
    "facts": [("--goal", "ice"), ("--goal", "ice", *SOFT[:2])],
    "constraints": [(), ("--explain", "before", *RULE), ("--explain", "require_motion:required_motion=cut")],
    "lint": [("LINTED",)],
    "diff-network": [("NEARLY", "TWO"), ("TWO", "TWO", "--level", "1")],
}
# Verbs without documents: certificates, pictures, schemas and files have forms of their own.
OTHERS = {
    "certify",
    "completion",
    "draw",
    "encodings",
    "init",
    "schema",
    "shell",
    "fmt",
    "convert",
    "merge",
    "rename",
    "lsp",
    "vocabulary",
    "import",
}
CASES = [
    pytest.param(verb, words, marks=() if not number else pytest.mark.slow, id=f"{verb}-{number}")
    for verb, asked in ASKED.items()
    for number, words in enumerate(asked)
]


@pytest.fixture
def files(cli: Cli, tmp_path: Path) -> dict[str, str]:
    """Give a file for every name in capitals."""
    return {name: str(tmp_path / f"{name}.txt") for name in ("ROWS", *_CONTENTS)}


_UNIT = "O\tice\nS\tcubed\nO\tmuddler\nM\tcrush\nO\tice\nS\tcrushed\n"
_BOWLS = "O\t{0}\nO\tbowl\nM\ttwist\nO\tbowl\nS\tcontains\t{{{0}}}\n//\n"
_CONTENTS = {
    "BOWLS": f"//\n{_BOWLS.format('egg')}{_BOWLS.format('salt')}"
    "O\tbowl\nS\tcontains\t{egg}\nO\tbowl\nS\tcontains\t{salt}\nM\tcrush\nO\tdough\n//\n",
    "THINGS": "//\nO\tegg\n//\nO\tsalt\n//\nO\tbowl\n//\n",
    "LABELS": "bowl\n",
    "TWO": f"//\n{_UNIT}O\tmuddler\nS\twet\n//\n",
    "NEARLY": f"//\n{_UNIT.replace('crushed', 'broken')}//\n{_UNIT}O\tbowl\n//\n",
    "LENGTHS": "twist\t10\ncrush\t1 min\tpassive\n",
    "TREE": ("solve", "--goal", "ice", "--format", "json"),
    "TORN": f"//\n{_UNIT}//\n",
    "PROOF": ("certify", "--goal", "ice", "--objective", "success"),
    "FORGED": "{}",
    "QUESTIONS": '{"goal": ["ice", "icecream"]}\n',
    "LINTED": _UNIT.replace("O\tm", "O m"),
    "PLAN": "(u26-twist)\n(u27-crush)\n",
    "MAP": ("export", "--goal", "ice"),
    "DOMAIN": "(define (domain d) (:predicates (p)) (:action a :parameters () :effect (p)))",
    "PROBLEM": "(define (problem e) (:domain d) (:init) (:goal (p)))",
}


@pytest.fixture
def printed(cli: Cli, files: dict[str, str]) -> Any:
    """Ask, with files in the place of names in capitals, and give what is printed."""

    def ask(verb: str, *words: str) -> Any:
        if verb == "schedule" and find_spec("ortools") is None:
            pytest.skip("OR-Tools is not installed (foon-asp[schedule])")
        for name in {*words} & _CONTENTS.keys():
            content = _CONTENTS[name]
            text = content if isinstance(content, str) else cli(*content).out
            if name == "MAP":
                text = json.dumps(cli(*content, "--format", "json").json["map"])
            Path(files[name]).write_text(text, encoding="utf-8")
        ran = cli(verb, *(files.get(word, word) for word in words), "--format", "json")
        assert ran.code in {0, 1, 3}, ran.err
        return ran.json

    return ask


def answers() -> dict[str, click.Command]:
    """Give the commands that have JSON, by verb."""
    found = {}
    for verb in VERBS:
        command = verb_command(verb)
        formats = [o.type for o in command.params if o.name == "format_" and isinstance(o.type, click.Choice)]
        if any("json" in choice.choices for choice in formats):
            found[verb] = command
    return found


def test_every_verb_that_answers_has_a_schema() -> None:
    assert answers().keys() == ASKED.keys() == VERBS.keys() - OTHERS
    kinds = {"answer" if verb == "solve" else verb for verb in ASKED}
    assert {*schema_kinds()} == kinds | {
        "batch-row",
        "compare-row",
        "each",
        "lint-baseline",
        "pddl-map",
        "steps",
    }


@pytest.mark.sampled(3)
@pytest.mark.parametrize(("verb", "words"), CASES)
def test_what_is_printed_is_what_the_schema_says(printed: Any, verb: str, words: tuple[str, ...]) -> None:
    kind = "answer" if verb == "solve" else verb
    assert printed(verb, *words)["schema"] == schema_name(kind)


@pytest.mark.parametrize("verb", ["solve", "search", "regret", "pareto", "alternatives", "why-not"])
def test_goals_that_nobody_named_have_a_document_each(printed: Any, verb: str) -> None:
    document = printed(verb, *["bfs"][: verb == "search"], "--network", "TWO")
    kind = "answer" if verb == "solve" else verb
    assert document["schema"] == schema_name("each")
    assert [answer["schema"] for answer in document["answers"]] == [schema_name(kind)] * 2
    document["answers"][0]["own"] = 1
    with pytest.raises(AssertionError, match=kind):
        valid(document)


@pytest.mark.parametrize(
    "words",
    [
        ("--items", "used-up"),
        ("--goal", "tea", "--objective", "success", "--level", "2"),
        ("--containers", "implied"),
    ],
)
def test_steps_are_what_their_schema_says(cli: Cli, words: tuple[str, ...]) -> None:
    steps = cli("solve", "--goal", "ice", *words, "--format", "steps").json
    assert steps["schema"] == schema_name("steps")
    del steps["steps"][0]["motion"]
    with pytest.raises(AssertionError, match="motion"):
        valid(steps)


def test_rows_and_maps_are_what_their_schemas_say(cli: Cli, tmp_path: Path) -> None:
    rows = tmp_path / "rows.jsonl"
    cli("compare", "--goal", "ice", "--goal", "apple pie", "--results", rows)
    kinds = [valid(json.loads(line))["schema"] for line in rows.read_text(encoding="utf-8").splitlines()]
    assert kinds == [schema_name("compare-row")] * 3
    exported = cli("export", "--goal", "ice", "--format", "json").json
    assert valid(exported["map"])["schema"] == schema_name("pddl-map")


WITHOUT_GOALS = {"batch", "stats", "constraints", "lint", "relax", "view", "units", "diff-network"}
HEAD = ("goals", "containers", "items", "level", "objectives", "starting_kitchen")


@pytest.mark.slow
@pytest.mark.parametrize(
    "verb",
    [
        v
        for v in ASKED
        if v not in {"batch", "stats", "constraints", "lint", "relax", "view", "units", "diff-network"}
    ],
)
def test_the_head_is_the_same_in_every_verb(printed: Any, verb: str) -> None:
    document = printed(verb, *ASKED[verb][0])
    heads = [document["a"], document["b"]] if verb == "diff" else [document]
    for head in heads:
        assert [key for key in head if key in HEAD] == [*HEAD]
        assert "ice" in {goal["label"] for goal in head["goals"]} or verb in {"why-not", "shopping-list"}
        assert head["items"] == ("used-up" if verb == "trace" else "lasting")


def test_the_page_has_every_verb() -> None:
    page = (ROOT / "docs" / "json.md").read_text(encoding="utf-8")
    headings = " ".join(re.findall(r"^## (.*)", page, re.MULTILINE)).split()
    assert {*ASKED, "certify"} <= {*headings}


def test_facts_in_json_are_those_in_text(cli: Cli) -> None:
    asked = ("facts", "--goal", "ice", *SOFT[:2])
    assert "\n".join(cli(*asked, "--format", "json").json["facts"]) + "\n" == cli(*asked).out


def origins(units: list[Any]) -> list[tuple[int, str, Any]]:
    """Give the step, the node and the origin of every input."""
    return [(unit["step"], node["node"], node["from"]) for unit in units for node in unit["inputs"]]


def test_an_input_says_where_it_comes_from(printed: Any) -> None:
    plan = printed("solve", "--goal", "macaroni", "--containers", "implied")["units"]
    assert [unit["step"] for unit in plan] == list(range(1, len(plan) + 1))
    made: dict[str, int] = {}
    for unit in plan:
        for node in unit["inputs"]:
            if node["node"] in made:
                assert node["from"] in ({"step": made[node["node"]]}, {"kitchen": True})
            else:
                assert node["from"] in ({"kitchen": True}, {"implied": True})
        for node in unit["outputs"]:
            if node["made"]:
                made.setdefault(node["node"], unit["step"])
    listed = origins(printed("search", "bfs", "--goal", "macaroni")["units"])
    assert any("later_step" in origin and origin["later_step"] > step for step, _, origin in listed)
    assert {"missing": True} in [
        origin for *_, origin in origins(printed("search", "bfs", "--goal", "hot cocoa")["units"])
    ]
    shopping = printed("shopping-list", "--goal", "apple pie")
    bought = {item["node"] for item in shopping["lists"][0]["items"]}
    found = {node for _, node, origin in origins(shopping["answer"]["units"]) if origin == {"bought": True}}
    assert found == bought != set()


@pytest.mark.parametrize("verb", ["menu", "regret", "shopping-list", "sensitivity", "search"])
@pytest.mark.sampled(3)
def test_a_tree_is_read_from_every_document_that_has_one(cli: Cli, tmp_path: Path, verb: str) -> None:
    file = tmp_path / "document.json"
    more = {"menu": ("--goal", "tea"), "search": ("ids",)}.get(verb, ())
    ran = cli(verb, *more, "--goal", "ice", "--format", "json")
    assert ran.code == 0
    file.write_text(ran.out, encoding="utf-8")
    assert cli("check", file, "--goal", "ice").code == 0
    if verb == "regret":
        assert cli("certify", "--tree", file, "--goal", "ice").code == 0


# --- the schemas


@pytest.mark.sampled(4)
@pytest.mark.parametrize("kind", [*schema_kinds(), None])
def test_a_schema_is_one(kind: str | None) -> None:
    file = SCHEMAS / f"{kind or 'defs'}.json"
    for each in (schema(kind) if kind else {}, json.loads(file.read_text(encoding="utf-8"))):
        jsonschema.Draft202012Validator.check_schema(each)
    if kind:
        whole = schema(kind)
        references = re.findall(r'"\$ref": "([^"]*)"', json.dumps(whole))
        assert {reference.removeprefix("#/$defs/") for reference in references} == whole.get(
            "$defs", {}
        ).keys()
        assert whole["$schema"] == "https://json-schema.org/draft/2020-12/schema"


def test_what_the_schemas_share_is_used() -> None:
    used = {name for kind in schema_kinds() for name in schema(kind).get("$defs", {})}
    used -= {*schema_kinds()} - {"answer", "clash"}  # documents of their own, which a page has
    assert used == json.loads((SCHEMAS / "defs.json").read_text(encoding="utf-8"))["$defs"].keys()


def test_the_words_of_the_schemas_are_ours() -> None:
    shared = schema("answer")["$defs"]
    ours, measures = shared["objective"]["anyOf"]
    assert ours["enum"] == list(shared["figures"]["properties"]) == list(map(str, Objective))
    assert re.fullmatch(measures["pattern"], "mine")
    assert shared["containers"]["enum"] == list(map(str, ContainerRule))
    assert shared["status"]["enum"] == list(map(str, Status))
    assert sorted(shared["level"]["enum"]) == sorted(LEVELS)
    assert schema("check")["$defs"]["verdict"]["enum"] == list(map(str, Verdict))
    assert schema("search")["properties"]["ending"]["enum"] == list(map(str, Ending))
    assert {*shared["answer"]["properties"]["proof"]["enum"]} == {*map(str, Proof), None}


def test_the_verb_prints_them(cli: Cli) -> None:
    listed = cli("schema").out.splitlines()
    assert [line.split()[0] for line in listed] == [schema_name(kind) for kind in schema_kinds()]
    assert (
        json.loads(cli("schema", "solve").out) == schema("answer") == json.loads(cli("schema", "answer").out)
    )
    ran = cli("schema", "sovle")
    assert (ran.code, ran.out) == (2, "")
    assert "found 'sovle', expected a verb that has a schema: alternatives, answer, " in ran.err


# What may have other keys, or lack one: what is by objective, phase, motion or code, and what only some have.
OPEN = {"codes", "statuses", "proofs", "person", "question"}
LOOSE = {
    *OPEN,
    "seconds",
    "lower_bound",
    "proof_by_objective",
    "measures",
    "ratios",
    "optimum",
    "loss",
    "costs",
}
SOME = {"stays", "why", "replay", "stands_for", "penalty", "soft_constraints", "cross_check"}


def changed(document: Any) -> Iterator[Any]:
    """Give the document with a key too many or too few, once for every place that looks the same."""
    seen: set[tuple[str, ...]] = set()

    def walk(value: Any, path: tuple[str, ...]) -> Iterator[None]:
        if isinstance(value, list):
            for each in value:
                yield from walk(each, path)
        elif isinstance(value, dict):
            for key in list(value):
                yield from walk(value[key], (*path, key))
            name = path[-1] if path else ""
            shape = (*path, *sorted(value))
            if shape in seen:
                return
            seen.add(shape)
            if name not in OPEN:
                value["more!"] = 1  # no name, and so no measure of somebody's either
                yield
                del value["more!"]
            for key in [key for key in value if name not in LOOSE and key not in SOME]:
                kept = dict(value)
                del value[key]
                yield
                value.clear()
                value.update(kept)

    document = copy.deepcopy(document)
    for _ in walk(document, ()):
        yield document


@pytest.mark.parametrize(
    ("verb", "words"),
    [
        pytest.param(verb, asked[0], marks=() if verb in {"facts", "verify"} else pytest.mark.slow, id=verb)
        for verb, asked in ASKED.items()
    ],
)
def test_a_key_too_many_or_too_few_is_noticed(printed: Any, verb: str, words: tuple[str, ...]) -> None:
    document = printed(verb, *words)
    validator = jsonschema.Draft202012Validator(schema("answer" if verb == "solve" else verb))
    broken = 0
    for each in changed(document):
        broken += 1
        assert not validator.is_valid(each), each
    assert broken > 3
    assert valid(document) == document


# --- nodes, and the text


names = st.text(st.characters(codec="utf-8"), min_size=1, max_size=5)
nodes = st.builds(
    ObjectNode.of,
    names,
    st.lists(names, max_size=2),
    st.lists(st.tuples(names, names), max_size=2),
    st.lists(st.tuples(names, st.lists(names, max_size=3)), max_size=2),
)


@given(nodes)
@settings(max_examples=30)
def test_a_node_is_read_as_it_was_written(node: ObjectNode) -> None:
    assert read_node_json(json.loads(json_text(node_json(node, 3)))) == node


values = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False) | st.text(),
    lambda inner: st.lists(inner) | st.dictionaries(st.text(), inner),
)


@given(values)
@settings(max_examples=30)
def test_what_is_laid_out_is_the_same_value(value: Any) -> None:
    text = json_text(value)
    assert read_json(text) == value
    assert text.endswith("\n")
    text.encode()


def test_what_fits_stands_on_one_line() -> None:
    short, long = ["a"] * 3, ["b" * 30] * 6
    assert json_text({"short": short, "long": long, "none": []}) == (
        '{\n  "short": ["a", "a", "a"],\n  "long": [\n    '
        + ",\n    ".join([json.dumps("b" * 30)] * 6)
        + '\n  ],\n  "none": []\n}\n'
    )
    assert all(len(line) <= 100 for line in json_text([[short] * 9] * 9).splitlines())
