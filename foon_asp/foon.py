"""Loaded data: a FOON, a kitchen, and the files that belong to them."""

import contextlib
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence, Sized
from fractions import Fraction
from os import PathLike
from pathlib import Path
from typing import Any, Self

from foon_asp.argument_checks import typed
from foon_asp.dataset import Dataset, read_dataset
from foon_asp.dataset.item_options import Stays, Stock, items_for
from foon_asp.dataset.paths import File, Files, as_paths
from foon_asp.dataset.python_names import node_ids, python_error_text, stated_copies
from foon_asp.deadline import Cancel, parse_seconds, stoppable
from foon_asp.errors import UserError
from foon_asp.network import (
    FunctionalUnit,
    Network,
    NetworkBuilder,
    ObjectNode,
    Source,
    StandInTable,
    UnitPrices,
    is_starting,
    starting_kitchen,
)
from foon_asp.problem import DEFAULT_RULE, Changes, Names, Number, Problem, UnitPricesNamed
from foon_asp.problem.progress import OnProgress, Progress
from foon_asp.rules.measure import read_measures
from foon_asp.standins.table_file import read_stand_ins
from foon_asp.text.assumed_goals import LAST, goal_entry, last_goals
from foon_asp.text.data_folder import Data, find_data
from foon_asp.text.line import LineError
from foon_asp.text.line_parser import parse_node
from foon_asp.text.reading import reporting_to, size_of
from foon_asp.text.stated_amounts import StatedAmounts, counted_amounts
from foon_asp.text.unknown_node import GoalError
from foon_asp.warning import warn


@typed
def load(
    source: Files | None = None,
    *,
    kitchen: File | None = None,
    rates: File | None = None,
    utensils: File | None = None,
    goals: File | None = None,
    unit_prices: File | None = None,
    unit_amounts: File | None = None,
    measures: Files = (),
    stand_ins: StandInTable | bool | None = None,
    level: int = 3,
    lenient: bool = False,
    time_limit: float | None = None,
    on_progress: OnProgress | None = None,
    cancel: Cancel | None = None,
) -> "Foon":
    """Load a FOON, a kitchen and the files that belong to them.

    Of a store, only the indexes are read; :meth:`Foon.problem` reads what can matter for its goals.
    Assumptions made while reading are warnings (:class:`FoonWarning`), which :attr:`Foon.warnings` lists
    too.

    Parameters:
        source: A folder with all files; or a network (FOON text or JSON), several networks to merge, or a
            store. Without it, the bundled kitchen is loaded.
        kitchen: The file with the available object nodes, instead of that of the folder. ``"@starting"``
            means the starting kitchen: whatever the units of each file need in order to run. It is also
            assumed if there is no kitchen.
        rates: The file with the success rates of motions, instead of that of the folder.
        utensils: The file with the labels of utensils, instead of that of the folder.
        goals: The file with goals, instead of that of the folder.
        unit_prices: The file with the prices of units, instead of that of the folder.
        unit_amounts: The file with the numbers of copies that units take and make, instead of that of
            the folder.
        measures: Objectives of your own: files with rules for what units cost, or the rules themselves.
        stand_ins: Whether available nodes may be used in place of nodes that cannot be made. ``True`` means
            by the usual table of prices, with the changes of ``stand_ins.txt`` in the folder. A table means
            by this one.
        level: How object nodes are compared: by label (1), by label, states and relations (2), or by
            everything (3).
        lenient: Whether lines that are not understood are skipped, with a warning, instead of being errors.
        time_limit: Stop reading after this many seconds.
        on_progress: Is called now and then with a :class:`Progress`, in bytes.
        cancel: A token that ends reading from another thread.

    Returns:
        The data, from which problems are made.

    Raises:
        UserError: for a file that is missing or cannot be read, or another level.
        StoppedError: if it was stopped.

    Example:
        >>> foon = foon_asp.load()
        >>> foon.network
        <Network: 220 units, 418 object nodes, level 3>
    """
    if level not in {1, 2, 3}:
        raise UserError(f"found level={level!r}, expected 1, 2 or 3")
    paths = () if source is None else as_paths(source)
    is_single = isinstance(source, str | PathLike)
    folder = paths[0] if is_single and paths[0].is_dir() else None
    if source is not None and not paths:
        raise UserError("expected the path of a FOON, found an empty list")
    side_files = [
        None if file is None else Path(file)
        for file in (kitchen, rates, utensils, goals, unit_prices, unit_amounts)
    ]
    with _time_limit_context(time_limit, cancel, "reading"):
        user_measures = read_measures(measures)
        data_files = find_data(folder, () if folder else paths, *side_files)
        with _progress_counter(on_progress, size_of(data_files.network)) as tell, reporting_to(tell):
            dataset = read_dataset(data_files, lenient, level).with_measures(user_measures)
            if stand_ins:
                folder_tables = () if data_files.stand_ins is None else (data_files.stand_ins,)
                table = read_stand_ins(folder_tables) if isinstance(stand_ins, bool) else stand_ins
                dataset = dataset.with_stand_in_table(table)
    name = "the bundled kitchen" if source is None else ", ".join(map(str, paths))
    foon = Foon(dataset, name)
    for remark in foon.warnings:
        warn(remark)
    return foon


