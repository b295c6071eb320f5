"""One run of clingo over encodings and facts, within limits."""

import time
from collections.abc import Callable, Sequence

from clingo import Control

from foon_asp.deadline import Deadline
from foon_asp.encoding.grounded import Grounded
from foon_asp.encoding.messages import listener, refuse_messages
from foon_asp.encoding.run import ProgramError, Run
from foon_asp.encoding.stated import Loaded
from foon_asp.errors import UserError


def check_options(arguments: Sequence[str]) -> None:
    """Raise :class:`UserError` for options that clingo refuses."""
    messages: list[str] = []
    try:
        with refuse_messages(messages):
            Control(list(arguments), logger=listener(messages))
    except ProgramError as error:
        raise as_user_error(error) from None


def run(
    files: Sequence[Loaded],
    facts: str,
    arguments: Sequence[str],
    deadline: Deadline,
    opt_mode: str = "opt",
    on_tree: Callable[[frozenset[int]], None] | None = None,
    on_bound: Callable[[list[int]], None] | None = None,
    predicates: Sequence[tuple[str, int]] = (),
    products: int = 0,
    endless: bool = False,
) -> Run:
    """Ground the files and facts, and search for the best answer.

    Parameters:
        files: The encodings and rules.
        facts: The facts, as text.
        arguments: Options of clingo.
        deadline: The limits. If the search is stopped by a limit or ctrl-C, the run has the last answer.
        opt_mode: As in clasp: ``opt``, ``opt,BOUND,...`` or ``ignore`` (stop at the first answer).
        on_tree: Is called with the numbers of the units of each answer.
        on_bound: Is called with the greatest lower bound so far, by priority, whenever clingo proves one.
        predicates: Predicates (name and arity) whose atoms the run has in addition to ``use``. The first
            argument of their atoms is a number.
        products: The number of products of rates in the facts.
        endless: Whether grounding may not terminate; then it runs in another process.

    If a limit or ctrl-C stops the grounding, nothing is raised. The run then has no answer, and is not
    exhausted. The deadline records ctrl-C. Raises :class:`UserError` (see
    :func:`foon_asp.encoding.encoding.program_fault`) if clingo refuses the program.
    """
    began = time.perf_counter()
    try:
        program = ground(files, facts, arguments, deadline, products, endless)
    except KeyboardInterrupt:
        deadline.interrupt()
        return Run(ground_seconds=time.perf_counter() - began)
    grounded = time.perf_counter()
    try:
        result = program.search(deadline, opt_mode, on_tree, on_bound, predicates)
    finally:
        program.close()
    result.ground_seconds = grounded - began
    return result


def ground(
    files: Sequence[Loaded],
    facts: str,
    arguments: Sequence[str],
    deadline: Deadline,
    products: int = 0,
    endless: bool = False,
) -> Grounded:
    """Return the ground program of files and facts; the parameters are those of :func:`run`.

    Raises ``LimitError`` at a limit, and ``KeyboardInterrupt`` at ctrl-C. Raises :class:`UserError` if clingo
    refuses the program.
    """
    try:
        return Grounded(files, facts, arguments, products, deadline, endless)
    except ProgramError as error:
        raise as_user_error(error, files) from None


def as_user_error(error: ProgramError, files: Sequence[Loaded] = ()) -> UserError:
    """Return an error for the user with the messages of clingo, their places and source lines.

    ``files`` are the files and texts of the program.
    """
    from foon_asp.encoding.encoding import program_fault  # noqa: PLC0415 (slow to import, needed for faults only)

    return program_fault(error.messages, error.otherwise, files)
