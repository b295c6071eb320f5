"""One run of clingo over encodings and facts, with limits and without any claim of its own."""

import time
from collections import Counter
from collections.abc import Callable, Sequence
from pathlib import Path

from clingo import Control, Model
from clingo.symbol import SymbolType

from foon_asp.asp.deadline import Deadline
from foon_asp.asp.run import Run
from foon_asp.errors import UserError


def check(arguments: Sequence[str]) -> None:
    """Raise :class:`UserError` for options that clingo does not take."""
    messages: list[str] = []
    try:
        Control(list(arguments), logger=lambda _, text: messages.append(text))
    except RuntimeError as error:
        from foon_asp.asp.encoding import fault  # noqa: PLC0415 (slow to import, needed for faults only)

        raise fault(messages, str(error)) from None


def run(
    files: Sequence[Path],
    facts: str,
    arguments: Sequence[str],
    deadline: Deadline,
    opt_mode: str = "opt",
    on_tree: Callable[[frozenset[int]], None] | None = None,
    on_bound: Callable[[list[int]], None] | None = None,
    predicates: Sequence[str] = (),
) -> Run:
    """Ground the files and facts and search for the best answer.

    ``opt_mode`` is clasp's: ``opt``, ``opt,BOUND,...`` or ``ignore`` (the first answer will do).
    ``predicates`` are names of atoms that are wanted beside ``use``; they begin with a number. Raises
    what :func:`foon_asp.asp.encoding.fault` makes of clingo's messages where a program is at fault.
    """
    messages: list[str] = []
    result = Run()
    began = time.perf_counter()
    try:
        control = Control(list(arguments), logger=lambda _, text: messages.append(text), message_limit=1000)
        for file in files:
            control.load(str(file))
        control.add("base", [], facts)
        control.ground([("base", [])])
        models = 1 if opt_mode == "ignore" else 0
        _set(control, opt_mode=opt_mode, models=models, enum_mode="auto", project="no", opt_stop="no")
    except RuntimeError as error:
        from foon_asp.asp.encoding import fault  # noqa: PLC0415 (slow to import, needed for faults only)

        raise fault(messages, str(error)) from None
    grounded = time.perf_counter()
    result.ground_seconds = grounded - began

    faults: list[UserError] = []  # raised in clingo's thread, to be raised in ours

    def model(model: Model) -> bool:
        try:
            result.units = _used(model)
            result.cost = tuple(model.cost)
            result.atoms = {name: _numbers(model, name) for name in predicates}
            if on_tree:
                on_tree(result.units)
        except UserError as error:
            faults.append(error)
        return not faults

    def unsat(lower: Sequence[int]) -> None:
        result.lower = list(lower)
        if on_bound:
            on_bound(result.lower)

    with control.solve(async_=True, on_model=model, on_unsat=unsat) as handle:
        while True:
            try:
                if handle.wait(deadline.slice()):
                    break
                if deadline.passed:
                    handle.cancel()
                    break
            except KeyboardInterrupt:
                deadline.interrupted = True
                handle.cancel()
                break
        ended = handle.get()
    if faults:
        raise faults[0]
    result.exhausted = bool(ended.exhausted) or (opt_mode == "ignore" and ended.satisfiable is not None)
    result.solve_seconds = time.perf_counter() - grounded
    return result


def _set(control: Control, **values: str | int) -> None:
    """Set how to search, whatever the options say: a proof needs the whole search space."""
    for name, value in values.items():
        setattr(control.configuration.solve, name, value)


def _used(model: Model) -> frozenset[int]:
    units = set()
    for symbol in model.symbols(shown=True):
        if symbol.type is SymbolType.Function and symbol.match("use", 1):
            argument = symbol.arguments[0]
            if argument.type is not SymbolType.Number:
                raise UserError(f"the encodings made {symbol}, expected use(U) with the number of a unit")
            units.add(argument.number)
    return frozenset(units)


def _numbers(model: Model, name: str) -> Counter[int]:
    atoms = (symbol for symbol in model.symbols(atoms=True) if symbol.name == name and symbol.positive)
    return Counter(symbol.arguments[0].number for symbol in atoms)
