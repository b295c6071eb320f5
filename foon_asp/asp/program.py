"""The clingo program of one question."""

from collections.abc import Collection
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from foon_asp.encoding.own_encodings import question_encoding
from foon_asp.encoding.stated import Loaded
from foon_asp.errors import UserError
from foon_asp.problem import Objective, Problem

if TYPE_CHECKING:  # clingo, which is not needed where no rule is added
    from foon_asp.rules.ready_made import ReadyMade
    from foon_asp.rules.rules import Rules


class Program(NamedTuple):
    """Encodings in the order of loading, and clingo's arguments.

    ``files``: the encodings and user rules.
    ``exact_success``: an encoding for exact comparison of products of rates, loaded after ``files``.
    ``arguments``: clingo's arguments; arguments that set constants come first.
    ``constants``: the arguments that set constants.
    ``replaced``: whether some of the first three files differ from the built-in ones.
    ``is_built_in``: whether every rule is built in, so that units that the goals do not need cannot matter.
    ``rules``: rules as text, in addition to the files.
    ``bounded``: whether bounds on costs may exclude trees.
    ``looked_at``: the predicates that user rules read, by name and arity.
    ``text``: the content of the files when they were checked; empty if all files are built in.
    ``endless``: whether grounding may not terminate.
    ``encodings``: the folder that replaces the built-in encodings; ``None`` without one.
    ``ours``: the files without those that the user added.
    ``understood``: the user rules, analysed. ``None`` without user rules, if encodings are replaced, or if
    rules may be broken or dropped.
    ``named``: the names of the constants that encodings and user rules define.
    ``reads``: the predicates that user rules read and that have facts only in some questions. Each is a pair
    of its name and its first argument. If the first argument is no name, the pair has an empty text.
    ``ready_made``: the user rules, if all are ready-made constraints; else ``None``. If they are ready-made,
    ``files`` does not have them.
    ``whole``: if the user rules are ready-made, the program with them, for searches with clingo.
    """

    files: tuple[Loaded, ...]
    exact_success: Path
    arguments: tuple[str, ...]
    replaced: bool
    is_built_in: bool
    rules: str = ""
    bounded: bool = False
    looked_at: frozenset[tuple[str, int]] = frozenset()
    text: str = ""
    endless: bool = False
    constants: tuple[str, ...] = ()
    encodings: Path | None = None
    ours: tuple[Path, ...] = ()
    understood: "Rules | None" = None
    named: frozenset[str] = frozenset()
    reads: frozenset[tuple[str, str]] = frozenset()
    ready_made: "ReadyMade | None" = None
    whole: "Program | None" = None

    @property
    def added(self) -> "Rules | ReadyMade | None":
        """The user rules, ready-made or analysed; ``None`` if they are neither."""
        return self.ready_made or self.understood

    def require_facts(self, problem: Problem, objectives: Collection[Objective]) -> None:
        """Raise :class:`UserError` if user rules read facts that a question by these objectives lacks."""
        terms = {objective.row.term for objective in objectives if objective.row.is_fact}
        for name, first in sorted(self.reads):
            if name == "cost" and (first not in terms if first else not terms):
                raise UserError(
                    f"a rule looks at cost({first or 'Objective'},U,N), which only a question by such an "
                    "objective has: name it with --objective, or look at price/2 or facts of the network"
                )
            if name != "cost" and problem.rates is None:
                raise UserError(
                    f"a rule looks at {name}/2, and no success rates are known: give a file of rates, with "
                    "--rates FILE or in Python load(..., rates=FILE)"
                )

    @property
    def settled(self) -> "Program":
        """The program without user rules, for a problem whose restriction has their effect."""
        return self._replace(
            files=(*self.ours, question_encoding("required.lp")),
            arguments=self.arguments[len(self.constants) :],
            constants=(),
            is_built_in=True,
            looked_at=frozenset(),
            text="",
            endless=False,
            understood=None,
            ready_made=None,
            whole=None,
        )
