"""docs/json.md: the keys of every document, from its schema, with an example that is run.

Part of a page by hand is only what no field says: what is common to all documents, and the commands.
"""

import contextlib
import re
import shlex
import tempfile
from collections import Counter
from collections.abc import Collection, Iterator, Mapping
from pathlib import Path
from typing import NamedTuple

from foon_asp.json_layout import Json, json_line, read_json
from foon_asp.results.schema_file import schema, schema_kinds
from tests.conftest import ROOT
from tests.golden.transcript import run_here

PAGE = ROOT / "docs" / "json.md"
_BEGINS = Path(__file__).with_suffix(".md")
_HEAD = ("schema", "goals", "containers", "items", "level", "objectives", "starting_kitchen")
_UNREAD = tuple(f'"{key}":' for key in (*_HEAD[1:], "seconds", "seconds_median", "seconds_worst"))
_REFERENCE = re.compile(r'"#/\$defs/([\w-]+)"')


class Section(NamedTuple):
    """The section of some kinds of documents.

    ``note`` is what no field says. ``files`` are written before the ``commands`` are run, of which the last
    prints the document; lines that stand further in than ``depth`` are left out of it.
    """

    heading: str
    kinds: tuple[str, ...]
    commands: tuple[str, ...] = ()
    note: str = ""
    files: Mapping[str, str] = {}
    depth: int = 6


_UNIT = "O→ice\nM→crush\nO→ice\nS→{}\n//\n"
_DOMAIN = """\
(define (domain post)
  (:predicates (at ?x) (road ?x ?y))
  (:action go :parameters (?x ?y)
    :precondition (and (at ?x) (road ?x ?y))
    :effect (and (at ?y) (not (at ?x)))))
"""
_PROBLEM = """\
(define (problem there-and-back)
  (:domain post)
  (:objects home office)
  (:init (at home) (road home office) (road office home))
  (:goal (and (at office) (at home))))
"""
_ANSWER = "solve --goal ice --format json > answer.json"
SECTIONS = (
    Section("solve", ("answer",), ("solve --goal ice --format json",), depth=12),
    Section(
        "solve --all-goals", ("optima",), ("solve --all-goals --goal ice --objective success --format json",)
    ),
    Section("solve --format steps", ("steps",), ("solve --goal ice --format steps",), depth=10),
    Section("alternatives", ("alternatives",), ("alternatives --goal ice --best 2 --format json",)),
    Section(
        "alternatives --union",
        ("unit-union",),
        ("alternatives --goal ice --union --within 50 --format json",),
        depth=8,
    ),
    Section("pareto", ("pareto",), ("pareto --goal ice --format json",)),
    Section("regret", ("regret",), ("regret --goal ice --format json",), depth=8),
    Section("sensitivity", ("sensitivity",), ("sensitivity --goal ice --format json",), depth=8),
    Section("assist", ("assist",), ("assist --goal ice --reach 0.9 --format json",)),
    Section("why-not", ("why-not",), ("why-not --goal 'apple pie' --format json",)),
    Section(
        "shopping-list", ("shopping-list",), ("shopping-list --goal 'apple pie' --format json",), depth=8
    ),
    Section(
        "compare",
        ("compare", "search"),
        ("compare --goal ice --search ids --format json",),
        "A document of a search is that of `foon_asp.search`, and of a page.",
        depth=10,
    ),
    Section("check", ("check",), (_ANSWER, "check answer.json --format json")),
    Section(
        "diff",
        ("diff",),
        (
            _ANSWER,
            "solve --goal ice --objective success --format json > success.json",
            "diff answer.json success.json --format json",
        ),
    ),
    Section(
        "diff of networks: diff-network",
        ("diff-network",),
        ("diff mine.txt yours.txt --format json",),
        files={"mine.txt": _UNIT.format("crushed"), "yours.txt": _UNIT.format("broken")},
        depth=8,
    ),
    Section(
        "verify",
        ("verify", "refused"),
        ("solve --goal ice --certificate proof.json", "verify proof.json --format json"),
        "A certificate has a form and version of its own ([proofs.md](proofs.md)); `verify` says what "
        "one proves.",
    ),
    Section(
        "trace",
        ("trace",),
        (
            "solve --goal ice --items used-up --format foon > plan.txt",
            "trace plan.txt --goal ice --items used-up --format json",
        ),
    ),
    Section(
        "trace --state",
        ("state",),
        ("trace --state state.txt --goal ice --format json",),
        files={"state.txt": "O→ice\nS→cubed\nS→in→[drinking glass]\n"},
        depth=8,
    ),
    Section("schedule", ("schedule", "durations"), note="[plans.md](plans.md#schedules) has an example."),
    Section(
        "view",
        ("view",),
        ("view --goal ice --beside proof --format json",),
        "Documents of other questions are as these give them, `null` where the page has none "
        "([view.md](view.md)).",
    ),
    Section("export", ("export", "pddl-map"), ("export --goal ice --format json",)),
    Section("read-plan", ("read-plan",)),
    Section(
        "relax",
        ("relax",),
        ("relax domain.pddl problem.pddl --format json",),
        "It is about a planning task and not about a FOON, so it has no head.",
        {"domain.pddl": _DOMAIN, "problem.pddl": _PROBLEM},
    ),
    Section("facts", ("facts",), ("facts --goal ice --format json",)),
    Section("constraints", ("constraints",), ("constraints --format json",)),
    Section(
        "constraints --explain",
        ("rules",),
        ("constraints --rule ':- use(U), motion(U,\"fry\").' --format json",),
        "[writing-constraints.md](writing-constraints.md#which-rules-are-fast) describes the kinds.",
    ),
    Section(
        "stats",
        ("stats",),
        ("stats --format json",),
        "[formats.md](formats.md#what-foon-asp-stats-counts) defines the counts at each level.",
    ),
    Section("stats --units", ("units",), ("stats --unit 7 --explain-items --format json",), depth=10),
    Section("merge", ("merge",)),
    Section(
        "lint",
        ("lint", "lint-baseline"),
        ("lint recipe.txt --format json",),
        files={"recipe.txt": "O→ice\nS cubed\nM→crush\nO→ice\nS→crushed\n//\n"},
    ),
    Section(
        "batch, and compare --results",
        ("batch", "batch-row", "compare-row"),
        ("batch questions.jsonl --results answers.jsonl --format json",),
        "The lines of results are documents of their own: the first says what is asked of all, each other "
        "one has an answer. Lines of another version are refused. [batch.md](batch.md) describes the rows.",
        {"questions.jsonl": '{"goal": ["ice", "tea"]}\n'},
    ),
    Section("several goals: each", ("each",)),
)


