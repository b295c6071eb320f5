"""Orders for given counts of executions, as runs that repeat one action each.

Whether each action can be executed as often as counted is a question about firing sequences of a Petri net. A
run executes an action as often as possible. If a run leaves enough copies for all executions that wait, the
search tries no other run.
"""

from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence

from foon_asp.plans.conditions import Counts
from foon_asp.plans.flows import Flows
from foon_asp.plans.tuning import PLANS
from foon_asp.plans.whole_program import Stopped

Run = tuple[int, int]
"""An action, and how often it is executed in a row."""


def bulk_order(
    flows: Flows, counts: Counts, start: Mapping[int, int], expired: Callable[[], bool]
) -> list[Run] | None:
    """Return runs that execute each action as often as counted; ``None`` if there is no such order.

    ``start`` has the initial copies by object. ``expired`` returns whether time is up. Runs as long as
    possible are tried first. If they have no order, and there are few executions, single executions are
    tried. Raises :class:`Stopped` if no order is found, but it is not proved that no order exists.
    """
    if not _may_have_order(flows, counts, start):
        return None
    runs = _OrderSearch(flows, counts, start, expired, single=False).find_runs()
    if runs is None and sum(counts.values()) <= PLANS.single_executions:
        search = _OrderSearch(flows, counts, start, expired, single=True)
        runs = search.find_runs()
        if runs is None and search.is_exhausted:
            return None
    if runs is None:
        raise Stopped
    return runs


def least_copies(flows: Flows, counts: Counts) -> dict[int, int]:
    """Return how many initial copies of each object in ``flows.start`` are needed at least in every order."""
    change = Counter({o: -n for o, n in flows.targets.items()})
    required = Counter[int]()
    for action, times in counts.items():
        for o, n in flows.asks[action].items():
            made_before = sum(flows.adds[a].get(o, 0) * counts[a] for a in counts if a != action)
            required[o] = max(required[o], n - made_before)
        for o, n in flows.uses[action].items():
            change[o] -= n * times
        for o, n in flows.adds[action].items():
            change[o] += n * times
    return {o: max(0, -change[o], required[o]) for o in flows.start}


def _may_have_order(flows: Flows, counts: Counts, start: Mapping[int, int]) -> bool:
    """Return whether counts satisfy two conditions that every order needs.

    If nothing is consumed, each action can be executed. After all executions, no object has fewer than 0
    copies, and each target has the copies wanted.
    """
    copies, waiting = Counter(start), set(counts)
    grown = True
    while grown:
        ready = [a for a in waiting if all(copies[o] >= n for o, n in flows.asks[a].items())]
        grown = bool(ready)
        waiting.difference_update(ready)
        for action in ready:
            for o, n in flows.adds[action].items():
                copies[o] += n * counts[action]
    for action, times in counts.items():
        for o, n in flows.uses[action].items():
            copies[o] -= n * times
    if waiting or any(n < 0 for n in copies.values()):
        return False
    return all(copies[o] >= n for o, n in flows.targets.items())


