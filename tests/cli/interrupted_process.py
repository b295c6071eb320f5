"""Ctrl-C at random moments of every verb in one process: none hangs, and the next answer is right.

    python -m tests.cli.interrupted_process --interrupts 5000 --seed 1

A thread presses ctrl-C. What is wrong is printed with the verb and the moment; the exit code is 1 then.
"""

import argparse
import faulthandler
import io
import os
import random
import re
import shutil
import signal
import sys
import tempfile
import threading
import time
from collections import Counter
from pathlib import Path

from foon_asp.cli.main import main

_PATIENCE = 20.0  # seconds after which a question that was interrupted hangs
_KITCHEN = Path(__file__).resolve().parents[2] / "data" / "kitchen"
_LIMIT = ("--time-limit", "30")  # watched, and far away
_CHECK = ("solve", "--goal", "ice")
_TASK = (
    "(define (domain d) (:requirements :strips) (:predicates (a) (b) (c))"
    "(:action x :parameters () :precondition (a) :effect (b))"
    "(:action y :parameters () :precondition (b) :effect (c)))",
    "(define (problem p) (:domain d) (:init (a)) (:goal (c)))",
)
# what ctrl-C costs there
_LESS_PROVED = ("no certificate was found, and nothing is written", "proves the tree best by units alone")
_MADE_ONCE = {"rows.jsonl", "new", "store.foon"}
_RULE = ':- use(U), motion(U,"dance").'


def questions(folder: Path) -> list[tuple[str, ...]]:
    """List questions of every verb that ends by itself, about files of a folder that is made for them."""
    for name, text in (
        ("own.lp", _RULE),
        ("other.lp", ":- not use(_).\n"),
        ("domain.pddl", _TASK[0]),
        ("problem.pddl", _TASK[1]),
        ("asked.jsonl", '{"goal": ["ice", "macaroni"]}\n'),
    ):
        (folder / name).write_text(text, encoding="utf-8")
    tree, tree_json = str(folder / "tree.txt"), str(folder / "tree.json")
    for file, form in ((tree, "foon"), (tree_json, "json")):
        said, _, _ = asked(("solve", "--goal", "macaroni", "--format", form))
        Path(file).write_text(said, encoding="utf-8")
    network, task = str(_KITCHEN / "FOON.txt"), folder / "task"
    asked(("export", "--to", "pddl", "--goal", "ice", "-o", str(task)))
    (folder / "plan").write_text("", encoding="utf-8")
    goal, rule = ("--goal", "macaroni"), ("--constraint", str(folder / "own.lp"))
    return [
        ("solve", *goal, *_LIMIT, "--debug"),
        ("solve", *goal, "--objective", "success", *_LIMIT),
        ("solve", *goal, *rule, *_LIMIT),
        ("solve", *goal, "--items", "used-up", *_LIMIT),
        ("solve", *goal, "--certificate", str(folder / "proof.json"), *_LIMIT),
        ("solve", *goal, "--time-limit", "0.01"),
        ("solve", "--all-goals", "--goal", "ice", *_LIMIT),
        ("solve", "--goal", "ice", *goal, *_LIMIT),
        ("schedule", tree_json, "--durations", str(_KITCHEN / "durations.txt"), *goal, *_LIMIT),
        ("trace", tree, *goal),
        ("batch", str(folder / "asked.jsonl"), "--results", str(folder / "rows.jsonl")),
        ("why-not", "--goal", "macaroni", *_LIMIT),
        ("shopping-list", *goal, *_LIMIT),
        ("why-not", *goal, "--constraint", str(folder / "other.lp"), *rule, *_LIMIT),
        ("alternatives", *goal, "--best", "3", *_LIMIT),
        ("pareto", *goal, "--objective", "units", "--objective", "success", *_LIMIT),
        ("regret", "--goal", "ice", *_LIMIT),
        ("sensitivity", "--goal", "ice", *_LIMIT),
        ("assist", "--goal", "ice", *_LIMIT),
        ("view", "--goal", "ice", "-o", str(folder / "page.html"), *_LIMIT),
        ("compare", "--goal", "ice", *goal, "--jobs", "2", *_LIMIT),
        ("compare", *goal, *_LIMIT),
        ("diff", tree, tree_json),
        ("diff", network, network),
        ("stats", "--units"),
        ("stats",),
        ("init", str(folder / "new")),
        ("lint", tree),
        ("lint", "--learn", tree, "-o", str(folder / "names.txt")),
        ("fmt", tree, "--check"),
        ("rename", "salt", "pepper", tree),
        ("convert", tree, "--to", "json"),
        ("merge", tree, tree, "-o", str(folder / "merged.txt")),
        ("merge", tree, "--store", str(folder / "store.foon")),
        ("check", tree, *goal),
        ("solve", *goal, "--certificate", str(folder / "certificate.json"), *_LIMIT),
        ("verify", str(folder / "proof.json")),
        ("export", "--to", "pddl", *goal, "-o", str(task)),
        ("read-plan", str(folder / "plan"), "--map", str(task / "map.json")),
        ("relax", str(folder / "domain.pddl"), str(folder / "problem.pddl"), *_LIMIT),
        ("view", *goal, "--format", "dot", *_LIMIT),
        ("facts", *goal),
        ("encodings",),
        ("constraints",),
        ("completion", "bash"),
        ("schema", "solve"),
    ]


