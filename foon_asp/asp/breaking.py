"""Which rules of the user's a tree breaks, whoever made the tree."""

from collections.abc import Collection

from foon_asp.asp.assembly import assemble
from foon_asp.asp.integrity import IntegrityConstraint
from foon_asp.asp.prepared import Prepared
from foon_asp.asp.settings import Settings
from foon_asp.asp.soft import soft_rules
from foon_asp.encoding.facts import write_least_penalty, write_tree
from foon_asp.errors import UserError
from foon_asp.problem import Objective, Problem, levels, reach


class Breaking:
    """Constraints, read once, to be held against trees that execute.

    ``local`` says that whether a tree keeps to them does not depend on units outside it.
    """

    def __init__(self, settings: Settings) -> None:
        """Read the constraints of settings.

        Raises :class:`UserError` for what is wrong with them.
        """
        rules = assemble(settings, lambda _: None).understood
        self.local = rules is not None and rules.local
        weights = dict.fromkeys(settings.constraints, 1)
        self._rules, _, relaxed = soft_rules(settings._replace(constraints=()), weights)
        self._settings = settings._replace(constraints=(), relaxed=relaxed, session=None)
        self._program = assemble(self._settings, lambda _: None)

    def broken(self, problem: Problem, tree: Collection[int]) -> tuple[IntegrityConstraint, ...]:
        """Give the rules that a tree breaks, by the ids of its units.

        Raises ``KeyboardInterrupt`` at a limit, and :class:`UserError` for a rule without a value.
        """
        units = sorted(tree if self.local else {*tree, *reach(problem).units})
        asked = levels((Objective.UNITS,))
        deadline = self._settings.begun
        first = Prepared(problem, asked, self._settings, deadline, self._program, tuple(units))
        numbers = list(map(problem.network.unit_number, sorted(set(tree))))
        ended = first.run(write_tree(numbers) + write_least_penalty(1), predicates=[("_broken", 2)])
        if not ended.exhausted:
            deadline.check()
            raise KeyboardInterrupt
        if ended.units is None:
            raise UserError(
                "the rules that are added exclude every tree by more than rules that begin with :-, so it "
                "cannot be said which of them a tree breaks"
            )
        ways = ended.atoms["_broken"]
        return tuple(rule for rule in self._rules if ways.get(rule.number))