class _OrderSearch:
    """A depth-first search for an order of executions.

    ``single``: whether to branch over single executions, in place of runs.
    ``start``: the initial copies by object.
    """

    def __init__(
        self,
        flows: Flows,
        counts: Counts,
        start: Mapping[int, int],
        expired: Callable[[], bool],
        single: bool,
    ) -> None:
        """Begin with all executions waiting, and count the copies that they consume."""
        self._flows, self._expired, self._single = flows, expired, single
        self._copies, self._waiting = Counter(start), dict(counts)
        self._steps_left = PLANS.order_steps
        # the copies that all waiting executions consume
        self._consumed = Counter[int]()
        for action, times in counts.items():
            for o, n in flows.uses[action].items():
                self._consumed[o] += n * times

    @property
    def is_exhausted(self) -> bool:
        """Whether the search ended because it had tried all orders, and not for lack of steps or time."""
        return self._steps_left > 0

    def find_runs(self) -> list[Run] | None:
        """Return the runs of an order; ``None`` if none is found (:attr:`is_exhausted` says why)."""
        done: list[Run] = []
        dead: set[tuple[tuple[int, int], ...]] = set()  # waiting executions without an order
        choices = [self._choices(dead)]
        while choices:
            if not self._waiting:
                return done
            run = next(choices[-1], None)
            if run is not None:
                self._execute(run, 1)
                done.append(run)
                choices.append(self._choices(dead))
                continue
            if self._steps_left <= 0:
                return None
            dead.add(self._waiting_counts)
            choices.pop()
            if done:
                self._execute(done.pop(), -1)
        return None

    @property
    def _waiting_counts(self) -> tuple[tuple[int, int], ...]:
        """The executions that wait, as pairs of action and count, ascending."""
        return tuple(sorted(self._waiting.items()))

    def _choices(self, dead: set[tuple[tuple[int, int], ...]]) -> Iterator[Run]:
        """Yield the runs to try next.

        A run is as long as possible. If a run leaves enough copies for all waiting executions, it is the only
        one. Otherwise, with ``single``, each run has one execution. If the waiting executions are in
        ``dead``, they have no order, and nothing is yielded.
        """
        if self._waiting_counts in dead:
            return
        ready_runs = [(action, self._max_times(action)) for action in sorted(self._waiting)]
        ready_runs = [(action, max_times) for action, max_times in ready_runs if max_times]
        free_runs = [(action, max_times) for action, max_times in ready_runs if self._is_free(action)]
        for action, max_times in free_runs[:1] or sorted(
            ready_runs, key=lambda run: len(self._flows.uses[run[0]])
        ):
            for times in (max_times,) if free_runs or not self._single else (1,):
                self._steps_left -= 1
                if self._steps_left <= 0 or self._expired():
                    self._steps_left = 0
                    return
                yield action, times

    def _max_times(self, action: int) -> int:
        """Return how often a waiting action can be executed in a row now; 0 if not at all."""
        max_times, flows = self._waiting[action], self._flows
        for o, n in flows.asks[action].items():
            surplus = self._copies[o] - n
            if surplus < 0:
                return 0
            loss = flows.uses[action].get(o, 0) - flows.adds[action].get(o, 0)
            if loss > 0:
                max_times = min(max_times, surplus // loss + 1)
        return max_times

    def _is_free(self, action: int) -> bool:
        """Return whether all waiting executions have enough copies of the objects that an action consumes."""
        return all(
            self._copies[o] - self._consumed[o] >= self._copies_to_keep(o) for o in self._flows.uses[action]
        )

    def _copies_to_keep(self, o: int) -> int:
        """Return how many copies of an object have to remain after all waiting executions.

        This is the greater of two numbers: the copies of the target, and the most copies that one waiting
        execution needs and does not consume.
        """
        readers = (self._flows.asks[a].get(o, 0) - self._flows.uses[a].get(o, 0) for a in self._waiting)
        return max(self._flows.targets.get(o, 0), *readers)

    def _execute(self, run: Run, sign: int) -> None:
        """Execute a run on copies and waiting executions, or undo it with a ``sign`` of -1."""
        action, times = run
        for o, n in self._flows.uses[action].items():
            self._copies[o] -= sign * n * times
            self._consumed[o] -= sign * n * times
        for o, n in self._flows.adds[action].items():
            self._copies[o] += sign * n * times
        unexecuted = self._waiting.get(action, 0) - sign * times
        if unexecuted:
            self._waiting[action] = unexecuted
        else:
            del self._waiting[action]


def plan_of(units: Sequence[int], runs: Sequence[Run]) -> tuple[int, ...]:
    """Return the units of a sequence of runs, in order, with repeats; action ``a`` is ``units[a]``."""
    return tuple(unit for action, times in runs for unit in (units[action],) * times)
