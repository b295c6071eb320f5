"""Progress on stderr during a search: the best tree and the bound, only at a terminal."""

import contextlib
import sys
import time
from collections.abc import Callable, Iterator
from fractions import Fraction
from types import TracebackType
from typing import TYPE_CHECKING, Self

import click

from foon_asp.asp import Reporter
from foon_asp.cli.output import console
from foon_asp.problem import Costs, Objective
from foon_asp.report.answer import bound_text, costs_text

if TYPE_CHECKING:
    from rich.status import Status

_PATIENCE = 0.3  # seconds before anything is shown: most answers are there by then


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
    from rich.progress import BarColumn, MofNCompleteColumn, TextColumn, TimeRemainingColumn
    from rich.progress import Progress as Bar

    columns = (TextColumn(word), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
    with Bar(*columns, console=console(err=True)) as progress:
        task = progress.add_task("", total=total, completed=completed)
        yield lambda: progress.advance(task)
