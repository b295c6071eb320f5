"""Conversion of ids in a network into values for results."""

import functools
from collections import deque
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from itertools import groupby
from types import MappingProxyType
from typing import Any, Literal, TypedDict, TypeVar

from msgspec import UNSET, UnsetType

from foon_asp.network import FunctionalUnit, Network, ObjectNode, Source, UnitAmounts
from foon_asp.network.near_units import NearUnits
from foon_asp.problem import ContainerRule, Costs, Objective, Problem, kitchen_needed
from foon_asp.proof.replay import Copy as Replayed
from foon_asp.proof.replay import Shortage
from foon_asp.proof.used_up_run import used_up_run
from foon_asp.results.values import (
    Contents,
    Copies,
    Copy,
    CostedTree,
    Input,
    Lack,
    Mention,
    Node,
    Origin,
    Output,
    Place,
    Relation,
    Step,
    Unit,
    UnitDifference,
    UsedUpRun,
)

N = TypeVar("N", bound=Node)
U = TypeVar("U", bound=Unit)

_KITCHEN, _BOUGHT, _IMPLIED, _MISSING = (
    Origin(**{name: True}) for name in ("kitchen", "bought", "implied", "missing")
)


class Head(TypedDict):
    """The fields of the question, which come first in every document about goals."""

    goals: tuple[Node, ...]
    containers: ContainerRule
    items: Literal["lasting", "used-up"]
    level: int
    objectives: tuple[Objective, ...]
    starting_kitchen: tuple[Node, ...] | None


def question_fields(problem: Problem, objectives: Iterable[Objective] = ()) -> Head:
    """Return the first fields of a document about goals: the goals, the conditions and the objectives.

    The starting kitchen is ``None`` where a kitchen was given.
    """
    network = problem.network
    return {
        "goals": goals_of(network, problem.goals, problem.items.wanted if problem.items else {}),
        "containers": problem.containers,
        "items": "lasting" if problem.items is None else "used-up",
        "level": network.level,
        "objectives": tuple(objectives),
        "starting_kitchen": nodes_of(network, kitchen_needed(problem)) if problem.starting else None,
    }


def goals_of(
    network: Network, goals: Iterable[int], wanted: Mapping[ObjectNode, int] = MappingProxyType({})
) -> tuple[Node, ...]:
    """Return goals, by id, as nodes with the copies that are ``wanted`` of them.

    Below level 3, each goal has the level-3 nodes that it stands for, and no number of copies.
    """
    detailed = network.detailed
    if detailed is None:
        amounts = (wanted.get(network.objects[goal], UNSET) for goal in goals)
        return tuple(node_as(Node, network, goal, wanted=n) for goal, n in zip(goals, amounts, strict=True))
    return tuple(
        node_as(Node, network, goal, stands_for=nodes_of(detailed, network.objects_stand_for[goal]))
        for goal in goals
    )


def nodes_of(network: Network, ids: Iterable[int]) -> tuple[Node, ...]:
    """Return object nodes, by id, as values."""
    return tuple(node_of(network, o) for o in ids)


def node_of(network: Network, o: int) -> Node:
    """Return an object node, by id, as a value."""
    return node_as(Node, network, o)


def node_as(kind: type[N], network: Network, o: int, **fields: Any) -> N:
    """Return an object node, by id, as a value of class ``kind``, with additional fields of the class.

    The value has the id of the node in the whole network.
    """
    return kind(network.object_number(o), *_node_fields(network.objects[o]), **fields)


def named_node(network: Network, node: ObjectNode) -> Node:
    """Return an object node as a value, whether or not the network has it."""
    o = network.object_id(node)
    return Node(None if o is None else network.object_number(o), *_node_fields(node))


def place_of(source: Source) -> Place:
    """Return the place where a unit was read, as a value."""
    return Place(source.file, source.line, tuple(source.videos))


def mention_of(network: Network, unit: int) -> Mention:
    """Return a unit, by id, as a value with its id in the whole network, its motion and its places."""
    return Mention(network.unit_number(unit), network.motions[unit], _places_of(network, unit))


def unit_of(network: Network, unit: int) -> Unit:
    """Return a unit, by id, as a value; below level 3 with the level-3 units that it stands for."""
    return unit_as(Unit, network, unit)


def unit_as(kind: type[U], network: Network, unit: int, **fields: Any) -> U:
    """Return a unit, by id, as a value of class ``kind``, with additional fields of the class.

    The value has the id in the whole network and, below level 3, the level-3 units that the unit stands for.
    """
    return kind(
        network.unit_number(unit),
        network.motions[unit],
        nodes_of(network, network.inputs[unit]),
        nodes_of(network, network.outputs[unit]),
        _places_of(network, unit),
        _level_3_units(network, unit),
        **fields,
    )


