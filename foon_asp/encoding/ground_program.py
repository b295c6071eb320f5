"""A program that clingo grounds and searches, independent of the question.

Arguments and results are plain values, so that the program may be in another process.
"""

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from typing import Any

from clingo import Control, MessageCode, Model, SolveHandle
from clingo.symbol import Number, Symbol, SymbolType

from foon_asp.deadline import Deadline
from foon_asp.encoding.messages import NO_LIMIT, listener, refuse_messages
from foon_asp.encoding.number_checks import CHECKS_FILE, Exact, overflow_messages
from foon_asp.encoding.run import Ended, FoundAnswer, asks_for_statistics
from foon_asp.encoding.stated import Stated
from foon_asp.errors import UserError


class GroundProgram:
    """Ground program of files and text; raises :class:`ProgramError` if clingo refuses it.

    If clingo only gives a message that it drops an instance of a rule, this counts as a refusal.
    ``arguments`` are options of clingo. ``products`` is the number of products of rates in the text; the
    program part ``_product`` is grounded for each. A search ends at the ``deadline``, if there is one.
    """

    deadline: Deadline | None = None

    def __init__(
        self, files: Sequence[str | Stated], text: str, arguments: Sequence[str], products: int = 0
    ) -> None:
        """Load files and text, with rules that check for overflows last, and ground them."""
        self._messages: list[str] = []
        self._statistics = asks_for_statistics(arguments)
        with refuse_messages(self._messages):
            logger = listener(self._messages)
            self._control = Control(list(arguments), logger=logger, message_limit=NO_LIMIT)
            checks = [file for file in files if isinstance(file, Stated) and file.place == CHECKS_FILE]
            self._load([file for file in files if file not in checks], logger)
            self._control.add("base", [], text)
            # last, since the check of a sum that clasp refuses has to be grounded before the sum
            self._load(checks, logger)
            parts = [("_product", [Number(number)]) for number in range(products)]
            self._ground([("base", []), *parts])

    def _load(self, files: Sequence[str | Stated], logger: Callable[[MessageCode, str], None]) -> None:
        """Load encodings, which are given as file names, and rules without a file into clingo."""
        for file in files:
            if isinstance(file, Stated):
                from foon_asp.encoding.parsing import load  # noqa: PLC0415 (slow to import)

                load(self._control, file, logger)
            else:
                self._control.load(file)

    def _ground(self, parts: Sequence[tuple[str, Sequence[Symbol]]]) -> None:
        """Ground parts of the program; messages about overflows are added to ``_messages``."""
        try:
            self._control.ground(parts, Exact())
        finally:
            self._messages += overflow_messages(self._control)

    def consequences(self, predicates: Sequence[tuple[str, int]]) -> list[list[tuple[int, ...]]]:
        """Return the arguments of all atoms of each predicate, given by name and arity.

        The result has a list for each predicate; all arguments have to be numbers. The rules have to be
        stratified, so that grounding alone derives all atoms.
        """
        atoms = self._control.symbolic_atoms
        return [
            [
                tuple([term.number for term in atom.symbol.arguments])
                for atom in atoms.by_signature(*predicate)
            ]
            for predicate in predicates
        ]

    def search(
        self,
        opt_mode: str,
        predicates: Sequence[tuple[str, int]],
        on_tree: Callable[[FoundAnswer], None],
        on_bound: Callable[[list[int]], None],
    ) -> Ended:
        """Search for the best answer, and return how the search ended.

        Parameters:
            opt_mode: As in clasp: ``opt``, ``opt,BOUND,...`` or ``ignore`` (stop at the first answer).
            predicates: Predicates (name and arity) whose atoms are reported, in addition to ``use``. The
                first argument of their atoms is a number.
            on_tree: Is called with each answer, perhaps in another thread.
            on_bound: Is called with each lower bound that clingo proves, perhaps in another thread.

        The search is not exhausted if the deadline or ctrl-C stopped it. With ``ignore``, it is exhausted
        once it has an answer. Options of clingo on the number of answers and their enumeration have no
        effect.

        Raises :class:`UserError` for an option that clasp refuses and for invalid answers, and any error that
        ``on_tree`` raises.
        """
        # overrides the options: a proof needs the whole search space
        models = 1 if opt_mode == "ignore" else 0
        settings = {"opt_mode": opt_mode, "models": models, "enum_mode": "auto", "project": "no"}
        try:
            for name, value in {**settings, "opt_stop": "no"}.items():
                setattr(self._control.configuration.solve, name, value)
        except RuntimeError as error:
            raise UserError(str(error)) from None
        faults: list[Exception] = []  # raised in clingo's thread, to be raised again in this one

        def report_answer(model: Model) -> bool:
            """Report an answer; return whether to continue, which is ``False`` after an error."""
            try:
                atoms = {name: _count_by_first_argument(model, name, arity) for name, arity in predicates}
                rows = {name: _rows_of_numbers(model, name, arity) for name, arity in predicates}
                on_tree(FoundAnswer(_used_units(model), tuple(model.cost), atoms, rows))
            except Exception as error:
                faults.append(error)
            return not faults

        with self._control.solve(
            async_=True, on_model=report_answer, on_unsat=lambda lower: on_bound(list(lower))
        ) as handle:
            if self.deadline:
                _wait(handle, self.deadline)
            ended = handle.get()
        if faults:
            raise faults[0]
        exhausted = bool(ended.exhausted) or (opt_mode == "ignore" and ended.satisfiable is not None)
        return Ended(
            exhausted, "\n".join(_statistics_lines(self._control.statistics)) if self._statistics else ""
        )

    def close(self) -> None:
        """Release the program: nothing to do, as it is in this process."""


