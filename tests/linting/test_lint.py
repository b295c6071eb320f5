"""``foon-asp lint``: what is found, where, and what mending changes."""

import json
import time
from itertools import product
from pathlib import Path

import pytest
from hypothesis import given, settings

from foon_asp.linting.catalog import CATALOG
from foon_asp.linting.finding import Finding
from foon_asp.linting.linter import lint
from foon_asp.linting.mending import mend
from foon_asp.linting.near_names import near_names
from foon_asp.text.diagnostics import Diagnostic
from foon_asp.text.reader import FoonReader
from tests.conftest import CORPUS, Cli
from tests.linting.planted import CHOP, written
from tests.text.foon_strategies import steady, texts


def found(folder: Path, *texts: str, names: tuple[str, ...] = ()) -> list[Diagnostic]:
    return lint(written(folder, *texts, names=names))


def codes(findings: list[Diagnostic]) -> list[str]:
    return [finding.code for finding in findings]


def test_clean_text_has_no_findings(tmp_path: Path) -> None:
    assert found(tmp_path, "# soup\n" + CHOP, names=("soup.txt",)) == []
    assert found(tmp_path, "") == []


def test_linting_goes_on_after_errors(tmp_path: Path) -> None:
    text = "zzz\n" + CHOP + "S\tlost\n//\n" + CHOP + "O\ttea\nM\tstir\nO\ttea\n//\n"
    findings = found(tmp_path, text, CHOP, text)
    assert codes(findings[4:]) == codes(findings[:4])
    assert codes(findings[:4]) == [
        "syntax",
        "state-without-object",
        "duplicate-unit",
        "no-effect",
    ]
    assert [finding.source.line for finding in findings] == [1, 8, 10, 16] * 2


@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_line_ends_do_not_matter(tmp_path: Path, end: str) -> None:
    text = "O\tonion\nS\tpeeled\nS\tpeeled\nM\tchop\nO\tonion\nS\tin [gamelle]\n"
    here = [(f.source.line, f.source.column, f.code, f.excerpt) for f in found(tmp_path, text)]
    there = [
        (f.source.line, f.source.column, f.code, f.excerpt) for f in found(tmp_path, text.replace("\n", end))
    ]
    assert here == there
    assert [code for _, _, code, _ in here] == [
        "repeated-object",
        "space-for-tab",
        "unknown-container",
        "missing-separator",
    ]


# Names


def mentions(text: str) -> dict[str, int]:
    """Read ``name: mentions, name: mentions``."""
    pairs = (each.split(": ") for each in text.split(", "))
    return {name: int(count) for name, count in pairs}


@pytest.mark.parametrize(
    "counts",
    [
        "drinking glas: 30, drinking glass: 29",
        "hash brown: 2, hashbrown: 9",
        "Bowl: 1, bowl: 9",
        "baking try: 1, baking tray: 400",
        "onoin: 1, onion: 3",
        "tomto: 1, tomato: 3",
        "tometo: 2, tomato: 40",
        "bow: 3, bowl: 900",  # the same slip in the copies of a file
    ],
)
def test_slips_of_the_pen(counts: str) -> None:
    slip, meant = mentions(counts)
    expected = [(meant, slip)] if counts.startswith("drinking") else [(slip, meant)]
    assert list(near_names(mentions(counts))) == expected


@pytest.mark.parametrize(
    "counts",
    [
        "egg: 400, eggs: 1",
        "pig in a blanket: 90, pigs in a blanket: 2",
        "pan: 900, can: 2",
        "butter: 700, cutter: 1",
        "butter: 700, batter: 11",
        "tomato: 39, tometo: 2",
        "tomato: 60, tometo: 3",
        "item 1: 400, item 11: 1",
        "icecream: 400, ice ream: 1",
        "of: 1, off: 900",
        "dip: 7, drip: 1",
        "bow: 1, bowl: 99",
        "fried: 60, dried: 78",
        "cup: 300, cap: 2",
        "onoin: 1, onion: 2",
        f"{'x' * 60}: 100, {'x' * 61}: 1",
    ],
)
def test_words_of_their_own(counts: str) -> None:
    assert list(near_names(mentions(counts))) == []


