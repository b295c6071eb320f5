"""Checks of the text of an encoding before clingo reads it: included files, letters and numbers.

clingo opens any file that an ``#include`` names. It reads a number that is too large modulo 2^32. It aborts
the whole process where its message about an unexpected letter is not UTF-8. These texts are refused here.
"""

import re
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from foon_asp.encoding.exact import LARGEST
from foon_asp.errors import UserError
from foon_asp.network import Source
from foon_asp.text.diagnostics import Diagnostic, InputError, Severity

# The tokens of clingo's own lexer, as far as they matter here.
_TOKEN = re.compile(
    r"""
      (?P<block>%\*)
    | (?P<comment>(?:%|\#!)[^\n]*)
    | (?P<string>"(?:[^\\"\n]|\\["\\n])*")
    | (?P<number>0x[0-9A-Fa-f]+|0o[1-7]+|0b[01]+|0|[1-9][0-9]*)
    | (?P<word>[_']*[A-Za-z]['A-Za-z0-9_]*)
    | (?P<call>@[\t\r\n ]*[_']*[a-z]['A-Za-z0-9_]*[\t\r\n ]*\()
    | (?P<keyword>\#[A-Za-z0-9_]*)
    | (?P<blank>[\t\r\n ]+)
    | (?P<sign>.)
    """,
    re.VERBOSE | re.DOTALL,
)
_IN_BLOCK = re.compile(r"\*%|%\*|%[^\n]*")
_ESCAPED = re.compile(r"\\(.)")
_STRING = re.compile(r'"([^"\\]|\\["\\n])*"')  # as clingo reads one
_SUFFIX = ".lp"


def included_files(path: Path) -> list[Path]:
    """Return an encoding and all files that it includes, directly or not, each once.

    A file may include files in its own folder and below. Raises :class:`UserError` for a file whose name does
    not end in ``.lp``. Raises :class:`InputError` with all faults of the files:

    - other includes,
    - a ``#script`` or a call ``@f(...)``,
    - letters that clingo does not read outside of quotes, and text that is not UTF-8,
    - numbers beyond clingo's range.
    """
    files: dict[Path, Path] = {}  # by resolved path
    pending = [path]
    errors: list[Diagnostic] = []
    while pending:
        file = pending.pop()
        if file.resolve() not in files:
            files[file.resolve()] = file
            pending += _check_file(file, errors)
    if errors:
        raise InputError(errors)
    return list(files.values())


def source_line(source: Source) -> str:
    """Return the line of an encoding at a place.

    It is empty if there is no such line, and for files whose names do not end in ``.lp``.
    """
    path = Path(source.file)
    if path.suffix != _SUFFIX or not path.is_file():
        return ""
    lines = path.read_text(encoding="utf-8", errors="replace").split("\n")
    return lines[source.line - 1].rstrip("\r") if 0 < source.line <= len(lines) else ""


class _Token(NamedTuple):
    """A token: its kind (a group name of ``_TOKEN``), its text, and its offset in the program."""

    kind: str
    text: str
    start: int


def check_text(text: str, origin: str) -> None:
    """Raise :class:`InputError` for rules given as text that clingo must not read.

    An ``#include`` is a fault, and so is anything that :func:`included_files` calls a fault. ``origin`` is
    the name of the rules in messages. Raises :class:`UserError` for a text that has no encoding in UTF-8.
    """
    errors: list[Diagnostic] = []
    if any("\ud800" <= letter <= "\udfff" for letter in text):
        raise UserError(f"{origin}: expected a rule in UTF-8")
    _check_content(text, origin, None, errors)
    if errors:
        raise InputError(errors)


def _check_file(file: Path, errors: list[Diagnostic]) -> list[Path]:
    """Append the errors of a file to ``errors``, and return the files that it includes.

    A file that is not UTF-8 has one error, and includes nothing. Raises :class:`UserError` for a name that
    does not end in ``.lp``, or has no encoding in UTF-8.
    """
    if file.suffix != _SUFFIX:
        raise UserError(f"{file}: expected an encoding, a file whose name ends in {_SUFFIX}")
    if any("\ud800" <= letter <= "\udfff" for letter in str(file)):  # clingo takes UTF-8 only
        raise UserError(f"{file}: expected an encoding with a name in UTF-8")
    content = file.read_bytes()
    try:
        text = content.decode("utf-8")
    except UnicodeDecodeError as fault:
        line = content.count(b"\n", 0, fault.start) + 1
        column = fault.start - content.rfind(b"\n", 0, fault.start)
        message = f"found the byte {content[fault.start]:#04x}, expected text in UTF-8"
        line_text = content.split(b"\n")[line - 1].decode("utf-8", "replace").rstrip("\r")
        source = Source(str(file), line, column)
        errors.append(Diagnostic(Severity.ERROR, "not-utf-8", message, source, line_text))
        return []
    return _check_content(text, str(file), file, errors)


