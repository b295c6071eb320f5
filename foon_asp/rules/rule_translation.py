"""Translation of rules into programs about single units, which clingo evaluates.

There are three kinds of translations. A *removal* removes each unit that breaks the rule by itself. An
*at-least-one constraint* requires one of the units that keep to the rule by themselves. A *row* bounds a sum
of weights of units. Any other rule is a *check*: clingo evaluates it on whole trees.

Clingo evaluates the program of a translation in several worlds. There is a world for each unit, in which only
this unit is used; in the world ``NOTHING``, no unit is. The program derives atoms
``_of_unit(NUMBER,WHAT,OF,W)`` in a world ``W``. ``NUMBER`` is that of the translation. ``WHAT`` is
``breaks``, ``asks``, ``meets`` or ``weighs``. ``OF`` is a term, or the weight.

A rule can be translated if, by its syntax, each of its derivations looks at one unit of the tree, and if it
calculates nothing. Then no number can overflow, and grounding ends.
"""

from collections.abc import Iterable, Iterator, Sequence
from typing import Final, NamedTuple

from clingo.ast import AST, AggregateFunction, ASTType, ComparisonOperator
from clingo.symbol import Number, SymbolType

from foon_asp.problem import RequiredUnit, Trait
from foon_asp.problem.number import INT32_MAX
from foon_asp.rules.clause import (
    Aggregate,
    Clause,
    Conditional,
    Conjunct,
    Constants,
    Element,
    Literal,
    Signature,
    Test,
    UnknownConjunct,
    comparison_holds,
    factors,
    global_variables,
    literals,
    value,
    variables,
)
from foon_asp.rules.dependence import AVAILABLE, TIMES, USE, Dependence, Monotonicity
from foon_asp.rules.fact_subject import SUBJECTS
from foon_asp.rules.required_traits import TraitReader
from foon_asp.rules.worlds import Worlds, unused_variable

ANSWER: Final = ("_of_unit", 4)
NOTHING: Final = "nothing"  # the world without units
_WORLD_OF_NOTHING: Final = f'"{NOTHING}"'
_ONE_EXECUTION = {USE, TIMES}


class Removal(NamedTuple):
    """A rule that removes units.

    Its program derives ``breaks`` in worlds, each of which stands for one unit
    (:mod:`foon_asp.rules.worlds`). A unit is removed if its world has ``breaks``. If the world ``NOTHING``
    has ``breaks``, there is no tree.
    """

    program: tuple[str, ...]


class AtLeastOne(NamedTuple):
    """A rule that requires a unit of each of several sets.

    ``program``: rules for clingo, in which a term stands for each set. They derive ``asks`` with the term of
    each required set. They derive ``meets`` with this term in the world of each unit of the set. If they
    derive ``meets`` in the world ``NOTHING``, no unit of the set is needed.
    ``wanted``: the traits of the units in the sets.
    """

    program: tuple[str, ...]
    wanted: RequiredUnit


class Row(NamedTuple):
    """A rule that bounds a sum of weights of units.

    ``number``: the first argument of the atoms ``weighs``.
    ``program``: it derives the weights in atoms ``weighs``. Different weights of a unit add up.
    ``bound``: an upper bound on the sum; with ``at_least``, a lower bound.
    ``used``: whether a weight counts once, not for each execution of the unit.
    ``per_unit``: whether the bound holds for each unit by itself, not for the sum over units.
    """

    number: int
    program: tuple[str, ...]
    bound: int
    at_least: bool = False
    used: bool = False
    per_unit: bool = False


Understood = Removal | AtLeastOne | Row

# By forbidden comparison: whether the bound that remains is a lower one, and its offset from the number.
_ALLOWED = {
    ComparisonOperator.GreaterThan: (False, 0),
    ComparisonOperator.GreaterEqual: (False, -1),
    ComparisonOperator.LessThan: (True, 0),
    ComparisonOperator.LessEqual: (True, 1),
}


