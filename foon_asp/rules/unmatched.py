"""Warnings for literals over facts whose constants match nothing in a network: misspellings, lost quotes."""

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import chain, islice, product
from typing import NamedTuple

from clingo.ast import AST, ASTType, ComparisonOperator, Sign
from clingo.symbol import Symbol, SymbolType

from foon_asp.encoding.encoding import Encoding
from foon_asp.encoding.fact_writer import quote
from foon_asp.network import Source
from foon_asp.rules.clause import (
    Aggregate,
    Clause,
    Conditional,
    Conjunct,
    Constants,
    Literal,
    Signature,
    Test,
    clauses,
    constant_values,
    plain_value,
    value,
)
from foon_asp.rules.fact_values import (
    COLUMNS,
    LISTED_FACTS,
    FactValues,
    has_text,
    nearest_text,
    unknown_text_message,
)
from foon_asp.text.diagnostics import Diagnostic, Severity

_Values = Mapping[str, Sequence[Symbol]]  # by variable, where all values are known


class _Unmatched(NamedTuple):
    """A literal that matches no fact, with the warning about it and its place.

    ``clause``: the index of its rule in the file.
    ``head``: the predicate that the rule derives; ``None`` if it derives none.
    ``constants``: the values in the literal.
    ``message``: the text of the warning.
    """

    clause: int
    head: Signature | None
    constants: frozenset[Symbol]
    message: str
    source: Source


def unmatched_warnings(
    user_files: Sequence[Encoding],
    ready_made_files: Sequence[Encoding],
    settings: Sequence[str],
    values: FactValues,
) -> Iterator[Diagnostic]:
    """Yield a warning for each literal over a fact whose constants match nothing in the network.

    Only literals in ``user_files`` get warnings. ``ready_made_files`` are constraints used with them, and
    ``settings`` the constants that are set, as ``NAME=VALUE``.

    A literal gets no warning if another rule in the file has the same head and a matching literal with the
    same constants. For example, one rule looks for a label, the other for an ingredient of this name.

    There are also warnings for facts in user files, such as ``allergen("milk").``, that name nothing in the
    network.
    """
    encodings = (*user_files, *ready_made_files)
    definitions = [statement for encoding in encodings for statement in encoding.definitions]
    constants = constant_values(definitions, settings)
    rules = [
        [list(clauses(rule, 0, constants)) for rule in encoding.statements if rule.ast_type == ASTType.Rule]
        for encoding in encodings
    ]
    programs = [list(chain.from_iterable(of_file)) for of_file in rules]
    search = _Search(list(chain.from_iterable(programs)), constants, values)
    unlisted = _unlisted_warnings(list(chain.from_iterable(programs[: len(user_files)])), constants, values)
    for encoding, program in zip(user_files, programs, strict=False):
        warnings = [(literal.source, literal.message) for literal in search.unmatched(program)]
        clause_ids = set(map(id, program))
        warnings += [(clause.source, text) for clause, text in unlisted if id(clause) in clause_ids]
        for source, message in dict.fromkeys(warnings):
            yield encoding.remark(Severity.WARNING, "unmatched", message, source)


