"""The units that are in every optimal tree or in some of them, proved without a list of the trees."""

from collections.abc import Iterator
from enum import StrEnum
from fractions import Fraction
from typing import Unpack

from foon_asp.asp.tree_union import tree_union
from foon_asp.json_layout import schema_name
from foon_asp.network import counted
from foon_asp.problem import Problem
from foon_asp.questions.answer import Answer, WithAnswer
from foon_asp.questions.caller import caller
from foon_asp.questions.ending import Ending
from foon_asp.questions.python_arguments import (
    Objectives,
    chosen_objectives,
    problem_for_rules,
    require_at_least,
)
from foon_asp.questions.python_options import CommonOptions, settings_of
from foon_asp.questions.question import not_for_used_up_items, python_question
from foon_asp.results.table import Block
from foon_asp.results.values import Mention
from foon_asp.results.values_of import mention_of, question_fields


class Membership(StrEnum):
    """Whether a unit is in every one of the trees, in some, or not decided."""

    EVERY = "every"
    NOT_EVERY = "some"
    UNKNOWN = "unknown"


_HEADINGS = {
    Membership.EVERY: "in every one",
    Membership.NOT_EVERY: "in some, not in every one",
    Membership.UNKNOWN: "not decided before a limit",
}


class UnitOfTrees(Mention, frozen=True, kw_only=True):
    """A unit that is in some of the trees, or in all.

    Attributes:
        trees: Whether ``every`` tree has it, or only ``some``; ``unknown`` where a limit came first.
    """

    trees: Membership


class UnitUnion(WithAnswer, frozen=True, kw_only=True, tag=schema_name("unit-union")):
    """The units that are in every optimal tree, and those that are in some of them.

    Attributes:
        within: How much worse than the best tree a tree may be by the first objective, in percent; 0 for
            optimal trees.
        complete: Whether it is proved for each unit that every tree has it, or that only some have it.
        units: The units of every tree first, then the others, in the order of their ids.
        answer: The best tree.

    Example:
        >>> found = foon_asp.unit_union(foon_asp.load().problem("ice"), within=50)
        >>> [unit.motion for unit in found.units if unit.trees == "some"], found.complete
        (['twist', 'crush', 'twist', 'pound', 'pour'], True)
    """

    ROWS = "units"

    within: int
    complete: bool
    units: tuple[UnitOfTrees, ...]
    answer: Answer

    @property
    def ending(self) -> Ending:
        """The ending of ``answer``; ``LIMIT`` unless everything is proved."""
        return self.answer.ending if self.complete else Ending.LIMIT

    def show(self) -> Iterator[Block]:
        """Return the cost of the best tree, and the units under headings.

        The headings are: in every tree, in some, not decided. Without a best tree, no units follow.
        """
        yield from (*self.goal_lines(), *self.answer.headlines())
        if self.answer.costs is None:
            return
        trees = f"trees up to {self.within} % worse" if self.within else "optimal trees"
        for membership, heading in _HEADINGS.items():
            units = [unit for unit in self.units if unit.trees is membership]
            if units or membership is Membership.EVERY:
                proved = "" if membership is Membership.UNKNOWN else ", proved"
                yield ""
                yield f"{trees}, {heading}{proved}: {counted(len(units), 'unit')}"
            yield from (f"  {unit.id}  {unit}" for unit in units)


@python_question
def unit_union(
    problem: Problem,
    objectives: Objectives = "units",
    *,
    within: int = 0,
    **options: Unpack[CommonOptions],
) -> UnitUnion:
    """Find the units of every optimal tree and those of some, without a list of the trees.

    A tree that is worse than the best one counts only if no unit of it can be left out.

    Parameters:
        objectives: What is best: one objective, or several in a list, the most important first.
        within: How much worse by the first objective a tree may be, in percent. 10 allows 11 units if 10 are
            best, or 0.9 times the best success.

    Returns:
        The ``units``, each with ``trees``; ``complete`` tells whether everything is proved.

    Raises:
        UserError: for a wrong argument or constraint, for constraints together with ``within``, or for a
            problem whose items are used up.

    Example:
        >>> found = foon_asp.unit_union(foon_asp.load().problem("macaroni"))
        >>> {str(unit.trees) for unit in found.units}, len(found.units)
        ({'every'}, 9)
    """
    require_at_least(within, 0, "within")
    chosen, settings = chosen_objectives(problem, objectives), settings_of(options)
    problem = problem_for_rules(problem, settings)
    if problem.items is not None:
        raise not_for_used_up_items("alternatives --union")
    union = tree_union(problem, chosen, settings, caller().reporter, Fraction(within, 100))
    network = problem.network

    def membership(unit: int) -> Membership:
        """Return whether a unit of the union, by id, is in every tree, in some, or not decided."""
        if unit in union.undecided:
            return Membership.UNKNOWN
        return Membership.EVERY if unit in union.in_every else Membership.NOT_EVERY

    listed = sorted(
        union.in_some | union.undecided, key=lambda unit: (membership(unit) is not Membership.EVERY, unit)
    )
    mentions = [(mention_of(network, unit), membership(unit)) for unit in listed]
    return UnitUnion(
        **question_fields(problem, chosen),
        within=within,
        complete=not union.undecided and union.best.proof is not None,
        units=tuple(
            UnitOfTrees(mention.id, mention.motion, mention.source, trees=trees)
            for mention, trees in mentions
        ),
        answer=Answer.of(union.best),
    )
