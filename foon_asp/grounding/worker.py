"""The other process: it obeys commands about one program, until no more come.

A thread reads the commands, so that the end of the parent is noticed while clingo grounds, and the process
ends with it.
"""

import contextlib
import errno
import os
import queue
import signal
import traceback
from io import FileIO
from typing import Any

from foon_asp.aside import Aside
from foon_asp.errors import UserError
from foon_asp.grounding.derived import derive
from foon_asp.grounding.ground_program import GroundProgram
from foon_asp.grounding.run import OUT_OF_MEMORY, ProgramError
from foon_asp.pipe import receive, send


def serve() -> None:
    """Obey the commands on standard input and answer on what was standard output."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    answers = FileIO(os.dup(1), "wb")
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)  # so that nothing else gets among the answers
    commands: queue.SimpleQueue[tuple[Any, ...]] = queue.SimpleQueue()
    Aside(_read, commands)
    program: GroundProgram | None = None

    def obey(command: str, *given: Any) -> object:
        nonlocal program
        if command == "ground":
            program = None  # before there are two
            folder, *described, memory = given
            if folder is not None:
                os.chdir(folder)
            _bound_memory(memory)
            program = GroundProgram(*described)
            return None
        if command == "forget":
            program = None
            return None
        if command == "derive":
            *described, memory = given
            _bound_memory(memory)
            return derive(*described)
        assert program is not None
        if command == "consequences":
            return program.consequences(*given)
        assert command == "search"
        opt_mode, predicates = given
        tree, bound = (lambda said, kind=kind: send(answers, (kind, said)) for kind in ("tree", "bound"))
        return tuple(program.search(opt_mode, predicates, tree, bound))

    while True:
        try:
            answer: tuple[str, object] = "done", obey(*commands.get())
        except ProgramError as error:
            answer = "refused", (error.messages, error.otherwise)
        except UserError as error:
            answer = "fault", str(error)
        except MemoryError:
            os._exit(OUT_OF_MEMORY)
        except Exception as error:
            if str(error) == os.strerror(errno.EAGAIN):  # no memory for the stack of a thread of clingo's
                os._exit(OUT_OF_MEMORY)
            answer = "bug", traceback.format_exc()
        try:
            send(answers, answer)
        except OSError:
            return


def _read(commands: "queue.SimpleQueue[tuple[Any, ...]]") -> None:
    pipe = FileIO(0, "rb")
    while True:
        try:
            commands.put(receive(pipe))
        except EOFError:
            os._exit(0)
        except MemoryError:
            os._exit(OUT_OF_MEMORY)


def _bound_memory(size: int | None) -> None:
    """Let no more be allocated than this, where the system can: the other process looks only now and then."""
    try:
        import resource  # noqa: PLC0415 (not on every system)
    except ImportError:
        return
    most = resource.getrlimit(resource.RLIMIT_DATA)[1]
    with contextlib.suppress(ValueError, OSError):  # of a system, or more than its owner allows
        resource.setrlimit(resource.RLIMIT_DATA, (most if size is None else size, most))
