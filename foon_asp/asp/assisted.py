"""Units done by a person: a bound on their number, and constraints that look at them."""

from collections.abc import Mapping, Sequence

from foon_asp.asp.settings import Bounded
from foon_asp.encoding.facts import write_assisted
from foon_asp.encoding.own_encodings import question_encoding
from foon_asp.rules.constraint import Constraint, find_constraint

_OF_DOERS = {("rate", 2), ("risk", 2), ("_takes_over", 2), ("_by_person", 1)}


def assisted(twins: Mapping[int, int], most: int) -> Bounded:
    """Ask for trees in which a person does at most ``most`` units, and no unit is done twice.

    ``twins`` gives for each unit that is a person's the same unit as the robot does it, both by their ids in
    the whole network. For :class:`foon_asp.asp.Settings`.
    """
    return Bounded(write_assisted(twins, most), (question_encoding("assist.lp"),))


def sees_who_does_it(constraints: Sequence[Constraint]) -> bool:
    """Whether constraints look at who does a unit: at success rates, or at units done by a person.

    Raises what :func:`foon_asp.encoding.encoding.read_encoding` does.
    """
    if not constraints:
        return False
    from foon_asp.encoding.encoding import read_encoding  # noqa: PLC0415 (takes clingo along)
    from foon_asp.rules.stating import loaded  # noqa: PLC0415

    files = loaded([*map(find_constraint, constraints)]).values()
    return any(_OF_DOERS & read_encoding(rules).used.keys() for rules in files)
