"""Why there is no tree: what cannot be made, the causes, and names one edit away; or rules that clash."""

import contextlib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Annotated, NamedTuple, Unpack

from msgspec import UNSET, UnsetType
from msgspec.structs import replace

from foon_asp.dataset import Dataset
from foon_asp.dataset.paths import File
from foon_asp.json_layout import schema_name
from foon_asp.network import STAND_IN, NodePattern, ObjectNode, StandInTable, counted, pattern_at_level
from foon_asp.network.slip import nearest_nodes, slip_between
from foon_asp.problem import Objective, Problem
from foon_asp.problem.dead_ends import Cause, DeadEnds, RootCause, dead_ends
from foon_asp.problem.for_sale import Shop
from foon_asp.questions.ending import Ending
from foon_asp.questions.options import CONTAINERS, GOALS
from foon_asp.questions.python_arguments import constraint_weights, over_whole_network
from foon_asp.questions.python_options import CommonOptions, settings_of
from foon_asp.questions.question import Kind, Option, question
from foon_asp.questions.result import Result
from foon_asp.questions.stand_in import StandIn, stand_ins_in
from foon_asp.results.document import AboutGoals
from foon_asp.results.table import Block
from foon_asp.results.values import Mention, Node, Unit, Value
from foon_asp.results.values_of import mention_of, node_as, node_of, nodes_of, question_fields, unit_as
from foon_asp.standins import with_stand_ins

if TYPE_CHECKING:  # takes clingo along, which only rules need
    from foon_asp.asp import Settings
    from foon_asp.questions.clash import Clash


class _MaxShown(NamedTuple):
    """The greatest numbers that an explanation shows as text; its JSON has everything.

    ``roots``: causes that are explained.
    ``dead_ends``: dead ends that are expanded.
    ``other_units``: achievers of a node, beside the first.
    ``steps``: steps of a cycle.
    ``units``: units in one line.
    ``fix_items``: nodes to add to the kitchen.
    ``alike``: nodes with the same label as a missing node.
    """

    roots: int = 8
    dead_ends: int = 12
    other_units: int = 2
    steps: int = 6
    units: int = 3
    fix_items: int = 4
    alike: int = 2


_MAX_SHOWN = _MaxShown()


class NearName(Value, frozen=True):
    """A name that is one edit away from the name of a missing node.

    Attributes:
        name: A node of the network, or an entry of the kitchen file that matches no node.
        differs_in: The part that differs: label, state, relation, container or ingredient.
        kitchen_entry: Where the kitchen file has the entry; null for a node of the network.
        missing_part: The differing part of the missing node.
        near_part: The differing part of the name.
        in_kitchen: Whether the name is in the kitchen; otherwise it can be made.
    """

    name: str
    differs_in: str
    kitchen_entry: str | None
    missing_part: str
    near_part: str
    in_kitchen: bool

    def __str__(self) -> str:
        shown = f"{self.name} {_origin_text(self.in_kitchen)}"
        if self.kitchen_entry is not None:
            shown = f"{self.kitchen_entry} has {self.name}, which is no node of the network"
        return f"{shown}: the {self.differs_in} {self.missing_part!r} for {self.near_part!r}"


class AlikeNode(Node, frozen=True, kw_only=True):
    """A node with the label of a missing one.

    Attributes:
        in_kitchen: Whether it is in the kitchen; otherwise it can be made.
    """

    in_kitchen: bool


class CycleStep(Value, frozen=True):
    """A node of a cycle, and a unit that needs it. The unit makes the node of the next step."""

    object: Node
    needed_by: Mention


