"""Optimal task trees: reductions, runs of clingo, and the resulting outcome."""

import itertools
import time
from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import TYPE_CHECKING

from foon_asp.asp.assembly import CLINGO_OPTIONS, SHRINKING, program_of
from foon_asp.asp.outcome import Outcome, Proof, Status
from foon_asp.asp.prepared import Prepared, prepare
from foon_asp.asp.program import Program
from foon_asp.asp.reporter import Reporter
from foon_asp.asp.search_tuning import SEARCH
from foon_asp.asp.settings import Settings
from foon_asp.encoding.own_encodings import question_encoding
from foon_asp.errors import BugError, UserError
from foon_asp.hypergraph import ExactCosts, Listener, Reduced, Reduction, SolvedGoals, Subproblem
from foon_asp.hypergraph.landmark_cuts import Cuts
from foon_asp.problem import Costs, Objective, Problem, levels, multiplies

if TYPE_CHECKING:  # clingo and what it is given, which often is not needed
    from foon_asp.encoding.cost_scales import Scales
    from foon_asp.encoding.grounded import Grounded
    from foon_asp.encoding.run import Run

_NOT_ASKED = (
    "clingo has no statistics: the question was settled without its search; --reduce none leaves it to clingo"
)
_UNITS_ONLY: tuple[Objective, ...] = (Objective.UNITS,)
_QUICK_OPTIONS = (
    "--configuration=frumpy",
    "--opt-strategy=usc,pmres,4",
)  # faster here than the defaults of clingo

Units = frozenset[int]


def solve(
    problem: Problem,
    objectives: Sequence[Objective] = (Objective.UNITS,),
    settings: Settings | None = None,
    reporter: Reporter | None = None,
    mattered: set[int] | None = None,
    solved: SolvedGoals | None = None,
) -> Outcome:
    """Return the best task tree under lexicographic objectives, with what is proved about it.

    ``units`` decides last, so that the tree is irredundant. At a limit or ctrl-C, the outcome has the
    incumbent. If clingo's statistics are requested, but clingo does not run, the reporter is told so.

    ``mattered``: units, by id in the whole network, that the search for a similar question explored. They are
    explored first, and the units that this search explores are added.
    ``solved``: the solved goals of questions that differ only in their goals, by which reductions save work.
    The goal of this question is added.

    Raises :class:`UserError` for faults in constraints, encodings and options, and for ``success`` without
    known rates. Raises :class:`BugError` if stand-ins that the best tree may need are not in the network.
    """
    settings, reporter = settings or Settings(), reporter or Reporter()
    if not problem.has_stand_ins_for(objectives):
        raise BugError("only the nearest stand-ins are there, of which another tree may be the best")
    program = program_of(problem, settings, reporter.warning)
    began = time.perf_counter()
    listener = _IncumbentListener(problem, objectives, reporter)
    prepared = prepare(problem, objectives, settings, program, listener, (), bool(mattered), solved)
    seconds = {"cut": time.perf_counter() - began}
    outcome = _Solver(prepared, objectives, listener, seconds, mattered=mattered).solve()
    if settings.asks_for_statistics and not listener.clingo_ran:
        reporter.statistics(_NOT_ASKED)
    return outcome


def solve_prepared(prepared: Prepared, objectives: Sequence[Objective], rules: str = "") -> Outcome:
    """Return the best task tree of a prepared question under additional rules, with what is proved.

    ``rules`` are the additional rules, as text. Nothing is reported.
    """
    return _Solver(
        prepared, objectives, _IncumbentListener(prepared.problem, objectives, Reporter()), {}, rules
    ).solve()


class _IncumbentListener(Listener):
    """Listener that keeps the incumbent, and reports better trees, bounds and statistics."""

    def __init__(self, problem: Problem, objectives: Sequence[Objective], reporter: Reporter) -> None:
        self.problem, self.levels, self.reporter = problem, levels(tuple(objectives)), reporter
        self.incumbent: tuple[Units, Costs] | None = None
        self.clingo_ran = False  # whether clingo ran, so that there are statistics
        self._last_costed: tuple[Units, Costs] | None = None  # cache of one tree

    def tree(self, units: Units) -> None:
        """Receive a tree; if it is better than the incumbent, keep and report it."""
        costs = self.costs(units)
        if self.incumbent is None or costs.key(self.levels) < self.incumbent[1].key(self.levels):
            self.incumbent = units, costs
            self.reporter.tree(costs)

    def bound(self, costs: ExactCosts, bound: int) -> None:
        """Receive a proved lower bound, and report it as a bound on the first objective.

        ``bound`` is in the scaled integers of ``costs``.
        """
        self.reporter.bound(self.levels[0], costs.first_objective_bound(bound))

    def run_ended(self, run: "Run") -> None:
        """Receive a finished run of clingo; if it has statistics, report them and note that clingo ran."""
        if run.statistics:
            self.clingo_ran = True
            self.reporter.statistics(run.statistics)

    def costs(self, units: Units) -> Costs:
        """Return the costs of a tree; those of the last tree are cached."""
        if self._last_costed is None or self._last_costed[0] != units:
            self._last_costed = units, self.problem.costs(units)
        return self._last_costed[1]


