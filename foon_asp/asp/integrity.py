"""Integrity constraints of the user's files, one by one, and the same relaxed."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple

from clingo.ast import AST, ASTSequence, ASTType, parse_files, parse_string
from clingo.symbol import SymbolType

from foon_asp.asp.assembly import find_constraint
from foon_asp.asp.clause import place, written
from foon_asp.asp.encoding import located, read_encoding
from foon_asp.asp.own_encodings import question_encoding
from foon_asp.asp.search import ground
from foon_asp.asp.settings import Relaxed
from foon_asp.deadline import Deadline
from foon_asp.network import Source
from foon_asp.text.diagnostics import Diagnostic, InputError

_TEXT = "<block>"  # what clingo calls text that is in no file
_PASSED_OVER = {ASTType.Program, ASTType.Comment}


class IntegrityConstraint(NamedTuple):
    """One rule without a head: its number, the file it was asked for in, where it stands, and its text there.

    ``constants`` are the constants in it that were set, as ``NAME=VALUE``.
    """

    number: int
    file: Path
    source: Source
    text: str
    constants: tuple[str, ...]


def relax(
    files: Sequence[Path], constants: Sequence[str], soft: bool, deadline: Deadline | None = None
) -> tuple[tuple[IntegrityConstraint, ...], Relaxed]:
    """Number the integrity constraints of some files, from 1, and rewrite the files accordingly.

    Without ``soft``, constraint number C holds unless ``_dropped(C)`` does (``questions/clash.lp``). With it,
    it is a rule for ``_broken(C,Way)``, where ``Way`` has the values of its variables
    (``questions/soft.lp``).
    Other rules stay as they are. Raises what :func:`foon_asp.asp.encoding.read_encoding` does.
    """
    found: list[IntegrityConstraint] = []
    rules: dict[str, Source] = {}
    paths = tuple(dict.fromkeys(find_constraint(file) for file in files))
    for path in paths:
        _look_over(path, deadline or Deadline())
        statements: list[AST] = []
        parse_files([str(path)], statements.append)
        for statement in statements:
            if statement.ast_type in _PASSED_OVER:
                continue
            if not _is_constraint(statement):
                rules.setdefault(str(statement), place(statement))
                continue
            number = len(found) + 1
            names = set(_names(statement))
            given = tuple(setting for setting in constants if setting.partition("=")[0] in names)
            found.append(IntegrityConstraint(number, path, place(statement), written(statement), given))
            rule = _broken(statement, number) if soft else _unless_dropped(statement, number)
            rules[rule] = place(statement)
    encoding = question_encoding("soft.lp" if soft else "clash.lp")
    return tuple(found), Relaxed(paths, "".join(f"{rule}\n" for rule in rules), encoding, rules)


@contextmanager
def placed(relaxed: Relaxed, text: str) -> Iterator[None]:
    """Translate errors in a text with the rules into places in the files."""
    try:
        yield
    except InputError as error:
        lines = text.split("\n")
        found: list[Diagnostic] = []
        for diagnostic in error.diagnostics:
            file, line, *_ = diagnostic.source
            stands = relaxed.places.get(lines[line - 1]) if file == _TEXT and line <= len(lines) else None
            found.append(
                diagnostic
                if stands is None
                else located(diagnostic.severity, diagnostic.code, diagnostic.message, stands)
            )
        raise InputError(found) from None


def _look_over(path: Path, deadline: Deadline) -> None:
    """Raise the errors of a file while places are known: once rewritten it is only text."""
    read_encoding(path)
    try:  # without facts, for unsafe variables alone
        ground((path,), "", (), deadline, endless=True).close()
    except KeyboardInterrupt:  # a limit: then nobody comes to look at what was not seen
        deadline.interrupt()


def _is_constraint(statement: AST) -> bool:
    if statement.ast_type != ASTType.Rule or statement.head.ast_type != ASTType.Literal:
        return False
    atom = statement.head.atom
    return atom.ast_type == ASTType.BooleanConstant and not atom.value


def _unless_dropped(rule: AST, number: int) -> str:
    return str(rule.update(body=[*rule.body, *_parsed(f":- not _dropped({number}).").body]))


def _broken(rule: AST, number: int) -> str:
    way = ",".join(sorted(set(_global_variables(rule.body))))
    head = _parsed(f"_broken({number},_way({way})).") if way else _parsed(f"_broken({number},_way).")
    return str(rule.update(head=head.head))


def _parsed(text: str) -> AST:
    statements: list[AST] = []
    parse_string(text, statements.append)
    return statements[-1]


def _global_variables(body: Sequence[AST]) -> Iterator[str]:
    """Give the variables that a whole rule has in common: not those within an aggregate or a condition."""
    for literal in body:
        if literal.ast_type == ASTType.ConditionalLiteral:
            continue
        atom = literal.atom
        if atom.ast_type in {ASTType.Aggregate, ASTType.BodyAggregate}:
            for guard in (atom.left_guard, atom.right_guard):
                if guard is not None:
                    yield from _variables(guard)
        elif atom.ast_type != ASTType.TheoryAtom:
            yield from _variables(atom)


def _variables(node: AST) -> Iterator[str]:
    return (part.name for part in _walk(node) if part.ast_type == ASTType.Variable and part.name != "_")


def _names(statement: AST) -> Iterator[str]:
    """Give the names of what may be a constant in the terms of a statement."""
    for part in _walk(statement):
        if part.ast_type == ASTType.SymbolicTerm and part.symbol.type is SymbolType.Function:
            yield part.symbol.name


def _walk(node: AST) -> Iterator[AST]:
    yield node
    for key in node.child_keys:
        child = getattr(node, key)
        for part in child if isinstance(child, ASTSequence) else [child]:
            if isinstance(part, AST):
                yield from _walk(part)
