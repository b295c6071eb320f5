"""Answers to the requests of an editor about a FOON text, as JSON of the language server protocol."""

import contextlib
import re
from collections import Counter
from collections.abc import Callable, Iterable, Iterator

from foon_asp.editor.checked_text import CheckedText
from foon_asp.editor.edited_text import EditedText
from foon_asp.editor.field import NAME_KINDS, Field, field_at
from foon_asp.editor.json_rpc import ErrorCode, RequestError, parameter
from foon_asp.errors import UserError
from foon_asp.json_layout import Json
from foon_asp.linting.names import Names
from foon_asp.linting.noqa import silencing_comment
from foon_asp.linting.sheet import Sheet
from foon_asp.network import Contents, ObjectNode, counted
from foon_asp.text.data_folder import kitchen_file
from foon_asp.text.diagnostics import InputError, Rename, Severity
from foon_asp.text.formats import format_of
from foon_asp.text.line import Line, NameKind, StateLine, line_names
from foon_asp.text.object_list import read_object_list
from foon_asp.text.plain_file import split_lines
from foon_asp.text.renaming import Renaming, is_name

_MAX_ITEMS = 100  # names or fixes in an answer: more are slower, and the next letter typed selects among them
_SEVERITIES = {Severity.ERROR: 1, Severity.WARNING: 2, Severity.NOTE: 3}
_SYMBOL_FUNCTION, _ITEM_KEYWORD = 12, 14  # numbers that the protocol gives to kinds of symbols and of items
_ITEM_KINDS = {NameKind.OBJECT: 6, NameKind.STATE: 10, NameKind.WORD: _ITEM_KEYWORD, NameKind.MOTION: 3}
_UnitLine = tuple[int, str]  # the first line of a unit, from 0, and its motion
_LINE_HEADS = {
    "O\t": "an object",
    "S\t": "a state, a relation or contents",
    "M\t": "a motion",
    "//": "the end of a unit",
}


def diagnostics(checked: CheckedText) -> list[Json]:
    """Return all findings of lint as diagnostics of the protocol.

    The range of each goes from the column of the finding to the end of the field there.
    """
    reported = []
    for line, finding in checked.findings:
        start = max(0, finding.source.column - 1)
        field_end = re.split(r"[\t\[\]{},]", checked.text.lines[line][start + 1 :])[0]
        reported.append(
            {
                "range": checked.text.range(line, start, start + 1 + len(field_end)),
                "severity": _SEVERITIES[finding.severity],
                "code": finding.code,
                "source": "foon-asp",
                "message": finding.message,
            }
        )
    return reported


def completion(text: EditedText, names: Names, parameters: object) -> Json:
    """Return the completions at the position in the parameters of a request, at most 100.

    At the beginning of a line, the completions are those of :func:`_line_head_items`. In a field, a name is a
    completion if its kind may stand there and it contains the text before the position. Names that begin with
    this text come first, and then the most frequent. Case is ignored. The text typed so far is a completion
    only if it also stands elsewhere. ``isIncomplete`` says that more than 100 names match.
    """
    line, letter = text.requested_position(parameters)
    content = text.lines[line]
    field = field_at(content, letter)
    if field is None:
        return {"isIncomplete": False, "items": _line_head_items(text, line, letter, names)}
    typed = content[field.start : letter]
    folded = typed.casefold()
    matches = [
        (not name.casefold().startswith(folded), -count, kind, name)
        for kind in field.kinds
        for name, count in names.counts[kind].items()
        if folded in name.casefold() and (name != typed or count > 1)  # one mention is the one being typed
    ]
    items = [
        _completion_item(text, line, field, names, kind, name) | {"sortText": f"{number:03}"}
        for number, (_, _, kind, name) in enumerate(sorted(matches)[:_MAX_ITEMS])
    ]
    return {"isIncomplete": len(matches) > _MAX_ITEMS, "items": items}


