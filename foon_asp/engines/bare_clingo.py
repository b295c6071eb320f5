"""The same question put to stock clingo: a process of its own, on the text that ``foon-asp facts`` prints.

Whatever the constraints, soft files, constants and encodings are, it reads them as they stand. Nothing is
reduced before it, kept from a question before it, or known to it of our answer while it looks for its own; it
searches in another way than ours, too. What it says is compared with our answer here, in exact numbers: the
costs it adds up against those of its units, its tree against the simulation, our tree against its rules.

By ``success`` and others that are fractions clingo goes by rounded weights, which are no answer yet. Every
tree that is at least as good as ours has a rounded weight within a bound that is worked out here anew; see
docs/proofs.md. clingo gives the trees within it: rates are multiplied, or costs added up, as fractions.
"""

import contextlib
import json
import math
import re
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from decimal import Context, Decimal
from fractions import Fraction
from pathlib import Path
from typing import Any, NamedTuple

from foon_asp.asp import Status
from foon_asp.asp.bare_program import BareProgram, bare_program
from foon_asp.encoding.facts import write_exactly_alike, write_given, write_most_alike, write_same_rates
from foon_asp.encoding.own_encodings import question_encoding
from foon_asp.engines.engine import (
    Asked,
    DisagreementError,
    EngineAnswer,
    NotCheckedError,
    check_tree,
    differing,
)
from foon_asp.problem import Objective, levels, multiplies

NAME = "clingo"
OPTIONS = ("--opt-strategy=usc,pmres,disjoint,stratify",)  # ended most often of those tried, ours apart
MOST_KINDS = 10_000  # of trees within the bound
_MEMORY = 4 * 2**30  # bytes, where no memory limit says otherwise
_ENDED = {0, 10, 20, 30}  # the program and the Python module end otherwise where there was no fault
_OUT_OF_MEMORY = (b"bad_alloc", b"MemoryError", b"cannot allocate memory")
_BEST = ("--opt-mode=opt", "--models=0", "--quiet=1")
_SECOND_OPINION = "second_opinion.lp"
_STRING_OR_WEIGHT = re.compile(r'"(?:\\.|[^"\\])*"|(?<![\w\'])(?:risk\(|cost\((\w+),)(\d+),(\d+)\)')
_SHOWN = re.compile(r"use\((\d+)\)")


def check_with_bare_clingo(asked: Asked, seconds: float) -> None:
    """Hold an answer against clingo's own.

    Raises :class:`DisagreementError` where both cannot be right, and :class:`NotCheckedError` where clingo
    did not finish within ``seconds``.
    """
    outcome = asked.outcome
    program = bare_program(outcome.problem, outcome.objectives, asked.settings, asked.soft)
    _Check(asked, program, Clingo(program, seconds, asked.settings.begun.memory)).check()


def printed_command(asked: Asked) -> tuple[list[str], str]:
    """Give the command that asks bare clingo the question, and the text of its ``facts.lp``."""
    outcome = asked.outcome
    program = bare_program(outcome.problem, outcome.objectives, asked.settings, asked.soft)
    files = [*map(str, program.files), "facts.lp"]
    return ["python", "-m", "clingo", *files, *program.constants, *OPTIONS], program.text


class Found(NamedTuple):
    """An answer of clingo: the numbers of the units used, and the costs as clingo adds them up."""

    units: frozenset[int]
    costs: tuple[int, ...]


