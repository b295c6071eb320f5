"""Checks of a given tree: whether it executes, keeps to rules, and is the best."""

from collections.abc import Iterable, Iterator
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Self, Unpack

from msgspec import UNSET, UnsetType, structs

from foon_asp.dataset.paths import File
from foon_asp.errors import UserError
from foon_asp.json_layout import schema_name
from foon_asp.network import FunctionalUnit, counted
from foon_asp.pictures.drawing import Drawing
from foon_asp.problem import Costs, Objective, Problem
from foon_asp.proof.replay import replay_for
from foon_asp.proof.simulation import Obstacle, Simulation, Verdict, simulate_for
from foon_asp.questions.ending import Ending
from foon_asp.questions.options import AMOUNT, CONTAINERS, GOAL_OF_PLAN, ITEMS, OBJECTIVES
from foon_asp.questions.posing import Command
from foon_asp.questions.posing_plan import pose_plan
from foon_asp.questions.python_arguments import Objectives, chosen_objectives, over_whole_network
from foon_asp.questions.python_options import CommonOptions, settings_of
from foon_asp.questions.question import Kind, Option, Role, question
from foon_asp.questions.result import Result
from foon_asp.questions.tree import Tree, as_tree, read_answer
from foon_asp.questions.verdict import Stop, simulation_fields, verdict_lines
from foon_asp.results.document import AboutGoals, Unserialized
from foon_asp.results.table import Block
from foon_asp.results.values import ListedConstraint, UsedUpRun
from foon_asp.results.values_of import question_fields

if TYPE_CHECKING:  # clingo and linear programs, which only rules and certificates need
    from foon_asp.asp import Settings
    from foon_asp.asp.user_rule_check import UserRuleCheck
    from foon_asp.certificate import Certificate  # noqa: F401 (named in a text)
    from foon_asp.questions.repair import Repaired


class Checked(Result, AboutGoals, frozen=True, kw_only=True, tag=schema_name("check")):
    """Whether a given tree or plan executes, and what stops it if not.

    In a plan, items are used up: the order of its units and their repeats count.

    Attributes:
        verdict: Whether the tree executes; a plan executes as listed or not at all.
        as_listed: What stops the listed order, if anything.
        in_any_order: What stops every order of a tree, if anything.
        order: The positions of units, from 1, in an order that executes. Units that cannot run are left out.
        used_up: Whether the tree, each step done once, runs where items are used up; null for a plan.
        costs: What the tree costs by every objective; null where the network does not have all of its units.
        not_in_network: The positions, from 1, of the units that are not in the network.
        breaks: The rules that the tree breaks; null if it does not execute or has units of its own.

    Example:
        >>> problem = foon_asp.load().problem("ice")
        >>> foon_asp.check(problem, foon_asp.solve(problem).tree).executes
        True
    """

    verdict: Verdict
    as_listed: Stop | None
    in_any_order: Stop | None
    order: tuple[int, ...]
    used_up: UsedUpRun | None
    costs: Costs | None
    not_in_network: tuple[int, ...]
    breaks: tuple[ListedConstraint, ...] | UnsetType | None = UNSET

    @classmethod
    def of(cls, tree: Tree, objectives: Iterable[Objective] = (), **fields: Any) -> Self:
        """Simulate a tree, or replay a plan, and return what was found.

        Costs are ``None`` if the network lacks one of its units.

        Parameters:
            tree: The tree or plan.
            objectives: The objectives of the question, listed in the result; nothing is proved here.
            fields: Further fields of a subclass.
        """
        problem, simulation = tree.problem, _simulate(tree)
        foreign = tuple(n for n, unit in enumerate(map(problem.network.unit_id, tree), 1) if unit is None)
        checked = cls(
            **question_fields(problem, objectives),
            **simulation_fields(tree, simulation),
            costs=None if foreign else problem.costs(tree.ids),
            not_in_network=foreign,
            **fields,
        )
        return checked.set_unserialized(tree=tree, simulation=simulation)

    tree = Unserialized[Tree]()
    """The tree as it was given."""

    @property
    def problem(self) -> Problem:
        """The problem that the tree is for."""
        return self.tree.problem

    @property
    def executes(self) -> bool:
        """Whether the tree executes, as listed or in another order."""
        return self.verdict is not Verdict.NEVER

    @property
    def in_order(self) -> Tree | None:
        """The tree in an order that executes; ``None`` if no order does."""
        if not self.executes:
            return None
        return self.tree.in_order(position - 1 for position in self.order)

    certificate = Unserialized["Certificate | None"](None)
    """The certificate that proves the tree the best, where one was asked for and found."""

    @property
    def ending(self) -> Ending:
        """``NEGATIVE`` if the tree does not execute, has units of its own, or breaks a rule.

        Otherwise, if a certificate is asked for, it is the ending of the proof. Otherwise, it is ``DONE``.
        """
        sound = self.executes and not self.not_in_network and not self.breaks
        return self.proof_ending if sound else Ending.NEGATIVE

    def show(self) -> Iterator[Block]:
        """Yield whether and in which order the tree executes, what stops it, broken rules, and the notes."""
        yield from verdict_lines(self.tree, self.simulation)
        yield from (*self._rule_lines(), *self.notes)

    def _rule_lines(self) -> Iterator[str]:
        """Yield lines on whether the tree keeps to the rules, and on broken rules; none without rules."""
        if self.breaks is UNSET:
            return
        if self.breaks is None:
            why = "has units that are not in the network" if self.executes else "does not execute"
            yield f"whether it keeps to the rules is not looked at, since it {why}"
        elif not self.breaks:
            yield "it keeps to the rules"
        else:
            yield f"it breaks {counted(len(self.breaks), 'rule')}:"
            for rule in self.breaks:
                yield from rule.lines()

    notes = Unserialized[tuple[str, ...]](())
    """Lines on what a certificate proves of the tree, where one was asked for."""

    proof_ending = Unserialized[Ending](Ending.DONE)
    """How the proof ended, where one was asked for."""

    simulation = Unserialized[Simulation]()
    """What the simulation of the tree found."""

    def foon(self) -> str:
        """Return the tree as FOON text, in an order that executes if there is one, else as listed."""
        return str(self.in_order or self.tree)

    def remark(self, format_: str) -> str:
        """Return the notes on the certificate; only results as text have them, so ``format_`` is not read."""
        return "\n".join(self.notes)

    def drawing(self) -> Drawing | None:
        """Return the drawing of the tree in the listed order."""
        return self.tree.drawing()

    def __repr__(self) -> str:
        shown = super().__repr__()
        return f"{shown[:-1]}, but breaks {counted(len(self.breaks), 'rule')}>" if self.breaks else shown


