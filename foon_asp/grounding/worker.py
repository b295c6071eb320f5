"""The other process: it obeys commands about one program, until no more come."""

import contextlib
import errno
import os
import traceback
from typing import Any

from foon_asp.errors import UserError
from foon_asp.grounding.derived import derive
from foon_asp.grounding.ground_program import GroundProgram
from foon_asp.grounding.run import ProgramError
from foon_asp.processes.pipe import OUT_OF_MEMORY, receive, requests, send


def serve() -> None:
    """Obey the commands on standard input and answer on what was standard output."""
    commands, answers = requests(receive)
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
        command = commands.get()
        if command == ("forget",):  # nothing is answered
            program = None
            continue
        try:
            answer: tuple[str, object] = "done", obey(*command)
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


def _bound_memory(size: int | None) -> None:
    """Let no more be allocated than this, where the system can: the other process looks only now and then."""
    try:
        import resource  # noqa: PLC0415 (not on every system)
    except ImportError:
        return
    most = resource.getrlimit(resource.RLIMIT_DATA)[1]
    with contextlib.suppress(ValueError, OSError):  # of a system, or more than its owner allows
        resource.setrlimit(resource.RLIMIT_DATA, (most if size is None else size, most))
