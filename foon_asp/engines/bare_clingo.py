"""The same question put to stock clingo: a process of its own, on the text that ``foon-asp facts`` prints.

Whatever the constraints, soft files, constants and encodings are, it reads them as they stand. Nothing is
reduced before it, kept from a question before it, or known to it of our answer while it looks for its own; it
searches in another way than ours, too. What it says is compared with our answer here, in exact numbers: the
costs it adds up against those of its units, its tree against the simulation, our tree against its rules.

By ``success`` and others that are fractions clingo goes by rounded weights, which are no answer yet. Every
tree that is at least as good as ours has a rounded weight within a bound that is worked out here anew; see
docs/dev/certificates.md. clingo gives the trees within it: rates are multiplied, or costs added up, as
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
from foon_asp.problem import Costs, Objective, levels, multiplies

NAME: Final = "clingo"
OPTIONS: Final = ("--opt-strategy=usc,pmres,disjoint,stratify",)  # ended most often of those tried
MOST_KINDS = 10_000  # of trees within the bound
_MEMORY: Final = 4 * 2**30  # bytes, where no memory limit says otherwise
_ENDED: Final = {0, 10, 20, 30}  # the program and the Python module end otherwise where there was no fault
_OUT_OF_MEMORY: Final = (b"bad_alloc", b"MemoryError", b"cannot allocate memory")
_STRING_OR_WEIGHT = re.compile(r'"(?:\\.|[^"\\])*"|(?<![\w\'])(?:risk\(|cost\((\w+),)(\d+),(\d+)\)')
_USED = re.compile(r"(?:use|times)\((\d+)(?:,(\d+))?\)")


def check_with_bare_clingo(asked: Asked, seconds: float) -> None:
    """Hold an answer against clingo's own.

    Raises :class:`DisagreementError` where both cannot be right, and :class:`NotCheckedError` where clingo
    did not finish within ``seconds``.
    """
    outcome = asked.outcome
    program = bare_program(outcome.problem, outcome.objectives, asked.settings, asked.soft)
    _Check(asked, program, Clingo(program, seconds, asked.settings.begun.memory)).check()


class Found(NamedTuple):
    """An answer of clingo: how often each unit is used, by number, and the costs as clingo adds them up."""

    times: dict[int, int]
    costs: tuple[int, ...]


class Clingo:
    """Runs clingo, time after time until the end."""

    def __init__(self, program: BareProgram, seconds: float, memory: int | None) -> None:
        self._program, self._seconds = program, seconds
        self._end = time.monotonic() + seconds
        self._memory = _MEMORY if memory is None else min(memory, _MEMORY)

    def best(self, more: str = "", with_second_opinion: bool = True) -> Found | None:
        """Return an optimal answer, ``None`` where there is none; ``more`` text is read beside the facts.

        What reads that text is the encoding of the second opinion, if it is not the question itself.
        """
        options = ("--opt-mode=opt", "--models=0", "--quiet=1")
        result, _, answers = self._run(more, options, bool(more) and with_second_opinion)
        if result == "UNSATISFIABLE":
            return None
        if result != "OPTIMUM FOUND" or not answers:
            raise NotCheckedError(f"clingo ended with {result!r}")
        return answers[-1]

    def all_kinds(self, more: str, bounds: Sequence[int]) -> list[Found]:
        """Return an answer of every kind that costs at most ``bounds``."""
        mode = ",".join(["--opt-mode=enum", *map(str, bounds)])
        options = (mode, f"--models={MOST_KINDS + 1}", "--project=project")
        result, is_all, answers = self._run(more, options, True)
        if len(answers) > MOST_KINDS:
            raise NotCheckedError(
                f"more than {MOST_KINDS} kinds of trees are too close to the best by rounded costs"
            )
        if not is_all:
            raise NotCheckedError(f"clingo ended with {result!r}")
        return answers

    def _run(
        self, more: str, options: Iterable[str], with_second_opinion: bool
    ) -> tuple[str, bool, list[Found]]:
        """Return the result, whether there are no more answers, and the answers."""
        program, late = self._program, f"clingo did not finish within {self._seconds:g} s"
        added = (question_encoding("second_opinion.lp"),) if with_second_opinion else ()
        # absolute, since a name may begin with -; not resolved, since files include others beside them
        files = [str(file.absolute()) for file in (*program.files, *added)]
        command = [sys.executable, "-P", "-m", "clingo", *files, "-", *program.constants, "--outf=2"]
        left = self._end - time.monotonic()
        if left <= 0:
            raise NotCheckedError(late)
        with subprocess.Popen(
            [*command, *OPTIONS, *options],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            start_new_session=True,  # ctrl-C is for us, who then stop the process
        ) as process:
            try:
                _limit(process.pid, left, self._memory)
                text = (program.text + more).encode("utf-8", "surrogatepass")
                out, err = process.communicate(text, left)
            except subprocess.TimeoutExpired:
                raise NotCheckedError(late) from None
            finally:
                process.kill()
                process.wait()  # at ctrl-C, Popen itself waits for a quarter of a second only
        found: dict[str, Any] = {}
        with contextlib.suppress(ValueError):
            found = json.loads(out.decode("utf-8", "replace"), strict=False)
        if process.returncode == 33 or any(words in err for words in _OUT_OF_MEMORY):
            raise NotCheckedError("clingo ran out of memory")
        if process.returncode not in _ENDED or found.get("Result", "UNKNOWN") == "UNKNOWN":
            lines = err.decode("utf-8", "replace").strip().split("\n")
            error = next((line for line in lines if ": error: " in line), lines[-1])
            raise NotCheckedError(f"clingo ended with the code {process.returncode}: {error}")
        witnesses = [each for call in found["Call"] for each in call.get("Witnesses", ()) if "Value" in each]
        return found["Result"], found["Models"]["More"] == "no", list(map(_found, witnesses))


def _found(witness: dict[str, Any]) -> Found:
    """Read an answer; what else the user's files show is passed over."""
    times: dict[int, int] = {}
    for used in filter(None, map(_USED.fullmatch, witness["Value"])):
        if used[2] or int(used[1]) not in times:  # plans show times(U,N) and use(U)
            times[int(used[1])] = int(used[2] or 1)
    return Found(times, tuple(witness.get("Costs", ())))


