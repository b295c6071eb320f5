"""Parser of encodings, built-in or of the user, and checks before solving."""

import difflib
import re
from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path

from clingo.ast import AST, AggregateFunction, ASTType, ComparisonOperator, Location, Transformer
from clingo.symbol import SymbolType

from foon_asp.encoding.encoding_file import check_text, included_files, source_line, string_constant
from foon_asp.encoding.exact import LARGEST
from foon_asp.encoding.fact_writer import FACT_PREDICATES, quote
from foon_asp.encoding.messages import listener
from foon_asp.encoding.parsing import nodes, parse
from foon_asp.encoding.stated import Loaded, Stated
from foon_asp.errors import UserError
from foon_asp.network import Source
from foon_asp.problem import Objective
from foon_asp.resources import encodings_folder
from foon_asp.text.diagnostics import Diagnostic, InputError, Severity

Signature = tuple[str, int]

# The prefix of reserved names: see encodings/README.md.
_PREFIX = "_"
PUBLIC = frozenset((*FACT_PREDICATES.items(), ("use", 1), ("times", 2), ("available", 1)))
EXTENDED = frozenset(
    (("allergen", 1), ("allowed", 1), ("heats", 1))
)  # predicates that user files add facts to
_LOOKED_AT = frozenset(
    (("_by_person", 1),)
)  # reserved predicates that constraints may read, in a question that has them
_TERMS = frozenset(objective.row.term for objective in Objective)
PUBLIC_NAMES = frozenset(name for name, _ in (*PUBLIC, *EXTENDED)) | _TERMS

_THEORY = "no theory is part of the program, so it would have no meaning; #sum and #count add up and count"
_REFUSED = {
    ASTType.Minimize: "a statement that minimizes, expected only rules and constraints: what may be broken "
    "at a cost is a constraint (:-) in a file passed with --soft FILE=WEIGHT; what units cost are rules for "
    "cost(NAME,U,N) in a file passed with --measure FILE.lp --objective NAME",
    ASTType.ShowTerm: "#show of a term, expected only rules and constraints: what is shown is the answer; "
    "#show NAME/ARITY. may stay",
    ASTType.ProjectAtom: "#project, expected only rules and constraints: answers are not projected",
    ASTType.ProjectSignature: "#project, expected only rules and constraints: answers are not projected",
    ASTType.Edge: "#edge, expected only rules and constraints: an edge would join the graph of the "
    "encodings; forbid with :- what must not be",
    ASTType.Program: "#program, expected rules: parts are not solved",
    ASTType.External: "#external, expected rules: nothing sets such an atom, so it would never hold; a "
    "choice rule leaves an atom open",
    ASTType.TheoryDefinition: f"#theory, expected rules: {_THEORY}",
    ASTType.TheoryAtom: f"a theory atom, expected rules: {_THEORY}",
}
# Statements that replaced encodings may not have either, since clingo would ignore them.
_LOST = (ASTType.Program, ASTType.External, ASTType.TheoryDefinition, ASTType.TheoryAtom)
_CODES = {ASTType.Minimize: "minimize", ASTType.Program: "program-part"}

# A message of clingo: file, line and column, its kind, and its first line.
_MESSAGE = re.compile(r"(?P<file>.+?):(?P<line>\d+):(?P<column>\d+)[-:\d]*: (?P<kind>\w+): (?P<text>.*)")
_NEGATIVE = re.compile(r"-\d+(,|$)")  # the weight of an element
_EQUALITIES = {ComparisonOperator.Equal, ComparisonOperator.NotEqual}
_NON_NUMERIC = {AggregateFunction.Min, AggregateFunction.Max}  # aggregates over terms of any type
_EXAMPLE = ':- use(U), motion(U,"fry").'
_IDENTIFIER = re.compile(r"[a-z][A-Za-z0-9_]*")


