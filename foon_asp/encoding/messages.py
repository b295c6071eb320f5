"""Messages of clingo about statements or instances that it drops."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from clingo import MessageCode

from foon_asp.encoding.number_checks import CHECKS_FILE
from foon_asp.encoding.run import ProgramError
from foon_asp.problem.number import INT32_MAX

# Undefined atoms have a check of their own; a file may be included twice; and a global variable may stand in
# an aggregate. With any other message clingo drops an instance, or stops.
_HARMLESS = (MessageCode.AtomUndefined, MessageCode.FileIncluded, MessageCode.GlobalVariable)

NO_LIMIT = INT32_MAX  # clingo's limit of messages: beyond a lower one, a relevant message might be lost


def listener(messages: list[str], max_kept: int = 1000) -> Callable[[MessageCode, str], None]:
    """Return a logger for clingo that adds to ``messages`` the errors, and the instances that clingo drops.

    After ``max_kept`` messages, it adds only errors. Harmless messages are ignored, such as those about
    undefined atoms.
    """

    def log(code: MessageCode, text: str) -> None:
        """Add a message, unless it is harmless or comes from an overflow check."""
        if text.startswith(f"{CHECKS_FILE}:") and code is MessageCode.OperationUndefined:
            return  # the checked rule causes the same message
        if code not in _HARMLESS and (code is MessageCode.RuntimeError or len(messages) < max_kept):
            messages.append(text)

    return log


@contextmanager
def refuse_messages(messages: list[str]) -> Iterator[None]:
    """Return a context that raises :class:`ProgramError` if clingo stops in its block, or leaves messages.

    ``messages`` is the list to which a :func:`listener` adds messages. It is looked at when the block ends.
    """
    try:
        yield
    except RuntimeError as error:
        raise ProgramError(messages, str(error)) from None
    if messages:
        raise ProgramError(messages, "")
