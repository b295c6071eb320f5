"""What is in the kitchen after each step of a plan, and how to go on from there."""

from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from os import PathLike
from pathlib import Path

from foon_asp.dataset.paths import File
from foon_asp.deadline import Cancel
from foon_asp.document.json_document import document, listed_unit_json, named_json
from foon_asp.errors import UserError
from foon_asp.network import FunctionalUnit, ObjectNode
from foon_asp.problem import Problem, UsedUp
from foon_asp.problem.progress import OnProgress
from foon_asp.proof.replay import Copy, Replay, replay_for
from foon_asp.questions.answer import Answer, answered
from foon_asp.questions.arguments import Objectives, chosen_objectives, settings
from foon_asp.questions.contract import TABLES, Kind, Option, question
from foon_asp.questions.options import CONTAINERS, GOALS, ITEMS, LIMITS, OBJECTIVES
from foon_asp.questions.result import Ending, Result
from foon_asp.questions.tree import Tree
from foon_asp.report.answer import changes_text
from foon_asp.report.replay import shortage_text
from foon_asp.report.robot_steps import replayable
from foon_asp.report.whole_file import utf_8, write_whole
from foon_asp.text.json_value import Json
from foon_asp.text.writer import write_node


@dataclass(frozen=True, repr=False)
class Traced(Result):
    """A ``plan``, and the ``replay`` that says what came and what went at each step.

    ``failed`` is the step that failed, counted from 1, or ``None``; ``answer`` is then the best plan from
    what is there without it.

    Example:
        >>> problem = foon_asp.load().problem("ice", items="used-up")
        >>> traced = foon_asp.trace(problem, foon_asp.solve(problem).tree)
        >>> [str(node) for node in traced.copies(2)][:2]
        ['drinking glass; contains {ice}', 'ice cube tray; empty']
        >>> traced.kitchen_text(2).split()[:2], traced.stock_text(2).split()[:3]
        (['O', 'faucet'], ['O', 'drinking', 'glass'])
    """

    plan: Tree
    replay: Replay
    failed: int | None = None
    answer: Answer | None = None

    @property
    def ending(self) -> Ending:
        """As the new plan was found, if a step failed; else done when the plan runs."""
        if self.answer is not None:
            return self.answer.ending
        return Ending.DONE if self.replay.shortage is None else Ending.NEGATIVE

    def copies(self, after: int) -> dict[ObjectNode, int]:
        """Count what is there after a step, but for what never runs out.

        Parameters:
            after: The number of steps that were done, from 0.

        Raises:
            UserError: if the plan does not run so far.
        """
        if not 0 <= after <= len(self.replay.steps):
            ran = len(self.replay.steps)
            raise UserError(f"found the step {after}, expected one that runs, or 0 for the start: 0 to {ran}")
        problem = self.plan.problem
        counts = Counter({node: n for node, n in _stock(problem).items() if problem.at_hand(node)})
        for step in self.replay.steps[:after]:
            counts.update(copy.node for copy in step.came if not _endless(problem, copy.node))
            counts.subtract(copy.node for copy in step.gone if not _endless(problem, copy.node))
        return {node: n for node, n in sorted(counts.items(), key=lambda each: str(each[0])) if n}

    def kitchen_text(self, after: int) -> str:
        """Give the kitchen after a step as FOON text: each object node that is there, once.

        Parameters:
            after: The number of steps that were done, from 0.
        """
        problem = self.plan.problem
        objects = problem.network.objects
        endless = [objects[o] for o in sorted(problem.kitchen) if _endless(problem, objects[o])]
        return "".join(map(write_node, [*endless, *self.copies(after)]))

    def stock_text(self, after: int) -> str:
        """Give the stock after a step as FOON text: an object block for each copy.

        Parameters:
            after: The number of steps that were done, from 0.
        """
        return "".join(write_node(node) * n for node, n in self.copies(after).items())

    def text(self) -> str:
        """List the steps with what goes and what comes, and what is there in the end."""
        return "\n".join(self._lines()) + "\n"

    def json_dict(self) -> object:
        """Give the same; steps count from 1."""
        problem = self.plan.problem
        shortage = self.replay.shortage
        steps = []
        for number, step in enumerate(self.replay.steps, 1):
            unit = listed_unit_json(problem.network, step.unit, self.plan.places[number - 1])
            steps.append(
                {
                    "step": number,
                    "unit": unit,
                    "gone": [self._copy_json(copy) for copy in step.gone],
                    "stayed": [self._copy_json(copy) for copy in step.stayed],
                    "came": [self._copy_json(copy) for copy in step.came],
                    "there": [
                        {"object": named_json(problem.network, node), "copies": n}
                        for node, n in self.copies(number).items()
                    ],
                }
            )
        listed = list(zip(self.plan.units, self.plan.places, strict=True))
        return document(
            "trace",
            problem,
            steps=steps,
            stopped=None if shortage is None else shortage_text(listed, shortage),
            failed=self.failed,
            answer=None if self.answer is None else self.answer.json_dict(),
        )

    def _copy_json(self, copy: Copy) -> Json:
        made = {"kitchen": True} if copy.made is None else {"step": copy.made + 1}
        return {**named_json(self.plan.problem.network, copy.node), "from": made}

    def _lines(self) -> Iterator[str]:
        done = len(self.replay.steps) if self.failed is None else self.failed - 1
        for number, step in enumerate(self.replay.steps[:done], 1):
            yield f"{number:>3}  {step.unit.motion}    [{self.plan.places[number - 1]}]"
            yield from (f"     - {copy.node}" for copy in step.gone)
            yield from (f"     + {copy.node}" for copy in step.came)
        yield f"after step {done} there are, beside what never runs out:"
        yield from (f"     {n} x {node}" for node, n in self.copies(done).items())
        if self.answer is not None:
            yield f"step {self.failed} failed; from here:"
            yield self._change(self.answer)
            yield self.answer.text().rstrip("\n")
        elif self.replay.shortage is not None:
            listed = list(zip(self.plan.units, self.plan.places, strict=True))
            yield shortage_text(listed, self.replay.shortage)

    def _change(self, answer: Answer) -> str:
        """Say how the new plan differs from what was left of the old one."""
        assert self.failed is not None
        if answer.units is None:
            return "there is no plan in hand"
        network = answer.problem.network
        left = Counter(network.unit_id(unit) for unit in self.plan.units[self.failed - 1 :])
        new = Counter[int | None](answer.units)
        gone = [unit for unit in (left - new).elements() if unit is not None]
        come = [unit for unit in (new - left).elements() if unit is not None]
        if not gone and not come:
            return "what was left of the plan is still the best"
        return f"compared with what was left of the plan: {changes_text(network, gone, come)}"


