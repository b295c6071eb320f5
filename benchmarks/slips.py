"""Slips planted in clean files, and the share of them on which a finding of ``foon-asp lint`` lands.

One slip is planted in a file at a time. It is seen when a finding that was not there before lies in a unit
that the slip touches, or on its line in a table. Files are linted alone, as in an editor; tables beside a
network are linted with their folder. What is planted is written down here, and the rules know nothing of it.
Every file is read twice, as it is and without ids. The seed is fixed.

    python benchmarks/slips.py                        the bundled kitchen, a dish a file
    python benchmarks/slips.py FOLDER ...             recipes, one a file, and folders with a kitchen
    python benchmarks/slips.py FOLDER --missed        and show what was not seen
"""

import argparse
import random
import re
import shutil
import tempfile
import unicodedata
from collections import Counter, defaultdict
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

from foon_asp.linting.linter import lint
from foon_asp.resources import bundled_kitchen
from foon_asp.text.diagnostics import Diagnostic

SEED = 19
OFTEN = 12  # slips of a kind


class Edit(NamedTuple):
    """Lines ``start`` to ``stop`` (from 0, without the last) become others."""

    start: int
    stop: int
    lines: Sequence[str]


class Unit(NamedTuple):
    """The lines of a unit, those of its motion and its blocks; ``end`` is its ``//``."""

    start: int
    end: int
    motion: int
    inputs: list[tuple[int, int]]
    outputs: list[tuple[int, int]]


Draw = random.Random
Slip = Callable[[list[str], list[Unit], Draw], list[Edit] | None]


def units_of(lines: Sequence[str]) -> list[Unit]:
    """Give the complete units of a file."""
    found, start = [], 0
    for end, line in enumerate(lines):
        if not line.startswith("//"):
            continue
        blocks: list[tuple[int, int]] = []
        motion = -1
        for number in range(start, end):
            if lines[number][:1] == "O":
                blocks.append((number, number + 1))
            elif lines[number][:1] == "S" and blocks:
                blocks[-1] = blocks[-1][0], number + 1
            elif lines[number][:1] == "M":
                motion = number
        inputs = [block for block in blocks if block[0] < motion]
        outputs = [block for block in blocks if block[0] > motion]
        if inputs and outputs:
            found.append(Unit(inputs[0][0], end, motion, inputs, outputs))
        start = end + 1
    return found


def _line(pattern: str, change: Callable[[re.Match[str], Draw], str | None]) -> Slip:
    """A slip in one line, drawn among those that match."""

    def slip(lines: list[str], units: list[Unit], draw: Draw) -> list[Edit] | None:
        inside = [n for unit in units for n in range(unit.start, unit.end)]
        draw.shuffle(inside)
        for number in inside:
            if match := re.fullmatch(pattern, lines[number]):
                new = change(match, draw)
                if new is not None and new != lines[number]:
                    return [Edit(number, number + 1, [new])]
        return None

    return slip


def _everywhere(pattern: str, spell: Callable[[str, Draw], str | None]) -> Slip:
    """The same slip wherever a name stands: the group ``name`` of a line."""

    def slip(lines: list[str], units: list[Unit], draw: Draw) -> list[Edit] | None:
        names = sorted({m["name"] for line in lines if (m := re.fullmatch(pattern, line))})
        draw.shuffle(names)
        for name in names:
            new = spell(name, draw)
            if new is None:
                continue
            whole = re.compile(rf"(?<=[\t\[{{,]){re.escape(name)}(?=$|[\t\]}},*])")
            edits = [
                Edit(n, n + 1, [changed])
                for unit in units
                for n in range(unit.start, unit.end)
                if (changed := whole.sub(new, lines[n])) != lines[n]
            ]
            if edits:
                return edits
        return None

    return slip


# Spelling: each gives a word with a slip in it, behind its first letter, or nothing for a short one.

NEXT_KEYS = dict(
    zip(
        "qwertyuiopasdfghjklzxcvbnm",
        "wertyuiopqsdfghjklaxcvbnmz",
        strict=True,
    )
)


def _long_word(name: str, draw: Draw) -> tuple[int, int] | None:
    words = [match.span() for match in re.finditer(r"[a-z]{4,}", name)]
    return draw.choice(words) if words else None


def less(name: str, draw: Draw) -> str | None:
    """Leave out a letter."""
    if not (span := _long_word(name, draw)):
        return None
    at = draw.randrange(span[0] + 1, span[1])
    return name[:at] + name[at + 1 :]


