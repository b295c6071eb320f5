"""The units that lead from a state to the goals, and the object nodes that are missing."""

from collections.abc import Iterable, Iterator
from dataclasses import replace
from os import PathLike
from typing import Any, Unpack

from foon_asp.asp import Settings, Status
from foon_asp.dataset.paths import as_path
from foon_asp.json_layout import schema_name
from foon_asp.network import ObjectNode, counted
from foon_asp.problem import Problem
from foon_asp.problem.relevance import reach, relevant_units
from foon_asp.questions.answer import Answer, WithAnswer, answer_problem
from foon_asp.questions.caller import asked_by, caller
from foon_asp.questions.ending import Ending
from foon_asp.questions.python_arguments import Objectives, chosen_objectives, over_whole_network
from foon_asp.questions.python_options import Posed, start_deadline
from foon_asp.questions.question import not_for_used_up_items, python_question
from foon_asp.questions.shopping_list import shopping_list
from foon_asp.results.table import Block
from foon_asp.results.values import Node, Unit
from foon_asp.results.values_of import node_of, nodes_of, question_fields, unit_as
from foon_asp.text.line_parser import parse_node


class WayOn(Unit, frozen=True, kw_only=True):
    """A unit that leads to the goals: some irredundant tree from the state has it.

    Attributes:
        lacks: The inputs that it needs and that the state does not have; if empty, it can run now.
    """

    lacks: tuple[Node, ...]


class WaysOn(WithAnswer, frozen=True, kw_only=True, tag=schema_name("state")):
    """The units that lead from a state to the goals, and the nodes that the state lacks.

    Attributes:
        reached: Whether the goals are in the state.
        lacks: The fewest object nodes to add to the state so that the goals can be made, found as a shopping
            list. Empty if the goals can be made already; null if nothing helps, or a limit came first.
        units: The units of all irredundant trees from the state, to which the nodes in ``lacks`` are added.
            Units that can run now come before the others; in both groups, units of the best tree come first.
        answer: The best tree from the state with the nodes it lacks; null without one.

    Example:
        >>> ways = foon_asp.ways_on(foon_asp.load().problem("ice"), ["ice; crushed; in [drinking glass]"])
        >>> ways.reached, ways.units
        (True, ())
    """

    ROWS = "units"

    reached: bool
    lacks: tuple[Node, ...] | None
    units: tuple[WayOn, ...]

    @property
    def ending(self) -> Ending:
        """The ending of ``answer``; ``NEGATIVE`` if the state lacks nodes, or without a tree."""
        if self.lacks:
            return Ending.NEGATIVE
        return Ending.NEGATIVE if self.answer is None else self.answer.ending

    def show(self) -> Iterator[Block]:
        """Return the nodes that the state lacks, the units that can run now, and the best tree.

        Up to ten units that can run now are listed. Of the other units, only the number is shown. If the
        state has the goals, or if nothing was found that would help, there is instead one line that says so.
        """
        yield from self.goal_lines()
        if self.reached:
            yield "the state has it: nothing to do"
            return
        if self.lacks is None:
            yield f"no tree exists from this state, and nothing was found that would help ({self.conditions})"
            return
        if self.lacks:
            yield f"no tree exists from this state ({self.conditions}); it lacks"
            yield from (f"  {node}" for node in self.lacks)
        now = [unit for unit in self.units if not unit.lacks]
        number = counted(len(now), "unit") if now else "no unit"
        yield f"{number} that can run now lead{'' if len(now) > 1 else 's'} to the goals"
        yield from (f"  {unit.id}  {unit.motion}    [{unit.source[0]}]" for unit in now[:10])
        if len(now) > 10:
            yield f"  ... and {len(now) - 10} more"
        if later := len(self.units) - len(now):
            yield f"{counted(later, 'unit')} that cannot run yet; --format json says what each lacks"
        if self.answer is not None:
            yield "from here:" if not self.lacks else "once that is there:"
            yield from self.answer.findings()


@python_question
def ways_on(
    problem: Problem,
    state: str | PathLike[str] | Iterable[str | ObjectNode],
    objectives: Objectives = "units",
    **options: Unpack[Posed],
) -> WaysOn:
    """Find the units that lead from a state to the goals, and what is missing.

    Whatever is in the state can be used again and again. This question is for verifiers that check the plan
    of a language model after each step (as in arXiv 2503.21564).

    Parameters:
        problem: The problem: the data, and the goals. Its kitchen is not used.
        state: The object nodes that are available, or a file that lists them as a kitchen file does.
        objectives: What the best tree is best by, the most important first.

    Returns:
        The ``units`` that lead to the goals, each with the inputs that it lacks; what the state ``lacks``,
        and the best tree as the ``answer``.

    Raises:
        UserError: for a state that cannot be read, or a problem whose items are used up.

    Example:
        >>> problem = foon_asp.load().problem("ice")
        >>> ways = foon_asp.ways_on(problem, ["ice; cubed; in [drinking glass]", "muddler; clean"])
        >>> [str(node) for node in ways.lacks], [unit.motion for unit in ways.units if not unit.lacks]
        (['drinking glass; contains {ice}'], [])
    """
    if problem.items is not None:
        raise not_for_used_up_items("trace --state")
    state_source: Any = as_path(state) if isinstance(state, str | PathLike) else tuple(state)
    problem = over_whole_network(problem.vary(kitchen=state_source))
    chosen, limits = chosen_objectives(problem, objectives), Settings(deadline=start_deadline(options))
    answer: Answer | None = answer_problem(problem, chosen, limits)
    lacks: tuple[Node, ...] | None = ()
    if answer is not None and answer.status is Status.INFEASIBLE:
        with asked_by(caller()._replace(deadline=limits.effective_deadline)):
            shopping = shopping_list(problem, chosen, lists=1)
        lacks = shopping.lists[0].items if shopping.lists else None
        answer = shopping.answer
    added = {o for node in lacks or () if (o := problem.network.object_id(parse_node(node.node))) is not None}
    return WaysOn(
        **question_fields(problem, chosen),
        reached=problem.kitchen.issuperset(problem.goals),
        lacks=lacks if lacks is None else tuple(node_of(problem.network, o) for o in sorted(added)),
        units=tuple(_units_to_goals(problem, replace(problem, kitchen=problem.kitchen | added), answer)),
        answer=answer,
    )


def _units_to_goals(problem: Problem, stocked: Problem, answer: Answer | None) -> Iterator[WayOn]:
    """Yield the units that lead to the goals, in the order of :class:`WaysOn`, with the inputs they lack.

    ``stocked`` is the problem whose kitchen also has the nodes that the state lacks. ``answer`` has the best
    tree for ``stocked``; ``None`` without one.
    """
    best = frozenset() if answer is None else frozenset(answer.ids or ())
    lacking = {
        unit: [o for o in problem.needs[unit] if o not in problem.kitchen]
        for unit in relevant_units(stocked, reach(stocked))
    }
    for unit in sorted(lacking, key=lambda unit: (bool(lacking[unit]), unit not in best, unit)):
        yield unit_as(WayOn, problem.network, unit, lacks=nodes_of(problem.network, lacking[unit]))
