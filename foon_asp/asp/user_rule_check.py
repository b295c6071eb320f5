"""The user rules that a given tree or plan breaks."""

from collections import Counter
from collections.abc import Collection

from foon_asp.asp.assembly import assemble
from foon_asp.asp.integrity import IntegrityConstraint, errors_at_sources
from foon_asp.asp.prepared import Prepared
from foon_asp.asp.settings import Settings
from foon_asp.asp.soft import soft_rules
from foon_asp.encoding.clingo_run import run
from foon_asp.encoding.cost_scales import Scales
from foon_asp.encoding.fact_writer import write_facts, write_least_penalty, write_times, write_tree
from foon_asp.encoding.run import Run
from foon_asp.errors import UserError
from foon_asp.plans.built_for_plans import require_built_for_plans, require_rules_of_plans
from foon_asp.problem import Objective, Problem, levels, reach


class UserRuleCheck:
    """A check that finds the user rules that an executable tree breaks or, if items are used up, a plan.

    The constraints are read once, for any number of trees. ``local`` says that units outside a tree do not
    matter for any constraint.
    """

    def __init__(self, settings: Settings, used_up: bool = False) -> None:
        """Read the constraints of settings; ``used_up`` says that plans will be checked.

        Raises :class:`UserError` for faults in the constraints.
        """
        program = assemble(settings, lambda _: None, used_up)
        if used_up:
            require_built_for_plans(settings)
            require_rules_of_plans(program)
        self.local = program.understood is not None and program.understood.local
        weights = dict.fromkeys(settings.constraints, 1)
        self._rules, _, self._relaxed = soft_rules(settings._replace(constraints=()), weights)
        self._settings = settings._replace(constraints=(), relaxed=self._relaxed)
        self._program = assemble(self._settings, lambda _: None, used_up)

    def broken_rules(self, problem: Problem, tree: Collection[int]) -> tuple[IntegrityConstraint, ...]:
        """Return the integrity constraints that a tree or plan breaks.

        ``tree`` has unit ids; for a plan, the id of a unit comes once per execution. Raises
        ``KeyboardInterrupt`` at a limit. Raises :class:`UserError` if a rule reads facts that the question
        lacks, or if rules that are no integrity constraints exclude the tree.
        """
        self._program.require_facts(problem, (Objective.UNITS,))
        clingo_run = (
            self._run_on_tree(problem, tree) if problem.items is None else self._run_on_plan(problem, tree)
        )
        if not clingo_run.exhausted:
            self._settings.effective_deadline.check()
            raise KeyboardInterrupt
        if clingo_run.units is None:
            raise UserError(
                "the rules that are added exclude every tree by more than rules that begin with :-, so it "
                "cannot be said which of them a tree breaks"
            )
        ways = clingo_run.atoms["_broken"]
        return tuple(rule for rule in self._rules if ways.get(rule.number))

    def _run_on_tree(self, problem: Problem, tree: Collection[int]) -> Run:
        """Run clingo on the facts of a tree, with constraints rewritten to count their broken instances.

        If some constraint is not local, the facts also have all other reachable units.
        """
        used = set(tree)
        units = sorted(used if self.local else used.union(reach(problem).units))
        objective_levels = levels((Objective.UNITS,))
        prepared = Prepared(
            problem,
            objective_levels,
            self._settings,
            self._settings.effective_deadline,
            self._program,
            tuple(units),
        )
        numbers = list(map(problem.network.unit_number, sorted(used)))
        return prepared.run(write_tree(numbers) + write_least_penalty(1), predicates=[("_broken", 2)])

    def _run_on_plan(self, problem: Problem, plan: Collection[int]) -> Run:
        """Run clingo on the facts of a plan, with constraints rewritten to count their broken instances."""
        counts, program = Counter(plan), self._program
        text = write_facts(problem, sorted(counts), Scales(problem, counts), program.looked_at)
        text += write_times({problem.network.unit_number(unit): (n, n) for unit, n in counts.items()})
        text += program.rules + write_least_penalty(1)
        with errors_at_sources(self._relaxed, text):
            return run(
                program.files,
                text,
                program.arguments,
                self._settings.effective_deadline,
                predicates=[("_broken", 2)],
                endless=program.endless,
            )
