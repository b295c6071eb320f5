"""The program on public instances, beside the models that were published for them, in one run.

    python benchmarks/records.py --instances DIR --rows FILE             all, 60 s each
    python benchmarks/records.py --instances DIR --rows FILE --quick     every tenth, 5 s, the program alone
    python benchmarks/records.py --instances DIR --rows FILE --only babble --seconds 10 --engine foon-asp
    python benchmarks/records.py --rows FILE --report                    the tables of what was run

DIR has ``planning/`` (PDDL, and ``best_known.csv`` with the columns problem, domain_file, problem_file,
status and best_known) and ``egraphs/`` (JSON of egraph-serialize). What is in the file of rows for the same
limit is not run again, so a run that was ended resumes.

A task is read once; then each engine answers it in a process of its own, on one processor, and its clock
starts with everything imported and the task in memory. Its seconds are those of the processor, so that other
programs on the machine do not count; the limit is by the clock on the wall. *Proved* is the cost, not that
no tree of that cost has fewer units. Engines get the units that can run and that the goals can need (the
program gets all), and are asked with the models as published, without what their authors do before:

- HiGHS and CP-SAT on planning: vertex elimination (Rankooh and Rintanen, AAAI and ICAPS 2022);
- clingo on planning: supported models with vertex elimination (Rankooh and Janhunen, TPLP 2023);
- HiGHS and CP-SAT on e-graphs: one variable for each node, cycles cut off as they turn up, as the ILP
  extractors of extraction-gym and of egg do it;
- ``greedy`` on e-graphs: ``faster-greedy-dag`` of extraction-gym.

Costs are recomputed from what engines use, as exact fractions. A value that is proved has to be the one that
others proved, there and here; else the run says WRONG and ends with 1. What is better than the best that was
known, or proved where it was open, is written to ``--found`` with its certificate. Every proof of the program
is written down as a certificate, if it has one, after its clock has stopped, and checked.
"""

import argparse
import csv
import json
import os
import statistics
import sys
import time
from collections.abc import Callable, Iterator
from fractions import Fraction
from pathlib import Path
from typing import Any, NamedTuple

from contest.clingo_plain import ready as clingo_ready
from contest.engines import ENGINES
from contest.instance import raw_units
from contest.mixed_integer import ready as mixed_integer_ready
from contest.page import put, table
from contest.trial import End, Work, attempt
from fields.egraph import EGraph

from foon_asp.certificate import certify
from foon_asp.certificate.certificate import subject_of
from foon_asp.deadline import Deadline
from foon_asp.errors import UserError
from foon_asp.planning.strips_task import StripsTask
from foon_asp.planning.task_files import read_task
from foon_asp.problem import Problem, executable_order
from foon_asp.proof import verifier as proof
from foon_asp.proof.certificate_json import read_certificate
from foon_asp.questions.relax import Relaxed, solve_relaxation

OURS, GREEDY = "foon-asp", "greedy"
OPPONENTS = {
    "planning": ("HiGHS elimination", "CP-SAT elimination", "clingo supported"),
    "egraphs": ("HiGHS", "CP-SAT 1 worker"),
}
_READING = 300.0  # seconds for one task


class Instance(NamedTuple):
    """A public instance: its kind, its files, and what is known of it: ``proved``, ``open`` or nothing."""

    kind: str
    name: str
    files: tuple[Path, ...]
    status: str = ""
    known: str = ""


def instances(folder: Path) -> Iterator[Instance]:
    """Give all instances of a folder."""
    listed = folder / "planning" / "best_known.csv"
    if listed.exists():
        with listed.open(newline="", encoding="utf-8") as file:
            for row in csv.DictReader(file):
                files = tuple(listed.parent / row[key] for key in ("domain_file", "problem_file"))
                yield Instance("planning", row["problem"], files, row["status"], row["best_known"])
    graphs = folder / "egraphs"
    for found in sorted(graphs.rglob("*.json")):
        yield Instance("egraphs", str(found.relative_to(graphs).with_suffix("")), (found,))


