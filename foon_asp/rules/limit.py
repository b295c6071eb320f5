"""Rules that limit how often units are executed: ``:- #sum { N,U : times(U,N), ... } > 9.`` and the like."""

import re
from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple

from clingo.ast import AST, AggregateFunction, ASTType, ComparisonOperator
from clingo.symbol import SymbolType

from foon_asp.rules.clause import (
    Aggregate,
    Clause,
    Constants,
    Literal,
    Part,
    Strange,
    Test,
    factors,
    value,
    variables,
)
from foon_asp.rules.dependence import TIMES, USE, Depends
from foon_asp.rules.rule_kind import Analysis

_WORD = re.compile(r"[\w']+")
# What a forbidden comparison leaves: whether that is at least or at most the number, and how far from it.
_LEFT = {
    ComparisonOperator.GreaterThan: (False, 0),
    ComparisonOperator.GreaterEqual: (False, -1),
    ComparisonOperator.LessThan: (True, 0),
    ComparisonOperator.LessEqual: (True, 1),
}


class Once(Strange):
    """That a unit is executed once."""


class Limit(NamedTuple):
    """That units, times their weights, add up to ``bound`` at most, or ``at_least``.

    Each execution of a unit counts; if it says what is ``used``, a unit counts once.
    """

    weights: Mapping[int, int]
    bound: int
    at_least: bool = False
    used: bool = False


class Limiting(NamedTuple):
    """What a rule limits: ``rows`` are heads ``WEIGHT,UNIT`` and bodies for what one execution counts.

    ``each`` says that the bound is for each unit by itself, ``single`` that each that counts adds 1.
    """

    rows: Sequence[tuple[str, tuple[Part, ...]]]
    bound: int
    at_least: bool = False
    used: bool = False
    each: bool = False
    single: bool = False

    def bodies(self) -> list[tuple[Part, ...]]:
        """Give bodies one of which holds for each unit that counts, and takes it as one of the tree."""
        found = []
        for _, body in self.rows:
            unit, *rest = body
            assert isinstance(unit, Literal)
            use = Literal(USE, unit.arguments, 0, f"use({unit.arguments[0]})")
            found.append((use, *(part for part in rest if not isinstance(part, Once))))
        return found

    def limits(self, rows: Iterable[tuple[int, int]]) -> list[Limit]:
        """Give the limits, from the weights and units that the rows hold for; none with a weight below 0."""
        weights: dict[int, int] = {}
        for weight, unit in rows:
            weights[unit] = weights.get(unit, 0) + weight
        if min(weights.values(), default=0) < 0:
            return []
        if self.each:
            return [Limit({unit: 1}, self.bound) for unit in weights]
        return [Limit(weights, self.bound, self.at_least, self.used)]


def limiting(analysis: Analysis, clause: Clause) -> Limiting | None:
    """Give what a clause limits; ``None`` where it says anything else."""
    if not clause.constraint:
        return None
    first, *others = sorted(clause.body, key=lambda part: not isinstance(part, Aggregate))
    if not isinstance(first, Aggregate):
        return _each(analysis, clause.body)
    if others or first.negations or len(first.guards) != 1:
        return None
    left = _left(first.guards[0].comparison, first.guards[0].term, analysis.constants)
    rows = [_row(analysis, first.function, each.terms, each.condition) for each in first.elements]
    found = [row for row in rows if row is not None]
    kinds = {row[2] for row in found}
    single = all(row[3] for row in found)
    if left is None or len(found) < len(rows) or len(kinds) != 1:
        return None
    return Limiting([row[:2] for row in found], left[1], left[0], kinds.pop(), single=single)


def _each(analysis: Analysis, body: Sequence[Part]) -> Limiting | None:
    """Read ``:- times(U,N), N > 2, ...``."""
    for part in body:
        if not isinstance(part, Test) or part.ast.atom.ast_type != ASTType.Comparison or part.ast.sign:
            continue
        count, guards = part.ast.atom.term, part.ast.atom.guards
        left = _left(guards[0].comparison, guards[0].term, analysis.constants) if len(guards) == 1 else None
        times = [each for each in body if isinstance(each, Literal) and each.signature == TIMES]
        if left is None or left[0] or not times or times[0].arguments[1] != count:
            continue
        rest = tuple(each for each in body if each is not part)
        terms = (count, times[0].arguments[0])
        row = _row(analysis, AggregateFunction.Sum, terms, rest)
        return None if row is None else Limiting([row[:2]], left[1], each=True)
    return None


def _left(comparison: int, term: AST, constants: Constants) -> tuple[bool, int] | None:
    """Give what is left if a comparison with a number is forbidden: at least or at most another one."""
    number, sides = value(term, constants), _LEFT.get(ComparisonOperator(comparison))
    if number is None or number.type is not SymbolType.Number or sides is None:
        return None
    return sides[0], number.number + sides[1]


def _row(
    analysis: Analysis, function: AggregateFunction, terms: Sequence[AST], condition: Sequence[Part]
) -> tuple[str, tuple[Part, ...], bool, bool] | None:
    """Give an element for one execution, if more of them count as many times as much.

    And whether use counts, and whether one execution counts 1.
    """
    deciding = [part for part in condition if isinstance(part, Literal) and part.signature in {TIMES, USE}]
    length = {AggregateFunction.Sum: 2, AggregateFunction.Count: 1}.get(function)
    if len(deciding) != 1 or deciding[0].negations or len(terms) != length:
        return None
    unit, *count = deciding[0].arguments
    weight = terms[0] if length == 2 else None
    rest = tuple(part for part in condition if part is not deciding[0])
    product = [] if weight is None else factors(weight)
    words = {name for factor in product if factor not in count for name in variables(factor)}
    words.update(word for part in rest for word in _WORD.findall(part.text))
    named = {str(each) for each in (unit, *count)}
    plain = {each.ast_type for each in (unit, *count)} == {ASTType.Variable} and "_" not in named
    counted = [factor for factor in product if factor in count]
    if not plain or len(named) != 1 + len(count) or str(terms[-1]) != str(unit) or len(counted) != len(count):
        return None
    if words & {str(each) for each in count} or analysis.dependence.of_parts(rest) is not Depends.NOT:
        return None
    here: list[Part] = [Literal(("unit", 1), (unit,), 0, f"unit({unit})")]
    here += [Once(f"{each}=1") for each in count]
    single = weight is None or str(weight) in {"1", *map(str, count)}
    return f"{1 if weight is None else weight},{unit}", (*here, *rest), not count, single
