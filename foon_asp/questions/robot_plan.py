"""Plans for a robot's program: each step with its objects by role, and the steps that it waits for."""

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Self

from msgspec import UNSET, UnsetType, field

from foon_asp.json_layout import schema_name
from foon_asp.planning.behaviour_tree import Branch, behaviour_tree_text
from foon_asp.planning.robot_step import RobotStep, robot_steps
from foon_asp.problem import Objective, Problem
from foon_asp.results.document import AboutGoals
from foon_asp.results.values import UsedUpRun
from foon_asp.results.values_of import question_fields, used_up_of
from foon_asp.text.clip_times import ListedClips, listed_clips
from foon_asp.text.tables import Duration


class RobotPlan(AboutGoals, frozen=True, kw_only=True, tag=schema_name("steps")):
    """A plan for a robot's program.

    Attributes:
        used_up: Whether the steps, each done once, run where items are used up; null where items are used
            up anyway.
        tools_inferred: Whether no utensils are known, so that tools are inferred from what stays the same.
        robot_steps: The steps, in an order that executes.
        branches: With ``--retries``: the trees to follow, one after the other; else left out.
    """

    ROWS = "robot_steps"

    used_up: UsedUpRun | None
    tools_inferred: bool
    robot_steps: tuple[RobotStep, ...] = field(name="steps")
    branches: tuple[Branch, ...] | UnsetType = UNSET

    @classmethod
    def of(
        cls,
        problem: Problem,
        objectives: Iterable[Objective],
        plan: Collection[int],
        durations: Mapping[str, Duration],
        policy: Sequence[tuple[Collection[int], int]] | None = None,
    ) -> Self:
        """Return the robot plan of a tree or plan.

        Parameters:
            problem: The problem.
            objectives: The objectives that the plan is optimal by.
            plan: The units by id, in an order that executes.
            durations: How long motions take, as far as that is known.
            policy: With ``--retries``, the trees to follow: units by id, and how many failures end each.
        """
        clips = tuple(_clips(problem, (plan, *(units for units, _ in policy or ()))))

        def steps(units: Collection[int]) -> tuple[RobotStep, ...]:
            """Return the steps of units, which are listed by id in an order that executes."""
            return tuple(robot_steps(problem, units, durations, clips))

        return cls(
            **question_fields(problem, objectives),
            used_up=used_up_of(problem, problem.tree(plan)),
            tools_inferred=not problem.utensils,
            robot_steps=steps(plan),
            branches=UNSET
            if policy is None
            else tuple(Branch(failures, steps(units)) for units, failures in policy),
        )

    def behaviour_tree(self) -> str:
        """Return the plan as a behaviour tree: XML of BehaviorTree.CPP 4.

        Where items are used up, failed steps are tried again without end. Without ``branches``, they are also
        tried again without end if the first objective is ``attempts``; otherwise the tree fails with the
        first failure.
        """
        endless = self.objectives[:1] == (Objective.ATTEMPTS,)
        branches = self.branches or (Branch(-1 if endless else 1, self.robot_steps),)
        name = " + ".join(map(str, self.goals))
        return behaviour_tree_text(name, branches, is_used_up=self.items == "used-up")


def _clips(problem: Problem, plans: Iterable[Collection[int]]) -> Iterator[ListedClips]:
    """Yield the video clips that the source files of the plans' units annotate.

    Missing files and unclear lines are skipped.
    """
    sources = (source for plan in plans for unit in plan for source in problem.network.sources[unit])
    files = dict.fromkeys(Path(source.file) for source in sources)
    return listed_clips((file for file in files if file.is_file()), lenient=True)
