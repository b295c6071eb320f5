"""A plugin of pytest that tries mutants: tests are collected once, and each mutant has a forked process.

There the function with the change gets its new code, and the tests that reach the changed lines run, quickest
first, until one fails. Changes that count while a module is imported take a new Python (:mod:`.afresh`).
"""

import contextlib
import gc
import inspect
import json
import math
import os
import resource
import shutil
import signal
import sys
import tempfile
import time
import types
import warnings
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from enum import StrEnum
from pathlib import Path
from typing import NamedTuple

import pytest

from tests.mutation.mutant import Mutant
from tests.mutation.rooms import ROOT, texts

BUDGET = 60.0  # seconds of tests for one mutant, as long as they took unchanged; the slowest are left out
_PATIENCE = (10.0, 10.0)  # a test may take so many seconds, and so many times as long as unchanged
_START = 120  # seconds until the first test begins
_MEMORY = 4 << 30  # bytes of a process that tries a mutant
_QUICK = 0.01  # seconds: quicker than that is as good as that
_SURVIVED, _KILLED = 0, 1  # exit codes of a trial


class Outcome(StrEnum):
    """What became of a mutant."""

    KILLED = "killed"
    TIMEOUT = "timeout"
    SURVIVED = "survived"
    UNREACHED = "unreached"


class Tried(NamedTuple):
    """A mutant, and what became of it; ``by`` has a line for each test that noticed."""

    mutant: Mutant
    outcome: Outcome
    by: str
    seconds: float


class Reach(NamedTuple):
    """What a test does when nothing is changed: seconds, and lines by file."""

    seconds: float
    lines: Mapping[str, frozenset[int]]


class _Running(NamedTuple):
    mutant: Mutant
    folder: Path
    began: float


