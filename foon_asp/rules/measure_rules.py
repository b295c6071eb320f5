"""Parser and checker of user measures: rules for the cost of one unit at a time.

The rules are evaluated for each unit in a *world*, which has only the facts about this unit and its object
nodes. So the cost of a unit cannot depend on the question, the tree or another unit. In the program for
clingo, a predicate ``p`` that depends on such facts becomes ``_p`` with the world as first argument. Tables,
which depend on no facts, are not changed.
"""

from collections.abc import Iterable, Iterator, Sequence
from functools import lru_cache
from graphlib import CycleError, TopologicalSorter
from typing import NamedTuple

from clingo.ast import (
    AST,
    AggregateFunction,
    ASTType,
    BinaryOperator,
    Function,
    Literal,
    Sign,
    SymbolicAtom,
    Transformer,
    Variable,
    parse_string,
)
from clingo.symbol import SymbolType

from foon_asp.encoding.encoding import (
    PUBLIC_NAMES,
    Signature,
    located_diagnostic,
    non_numeric_terms,
    program_fault,
    undefined_message,
)
from foon_asp.encoding.encoding_file import check_text
from foon_asp.encoding.fact_writer import FACT_PREDICATES, OBJECT_FACTS
from foon_asp.encoding.messages import listener
from foon_asp.encoding.parsing import parse
from foon_asp.encoding.stated import Stated
from foon_asp.errors import UserError
from foon_asp.network import Source
from foon_asp.rules.number_limits import overflow_checks
from foon_asp.rules.tuning import TUNING
from foon_asp.rules.worlds import Worlds, unused_variable
from foon_asp.text.diagnostics import Diagnostic, InputError, Severity

COST = ("cost", 3)
WORLD = "__world"
BEYOND = "_beyond"  # the cost of a unit where rules calculate with numbers beyond those of clingo
# Predicates that a rule cannot read, since they are not about one unit, and the reason.
_DIFFERS_BY_TREE = (
    "differs from tree to tree, and what a unit costs does not: a price for what a tree does is a soft "
    "constraint (--soft), another way to measure trees an edited copy of objectives.lp (--encodings)"
)
_QUESTION = "differs from question to question, and what a unit costs does not"
_REFUSED = {
    ("use", 1): _DIFFERS_BY_TREE,
    ("available", 1): _DIFFERS_BY_TREE,
    ("times", 2): _DIFFERS_BY_TREE,
    ("kitchen", 1): _QUESTION,
    ("goal", 1): _QUESTION,
    ("optimize", 2): _QUESTION,
    ("price", 2): "is there only where it is exact: list the objective price too, or give costs in a table",
    ("risk", 2): "is rounded for a question: read rate/2, in millionths",
    COST: "is rounded for a question: read the facts that it is made of",
}
_UNIT_OBJECT_FACTS = frozenset(("input", "output", "needs", "gives"))
_UNIT, _OBJECT = "unit", "object"


class Statement(NamedTuple):
    """A statement of the program for clingo: its text, its place in the user's rules, and its kind.

    ``is_cost``: whether its head is a cost.
    """

    text: str
    source: Source
    is_cost: bool


class MeasureRules(NamedTuple):
    """Rules of measures, translated for clingo.

    ``names``: the names of the measures, each with the place of its first occurrence.
    ``statements``: the program for clingo, one statement per line.
    ``reads``: the names of the predicates of facts that the rules read.
    ``nameless``: whether units cost the same if their facts differ only in numbers of units and object nodes.
    ``plain``: whether each rule has few ground instances: no interval or division, at most one table,
    and few atoms.
    """

    names: dict[str, Source]
    statements: tuple[Statement, ...]
    reads: frozenset[str]
    nameless: bool
    plain: bool


@lru_cache(maxsize=64)
def read_rules(text: str, origin: str) -> MeasureRules:
    """Parse and check the rules of measures; the results for the last 64 texts are cached.

    ``origin`` is the name of the text in messages. Raises :class:`InputError` for a syntax error, and for
    rules that are not about one unit at a time. Raises :class:`UserError` if the text defines no measure.
    """
    check_text(text, origin)
    stated = Stated(origin, text)
    statements: list[AST] = []
    messages: list[str] = []
    try:
        parse(stated, statements.append, listener(messages))
    except RuntimeError as error:
        raise program_fault(messages, str(error), [stated]) from None
    return _MeasureReader(statements, stated).rules()