@contextlib.contextmanager
def _progress_counter(on_progress: OnProgress | None, total: int) -> Iterator[Callable[[int], None]]:
    """Yield a function for a ``with`` block that adds a number to the progress, and reports the sum.

    At the end of the block, the progress is reported as complete, unless it was before or the block raised an
    exception. ``total`` is 0 if it is unknown. Without ``on_progress``, nothing is reported.
    """
    done = 0

    def report(added: int) -> None:
        """Add a number to the progress, and report the sum."""
        nonlocal done
        done += added
        if on_progress is not None:
            on_progress(Progress(done=done, total=total))

    yield report
    if done < total:
        report(total - done)


def _time_limit_context(
    time_limit: float | None, cancel: Cancel | None, doing: str
) -> contextlib.AbstractContextManager[object]:
    """Return a context that stops its ``with`` block at a time limit or by a token.

    ``None`` for ``time_limit`` is no limit, and for both, the context does nothing. ``doing`` is the work for
    messages. Raises :class:`UserError` for a time limit that is no number of seconds.
    """
    if time_limit is None and cancel is None:
        return contextlib.nullcontext()
    return stoppable(None if time_limit is None else parse_seconds(time_limit), cancel, doing)


PlainUnit = FunctionalUnit | tuple[str, Names, Names] | Mapping[str, Any]
"""A unit as callers write it: motion, inputs and outputs."""


