"""Escaped text: terminals and logs receive only harmless characters, whatever names contain.

Unsafe characters, such as control characters and marks of writing direction, become a JSON escape: a
backslash, ``u`` and four digits. So an escaped JSON text is JSON with the same value.
"""

import re

# Control characters (C0 without tab and line feed, delete, C1), marks that turn the direction of writing,
# characters without width, line and paragraph separators, halves of characters, and tags.
_UNSAFE = (
    "\x00-\x08\x0b-\x1f\x7f-\x9f\u061c\u180e\u200b-\u200f\u2028-\u202e\u2060-\u206f\ufeff\ufff9-\ufffb"
    "\ud800-\udfff\U000e0000-\U000e007f"
)
UNSAFE = re.compile(f"[{_UNSAFE}]")  # within a text of several lines
# Patterns as text are compiled when they are needed.
_IN_A_LINE = f"[{_UNSAFE}\n\t]"
# A progress line that is overwritten begins with a carriage return and an escape sequence.
_UNSAFE_BUT_ESCAPE = f"[{_UNSAFE}]|\r(?!\x1b)".replace("\x0b-\x1f", "\x0b\x0c\x0e-\x1a\x1c-\x1f")
# Commands of GitHub's and Azure's logs: ``::error::`` at the beginning of a line, ``##[error]`` anywhere.
_COMMAND = r"(?m)^([^\S\n]*):(?=:)|#(?=#(?:\[|vso\[))"


def escaped(name: str) -> str:
    """Return a name that can be shown within a line: unsafe characters, line ends and tabs are escaped."""
    return re.sub(_IN_A_LINE, _escape_match, name)


def escaped_lines(text: str, styled: bool = False) -> str:
    """Return a text of several lines with escapes for unsafe characters; line ends and tabs stay.

    A command of build logs, such as ``::error::`` or ``##[error]``, gets an escape within its beginning, so
    that no log obeys it. If ``styled``, escape characters stay, since colours need them. Carriage returns
    before escape characters then stay, too.
    """
    shown = re.sub(_UNSAFE_BUT_ESCAPE, _escape_match, text) if styled else UNSAFE.sub(_escape_match, text)
    return re.sub(_COMMAND, _without_command, shown) if "::" in shown or "##" in shown else shown


def encodable(text: str, encoding: str = "utf-8") -> str:
    """Return a text with escapes for the letters that an encoding does not have.

    An unknown encoding is taken for ASCII.
    """
    try:
        text.encode(encoding)
    except UnicodeEncodeError:
        return "".join(letter if _encodes(encoding, letter) else _escape_of(letter) for letter in text)
    except LookupError:  # no such encoding: ASCII is in all of them
        return encodable(text, "ascii")
    return text


def _encodes(encoding: str, letter: str) -> bool:
    """Whether an encoding has a letter."""
    try:
        letter.encode(encoding)
    except UnicodeEncodeError:
        return False
    return True


def _escape_match(match: re.Match[str]) -> str:
    """Return the escape of a matched letter."""
    return _escape_of(match[0])


def _without_command(match: re.Match[str]) -> str:
    """Return a match of ``_COMMAND``, the beginning of a command, with an escape for its last letter."""
    return f"{match[1] or ''}{_escape_of(match[0][-1])}"


def _escape_of(letter: str) -> str:
    r"""Return the JSON escape of a letter: ``\u200b``; a letter beyond 0xFFFF has two, a surrogate pair."""
    code_point = ord(letter)
    if code_point > 0xFFFF:
        code_point -= 0x10000
        return f"\\u{0xD800 + (code_point >> 10):04x}\\u{0xDC00 + (code_point & 0x3FF):04x}"
    return f"\\u{code_point:04x}"