def more(name: str, draw: Draw) -> str | None:
    """Add a letter, often one that is there already."""
    if not (span := _long_word(name, draw)):
        return None
    at = draw.randrange(span[0] + 1, span[1])
    return name[:at] + draw.choice([name[at], NEXT_KEYS[name[at]]]) + name[at:]


def other(name: str, draw: Draw) -> str | None:
    """Hit the key beside."""
    if not (span := _long_word(name, draw)):
        return None
    at = draw.randrange(span[0] + 1, span[1])
    return name[:at] + NEXT_KEYS[name[at]] + name[at + 1 :]


def swapped(name: str, draw: Draw) -> str | None:
    """Let two letters change places."""
    if not (span := _long_word(name, draw)):
        return None
    places = [at for at in range(span[0] + 1, span[1] - 1) if name[at] != name[at + 1]]
    if not places:
        return None
    at = draw.choice(places)
    return name[:at] + name[at + 1] + name[at] + name[at + 2 :]


def misspelt(name: str, draw: Draw) -> str | None:
    """Make one of the four slips."""
    return draw.choice([less, more, other, swapped])(name, draw)


def _at_letter(name: str, draw: Draw, put: Callable[[str], str]) -> str:
    at = draw.randrange(1, len(name))
    return name[:at] + put(name[at]) + name[at + 1 :]


def confusable(name: str, draw: Draw) -> str | None:
    """Put a Cyrillic letter for one that looks like it."""
    alike = dict(zip("aeopcx", "аеорсх", strict=True))
    places = [at for at, letter in enumerate(name) if letter in alike]
    if not places:
        return None
    at = draw.choice(places)
    return name[:at] + alike[name[at]] + name[at + 1 :]


def _spelt(spell: Callable[[str, Draw], str | None]) -> Callable[[re.Match[str], Draw], str | None]:
    def change(match: re.Match[str], draw: Draw) -> str | None:
        new = spell(match["name"], draw)
        return None if new is None else match[1] + new + match[3]

    return change


LABEL = r"(O\d*\t)(?P<name>[^\t]+)(\t.*|)"
STATE = r"(S\d*\t)(?P<name>[^\t]+)()"
MOTION = r"(M\d*\t)(?P<name>[^\t*]+)(.*)"
WORD = r"(S\d*\t)(?P<name>[^\t]+)(\t[\[{].*)"
PLACE = r"(S\d*\t[^\t]+\t\[)(?P<name>[^\]{}]+)(\])"
ITEM = r"(S\d*\t[^\t]+\t\{(?:.*,)?)(?P<name>[^,{}]+)((?:,.*)?\})"
ANY = r"([OSM]\d*\t)(?P<name>[^\t]+)(.*)"
TIMED = r"(M\d*\t[^\t]+\t)(?P<first>\d+:\d\d)\t(?P<last>\d+:\d\d)"


def _swap_sides(lines: list[str], units: list[Unit], draw: Draw) -> list[Edit] | None:
    def side(blocks: list[tuple[int, int]]) -> list[str]:
        return [line for start, stop in blocks for line in lines[start:stop]]

    unit = draw.choice(units)
    if side(unit.inputs) == side(unit.outputs):
        return None
    return [Edit(unit.start, unit.end, [*side(unit.outputs), lines[unit.motion], *side(unit.inputs)])]


def _labels(lines: list[str], blocks: list[tuple[int, int]]) -> list[str]:
    return [lines[start].split("\t")[1] for start, _ in blocks]


def _vanished(lines: list[str], units: list[Unit], draw: Draw) -> list[Edit] | None:
    """Take out what comes out of a unit beside something else: the block with most lines, no bare tool."""
    places = [
        block
        for unit in units
        if len(unit.outputs) > 1
        for block in unit.outputs
        if block[1] - block[0] > 1 and lines[block[0]].split("\t")[1] in _labels(lines, unit.inputs)
    ]
    if not places:
        return None
    start, stop = draw.choice(places)
    return [Edit(start, stop, [])]