@pytest.mark.parametrize(
    ("counts", "known", "loose", "pairs"),
    [
        ("zwirbla: 30, zwirblo: 30", "zwirbla", "", [("zwirblo", "zwirbla")]),
        ("zwirbla: 30, zwirblo: 30", "zwirbla, zwirblo", "", []),
        ("zwirbla: 30, zwirblo: 30", "egg", "zwirblo", [("zwirblo", "zwirbla")]),
        ("zwirbla: 30, zwirblo: 30", "egg", "zwirblo, zwirbla", []),
        ("zwirbla: 30, zwirblo: 30", "egg", "", []),
    ],
)
def test_names_that_are_known_or_never_made(
    counts: str, known: str, loose: str, pairs: list[tuple[str, str]]
) -> None:
    assert list(near_names(mentions(counts), False, known.split(", "), loose.split(", "))) == pairs


def test_endings_of_states_are_grammar() -> None:
    for rare, frequent in (("cube", "cubed"), ("juiced", "juice"), ("flakes", "flaked"), ("mixer", "mixed")):
        assert list(near_names({rare: 1, frequent: 200}, verbs=True)) == []
    assert list(near_names({"gratd": 1, "grated": 200}, verbs=True)) == [("gratd", "grated")]


def test_names_are_compared_over_all_files_and_kinds_of_mention(tmp_path: Path) -> None:
    glas = "O\tdrinking glas\nM\tfill\nO\tice\nS\tin\t[drinking glass]\n//\n"
    (finding,) = [f for f in found(tmp_path, CHOP, glas) if f.code == "near-name"]
    assert (finding.source.line, finding.source.column) in {(1, 3), (4, 7)}
    assert "'drinking glass' is never an object" in finding.message
    separate = CHOP.replace("chopped", "choppped"), CHOP.replace("whole", "peeled")
    findings = [f for f in found(tmp_path, *separate) if f.code == "near-name"]
    assert len(findings) == 1


@pytest.mark.parametrize(
    ("often", "seldom", "codes_found"),
    [
        ("O\tzwirbled\nM\tgo\nO\tzwirbled\nS\tup\n//\n" * 3, "O\tzwirbles", ["near-name"]),
        ("O\tegg\nS\tzwirbled\nM\tgo\nO\tegg\nS\tup\n//\n" * 3, "O\tegg\nS\tzwirbles", []),  # grammar
        # what is only taken, beside what is made, is a slip however often either stands
        (
            "O\tegg\nS\tzwirbla\t[egg]\nM\tgo\nO\tegg\nS\tzwirbla\t[egg]\nS\tup\n//\n",
            "O\tegg\nS\tzwirbl\t[egg]",
            ["near-name"],
        ),
        ("O\tegg\nS\tzwirbla\nM\tgo\nO\tegg\nS\tzwirbla\nS\tup\n//\n", "O\tegg\nS\tzwirbl", ["near-name"]),
        ("O\tegg\nS\tzwirbla\nM\tgo\nO\tegg\nS\tup\n//\n" * 2, "O\tegg\nS\tzwirbl", []),
    ],
)
def test_names_of_each_kind(tmp_path: Path, often: str, seldom: str, codes_found: list[str]) -> None:
    findings = found(tmp_path, often, f"{seldom}\nM\tgo\nO\tegg\nS\tdown\n//\n")
    assert [code for code in codes(findings) if code == "near-name"] == codes_found