def read_back(file: io.TextIOWrapper) -> str:
    """Return what was written."""
    file.seek(0)
    return file.read()


def asked(words: tuple[str, ...]) -> tuple[str, str, int]:
    """Run a command in this process; give what it prints, what it remarks and its exit code."""
    for word in words:  # else there would be nothing left to do
        if Path(word).name in _MADE_ONCE:
            shutil.rmtree(word, ignore_errors=True)
            Path(word).unlink(missing_ok=True)
    before = sys.stdout, sys.stderr
    out, err = (io.TextIOWrapper(io.BytesIO(), "utf-8", write_through=True) for _ in range(2))
    code = -1
    try:
        sys.stdout, sys.stderr = out, err
        main(list(words))
    except SystemExit as ended:
        code = int(ended.code or 0)
    finally:
        sys.stdout, sys.stderr = before
    return read_back(out), read_back(err), code


def _same(said: str) -> str:
    return re.sub(r"\d+\.\d+", "#", said)


def interrupt(interrupts: int, seed: int) -> tuple[list[str], Counter[str]]:
    """Interrupt questions; return what is wrong, and how often each verb was struck.

    Where one hangs, this process prints where each thread is, and ends.
    """
    random_ = random.Random(seed)
    faults, struck = [], Counter[str]()
    with tempfile.TemporaryDirectory() as name:
        expected = {}
        for words in (_CHECK, *(all_ := questions(Path(name)))):
            asked(words)
            began = time.monotonic()
            said, err, code = asked(words)
            expected[words] = _same(said), code, time.monotonic() - began
            if code in {2, 70}:
                faults.append(f"{words} ends with {code}: {err}")
        for _ in range(interrupts):
            words = random_.choice(all_)
            right, right_code, seconds = expected[words]
            moment = random_.uniform(0, 1.1 * seconds)
            said, err, code = "", "", -1
            faulthandler.dump_traceback_later(moment + _PATIENCE, exit=True)
            press = threading.Timer(moment, os.kill, (os.getpid(), signal.SIGINT))
            try:
                press.start()
                said, err, code = asked(words)
                press.join()
                time.sleep(0.05)
            except KeyboardInterrupt:  # it came before the question, or behind it
                struck["outside"] += 1
            else:
                struck[words[0]] += 1
            before = signal.signal(signal.SIGINT, signal.SIG_IGN)
            sys.stdout, sys.stderr = sys.__stdout__, sys.__stderr__
            where = f"{' '.join(words)} at {moment:.4f} s"
            if code in {2, 70} or "Traceback" in err or "ignored in" in err:
                faults.append(f"{where} ends with {code}: {err}")
            is_same = _same(said) == right or any(each in said for each in _LESS_PROVED)
            if code in {0, 1} and code == right_code and not is_same:
                faults.append(f"{where} ends with {code} and another answer")
            said, err, code = asked(_CHECK)
            if (_same(said), code) != expected[_CHECK][:2]:
                faults.append(f"{where}: the next question ends with {code}: {said}{err}")
            signal.signal(signal.SIGINT, before)
        faulthandler.cancel_dump_traceback_later()
    return faults, struck


def run() -> None:
    """Read the options, and interrupt."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--interrupts", type=int, default=5000)
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    faults, struck = interrupt(given.interrupts, given.seed)
    print(*faults, sep="\n")
    print(f"{given.interrupts} interrupts of {len(struck)} verbs: {len(faults)} faults")
    sys.exit(bool(faults))


if __name__ == "__main__":
    run()
