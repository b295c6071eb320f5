"""Lint rules whose findings are remarks of the reader on files and lines."""

from collections.abc import Iterator

from foon_asp.linting.context import Context
from foon_asp.linting.rule import ERROR, WARNING, rule
from foon_asp.linting.sheet import Sheet
from foon_asp.text.diagnostics import Diagnostic, Severity
from foon_asp.text.line import ObjectLine


def _register_reader_rule(code: str, severity: Severity, meaning: str, explanation: str) -> None:
    """Register a rule whose findings are the remarks of the reader that have the rule's code.

    ``explanation`` is the text for users.
    """

    def remarks_of_this_code(context: Context) -> list[Diagnostic]:
        return context.remarks.get(code, [])

    remarks_of_this_code.__doc__ = explanation
    rule(code, severity, meaning)(remarks_of_this_code)


_register_reader_rule(
    "encoding",
    ERROR,
    "the file is not UTF-8 text",
    "Text must be UTF-8, with or without a byte order mark. Save the file as UTF-8.",
)
_register_reader_rule(
    "json",
    ERROR,
    "JSON that is no network, kitchen or list of goals",
    "The place is that of the unit or entry that cannot be read; the message says what is expected there. "
    "The other units are still linted.",
)
_register_reader_rule(
    "json-value",
    WARNING,
    "a value in JSON that units have no place for",
    "The value has no counterpart in FOON text. The unit is read without it.",
)
_register_reader_rule(
    "syntax",
    ERROR,
    "a line that is not understood",
    "The line is left out; if it is an object line, the states below it are left out, too. Lines begin with "
    "`O`, `S`, `M` or `//`, or with `#` for comments.",
)
_register_reader_rule(
    "state-without-object",
    ERROR,
    "a state line with no object line above it",
    "A state belongs to the object line above it, which is missing here.",
)
_register_reader_rule(
    "second-motion",
    ERROR,
    "two motions in one unit",
    "Usually a `//` between two units is missing.",
)
_register_reader_rule(
    "no-motion",
    ERROR,
    "a unit without a motion",
    "The motion line is missing, or there is a `//` too many. An incomplete unit is left out of the network. "
    "A file without any motion is read as a kitchen or a list of goals.",
)
_register_reader_rule(
    "no-inputs",
    ERROR,
    "a unit without input objects",
    "A motion needs something to act on. An incomplete unit is left out of the network.",
)
_register_reader_rule(
    "no-outputs",
    ERROR,
    "a unit without output objects",
    "A unit that makes nothing is of no use to any task tree. What became of its inputs?",
)
_register_reader_rule(
    "missing-separator",
    WARNING,
    "the last unit is not closed by //",
    "If another file were appended to this one, its first unit would run into the last one here. `--fix` "
    "adds the line.",
)
_register_reader_rule(
    "outer-space",
    WARNING,
    "blanks around a name or at the end of a line",
    "Spaces around a name or an ingredient, or at the end of a line, are not part of it. `--fix` removes "
    "them.",
)
_register_reader_rule(
    "bracket",
    WARNING,
    "a bracket that is missing, open, or closed by one of another kind",
    "The bracket is read as closed, or as the kind that must be meant; `--fix` writes it that way. Of "
    "brackets of two kinds, as in `in→{bowl]`, a line stays as it is where a place is probably meant and the "
    "reader takes it for a list.",
)
_register_reader_rule(
    "contents-bracket",
    WARNING,
    "contents in [ ] instead of { }",
    "`[ ]` names the one object that this object is in, on or with. A list is contents, and so is whatever "
    "an object `contains`. `--fix` writes braces.",
)
_register_reader_rule(
    "empty-relation",
    WARNING,
    "nothing in [ ]",
    "Without an object, the word is read as a state. `--fix` removes the brackets; if an object was "
    "forgotten, add it first.",
)
_register_reader_rule(
    "empty-ingredient",
    WARNING,
    "a comma with no ingredient before or after it",
    "There is a comma too many. `--fix` removes it; if an ingredient was forgotten, add it first.",
)
_register_reader_rule(
    "repeated-ingredient",
    WARNING,
    "an ingredient listed twice in one { }",
    "Contents say what is there, not how often it was added. Both entries stay part of the object node, "
    "which therefore differs from the node with a single entry: a kitchen that has one does not have the "
    "other.",
)
_register_reader_rule(
    "empty-field",
    WARNING,
    "a tab with nothing after it",
    "An empty field has no meaning. `--fix` removes it.",
)
_register_reader_rule(
    "motion-flag",
    WARNING,
    "a motion flag that is not 0 or 1",
    "`1` means in motion, `0` not in motion. `--fix` writes `0` for `00`; anything else stays.",
)
_register_reader_rule(
    "unknown-field",
    WARNING,
    "something after a motion flag that is neither a category nor !",
    "After the motion flag there may be a recipe category, which is a number, or the goal mark `!`.",
)
_register_reader_rule(
    "time",
    WARNING,
    "something that is not a valid time",
    "Times are `m:ss`, `h:mm:ss` or `Assumed`, in two fields or in one: `<0:12-0:34,0:40-0:44>`. `--fix` "
    "removes a bracket too many and adds a letter missing in `Assumed`; anything else only the annotator can "
    "know.",
)


@rule("space-for-tab", WARNING, "a space instead of a tab")
def find_spaces_for_tabs(context: Context) -> Iterator[Diagnostic]:
    """The letter, the name, the brackets and the motion flag are separated by tabs.

    A space in place of such a tab is read as a tab, and `--fix` replaces it. A motion flag after a space is
    the exception: it is read as a part of the name. It is reported if other lines have flags, or if the text
    before it is a name elsewhere.
    """
    yield from context.remarks.get("space-for-tab", ())
    for sheet in context.sheets:
        if sheet.entries is None:
            yield from _flag_after_space_findings(sheet)


def _flag_after_space_findings(sheet: Sheet) -> Iterator[Diagnostic]:
    """Yield a finding for each name of a sheet that ends in a space and a probable motion flag, 0 or 1.

    It is probably a flag if other lines have flags, or if the name without it is also in the sheet.
    """
    labels = {line.label: line.fields for line, _, _ in sheet.distinct_lines if isinstance(line, ObjectLine)}
    flagged = any(labels.values())
    for line, index, _ in sheet.distinct_lines:
        if not isinstance(line, ObjectLine) or line.fields or line.label[-2:] not in {" 0", " 1"}:
            continue
        name, flag = line.label[:-2], line.label[-1]
        if flagged or name in labels:
            message = f"{line.label!r} is read as the name; is it {name!r} with the motion flag {flag}?"
            yield sheet.finding(message, index, line.label)
