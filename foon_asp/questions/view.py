"""A tree, some units or a whole network to look at: a page for any browser, or a picture."""

from collections.abc import Container, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from enum import StrEnum
from fractions import Fraction
from os import PathLike
from pathlib import Path
from typing import Any, Unpack

from msgspec import structs

from foon_asp.asp import Settings
from foon_asp.asp.postconditions import Postconditions
from foon_asp.dataset.nearby import without_reading_more
from foon_asp.dataset.paths import File
from foon_asp.errors import UserError
from foon_asp.foon import Foon
from foon_asp.json_layout import Json
from foon_asp.network import FunctionalUnit, TaskTree, counted, unit_at_level
from foon_asp.pictures.dot import dot_text
from foon_asp.pictures.drawing import Drawing
from foon_asp.pictures.graphml import graphml_text
from foon_asp.pictures.mermaid import mermaid_markdown, mermaid_text
from foon_asp.pictures.notebook import picture_bundle
from foon_asp.pictures.page import Page
from foon_asp.pictures.painting import paint_drawing
from foon_asp.pictures.tree_drawing import network_drawing, tree_drawing
from foon_asp.pictures.whole_network import WholeNetwork
from foon_asp.problem import DEFAULT_RULE, ContainerRule, Objective, Problem, container_rule, levels
from foon_asp.questions.alternatives import Alternatives, alternatives
from foon_asp.questions.answer import Answer, answer_problem, answer_under_rules
from foon_asp.questions.caller import caller
from foon_asp.questions.certifying import solve_with_certificate
from foon_asp.questions.ending import Ending
from foon_asp.questions.options import AMOUNT, CONTAINERS, GOALS, ITEMS, OBJECTIVES
from foon_asp.questions.page_data import PageData, UnitRate
from foon_asp.questions.pareto import Front, pareto
from foon_asp.questions.posing import Command, is_picture_of_tree, pose_data, pose_problem
from foon_asp.questions.python_arguments import (
    Objectives,
    chosen_objectives,
    over_whole_network,
    problem_for_rules,
)
from foon_asp.questions.python_options import CommonOptions, Limits, settings_of, start_deadline
from foon_asp.questions.question import Kind, Option, Role, question
from foon_asp.questions.result import NothingToDrawError, Result
from foon_asp.questions.search import Retrieved, search
from foon_asp.questions.search_options import usable_searches
from foon_asp.questions.shopping_list import Shopping, shopping_list
from foon_asp.questions.tree import as_tree, read_listed_units
from foon_asp.questions.why_not import Explanation, why_not
from foon_asp.results.proof_cases import ProofCases
from foon_asp.whole_file import utf_8, write_whole

_MERMAID_PAGE = ".md"
_SHOWN = (
    *("answer", "searches", "lasting", "without_rules"),
    *("alternatives", "front", "why_not", "shopping_list"),
)
_PAGES = ("html", "json")
_PICTURES = ("svg", "png", "pdf", "dot", "mermaid", "graphml")
_RULE_OPTIONS = ("constraints", "constants", "encodings")
_FOR_THE_BEST = {
    "objectives": "--objective",
    "beside": "--beside",
    "constraints": "--constraint",
    "rules": "--rule",
    "constants": "-c",
    "encodings": "--encodings",
}


class PagePart(StrEnum):
    """A part that a page can show beside the tree."""

    SEARCHES = "searches"
    PROOF = "proof"
    ALTERNATIVES = "alternatives"
    FRONT = "front"
    NETWORK = "network"


_SUFFIXES = {
    ".html": "html",
    ".htm": "html",
    ".json": "json",
    ".svg": "svg",
    ".png": "png",
    ".pdf": "pdf",
    ".dot": "dot",
    ".mmd": "mermaid",
    _MERMAID_PAGE: "mermaid",
    ".graphml": "graphml",
}


