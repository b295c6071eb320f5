"""The prompt of a session at a terminal: completion, and the history of earlier sessions."""

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
    """Prompt for lines until ctrl-D; ctrl-C drops the line being typed."""
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
    """Completes the line up to the cursor."""

    def __init__(self, session: ShellSession) -> None:
        self._session = session

    def get_completions(self, document: Document, complete_event: CompleteEvent) -> Iterable[Completion]:
        line = document.text_before_cursor
        found = candidates(line, self._session)
        return (Completion(text, start_position=found.start - len(line)) for text in found.texts)


def history_file() -> Path:
    """Give the file with the history of earlier sessions: ``foon-asp/history`` in the user's state folder.

    That folder is ``$XDG_STATE_HOME`` if that is an absolute path, otherwise ``~/.local/state``.
    """
    folder = Path(os.environ.get("XDG_STATE_HOME", ""))
    return (folder if folder.is_absolute() else Path.home() / ".local" / "state") / "foon-asp" / "history"


def _history() -> History:
    """Open the history; if it cannot be written, lines are kept until the session ends."""
    try:
        file = history_file()
        file.parent.mkdir(parents=True, exist_ok=True)
        file.touch(mode=0o600)
    except (OSError, RuntimeError):  # RuntimeError: nobody knows where home is
        return InMemoryHistory()
    return FileHistory(file)