class Root(Value, frozen=True):
    """A reason why goals cannot be made: an object node that is missing or can only be made from itself.

    Attributes:
        cause: missing: it is not in the kitchen and no unit makes it; cycle: it can only be made from itself.
        on_the_easiest_way: Whether it is on the path to the goals that lacks the fewest nodes.
        stops: The units that lack it.
        handed_on_by: The units that make a missing node and need it, too.
        taken_as_given_by: The units that have a missing node among their outputs, but take it as given by the
            container rule.
        cycle: The steps once around the cycle; null for a missing node.
        cycle_objects: All object nodes that can only be made from each other; empty for a missing node.
        near: Names that are one edit away.
        alike: Nodes with the same label that are in the kitchen or can be made.
    """

    object: Node
    cause: Cause
    on_the_easiest_way: bool
    stops: tuple[Mention, ...]
    handed_on_by: tuple[Mention, ...]
    taken_as_given_by: tuple[Mention, ...]
    cycle: tuple[CycleStep, ...] | None
    cycle_objects: tuple[Node, ...]
    near: tuple[NearName, ...] = ()
    alike: tuple[AlikeNode, ...] = ()

    @classmethod
    def of(cls, problem: Problem, root: RootCause) -> "Root":
        """Return a cause as a value for a result; ``near`` and ``alike`` are still empty."""
        network = problem.network
        makers = problem.makers[root.object] if root.cycle is None else ()
        producers = network.producers[root.object] if root.cycle is None else ()
        stops, handed, skipped = (
            tuple(mention_of(network, unit) for unit in units)
            for units in (root.stops, makers, (unit for unit in producers if unit not in makers))
        )
        steps, nodes = root.cycle or ((), frozenset())
        cycle = tuple(CycleStep(node_of(network, o), mention_of(network, unit)) for o, unit in steps)
        return cls(
            node_of(network, root.object),
            root.cause,
            root.on_the_way,
            stops,
            handed,
            skipped,
            cycle or None,
            nodes_of(network, sorted(nodes)),
        )

    def lines(self) -> Iterator[str]:
        """Yield lines on why the node cannot be had, and similar names that were perhaps meant.

        Nodes with the same label are named only if no name is one edit away.
        """
        if self.cycle is not None:
            yield "can only be made from itself, in a cycle:"
            made = [*(step.object for step in self.cycle[1:]), self.cycle[0].object]
            for step, node in list(zip(self.cycle, made, strict=True))[: _MAX_SHOWN.steps]:
                yield f"  {step.needed_by} makes {node}"
                yield f"    and needs {step.object}"
            if len(made) > _MAX_SHOWN.steps:
                yield f"  and {counted(len(made) - _MAX_SHOWN.steps, 'more step')}"
            return
        if self.handed_on_by:
            yield f"not in the kitchen, and what gives it needs it too: {_units_text(self.handed_on_by)}"
        else:
            yield "not in the kitchen, and no unit makes it"
        if self.taken_as_given_by:
            yield f"taken as given, and so not made, by {_units_text(self.taken_as_given_by)}"
        if stopped := [unit for unit in self.stops if unit not in self.handed_on_by]:
            yield f"stops {_units_text(stopped)}"
        yield from (f"a typing error? {name}" for name in self.near)
        if self.alike and not self.near:
            shown = (f"{node} {_origin_text(node.in_kitchen)}" for node in self.alike)
            yield f"most like it are {' and '.join(shown)}"


class BlockedUnit(Unit, frozen=True, kw_only=True):
    """A unit that cannot run.

    Attributes:
        lacks: The inputs that it needs and that cannot be had.
    """

    lacks: tuple[Node, ...]

    def __str__(self) -> str:
        shown = f"{self.motion}    [{self.source[0]}]"
        return f"{shown} lacks {len(self.lacks)} of {counted(len(self.inputs), 'input')}"


class DeadEnd(Value, frozen=True):
    """An object node that a goal needs and that cannot be had.

    Attributes:
        makers: The units that would make it; those that lack the fewest nodes come first.
    """

    object: Node
    makers: tuple[BlockedUnit, ...]


