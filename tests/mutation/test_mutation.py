"""Mutation testing itself: which changes are made, how they are known again, what a trial says of them."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.conftest import ROOT
from tests.mutation.equivalents import equivalents, place
from tests.mutation.operators import mutants
from tests.mutation.reach import RECORD
from tests.mutation.rooms import all_mutants, texts

FILE = "foon_asp/proof/example.py"


def changes(text: str) -> set[str]:
    return {mutant.change for mutant in mutants(FILE, text)}


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("x = a < b", {"a < b → (a <= b)"}),
        ("x = a == b", {"a == b → (a != b)"}),
        ("x = a not in b", {"a not in b → (a in b)"}),
        ("x = a <= b < c", {"a <= b < c → (a < b < c)", "a <= b < c → (a <= b <= c)"}),
        ("x = a + b", {"a + b → (a - b)"}),
        ("x = a | b", {"a | b → (a & b)", "a | b → a"}),
        ("x = a // b", {"a // b → (-(-a // b))"}),
        ("x = 'a' + b", set()),
        ("x = -a", {"-a → a"}),
        ("x = not a", {"not a → a"}),
        ("x = a and b", {"a and b → (a or b)"}),
        ("x = True", {"True → False"}),
        ("x = min(a, b)", {"min → max"}),
        ("x = math.floor(a)", {"math.floor → (math.ceil)"}),
        ("x = a[1:]", {"1 → 2", "1 → 0"}),
        ("x = a if b else c", {"b → True", "b → False"}),
        ("x = [a for a in b if c]", {"c → True"}),
        ("while a:\n    f()", {"a → False", "f() → pass"}),
        ("for a in b:\n    break", {"break → continue"}),
        ("raise a", {"raise a → pass"}),
        ("a.b = c", {"a.b = c → pass"}),
        ("a = c", set()),
        ("a += c", {"a += c → pass", "a += c → a -= c"}),
        ("def f() -> bool:\n    return a", {"a → None", "a → (not a)"}),
        ("def f(a: int | None = 0) -> int | str:\n    '''Text.'''\n    return None", {"0 → 1"}),
        ("assert a < b", set()),
        ("x = f'{a < b}'", set()),
        ("if TYPE_CHECKING:\n    x = 1", set()),
    ],
)
def test_changes(text: str, expected: set[str]) -> None:
    assert changes(text) == expected


TEXT = '''\
"""Ünïcode before, so that bytes and letters differ: é."""

SIZE = 1


class Box:
    def full(self, size: int = 0) -> bool:
        def within() -> bool:
            return size < SIZE

        é = "é"; return self.big(é) or within()


key = lambda a: a + 1
'''


def test_a_change_is_made_where_it_says() -> None:
    found = mutants(FILE, TEXT)
    (less,) = (mutant for mutant in found if mutant.old == "size < SIZE" and mutant.operator == "comparison")
    assert less.applied(TEXT) == TEXT.replace("size < SIZE", "(size <= SIZE)")
    assert less.diff(TEXT) == "-            return size < SIZE\n+            return (size <= SIZE)"
    assert (less.function, less.outermost, less.first, less.last) == ("Box.full.within", "Box.full", 9, 9)
    (either,) = (mutant for mutant in found if mutant.operator == "boolean")
    assert either.applied(TEXT) == TEXT.replace("self.big(é) or within()", "(self.big(é) and within())")
    # defaults, and lambdas without a name, count when the file is imported
    assert {mutant.outermost for mutant in found if mutant.first in {3, 7, 13}} == {""}


def test_a_mutant_is_known_again_when_lines_have_moved() -> None:
    before, after = mutants(FILE, TEXT), mutants(FILE, "# a line more\n" + TEXT)
    assert [mutant.key for mutant in before] == [mutant.key for mutant in after]
    assert [mutant.rank() for mutant in before] == [mutant.rank() for mutant in after]
    assert len({mutant.key for mutant in before}) == len(before)
    twice = mutants(FILE, "def f():\n    g(1)\n    h(1)\n")
    ones = [mutant for mutant in twice if mutant.change == "1 → 2"]
    assert [mutant.occurrence for mutant in ones] == [0, 1]


def test_all_rooms_have_mutants_and_every_mutant_is_python() -> None:
    files = texts()
    found = all_mutants()
    lint = {mutant.file for mutant in all_mutants(places=["foon_asp/linting", "foon_asp/cli/main.py"])}
    assert {file.rpartition("/")[0] for file in lint} == {"foon_asp/linting", "foon_asp/cli"}
    assert len({mutant.room for mutant in found[:6]}) == 6
    assert len({mutant.rank() for mutant in found}) == len(found)
    for mutant in found[:150]:
        compile(mutant.applied(files[mutant.file]), mutant.file, "exec")
    assert equivalents() <= {place(mutant) for mutant in found}


TRIAL = """
import json, os, sys
import pytest
from tests.mutation.mutant import Mutant
from tests.mutation.trials import Trials, read_reach

mutants = [Mutant(*fields) for fields in json.loads(sys.argv[1])]
reach = read_reach(json.load(open(sys.argv[2])))
trials = Trials(mutants, reach, 2, None)
assert pytest.main(["-q", "-s", "-p", "no:cacheprovider", sys.argv[3]], plugins=[trials]) in {0, 5}
print(json.dumps([[each.mutant.key, each.outcome, each.by] for each in trials.tried]))
"""


@pytest.mark.nightly
def test_trials_tell_changes_from_none(tmp_path: Path) -> None:
    """What is no change survives, in a forked process and afresh; what breaks a function is noticed."""
    tests = "tests/proof/test_simulation.py"
    alone = {name: value for name, value in os.environ.items() if not name.startswith("PYTEST_XDIST")}
    subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "-p", "tests.mutation.reach", "-p", "no:cacheprovider", tests],
        cwd=ROOT,
        env={**alone, RECORD: str(tmp_path)},
        check=True,
    )
    file = "foon_asp/proof/simulation.py"
    every = [mutant for mutant in all_mutants() if mutant.file == file]
    inside = next(
        mutant for mutant in every if mutant.outermost == "simulate" and mutant.operator == "return"
    )
    none = inside._replace(new=inside.old, occurrence=1)
    at_import = inside._replace(outermost="", old=inside.old, new=inside.old, occurrence=2)
    endless = inside._replace(new="(lambda: [0 for _ in iter(int, 1)])()", occurrence=3)
    generator = inside._replace(new="(yield)", occurrence=4)
    chosen = [inside, none, at_import, endless, generator]
    ran = subprocess.run(
        [sys.executable, "-c", TRIAL, json.dumps(chosen), str(tmp_path / "alone.json"), tests],
        cwd=ROOT,
        env=alone,
        stdout=subprocess.PIPE,
        text=True,
        check=True,
    )
    outcomes = {tuple(key): (outcome, by) for key, outcome, by in json.loads(ran.stdout.splitlines()[-1])}
    assert outcomes[none.key] == outcomes[at_import.key] == ("survived", "")
    assert outcomes[endless.key][0] == "timeout"
    for mutant in (inside, generator):
        outcome, by = outcomes[mutant.key]
        assert outcome == "killed"
        assert by.startswith(tests)
