"""A program that clingo grounds and searches, with nothing in it that knows of the question.

What comes in and goes out are plain values, so that it may be in another process.
"""

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from typing import Any

from clingo import Control, MessageCode, Model, SolveHandle
from clingo.symbol import Number, Symbol, SymbolType

from foon_asp.deadline import Deadline
from foon_asp.errors import UserError
from foon_asp.grounding.messages import NO_LIMIT, listener, refusing
from foon_asp.grounding.number_checks import PLACE, Exact, numbers_beyond
from foon_asp.grounding.run import Ended, Heard, asks_for_statistics
from foon_asp.grounding.stated import Stated


class GroundProgram:
    """Files and text, grounded; raises :class:`ProgramError` for what clingo refuses.

    It raises that, too, for what clingo would leave out with no more than a message. ``products`` says how
    many products of rates the text describes. A search ends at the ``deadline``, if any.
    """

    deadline: Deadline | None = None

    def __init__(
        self, files: Sequence[str | Stated], text: str, arguments: Sequence[str], products: int = 0
    ) -> None:
        self._messages: list[str] = []
        self._statistics = asks_for_statistics(arguments)
        with refusing(self._messages):
            hear = listener(self._messages)
            self._control = Control(list(arguments), logger=hear, message_limit=NO_LIMIT)
            checks = [file for file in files if isinstance(file, Stated) and file.place == PLACE]
            self._load([file for file in files if file not in checks], hear)
            self._control.add("base", [], text)
            self._load(checks, hear)  # last: what finds a sum that clasp refuses is grounded before the sum
            parts = [("_product", [Number(number)]) for number in range(products)]
            self._ground([("base", []), *parts])

    def _load(self, files: Sequence[str | Stated], hear: Callable[[MessageCode, str], None]) -> None:
        for file in files:
            if isinstance(file, Stated):
                from foon_asp.grounding.parsing import load  # noqa: PLC0415 (slow to import)

                load(self._control, file, hear)
            else:
                self._control.load(file)

    def _ground(self, parts: Sequence[tuple[str, Sequence[Symbol]]]) -> None:
        try:
            self._control.ground(parts, Exact())
        finally:
            self._messages += numbers_beyond(self._control)

    def consequences(self, predicates: Sequence[tuple[str, int]]) -> list[list[tuple[int, ...]]]:
        """Return for each predicate, by name and arity, the numbers of its atoms: all that the rules derive.

        To be asked of rules without choice, whose atoms grounding alone settles.
        """
        atoms = self._control.symbolic_atoms
        return [
            [tuple([term.number for term in atom.symbol.arguments]) for atom in atoms.by_signature(*each)]
            for each in predicates
        ]

    def search(
        self,
        opt_mode: str,
        predicates: Sequence[tuple[str, int]],
        on_tree: Callable[[Heard], None],
        on_bound: Callable[[list[int]], None],
    ) -> Ended:
        """Search for the best answer, and say how the search ended; any thread may report trees.

        ``opt_mode`` is clasp's: ``opt``, ``opt,BOUND,...`` or ``ignore`` (the first answer will do).
        ``predicates``, by name and arity, have atoms that are wanted besides ``use``, which begin with a
        number. Raises :class:`UserError` for an option that clasp does not take, for answers that are none,
        and what ``on_tree`` raises.
        """
        # whatever the options say: a proof needs the whole search space
        models = 1 if opt_mode == "ignore" else 0
        settings = {"opt_mode": opt_mode, "models": models, "enum_mode": "auto", "project": "no"}
        try:
            for name, value in {**settings, "opt_stop": "no"}.items():
                setattr(self._control.configuration.solve, name, value)
        except RuntimeError as error:
            raise UserError(str(error)) from None
        faults: list[Exception] = []  # raised in clingo's thread, to be raised in ours

        def model(model: Model) -> bool:
            try:
                atoms = {name: _numbers(model, name, arity) for name, arity in predicates}
                rows = {name: _rows(model, name, arity) for name, arity in predicates}
                on_tree(Heard(_used(model), tuple(model.cost), atoms, rows))
            except Exception as error:
                faults.append(error)
            return not faults

        with self._control.solve(
            async_=True, on_model=model, on_unsat=lambda lower: on_bound(list(lower))
        ) as handle:
            if self.deadline:
                _wait(handle, self.deadline)
            ended = handle.get()
        if faults:
            raise faults[0]
        exhausted = bool(ended.exhausted) or (opt_mode == "ignore" and ended.satisfiable is not None)
        return Ended(exhausted, "\n".join(_lines(self._control.statistics)) if self._statistics else "")

    def close(self) -> None:
        """Release the program."""


def _lines(statistics: Any, name: str = "") -> Iterator[str]:
    """Return clingo's statistics, a tree of numbers, as lines with the path to each."""
    if isinstance(statistics, dict):
        for key, each in statistics.items():
            yield from _lines(each, f"{name}.{key}" if name else key)
    elif isinstance(statistics, list):
        for number, each in enumerate(statistics):
            yield from _lines(each, f"{name}.{number}")
    else:
        yield f"{name} = {statistics:g}"


def _wait(handle: SolveHandle, deadline: Deadline) -> None:
    """Wait for the end of a search, and cancel it when it is time to stop."""
    try:
        while not handle.wait(deadline.slice()):
            if deadline.passed:
                handle.cancel()
                break
    except KeyboardInterrupt:
        deadline.interrupt()
        handle.cancel()


def _used(model: Model) -> frozenset[int]:
    units = set()
    for symbol in model.symbols(shown=True):
        if symbol.type is SymbolType.Function and symbol.match("use", 1):
            argument = symbol.arguments[0]
            if argument.type is not SymbolType.Number:
                raise UserError(f"the encodings made {symbol}, expected use(U) with the number of a unit")
            units.add(argument.number)
    return frozenset(units)


def _rows(model: Model, name: str, arity: int) -> frozenset[tuple[int, ...]]:
    atoms = (symbol.arguments for symbol in model.symbols(atoms=True) if symbol.match(name, arity))
    return frozenset(
        tuple(argument.number for argument in arguments)
        for arguments in atoms
        if all(argument.type is SymbolType.Number for argument in arguments)
    )


def _numbers(model: Model, name: str, arity: int) -> Counter[int]:
    atoms = (symbol for symbol in model.symbols(atoms=True) if symbol.match(name, arity))
    return Counter(symbol.arguments[0].number for symbol in atoms)
