"""A page that shows a tree and what else is known: one file, for any browser, without a network."""

from collections.abc import Container, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from enum import StrEnum
from pathlib import Path
from typing import Any

from foon_asp.asp import Settings
from foon_asp.asp.postconditions import Postconditions
from foon_asp.dataset.paths import File, Files
from foon_asp.deadline import Cancel
from foon_asp.errors import UserError
from foon_asp.foon import Foon
from foon_asp.network import counted
from foon_asp.problem import Objective, Problem, levels
from foon_asp.problem.progress import OnProgress
from foon_asp.questions.alternatives import Alternatives, alternatives
from foon_asp.questions.answer import Answer, answered
from foon_asp.questions.arguments import Constants, Objectives, asked_with, chosen_objectives, settings, whole
from foon_asp.questions.certify import Certified, certified
from foon_asp.questions.contract import Option, Part, question, question_of
from foon_asp.questions.options import CONTAINERS, GOALS, HOW, ITEMS, OBJECTIVES
from foon_asp.questions.pareto import Front, pareto
from foon_asp.questions.posing import Command, one_problem, the_data
from foon_asp.questions.result import Ending, Result
from foon_asp.questions.search import Retrieved, retrieve
from foon_asp.questions.searching import known_searches
from foon_asp.questions.shopping_list import Shopping, shopping_list
from foon_asp.questions.why_not import Explanation, why_not
from foon_asp.report.page import Page, network_json, view_json
from foon_asp.report.proof_cases import proof_json
from foon_asp.report.whole_file import utf_8, write_whole
from foon_asp.text.json_value import Json

_BEST = 5  # trees, the best and those after it


class Beside(StrEnum):
    """What a page shows beside the tree."""

    SEARCHES = "searches"
    PROOF = "proof"
    ALTERNATIVES = "alternatives"
    FRONT = "front"
    NETWORK = "network"


@dataclass(frozen=True, repr=False)
class View(Result):
    """A page about an ``answer``; :meth:`html` gives it, and :meth:`write` writes it into a file.

    Beside it the page shows what is not empty here: the trees of ``searches``, the certificate that is
    ``certified``, the answer ``without_rules``, ``alternatives``, the ``front``; where there is no tree,
    ``why_not`` and the ``shopping`` that would help; and the whole ``network`` of a problem. Beside a plan it
    shows the answer where items are ``lasting``, which no plan is better than, and the certificate is about
    that one. A page about a network alone has no ``answer``.

    Example:
        >>> page = foon_asp.view(foon_asp.load().problem("ice"))
        >>> page.html().splitlines()[0]
        '<!DOCTYPE html>'
    """

    answer: Answer | None
    searches: tuple[Retrieved, ...] = ()
    certified: Certified | None = None
    lasting: Answer | None = None
    without_rules: Answer | None = None
    alternatives: Alternatives | None = None
    front: Front | None = None
    why_not: Explanation | None = None
    shopping: Shopping | None = None
    network: Problem | None = None

    @property
    def ending(self) -> Ending:
        """As that of the answer."""
        return Ending.DONE if self.answer is None else self.answer.ending

    def text(self) -> str:
        """Give the answer in words, or how large the network is."""
        if self.answer is not None:
            return self.answer.text()
        assert self.network is not None
        network = self.network.network
        return f"{counted(len(network), 'unit')}, {counted(len(network.objects), 'object node')}\n"

    def json_dict(self) -> Json:
        """Give what is in the page: the documents of the answers as they are."""
        proof = None
        if self.certified is not None and self.certified.certificate is not None:
            proof = proof_json(self.certified.answer.problem, self.certified.certificate.content)
        others: dict[str, Result | None] = {
            "lasting": self.lasting,
            "without_rules": self.without_rules,
            "alternatives": self.alternatives,
            "front": self.front,
            "why_not": self.why_not,
            "shopping_list": self.shopping,
        }
        return view_json(
            None if self.answer is None else self.answer.json_dict(),
            self._trees(),
            searches=[found.json_dict() for found in self.searches],
            proof=proof,
            network=None if self.network is None else network_json(self.network),
            **{name: None if found is None else found.json_dict() for name, found in others.items()},
        )

    def _trees(self) -> Iterator[tuple[Problem, Iterable[int]]]:
        bought = None if self.shopping is None else self.shopping.outcome
        for answer in (self.answer, self.lasting, self.without_rules, bought):
            if answer is not None:
                yield answer.problem, answer.units or ()
        for found in self.searches:
            yield found.problem, found.retrieval.units if found.simulation else ()
        if self.alternatives is not None:
            yield from ((self.alternatives.problem, tree.units) for tree in self.alternatives.trees)
        if self.front is not None:
            yield from ((self.front.problem, point.units) for point in self.front.points)

    def html(self) -> str:
        """Give the page, a document by itself."""
        return self._page().html()

    def _page(self) -> Page:
        about = self.text() if self.answer is None else " + ".join(map(str, self.answer.problem.goal_nodes))
        return Page(f"{about.strip()} - foon-asp", self.text(), self.json_dict())

    def remark(self, format_: str) -> str:
        """Say what is claimed, where that is not the best tree."""
        return "" if self.answer is None else self.answer.remark(format_)

    def write(self, file: File, format_: str | None = None) -> None:
        """Write the page into a file.

        Parameters:
            file: The path of the file.
            format_: ``html``, or ``json`` for what is in the page; without it, the end of the file name
                chooses one.

        Raises:
            UserError: for another format, or a file that cannot be written.
        """
        how = question_of(view)
        form = format_ or how.format_of(Path(file))
        if form not in how.formats:
            raise UserError(f"found the format {form!r}, expected one of {', '.join(how.formats)}")
        write_whole(Path(file), utf_8(self.html() if form == "html" else self.json_text()))

    def __repr__(self) -> str:
        return f"<View of {self.text().strip() if self.answer is None else repr(self.answer)}>"

    def _in_notebook(self) -> dict[str, str]:
        """Give what a notebook shows by media type: the page, in a frame of its own."""
        return {"text/plain": repr(self), "text/html": self._page().frame()}