def _from_nothing(lines: list[str], units: list[Unit], draw: Draw) -> list[Edit] | None:
    """Let an object of another unit come out of this one."""
    unit, beside = draw.sample(units, 2) if len(units) > 1 else (units[0], units[0])
    known = set(_labels(lines, unit.inputs + unit.outputs))
    blocks = [b for b in beside.outputs if lines[b[0]].split("\t")[1] not in known and b[1] - b[0] in {2, 3}]
    if not blocks:
        return None
    start, stop = draw.choice(blocks)
    return [Edit(unit.end, unit.end, lines[start:stop])]


def _without_line(pattern: str, sides: str) -> Slip:
    """Leave out a line that matches, of the inputs or the outputs."""

    def slip(lines: list[str], units: list[Unit], draw: Draw) -> list[Edit] | None:
        places = [
            n
            for unit in units
            for start, stop in getattr(unit, sides)
            for n in range(start, stop)
            if re.fullmatch(pattern, lines[n])
        ]
        if not places:
            return None
        at = draw.choice(places)
        return [Edit(at, at + 1, [])]

    return slip


def _items(change: Callable[[list[str], list[str], Draw], list[str] | None]) -> Slip:
    """Change what an output contains; the names of objects of the file are at hand."""

    def slip(lines: list[str], units: list[Unit], draw: Draw) -> list[Edit] | None:
        places = [
            n
            for unit in units
            for start, stop in unit.outputs
            for n in range(start, stop)
            if re.fullmatch(ITEM, lines[n])
        ]
        known = sorted({lines[start].split("\t")[1] for unit in units for start, _ in unit.inputs})
        draw.shuffle(places)
        for at in places:
            head, _, listed = lines[at].partition("{")
            items = change(listed.rstrip("}").split(","), known, draw)
            if items is not None:
                return [Edit(at, at + 1, [head + "{" + ",".join(items) + "}"])]
        return None

    return slip


def _gain(items: list[str], known: list[str], draw: Draw) -> list[str] | None:
    new = [name for name in known if name not in items]
    return [*items, draw.choice(new)] if new else None


def _lose(items: list[str], _: list[str], draw: Draw) -> list[str] | None:
    if len(items) < 2:
        return None
    left = draw.choice(items)
    return [item for item in items if item != left]


def _lines_of(pick: str) -> Slip:
    """Drop or repeat a line or a block."""

    def slip(lines: list[str], units: list[Unit], draw: Draw) -> list[Edit] | None:
        unit = draw.choice(units[:-1] or units)
        if pick in {"motion", "separator"}:
            at = unit.motion if pick == "motion" else unit.end
            return [Edit(at, at + 1, [])]
        if pick == "second separator":
            return [Edit(unit.motion, unit.motion, ["//"])]
        if pick == "unit":
            return [Edit(unit.end + 1, unit.end + 1, lines[unit.start : unit.end + 1])]
        blocks = [block for block in unit.inputs + unit.outputs if block[1] - block[0] > 1]
        if not blocks:
            return None
        start, stop = draw.choice(blocks)
        if pick == "block":
            return [Edit(stop, stop, lines[start:stop])]
        at = draw.randrange(start + 1, stop)
        return [Edit(at, at, [lines[at]])]

    return slip


def _step_before(lines: list[str], units: list[Unit], draw: Draw) -> list[Edit] | None:
    """Give a step a time before that of the one whose product it uses."""
    timed = [(unit, match) for unit in units if (match := re.fullmatch(TIMED, lines[unit.motion]))]
    pairs = []
    for number, (unit, match) in enumerate(timed):
        for later, after in timed[number + 1 :]:
            made = {tuple(lines[a:b]) for a, b in unit.outputs} - {tuple(lines[a:b]) for a, b in unit.inputs}
            used = {tuple(lines[a:b]) for a, b in later.inputs}
            late = _seconds(after["first"]) > _seconds(match["last"])
            if late and made & used and _seconds(match["first"]) > 5:
                pairs.append((unit, match, later, after))
    if not pairs:
        return None
    unit, match, later, after = draw.choice(pairs)
    at = draw.randrange(0, _seconds(match["first"]) - 4)
    new = f"{after[1]}{_clock(at)}\t{_clock(at + 2)}"
    return [Edit(later.motion, later.motion + 1, [new])]


def _seconds(clock: str) -> int:
    minutes, seconds = clock.split(":")
    return 60 * int(minutes) + int(seconds)


def _clock(seconds: int) -> str:
    return f"{seconds // 60}:{seconds % 60:02}"


