"""Which messages of clingo are about something that is lost."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from clingo import MessageCode

from foon_asp.grounding.number_checks import PLACE
from foon_asp.grounding.run import ProgramError

# Atoms that nothing defines are looked for elsewhere; a file may be included twice; and a variable of the
# whole rule may stand in an aggregate. With any other message clingo leaves something out, or stops.
_HARMLESS = (MessageCode.AtomUndefined, MessageCode.FileIncluded, MessageCode.GlobalVariable)

NO_LIMIT = 2**31 - 1  # of messages, for clingo's: behind a limit there might be one that matters
_MOST = 1000  # that are kept of those about what was left out


def listener(messages: list[str]) -> Callable[[MessageCode, str], None]:
    """Return a logger for clingo that notes the messages about something that is lost."""

    def hear(code: MessageCode, text: str) -> None:
        if text.startswith(f"{PLACE}:") and code is MessageCode.OperationUndefined:
            return  # the rule that is looked into says so itself
        if code not in _HARMLESS and (code is MessageCode.RuntimeError or len(messages) < _MOST):
            messages.append(text)

    return hear


@contextmanager
def refusing(messages: list[str]) -> Iterator[None]:
    """Raise :class:`ProgramError` where clingo stops, and where messages are there in the end."""
    try:
        yield
    except RuntimeError as error:
        raise ProgramError(messages, str(error)) from None
    if messages:
        raise ProgramError(messages, "")
