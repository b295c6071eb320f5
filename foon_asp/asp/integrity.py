"""Integrity constraints of the user (rules without a head), one by one, and their relaxation."""

from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from typing import NamedTuple

from clingo.ast import AST, ASTType, parse_string
from clingo.symbol import SymbolType

from foon_asp.asp.settings import Relaxed
from foon_asp.deadline import Deadline
from foon_asp.encoding.clingo_run import ground
from foon_asp.encoding.encoding import located_diagnostic, read_encoding
from foon_asp.encoding.own_encodings import question_encoding
from foon_asp.encoding.parsing import nodes, parse
from foon_asp.encoding.stated import Loaded
from foon_asp.network import Source
from foon_asp.results.values import ListedConstraint
from foon_asp.rules.clause import source_of, statement_text, variables
from foon_asp.rules.passed_constraint import Constraint, LibraryUse, find_constraint
from foon_asp.rules.stating import load_constraints
from foon_asp.text.diagnostics import Diagnostic, InputError

_BLOCK = "<block>"  # the file name that clingo uses for text without a file
_PASSED_OVER = {ASTType.Program, ASTType.Comment}


class IntegrityConstraint(NamedTuple):
    """A rule without a head: its number, the constraint that it belongs to, its source and text.

    ``number`` counts from 1. ``constants`` are the user's settings, ``NAME=VALUE``, of the constants that
    occur in the rule.
    """

    number: int
    constraint: Constraint
    source: Source
    text: str
    constants: tuple[str, ...]

    @property
    def listed(self) -> ListedConstraint:
        """The rule in the form in which results list it."""
        return ListedConstraint(self.number, *self.source[:2], self.text, self.constants)

    def __str__(self) -> str:
        return f"{self.source}: {self.text}" + "".join(f" -c {setting}" for setting in self.constants)


def relax(
    constraints: Iterable[Constraint],
    constants: Sequence[str],
    soft: bool,
    deadline: Deadline | None = None,
    before: Iterable[Constraint] = (),
) -> tuple[tuple[IntegrityConstraint, ...], Relaxed]:
    """Number integrity constraints from 1, and rewrite them so that trees may break them.

    Returns the numbered integrity constraints, and the rewritten rules. Without ``soft``, integrity
    constraint number C need not hold if the atom ``_dropped(C)`` is true (``questions/clash.lp``). With
    ``soft``, the integrity constraint becomes a rule for ``_broken(C,Way)``, where ``Way`` has the values of
    its variables (``questions/soft.lp``). Rules of ``constraints`` with a head stay as they are.
    ``constants`` are the user's settings of constants. ``deadline`` has the limits of the checks.

    ``before`` are constraints of the question that are not rewritten. Messages number rules given as text;
    the rules of ``before`` come first. Each of the ``constraints`` is parsed and grounded alone, without
    facts, so that its errors are raised with their places. At a limit or ctrl-C, the grounding is skipped and
    the deadline records it. Raises as :func:`foon_asp.encoding.encoding.read_encoding` does.
    """
    numbered: list[IntegrityConstraint] = []
    rules: dict[str, Source] = {}
    distinct = tuple(dict.fromkeys(map(find_constraint, constraints)))
    files = load_constraints((*map(find_constraint, before), *distinct))
    for constraint in distinct:
        _check_alone(files[constraint], deadline or Deadline())
        settings, original_rules = constants, files[constraint]
        if isinstance(constraint, LibraryUse):
            settings, original_rules = (
                [f"{name}={value}" for name, value in constraint.constants.items()],
                constraint.file,
            )
        for statement, original in zip(
            _statements(files[constraint]), _statements(original_rules), strict=True
        ):
            if not _is_constraint(statement):
                rules.setdefault(str(statement), source_of(statement))
                continue
            number = len(numbered) + 1
            names = set(_possible_constants(original))
            set_here = tuple(setting for setting in settings if setting.partition("=")[0] in names)
            text = statement_text(original, original_rules)
            numbered.append(IntegrityConstraint(number, constraint, source_of(original), text, set_here))
            rule = _rule_for_broken(statement, number) if soft else _rule_unless_dropped(statement, number)
            rules[rule] = source_of(statement)
    encoding = question_encoding("soft.lp" if soft else "clash.lp")
    text = "".join(f"{rule}\n" for rule in rules)
    return tuple(numbered), Relaxed(distinct, text, encoding, rules, tuple(files.values()))