class View(Result, frozen=True):
    """A page about an ``answer``, and the picture of its tree; :meth:`write` writes either into a file.

    The page shows the following fields, unless they are empty:

    ``answer``: the best tree. A page about a network alone has no answer.
    ``searches``: the results of searches for the same goals.
    ``certified``: the answer whose certificate is shown.
    ``lasting``: beside a plan, the answer for lasting items, which no plan beats; ``certified`` is about it.
    ``without_rules``: the answer without user rules.
    ``alternatives`` and ``front``: other trees.
    ``why_not`` and ``shopping_list``: why there is no tree, and what would help.
    ``network``: a problem over the whole network, which is shown.

    For a given tree or given units, there is only a ``picture``, and no page. SVG, PNG and PDF raise
    :class:`UserError` if the picture would be too large, or if the packages of ``foon-asp[pictures]`` are
    missing. All pictures raise :class:`NothingToDrawError` if there is no tree.

    Example:
        >>> page = foon_asp.view(foon_asp.load().problem("ice"))
        >>> page.html().splitlines()[0]
        '<!DOCTYPE html>'
        >>> page.dot().splitlines()[0]
        'digraph foon {'
    """

    SUFFIXES = _SUFFIXES

    answer: Answer | None
    searches: tuple[Retrieved, ...] = ()
    certified: Answer | None = None
    lasting: Answer | None = None
    without_rules: Answer | None = None
    alternatives: Alternatives | None = None
    front: Front | None = None
    why_not: Explanation | None = None
    shopping_list: Shopping | None = None
    network: Problem | None = None
    picture: Drawing | None = None

    @property
    def ending(self) -> Ending:
        """The ending of the answer; ``DONE`` without one."""
        return Ending.DONE if self.answer is None else self.answer.ending

    def text(self) -> str:
        """Return the answer in words; without an answer, the caption of the picture."""
        return self._drawing_or_error().caption[0] + "\n" if self.answer is None else self.answer.text()

    @property
    def data(self) -> PageData:
        """The data of the page: the documents of the answers.

        Raises:
            UserError: for a given tree or some units, which have no page.
        """
        if self.picture is not None:
            raise UserError(f"a given tree and units have no page: choose one of {', '.join(_PICTURES)}")
        certificate = None if self.certified is None else self.certified.certificate
        proof = None
        if self.certified is not None and certificate is not None:
            proof = ProofCases.of(self.certified.problem, certificate.content)
        rates = {
            problem.network.unit_number(unit): Fraction(problem.rate(unit))
            for problem, units in self._trees()
            for unit in units
            if problem.rates is not None
        }
        return PageData(
            rates=tuple(UnitRate(unit, rates[unit]) for unit in sorted(rates)) or None,
            proof=proof,
            network=None if self.network is None else WholeNetwork.of(self.network),
            **{name: getattr(self, name) for name in _SHOWN},
        )

    def json_dict(self) -> Json:
        """Return :attr:`data` as plain values."""
        return self.data.json_dict()

    def _trees(self) -> Iterator[tuple[Problem, Iterable[int]]]:
        """Yield the problem and the unit ids of each tree that the page shows."""
        shopping_answer = None if self.shopping_list is None else self.shopping_list.answer
        for answer in (self.answer, self.lasting, self.without_rules, shopping_answer):
            if answer is not None:
                yield answer.problem, answer.ids or ()
        for retrieved in self.searches:
            yield retrieved.problem, retrieved.ids
        if self.alternatives is not None:
            problem = self.alternatives.problem
            yield from (
                (problem, problem.network.units_of_numbers(tree.ids)) for tree in self.alternatives.trees
            )
        if self.front is not None:
            front_problem = self.front.problem
            yield from (
                (front_problem, front_problem.network.units_of_numbers(point.ids))
                for point in self.front.points
            )

    def html(self) -> str:
        """Return the page as one HTML document, which loads no other files."""
        return self._page().html()

    def _page(self) -> Page:
        """Return the page: the goals or the caption as title, its text, and its data as plain values."""
        about = self.text() if self.answer is None else " + ".join(map(str, self.answer.problem.goal_nodes))
        return Page(f"{about.strip()} - foon-asp", self.text(), self.json_dict())

    def dot(self) -> str:
        """Return the picture in DOT, Graphviz' language."""
        return dot_text(self._drawing_or_error())

    def png(self) -> bytes:
        """Return the picture as PNG."""
        return paint_drawing(self._drawing_or_error(), "png")

    def pdf(self) -> bytes:
        """Return the picture as PDF."""
        return paint_drawing(self._drawing_or_error(), "pdf")

    def mermaid(self) -> str:
        """Return the picture as a Mermaid flowchart."""
        return mermaid_text(self._drawing_or_error())

    def graphml(self) -> str:
        """Return the nodes and arrows of the picture as GraphML, for Gephi, networkx and the like."""
        return graphml_text(self._drawing_or_error())

    def drawing(self) -> Drawing | None:
        """Return the drawing of the tree, or else of the network or the units; ``None`` if no tree exists."""
        if self.answer is not None:
            return self.answer.drawing()
        if self.network is None:
            return self.picture
        network = self.network.network
        caption = [
            f"A network of {counted(len(network), 'unit')}, {counted(len(network.objects), 'object node')}"
        ]
        return network_drawing(network, range(len(network)), self.network.kitchen, (), caption)

    def _drawing_or_error(self) -> Drawing:
        """Return the drawing; raises :class:`NothingToDrawError` if no tree exists."""
        drawing = self.drawing()
        if drawing is None:
            raise NothingToDrawError("there is no tree to draw")
        return drawing

    def remark(self, format_: str) -> str:
        """Return the remark of the answer; empty without an answer."""
        return "" if self.answer is None else self.answer.remark(format_)

    def write(self, file: File, format_: str | None = None) -> None:
        """Write the page or the picture into a file, as :meth:`Result.write` does for other results.

        A file that ends in ``.md`` is Markdown with a flowchart.
        """
        if format_ in {None, "mermaid"} and Path(file).suffix.lower() == _MERMAID_PAGE:
            write_whole(Path(file), utf_8(mermaid_markdown(self._drawing_or_error())))
        else:
            super().write(file, format_)

    def __repr__(self) -> str:
        return f"<View of {self.text().strip() if self.answer is None else repr(self.answer)}>"

    def _in_notebook(self) -> dict[str, str]:
        """Return the notebook display by media type: the page in a frame, or the picture."""
        if self.picture is not None:
            return picture_bundle(self, self.picture)
        return {"text/plain": repr(self), "text/html": self._page().frame()}


