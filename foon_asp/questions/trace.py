"""The kitchen after each step of a plan, and replanning from there."""

from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import replace
from os import PathLike
from pathlib import Path
from typing import Annotated, Any, Unpack

from msgspec import field

from foon_asp.asp import Settings
from foon_asp.errors import UserError
from foon_asp.json_layout import schema_name
from foon_asp.network import FunctionalUnit, ObjectNode
from foon_asp.problem import Problem
from foon_asp.proof.replay import Replay, replay_for, replayable_problem
from foon_asp.questions.answer import Answer, answer_problem
from foon_asp.questions.ending import Ending
from foon_asp.questions.options import AMOUNT, CONTAINERS, GOAL_OF_PLAN, OBJECTIVES, PLAN_ITEMS
from foon_asp.questions.posing_plan import pose_plan_or_state
from foon_asp.questions.python_arguments import Objectives, chosen_objectives, with_items
from foon_asp.questions.python_options import Posed, start_deadline
from foon_asp.questions.question import TABLES, Kind, Option, Role, question
from foon_asp.questions.result import Result
from foon_asp.questions.tree import OTHER_READING, Tree, as_tree
from foon_asp.results.document import AboutGoals, Unserialized
from foon_asp.results.table import Block
from foon_asp.results.values import Copies, Copy, Unit, Value, changed_motions
from foon_asp.results.values_of import copies_of, copy_of, lack_of, question_fields
from foon_asp.text.writer import write_counted_node, write_node
from foon_asp.whole_file import utf_8, write_whole

States = tuple[dict[ObjectNode, int], ...]
"""The number of copies of each object node that can run out, initially and after each step."""


class TracedStep(Value, frozen=True):
    """The effects of a step on the kitchen.

    Attributes:
        step: The number of the step, from 1.
        gone: The copies that it uses up.
        stayed: The copies that it needs and does not use up.
        came: The copies that it makes.
        there: The number of copies of each object node that can run out, after the step.
    """

    step: int
    unit: Unit
    gone: tuple[Copy, ...]
    stayed: tuple[Copy, ...]
    came: tuple[Copy, ...]
    there: tuple[Copies, ...]


class Traced(Result, AboutGoals, frozen=True, kw_only=True, tag=schema_name("trace")):
    """The copies that each step of a plan makes and uses up, and the best plan from a failed step on.

    Attributes:
        executed: The steps that run.
        stopped: In words, the copy that is missing for the next step or a goal; null if the plan runs.
        failed: The number of the step that failed, from 1; null if none did.
        answer: The best plan from the kitchen before the failed step; null if no step failed.

    Example:
        >>> problem = foon_asp.load().problem("ice", items="used-up")
        >>> traced = foon_asp.trace(problem, foon_asp.solve(problem).tree)
        >>> [str(node) for node in traced.copies(2)][:2]
        ['drinking glass; contains {ice}', 'ice cube tray; empty']
        >>> [(str(copy), str(copy.origin)) for copy in traced.executed[1].gone]
        [('ice; cubed; in [drinking glass]', 'step 1')]
        >>> traced.kitchen_text(2).split()[:2], traced.stock_text(2).split()[:3]
        (['O', 'faucet'], ['O', 'drinking', 'glass'])
    """

    ROWS = "executed"

    executed: tuple[TracedStep, ...] = field(name="steps")
    stopped: str | None
    failed: int | None
    answer: Answer | None

    plan = Unserialized[Tree]()
    """The plan that was traced."""

    states = Unserialized[States]()
    """The number of copies of each object node that can run out, initially and after each step."""

    @property
    def ending(self) -> Ending:
        """The ending of the new plan, if a step failed; else ``DONE`` if the plan runs, or ``NEGATIVE``."""
        if self.answer is not None:
            return self.answer.ending
        return Ending.DONE if self.stopped is None else Ending.NEGATIVE

    def copies(self, after: int) -> dict[ObjectNode, int]:
        """Return the number of copies of each object node that can run out, after a step.

        Parameters:
            after: The number of steps that were done, from 0.

        Raises:
            UserError: if the plan does not run so far.
        """
        if not 0 <= after < len(self.states):
            last = len(self.states) - 1
            raise UserError(
                f"found the step {after}, expected one that runs, or 0 for the start: 0 to {last}"
            )
        return self.states[after]

    def kitchen_text(self, after: int) -> str:
        """Return the kitchen after a step as FOON text: each available object node, with its amount.

        Items that never run out have no amount.

        Parameters:
            after: The number of steps that were done, from 0.
        """
        problem = self.plan.problem
        kitchen = (problem.network.objects[o] for o in sorted(problem.kitchen))
        endless = (node for node in kitchen if node not in _stated_stock(problem))
        return "".join(map(write_node, endless)) + self.stock_text(after)

    def stock_text(self, after: int) -> str:
        """Return the stock after a step as FOON text: the nodes that can run out, with amounts.

        Parameters:
            after: The number of steps that were done, from 0.
        """
        return "".join(write_counted_node(node, n) for node, n in self.copies(after).items())

    def show(self) -> Iterator[Block]:
        """Return the steps that were done, each with the copies used up and made, and the copies in the end.

        If a step failed, the steps before it were done, and the new plan follows. If the plan does not run,
        the copy that is missing follows.
        """
        done = len(self.executed) if self.failed is None else self.failed - 1
        for step in self.executed[:done]:
            yield f"{step.step:>3}  {step.unit.motion}    [{step.unit.source[0]}]"
            yield from (f"     - {copies}" for copies in _copy_texts(step.gone))
            yield from (f"     + {copies}" for copies in _copy_texts(step.came))
        yield f"after step {done} there are, beside what never runs out:"
        yield from (f"     {n} x {node}" for node, n in self.copies(done).items())
        if self.answer is not None:
            yield f"step {self.failed} failed; from here:"
            yield self._plan_change_text(self.answer)
            yield from self.answer.show()
        elif self.stopped is not None:
            yield self.stopped
            if self.plan.problem.items is not None:
                yield OTHER_READING

    def _plan_change_text(self, answer: Answer) -> str:
        """Return in words the units in which the new plan differs from what remained of the old one."""
        assert self.failed is not None
        if answer.tree is None:
            return "no plan was found"
        remaining, new = Counter(self.plan.units[self.failed - 1 :]), Counter(answer.tree.units)
        changes = changed_motions((remaining - new).elements(), (new - remaining).elements())
        if not changes:
            return "what was left of the plan is still the best"
        return f"compared with what was left of the plan: {changes}"