def our_work(task: StripsTask, offset: Fraction, limit: float) -> Work:
    """Answer as ``foon-asp relax`` does; then look for a certificate and check it, beyond the clock."""

    def work(start: Callable[[], None]) -> dict[str, Any]:
        clingo_ready()
        mixed_integer_ready()
        on_one_processor()
        start()
        began = time.process_time()
        found = solve_relaxation(task, Deadline(limit))
        took = time.process_time() - began
        said = {
            "took": took,
            "proved": found.proved,
            "cost": "" if found.cost is None else str(found.cost - offset),
            "bound": "" if found.lower_bound is None else str(found.lower_bound - offset),
            "plan": found.plan and [str(action) for action in found.plan],
        }
        return said | (certified(found, limit) if found.proved else {})

    return work


def certified(found: Relaxed, limit: float) -> dict[str, Any]:
    """Give the certificate of an answer, and whether it is right."""
    answer, problem = found.answer, found.problem
    deadline = Deadline(limit)
    if answer.ids is None:
        return {}
    certificate = certify(
        *(problem, answer.objectives, answer.ids),
        expired=lambda: deadline.passed,
        cuts=answer.outcome.cuts,
        cases=answer.outcome.cases,
    )
    if certificate is None:
        return {"certified": False}
    text = certificate.text()
    content = read_certificate(text)
    proof.verify(content, subject_of(problem))
    return {"certified": True, "certificate": text}


def their_work(name: str, task: StripsTask, problem: Problem, offset: Fraction, limit: float) -> Work:
    """Answer with another engine."""
    engine = next(engine for engine in ENGINES if engine.name == name)

    def work(start: Callable[[], None]) -> dict[str, Any]:
        engine.ready()
        on_one_processor()
        start()
        began = time.process_time()
        used = engine.solve(problem, raw_units(problem), task.objective, limit)
        took = time.process_time() - began
        if used is None:
            return {"took": took, "proved": True, "cost": "", "bound": ""}
        if executable_order(problem, used) is None:
            raise RuntimeError("the tree does not execute")
        cost = str(Fraction(problem.costs(tuple(used)).measure(task.objective)) - offset)
        return {"took": took, "proved": True, "cost": cost, "bound": cost}

    return work


def greedy_work(graph: EGraph) -> Work:
    """Extract as the gym's greedy extractor does."""

    def work(start: Callable[[], None]) -> dict[str, Any]:
        start()
        began = time.process_time()
        cost = graph.greedy()
        took = time.process_time() - began
        return {"took": took, "proved": False, "cost": "" if cost is None else str(cost), "bound": ""}

    return work


def on_one_processor() -> None:
    """Keep this process, and what it starts, on one processor where the system can do that."""
    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})


def rows(instance: Instance, engines: list[str], limit: float) -> Iterator[dict[str, Any]]:
    """Let engines answer an instance, one after the other."""
    began = time.perf_counter()
    head: dict[str, Any] = {"kind": instance.kind, "instance": instance.name, "limit": limit}
    head |= {"status": instance.status, "known": instance.known}
    graph, offset = None, Fraction(0)
    try:
        if instance.kind == "egraphs":
            graph = EGraph.read(instance.files[0])
            task, offset = graph.task()
        else:
            task = read_task(instance.files, Deadline(_READING))
        problem = task.problem()
    except (UserError, ValueError) as error:
        for engine in engines:
            yield head | {"engine": engine, "end": "not read", "said": str(error)[:500]}
        return
    head |= {"units": len(task.actions), "goals": len(task.goals), "reading": time.perf_counter() - began}
    for engine in engines:
        if engine == OURS:
            work = our_work(task, offset, limit)
        elif engine == GREEDY:
            if graph is None:
                continue
            work = greedy_work(graph)
        else:
            problem.needs, problem.makers  # noqa: B018 (made when first asked for, once for all)
            work = their_work(engine, task, problem, offset, limit)
        trial = attempt(work, 2 * limit + 30 if engine == OURS else limit + 5)
        row = head | {"engine": engine, "end": str(trial.end), "memory": trial.memory}
        if trial.end is End.FAILED:
            row["said"] = trial.trouble[-500:]
        yield row | {"took": limit, "proved": False, "cost": "", "bound": ""} | trial.said