@dataclass
class Encoding:
    """A parsed file or text of rules: the predicates that it defines and uses, and its constants.

    The name of a negated atom (``-p``) begins with a minus. Each place is that of the first occurrence. In
    rules without a file, the name of the rules stands for the file.

    Attributes:
        rules: The file or text.
        defined: Signatures of atoms in heads, with places.
        declared: Signatures under ``#defined``, with places.
        used: Signatures of atoms in bodies, with places.
        names: Names of constants and functions in terms, with places.
        constants: Values of ``#const`` statements by name, as written.
        constant_sources: Places of ``#const`` statements by name.
        special: Types of the statements and atoms that a constraint may not have, with places.
        assigns: Whether a variable may get its value from an aggregate (``N = #count {...}``).
        text: All statements as clingo prints them.
        statements: All statements, in order.
    """

    rules: Loaded
    defined: dict[Signature, Source] = field(default_factory=dict)
    declared: dict[Signature, Source] = field(default_factory=dict)
    used: dict[Signature, Source] = field(default_factory=dict)
    names: dict[str, Source] = field(default_factory=dict)
    constants: dict[str, str] = field(default_factory=dict)
    constant_sources: dict[str, Source] = field(default_factory=dict)
    special: list[tuple[ASTType, Source]] = field(default_factory=list)
    assigns: bool = False
    text: str = ""
    statements: list[AST] = field(default_factory=list)

    def first_argument_names(self, signatures: Collection[Signature]) -> Iterator[tuple[str, str]]:
        """Yield the predicate name and the first argument of each atom whose signature is in ``signatures``.

        There may be repeats. The first argument is empty if it is no name, but a variable or text, for
        example. Atoms in heads and bodies count, but none with a minus or a pool.
        """
        symbols = (
            node.symbol for statement in self.statements for node in nodes(statement) if _is_atom(node)
        )
        for symbol in symbols:
            if (symbol.name, len(symbol.arguments)) in signatures:
                argument = symbol.arguments[0]
                is_name = (
                    argument.ast_type == ASTType.SymbolicTerm and argument.symbol.type is SymbolType.Function
                )
                yield symbol.name, argument.symbol.name if is_name else ""

    @property
    def definitions(self) -> list[AST]:
        """The ``#const`` statements."""
        return [statement for statement in self.statements if statement.ast_type == ASTType.Definition]

    def predicates_with_argument(self, constant: str) -> set[Signature]:
        """Return the predicates that rules derive with a given constant as argument.

        Only rules whose head is a single atom are searched.
        """
        heads = (rule.head for rule in self.statements if rule.ast_type == ASTType.Rule)
        atoms = (
            head.atom.symbol for head in heads if head.ast_type == ASTType.Literal and _is_atom(head.atom)
        )
        return {(atom.name, len(atom.arguments)) for atom in atoms if constant in map(str, atom.arguments)}

    def remark(self, severity: Severity, code: str, message: str, source: Source) -> Diagnostic:
        """Return a diagnostic about a place in these rules, with its source line."""
        return located_diagnostic(severity, code, message, source, [self.rules])


def _is_atom(node: AST) -> bool:
    """Whether a node is an atom without a minus before it, and without a pool."""
    return node.ast_type == ASTType.SymbolicAtom and node.symbol.ast_type == ASTType.Function


def read_encoding(rules: Loaded) -> Encoding:
    """Parse an encoding and the files that it includes.

    Raises :class:`InputError` for a syntax error, and for a text or file that
    :mod:`foon_asp.encoding.encoding_file` refuses. Raises :class:`UserError` for a missing file, for a text
    without rules, and if clingo included a file that was not checked.
    """
    encoding = Encoding(rules)
    collector = _Collector(encoding)
    included: set[str] = set()
    kinds: set[ASTType] = set()

    def collect(statement: AST) -> None:
        """Pass a statement to the collector; record the name of its file, and its kind."""
        included.add(statement.location.begin.filename)
        kinds.add(statement.ast_type)
        collector.collect(statement)

    if isinstance(rules, Stated):
        check_text(rules.text, rules.place)
        checked: set[Path] = set()
    elif rules.is_file():
        checked = {file.resolve() for file in included_files(rules)}
    else:
        raise UserError(f"{rules}: no such file; expected an encoding (.lp)")
    messages: list[str] = []
    try:
        parse(rules, collect, listener(messages))
    except RuntimeError as error:
        raise program_fault(messages, str(error), [rules]) from None
    if isinstance(rules, Stated):
        if not kinds - {ASTType.Program, ASTType.Comment}:
            raise UserError(f"{rules.place}: found {rules.text!r}, expected a rule such as {_EXAMPLE}")
        return encoding
    unchecked_files = sorted(file for file in included if Path(file).resolve() not in checked)
    if unchecked_files:
        raise UserError(f"{rules} includes {unchecked_files[0]}, which was not checked: leave that out")
    return encoding