class Explanation(Result, AboutGoals, frozen=True, kw_only=True, tag=schema_name("why-not")):
    """Why some goals cannot be made, or that all can.

    Attributes:
        tree_exists: Whether there is a tree if rules are ignored.
        unreachable_goals: The goals that cannot be made.
        roots: The causes; those on the easiest path to the goals come first.
        dead_ends: Every object node that cannot be had and that some path to an unreachable goal needs.
        clash: If all goals can be made and there are rules: whether these leave a tree, and which clash.
        fix: A few nodes to add to the kitchen so that the goals can be made without rules. Null if all can be
            made, or if a limit came first. A shorter list may exist.
        stand_ins: The cheapest stand-ins of the usual table with which the goals can be made without rules.
            Left out if none are enough, or if stand-ins are allowed already.

    Example:
        >>> explanation = foon_asp.why_not(foon_asp.load().problem("apple pie"))
        >>> explanation.tree_exists, [str(root.object) for root in explanation.roots]
        (False, ['pie crust; rolled'])
    """

    ROWS = "roots"

    tree_exists: bool
    unreachable_goals: tuple[Node, ...]
    roots: tuple[Root, ...]
    dead_ends: tuple[DeadEnd, ...]
    clash: "Clash | None" = None
    fix: tuple[Node, ...] | None = None
    stand_ins: tuple[StandIn, ...] | UnsetType = UNSET

    @property
    def ending(self) -> Ending:
        """``DONE`` if there is a tree that keeps to the rules, ``NEGATIVE`` if not, else ``LIMIT``."""
        if not self.tree_exists:
            return Ending.NEGATIVE
        return Ending.DONE if self.clash is None else self.clash.ending

    def show(self) -> Iterator[Block]:
        """Return the dead ends as an indented tree, and the causes; or the rules that clash.

        If there is a tree and there are no rules, one line says so.
        """
        yield from self.goal_lines()
        if self.clash is not None:
            yield from self.clash.lines(self.conditions)
            return
        if self.tree_exists:
            yield f"there is a task tree ({self.conditions}); foon-asp solve finds the best"
            return
        shown = [root for root in self.roots if root.on_the_easiest_way]
        yield f"no task tree exists ({self.conditions}): {_causes_text(shown)}"
        numbers: dict[Node, int] = {}
        for number, root in enumerate(self.roots, 1):
            numbers |= dict.fromkeys((root.object, *root.cycle_objects), number)
        yield from ("", *_dead_end_lines(self, numbers), "", "in the way:")
        for root in shown[: _MAX_SHOWN.roots]:
            yield f"  ({numbers[root.object]}) {root.object}"
            yield from (f"      {line}" for line in root.lines())
        if len(self.roots) > min(len(shown), _MAX_SHOWN.roots):
            others = len(self.roots) - min(len(shown), _MAX_SHOWN.roots)
            yield f"{others} more behind other units; --format json lists all"
        yield self._fix_line()
        if isinstance(self.stand_ins, tuple):
            yield "or let others stand in (foon-asp solve --stand-ins proves the least different ones):"
            for stand_in in self.stand_ins:
                yield f"  {stand_in.used}"
                yield f"    for {stand_in.stands_in_for}"

    def _fix_line(self) -> str:
        """Return one line on which nodes to add to the kitchen, or on how to find them.

        Up to four nodes are named, and the others counted.
        """
        if self.fix is None:
            return "foon-asp shopping-list with the same options says what to add to the kitchen"
        named = [str(node) for node in self.fix[: _MAX_SHOWN.fix_items]]
        if len(self.fix) > len(named):
            named.append(f"{len(self.fix) - len(named)} more")
        return f"try adding {' and '.join(named)} (foon-asp shopping-list proves the shortest list)"


