"""A ground program that keeps to limits, wherever it is."""

import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from foon_asp.deadline import Deadline, LimitError
from foon_asp.grounding.ground_program import GroundProgram
from foon_asp.grounding.run import Heard, Run
from foon_asp.grounding.stated import Loaded

if TYPE_CHECKING:
    from foon_asp.grounding.worker_process import WorkerProgram

_SMALL = 1_500_000  # letters that encodings of ours ground in a fraction of a second


class Grounded:
    """Files and text, grounded.

    With ``endless``, for rules whose grounding may have no end, it is in a process of its own, which ends at
    the limits and at ctrl-C; so it is where there is much text, and where the memory is limited. ``doing`` is
    what a limit says of it. Raises :class:`foon_asp.grounding.run.ProgramError` for what clingo refuses, and
    :class:`LimitError`.
    """

    def __init__(
        self,
        files: Sequence[Loaded],
        text: str,
        arguments: Sequence[str],
        products: int,
        deadline: Deadline,
        endless: bool,
        doing: str = "grounding",
    ) -> None:
        deadline.doing = doing
        deadline.check()
        names = [str(file) if isinstance(file, Path) else file for file in files]
        self._program: GroundProgram | WorkerProgram
        if endless or len(text) > _SMALL or deadline.memory is not None:
            from foon_asp.grounding import worker_process  # noqa: PLC0415 (often not needed)

            self._program = worker_process.WorkerProgram(names, text, arguments, products, deadline)
        else:
            self._program = GroundProgram(names, text, arguments, products)

    def consequences(self, predicates: Sequence[tuple[str, int]]) -> list[list[tuple[int, ...]]]:
        """Give for each predicate, by name and arity, the numbers of its atoms; raises as the class does."""
        return self._program.consequences(predicates)

    def search(
        self,
        deadline: Deadline,
        opt_mode: str,
        on_tree: Callable[[frozenset[int]], None] | None = None,
        on_bound: Callable[[list[int]], None] | None = None,
        predicates: Sequence[tuple[str, int]] = (),
    ) -> Run:
        """Search for the best answer; at a limit, or at ctrl-C, what was found before.

        ``opt_mode`` is clasp's: ``opt``, ``opt,BOUND,...`` or ``ignore`` (the first answer will do).
        ``predicates``, by name and arity, have atoms that are wanted besides ``use``, which begin with a
        number. Raises what ``on_tree`` raises, and :class:`UserError` for answers that are none.
        """
        result = Run()
        began = time.perf_counter()

        def tree(heard: Heard) -> None:
            result.units, result.cost, result.atoms, result.rows = heard
            if on_tree:
                on_tree(heard.units)

        def bound(lower: list[int]) -> None:
            result.lower = max(result.lower, lower)  # a lesser one may come behind; each of them holds
            if on_bound:
                on_bound(result.lower)

        try:
            self._begin("searching", deadline)
            result.exhausted, result.statistics = self._program.search(opt_mode, predicates, tree, bound)
        except LimitError:  # what was heard stands
            pass
        result.solve_seconds = time.perf_counter() - began
        return result

    def close(self) -> None:
        """Say that it is not needed any more; so is one that is dropped."""
        self._program.close()

    def _begin(self, doing: str, deadline: Deadline) -> None:
        deadline.doing = doing
        deadline.check()
        self._program.deadline = deadline
