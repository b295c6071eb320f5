"""Two checkouts of the program on the same questions, in turn: ratios of seconds by family, and what differs.

    python benchmarks/against.py OLD NEW                               the bundled kitchen
    python benchmarks/against.py OLD NEW --data DIR --commands         a universal FOON, and whole commands
    python benchmarks/against.py OLD NEW --family deep --units 10000   generated, see generate.py
    python benchmarks/against.py OLD NEW --instances DIR               planning and e-graphs, see records.py

OLD and NEW are folders of checkouts, each run by the Python of its ``.venv`` where it has one. Each has one
process that reads a network once and is asked question after question; the other one waits. A question is
asked ``--repeat`` times of both, and the quicker time of each counts, in seconds of the processor: of
solving, after reading, and of writing the answer as JSON. A ratio is new by old, so below 1 the new one is
quicker. Questions that both answer within a millisecond are left out of the ratios, since there is nothing to
compare.

An answer that differs in status or costs is printed, and the exit code is 1 where two that are both proved
differ, or where the new checkout proves fewer.
"""

import argparse
import json
import os
import random
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

OBJECTIVES = ("units", "inputs", "success")
LEAST = 0.001  # seconds that both answers take at least, where a ratio says something
COMMANDS = {
    "compare": ("compare", "--all-makeable", "--format", "json"),
    "batch": ("batch", "{questions}", "--results", "{results}"),
}


class Question(NamedTuple):
    """One question: what is read, and what is asked."""

    family: str
    folder: str
    goals: tuple[str, ...]
    objectives: tuple[str, ...]
    limit: float


class Answer(NamedTuple):
    """What a checkout answers, with seconds of solving and of writing JSON."""

    status: str
    costs: dict[str, str]
    seconds: float
    json_seconds: float


def work() -> None:
    """Answer questions, a line of JSON each, until standard input ends; only the public front is used."""
    import foon_asp  # noqa: PLC0415 (that of the checkout which this process runs)

    read: dict[str, Any] = {}
    answers = os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(2, 1)  # nothing else may be printed among the answers
    for line in sys.stdin:
        asked = Question(*json.loads(line))
        if asked.folder not in read:
            read = {asked.folder: foon_asp.load(asked.folder, lenient=True)}
        problem = read[asked.folder].problem(*asked.goals)
        began = time.process_time()
        answer = foon_asp.solve(problem, ",".join(asked.objectives), time_limit=asked.limit)
        solved = time.process_time()
        answer.json_text()
        written = time.process_time()
        costs = answer.costs
        shown = (
            {} if costs is None else {o: str(costs.measure(foon_asp.Objective(o))) for o in asked.objectives}
        )
        print(
            json.dumps((str(answer.status), shown, solved - began, written - solved)),
            file=answers,
            flush=True,
        )


class Checkout:
    """A checkout, and the process that answers for it."""

    def __init__(self, folder: Path) -> None:
        own = folder / ".venv" / "bin" / "python"
        self.folder, self.python = folder.resolve(), str(own if own.exists() else sys.executable)
        self.environment = os.environ | {"PYTHONPATH": str(self.folder), "PYTHONWARNINGS": "ignore"}
        self._process = subprocess.Popen(
            [self.python, str(Path(__file__).resolve()), "--work"],
            env=self.environment,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )

    def ask(self, question: Question) -> Answer:
        """Return the answer to a question; raises :class:`RuntimeError` where the process has ended."""
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        self._process.stdin.write(json.dumps(question) + "\n")
        self._process.stdin.flush()
        line = self._process.stdout.readline()
        if not line:
            raise RuntimeError(f"{self.folder}: ended at {question}")
        return Answer(*json.loads(line))

    def run(self, words: Sequence[str]) -> float:
        """Return the seconds of a whole command; raises :class:`RuntimeError` where it fails."""
        began = time.perf_counter()
        command = [self.python, "-P", "-m", "foon_asp", *words]  # -P: not the code of the current folder
        ended = subprocess.run(command, check=False, env=self.environment, capture_output=True, text=True)
        if ended.returncode not in {0, 1, 3}:
            raise RuntimeError(f"{self.folder}: {ended.stderr}")
        return time.perf_counter() - began


def questions_of(family: str, folder: Path, most: int, limit: float) -> Iterator[Question]:
    """Return questions for the goals that can be made in a folder of data, ``most`` of them at random."""
    from foon_asp.comparison.many import makeable  # noqa: PLC0415 (not for a process that answers)
    from foon_asp.foon import load  # noqa: PLC0415

    foon = load(folder, lenient=True)
    problem = foon.dataset.problem((0,), "strict", everything=True)
    goals = [str(problem.network.objects[goal]) for goal in makeable(problem)]
    if len(goals) > most:
        goals = sorted(random.Random(1).sample(goals, most))
    for objective in OBJECTIVES:
        yield from (Question(family, str(folder), (goal,), (objective,), limit) for goal in goals)


def instances_of(folder: Path, made: Path, limit: float) -> Iterator[Question]:
    """Return a question for each planning task and e-graph, by price; each becomes a folder of data."""
    from fields.egraph import EGraph  # noqa: PLC0415
    from neutral import write_task  # noqa: PLC0415
    from records import instances  # noqa: PLC0415

    from foon_asp.deadline import Deadline  # noqa: PLC0415
    from foon_asp.planning.task_files import read_task  # noqa: PLC0415

    for number, instance in enumerate(instances(folder)):
        if instance.kind == "egraphs":
            task, _ = EGraph.read(instance.files[0]).task()
        else:
            task = read_task(instance.files, Deadline())
        written = made / str(number)
        write_task(task, written)
        goals = tuple(task.facts[goal] for goal in task.goals)
        yield Question(instance.kind, str(written), goals, ("price",), limit)


