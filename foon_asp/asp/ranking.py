"""Trees in order of their costs, one by one, none of which holds another."""

from collections.abc import Iterator, Sequence
from fractions import Fraction

from foon_asp.asp.exact_success import RateScale, problem_scale
from foon_asp.asp.facts import write_avoided, write_facts, write_objectives
from foon_asp.asp.own_encodings import question_encoding
from foon_asp.asp.postconditions import Postconditions
from foon_asp.asp.program import Settings, assemble
from foon_asp.asp.search import run
from foon_asp.asp.solver import Reporter
from foon_asp.errors import UserError
from foon_asp.grounding.run import Run
from foon_asp.problem import Costs, Objective, Problem, levels, multiplies, reach, relevant

Rounded = tuple[int, ...]  # costs as clingo adds them up: success in rounded logarithms


class Ranked:
    """The trees of a question from the best on, under a lexicographic list of objectives.

    A tree that holds all the units of one before it, and others to spare, is not among them. Iterate to get
    each tree as unit ids in an executable order, with its costs. ``complete`` says afterwards that there are
    no others; it is false where a limit came first, or ctrl-C. Then ``known`` has, in order, the trees that
    were found beyond those given, and before which others may come. Raises :class:`UserError` like
    :func:`foon_asp.asp.solve`.
    """

    def __init__(
        self,
        problem: Problem,
        objectives: Sequence[Objective],
        settings: Settings,
        reporter: Reporter | None = None,
    ) -> None:
        self.problem = problem
        self.levels = levels(tuple(objectives))
        self.complete = False
        self.known: list[tuple[tuple[int, ...], Costs]] = []
        self._deadline = settings.begun
        self._program = assemble(settings, (reporter or Reporter()).warning)
        self._holds = Postconditions(problem, self.levels, settings, self._program.own)
        self._given: tuple[int | Fraction, ...] = ()  # what the tree given last costs
        self._scale: RateScale | None = None
        if Objective.SUCCESS in self.levels and problem.rates is None:
            raise UserError(
                "the objective success needs the success rates of the motions; give a rates file with --rates"
            )
        self._units: tuple[int, ...] = ()
        try:
            with self._deadline.watched("cutting the network"):
                self._cut(problem)
        except KeyboardInterrupt:
            self._deadline.interrupt()

    def _cut(self, problem: Problem) -> None:
        reached = reach(problem)
        if all(reached.available[goal] for goal in problem.goals):
            own = self._program.own
            self._units = relevant(problem, reached) if own else tuple(sorted(reached.units))
            if problem.rates is not None:
                self._scale = problem_scale(problem, self._units)
        else:
            self.complete = True

    def __iter__(self) -> Iterator[tuple[tuple[int, ...], Costs]]:
        """Give tree after tree.

        clingo gives them in the order of rounded costs. A tree is given out when no tree that clingo may
        still find can come before it: where rates multiply, one whose weight is higher by no more than there
        are units whose rates were rounded may (docs/exact-success.md).
        """
        if self.complete:
            return
        found: list[tuple[Costs, Rounded, tuple[int, ...]]] = []
        known: list[frozenset[int]] = []
        last: Rounded = ()
        avoided = ""
        number = 0
        while True:
            ended = self._next(avoided)
            if ended.units is None and ended.exhausted:
                break
            units = () if ended.units is None else self._in_order(ended.units)
            costs = self.problem.costs(units)
            rounded = self._rounded(units, costs)
            if not ended.exhausted:
                if ended.units is not None:
                    found.append((costs, rounded, units))
                found.sort(key=lambda each: (each[0].key(self.levels), sorted(each[2])))
                self.known = [(tree, its) for its, _, tree in found]
                return
            self._check(ended, rounded, last, units, known)
            last = rounded
            known.append(frozenset(units))
            while found and self._is_settled(found[0], rounded):
                yield self._next_in_order(found)
            found.append((costs, rounded, units))
            found.sort(key=lambda each: (each[0].key(self.levels), sorted(each[2])))
            avoided += write_avoided(number, map(self.problem.network.unit_number, units))
            number += 1
            if not units:  # every other tree holds it
                break
        self.complete = True
        while found:
            yield self._next_in_order(found)

    def _next(self, avoided: str) -> Run:
        if self._deadline.passed:
            return Run()
        try:
            with self._deadline.watched("writing facts"):
                facts = write_facts(
                    self.problem, self._units, self._scale, with_sources=not self._program.own
                )
        except KeyboardInterrupt:
            self._deadline.interrupt()
            return Run()
        files = (*self._program.files, question_encoding("other_trees.lp"))
        return run(
            files,
            facts + self._program.rules + write_objectives(self.levels) + avoided,
            self._program.arguments,
            self._deadline,
            endless=self._program.endless,
        )

    def _in_order(self, numbers: frozenset[int]) -> tuple[int, ...]:
        network = self.problem.network
        units = [network.unit_of_number(number) for number in sorted(numbers)]
        known = [unit for unit in units if unit is not None]
        if len(known) < len(units):
            raise UserError("a tree was found with units that the network has not: check the encodings")
        return self._holds.tree(known)

    def _check(
        self,
        ended: Run,
        rounded: Rounded,
        last: Rounded,
        units: Sequence[int],
        known: Sequence[frozenset[int]],
    ) -> None:
        """Require that clingo measures a tree as we do, after the one before it, and that it holds none.

        Raises :class:`UserError` where other encodings measure something else: then its order is not ours.
        """
        agree = len(rounded) == len(ended.cost) and all(
            (ours - theirs) % 2**32 == 0 for ours, theirs in zip(rounded, ended.cost, strict=True)
        )
        if not (agree and last <= rounded) and self._program.replaced:
            raise UserError(
                f"{self._program.files[1]} does not measure what the objectives {', '.join(self.levels)} "
                "measure here, so trees cannot be put in their order"
            )
        self._holds.require(
            agree, lambda: f"clingo reports the costs {list(ended.cost)}, the units {units} cost {rounded}"
        )
        self._holds.require(
            last <= rounded, lambda: f"the tree {units} costs {rounded}, but comes after one for {last}"
        )
        self._holds.require(
            not any(map(frozenset(units).issuperset, known)),
            lambda: f"the tree {units} holds one that was found before",
        )

    def _next_in_order(
        self, found: list[tuple[Costs, Rounded, tuple[int, ...]]]
    ) -> tuple[tuple[int, ...], Costs]:
        """Take the first of the trees found, which is no better than those given before."""
        costs, _, units = found.pop(0)
        key = costs.key(self.levels)
        self._holds.require(
            self._given <= key, lambda: f"the tree {units} is better than one that was given before it"
        )
        self._given = key
        return units, costs

    def _rounded(self, units: Sequence[int], costs: Costs) -> Rounded:
        return tuple(
            sum(self._weight(unit) for unit in units)
            if multiplies(objective)
            else int(costs.measure(objective))
            for objective in self.levels
        )

    def _is_settled(self, tree: tuple[Costs, Rounded, tuple[int, ...]], last: Rounded) -> bool:
        """Whether all trees from these rounded costs on come after a tree, or are as good as it."""
        if Objective.SUCCESS not in self.levels:
            return True
        place = self.levels.index(Objective.SUCCESS)
        _, rounded, units = tree
        if last[:place] > rounded[:place]:
            return True
        doubt = sum(self.problem.rate(unit) != 1 for unit in units)  # also those that weigh 0
        return last[place] > rounded[place] + doubt

    def _weight(self, unit: int) -> int:
        if self._scale is None:
            return 0
        return self._scale.weights[self.problem.rate(unit)]
