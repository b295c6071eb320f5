"""``foon-asp rename``: a name is another one everywhere, and nothing else is."""

import json
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from foon_asp.errors import UserError
from foon_asp.network import FunctionalUnit, ObjectNode
from foon_asp.text.conversion import Converter
from foon_asp.text.diagnostics import Rename
from foon_asp.text.format import Dialect
from foon_asp.text.formats import format_of
from foon_asp.text.reader import FoonReader
from foon_asp.text.renaming import Renaming
from foon_asp.text.writer import write_units
from tests.conftest import Cli
from tests.text.foon_strategies import steady, units

IDS = (
    "# bowl\n//\nO5\tbowl\t0\nS1\tempty\nO9\tsalt\t1\nS2\tin\t[bowl]\nM3\tpour*\t<0:12-0:14>\n"
    "O5\tbowl \t0\nS4\tcontains\t{ salt,bowl}\nO7\tdish\nM\n"
)


def renamed(text: str, kind: str, old: str, new: str, file: str = "a.txt") -> str:
    renaming = Renaming(Rename(kind, old, new))
    format_ = format_of(text, file)
    renaming.learn(format_.mentions(text, file))
    return format_.renamed_text(text, file, renaming)


def test_lines_keep_everything_else() -> None:
    dish = IDS.replace("O5\tbowl", "O7\tdish").replace("[bowl]", "[dish]").replace(",bowl", ",dish")
    assert (
        renamed(IDS, "object", "bowl", "dish") == dish
    )  # with the id of dish, and the slips that were there
    assert renamed(IDS, "object", "salt", "sea salt") == IDS.replace("salt", "sea salt")
    assert renamed(IDS, "motion", "pour", "tip") == IDS.replace("pour", "tip")
    assert renamed(IDS, "state", "empty", "clean") == IDS.replace("empty", "clean")
    assert renamed(IDS, "relation", "contains", "holds") == IDS.replace("contains", "holds")
    assert renamed(IDS.replace("\n", "\r\n"), "object", "bowl", "dish") == dish.replace("\n", "\r\n")


def test_an_ingredient_that_is_there_already_is_not_written_twice() -> None:
    both = "O\ta\nS4\tcontains\t{salt, pepper,leek}\nS\tin\t[salt]\n"
    once = "O\ta\nS4\tcontains\t{pepper,leek}\nS\tin\t[pepper]\n"
    assert renamed(both, "object", "salt", "pepper") == once


def mapped(unit: FunctionalUnit, kind: str, old: str, new: str) -> FunctionalUnit:
    """Rename in a unit, in the plain way."""

    def name(of: str, text: str) -> str:
        return new if (of, text) == (kind, old) else text

    def node(given: ObjectNode) -> ObjectNode:
        return ObjectNode.of(
            name("object", given.label),
            [name("state", state) for state in given.states],
            [(name("relation", word), name("object", thing)) for word, thing in given.relations],
            [(name("relation", w), [name("object", item) for item in items]) for w, items in given.contents],
        )

    return FunctionalUnit.of(name("motion", unit.motion), map(node, unit.inputs), map(node, unit.outputs))


@settings(steady, max_examples=40)
@given(drawn=units(), dialect=st.sampled_from(Dialect), data=st.data())
def test_what_is_read_is_what_was_read_with_another_name(
    drawn: list[FunctionalUnit], dialect: Dialect, data: st.DataObject
) -> None:
    converter = Converter(dialect, lenient=False)
    plain = write_units(drawn)
    converter.learn(plain)
    try:
        text = converter.convert(plain, "a.txt").text
    except UserError:  # what a dialect cannot hold
        text = plain
    reader = FoonReader()
    before = [unit for unit, _ in reader.tree_units(text, "a.txt")]
    names = sorted({(str(kind), name) for kind, name, _ in format_of(text).mentions(text, "a.txt")})
    if not names:
        return
    kind, old = data.draw(st.sampled_from(names))
    if (kind, old) == ("relation", "contains") and '"ingredients"' in text:
        return  # JSON lists ingredients under one word
    after = renamed(text, kind, old, "zzz")
    found = [unit for unit, _ in FoonReader().tree_units(after, "a.txt")]
    assert found == [mapped(unit, kind, old, "zzz") for unit in before]
    again = [unit for unit, _ in FoonReader().tree_units(renamed(after, kind, "zzz", old), "a.txt")]
    assert again == before


def test_the_word_of_ingredients_in_json_is_no_state() -> None:
    node = {"label": "cup", "states": ["contains", "contains"], "ingredients": ["milk"]}
    text = json.dumps([node, {"label": "jar", "states": ["contains"], "ingredients": ["none"]}])
    kinds = [
        str(mention.kind)
        for mention in format_of(text).mentions(text, "a.json")
        if mention.name == "contains"
    ]
    assert kinds == ["relation", "state", "state"]
    assert json.loads(renamed(text, "state", "contains", "full"))[0]["states"] == ["contains", "full"]
    with pytest.raises(UserError, match="under the word 'contains' alone"):
        renamed(text, "relation", "contains", "holds")


def test_a_state_of_json_with_ingredients_is_one_line() -> None:
    text = json.dumps([{"label": "cup", "states": ["coated {milk}"]}])
    assert json.loads(renamed(text, "relation", "coated", "filled"))[0]["states"] == ["filled {milk}"]


