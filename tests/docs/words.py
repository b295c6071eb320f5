"""Words that hide a meaning: ``python -m tests.docs.words``, a part of `make lint`, lists them.

A name says what it holds, in a term of planning, linear programming, answer-set programming or FOON; a
docstring begins with what is done or returned. docs/dev/words.md has the terms.
"""

import ast
import re
import sys
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]

# As whole names, with or without an underscore, these say nothing.
EMPTY_NAMES = frozenset(
    {
        "asked",
        "beside",
        "dear",
        "each",
        "elsewhere",
        "few",
        "found",
        "given",
        "heard",
        "held",
        "here",
        "how",
        "known",
        "left",
        "more",
        "most",
        "narrow",
        "near",
        "part",
        "place",
        "rest",
        "said",
        "side",
        "some",
        "spare",
        "taken",
        "there",
        "told",
        "wide",
        "within",
    }
)
OPENINGS = re.compile(r"(Give|Say|Tell|Note|Know|Let|Ask|Hear|Leave)s?\b")

# Names that are allowed all the same, with where and why.
EXCEPTIONS = {
    "beside": ("questions/view.py serve/form.py", "a field of the page's form"),
    "dear": (
        "hypergraph/reductions.py results/proof_cases.py",
        "a word of --reduce, and a key of certificates",
    ),
    "each": ("cli/rename_command.py pictures/whole_network.py text/json_names.py", "a loop of one line"),
    "found": (
        "asp/ranking.py cli/lint_command.py text whole_file.py",
        "findings, and what a line error found",
    ),
    "given": (
        "cli/asking.py questions/posing.py questions/tree.py results/proof_cases.py",
        "keys of documents",
    ),
    "held": ("whole_file.py", "the error of a file that another process has locked"),
    "asked": ("engines/engine.py", "what an engine is asked, part of what packages import"),
    "known": (
        "linting/baseline.py problem/objective.py questions/lint.py",
        "keys of a baseline and of documents",
    ),
    "left": (
        "asp/outcome.py deadline.py network/near_units.py problem proof/replay.py",
        "as in left and right; time",
    ),
    "most": ("questions/assist.py", "a parameter that users write"),
    "near": (
        "network/network.py questions/why_not.py store/store.py text/node_lookup.py",
        "near names and nodes",
    ),
    "part": ("dataset network questions/regret.py store/store.py", "a part of a network or a tree"),
    "place": ("encoding problem results/values.py rules/measure.py", "file, line and column"),
    "side": (
        "linting network questions text store problem planning proof certificate foon.py",
        "the inputs or the outputs of a unit",
    ),
    "taken": ("problem/root.py results/proof_cases.py", "keys of documents"),
    "there": ("questions/schedule.py questions/trace.py", "a key of documents"),
    "told": ("problem/items.py", "a field of what kitchens say of items"),
    "within": (
        "deadline.py questions/alternatives.py questions/unit_union.py",
        "a parameter that users write",
    ),
}


def remarks(file: Path) -> Iterator[str]:
    """Yield a line for each empty name and each docstring of a file that does not say what is done."""
    inside = file.relative_to(ROOT / "foon_asp").as_posix()
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        for name in _bound(node):
            word = name.strip("_").lower()
            where, _ = EXCEPTIONS.get(word, ("", ""))
            if word in EMPTY_NAMES and not any(inside.startswith(start) for start in where.split()):
                line = getattr(node, "lineno", 1)
                yield f"{file.relative_to(ROOT)}:{line}: the name {name!r} does not say what it holds"
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef):
            opening = OPENINGS.match(ast.get_docstring(node) or "")
            if opening:
                line = getattr(node, "lineno", 1)
                yield f"{file.relative_to(ROOT)}:{line}: a docstring begins with {opening.group()!r}"


def _bound(node: ast.AST) -> list[str]:
    """Return the names that a node binds."""
    match node:
        case ast.Name(id=name, ctx=ast.Store()) | ast.Attribute(attr=name, ctx=ast.Store()):
            return [name]
        case ast.arg(arg=name) | ast.FunctionDef(name=name) | ast.ClassDef(name=name):
            return [name]
    return []


def main() -> int:
    """Print the remarks on the whole package; return the exit code."""
    lines = [line for file in sorted((ROOT / "foon_asp").rglob("*.py")) for line in remarks(file)]
    print(*lines, sep="\n", end="\n" if lines else "")
    return 1 if lines else 0


if __name__ == "__main__":
    sys.exit(main())
