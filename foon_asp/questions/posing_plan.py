"""Posing the problem of a file with a tree or plan: its goals, and its data if none are named."""

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
from foon_asp.questions.posing import Command, one_problem
from foon_asp.questions.tree import Tree, read_answer
from foon_asp.text.answer_file import ListedTree


def a_plan(
    command: Command,
    goals_named: Sequence[str],
    containers: str,
    items: str,
    stock: File | None,
    stays: File | None,
    amounts: Sequence[int] = (),
    **named: Path,
) -> tuple[Problem, Tree]:
    """Read a plan, and pose its problem; options of the command override the fields of an answer.

    ``named`` has one entry: the file of the plan, by the name of the question's parameter.
    """
    (plan,) = named.values()
    answer = read_answer(plan)
    settle_data(command, {plan: answer})
    if not command.given("containers"):
        containers = answer.containers or containers
    dataset = command.dataset
    with command.reading():

        def used_up(goals: Sequence[int]) -> UsedUp | None:
            wanted = [answer.wanted.get(dataset.names.node(goal), 1) for goal in goals]
            stated = amounts or (wanted if answer.wanted and items != "lasting" else ())
            return items_for(dataset, goals, stated, items, stock, stays)

        tree = listed_tree(dataset, plan, answer, goals_named, containers, used_up)
    return tree.problem, tree


def a_plan_or_state(
    command: Command, goals_named: Sequence[str], state: Path | None, plan: Path | None, **options: Any
) -> tuple[Problem, Tree | None]:
    """Read a plan, and pose its problem; with a ``state``, pose the goals named, and return no plan.

    The file of a plan beside a state serves as one more network.
    """
    if state is None:
        if plan is None:
            raise UserError("found no plan: name a file with one, or a state with --state")
        return a_plan(command, goals_named, plan=plan, **options)
    if command.given("items") and options["items"] != "lasting":
        raise UserError("trace --state is not built for items that are used up (--items used-up)")
    if plan is not None:
        command.add_sources((plan,))
    return *one_problem(command, goals_named, options["containers"]), None


def listed_tree(
    dataset: Dataset,
    file: Path,
    answer: ListedTree,
    goals_named: Sequence[str | ObjectNode],
    containers: str,
    used_up: Callable[[Sequence[int]], UsedUp | None] | None = None,
) -> Tree:
    """Return the tree that a file lists, for the named goals or the goals of an answer.

    Without any such goal, the tree is for the only goal of the data, or for what the last step makes.
    ``used_up`` returns for goals, by id, how items are used up; without it, items last.
    """
    ordered = not answer.numbers
    listed = answer.with_units(file, lambda: dataset.whole_network).units or ()
    if answer.goals and not goals_named:
        goals = dataset.python_goal_ids(answer.goals)
    elif goals_named:
        goals = dataset.command_goal_ids(goals_named)
    elif len(dataset.listed) == 1:
        goals = dataset.command_goal_ids(())
    elif listed and ordered:
        goals = dataset.python_goal_ids(_last_made(listed[-1][0]))
    else:
        why = "use(U) names no goal, and has no last step" if listed else "there is no step"
        raise UserError(f"{file}: {why}; name a goal with --goal")
    problem = dataset.problem(goals, containers, items=used_up and used_up(goals))
    if not goals_named and not answer.goals and (len(dataset.listed) != 1 or dataset.goals_from):
        shown = " + ".join(map(str, problem.goal_nodes))
        caller().reporter.warning(f"No --goal: using what the last step makes: {shown}")
    return Tree.given(problem, [unit for unit, _ in listed], [source for _, source in listed])


def settle_data(command: Command, files: Mapping[Path, ListedTree]) -> Dataset:
    """Return the data for trees in files: those that the command names.

    If it names none, they are the files of :func:`own_networks`; without any, the bundled kitchen.
    """
    if not command.names_data:
        command.add_sources(own_networks(command.dataset.data.network, files))
    return command.dataset


def own_networks(kitchen: Network, files: Mapping[Path, ListedTree]) -> Sequence[Path]:
    """Return the files with trees that also serve as the network, where no data are named.

    Returns no file if the bundled ``kitchen`` has at least half of the units; it is then the network. Fewer
    shared units may be chance, and a program may have made up some units of a tree. Raises :class:`UserError`
    for an answer about other data, since an answer holds only a part of its data.
    """
    listed = [listed_unit for tree in files.values() for listed_unit in tree.units or ()]
    bundled = units_in(kitchen, [unit for unit, _ in listed])
    names = ", ".join(map(str, files))
    if bundled == len(listed):
        return ()
    if 2 * bundled >= len(listed):
        caller().reporter.warning(
            f"{names}: no --network: using the bundled kitchen, which has {bundled} of "
            f"{counted(len(listed), 'unit')}"
        )
        return ()
    if texts := [file for file, tree in files.items() if not tree.goals]:
        caller().reporter.warning(f"No --network: using {' and '.join(map(str, texts))}")
        return texts
    places = ", ".join(dict.fromkeys(source.file for _, source in listed))
    raise UserError(f"{names}: not of the bundled kitchen; name the data with --network: {places}")


def units_in(network: Network, units: Collection[FunctionalUnit]) -> int:
    """Return the number of units that a network has."""
    return sum(network.unit_id(unit_at_level(unit, network.level)) is not None for unit in units)


def _last_made(unit: FunctionalUnit) -> list[ObjectNode]:
    made = [node for node in unit.outputs if node not in unit.inputs]
    return made[:1] or list(unit.outputs)
