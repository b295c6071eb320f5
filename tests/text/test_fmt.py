"""``foon-asp fmt``: canonical form that means the same, byte for byte where there is nothing to mend."""

import json
import stat
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from foon_asp.text.diagnostics import InputError
from foon_asp.text.foon_json_indent import lay_out
from foon_asp.text.formats import format_of
from foon_asp.text.listed_unit import ReadUnit
from foon_asp.text.plain_file import read_plain_text
from foon_asp.text.reader import FoonReader
from tests.conftest import CORPUS, Cli
from tests.text.foon_strategies import steady, texts

CLEAN = "# soup\n//\nO1\twater\t1\nS2\tin\t[pot]\n\nM3\theat*\t0:10\t0:20\nO1\twater\t0\nS5\thot\n//\n"
# What annotators slip on, and what is meant.
SLIPS = {
    "S\tin\t[pot": "S\tin\t[pot]",
    "S\tcoated\t[salt,oil]": "S\tcoated\t{salt,oil}",
    "S\ton\t[]": "S\ton",
    "O\ttea\t00": "O\ttea\t0",
    "M\tpour\tAssume\t1:35]": "M\tpour\tAssumed\t1:35",
    "S\thot \t": "S\thot",
    "// ": "//",
    " \t": "",
}
# Read with a remark, and left alone: nobody reads anything else in them.
LEFT_ALONE = [
    "S\tunder [pan]",
    "S\tcontains\t{jelly, peanut butter}",
    "O tea",
    "M\tpour\t3:0s7",
]


def format_text(text: str, file: str, lenient: bool = False) -> str:
    return format_of(text, file).canonical_text(text, file, lenient)


def network(text: str) -> list[ReadUnit]:
    return list(FoonReader(lenient=True).units(text, "file"))


def listed(text: str) -> list[object]:
    """Return the nodes of an object list."""
    if text.lstrip().startswith(("{", "[")):
        return []
    blocks = FoonReader(lenient=True).object_blocks(text, "file")
    return [(block.node, block.object.id, block.object.fields, block.source) for block in blocks]


def formatted(text: str) -> str:
    return format_text(text, "file", lenient=True)


@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_what_is_canonical_stays_byte_for_byte(end: str) -> None:
    text = CLEAN.replace("\n", end)
    assert format_text(text, "file") == text


@pytest.mark.parametrize(("slip", "meant"), SLIPS.items())
def test_slips_are_mended(slip: str, meant: str) -> None:
    text = f"O\tcup\n{slip}\nO\tbowl\n"
    result = format_text(text, "file")
    assert result == f"O\tcup\n{meant}\nO\tbowl\n" or meant[0] == "M"
    assert result.split("\n")[1] == meant


@pytest.mark.parametrize("line", LEFT_ALONE)
def test_blanks_within_a_line_and_doubtful_lines_stay(line: str) -> None:
    text = f"O\tcup\n{line}\n//\n"
    assert format_text(text, "file") == text


def test_the_file_as_a_whole() -> None:
    text = "\n# tea\n//\r\nO\ttea\r\nM\tdrink\r\nO\tcup\r\n\r\n# end"
    result = format_text(text, "file")
    assert result == "\r\n# tea\r\n//\r\nO\ttea\r\nM\tdrink\r\nO\tcup\r\n\r\n# end\r\n//\r\n"
    assert network(result) == network(text)


def test_what_is_no_unit_is_not_closed() -> None:
    for text in ("O\ttea\nS\thot", "O\ttea\nM\tdrink\nO\tcup\nM\twash", "M\tdrink\nO\tcup", "# end"):
        assert format_text(text, "file") == text + "\n"


def test_nothing_stays_nothing() -> None:
    assert format_text("", "file") == ""
    assert format_text(" \t", "file") == ""


def test_a_second_byte_order_mark_belongs_to_the_text(cli: Cli, tmp_path: Path) -> None:
    file = tmp_path / "a.txt"
    file.write_bytes("\ufeff\ufeffO\ttea\n".encode())
    before = file.read_bytes()
    assert cli("fmt", file, "--lenient").code == 0
    assert file.read_bytes() == before


@steady
@given(texts())
def test_the_network_stays_and_formatting_twice_changes_nothing_more(text: str) -> None:
    result = format_text(text, "file", lenient=True)
    assert network(result) == network(text)
    assert formatted(result) == result
    assert listed(result) == listed(text)


def test_clean_corpus_files_stay(universal: Path) -> None:
    files = [*sorted(CORPUS.rglob("*.txt")), CORPUS / "universal" / "kitchen.json"]
    files += sorted((CORPUS / "dialects").glob("*.json"))
    changed = set()
    for file in files:
        if file.name not in {"motion.txt", "utensils.txt"}:
            result = format_text(read_plain_text(file), file.name)
            if result.encode() != file.read_bytes():
                changed.add(file.name[:4])
            assert format_text(result, file.name) == result
    # No last line end, or one of the slips that the corpus is known for.
    assert changed == {"goal", "pour", "0005", "0019", "0033", "0071", "0083", "0085"}


JSON_VALUES = st.recursive(
    st.none() | st.booleans() | st.integers() | st.text(max_size=4),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=3), inner, max_size=3),
)


