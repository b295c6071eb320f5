"""Which rules see no further than the tree: its units, their object nodes, the goals.

A rule is local if what it says of a tree stays the same when facts of units outside the tree, and of object
nodes that only those have, are left out. So every fact that it looks at has to be about something that is
known to be the tree's: ``use(U)`` leads to a unit of it, ``input(U,O)`` from there to an object node,
``label(O,L)`` to a label, and ``goal(O)`` to a goal, which is always there. A helper predicate may be about
its arguments: ``tainted(O) :- label(O,"nut").`` sees no further than what it is asked about.
"""

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple

from clingo.ast import AST, ASTType

from foon_asp.network import Source
from foon_asp.rules.clause import Aggregate, Clause, Conditional, Literal, Part, Signature, Strange
from foon_asp.rules.dependence import Dependence
from foon_asp.rules.fact_subject import DECISIONS, SUBJECTS, Subject

_FACTS = {**SUBJECTS, **DECISIONS}
_Known = dict[str, set[Subject]]  # what terms are known to be, of the tree


class Further(NamedTuple):
    """What a rule sees beyond the tree, and where that stands."""

    reason: str
    source: Source


class Locality:
    """What each rule of a program sees beyond the tree."""

    def __init__(self, program: Sequence[Clause], dependence: Dependence) -> None:
        self._dependence = dependence
        self._rules: defaultdict[Signature, list[Clause]] = defaultdict(list)
        for clause in program:
            for head in clause.heads:
                self._rules[head.signature].append(clause)
        self._leads_to = self._find_leads()
        # what the arguments of a helper have to be for it to see no further, and those that do see further
        self._about: dict[Signature, dict[int, Subject]] = {signature: {} for signature in self._rules}
        self._further: dict[Signature, Further] = {}
        self._find_abouts(program)

    def further(self, clause: Clause) -> Further | None:
        """Return what a rule that stands by itself sees beyond the tree, ``None`` where it is local."""
        if any(atom.signature[0].startswith("-") for atom in clause.heads):
            return Further("an atom with a minus rules out the one without, wherever that is", clause.source)
        known = self._known(clause.body)
        lacking = self._lacking(clause.body, known, clause.source)
        for atom, condition in clause.others:
            lacking = lacking or self._lacking(
                (atom, *condition), self._known(condition, known), clause.source
            )
        return lacking.further if lacking else None

    def closed(self, signature: Signature) -> bool:
        """Whether a helper predicate has the same atoms whatever is beyond the tree."""
        return signature in self._about and signature not in self._further and not self._about[signature]

    def _find_leads(self) -> dict[Signature, dict[int, set[Subject]]]:
        """Find out which arguments of helper predicates are always of the tree."""
        leads = {
            signature: {place: set(Subject) for place in range(signature[1])} for signature in self._rules
        }
        self._leads_to = leads
        changed = True
        while changed:
            changed = False
            for signature, clauses in self._rules.items():
                for clause in clauses:
                    for atom, condition in ((clause.head, ()), *clause.others):
                        if atom is None or atom.signature != signature:
                            continue
                        known = self._known(condition, self._known(clause.body))
                        for place, term in enumerate(atom.arguments):
                            still = leads[signature][place] & known.get(str(term), set())
                            changed |= still != leads[signature][place]
                            leads[signature][place] = still
        return leads

    def _find_abouts(self, program: Sequence[Clause]) -> None:
        """Find out what arguments of helper predicates have to be, so that they see no further."""
        changed = True
        while changed:
            changed = False
            for clause in program:
                if clause.constraint:
                    continue
                heads = clause.heads
                loops = any(head.signature in self._dependence.loops for head in heads)
                if not clause.plain or loops:
                    found = self.further(clause)
                    if found is None and any(self._about[head.signature] for head in heads):
                        found = Further(
                            "it is left open of object nodes or units beyond the tree", clause.source
                        )
                    for head in heads if found else ():
                        assert found
                        changed |= self._see(head.signature, found)
                else:
                    assert clause.head is not None
                    changed |= self._find_about(clause, clause.head)

    def _find_about(self, clause: Clause, head: Literal) -> bool:
        """Ask for more of the arguments of a rule's head, where its body needs it; says whether it did."""
        changed = False
        while head.signature not in self._further:
            about = self._about[head.signature]
            known: _Known = {}
            for place, subject in about.items():
                if _simple(head.arguments[place]):
                    known.setdefault(str(head.arguments[place]), set()).add(subject)
            lacking = self._lacking(clause.body, self._known(clause.body, known), clause.source)
            if lacking is None:
                return changed
            changed = True
            places = [p for p, term in enumerate(head.arguments) if str(term) == lacking.term]
            if places and places[0] not in about:
                about[places[0]] = lacking.subject
            else:
                self._see(head.signature, lacking.further)
        return changed

    def _see(self, signature: Signature, further: Further) -> bool:
        if signature in self._further:
            return False
        self._further[signature] = further
        return True

    def _known(self, parts: Iterable[Part], known: Mapping[str, set[Subject]] | None = None) -> _Known:
        """Find the terms that are of the tree wherever parts of a body hold."""
        positive = [part for part in parts if isinstance(part, Literal) and part.positive]
        found = {term: set(subjects) for term, subjects in (known or {}).items()}
        changed = True
        while changed:
            changed = False
            for part in positive:
                for place, subject in self._led(part, found):
                    term = part.arguments[place]
                    if _simple(term) and subject not in found.setdefault(str(term), set()):
                        found[str(term)].add(subject)
                        changed = True
        return found

    def _led(self, literal: Literal, known: _Known) -> list[tuple[int, Subject]]:
        if literal.signature in self._leads_to:
            leads = self._leads_to[literal.signature]
            return [(place, subject) for place, subjects in leads.items() for subject in subjects]
        facts = _FACTS.get(literal.signature)
        if facts is None or not all(
            subject in known.get(str(literal.arguments[place]), ()) for place, subject in facts.about.items()
        ):
            return []
        return list(facts.leads_to.items())

    def _lacking(self, parts: Iterable[Part], known: _Known, source: Source) -> "_Lacking | None":
        """Return the first thing that has to be of the tree, and is not known to be."""
        for part in parts:
            found = self._lacking_in(part, known, source)
            if found:
                return found
        return None

    def _lacking_in(self, part: Part, known: _Known, source: Source) -> "_Lacking | None":
        if isinstance(part, Literal):
            return self._lacking_of(part, known, source)
        if isinstance(part, Conditional):
            # it matters only where its condition holds and its literal does not
            against = part.literal
            if isinstance(against, Literal) and against.negations == 1:
                against = against._replace(negations=0)
                met = self._known((against, *part.condition), known)
            else:
                met = self._known(part.condition, known)
            return self._lacking((part.literal, *part.condition), met, source)
        if isinstance(part, Aggregate):
            for element in part.elements:
                met = self._known(element.condition, known)
                found = self._lacking(element.condition, met, source)
                if found:
                    return found
        if isinstance(part, Strange):
            return _Lacking("", Subject.UNIT, Further(f"{part.text} is nothing that is looked into", source))
        return None

    def _lacking_of(self, literal: Literal, known: _Known, source: Source) -> "_Lacking | None":
        signature = literal.signature
        if signature in self._further:
            return _Lacking("", Subject.UNIT, self._further[signature])
        if signature in self._about:
            about = self._about[signature]
        elif signature in _FACTS:
            about = _FACTS[signature].about
        else:
            doubt = self._dependence.doubt((literal,))
            return _Lacking("", Subject.UNIT, Further(doubt.reason, source)) if doubt else None
        for place, subject in about.items():
            term = literal.arguments[place]
            if subject not in known.get(str(term), ()):
                reason = f"{_atom(literal)} is about {_ARTICLES[subject]} that the tree need not have"
                return _Lacking(str(term) if _simple(term) else "", subject, Further(reason, source))
        return None


class _Lacking(NamedTuple):
    """A term that has to be of the tree, empty where none would do, and what is seen if it is not."""

    term: str
    subject: Subject
    further: Further


_ARTICLES = {Subject.UNIT: "a unit", Subject.OBJECT: "an object node", Subject.LABEL: "a label"}


def _simple(term: AST) -> bool:
    """Whether a term stands for the same wherever it is in a rule."""
    return term.ast_type == ASTType.SymbolicTerm or (term.ast_type == ASTType.Variable and term.name != "_")


def _atom(literal: Literal) -> str:
    name, arity = literal.signature
    arguments = ",".join(map(str, literal.arguments))
    return f"{name}({arguments})" if arity else name
