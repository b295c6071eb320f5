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

import foon_asp
from foon_asp.cli.verbs import VERBS, verb_command
from foon_asp.json_layout import json_text, read_json, schema_name
from foon_asp.network import NetworkBuilder, ObjectNode
from foon_asp.planning import translator
from foon_asp.results.plain_values import plain
from foon_asp.results.schema_file import schema, schema_kinds
from foon_asp.results.values_of import named_node
from foon_asp.text.json_node import read_node_json
from tests.conftest import Cli, valid

FORBID = ("--constraint", "forbid_motion", "-c", 'forbidden_motion="crush"')
SOFT = ("--soft", "forbid_motion=3", "-c", 'forbidden_motion="crush"')
# By verb: what is asked of the bundled kitchen, each to give another branch of the document. The first is
# asked by default. What is in capitals is a file.
RULE = ("--rule", ":- use(U), motion(U,M), #count { V : motion(V,M) } = 1.")
ASKED: dict[str, list[tuple[str, ...]]] = {
    "solve": [
        ("--goal", "ice", "--goal", "tea"),
        ("--goal", "ice", "--goal", "apple pie"),
        ("--goal", "ice", *SOFT),
        ("--goal", "ice", "--cross-check"),
        ("--goal", "ice", "--goal", "tea", "--objective", "success,inputs", "--containers", "implied"),
        ("--goal", "ice", "--level", "1", "--objective", "attempts,inputs+ingredients,kitchen"),
        ("--goal", "apple pie"),
        ("--goal", "whipped cream", "--time-limit", "0"),
        ("--goal", "ice", "--items", "used-up"),
    ],
    "compare": [
        ("--goal", "macaroni", "--search", "bfs", "--trees"),
        ("--goal", "apple pie", "--level", "2"),
        ("--goal", "ice", "--published", "--containers", "implied"),
    ],
    "check": [
        ("TORN", "--goal", "ice"),
        ("TREE", "--goal", "tea"),
        ("TORN", "--goal", "ice", "--items", "used-up"),
        ("TREE", "--goal", "ice", "--items", "used-up"),
    ],
    "verify": [("PROOF",), ("FORGED",)],
    "why-not": [
        ("--goal", "apple pie"),
        ("--goal", "ice", *FORBID),
        ("--goal", "ice", "--constraint", "require_motion", "-c", 'required_motion="crush"'),
    ],
    "shopping-list": [("--goal", "apple pie")],
    "alternatives": [
        ("--goal", "ice", "--different", "2"),
        ("--goal", "apple pie"),
        ("--goal", "ice", "--union", "--within", "50"),
        ("--goal", "apple pie", "--union"),
    ],
    "pareto": [("--goal", "ice"), ("--goal", "apple pie")],
    "regret": [("--goal", "ice", "--objective", "success,kitchen"), ("--goal", "apple pie")],
    "sensitivity": [("--goal", "ice"), ("--goal", "apple pie")],
    "assist": [("--goal", "ice", "--reach", "0.9"), ("--goal", "apple pie")],
    "diff": [("TREE", "TORN", "--goal", "ice"), ("NEARLY", "TWO"), ("TWO", "TWO", "--level", "1")],
    "export": [("--goal", "ice", "--objective", "kitchen,success", "--containers", "implied")],
    "read-plan": [("PLAN", "--map", "MAP")],
    "relax": [("DOMAIN", "PROBLEM")],
    "batch": [("QUESTIONS", "--results", "ROWS")],
    "trace": [
        ("TREE", "--goal", "ice", "--items", "used-up", "--failed", "2"),
        ("TORN", "--goal", "ice"),
    ],
    "schedule": [
        ("TREE", "--durations", "LENGTHS"),
        (
            *("BOWLS", "--network", "BOWLS", "--utensils", "LABELS"),
            *("--kitchen", "THINGS", "--durations", "LENGTHS"),
        ),
    ],
    "view": [
        ("--goal", "ice", "--beside", "alternatives"),
        ("--goal", "apple pie"),
        ("--goal", "ice", "--beside", "front", *FORBID),
        ("--goal", "ice", "--items", "used-up"),
    ],
    "align": [("TORN", "--to", "TWO")],
    "stats": [(), ("--unit", "3", "--explain-items")],
    "facts": [("--goal", "ice", *SOFT[:2])],
    "constraints": [(), ("--explain", "before", *RULE), ("--explain", "require_motion:required_motion=cut")],
    "lint": [("LINTED",)],
}
OTHERS = {
    *("completion", "encodings", "init", "schema", "fmt", "convert", "merge"),
    *("help", "rename", "lsp"),
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
    "PROOF": ("solve", "--goal", "ice", "--objective", "success", "--certificate"),
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
        if verb == "relax" and not translator.is_installed():
            pytest.skip("Fast Downward's translator is not installed (foon-asp[pddl])")
        for name in {*words} & _CONTENTS.keys():
            content = _CONTENTS[name]
            if name == "PROOF":
                cli(*content, files[name])
                continue
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
    alone = {"batch-row", "compare-row", "diff-network", "durations", "each", "lint-baseline", "merge"}
    alone |= {"optima", "pddl-map", "refused", "repair", "rules", "search", "state", "steps"}
    alone |= {"unit-union", "units"}
    assert {*schema_kinds()} == {"answer" if verb == "solve" else verb for verb in ASKED} | alone


@pytest.mark.parametrize(("verb", "words"), CASES)
def test_what_is_printed_is_what_the_schema_says(printed: Any, verb: str, words: tuple[str, ...]) -> None:
    document = printed(verb, *words)
    networks = verb == "diff" and "TREE" not in words
    kind = "diff-network" if networks else "answer" if verb == "solve" else verb
    kind = "units" if "--unit" in words else "rules" if "--explain" in words else kind
    kind = "unit-union" if "--union" in words else kind
    assert document["schema"] == schema_name("refused" if "FORGED" in words else kind)
    if verb not in WITHOUT_GOALS and not networks:
        heads = [document["a"], document["b"]] if verb == "diff" else [document]
        for head in heads:
            assert [key for key in head if key in HEAD] == [*HEAD]


@pytest.mark.parametrize("verb", ["solve", "regret", "pareto", "alternatives", "why-not"])
def test_goals_that_nobody_named_have_a_document_each(printed: Any, verb: str) -> None:
    document = printed(verb, "--network", "TWO")
    kind = "answer" if verb == "solve" else verb
    assert document["schema"] == schema_name("each")
    assert [answer["schema"] for answer in document["answers"]] == [schema_name(kind)] * 2
    document["answers"][0]["own"] = 1
    with pytest.raises(AssertionError, match=kind):
        valid(document)


def test_all_goals_have_an_answer_each(printed: Any) -> None:
    words = ("--goal", "tea", "--goal", "ice", "--objective", "kitchen,success", "--level", "2")
    document = printed("solve", "--all-goals", *words)
    assert document["schema"] == schema_name("optima")
    assert [answer["goals"][0]["label"] for answer in document["answers"]] == ["tea", "ice"]


@pytest.mark.parametrize(
    "words", [("--items", "used-up"), ("--goal", "tea", "--objective", "success", "--level", "2")]
)
def test_steps_are_what_their_schema_says(cli: Cli, words: tuple[str, ...]) -> None:
    steps = cli("solve", "--goal", "ice", *words, "--format", "steps").json
    assert steps["schema"] == schema_name("steps")
    del steps["steps"][0]["motion"]
    with pytest.raises(AssertionError, match="motion"):
        valid(steps)


def test_rows_of_a_comparison_are_what_their_schema_says(cli: Cli, tmp_path: Path) -> None:
    rows = tmp_path / "rows.jsonl"
    cli("compare", "--goal", "ice", "--goal", "apple pie", "--results", rows)
    lines = rows.read_text(encoding="utf-8").splitlines()
    assert [valid(json.loads(line))["schema"] for line in lines] == [schema_name("compare-row")] * 3
    assert valid(cli("export", "--goal", "ice", "--format", "json").json["map"])


def test_steps_without_utensils_say_that_tools_are_not_known(cli: Cli, tmp_path: Path) -> None:
    recipe = tmp_path / "egg.txt"
    recipe.write_text("//\nO\tegg\nO\tknife\nM\tcut\nO\tegg\nS\tcut\n//\n")
    assert "no utensils are known (--utensils)" in cli("solve", recipe, "--format", "steps").err
    assert "utensils" not in cli("solve", recipe).err
    (tmp_path / "utensils.txt").write_text("knife\n")
    ran = cli("solve", recipe, "--utensils", tmp_path / "utensils.txt", "--format", "steps")
    assert "utensils" not in ran.err
    assert [tool["node"] for tool in ran.json["steps"][0]["tools"]] == ["knife"]


WITHOUT_GOALS = {
    "align",
    *("batch", "stats", "constraints", "lint", "relax", "verify", "read-plan"),
    "view",  # the answer of which has them
}
HEAD = ("goals", "containers", "items", "level", "objectives", "starting_kitchen")


def origins(document: Any) -> set[tuple[str, bool]]:
    """Give the origins of all inputs, and whether that is a step before their own."""
    found = set()
    for unit in document["units"]:
        for node in unit["inputs"]:
            ((kind, value),) = node["from"].items()
            found.add((kind, value is not True and value < unit["step"]))
            if kind in {"step", "later_step"}:
                outputs = document["units"][value - 1]["outputs"]
                assert (node["node"], True) in [(each["node"], each["made"]) for each in outputs]
    return found


def test_an_input_says_where_it_comes_from(printed: Any) -> None:
    plan = printed("solve", "--goal", "hot cocoa", "--containers", "implied")
    assert [unit["step"] for unit in plan["units"]] == list(range(1, len(plan["units"]) + 1))
    assert origins(plan) == {("step", True), ("kitchen", False), ("implied", False)}
    foon = foon_asp.load()
    listed = valid(foon_asp.search(foon.problem("macaroni"), "bfs").json())
    assert origins(listed) == {("step", True), ("kitchen", False), ("later_step", False)}
    assert ("missing", False) in origins(foon_asp.search(foon.problem("hot cocoa"), "bfs").json())
    assert valid(foon_asp.search(foon.problem("apple pie"), "ids").json())["units"] is None
    shopping = printed("shopping-list", "--goal", "apple pie")
    bought = {
        node["node"]
        for unit in shopping["answer"]["units"]
        for node in unit["inputs"]
        if node["from"] == {"bought": True}
    }
    assert bought == {item["node"] for item in shopping["lists"][0]["items"]} != set()


@pytest.mark.parametrize("verb", ["regret", "shopping-list", "sensitivity"])
def test_a_tree_is_read_from_every_document_that_has_one(cli: Cli, tmp_path: Path, verb: str) -> None:
    file = tmp_path / "document.json"
    file.write_text(cli(verb, "--goal", "ice", "--format", "json").out, encoding="utf-8")
    assert cli("check", file, "--goal", "ice").code == 0
    if verb == "regret":
        assert cli("check", file, "--goal", "ice", "--certificate", tmp_path / "proof.json").code == 0


# --- the schemas


@pytest.mark.parametrize("kind", schema_kinds())
def test_a_schema_is_one(kind: str) -> None:
    whole = schema(kind)
    jsonschema.Draft202012Validator.check_schema(whole)
    references = {
        each.removeprefix("#/$defs/") for each in re.findall(r'"\$ref": "([^"]*)"', json.dumps(whole))
    }
    assert references == whole.get("$defs", {}).keys()
    assert whole["$schema"] == "https://json-schema.org/draft/2020-12/schema"


def test_the_verb_prints_them(cli: Cli) -> None:
    listed = cli("schema").out.splitlines()
    assert [line.split()[0] for line in listed] == [schema_name(kind) for kind in schema_kinds()]
    for named in ("solve", "answer"):
        assert json.loads(cli("schema", named).out) == schema("answer")
    ran = cli("schema", "sovle")
    assert (ran.code, ran.out) == (2, "")
    assert "found 'sovle', expected a verb that has a schema: align, alternatives, " in ran.err


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
SOME = {"stays", "why", "used_up_by", "stands_for", "penalty", "soft_constraints", "cross_check"}
SOME |= {"goals_alone", "sum_of_goals_alone", "serves", "by", "tree", "published"}


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


NOTHING = NetworkBuilder().build()
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
    assert read_node_json(json.loads(json_text(plain(named_node(NOTHING, node))))) == node


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
