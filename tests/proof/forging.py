"""Certificates that one check alone refuses: with the check taken out of the source, they pass."""

import ast
import re
import sys
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import Any, NamedTuple

import pytest

from foon_asp.certificate.certificate import subject_of
from foon_asp.problem import Problem
from foon_asp.proof.verifier import RefusedError

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


def checks(by: ModuleType) -> Iterator[tuple[str, ast.stmt]]:
    """Return the statements that refuse, in order, each by its function and what it says."""
    yield from _checks(ast.parse(_source(by)), "")


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


def _run(source: str) -> ModuleType:
    """Run a source as a module."""
    found = ModuleType("changed")
    exec(compile(source, "changed", "exec"), found.__dict__)
    return found


@cache
def _without(by: ModuleType, name: str) -> ModuleType:
    gone, lines = dict(checks(by))[name], _source(by).split("\n")
    lines[gone.lineno - 1 : gone.end_lineno] = [" " * gone.col_offset + "pass"]
    return _run("\n".join(lines))


def held(by: Any, forged: Forged, folder: Path) -> Any:
    """Hold a forged certificate against its data: from a file, from text or as it is."""
    content, at = forged.content, forged.at
    if isinstance(content, bytes):
        file = folder / "forged.json"
        file.write_bytes(content)
        content = by.load_certificate(file)
    elif isinstance(content, str):
        content = by.read_certificate(content)
    if isinstance(forged.content, str | bytes):
        content["seal"] = by.seal(content)
    verify = getattr(by, "verify_plan", None) or by.verify
    return verify(content, subject_of(at))


def require_its_check_alone(by: ModuleType, name: str, forged: Forged, folder: Path) -> None:
    """Require that a check refuses a certificate, in its words, and that nothing else does."""
    said = name.partition(": ")[2]
    said = getattr(by, said, said)
    with pytest.raises(RefusedError, match=".*".join(map(re.escape, said.split("…")))):
        held(by, forged, folder)
    failed = ""
    try:
        assert type(held(_without(by, name), forged, folder)).__name__ == "Verified"
    except Exception as error:
        failed = type(error).__name__
    assert (failed != "") == (forged.stays != "")
    assert (forged.stays == KIND) == (failed not in ("", "RefusedError", "LimitError"))


def require_right(part: Part, folder: Path, monkeypatch: pytest.MonkeyPatch, *modules: ModuleType) -> None:
    """Require that a certificate is refused, and with a wrong part in one of the modules accepted.

    The last module verifies; each imports those before it.
    """
    with pytest.raises(RefusedError):
        held(modules[-1], part.forged, folder)
    for each in modules:
        source = _source(each)
        if each is (part.of or modules[-1]):
            assert source.count(part.right) == 1
            source = source.replace(part.right, part.wrong)
        changed = _run(source)
        monkeypatch.setitem(sys.modules, each.__name__, changed)
    assert type(held(changed, part.forged, folder)).__name__ == "Verified"