def _statements(rules: Loaded) -> list[AST]:
    """Return the parsed statements of a constraint, without comments and ``#program``."""
    statements: list[AST] = []
    parse(rules, statements.append, lambda *_: None)
    return [statement for statement in statements if statement.ast_type not in _PASSED_OVER]


@contextmanager
def errors_at_sources(relaxed: Relaxed, text: str) -> Iterator[None]:
    """Return a context in which errors in the rewritten rules are raised with places in the user's files.

    ``text`` is the text given to clingo, which has the rules. Errors outside these rules keep their places.
    """
    try:
        yield
    except InputError as error:
        lines = text.split("\n")
        diagnostics: list[Diagnostic] = []
        for diagnostic in error.diagnostics:
            file, line, *_ = diagnostic.source
            source = relaxed.places.get(lines[line - 1]) if file == _BLOCK and line <= len(lines) else None
            diagnostics.append(
                diagnostic
                if source is None
                else located_diagnostic(
                    diagnostic.severity, diagnostic.code, diagnostic.message, source, relaxed.files
                )
            )
        raise InputError(diagnostics) from None


def _check_alone(rules: Loaded, deadline: Deadline) -> None:
    """Parse and ground one constraint without facts, to raise its errors with their places.

    Later the constraint is a part of a rewritten text, in which errors have no place. At a limit or ctrl-C,
    the grounding ends early. Then nothing is raised, and the deadline records the interrupt.
    """
    read_encoding(rules)
    try:  # without facts, for unsafe variables alone
        ground((rules,), "", (), deadline, endless=True).close()
    except KeyboardInterrupt:  # at a limit, nothing is searched under unchecked rules
        deadline.interrupt()


def _is_constraint(statement: AST) -> bool:
    """Whether a statement is a rule without a head."""
    if statement.ast_type != ASTType.Rule or statement.head.ast_type != ASTType.Literal:
        return False
    atom = statement.head.atom
    return atom.ast_type == ASTType.BooleanConstant and not atom.value


def _rule_unless_dropped(rule: AST, number: int) -> str:
    """Return the text of a rule with ``not _dropped(number)`` added to its body."""
    return str(rule.update(body=[*rule.body, *_parse_statement(f":- not _dropped({number}).").body]))


def _rule_for_broken(rule: AST, number: int) -> str:
    """Return the text of a rule with the head ``_broken(number,Way)``.

    ``Way`` has the global variables of the body in alphabetical order, as in ``_way(O,U)``. Without
    variables, it is ``_way``.
    """
    way = ",".join(sorted(set(_global_variables(rule.body))))
    head = (
        _parse_statement(f"_broken({number},_way({way})).")
        if way
        else _parse_statement(f"_broken({number},_way).")
    )
    return str(rule.update(head=head.head))


def _parse_statement(text: str) -> AST:
    """Return the parsed statement of a text that has a single statement."""
    statements: list[AST] = []
    parse_string(text, statements.append)
    return statements[-1]


def _global_variables(body: Sequence[AST]) -> Iterator[str]:
    """Yield the names of the global variables of a body, with repeats.

    A variable is global if it occurs outside elements of aggregates and outside conditional literals.
    """
    for literal in body:
        if literal.ast_type == ASTType.ConditionalLiteral:
            continue
        atom = literal.atom
        if atom.ast_type in {ASTType.Aggregate, ASTType.BodyAggregate}:
            for guard in (atom.left_guard, atom.right_guard):
                if guard is not None:
                    yield from variables(guard)
        elif atom.ast_type != ASTType.TheoryAtom:
            yield from variables(atom)


def _possible_constants(statement: AST) -> Iterator[str]:
    """Yield the names in the terms of a statement that may be constants, with repeats."""
    for node in nodes(statement):
        if node.ast_type == ASTType.SymbolicTerm and node.symbol.type is SymbolType.Function:
            yield node.symbol.name
