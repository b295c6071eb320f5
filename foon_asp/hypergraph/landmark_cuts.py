"""Lower bounds by LM-cut (Helmert and Domshlak 2009), looking only at actions that its cuts touch.

Landmarks are as in :mod:`foon_asp.hypergraph.cut`. The weight of each landmark is the least reduced cost of
its actions. It is subtracted from the reduced costs of all of them.

Cuts are *goal zones*. The goal zone of an object grows backwards from it through actions of reduced cost 0:
of each such action, the precondition of the greatest h-value is added. Actions that cross the zone form the
landmark.
"""

import math
from collections import deque
from collections.abc import Callable, Container, Iterable, Mapping, Sequence
from typing import NamedTuple

from foon_asp.hypergraph import tuning
from foon_asp.hypergraph.hypergraph import Hypergraph


class WeightedCut(NamedTuple):
    """A cut with its landmark and its weight.

    ``members``: the actions of the landmark.
    ``cheapest``: the landmark action of the least reduced cost when the cut was found.
    ``weight``: this least reduced cost.
    ``added_objects``, ``earlier_cut``: the cut has the ``added_objects`` and all objects of the earlier cut,
    if there is one. Such chains save memory.
    """

    added_objects: frozenset[int]
    members: tuple[int, ...]
    cheapest: int
    weight: int
    earlier_cut: "WeightedCut | None" = None

    @property
    def objects(self) -> frozenset[int]:
        """All objects of the cut, among them a target.

        They are computed anew at each access, to save memory.
        """
        objects, cut = [self.added_objects], self.earlier_cut
        while cut is not None:
            objects.append(cut.added_objects)
            cut = cut.earlier_cut
        return frozenset().union(*objects)


class Cuts(NamedTuple):
    """A cost partition over cuts.

    ``bound``: the sum of the weights of the cuts, a lower bound on the cost of every derivation.
    ``reduced_costs``: the reduced cost of actions; an action that is missing has its full cost.
    ``hopeless``: whether the allowed actions have no derivation.
    ``interrupted``: whether ctrl-C ended the search for cuts. Then the bound holds, but ``reduced_costs``
    must not be used.
    """

    bound: int
    reduced_costs: dict[int, int]
    cuts: list[WeightedCut]
    hopeless: bool = False
    interrupted: bool = False


class _Level:
    """A level of a target: some objects that every derivation of the target makes.

    The last of these objects has a goal zone.
    ``zone``: the goal zone, a set of objects that grows backwards through actions of reduced cost 0. It is
    empty at first.
    ``frontier``: the actions of reduced cost above 0 that achieve an object of the zone, as keys of a dict.
    ``earlier_cut``: the latest cut of the level below; ``None`` for the lowest level.
    ``cut``: the latest cut of this zone. Before the first one, it is ``earlier_cut``.
    """

    def __init__(self, objects: Sequence[int], earlier_cut: WeightedCut | None) -> None:
        self.objects = list(objects)
        self.earlier_cut = earlier_cut
        self.clear_zone()

    def clear_zone(self) -> None:
        """Start an empty zone without a frontier; ``cut`` becomes the earlier cut."""
        self.zone: set[int] = set()
        self.frontier: dict[int, None] = {}
        self.cut = self.earlier_cut


class _Target:
    """A target with a stack of levels. The lowest level has only the target.

    Objects of a level are made before objects of the level below. ``outer_zones`` are the objects in the
    zones of all levels except the topmost.
    """

    def __init__(self, target: int) -> None:
        self.levels = [_Level([target], None)]
        self.outer_zones: set[int] = set()

    def top_level(self, free: Container[int]) -> _Level | None:
        """Drop what is free from the top of the stack, and return the level that is then on top.

        An object is free if it can be made at reduced cost 0. Free objects at the end of the top level are
        removed, and so are levels that become empty. Return ``None`` if no level remains: the target itself
        is free.
        """
        while self.levels:
            level = self.levels[-1]
            if level.objects and level.objects[-1] not in free:
                return level
            if level.objects:
                level.objects.pop()
                level.clear_zone()
                continue
            self.levels.pop()
            if self.levels:
                self.outer_zones -= self.levels[-1].zone
        return None

    def add_level(self, needed: Sequence[int]) -> None:
        """Put a level on the stack with the objects ``needed``, the common preconditions of a landmark.

        Does nothing if ``needed`` is empty.
        """
        if needed:
            self.outer_zones |= self.levels[-1].zone
            self.levels.append(_Level(needed, self.levels[-1].cut))


