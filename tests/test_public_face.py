"""``import foon_asp``: its names, its example, and that it costs nothing until used."""

import doctest
import subprocess
import sys

import pytest

import foon_asp
from tests.conftest import ROOT


def test_every_public_name_is_there() -> None:
    for name in foon_asp.__all__:
        assert getattr(foon_asp, name).__module__.startswith("foon_asp.")
    with pytest.raises(AttributeError, match="no attribute 'nothing'"):
        _ = foon_asp.nothing


def test_no_public_name_is_that_of_a_room() -> None:
    """A room would take the name over as soon as it is imported."""
    rooms = {path.stem for path in (ROOT / "foon_asp").iterdir()}
    assert not rooms & set(foon_asp.__all__)
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
