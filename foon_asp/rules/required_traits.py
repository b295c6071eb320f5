"""Traits of the units that a rule requires: the motions and items that the rule names for them."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import count, product

from clingo.ast import AST, ASTType
from clingo.symbol import Symbol, SymbolType

from foon_asp.problem import Role, Trait
from foon_asp.rules.clause import Clause, Conjunct, Constants, Literal, Signature, value
from foon_asp.rules.dependence import AVAILABLE, TIMES, USE
from foon_asp.rules.fact_subject import SUBJECTS

_KITCHEN = ("kitchen", 1)
_ROLES = {
    "motion": Role.MOTION,
    **dict.fromkeys(("input", "needs"), Role.INPUT),
    **dict.fromkeys(("output", "gives"), Role.OUTPUT),
}
_Term = str | Symbol  # the name of a variable, or a constant
_Atom = tuple[Signature, int, tuple[_Term, ...]]  # with its negations


class TraitReader:
    """Reader of the traits that a conjunction about one unit of the tree requires of this unit.

    It replaces auxiliary predicates by the bodies of their rules. ``clauses`` are the rules, by the predicate
    that they derive.
    """

    def __init__(self, clauses: Mapping[Signature, Sequence[Clause]], constants: Constants) -> None:
        """Keep the rules and the values of constants."""
        self._clauses, self._constants = clauses, constants
        self._fresh = count()

    def rows(self, conjuncts: Iterable[Conjunct]) -> list[list[Trait]]:
        """Return the traits that a conjunction requires of a unit: one list for each of its disjuncts.

        To get the disjuncts, auxiliary predicates in the conjunction are replaced by the bodies of their
        rules.
        """
        return [list(_traits(atoms)) for atoms in self._disjuncts(conjuncts, {}, ())]

    def _disjuncts(
        self, conjuncts: Iterable[Conjunct], names: dict[str, _Term], above: tuple[Signature, ...]
    ) -> list[list[_Atom]]:
        """Return the disjuncts of a conjunction, with its variables replaced by the terms in ``names``.

        Conjuncts other than literals are left out. Variables that are not in ``names`` get new names there.
        ``above`` has the auxiliary predicates that are being unfolded.
        """
        alternatives = []
        for conjunct in conjuncts:
            if isinstance(conjunct, Literal):
                terms = tuple(self._replace_term(argument, names) for argument in conjunct.arguments)
                alternatives.append(self._unfold_literal(conjunct, terms, above))
        return [[atom for atoms in chosen for atom in atoms] for chosen in product(*alternatives)]

    def _unfold_literal(
        self, literal: Literal, terms: tuple[_Term, ...], above: tuple[Signature, ...]
    ) -> list[list[_Atom]]:
        """Return the disjuncts of a literal, with auxiliary predicates replaced by the bodies of rules.

        A negated literal, a fact and a recursive predicate are not replaced. ``available(O)`` becomes
        ``use(U), gives(U,O)``, although O may also be in the kitchen. A predicate that nothing defines has no
        disjuncts.
        """
        signature = literal.signature
        if literal.negations or signature in SUBJECTS or signature in {USE, TIMES} or signature in above:
            return [[(signature, literal.negations, terms)]]
        if signature == AVAILABLE:
            unit = f"{next(self._fresh)} unit"
            return [[(USE, 0, (unit,)), (("gives", 2), 0, (unit, *terms))]]
        disjuncts: list[list[_Atom]] = []
        for clause in self._clauses.get(signature, ()):
            assert clause.head is not None
            pairs = zip(clause.head.arguments, terms, strict=True)
            names = {str(argument): term for argument, term in pairs if argument.ast_type == ASTType.Variable}
            disjuncts += self._disjuncts(clause.body, names, (*above, signature))
        return disjuncts

    def _replace_term(self, term: AST, names: dict[str, _Term]) -> _Term:
        """Return the value of a constant, or the term that ``names`` has for a variable.

        A variable that is not in ``names`` gets a new name there. Each ``_`` becomes a different new name.
        """
        symbol = value(term, self._constants)
        if symbol is not None:
            return symbol
        fresh = f"{next(self._fresh)} {term}"
        return fresh if str(term) == "_" else names.setdefault(str(term), fresh)


def _traits(atoms: Sequence[_Atom]) -> Iterator[Trait]:
    """Yield the traits that a conjunction of atoms states for the unit that it uses.

    Traits are the motion of the unit, and the labels and ingredients of its inputs and outputs. Only texts
    become traits. If the rule says that an input is not in the kitchen, the role is ``Role.MADE``.
    """
    units = {terms[0] for signature, negations, terms in atoms if signature in {USE, TIMES} and not negations}
    facts = [(signature[0], terms) for signature, negations, terms in atoms if not negations]
    outside = {terms[0] for signature, negations, terms in atoms if signature == _KITCHEN and negations == 1}
    for name, terms in facts:
        if name not in _ROLES or terms[0] not in units:
            continue
        role, words = _ROLES[name], [terms[-1]]
        if role is not Role.MOTION:
            words = [
                fact_terms[-1]
                for fact_name, fact_terms in facts
                if fact_name in {"label", "ingredient"} and fact_terms[0] == terms[-1]
            ]
            if role is Role.INPUT and terms[-1] in outside:
                role = Role.MADE
        for word in words:
            if isinstance(word, Symbol) and word.type is SymbolType.String:
                yield Trait(role, word.string)