def _time(change: Callable[[str, str, Draw], tuple[str, str] | None]) -> Slip:
    def on(match: re.Match[str], draw: Draw) -> str | None:
        new = change(match["first"], match["last"], draw)
        return None if new is None else match[1] + "\t".join(new)

    return _line(TIMED, on)


def _one_name_for_another(pattern: str) -> Slip:
    """Put another name of the file, of the same kind, for one."""

    def slip(lines: list[str], units: list[Unit], draw: Draw) -> list[Edit] | None:
        found = [
            (n, match)
            for unit in units
            for n in range(unit.start, unit.end)
            if (match := re.fullmatch(pattern, lines[n]))
        ]
        names = sorted({match["name"] for _, match in found})
        if len(names) < 2:
            return None
        number, match = draw.choice(found)
        new = draw.choice([name for name in names if name != match["name"]])
        return [Edit(number, number + 1, [match[1] + new + match[3]])]

    return slip


def _other_id(match: re.Match[str], draw: Draw) -> str | None:
    digits = list(match[2])
    at = draw.randrange(len(digits))
    digits[at] = str((int(digits[at]) + draw.randrange(1, 10)) % 10)
    return match[1] + "".join(digits) + match[3]


def _two_accents(lines: list[str], units: list[Unit], draw: Draw) -> list[Edit] | None:
    """Give a name an accent everywhere, and write it in another form on one line."""
    edits = _everywhere(LABEL, lambda name, d: name[:-1] + "é" if name[-1] == "e" else None)(
        lines, units, draw
    )
    if not edits or len(edits) < 2:
        return None
    at = draw.randrange(len(edits))
    edit = edits[at]
    edits[at] = Edit(edit.start, edit.stop, [unicodedata.normalize("NFD", line) for line in edit.lines])
    return edits


def _bracket(pattern: str, new: str) -> Slip:
    return _line(pattern, lambda match, _: match.expand(new))