def _simulate(tree: Tree) -> Simulation:
    """Simulate a tree in any order; replay a plan, in which items are used up, in the listed order alone."""
    if tree.problem.items is None:
        return simulate_for(tree.problem, tree)
    shortage = replay_for(tree.problem, tree).shortage
    if shortage is None:
        return Simulation(Verdict.AS_LISTED, tuple(range(len(tree))), None, None)
    stop = Obstacle(shortage.step, shortage.node, used_up_by=shortage.consumers, amount=shortage.amount)
    return Simulation(Verdict.NEVER, (), stop, None)


def _pose_tree(command: Command, tree: Path, **named: Any) -> tuple[Problem, Tree]:
    """Read a tree from a file, and return its problem and the tree.

    With ``--repair``, a file that names no goals is added to the networks of the command.
    """
    if command.given("repair") and not read_answer(tree).goals:
        command.add_sources([tree])
    return pose_plan(command, tree=tree, **named)


def check_or_repair(
    problem: Problem, tree: Tree, *, repair: bool = False, certificate: File | None = None, **options: Any
) -> "Checked | Repaired":
    """Check a tree, or with ``repair`` find stand-ins and further units with which it executes.

    Raises :class:`UserError` for a repair with objectives.
    """
    if not repair:
        return check(problem, tree, certificate=certificate, **options)
    if options.pop("objectives"):
        raise UserError("a repair has objectives of its own: leave --objective out")
    from foon_asp.questions.repair import repair as repair_tree  # noqa: PLC0415 (the solver)

    return repair_tree(problem, tree, certificate=certificate, **options)


