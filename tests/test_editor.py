"""``foon-asp lsp``: what an editor is told, driven as a client over standard input and output."""

import json
import re
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from foon_asp.editor.edited_text import EditedText
from foon_asp.editor.name_place import names_in, typed_at
from foon_asp.lint.linter import lint
from foon_asp.lint.sheet import Sheet
from foon_asp.text.formatter import format_text
from foon_asp.text.reader import FoonReader
from foon_asp.text.renaming import line_names
from tests.conftest import ROOT, Cli
from tests.language_client import LanguageClient, Text, edited
from tests.text.foon_strategies import steady, texts

SOUP = (
    "O1\tonion\t0\nS2\twhole\nO3\tknife\t1\nM4\tchop\t0:01\t0:02\nO1\tonion\t0\nS5\tchopped\n//\n"
    "O1\tonion\t0\nS5\tchopped\nO7\tpot\t0\nM6\tput\nO7\tpot\t0\nS8\tcontains\t{onion}\n//\n"
)


# --- a text that is edited, without a server


def shape(text: EditedText) -> object:
    """Give everything that a text knows of itself."""
    makers, needers = (
        {node: sorted(start for start, _ in text.where(pieces)) for node, pieces in index.items() if pieces}
        for index in (text.makers, text.needers)
    )
    pieces = [(piece.lines, piece.is_closed, piece.motion, piece.blocks) for piece in text.pieces]
    ids = {name: +found for name, found in text.ids.items() if +found}
    counts = dict(text.counts), +text.holding
    return text.lines, text.starts, pieces, counts, ids, makers, needers, text.is_list


@settings(steady, max_examples=25)
@given(text=texts(), more=texts(), data=st.data())
def test_a_change_gives_what_reading_it_all_gives(text: str, more: str, data: st.DataObject) -> None:
    here = EditedText(text)
    for _ in range(3):
        lines = len(here.lines)
        start, end = sorted(data.draw(st.tuples(*[st.integers(0, lines - 1)] * 2)))
        columns = [data.draw(st.integers(0, len(here.lines[line]))) for line in (start, end)]
        if start == end:
            columns.sort()
        piece = data.draw(st.sampled_from(["", "//", "\n//\n", "M\tx", "\n", more]))
        before = here.lines
        between = before[start][: columns[0]] + piece + before[end][columns[1] :]
        expected = [*before[:start], between, *before[end + 1 :]]
        here.change((start, columns[0]), (end, columns[1]), piece)
        if here.is_json:
            return
        whole = EditedText("\n".join(expected).replace("\r\n", "\n").replace("\r", "\n"))
        if whole.is_json:
            return
        assert shape(here) == shape(whole)


def many(count: int) -> str:
    return "".join(f"O\tonion {n}\nS\twhole\nM\tchop\nO\tonion {n}\nS\tchopped\n//\n" for n in range(count))


def test_a_keystroke_reads_one_unit() -> None:
    text = EditedText(many(50))
    before = list(text.pieces)
    text.change((6 * 20 + 1, 2), (6 * 20 + 1, 7), "peeled")
    assert [n for n, (old, new) in enumerate(zip(before, text.pieces, strict=True)) if old is not new] == [20]
    text.change((6 * 20 + 5, 0), (6 * 20 + 5, 2), "")  # without its separator, two units are one
    assert len(text.pieces) == len(before) - 1
    assert text.pieces[21:] == before[22:]
    assert [finding.code for _, finding in text.findings(0, len(text.lines))] == ["second-motion"]


SHEET = Sheet("a.txt", ["S\twhole"] * 60_000, FoonReader())


def lint_finding(line: int) -> Any:
    return SHEET.finding("near-name", "x", line, "whole")


