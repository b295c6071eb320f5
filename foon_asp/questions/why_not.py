"""Why there is no tree: what cannot be made, the causes, and names one edit away."""

import contextlib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from foon_asp.dataset.paths import File, Files
from foon_asp.deadline import Cancel
from foon_asp.document.json_document import document, mention_json, nodes_json, unit_json
from foon_asp.foon import Foon
from foon_asp.network import Network, ObjectNode, counted, pattern_at_level
from foon_asp.network.near_nodes import nearest, slip_between
from foon_asp.problem import Objective, Problem
from foon_asp.problem.dead_ends import Blocked, Cause, NearName, Root, dead_ends
from foon_asp.problem.progress import OnProgress
from foon_asp.questions.arguments import Constants, settings, whole
from foon_asp.questions.contract import question
from foon_asp.questions.options import CONTAINERS, GOALS, HOW
from foon_asp.questions.result import Ending, Result
from foon_asp.report.answer import goal_lines
from foon_asp.text.object_list import ListedObject

if TYPE_CHECKING:  # clingo, which is needed where rules have a say, and for what helps
    from foon_asp.questions.clash import Clash
    from foon_asp.questions.shopping_list import ShoppingList

_ALIKE = 2  # nodes with the same label that are named beside a missing one
_OBJECTS = 12  # dead ends that are opened up in the text
_OTHERS = 2  # other units that are named beside the first
_ROOTS = 8
_STEPS = 6  # of a cycle
_STOPS = 3
_FIX_SECONDS = 10.0  # to look for what helps; the causes are known without
_FIX_ITEMS = 4  # that are named in one line


@dataclass(frozen=True, repr=False)
class Explanation(Result):
    """Why some goals cannot be made, or that all can.

    ``problem`` is the problem asked about, and ``goals`` are those that cannot be made. ``dead_ends`` has
    every object node that is needed for one of them, in any way, and cannot be had, with the units that
    would make it, first those that lack the fewest things. ``roots`` are the causes (each with its
    ``object``, ``cause``, ``stops``, ``cycle`` and ``near`` names), first those on the easiest way.
    ``available`` has a 1 for every node that is at hand or can be made. All are ids, positions in
    ``problem.network.objects``; ``json()`` has names. If all goals can be made, ``clash`` tells whether
    rules leave a tree; it is ``None`` without rules. Otherwise ``fix`` is the shortest list of things to add
    to the kitchen, rules left aside; ``None`` where none was found within some seconds.

    Example:
        >>> explanation = foon_asp.why_not(foon_asp.load().problem("apple pie"))
        >>> explanation.tree_exists, len(explanation.roots)
        (False, 1)
    """

    problem: Problem
    goals: tuple[int, ...]
    dead_ends: dict[int, tuple[Blocked, ...]]
    roots: tuple[Root, ...]
    available: bytearray
    clash: "Clash | None" = None
    fix: "ShoppingList | None" = None

    @property
    def tree_exists(self) -> bool:
        """Whether there is a tree, constraints left aside, so that nothing has to be explained."""
        return not self.goals

    @property
    def ending(self) -> Ending:
        """Done where there is a tree."""
        if self.goals:
            return Ending.NEGATIVE
        return Ending.DONE if self.clash is None else self.clash.ending

    def text(self) -> str:
        """Show the dead ends as a tree, the easiest way first and every part once, and their roots."""
        return "\n".join([*goal_lines(self.problem), *self._lines()]) + "\n"

    def _lines(self) -> Iterator[str]:
        rule = self.problem.conditions
        if self.clash is not None:
            yield from self.clash.lines()
            return
        if not self.goals:
            yield f"there is a task tree ({rule}); foon-asp solve finds the best"
            return
        causes = filter(None, (_causes(self, Cause.MISSING), _causes(self, Cause.CYCLE)))
        yield f"no task tree exists ({rule}): {' and '.join(causes)}"
        yield ""
        yield from _Tree(self).lines()
        yield ""
        shown = [root for root in self.roots if root.on_the_way][:_ROOTS]
        numbers = _numbers(self)
        yield "in the way:"
        for root in shown:
            yield from _root_lines(self.problem, root, numbers[root.object])
        if len(self.roots) > len(shown):
            yield f"{len(self.roots) - len(shown)} more behind other units; --format json lists all"
        yield _fix_line(self.problem, self.fix)

    def json_dict(self) -> object:
        """Give everything that is known of the dead ends, without the bounds of the text."""
        network = self.problem.network
        return document(
            "why-not",
            self.problem,
            tree_exists=not self.goals,
            unreachable_goals=nodes_json(network, self.goals),
            roots=[_root_json(network, root) for root in self.roots],
            dead_ends=[
                {
                    "object": nodes_json(network, [o])[0],
                    "makers": [
                        unit_json(network, blocked.unit) | {"lacks": nodes_json(network, blocked.lacks)}
                        for blocked in makers
                    ],
                }
                for o, makers in self.dead_ends.items()
            ],
            clash=None if self.clash is None else self.clash.json_dict(),
            fix=None
            if self.fix is None
            else {"items": nodes_json(network, self.fix.items), "proved": self.fix.proved},
        )