def _stock(problem: Problem) -> dict[ObjectNode, int]:
    return {} if problem.items is None else dict(problem.items.stock)


def _endless(problem: Problem, node: ObjectNode) -> bool:
    return problem.at_hand(node) and node not in _stock(problem)


def trace_and_write(
    problem: Problem,
    plan: str | PathLike[str] | Iterable[FunctionalUnit],
    objectives: Objectives = "units",
    *,
    failed: int | None = None,
    after: int | None = None,
    kitchen_file: File | None = None,
    stock_file: File | None = None,
    time_limit: float | None = None,
    memory_limit: int | str | None = None,
) -> Traced:
    """Trace as ``foon-asp trace`` does, and write the kitchen and the stock of a step."""
    if after is not None and failed is not None and after != failed - 1:
        raise UserError(f"if step {failed} failed, {failed - 1} steps were done: leave --after out")
    traced = trace(problem, plan, objectives, failed=failed, time_limit=time_limit, memory_limit=memory_limit)
    done = len(traced.replay.steps) if after is None else after
    done = done if failed is None else failed - 1
    if kitchen_file is not None:
        write_whole(Path(kitchen_file), utf_8(traced.kitchen_text(done)))
    if stock_file is not None:
        write_whole(Path(stock_file), utf_8(traced.stock_text(done)))
    return traced


@question(
    Option(
        "plan",
        "The plan: FOON text, or an answer in JSON.",
        Kind.FILE,
        metavar="PLAN.txt",
        positional=True,
    ),
    GOALS,
    Option("failed", "The step that failed, of which nothing was done.", Kind.WHOLE, metavar="N", least=1),
    Option(
        "after", "The number of steps after which to write the kitchen.", Kind.WHOLE, metavar="N", least=0
    ),
    Option(
        "kitchen_file",
        "Write what is there as a kitchen, in FOON text.",
        Kind.FILE,
        flags=("-o", "--output"),
        metavar="FILE",
    ),
    Option("stock_file", "Write its copies as a stock.", Kind.FILE, flags=("--stock-out",), metavar="FILE"),
    OBJECTIVES,
    CONTAINERS,
    *ITEMS,
    *LIMITS,
    formats=TABLES,
    command=trace_and_write,
    help_="""
    \b
    foon-asp trace plan.txt --goal 'greek salad' --items used-up
    foon-asp trace plan.txt --goal macaroni --items used-up --after 3 -o state.txt --stock-out stock.txt
    foon-asp trace plan.txt --goal macaroni --items used-up --failed 4

    What goes and what comes at each step, and what is there in the end. With --failed, the best plan from
    what is there before that step, by --objective, and how it differs from what was left of the old one.

    Exits with 0 when the plan runs, with 1 when it does not; with --failed as `solve` does.
    """,
)
def trace(
    problem: Problem,
    plan: str | PathLike[str] | Iterable[FunctionalUnit],
    objectives: Objectives = "units",
    *,
    failed: int | None = None,
    time_limit: float | None = None,
    memory_limit: int | str | None = None,
    on_progress: OnProgress | None = None,
    cancel: Cancel | None = None,
) -> Traced:
    """Say what is in the kitchen after each step of a plan, and plan anew if a step fails.

    Parameters:
        plan: The path of a file (FOON text, or an answer in JSON), or functional units in the order of
            execution.

    Returns:
        The replay with what came and went, the kitchen and the stock after each step, and if a step
        ``failed`` the new ``answer``.

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
    tree = Tree.read(problem, plan) if isinstance(plan, str | PathLike) else Tree.given(problem, plan)
    replayed = replayable(tree.problem, tree)
    tree = replace(tree, problem=replayed)
    replay = replay_for(replayed, tree)
    if failed is None:
        return Traced(tree, replay)
    if not 1 <= failed <= len(replay.steps):
        raise UserError(
            f"found the step {failed}, expected one up to which the plan runs: 1 to {len(replay.steps)}"
        )
    how = settings(time_limit=time_limit, memory_limit=memory_limit)
    here = _from_here(problem, Traced(tree, replay).copies(failed - 1))
    return Traced(tree, replay, failed, answered(here, chosen, how))


def _from_here(problem: Problem, copies: dict[ObjectNode, int]) -> Problem:
    """Give a problem whose kitchen is what is there."""
    whole = problem.whole
    network = whole.network
    there = {o for node in copies if (o := network.object_id(node)) is not None}
    if whole.items is None:
        return replace(whole, kitchen=whole.kitchen | there, origin=None)
    items = UsedUp(whole.items.told, copies)
    return replace(whole, kitchen=whole.endless | there, items=items, origin=None)
