"""One mutant in a Python of its own, for changes that count while modules are imported."""

import importlib.abc
import importlib.machinery
import json
import os
import sys
import types
from collections.abc import Sequence
from pathlib import Path

import pytest

from tests.mutation.rooms import ROOT
from tests.mutation.trials import fix_examples, run_tests


class _Changed(importlib.machinery.SourceFileLoader):
    """Loads modules of ours, one of them with a changed text."""

    changed = ("", "")

    def get_code(self, fullname: str) -> types.CodeType | None:
        if self.path == self.changed[0]:
            return compile(self.changed[1], self.path, "exec", dont_inherit=True)
        return super().get_code(fullname)


class _Chosen:
    """Runs the chosen tests in their order, and ends with the first that fails, or names all that do."""

    def __init__(
        self, folder: Path, tests: Sequence[str], seconds: Sequence[float], every_killer: bool
    ) -> None:
        self._folder = folder
        self._every_killer = every_killer
        self._seconds = dict(zip(tests, seconds, strict=True))

    def pytest_configure(self) -> None:
        fix_examples()

    def pytest_runtestloop(self, session: pytest.Session) -> bool:
        items = {item.nodeid: item for item in session.items}
        run_tests([(items[test], seconds) for test, seconds in self._seconds.items() if test in items])
        os._exit(0)

    def pytest_collectreport(self, report: pytest.CollectReport) -> None:
        if report.failed:
            self._noticed(f"{report.nodeid} cannot be loaded")

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        if report.failed:
            with (self._folder / "by").open("a") as file:
                file.write(f"{report.nodeid}\n")
            if not self._every_killer:
                os._exit(1)

    def _noticed(self, by: str) -> None:
        (self._folder / "by").write_text(by)
        os._exit(1)


def main(folder: Path) -> None:
    """Do what ``order.json`` in the folder says."""
    order = json.loads((folder / "order.json").read_text())
    _Changed.changed = (str(ROOT / order["file"]), order["text"])
    # before all other finders, and for the package's own folder only
    hook = importlib.machinery.FileFinder.path_hook((_Changed, [".py"]))
    package = str(ROOT / "foon_asp")
    sys.path_hooks.insert(0, lambda path: hook(path) if path.startswith(package) else _not_ours(path))
    sys.path_importer_cache.clear()
    try:
        files = sorted({test.split("::")[0] for test in order["tests"]})
        words = ["-q", "-s", "-p", "no:cacheprovider", *files]
        code = pytest.main(
            words, plugins=[_Chosen(folder, order["tests"], order["seconds"], order["every_killer"])]
        )
    except BaseException as error:  # a change can do anything at import
        (folder / "by").write_text(f"{type(error).__name__} at import")
        os._exit(1)
    # neither a test nor its loading has failed: a fault in loading conftest.py
    (folder / "by").write_text(f"pytest ended with {code}")
    os._exit(1)


def _not_ours(path: str) -> importlib.abc.PathEntryFinder:
    raise ImportError(path)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
