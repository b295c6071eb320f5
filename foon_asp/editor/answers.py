"""Answers to what an editor asks about a FOON text, as plain values of the protocol."""

import contextlib
import re
from collections import Counter
from collections.abc import Callable, Iterable, Iterator

from foon_asp.editor.checked_text import CheckedText
from foon_asp.editor.edited_text import EditedText
from foon_asp.editor.field import KINDS, Field, field_at
from foon_asp.editor.json_rpc import INVALID_PARAMETERS, RequestError, parameter
from foon_asp.errors import UserError
from foon_asp.linting.names import Names
from foon_asp.linting.noqa import silencing
from foon_asp.linting.sheet import Sheet
from foon_asp.network import Contents, ObjectNode, counted
from foon_asp.text.data_folder import kitchen_file
from foon_asp.text.diagnostics import InputError, Rename, Severity
from foon_asp.text.formats import format_of
from foon_asp.text.json_value import Json
from foon_asp.text.line import Line, NameKind, StateLine, line_names
from foon_asp.text.object_list import read_object_list
from foon_asp.text.plain_file import split_lines
from foon_asp.text.renaming import Renaming, is_name

_OFFERED = 100  # names: what is typed next leaves fewer
_SHOWN = 8  # units in what is shown of a node
_LEVELS = {Severity.ERROR: 1, Severity.WARNING: 2, Severity.NOTE: 3}
_FUNCTION, _KEYWORD = 12, 14  # kinds of symbols and of completion items
_COMPLETED = {NameKind.OBJECT: 6, NameKind.STATE: 10, NameKind.WORD: _KEYWORD, NameKind.MOTION: 3}
_Place = tuple[int, str]  # of a unit: its first line, and its motion
_HEADS = {
    "O\t": "an object",
    "S\t": "a state, a relation or contents",
    "M\t": "a motion",
    "//": "the end of a unit",
}


def diagnostics(checked: CheckedText) -> list[Json]:
    """Return all findings."""
    found = []
    for line, finding in checked.findings:
        start = max(0, finding.source.column - 1)
        rest = re.split(r"[\t\[\]{},]", checked.text.lines[line][start + 1 :])[0]
        found.append(
            {
                "range": checked.text.range(line, start, start + 1 + len(rest)),
                "severity": _LEVELS[finding.severity],
                "code": finding.code,
                "source": "foon-asp",
                "message": finding.message,
            }
        )
    return found


def completion(text: EditedText, names: Names, parameters: object) -> Json:
    """Offer names of the kind that may stand at a place, the most frequent first, with their ids."""
    line, at = text.place(parameters)
    written = text.lines[line]
    field = field_at(written, at)
    if field is None:
        return {"isIncomplete": False, "items": _heads(text, line, at, names)}
    typed = written[field.start : at]
    wanted = typed.casefold()
    found = [
        (not name.casefold().startswith(wanted), -count, kind, name)
        for kind in field.kinds
        for name, count in names.counts[kind].items()
        if wanted in name.casefold() and (name != typed or count > 1)  # once, that is what is being typed
    ]
    items = [
        _item(text, line, field, names, kind, name) | {"sortText": f"{number:03}"}
        for number, (_, _, kind, name) in enumerate(sorted(found)[:_OFFERED])
    ]
    return {"isIncomplete": len(found) > _OFFERED, "items": items}


def _item(text: EditedText, line: int, field: Field, names: Names, kind: NameKind, name: str) -> Json:
    """Offer a name, with its id where the line has none."""
    count, mentions = names.counts[kind][name], names.mentions[kind][name]
    ids = _ids(names, kind, name)
    id_ = "" if field.id is None else max(ids, key=ids.__getitem__, default="")
    bracket = ""
    if kind is NameKind.WORD and field.end == len(text.lines[line]):
        holding = sum(mention.often for mention in mentions if _holds(mention.line))
        bracket = "\t{" if 2 * holding > count else "\t["
    item: Json = {
        "label": name,
        "kind": _COMPLETED[kind],
        "detail": f"{kind}, {f'{field.letter}{id_}, ' if id_ else ''}{counted(count, 'time')}",
        "textEdit": text.edit(name + bracket, line, field.start, field.end),
    }
    if id_ and not field.id:
        item["additionalTextEdits"] = [text.edit(id_, line, 1, 1)]
    return item


def _holds(line: Line) -> bool:
    return isinstance(line, StateLine) and isinstance(line.attribute, Contents)


