"""Data that was loaded: a FOON, a kitchen and what stands beside them."""

import difflib
from collections.abc import Iterable, Mapping, Sequence
from fractions import Fraction
from os import PathLike
from pathlib import Path
from typing import Self

from foon_asp.api.arguments import File, Files, Number, container_rule, files, success_rate
from foon_asp.api.problem import Problem, taken
from foon_asp.api.warning import warn
from foon_asp.dataset import Dataset, ask, dataset_files, read_dataset
from foon_asp.errors import UserError
from foon_asp.network import Network, ObjectNode, TaskTree, node_at_level, pattern_at_level
from foon_asp.text import Data, GoalError, Wording, find_goal, kitchen_item_warning, read_object_list

Names = str | ObjectNode | Iterable[str | ObjectNode]
"""One object node or several: labels, one-line notation (``ice; crushed; in [drinking glass]``), or nodes."""


def load(
    source: Files | None = None,
    *,
    kitchen: File | None = None,
    rates: File | None = None,
    utensils: File | None = None,
    goals: File | None = None,
    level: int = 3,
    lenient: bool = False,
) -> "Foon":
    """Load a FOON and what stands beside it.

    ``source`` is a folder with all of it, a network (FOON text or JSON), several of them, which are merged,
    or a store; without it, the bundled kitchen. The other files take the place of those of the folder.
    ``level`` says what counts of an object node: 3 all of it, 2 without contents, 1 the label. With
    ``lenient`` lines that are not understood are left out.

    Of a store, nothing but its indexes is read yet; :meth:`Foon.problem` reads what can matter for the
    goals. What was assumed while reading is warned of (:class:`FoonWarning`) and in :attr:`Foon.warnings`.
    Raises :class:`UserError` for what cannot be read.
    """
    if level not in {1, 2, 3}:
        raise UserError(f"found level={level!r}, expected 1, 2 or 3")
    paths = () if source is None else files(source)
    one = isinstance(source, str | PathLike)
    folder = paths[0] if one and paths[0].is_dir() else None
    if source is not None and not paths:
        raise UserError("expected the path of a FOON, found an empty list")
    beside = [None if file is None else Path(file) for file in (kitchen, rates, utensils, goals)]
    dataset = read_dataset(dataset_files(folder, () if folder else paths, *beside), lenient, level)
    name = "the bundled kitchen" if source is None else ", ".join(map(str, paths))
    foon = Foon(dataset, name)
    for remark in foon.warnings:
        warn(remark)
    return foon