def ratios(rows: Sequence[tuple[Answer, Answer]], seconds: str) -> str:
    """Return the median, the 90th percentile and the greatest of ratios, and of how many questions."""
    pairs = [(getattr(old, seconds), getattr(new, seconds)) for old, new in rows]
    found = sorted(new / old for old, new in pairs if max(old, new) >= LEAST)
    if not found:
        return "| | | | 0"
    nine = found[min(len(found) - 1, len(found) * 9 // 10)]
    return f"| {statistics.median(found):.2f} | {nine:.2f} | {found[-1]:.2f} | {len(found)}"


def whole_commands(old: Checkout, new: Checkout, folder: Path, repeat: int) -> None:
    """Print the ratio of whole commands on a folder of data."""
    with tempfile.TemporaryDirectory() as made:
        questions = Path(made) / "questions.jsonl"
        questions.write_text('{"goal": "@makeable", "objective": ["units", "success"]}\n', encoding="utf-8")
        for name, words in COMMANDS.items():
            pairs = []
            for turn in range(repeat):
                for checkout in (old, new):
                    results = Path(made) / f"{turn}-{checkout.folder.name}.jsonl"
                    filled = [word.format(questions=questions, results=results) for word in words]
                    pairs.append(checkout.run([*filled, "--data", str(folder)]))
            ratio = statistics.median(n / o for o, n in zip(pairs[::2], pairs[1::2], strict=True))
            print(f"{name}: {ratio:.2f}  ({min(pairs[::2]):.2f} s, {min(pairs[1::2]):.2f} s)", flush=True)


def main() -> int:
    """Ask everything and print; 1 where proved answers differ, or the new checkout proves fewer."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("old", type=Path)
    parser.add_argument("new", type=Path)
    parser.add_argument("--data", action="append", type=Path, default=[], metavar="DIR")
    parser.add_argument("--family", action="append", default=[], metavar="NAME")
    parser.add_argument("--units", type=int, default=10_000)
    parser.add_argument("--instances", type=Path, metavar="DIR")
    parser.add_argument("--commands", action="store_true", help="whole commands on each --data, too")
    parser.add_argument("--goals", type=int, default=200, help="the most goals of each network")
    parser.add_argument("--limit", type=float, default=20, metavar="SECONDS")
    parser.add_argument("--repeat", type=int, default=3)
    options = parser.parse_args()
    old, new = Checkout(options.old), Checkout(options.new)
    with tempfile.TemporaryDirectory() as made:
        folders = {folder.resolve().name: folder.resolve() for folder in options.data}
        if not (folders or options.family or options.instances):
            folders["kitchen"] = Path(__file__).resolve().parents[1] / "data" / "kitchen"
        for family in options.family:
            folders[f"{family} {options.units}"] = folder = Path(made) / family
            script = str(Path(__file__).with_name("generate.py"))
            words = ["--family", family, "--units", str(options.units), "--seed", "1", "--out", str(folder)]
            subprocess.run([sys.executable, script, *words], check=True, stdout=sys.stderr)
        asked = [
            q
            for name, folder in folders.items()
            for q in questions_of(name, folder, options.goals, options.limit)
        ]
        if options.instances:
            asked += instances_of(options.instances, Path(made), options.limit)
        wrong = report(asked, old, new, options.repeat)
        if options.commands:
            for folder in folders.values():
                whole_commands(old, new, folder, options.repeat)
    return 1 if wrong else 0


def report(asked: Sequence[Question], old: Checkout, new: Checkout, repeat: int) -> bool:
    """Ask, print a row for each family, and return whether something is wrong."""
    rows: dict[str, list[tuple[Answer, Answer]]] = {}
    wrong = False
    for question in asked:
        turns = [(old.ask(question), new.ask(question)) for _ in range(repeat)]
        pair = tuple(quickest([turn[side] for turn in turns]) for side in (0, 1))
        rows.setdefault(question.family, []).append((pair[0], pair[1]))
        if (pair[0].status, pair[0].costs) != (pair[1].status, pair[1].costs):
            print(f"differs: {question}\n  old {pair[0]}\n  new {pair[1]}", flush=True)
            wrong |= pair[0].status == pair[1].status == "optimal"
    print("| family | asked | proved old | new | median | 90 % | most | of | JSON | 90 % | most | of |")
    print("|---" * 12 + "|")
    for family, answers in rows.items():
        proved = [sum(pair[side].status in {"optimal", "infeasible"} for pair in answers) for side in (0, 1)]
        wrong |= proved[1] < proved[0]
        both = f"{ratios(answers, 'seconds')} {ratios(answers, 'json_seconds')}"
        print(f"| {family} | {len(answers)} | {proved[0]} | {proved[1]} {both} |", flush=True)
    return wrong


def quickest(answers: Sequence[Answer]) -> Answer:
    """Return the answer with the least seconds of each kind among several to one question."""
    best = min(answers, key=lambda answer: answer.seconds)
    return best._replace(json_seconds=min(answer.json_seconds for answer in answers))


if __name__ == "__main__":
    if "--work" in sys.argv[1:2]:
        work()
    else:
        sys.exit(main())
