"""A language server: it receives the texts that an editor has open, checks them, and answers requests."""

import asyncio
import sys
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import BinaryIO

from foon_asp import __version__
from foon_asp.editor import answers
from foon_asp.editor.checked_text import CheckedText, check_text
from foon_asp.editor.edited_text import EditedText
from foon_asp.editor.json_rpc import (
    ErrorCode,
    RequestError,
    parameter,
    read_message,
    write_message,
)
from foon_asp.json_layout import Json

_CAPABILITIES = {
    "textDocumentSync": {"openClose": True, "change": 1},  # the whole text
    "completionProvider": {"triggerCharacters": ["\t", "[", "{", ","]},
    "codeActionProvider": {"codeActionKinds": ["quickfix"]},
    "renameProvider": {"prepareProvider": True},
    "hoverProvider": True,
    "definitionProvider": True,
    "documentSymbolProvider": True,
    "foldingRangeProvider": True,
    "documentFormattingProvider": True,
}


class LanguageServer:
    """A server for one editor, which reads requests from ``stdin`` and writes responses to ``stdout``.

    Texts are checked one after the other in a thread. After a change, the check begins once the text has not
    changed for a while.
    """

    def __init__(self, stdin: BinaryIO, stdout: BinaryIO) -> None:
        self._in, self._out = stdin, stdout
        self._texts: dict[str, EditedText] = {}
        self._checks: dict[str, asyncio.Task[CheckedText]] = {}
        self._checked: dict[str, CheckedText] = {}  # the last finished check, maybe of an earlier text
        self._worker = ThreadPoolExecutor(1)
        self._settings_error = ""
        self._ending: set[str] = set()  # "shutdown" and "exit", once the editor has sent them
        self._methods: dict[str, Callable[[object], object]] = {
            "initialize": self._initialize,
            "shutdown": lambda _: self._ending.add("shutdown"),
            "exit": lambda _: self._ending.add("exit"),
            "textDocument/didOpen": self._open_text,
            "textDocument/didChange": self._change_text,
            "textDocument/didClose": self._close_text,
            "textDocument/formatting": lambda parameters: answers.format_edits(self._text_of(parameters)),
        }

    async def run(self) -> bool:
        """Answer requests until the editor sends ``exit`` or closes the stream.

        Return false if ``exit`` came and ``shutdown`` did not come before it. Otherwise return true.
        """
        async with asyncio.TaskGroup() as responses:
            while "exit" not in self._ending:
                message = await asyncio.to_thread(read_message, self._in)
                if message is None:
                    break
                responses.create_task(self._respond(message))
                await asyncio.sleep(0)  # the response begins before the next message is read
        return self._ending != {"exit"}

    async def _respond(self, message: Json) -> None:
        """Process a message, and write a response unless the message is a notification.

        Any error becomes an error response; an error about a notification is dropped. Requests after
        ``shutdown`` are refused. If the text changes before it was checked, the error is
        ``CONTENT_MODIFIED``.
        """
        id_ = message["id"] if type(message.get("id")) in {str, int} else None
        is_request = "id" in message or "method" not in message
        try:
            if is_request and (id_ is None or self._ending or message.get("jsonrpc") != "2.0"):
                reason = "found no request of JSON-RPC 2.0, or one after the editor has ended the server"
                raise RequestError(ErrorCode.INVALID_REQUEST, reason)
            response: Json = {"result": await self._result(str(message.get("method")), message.get("params"))}
        except RequestError as error:
            response = _error_response(error.code, str(error))
        except asyncio.CancelledError:
            response = _error_response(ErrorCode.CONTENT_MODIFIED, "the text has changed")
        except Exception as error:  # the editor waits for an answer
            response = _error_response(ErrorCode.INTERNAL_ERROR, repr(error))
        if is_request:
            write_message(self._out, {"id": id_, **response})

    async def _result(self, method: str, parameters: object) -> object:
        """Return the result of a request, after the check of the text that it is about.

        Completions do not wait if an earlier version of the text was checked. Raises :class:`RequestError`
        for a request that is refused.
        """
        if method in self._methods:
            return self._methods[method](parameters)
        if method == "textDocument/completion":
            text = self._text_of(parameters)
            checked = self._checked.get(text.uri) or await self._checks[text.uri]
            return answers.completion(text, checked.names, parameters)
        if answer := answers.ANSWERS.get(method):
            return answer(await self._checks[self._text_of(parameters).uri], parameters)
        raise RequestError(ErrorCode.METHOD_NOT_FOUND, f"there is no method {method}")

    def _initialize(self, parameters: object) -> Json:
        """Return the capabilities of the server; raises :class:`RequestError` without those of the editor."""
        parameter(parameters, "capabilities", dict)
        return {
            "capabilities": _CAPABILITIES,
            "serverInfo": {"name": "foon-asp", "version": __version__},
        }

    def _open_text(self, parameters: object) -> None:
        """Open a text, and check it at once."""
        uri = parameter(parameters, "textDocument.uri", str)
        self._schedule_check(EditedText(uri, parameter(parameters, "textDocument.text", str)), 0)

    def _change_text(self, parameters: object) -> None:
        """Replace a text by its new version. It is checked unless it changes again within a quarter second.

        Raises :class:`RequestError` if the text is not open.
        """
        text = self._text_of(parameters)
        for change in parameter(parameters, "contentChanges", list):
            # sooner, texts would be checked while somebody types
            self._schedule_check(EditedText(text.uri, parameter(change, "text", str)), 0.25)

    def _close_text(self, parameters: object) -> None:
        """Forget a text that the editor has closed, cancel its check, and withdraw its findings."""
        uri = self._text_of(parameters).uri
        self._checks.pop(uri).cancel()
        self._checked.pop(uri, None)
        del self._texts[uri]
        self._notify("textDocument/publishDiagnostics", {"uri": uri, "diagnostics": []})

    def _text_of(self, parameters: object) -> EditedText:
        """Return the text that a message is about; raises :class:`RequestError` if it is not open."""
        uri = parameter(parameters, "textDocument.uri", str)
        if uri not in self._texts:
            raise RequestError(ErrorCode.INVALID_PARAMETERS, f"found {uri}, expected a text that is open")
        return self._texts[uri]

    def _schedule_check(self, text: EditedText, seconds: float) -> None:
        """Keep a text, begin its check after ``seconds``, and cancel the check of its version before."""
        if earlier_check := self._checks.get(text.uri):
            earlier_check.cancel()
        self._texts[text.uri] = text
        self._checks[text.uri] = asyncio.create_task(self._check(text, seconds))

    async def _check(self, text: EditedText, seconds: float) -> CheckedText:
        """Check a text after ``seconds``, publish its findings, and return the checked text.

        An error in the settings of lint is shown to the user, unless the last check met the same error.
        """
        await asyncio.sleep(seconds)
        checked = await asyncio.get_running_loop().run_in_executor(self._worker, check_text, text)
        self._checked[text.uri] = checked
        if checked.settings_error not in {"", self._settings_error}:
            self._notify("window/showMessage", {"type": 1, "message": checked.settings_error})  # an error
        self._settings_error = checked.settings_error
        diagnostics = {"uri": text.uri, "diagnostics": answers.diagnostics(checked)}
        self._notify("textDocument/publishDiagnostics", diagnostics)
        return checked

    def _notify(self, method: str, parameters: Json) -> None:
        """Send a notification to the editor."""
        write_message(self._out, {"method": method, "params": parameters})


def _error_response(code: ErrorCode, message: str) -> Json:
    """Return the part of a response that says why there is no result."""
    return {"error": {"code": code, "message": message}}


def serve_editor() -> bool:
    """Serve an editor over standard input and output; return the result of :meth:`LanguageServer.run`.

    From then on, threads of this process switch more often, so that a check delays answers less.
    """
    sys.setswitchinterval(0.0005)  # until checking yields to an answer: less makes it slower
    return asyncio.run(LanguageServer(sys.stdin.buffer, sys.stdout.buffer).run())
