"""Measures of the user's own against ``inputs``: processor time of a question after reading, and its answers.

    python benchmarks/measures.py                            a quick run
    python benchmarks/measures.py --units 100000             both families, five harder goals each

One measure says what ``inputs`` says, one has a random cost for each motion. Each question is asked by all of
them in turn, several times. *ratio* is the median over the goals of the measure's median by that of
``inputs``, *worst* the greatest; *evaluating* is what it takes once for a network to work out what its units
cost, which is not part of the ratio, and *first* the ratio of the first question with that in it.
"""

import argparse
import gc
import json
import random
import statistics
import tempfile
import time
from pathlib import Path

from contest.page import table
from generate import Family, generate

from foon_asp.asp import Settings, Status, solve
from foon_asp.problem import Objective, Problem
from foon_asp.rules.measure import read_measures
from foon_asp.text.data_folder import find_data, read_data
from foon_asp.text.node_lookup import find_goal

SAME = "same"
RANDOM = "random"


def rules(motions: list[str]) -> str:
    """Give the rules of both measures."""
    rng = random.Random("measures")
    table = " ".join(f'pays("{motion}",{rng.randint(1, 30)}).' for motion in motions)
    return f"cost({SAME},U,N) :- inputs(U,N). {table} cost({RANDOM},U,N) :- motion(U,M), pays(M,N)."


def asked(problem: Problem, objective: Objective) -> tuple[float, tuple[object, ...]]:
    """Give the seconds that a question takes, and what its best tree costs."""
    began = time.process_time()
    outcome = solve(problem, (objective,), Settings())
    seconds = time.process_time() - began
    assert outcome.status is Status.OPTIMAL
    assert outcome.costs is not None
    return seconds, (outcome.costs.measure(objective), outcome.costs.units)


def compare(family: Family, units: int, goals: int, rounds: int) -> list[list[str]]:
    """Give a row for each measure on one network."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        generate(family, units, 0, folder)
        data = read_data(find_data(folder))
        entries = json.loads((folder / "goal_nodes.json").read_text(encoding="utf-8"))
    network = data.network
    network.producers, network.consumers, network.by_label  # noqa: B018 (made when first asked for)
    gc.freeze()
    measures = read_measures(rules(sorted(set(network.motions))))
    harder = [find_goal(each["label"], network, data.goals) for each in entries[(len(entries) + 1) // 2 :]]
    problems = [Problem(network, data.kitchen, (goal,), data.rates, data.utensils) for goal in harder[:goals]]
    asked(problems[0], Objective.INPUTS)  # what is made once for a network is made for all
    rows = []
    for measure in (SAME, RANDOM):
        objective = Objective.of_measure(measure)
        evaluating, ratios = 0.0, []
        first = 0.0
        for problem in problems:
            seconds: dict[Objective, list[float]] = {Objective.INPUTS: [], objective: []}
            answers: dict[Objective, object] = {}
            for _ in range(rounds):
                for each, taken in seconds.items():
                    own = {} if each is Objective.INPUTS else {measure: measures[measure]}
                    given = Problem(
                        network, data.kitchen, problem.goals, data.rates, data.utensils, measures=own
                    )
                    began = time.process_time()
                    given.apply_measures()
                    if own and not evaluating:
                        evaluating = time.process_time() - began
                    needed, answers[each] = asked(given, each)
                    taken.append(needed)
            if measure == SAME:
                assert answers[objective] == answers[Objective.INPUTS]
            ours, theirs = (statistics.median(seconds[each]) for each in (Objective.INPUTS, objective))
            ratios.append(theirs / ours)
            first = first or (seconds[objective][0] + evaluating) / ours
        shown = (
            f"{evaluating:.3f} s",
            f"{statistics.median(ratios):.2f}",
            f"{max(ratios):.2f}",
            f"{first:.1f}",
        )
        rows.append([str(family), f"{units:,}", measure, *shown])
    return rows


def main() -> None:
    """Compare, and print a table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--units", type=int, default=5000)
    parser.add_argument("--goals", type=int, default=5)
    parser.add_argument("--rounds", type=int, default=5)
    given = parser.parse_args()
    rows = [
        row
        for family in (Family.RECIPE_LIKE, Family.DEEP)
        for row in compare(family, given.units, given.goals, given.rounds)
    ]
    print(table(["network", "units", "measure", "evaluating", "ratio", "worst", "first"], rows))


if __name__ == "__main__":
    main()
