"""Literals over facts that nothing in a network matches because of a constant: slips, and lost quotes."""

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import chain, islice, product
from typing import NamedTuple

from clingo.ast import AST, ASTType, ComparisonOperator, Sign
from clingo.symbol import Symbol, SymbolType

from foon_asp.encoding.encoding import Encoding
from foon_asp.encoding.facts import quote
from foon_asp.network import Source
from foon_asp.rules.clause import (
    Aggregate,
    Clause,
    Conditional,
    Constants,
    Literal,
    Part,
    Signature,
    Test,
    clauses,
    constant_values,
    plain_value,
    value,
)
from foon_asp.rules.fact_values import COLUMNS, LISTED_FACTS, FactValues, has_text, nearest_text, unknown_text
from foon_asp.text.diagnostics import Diagnostic, Severity

_MAX_COMBINATIONS = 10_000  # of values that lists give a literal; beyond, it counts as matched
_SHOWN = 3  # values of a list

_Values = Mapping[str, Sequence[Symbol]]  # of variables, where all are known


class _Unmatched(NamedTuple):
    """A literal that nothing matches: its rule, the rule's head, its constants, and what to say where."""

    clause: int
    head: Signature | None
    constants: frozenset[Symbol]
    message: str
    source: Source


def unmatched(
    theirs: Sequence[Encoding], ours: Sequence[Encoding], settings: Sequence[str], values: FactValues
) -> Iterator[Diagnostic]:
    """Return a warning for each literal over a fact that its constants keep from matching anything.

    ``theirs`` are the user's files, ``ours`` ready-made constraints beside them, and ``settings`` the
    constants that are set. A literal is passed over where another rule with the same head has its constants
    in a literal that matches: a name may be a label or an ingredient.
    """
    definitions = [statement for each in (*theirs, *ours) for statement in each.definitions]
    constants = constant_values(definitions, settings)
    rules = [
        [list(clauses(rule, 0, constants)) for rule in each.statements if rule.ast_type == ASTType.Rule]
        for each in (*theirs, *ours)
    ]
    programs = [list(chain.from_iterable(each)) for each in rules]
    search = _Search(list(chain.from_iterable(programs)), constants, values)
    unlisted = _unlisted(list(chain.from_iterable(programs[: len(theirs)])), constants, values)
    for encoding, program in zip(theirs, programs, strict=False):
        found = [(each.source, each.message) for each in search.unmatched(program)]
        own = set(map(id, program))
        found += [(clause.source, text) for clause, text in unlisted if id(clause) in own]
        for source, message in dict.fromkeys(found):
            yield encoding.remark(Severity.WARNING, "unmatched", message, source)


