"""Encoding files: ours, a user's constraints, and what can be said of them before solving."""

import difflib
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from clingo.ast import AST, ASTType, ComparisonOperator, Location, Transformer, parse_files

from foon_asp.asp.facts import FACT_PREDICATES, quote
from foon_asp.errors import UserError
from foon_asp.network import Source
from foon_asp.text import Diagnostic, InputError, Severity

Signature = tuple[str, int]

# A message of clingo: file, line and column of what it is about, its kind, and its first line.
_MESSAGE = re.compile(r"(?P<file>.+?):(?P<line>\d+):(?P<column>\d+)[-:\d]*: (?P<kind>\w+): (?P<text>.*)")
_STRING = re.compile(r'"([^"\\]|\\["\\n])*"')  # as clingo reads one
_ESCAPED = re.compile(r"\\(.)")


@dataclass
class Encoding:
    """One ``.lp`` file, parsed: what it defines, what it looks at, and its constants.

    ``defined`` holds the signatures of atoms in heads and ``used`` those in bodies, with the place
    where each is met first, ``declared`` those under ``#defined``. ``constants`` maps the names of
    ``#const`` statements to their values as written. ``minimizes`` are the places of ``#minimize`` and
    weak constraints, ``parts`` those of ``#program`` statements other than ``base``, ``scripts`` those
    of ``#script``. ``assigns`` says that a variable may get its value from an aggregate
    (``N = #count {...}``). ``text`` is every statement as clingo understands it.
    """

    path: Path
    defined: dict[Signature, Source] = field(default_factory=dict)
    declared: set[Signature] = field(default_factory=set)
    used: dict[Signature, Source] = field(default_factory=dict)
    constants: dict[str, str] = field(default_factory=dict)
    minimizes: list[Source] = field(default_factory=list)
    parts: list[Source] = field(default_factory=list)
    scripts: list[Source] = field(default_factory=list)
    assigns: bool = False
    text: str = ""


def read_encoding(path: Path) -> Encoding:
    """Parse an encoding, the files it includes with it; raises :class:`InputError` for a syntax error.

    ``#script`` blocks are found but not run.
    """
    if not path.is_file():
        raise UserError(f"{path}: no such file; expected an encoding (.lp)")
    encoding = Encoding(path)
    collector = _Collector(encoding)
    messages: list[str] = []
    try:
        parse_files([str(path)], collector.statement, logger=lambda _, text: messages.append(text))
    except RuntimeError as error:
        raise fault(messages, str(error)) from None
    return encoding


class _Collector(Transformer):
    """Walks statements and notes signatures in heads and in bodies."""

    def __init__(self, encoding: Encoding) -> None:
        self.encoding = encoding
        self._in_head = False

    def statement(self, statement: AST) -> None:
        encoding = self.encoding
        encoding.text += f"{statement}\n"
        kind = statement.ast_type
        if kind == ASTType.Script:
            encoding.scripts.append(_source(statement.location))
        elif kind == ASTType.Program:
            if statement.name != "base" or statement.parameters:
                encoding.parts.append(_source(statement.location))
        elif kind == ASTType.Definition:
            encoding.constants[statement.name] = str(statement.value)
        elif kind == ASTType.Defined:
            encoding.declared.add((statement.name, statement.arity))
        else:
            if kind == ASTType.Minimize:
                encoding.minimizes.append(_source(statement.location))
            self.visit(statement)

    def visit_Rule(self, rule: AST) -> AST:  # noqa: N802 (the name clingo looks for)
        self._head(rule.head)
        self.visit_sequence(rule.body)
        return rule

    def visit_External(self, external: AST) -> AST:  # noqa: N802
        self._head(external.atom)
        self.visit_sequence(external.body)
        return external

    def visit_ConditionalLiteral(self, literal: AST) -> AST:  # noqa: N802
        in_head, self._in_head = self._in_head, False
        self.visit_sequence(literal.condition)
        self._in_head = in_head
        self.visit(literal.literal)
        return literal

    def visit_SymbolicAtom(self, atom: AST) -> AST:  # noqa: N802
        symbol = atom.symbol
        while symbol.ast_type == ASTType.UnaryOperation:  # classical negation: -p(X)
            symbol = symbol.argument
        if symbol.ast_type == ASTType.Function:
            signature = symbol.name, len(symbol.arguments)
            if self._in_head:
                self.encoding.defined.setdefault(signature, _source(symbol.location))
            else:
                self.encoding.used.setdefault(signature, _source(symbol.location))
        return atom

    def visit_BodyAggregate(self, aggregate: AST) -> AST:  # noqa: N802
        self._note_assignment(aggregate)
        return aggregate.update(**self.visit_children(aggregate))

    def visit_Aggregate(self, aggregate: AST) -> AST:  # noqa: N802
        if not self._in_head:
            self._note_assignment(aggregate)
        return aggregate.update(**self.visit_children(aggregate))

    def _note_assignment(self, aggregate: AST) -> None:
        guard = aggregate.left_guard
        if guard is not None and guard.comparison == ComparisonOperator.Equal:
            self.encoding.assigns |= guard.term.ast_type != ASTType.SymbolicTerm

    def _head(self, head: AST) -> None:
        self._in_head = True
        self.visit(head)
        self._in_head = False


