"""A question as bare clingo is asked: which files, which constants, and the text of ``foon-asp facts``."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from foon_asp.asp.assembly import assemble
from foon_asp.asp.facts import write_least_penalty
from foon_asp.asp.settings import Settings
from foon_asp.asp.solver import program_facts
from foon_asp.problem import Objective, Problem, levels


class BareProgram(NamedTuple):
    """What stands on the command line of clingo.

    ``files`` are encodings and constraints, ``constants`` the arguments that set constants, and ``facts`` the
    text of one more file, as ``foon-asp facts`` prints it. No reduction, bound or second step is in it.
    """

    files: tuple[Path, ...]
    constants: tuple[str, ...]
    facts: str


def bare_program(
    problem: Problem, objectives: Sequence[Objective], settings: Settings, soft: Mapping[Path, int]
) -> BareProgram:
    """Write a question for bare clingo, which finds the same optimum from it.

    ``soft`` are the weights of constraint files that may be broken; the least sum of weights then comes
    first. Under ``success`` clingo goes by rounded weights alone. Raises :class:`UserError` like
    :func:`foon_asp.asp.solve`.
    """
    penalty = ""
    # how long and how we would search is nothing to bare clingo
    settings = settings._replace(time_limit=None, memory_limit=None, deadline=None, session=None)
    if soft:
        from foon_asp.asp.soft import soft_rules  # noqa: PLC0415 (takes clingo along)

        _, _, relaxed = soft_rules(settings, soft)
        settings = settings._replace(relaxed=relaxed)
        penalty = write_least_penalty(len(levels(tuple(objectives))) + 1)
    program = assemble(settings, lambda _: None)
    return BareProgram(
        program.files, program.constants, program_facts(problem, objectives, settings) + penalty
    )
