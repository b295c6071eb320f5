"""When to do each step of a plan, and who does it: the shortest schedule."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from os import PathLike
from pathlib import Path

from foon_asp.asp import Status
from foon_asp.dataset.items import items_of
from foon_asp.dataset.paths import File
from foon_asp.deadline import Cancel
from foon_asp.document.json_document import document, fraction_json, listed_unit_json
from foon_asp.errors import BugError, UserError
from foon_asp.network import FunctionalUnit, ObjectNode, counted
from foon_asp.planning.schedule_task import schedule_task
from foon_asp.planning.scheduling import Found, shortest, timed_steps
from foon_asp.problem import Number, Problem, exact
from foon_asp.problem.progress import OnProgress
from foon_asp.proof.replay import replay_for, waits
from foon_asp.proof.simulation import Verdict, simulate_for
from foon_asp.proof.timetable import Means, TimedStep, ToolName, timetable_fault
from foon_asp.questions.answer import of_status
from foon_asp.questions.arguments import at_least, begin
from foon_asp.questions.caller import caller
from foon_asp.questions.contract import TABLES, Kind, Option, Part, question
from foon_asp.questions.options import CONTAINERS, GOALS, ITEMS, LIMITS
from foon_asp.questions.posing import Command
from foon_asp.questions.result import Ending, NothingToDrawError, NoTreeError, Result
from foon_asp.questions.tree import Tree, read_answer
from foon_asp.report.answer import goal_lines
from foon_asp.report.gantt import Gantt, GanttRow, ShownGantt, gantt_lines, time_text
from foon_asp.report.renderable import Renderable
from foon_asp.report.replay import shortage_text
from foon_asp.report.robot_steps import replayable
from foon_asp.text.clip_times import median_clips
from foon_asp.text.duration_list import Duration, read_durations
from foon_asp.text.item_list import stated_name
from foon_asp.text.json_value import Json
from foon_asp.text.line import LineError
from foon_asp.text.tool_list import read_tools

Durations = str | PathLike[str] | Mapping[str, Number | Duration]
Tools = str | PathLike[str] | Mapping[ToolName, int | None]


@dataclass(frozen=True, repr=False)
class Schedule(Result):
    """When the steps of a ``plan`` are done, and by whom.

    ``status`` says what is proved: that the schedule is a shortest one (``optimal``), or that there is none
    (``infeasible``). ``timetable`` has the steps of the plan, in its order, and is empty without a schedule.
    ``makespan`` and ``lower_bound`` are in seconds: how long it takes, ``None`` without a schedule, and what
    none takes less than. ``lacking`` says how many there would have to be of some tools, so that there is
    one: at least, where it is proved that there is none, and else how many are enough. ``means`` is what
    there is to work with, and ``after`` has for each step those that it waits for, by position. ``stopped``
    is the limit that came first, in words, if one did.

    Example:
        >>> problem = foon_asp.load().problem("ice")
        >>> tree = foon_asp.solve(problem).tree
        >>> found = foon_asp.schedule(problem, tree, durations={"twist": 10, "crush": 30})
        >>> found.makespan, [step.start for step in found.timetable]
        (Fraction(40, 1), [Fraction(0, 1), Fraction(10, 1)])
    """

    plan: Tree
    means: Means
    status: Status
    timetable: tuple[TimedStep, ...]
    lower_bound: Fraction
    lacking: Mapping[ToolName, int]
    after: tuple[frozenset[int], ...]
    stopped: str | None = None

    @property
    def makespan(self) -> Fraction | None:
        """How long it takes, in seconds; ``None`` without a schedule."""
        if self.status not in {Status.OPTIMAL, Status.FEASIBLE}:
            return None
        return max((step.end for step in self.timetable), default=Fraction(0))

    @property
    def ending(self) -> Ending:
        """Done when the schedule is proved to be a shortest one."""
        return of_status(self.status)

    def text(self) -> str:
        """Give how long it takes, what is proved, and a chart in letters, for 79 columns."""
        return "\n".join([*self._head(), *gantt_lines(self._gantt()), *self._foot()]) + "\n"

    def renderable(self) -> Renderable | None:
        """Give the same, as wide as a console; ``None`` without a chart."""
        if not self.timetable:
            return None
        return ShownGantt(self._head(), self._gantt(), [*self._foot()])

    def json_dict(self) -> Json:
        """Give the steps with their times in seconds; steps count from 1."""
        problem, means = self.plan.problem, self.means
        steps = []
        for number, step in enumerate(self.timetable, 1):
            unit = listed_unit_json(
                problem.network, self.plan.units[number - 1], self.plan.places[number - 1]
            )
            steps.append(
                {
                    "step": number,
                    **{key: unit[key] for key in ("id", "motion", "source")},
                    "start": fraction_json(step.start),
                    "end": fraction_json(step.end),
                    "agent": step.agent,
                    "tools": [{"tool": str(tool.name), "number": tool.number} for tool in step.tools],
                    "after": [earlier + 1 for earlier in sorted(self.after[number - 1])],
                }
            )
        durations = [
            {"motion": motion, "seconds": fraction_json(Fraction(each.seconds)), "passive": each.passive}
            for motion, each in means.durations.items()
        ]
        return document(
            "schedule",
            problem,
            status=str(self.status),
            makespan=fraction_json(self.makespan),
            lower_bound=fraction_json(self.lower_bound),
            agents=means.agents,
            durations=durations,
            steps=steps,
            lacking=[
                {"tool": str(name), "there": means.number_of(problem, name), "needed": needed}
                for name, needed in self.lacking.items()
            ],
        )

    def write_chart(self, file: File) -> None:
        """Draw a Gantt chart into a file.

        Parameters:
            file: The path of the file, which ends in ``.svg`` or ``.png``.

        Raises:
            NothingToDrawError: if there is no step.
            UserError: for another file name, or if the packages of ``foon-asp[pictures]`` are missing.
        """
        from foon_asp.report.gantt_chart import write_gantt  # noqa: PLC0415 (seldom asked for)

        if not self.timetable:
            raise NothingToDrawError("there is no step in a schedule")
        write_gantt(self._gantt(), Path(file))

    def _gantt(self) -> Gantt:
        units = self.plan.units[: len(self.timetable)]
        rows = [
            GanttRow(number, unit.motion, _thing(unit), step.start, step.end, step.agent)
            for number, (unit, step) in enumerate(zip(units, self.timetable, strict=True), 1)
        ]
        goals = " + ".join(str(goal) for goal in self.plan.problem.goal_nodes)
        return Gantt(goals, tuple(rows), self.makespan or Fraction(0))

    def _head(self) -> list[str]:
        agents = counted(self.means.agents, "agent")
        lines = [*goal_lines(self.plan.problem)]
        if self.makespan is not None:
            alone = sum((step.end - step.start for step in self.timetable), Fraction(0))
            proved = ", proved" if self.status is Status.OPTIMAL else ""
            found = "shortest" if proved else "best found"
            lines.append(f"{found} for {agents}: {time_text(self.makespan)}{proved}")
            lines.append(f"{counted(len(self.timetable), 'step')}, one after the other {time_text(alone)}")
        elif self.status is Status.INFEASIBLE:
            lines.append(
                f"no schedule for {agents}, proved: more tools have to be in use at once than there are"
            )
            lines.append("if the kitchen has as many of them, say so in a file for --tools:")
            lines += [f"  {name}\t{needed}" for name, needed in self.lacking.items()]
        else:
            lines.append(
                f"no schedule found for {agents}; with so many tools there is one (a file for --tools):"
            )
            lines += [f"  {name}\t{needed}" for name, needed in self.lacking.items()]
        if self.status in {Status.FEASIBLE, Status.UNKNOWN}:
            lines.append(f"none takes less than {time_text(self.lower_bound)}; stopped by {self.stopped}")
        return [*lines, ""] if self.timetable else lines

    def _foot(self) -> Iterator[str]:
        """Say what there is to do for each agent."""
        if not self.timetable or self.makespan is None:
            return
        work = dict.fromkeys(range(1, self.means.agents + 1), Fraction(0))
        for step in self.timetable:
            if step.agent is not None:
                work[step.agent] += step.end - step.start
        yield ""
        for agent, seconds in work.items():
            yield f"agent {agent} works {time_text(seconds)} of {time_text(self.makespan)}"


def _thing(unit: FunctionalUnit) -> str:
    """Name what a unit is about: the first that it makes."""
    made = [node for node in unit.outputs if node not in unit.inputs] or list(unit.outputs)
    return made[0].label if made else ""


def _posed(
    command: Command,
    plan: Path,
    goals_named: tuple[str, ...],
    containers: str,
    items: str,
    stock: File | None,
    stays: File | None,
) -> tuple[Problem, Tree]:
    """Pose what a plan is for, as an answer says it where the command does not, and read the plan."""
    answer = read_answer(plan)
    listed = answer.units or ()
    if not command.given("containers"):
        containers = answer.containers or containers
    if not command.given("items"):
        items = answer.items or items
    dataset = command.dataset
    with command.reading():
        if goals_named:
            goals = dataset.goals(goals_named)
        elif answer.goals:
            goals = dataset.named_goals(answer.goals)
        elif listed:
            goals = dataset.named_goals(_last_made(listed[-1][0]))
        else:
            raise UserError(f"{plan}: there is no step; name a goal with --goal")
        how = items_of(dataset, items, stock, stays)
        problem = dataset.problem(goals, containers, items=how)
    return problem, Tree.given(problem, [unit for unit, _ in listed], [place for _, place in listed])


def _last_made(unit: FunctionalUnit) -> list[ObjectNode]:
    made = [node for node in unit.outputs if node not in unit.inputs]
    return made[:1] or list(unit.outputs)


@question(
    Option(
        "plan",
        "The plan or task tree: FOON text, or an answer in JSON.",
        Kind.FILE,
        Part.PROBLEM,
        metavar="PLAN",
        positional=True,
    ),
    Option(
        "durations",
        "How long each motion takes: lines of a motion, a tab, a number of seconds (or 25 min, 1.5 h), and "
        "behind another tab the word passive if nobody has to stand by.",
        Kind.FILE,
        metavar="FILE",
        python="Or seconds by motion, or a :class:`Duration`.",
    ),
    Option("agents", "How many agents work, each at one step at a time.", Kind.WHOLE, default=1, least=1),
    Option(
        "tools",
        "How many there are of tools and vessels: lines of a label, a tab, and a number or the word free. Of "
        "other utensils there is one each.",
        Kind.FILE,
        metavar="FILE",
        python="Or numbers by label or object node, ``None`` for what is free.",
    ),
    Option(
        "from_video",
        "Take the medians of the clips of the annotations for motions without a duration.",
        Kind.FLAG,
        default=False,
    ),
    GOALS._replace(help="A goal of the plan; without it, those of the answer, or what the last step makes."),
    CONTAINERS,
    *ITEMS,
    Option(
        "charts",
        "A file for a Gantt chart (.svg or .png).",
        Kind.FILE,
        Part.CHART,
        flags=("--chart",),
        many=True,
    ),
    *LIMITS,
    pose=_posed,
    formats=TABLES,
    help_="""
    \b
    foon-asp solve --goal 'greek salad' --items used-up --format json > plan.json
    foon-asp schedule plan.json --durations durations.txt --agents 2
    foon-asp schedule plan.json --durations durations.txt --agents 2 --tools tools.txt --chart plan.svg

    \b
    durations.txt              tools.txt
      chop    40                 knife   2
      pour    10                 oven    1
      bake    30 min  passive    stove   free
    (tabs between the columns)

    An agent does one step at a time; a passive one goes on by itself, and needs none. A step waits for those
    that make what it takes, and for those that look at what it uses up.

    A step needs the utensils among its objects, those that its objects are in, on or at, and what the file of
    tools names. Each is at one step at a time. It is in use from the first step that takes it from the
    kitchen to the last one that needs it as it was left: a bowl, as long as there is something in it that
    the plan needs. Vessels that the kitchen has with something in them are counted each by themselves.

    Durations are yours: a motion without one is an error that names it. Those of --from-video are times of
    clips, and not of what happens in them. OR-Tools looks for the schedule: pip install 'foon-asp[schedule]'.

    Exits with 0 when the schedule is proved to be a shortest one, with 1 when there is none or the plan does
    not run, with 3 when a limit or ctrl-C came first; the best schedule and its bound are printed then.
    """,
)
def schedule(
    problem: Problem,
    plan: str | PathLike[str] | Iterable[FunctionalUnit],
    *,
    durations: Durations | None = None,
    agents: int = 1,
    tools: Tools | None = None,
    from_video: bool = False,
    time_limit: float | None = None,
    memory_limit: int | str | None = None,
    on_progress: OnProgress | None = None,
    cancel: Cancel | None = None,
) -> Schedule:
    """Find the shortest schedule of a plan: when each step starts, who does it, and with which tools.

    Which step takes which copy is as :func:`trace` shows it.

    Parameters:
        plan: The path of a file (FOON text, or an answer in JSON), or functional units in the order of
            execution. A tree in which items last may be in any order.

    Returns:
        The ``timetable`` of the steps, the ``makespan``, and what is proved as ``status``.

    Raises:
        UserError: if the plan does not run, for motions without a duration, for a wrong argument or file, or
            if OR-Tools is not installed.

    Example:
        >>> problem = foon_asp.load().problem("ice")
        >>> tree = foon_asp.solve(problem).tree
        >>> found = foon_asp.schedule(problem, tree, durations={"twist": 10, "crush": 30})
        >>> str(found.status), str(found.makespan)
        ('optimal', '40')
    """
    deadline = begin(time_limit, memory_limit)
    at_least(agents, 1, "agents")
    tree = Tree.read(problem, plan) if isinstance(plan, str | PathLike) else _tree(problem, plan)
    if tree.problem.items is None:
        tree = _in_order(tree)
    replayed = replayable(tree.problem, tree)
    replay = replay_for(replayed, tree)
    if replay.shortage is not None:
        listed = list(zip(tree.units, tree.places, strict=True))
        raise NoTreeError(f"the plan does not run: {shortage_text(listed, replay.shortage)}")
    means = Means(_durations(tree, durations, from_video), agents, _tools(tools))
    task = schedule_task(replayed, tree.units, replay, means)
    found = shortest(task, deadline)
    steps = () if found.starts is None else tuple(timed_steps(task, found.starts))
    if found.starts is not None and (fault := timetable_fault(replayed, tree.units, steps, means)):
        raise BugError(f"the schedule does not hold: {fault}")
    return Schedule(
        tree,
        means,
        _status(found),
        steps,
        found.bound * task.tick,
        found.lacking,
        tuple(map(frozenset, waits(replay))),
        deadline.stopped,
    )


def _status(found: Found) -> Status:
    if found.proved:
        return Status.INFEASIBLE if found.starts is None else Status.OPTIMAL
    return Status.UNKNOWN if found.starts is None else Status.FEASIBLE


def _tree(problem: Problem, plan: Iterable[FunctionalUnit]) -> Tree:
    return plan if isinstance(plan, Tree) and plan.problem is problem else Tree.given(problem, plan)


def _in_order(tree: Tree) -> Tree:
    """Give a tree in an order that executes, if it has one."""
    simulation = simulate_for(tree.problem, tree)
    if simulation.verdict is not Verdict.REORDERED:
        return tree
    order = simulation.order
    return replace(
        tree, units=tuple(tree.units[n] for n in order), places=tuple(tree.places[n] for n in order)
    )


def _durations(tree: Tree, given: Durations | None, from_video: bool) -> dict[str, Duration]:
    """Give the durations of the motions of a plan; raises :class:`UserError` with all that have none."""
    known: dict[str, Duration] = {}
    if from_video:
        problem = tree.problem.whole
        files = dict.fromkeys(Path(copy.file) for copies in problem.network.sources for copy in copies)
        clips = median_clips((file for file in files if file.is_file()), caller().lenient)
        known = {motion: Duration(seconds) for motion, seconds in clips.items()}
    if isinstance(given, str | PathLike):
        stated: Mapping[str, Duration] = read_durations(Path(given))
    else:
        stated = {motion: _duration(each, motion) for motion, each in (given or {}).items()}
    motions = dict.fromkeys(unit.motion for unit in tree.units)
    timed = [motion for motion in motions if motion in known and motion not in stated]
    if timed:
        shown = ", ".join(f"{motion} {time_text(Fraction(known[motion].seconds))}" for motion in timed)
        caller().reporter.warning(
            f"warning: these durations are medians of clips, and not of what happens in them: {shown}"
        )
    known |= stated
    missing = [motion for motion in motions if motion not in known]
    if missing:
        place = "in a file for --durations (durations=)" if given is None else "in the durations"
        lines = "".join(f"\n  {motion}\tSECONDS" for motion in missing)
        raise UserError(
            f"no duration is known of {counted(len(missing), 'motion')} of the plan: say how long they take, "
            f"{place}, a tab before the seconds{lines}"
        )
    return {motion: known[motion] for motion in motions}


def _duration(given: Number | Duration, motion: str) -> Duration:
    number, passive = given if isinstance(given, Duration) else (given, False)
    seconds = exact(number, f"the duration of {motion!r}")
    if seconds <= 0:
        raise UserError(f"found the duration {given} of {motion!r}, expected one above 0")
    return Duration(seconds, passive)


def _tools(given: Tools | None) -> dict[ToolName, int | None]:
    if given is None:
        return {}
    if isinstance(given, str | PathLike):
        return read_tools(Path(given))
    found: dict[ToolName, int | None] = {}
    for name, count in given.items():
        if count is not None and (isinstance(count, bool) or not isinstance(count, int) or count < 1):
            raise UserError(f"found the number {count!r} of {str(name)!r}, expected a whole number from 1")
        try:
            found[stated_name(name) if isinstance(name, str) else name] = count
        except LineError as error:
            raise UserError(f"tools: {error}") from None
    return found
