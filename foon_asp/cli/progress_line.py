"""Progress at a terminal, on stderr: bytes read, the incumbent and the bound, the remaining time."""

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

from foon_asp.asp.reporter import Reporter
from foon_asp.cli.output import console, write_remark_once
from foon_asp.daemon_thread import DaemonThread
from foon_asp.deadline import Deadline
from foon_asp.problem import Costs, Objective
from foon_asp.text.reading import reporting_to, size_of

if TYPE_CHECKING:
    from rich.text import Text

_DELAY_SECONDS = 1.0  # before anything is shown: most answers take less


class Progress(Reporter):
    """A reporter that shows one line during a long search: incumbent and bound, or the number of steps done.

    The elapsed and the remaining seconds follow. The remaining seconds are estimated from the steps done, or
    else from the speed at which the gap closes. If the ``deadline`` comes earlier, or nothing can be
    estimated, the seconds up to the deadline are shown.
    """

    def __init__(self, deadline: Deadline | None = None) -> None:
        self._deadline = deadline
        self._began = time.monotonic()
        self._finished: SimpleQueue[None] = SimpleQueue()
        self._thread: DaemonThread | None = None
        self._costs: Costs | None = None
        self._bound: tuple[Objective, int | Fraction] | None = None
        self._first_bound: tuple[int | Fraction, float] | None = None
        self._step: tuple[str, int, int] | None = None
        self._initial_steps = 0

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """End the thread that shows the line, and wait for at most a second until the line is gone."""
        self._finished.put(None)
        if self._thread is not None:
            self._thread.wait_for_end(_DELAY_SECONDS)  # so that the line does not overwrite the answer

    def begin(self) -> None:
        """Start the time of the search; at a terminal, also start the thread that shows the line."""
        self._began = time.monotonic()
        if sys.stderr.isatty():
            self._thread = DaemonThread(self._show)

    def _show(self) -> None:
        """Wait for a second, then show the line until the search has finished."""
        with contextlib.suppress(Empty):
            self._finished.get(timeout=_DELAY_SECONDS)
            return
        with console(err=True).status(self):
            self._finished.get()

    def warning(self, message: str) -> None:
        """Print a warning to stderr at once, if the command has not printed it already."""
        write_remark_once(message)

    def statistics(self, text: str) -> None:
        """Print statistics of a search to stderr at once."""
        click.echo(text, err=True)

    def tree(self, costs: Costs) -> None:
        """Store the costs of a new incumbent."""
        self._costs = costs

    def bound(self, objective: Objective, bound: int | Fraction) -> None:
        """Store a bound on an objective, and the first bound on the objective with its time."""
        if self._bound is None or self._bound[0] != objective:
            self._first_bound = (bound, time.monotonic())
        self._bound = (objective, bound)

    def step(self, word: str, done: int, total: int) -> None:
        """Store the number of steps done and their total; ``word`` says what is done.

        The number at the first call counts as done before the search.
        """
        if self._step is None:
            self._initial_steps = done
        self._step = (word, done, total)

    def line(self, now: float) -> str:
        """Return the line at the time ``now`` of the monotonic clock.

        If steps are counted, they stand in place of the incumbent and the bound.
        """
        from foon_asp.results.figure_text import bound_text, costs_text  # slow to import: for long searches

        seconds = f"{now - self._began:.0f} s"
        limit = None if self._deadline is None else self._deadline.remaining_seconds
        remaining = self._remaining_seconds(now)
        if remaining is not None and (limit is None or remaining < limit):
            seconds += f", about {remaining:.0f} s left at this pace"
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

    def _remaining_seconds(self, now: float) -> float | None:
        """Return an estimate of the remaining seconds; ``None`` without progress to extrapolate."""
        if self._step is not None:
            _, done, total = self._step
            new_steps = done - self._initial_steps
            return (now - self._began) / new_steps * (total - done) if new_steps else None
        if self._costs is None or self._bound is None or self._first_bound is None:
            return None
        (objective, bound), (first_bound, first_time) = self._bound, self._first_bound
        closed_gap = abs(Fraction(bound - first_bound))
        gap = abs(Fraction(self._costs.measure(objective) - bound))
        return float(gap / closed_gap) * (now - first_time) if closed_gap and gap else None

    def __rich__(self) -> "Text":
        """Return the current line, whenever rich draws it."""
        from rich.text import Text

        return Text(self.line(time.monotonic()))


@contextlib.contextmanager
def bytes_bar(word: str, files: Iterable[Path]) -> Iterator[None]:
    """Show at a terminal how many bytes of ``files`` a ``with`` block has read, and the remaining time.

    Nothing is shown for reading that takes less than a second, and nothing in worker processes.
    """
    if not sys.stderr.isatty() or click.get_current_context(silent=True) is None:
        yield
        return
    total_bytes = size_of(files)
    began, bytes_read = time.monotonic(), 0
    advance: Callable[[int], None] | None = None
    with contextlib.ExitStack() as bars:

        def report(new_bytes: int) -> None:
            """Add the number of bytes read since the last call; after a second, show the bar."""
            nonlocal advance, bytes_read
            bytes_read += new_bytes
            if advance is not None:
                advance(new_bytes)
            elif time.monotonic() - began >= _DELAY_SECONDS:
                advance = bars.enter_context(_bar(word, total_bytes, bytes_read))

        with reporting_to(report):
            yield


@contextlib.contextmanager
def _bar(word: str, total: int, completed: int) -> Iterator[Callable[[int], None]]:
    """Show a progress bar in a ``with`` block; yield a function that advances it by a number of bytes."""
    from rich.progress import BarColumn, DownloadColumn, TextColumn, TimeRemainingColumn
    from rich.progress import Progress as Bar

    columns = TextColumn(word), BarColumn(), DownloadColumn(), TimeRemainingColumn()
    with Bar(*columns, console=console(err=True)) as progress:
        task = progress.add_task("", total=total, completed=completed)
        yield lambda read: progress.advance(task, read)
