"""Check of an answer by stock clingo, in a separate process, on the text that ``foon-asp facts`` prints.

clingo reads constraints, soft files, constants and encodings unchanged. The problem is not reduced, and
nothing is reused from earlier questions. clingo searches with other options than ours and does not know our
answer. The answers are compared in exact numbers. The costs that clingo adds up have to be the costs of its
units. Its tree has to execute in our simulation, and our tree has to keep to the rules in clingo.

Objectives with fractions, such as ``success``, have rounded weights in the facts, so clingo's optimum may not
be the true one. Every tree at least as good as ours has a rounded weight up to a bound that is computed here
anew (docs/dev/certificates.md). clingo enumerates the trees up to this bound, and their costs are compared as
fractions.
"""

import contextlib
import json
import math
import re
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Collection, Iterable, Sequence
from decimal import Context, Decimal
from fractions import Fraction
from typing import Any, Final, NamedTuple

from foon_asp.asp.bare_program import BareProgram, bare_program
from foon_asp.encoding.fact_writer import write_exactly_alike, write_given, write_most_alike, write_same_rates
from foon_asp.encoding.own_encodings import question_encoding
from foon_asp.engines.engine import (
    ClaimedAnswer,
    DisagreementError,
    EngineAnswer,
    NotCheckedError,
    check_tree,
    difference_error,
)
from foon_asp.problem import Costs, Objective, levels, multiplies

BARE_CLINGO: Final = "clingo"
ENGINE_OPTIONS: Final = (
    "--opt-strategy=usc,pmres,disjoint,stratify",
)  # of the strategies tried, it ended most often
MAX_KINDS = 10_000  # of trees within the bound: more prove more answers, and take longer to enumerate
_EXIT_CODES: Final = {0, 10, 20, 30}  # without a fault: of the Python module, and of the program
_OUT_OF_MEMORY: Final = (b"bad_alloc", b"MemoryError", b"cannot allocate memory")
_STRING_OR_WEIGHT = re.compile(r'"(?:\\.|[^"\\])*"|(?<![\w\'])(?:risk\(|cost\((\w+),)(\d+),(\d+)\)')
_USED = re.compile(r"(?:use|times)\((\d+)(?:,(\d+))?\)")


def check_with_bare_clingo(claim: ClaimedAnswer, seconds: float) -> None:
    """Have bare clingo answer the question of a claim, and raise an exception unless it agrees.

    Raises :class:`DisagreementError` if the two answers contradict each other. Raises
    :class:`NotCheckedError` if clingo does not finish within ``seconds``, or if clingo's answer implies
    nothing about ours.
    """
    outcome = claim.outcome
    program = bare_program(outcome.problem, outcome.objectives, claim.settings, claim.soft)
    _Comparison(claim, program, Clingo(program, seconds, claim.settings.effective_deadline.memory)).check()


class ClingoAnswer(NamedTuple):
    """An answer of clingo.

    ``times``: how often each unit is used, by its public number.
    ``costs``: the costs as clingo adds them up, the most important first.
    """

    times: dict[int, int]
    costs: tuple[int, ...]