class _Collector(Transformer):
    """Visitor that records in ``encoding`` what statements define and use: atoms, names and constants."""

    def __init__(self, encoding: Encoding) -> None:
        """Keep the encoding in which to record; begin outside heads."""
        self.encoding = encoding
        self._in_head = False

    def collect(self, statement: AST) -> None:
        """Record a statement: its text, its place if its kind is refused, and what it defines and uses."""
        encoding = self.encoding
        encoding.text += f"{statement}\n"
        encoding.statements.append(statement)
        kind = statement.ast_type
        source = _source(statement.location)
        if kind == ASTType.Program:
            if statement.name != "base" or statement.parameters:
                encoding.special.append((kind, source))
            for name in (statement.name, *(parameter.name for parameter in statement.parameters)):
                encoding.names.setdefault(name, source)
            return
        if kind in _REFUSED:
            encoding.special.append((kind, source))
        if kind == ASTType.Definition:
            encoding.constants[statement.name] = str(statement.value)
            encoding.constant_sources.setdefault(statement.name, source)
            self.visit(statement.value)
        elif kind == ASTType.Defined:
            name = statement.name if statement.positive else f"-{statement.name}"
            encoding.declared.setdefault((name, statement.arity), source)
        elif kind != ASTType.TheoryDefinition:
            self.visit(statement)

    def visit_Rule(self, rule: AST) -> AST:  # noqa: N802 (the name clingo looks for)
        """Visit a rule; record the atoms in its head as defined, and the atoms in its body as used."""
        self._visit_head(rule.head)
        self.visit_sequence(rule.body)
        return rule

    def visit_External(self, external: AST) -> AST:  # noqa: N802
        """Visit ``#external``; record its atom as defined, and the atoms in its body as used."""
        self._visit_head(external.atom)
        self.visit_sequence(external.body)
        return external

    def visit_ConditionalLiteral(self, literal: AST) -> AST:  # noqa: N802
        """Visit a conditional literal; atoms in its condition are recorded as used, even in a head."""
        in_head, self._in_head = self._in_head, False
        self.visit_sequence(literal.condition)
        self._in_head = in_head
        self.visit(literal.literal)
        return literal

    def visit_SymbolicAtom(self, atom: AST) -> AST:  # noqa: N802
        """Record the signature of an atom."""
        self._record_atom(atom.symbol, "")
        return atom

    def _record_atom(self, symbol: AST, sign: str) -> None:
        """Record the signature of an atom, or of each atom in a pool, and visit its arguments.

        It is recorded as defined or used, with its first place. ``sign`` is ``-`` for an atom after a minus,
        else empty.
        """
        if symbol.ast_type == ASTType.UnaryOperation:  # classical negation: -p(X)
            self._record_atom(symbol.argument, "" if sign else "-")
        elif symbol.ast_type == ASTType.Pool:  # p(1;2)
            for argument in symbol.arguments:
                self._record_atom(argument, sign)
        else:
            signature = sign + symbol.name, len(symbol.arguments)
            first_places = self.encoding.defined if self._in_head else self.encoding.used
            first_places.setdefault(signature, _source(symbol.location))
            self.visit_sequence(symbol.arguments)

    def visit_Function(self, function: AST) -> AST:  # noqa: N802
        """Record the name of a function in a term, and visit its arguments."""
        self.encoding.names.setdefault(function.name, _source(function.location))
        self.visit_sequence(function.arguments)
        return function

    def visit_SymbolicTerm(self, term: AST) -> AST:  # noqa: N802
        """Record a term that is a name, such as a constant."""
        if term.symbol.type is SymbolType.Function:
            self.encoding.names.setdefault(term.symbol.name, _source(term.location))
        return term

    def visit_TheoryAtom(self, atom: AST) -> AST:  # noqa: N802
        """Record a theory atom as special, and do not visit it."""
        self.encoding.special.append((ASTType.TheoryAtom, _source(atom.location)))
        return atom

    def visit_BodyAggregate(self, aggregate: AST) -> AST:  # noqa: N802
        """Visit an aggregate, and record whether it may give a variable its value."""
        self._record_assignment(aggregate)
        return aggregate.update(**self.visit_children(aggregate))

    def visit_Aggregate(self, aggregate: AST) -> AST:  # noqa: N802
        """Visit an aggregate ``{ ... }``; in a body, record whether it may give a variable its value."""
        if not self._in_head:
            self._record_assignment(aggregate)
        return aggregate.update(**self.visit_children(aggregate))

    def _record_assignment(self, aggregate: AST) -> None:
        """Set ``assigns`` if an aggregate may give a variable its value, as in ``N = #count {...}``."""
        guard = aggregate.left_guard
        if guard is not None and guard.comparison == ComparisonOperator.Equal:
            self.encoding.assigns |= guard.term.ast_type != ASTType.SymbolicTerm

    def _visit_head(self, head: AST) -> None:
        """Visit a head; atoms in it are recorded as defined."""
        self._in_head = True
        self.visit(head)
        self._in_head = False