@question(
    GOALS,
    CONTAINERS,
    *HOW,
    help_="""
    \b
    foon-asp why-not --goal 'apple pie'
    foon-asp why-not --goal omelet --constraint mine.lp

    What cannot be made is shown as a tree from the goals to the causes: an object node that is missing
    in the kitchen, or a cycle of nodes that can only be made from each other. A missing node is compared
    with what is at hand and with kitchen entries that match nothing: its name may be one edit away. If the
    constraints are the reason, those that clash are listed. The last line is the cheapest fix: the fewest
    things to add to the kitchen, of those that foon-asp shopping-list has for sale.

    Exits with 0 when there is a tree, 1 when there is none, 3 when stopped at a limit.
    """,
)
def why_not(
    problem: Problem,
    *,
    constraints: Files = (),
    constants: Constants | None = None,
    encodings: File | None = None,
    time_limit: float | None = None,
    memory_limit: int | str | None = None,
    on_progress: OnProgress | None = None,
    cancel: Cancel | None = None,
) -> Explanation:
    """Explain why there is no task tree: what is missing, and which cycles feed only themselves.

    The time grows about linearly with the network, and all of a store is read. If every goal can be made and
    there are ``constraints`` or ``encodings``, those that clash are found, as by :func:`foon_asp.clash`. At a
    limit, or when interrupted, names that are near and what would help are left out.

    Returns:
        The ``goals`` that cannot be made, the ``roots`` of that, and the ``clash``.

    Raises:
        UserError: for a wrong argument or constraint.

    Example:
        >>> foon_asp.why_not(foon_asp.load().problem("apple pie"))
        <Explanation: no task tree exists (strict containers): 1 cycle feeds only itself>
    """
    how = settings(constraints, constants, encodings, time_limit, memory_limit)
    problem, deadline = whole(problem), how.begun
    with deadline.watched("looking for the reason", late=True):
        found = dead_ends(problem)
    clash = None
    if not found.goals and (how.constraints or how.replaced is not None):
        from foon_asp.questions.clash import find_clash  # noqa: PLC0415

        clash = find_clash(problem, (Objective.UNITS,), how)
    roots, fix = found.roots, None
    with contextlib.suppress(KeyboardInterrupt), deadline.watched("looking for what would help"):
        spellings = _Spellings(problem, Foon.of(problem).dataset.data.kitchen_items, found.available)
        roots = tuple(map(spellings.look_up, found.roots))
        fix = _fix(problem, time_limit) if found.goals else None
    return Explanation(problem, found.goals, found.makers, roots, found.available, clash, fix)


def _fix(problem: Problem, time_limit: float | None) -> "ShoppingList | None":
    """Find the shortest list of things to add to the kitchen, if that takes only some seconds."""
    if problem.items is not None:
        return None
    from foon_asp.questions.shopping_list import shopping_list  # noqa: PLC0415

    most = _FIX_SECONDS if time_limit is None else min(time_limit, _FIX_SECONDS)
    lists = shopping_list(problem, lists=1, time_limit=most).lists
    return lists[0] if lists else None


