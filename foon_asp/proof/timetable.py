"""Check of a schedule by simulating it in time, in plain Python and independent of the scheduler."""

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from typing import NamedTuple

from foon_asp.network import Contents, FunctionalUnit, ObjectNode
from foon_asp.problem import Problem
from foon_asp.proof.execution import Executions
from foon_asp.text.tables import Duration

ToolName = str | ObjectNode
"""What tools are counted by: a label, or one that the kitchen has with something in it."""


class Tool(NamedTuple):
    """One tool or vessel: the ``number``-th (from 1) of a ``name``, which is a label or an object node."""

    name: ToolName
    number: int

    def __str__(self) -> str:
        return f"{self.name} {self.number}"

    @property
    def label(self) -> str:
        """The label of its object nodes."""
        return self.name if isinstance(self.name, str) else self.name.label


class TimedStep(NamedTuple):
    """A scheduled step: its times, its agent and its tools.

    ``start`` and ``end`` are in seconds. ``agent`` is a number from 1, ``None`` where nobody has to stand by.
    ``tools`` are used only by this step while it runs; they are in the order of the unit's objects.
    """

    start: Fraction
    end: Fraction
    agent: int | None
    tools: tuple[Tool, ...]


class Means(NamedTuple):
    """The resources of a schedule.

    ``durations`` are those of motions. ``tools`` maps tools to their number, ``None`` for an unlimited
    number. There is one of each utensil that ``tools`` omits.
    """

    durations: Mapping[str, Duration]
    agents: int
    tools: Mapping[ToolName, int | None]

    def is_limited(self, problem: Problem, label: str) -> bool:
        """Return whether a step may have to wait for objects of a label, as tools in limited number."""
        if label in self.tools:
            return self.tools[label] is not None
        named = any(isinstance(name, ObjectNode) and name.label == label for name in self.tools)
        return named or label in problem.utensils

    def is_unlimited(self, label: str) -> bool:
        """Return whether several steps can share one object of a label at the same time."""
        return label in self.tools and self.tools[label] is None

    def counted_name(self, node: ObjectNode, label: str) -> ToolName:
        """Return the name under which a tool is counted.

        ``label`` is the label of the tool, and ``node`` is the tool or an object in it. The name is the node
        or the label if ``tools`` lists it. Otherwise, a tool with contents is named by its contents.
        """
        if node in self.tools:
            return node
        inside = node.ingredients if node.label == label else (node.label,)
        if label in self.tools or not inside:
            return label
        return ObjectNode.of(label, (), (), [Contents("contains", tuple(sorted({*inside})))])

    def number_of(self, problem: Problem, name: ToolName) -> int:
        """Return the number of tools of a name: as in ``tools``, else as in the stock, else 1."""
        stated = self.tools.get(name)
        if stated is not None:
            return stated
        stock = {} if problem.items is None else problem.items.stock
        return max(1, sum(n for node, n in stock.items() if self.counted_name(node, node.label) == name))


class ToolNeed(NamedTuple):
    """The tools of one label that a unit needs.

    ``kept`` are inputs that stay as they are, ``changed`` inputs that change, and ``made`` are the outputs.
    ``others`` are tools that are no preconditions: skipped containers, the contents of a tool that the unit
    does not list, or ``None`` for a tool that something is put in, on or by.
    """

    kept: tuple[ObjectNode, ...]
    changed: tuple[ObjectNode, ...]
    made: tuple[ObjectNode, ...]
    others: tuple[ObjectNode | None, ...]

    @property
    def number(self) -> int:
        """The number of the tools."""
        return len(self.kept) + max(len(self.changed) + len(self.others), len(self.made))


def tools_needed(problem: Problem, means: Means, unit: FunctionalUnit) -> dict[str, ToolNeed]:
    """Return the tools that a unit needs, by label.

    They are its utensils, and the tools that its objects are in, on or at.
    """
    needed, _, made = Executions(problem).of(unit)
    needs: dict[str, ToolNeed] = {}
    nodes = (*dict.fromkeys(unit.inputs), *unit.outputs)
    around = (relation.object for node in nodes for relation in node.relations)
    for label in dict.fromkeys([*(node.label for node in nodes), *around]):
        if not means.is_limited(problem, label):
            continue
        own = [node for node in dict.fromkeys(unit.inputs) if node.label == label]
        kept = tuple(node for node in own if node in needed and node in unit.outputs)
        changed = tuple(node for node in own if node in needed and node not in unit.outputs)
        out = tuple(node for node in made if node.label == label)
        others: list[ObjectNode | None] = [node for node in own if node not in needed]
        if not own and not out:
            inside = sorted((node for node in needed if node.is_in(label)), key=problem.at_hand)
            others.append(next(iter(inside), None))  # preferably one that was made: it is known where
        needs[label] = ToolNeed(kept, changed, out, tuple(others))
    return needs


