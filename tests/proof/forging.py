"""Certificates that one check alone refuses: with the check taken out of the source, they pass.

A verifier is a list of modules. Each imports only those before it, and the last one verifies.
"""

import ast
import re
import sys
from collections.abc import Iterable, Iterator, Mapping
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import Any, NamedTuple

import pytest

from foon_asp.certificate.certificate import subject_of
from foon_asp.problem import Problem
from foon_asp.proof.refusal import RefusedError

KIND = "what is of another kind ends the check with a fault of Python's and not with a refusal"
WORDS = "the refusal says what is wrong; without it a later one says less"


class Forged(NamedTuple):
    """A certificate or the text of one, and the data it is held against.

    ``stays`` is empty where the certificate passes without the check, and else says why the check stays.
    """

    content: Any
    at: Problem
    stays: str = ""


class Part(NamedTuple):
    """A part of the source that is no check by itself, a wrong one in its place, and what passes then."""

    right: str
    wrong: str
    forged: Forged
    of: ModuleType | None = None


def checks(by: Iterable[ModuleType]) -> Iterator[tuple[str, ast.stmt]]:
    """Return the statements of modules that refuse, in order, each by its function and what it says."""
    for module in by:
        yield from _checks(ast.parse(_source(module)), "")


def _checks(tree: ast.AST, function: str) -> Iterator[tuple[str, ast.stmt]]:
    for node in ast.iter_child_nodes(tree):
        if isinstance(node, ast.FunctionDef):
            yield from _checks(node, node.name)
            continue
        said: ast.expr | None = None
        if isinstance(node, ast.Raise) and isinstance(node.exc, ast.Call):
            said = node.exc.args[0]
        elif isinstance(node, ast.Expr) and isinstance(node.value, ast.Call):
            called = node.value.func
            said = node.value.args[1] if isinstance(called, ast.Name) and called.id == "require" else None
        if said is not None and isinstance(node, ast.stmt):
            yield f"{function}: {_words(said)}", node
        yield from _checks(node, function)


def _words(said: ast.expr) -> str:
    """Return what a check says, with … for what depends on the certificate."""
    if isinstance(said, ast.Constant):
        return str(said.value)
    if isinstance(said, ast.JoinedStr):
        return "".join(str(part.value) if isinstance(part, ast.Constant) else "…" for part in said.values)
    return ast.unparse(said)


def _source(of: ModuleType) -> str:
    return Path(str(of.__file__)).read_text(encoding="utf-8")


def _run(sources: Mapping[ModuleType, str], patch: pytest.MonkeyPatch) -> tuple[ModuleType, ...]:
    """Run sources in place of modules, in order, each of which imports those before it."""
    changed = []
    for module, source in sources.items():
        found = ModuleType(module.__name__)
        exec(compile(source, module.__name__, "exec"), found.__dict__)
        patch.setitem(sys.modules, module.__name__, found)
        changed.append(found)
    return tuple(changed)


@cache
def _without(by: tuple[ModuleType, ...], name: str) -> tuple[ModuleType, ...]:
    sources = {module: _source(module) for module in by}
    (at,) = (module for module in by if name in dict(checks([module])))
    gone, lines = dict(checks([at]))[name], sources[at].split("\n")
    lines[gone.lineno - 1 : gone.end_lineno] = [" " * gone.col_offset + "pass"]
    with pytest.MonkeyPatch.context() as patch:
        return _run({**sources, at: "\n".join(lines)}, patch)


def named(by: Iterable[ModuleType], name: str) -> Any:
    """Give what the first of modules that knows a name calls so; the name itself where none does."""
    return next((vars(module)[name] for module in by if name in vars(module)), name)


def held(by: tuple[ModuleType, ...], forged: Forged, folder: Path) -> Any:
    """Hold a forged certificate against its data: from a file, from text or as it is."""
    content, at = forged.content, forged.at
    if isinstance(content, bytes):
        file = folder / "forged.json"
        file.write_bytes(content)
        content = named(by, "load_certificate")(file)
    elif isinstance(content, str):
        content = named(by, "read_certificate")(content)
    if isinstance(forged.content, str | bytes):
        content["seal"] = named(by, "seal")(content)
    verify = getattr(by[-1], "verify_plan", None) or vars(by[-1])["verify"]
    return verify(content, subject_of(at))


def require_its_check_alone(by: tuple[ModuleType, ...], name: str, forged: Forged, folder: Path) -> None:
    """Require that a check refuses a certificate, in its words, and that nothing else does."""
    said = named(by, name.partition(": ")[2])
    with pytest.raises(RefusedError, match=".*".join(map(re.escape, said.split("…")))):
        held(by, forged, folder)
    failed = ""
    try:
        assert type(held(_without(by, name), forged, folder)).__name__ == "Verified"
    except Exception as error:
        failed = type(error).__name__
    assert (failed != "") == (forged.stays != "")
    assert (forged.stays == KIND) == (failed not in ("", "RefusedError", "CheckLimitError"))


def require_right(
    part: Part, folder: Path, monkeypatch: pytest.MonkeyPatch, by: tuple[ModuleType, ...]
) -> None:
    """Require that a certificate is refused, and with a wrong part in one of the modules accepted."""
    with pytest.raises(RefusedError):
        held(by, part.forged, folder)
    sources = {module: _source(module) for module in by}
    wrong_in = part.of or by[-1]
    assert sources[wrong_in].count(part.right) == 1
    sources[wrong_in] = sources[wrong_in].replace(part.right, part.wrong)
    assert type(held(_run(sources, monkeypatch), part.forged, folder)).__name__ == "Verified"
