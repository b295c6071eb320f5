"""The encodings of one question, put together."""

from collections.abc import Collection
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from foon_asp.encoding.own_encodings import question_encoding
from foon_asp.errors import UserError
from foon_asp.grounding.stated import Loaded
from foon_asp.problem import Objective, Problem

if TYPE_CHECKING:  # clingo, which is not needed where no rule is added
    from foon_asp.rules.ready_made import ReadyMade
    from foon_asp.rules.rules import Rules


class Program(NamedTuple):
    """Encodings in the order of loading, and clingo's arguments.

    ``constants`` are those of the ``arguments`` that set constants. ``rules`` are added to them as text.
    ``exact_success`` is loaded beside ``files`` when products of rates are compared exactly. ``replaced``
    says that not all of the first three files say what ours say. ``own`` says that every rule is ours, so
    that what the goals do not need cannot matter. ``bounded`` says that a tree of the unbounded question need
    not be one. ``looked_at`` are the predicates, by name and arity, that rules of the user's look at.
    ``text`` is all that the files said when they were looked over. ``endless`` says that nobody knows whether
    its grounding comes to an end. ``encodings`` is the folder whose encodings are used in place of ours.
    ``ours`` are the files but for those that the user added. ``understood`` are the rules that are added,
    looked into: ``None`` where there are none, where encodings are replaced, and where some of the rules may
    be broken or dropped. ``named`` are the names of constants that files define. Where all rules are
    ``ready_made`` constraints, clingo is asked the ``whole`` program. ``reads`` are
    predicates that rules of the user's own read and not every question has facts of, with their first
    argument where it is a name.
    """

    files: tuple[Loaded, ...]
    exact_success: Path
    arguments: tuple[str, ...]
    replaced: bool
    own: bool
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
        """What is known of the rules that are added."""
        return self.ready_made or self.understood

    def require_facts(self, problem: Problem, objectives: Collection[Objective]) -> None:
        """Raise :class:`UserError` for facts that rules read and that are not there."""
        known = {objective.row.term for objective in objectives if objective.row.is_fact}
        for name, first in sorted(self.reads):
            if name == "cost" and (first not in known if first else not known):
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
        """The same without the user's rules, where they are applied to the problem before."""
        return self._replace(
            files=(*self.ours, question_encoding("required.lp")),
            arguments=self.arguments[len(self.constants) :],
            constants=(),
            own=True,
            looked_at=frozenset(),
            text="",
            endless=False,
            understood=None,
            ready_made=None,
            whole=None,
        )