class _Search:
    """A search for literals that match no fact.

    ``program`` has the rules of all files, since facts in one file may bind variables in another.
    """

    def __init__(self, program: Sequence[Clause], constants: Constants, values: FactValues) -> None:
        """Collect the values that facts in the program list."""
        self._constants, self._values = constants, values
        self._listed_values = self._find_listed_values(program)

    def unmatched(self, program: Sequence[Clause]) -> Iterator[_Unmatched]:
        """Return the literals of the rules of one file that match no fact, each with a warning.

        A literal is left out if another rule has the same head and a matching literal with the same
        constants.
        """
        candidates: list[_Unmatched] = []
        matched: defaultdict[tuple[Signature | None, frozenset[Symbol]], set[int]] = defaultdict(set)
        for number, clause in enumerate(program):
            head = clause.head.signature if clause.head is not None else None
            parts = (
                *clause.body,
                *(conjunct for _, condition in clause.head_elements for conjunct in condition),
            )
            for literal, scope in _literals_with_scope(parts, ()):
                rows = self._value_combinations(literal, (*clause.body, *scope))
                constants = frozenset(symbol for row in rows for symbol in row.values())
                if any(self._matches(literal, row) for row in rows):
                    matched[head, constants].add(number)
                elif rows:
                    begin = literal.arguments[next(iter(rows[0]))].location.begin
                    source = Source(begin.filename, begin.line, begin.column)
                    candidates.append(
                        _Unmatched(number, head, constants, self._warning_text(literal, rows), source)
                    )
        return (
            literal
            for literal in candidates
            if not matched[literal.head, literal.constants] - {literal.clause}
        )

    def _value_combinations(
        self, literal: Literal, conjuncts: Iterable[Conjunct]
    ) -> Sequence[Mapping[int, Symbol]]:
        """Return the combinations of values that a literal over a fact requires, by argument position.

        Arguments whose values are unknown are left out. The result is empty if no value is known. It is empty
        also for more than 10,000 combinations; then the literal counts as matched.
        """
        max_combinations = 10_000
        values_by_position = (
            self._argument_values(literal, self._variable_values(conjuncts))
            if literal.signature in COLUMNS
            else {}
        )
        combinations = (
            list(islice(product(*values_by_position.values()), max_combinations + 1))
            if values_by_position
            else []
        )
        if len(combinations) > max_combinations:
            return []
        return [dict(zip(values_by_position, combination, strict=True)) for combination in combinations]

    def _matches(self, literal: Literal, row: Mapping[int, Symbol]) -> bool:
        """Whether some fact has the values in ``row``, by argument position of the literal."""
        wanted = {position: plain_value(symbol) for position, symbol in row.items()}
        return self._values.matches(literal.signature[0], COLUMNS[literal.signature], wanted)

    def _argument_values(self, literal: Literal, bound: _Values) -> dict[int, Sequence[Symbol]]:
        """Return the possible values of arguments, by position.

        ``bound`` has the possible values of variables. An argument is left out if its values are unknown, or
        if it may be an unset constant.
        """
        values_by_position: dict[int, Sequence[Symbol]] = {}
        for position, argument in enumerate(literal.arguments):
            if argument.ast_type == ASTType.Variable:
                symbols = bound.get(argument.name, ())
            else:
                symbol = value(argument, self._constants)
                symbols = () if symbol is None else (symbol,)
            if symbols and all(map(_is_set, symbols)):
                values_by_position[position] = symbols
        return values_by_position

    def _variable_values(self, conjuncts: Iterable[Conjunct]) -> dict[str, Sequence[Symbol]]:
        """Return the possible values of variables under the equations and listed facts of a body."""
        values: dict[str, Sequence[Symbol]] = {}
        for conjunct in conjuncts:
            if isinstance(conjunct, Test) and (equation := _equation(conjunct.ast)) is not None:
                for variable, term in (equation, equation[::-1]):
                    symbol = value(term, self._constants)
                    if variable.ast_type == ASTType.Variable and symbol is not None:
                        values[variable.name] = (symbol,)
            elif isinstance(conjunct, Literal) and conjunct.positive:
                for position, argument in enumerate(conjunct.arguments):
                    symbols = self._listed_values.get((conjunct.signature, position))
                    if symbols and argument.ast_type == ASTType.Variable:
                        values.setdefault(argument.name, symbols)
        return values

    def _find_listed_values(self, program: Sequence[Clause]) -> dict[tuple[Signature, int], Sequence[Symbol]]:
        """Return the values that facts list for predicates without rules, by predicate and position.

        Predicates of the network's facts are left out. An argument is left out if its value in some fact is
        unknown.
        """
        rows: defaultdict[Signature, list[list[Symbol | None]]] = defaultdict(list)
        derived = {
            head.signature for clause in program if clause.body or not clause.plain for head in clause.heads
        }
        for clause in program:
            if clause.head is not None and clause.head.signature not in derived | COLUMNS.keys():
                row = [value(argument, self._constants) for argument in clause.head.arguments]
                rows[clause.head.signature].append(row)
        columns: dict[tuple[Signature, int], Sequence[Symbol]] = {}
        for signature, listed in rows.items():
            for position in range(signature[1]):
                symbols = [row[position] for row in listed]
                if None not in symbols:
                    columns[signature, position] = [
                        symbol for symbol in dict.fromkeys(symbols) if symbol is not None
                    ]
        return columns

    def _warning_text(self, literal: Literal, rows: Sequence[Mapping[int, Symbol]]) -> str:
        """Return the warning about a literal that matches no fact.

        ``rows`` are its combinations of values. The warning names a cause if one is found: an argument of the
        wrong type, or a number that no unit or node has. Otherwise it suggests similar texts of a fact.
        """
        name, columns = literal.signature[0], COLUMNS[literal.signature]
        variables = {
            position: argument.name
            for position, argument in enumerate(literal.arguments)
            if argument.ast_type == ASTType.Variable
        }
        listed = [
            f"{variables[position]} = {' or '.join(_first_three([str(row[position]) for row in rows]))}"
            for position in rows[0]
            if position in variables
        ]
        constant = {
            position: str(symbol) for position, symbol in rows[0].items() if position not in variables
        }
        text = f"nothing in this network matches {_literal_text(literal, constant)}"
        text += f" with {' and '.join(listed)}" if listed else ""
        for position in rows[0]:
            symbol = rows[0][position]
            if position in (*columns.units, *columns.objects) and symbol.type is not SymbolType.Number:
                kind, words = (
                    ("unit", "motion(U") if position in columns.units else ("object node", "label(O")
                )
                variable = words[-1]
                return (
                    f"{text}: {variable} is the number of {'a' if kind == 'unit' else 'an'} {kind} there; "
                    f"{words},{quote(_symbol_text(symbol))}) says which it is"
                )
            if position in (*columns.units, *columns.objects):
                if not self._values.matches(name, columns, {position: symbol.number}):
                    return (
                        f"{text}: no {'unit' if position in columns.units else 'object node'} has that number"
                    )
            elif position in columns.numbers and symbol.type is not SymbolType.Number:
                return f"{text}: a number stands there"
        for row in rows:
            texts = {
                position: _symbol_text(symbol)
                for position, symbol in row.items()
                if position in columns.texts
            }
            meant = self._values.nearest(name, columns, texts) if texts else None
            if meant is not None:
                suggested = {position: quote(word) for position, word in meant.items()}
                arguments = {position: constant.get(position, "") for position in constant} | suggested
                return f"{text}; did you mean {_literal_text(literal, arguments)}?"
        if any(
            row[position].type is not SymbolType.String
            for row in rows
            for position in columns.texts
            if position in row
        ):
            return f"{text}: names are texts, in quotes"
        return text


