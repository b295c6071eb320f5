"""Linting in a process of its own, which is ended when the text has changed."""

import subprocess
import sys
from collections.abc import Callable
from io import BufferedReader
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
        found: Findings = []
        try:
            left = memoryview(f"{json_line(file)}\n{text}".encode("utf-8", "replace"))
            while left:
                left = left[self._out.write(left) or 0 :]
            self._out.close()
            for line in BufferedReader(self._in):
                # one by one, so that the editor gets its answers meanwhile
                if "error" in (said := read_json(line)):
                    done(self, str(said["error"]))
                    return
                if "whole" in said:
                    done(self, found)
                    return
                found.append(_finding(file, said))
        except (OSError, ValueError):
            return  # it was ended


def _finding(file: str, said: dict[str, Any]) -> tuple[int, Diagnostic]:
    source = Source(file, said["line"], said["column"])
    rename = Rename(*said["rename"]) if said["rename"] else None
    severity, fix = Severity(said["severity"]), said["fix"]
    code, message, text, unsafe = (said[key] for key in ("code", "message", "text", "unsafe"))
    return said["line"] - 1, Diagnostic(severity, code, message, source, text, fix, unsafe, rename)


def serve() -> None:
    """Lint the text on standard input, behind a line with its name; write the findings, each on a line."""
    file = Path(read_json(sys.stdin.buffer.readline()))
    said: list[dict[str, object]]
    try:
        found = find_settings([file]).applied(lint([file], {file: sys.stdin.buffer.read()}))
    except UserError as error:
        said = [{"error": str(error)}]
    else:
        said = [
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
        said.append({"whole": True})
    sys.stdout.buffer.writelines(f"{json_line(each)}\n".encode() for each in said)
    sys.stdout.flush()