def _source(location: Location) -> Source:
    """Return the place where a location of clingo begins."""
    return Source(location.begin.filename, location.begin.line, location.begin.column)


def check_encodings(
    added: Sequence[Encoding], base: Sequence[Encoding], others: Sequence[Encoding] = ()
) -> list[Diagnostic]:
    """Check the user's rules: constraints in ``added``, and files in ``base`` that replace built-in ones.

    Ready-made constraints among ``added``, and built-in files among ``base``, are not searched for errors.
    ``others`` are further built-in files that are loaded.

    Return two kinds of warnings:

    - A predicate in a body of ``added`` is not defined anywhere; the most similar one is suggested.
    - A term in the user's constraints is compared with numbers, but can never be a number.

    Raises :class:`InputError` for statements that would change the set of trees or their order, or that
    clingo would ignore silently:

    - rules for built-in predicates,
    - reserved names,
    - constants that replace a name elsewhere,
    - statements other than rules.
    """
    errors: list[Diagnostic] = []
    defined = set(PUBLIC)
    for encoding in (*added, *base, *others):
        defined |= encoding.defined.keys() | encoding.declared.keys()
    user_files = [encoding for encoding in added if not _is_built_in(encoding.rules)]
    replaced = [encoding for encoding in base if not _is_built_in(encoding.rules)]
    for encoding in user_files:
        errors += _statement_errors(encoding, tuple(_REFUSED))
        errors += _definition_errors(encoding, PUBLIC.union(*(file.defined for file in base)))
        errors += _reserved_name_errors(encoding)
    for encoding in replaced:
        errors += _statement_errors(encoding, _LOST)
        errors += _replaced_definition_errors(encoding)
    settable = {name for encoding in added if _is_built_in(encoding.rules) for name in encoding.constants}
    for encoding in (*user_files, *replaced):
        names = set(settable)
        if encoding in user_files:
            for file in replaced:
                names |= file.names.keys() | {name for name, _ in (*file.defined, *file.used)}
        errors += _constant_errors(encoding, names)
    if errors:
        raise InputError(errors)
    warnings = [
        encoding.remark(Severity.WARNING, "undefined-atom", undefined_message(signature, defined), source)
        for encoding in added
        for signature, source in encoding.used.items()
        if signature not in defined
    ]
    constants = {name for encoding in (*added, *base, *others) for name in encoding.constants}
    for encoding in user_files:
        for term, message in non_numeric_terms(encoding.statements, constants):
            warnings.append(encoding.remark(Severity.WARNING, "no-number", message, _source(term.location)))
    return warnings


def non_numeric_terms(statements: Iterable[AST], constants: Collection[str]) -> Iterator[tuple[AST, str]]:
    """Yield the terms that are compared with numbers but are no numbers, each with a message.

    In clingo's order, such a term is above every number. It is either a name that no ``#const`` statement
    sets, or a text as guard of a count or sum. The names that ``#const`` statements set are in ``constants``.
    Comparisons with only ``=`` and ``!=`` are ignored.
    """
    for node in (node for statement in statements for node in nodes(statement)):
        terms: list[AST] = []
        refuses_texts = False
        if node.ast_type == ASTType.Comparison:
            if not _EQUALITIES.issuperset(guard.comparison for guard in node.guards):
                terms = [node.term, *(guard.term for guard in node.guards)]
        elif node.ast_type == ASTType.Aggregate or (
            node.ast_type == ASTType.BodyAggregate and node.function not in _NON_NUMERIC
        ):
            terms = [guard.term for guard in (node.left_guard, node.right_guard) if guard is not None]
            refuses_texts = True
        for term in terms:
            if term.ast_type != ASTType.SymbolicTerm:
                continue
            kind = term.symbol.type
            if kind is SymbolType.Function and term.symbol.name not in constants:
                yield term, f"found {term}, which is above every number; set it, as in #const {term} = 3."
            elif kind is SymbolType.String and refuses_texts:
                yield term, f"found the text {term}, which is above every number: leave out the quotes"


