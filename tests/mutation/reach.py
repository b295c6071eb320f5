"""A plugin of pytest that records which tests reach which lines, and how long each test takes.

A fixture that several tests share is run once: its lines count for every test that asks for it.
"""

import json
import os
import time
from collections import defaultdict
from collections.abc import Generator
from pathlib import Path

import coverage
import pytest

from tests.mutation.rooms import texts

RECORD = "FOON_ASP_REACH"  # the variable that names the folder to write to

Lines = dict[str, list[int]]


class Recorder:
    """Switches coverage from test to test, and writes what was found at the end."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._seconds: dict[str, float] = defaultdict(float)
        self._failed: set[str] = set()
        self._fixtures: dict[str, list[str]] = {}
        self._coverage = coverage.Coverage(
            data_file=None, include=[str(Path(file).resolve()) for file in texts()], config_file=False
        )
        self._coverage.start()

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_protocol(self, item: pytest.Item) -> Generator[None, object, object]:
        """Everything until the next test is this test's."""
        self._context = item.nodeid
        self._coverage.switch_context(item.nodeid)
        began = time.perf_counter()
        try:
            return (yield)
        finally:
            self._seconds[item.nodeid] += time.perf_counter() - began
            self._fixtures[item.nodeid] = [
                _name(definitions[-1])
                for definitions in item._fixtureinfo.name2fixturedefs.values()  # type: ignore[attr-defined]
                if definitions[-1].scope != "function"
            ]

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Note a test that fails: it says nothing about changes."""
        if report.failed:
            self._failed.add(report.nodeid)

    @pytest.hookimpl(wrapper=True)
    def pytest_fixture_setup(
        self, fixturedef: "pytest.FixtureDef[object]"
    ) -> Generator[None, object, object]:
        """Note the lines of a shared fixture under its own name."""
        if fixturedef.scope == "function":
            return (yield)
        before = self._context
        self._context = _name(fixturedef)
        self._coverage.switch_context(self._context)
        try:
            return (yield)
        finally:
            self._context = before
            self._coverage.switch_context(before)

    def pytest_sessionfinish(self) -> None:
        """Write a file for this process, one of several that run tests."""
        self._coverage.stop()
        data = self._coverage.get_data()
        lines: dict[str, Lines] = defaultdict(dict)
        for file in texts():
            by_line = data.contexts_by_lineno(str(Path(file).resolve()))
            for line, contexts in by_line.items():
                for context in contexts:
                    lines[context].setdefault(file, []).append(line)
        reached = {}
        for test, seconds in self._seconds.items():
            if test in self._failed:
                continue
            own: dict[str, set[int]] = defaultdict(set)
            for context in (test, *self._fixtures[test]):
                for file, found in lines.get(context, {}).items():
                    own[file].update(found)
            reached[test] = {"seconds": seconds, "lines": {file: sorted(own[file]) for file in own}}
        name = os.environ.get("PYTEST_XDIST_WORKER", "alone")
        (self._folder / f"{name}.json").write_text(json.dumps(reached))


def _name(fixture: "pytest.FixtureDef[object]") -> str:
    return f"fixture {fixture.baseid} {fixture.argname}"


def pytest_configure(config: pytest.Config) -> None:
    """Begin to record in every process that runs tests itself."""
    if hasattr(config, "workerinput") or not config.getoption("numprocesses", None):
        config.pluginmanager.register(Recorder(Path(os.environ[RECORD])))
