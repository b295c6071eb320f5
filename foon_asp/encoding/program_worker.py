"""Main loop of the worker process: it executes commands about one program until its input ends."""

import errno
import os
import traceback
from typing import Any

from foon_asp.encoding.derived import derive
from foon_asp.encoding.ground_program import GroundProgram
from foon_asp.encoding.run import ProgramError
from foon_asp.errors import UserError
from foon_asp.processes.memory_limit import limit_own_memory
from foon_asp.processes.pipe import OUT_OF_MEMORY, become_worker, receive, send


def serve() -> None:
    """Execute the commands on standard input, and write answers to the original standard output.

    A command is a tuple of its name and parameters. An answer is a pair: ``done`` with the result, or
    ``refused``, ``fault`` or ``bug`` with the error. The command ``forget`` drops the program, without an
    answer. The process exits if memory runs out or its input ends.
    """
    commands, answers = become_worker(receive)
    program: GroundProgram | None = None

    def execute(command: str, *parameters: Any) -> object:
        """Execute a command, and return its result; a search first sends its trees and bounds.

        Before ``ground`` and ``derive``, the memory of this process is limited. ``ground`` also changes its
        current folder, and keeps the program for later commands.
        """
        nonlocal program
        if command == "ground":
            program = None  # frees the memory before the next one
            folder, *arguments, memory = parameters
            if folder is not None:
                os.chdir(folder)
            limit_own_memory(memory)
            program = GroundProgram(*arguments)
            return None
        if command == "derive":
            *arguments, memory = parameters
            limit_own_memory(memory)
            return derive(*arguments)
        assert program is not None
        if command == "consequences":
            return program.consequences(*parameters)
        assert command == "search"
        opt_mode, predicates = parameters
        send_tree, send_bound = (
            lambda value, kind=kind: send(answers, (kind, value)) for kind in ("tree", "bound")
        )
        return tuple(program.search(opt_mode, predicates, send_tree, send_bound))

    while True:
        command = commands.get()
        if command == ("forget",):  # without an answer
            program = None
            continue
        try:
            answer: tuple[str, object] = "done", execute(*command)
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