@typed
def build(
    units: "Network | Iterable[PlainUnit]",  # quoted: _build_network reports other types itself
    *,
    kitchen: Names | None = None,
    goals: Names | None = None,
    rates: Mapping[str, Number] | None = None,
    utensils: Iterable[str] = (),
    unit_prices: UnitPricesNamed | None = None,
    measures: Files = (),
    time_limit: float | None = None,
    on_progress: OnProgress | None = None,
    cancel: Cancel | None = None,
) -> "Foon":
    """Make data from units written in Python, with a kitchen, goals, rates and further parts.

    Parameters:
        units: Units, or a network made by a :class:`NetworkBuilder`. A unit is a motion, inputs and outputs,
            with object nodes in one-line notation:
            ``("pour", ["water; hot", "cup; empty"], ["cup; contains {water}"])``. It may also be a dictionary
            with the keys ``motion``, ``inputs`` and ``outputs``, or a :class:`FunctionalUnit`. A node that a
            unit lists twice is taken or made twice if items are used up.
        kitchen: The available object nodes, by label, in one-line notation, or as :class:`ObjectNode`. A
            dictionary has numbers of copies by such names, with ``None`` for what never runs out. Without
            it, or as ``"@starting"``, whatever all units need in order to run is available. ``()`` means
            that nothing is available.
        goals: The object nodes to make, named like those of the kitchen. A dictionary has the numbers of
            copies wanted. Without it, the goals are what the last unit makes and no unit needs.
        rates: The success rates of motions, above 0 and at most 1.
        utensils: The labels of the utensils that the container rule ``implied`` is about.
        unit_prices: Prices, from 0, by the name of a motion or of single units.
        measures: Objectives of your own: files with rules for what units cost, or the rules themselves.
        time_limit: Stop after this many seconds.
        on_progress: Is called with a :class:`Progress` now and then: units ``done``, of ``total`` if their
            number is known.
        cancel: A token that ends it from another thread.

    Returns:
        The data, from which problems are made.

    Raises:
        UserError: for what is no unit, a name that means no object node or several, or a rate or price out
            of range.
        StoppedError: if it was stopped.

    Example:
        >>> brew = ("brew", ["water; hot", "tea bag"], ["tea; hot"])
        >>> foon = foon_asp.build([("boil", "water; cold", "water; hot"), brew], kitchen=["water", "tea bag"])
        Traceback (most recent call last):
        foon_asp.errors.UserError: the kitchen item 'water' means 2 object nodes; paste the one you mean
          'water; cold'
          'water; hot'
        >>> units = [("boil", "water; cold", "water; hot"), brew]
        >>> foon = foon_asp.build(units, kitchen=["water; cold", "tea bag"], goals="tea", rates={"boil": 0.9})
        >>> foon_asp.solve(foon.problem())
        <Answer: optimal by units (strict containers): 2 units, 3 inputs>
    """
    with _time_limit_context(time_limit, cancel, "building"):
        total = len(units) if isinstance(units, Sized) else 0
        with _progress_counter(on_progress, total) as tell:
            stated_amounts = StatedAmounts()
            network = units if isinstance(units, Network) else _build_network(units, stated_amounts, tell)
        making_units = [unit for unit, outputs in enumerate(network.outputs) if outputs]
        last_maker = {making_units[-1]: Source("the units", making_units[-1] + 1)} if making_units else {}
        assumed_goals = tuple(entry for entry in last_goals(network, last_maker)) if goals is None else ()
        starting = is_starting(kitchen)
        kitchen_ids = starting_kitchen(network).nodes if starting else frozenset[int]()
        data = Data(network, kitchen_ids, (), assumed_goals, None, frozenset(utensils), (), 0, None, starting)
        data = data._replace(
            goals_from=LAST if goals is None else "", amounts=stated_amounts.amounts_by_unit(network)
        )
        dataset = (
            Dataset.of(data)
            .with_remarks((), (), (), kitchen is not None)
            .with_measures(read_measures(measures))
        )
        if goals is not None:
            nodes = [network.objects[o] for o in node_ids(dataset, goals, "goal")]
            wanted = stated_copies(dataset, goals, "goal") if isinstance(goals, Mapping) else {}
            goal_entries = (
                goal_entry(node, Source("the goals", number))._replace(amount=wanted.get(node))
                for number, node in enumerate(nodes, 1)
            )
            dataset = dataset.with_goals(tuple(goal_entries))
        new_kitchen = None if starting else kitchen
        foon = Foon(dataset.vary(Changes(new_kitchen, rates=rates, unit_prices=unit_prices)), "a network")
    for remark in foon.warnings:
        warn(remark)
    return foon


def _build_network(
    units: Iterable[PlainUnit], amounts: StatedAmounts, tell: Callable[[int], None]
) -> Network:
    """Build a network of units as callers write them; the source of a unit has its number, from 1.

    A node that a unit lists several times is taken or made in as many copies, which are added to ``amounts``.
    ``tell`` is called after each 100 units and at the end, with the number of units since the last call.
    Raises :class:`UserError` for what is no unit.
    """
    builder, number, reported = NetworkBuilder(), 0, 0
    if isinstance(units, str | Mapping) or not isinstance(units, Iterable):
        raise UserError(f"found units={units!r}, expected several units; {_UNIT}")
    for number, unit in enumerate(units, 1):
        motion: object
        inputs: object
        outputs: object
        if isinstance(unit, FunctionalUnit):
            motion, inputs, outputs = unit.motion, unit.inputs, unit.outputs
        elif isinstance(unit, Mapping) and unit.keys() == {"motion", "inputs", "outputs"}:
            motion, inputs, outputs = unit["motion"], unit["inputs"], unit["outputs"]
        elif isinstance(unit, tuple | list) and len(unit) == 3:
            motion, inputs, outputs = unit
        else:
            raise UserError(f"found the unit {unit!r}; {_UNIT}")
        if not isinstance(motion, str) or not motion.strip():
            raise UserError(f"found the motion {motion!r} of unit {number}, expected a name; {_UNIT}")
        source = Source("the units", number)
        sides = [*_parse_nodes(inputs, number)], [*_parse_nodes(outputs, number)]
        builder.add(motion, *sides, source)
        if unit_amounts := counted_amounts(*([(node, 1) for node in side] for side in sides)):
            amounts.add(FunctionalUnit.of(motion, *sides), unit_amounts, source)
        if number - reported == 100:
            tell(number - reported)
            reported = number
    if number > reported:
        tell(number - reported)
    return builder.build()