class _Search:
    """A search for literals that nothing matches.

    ``program`` has all rules, of which some say what the values of others may be.
    """

    def __init__(self, program: Sequence[Clause], constants: Constants, values: FactValues) -> None:
        self._constants, self._values = constants, values
        self._lists = self._find_lists(program)

    def unmatched(self, program: Sequence[Clause]) -> Iterator[_Unmatched]:
        """Return the literals of the rules of one file that nothing matches."""
        found: list[_Unmatched] = []
        matched: defaultdict[tuple[Signature | None, frozenset[Symbol]], set[int]] = defaultdict(set)
        for number, clause in enumerate(program):
            head = clause.head.signature if clause.head is not None else None
            parts = (*clause.body, *(part for _, condition in clause.others for part in condition))
            for literal, scope in _literals(parts, ()):
                rows = self._rows(literal, (*clause.body, *scope))
                constants = frozenset(symbol for row in rows for symbol in row.values())
                if any(self._matches(literal, row) for row in rows):
                    matched[head, constants].add(number)
                elif rows:
                    begin = literal.arguments[next(iter(rows[0]))].location.begin
                    source = Source(begin.filename, begin.line, begin.column)
                    found.append(_Unmatched(number, head, constants, self._message(literal, rows), source))
        return (each for each in found if not matched[each.head, each.constants] - {each.clause})

    def _rows(self, literal: Literal, parts: Iterable[Part]) -> Sequence[Mapping[int, Symbol]]:
        """Return the values that a literal over a fact asks for, by place; none where it asks for none."""
        known = self._arguments(literal, self._bound(parts)) if literal.signature in COLUMNS else {}
        combinations = list(islice(product(*known.values()), _MAX_COMBINATIONS + 1)) if known else []
        if len(combinations) > _MAX_COMBINATIONS:
            return []
        return [dict(zip(known, each, strict=True)) for each in combinations]

    def _matches(self, literal: Literal, row: Mapping[int, Symbol]) -> bool:
        wanted = {place: plain_value(symbol) for place, symbol in row.items()}
        return self._values.matches(literal.signature[0], COLUMNS[literal.signature], wanted)

    def _arguments(self, literal: Literal, bound: _Values) -> dict[int, Sequence[Symbol]]:
        """Return the values of arguments, by place, where they are known and set."""
        found: dict[int, Sequence[Symbol]] = {}
        for place, argument in enumerate(literal.arguments):
            if argument.ast_type == ASTType.Variable:
                symbols = bound.get(argument.name, ())
            else:
                known = value(argument, self._constants)
                symbols = () if known is None else (known,)
            if symbols and all(map(_is_set, symbols)):
                found[place] = symbols
        return found

    def _bound(self, parts: Iterable[Part]) -> dict[str, Sequence[Symbol]]:
        """Return the values that equations and lists of facts in a body leave its variables."""
        found: dict[str, Sequence[Symbol]] = {}
        for part in parts:
            if isinstance(part, Test) and (equation := _equation(part.ast)) is not None:
                for one, other in (equation, equation[::-1]):
                    symbol = value(other, self._constants)
                    if one.ast_type == ASTType.Variable and symbol is not None:
                        found[one.name] = (symbol,)
            elif isinstance(part, Literal) and part.positive:
                for place, argument in enumerate(part.arguments):
                    symbols = self._lists.get((part.signature, place))
                    if symbols and argument.ast_type == ASTType.Variable:
                        found.setdefault(argument.name, symbols)
        return found

    def _find_lists(self, program: Sequence[Clause]) -> dict[tuple[Signature, int], Sequence[Symbol]]:
        """Return the values of predicates that facts alone define, by argument."""
        rows: defaultdict[Signature, list[list[Symbol | None]]] = defaultdict(list)
        derived = {
            head.signature for clause in program if clause.body or not clause.plain for head in clause.heads
        }
        for clause in program:
            if clause.head is not None and clause.head.signature not in derived | COLUMNS.keys():
                row = [value(argument, self._constants) for argument in clause.head.arguments]
                rows[clause.head.signature].append(row)
        found: dict[tuple[Signature, int], Sequence[Symbol]] = {}
        for signature, listed in rows.items():
            for place in range(signature[1]):
                symbols = [row[place] for row in listed]
                if None not in symbols:
                    found[signature, place] = [each for each in dict.fromkeys(symbols) if each is not None]
        return found

    def _message(self, literal: Literal, rows: Sequence[Mapping[int, Symbol]]) -> str:
        name, columns = literal.signature[0], COLUMNS[literal.signature]
        variables = {
            place: argument.name
            for place, argument in enumerate(literal.arguments)
            if argument.ast_type == ASTType.Variable
        }
        listed = [
            f"{variables[place]} = {' or '.join(_few([str(row[place]) for row in rows]))}"
            for place in rows[0]
            if place in variables
        ]
        constant = {place: str(symbol) for place, symbol in rows[0].items() if place not in variables}
        text = f"nothing in this network matches {_text(literal, constant)}"
        text += f" with {' and '.join(listed)}" if listed else ""
        for place in rows[0]:
            symbol = rows[0][place]
            if place in (*columns.units, *columns.objects) and symbol.type is not SymbolType.Number:
                kind, words = ("unit", "motion(U") if place in columns.units else ("object node", "label(O")
                variable = words[-1]
                return (
                    f"{text}: {variable} is the number of {'a' if kind == 'unit' else 'an'} {kind} there; "
                    f"{words},{quote(_word(symbol))}) says which it is"
                )
            if place in (*columns.units, *columns.objects):
                if not self._values.matches(name, columns, {place: symbol.number}):
                    return f"{text}: no {'unit' if place in columns.units else 'object node'} has that number"
            elif place in columns.numbers and symbol.type is not SymbolType.Number:
                return f"{text}: a number stands there"
        for row in rows:
            texts = {place: _word(symbol) for place, symbol in row.items() if place in columns.texts}
            meant = self._values.nearest(name, columns, texts) if texts else None
            if meant is not None:
                put = {place: quote(word) for place, word in meant.items()}
                shown = {place: constant.get(place, "") for place in constant} | put
                return f"{text}; did you mean {_text(literal, shown)}?"
        if any(
            row[place].type is not SymbolType.String
            for row in rows
            for place in columns.texts
            if place in row
        ):
            return f"{text}: names are texts, in quotes"
        return text


