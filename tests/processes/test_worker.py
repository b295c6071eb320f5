"""A process that is asked again and again: who ends it, and who may not."""

import os

import pytest

from foon_asp.deadline import Deadline
from foon_asp.processes.pipe import pack_message
from foon_asp.processes.worker import Worker

GROUNDER = "foon_asp.encoding.program_worker"
needs_fork = pytest.mark.skipif(not hasattr(os, "fork"), reason="this system does not fork")


def derived(worker: Worker) -> object:
    """Ask the process something small."""
    return worker.ask(pack_message(("derive", "a(1).", "a", 1, None)), Deadline())


@needs_fork
@pytest.mark.filterwarnings("ignore:.*multi-threaded.*:DeprecationWarning")
def test_a_fork_that_ends_leaves_the_process_to_its_parent() -> None:
    worker = Worker(GROUNDER, "rules are grounded")
    before = derived(worker)
    child = os.fork()
    if child == 0:
        try:
            worker.end()  # as every process does when it ends
        finally:
            os._exit(0)
    os.waitpid(child, 0)
    try:
        assert derived(worker) == before
    finally:
        worker.end()


@pytest.mark.skipif(not hasattr(os, "killpg"), reason="this system has no process groups")
def test_a_process_that_has_ended_is_not_struck_again(monkeypatch: pytest.MonkeyPatch) -> None:
    """Its number may be that of another process by then."""
    worker = Worker(GROUNDER, "rules are grounded", "-S")
    derived(worker)
    worker.end()
    struck: list[int] = []
    monkeypatch.setattr(os, "killpg", lambda group, _: struck.append(group))
    worker.end()
    assert struck == []
