"""Living with ``foon-asp lint``: settings, comments, baselines, standard input, unsafe fixes."""

import io
import json
import subprocess
import sys
from pathlib import Path
from shutil import which
from typing import Any

import pytest

from foon_asp.linting.lint_settings import find_settings, read_settings
from foon_asp.report.line_diff import line_diff
from foon_asp.text.diagnostics import InputError
from tests.conftest import ROOT, Cli, valid

SLIP = "O\tonion\nS\tin [gamelle]\nM\tchop\nO\tonion\nS\tchopped\n//\n"
CHOPPED = "O\tonion\nS\tchopped\nM\tfry\nO\tonion\nS\tfried\nS\tchopped\n//\n"
NEAR = f"{CHOPPED}O\tonion\nS\tchoppped\nM\tstir\nO\tonion\nS\tmixed\n//\n"
TABLE = "[tool.foon-asp.lint]\n"


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Give an empty folder to work in."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


def write(name: str, text: str) -> Path:
    file = Path(name)
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_bytes(text.encode())
    return file


def codes(cli: Cli, *words: str | Path) -> list[tuple[str, str]]:
    return [(f["code"], f["severity"]) for f in cli("lint", *words, "--format", "json").json["findings"]]


def feed(monkeypatch: pytest.MonkeyPatch, text: str) -> None:
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(text.encode())))


# --- settings


def test_settings_choose_codes_and_severities(folder: Path, cli: Cli) -> None:
    write("recipes/old/a.txt", SLIP)
    write("recipes/b.txt", SLIP.replace("gamelle", "kaskade"))
    here = ["space-for-tab", "unknown-container"]
    assert codes(cli, "recipes") == [(here[0], "warning"), (here[1], "note")] * 2
    settings = write("pyproject.toml", f'{TABLE}ignore = ["unknown-container"]\n')
    assert codes(cli, "recipes") == [(here[0], "warning")] * 2
    assert (
        codes(cli, "recipes", "--select", here[1]) == [(here[1], "note")] * 2
    )  # what is asked for is asked for
    assert codes(cli, "recipes", "--ignore", here[0]) == []
    settings.write_text(
        f'{TABLE}select = ["space-for-tab"]\n'
        '[tool.foon-asp.lint.per-file]\n"recipes/old" = ["space-for-tab"]\n"recipes" = ["syntax"]\n'
        '[tool.foon-asp.lint.severity]\nspace-for-tab = "note"\n'
    )
    assert codes(cli, "recipes") == [(here[0], "note")]
    assert cli("lint", "recipes").code == 0
    # the nearest settings, and those of foon-asp.toml first; a pyproject.toml without any is passed over
    write("recipes/pyproject.toml", "[project]\n")
    assert codes(cli, "recipes") == [(here[0], "note")]
    write("recipes/foon-asp.toml", f'{TABLE}select = ["unknown-container"]\n')
    assert codes(cli, "recipes") == [(here[1], "note")] * 2
    assert find_settings([Path("recipes/b.txt")]).file == Path("recipes/foon-asp.toml")


@pytest.mark.parametrize(
    ("text", "places"),
    [
        (f"{TABLE}select = [\n", []),  # not TOML, whose end is where it is: Pythons differ
        (f'# select\n[tool]\nx = "near-nam"\n{TABLE}select = ["syntax", "near-nam"]\n', ["5:22"]),
        ('tool.foon-asp.lint.ignore = "syntax"\n', ["1:20"]),
        ('tool = {foon-asp = {lint = {ignored = ["x"]}}}\n', ["1:29"]),
        (f'{TABLE}per-file = {{"*.txt" = ["typo"]}}\n', ["2:25"]),
        (f'{TABLE}severity = {{syntax = "bad", typo = "note"}}\n', ["2:13", "2:29"]),
        (f'{TABLE}severity = 3\nselect = [3]\r\nper-file = ["a"]\n', ["2:1", "3:1", "4:1"]),
        ('[tool.foon-asp]\nlint = "yes"\n', ["2:1"]),
        (f'{TABLE}"\\u0069gnored" = []\n', ["1:7"]),  # spelt otherwise: where the table begins
    ],
)
def test_what_is_wrong_in_settings_is_said_with_its_place(folder: Path, text: str, places: list[str]) -> None:
    file = write("foon-asp.toml", text)
    with pytest.raises(InputError) as error:
        read_settings(file)
    found = [diagnostic.source for diagnostic in error.value.diagnostics]
    assert {source.file for source in found} == {"foon-asp.toml"}
    rows = text.replace("\r\n", "\n").split("\n")
    assert all(1 <= source.column <= len(rows[source.line - 1]) + 1 for source in found)
    assert not places or [f"{source.line}:{source.column}" for source in found] == places


