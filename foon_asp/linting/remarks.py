"""The remarks of the reader, with the fixes that are certain."""

from foon_asp.linting.linted_files import LintedFiles
from foon_asp.linting.vocabulary import Vocabulary
from foon_asp.network import Contents
from foon_asp.text.diagnostics import Diagnostic
from foon_asp.text.line import LineError, StateLine
from foon_asp.text.reader import FoonReader


def remarks_by_code(files: LintedFiles, vocabulary: Vocabulary) -> dict[str, list[Diagnostic]]:
    """Return the remarks of the reader by code; fixes that are doubtful or repair nothing are removed.

    A fix rewrites a whole line. So if one remark on a line is doubtful, no remark on this line keeps its fix.
    """
    doubtful = {
        remark.source[:2] for remark in files.remarks if _is_doubtful(remark, vocabulary, files.reader)
    }
    by_code: dict[str, list[Diagnostic]] = {}
    for remark in files.remarks:
        fix = None if remark.source[:2] in doubtful else _mending_fix(remark, files.reader)
        by_code.setdefault(remark.code, []).append(remark._replace(fix=fix))
    return by_code


def _is_doubtful(remark: Diagnostic, vocabulary: Vocabulary, reader: FoonReader) -> bool:
    """Whether the reader may have guessed the wrong kind of bracket for a mixed pair such as ``[a}``.

    False for other remarks. Braces are certain for a list, and after the word ``contains``. Any other guess
    is certain only if the vocabulary usually has this kind of bracket after the word.
    """
    if remark.code != "bracket" or "wrong bracket" not in remark.message:
        return False
    line = reader.parse(remark.excerpt)
    attribute = line.attribute if isinstance(line, StateLine) else ""
    if isinstance(attribute, str):
        return False
    if isinstance(attribute, Contents) and (len(attribute.ingredients) > 1 or attribute.word == "contains"):
        return False
    return vocabulary.usual_bracket(attribute.word) is not type(attribute)


def _mending_fix(remark: Diagnostic, reader: FoonReader) -> str | None:
    """Return the fix of a remark. Return ``None`` if it has none, or one that does not repair the line.

    A fix does not repair a line if the reader makes the same remark on the fixed line. The fix of a missing
    separator is the line with ``//`` below it.
    """
    if remark.code == "missing-separator":
        return f"{remark.excerpt}\n//"
    if remark.fix is None or remark.fix == "//":
        return remark.fix
    mended = reader.parse(remark.fix)
    remaining = [] if isinstance(mended, LineError) else [message for _, _, message in mended.remarks]
    return remark.fix if remark.message not in remaining else None
