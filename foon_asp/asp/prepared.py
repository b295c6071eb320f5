"""The first half of every question: the network left after the cut, its measures, and its program."""

from collections.abc import Collection, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

from foon_asp.asp.postconditions import Postconditions
from foon_asp.asp.program import Program
from foon_asp.asp.settings import Settings
from foon_asp.deadline import Deadline
from foon_asp.encoding.own_encodings import question_encoding
from foon_asp.errors import UserError
from foon_asp.problem import Objective, Problem, Restriction, first_tree, levels, reach, relevant
from foon_asp.reduce import NONE, Bounds, Listener, Reduced, Reduction, reduce

if TYPE_CHECKING:  # often there is nothing left to ask clingo
    from foon_asp.encoding.scales import Scales
    from foon_asp.grounding.run import Run
    from foon_asp.rules.ready_made import ReadyMade
    from foon_asp.rules.rules import Rules


@dataclass(frozen=True, eq=False, repr=False)
class Prepared:
    """A question, prepared for the search.

    ``levels`` are the objectives as optimized and ``units`` what is left of the network after the cut, where
    ``tree`` is some tree: ``None`` where nothing makes the goals. ``reduced`` is what the reductions made of
    the question, where they were asked. ``stopped`` says that a limit or ctrl-C came in the middle of the
    cut, and that nothing is known. ``kept`` is the problem as rules of the user leave it, where these are
    applied before the search, ``contradicted`` says that they leave nothing at all, and ``asked`` is the
    program with all of them. ``rest`` says that some of them are still to be kept to: ``tree`` and
    ``reduced`` do not know of these. ``spare`` says that trees that keep to these may need units that lead to
    no goal.
    """

    problem: Problem
    levels: tuple[Objective, ...]
    settings: Settings
    deadline: Deadline
    program: Program
    units: tuple[int, ...] = ()
    tree: frozenset[int] | None = None
    reduced: Reduced | None = None
    stopped: bool = False
    kept: Problem | None = None
    contradicted: bool = False
    rest: bool = False
    spare: bool = False
    asked: Program | None = None

    @cached_property
    def holds(self) -> Postconditions:
        """What the answers are checked with."""
        return Postconditions(self.kept or self.problem, self.levels, self.settings, self.program.own)

    @cached_property
    def scales(self) -> "Scales":
        """How the units that are left are measured in clingo; raises like :class:`Scales`."""
        from foon_asp.encoding.scales import Scales  # noqa: PLC0415

        return Scales(self.problem, self.units, self.levels)

    @cached_property
    def facts(self) -> str:
        """The facts of the problem, as text, without those of the question.

        Raises ``KeyboardInterrupt`` at a limit.
        """
        from foon_asp.encoding import facts as writing  # noqa: PLC0415

        with self.deadline.watched("writing facts"):
            if self.asked is not None:  # it is known what the rules look at, and nobody sees these facts
                read = writing.READ_BY_OURS | self.program.looked_at
                facts = writing.write_facts_read(self.problem, self.units, read, self.scales)
            else:
                looked_at = None if self.program.own else self.program.looked_at
                facts = writing.write_facts(self.problem, self.units, self.scales, looked_at)
            bounded = self.settings.bounded
            facts += writing.write_below(bounded.below, self.scales) if bounded else ""
            if self.kept is None or self.kept.restriction is None or self.rest:
                return facts
            number, left = self.problem.network.unit_number, frozenset(self.units)
            sets = self.kept.restriction.required
            return facts + writing.write_required([map(number, sorted(left & units)) for units in sets])

    def keeps(self, units: Collection[int]) -> bool | None:
        """Whether a tree keeps to all rules of the user's, which see no further than the tree.

        ``None`` where that is not known at a limit. Raises :class:`UserError` for what is wrong with a rule.
        """
        program = self.asked or self.program
        if program.ready_made is not None:
            return program.ready_made.keeps(self.problem, units)
        from foon_asp.encoding.facts import write_given  # noqa: PLC0415

        tree = replace(self, units=tuple(sorted(units)), program=program)
        numbers = list(map(self.problem.network.unit_number, tree.units))
        ended = tree.run(write_given(numbers), "ignore", (question_encoding("second_opinion.lp"),))
        return True if ended.units is not None else (False if ended.exhausted else None)

    def require_kept(self, units: Collection[int]) -> None:
        """Require that a tree keeps to rules that were applied beforehand, as far as they can be asked."""
        rules = self.asked.added if self.asked else None
        if rules is not None and rules.local and not self.rest:
            kept = self.keeps(units)
            self.holds.require(
                kept is not False,
                lambda: f"the tree {sorted(units)} does not keep to the rules that were added",
            )

    def run(
        self,
        more: str,
        opt_mode: str = "opt",
        encodings: Sequence[Path] = (),
        predicates: Sequence[tuple[str, int]] = (),
    ) -> "Run":
        """Ask clingo with additional facts and encodings.

        As :func:`foon_asp.encoding.search.run` does; nothing is known where a limit comes before.
        """
        from foon_asp.encoding.search import run  # noqa: PLC0415 (both take clingo along)
        from foon_asp.grounding.run import Run  # noqa: PLC0415

        program, relaxed = self.program, self.settings.relaxed
        try:
            text = self.facts + program.rules + more
        except KeyboardInterrupt:
            self.deadline.interrupt()
            return Run()
        with ExitStack() as stack:
            if relaxed is not None:
                from foon_asp.asp.integrity import placed  # noqa: PLC0415 (which parses)

                stack.enter_context(placed(relaxed, text))
            return run(
                (*program.files, *encodings),
                text,
                program.arguments,
                self.deadline,
                opt_mode,
                predicates=predicates,
                endless=program.endless,
            )


