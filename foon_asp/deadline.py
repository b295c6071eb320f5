"""Deadlines: time and memory limits, ctrl-C and cancellation, and interrupts of code that ignores them."""

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
from typing import NamedTuple, Self

from foon_asp.daemon_thread import DaemonThread
from foon_asp.errors import UserError

_STATM = Path("/proc/self/statm")
_PAGE_BYTES = os.sysconf("SC_PAGE_SIZE") if hasattr(os, "sysconf") else 4096
_ADVICE = {
    "reading": "raise the limit, or if the network is text, make a store of it once: foon-asp merge --store",
    "grounding": "rules that were added may be endless, as in p(f(X)) :- p(X), or have too many instances: "
    "check them, or raise the limit",
}
_CANCELLED = "a cancel"
_PROVED, _INTERRUPTED = "a proof", "ctrl-C"
_UNITS = {"": 1, "K": 2**10, "M": 2**20, "G": 2**30, "T": 2**40}


class _Pace(NamedTuple):
    """How long work may continue after a limit, and how often limits are checked.

    Attributes:
        tolerance_seconds: The time from a limit until work is overdue and is interrupted; after a cancel, it
            is half as long. A longer time lets more work end with an answer; a shorter one ends work sooner.
        memory_tolerance_seconds: The time from the memory limit until work is overdue.
        grace_seconds: The least time for the last piece of work if it begins at a limit.
        poll_seconds: The time between two checks of the memory. With a longer time, the limit is overshot; a
            shorter one makes work slower.
        max_interrupts: The greatest number of interrupts that are sent. Some are lost in destructors.
        interrupt_seconds: The time between two interrupts.
        lost_polls: The number of polls after which an interrupt counts as lost; together they take a second.
        handover_seconds: The time between two checks of whether another thread has sent its interrupt.
    """

    tolerance_seconds: float = 0.5
    memory_tolerance_seconds: float = 0.1
    grace_seconds: float = 0.25
    poll_seconds: float = 0.02
    max_interrupts: int = 5
    interrupt_seconds: float = 3.0
    lost_polls: int = 50
    handover_seconds: float = 0.001


_PACE = _Pace()


class StoppedError(Exception):
    """A question was stopped, by its token or at a limit, before it had any answer.

    Example:
        >>> token = foon_asp.Cancel()
        >>> token.cancel()
        >>> foon_asp.why_not(foon_asp.load().problem("ice"), cancel=token)
        Traceback (most recent call last):
        foon_asp.deadline.StoppedError: cancelled
    """


class Cancel:
    """A token that is passed to questions, and by which any thread can cancel them within a second.

    A cancelled question that has an incumbent returns it, as at a time limit. A cancelled question without an
    incumbent raises :class:`StoppedError`.

    Example:
        >>> token = foon_asp.Cancel()
        >>> foon_asp.solve(foon_asp.load().problem("ice"), cancel=token).costs.units
        2
        >>> token.cancel()
        >>> token.cancelled, token.since(60)
        (True, False)
    """

    def __init__(self) -> None:
        self._cancelled_at: float | None = None

    def cancel(self) -> None:
        """Cancel the questions; later questions with this token end at once."""
        if self._cancelled_at is None:
            self._cancelled_at = time.monotonic()

    @property
    def cancelled(self) -> bool:
        """Whether the token was cancelled."""
        return self._cancelled_at is not None

    def since(self, late: float) -> bool:
        """Return whether the token was cancelled at least ``late`` seconds ago.

        Parameters:
            late: The seconds in which questions should end by themselves.
        """
        return self._cancelled_at is not None and time.monotonic() >= self._cancelled_at + late


_CANCEL: ContextVar[Cancel | None] = ContextVar("cancel", default=None)


