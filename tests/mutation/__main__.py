"""Tries mutants: ``python -m tests.mutation``, or ``make mutants``."""

import argparse
import hashlib
import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import pytest

from tests.mutation.equivalents import GREATEST_SHARE, equivalents, place
from tests.mutation.mutant import SEED
from tests.mutation.reach import RECORD
from tests.mutation.report import matrix, only_killers, share, survivors, table
from tests.mutation.rooms import PROVING, ROOT, all_mutants, changed_since, tests_of, texts
from tests.mutation.trials import Outcome, Reach, Trials, read_reach

LEAST = 0.95  # of the mutants that are tried
LEAST_OF_CHANGE = 0.4  # of a few dozen, with the tests of their rooms alone: what survives is for a person
FEWEST = 50  # fewer say nothing
FOLDER = ROOT / ".mutants"
_FEEDS = ("foon_asp", "encodings", "data", "tests", "pyproject.toml")


def main() -> int:
    """Try mutants and report; give 1 where too many survive."""
    options = _options()
    os.chdir(ROOT)
    FOLDER.mkdir(exist_ok=True)
    places = options.places or list(PROVING)
    if options.changed_since is not None:
        places = changed_since(options.changed_since)
        if not places:
            print(f"no file of the package differs from {options.changed_since}: nothing to try")
            return 0
    tests = options.tests or (tests_of(places) if options.changed_since is not None else [])
    listed = equivalents()
    mutants = all_mutants(options.seed, places)
    known = [mutant for mutant in mutants if place(mutant) in listed]
    waiting = [mutant for mutant in mutants if place(mutant) not in listed][options.skip :]
    if options.again:
        before = set(map(tuple, json.loads((FOLDER / "survivors.json").read_text())))
        waiting = [mutant for mutant in mutants if mutant.key in before]
    print(
        f"{len(mutants)} mutants, {len(known)} of them known to be equivalent; {len(waiting)} to try",
        flush=True,
    )
    reach = _reach(options.jobs, tests)
    trials = Trials(waiting, reach, options.jobs, options.seconds, every_killer=options.matrix)
    began = time.monotonic()
    ended = pytest.main(["-q", "-s", "-p", "no:cacheprovider", *tests], plugins=[trials])
    if ended not in {pytest.ExitCode.OK, pytest.ExitCode.NO_TESTS_COLLECTED}:
        return int(ended)
    alive = [each for each in trials.tried if each.outcome in {Outcome.SURVIVED, Outcome.UNREACHED}]
    if options.matrix:
        (FOLDER / "matrix.json").write_text(matrix(trials.tried, reach))
        print(f"written: {FOLDER.name}/matrix.json")
    (FOLDER / "survivors.json").write_text(json.dumps([each.mutant.key for each in alive]))
    tried_known = [] if options.seconds is not None or options.again else known
    said = [
        survivors(trials.tried, texts()),
        *([only_killers(trials.tried)] if options.matrix else []),
        table(trials.tried, tried_known),
        f"{len(trials.tried)} of {len(waiting)} tried in {time.monotonic() - began:.0f} s; "
        f"{share(trials.tried):.1%} were noticed",
    ]
    faults = [f"{test} fails unchanged when tried this way, and was not used" for test in trials.not_used]
    if places == list(PROVING):
        gone = listed - {place(mutant) for mutant in mutants}
        faults += [
            f"docs/dev/testing.md lists a change that is not there: {' '.join(each)}" for each in sorted(gone)
        ]
    if options.changed_since is None and len(known) > GREATEST_SHARE * len(mutants):
        faults.append(
            f"docs/dev/testing.md lists {len(known)} mutants, more than {GREATEST_SHARE:.0%} of them"
        )
    if len(trials.tried) < min(FEWEST, len(waiting)) and not options.again:
        faults.append(f"only {len(trials.tried)} mutants were tried, which says nothing")
    least = LEAST if options.changed_since is None else LEAST_OF_CHANGE
    if trials.tried and share(trials.tried) < least:
        faults.append(f"{share(trials.tried):.1%} were noticed, expected at least {least:.0%}")
    text = "\n".join(said + faults) + "\n"
    (FOLDER / "report.txt").write_text(text)
    print(text, end="")
    return 1 if faults else 0


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m tests.mutation", description=__doc__)
    parser.add_argument("--seconds", type=float, help="begin none after so long; without it, try all")
    parser.add_argument("--skip", type=int, default=0, help="leave out the first of the order")
    parser.add_argument("--again", action="store_true", help="only those that survived the run before")
    parser.add_argument("--changed-since", metavar="REVISION", help="change the files that differ from it")
    parser.add_argument("--seed", default=SEED, help="another order")
    parser.add_argument(
        "--matrix",
        action="store_true",
        help="run every test that reaches a mutant, and write which notice it",
    )
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, help="how many at a time")
    parser.add_argument(
        "--tests", nargs="+", default=[], help="files or folders; without it, all tests not slow"
    )
    parser.add_argument("places", nargs="*", help="folders or files to change; without any, those of proofs")
    return parser.parse_args()


def _reach(jobs: int, files: list[str]) -> dict[str, Reach]:
    """Give which tests reach which lines, recorded once for the same files."""
    file = FOLDER / "reach.json"
    digest = _digest(files)
    if file.exists():
        kept = json.loads(file.read_text())
        if kept["digest"] == digest:
            return read_reach(kept["tests"])
    print("recording which tests reach which lines", flush=True)
    with tempfile.TemporaryDirectory() as folder:
        words = [sys.executable, "-m", "pytest", "-q", "-p", "tests.mutation.reach", "-n", str(jobs)]
        ran = subprocess.run(
            [*words, "--dist", "worksteal", "-p", "no:cacheprovider", *files],
            env={**os.environ, RECORD: folder},
            check=False,
        )
        if ran.returncode not in {pytest.ExitCode.OK, pytest.ExitCode.TESTS_FAILED}:
            raise SystemExit("the tests have to run before mutants are tried")
        tests = {}
        for part in Path(folder).glob("*.json"):
            tests.update(json.loads(part.read_text()))
    if _digest(files) != digest:
        raise SystemExit("files were changed while the tests ran; begin again")
    file.write_text(json.dumps({"digest": digest, "tests": tests}))
    return read_reach(tests)


def _digest(files: list[str]) -> str:
    found = hashlib.sha256(json.dumps([sys.version, *files]).encode())
    for name in _FEEDS:
        path = ROOT / name
        for each in sorted(path.rglob("*")) if path.is_dir() else [path]:
            if each.is_file() and not {"__pycache__", "mutation"} & set(each.parts):
                found.update(each.relative_to(ROOT).as_posix().encode() + b"\0" + each.read_bytes())
    return found.hexdigest()


if __name__ == "__main__":
    sys.exit(main())
