"""Programs for bare clingo: clingo run by a user or an engine, without the reductions of this program."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

from foon_asp.asp.assembly import assemble
from foon_asp.asp.outcome import Outcome
from foon_asp.asp.prepared import prepare
from foon_asp.asp.program import Program
from foon_asp.asp.settings import Settings
from foon_asp.encoding.cost_scales import Scales
from foon_asp.encoding.fact_writer import write_facts, write_least_penalty, write_objectives, write_times
from foon_asp.encoding.number_checks import CHECKS_FILE
from foon_asp.encoding.stated import Stated
from foon_asp.errors import UserError
from foon_asp.plans.most_executions import executions_as_good, most_executions
from foon_asp.problem import Objective, Problem, levels, reach, relevant_units
from foon_asp.rules.passed_constraint import Constraint


class BareProgram(NamedTuple):
    """The files, arguments and text for a command line of clingo.

    ``files``: the encodings and constraints.
    ``constants``: the arguments that set constants.
    ``facts``: the facts of the question.
    ``rules``: the rules that are in no file.

    Facts and rules are the text of one more file, as ``foon-asp facts`` prints it.
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
    """Return a program with which bare clingo finds the optimum of a question.

    ``soft`` has the weight of each constraint that may be broken. If there is one, the first objective is the
    least sum of the weights of broken rules. Under ``success``, clingo compares rounded weights, so its
    optimum may differ in the last digits. The limits of ``settings`` are ignored. If there is no tree, the
    program has all units that could matter. So clingo can prove that no tree exists.

    Raises :class:`UserError` like :func:`foon_asp.asp.solve`. If items are used up, also raises it for soft
    constraints and for amounts.
    """
    penalty = ""
    # limits of time do not apply to bare clingo
    settings = settings._replace(deadline=None)
    if soft:
        from foon_asp.asp.soft import soft_rules  # noqa: PLC0415 (takes clingo along)

        _, _, relaxed = soft_rules(settings, soft)
        settings = settings._replace(relaxed=relaxed)
        penalty = write_least_penalty(len(levels(tuple(objectives))) + 1)
    program = assemble(settings, lambda _: None, used_up=problem.items is not None)
    if problem.items is not None:
        _require_no_amounts(problem)
        if soft:
            raise UserError("soft constraints are not built for items that are used up")
        executions = most_executions(problem, objectives, settings)
        objective_levels = levels(tuple(objectives))
        scales = Scales(problem, list(executions), objective_levels)
        facts = write_facts(problem, list(executions), scales, program.looked_at) + write_objectives(
            objective_levels
        )
        unit_number = problem.network.unit_number
        return _bare_program_of(
            program, facts + write_times({unit_number(unit): bounds for unit, bounds in executions.items()})
        )
    prepared = prepare(problem, objectives, settings, program._replace(understood=None))
    if prepared.tree is None:  # with all units, bare clingo can prove that a goal cannot be made
        all_reached = reach(problem)._replace(units=tuple(range(len(problem.network))))
        units = relevant_units(problem, all_reached) if program.is_built_in else all_reached.units
        prepared = replace(prepared, units=units)
    return _bare_program_of(program, prepared.facts + write_objectives(prepared.levels) + penalty)


def printable_program(
    problem: Problem, objectives: Sequence[Objective], settings: Settings, soft: Mapping[Constraint, int]
) -> BareProgram:
    """Return the program of :func:`bare_program`.

    With user rules or replaced encodings, the program is over the whole network.
    """
    has_rules = settings.constraints or settings.encodings or soft
    return bare_program(problem.whole if has_rules else problem, objectives, settings, soft)


def bare_plan_program(
    outcome: Outcome, objectives: Sequence[Objective], settings: Settings
) -> tuple[BareProgram | None, dict[int, tuple[int, int]]]:
    """Return a program with which bare clingo finds the optimum of a question about plans.

    ``outcome`` is an optimal plan. The program has no facts that limit how often units are executed. These
    limits are the second value: it maps the id of each unit to a pair. The pair is the unit's id in the whole
    network, and its greatest number of executions in any plan as good by the first objective. If the numbers
    of executions are unbounded, the result is ``None`` and an empty mapping.
    """
    settings = settings._replace(deadline=None)
    executions = executions_as_good(outcome, settings)
    if executions is None:
        return None, {}
    problem = outcome.problem
    program = assemble(settings, lambda _: None, used_up=True)
    facts = write_facts(
        problem, list(executions), Scales(problem, list(executions), objectives), program.looked_at
    )
    unit_number = problem.network.unit_number
    caps = {unit: (unit_number(unit), cap) for unit, cap in executions.items()}
    return _bare_program_of(program, facts + write_objectives(objectives)), caps


def _require_no_amounts(problem: Problem) -> None:
    """Raise :class:`UserError` if amounts count: several copies of a node are taken, made or wanted.

    The encodings have one copy of each output.
    """
    if problem.counts_amounts:
        raise UserError("amounts are not built for bare clingo, whose encodings have one copy of each output")


def _bare_program_of(program: Program, facts: str) -> BareProgram:
    """Return a program for bare clingo: the files of ``program``, these facts, and its rules as text.

    Options of clingo, and rules that check for overflow of numbers, are left out.
    """
    files = tuple(file for file in program.files if isinstance(file, Path))
    rules = (
        stated_rules
        for stated_rules in program.files
        if isinstance(stated_rules, Stated) and stated_rules.place != CHECKS_FILE
    )
    stated = (stated_rules.text.strip() for stated_rules in rules)
    return BareProgram(files, program.constants, facts, program.rules + "".join(map("{}\n".format, stated)))
