"""Random networks under random rules of every class: one optimum, whoever is asked.

    python -m benchmarks.rule_campaign 5000 [FIRST SEED]        in the folder of the project
    python -m benchmarks.rule_campaign 60                       a quick run

Each small network has one to three rules: they delete units, ask for some, limit how many of some there are,
exclude pairs, ask for several at once, or mix these. The best tree of the program is held against the best of
all trees there are, against the plain program (``--reduce none``), and against the encoding by need where no
rule asks for units. Rules are grounded in this process, so that none is started for each question.
"""

import random
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

from foon_asp.asp import Settings, Status, assembly, solve
from foon_asp.hypergraph import NONE
from foon_asp.problem import Objective, Problem
from tests.hypergraph.test_reductions import LISTS, posed
from tests.rules.test_restricted_answers import CLASSES, Rule

_AT_ONCE = 100  # networks between two lines


def limiting(rng: random.Random, problem: Problem) -> Rule:
    """Limit how many units with some motion there are."""
    network = problem.network
    motion, most = rng.choice(network.motions), rng.choice((0, 1, 1, 2))
    some = frozenset(unit for unit, name in enumerate(network.motions) if name == motion)
    sums = f':- #sum {{ N,U : times(U,N), motion(U,"{motion}") }} > {most}.'
    counts = f':- #count {{ U : use(U), motion(U,"{motion}") }} > {most}.'
    return Rule(rng.choice((sums, counts)), lambda tree: len(tree & some) <= most)


def drawn(seed: int, problem: Problem) -> dict[str, Rule]:
    """Give rules by their texts, with their class before it."""
    rng = random.Random(f"rule campaign {seed}")
    kinds = [*CLASSES, "limiting"]
    mix = rng.choice([*([kind] for kind in kinds), ["deleting", "requiring"], kinds])
    found = {}
    for _ in range(rng.choice((1, 1, 2, 3))):
        kind = rng.choice(mix)
        rule = limiting(rng, problem) if kind == "limiting" else CLASSES[kind](rng, len(problem.network))
        found[f"{kind}: {rule.text}"] = rule
    return found


def faults(seed: int, folder: Path, total: Counter[str]) -> list[str]:
    """Ask about one network, and say what is wrong."""
    problem, _, every = posed(seed)
    rules = drawn(seed, problem)
    file = folder / "mine.lp"
    file.write_text("\n".join(rule.text for rule in rules.values()) + "\n")
    names = LISTS[seed % len(LISTS)]
    by = [*names, "units"]
    kept = [tree for tree in every if all(rule.keeps(tree.units) for rule in rules.values())]
    best = min((tree.key(by) for tree in kept), default=None)
    keys = {tree.units: tree.key(by) for tree in kept}
    ways = {"reduced": Settings((file,)), "plain": Settings((file,), reductions=NONE)}
    if all(name.startswith(("deleting", "limiting", "shrinking")) for name in rules):
        ways["by need"] = Settings((file,), encodings=Path("by_need"))
    total.update({name.partition(":")[0] for name in rules})
    total["without a tree"] += best is None
    wrong = []
    for way, settings in ways.items():
        outcome = solve(problem, tuple(map(Objective, names)), settings)
        total[way] += 1
        found = (
            None if outcome.units is None else keys.get(frozenset(outcome.units), "a tree that breaks them")
        )
        expected = Status.INFEASIBLE if best is None else Status.OPTIMAL
        if outcome.status is not expected or found != best:
            wrong.append(f"seed {seed}, {names}, {way}: {outcome.status}, {found}, not {best}: {list(rules)}")
    return wrong


def main(words: Sequence[str]) -> int:
    """Ask about ``number`` networks; gives 1 if an answer is wrong."""
    number, first = int(words[0]), int(words[1]) if len(words) > 1 else 0
    assembly._is_ready_made = lambda constraint: True  # so nothing is grounded in another process
    began, total = time.monotonic(), Counter({"wrong": 0})
    with tempfile.TemporaryDirectory() as folder:
        for seed in range(first, first + number):
            for said in faults(seed, Path(folder), total):
                total["wrong"] += 1
                print(f"WRONG: {said}", flush=True)
            total["networks"] += 1
            if total["networks"] % _AT_ONCE == 0:
                print(f"{time.monotonic() - began:6.0f} s  {dict(total)}", file=sys.stderr, flush=True)
    for name, count in sorted(total.items()):
        print(f"{name:16} {count:6}")
    return int(total["wrong"] > 0)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
