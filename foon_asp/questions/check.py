"""Does a tree that some program wrote execute?"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from os import PathLike
from typing import TYPE_CHECKING

from foon_asp.dataset.paths import File, Files
from foon_asp.deadline import Cancel
from foon_asp.document.json_document import costs_json, document
from foon_asp.errors import UserError
from foon_asp.network import FunctionalUnit, counted
from foon_asp.problem import Problem
from foon_asp.problem.progress import OnProgress
from foon_asp.proof.replay import Replay, replay_for
from foon_asp.proof.simulation import Simulation, Verdict, simulate_for
from foon_asp.questions.arguments import Constants, settings, whole
from foon_asp.questions.contract import Kind, Option, question
from foon_asp.questions.options import CONTAINERS, GOALS, ITEMS, RULES
from foon_asp.questions.result import Ending, Result
from foon_asp.questions.tree import Tree
from foon_asp.report.drawing import Drawing
from foon_asp.report.replay import replay_json, replay_text
from foon_asp.report.verdict import Listed, verdict_json, verdict_text
from foon_asp.text.json_value import Json

if TYPE_CHECKING:  # clingo, which only rules need
    from foon_asp.asp import Settings
    from foon_asp.asp.breaking import Breaking
    from foon_asp.asp.integrity import IntegrityConstraint


@dataclass(frozen=True, repr=False)
class Checked(Result):
    """The ``tree`` that was simulated, and the ``simulation`` with its ``verdict`` and what stops the tree.

    Where items are used up, the tree is a plan, whose order and repeats count, and ``replay`` says what
    became of each copy; otherwise it is ``None``. ``ruled`` says that there are rules to keep to, and
    ``breaks`` has those that the tree breaks: each with its ``source`` and ``text``. It is ``None`` without
    rules, and for a tree that does not execute, or has units of its own.

    Example:
        >>> problem = foon_asp.load().problem("ice")
        >>> foon_asp.check(problem, foon_asp.solve(problem).tree).executes
        True
    """

    tree: Tree
    simulation: Simulation
    replay: Replay | None = None
    ruled: bool = False
    breaks: "tuple[IntegrityConstraint, ...] | None" = None

    @property
    def executes(self) -> bool:
        """Whether the tree executes, as listed or in another order; a plan, as listed."""
        if self.replay is not None:
            return self.replay.shortage is None
        return self.simulation.verdict is not Verdict.NEVER

    @property
    def in_order(self) -> Tree | None:
        """The tree in an order that executes, ``None`` where no order does."""
        if not self.executes:
            return None
        if self.replay is not None:
            return self.tree
        units, places = self.tree.units, self.tree.places
        order = self.simulation.order
        return Tree(tuple(units[n] for n in order), self.tree.problem, tuple(places[n] for n in order))

    @property
    def problem(self) -> Problem:
        """What the tree is for."""
        return self.tree.problem

    @property
    def ending(self) -> Ending:
        """Done when the tree executes, has no unit but those of the network, and breaks no rule."""
        sound = self.executes and not self.foreign and not self.breaks
        return Ending.DONE if sound else Ending.NEGATIVE

    @property
    def foreign(self) -> tuple[int, ...]:
        """The positions, from 0, of units that are not in the network."""
        return tuple(position for position, unit in enumerate(self._ids()) if unit is None)

    def text(self) -> str:
        """Say whether the tree executes, in which order, what stops it, and which rules it breaks."""
        if self.replay is not None:
            found = replay_text(self.problem, self._listed(), self.replay)
        else:
            found = verdict_text(self.problem, self._listed(), self.simulation)
        return found + "".join(f"{line}\n" for line in self._about_rules())

    def _about_rules(self) -> Iterator[str]:
        if not self.ruled:
            return
        if self.breaks is None:
            why = "has units that are not in the network" if self.executes else "does not execute"
            yield f"whether it keeps to the rules is not looked at, since it {why}"
        elif not self.breaks:
            yield "it keeps to the rules"
        else:
            from foon_asp.report.integrity_constraint import constraint_lines  # noqa: PLC0415

            yield f"it breaks {counted(len(self.breaks), 'rule')}:"
            for rule in self.breaks:
                yield from constraint_lines(rule)

    def json_dict(self) -> Json:
        """Give the same; positions count from 1."""
        problem, foreign, replay = self.problem, self.foreign, self.replay
        known = [unit for unit in self._ids() if unit is not None]
        return document(
            "check",
            problem,
            **verdict_json(problem, self._listed(), None if replay else self.simulation),
            **({} if replay is None else {"replay": replay_json(problem, self._listed(), replay)}),
            not_in_network=[position + 1 for position in foreign],
            costs=None if foreign else costs_json(problem.costs(known)),
            **({"breaks": self._breaks_json()} if self.ruled else {}),
        )

    def _breaks_json(self) -> list[Json] | None:
        from foon_asp.report.integrity_constraint import constraint_json  # noqa: PLC0415

        return None if self.breaks is None else list(map(constraint_json, self.breaks))

    def drawing(self) -> Drawing | None:
        """Give what the picture shows."""
        return self.tree.drawing()

    def _ids(self) -> list[int | None]:
        return [self.problem.network.unit_id(unit) for unit in self.tree.units]

    def __repr__(self) -> str:
        said = super().__repr__()
        return f"{said[:-1]}, but breaks {counted(len(self.breaks), 'rule')}>" if self.breaks else said

    def _listed(self) -> Listed:
        return list(zip(self.tree.units, self.tree.places, strict=True))


@question(
    Option(
        "tree",
        "The task tree: FOON text, or an answer in JSON.",
        Kind.FILE,
        metavar="TREE.txt",
        positional=True,
    ),
    GOALS,
    CONTAINERS,
    *ITEMS,
    *RULES,
    help_="""
    \b
    foon-asp check tree.txt --goal macaroni
    foon-asp check tree.txt --goal macaroni --rule ':- use(U), motion(U,"fry").'

    The tree is FOON text, units in the order of execution, or an answer in JSON.

    With --items used-up, order and repeats count: the plan is replayed copy by copy.

    Under rules, it says of a tree that executes which of them it breaks.

    Exits with 0 when the tree executes, as listed or in the order that is then given; with 1 when no
    order executes, a unit is not in the network, or a rule is broken.
    """,
)
def check(
    problem: Problem,
    tree: str | PathLike[str] | Iterable[FunctionalUnit],
    *,
    constraints: Files = (),
    constants: Constants | None = None,
    encodings: File | None = None,
    time_limit: float | None = None,
    on_progress: OnProgress | None = None,
    cancel: Cancel | None = None,
) -> Checked:
    """Simulate a task tree for the goals of a problem: does it execute, and in which order?

    Parameters:
        tree: The path of a file (FOON text, or an answer in JSON), or functional units in the order listed,
            such as a :class:`TaskTree`. Where items are used up, it is a plan, in which a unit may be listed
            several times.

    Returns:
        Whether the tree ``executes``, the tree ``in_order``, the ``simulation`` with what stops it, and the
        rules that it ``breaks``.

    Raises:
        UserError: if the file cannot be read or contains no tree, or for a wrong rule.

    Example:
        >>> problem = foon_asp.load().problem("macaroni")
        >>> checked = foon_asp.check(problem, foon_asp.retrieve(problem, "bfs").tree)
        >>> checked.simulation.verdict
        <Verdict.REORDERED: 'executes in another order'>
        >>> checked.simulation.as_listed.missing.label
        'stove'
        >>> rule = ':- use(U), motion(U,"turn on").'
        >>> checked = foon_asp.check(problem, foon_asp.solve(problem).tree, constraints=rule)
        >>> [broken.text for broken in checked.breaks] == [rule]
        True
    """
    rules = settings(constraints, constants, encodings)._replace(session=None)
    if rules.replaced is not None:
        raise UserError(f"{rules.replaced}: a tree is checked without encodings: leave them out")
    used_up = problem.items is not None
    breaking = _breaking(rules, used_up) if rules.constraints or rules.constants else None
    if breaking is not None and not breaking.local:
        problem = whole(problem)
    given = Tree.read(problem, tree) if isinstance(tree, str | PathLike) else Tree.given(problem, tree)
    replay = None if given.problem.items is None else replay_for(given.problem, given)
    found = Checked(given, simulate_for(given.problem, given), replay, breaking is not None)
    if breaking is None or not found.executes or found.foreign:
        return found
    ids = map(given.problem.network.unit_id, given.units)
    units = [unit for unit in ids if unit is not None]
    return replace(found, breaks=breaking.broken(given.problem, units))


def _breaking(rules: "Settings", used_up: bool) -> "Breaking":
    from foon_asp.asp.breaking import Breaking  # noqa: PLC0415 (takes clingo along)

    return Breaking(rules, used_up)
