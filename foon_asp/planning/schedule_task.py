"""A plan as a scheduling task: how long its steps take, what they wait for, and which tools they hold."""

from collections.abc import Iterable, Sequence
from fractions import Fraction
from math import lcm
from typing import NamedTuple

from foon_asp.errors import UserError
from foon_asp.network import FunctionalUnit, ObjectNode
from foon_asp.problem import Problem
from foon_asp.proof.replay import Copy, Replay, readers, waits
from foon_asp.proof.timetable import Means, ToolName, tools_asked

_LONGEST = 10**12  # ticks of a whole plan: CP-SAT's numbers are not without end


class Use(NamedTuple):
    """A tool that is fetched from the kitchen and then in use: ``steps`` take it, one at a time.

    It is not there for others from the start of the first of them to the end of the last, for it is in a
    state that a later one needs.
    """

    name: ToolName
    steps: tuple[int, ...]


class ScheduleTask(NamedTuple):
    """Steps by position: ``lengths`` in ticks of ``tick`` seconds, and which are ``passive``.

    ``after`` are the steps that each waits for. ``uses`` are all uses of tools, and ``counts`` says how many
    there are of each. ``at_step`` are the uses that each step is part of. ``sharing`` are sets of steps that
    need one copy of something, and have it one after the other.
    """

    tick: Fraction
    lengths: tuple[int, ...]
    passive: tuple[bool, ...]
    after: tuple[frozenset[int], ...]
    uses: tuple[Use, ...]
    counts: dict[ToolName, int]
    agents: int
    sharing: tuple[tuple[int, ...], ...] = ()

    @property
    def at_step(self) -> list[list[int]]:
        """The uses that each step is part of, in order."""
        found: list[list[int]] = [[] for _ in self.lengths]
        for use, (_, steps) in enumerate(self.uses):
            for step in steps:
                found[step].append(use)
        return found

    @property
    def bound(self) -> int:
        """A time, in ticks, that no schedule stays below: that of the longest chain, and of all work."""
        ready: list[int] = []
        for length, after in zip(self.lengths, self.after, strict=True):
            ready.append(length + max((ready[step] for step in after), default=0))
        work = sum(n for n, passive in zip(self.lengths, self.passive, strict=True) if not passive)
        return max([*ready, -(-work // self.agents)])


def schedule_task(
    problem: Problem, plan: Sequence[FunctionalUnit], replay: Replay, means: Means
) -> ScheduleTask:
    """Make the task of a plan that runs, as it was replayed: which step takes which copy stays as it is.

    Raises :class:`UserError` for durations that are too fine for their sum.
    """
    seconds = [Fraction(means.durations[unit.motion].seconds) for unit in plan]
    parts = lcm(*(each.denominator for each in seconds))
    lengths = tuple(int(each * parts) for each in seconds)
    if sum(lengths) > _LONGEST:
        raise UserError("the durations are too fine for so long a plan: round them")
    uses = _uses(problem, replay, means)
    return ScheduleTask(
        Fraction(1, parts),
        lengths,
        tuple(means.durations[unit.motion].passive for unit in plan),
        tuple(map(frozenset, waits(replay))),
        uses,
        {use.name: means.number_of(problem, use.name) for use in uses},
        means.agents,
        tuple(readers(replay, means.is_free)),
    )


def _uses(problem: Problem, replay: Replay, means: Means) -> tuple[Use, ...]:
    """Follow each tool from step to step by the copies that are made of it, and of what is in it."""
    names: list[ToolName] = []
    steps: list[list[int]] = []
    known: dict[tuple[Copy, str], int] = {}  # the use of a label that a made copy belongs to

    def take(number: int, label: str, node: ObjectNode | None, copy: Copy | None) -> int:
        """Let a step take a tool: one that is in use, or another from the kitchen."""
        use = None if copy is None else known.get((copy, label))
        if use is None or number in steps[use]:
            names.append(label if node is None or not problem.at_hand(node) else means.name(node, label))
            steps.append([])
            use = len(names) - 1
        steps[use].append(number)
        return use

    for number, step in enumerate(replay.steps):
        copies = {copy.node: copy for copy in (*step.gone, *step.stayed)}
        for label, asked in tools_asked(problem, means, step.unit).items():
            here = {node: take(number, label, node, copies.get(node)) for node in asked.kept}
            left = {
                node: take(number, label, node, None if node is None else copies.get(node))
                for node in (*asked.changed, *asked.others)
            }
            last = next(iter((left or here).values()), None)
            for made in asked.made:
                here[made] = left.pop(_most_alike(left, made)) if left else take(number, label, None, None)
                known[Copy(made, number), label] = here[made]
            for copy in step.came:
                if copy.node.label != label and copy.node.is_in(label):
                    vessels = (use for node, use in here.items() if copy.node.label in node.ingredients)
                    use = next(vessels, next(iter(here.values()), last))
                    if use is not None:
                        known[copy, label] = use
    return tuple(Use(name, tuple(which)) for name, which in zip(names, steps, strict=True))


def _most_alike(before: Iterable[ObjectNode | None], after: ObjectNode) -> ObjectNode | None:
    """Give what has most in common with what is in a vessel afterwards, the first of several."""
    return max(
        before, key=lambda node: 0 if node is None else len({*node.ingredients} & {*after.ingredients})
    )
