"""The shortest schedule of a plan: when each step is done, who does it, and with which tools."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from fractions import Fraction
from os import PathLike
from pathlib import Path
from typing import Annotated, Any, Unpack

from msgspec import UNSET, field

from foon_asp.asp import Status
from foon_asp.dataset.paths import File
from foon_asp.errors import BugError, UserError
from foon_asp.escapes import escaped
from foon_asp.json_layout import schema_name
from foon_asp.network import ALL_ONE, FunctionalUnit, counted
from foon_asp.pictures.gantt import Gantt, time_text
from foon_asp.planning.schedule_task import schedule_task
from foon_asp.planning.scheduling import BestSchedule, shortest_schedule, timed_steps
from foon_asp.problem import Number, Problem
from foon_asp.proof.replay import Shortage, predecessors, replay_for, replayable_problem
from foon_asp.proof.simulation import Verdict, simulate_for
from foon_asp.proof.timetable import ScheduleResources, ToolName, timetable_fault
from foon_asp.proof.timetable import TimedStep as Timed
from foon_asp.proof.used_up_run import used_up_run
from foon_asp.questions.caller import caller
from foon_asp.questions.durations import Durations, duration_of, stated_durations
from foon_asp.questions.ending import Ending, ending_of_status
from foon_asp.questions.options import AMOUNT, CHART, CONTAINERS, GOAL_OF_PLAN, PLAN_ITEMS
from foon_asp.questions.posing_plan import pose_plan
from foon_asp.questions.python_arguments import require_at_least, with_items
from foon_asp.questions.python_options import Posed, start_deadline
from foon_asp.questions.question import TABLES, Kind, Option, Role, question
from foon_asp.questions.result import NothingToDrawError, NoTreeError, Result
from foon_asp.questions.tree import OTHER_READING, Tree, as_tree
from foon_asp.results.document import AboutGoals
from foon_asp.results.table import Block, Table
from foon_asp.results.timed_step import TimedStep, Tool
from foon_asp.results.values import Value
from foon_asp.results.values_of import lack_of, question_fields
from foon_asp.text.clip_times import median_clips
from foon_asp.text.line import LineError
from foon_asp.text.tables import (
    TOOLS,
    Duration,
    duration_template,
    read_default_duration,
    stated_name,
)
from foon_asp.whole_file import utf_8, write_whole

Tools = str | PathLike[str] | Mapping[ToolName, int | None]
"""Numbers of tools: the path of a file, or the numbers by label or node; ``None`` for an unlimited number."""


class MotionTime(Value, frozen=True):
    """How long a motion takes, in seconds.

    Attributes:
        passive: Whether it goes on without an agent.
    """

    motion: str
    seconds: Fraction
    passive: bool


class LackingTool(Value, frozen=True):
    """A tool of which there are too few.

    Attributes:
        tool: A label, or a vessel with what is in it.
        there: How many there are.
        needed: If infeasible, the least number that a schedule needs; if unknown, a number that is enough.
    """

    tool: str
    there: int
    needed: int


class Schedule(Result, AboutGoals, frozen=True, kw_only=True, tag=schema_name("schedule")):
    """A schedule: when each step of a plan is done, by whom, and with which tools.

    Attributes:
        status: optimal: proved a shortest schedule; infeasible: proved that no schedule exists; feasible and
            unknown: stopped at a limit with or without a schedule.
        stopped: The limit that came first, and what was being done; null if none did.
        makespan: The makespan in seconds; null without a schedule.
        lower_bound: A proved lower bound on the makespan, in seconds.
        agents: The number of agents.
        durations: The duration of each motion of the plan.
        timetable: The steps, in the order of the plan; empty without a schedule.
        lacking: Without a schedule, the tools of which there are too few.

    Example:
        >>> problem = foon_asp.load().problem("ice")
        >>> tree = foon_asp.solve(problem).tree
        >>> found = foon_asp.schedule(problem, tree, durations={"twist": 10, "crush": 30})
        >>> found.makespan, [step.start for step in found.timetable]
        (Fraction(40, 1), [Fraction(0, 1), Fraction(10, 1)])
    """

    ROWS = "timetable"

    status: Status
    stopped: str | None
    makespan: Fraction | None
    lower_bound: Fraction
    agents: int
    durations: tuple[MotionTime, ...]
    timetable: tuple[TimedStep, ...] = field(name="steps")
    lacking: tuple[LackingTool, ...]

    @property
    def ending(self) -> Ending:
        """``DONE`` if the schedule is proved shortest, ``NEGATIVE`` if it is proved that none exists."""
        return ending_of_status(self.status)

    @property
    def gantt(self) -> Gantt:
        """The data of a Gantt chart: title, steps and makespan."""
        return Gantt(" + ".join(map(str, self.goals)), self.timetable, self.makespan or Fraction(0))

    def show(self) -> Iterator[Block]:
        """Return the makespan with what is proved of it, a table of the steps, and the time each agent works.

        Without a schedule, the tools that are lacking are listed, and how many are needed. If a limit came
        first, a line has the lower bound.
        """
        yield from self.goal_lines()
        agents = counted(self.agents, "agent")
        if self.makespan is not None:
            claim, proved = ("shortest", ", proved") if self.status is Status.OPTIMAL else ("best found", "")
            yield f"{claim} for {agents}: {time_text(self.makespan)}{proved}"
            sequential_time = sum((step.end - step.start for step in self.timetable), Fraction(0))
            yield f"{counted(len(self.timetable), 'step')}, one after the other {time_text(sequential_time)}"
        elif self.status is Status.INFEASIBLE:
            yield f"no schedule for {agents}, proved: more tools have to be in use at once than there are"
            yield "if the kitchen has as many of them, say so in a file for --tools:"
        else:
            yield f"no schedule found for {agents}; with so many tools there is one (a file for --tools):"
        yield from (f"  {lack.tool}\t{lack.needed}" for lack in self.lacking)
        if self.stopped is not None:
            yield f"none takes less than {time_text(self.lower_bound)}; stopped by {self.stopped}"
        if not self.timetable or self.makespan is None:
            return
        rows = [
            (str(step.step), time_text(step.start), time_text(step.end), str(step.agent or "-"), step.name)
            for step in self.gantt.sorted_rows
        ]
        yield from ("", Table(("step", "start", "end", "agent", ""), rows, left_aligned=frozenset({4})), "")
        for agent in range(1, self.agents + 1):
            times = (step.end - step.start for step in self.timetable if step.agent == agent)
            yield f"agent {agent} works {time_text(sum(times, Fraction(0)))} of {time_text(self.makespan)}"

    def write_chart(self, file: File) -> None:
        """Draw a Gantt chart into a file.

        Parameters:
            file: The path of the file, which ends in ``.svg`` or ``.png``.

        Raises:
            NothingToDrawError: if there is no step.
            UserError: for another file name, or if the packages of ``foon-asp[pictures]`` are missing.
        """
        from foon_asp.pictures.gantt_chart import write_gantt  # noqa: PLC0415 (seldom asked for)

        if not self.timetable:
            raise NothingToDrawError("there is no step in a schedule")
        write_gantt(self.gantt, Path(file))


class WrittenDurations(Result, frozen=True, kw_only=True, tag=schema_name("durations")):
    """A file of durations, written for the user to fill in.

    Attributes:
        unknown: How many durations are to be filled in.
    """

    file: Path
    unknown: int

    def show(self) -> Iterator[Block]:
        """Return one line: the file, and how many durations to fill in."""
        todo = f"say {counted(self.unknown, 'duration')} in place of SECONDS" if self.unknown else "change it"
        yield f"wrote {self.file}: {todo}, and give it as --durations"


def _schedule_or_template(
    problem: Problem, plan: Tree, *, durations_template: Path | None = None, **options: Any
) -> Result:
    """Return the schedule; with ``durations_template``, only write this file of durations to be filled in.

    Known durations are filled in already. Raises :class:`UserError` if the file exists.
    """
    if durations_template is None:
        return schedule(problem, plan, **options)
    if durations_template.exists():
        raise UserError(f"{durations_template} is there already: name a new file, or remove it")
    known_durations = _known_durations(
        plan, options["durations"], options["from_video"], options["default_duration"]
    )
    template = {unit.motion: known_durations.get(unit.motion) for unit in plan.units}
    write_whole(durations_template, utf_8(duration_template(template)))
    unknown = sum(duration is None for duration in template.values())
    return WrittenDurations(file=durations_template, unknown=unknown)


@question(
    Option(
        "plan",
        "The plan or task tree: FOON text, or an answer in JSON.",
        Kind.FILE,
        Role.PROBLEM,
        metavar="PLAN",
        positional=True,
    ),
    Option(
        "durations_template",
        "Only write a file for --durations with the motions of the plan, to be filled in.",
        Kind.WRITTEN,
        metavar="FILE",
    ),
    GOAL_OF_PLAN,
    CONTAINERS,
    *PLAN_ITEMS,
    AMOUNT,
    CHART._replace(help="A file for a Gantt chart (.svg or .png)."),
    pose=pose_plan,
    command=_schedule_or_template,
    formats=TABLES,
    help_="""
    \b
    foon-asp solve --goal 'greek salad' --items used-up --format json > plan.json
    foon-asp schedule plan.json --durations-template durations.txt      then fill it in
    foon-asp schedule plan.json --durations durations.txt --agents 2
    foon-asp schedule plan.json --durations durations.txt --agents 2 --tools tools.txt --chart plan.svg

    \b
    durations.txt              tools.txt
      chop    40                 knife   2
      pour    10                 oven    1
      bake    30 min  passive    stove   free
    (tabs between the columns)

    Each item is used once, so the plan has to run so, in the order listed or in another; with --items
    lasting, what is there can be used again.

    An agent does one step at a time; a passive one goes on by itself, and needs none. A step waits for those
    that make what it takes, and for those that look at what it uses up.

    A step needs the utensils among its objects, those that its objects are in, on or at, and what the file of
    tools names. Each is at one step at a time. It is in use from the first step that takes it from the
    kitchen to the last one that needs it as it was left: a bowl, as long as there is something in it that
    the plan needs. Vessels that the kitchen has with something in them are counted each by themselves.

    Durations are yours: a motion without one is an error that names it, but for --default-duration. Those of
    --from-video are times of clips, and not of what happens in them. OR-Tools looks for the schedule: pip
    install 'foon-asp[schedule]'.

    Exits with 0 when the schedule is proved to be a shortest one, with 1 when there is none or the plan does
    not run, with 3 when a limit or ctrl-C came first; the best schedule and its bound are printed then.
    """,
)
def schedule(
    problem: Problem,
    plan: str | PathLike[str] | Iterable[FunctionalUnit],
    *,
    durations: Annotated[Durations | None, Option(kind=Kind.FILE, metavar="FILE")] = None,
    agents: Annotated[int, Option(least=1)] = 1,
    tools: Annotated[Tools | None, Option(kind=Kind.FILE, metavar="FILE")] = None,
    from_video: Annotated[bool, Option()] = False,
    default_duration: Annotated[
        Number | None,
        Option(
            "default_duration",
            "How long motions take that have no other duration: 60, 25 min or 1.5 h.",
            metavar="SECONDS",
        ),
    ] = None,
    items: str = "used-up",
    **options: Unpack[Posed],
) -> Schedule:
    """Find the shortest schedule of a plan: when each step starts, who does it, and with which tools.

    Each step takes the copies that :func:`trace` shows.

    Parameters:
        plan: The path of a file (FOON text, or an answer in JSON), or functional units in the order of
            execution; the plan is put in an order that runs, if this order does not.
        durations: How long each motion takes: lines of a motion, a tab, a number of seconds (or 25 min,
            1.5 h), and behind another tab the word passive if nobody has to stand by. Or seconds by motion,
            or a :class:`Duration`.
        agents: How many agents work, each at one step at a time.
        tools: How many there are of tools and vessels: lines of a label, a tab, and a number or the word
            free; of other utensils there is one each. Or numbers by label or object node, ``None`` for what
            is free.
        from_video: Take the medians of the clips of the annotations for motions without a duration.

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
    deadline = start_deadline(options)
    require_at_least(agents, 1, "agents")
    problem = with_items(problem, items)
    tree = _executable_tree(as_tree(problem, plan))
    replayed = replayable_problem(tree.problem, tree)
    replay = replay_for(replayed, tree)
    if replay.shortage is not None:
        raise NoTreeError(_shortage_text(tree, replay.shortage))
    known_durations = _durations_of_plan(tree, durations, from_video, default_duration)
    resources = ScheduleResources(known_durations, agents, _tool_counts(tools))
    task = schedule_task(replayed, tree.units, replay, resources)
    solution = shortest_schedule(task, deadline)
    timed = () if solution.starts is None else tuple(timed_steps(task, solution.starts))
    if solution.starts is not None and (fault := timetable_fault(replayed, tree.units, timed, resources)):
        raise BugError(f"the schedule does not hold: {fault}")
    earlier_numbers = [
        tuple(earlier + 1 for earlier in sorted(earlier_steps)) for earlier_steps in predecessors(replay)
    ]
    return Schedule(
        **question_fields(tree.problem),
        status=_status_of(solution),
        stopped=None if solution.proved else deadline.stopped,
        makespan=None if solution.starts is None else max((step.end for step in timed), default=Fraction(0)),
        lower_bound=solution.bound * task.tick,
        agents=agents,
        durations=tuple(
            MotionTime(motion, Fraction(duration.seconds), duration.passive)
            for motion, duration in resources.durations.items()
        ),
        timetable=tuple(_timed_step_values(tree, timed, earlier_numbers)),
        lacking=tuple(
            LackingTool(str(name), resources.number_of(tree.problem, name), needed)
            for name, needed in solution.lacking.items()
        ),
    )