def prepare(
    problem: Problem,
    objectives: Sequence[Objective],
    settings: Settings,
    program: Program,
    listener: Listener | None = None,
    for_sale: Collection[int] = (),
    brief: bool = False,
) -> Prepared:
    """Cut a network down to what can matter.

    Where all rules are ours, that is what the goals can need; with others it is all that can be made, since a
    constraint may ask for units that no goal does. Rules that are understood are applied first, unless no
    reductions are asked for; those that are settled so need not be asked again. With a ``listener``, who
    hears of trees and bounds, it is less what the reductions leave out: what only trees have that are no
    better than another, which may be the only one within bounds, so then they leave out nothing.
    ``for_sale`` are object nodes that may come to those in the kitchen. ``brief`` says that the
    best tree without the rest of the rules is not asked for. Raises :class:`UserError` where an objective
    needs rates that are not known.
    """
    if problem.items is not None:
        raise UserError("this question is not built for items that are used up")
    asked = levels(tuple(objectives))
    problem.require_known_for(asked)
    program.require_facts(problem, asked)
    for objective in program.named.intersection(asked):
        raise UserError(
            f"found #const {objective} in a constraint or an encoding, but that is the name of a measure: "
            "give one of them another name"
        )
    if sum(not each.row.whole for each in asked) > 1:
        from foon_asp.encoding.scales import require_one_rounded  # noqa: PLC0415 (few questions have two)

        require_one_rounded(problem, asked)
    deadline = settings.begun
    first = Prepared(problem, asked, settings, deadline, program)
    try:
        if problem.measures:
            with deadline.watched("measuring units"):
                problem.apply_measures(deadline)
        if program.added and settings.reductions and not for_sale:
            with deadline.watched("cutting the network"):
                first = _applied(first, program.added)
        if first.contradicted:
            return first
        program, kept = first.program, first.kept or problem
        if listener is not None and (program.own or _limits_rest(first)):
            reduced = reduce(
                kept,
                asked,
                NONE if program.bounded else settings.reductions,
                lambda: deadline.passed,
                Bounds(listener) if first.rest else listener,
                lambda: deadline.watched("cutting the network", late=True),
                first.spare,
                first.rest,
                brief and first.rest,
            )
            if reduced.interrupted:
                deadline.interrupt()
            if not first.rest or reduced.wide is not None or reduced.tree is None:
                return replace(first, units=reduced.units, tree=reduced.tree, reduced=reduced)
        with deadline.watched("cutting the network"):
            stocked = replace(kept, kitchen=problem.kitchen.union(for_sale)) if for_sale else kept
            reached = reach(stocked)
            tree = first_tree(stocked, reached)
            # backwards with the kitchen as it is: what is for sale may also be made
            cut = program.own or (first.rest and not first.spare)
            units = relevant(kept, reached) if cut else tuple(sorted(reached.units))
        return replace(first, units=units, tree=None if tree is None else frozenset(tree))
    except KeyboardInterrupt:
        deadline.interrupt()
        return replace(first, stopped=True)


def _applied(first: Prepared, rules: "Rules | ReadyMade") -> Prepared:
    """Apply the user's rules as far as they say which units there are, or which sets are needed."""
    if rules.rest and not rules.local:
        return first
    found = rules.applied(first.problem)
    first = replace(first, asked=first.program)
    if not isinstance(found, Restriction):
        return replace(first, contradicted=True)
    kept = replace(first.problem, restriction=found)
    if not rules.rest:
        return replace(first, kept=kept, program=first.program.settled)
    return replace(first, kept=kept, rest=True, spare=rules.spare)


def _limits_rest(first: Prepared) -> bool:
    """Whether the rest of the user's rules is kept to by limits on costs."""
    return first.rest and not first.program.bounded and Reduction.DEAR in first.settings.reductions