class Clingo:
    """Runs of clingo on one program.

    ``seconds``: the time limit of all runs together, which begins at construction.
    ``memory``: the memory limit of each run, in bytes. If it is ``None`` or above 4 GB, the limit is 4 GB.
    """

    def __init__(self, program: BareProgram, seconds: float, memory: int | None) -> None:
        self._program, self._seconds = program, seconds
        self._end = time.monotonic() + seconds
        max_memory = 4 * 2**30
        self._memory = max_memory if memory is None else min(memory, max_memory)

    def best_answer(self, extra_facts: str = "", with_second_opinion: bool = True) -> ClingoAnswer | None:
        """Return an optimal answer of the program. Return ``None`` if it has no answer.

        ``extra_facts``: facts that are added to the program. If there are any, ``second_opinion.lp``, which
        reads them, is added as well; ``with_second_opinion=False`` leaves this encoding out.

        Raises :class:`NotCheckedError` if clingo does not finish.
        """
        options = ("--opt-mode=opt", "--models=0", "--quiet=1")
        result, _, answers = self._run(extra_facts, options, bool(extra_facts) and with_second_opinion)
        if result == "UNSATISFIABLE":
            return None
        if result != "OPTIMUM FOUND" or not answers:
            raise NotCheckedError(f"clingo ended with {result!r}")
        return answers[-1]

    def answers_by_kind(self, extra_facts: str, bounds: Sequence[int]) -> list[ClingoAnswer]:
        """Return one answer of each kind, among the answers with costs up to ``bounds``.

        ``bounds``: the greatest costs, the most important first.
        ``extra_facts``: the facts ``_same_rate`` and ``_most_alike`` of ``second_opinion.lp``, which say
        which units have the same cost by the rounded objective.

        Two answers are of one kind if they have equally many units of each cost by the rounded objective.
        Raises :class:`NotCheckedError` if there are more than ``MAX_KINDS`` kinds, or clingo does not finish.
        """
        mode = ",".join(["--opt-mode=enum", *map(str, bounds)])
        options = (mode, f"--models={MAX_KINDS + 1}", "--project=project")
        result, exhausted, answers = self._run(extra_facts, options, True)
        if len(answers) > MAX_KINDS:
            raise NotCheckedError(
                f"more than {MAX_KINDS} kinds of trees are too close to the best by rounded costs"
            )
        if not exhausted:
            raise NotCheckedError(f"clingo ended with {result!r}")
        return answers

    def _run(
        self, extra_facts: str, options: Iterable[str], with_second_opinion: bool
    ) -> tuple[str, bool, list[ClingoAnswer]]:
        """Run clingo; return its result, whether the search was exhausted, and the answers it printed.

        The result is a text of clingo such as ``OPTIMUM FOUND``. ``options`` are words for clingo's command
        line. ``with_second_opinion`` adds ``second_opinion.lp`` to the program. The process of clingo is
        stopped in any case, also at ctrl-C, which is passed on. Raises :class:`NotCheckedError` if time or
        memory runs out, or clingo fails.
        """
        program, timeout_message = self._program, f"clingo did not finish within {self._seconds:g} s"
        second_opinion = (question_encoding("second_opinion.lp"),) if with_second_opinion else ()
        # absolute, since a name may begin with -; not resolved, since files include others in their folder
        files = [str(file.absolute()) for file in (*program.files, *second_opinion)]
        command = [sys.executable, "-P", "-m", "clingo", *files, "-", *program.constants, "--outf=2"]
        remaining = self._end - time.monotonic()
        if remaining <= 0:
            raise NotCheckedError(timeout_message)
        with subprocess.Popen(
            [*command, *ENGINE_OPTIONS, *options],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            start_new_session=True,  # ctrl-C is for us, who then stop the process
        ) as process:
            try:
                _limit_process(process.pid, remaining, self._memory)
                text = (program.text + extra_facts).encode("utf-8", "surrogatepass")
                out, err = process.communicate(text, remaining)
            except subprocess.TimeoutExpired:
                raise NotCheckedError(timeout_message) from None
            finally:
                process.kill()
                process.wait()  # at ctrl-C, Popen itself waits for a quarter of a second only
        output: dict[str, Any] = {}
        with contextlib.suppress(ValueError):
            output = json.loads(out.decode("utf-8", "replace"), strict=False)
        if process.returncode == 33 or any(message in err for message in _OUT_OF_MEMORY):
            raise NotCheckedError("clingo ran out of memory")
        if process.returncode not in _EXIT_CODES or output.get("Result", "UNKNOWN") == "UNKNOWN":
            lines = err.decode("utf-8", "replace").strip().split("\n")
            error = next((line for line in lines if ": error: " in line), lines[-1])
            raise NotCheckedError(f"clingo ended with the code {process.returncode}: {error}")
        witnesses = [
            witness for call in output["Call"] for witness in call.get("Witnesses", ()) if "Value" in witness
        ]
        return output["Result"], output["Models"]["More"] == "no", list(map(_read_witness, witnesses))