def _source(location: Location) -> Source:
    return Source(location.begin.filename, location.begin.line, location.begin.column)


def check_added(added: Sequence[Encoding], base: Sequence[Encoding]) -> list[Diagnostic]:
    """Look over a user's constraint files; ``base`` are the encodings they are added to.

    Returns warnings: atoms that nothing defines, with the nearest predicate that something does. Raises
    :class:`InputError` for what would change which trees there are or which are best: ``#script``,
    statements that minimize, and rules for predicates that are ours or facts.
    """
    refuse_scripts((*added, *base))
    errors = [
        located(
            Severity.ERROR,
            "minimize",
            "found a statement that minimizes, expected only rules and constraints: what is best is said by "
            "--objective; to change it, edit a copy of objectives.lp and pass its folder with --encodings",
            source,
        )
        for encoding in added
        for source in encoding.minimizes
    ]
    owned = set(FACT_PREDICATES.items()).union(*(encoding.defined for encoding in base))
    errors += [
        located(
            Severity.ERROR,
            "owned-predicate",
            f"found a rule for {name}/{arity}, which is not a constraint's to define: "
            "give it another name, or edit a copy of the encodings and pass its folder with --encodings",
            source,
        )
        for encoding in added
        for (name, arity), source in encoding.defined.items()
        if (name, arity) in owned
    ]
    errors += [
        located(
            Severity.ERROR, "program-part", "found #program, expected rules: parts are not solved", source
        )
        for encoding in added
        for source in encoding.parts
    ]
    if errors:
        raise InputError(errors)
    known = set(FACT_PREDICATES.items())
    for encoding in (*added, *base):
        known |= encoding.defined.keys() | encoding.declared
    return [
        located(Severity.WARNING, "undefined-atom", _undefined(signature, known), source)
        for encoding in added
        for signature, source in encoding.used.items()
        if signature not in known
    ]


def refuse_scripts(encodings: Iterable[Encoding]) -> None:
    """Raise :class:`InputError` where an encoding holds a ``#script``: encodings state, they do not run."""
    found = [source for encoding in encodings for source in encoding.scripts]
    if found:
        message = "found #script, expected rules: scripts in encodings are not run"
        raise InputError([located(Severity.ERROR, "script", message, source) for source in found])


def _undefined(signature: Signature, known: set[Signature]) -> str:
    name, arity = signature
    message = f"no rule or fact defines {name}/{arity}, so it never holds"
    same_name = sorted(n for other, n in known if other == name)
    if same_name:
        return message + f"; did you mean {name}/{same_name[0]}?"
    nearest = difflib.get_close_matches(name, sorted({other for other, _ in known}), n=1, cutoff=0.5)
    if not nearest:
        return message + "; the predicates are listed in encodings/README.md"
    arities = {n for other, n in known if other == nearest[0]}
    return message + f"; did you mean {nearest[0]}/{min(arities, key=lambda n: (abs(n - arity), n))}?"


