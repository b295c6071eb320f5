"""The best tree for a problem, and what is proved of it."""

from collections.abc import Iterable, Mapping, Sequence

from foon_asp.api.arguments import Constants, Objectives, chosen_objectives, file_weights, settings
from foon_asp.api.shown import Shown, picture_bundle
from foon_asp.api.tree import Tree
from foon_asp.api.warning import Warner
from foon_asp.asp import Outcome, Reporter, Settings
from foon_asp.asp.soft import SoftOutcome
from foon_asp.asp.soft import solve_soft as find_soft
from foon_asp.asp.solver import solve as find
from foon_asp.dataset.paths import File, Files
from foon_asp.problem import Problem
from foon_asp.reduce import parse_reductions
from foon_asp.report.answer import headline, outcome_json, outcome_text
from foon_asp.report.clash import soft_json, soft_text
from foon_asp.report.drawing import Drawing
from foon_asp.report.tree_drawing import solved_tree


class Answer(Shown, Outcome):
    """The answer to one problem: an :class:`~foon_asp.Outcome` that shows itself.

    ``status`` says what is proved, ``costs`` what the tree costs, ``units`` are its units by id in an order
    that executes; :attr:`tree` has them as values.
    """

    __slots__ = ()

    @property
    def tree(self) -> Tree | None:
        """The tree, in an order that executes; ``None`` where there is none."""
        return None if self.units is None else Tree.of(self.problem, self.units, headline(self))

    def text(self) -> str:
        """Give the answer as ``foon-asp solve`` does."""
        return outcome_text(self)

    def json_text(self) -> str:
        """Give the answer as ``foon-asp solve --format json`` does; docs/json.md describes it."""
        return outcome_json(self)

    def drawing(self) -> Drawing | None:
        """Give what the picture shows."""
        return None if self.units is None else solved_tree(self, self.units)

    def _repr_mimebundle_(
        self, include: Iterable[str] | None = None, exclude: Iterable[str] | None = None
    ) -> dict[str, str]:
        """Give what a notebook shows: the picture, whose caption says what is proved, or the text."""
        drawing = self.drawing()
        return super()._repr_mimebundle_() if drawing is None else picture_bundle(self, drawing)


class SoftAnswer(Shown, SoftOutcome):
    """The answer under constraints that may be broken at a price.

    ``penalty`` is what the tree of ``outcome`` pays, ``constraints`` says for each how often it is broken.
    """

    __slots__ = ()

    @property
    def outcome(self) -> Answer:
        """The best tree among those with the least penalty."""
        return Answer._make(super().outcome)

    def text(self) -> str:
        """Give the answer as ``foon-asp solve --soft`` does."""
        return soft_text(self)

    def json_text(self) -> str:
        """Give the answer as ``foon-asp solve --soft --format json`` does."""
        return soft_json(self)

    def drawing(self) -> Drawing | None:
        """Give what the picture shows."""
        return self.outcome.drawing()


def solve(
    problem: Problem,
    objectives: Objectives = "units",
    *,
    constraints: Files = (),
    constants: Constants | None = None,
    encodings: File | None = None,
    time_limit: float | None = None,
    memory_limit: int | str | None = None,
    reductions: str = "all",
    clingo_options: Sequence[str] = (),
    reporter: Reporter | None = None,
) -> Answer:
    """Find the best task tree, and prove that none is better.

    ``objectives`` are names (``units``, ``inputs``, ``inputs+ingredients``, ``success``, ``kitchen``) of
    which the first counts most; ``units`` always decides last. ``constraints`` are files, or names of ours,
    whose ``#const`` are set by ``constants``; ``encodings`` is a folder of encodings to use instead of ours.
    ``time_limit`` is in seconds; at the limit, or when interrupted, the answer is the best tree so far with
    the proved bound. ``reductions`` (``all``, ``safe``, ``none`` or a list by commas) come before the search;
    ``clingo_options`` go to clingo. ``reporter`` hears of trees, bounds and warnings; without it, faults of
    constraints that stop nothing are warned of (:class:`FoonWarning`). Raises :class:`UserError`.
    """
    chosen = chosen_objectives(problem, objectives)
    how = settings(constraints, constants, encodings, time_limit, memory_limit)._replace(
        reductions=parse_reductions(reductions), clingo_options=tuple(clingo_options)
    )
    return Answer._make(find(asked_with(problem, how), chosen, how, reporter or Warner()))


def solve_soft(
    problem: Problem,
    objectives: Objectives = "units",
    *,
    soft: Mapping[File, int],
    constraints: Files = (),
    constants: Constants | None = None,
    encodings: File | None = None,
    time_limit: float | None = None,
    memory_limit: int | str | None = None,
) -> SoftAnswer:
    """Find the tree that pays least for the constraints it breaks, and the best among those.

    ``soft`` gives the constraint files that may be broken, or names of ours, with their weights: each way of
    breaking a rule costs that much. Otherwise as :func:`solve`.
    """
    chosen = chosen_objectives(problem, objectives)
    how = settings(constraints, constants, encodings, time_limit, memory_limit)
    return SoftAnswer._make(find_soft(problem.whole, chosen, how, file_weights(soft), Warner()))


def asked_with(problem: Problem, how: Settings) -> Problem:
    """Give a problem over all that the rules of these settings may be about."""
    return problem.whole if how.constraints or how.replaced is not None else problem