class _MeasureReader:
    """Checker of the rules of measures, and their translator for clingo.

    The checks collect errors in ``_errors``, so that one exception has all of them.
    """

    def __init__(self, statements: Sequence[AST], stated: Stated) -> None:
        """Sort the statements; raises :class:`InputError` for statements that are not allowed."""
        self._stated = stated
        self._errors: list[Diagnostic] = []
        self._rules: list[AST] = []
        self._constants: list[AST] = []
        declared: set[Signature] = set()
        for statement in statements:
            kind = statement.ast_type
            if kind is ASTType.Rule:
                self._rules.append(statement)
            elif kind is ASTType.Definition:
                self._constants.append(statement)
            elif kind is ASTType.Defined:
                declared.add((statement.name, statement.arity))
            elif not (kind in _HARMLESS or (kind is ASTType.Program and statement.name == "base")):
                self._add_error_at(
                    "statement", "found a statement that is no rule, expected rules", statement
                )
        self._atoms = [_Atoms(rule) for rule in self._rules]
        self._declared = declared
        self._raise_errors()

    def rules(self) -> MeasureRules:
        """Return the rules translated for clingo; raises :class:`InputError` if a check finds an error."""
        names: dict[str, Source] = {}
        for rule, atoms in zip(self._rules, self._atoms, strict=True):
            self._check_head(rule, atoms, names)
            self._check_atoms(atoms)
        self._check_names(names)
        self._check_numbers()
        self._check_loops()
        self._raise_errors()
        dependent = self._dependent_predicates()
        world = unused_variable(self._stated.text, "W")
        statements = [_WorldWriter(dependent, world).write(rule, self._source(rule)) for rule in self._rules]
        statements += self._overflow_rules(names, dependent, world)
        constants = [
            Statement(f"{definition}", self._source(definition), False) for definition in self._constants
        ]
        return MeasureRules(
            names,
            (*constants, *statements),
            frozenset(name for name, _ in self._facts_read()),
            _is_nameless(self._atoms),
            all(self._has_small_grounding(atoms, dependent) for atoms in self._atoms),
        )

    def _overflow_rules(
        self, names: Iterable[str], dependent: frozenset[Signature], world: str
    ) -> Iterator[Statement]:
        """Yield rules that derive the cost ``BEYOND`` where arithmetic overflows 32 bits in clingo.

        ``names`` are the measures. ``dependent`` are the predicates that get a world as argument; ``world``
        is the variable for it.
        """
        statements: list[AST] = []
        sources: list[Source] = []
        for name in names:
            for rule, text in overflow_checks(self._rules, f"cost({name},{world},{BEYOND})".format):
                before = len(statements)
                parse_string(text, statements.append)
                sources += [self._source(rule)] * (len(statements) - before)
        rules = [
            (rule, source)
            for rule, source in zip(statements, sources, strict=True)
            if rule.ast_type is ASTType.Rule
        ]
        writer = _WorldWriter(dependent, world)
        yield from (writer.write(rule, source) for rule, source in rules)

    def _check_head(self, rule: AST, atoms: "_Atoms", names: dict[str, Source]) -> None:
        """Add an error for a head that is not one atom of a permitted predicate.

        Also add an error for a cost whose first argument is no name. Each measure that the head names is
        added to ``names``, with its place.
        """
        head = rule.head
        if head.ast_type is not ASTType.Literal or head.sign != Sign.NoSign:
            self._add_error_at(
                "head", "found a choice or a disjunction, expected a rule with one atom in its head", rule
            )
        elif head.atom.ast_type is not ASTType.SymbolicAtom:
            message = "found a constraint, expected a rule for what units cost: pass it with --constraint"
            self._add_error_at("head", message, rule)
        for atom in atoms.heads:
            name, arity = _signature(atom)
            if (name, arity) == COST:
                term = atom.arguments[0]
                symbol = term.symbol if term.ast_type is ASTType.SymbolicTerm else None
                if symbol is None or symbol.type is not SymbolType.Function or symbol.arguments:
                    message = f"found cost({term},...), expected the name of a measure: cost(mine,U,N)"
                    self._add_error_at("measure-name", message, atom)
                else:
                    names.setdefault(symbol.name, self._source(atom))
            elif FACT_PREDICATES.get(name) == arity or (name, arity) in _REFUSED:
                self._add_error_at(
                    "owned-predicate", f"found a rule for {name}/{arity}: give it another name", atom
                )

    def _check_atoms(self, atoms: "_Atoms") -> None:
        """Add errors for atoms that are negated with a minus, reserved, undefined or not about one unit."""
        for minus in atoms.negated:
            self._add_error_at(
                "negation", "found an atom with a minus before it, expected one without", minus
            )
        for atom in (*atoms.heads, *atoms.used):
            if atom.name.startswith("_"):
                message = f"found {atom.name}, but names that begin with '_' are reserved: take another"
                self._add_error_at("reserved-name", message, atom)
        defined = {
            _signature(atom) for rule_atoms in self._atoms for atom in rule_atoms.heads
        } | self._declared
        readable = {(name, arity) for name, arity in FACT_PREDICATES.items()} - _REFUSED.keys()
        for atom in atoms.used:
            signature = _signature(atom)
            predicate = "{}/{}".format(*signature)
            if signature in _REFUSED:
                self._add_error_at("not-of-a-unit", f"found {predicate}, which {_REFUSED[signature]}", atom)
            elif signature not in defined | readable and not atom.name.startswith("_"):
                self._add_error_at("undefined-atom", undefined_message(signature, defined | readable), atom)

    def _check_names(self, names: dict[str, Source]) -> None:
        """Add errors for measures and constants with a reserved name, or with a name that facts use.

        Also add an error for a constant with the name of a measure. Raises :class:`UserError` if the rules
        define no measure and have no other error.
        """
        for name, source in names.items():
            if name in PUBLIC_NAMES or name.startswith("_"):
                message = f"found a measure {name!r}, which is a name of ours: give it another one"
                self._add_error("measure-name", message, source)
        for definition in self._constants:
            if definition.name in PUBLIC_NAMES or definition.name in names or definition.name.startswith("_"):
                message = (
                    f"found #const {definition.name}, but that is a name in the facts: give it another one"
                )
                self._add_error_at("taken-constant", message, definition)
        if not names and not self._errors:
            raise UserError(
                f"{self._stated.place}: expected rules for what units cost, such as "
                'cost(mine,U,5) :- unit(U), motion(U,"pour").'
            )

    def _check_numbers(self) -> None:
        """Add errors for comparisons of a number with a term that is never a number.

        Also add errors for heads ``cost`` that do not have 3 arguments.
        """
        for term, message in non_numeric_terms(
            self._rules, [definition.name for definition in self._constants]
        ):
            self._add_error_at("no-number", message, term)
        for atom in (head for atoms in self._atoms for head in atoms.heads):
            if atom.name == COST[0] and _signature(atom) != COST:
                self._add_error_at("head", f"found {atom}, expected a cost such as cost(mine,U,5)", atom)

    def _check_loops(self) -> None:
        """Add an error for the first recursive predicate: its atoms may be infinitely many, or undefined."""
        graph: dict[Signature, set[Signature]] = {}
        for atoms in self._atoms:
            for head in map(_signature, atoms.heads):
                graph.setdefault(head, set()).update(map(_signature, atoms.used))
        try:
            tuple(TopologicalSorter(graph).static_order())
        except CycleError as loop:
            name, arity = loop.args[1][0]
            atom = next(
                head for atoms in self._atoms for head in atoms.heads if _signature(head) == (name, arity)
            )
            message = f"found {name}/{arity}, which depends on itself, expected rules without loops"
            self._add_error_at("loop", message, atom)

    def _facts_read(self) -> Iterator[Signature]:
        """Yield the predicates of facts that the rules read; one may be repeated."""
        derived = {_signature(atom) for rule_atoms in self._atoms for atom in rule_atoms.heads}
        for atoms in self._atoms:
            for signature in map(_signature, atoms.used):
                if FACT_PREDICATES.get(signature[0]) == signature[1] and signature not in derived:
                    yield signature

    def _dependent_predicates(self) -> frozenset[Signature]:
        """Return ``cost/3``, the predicates of facts about units, and all predicates that depend on them.

        The fact ``utensil/1`` is not among them, as it is the same for all units.
        """
        dependent = {COST, *self._facts_read()} - {("utensil", 1)}
        before = 0
        while len(dependent) > before:
            before = len(dependent)
            for atoms in self._atoms:
                if not dependent.isdisjoint(map(_signature, atoms.used)):
                    dependent.update(map(_signature, atoms.heads))
        return frozenset(dependent)

    def _has_small_grounding(self, atoms: "_Atoms", dependent: frozenset[Signature]) -> bool:
        """Whether a rule, given by its atoms, can have only few ground instances for each unit.

        Such a rule has no interval, no division and few atoms. At most one atom is over a table, which is a
        predicate that is not in ``dependent``.
        """
        tables = [atom for atom in atoms.used if _signature(atom) not in dependent]
        return (
            not (atoms.has_interval or atoms.divides)
            and len(tables) < 2
            and len(atoms.used) <= TUNING.plain_atoms
        )

    def _source(self, node: AST) -> Source:
        """Return the place of a node of the syntax tree, in the file or text of the rules."""
        begin = node.location.begin
        return Source(self._stated.place, begin.line, begin.column)

    def _add_error_at(self, code: str, message: str, node: AST) -> None:
        """Add an error at a node of the syntax tree."""
        self._add_error(code, message, self._source(node))

    def _add_error(self, code: str, message: str, source: Source) -> None:
        """Add an error at a place."""
        self._errors.append(located_diagnostic(Severity.ERROR, code, message, source, [self._stated]))

    def _raise_errors(self) -> None:
        """Raise :class:`InputError` with the errors so far, if there are any."""
        if self._errors:
            raise InputError(self._errors)


