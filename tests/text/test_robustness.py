"""Whatever a file holds, reading it ends soon, in a network or in located words."""

import contextlib
import os
import random
import threading
from pathlib import Path

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from foon_asp.errors import UserError
from foon_asp.text.diagnostics import InputError
from foon_asp.text.object_list import read_object_list
from foon_asp.text.plain_file import STORE_MAGIC
from foon_asp.text.reader import FoonReader
from tests.conftest import CORPUS, Cli

TREE = b"# Source:\thttp://video\n//\nO1\tegg\t1\nS2\twhole\nM3\tcrack\t0:01\t0:02\nO1\tegg\t0\t15\nS4\tin\t[bowl]\n//\n"


def read(file: Path, lenient: bool) -> FoonReader:
    """Read a file both ways; whatever is wrong must be said with a place in that file."""
    reader = FoonReader(lenient)
    with contextlib.suppress(InputError):
        reader.read_network([file])
    listed = FoonReader(lenient)
    units = list(listed.listed_units(listed.text(file), str(file)))
    assert len(units) >= len({unit.sources for unit in units})
    assert [d[:4] for d in listed.diagnostics] == [d[:4] for d in reader.diagnostics]
    for diagnostic in reader.diagnostics:
        assert diagnostic.source.file == str(file)
        assert diagnostic.source.line >= 1
        assert diagnostic.source.column >= 1
        assert diagnostic.message
        assert len(str(diagnostic)) < 2_000
    return reader


def mutated(data: bytes, dice: random.Random) -> bytes:
    """Change a file as an accident would: bytes flipped, lost, doubled, pieces moved."""
    changed = bytearray(data)
    pieces = [b"", b"\t", b"\n", b"\r", b"{", b"}", b"[", b"]", b"//", b"\nM\t", b"\xff", "\u2028".encode()]
    for _ in range(dice.randint(1, 12)):
        at, length = dice.randrange(len(changed) + 1), dice.choice([0, 1, 30, 200])
        changed[at : at + dice.randint(0, 30)] = dice.choice([*pieces, changed[at : at + length]])
    return bytes(changed)


@settings(deadline=None, derandomize=True, max_examples=200)
@example(data=STORE_MAGIC, lenient=True)
@given(data=st.binary(max_size=300) | st.text(max_size=300).map(str.encode), lenient=st.booleans())
def test_any_bytes_are_read_or_refused(
    tmp_path_factory: pytest.TempPathFactory, data: bytes, lenient: bool
) -> None:
    file = tmp_path_factory.mktemp("any") / "any.txt"
    file.write_bytes(data)
    if data.startswith(STORE_MAGIC):
        with pytest.raises(UserError, match="is a store, expected text"):
            read(file, lenient)
    else:
        read(file, lenient)


@pytest.mark.slow
def test_a_small_file_with_any_byte_changed(tmp_path: Path) -> None:
    file = tmp_path / "one.txt"
    for at in range(len(TREE)):
        for byte in b"\t\n\r {}[]/#OSM\x00\xff":
            file.write_bytes(TREE[:at] + bytes([byte]) + TREE[at + 1 :])
            read(file, lenient=at % 2 == 0)


@pytest.mark.skipif(not CORPUS.exists(), reason="the corpus of real FOON files is not here")
@pytest.mark.slow
def test_real_files_with_accidents(tmp_path: Path) -> None:
    dice = random.Random(7)
    files = sorted((CORPUS / "subgraphs").glob("*.txt")) + sorted((CORPUS / "dialects").iterdir())
    for number, original in enumerate(files):
        for _ in range(3):
            file = tmp_path / f"{number}{original.suffix}"
            file.write_bytes(mutated(original.read_bytes(), dice))
            read(file, lenient=bool(dice.randrange(2)))
            with contextlib.suppress(UserError):
                read_object_list(file)


@pytest.mark.parametrize(
    "text",
    [
        "{" * 100_000,
        "[" * 100_000,
        '{"functional_units":' * 50_000,
        "O\ta\nS\tin\t" + "[" * 100_000,
        "O\ta\nS\tin\t" + "{[" * 50_000,
        "M" * 100_000,
        "O\t" + " " * 100_000,
    ],
)
def test_brackets_and_blanks_without_end(tmp_path: Path, text: str) -> None:
    file = tmp_path / "FOON.txt"
    file.write_text(text)
    read(file, lenient=False)


def test_a_folder_a_pipe_and_what_is_not_there(cli: Cli, tmp_path: Path) -> None:
    ran = cli("stats", "--network", tmp_path)
    assert ran.code == 2
    assert "expected a folder with FOON.txt or other networks" in ran.err
    assert cli("stats", "--network", tmp_path / "none.txt").code == 2
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    writer = threading.Thread(target=pipe.write_bytes, args=(TREE,))
    writer.start()
    ran = cli("stats", "--network", pipe, "--format", "json")
    writer.join()
    assert ran.code == 0


@pytest.mark.slow
@pytest.mark.parametrize(
    "data",
    [
        b"O\t" + b"a" * 100_000_000,
        b"O\tb\nS\tcontains\t{" + b"a," * 50_000_000,
        b"\0" * 100_000_000,
        b"[" * 100_000_000,
        b'"' * 100_000_000,
    ],
    ids=["label", "list", "zeros", "brackets", "quotes"],
)
def test_one_line_of_a_hundred_megabytes(tmp_path: Path, data: bytes) -> None:
    file = tmp_path / "FOON.txt"
    file.write_bytes(data)
    assert read(file, lenient=False).diagnostics
