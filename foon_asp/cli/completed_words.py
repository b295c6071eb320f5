"""Words that shells complete: goals, objectives, constraints and their constants."""

import os
from collections.abc import Callable, Iterable, Mapping
from itertools import chain

import click

from foon_asp.dataset import Dataset
from foon_asp.foon import load
from foon_asp.problem import Objective
from foon_asp.rules.constraint_library import library_constraints
from foon_asp.text.goal_name import entry_names, nodes_beginning

_MAX_NAMES = 200

# Constants whose values are names: those that end so are motions, or labels.
_MOTIONS, _LABELS = "_motion", ("_object", "_intermediate", "_ingredient")


def completed_words(context: click.Context, parameter: click.Parameter, begun: str) -> list[str]:
    """Return the values that begin like what is typed, for an option that names something in the data."""
    return [*_COMPLETED[str(parameter.name)](context, begun)]


def _dataset(context: click.Context) -> Dataset:
    """Return the data that the line names so far."""
    given = context.params
    # an option that lacks its value ends click's parsing before arguments have their names
    sources = given.get("sources") or filter(os.path.exists, context.args)
    networks = (*sources, *(given.get("network") or ()))
    source = networks[0] if len(networks) == 1 else networks or given.get("folder")
    tables = {name: given.get(name) for name in ("kitchen", "rates", "utensils", "goals", "unit_prices")}
    measures, level = given.get("measures") or (), given.get("level") or 3
    return load(source, **tables, measures=measures, level=level, lenient=True).dataset


def _goals(context: click.Context, begun: str) -> Iterable[str]:
    """Return the labels of the goals file, then all other nodes."""
    dataset = _dataset(context)
    names = dataset.names
    listed = _beginning(entry_names(dataset.listed, names), begun)
    return chain(listed, (str(names.node(o)) for o in nodes_beginning(begun, names, _MAX_NAMES)))


def _objectives(context: click.Context, begun: str) -> Iterable[str]:
    """Return a list of objectives with one more at its end."""
    done, comma, last = begun.rpartition(",")
    others = [name for name in (*Objective, *_dataset(context).measures) if name not in done.split(",")]
    return (f"{done}{comma}{objective}" for objective in _beginning(others, last))


def _constraints(context: click.Context, begun: str) -> Iterable[str]:
    """Return the names of ready-made constraints, or what may follow after one."""
    name, colon, settings = begun.partition(":")
    if not colon:
        return _beginning((each.name for each in library_constraints()), begun)
    done, comma, last = settings.rpartition(",")
    return (f"{name}:{done}{comma}{each}" for each in _constants_of(name, context, last))


def _constants(context: click.Context, begun: str) -> Iterable[str]:
    """Return the constants of the constraints that the line has so far."""
    names = [each.name.partition(":")[0] for each in context.params.get("constraints") or ()]
    return chain.from_iterable(_constants_of(name, context, begun) for name in names)


def _constants_of(constraint: str, context: click.Context, begun: str) -> Iterable[str]:
    """Return the constants of a ready-made constraint, or values of one that is a motion or a label."""
    name, equals, value = begun.partition("=")
    if not equals:
        ours = {each.name: each.parameters for each in library_constraints()}
        return _beginning((f"{parameter.name}=" for parameter in ours.get(constraint, ())), begun)
    values: Iterable[str] = ()
    if name.endswith(_MOTIONS):
        values = _beginning(_dataset(context).motions, value)
    elif name.endswith(_LABELS):
        values = _dataset(context).names.beginning(value, _MAX_NAMES)
    return (f"{name}={each}" for each in values)


def _beginning(known: Iterable[str], begun: str) -> Iterable[str]:
    return (each for each in known if each.startswith(begun))


_COMPLETED: Mapping[str, Callable[[click.Context, str], Iterable[str]]] = {
    "goals_named": _goals,
    "objectives": _objectives,
    "constraints": _constraints,
    "constants": _constants,
}