def _pose_goals_or_data(
    command: Command,
    goals_named: Sequence[str],
    containers: str,
    tree: File | None,
    units: Sequence[int],
    **items: Any,
) -> tuple[Problem | Foon]:
    """Return the problem of the goals, if there are any, or else the data; in a tuple of one.

    Goals are those named or, without names, those that a recipe has. If a ``tree`` or ``units`` are named,
    the goals of a recipe do not count. Raises :class:`UserError` for options that do not go with what is
    shown.
    """
    listed = tree is not None or bool(units)
    for_goals = bool(goals_named) or (not listed and is_picture_of_tree(command, goals_named))
    for option, flag in _FOR_THE_BEST.items():
        if command.given(option) and (listed or not for_goals):
            raise UserError(f"{flag} is for the best tree for a --goal; nothing is solved here")
    if command.given("beside") and caller().form in _PICTURES:
        raise UserError("--beside is for a page: end the file in .html")
    if for_goals:
        return pose_problem(command, goals_named, containers, **items)
    if command.given("items"):
        raise UserError("--items is for a plan for a --goal: name one")
    return pose_data(command)


@question(
    GOALS,
    Option("tree", "A task tree to draw.", Kind.FILE, Role.PROBLEM | Role.QUESTION, metavar="TREE.txt"),
    Option(
        "units",
        "The id of a unit to draw.",
        Kind.WHOLE,
        Role.PROBLEM | Role.QUESTION,
        flags=("--unit",),
        many=True,
        metavar="ID",
    ),
    OBJECTIVES,
    CONTAINERS._replace(role=Role.PROBLEM | Role.QUESTION),
    *ITEMS,
    AMOUNT,
    Option(
        "beside",
        f"What a page shows beside the tree: {', '.join(PagePart)}.",
        default=(PagePart.SEARCHES.value, PagePart.PROOF.value),
        many=True,
        choices=tuple(map(str, PagePart)),
    ),
    help_="""
    \b
    foon-asp view --goal macaroni -o macaroni.html      a page
    foon-asp view --goal macaroni -o macaroni.svg       a picture of the optimal task tree
    foon-asp view --goal 'greek salad' --objective success --beside front -o salad.html
    foon-asp view recipe.txt -o recipe.pdf              what the recipe makes
    foon-asp view --tree tree.txt --goal macaroni -o t.png   a task tree read from FOON text
    foon-asp view --unit 12 -o unit.svg                 one functional unit, by id
    foon-asp view --network FILE -o whole.graphml       a whole network
    foon-asp view --goal macaroni --serve               a page that asks again

    The page is whole in itself: open it in any browser, with no network. It walks through the best tree step
    by step, shows the trees of the searches and why no tree is better, and where there is none, why. Under
    constraints it shows the tree without them, too. Without a goal, a recipe is asked for what it makes, as
    by `solve`; with --network, or without a file, the whole network is shown. With --tree and --unit, --goal
    says which nodes are shown as goals, and nothing is solved.

    Exits with 0 when the tree is proved optimal, and otherwise as `solve` does.
    """,
    formats=(*_PAGES, *_PICTURES),
    suffixes=View.SUFFIXES,
    pose=_pose_goals_or_data,
)
def view(
    about: Problem | Foon | Answer,
    objectives: Objectives = "units",
    *,
    tree: str | PathLike[str] | Iterable[FunctionalUnit] | None = None,
    units: Iterable[int] = (),
    beside: Iterable[str] = (PagePart.SEARCHES, PagePart.PROOF),
    **options: Unpack[CommonOptions],
) -> View:
    """Solve a problem, and show what was found on a page or as a picture; or show what is given.

    A given tree, some units or a whole network are shown without solving; for these, there are no
    ``objectives``, rules and limits. The limits are for the whole question. If ``about`` is an answer, all
    other arguments are ignored.

    Parameters:
        about: A problem, whose goals are marked; data that were loaded, whose whole network is shown; or an
            answer, which is shown as it is.
        tree: A tree to draw: the path of a file (FOON text, or an answer in JSON), or functional units.
        units: Ids of units to draw, as in ``json()``.
        beside: The names of parts (:class:`PagePart`) to show on a page beside the tree. Without any, there
            is only the tree, which is enough for a picture.

    Returns:
        The page and the picture: ``html()``, ``svg()``, ``png()``, ``pdf()``, ``dot()``, ``mermaid()`` and
        ``graphml()`` give them, ``write`` writes one into a file, and a notebook shows the page.

    Raises:
        UserError: for a wrong argument or constraint, a file that cannot be read, a unit that the network
            does not have, or rules where nothing is solved.

    Example:
        >>> foon_asp.view(foon_asp.load().problem("ice"))
        <View of <Answer: optimal by units (strict containers): 2 units, 6 inputs, success 0.644>>
        >>> foon_asp.view(foon_asp.solve(foon_asp.load().problem("ice"))).html().splitlines()[0]
        '<!DOCTYPE html>'
        >>> foon_asp.view(foon_asp.load())
        <View of A network of 220 units, 418 object nodes>
        >>> foon_asp.view(foon_asp.load(), units=[12]).dot().splitlines()[0]
        'digraph foon {'
    """
    if isinstance(about, Answer):
        return View(about)
    listed = tuple(dict.fromkeys(units))
    rules = {name: options[name] for name in _RULE_OPTIONS if name in options}  # type: ignore[literal-required]
    rule = options.get("containers", DEFAULT_RULE.value)
    if tree is not None and listed:
        raise UserError("a tree and units are two different drawings: give one of them")
    if tree is None and not listed and isinstance(about, Problem):
        wanted = {str(name) for name in ([beside] if isinstance(beside, str) else beside)}
        for name in sorted(wanted - {*PagePart}):
            raise UserError(f"found beside={name!r}, expected one of {', '.join(PagePart)}")
        chosen, settings = chosen_objectives(about, objectives), settings_of(options)
        if not wanted or caller().form in _PICTURES:
            return View(answer_under_rules(about, chosen, settings))
        *_, complete_page = pages(about, chosen, settings, wanted, rules)
        return complete_page
    if any(rules.values()):
        raise UserError("rules are for the best tree of a problem; nothing is solved here")
    if listed:
        return View(None, picture=_units_drawing(about, listed))
    if tree is not None:
        drawing = (
            as_tree(about, tree).drawing()
            if isinstance(about, Problem)
            else _drawing_without_goals(about, container_rule(rule), tree)
        )
        if not drawing.unit_count:
            raise UserError("the tree has no functional unit to draw")
        return View(None, picture=drawing)
    assert isinstance(about, Foon)
    if not len(about.dataset.data.network):
        raise UserError("the network has no units to show")
    return View(None, network=about.dataset.problem((0,), rule, everything=True))


