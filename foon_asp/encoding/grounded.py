"""A ground program under limits, in this process or in a worker."""

import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from foon_asp.deadline import Deadline, LimitError
from foon_asp.encoding.ground_program import GroundProgram
from foon_asp.encoding.run import FoundAnswer, Run
from foon_asp.encoding.stated import Loaded

if TYPE_CHECKING:
    from foon_asp.encoding.program_client import WorkerProgram


class Grounded:
    """Ground program of files and text, in this process or in a worker process.

    A worker is used if grounding may not terminate (``endless``), if the text has more than 1,500,000
    letters, or if memory is limited. It is killed at the limits and at ctrl-C. ``products`` is the number of
    products of rates in the text. ``doing`` names the phase in messages about limits.

    Raises :class:`foon_asp.encoding.run.ProgramError` if clingo refuses the program, and :class:`LimitError`
    at a limit.
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
        """Ground the files and the text, in this process or in a worker; set ``doing`` in the deadline."""
        deadline.doing = doing
        deadline.check()
        names = [str(file) if isinstance(file, Path) else file for file in files]
        self._program: GroundProgram | WorkerProgram
        # the built-in encodings ground facts of that length in a fraction of a second
        if endless or len(text) > 1_500_000 or deadline.memory is not None:
            from foon_asp.encoding import program_client  # noqa: PLC0415 (often not needed)

            self._program = program_client.WorkerProgram(names, text, arguments, products, deadline)
        else:
            self._program = GroundProgram(names, text, arguments, products)

    def consequences(self, predicates: Sequence[tuple[str, int]]) -> list[list[tuple[int, ...]]]:
        """Return the arguments of all atoms of each predicate, given by name and arity.

        The result has a list for each predicate; all arguments have to be numbers. The rules have to be
        stratified. Raises :class:`LimitError` if a limit is reached in a worker.
        """
        return self._program.consequences(predicates)

    def search(
        self,
        deadline: Deadline,
        opt_mode: str,
        on_tree: Callable[[frozenset[int]], None] | None = None,
        on_bound: Callable[[list[int]], None] | None = None,
        predicates: Sequence[tuple[str, int]] = (),
    ) -> Run:
        """Search for the best answer, and return the run; at a limit or ctrl-C, it has the last answer.

        Parameters:
            deadline: The limits of the search.
            opt_mode: As in clasp: ``opt``, ``opt,BOUND,...`` or ``ignore`` (stop at the first answer).
            on_tree: Is called with the numbers of the units of each answer.
            on_bound: Is called with the greatest lower bound so far, by priority, whenever clingo proves one.
            predicates: Predicates (name and arity) whose atoms the run has in addition to ``use``. The first
                argument of their atoms is a number.

        Raises any error that ``on_tree`` raises, and :class:`UserError` for invalid answers.
        """
        result = Run()
        began = time.perf_counter()

        def record_answer(answer: FoundAnswer) -> None:
            """Record an answer in the run, and report its units."""
            result.units, result.cost, result.atoms, result.rows = answer
            if on_tree:
                on_tree(answer.units)

        def record_bound(lower: list[int]) -> None:
            """Record a lower bound in the run if it is the greatest, and report the greatest so far."""
            result.lower = max(result.lower, lower)  # a lesser bound may arrive later; all are valid
            if on_bound:
                on_bound(result.lower)

        try:
            self._begin_phase("searching", deadline)
            result.exhausted, result.statistics = self._program.search(
                opt_mode, predicates, record_answer, record_bound
            )
        except LimitError:  # the last answer remains
            pass
        result.solve_seconds = time.perf_counter() - began
        return result

    def close(self) -> None:
        """Release the program; dropping the last reference does so, too."""
        self._program.close()

    def _begin_phase(self, doing: str, deadline: Deadline) -> None:
        """Set the deadline of a phase and its name in messages.

        Raises :class:`LimitError` if the deadline has passed.
        """
        deadline.doing = doing
        deadline.check()
        self._program.deadline = deadline