def _ids(names: Names, kind: NameKind, name: str) -> Counter[str]:
    """Count the ids of a name."""
    ids: Counter[str] = Counter()
    for mention in names.mentions[kind].get(name, ()):
        if mention.line.id and next(line_names(mention.line))[:2] == (kind, name):
            ids[mention.line.id] += mention.often
    return ids


def _heads(text: EditedText, line: int, at: int, names: Names) -> list[Json]:
    """Offer how a line may begin; behind a letter and digits, the names that have such an id."""
    written = text.lines[line]
    if text.is_json or written[at:].strip():
        return []
    if match := re.fullmatch(r"([OSM])(\d+)", written):
        letter, digits = match.groups()
        found = sorted(
            (id_, name, kind)
            for kind in KINDS[letter]
            for name in names.counts[kind]
            for id_ in _ids(names, kind, name)
            if id_.startswith(digits)
        )
        offered = [
            (f"{letter}{id_} {name}", f"{letter}{id_}\t{name}", _COMPLETED[kind], str(kind))
            for id_, name, kind in found[:_OFFERED]
        ]
    else:
        offered = [
            (head.rstrip(), head, _KEYWORD, meaning)
            for head, meaning in _HEADS.items()
            if head.startswith(written)
        ]
    return [
        {
            "label": label,
            "filterText": written or label,
            "kind": kind_number,
            "detail": detail,
            "textEdit": text.edit(new, line),
        }
        for label, new, kind_number, detail in offered
    ]


def _hover(checked: CheckedText, parameters: object) -> Json | None:
    """Say which units make and need the node of a line, and whether it is available.

    Without a kitchen beside the file, a node that no unit makes is available.
    """
    text = checked.text
    line, at = text.place(parameters)
    node = _node_at(checked, line)
    if node is None:
        return None
    makers, needers = _makers_and_needers(checked, node)
    at_hand = "not at hand: a unit has to make it" if makers else "at hand: no unit makes it"
    with contextlib.suppress(OSError, UserError):
        if file := kitchen_file(text.file.parent):
            is_there = any(entry.pattern.matches(node) for entry in read_object_list(file))
            at_hand = "at hand: the kitchen has it" if is_there else "not in the kitchen"
    said = [f"**{_plain(str(node))}**", f"made by {_units(makers)}", f"needed by {_units(needers)}", at_hand]
    field = field_at(text.lines[line], at)
    if field and (count := checked.names.counts[field.kinds[0]].get(field.name)):
        said.append(f"{field.kinds[0]} '{_plain(field.name)}': {counted(count, 'time')}")
    return {"contents": {"kind": "markdown", "value": "\n\n".join(said)}}


def _node_at(checked: CheckedText, line: int) -> ObjectNode | None:
    """Return the object node that a line belongs to."""
    lines = checked.text.lines
    while line > 0 and lines[line][:1] in {"S", "#", ""}:
        line -= 1
    blocks = Sheet("", lines, checked.names.files.reader).blocks(line)
    return next((node for start, node in blocks if start == line), None)


def _makers_and_needers(checked: CheckedText, node: ObjectNode) -> tuple[list[_Place], list[_Place]]:
    """Return the units that make a node and do not need it, and those that need it."""
    network, copies = checked.names.network, checked.names.files.copies

    def places(units: Iterable[int]) -> list[_Place]:
        return sorted((copy.at, network.motions[unit]) for unit in units for copy in copies[unit])

    id_ = network.object_id(node)
    if id_ is None:
        return [], []
    makers = (unit for unit in network.producers[id_] if id_ not in network.inputs[unit])
    return places(makers), places(network.consumers[id_])


def _units(places: list[_Place]) -> str:
    """Name units by their motions and lines."""
    shown = [f"{_plain(motion)} (line {line + 1})" for line, motion in places[:_SHOWN]]
    return ", ".join([*shown, *[f"{len(places) - _SHOWN} more"] * (len(places) > _SHOWN)]) or "no unit"


def _plain(text: str) -> str:
    """Write a name so that Markdown shows it as it is."""
    return re.sub(r"([\\`*_{}\[\]<>#+\-!|&])", r"\\\1", text)


def _makers(checked: CheckedText, parameters: object) -> list[Json]:
    """Return the places where the units that make the node of a line state it."""
    text = checked.text
    node = _node_at(checked, text.place(parameters)[0])
    if node is None:
        return []
    sheet = Sheet("", text.lines, checked.names.files.reader)
    lines = (
        next((index for index, listed in sheet.blocks(first) if listed == node), first)
        for first, _ in _makers_and_needers(checked, node)[0]
    )
    return [{"uri": text.uri, "range": text.range(line)} for line in lines]


