"""Check of a schedule by simulating it in time, in plain Python and without the scheduler's code."""

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from typing import NamedTuple

from foon_asp.network import Contents, FunctionalUnit, ObjectNode
from foon_asp.problem import Problem
from foon_asp.proof.execution import Executions
from foon_asp.text.tables import Duration

ToolName = str | ObjectNode
"""The name under which tools are counted: a label, or an object node for a tool with contents."""


class Tool(NamedTuple):
    """One tool or vessel: the ``number``-th, from 1, that is counted under ``name``.

    ``name`` is a label, or an object node for a tool that the kitchen has with contents.
    """

    name: ToolName
    number: int

    def __str__(self) -> str:
        """Return the name and the number, such as ``bowl 2``."""
        return f"{self.name} {self.number}"

    @property
    def label(self) -> str:
        """The label of the tool: its name, or the label of the object node that is its name."""
        return self.name if isinstance(self.name, str) else self.name.label


class TimedStep(NamedTuple):
    """A scheduled step.

    ``start``, ``end``: its times, in seconds.
    ``agent``: the number of its agent, from 1; ``None`` if nobody has to stand by.
    ``tools``: the tools that no other step may use while it runs, in the order of the unit's objects.
    """

    start: Fraction
    end: Fraction
    agent: int | None
    tools: tuple[Tool, ...]


class ScheduleResources(NamedTuple):
    """The resources of a schedule.

    ``durations``: how long each motion takes, and whether somebody has to stand by.
    ``agents``: the number of agents.
    ``tools``: the number of tools by name; ``None`` if unlimited. Utensils that it omits exist once each.
    """

    durations: Mapping[str, Duration]
    agents: int
    tools: Mapping[ToolName, int | None]

    def is_limited(self, problem: Problem, label: str) -> bool:
        """Return whether objects of a label are tools in limited number, so that steps may wait for them.

        If ``tools`` lists the label, they are limited unless its number there is ``None``. Otherwise, they
        are limited if ``tools`` lists a node with the label, or if the label is a utensil.
        """
        if label in self.tools:
            return self.tools[label] is not None
        is_node_listed = any(isinstance(name, ObjectNode) and name.label == label for name in self.tools)
        return is_node_listed or label in problem.utensils

    def is_unlimited(self, label: str) -> bool:
        """Return whether ``tools`` lists a label without a limit on its number.

        Several steps can then share one object of the label at the same time.
        """
        return label in self.tools and self.tools[label] is None

    def counted_name(self, node: ObjectNode, label: str) -> ToolName:
        """Return the name under which a tool is counted.

        ``label`` is the tool's label, and ``node`` is the tool itself or an object in it. If ``tools`` lists
        the node, it is the name. Otherwise, if ``tools`` lists the label or the tool is empty, the label is
        the name. Otherwise, the name is an object node that has only the contents of the tool.
        """
        if node in self.tools:
            return node
        inside = node.ingredients if node.label == label else (node.label,)
        if label in self.tools or not inside:
            return label
        return ObjectNode.of(label, (), (), [Contents("contains", tuple(sorted({*inside})))])

    def number_of(self, problem: Problem, name: ToolName) -> int:
        """Return the number of tools of a name.

        If ``tools`` has a number for the name, return it. Otherwise, return the number of nodes of this name
        in the stock of the problem, but at least 1.
        """
        listed_number = self.tools.get(name)
        if listed_number is not None:
            return listed_number
        stock = {} if problem.items is None else problem.items.stock
        return max(1, sum(n for node, n in stock.items() if self.counted_name(node, node.label) == name))


class ToolNeed(NamedTuple):
    """The objects of one label that a unit needs as tools.

    ``kept``: preconditions that are outputs, too: they stay as they are.
    ``changed``: preconditions that are no outputs.
    ``made``: outputs that the unit makes.
    ``others``: inputs of the label that the container rule skips. If no input or output has the label, the
    tool is only a container. The tuple then has one entry: an input in, on or at the tool, or ``None`` if no
    input is there.
    """

    kept: tuple[ObjectNode, ...]
    changed: tuple[ObjectNode, ...]
    made: tuple[ObjectNode, ...]
    others: tuple[ObjectNode | None, ...]

    @property
    def number(self) -> int:
        """The number of tools of the label that the unit occupies.

        A tool in ``made`` can be a changed or skipped one, so the larger number counts.
        """
        return len(self.kept) + max(len(self.changed) + len(self.others), len(self.made))