def _completion_item(
    text: EditedText, line: int, field: Field, names: Names, kind: NameKind, name: str
) -> Json:
    """Return the completion item of a name in a field of a line.

    If the head of the line has no id, the item adds the most frequent id of the name. After a word of
    relations at the end of the line, it adds a tab and the opening bracket that most often follows the word.
    """
    count, mentions = names.counts[kind][name], names.mentions[kind][name]
    ids = _id_counts(names, kind, name)
    id_ = "" if field.id is None else max(ids, key=ids.__getitem__, default="")
    bracket = ""
    if kind is NameKind.WORD and field.end == len(text.lines[line]):
        holding = sum(mention.occurrences for mention in mentions if _is_contents(mention.line))
        bracket = "\t{" if 2 * holding > count else "\t["
    item: Json = {
        "label": name,
        "kind": _ITEM_KINDS[kind],
        "detail": f"{kind}, {f'{field.letter}{id_}, ' if id_ else ''}{counted(count, 'time')}",
        "textEdit": text.edit(name + bracket, line, field.start, field.end),
    }
    if id_ and not field.id:
        item["additionalTextEdits"] = [text.edit(id_, line, 1, 1)]
    return item


def _is_contents(line: Line) -> bool:
    """Whether a line has contents, in ``{ }``."""
    return isinstance(line, StateLine) and isinstance(line.attribute, Contents)


def _id_counts(names: Names, kind: NameKind, name: str) -> Counter[str]:
    """Return, by id, how many lines have a name with this id at their head."""
    ids: Counter[str] = Counter()
    for mention in names.mentions[kind].get(name, ()):
        if mention.line.id and next(line_names(mention.line))[:2] == (kind, name):
            ids[mention.line.id] += mention.occurrences
    return ids


def _line_head_items(text: EditedText, line: int, letter: int, names: Names) -> list[Json]:
    """Return completions of the beginning of a line: ``O``, ``S``, ``M`` and their tabs, or ``//``.

    After a letter and digits, they are the names whose id begins with these digits, at most 100. Return no
    completions for JSON, or if text follows the position in the line.
    """
    content = text.lines[line]
    if text.is_json or content[letter:].strip():
        return []
    if match := re.fullmatch(r"([OSM])(\d+)", content):
        head, digits = match.groups()
        matches = sorted(
            (id_, name, kind)
            for kind in NAME_KINDS[head]
            for name in names.counts[kind]
            for id_ in _id_counts(names, kind, name)
            if id_.startswith(digits)
        )
        heads = [
            (f"{head}{id_} {name}", f"{head}{id_}\t{name}", _ITEM_KINDS[kind], str(kind))
            for id_, name, kind in matches[:_MAX_ITEMS]
        ]
    else:
        heads = [
            (head.rstrip(), head, _ITEM_KEYWORD, meaning)
            for head, meaning in _LINE_HEADS.items()
            if head.startswith(content)
        ]
    return [
        {
            "label": label,
            "filterText": content or label,
            "kind": kind_number,
            "detail": detail,
            "textEdit": text.edit(new, line),
        }
        for label, new, kind_number, detail in heads
    ]


def _hover(checked: CheckedText, parameters: object) -> Json | None:
    """Return a hover text on the node of a line: its achievers, its consumers, and whether it is available.

    If a name is at the position, the text also says how often it occurs. Return ``None`` if the line belongs
    to no node. The kitchen in the folder of the file is read. If there is no kitchen, or none that can be
    read, a node that no unit makes counts as available.
    """
    text = checked.text
    line, letter = text.requested_position(parameters)
    node = _node_at(checked, line)
    if node is None:
        return None
    achievers, consumers = _achievers_and_consumers(checked, node)
    availability = (
        "not available: a unit has to make it" if achievers else "assumed to be available: no unit makes it"
    )
    with contextlib.suppress(OSError, UserError):
        if file := kitchen_file(text.file.parent):
            in_kitchen = any(entry.pattern.matches(node) for entry in read_object_list(file))
            availability = "available: it is in the kitchen" if in_kitchen else "not in the kitchen"
    paragraphs = [f"**{_escape_markdown(str(node))}**", f"made by {_units_text(achievers)}"]
    paragraphs += [f"needed by {_units_text(consumers)}", availability]
    field = field_at(text.lines[line], letter)
    if field and (count := checked.names.counts[field.kinds[0]].get(field.name)):
        paragraphs.append(f"{field.kinds[0]} '{_escape_markdown(field.name)}': {counted(count, 'time')}")
    return {"contents": {"kind": "markdown", "value": "\n\n".join(paragraphs)}}


