"""Words and numbers that hide a meaning: ``python -m tests.docs.words``, a part of `make lint`, lists them.

A name says what it holds, in a term of planning, linear programming, answer-set programming or FOON; a
docstring begins with what is done or returned, and its references have their nouns. docs/dev/words.md has the
terms. A number stands where it is used, is a default of a parameter, or a field of the class that says what
it limits or steers; a constant of a module is the exception.
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

# References whose noun the reader has to look for: "of those that", "so many".
REFERENCES = re.compile(
    r"\bof (these|those)(?=[.,;:)]|\s+(that|which|who|whose|are|is|and|or|to|in|on|with|for|has|have)\b)"
    r"|\bof (theirs|ours)\b|\bso many\b|\bthat which\b"
)

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
        "asp/outcome.py network/near_units.py problem proof/replay.py",
        "as in left and right; time",
    ),
    "most": ("questions/assist.py", "a parameter that users write"),
    "near": (
        "network/network.py questions/why_not.py store/store.py text/node_names.py",
        "near names and nodes",
    ),
    "part": ("dataset network questions/regret.py store/store.py", "a part of a network or a tree"),
    "place": ("encoding problem results/values.py rules/measure.py", "file, line and column"),
    "side": (
        "linting network questions text store problem planning proof certificate foon.py",
        "the inputs or the outputs of a unit",
    ),
    "taken": ("results/proof_cases.py", "keys of documents"),
    "there": ("questions/schedule.py questions/trace.py", "a key of documents"),
    "told": ("problem/items.py", "a field of what kitchens say of items"),
    "within": (
        "deadline.py questions/alternatives.py questions/unit_union.py",
        "a parameter that users write",
    ),
}

# Numeric constants of modules, by why they are constants; all others are refused, and more than MAX_NUMBERS.
NUMBERS = {
    "a number of a protocol, a file format or a language": """
        APPLICATION_ID INT32_MAX LEVELS OUT_OF_MEMORY UNTIL_SUCCESS VERSION _HEADER _TICK_SECONDS""",
    "a sentinel": """
        FAR UNREACHED""",
    "a scale that exact numbers or bounds rely on": """
        LOGARITHM_SCALE PARTS USUAL_SCALE _MAX_FACTOR _ROUNDED _SCALE""",
    "a tolerance of floats or of digits, by which nothing is proved": """
        INTEGRALITY ROUGH_TOLERANCE TOLERANCE _DIGITS""",
    "a limit that users are told of, or that several rooms keep": """
        BOXED_UNITS CHUNK_BYTES CLINGO_SECONDS MANY MAX_AMOUNT MAX_COMPLETIONS MAX_KINDS MAX_LETTERS
        MAX_UNITS REPORT_BYTES _MAX_CANDIDATES _MAX_COUNT _MAX_DIGITS _MAX_ITEMS""",
    "steers one search; where there are several, a tuning class of their stage is better": """
        _DELAY_SECONDS _FIRST _MAX_COMPARED _STEPS""",
}
MAX_NUMBERS = 60


def numbers(file: Path) -> Iterator[tuple[int, str]]:
    """Yield line and name of each constant of a module that is a number, or a tuple of numbers."""
    for node in ast.parse(file.read_text(encoding="utf-8")).body:
        match node:
            case ast.Assign(targets=[ast.Name(id=name)], value=value) if name.strip("_").isupper():
                pass
            case ast.AnnAssign(target=ast.Name(id=name), value=ast.expr() as value) if name.strip(
                "_"
            ).isupper():
                pass
            case _:
                continue
        if _is_number(value):
            yield node.lineno, name


def _is_number(value: ast.expr) -> bool:
    """Return whether an expression is made of numbers alone."""
    match value:
        case ast.UnaryOp(operand=operand):
            return _is_number(operand)
        case ast.BinOp(left=left, right=right):
            return _is_number(left) and _is_number(right)
        case ast.Tuple(elts=elements):
            return bool(elements) and all(map(_is_number, elements))
        case ast.Constant(value=number):
            return type(number) in {int, float}
    return False


def remarks(file: Path) -> Iterator[str]:
    """Yield a line for each name, docstring and number of a file that does not say what it is."""
    inside = file.relative_to(ROOT / "foon_asp").as_posix()
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        for name in _bound(node):
            word = name.strip("_").lower()
            where, _ = EXCEPTIONS.get(word, ("", ""))
            if word in EMPTY_NAMES and not any(inside.startswith(start) for start in where.split()):
                line = getattr(node, "lineno", 1)
                yield f"{file.relative_to(ROOT)}:{line}: the name {name!r} does not say what it holds"
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef):
            docstring, line = ast.get_docstring(node) or "", getattr(node, "lineno", 1)
            if opening := OPENINGS.match(docstring):
                yield f"{file.relative_to(ROOT)}:{line}: a docstring begins with {opening.group()!r}"
            for reference in REFERENCES.finditer(docstring):
                yield f"{file.relative_to(ROOT)}:{line}: {reference.group()!r} lacks its noun"
    allowed = {name for names in NUMBERS.values() for name in names.split()}
    for line, name in numbers(file):
        if name not in allowed:
            yield f"{file.relative_to(ROOT)}:{line}: {name} is a number, and neither a field nor a default"


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
    files = sorted((ROOT / "foon_asp").rglob("*.py"))
    lines = [line for file in files for line in remarks(file)]
    count = sum(len([*numbers(file)]) for file in files)
    if count > MAX_NUMBERS:
        lines.append(f"{count} constants of modules are numbers, expected at most {MAX_NUMBERS}")
    print(*lines, sep="\n", end="\n" if lines else "")
    return 1 if lines else 0


if __name__ == "__main__":
    sys.exit(main())