def listed_unit(network: Network, unit: FunctionalUnit, source: Source) -> Unit:
    """Return a unit that a file lists as a value, with its place in the file.

    Its id is ``None`` if the network does not have the unit.
    """
    number = network.unit_id(unit)
    inputs, outputs = (
        tuple(named_node(network, node) for node in nodes) for nodes in (unit.inputs, unit.outputs)
    )
    return Unit(
        None if number is None else network.unit_number(number),
        unit.motion,
        inputs,
        outputs,
        (place_of(source),),
    )


def differences_of(pair: NearUnits) -> tuple[UnitDifference, ...]:
    """Return the differences of a pair of similar units as values."""
    return tuple(
        UnitDifference(kind, word_a or None, word_b or None, of or None)
        for kind, word_a, word_b, of in pair.differences
    )


def steps_of(
    problem: Problem,
    units: Collection[int],
    bought: Mapping[int, int] = MappingProxyType({}),
    helped: Collection[int] | None = None,
) -> tuple[Step, ...]:
    """Return units, by id, as steps: each input has its origin, and each output says whether it is made.

    ``bought`` has the number of bought copies by id of the kitchen item. ``helped`` are the units that a
    person does; ``None`` if no person helps. If the listed order does not execute, the origin of an input may
    be a later step, or the input may be missing. Where amounts are counted, equal units that follow each
    other are one step.
    """
    network, steps = problem.network, []
    for number, (unit, times, origins) in enumerate(_steps_with_origins(problem, units, bought), 1):
        uses = None if problem.items is None else problem.flows[unit].uses
        input_amounts, output_amounts = (
            problem.amounts.get(network.unit(unit), UnitAmounts()) if problem.counts_amounts else (None, None)
        )
        inputs = tuple(
            node_as(
                Input,
                network,
                o,
                origin=origin,
                stays=UNSET if uses is None else o not in uses,
                amount=_amount_of(input_amounts, network, o),
            )
            for o, origin in zip(network.inputs[unit], origins, strict=True)
        )
        gives = frozenset(problem.gives[unit])
        outputs = tuple(
            node_as(Output, network, o, made=o in gives, amount=_amount_of(output_amounts, network, o))
            for o in network.outputs[unit]
        )
        by = UNSET if helped is None else "person" if unit in helped else "robot"
        named = network.unit_number(unit), network.motions[unit]
        steps.append(
            Step(
                number,
                *named,
                inputs,
                outputs,
                _places_of(network, unit),
                _level_3_units(network, unit),
                by,
                times,
            )
        )
    return tuple(steps)


def _amount_of(amounts: Mapping[ObjectNode, int] | None, network: Network, o: int) -> int | UnsetType:
    """Return the amount of a node, by id, or 1 if none is stated; ``UNSET`` where amounts do not count."""
    return UNSET if amounts is None else amounts.get(network.objects[o], 1)


def costed_tree(problem: Problem, units: Collection[int], costs: Costs) -> CostedTree:
    """Return a tree as a value with its costs; ``units`` are ids in an order that executes."""
    return CostedTree(costs, used_up_of(problem, problem.tree(units)), steps_of(problem, units))


def used_up_of(problem: Problem, tree: Iterable[FunctionalUnit] | None) -> UsedUpRun | None:
    """Return whether a tree runs where items are used up, and the missing copy if it does not.

    Return ``None`` without a tree, and where the items of the problem are used up already.
    """
    if tree is None or problem.items is not None:
        return None
    run = used_up_run(problem, tree)
    lack = run.shortage
    return UsedUpRun(run.runs, None if lack is None else lack_of(problem.network, lack))


def lack_of(network: Network, shortage: Shortage) -> Lack:
    """Return a missing copy as a value; steps are numbered from 1, and an amount of 1 is left out."""
    position = None if shortage.step is None else shortage.step + 1
    consumers = tuple(step + 1 for step in shortage.consumers)
    amount = UNSET if shortage.amount == 1 else shortage.amount
    return Lack(position, named_node(network, shortage.node), consumers, amount=amount)


def copy_of(network: Network, copy: Replayed) -> Copy:
    """Return a copy of an object node as a value with its origin: the kitchen or a step."""
    origin = _KITCHEN if copy.made is None else Origin(step=copy.made + 1)
    o = network.object_id(copy.node)
    return Copy(None if o is None else network.object_number(o), *_node_fields(copy.node), origin=origin)


def copies_of(network: Network, counts: Mapping[ObjectNode, int]) -> tuple[Copies, ...]:
    """Return object nodes as values, each with its number of copies."""
    return tuple(Copies(named_node(network, node), number) for node, number in counts.items())