def test_settings_that_would_be_dropped_are_refused(folder: Path, cli: Cli) -> None:
    write("foon-asp.toml", '[lint]\nselect = ["syntax"]\n')
    ran = cli("lint", write("a.txt", SLIP))
    assert ran.code == 2
    assert "foon-asp.toml:1:2: error: found the table [lint], expected [tool.foon-asp.lint]" in ran.err


# --- comments


def test_comments_silence_the_next_line(folder: Path, cli: Cli) -> None:
    comment = "# noqa: space-for-tab\n\n# said by the annotator\n"
    file = write("a.txt", SLIP.replace("S\tin", f"{comment}S\tin"))
    assert codes(cli, file) == [("unknown-container", "note")]
    file.write_text(SLIP.replace("S\tin", "#noqa\nS\tin"))
    assert codes(cli, file) == []
    both = "# NOQA:unknown-container, space-for-tab\n"
    file.write_text(SLIP.replace("S\tin", f"{both}S\tin").replace("\n", "\r\n"))
    assert codes(cli, file) == []


def test_a_comment_that_silences_nothing_is_reported(folder: Path, cli: Cli) -> None:
    file = write("a.txt", "# noqa: syntax\nO\tonion\n# noqa: typo\nM\tchop\nO\tonion\nS\tcut\n//\n# noqa\n")
    found = cli("lint", file, "--format", "json").json["findings"]
    assert [(f["code"], f["line"]) for f in found] == [("noqa", 1), ("noqa", 3), ("noqa", 8)]
    nothing = write(
        "c.txt", "# noqa: space-for-tab\n" + SLIP.replace("\t[gamelle]", "").replace("in [", "in\t[")
    )
    assert ("noqa", "warning") in codes(cli, nothing, write("b.txt", SLIP))
    # what is left out otherwise is there to be silenced
    file.write_text(SLIP.replace("S\tin", "# noqa: space-for-tab\nS\tin"))
    write("foon-asp.toml", f'{TABLE}ignore = ["space-for-tab", "unknown-container"]\n')
    assert codes(cli, file) == []


# --- a baseline


def test_only_new_findings_fail(folder: Path, cli: Cli) -> None:
    file = write("recipes/a.txt", SLIP)
    assert "known.json: there is no such file, expected" in cli("lint", file, "--baseline", "known.json").err
    wrote = cli("lint", file, "--baseline", "known.json", "--write-baseline")
    assert (wrote.code, wrote.out) == (0, "")
    baseline = valid(json.loads(Path("known.json").read_text()))
    assert [entry["file"] for entry in baseline["known"]] == ["recipes/a.txt"] * 2
    again = cli("lint", file, "--baseline", "known.json")
    assert (again.code, again.out, again.err) == (0, "1 file: nothing found\n", "2 known findings left out\n")
    # elsewhere in the file, and named from elsewhere, it is known; a second of its kind is new
    file.write_text(f"# new\n{CHOPPED}{SLIP}")
    assert cli("lint", file.resolve(), "--baseline", Path("known.json").resolve()).code == 0
    file.write_text(SLIP.replace("M\tchop", "O\ttea\nS\tin [gamelle]\nM\tchop"))
    ran = cli("lint", file, "--baseline", "known.json", "--format", "json")
    assert (ran.code, [f["line"] for f in ran.json["findings"]]) == (1, [4])
    file.write_text(CHOPPED)
    assert "2 in the baseline are gone" in cli("lint", file, "--baseline", "known.json").err


def test_what_is_no_baseline_is_refused(folder: Path, cli: Cli) -> None:
    file = write("a.txt", SLIP)
    wrong = (
        "[]",
        '{"schema": "foon-asp/lint/1"}',
        '{"schema": "foon-asp/lint-baseline/1", "known": 3}',
        '{"schema": "foon-asp/lint-baseline/1", "known": [{"file": "a", "code": 3, "text": "", "count": 1}]}',
    )
    for text in wrong:
        ran = cli("lint", file, "--baseline", write("known.json", text))
        assert (ran.code, "expected a baseline" in ran.err) == (2, True)


