"""Ctrl-C at any moment: nothing hangs, and the next question is answered."""

import subprocess
import sys

import pytest

from tests.conftest import ROOT

# An interrupt before each instruction of a block, one after another.
_EVERYWHERE = """
import signal, sys
from foon_asp import deadline
from foon_asp.deadline import Deadline, uninterrupted

def watched():
    with Deadline(600).watched("waiting"):
        pass

def shielded():
    with uninterrupted():
        pass

def at(moment, block):
    count = 0
    def trace(frame, event, _):
        nonlocal count
        frame.f_trace_opcodes = True
        count += 1
        if count == moment:
            sys.settrace(None)
            signal.raise_signal(signal.SIGINT)
        return trace
    try:
        sys.settrace(trace)
        block()
        return False
    except KeyboardInterrupt:
        return True
    finally:
        sys.settrace(None)

moment = 1
while at(moment, {block}):
    watched()
    shielded()
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
    moment += 1
print(moment)
"""


@pytest.mark.parametrize("block", ["watched", "shielded"])
def test_an_interrupt_at_any_instruction_freezes_nothing(block: str) -> None:
    code = _EVERYWHERE.replace("{block}", block)
    ran = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, timeout=60, check=False
    )
    assert ran.stderr == ""
    assert int(ran.stdout) > 50


@pytest.mark.slow
def test_verbs_that_are_interrupted_end_and_the_next_answer_is_right() -> None:
    words = [sys.executable, "-m", "tests.cli.interrupted_process", "--interrupts", "100", "--seed", "4"]
    ran = subprocess.run(words, capture_output=True, text=True, cwd=ROOT, check=False)
    assert ran.returncode == 0, ran.stdout + ran.stderr