def _timed_step_values(
    tree: Tree, timed: Sequence[Timed], after: Sequence[tuple[int, ...]]
) -> Iterator[TimedStep]:
    """Yield the steps of a schedule as values for a result.

    ``timed`` has the times, the agent and the tools of each step of the tree. ``after`` has the numbers, from
    1, of the steps that each step waits for.
    """
    problem = tree.problem
    for number, (unit, step, earlier) in enumerate(zip(tree.units, timed, after, strict=False), 1):
        named = tree.step_unit(number)
        made = [node for node in unit.outputs if node not in unit.inputs] or unit.outputs
        amounts = ALL_ONE if problem.items is None else problem.amounts.get(unit, ALL_ONE)
        yield TimedStep(
            number,
            named.id,
            named.motion,
            named.source,
            made[0].label if made else None,
            step.start,
            step.end,
            step.agent,
            tuple(Tool(str(tool.name), tool.number) for tool in step.tools),
            earlier,
            amounts.outputs.get(made[0], UNSET) if made else UNSET,
        )


def _status_of(solution: BestSchedule) -> Status:
    """Return the status of a solution.

    With a schedule, it is optimal or, without a proof, feasible. Without a schedule, it is infeasible or,
    without a proof, unknown.
    """
    if solution.proved:
        return Status.INFEASIBLE if solution.starts is None else Status.OPTIMAL
    return Status.UNKNOWN if solution.starts is None else Status.FEASIBLE