def tools_needed(problem: Problem, resources: ScheduleResources, unit: FunctionalUnit) -> dict[str, ToolNeed]:
    """Return what a unit needs of each tool in limited number, by label of the tool.

    The tools are inputs and outputs of the unit, and containers that an input or output is in, on or at.
    """
    preconditions, _, made = Executions(problem).of(unit)
    tool_needs: dict[str, ToolNeed] = {}
    nodes = (*dict.fromkeys(unit.inputs), *unit.outputs)
    containers = (relation.object for node in nodes for relation in node.relations)
    for label in dict.fromkeys([*(node.label for node in nodes), *containers]):
        if not resources.is_limited(problem, label):
            continue
        own_inputs = [node for node in dict.fromkeys(unit.inputs) if node.label == label]
        kept = tuple(node for node in own_inputs if node in preconditions and node in unit.outputs)
        changed = tuple(node for node in own_inputs if node in preconditions and node not in unit.outputs)
        outputs = tuple(node for node in made if node.label == label)
        others: list[ObjectNode | None] = [node for node in own_inputs if node not in preconditions]
        if not own_inputs and not outputs:
            inputs_inside = sorted((node for node in preconditions if node.is_in(label)), key=problem.at_hand)
            others.append(
                next(iter(inputs_inside), None)
            )  # preferably one that a step made: its tool is known
        tool_needs[label] = ToolNeed(kept, changed, outputs, tuple(others))
    return tool_needs


def timetable_fault(
    problem: Problem, plan: Sequence[FunctionalUnit], steps: Sequence[TimedStep], resources: ScheduleResources
) -> str | None:
    """Return in words the first fault of a schedule of a plan; ``None`` without one.

    Numbers of steps in the words are from 1. Steps have to take the durations in ``resources``. At each
    moment, there have to be enough copies for all running steps. Each agent and each tool may be at only one
    step. A tool has to be in the state in which an earlier step left it, or as the kitchen has it.

    ``steps`` has the times of each unit of ``plan``, in the same order. Items of the problem have to be used
    up (:func:`foon_asp.proof.replay.replayable_problem`).
    """
    if len(steps) != len(plan):
        return f"there are {len(plan)} steps, and times for {len(steps)}"
    for number, (unit, step) in enumerate(zip(plan, steps, strict=True), 1):
        duration = resources.durations[unit.motion]
        if step.start < 0 or step.end - step.start != duration.seconds:
            return f"step {number} does not take the time that {unit.motion} takes"
        if (step.agent is None) != duration.passive:
            return f"step {number} is done by nobody, or by somebody where nobody has to"
        if step.agent is not None and not 1 <= step.agent <= resources.agents:
            return f"step {number} is done by agent {step.agent}, and there are {resources.agents}"
    return _Run(problem, plan, steps, resources).fault()


