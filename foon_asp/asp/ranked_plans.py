"""Plans in which items are used up in order of their costs, one by one; none holds another."""

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence

from foon_asp.asp.outcome import Status
from foon_asp.asp.reporter import Reporter
from foon_asp.asp.settings import Bounded, Settings
from foon_asp.asp.used_up import Plan, solve_used_up
from foon_asp.problem import Costs, Objective, Problem


class RankedPlans:
    """The plans of a question, the best first, under a lexicographic list of objectives.

    Plans with at least the executions of an earlier one are excluded. ``complete`` and ``pending`` are as in
    :class:`foon_asp.asp.ranking.Ranked`, which ranks trees.
    """

    def __init__(
        self, problem: Problem, objectives: Sequence[Objective], settings: Settings, reporter: Reporter
    ) -> None:
        self._problem, self._objectives = problem, tuple(objectives)
        self._settings, self._reporter = settings._replace(deadline=settings.begun), reporter
        self.complete = False
        self.pending: list[tuple[Plan, Costs]] = []

    def __iter__(self) -> Iterator[tuple[Plan, Costs]]:
        """Iterate over plans, each proved best among the plans that contain no earlier one."""
        yielded: list[Mapping[int, int]] = []
        while True:
            settings = self._settings._replace(bounded=Bounded(incomparable=tuple(yielded)))
            reporter = Reporter() if yielded else self._reporter
            outcome = solve_used_up(self._problem, self._objectives, settings, reporter)
            plan, costs = outcome.units, outcome.costs
            if plan is None or costs is None or outcome.status is not Status.OPTIMAL:
                self.complete = outcome.status is Status.INFEASIBLE
                self.pending = [] if plan is None or costs is None else [(plan, costs)]
                return
            yield plan, costs
            if not plan:  # every other plan contains it
                self.complete = True
                return
            yielded.append(Counter(plan))
