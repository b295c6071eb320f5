"""Completions of the last word of a line in a session."""

import itertools
from collections.abc import Callable, Iterable
from itertools import islice
from typing import NamedTuple, Protocol

import click

from foon_asp.cli.shell_kitchen import ShellKitchen
from foon_asp.cli.shell_line import quoted, take_apart
from foon_asp.cli.shell_session import QUESTIONS, WORDS, ShellSession
from foon_asp.cli.verbs import verb_command
from foon_asp.problem import ContainerRule, Objective
from foon_asp.rules.constraint_library import library_constraints
from foon_asp.text.data_folder import STARTING
from foon_asp.text.goal_name import NodeNames, nodes_beginning, notation

MOST = 200
"""How many candidates are shown."""

# Constants whose values are names: those that end so are motions, or labels.
_MOTIONS, _LABELS = "_motion", ("_object", "_intermediate", "_ingredient")


class Known(Protocol):
    """What names come from."""

    @property
    def kitchen(self) -> ShellKitchen:
        """What is at hand, and all object nodes there are."""

    @property
    def constraints(self) -> Iterable[object]:
        """The constraints whose constants may be given, by name."""


class Candidates(NamedTuple):
    """Texts that may replace the line from ``column`` on, counted from 0."""

    start: int
    texts: tuple[str, ...]


def candidates(text: str, session: ShellSession) -> Candidates:
    """Give completions of the last word of a line: words, nodes, constraints, options and their values."""
    line = take_apart(text)
    words = list(line.words)
    if not line.open_quote and (not words or text[-1:].isspace()):
        fragment, start = "", len(text)
    else:
        fragment, start = words.pop()
    before = [word.text for word in words]
    if before[:1] == ["foon-asp"]:
        del before[0]
    found = dict.fromkeys(_words(before, fragment, session))
    return Candidates(start, tuple(quoted(each) for each in islice(found, MOST)))


def _words(before: list[str], fragment: str, session: ShellSession) -> Iterable[str]:
    """Give words that begin like the fragment and may follow the words before it."""
    if not before:
        return beginning([*WORDS, *QUESTIONS], fragment)
    first, *rest = before
    if first in QUESTIONS:
        return option_words(first, before[-1], fragment, session)
    if first == "constraint" and rest:
        return _constants(rest[0], fragment, session)
    kitchen = session.kitchen
    known: dict[str, Callable[[], Iterable[str]]] = {
        "goal": lambda: _goals(fragment, session),
        "have": lambda: _nodes(fragment, kitchen.names),
        "lack": lambda: _nodes(fragment, kitchen.names_at_hand),
        "objective": lambda: _list(fragment, session),
        "kitchen": lambda: beginning([str(STARTING)], fragment),
        "containers": lambda: beginning(ContainerRule, fragment),
        "constraint": lambda: _constraints(fragment, session),
        "drop": lambda: beginning(map(str, session.constraints), fragment),
        "time-limit": lambda: beginning(["none"], fragment),
        "help": lambda: beginning([*WORDS, *QUESTIONS], fragment),
    }
    return known[first]() if first in known else ()


def option_words(verb: str, last: str, fragment: str, session: Known) -> Iterable[str]:
    """Give the options of a verb, or the values of the option before the fragment."""
    options = [each for each in verb_command(verb).params if isinstance(each, click.Option)]
    option = next((each for each in options if last in each.opts and not each.is_flag), None)
    if option is None:
        names = (name for each in options for name in each.opts if name.startswith("--"))
        return beginning(sorted(names), fragment)
    known: dict[str | None, Callable[[], Iterable[str]]] = {
        "goals_named": lambda: _goals(fragment, session),
        "objectives": lambda: _list(fragment, session),
        "constraints": lambda: _constraints(fragment, session),
        "constants": lambda: itertools.chain(
            *(_constants(str(name), fragment, session) for name in session.constraints)
        ),
    }
    if option.name in known:
        return known[option.name]()
    choices = option.type.choices if isinstance(option.type, click.Choice) else ()
    return beginning(map(str, choices), fragment)


def _goals(fragment: str, session: Known) -> Iterable[str]:
    """Give the labels of the goals file, then all other nodes."""
    yield from beginning((entry.pattern.label for entry in session.kitchen.dataset.listed), fragment)
    yield from _nodes(fragment, session.kitchen.names)


def _nodes(fragment: str, names: NodeNames) -> Iterable[str]:
    return (notation(names.node(o)) for o in nodes_beginning(fragment, names, MOST))


def _list(fragment: str, session: Known) -> Iterable[str]:
    """Complete a list of objectives."""
    done, comma, last = fragment.rpartition(",")
    left = [name for name in (*Objective, *session.kitchen.dataset.measures) if name not in done.split(",")]
    return (f"{done}{comma}{objective}" for objective in beginning(left, last))


def _constraints(fragment: str, session: Known) -> Iterable[str]:
    """Give the names of ready-made constraints, or what may follow behind one."""
    name, colon, settings = fragment.partition(":")
    if not colon:
        return beginning((each.name for each in library_constraints()), fragment)
    done, comma, last = settings.rpartition(",")
    return (f"{name}:{done}{comma}{each}" for each in _constants(name, last, session))


def _constants(constraint: str, fragment: str, session: Known) -> Iterable[str]:
    """Give the constants of a ready-made constraint, or values of a constant that is a motion or a label."""
    name, equals, value = fragment.partition("=")
    if not equals:
        ours = {each.name: each.parameters for each in library_constraints()}
        return beginning((f"{parameter.name}=" for parameter in ours.get(constraint, ())), fragment)
    if name.endswith(_MOTIONS):
        values = beginning(session.kitchen.dataset.motions, value)
    elif name.endswith(_LABELS):
        values = session.kitchen.names.beginning(value, MOST)
    else:
        values = ()
    return (f"{name}={each}" for each in values)


def beginning(known: Iterable[str], fragment: str) -> Iterable[str]:
    """Give those of the known words that begin like a fragment."""
    return (each for each in known if each.startswith(fragment))