class _Run:
    """The state of a kitchen while the steps of a schedule start and end."""

    def __init__(
        self,
        problem: Problem,
        plan: Sequence[FunctionalUnit],
        steps: Sequence[TimedStep],
        resources: ScheduleResources,
    ) -> None:
        """Start with the initial copies of the problem, and with no step running."""
        assert problem.items is not None
        self._problem, self._executions, self._resources = problem, Executions(problem), resources
        self._plan, self._steps = plan, steps
        self._copies = self._executions.initial_copies()
        self._copies_read: Counter[ObjectNode] = Counter()
        self._step_using: dict[int | Tool, int] = {}  # by agent or tool, while occupied
        self._states: dict[Tool, frozenset[ObjectNode]] = {}

    def fault(self) -> str | None:
        """Simulate the schedule; return its first fault in words, ``None`` without one.

        Of events at the same time, ends of steps come first.
        """
        events = [(step.end, False, position) for position, step in enumerate(self._steps)]
        events += [(step.start, True, position) for position, step in enumerate(self._steps)]
        for _, starts, position in sorted(events):
            if not starts:
                self._end_step(position)
            elif fault := next(self._start_step(position), None):
                return f"step {position + 1} ({self._plan[position].motion}) {fault}"
        return None

    def _start_step(self, position: int) -> Iterator[str]:
        """Start a step, and yield in words each reason why it cannot start.

        Iterating to the end takes its copies, agent and tools from the kitchen. ``position`` is that of the
        step in the schedule, from 0.
        """
        unit, step = self._plan[position], self._steps[position]
        occupied = _resources_of(step)
        if len(set(occupied)) < len(occupied):
            yield "has the same tool twice"
        for resource in occupied:
            if resource in self._step_using:
                yield f"waits for {resource}, which is at step {self._step_using[resource] + 1}"
        yield from self._tool_faults(unit, step.tools)
        needed, consumes, _ = self._executions.of(unit)
        for node, amount in needed.items():
            if self._executions.is_endless(node):
                continue
            consumed = consumes.get(node, 0)
            in_use = (
                0 if self._resources.is_unlimited(node.label) and not consumed else self._copies_read[node]
            )
            if self._copies[node] < in_use + amount:
                yield f"lacks a copy of {node}"
            self._copies[node] -= consumed
            self._copies_read[node] += amount - consumed
        self._step_using.update(dict.fromkeys(occupied, position))

    def _end_step(self, position: int) -> None:
        """End a step: add its outputs, update the states of its tools, and release its tools and agent."""
        unit, step = self._plan[position], self._steps[position]
        needed, consumes, made = self._executions.of(unit)
        for node, amount in needed.items():
            # endless nodes get negative numbers, which nothing reads
            self._copies_read[node] -= amount - consumes.get(node, 0)
        self._copies.update(made)
        for tool in step.tools:
            # some nodes are at other tools: nothing looks for them here
            self._states[tool] = self._states.get(tool, frozenset()).difference(consumes).union(made)
        for resource in _resources_of(step):
            self._step_using.pop(resource, None)

    def _tool_faults(self, unit: FunctionalUnit, tools: Sequence[Tool]) -> Iterator[str]:
        """Yield in words each fault of the tools with which a step of ``unit`` starts.

        A tool that holds no needed object counts as fetched from the kitchen: what it held is forgotten.
        """
        problem, resources = self._problem, self._resources
        tool_needs = tools_needed(problem, resources, unit)
        preconditions = self._executions.of(unit).preconditions
        brought = Counter(tool.label for tool in tools)
        for label in tool_needs.keys() | brought.keys():
            needed_number = tool_needs[label].number if label in tool_needs else 0
            if brought[label] != needed_number:
                yield f"has {brought[label]} of {label}, and asks for {needed_number}"
        for tool in tools:
            if not 1 <= tool.number <= resources.number_of(problem, tool.name):
                yield f"has {tool}, and there are {resources.number_of(problem, tool.name)}"
        for label, need in tool_needs.items():
            brought_tools = [tool for tool in tools if tool.label == label]
            held_nodes = {node for tool in brought_tools for node in self._states.get(tool, ())}
            wanted_nodes = {node for node in (*need.kept, *need.changed, *need.others) if node is not None}
            for node in wanted_nodes - held_nodes:
                fetched = problem.at_hand(node) and resources.counted_name(node, label) in {
                    tool.name for tool in brought_tools
                }
                if not fetched and node in preconditions:
                    yield f"has no {label} for {node}"
            for tool in brought_tools:  # a tool fetched from the kitchen loses its earlier state
                if wanted_nodes and wanted_nodes.isdisjoint(self._states.get(tool, ())):
                    self._states[tool] = frozenset()


def _resources_of(step: TimedStep) -> list[int | Tool]:
    """Return the resources that a step occupies: its tools, and its agent as a number if it has one."""
    return [*step.tools] + ([] if step.agent is None else [step.agent])
