"""The program that tells which units rules rule out, and of which they ask for one.

An atom that one unit of the tree decides gets that unit as another argument: ``done :- use(U), hot(U)``
becomes ``_lifted_done(U) :- _lifted_use(U,U), hot(U)``. So nothing is left to decide, and clingo only
derives. What holds without any unit has ``NOBODY`` in its place.
"""

from collections.abc import Iterable, Sequence

from foon_asp.rules.clause import (
    Aggregate,
    Clause,
    Conditional,
    Literal,
    Part,
    Signature,
    global_variables,
    literals,
)
from foon_asp.rules.rule_kind import Analysis, Kind

NOBODY = -1

_BASE = f"""
#show.
#defined unit/1. #defined kitchen/1. #defined gives/2.
_lifted_use(U,U) :- unit(U).
_lifted_available({NOBODY},O) :- kitchen(O).
_lifted_available(U,O) :- unit(U), gives(U,O).
"""
_READ_BY_BASE: frozenset[Signature] = frozenset({("unit", 1), ("kitchen", 1), ("gives", 2)})


class LiftedProgram:
    """Some rules of an analysis, by their places in it, lifted.

    In its one answer, ``_removed(U)`` says that a unit breaks a rule, or that it is broken by ``NOBODY``;
    ``_asks(R)`` that requiring rule number R asks for a unit, and ``_helps_R(U)`` that this is one. ``reads``
    are the predicates of facts that it looks at. ``more`` are heads and bodies of other rules, which no unit
    of the tree decides.
    """

    def __init__(
        self, analysis: Analysis, numbers: Iterable[int], more: Iterable[tuple[str, tuple[Part, ...]]] = ()
    ) -> None:
        self._analysis = analysis
        definitions = [str(each) for each in analysis.definitions]
        self._lines = [*definitions, _BASE]
        self.predicates: list[Signature] = [("_removed", 1), ("_asks", 1)]
        reads: set[Signature] = set()
        for head, body in more:
            self._line(head, [part.text for part in body])
            reads |= {literal.signature for literal in literals(body)}
        for number in numbers:
            for clause in analysis.of_rule[number]:
                if analysis.rules[number].kind is Kind.REQUIRING:
                    self._add_requiring(number, clause)
                else:
                    self._add("_removed", clause, clause.body)
                reads |= {literal.signature for literal in literals(clause.body)}
            if analysis.rules[number].kind is Kind.REQUIRING:
                self.predicates.append((f"_helps_{number}", 1))
        self.reads = self._add_helpers(reads) | _READ_BY_BASE

    @property
    def text(self) -> str:
        """The program, without facts."""
        return "\n".join(self._lines) + "\n"

    def _add_helpers(self, reads: set[Signature]) -> set[Signature]:
        """Add the rules of all helpers that are read; gives everything that is read then."""
        waiting = [clause for clause in self._analysis.live if clause.head is not None]
        added = True
        while added:
            needed = [c for c in waiting if c.head is not None and c.head.signature in reads]
            added = bool(needed)
            waiting = [clause for clause in waiting if clause not in needed]
            for clause in needed:
                assert clause.head is not None
                reads |= {literal.signature for literal in literals(clause.body)}
                if clause.head.signature in self._analysis.lifted:
                    arguments = ",".join(map(str, clause.head.arguments))
                    self._add(f"_lifted_{clause.head.signature[0]}", clause, clause.body, arguments)
                else:
                    self._line(clause.head.text, [part.text for part in clause.body])
        return reads

    def _add(self, name: str, clause: Clause, body: Sequence[Part], arguments: str = "") -> None:
        """Add a rule for an atom whose first argument is the unit that decides it."""
        deciding = self._analysis.deciding(body)
        who = _variable(clause) if deciding else str(NOBODY)
        texts = [_lifted(part, who) if part in deciding else part.text for part in body]
        self._line(f"{name}({who},{arguments})" if arguments else f"{name}({who})", texts)

    def _add_requiring(self, number: int, clause: Clause) -> None:
        deciding = self._analysis.deciding(clause.body)
        self._line(f"_asks({number})", [part.text for part in clause.body if part not in deciding])
        for part in deciding:
            for body in _helping(part):
                self._add(f"_helps_{number}", clause, body)

    def _line(self, head: str, body: Sequence[str]) -> None:
        self._lines.append(f"{head} :- {'; '.join(body)}." if body else f"{head}.")


def stands_alone(clauses: Sequence[Clause]) -> bool:
    """Whether a requiring rule asks for one set.

    It does not where pools make several rules of it, or where it asks for a set for each of some values of
    variables.
    """
    return len(clauses) == 1 and not any(
        variable for part in clauses[0].body for variable in global_variables(part)
    )


def _helping(part: Part) -> list[tuple[Part, ...]]:
    """Give the bodies that say which units a part of a requiring rule asks for."""
    if isinstance(part, Literal):
        return [(_positive(part),)]
    if isinstance(part, Conditional):
        assert isinstance(part.literal, Literal)
        return [(_positive(part.literal), *part.condition)]
    assert isinstance(part, Aggregate)
    return [element.condition for element in part.elements]


def _positive(literal: Literal) -> Literal:
    return literal._replace(negations=0)


def _lifted(part: Part, who: str) -> str:
    assert isinstance(part, Literal)
    arguments = ",".join(map(str, (who, *part.arguments)))
    return f"_lifted_{part.signature[0]}({arguments})"


def _variable(clause: Clause) -> str:
    """Give a variable that a rule does not have."""
    name = "Unit"
    text = " ".join(part.text for part in clause.body)
    while name in text:
        name += "_"
    return name
