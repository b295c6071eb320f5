"""Facts and rules of a problem for bare clingo."""

from collections.abc import Mapping, Sequence

from foon_asp.asp import Settings
from foon_asp.asp.bare_program import printable_program
from foon_asp.json_layout import schema_name
from foon_asp.problem import Objective, Problem
from foon_asp.results.document import AboutGoals
from foon_asp.results.values_of import question_fields
from foon_asp.rules.passed_constraint import Constraint


class Facts(AboutGoals, frozen=True, kw_only=True, tag=schema_name("facts")):
    """The facts and rules that the solver reads.

    Attributes:
        facts: Lines of facts in the syntax of clingo; with soft constraints, also of rules.
    """

    facts: tuple[str, ...]

    @property
    def program(self) -> str:
        """The facts as the text of a program."""
        return "".join(f"{line}\n" for line in self.facts)


def facts_of(
    problem: Problem, objectives: Sequence[Objective], settings: Settings, soft: Mapping[Constraint, int]
) -> Facts:
    """Return the facts for bare clingo, with those rules of users that bare clingo cannot read from a file.

    With user rules or replaced encodings, the facts are for the whole network. ``soft`` maps soft constraints
    to their weights.
    """
    program = printable_program(problem, objectives, settings, soft).text
    lines = program.rstrip("\n").split("\n")  # a name may hold what other letters end a line
    return Facts(**question_fields(problem, objectives), facts=tuple(lines))