def test_what_is_never_an_object(tmp_path: Path) -> None:
    text = (
        "O\twhite rice\nO\tcup\nM\tput\nO\tcup\nS\tin\t[xyrq]\nS\tcontains\t{rice,zqlz}\n"
        "O\tcup\nS\tin\t[xyrq]\n//\n"
    )
    findings = found(tmp_path, text)
    assert [(f.code, f.source.line, f.source.column) for f in findings] == [
        ("unknown-container", 5, 7),
        ("unknown-ingredient", 6, 13),
        ("unknown-ingredient", 6, 18),
    ]
    assert "'xyrq' stands in [ ] twice" in findings[0].message
    assert "is it 'white rice'?" in findings[1].message
    assert "no unit adds it" in findings[2].message
    plural = found(tmp_path, text.replace("{rice,zqlz}", "{eggs}").replace("rice", "egg"))
    assert "'eggs' is an ingredient once, and is never an object; is it 'white egg'?" in plural[1].message
    known = "O\txyrq\nO\trice\nO\tzqlz\nM\tuse\nO\tdone\n//\n"
    assert found(tmp_path, text, known) == []
    # what is known to be a thing, and has no other name here, may never have been annotated
    assert found(tmp_path, text.replace("xyrq", "sink").replace("rice,zqlz", "salt")) == []


def test_the_caret_stands_under_the_whole_name(tmp_path: Path) -> None:
    text = "O\tbowl\nS\tcontains\t{quix vinegar,quix, quix wine}\nM\tinqall\nO\tbowl\nS\tin [qall]\n//\n"
    findings = [f for f in found(tmp_path, text) if f.code.startswith("unknown")]
    carets = [(f.excerpt[f.source.column - 1 :], f.message.split("'")[1]) for f in findings]
    assert carets == [
        ("quix vinegar,quix, quix wine}", "quix vinegar"),
        ("quix, quix wine}", "quix"),
        ("quix wine}", "quix wine"),
        ("qall]", "qall"),
    ]


def test_recipes_may_have_units_in_common(tmp_path: Path) -> None:
    findings = found(tmp_path, "\n" + CHOP, CHOP, CHOP + CHOP)
    assert [(f.code, Path(f.source.file).name, f.source.line) for f in findings] == [
        ("duplicate-unit", "2.txt", 7),
    ]
    assert "already on line 1," in findings[0].message


# Dead cycles


def test_a_kitchen_breaks_a_cycle(tmp_path: Path) -> None:
    text = "O\tgate\nS\toff\nM\topen\nO\tgate\nS\ton\n//\nO\tgate\nS\ton\nM\tshut\nO\tgate\nS\toff\n//\n"
    assert codes(found(tmp_path, text)) == ["dead-cycle"]
    for name, kitchen in (
        ("k.txt", "O\tgate\nS\toff\n"),
        ("k.json", '[{"label": "gate", "states": ["off"]}]'),
    ):
        assert found(tmp_path, text, kitchen, names=("a.txt", name)) == []


def test_a_utensil_is_at_hand(tmp_path: Path) -> None:
    text = "O\ttap\nS\toff\nM\topen\nO\ttap\nS\ton\n//\nO\ttap\nS\ton\nM\tshut\nO\ttap\nS\toff\n//\n"
    assert found(tmp_path, text) == []
    inside = text.replace("S\to", "S\tin\t[wall]\nS\to")
    assert codes(found(tmp_path, inside + "O\twall\nM\twet\nO\twall\nS\twet\n//\n")) == ["dead-cycle"]


# Goals and kitchens


def test_tagged_goals(tmp_path: Path) -> None:
    made = "O\tonion\nM\tchop\nO\tonion\t0\t12\nS\tchopped\n//\n"
    assert found(tmp_path, made) == []
    for tag in ("12", "!"):
        handed_on = f"O\tonion\t0\t{tag}\nO\tpan\nM\tserve\nO\tonion\t0\t{tag}\nO\tplate\n//\n"
        findings = found(tmp_path, handed_on)
        assert [(f.code, f.source.line) for f in findings] == [("unmade-goal", 1)]
    assert (
        found(tmp_path, handed_on, made.replace("\nS\tchopped", "").replace("O\tonion\nM", "O\tpeel\nM"))
        == []
    )