@contextlib.contextmanager
def stoppable(seconds: float | None, token: Cancel | None, doing: str) -> Iterator["Deadline"]:
    """Limit the time of a ``with`` block, and end it when its token is cancelled.

    ``seconds``: the time limit; ``None`` for no limit.
    ``token``: the token, which all deadlines made in the block obey; ``None`` for that of an outer block.
    ``doing``: the work for messages, as in "while reading".

    The value of the context is the deadline of the block. Raises :class:`StoppedError` at once if the token
    was cancelled before, and otherwise when the block is interrupted. With ``seconds``, it is interrupted at
    the limit or as soon as the token is cancelled. Without ``seconds``, it is interrupted 0.75 seconds after
    the cancel; until then, its code can end with an incumbent. Ctrl-C is passed on.
    """
    if token is not None and token.cancelled:
        raise StoppedError("cancelled")
    reset_token = _CANCEL.set(_CANCEL.get() if token is None else token)
    try:
        deadline = Deadline(seconds)
        deadline._tolerance *= 3  # the last resort, after the checks and the watches within the block
        try:
            with deadline.watched(doing, late=seconds is None):
                yield deadline
        except KeyboardInterrupt as stop:
            if isinstance(stop, LimitError) or (deadline.passed and not deadline.interrupted):
                raise StoppedError(_stop_reason(stop, deadline)) from None
            raise
    finally:
        _CANCEL.reset(reset_token)


def _stop_reason(stop: KeyboardInterrupt, deadline: "Deadline") -> str:
    """Return ``cancelled`` if the token was cancelled; otherwise ``stopped at``, the limit and the work."""
    token = _CANCEL.get()
    if token is not None and token.cancelled:
        return "cancelled"
    return f"stopped at {stop.stopped if isinstance(stop, LimitError) else deadline.stopped}"


class LimitError(KeyboardInterrupt):
    """A limit was reached, the question was cancelled, or ctrl-C was pressed, before any answer.

    It is a ``KeyboardInterrupt``. So handlers of ctrl-C also catch it, and handlers of ``Exception`` do not.

    ``stopped``: the limit and the work, in words.
    ``advice``: advice for the user.
    """

    def __init__(self, deadline: "Deadline") -> None:
        super().__init__(deadline.stopped)
        self.stopped, self.advice = deadline.stopped or "a limit", deadline.advice