KINDS: dict[str, Slip] = {
    # names
    "label, letter left out": _line(LABEL, _spelt(less)),
    "label, letter too many": _line(LABEL, _spelt(more)),
    "label, key beside": _line(LABEL, _spelt(other)),
    "label, letters swapped": _line(LABEL, _spelt(swapped)),
    "label, everywhere": _everywhere(LABEL, misspelt),
    "state": _line(STATE, _spelt(misspelt)),
    "state, everywhere": _everywhere(STATE, misspelt),
    "motion": _line(MOTION, _spelt(misspelt)),
    "relation word": _line(WORD, _spelt(misspelt)),
    "container": _line(PLACE, _spelt(misspelt)),
    "ingredient": _line(ITEM, _spelt(misspelt)),
    "capital": _line(ANY, _spelt(lambda name, _: name.capitalize())),
    "another state": _one_name_for_another(STATE),
    "another container": _one_name_for_another(PLACE),
    "another label": _one_name_for_another(LABEL),
    # brackets
    "place in braces": _bracket(r"(S\d*\t(?!contains)[^\t]+\t)\[([^\]]*)\]", r"\1{\2}"),
    "contents in brackets": _bracket(r"(S\d*\tcontains\t)\{([^,}]*)\}", r"\1[\2]"),
    "place in two kinds": _bracket(r"(S\d*\t[^\t]+\t)\[([^\]]*)\]", r"\1{\2]"),
    "contents in two kinds": _bracket(r"(S\d*\t[^\t]+\t)\{([^}]*)\}", r"\1{\2]"),
    "place without brackets": _bracket(r"(S\d*\t[^\t]+)\t\[([^\]]*)\]", r"\1 \2"),
    "place behind a bare tab": _bracket(r"(S\d*\t[^\t]+\t)\[([^\]]*)\]", r"\1\2"),
    "contents without brackets": _bracket(r"(S\d*\t[^\t]+)\t\{([^}]*)\}", r"\1 \2"),
    "bracket left open": _bracket(r"(S\d*\t[^\t]+\t[\[{][^\]}]*)[\]}]", r"\1"),
    "semicolon in contents": _bracket(r"(S\d*\t[^\t]+\t\{[^,}]*),(.*)", r"\1;\2"),
    "point in contents": _bracket(r"(S\d*\t[^\t]+\t\{[^,}]*),(.*)", r"\1.\2"),
    "comma twice": _bracket(r"(S\d*\t[^\t]+\t\{[^,}]*),(.*)", r"\1,,\2"),
    "space for the tab before a bracket": _bracket(r"(S\d*\t[^\t]+)\t([\[{].*)", r"\1 \2"),
    # lines
    "space for the tab behind the letter": _bracket(r"([OSM]\d*)\t(.*)", r"\1 \2"),
    "space at the end": _bracket(r"([OSM]\d*\t.*)", r"\1 "),
    "small letter": _line(r"([OSM])(\d*\t.*)", lambda match, _: match[1].lower() + match[2]),
    "object line as a state": _bracket(r"O(\d*\t[^\t]+)(\t.*|)", r"S\1"),
    "state line as an object": _bracket(r"S(\d*\t[^\t]+)", r"O\1"),
    "flag behind a space": _bracket(r"(O\d*\t[^\t]+)\t([01])", r"\1 \2"),
    "flag of another kind": _line(r"(O\d*\t[^\t]+\t)[01]", lambda match, d: match[1] + d.choice("23ol")),
    "flag left out": _bracket(r"(O\d*\t[^\t]+)\t[01]", r"\1"),
    "motion line left out": _lines_of("motion"),
    "separator left out": _lines_of("separator"),
    "separator too many": _lines_of("second separator"),
    "state line twice": _lines_of("state"),
    # times
    "end before start": _time(lambda a, b, _: (b, a) if a != b else None),
    "before its product": _step_before,
    "minutes, seconds and a fraction": _time(lambda a, b, d: (a, f"{b}:{d.randrange(10, 60)}")),
    "hours": _time(lambda a, b, _: (f"{a}:00", f"{b}:00")),
    "hours in minutes": _time(lambda a, b, _: (a, f"7{b}" if len(b) == 4 else f"4{b[1:]}")),
    "point for colon": _time(lambda a, b, _: (a, b.replace(":", "."))),
    "a letter in a time": _time(lambda a, b, d: (a.replace(":", ":" + d.choice("os")), b)),
    "more than 59 seconds": _time(lambda a, b, d: (a, f"{b.split(':')[0]}:{d.randrange(60, 99)}")),
    # units
    "sides swapped": _swap_sides,
    "an output left out": _vanished,
    "an output from nothing": _from_nothing,
    "state left out of an output": _without_line(STATE, "outputs"),
    "state left out of an input": _without_line(STATE, "inputs"),
    "place left out of an output": _without_line(PLACE, "outputs"),
    "contents lose one": _items(_lose),
    "contents gain one": _items(_gain),
    "unit twice": _lines_of("unit"),
    "object twice": _lines_of("block"),
    # letters
    "invisible letter": _line(ANY, _spelt(lambda n, d: _at_letter(n, d, lambda c: "\u200b" + c))),
    "hard space": _line(ANY, _spelt(lambda n, _: n.replace(" ", "\xa0", 1) if " " in n else None)),
    "letter that looks alike": _line(ANY, _spelt(confusable)),
    "two forms of an accent": _two_accents,
    "control character": _line(ANY, _spelt(lambda n, d: _at_letter(n, d, lambda c: "\x08" + c))),
}
WITH_IDS: dict[str, Slip] = {
    "digit of an id": _line(r"([OSM])(\d+)(\t.*)", _other_id),
    "id left out": _bracket(r"([OSM])\d+(\t.*)", r"\1\2"),
}


def _row(name: str, change: Callable[[str, str, Draw], str | None]) -> tuple[str, Slip]:
    """A slip in a row of a table: the name, what stands behind the tab, and what becomes of them."""

    def slip(lines: list[str], _: list[Unit], draw: Draw) -> list[Edit] | None:
        places = [n for n, line in enumerate(lines) if line.strip() and line[0] != "#"]
        draw.shuffle(places)
        for at in places:
            first, second = (*lines[at].split("\t", 1), "")[:2]
            new = change(first, second, draw)
            if new is not None and new != lines[at]:
                return [Edit(at, at + 1, [new])]
        return None

    return name, slip


def _quoted(name: str) -> tuple[str, Slip]:
    def slip(lines: list[str], _: list[Unit], draw: Draw) -> list[Edit] | None:
        places = [n for n, line in enumerate(lines) if re.search(r'"[a-z][a-z ]{3,}"(?!:)', line)]
        draw.shuffle(places)
        for at in places:
            quoted = list(re.finditer(r'"([a-z][a-z ]{3,})"(?!:)', lines[at]))
            match = draw.choice(quoted)
            new = misspelt(match[1], draw)
            if new is not None and new != match[1]:
                line = lines[at][: match.start(1)] + new + lines[at][match.end(1) :]
                return [Edit(at, at + 1, [line])]
        return None

    return name, slip


