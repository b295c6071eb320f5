"""The best tree for a problem, and what is proved of it."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from foon_asp.asp import Outcome, Reporter, Settings, Status
from foon_asp.asp.assembly import ReachOfRules, reach_of_rules
from foon_asp.asp.optimum import solve as find
from foon_asp.dataset.nearby_optimum import least_with_more, near_goals, solve_nearby
from foon_asp.problem import Objective, Problem, levels
from foon_asp.questions.arguments import asked_with, read, reading
from foon_asp.questions.caller import caller
from foon_asp.questions.result import Ending, Result
from foon_asp.report.answer import answer_json, headline, outcome_foon, outcome_text
from foon_asp.text.json_value import Json, json_text

if TYPE_CHECKING:  # what a command that prints an answer can do without
    from foon_asp.dataset.nearby import Nearby
    from foon_asp.questions.tree import Tree
    from foon_asp.report.drawing import Drawing
    from foon_asp.report.page import Page


def of_status(status: Status) -> Ending:
    """Give the ending of a question from the status of its answer."""
    return {
        Status.OPTIMAL: Ending.DONE,
        Status.INFEASIBLE: Ending.NEGATIVE,
        Status.FEASIBLE: Ending.LIMIT,
        Status.UNKNOWN: Ending.LIMIT,
    }[status]


class Answer(Result, Outcome):
    """The answer to one problem: an :class:`~foon_asp.Outcome` with a text, JSON and a picture.

    ``status`` tells what is proved, ``costs`` what the tree costs, and ``units`` are its units by id in an
    order that executes; :attr:`tree` has them as values.

    Example:
        >>> answer = foon_asp.solve(foon_asp.load().problem("ice"))
        >>> str(answer.status), answer.costs.units, answer.tree
        ('optimal', 2, <Tree for ice; crushed; in [drinking glass]: 2 units>)
        >>> answer.text().splitlines()[1]
        'optimal by units (strict containers): 2 units, 6 inputs, success 0.644'
        >>> answer.json()["status"], answer.json_dict()["level"]
        ('optimal', 3)
        >>> answer.foon().count("//"), answer.steps()[0], answer.json_text()[0], answer.remark("foon")
        (3, '{', '{', '')
        >>> answer.drawing().caption[0], answer.renderable()
        ('Task tree for ice; crushed; in [drinking glass]', None)
        >>> answer.view().title
        'ice; crushed; in [drinking glass] - foon-asp'
    """

    __slots__ = ()

    def __bool__(self) -> bool:
        """Whether there is a tree."""
        return self.units is not None

    @property
    def tree(self) -> "Tree | None":
        """The tree, in an order that executes; ``None`` where there is none."""
        from foon_asp.questions.tree import Tree  # noqa: PLC0415

        return None if self.units is None else Tree.of(self.problem, self.units, headline(self))

    @property
    def ending(self) -> Ending:
        """Done when the tree is proved to be the best."""
        return of_status(self.status)

    def text(self) -> str:
        """Give the answer as ``foon-asp solve`` does."""
        return outcome_text(self, deadline=caller().deadline)

    def json_dict(self) -> Json:
        """Give the answer as ``foon-asp solve --format json`` does; docs/json.md describes it."""
        return answer_json(self)

    def foon(self) -> str:
        """Give the tree as FOON text with a comment that says what it is; empty where there is none."""
        return outcome_foon(self)

    def steps(self) -> str:
        """Give the plan for a robot's program, as JSON; empty where there is none."""
        if self.units is None:
            return ""
        from foon_asp.report.robot_steps import robot_steps  # noqa: PLC0415

        return json_text(robot_steps(self.problem, self.objectives, self.units))

    def remark(self, format_: str) -> str:
        """Say what is claimed, where that is not the best tree."""
        return "" if self.status is Status.OPTIMAL else headline(self)

    def drawing(self) -> "Drawing | None":
        """Give what the picture shows."""
        from foon_asp.report.tree_drawing import solved_tree  # noqa: PLC0415

        return None if self.units is None else solved_tree(self, self.units)

    def view(self) -> "Page":
        """Give the page that shows the tree in any browser; ``write`` writes it, and a notebook shows it."""
        from foon_asp.report.page import Page, view_json  # noqa: PLC0415

        goals = " + ".join(map(str, self.problem.goal_nodes))
        shown = view_json(self.json_dict(), [(self.problem, self.units or ())])
        return Page(f"{goals} - foon-asp", self.text(), shown)

    def _in_notebook(self) -> dict[str, str]:
        """Give what a notebook shows by media type: the picture with its claim, or the text."""
        from foon_asp.report.notebook import picture_bundle  # noqa: PLC0415

        drawing = self.drawing()
        return super()._in_notebook() if drawing is None else picture_bundle(self, drawing)


