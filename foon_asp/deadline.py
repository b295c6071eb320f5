"""When to stop: at a time limit, at a memory limit, at ctrl-C, or where a token says so."""

import contextlib
import math
import os
import re
import signal
import sys
import threading
import time
import weakref
from collections.abc import Iterator
from contextvars import ContextVar
from pathlib import Path
from queue import Empty, SimpleQueue
from types import TracebackType
from typing import Self

from foon_asp.aside import Aside
from foon_asp.errors import UserError

_STATM = Path("/proc/self/statm")
_PAGE = os.sysconf("SC_PAGE_SIZE") if hasattr(os, "sysconf") else 4096
_ADVICE = {
    "reading": "raise the limit, or if the network is text, make a store of it once: foon-asp merge --store",
    "grounding": "rules that were added may be endless, as in p(f(X)) :- p(X), or have too many instances: "
    "check them, or raise the limit",
}
_LATE = 0.5  # seconds, and half of it after a cancel
_MEMORY_LATE = 0.1  # seconds
_GRACE = 0.25  # seconds
_CANCELLED = "a cancel"
_PROVED, _INTERRUPTED = "a proof", "ctrl-C"
_STRIKES, _BETWEEN = 5, 3.0  # interrupts, and seconds between them
_WAITS = 50  # looks until an interrupt is taken for lost
_LOOKS = 0.02  # seconds between two looks at the memory
_MOMENT = 0.001  # seconds, in which who is about to strike does so
_UNITS = {"": 1, "K": 2**10, "M": 2**20, "G": 2**30, "T": 2**40}


class StoppedError(Exception):
    """A question was stopped, by its token or at a limit, before there was anything to give.

    Example:
        >>> token = foon_asp.Cancel()
        >>> token.cancel()
        >>> foon_asp.why_not(foon_asp.load().problem("ice"), cancel=token)
        Traceback (most recent call last):
        foon_asp.deadline.StoppedError: cancelled
    """


class Cancel:
    """A token that ends every question it was given to, within a second, from any thread.

    A question that knows something by then gives that, as at a time limit; any other raises
    :class:`StoppedError`.

    Example:
        >>> token = foon_asp.Cancel()
        >>> foon_asp.solve(foon_asp.load().problem("ice"), cancel=token).costs.units
        2
        >>> token.cancel()
        >>> token.cancelled, token.since(60)
        (True, False)
    """

    def __init__(self) -> None:
        self._at: float | None = None

    def cancel(self) -> None:
        """End the questions; those asked with this token later end at once."""
        if self._at is None:
            self._at = time.monotonic()

    @property
    def cancelled(self) -> bool:
        """Whether it ends questions."""
        return self._at is not None

    def since(self, late: float) -> bool:
        """Whether it has ended questions for so long that they should have ended by themselves.

        Parameters:
            late: How long that is, in seconds.
        """
        return self._at is not None and time.monotonic() >= self._at + late


_CANCEL: ContextVar[Cancel | None] = ContextVar("cancel", default=None)


@contextlib.contextmanager
def stoppable(seconds: float | None, token: Cancel | None, doing: str) -> Iterator["Deadline"]:
    """Stop what is in a ``with`` block in time, or where a token says so, which deadlines made in it obey.

    Who looks at deadlines has time to end with what is known; then the block is interrupted, and
    :class:`StoppedError` is raised.
    """
    if token is not None and token.cancelled:
        raise StoppedError("cancelled")
    before = _CANCEL.set(_CANCEL.get() if token is None else token)
    try:
        deadline = Deadline(seconds)
        deadline._late *= 3  # for what all ends that are looked at, and all watches, left running
        try:
            with deadline.watched(doing, late=seconds is None):
                yield deadline
        except KeyboardInterrupt as stop:
            if isinstance(stop, LimitError) or (deadline.passed and not deadline.interrupted):
                raise StoppedError(_said(stop, deadline)) from None
            raise
    finally:
        _CANCEL.reset(before)


def _said(stop: KeyboardInterrupt, deadline: "Deadline") -> str:
    token = _CANCEL.get()
    if token is not None and token.cancelled:
        return "cancelled"
    return f"stopped at {stop.stopped if isinstance(stop, LimitError) else deadline.stopped}"


class LimitError(KeyboardInterrupt):
    """A limit was reached, or ctrl-C pressed, where there is nothing to give yet.

    What holds at ctrl-C holds at a limit: so it is one, and no handler of other errors takes it for a fault.
    ``stopped`` says at what and while doing what, ``advice`` what to do.
    """

    def __init__(self, deadline: "Deadline") -> None:
        super().__init__(deadline.stopped)
        self.stopped, self.advice = deadline.stopped or "a limit", deadline.advice