def _misspelt_row(first: str, second: str, draw: Draw) -> str | None:
    new = misspelt(first, draw)
    return None if new is None else f"{new}\t{second}" if second else new


def _percent(first: str, second: str, _: Draw) -> str | None:
    return f"{first}\t{round(100 * float(second))}%"


TABLES: dict[str, tuple[str, Slip]] = {
    "rate in percent": _row("motion.txt", _percent),
    "rate above 1": _row("motion.txt", lambda a, b, d: f"{a}\t1.{d.randrange(1, 9)}"),
    "rate with a comma": _row("motion.txt", lambda a, b, _: f"{a}\t{b.replace('.', ',')}"),
    "rate behind a space": _row("motion.txt", lambda a, b, _: f"{a} {b}"),
    "rate of a misspelt motion": _row("motion.txt", _misspelt_row),
    "rate of a motion that is not there": _row("motion.txt", lambda a, b, _: f"juggle\t{b}"),
    "utensil misspelt": _row("utensils.txt", _misspelt_row),
    "utensil cut short": _row("utensils.txt", lambda a, b, _: a[:-1] if len(a) > 5 else None),
    "kitchen item misspelt": _quoted("kitchen.json"),
    "goal misspelt": _quoted("goal_nodes.json"),
}


def planted(lines: list[str], edits: Sequence[Edit]) -> tuple[list[str], dict[int, int], list[int]]:
    """Give the lines with edits, for each new line the old one, and the new lines that edits touch."""
    new: list[str] = []
    old: dict[int, int] = {}
    touched = []
    at = 0
    for edit in sorted(edits):
        for number in range(at, edit.start):
            old[len(new)] = number
            new.append(lines[number])
        for offset, line in enumerate(edit.lines):
            if edit.start + offset < edit.stop:
                old[len(new)] = edit.start + offset
            touched.append(len(new))
            new.append(line)
        if not edit.lines:
            touched += [len(new) - 1, len(new)]
        at = edit.stop
    for number in range(at, len(lines)):
        old[len(new)] = number
        new.append(lines[number])
    return new, old, touched


def around(lines: Sequence[str], touched: Sequence[int], whole: bool) -> set[int]:
    """Give the lines of the units in which lines were touched; of tables these alone."""
    found = set(touched)
    if whole:
        for at in touched:
            first = last = min(at, len(lines) - 1)
            while first > 0 and not lines[first - 1].startswith("//"):
                first -= 1
            while last < len(lines) - 1 and not lines[last].startswith("//"):
                last += 1
            found.update(range(first, last + 1))
    return found


class Case(NamedTuple):
    """One slip, and whether it is seen."""

    kind: str
    file: str
    seen: bool
    edits: Sequence[Edit]
    codes: Sequence[str]