@question(
    GOALS,
    CONTAINERS,
    help_="""
    \b
    foon-asp why-not --goal 'apple pie'
    foon-asp why-not --goal omelet --constraint mine.lp --constraint yours.lp
    foon-asp why-not --goal omelet --constraint mine.lp --constraint yours.lp --weight mine.lp=10

    What cannot be made is shown as a tree from the goals to the causes: an object node that is missing
    in the kitchen, or a cycle of nodes that can only be made from each other. A missing node is compared
    with what is at hand and with kitchen entries that match nothing: its name may be one edit away. The last
    line has a few things to add to the kitchen; foon-asp shopping-list finds the fewest.

    If every goal can be made, the constraints may be the reason: every rule without a head (:- ...) is a
    constraint of its own, and other rules of the files always hold. A smallest set that clashes is found, and
    the cheapest constraints to drop. Both sets are proved.

    Exits with 0 when there is a tree, 1 when there is none, 3 when stopped at a limit.
    """,
)
def why_not(
    problem: Problem,
    *,
    weights: Annotated[
        Mapping[File, int] | None,
        Option(kind=Kind.WEIGHTS, flags=("--weight",), many=True, metavar="FILE.lp=WEIGHT"),
    ] = None,
    **options: Unpack[CommonOptions],
) -> Explanation:
    """Explain why there is no task tree: missing things, cycles that feed only themselves, rules that clash.

    The time grows about linearly with the network, and all of a store is read. If every goal can be made and
    there are ``constraints`` or ``encodings``, those that clash are found. At a limit, or when interrupted,
    similar names, stand-ins and the items that would help are left out.

    Parameters:
        weights: What it costs to drop a constraint of a file, 1 if not given.

    Returns:
        The goals that cannot be made (``unreachable_goals``), the ``roots`` of that, and the ``clash``.

    Raises:
        UserError: for a wrong argument or constraint.

    Example:
        >>> foon_asp.why_not(foon_asp.load().problem("apple pie"))
        <Explanation: no task tree exists (strict containers): 1 cycle feeds only itself>
        >>> ice = foon_asp.load().problem("ice")
        >>> rules = ["forbid_motion", "require_motion"]
        >>> motions = {"forbidden_motion": "crush", "required_motion": "crush"}
        >>> found = foon_asp.why_not(ice, constraints=rules, constants=motions).clash
        >>> len(found.smallest_clash), len(found.cheapest_to_drop)
        (2, 1)
    """
    settings, weight_of_constraint = settings_of(options), constraint_weights(weights) if weights else {}
    problem, deadline = over_whole_network(problem), settings.effective_deadline
    network = problem.network
    with deadline.watched("looking for the reason", late=True):
        analysis = dead_ends(problem)
        dead_end_values = tuple(
            DeadEnd(
                node_of(network, o),
                tuple(
                    unit_as(BlockedUnit, network, unit, lacks=nodes_of(network, lacks))
                    for unit, lacks in makers
                ),
            )
            for o, makers in analysis.makers.items()
        )
        roots = tuple(Root.of(problem, root) for root in analysis.roots)
    clash, fix = None, None
    stand_ins: tuple[StandIn, ...] | UnsetType = UNSET
    if not analysis.goals and (settings.constraints or settings.replaced is not None):
        from foon_asp.questions.clash import find_clash  # noqa: PLC0415

        clash = find_clash(problem, settings, weight_of_constraint)
    with contextlib.suppress(KeyboardInterrupt), deadline.watched("looking for what would help"):
        if analysis.goals:
            roots = tuple(_with_near_names(problem, analysis, roots))
            fix = nodes_of(network, Shop(problem).short_list(analysis))
            stand_ins = _cheapest_stand_ins(problem, settings)
    return Explanation(
        **question_fields(problem),
        tree_exists=not analysis.goals,
        unreachable_goals=nodes_of(network, analysis.goals),
        roots=roots,
        dead_ends=dead_end_values,
        clash=clash,
        fix=fix,
        stand_ins=stand_ins,
    )


def _cheapest_stand_ins(problem: Problem, settings: "Settings") -> tuple[StandIn, ...] | UnsetType:
    """Return the cheapest stand-ins of the usual table with which there is a tree without rules.

    If a limit stops the search, return the cheapest found so far. Return ``UNSET`` if there are none. Return
    ``UNSET``, too, if stand-ins cannot be used: below level 3, if items are used up, or if the problem has
    stand-ins already.
    """
    level, has_motion = problem.network.level, STAND_IN in problem.network.different_motions
    if level < 3 or problem.items is not None or has_motion:
        return UNSET
    from foon_asp.asp.optimum import solve  # noqa: PLC0415 (only where there is no tree)

    posed = with_stand_ins(problem, StandInTable.usual())
    settings_without_rules = settings._replace(constraints=(), constants=(), encodings=None)
    outcome = solve(posed, (Objective.DISSIMILARITY,), settings_without_rules)
    return UNSET if outcome.units is None else stand_ins_in(posed, outcome.units)