def _check_content(text: str, origin: str, file: Path | None, errors: list[Diagnostic]) -> list[Path]:
    """Append the errors of a text to ``errors``, and return the files that it may include.

    ``file`` is the file that has the text; a text without a file may include nothing. ``origin`` is its name
    in messages. After a ``#script``, nothing is read. In a text with a zero character, only this character is
    reported.
    """
    lines = text.split("\n")

    def error(code: str, message: str, start: int) -> None:
        """Append an error at an offset of the text (``start``), with its line."""
        line = text.count("\n", 0, start) + 1
        column = start - text.rfind("\n", 0, start)
        line_text = lines[line - 1].rstrip("\r")
        errors.append(Diagnostic(Severity.ERROR, code, message, Source(origin, line, column), line_text))

    if "\0" in text:  # clingo ends a text there, even within a comment
        error("letter", "found U+0000, which no rule can have", text.index("\0"))
        return []
    included: list[Path] = []
    tokens = _tokens(text)
    for token in tokens:
        if token.kind == "number" and int(token.text, 0) > LARGEST:
            error("large-number", f"found the number {token.text}, expected at most {LARGEST}", token.start)
        elif token.kind == "sign" and not (token.text.isascii() and token.text.isprintable()):
            letter = f"U+{ord(token.text):04X}"
            letter_text = f"{token.text!r} ({letter})" if token.text.isprintable() else letter
            advice = "; clingo's quotation mark is \"" if token.text in "“”„«»‘’" else ""
            error(
                "letter",
                f"found {letter_text}, which no rule can have outside of quotes{advice}",
                token.start,
            )
        elif token.kind == "call":
            name = "".join(token.text[:-1].split())
            error("function", f"found {name}(...), expected no function: rules run no code", token.start)
        elif token.text == "#script":
            error("script", "found #script, expected rules: scripts in encodings are not run", token.start)
            break
        elif token.text == "#include":
            target_token = next(tokens, None)
            if file is None:
                error("include", "found #include, expected rules: only a file includes others", token.start)
            elif target_token is not None and target_token.kind == "string":
                target = _ESCAPED.sub(
                    lambda match: "\n" if match[1] == "n" else match[1], target_token.text[1:-1]
                )
                refusal = _include_refusal(file, target)
                if refusal:
                    error("include", f"found #include of {target_token.text}, {refusal}", token.start)
                else:
                    included.append(file.parent / target)
            elif target_token is not None and target_token.text == "<":
                error(
                    "include", "found #include <...>, expected a file: nothing else is included", token.start
                )
    return included


def _include_refusal(file: Path, target: str) -> str:
    """Return the reason why a file may not include ``target``; empty if it may.

    It may include an existing ``.lp`` file in its folder or below. It may not if the working folder has
    another file of that name, which clingo would take.
    """
    folder = file.parent.resolve()
    path = file.parent / target
    if "\0" in target or not path.resolve().is_relative_to(folder) or ".." in Path(target).parts:
        return "expected a file in the folder of the file that includes it, or below"
    if path.suffix != _SUFFIX or path.resolve().suffix != _SUFFIX:
        return f"expected an encoding, a file whose name ends in {_SUFFIX}"
    if not path.is_file():
        return f"expected an existing file: there is none in {folder}"
    working_file = Path(target)  # clingo prefers the working folder
    if working_file.is_file() and not working_file.samefile(path):
        return (
            "but the folder in which foon-asp was started has a file of this name, too, which clingo would "
            "take: give the file another name, or start foon-asp elsewhere"
        )
    return ""


def _tokens(text: str) -> Iterator[_Token]:
    """Yield the tokens of a program, without blanks and comments.

    If a block comment never ends, the tokens before it are the last.
    """
    offset = 0
    while match := _TOKEN.match(text, offset):
        kind = str(match.lastgroup)
        offset = match.end()
        if kind == "block":
            depth = 1
            while depth and (mark := _IN_BLOCK.search(text, offset)):
                depth += {"%*": 1, "*%": -1}.get(mark[0], 0)
                offset = mark.end()
            if depth:  # clingo says so
                return
        elif kind not in {"comment", "blank"}:
            yield _Token(kind, match[0], match.start())


def string_constant(value: str) -> str:
    """Return the text that a setting of a string constant means.

    The setting may be in quotes; then escaped characters in it are resolved. Raises :class:`UserError` for a
    setting that begins with a quote and is no string of clingo.
    """
    if not value.startswith('"'):
        return value
    if not _STRING.fullmatch(value):
        raise UserError(
            f'found {value} for a constant, expected a text in quotes, with \\" for a quote in it'
        )
    return _ESCAPED.sub(lambda match: "\n" if match[1] == "n" else match[1], value[1:-1])