class Deadline:
    """When to stop, shared by all that is done for one question, and at what it stopped.

    ``seconds`` count from the beginning, ``memory`` is in bytes; ``None`` is never. The memory is that of
    this process together with those that work for it. It is over at the latest ``within`` another one, and
    ctrl-C ends both. ``doing`` says what is being done, as it follows on
    "while". Raises :class:`UserError` for a memory limit where the system does not tell how much is in use.
    """

    def __init__(
        self,
        seconds: float | None = None,
        memory: int | None = None,
        began: float | None = None,
        within: "Deadline | None" = None,
    ) -> None:
        if memory is not None and not _STATM.exists():
            raise UserError(
                "a memory limit works only on Linux, where /proc shows how much memory is in use; leave it "
                "out, and use a limit of the system"
            )
        self.seconds, self.memory = seconds, memory
        self._doing = "reading"
        self._end = None if seconds is None else (time.monotonic() if began is None else began) + seconds
        self._within = within
        if within is not None:
            if within._end is not None and (self._end is None or within._end < self._end):
                self.seconds, self._end = within.seconds, within._end
            if within.memory is not None and (memory is None or within.memory < memory):
                self.memory = within.memory
        self._time_words = "" if self.seconds is None else f"the time limit of {self.seconds:g} s"
        self._workers: set[int] = set()
        self._looked = 0.0
        self._by: str | None = None
        self._token = _CANCEL.get()
        self._late = _LATE
        self._noticed: float | None = None  # when somebody saw that it was over

    @property
    def doing(self) -> str:
        """What is being done, or was when it stopped."""
        return self._doing

    @doing.setter
    def doing(self, what: str) -> None:
        """Note what is being done, unless it has stopped before."""
        if self._by is None:
            self._doing = what

    @property
    def passed(self) -> bool:
        """Whether to stop."""
        if self._by is not None:
            return True
        if self._within is not None and self._within.interrupted:
            self._by = self._within._by
            return True
        if self._token is not None and self._token.cancelled:
            self._by = _CANCELLED
            return True
        if self._end is None and self.memory is None:
            return False
        now = time.monotonic()
        if self._end is not None and now >= self._end:
            self._by = self._time_words
        elif self.memory is not None and now >= self._looked + _LOOKS:
            self._looked = now
            if self.memory_in_use() > self.memory:
                self.out_of_memory()
        return self._by is not None

    @property
    def interrupted(self) -> bool:
        """Whether ctrl-C was pressed."""
        return self._by == _INTERRUPTED

    @property
    def left(self) -> float | None:
        """The seconds that are left, ``None`` where time is not limited."""
        return None if self._end is None else max(0.0, self._end - time.monotonic())

    @property
    def limited(self) -> bool:
        """Whether anything but ctrl-C can end it."""
        return self.seconds is not None or self.memory is not None or self._token is not None

    @property
    def overdue(self) -> bool:
        """Whether to stop even where nothing is known yet, which may still come half a second late."""
        if not self.passed:
            return False
        if self._by == _CANCELLED:
            return self._token is None or self._token.since(self._late / 2)
        now = time.monotonic()
        if self._end is not None and self._by == self._time_words:
            return now >= self._end + self._late
        if self._noticed is None:
            self._noticed = now
        return now >= self._noticed + (_MEMORY_LATE if self.full else self._late)

    @property
    def full(self) -> bool:
        """Whether there was no more memory: what comes to an end may, but nothing else is begun."""
        return self._by is not None and self._by not in {
            self._time_words,
            _CANCELLED,
            _PROVED,
            _INTERRUPTED,
        }

    def interrupt(self) -> None:
        """Note that ctrl-C was pressed, unless a limit came before."""
        if self._by is None:
            self._by = _INTERRUPTED
            if self._within is not None:
                self._within.interrupt()

    def enough(self) -> None:
        """Note that all that was asked for is known; what this is within goes on."""
        self._by = self._by or _PROVED

    def out_of_memory(self) -> None:
        """Note that there is no more memory."""
        limit = "" if self.memory is None else f"the memory limit of {size_text(self.memory)}"
        self._by = self._by or limit or "the end of memory"

    @property
    def stopped(self) -> str | None:
        """The limit that stopped the work, and what was being done, as a text; ``None`` before."""
        return None if self._by is None else f"{self._by} while {self._doing}"

    @property
    def advice(self) -> str:
        """What to do about it, as a text."""
        return _ADVICE.get(self._doing, "raise the limit")

    def check(self) -> None:
        """Raise :class:`LimitError` where it is time to stop."""
        if self.passed:
            raise LimitError(self)

    def slice(self, longest: float = 0.2) -> float:
        """Give how long to wait before looking again."""
        if self.memory is not None:
            longest = min(longest, 2 * _LOOKS)
        left = self.left
        return longest if left is None else min(longest, left)

    def memory_in_use(self) -> int:
        """Give how many bytes this process and those that work for it have in memory."""
        return sum(_resident(Path(f"/proc/{pid}/statm")) for pid in ("self", *self._workers))

    def count(self, process: int) -> None:
        """Count the memory of another process, too."""
        self._workers.add(process)

    def uncount(self, process: int) -> None:
        """Leave a process out again."""
        self._workers.discard(process)

    def watched(self, doing: str, late: bool = False, grace: bool = False) -> "Watch":
        """Stop what is in a ``with`` block at the limits: for work that does not look at them itself.

        Raises :class:`LimitError` in the middle of it. So there may be nothing to lose in the block, and
        nothing that continues after ctrl-C. With ``late`` it is stopped only when overdue, and with ``grace``
        never before a quarter of a second, to come to an end with what is known already.
        """
        return Watch(self, doing, late, grace)