def test_lists_are_compared_with_networks_only(tmp_path: Path) -> None:
    fried = "O\tonion\nS\tfried\n"
    assert found(tmp_path, fried, names=("goals.txt",)) == []
    assert codes(found(tmp_path, CHOP, fried, names=("a.txt", "goals.txt"))) == ["unmade-goal"]
    assert codes(found(tmp_path, CHOP, fried, names=("a.txt", "kitchen.txt"))) == ["unknown-item"]
    (tmp_path / "goals").mkdir()
    assert codes(found(tmp_path, CHOP, fried, names=("a.txt", "goals/kitchen.txt"))) == ["unknown-item"]
    whole = "O\tonion\nS\twhole\n"  # is a node, and made by nothing
    assert codes(found(tmp_path, CHOP, whole, names=("a.txt", "goals.txt"))) == ["unmade-goal"]
    assert found(tmp_path, CHOP, whole, names=("a.txt", "kitchen.txt")) == []


# JSON


def test_json_is_linted_like_text(tmp_path: Path) -> None:
    unit = {
        "input_nodes": [{"label": "caf\u00e9", "states": ["hot"]}, {"label": "cup"}],
        "motion_node": "pour",
        "output_nodes": [{"label": "cup", "ingredients": ["qu\u00e8q"]}],
    }
    text = json.dumps([unit, unit], indent=1)
    findings = found(tmp_path, text, names=("a.json",))
    assert codes(findings) == ["unknown-ingredient", "duplicate-unit"]
    line = text.split("\n")[findings[0].source.line - 1]
    assert (line, line[findings[0].source.column - 1 :]) == (findings[0].excerpt, '"qu\\u00e8q"'[1:])


def test_names_in_json_may_hold_anything(tmp_path: Path) -> None:
    node = {"label": 'a"b\\c', "states": ["tall"], "ingredients": ["x\\", "\ud800"], "container": "in {x}"}
    for value in ([node], [{"input_nodes": [node], "motion_node": "go", "output_nodes": [node]}]):
        findings = found(tmp_path, json.dumps(value), names=("a.json",))
        assert all(str(Finding.of(finding)) for finding in findings)


# Mending

SLIPS = (
    "\ufeff# tea\r\n//\r\nO\ttea\t00\r\nS\tin [cup]\r\nS\tcontains\t{milk, sugar,}\n"
    "M\tstir\tAssume\t3:0s7\r\n"
    "O\ttea\t\nS\ton\t[]\rS\tcoated\t[a,b]\r\n// \r\n\r\nzzz \n  \nO\ttea\nM\tdrink\nO\tcup\n# end"
)
MENDED = (
    "\ufeff# tea\r\n//\r\nO\ttea\t0\r\nS\tin\t[cup]\r\nS\tcontains\t{milk,sugar}\nM\tstir\tAssumed\t3:0s7\r\n"
    "O\ttea\nS\ton\rS\tcoated\t{a,b}\r\n//\r\n\r\nzzz \n  \nO\ttea\nM\tdrink\nO\tcup\n# end\r\n//\r\n"
)


def test_mending_leaves_every_other_byte(tmp_path: Path, cli: Cli) -> None:
    (file,) = written(tmp_path, SLIPS)
    ran = cli("lint", "--fix", file)
    assert file.read_bytes().decode() == MENDED
    assert ran.code == 1  # the syntax error stays, and the time
    assert "error" in ran.out
    assert "10 mended" in ran.out.split("\n")[-2]
    again = cli("lint", "--fix", "--format", "json", file)
    assert file.read_bytes().decode() == MENDED
    assert again.json["mended"] == 0
    assert not any(finding["fix"] for finding in again.json["findings"])


def test_mending_only_what_is_selected(tmp_path: Path, cli: Cli) -> None:
    (file,) = written(tmp_path, "O\ttea\t00\nS\tin [cup]\nM\tstir\nO\ttea\n//\n")
    assert cli("lint", "--fix", "--select", "motion-flag", file).code == 0
    assert file.read_text() == "O\ttea\t0\nS\tin [cup]\nM\tstir\nO\ttea\n//\n"
    assert cli("lint", "--fix", "--ignore", "space-for-tab", "--ignore", "unknown-container", file).code == 0
    assert "in [cup]" in file.read_text()