def landmark_cuts(
    graph: Hypergraph,
    targets: Iterable[int],
    allowed: Container[int],
    cost: Callable[[int], int],
    h_values: Mapping[int, int],
    expired: Callable[[], bool],
    guide: Callable[[Callable[[int], int]], Mapping[int, int]] | None = None,
    max_landmark_actions: float = math.inf,
) -> Cuts:
    """Find landmark cuts by LM-cut until all targets have reduced cost 0; return the cost partition.

    ``allowed``: the only actions that count. All of them cost more than 0.
    ``h_values``: the h-value of each object; a missing one is infinite. They decide through which
    preconditions a goal zone grows.
    ``guide``: a function that computes new h-values from reduced costs. It is called whenever a certain
    number of cuts has been found. ``None`` keeps the first h-values.
    ``max_landmark_actions``: ends the search when the landmarks have about this many actions together.

    Also ends when ``expired`` returns true. If a target cannot be reached, the result is ``hopeless``. After
    ctrl-C, nothing is raised, and the result is ``interrupted``.

    Targets take turns, beginning with the greatest h-value. So the cuts of one target do not use up the costs
    that other targets need. The time is linear in the parts of the graph that cuts touch.
    """
    search = _Search(graph, allowed, cost, h_values)
    queue = deque(_Target(o) for o in sorted(targets, key=search.h_value_key, reverse=True))
    next_guide = max(tuning.CUTS.guided_cuts, len(queue))  # how many cuts there are when the guide is asked
    effort = 0
    try:
        while queue and effort < max_landmark_actions and not expired():
            target = queue.popleft()
            level = target.top_level(search.free.objects)
            if level is None:
                continue
            queue.append(target)
            if guide is not None and len(search.cuts) >= next_guide:
                search.h_values = guide(search.reduced_cost)
                waiting = sum(len(level_above.objects) for level_above in target.levels)
                next_guide = len(search.cuts) + max(
                    tuning.CUTS.guided_cuts,
                    len(queue),
                    waiting,
                    len(search.h_values) // tuning.CUTS.guides,
                )
                level.clear_zone()
            cut = search.add_cut(level, target.outer_zones)
            if cut is None:
                return Cuts(search.bound, search.reduced_costs, search.cuts, hopeless=True)
            effort += len(cut.members)
            target.add_level(search.common_preconditions(cut.members))
    except KeyboardInterrupt:
        return Cuts(search.bound, search.reduced_costs, search.cuts, interrupted=True)
    return Cuts(search.bound, search.reduced_costs, search.cuts)


