"""Postconditions: checks of each answer before it is returned, whatever search found it."""

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
    """Checks of the answers to one question; a check that fails raises :class:`BugError` with the question.

    ``levels`` are the objectives as optimized. ``is_built_in`` says that all rules are built in. Then a tree
    that does not execute is a bug of this program; otherwise it is an error in the user's rules.
    """

    def __init__(
        self, problem: Problem, levels: Sequence[Objective], settings: Settings, own: bool = True
    ) -> None:
        self.problem, self.levels = problem, tuple(levels)
        self._settings, self._own = settings, own

    def require(self, holds: bool, otherwise: Callable[[], str]) -> None:
        """Raise :class:`BugError` unless ``holds``.

        Its text is the message that ``otherwise`` returns, and the question.
        """
        if not holds:
            raise BugError(f"{otherwise()}\n{self._question()}")

    def require_executable(self, units: Collection[int]) -> tuple[int, ...]:
        """Require that units can be executed and make the goals; return them in an executable order.

        Among the executable orders, one is preferred that also executes if items are used up. Raises
        :class:`UserError` where user rules allowed a tree that does not execute.
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

    def require_no_tree(self) -> None:
        """Require that no tree makes all goals and required sets of the restriction.

        This is checked by forward reachability over the units that are relevant for these goals and sets.
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
        executed = bytearray(len(needs))
        while ready:
            unit = ready.pop()
            executed[unit] = 1
            for o in gives[unit]:
                if o not in made:
                    made.add(o)
                    for consumer in consumers.get(o, ()):
                        missing[consumer] -= 1
                        if not missing[consumer]:
                            ready.append(consumer)
        self.require(
            any(
                goal not in kitchen and not any(executed[unit] for unit in producers[goal])
                for goal in self.problem.targets
            ),
            lambda: "the answer is that there is no tree, but the goals can be made",
        )

    def require_true_claims(
        self, outcome: Outcome, best: Costs | None = None, reduced: Reduced | None = None
    ) -> None:
        """Require that the claims of an outcome with a tree are true: its costs, its bounds and its proof.

        No unit may be in the tree twice. ``best`` has the costs of the incumbent of the search: the tree must
        not cost more. ``reduced`` is the result of the reductions: it must agree with the costs. Both may be
        ``None``.
        """
        assert outcome.units is not None
        assert outcome.costs is not None
        units, costs = outcome.units, outcome.costs
        self.require(len(set(units)) == len(units), lambda: f"a unit is twice in the tree {list(units)}")
        recomputed = self.problem.costs(units)
        self.require(
            costs == recomputed,
            lambda: (
                f"the answer says {_costs_text(costs)}, "
                f"but the tree {list(units)} costs {_costs_text(recomputed)}"
            ),
        )
        self.require(
            best is None or costs.key(self.levels) <= best.key(self.levels),
            lambda: (
                f"the tree {list(units)} costs {_costs_text(costs)}, "
                f"but one was found for {_costs_text(best)}"
            ),
        )
        self._require_bounds(outcome, costs)
        if reduced is not None and reduced.costs is not None:
            self._require_agreement(outcome, costs, reduced, reduced.costs)

    def require_equal_costs(
        self, tree: Collection[int], chosen: Collection[int], objectives: Sequence[Objective]
    ) -> None:
        """Require that two trees, given by unit ids, cost the same by some objectives."""
        tree_costs, chosen_costs = self.problem.costs(tree), self.problem.costs(chosen)
        self.require(
            tree_costs.key(objectives) == chosen_costs.key(objectives),
            lambda: (
                f"the tree {sorted(tree)} is to be as good as {sorted(chosen)} by {', '.join(objectives)}, "
                f"but costs {_costs_text(tree_costs)} and not {_costs_text(chosen_costs)}"
            ),
        )

    def require_no_better(self, harder: Outcome, easier: Outcome, description: str) -> None:
        """Require that the tree of ``harder`` is no better than the proved optimum of ``easier``.

        The question of ``easier`` allows more trees; ``description`` names that question in the message.
        Nothing is checked if ``easier`` has no proof, or if ``harder`` has no tree.
        """
        if harder.costs is None or easier.status not in {Status.OPTIMAL, Status.INFEASIBLE}:
            return
        easier_costs = easier.costs
        self.require(
            easier_costs is not None and harder.costs.key(self.levels) >= easier_costs.key(self.levels),
            lambda: (
                f"the best tree {description} costs {_costs_text(easier_costs)}, "
                f"but a question with fewer trees has one for {_costs_text(harder.costs)}"
            ),
        )

    def _require_bounds(self, outcome: Outcome, costs: Costs) -> None:
        """Require that the bounds allow the tree, and equal its costs if it is called optimal.

        Bounds and costs are compared in the order of the objectives. The comparison ends at the first
        objective without a bound, or whose bound is better than the cost.
        """
        exact = {objective: costs.measure(objective) for objective in self.levels}
        self.require(
            outcome.status is not Status.OPTIMAL or outcome.bounds == exact,
            lambda: (
                f"the tree is called optimal and costs {_costs_text(costs)}, "
                f"but the bounds are {list(map(_number_text, outcome.bounds.values()))}"
            ),
        )
        for objective, cost in exact.items():
            bound = outcome.bounds.get(objective)
            if bound is None or (bound > cost if multiplies(objective) else bound < cost):
                return  # later objectives count among better trees only
            self.require(
                bound == cost,
                partial(
                    "the tree has {} by {}, which the bound {} rules out".format,
                    _number_text(cost),
                    objective,
                    _number_text(bound),
                ),
            )

    def _require_agreement(self, outcome: Outcome, costs: Costs, reduced: Reduced, exact: ExactCosts) -> None:
        """Require that reductions and outcome agree on the costs, and that the bound allows the tree.

        If the outcome is proved by cuts, its tree has to be that of the reductions, and cost what they prove.
        """
        assert outcome.units is not None
        units = frozenset(outcome.units)
        size = len(self.problem.network)
        actions = sorted(units)
        if any(objective.row.item for objective in self.levels):  # then taking an item is an action as well
            needed = {o for unit in units for o in self.problem.needs[unit]}
            actions += [size + o for o in needed & self.problem.kitchen]
        totals = dict.fromkeys(self.levels, 0)
        for action in actions:
            for objective, figure in exact.scaled_costs(action):
                totals[objective] += figure
        self.require(
            all(
                exact.is_logarithm(total, Fraction(costs.measure(objective)))
                if multiplies(objective)
                else exact.unscale(objective, total) == costs.measure(objective)
                for objective, total in totals.items()
            ),
            lambda: f"the tree {actions} costs {_costs_text(costs)}, but the reductions make it {totals}",
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
        """Return the question as text by which it can be reproduced: a command, and other settings.

        The command is ``foon-asp facts``. Settings that this command does not show follow, each on a line.
        """
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
        other_settings = {
            "constants": ", ".join(settings.constants),
            "reductions": ", ".join(sorted(settings.reductions)) or "none",
            "options of clingo": " ".join(settings.clingo_options),
            "soft constraints or dropped ones": ", ".join(map(str, relaxed)),
            "bounds": f"{settings.bounded.rules} {settings.bounded.below or ''}".replace("\n", " ").strip()
            if settings.bounded
            else "",
            "time limit": ""
            if settings.effective_deadline.seconds is None
            else f"{settings.effective_deadline.seconds} s",
        }
        return "\n".join(
            [
                "what was asked, with the network, kitchen and rates of your command:",
                f"  {shlex.join(words)}",
                *(f"  {name}: {text}" for name, text in other_settings.items() if text),
            ]
        )


def _costs_text(costs: Costs | None) -> str:
    """Return costs as text: ``units 2, inputs 6``; ``nothing`` for ``None``."""
    if costs is None:
        return "nothing"
    return ", ".join(f"{name} {_number_text(figure)}" for name, figure in costs.measures.items())


def _number_text(figure: int | Fraction | None) -> str:
    """Return a number as text, such as ``3/5``; ``unknown`` for ``None``.

    It may have more digits than ``str`` allows.
    """
    if figure is None:
        return "unknown"
    numerator, denominator = Decimal(figure.numerator), Decimal(figure.denominator)
    return f"{numerator}" if denominator == 1 else f"{numerator}/{denominator}"
