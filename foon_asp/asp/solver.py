"""Optimal task trees: the cut, the runs of clingo, and the resulting claim."""

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
from foon_asp.asp.settings import Settings
from foon_asp.bounds.landmark_cuts import Cuts
from foon_asp.encoding.own_encodings import question_encoding
from foon_asp.errors import UserError
from foon_asp.problem import Costs, Objective, Problem, levels, multiplies
from foon_asp.reduce import ExactCosts, Listener, Reduced, Reduction, Wide

if TYPE_CHECKING:  # clingo and what it is given, which often is not needed
    from foon_asp.encoding.scales import Scales
    from foon_asp.grounding.grounded import Grounded
    from foon_asp.grounding.run import Run

_MOST_CUT_OBJECTS = 200_000  # of the cuts that a certificate tries first; it finds others by itself
_NEAR = 200  # units nearest to the goals, among which a tree that keeps to all rules is looked for first
_LOOSE = 12  # times that trees with loose ends are looked for, with ever fewer of these
NOT_ASKED = (
    "clingo has no statistics: the question was settled without its search; --reduce none leaves it to clingo"
)
_FEWEST: tuple[Objective, ...] = (Objective.UNITS,)
_GROWN = 1.5  # times as many of them are known each time, if that is what leads to what they need
_MANY = 5000  # units that are known then, at most about, beside those that were before
_QUICK = "--configuration=frumpy", "--opt-strategy=usc,pmres,4"  # what clingo has done by itself takes longer
_MORE = 4  # times as many, where there is none

Units = frozenset[int]


def solve(
    problem: Problem,
    objectives: Sequence[Objective] = (Objective.UNITS,),
    settings: Settings | None = None,
    reporter: Reporter | None = None,
    known: set[int] | None = None,
) -> Outcome:
    """Find the best task tree under a lexicographic list of objectives, and prove it.

    ``units`` decides last, so that no tree carries a unit it does not need. Stops at the time limit or at
    ctrl-C with the best tree so far. ``known`` are numbers of units that mattered in a question like this
    one, and of those that matter in this one afterwards. Raises :class:`UserError` for faults in constraints,
    encodings and options, and where ``success`` is asked for and no rates are known.
    """
    settings, reporter = settings or Settings(), reporter or Reporter()
    program = program_of(problem, settings, reporter.warning)
    began = time.perf_counter()
    heard = _Heard(problem, objectives, reporter)
    first = prepare(problem, objectives, settings, program, heard, brief=bool(known))
    seconds = {"cut": time.perf_counter() - began}
    outcome = _Solver(first, objectives, heard, seconds, known=known).solve()
    if settings.asks_for_statistics and not heard.asked:
        reporter.statistics(NOT_ASKED)
    return outcome


def solve_prepared(first: Prepared, objectives: Sequence[Objective], rules: str = "") -> Outcome:
    """Find the best task tree of a prepared question, with additional rules, and prove it."""
    return _Solver(first, objectives, _Heard(first.problem, objectives, Reporter()), {}, rules).solve()


class _Heard(Listener):
    """Receives trees and bounds, keeps the best tree and passes on improvements."""

    def __init__(self, problem: Problem, objectives: Sequence[Objective], reporter: Reporter) -> None:
        self.problem, self.levels, self.reporter = problem, levels(tuple(objectives)), reporter
        self.best: tuple[Units, Costs] | None = None
        self.asked = False  # clingo, so that there are statistics
        self._costed: tuple[Units, Costs] | None = None  # the tree whose costs were asked for last

    def tree(self, units: Units) -> None:
        costs = self.costs(units)
        if self.best is None or costs.key(self.levels) < self.best[1].key(self.levels):
            self.best = units, costs
            self.reporter.tree(costs)

    def bound(self, costs: ExactCosts, bound: int) -> None:
        self.reporter.bound(self.levels[0], costs.first(bound))

    def ended(self, run: "Run") -> None:
        """Pass on the statistics of a run of clingo."""
        if run.statistics:
            self.asked = True
            self.reporter.statistics(run.statistics)

    def costs(self, units: Units) -> Costs:
        """Return what units cost, worked out once for a tree in hand."""
        if self._costed is None or self._costed[0] != units:
            self._costed = units, self.problem.costs(units)
        return self._costed[1]


