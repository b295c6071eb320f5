"""A question for bare clingo: files, constants, and the text of ``foon-asp facts``."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

from foon_asp.asp.assembly import assemble
from foon_asp.asp.outcome import Outcome
from foon_asp.asp.prepared import prepare
from foon_asp.asp.program import Program
from foon_asp.asp.settings import Settings
from foon_asp.asp.used_up import executions_as_good, most_executions
from foon_asp.encoding.facts import write_facts, write_least_penalty, write_objectives, write_times
from foon_asp.encoding.scales import Scales
from foon_asp.errors import UserError
from foon_asp.grounding.number_checks import PLACE
from foon_asp.grounding.stated import Stated
from foon_asp.problem import Objective, Problem, levels, reach, relevant
from foon_asp.rules.constraint import Constraint


class BareProgram(NamedTuple):
    """What a command line of clingo needs.

    ``files`` are encodings and constraints, ``constants`` the arguments that set constants. ``facts``, and
    ``rules`` that are in no file, are the text of one more, as ``foon-asp facts`` prints it. No reduction,
    bound or second step is in it.
    """

    files: tuple[Path, ...]
    constants: tuple[str, ...]
    facts: str
    rules: str

    @property
    def text(self) -> str:
        """The facts, and the rules that are in no file."""
        return self.facts + self.rules


def bare_program(
    problem: Problem, objectives: Sequence[Objective], settings: Settings, soft: Mapping[Constraint, int]
) -> BareProgram:
    """Write a question for bare clingo, which finds the same optimum from it.

    ``soft`` are the weights of constraints that may be broken; the least sum of weights then comes
    first. Under ``success`` clingo goes by rounded weights alone. Raises :class:`UserError` like
    :func:`foon_asp.asp.solve`.
    """
    penalty = ""
    # how long and how we would search is nothing to bare clingo
    settings = settings._replace(deadline=None)
    if soft:
        from foon_asp.asp.soft import soft_rules  # noqa: PLC0415 (takes clingo along)

        _, _, relaxed = soft_rules(settings, soft)
        settings = settings._replace(relaxed=relaxed)
        penalty = write_least_penalty(len(levels(tuple(objectives))) + 1)
    program = assemble(settings, lambda _: None, used_up=problem.items is not None)
    if problem.items is not None:
        if soft:
            raise UserError("soft constraints are not built for items that are used up")
        most = most_executions(problem, objectives, settings)
        asked = levels(tuple(objectives))
        scales = Scales(problem, list(most), asked)
        facts = write_facts(problem, list(most), scales, program.looked_at) + write_objectives(asked)
        number = problem.network.unit_number
        return _written(program, facts + write_times({number(unit): each for unit, each in most.items()}))
    first = prepare(problem, objectives, settings, program._replace(understood=None))
    if first.tree is None:  # bare clingo is to see for itself that a goal cannot be made
        everything = reach(problem)._replace(units=tuple(range(len(problem.network))))
        units = relevant(problem, everything) if program.own else everything.units
        first = replace(first, units=units)
    return _written(program, first.facts + write_objectives(first.levels) + penalty)


def printed_program(
    problem: Problem, objectives: Sequence[Objective], settings: Settings, soft: Mapping[Constraint, int]
) -> BareProgram:
    """Write a question like :func:`bare_program`; with rules that may ask for it, of all units there are."""
    ruled = settings.constraints or settings.encodings or soft
    return bare_program(problem.whole if ruled else problem, objectives, settings, soft)


def bare_plans(
    outcome: Outcome, objectives: Sequence[Objective], settings: Settings
) -> tuple[BareProgram | None, dict[int, tuple[int, int]]]:
    """Write a question about plans for bare clingo, of which an optimal one is known.

    Beside the program, which does not say how often units are executed, gives for each unit its number and
    how often any plan executes it that is as good by the first objective; no program where nothing says so.
    """
    settings = settings._replace(deadline=None)
    most = executions_as_good(outcome, settings)
    if most is None:
        return None, {}
    problem = outcome.problem
    program = assemble(settings, lambda _: None, used_up=True)
    facts = write_facts(problem, list(most), Scales(problem, list(most), objectives), program.looked_at)
    number = problem.network.unit_number
    caps = {unit: (number(unit), each) for unit, each in most.items()}
    return _written(program, facts + write_objectives(objectives)), caps


def _written(program: Program, facts: str) -> BareProgram:
    files = tuple(file for file in program.files if isinstance(file, Path))
    rules = (each for each in program.files if isinstance(each, Stated) and each.place != PLACE)
    stated = (each.text.strip() for each in rules)
    return BareProgram(files, program.constants, facts, program.rules + "".join(map("{}\n".format, stated)))
