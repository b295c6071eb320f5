"""Progress on stderr during a search: the best tree and the bound, only at a terminal."""

import contextlib
import sys
import time
from collections.abc import Callable, Iterable, Iterator
from fractions import Fraction
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Self

import click

from foon_asp.asp import Reporter
from foon_asp.cli.output import console
from foon_asp.problem import Costs, Objective
from foon_asp.report.answer import bound_text, costs_text
from foon_asp.text.bytes_read import size_of, telling

if TYPE_CHECKING:
    from rich.progress import ProgressColumn
    from rich.status import Status

_PATIENCE = 0.3  # seconds before anything is shown: most answers are there by then
_LONG = 1.0  # seconds of reading before a bar is shown


class Progress(Reporter):
    """Shows the best tree so far and the proved bound in one line, which is updated."""

    def __init__(self) -> None:
        self._began = time.monotonic()
        self._live: Status | None = None
        self._tree = "no tree yet"
        self._bound = "no bound yet"
        self._bar = contextlib.ExitStack()
        self._advance: Callable[[], None] | None = None

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._live:
            self._live.stop()
        self._bar.close()

    def warning(self, message: str) -> None:
        """Print a warning at once."""
        click.echo(message, err=True)

    def tree(self, costs: Costs) -> None:
        """Note the best tree."""
        self._tree = f"best tree: {costs_text(costs)}"
        self._show()

    def bound(self, objective: Objective, bound: int | Fraction) -> None:
        """Note the bound."""
        self._bound = f"proved: {bound_text(objective, bound)}"
        self._show()

    def step(self, word: str, done: int, total: int) -> None:
        """Show a bar, and advance it."""
        if self._advance is None:
            self._advance = self._bar.enter_context(bar(word, total, done))
        else:
            self._advance()

    def _show(self) -> None:
        if not sys.stderr.isatty() or time.monotonic() - self._began < _PATIENCE:
            return
        text = f"{self._tree}  |  {self._bound}  |  ctrl-C stops with the best"
        if self._live:
            self._live.update(text)
            return
        self._live = console(err=True).status(text)
        self._live.start()


@contextlib.contextmanager
def bar(word: str, total: int, completed: int) -> Iterator[Callable[[], None]]:
    """Show a bar at a terminal if there are more than a few steps; call the function given after each."""
    if total < 20 or not sys.stderr.isatty():
        yield lambda: None
        return
    from rich.progress import MofNCompleteColumn

    with _bar(word, MofNCompleteColumn(), total, completed) as advance:
        yield lambda: advance(1)


@contextlib.contextmanager
def bytes_bar(word: str, files: Iterable[Path]) -> Iterator[None]:
    """Show at a terminal how many bytes of networks are read in a ``with`` block, and the time left.

    Most networks are read before anything is shown. Workers, which have no command, show nothing.
    """
    if not sys.stderr.isatty() or click.get_current_context(silent=True) is None:
        yield
        return
    total = size_of(files)
    began, done = time.monotonic(), 0
    advance: Callable[[int], None] | None = None
    with contextlib.ExitStack() as bars:

        def tell(read: int) -> None:
            nonlocal advance, done
            done += read
            if advance is not None:
                advance(read)
            elif time.monotonic() - began >= _LONG:
                from rich.progress import DownloadColumn

                advance = bars.enter_context(_bar(word, DownloadColumn(), total, done))

        with telling(tell):
            yield


@contextlib.contextmanager
def _bar(word: str, count: "ProgressColumn", total: int, completed: int) -> Iterator[Callable[[int], None]]:
    from rich.progress import BarColumn, TextColumn, TimeRemainingColumn
    from rich.progress import Progress as Bar

    with Bar(
        TextColumn(word), BarColumn(), count, TimeRemainingColumn(), console=console(err=True)
    ) as progress:
        task = progress.add_task("", total=total, completed=completed)
        yield lambda steps: progress.advance(task, steps)
