"""Conditions of PDDL: formulas over atoms, with variables or about objects.

No tuples, which would be equal where all have to hold and where one has to.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

Terms = tuple[str, ...]
"""Names of objects, and of variables, which begin with ``?``."""


class Atom(NamedTuple):
    """A predicate with its terms."""

    predicate: str
    terms: Terms

    def of(self, binding: Mapping[str, str]) -> "Atom":
        """Put objects in the place of variables."""
        return Atom(self.predicate, tuple(binding.get(term, term) for term in self.terms))

    def __str__(self) -> str:
        return f"({' '.join((self.predicate, *self.terms))})"


@dataclass(frozen=True, slots=True)
class Literal:
    """An atom that has to hold, or one that must not."""

    atom: Atom
    holds: bool


@dataclass(frozen=True, slots=True)
class Equal:
    """Two terms that have to be the same, or must not."""

    left: str
    right: str
    holds: bool


@dataclass(frozen=True, slots=True)
class All:
    """Conditions that all have to hold."""

    parts: "tuple[Formula, ...]"


@dataclass(frozen=True, slots=True)
class AnyOf:
    """Conditions of which one has to hold."""

    parts: "tuple[Formula, ...]"


@dataclass(frozen=True, slots=True)
class Quantified:
    """A condition on variables with their types: for all objects of these, or for ``some``."""

    some: bool
    variables: "tuple[Variable, ...]"
    part: "Formula"


class Variable(NamedTuple):
    """A variable, and the types that its object may have."""

    name: str
    types: tuple[str, ...]


Formula = Literal | Equal | All | AnyOf | Quantified

TRUE = All(())
FALSE = AnyOf(())


def literals(formula: Formula) -> Iterator[Literal]:
    """Give every literal in a formula."""
    if isinstance(formula, Literal):
        yield formula
    elif isinstance(formula, All | AnyOf):
        for part in formula.parts:
            yield from literals(part)
    elif isinstance(formula, Quantified):
        yield from literals(formula.part)


def negated(formula: Formula) -> Formula:
    """Give what holds where a formula does not; ``not`` stands before atoms alone."""
    if isinstance(formula, Literal | Equal):
        return replace(formula, holds=not formula.holds)
    if isinstance(formula, Quantified):
        return Quantified(not formula.some, formula.variables, negated(formula.part))
    parts = tuple(map(negated, formula.parts))
    return AnyOf(parts) if isinstance(formula, All) else All(parts)


Objects = Mapping[tuple[str, ...], Sequence[str]]
"""The objects that a variable can stand for, by its types."""


def expanded(formula: Formula, objects: Objects) -> tuple[Formula, tuple[Variable, ...]]:
    """Put every object in the place of variables that stand for all, or for some within an alternative.

    Variables for some object that stand outside of all alternatives may as well be parameters: these are
    given, by names that no others have.
    """
    found: list[Variable] = []
    return _expanded(formula, {}, objects, found, outside=True), tuple(found)


def _expanded(
    formula: Formula, binding: Mapping[str, str], objects: Objects, found: list[Variable], outside: bool
) -> Formula:
    if isinstance(formula, Literal):
        return Literal(formula.atom.of(binding), formula.holds)
    if isinstance(formula, Equal):
        left, right = (binding.get(term, term) for term in (formula.left, formula.right))
        return _settled(Equal(left, right, formula.holds))
    if isinstance(formula, All | AnyOf):
        every = isinstance(formula, All)
        parts = [_expanded(part, binding, objects, found, outside and every) for part in formula.parts]
        return _joined(every, parts)
    bindings = [dict(binding)]
    for variable in formula.variables:
        if formula.some and outside:
            fresh = variable._replace(name=f"{variable.name};{len(found)}")
            found.append(fresh)
            bindings[0][variable.name] = fresh.name
        else:
            bindings = [{**each, variable.name: o} for each in bindings for o in objects[variable.types]]
    parts = [_expanded(formula.part, each, objects, found, outside) for each in bindings]
    return parts[0] if formula.some and outside else _joined(not formula.some, parts)


def _settled(equal: Equal) -> Formula:
    if equal.left == equal.right:
        return TRUE if equal.holds else FALSE
    if "?" in (equal.left[0], equal.right[0]):
        return equal
    return FALSE if equal.holds else TRUE


def _joined(every: bool, parts: Sequence[Formula]) -> Formula:
    """Join parts that all have to hold, or one of which has to; what is known of them drops out."""
    neutral, decisive = (TRUE, FALSE) if every else (FALSE, TRUE)
    kind = All if every else AnyOf
    left: dict[Formula, None] = {}
    for part in parts:
        if part == decisive:
            return decisive
        left.update(dict.fromkeys(part.parts if isinstance(part, kind) else (part,)))
    left.pop(neutral, None)
    return next(iter(left)) if len(left) == 1 else kind(tuple(left))
