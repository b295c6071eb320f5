"""Several goals together: what one tree for all costs beside a tree for each."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

from foon_asp.asp import Reporter, solve
from foon_asp.asp.postconditions import Postconditions
from foon_asp.dataset.paths import File, Files
from foon_asp.deadline import Cancel
from foon_asp.document.json_document import document, figure_json, nodes_json
from foon_asp.errors import UserError
from foon_asp.network import counted
from foon_asp.problem import Objective, Problem, levels, multiplies
from foon_asp.problem.progress import OnProgress
from foon_asp.questions.answer import Answer
from foon_asp.questions.arguments import Constants, Objectives, asked_with, chosen_objectives, settings
from foon_asp.questions.caller import caller
from foon_asp.questions.contract import TABLES, question
from foon_asp.questions.options import HOW, TREE
from foon_asp.questions.result import Ending, Result
from foon_asp.report.answer import headline, steps, success_text
from foon_asp.report.drawing import Drawing


@dataclass(frozen=True, repr=False)
class Menu(Result):
    """One tree for all goals (``together``), and one for each goal in order (``separate``).

    ``serves`` has, for each unit of the common tree by id, the goals (by object node id) that need it,
    followed back from each goal through the first makers.

    Example:
        >>> menu = foon_asp.menu(foon_asp.load().problem("ice", "tea"))
        >>> menu.together.costs.units, len(menu.shared)
        (9, 0)
        >>> menu.sum_of_separate(foon_asp.Objective.UNITS)
        9
    """

    together: Answer
    separate: tuple[Answer, ...]
    serves: Mapping[int, tuple[int, ...]]

    @property
    def shared(self) -> tuple[int, ...]:
        """The units of the tree for all that serve several goals, in the order of the tree."""
        return tuple(u for u in self.together.units or () if len(self.serves[u]) > 1)

    def sum_of_separate(self, objective: Objective) -> int | Fraction | None:
        """Add up what the separate trees cost (``success``: multiply); ``None`` if one goal has no tree.

        Parameters:
            objective: The objective.
        """
        total: int | Fraction = Fraction(1) if multiplies(objective) else 0
        for answer in self.separate:
            if answer.costs is None:
                return None
            figure = answer.costs.measure(objective)
            total = total * figure if multiplies(objective) else total + figure
        return total

    @property
    def ending(self) -> Ending:
        """Done when every answer is proved."""
        stopped = any(answer.ending is Ending.LIMIT for answer in self.separate)
        return Ending.LIMIT if stopped else self.together.ending

    def text(self) -> str:
        """Give the costs together and one by one, what is shared, and the tree for all."""
        return "\n".join(_lines(self)) + "\n"

    def json_dict(self) -> object:
        """Give all answers, the sum of the separate ones, and which goals each unit serves."""
        problem, objectives = self.together.problem, self.together.objectives
        network = problem.network
        return document(
            "menu",
            problem,
            objectives,
            answer=self.together.json_dict(),
            separate=[answer.json_dict() for answer in self.separate],
            sum_of_separate=figure_json(objectives[0], self.sum_of_separate(objectives[0])),
            serves=[
                {"unit": network.unit_number(unit), "goals": nodes_json(network, goals)}
                for unit, goals in self.serves.items()
            ],
        )

    def drawing(self) -> Drawing | None:
        """Give what the picture of the tree for all shows."""
        return self.together.drawing()

    def __repr__(self) -> str:
        return f"<Menu of {len(self.separate)}: {headline(self.together)}>"


@question(
    *TREE,
    *HOW,
    formats=TABLES,
    help_="""
    \b
    foon-asp menu --goal macaroni --goal omelet
    foon-asp menu --goal macaroni --goal omelet --objective success

    Exits with 0 when all are proved, 1 when no tree makes all goals, 3 when a limit came first.
    """,
)
def menu(
    problem: Problem,
    objectives: Objectives = "units",
    *,
    constraints: Files = (),
    constants: Constants | None = None,
    encodings: File | None = None,
    time_limit: float | None = None,
    memory_limit: int | str | None = None,
    on_progress: OnProgress | None = None,
    cancel: Cancel | None = None,
) -> Menu:
    """Solve several goals with one tree and each by itself, and find the units they share.

    The limits are for the whole question.

    Parameters:
        problem: A problem with two goals or more, made by :meth:`foon_asp.Foon.problem`.

    Returns:
        The best tree for all goals (``together``), those for single goals (``separate``), and the units that
        serve several goals (``shared``).

    Raises:
        UserError: for a wrong argument or constraint, or a single goal.

    Example:
        >>> found = foon_asp.menu(foon_asp.load().problem("ice", "tea"))
        >>> found.together.costs.units, [answer.costs.units for answer in found.separate]
        (9, [2, 7])
    """
    if len(problem.goals) < 2:
        raise UserError("a menu has several goals: name two or more")
    chosen = chosen_objectives(problem, objectives)
    how = settings(constraints, constants, encodings, time_limit, memory_limit)
    problem = asked_with(problem, how)
    together = solve(problem, chosen, how, caller().reporter)
    separate = [solve(replace(problem, goals=(goal,)), chosen, how, Reporter()) for goal in problem.goals]
    if how.constraints == () and how.replaced is None:  # else goals may have rules of their own
        holds = Postconditions(problem, levels(chosen), how)
        for goal, alone in zip(problem.goals, separate, strict=True):
            holds.no_better(together, alone, f"for goal {goal} alone")
    serves = _serves(problem, together.units or ())
    return Menu(Answer._make(together), tuple(map(Answer._make, separate)), serves)


def _serves(problem: Problem, units: Sequence[int]) -> dict[int, tuple[int, ...]]:
    """Say which goals each unit of a tree, given in an order that executes, is needed for."""
    makers: dict[int, int] = {}
    for unit in units:
        for o in problem.gives[unit]:
            if o not in problem.kitchen:
                makers.setdefault(o, unit)
    served: dict[int, list[int]] = {unit: [] for unit in units}
    for goal in problem.goals:
        stack, seen = [goal], set[int]()
        while stack:
            maker = makers.get(stack.pop())
            if maker is not None and maker not in seen:
                seen.add(maker)
                served[maker].append(goal)
                stack.extend(problem.needs[maker])
    return {unit: tuple(goals) for unit, goals in served.items()}


def _lines(menu: Menu) -> Iterator[str]:
    problem = menu.together.problem
    objects = problem.network.objects
    for goal, answer in zip(problem.goals, menu.separate, strict=True):
        yield f"{objects[goal]}"
        yield f"  {headline(answer)}"
    yield f"all {len(problem.goals)} by one tree"
    yield f"  {headline(menu.together)}"
    if menu.together.costs is None or menu.together.units is None:
        return
    first = menu.together.objectives[0]
    total = menu.sum_of_separate(first)
    if total is not None:
        ours = menu.together.costs.measure(first)
        if multiplies(first):
            shown = f"one by one {success_text(Fraction(total))}, together {success_text(Fraction(ours))}"
        else:
            shown = f"one by one {total} {first}, together {ours}"
        yield f"{shown}; {counted(len(menu.shared), 'unit')} shared"
    for unit in menu.shared:
        names = ", ".join(objects[goal].label for goal in menu.serves[unit])
        yield f"  {problem.network.motions[unit]}    [{problem.network.sources[unit][0]}] for {names}"
    yield ""
    yield from steps(problem, menu.together.units)
