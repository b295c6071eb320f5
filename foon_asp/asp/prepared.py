"""Preparation of a question: the units that can matter, the scales of their costs, and the program."""

from collections.abc import Collection, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, replace
from functools import cached_property, partial
from pathlib import Path
from typing import TYPE_CHECKING

from foon_asp.asp.postconditions import Postconditions
from foon_asp.asp.program import Program
from foon_asp.asp.settings import Settings
from foon_asp.deadline import Deadline
from foon_asp.encoding.own_encodings import question_encoding
from foon_asp.errors import UserError
from foon_asp.hypergraph import (
    BOUND,
    NONE,
    Bounds,
    Listener,
    Reduced,
    Reduction,
    SolvedGoals,
    reduce,
    reduce_under_rules,
)
from foon_asp.problem import Contradiction, Objective, Problem, first_tree, levels, reach, relevant_units

if TYPE_CHECKING:  # often clingo need not run
    from foon_asp.encoding.cost_scales import Scales
    from foon_asp.encoding.run import Run
    from foon_asp.rules.ready_made import ReadyMade
    from foon_asp.rules.rules import Rules


@dataclass(frozen=True, eq=False, repr=False)
class Prepared:
    """A question, prepared for the search.

    ``levels``: the objectives as optimized.
    ``units``: the units of the network that remain after the reductions, by id.
    ``tree``: a tree of ``units``; ``None`` if they do not make the goals.
    ``reduced``: the result of the reductions; ``None`` if none ran.
    ``stopped``: whether a limit or ctrl-C interrupted the preparation, so that nothing is known.
    ``restricted_problem``: the problem restricted by user rules, if rules were applied before the search.
    ``contradicted``: whether user rules allow no tree. If so, there are no units.
    ``full_program``: the program with all user rules, if rules were applied before the search.
    ``unsettled``: whether clingo has to enforce some rules. ``tree`` and ``reduced`` ignore these rules.
    ``redundant``: whether trees under the rules may need units that lead to no goal.
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
    restricted_problem: Problem | None = None
    contradicted: bool = False
    unsettled: bool = False
    redundant: bool = False
    full_program: Program | None = None

    @cached_property
    def holds(self) -> Postconditions:
        """The postconditions that answers to this question have to satisfy."""
        return Postconditions(
            self.restricted_problem or self.problem, self.levels, self.settings, self.program.is_built_in
        )

    @cached_property
    def scales(self) -> "Scales":
        """The scales by which costs of the units become integers of clingo; raises like :class:`Scales`."""
        from foon_asp.encoding.cost_scales import Scales  # noqa: PLC0415

        return Scales(self.problem, self.units, self.levels)

    @cached_property
    def facts(self) -> str:
        """The facts of the problem, as text, without the facts about objectives.

        If user rules were applied before the search, only facts that some rule reads are written. Bounds on
        costs are included. If clingo does not get the user rules, the sets of units that they require are
        included. Raises ``KeyboardInterrupt`` at a limit.
        """
        from foon_asp.encoding import fact_writer as writing  # noqa: PLC0415

        with self.deadline.watched("writing facts"):
            if self.full_program is not None:  # the predicates that rules read are known
                predicates_read = writing.READ_BY_OURS | self.program.looked_at
                facts = writing.write_facts_read(self.problem, self.units, predicates_read, self.scales)
            else:
                looked_at = None if self.program.is_built_in else self.program.looked_at
                facts = writing.write_facts(self.problem, self.units, self.scales, looked_at)
            bounded = self.settings.bounded
            facts += writing.write_below(bounded.below, self.scales) if bounded else ""
            if (
                self.restricted_problem is None
                or self.restricted_problem.restriction is None
                or self.unsettled
            ):
                return facts
            number, remaining = self.problem.network.unit_number, frozenset(self.units)
            sets = self.restricted_problem.restriction.required
            return facts + writing.write_required([map(number, sorted(remaining & units)) for units in sets])

    def keeps(self, units: Collection[int]) -> bool | None:
        """Whether a tree, given by unit ids, keeps to all user rules; ``None`` if a limit stops the check.

        The rules have to be local: units outside the tree must not matter for them. clingo decides, unless
        all rules are ready-made. At a limit or ctrl-C, nothing is raised. Raises :class:`UserError` for a
        fault in a rule.
        """
        program = self.full_program or self.program
        if program.ready_made is not None:
            return program.ready_made.keeps(self.problem, units)
        from foon_asp.encoding.fact_writer import write_given  # noqa: PLC0415

        question = replace(self, units=tuple(sorted(units)), program=program)
        numbers = list(map(self.problem.network.unit_number, question.units))
        run = question.run(write_given(numbers), "ignore", (question_encoding("second_opinion.lp"),))
        return True if run.units is not None else (False if run.exhausted else None)

    def require_kept(self, units: Collection[int]) -> None:
        """Require that a tree keeps to the user rules that were applied before the search.

        Nothing is checked if the user rules are not local, or if clingo enforced some of them.
        """
        rules = self.full_program.added if self.full_program else None
        if rules is not None and rules.local and not self.unsettled:
            kept = self.keeps(units)
            self.holds.require(
                kept is not False,
                lambda: f"the tree {sorted(units)} does not keep to the rules that were added",
            )

    def run(
        self,
        question_facts: str,
        opt_mode: str = "opt",
        encodings: Sequence[Path] = (),
        predicates: Sequence[tuple[str, int]] = (),
    ) -> "Run":
        """Run clingo with additional facts and encodings; see :func:`foon_asp.encoding.clingo_run.run`.

        The run has the atoms of ``predicates`` in addition to the units. Returns an empty run if a limit is
        reached while the facts are written. Errors in rewritten constraints have their places in the files.
        """
        from foon_asp.encoding.clingo_run import run  # noqa: PLC0415 (both take clingo along)
        from foon_asp.encoding.run import Run  # noqa: PLC0415

        program, relaxed = self.program, self.settings.relaxed
        try:
            text = self.facts + program.rules + question_facts
        except KeyboardInterrupt:
            self.deadline.interrupt()
            return Run()
        with ExitStack() as stack:
            if relaxed is not None:
                from foon_asp.asp.integrity import errors_at_sources  # noqa: PLC0415 (which parses)

                stack.enter_context(errors_at_sources(relaxed, text))
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
    solved: SolvedGoals | None = None,
) -> Prepared:
    """Prepare a question: find the units that can matter, and where possible a tree and reductions.

    Without user rules, the units that can matter are those that the goals can need. With user rules, they are
    all units that can be executed, since a constraint may require units that no goal needs. User rules that
    only remove or require units are applied first, unless ``settings`` are without reductions. The costs by
    user measures are computed before that, and kept in ``problem``.

    ``listener``: receives trees and bounds. Without a listener, no reductions by costs are made, so that all
    trees remain. With a listener, they may exclude every tree except one of the best. If ``program`` has
    bounds on trees, no reductions by costs are made, since the remaining trees might not meet the bounds.
    ``for_sale``: ids of object nodes that may be added to the kitchen. With them, no rules are applied first.
    ``brief``: whether to skip the search for the best tree without the rules that clingo has to enforce.
    ``solved``: the solved goals of questions that differ only in their goals, by which reductions save work.

    At a limit or ctrl-C, a question with ``stopped`` is returned. Raises :class:`UserError` if an objective
    needs data that are missing, if a constant has the name of an objective, and for items that are used up.
    """
    if problem.items is not None:
        raise UserError("this question is not built for items that are used up")
    objective_levels = levels(tuple(objectives))
    problem.require_known_for(objective_levels)
    program.require_facts(problem, objective_levels)
    for objective in program.named.intersection(objective_levels):
        raise UserError(
            f"found #const {objective} in a constraint or an encoding, but that is the name of a measure: "
            "give one of them another name"
        )
    if sum(not objective.row.whole for objective in objective_levels) > 1:
        from foon_asp.encoding.cost_scales import require_one_rounded  # noqa: PLC0415 (few questions have two)

        require_one_rounded(problem, objective_levels)
    deadline = settings.effective_deadline
    prepared = Prepared(problem, objective_levels, settings, deadline, program)
    try:
        if problem.measures:
            with deadline.watched("measuring units"):
                problem.apply_measures(deadline)
        if program.added and settings.reductions and not for_sale:
            with deadline.watched("cutting the network"):
                prepared = _apply_rules(prepared, program.added)
        if prepared.contradicted:
            return prepared
        program, ruled_problem = prepared.program, prepared.restricted_problem or problem
        if listener is not None and (program.is_built_in or _can_reduce_unsettled(prepared)):
            presolve = partial(reduce, solved=None if prepared.restricted_problem else solved)
            if prepared.unsettled:
                course = BOUND if brief else None
                presolve = partial(reduce_under_rules, redundant=prepared.redundant, course=course)
            reduced = presolve(
                ruled_problem,
                objective_levels,
                NONE if program.bounded else settings.reductions,
                lambda: deadline.passed,
                Bounds(listener) if prepared.unsettled else listener,
                lambda: deadline.watched("cutting the network", late=True),
            )
            if reduced.interrupted:
                deadline.interrupt()
            if not prepared.unsettled or reduced.subproblem is not None or reduced.tree is None:
                return replace(prepared, units=reduced.units, tree=reduced.tree, reduced=reduced)
        with deadline.watched("cutting the network"):
            stocked_problem = ruled_problem
            if for_sale:
                stocked_problem = replace(ruled_problem, kitchen=problem.kitchen.union(for_sale))
            reached = reach(stocked_problem)
            tree = first_tree(stocked_problem, reached)
            # backwards with the kitchen as it is: items for sale may also be made
            only_relevant = program.is_built_in or (prepared.unsettled and not prepared.redundant)
            units = relevant_units(ruled_problem, reached) if only_relevant else tuple(sorted(reached.units))
        return replace(prepared, units=units, tree=None if tree is None else frozenset(tree))
    except KeyboardInterrupt:
        deadline.interrupt()
        return replace(prepared, stopped=True)


def _apply_rules(prepared: Prepared, rules: "Rules | ReadyMade") -> Prepared:
    """Apply the user rules that remove units or require sets of units, and return the question.

    If clingo has to enforce other rules, the question is ``unsettled``. If no tree can satisfy the rules, the
    question is ``contradicted``. The question is returned unchanged if clingo refuses a rule, or if rules
    that clingo has to enforce are not local. In a large network, all rules may be left to the search.
    """
    if rules.unsettled and not rules.local:
        return prepared
    problem = prepared.problem
    with_full_program = replace(prepared, full_program=prepared.program)
    if rules.leave_to_search(problem):
        return replace(
            with_full_program, restricted_problem=problem, unsettled=True, redundant=rules.redundant
        )
    restriction = rules.restriction_of(problem, prepared.deadline)
    if restriction is None:
        return prepared
    if isinstance(restriction, Contradiction):
        return replace(with_full_program, contradicted=True)
    restricted_problem = replace(problem, restriction=restriction)
    restricted = replace(with_full_program, restricted_problem=restricted_problem)
    if not rules.unsettled:
        return replace(restricted, program=prepared.program.settled)
    return replace(restricted, unsettled=True, redundant=rules.redundant)


def _can_reduce_unsettled(prepared: Prepared) -> bool:
    """Whether reductions by costs are possible although clingo has to enforce some rules."""
    return (
        prepared.unsettled and not prepared.program.bounded and Reduction.DEAR in prepared.settings.reductions
    )