def _fix_line(problem: Problem, fix: "ShoppingList | None") -> str:
    if fix is None:
        return "foon-asp shopping-list with the same options says what to add to the kitchen"
    named = [str(problem.network.objects[o]) for o in fix.items[:_FIX_ITEMS]]
    if len(fix.items) > len(named):
        named.append(f"{len(fix.items) - len(named)} more")
    proved = "" if fix.proved else ", not proved the cheapest"
    return f"cheapest fix: add {' and '.join(named)} (foon-asp shopping-list says more{proved})"


class _Spellings:
    """What is at hand, to be compared with what is missing."""

    def __init__(self, problem: Problem, items: Sequence[ListedObject], available: bytearray) -> None:
        self.objects = problem.network.objects
        self.had = [o for o, there in enumerate(available) if there]
        network = problem.network
        entries = ((item.source, pattern_at_level(item.pattern, network.level)) for item in items)
        self.unmatched = [(source, pattern) for source, pattern in entries if not network.find(pattern)]

    def look_up(self, root: Root) -> Root:
        """Add near names and nodes alike to a missing node."""
        if root.cause is not Cause.MISSING:
            return root
        node = self.objects[root.object]
        ids = {self.objects[o]: o for o in self.had if self.objects[o].label == node.label}
        alike = tuple(ids[other] for other in nearest(node, ids, _ALIKE))
        near = tuple(self._near(node))
        return root._replace(near=near, alike=tuple(o for o in alike if o not in {n.object for n in near}))

    def _near(self, node: ObjectNode) -> Iterator[NearName]:
        for source, pattern in self.unmatched:
            slip = slip_between(node, pattern)
            if slip:
                yield NearName(str(pattern), slip, None, str(source))
        for o in self.had:
            slip = slip_between(node, self.objects[o])
            if slip:
                yield NearName(str(self.objects[o]), slip, o, None)


def _numbers(explanation: Explanation) -> dict[int, int]:
    """Number the roots from 1, by object; every node of a cycle has the number of its root."""
    found: dict[int, int] = {}
    for number, root in enumerate(explanation.roots, 1):
        found.update(dict.fromkeys(root.cycle.nodes if root.cycle else (), number))
        found[root.object] = number
    return found


class _Tree:
    """The dead ends, each opened up once: the first unit that would make it, and what that lacks."""

    def __init__(self, explanation: Explanation) -> None:
        self.explanation = explanation
        self.problem = explanation.problem
        self.roots = _numbers(explanation)
        self.opened = self._choose()
        self.shown: set[int] = set()
        self.shown_units: set[int] = set()

    def _choose(self) -> set[int]:
        """Choose which dead ends to open up: those near the goals first."""
        chosen: dict[int, None] = {}
        frontier = list(self.explanation.goals)
        while frontier and len(chosen) < _OBJECTS:
            following: list[int] = []
            for o in frontier:
                if o in chosen or o in self.roots or len(chosen) == _OBJECTS:
                    continue
                chosen[o] = None
                following += self.explanation.dead_ends[o][0].lacks
            frontier = following
        return set(chosen)

    def lines(self) -> Iterator[str]:
        for goal in self.explanation.goals:
            yield from self._object(goal, 0)

    def _object(self, o: int, depth: int) -> Iterator[str]:
        margin = "  " * depth
        name = str(self.problem.network.objects[o])
        if o in self.roots:
            yield f"{margin}{name}  ({self.roots[o]})"
        elif o in self.shown:
            yield f"{margin}{name}  (see above)"
        elif o not in self.opened:
            yield f"{margin}{name}  ..."
        else:
            self.shown.add(o)
            yield margin + name
            first, *others = self.explanation.dead_ends[o]
            if first.unit in self.shown_units:
                yield f"{margin}  {self._unit(first)}  (see above)"
            else:
                self.shown_units.add(first.unit)
                yield f"{margin}  {self._unit(first)}"
                for lack in first.lacks:
                    yield from self._object(lack, depth + 2)
            for blocked in others[:_OTHERS]:
                yield f"{margin}  or {self._unit(blocked)}"
            if len(others) > _OTHERS:
                yield f"{margin}  or {counted(len(others) - _OTHERS, 'other unit')}"

    def _unit(self, blocked: Blocked) -> str:
        network, needs = self.problem.network, self.problem.needs[blocked.unit]
        place = f"{network.motions[blocked.unit]}    [{network.sources[blocked.unit][0]}]"
        return f"{place} lacks {len(blocked.lacks)} of {counted(len(needs), 'input')}"