def _unlisted(
    program: Sequence[Clause], constants: Constants, values: FactValues
) -> list[tuple[Clause, str]]:
    """Find facts for a list of ready-made constraints where none of them names what the network has."""
    said: defaultdict[Signature, list[tuple[Clause, str]]] = defaultdict(list)
    for clause in program:
        if clause.head is not None and clause.head.signature in LISTED_FACTS and not clause.body:
            symbol = value(clause.head.arguments[0], constants)
            if symbol is not None and _is_set(symbol):
                said[clause.head.signature].append((clause, _word(symbol)))
    return [
        (clause, unknown_text(facts, word, nearest_text(facts, word, values)))
        for facts, words in ((LISTED_FACTS[signature], each) for signature, each in said.items())
        if not any(has_text(facts, word, values) for _, word in words)
        for clause, word in words
    ]


def _literals(parts: Iterable[Part], scope: tuple[Part, ...]) -> Iterator[tuple[Literal, tuple[Part, ...]]]:
    """Return the literals in parts of a body, each with the parts that hold only beside it."""
    for part in parts:
        if isinstance(part, Literal):
            yield part, scope
        elif isinstance(part, Conditional):
            yield from _literals((part.literal, *part.condition), part.condition)
        elif isinstance(part, Aggregate):
            for element in part.elements:
                yield from _literals(element.condition, element.condition)


def _equation(node: AST) -> tuple[AST, AST] | None:
    """Return the two terms of ``X = Y``."""
    if node.ast_type != ASTType.Literal or node.sign != Sign.NoSign:
        return None
    atom = node.atom
    if atom.ast_type != ASTType.Comparison or len(atom.guards) != 1:
        return None
    guard = atom.guards[0]
    return (atom.term, guard.term) if guard.comparison == ComparisonOperator.Equal else None


def _is_set(symbol: Symbol) -> bool:
    """Whether a value is none of those that stand for a constant that is not set."""
    unset = symbol.type is SymbolType.String and not symbol.string
    return not unset and symbol.type not in {SymbolType.Infimum, SymbolType.Supremum}


def _word(symbol: Symbol) -> str:
    return symbol.string if symbol.type is SymbolType.String else str(symbol)


def _text(literal: Literal, arguments: Mapping[int, str]) -> str:
    """Return a literal without its ``not``, with other arguments at places."""
    shown = [arguments.get(place, str(each)) for place, each in enumerate(literal.arguments)]
    return f"{literal.signature[0]}({','.join(shown)})"


def _few(words: Sequence[str]) -> list[str]:
    words = list(dict.fromkeys(words))
    return [*words[:_SHOWN], "..."] if len(words) > _SHOWN else words