@cache
def _is_built_in(rules: Loaded) -> bool:
    """Whether rules are a built-in encoding, or a ready-made constraint as file or with constants set.

    The folder of the file decides, so a changed built-in file is still built-in. The result is cached.
    """
    path = rules.file if isinstance(rules, Stated) else rules
    return path is not None and path.resolve().is_relative_to(encodings_folder().resolve())


def _statement_errors(encoding: Encoding, refused: Sequence[ASTType]) -> list[Diagnostic]:
    """Return an error for each statement of a refused kind."""
    return [
        encoding.remark(Severity.ERROR, _CODES.get(kind, "statement"), f"found {_REFUSED[kind]}", source)
        for kind, source in encoding.special
        if kind in refused
    ]


def _definition_errors(encoding: Encoding, owned: frozenset[Signature]) -> list[Diagnostic]:
    """Return an error for each predicate that rules define although a constraint may not.

    A constraint may not define predicates in ``owned``, which has the facts and the built-in predicates. It
    may not define predicates with a reserved name either. A minus before an atom is ignored.
    """
    return [
        encoding.remark(
            Severity.ERROR,
            "owned-predicate",
            f"found a rule for {name}/{arity}, which a constraint may not define: give it "
            "another name, or edit a copy of the encodings and pass its folder with --encodings",
            source,
        )
        for (name, arity), source in encoding.defined.items()
        if (name.lstrip("-"), arity) in owned or _is_reserved(name)
    ]


def _reserved_name_errors(encoding: Encoding) -> list[Diagnostic]:
    """Return errors for reserved names in bodies, ``#defined`` and terms of a constraint.

    The predicate ``_by_person/1`` is allowed.
    """
    atoms = [
        (f"{name}/{arity}", source)
        for sources in (encoding.used, encoding.declared)
        for (name, arity), source in sources.items()
        if _is_reserved(name) and (name, arity) not in _LOOKED_AT
    ]
    terms = [(name, source) for name, source in encoding.names.items() if _is_reserved(name)]
    return [
        encoding.remark(
            Severity.ERROR,
            "reserved-name",
            f"found {name}, but names that begin with {_PREFIX!r} are reserved: give it another name",
            source,
        )
        for name, source in (*atoms, *terms)
    ]


def _replaced_definition_errors(encoding: Encoding) -> list[Diagnostic]:
    """Return an error for each reserved predicate in a head of a file that replaces a built-in one.

    A predicate is allowed if a built-in file of the same name defines it, also one in the folder ``by_need``.
    """
    name = encoding.rules.name if isinstance(encoding.rules, Path) else ""
    built_in_files = [
        file for file in (encodings_folder() / name, encodings_folder() / "by_need" / name) if file.is_file()
    ]
    built_in_predicates = {signature for file in built_in_files for signature in read_encoding(file).defined}
    return [
        encoding.remark(
            Severity.ERROR,
            "owned-predicate",
            f"found a rule for {predicate}/{arity}, but names that begin with {_PREFIX!r} are reserved, and "
            f"the built-in {name} does not define this one: give it another name",
            source,
        )
        for (predicate, arity), source in encoding.defined.items()
        if _is_reserved(predicate) and (predicate, arity) not in built_in_predicates
    ]


def _constant_errors(encoding: Encoding, names: set[str]) -> list[Diagnostic]:
    """Return errors for constants with a reserved name, or with a name in the facts or in another file.

    In the facts or the other file, the value of the constant would replace the name. ``names`` are the names
    in other files.
    """
    return [
        encoding.remark(
            Severity.ERROR,
            "taken-constant",
            f"found #const {name}, but that is a name in the facts or in other encodings, where its value "
            "would replace it: give the constant another name",
            source,
        )
        for name, source in encoding.constant_sources.items()
        if _is_reserved(name) or name in PUBLIC_NAMES or name in names
    ]


def _is_reserved(name: str) -> bool:
    """Whether a name begins with ``_``, perhaps after a minus."""
    return name.lstrip("-").startswith(_PREFIX)


