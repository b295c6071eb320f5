"""The language server: what editors send, handed to the texts that are edited, and linting behind it."""

import asyncio
import contextlib
import functools
import os
import sys
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from lsprotocol import types
from pygls.lsp.server import LanguageServer
from pygls.protocol import LanguageServerProtocol, default_converter
from pygls.protocol.language_server import lsp_method
from pygls.uris import to_fs_path

from foon_asp import __version__
from foon_asp.editor import answers
from foon_asp.editor.edited_text import EditedText
from foon_asp.editor.lint_worker import Findings, LintProcess
from foon_asp.errors import UserError
from foon_asp.network import NodePattern
from foon_asp.text.data_folder import kitchen_file
from foon_asp.text.json_value import json_line
from foon_asp.text.object_list import read_object_list
from foon_asp.text.reader import FoonReader

_COMPLETION = types.CompletionOptions(trigger_characters=["\t", "[", "{", ","])
_FIXES = types.CodeActionOptions([types.CodeActionKind.QuickFix])
_PAUSE = 0.25  # seconds in which the editor says nothing, before findings are sent
_REST = 0.4  # seconds without a change, before a text is linted as a whole


class _Protocol(LanguageServerProtocol):  # type: ignore[misc]
    """Keeps texts in pieces, and not as a whole, which would be copied at every keystroke.

    ``heard`` is when the editor last said something.
    """

    heard = 0.0

    def handle_message(self, message: Any) -> None:
        """Hear what the editor says."""
        self.heard = asyncio.get_running_loop().time()
        super().handle_message(message)

    def tell(self, message: str) -> None:
        """Send what is JSON already."""
        body = message.encode()
        with contextlib.suppress(BrokenPipeError):  # then what the editor says has ended, too
            self.writer.write(b"Content-Length: %d\r\n\r\n%b" % (len(body), body))

    def lsp_text_document__did_change(self, params: types.DidChangeTextDocumentParams) -> Iterator[Any]:
        """Hand a change on."""
        yield self.fm.features[types.TEXT_DOCUMENT_DID_CHANGE], (params,), None

    lsp_text_document__did_change = lsp_method(types.TEXT_DOCUMENT_DID_CHANGE)(lsp_text_document__did_change)


def _converter() -> Any:
    """Make what turns answers into JSON; the long ones are plain values already."""
    converter = default_converter()
    plain = {
        types.DocumentSymbolResponse: ("jsonrpc", "id", "result"),
        types.FoldingRangeResponse: ("jsonrpc", "id", "result"),
    }
    for kind, keys in plain.items():
        converter.register_unstructure_hook(
            kind, lambda message, keys=keys: {key: getattr(message, key) for key in keys}
        )
    return converter


