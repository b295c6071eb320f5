"""The cheapest repair of a tree: stand-ins, units of a network and another order, so that it executes."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from foon_asp.network import (
    STAND_IN,
    FunctionalUnit,
    Network,
    NetworkBuilder,
    ObjectNode,
    Source,
    StandInTable,
)
from foon_asp.problem import Problem, reach
from foon_asp.standins.extension import with_stand_ins


@dataclass(frozen=True)
class Repair:
    """The problem whose best tree is the cheapest repair of a tree.

    ``posed``: the problem to solve. In it, each step of the tree has one additional output, its *marker*: a
    node that is a goal and that only this step makes. So every solution has all steps.
    ``shown``: the problem ``posed`` without markers. Units have the ids that they have in ``posed``.
    ``steps``: the units of the tree, by id, in the order listed, each once.
    """

    posed: Problem
    shown: Problem
    steps: tuple[int, ...]

    @classmethod
    def of(
        cls,
        problem: Problem,
        tree: Sequence[FunctionalUnit],
        sources: Sequence[Source],
        table: StandInTable,
        is_available: Callable[[ObjectNode], bool],
    ) -> "Repair":
        """Make the problem of a repair, over the units of a problem's network and of a tree.

        ``sources`` has the source of each unit of the tree, and ``table`` the prices of stand-ins. Stand-ins
        in the network are omitted, and so are rates of single units. ``is_available`` says whether the
        kitchen has a node that is not in the network of ``problem``. Goals that are in no unit are dropped.
        Raises :class:`UserError` like :func:`with_stand_ins`.
        """
        original = problem.network
        builder = NetworkBuilder()
        for unit, unit_sources in zip(original, original.sources, strict=True):
            if unit.motion == STAND_IN:
                continue
            builder.add(unit.motion, unit.inputs, unit.outputs, *unit_sources)
        unit_ids = [
            builder.add(unit.motion, unit.inputs, unit.outputs, source)
            for unit, source in zip(tree, sources, strict=True)
        ]
        steps, network = tuple(dict.fromkeys(unit_ids)), builder.build()
        nodes = enumerate(network.objects)
        kitchen = frozenset(
            o
            for o, node in nodes
            if (problem.at_hand(node) if original.object_id(node) is not None else is_available(node))
        )
        goals = [network.object_id(node) for node in problem.goal_nodes]
        merged = replace(
            problem,
            network=network,
            kitchen=kitchen,
            goals=tuple(goal for goal in goals if goal is not None),
            own_rates={},
            origin=None,
            stand_ins=None,
        )
        return cls.over(merged, steps, table)

    @classmethod
    def over(cls, problem: Problem, steps: tuple[int, ...], table: StandInTable) -> "Repair":
        """Make the problem of a repair for a tree whose units are in the problem's network.

        ``steps`` has the units of the tree, by id, each once. The network must have no stand-ins. Raises
        :class:`UserError` like :func:`with_stand_ins`.
        """
        network = problem.network
        first_marker = len(network.objects)
        marked_problem = replace(
            problem,
            network=_with_markers(network, steps),
            goals=(*problem.goals, *range(first_marker, first_marker + len(steps))),
        )
        posed = with_stand_ins(marked_problem, table)
        shown = replace(posed, network=_without_markers(posed.network, network), goals=problem.goals)
        return cls(posed, shown, steps)

    def added_units(self, units: Sequence[int]) -> list[int]:
        """Return the units of a repaired tree, in order, that are neither ``steps`` nor stand-ins.

        ``units`` is the repaired tree.
        """
        motions, steps = self.posed.network.motions, frozenset(self.steps)
        return [unit for unit in units if unit not in steps and motions[unit] != STAND_IN]

    def unmakeable_nodes(self) -> list[int]:
        """Return goals and preconditions of steps that cannot be made, even with stand-ins, as ascending ids.

        Nodes that a step would make are omitted, unless all are such nodes.
        """
        available = reach(self.posed).available
        made = {o for unit in self.steps for o in self.shown.gives[unit]}
        needed = {o for unit in self.steps for o in self.shown.needs[unit]}.union(self.shown.goals)
        unmakeable = [o for o in sorted(needed) if not available[o]]
        return [o for o in unmakeable if o not in made] or unmakeable


def _with_markers(network: Network, steps: Sequence[int]) -> Network:
    """Return a copy of a network in which each of ``steps`` has a marker as an additional output."""
    first_marker = len(network.objects)
    markers = {unit: o for o, unit in enumerate(steps, first_marker)}
    # labels in files have no line break, so these nodes have no stand-in
    nodes = [ObjectNode(f"step\n{number}", frozenset({"done"})) for number in range(1, len(steps) + 1)]
    outputs = tuple(
        (*made, markers[unit]) if unit in markers else made for unit, made in enumerate(network.outputs)
    )
    return replace(
        network,
        objects=(*network.objects, *nodes),
        outputs=outputs,
        _object_ids={**network._object_ids, **{node: o for o, node in enumerate(nodes, first_marker)}},
        _unit_ids={
            (motion, frozenset(inputs), frozenset(made)): unit
            for unit, (motion, inputs, made) in enumerate(
                zip(network.motions, network.inputs, outputs, strict=True)
            )
        },
    )


def _without_markers(extended: Network, plain: Network) -> Network:
    """Return a copy of a network without the nodes that :func:`_with_markers` added; stand-ins stay.

    ``plain`` is the network before markers and stand-ins were added.
    """
    stand_ins = {key: unit for key, unit in extended._unit_ids.items() if unit >= len(plain)}
    return replace(
        extended,
        objects=plain.objects,
        outputs=(*plain.outputs, *extended.outputs[len(plain) :]),
        _object_ids=plain._object_ids,
        _unit_ids={**plain._unit_ids, **stand_ins},
    )
