"""Lint rule about letters that are invisible or look like others."""

import re
import unicodedata
from collections import Counter
from collections.abc import Iterator

from foon_asp.linting.context import Context
from foon_asp.linting.rule import ERROR, rule
from foon_asp.text.diagnostics import Diagnostic

_PLAIN = re.compile(r"[\t\x20-\x7e]*")
_LETTERS_OF_WORD = re.compile(
    r"(?:[^\W\d_]|[\u0300-\u036f])+"
)  # letters, and accents that stand behind theirs
_SCRIPTS = {"LATIN", "CYRILLIC", "GREEK"}  # those whose letters look alike
_UNSEEN = {"Cc", "Cf", "Zl", "Zp", "Zs"}


@rule("ambiguous-letter", ERROR, "a letter that is not seen, or that looks like another")
def find_ambiguous_letters(context: Context) -> Iterator[Diagnostic]:
    """Two names look the same but differ, which nobody can see.

    There are three kinds. A name has a control character, a letter without width, or a blank that is not the
    usual one. A name has a Cyrillic or Greek letter among Latin ones; a word in a single script is fine. An
    accented letter is two characters in one name and one character in the other; then the rarer form is
    reported. Type the name again, or copy it.
    """
    odd_lines = [
        (sheet, index, line)
        for sheet in context.sheets
        for index, line in enumerate(sheet.lines)
        if not line.startswith("#") and not _PLAIN.fullmatch(line)
    ]
    spelt = Counter(word for _, _, line in odd_lines for word in _LETTERS_OF_WORD.findall(line))
    # the most frequent form of each word, by its composed form, which comes first among equally frequent ones
    usual_forms: dict[str, str] = {}
    for word in sorted(spelt, key=lambda form: (spelt[form], unicodedata.is_normalized("NFC", form))):
        usual_forms[unicodedata.normalize("NFC", word)] = word
    for sheet, index, line in odd_lines:
        faults = [_invisible_character_fault(line), _mixed_script_fault(line)]
        for word in dict.fromkeys(_LETTERS_OF_WORD.findall(line)):
            if word != usual_forms[unicodedata.normalize("NFC", word)]:
                message = (
                    f"{word!r} looks the same elsewhere, where its accents are other characters; the names "
                    "differ, so copy the word from there"
                )
                faults.append((line.index(word) + 1, message))
        for column, message in filter(None, faults):
            yield sheet.finding(message, index, column=column)


def _invisible_character_fault(line: str) -> tuple[int, str] | None:
    """Return the column of the first invisible character, from 1, and the message about it.

    ``None`` if the line has no such character.
    """
    for column, letter in enumerate(line, 1):
        category = unicodedata.category(letter)
        if letter not in "\t " and category in _UNSEEN:
            name = unicodedata.name(letter, "control character").lower()
            fault = "is no usual blank" if category == "Zs" else "is not seen"
            character = f"the character U+{ord(letter):04X} ({name})"
            return column, f"{character} {fault}, and makes another name; type it anew"
    return None


def _mixed_script_fault(line: str) -> tuple[int, str] | None:
    """Return the column, from 1, of the first letter of another script within a word, and the message.

    Only Latin, Cyrillic and Greek letters count. The other script is the one with the fewest letters in the
    word. ``None`` if every word has one script.
    """
    for match in _LETTERS_OF_WORD.finditer(line):
        scripts: dict[str, list[int]] = {}
        for index, letter in enumerate(match[0]):
            scripts.setdefault(unicodedata.name(letter, "").partition(" ")[0], []).append(index)
        scripts = {script: indexes for script, indexes in scripts.items() if script in _SCRIPTS}
        if len(scripts) > 1:
            script, indexes = min(scripts.items(), key=lambda entry: len(entry[1]))
            message = (
                f"{match[0]!r} has a {script.capitalize()} letter, U+{ord(match[0][indexes[0]]):04X}, among "
                "others that look like it, which makes another name; type it anew"
            )
            return match.start() + indexes[0] + 1, message
    return None
