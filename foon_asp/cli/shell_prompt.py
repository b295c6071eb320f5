"""The prompt of a session on a terminal: completion, and the lines of earlier sessions."""

import os
from collections.abc import Iterable, Iterator
from pathlib import Path

from prompt_toolkit import PromptSession
from prompt_toolkit.completion import CompleteEvent, Completer, Completion
from prompt_toolkit.document import Document
from prompt_toolkit.history import FileHistory, History, InMemoryHistory

from foon_asp.cli.shell_completion import candidates
from foon_asp.cli.shell_session import ShellSession


def prompted_lines(session: ShellSession) -> Iterator[str]:
    """Ask for line after line until ctrl-D; ctrl-C drops the line that is being typed."""
    prompt: PromptSession[str] = PromptSession(
        "foon-asp> ",
        completer=_Completer(session),
        complete_while_typing=False,
        history=_history(),
    )
    while True:
        try:
            yield prompt.prompt()
        except KeyboardInterrupt:
            continue
        except EOFError:
            return


class _Completer(Completer):
    """Hands the line over, up to the cursor."""

    def __init__(self, session: ShellSession) -> None:
        self._session = session

    def get_completions(self, document: Document, complete_event: CompleteEvent) -> Iterable[Completion]:
        line = document.text_before_cursor
        found = candidates(line, self._session)
        return (Completion(text, start_position=found.start - len(line)) for text in found.texts)


def history_file() -> Path:
    """Give the file with the lines of earlier sessions: ``foon-asp/history`` in the user's state folder.

    That is ``$XDG_STATE_HOME``, or ``~/.local/state`` where that is not set to an absolute path.
    """
    folder = Path(os.environ.get("XDG_STATE_HOME", ""))
    return (folder if folder.is_absolute() else Path.home() / ".local" / "state") / "foon-asp" / "history"


def _history() -> History:
    """Open the history; where there is no room for it, lines are kept until the session ends."""
    try:
        file = history_file()
        file.parent.mkdir(parents=True, exist_ok=True)
        file.touch(mode=0o600)
    except (OSError, RuntimeError):  # RuntimeError: nobody knows where home is
        return InMemoryHistory()
    return FileHistory(file)