def _executable_tree(tree: Tree) -> Tree:
    """Return a tree in an order that executes.

    If no order executes where items last, the listed order is kept. If no order executes where items are used
    up, raises :class:`NoTreeError`.
    """
    if tree.problem.items is None:
        simulation = simulate_for(tree.problem, tree)
        order = simulation.order if simulation.verdict is Verdict.REORDERED else range(len(tree))
    else:
        run = used_up_run(tree.problem, tree)
        if run.order is None:
            assert run.shortage is not None
            raise NoTreeError(f"{_shortage_text(tree, run.shortage)}\n{OTHER_READING}")
        order = run.order
    return tree.in_order(order)


def _shortage_text(tree: Tree, shortage: Shortage) -> str:
    """Return the message that a plan does not run, with the missing copy and the step that needs it."""
    return f"the plan does not run: {tree.lack_text(lack_of(tree.problem.network, shortage))}"


def _durations_of_plan(
    tree: Tree, stated: Durations | None, from_video: bool, default: Number | None
) -> dict[str, Duration]:
    """Return the duration of each motion of a plan; raises :class:`UserError` for motions without one.

    The parameters are those of :func:`_known_durations`.
    """
    known_durations = _known_durations(tree, stated, from_video, default)
    motions = dict.fromkeys(unit.motion for unit in tree.units)
    missing = [motion for motion in motions if motion not in known_durations]
    if missing:
        where = "in a file for --durations (durations=)" if stated is None else "in the durations"
        advice = [
            *(
                []
                if from_video
                else ["--from-video takes them from clips of the annotations, as far as they are known there"]
            ),
            "--default-duration 60 counts each as 60 seconds",
            "--durations-template FILE writes these lines into a file",
        ]
        lines = "".join(f"\n  {escaped(motion)}\tSECONDS" for motion in missing)
        raise UserError(
            f"no duration is known of {counted(len(missing), 'motion')} of the plan: say how long they take, "
            f"{where}, a tab before the seconds{lines}\n" + "\n".join(advice)
        )
    return {motion: known_durations[motion] for motion in motions}


