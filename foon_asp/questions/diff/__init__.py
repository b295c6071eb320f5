"""Comparison of two task trees or two networks."""

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from os import PathLike
from pathlib import Path
from types import MappingProxyType
from typing import NamedTuple, Unpack

from foon_asp.dataset import Dataset
from foon_asp.dataset.paths import File
from foon_asp.errors import UserError
from foon_asp.foon import Foon, load
from foon_asp.network import LEVELS, Amounts, Network, NetworkBuilder, ObjectNode
from foon_asp.problem import DEFAULT_RULE, Problem
from foon_asp.questions.answer import Answer
from foon_asp.questions.diff.networks import NetworkDifference as NetworkDifference
from foon_asp.questions.diff.networks import compare_networks
from foon_asp.questions.diff.trees import TreeDifference as TreeDifference
from foon_asp.questions.diff.trees import compare_trees
from foon_asp.questions.options import CONTAINERS, GOALS
from foon_asp.questions.posing import Command
from foon_asp.questions.posing_plan import data_for_trees, listed_tree, own_networks
from foon_asp.questions.python_options import Posed, start_deadline
from foon_asp.questions.question import TABLES, Kind, Option, Role, question
from foon_asp.questions.result import ENDINGS, NoTreeError
from foon_asp.questions.tree import Tree, read_answer
from foon_asp.text.answer_file import ListedTree
from foon_asp.text.plain_file import is_store


class Named(NamedTuple):
    """A task tree or a network that is compared, with its name, and for a network with amounts.

    ``name``: the file that the tree or network was read from, or ``a`` or ``b``.
    """

    name: str
    compared: Tree | Network
    amounts: Amounts = MappingProxyType({})


_Comparable = Answer | Tree | Foon | File | Named


def _pose_files(
    command: Command, a: Path, b: Path, goals_named: Sequence[str], containers: str
) -> tuple[Named, Named, int]:
    """Read two files as trees or networks; return them and the level, as the arguments of :func:`diff`.

    The data that the command names are read only if the files are task trees.
    """
    chosen = containers if command.given("containers") else None
    with command.reading():
        return (*_read_pair((a, b), goals_named, chosen, partial(data_for_trees, command)), command.level)


def _read_pair(
    files: tuple[Path, Path],
    goals: Sequence[str | ObjectNode],
    containers: str | None,
    read_data: Callable[[Mapping[Path, ListedTree]], Dataset],
) -> tuple[Named, Named]:
    """Read two files as trees of ``goals``, or as networks.

    The files are trees if there are ``goals``, or if one of the files says that it is a tree. ``read_data``
    then reads the data that the trees are about. Without ``goals``, the trees are for the goals that the
    files name. If ``containers`` is ``None``, a tree has the container rule that its file names, or else the
    default rule.
    """
    content_of: dict[Path, ListedTree | Tree | Foon] = {
        file: _read_units_or_data(file) for file in dict.fromkeys(files)
    }
    trees = {file: content for file, content in content_of.items() if isinstance(content, ListedTree)}
    if goals or any(tree.is_tree for tree in trees.values()):
        dataset = read_data(trees)
        goals = goals or [goal for tree in trees.values() for goal in tree.goals]
        for file, tree in trees.items():
            content_of[file] = listed_tree(
                dataset, file, tree, goals, containers or tree.containers or DEFAULT_RULE.value
            )
    a, b = (_named_network(str(file), content_of[file]) for file in files)
    return a, b


def _data_for_trees(level: int, files: Mapping[Path, ListedTree]) -> Dataset:
    """Return the data that trees in files are about, for a call from Python, which names no data.

    The data are read from the files that :func:`own_networks` returns. Without such files, they are the
    bundled kitchen.
    """
    kitchen = load(level=level)
    network_files = own_networks(kitchen.network, files)
    return load(network_files, level=level).dataset if network_files else kitchen.dataset


def _read_units_or_data(file: Path) -> ListedTree | Foon:
    """Read a file as units in their order, and a folder or a store as data."""
    return load(file) if file.is_dir() or is_store(file) else read_answer(file)


def _named_network(name: str, compared: ListedTree | Tree | Foon) -> Named:
    """Return data or listed units as a network at level 3, with its name; return a tree as it is."""
    if isinstance(compared, Tree):
        return Named(name, compared)
    if isinstance(compared, Foon):
        network = compared.network
        return Named(name, network.detailed or network, compared.dataset.source.amounts.units)
    builder = NetworkBuilder()
    for unit, source in compared.units or ():
        builder.add(unit.motion, unit.inputs, unit.outputs, source)
    return Named(name, builder.build(), compared.amounts)