class Translator:
    """Translator of rules to removals, at-least-one constraints or rows.

    The methods ``removal``, ``at_least_one`` and ``row`` return ``None`` for a rule without such a
    translation. ``program`` has the clauses of all rules.
    """

    def __init__(self, program: Sequence[Clause], constants: Constants, dependence: Dependence) -> None:
        """Index the clauses by the predicate in their heads, and choose a variable for worlds."""
        self._constants, self._dependence = constants, dependence
        self._clauses: dict[Signature, list[Clause]] = {}
        for clause in program:
            if clause.head is not None:
                self._clauses.setdefault(clause.head.signature, []).append(clause)
        dependent = {
            signature
            for signature in self._clauses
            if dependence.of_predicate(signature) is not Monotonicity.NOT
        } | {USE, AVAILABLE}
        self._world = unused_variable("".join(str(clause.ast) for clause in program), "World")
        self._worlds = Worlds(dependent, self._world, "__")
        self._numbers = 0
        self._units_read_by_predicate: dict[Signature, int] = {}

    def removal(self, clauses: Sequence[Clause]) -> Removal | None:
        """Return the removal of units for the rule that consists of ``clauses``.

        Return ``None`` if a clause calculates, or depends on more than one unit of the tree.
        """
        if not all(self._has_no_calculation(clause.body) for clause in clauses):
            return None
        if any(self._count_units_read(clause.body) > 1 for clause in clauses):
            return None
        return Removal(
            tuple(self._rule_text(self._new_answer_head("breaks", 0), clause) for clause in clauses)
        )

    def at_least_one(self, clause: Clause) -> AtLeastOne | None:
        """Return the at-least-one constraint that a requiring rule stands for.

        Return ``None`` if the rule calculates, or if it says anything about the tree except that units are
        absent.
        """
        unit_positions = [n for n, conjunct in enumerate(clause.body) if self._count_units_read([conjunct])]
        set_positions = [n for n in range(len(clause.body)) if n not in unit_positions]
        alternatives = [self._alternatives(clause, n) for n in unit_positions]
        if None in alternatives or not self._has_no_calculation(clause.body):
            return None
        bound = {name for n in set_positions for name in global_variables(clause.body[n])}
        set_term = f"({','.join([*sorted(bound), ''])})" if bound else "()"
        set_conditions = [str(self._worlds.visit(clause.ast.body[n])) for n in set_positions]
        self._numbers += 1
        asks = self._answer_head("asks", set_term, _WORLD_OF_NOTHING)
        program = [f"{asks} :- {'; '.join(set_conditions) or '#true'}."]
        rows: list[Sequence[Trait]] = []
        always = all(getattr(clause.body[n], "holds", None) for n in set_positions)
        for unit_conditions, conjuncts in (pair for pairs in alternatives for pair in pairs or ()):
            body = "; ".join([*set_conditions, *unit_conditions, f"__world({self._world})"])
            program.append(f"{self._answer_head('meets', set_term, self._world)} :- {body}.")
            rows += TraitReader(self._clauses, self._constants).rows(conjuncts)
            always &= self._requires_unit(conjuncts)
        return AtLeastOne(tuple(program), RequiredUnit(rows, always))

    def row(self, clause: Clause) -> Row | None:
        """Return the row that a rule such as ``:- #sum { N,U : times(U,N) } > 9`` stands for.

        A rule such as ``:- times(U,N), N > 3`` stands for a row with a bound per unit. Return ``None`` for a
        rule of another form.
        """
        body = clause.body
        if len(body) == 1 and isinstance(body[0], Aggregate):
            return self._sum_row(body[0], clause.ast.body[0].atom.elements)
        for position, conjunct in enumerate(body):
            others = [n for n in range(len(body)) if n != position]
            if isinstance(conjunct, Test) and (guard := _comparison(conjunct)) is not None:
                condition = tuple(body[n] for n in others)
                count, operator, term = guard
                allowed = self._remaining_bound(operator, term)
                if allowed is None or allowed[0] or not _states_count(condition, count):
                    continue
                self._numbers += 1
                element = Element((count, *(_execution_arguments(condition) or ())[:1]), condition)
                weights = self._weight_rule(element, [clause.ast.body[n] for n in others])
                return (
                    None if weights is None else Row(self._numbers, (weights[0],), allowed[1], per_unit=True)
                )
        return None

    def complete_program(
        self, programs: Sequence[str], read: Iterable[Clause]
    ) -> tuple[list[str], set[Signature]]:
        """Return ``programs`` with the rules that they need, and the predicates of the facts that are read.

        ``read`` has the clauses from which the programs were translated.
        """
        facts: set[Signature] = {("unit", 1)}
        rules: list[str] = []
        done: set[Signature] = set()
        stack = [literal.signature for clause in read for literal in literals(clause.body)]
        while stack:
            signature = stack.pop()
            if signature in done:
                continue
            done.add(signature)
            if signature in SUBJECTS:
                facts.add(signature)
            for clause in self._clauses.get(signature, ()):
                rules.append(self._rule_text(str(self._worlds.visit(clause.ast.head)), clause))
                stack += [literal.signature for literal in literals(clause.body)]
        rules += ["__world(W) :- unit(W).", f"__world({_WORLD_OF_NOTHING}).", "__use(W,W) :- unit(W)."]
        if AVAILABLE in done:
            rules += [f"__available({_WORLD_OF_NOTHING},O) :- kitchen(O).", "__available(W,O) :- gives(W,O)."]
            facts |= {("kitchen", 1), ("gives", 2)}
        return [*rules, *programs], facts

    def _sum_row(self, aggregate: Aggregate, elements: Sequence[AST]) -> Row | None:
        """Return the row that a sum or count with one guard stands for; ``None`` for other aggregates.

        ``elements`` are the syntax trees of its elements.
        """
        is_sum = aggregate.function is AggregateFunction.Sum
        sizes = {len(element.terms) for element in aggregate.elements}
        if aggregate.negations or len(aggregate.guards) != 1 or sizes != {1 + is_sum}:
            return None
        if not is_sum and aggregate.function is not AggregateFunction.Count:
            return None
        allowed = self._remaining_bound(aggregate.guards[0].comparison, aggregate.guards[0].term)
        self._numbers += 1
        element_weights = [
            self._weight_rule(element, list(node.condition))
            for element, node in zip(aggregate.elements, elements, strict=True)
        ]
        used = {signature for weights in element_weights if weights for signature in weights[1:]}
        if allowed is None or None in element_weights or len(used) != 1:
            return None
        program = tuple(weights[0] for weights in element_weights if weights)
        return Row(self._numbers, program, allowed[1], allowed[0], used == {USE})

    def _weight_rule(self, element: Element, condition: Sequence[AST]) -> tuple[str, Signature] | None:
        """Return a rule that derives the weight of one execution, and the predicate that states executions.

        The predicate is ``use/1`` or ``times/2``. The weight of n executions of a unit is n times this
        weight, since nothing else reads n. ``condition`` has the syntax trees of the element's condition.
        Return ``None`` if the element has another form.
        """
        executions = _execution_arguments(element.condition)
        if executions is None or not self._has_no_calculation(element.condition):
            return None
        unit, *count = executions
        if str(unit) == "_" or any(term.ast_type != ASTType.Variable for term in count):
            return None
        *product, last_term = (factor for term in element.terms for factor in factors(term))
        factor_texts = [str(factor) for factor in product]
        position = next(n for n, conjunct in enumerate(element.condition) if _states_executions(conjunct))
        others = [conjunct for n, conjunct in enumerate(element.condition) if n != position]
        for factor in map(str, count):
            other_names = [name for conjunct in others for name in variables(*_terms_of(conjunct))]
            if factor_texts.count(factor) != 1 or factor in {*other_names, str(unit), "_"}:
                return None
            factor_texts.remove(factor)
        if len(factor_texts) > 1 or str(last_term) != str(unit) or self._count_units_read(others):
            return None
        if factor_texts and not self._is_variable_or_value(
            next(factor for factor in product if str(factor) == factor_texts[0])
        ):
            return None
        body = [f"unit({unit})", *(str(node) for n, node in enumerate(condition) if n != position)]
        weight = factor_texts[0] if factor_texts else "1"
        execution = element.condition[position]
        assert isinstance(execution, Literal)
        return f"{self._answer_head('weighs', weight, unit)} :- {'; '.join(body)}.", execution.signature

    def _remaining_bound(self, comparison: int, term: AST) -> tuple[bool, int] | None:
        """Return the bound that a forbidden comparison leaves: whether it is a lower bound, and its number.

        If ``> 9`` is forbidden, the upper bound ``(False, 9)`` remains. Return ``None`` if the term is no
        number, and for ``=`` and ``!=``.
        """
        number, allowed = value(term, self._constants), _ALLOWED.get(ComparisonOperator(comparison))
        if number is None or number.type is not SymbolType.Number or allowed is None:
            return None
        return allowed[0], number.number + allowed[1]

    def _alternatives(self, clause: Clause, position: int) -> "list[_Alternative] | None":
        """Return the conditions under which a unit makes a conjunct of a requiring rule false.

        The conjunct, given by its position, states that units are absent. It is a literal or a conditional
        with ``not``, or a count of 0. Return ``None`` for any other conjunct.

        Each condition is a pair: a list of its conjuncts as texts for clingo, and the conjuncts themselves.
        """
        conjunct, node = clause.body[position], clause.ast.body[position]
        if isinstance(conjunct, Aggregate):
            if not _is_count_of_zero(conjunct, self._constants):
                return None
            pairs = (
                [
                    (element.condition, list(inner.condition))
                    for element, inner in zip(conjunct.elements, node.atom.elements, strict=True)
                ]
                if node.atom.ast_type == ASTType.BodyAggregate
                else []
            )
            if not pairs:
                return None
        else:
            literal, condition, nodes = conjunct, tuple[Conjunct, ...](), list[AST]()
            if isinstance(conjunct, Conditional):
                literal, condition = conjunct.literal, conjunct.condition
                node, nodes = node.literal, list(node.condition)
            if not isinstance(literal, Literal) or literal.negations != 1:
                return None
            pairs = [((literal._replace(negations=0), *condition), [node.update(sign=0), *nodes])]
        if any(self._count_units_read(conjuncts) != 1 for conjuncts, _ in pairs):
            return None
        return [
            ([str(self._worlds.visit(condition_node)) for condition_node in condition_nodes], conjuncts)
            for conjuncts, condition_nodes in pairs
        ]

    def _new_answer_head(self, what: str, of: object) -> str:
        """Return a head with a new number: ``_of_unit(NUMBER,"what",of,World)``.

        ``what`` says what is answered, ``of`` is its term, and World is a variable.
        """
        self._numbers += 1
        return self._answer_head(what, of, self._world)

    def _answer_head(self, what: str, of: object, world: object) -> str:
        """Return a head ``_of_unit(NUMBER,"what",of,world)`` with the number of the last translation."""
        return f'{ANSWER[0]}({self._numbers},"{what}",{of},{world})'

    def _rule_text(self, head: str, clause: Clause) -> str:
        """Return a rule with the head ``head`` and the body of a clause.

        If the head has the variable for worlds, the body gets a condition on this variable. It is any world
        if the clause depends on the tree, else the world without units.
        """
        body = [str(self._worlds.visit(node)) for node in clause.ast.body]
        if self._world in head:
            world_condition = (
                f"__world({self._world})"
                if self._count_units_read(clause.body)
                else f"{self._world} = {_WORLD_OF_NOTHING}"
            )
            body.append(world_condition)
        return f"{head} :- {'; '.join(body) or '#true'}."

    def _count_units_read(self, body: Iterable[Conjunct]) -> int:
        """Return on how many units of the tree a conjunction depends; 2 stands for more than one.

        A literal with ``not``, an aggregate or a conditional that depends on the tree counts as 2.
        """
        unit_count = 0
        for conjunct in body:
            if isinstance(conjunct, Literal):
                unit_count += self._count_units_read_by_atom(conjunct.signature) << (conjunct.negations > 0)
            else:
                unit_count += 2 * any(
                    self._count_units_read_by_atom(literal.signature) for literal in literals([conjunct])
                )
        return min(unit_count, 2)

    def _count_units_read_by_atom(self, signature: Signature) -> int:
        """Return on how many units of the tree an atom depends; 2 stands for more than one.

        It is 2 for a recursive predicate that depends on the tree. The result is cached by predicate.
        """
        if signature in {USE, AVAILABLE}:
            return 1
        if signature not in self._units_read_by_predicate:
            self._units_read_by_predicate[signature] = (
                2 if self._dependence.of_predicate(signature) is not Monotonicity.NOT else 0
            )  # recursion
            if self._units_read_by_predicate[signature]:
                clauses = self._clauses.get(signature, ())
                self._units_read_by_predicate[signature] = max(
                    (self._count_units_read(clause.body) for clause in clauses), default=0
                )
        return self._units_read_by_predicate[signature]

    def _requires_unit(self, body: Iterable[Conjunct]) -> bool:
        """Whether a conjunction about one unit is false in the world without units.

        An atom ``available(O)`` may be true there, since O may be in the kitchen.
        """
        return any(
            isinstance(conjunct, Literal)
            and (
                conjunct.signature == USE
                or (
                    conjunct.signature != AVAILABLE
                    and self._count_units_read_by_atom(conjunct.signature) == 1
                    and all(
                        self._requires_unit(clause.body)
                        for clause in self._clauses.get(conjunct.signature, ())
                    )
                )
            )
            for conjunct in body
        )

    def _has_no_calculation(
        self, body: Iterable[Conjunct], above: frozenset[Signature] = frozenset()
    ) -> bool:
        """Whether a body, and the rules that derive what it reads, calculate nothing.

        Aggregates other than counts, predicates with a minus and conjuncts of unknown kind count as
        calculations. ``above`` has the predicates whose rules are being checked.
        """
        conjuncts = tuple(body)
        terms = [term for conjunct in conjuncts for term in _terms_of(conjunct)]
        inner = [literal for conjunct in conjuncts for literal in literals([conjunct])]
        if any(map(_has_unknown_part, conjuncts)) or not all(map(self._is_variable_or_value, terms)):
            return False
        read = {literal.signature for literal in inner} - above
        above |= read
        return all(not name.startswith("-") for name, _ in read) and all(
            all(map(self._is_variable_or_value, clause.ast.head.atom.symbol.arguments))
            and self._has_no_calculation(clause.body, above)
            for signature in read
            for clause in self._clauses.get(signature, ())
        )

    def _is_variable_or_value(self, term: AST) -> bool:
        """Whether a term is a variable, or has a value that is known without clingo."""
        return term.ast_type == ASTType.Variable or value(term, self._constants) is not None