def _parse_nodes(names: object, number: int) -> Iterator[ObjectNode]:
    """Yield the inputs or the outputs of a unit as object nodes, from one name or several.

    Names are in one-line notation, or nodes already. ``number`` names the unit in errors. Raises
    :class:`UserError` for a name that is no valid notation.
    """
    node_names = [names] if isinstance(names, str | ObjectNode) else names
    if not isinstance(node_names, Iterable):
        raise UserError(f"found {names!r} in unit {number}, expected object nodes; {_UNIT}")
    for name in node_names:
        if isinstance(name, ObjectNode):
            yield name
        elif isinstance(name, str):
            try:
                yield parse_node(name)
            except LineError as error:
                message = f"{name!r} of unit {number} cannot be read: at column {error.column}, {error}"
                raise UserError(f"the object node {message}") from None
        else:
            raise UserError(f"found {name!r} in unit {number}, expected an object node; {_UNIT}")


_UNIT = "a unit is its motion, its inputs and its outputs: ('pour', ['water; hot', 'tea bag'], ['tea; hot'])"


class Foon:
    """A FOON, a kitchen, and the files that belong to them; a value that never changes.

    :func:`load` makes one. An object node is named in one-line notation or as an :class:`ObjectNode`. Its
    label is enough if no other node has it, or for a goal, if only one entry of the goals file has it.

    A store stays open while questions may read from it. ``with load(...) as foon:`` closes it at the end, as
    :meth:`close` does; otherwise it is closed when nothing refers to the data any more.

    Example:
        >>> foon = foon_asp.load()
        >>> foon.problem("ice")
        <Problem: ice; crushed; in [drinking glass] (strict containers)>
        >>> str(foon.rates["crush"])
        '7/10'
        >>> foon.vary(adding="tea").problem("ice").at_hand(foon.nodes("tea")[0])
        True
        >>> foon_asp.Foon.of(foon.problem("ice"))
        <Foon of a problem>
        >>> foon.close()
    """

    def __init__(self, dataset: Dataset, name: str) -> None:
        self._dataset = dataset
        self._name = name

    @classmethod
    def of(cls, problem: Problem) -> Self:
        """Return the data that a problem was made from, with the kitchen of the problem.

        Parameters:
            problem: The problem. If it was made by hand, its network, kitchen, rates, prices and measures are
                the data, without goals.
        """
        if isinstance(problem.origin, Dataset):
            return cls(problem.origin.with_kitchen_of(problem), "a problem")
        rates = None if problem.rates is None else dict(problem.rates)
        data = Data(
            problem.network, problem.kitchen, (), (), rates, problem.utensils, (), 0, problem.unit_prices
        )
        return cls(Dataset.of(data).with_measures(problem.measures), "a problem")

    def close(self) -> None:
        """Close the store, also for data varied from these; do nothing for data in memory.

        What was read stays. To read more of a closed store raises :class:`UserError`.
        """
        self._dataset.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    @typed
    def problem(
        self,
        *goals: str | ObjectNode,
        containers: str = DEFAULT_RULE.value,
        items: str | None = None,
        stock: Stock | None = None,
        stays: Stays | None = None,
        amounts: int | Sequence[int] = (),
    ) -> Problem:
        """Make a problem: goals that one tree has to make together.

        Parameters:
            goals: Object nodes, by name or as :class:`ObjectNode`; without any, the goal of the goals file.
            containers: The container rule, ``strict`` or ``implied``.
            items: ``lasting``, or ``used-up`` by the rule of docs/plans.md. The default is ``used-up`` if
                amounts of goals are wanted, and ``lasting`` otherwise.
            stock: How many copies the kitchen has of some object nodes, by name, or the path of a stock
                file. It takes precedence over the amounts of the kitchen; all other items never run out.
                Only for items that are used up.
            stays: Exceptions from the rule, by label or object node: ``True`` if an item stays, ``False`` if
                it is used up. Or the path of a file with such exceptions. Only for items that are used up.
            amounts: How many copies of the goal are wanted; for several goals, a number for each, in order.
                Without it, the amounts of the goals file count.

        Raises:
            UserError: for a name that means no object node or several, with candidates; for an unknown
                container rule or word of ``items``; and for amounts that do not fit the goals.
        """
        ids = self._dataset.python_goal_ids(goals)
        amounts_of_goals = [amounts] if isinstance(amounts, int) else amounts
        used_up = items_for(self._dataset, ids, amounts_of_goals, items, stock, stays)
        return self._dataset.nearby(ids, containers, used_up)

    @typed
    def vary(
        self,
        *,
        kitchen: Names | Path | None = None,
        adding: Names = (),
        without: Names = (),
        rates: Mapping[str, Number] | None = None,
        unit_prices: UnitPricesNamed | None = None,
        measures: Files | None = None,
    ) -> "Foon":
        """Return the same data with another kitchen, other success rates, other prices or other measures.

        Parameters:
            kitchen: The available items: names, or a kitchen file as a :class:`~pathlib.Path`. A dictionary
                has numbers of copies by name, with ``None`` for what never runs out.
            adding: Names of object nodes to add to the kitchen.
            without: Names of object nodes to remove from the kitchen.
            rates: New success rates of some motions, above 0 and at most 1.
            unit_prices: New prices, from 0, of motions by name and of single units; the price of a single
                unit stays when that of its motion changes.
            measures: All measures of your own: files with rules for what units cost, or the rules themselves.

        Raises:
            UserError: for a name that means no object node or several, or a rate or price out of range.
        """
        varied = self._dataset.vary(Changes(kitchen, adding, without, rates, unit_prices, measures))
        return self if varied is self._dataset else Foon(varied, self._name)

    @property
    def warnings(self) -> tuple[str, ...]:
        """The assumptions made while reading, with files and lines, also that no kitchen was given."""
        advice = () if self._dataset.has_kitchen else (_NO_KITCHEN,)
        return (*self._dataset.remarks, *advice)

    @property
    def level(self) -> int:
        """The level at which nodes are compared: by label (1), states and relations too (2), or all (3)."""
        return self._dataset.names.level

    @property
    def network(self) -> Network:
        """The whole network; of a store, all of it is read."""
        return self._dataset.data.network

    @property
    def kitchen(self) -> tuple[ObjectNode, ...]:
        """The items of the kitchen, in the order of the network; of a store, all of it is read."""
        data = self._dataset.data
        return tuple(data.network.objects[o] for o in sorted(data.kitchen))

    @property
    def goals(self) -> tuple[ObjectNode, ...]:
        """The object nodes of the goals file; if there is no file, the goals that were assumed.

        Raises:
            UserError: if an entry matches no object node.
        """
        try:
            return tuple(map(self._dataset.names.node, dict.fromkeys(self._dataset.goal_ids(()))))
        except GoalError as error:
            raise UserError(python_error_text(error)) from None

    @property
    def rates(self) -> dict[str, Fraction] | None:
        """The exact success rates by motion; ``None`` if there are none."""
        rates = self._dataset.rates
        return None if rates is None else dict(rates)

    @property
    def unit_prices(self) -> UnitPrices | None:
        """The prices of units, ``None`` if there are none; of a store, all of it is read."""
        return self._dataset.data.unit_prices

    @property
    def utensils(self) -> frozenset[str]:
        """The labels of utensils, which the container rule ``implied`` uses."""
        return self._dataset.utensils

    @typed
    def nodes(self, label: str) -> tuple[ObjectNode, ...]:
        """Return the object nodes that have a label; empty if there are none.

        Parameters:
            label: The label. Of a store, only about the first dozen nodes are returned.
        """
        names = self._dataset.names
        return tuple(map(names.node, names.labelled(label)[1]))

    @property
    def dataset(self) -> Dataset:
        """The dataset behind this value, for other modules of foon-asp."""
        return self._dataset

    def __repr__(self) -> str:
        return f"<Foon of {self._name}>"


_NO_KITCHEN = (
    "No kitchen given: assuming what the recipe does not make is available (Foon.kitchen, for one question: "
    "Answer.json()['starting_kitchen']); load(..., kitchen=FILE) takes another"
)