def _copy_texts(copies: Iterable[Copy]) -> Iterator[str]:
    """Yield each object node of the copies once, with their number if that is not one: ``2 x egg``."""
    for node, number in Counter(map(str, copies)).items():
        yield node if number == 1 else f"{number} x {node}"


def _stated_stock(problem: Problem) -> dict[ObjectNode, int]:
    """Return the number of copies of each node in stock; empty if items last."""
    return {} if problem.items is None else dict(problem.items.stock)


def _copies_after_steps(problem: Problem, replay: Replay) -> Iterator[dict[ObjectNode, int]]:
    """Yield the number of copies by node: before the first step, and after each step.

    Nodes without a copy are left out. Available nodes without a stock are left out too, since they never run
    out.
    """
    stock = _stated_stock(problem)
    counts = Counter({node: n for node, n in stock.items() if problem.at_hand(node)})
    changes = [((), ()), *((step.came, step.gone) for step in replay.steps)]
    for added, consumed in changes:
        for copies, sign in ((added, 1), (consumed, -1)):
            for copy in copies:
                if copy.node in stock or not problem.at_hand(copy.node):
                    counts[copy.node] += sign
        yield {node: n for node, n in sorted(counts.items(), key=lambda pair: str(pair[0])) if n}


def _trace_and_write(
    problem: Problem,
    plan: Tree | None,
    objectives: Objectives = "units",
    *,
    failed: int | None = None,
    after: int | None = None,
    kitchen_file: Path | None = None,
    stock_file: Path | None = None,
    state: Path | None = None,
    **options: Any,
) -> Result:
    """Trace a plan, and write the kitchen and the stock after a step into files, where named.

    ``after`` is the number of steps done. By default, these are all steps that run or, with ``failed``, those
    before the failed step. With a ``state``, the result is that of :func:`ways_on`, and no file is written.
    Raises :class:`UserError` for options that do not go together.
    """
    if state is not None:
        from foon_asp.questions.ways_on import ways_on  # noqa: PLC0415 (most traces are of plans)

        if any(value is not None for value in (failed, after, kitchen_file, stock_file)):
            raise UserError(
                "--state is a question without a plan: leave --failed, --after, -o and --stock-out out"
            )
        options.pop("items", None)
        return ways_on(problem, state, objectives, **options)
    assert plan is not None
    if after is not None and failed is not None and after != failed - 1:
        raise UserError(f"if step {failed} failed, {failed - 1} steps were done: leave --after out")
    traced = trace(problem, plan, objectives, failed=failed, **options)
    done = len(traced.executed) if after is None else after
    done = done if failed is None else failed - 1
    if kitchen_file is not None:
        write_whole(kitchen_file, utf_8(traced.kitchen_text(done)))
    if stock_file is not None:
        write_whole(stock_file, utf_8(traced.stock_text(done)))
    return traced