_HARMLESS = {ASTType.ShowSignature, ASTType.Comment}


def _signature(atom: AST) -> Signature:
    """Return name and arity of an atom."""
    return atom.name, len(atom.arguments)


class _Atoms(Transformer):
    """Visitor that collects the atoms of a rule, as terms, and the use of its variables.

    ``heads``, ``used``: the atoms in the head, and those in the body.
    ``negated``: atoms with a minus before them, which are in neither list.
    ``compared``: the variables that are used other than in tests for equality.
    ``has_interval``: whether the rule has an interval such as ``1..9``.
    ``divides``: whether the rule has a division or remainder; clingo's process crashes at -2147483648 / -1.
    """

    def __init__(self, rule: AST) -> None:
        """Visit the head and the body of a rule."""
        self.heads: list[AST] = []
        self.used: list[AST] = []
        self.negated: list[AST] = []
        self.compared: set[str] = set()
        self.has_interval = False
        self.divides = False
        self._collected = self.heads
        self.visit(rule.head)
        self._collected = self.used
        self.visit_sequence(rule.body)

    def visit_SymbolicAtom(self, atom: AST) -> AST:  # noqa: N802 (the name clingo looks for)
        """Collect an atom, and return it unchanged."""
        self._collect_atom(atom.symbol)
        return atom

    def _collect_atom(self, symbol: AST) -> None:
        """Collect an atom, or each atom of a pool, and visit its arguments."""
        if symbol.ast_type is ASTType.UnaryOperation:
            self.negated.append(symbol)
        elif symbol.ast_type is ASTType.Pool:
            for argument in symbol.arguments:
                self._collect_atom(argument)
        else:
            self._collected.append(symbol)
            self._visit_terms(symbol.arguments)

    def _visit_terms(self, terms: Iterable[AST]) -> None:
        """Visit the arguments of an atom, except its variables: an atom compares these only for equality."""
        for term in terms:
            if term.ast_type is not ASTType.Variable:
                self.visit(term)

    def visit_BodyAggregate(self, aggregate: AST) -> AST:  # noqa: N802
        """Visit an aggregate; its weights are compared, unlike its other terms."""
        weight_count = int(aggregate.function != AggregateFunction.Count)
        for guard in (aggregate.left_guard, aggregate.right_guard):
            if guard is not None:
                self.visit(guard)
        for element in aggregate.elements:
            for term in element.terms[:weight_count]:
                self.visit(term)
            self._visit_terms(element.terms[weight_count:])
            self.visit_sequence(element.condition)
        return aggregate

    def visit_Variable(self, variable: AST) -> AST:  # noqa: N802
        """Add a variable to ``compared``."""
        self.compared.add(variable.name)
        return variable

    def visit_BinaryOperation(self, term: AST) -> AST:  # noqa: N802
        """Set ``divides`` for a division or remainder; visit the operands."""
        self.divides |= term.operator_type in {BinaryOperator.Division, BinaryOperator.Modulo}
        self.visit_children(term)
        return term

    def visit_Interval(self, interval: AST) -> AST:  # noqa: N802
        """Set ``has_interval``, and visit the bounds."""
        self.has_interval = True
        self.visit_children(interval)
        return interval


