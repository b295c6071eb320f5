"""A plan as a scheduling task: durations of steps, precedences, and the tools that steps occupy."""

from collections.abc import Iterable, Sequence
from fractions import Fraction
from math import lcm
from typing import NamedTuple

from foon_asp.errors import UserError
from foon_asp.network import FunctionalUnit, ObjectNode
from foon_asp.problem import Problem
from foon_asp.proof.replay import Copy, Replay, predecessors, shared_readers
from foon_asp.proof.timetable import ScheduleResources, ToolName, tools_needed


class Use(NamedTuple):
    """The use of one copy of a tool by some steps of a plan, which do not overlap.

    ``steps`` are positions in the plan, from 0. The copy is occupied from the start of the first step to the
    end of the last step. For each later step needs the tool in the state in which an earlier step left it.
    """

    name: ToolName
    steps: tuple[int, ...]


class ScheduleTask(NamedTuple):
    """A resource-constrained scheduling problem over the steps of a plan, given by position from 0.

    ``tick``: the length of a tick in seconds.
    ``lengths``: the durations of the steps in ticks.
    ``passive``: for each step, whether it occupies no agent.
    ``after``: for each step, the steps that it waits for.
    ``uses``: all uses of tools.
    ``counts``: the number of copies of each tool that has a use.
    ``agents``: the number of agents.
    ``sharing``: sets of steps that need the same copy of an item, so that they must not overlap.
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
        """For each step, the positions in ``uses`` of the uses that have the step."""
        uses_of: list[list[int]] = [[] for _ in self.lengths]
        for use, (_, steps) in enumerate(self.uses):
            for step in steps:
                uses_of[step].append(use)
        return uses_of

    @property
    def bound(self) -> int:
        """A lower bound on the makespan, in ticks.

        It is the critical path or the work divided among the agents, whichever is greater.
        """
        ready: list[int] = []
        for length, after in zip(self.lengths, self.after, strict=True):
            ready.append(length + max((ready[step] for step in after), default=0))
        work = sum(n for n, passive in zip(self.lengths, self.passive, strict=True) if not passive)
        return max([*ready, -(-work // self.agents)])


def schedule_task(
    problem: Problem, plan: Sequence[FunctionalUnit], replay: Replay, resources: ScheduleResources
) -> ScheduleTask:
    """Return the scheduling task of an executable plan.

    A tick is the longest fraction 1/n of a second of which all durations are multiples. ``replay`` says which
    copy of an item each step takes. ``resources`` are the durations of all motions of the plan, the agents
    and the tools. Raises :class:`UserError` if the durations have too many digits to be added up in ticks.
    """
    seconds = [Fraction(resources.durations[unit.motion].seconds) for unit in plan]
    ticks_per_second = lcm(*(duration.denominator for duration in seconds))
    lengths = tuple(int(duration * ticks_per_second) for duration in seconds)
    if sum(lengths) > 10**12:  # CP-SAT's integers have 64 bits
        raise UserError("the durations are too fine for so long a plan: round them")
    uses = _uses(problem, replay, resources)
    return ScheduleTask(
        Fraction(1, ticks_per_second),
        lengths,
        tuple(resources.durations[unit.motion].passive for unit in plan),
        tuple(map(frozenset, predecessors(replay))),
        uses,
        {use.name: resources.number_of(problem, use.name) for use in uses},
        resources.agents,
        tuple(shared_readers(replay, resources.is_unlimited)),
    )


def _uses(problem: Problem, replay: Replay, resources: ScheduleResources) -> tuple[Use, ...]:
    """Return the uses of tools in a plan.

    The steps of a use make copies of the tool, and of items in it. A later step that takes such a copy
    belongs to the same use. Any other step that needs the tool begins a new use. If a step needs several
    copies of a tool, it belongs to several uses.
    """
    names: list[ToolName] = []
    steps: list[list[int]] = []
    use_of: dict[tuple[Copy, str], int] = {}  # the use of a tool with this label that a made copy belongs to

    def assign(number: int, label: str, node: ObjectNode | None, copy: Copy | None) -> int:
        """Add a step to the use that ``copy`` belongs to, or to a new use; return the position of the use.

        The use is new if ``copy`` belongs to no use, or to one that has the step already. ``label`` is the
        label of the tool. ``node`` is the tool's node before the step, if that is known. The name of a new
        use is ``label`` or, for a ``node`` in the kitchen, the name under which ``node`` is counted.
        """
        use = None if copy is None else use_of.get((copy, label))
        if use is None or number in steps[use]:
            names.append(
                label if node is None or not problem.at_hand(node) else resources.counted_name(node, label)
            )
            steps.append([])
            use = len(names) - 1
        steps[use].append(number)
        return use

    for number, step in enumerate(replay.steps):
        copies = {copy.node: copy for copy in (*step.gone, *step.stayed)}
        for label, demand in tools_needed(problem, resources, step.unit).items():
            use_of_output = {node: assign(number, label, node, copies.get(node)) for node in demand.kept}
            use_of_input = {
                node: assign(number, label, node, None if node is None else copies.get(node))
                for node in (*demand.changed, *demand.others)
            }
            fallback = next(iter((use_of_input or use_of_output).values()), None)
            for output in demand.made:
                if use_of_input:
                    use_of_output[output] = use_of_input.pop(_most_similar(use_of_input, output))
                else:
                    use_of_output[output] = assign(number, label, None, None)
                use_of[Copy(output, number), label] = use_of_output[output]
            for copy in step.came:
                if copy.node.label != label and copy.node.is_in(label):
                    uses_with_copy = (
                        use for node, use in use_of_output.items() if copy.node.label in node.ingredients
                    )
                    use = next(uses_with_copy, next(iter(use_of_output.values()), fallback))
                    if use is not None:
                        use_of[copy, label] = use
    return tuple(Use(name, tuple(positions)) for name, positions in zip(names, steps, strict=True))


def _most_similar(before: Iterable[ObjectNode | None], after: ObjectNode) -> ObjectNode | None:
    """Return the node of ``before`` that shares the most ingredients with ``after``; the first in a tie."""
    return max(
        before, key=lambda node: 0 if node is None else len({*node.ingredients} & {*after.ingredients})
    )