@question(
    Option(
        "plan",
        "The plan: FOON text, or an answer in JSON.",
        Kind.FILE,
        Role.PROBLEM,
        metavar="[PLAN]",
        positional=True,
        optional=True,
    ),
    Option(
        "state",
        "In place of a plan, a file with what is there: which units lead to the goals, and what lacks?",
        Kind.FILE,
        Role.PROBLEM | Role.QUESTION,
        metavar="FILE",
    ),
    GOAL_OF_PLAN,
    Option(
        "after", "The number of steps after which to write the kitchen.", Kind.WHOLE, metavar="N", least=0
    ),
    Option(
        "kitchen_file",
        "Write what is there as a kitchen, in FOON text.",
        Kind.WRITTEN,
        flags=("-o", "--output"),
        metavar="FILE",
    ),
    Option(
        "stock_file", "Write its copies as a stock.", Kind.WRITTEN, flags=("--stock-out",), metavar="FILE"
    ),
    OBJECTIVES,
    CONTAINERS,
    *PLAN_ITEMS,
    AMOUNT,
    pose=pose_plan_or_state,
    formats=TABLES,
    command=_trace_and_write,
    help_="""
    \b
    foon-asp trace plan.txt --goal 'greek salad'
    foon-asp trace plan.txt --goal macaroni --after 3 -o state.txt --stock-out stock.txt
    foon-asp trace plan.txt --goal macaroni --failed 4
    foon-asp trace --state state.txt --goal macaroni --format json

    What goes and what comes at each step, counted from 1, and what is there in the end. Each item is used
    once; with --items lasting, what is there can be used again. With --failed, the best plan from what is
    there before that step, by --objective, and how it differs from what was left of the old one.

    With --state, which units lead from what is there to the goals, those that can run now first, and with
    which inputs lacking; and the fewest things without which no tree exists. What is there can be used again.

    Exits with 0 when the plan runs, with 1 when it does not; with --failed as `solve` does; with --state 0
    when there is a tree, 1 when something lacks.
    """,
)
def trace(
    problem: Problem,
    plan: str | PathLike[str] | Iterable[FunctionalUnit],
    objectives: Objectives = "units",
    *,
    failed: Annotated[int | None, Option(metavar="N", least=1)] = None,
    items: str = "used-up",
    **options: Unpack[Posed],
) -> Traced:
    """Return what is in the kitchen after each step of a plan, and plan anew if a step fails.

    Parameters:
        plan: The path of a file (FOON text, or an answer in JSON), or functional units in the order of
            execution.
        failed: The step that failed, of which nothing was done.

    Returns:
        The copies made and used up by each step, the kitchen and the stock after the step, and the new
        ``answer`` if a step ``failed``.

    Raises:
        UserError: if the file cannot be read or contains no plan, or the plan does not run up to the step
            that failed.

    Example:
        >>> problem = foon_asp.load().problem("macaroni", items="used-up")
        >>> plan = foon_asp.solve(problem).tree
        >>> traced = foon_asp.trace(problem, plan, failed=4)
        >>> len(plan), traced.answer.costs.units
        (9, 6)
    """
    chosen = chosen_objectives(problem, objectives)
    problem = with_items(problem, items)
    tree = as_tree(problem, plan)
    network = tree.problem.network
    replay = replay_for(replayable_problem(tree.problem, tree), tree)
    states = tuple(_copies_after_steps(tree.problem, replay))
    shortage, answer = replay.shortage, None
    if failed is not None:
        if not 1 <= failed <= len(replay.steps):
            last = len(replay.steps)
            raise UserError(f"found the step {failed}, expected one up to which the plan runs: 1 to {last}")
        limits = Settings(deadline=start_deadline(options))
        answer = answer_problem(_problem_from_state(problem, states[failed - 1]), chosen, limits)
    executed = []
    for number, step in enumerate(replay.steps, 1):
        gone, stayed, came = (
            tuple(copy_of(network, copy) for copy in copies) for copies in (step.gone, step.stayed, step.came)
        )
        unit = tree.step_unit(number)
        executed.append(TracedStep(number, unit, gone, stayed, came, copies_of(network, states[number])))
    traced = Traced(
        **question_fields(tree.problem),
        executed=tuple(executed),
        stopped=None if shortage is None else tree.lack_text(lack_of(network, shortage)),
        failed=failed,
        answer=answer,
    )
    return traced.set_unserialized(plan=tree, states=states)


def _problem_from_state(problem: Problem, copies: dict[ObjectNode, int]) -> Problem:
    """Return the problem, over the whole network, from the state that some steps of a plan leave.

    ``copies`` has the number of copies by node in this state. If items last, these nodes are added to the
    kitchen. If items are used up, the copies are the stock, and nodes that never run out stay available.
    Nodes that the network lacks are not added to the kitchen.
    """
    problem = problem.whole
    network = problem.network
    present = {o for node in copies if (o := network.object_id(node)) is not None}
    if problem.items is None:
        return replace(problem, kitchen=problem.kitchen | present, origin=None)
    items = replace(problem.items, stock=copies)
    return replace(problem, kitchen=problem.endless | present, items=items, origin=None)
