"""The best tree under constraints that may be broken at a price: ``foon-asp solve --soft``."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from foon_asp.asp import Settings, Status
from foon_asp.asp.soft import Broken
from foon_asp.asp.soft import solve_soft as find
from foon_asp.dataset.paths import File, Files
from foon_asp.deadline import Cancel
from foon_asp.network import counted
from foon_asp.problem import Objective, Problem
from foon_asp.problem.progress import OnProgress
from foon_asp.questions.answer import Answer, WithOutcome
from foon_asp.questions.arguments import (
    Constants,
    Objectives,
    chosen_objectives,
    constraint_weights,
    settings,
    whole,
)
from foon_asp.questions.caller import caller
from foon_asp.questions.contract import described
from foon_asp.questions.in_hand import in_hand
from foon_asp.questions.options import LIMITS, OBJECTIVES, RULES, SOFT
from foon_asp.questions.result import Ending
from foon_asp.report.answer import headline, outcome_text
from foon_asp.report.integrity_constraint import constraint_json, constraint_lines
from foon_asp.rules.constraint import Constraint
from foon_asp.text.json_value import Json


@dataclass(frozen=True, repr=False)
class SoftAnswer(WithOutcome):
    """The answer under constraints that may be broken at a price.

    ``outcome`` is the best tree among those with the lowest ``penalty``, which is the sum of weight times
    ways over the ``constraints``: each tells in how many ways the tree breaks it. If there is no tree, the
    penalty is ``None`` and there are no constraints.

    Example:
        >>> ice = foon_asp.load().problem("ice")
        >>> crush = {"forbidden_motion": "crush"}
        >>> found = foon_asp.solve_soft(ice, soft={"forbid_motion": 3}, constants=crush)
        >>> [each.ways for each in found.constraints]
        [0]
    """

    outcome: Answer
    penalty: int | None
    constraints: tuple[Broken, ...]

    @property
    def ending(self) -> Ending:
        """Done when the tree is proved to be the best."""
        return self.outcome.ending

    def text(self) -> str:
        """Give the answer with what its tree breaks."""
        return outcome_text(self.outcome, self._lines(), caller().deadline)

    def _lines(self) -> Iterator[str]:
        """Say what the tree breaks and what that costs."""
        if self.penalty is None:
            return
        number = counted(len(self.constraints), "soft constraint")
        broken = [each for each in self.constraints if each.ways]
        if not broken:
            one = len(self.constraints) == 1
            yield f"penalty 0: {'the soft constraint holds' if one else f'all of {number} hold'}"
            return
        least = "the least there is" if self.outcome.status is Status.OPTIMAL else "not proved least"
        yield f"penalty {self.penalty}, {least}: {len(broken)} of {number} broken"
        for each in broken:
            times = "" if each.ways == 1 else f", {each.ways} times"
            yield from constraint_lines(each.constraint, f"    (weight {each.weight}{times})")

    def json_dict(self) -> Json:
        """Give the answer with the penalty, and every soft constraint."""
        constraints = [
            constraint_json(each.constraint) | {"weight": each.weight, "broken": each.ways}
            for each in self.constraints
        ]
        return self.outcome.json_dict() | {"penalty": self.penalty, "soft_constraints": constraints}

    def foon(self) -> str:
        """Give the tree as FOON text; empty where there is none."""
        return self.outcome.foon()

    def remark(self, format_: str) -> str:
        """Say what FOON text does not say: what is claimed, and what the tree breaks."""
        if format_ == "foon":
            return "\n".join([headline(self.outcome), *self._lines()])
        return ""


def softly_answered(
    problem: Problem, objectives: Sequence[Objective], how: Settings, weights: Mapping[Constraint, int]
) -> SoftAnswer:
    """Solve a problem under soft constraints with their weights."""
    who = caller()
    outcome, penalty, constraints = find(whole(problem), objectives, how, weights, who.reporter)
    if who.read_seconds is not None:
        outcome.seconds["read"] = who.read_seconds
    return SoftAnswer(Answer._make(outcome), penalty, constraints)


@described(OBJECTIVES, SOFT, *RULES, *LIMITS)
@in_hand(takes_time=True)
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
    on_progress: OnProgress | None = None,
    cancel: Cancel | None = None,
) -> SoftAnswer:
    """Find the best tree of those that pay least for the constraints they break.

    Returns:
        The answer, with the ``penalty`` paid and, for each of the ``constraints``, in how many ways it is
        broken.

    Raises:
        UserError: for a wrong argument, constraint or weight.

    Example:
        >>> ice = foon_asp.load().problem("ice")
        >>> forbidden = {"forbidden_motion": "crush"}
        >>> found = foon_asp.solve_soft(ice, soft={"forbid_motion": 3}, constants=forbidden)
        >>> found.penalty, found.outcome.costs.units
        (0, 3)
    """
    chosen = chosen_objectives(problem, objectives)
    how = settings(constraints, constants, encodings, time_limit, memory_limit)
    return softly_answered(problem, chosen, how, constraint_weights(soft))