def undefined_message(signature: Signature, defined: set[Signature]) -> str:
    """Return the message that a predicate is undefined, with a suggestion from ``defined``.

    The suggestion is a predicate of the same name, or else of the most similar name. If no name is similar,
    the message refers to the list of predicates.
    """
    name, arity = signature
    message = f"no rule or fact defines {name}/{arity}, so it never holds"
    same_name = sorted(n for defined_name, n in defined if defined_name == name)
    if same_name:
        return message + f"; did you mean {name}/{same_name[0]}?"
    nearest = difflib.get_close_matches(
        name, sorted({defined_name for defined_name, _ in defined}), n=1, cutoff=0.5
    )
    if not nearest:
        return message + "; the predicates are listed in encodings/README.md"
    arities = {n for defined_name, n in defined if defined_name == nearest[0]}
    return message + f"; did you mean {nearest[0]}/{min(arities, key=lambda n: (abs(n - arity), n))}?"


def constant_arguments(constants: Sequence[str], encodings: Sequence[Encoding]) -> list[str]:
    """Return settings ``NAME=VALUE`` as arguments of clingo: ``-c`` and ``NAME=VALUE`` by turns.

    Each value gets the type of the default in its ``#const``. If the default is a string, the value may be
    given with or without quotes. If the default is a number, the value has to be an integer of 32 bits.

    Raises :class:`UserError` for a setting of another form, an unknown name, and a value of another type.
    Also raises it for a constant that only a ready-made constraint with its own values has.
    """
    defaults = {
        name: value
        for encoding in encodings
        for name, value in encoding.constants.items()
        if not _is_reserved(name)  # that of a ready-made constraint with constants of its own
    }
    arguments: list[str] = []
    for setting in constants:
        name, equals, value = setting.partition("=")
        if not equals:
            raise UserError(f"found the constant {setting!r}, expected NAME=VALUE")
        if name not in defaults:
            for rules in (encoding.rules for encoding in encodings):
                if isinstance(rules, Stated) and name in dict(rules.renamed).values():
                    raise UserError(
                        f"found a value of the constant {name!r}, but {rules.written} has values of its own: "
                        "set it there"
                    )
            listed = ", ".join(sorted(defaults)) or "none: add a constraint with #const"
            raise UserError(f"no encoding in use has the constant {name!r}; known are {listed}")
        arguments += ["-c", f"{name}={constant_value(name, defaults[name], value)}"]
    return arguments


def constant_value(name: str, default: str, value: str) -> str:
    """Return a value of a constant as a term, of the type of its default.

    If the default is a string, the value gets quotes, unless it has them. If the default is a word, the value
    may be a word or a whole number. The defaults ``#sup`` and ``#inf`` count as numbers. Zeros before a
    number are dropped. Raises :class:`UserError` for a value of another type.
    """
    if default.startswith('"'):
        return quote(string_constant(value))
    if _is_number(default) and not _is_int32(value):
        raise UserError(f"found {value!r} for the constant {name!r}, expected a whole number of 32 bits")
    if not _is_number(default) and not (_is_int32(value) or _IDENTIFIER.fullmatch(value)):
        raise UserError(f"found {value!r} for the constant {name!r}, expected a whole number or a word")
    return str(int(value)) if _is_int32(value) else value  # clingo reads no 007


def unset_constant_warnings(added: Sequence[Encoding], constants: Sequence[str]) -> list[str]:
    """Return a warning for each constant that is not set, so that its constraint in ``added`` has no effect.

    Such a constant has the default ``""``, ``#sup`` or ``#inf``, and is not set by ``constants``, which are
    settings ``NAME=VALUE``.

    There is no warning if facts can replace the constant. For example, a rule derives
    ``allergen(forbidden_ingredient)`` from a constant, and another file has the fact ``allergen("milk").``
    """
    settings_given = {setting.partition("=")[0] for setting in constants}
    warnings = []
    for encoding in added:
        rules = encoding.rules
        defined_elsewhere = {
            signature
            for other_encoding in added
            if other_encoding is not encoding
            for signature in other_encoding.defined
        }
        for name, value in encoding.constants.items():
            if (
                value not in {'""', "#sup", "#inf"}
                or name in settings_given
                or encoding.predicates_with_argument(name) & defined_elsewhere
            ):
                continue
            if isinstance(rules, Stated) and rules.file is not None:
                shown_name = dict(rules.renamed)[name]
                origin = f"{rules.file} ({rules.written})"
                advice, empty = re.subn(
                    rf"(?<=[:,]){shown_name}=(?=,|$)", f"{shown_name}=VALUE", rules.written
                )
                advice = advice if empty else f"{rules.written},{shown_name}=VALUE"
            else:
                origin = rules.place if isinstance(rules, Stated) else f"{rules}"
                shown_name, advice = name, f"-c {name}=VALUE"
            warnings.append(
                f"{origin}: warning: the constant {shown_name} is not set and the constraint has no effect; "
                f"set it with {advice}"
            )
    return warnings