_Alternative = tuple[list[str], Sequence[Conjunct]]


def _terms_of(conjunct: Conjunct) -> Iterator[AST]:
    """Yield all terms in a conjunct, except in comparisons whose truth is known."""
    if isinstance(conjunct, Literal):
        yield from conjunct.arguments
    elif isinstance(conjunct, Test):
        if conjunct.holds is None and conjunct.ast.atom.ast_type == ASTType.Comparison:
            yield conjunct.ast.atom.term
            yield from (guard.term for guard in conjunct.ast.atom.guards)
    elif isinstance(conjunct, Conditional):
        for inner in (conjunct.literal, *conjunct.condition):
            yield from _terms_of(inner)
    elif isinstance(conjunct, Aggregate):
        yield from (guard.term for guard in conjunct.guards)
        for element in conjunct.elements:
            yield from element.terms
            for inner in element.condition:
                yield from _terms_of(inner)


def _has_unknown_part(conjunct: Conjunct) -> bool:
    """Whether a conjunct has a part of an unknown kind, or an aggregate other than a count."""
    if isinstance(conjunct, Conditional):
        return any(map(_has_unknown_part, (conjunct.literal, *conjunct.condition)))
    if isinstance(conjunct, Aggregate):
        counts = conjunct.function is AggregateFunction.Count
        return not counts or any(
            _has_unknown_part(inner) for element in conjunct.elements for inner in element.condition
        )
    return isinstance(conjunct, UnknownConjunct)


