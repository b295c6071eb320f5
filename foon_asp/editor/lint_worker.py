"""Linting in a process of its own, which is ended when the text has changed."""

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

from foon_asp.errors import UserError
from foon_asp.lint.linter import lint
from foon_asp.lint.settings import find_settings
from foon_asp.network import Source
from foon_asp.python_process import PythonProcess
from foon_asp.text.diagnostics import Diagnostic, Rename, Severity
from foon_asp.text.json_value import json_line, read_json

Findings = list[tuple[int, Diagnostic]]
"""Findings with the index of their lines."""


class LintProcess(PythonProcess):
    """Lints one text; ``done`` is called in a thread with the findings, or what is wrong with the settings.

    It is not called when the process is ended before.
    """

    def __init__(self, file: str, text: str, done: Callable[["LintProcess", Findings | str], None]) -> None:
        super().__init__("foon_asp.editor.lint_worker", "texts are linted", stderr=subprocess.DEVNULL)
        self.beside(self._speak, file, text, done)

    def _speak(self, file: str, text: str, done: Callable[["LintProcess", Findings | str], None]) -> None:
        try:
            left = memoryview(json_line({"file": file, "text": text}).encode())
            while left:
                left = left[self._out.write(left) or 0 :]
            self._out.close()
            parts = []
            while part := self._in.read(1 << 20):
                parts.append(part)
            answer: Any = read_json(b"".join(parts))
        except (OSError, ValueError):
            return  # it was ended
        if "error" in answer:
            done(self, str(answer["error"]))
        else:
            done(self, [_finding(file, each) for each in answer["findings"]])


def _finding(file: str, said: dict[str, Any]) -> tuple[int, Diagnostic]:
    source = Source(file, said["line"], said["column"])
    rename = Rename(*said["rename"]) if said["rename"] else None
    severity, fix = Severity(said["severity"]), said["fix"]
    code, message, text, unsafe = (said[key] for key in ("code", "message", "text", "unsafe"))
    return said["line"] - 1, Diagnostic(severity, code, message, source, text, fix, unsafe, rename)


def serve() -> None:
    """Lint the text on standard input, and write the findings to standard output."""
    asked = read_json(sys.stdin.buffer.read())
    file = Path(asked["file"])
    answer: dict[str, object]
    try:
        found = find_settings([file]).applied(lint([file], {file: asked["text"].encode("utf-8", "replace")}))
    except UserError as error:
        answer = {"error": str(error)}
    else:
        answer = {
            "findings": [
                {
                    "line": max(1, each.source.line),
                    "column": max(1, each.source.column),
                    "severity": each.severity,
                    "code": each.code,
                    "message": each.message,
                    "text": each.excerpt,
                    "fix": each.fix,
                    "unsafe": each.unsafe,
                    "rename": each.rename,
                }
                for each in found
            ]
        }
    sys.stdout.buffer.write(json_line(answer).encode())
    sys.stdout.flush()