def test_a_line_that_has_changed_since_is_left_alone(tmp_path: Path) -> None:
    (file,) = written(tmp_path, "O\ttea\t00\nM\tstir\nO\ttea\n//\n")
    findings = lint([file])
    assert mend(b"O\tcoffee\t1\nM\tstir\n", findings) == b"O\tcoffee\t1\nM\tstir\n"


@pytest.mark.parametrize(
    "text", ["O\ta\nM\tb\nO\tc", "O\ta\nM\tb\nO\tc\n", "O\ta\r\nM\tb\r\nO\tc", "O\ta\nM\tb\nO\tc \n\n"]
)
def test_a_missing_separator(tmp_path: Path, cli: Cli, text: str) -> None:
    (file,) = written(tmp_path, text)
    assert cli("lint", "--fix", file).code == 0
    assert found(tmp_path, file.read_bytes().decode()) == []
    end = "\r\n" if "\r" in text else "\n"
    assert f"c{end}//{end}" in file.read_bytes().decode()


@settings(steady, max_examples=30)
@given(text=texts())
def test_mending_changes_nothing_of_what_is_read(tmp_path_factory: pytest.TempPathFactory, text: str) -> None:
    file = tmp_path_factory.getbasetemp() / "mending.txt"
    try:
        file.write_bytes(text.encode())
    except UnicodeEncodeError:
        return
    findings = lint([file])
    assert {finding.code for finding in findings} <= set(CATALOG)
    assert all(finding.severity is CATALOG[finding.code].severity for finding in findings)
    assert all(str(Finding.of(finding)) for finding in findings)
    content = mend(file.read_bytes(), findings)
    before = [unit[:3] for unit in FoonReader().units(file.read_bytes().decode().removeprefix("\ufeff"), "f")]
    file.write_bytes(content)
    assert [unit[:3] for unit in FoonReader().units(content.decode().removeprefix("\ufeff"), "f")] == before
    assert not [finding for finding in lint([file]) if finding.fix is not None]


# The command


def test_text_folds_and_counts(tmp_path: Path, cli: Cli) -> None:
    (file,) = written(
        tmp_path,
        "O\ta\nS\tcontains\t{a, a}\nM\tgo\nO\tb\n//\nO\ta\nS\tx \nM\tgo\nO\tb\nS\tx \nS\ty \nS\tz \n//\n",
    )
    ran = cli("lint", file)
    lines = ran.out.split("\n")
    assert lines[0] == f"{file}:2:15: warning: spaces around 'a' left out [outer-space]"
    assert lines[1] == "    S→contains→{a, a}"
    assert "    ... and 2 more of this kind in this file, on lines 11, 12 [outer-space]" in lines
    assert lines[-2] == "1 file: 6 warnings; --fix would mend 5"
    assert ran.code == 1


def test_json_has_all(tmp_path: Path, cli: Cli) -> None:
    (file,) = written(tmp_path, "O\ta\nM\tgo\nO\tb\nS\tin [c]\n//\n")
    ran = cli("lint", "--format", "json", file)
    assert ran.json["counts"] == {"error": 0, "warning": 1, "note": 1}
    assert ran.json["codes"] == {"space-for-tab": 1, "unknown-container": 1}
    assert ran.json["findings"][0] == {
        "file": str(file),
        "line": 4,
        "column": 5,
        "severity": "warning",
        "code": "space-for-tab",
        "message": "no tab before [c]; read as if there were one",
        "text": "S\tin [c]",
        "fix": "S\tin\t[c]",
        "mendable": True,
        "unsafe": False,
    }