def _extents(checked: CheckedText) -> Iterator[tuple[int, int, int, int]]:
    """Return the first line of each unit, that of its motion, that of its end, and its number, in order."""
    lines, files = checked.text.lines, checked.names.files
    copies = sorted((copy.at, unit) for unit, listed in enumerate(files.copies) for copy in listed)
    for first, unit in copies if not checked.text.is_json else ():
        behind = range(first, len(lines))
        end = next((number for number in behind if lines[number][:2] == "//"), behind[-1])
        motion = next((number for number in behind if lines[number][:1] == "M"), first)
        yield first, motion, end, unit


def _symbols(checked: CheckedText, _: object) -> list[Json]:
    """Return the outline: each unit by its motion and what it makes."""
    network, position = checked.names.network, checked.text.position
    found = []
    for first, motion, end, unit in _extents(checked):
        made = (node for node in network.outputs[unit] if node not in network.inputs[unit])
        labels = " + ".join(dict.fromkeys(network.objects[node].label for node in made))
        found.append(
            {
                "name": network.motions[unit],
                "detail": f"→ {labels}",
                "kind": _FUNCTION,
                "range": {"start": position(first), "end": position(end)},
                "selectionRange": checked.text.range(motion, 0, 1),
            }
        )
    return found


def _folds(checked: CheckedText, _: object) -> list[Json]:
    """Return what can be folded: each unit, up to its separator."""
    return [{"startLine": first, "endLine": end - 1} for first, _, end, _ in _extents(checked)]


def _renameable(checked: CheckedText, parameters: object) -> Json | None:
    """Return the range of the name at a place, if there is one."""
    line, at = checked.text.place(parameters)
    field = field_at(checked.text.lines[line], at)
    return checked.text.range(line, field.start, field.end) if field and field.name else None


def _rename(checked: CheckedText, parameters: object) -> Json:
    """Rename the name at a place everywhere in the text."""
    line, at = checked.text.place(parameters)
    field, new = field_at(checked.text.lines[line], at), parameter(parameters, "newName", str)
    if not field or not field.name or not is_name(field.kinds[0], new):
        raise RequestError(INVALID_PARAMETERS, f"found {new!r}, which cannot be a name there")
    return {"changes": {checked.text.uri: _renamed(checked, Rename(field.kinds[0], field.name, new))}}


def _renamed(checked: CheckedText, rename: Rename) -> list[Json]:
    renaming = Renaming(rename)
    renaming.learn_ids(_ids(checked.names, NameKind(rename.kind), rename.new))
    return checked.text.edits([renaming.line(line) for line in checked.text.lines])


def formatted(text: EditedText) -> list[Json]:
    """Bring the text into canonical form."""
    try:
        return text.edits(split_lines(format_of(text.text).normalised(text.text, "", lenient=True)))
    except InputError:
        return []


def _quick_fixes(checked: CheckedText, parameters: object) -> list[Json]:
    """Offer what mends the findings on some lines, and to silence them."""
    text = checked.text
    first, last = (parameter(parameters, f"range.{side}.line", int) for side in ("start", "end"))
    mending: list[Json] = []
    silenced: dict[tuple[int, str], Json] = {}
    here = [each for each in checked.findings if first <= each[0] <= last]
    for line, finding in here[:_OFFERED]:
        code, rename = finding.code, finding.rename
        if rename and (edits := _renamed(checked, rename)):
            title = f"Write {rename.new!r} for the {rename.kind} {rename.old!r} everywhere in this file"
            mending.append(_action(title, text, edits, False))
        elif finding.fix is not None and text.lines[line] == finding.excerpt:
            fix = text.edit(text.end.join(split_lines(finding.fix)), line)  # which may add a separator
            mending.append(_action(f"Mend: {finding.message}", text, [fix], not finding.unsafe))
        if not text.is_json and code != "noqa":
            comment = text.edit(silencing(code) + text.end, line, 0, 0)
            silenced[line, code] = _action(f"Silence {code} on this line", text, [comment], False)
    return [*mending, *silenced.values()]


def _action(title: str, text: EditedText, edits: list[Json], preferred: bool) -> Json:
    edit = {"changes": {text.uri: edits}}
    return {"title": title, "kind": "quickfix", "isPreferred": preferred, "edit": edit}


ANSWERS: dict[str, Callable[[CheckedText, object], object]] = {
    "textDocument/hover": _hover,
    "textDocument/definition": _makers,
    "textDocument/prepareRename": _renameable,
    "textDocument/rename": _rename,
    "textDocument/documentSymbol": _symbols,
    "textDocument/foldingRange": _folds,
    "textDocument/codeAction": _quick_fixes,
}
"""What is asked of a text that was read, by method."""