def _comparison(test: Test) -> tuple[AST, int, AST] | None:
    """Return the left term, operator and right term of a comparison.

    Return ``None`` for a comparison with ``not``, a chain of comparisons and any other test.
    """
    atom = test.ast.atom
    if test.ast.sign or atom.ast_type != ASTType.Comparison or len(atom.guards) != 1:
        return None
    return atom.term, atom.guards[0].comparison, atom.guards[0].term


def _states_executions(conjunct: Conjunct) -> bool:
    """Whether a conjunct is an atom ``use(U)`` or ``times(U,N)`` without ``not``."""
    return isinstance(conjunct, Literal) and conjunct.positive and conjunct.signature in _ONE_EXECUTION


def _execution_arguments(condition: Iterable[Conjunct]) -> tuple[AST, ...] | None:
    """Return the arguments of the only ``use(U)`` or ``times(U,N)`` in a condition, else ``None``."""
    execution_literals = [conjunct for conjunct in condition if _states_executions(conjunct)]
    if len(execution_literals) == 1 and isinstance(execution_literals[0], Literal):
        return execution_literals[0].arguments
    return None


def _states_count(condition: Iterable[Conjunct], count: AST) -> bool:
    """Whether ``count`` is the number of executions in the only ``times(U,N)`` of a condition."""
    executions = _execution_arguments(condition)
    return executions is not None and len(executions) == 2 and str(executions[1]) == str(count)


def _is_count_of_zero(aggregate: Aggregate, constants: Constants) -> bool:
    """Whether a ``#count`` holds exactly where its count is 0."""
    if aggregate.function is not AggregateFunction.Count or len(aggregate.guards) != 1:
        return False
    bound = value(aggregate.guards[0].term, constants)
    if bound is None or bound.type is not SymbolType.Number:
        return False
    compares = [comparison_holds(Number(n), aggregate.guards[0].comparison, bound) for n in (0, 1, INT32_MAX)]
    expected = [not holds for holds in compares] if aggregate.negations == 1 else compares
    return expected == [True, False, False]
