"""Locality of rules: whether they read facts about the tree alone, its units, object nodes and goals.

A rule is local if its truth for a tree does not depend on facts outside the tree. They are facts of units
outside the tree, and of object nodes that only such units have. So each fact that a local rule reads is about
a subject that is known to be in the tree. In ``use(U)``, the unit U is in the tree. If U is in the tree, so
is the object node O in ``input(U,O)``. If O is in the tree, so is the label L in ``label(O,L)``. The node O
in ``goal(O)`` always is in the tree. The arguments of an auxiliary predicate may be subjects: ``tainted(O) :-
label(O,"nut").`` reads facts about O only.
"""

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple

from clingo.ast import AST, ASTType

from foon_asp.network import Source
from foon_asp.rules.clause import (
    Aggregate,
    Clause,
    Conditional,
    Conjunct,
    Literal,
    Signature,
    UnknownConjunct,
)
from foon_asp.rules.dependence import Dependence
from foon_asp.rules.fact_subject import DECISIONS, SUBJECTS, Subject

_FACTS = {**SUBJECTS, **DECISIONS}
_TreeTerms = dict[str, set[Subject]]  # by term: what it is known to stand for in the tree


class Nonlocality(NamedTuple):
    """The reason why a rule is not local, and the place of that rule."""

    reason: str
    source: Source