@question(
    Option(
        "tree",
        "The task tree: FOON text, or an answer in JSON.",
        Kind.FILE,
        Role.PROBLEM,
        metavar="TREE",
        positional=True,
    ),
    GOAL_OF_PLAN,
    CONTAINERS,
    *ITEMS,
    AMOUNT,
    Option(
        "repair",
        "Find the cheapest stand-ins and steps to add, with which every step of the tree executes.",
        Kind.FLAG,
        default=False,
    ),
    formats=("text", "json", "csv", "markdown", "foon"),
    pose=_pose_tree,
    command=check_or_repair,
    help_="""
    \b
    foon-asp check tree.txt --goal macaroni
    foon-asp check tree.txt --goal macaroni --rule ':- use(U), motion(U,"fry").'
    foon-asp check tree.txt --goal macaroni --certificate proof.json --objective success
    foon-asp check answer.json                              an answer knows its goal
    foon-asp check tree.json --network FOON.txt --kitchen kitchen.json --repair
    foon-asp check tree.json --network FOON.txt --repair --certificate proof.json
    foon-asp verify proof.json tree.json --network FOON.txt

    The tree is FOON text, units in the order of execution, or an answer in JSON. Where no data are named and
    the bundled kitchen has less than half of its units, it is the network itself.

    With --items used-up, order and repeats count: the plan is replayed copy by copy.

    Under rules, it says of a tree that executes which of them it breaks. With --certificate, it proves the
    tree the best without a search, and writes the proof, which `foon-asp verify` checks.

    With --repair, available nodes stand in for others (docs/stand-ins.md), units of the network are added,
    and the order may change: the least dissimilarity, then the fewest units, with a proof.

    Exits with 0 when the tree executes, as listed or in the order that is then given; with 1 when no
    order executes, a unit is not in the network, or a rule is broken. With --certificate, it exits with 0
    when the tree is proved the best by every objective, with 1 also when it is not the best, and with 3 when
    less is proved.
    """,
)
def check(
    problem: Problem,
    tree: str | PathLike[str] | Iterable[FunctionalUnit],
    *,
    certificate: Annotated[File | None, Option(kind=Kind.WRITTEN)] = None,
    objectives: Annotated[
        Objectives,
        OBJECTIVES._replace(help="What is best, for a certificate: the most important first.", default=()),
    ] = (),
    **options: Unpack[CommonOptions],
) -> Checked:
    """Simulate a task tree for the goals of a problem: does it execute, and in which order?

    Parameters:
        tree: The path of a file (FOON text, or an answer in JSON), or functional units in the order listed,
            such as a :class:`TaskTree`. Where items are used up, it is a plan, in which a unit may be listed
            several times.
        certificate: Also prove the tree the best, and write the proof. The argument is the path of the file.
            It is not written for a tree that does not execute, has units of its own, or breaks a rule.

    Returns:
        Whether the tree ``executes``, the tree ``in_order``, what stops it, the rules that it ``breaks``, and
        the ``certificate`` that was found, if one was asked for.

    Raises:
        UserError: if the file cannot be read or contains no tree, for a wrong rule, for encodings, and for
            objectives without a certificate.

    Example:
        >>> problem = foon_asp.load().problem("macaroni")
        >>> checked = foon_asp.check(problem, foon_asp.search(problem, "bfs").tree)
        >>> checked.verdict
        <Verdict.REORDERED: 'executes in another order'>
        >>> checked.as_listed.missing.label
        'stove'
        >>> rule = ':- use(U), motion(U,"turn on").'
        >>> checked = foon_asp.check(problem, foon_asp.solve(problem).tree, constraints=rule)
        >>> [broken.text for broken in checked.breaks] == [rule]
        True
    """
    rules, used_up = settings_of(options), problem.items is not None
    if rules.replaced is not None:
        raise UserError(f"{rules.replaced}: a tree is checked without encodings: leave them out")
    if objectives and certificate is None:
        raise UserError("objectives are those of a certificate: add --certificate FILE")
    rule_check = _user_rule_check(rules, used_up) if rules.constraints or rules.constants else None
    if certificate is not None or (rule_check is not None and not rule_check.local):
        problem = over_whole_network(problem)
    chosen = () if certificate is None else chosen_objectives(problem, objectives or "units")
    task_tree = as_tree(problem, tree)
    checked = Checked.of(task_tree, chosen)
    if rule_check is not None:
        broken = None
        if checked.executes and not checked.not_in_network:
            broken = tuple(rule.listed for rule in rule_check.broken_rules(task_tree.problem, task_tree.ids))
        checked = structs.replace(checked, breaks=broken).set_unserialized(**checked.__dict__)
    in_order = checked.in_order
    if certificate is not None and in_order is not None and checked.ending is Ending.DONE:
        from foon_asp.questions.certifying import certify_tree  # noqa: PLC0415

        proof, proof_ending, note = certify_tree(in_order, chosen, rules, certificate)
        checked.set_unserialized(certificate=proof, proof_ending=proof_ending, notes=(note,))
    return checked


def _user_rule_check(rules: "Settings", used_up: bool) -> "UserRuleCheck":
    """Return the check that finds which user rules a tree breaks, or a plan if ``used_up``."""
    from foon_asp.asp.user_rule_check import UserRuleCheck  # noqa: PLC0415 (takes clingo along)

    return UserRuleCheck(rules, used_up)
