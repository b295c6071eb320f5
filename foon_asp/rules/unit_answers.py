"""Evaluation of the rules of one question on single units, by clingo."""

from collections.abc import Collection, Iterable, Mapping, Sequence
from typing import NamedTuple

from foon_asp.deadline import Deadline
from foon_asp.encoding.derived import Value, derive
from foon_asp.encoding.fact_writer import write_facts_read
from foon_asp.encoding.run import ProgramError
from foon_asp.errors import UserError
from foon_asp.network import Network
from foon_asp.problem import Contradiction, Problem, RequiredUnit, Restriction, Role, reach
from foon_asp.rules.clause import Signature
from foon_asp.rules.rule_translation import ANSWER, NOTHING


class UnitAnswers(NamedTuple):
    """The evaluation of rules on single units.

    ``restriction``: the removed units and the required sets; :class:`Contradiction` if no tree keeps to the
    rules.
    ``weights``: for each row, given by its number, the weight of each unit by id.
    """

    restriction: Restriction | Contradiction
    weights: Mapping[int, Mapping[int, int]]


def ask_units(
    problem: Problem,
    units: Collection[int],
    program: Sequence[str],
    read: Collection[Signature],
    deadline: Deadline | None,
) -> UnitAnswers | None:
    """Evaluate the programs of rules on units; with a ``deadline``, in another process.

    ``program`` has the rules as text. ``read`` are the predicates of facts that the rules read. If facts of
    ``units`` cannot be written, the rules are evaluated on the units that can execute. Return ``None`` if
    clingo refuses a rule; the search then reports the message of clingo.

    Raises :class:`UserError` if rules read a price that is not a whole number of hundredths.
    """
    try:
        facts = write_facts_read(problem, sorted(units), read)
    except UserError:  # of units that cannot execute
        facts = write_facts_read(problem, sorted(reach(problem).units), read)
    text = "\n".join([*program, facts])
    try:
        if deadline is None:
            rows = derive(text, *ANSWER)
        else:
            from foon_asp.encoding import program_client  # noqa: PLC0415 (of use with rules of the user only)

            rows = program_client.derive(text, *ANSWER, deadline)
    except ProgramError:
        return None
    return _read_answers(problem, rows)


def candidate_units(network: Network, wanted: Iterable[RequiredUnit]) -> set[int] | None:
    """Return the ids of units that may have the traits in ``wanted``, among them all that rules require.

    Only the first trait of each row in ``wanted`` is looked at. Return ``None`` if a row has no trait.
    """
    units: set[int] = set()
    for row in (row for requirement in wanted for row in requirement.rows):
        if not row:
            return None
        role, word = row[0]
        if role is Role.MOTION:
            units |= {unit for unit, motion in enumerate(network.motions) if motion == word}
        else:
            nodes = {*network.by_label.get(word, ()), *network.by_ingredient.get(word, ())}
            sides = network.producers if role is Role.OUTPUT else network.consumers
            units.update(unit for o in nodes for unit in sides[o])
    return units


def _read_answers(problem: Problem, rows: Iterable[tuple[Value, ...]]) -> UnitAnswers:
    """Return the removed units, required sets and weights in the atoms that clingo derived.

    ``rows`` are the arguments of the atoms ``_of_unit/4`` (see :mod:`foon_asp.rules.rule_translation`).
    Worlds of unknown units are skipped. If there is no tree or a required set is empty, the restriction in
    the result is :class:`Contradiction`.
    """
    removed: set[int] = set()
    required: dict[tuple[Value, Value], set[int] | None] = {}  # None where a set is not needed
    weights: dict[int, dict[int, int]] = {}
    possible = True
    for number, answer, term, world in rows:
        assert isinstance(number, int)
        unit = problem.network.unit_of_number(world) if isinstance(world, int) else None
        if world == NOTHING:
            possible &= answer != "breaks"
            if answer == "meets":
                required[number, term] = None
            else:
                required.setdefault((number, term), set())
        elif unit is None:
            continue
        elif answer == "breaks":
            removed.add(unit)
        elif answer == "weighs":
            row_weights = weights.setdefault(number, {})
            row_weights[unit] = row_weights.get(unit, 0) + (term if isinstance(term, int) else 0)
        elif (units := required.setdefault((number, term), set())) is not None:
            units.add(unit)
    sets = tuple(frozenset(units) for units in required.values() if units is not None)
    if not possible or not all(sets):
        return UnitAnswers(Contradiction(), weights)
    return UnitAnswers(Restriction(removed.__contains__, sets), weights)
