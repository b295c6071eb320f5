"""The steps of a plan for a robot's program: the objects of each before and after it, by role."""

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from fractions import Fraction

from msgspec import field

from foon_asp.network import FunctionalUnit, Network, ObjectNode
from foon_asp.problem import Problem
from foon_asp.proof.replay import predecessors, replay_for, replayable_problem
from foon_asp.results.values import Copy, Node, NumberedStep, Value
from foon_asp.results.values_of import copy_of, mention_of, named_node
from foon_asp.text.clip_times import ListedClips
from foon_asp.text.tables import Duration


class Change(Value, frozen=True):
    """One object of a step, and its nodes before and after the step.

    Attributes:
        object: The label of the object.
        before: The node before the step; null for an object that the step makes.
        after: The node after the step; null for an object that is gone then.
    """

    object: str
    before: Node | None
    after: Node | None


class Clip(Value, frozen=True):
    """When a step happens in the video that was annotated, in seconds.

    Attributes:
        begin: The begin of its first part.
        end: The end of its last part.
        seconds: The length of all parts.
    """

    begin: int
    end: int
    seconds: int


class RobotStep(NumberedStep, frozen=True, kw_only=True):
    """A step with its objects by role, as far as the FOON tells.

    Attributes:
        objects: Every object that the unit lists, with its node before and after the step.
        needs: The inputs that have to be available, and where each comes from.
        makes: The outputs that were no inputs.
        acted_on: Inputs that are neither tools nor places.
        tools: Utensils that nothing comes from or goes to. Without a list of utensils, inputs that nothing
            comes from or goes to, and that are the same after the step.
        origins: The places that the inputs are in, on or at; an object that the unit does not list has its
            label alone.
        destinations: The places that the outputs are in, on or at, as they are after the step.
        after: The steps that have to be done before.
        rate: The success rate; null without rates.
        duration: In seconds; null where none is stated.
        clip: When the motion happens in the video that was annotated; null where no time is written.
    """

    objects: tuple[Change, ...]
    needs: tuple[Copy, ...]
    makes: tuple[Node, ...]
    acted_on: tuple[Node, ...]
    tools: tuple[Node, ...]
    origins: tuple[Node, ...] = field(name="from")
    destinations: tuple[Node, ...] = field(name="to")
    after: tuple[int, ...]
    rate: Fraction | None
    duration: Fraction | None
    clip: Clip | None


def robot_steps(
    problem: Problem,
    plan: Collection[int],
    durations: Mapping[str, Duration],
    clips: Iterable[ListedClips],
) -> Iterator[RobotStep]:
    """Yield the steps of a plan for a robot's program, in order.

    Parameters:
        problem: The problem that the plan is for.
        plan: The ids of the units, in an order that executes.
        durations: How long motions take, by motion, as far as that is known.
        clips: The clips of the annotated video, as far as they have times; a step has the clip of its source
            line.
    """
    clip_of = {
        (source.file, source.line): Clip(listed.clips[0][0], listed.clips[-1][1], listed.seconds)
        for listed in clips
        for source in listed.sources
    }
    network, tree = problem.network, problem.tree(plan)
    replay = replay_for(replayable_problem(problem, tree), tree)
    for number, (done, after, id_) in enumerate(
        zip(replay.steps, predecessors(replay), plan, strict=True), 1
    ):
        mention, unit = mention_of(network, id_), done.unit
        duration = durations.get(unit.motion)
        origins, destinations = (
            _places(network, nodes, others)
            for nodes, others in ((unit.inputs, unit.outputs), (unit.outputs, unit.inputs))
        )
        places = {node.label for node in (*origins, *destinations)}
        moved = [node for node in unit.inputs if node.label not in places]
        tools = [node for node in moved if _is_tool(problem, unit, node)]
        copies = {copy.node: copy for copy in (*done.gone, *done.stayed)}
        yield RobotStep(
            number,
            mention.id,
            mention.motion,
            mention.source,
            objects=tuple(_changes(network, unit)),
            needs=tuple(copy_of(network, copies[node]) for node in unit.inputs if node in copies),
            makes=tuple(named_node(network, copy.node) for copy in done.came),
            acted_on=tuple(named_node(network, node) for node in moved if node not in tools),
            tools=tuple(named_node(network, node) for node in tools),
            origins=origins,
            destinations=destinations,
            after=tuple(earlier + 1 for earlier in sorted(after)),
            rate=None if problem.rates is None else Fraction(problem.rate(id_)),
            duration=None if duration is None else Fraction(duration.seconds),
            clip=next(filter(None, (clip_of.get((at.file, at.line)) for at in mention.source)), None),
        )


def _is_tool(problem: Problem, unit: FunctionalUnit, node: ObjectNode) -> bool:
    """Whether an input is a tool; the input must be no place of the unit.

    A tool is a utensil. If the problem has no utensils, a tool is an input that is also an output.
    """
    return node.label in problem.utensils if problem.utensils else node in unit.outputs


def _places(network: Network, nodes: Sequence[ObjectNode], others: Iterable[ObjectNode]) -> tuple[Node, ...]:
    """Return the places of ``nodes``, which are one side of a unit, in alphabetical order of their labels.

    Every object to which a node has a relation is a place, whatever the relation. A place is the node with
    its label among ``nodes``, or else among ``others``, the other side of the unit. If there is no such node,
    the place has only the label.
    """
    by_label: dict[str, ObjectNode] = {}
    for node in (*nodes, *others):
        by_label.setdefault(node.label, node)
    labels = sorted({relation.object for node in nodes for relation in node.relations})
    return tuple(named_node(network, by_label.get(label, ObjectNode(label))) for label in labels)


def _changes(network: Network, unit: FunctionalUnit) -> Iterator[Change]:
    """Yield the objects of a unit with their nodes before and after it.

    An input is paired with the same node among the outputs, or else with an output of its label. An input
    without such an output has no node after the unit. Outputs without an input come last, and have no node
    before the unit.
    """
    pairs: list[tuple[ObjectNode | None, ObjectNode | None]] = []
    remaining = list(unit.outputs)
    unchanged = [node for node in unit.inputs if node in remaining]
    for node in unchanged:
        remaining.remove(node)
    for node in unit.inputs:
        if node in unchanged:
            pairs.append((node, node))
            continue
        after = next((output for output in remaining if output.label == node.label), None)
        if after is not None:
            remaining.remove(after)
        pairs.append((node, after))
    pairs += ((None, output) for output in remaining)
    for before, after in pairs:
        listed = before or after
        assert listed is not None
        yield Change(
            listed.label,
            None if before is None else named_node(network, before),
            None if after is None else named_node(network, after),
        )
