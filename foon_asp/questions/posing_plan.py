"""Problems of trees and plans in files, with their goals and their data."""

from collections.abc import Callable, Collection, Mapping, Sequence
from pathlib import Path
from typing import Any

from foon_asp.dataset import Dataset
from foon_asp.dataset.item_options import items_for
from foon_asp.dataset.paths import File
from foon_asp.errors import UserError
from foon_asp.network import FunctionalUnit, Network, ObjectNode, counted, unit_at_level
from foon_asp.problem import Problem, UsedUp
from foon_asp.questions.caller import caller
from foon_asp.questions.posing import Command, pose_problem
from foon_asp.questions.tree import Tree, read_answer
from foon_asp.text.answer_file import ListedTree


def pose_plan(
    command: Command,
    goals_named: Sequence[str],
    containers: str,
    items: str,
    stock: File | None,
    stays: File | None,
    amounts: Sequence[int] = (),
    **named: Path,
) -> tuple[Problem, Tree]:
    """Read a plan from a file, and return its problem and the plan.

    ``named`` has one entry: the file, by the name of the question's parameter. An answer in the file may
    state goals, a container rule and amounts of goals. The command line overrides them. If items last, the
    amounts of the answer are ignored. The data are those of :func:`data_for_trees`, which may add the file to
    the networks of the command.
    """
    (plan,) = named.values()
    answer = read_answer(plan)
    data_for_trees(command, {plan: answer})
    if not command.given("containers"):
        containers = answer.containers or containers
    dataset = command.dataset
    with command.reading():

        def used_up(goals: Sequence[int]) -> UsedUp | None:
            """Return how items are used up for goals, which are given by id.

            The amounts are those on the command line, or else those of the answer.
            """
            wanted = [answer.wanted.get(dataset.names.node(goal), 1) for goal in goals]
            stated = amounts or (wanted if answer.wanted and items != "lasting" else ())
            return items_for(dataset, goals, stated, items, stock, stays)

        tree = listed_tree(dataset, plan, answer, goals_named, containers, used_up)
    return tree.problem, tree


def pose_plan_or_state(
    command: Command, goals_named: Sequence[str], state: Path | None, plan: Path | None, **options: Any
) -> tuple[Problem, Tree | None]:
    """Return the problem of the plan in a file, and the plan.

    With a ``state``, return the problem of the goals, in which items last, and ``None`` in place of a plan.
    The file of a plan then serves as one more network. The file of the state is not read here. Raises
    :class:`UserError` if there is neither a plan nor a state, and for a state with items that are used up.
    """
    if state is None:
        if plan is None:
            raise UserError("found no plan: name a file with one, or a state with --state")
        return pose_plan(command, goals_named, plan=plan, **options)
    if command.given("items") and options["items"] != "lasting":
        raise UserError("trace --state is not built for items that are used up (--items used-up)")
    if plan is not None:
        command.add_sources((plan,))
    return *pose_problem(command, goals_named, options["containers"]), None


def listed_tree(
    dataset: Dataset,
    file: Path,
    answer: ListedTree,
    goals_named: Sequence[str | ObjectNode],
    containers: str,
    used_up: Callable[[Sequence[int]], UsedUp | None] | None = None,
) -> Tree:
    """Return the tree that a file lists, with its goals.

    The goals are the first that exist in this order:

    - the named goals
    - the goals of the answer in the file
    - the only goal of the data
    - what the last step makes, which a warning names

    ``used_up`` takes the ids of goals and returns how items are used up for them; without it, items last.
    Raises :class:`UserError` where no goal can be found.
    """
    ordered = not answer.numbers
    listed = answer.with_units(file, lambda: dataset.whole_network).units or ()
    if answer.goals and not goals_named:
        goals = dataset.python_goal_ids(answer.goals)
    elif goals_named:
        goals = dataset.command_goal_ids(goals_named)
    elif len(dataset.goal_entries) == 1:
        goals = dataset.command_goal_ids(())
    elif listed and ordered:
        goals = dataset.python_goal_ids(_goals_of_last_unit(listed[-1][0]))
    else:
        fault = "use(U) names no goal, and has no last step" if listed else "there is no step"
        raise UserError(f"{file}: {fault}; name a goal with --goal")
    problem = dataset.problem(goals, containers, items=used_up and used_up(goals))
    if not goals_named and not answer.goals and (len(dataset.goal_entries) != 1 or dataset.goals_from):
        goals_text = " + ".join(map(str, problem.goal_nodes))
        caller().reporter.warning(f"No --goal: using what the last step makes: {goals_text}")
    return Tree.given(problem, [unit for unit, _ in listed], [source for _, source in listed])


def data_for_trees(command: Command, files: Mapping[Path, ListedTree]) -> Dataset:
    """Return the data that trees in ``files`` are about.

    If the command names data, they are returned. Otherwise, the files of :func:`own_networks` are added to
    the command as its data. Without such files, the data are the bundled kitchen.
    """
    if not command.names_data:
        command.add_sources(own_networks(command.dataset.data.network, files))
    return command.dataset


def own_networks(kitchen: Network, files: Mapping[Path, ListedTree]) -> Sequence[Path]:
    """Return the files with trees that also serve as the network, for a command that names no data.

    If the bundled ``kitchen`` has at least half of the units in all files, it is the network, and no file is
    returned. Other units were perhaps made up by the program that wrote the trees. Otherwise, the files that
    hold no answer are returned.

    A warning names the network, unless the bundled kitchen has all units. If all files are answers about
    other data, :class:`UserError` is raised, since an answer holds only a part of its data.
    """
    listed = [listed_unit for tree in files.values() for listed_unit in tree.units or ()]
    bundled_count = count_units_in(kitchen, [unit for unit, _ in listed])
    file_names = ", ".join(map(str, files))
    if bundled_count == len(listed):
        return ()
    if 2 * bundled_count >= len(listed):
        caller().reporter.warning(
            f"{file_names}: no --network: using the bundled kitchen, which has {bundled_count} of "
            f"{counted(len(listed), 'unit')}"
        )
        return ()
    if text_files := [file for file, tree in files.items() if not tree.goals]:
        caller().reporter.warning(f"No --network: using {' and '.join(map(str, text_files))}")
        return text_files
    source_files = ", ".join(dict.fromkeys(source.file for _, source in listed))
    raise UserError(f"{file_names}: not of the bundled kitchen; name the data with --network: {source_files}")


def count_units_in(network: Network, units: Collection[FunctionalUnit]) -> int:
    """Return how many of the units a network has; units are compared at the level of the network."""
    return sum(network.unit_id(unit_at_level(unit, network.level)) is not None for unit in units)


def _goals_of_last_unit(unit: FunctionalUnit) -> list[ObjectNode]:
    """Return the first output that is no input, in a list; if all outputs are inputs, return all outputs."""
    made = [node for node in unit.outputs if node not in unit.inputs]
    return made[:1] or list(unit.outputs)
