"""Data that was read, and the problems that are posed of it."""

from collections.abc import Collection, Iterable, Mapping, Sequence
from fractions import Fraction

from foon_asp.errors import UserError
from foon_asp.network import FunctionalUnit, Network
from foon_asp.problem import ContainerRule, Problem
from foon_asp.text import Data, ListedObject, NodeNames, find_goal, kitchen_nodes, listed_nodes


def ask(data: Data, goals: Sequence[int], containers: str) -> Problem:
    """Ask for goals of the network under a container rule."""
    rule = ContainerRule(containers)
    return Problem(data.network, data.kitchen, tuple(goals), data.rates, data.utensils, rule)


class Dataset:
    """Data that was read, and how many seconds that took.

    Whoever asks it for goals and problems leaves the rest to it; ``data`` is everything, for those that need
    it. ``remarks`` are what was assumed while reading, in words; ``has_kitchen`` says that a kitchen was
    given, be it an empty one.
    """

    def __init__(
        self, data: Data, read_seconds: float, remarks: tuple[str, ...] = (), has_kitchen: bool = True
    ) -> None:
        self._data = data
        self.read_seconds = read_seconds
        self.remarks = remarks
        self.has_kitchen = has_kitchen

    def close(self) -> None:
        """Close the files that are read only as far as questions go; there are none here."""

    @property
    def data(self) -> Data:
        """Everything there is."""
        return self._data

    @property
    def listed(self) -> Sequence[ListedObject]:
        """The entries of the goals file."""
        return self.data.goals

    @property
    def names(self) -> Network | NodeNames:
        """What goals are looked up in."""
        return self.data.network

    @property
    def rates(self) -> Mapping[str, Fraction] | None:
        """The success rates of motions, ``None`` where none are known."""
        return self.data.rates

    @property
    def utensils(self) -> frozenset[str]:
        """The labels that the container rule ``implied`` looks at."""
        return self.data.utensils

    @property
    def motions(self) -> list[str]:
        """The motions of the network, in alphabetical order."""
        return sorted(set(self.data.network.motions))

    @property
    def kitchen(self) -> frozenset[int]:
        """The object nodes at hand, by id."""
        return self.data.kitchen

    def at_hand(self, o: int) -> bool:
        """Whether the kitchen has an object node, by id."""
        return o in self.data.kitchen

    def goals(self, names: Sequence[str]) -> tuple[int, ...]:
        """Find the goals by name; without a name, the goals file has to hold exactly one."""
        if not names and len(self.listed) == 1:
            names = [self.listed[0].pattern.label]
        if not names:
            listed = "\n".join(f"  --goal {entry.pattern.label!r}" for entry in self.listed)
            raise UserError("name a goal with --goal" + (f"; the goals file has\n{listed}" if listed else ""))
        return tuple(dict.fromkeys(self.each_goal(names)))

    def each_goal(self, names: Sequence[str]) -> list[int]:
        """Find one goal for each name; without names, all nodes of the goals file."""
        if names:
            return [find_goal(name, self.names, self.listed) for name in names]
        return [node for entry in self.listed for node in listed_nodes(entry, self.names)]

    def with_kitchen(self, items: Sequence[ListedObject]) -> "Dataset":
        """Give the same data with the kitchen of another file."""
        kitchen = kitchen_nodes(self.data.network, items)
        data = self.data._replace(kitchen=kitchen, kitchen_items=tuple(items))
        return Dataset(data, self.read_seconds)

    def varied(
        self,
        more: Collection[int],
        less: Collection[int],
        only: Collection[int] | None,
        rates: Mapping[str, Fraction] | None,
    ) -> "Dataset":
        """Give the same data with these object nodes, by id, put into the kitchen and taken out of it.

        ``only`` are all that is in the kitchen before that, where it is not ``None``; ``rates`` are those of
        all motions.
        """
        kitchen = self._data.kitchen if only is None else only
        items = self._data.kitchen_items if only is None else ()
        return Dataset(
            self._data._replace(
                kitchen=frozenset(kitchen).union(more).difference(less),
                kitchen_items=items,
                rates=None if rates is None else dict(rates),
            ),
            self.read_seconds,
        )

    def kitchen_changes(self, problem: Problem) -> tuple[frozenset[int], frozenset[int]]:
        """Give what a problem posed of this data has in its kitchen beyond it, and what it lacks.

        Ids are those of the whole network.
        """
        ours, theirs = self.data.kitchen, problem.kitchen
        return (frozenset(), frozenset()) if ours is theirs else (theirs - ours, ours - theirs)

    def problem(self, goals: Sequence[int], containers: str, everything: bool = False) -> Problem:
        """Ask for goals, which are those of the problem in the same order, under a container rule.

        ``everything`` asks for units that no goal needs to be there too.
        """
        return ask(self.data, goals, containers)

    def part(
        self, goals: Sequence[int], units: Iterable[int] = (), tree: Iterable[FunctionalUnit] = ()
    ) -> tuple[Data, tuple[int, ...]]:
        """Give data with at least these goals, these units by id, and what a tree is made of.

        With it come the ids that the goals have there. Raises :class:`UserError` for ids of no unit.
        """
        self._check_units(units, len(self.data.network))
        return self.data, tuple(goals)

    def _check_units(self, units: Iterable[int], count: int) -> None:
        for unit in units:
            if not 0 <= unit < count:
                raise UserError(f"there is no unit {unit}: the network has units 0 to {count - 1}")