class _Check:
    """One answer, compared with clingo's."""

    def __init__(self, asked: Asked, program: BareProgram, clingo: Clingo) -> None:
        self.asked, self.clingo = asked, clingo
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
        theirs = self.clingo.best()
        costs = self.outcome.costs
        if theirs is None or costs is None:
            if theirs is not None or costs is not None:
                ours, other = ("a", "no") if theirs is None else ("no", "a")
                raise self._disagreement(
                    f"we say {ours} tree exists, clingo says {other} tree exists", theirs
                )
            return
        given = self._given(theirs)
        rounded = [objective for objective in self.weights if not self._is_to_scale(objective)]
        if not (self._is_usual(theirs) and self._is_usual(given)):
            self._compare_as_added_up(given, theirs)
        elif len(rounded) > 1:
            raise NotCheckedError(f"{' and '.join(rounded)} are both rounded in the facts")
        elif rounded:
            self._compare_exactly(theirs, given, costs, rounded[0])
        else:
            self._compare(theirs, self.levels)

    def _given(self, theirs: Found) -> Found:
        """Return our tree with the costs that clingo adds up; raise where it is none under the rules.

        ``theirs`` is shown beside it then.
        """
        units = check_tree(self.problem, EngineAnswer("foon-asp", self.levels, self.outcome.units, True))
        if self.problem.costs(units) != self.outcome.costs:
            raise self._disagreement("the costs of our tree are not those of its units", theirs)
        given = self.clingo.best(write_given(list(map(self.problem.network.unit_number, units))))
        if given is None:
            raise self._disagreement("clingo says that our tree breaks the rules", theirs)
        penalty = given.costs[0] if self.asked.soft else None
        if penalty != self.asked.penalty:
            raise self._disagreement(
                f"we say our tree has the penalty {self.asked.penalty}, clingo says {penalty}", given
            )
        return given

    def _is_usual(self, found: Found) -> bool:
        """Whether the costs that clingo adds up are those of the units, which replaced encodings may change.

        The penalty is for clingo alone to know.
        """
        costs = self.problem.costs(self._executable(found))
        figures = [
            sum(self.weights[objective].get(number, 0) for number in found.times)
            if objective in self.weights
            else costs.measure(objective)
            for objective in self.levels
        ]
        added_up = list(found.costs[bool(self.asked.soft) :])
        if added_up != figures and self.asked.settings.replaced is None:
            raise self._disagreement(f"clingo adds up the costs {added_up}, its units cost {figures}", found)
        return added_up == figures

    def _compare_as_added_up(self, ours: Found, theirs: Found) -> None:
        if self.weights:
            names = " and ".join(self.weights)
            raise NotCheckedError(f"the replaced encodings do not measure {names} as it is measured here")
        if ours.costs != theirs.costs:
            raise self._disagreement(
                f"as the encodings have it our tree costs {list(ours.costs)}, "
                f"the one of clingo {list(theirs.costs)}",
                theirs,
            )

    def _compare(self, found: Found, objectives: Iterable[Objective]) -> None:
        """Hold the penalty and some objectives against ours; raise where one is not the same."""
        answer = self._answer(found)
        if self.asked.soft and self.asked.penalty != found.costs[0]:
            raise differing("penalty", self.asked.penalty or 0, found.costs[0], answer)
        assert self.outcome.costs is not None
        costs = self.problem.costs(answer.units or ())
        for by in objectives:
            ours, theirs = self.outcome.costs.measure(by), costs.measure(by)
            if ours != theirs:
                raise differing(str(by), ours, theirs, answer, multiplies(by))

    def _is_to_scale(self, objective: Objective) -> bool:
        """Whether weights compare as what units cost: none is rounded."""
        weights = self.weights[objective]
        pairs = set(zip(self._figures(weights, objective), weights.values(), strict=True))
        if multiplies(objective):
            return all(figure == 1 for figure, _ in pairs)
        ratios = {weight / figure for figure, weight in pairs if figure}
        return len(ratios) <= 1 and all(figure or not weight for figure, weight in pairs)

    def _figures(self, numbers: Iterable[int], objective: Objective) -> list[Fraction]:
        """Return what each of the units costs by an objective."""
        return [Fraction(self.problem.figure(objective, unit)) for unit in map(self._unit, numbers)]

    def _compare_exactly(self, theirs: Found, given: Found, costs: Costs, by: Objective) -> None:
        """Compare an objective exactly, with what counts more before it and what counts less after it."""
        place = self.levels.index(by)
        before, after, weights = self.levels[:place], self.levels[place:], self.weights[by]
        self._compare(theirs, before)
        if self._key(theirs, self.levels) < costs.key(self.levels):
            self._compare(theirs, self.levels)  # best by weights, and better than ours in truth
        own = self._figures(given.times, by)
        classes: dict[Fraction, list[int]] = {}
        for number, figure in zip(weights, self._figures(weights, by), strict=True):
            classes.setdefault(figure, []).append(number)
        pairs = {(figure, weights[number]) for figure, numbers in classes.items() for number in numbers}
        most = greatest_weight(pairs, own, multiplies(by))
        classes.pop(Fraction(int(multiplies(by))), None)  # of which as many as there are change nothing
        lightest = [min(map(weights.__getitem__, numbers)) for numbers in classes.values()]
        alike = [
            min(len(numbers), most // light) if light else len(numbers)
            for numbers, light in zip(classes.values(), lightest, strict=True)
        ]
        same = write_same_rates(list(classes.values()))
        bounds = [*given.costs[: place + bool(self.asked.soft)], most]
        equal: list[list[int]] = []
        for found in self.clingo.all_kinds(same + write_most_alike(alike), bounds):
            if not self._is_usual(found):
                raise NotCheckedError("the replaced encodings measure some trees in another way")
            self._compare(found, before)
            if self._key(found, (by,)) < costs.key([by]):
                self._compare(found, [by])
            elif self._key(found, (by,)) == costs.key([by]):
                equal.append(_counts(classes, self._figures(found.times, by)))
        if _counts(classes, own) not in equal:  # it is within the bound itself
            raise self._disagreement("our tree is not among those that clingo finds within the bound", theirs)
        if len(after) == 1:
            return
        best: list[Found] = []
        for numbers in equal:
            found_best = self.clingo.best(same + write_exactly_alike(numbers))
            if found_best is None:
                raise NotCheckedError("clingo loses a kind of tree that it found")
            self._executable(found_best)
            best.append(found_best)
        self._compare(min(best, key=lambda found: self._key(found, after)), self.levels)

    def _executable(self, found: Found) -> tuple[int, ...]:
        """Return the units of an answer in an order that executes."""
        try:
            return check_tree(self.problem, self._answer(found))
        except DisagreementError as error:
            if self.asked.settings.replaced is None:
                raise
            raise NotCheckedError(f"{error}, as the replaced encodings allow") from None

    def _key(self, found: Found, objectives: tuple[Objective, ...]) -> tuple[int | Fraction, ...]:
        return self.problem.costs(map(self._unit, found.times)).key(objectives)

    def _unit(self, number: int) -> int:
        unit = self.problem.network.unit_of_number(number)
        if unit is None:
            raise self._disagreement(f"clingo uses a unit number {number}, which there is not", None)
        return unit

    def _answer(self, found: Found | None) -> EngineAnswer:
        units = None if found is None else tuple(map(self._unit, sorted(found.times)))
        return EngineAnswer(NAME, self.levels, units, True)

    def _disagreement(self, message: str, found: Found | None) -> DisagreementError:
        return DisagreementError(message, self._answer(found))


def _counts(different: Iterable[Fraction], figures: Iterable[Fraction]) -> list[int]:
    """Count how many of the figures are each of the ``different`` ones."""
    counted = Counter(figures)
    return [counted[figure] for figure in different]


def greatest_weight(
    weights: Collection[tuple[Fraction, int]], own: Collection[Fraction], multiplies: bool = True
) -> int:
    """Return the greatest sum of weights that a tree at least as good as ours can have.

    ``weights`` are the different pairs of what a unit costs and its weight; ``own`` are the costs of our
    units. Costs are rates where it ``multiplies``. Nothing is taken for granted of how the weights were
    rounded. Write L(c) for a cost, -ln p for a rate p, and let S be the greatest w / L(c) over all units that
    cost anything. Then w <= S * L(c) for every unit, so the sum of the weights of any tree T is at most
    S * L(T), where L(T) is the sum of its costs; and L(T) is no greater than that of our tree. Raises
    :class:`NotCheckedError` for a unit that costs nothing and has a weight, where there is no such S, and for
    rates that have no logarithm.
    """
    known = {*own, *(cost for cost, _ in weights)}
    bounds = {cost: _minus_log(cost) if multiplies else (cost, cost) for cost in known}
    if any(weight and bounds[cost][0] <= 0 for cost, weight in weights):
        raise NotCheckedError("a unit that costs nothing has a weight")
    ratios = (weight / bounds[cost][0] for cost, weight in weights if bounds[cost][0])
    return math.floor(max(ratios, default=Fraction(0)) * sum(bounds[cost][1] for cost in own))


def _minus_log(rate: Fraction) -> tuple[Fraction, Fraction]:
    """Enclose -ln of a rate between two fractions, both above 0 where the rate is below 1."""
    if rate <= 0:
        raise NotCheckedError("a success rate of 0 has no logarithm")
    lost = 1 - rate
    if lost < Fraction(1, 10**40):  # lost <= -ln(1 - lost) <= lost / (1 - lost), next to 1 all but the same
        return lost, lost / rate
    context = Context(prec=100)  # of which no more than 50 are lost in the difference of two logarithms

    def enclosed(number: int) -> tuple[Fraction, Fraction]:
        logarithm = context.ln(Decimal(number))  # correctly rounded: the true one is between its neighbours
        if not logarithm:
            return Fraction(0), Fraction(0)
        return Fraction(context.next_minus(logarithm)), Fraction(context.next_plus(logarithm))

    (low, high), (lower, higher) = enclosed(rate.numerator), enclosed(rate.denominator)
    return lower - high, higher - low


def _limit(process: int, seconds: float, memory: int) -> None:
    """Keep endless grounding from taking all memory, and from outliving us, where the system can."""
    with contextlib.suppress(ImportError, AttributeError, OSError, ValueError):
        import resource  # noqa: PLC0415 (not everywhere)

        resource.prlimit(process, resource.RLIMIT_AS, (memory, memory))
        most = math.ceil(seconds) + 1
        resource.prlimit(process, resource.RLIMIT_CPU, (most, most))