@pytest.mark.slow
def test_json_does_not_repeat_a_long_line_for_each_finding(tmp_path: Path, cli: Cli) -> None:
    names = ", ".join(f"ingredient {number}" for number in range(2000))
    (file,) = written(tmp_path, f"O\ta\nS\tcontains\t{{{names}}}\nM\tgo\nO\ta\nS\tbig\n//\n")
    ran = cli("lint", "--format", "json", file)
    slip = next(finding for finding in ran.json["findings"] if finding["code"] == "outer-space")
    assert (slip["text"], slip["fix"], slip["mendable"]) == (None, None, True)
    assert len(ran.json["findings"]) > 2000
    assert len(ran.out) < 500 * len(ran.json["findings"])
    assert cli("lint", "--fix", "--select", "outer-space", file).code == 0
    assert ", " not in file.read_text()


def test_annotations_are_escaped(tmp_path: Path, cli: Cli) -> None:
    (file,) = written(
        tmp_path, "O\ta%\nM\tgo\nO\ta%\n//\nO\ta\nM\tgo\nO\tb\nS\tin\t[c%]\n//\n", names=("a,b.txt",)
    )
    ran = cli("lint", "--format", "github", file)
    place = str(file).replace(",", "%2C").replace(":", "%3A")
    first, second = ran.out.splitlines()
    assert first.startswith(f"::warning file={place},line=1,col=1,title=no-effect::the outputs")
    assert second.startswith(f"::notice file={place},line=8,col=7,title=unknown-container::'c%25' stands")


def test_the_exit_code_goes_by_severity(tmp_path: Path, cli: Cli) -> None:
    note, warning, error = written(
        tmp_path, "O\ta\nS\tin\t[z]\nM\tgo\nO\tb\n//\n", "O\ta\nM\tgo\nO\ta\n//\n", "zzz\n" + CHOP
    )
    assert [cli("lint", file).code for file in (note, warning, error)] == [0, 1, 1]
    assert cli("lint", "--ignore", "syntax", error).code == 0
    assert cli("lint", "--select", "syntax", warning).code == 0
    for words in (
        ["--select", "nothing", note],
        [tmp_path / "none.txt"],
        [],
        ["--fix", "--format", "xml", note],
    ):
        assert cli("lint", *words).code == 2


# The real corpus


@pytest.mark.parametrize(
    ("folder", "expected"),
    [
        (
            "universal/FOON.txt",
            {"space-for-tab", "outer-space", "no-outputs", "near-name", "repeated-ingredient"},
        ),
        (
            "subgraphs",
            {
                "contents-bracket",
                "empty-ingredient",
                "time",
                "no-motion",
                "broken-chain",
                "time-value",
                "other-bracket",
                "misread-line",
            },
        ),
        ("dialects", {"no-motion", "id-of-two-names"}),
    ],
)
def test_the_dirt_of_the_corpus_is_found(universal: Path, cli: Cli, folder: str, expected: set[str]) -> None:
    ran = cli("lint", CORPUS / folder, "--format", "json")
    assert ran.code == 1
    assert expected <= set(ran.json["codes"])


def test_near_names_of_the_universal_foon_are_slips(universal: Path) -> None:
    slips = {
        "choppped",
        "drinking glas",
        "baking try",
        "choocolate",
        "cinammon",
        "bow",
        "garlic pres",
        "lemon gras",
    }
    messages = [f.message for f in lint([universal / "FOON.txt"]) if f.code == "near-name"]
    assert all(any(repr(slip) in message for message in messages) for slip in slips)
    assert len(messages) < 20
    words = {"cutter", "batter", "mashed", "loaf", "eggs", "broil"}
    assert not any(repr(word) in message for word, message in product(words, messages))


def test_quotes_that_are_not_closed_are_looked_through_once(tmp_path: Path) -> None:
    (file,) = written(tmp_path, '[{"label": "on\\"ion"}] "open\n"' + '\\"' * 300_000, names=("a.json",))
    began = time.process_time()
    assert codes(lint([file])) == ["json"]
    assert time.process_time() - began < 1
