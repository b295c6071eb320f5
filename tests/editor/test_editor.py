"""``foon-asp lsp``: what an editor is told, driven as a client over standard input and output."""

import json
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from foon_asp.editor.edited_text import EditedText
from foon_asp.editor.field import field_at
from foon_asp.text.formats import format_of
from foon_asp.text.line import line_names
from foon_asp.text.plain_file import split_lines
from foon_asp.text.reader import FoonReader
from tests.conftest import ROOT
from tests.support.damaged_json import damaged
from tests.support.language_client import LanguageClient, Text, edited
from tests.text.foon_strategies import steady, texts

SOUP = (
    "O1\tonion\t0\nS2\twhole\nO3\tknife\t1\nM4\tchop\t0:01\t0:02\nO1\tonion\t0\nS5\tchopped\n//\n"
    "O1\tonion\t0\nS5\tchopped\nO7\tpot\t0\nM6\tput\nO7\tpot\t0\nS8\tcontains\t{onion}\n//\n"
)


@settings(steady, max_examples=30)
@given(text=texts())
def test_names_stand_where_the_reader_finds_them(text: str) -> None:
    reader = FoonReader()
    for line in text.replace("\r", "\n").split("\n"):
        parsed = reader.parse(line) if line[:1] in {"O", "S", "M"} else None
        if parsed is None or isinstance(parsed, Exception) or parsed.remarks:
            continue
        fields = [field for at in range(len(line) + 1) if (field := field_at(line, at)) and field.name]
        assert {(field.kinds[0], field.name) for field in fields} == {
            (k, n) for k, n, _ in line_names(parsed)
        }
        for field in fields:
            assert field.name in line[field.start : field.end]


@settings(steady, max_examples=50)
@given(text=texts(), other=texts(), end=st.sampled_from(["\n", "\r\n"]))
def test_edits_bring_about_other_lines(text: str, other: str, end: str) -> None:
    before, after = (split_lines(each) for each in (text, other))
    edits = EditedText("file:///a", end.join(before)).edits_to(after)
    assert edited("\n".join(before), edits).replace("\r\n", "\n") == "\n".join(after)


# --- the server


@pytest.fixture(scope="module")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[LanguageClient]:
    """Start a server for all tests, as it serves an editor with many files; in the end it ends as asked."""
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
    assert "available: it is in the kitchen" in text.ask("hover", 0, 4)["contents"]["value"]
    (maker,) = text.ask("definition", 7, 4)
    assert (maker["uri"], maker["range"]["start"]["line"]) == (text.uri, 4)
    assert text.ask("definition", 0, 4) == []
    # the outline, and what can be folded
    outline = text.whole("documentSymbol")
    assert [(unit["name"], unit["detail"]) for unit in outline] == [("chop", "→ onion"), ("put", "→ pot")]
    assert [(unit["startLine"], unit["endLine"]) for unit in text.whole("foldingRange")] == [(0, 5), (7, 12)]
    # typing: the findings are there when it rests
    text.change((9, 0), (9, 0), "O7\tpan\tx\n")
    assert {(9, "motion-flag"), (9, "id-of-two-names")} <= {*codes(client.findings())}


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
    with pytest.raises(AssertionError, match="cannot be a name"):
        text.ask("rename", 0, 4, newName="[x]")
    options = {"tabSize": 4, "insertSpaces": False}
    formatted = edited(text.text, text.whole("formatting", options=options))
    assert formatted == format_of(source).canonical_text(source, "soup.txt")
    # quick fixes, each of which is taken
    everything = {"start": {"line": 0, "character": 0}, "end": {"line": 99, "character": 0}}
    actions = text.whole("codeAction", range=everything, context={"diagnostics": []})
    by_title = {action["title"]: action for action in actions}
    silencing = [title.startswith("Silence") for title in by_title]
    assert silencing == sorted(silencing)  # what mends comes first
    after = applied(by_title["Write 'chopped' for the state 'choped' everywhere in this file"]["edit"])
    assert after.count("chopped") == 4
    mended = next(title for title in by_title if title.startswith("Fix: no tab after S5"))
    assert "S5\tchoped\n" in applied(by_title[mended]["edit"])
    closed = next(title for title in by_title if title.startswith("Fix: the last unit"))
    assert applied(by_title[closed]["edit"]) == source + "//\n"
    silenced = applied(by_title["Silence near-name on this line"]["edit"])
    assert "# noqa: near-name\nS5 choped" in silenced
    assert by_title[mended]["isPreferred"] is True


def test_settings_that_are_wrong_are_said_once(client: LanguageClient, tmp_path: Path) -> None:
    (tmp_path / "foon-asp.toml").write_text('[tool.foon-asp.lint]\nselect = ["typo"]\n')
    text = Text(client, tmp_path / "soup.txt", SOUP)
    assert "there is no code 'typo'" in client.wait("window/showMessage")["message"]
    client.findings()
    text.change((0, 0), (0, 0), "zzz\n")
    assert (0, "syntax") in codes(client.findings())
    assert client.told == []


