"""How to solve, and under which constraints."""

from collections.abc import Mapping
from fractions import Fraction
from pathlib import Path
from typing import NamedTuple

from foon_asp.deadline import Deadline
from foon_asp.encoding.own_encodings import ENCODING_FILES, is_own
from foon_asp.encoding.run import asks_for_statistics
from foon_asp.encoding.stated import Loaded
from foon_asp.hypergraph.reductions import ALL, Reduction
from foon_asp.network import Source
from foon_asp.problem import Objective
from foon_asp.resources import encodings_folder
from foon_asp.rules.passed_constraint import Constraint


class Relaxed(NamedTuple):
    """Constraints that are loaded rewritten.

    They are checked like others, but replaced by ``rules`` and the built-in ``encoding``, a file of
    ``encodings/questions``. ``places`` maps the text of each rule to its place in ``files``.
    """

    constraints: tuple[Constraint, ...]
    rules: str
    encoding: Path
    places: Mapping[str, Source]
    files: tuple[Loaded, ...]


class Bounded(NamedTuple):
    """Upper bounds on the costs of a tree, as built-in encodings.

    ``files``: encodings of ``encodings/questions``.
    ``rules``: the facts that these read.
    ``below``: mappings of costs with fractions, by objective; of each, a tree has to be below at least one
    cost. They are written once their scale is known.
    ``incomparable``: known plans, as executions by unit; no plan may contain one.

    The bounds are antimonotone: every subtree of a tree that meets them meets them, too, so units that the
    goals do not need cannot matter. If items are used up, there are no rules and files, and each of ``below``
    has one cost.
    """

    rules: str = ""
    files: tuple[Path, ...] = ()
    below: tuple[Mapping[Objective, int | Fraction], ...] = ()
    incomparable: tuple[Mapping[int, int], ...] = ()


class Settings(NamedTuple):
    """Settings of the search: constraints, encodings, reductions and limits.

    ``constraints`` are added to the encodings; ``encodings`` is a folder whose files replace the built-in
    ones; ``constants`` are ``NAME=VALUE`` settings; ``clingo_options`` go to clingo unchanged.
    ``reductions`` come before the search as far as constraints allow, and not with bounds or other encodings.
    ``relaxed`` are rewritten constraints, ``bounded`` are upper bounds on costs. ``deadline`` is for
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
        """The folder of encodings that replace the built-in ones, ``None`` where these are unchanged."""
        if self.encodings is None:
            ours = encodings_folder()
            return None if all(is_own(ours / name) for name in ENCODING_FILES) else ours
        return self.encodings

    @property
    def asks_for_statistics(self) -> bool:
        """Whether the options request clingo's statistics."""
        return asks_for_statistics(self.clingo_options)

    @property
    def begun(self) -> Deadline:
        """The deadline that has begun, or one without limits that begins now."""
        return self.deadline or Deadline()