class Clingo:
    """Runs clingo, time after time until the end."""

    def __init__(self, program: BareProgram, seconds: float, memory: int | None) -> None:
        self.program, self.seconds = program, seconds
        self.end = time.monotonic() + seconds
        self.memory = _MEMORY if memory is None else min(memory, _MEMORY)

    def best(self, more: str = "") -> Found | None:
        """Give an optimal answer, ``more`` text being read beside the facts; ``None`` where there is none."""
        found = self._run(more, _BEST, _added(more))
        answers = _answers(found)
        if found["Result"] == "UNSATISFIABLE":
            return None
        if found["Result"] != "OPTIMUM FOUND" or not answers:
            raise NotCheckedError(f"clingo ended with {found['Result']!r}")
        return answers[-1]

    def run(self, more: str) -> dict[str, Any]:
        """Give what clingo says of the optimal answers, ``more`` facts being read beside the others."""
        return self._run(more, _BEST, ())

    def all_kinds(self, more: str, bounds: Sequence[int]) -> list[Found]:
        """Give an answer of every kind that costs at most so much."""
        mode = ",".join(["--opt-mode=enum", *map(str, bounds)])
        found = self._run(more, (mode, f"--models={MOST_KINDS + 1}", "--project=project"), _added(more))
        answers = _answers(found)
        if len(answers) > MOST_KINDS:
            raise NotCheckedError(
                f"more than {MOST_KINDS} kinds of trees are too close to the best by rounded costs"
            )
        if found["Models"]["More"] != "no":
            raise NotCheckedError(f"clingo ended with {found['Result']!r}")
        return answers

    def _run(self, more: str, options: Iterable[str], added: tuple[Path, ...]) -> dict[str, Any]:
        program = self.program
        # absolute, since a name may begin with -; not resolved, since files include others beside them
        files = [str(file.absolute()) for file in (*program.files, *added)]
        command = [sys.executable, "-P", "-m", "clingo", *files, "-", *program.constants, "--outf=2"]
        text = (program.text + more).encode("utf-8", "surrogatepass")
        left = self.end - time.monotonic()
        if left <= 0:
            raise self._late()
        with subprocess.Popen(
            [*command, *OPTIONS, *options],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            start_new_session=True,  # ctrl-C is for us, who then stop the process
        ) as process:
            try:
                _limit(process.pid, left, self.memory)
                out, err = process.communicate(text, left)
            except subprocess.TimeoutExpired:
                raise self._late() from None
            finally:
                process.kill()
        try:
            found: dict[str, Any] = json.loads(out.decode("utf-8", "replace"), strict=False)
        except ValueError:
            found = {}
        if process.returncode == 33 or any(words in err for words in _OUT_OF_MEMORY):
            raise NotCheckedError("clingo ran out of memory")
        if process.returncode not in _ENDED or found.get("Result", "UNKNOWN") == "UNKNOWN":
            said = err.decode("utf-8", "replace").strip().split("\n")
            error = next((line for line in said if ": error: " in line), said[-1])
            raise NotCheckedError(f"clingo ended with the code {process.returncode}: {error}")
        return found

    def _late(self) -> NotCheckedError:
        return NotCheckedError(f"clingo did not finish within {self.seconds:g} s")