def _is_number(value: str) -> bool:
    """Whether a default is a whole number, ``#sup`` or ``#inf``."""
    return value in {"#sup", "#inf"} or value.lstrip("-").isdigit()


def _is_int32(value: str) -> bool:
    """Whether a text is a decimal whole number that clingo can represent."""
    return bool(re.fullmatch(r"-?\d{1,10}", value, re.ASCII)) and abs(int(value)) <= LARGEST


def program_fault(
    messages: Sequence[str], otherwise: str, files: Sequence[Loaded] = ()
) -> InputError | UserError:
    """Return clingo's messages about a program as one error for the user.

    If a message has a place, the error is :class:`InputError`, with places and source lines. Otherwise it is
    :class:`UserError` with the text of the messages. Without messages, the text is ``otherwise``, that of
    clingo's exception. Of several messages about one place, only the first is kept. ``files`` are the files
    and texts of the program; source lines are looked up in them.
    """
    errors: dict[Source, Diagnostic] = {}
    for message in messages:
        main_match, *note_matches = (_MESSAGE.match(line) for line in message.strip().split("\n"))
        if main_match is None:
            continue
        matches = [main_match]
        details = [line.strip() for line in message.strip().split("\n")[1:]]
        if main_match["text"].startswith("unsafe variables"):
            matches = list(filter(None, note_matches))
        for match in matches:
            if match is not main_match:
                text = f"the variable {match['text'].split()[0]} is unsafe: no literal of the body binds it"
            elif main_match["kind"] == "error":
                text = " ".join([main_match["text"], *details])
            else:
                text = _dropped_message(main_match["text"].rstrip(":"), " ".join(details))
            source = Source(match["file"], int(match["line"]), int(match["column"]))
            errors.setdefault(source, located_diagnostic(Severity.ERROR, "clingo", text, source, files))
    if errors:
        return InputError(list(errors.values()))
    if "Integer overflow" in otherwise:
        return UserError(
            "a sum in the encodings or of weights can be larger than clingo's numbers, which have 32 bits: "
            "use smaller numbers"
        )
    return UserError("".join(messages).strip() or otherwise)


def _dropped_message(message: str, term: str) -> str:
    """Return a message for the user that clingo would drop an instance of a rule or aggregate element.

    ``message`` is the reason as clingo states it, and ``term`` the term that it names.
    """
    no_value = f"a term has no value here: {term.removeprefix('(').removesuffix(')')}"
    if message == "tuple ignored" and _NEGATIVE.match(term):
        return (
            f"the weight in {term} is below 0, which #sum+ counts as nothing; clingo would leave this out "
            "silently: use #sum, or a condition that keeps such weights out"
        )
    reason = {
        "operation undefined": no_value,
        "interval undefined": no_value,
        "tuple ignored": f"the weight in {term} is not a number",
    }.get(message, f"{message} {term}".strip())
    return (
        f"{reason}; clingo would leave this out silently: calculate with whole numbers only, and do "
        "not divide by 0"
    )


def located_diagnostic(
    severity: Severity, code: str, message: str, source: Source, files: Sequence[Loaded] = ()
) -> Diagnostic:
    """Return a diagnostic with its source line, found in ``files`` or in the file of ``source``.

    In a ready-made constraint with constants of its own, the place becomes the place in its file. The message
    then gets the text of the option. A place after the end of a text is moved to the end.
    """
    for rules in files:
        if isinstance(rules, Stated) and rules.place == source.file:
            lines = rules.text.split("\n")
            if source.line > len(lines):  # clingo means the end
                source = source._replace(line=len(lines), column=len(lines[-1]) + 1)
                message += "" if rules.text.rstrip().endswith(".") else "; a rule ends in a full stop"
            if rules.file is not None:
                source = source._replace(file=str(rules.file))
                message = f"{message} (in {rules.written})"
            return Diagnostic(severity, code, message, source, lines[source.line - 1].rstrip("\r"))
    return Diagnostic(severity, code, message, source, source_line(source))