def timetable_fault(
    problem: Problem, plan: Sequence[FunctionalUnit], steps: Sequence[TimedStep], means: Means
) -> str | None:
    """Return the first fault of a schedule of a plan in words; ``None`` without one.

    At each moment, there have to be enough copies for all running steps, and each agent and each tool may be
    at only one step. A tool has to be in the state in which an earlier step left it, or as the kitchen has
    it. Items of the problem have to be used up (:func:`foon_asp.proof.replay.replayable`).
    """
    if len(steps) != len(plan):
        return f"there are {len(plan)} steps, and times for {len(steps)}"
    for number, (unit, step) in enumerate(zip(plan, steps, strict=True), 1):
        duration = means.durations[unit.motion]
        if step.start < 0 or step.end - step.start != duration.seconds:
            return f"step {number} does not take the time that {unit.motion} takes"
        if (step.agent is None) != duration.passive:
            return f"step {number} is done by nobody, or by somebody where nobody has to"
        if step.agent is not None and not 1 <= step.agent <= means.agents:
            return f"step {number} is done by agent {step.agent}, and there are {means.agents}"
    return _Run(problem, plan, steps, means).fault()


class _Run:
    """The state of the kitchen while steps start and end."""

    def __init__(
        self, problem: Problem, plan: Sequence[FunctionalUnit], steps: Sequence[TimedStep], means: Means
    ) -> None:
        assert problem.items is not None
        self._problem, self._executions, self._means = problem, Executions(problem), means
        self._plan, self._steps = plan, steps
        self._copies = self._executions.initial_copies()
        self._copies_read: Counter[ObjectNode] = Counter()
        self._step_using: dict[int | Tool, int] = {}  # who and what is at a step
        self._states: dict[Tool, frozenset[ObjectNode]] = {}

    def fault(self) -> str | None:
        """Return the first fault of the schedule in words; ``None`` without one.

        At the same time, ends of steps come before starts of steps.
        """
        events = [(step.end, False, number) for number, step in enumerate(self._steps)]
        events += [(step.start, True, number) for number, step in enumerate(self._steps)]
        for _, starts, number in sorted(events):
            if not starts:
                self._end_step(number)
            elif fault := next(self._start_step(number), None):
                return f"step {number + 1} ({self._plan[number].motion}) {fault}"
        return None

    def _start_step(self, number: int) -> Iterator[str]:
        """Start a step; yield each reason why it cannot."""
        unit, step = self._plan[number], self._steps[number]
        resources = _resources_of(step)
        if len(set(resources)) < len(resources):
            yield "has the same tool twice"
        for resource in resources:
            if resource in self._step_using:
                yield f"waits for {resource}, which is at step {self._step_using[resource] + 1}"
        yield from self._tool_faults(unit, step.tools)
        needed, consumes, _ = self._executions.of(unit)
        for node, amount in needed.items():
            if self._executions.is_endless(node):
                continue
            goes = consumes.get(node, 0)
            in_use = 0 if self._means.is_unlimited(node.label) and not goes else self._copies_read[node]
            if self._copies[node] < in_use + amount:
                yield f"lacks a copy of {node}"
            self._copies[node] -= goes
            self._copies_read[node] += amount - goes
        self._step_using.update(dict.fromkeys(resources, number))

    def _end_step(self, number: int) -> None:
        """End a step: add its outputs, and release its tools and its agent."""
        unit, step = self._plan[number], self._steps[number]
        needed, consumes, made = self._executions.of(unit)
        for node, amount in needed.items():
            self._copies_read[node] -= amount - consumes.get(
                node, 0
            )  # of what is endless, nobody asks for this
        self._copies.update(made)
        for tool in step.tools:
            # what of it is at other tools, nobody asks this one for
            self._states[tool] = self._states.get(tool, frozenset()).difference(consumes).union(made)
        for resource in _resources_of(step):
            self._step_using.pop(resource, None)

    def _tool_faults(self, unit: FunctionalUnit, tools: Sequence[Tool]) -> Iterator[str]:
        """Yield each fault of the tools with which a step starts."""
        problem, means = self._problem, self._means
        needs, needed = tools_needed(problem, means, unit), self._executions.of(unit).preconditions
        brought = Counter(tool.label for tool in tools)
        for label in needs.keys() | brought.keys():
            wanted = needs[label].number if label in needs else 0
            if brought[label] != wanted:
                yield f"has {brought[label]} of {label}, and asks for {wanted}"
        for tool in tools:
            if not 1 <= tool.number <= means.number_of(problem, tool.name):
                yield f"has {tool}, and there are {means.number_of(problem, tool.name)}"
        for label, need in needs.items():
            brought_tools = [tool for tool in tools if tool.label == label]
            held_nodes = {node for tool in brought_tools for node in self._states.get(tool, ())}
            wanted_nodes = {node for node in (*need.kept, *need.changed, *need.others) if node is not None}
            for node in wanted_nodes - held_nodes:
                fetched = problem.at_hand(node) and means.counted_name(node, label) in {
                    tool.name for tool in brought_tools
                }
                if not fetched and node in needed:
                    yield f"has no {label} for {node}"
            for tool in brought_tools:  # what is fetched is as the kitchen has it, whatever it was before
                if wanted_nodes and wanted_nodes.isdisjoint(self._states.get(tool, ())):
                    self._states[tool] = frozenset()


def _resources_of(step: TimedStep) -> list[int | Tool]:
    """Return the resources that a step occupies: its tools, and its agent as a number."""
    return [*step.tools] + ([] if step.agent is None else [step.agent])