def _node_at(checked: CheckedText, line: int) -> ObjectNode | None:
    """Return the object node to which a line belongs; ``None`` if it belongs to no node.

    A state, a comment or an empty line belongs to the object line above it.
    """
    lines = checked.text.lines
    while line > 0 and lines[line][:1] in {"S", "#", ""}:
        line -= 1
    blocks = Sheet("", lines, checked.names.files.reader).object_nodes(line)
    return next((node for start, node in blocks if start == line), None)


def _achievers_and_consumers(
    checked: CheckedText, node: ObjectNode
) -> tuple[list[_UnitLine], list[_UnitLine]]:
    """Return the units that make a node without needing it, and the units that need it.

    They are in the order of their lines, once for each copy; empty if no unit has the node.
    """
    network, copies = checked.names.network, checked.names.files.copies

    def lines_of(units: Iterable[int]) -> list[_UnitLine]:
        """Return the first line and the motion of each copy of units, in order."""
        return sorted((copy.first_index, network.motions[unit]) for unit in units for copy in copies[unit])

    id_ = network.object_id(node)
    if id_ is None:
        return [], []
    achievers = (unit for unit in network.producers[id_] if id_ not in network.inputs[unit])
    return lines_of(achievers), lines_of(network.consumers[id_])


def _units_text(units: list[_UnitLine], max_shown: int = 8) -> str:
    """Return units as text, such as ``mix (line 4), bake (line 9)``; ``no unit`` for an empty list.

    At most ``max_shown`` units are named; the text then ends with the number of the others: ``3 more``.
    """
    shown = [f"{_escape_markdown(motion)} (line {line + 1})" for line, motion in units[:max_shown]]
    if len(units) > max_shown:
        shown.append(f"{len(units) - max_shown} more")
    return ", ".join(shown) or "no unit"


def _escape_markdown(text: str) -> str:
    """Return a text in which the characters that have a meaning in Markdown are escaped."""
    return re.sub(r"([\\`*_{}\[\]<>#+\-!|&])", r"\\\1", text)


def _definitions(checked: CheckedText, parameters: object) -> list[Json]:
    """Return the locations at which achievers list an object node as an output.

    The node is the one to which the line in the parameters belongs. Return no locations if the line belongs
    to no node. If a unit is not found to list the node, its location is its first line.
    """
    text = checked.text
    node = _node_at(checked, text.requested_position(parameters)[0])
    if node is None:
        return []
    sheet = Sheet("", text.lines, checked.names.files.reader)
    lines = (
        next((index for index, listed in sheet.object_nodes(first) if listed == node), first)
        for first, _ in _achievers_and_consumers(checked, node)[0]
    )
    return [{"uri": text.uri, "range": text.range(line)} for line in lines]


def _unit_extents(checked: CheckedText) -> Iterator[tuple[int, int, int, int]]:
    """Yield the extent of each unit, in order: its first line, its motion line, its last line, and its id.

    Lines are indices from 0. The last line is that of ``//``, or the last line of the text without it. Yields
    nothing for JSON.
    """
    lines, files = checked.text.lines, checked.names.files
    starts = sorted((copy.first_index, unit) for unit, copies in enumerate(files.copies) for copy in copies)
    for first, unit in starts if not checked.text.is_json else ():
        following = range(first, len(lines))
        end = next((number for number in following if lines[number][:2] == "//"), following[-1])
        motion = next((number for number in following if lines[number][:1] == "M"), first)
        yield first, motion, end, unit


def _document_symbols(checked: CheckedText, _: object) -> list[Json]:
    """Return the outline of the text: each unit by its motion and the labels of what it makes.

    Outputs that are also inputs are left out. The outline of JSON is empty.
    """
    network, position = checked.names.network, checked.text.position
    symbols = []
    for first, motion, end, unit in _unit_extents(checked):
        outputs = (node for node in network.outputs[unit] if node not in network.inputs[unit])
        labels = " + ".join(dict.fromkeys(network.objects[node].label for node in outputs))
        symbols.append(
            {
                "name": network.motions[unit],
                "detail": f"→ {labels}",
                "kind": _SYMBOL_FUNCTION,
                "range": {"start": position(first), "end": position(end)},
                "selectionRange": checked.text.range(motion, 0, 1),
            }
        )
    return symbols