def _units_drawing(about: Problem | Foon, unit_ids: Sequence[int]) -> Drawing:
    """Return the drawing of some units, by id in the whole network; the goals of a problem are marked.

    Raises :class:`UserError` for an id that the network does not have.
    """
    goal_ids: Sequence[int] = ()
    if isinstance(about, Problem):
        posed = without_reading_more(about)
        goal_ids = [posed.network.object_number(goal) for goal in posed.goals]
        about = Foon.of(about)
    data, goal_ids = about.dataset.data_part(goal_ids, unit_ids)
    network = data.network
    units = [unit for unit in map(network.unit_of_number, unit_ids) if unit is not None]
    caption = f"Functional units {', '.join(map(str, unit_ids))}"
    if len(units) == 1:
        file, line, *_ = network.sources[units[0]][0]
        caption = f"Functional unit {unit_ids[0]} ({Path(file).name}, line {line})"
    return network_drawing(network, units, data.kitchen, goal_ids, [caption])


def _drawing_without_goals(
    foon: Foon, rule: ContainerRule, tree: str | PathLike[str] | Iterable[FunctionalUnit]
) -> Drawing:
    """Return the drawing of a tree where no goals are given; only the data that it touches are read.

    ``rule`` is the container rule. A unit that is listed twice is drawn once.
    """
    if isinstance(tree, str | PathLike):
        tree = [unit for unit, _ in read_listed_units(Path(tree), lambda: foon.dataset.whole_network)[0]]
    task_tree = TaskTree(tuple(dict.fromkeys(unit_at_level(unit, foon.level) for unit in tree)))
    data, _ = foon.dataset.data_part((), tree=task_tree)
    kitchen = {data.network.objects[o] for o in data.kitchen}
    return tree_drawing(task_tree, kitchen, (), rule, data.utensils, data.network)


