"""What there is to say of letters that nobody sees, or takes for others."""

import re
import unicodedata
from collections.abc import Iterator

from foon_asp.linting.linted_files import LintedFiles
from foon_asp.linting.sheet import Sheet
from foon_asp.text.diagnostics import Diagnostic

_PLAIN = re.compile(r"[\t\x20-\x7e]*")
_WORD = re.compile(r"(?:[^\W\d_]|[\u0300-\u036f])+")  # letters, and accents that stand behind theirs
_SCRIPTS = {"LATIN", "CYRILLIC", "GREEK"}  # those whose letters look alike
_UNSEEN = {"Cc", "Cf", "Zl", "Zp"}


def letter_findings(files: LintedFiles) -> Iterator[Diagnostic]:
    """Give a finding for each line with odd letters, of each kind: unseen, of another script, two accents."""
    odd = [
        (sheet, index, line)
        for sheet in files.sheets
        for index, line in enumerate(sheet.lines)
        if line[:1] != "#" and not _PLAIN.fullmatch(line)
    ]
    forms: dict[str, dict[str, int]] = {}
    for _, _, line in odd:
        for word in _WORD.findall(line):
            spelt = forms.setdefault(unicodedata.normalize("NFC", word), {})
            spelt[word] = spelt.get(word, 0) + 1
    for sheet, index, line in odd:
        yield from _unseen(sheet, index, line)
        yield from _of_two_scripts(sheet, index, line)
        for word in dict.fromkeys(_WORD.findall(line)):
            spelt = forms[unicodedata.normalize("NFC", word)]
            if word != max(spelt, key=lambda form: (spelt[form], unicodedata.is_normalized("NFC", form))):
                message = (
                    f"{word!r} looks the same elsewhere, where its accents are other characters; the names "
                    "differ, so copy the word from there"
                )
                yield sheet.finding("accent", message, index, column=line.index(word) + 1)


def _unseen(sheet: Sheet, index: int, line: str) -> Iterator[Diagnostic]:
    for column, letter in enumerate(line, 1):
        category = unicodedata.category(letter)
        if letter not in "\t " and (category in _UNSEEN or category == "Zs"):
            name = unicodedata.name(letter, "control character").lower()
            what = "is no usual blank" if category == "Zs" else "is not seen"
            message = (
                f"the character U+{ord(letter):04X} ({name}) {what}, and makes another name; type it anew"
            )
            yield sheet.finding("unseen-letter", message, index, column=column)
            return


def _of_two_scripts(sheet: Sheet, index: int, line: str) -> Iterator[Diagnostic]:
    for match in _WORD.finditer(line):
        if match[0].isascii():
            continue
        scripts: dict[str, list[int]] = {}
        for place, letter in enumerate(match[0]):
            script = unicodedata.name(letter, "").partition(" ")[0]
            if script in _SCRIPTS:
                scripts.setdefault(script, []).append(place)
        if len(scripts) > 1:
            script, places = min(scripts.items(), key=lambda each: len(each[1]))
            letter = match[0][places[0]]
            message = (
                f"{match[0]!r} has a {script.capitalize()} letter, U+{ord(letter):04X}, among others that "
                "look like it, which makes another name; type it anew"
            )
            yield sheet.finding("foreign-letter", message, index, column=match.start() + places[0] + 1)
            return