class Bench:
    """Plants slips in the files of one folder; findings without a slip are asked for once."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.known: dict[tuple[str, str], Counter[tuple[str, int]]] = {}

    def findings(self, files: Sequence[Path], of: Path) -> list[Diagnostic]:
        """Lint files, and give what is said of one."""
        return [finding for finding in lint(files) if finding.source.file == str(of)]

    def seen(self, file: Path, lines: list[str], edits: Sequence[Edit], files: Sequence[Path]) -> list[str]:
        """Plant a slip in a file and give the codes of what is newly said of it."""
        text = "\n".join(lines)
        if (file.name, text) not in self.known:
            file.write_text(text, encoding="utf-8")
            self.known[file.name, text] = Counter(
                (finding.code, finding.source.line - 1) for finding in self.findings(files, file)
            )
        new, old, touched = planted(lines, edits)
        file.write_text("\n".join(new), encoding="utf-8")
        before = self.known[file.name, text]
        inside = around(new, touched, whole=file.suffix == ".txt" and any(x[:1] == "M" for x in lines))
        after = Counter((finding.code, finding.source.line - 1) for finding in self.findings(files, file))
        file.write_text(text, encoding="utf-8")
        return [
            code
            for (code, at), count in after.items()
            if at in inside and count > (before[code, old[at]] if at in old else 0)
        ]


def recipes(paths: Sequence[Path]) -> Iterator[tuple[str, list[str]]]:
    """Give the recipes of folders, and of a universal FOON its dishes, each as lines."""
    for path in paths:
        for file in sorted(path.glob("*.txt") if path.is_dir() else [path]):
            lines = file.read_text(encoding="utf-8-sig").splitlines()
            dishes = [n for n, line in enumerate(lines) if line.startswith("# Recipe:")]
            for start, end in zip(dishes, [*dishes[1:], len(lines)], strict=False):
                yield lines[start], lines[start:end]
            if not dishes and 3 <= len(units_of(lines)) < 1_000:
                yield file.name, lines


def measure(
    texts: Sequence[tuple[str, list[str]]], kinds: dict[str, Slip], often: int, folder: Path
) -> Iterator[Case]:
    """Plant slips of each kind in recipes, each linted alone."""
    bench = Bench(folder)
    for kind, slip in kinds.items():
        draw = random.Random(f"{SEED} {kind}")
        done = 0
        for name, lines in draw.sample(texts, len(texts)) * 3:
            if done == often:
                break
            edits = slip(lines, units_of(lines), draw)
            if edits is not None:
                done += 1
                # the same name for all, so that no name of a file is known
                codes = bench.seen(folder / "recipe.txt", lines, edits, [folder / "recipe.txt"])
                yield Case(kind, name, bool(codes), edits, codes)


def measure_tables(source: Path, often: int, folder: Path) -> Iterator[Case]:
    """Plant slips in the tables beside a network; the whole folder is linted."""
    for file in source.iterdir():
        if file.suffix in {".txt", ".json"}:
            shutil.copy(file, folder / file.name)
    bench = Bench(folder)
    for kind, (table, slip) in TABLES.items():
        draw = random.Random(f"{SEED} {kind}")
        lines = (source / table).read_text(encoding="utf-8").splitlines()
        for _ in range(often):
            edits = slip(lines, [], draw)
            if edits is not None:
                codes = bench.seen(folder / table, lines, edits, linted(folder))
                yield Case(kind, table, bool(codes), edits, codes)


def linted(folder: Path) -> list[Path]:
    """Give the files that are linted when a folder is named."""
    from foon_asp.linting.linted_files import with_tables  # noqa: PLC0415
    from foon_asp.text.folder_files import foon_files  # noqa: PLC0415

    return with_tables([folder], (file for file, _ in foon_files([folder])))


def without_ids(lines: Sequence[str]) -> list[str]:
    """Give the lines of a file without ids."""
    return [re.sub(r"^([OSM])\d+\t", r"\1\t", line) for line in lines]


def _told(title: str, cases: Sequence[Case], missed: bool) -> None:
    by_kind: dict[str, list[Case]] = defaultdict(list)
    for case in cases:
        by_kind[case.kind].append(case)
    for kind, found in by_kind.items():
        print(f"{sum(case.seen for case in found):5} of {len(found):3}  {kind}")
        for case in found if missed else ():
            if not case.seen:
                shown = "; ".join(
                    f"{e.start + 1}-{e.stop}: " + " | ".join(e.lines).replace("\t", "→") for e in case.edits
                )
                print(f"               {case.file[:30]} {shown[:110]}")
    share = sum(case.seen for case in cases) / len(cases)
    print(f"{title}: {sum(case.seen for case in cases)} of {len(cases)} slips seen, {share:.1%}\n")


def main() -> None:
    """Plant and tell."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0] if __doc__ else None)
    parser.add_argument("paths", nargs="*", type=Path, default=[bundled_kitchen() / "FOON.txt"])
    parser.add_argument("--tables", type=Path, default=bundled_kitchen(), help="a folder with a kitchen")
    parser.add_argument("--often", type=int, default=OFTEN, help="slips of each kind")
    parser.add_argument("--missed", action="store_true", help="show what was not seen")
    asked = parser.parse_args()
    texts = list(recipes(asked.paths))
    bare = [(name, without_ids(lines)) for name, lines in texts]
    with tempfile.TemporaryDirectory() as folder:
        if bare != texts:
            cases = list(measure(texts, KINDS | WITH_IDS, asked.often, Path(folder)))
            _told("with ids", cases, asked.missed)
        _told("without ids", list(measure(bare, KINDS, asked.often, Path(folder))), asked.missed)
    with tempfile.TemporaryDirectory() as folder:
        _told("tables", list(measure_tables(asked.tables, asked.often, Path(folder))), asked.missed)


if __name__ == "__main__":
    main()
