"""What an editor asks of a FOON text that is edited, and the answers, in the words of the protocol."""

import re
from collections.abc import Callable, Iterable, Iterator
from itertools import islice, takewhile

from lsprotocol import types

from foon_asp.editor.edited_text import EditedText
from foon_asp.editor.name_place import name_at, typed_at
from foon_asp.editor.piece import Name, Piece, Told
from foon_asp.lint.noqa import silencing
from foon_asp.network import NodePattern, counted
from foon_asp.text.diagnostics import Diagnostic, InputError, Rename, Severity
from foon_asp.text.formatter import format_text
from foon_asp.text.json_value import json_line
from foon_asp.text.plain_file import split_lines
from foon_asp.text.renaming import NameKind, Renaming, is_name

_OFFERED = 100  # names: what is typed next leaves fewer
_PART = 500  # findings that are put together before something else may be asked
_SHOWN = 8  # units in what is shown of a node
_LEVELS = {Severity.ERROR: 1, Severity.WARNING: 2, Severity.NOTE: 3}
_COMPLETED = {
    NameKind.OBJECT: types.CompletionItemKind.Variable,
    NameKind.STATE: types.CompletionItemKind.Property,
    NameKind.WORD: types.CompletionItemKind.Keyword,
    NameKind.MOTION: types.CompletionItemKind.Function,
}
_LETTERS = {
    "O": "an object",
    "S": "a state, a relation or contents",
    "M": "a motion",
    "//": "the end of a unit",
}


class Columns:
    """Letters of a line as the editor counts them: UTF-16 units, unless both sides chose something else."""

    def __init__(self, encoding: str) -> None:
        codec, self._size = {
            "utf-8": ("utf-8", 1),
            "utf-32": ("utf-32-le", 4),
        }.get(encoding, ("utf-16-le", 2))
        self._bytes: Callable[[str], bytes] = lambda text: text.encode(codec, "surrogatepass")
        self._text: Callable[[bytes], str] = lambda data: data.decode(codec, "ignore")

    def theirs(self, line: str, letter: int) -> int:
        """Give a place in a line as the editor counts."""
        return letter if line.isascii() else len(self._bytes(line[:letter])) // self._size

    def ours(self, line: str, column: int) -> int:
        """Give a place in a line as Python counts."""
        if line.isascii():
            return min(column, len(line))
        return len(self._text(self._bytes(line)[: column * self._size]))

    def range(self, lines: list[str], line: int, start: int, end: int) -> types.Range:
        """Give the letters of a line."""
        text = lines[line] if line < len(lines) else ""
        return types.Range(
            types.Position(line, self.theirs(text, start)), types.Position(line, self.theirs(text, end))
        )


def diagnostics(edited: EditedText, columns: Columns) -> Iterator[str]:
    """Give all findings in JSON, some at a time, since there may be thousands.

    What a piece says is put together once, and moves with its lines.
    """
    parts: list[str] = []
    for first, piece in zip(edited.starts, edited.pieces, strict=True):
        if piece.told is None:
            piece.told = [_told(edited, columns, first, *each) for each in piece.findings]
        for at, start, end, rest in piece.told:
            line = first + at
            place = (
                f'{{"start":{{"line":{line},"character":{start}}},"end":{{"line":{line},"character":{end}}}}}'
            )
            parts.append(f'{{"range":{place},{rest}')
        if len(parts) >= _PART:
            yield ",".join(parts)
            parts = []
    if parts:
        yield ",".join(parts)


def _told(edited: EditedText, columns: Columns, first: int, at: int, finding: Diagnostic) -> Told:
    text = edited.lines[first + at] if first + at < len(edited.lines) else ""
    start = min(finding.source.column - 1, len(text))
    end = start + len(re.match(r"[^\t\[\]{},]*", text[start:])[0])  # type: ignore[index]
    said = {
        "severity": _LEVELS[finding.severity],
        "code": finding.code,
        "source": "foon-asp",
        "message": finding.message,
    }
    begin, behind = columns.theirs(text, start), columns.theirs(text, max(end, min(start + 1, len(text))))
    return Told(at, begin, behind, json_line(said)[1:])