class WithOutcome(Result):
    """What comes with an ``outcome``: the best tree, which its picture shows, or ``None`` without one."""

    outcome: Answer | None

    def __bool__(self) -> bool:
        """Whether there is a tree."""
        return bool(self.outcome)

    def drawing(self) -> "Drawing | None":
        """Give what the picture of the tree shows."""
        return None if self.outcome is None else self.outcome.drawing()


def answered(
    problem: Problem, objectives: Sequence[Objective], how: Settings, reporter: Reporter | None = None
) -> Answer:
    """Solve a problem, and note how long reading took, if known."""
    return _noted(find(problem, objectives, how, reporter or caller().reporter))


def answered_under(
    problem: Problem, objectives: Sequence[Objective], how: Settings, reporter: Reporter | None = None
) -> Answer:
    """Solve a problem under rules of the user's, which may be about units that no goal needs.

    Of a store, the part that the goals can need is asked about first, where no rule looks beyond a tree. A
    tree with a unit from elsewhere has one more than its goals need: where that makes it no better than what
    was found, no more is read. Where what is near the goals is enough to begin with, it is asked about first.
    """
    near = near_goals(problem, objectives, how)
    if near is not None:
        return answered_nearby(near, objectives, how)
    reporter = reporter or caller().reporter
    how = how._replace(deadline=how.begun)
    found = None
    if hasattr(problem, "near"):  # of a large store
        from foon_asp.dataset.nearby_under_rules import solve_nearby_under  # noqa: PLC0415

        found = solve_nearby_under(problem, objectives, how, reporter)
    if found is not None and (found.proof is not None or found.stopped):
        return _noted(found)
    try:
        answer = _answered_reading(problem, objectives, how, reporter)
    except KeyboardInterrupt:
        if found is None:
            raise
        how.begun.interrupt()
        return _noted(found._replace(stopped=how.begun.stopped))
    if found is not None and answer.status is Status.UNKNOWN:  # there is a tree already
        return _noted(found._replace(stopped=answer.stopped))
    return answer


def _answered_reading(
    problem: Problem, objectives: Sequence[Objective], how: Settings, reporter: Reporter
) -> Answer:
    """Read the part that the goals can need, and where that is not enough, everything."""
    problem = read(problem)
    part = problem.network.object_numbers and problem.items is None and how.constraints
    if part and how.replaced is None and reach_of_rules(how) is ReachOfRules.TREE:
        free = find(problem, objectives, how._replace(constraints=(), constants=()), Reporter())
        if free.status is Status.OPTIMAL and free.costs:
            here = find(problem, objectives, how, Reporter())
            order = levels(tuple(objectives))
            least = least_with_more(free.costs, order)
            if here.status is Status.OPTIMAL and here.costs and here.costs.key(order) <= least:
                return _noted(here)
            try:
                with how.begun.watched("reading"):  # and not late, since there may be a tree already
                    problem = asked_with(problem, how)
            except KeyboardInterrupt:
                if here.units is None:
                    raise
                how.begun.interrupt()
                bounds = {order[0]: free.costs.measure(order[0])}
                here = here._replace(status=Status.FEASIBLE, proof=None, stopped=how.begun.stopped)
                return _noted(here._replace(bounds=bounds))
    return answered(asked_with(problem, how), objectives, how, reporter)


def answered_nearby(near: "Nearby", objectives: Sequence[Objective], how: Settings) -> Answer:
    """Solve a question to a large store, of which no more is read than it takes to prove the answer.

    Without a tree, everything is read, to say why.
    """
    found = solve_nearby(near, objectives, how, caller().reporter)
    if found is not None:
        return _noted(found)
    with reading():
        problem = near.whole()
    return answered_under(problem, objectives, how)


def _noted(outcome: Outcome) -> Answer:
    """Make an answer of an outcome, with how long reading took, if known."""
    answer, read = Answer._make(outcome), caller().read_seconds
    if read is not None:
        answer.seconds["read"] = read
    return answer
