"""Progress on stderr, only at a terminal: how much was read, the best tree and the bound, the time left."""

import contextlib
import sys
import time
from collections.abc import Callable, Iterable, Iterator
from fractions import Fraction
from pathlib import Path
from queue import Empty, SimpleQueue
from types import TracebackType
from typing import TYPE_CHECKING, Self

import click

from foon_asp.aside import Aside
from foon_asp.asp.reporter import Reporter
from foon_asp.cli.output import console, say
from foon_asp.deadline import Deadline
from foon_asp.problem import Costs, Objective
from foon_asp.text.reading import size_of, telling

if TYPE_CHECKING:
    from rich.text import Text

_LONG = 1.0  # seconds before anything is shown: most answers are there by then


class Progress(Reporter):
    """Shows one line while a question takes long: the best tree and the proved bound, or how many are done.

    After them come the seconds so far, and those that are left: at most, where there is a ``deadline``; by
    what was done so far, where that can be counted or the gap between tree and bound has become smaller.
    """

    def __init__(self, deadline: Deadline | None = None) -> None:
        self._deadline = deadline
        self._began = time.monotonic()
        self._over: SimpleQueue[None] = SimpleQueue()
        self._line: Aside | None = None
        self._warnings: set[str] = set()
        self._costs: Costs | None = None
        self._bound: tuple[Objective, int | Fraction] | None = None
        self._first: tuple[int | Fraction, float] | None = None
        self._step: tuple[str, int, int] | None = None
        self._steps_before = 0

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._over.put(None)
        if self._line is not None:
            self._line.ended(_LONG)  # so that nothing is printed into it

    def begin(self) -> None:
        """Note that everything is read, and show the line where the answer takes long."""
        self._began = time.monotonic()
        if sys.stderr.isatty():
            self._line = Aside(self._show)

    def _show(self) -> None:
        with contextlib.suppress(Empty):
            self._over.get(timeout=_LONG)
            return
        with console(err=True).status(self):
            self._over.get()

    def warning(self, message: str) -> None:
        """Print a warning at once, the first time: a question may ask others, under the same rules."""
        if message not in self._warnings:
            self._warnings.add(message)
            say(message)

    def statistics(self, text: str) -> None:
        """Print statistics of a search at once."""
        click.echo(text, err=True)

    def tree(self, costs: Costs) -> None:
        """Note the best tree."""
        self._costs = costs

    def bound(self, objective: Objective, bound: int | Fraction) -> None:
        """Note the bound, and when the first one of this objective came."""
        if self._bound is None or self._bound[0] != objective:
            self._first = (bound, time.monotonic())
        self._bound = (objective, bound)

    def step(self, word: str, done: int, total: int) -> None:
        """Note how many are done."""
        if self._step is None:
            self._steps_before = done
        self._step = (word, done, total)

    def line(self, now: float) -> str:
        """Say how far it is at a time."""
        from foon_asp.results.figure_text import bound_text, costs_text  # after a second

        seconds = f"{now - self._began:.0f} s"
        limit = None if self._deadline is None else self._deadline.left
        left = self._left(now)
        if left is not None and (limit is None or left < limit):
            seconds += f", about {left:.0f} s left at this pace"
        elif limit is not None:
            seconds += f", at most {limit:.0f} s left"
        if self._step is not None:
            word, done, total = self._step
            return f"{word}: {done} of {total}  |  {seconds}"
        if self._costs is None and self._bound is None:
            return f"nothing found yet  |  {seconds}  |  ctrl-C stops with the best"
        tree = "no tree yet" if self._costs is None else f"best tree: {costs_text(self._costs)}"
        bound = "no bound yet" if self._bound is None else f"proved: {bound_text(*self._bound)}"
        return f"{tree}  |  {bound}  |  {seconds}  |  ctrl-C stops with the best"

    def _left(self, now: float) -> float | None:
        """Guess how many seconds are left, by the pace so far; ``None`` where nothing tells."""
        if self._step is not None:
            _, done, total = self._step
            new = done - self._steps_before
            return (now - self._began) / new * (total - done) if new else None
        if self._costs is None or self._bound is None or self._first is None:
            return None
        (objective, bound), (first, since) = self._bound, self._first
        closed, gap = abs(Fraction(bound - first)), abs(Fraction(self._costs.measure(objective) - bound))
        return float(gap / closed) * (now - since) if closed and gap else None

    def __rich__(self) -> "Text":
        from rich.text import Text

        return Text(self.line(time.monotonic()))


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
                advance = bars.enter_context(_bar(word, total, done))

        with telling(tell):
            yield


@contextlib.contextmanager
def _bar(word: str, total: int, completed: int) -> Iterator[Callable[[int], None]]:
    from rich.progress import BarColumn, DownloadColumn, TextColumn, TimeRemainingColumn
    from rich.progress import Progress as Bar

    columns = TextColumn(word), BarColumn(), DownloadColumn(), TimeRemainingColumn()
    with Bar(*columns, console=console(err=True)) as progress:
        task = progress.add_task("", total=total, completed=completed)
        yield lambda steps: progress.advance(task, steps)