def wrong(row: dict[str, Any], others: list[dict[str, Any]]) -> str:
    """Say what cannot be right of a row, beside others about the same instance."""
    if not row.get("cost"):
        return ""
    cost, known = Fraction(row["cost"]), Fraction(row["known"]) if row["known"] else None
    if known is not None and row["status"] == "proved" and cost < known:
        return f"{row['instance']}: {row['engine']} has {cost}, and {known} is proved"
    if known is not None and row["proved"] and cost > known:
        return f"{row['instance']}: {row['engine']} proves {cost}, and {known} is known"
    for other in others:
        if other.get("cost") and _apart(row, other) and (row["proved"] or other["proved"]):
            theirs = Fraction(other["cost"])
            best, rest = (cost, theirs) if row["proved"] else (theirs, cost)
            if rest < best or (row["proved"] and other["proved"]):
                said = f"{row['engine']} has {cost} and {other['engine']} has {theirs}"
                return f"{row['instance']}: {said}"
    return ""


def _apart(row: dict[str, Any], other: dict[str, Any]) -> bool:
    """Whether two costs differ by more than engines of floats can tell."""
    one, two = Fraction(row["cost"]), Fraction(other["cost"])
    return abs(one - two) * 10**6 > max(Fraction(1), abs(one))


def is_new(row: dict[str, Any]) -> bool:
    """Whether a row has what nobody had: better than the best known, or proved where that was open."""
    if row["engine"] != OURS or not row.get("cost") or row["status"] != "open":
        return False
    return bool(row["proved"]) or Fraction(row["cost"]) < Fraction(row["known"])


def report(found: list[dict[str, Any]]) -> str:
    """Lay out what was run, a table for each kind of instance.

    *Times* is how many times as long as the program an engine takes, the median over what both prove, and
    *sooner* how often it was the first of the two.
    """
    parts = []
    for kind in dict.fromkeys(row["kind"] for row in found):
        some = [row for row in found if row["kind"] == kind]
        names = list(dict.fromkeys(row["instance"] for row in some))
        limit = some[0]["limit"]
        closed = {row["instance"] for row in some if row["status"] != "open"}
        words = (
            "engine, asked, proved, of the open, median s, times, sooner, cost over the best, proved wrongly"
        )
        header = [*words.split(", "), "certified"]
        ours = {row["instance"]: row["took"] for row in some if row["engine"] == OURS and row["proved"]}
        lines = []
        best: dict[str, dict[str, Any]] = {}
        for row in some:
            if row.get("cost"):
                first = best.setdefault(row["instance"], row)
                best[row["instance"]] = min(first, row, key=lambda each: Fraction(each["cost"]))
        for engine in dict.fromkeys(row["engine"] for row in some):
            own = [row for row in some if row["engine"] == engine]
            dear = [row for row in own if row.get("cost") and _apart(row, best[row["instance"]])]
            wrongly = [row for row in dear if row["proved"]]
            proved = [row for row in own if row.get("proved") and row not in wrongly]
            in_time = sum(row["instance"] in closed for row in proved)
            asked = sum(row["instance"] in closed for row in own)
            ended = [row["took"] if row in proved else limit for row in own if "took" in row]
            middle = statistics.median(ended or [limit])
            sure = sum(bool(row.get("certified")) for row in proved)
            both = [row for row in proved if row["instance"] in ours and engine != OURS]
            beside = [(row["took"], ours[row["instance"]]) for row in both]
            times = statistics.median(theirs / took for theirs, took in beside) if beside else None
            sooner = sum(theirs < took for theirs, took in beside)
            lines.append(
                [
                    engine,
                    f"{len(own)}",
                    f"{in_time} of {asked}",
                    f"{len(proved) - in_time} of {len(own) - asked}",
                    f"{'> ' * (middle >= limit)}{middle:.2f}",
                    "" if times is None else f"{times:.3g}",
                    f"{sooner} of {len(beside)}" if beside else "",
                    f"{len(dear)}",
                    f"{len(wrongly)}",
                    f"{sure} of {len(proved)}" if engine == OURS else "",
                ]
            )
        parts.append(f"**{kind}**, {len(names)} instances, limit {limit:g} s, one processor")
        parts.append(table(header, lines))
    return "\n\n".join(parts)


