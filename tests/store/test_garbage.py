"""Python collects garbage again after what does without."""

import gc
from contextlib import nullcontext
from pathlib import Path

import pytest

from foon_asp.errors import UserError
from foon_asp.garbage_collection import without_garbage_collection
from foon_asp.store.import_files import import_files
from foon_asp.store.store import Store
from foon_asp.text.data_folder import DataFiles, read_data


def test_collecting_is_off_inside_and_as_it_was_afterwards() -> None:
    assert gc.isenabled()
    with without_garbage_collection():
        assert not gc.isenabled()
        with without_garbage_collection():
            pass
        assert not gc.isenabled()
    assert gc.isenabled()


def test_collecting_is_on_again_where_reading_fails(tmp_path: Path) -> None:
    with pytest.raises(UserError):
        read_data(DataFiles((tmp_path / "none.txt",)))
    assert gc.isenabled()


def test_networks_are_read_without(tmp_path: Path) -> None:
    units = "".join(f"O\twater\nM\tboil\nO\tsoup {n}\n//\n" for n in range(100))
    (tmp_path / "soup.txt").write_text(units, encoding="utf-8")
    files = DataFiles((tmp_path / "soup.txt",))
    import_files(files, tmp_path / "soup.foon")
    collected = []

    def noting(phase: str, _: dict[str, int]) -> None:
        collected.append(phase)

    before = gc.get_threshold()
    with Store(tmp_path / "soup.foon") as store:
        for read in (store.read_whole, lambda: read_data(files)):
            read()  # makes the parser, too
            gc.collect()
            gc.callbacks.append(noting)
            gc.set_threshold(50)
            try:
                read()
            finally:
                gc.set_threshold(*before)
                gc.callbacks.remove(noting)
    assert len(collected) < 40


@pytest.mark.slow
@pytest.mark.parametrize("lenient", [True, False])
def test_lines_that_are_not_understood_leave_none(tmp_path: Path, lenient: bool) -> None:
    lines = "".join(f"O\twater\nX nonsense {i}\nM\tboil\nO\tsoup {i}\n//\n" for i in range(100))
    file = tmp_path / "soup.txt"
    file.write_text(lines, encoding="utf-8")
    read_data(DataFiles((file,)), lenient=True)  # makes the parser
    gc.collect()
    with without_garbage_collection(), nullcontext() if lenient else pytest.raises(UserError):
        read_data(DataFiles((file,)), lenient)
    assert gc.collect() < 100


def test_very_many_new_objects_are_collected_again_after_an_interrupt() -> None:
    gc.unfreeze()  # what a benchmark may have frozen in this process
    many: list[list[int]] = []
    with pytest.raises(KeyboardInterrupt):
        _interrupted(many)
    assert gc.isenabled()
    assert gc.get_freeze_count() == 0


def _interrupted(made: list[list[int]]) -> None:
    with without_garbage_collection():
        made.extend([each] for each in range(1_000_100))
        raise KeyboardInterrupt