def _posed(
    command: Command,
    goals_named: Sequence[str],
    containers: str,
    items: str,
    stock: File | None,
    stays: File | None,
) -> tuple[Problem | Foon]:
    """Pose the goals that are named; without any it is about the data."""
    if goals_named:
        return one_problem(command, goals_named, containers, items, stock, stays)
    for option, flag in (
        ("objectives", "--objective"),
        ("beside", "--beside"),
        ("constraints", "--constraint"),
        ("rules", "--rule"),
    ):
        if command.given(option):
            raise UserError(f"{flag} is about a tree: name a goal with --goal")
    return the_data(command)


@question(
    GOALS,
    OBJECTIVES,
    CONTAINERS._replace(part=Part.PROBLEM | Part.QUESTION),
    *ITEMS,
    Option(
        "beside",
        f"What to show beside the tree: {', '.join(Beside)}; by default the first two.",
        many=True,
        choices=tuple(map(str, Beside)),
    ),
    *HOW,
    help_="""
    \b
    foon-asp view --goal macaroni -o macaroni.html
    foon-asp view --goal 'greek salad' --objective success --beside front -o salad.html
    foon-asp view --goal ice --constraint mine.lp -o ice.html
    foon-asp view --network FILE -o whole.html          a whole network
    foon-asp view --goal macaroni --serve               a page that asks again

    The file is whole in itself: open it in any browser, with no network. It walks through the best tree step
    by step, shows the trees of the searches and why no tree is better, and where there is none, why. Under
    constraints it shows the tree without them, too. Without a goal it shows the whole network.

    Exits with 0 when the tree is proved optimal, and otherwise as `solve` does.
    """,
    formats=("html", "json"),
    suffixes={".html": "html", ".htm": "html", ".json": "json"},
    pose=_posed,
)
def view(
    about: Problem | Foon,
    objectives: Objectives = "units",
    *,
    beside: Iterable[str] = (),
    constraints: Files = (),
    constants: Constants | None = None,
    encodings: File | None = None,
    containers: str = "strict",
    time_limit: float | None = None,
    memory_limit: int | str | None = None,
    on_progress: OnProgress | None = None,
    cancel: Cancel | None = None,
) -> View:
    """Solve a problem, and show what was found on a page that any browser opens; or show a whole network.

    The limits are for all of it.

    Parameters:
        about: A problem; or data that were loaded, whose whole network is shown.
        containers: The container rule for what can be made in a whole network: ``strict`` or ``implied``. A
            problem has its own.

    Returns:
        The page: ``html()`` gives it, ``write`` writes it into a file, and a notebook shows it.

    Raises:
        UserError: for a wrong argument or constraint.

    Example:
        >>> foon_asp.view(foon_asp.load().problem("ice"))
        <View of <Answer: optimal by units (strict containers): 2 units, 6 inputs, success 0.644>>
        >>> foon_asp.view(foon_asp.load())
        <View of 220 units, 418 object nodes>
    """
    if isinstance(about, Foon):
        if not len(about.dataset.data.network):
            raise UserError("the network has no units to show")
        return View(None, network=about.dataset.problem((0,), containers, everything=True))
    problem = about
    wanted = {str(each) for each in ([beside] if isinstance(beside, str) else beside)}
    for name in sorted(wanted - {*Beside}):
        raise UserError(f"found beside={name!r}, expected one of {', '.join(Beside)}")
    chosen = chosen_objectives(problem, objectives)
    how = settings(constraints, constants, encodings, time_limit, memory_limit)
    wanted = wanted or {Beside.SEARCHES, Beside.PROOF}
    rules = {"constraints": constraints, "constants": constants, "encodings": encodings}
    *_, grown = pages(problem, chosen, how, wanted, rules)
    return grown


