"""Postconditions of every answer, independent of how it was found."""

import shlex
from collections.abc import Callable, Collection, Sequence
from decimal import Decimal
from fractions import Fraction
from functools import partial

from foon_asp.asp.outcome import Outcome, Proof, Status
from foon_asp.asp.settings import Settings
from foon_asp.errors import BugError, UserError
from foon_asp.hypergraph import ExactCosts, Reduced
from foon_asp.problem import Costs, Objective, Problem, executable_order, multiplies
from foon_asp.proof.simulation import Verdict, simulate_for
from foon_asp.proof.used_up_run import used_up_run
from foon_asp.rules.passed_constraint import RuleText


class Postconditions:
    """Checks of the answers to one question.

    ``levels`` are the objectives as optimized. ``own`` says that all rules are built-in: then a tree
    that does not execute is a bug. A violated check raises :class:`BugError` with the question.
    """

    def __init__(
        self, problem: Problem, levels: Sequence[Objective], settings: Settings, own: bool = True
    ) -> None:
        self.problem, self.levels = problem, tuple(levels)
        self._settings, self._own = settings, own

    def require(self, holds: bool, otherwise: Callable[[], str]) -> None:
        """Raise :class:`BugError` with a message and the question unless ``holds``."""
        if not holds:
            raise BugError(f"{otherwise()}\n{self._question()}")

    def tree(self, units: Collection[int]) -> tuple[int, ...]:
        """Require that units execute and make the goals; return them in an executable order.

        If there is an order in which each item can even be used up, that order is returned. Raises
        :class:`UserError` where user rules made a tree that does not execute.
        """
        problem = self.problem
        order = executable_order(problem, units)
        listed = tuple(sorted(units)) if order is None else order
        simulation = simulate_for(problem, problem.tree(listed))
        if simulation.verdict is not Verdict.AS_LISTED:
            message = f"the tree found {simulation.verdict}"
            if simulation.obstacle and simulation.obstacle.unit is not None:
                unit = problem.network.unit(listed[simulation.obstacle.unit])
                message += f" (the unit {unit.motion!r} lacks {simulation.obstacle.missing})"
            elif simulation.obstacle:
                message += f" (nothing in it makes {simulation.obstacle.missing})"
            if not self._own:
                raise UserError(f"{message}: check the constraints and encodings that were added or replaced")
            self.require(False, lambda: message)
        run = used_up_run(problem, problem.tree(listed))
        return listed if run.order is None else tuple(listed[position] for position in run.order)

    def no_tree(self) -> None:
        """Require that no tree makes all goals, by forward reachability over the units relevant for them.

        The required sets of a restriction are goals as well.
        """
        needs, gives, producers = self.problem.needs, self.problem.gives, self.problem.makers
        kitchen = self.problem.kitchen
        wanted = {goal for goal in self.problem.targets if goal not in kitchen}
        stack, missing = list(wanted), dict[int, int]()
        consumers: dict[int, list[int]] = {}
        ready: list[int] = []
        while stack:
            for unit in producers[stack.pop()]:
                if unit in missing:
                    continue
                lacking = {o for o in needs[unit] if o not in kitchen}
                missing[unit] = len(lacking)
                if not lacking:
                    ready.append(unit)
                for o in lacking:
                    consumers.setdefault(o, []).append(unit)
                    if o not in wanted:
                        wanted.add(o)
                        stack.append(o)
        made: set[int] = set()
        ran = bytearray(len(needs))
        while ready:
            unit = ready.pop()
            ran[unit] = 1
            for o in gives[unit]:
                if o not in made:
                    made.add(o)
                    for unit in consumers.get(o, ()):
                        missing[unit] -= 1
                        if not missing[unit]:
                            ready.append(unit)
        self.require(
            any(
                goal not in kitchen and not any(ran[unit] for unit in producers[goal])
                for goal in self.problem.targets
            ),
            lambda: "the answer is that there is no tree, but the goals can be made",
        )

    def outcome(self, outcome: Outcome, best: Costs | None = None, reduced: Reduced | None = None) -> None:
        """Require that the claims of an outcome with a tree are true.

        ``best`` has the costs of the incumbent of the search, ``reduced`` is the result of the reductions;
        both may be ``None``.
        """
        assert outcome.units is not None
        assert outcome.costs is not None
        units, costs = outcome.units, outcome.costs
        self.require(len(set(units)) == len(units), lambda: f"a unit is twice in the tree {list(units)}")
        anew = self.problem.costs(units)
        self.require(
            costs == anew,
            lambda: f"the answer says {_shown(costs)}, but the tree {list(units)} costs {_shown(anew)}",
        )
        self.require(
            best is None or costs.key(self.levels) <= best.key(self.levels),
            lambda: f"the tree {list(units)} costs {_shown(costs)}, but one was found for {_shown(best)}",
        )
        self._bounds(outcome, costs)
        if reduced is not None and reduced.costs is not None:
            self._reduced(outcome, costs, reduced, reduced.costs)

    def settled(self, tree: Collection[int], chosen: Collection[int], by: Sequence[Objective]) -> None:
        """Require that a tree costs the same as the ``chosen`` one by some objectives."""
        ours, theirs = self.problem.costs(tree), self.problem.costs(chosen)
        self.require(
            ours.key(by) == theirs.key(by),
            lambda: (
                f"the tree {sorted(tree)} is to be as good as {sorted(chosen)} by {', '.join(by)}, "
                f"but costs {_shown(ours)} and not {_shown(theirs)}"
            ),
        )

    def no_better(self, harder: Outcome, easier: Outcome, by: str) -> None:
        """Require that a tree is not better than the proved optimum of an easier question.

        The easier question allows more trees; ``by`` names it in the message. Checks nothing if its optimum
        is not proved.
        """
        if harder.costs is None or easier.status not in {Status.OPTIMAL, Status.INFEASIBLE}:
            return
        theirs = easier.costs
        self.require(
            theirs is not None and harder.costs.key(self.levels) >= theirs.key(self.levels),
            lambda: (
                f"the best tree {by} costs {_shown(theirs)}, but a question with fewer trees has one for "
                f"{_shown(harder.costs)}"
            ),
        )

    def _bounds(self, outcome: Outcome, costs: Costs) -> None:
        """Require that the bounds allow the tree, and meet its costs if it is called optimal."""
        exact = {objective: costs.measure(objective) for objective in self.levels}
        self.require(
            outcome.status is not Status.OPTIMAL or outcome.bounds == exact,
            lambda: (
                f"the tree is called optimal and costs {_shown(costs)}, "
                f"but the bounds are {list(map(_text, outcome.bounds.values()))}"
            ),
        )
        for objective, have in exact.items():
            bound = outcome.bounds.get(objective)
            if bound is None or (bound > have if multiplies(objective) else bound < have):
                return  # later objectives count among better trees only
            self.require(
                bound == have,
                partial(
                    "the tree has {} by {}, which the bound {} rules out".format,
                    _text(have),
                    objective,
                    _text(bound),
                ),
            )

    def _reduced(self, outcome: Outcome, costs: Costs, reduced: Reduced, exact: ExactCosts) -> None:
        """Require that reductions and outcome agree on the costs, and that the bound allows the tree."""
        assert outcome.units is not None
        units = frozenset(outcome.units)
        size = len(self.problem.network)
        actions = sorted(units)
        if any(objective.row.item for objective in self.levels):  # then taking an item is an action as well
            needed = {o for unit in units for o in self.problem.needs[unit]}
            actions += [size + o for o in needed & self.problem.kitchen]
        totals = dict.fromkeys(self.levels, 0)
        for action in actions:
            for objective, figure in exact.figures(action):
                totals[objective] += figure
        self.require(
            all(
                exact.is_logarithm(total, Fraction(costs.measure(objective)))
                if multiplies(objective)
                else exact.unscale(objective, total) == costs.measure(objective)
                for objective, total in totals.items()
            ),
            lambda: f"the tree {actions} costs {_shown(costs)}, but the reductions make it {totals}",
        )
        total = sum(map(exact, actions))
        self.require(
            reduced.bound <= total + exact.doubt,
            lambda: f"the tree costs {total} to the reductions, which bound all trees by {reduced.bound}",
        )
        self.require(
            outcome.proof is not Proof.CUTS
            or (units == reduced.tree and total <= reduced.bound + exact.doubt),
            lambda: (
                f"the tree {sorted(units)} is called optimal by cuts, which prove {reduced.bound} "
                f"of {total} for {sorted(reduced.tree or ())}"
            ),
        )

    def _question(self) -> str:
        """Return the question as a command and its settings, to reproduce it."""
        problem, settings = self.problem, self._settings
        words = ["foon-asp", "facts"]
        for goal in problem.goals:
            words += ["--goal", str(problem.network.objects[goal])]
        words += ["--objective", ",".join(self.levels), "--containers", str(problem.containers)]
        words += ["--level", str(problem.network.level)]
        relaxed = settings.relaxed.constraints if settings.relaxed else ()
        for constraint in dict.fromkeys((*settings.constraints, *relaxed)):
            words += ["--rule" if isinstance(constraint, RuleText) else "--constraint", str(constraint)]
        if settings.replaced is not None:
            words += ["--encodings", str(settings.replaced)]
        others = {
            "constants": ", ".join(settings.constants),
            "reductions": ", ".join(sorted(settings.reductions)) or "none",
            "options of clingo": " ".join(settings.clingo_options),
            "soft constraints or dropped ones": ", ".join(map(str, relaxed)),
            "bounds": f"{settings.bounded.rules} {settings.bounded.below or ''}".replace("\n", " ").strip()
            if settings.bounded
            else "",
            "time limit": "" if settings.begun.seconds is None else f"{settings.begun.seconds} s",
        }
        return "\n".join(
            [
                "what was asked, with the network, kitchen and rates of your command:",
                f"  {shlex.join(words)}",
                *(f"  {name}: {text}" for name, text in others.items() if text),
            ]
        )


def _shown(costs: Costs | None) -> str:
    if costs is None:
        return "nothing"
    return ", ".join(f"{name} {_text(figure)}" for name, figure in costs.measures.items())


def _text(figure: int | Fraction | None) -> str:
    """Return a figure as text, also if it has more digits than Python converts at once."""
    if figure is None:
        return "unknown"
    above, below = Decimal(figure.numerator), Decimal(figure.denominator)
    return f"{above}" if below == 1 else f"{above}/{below}"