def test_a_baseline_replaces_nothing_but_a_baseline(folder: Path, cli: Cli) -> None:
    file, words = write("a.txt", SLIP), ("--write-baseline", "--baseline", "notes.json")
    notes = write("notes.json", "notes of mine")
    ran = cli("lint", file, *words)
    assert (ran.code, notes.read_text()) == (2, "notes of mine")
    assert "notes.json: is no baseline, and is not replaced by one" in ran.err
    for text in ("", None):
        if text is not None:
            notes.write_text(text)
        assert cli("lint", file, *words).code == 0
    assert cli("lint", file, "--baseline", "notes.json").out == "1 file: nothing found\n"


# --- standard input, fixes and diffs


def test_standard_input_stands_for_a_file(folder: Path, cli: Cli, monkeypatch: pytest.MonkeyPatch) -> None:
    write("a.txt", SLIP)
    write("foon-asp.toml", f'{TABLE}[tool.foon-asp.lint.per-file]\n"b.txt" = ["space-for-tab"]\n')
    feed(monkeypatch, SLIP)
    found = cli("lint", "a.txt", "-", "--stdin-filename", "b.txt", "--format", "json").json["findings"]
    assert [(f["file"], f["code"]) for f in found] == [
        ("a.txt", "space-for-tab"),
        ("a.txt", "unknown-container"),
    ]
    feed(monkeypatch, CHOPPED)
    assert cli("lint", "a.txt", "-", "--stdin-filename", "a.txt").out == "1 file: nothing found\n"
    feed(monkeypatch, SLIP)
    ran = cli("lint", "-", "--fix")
    assert ran.out == SLIP.replace(" [", "\t[")
    assert "<stdin>:2:7: note" in ran.err
    assert Path("a.txt").read_text() == SLIP


def test_a_diff_is_what_fixing_does(folder: Path, cli: Cli) -> None:
    file = write("a.txt", SLIP.replace("//\n", "").replace("\n", "\r\n"))
    before = file.read_bytes()
    ran = cli("lint", file, "--diff")
    assert (ran.code, file.read_bytes()) == (1, before)
    assert cli("lint", file, "--fix").code == 0
    assert ran.out == line_diff("a.txt", before.decode(), file.read_bytes().decode())
    assert cli("lint", file, "--diff") == (0, "", "would mend 0 findings in 0 files\n")


@pytest.mark.skipif(which("patch") is None, reason="there is no patch here")
def test_patch_applies_a_diff(folder: Path) -> None:
    for before, after in (
        ("a\nb\n", "a\nc"),
        ("a", "b\n"),
        ("", "a\n"),
        ("a\r\nb\n", "a\r\nc\n"),
        ("a\x0cb", "c"),
    ):
        write("a.txt", before)
        diff = line_diff("a.txt", before, after)
        subprocess.run(["patch", "-p0", "--binary", "-s"], input=diff.encode(), check=True, timeout=20)
        assert (Path("a.txt").read_bytes() if Path("a.txt").exists() else b"") == after.encode()


def test_the_name_that_is_known_is_written_for_the_one_that_is_not(tmp_path: Path, cli: Cli) -> None:
    slips = "O\tonion\nS\tin\t[onio onions]\nM\tchop\nO\tonion\nS\tchoped\n//\nO\tsalt\nS\tchopped\n"
    slips += (
        "M\tspriknle\nO\tonion\nS\tunccracked\n//\n"  # one near a name of the file, three near known words
    )
    file = tmp_path / "a.txt"
    file.write_text(slips)
    assert cli("lint", file, "--fix", "--unsafe-fixes").code == 0
    mended = slips.replace("onio ", "onion ").replace("choped", "chopped").replace("spriknle", "sprinkle")
    assert file.read_text() == mended.replace("unccracked", "uncracked")


def test_unsafe_fixes_are_only_made_when_asked_for(folder: Path, cli: Cli) -> None:
    file = write("a.txt", "\ufeff" + NEAR)
    ran = cli("lint", file, "--fix")
    assert (ran.code, file.read_text(encoding="utf-8")) == (1, "\ufeff" + NEAR)
    assert ran.out.endswith("1 file: 1 warning; --unsafe-fixes 1\n")
    found = cli("lint", file, "--format", "json").json["findings"]
    assert [(f["mendable"], f["unsafe"]) for f in found] == [(False, True)]
    assert cli("lint", file, "--fix", "--unsafe-fixes").code == 0
    assert file.read_text(encoding="utf-8") == "\ufeff" + NEAR.replace("ppp", "pp")
    once = NEAR.replace("S\tchopped\n//", "//").replace("S\tchopped", "S\tchopped\nS\tpeeled", 1)
    file.write_text(once.replace("cho", "zwo"))
    assert cli("lint", file).out.endswith("1 file: 1 warning\n")  # each stands once: which is the slip?
    file.write_text(CHOPPED.replace("fried", "Frieed"))
    assert cli("lint", file).out.endswith("1 file: 1 warning\n")  # how is it spelt?


