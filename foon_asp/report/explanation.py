"""Why there is no tree, for people and for programs."""

import json
from collections.abc import Iterator, Sequence

from foon_asp.explain.why_not import Blocked, Cause, Explanation, NearName, Root
from foon_asp.problem import Problem
from foon_asp.report.answer import counted, goal_lines, unit_json

_OBJECTS = 12  # dead ends that are opened up in the text
_OTHERS = 2  # other units that are named beside the first
_ROOTS = 8
_STEPS = 6  # of a cycle
_STOPS = 3


def explanation_text(explanation: Explanation) -> str:
    """Show the dead ends as a tree, the easiest way first and every part once, and what is at their root."""
    problem = explanation.problem
    if not explanation.goals:
        return "\n".join([*goal_lines(problem), f"there is a task tree ({problem.conditions})"]) + "\n"
    roots = explanation.roots
    causes = [_causes(explanation, Cause.MISSING), _causes(explanation, Cause.CYCLE)]
    lines = [
        *goal_lines(problem),
        f"no task tree exists ({problem.conditions}): {' and '.join(filter(None, causes))}",
    ]
    lines += ["", *_Tree(explanation).lines(), ""]
    shown = [root for root in roots if root.on_the_way][:_ROOTS]
    lines.append("in the way:")
    for root in shown:
        lines += _root_lines(explanation, root, numbers(explanation)[root.object])
    if len(roots) > len(shown):
        lines.append(
            f"{counted(len(roots) - len(shown), 'more')} behind other units; --format json lists all"
        )
    return "\n".join(lines) + "\n"


def explanation_json(explanation: Explanation) -> str:
    """Give :func:`explanation_dict` as JSON."""
    return json.dumps(explanation_dict(explanation), indent=2, ensure_ascii=False) + "\n"


def explanation_dict(explanation: Explanation) -> dict[str, object]:
    """Give everything that is known of the dead ends, without the bounds of the text."""
    problem = explanation.problem
    network = problem.network
    objects = network.objects
    return {
        "goals": [str(objects[goal]) for goal in problem.goals],
        "containers": str(problem.containers),
        "level": network.level,
        "tree_exists": not explanation.goals,
        "unreachable_goals": [str(objects[goal]) for goal in explanation.goals],
        "roots": [
            {
                "object": str(objects[root.object]),
                "cause": str(root.cause),
                "on_the_easiest_way": root.on_the_way,
                "stops": [_place(problem, unit) for unit in root.stops],
                "cycle": None
                if root.cycle is None
                else [
                    {"object": str(objects[o]), "needed_by": _place(problem, unit)}
                    for o, unit in root.cycle.steps
                ],
                "near": [
                    {"name": near.name, "differs_in": near.slip.kind, "kitchen_entry": near.place}
                    for near in root.near
                ],
                "alike": [str(objects[o]) for o in root.alike],
            }
            for root in explanation.roots
        ],
        "dead_ends": [
            {
                "object": str(objects[o]),
                "makers": [
                    {
                        **unit_json(network, blocked.unit),
                        "lacks": [str(objects[lack]) for lack in blocked.lacks],
                    }
                    for blocked in makers
                ],
            }
            for o, makers in explanation.dead_ends.items()
        ],
    }


def numbers(explanation: Explanation) -> dict[int, int]:
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
        self.roots = numbers(explanation)
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


def _root_lines(explanation: Explanation, root: Root, number: int) -> Iterator[str]:
    problem = explanation.problem
    objects, motions = problem.network.objects, problem.network.motions
    yield f"  ({number}) {objects[root.object]}"
    if root.cycle is not None:
        yield "      can only be made from itself; round it goes:"
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
        return f"a slip of the pen? {near.place} has {near.name}, which is no node of the network: {kind}"
    return f"a slip of the pen? {_had(problem, near.object)}: {kind}"


def _had(problem: Problem, o: int) -> str:
    return f"{problem.network.objects[o]} ({'in the kitchen' if o in problem.kitchen else 'can be made'})"


def _place(problem: Problem, unit: int) -> dict[str, object]:
    source = problem.network.sources[unit][0]
    return {"id": unit, "motion": problem.network.motions[unit], "file": source.file, "line": source.line}