def completion(edited: EditedText, columns: Columns, line: int, column: int) -> types.CompletionList:
    """Offer names of the kind that stands there, the most frequent first, with the ids that they have."""
    text = edited.lines[line]
    if edited.is_json:
        return types.CompletionList(is_incomplete=False, items=[])
    typed = typed_at(text, column)
    if typed is None:
        return types.CompletionList(is_incomplete=False, items=_heads(edited, columns, line, column))
    wanted = typed.word.casefold()
    found = [
        (not name.name.casefold().startswith(wanted), -count, name)
        for name, count in edited.counts.items()
        if name.kind in typed.kinds
        and wanted in name.name.casefold()
        and (name.name != typed.word or count > 1)  # once, that is what is being typed
    ]
    items = []
    for number, (_, count, name) in enumerate(sorted(found)[:_OFFERED]):
        id_ = _id(edited, name) if typed.is_own else ""
        known = f"{typed.letter}{id_}, " if id_ else ""
        edits = []
        if id_ and not typed.id:
            edits.append(types.TextEdit(columns.range(edited.lines, line, 1, 1), id_))
        bracket = ""
        if name.kind is NameKind.WORD and typed.end == len(text):
            holds = 2 * edited.holding[name.name] > -count  # mostly, where the word is used both ways
            bracket = "\t{" if holds else "\t["
        items.append(
            types.CompletionItem(
                label=name.name,
                kind=_COMPLETED[name.kind],
                detail=f"{name.kind}, {known}{counted(-count, 'time')}",
                sort_text=f"{number:03}",
                text_edit=types.TextEdit(
                    columns.range(edited.lines, line, typed.start, typed.end), name.name + bracket
                ),
                additional_text_edits=edits or None,
            )
        )
    return types.CompletionList(is_incomplete=len(found) > _OFFERED, items=items)


def _id(edited: EditedText, name: Name) -> str:
    """Give the id that a name mostly has."""
    ids = edited.ids[name].most_common(1) if name in edited.ids else []
    return next((id_ for id_, count in ids if count), "")


def _heads(edited: EditedText, columns: Columns, line: int, column: int) -> list[types.CompletionItem]:
    """Offer how a line may begin; behind a letter and digits, the names that have such an id."""
    text = edited.lines[line]
    whole = columns.range(edited.lines, line, 0, len(text))
    if text[column:].strip():
        return []
    if match := re.fullmatch(r"([OSM])(\d+)", text):
        letter, digits = match.groups()
        found = [
            (id_, name)
            for name, ids in edited.ids.items()
            for id_, count in ids.items()
            if count and id_.startswith(digits) and _letter(name.kind) == letter
        ]
        return [
            types.CompletionItem(
                label=f"{letter}{id_} {name.name}",
                filter_text=text,
                kind=_COMPLETED[name.kind],
                text_edit=types.TextEdit(whole, f"{letter}{id_}\t{name.name}"),
            )
            for id_, name in sorted(found)[:_OFFERED]
        ]
    return [
        types.CompletionItem(
            label=head,
            detail=meaning,
            kind=types.CompletionItemKind.Keyword,
            filter_text=text or head,
            text_edit=types.TextEdit(whole, head if head == "//" else f"{head}\t"),
        )
        for head, meaning in _LETTERS.items()
        if head.startswith(text)
    ]


def _letter(kind: NameKind) -> str:
    return {NameKind.OBJECT: "O", NameKind.MOTION: "M"}.get(kind, "S")


