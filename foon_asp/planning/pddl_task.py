"""A domain and a problem of PDDL, as far as they are STRIPS with action costs and ADL."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from typing import NamedTuple

from foon_asp.planning.formula import Atom, Formula, Terms, Variable
from foon_asp.planning.pddl_form import PddlText


class Effect(NamedTuple):
    """An atom that an action adds or deletes, for all objects of some ``variables``, under a condition.

    ``at`` is its place in the file of the domain.
    """

    variables: tuple[Variable, ...]
    condition: Formula
    atom: Atom
    adds: bool
    at: int


class Schema(NamedTuple):
    """An action with its parameters; ``costs`` are numbers, and functions that give them, to be added up."""

    name: str
    parameters: tuple[Variable, ...]
    condition: Formula
    effects: tuple[Effect, ...]
    costs: tuple[Fraction | Atom, ...]
    at: int


@dataclass(frozen=True)
class PddlDomain:
    """What a domain declares.

    ``supertypes`` has for each type those that it belongs to, itself among them. ``predicates`` and
    ``functions`` have the number of their terms.
    """

    text: PddlText
    supertypes: dict[str, set[str]] = field(default_factory=dict)
    constants: dict[str, set[str]] = field(default_factory=dict)
    predicates: dict[str, int] = field(default_factory=dict)
    functions: dict[str, int] = field(default_factory=dict)
    schemas: list[Schema] = field(default_factory=list)


@dataclass(frozen=True)
class PddlTask:
    """A task: ``objects`` with their types, what holds at the start, values of functions, and the goal.

    ``costed`` says that the sum of costs is what is best, and not the number of actions.
    """

    domain: PddlDomain
    text: PddlText
    objects: Mapping[str, set[str]]
    start: frozenset[Atom]
    values: Mapping[tuple[str, Terms], Fraction]
    goal: Formula
    costed: bool