class Trials:
    """Tries mutants one after the other, ``jobs`` at a time, and begins none when ``seconds`` are over.

    A trial ends with the first test that fails, or with ``every_killer`` names all that fail.
    """

    def __init__(
        self,
        mutants: Sequence[Mutant],
        reach: Mapping[str, Reach],
        jobs: int,
        seconds: float | None,
        every_killer: bool = False,
    ) -> None:
        self.tried: list[Tried] = []
        self.not_used: set[str] = set()  # tests that fail unchanged, tried this way
        self._waiting = list(reversed(mutants))
        self._reach = reach
        self._jobs = jobs
        self._seconds = seconds
        self._every_killer = every_killer
        self._running: dict[int, _Running] = {}
        self._trusted: set[str] = set()
        self._texts = texts()
        self._child: Path | None = None

    # Pytest's side.

    def pytest_configure(self) -> None:
        """Before any test is loaded, settle what is left to chance."""
        fix_examples()

    @pytest.hookimpl(tryfirst=True)
    def pytest_runtestloop(self, session: pytest.Session) -> bool:
        """Try mutants in place of running tests."""
        import highspy  # noqa: F401, PLC0415  # slow to import, so not in every process anew

        self._items = {item.nodeid: item for item in session.items}
        self._places = {nodeid: place for place, nodeid in enumerate(self._items)}
        self._functions = _functions(self._texts)
        began = time.monotonic()
        with tempfile.TemporaryDirectory(prefix="mutants") as folder:
            self._folder = Path(folder)
            while self._waiting or self._running:
                over = self._seconds is not None and time.monotonic() - began > self._seconds
                while self._waiting and not over and len(self._running) < self._jobs:
                    self._begin(self._waiting.pop())
                if not self._running:
                    break
                self._end_one()
        return True

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """End the trial with the first test that fails, or go on where all are wanted."""
        if self._child and report.failed:
            with (self._child / "by").open("a") as file:
                file.write(f"{report.nodeid}\n")
            if not self._every_killer:
                os._exit(_KILLED)

    # The parent's side.

    def _begin(self, mutant: Mutant) -> None:
        chosen = self._chosen(mutant)
        if not chosen:
            self._note(mutant, Outcome.UNREACHED, "", 0.0)
            return
        folder = Path(tempfile.mkdtemp(dir=self._folder))
        pid = self._forked(lambda: self._try(mutant, chosen, folder), folder)
        self._running[pid] = _Running(mutant, folder, time.monotonic())

    def _end_one(self) -> None:
        pid, status = os.wait()
        running = self._running.pop(pid)
        outcome, by = self._outcome(pid, status, running.folder)
        failing = [test for test in by.splitlines() if not self._passes_unchanged(test)]
        if outcome is Outcome.KILLED and failing:
            self._waiting.append(running.mutant)
            return
        self._note(running.mutant, outcome, by, time.monotonic() - running.began)

    def _outcome(self, pid: int, status: int, folder: Path) -> tuple[Outcome, str]:
        with contextlib.suppress(ProcessLookupError):
            os.killpg(pid, signal.SIGKILL)  # what its tests started
        file = folder / "by"
        by = file.read_text().strip() if file.exists() else ""
        said = (folder / "output").read_text(errors="replace")
        shutil.rmtree(folder, ignore_errors=True)
        if os.WIFSIGNALED(status):
            late = os.WTERMSIG(status) == signal.SIGALRM
            return (Outcome.TIMEOUT if late else Outcome.KILLED), by
        code = os.WEXITSTATUS(status)
        if code not in {_SURVIVED, _KILLED}:  # 1 without a test: a library ended the process
            raise RuntimeError(f"a trial ended with {code}\n{said[-5000:]}")
        return (Outcome.KILLED if code or by else Outcome.SURVIVED), by

    def _note(self, mutant: Mutant, outcome: Outcome, by: str, seconds: float) -> None:
        tried = Tried(mutant, outcome, by, seconds)
        self.tried.append(tried)
        print(
            f"{len(self.tried):5} {outcome:9} {seconds:6.1f} s  {mutant.file}:{mutant.first}  "
            f"{mutant.change[:100]}",
            file=sys.__stderr__,
            flush=True,
        )

    def _chosen(self, mutant: Mutant) -> list[str]:
        """Give the tests to run, in their order."""
        lines = range(mutant.first, mutant.last + 1)
        reaching = [
            test
            for test, reach in self._reach.items()
            if test in self._items
            and test not in self.not_used
            and (found := reach.lines.get(mutant.file))
            and (not mutant.outermost or not found.isdisjoint(lines))
        ]
        return self._ordered(reaching)

    def _ordered(self, tests: Iterable[str]) -> list[str]:
        seconds = {test: self._reach[test].seconds for test in tests}
        dear: dict[str, float] = {}
        asked: Counter[str] = Counter()
        for test in sorted(seconds, key=self._places.__getitem__):
            name = test.partition("[")[0]
            asked[name] += 1  # one more case of the same test is less likely to notice what others did not
            dear[test] = seconds[test] * asked[name]
        # what is about as dear stays in its usual order, in which fixtures are shared
        ordered = sorted(seconds, key=lambda t: (math.frexp(max(dear[t], _QUICK))[1], self._places[t]))
        budget = BUDGET
        chosen: list[str] = []
        for test in ordered:
            if chosen and seconds[test] > budget:
                break
            budget -= seconds[test]
            chosen.append(test)
        return chosen

    def _passes_unchanged(self, test: str) -> bool:
        """Whether a test passes in a process forked like the others, without a change."""
        if test not in self._trusted and test in self._items:
            folder = Path(tempfile.mkdtemp(dir=self._folder))
            pid = self._forked(lambda: self._run([test]), folder)
            _, status = os.waitpid(pid, 0)
            outcome, _ = self._outcome(pid, status, folder)
            if outcome is not Outcome.SURVIVED:
                self.not_used.add(test)
                return False
            self._trusted.add(test)
        return True

    def _forked(self, work: Callable[[], None], folder: Path) -> int:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # that there are threads, which libraries keep waiting
            pid = os.fork()
        if pid:
            return pid
        code = 3
        try:
            self._child = folder
            os.setsid()
            signal.setitimer(signal.ITIMER_REAL, _START)
            resource.setrlimit(resource.RLIMIT_DATA, (_MEMORY, _MEMORY))
            resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
            os.environ["PYTEST_DEBUG_TEMPROOT"] = str(folder)  # where tmp_path is
            output = os.open(folder / "output", os.O_WRONLY | os.O_CREAT)
            nothing = os.open(os.devnull, os.O_RDONLY)
            os.dup2(nothing, 0)
            os.dup2(output, 1)
            os.dup2(output, 2)
            work()
            code = _SURVIVED
        except BaseException:
            sys.excepthook(*sys.exc_info())
        finally:
            sys.stderr.flush()
            os._exit(code)

    # The child's side.

    def _try(self, mutant: Mutant, tests: Sequence[str], folder: Path) -> None:
        new = compile(mutant.applied(self._texts[mutant.file]), mutant.file, "exec", dont_inherit=True)
        if not self._replaced(mutant, new):
            order: dict[str, object] = {"file": mutant.file, "text": mutant.applied(self._texts[mutant.file])}
            seconds = [self._reach[test].seconds for test in tests]
            order |= {"tests": tests, "seconds": seconds, "every_killer": self._every_killer}
            (folder / "order.json").write_text(json.dumps(order))
            os.execv(sys.executable, [sys.executable, "-m", "tests.mutation.afresh", str(folder)])
        self._run(tests)

    def _replaced(self, mutant: Mutant, new: types.CodeType) -> bool:
        """Give the changed function its new code; ``False`` where that cannot be."""
        functions = self._functions.get((mutant.file, mutant.outermost), [])
        codes = {code.co_firstlineno: code for code in _codes(new) if code.co_qualname == mutant.outermost}
        done = False
        for function in functions:
            code = codes.get(function.__code__.co_firstlineno)
            if code is None or not _interchangeable(code, function.__code__):
                return False
            last = max((line for *_, line in code.co_lines() if line), default=0)
            if code.co_firstlineno <= mutant.first <= last:
                function.__code__ = code
                done = True
        return done

    def _run(self, tests: Sequence[str]) -> None:
        assert self._child is not None
        try:
            run_tests([(self._items[test], self._reach[test].seconds) for test in tests])
        except BaseException as error:  # what pytest passes on, as ctrl-C, is noticed too
            (self._child / "by").write_text(f"{type(error).__name__} in a test")
            os._exit(_KILLED)