def _with_name(name: str, compared: _Comparable, problem: Problem | None) -> Named:
    """Return an argument of :func:`diff` as a tree or a network, with its name.

    A file gets its path as name. It is read as a tree for ``problem``, or as a network if ``problem`` is
    ``None``. Raises :class:`NoTreeError` for an answer without a tree.
    """
    if isinstance(compared, str | PathLike):
        name, file = str(compared), Path(compared)
        return (
            Named(name, Tree.read(problem, file))
            if problem
            else _named_network(name, _read_units_or_data(file))
        )
    if isinstance(compared, Foon):
        return _named_network(name, compared)
    if isinstance(compared, Answer):
        if compared.tree is None:
            raise NoTreeError(f"{name}: the answer has no tree")
        return Named(name, compared.tree)
    return compared if isinstance(compared, Named) else Named(name, compared)


@question(
    Option(
        "a",
        "A task tree or a network: a file; networks may be folders or stores.",
        Kind.FILE,
        Role.PROBLEM,
        metavar="A",
        positional=True,
    ),
    Option("b", "The other one.", Kind.FILE, Role.PROBLEM, metavar="B", positional=True),
    GOALS,
    CONTAINERS,
    formats=("text", "json", "html", *TABLES[2:]),
    suffixes=ENDINGS,
    pose=_pose_files,
    help_="""
    \b
    foon-asp diff mine.txt answer.json --goal macaroni      two trees
    foon-asp diff v1/FOON.txt v2/FOON.txt --level 2         two networks
    foon-asp diff mine.txt yours.txt -o page.html           side by side

    A and B are compared as task trees where one is an answer in JSON, or FOON text that says it is a task
    tree, as solve writes it, or where --goal is given; else as networks. The first line says so.

    The kitchen, the rates and the goal of trees are those that the options name; an answer knows its goals.
    Trees part at an object node that both need on the way to the goals but get in different ways.

    Units are the same when motion, inputs and outputs are, ids, times and order aside; level 2 ignores
    contents, level 1 all but labels. Units nearly agree when they differ in three things at most (a motion, a
    label, a state, a relation, an ingredient, a whole object) and agree in more than half of what they say;
    each is paired with one other at most. Jaccard is what both have, of all that there is; F1 is twice what
    both have, by the sum of both.

    Exits with 0 when both were compared, whether they differ or not, and with 1 when an answer has no tree.
    """,
)
def diff(
    a: _Comparable,
    b: _Comparable,
    level: int = 3,
    **limits: Unpack[Posed],
) -> TreeDifference | NetworkDifference:
    """Compare two task trees or two networks: the units of both, of only one, and those that nearly agree.

    Trees are also compared by what they cost, and by where they part. A file is read as a tree if the other
    argument is an answer or a tree. Two files are read as trees if one of them says that it is a tree, or
    if a ``goal`` is given.

    Parameters:
        a: An answer, a tree, data that were loaded, or a path.
        b: The value to compare with, of the same types.
        level: The level of detail at which units of files and networks are compared, 1 to 3.
        goal: A goal, or several, of trees in files; by default, the goal of an answer, or what the last step
            makes.
        containers: The container rule of trees in files.

    Returns:
        The units. For trees also the costs, and where the trees part; for networks how much they agree.

    Raises:
        UserError: for a path without a tree or network, an answer without a tree, a tree and a network, and
            another level.

    Example:
        >>> problem = foon_asp.load().problem("macaroni")
        >>> found = foon_asp.diff(foon_asp.search(problem, "bfs").tree, foon_asp.solve(problem))
        >>> [unit.motion for unit in found.only_in_a]
        ['drain', 'pour']
        >>> found = foon_asp.diff("data/kitchen/FOON.txt", foon_asp.load())
        >>> len(found.in_both), found.nearly_the_same
        (220, ())
    """
    if level not in LEVELS:
        raise UserError(f"found level={level}, expected 1, 2 or 3")
    with start_deadline(limits).watched("comparing"):
        if isinstance(a, str | PathLike) and isinstance(b, str | PathLike):
            goal = limits.get("goal", ())
            goals = [goal] if isinstance(goal, str | ObjectNode) else [*goal]
            read_data = partial(_data_for_trees, level)
            a, b = _read_pair((Path(a), Path(b)), goals, limits.get("containers"), read_data)
        problem = next((value.problem for value in (a, b) if isinstance(value, Answer | Tree)), None)
        named_a, named_b = _with_name("a", a, problem), _with_name("b", b, problem)
        names = named_a.name, named_b.name
        if isinstance(named_a.compared, Tree) and isinstance(named_b.compared, Tree):
            return compare_trees(names, (named_a.compared, named_b.compared))
        if isinstance(named_a.compared, Network) and isinstance(named_b.compared, Network):
            networks, amounts = (named_a.compared, named_b.compared), (named_a.amounts, named_b.amounts)
            return compare_networks(names, networks, amounts, level)
        raise UserError(f"{' and '.join(names)}: found a task tree and a network, expected two of a kind")