@contextlib.contextmanager
def none_lost() -> Iterator[None]:
    """Let no interrupt be lost in a ``with`` block of the main thread, nor a word said of it.

    Nothing comes out of a destructor, so what strikes in one strikes again a moment later.
    """
    before = sys.unraisablehook
    main = threading.main_thread().ident or 0

    def strike_again() -> None:
        time.sleep(_LOOKS)
        signal.pthread_kill(main, signal.SIGINT)

    def again(lost: "sys.UnraisableHookArgs") -> None:
        destroyed = getattr(lost.object, "__name__", "") == "__del__"
        if destroyed and issubclass(lost.exc_type, AttributeError):
            return  # an interrupt left the object half made
        if not issubclass(lost.exc_type, KeyboardInterrupt):
            before(lost)
        elif threading.get_ident() == main and hasattr(signal, "pthread_kill"):
            Aside(strike_again)

    sys.unraisablehook = again
    try:
        yield
    finally:
        sys.unraisablehook = before


@contextlib.contextmanager
def uninterrupted() -> Iterator[None]:
    """Let neither ctrl-C nor a watch of any thread strike in a ``with`` block, but right after it.

    C libraries make an ``ImportError`` of one that strikes while they are imported, and stay broken.
    """
    came: list[int] = []
    shield, here = object(), threading.get_ident()
    before = signal.getsignal(signal.SIGINT)
    is_main = threading.current_thread() is threading.main_thread() and callable(before)
    try:
        if is_main:
            signal.signal(signal.SIGINT, lambda number, _: came.append(number))
        _shields[shield] = here
        while here in _aims:  # one is on its way
            time.sleep(_MOMENT)
        yield
    finally:
        while True:  # ctrl-C may strike as soon as it is let through again
            try:
                if is_main:
                    signal.signal(signal.SIGINT, before)
                _shields.pop(shield, None)
                break
            except KeyboardInterrupt:
                came.append(signal.SIGINT)
        if came:
            signal.raise_signal(signal.SIGINT)


# Who strikes first says at whom, and then looks whether it may; who may not be struck first says so, and then
# looks whether somebody is about to. So neither needs a lock, in which an interrupt could land.
_aims: list[int] = []  # threads about to be struck
_shields: dict[object, int] = {}  # threads that may not be
if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_aims.clear)  # those who were about to are not here