class Foon:
    """A FOON, a kitchen, and what stands beside them; it never changes.

    :func:`load` makes one. Object nodes go by name: a label that only one node has (or one entry of the goals
    file), the one-line notation, or an :class:`ObjectNode`.

    A store stays open while questions may read from it. ``with load(...) as foon:`` closes it at the end, as
    :meth:`close` does; so does Python when nothing refers to the data any more.
    """

    def __init__(self, dataset: Dataset, name: str) -> None:
        self._dataset = dataset
        self._name = name

    def close(self) -> None:
        """Close the store, for all that vary these data too; data that were read whole stay.

        To read more of a closed store raises :class:`UserError`.
        """
        self._dataset.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def problem(self, *goals: str | ObjectNode, containers: str = "strict") -> Problem:
        """Ask for goals, all of which one tree has to make; without any, for the one of the goals file.

        ``containers`` is ``strict`` or ``implied``. Raises :class:`UserError` with candidates for a name that
        means no object node, or several.
        """
        return self.pose(self.goal_ids(goals), containers)

    def vary(
        self,
        *,
        kitchen: "Names | Path | None" = None,
        adding: Names = (),
        without: Names = (),
        rates: Mapping[str, Number] | None = None,
    ) -> "Foon":
        """Give the same data with another kitchen or other success rates.

        ``kitchen`` is all that is at hand: names, or the path of a kitchen file as a :class:`~pathlib.Path`.
        Then what is named in ``adding`` comes in and what is named in ``without`` goes out, where a label
        stands for every item of the kitchen that has it. ``rates`` are new rates of some motions, above 0
        and at most 1.
        """
        if kitchen is None and not adding and not without and rates is None:
            return self
        dataset = self._dataset
        only = None
        if isinstance(kitchen, Path):
            items = read_object_list(kitchen)
            dataset = dataset.with_kitchen(items)
            names = dataset.names
            for item in items:
                if not names.find(pattern_at_level(item.pattern, names.level)):
                    warn(str(kitchen_item_warning(item)))
        elif kitchen is not None:
            only = frozenset(self._ids(kitchen, "kitchen item"))
        more = frozenset(self._ids(adding, "kitchen item"))
        with_more = Foon(dataset.varied(more, frozenset(), only, self._rates(rates)), self._name)
        less = frozenset(o for name in _listed(without) for o in with_more._items(name))
        if not less:
            return with_more
        return Foon(with_more._dataset.varied((), less, None, with_more._dataset.rates), self._name)

    @property
    def warnings(self) -> tuple[str, ...]:
        """What was assumed while reading, with files and lines; empty when nothing was."""
        advice = () if self._dataset.has_kitchen else (_NO_KITCHEN,)
        return (*self._dataset.remarks, *advice)

    @property
    def level(self) -> int:
        """What counts of an object node: 3 all of it, 2 without contents, 1 the label."""
        return self._dataset.names.level

    @property
    def network(self) -> Network:
        """The whole network; of a store, all of it is read."""
        return self._dataset.data.network

    @property
    def kitchen(self) -> tuple[ObjectNode, ...]:
        """Everything at hand, in the order of the network; of a store, all of it is read."""
        data = self._dataset.data
        return tuple(data.network.objects[o] for o in sorted(data.kitchen))

    @property
    def goals(self) -> tuple[ObjectNode, ...]:
        """The object nodes of the goals file; raises :class:`UserError` for an entry that matches none."""
        try:
            return tuple(map(self._node, dict.fromkeys(self._dataset.each_goal(()))))
        except GoalError as error:
            raise UserError(_in_python(error)) from None

    @property
    def rates(self) -> dict[str, Fraction] | None:
        """The success rates by motion, exact; ``None`` where none are known."""
        rates = self._dataset.rates
        return None if rates is None else dict(rates)

    @property
    def utensils(self) -> frozenset[str]:
        """The labels that the container rule ``implied`` looks at."""
        return self._dataset.utensils

    def nodes(self, label: str) -> tuple[ObjectNode, ...]:
        """Give the object nodes that have a label; of a store, the first dozen or more."""
        names = self._dataset.names
        found = names.by_label.get(label, ()) if isinstance(names, Network) else names.labelled(label)[1]
        return tuple(map(self._node, found))

    @property
    def dataset(self) -> Dataset:
        """What the rooms below ask the data with."""
        return self._dataset

    def goal_ids(self, names: Names) -> tuple[int, ...]:
        """Find goals, by id in the whole network, each once."""
        found = tuple(dict.fromkeys(self._ids(names, "goal")))
        if found:
            return found
        listed = self._dataset.listed
        if len(listed) == 1:
            return (self._id(listed[0].pattern.label, "goal"),)
        known = ", ".join(repr(entry.pattern.label) for entry in listed)
        raise UserError("name a goal" + (f"; the goals file has {known}" if known else ""))

    def pose(self, goals: Sequence[int], containers: str, everything: bool = False) -> Problem:
        """Ask for goals by id in the whole network; with ``everything``, a store is read as a whole."""
        return taken(self._dataset.problem(goals, container_rule(containers), everything), self)

    def pose_for(self, goals: Sequence[int], containers: str, tree: TaskTree) -> Problem:
        """Ask for goals by id in the whole network, about a tree: of a store, no more is read than it has."""
        data, goals = self._dataset.part(goals, tree=tree)
        return taken(ask(data, goals, containers), self)

    def _ids(self, names: Names, what: str) -> list[int]:
        return [self._id(name, what) for name in _listed(names)]

    def _id(self, name: str | ObjectNode, what: str) -> int:
        names = self._dataset.names
        if isinstance(name, ObjectNode):
            found = names.object_id(node_at_level(name, names.level))
            if found is None:
                raise UserError(f"no object node of the network is the {what} {str(name)!r}")
            return found
        try:
            return find_goal(
                name, names, self._dataset.listed if what == "goal" else (), Wording(what, "", "")
            )
        except GoalError as error:
            raise UserError(_in_python(error)) from None

    def _items(self, name: str | ObjectNode) -> list[int]:
        """Give the kitchen items that a name stands for: a label for all that have it."""
        names = self._dataset.names
        if isinstance(name, str) and ";" not in name:
            count, found = (
                (len(ids := names.by_label.get(name, ())), ids)
                if isinstance(names, Network)
                else names.labelled(name)
            )
            if count > len(found):
                raise UserError(f"{count} object nodes have the label {name!r}: name those you mean in full")
            if count:
                there = [o for o in found if self._dataset.at_hand(o)]
                if not there:
                    raise UserError(f"the kitchen has nothing with the label {name!r}")
                return there
        found_one = self._id(name, "kitchen item")
        if not self._dataset.at_hand(found_one):
            raise UserError(f"the kitchen does not have {str(name)!r}")
        return [found_one]

    def _node(self, o: int) -> ObjectNode:
        names = self._dataset.names
        return names.objects[o] if isinstance(names, Network) else names.node(o)

    def _rates(self, changed: Mapping[str, Number] | None) -> Mapping[str, Fraction] | None:
        known = self._dataset.rates
        if changed is None:
            return known
        rates = dict(known or {})
        for motion, given in changed.items():
            rate = success_rate(given, f"the success rate of {motion!r}")
            if known is not None and motion not in known:
                near = difflib.get_close_matches(motion, known, n=3, cutoff=0.6)
                similar = f"; similar are {', '.join(map(repr, near))}" if near else ""
                raise UserError(f"no motion {motion!r} has a success rate{similar}")
            rates[motion] = rate
        return rates

    def __repr__(self) -> str:
        return f"<Foon of {self._name}>"


_NO_KITCHEN = "no kitchen is given, so nothing is at hand: load(..., kitchen=FILE)"


def foon_of(problem: Problem) -> Foon:
    """Give the data that a problem was asked of, with the kitchen that the problem has."""
    if problem.origin is None:
        network, kitchen = problem.network, problem.kitchen
        rates = None if problem.rates is None else dict(problem.rates)
        return Foon(Dataset(Data(network, kitchen, (), (), rates, problem.utensils, (), 0), 0.0), "a problem")
    dataset = problem.origin.dataset
    more, less = dataset.kitchen_changes(problem)
    if not more and not less:
        return problem.origin
    return Foon(dataset.varied(more, less, None, dataset.rates), problem.origin._name)


def _listed(names: Names) -> list[str | ObjectNode]:
    # a node is a tuple, and so could pass for several names
    return [names] if isinstance(names, str | ObjectNode) else list(names)


def _in_python(error: GoalError) -> str:
    """Give the candidates of an error as Python has them."""
    lines = [error.said, *(f"  {candidate!r}" for candidate in error.candidates)]
    return "\n".join(lines + ([f"  ... and {error.more} more"] if error.more else []))
