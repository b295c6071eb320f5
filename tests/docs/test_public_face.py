"""``import foon_asp``: its names, its example, and that it costs nothing until used."""

import doctest
import subprocess
import sys

import pytest

import foon_asp
from tests.conftest import ROOT
from tests.docs.__main__ import FILE, stub


def test_every_public_name_is_there() -> None:
    for name in foon_asp.__all__:
        assert getattr(foon_asp, name).__module__.startswith("foon_asp.")
    with pytest.raises(AttributeError, match="no attribute 'nothing'"):
        _ = foon_asp.nothing  # type: ignore[attr-defined]


def test_type_checkers_know_every_public_name() -> None:
    assert FILE.read_text(encoding="utf-8") == stub(), "python -m tests.docs writes it anew"


def test_no_public_name_is_that_of_a_room() -> None:
    """A room would take the name over as soon as it is imported."""
    rooms = {path.relative_to(ROOT / "foon_asp").parts[0] for path in (ROOT / "foon_asp").rglob("*.py")}
    assert not {room.removesuffix(".py") for room in rooms} & set(foon_asp.__all__)
    assert set(dir(foon_asp)) == {*foon_asp.__all__, "__version__"}


def test_the_example_runs(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT)
    assert doctest.testmod(foon_asp) == (0, 5)


def test_importing_it_loads_neither_clingo_nor_lark() -> None:
    code = (
        "import sys, foon_asp; print([name for name in ('clingo', 'lark', 'click') if name in sys.modules])"
    )
    ended = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert ended.stdout.strip() == "[]"