class Watch:
    """A thread that looks at a deadline while another one works, and interrupts it as ctrl-C does.

    An interrupt that strikes in the very moment in which the block ends leaves it as ``KeyboardInterrupt``.
    """

    def __init__(self, deadline: Deadline, doing: str, late: bool, grace: bool) -> None:
        self._deadline, self._doing, self._late = deadline, doing, late
        self._earliest = time.monotonic() + _GRACE if grace else -math.inf
        self._begins = grace  # whatever has passed
        self._thread = threading.get_ident()
        self._over = self._struck = False
        self._wake: SimpleQueue[None] = SimpleQueue()

    def __enter__(self) -> Self:
        deadline = self._deadline
        deadline.doing = self._doing
        if self._due or (deadline.passed and deadline.full and not self._begins):
            raise LimitError(deadline)
        if deadline.limited:
            try:
                if not self._is_woken_by_signals:
                    import ctypes  # noqa: F401, PLC0415 (to have it when it strikes)
                Aside(_watch, weakref.ref(self), self._wake)
            except BaseException:
                self._end()
                raise
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        came = kind is not None and issubclass(kind, KeyboardInterrupt)
        while True:  # an interrupt may strike in the middle of this, which can be done again
            try:
                self._end()
                if self._struck and not came:
                    for _ in range(_WAITS):
                        time.sleep(_LOOKS)
                break
            except KeyboardInterrupt:
                came = True
        if self._struck:
            raise LimitError(self._deadline) from None
        if came:
            self._deadline.interrupt()
            if kind is None:
                raise KeyboardInterrupt

    def _end(self) -> None:
        """Let nothing strike any more."""
        self._over = True
        self._wake.put(None)
        while self._thread in _aims:  # who is about to strike does so now
            time.sleep(_MOMENT)

    @property
    def _due(self) -> bool:
        due = self._deadline.overdue if self._late else self._deadline.passed
        return due and time.monotonic() >= self._earliest

    def next_look(self, strikes: int) -> tuple[float, int] | None:
        """Strike when it is time, again and again, for one in a destructor is lost; ``None`` after the last.

        Returns the seconds until the next look, and how often it has struck.
        """
        if self._over or strikes == _STRIKES:
            return None
        if not self._due:
            return max(_LOOKS, self._deadline.slice()), strikes
        _aims.append(self._thread)
        try:
            if self._over:
                return None
            if self._thread in _shields.values():
                return _LOOKS, strikes
            self._struck = True
            self._strike()
        finally:
            _aims.remove(self._thread)
        return _BETWEEN, strikes + 1

    @property
    def _is_woken_by_signals(self) -> bool:
        return (
            self._thread == threading.main_thread().ident
            and hasattr(signal, "pthread_kill")
            and signal.getsignal(signal.SIGINT) is signal.default_int_handler
        )

    def _strike(self) -> None:
        if self._is_woken_by_signals:
            signal.pthread_kill(self._thread, signal.SIGINT)  # wakes it from waiting for a file, too
            return
        import ctypes  # noqa: PLC0415 (seldom needed)

        ctypes.pythonapi.PyThreadState_SetAsyncExc(
            ctypes.c_ulong(self._thread), ctypes.py_object(KeyboardInterrupt)
        )


def _watch(watching: "weakref.ref[Watch]", wake: "SimpleQueue[None]") -> None:
    """Look at a watch until it is over, or was left by an interrupt that came before it could be ended."""
    pause, strikes = _LOOKS, 0
    while True:
        with contextlib.suppress(Empty):
            wake.get(timeout=pause)
            return
        watch = watching()
        told = None if watch is None else watch.next_look(strikes)
        del watch
        if told is None:
            return
        pause, strikes = told


def _resident(statm: Path) -> int:
    try:
        return int(statm.read_bytes().split()[1]) * _PAGE
    except (OSError, IndexError):  # the process has ended
        return 0


def seconds(given: float | str, what: str = "the time limit") -> float:
    """Read a number of seconds from 0 on; raises :class:`UserError` for others."""
    try:
        value = float(given)
    except (TypeError, ValueError, OverflowError):
        value = math.nan
    if isinstance(given, bool) or not 0 <= value < math.inf:
        raise UserError(f"found {what} {given!r}, expected a number of seconds from 0")
    return value


def memory_size(given: int | str, what: str = "the memory limit") -> int:
    """Read a size in bytes, a whole number or one with K, M, G or T; raises :class:`UserError` for others."""
    if isinstance(given, int) and not isinstance(given, bool) and given > 0:
        return given
    found = re.fullmatch(r"(\d{1,15}(?:\.\d{1,6})?)\s*([KMGT]?)(?:i?B)?", str(given).strip(), re.I | re.ASCII)
    size = int(float(found[1]) * _UNITS[found[2].upper()]) if found and isinstance(given, str) else 0
    if size <= 0:
        raise UserError(f"found {what} {given!r}, expected a size such as 500M or 2G, or bytes")
    return size


def size_text(size: int) -> str:
    """Say a size, in the greatest unit in which it is a whole number."""
    for letter in "TGMK":
        if size % _UNITS[letter] == 0:
            return f"{size // _UNITS[letter]}{letter}"
    return f"{size} bytes"