def run_tests(items: Sequence[tuple[pytest.Item, float]]) -> None:
    """Run tests with a limit for each, which ends the process; seconds are what they take unchanged."""
    following = [item for item, _ in items[1:]] + [None]
    for (item, seconds), nextitem in zip(items, following, strict=True):
        signal.setitimer(signal.ITIMER_REAL, _PATIENCE[0] + _PATIENCE[1] * seconds)
        item.config.hook.pytest_runtest_protocol(item=item, nextitem=nextitem)
    signal.setitimer(signal.ITIMER_REAL, 0)


def fix_examples() -> None:
    """Have Hypothesis try the same examples every time, and keep none and shrink none."""
    from hypothesis import HealthCheck, Phase, settings  # noqa: PLC0415  # after pytest has prepared it

    settings.register_profile(
        "mutation",
        database=None,
        derandomize=True,
        deadline=None,
        phases=(Phase.explicit, Phase.generate),
        suppress_health_check=(HealthCheck.too_slow,),
    )
    settings.load_profile("mutation")


def read_reach(found: Mapping[str, Mapping[str, object]]) -> dict[str, Reach]:
    """Give what was recorded, by test."""
    reach = {}
    for test, record in found.items():
        seconds, lines = record["seconds"], record["lines"]
        assert isinstance(seconds, float)
        assert isinstance(lines, dict)
        reach[test] = Reach(seconds, {file: frozenset(lines[file]) for file in lines})
    return reach


def _functions(files: Iterable[str]) -> dict[tuple[str, str], list[types.FunctionType]]:
    """Find the functions of the files, wherever they are held: in modules, properties, wrappers."""
    names = {str(ROOT / file): file for file in files}
    found: dict[tuple[str, str], list[types.FunctionType]] = {}
    for thing in gc.get_objects():
        if type(thing) is types.FunctionType and thing.__code__.co_filename in names:
            place = (names[thing.__code__.co_filename], thing.__code__.co_qualname)
            found.setdefault(place, []).append(thing)
    return found


def _interchangeable(one: types.CodeType, other: types.CodeType) -> bool:
    """Whether a function can be given the one code in place of the other: a generator stays one."""
    kind = inspect.CO_GENERATOR | inspect.CO_COROUTINE | inspect.CO_ASYNC_GENERATOR
    return one.co_freevars == other.co_freevars and one.co_flags & kind == other.co_flags & kind


def _codes(code: types.CodeType) -> Iterator[types.CodeType]:
    for constant in code.co_consts:
        if isinstance(constant, types.CodeType):
            yield constant
            yield from _codes(constant)