class Deadline:
    """The limits of one question, shared by all its work, and the limit that stopped it.

    It also obeys the token of the :func:`stoppable` block in which it is made. ``doing`` describes the
    current work, as in "while reading".

    Parameters:
        seconds: The time limit; ``None`` for no limit.
        memory: The memory limit in bytes, for this process and its workers; ``None`` for no limit.
        began: The start of the time, on the monotonic clock; by default, now.
        within: An outer deadline. The smaller limits of both apply, and ctrl-C ends both.

    Raises :class:`UserError` for a memory limit if the system does not report the memory in use.
    """

    def __init__(
        self,
        seconds: float | None = None,
        memory: int | None = None,
        began: float | None = None,
        within: "Deadline | None" = None,
    ) -> None:
        """Begin to count the time; take over smaller limits of ``within``, and the current token."""
        if memory is not None and not _STATM.exists():
            raise UserError(
                "a memory limit works only on Linux, where /proc shows how much memory is in use; leave it "
                "out, and use a limit of the system"
            )
        self.seconds, self.memory = seconds, memory
        self._doing = "reading"
        self._end_time = None if seconds is None else (time.monotonic() if began is None else began) + seconds
        self._within = within
        if within is not None:
            if within._end_time is not None and (self._end_time is None or within._end_time < self._end_time):
                self.seconds, self._end_time = within.seconds, within._end_time
            if within.memory is not None and (memory is None or within.memory < memory):
                self.memory = within.memory
        self._time_limit_text = "" if self.seconds is None else f"the time limit of {self.seconds:g} s"
        self._counted_processes: set[int] = set()
        self._memory_polled_at = 0.0
        self._stopped_by: str | None = None
        self._token = _CANCEL.get()
        self._tolerance = _PACE.tolerance_seconds
        self._noticed_at: float | None = None  # when ``overdue`` first saw that the deadline has passed

    @property
    def doing(self) -> str:
        """The current work; if the question was stopped, the work at that time."""
        return self._doing

    @doing.setter
    def doing(self, work: str) -> None:
        """Set the current work, unless the question was stopped."""
        if self._stopped_by is None:
            self._doing = work

    @property
    def passed(self) -> bool:
        """Whether a limit is reached, or the question was stopped by a proof, a cancel or ctrl-C.

        The first reason is kept for :attr:`stopped`. Memory is read only every 0.02 seconds.
        """
        if self._stopped_by is not None:
            return True
        if self._within is not None and self._within.interrupted:
            self._stopped_by = self._within._stopped_by
            return True
        if self._token is not None and self._token.cancelled:
            self._stopped_by = _CANCELLED
            return True
        if self._end_time is None and self.memory is None:
            return False
        now = time.monotonic()
        if self._end_time is not None and now >= self._end_time:
            self._stopped_by = self._time_limit_text
        elif self.memory is not None and now >= self._memory_polled_at + _PACE.poll_seconds:
            self._memory_polled_at = now
            if self.memory_in_use() > self.memory:
                self.stop_out_of_memory()
        return self._stopped_by is not None

    @property
    def interrupted(self) -> bool:
        """Whether ctrl-C stopped the question."""
        return self._stopped_by == _INTERRUPTED

    @property
    def remaining_seconds(self) -> float | None:
        """The seconds until the time limit, at least 0; ``None`` without a time limit."""
        return None if self._end_time is None else max(0.0, self._end_time - time.monotonic())

    @property
    def is_limited(self) -> bool:
        """Whether the question may be stopped: it has a time limit, a memory limit or a token."""
        return self.seconds is not None or self.memory is not None or self._token is not None

    @property
    def overdue(self) -> bool:
        """Whether to stop even without an answer, since the time for ending with an answer is over.

        The time is half a second after the time limit, a proof or ctrl-C. After a cancel, it is a quarter of
        a second; after the memory limit, 0.1 seconds. For the deadline of :func:`stoppable`, the times are
        three times as long, except that after the memory limit. After a proof, ctrl-C or the memory limit,
        the time begins when this property is first read.
        """
        if not self.passed:
            return False
        if self._stopped_by == _CANCELLED:
            return self._token is None or self._token.since(self._tolerance / 2)
        now = time.monotonic()
        if self._end_time is not None and self._stopped_by == self._time_limit_text:
            return now >= self._end_time + self._tolerance
        if self._noticed_at is None:
            self._noticed_at = now
        return now >= self._noticed_at + (
            _PACE.memory_tolerance_seconds if self.is_out_of_memory else self._tolerance
        )

    @property
    def is_out_of_memory(self) -> bool:
        """Whether memory stopped the question: the memory limit, or an allocation that failed.

        Then the current work may finish, but no other work begins.
        """
        return self._stopped_by is not None and self._stopped_by not in {
            self._time_limit_text,
            _CANCELLED,
            _PROVED,
            _INTERRUPTED,
        }

    def interrupt(self) -> None:
        """Stop the question and the outer deadlines because of ctrl-C, unless it was stopped before."""
        if self._stopped_by is None:
            self._stopped_by = _INTERRUPTED
            if self._within is not None:
                self._within.interrupt()

    def stop_at_proof(self) -> None:
        """Stop the question because its answer is proved, unless it was stopped before.

        An outer deadline (``within``) is not stopped.
        """
        self._stopped_by = self._stopped_by or _PROVED

    def stop_out_of_memory(self) -> None:
        """Stop the question because of the memory, unless it was stopped before."""
        limit = "" if self.memory is None else f"the memory limit of {size_text(self.memory)}"
        self._stopped_by = self._stopped_by or limit or "the end of memory"

    @property
    def stopped(self) -> str | None:
        """The limit that stopped the question, and the work that was stopped, in words.

        An example is ``the time limit of 5 s while reading``. It is ``None`` if the question was not stopped.
        """
        return None if self._stopped_by is None else f"{self._stopped_by} while {self._doing}"

    @property
    def advice(self) -> str:
        """A sentence of advice for the user about the limit; it depends on the work that was stopped."""
        return _ADVICE.get(self._doing, "raise the limit")

    def check(self) -> None:
        """Raise :class:`LimitError` if the deadline has passed."""
        if self.passed:
            raise LimitError(self)

    def seconds_to_next_check(self, longest: float = 0.2) -> float:
        """Return the seconds to wait until the next check of the deadline.

        They are at most ``longest``, at most the time left, and with a memory limit at most 0.04.
        """
        if self.memory is not None:
            longest = min(longest, 2 * _PACE.poll_seconds)
        remaining = self.remaining_seconds
        return longest if remaining is None else min(longest, remaining)

    def memory_in_use(self) -> int:
        """Return the resident memory of this process and of the counted ones, in bytes."""
        return sum(_resident_bytes(Path(f"/proc/{pid}/statm")) for pid in ("self", *self._counted_processes))

    def count_memory_of(self, process: int) -> None:
        """Count the memory of another process, by its id, towards the memory limit."""
        self._counted_processes.add(process)

    def uncount_memory_of(self, process: int) -> None:
        """Stop counting the memory of another process."""
        self._counted_processes.discard(process)

    def watched(self, doing: str, late: bool = False, grace: bool = False) -> "Watch":
        """Return a context that interrupts its ``with`` block at the limits.

        It is for code that does not check the limits itself. :class:`LimitError` may be raised at the start,
        and anywhere in the block. So the block must be safe to abort, and must not handle ctrl-C itself.

        ``doing``: becomes the current work.
        ``late``: whether the block is interrupted only when it is overdue.
        ``grace``: whether the block has at least a quarter of a second to finish an answer, also at a limit.
        """
        return Watch(self, doing, late, grace)


