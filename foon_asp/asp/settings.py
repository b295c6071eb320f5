"""Settings of the search: constraints, encodings, reductions and limits."""

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
    """Constraints that are rewritten, so that a tree may break them or the search may drop them.

    ``constraints``: the original constraints. They are checked, but not loaded.
    ``rules``: the text of the rewritten rules.
    ``encoding``: the built-in file of ``encodings/questions`` that is loaded with the rules.
    ``places``: the source of each rewritten rule, by its text.
    ``files``: the files that the places are in.
    """

    constraints: tuple[Constraint, ...]
    rules: str
    encoding: Path
    places: Mapping[str, Source]
    files: tuple[Loaded, ...]


class Bounded(NamedTuple):
    """Upper bounds on the costs of a tree, as built-in encodings.

    ``rules``: the facts that the encodings read.
    ``files``: encodings of ``encodings/questions``.
    ``below``: mappings from objectives to costs with fractions. A tree has to cost less than at least one
    cost of each mapping. The mappings are written as facts once the scale of the costs is known.
    ``incomparable``: known plans, as numbers of executions by unit id; no plan may contain one.

    The bounds are antimonotone: if a tree meets them, so does each subtree. Therefore, units that the goals
    do not need can be ignored. If items are used up, there are no rules and files, and each mapping of
    ``below`` has one cost.
    """

    rules: str = ""
    files: tuple[Path, ...] = ()
    below: tuple[Mapping[Objective, int | Fraction], ...] = ()
    incomparable: tuple[Mapping[int, int], ...] = ()


class Settings(NamedTuple):
    """Settings of the search: constraints, encodings, reductions and limits.

    ``constraints``: user rules, which are added to the encodings.
    ``encodings``: a folder whose files replace the built-in encodings; ``None`` to use the built-in ones.
    ``constants``: settings of constants, ``NAME=VALUE``.
    ``clingo_options``: options that go to clingo unchanged.
    ``reductions``: the reductions to make before the search. They are made as far as constraints allow. With
    bounds or other encodings, none are made.
    ``relaxed``: rewritten constraints that trees may break; ``None`` for none.
    ``bounded``: upper bounds on costs; ``None`` for none.
    ``deadline``: the limits on everything from the reductions to the last proof, whose time is running;
    ``None`` for no limits.
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
        """The folder of encodings that replace the built-in ones; ``None`` without one.

        If files of the built-in folder itself were changed, this is the built-in folder.
        """
        if self.encodings is None:
            built_in_folder = encodings_folder()
            return None if all(is_own(built_in_folder / name) for name in ENCODING_FILES) else built_in_folder
        return self.encodings

    @property
    def asks_for_statistics(self) -> bool:
        """Whether ``clingo_options`` request clingo's statistics."""
        return asks_for_statistics(self.clingo_options)

    @property
    def effective_deadline(self) -> Deadline:
        """The ``deadline``; if it is ``None``, a new :class:`Deadline` without limits, which begins now."""
        return self.deadline or Deadline()
