"""E-graphs in the JSON of egraph-serialize: extraction as a task, and the greedy extractor of extraction-gym.

An e-class is a fact, an e-node an action that gives its class and needs those of its children, at its cost;
all roots are wanted; where a file names none, the classes that no node has as a child. Each node counts once,
which is DAG extraction. Costs are the decimals of the text, and 1 for a node without one. A
node that has its own class among its children, or an infinite cost, is of no use and left out.

A negative cost is a reward for a class that is reached. It is taken where its node is the only one of its
class and has no children, and where only classes refer to it that each extraction has: these are chosen
exactly once, so the reward that is missed can be paid instead. What is paid is then a constant more than what
the extraction costs: ``offset``. Choosing two nodes of such a class costs more than all they could save.
"""

import json
from collections import defaultdict, deque
from collections.abc import Iterable
from fractions import Fraction
from functools import cached_property
from pathlib import Path
from typing import Any, NamedTuple

from foon_asp.network import Source
from foon_asp.planning.strips_task import StripsAction, StripsTask


class ENode(NamedTuple):
    """A node by name: the class that it is of, those of its children, and its cost."""

    name: str
    eclass: str
    children: tuple[str, ...]
    cost: Fraction


class EGraph:
    """The nodes that are of use, and the classes that are wanted."""

    def __init__(self, name: str, nodes: Iterable[ENode], roots: Iterable[str]) -> None:
        self.name = name
        self.nodes = tuple(nodes)
        self.roots = tuple(dict.fromkeys(roots))

    @classmethod
    def read(cls, file: Path) -> "EGraph":
        """Read a file; raises :class:`ValueError` for one that is none."""
        text = file.read_text(encoding="utf-8")
        found: Any = json.loads(text, parse_float=str, parse_int=str, parse_constant=str)
        try:
            classes = {name: str(node["eclass"]) for name, node in found["nodes"].items()}
            nodes = []
            for name, node in found["nodes"].items():
                children = tuple(dict.fromkeys(classes[child] for child in node.get("children", ())))
                cost = node.get("cost", "1")
                if cost not in (None, "Infinity") and classes[name] not in children:
                    nodes.append(ENode(name, classes[name], children, Fraction(cost)))
            used = {child for node in nodes for child in node.children}
            top = [eclass for eclass in dict.fromkeys(classes.values()) if eclass not in used]
            return cls(file.stem, nodes, map(str, found.get("root_eclasses") or top))
        except (KeyError, TypeError, AttributeError) as error:
            raise ValueError(f"{file}: expected an e-graph, but {error!r}") from None

    @cached_property
    def members(self) -> dict[str, list[ENode]]:
        """The nodes of each class."""
        found: defaultdict[str, list[ENode]] = defaultdict(list)
        for node in self.nodes:
            found[node.eclass].append(node)
        return found

    def always(self) -> set[str]:
        """Give classes that every extraction has: the roots, and what all nodes of such a class need."""
        found = set(self.roots)
        left = list(found)
        while left:
            sides = [set(node.children) for node in self.members.get(left.pop(), ())]
            fresh = set.intersection(*sides).difference(found) if sides else set()
            found |= fresh
            left += fresh
        return found

    def task(self) -> tuple[StripsTask, Fraction]:
        """Give the question, and how much less than its answer the extraction costs.

        Raises :class:`ValueError` for a negative cost elsewhere than where it can be taken.
        """
        rewards = self._rewards()
        numbers: dict[str, int] = {}
        actions = []

        def of(eclass: str) -> int:
            return numbers.setdefault(eclass, len(numbers))

        dearer: dict[str, Fraction] = {}
        for eclass, nodes in self.members.items():
            saved = [sum((rewards[c] for c in n.children if c in rewards), Fraction(0)) for n in nodes]
            if any(saved):
                dearer[eclass] = max(saved) + 1
        for line, node in enumerate(self.nodes, 1):
            if node.eclass in rewards:
                continue
            needs = [of(child) for child in node.children if child not in rewards]
            gives = [of(node.eclass), *(of(child) for child in node.children if child in rewards)]
            cost = node.cost + dearer.get(node.eclass, 0)
            actions.append(StripsAction(node.name, needs, gives, cost, Source(self.name, line)))
        for line, (eclass, reward) in enumerate(rewards.items(), len(self.nodes) + 1):
            actions.append(
                StripsAction(f"without {eclass}", (), [of(eclass)], reward, Source(self.name, line))
            )
        offset = sum(dearer.values(), Fraction(0)) + sum(rewards.values(), Fraction(0))
        goals = tuple(of(root) for root in (*self.roots, *rewards))
        return StripsTask(self.name, tuple(numbers), actions, frozenset(), goals), offset

    def _rewards(self) -> dict[str, Fraction]:
        found: dict[str, Fraction] = {}
        negative = {node.eclass for node in self.nodes if node.cost < 0}
        if not negative:
            return found
        always = self.always()
        users = {child: set[str]() for child in negative}
        for node in self.nodes:
            for child in negative.intersection(node.children):
                users[child].add(node.eclass)
        for eclass in sorted(negative):
            node, *others = self.members[eclass]
            if others or node.children or eclass in self.roots or not users[eclass] <= always:
                raise ValueError(f"{self.name}: the class {eclass} has a negative cost that cannot be taken")
            found[eclass] = -node.cost
        return found

    def cost(self, chosen: dict[str, ENode]) -> Fraction:
        """Give what an extraction costs that has a node for each class."""
        reached = dict.fromkeys(self.roots)
        left = list(reached)
        while left:
            fresh = [child for child in chosen[left.pop()].children if child not in reached]
            reached.update(dict.fromkeys(fresh))
            left += fresh
        return sum((chosen[eclass].cost for eclass in reached), Fraction(0))

    def greedy(self) -> Fraction | None:
        """Give what the gym's ``faster-greedy-dag`` finds, ``None`` where a root cannot be extracted.

        Each class keeps the cheapest set of classes with their costs known so far; a node's set is its own
        cost with the union of its children's, and classes are looked at again when a child's got cheaper.
        """
        users: defaultdict[str, list[ENode]] = defaultdict(list)
        for node in self.nodes:
            for child in node.children:
                users[child].append(node)
        best: dict[str, tuple[float, dict[str, float], ENode]] = {}
        waiting = deque(node for node in self.nodes if not node.children)
        queued = {node.name for node in waiting}
        while waiting:
            node = waiting.popleft()
            queued.discard(node.name)
            if any(child not in best or node.eclass in best[child][1] for child in node.children):
                continue
            costs: dict[str, float] = {}
            for child in node.children:
                costs.update(best[child][1])
            costs[node.eclass] = float(node.cost)
            total = sum(costs.values())
            if node.eclass not in best or total < best[node.eclass][0]:
                best[node.eclass] = total, costs, node
                for user in users[node.eclass]:
                    if user.name not in queued:
                        queued.add(user.name)
                        waiting.append(user)
        if any(root not in best for root in self.roots):
            return None
        return self.cost({eclass: node for eclass, (_, _, node) in best.items()})
