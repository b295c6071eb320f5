"""Everything that linting can say: one entry for each code."""

from difflib import get_close_matches
from typing import NamedTuple

from foon_asp.text.diagnostics import Severity

ERROR, WARNING, NOTE = Severity.ERROR, Severity.WARNING, Severity.NOTE


class Rule(NamedTuple):
    """What a code means, in one line, and how bad it is; ``docs/lint.md`` has an example of each."""

    code: str
    severity: Severity
    meaning: str


_RULES = (
    # The file and its lines: what the reader remarks on.
    Rule("encoding", ERROR, "the file is not UTF-8 text"),
    Rule("json", ERROR, "JSON that is no network, kitchen or list of goals"),
    Rule("json-value", WARNING, "a value in JSON that units have no place for"),
    Rule("syntax", ERROR, "a line that is not understood"),
    Rule("state-without-object", ERROR, "a state line with no object line above it"),
    Rule("second-motion", ERROR, "two motions in one unit"),
    Rule("no-motion", ERROR, "a unit without a motion"),
    Rule("no-inputs", ERROR, "a unit without input objects"),
    Rule("no-outputs", ERROR, "a unit without output objects"),
    Rule("missing-separator", WARNING, "the last unit is not closed by //"),
    Rule("space-for-tab", WARNING, "a space instead of a tab"),
    Rule("outer-space", WARNING, "blanks around a name or at the end of a line"),
    Rule("bracket", WARNING, "a bracket that is missing, open, or closed by one of another kind"),
    Rule("contents-bracket", WARNING, "contents in [ ] instead of { }"),
    Rule("empty-relation", WARNING, "nothing in [ ]"),
    Rule("empty-ingredient", WARNING, "a comma with no ingredient before or after it"),
    Rule("repeated-ingredient", WARNING, "an ingredient listed twice in one { }"),
    Rule("empty-field", WARNING, "a tab with nothing after it"),
    Rule("motion-flag", WARNING, "a motion flag that is not 0 or 1"),
    Rule("unknown-field", WARNING, "something after a motion flag that is neither a category nor !"),
    Rule("time", WARNING, "something that is not a valid time"),
    Rule(
        "time-value", WARNING, "a time that is hardly meant: too many seconds, hours, an end before its start"
    ),
    Rule("time-order", WARNING, "a step before the one that makes what it uses"),
    Rule("unseen-letter", ERROR, "a character that is not seen"),
    Rule("foreign-letter", ERROR, "a letter of another script that looks like one"),
    Rule("accent", ERROR, "an accent that is written in two forms"),
    Rule("noqa", WARNING, "a noqa comment that silences nothing"),
    # Object nodes.
    Rule("flag-space", WARNING, "a motion flag behind a space, which makes it part of the name"),
    Rule("other-bracket", WARNING, "a bracket of another kind than the word has elsewhere"),
    Rule("no-bracket", WARNING, "a state that is a relation or contents without brackets"),
    Rule("missing-flag", NOTE, "no motion flag on an object line, in a file where most have one"),
    Rule("second-contents", NOTE, "two { } lines under one object"),
    Rule("second-relation", NOTE, "two [ ] lines under one object"),
    Rule("repeated-state", WARNING, "the same state line twice under one object"),
    # Names and ids.
    Rule("near-name", WARNING, "two names that differ by a likely typing error"),
    Rule("misspelt", WARNING, "a word that is nearly one of the vocabulary"),
    Rule("other-kind", WARNING, "a state that is known as an object, or an object as a state"),
    Rule("unknown-container", NOTE, "an object in [ ] that is never an object line"),
    Rule("unknown-ingredient", WARNING, "an ingredient in { } that is never an object line"),
    Rule("id-of-two-names", WARNING, "one id for two names"),
    Rule("missing-id", NOTE, "no id, in a file where nearly all lines have one"),
    Rule("name-of-two-ids", WARNING, "one name with two ids"),
    # Units and what they make.
    Rule("repeated-object", WARNING, "an object node listed twice on one side of a unit"),
    Rule("no-effect", WARNING, "a unit whose outputs are its inputs"),
    Rule("duplicate-unit", WARNING, "a unit that the file already contains"),
    Rule("broken-chain", WARNING, "an object that is taken, and made a little different"),
    Rule(
        "left-out",
        WARNING,
        "a unit that has something and not the container that it is in, or the other way round",
    ),
    Rule("swapped-sides", WARNING, "a unit that would go together with others the other way round"),
    Rule("lost-contents", WARNING, "contents that lose something, which no output has"),
    Rule("gained-contents", WARNING, "contents that gain something, which no input has"),
    Rule("from-nothing", WARNING, "an output that nothing among the inputs is or contains"),
    Rule("vanished", WARNING, "an input that no output is or contains"),
    Rule("unheld", WARNING, "an object in something that contains other things, and not it"),
    Rule(
        "other-place",
        WARNING,
        "an object in something that the unit has not, or in nothing, while something else contains it",
    ),
    Rule("dead-cycle", NOTE, "objects that are made only by units that need them"),
    # What stands beside units.
    Rule("table", ERROR, "a row of a table beside the network that cannot be read"),
    Rule("unknown-row", WARNING, "a row of a table for a name that the network has not"),
    Rule("missing-rate", WARNING, "motions of the network without a success rate"),
    Rule("unmade-goal", WARNING, "a goal that no unit makes"),
    Rule("unknown-item", NOTE, "an entry of a kitchen that is not in the network"),
)

CATALOG = {rule.code: rule for rule in _RULES}
"""By code, in the order in which they are documented."""


def unknown_code(code: str) -> str:
    """Return what to say of a code that is none, with the nearest that there is."""
    near = get_close_matches(code, CATALOG, n=1)
    hint = f"; did you mean {near[0]!r}?" if near else ""
    return f"there is no code {code!r}; docs/lint.md lists them{hint}"