def page() -> str:
    """Return the page."""
    known = {kind for section in SECTIONS for kind in section.kinds}
    sections = [*SECTIONS, *(Section(kind, (kind,)) for kind in schema_kinds() if kind not in known)]
    headings = {kind: section.heading for section in sections for kind in section.kinds}
    schemas = {kind: schema(kind) for kind in headings}
    parts_of = {kind: _parts(whole) for kind, whole in schemas.items()}
    used = Counter((name, json_line(part)) for parts in parts_of.values() for name, part in parts.items())
    shown = {name: read_json(part) for (name, part), count in used.items() if count > 1}
    links = {name: f"[{name}](#{name.lower()})" for name in shown}
    for whole in schemas.values():
        for name, part in whole.get("$defs", {}).items():
            if kind := _kind_of(part):
                links[name] = f"[{kind}](#{_anchor(headings[kind])})"
    head = {key: schemas["answer"]["properties"][key] for key in _HEAD[1:]}
    begins = _BEGINS.read_text(encoding="utf-8")
    text = [begins.replace("{head}", _table({"properties": head}, links))]
    text += [f"### {name}\n\n{_described(shown[name], links)}\n" for name in sorted(shown, key=str.lower)]
    for section in sections:
        note = f"{section.note}\n\n" if section.note else ""
        documents = [_document(kind, schemas[kind], parts_of[kind], links) for kind in section.kinds]
        text += [f"## {section.heading}\n\n{note}", *documents, _example(section)]
    return re.sub(r"\n{3,}", "\n\n", "".join(text)).rstrip() + "\n"


def _parts(whole: Json) -> dict[str, Json]:
    """Return the values in a document by name, but for those that stand in other documents within it."""
    parts, found = whole.get("$defs", {}), dict[str, Json]()
    waiting = [{key: value for key, value in whole.items() if key != "$defs"}]
    for part in waiting:  # grows on the way
        for name in _REFERENCE.findall(json_line(part)):
            if name not in found and _kind_of(parts[name]) is None:
                found[name] = parts[name]
                waiting.append(parts[name])
    return found


def _kind_of(part: Json) -> str | None:
    """Return the kind of a document; ``None`` for what is none."""
    named = part.get("properties", {}).get("schema", {}).get("enum", [""])[0]
    return named.split("/")[1] if named.startswith("foon-asp/") else None


def _anchor(heading: str) -> str:
    return re.sub(r"[^a-z0-9 -]", "", heading.lower()).replace(" ", "-")