def _unlisted_warnings(
    program: Sequence[Clause], constants: Constants, values: FactValues
) -> list[tuple[Clause, str]]:
    """Return warnings for user facts such as ``allergen("milk").`` with a name that is not in the network.

    Each warning comes with the clause of the fact. If some fact of a predicate has a name in the network, no
    fact of this predicate gets a warning.
    """
    listed: defaultdict[Signature, list[tuple[Clause, str]]] = defaultdict(list)
    for clause in program:
        if clause.head is not None and clause.head.signature in LISTED_FACTS and not clause.body:
            symbol = value(clause.head.arguments[0], constants)
            if symbol is not None and _is_set(symbol):
                listed[clause.head.signature].append((clause, _symbol_text(symbol)))
    return [
        (clause, unknown_text_message(facts, word, nearest_text(facts, word, values)))
        for facts, words in (
            (LISTED_FACTS[signature], named_facts) for signature, named_facts in listed.items()
        )
        if not any(has_text(facts, word, values) for _, word in words)
        for clause, word in words
    ]


def _literals_with_scope(
    conjuncts: Iterable[Conjunct], scope: tuple[Conjunct, ...]
) -> Iterator[tuple[Literal, tuple[Conjunct, ...]]]:
    """Yield the literals in conjuncts of a body, each with the conjuncts of the condition around it.

    A literal outside conditions comes with ``scope`` instead.
    """
    for conjunct in conjuncts:
        if isinstance(conjunct, Literal):
            yield conjunct, scope
        elif isinstance(conjunct, Conditional):
            yield from _literals_with_scope((conjunct.literal, *conjunct.condition), conjunct.condition)
        elif isinstance(conjunct, Aggregate):
            for element in conjunct.elements:
                yield from _literals_with_scope(element.condition, element.condition)


def _equation(node: AST) -> tuple[AST, AST] | None:
    """Return the two terms of ``X = Y``; ``None`` for any other node."""
    if node.ast_type != ASTType.Literal or node.sign != Sign.NoSign:
        return None
    atom = node.atom
    if atom.ast_type != ASTType.Comparison or len(atom.guards) != 1:
        return None
    guard = atom.guards[0]
    return (atom.term, guard.term) if guard.comparison == ComparisonOperator.Equal else None


def _is_set(symbol: Symbol) -> bool:
    """Whether a value is set; an empty text, ``#inf`` and ``#sup`` stand for an unset constant."""
    unset = symbol.type is SymbolType.String and not symbol.string
    return not unset and symbol.type not in {SymbolType.Infimum, SymbolType.Supremum}


def _symbol_text(symbol: Symbol) -> str:
    """Return a symbol as text, without the quotes of a string."""
    return symbol.string if symbol.type is SymbolType.String else str(symbol)


def _literal_text(literal: Literal, arguments: Mapping[int, str]) -> str:
    """Return a literal without its ``not``; ``arguments`` replace those at the same positions."""
    shown = [arguments.get(position, str(argument)) for position, argument in enumerate(literal.arguments)]
    return f"{literal.signature[0]}({','.join(shown)})"


def _first_three(words: Sequence[str]) -> list[str]:
    """Return the first three different words, and ``...`` if there are more."""
    words = list(dict.fromkeys(words))
    return [*words[:3], "..."] if len(words) > 3 else words