class _Search:
    """The state of LM-cut: cuts so far, reduced costs, and free objects (of reduced cost 0)."""

    def __init__(
        self,
        graph: Hypergraph,
        allowed: Container[int],
        cost: Callable[[int], int],
        h_values: Mapping[int, int],
    ) -> None:
        self._graph, self._allowed, self._cost = graph, allowed, cost
        self.h_values = h_values
        self.reduced_costs: dict[int, int] = {}
        self.free = _FreeObjects(graph)
        self.cuts: list[WeightedCut] = []
        self.bound = 0

    def reduced_cost(self, action: int) -> int:
        """Return the reduced cost of an action."""
        return self.reduced_costs[action] if action in self.reduced_costs else self._cost(action)

    def h_value_key(self, o: int) -> tuple[float, int]:
        """Return a sort key of an object: its h-value, then its number."""
        return self.h_values.get(o, math.inf), o

    def add_cut(self, level: _Level, outer_zones: set[int]) -> WeightedCut | None:
        """Find the next cut of a level, record it, and subtract its weight from reduced costs; return it.

        Return ``None`` if no action crosses the zone, so that the target cannot be reached. ``outer_zones``
        are explained at :class:`_Target`.
        """
        new_objects = self._grow_zone(level, outer_zones)
        while new_objects is None:
            level.clear_zone()
            new_objects = self._grow_zone(level, outer_zones)
        needs = self._graph.needs
        members = tuple(action for action in level.frontier if level.zone.isdisjoint(needs[action]))
        if not members:
            return None
        level.frontier = dict.fromkeys(members)
        reduced_costs = {action: self.reduced_cost(action) for action in members}
        cheapest = min(reduced_costs, key=reduced_costs.__getitem__)
        weight = reduced_costs[cheapest]
        level.cut = WeightedCut(frozenset(new_objects), members, cheapest, weight, level.cut)
        self.bound += weight
        self.cuts.append(level.cut)
        for action, reduced_cost in reduced_costs.items():
            self.reduced_costs[action] = reduced_cost - weight
            if reduced_cost == weight:
                self.free.add_action(action)
        return level.cut

    def common_preconditions(self, members: Sequence[int]) -> list[int]:
        """Return the preconditions that all actions of a landmark share, the greatest h-value last.

        Free and initial objects are left out.
        """
        needs = self._graph.needs
        common = set(self.free.missing_preconditions(members[0])).intersection(
            *(needs[action] for action in members)
        )
        return sorted(common, key=self.h_value_key)

    def _grow_zone(self, level: _Level, outer_zones: set[int]) -> list[int] | None:
        """Grow the zone of a level through actions of reduced cost 0, and return its new objects.

        The zone and the frontier of the level are changed in place. Actions that need an object of
        ``outer_zones`` are skipped. Return ``None`` if an action of reduced cost 0 has only free
        preconditions: an object of the zone is then free, and the caller has to clear the zone.
        """
        needs, achievers, reduced_costs = self._graph.needs, self._graph.makers, self.reduced_costs
        zone, frontier = level.zone, level.frontier
        new_objects = [] if zone else [level.objects[-1]]
        zone.update(new_objects)
        free_actions = [action for action in frontier if not reduced_costs.get(action, True)]
        for action in free_actions:
            del frontier[action]
        i = 0
        while True:
            for action in free_actions:
                if not zone.isdisjoint(needs[action]):
                    continue
                lacking = self.free.missing_preconditions(action)
                if not lacking:
                    return None
                costliest = max(lacking, key=self.h_value_key)
                zone.add(costliest)
                new_objects.append(costliest)
            if i == len(new_objects):
                return new_objects
            free_actions = []
            for action in achievers[new_objects[i]]:
                if action in self._allowed and outer_zones.isdisjoint(needs[action]):
                    if reduced_costs.get(action, True):
                        frontier[action] = None
                    else:
                        free_actions.append(action)
            i += 1


class _FreeObjects:
    """The objects reachable by actions of reduced cost 0, updated as such actions are added."""

    def __init__(self, graph: Hypergraph) -> None:
        self._graph = graph
        self.objects: set[int] = set()
        self._missing: dict[int, int] = {}
        self._waiting: dict[int, list[int]] = {}

    def missing_preconditions(self, action: int) -> list[int]:
        """Return the preconditions of an action that are neither free nor initial."""
        free, start = self.objects, self._graph.start
        return [o for o in self._graph.needs[action] if o not in free and o not in start]

    def add_action(self, action: int) -> None:
        """Add an action of reduced cost 0.

        Once its preconditions are free, its add effects become free.
        """
        lacking = self.missing_preconditions(action)
        self._missing[action] = len(lacking)
        for o in lacking:
            self._waiting.setdefault(o, []).append(action)
        stack = [] if lacking else [action]
        while stack:
            for o in self._graph.gives[stack.pop()]:
                self.objects.add(o)
                for consumer in self._waiting.pop(o, ()):
                    self._missing[consumer] -= 1
                    if not self._missing[consumer]:
                        stack.append(consumer)