@settings(steady, max_examples=50)
@given(st.lists(JSON_VALUES), st.booleans())
def test_json_is_laid_out_as_python_does_by_four(value: list[object], ascii_only: bool) -> None:
    laid_out = json.dumps(value, indent=4, ensure_ascii=ascii_only)
    assert lay_out(json.dumps(value, ensure_ascii=ascii_only)) == laid_out
    assert format_text(laid_out, "file.json") == laid_out
    assert format_text(laid_out + "\n", "file.json") == laid_out + "\n"
    assert format_text("\n" + laid_out, "file.json") == laid_out


def test_numbers_strings_and_repeated_keys_of_json_stay_as_written() -> None:
    text = '[{"a": 1.50, "a": "\\u00e9\\ud800", "b": 1e400}]\r\n'
    lines = [
        "[",
        "    {",
        '        "a": 1.50,',
        '        "a": "\\u00e9\\ud800",',
        '        "b": 1e400',
        "    }",
        "]",
        "",
    ]
    assert format_text(text, "file") == "\r\n".join(lines)


@pytest.mark.parametrize(
    ("text", "place"),
    [('[{"a": 1,}]', "1:9:"), ('[{"a": 1\n,\n}]', "2:1:"), ("[" * 100_000, "1:"), ("{", "1:2:")],
)
def test_broken_json_is_refused_or_left_alone(text: str, place: str) -> None:
    with pytest.raises(InputError, match=f"file:{place}"):
        format_text(text, "file")
    assert format_text(text, "file", lenient=True) == text


DIRTY = "O\ttea \nM\tdrink\nO\tcup\n"


def test_in_place(cli: Cli, tmp_path: Path) -> None:
    clean, dirty = tmp_path / "clean.txt", tmp_path / "deep" / "dirty.txt"
    dirty.parent.mkdir()
    clean.write_text(CLEAN)
    dirty.write_text(DIRTY)
    dirty.chmod(0o640)
    (tmp_path / "notes.txt").write_text("nothing of ours ")
    before = clean.stat().st_mtime_ns, clean.stat().st_ino

    checked = cli("fmt", "--check", tmp_path)
    assert checked.code == 1
    assert f"--- {dirty}\n" in checked.out
    assert "-O\ttea \n+O\ttea\n" in checked.out
    assert checked.err == "2 files: 1 would change, 1 in canonical form\n"
    assert dirty.read_text() == DIRTY

    ran = cli("fmt", tmp_path)
    assert (ran.code, ran.out) == (0, "")
    assert ran.err == f"wrote {dirty}\n2 files: 1 changed, 1 in canonical form\n"
    assert dirty.read_text() == "O\ttea\nM\tdrink\nO\tcup\n//\n"
    assert stat.S_IMODE(dirty.stat().st_mode) == 0o640
    assert (clean.stat().st_mtime_ns, clean.stat().st_ino) == before
    assert (tmp_path / "notes.txt").read_text() == "nothing of ours "
    assert cli("fmt", "--check", tmp_path).code == 0


def test_what_is_not_understood_is_refused_and_the_others_are_written(cli: Cli, tmp_path: Path) -> None:
    broken, dirty = tmp_path / "a.txt", tmp_path / "b.txt"
    broken.write_text("O\ttea \nS\nwhat\n")
    dirty.write_text(DIRTY)
    ran = cli("fmt", broken, dirty)
    assert ran.code == 2
    assert f"{broken}:2:1: error: " in ran.err
    assert f"{broken}:3:1: error: " in ran.err
    assert "2 files: 1 changed, 0 in canonical form, 1 not understood" in ran.err
    assert broken.read_text() == "O\ttea \nS\nwhat\n"
    assert dirty.read_text() != DIRTY
    assert cli("fmt", "--lenient", broken).code == 0
    assert broken.read_text() == "O\ttea\nS\nwhat\n"


def test_elsewhere(cli: Cli, tmp_path: Path) -> None:
    file, copy = tmp_path / "a.txt", tmp_path / "b.txt"
    file.write_text(DIRTY)
    assert cli("fmt", file, "-o", "-").out == "O\ttea\nM\tdrink\nO\tcup\n//\n"
    assert cli("fmt", file, "-o", copy).code == 0
    assert copy.read_text() == "O\ttea\nM\tdrink\nO\tcup\n//\n"
    assert file.read_text() == DIRTY
    assert cli("fmt", file, copy, "-o", "-").code == 2
    assert cli("fmt", file, "--check", "-o", "-").code == 2


def test_a_byte_order_mark_goes(cli: Cli, tmp_path: Path) -> None:
    file = tmp_path / "a.txt"
    file.write_bytes(b"\xef\xbb\xbf" + CLEAN.encode())
    checked = cli("fmt", "--check", file)
    assert (checked.code, "\n-\\ufeff" in checked.out) == (1, True)
    assert cli("fmt", file).code == 0
    assert file.read_text() == CLEAN


@pytest.mark.parametrize("name", ["missing.txt", "."])
def test_nothing_to_format(cli: Cli, tmp_path: Path, name: str) -> None:
    ran = cli("fmt", tmp_path / name)
    assert ran.code == 2
    assert str(tmp_path) in ran.err
