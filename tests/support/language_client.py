"""A client of the language server, over standard input and output, as an editor is one."""

import json
import os
import queue
import subprocess
import sys
import threading
from pathlib import Path
from typing import IO, Any, cast

from tests.conftest import ROOT

_PATIENCE = 60  # seconds: the machine may be busy


class LanguageClient:
    """A server in a process, and what it says."""

    def __init__(self, folder: Path, **capabilities: Any) -> None:
        self._process = subprocess.Popen(
            [sys.executable, "-m", "foon_asp", "lsp"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            cwd=folder,
            env={**os.environ, "PYTHONPATH": str(ROOT)},
        )
        self._out = cast(IO[bytes], self._process.stdin)
        self._said: queue.Queue[Any] = queue.Queue()
        self._number = 0
        self.told: list[Any] = []
        self.open: list[str] = []
        threading.Thread(target=self._listen, daemon=True).start()
        self.capabilities = self.ask("initialize", processId=None, rootUri=None, capabilities=capabilities)[
            "capabilities"
        ]
        self.tell("initialized")

    def _listen(self) -> None:
        stream = cast(IO[bytes], self._process.stdout)
        while head := stream.readline():
            length = int(head.split(b":")[1]) if head.lower().startswith(b"content-length") else None
            while stream.readline().strip():
                pass
            if length is not None:
                self._said.put(json.loads(stream.read(length)))

    def tell(self, method: str, **params: Any) -> None:
        """Send what asks for no answer."""
        self._send({"jsonrpc": "2.0", "method": method, "params": params})

    def ask(self, method: str, **params: Any) -> Any:
        """Ask, and give the answer."""
        self._number += 1
        said = self.answer({"jsonrpc": "2.0", "id": self._number, "method": method, "params": params})
        assert "error" not in said, said["error"]
        return said["result"]

    def answer(self, message: Any) -> Any:
        """Send any message, and return its answer, which has no number where the message has none."""
        self._send(message)
        number = message.get("id") if isinstance(message, dict) else None
        while True:
            said = self._said.get(timeout=_PATIENCE)
            if said.get("id") == (number if type(number) in {str, int} else None) and "method" not in said:
                return said
            self.told.append(said)

    def wait(self, method: str) -> Any:
        """Give what the server tells next by a method."""
        while True:
            said = self.told.pop(0) if self.told else self._said.get(timeout=_PATIENCE)
            if said.get("method") == method:
                return said["params"]

    def silence(self) -> None:
        """Close all texts, and forget what was told of them."""
        for uri in self.open:
            self.tell("textDocument/didClose", textDocument={"uri": uri})
            while self.wait("textDocument/publishDiagnostics") != {"uri": uri, "diagnostics": []}:
                pass
        self.open.clear()
        self.told.clear()

    def findings(self) -> list[dict[str, Any]]:
        """Give the findings that are told next."""
        found: list[dict[str, Any]] = self.wait("textDocument/publishDiagnostics")["diagnostics"]
        return found

    def end(self) -> int:
        """End the server as an editor does; give its exit code."""
        self.ask("shutdown")
        self.tell("exit")
        self._out.close()
        return self._process.wait(timeout=_PATIENCE)

    def kill(self) -> None:
        """End it whatever it is at."""
        self._process.kill()
        self._process.wait()
        for stream in (self._process.stdin, self._process.stdout, self._process.stderr):
            cast(IO[bytes], stream).close()

    def _send(self, message: Any) -> None:
        body = json.dumps(message).encode()
        self._out.write(b"Content-Length: %d\r\n\r\n%s" % (len(body), body))
        self._out.flush()


class Text:
    """A text that is open in the editor."""

    def __init__(self, client: LanguageClient, file: Path, text: str) -> None:
        self.client, self.uri, self.text, self.version = client, file.as_uri(), text, 1
        client.open.append(self.uri)
        item = {"uri": self.uri, "languageId": "foon", "version": 1, "text": text}
        client.tell("textDocument/didOpen", textDocument=item)

    def at(self, line: int, column: int) -> dict[str, Any]:
        """Give a place in it, from 0."""
        return {"textDocument": {"uri": self.uri}, "position": {"line": line, "character": column}}

    def ask(self, method: str, line: int = 0, column: int = 0, **more: Any) -> Any:
        """Ask about a place."""
        return self.client.ask(f"textDocument/{method}", **self.at(line, column), **more)

    def whole(self, method: str, **more: Any) -> Any:
        """Ask about all of it."""
        return self.client.ask(f"textDocument/{method}", textDocument={"uri": self.uri}, **more)

    def change(self, start: tuple[int, int], end: tuple[int, int], text: str) -> None:
        """Type, in the editor and here."""
        self.version += 1
        places = [{"line": line, "character": column} for line, column in (start, end)]
        edit = {"range": dict(zip(("start", "end"), places, strict=True)), "newText": text}
        self.text = edited(self.text, [edit])
        document = {"uri": self.uri, "version": self.version}
        self.client.tell(
            "textDocument/didChange", textDocument=document, contentChanges=[{"text": self.text}]
        )


def edited(text: str, edits: list[dict[str, Any]]) -> str:
    """Apply edits as an editor does: from the last to the first, columns in UTF-16 units."""
    lines = text.split("\n")
    starts = [0]
    for line in lines:
        starts.append(starts[-1] + len(line.encode("utf-16-le")) + 2)
    data = text.encode("utf-16-le")

    def place(at: dict[str, int]) -> int:
        return min(starts[min(at["line"], len(lines))] + 2 * at["character"], len(data))

    for edit in sorted(edits, key=lambda each: place(each["range"]["start"]), reverse=True):
        start, end = place(edit["range"]["start"]), place(edit["range"]["end"])
        data = data[:start] + edit["newText"].encode("utf-16-le") + data[end:]
    return data.decode("utf-16-le")