def test_findings_move_with_their_lines(client: LanguageClient, tmp_path: Path) -> None:
    source = SOUP.replace("O7\tpot\t0\nS8", "O7\tpan\t0\nS8")
    text = Text(client, tmp_path / "soup.txt", source)
    before = codes(client.findings())
    assert (11, "id-of-two-names") in before
    text.change((0, 0), (0, 0), "# lunch\n# for two\n")
    assert codes(client.findings()) == [(line + 2, code) for line, code in before]


def test_json_is_linted_whole(client: LanguageClient, tmp_path: Path) -> None:
    source = '[\n {"input_nodes": [], "motion_node": "chop",\n  "output_nodes": [{"label": "a"}]}]\n'
    text = Text(client, tmp_path / "soup.json", source)
    assert codes(client.findings()) == [(1, "no-inputs")]
    assert (text.ask("hover", 0, 0), text.ask("completion", 2, 5)["items"]) == (None, [])
    text.change((0, 0), (3, 0), "[]")
    assert codes(client.findings()) == []


REQUESTS = (
    *("completion", "hover", "definition", "prepareRename", "rename", "documentSymbol", "foldingRange"),
    *("formatting", "codeAction"),
)


def test_every_request_is_answered(client: LanguageClient, tmp_path: Path) -> None:
    text = Text(client, tmp_path / "a.txt", SOUP)
    client.findings()
    whole = [
        {
            "textDocument": {"uri": uri},
            "position": (place := {"line": line, "character": column}),
            "range": {"start": place, "end": place},
            "newName": "a [b",
            "options": {"tabSize": 2, "insertSpaces": True},
            "context": {"diagnostics": [], "triggerKind": 1},
        }
        for uri in (text.uri, "file:///none", "http://[")
        for line, column in ((0, 3), (9, 2**31 - 1))
    ]

    @settings(steady, max_examples=150, database=None)
    @given(
        method=st.sampled_from(REQUESTS),
        params=st.sampled_from(whole) | damaged(whole),
        number=st.integers(0, 2**31) | st.text(max_size=9),
    )
    def answered(method: str, params: Any, number: object) -> None:
        asked = {"jsonrpc": "2.0", "id": number, "method": f"textDocument/{method}", "params": params}
        said = client.answer(asked)
        assert "error" not in said or said["error"]["code"] == -32602, said

    answered()
    assert len(text.whole("documentSymbol")) == 2


@pytest.mark.parametrize("kind", REQUESTS)
@pytest.mark.parametrize("params", [None, 5, {}, {"textDocument": {"uri": 7}}])
def test_wrong_parameters_are_said(client: LanguageClient, kind: str, params: Any) -> None:
    said = client.answer({"jsonrpc": "2.0", "id": "x", "method": f"textDocument/{kind}", "params": params})
    assert (said["id"], said["error"]["code"]) == ("x", -32602)
    assert "found" in said["error"]["message"]


@pytest.mark.parametrize(
    ("message", "code"),
    [
        ({"jsonrpc": "2.0", "id": 1, "method": "no/such"}, -32601),
        ({"jsonrpc": "2.0", "id": [1], "method": "shutdown"}, -32600),
        ({"jsonrpc": "1.0", "id": 1, "method": "shutdown"}, -32600),
        ({"id": 1, "method": "shutdown"}, -32600),
        ({"jsonrpc": "2.0", "id": 1, "method": "initialize", "params": {"jsonrpc": "2.0", "id": 2}}, -32602),
        (7, -32600),
    ],
    ids=range(6),
)
def test_what_is_no_message_is_refused(client: LanguageClient, message: Any, code: int) -> None:
    assert client.answer(message)["error"]["code"] == code


def test_a_server_that_was_told_to_end_says_so(tmp_path: Path) -> None:
    client = LanguageClient(tmp_path)
    try:
        client.ask("shutdown")
        said = client.answer({"jsonrpc": "2.0", "id": 7, "method": "textDocument/hover", "params": {}})
        assert said["error"]["code"] == -32600
    finally:
        client.kill()


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
        ("//", ["// punctuation"]),
        ("O12\tred onion\t1\t!", ["O keyword", "12 constant", "red onion variable", "1\t! constant"]),
        ("S3\tin\t[bowl]", ["S keyword", "3 constant", "in storage", "bowl variable"]),
        ("M4\tpour*\t0:12\tAssumed", ["M keyword", "4 constant", "pour* entity", "0:12\tAssumed constant"]),
    ],
)
def test_the_grammar_names_the_parts_of_lines(line: str, parts: list[str]) -> None:
    assert [f"{part} {scope.split('.')[0]}" for part, scope in scopes(line) if part] == parts


@settings(steady, max_examples=20)
@given(text=texts())
def test_the_grammar_knows_every_line_that_is_as_it_should_be(text: str) -> None:
    reader = FoonReader()
    for line in text.replace("\r", "\n").split("\n"):
        parsed = reader.parse(line) if line[:1] in {"O", "S", "M"} else None
        if parsed is not None and not isinstance(parsed, Exception) and not parsed.remarks:
            assert scopes(line)[0][0] == line[0]


def test_a_length_that_is_no_number_ends_the_server() -> None:
    words = [sys.executable, "-m", "foon_asp", "lsp"]
    ran = subprocess.run(words, input=b"Content-Length: long\r\n\r\n{}", capture_output=True, check=False)
    assert (ran.returncode, ran.stdout, ran.stderr) == (0, b"", b"")