def pages(
    problem: Problem,
    chosen: Sequence[Objective],
    settings: Settings,
    wanted: Container[str],
    rules: Mapping[str, Any],
) -> Iterator[View]:
    """Yield a page several times: first with the answer, then each time with one more part.

    ``wanted`` are the names of the parts (:class:`PagePart`); ``rules`` are the rules of the settings, as
    keywords of questions. The first page has the network and, unless items are used up, the proof. Other
    parts come in this order:

    - Where items are used up and there are no rules: the answer for lasting items, and its proof. No plan
      costs less than this answer, except by ``kitchen``; there is no proof by ``kitchen``.
    - Under rules: the answer without them.
    - If there is no tree: why, and a shopping list unless rules are the reason. No other part follows. For
      a plan, this part is left out if there is a tree for lasting items.
    - The searches, the five best alternatives and the front, as far as they are wanted.

    The limits of ``settings`` are for all pages together.
    """
    deadline = settings.effective_deadline
    settings = settings._replace(deadline=deadline)
    has_rules = bool(settings.constraints) or settings.encodings is not None
    is_of_plan, lasting_problem = problem.items is not None, replace(problem, items=None)
    proof = (
        solve_with_certificate(problem, chosen, settings)
        if PagePart.PROOF in wanted and not is_of_plan
        else None
    )
    answer = (
        answer_problem(problem_for_rules(problem, settings), chosen, settings) if proof is None else proof
    )
    page = View(
        answer, certified=proof, network=over_whole_network(problem) if PagePart.NETWORK in wanted else None
    )
    yield page

    def remaining_limits() -> Limits:
        """Return the time that remains, in seconds, and the memory limit, as options of a question."""
        return {"time_limit": deadline.remaining_seconds, "memory_limit": deadline.memory}

    if is_of_plan and not has_rules:
        # a plan need not take from the kitchen items that it makes
        is_bounded = Objective.KITCHEN not in chosen
        wants_proof = is_bounded and PagePart.PROOF in wanted
        proof = solve_with_certificate(lasting_problem, chosen, settings) if wants_proof else None
        lasting = answer_problem(lasting_problem, chosen, settings) if proof is None else proof
        if is_bounded:
            Postconditions(lasting_problem, levels(tuple(chosen)), settings).require_no_better(
                answer.outcome, lasting.outcome, "where items last"
            )
        if lasting and not answer:
            proof = None  # it proves a tree optimal, but there is no plan
        page = structs.replace(page, certified=proof, lasting=lasting)
        yield page
    if has_rules:
        page = structs.replace(
            page,
            without_rules=answer_problem(
                problem, chosen, Settings(deadline=start_deadline(remaining_limits()))
            ),
        )
        yield page
    if answer.ending is Ending.NEGATIVE:
        explained = why_not(lasting_problem, **rules, **remaining_limits())
        if is_of_plan and explained.tree_exists:
            return  # items run out, which why_not does not explain
        shopping = None
        if not explained.tree_exists:
            shopping = shopping_list(lasting_problem, chosen, **rules, **remaining_limits())
        yield structs.replace(page, why_not=explained, shopping_list=shopping)
        return
    if PagePart.SEARCHES in wanted:
        methods = usable_searches(problem.rates is not None)
        page = structs.replace(
            page, searches=tuple(search(problem, method.name, **remaining_limits()) for method in methods)
        )
        yield page
    if PagePart.ALTERNATIVES in wanted:
        page = structs.replace(
            page, alternatives=alternatives(problem, chosen, best=5, **rules, **remaining_limits())
        )
        yield page
    if PagePart.FRONT in wanted:
        front_objectives = chosen if len(chosen) > 1 else _front_objectives(chosen, problem.rates is not None)
        yield structs.replace(page, front=pareto(problem, front_objectives, **rules, **remaining_limits()))


def _front_objectives(chosen: Sequence[Objective], rated: bool) -> tuple[Objective, ...]:
    """Return two objectives for a front: the only objective of the question, and a second.

    The second is ``units``. For a question by ``units``, it is ``success``, or ``inputs`` without rates.
    """
    if Objective.UNITS not in chosen:
        return (*chosen, Objective.UNITS)
    return (*chosen, Objective.SUCCESS if rated else Objective.INPUTS)