def constant_arguments(constants: Sequence[str], encodings: Sequence[Encoding]) -> list[str]:
    """Turn ``NAME=VALUE`` settings into clingo's, typed after the ``#const`` they set.

    Where the encoding's own value is a string the setting is one too, quotes or not; where it is a number
    the setting has to be a whole number that fits 32 bits. Raises :class:`UserError` for an unknown name.
    """
    defaults = {name: value for encoding in encodings for name, value in encoding.constants.items()}
    arguments: list[str] = []
    for setting in constants:
        name, equals, value = setting.partition("=")
        if not equals:
            raise UserError(f"found the constant {setting!r}, expected NAME=VALUE")
        if name not in defaults:
            listed = ", ".join(sorted(defaults)) or "none: add a constraint file with #const"
            raise UserError(f"no encoding in use has the constant {name!r}; known are {listed}")
        if defaults[name].startswith('"'):
            value = quote(string_constant(value))
        elif _is_number(defaults[name]) and not _fits(value):
            raise UserError(f"found {value!r} for the constant {name!r}, expected a whole number of 32 bits")
        arguments += ["-c", f"{name}={value}"]
    return arguments


def string_constant(value: str) -> str:
    """Give the text that a setting of a constant means where the constant is a string, in quotes or not.

    Raises :class:`UserError` for a quote at the beginning with no string of clingo's after it.
    """
    if not value.startswith('"'):
        return value
    if not _STRING.fullmatch(value):
        raise UserError(
            f'found {value} for a constant, expected a text in quotes, with \\" for a quote in it'
        )
    return _ESCAPED.sub(lambda found: "\n" if found[1] == "n" else found[1], value[1:-1])


def unset_constants(added: Sequence[Encoding], constants: Sequence[str]) -> list[str]:
    """Warn of constants without a meaning until they are set: their own value is "", #sup or #inf."""
    given = {setting.partition("=")[0] for setting in constants}
    return [
        f"{encoding.path}: warning: the constant {name} is not set and the constraint has no effect; "
        f"set it with -c {name}=VALUE"
        for encoding in added
        for name, value in encoding.constants.items()
        if value in {'""', "#sup", "#inf"} and name not in given
    ]


def _is_number(value: str) -> bool:
    return value in {"#sup", "#inf"} or value.lstrip("-").isdigit()


def _fits(value: str) -> bool:
    return bool(re.fullmatch(r"-?\d{1,10}", value, re.ASCII)) and -(2**31) <= int(value) < 2**31


def fault(messages: Sequence[str], otherwise: str) -> InputError | UserError:
    """Turn clingo's messages about a program into one error with places and source lines."""
    errors: list[Diagnostic] = []
    for message in messages:
        first, *notes = (_MESSAGE.match(line) for line in message.strip().split("\n"))
        if first is None or first["kind"] != "error":
            continue
        if first["text"].startswith("unsafe variables"):
            for note in filter(None, notes):
                text = f"the variable {note['text'].split()[0]} is unsafe: no literal of the body binds it"
                errors.append(located(Severity.ERROR, "clingo", text, _message_source(note)))
        else:
            text = " ".join(line.strip() for line in [first["text"], *message.strip().split("\n")[1:]])
            errors.append(located(Severity.ERROR, "clingo", text, _message_source(first)))
    return InputError(errors) if errors else UserError("".join(messages).strip() or otherwise)


def _message_source(match: re.Match[str]) -> Source:
    return Source(match["file"], int(match["line"]), int(match["column"]))


def located(severity: Severity, code: str, message: str, source: Source) -> Diagnostic:
    """Make a diagnostic with the line of the file that it is about."""
    excerpt = ""
    path = Path(source.file)
    if path.is_file():
        lines = path.read_text(encoding="utf-8", errors="replace").split("\n")
        if 0 < source.line <= len(lines):
            excerpt = lines[source.line - 1].rstrip("\r")
    return Diagnostic(severity, code, message, source, excerpt)