def hover(
    edited: EditedText, columns: Columns, line: int, column: int, kitchen: Iterable[NodePattern] | None
) -> types.Hover | None:
    """Say which units make and need the node of a line, and whether it is at hand.

    ``kitchen`` is ``None`` where there is none: then what no unit makes is at hand.
    """
    found = edited.block_at(line)
    if found is None:
        return None
    node = found.block.node
    makers, needers = (list(edited.where(index.get(node, ()))) for index in (edited.makers, edited.needers))
    if kitchen is not None:
        is_there = any(pattern.matches(node) for pattern in kitchen)
        at_hand = "at hand: the kitchen has it" if is_there else "not in the kitchen"
    else:
        at_hand = "not at hand: a unit has to make it" if makers else "at hand: no unit makes it"
    said = [f"**{_plain(str(node))}**", f"made by {_units(makers)}", f"needed by {_units(needers)}", at_hand]
    if (place := name_at(edited.lines[line], column)) and place.name in edited.counts:
        kind, name = place.name
        said.append(f"{kind} '{_plain(name)}': {counted(edited.counts[place.name], 'time')}")
    return types.Hover(types.MarkupContent(types.MarkupKind.Markdown, "\n\n".join(said)))


def _units(places: list[tuple[int, Piece]]) -> str:
    """Name units by their motions and lines."""
    if not places:
        return "no unit"
    shown = [
        f"{_plain(piece.motion[1]) if piece.motion else '?'} (line {start + _first(piece) + 1})"
        for start, piece in places[:_SHOWN]
    ]
    return ", ".join([*shown, *[f"{len(places) - _SHOWN} more"] * (len(places) > _SHOWN)])


def _first(piece: Piece) -> int:
    return piece.blocks[0].start if piece.blocks else 0


def _plain(text: str) -> str:
    """Give a name so that Markdown shows it as it is."""
    return re.sub(r"([\\`*_{}\[\]<>#+\-!|&])", r"\\\1", text)


def makers(edited: EditedText, columns: Columns, uri: str, line: int) -> list[types.Location]:
    """Give the places where the units that make the node of a line state it."""
    found = edited.block_at(line)
    if found is None:
        return []
    places = []
    for start, piece in edited.where(edited.makers.get(found.block.node, ())):
        block = next(b for b in piece.blocks if b.is_output and b.node == found.block.node)
        at = start + block.start
        places.append(types.Location(uri, columns.range(edited.lines, at, 0, len(edited.lines[at]))))
    return places


def symbols(edited: EditedText) -> list[dict[str, object]]:
    """Give the outline: each unit by its motion and what it makes, as plain values for speed."""
    listed = []
    for start, piece in zip(edited.starts, edited.pieces, strict=True):
        if piece.motion is None or not piece.blocks:
            continue
        at, motion = piece.motion
        made = " + ".join(dict.fromkeys(node.label for node in piece.makes))
        end = {"line": start + len(piece.lines) - 1, "character": 0}
        listed.append(
            {
                "name": motion,
                "detail": f"→ {made}" if made else "",
                "kind": types.SymbolKind.Function.value,
                "range": {"start": {"line": start + _first(piece), "character": 0}, "end": end},
                "selectionRange": {
                    "start": {"line": start + at, "character": 0},
                    "end": {"line": start + at, "character": 1},
                },
            }
        )
    return listed


def folds(edited: EditedText) -> list[dict[str, object]]:
    """Give what can be folded: each unit, from its first object line to its last."""
    return [
        {"startLine": start + piece.blocks[0].start, "endLine": start + piece.blocks[-1].end - 1}
        for start, piece in zip(edited.starts, edited.pieces, strict=True)
        if piece.blocks and piece.blocks[0].start < piece.blocks[-1].end - 1
    ]


def renameable(edited: EditedText, columns: Columns, line: int, column: int) -> types.Range | None:
    """Give the name at a place, if there is one."""
    place = None if edited.is_json else name_at(edited.lines[line], column)
    return columns.range(edited.lines, line, place.start, place.end) if place else None


