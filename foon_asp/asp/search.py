"""One run of clingo over encodings and facts, with limits and without any claim of its own."""

import time
from collections import Counter
from collections.abc import Callable, Sequence
from pathlib import Path

from clingo import Control, Model
from clingo.symbol import Number, SymbolType

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
    products: int = 0,
) -> Run:
    """Ground the files and facts and search for the best answer.

    ``opt_mode`` is clasp's: ``opt``, ``opt,BOUND,...`` or ``ignore`` (the first answer will do).
    ``predicates`` are names of atoms that are wanted beside ``use``; they begin with a number. ``products``
    says how many products of rates the facts describe. Raises
    what :func:`foon_asp.asp.encoding.fault` makes of clingo's messages where a program is at fault.
    """
    began = time.perf_counter()
    control = ground(files, facts, arguments, products)
    grounded = time.perf_counter()
    result = search(control, deadline, opt_mode, on_tree, on_bound, predicates)
    result.ground_seconds = grounded - began
    return result


def ground(files: Sequence[Path], facts: str, arguments: Sequence[str], products: int = 0) -> Control:
    """Ground the files and facts; raises like :func:`run`."""
    messages: list[str] = []
    try:
        control = Control(list(arguments), logger=lambda _, text: messages.append(text), message_limit=1000)
        for file in files:
            control.load(str(file))
        control.add("base", [], facts)
        control.ground([("base", []), *(("_product", [Number(number)]) for number in range(products))])
    except RuntimeError as error:
        from foon_asp.asp.encoding import fault  # noqa: PLC0415 (slow to import, needed for faults only)

        raise fault(messages, str(error)) from None
    return control


def search(
    control: Control,
    deadline: Deadline,
    opt_mode: str,
    on_tree: Callable[[frozenset[int]], None] | None = None,
    on_bound: Callable[[list[int]], None] | None = None,
    predicates: Sequence[str] = (),
) -> Run:
    """Search a ground program for the best answer; see :func:`run`."""
    result = Run()
    began = time.perf_counter()
    models = 1 if opt_mode == "ignore" else 0
    try:
        _set(control, opt_mode=opt_mode, models=models, enum_mode="auto", project="no", opt_stop="no")
    except RuntimeError as error:
        raise UserError(str(error)) from None
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
    result.solve_seconds = time.perf_counter() - began
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