def test_json_of_both_forms_with_its_ids() -> None:
    nodes = [
        {"object_id": 5, "object_label": "bowl", "object_states": [{"state_id": 1, "state_label": "empty"}]},
        {"object_label": "dish", "object_id": 7, "object_states": []},
        {
            "object_id": "8",
            "object_label": "bo\u0077l",
            "object_states": [{"state_label": "in", "relative_object": "bowl"}, {"state_label": "on [bowl]"}],
            "ingredients": ["bowl", {"label": "bowl", "container": "bowl"}],
        },
    ]
    motion = {"motion_label": "bowl*", "motion_id": 3}
    unit = {"input_nodes": nodes, "motion_node": motion, "output_nodes": nodes[:1]}
    text = json.dumps({"source": "bowl", "functional_units": [unit]}, indent=1)
    expected = (
        text.replace('5,\n     "object_label": "bowl"', '7,\n     "object_label": "dish"')
        .replace('"8",\n     "object_label": "bowl"', '"7",\n     "object_label": "dish"')
        .replace('t": "bowl"', 't": "dish"')
        .replace("on [bowl]", "on [dish]")
        .replace('\n      "bowl"', '\n      "dish"')
        .replace('"label": "bowl"', '"label": "dish"')
        .replace('r": "bowl"', 'r": "dish"')
    )
    assert expected.count("bowl") == 2  # the source, and the motion
    assert renamed(text, "object", "bowl", "dish", "a.json") == expected
    assert renamed(text, "motion", "bowl", "cup", "a.json") == text.replace('"bowl*"', '"cup*"')
    assert renamed(text, "relation", "in", "inside", "a.json") == text.replace('"in"', '"inside"')
    assert '"clean"' in renamed(text, "state", "empty", "clean", "a.json")


def test_broken_json_is_refused_in_place(cli: Cli, tmp_path: Path) -> None:
    file = tmp_path / "a.json"
    for text in ('[{"label": "pot"}]]', '[{"label" "pot"}]', '[O "label": "pot"}]'):
        file.write_text(text)
        ran = cli("rename", "pot", "pan", file)
        assert (ran.code, "not JSON" in ran.err) == (2, True), ran.err


def folder_of_data(folder: Path) -> dict[str, str]:
    texts = {
        "FOON.txt": "\ufeffO\tpot\nM\tstir\nO\tpot\nS\thot\n//\n",
        "kitchen.json": '[{"label": "pot", "states": []}]\n',
        "motion.txt": "# rates\nstir\t0.9\n",
        "utensils.txt": "pot\r\nspoon\n",
        "tools.txt": "pot\t1\npot; in [pot]\t2\n",
        "unit_prices.txt": "stir\tpot\t→\tpot; hot\t1.5\nfry\t3\n",
        "durations.txt": "stir\t1 min\n",
    }
    for name, text in texts.items():
        (folder / name).write_bytes(text.encode())
    return texts


def test_a_folder_is_renamed_with_its_tables(tmp_path: Path, cli: Cli) -> None:
    texts = folder_of_data(tmp_path)
    shown = cli("rename", "pot", "pan", tmp_path)
    assert {file.name: file.read_bytes().decode() for file in tmp_path.iterdir()} == texts
    assert (shown.code, shown.out.count("\n+")) == (0, 7 + 5)
    assert cli("rename", "pot", "pan", tmp_path, "-y").out == shown.out
    expected = {name: text.replace("pot", "pan") for name, text in texts.items()}
    assert {file.name: file.read_bytes().decode() for file in tmp_path.iterdir()} == expected
    assert cli("rename", "stir", "mix", tmp_path, "-y").code == 0
    assert (tmp_path / "unit_prices.txt").read_text() == "mix\tpan\t→\tpan; hot\t1.5\nfry\t3\n"
    assert cli("rename", "hot", "warm", tmp_path, "--write").code == 0
    assert "pan; warm\t1.5" in (tmp_path / "unit_prices.txt").read_text()


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("ladel", "spoon"), "is called 'ladel' in 7 files; there is 'ladle'"),
        (("stir", "shake", "--kind", "object"), "'stir' is no object; it is a motion"),
        (("ladle", "serve"), "'ladle' is an object (1 times) and a motion (1 times): choose one with --kind"),
        (("pot", "a, b"), "'a, b' cannot be the name of an object"),
        (("stir", "mix*"), "'mix*' cannot be the name of a motion"),
        (("pot", "pot"), "the new name is the old one"),
        (("stir", "fry"), "motion.txt would have two different rows for 'fry'"),
        (("spilt", "poured"), "ladle.txt:7:1: error: found 'Sspilt"),
    ],
)
def test_what_cannot_be_renamed(tmp_path: Path, cli: Cli, words: tuple[str, ...], said: str) -> None:
    texts = folder_of_data(tmp_path) | {"motion.txt": "stir\t0.9\nfry\t0.8\n"}
    (tmp_path / "motion.txt").write_text(texts["motion.txt"])
    texts["ladle.txt"] = "O\tladle\nM\tladle\nO\tsoup\nS\tspilt\n//\n\nSspilt\n"
    (tmp_path / "ladle.txt").write_text(texts["ladle.txt"])
    if words[0] == "ladel":
        del texts["durations.txt"]
        (tmp_path / "durations.txt").unlink()
    ran = cli("rename", *words, tmp_path, "-y")
    assert (ran.code, ran.out) == (2, "")
    assert said in ran.err
    assert {file.name: file.read_bytes().decode() for file in tmp_path.iterdir()} == texts