def renamed(
    edited: EditedText, columns: Columns, line: int, column: int, new: str
) -> list[types.TextEdit] | None:
    """Write the name at a place otherwise everywhere in the text; ``None`` if it cannot be called so."""
    place = None if edited.is_json else name_at(edited.lines[line], column)
    if place is None or not is_name(place.name.kind, new):
        return None
    return _with_name(edited, columns, Rename(place.name.kind, place.name.name, new))


def _with_name(edited: EditedText, columns: Columns, rename: Rename) -> list[types.TextEdit]:
    renaming = Renaming(rename, edited.reader)
    renaming.learn_ids(edited.ids.get(Name(NameKind(rename.kind), rename.new), {}))
    edits = []
    for number, text in enumerate(edited.lines):
        if rename.old in text and (new := renaming.line(text)) != text:
            edits.append(types.TextEdit(columns.range(edited.lines, number, 0, len(text)), new))
    return edits


def formatted(edited: EditedText, columns: Columns) -> list[types.TextEdit]:
    """Bring the text into canonical form, in one edit from the first line that changes to the last."""
    try:
        text = format_text(edited.text, "", lenient=True).text
    except InputError:
        return []
    before, after = edited.lines, split_lines(text)
    same = _same(before, after)
    if same == len(before) == len(after):
        return []
    at_end = min(_same(before[::-1], after[::-1]), len(before) - same, len(after) - same)
    first, last = same, len(before) - at_end
    lines = after[same : len(after) - at_end]
    if last < len(before):  # what follows stays on a line of its own
        end, written = types.Position(last, 0), "".join(f"{each}{edited.end}" for each in lines)
    else:
        end = types.Position(last - 1, columns.theirs(before[-1], len(before[-1])))
        written = edited.end.join(lines)
        if first == last:
            start = end
            return [types.TextEdit(types.Range(start, end), edited.end + written)]
    return [types.TextEdit(types.Range(types.Position(first, 0), end), written)]


def _same(one: list[str], other: list[str]) -> int:
    pairs = zip(one, other, strict=False)
    return sum(1 for _ in takewhile(lambda pair: pair[0] == pair[1], pairs))


def quick_fixes(
    edited: EditedText, columns: Columns, uri: str, first: int, last: int
) -> Iterator[types.CodeAction]:
    """Offer what mends the findings on some lines, and to silence them."""
    silenced: dict[tuple[int, str], types.CodeAction] = {}
    for line, finding in islice(edited.findings(first, last), _OFFERED):
        title, edits = _mending(edited, columns, line, finding)
        if edits:
            yield _action(title, uri, edits, is_preferred=not finding.unsafe and finding.rename is None)
        if not edited.is_json and (line, finding.code) not in silenced and finding.code != "noqa":
            place = types.Range(types.Position(line, 0), types.Position(line, 0))
            comment = types.TextEdit(place, f"{silencing(finding.code)}{edited.end}")
            action = _action(f"Silence {finding.code} on this line", uri, [comment], is_preferred=False)
            silenced[line, finding.code] = action
    yield from silenced.values()


def _mending(
    edited: EditedText, columns: Columns, line: int, finding: Diagnostic
) -> tuple[str, list[types.TextEdit]]:
    if finding.rename is not None:
        kind, old, new = finding.rename
        return f"Write {new!r} for the {kind} {old!r} everywhere in this file", _with_name(
            edited, columns, finding.rename
        )
    if finding.fix is None or edited.is_json or edited.lines[line] != finding.excerpt:
        return "", []
    fix = edited.end.join(split_lines(finding.fix))  # which may add a separator
    whole = columns.range(edited.lines, line, 0, len(edited.lines[line]))
    return f"Mend: {finding.message}", [types.TextEdit(whole, fix)]


def _action(title: str, uri: str, edits: list[types.TextEdit], is_preferred: bool) -> types.CodeAction:
    return types.CodeAction(
        title,
        kind=types.CodeActionKind.QuickFix,
        is_preferred=is_preferred,
        edit=types.WorkspaceEdit(changes={uri: edits}),
    )