def _causes(explanation: Explanation, cause: Cause) -> str:
    """Count the roots on the easiest way with a cause."""
    count = sum(1 for root in explanation.roots if root.on_the_way and root.cause is cause)
    if not count:
        return ""
    if cause is Cause.MISSING:
        return f"{counted(count, 'object node')} {'is' if count == 1 else 'are'} missing"
    return f"{counted(count, 'cycle')} {'feeds only itself' if count == 1 else 'feed only themselves'}"


def _root_lines(problem: Problem, root: Root, number: int) -> Iterator[str]:
    objects, motions = problem.network.objects, problem.network.motions
    yield f"  ({number}) {objects[root.object]}"
    if root.cycle is not None:
        yield "      can only be made from itself, in a cycle:"
        nodes = [*(o for o, _ in root.cycle.steps), root.cycle.steps[0][0]]
        for (o, unit), made in list(zip(root.cycle.steps, nodes[1:], strict=True))[:_STEPS]:
            yield f"        {motions[unit]}    [{problem.network.sources[unit][0]}] makes {objects[made]}"
            yield f"          and needs {objects[o]}"
        if len(root.cycle.steps) > _STEPS:
            yield f"        and {counted(len(root.cycle.steps) - _STEPS, 'more step')}"
        return
    handing = problem.makers[root.object]
    skipping = [unit for unit in problem.network.producers[root.object] if unit not in handing]
    if handing:
        yield f"      not in the kitchen, and what gives it needs it too: {_units(problem, handing)}"
    else:
        yield "      not in the kitchen, and no unit makes it"
    if skipping:
        yield f"      taken as given, and so not made, by {_units(problem, skipping)}"
    others = [unit for unit in root.stops if unit not in handing]
    if others:
        yield f"      stops {_units(problem, others)}"
    for near in root.near:
        yield f"      {_near_text(problem, near)}"
    if root.alike and not root.near:
        yield f"      most like it are {' and '.join(f'{_had(problem, o)}' for o in root.alike)}"


def _units(problem: Problem, units: Sequence[int]) -> str:
    network = problem.network
    places = ", ".join(f"{network.motions[unit]} [{network.sources[unit][0]}]" for unit in units[:_STOPS])
    return places + (f" and {counted(len(units) - _STOPS, 'more unit')}" if len(units) > _STOPS else "")


def _near_text(problem: Problem, near: NearName) -> str:
    kind = f"the {near.slip.kind} {near.slip.name!r} for {near.slip.other!r}"
    if near.object is None:
        return f"a typing error? {near.place} has {near.name}, which is no node of the network: {kind}"
    return f"a typing error? {_had(problem, near.object)}: {kind}"


def _had(problem: Problem, o: int) -> str:
    return f"{problem.network.objects[o]} ({'in the kitchen' if o in problem.kitchen else 'can be made'})"


def _root_json(network: Network, root: Root) -> object:
    steps = None if root.cycle is None else root.cycle.steps
    return {
        "object": nodes_json(network, [root.object])[0],
        "cause": str(root.cause),
        "on_the_easiest_way": root.on_the_way,
        "stops": [mention_json(network, unit) for unit in root.stops],
        "cycle": steps
        and [
            {"object": nodes_json(network, [o])[0], "needed_by": mention_json(network, unit)}
            for o, unit in steps
        ],
        "near": [
            {"name": near.name, "differs_in": near.slip.kind, "kitchen_entry": near.place}
            for near in root.near
        ],
        "alike": nodes_json(network, root.alike),
    }