def main() -> int:
    """Read the command line, run what is not there yet, and print the tables."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--instances", type=Path, help="folder with planning/ and egraphs/")
    parser.add_argument("--rows", type=Path, required=True, help="file of results, which a run resumes")
    parser.add_argument("--found", type=Path, default=Path("found"), help="folder for what is new")
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--only", action="append", default=[], help="instances with this in their names")
    parser.add_argument("--engine", action="append", default=[], help="engines to ask; all, if not given")
    parser.add_argument("--quick", action="store_true", help="every tenth instance, 5 s, the program alone")
    parser.add_argument("--report", action="store_true", help="print the tables alone")
    parser.add_argument("--page", type=Path, help="page whose section records gets the tables")
    options = parser.parse_args()
    limit = 5.0 if options.quick else options.seconds
    found = _read(options.rows)
    faults = 0
    asked = [] if options.report or options.instances is None else list(instances(options.instances))
    if options.only:
        asked = [one for one in asked if any(word in f"{one.kind}/{one.name}" for word in options.only)]
    for instance in asked[:: 10 if options.quick else 1]:
        there = {row["engine"] for row in found if (row["instance"], row["limit"]) == (instance.name, limit)}
        engines = [OURS, *(() if options.quick else OPPONENTS[instance.kind])]
        engines += [GREEDY] * (instance.kind == "egraphs")
        wanted = [e for e in engines if e not in there and (not options.engine or e in options.engine)]
        for row in rows(instance, wanted, limit) if wanted else ():
            text = row.pop("certificate", None)
            fault = wrong(row, [other for other in found if other["instance"] == instance.name])
            faults += bool(fault)
            if fault:
                print(f"WRONG: {fault}", flush=True)
            elif is_new(row):
                options.found.mkdir(parents=True, exist_ok=True)
                place = options.found / f"{instance.name}.json"
                document = row | {"certificate": json.loads(text) if text else None}
                place.write_text(json.dumps(document, indent=1) + "\n", encoding="utf-8")
            row.pop("plan", None)
            found.append(row)
            with options.rows.open("a", encoding="utf-8") as file:
                file.write(json.dumps(row) + "\n")
            print(_line(row), flush=True)
    if found:
        text = report([row for row in found if row["limit"] == limit] or found)
        print(text)
        if options.page:
            put(options.page, "records", text)
    return int(faults > 0)


def _read(file: Path) -> list[dict[str, Any]]:
    lines = file.read_text(encoding="utf-8").splitlines() if file.exists() else []
    return [json.loads(line) for line in lines]


def _line(row: dict[str, Any]) -> str:
    head = f"{row['instance'][:48]:48} {row['engine']:18}"
    if "took" not in row:
        return f"{head} {row['end']}: {row.get('said', '')[:80]}"
    what = "proved" if row["proved"] else f"from {row['bound'] or '?'}"
    known = f"({row['status']} {row['known']})" if row["known"] else ""
    cost = row["cost"] if "/" not in row["cost"] else f"{float(Fraction(row['cost'])):.9g}"
    sure = "" if "certified" not in row else " certified" if row["certified"] else " no certificate"
    return f"{head} {cost:>10} {what:12} {known:14} {row['took']:6.2f} s{sure}"


if __name__ == "__main__":
    sys.exit(main())