def _with_near_names(problem: Problem, analysis: DeadEnds, roots: Iterable[Root]) -> Iterator[Root]:
    """Yield the causes; missing nodes get similar names that were perhaps meant, cycles are unchanged.

    Names one edit away (``near``) are nodes that are in the kitchen or can be made, and entries of the
    kitchen file that match no node. Up to two other nodes have the same label (``alike``).
    """
    network, kitchen, origin = problem.network, problem.kitchen, problem.origin
    ids_available = {
        network.objects[o]: o for o, is_available in enumerate(analysis.available) if is_available
    }
    items = origin.data.kitchen_items if isinstance(origin, Dataset) else ()
    patterns = [(pattern_at_level(item.pattern, network.level), str(item.source)) for item in items]
    names: list[tuple[ObjectNode | NodePattern, str | None, bool]] = [
        *((pattern, source, True) for pattern, source in patterns if not network.find(pattern)),
        *((node, None, o in kitchen) for node, o in ids_available.items()),
    ]
    for root, value in zip(analysis.roots, roots, strict=True):
        if root.cause is not Cause.MISSING:
            yield value
            continue
        node = network.objects[root.object]
        near_names = tuple(
            NearName(str(other), slip.kind, source, slip.name, slip.other, in_kitchen)
            for other, source, in_kitchen in names
            if (slip := slip_between(node, other))
        )
        nodes_near = {near_name.name for near_name in near_names if near_name.kitchen_entry is None}
        alike = tuple(
            node_as(AlikeNode, network, ids_available[other], in_kitchen=ids_available[other] in kitchen)
            for other in nearest_nodes(node, ids_available, _MAX_SHOWN.alike)
            if str(other) not in nodes_near
        )
        yield replace(value, near=near_names, alike=alike)


def _dead_end_lines(explanation: Explanation, numbers: Mapping[Node, int]) -> Iterator[str]:
    """Yield the dead ends as an indented tree of lines; the unreachable goals are its roots.

    Below a node are its first achiever and the inputs that this unit lacks, and then a line for each other
    achiever. Nothing is below a cause, which has its number in ``numbers``. Of the other nodes, up to 12 are
    expanded, each once; nodes nearest to the goals come first.
    """
    makers = {end.object: end.makers for end in explanation.dead_ends}
    expanded: set[Node] = set()
    frontier = list(explanation.unreachable_goals)
    for node in frontier:
        if node not in expanded and node not in numbers and len(expanded) < _MAX_SHOWN.dead_ends:
            expanded.add(node)
            frontier += makers[node][0].lacks
    shown_values: set[Value] = set()

    def lines(node: Node, margin: str) -> Iterator[str]:
        """Yield the lines of a node and of the nodes below it, each behind the spaces of ``margin``."""
        if node in numbers or node in shown_values or node not in expanded:
            reference = "(see above)" if node in shown_values else "..."
            yield f"{margin}{node}  {f'({numbers[node]})' if node in numbers else reference}"
            return
        first, *others = makers[node]
        is_shown = first in shown_values
        yield from (f"{margin}{node}", f"{margin}  {first}{'  (see above)' if is_shown else ''}")
        shown_values.update((node, first))
        for lack in () if is_shown else first.lacks:
            yield from lines(lack, f"{margin}    ")
        yield from (f"{margin}  or {other}" for other in others[: _MAX_SHOWN.other_units])
        if len(others) > _MAX_SHOWN.other_units:
            yield f"{margin}  or {counted(len(others) - _MAX_SHOWN.other_units, 'other unit')}"

    for goal in explanation.unreachable_goals:
        yield from lines(goal, "")


def _causes_text(roots: Sequence[Root]) -> str:
    """Return in words how many nodes are missing, and how many cycles feed only themselves."""
    cycles = sum(root.cycle is not None for root in roots)
    missing = len(roots) - cycles
    counts = []
    if missing:
        counts.append(f"{counted(missing, 'object node')} {'is' if missing == 1 else 'are'} missing")
    if cycles:
        feeds = "feeds only itself" if cycles == 1 else "feed only themselves"
        counts.append(f"{counted(cycles, 'cycle')} {feeds}")
    return " and ".join(counts)


def _units_text(units: Sequence[Mention]) -> str:
    """Return the motions of the first three units with their places, and how many units follow."""
    mentioned = ", ".join(f"{unit.motion} [{unit.source[0]}]" for unit in units[: _MAX_SHOWN.units])
    return mentioned + (
        f" and {counted(len(units) - _MAX_SHOWN.units, 'more unit')}" if len(units) > _MAX_SHOWN.units else ""
    )


def _origin_text(in_kitchen: bool) -> str:
    """Return in parentheses whether a node is in the kitchen or can be made."""
    return "(in the kitchen)" if in_kitchen else "(can be made)"