def _statistics_lines(statistics: Any, name: str = "") -> Iterator[str]:
    """Yield clingo's statistics as one line per number, such as ``solving.solvers.choices = 9``."""
    if isinstance(statistics, dict):
        for key, child in statistics.items():
            yield from _statistics_lines(child, f"{name}.{key}" if name else key)
    elif isinstance(statistics, list):
        for number, child in enumerate(statistics):
            yield from _statistics_lines(child, f"{name}.{number}")
    else:
        yield f"{name} = {statistics:g}"


def _wait(handle: SolveHandle, deadline: Deadline) -> None:
    """Wait for the end of a search, and cancel it at the deadline or ctrl-C.

    Ctrl-C is recorded in the deadline, and not raised.
    """
    try:
        while not handle.wait(deadline.seconds_to_next_check()):
            if deadline.passed:
                handle.cancel()
                break
    except KeyboardInterrupt:
        deadline.interrupt()
        handle.cancel()


def _used_units(model: Model) -> frozenset[int]:
    """Return the numbers of the units in use in an answer, as far as ``use/1`` is shown.

    Raises :class:`UserError` if an argument of ``use/1`` is no number.
    """
    units = set()
    for symbol in model.symbols(shown=True):
        if symbol.type is SymbolType.Function and symbol.match("use", 1):
            argument = symbol.arguments[0]
            if argument.type is not SymbolType.Number:
                raise UserError(f"the encodings made {symbol}, expected use(U) with the number of a unit")
            units.add(argument.number)
    return frozenset(units)


def _rows_of_numbers(model: Model, name: str, arity: int) -> frozenset[tuple[int, ...]]:
    """Return the arguments of each atom of a predicate in an answer, if all are numbers.

    Atoms with another argument are left out.
    """
    atoms = (symbol.arguments for symbol in model.symbols(atoms=True) if symbol.match(name, arity))
    return frozenset(
        tuple(argument.number for argument in arguments)
        for arguments in atoms
        if all(argument.type is SymbolType.Number for argument in arguments)
    )


def _count_by_first_argument(model: Model, name: str, arity: int) -> Counter[int]:
    """Return how many atoms of a predicate an answer has for each first argument, which is a number."""
    atoms = (symbol for symbol in model.symbols(atoms=True) if symbol.match(name, arity))
    return Counter(symbol.arguments[0].number for symbol in atoms)