def _document(kind: str, whole: Json, parts: Mapping[str, Json], links: Mapping[str, str]) -> str:
    """Return the keys of a document, but for those of the head, and the values that are its own."""
    if "oneOf" in whole:
        whole = {**whole, **whole["oneOf"][1]}
    has_head = "goals" in whole["properties"]
    fields = {k: v for k, v in whole["properties"].items() if k != "schema" and not (has_head and k in _HEAD)}
    title = whole["title"]
    text = f"`foon-asp/{kind}`{', behind the head' * has_head}: {title[0].lower()}{title[1:]}.\n\n"
    text += _table({"properties": fields, "required": whole["required"]}, links)
    for name in sorted(parts.keys() - links.keys()):
        text += f"\n**{name}**: {_described(parts[name], links)}\n"
    return f"{text}\n"


def _described(part: Json, links: Mapping[str, str]) -> str:
    text = part.get("description", "").rstrip(".").replace("``", "`")
    if "properties" in part:
        return f"{text}.\n\n{_table(part, links)}"
    return f"{text}: {_type(part, links)}.\n"


def _table(part: Json, links: Mapping[str, str]) -> str:
    required: Collection[str] = part["required"] if "required" in part else part["properties"]
    rows = ["| key | value | |", "|---|---|---|"]
    for key, value in part["properties"].items():
        often = "" if key in required else "; not always there"
        said = value.get("description", "").replace("|", "\\|").replace("``", "`")
        rows.append(f"| `{key}` | {_type(value, links)}{often} | {said} |")
    return "\n".join(rows) + "\n"


def _type(value: Json, links: Mapping[str, str]) -> str:
    """Return in words what a value may be."""
    several = value.get("anyOf", value.get("oneOf"))
    kind = value.get("type", "anything")
    if "$ref" in value:
        name = value["$ref"].rpartition("/")[2]
        said = str(links.get(name, name))
    elif several:
        said = " or ".join(_type(each, links) for each in several)
    elif "enum" in value:
        said = ", ".join(f"`{each}`" for each in value["enum"])
    elif kind == "array":
        said = f"list of {_type(value.get('items', {}), links)}"
    elif isinstance(value.get("additionalProperties"), dict):
        said = f"by name: {_type(value['additionalProperties'], links)}"
    else:
        said = kind if isinstance(kind, str) else " or ".join(kind)
    return said


def _example(section: Section) -> str:
    """Return the files of an example, and its commands with what they print."""
    text = "".join(f"```{name}\n{content}```\n\n" for name, content in section.files.items())
    with tempfile.TemporaryDirectory(prefix="json") as folder, contextlib.chdir(folder):
        for name in ("data", "encodings"):
            Path(name).symlink_to(ROOT / name)
        for name, content in section.files.items():
            Path(name).write_text(content.replace("→", "\t"), encoding="utf-8")
        for command in section.commands:
            words, _, target = command.partition(" > ")
            printed = run_here(shlex.split(words))
            assert printed.code in {0, 1}, printed.err
            said = printed.out.replace(f"{ROOT}/", "")
            shown = "".join(f"{line}\n" for line in shortened(said, section.depth))
            if target:
                Path(target).write_text(printed.out, encoding="utf-8")
                shown = ""
            elif not printed.out.startswith("{"):
                shown = "...\n"
            text += f"```\n$ foon-asp {command}\n{shown}```\n\n"
    return text


def shortened(text: str, depth: int) -> Iterator[str]:
    """Yield the lines of a JSON text: of lists the first part, and nothing of the head, or deeper."""
    left_out, unread = False, -1
    inside = list[tuple[int, bool, int]]()  # margin, whether it is a list, how many parts it has so far
    for line in text.splitlines():
        margin = len(line) - len(line.lstrip())
        while inside and margin <= inside[-1][0]:
            inside.pop()
        if inside and margin == inside[-1][0] + 2 and line.strip()[0] not in "]}":
            outer, is_list, count = inside.pop()
            inside.append((outer, is_list, count + 1))
        skipped = margin > depth or any(is_list and count > 1 for _, is_list, count in inside)
        if unread >= 0 or line.strip().startswith(_UNREAD):
            skipped = True
            if unread < 0 and line.endswith(("[", "{")):
                unread = margin
            elif margin == unread:
                unread = -1
        if left_out and not skipped:
            yield "..."
        if not skipped:
            yield line
        left_out = skipped
        if line.endswith(("[", "{")):
            inside.append((margin, line.endswith("["), 0))