def test_statistics_count_by_code(folder: Path, cli: Cli) -> None:
    ran = cli("lint", write("a.txt", SLIP + SLIP), "--statistics")
    assert [line.split()[:3] for line in ran.out.splitlines()[1:-1]] == [
        ["2", "warning", "space-for-tab"],
        ["1", "note", "unknown-container"],
        ["1", "warning", "duplicate-unit"],
    ]
    assert "2 safely" in ran.out
    assert cli("lint", write("b.txt", CHOPPED), "--statistics").out == "1 file: nothing found\n"


@pytest.mark.parametrize(
    "words",
    [
        ("--fix", "--diff"),
        ("--unsafe-fixes",),
        ("--write-baseline",),
        ("--write-baseline", "--baseline", "x", "--fix"),
        ("--statistics", "--format", "json"),
        ("--diff", "--format", "json"),
        ("--stdin-filename", "x"),
        ("--fix", "--format", "sarif", "-"),
    ],
)
def test_options_that_do_not_go_together(folder: Path, cli: Cli, words: tuple[str, ...]) -> None:
    ran = cli("lint", write("a.txt", SLIP), *words)
    assert (ran.code, ran.err.startswith("error: --")) == (2, True)


def test_sarif_has_the_shape_that_is_published(folder: Path, cli: Cli) -> None:
    file = write("my recipes/a.txt", SLIP + NEAR.replace("//\n", ""))
    ran = cli("lint", file, "--format", "sarif")
    document: Any = json.loads(ran.out)
    assert (document["version"], document["$schema"].rsplit("/", 1)[-1]) == (
        "2.1.0",
        "sarif-2.1.0.json",
    )
    (run,) = document["runs"]
    assert (run["tool"]["driver"]["name"], run["columnKind"]) == ("foon-asp", "unicodeCodePoints")
    listed = cli("lint", file, "--format", "json").json["findings"]
    assert [r["ruleId"] for r in run["results"]] == [f["code"] for f in listed]
    rules = run["tool"]["driver"]["rules"]
    assert all(rules[result["ruleIndex"]]["id"] == result["ruleId"] for result in run["results"])
    result = next(r for r in run["results"] if r["ruleId"] == "space-for-tab")
    place = result["locations"][0]["physicalLocation"]
    assert place["artifactLocation"]["uri"] == "my%20recipes/a.txt"
    assert (place["region"]["startLine"], place["region"]["startColumn"]) == (2, 5)
    (replacement,) = result["fixes"][0]["artifactChanges"][0]["replacements"]
    assert replacement == {
        "deletedRegion": {"startLine": 2, "startColumn": 1, "endColumn": 15},
        "insertedContent": {"text": "S\tin\t[gamelle]"},
    }
    assert result["level"] == "warning"
    assert {key for each in run["results"] for key in each} == {
        *("ruleId", "ruleIndex", "level", "message", "locations", "fixes")
    }


def test_the_hooks_call_verbs_that_there_are(cli: Cli) -> None:
    text = (ROOT / ".pre-commit-hooks.yaml").read_text(encoding="utf-8")
    hooks = pytest.importorskip("yaml").safe_load(text)
    assert {hook["id"] for hook in hooks} == {"foon-asp-lint", "foon-asp-fmt"}
    for hook in hooks:
        program, *words = hook["entry"].split()
        assert (program, cli(*words, "--help").code, hook["pass_filenames"]) == ("foon-asp", 0, False)


def test_of_a_misspelt_kind_the_nearest_is_named(cli: Cli, tmp_path: Path) -> None:
    assert (
        "there is no code 'near-nam'; docs/lint.md lists them; did you mean 'near-name'?"
        in cli("lint", tmp_path, "--select", "near-nam").err
    )
    assert "docs/lint.md lists them" in cli("lint", tmp_path, "--ignore", "xyz").err
