"""Completions for shells: the names of goals, objectives, constraints and constants of constraints."""

import os
from collections.abc import Callable, Iterable, Mapping
from itertools import chain

import click

from foon_asp.dataset import Dataset
from foon_asp.foon import load
from foon_asp.problem import Objective
from foon_asp.rules.constraint_library import library_constraints
from foon_asp.text.node_lookup import entry_names, nodes_beginning

MAX_COMPLETIONS = 200
"""The greatest number of completions: a shell cannot list more in a readable way."""

_TABLES = ("kitchen", "rates", "utensils", "goals", "unit_prices", "unit_amounts")

# Endings of the names of constants whose values are motions, or labels.
_MOTIONS, _LABELS = "_motion", ("_object", "_intermediate", "_ingredient")


def completed_words(context: click.Context, parameter: click.Parameter, prefix: str) -> list[str]:
    """Return the values of an option that begin with the typed word ``prefix``, read from the data."""
    return [*_COMPLETED[str(parameter.name)](context, prefix)]


def _read_dataset(context: click.Context) -> Dataset:
    """Read the data that the incomplete command line names, by default the bundled data.

    Lines that are not understood are left out.
    """
    parameters = context.params
    # an option without its value stops click before it assigns arguments to names
    sources = parameters.get("sources") or filter(os.path.exists, context.args)
    networks = (*sources, *(parameters.get("network") or ()))
    source = networks[0] if len(networks) == 1 else networks or parameters.get("folder")
    tables = {name: parameters.get(name) for name in _TABLES}
    measures, level = parameters.get("measures") or (), parameters.get("level") or 3
    return load(source, **tables, measures=measures, level=level, lenient=True).dataset


def _complete_goal(context: click.Context, prefix: str) -> Iterable[str]:
    """Return the names in the goals file that begin with ``prefix``, then nodes in one-line notation.

    A node is returned if its label or its notation begins with ``prefix``.
    """
    dataset = _read_dataset(context)
    names = dataset.names
    entries = _words_with_prefix(entry_names(dataset.goal_entries, names), prefix)
    return chain(entries, (str(names.node(o)) for o in nodes_beginning(prefix, names, MAX_COMPLETIONS)))


def _complete_objectives(context: click.Context, prefix: str) -> Iterable[str]:
    """Return completions of the last name in a list of objectives: ``units,success`` for ``units,s``.

    Objectives that the list has already are left out.
    """
    done, comma, last = prefix.rpartition(",")
    unused_names = [
        name for name in (*Objective, *_read_dataset(context).measures) if name not in done.split(",")
    ]
    return (f"{done}{comma}{objective}" for objective in _words_with_prefix(unused_names, last))


def _complete_constraint(context: click.Context, prefix: str) -> Iterable[str]:
    """Return the names of ready-made constraints; after ``NAME:``, the constants of this constraint."""
    name, colon, settings = prefix.partition(":")
    if not colon:
        return _words_with_prefix((constraint.name for constraint in library_constraints()), prefix)
    done, comma, last = settings.rpartition(",")
    return (f"{name}:{done}{comma}{constant}" for constant in _constants_of(name, context, last))


def _complete_constant(context: click.Context, prefix: str) -> Iterable[str]:
    """Return completions of ``CONSTANT=VALUE`` for the constraints that the command line names."""
    constraints = context.params.get("constraints") or ()
    names = [constraint.name.partition(":")[0] for constraint in constraints]
    return chain.from_iterable(_constants_of(name, context, prefix) for name in names)


def _constants_of(constraint: str, context: click.Context, prefix: str) -> Iterable[str]:
    """Return completions of ``CONSTANT=VALUE`` for a ready-made constraint.

    Up to the ``=``, the completions are the constants of the constraint. After it, they are motions or labels
    of the data: the ending of the constant's name says which. A constant with another ending has no
    completions.
    """
    name, equals, value = prefix.partition("=")
    if not equals:
        parameters = {entry.name: entry.parameters for entry in library_constraints()}
        names = (f"{parameter.name}=" for parameter in parameters.get(constraint, ()))
        return _words_with_prefix(names, prefix)
    values: Iterable[str] = ()
    if name.endswith(_MOTIONS):
        values = _words_with_prefix(_read_dataset(context).motions, value)
    elif name.endswith(_LABELS):
        values = _read_dataset(context).names.beginning(value, MAX_COMPLETIONS)
    return (f"{name}={value}" for value in values)


def _words_with_prefix(words: Iterable[str], prefix: str) -> Iterable[str]:
    return (word for word in words if word.startswith(prefix))


_COMPLETED: Mapping[str, Callable[[click.Context, str], Iterable[str]]] = {
    "goals_named": _complete_goal,
    "objectives": _complete_objectives,
    "constraints": _complete_constraint,
    "constants": _complete_constant,
}