@contextlib.contextmanager
def resend_lost_interrupts() -> Iterator[None]:
    """Repeat interrupts that Python loses in a ``with`` block of the main thread.

    Python only reports an exception in a destructor, and does not raise it. So ctrl-C in a destructor has no
    effect, unless it is sent again. This works where the system can send signals to threads.
    """
    previous_hook = sys.unraisablehook
    main = threading.main_thread().ident or 0

    def send_again() -> None:
        """Interrupt the main thread a moment later, when the destructor has ended."""
        time.sleep(_PACE.poll_seconds)
        signal.pthread_kill(main, signal.SIGINT)

    def hook(lost: "sys.UnraisableHookArgs") -> None:
        """Send a lost interrupt again, and pass on other exceptions that Python does not raise.

        An ``AttributeError`` in a destructor is ignored.
        """
        in_destructor = getattr(lost.object, "__name__", "") == "__del__"
        if in_destructor and issubclass(lost.exc_type, AttributeError):
            return  # an interrupt in its constructor left the object incomplete
        if not issubclass(lost.exc_type, KeyboardInterrupt):
            previous_hook(lost)
        elif threading.get_ident() == main and hasattr(signal, "pthread_kill"):
            DaemonThread(send_again)

    sys.unraisablehook = hook
    try:
        yield
    finally:
        sys.unraisablehook = previous_hook


@contextlib.contextmanager
def uninterrupted() -> Iterator[None]:
    """Defer ctrl-C and interrupts of :class:`Watch` until the end of a ``with`` block.

    Several interrupts become one. Outside of the main thread, only interrupts of a watch are deferred.

    Imports need this: a C library that is interrupted during its import raises ``ImportError``, and cannot be
    imported any more.
    """
    deferred: list[int] = []
    shield, thread = object(), threading.get_ident()
    handler = signal.getsignal(signal.SIGINT)
    is_main = threading.current_thread() is threading.main_thread() and callable(handler)
    try:
        if is_main:
            signal.signal(signal.SIGINT, lambda number, _: deferred.append(number))
        _shields[shield] = thread
        while thread in _targets:  # a watch is sending an interrupt
            time.sleep(_PACE.handover_seconds)
        yield
    finally:
        while True:  # ctrl-C may interrupt as soon as the handler is restored
            try:
                if is_main:
                    signal.signal(signal.SIGINT, handler)
                _shields.pop(shield, None)
                break
            except KeyboardInterrupt:
                deferred.append(signal.SIGINT)
        if deferred:
            signal.raise_signal(signal.SIGINT)


