"""How to solve, and under which constraints."""

from collections.abc import Mapping
from fractions import Fraction
from pathlib import Path
from typing import NamedTuple

from foon_asp.deadline import Deadline
from foon_asp.encoding.own_encodings import ENCODING_FILES, is_own
from foon_asp.grounding.run import asks_for_statistics
from foon_asp.grounding.stated import Loaded
from foon_asp.network import Source
from foon_asp.problem import Objective
from foon_asp.reduce.reductions import ALL, Reduction
from foon_asp.resources import encodings_folder
from foon_asp.rules.constraint import Constraint


class Relaxed(NamedTuple):
    """Constraints that are loaded rewritten.

    They are looked over like others, but ``rules`` stand in for what they say, together with ``encoding``,
    one of ours (``encodings/questions``). ``places`` says where each rule comes from, in ``files``.
    """

    constraints: tuple[Constraint, ...]
    rules: str
    encoding: Path
    places: Mapping[str, Source]
    files: tuple[Loaded, ...]


class Bounded(NamedTuple):
    """Upper bounds on the costs of a tree, as encodings of ours.

    ``files`` are encodings of ours (``encodings/questions``) and ``rules`` the facts that they read. A tree
    that meets them has to meet them still when units are left out of it: then what the goals do not need
    cannot matter, bounded or not. ``below`` are sets of costs, in each of which a tree has
    to be below one: those of objectives that are fractions, written down when it is known to which scale.
    Where items are used up there are no rules and files, and each of these sets has one cost; plans are
    ``beside`` others, by how often these execute which units: none does all of that as often.
    """

    rules: str = ""
    files: tuple[Path, ...] = ()
    below: tuple[Mapping[Objective, int | Fraction], ...] = ()
    beside: tuple[Mapping[int, int], ...] = ()


class Settings(NamedTuple):
    """How to solve, and under which constraints.

    ``constraints`` are added to the encodings; ``encodings`` is a folder whose files replace ours;
    ``constants`` are ``NAME=VALUE`` settings; ``clingo_options`` go to clingo as they are.
    ``reductions`` come before the search as far as constraints allow, and not with bounds or other encodings.
    ``relaxed`` are constraints in other words. Trees keep to what is ``bounded``. ``deadline`` is for
    everything from the cut to the last proof, and has begun.
    """

    constraints: tuple[Constraint, ...] = ()
    encodings: Path | None = None
    constants: tuple[str, ...] = ()
    clingo_options: tuple[str, ...] = ()
    reductions: frozenset[Reduction] = ALL
    relaxed: Relaxed | None = None
    bounded: Bounded | None = None
    deadline: Deadline | None = None

    @property
    def replaced(self) -> Path | None:
        """The folder of encodings that replace ours: our own folder where a file was changed in place."""
        if self.encodings is None:
            ours = encodings_folder()
            return None if all(is_own(ours / name) for name in ENCODING_FILES) else ours
        return self.encodings

    @property
    def asks_for_statistics(self) -> bool:
        """Whether clingo's statistics are asked for."""
        return asks_for_statistics(self.clingo_options)

    @property
    def begun(self) -> Deadline:
        """The deadline that has begun, or one without limits that begins now."""
        return self.deadline or Deadline()