def _read_witness(witness: dict[str, Any]) -> ClingoAnswer:
    """Return the answer in a witness, which is one answer set in clingo's JSON.

    A unit with an atom ``use/1`` is used once. If there is also an atom ``times/2``, its number counts
    instead. Other atoms are ignored; files of users may show them. Without objectives, the costs are empty.
    """
    times: dict[int, int] = {}
    for used in filter(None, map(_USED.fullmatch, witness["Value"])):
        if used[2] or int(used[1]) not in times:  # plans show times(U,N) and use(U)
            times[int(used[1])] = int(used[2] or 1)
    return ClingoAnswer(times, tuple(witness.get("Costs", ())))


class _Comparison:
    """The comparison of our answer with clingo's.

    ``weights``: for each objective with fractions, the rounded costs of units by public number. They are read
    from the facts at construction.
    """

    def __init__(self, claim: ClaimedAnswer, program: BareProgram, clingo: Clingo) -> None:
        self.claim, self.clingo = claim, clingo
        self.outcome, self.problem = claim.outcome, claim.outcome.problem
        self.levels = levels(self.outcome.objectives)
        self.weights: dict[Objective, dict[int, int]] = {
            objective: {} for objective in self.levels if not objective.row.whole
        }
        by_term = {objective.row.term: weights for objective, weights in self.weights.items()}
        for term, number, weight in _STRING_OR_WEIGHT.findall(program.facts):
            if number and (name := term or "success") in by_term:
                by_term[name].setdefault(int(number), int(weight))

    def check(self) -> None:
        """Compare the answers, and raise an exception unless they agree.

        If neither side has a tree, they agree. If an encoding is replaced such that clingo adds up other
        costs, only these sums are compared. If one objective is rounded in the facts, kinds of trees are
        compared exactly. If several are rounded, nothing is checked, and :class:`NotCheckedError` is raised.
        Otherwise, the costs by all objectives are compared.

        Raises :class:`DisagreementError` or :class:`NotCheckedError`.
        """
        theirs = self.clingo.best_answer()
        costs = self.outcome.costs
        if theirs is None or costs is None:
            if theirs is not None or costs is not None:
                we_say, clingo_says = ("a", "no") if theirs is None else ("no", "a")
                raise self._disagreement(
                    f"we say {we_say} tree exists, clingo says {clingo_says} tree exists", theirs
                )
            return
        ours = self._check_our_tree(theirs)
        rounded = [objective for objective in self.weights if not self._has_exact_weights(objective)]
        if not (self._has_standard_costs(theirs) and self._has_standard_costs(ours)):
            self._require_same_sums(ours, theirs)
        elif len(rounded) > 1:
            raise NotCheckedError(f"{' and '.join(rounded)} are both rounded in the facts")
        elif rounded:
            self._compare_exactly(theirs, ours, costs, rounded[0])
        else:
            self._require_same_costs(theirs, self.levels)

    def _check_our_tree(self, theirs: ClingoAnswer) -> ClingoAnswer:
        """Have clingo add up the costs of our tree; return our tree as an answer of clingo with these costs.

        Raises :class:`DisagreementError` if our tree does not execute or breaks rules in clingo. Also raises
        it if the claimed costs or penalty are wrong. ``theirs`` is clingo's own answer; the errors contain
        it.
        """
        units = check_tree(self.problem, EngineAnswer("foon-asp", self.levels, self.outcome.units, True))
        if self.problem.costs(units) != self.outcome.costs:
            raise self._disagreement("the costs of our tree are not those of its units", theirs)
        ours = self.clingo.best_answer(write_given(list(map(self.problem.network.unit_number, units))))
        if ours is None:
            raise self._disagreement("clingo says that our tree breaks the rules", theirs)
        penalty = ours.costs[0] if self.claim.soft else None
        if penalty != self.claim.penalty:
            raise self._disagreement(
                f"we say our tree has the penalty {self.claim.penalty}, clingo says {penalty}", ours
            )
        return ours

    def _has_standard_costs(self, answer: ClingoAnswer) -> bool:
        """Return whether the costs in an answer of clingo are the sums of the costs of its units.

        A replaced encoding may add up other numbers. If no encoding is replaced, other numbers raise
        :class:`DisagreementError`. The penalty of soft constraints is not compared. If the answer does not
        execute, raises what :meth:`_executable_order` raises.
        """
        costs = self.problem.costs(self._executable_order(answer))
        figures = [
            sum(self.weights[objective].get(number, 0) for number in answer.times)
            if objective in self.weights
            else costs.measure(objective)
            for objective in self.levels
        ]
        added_up = list(answer.costs[bool(self.claim.soft) :])
        if added_up != figures and self.claim.settings.replaced is None:
            raise self._disagreement(f"clingo adds up the costs {added_up}, its units cost {figures}", answer)
        return added_up == figures

    def _require_same_sums(self, ours: ClingoAnswer, theirs: ClingoAnswer) -> None:
        """Raise :class:`DisagreementError` if clingo adds up different costs for our tree and for its own.

        This comparison is for replaced encodings, whose sums may differ from our costs. Raises
        :class:`NotCheckedError` if an objective has fractions.
        """
        if self.weights:
            names = " and ".join(self.weights)
            raise NotCheckedError(f"the replaced encodings do not measure {names} as it is measured here")
        if ours.costs != theirs.costs:
            raise self._disagreement(
                f"as the encodings have it our tree costs {list(ours.costs)}, "
                f"the one of clingo {list(theirs.costs)}",
                theirs,
            )

    def _require_same_costs(self, answer: ClingoAnswer, objectives: Iterable[Objective]) -> None:
        """Raise :class:`DisagreementError` if an answer and our tree differ in penalty or in an objective.

        The costs by the given ``objectives`` are computed anew from the units of the answer. Penalties are
        compared only if there are soft constraints.
        """
        compared = self._engine_answer(answer)
        if self.claim.soft and self.claim.penalty != answer.costs[0]:
            raise difference_error("penalty", self.claim.penalty or 0, answer.costs[0], compared)
        assert self.outcome.costs is not None
        costs = self.problem.costs(compared.units or ())
        for objective in objectives:
            ours, theirs = self.outcome.costs.measure(objective), costs.measure(objective)
            if ours != theirs:
                raise difference_error(str(objective), ours, theirs, compared, multiplies(objective))

    def _has_exact_weights(self, objective: Objective) -> bool:
        """Return whether the weights for an objective are exact: the costs of units times one factor.

        Where rates multiply, weights are exact only if all rates are 1.
        """
        weights = self.weights[objective]
        pairs = set(zip(self._unit_costs(weights, objective), weights.values(), strict=True))
        if multiplies(objective):
            return all(figure == 1 for figure, _ in pairs)
        ratios = {weight / figure for figure, weight in pairs if figure}
        return len(ratios) <= 1 and all(figure or not weight for figure, weight in pairs)

    def _unit_costs(self, numbers: Iterable[int], objective: Objective) -> list[Fraction]:
        """Return for each public number the cost of the unit by an objective; for ``success``, its rate."""
        return [Fraction(self.problem.figure(objective, unit)) for unit in map(self._unit_id, numbers)]

    def _compare_exactly(
        self, theirs: ClingoAnswer, ours: ClingoAnswer, costs: Costs, rounded: Objective
    ) -> None:
        """Check that our tree is optimal although clingo knows only rounded weights of one objective.

        ``theirs``, ``ours``: clingo's tree and our tree, as answers of clingo.
        ``costs``: the exact costs of our tree.
        ``rounded``: the objective whose weights are rounded in the facts.

        Trees with equally many units of each cost by this objective are of one kind. clingo enumerates the
        kinds up to a bound on their weight. Their costs are compared with ours as fractions. Among the kinds
        that are as good as our tree, clingo minimizes the less important objectives.

        Raises :class:`DisagreementError` or :class:`NotCheckedError` unless the answers agree.
        """
        index = self.levels.index(rounded)
        more_important, from_rounded = self.levels[:index], self.levels[index:]
        weights = self.weights[rounded]
        self._require_same_costs(theirs, more_important)
        # theirs is the best by weights: is it better than ours in exact numbers?
        if self._cost_key(theirs, self.levels) < costs.key(self.levels):
            self._require_same_costs(theirs, self.levels)
        our_figures = self._unit_costs(ours.times, rounded)
        classes: dict[Fraction, list[int]] = {}
        for number, figure in zip(weights, self._unit_costs(weights, rounded), strict=True):
            classes.setdefault(figure, []).append(number)
        pairs = {(figure, weights[number]) for figure, numbers in classes.items() for number in numbers}
        max_weight = tree_weight_bound(pairs, our_figures, multiplies(rounded))
        classes.pop(Fraction(int(multiplies(rounded))), None)  # units without a cost do not change the sum
        least_weights = [min(map(weights.__getitem__, numbers)) for numbers in classes.values()]
        max_counts = [
            min(len(numbers), max_weight // least_weight) if least_weight else len(numbers)
            for numbers, least_weight in zip(classes.values(), least_weights, strict=True)
        ]
        class_facts = write_same_rates(list(classes.values()))
        bounds = [*ours.costs[: index + bool(self.claim.soft)], max_weight]
        equal_kinds: list[list[int]] = []
        for answer in self.clingo.answers_by_kind(class_facts + write_most_alike(max_counts), bounds):
            if not self._has_standard_costs(answer):
                raise NotCheckedError("the replaced encodings measure some trees in another way")
            self._require_same_costs(answer, more_important)
            if self._cost_key(answer, (rounded,)) < costs.key([rounded]):
                self._require_same_costs(answer, [rounded])
            elif self._cost_key(answer, (rounded,)) == costs.key([rounded]):
                equal_kinds.append(_count_each(classes, self._unit_costs(answer.times, rounded)))
        if _count_each(classes, our_figures) not in equal_kinds:  # our tree is within the bound itself
            raise self._disagreement("our tree is not among those that clingo finds within the bound", theirs)
        if len(from_rounded) == 1:
            return
        candidates: list[ClingoAnswer] = []
        for counts in equal_kinds:
            candidate = self.clingo.best_answer(class_facts + write_exactly_alike(counts))
            if candidate is None:
                raise NotCheckedError("clingo loses a kind of tree that it found")
            self._executable_order(candidate)
            candidates.append(candidate)
        self._require_same_costs(
            min(candidates, key=lambda answer: self._cost_key(answer, from_rounded)), self.levels
        )

    def _executable_order(self, answer: ClingoAnswer) -> tuple[int, ...]:
        """Return the ids of the units of an answer in an executable order.

        If there is no such order, raises :class:`DisagreementError` or, with replaced encodings,
        :class:`NotCheckedError`.
        """
        try:
            return check_tree(self.problem, self._engine_answer(answer))
        except DisagreementError as error:
            if self.claim.settings.replaced is None:
                raise
            raise NotCheckedError(f"{error}, as the replaced encodings allow") from None

    def _cost_key(
        self, answer: ClingoAnswer, objectives: tuple[Objective, ...]
    ) -> tuple[int | Fraction, ...]:
        """Return the costs of an answer by these objectives, as a key that is smaller for better trees."""
        return self.problem.costs(map(self._unit_id, answer.times)).key(objectives)

    def _unit_id(self, number: int) -> int:
        """Return the id of the unit with a public number.

        Raises :class:`DisagreementError` if there is no such unit, since clingo then uses an unknown unit.
        """
        unit = self.problem.network.unit_of_number(number)
        if unit is None:
            raise self._disagreement(f"clingo uses a unit number {number}, which there is not", None)
        return unit

    def _engine_answer(self, answer: ClingoAnswer | None) -> EngineAnswer:
        """Return an answer of clingo as that of an engine; it has no tree if ``answer`` is ``None``.

        Each used unit is listed once, by ascending public number.
        """
        units = None if answer is None else tuple(map(self._unit_id, sorted(answer.times)))
        return EngineAnswer(BARE_CLINGO, self.levels, units, True)

    def _disagreement(self, message: str, answer: ClingoAnswer | None) -> DisagreementError:
        """Return the error with this message and clingo's answer, which is ``None`` if it has no tree."""
        return DisagreementError(message, self._engine_answer(answer))


def _count_each(classes: Iterable[Fraction], figures: Iterable[Fraction]) -> list[int]:
    """Return for each of the ``classes``, which are distinct costs, how many of the ``figures`` equal it."""
    counted = Counter(figures)
    return [counted[figure] for figure in classes]


def tree_weight_bound(
    weights: Collection[tuple[Fraction, int]], our_costs: Collection[Fraction], multiplies: bool = True
) -> int:
    """Return an upper bound on the sum of weights of trees that are at least as good as ours.

    ``weights``: the distinct pairs of a unit's cost and its weight, which may be rounded in any way.
    ``our_costs``: the costs of our units.
    ``multiplies``: whether the costs are rates, which multiply.

    Let w be the weight of a unit. Let L be its cost or, for a rate p, -ln p. Let S be the maximum of w / L
    over all units with L > 0. Then w <= S * L for every unit. So the weights of a tree add up to at most S
    times the sum of L over its units. For a tree as good as ours, this sum is at most that of our tree.

    Raises :class:`NotCheckedError` for a unit that has a weight but no cost, since no such S exists then.
    Also raises it for a rate of 0, which has no logarithm.
    """
    all_costs = {*our_costs, *(cost for cost, _ in weights)}
    bounds = {cost: _minus_log_interval(cost) if multiplies else (cost, cost) for cost in all_costs}
    if any(weight and bounds[cost][0] <= 0 for cost, weight in weights):
        raise NotCheckedError("a unit that costs nothing has a weight")
    ratios = (weight / bounds[cost][0] for cost, weight in weights if bounds[cost][0])
    return math.floor(max(ratios, default=Fraction(0)) * sum(bounds[cost][1] for cost in our_costs))


def _minus_log_interval(rate: Fraction) -> tuple[Fraction, Fraction]:
    """Return the ends of an interval that contains -ln of a rate; both are above 0 if the rate is below 1.

    Raises :class:`NotCheckedError` for a rate of 0.
    """
    if rate <= 0:
        raise NotCheckedError("a success rate of 0 has no logarithm")
    failure = 1 - rate
    if failure < Fraction(1, 10**40):  # x <= -ln(1 - x) <= x / (1 - x), which are almost equal for small x
        return failure, failure / rate
    context = Context(prec=100)  # digits, of which at most 50 cancel in the difference of two logarithms

    def logarithm_interval(number: int) -> tuple[Fraction, Fraction]:
        """Return the ends of an interval that contains the logarithm of an integer; both are 0 for 1."""
        logarithm = context.ln(Decimal(number))  # correctly rounded: the exact one is between its neighbours
        if not logarithm:
            return Fraction(0), Fraction(0)
        return Fraction(context.next_minus(logarithm)), Fraction(context.next_plus(logarithm))

    numerator_low, numerator_high = logarithm_interval(rate.numerator)
    denominator_low, denominator_high = logarithm_interval(rate.denominator)
    return denominator_low - numerator_high, denominator_high - numerator_low


def _limit_process(process: int, seconds: float, memory: int) -> None:
    """Limit the memory (in bytes) and the processor time of the process with this id.

    The limit of processor time is ``seconds``, rounded up, plus 1. Such limits stop a grounding that does not
    end. If the system knows no such limits, or the process has ended, nothing happens.
    """
    with contextlib.suppress(ImportError, AttributeError, OSError, ValueError):
        import resource  # noqa: PLC0415 (not everywhere)

        resource.prlimit(process, resource.RLIMIT_AS, (memory, memory))
        cpu_seconds = math.ceil(seconds) + 1
        resource.prlimit(process, resource.RLIMIT_CPU, (cpu_seconds, cpu_seconds))