# A watch first announces its target, and then checks whether it is shielded; a thread first announces that it
# is shielded, and then checks whether it is a target. So neither needs a lock, which an interrupt could leave
# locked.
_targets: list[int] = []  # threads to which an interrupt is being sent
_shields: dict[object, int] = {}  # threads that must not be interrupted
if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_targets.clear)  # the watches are threads of the parent


class Watch:
    """A context that interrupts its thread at a deadline, as ctrl-C would.

    A background thread polls the deadline. The parameters are those of :meth:`Deadline.watched`. Ctrl-C at
    the very end of the block is raised as ``KeyboardInterrupt``.
    """

    def __init__(self, deadline: Deadline, doing: str, late: bool, grace: bool) -> None:
        self._deadline, self._doing, self._late = deadline, doing, late
        self._earliest = time.monotonic() + _PACE.grace_seconds if grace else -math.inf
        self._has_grace = grace  # also at a deadline that has passed
        self._thread = threading.get_ident()
        self._finished = self._interrupted = False
        self._wake: SimpleQueue[None] = SimpleQueue()

    def __enter__(self) -> Self:
        """Set the current work, and start the background thread if the question has any limit.

        Without ``late``, raises :class:`LimitError` if the deadline has passed. With ``late``, raises it if
        the deadline is overdue or memory stopped the question. With ``grace``, raises nothing.
        """
        deadline = self._deadline
        deadline.doing = self._doing
        if self._is_due or (deadline.passed and deadline.is_out_of_memory and not self._has_grace):
            raise LimitError(deadline)
        if deadline.is_limited:
            try:
                if not self._is_woken_by_signals:
                    import ctypes  # noqa: F401, PLC0415 (imported before it is needed for an interrupt)
                DaemonThread(_poll_until_end, weakref.ref(self), self._wake)
            except BaseException:
                self._end()
                raise
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Stop the background thread; raises :class:`LimitError` if it has sent an interrupt.

        If its interrupt has not arrived yet, this waits up to a second for it. An interrupt that the thread
        has not sent is ctrl-C: it stops the deadline, and is passed on.
        """
        received = kind is not None and issubclass(kind, KeyboardInterrupt)
        while True:  # an interrupt may come within this loop, which can be repeated
            try:
                self._end()
                if self._interrupted and not received:
                    for _ in range(_PACE.lost_polls):
                        time.sleep(_PACE.poll_seconds)
                break
            except KeyboardInterrupt:
                received = True
        if self._interrupted:
            raise LimitError(self._deadline) from None
        if received:
            self._deadline.interrupt()
            if kind is None:
                raise KeyboardInterrupt

    def _end(self) -> None:
        """Stop the watch; return once it can send no more interrupt."""
        self._finished = True
        self._wake.put(None)
        while self._thread in _targets:  # an interrupt is being sent
            time.sleep(_PACE.handover_seconds)

    @property
    def _is_due(self) -> bool:
        """Whether to interrupt the block: the deadline has passed, or with ``late``, is overdue.

        With ``grace``, the block is not interrupted in its first quarter of a second.
        """
        due = self._deadline.overdue if self._late else self._deadline.passed
        return due and time.monotonic() >= self._earliest

    def poll(self, interrupt_count: int) -> tuple[float, int] | None:
        """Poll the deadline, and interrupt the thread if the deadline is due.

        Interrupts are repeated, since some are lost. They are postponed while the thread is in
        :func:`uninterrupted`. ``interrupt_count`` is the number of interrupts sent before. Return the seconds
        until the next poll and the number of interrupts sent so far. Return ``None`` after the last poll.
        """
        if self._finished or interrupt_count == _PACE.max_interrupts:
            return None
        if not self._is_due:
            return max(_PACE.poll_seconds, self._deadline.seconds_to_next_check()), interrupt_count
        _targets.append(self._thread)
        try:
            if self._finished:
                return None
            if self._thread in _shields.values():
                return _PACE.poll_seconds, interrupt_count
            self._interrupted = True
            self._interrupt()
        finally:
            _targets.remove(self._thread)
        return _PACE.interrupt_seconds, interrupt_count + 1

    @property
    def _is_woken_by_signals(self) -> bool:
        """Whether a signal interrupts the watched thread.

        It has to be the main thread, in which ctrl-C raises ``KeyboardInterrupt``. The system has to be able
        to send signals to threads.
        """
        return (
            self._thread == threading.main_thread().ident
            and hasattr(signal, "pthread_kill")
            and signal.getsignal(signal.SIGINT) is signal.default_int_handler
        )

    def _interrupt(self) -> None:
        """Raise ``KeyboardInterrupt`` in the watched thread, by a signal if that is possible.

        Otherwise, it is raised when the thread next runs Python code.
        """
        if self._is_woken_by_signals:
            signal.pthread_kill(self._thread, signal.SIGINT)  # also wakes it from blocking reads
            return
        import ctypes  # noqa: PLC0415 (seldom needed)

        ctypes.pythonapi.PyThreadState_SetAsyncExc(
            ctypes.c_ulong(self._thread), ctypes.py_object(KeyboardInterrupt)
        )


def _poll_until_end(watching: "weakref.ref[Watch]", wake: "SimpleQueue[None]") -> None:
    """Poll a watch in the background until its end.

    An interrupt can prevent the end of a watch. Then polling ends when the watch is garbage collected.
    """
    pause, interrupt_count = _PACE.poll_seconds, 0
    while True:
        with contextlib.suppress(Empty):
            wake.get(timeout=pause)
            return
        watch = watching()
        next_poll = None if watch is None else watch.poll(interrupt_count)
        del watch
        if next_poll is None:
            return
        pause, interrupt_count = next_poll


def _resident_bytes(statm: Path) -> int:
    """Return the resident memory of a process in bytes, read from its file in /proc; 0 if it has ended."""
    try:
        return int(statm.read_bytes().split()[1]) * _PAGE_BYTES
    except (OSError, IndexError):  # the process has ended
        return 0


def parse_seconds(number: float | str, quantity: str = "the time limit") -> float:
    """Return a number of seconds, at least 0, from a number or a text.

    Raises :class:`UserError` for other values; ``quantity`` names in the message what the seconds are.
    """
    try:
        value = float(number)
    except (TypeError, ValueError, OverflowError):
        value = math.nan
    if isinstance(number, bool) or not 0 <= value < math.inf:
        raise UserError(f"found {quantity} {number!r}, expected a number of seconds from 0")
    return value


def parse_memory_size(number: int | str, quantity: str = "the memory limit") -> int:
    """Return a size in bytes, from an integer or a text such as ``500M`` or ``2.5G``; ``K`` is 1024 bytes.

    Small letters and a following ``B`` or ``iB`` make no difference: ``500MiB``, ``500mb``.

    Raises :class:`UserError` for other values, also 0; ``quantity`` names in the message what the size is.
    """
    if isinstance(number, int) and not isinstance(number, bool) and number > 0:
        return number
    match = re.fullmatch(
        r"(\d{1,15}(?:\.\d{1,6})?)\s*([KMGT]?)(?:i?B)?", str(number).strip(), re.I | re.ASCII
    )
    size = int(float(match[1]) * _UNITS[match[2].upper()]) if match and isinstance(number, str) else 0
    if size <= 0:
        raise UserError(f"found {quantity} {number!r}, expected a size such as 500M or 2G, or bytes")
    return size


def size_text(size: int) -> str:
    """Return a size in bytes as text, in the largest unit in which it is a whole number.

    Examples are ``2G`` and ``100 bytes``.
    """
    for letter in "TGMK":
        if size % _UNITS[letter] == 0:
            return f"{size // _UNITS[letter]}{letter}"
    return f"{size} bytes"
