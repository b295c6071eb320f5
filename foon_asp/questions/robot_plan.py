"""Plans for a robot's program: each step with its objects by role, and the steps that it waits for."""

from collections.abc import Collection, Iterable
from fractions import Fraction
from typing import Self

from msgspec import field

from foon_asp.network import ObjectNode
from foon_asp.problem import Objective, Problem
from foon_asp.proof.replay import replay_for, replayable, waits
from foon_asp.results.document import AboutGoals
from foon_asp.results.values import Node, NumberedStep, UsedUpRun
from foon_asp.results.values_of import head_of, mention_of, named_node, used_up_of
from foon_asp.text.json_value import schema_name


class RobotStep(NumberedStep, frozen=True, kw_only=True):
    """A step with its objects by role, as far as the FOON tells.

    Attributes:
        tools: Utensils that nothing comes from or goes to.
        origins: Labels of what the inputs are in, on or at.
        destinations: Labels of what the outputs are in, on or at.
        after: The steps that have to be done before.
    """

    acted_on: tuple[Node, ...]
    tools: tuple[Node, ...]
    origins: tuple[str, ...] = field(name="from")
    destinations: tuple[str, ...] = field(name="to")
    makes: tuple[Node, ...]
    after: tuple[int, ...]
    rate: Fraction | None


class RobotPlan(AboutGoals, frozen=True, kw_only=True, tag=schema_name("steps")):
    """A plan for a robot's program.

    Attributes:
        used_up: Whether the steps, each done once, run where items are used up; null where items are used
            up anyway.
        robot_steps: The steps, in an order that executes.
    """

    used_up: UsedUpRun | None
    robot_steps: tuple[RobotStep, ...] = field(name="steps")

    @classmethod
    def of(cls, problem: Problem, objectives: Iterable[Objective], plan: Collection[int]) -> Self:
        """Return the plan that units, by id, are in an order that executes."""
        network, tree = problem.network, problem.tree(plan)
        replay = replay_for(replayable(problem, tree), tree)
        steps = []
        for number, (done, after, id_) in enumerate(zip(replay.steps, waits(replay), plan, strict=True), 1):
            mention, unit = mention_of(network, id_), done.unit
            origins, destinations = _places(unit.inputs), _places(unit.outputs)
            others = [node for node in unit.inputs if node.label not in {*origins, *destinations}]
            tools, acted_on = (
                tuple(
                    named_node(network, node) for node in others if (node.label in problem.utensils) is tool
                )
                for tool in (True, False)
            )
            steps.append(
                RobotStep(
                    number,
                    mention.id,
                    mention.motion,
                    mention.source,
                    acted_on=acted_on,
                    tools=tools,
                    origins=origins,
                    destinations=destinations,
                    makes=tuple(named_node(network, copy.node) for copy in done.came),
                    after=tuple(earlier + 1 for earlier in sorted(after)),
                    rate=None if problem.rates is None else Fraction(problem.rate(id_)),
                )
            )
        used_up = used_up_of(problem, tree)
        return cls(**head_of(problem, objectives), used_up=used_up, robot_steps=tuple(steps))


def _places(nodes: Iterable[ObjectNode]) -> tuple[str, ...]:
    """Return the labels of the objects that nodes are in, on or at."""
    return tuple(sorted({relation.object for node in nodes for relation in node.relations}))
