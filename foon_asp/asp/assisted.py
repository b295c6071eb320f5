"""Assistance: units that a person does instead of the robot, in at most a given number."""

from collections.abc import Mapping, Sequence

from foon_asp.asp.assembly import assemble
from foon_asp.asp.settings import Bounded, Settings
from foon_asp.encoding.fact_writer import write_assisted
from foon_asp.encoding.own_encodings import question_encoding
from foon_asp.encoding.stated import Stated
from foon_asp.errors import UserError
from foon_asp.rules.passed_constraint import Constraint, find_constraint

# The predicates that rules may read in this question are local as motion/2 is.
_AS_FACTS = "_by_person(U) :- motion(U,_). _takes_over(P,U) :- motion(P,M), motion(U,M), P < U."
_OF_DOERS = {("rate", 2), ("risk", 2), ("_takes_over", 2), ("_by_person", 1)}


def assistance_bounds(twins: Mapping[int, int], max_assisted: int) -> Bounded:
    """Return bounds by which a person does at most ``max_assisted`` units, and no unit is done twice.

    Each unit that the person can do has a twin, the same unit done by the robot. ``twins`` maps the id of the
    former to that of the latter; ids are those in the whole network. The result is for ``bounded`` of
    :class:`foon_asp.asp.Settings`.
    """
    return Bounded(write_assisted(twins, max_assisted), (question_encoding("assist.lp"),))


def read_who_does_units(constraints: Sequence[Constraint]) -> bool:
    """Whether constraints read who does a unit: its success rate or risk, or predicates about the person.

    Raises as :func:`foon_asp.encoding.encoding.read_encoding` does.
    """
    if not constraints:
        return False
    from foon_asp.encoding.encoding import read_encoding  # noqa: PLC0415 (takes clingo along)
    from foon_asp.rules.stating import load_constraints  # noqa: PLC0415

    files = load_constraints([*map(find_constraint, constraints)]).values()
    return any(_OF_DOERS & read_encoding(rules).used.keys() for rules in files)


def require_local(settings: Settings) -> None:
    """Raise :class:`UserError` for constraints that are not local, or that name a unit by number.

    A constraint is local if units outside the tree do not matter for it. Other constraints would be wrong,
    since a unit may exist twice: done by the robot and by a person. The error has the place of the first
    faulty rule.
    """
    from foon_asp.encoding.encoding import read_encoding  # noqa: PLC0415 (takes clingo along)
    from foon_asp.rules.numbered_units import numbered_unit  # noqa: PLC0415
    from foon_asp.rules.rules import Rules  # noqa: PLC0415
    from foon_asp.rules.stating import load_constraints  # noqa: PLC0415

    program = assemble(settings, lambda _: None)
    files = load_constraints([*map(find_constraint, settings.constraints)]).values()
    encodings = [read_encoding(rules) for rules in (*files, Stated("a person", _AS_FACTS))]
    for encoding in encodings:
        numbered = numbered_unit(encoding.statements)
        if numbered is not None:
            raise UserError(
                f"{numbered.source}: {numbered.text} names a unit by its number, and one that a person does "
                "has another one beside a rule about who does a unit: name it by its motion, inputs or "
                "outputs, or leave one of the two out"
            )
    for shown in Rules(encodings, program.constants[1::2]).shown_rules:
        if not shown.rule.local:
            raise UserError(
                f"{shown.source}: this rule looks at units that the tree need not have "
                f"({shown.rule.nonlocality}). "
                "Beside a rule about who does a unit it would see those twice that a person does better: ask "
                "it about units that are used, or leave one of the two out"
            )