def _known_durations(
    tree: Tree, stated: Durations | None, from_video: bool, default: Number | None
) -> dict[str, Duration]:
    """Return the known durations by motion, for the motions of a plan and those that are ``stated``.

    A stated duration comes first. Then, with ``from_video``, comes the median of the video clips of the
    motion, and then the ``default``. Warnings name the motions that have a median or the default. With
    ``from_video``, the whole network is read; files of clips that do not exist are skipped.
    """
    durations = stated_durations(stated)
    motions = dict.fromkeys(unit.motion for unit in tree.units)
    if from_video:
        problem = tree.problem.whole
        files = dict.fromkeys(Path(copy.file) for copies in problem.network.sources for copy in copies)
        clips = median_clips((file for file in files if file.is_file()), caller().lenient)
        timed = [motion for motion in motions if motion in clips and motion not in durations]
        if timed:
            medians = ", ".join(f"{escaped(motion)} {time_text(Fraction(clips[motion]))}" for motion in timed)
            caller().reporter.warning(
                f"warning: these durations are medians of clips, and not of what happens in them: {medians}"
            )
        durations |= {motion: Duration(clips[motion]) for motion in timed}
    if default is not None:
        duration = (
            Duration(read_default_duration(default))
            if isinstance(default, str)
            else duration_of(default, "default")
        )
        untimed_motions = [motion for motion in motions if motion not in durations]
        if untimed_motions:
            default_text = time_text(Fraction(duration.seconds))
            motions_named = ", ".join(map(escaped, untimed_motions))
            caller().reporter.warning(f"warning: these motions count as {default_text} each: {motions_named}")
        durations |= dict.fromkeys(untimed_motions, duration)
    return durations


def _tool_counts(stated: Tools | None) -> dict[ToolName, int | None]:
    """Return the stated numbers of tools by label or node; ``None`` for an unlimited number.

    ``stated`` is the path of a file to read, or numbers to check. If it is ``None``, the result is empty.
    Raises :class:`UserError` for a wrong number or label.
    """
    if stated is None:
        return {}
    if isinstance(stated, str | PathLike):
        return TOOLS.read(Path(stated))
    tools: dict[ToolName, int | None] = {}
    for name, count in stated.items():
        if count is not None and (isinstance(count, bool) or not isinstance(count, int) or count < 1):
            raise UserError(f"found the number {count!r} of {str(name)!r}, expected a whole number from 1")
        try:
            tools[stated_name(name) if isinstance(name, str) else name] = count
        except LineError as error:
            raise UserError(f"tools: {error}") from None
    return tools
