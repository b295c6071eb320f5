"""The best tree under rules that may ask for units of a large store that lead to no goal.

The units read of any tree of the whole network are a tree of the relaxed question of
:class:`~foon_asp.dataset.nearby.Nearby`, where no rules are added: so they cost no less than the best one
there. By objectives that only units add to, a unit that was not read makes that no cheaper, and counts as one
unit more. So a tree that has one is no better than the best one without rules would be with one unit more;
and the trees without one are those of what was read, of which rules that look at a tree alone say the same.

By ``success``, a unit more makes a tree worse. Where rules do no more than to ask for a unit with some
motion, either that unit is from elsewhere, and its rate is that of the motion; or the units read keep to the
rules, and so cost no less than the best tree of the relaxed question under them.
"""

from collections.abc import Sequence
from fractions import Fraction

from foon_asp.asp import Outcome, Proof, Reporter, Settings, Status
from foon_asp.asp.assembly import ReachOfRules, asked_for, assemble, motions_asked_for, reach_of_rules
from foon_asp.asp.optimum import solve
from foon_asp.dataset.nearby import Nearby
from foon_asp.dataset.nearby_optimum import least_with_one_more, near_goals, solve_nearby
from foon_asp.deadline import LimitError
from foon_asp.problem import Objective, Problem, levels

_READ = 7  # times in which a tree is looked for that is good enough, each among twice as many units


def solve_nearby_under(
    problem: Problem, objectives: Sequence[Objective], how: Settings, reporter: Reporter
) -> Outcome | None:
    """Solve a question to a large store under rules, as far as what is near the goals tells.

    The best tree of what was read is the best of all if no tree with a further unit can be better. Else it is
    given as one of which that is not known; only at a limit, ``stopped`` says so. ``None`` where there is
    none, or nothing was asked.
    """
    if not how.constraints or reach_of_rules(how) is ReachOfRules.ALL:
        return None
    plain = how._replace(constraints=(), constants=(), session=None)
    near = near_goals(problem, objectives, plain)
    free = None if near is None else solve_nearby(near, objectives, plain)
    if near is None or free is None or (free.units is None and not free.stopped):
        return None
    found = _with_rules(near, free, how._replace(session=None), reporter)
    return None if found.units is None and not found.stopped else found


def _with_rules(near: Nearby, free: Outcome, how: Settings, reporter: Reporter) -> Outcome:
    """Look for a tree that is proved to be the best, where ``free`` is the best without rules.

    Without a tree, its status is unknown.
    """
    order = levels(free.objectives)
    bounds = {each: bound for each, bound in free.bounds.items() if each == order[0]}
    best = free._replace(status=Status.UNKNOWN, units=None, costs=None, proof=None, bounds=bounds)
    best = best._replace(cuts=(), cases=None)
    if free.status is not Status.OPTIMAL or free.costs is None:
        return best
    rate = _rate_asked_for(near.problem, how) if Objective.SUCCESS in order else None
    for asked_before in range(_READ):
        try:
            with how.begun.watched("reading"):
                if asked_before:
                    near.double()
                else:
                    near.add_ready(asked_for(how))
                here = near.problem
        except LimitError as limit:
            return best._replace(stopped=limit.stopped)
        found = solve(here, free.objectives, how)._replace(cuts=(), cases=None)
        proved = _proved(found, free, near, how, rate)
        if proved is not None and found.costs is not None:
            assemble(how, reporter.warning)
            reporter.tree(found.costs)
            return found._replace(proof=proved)
        if found.units is not None:
            best = found._replace(status=Status.FEASIBLE, proof=None, bounds=bounds)
        if found.stopped:
            return best._replace(stopped=found.stopped)
    return best


def _proved(
    found: Outcome, free: Outcome, near: Nearby, how: Settings, rate: Fraction | None
) -> Proof | None:
    """Say by what the best tree near the goals is the best of all, if it is known to be.

    ``rate`` is the greatest success rate of a unit that rules ask for, where that is known.
    """
    order = levels(free.objectives)
    if found.status is not Status.OPTIMAL or found.costs is None or free.costs is None:
        return None
    key, proofs = found.costs.key(order), [free.proof, found.proof]
    if key > least_with_one_more(free.costs, order):
        if rate is None or key > least_with_one_more(free.costs, order, rate):
            return None
        # what a rule asks for is a unit from elsewhere, or what was read of the tree keeps to the rules
        relaxed = solve(near.relaxed, free.objectives, how)
        if relaxed.status is not Status.OPTIMAL or relaxed.costs is None or key > relaxed.costs.key(order):
            return None
        proofs.append(relaxed.proof)
    return next((proof for proof in proofs if proof is not Proof.CUTS), Proof.CUTS)


def _rate_asked_for(problem: Problem, how: Settings) -> Fraction | None:
    """Give the greatest success rate, above 0, of a unit that rules ask for, or ``None``."""
    asked, rates = motions_asked_for(how), problem.rates
    if not asked or rates is None:
        return None
    each = (
        max([rates.get(motion, Fraction(1)) for motion in motions], default=Fraction(1)) for motions in asked
    )
    return max(each) or None