def pages(
    problem: Problem,
    chosen: Sequence[Objective],
    how: Settings,
    wanted: Container[str],
    rules: Mapping[str, Any],
) -> Iterator[View]:
    """Give a page about a tree as it grows: first with its answer, then with one thing more beside it each.

    ``rules`` are those of the settings, as questions take them. A plan, in which items are used up, costs no
    less than the best tree, in which they are not; so the proof is about that tree. But not by ``kitchen``,
    and not under rules, which may count how often units are executed.
    """
    deadline = how.begun
    how = how._replace(deadline=deadline)
    ruled = bool(how.constraints) or how.encodings is not None
    plans, endless = problem.items is not None, replace(problem, items=None)
    proof = certified(problem, chosen, how) if Beside.PROOF in wanted and not plans else None
    answer = answered(asked_with(problem, how), chosen, how) if proof is None else proof.answer
    page = View(answer, certified=proof, network=whole(problem) if Beside.NETWORK in wanted else None)
    yield page

    def left() -> dict[str, Any]:
        return {"time_limit": deadline.left, "memory_limit": deadline.memory}

    if plans and not ruled:
        below = Objective.KITCHEN not in chosen  # what a plan makes itself, it need not take
        proof = certified(endless, chosen, how) if Beside.PROOF in wanted and below else None
        lasting = answered(endless, chosen, how) if proof is None else proof.answer
        if below:
            Postconditions(endless, levels(tuple(chosen)), how).no_better(answer, lasting, "where items last")
        if lasting and not answer:
            proof = None  # of a tree, and there is no plan to hold against it
        page = replace(page, certified=proof, lasting=lasting)
        yield page
    if ruled:
        page = replace(page, without_rules=answered(problem, chosen, settings(**left())))
        yield page
    if answer.ending is Ending.NEGATIVE:
        explained = why_not(endless, **rules, **left())
        if plans and explained.tree_exists:
            return  # it is what runs out
        helped = None if explained.tree_exists else shopping_list(endless, chosen, **rules, **left())
        yield replace(page, why_not=explained, shopping=helped)
        return
    if Beside.SEARCHES in wanted:
        known = known_searches(problem.rates is not None)
        page = replace(page, searches=tuple(retrieve(problem, each.name, **left()) for each in known))
        yield page
    if Beside.ALTERNATIVES in wanted:
        page = replace(page, alternatives=alternatives(problem, chosen, best=_BEST, **rules, **left()))
        yield page
    if Beside.FRONT in wanted:
        several = chosen if len(chosen) > 1 else _against(chosen, problem.rates is not None)
        yield replace(page, front=pareto(problem, several, **rules, **left()))


def _against(chosen: Sequence[Objective], rated: bool) -> tuple[Objective, ...]:
    """Give two objectives of a front, where one was asked for.

    Against it the number of units; against that success, or inputs where no rates are known.
    """
    if Objective.UNITS not in chosen:
        return (*chosen, Objective.UNITS)
    return (*chosen, Objective.SUCCESS if rated else Objective.INPUTS)