class Locality:
    """Locality of each rule of a program: whether its truth for a tree depends on facts about the tree alone.

    It is computed as a fixpoint over the auxiliary predicates.
    """

    def __init__(self, program: Sequence[Clause], dependence: Dependence) -> None:
        """Find the locality of all predicates that the clauses of a program derive."""
        self._dependence = dependence
        self._rules: defaultdict[Signature, list[Clause]] = defaultdict(list)
        for clause in program:
            for head in clause.heads:
                self._rules[head.signature].append(clause)
        self._leads_to = self._find_leads_to()
        # of auxiliary predicates: what their arguments have to be in the tree, and which are not local at all
        self._about: dict[Signature, dict[int, Subject]] = {signature: {} for signature in self._rules}
        self._nonlocal: dict[Signature, Nonlocality] = {}
        self._find_about_arguments(program)

    def nonlocality(self, clause: Clause) -> Nonlocality | None:
        """Return why a rule is not local; ``None`` if it is local.

        A rule with a minus in its head is never local.
        """
        if any(atom.signature[0].startswith("-") for atom in clause.heads):
            return Nonlocality(
                "an atom with a minus rules out the one without, wherever that is", clause.source
            )
        tree_terms = self._tree_terms(clause.body)
        lacking = self._lacking_term(clause.body, tree_terms, clause.source)
        for atom, condition in clause.head_elements:
            lacking = lacking or self._lacking_term(
                (atom, *condition), self._tree_terms(condition, tree_terms), clause.source
            )
        return lacking.nonlocality if lacking else None

    def _find_leads_to(self) -> dict[Signature, dict[int, set[Subject]]]:
        """Find the arguments of auxiliary predicates that are in the tree whenever an atom holds.

        Return a dictionary by predicate and position; its values are the subjects that the argument stands
        for in the tree. It is the greatest fixpoint over the rules, and is also set as ``_leads_to``.
        """
        leads_to = {
            signature: {position: set(Subject) for position in range(signature[1])}
            for signature in self._rules
        }
        self._leads_to = leads_to
        changed = True
        while changed:
            changed = False
            for signature, clauses in self._rules.items():
                for clause in clauses:
                    for atom, condition in ((clause.head, ()), *clause.head_elements):
                        if atom is None or atom.signature != signature:
                            continue
                        tree_terms = self._tree_terms(condition, self._tree_terms(clause.body))
                        for position, term in enumerate(atom.arguments):
                            subjects = leads_to[signature][position] & tree_terms.get(str(term), set())
                            changed |= subjects != leads_to[signature][position]
                            leads_to[signature][position] = subjects
        return leads_to

    def _find_about_arguments(self, program: Sequence[Clause]) -> None:
        """Fill ``_about`` and ``_nonlocal`` for all auxiliary predicates, as a fixpoint.

        ``_about`` gets the arguments that have to be in the tree for the rules of a predicate to be local.
        ``_nonlocal`` gets each predicate with a rule that is not local, whatever the arguments are.
        """
        changed = True
        while changed:
            changed = False
            for clause in program:
                if clause.is_constraint:
                    continue
                heads = clause.heads
                is_recursive = any(head.signature in self._dependence.loops for head in heads)
                if not clause.plain or is_recursive:
                    nonlocality = self.nonlocality(clause)
                    if nonlocality is None and any(self._about[head.signature] for head in heads):
                        nonlocality = Nonlocality(
                            "it is left open of object nodes or units beyond the tree", clause.source
                        )
                    for head in heads if nonlocality else ():
                        assert nonlocality
                        changed |= self._mark_nonlocal(head.signature, nonlocality)
                else:
                    assert clause.head is not None
                    changed |= self._add_about_arguments(clause, clause.head)

    def _add_about_arguments(self, clause: Clause, head: Literal) -> bool:
        """Add to ``_about`` the head arguments that have to be in the tree so that a rule is local.

        If no arguments make the rule local, mark its predicate as not local. Return whether anything changed.
        """
        changed = False
        while head.signature not in self._nonlocal:
            about = self._about[head.signature]
            tree_terms: _TreeTerms = {}
            for position, subject in about.items():
                if _has_one_value(head.arguments[position]):
                    tree_terms.setdefault(str(head.arguments[position]), set()).add(subject)
            lacking = self._lacking_term(
                clause.body, self._tree_terms(clause.body, tree_terms), clause.source
            )
            if lacking is None:
                return changed
            changed = True
            positions = [p for p, term in enumerate(head.arguments) if str(term) == lacking.term]
            if positions and positions[0] not in about:
                about[positions[0]] = lacking.subject
            else:
                self._mark_nonlocal(head.signature, lacking.nonlocality)
        return changed

    def _mark_nonlocal(self, signature: Signature, nonlocality: Nonlocality) -> bool:
        """Record why a predicate is not local, unless a reason is known; return whether it was recorded."""
        if signature in self._nonlocal:
            return False
        self._nonlocal[signature] = nonlocality
        return True

    def _tree_terms(
        self, conjuncts: Iterable[Conjunct], known_terms: Mapping[str, set[Subject]] | None = None
    ) -> _TreeTerms:
        """Return the terms that are known to be in the tree wherever the conjuncts hold.

        The keys are terms as text, the values the subjects that a term stands for. The result has
        ``known_terms``, and the terms that follow from literals without ``not``.
        """
        positive = [literal for literal in conjuncts if isinstance(literal, Literal) and literal.positive]
        tree_terms = {term: set(subjects) for term, subjects in (known_terms or {}).items()}
        changed = True
        while changed:
            changed = False
            for literal in positive:
                for position, subject in self._arguments_in_tree(literal, tree_terms):
                    term = literal.arguments[position]
                    if _has_one_value(term) and subject not in tree_terms.setdefault(str(term), set()):
                        tree_terms[str(term)].add(subject)
                        changed = True
        return tree_terms

    def _arguments_in_tree(self, literal: Literal, tree_terms: _TreeTerms) -> list[tuple[int, Subject]]:
        """Return the arguments that are in the tree if a literal holds: pairs of a position and a subject.

        ``tree_terms`` has the terms that are known to be in the tree. For a fact, the list is empty unless
        ``tree_terms`` has all subjects that the fact is about. For an auxiliary predicate, ``tree_terms``
        does not matter. For any other predicate, the list is empty.
        """
        if literal.signature in self._leads_to:
            leads_to = self._leads_to[literal.signature]
            return [(position, subject) for position, subjects in leads_to.items() for subject in subjects]
        facts = _FACTS.get(literal.signature)
        if facts is None or not all(
            subject in tree_terms.get(str(literal.arguments[position]), ())
            for position, subject in facts.about.items()
        ):
            return []
        return list(facts.leads_to.items())

    def _lacking_term(
        self, conjuncts: Iterable[Conjunct], tree_terms: _TreeTerms, source: Source
    ) -> "_LackingTerm | None":
        """Return the first term in conjuncts that has to be in the tree but may be outside, else ``None``.

        ``tree_terms`` has the terms that are known to be in the tree. ``source`` is the place of the rule.
        """
        for conjunct in conjuncts:
            lacking = self._lacking_term_in_conjunct(conjunct, tree_terms, source)
            if lacking:
                return lacking
        return None

    def _lacking_term_in_conjunct(
        self, conjunct: Conjunct, tree_terms: _TreeTerms, source: Source
    ) -> "_LackingTerm | None":
        """Return the first term of a conjunct that must be in the tree but may be outside, else ``None``.

        The term is empty for a conjunct of unknown kind. A comparison never has such a term.
        """
        if isinstance(conjunct, Literal):
            return self._lacking_term_in_literal(conjunct, tree_terms, source)
        if isinstance(conjunct, Conditional):
            # it matters only where its condition holds and its literal does not
            literal = conjunct.literal
            if isinstance(literal, Literal) and literal.negations == 1:
                atom = literal._replace(negations=0)
                inner_terms = self._tree_terms((atom, *conjunct.condition), tree_terms)
            else:
                inner_terms = self._tree_terms(conjunct.condition, tree_terms)
            return self._lacking_term((conjunct.literal, *conjunct.condition), inner_terms, source)
        if isinstance(conjunct, Aggregate):
            for element in conjunct.elements:
                inner_terms = self._tree_terms(element.condition, tree_terms)
                lacking = self._lacking_term(element.condition, inner_terms, source)
                if lacking:
                    return lacking
        if isinstance(conjunct, UnknownConjunct):
            return _LackingTerm(
                "", Subject.UNIT, Nonlocality(f"{conjunct.text} is nothing that is looked into", source)
            )
        return None

    def _lacking_term_in_literal(
        self, literal: Literal, tree_terms: _TreeTerms, source: Source
    ) -> "_LackingTerm | None":
        """Return the first argument that has to be in the tree but may be outside, else ``None``.

        The term is empty if the predicate is not local whatever its arguments are. It is empty also for an
        argument that may have several values: a pool, an interval, an operation or ``_``.
        """
        signature = literal.signature
        if signature in self._nonlocal:
            return _LackingTerm("", Subject.UNIT, self._nonlocal[signature])
        if signature in self._about:
            about = self._about[signature]
        elif signature in _FACTS:
            about = _FACTS[signature].about
        else:
            doubt = self._dependence.doubt((literal,))
            return _LackingTerm("", Subject.UNIT, Nonlocality(doubt.reason, source)) if doubt else None
        for position, subject in about.items():
            term = literal.arguments[position]
            if subject not in tree_terms.get(str(term), ()):
                reason = f"{_atom_text(literal)} is about {_ARTICLES[subject]} that the tree need not have"
                return _LackingTerm(
                    str(term) if _has_one_value(term) else "", subject, Nonlocality(reason, source)
                )
        return None


class _LackingTerm(NamedTuple):
    """A term that has to be in the tree for a rule to be local, but may be outside.

    ``term``: the term as text; empty if the rule is not local whatever terms are in the tree.
    ``subject``: the kind of thing that the term stands for.
    ``nonlocality``: the reason why the rule is not local.
    """

    term: str
    subject: Subject
    nonlocality: Nonlocality


_ARTICLES = {Subject.UNIT: "a unit", Subject.OBJECT: "an object node", Subject.LABEL: "a label"}


def _has_one_value(term: AST) -> bool:
    """Whether a term has the same value throughout a rule: a constant, or a variable other than ``_``."""
    return term.ast_type == ASTType.SymbolicTerm or (term.ast_type == ASTType.Variable and term.name != "_")


def _atom_text(literal: Literal) -> str:
    """Return the atom of a literal as text, without ``not``."""
    name, arity = literal.signature
    arguments = ",".join(map(str, literal.arguments))
    return f"{name}({arguments})" if arity else name