def _folding_ranges(checked: CheckedText, _: object) -> list[Json]:
    """Return the ranges that can be folded: each unit, without its last line; no ranges for JSON."""
    return [{"startLine": first, "endLine": end - 1} for first, _, end, _ in _unit_extents(checked)]


def _rename_range(checked: CheckedText, parameters: object) -> Json | None:
    """Return the range of the name at a position, which can be renamed; ``None`` if no name is there."""
    line, letter = checked.text.requested_position(parameters)
    field = field_at(checked.text.lines[line], letter)
    return checked.text.range(line, field.start, field.end) if field and field.name else None


def _rename_everywhere(checked: CheckedText, parameters: object) -> Json:
    """Return the edits that rename the name at a position everywhere in the text.

    Raises :class:`RequestError` if no name is there, or if FOON text cannot hold the new name.
    """
    line, letter = checked.text.requested_position(parameters)
    field, new = field_at(checked.text.lines[line], letter), parameter(parameters, "newName", str)
    if not field or not field.name or not is_name(field.kinds[0], new):
        raise RequestError(ErrorCode.INVALID_PARAMETERS, f"found {new!r}, which cannot be a name there")
    return {"changes": {checked.text.uri: _rename_edits(checked, Rename(field.kinds[0], field.name, new))}}


def _rename_edits(checked: CheckedText, rename: Rename) -> list[Json]:
    """Return the edits that apply a renaming to the whole text.

    Renamed lines also get the id that the new name has elsewhere.
    """
    renaming = Renaming(rename)
    renaming.learn_ids(_id_counts(checked.names, NameKind(rename.kind), rename.new))
    return checked.text.edits_to([renaming.line(line) for line in checked.text.lines])


def format_edits(text: EditedText) -> list[Json]:
    """Return the edits that bring the text into canonical form.

    A text with errors gets no edits.
    """
    try:
        return text.edits_to(split_lines(format_of(text.text).canonical_text(text.text, "", lenient=True)))
    except InputError:
        return []


def _quick_fixes(checked: CheckedText, parameters: object) -> list[Json]:
    """Return the actions for the findings on a range of lines: those that fix, then those that silence.

    Only the first 100 findings in the range get actions. A finding with a rename has no other fix. A fix is
    left out if the line is not as it was when it was linted. ``noqa`` findings and findings in JSON cannot be
    silenced.
    """
    text = checked.text
    first, last = (parameter(parameters, f"range.{end}.line", int) for end in ("start", "end"))
    fixes: list[Json] = []
    silenced: dict[tuple[int, str], Json] = {}
    in_range = [(line, finding) for line, finding in checked.findings if first <= line <= last]
    for line, finding in in_range[:_MAX_ITEMS]:
        code, rename = finding.code, finding.rename
        if rename and (edits := _rename_edits(checked, rename)):
            title = f"Write {rename.new!r} for the {rename.kind} {rename.old!r} everywhere in this file"
            fixes.append(_quick_fix(title, text, edits, False))
        elif finding.fix is not None and text.lines[line] == finding.excerpt:
            fix = text.edit(
                text.line_end.join(split_lines(finding.fix)), line
            )  # several lines, if it adds one
            fixes.append(_quick_fix(f"Fix: {finding.message}", text, [fix], not finding.unsafe))
        if not text.is_json and code != "noqa":
            comment = text.edit(silencing_comment(code) + text.line_end, line, 0, 0)
            silenced[line, code] = _quick_fix(f"Silence {code} on this line", text, [comment], False)
    return [*fixes, *silenced.values()]


def _quick_fix(title: str, text: EditedText, edits: list[Json], preferred: bool) -> Json:
    """Return a quick fix of the protocol, which makes these edits of the text.

    ``preferred`` says whether an editor may make it without a choice.
    """
    edit = {"changes": {text.uri: edits}}
    return {"title": title, "kind": "quickfix", "isPreferred": preferred, "edit": edit}


ANSWERS: dict[str, Callable[[CheckedText, object], object]] = {
    "textDocument/hover": _hover,
    "textDocument/definition": _definitions,
    "textDocument/prepareRename": _rename_range,
    "textDocument/rename": _rename_everywhere,
    "textDocument/documentSymbol": _document_symbols,
    "textDocument/foldingRange": _folding_ranges,
    "textDocument/codeAction": _quick_fixes,
}
"""The functions that answer requests about a checked text, by method of the protocol."""
