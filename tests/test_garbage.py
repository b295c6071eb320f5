"""Python collects garbage again after what does without."""

import gc
from collections.abc import Callable
from contextlib import nullcontext
from pathlib import Path

import pytest

from foon_asp.errors import UserError
from foon_asp.garbage import uncollected
from foon_asp.store.import_files import import_files
from foon_asp.store.plain_values import node_of
from foon_asp.store.store import Store
from foon_asp.text.data_folder import DataFiles, read_data
from foon_asp.text.reader import FoonReader


def test_collecting_is_off_inside_and_as_it_was_afterwards() -> None:
    assert gc.isenabled()
    with uncollected():
        assert not gc.isenabled()
        with uncollected():
            pass
        assert not gc.isenabled()
    assert gc.isenabled()


def test_collecting_is_on_again_where_reading_fails(tmp_path: Path) -> None:
    with pytest.raises(UserError):
        read_data(DataFiles((tmp_path / "none.txt",)))
    assert gc.isenabled()


def test_networks_are_read_without(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "soup.txt").write_text("O\twater\nM\tboil\nO\tsoup\n//\n", encoding="utf-8")
    files = DataFiles((tmp_path / "soup.txt",))
    import_files(files, tmp_path / "soup.foon")
    inside = []

    def noting(made: Callable[..., object]) -> Callable[..., object]:
        def called(*given: object) -> object:
            inside.append(gc.isenabled())
            return made(*given)

        return called

    monkeypatch.setattr("foon_asp.text.data_folder.FoonReader", noting(FoonReader))
    monkeypatch.setattr("foon_asp.store.store.node_of", noting(node_of))
    read_data(files)
    with Store(tmp_path / "soup.foon") as opened:
        assert len(opened.whole()[0]) == 1
    assert inside == [False] * 3
    assert gc.isenabled()


@pytest.mark.slow
@pytest.mark.parametrize("lenient", [True, False])
def test_lines_that_are_not_understood_leave_none(tmp_path: Path, lenient: bool) -> None:
    lines = "".join(f"O\twater\nX nonsense {i}\nM\tboil\nO\tsoup {i}\n//\n" for i in range(100))
    file = tmp_path / "soup.txt"
    file.write_text(lines, encoding="utf-8")
    read_data(DataFiles((file,)), lenient=True)  # makes the parser
    gc.collect()
    with uncollected(), nullcontext() if lenient else pytest.raises(UserError):
        read_data(DataFiles((file,)), lenient)
    assert gc.collect() < 100


def test_very_many_new_objects_are_old_afterwards(monkeypatch: pytest.MonkeyPatch) -> None:
    with uncollected():
        few = [[each] for each in range(100)]
    assert any(each is few[0] for each in gc.get_objects(0))
    monkeypatch.setattr("foon_asp.garbage._VERY_MANY", 10_000)
    many: list[list[int]] = []
    with pytest.raises(KeyboardInterrupt):
        _interrupted(many)
    assert gc.get_count()[0] < 10_000
    assert any(each is many[0] for each in gc.get_objects(2))
    assert gc.get_freeze_count() == 0


def _interrupted(made: list[list[int]]) -> None:
    with uncollected():
        made.extend([each] for each in range(20_000))
        raise KeyboardInterrupt