class Desk:
    """The texts that are open, each with the linting of it that is under way."""

    def __init__(self) -> None:
        self.server = LanguageServer(
            "foon-asp", __version__, protocol_cls=_Protocol, converter_factory=_converter
        )
        self.texts: dict[str, EditedText] = {}
        self._timers: dict[str, asyncio.Handle] = {}
        self._telling: dict[str, asyncio.Handle] = {}
        self._told: dict[str, str] = {}
        self._lints: dict[str, LintProcess] = {}
        self._complaint = ""
        self._kitchens: dict[Path, tuple[float, list[NodePattern]]] = {}
        for name, answer, *how in (
            (types.TEXT_DOCUMENT_DID_OPEN, self.opened),
            (types.TEXT_DOCUMENT_DID_CHANGE, self.changed),
            (types.TEXT_DOCUMENT_DID_CLOSE, self.closed),
            (types.TEXT_DOCUMENT_COMPLETION, self.completion, _COMPLETION),
            (types.TEXT_DOCUMENT_HOVER, self.hover),
            (types.TEXT_DOCUMENT_DEFINITION, self.makers),
            (types.TEXT_DOCUMENT_PREPARE_RENAME, self.renameable),
            (types.TEXT_DOCUMENT_RENAME, self.renamed, types.RenameOptions(prepare_provider=True)),
            (types.TEXT_DOCUMENT_DOCUMENT_SYMBOL, self.outline),
            (types.TEXT_DOCUMENT_FOLDING_RANGE, self.folds),
            (types.TEXT_DOCUMENT_FORMATTING, self.formatted),
            (types.TEXT_DOCUMENT_CODE_ACTION, self.fixes, _FIXES),
        ):
            self.server.feature(name, *how)(functools.partial(answer))  # a method takes no attributes

    @property
    def columns(self) -> answers.Columns:
        """How the editor counts letters."""
        return answers.Columns(types.PositionEncodingKind(self.server.workspace.position_encoding).value)

    def opened(self, params: types.DidOpenTextDocumentParams) -> None:
        """Take a text, and lint it."""
        self.texts[params.text_document.uri] = EditedText(params.text_document.text)
        self._lint_later(params.text_document.uri, 0)

    def changed(self, params: types.DidChangeTextDocumentParams) -> None:
        """Change a text, say what the new pieces say when it pauses, and lint it when it rests."""
        uri, columns = params.text_document.uri, self.columns
        edited = self.texts[uri]
        for change in params.content_changes:
            where = getattr(change, "range", None)
            if where is None:
                edited = self.texts[uri] = EditedText(change.text)
                continue
            start, end = ((at.line, _letter(edited, columns, at)) for at in (where.start, where.end))
            edited.change(start, end, change.text)
        self._lint_later(uri, _REST)
        self.publish(uri)

    def closed(self, params: types.DidCloseTextDocumentParams) -> None:
        """Forget a text."""
        uri = params.text_document.uri
        self._stop(uri)
        self.texts.pop(uri, None)
        self._send(uri, "")
        del self._told[uri]

    def end(self) -> None:
        """End the linting that is under way."""
        for uri in list(self.texts):
            self._stop(uri)

    def completion(self, params: types.CompletionParams) -> types.CompletionList:
        """Offer names."""
        return answers.completion(*self._here(params))

    def hover(self, params: types.HoverParams) -> types.Hover | None:
        """Say who makes and needs a node."""
        return answers.hover(*self._here(params), self.kitchen(params.text_document.uri))

    def makers(self, params: types.DefinitionParams) -> list[types.Location]:
        """Say where the makers of a node are."""
        edited, columns, line, _ = self._here(params)
        return answers.makers(edited, columns, params.text_document.uri, line)

    def renameable(self, params: types.PrepareRenameParams) -> types.Range | None:
        """Say what would be renamed."""
        return answers.renameable(*self._here(params))

    def renamed(self, params: types.RenameParams) -> types.WorkspaceEdit | None:
        """Rename."""
        edits = answers.renamed(*self._here(params), params.new_name)
        if edits is None:
            self._say(types.MessageType.Warning, f"{params.new_name!r} cannot be a name there")
            return None
        return types.WorkspaceEdit(changes={params.text_document.uri: edits})

    def outline(self, params: types.DocumentSymbolParams) -> Any:
        """Give the outline."""
        return answers.symbols(self.texts[params.text_document.uri])

    def folds(self, params: types.FoldingRangeParams) -> Any:
        """Say what can be folded."""
        return answers.folds(self.texts[params.text_document.uri])

    def formatted(self, params: types.DocumentFormattingParams) -> list[types.TextEdit]:
        """Bring a text into canonical form."""
        return answers.formatted(self.texts[params.text_document.uri], self.columns)

    def fixes(self, params: types.CodeActionParams) -> list[types.CodeAction]:
        """Offer what mends findings."""
        uri, lines = params.text_document.uri, params.range
        edited = self.texts[uri]
        return [*answers.quick_fixes(edited, self.columns, uri, lines.start.line, lines.end.line)]

    def publish(self, uri: str) -> None:
        """Send all findings about a text when the editor asks nothing; anew if that was under way."""
        if waiting := self._telling.pop(uri, None):
            waiting.cancel()
        self._tell(uri, answers.diagnostics(self.texts[uri], self.columns), [])

    def kitchen(self, uri: str) -> list[NodePattern] | None:
        """Give the entries of the kitchen beside a text; ``None`` where there is none that can be read."""
        path = to_fs_path(uri)
        file = kitchen_file(Path(path).parent) if path else None
        if file is None:
            return None
        with contextlib.suppress(OSError, UserError):
            changed = file.stat().st_mtime
            if self._kitchens.get(file, (None,))[0] != changed:
                self._kitchens[file] = changed, [entry.pattern for entry in read_object_list(file)]
            return self._kitchens[file][1]
        return None

    def _here(self, params: Any) -> tuple[EditedText, answers.Columns, int, int]:
        """Give the text that is asked about, and the place in it."""
        edited, columns, at = self.texts[params.text_document.uri], self.columns, params.position
        line = min(at.line, len(edited.lines) - 1)
        return edited, columns, line, columns.ours(edited.lines[line], at.character)

    def _say(self, kind: types.MessageType, text: str) -> None:
        self.server.window_show_message(types.ShowMessageParams(kind, text))

    def _tell(self, uri: str, parts: Iterator[str], found: list[str]) -> None:
        """Put findings together, part by part, while nothing is asked; then send them if they are others."""
        loop = asyncio.get_running_loop()
        self._telling.pop(uri, None)
        if (left := self.server.protocol.heard + _PAUSE - loop.time()) > 0:
            self._telling[uri] = loop.call_later(left, self._tell, uri, parts, found)
        elif part := next(parts, None):
            self._telling[uri] = loop.call_soon(self._tell, uri, parts, [*found, part])
        elif (told := ",".join(found)) != self._told.get(uri):
            self._send(uri, told)

    def _send(self, uri: str, found: str) -> None:
        self._told[uri] = found
        told = f'{{"uri":{json_line(uri)},"diagnostics":[{found}]}}'
        method = types.TEXT_DOCUMENT_PUBLISH_DIAGNOSTICS
        self.server.protocol.tell(f'{{"jsonrpc":"2.0","method":"{method}","params":{told}}}')

    def _stop(self, uri: str) -> None:
        """Stop what is under way about a text."""
        for waiting in (self._timers, self._telling):
            if uri in waiting:
                waiting.pop(uri).cancel()
        if process := self._lints.pop(uri, None):
            _end(process)

    def _lint_later(self, uri: str, seconds: float) -> None:
        self._stop(uri)
        self._timers[uri] = asyncio.get_running_loop().call_later(seconds, self._lint, uri)

    def _lint(self, uri: str) -> None:
        edited, loop = self.texts[uri], asyncio.get_running_loop()

        def done(process: LintProcess, found: Findings | str) -> None:
            with contextlib.suppress(RuntimeError):  # the server has ended
                loop.call_soon_threadsafe(self._linted, uri, edited, process, found)

        self._timers.pop(uri, None)
        self._lints[uri] = LintProcess(to_fs_path(uri) or "untitled", edited.text, done)

    def _linted(self, uri: str, edited: EditedText, process: LintProcess, found: Findings | str) -> None:
        if self._lints.get(uri) is not process:
            return  # it has changed since
        _end(self._lints.pop(uri))
        if isinstance(found, str):
            if found != self._complaint:
                self._say(types.MessageType.Error, found)
            self._complaint = found
            return
        self._complaint = ""
        edited.linted(found)
        self._told.pop(uri, None)  # an editor may have lost some of them with lines that came back
        self.publish(uri)


def _end(process: LintProcess) -> None:
    """End a process beside, since that may take a while."""
    threading.Thread(target=process.end, daemon=True).start()


def _letter(edited: EditedText, columns: answers.Columns, at: types.Position) -> int:
    return columns.ours(edited.lines[at.line], at.character) if at.line < len(edited.lines) else 0


def serve() -> None:
    """Speak with an editor over standard input and output, until it ends."""
    FoonReader().parse("S x")  # the first line that is not as it should be takes longer
    desk = Desk()
    # streams of its own, since the server closes them
    streams = (
        os.fdopen(os.dup(stream.fileno()), mode) for stream, mode in ((sys.stdin, "rb"), (sys.stdout, "wb"))
    )
    desk.server.start_io(*streams)
    desk.end()