@functools.lru_cache(maxsize=10_000)  # units that are near each other share most of their nodes
def _node_fields(
    node: ObjectNode,
) -> tuple[str, str, tuple[str, ...], tuple[Relation, ...], tuple[Contents, ...]]:
    """Return the fields of an object node after its id: notation, label, states, relations, contents."""
    relations = tuple(Relation(*relation) for relation in sorted(node.relations))
    contents = tuple(
        Contents(contents_of.word, tuple(contents_of.ingredients)) for contents_of in node.contents
    )
    return str(node), node.label, tuple(sorted(node.states)), relations, contents


def _places_of(network: Network, unit: int) -> tuple[Place, ...]:
    """Return the places of all copies of a unit."""
    return tuple(map(place_of, network.sources[unit]))


def _level_3_units(network: Network, unit: int) -> tuple[Unit, ...] | UnsetType:
    """Return the level-3 units that a unit stands for; ``UNSET`` at level 3."""
    detailed = network.detailed
    if detailed is None:
        return UNSET
    return tuple(unit_of(detailed, detail) for detail in network.stands_for[unit])


def _steps_with_origins(
    problem: Problem, units: Collection[int], bought: Mapping[int, int]
) -> Iterator[tuple[int, int | UnsetType, Sequence[Origin]]]:
    """Yield the unit id, the number of executions and the origins of the inputs of each step.

    The number is ``UNSET`` unless amounts are counted. ``bought`` has the number of bought copies by id of
    the kitchen item.
    """
    if problem.items is not None:
        yield from _steps_with_copies(problem, units, bought)
        return
    makers: dict[int, list[int]] = {}
    for step, unit in enumerate(units, 1):
        for o in problem.gives[unit]:
            makers.setdefault(o, []).append(step)
    for step, unit in enumerate(units, 1):
        needs = frozenset(problem.needs[unit])  # a unit may need very many
        yield (
            unit,
            UNSET,
            [
                _input_origin(problem, o, step, makers, o in needs, bought)
                for o in problem.network.inputs[unit]
            ],
        )


def _input_origin(
    problem: Problem,
    o: int,
    step: int,
    makers: Mapping[int, Sequence[int]],
    needed: bool,
    bought: Mapping[int, int],
) -> Origin:
    """Return the origin of the input ``o`` of a step, where items last.

    ``makers`` has the numbers of the steps that make each node. ``needed`` is false for an input that the
    container rule takes as given. Kitchen items in ``bought`` have the origin ``bought``.
    """
    if o in problem.kitchen:
        return _BOUGHT if o in bought else _KITCHEN
    makes = makers.get(o, ())
    if makes and makes[0] < step:
        return Origin(step=makes[0])
    if not needed:
        return _IMPLIED
    later = next((maker for maker in makes if maker > step), None)
    return _MISSING if later is None else Origin(later_step=later)


def _steps_with_copies(
    problem: Problem, plan: Collection[int], bought: Mapping[int, int]
) -> Iterator[tuple[int, int | UnsetType, Sequence[Origin]]]:
    """Yield the steps where items are used up, each as :func:`_steps_with_origins` yields it.

    Each step takes the oldest copies of its inputs; bought copies come after those of the kitchen. Where
    amounts are counted, equal units that follow each other are one step.
    """
    copies = {
        o: deque([(_KITCHEN, (problem.stock_of(o) or 0) - bought.get(o, 0)), (_BOUGHT, bought.get(o, 0))])
        for o in problem.kitchen
    }
    runs = ((unit, sum(1 for _ in run)) for unit, run in groupby(plan))
    executed = runs if problem.counts_amounts else ((unit, 1) for unit in plan)
    for step, (unit, times) in enumerate(executed, 1):
        asks, uses, adds = problem.flows[unit]
        origins = []
        for o in problem.network.inputs[unit]:
            if o in problem.endless:
                origins.append(_KITCHEN)
            elif o not in asks:
                origins.append(_IMPLIED)
            else:
                origins.append(_take_oldest(copies.get(o, deque()), uses.get(o, 0) * times))
        for o, amount in adds.items():
            copies.setdefault(o, deque()).append((Origin(step=step), amount * times))
        yield unit, times if problem.counts_amounts else UNSET, origins


def _take_oldest(copies: deque[tuple[Origin, int]], amount: int) -> Origin:
    """Remove ``amount`` of the oldest copies from the queue, and return the origin of the oldest copy.

    Each entry of ``copies`` is an origin and its number of copies. For an empty queue, the origin is
    ``missing``.
    """
    while copies and not copies[0][1]:
        copies.popleft()
    first = copies[0][0] if copies else _MISSING
    while amount and copies:
        origin, available = copies.popleft()
        if available > amount:
            copies.appendleft((origin, available - amount))
        amount -= min(available, amount)
    return first