def _is_nameless(rules: Sequence[_Atoms]) -> bool:
    """Whether rules compare units and object nodes for equality only.

    From the facts and the variables of rules, it is inferred which arguments are units or object nodes.
    Return ``False`` if such an argument is a constant, or if its variable stands for both kinds. Return
    ``False`` also if its variable is compared otherwise, or is a cost.
    """
    kinds: dict[tuple[Signature, int], str] = {(COST, 1): _UNIT}
    for name, arity in FACT_PREDICATES.items():
        if name in OBJECT_FACTS:
            kinds[(name, arity), 0] = _OBJECT
        elif name != "utensil" and (name, arity) not in _REFUSED:
            kinds[(name, arity), 0] = _UNIT
        if name in _UNIT_OBJECT_FACTS:
            kinds[(name, arity), 1] = _OBJECT
    before = 0
    while len(kinds) > before:
        before = len(kinds)
        for rule in rules:
            variables: dict[str, str] = {}
            atoms = (*rule.heads, *rule.used)
            for atom in atoms:
                for position, term in enumerate(atom.arguments):
                    kind = kinds.get((_signature(atom), position))
                    if kind is None or (term.ast_type is ASTType.Variable and term.name == "_"):
                        continue
                    if term.ast_type is not ASTType.Variable or variables.setdefault(term.name, kind) != kind:
                        return False
            for atom in atoms:
                for position, term in enumerate(atom.arguments):
                    if term.ast_type is ASTType.Variable and term.name in variables:
                        kind = variables[term.name]
                        if kinds.setdefault((_signature(atom), position), kind) != kind:
                            return False
            if not rule.compared.isdisjoint(variables):
                return False
    return (COST, 2) not in kinds


class _WorldWriter:
    """Writer of rules that adds a world as first argument to the predicates that depend on facts.

    ``dependent`` are these predicates. ``world`` is a name of a variable that no rule has.
    """

    def __init__(self, dependent: frozenset[Signature], world: str) -> None:
        """Keep the predicates and the variable."""
        self._dependent_predicates, self._world = dependent, world

    def write(self, rule: AST, source: Source) -> Statement:
        """Return a rule as a statement for clingo, with a world if its head depends on facts."""
        heads = _Atoms(rule).heads
        text = str(rule)
        if any(_signature(atom) in self._dependent_predicates for atom in heads):
            changed = Worlds(self._dependent_predicates, self._world).visit(rule)
            location = rule.location
            world = Function(location, WORLD, [Variable(location, self._world)], 0)
            body = [*changed.body, Literal(location, Sign.NoSign, SymbolicAtom(world))]
            text = str(changed.update(body=body))
        return Statement(text, source, any(_signature(atom) == COST for atom in heads))