class _Solver:
    """A prepared question that is being solved."""

    def __init__(
        self,
        first: Prepared,
        objectives: Sequence[Objective],
        heard: _Heard,
        seconds: dict[str, float],
        rules: str = "",
        known: set[int] | None = None,
    ) -> None:
        self.first, self.objectives, self.heard, self.seconds = first, tuple(objectives), heard, seconds
        self.rules = first.program.rules + rules
        self.problem, self.levels, self.deadline = first.problem, first.levels, first.deadline
        self.program, self.holds = first.program, first.holds
        self._scales: Scales | None = None  # before clingo is asked anything
        self._ground: tuple[object, Grounded] | None = None  # what was asked last
        self._loose = False  # whether what is found may have loose ends
        self._known = set() if known is None else known  # units, by number, with which loose ends begin

    def solve(self) -> Outcome:
        """Solve it; where that is stopped anywhere, state what is known by then."""
        deadline = self.deadline
        try:
            with deadline.watched(deadline.doing, late=True, grace=True):
                return self._solve()
        except KeyboardInterrupt:
            deadline.interrupt()
            if self.heard.best is None and self._at_hand is not None:
                self.heard.tree(self._at_hand)
            best = self.heard.best
            return self._outcome(Status.UNKNOWN, None, {}) if best is None else self._limited(best[0], ())
        finally:
            if self._ground:
                self._ground[1].close()

    @property
    def _at_hand(self) -> Units | None:
        """The tree that the cut gave, if all there is to keep to is known to it."""
        decided = self.program.own and not self.program.bounded
        return self.first.tree if decided else None

    def _solve(self) -> Outcome:
        first = self.first
        if first.stopped:
            return self._outcome(Status.UNKNOWN, None, {})
        if first.tree is None:
            if first.asked is not None:
                first.keeps(Units())  # to say what is wrong with a rule, though no tree depends on it
            if not first.contradicted:
                self.holds.no_tree()
            return self._outcome(Status.INFEASIBLE, None, {})
        if first.rest and first.reduced and first.reduced.wide:
            return self._under_rest(first.reduced, first.reduced.wide, first.tree)
        incumbent = self._at_hand
        if incumbent is None:  # the user's rules or the bounds decide what a tree is: let them find the first
            some = self._run(self.levels, opt_mode="ignore")
            if some.units is None:
                return self._outcome(Status.INFEASIBLE if some.exhausted else Status.UNKNOWN, None, {})
            incumbent = some.units
        self.heard.tree(incumbent)
        if first.reduced and first.reduced.settled:
            return self._optimal(incumbent)
        # at a limit, not even what clingo would be given is written
        return self._limited(incumbent, ()) if self.deadline.passed else self._search(incumbent)

    def _under_rest(self, reduced: Reduced, wide: Wide, tree: Units) -> Outcome:
        """Find the best tree that keeps to rules that the reductions did not know of.

        If the best tree without them keeps to them, it is the one.
        """
        if self._known:  # it does not, and nothing else told before
            return self._beside(wide, tree)
        keeps = self.first.keeps(tree)
        if keeps:
            self.heard.tree(tree)
            if reduced.settled:
                return self._optimal(tree)
        self.first = replace(self.first, reduced=reduced._replace(settled=False))
        found = self._by_cases(reduced, wide)
        if found is None and keeps:
            found = self._up_to(wide, tree, None)
        return found or self._beside(wide, tree)

    def _beside(self, wide: Wide, tree: Units) -> Outcome:
        """Find the best tree that keeps to rules which this one breaks.

        One is looked for that has units without what they need, and then one near the goals.
        """
        if not wide.redundant and not self._known and (found := self._within_limits(wide, tree)) is not None:
            return found
        ended = None if wide.redundant else self._with_loose_ends(wide, tree)
        is_best = ended is not None
        if ended is None:
            ended = self._near(wide, tree)
        if ended.units is None:
            return self._outcome(Status.INFEASIBLE if ended.exhausted else Status.UNKNOWN, None, {})
        self.heard.tree(ended.units)
        if is_best:
            return self._optimal(self._in_hand(ended.units))
        if not ended.exhausted:
            return self._limited(ended.units, ())
        return self._up_to(wide, self._in_hand(ended.units), ended)

    def _by_cases(self, reduced: Reduced, wide: Wide) -> Outcome | None:
        """Find the best tree that keeps to ready-made constraints, where few cases tell; else ``None``."""
        rules, settings = self.program.ready_made, self.first.settings
        if rules is None or Reduction.BOUNDS not in settings.reductions:
            return None
        from foon_asp.reduce.cases import best_kept  # noqa: PLC0415 (of use with few rules)

        try:
            with self.deadline.watched("cutting the network", late=True):
                found = best_kept(
                    self.problem, self.levels, wide, reduced, rules, lambda: self.deadline.passed
                )
        except KeyboardInterrupt:
            self.deadline.interrupt()
            if self.heard.best is None:
                return self._outcome(Status.UNKNOWN, None, {})
            return self._limited(self.heard.best[0], ())
        if found is None:
            return None
        if found.tree is None:
            return self._outcome(Status.INFEASIBLE, None, {})
        self.heard.tree(found.tree)
        return self._optimal(self._in_hand(found.tree))

    def _within_limits(self, wide: Wide, tree: Units) -> Outcome | None:
        """Find the best tree by a price on what a rule limits; ``None`` where no price tells."""
        from foon_asp.reduce.within_limit import limited  # noqa: PLC0415 (of use with few rules)

        asked = self.first.asked
        assert asked is not None
        assert asked.added is not None
        for counts, most in asked.added.counted(self.problem):
            if sum(map(counts, tree)) <= most:
                continue
            try:
                with self.deadline.watched("cutting the network", late=True):
                    found = limited(wide, self.levels, tree, counts, most, lambda: self.deadline.passed)
            except KeyboardInterrupt:
                self.deadline.interrupt()
                return self._outcome(Status.UNKNOWN, None, {})
            if found is None:
                continue
            if found.tree is None:
                return self._outcome(Status.INFEASIBLE, None, {})
            if self.first.keeps(found.tree):
                self.heard.tree(found.tree)
                if found.units is not None:
                    self._look_at(found.units | found.tree)
                    return self._search(found.tree)
                return self._up_to(wide, found.tree, None)
        return None

    def _near(self, wide: Wide, tree: Units) -> "Run":
        """Look for the best tree that keeps to all rules near the goals, then ever farther from them."""
        known, most = wide.everything(), _NEAR
        while True:
            among = known if most >= len(known) else wide.nearest(most) | tree
            most *= _MORE
            self._look_at(among)
            ended = self._run(self.levels)
            if ended.units is not None or not ended.exhausted or among >= known:
                return ended

    def _up_to(self, wide: Wide, tree: Units, ended: "Run | None") -> Outcome:
        """Look for what is better than a tree, among all units that trees up to its cost can have.

        ``ended`` is the search that found the tree, if one did.
        """
        try:
            with self.deadline.watched("cutting the network", late=True):
                within = wide.units_within(wide.total(tree), lambda: self.deadline.passed)
        except KeyboardInterrupt:
            return self._limited(tree, ())
        if ended is not None and ended.units is not None and within <= set(self.first.units):
            return self._ended(ended, ended.units)
        self._look_at(within)
        return self._search(tree)

    def _with_loose_ends(self, wide: Wide, tree: Units) -> "Run | None":
        """Look for the best tree that keeps to rules, some units of which run without what they need.

        Of any tree some units are one with loose ends, and keep to the rules where it does. So there is none
        where there is none with loose ends, and the best of these is the best of all if it has none. Every
        tree has a unit of each landmark, too. ``None`` where nothing is settled so after some times.
        """
        from foon_asp.encoding.facts import write_known, write_objectives, write_required  # noqa: PLC0415

        self._ask_clingo()
        program, number = self.program, self.problem.network.unit_number
        files = (question_encoding("loose_ends.lp"), *program.files[1:], question_encoding("required.lp"))
        # to make cores small takes longer than it saves here
        others, quick = ((SHRINKING,), ()) if self.first.settings.clingo_options else (CLINGO_OPTIONS, _QUICK)
        arguments = (*(each for each in program.arguments if each not in others), *quick)
        program = program._replace(files=files, arguments=arguments)
        sets = wide.landmarks()
        required = write_required([map(number, sorted(each)) for each in sets])
        before = wide.left_of(self._known)
        most = _MANY + len(before)
        known = wide.with_only_achievers(before.union(tree, *(e for e in sets if len(e) <= _NEAR)), most)
        by, fewest = _FEWEST, 0  # quick to ask, and enough to see that there is none
        for _ in range(_LOOSE):
            self._known.update(map(number, known))
            self._look_at(known.union(wide.achievers_for(known), *sets))
            asked = replace(self.first, program=program)
            text = required + write_known(map(number, sorted(known)))
            ended = asked.run(text + write_objectives(by))
            self.heard.ended(ended)
            if by != self.levels and ended.exhausted and ended.units is not None:
                tree = self._ids(ended.units)
                if tree <= known:  # one that keeps to all rules: what is best is no worse
                    by, fewest = self.levels, len(tree)
                    worst = self._scaled().weight(by[0], tree)
                    ended = asked.run(text + write_objectives(by), f"opt,{worst}")
                    self.heard.ended(ended)
            if not ended.exhausted or ended.units is None:
                return ended if ended.exhausted else None
            ended.units = self._ids(ended.units)
            if ended.units <= known:
                return self._settled_with_loose_ends(ended, program, text, known, fewest)
            if len(known) > most:
                return None
            fresh = wide.rival_achievers(ended.units - known)
            enough = min(most, len(known) * _GROWN)
            while fresh and len(known) < enough:
                fresh = wide.with_only_achievers(fresh | wide.achievers_for(fresh), most) - known
                known |= fresh
        return None

    def _settled_with_loose_ends(
        self, ended: "Run", program: Program, text: str, known: Collection[int], fewest: int
    ) -> "Run | None":
        """Examine what rounding may have hidden among trees with loose ends, too.

        None of them has fewer units than ``fewest``. ``None`` where the best has loose ends.
        """
        assert ended.units is not None
        self._measures_agree(ended.units, ended.cost, self.levels)
        if self._scaled().rounded is None:
            return ended
        before, rules = self.program, self.rules
        self.program, self.rules, self._loose = program, rules + text, True
        try:
            best, proved = self._settle(ended.units, fewest)
        finally:
            self.program, self.rules, self._loose = before, rules, False
        ended.units = best
        return ended if proved and best <= set(known) else None

    def _ask_clingo(self) -> None:
        """Have the program as a whole from now on."""
        if self.program.whole is not None:
            self.program = self.program.whole
            self.first = replace(self.first, program=self.program)

    def _look_at(self, units: Collection[int]) -> None:
        """Search among these units from now on."""
        self.first = replace(self.first, units=tuple(sorted(units)))
        self._scales = None
        if self._ground:
            self._ground[1].close()
            self._ground = None

    def _search(self, incumbent: Units) -> Outcome:
        """Ask clingo for what is better than the tree in hand."""
        wanted, strict = self._wanted(incumbent)
        ended = self._run(self.levels, opt_mode=wanted, bounds=True)
        if ended.units is None:
            if not ended.exhausted:
                return self._limited(incumbent, ended.lower)
            self.holds.require(strict, lambda: "a tree is at hand, but the encodings say that there is none")
            return self._optimal(incumbent)
        return self._ended(ended, ended.units)

    def _ended(self, ended: "Run", units: Units) -> Outcome:
        """Settle what a search ended with."""
        best, proved = self._in_hand(units), ended.exhausted
        if self._measures_agree(units, ended.cost, self.levels) and proved:
            best, proved = self._settle(best)
        return self._optimal(best) if proved else self._limited(best, ended.lower)

    def _in_hand(self, units: Units) -> Units:
        """Return the best tree reported; with replaced encodings that is not known, and these units count."""
        assert self.heard.best is not None
        return units if self.program.replaced else self.heard.best[0]

    def _wanted(self, incumbent: Units) -> tuple[str, bool]:
        """Return clasp's mode of search, and whether it leaves out trees that are only as good as this one.

        After the reductions, trees that are only as good need not be among the units left. Where rates
        multiply, rounded weights cannot tell what is better: then what weighs the same is left in. No bound
        is below 0, which not every strategy of clasp takes for what it says.
        """
        first = self.first
        if not first.reduced or self.program.bounded or Reduction.BOUNDS not in first.settings.reductions:
            return "opt", False
        scales = self._scaled()
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

    def _optimal(self, units: Units) -> Outcome:
        costs = self.heard.costs(units)
        return self._outcome(Status.OPTIMAL, units, {o: costs.measure(o) for o in self.levels})

    def _limited(self, units: Units, lower: Sequence[int]) -> Outcome:
        """State what is known at a limit; what the bounds of replaced encodings mean is not known."""
        bounds = {} if self.program.replaced else self._bounds(lower)
        return self._outcome(Status.FEASIBLE, self._in_hand(units), bounds)

    def _run(
        self,
        objectives: Sequence[Objective],
        products: Sequence[Mapping[int, int]] = (),
        wanted: int | None = None,
        opt_mode: str = "opt",
        bounds: bool = False,
        fewer: Mapping[int, int] | None = None,
    ) -> "Run":
        """Ask clingo for the best tree by some of the levels.

        ``products`` of rates, by exponents, are ruled out, but for trees of fewer units than ``fewer`` says
        of their number; with ``wanted`` the one of that number is asked for instead. The reporter hears of
        trees, and of ``bounds`` where they are those of the question.
        """
        on_bound = self._report_bound if bounds and not self.program.replaced else None

        def on_tree(units: Units) -> None:
            if not self._loose:
                self.heard.tree(self._ids(units))

        self._ask_clingo()
        try:
            ended = self._grounded(objectives, products, wanted, fewer or {}).search(
                self.deadline, opt_mode, on_tree, on_bound
            )
        except KeyboardInterrupt:  # before it came to a search
            self.deadline.interrupt()
            from foon_asp.grounding.run import Run  # noqa: PLC0415

            ended = Run()
        self.seconds["solve"] = self.seconds.get("solve", 0.0) + ended.solve_seconds
        self.heard.ended(ended)
        if ended.units is not None:
            ended.units = self._ids(ended.units)
        return ended

    def _grounded(
        self,
        objectives: Sequence[Objective],
        products: Sequence[Mapping[int, int]],
        wanted: int | None,
        fewer: Mapping[int, int],
    ) -> "Grounded":
        """Ground what is asked, unless it was the last thing asked."""
        asked = objectives, len(products), wanted, fewer
        if self._ground:
            before, program = self._ground
            if before == asked:
                return program
            program.close()
        from foon_asp.encoding import facts  # noqa: PLC0415 (often there is nothing left to ask)

        began = time.perf_counter()
        text = self.first.facts + self.rules + facts.write_objectives(objectives)
        self._spent("facts", began)
        files = self.program.files
        if products:
            files = (*files, self.program.exact_success)
            text += facts.write_exponents(self.problem, self._scaled())
            text += "".join(itertools.starmap(facts.write_product, enumerate(products)))
            text += facts.write_seen(range(len(products))) if wanted is None else facts.write_wanted(wanted)
            text += facts.write_fewer(fewer)
        from foon_asp.encoding.search import ground  # noqa: PLC0415 (slow to import)

        began = time.perf_counter()
        try:
            program = ground(
                files, text, self.program.arguments, self.deadline, len(products), self.program.endless
            )
        finally:
            self._spent("ground", began)
        self._ground = asked, program
        return program

    def _scaled(self) -> "Scales":
        """Return how what is left of the network is measured in clingo."""
        if self._scales is None:
            self._scales = self.first.scales
        return self._scales

    def _ids(self, numbers: Units) -> Units:
        """Give the ids of units in an answer, whose numbers come from encodings, which may be the user's."""
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
        """Examine every total that rounding may have hidden; see docs/dev/exact-success.md.

        No tree has fewer units than ``fewest``. Returns the tree that is best exactly, and whether the search
        came to its end.
        """
        scales = self._scaled()
        if scales.rounded not in self.levels:  # a program that is kept knows others, too
            return best, True
        place = self.levels.index(scales.rounded)
        before, by, after = self.levels[:place], self.levels[: place + 1], self.levels[place + 1 :]
        totals: list[dict[int, int]] = []
        fixed = [scales.weight(objective, best) for objective in before]
        chosen, rival, wanted = best, best, [0]  # the totals that are as good as that of the tree chosen
        at_once = self._loose and after == _FEWEST  # the second search of these takes long
        while True:
            # A total that is better or as good has a weight of at most W + n - 1, where n units of the tree
            # weigh less than they cost, and of at most W where none does.
            totals.append(scales.vector(rival))
            doubt = scales.doubt(chosen)
            if not doubt and multiplies(scales.rounded):
                break  # nothing succeeds more often than always, and equal products have equal vectors
            band = scales.weight(scales.rounded, chosen) + max(0, doubt - 1)
            mode = ",".join(["opt", *map(str, fixed), str(band)])
            fewer = wanted if at_once and len(chosen) > fewest else ()
            ended = self._run(by, totals, opt_mode=mode, fewer=dict.fromkeys(fewer, len(chosen)))
            if not ended.exhausted or (at_once and ended.units is None):
                return chosen, ended.exhausted
            if ended.units is None:
                break
            rival = ended.units
            self._require_measures(self._measures_agree(rival, ended.cost, by))
            ours, theirs = (self.heard.costs(tree).key(by) for tree in (chosen, rival))
            if theirs < ours:
                chosen, wanted = rival, []
            elif theirs == ours and at_once:
                chosen = min(chosen, rival, key=len)
            if theirs <= ours:
                wanted.append(len(totals))
        if not after or (after == _FEWEST and len(chosen) == fewest):
            return chosen, True
        for number in wanted:
            limits = (scales.weight(objective, chosen) for objective in after)
            mode = ",".join(["opt", *map(str, fixed), *map(str, limits)])
            ended = self._run((*before, *after), totals, number, mode)
            if ended.units is not None:
                self._require_measures(self._measures_agree(ended.units, ended.cost, (*before, *after)))
                self.holds.settled(ended.units, chosen, by)
                chosen = ended.units
            if not ended.exhausted:
                return chosen, False
            found = ended.units is not None or number != wanted[0]  # of the first, one is in hand
            self._require_measures(found or not self.program.replaced)
            self.holds.require(found, lambda: f"the best {scales.rounded} was lost")
        return chosen, True

    def _measures_agree(self, units: Units, cost: Sequence[int], objectives: Sequence[Objective]) -> bool:
        """Compare clingo's costs (modulo 2^32) with the weights of units, and these with what units cost.

        A replaced objectives.lp may measure something else: then the optimum is the one it defines. A program
        that is kept measures all levels, and what was not asked for as nothing.
        """
        scales, costs = self._scaled(), self.heard.costs(units)
        weights = {objective: scales.weight(objective, units) for objective in objectives}
        self.holds.require(
            all(scales.allows(o, weight, costs.measure(o)) for o, weight in weights.items()),
            lambda: (
                f"the units {sorted(units)} weigh {list(weights.values())}, "
                f"but cost {[str(costs.measure(o)) for o in weights]}"
            ),
        )
        listed = self.levels if len(cost) == len(self.levels) else objectives
        ours = [weights.get(objective, 0) for objective in listed]
        agree = [mine % 2**32 for mine in ours] == [theirs % 2**32 for theirs in cost]
        self.holds.require(
            agree or self.program.replaced,
            lambda: f"clingo reports the costs {list(cost)}, the units {sorted(units)} cost {ours}",
        )
        if not agree:
            self.heard.reporter.warning(
                f"{self.program.files[1]} does not measure what the objectives "
                f"{', '.join(self.levels)} measure here: the tree is optimal in its sense, and the costs "
                "shown are the usual ones"
            )
        return agree

    def _require_measures(self, agree: bool) -> None:
        """Raise :class:`UserError` if a replaced objectives.lp measures only some trees as we do."""
        if not agree:
            raise UserError(
                f"{self.program.files[1]} measures some trees as the objectives {', '.join(self.levels)} do, "
                "and others not: they cannot be compared"
            )

    def _bounds(self, lower: Sequence[int]) -> dict[Objective, int | Fraction]:
        """Turn clingo's lower bounds, highest priority first, into bounds on the objectives.

        Where it has none yet, no cost is below 0 and no success above 1. A bound on trees that are better
        than the one in hand is no bound beyond that one. What the cuts say of the first objective counts.
        Nothing is said of what comes after an objective that is rounded: rounded weights do not tell which
        trees it counts among.
        """
        bounds: dict[Objective, int | Fraction] = {}
        for objective, value in zip(self.levels, lower or [0], strict=False):
            scales = self._scales
            bounds[objective] = (
                scales.bound(objective, max(0, value)) if scales else int(multiplies(objective))
            )
            if scales and objective is scales.rounded:
                break
        reduced = self.first.reduced
        if reduced is None or reduced.costs is None:
            return bounds
        first, proved = self.levels[0], reduced.costs.first(reduced.bound)
        if multiplies(first):
            return {first: min(bounds[first], proved)}
        assert self.heard.best is not None
        _, best = self.heard.best
        bounds[first] = max(bounds[first], proved)
        for objective, bound in bounds.items():
            if not multiplies(objective):
                bounds[objective] = min(bound, best.measure(objective))
        return bounds if bounds[first] == best.measure(first) else {first: bounds[first]}

    def _report_bound(self, lower: Sequence[int]) -> None:
        for objective, bound in self._bounds(lower).items():
            self.heard.reporter.bound(objective, bound)

    def _outcome(
        self, status: Status, units: Units | None, bounds: dict[Objective, int | Fraction]
    ) -> Outcome:
        """State the outcome, once it holds."""
        first, reduced = self.first, self.first.reduced
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
        size = len(self.problem.network.objects)  # beyond are sets of units that rules ask for
        outcome = outcome._replace(
            units=self.holds.tree(units),
            costs=self.heard.costs(units),
            left=0 if proof is Proof.CUTS else len(first.units),
            cases=reduced.cases if reduced else None,
            cuts=tuple(tuple(sorted(objects)) for objects in _cuts(reduced) if max(objects) < size),
        )
        assert self.heard.best is not None
        self.holds.outcome(outcome, None if self.program.replaced else self.heard.best[1], reduced)
        first.require_kept(units)
        self._spent("check", began)
        return outcome

    def _spent(self, phase: str, began: float) -> None:
        self.seconds[phase] = self.seconds.get(phase, 0.0) + time.perf_counter() - began


def _cuts(reduced: Reduced | None) -> list[frozenset[int]]:
    """Give the cuts of the best bound, those that were found before anything was left out, and those between.

    What was left out may cross many of the first; of the second, all units count.
    """
    if reduced is None:
        return []
    best = _few_objects(reduced.cuts)
    if reduced.shared:
        best = [objects for objects, _ in reduced.shared.cuts]
    first = _few_objects(reduced.wide.cuts if reduced.wide else None)
    return [*dict.fromkeys([*best, *first, *reduced.tight])]


def _few_objects(cuts: Cuts | None) -> list[frozenset[int]]:
    """Return the objects of cuts, of the first ones only where they have very many together."""
    found, total = list[frozenset[int]](), 0
    for cut in cuts.cuts if cuts else ():
        if total > _MOST_CUT_OBJECTS:
            break
        found.append(cut.objects)
        total += len(found[-1])
    return found