class _Solver:
    """The search for the best tree of one prepared question, with clingo where reductions do not suffice."""

    def __init__(
        self,
        prepared: Prepared,
        objectives: Sequence[Objective],
        listener: _IncumbentListener,
        seconds: dict[str, float],
        rules: str = "",
        mattered: set[int] | None = None,
    ) -> None:
        """Take a prepared question.

        ``listener`` has the incumbent of the reductions, and receives better trees. ``seconds`` has the time
        of each phase; the times of this search are added. ``rules`` are additional rules as text.
        ``mattered`` are units to explore first, by id in the whole network; the units that are explored are
        added.
        """
        self.prepared, self.objectives, self.listener, self.seconds = (
            prepared,
            tuple(objectives),
            listener,
            seconds,
        )
        self.rules = prepared.program.rules + rules
        self.problem, self.levels, self.deadline = prepared.problem, prepared.levels, prepared.deadline
        self.program, self.holds = prepared.program, prepared.holds
        self._scales: Scales | None = None  # None before the first run of clingo
        self._ground: tuple[object, Grounded] | None = None  # the last question grounded, and its program
        self._open_preconditions = False  # whether trees found may have open preconditions
        # units to explore first, by id in the whole network
        self._mattered = set() if mattered is None else mattered

    def solve(self) -> Outcome:
        """Return the outcome of the search; at a limit or ctrl-C, the outcome with the incumbent.

        If there is no incumbent at a limit, the outcome has the tree of the prepared question, unless rules
        or bounds may exclude this tree. The ground program is closed at the end.
        """
        deadline = self.deadline
        try:
            with deadline.watched(deadline.doing, late=True, grace=True):
                return self._solve()
        except KeyboardInterrupt:
            deadline.interrupt()
            if self.listener.incumbent is None and self._initial_incumbent is not None:
                self.listener.tree(self._initial_incumbent)
            best = self.listener.incumbent
            return (
                self._outcome(Status.UNKNOWN, None, {})
                if best is None
                else self._outcome_at_limit(best[0], ())
            )
        finally:
            if self._ground:
                self._ground[1].close()

    @property
    def _initial_incumbent(self) -> Units | None:
        """The tree of the prepared question; ``None`` if user rules or bounds may exclude it."""
        decided = self.program.is_built_in and not self.program.bounded
        return self.prepared.tree if decided else None

    def _solve(self) -> Outcome:
        """Return the outcome of the reductions or, if they leave the question open, of a search with clingo.

        If the preparation was stopped, the outcome is unknown. If there is no tree, user rules are still
        checked for errors, which are raised. A limit during a run of clingo leads to an outcome without a
        proof. Any other limit raises ``KeyboardInterrupt``.
        """
        prepared = self.prepared
        if prepared.stopped:
            return self._outcome(Status.UNKNOWN, None, {})
        if prepared.tree is None:
            if prepared.full_program is not None:
                prepared.keeps(Units())  # to say what is wrong with a rule, though no tree depends on it
            if not prepared.contradicted:
                self.holds.require_no_tree()
            return self._outcome(Status.INFEASIBLE, None, {})
        if prepared.unsettled and prepared.reduced and prepared.reduced.subproblem:
            return self._solve_unsettled(prepared.reduced, prepared.reduced.subproblem, prepared.tree)
        incumbent = self._initial_incumbent
        if incumbent is None:  # user rules or bounds may exclude the tree of the cut
            run = self._run(self.levels, opt_mode="ignore")
            if run.units is None:
                return self._outcome(Status.INFEASIBLE if run.exhausted else Status.UNKNOWN, None, {})
            incumbent = run.units
        self.listener.tree(incumbent)
        if prepared.reduced and prepared.reduced.settled:
            return self._optimal_outcome(incumbent)
        # at a limit, not even what clingo would be given is written
        return self._outcome_at_limit(incumbent, ()) if self.deadline.passed else self._search(incumbent)

    def _solve_unsettled(
        self, reduced: Reduced, subproblem: Subproblem, tree_without_rules: Units
    ) -> Outcome:
        """Find the best tree under rules that the reductions ignored.

        ``tree_without_rules`` is the best tree that was found without these rules. If it keeps to the rules,
        and ``reduced`` proves it best without them, it is optimal. If a similar question explored units, the
        tree is not checked, but taken to break the rules.
        """
        if self._mattered:  # the tree breaks rules, as in the similar question
            return self._solve_violated(subproblem, tree_without_rules)
        keeps = self.prepared.keeps(tree_without_rules)
        if keeps:
            self.listener.tree(tree_without_rules)
            if reduced.settled:
                return self._optimal_outcome(tree_without_rules)
        self.prepared = replace(self.prepared, reduced=reduced._replace(settled=False))
        if keeps:
            return self._search_gap_bounded(subproblem, tree_without_rules, None)
        return self._solve_violated(subproblem, tree_without_rules)

    def _solve_violated(self, subproblem: Subproblem, tree_without_rules: Units) -> Outcome:
        """Find the best tree under the rules if the best tree without them breaks some of them.

        ``tree_without_rules`` is the best tree without rules. These searches are made in turn, until one
        finds the best tree under the rules or proves that no tree keeps them:

        - by a price on a limited sum, unless a similar question explored units;
        - for trees with open preconditions;
        - in ever larger neighbourhoods of the goals. If one has a tree, the gap-bounded subproblem is
          searched for the best tree.

        If trees may need redundant units, only the last search is made.
        """
        if (
            not subproblem.redundant
            and not self._mattered
            and (outcome := self._solve_by_priced_limit(subproblem, tree_without_rules)) is not None
        ):
            return outcome
        run = (
            None
            if subproblem.redundant
            else self._search_with_open_preconditions(subproblem, tree_without_rules)
        )
        is_best = run is not None
        if run is None:
            run = self._search_near_goals(subproblem, tree_without_rules)
        if run.units is None:
            return self._outcome(Status.INFEASIBLE if run.exhausted else Status.UNKNOWN, None, {})
        self.listener.tree(run.units)
        if is_best:
            return self._optimal_outcome(self._best_reported(run.units))
        if not run.exhausted:
            return self._outcome_at_limit(run.units, ())
        return self._search_gap_bounded(subproblem, self._best_reported(run.units), run)

    def _solve_by_priced_limit(self, subproblem: Subproblem, tree_without_rules: Units) -> Outcome | None:
        """Find the best tree under a limit on a sum by putting a Lagrangian price on the sum.

        Some rules limit a sum. Each sum whose limit ``tree_without_rules`` exceeds is tried in turn. Returns
        an outcome without a tree if no tree is within a limit, or if the time is up. Returns ``None`` if no
        price yields a tree that keeps to all rules.
        """
        from foon_asp.hypergraph.priced_limit import search_within_limit  # noqa: PLC0415 (of use with few rules)

        program = self.prepared.full_program
        assert program is not None
        assert program.added is not None
        for row in program.added.upper_limits(self.problem, self.deadline):
            if row.total(tree_without_rules) <= row.bound:
                continue
            try:
                with self.deadline.watched("cutting the network", late=True):
                    result = search_within_limit(
                        subproblem, self.levels, tree_without_rules, row, lambda: self.deadline.passed
                    )
            except KeyboardInterrupt:
                self.deadline.interrupt()
                return self._outcome(Status.UNKNOWN, None, {})
            if result is None:
                continue
            if result.tree is None:
                return self._outcome(Status.INFEASIBLE, None, {})
            if self.prepared.keeps(result.tree):
                self.listener.tree(result.tree)
                if result.units is not None:
                    self._restrict_to(result.units | result.tree)
                    return self._search(result.tree)
                return self._search_gap_bounded(subproblem, result.tree, None)
        return None

    def _search_near_goals(self, subproblem: Subproblem, tree_without_rules: Units) -> "Run":
        """Search ever larger neighbourhoods of the goals until one has a tree; return the last run.

        Each neighbourhood includes ``tree_without_rules``. The last one is the whole subproblem. If a limit
        is reached, the run is not exhausted.
        """
        all_units, size = subproblem.all_units(), SEARCH.nearest_units
        while True:
            neighbourhood = (
                all_units if size >= len(all_units) else subproblem.nearest_units(size) | tree_without_rules
            )
            size *= SEARCH.nearest_growth
            self._restrict_to(neighbourhood)
            run = self._run(self.levels)
            if run.units is not None or not run.exhausted or neighbourhood >= all_units:
                return run

    def _search_gap_bounded(self, subproblem: Subproblem, tree: Units, run: "Run | None") -> Outcome:
        """Search the gap-bounded subproblem: all units that trees up to the cost of ``tree`` can have.

        ``run`` is the search that found the tree; ``None`` if the tree was found without clingo. If that
        search was over all these units, it is not repeated. At a limit, the outcome has ``tree``.
        """
        try:
            with self.deadline.watched("cutting the network", late=True):
                candidates = subproblem.units_within(subproblem.tree_cost(tree), lambda: self.deadline.passed)
        except KeyboardInterrupt:
            return self._outcome_at_limit(tree, ())
        if run is not None and run.units is not None and candidates <= set(self.prepared.units):
            return self._conclude(run, run.units)
        self._restrict_to(candidates)
        return self._search(tree)

    def _search_with_open_preconditions(
        self, subproblem: Subproblem, tree_without_rules: Units
    ) -> "Run | None":
        """Search a relaxation in which preconditions of unexplored units may stay open.

        A precondition is open if no unit of the tree makes it. Every tree that keeps to the rules has a part
        that is feasible in the relaxation. So an infeasible relaxation proves that there is no tree. A best
        tree without open preconditions is optimal. A unit of each landmark is required as well, since every
        tree has one. Until a tree without open preconditions is found, only units are minimized, which is
        fast.

        The first round explores ``tree_without_rules``, small landmarks and the units that mattered before.
        Each later round also explores the units of the last tree, and the other achievers of what they make.

        Returns the run with a proof. Returns ``None`` if no run has a proof within the limits of
        :class:`SearchTuning`. The explored units are added to ``_mattered``.
        """
        from foon_asp.encoding.fact_writer import write_known, write_objectives, write_required  # noqa: PLC0415

        self._take_whole_program()
        program, number = self.program, self.problem.network.unit_number
        files = (question_encoding("loose_ends.lp"), *program.files[1:], question_encoding("required.lp"))
        # shrinking cores takes longer than it saves here
        replaced_options, quick_options = (
            ((SHRINKING,), ()) if self.prepared.settings.clingo_options else (CLINGO_OPTIONS, _QUICK_OPTIONS)
        )
        arguments = (
            *(argument for argument in program.arguments if argument not in replaced_options),
            *quick_options,
        )
        program = program._replace(files=files, arguments=arguments)
        landmarks = subproblem.landmarks()
        required = write_required([map(number, sorted(landmark)) for landmark in landmarks])
        explored_before = subproblem.units_of_numbers(self._mattered)
        max_units = SEARCH.explored_units + len(explored_before)
        explored = subproblem.with_only_achievers(
            explored_before.union(
                tree_without_rules,
                *(landmark for landmark in landmarks if len(landmark) <= SEARCH.nearest_units),
            ),
            max_units,
        )
        minimized, fewest = _UNITS_ONLY, 0  # fast, and enough to prove that there is no tree
        for _ in range(SEARCH.open_rounds):
            self._mattered.update(map(number, explored))
            self._restrict_to(explored.union(subproblem.achievers_for(explored), *landmarks))
            prepared = replace(self.prepared, program=program)
            text = required + write_known(map(number, sorted(explored)))
            run = prepared.run(text + write_objectives(minimized))
            self.listener.run_ended(run)
            if minimized != self.levels and run.exhausted and run.units is not None:
                tree = self._unit_ids(run.units)
                if tree <= explored:  # it keeps to all rules: its cost bounds the optimum
                    minimized, fewest = self.levels, len(tree)
                    worst = self._current_scales().weight(minimized[0], tree)
                    run = prepared.run(text + write_objectives(minimized), f"opt,{worst}")
                    self.listener.run_ended(run)
            if not run.exhausted or run.units is None:
                return run if run.exhausted else None
            run.units = self._unit_ids(run.units)
            if run.units <= explored:
                return self._settle_open_preconditions(run, program, text, explored, fewest)
            if len(explored) > max_units:
                return None
            frontier = subproblem.rival_achievers(run.units - explored)
            enough = min(max_units, len(explored) * SEARCH.explored_growth)
            while frontier and len(explored) < enough:
                frontier = (
                    subproblem.with_only_achievers(frontier | subproblem.achievers_for(frontier), max_units)
                    - explored
                )
                explored |= frontier
        return None

    def _settle_open_preconditions(
        self, run: "Run", program: Program, text: str, explored: Collection[int], fewest: int
    ) -> "Run | None":
        """Find the best tree of a relaxation with open preconditions by exact costs.

        ``run`` found the best tree by rounded costs. ``program`` and ``text`` are the encodings and facts of
        the relaxation. Every tree has at least ``fewest`` units. Returns the run, with the tree that is best
        by exact costs. Returns ``None`` if this tree is not proved best. Also returns ``None`` if it has
        units that are not ``explored``, since it may then have open preconditions.
        """
        assert run.units is not None
        self._measures_agree(run.units, run.cost, self.levels)
        if self._current_scales().rounded is None:
            return run
        usual_program, usual_rules = self.program, self.rules
        self.program, self.rules, self._open_preconditions = program, usual_rules + text, True
        try:
            best, proved = self._settle(run.units, fewest)
        finally:
            self.program, self.rules, self._open_preconditions = usual_program, usual_rules, False
        run.units = best
        return run if proved and best <= set(explored) else None

    def _take_whole_program(self) -> None:
        """Switch to the program in which clingo enforces ready-made constraints, if there is one."""
        if self.program.whole is not None:
            self.program = self.program.whole
            self.prepared = replace(self.prepared, program=self.program)

    def _restrict_to(self, units: Collection[int]) -> None:
        """Restrict all later searches to these units; drop the scales, and close the ground program."""
        self.prepared = replace(self.prepared, units=tuple(sorted(units)))
        self._scales = None
        if self._ground:
            self._ground[1].close()
            self._ground = None

    def _search(self, incumbent: Units) -> Outcome:
        """Search for a tree better than the incumbent, and return the outcome.

        If no better tree exists, the incumbent is optimal. At a limit, the outcome has the best tree found.
        """
        opt_mode, strict = self._opt_mode(incumbent)
        run = self._run(self.levels, opt_mode=opt_mode, bounds=True)
        if run.units is None:
            if not run.exhausted:
                return self._outcome_at_limit(incumbent, run.lower)
            self.holds.require(strict, lambda: "a tree is at hand, but the encodings say that there is none")
            return self._optimal_outcome(incumbent)
        return self._conclude(run, run.units)

    def _conclude(self, run: "Run", units: Units) -> Outcome:
        """Return the outcome of a run that found the tree ``units``.

        A run that a limit stopped leads to an outcome without a proof. If clingo rounded costs, exact costs
        decide, except with replaced encodings that measure something else.
        """
        best, proved = self._best_reported(units), run.exhausted
        if self._measures_agree(units, run.cost, self.levels) and proved:
            best, proved = self._settle(best)
        return self._optimal_outcome(best) if proved else self._outcome_at_limit(best, run.lower)

    def _best_reported(self, units: Units) -> Units:
        """Return the incumbent; with replaced encodings, which may define another order, return ``units``."""
        assert self.listener.incumbent is not None
        return units if self.program.replaced else self.listener.incumbent[0]

    def _opt_mode(self, incumbent: Units) -> tuple[str, bool]:
        """Return clasp's ``--opt-mode``, such as ``opt,2,5``, and whether only better trees satisfy it.

        The mode bounds costs by those of the incumbent. Reductions by costs may remove trees that are as good
        as the incumbent, so only better trees are searched. If costs are rounded, they do not decide, so
        equal rounded costs are allowed. Without reductions by costs, the mode is ``opt``. No bound is below
        0, which some strategies of clasp do not support.
        """
        prepared = self.prepared
        if (
            not prepared.reduced
            or self.program.bounded
            or Reduction.BOUNDS not in prepared.settings.reductions
        ):
            return "opt", False
        scales = self._current_scales()
        level = len(self.levels) if scales.rounded is None else self.levels.index(scales.rounded)
        figures = [scales.weight(objective, incumbent) for objective in self.levels[:level]]
        if scales.rounded is not None:
            return ",".join(["opt", *map(str, figures)]), False
        while figures and not figures[-1]:
            figures.pop()
        if not figures:
            return "opt", False
        figures[-1] -= 1
        return ",".join(["opt", *map(str, figures)]), True

    def _optimal_outcome(self, units: Units) -> Outcome:
        """Return the outcome in which a tree is optimal, so that its costs are the bounds."""
        costs = self.listener.costs(units)
        return self._outcome(Status.OPTIMAL, units, {o: costs.measure(o) for o in self.levels})

    def _outcome_at_limit(self, units: Units, lower: Sequence[int]) -> Outcome:
        """Return the outcome with the incumbent at a limit.

        With replaced encodings, it has the tree ``units`` and no bounds. ``lower`` are clingo's lower bounds,
        the highest priority first; it may be empty.
        """
        bounds = {} if self.program.replaced else self._objective_bounds(lower)
        return self._outcome(Status.FEASIBLE, self._best_reported(units), bounds)

    def _run(
        self,
        objectives: Sequence[Objective],
        products: Sequence[Mapping[int, int]] = (),
        wanted: int | None = None,
        opt_mode: str = "opt",
        bounds: bool = False,
        fewer: Mapping[int, int] | None = None,
    ) -> "Run":
        """Run clingo for the best tree by ``objectives``, report trees, and return the run.

        The units of the run are given by id in the network of the problem. At a limit before the search, the
        run is empty.

        ``products``: totals by the rounded objective, such as products of success rates. Each total is a
        vector of :meth:`Scales.vector`. Trees with one of the totals are excluded.
        ``wanted``: if it is not ``None``, no total is excluded. Instead, trees must have the total at this
        index of ``products``.
        ``fewer``: numbers of units by index of a total. Trees with this total are allowed if they have fewer
        units.
        ``opt_mode``: the ``--opt-mode`` of clasp.
        ``bounds``: whether to report bounds as well; with replaced encodings, none are reported.
        """
        on_bound = self._report_bound if bounds and not self.program.replaced else None

        def on_tree(units: Units) -> None:
            """Report a tree, given by ids in the whole network, unless it may have open preconditions."""
            if not self._open_preconditions:
                self.listener.tree(self._unit_ids(units))

        self._take_whole_program()
        try:
            run = self._ground_program(objectives, products, wanted, fewer or {}).search(
                self.deadline, opt_mode, on_tree, on_bound
            )
        except KeyboardInterrupt:  # before the search began
            self.deadline.interrupt()
            from foon_asp.encoding.run import Run  # noqa: PLC0415

            run = Run()
        self.seconds["solve"] = self.seconds.get("solve", 0.0) + run.solve_seconds
        self.listener.run_ended(run)
        if run.units is not None:
            run.units = self._unit_ids(run.units)
        return run

    def _ground_program(
        self,
        objectives: Sequence[Objective],
        products: Sequence[Mapping[int, int]],
        wanted: int | None,
        fewer: Mapping[int, int],
    ) -> "Grounded":
        """Return the ground program for the parameters of :meth:`_run`.

        The last program is kept. It is returned again for equal parameters; of ``products``, only the number
        of totals is compared. For other parameters, the last program is closed. The times of writing facts
        and of grounding are added to ``seconds``.
        """
        question = objectives, len(products), wanted, fewer
        if self._ground:
            last_question, program = self._ground
            if last_question == question:
                return program
            program.close()
        from foon_asp.encoding import fact_writer  # noqa: PLC0415 (often there is nothing left to ask)

        began = time.perf_counter()
        text = self.prepared.facts + self.rules + fact_writer.write_objectives(objectives)
        self._add_seconds("facts", began)
        files = self.program.files
        if products:
            files = (*files, self.program.exact_success)
            text += fact_writer.write_exponents(self.problem, self._current_scales())
            text += "".join(itertools.starmap(fact_writer.write_product, enumerate(products)))
            text += (
                fact_writer.write_seen(range(len(products)))
                if wanted is None
                else fact_writer.write_wanted(wanted)
            )
            text += fact_writer.write_fewer(fewer)
        from foon_asp.encoding.clingo_run import ground  # noqa: PLC0415 (slow to import)

        began = time.perf_counter()
        try:
            program = ground(
                files, text, self.program.arguments, self.deadline, len(products), self.program.endless
            )
        finally:
            self._add_seconds("ground", began)
        self._ground = question, program
        return program

    def _current_scales(self) -> "Scales":
        """Return the scales by which costs of the remaining units become clingo's integers."""
        if self._scales is None:
            self._scales = self.prepared.scales
        return self._scales

    def _unit_ids(self, numbers: Units) -> Units:
        """Return the ids of units that are given by id in the whole network.

        Raises :class:`UserError` for an id of no unit.
        """
        units: set[int] = set()
        for number in sorted(numbers):
            unit = self.problem.network.unit_of_number(number)
            if unit is None:
                raise UserError(
                    f"the encodings made use({number}), but the network has no unit of that number"
                )
            units.add(unit)
        return Units(units)

    def _settle(self, best: Units, fewest: int = 0) -> tuple[Units, bool]:
        """Find the best tree by exact costs where clingo compares rounded ones (docs/dev/exact-success.md).

        ``best`` is the best tree by rounded costs. Every total that rounding may have hidden is examined. No
        tree has fewer units than ``fewest``. Returns the best tree found, and whether it is proved best. At a
        limit, there is no proof. If no costs are rounded, ``best`` is returned as proved.
        """
        scales = self._current_scales()
        if scales.rounded not in self.levels:  # a kept program has other levels, too
            return best, True
        position = self.levels.index(scales.rounded)
        earlier_levels, rounded_levels, later_levels = (
            self.levels[:position],
            self.levels[: position + 1],
            self.levels[position + 1 :],
        )
        totals: list[dict[int, int]] = []
        earlier_weights = [scales.weight(objective, best) for objective in earlier_levels]
        chosen, rival, wanted = best, best, [0]  # indices of the totals as good as that of the chosen tree
        # a second search with open preconditions is slow
        at_once = self._open_preconditions and later_levels == _UNITS_ONLY
        while True:
            # A total that is better or as good has a weight of at most W + n - 1, where n units of the tree
            # weigh less than they cost, and of at most W where none does.
            totals.append(scales.vector(rival))
            doubt = scales.count_rounded(chosen)
            if not doubt and multiplies(scales.rounded):
                break  # nothing succeeds more often than always, and equal products have equal vectors
            rounded_limit = scales.weight(scales.rounded, chosen) + max(0, doubt - 1)
            mode = ",".join(["opt", *map(str, earlier_weights), str(rounded_limit)])
            fewer = wanted if at_once and len(chosen) > fewest else ()
            run = self._run(rounded_levels, totals, opt_mode=mode, fewer=dict.fromkeys(fewer, len(chosen)))
            if not run.exhausted or (at_once and run.units is None):
                return chosen, run.exhausted
            if run.units is None:
                break
            rival = run.units
            self._require_measures(self._measures_agree(rival, run.cost, rounded_levels))
            chosen_costs, rival_costs = (
                self.listener.costs(tree).key(rounded_levels) for tree in (chosen, rival)
            )
            if rival_costs < chosen_costs:
                chosen, wanted = rival, []
            elif rival_costs == chosen_costs and at_once:
                chosen = min(chosen, rival, key=len)
            if rival_costs <= chosen_costs:
                wanted.append(len(totals))
        if not later_levels or (later_levels == _UNITS_ONLY and len(chosen) == fewest):
            return chosen, True
        for number in wanted:
            limits = (scales.weight(objective, chosen) for objective in later_levels)
            mode = ",".join(["opt", *map(str, earlier_weights), *map(str, limits)])
            run = self._run((*earlier_levels, *later_levels), totals, number, mode)
            if run.units is not None:
                self._require_measures(
                    self._measures_agree(run.units, run.cost, (*earlier_levels, *later_levels))
                )
                self.holds.require_equal_costs(run.units, chosen, rounded_levels)
                chosen = run.units
            if not run.exhausted:
                return chosen, False
            settled = run.units is not None or number != wanted[0]  # the first total has a tree
            self._require_measures(settled or not self.program.replaced)
            self.holds.require(settled, lambda: f"the best {scales.rounded} was lost")
        return chosen, True

    def _measures_agree(self, units: Units, cost: Sequence[int], objectives: Sequence[Objective]) -> bool:
        """Return whether clingo's costs of a tree are the weights of its units, modulo 2^32.

        If they are not, and objectives.lp was replaced, a warning is reported. If objectives.lp was not
        replaced, this is a bug. In any case, the weights have to fit the exact costs. ``cost`` may have all
        levels, with 0 for levels that are not optimized.
        """
        scales, costs = self._current_scales(), self.listener.costs(units)
        weights = {objective: scales.weight(objective, units) for objective in objectives}
        self.holds.require(
            all(scales.allows(o, weight, costs.measure(o)) for o, weight in weights.items()),
            lambda: (
                f"the units {sorted(units)} weigh {list(weights.values())}, "
                f"but cost {[str(costs.measure(o)) for o in weights]}"
            ),
        )
        listed = self.levels if len(cost) == len(self.levels) else objectives
        our_weights = [weights.get(objective, 0) for objective in listed]
        agree = [weight % 2**32 for weight in our_weights] == [clingo_cost % 2**32 for clingo_cost in cost]
        self.holds.require(
            agree or self.program.replaced,
            lambda: f"clingo reports the costs {list(cost)}, the units {sorted(units)} cost {our_weights}",
        )
        if not agree:
            self.listener.reporter.warning(
                f"{self.program.files[1]} does not measure what the objectives "
                f"{', '.join(self.levels)} measure here: the tree is optimal in its sense, and the costs "
                "shown are the usual ones"
            )
        return agree

    def _require_measures(self, agree: bool) -> None:
        """Raise :class:`UserError` unless ``agree``: clingo's costs of a tree equal our weights.

        Called for later trees, after the costs of an earlier tree agreed. A disagreement then means that a
        replaced objectives.lp is the usual measure for some trees only, so that trees cannot be compared.
        """
        if not agree:
            raise UserError(
                f"{self.program.files[1]} measures some trees as the objectives {', '.join(self.levels)} do, "
                "and others not: they cannot be compared"
            )

    def _objective_bounds(self, lower: Sequence[int]) -> dict[Objective, int | Fraction]:
        """Return bounds on the objectives from clingo's lower bounds, which begin with the highest priority.

        Without a bound of clingo, costs are at least 0 and success is at most 1. Objectives after a rounded
        one have no bound.

        After reductions, the bound by cuts on the first objective is used if it is better. A bound on a cost
        is at most the cost of the incumbent, since clingo may search for better trees only. If the first
        objective multiplies, or its bound differs from the cost of the incumbent, later objectives have no
        bound.
        """
        bounds: dict[Objective, int | Fraction] = {}
        for objective, value in zip(self.levels, lower or [0], strict=False):
            scales = self._scales
            bounds[objective] = (
                scales.bound(objective, max(0, value)) if scales else int(multiplies(objective))
            )
            if scales and objective is scales.rounded:
                break
        reduced = self.prepared.reduced
        if reduced is None or reduced.costs is None:
            return bounds
        first_objective, proved = self.levels[0], reduced.costs.first_objective_bound(reduced.bound)
        if multiplies(first_objective):
            return {first_objective: min(bounds[first_objective], proved)}
        assert self.listener.incumbent is not None
        _, best = self.listener.incumbent
        bounds[first_objective] = max(bounds[first_objective], proved)
        for objective, bound in bounds.items():
            if not multiplies(objective):
                bounds[objective] = min(bound, best.measure(objective))
        return (
            bounds
            if bounds[first_objective] == best.measure(first_objective)
            else {first_objective: bounds[first_objective]}
        )

    def _report_bound(self, lower: Sequence[int]) -> None:
        """Report the bounds that follow from clingo's lower bounds."""
        for objective, bound in self._objective_bounds(lower).items():
            self.listener.reporter.bound(objective, bound)

    def _outcome(
        self, status: Status, units: Units | None, bounds: dict[Objective, int | Fraction]
    ) -> Outcome:
        """Return the outcome with this status, these units and these bounds.

        If ``units`` is ``None``, the outcome has no tree. Otherwise the postconditions of the tree are
        checked first.
        """
        prepared, reduced = self.prepared, self.prepared.reduced
        proof = Proof.SOLVER if status in {Status.OPTIMAL, Status.INFEASIBLE} else None
        if status is Status.OPTIMAL and reduced and reduced.settled:
            proof = Proof.CUTS
        outcome = Outcome(
            self.problem,
            self.objectives,
            status,
            None,
            None,
            bounds,
            self.seconds,
            self.program.encodings,
            proof,
            stopped=self.deadline.stopped if proof is None else None,
        )
        if units is None:
            return outcome
        began = time.perf_counter()
        size = len(self.problem.network.objects)  # larger ids are required sets of units
        outcome = outcome._replace(
            units=self.holds.require_executable(units),
            costs=self.listener.costs(units),
            left=0 if proof is Proof.CUTS else len(prepared.units),
            cases=reduced.cases if reduced else None,
            cuts=tuple(tuple(sorted(objects)) for objects in _cut_objects(reduced) if max(objects) < size),
        )
        assert self.listener.incumbent is not None
        self.holds.require_true_claims(
            outcome, None if self.program.replaced else self.listener.incumbent[1], reduced
        )
        prepared.require_kept(units)
        self._add_seconds("check", began)
        return outcome

    def _add_seconds(self, phase: str, began: float) -> None:
        """Add the time since ``began`` to the seconds of a phase."""
        self.seconds[phase] = self.seconds.get(phase, 0.0) + time.perf_counter() - began


def _cut_objects(reduced: Reduced | None) -> list[frozenset[int]]:
    """Return the objects of each cut that a certificate can start from.

    There are three kinds of cuts: those of the best bound, those found before any reduction, and tight cuts.
    Excluded actions may cross many cuts of the best bound. Cuts found before any reduction count all actions.
    A tight cut counts the actions that remained when it was found. Without reductions, the list is empty.
    """
    if reduced is None:
        return []
    best = _first_cut_objects(reduced.cuts)
    if reduced.partition:
        best = [objects for objects, _ in reduced.partition.cuts]
    first = _first_cut_objects(reduced.subproblem.cuts if reduced.subproblem else None)
    return [*dict.fromkeys([*best, *first, *reduced.tight])]


def _first_cut_objects(cuts: Cuts | None) -> list[frozenset[int]]:
    """Return the objects of each cut, for the first cuts: up to about ``SEARCH.cut_objects`` objects in all.

    The list is empty for ``None``.
    """
    object_sets, total = list[frozenset[int]](), 0
    for cut in cuts.cuts if cuts else ():
        if total > SEARCH.cut_objects:
            break
        object_sets.append(cut.objects)
        total += len(object_sets[-1])
    return object_sets