def told(text: EditedText) -> list[tuple[int, int, int, str]]:
    """Give the findings that an editor is told of, with their lines and columns."""
    answers = pytest.importorskip("foon_asp.editor.answers", reason="pygls is not installed (foon-asp[lsp])")
    parts = list(answers.diagnostics(text, answers.Columns("utf-16")))
    ranges = [(each["range"], each["code"]) for each in json.loads(f"[{','.join(filter(None, parts))}]")]
    assert all(place["start"]["line"] == place["end"]["line"] for place, _ in ranges)
    return [
        (place["start"]["line"], place["start"]["character"], place["end"]["character"], code)
        for place, code in ranges
    ]


def test_findings_that_were_told_move_with_their_lines(monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("pygls", reason="pygls is not installed (foon-asp[lsp])")
    monkeypatch.setattr("foon_asp.editor.answers._PART", 7)
    text = EditedText(many(60))
    text.linted((6 * n + 1, lint_finding(6 * n + 1)) for n in range(0, 60, 2))
    place = (2, 7, "near-name")  # of "whole"
    assert told(text) == [(6 * n + 1, *place) for n in range(0, 60, 2)]
    text.change((6 * 20 + 1, 0), (6 * 20 + 1, 0), "S\t\U0001f52a\nM\n")  # two lines more, in a new piece
    after = [(6 * n + 1, *place) for n in range(0, 20, 2)], [(6 * n + 3, *place) for n in range(22, 60, 2)]
    assert told(text) == [*after[0], (122, 0, 1, "syntax"), *after[1]]
    text.change((0, 0), (6 * 20, 0), "")
    assert [line for line, *_ in told(text)][:2] == [2, 15]
    text.linted([(3, lint_finding(3))])  # what was told before is forgotten
    assert [line for line, *_ in told(text)] == [3]


@pytest.mark.slow
def test_ten_thousand_units_answer_a_keystroke_in_time() -> None:
    answers = pytest.importorskip("foon_asp.editor.answers", reason="pygls is not installed (foon-asp[lsp])")
    text, columns = EditedText(many(10_000)), answers.Columns("utf-16")
    text.linted((6 * n, lint_finding(6 * n)) for n in range(10_000))
    assert len(told(text)) == 10_000
    seconds = []
    for n in range(10):
        start = time.process_time()
        text.change((600 * n + 1, 7), (600 * n + 1, 7), "x")
        assert any(answers.diagnostics(text, columns))
        assert answers.completion(text, columns, 600 * n + 1, 4).items
        seconds.append(time.process_time() - start)
    assert min(seconds) < 0.1


@pytest.mark.parametrize(
    ("text", "code"),
    [
        (SOUP.replace("S5\tchopped\n//", "S5 chopped\n//"), "space-for-tab"),
        (SOUP.replace("M4\tchop\t0:01\t0:02\n", ""), "no-motion"),
        (SOUP[:-3], "missing-separator"),
        (SOUP.replace("//", "zzz", 1), "syntax"),
        (SOUP.replace("O7\tpot\t0\nM6", "# noqa: outer-space\nO7\tpot \t0\nM6"), None),
    ],
)
def test_what_a_new_unit_says_is_what_linting_says_of_it(tmp_path: Path, text: str, code: str | None) -> None:
    here = EditedText("")
    here.change((0, 0), (0, 0), text)
    file = tmp_path / "a.txt"
    linted = [(f.source.line - 1, f.code, f.fix) for f in lint([file], {file: text.encode()})]
    said = [(line, f.code, f.fix) for line, f in here.findings(0, len(here.lines))]
    assert (code in {c for _, c, _ in said}) if code else said == []
    assert set(said) <= set(linted)


@settings(steady, max_examples=30)
@given(text=texts())
def test_names_stand_where_the_reader_finds_them(text: str) -> None:
    reader = FoonReader()
    for line in text.replace("\r", "\n").split("\n"):
        parsed = reader.parse(line) if line[:1] in {"O", "S", "M"} else None
        if parsed is None or isinstance(parsed, Exception) or parsed.remarks:
            continue
        places = names_in(line)
        assert sorted(place.name for place in places) == sorted((k, n) for k, n, _ in line_names(parsed))
        for place in places:
            assert line[place.start : place.end] == place.name.name
            typed = typed_at(line, place.end)
            assert typed is not None
            assert (typed.start, typed.end) == (place.start, place.end)


# --- the server


@pytest.fixture(scope="module")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[LanguageClient]:
    """Start a server for all tests, as it serves an editor with many files; in the end it ends as asked."""
    pytest.importorskip("pygls", reason="pygls is not installed (foon-asp[lsp])")
    client = LanguageClient(
        tmp_path_factory.mktemp("editor"), textDocument={"rename": {"prepareSupport": True}}
    )
    try:
        yield client
        assert client.end() == 0
    finally:
        client.kill()


@pytest.fixture
def client(server: LanguageClient) -> LanguageClient:
    """Give the server, from which nothing is heard of earlier texts."""
    server.silence()
    return server


def codes(found: list[dict[str, Any]]) -> list[tuple[int, str]]:
    return [(each["range"]["start"]["line"], each["code"]) for each in found]


@pytest.mark.slow
def test_a_session_in_an_editor(client: LanguageClient, tmp_path: Path) -> None:
    (tmp_path / "kitchen.txt").write_text("O\tonion\nS\twhole\nO\tknife\n")
    (tmp_path / "foon-asp.toml").write_text('[tool.foon-asp.lint]\nignore = ["no-effect"]\n')
    text = Text(client, tmp_path / "soup.txt", SOUP)
    assert codes(client.findings()) == []
    # who makes and who needs a node, and is it at hand
    hovered = text.ask("hover", 8, 4)["contents"]["value"].split("\n\n")
    assert hovered == [
        "**onion; chopped**",
        "made by chop (line 1)",
        "needed by put (line 8)",
        "not in the kitchen",
        "state 'chopped': 2 times",
    ]
    assert "at hand: the kitchen has it" in text.ask("hover", 0, 4)["contents"]["value"]
    (maker,) = text.ask("definition", 7, 4)
    assert (maker["uri"], maker["range"]["start"]["line"]) == (text.uri, 4)
    assert text.ask("definition", 0, 4) == []
    # the outline, and what can be folded
    outline = text.whole("documentSymbol")
    assert [(unit["name"], unit["detail"]) for unit in outline] == [("chop", "→ onion"), ("put", "→ pot")]
    assert [(unit["startLine"], unit["endLine"]) for unit in text.whole("foldingRange")] == [(0, 5), (7, 12)]
    # typing: the findings are there when it pauses, and those of the whole text when it rests
    text.change((9, 0), (9, 0), "O7\tpan\tx\n")
    assert (9, "motion-flag") in codes(client.findings())
    assert {(9, "motion-flag"), (9, "id-of-two-names")} <= {*codes(client.findings())}

    def told_while_typing() -> list[Any]:
        """Type five lines that cannot be read, and ask at each; give what was told before the last answer."""
        for _ in range(5):
            text.change((0, 0), (0, 0), "zzz\n")
            text.ask("completion", 6, 0)
        told = [*client.told]
        while sum(code == "syntax" for _, code in codes(client.findings())) < text.text.count("zzz"):
            pass
        return told

    assert any(told_while_typing() == [] for _ in range(3))  # thrice, should the machine stand still


@pytest.mark.slow
def test_findings_that_stay_as_they_are_are_told_again_only_when_all_is_linted(
    client: LanguageClient, tmp_path: Path
) -> None:
    text = Text(client, tmp_path / "soup.txt", f"zzz\n{SOUP}")
    before = client.findings()
    text.change((0, 0), (0, 0), "z")
    text.change((0, 0), (0, 1), "")
    changed = time.monotonic()
    assert client.findings() == before
    assert time.monotonic() - changed > 0.4  # not when it pauses, but when it rests


def test_completion_knows_kinds_counts_and_ids(client: LanguageClient, tmp_path: Path) -> None:
    text = Text(client, tmp_path / "soup.txt", SOUP + "O\to\nS\tch\nS\tcon\nS8\tcontains\t{onion,p\nM1\nO\n")

    def offered(line: int, column: int) -> dict[str, str]:
        found = {}
        for item in text.ask("completion", line, column)["items"]:
            edits = [item["textEdit"], *item.get("additionalTextEdits", ())]
            found[item["label"]] = edited(text.text, edits).split("\n")[line]
        return found

    assert offered(14, 3) == {"onion": "O1\tonion", "pot": "O7\tpot"}
    assert offered(15, 4) == {"chopped": "S5\tchopped"}
    assert offered(16, 5) == {"contains": "S8\tcontains\t{"}
    assert offered(17, 20) == {"pot": "S8\tcontains\t{onion,pot"}
    text.change((18, 1), (18, 2), "4")
    assert offered(18, 2) == {"M4 chop": "M4\tchop"}
    assert offered(19, 1) == {"O": "O\t"}
    assert offered(20, 0) == {"O": "O\t", "S": "S\t", "M": "M\t", "//": "//"}
    assert offered(3, 9) == {}  # a time


def test_renaming_formatting_and_quick_fixes(client: LanguageClient, tmp_path: Path) -> None:
    source = SOUP.replace("O3\tknife", "O3\tmes🔪ser").replace("S5\tchopped\n//\n", "S5 choped  \n//\n", 1)
    source += "O1\tonion\t0\nS5\tchopped\nM9\tfry*\nO1\tonion\t0\nS5\tchopped\nS6\tfried\n"
    text = Text(client, tmp_path / "soup.txt", source)
    client.findings()

    def applied(edit: dict[str, Any]) -> str:
        return edited(text.text, edit["changes"][text.uri])

    assert text.ask("prepareRename", 2, 10)["end"] == {"line": 2, "character": 11}
    renamed = text.ask("rename", 2, 4, newName="knife")
    assert applied(renamed) == source.replace("mes🔪ser", "knife")
    assert applied(text.ask("rename", 16, 4, newName="bake")) == source.replace("fry*", "bake*")
    assert text.ask("prepareRename", 6, 1) is None
    assert text.ask("rename", 0, 4, newName="[x]") is None
    assert "cannot be a name" in client.wait("window/showMessage")["message"]
    options = {"tabSize": 4, "insertSpaces": False}
    formatted = edited(text.text, text.whole("formatting", options=options))
    assert formatted == format_text(source, "soup.txt").text
    # quick fixes, each of which is taken
    everything = {"start": {"line": 0, "character": 0}, "end": {"line": 99, "character": 0}}
    actions = text.whole("codeAction", range=everything, context={"diagnostics": []})
    by_title = {action["title"]: action for action in actions}
    silencing = [title.startswith("Silence") for title in by_title]
    assert silencing == sorted(silencing)  # what mends comes first
    after = applied(by_title["Write 'chopped' for the state 'choped' everywhere in this file"]["edit"])
    assert after.count("chopped") == 4
    mended = next(title for title in by_title if title.startswith("Mend: no tab after S5"))
    assert "S5\tchoped\n" in applied(by_title[mended]["edit"])
    closed = next(title for title in by_title if title.startswith("Mend: the last unit"))
    assert applied(by_title[closed]["edit"]) == source + "//\n"
    silenced = applied(by_title["Silence near-name on this line"]["edit"])
    assert "# noqa: near-name\nS5 choped" in silenced
    assert by_title[mended]["isPreferred"] is True


def test_settings_that_are_wrong_are_said_once(client: LanguageClient, tmp_path: Path) -> None:
    (tmp_path / "foon-asp.toml").write_text('[tool.foon-asp.lint]\nselect = ["typo"]\n')
    text = Text(client, tmp_path / "soup.txt", SOUP)
    assert "there is no code 'typo'" in client.wait("window/showMessage")["message"]
    text.change((0, 0), (0, 0), "zzz\n")
    assert codes(client.findings()) == [(0, "syntax")]


def test_json_is_linted_whole(client: LanguageClient, tmp_path: Path) -> None:
    source = '[\n {"input_nodes": [], "motion_node": "chop",\n  "output_nodes": [{"label": "a"}]}]\n'
    text = Text(client, tmp_path / "soup.json", source)
    assert codes(client.findings()) == [(1, "no-inputs")]
    assert (text.ask("hover", 0, 0), text.ask("completion", 2, 5)["items"]) == (None, [])
    text.change((0, 0), (3, 0), "[]")
    assert codes(client.findings()) == []  # they stay until it is linted


@pytest.mark.slow
def test_places_count_as_the_editor_wants(tmp_path: Path) -> None:
    pytest.importorskip("pygls", reason="pygls is not installed (foon-asp[lsp])")
    client = LanguageClient(tmp_path, general={"positionEncodings": ["utf-8", "utf-16"]})
    try:
        assert client.capabilities["positionEncoding"] == "utf-8"
        text = Text(client, tmp_path / "a.txt", "O\té🔪\nM\tput\nO\té🔪\n//\n")
        assert text.ask("prepareRename", 0, 3)["end"]["character"] == 2 + len("é🔪".encode())
    finally:
        client.kill()


def test_without_its_library_lsp_says_what_to_install(cli: Cli, monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("pygls", "lsprotocol"):
        monkeypatch.setitem(sys.modules, name, None)
    monkeypatch.delitem(sys.modules, "foon_asp.editor.server", raising=False)
    ran = cli("lsp")
    assert (ran.code, "pip install 'foon-asp[lsp]'" in ran.err) == (2, True)


# --- the syntax definition


GRAMMAR = json.loads((ROOT / "docs" / "foon.tmLanguage.json").read_text(encoding="utf-8"))


def scopes(line: str) -> list[tuple[str, str]]:
    """Give the parts of a line that the grammar names, as an editor would."""
    for pattern in GRAMMAR["patterns"]:
        if match := re.match(pattern["match"], line):
            if not match.groups():
                return [(match[0], pattern["name"])]
            named = pattern["captures"].items()
            return [(match[int(n)], scope["name"]) for n, scope in named if match[int(n)] is not None]
    return []


@pytest.mark.parametrize(
    ("line", "parts"),
    [
        ("# noqa: syntax", [("# noqa: syntax", "comment.line.number-sign.foon")]),
        ("//", [("//", "punctuation.separator.unit.foon")]),
        ("O12\tred onion\t1\t!", ["O keyword", "12 constant", "red onion variable", "1\t! constant"]),
        ("S\twhole", ["S keyword", "whole string"]),
        ("S3\tin\t[bowl]", ["S keyword", "3 constant", "in storage", "bowl variable"]),
        ("S\tcontains\t{salt,red onion}", ["S keyword", "contains storage", "salt,red onion variable"]),
        ("M4\tpour*\t0:12\tAssumed", ["M keyword", "4 constant", "pour* entity", "0:12\tAssumed constant"]),
    ],
)
def test_the_grammar_names_the_parts_of_lines(line: str, parts: list[Any]) -> None:
    found = [(part, scope) for part, scope in scopes(line) if part]
    if isinstance(parts[0], str):
        assert [f"{part} {scope.split('.')[0]}" for part, scope in found] == parts
    else:
        assert found == parts


@settings(steady, max_examples=20)
@given(text=texts())
def test_the_grammar_knows_every_line_that_is_as_it_should_be(text: str) -> None:
    reader = FoonReader()
    for line in text.replace("\r", "\n").split("\n"):
        parsed = reader.parse(line) if line[:1] in {"O", "S", "M"} else None
        if parsed is not None and not isinstance(parsed, Exception) and not parsed.remarks:
            assert scopes(line)[0][0] == line[0]
