"""What two trees have in common, what only one has, what each costs, and where they part."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import NamedTuple

from foon_asp.dataset import Dataset
from foon_asp.deadline import Cancel
from foon_asp.document.json_document import costs_json, document, head_json, listed_unit_json, named_json
from foon_asp.errors import UserError
from foon_asp.network import FunctionalUnit, Network, ObjectNode, Source, UnitPrices, counted, unit_at_level
from foon_asp.problem import (
    ContainerRule,
    Costs,
    Known,
    Objective,
    container_rule,
    given_outputs,
    needed_inputs,
    tree_costs,
)
from foon_asp.problem.progress import OnProgress
from foon_asp.questions.answer import Answer
from foon_asp.questions.contract import TABLES, Option, Part, question
from foon_asp.questions.each import Each
from foon_asp.questions.options import CONTAINERS, GOALS
from foon_asp.questions.posing import Command
from foon_asp.questions.result import Ending, NoTreeError, Result
from foon_asp.questions.tree import Tree, read_listed
from foon_asp.report.answer import costs_text, headline
from foon_asp.report.stacked import is_narrow
from foon_asp.text.goal_name import find_goal

Listed = Sequence[tuple[FunctionalUnit, Source]]

_PARTINGS = 12  # that the text lists


class Side(NamedTuple):
    """One of two trees: its units in the order listed, each once, with place, needs and products; its costs.

    ``goals`` may be empty where they are not known. ``costs.success`` is ``None`` where a rate is not known.
    ``ending`` is how the question ended whose answer it is, and ``objectives`` are those of it, none for a
    tree that is no answer. ``starting`` says that no kitchen was given, so that it is the starting one.
    """

    name: str
    units: tuple[FunctionalUnit, ...]
    places: Mapping[FunctionalUnit, Source]
    needs: Mapping[FunctionalUnit, tuple[ObjectNode, ...]]
    gives: Mapping[FunctionalUnit, tuple[ObjectNode, ...]]
    goals: tuple[ObjectNode, ...]
    kitchen: frozenset[ObjectNode]
    costs: Costs
    rule: ContainerRule
    network: Network
    ending: Ending
    objectives: tuple[Objective, ...]
    starting: bool = False

    def origin(self, node: ObjectNode) -> FunctionalUnit | None:
        """Give the unit that makes a node first; ``None`` where the kitchen has it or no unit makes it."""
        if node in self.kitchen:
            return None
        return next((u for u in self.units if node in self.gives[u] and node not in self.needs[u]), None)


class Parting(NamedTuple):
    """An object node that both trees come to, and the unit that makes it in each, or ``None``."""

    object: ObjectNode
    left: FunctionalUnit | None
    right: FunctionalUnit | None


@dataclass(frozen=True, repr=False)
class Difference(Result):
    """Two trees: the units of only one, those of both, and where the trees part.

    The units are ``only_left``, ``only_right`` and ``both``. ``left`` and ``right`` have the units and the
    ``costs`` of each; ``partings`` are the object nodes that both need on the way to the goals but get in
    different ways.

    Example:
        >>> problem = foon_asp.load().problem("macaroni")
        >>> foon_asp.diff(foon_asp.solve(problem), foon_asp.solve(problem, "success"))
        <Difference: 3 only left, 5 only right, 6 in both>
    """

    left: Side
    right: Side
    only_left: tuple[FunctionalUnit, ...]
    only_right: tuple[FunctionalUnit, ...]
    both: tuple[FunctionalUnit, ...]
    partings: tuple[Parting, ...]

    @property
    def same_order(self) -> bool:
        """Whether the units that both have stand in the same order in both."""
        return self.both == tuple(unit for unit in self.right.units if unit in set(self.both))

    @property
    def ending(self) -> Ending:
        """Done when both were compared, whether they differ or not; an answer has to be proved."""
        return Ending.LIMIT if Ending.LIMIT in {self.left.ending, self.right.ending} else Ending.DONE

    def text(self) -> str:
        """Give the costs of both, the units that only one has, and where they part."""
        left, right = self.left, self.right
        width = 0 if is_narrow() else max(len(left.name), len(right.name))
        between = "\n" if is_narrow() else ""
        lines = [
            f"{letter}: {tree.name:<{width}}{between}    {costs_text(tree.costs)}"
            for letter, tree in (("A", left), ("B", right))
        ]
        if not self.only_left and not self.only_right:
            order = "in the same order" if self.same_order else "in another order"
            lines.append(f"the same {counted(len(self.both), 'unit')}, {order}")
        else:
            lines.append(f"{counted(len(self.both), 'unit')} in both")
            for letter, tree, units in (("A", left, self.only_left), ("B", right, self.only_right)):
                lines.append(f"only in {letter}: {counted(len(units), 'unit')}")
                lines += [f"  {_unit_text(tree, unit)}" for unit in units]
        if self.partings:
            lines.append("they part at")
            for parting in self.partings[:_PARTINGS]:
                lines.append(f"  {parting.object}")
                lines += [
                    f"    {letter}: {_origin(tree, unit, parting.object)}"
                    for letter, tree, unit in (("A", left, parting.left), ("B", right, parting.right))
                ]
            if len(self.partings) > _PARTINGS:
                lines.append(
                    f"  ... and {counted(len(self.partings) - _PARTINGS, 'more')}; --format json lists all"
                )
        return "\n".join(lines) + "\n"

    def json_dict(self) -> object:
        """Give the same; ids are those of the network that a tree is of."""
        left, right = self.left, self.right
        return document(
            "diff",
            a=_side_json(left),
            b=_side_json(right),
            same_units=not self.only_left and not self.only_right,
            same_order=self.same_order,
            only_in_a=[_unit_json(left, unit) for unit in self.only_left],
            only_in_b=[_unit_json(right, unit) for unit in self.only_right],
            in_both=[_unit_json(left, unit) for unit in self.both],
            they_part_at=[
                {
                    "object": named_json(left.network, parting.object),
                    "a": _origin_json(left, parting.left, parting.object),
                    "b": _origin_json(right, parting.right, parting.object),
                }
                for parting in self.partings
            ],
        )

    def __repr__(self) -> str:
        only = f"{len(self.only_left)} only left, {len(self.only_right)} only right"
        return f"<Difference: {only}, {len(self.both)} in both>"


def _posed(
    command: Command, left: str, right: str, goals_named: Sequence[str], containers: str
) -> tuple[Side, Side]:
    """Take files, and questions in words; the data are read for files alone."""
    return (
        _posed_side(command, left, goals_named, containers),
        _posed_side(command, right, goals_named, containers),
    )


def _posed_side(command: Command, name: str, goals_named: Sequence[str], containers: str) -> Side:
    if name.split(" ", maxsplit=1)[0] != "solve" or Path(name).exists():
        return _file_side(Path(name), command.dataset, goals_named, containers)
    answer = command.ask(name, without=("certificate_file", "cross_check", "soft"))
    if isinstance(answer, Each):
        raise UserError(f"{name}: no goal is named, and it is solved for several: name one with --goal")
    assert isinstance(answer, Answer)
    if answer.units is None:
        raise NoTreeError(f"{name}: {headline(answer)}", answer.ending)
    return _side(name, answer)


def _file_side(file: Path, dataset: Dataset, goals_named: Sequence[str], containers: str) -> Side:
    """Read a tree from a file, which may be for no goal; an answer knows its own."""
    listed, goals = read_listed(file)
    data, network = dataset.data, dataset.data.network
    objects = network.objects
    if not goals:
        goals = [objects[find_goal(name, network, data.goals)] for name in goals_named]
    units = [(unit_at_level(unit, network.level), source) for unit, source in listed]
    kitchen = frozenset(objects[o] for o in data.kitchen)
    rule = container_rule(containers)
    beside = data.utensils, data.rates, network
    taken = side(str(file), units, goals, kitchen, rule, *beside, unit_prices=data.unit_prices)
    return taken._replace(starting=data.starting)


@question(
    Option(
        "left",
        "A tree: a file, or a solve command in quotes.",
        part=Part.PROBLEM,
        metavar="A",
        positional=True,
    ),
    Option("right", "The other tree, in the same way.", part=Part.PROBLEM, metavar="B", positional=True),
    GOALS,
    CONTAINERS,
    formats=TABLES,
    help_="""
    \b
    foon-asp diff mine.txt answer.json
    foon-asp diff mine.txt 'solve --goal macaroni'
    foon-asp diff 'solve --goal macaroni' 'solve --goal macaroni --objective success'

    A and B are files (FOON text, or an answer in JSON) or questions: solve with its options, in quotes. The
    kitchen, the rates and the goal of a file are those that the options name; an answer knows its goals.
    Options beside A and B also apply to a question that does not set them itself; options of data do not, if
    the question names data of its own. Without goals, the trees are followed back from everything that they
    make and do not need.

    Exits with 0 when both were compared, whether they differ or not, and with 1 when one has no tree.
    """,
    pose=_posed,
)
def diff(
    left: Answer | Tree | Side,
    right: Answer | Tree | Side,
    *,
    time_limit: float | None = None,
    on_progress: OnProgress | None = None,
    cancel: Cancel | None = None,
) -> Difference:
    """Compare two trees: what both have, what only one has, what each costs, and where they part.

    They part at an object node that both need on the way to the goals but get in different ways: from
    another unit, or one of them from the kitchen.

    Parameters:
        left: An answer, or a tree; :meth:`foon_asp.Tree.read` reads one from a file.
        right: The same.

    Returns:
        The units of ``only_left``, ``only_right`` and ``both``, and the ``partings``.

    Raises:
        UserError: for an answer without a tree.

    Example:
        >>> problem = foon_asp.load().problem("macaroni")
        >>> found = foon_asp.diff(foon_asp.retrieve(problem, "bfs").tree, foon_asp.solve(problem))
        >>> [unit.motion for unit in found.only_left]
        ['drain', 'pour']
    """
    left, right = _side("left", left), _side("right", right)
    in_left, in_right = set(left.units), set(right.units)
    goals = left.goals + right.goals or (*_ends(left), *_ends(right))
    on_right_way = set(_way(right, goals))
    partings = [
        Parting(node, left.origin(node), right.origin(node))
        for node in _way(left, goals)
        if node in on_right_way
        and (left.origin(node) != right.origin(node) or (node in left.kitchen) != (node in right.kitchen))
    ]
    return Difference(
        left,
        right,
        tuple(unit for unit in left.units if unit not in in_right),
        tuple(unit for unit in right.units if unit not in in_left),
        tuple(unit for unit in left.units if unit in in_right),
        tuple(partings),
    )


def _side(name: str, given: Answer | Tree | Side) -> Side:
    if isinstance(given, Side):
        return given
    ending = Ending.DONE
    objectives: tuple[Objective, ...] = ()
    if isinstance(given, Answer):
        ending, objectives = given.ending, given.objectives
    tree = given.tree if isinstance(given, Answer) else given
    if tree is None:
        raise NoTreeError(f"the {name} answer has no tree, so there is nothing to compare", ending)
    problem = tree.problem
    nodes = {node for unit in tree for node in (*unit.inputs, *unit.outputs)}.union(problem.goal_nodes)
    taken = side(
        name,
        list(zip(tree.units, tree.places, strict=True)),
        problem.goal_nodes,
        frozenset(filter(problem.at_hand, nodes)),
        problem.containers,
        problem.utensils,
        problem.rates,
        problem.network,
        ending,
        problem.unit_prices,
        objectives,
    )
    ids = [unit for each in tree if (unit := problem.network.unit_id(each)) is not None]
    known = problem.costs(ids).measures if len(ids) == len(tree) else {}
    measures = {each: known[each] for each in map(Objective.of_measure, problem.measures) if each in known}
    costs = Costs({**taken.costs.measures, **measures})
    return taken._replace(costs=costs, starting=problem.starting)


def side(
    name: str,
    listed: Listed,
    goals: Sequence[ObjectNode],
    kitchen: frozenset[ObjectNode],
    rule: ContainerRule,
    utensils: frozenset[str],
    rates: Mapping[str, Fraction] | None,
    network: Network,
    ending: Ending = Ending.DONE,
    unit_prices: UnitPrices | None = None,
    objectives: tuple[Objective, ...] = (),
) -> Side:
    """Take a tree as one side of a difference; its units need not be those of any network.

    Below level 3 the ``network`` says what its units stand for, and so what they need and make.
    """
    places = dict(reversed(listed))
    units = tuple(dict.fromkeys(unit for unit, _ in listed))
    needs = {unit: needed_inputs(unit, rule, utensils, network) for unit in units}
    gives = {unit: given_outputs(unit, rule, utensils, network) for unit in units}
    known = set()
    if rates is not None and all(unit.motion in rates for unit in units):
        known.add(Known.RATES)
    priced = unit_prices or UnitPrices({}, {})
    prices = {unit: priced.price(unit, network) for unit in units}
    if unit_prices is not None and None not in prices.values():
        known.add(Known.PRICES)
    taken = {node for needed in needs.values() for node in needed if node in kitchen}
    costs = tree_costs([_ListedUnit(unit, rates, prices[unit]) for unit in units], len(taken), known)
    at_hand = tuple(goals), kitchen
    return Side(name, units, places, needs, gives, *at_hand, costs, rule, network, ending, objectives)


class _ListedUnit(NamedTuple):
    """A unit of any origin, as objectives look at it."""

    unit: FunctionalUnit
    rates: Mapping[str, Fraction] | None
    known_price: Fraction | None

    @property
    def inputs(self) -> tuple[ObjectNode, ...]:
        """Its input object nodes."""
        return self.unit.inputs

    @property
    def rate(self) -> Fraction:
        """The success rate of its motion."""
        if self.rates is None:
            raise ValueError("no success rates are known")
        return self.rates[self.unit.motion]

    @property
    def price(self) -> Fraction:
        """Its price."""
        if self.known_price is None:
            raise ValueError("no price is known")
        return self.known_price

    def measure(self, name: str) -> Fraction:
        """What it costs by a measure, which says nothing of units of any origin."""
        raise ValueError(f"no measure {name} is known")


def _way(tree: Side, goals: Sequence[ObjectNode]) -> dict[ObjectNode, None]:
    """Give the nodes that a tree comes to on the way back from the goals, those near the goals first."""
    way: dict[ObjectNode, None] = {}
    frontier = list(goals)
    while frontier:
        way.update(dict.fromkeys(frontier))
        makers = (tree.origin(node) for node in frontier)
        needed = dict.fromkeys(node for maker in makers if maker for node in tree.needs[maker])
        frontier = [node for node in needed if node not in way]
    return way


def _ends(tree: Side) -> list[ObjectNode]:
    needed = {node for needs in tree.needs.values() for node in needs}
    return [node for unit in tree.units for node in tree.gives[unit] if node not in needed]


def _side_json(tree: Side) -> object:
    goals = [named_json(tree.network, goal) for goal in tree.goals]
    needed = dict.fromkeys(node for needs in tree.needs.values() for node in needs if node in tree.kitchen)
    starting = [named_json(tree.network, node) for node in needed] if tree.starting else None
    level = tree.network.level
    head = head_json(goals, tree.rule, level, tree.objectives, starting_kitchen=starting)
    return {"name": tree.name, **head, "costs": costs_json(tree.costs)}


def _unit_json(tree: Side, unit: FunctionalUnit) -> object:
    return listed_unit_json(tree.network, unit, tree.places[unit])


def _unit_text(tree: Side, unit: FunctionalUnit) -> str:
    made = [str(node) for node in tree.gives[unit] if node not in tree.needs[unit]]
    return f"{unit.motion}    [{tree.places[unit]}] makes {' and '.join(_few(made)) or 'nothing new'}"


def _few(names: list[str], shown: int = 2) -> Iterator[str]:
    yield from names[:shown]
    if len(names) > shown:
        yield f"{len(names) - shown} more"


def _origin(tree: Side, unit: FunctionalUnit | None, node: ObjectNode) -> str:
    if unit is not None:
        return f"{unit.motion}    [{tree.places[unit]}]"
    return "from the kitchen" if node in tree.kitchen else "not made"


def _origin_json(tree: Side, unit: FunctionalUnit | None, node: ObjectNode) -> object:
    if unit is not None:
        return {"unit": _unit_json(tree, unit)}
    return {"kitchen" if node in tree.kitchen else "missing": True}
