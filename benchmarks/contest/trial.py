"""One engine on one question, in a process group of its own that is ended as a whole."""

import gc
import json
import os
import select
import signal
import sys
import time
import traceback
from collections.abc import Callable
from enum import StrEnum
from typing import Any, NamedTuple

_READYING = 120.0  # seconds for importing what an engine needs, which its clock leaves out

Work = Callable[[Callable[[], None]], dict[str, Any]]


class End(StrEnum):
    """How a trial ended: with an answer, at the limit of time, or without either (out of memory, a crash)."""

    ANSWERED = "answered"
    TIME = "time"
    FAILED = "failed"


class Trial(NamedTuple):
    """What came of a trial.

    ``seconds`` are those of wall-clock time from the start of the clock to the answer, the limit where none
    came in time. ``said`` is what the work gave, ``memory`` the largest peak of any of its processes in
    bytes, the network in memory included. ``trouble`` is what a failed one wrote last.
    """

    end: End
    seconds: float
    said: dict[str, Any]
    memory: int
    trouble: str = ""


def attempt(work: Work, limit: float) -> Trial:
    """Do some work in a forked process, and kill it with all that it started when the time is up.

    ``work`` is given a function that starts its clock, to be called when everything is imported; what it
    returns has to go through JSON, and to raise :class:`TimeoutError` is to give up. The process has all
    that this one has in memory. Needs ``fork``.
    """
    gc.freeze()  # so that nothing that is there already is looked at, and copied, by a collection
    sys.stdout.flush()
    reading, writing = os.pipe()
    child = os.fork()
    if child == 0:
        os.close(reading)
        _child(work, writing)
    os.close(writing)
    text = b""
    end = time.monotonic() + _READYING
    started = False
    try:
        while True:
            ready, _, _ = select.select([reading], [], [], max(0.0, end - time.monotonic()))
            part = os.read(reading, 65536) if ready else b""
            if not part:
                timed_out = not ready
                break
            text += part
            if not started and b"\n" in text:
                started, end = True, time.monotonic() + limit
    finally:
        os.close(reading)
        _kill(child)
        _, _, usage = os.wait4(child, 0)
    memory = usage.ru_maxrss * (1 if sys.platform == "darwin" else 1024)
    lines = text.decode().split("\n")
    if len(lines) < 3:  # no whole answer
        if timed_out and started:
            return Trial(End.TIME, limit, {}, memory)
        return Trial(End.FAILED, limit, {}, memory, "was ended from outside, perhaps for want of memory")
    said = json.loads(lines[1])
    if "stopped" in said:
        return Trial(End.TIME, limit, {}, memory)
    if "trouble" in said:
        return Trial(End.FAILED, limit, {}, memory, said["trouble"])
    return Trial(End.ANSWERED, said.pop("seconds"), said, memory)


def _child(work: Work, writing: int) -> None:
    began = [0.0]

    def start() -> None:
        os.write(writing, b"started\n")
        began[0] = time.perf_counter()

    gc.set_threshold(100_000, 50, 50)  # as the command line has it, for all
    try:
        os.setsid()
        said = work(start)
        said["seconds"] = time.perf_counter() - began[0]
    except TimeoutError:
        said = {"stopped": True}
    except BaseException:
        said = {"trouble": traceback.format_exc()[-3000:]}
        if not began[0]:
            os.write(writing, b"never started\n")
    try:
        answer = memoryview(f"{json.dumps(said)}\n".encode())
        while answer:
            answer = answer[os.write(writing, answer) :]
    finally:
        os._exit(0)


def _kill(child: int) -> None:
    """End a process and its group; it may not yet have one."""
    for kill in (os.killpg, os.kill):
        try:
            kill(child, signal.SIGKILL)
        except (ProcessLookupError, PermissionError):
            continue
