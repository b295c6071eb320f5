"""Work that processes share ends with the command that shares it, however that one ends."""

import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not Path("/proc/self/environ").exists(), reason="/proc says which processes run"),
]

_TRIES = 8
_PATIENCE = 15.0  # seconds


def marked(mark: str) -> list[int]:
    """List the processes that have a mark in their environment."""
    found = []
    for process in Path("/proc").glob("[0-9]*"):
        try:
            if mark.encode() in (process / "environ").read_bytes():  # a dead one has none
                found.append(int(process.name))
        except OSError:
            continue
    return found


@pytest.mark.parametrize("how", [signal.SIGINT, signal.SIGKILL])
@pytest.mark.parametrize("verb", ["compare", "batch"])
def test_nothing_hangs_and_no_process_stays(verb: str, how: signal.Signals, tmp_path: Path) -> None:
    questions = tmp_path / "q.jsonl"
    questions.write_text('{"goal": "@makeable", "objective": ["units", "success", "inputs"]}\n')
    random_ = random.Random(f"{verb} {how}")
    for number in range(_TRIES):
        words = ["compare", "--all-makeable", "--jobs", "2"]
        if verb == "batch":
            words = ["batch", str(questions), "--results", str(tmp_path / f"{number}.jsonl"), "--jobs", "2"]
        mark = f"foon-asp-{os.getpid()}-{verb}-{how}-{number}-"
        ran = subprocess.Popen(
            [sys.executable, "-m", "foon_asp", *words],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            env={**os.environ, "MARK": mark},
        )
        time.sleep(random_.uniform(0.5, 2.5))
        ran.send_signal(how)
        _, err = ran.communicate(timeout=_PATIENCE)  # which waits for whoever holds standard error, too
        assert b"Traceback" not in err
        end = time.monotonic() + _PATIENCE
        while marked(mark):
            assert time.monotonic() < end
            time.sleep(0.05)
