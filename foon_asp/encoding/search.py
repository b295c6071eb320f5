"""One run of clingo over encodings and facts, with limits; it claims nothing itself."""

import time
from collections.abc import Callable, Sequence

from clingo import Control

from foon_asp.deadline import Deadline
from foon_asp.errors import UserError
from foon_asp.grounding.grounded import Grounded
from foon_asp.grounding.messages import listener, refusing
from foon_asp.grounding.run import ProgramError, Run
from foon_asp.grounding.stated import Loaded


def check(arguments: Sequence[str]) -> None:
    """Raise :class:`UserError` for options that clingo does not take."""
    messages: list[str] = []
    try:
        with refusing(messages):
            Control(list(arguments), logger=listener(messages))
    except ProgramError as error:
        raise refused(error) from None


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
    """Ground the files and facts and search for the best answer.

    ``opt_mode`` is clasp's: ``opt``, ``opt,BOUND,...`` or ``ignore`` (the first answer will do).
    ``predicates``, by name and arity, have atoms that are wanted besides ``use``, which begin with a number.
    ``products`` says how many products of rates the facts describe, ``endless`` that nobody knows whether the
    grounding comes to an end. Stopped at a limit, or at ctrl-C, it gives what is known by then. Raises what
    :func:`foon_asp.encoding.encoding.fault` makes of clingo's messages where a program is at fault.
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
    """Ground the files and facts; raises like :func:`run`, and ``KeyboardInterrupt`` where it is stopped."""
    try:
        return Grounded(files, facts, arguments, products, deadline, endless)
    except ProgramError as error:
        raise refused(error, files) from None


def refused(error: ProgramError, files: Sequence[Loaded] = ()) -> UserError:
    """Turn clingo's messages into one error with places and source lines."""
    from foon_asp.encoding.encoding import fault  # noqa: PLC0415 (slow to import, needed for faults only)

    return fault(error.messages, error.otherwise, files)