class _Check:
    """One answer, compared with clingo's."""

    def __init__(self, asked: Asked, program: BareProgram, clingo: Clingo) -> None:
        self.asked, self.program, self.clingo = asked, program, clingo
        self.outcome, self.problem = asked.outcome, asked.outcome.problem
        self.levels = levels(self.outcome.objectives)
        self.weights: dict[Objective, dict[int, int]] = {
            objective: {} for objective in self.levels if not objective.row.whole
        }
        by_term = {objective.row.term: weights for objective, weights in self.weights.items()}
        for term, number, weight in _STRING_OR_WEIGHT.findall(program.facts):
            if number and (name := term or "success") in by_term:
                by_term[name].setdefault(int(number), int(weight))

    def check(self) -> None:
        outcome = self.outcome
        theirs = self.clingo.best()
        if theirs is None:
            if outcome.status is not Status.INFEASIBLE:
                raise self._disagreement("we say a tree exists, clingo says no tree exists", None)
            return
        if outcome.status is Status.INFEASIBLE or outcome.units is None:
            raise self._disagreement("we say no tree exists, clingo says a tree exists", theirs)
        ours = self._ours(theirs)
        usual = self._usual(theirs) and self._usual(ours)
        if not usual:
            self._by_replaced_objectives(ours, theirs)
        elif rounded := [objective for objective in self.weights if not self._is_to_scale(objective)]:
            if len(rounded) > 1:
                raise NotCheckedError(f"{' and '.join(rounded)} are both rounded in the facts")
            self._by_rounded(theirs, rounded[0])
        else:
            self._compare(theirs, self.levels)

    def _ours(self, theirs: Found) -> Found:
        """Ask clingo whether our tree is one under the rules, and what it costs.

        ``theirs`` is shown beside it where it is none.
        """
        assert self.outcome.units is not None
        network = self.problem.network
        units = check_tree(self.problem, EngineAnswer("foon-asp", self.levels, self.outcome.units, True))
        if self.problem.costs(units) != self.outcome.costs:
            raise self._disagreement("the costs of our tree are not those of its units", theirs)
        given = self.clingo.best(write_given([network.unit_number(unit) for unit in self.outcome.units]))
        if given is None:
            raise self._disagreement("clingo says that our tree breaks the rules", theirs)
        penalty = given.costs[0] if self.asked.soft else None
        if penalty != self.asked.penalty:
            raise self._disagreement(
                f"we say our tree has the penalty {self.asked.penalty}, clingo says {penalty}", given
            )
        return given

    def _usual(self, found: Found) -> bool:
        """Whether the costs that clingo adds up are those of the units, which replaced encodings may change.

        The penalty is for clingo alone to know.
        """
        costs = self.problem.costs(self._tree(found))
        figures = [
            self._weight(objective, found.units) if objective in self.weights else costs.measure(objective)
            for objective in self.levels
        ]
        said = list(found.costs[1:] if self.asked.soft else found.costs)
        if said == figures:
            return True
        if self.asked.settings.replaced is None:
            raise self._disagreement(f"clingo adds up the costs {said}, its units cost {figures}", found)
        return False

    def _by_replaced_objectives(self, ours: Found, theirs: Found) -> None:
        if self.weights:
            names = " and ".join(self.weights)
            raise NotCheckedError(f"the replaced encodings do not measure {names} as it is measured here")
        if ours.costs != theirs.costs:
            raise self._disagreement(
                f"as the encodings have it our tree costs {list(ours.costs)}, "
                f"the one of clingo {list(theirs.costs)}",
                theirs,
            )

    def _compare(self, found: Found, objectives: Sequence[Objective]) -> None:
        """Hold the penalty and some objectives against ours; raise where one is not the same."""
        assert self.outcome.costs is not None
        costs = self.problem.costs(self._answer(found).units or ())
        rows: list[tuple[str, bool, int | Fraction, int | Fraction]] = [
            (str(by), multiplies(by), self.outcome.costs.measure(by), costs.measure(by)) for by in objectives
        ]
        if self.asked.soft:
            rows.insert(0, ("penalty", False, self.asked.penalty or 0, found.costs[0]))
        for name, more_is_better, ours, theirs in rows:
            if ours != theirs:
                better = theirs > ours if more_is_better else theirs < ours
                raise differing(name, ours, theirs, better, self._answer(found))

    def _weight(self, objective: Objective, numbers: Iterable[int]) -> int:
        return sum(self.weights[objective].get(number, 0) for number in numbers)

    def _is_to_scale(self, objective: Objective) -> bool:
        """Whether weights compare as what units cost: none is rounded."""
        figures, weights = self._figures(objective), self.weights[objective]
        if multiplies(objective):
            return all(figure == 1 for figure in figures.values())
        ratios = {weight / figures[n] for n, weight in weights.items() if figures[n]}
        return len(ratios) <= 1 and all(figures[n] or not weight for n, weight in weights.items())

    def _figures(self, objective: Objective) -> dict[int, Fraction]:
        """Give what each unit costs by an objective, by number."""
        problem = self.problem
        return {n: Fraction(problem.figure(objective, self._unit(n))) for n in self.weights[objective]}

    def _by_rounded(self, theirs: Found, by: Objective) -> None:
        """Compare an objective exactly, with what counts more before it and what counts less after it."""
        outcome, problem = self.outcome, self.problem
        assert outcome.units is not None
        assert outcome.costs is not None
        place = self.levels.index(by)
        before, weights = self.levels[:place], self.weights[by]
        self._compare(theirs, before)
        if self._key(theirs, self.levels) < outcome.costs.key(self.levels):
            self._compare(theirs, self.levels)  # best by weights, and better than ours in truth
        figures = self._figures(by)
        own = [Fraction(problem.figure(by, unit)) for unit in outcome.units]
        greatest = greatest_weight if multiplies(by) else greatest_sum
        most = greatest({(figures[number], weight) for number, weight in weights.items()}, own)
        nothing = int(multiplies(by))  # of which as many as there are change nothing
        different = sorted({figure for figure in figures.values() if figure != nothing})
        classes = [[number for number in figures if figures[number] == figure] for figure in different]
        lightest = [min(weights[number] for number in numbers) for numbers in classes]
        alike = [
            min(len(numbers), most // light) if light else len(numbers)
            for numbers, light in zip(classes, lightest, strict=True)
        ]
        same = write_same_rates(classes)
        fixed = [
            self._weight(objective, map(problem.network.unit_number, outcome.units))
            if objective in self.weights
            else int(outcome.costs.measure(objective))
            for objective in before
        ]
        if self.asked.soft:
            fixed.insert(0, self.asked.penalty or 0)
        kinds = self.clingo.all_kinds(same + write_most_alike(alike), [*fixed, most])
        equal: list[list[int]] = []
        for found in kinds:
            units = self._tree(found)
            if not self._usual(found):
                raise NotCheckedError("the replaced encodings measure some trees in another way")
            self._compare(found, before)
            key = problem.costs(units).key([by])
            if key < outcome.costs.key([by]):
                self._compare(found, [by])
            elif key == outcome.costs.key([by]):
                counted = Counter(Fraction(problem.figure(by, unit)) for unit in units)
                equal.append([counted[figure] for figure in different])
        counted = Counter(own)
        if [counted[figure] for figure in different] not in equal:  # it is within the bound itself
            raise self._disagreement("our tree is not among those that clingo finds within the bound", theirs)
        if before == self.levels[:-1]:
            return
        best: Found | None = None
        for numbers in equal:
            found_best = self.clingo.best(same + write_exactly_alike(numbers))
            if found_best is None:
                raise NotCheckedError("clingo loses a kind of tree that it found")
            self._tree(found_best)
            after = self.levels[place:]
            if best is None or self._key(found_best, after) < self._key(best, after):
                best = found_best
        if best is not None:
            self._compare(best, self.levels)

    def _tree(self, found: Found) -> tuple[int, ...]:
        """Give the units of an answer in an order that executes."""
        try:
            return check_tree(self.problem, self._answer(found))
        except DisagreementError as error:
            if self.asked.settings.replaced is None:
                raise
            raise NotCheckedError(f"{error}, as the replaced encodings allow") from None

    def _key(self, found: Found, objectives: tuple[Objective, ...]) -> tuple[int | Fraction, ...]:
        return self.problem.costs(map(self._unit, found.units)).key(objectives)

    def _unit(self, number: int) -> int:
        unit = self.problem.network.unit_of_number(number)
        if unit is None:
            raise self._disagreement(f"clingo uses a unit number {number}, which there is not", None)
        return unit

    def _answer(self, found: Found | None) -> EngineAnswer:
        units = None if found is None else tuple(map(self._unit, sorted(found.units)))
        return EngineAnswer(NAME, self.levels, units, True)

    def _disagreement(self, message: str, found: Found | None) -> DisagreementError:
        return DisagreementError(message, self._answer(found))


def greatest_weight(weights: Iterable[tuple[Fraction, int]], own: Iterable[Fraction]) -> int:
    """Give the greatest sum of weights that a tree can have whose product of rates is at least that of ours.

    ``weights`` are the different pairs of a rate and the weight of a unit that has it; ``own`` are the rates
    of our tree. Nothing is taken for granted of how the weights were rounded. Write L(p) = -ln p, and let S
    be the greatest w / L(p) over all units of rates below 1. Then w <= S * L(p) for every unit, so the sum of
    the weights of any tree T is at most S * L(T), where L(T) is the sum of its logarithms; and L(T) is no
    greater than that of our tree. Raises :class:`NotCheckedError` for a unit of rate 1 with a weight, where
    there is no such S, and for rates that have no logarithm.
    """
    weights, own = set(weights), list(own)
    if any(rate <= 0 for rate in (*(rate for rate, _ in weights), *own)):
        raise NotCheckedError("a success rate of 0 has no logarithm")
    if any(rate >= 1 and weight for rate, weight in weights):
        raise NotCheckedError("a unit that never fails has a weight")
    bounds = {rate: _minus_log(rate) for rate in {*own, *(rate for rate, _ in weights)}}
    greatest = max((weight / bounds[rate][0] for rate, weight in weights if rate < 1), default=Fraction(0))
    return math.floor(greatest * sum(bounds[rate][1] for rate in own))


def greatest_sum(weights: Iterable[tuple[Fraction, int]], own: Iterable[Fraction]) -> int:
    """Give the greatest sum of weights of a tree that costs no more than ours, where costs add up.

    As :func:`greatest_weight`, with what units cost in place of logarithms. Raises :class:`NotCheckedError`
    for a unit that costs nothing and has a weight.
    """
    weights = set(weights)
    if any(not cost and weight for cost, weight in weights):
        raise NotCheckedError("a unit that costs nothing has a weight")
    greatest = max((weight / cost for cost, weight in weights if cost), default=Fraction(0))
    return math.floor(greatest * sum(own))


def _minus_log(rate: Fraction) -> tuple[Fraction, Fraction]:
    """Enclose -ln of a rate between two fractions, both above 0 where the rate is below 1."""
    lost = 1 - rate
    if lost < Fraction(1, 10**40):  # lost <= -ln(1 - lost) <= lost / (1 - lost), next to 1 all but the same
        return lost, lost / rate
    context = Context(prec=100)  # of which no more than 50 are lost in the difference of two logarithms

    def enclosed(number: int) -> tuple[Fraction, Fraction]:
        if number == 1:
            return Fraction(0), Fraction(0)
        logarithm = context.ln(Decimal(number))  # correctly rounded: the true one is between its neighbours
        return Fraction(context.next_minus(logarithm)), Fraction(context.next_plus(logarithm))

    (low, high), (lower, higher) = enclosed(rate.numerator), enclosed(rate.denominator)
    return lower - high, higher - low


def _added(more: str) -> tuple[Path, ...]:
    return (question_encoding(_SECOND_OPINION),) if more else ()


def _answers(found: Mapping[str, Any]) -> list[Found]:
    """Take the answers out of clingo's JSON; what else the user's files show is passed over."""
    return [
        Found(
            frozenset(int(match[1]) for shown in witness["Value"] if (match := _SHOWN.fullmatch(shown))),
            tuple(witness.get("Costs", ())),
        )
        for call in found["Call"]
        for witness in call.get("Witnesses", ())
        if "Value" in witness
    ]


def _limit(process: int, seconds: float, memory: int) -> None:
    """Keep endless grounding from taking all memory, and from outliving us, where the system can."""
    with contextlib.suppress(ImportError, AttributeError, OSError, ValueError):
        import resource  # noqa: PLC0415 (not everywhere)

        resource.prlimit(process, resource.RLIMIT_AS, (memory, memory))
        most = math.ceil(seconds) + 1
        resource.prlimit(process, resource.RLIMIT_CPU, (most, most))
